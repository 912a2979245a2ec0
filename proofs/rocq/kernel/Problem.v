(** * A claim as formulas, a box and tests, and what an accepted tree says of it *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Linear Arithmetic Slope Definite Test Cell Check Number Machine Formula.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** The quantities of a claim: constants, where they are small integers, or parameters *)

Definition small (p : parameter) : option Z :=
  match fst p with
  | Within (Ratio n 1) (Ratio n' 1) =>
      if (n =? n')%Z && is_small n && ((snd p =? 0)%Z || (n =? 0)%Z) then Some n else None
  | _ => None
  end.
Definition quantity (p : parameter) (j : nat) : formula :=
  match small p with Some n => integer n | None => F (Param j) end.
Fixpoint numbered (j : nat) (l : list parameter) : list formula :=
  match l with [] => [] | p :: l' => quantity p j :: numbered (S j) l' end.

Lemma small_value : forall p n y, small p = Some n -> scaled_within p y -> y = IZR n.
Proof.
  intros [[a b] u] n y h [x [[h1 h2] ->]]. unfold small in h. cbn [fst snd least greatest] in *.
  destruct a as [k [| | ] | | | | |]; try discriminate. destruct b as [k' [| | ] | | | | |]; try discriminate.
  destruct ((k =? k')%Z && is_small k && ((u =? 0)%Z || (k =? 0)%Z)) eqn:e; [| discriminate]. injection h as <-.
  apply andb_true_iff in e as [e1 e2]. apply andb_true_iff in e1 as [e1 _]. apply Z.eqb_eq in e1. subst k'.
  cbn [Claim.value] in h1, h2. assert (x = IZR k) by lra. subst x.
  apply orb_true_iff in e2 as [z | z]; apply Z.eqb_eq in z; subst; unfold two_to; cbn; field.
  pose proof (two_to_pos u) as p. unfold two_to in p. cbn in p. lra.
Qed.

Lemma quantity_value : forall p y x theta j, scaled_within p y -> nth j theta 0 = y -> value x theta (quantity p j) = y.
Proof.
  intros p y x theta j h n. unfold quantity. destruct (small p) as [k |] eqn:e.
  - symmetry. exact (small_value p k y e h).
  - exact n.
Qed.

Lemma numbered_values : forall l th x front back, Forall2 scaled_within l th ->
  map (value x (front ++ th ++ back)) (numbered (length front) l) = th.
Proof.
  intros l th x front back h. revert front. induction h as [| p y l th hp h IH]; intro front; [reflexivity |].
  cbn [numbered map app]. f_equal.
  - apply quantity_value; [exact hp | apply nth_middle].
  - specialize (IH (front ++ [y])). rewrite app_length, <- app_assoc in IH. cbn [length app] in IH.
    rewrite Nat.add_1_r in IH. exact IH.
Qed.

Definition three (t : tolerances) (u : Z) : list parameter := [(tx t, u); (ty t, u); (tz t, u)].

Lemma three_within : forall t u v, all_within t v -> Forall2 scaled_within (three t u) (coordinates (vscale (/ two_to u) v)).
Proof.
  intros t u v [h1 [h2 h3]].
  apply Forall2_cons; [exists (vx v) | apply Forall2_cons; [exists (vy v) | apply Forall2_cons; [exists (vz v) | constructor]]];
    (split; [assumption | cbn; unfold Rdiv; ring]).
Qed.

(** ** Legs.  [s]: lengths are divided by 2^s; [d]: a direction by 2^d. *)

Definition layout (s d : Z) (dr : drive) : list parameter :=
  match dr with
  | SliderLeg c => three (direction c) d ++ three (anchor c) s ++ three (platform c) s ++ [(Claim.length c, s)]
  | StrutLeg a p => three a s ++ three p s
  | PlanarLeg n => three n d
  end.

Definition vector_at (q : list formula) (k : nat) : evec :=
  EVec (nth k q (integer 0)) (nth (1 + k) q (integer 0)) (nth (2 + k) q (integer 0)).
Definition from_base (anchor platform : evec) : evec := map2 minus (map2 plus point platform) anchor.

Definition drive_formulas (s d : Z) (dr : drive) (j : nat) : leg_formulas :=
  let q := numbered j (layout s d dr) in
  match dr with
  | SliderLeg c => slider_formulas (from_base (vector_at q 3) (vector_at q 6)) (unit_vector (vector_at q 0)) (nth 9 q (integer 0)) (mode c)
  | StrutLeg _ _ => strut_formulas (from_base (vector_at q 0) (vector_at q 3))
  | PlanarLeg _ => planar_formulas point (unit_vector (vector_at q 0))
  end.

Lemma value_at : forall P theta q th k, map (value (coordinates P) theta) q = th ->
  value (coordinates P) theta (nth k q (integer 0)) = nth k th 0.
Proof. intros P theta q th k <-. symmetry. exact (map_nth (value (coordinates P) theta) q (integer 0) k). Qed.

Lemma vvalue_at : forall P theta q th k, map (value (coordinates P) theta) q = th ->
  vvalue P theta (vector_at q k) = Vec (nth k th 0) (nth (1 + k) th 0) (nth (2 + k) th 0).
Proof. intros. unfold vvalue, vector_at. cbn [ex ey ez]. f_equal; apply value_at; assumption. Qed.

Lemma vvalue_from_base : forall P theta a p, vvalue P theta (from_base a p) = vsub (vadd P (vvalue P theta p)) (vvalue P theta a).
Proof. intros. unfold from_base. rewrite vvalue_minus, vvalue_plus, vvalue_point. reflexivity. Qed.

Lemma drive_represents : forall s d dr l, is_leg_of dr l -> exists th, Forall2 scaled_within (layout s d dr) th /\
  forall P front back, represents P (front ++ th ++ back) (drive_formulas s d dr (length front)) (resized (/ two_to s) l).
Proof.
  intros s d dr l h. pose proof (Rinv_0_lt_compat _ (two_to_pos d)) as d0.
  destruct dr as [c | a p | n], l as [k | base platform | normal]; cbn [is_leg_of] in h; try contradiction.
  - destruct h as [[u [hu ax]] [ha [hp [hl hm]]]].
    exists (coordinates (vscale (/ two_to d) u) ++ coordinates (vscale (/ two_to s) (base_point k))
      ++ coordinates (vscale (/ two_to s) (platform_offset k)) ++ [/ two_to s * leg_length k]).
    assert (L : Forall2 scaled_within (layout s d (SliderLeg c)) (coordinates (vscale (/ two_to d) u) ++ coordinates (vscale (/ two_to s) (base_point k))
      ++ coordinates (vscale (/ two_to s) (platform_offset k)) ++ [/ two_to s * leg_length k])).
    { cbn [layout]. repeat apply Forall2_app; try (apply three_within; assumption).
      constructor; [| constructor]. exists (leg_length k). split; [exact hl | cbn [snd]; unfold Rdiv; ring]. }
    split; [exact L |]. intros P front back.
    pose proof (numbered_values _ _ (coordinates P) front back L) as V. cbn [drive_formulas resized] in *.
    apply slider_represents.
    + rewrite vvalue_from_base, !(vvalue_at _ _ _ _ _ V). reflexivity.
    + rewrite vvalue_unit, (vvalue_at _ _ _ _ _ V). cbn [axis]. rewrite ax. exact (normalised_resized (/ two_to d) u d0).
    + rewrite (value_at _ _ _ _ _ V). reflexivity.
    + exact hm.
  - destruct h as [ha hp].
    exists (coordinates (vscale (/ two_to s) base) ++ coordinates (vscale (/ two_to s) platform)).
    assert (L : Forall2 scaled_within (layout s d (StrutLeg a p)) (coordinates (vscale (/ two_to s) base) ++ coordinates (vscale (/ two_to s) platform)))
      by (apply Forall2_app; apply three_within; assumption).
    split; [exact L |]. intros P front back.
    pose proof (numbered_values _ _ (coordinates P) front back L) as V. cbn [drive_formulas resized].
    apply strut_represents. rewrite vvalue_from_base, !(vvalue_at _ _ _ _ _ V). reflexivity.
  - exists (coordinates (vscale (/ two_to d) normal)).
    assert (L : Forall2 scaled_within (layout s d (PlanarLeg n)) (coordinates (vscale (/ two_to d) normal)))
      by (apply three_within; assumption).
    split; [exact L |]. intros P front back.
    pose proof (numbered_values _ _ (coordinates P) front back L) as V. cbn [drive_formulas resized].
    apply planar_represents; [apply vvalue_point |]. rewrite vvalue_unit, (vvalue_at _ _ _ _ _ V).
    exact (normalised_resized (/ two_to d) normal d0).
Qed.

(** All legs; [ds] has the units of their directions. *)
Fixpoint layouts (s : Z) (ds : list Z) (drs : list drive) : list parameter :=
  match drs with [] => [] | dr :: r => layout s (hd 0%Z ds) dr ++ layouts s (tl ds) r end.
Fixpoint all_formulas (s : Z) (ds : list Z) (drs : list drive) (j : nat) : list leg_formulas :=
  match drs with
  | [] => []
  | dr :: r => drive_formulas s (hd 0%Z ds) dr j :: all_formulas s (tl ds) r (j + length (layout s (hd 0%Z ds) dr))
  end.

Lemma all_represent : forall s drs m, Forall2 is_leg_of drs m -> forall ds, exists th,
  Forall2 scaled_within (layouts s ds drs) th /\
  forall P front back, Forall2 (represents P (front ++ th ++ back)) (all_formulas s ds drs (length front)) (map (resized (/ two_to s)) m).
Proof.
  induction 1 as [| dr l drs m h hs IH]; intro ds; [exists []; split; [constructor | intros; constructor] |].
  destruct (drive_represents s (hd 0%Z ds) dr l h) as [t1 [L1 R1]]. destruct (IH (tl ds)) as [t2 [L2 R2]].
  exists (t1 ++ t2). split; [apply Forall2_app; assumption |]. intros P front back. cbn [all_formulas map]. constructor.
  - rewrite <- app_assoc. apply R1.
  - specialize (R2 P (front ++ t1) back). rewrite app_length, <- !app_assoc in R2.
    rewrite (related_length _ _ _ _ _ L1). rewrite <- app_assoc. exact R2.
Qed.

(** ** Requirements as tests *)

(** kappa = 1/psi_max, k = 1/psi_min, or the end of a joint's range. *)
Definition bound_of (s : Z) (r : requirement) : parameter :=
  match r with
  | NotSingular => (exactly (0 // 1), 0%Z)
  | PsiMax b | PsiMin b => (exactly (Over (1 // 1) b), 0%Z)
  | JointMin _ b | JointMax _ b => (exactly b, s)
  end.
Definition bound_value (s : Z) (r : requirement) : R := Claim.value (greatest (fst (bound_of s r))) / two_to (snd (bound_of s r)).

Lemma bound_within : forall s r, scaled_within (bound_of s r) (bound_value s r).
Proof.
  intros s r. unfold bound_value. exists (Claim.value (greatest (fst (bound_of s r)))). split; [| reflexivity].
  unfold within. destruct r; cbn; lra.
Qed.

Lemma bounds_within : forall s rs, Forall2 scaled_within (map (bound_of s) rs) (map (bound_value s) rs).
Proof. induction rs; cbn [map]; constructor; auto using bound_within. Qed.

(** What is not to be negative; [j] is the bound's place among the parameters. *)
Definition range_formula (fs : list leg_formulas) (s : Z) (j : nat) (r : requirement) : option formula :=
  let b := quantity (bound_of s r) j in
  match r with
  | JointMin i _ => option_map (fun f => minus (f_joint f) b) (nth_error fs i)
  | JointMax i _ => option_map (fun f => minus b (f_joint f)) (nth_error fs i)
  | _ => None
  end.
Fixpoint range_formulas (fs : list leg_formulas) (s : Z) (j : nat) (rs : list requirement) : list formula :=
  match rs with
  | [] => []
  | r :: rs' => match range_formula fs s j r with Some f => [f] | None => [] end ++ range_formulas fs s (S j) rs'
  end.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Definition test_of (place : formula -> nat) (fs : list leg_formulas) (s : Z) (j : nat) (r : requirement) : option test :=
  match r with
  | NotSingular => Some (SigmaMin zero)
  | PsiMax _ => option_map (fun a => SigmaMin (sqr bits a)) (enclose_parameter bits (bound_of s r))
  | PsiMin _ => option_map (fun a => SigmaMax (sqr bits a)) (enclose_parameter bits (bound_of s r))
  | JointMin _ _ | JointMax _ _ => option_map (fun f => AtLeast (place f)) (range_formula fs s j r)
  end.
Fixpoint tests_of (place : formula -> nat) (fs : list leg_formulas) (s : Z) (j : nat) (rs : list requirement) : list (option test) :=
  match rs with [] => [] | r :: rs' => test_of place fs s j r :: tests_of place fs s (S j) rs' end.

Definition is_lower (r : requirement) : bool := match r with NotSingular | PsiMax _ => true | _ => false end.
Definition entries (r : rows formula) : list formula := flat_map (fun p => fst p ++ [snd p]) r.

(** The whole check: formulas, a tape that stands for them, enclosures, the tree.
    [s], [ds], the tape and the tree are evidence. *)
Definition check_claim (c : claim) (s : Z) (ds : list Z) (t : tree) : bool :=
  let ps := layouts s ds (legs c) in
  let fs := all_formulas s ds (legs c) 0 in
  let n := length ps in
  let needed := entries (whole_rows fs) ++ entries (divided_rows fs) ++ range_formulas fs s n (require c) in
  let tape := fst (compile needed) in
  let found := formulas tape in
  if forallb (fun e => same (nth (place found e) found (integer 0)) e) needed then
    if existsb is_lower (require c) then
      match all_some (map (enclose_parameter bits) (ps ++ map (bound_of s) (require c))),
            all_some (map (enclose_parameter bits) (three (workspace c) s)),
            all_some (tests_of (place found) fs s n (require c)) with
      | Some params, Some box, Some tests =>
          check bits tape (map_rows (place found) (whole_rows fs)) (map_rows (place found) (divided_rows fs))
            params tests box (all_open tests) t
      | _, _, _ => false
      end
    else false
  else false.

(** ** Soundness *)

Lemma all_some_related : forall (A B : Type) (P : A -> B -> Prop) (f : A -> option B) l m,
  (forall a b, f a = Some b -> P a b) -> all_some (map f l) = Some m -> Forall2 P l m.
Proof.
  intros A B P f l m h. revert m. induction l as [| a l IH]; intros m e; cbn [map all_some] in e.
  - injection e as <-. constructor.
  - destruct (f a) as [b |] eqn:fa; [| discriminate]. destruct (all_some (map f l)) as [m' |]; [| discriminate].
    injection e as <-. constructor; auto.
Qed.

Lemma all_some_in : forall (A : Type) (l : list (option A)) m o, all_some l = Some m -> In o l -> exists a, o = Some a /\ In a m.
Proof.
  induction l as [| [a |] l IH]; intros m o e i; cbn [all_some] in e; try contradiction; try discriminate.
  destruct (all_some l) as [m' |]; [| discriminate]. injection e as <-. destruct i as [<- | i].
  - exists a. split; [reflexivity | left; reflexivity].
  - destruct (IH m' o eq_refl i) as [b [-> k]]. exists b. split; [reflexivity | right; exact k].
Qed.

Lemma enclosed_all : forall ps th a, all_some (map (enclose_parameter bits) ps) = Some a ->
  Forall2 scaled_within ps th -> Forall2 contains a th.
Proof.
  intros ps th a e h. revert a e. induction h as [| p y ps th hp h IH]; intros a e; cbn [map all_some] in e.
  - injection e as <-. constructor.
  - destruct (enclose_parameter bits p) as [b |] eqn:ep; [| discriminate].
    destruct (all_some (map _ ps)) as [a' |]; [| discriminate]. injection e as <-.
    constructor; [exact (enclose_parameter_sound bits p b y ep hp) | auto].
Qed.

Lemma rows_found : forall tape r, (forall e, In e (entries r) -> formula_at tape (place (formulas tape) e) = e) ->
  map_rows (formula_at tape) (map_rows (place (formulas tape)) r) = r.
Proof.
  induction r as [| [a d] r IH]; intro h; [reflexivity |]. rewrite !map_rows_cons. f_equal.
  - f_equal.
    + rewrite map_map. rewrite <- (map_id a) at 2. apply map_ext_in. intros e i. apply h.
      cbn [entries flat_map fst]. apply in_or_app. left. apply in_or_app. left. exact i.
    + apply h. cbn [entries flat_map snd]. apply in_or_app. left. apply in_or_app. right. left. reflexivity.
  - apply IH. intros e i. apply h. cbn [entries flat_map]. apply in_or_app. right. exact i.
Qed.

Lemma speed2_resized : forall c P m, 0 < c -> forall v, speed2 (map (resized c) m) (vscale c P) v = speed2 m P v.
Proof.
  intros c P m h v. induction m as [| l m IH]; [reflexivity |]. cbn [map speed2 fold_right].
  destruct (resized_same c P h l) as [-> _]. unfold speed2 in IH. rewrite IH. reflexivity.
Qed.

Lemma reaches_resized : forall c P m, 0 < c -> Forall (reaches (vscale c P)) (map (resized c) m) -> Forall (reaches P) m.
Proof.
  intros c P m h. induction m as [| l m IH]; intro k; [constructor |]. inversion k; subst.
  constructor; [| auto]. apply (resized_same c P h l). assumption.
Qed.

Lemma represents_nth : forall P theta fs m i f, Forall2 (represents P theta) fs m -> nth_error fs i = Some f ->
  exists l, nth_error m i = Some l /\ represents P theta f l.
Proof.
  intros P theta fs m i f h. revert i. induction h as [| g l fs m hg h IH]; intros [| i] e; try discriminate.
  - injection e as <-. exists l. auto.
  - exact (IH i e).
Qed.

Lemma nonzero_coordinates : forall v, v <> vzero -> nonzero (coordinates v).
Proof. intros v h. unfold nonzero. rewrite dot_coordinates, <- norm2_dot. apply norm2_pos, h. Qed.

Lemma speed2_zero : forall m P, speed2 m P vzero = 0.
Proof.
  intros m P. induction m as [| l m IH]; [reflexivity |]. cbn [speed2 fold_right]. unfold speed2 in IH. rewrite IH.
  unfold Vec3.dot, vzero. cbn. ring.
Qed.

Lemma vzero_dec : forall v, v = vzero \/ v <> vzero.
Proof.
  intro v. destruct (Req_dec (norm2 v) 0) as [z | z]; [left; apply norm2_zero, z | right].
  intro e. apply z. subst v. unfold norm2, vzero. cbn. ring.
Qed.

Section Accepted.
Variables (c : claim) (s : Z) (ds : list Z) (m : list leg) (P : vec) (theta : list R).
Let ratio := / two_to s.
Let fs := all_formulas s ds (legs c) 0.
Variable tape : list (op nat).
Local Notation Q := (vscale ratio P).
Local Notation x := (coordinates Q).
Local Notation found := (place (formulas tape)).
Hypothesis represented : Forall2 (represents Q theta) fs (map (resized ratio) m).
Hypothesis whole_found : forall e, In e (entries (whole_rows fs)) -> formula_at tape (found e) = e.
Hypothesis divided_found : forall e, In e (entries (divided_rows fs)) -> formula_at tape (found e) = e.

Lemma of_rows_speed : forall bound,
  of_rows tape (map_rows found (whole_rows fs)) (map_rows found (divided_rows fs)) theta x bound ->
  Forall (reaches P) m /\ exists r, bound r /\ forall v, energy r (coordinates v) = speed2 m P v.
Proof.
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0.
  intros bound [r [which [[def pos] h]]]. rewrite (rows_found tape _ whole_found), (rows_found tape _ divided_found) in which.
  assert (K : Forall (reaches Q) (map (resized ratio) m) /\
    forall v, energy (map_rows (value x theta) r) (coordinates v) = speed2 (map (resized ratio) m) Q v).
  { destruct which as [-> | ->]; [apply whole_speed | apply divided_speed]; assumption. }
  destruct K as [K1 K2]. split; [exact (reaches_resized ratio P m r0 K1) |].
  exists (map_rows (value x theta) r). split; [exact h |]. intro v. rewrite K2. apply speed2_resized, r0.
Qed.

Variable j : nat.
Variable r : requirement.
Hypothesis bound_at : nth j theta 0 = bound_value s r.
Hypothesis range_found : forall f, range_formula fs s j r = Some f -> formula_at tape (found f) = f.
Variable t : test.
Hypothesis is_test : test_of found fs s j r = Some t.
Hypothesis test_holds : Check.holds bits tape (map_rows found (whole_rows fs)) (map_rows found (divided_rows fs)) theta 3 x t.

Lemma two_to_0 : two_to 0 = 1.
Proof. reflexivity. Qed.

Lemma kappa_enclosed : forall q b a, bound_of s q = (exactly (Over (1 // 1) b), 0%Z) ->
  enclose_parameter bits (bound_of s q) = Some a -> contains (sqr bits a) ((1 / Claim.value b) ^ 2).
Proof.
  intros q b a e h. apply sqr_sound, (enclose_parameter_sound bits _ _ _ h). rewrite e.
  exists (1 / Claim.value b). cbn [fst snd]. rewrite two_to_0. unfold within, exactly. cbn [least greatest Claim.value].
  replace (1 / 1) with 1 by field. split; [lra | unfold Rdiv; rewrite Rinv_1; ring].
Qed.

Lemma lower_fulfilled : is_lower r = true -> Forall (reaches P) m /\ injective m P /\ fulfils m P r.
Proof.
  intro low. destruct r as [| b | b | i b | i b]; try discriminate; cbn [test_of] in is_test.
  - injection is_test as <-. destruct (of_rows_speed _ test_holds) as [h1 [e [h2 h3]]].
    assert (I : injective m P).
    { intros v nz. rewrite <- h3. specialize (h2 0 (coordinates v) (zero_sound bits) eq_refl (nonzero_coordinates v nz)). lra. }
    split; [exact h1 |]. split; exact I.
  - destruct (enclose_parameter bits (bound_of s (PsiMax b))) as [a |] eqn:E; [| discriminate]. injection is_test as <-.
    destruct (of_rows_speed _ test_holds) as [h1 [e [h2 h3]]].
    assert (B : forall v, v <> vzero -> (1 / Claim.value b) ^ 2 * norm2 v < speed2 m P v).
    { intros v nz. rewrite <- h3, norm2_dot, <- dot_coordinates.
      apply (h2 _ (coordinates v) (kappa_enclosed (PsiMax b) b a eq_refl E) eq_refl (nonzero_coordinates v nz)). }
    split; [exact h1 |]. split.
    + intros v nz. specialize (B v nz). pose proof (pow2_ge_0 (1 / Claim.value b)). pose proof (norm2_nonneg v). nra.
    + intro v. destruct (vzero_dec v) as [-> | nz]; [| apply Rlt_le, B, nz].
      rewrite speed2_zero. unfold norm2, vzero. cbn. lra.
Qed.

Lemma fulfilled : fulfils m P r.
Proof.
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0.
  assert (Bound : forall b i, r = JointMin i b \/ r = JointMax i b ->
    value x theta (quantity (bound_of s r) j) = ratio * Claim.value b).
  { intros b i e. rewrite (quantity_value _ _ x theta j (bound_within s r) bound_at). unfold bound_value, ratio.
    destruct e as [-> | ->]; cbn; unfold Rdiv; ring. }
  destruct (is_lower r) eqn:low; [apply (lower_fulfilled low) |].
  destruct r as [| b | b | i b | i b]; try discriminate; cbn [test_of] in is_test.
  - destruct (enclose_parameter bits (bound_of s (PsiMin b))) as [a |] eqn:E; [| discriminate]. injection is_test as <-.
    destruct (of_rows_speed _ test_holds) as [h1 [e [h2 h3]]]. intro v.
    destruct (vzero_dec v) as [-> | nz]; [rewrite speed2_zero; unfold norm2, vzero; cbn; lra |]. apply Rlt_le.
    rewrite <- h3, norm2_dot, <- dot_coordinates.
    apply (h2 _ (coordinates v) (kappa_enclosed (PsiMin b) b a eq_refl E) eq_refl (nonzero_coordinates v nz)).
  - destruct (range_formula fs s j (JointMin i b)) as [f |] eqn:E; [| discriminate]. injection is_test as <-.
    destruct test_holds as [_ h]. rewrite (range_found f eq_refl) in h. cbn [range_formula] in E.
    destruct (nth_error fs i) as [g |] eqn:n; [| discriminate]. injection E as <-.
    destruct (represents_nth _ _ _ _ _ _ represented n) as [l [k [_ [_ [_ [J _]]]]]].
    rewrite nth_error_map in k. destruct (nth_error m i) as [l0 |] eqn:n0; [| discriminate]. injection k as <-.
    exists l0. split; [exact n0 |]. pose proof (Bound b i (or_introl eq_refl)) as K. cbn [bound_of] in K.
    rewrite value_minus, J, K in h.
    destruct (resized_same ratio P r0 l0) as [_ [e _]]. rewrite e in h.
    apply Rmult_le_reg_l with ratio; [exact r0 | lra].
  - destruct (range_formula fs s j (JointMax i b)) as [f |] eqn:E; [| discriminate]. injection is_test as <-.
    destruct test_holds as [_ h]. rewrite (range_found f eq_refl) in h. cbn [range_formula] in E.
    destruct (nth_error fs i) as [g |] eqn:n; [| discriminate]. injection E as <-.
    destruct (represents_nth _ _ _ _ _ _ represented n) as [l [k [_ [_ [_ [J _]]]]]].
    rewrite nth_error_map in k. destruct (nth_error m i) as [l0 |] eqn:n0; [| discriminate]. injection k as <-.
    exists l0. split; [exact n0 |]. pose proof (Bound b i (or_intror eq_refl)) as K. cbn [bound_of] in K.
    rewrite value_minus, J, K in h.
    destruct (resized_same ratio P r0 l0) as [_ [e _]]. rewrite e in h.
    apply Rmult_le_reg_l with ratio; [exact r0 | lra].
Qed.
End Accepted.

(** Every requirement has its test, and its bound its place. *)
Lemma requirement_at : forall place fs s rs n r, In r rs -> exists k,
  nth_error rs k = Some r /\ In (test_of place fs s (n + k) r) (tests_of place fs s n rs) /\
  forall f, range_formula fs s (n + k) r = Some f -> In f (range_formulas fs s n rs).
Proof.
  intros place fs s rs. induction rs as [| q rs IH]; intros n r i; [contradiction |]. destruct i as [-> | i].
  - exists O. rewrite Nat.add_0_r. split; [reflexivity |]. split; [left; reflexivity |].
    intros f e. cbn [range_formulas]. rewrite e. left. reflexivity.
  - destruct (IH (S n) r i) as [k [h1 [h2 h3]]]. exists (S k). rewrite <- Nat.add_succ_comm. split; [exact h1 |].
    split; [right; exact h2 |]. intros f e. cbn [range_formulas]. apply in_or_app. right. exact (h3 f e).
Qed.

(** Soundness: what the checker accepts is true of every machine and point of the claim. *)
Theorem check_claim_sound : forall c s ds t, check_claim c s ds t = true -> Statement.holds c.
Proof.
  intros c s ds t h m P hm hP. unfold check_claim in h. cbn zeta in h.
  set (fs := all_formulas s ds (legs c) 0) in *. set (n := length (layouts s ds (legs c))) in *.
  set (needed := entries (whole_rows fs) ++ entries (divided_rows fs) ++ range_formulas fs s n (require c)) in *.
  set (tape := fst (compile needed)) in *.
  destruct (forallb _ needed) eqn:found; [| discriminate].
  destruct (existsb is_lower (require c)) eqn:low; [| discriminate].
  destruct (all_some (map (enclose_parameter bits) (layouts s ds (legs c) ++ map (bound_of s) (require c)))) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map (enclose_parameter bits) (three (workspace c) s))) as [box |] eqn:eb; [| discriminate].
  destruct (all_some (tests_of _ fs s n (require c))) as [tests |] eqn:et; [| discriminate].
  assert (Found : forall e, In e needed -> formula_at tape (place (formulas tape) e) = e).
  { rewrite forallb_forall in found. intros e i. apply same_sound, found, i. }
  destruct (all_represent s (legs c) m hm ds) as [th [L R]].
  set (tb := map (bound_value s) (require c)).
  pose proof (bounds_within s (require c)) as B. fold tb in B.
  pose proof (enclosed_all _ _ _ ep (Forall2_app L B)) as T.
  pose proof (enclosed_all _ _ _ eb (three_within (workspace c) s P hP)) as X.
  assert (three_of_them : length box = 3%nat) by (rewrite (related_length _ _ _ _ _ X); reflexivity).
  pose proof (check_all_open bits tape _ _ params tests (th ++ tb) T t box _ h X) as H. rewrite three_of_them in H.
  specialize (R (vscale (/ two_to s) P) [] tb). cbn [app length] in R.
  assert (ln : length th = n) by (symmetry; apply (related_length _ _ _ _ _ L)).
  assert (W : forall e, In e (entries (whole_rows fs)) -> formula_at tape (place (formulas tape) e) = e)
    by (intros e i; apply Found, in_or_app; left; exact i).
  assert (V : forall e, In e (entries (divided_rows fs)) -> formula_at tape (place (formulas tape) e) = e)
    by (intros e i; apply Found, in_or_app; right; apply in_or_app; left; exact i).
  assert (Each : forall r, In r (require c) -> exists k u, nth (n + k) (th ++ tb) 0 = bound_value s r /\
    (forall f, range_formula fs s (n + k) r = Some f -> formula_at tape (place (formulas tape) f) = f) /\
    test_of (place (formulas tape)) fs s (n + k) r = Some u /\
    Check.holds bits tape (map_rows (place (formulas tape)) (whole_rows fs)) (map_rows (place (formulas tape)) (divided_rows fs))
      (th ++ tb) 3 (coordinates (vscale (/ two_to s) P)) u).
  { intros r i. destruct (requirement_at (place (formulas tape)) fs s (require c) n r i) as [k [h1 [h2 h3]]].
    destruct (all_some_in _ _ _ _ et h2) as [u [e2 iu]]. exists k, u. split; [| split; [| split]].
    - rewrite <- ln, app_nth2_plus. unfold tb. apply nth_error_nth. rewrite nth_error_map, h1. reflexivity.
    - intros f e. apply Found, in_or_app. right. apply in_or_app. right. exact (h3 f e).
    - exact e2.
    - exact (H u iu). }
  apply existsb_exists in low as [r0 [i0 l0]]. destruct (Each r0 i0) as [k0 [u0 [E1 [E2 [E3 E4]]]]].
  destruct (lower_fulfilled c s ds m P (th ++ tb) tape R W V (n + k0) r0 E1 E2 u0 E3 E4 l0) as [h1 [h2 _]].
  split; [exact h1 |]. split; [exact h2 |]. apply Forall_forall. intros r i.
  destruct (Each r i) as [k [u [F1 [F2 [F3 F4]]]]].
  exact (fulfilled c s ds m P (th ++ tb) tape R W V (n + k) r F1 F2 u F3 F4).
Qed.
End Precision.
