(** * Rows of polynomials at control points, with tolerances apart

    At every point of a cell a formula of another machine differs by its
    derivatives, each for a machine of its own; formula and derivatives are
    weighted means of what they are at control points, with the same weights. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope Test Definite Cell Formula Control.
From Orthocert.kernel Require Tolerances.
From Orthocert.kernel Require Import Check.
Import ListNotations.
Local Open Scope R_scope.

(** ** Derivatives of polynomials, which are divided by parameters without tolerances alone *)

Fixpoint rate_of (j : nat) (f : formula) : formula :=
  match f with
  | F o => match o with
      | Coord _ | Integer _ => integer 0
      | Param i => integer (if Nat.eqb i j then 1 else 0)
      | Add a b => plus (rate_of j a) (rate_of j b)
      | Sub a b => minus (rate_of j a) (rate_of j b)
      | Neg a => opposite (rate_of j a)
      | Mul a b => plus (times b (rate_of j a)) (times a (rate_of j b))
      | Div a b => let r := rate_of j a in if is 0 r then r else Formula.over r b
      | Sqr a => times (times (integer 2) a) (rate_of j a)
      | Sqrt _ | Elbow _ _ _ _ => integer 0
      end
  end.

Section Polynomials.
Variable bits : positive.
Variable params : list fixed.
(** The parameters with tolerances. *)
Variable free : list nat.

Fixpoint is_polynomial (f : formula) : bool :=
  match f with
  | F o => match o with
      | Coord _ | Integer _ | Param _ => true
      | Add a b | Sub a b | Mul a b => is_polynomial a && is_polynomial b
      | Neg a | Sqr a => is_polynomial a
      | Div a b => is_polynomial a && match b with F (Param i) => (0 <? lo (nth i params zero))%Z && negb (existsb (Nat.eqb i) free) | _ => false end
      | Sqrt _ | Elbow _ _ _ _ => false
      end
  end.

Lemma rate_value : forall x th j f, is_polynomial f = true -> In j free -> value x th (rate_of j f) = Tolerances.rate x th j f.
Proof.
  intros x th j f h hj. revert f h. fix IH 1. intros [o] h. destruct o as [k | k | n | a b | a b | a | a b | a b | a | a | ? a b e]; cbn [is_polynomial] in h; try discriminate h.
  - reflexivity.
  - cbn [rate_of Tolerances.rate]. destruct (Nat.eqb k j); reflexivity.
  - reflexivity.
  - apply andb_true_iff in h as [h1 h2]. cbn [rate_of Tolerances.rate]. rewrite value_plus, (IH a h1), (IH b h2). reflexivity.
  - apply andb_true_iff in h as [h1 h2]. cbn [rate_of Tolerances.rate]. rewrite value_minus, (IH a h1), (IH b h2). unfold Rminus. reflexivity.
  - cbn [rate_of Tolerances.rate]. rewrite value_opposite, (IH a h). reflexivity.
  - apply andb_true_iff in h as [h1 h2]. cbn [rate_of Tolerances.rate]. rewrite value_plus, !value_times, (IH a h1), (IH b h2). reflexivity.
  - apply andb_true_iff in h as [h1 h2]. destruct b as [[| i | | | | | | | | |]]; try discriminate h2. apply andb_true_iff in h2 as [_ h2].
    assert (n : Nat.eqb i j = false).
    { destruct (Nat.eqb_spec i j) as [-> |]; [| reflexivity]. apply negb_true_iff in h2. rewrite <- h2. symmetry. apply existsb_exists. exists j. split; [exact hj | apply Nat.eqb_refl]. }
    pose proof (IH a h1) as A. cbn [rate_of Tolerances.rate]. cbv zeta. rewrite n, <- A. destruct (is 0 (rate_of j a)) eqn:z.
    + rewrite (is_value _ _ _ _ z). unfold Rdiv. ring.
    + rewrite value_over. unfold Rdiv. ring.
  - cbn [rate_of Tolerances.rate]. rewrite !value_times, (IH a h). reflexivity.
Qed.

Lemma polynomial_defined : forall x th f, is_polynomial f = true -> Forall2 (contains bits) params th -> defined x th f.
Proof.
  intros x th f h hth. revert f h. fix IH 1. intros [o] h. destruct o as [k | k | n | a b | a b | a | a b | a b | a | a | ? a b e]; cbn [is_polynomial] in h; try discriminate h;
    cbn [defined map_op defined_op all_op]; try (split; exact I); try (apply andb_true_iff in h as [h1 h2]; split; [exact I | split; [exact (IH a h1) | exact (IH b h2)]]);
    try (split; [exact I | exact (IH a h)]).
  apply andb_true_iff in h as [h1 h2]. destruct b as [[| i | | | | | | | | |]]; try discriminate h2. apply andb_true_iff in h2 as [p _]. apply Z.ltb_lt in p.
  pose proof (contains_positive bits _ _ p (nth_contains bits params th hth i)) as q. cbn [value map_op real_op defined defined_op all_op].
  split; [lra | split; [exact (IH a h1) | split; exact I]].
Qed.
End Polynomials.

(** No parameter is in the formula. *)
Fixpoint is_of_coordinates (f : formula) : bool :=
  match f with
  | F o => match o with
      | Coord _ | Integer _ => true
      | Add a b | Sub a b | Mul a b | Div a b => is_of_coordinates a && is_of_coordinates b
      | Neg a | Sqr a | Sqrt a => is_of_coordinates a
      | Param _ | Elbow _ _ _ _ => false
      end
  end.
Lemma of_coordinates_value : forall x th th' f, is_of_coordinates f = true -> value x th f = value x th' f.
Proof.
  intros x th th'. fix IH 1. intros [o] h. destruct o as [k | k | n | a b | a b | a | a b | a b | a | a | ? a b e]; cbn [is_of_coordinates] in h; try discriminate h; cbn [value map_op real_op];
    try reflexivity; try (apply andb_true_iff in h as [h1 h2]; rewrite (IH a h1), (IH b h2); reflexivity); rewrite (IH a h); reflexivity.
Qed.

(** ** Entries with their derivatives, one for each parameter with a tolerance *)

Definition multi (A : Type) : Type := A * list A.
Definition multi_rows (A : Type) : Type := list (list (multi A) * multi A).
Definition map_multi {A B : Type} (f g : A -> B) (q : multi A) : multi B := (f (fst q), map g (snd q)).
Definition map_multis {A B : Type} (f g : A -> B) (r : multi_rows A) : multi_rows B := map (fun p => (map (map_multi f g) (fst p), map_multi f g (snd p))) r.
Definition places_of_multi (q : multi nat) : list nat := fst q :: snd q.
Definition places_of_multis (r : multi_rows nat) : list nat := flat_map (fun p => flat_map places_of_multi (fst p) ++ places_of_multi (snd p)) r.

Record vsample (A : Type) := VSample { v_rows : multi_rows A; v_weight : A; v_less : option (A * Z * N) }.
Arguments VSample {A}. Arguments v_rows {A}. Arguments v_weight {A}. Arguments v_less {A}.
Definition map_less {A B : Type} (f : A -> B) (l : option (A * Z * N)) : option (B * Z * N) := option_map (fun l => (f (fst (fst l)), snd (fst l), snd l)) l.
Definition map_vsample {A B : Type} (f : A -> B) (s : vsample A) : vsample B := VSample (map_multis f f (v_rows s)) (f (v_weight s)) (map_less f (v_less s)).

Lemma map_multis_map : forall (A B C : Type) (f f' : A -> B) (g : B -> C) r, map_multis g g (map_multis f f' r) = map_multis (fun a => g (f a)) (fun a => g (f' a)) r.
Proof.
  intros A B C f f' g r. unfold map_multis. rewrite map_map. apply map_ext. intros [a d]. unfold map_multi. cbn [fst snd]. rewrite !map_map. f_equal.
  apply map_ext. intros [b l]. cbn [fst snd]. rewrite map_map. reflexivity.
Qed.
Lemma map_multis_ext : forall (A B : Type) (f g f' g' : A -> B) r, (forall a, f a = g a) -> (forall a, f' a = g' a) -> map_multis f f' r = map_multis g g' r.
Proof.
  intros A B f g f' g' r e e'. unfold map_multis. apply map_ext. intros [a d]. unfold map_multi. cbn [fst snd]. rewrite e, (map_ext _ _ e'). f_equal.
  apply map_ext. intros [b l]. cbn [fst snd]. rewrite e, (map_ext _ _ e'). reflexivity.
Qed.
Lemma map_less_map : forall (A B C : Type) (f : A -> B) (g : B -> C) l, map_less g (map_less f l) = map_less (fun a => g (f a)) l.
Proof. intros A B C f g [[[a n] p] |]; reflexivity. Qed.
Lemma map_vsample_map : forall (A B C : Type) (f : A -> B) (g : B -> C) s, map_vsample g (map_vsample f s) = map_vsample (fun a => g (f a)) s.
Proof. intros A B C f g [r w l]. unfold map_vsample. cbn [v_rows v_weight v_less]. rewrite map_multis_map, map_less_map. reflexivity. Qed.

Section Precision.
Variable bits : positive.

(** ** At a control point *)

Definition known_multi (q : multi (option fixed)) : option (Tolerances.multi slope) :=
  match fst q, all_known (snd q) with Some a, Some l => Some (constant a, map constant l) | _, _ => None end.
Definition known_varied (r : list (multi (option fixed)) * multi (option fixed)) : option (list (Tolerances.multi slope) * Tolerances.multi slope) :=
  match Check.all_some (map known_multi (fst r)), known_multi (snd r) with Some a, Some d => Some (a, d) | _, _ => None end.
(** Without changes that are zero. *)
Definition is_change (c : list fixed * fixed) : bool := negb (Tolerances.is_null (snd c :: fst c)).
Definition only_changes (r : Tolerances.varied fixed) : Tolerances.varied fixed := (fst r, filter is_change (snd r)).

Lemma only_changes_sound : forall r R, Tolerances.varied_in bits r R -> Tolerances.varied_in bits (only_changes r) R.
Proof.
  intros [b cs] R [a [d [ms [h1 [h2 [h3 [h4 h5]]]]]]]. cbn [fst snd] in *.
  assert (K : exists ms', Forall2 (fun c m => Tolerances.is_share (fst m) /\ Forall2 (contains bits) (fst c) (fst (snd m)) /\ contains bits (snd c) (snd (snd m))) (filter is_change cs) ms' /\
    (forall v, Tolerances.sum_of ms' (fun c => dot (fst c) v) = Tolerances.sum_of ms (fun c => dot (fst c) v)) /\ Tolerances.sum_of ms' snd = Tolerances.sum_of ms snd).
  { clear h4 h5. induction h3 as [| c m cs ms k h3 IH]; [exists []; repeat split; constructor |]. destruct IH as [ms' [i1 [i2 i3]]]. cbn [filter]. destruct (is_change c) eqn:e.
    - exists (m :: ms'). split; [constructor; assumption |]. unfold Tolerances.sum_of in *. cbn [fold_right]. split; [intro v; rewrite i2; reflexivity | rewrite i3; reflexivity].
    - exists ms'. split; [exact i1 |]. unfold is_change in e. apply negb_false_iff in e. destruct k as [_ [k1 k2]].
      assert (Z : forall v, dot (snd (snd m) :: fst (snd m)) v = 0) by (apply (Tolerances.null_sound bits _ _ e); constructor; assumption).
      unfold Tolerances.sum_of in *. cbn [fold_right]. split.
      + intro v. rewrite i2. specialize (Z (0 :: v)). cbn [dot] in Z. replace (dot (fst (snd m)) v) with 0 by lra. ring.
      + rewrite i3. specialize (Z [1]). cbn [dot] in Z. destruct (fst (snd m)); cbn [dot] in Z; replace (snd (snd m)) with 0 by lra; ring. }
  destruct K as [ms' [i1 [i2 i3]]]. exists a, d, ms'. cbn [only_changes fst snd]. split; [exact h1 |]. split; [exact h2 |]. split; [exact i1 |].
  split; [intro v; rewrite i2; apply h4 | rewrite i3; exact h5].
Qed.

(** Of all directions, or of those of a wedge. *)
Definition wedge : Type := list Z * list Z * Z * N.
Definition in_part (part : option wedge) (v : list R) : Prop := match part with Some (b, c, _, _) => Toward.in_wedge b c v | None => True end.
Definition changed_lower (n : nat) (places : N) (Y : list (list Z)) (direction : list Z) (part : option wedge) (rows : list (Tolerances.varied fixed)) (a : fixed) : bool :=
  match part with
  | None => match Tolerances.lower_apart bits (map (Fixed.integer bits) direction) places Y rows (repeat [neg a] n) with Some t => Solve.is_definite bits n t | None => false end
  | Some (b, c, z, pl) => let '(i, u, q, d) := Check.toward_of bits direction in let u' := map (fun x => Arithmetic.dyadic x q (Fixed.integer bits 1)) u in
      Nat.eqb (length u) n && Nat.eqb (length b) n && (0 <=? z)%Z && (pl <? 64)%N && Nat.ltb i n && negb (nth i u 0 =? 0)%Z &&
      match Toward.lower_toward bits i u' d places Y rows (Toward.less_wedge bits i u' b c z pl (Toward.squares bits i u' n (neg a) [])) with Some t => Solve.is_definite bits n t | None => false end
  end.
Lemma changed_lower_shows : forall n places Y direction part rows R a A v, changed_lower n places Y direction part rows a = true -> Forall2 (Tolerances.varied_in bits) rows R -> contains bits a A ->
  length v = n -> nonzero v -> in_part part v -> A * dot v v < form (lower_weights places Y v) R v.
Proof.
  intros n places Y direction [[[[b c] z] pl] |] rows R a A v h hr ha lv nz iv; cbn [changed_lower in_part] in *.
  - destruct (Check.toward_of bits direction) as [[[i u] q] d]. apply andb_true_iff in h as [g h]. apply andb_true_iff in g as [g rg]. apply andb_true_iff in g as [g kb]. apply andb_true_iff in g as [g _].
    apply andb_true_iff in g as [g z0]. apply andb_true_iff in g as [lu _]. apply Nat.eqb_eq in lu. rewrite <- (repeat_length zero n) in lu, kb, lv, h. rewrite (repeat_length zero n) in lu.
    exact (Check.lower_wedge_shows bits (repeat zero n) (repeat 0 n) ltac:(rewrite !repeat_length; reflexivity) b c z pl z0 i u q d ltac:(rewrite repeat_length; exact lu) kb rg a A places Y rows R v h hr ha lv nz iv).
  - exact (Check.lower_apart_shows bits _ a A places Y rows R v n h hr ha lv nz).
Qed.

Definition varied_lower_at (n : nat) (places : N) (Y : list (list Z)) (direction : list Z) (part : option wedge) (steps : list (list fixed)) (k : fixed) (s : vsample (option fixed)) : bool :=
  match Check.all_some (map known_varied (v_rows s)), v_weight s, known_multiple (v_less s) with
  | Some rows, Some w, Some t => changed_lower n places Y direction part (map (fun r => only_changes (Tolerances.varied_at bits [] steps r)) rows) (add (mul bits k w) t)
  | _, _, _ => false
  end.

Section Tape.
Variable tape : list (op address).
Variable params : list fixed.
Variable thin : list (op address).
Hypothesis thin_is : is_thinned thin tape.
(** The parameters with tolerances, and where the one machine is. *)
Variable ends : list (nat * Tolerances.choice).
Variable m : nat.

Definition varied_tensors (cell : list fixed) (rows : multi_rows nat) (w : nat) (l : multiple) : vsample tensor :=
  let own := tensors bits (Tolerances.starts_from ends 0 params) thin cell in let all := tensors bits params thin cell in
  let look ts i := nth i ts (Constant None) in
  VSample (map_multis (look own) (look all) rows) (look all w) (map_less (look all) l).

(** Squares of the first [e] coordinates are in D alone, with the factor w, and in no derivative. *)
Definition is_eased_varied (e : nat) (rows : multi_rows nat) (w : nat) (l : multiple) : bool :=
  let at_ i := entry_at tape i in
  is_of_coordinates (at_ w) &&
  forallb (fun k => is_free m k (at_ w)
    && forallb (fun p => forallb (fun i => is_without (m + k) (at_ i)) (flat_map places_of_multi (fst p) ++ snd (snd p)) && rises (at_ w) (m + k) (at_ (fst (snd p)))) rows
    && match l with Some (g, _, _) => is_without (m + k) (at_ g) | None => true end) (seq 0 e).

Definition is_varied_affine (rows : multi_rows nat) (w : nat) (l : multiple) : bool :=
  forallb (is_affine_at tape m) (w :: places_of_multis rows) && is_affine_multiple tape m l.

Variable theta : list R.
Hypothesis theta_in : Forall2 (contains bits) params theta.
Variables (cell : list fixed) (x : list R).
Hypothesis x_in : Forall2 (contains bits) cell x.
Hypothesis dimension : length cell = m.

(** What an entry and its derivatives stand for. *)
Definition entry_stands (q : multi nat) (f : formula) : Prop :=
  entry_at tape (fst q) = image m f /\ map (entry_at tape) (snd q) = map (fun p => image m (rate_of (fst p) f)) ends /\
  is_polynomial params (map fst ends) f = true /\ is_below m f = true /\ Forall (fun p => is_below m (rate_of (fst p) f) = true) ends.
Definition row_stands (r : list (multi nat) * multi nat) (p : list formula * formula) : Prop := Forall2 entry_stands (fst r) (fst p) /\ entry_stands (snd r) (snd p).

Hypothesis once : Check.are_once (map fst ends) = true.
Hypothesis exist : forallb (fun j => Nat.ltb j (length params)) (map fst ends) = true.

Section Machine.
Variables (theta0 : list R) (mss : list (list (R * R))).
Hypothesis h0 : Forall2 (contains bits) (Tolerances.starts_from ends 0 params) theta0.
Hypothesis h1 : Forall2 (contains bits) params theta0.
Hypothesis same_rest : forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0.
Hypothesis stepped : Forall2 (Tolerances.stepped bits) (Tolerances.steps ends params) mss.
Hypothesis strides : Forall2 (fun p ms => nth (fst p) theta 0 - nth (fst p) theta0 0 = Tolerances.stride ms) ends mss.
Local Notation ds := (map Tolerances.stride mss).

(** An entry at pairs, with the machine at which its derivatives are taken. *)
Definition at_varied (ps : list (R * R)) (q : multi nat * list R) : R :=
  at_pairs theta0 (entry_at tape (fst (fst q))) ps + dot ds (map (fun i => at_pairs (snd q) (entry_at tape i) ps) (snd (fst q))).
Definition row_varied (ps : list (R * R)) (r : list (multi nat * list R) * (multi nat * list R)) : list R * R := (map (at_varied ps) (fst r), at_varied ps (snd r)).
Definition machine_in (q : multi nat * list R) : Prop := Forall2 (contains bits) params (snd q).

Lemma entry_varied : forall q f, entry_stands q f -> length x = m -> exists th, Forall2 (contains bits) params th /\ value x theta f = at_varied (parabola x) (q, th).
Proof.
  intros q f [e [es [po [be bes]]]] lx. pose proof (Check.are_once_sound _ once) as nd.
  destruct (Tolerances.mean_value bits (map fst ends) x params theta0 theta f nd h1 theta_in (fun th h => polynomial_defined bits params _ x th f po h) same_rest) as [th [hth E]].
  exists th. split; [exact hth |]. unfold at_varied. cbn [fst snd]. rewrite e, <- lx, image_value by (rewrite lx; exact be). rewrite E. f_equal.
  rewrite <- (map_map (entry_at tape) (fun f => at_pairs th f (parabola x))), es, map_map.
  assert (K : forall (es : list (nat * Tolerances.choice)) mss, Forall2 (fun p ms => nth (fst p) theta 0 - nth (fst p) theta0 0 = Tolerances.stride ms) es mss -> (forall p, In p es -> In (fst p) (map fst ends)) ->
    Forall (fun p => is_below m (rate_of (fst p) f) = true) es ->
    Tolerances.sum_over (map fst es) (fun j => (nth j theta 0 - nth j theta0 0) * Tolerances.rate x th j f) =
    dot (map Tolerances.stride mss) (map (fun p => at_pairs th (image m (rate_of (fst p) f)) (parabola x)) es)).
  { clear - po lx. induction 1 as [| p ms es mss k hs IH]; intros i b; [reflexivity |]. inversion b as [| ? ? b1 b2]; subst. cbn [map Tolerances.sum_over fold_right dot].
    unfold Tolerances.sum_over in IH. rewrite IH by (try exact b2; intros q iq; apply i; right; exact iq). rewrite k, image_value by exact b1.
    rewrite (rate_value params (map fst ends) x th (fst p) f po) by (apply i; left; reflexivity). reflexivity. }
  exact (K ends mss strides (in_map (@fst nat Tolerances.choice) ends) bes).
Qed.

Lemma entries_varied : forall a fs, Forall2 entry_stands a fs -> length x = m -> exists l, map fst l = a /\ Forall machine_in l /\ map (value x theta) fs = map (at_varied (parabola x)) l.
Proof.
  intros a fs h lx. induction h as [| q f a fs k h [l [e1 [e2 e3]]]]; [exists []; repeat split; constructor |].
  destruct (entry_varied q f k lx) as [th [t1 t2]]. exists ((q, th) :: l). cbn [map fst]. rewrite e1, e3, t2. repeat split; constructor; assumption.
Qed.
Lemma rows_varied : forall rows fs, Forall2 row_stands rows fs -> length x = m -> exists L, map (fun r => (map fst (fst r), fst (snd r))) L = rows /\
  Forall (fun r => Forall machine_in (fst r) /\ machine_in (snd r)) L /\ map_rows (value x theta) fs = map (row_varied (parabola x)) L.
Proof.
  intros rows fs h lx. induction h as [| [a d] [A D] rows fs [ha hd] h [L [e1 [e2 e3]]]]; [exists []; repeat split; constructor |]. cbn [fst snd] in *.
  destruct (entries_varied a A ha lx) as [l [l1 [l2 l3]]]. destruct (entry_varied d D hd lx) as [th [t1 t2]].
  exists ((l, (d, th)) :: L). rewrite map_rows_cons. cbn [map fst snd]. rewrite e1, e3, l1. unfold row_varied at 1. cbn [fst snd]. rewrite l3, t2.
  repeat split; constructor; try assumption. split; assumption.
Qed.

(** *** Such rows are affine in each pair, and fall *)

Lemma at_varied_affine : forall q, forallb (is_affine_at tape m) (places_of_multi (fst q)) = true -> affine_there m (fun ps => at_varied ps q).
Proof.
  intros [[i js] th] h before after u v w p r s l e. cbn [fst places_of_multi forallb snd] in h. apply andb_true_iff in h as [h1' h2]. unfold at_varied. cbn [fst snd].
  rewrite (entry_affine tape theta0 m i h1' before after u v w p r s l e).
  assert (K : forall D, dot D (map (fun i => at_pairs th (entry_at tape i) (before ++ mean u v w p r s :: after)) js) = u * dot D (map (fun i => at_pairs th (entry_at tape i) (before ++ p :: after)) js)
    + v * dot D (map (fun i => at_pairs th (entry_at tape i) (before ++ r :: after)) js) + w * dot D (map (fun i => at_pairs th (entry_at tape i) (before ++ s :: after)) js)).
  { clear - h2 l e. induction js as [| j js IH]; intros [| y D]; cbn [map dot]; try ring. cbn [forallb] in h2. apply andb_true_iff in h2 as [h1 h2].
    rewrite (IH h2 D), (entry_affine tape th m j h1 before after u v w p r s l e). ring. }
  rewrite K. ring.
Qed.

Lemma form_varied_affine : forall L weights v, forallb (is_affine_at tape m) (places_of_multis (map (fun r => (map fst (fst r), fst (snd r))) L)) = true ->
  affine_there m (fun ps => form weights (map (row_varied ps) L) v).
Proof.
  intros L weights z h before after u v w p r s l e. revert weights. induction L as [| [a d] L IH]; intros [| [y t] ws]; cbn [map form]; try ring.
  cbn [map places_of_multis flat_map fst snd] in h. rewrite !forallb_app in h. apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [ha hd].
  specialize (IH h3 ws). cbn [row_varied fst snd] in *.
  assert (D : forall a z, forallb (is_affine_at tape m) (flat_map places_of_multi (map fst a)) = true ->
    dot (map (at_varied (before ++ mean u v w p r s :: after)) a) z = u * dot (map (at_varied (before ++ p :: after)) a) z
      + v * dot (map (at_varied (before ++ r :: after)) a) z + w * dot (map (at_varied (before ++ s :: after)) a) z).
  { clear - l e. induction a as [| q a IHa]; intros [| y z] k; cbn [map dot]; try ring. cbn [map flat_map] in k. rewrite forallb_app in k. apply andb_true_iff in k as [k1 k2].
    rewrite (IHa z k2), (at_varied_affine q k1 before after u v w p r s l e). ring. }
  unfold row_varied in *. cbn [fst snd] in *. rewrite IH, (D a z ha), (at_varied_affine d hd before after u v w p r s l e). ring.
Qed.

Lemma form_varied_falls : forall e w l L weights c d v, is_eased_varied e (map (fun r => (map fst (fst r), fst (snd r))) L) w l = true -> length x = m ->
  0 <= at_pairs theta (entry_at tape w) (parabola x) -> Forall (fun q => snd q <= 0) weights ->
  falls e x (fun ps => form weights (map (row_varied ps) L) v + c * at_pairs theta (entry_at tape w) ps + d * less_at tape theta ps l).
Proof.
  intros e w l L weights c d v h lx w0 hw before front z after s ex lb le zs. unfold is_eased_varied in h. cbv zeta in h. apply andb_true_iff in h as [wc h]. rewrite forallb_forall in h.
  assert (E : m = S (length before + length after)) by (rewrite <- lx, ex, app_length, lb; cbn [length]; lia).
  assert (Lp : length (parabola after) = length after) by apply map_length.
  assert (hk := h (length before) ltac:(apply in_seq; lia)). apply andb_true_iff in hk as [hk hl]. apply andb_true_iff in hk as [fw hr].
  assert (W : forall th f, is_without (m + length before) f = true -> at_pairs th f (before ++ (z, s) :: parabola after) = at_pairs th f (before ++ (z, z ^ 2) :: parabola after)).
  { intros th f q. apply without_value. rewrite Lp, <- E. exact q. }
  assert (WW : at_pairs theta (entry_at tape w) (before ++ (z, s) :: parabola after) = at_pairs theta (entry_at tape w) (before ++ (z, z ^ 2) :: parabola after)).
  { apply free_value. rewrite Lp, <- E. exact fw. }
  assert (W0 : 0 <= at_pairs theta0 (entry_at tape w) (before ++ (z, z ^ 2) :: parabola after)).
  { unfold at_pairs at 1. rewrite (of_coordinates_value _ theta0 theta _ wc). fold (at_pairs theta (entry_at tape w) (before ++ (z, z ^ 2) :: parabola after)).
    replace (at_pairs theta (entry_at tape w) (before ++ (z, z ^ 2) :: parabola after)) with (at_pairs theta (entry_at tape w) (parabola x)); [exact w0 |].
    rewrite ex. unfold parabola. rewrite map_app. cbn [map]. fold (parabola after).
    apply (prefix_value theta (entry_at tape w) m); [rewrite map_length; congruence | rewrite app_length, map_length; cbn [length]; rewrite Lp; lia |].
    intros k i. rewrite map_length in i. specialize (h k ltac:(apply in_seq; lia)). apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [h _]. exact h. }
  assert (LL : less_at tape theta (before ++ (z, s) :: parabola after) l = less_at tape theta (before ++ (z, z ^ 2) :: parabola after) l).
  { destruct l as [[[g n] places] |]; cbn [less_at]; [rewrite (W theta _ hl); reflexivity | reflexivity]. }
  rewrite WW, LL. apply Rplus_le_compat_r, Rplus_le_compat_r. clear h LL WW.
  assert (Rest : forall js th D, forallb (fun i => is_without (m + length before) (entry_at tape i)) js = true ->
    dot D (map (fun i => at_pairs th (entry_at tape i) (before ++ (z, s) :: parabola after)) js) = dot D (map (fun i => at_pairs th (entry_at tape i) (before ++ (z, z ^ 2) :: parabola after)) js)).
  { intros js th D k. f_equal. apply map_ext_in. intros i ii. apply W. rewrite forallb_forall in k. apply k, ii. }
  revert L hr. induction hw as [| [y q] ws q0 hw IH]; intros [| [a b] L] hr; try apply Rle_refl. cbn [map form].
  cbn [map forallb fst snd] in hr. apply andb_true_iff in hr as [hr1 hr]. apply andb_true_iff in hr1 as [ha hb]. rewrite forallb_app in ha. apply andb_true_iff in ha as [ha hd]. specialize (IH L hr).
  unfold row_varied at 1 3. cbn [fst snd].
  assert (A : map (at_varied (before ++ (z, s) :: parabola after)) a = map (at_varied (before ++ (z, z ^ 2) :: parabola after)) a).
  { clear - ha W Rest. induction a as [| [[i js] th] a IH]; [reflexivity |]. cbn [map flat_map fst places_of_multi snd app forallb] in *. apply andb_true_iff in ha as [h1 ha].
    rewrite forallb_app in ha. apply andb_true_iff in ha as [h2 ha]. rewrite (IH ha). f_equal. unfold at_varied. cbn [fst snd]. rewrite (W theta0 _ h1), (Rest js th _ h2). reflexivity. }
  assert (B : at_varied (before ++ (z, s) :: parabola after) b >= at_varied (before ++ (z, z ^ 2) :: parabola after) b).
  { apply Rle_ge. unfold at_varied. rewrite (Rest _ (snd b) _ hd). apply Rplus_le_compat_r.
    apply (rises_value theta0 before (parabola after) (entry_at tape w)); [rewrite Lp, <- E; exact hb | exact W0 | exact zs]. }
  apply Rge_le in B. rewrite A. cbn [snd] in q0. pose proof (Rmult_le_compat_neg_l q _ _ q0 B). lra.
Qed.

(** *** At a control point *)

Local Notation look ps_ q := (fun i => nth i (evaluate_at bits ps_ thin q) None).

Lemma known_multi_sound : forall q ps i th s, Forall2 (in_pair bits) q ps -> Forall2 (contains bits) params th ->
  known_multi (map_multi (look (Tolerances.starts_from ends 0 params) q) (look params q) i) = Some s ->
  exists e, Tolerances.multi_in bits s e /\ at_lambda [] (Tolerances.moved (fst e) ds (snd e)) = at_varied ps (i, th).
Proof.
  intros q ps [i js] th s hq hth h. unfold known_multi, map_multi in h. cbn [fst snd] in h.
  pose proof (evaluate_at_sound bits tape _ theta0 h0 thin thin_is q ps hq i) as V. destruct (nth i _ None) as [a |]; [| discriminate].
  destruct (all_known _) as [l |] eqn:el; [| discriminate]. injection h as <-.
  pose proof (all_known_sound bits tape params th hth thin thin_is q ps js l hq el) as D.
  exists ((at_pairs theta0 (entry_at tape i) ps, []), map (fun j => (at_pairs th (entry_at tape j) ps, [])) js). split.
  - split; cbn [fst snd]; [apply constant_in, V |]. rewrite <- (map_map (fun j => at_pairs th (entry_at tape j) ps) (fun y => (y, []))).
    eapply map_related; [| exact D]. intros b y hb. apply constant_in, hb.
  - rewrite Tolerances.at_moved. cbn [fst snd]. rewrite at_constant, map_map. unfold at_varied. cbn [fst snd]. f_equal. f_equal. apply map_ext. intro j. apply at_constant.
Qed.

Lemma known_row_sound : forall q ps r s, Forall2 (in_pair bits) q ps -> Forall machine_in (fst r) -> machine_in (snd r) ->
  known_varied (map (map_multi (look (Tolerances.starts_from ends 0 params) q) (look params q)) (map fst (fst r)), map_multi (look (Tolerances.starts_from ends 0 params) q) (look params q) (fst (snd r))) = Some s ->
  Tolerances.varied_in bits (only_changes (Tolerances.varied_at bits [] (Tolerances.steps ends params) s)) (row_varied ps r).
Proof.
  intros q ps [a [d th]] s hq ha hd h. cbn [fst snd] in *. unfold known_varied in h. cbn [fst snd] in h.
  destruct (Check.all_some _) as [l |] eqn:el; [| discriminate]. destruct (known_multi _) as [b |] eqn:eb in h; [| discriminate]. injection h as <-.
  destruct (known_multi_sound q ps d th b hq hd eb) as [e [e1 e2]].
  assert (K : exists es, Forall2 (Tolerances.multi_in bits) l es /\ map (fun e => at_lambda [] (Tolerances.moved (fst e) ds (snd e))) es = map (at_varied ps) a).
  { clear - ha el hq h0 thin_is. revert l el. induction ha as [| [i th] a hi ha IH]; intros l el; cbn [map fst Check.all_some] in el; [injection el as <-; exists []; split; constructor |].
    destruct (known_multi _) as [s |] eqn:es in el; [| discriminate]. destruct (Check.all_some _) as [l' |] eqn:e' in el; [| discriminate]. injection el as <-.
    destruct (IH l' e') as [es' [k1 k2]]. destruct (known_multi_sound q ps i th s hq hi es) as [e [e1 e2]]. exists (e :: es'). split; [constructor; assumption |]. cbn [map]. rewrite e2, k2. reflexivity. }
  destruct K as [es [k1 k2]]. apply only_changes_sound.
  pose proof (Tolerances.varied_at_sound bits [] (Tolerances.steps ends params) (l, b) es e mss k1 e1 stepped) as V. cbv zeta in V. cbn [map] in V. rewrite k2, e2 in V. exact V.
Qed.

Lemma known_rows_varied : forall q ps L s, Forall2 (in_pair bits) q ps -> Forall (fun r => Forall machine_in (fst r) /\ machine_in (snd r)) L ->
  Check.all_some (map known_varied (map_multis (look (Tolerances.starts_from ends 0 params) q) (look params q) (map (fun r => (map fst (fst r), fst (snd r))) L))) = Some s ->
  Forall2 (Tolerances.varied_in bits) (map (fun r => only_changes (Tolerances.varied_at bits [] (Tolerances.steps ends params) r)) s) (map (row_varied ps) L).
Proof.
  intros q ps L s hq hL. revert s. induction hL as [| r L [ha hd] hL IH]; intros s h; cbn [map map_multis Check.all_some fst snd] in h; [injection h as <-; constructor |].
  destruct (known_varied _) as [t |] eqn:et in h; [| discriminate]. destruct (Check.all_some _) as [s' |] eqn:es in h; [| discriminate]. injection h as <-. cbn [map].
  constructor; [exact (known_row_sound q ps r t hq ha hd et) | exact (IH s' es)].
Qed.
End Machine.

Theorem varied_form : forall rows fs w l e n places Y direction part kappa2 k v, Forall2 row_stands rows fs -> is_varied_affine rows w l = true ->
  is_eased_varied e rows w l = true -> 0 <= at_pairs theta (entry_at tape w) (parabola x) ->
  everywhere (@map_vsample) e m (varied_lower_at n places Y direction part (Tolerances.steps ends params) kappa2) (varied_tensors cell rows w l) = true ->
  contains bits kappa2 k -> length v = n -> nonzero v -> in_part part v ->
  0 < form (lower_weights places Y v) (map_rows (value x theta) fs) v + - (k * dot v v) * at_pairs theta (entry_at tape w) (parabola x) + - dot v v * less_at tape theta (parabola x) l.
Proof.
  intros rows fs w l e n places Y direction part kappa2 k v hs ha he w0 H hk lv nz iv.
  assert (lx : length x = m) by (rewrite <- (related_length _ _ _ _ _ x_in); exact dimension).
  destruct (Check.strides bits params theta theta_in ends exist once) as [theta0 [mss [h0 [h1 [rest [st sd]]]]]].
  destruct (rows_varied theta0 mss h1 rest sd rows fs hs lx) as [L [L1 [L2 L3]]]. rewrite L3.
  unfold is_varied_affine in ha. apply andb_true_iff in ha as [ha hl]. cbn [forallb] in ha. apply andb_true_iff in ha as [hw ha].
  apply (decide bits m cell x x_in dimension (fun ps => form (lower_weights places Y v) (map (row_varied theta0 mss ps) L) v + - (k * dot v v) * at_pairs theta (entry_at tape w) ps + - dot v v * less_at tape theta ps l) e).
  - intros before after a b c p q s len su. rewrite <- L1 in ha. rewrite (form_varied_affine theta0 mss L _ v ha before after a b c p q s len su),
      (entry_affine tape theta m w hw before after a b c p q s len su), (multiple_affine tape theta m l hl before after a b c p q s len su). ring.
  - apply (form_varied_falls theta0 mss); [rewrite L1; exact he | exact lx | exact w0 |]. unfold lower_weights. rewrite Forall_map. apply Forall_forall. intros y _. cbn [snd].
    pose proof (pow2_ge_0 (dot (map (Y_value places) y) v)). lra.
  - intros p ps lp ep rq. pose proof (everywhere_sound _ map_vsample_map _ _ _ _ H p lp ep) as G. unfold varied_tensors in G. cbv zeta in G. unfold map_vsample in G. cbn [v_rows v_weight v_less] in G.
    rewrite map_multis_map, map_less_map in G.
    rewrite (map_multis_ext _ _ _ (fun i => nth i (evaluate_at bits (Tolerances.starts_from ends 0 params) thin (points bits cell p)) None) _ (fun i => nth i (evaluate_at bits params thin (points bits cell p)) None)) in G
      by (intro i; apply tensors_value; congruence).
    rewrite (tensors_value bits params thin cell p) in G by congruence.
    assert (EL : map_less (fun i => value_at (nth i (tensors bits params thin cell) (Constant None)) p) l = map_less (fun i => nth i (evaluate_at bits params thin (points bits cell p)) None) l)
      by (destruct l as [[[g z] pl] |]; cbn [map_less option_map fst snd]; [rewrite tensors_value by congruence |]; reflexivity).
    cbn beta in G. rewrite EL in G. clear EL. unfold varied_lower_at in G. cbn [v_rows v_weight v_less] in G.
    destruct (Check.all_some _) as [s |] eqn:es in G; [| discriminate]. rewrite <- L1 in es. pose proof (known_rows_varied theta0 mss h0 st _ ps L s rq L2 es) as S.
    pose proof (evaluate_at_sound bits tape params theta theta_in thin thin_is _ ps rq w) as W. destruct (nth w (evaluate_at _ _ _ _) None) as [b |]; [| discriminate].
    destruct (known_multiple (map_less _ l)) as [t |] eqn:et in G; [| discriminate].
    assert (T : contains bits t (less_at tape theta ps l)).
    { destruct l as [[[g z] pl] |]; cbn [known_multiple map_less less_at option_map fst snd] in et |- *; [| injection et as <-; apply zero_sound].
      pose proof (evaluate_at_sound bits tape params theta theta_in thin thin_is _ ps rq g) as V. destruct (nth g _ None) as [a |]; [| discriminate]. injection et as <-. apply Arithmetic.dyadic_sound, V. }
    pose proof (changed_lower_shows n places Y direction part _ _ _ (k * at_pairs theta (entry_at tape w) ps + less_at tape theta ps l) v G S (add_sound bits _ _ _ _ (mul_sound bits _ _ _ _ hk W) T) lv nz iv). lra.
Qed.
End Tape.
End Precision.

(** ** What is checked of rows, and shown of a cell *)

Definition formulas_of_multi (q : multi formula) : list formula := fst q :: snd q.
Definition formulas_of_multis (r : multi_rows formula) : list formula := flat_map (fun p => flat_map formulas_of_multi (fst p) ++ formulas_of_multi (snd p)) r.
Definition are_affine (m : nat) (l : list formula) : bool := forallb (fun f => forallb (fun k => is_affine m k f) (seq 0 m)) l.
Definition are_eased (m e : nat) (F : multi_rows formula) (w : formula) (g : option formula) : bool :=
  is_of_coordinates w &&
  forallb (fun k => is_free m k w
    && forallb (fun p => forallb (is_without (m + k)) (flat_map formulas_of_multi (fst p) ++ snd (snd p)) && rises w (m + k) (fst (snd p))) F
    && match g with Some g => is_without (m + k) g | None => true end) (seq 0 e).
Definition same_numbers (a b : list nat) : bool := if list_eq_dec Nat.eq_dec a b then true else false.

(** Rows of which some form is positive along each direction have no strut of length zero. *)
Lemma regular_by_each : forall n r, length r = n -> grounded r -> (forall v, length v = n -> nonzero v -> exists places Y, 0 < form (lower_weights places Y v) r v) -> positive_D r.
Proof.
  assert (L : forall r, grounded r -> ~ positive_D r -> exists l, (length l < length r)%nat /\ forall v, Forall (fun a => dot a v = 0) l -> forall places Y, form (lower_weights places Y v) r v <= 0).
  { assert (All : forall r v, Forall (fun p : list R * R => 0 <= snd p /\ (snd p = 0 -> forall v, dot (fst p) v = 0)) r -> Forall (fun a => dot a v = 0) (map fst r) -> forall places Y, form (lower_weights places Y v) r v <= 0).
    { intros r v g. induction g as [| [a d] r [d0 _] g IH]; intros h places [| y Y]; cbn [map lower_weights form fst snd] in *; try lra. inversion h as [| ? ? h1 h2]; subst. specialize (IH h2 places Y). unfold lower_weights in IH.
      rewrite h1. pose proof (pow2_ge_0 (dot (map (Y_value places) y) v)). nra. }
    intros r g. induction g as [| [a d] r [d0 hd] g IH]; intro n; [destruct n; constructor |]. cbn [fst snd] in *. destruct (Rle_lt_or_eq_dec 0 d d0) as [p | e].
    - destruct IH as [l [k h]]; [intro q; apply n; constructor; assumption |]. exists (a :: l). split; [cbn [length]; lia |].
      intros v hv places [| y Y]; cbn [lower_weights map form]; [lra |]. inversion hv as [| ? ? h1 h2]; subst. specialize (h v h2 places Y). unfold lower_weights in h. rewrite h1. pose proof (pow2_ge_0 (dot (map (Y_value places) y) v)). nra.
    - exists (map fst r). split; [cbn [length]; rewrite map_length; lia |]. intros v hv places [| y Y]; cbn [lower_weights map form]; [lra |]. pose proof (All r v g hv places Y) as h. unfold lower_weights in h. rewrite (hd (eq_sym e)), <- e. lra. }
  intros n r lr g H. destruct (Forall_dec (fun p : list Rdefinitions.R * Rdefinitions.R => 0 < snd p) (fun p => Rlt_dec 0 (snd p)) r) as [p | p]; [exact p |]. exfalso.
  destruct (L r g p) as [l [k h]]. destruct (orthogonal_exists n l ltac:(lia)) as [v [lv [nv hv]]]. destruct (H v lv nv) as [places [Y q]]. specialize (h v hv places Y). lra.
Qed.

Section Claim.
Variable bits : positive.
(** Coordinates, how many have ends alone, rows and their factor, and what is not negative; parameters, and those with tolerances. *)
Variables (m ends : nat) (rs : rows formula) (w : formula) (g : option formula) (params : list fixed) (free : list nat).

Definition own_multi (f : formula) : multi formula := (image m f, map (fun j => image m (rate_of j f)) free).
Definition own_multis : multi_rows formula := map (fun p => (map own_multi (fst p), own_multi (snd p))) rs.
Definition varied_wanted (F : multi_rows formula) : list formula := image m w :: match g with Some g => [image m g] | None => [] end ++ formulas_of_multis F.

Definition is_fit (f : formula) : bool := is_polynomial params free f && is_below m f && forallb (fun j => is_below m (rate_of j f)) free.
Definition are_fit (F : multi_rows formula) (all : list formula) : bool :=
  forallb (fun f => same (nth (place all f) all (integer 0)) f) (varied_wanted F) && are_affine m (varied_wanted F) &&
  are_eased m ends F (image m w) (option_map (image m) g) && forallb (fun p => forallb is_fit (fst p) && is_fit (snd p)) rs.

(** [k]: the square of the least singular value, [e]: of how many coordinates the test has ends alone. *)
Definition shows_part (tape : list (op address)) (placed : multi_rows nat) (placed_w : nat) (placed_g : option nat) (cell : list fixed) (k : fixed) (part : option wedge) (by_ : evidence) : bool :=
  let shows es v l places Y := everywhere (@map_vsample) ends m (varied_lower_at bits m places Y v part (Tolerances.steps es params) k) (varied_tensors bits params tape es cell placed placed_w l) in
  match by_ with
  | ByTolerances (AtControls inner) es [] [v] =>
      same_numbers (map fst es) free && Check.are_once free && forallb (fun j => Nat.ltb j (length params)) free && Nat.eqb (length v) m &&
      match inner with
      | ByLower places Y => shows es v None places Y
      | Turned (ByLower places Y) n pl => match placed_g with Some i => (0 <=? n)%Z && shows es v (Some (i, n, pl)) places Y | None => false end
      | _ => false
      end
  | _ => false
  end.
Definition shows_varied (tape : list (op address)) (placed : multi_rows nat) (placed_w : nat) (placed_g : option nat) (cell : list fixed) (k : fixed) (e : nat) (by_ : evidence) : bool :=
  let along := shows_part tape placed placed_w placed_g cell k in
  Nat.eqb e ends && Nat.ltb 0 ends &&
  match by_ with
  | ByFan parts => negb (Nat.eqb (length parts) 0) && forallb (fun p => let '(_, n, pl, e) := snd p in along (Some (fst (fst p), snd (fst p), n, pl)) e) (combine (Toward.wedges (map (fun p => fst (fst (fst p))) parts)) parts)
  | _ => along None by_
  end.

Variable tape : list (op address).
Let placed_at (f : formula) : nat := place (formulas tape) f.
Hypothesis fit : are_fit own_multis (formulas tape) = true.
Variables (theta : list R) (cell : list fixed) (x : list R).
Hypothesis theta_in : Forall2 (contains bits) params theta.
Hypothesis x_in : Forall2 (contains bits) cell x.
Hypothesis dimension : length cell = m.

Lemma found_at : forall f, In f (varied_wanted own_multis) -> entry_at tape (placed_at f) = f.
Proof.
  intros f i. unfold are_fit in fit. apply andb_true_iff in fit as [h _]. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [h _].
  rewrite forallb_forall in h. apply same_sound, h, i.
Qed.
Lemma in_multis : forall p f, In p own_multis -> In f (flat_map formulas_of_multi (fst p) ++ formulas_of_multi (snd p)) -> In f (varied_wanted own_multis).
Proof. intros p f ip i. right. apply in_or_app. right. apply in_flat_map. exists p. split; assumption. Qed.

Lemma placed_formulas : forall F : multi_rows formula, (forall f, In f (formulas_of_multis F) -> entry_at tape (placed_at f) = f) ->
  map (entry_at tape) (places_of_multis (map_multis placed_at placed_at F)) = formulas_of_multis F.
Proof.
  assert (Q : forall q : multi formula, (forall f, In f (formulas_of_multi q) -> entry_at tape (placed_at f) = f) -> map (entry_at tape) (places_of_multi (map_multi placed_at placed_at q)) = formulas_of_multi q).
  { intros [a l] h. unfold places_of_multi, map_multi, formulas_of_multi in *. cbn [fst snd map] in *. rewrite (h a (or_introl eq_refl)). f_equal. rewrite map_map.
    rewrite <- (map_id l) at 2. apply map_ext_in. intros f i. apply h. right. exact i. }
  assert (A : forall l : list (multi formula), (forall f, In f (flat_map formulas_of_multi l) -> entry_at tape (placed_at f) = f) ->
    map (entry_at tape) (flat_map places_of_multi (map (map_multi placed_at placed_at) l)) = flat_map formulas_of_multi l).
  { induction l as [| q l IH]; intro h; [reflexivity |]. cbn [map flat_map] in *. rewrite map_app, Q, IH; [reflexivity | |]; intros f i; apply h, in_or_app; [right | left]; exact i. }
  induction F as [| [a d] F IH]; intro h; [reflexivity |]. cbn [map_multis map fst snd]. unfold places_of_multis, formulas_of_multis in *. cbn [flat_map fst snd] in *.
  rewrite !map_app, A, Q; [f_equal; apply IH | |]; intros f i; apply h, in_or_app; [right; exact i | left; apply in_or_app; right; exact i | left; apply in_or_app; left; exact i].
Qed.

Lemma affine_entries : forall l, are_affine m (map (entry_at tape) l) = true -> forallb (is_affine_at tape m) l = true.
Proof.
  intros l h. unfold are_affine in h. rewrite forallb_forall in *. intros i ii. exact (h (entry_at tape i) (in_map _ _ _ ii)).
Qed.
Lemma affine_app : forall a b, are_affine m (a ++ b) = true -> are_affine m a = true /\ are_affine m b = true.
Proof. intros a b h. unfold are_affine in *. rewrite forallb_app in h. apply andb_true_iff in h. exact h. Qed.

Lemma eased_placed : forall l, match l with Some (i, _, _) => exists f, g = Some f /\ i = placed_at (image m f) | None => True end ->
  is_eased_varied tape m ends (map_multis placed_at placed_at own_multis) (placed_at (image m w)) l = true.
Proof.
  intros l hl. assert (h := fit). unfold are_fit in h. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [_ h]. unfold are_eased in h. unfold is_eased_varied. cbv zeta.
  rewrite (found_at (image m w) (or_introl eq_refl)). apply andb_true_iff in h as [h1 h]. apply andb_true_iff. split; [exact h1 |]. rewrite forallb_forall in *. intros k ik. specialize (h k ik).
  apply andb_true_iff in h as [h hg]. apply andb_true_iff in h as [hf hr]. apply andb_true_iff. split; [apply andb_true_iff; split; [exact hf |] |].
  - unfold map_multis. rewrite forallb_forall in hr |- *. intros p ip. apply in_map_iff in ip as [q [<- iq]]. cbn [fst snd]. specialize (hr q iq). apply andb_true_iff in hr as [hw hrise].
    pose proof (fun f i => found_at f (in_multis q f iq i)) as Fd. apply andb_true_iff. split.
    + rewrite forallb_app in hw |- *. apply andb_true_iff in hw as [hw1 hw2]. apply andb_true_iff. split.
      * rewrite forallb_forall in hw1 |- *. intros i ii. apply in_flat_map in ii as [u [iu ii]]. apply in_map_iff in iu as [v [<- iv]].
        assert (G : exists f, In f (formulas_of_multi v) /\ i = placed_at f).
        { destruct v as [a l']. unfold places_of_multi, map_multi in ii. cbn [fst snd] in ii. destruct ii as [<- | ii]; [exists a; split; [left; reflexivity | reflexivity] |].
          apply in_map_iff in ii as [f [<- jf]]. exists f. split; [right; exact jf | reflexivity]. }
        destruct G as [f [jf ->]]. rewrite Fd by (apply in_or_app; left; apply in_flat_map; exists v; split; assumption). apply hw1, in_flat_map. exists v. split; assumption.
      * rewrite forallb_forall in hw2 |- *. intros i ii. cbn [map_multi snd] in ii. apply in_map_iff in ii as [f [<- jf]].
        rewrite Fd by (apply in_or_app; right; right; exact jf). apply hw2, jf.
    + cbn [map_multi fst]. rewrite Fd by (apply in_or_app; right; left; reflexivity). exact hrise.
  - destruct l as [[[i n] pl] |]; [| reflexivity]. destruct hl as [f [eg ->]]. rewrite eg in hg. cbn [option_map] in hg.
    rewrite found_at by (right; rewrite eg; left; reflexivity). exact hg.
Qed.

Lemma own_stand : forall es, map fst es = free -> Forall2 (row_stands tape params es m) (map_multis placed_at placed_at own_multis) rs.
Proof.
  intros es e. assert (ok := fit). unfold are_fit in ok. apply andb_true_iff in ok as [_ ok].
  assert (K : forall f, (forall y, In y (formulas_of_multi (own_multi f)) -> entry_at tape (placed_at y) = y) -> is_fit f = true -> entry_stands tape params es m (map_multi placed_at placed_at (own_multi f)) f).
  { intros f h k. unfold is_fit in k. apply andb_true_iff in k as [k k3]. apply andb_true_iff in k as [k1 k2]. unfold entry_stands, map_multi, own_multi. cbn [fst snd].
    split; [apply h; left; reflexivity |]. split; [| split; [rewrite e; exact k1 | split; [exact k2 |]]].
    - rewrite !map_map, <- e, map_map. apply map_ext_in. intros p ip. apply h. right. cbn [own_multi snd]. apply in_map_iff. exists (fst p). split; [reflexivity |]. rewrite <- e. apply in_map, ip.
    - rewrite forallb_forall in k3. apply Forall_forall. intros p ip. apply k3. rewrite <- e. apply in_map, ip. }
  assert (M : forall p, In p rs -> row_stands tape params es m (map (map_multi placed_at placed_at) (map own_multi (fst p)), map_multi placed_at placed_at (own_multi (snd p))) p).
  { intros p ip. pose proof (fun f i => found_at f (in_multis (map own_multi (fst p), own_multi (snd p)) f (in_map (fun p => (map own_multi (fst p), own_multi (snd p))) _ _ ip) i)) as Fd. cbn [fst snd] in Fd.
    rewrite forallb_forall in ok. specialize (ok p ip). apply andb_true_iff in ok as [ok1 ok2]. rewrite forallb_forall in ok1. split; cbn [fst snd].
    - rewrite map_map. assert (S : forall l, (forall f, In f l -> In f (fst p)) -> Forall2 (entry_stands tape params es m) (map (fun f => map_multi placed_at placed_at (own_multi f)) l) l).
      { induction l as [| f l IH]; intro sub; constructor; [| apply IH; intros y iy; apply sub; right; exact iy].
        apply K; [| apply ok1, sub; left; reflexivity]. intros y iy. apply Fd, in_or_app. left. apply in_flat_map. exists (own_multi f). split; [apply in_map, sub; left; reflexivity | exact iy]. }
      apply S. auto.
    - apply K; [| exact ok2]. intros y iy. apply Fd, in_or_app. right. exact iy. }
  unfold own_multis, map_multis. rewrite map_map. cbn [fst snd].
  assert (G : forall r : rows formula, (forall p, In p r -> In p rs) -> Forall2 (row_stands tape params es m) (map (fun p => (map (map_multi placed_at placed_at) (map own_multi (fst p)), map_multi placed_at placed_at (own_multi (snd p)))) r) r).
  { induction r as [| p r IH]; intro sub; constructor; [apply M, sub; left; reflexivity | apply IH; intros q iq; apply sub; right; exact iq]. }
  exact (G rs (fun p i => i)).
Qed.

Theorem shows_varied_sound : forall k e by_ kappa, shows_varied tape (map_multis placed_at placed_at own_multis) (placed_at (image m w)) (option_map (fun f => placed_at (image m f)) g) cell k e by_ = true ->
  length rs = m -> grounded (map_rows (value x theta) rs) -> 0 < value x theta w -> (forall f, g = Some f -> is_below m f = true -> 0 <= value x theta f) ->
  is_below m w = true -> match g with Some f => is_below m f | None => true end = true -> contains bits k kappa -> 0 <= kappa ->
  forall v, length v = m -> nonzero v -> positive_D (map_rows (value x theta) rs) /\ kappa * value x theta w * dot v v < energy (map_rows (value x theta) rs) v.
Proof.
  intros k e by_ kappa h lr gr w0 g0 bw bg hk k0.
  assert (lx : length x = m) by (rewrite <- (related_length _ _ _ _ _ x_in); exact dimension).
  assert (Wv : at_pairs theta (entry_at tape (placed_at (image m w))) (parabola x) = value x theta w).
  { rewrite (found_at (image m w) (or_introl eq_refl)), <- lx. apply image_value. rewrite lx. exact bw. }
  (* the form *)
  enough (T : forall v, length v = m -> nonzero v -> exists places Y less, 0 <= less /\
    0 < form (lower_weights places Y v) (map_rows (value x theta) rs) v + - (kappa * dot v v) * value x theta w + - dot v v * less).
  { assert (P : positive_D (map_rows (value x theta) rs)).
    { apply (regular_by_each m); [unfold map_rows; rewrite map_length; exact lr | exact gr |]. intros u lu nu. destruct (T u lu nu) as [places [Y [less [l0 q]]]]. exists places, Y. unfold nonzero in nu.
      pose proof (Rmult_le_pos (kappa * dot u u) (value x theta w) ltac:(apply Rmult_le_pos; lra) ltac:(lra)). pose proof (Rmult_le_pos (dot u u) less ltac:(lra) l0). lra. }
    intros v lv nz. split; [exact P |]. destruct (T v lv nz) as [places [Y [less [l0 q]]]]. apply Rlt_le_trans with (2 := lower_energy places Y _ v P).
    assert (0 <= dot v v * less) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l0]). lra. }
  unfold shows_varied in h. cbv zeta in h. set (along := shows_part _ _ _ _ _ _) in h.
  apply andb_true_iff in h as [_ h]. intros v lv nz.
  enough (Part : forall part e, along part e = true -> in_part part v -> exists places Y less, 0 <= less /\
    0 < form (lower_weights places Y v) (map_rows (value x theta) rs) v + - (kappa * dot v v) * value x theta w + - dot v v * less).
  { destruct by_; try exact (Part None _ h I). apply andb_true_iff in h as [n0 h]. rewrite forallb_forall in h.
    destruct (Toward.fan_covers (map (fun p => fst (fst (fst p))) parts) v) as [p [ip iw]]; [intro z; destruct parts; discriminate|].
    destruct (Check.part_of_wedge parts p ip) as [[[[c0 z] pl] e0] iq]. specialize (h _ iq). cbn [fst snd] in h. exact (Part _ _ h iw). }
  clear h. intros part by' h iv. unfold along, shows_part in h. cbv zeta in h. clear along. destruct by' as [| | | | | | | | | | | | | | | | inner es curved dirs | | | |]; try discriminate. destruct inner as [| | | | | | | | | | | inner | | | | | | | | |]; try discriminate.
  destruct curved; [| discriminate]. destruct dirs as [| dir [|]]; try discriminate. apply andb_true_iff in h as [h s]. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [h ex]. apply andb_true_iff in h as [sn on].
  unfold same_numbers in sn. destruct (list_eq_dec _ _ _) as [ef |]; [| discriminate]. rewrite <- ef in on, ex.
  assert (Aff := fit). unfold are_fit in Aff. apply andb_true_iff in Aff as [Aff _]. apply andb_true_iff in Aff as [Aff _]. apply andb_true_iff in Aff as [_ Aff].
  unfold varied_wanted in Aff. change (image m w :: ?a ++ ?b) with ([image m w] ++ (a ++ b)) in Aff. apply affine_app in Aff as [Aw Aff]. apply affine_app in Aff as [Ag AF].
  assert (Places : forall l, is_affine_multiple tape m l = true -> is_varied_affine tape m (map_multis placed_at placed_at own_multis) (placed_at (image m w)) l = true).
  { intros l hl. unfold is_varied_affine. apply andb_true_iff. split; [| exact hl]. apply affine_entries. cbn [map]. rewrite (found_at (image m w) (or_introl eq_refl)).
    rewrite placed_formulas by (intros f i; apply found_at; right; apply in_or_app; right; exact i). unfold are_affine in *. cbn [forallb] in *. rewrite AF. apply andb_true_iff in Aw as [-> _]. reflexivity. }
  assert (Go : forall l places Y, is_affine_multiple tape m l = true -> match l with Some (i, _, _) => exists f, g = Some f /\ i = placed_at (image m f) | None => True end ->
    everywhere (@map_vsample) ends m (varied_lower_at bits m places Y dir part (Tolerances.steps es params) k) (varied_tensors bits params tape es cell (map_multis placed_at placed_at own_multis) (placed_at (image m w)) l) = true ->
    0 < form (lower_weights places Y v) (map_rows (value x theta) rs) v + - (kappa * dot v v) * value x theta w + - dot v v * less_at tape theta (parabola x) l).
  { intros l places Y al hl q. rewrite <- Wv.
    apply (varied_form bits tape params tape (thinned_not_at_all tape) es m theta theta_in cell x x_in dimension on ex (map_multis placed_at placed_at own_multis) rs (placed_at (image m w)) l ends m places Y dir part k kappa v);
      [exact (own_stand es ef) | exact (Places l al) | exact (eased_placed l hl) | rewrite Wv; lra | exact q | exact hk | exact lv | exact nz | exact iv]. }
  destruct inner as [| | places Y | | | | | | | | | | inner n pl | | | | | | | |]; try discriminate.
  - exists places, Y, 0. split; [lra |]. exact (Go None places Y eq_refl I s).
  - destruct inner as [| | places Y | | | | | | | | | | | | | | | | | |]; try discriminate. destruct g as [f |] eqn:eg; [| discriminate]. cbn [option_map] in s. apply andb_true_iff in s as [n0 s]. apply Z.leb_le, IZR_le in n0.
    exists places, Y, (less_at tape theta (parabola x) (Some (placed_at (image m f), n, pl))).
    assert (ef' : entry_at tape (placed_at (image m f)) = image m f) by (apply found_at; right; rewrite eg; left; reflexivity). split.
    + cbn [less_at]. rewrite ef', <- lx, image_value by (rewrite lx; exact bg). pose proof (two_power pl). apply Rmult_le_pos; [apply Rmult_le_pos; [exact n0 | apply Rlt_le, Rinv_0_lt_compat; assumption] | apply g0; [reflexivity | exact bg]].
    + apply (Go (Some (placed_at (image m f), n, pl)) places Y); [| exists f; split; reflexivity | exact s].
      cbn [is_affine_multiple]. unfold is_affine_at, affine_in. cbv zeta. fold (entry_at tape (placed_at (image m f))). rewrite ef'. unfold are_affine in Ag. cbn [forallb] in Ag. apply andb_true_iff in Ag as [Ag _]. exact Ag.
Qed.
End Claim.

(** *** Parameters narrowed *)

(** Parameters that begin no lower: of halves of these. *)
Definition are_above (all params : list fixed) : Prop := Forall2 (fun a b => (lo a <= lo b)%Z) all params.
Lemma above_halved : forall bits k params theta, Forall2 (contains bits) params theta -> forall all, are_above all params ->
  are_above all (fst (halves k params)) /\ are_above all (snd (halves k params)).
Proof.
  intros bits k params theta h. revert k. induction h as [| a y params theta [h1 h2] hs IH]; intros k all r; inversion r as [| b ? all' ? e r']; subst; destruct k as [| k]; cbn [halves fst snd]; try (split; exact r).
  - assert (l : (lo a <= hi a)%Z) by (apply le_IZR; pose proof (unit_R_pos bits); nra).
    assert (M : (lo a <= midpoint a)%Z).
    { unfold midpoint. rewrite Z.shiftr_div_pow2 by lia. change (2 ^ 1)%Z with 2%Z. apply Z.div_le_lower_bound; lia. }
    split; constructor; cbn [lo]; (exact r' || lia).
  - destruct (IH k all' r') as [I1 I2]. destruct (halves k params) as [p q]. cbn [fst snd] in *. split; constructor; assumption.
Qed.
Lemma above_nth : forall all params, are_above all params -> forall i, (lo (nth i all zero) <= lo (nth i params zero))%Z.
Proof. induction 1 as [| a b l k h hs IH]; intros [| i]; cbn [nth]; auto; lia. Qed.
Lemma polynomial_above : forall free all params f, are_above all params -> is_polynomial all free f = true -> is_polynomial params free f = true.
Proof.
  intros free all params f h. revert f. fix IH 1. intros [[k | k | n | a b | a b | a | a b | a b | a | a | ? a b e]] p; cbn [is_polynomial] in *; try exact p; try (exact (IH a p));
    try (apply andb_true_iff in p as [p q]; rewrite (IH a p), (IH b q); reflexivity).
  apply andb_true_iff in p as [p q]. rewrite (IH a p). destruct b as [[]]; try discriminate q. apply andb_true_iff in q as [q r]. rewrite r, andb_true_r.
  apply Z.ltb_lt in q. apply Z.ltb_lt. pose proof (above_nth all params h j). lia.
Qed.
Lemma fit_above : forall m ends rs w g all params free F fs, are_above all params -> are_fit m ends rs w g all free F fs = true -> are_fit m ends rs w g params free F fs = true.
Proof.
  intros m ends rs w g all params free F fs h. unfold are_fit. intro f. apply andb_true_iff in f as [f k]. rewrite f. cbn [andb]. rewrite forallb_forall in k |- *.
  assert (K : forall q, is_fit m all free q = true -> is_fit m params free q = true).
  { unfold is_fit. intros q e. apply andb_true_iff in e as [e e3]. apply andb_true_iff in e as [e1 e2]. rewrite (polynomial_above free all params q h e1), e2, e3. reflexivity. }
  intros p i. specialize (k p i). apply andb_true_iff in k as [k1 k2]. rewrite (K _ k2), andb_true_r. rewrite forallb_forall in k1 |- *. auto.
Qed.
