(** * The checker: formulas on a tape, tests, a bisection tree with evidence

    Every step shows a test on its node's cell, for every machine of the
    tolerance; what is shown of a cell holds on its parts, and on the path to
    each leaf every test is discharged. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Formula Linear Arithmetic Slope Definite Test Cell.
Import ListNotations.
Local Open Scope R_scope.

(** A face of the cube of the postulate, by its corner. *)
Inductive face := Q1 | Q2.

(** [Y] over [2^places]; the names are those of certificate.rs. *)
Inductive evidence :=
  | ByTest | ByDivided
  | ByLower (places : N) (Y : list (list Z)) | ByLowerDivided (places : N) (Y : list (list Z))
  (* of the postulate: see Faces.v *)
  | ByCorner (f : face) | ByMirror.

(** Steps name tests by their number, counted from zero. *)
Inductive tree :=
  | Leaf (by_ : list (nat * evidence))
  | Split (by_ : list (nat * evidence)) (k : nat) (lower upper : tree).

(** kappa^2, k^2, and the place of a formula. *)
Inductive test := SigmaMin (kappa2 : fixed) | SigmaMax (k2 : fixed) | AtLeast (f : nat).

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Variable tape : list (op nat).
(** A and D of the machine, and the same divided by B. *)
Variables whole divided : rows nat.
Variable params : list fixed.
Variable tests : list test.

(** ** Formulas over a cell *)

Definition evaluate (cell : list fixed) : list (option slope) :=
  run (option slope) None (slope_op bits (coords_from 0 cell) (map constant params)) tape [].

Fixpoint all_some {A : Type} (l : list (option A)) : option (list A) :=
  match l with
  | [] => Some []
  | Some a :: l' => match all_some l' with Some m => Some (a :: m) | None => None end
  | None :: _ => None
  end.

(** Rows of which every entry is defined, and every D_i positive. *)
Fixpoint rows_over (values : list (option slope)) (r : rows nat) : option (rows slope) :=
  match r with
  | [] => Some []
  | (a, d) :: r' =>
      match all_some (map (fun i => nth i values None) a), nth d values None, rows_over values r' with
      | Some s, Some t, Some rest => if (0 <? lo (range t))%Z then Some ((s, t) :: rest) else None
      | _, _, _ => None
      end
  end.

Definition over_rows (values : list (option slope)) (r : rows nat) (holds : rows slope -> bool) : bool :=
  match rows_over values r with Some s => holds s | None => false end.

Definition shows (values : list (option slope)) (m : nat) (t : test) (e : evidence) : bool :=
  match t, e with
  | SigmaMin low, ByLower places Y => over_rows values whole (sigma_min m low places Y)
  | SigmaMin low, ByLowerDivided places Y => over_rows values divided (sigma_min m low places Y)
  | SigmaMax high, ByTest => over_rows values whole (sigma_max m high)
  | SigmaMax high, ByDivided => over_rows values divided (sigma_max m high)
  | AtLeast f, ByTest => match nth f values None with Some s => (0 <=? lo (range s))%Z | None => false end
  | _, _ => false
  end.

(** ** The tree; [open] has the tests that are not discharged yet *)

Fixpoint clear (i : nat) (open : list bool) : list bool :=
  match open, i with
  | [], _ => []
  | _ :: l, O => false :: l
  | b :: l, S j => b :: clear j l
  end.

Fixpoint discharge (values : list (option slope)) (m : nat) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  match steps with
  | [] => Some open
  | (i, e) :: rest =>
      match nth i open false, nth_error tests i with
      | true, Some t => if shows values m t e then discharge values m rest (clear i open) else None
      | _, _ => None
      end
  end.

Definition steps_on (cell : list fixed) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  match steps with [] => Some open | _ => discharge (evaluate cell) (length cell) steps open end.

Fixpoint check (cell : list fixed) (open : list bool) (t : tree) : bool :=
  match t with
  | Leaf steps => match steps_on cell steps open with Some last => forallb negb last | None => false end
  | Split steps k lower upper =>
      match steps_on cell steps open with
      | Some last => let (a, b) := halves k cell in if check a last lower then check b last upper else false
      | None => false
      end
  end.

(** ** What it shows *)

Variable theta : list R.
Hypothesis theta_in : Forall2 contains params theta.

Definition formula_at (i : nat) : formula := nth i (formulas tape) (integer 0).

(** Every formula of the rows is defined at [x], and every D_i positive. *)
Definition regular (x : list R) (r : rows formula) : Prop :=
  Forall (fun p => Forall (defined x theta) (fst p) /\ defined x theta (snd p)) r /\
  positive_D (map_rows (value x theta) r).

(** [bound] holds of the rows' |M v|^2, for one of the two forms of the rows. *)
Definition of_rows (x : list R) (bound : rows R -> Prop) : Prop :=
  exists r, (r = map_rows formula_at whole \/ r = map_rows formula_at divided) /\ regular x r /\
    bound (map_rows (value x theta) r).

Definition holds (m : nat) (x : list R) (t : test) : Prop :=
  match t with
  | SigmaMin low => of_rows x (fun r => forall kappa2 v, contains low kappa2 -> length v = m -> nonzero v ->
      kappa2 * dot v v < energy r v)
  | SigmaMax high => of_rows x (fun r => forall k2 v, contains high k2 -> length v = m -> nonzero v ->
      energy r v < k2 * dot v v)
  | AtLeast f => defined x theta (formula_at f) /\ 0 <= value x theta (formula_at f)
  end.

Section Cell.
Variables (cell : list fixed) (x lambda : list R).
Hypothesis lambda_length : length lambda = length cell.
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.
Let cs := map (centre_of bits) cell.
Let values := evaluate cell.
Hypothesis enclosed_at : forall i, encloses bits lambda x cs theta (nth i values None) (formula_at i).

(** The slope that belongs to [x]. *)
Definition entry_of (s : slope) (f : formula) (e : entry) : Prop :=
  entry_in bits s e /\ value x theta f = at_lambda lambda e.

Lemma entry_exists : forall i s, nth i values None = Some s ->
  defined x theta (formula_at i) /\ contains (range s) (value x theta (formula_at i)) /\
  exists e, entry_of s (formula_at i) e.
Proof.
  intros i s h. pose proof (enclosed_at i) as H. rewrite h in H. destruct H as [_ [d [h1 [h2 [u [h3 h4]]]]]].
  split; [exact d |]. split; [exact h2 |]. exists (value cs theta (formula_at i), u).
  split; [split; assumption |]. unfold at_lambda. cbn [fst snd]. lra.
Qed.

Lemma all_some_entries : forall a s, all_some (map (fun i => nth i values None) a) = Some s ->
  Forall (defined x theta) (map formula_at a) /\
  exists e, Forall2 (entry_in bits) s e /\ map (value x theta) (map formula_at a) = map (at_lambda lambda) e.
Proof.
  induction a as [| i a IH]; intros s h; cbn [map all_some] in h.
  - injection h as <-. split; [constructor |]. exists []. split; [constructor | reflexivity].
  - destruct (nth i values None) as [s1 |] eqn:n; [| discriminate].
    destruct (all_some (map _ a)) as [s' |]; [| discriminate]. injection h as <-.
    destruct (IH s' eq_refl) as [d [e [h1 h2]]]. destruct (entry_exists i s1 n) as [d1 [_ [e1 [k1 k2]]]].
    split; [constructor; assumption |]. exists (e1 :: e). split; [constructor; assumption |]. cbn [map]. congruence.
Qed.

Lemma rows_over_sound : forall r s, rows_over values r = Some s ->
  regular x (map_rows formula_at r) /\
  exists es, rows_rel (entry_in bits) s es /\
    map_rows (value x theta) (map_rows formula_at r) = map_rows (at_lambda lambda) es.
Proof.
  induction r as [| [a d] r IH]; intros s h; cbn [rows_over] in h.
  - injection h as <-. split; [split; constructor |]. exists []. split; [constructor | reflexivity].
  - destruct (all_some (map _ a)) as [sa |] eqn:ea; [| discriminate].
    destruct (nth d values None) as [sd |] eqn:ed; [| discriminate].
    destruct (rows_over values r) as [rest |]; [| discriminate].
    destruct (0 <? lo (range sd))%Z eqn:p; [| discriminate]. injection h as <-. apply Z.ltb_lt in p.
    destruct (IH rest eq_refl) as [[H1 H2] [es [H3 H4]]]. destruct (all_some_entries a sa ea) as [d1 [e1 [k1 k2]]].
    destruct (entry_exists d sd ed) as [d2 [c2 [e2 [k3 k4]]]]. rewrite !map_rows_cons. split.
    + split; constructor; cbn [fst snd]; auto. exact (contains_positive bits _ _ p c2).
    + exists ((e1, e2) :: es). split; [constructor; [split |]; assumption |].
      rewrite map_rows_cons. rewrite <- H4, <- k2, <- k4. reflexivity.
Qed.

Lemma over_rows_sound : forall r test (bound : rows R -> Prop),
  r = whole \/ r = divided -> over_rows values r test = true ->
  (forall s es, test s = true -> rows_rel (entry_in bits) s es ->
     positive_D (map_rows (at_lambda lambda) es) -> bound (map_rows (at_lambda lambda) es)) ->
  of_rows x bound.
Proof.
  intros r test bound which h H. unfold over_rows in h. destruct (rows_over values r) as [s |] eqn:e; [| discriminate].
  destruct (rows_over_sound r s e) as [reg [es [k1 k2]]]. exists (map_rows formula_at r).
  split; [destruct which; subst r; auto |]. split; [exact reg |]. destruct reg as [_ pos]. rewrite k2 in *.
  eapply H; eassumption.
Qed.

Lemma shows_sound : forall t e, shows values (length cell) t e = true -> holds (length cell) x t.
Proof.
  rewrite <- lambda_length. intros t e h. destruct t as [low | high | f], e as [| | places Y | places Y | |];
    cbn [shows holds] in *; try discriminate.
  1-2: eapply over_rows_sound; [| exact h |]; [auto |]; cbn beta; intros; eapply sigma_min_sound; eassumption.
  1-2: eapply over_rows_sound; [| exact h |]; [auto |]; cbn beta; intros; eapply sigma_max_sound; eassumption.
  destruct (nth f values None) as [s |] eqn:n; [| discriminate]. apply Z.leb_le in h.
  destruct (entry_exists f s n) as [d [c _]]. split; [exact d |]. exact (contains_nonneg bits _ _ h c).
Qed.
End Cell.

Lemma evaluate_holds : forall cell x t e, Forall2 contains cell x ->
  shows (evaluate cell) (length cell) t e = true -> holds (length cell) x t.
Proof.
  intros cell x t e hx h. destruct (coords_from_hold bits cell x hx) as [lambda [el [hlam C]]].
  specialize (C []). cbn [app length] in C.
  pose proof (evaluate_sound bits lambda hlam x (map (centre_of bits) cell) theta _ _ C
    (params_hold bits lambda params theta theta_in) tape) as S.
  apply (shows_sound cell x lambda el hlam) with e; [| exact h].
  intro i. apply (nth_related _ _ _ _ (encloses bits lambda x (map (centre_of bits) cell) theta)); [exact I | exact S].
Qed.

(** Every test that is not open holds. *)
Definition done (m : nat) (x : list R) (open : list bool) : Prop :=
  forall i t, nth_error tests i = Some t -> nth i open false = false -> holds m x t.

Lemma nth_clear : forall i j open, nth j (clear i open) false = false -> j = i \/ nth j open false = false.
Proof.
  induction i as [| i IH]; intros [| j] [| b open] h; cbn in *; auto.
  destruct (IH j open h); auto.
Qed.

Lemma steps_on_sound : forall cell x steps open rest, Forall2 contains cell x -> steps_on cell steps open = Some rest ->
  done (length cell) x open -> done (length cell) x rest.
Proof.
  intros cell x steps open rest hx h.
  assert (h' : discharge (evaluate cell) (length cell) steps open = Some rest) by (destruct steps; exact h).
  clear h. revert open h'.
  induction steps as [| [i e] steps IH]; intros open h D; cbn [discharge] in h; [injection h as <-; exact D |].
  destruct (nth i open false); [| discriminate]. destruct (nth_error tests i) as [t |] eqn:n; [| discriminate].
  destruct (shows (evaluate cell) (length cell) t e) eqn:s; [| discriminate]. apply (IH _ h).
  intros j u nj o. destruct (nth_clear i j open o) as [-> | o']; [| exact (D j u nj o')].
  rewrite n in nj. injection nj as <-. exact (evaluate_holds cell x t e hx s).
Qed.

(** Soundness: where the tree is accepted, every test holds at every point of the cell. *)
Theorem check_sound : forall tr cell x open, check cell open tr = true -> Forall2 contains cell x ->
  done (length cell) x open -> forall t, In t tests -> holds (length cell) x t.
Proof.
  induction tr as [steps | steps k lower IHl upper IHu]; intros cell x open h hx D t ht; cbn [check] in h;
    destruct (steps_on cell steps open) as [rest |] eqn:s; try discriminate;
    pose proof (steps_on_sound cell x steps open rest hx s D) as D'.
  - destruct (In_nth_error _ _ ht) as [i n]. apply (D' i t n). rewrite forallb_forall in h.
    destruct (nth_in_or_default i rest false) as [m | ->]; [| reflexivity].
    apply h in m. destruct (nth i rest false); [discriminate | reflexivity].
  - pose proof (halves_sound bits k cell x hx) as c. destruct (halves_length k cell) as [La Lb].
    destruct (halves k cell) as [a b]. cbn [fst snd] in *.
    destruct (check a rest lower) eqn:ha; [| discriminate].
    destruct c as [c | c].
    + rewrite <- La in *. exact (IHl a x rest ha c D' t ht).
    + rewrite <- Lb in *. exact (IHu b x rest h c D' t ht).
Qed.

Definition all_open : list bool := map (fun _ => true) tests.

Corollary check_all_open : forall tr cell x, check cell all_open tr = true -> Forall2 contains cell x ->
  forall t, In t tests -> holds (length cell) x t.
Proof.
  intros tr cell x h hx. apply (check_sound tr cell x all_open h hx).
  intros i t n o. exfalso. unfold all_open in o.
  rewrite (nth_indep _ false true) in o.
  - rewrite (map_nth (fun _ => true) tests (SigmaMin zero) i) in o. discriminate.
  - rewrite map_length. apply nth_error_Some. congruence.
Qed.
End Precision.
