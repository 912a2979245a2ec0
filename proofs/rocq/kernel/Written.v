(** * Mechanisms by formulas: claims, formulas on a tape, certificates and refutations

    A user names coordinates, parameters within tolerances and definitions, and
    gives each joint by its row of M. *)

From Coq Require Import ZArith Reals Lra Lia List Bool String.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Linear Arithmetic Slope Test Cell Check Number Formula Problem Witness Configuration.
Import ListNotations.
Local Open Scope list_scope.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** What is written, and what it means *)

Inductive written :=
  | Constant (c : number)
  | Named (name : string)
  | Opposite (a : written)
  | Sum (a b : written) | Difference (a b : written) | Product (a b : written) | Quotient (a b : written)
  | Raised (a : written) (n : positive)
  | RootOf (a : written).

Definition environment (A : Type) : Type := list (string * A).
Fixpoint lookup {A : Type} (default : A) (env : environment A) (name : string) : A :=
  match env with [] => default | (n, a) :: env' => if String.eqb n name then a else lookup default env' name end.

Fixpoint meaning (env : environment R) (e : written) : R :=
  match e with
  | Constant c => Claim.value c
  | Named name => lookup 0 env name
  | Opposite a => - meaning env a
  | Sum a b => meaning env a + meaning env b
  | Difference a b => meaning env a - meaning env b
  | Product a b => meaning env a * meaning env b
  | Quotient a b => meaning env a / meaning env b
  | Raised a n => meaning env a ^ Pos.to_nat n
  | RootOf a => sqrt (meaning env a)
  end.

(** No divisor is zero, and every radicand positive. *)
Fixpoint is_defined (env : environment R) (e : written) : Prop :=
  match e with
  | Constant _ | Named _ => True
  | Opposite a | Raised a _ => is_defined env a
  | Sum a b | Difference a b | Product a b => is_defined env a /\ is_defined env b
  | Quotient a b => is_defined env a /\ is_defined env b /\ meaning env b <> 0
  | RootOf a => is_defined env a /\ 0 < meaning env a
  end.

(** [rows]: of each joint, the entries of its row of M. *)
Record mechanism := Mechanism {
  coordinate_names : list string;
  parameters : list (string * tolerance);
  definitions : list (string * written);
  joint_rows : list (list written)
}.
Record written_claim := MakeWrittenClaim { by_formulas : mechanism; box_of : list tolerance; written_demands : list demand }.

(** Values of all names, those of definitions from those before them. *)
Definition given {A : Type} (c : mechanism) (x theta : list A) : environment A :=
  combine (coordinate_names c) x ++ combine (map fst (parameters c)) theta.
Fixpoint extended (env : environment R) (ds : list (string * written)) : environment R :=
  match ds with [] => env | (n, e) :: ds' => extended ((n, meaning env e) :: env) ds' end.
Fixpoint all_defined (env : environment R) (ds : list (string * written)) : Prop :=
  match ds with [] => True | (n, e) :: ds' => is_defined env e /\ all_defined ((n, meaning env e) :: env) ds' end.

(** The machine with the parameters [theta] at the coordinates [x]. *)
Definition machine_at (c : mechanism) (theta x : list R) : configuration :=
  let env := extended (given c x theta) (definitions c) in
  Configuration (map (map (meaning env)) (joint_rows c)) (map (fun _ => Unknown) (joint_rows c))
    (all_defined (given c x theta) (definitions c) /\ Forall (Forall (is_defined env)) (joint_rows c)).

Definition is_about_written (c : written_claim) (theta x : list R) : Prop :=
  Forall2 (fun p y => within (snd p) y) (parameters (by_formulas c)) theta /\ Forall2 within (box_of c) x.

(** Every machine of the claim meets it at every point of the box. *)
Definition written_holds (c : written_claim) : Prop := forall theta x, is_about_written c theta x ->
  Configuration.meets (length (coordinate_names (by_formulas c))) (machine_at (by_formulas c) theta x) (written_demands c).

(** ** As formulas: numbers are parameters of the tape, one each *)

Fixpoint literals (e : written) : list parameter :=
  match e with
  | Constant c => [(exactly c, 0%Z)]
  | Named _ => []
  | Opposite a | Raised a _ | RootOf a => literals a
  | Sum a b | Difference a b | Product a b | Quotient a b => literals a ++ literals b
  end.

(** x^2, times x^2 as often as it takes, and then x if n is odd. *)
Definition power (a : formula) (n : nat) : formula :=
  match n with
  | O => integer 1
  | S O => a
  | _ => let s := square a in
         let even := Nat.iter (pred (Nat.div2 n)) (fun p => times p s) s in
         if Nat.even n then even else times even a
  end.

Section Formulas.
Variable env : environment formula.
Fixpoint formula_of (e : written) (j : nat) : formula :=
  let second f a b := f (formula_of a j) (formula_of b (j + length (literals a))) in
  match e with
  | Constant c => quantity (exactly c, 0%Z) j
  | Named name => lookup (integer 0) env name
  | Opposite a => opposite (formula_of a j)
  | Sum a b => second plus a b
  | Difference a b => second minus a b
  | Product a b => second times a b
  | Quotient a b => second over a b
  | Raised a n => power (formula_of a j) (Pos.to_nat n)
  | RootOf a => root (formula_of a j)
  end.
(** Its quotients and roots. *)
Fixpoint partials (e : written) (j : nat) : list formula :=
  match e with
  | Constant _ | Named _ => []
  | Opposite a | Raised a _ => partials a j
  | Sum a b | Difference a b | Product a b => partials a j ++ partials b (j + length (literals a))
  | Quotient a b => formula_of e j :: partials a j ++ partials b (j + length (literals a))
  | RootOf a => formula_of e j :: partials a j
  end.
End Formulas.

Lemma value_power : forall x theta a n, value x theta (power a n) = value x theta a ^ n.
Proof.
  intros x theta a [| [| n]]; [reflexivity | cbn [power]; ring |]. unfold power. cbv zeta.
  set (m := S (S n)). assert (I : forall k, value x theta (Nat.iter k (fun p => times p (square a)) (square a)) = value x theta a ^ (2 * S k)).
  { induction k as [| k IH]; cbn [Nat.iter nat_rect]; [rewrite Formula.value_square; reflexivity |].
    rewrite value_times, Formula.value_square. change (nat_rect _ _ _ k) with (Nat.iter k (fun p => times p (square a)) (square a)). rewrite IH, <- pow_add. f_equal. lia. }
  assert (D : S (pred (Nat.div2 m)) = Nat.div2 m) by reflexivity. destruct (Nat.even m) eqn:e.
  - rewrite I, D. f_equal. apply Nat.even_spec in e. destruct e as [k e]. rewrite e, Nat.div2_double. reflexivity.
  - assert (o : Nat.odd m = true) by (rewrite <- Nat.negb_even, e; reflexivity). apply Nat.odd_spec in o. destruct o as [k o].
    rewrite value_times, I, D, o. replace (2 * k + 1)%nat with (S (2 * k)) by lia. rewrite Nat.div2_succ_double. cbn [pow]. ring.
Qed.


Section Values.
Variables x theta : list R.
Variable env : environment formula.
Variable renv : environment R.
Hypothesis agreed : forall name, value x theta (lookup (integer 0) env name) = lookup 0 renv name.

(** The parameters from [j] on are these numbers. *)
Definition holds_at (j : nat) (ps : list parameter) : Prop :=
  forall i p, nth_error ps i = Some p -> scaled_within p (nth (j + i) theta 0).

Lemma holds_app : forall j ps qs, holds_at j (ps ++ qs) -> holds_at j ps /\ holds_at (j + length ps) qs.
Proof.
  intros j ps qs h. split; intros i p n.
  - apply h. rewrite nth_error_app1; [exact n | apply nth_error_Some; congruence].
  - rewrite <- Nat.add_assoc. apply h. rewrite nth_error_app2 by lia. rewrite Nat.add_comm, Nat.add_sub. exact n.
Qed.

Lemma formula_value : forall e j, holds_at j (literals e) -> value x theta (formula_of env e j) = meaning renv e.
Proof.
  induction e as [c | n | a IH | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IH n | a IH]; intros j h; cbn [formula_of meaning literals] in *;
    try (apply holds_app in h as [h1 h2]; rewrite ?value_plus, ?value_minus, ?value_times, ?value_over, (IHa _ h1), (IHb _ h2); reflexivity).
  - specialize (h O _ eq_refl). rewrite Nat.add_0_r in h. rewrite (quantity_value _ _ x theta j h eq_refl).
    destruct h as [y [[h1 h2] h3]]. cbn [fst snd exactly least greatest] in *. rewrite h3. change (two_to 0) with 1. lra.
  - apply agreed.
  - rewrite value_opposite, (IH _ h). reflexivity.
  - rewrite value_power, (IH _ h). reflexivity.
  - rewrite value_root, (IH _ h). reflexivity.
Qed.

Lemma defined_root : forall a, defined x theta (root a) -> 0 < value x theta a.
Proof.
  intros a. unfold root. destruct (is 1 a) eqn:q; [rewrite (is_value _ _ _ _ q); intros; lra | intros [h _]; exact h].
Qed.

Lemma partials_defined : forall e j, holds_at j (literals e) -> Forall (defined x theta) (partials env e j) -> is_defined renv e.
Proof.
  induction e as [c | n | a IH | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IH n | a IH]; intros j h D; cbn [partials is_defined literals] in *;
    try exact I; try (apply (IH j); assumption);
    try (apply holds_app in h as [h1 h2]; apply Forall_app in D as [D1 D2]; split; [apply (IHa j) | apply (IHb (j + length (literals a))%nat)]; assumption).
  - apply holds_app in h as [h1 h2]. inversion D as [| ? ? D0 D']. subst. apply Forall_app in D' as [D1 D2].
    split; [apply (IHa j); assumption |]. split; [apply (IHb (j + length (literals a))%nat); assumption |].
    cbn [formula_of] in D0. apply defined_over in D0. rewrite (formula_value _ _ h2) in D0. exact D0.
  - inversion D as [| ? ? D0 D']. subst. split; [apply (IH j); assumption |].
    cbn [formula_of] in D0. apply defined_root in D0. rewrite (formula_value _ _ h) in D0. exact D0.
Qed.
End Values.

(** ** The whole mechanism *)

(** Formulas of definitions, in the environment of those before them; then of all entries of rows. *)
Fixpoint named (env : environment formula) (ds : list (string * written)) (j : nat) : environment formula :=
  match ds with [] => env | (n, e) :: ds' => named ((n, formula_of env e j) :: env) ds' (j + length (literals e)) end.
Fixpoint named_partials (env : environment formula) (ds : list (string * written)) (j : nat) : list formula :=
  match ds with
  | [] => []
  | (n, e) :: ds' => partials env e j ++ named_partials ((n, formula_of env e j) :: env) ds' (j + length (literals e))
  end.
Definition all_literals (es : list written) : list parameter := flat_map literals es.
Fixpoint row_of (env : environment formula) (es : list written) (j : nat) : list formula :=
  match es with [] => [] | e :: es' => formula_of env e j :: row_of env es' (j + length (literals e)) end.
Fixpoint row_partials (env : environment formula) (es : list written) (j : nat) : list formula :=
  match es with [] => [] | e :: es' => partials env e j ++ row_partials env es' (j + length (literals e)) end.
Fixpoint rows_of (env : environment formula) (rows : list (list written)) (j : nat) : list (list formula) :=
  match rows with [] => [] | r :: rows' => row_of env r j :: rows_of env rows' (j + length (all_literals r)) end.
Fixpoint rows_partials (env : environment formula) (rows : list (list written)) (j : nat) : list formula :=
  match rows with [] => [] | r :: rows' => row_partials env r j ++ rows_partials env rows' (j + length (all_literals r)) end.

Section Mechanism.
Variables x theta : list R.

Definition agrees (env : environment formula) (renv : environment R) : Prop :=
  forall name, value x theta (lookup (integer 0) env name) = lookup 0 renv name.

Lemma agrees_cons : forall env renv n f y, agrees env renv -> value x theta f = y -> agrees ((n, f) :: env) ((n, y) :: renv).
Proof. intros env renv n f y h e name. cbn [lookup]. destruct (String.eqb n name); [exact e | apply h]. Qed.

Lemma agrees_combine : forall ns fs ys env renv, map (value x theta) fs = ys -> agrees env renv ->
  agrees (combine ns fs ++ env) (combine ns ys ++ renv).
Proof.
  intros ns fs ys env renv <- h. revert fs. induction ns as [| n ns IH]; intros [| f fs]; try exact h.
  cbn [combine map app]. apply agrees_cons; [apply IH | reflexivity].
Qed.

Lemma named_agrees : forall ds env renv j, agrees env renv -> holds_at theta j (all_literals (map snd ds)) ->
  agrees (named env ds j) (extended renv ds) /\
  (Forall (defined x theta) (named_partials env ds j) -> all_defined renv ds).
Proof.
  induction ds as [| [n e] ds IH]; intros env renv j h H; [split; [exact h | exact (fun _ => I)] |].
  cbn [all_literals map snd flat_map] in H. apply holds_app in H as [H1 H2].
  pose proof (formula_value x theta env renv h e j H1) as V.
  destruct (IH _ _ (j + length (literals e))%nat (agrees_cons _ _ n _ _ h V) H2) as [I1 I2]. split; [exact I1 |].
  intro D. cbn [named_partials] in D. apply Forall_app in D as [D1 D2].
  split; [exact (partials_defined x theta env renv h e j H1 D1) | exact (I2 D2)].
Qed.

Lemma row_agrees : forall es env renv j, agrees env renv -> holds_at theta j (all_literals es) ->
  map (value x theta) (row_of env es j) = map (meaning renv) es /\
  (Forall (defined x theta) (row_partials env es j) -> Forall (is_defined renv) es).
Proof.
  induction es as [| e es IH]; intros env renv j h H; [split; [reflexivity | constructor] |].
  cbn [all_literals flat_map] in H. apply holds_app in H as [H1 H2]. destruct (IH _ _ _ h H2) as [I1 I2]. split.
  - cbn [row_of map]. rewrite (formula_value x theta env renv h e j H1), I1. reflexivity.
  - intro D. cbn [row_partials] in D. apply Forall_app in D as [D1 D2].
    constructor; [exact (partials_defined x theta env renv h e j H1 D1) | exact (I2 D2)].
Qed.

Lemma rows_agree : forall rows env renv j, agrees env renv -> holds_at theta j (flat_map all_literals rows) ->
  map (map (value x theta)) (rows_of env rows j) = map (map (meaning renv)) rows /\
  (Forall (defined x theta) (rows_partials env rows j) -> Forall (Forall (is_defined renv)) rows).
Proof.
  induction rows as [| r rows IH]; intros env renv j h H; [split; [reflexivity | constructor] |].
  cbn [flat_map] in H. apply holds_app in H as [H1 H2]. destruct (IH _ _ _ h H2) as [I1 I2].
  destruct (row_agrees r env renv j h H1) as [J1 J2]. split.
  - cbn [rows_of map]. rewrite J1, I1. reflexivity.
  - intro D. cbn [rows_partials] in D. apply Forall_app in D as [D1 D2]. constructor; auto.
Qed.

Lemma row_energy : forall rows v, energy (map_rows (value x theta) (map (fun a => (a, integer 1)) rows)) v = speed2 (map (map (value x theta)) rows) v.
Proof.
  induction rows as [| a rows IH]; intro v; [reflexivity |]. cbn [map]. rewrite map_rows_cons. cbn [energy speed2 fold_right].
  rewrite IH. unfold speed2. cbn. field.
Qed.
End Mechanism.

(** ** Checking *)

Definition exact_parameters (ps : list (string * tolerance)) : list parameter := map (fun p => (snd p, 0%Z)) ps.
Definition inputs (c : mechanism) : list parameter :=
  exact_parameters (parameters c) ++ all_literals (map snd (definitions c)) ++ flat_map all_literals (joint_rows c).
Definition given_formulas (c : mechanism) : environment formula :=
  given c (map (fun k => F (Coord k)) (seq 0 (length (coordinate_names c)))) (numbered 0 (exact_parameters (parameters c))).

Section Precision.
Variable bits : positive.

Definition written_test (d : demand) : option test :=
  let squared make x := option_map (fun a => make (sqr bits a)) (enclose_parameter bits (exactly x, 0%Z)) in
  match d with
  | Nonsingular => Some (SigmaMin zero)
  | FactorMax b => squared SigmaMin (Over (1 // 1) b)
  | FactorMin b => squared SigmaMax (Over (1 // 1) b)
  | Conditioned b => squared Conditioning b
  | LengthMin _ _ | LengthMax _ _ | AngleWithin _ _ _ | SpeedMax _ _ _ | ForceMax _ _ _ | StiffnessMin _ _ => None
  end.
Definition excludes_singularities (d : demand) : bool := match d with Nonsingular | FactorMax _ => true | _ => false end.

Definition check_written (c : written_claim) (t : tree) : bool :=
  let f := by_formulas c in let n := length (coordinate_names f) in
  let j := length (parameters f) in let i := (j + length (all_literals (map snd (definitions f))))%nat in
  let env := named (given_formulas f) (definitions f) j in
  let rows := map (fun a => (a, integer 1)) (rows_of env (joint_rows f) i) in
  let partial := named_partials (given_formulas f) (definitions f) j ++ rows_partials env (joint_rows f) i in
  let tape := fst (compile (entries rows ++ partial)) in
  let place := place (formulas tape) in
  let found := map_rows place rows in
  Nat.eqb (length (box_of c)) n &&
  forallb (fun e => Formula.same (nth (place e) (formulas tape) (integer 0)) e) (entries rows ++ partial) &&
  existsb excludes_singularities (written_demands c) &&
  match all_some (map (enclose_parameter bits) (inputs f)), all_some (map (fun b => enclose_parameter bits (b, 0%Z)) (box_of c)),
        all_some (map written_test (written_demands c)) with
  | Some params, Some box, Some tests => check bits tape found found (map place partial) params tests (fun _ => None) box (all_open tests) t
  | _, _, _ => false
  end.

Lemma within_scaled : forall t y, within t y -> scaled_within (t, 0%Z) y.
Proof. intros t y h. exists y. split; [exact h |]. cbn [snd]. change (two_to 0) with 1. field. Qed.

Lemma squared_sound : forall x a, enclose_parameter bits (exactly x, 0%Z) = Some a -> contains bits (sqr bits a) (Claim.value x ^ 2).
Proof.
  intros x a e. apply sqr_sound, (enclose_parameter_sound bits _ _ _ e), within_scaled. unfold within, exactly. cbn [least greatest]. lra.
Qed.

Lemma literals_exact : forall e, Forall2 scaled_within (literals e) (map (fun p => Claim.value (least (fst p))) (literals e)).
Proof.
  induction e; cbn [literals]; try assumption; try (rewrite map_app; apply Forall2_app; assumption); [| constructor].
  constructor; [| constructor]. apply within_scaled. unfold within, exactly. cbn. lra.
Qed.

Lemma exact_list : forall (A : Type) (f : A -> list parameter),
  (forall a, exists y, Forall2 scaled_within (f a) y) -> forall l, exists y, Forall2 scaled_within (flat_map f l) y.
Proof.
  intros A f h. induction l as [| a l [y IH]]; [exists []; constructor |]. destruct (h a) as [z H].
  exists (z ++ y). cbn [flat_map]. apply Forall2_app; assumption.
Qed.

Lemma holds_at_of : forall front ps th back, Forall2 scaled_within ps th -> holds_at (front ++ th ++ back) (length front) ps.
Proof.
  intros front ps th back h i p n. rewrite app_nth2_plus. revert i n.
  induction h as [| q y ps th hq h IH]; intros [| i] n; try discriminate; cbn [nth_error app nth] in *; [injection n as <-; exact hq | exact (IH i n)].
Qed.

(** What a test shows of the rows' |M v|^2. *)
Lemma demand_fulfilled : forall d t n c r, written_test d = Some t ->
  (forall v, energy r v = speed2 (jacobian c) v) ->
  match t with
  | SigmaMin low => forall k v, contains bits low k -> length v = n -> nonzero v -> k * dot v v < energy r v
  | SigmaMax high => forall k v, contains bits high k -> length v = n -> nonzero v -> energy r v < k * dot v v
  | Conditioning c2 => forall c u v, contains bits c2 c -> length u = n -> length v = n -> nonzero u -> nonzero v ->
      energy r u * dot v v < c * energy r v * dot u u
  | _ => False
  end ->
  fulfils n c d /\ (excludes_singularities d = true -> injective n c).
Proof.
  intros d t n c r e E H.
  assert (Z : forall v, ~ nonzero v -> dot v v = 0 /\ speed2 (jacobian c) v = 0).
  { intros v z. assert (dot v v <= 0) by (apply Rnot_lt_le; exact z). pose proof (zero_vector v ltac:(assumption)) as F. split; [apply dot_zero, F |].
    unfold speed2. clear - F. induction (jacobian c) as [| row M IH]; cbn [fold_right]; [reflexivity |]. rewrite IH, (dot_zero v row F). ring. }
  assert (N : forall v, nonzero v \/ ~ nonzero v) by (intro v; destruct (Rlt_dec 0 (dot v v)); auto).
  destruct d as [| b | b | i b | i b | i a b | b | i a b | i a b | a b]; cbn [written_test] in e; try discriminate.
  - injection e as <-. assert (J : injective n c).
    { intros v l nz. rewrite <- E. specialize (H 0 v (zero_sound bits) l nz). lra. }
    split; [exact J | intros _; exact J].
  - destruct (enclose_parameter bits _) as [a |] eqn:ea; [| discriminate]. injection e as <-. pose proof (squared_sound _ _ ea) as K.
    cbn [Claim.value] in K. replace (1 / 1) with 1 in K by field.
    assert (J : forall v, length v = n -> nonzero v -> (1 / Claim.value b) ^ 2 * dot v v < speed2 (jacobian c) v)
      by (intros v l nz; rewrite <- E; exact (H _ v K l nz)).
    split.
    + intros v l. destruct (N v) as [nz | z]; [apply Rlt_le, J; assumption | destruct (Z v z) as [-> ->]; lra].
    + intros _ v l nz. specialize (J v l nz). pose proof (pow2_ge_0 (1 / Claim.value b)). unfold nonzero in nz. nra.
  - destruct (enclose_parameter bits _) as [a |] eqn:ea; [| discriminate]. injection e as <-. pose proof (squared_sound _ _ ea) as K.
    cbn [Claim.value] in K. replace (1 / 1) with 1 in K by field. split; [| discriminate].
    intros v l. destruct (N v) as [nz | z]; [rewrite <- E; apply Rlt_le, H; assumption | destruct (Z v z) as [-> ->]; lra].
  - destruct (enclose_parameter bits _) as [a |] eqn:ea; [| discriminate]. injection e as <-. pose proof (squared_sound _ _ ea) as K.
    split; [| discriminate]. intros u v lu lv.
    destruct (N u) as [nu | zu]; [| destruct (Z u zu) as [-> ->]; lra]. destruct (N v) as [nv | zv]; [| destruct (Z v zv) as [-> ->]; lra].
    rewrite <- !E. specialize (H _ u v K lu lv nu nv). lra.
Qed.

Theorem check_written_sound : forall c t, check_written c t = true -> written_holds c.
Proof.
  intros c t h theta x [hp hb]. unfold check_written in h. cbv zeta in h. set (f := by_formulas c) in *.
  set (n := length (coordinate_names f)) in *. set (j := length (parameters f)) in *.
  set (i := (j + length (all_literals (map snd (definitions f))))%nat) in *.
  set (env := named (given_formulas f) (definitions f) j) in *.
  set (rows := map (fun a => (a, integer 1)) (rows_of env (joint_rows f) i)) in *.
  set (partial := named_partials (given_formulas f) (definitions f) j ++ rows_partials env (joint_rows f) i) in *.
  set (tape := fst (compile (entries rows ++ partial))) in *. set (place := place (formulas tape)) in *.
  apply andb_true_iff in h as [h C]. apply andb_true_iff in h as [h low]. apply andb_true_iff in h as [len found]. apply Nat.eqb_eq in len.
  destruct (all_some (map (enclose_parameter bits) (inputs f))) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map _ (box_of c))) as [box |] eqn:eb; [| discriminate].
  destruct (all_some (map written_test _)) as [tests |] eqn:et; [| discriminate].
  (* parameters of the tape: those of the mechanism, and the numbers in its formulas *)
  assert (P : Forall2 scaled_within (exact_parameters (parameters f)) theta).
  { unfold exact_parameters. clear - hp. induction hp; cbn [map]; constructor; auto. apply within_scaled; assumption. }
  destruct (exact_list written literals (fun e => ex_intro _ _ (literals_exact e)) (map snd (definitions f))) as [y1 D].
  destruct (exact_list (list written) all_literals (exact_list written literals (fun e => ex_intro _ _ (literals_exact e))) (joint_rows f)) as [y2 J].
  set (th := theta ++ y1 ++ y2).
  assert (lt : length theta = j) by (unfold j; rewrite <- (related_length _ _ _ _ _ P); apply map_length).
  assert (T : Forall2 (contains bits) params th) by (apply (enclosed_all bits _ _ _ ep); repeat apply Forall2_app; assumption).
  assert (X : Forall2 (contains bits) box x).
  { clear - eb hb. revert box eb. induction hb as [| b y bs ys h hs IH]; intros box e; cbn [map all_some] in e; [injection e as <-; constructor |].
    destruct (enclose_parameter bits (b, 0%Z)) as [a |] eqn:ea; [| discriminate]. destruct (all_some _) as [l |]; [| discriminate].
    injection e as <-. constructor; [exact (enclose_parameter_sound bits _ _ _ ea (within_scaled _ _ h)) | auto]. }
  assert (lx : length x = n) by (rewrite <- (related_length _ _ _ _ _ hb); exact len).
  assert (lb : length box = n) by (rewrite (related_length _ _ _ _ _ X); exact lx).
  assert (A : agrees x th (given_formulas f) (given f x theta)).
  { apply agrees_combine.
    - rewrite map_map. fold n. rewrite <- lx. clear. change (map (fun k => nth k x 0) (seq 0 (length x)) = x).
      apply nth_ext with 0 0; rewrite map_length, seq_length; [reflexivity |]. intros k hk.
      rewrite (nth_indep _ 0 (nth 0 x 0)) by (rewrite map_length, seq_length; exact hk). rewrite (map_nth (fun k => nth k x 0)), seq_nth by exact hk. reflexivity.
    - rewrite <- (app_nil_r (combine _ (numbered _ _))), <- (app_nil_r (combine _ theta)). apply agrees_combine; [| intro; reflexivity].
      exact (numbered_values _ _ x [] (y1 ++ y2) P). }
  assert (H1 : holds_at th j (all_literals (map snd (definitions f)))) by (rewrite <- lt; apply holds_at_of; exact D).
  assert (H2 : holds_at th i (flat_map all_literals (joint_rows f))).
  { pose proof (holds_at_of (theta ++ y1) _ y2 [] J) as K. rewrite app_nil_r, <- app_assoc in K. unfold i, th.
    replace (j + length (all_literals (map snd (definitions f))))%nat with (length (theta ++ y1)); [exact K |].
    rewrite app_length, lt. f_equal. symmetry. exact (related_length _ _ _ _ _ D). }
  destruct (named_agrees x th _ _ _ _ A H1) as [A1 D1]. fold env in A1. destruct (rows_agree x th _ _ _ _ A1 H2) as [A2 D2].
  rewrite forallb_forall in found. assert (Found : forall e, In e (entries rows ++ partial) -> formula_at tape (place e) = e)
    by (intros e k; apply Formula.same_sound, found, k).
  assert (R : map_rows (formula_at tape) (map_rows place rows) = rows) by (apply (rows_found tape); intros e k; apply Found, in_or_app; left; exact k).
  pose proof (check_all_open bits tape _ _ _ params tests (fun _ => None) th T (fun _ => True)
    (fun _ _ _ _ e => ltac:(discriminate e)) t box x C X I) as H. rewrite lb in H.
  assert (Rows : forall bound, of_rows tape (map_rows place rows) (map_rows place rows) th x bound -> bound (map_rows (value x th) rows)).
  { intros bound [r [which [_ B]]]. rewrite R in which. destruct which as [-> | ->]; exact B. }
  assert (E : forall v, energy (map_rows (value x th) rows) v = speed2 (jacobian (machine_at f theta x)) v)
    by (intro v; unfold rows; rewrite row_energy, A2; reflexivity).
  assert (Each : forall d, In d (written_demands c) -> fulfils n (machine_at f theta x) d /\
    (excludes_singularities d = true -> injective n (machine_at f theta x) /\ reached (machine_at f theta x))).
  { intros d k. assert (K : In (written_test d) (map written_test (written_demands c))) by (apply in_map, k).
    destruct (all_some_in _ _ _ _ et K) as [u [eu iu]]. specialize (H u iu).
    assert (S : excludes_singularities d = true -> reached (machine_at f theta x)).
    { intro s. assert (Q : Forall (defined x th) partial).
      { destruct d; try discriminate; cbn [written_test] in eu; [| destruct (enclose_parameter bits _); [| discriminate]]; injection eu as <-;
          destruct H as [H _]; rewrite Forall_map, Forall_forall in H; apply Forall_forall; intros e q;
          (specialize (H e q); rewrite Found in H; [exact H | apply in_or_app; right; exact q]). }
      apply Forall_app in Q as [Q1 Q2]. split; [exact (D1 Q1) | exact (D2 Q2)]. }
    enough (W : fulfils n (machine_at f theta x) d /\ (excludes_singularities d = true -> injective n (machine_at f theta x)))
      by (destruct W as [W1 W2]; split; [exact W1 | intro s; split; [exact (W2 s) | exact (S s)]]).
    apply (demand_fulfilled d u n (machine_at f theta x) (map_rows (value x th) rows) eu E).
    destruct d; cbn [written_test] in eu; try discriminate; try (destruct (enclose_parameter bits _); [| discriminate]); injection eu as <-;
      cbn [Check.holds] in H; [exact (Rows _ (proj2 H)) | exact (Rows _ (proj2 H)) | exact (Rows _ H) | exact (Rows _ H)]. }
  apply existsb_exists in low as [d0 [i0 s0]]. destruct (Each d0 i0) as [_ K0]. destruct (K0 s0) as [K1 K2].
  split; [exact K2 |]. split; [exact K1 |]. apply Forall_forall. intros d k. exact (proj1 (Each d k)).
Qed.
End Precision.

(** ** Well-formed mechanisms, and claims that are about something *)

(** Names that stand for something. *)
Fixpoint is_bound_in (ns : list string) (e : written) : bool :=
  match e with
  | Constant _ => true
  | Named n => existsb (String.eqb n) ns
  | Opposite a | Raised a _ | RootOf a => is_bound_in ns a
  | Sum a b | Difference a b | Product a b | Quotient a b => is_bound_in ns a && is_bound_in ns b
  end.
Fixpoint are_bound_in (ns : list string) (ds : list (string * written)) : bool :=
  match ds with
  | [] => true
  | (n, e) :: ds' => negb (existsb (String.eqb n) ns) && is_bound_in ns e && are_bound_in (n :: ns) ds'
  end.
Fixpoint differ (ns : list string) : bool :=
  match ns with [] => true | n :: l => negb (existsb (String.eqb n) l) && differ l end.
Definition is_mechanism (c : mechanism) : bool :=
  let given := coordinate_names c ++ map fst (parameters c) in
  let n := length (coordinate_names c) in
  Nat.leb 1 n && Nat.leb n 6 && Nat.leb n (length (joint_rows c)) && Nat.leb (length (joint_rows c)) 12 &&
  forallb (fun r => Nat.eqb (length r) n) (joint_rows c) && differ given && are_bound_in given (definitions c) &&
  forallb (forallb (is_bound_in (map fst (definitions c) ++ given))) (joint_rows c).

Definition certify_written (exact bits : positive) (c : written_claim) (t : tree) : bool :=
  is_mechanism (by_formulas c) && forallb (fun p => below exact (least (snd p)) (greatest (snd p))) (parameters (by_formulas c)) &&
  forallb (fun b => below exact (least b) (greatest b)) (box_of c) && check_written bits c t.

Theorem certify_written_sound : forall exact bits c t, certify_written exact bits c t = true ->
  written_holds c /\ exists theta x, is_about_written c theta x.
Proof.
  intros exact bits c t h. apply andb_true_iff in h as [h k]. apply andb_true_iff in h as [h b]. apply andb_true_iff in h as [_ p].
  split; [exact (check_written_sound bits c t k) |]. exists (map (fun p => Claim.value (least (snd p))) (parameters (by_formulas c))), (map (fun b => Claim.value (least b)) (box_of c)).
  rewrite forallb_forall in p, b. split.
  - induction (parameters (by_formulas c)) as [| q l IH]; cbn [map]; constructor; [| apply IH; intros y i; apply p; right; exact i].
    specialize (p q (or_introl eq_refl)). apply below_sound in p. unfold within. lra.
  - induction (box_of c) as [| q l IH]; cbn [map]; constructor; [| apply IH; intros y i; apply b; right; exact i].
    specialize (b q (or_introl eq_refl)). apply below_sound in b. unfold within. lra.
Qed.
End Named.
