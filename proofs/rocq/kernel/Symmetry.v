(** * Machines that look the same from permuted axes

    [is_symmetric]: the claim is the same where x, y and z are exchanged or pass into each other, and legs with
    them.  Then it holds at a point of the box if and only if it does at the point so moved ([symmetric_sound]). *)

From Coq Require Import ZArith Reals Lra List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Claim.
From Orthocert.kernel Require Import Statement Number Machine.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** (x, y, z) becomes (y, x, z), (z, x, y), (y, z, x): these make all permutations. *)
Inductive axes := Swapped | Forth | Back.
Definition back (p : axes) : axes := match p with Swapped => Swapped | Forth => Back | Back => Forth end.
Definition moved (A : Type) (p : axes) (l : list A) : list A :=
  match l with [x; y; z] => match p with Swapped => [y; x; z] | Forth => [z; x; y] | Back => [y; z; x] end | _ => l end.
Arguments moved {A}.

Definition turn (p : axes) (v : vec) : vec :=
  match p with Swapped => Vec (vy v) (vx v) (vz v) | Forth => Vec (vz v) (vx v) (vy v) | Back => Vec (vy v) (vz v) (vx v) end.
(** Where leg [i], or coordinate i, comes to. *)
Definition place_of (p : axes) (i : nat) : nat :=
  match p, i with
  | Swapped, O => 1 | Swapped, 1 => 0 | Forth, O => 1 | Forth, 1 => 2 | Forth, 2 => 0 | Back, O => 2 | Back, 1 => 0 | Back, 2 => 1 | _, _ => i
  end%nat.

(** ** Claims *)

Definition turned_tolerances (p : axes) (t : tolerances) : tolerances :=
  match p with Swapped => Tolerances (ty t) (tx t) (tz t) | Forth => Tolerances (tz t) (tx t) (ty t) | Back => Tolerances (ty t) (tz t) (tx t) end.
Definition turned_drive (p : axes) (d : drive) : drive :=
  let t := turned_tolerances p in
  match d with
  | SliderLeg c => SliderLeg (Slider (t (direction c)) (t (anchor c)) (t (platform c)) (Claim.length c) (mode c))
  | StrutLeg a b k => StrutLeg (t a) (t b) (option_map t k)
  | PlanarLeg n => PlanarLeg (t n)
  end.
(** Of quantities that do not change with the axes. *)
Definition turned_requirement (p : axes) (r : requirement) : option requirement :=
  match r with
  | NotSingular | PsiMax _ | PsiMin _ | ConditionMax _ | ParallelMargin _ => Some r
  | JointMin i b => Some (JointMin (place_of p i) b)
  | JointMax i b => Some (JointMax (place_of p i) b)
  | JointSpeed i tool b => Some (JointSpeed (place_of p i) tool b)
  | SerialMargin i b => Some (SerialMargin (place_of p i) b)
  | _ => None
  end.

Definition same_tolerance (t u : tolerance) : bool := same (least t) (least u) && same (greatest t) (greatest u).
Definition same_tolerances (t u : tolerances) : bool := same_tolerance (tx t) (tx u) && same_tolerance (ty t) (ty u) && same_tolerance (tz t) (tz u).
Definition same_drive (d e : drive) : bool :=
  match d, e with
  | SliderLeg c, SliderLeg k => same_tolerances (direction c) (direction k) && same_tolerances (anchor c) (anchor k) &&
      same_tolerances (platform c) (platform k) && same_tolerance (Claim.length c) (Claim.length k) && Bool.eqb (mode c) (mode k)
  | StrutLeg a b None, StrutLeg a' b' None => same_tolerances a a' && same_tolerances b b'
  | PlanarLeg n, PlanarLeg n' => same_tolerances n n'
  | _, _ => false
  end.
Definition same_requirement (r q : requirement) : bool :=
  match r, q with
  | NotSingular, NotSingular => true
  | PsiMax b, PsiMax c | PsiMin b, PsiMin c | ConditionMax b, ConditionMax c | ParallelMargin b, ParallelMargin c => same b c
  | JointMin i b, JointMin j c | JointMax i b, JointMax j c | SerialMargin i b, SerialMargin j c => Nat.eqb i j && same b c
  | JointSpeed i t b, JointSpeed j u c => Nat.eqb i j && same t u && same b c
  | _, _ => false
  end.

Definition is_symmetric (c : claim) : bool :=
  Nat.eqb (length (legs c)) 3 &&
  match workspace c with Box edges => same_tolerance (tx edges) (ty edges) && same_tolerance (ty edges) (tz edges) | _ => false end &&
  forallb (fun p => forallb (fun q => same_drive (fst q) (snd q)) (combine (legs c) (moved p (map (turned_drive p) (legs c)))) &&
    forallb (fun r => match turned_requirement p r with Some q => existsb (same_requirement q) (require c) | None => false end) (require c)) [Swapped; Forth; Back].

(** ** Machines *)

Definition turned (p : axes) (l : leg) : leg :=
  let t := turn p in
  match l with
  | Guided l => Guided (Leg (t (axis l)) (t (base_point l)) (t (platform_offset l)) (leg_length l) (working_mode l))
  | Extensible a b k => Extensible (t a) (t b) (option_map t k)
  | Plane n => Plane (t n)
  end.

Lemma turn_back : forall p v, turn p (turn (back p) v) = v.
Proof. intros [] [x y z]; reflexivity. Qed.
Lemma turn_dot : forall p u v, dot (turn p u) (turn p v) = dot u v.
Proof. intros [] u v; unfold dot, turn; cbn [vx vy vz]; ring. Qed.
Lemma turn_norm2 : forall p v, norm2 (turn p v) = norm2 v.
Proof. intros. rewrite !norm2_dot. apply turn_dot. Qed.
Lemma turn_add : forall p u v, vadd (turn p u) (turn p v) = turn p (vadd u v).
Proof. intros [] u v; reflexivity. Qed.
Lemma turn_sub : forall p u v, vsub (turn p u) (turn p v) = turn p (vsub u v).
Proof. intros [] u v; reflexivity. Qed.
Lemma turn_scale : forall p a v, vscale a (turn p v) = turn p (vscale a v).
Proof. intros [] a v; reflexivity. Qed.

Section Leg.
Variables (p : axes) (P : vec).
Local Notation Q := (turn p P).
Local Ltac turns := rewrite ?turn_add, ?turn_sub, ?turn_dot, ?turn_scale, ?turn_sub, ?turn_add, ?turn_norm2.

Lemma guided_turned : forall l, let k := Leg (turn p (axis l)) (turn p (base_point l)) (turn p (platform_offset l)) (leg_length l) (working_mode l) in
  w k Q = turn p (w l P) /\ r k Q = turn p (r l P) /\ s k Q = s l P /\ eta k Q = eta l P /\ rho k Q = rho l P /\ Jinv_row k Q = turn p (Jinv_row l P) /\ leg_vector k Q = turn p (leg_vector l P).
Proof.
  intros l k. assert (W : w k Q = turn p (w l P)) by (unfold w, k; cbn [platform_offset base_point]; turns; reflexivity).
  assert (R_ : r k Q = turn p (r l P)) by (unfold r; rewrite W; unfold k; cbn [axis]; turns; reflexivity).
  assert (S : s k Q = s l P) by (unfold s; rewrite R_; turns; reflexivity). assert (E : eta k Q = eta l P) by (unfold eta; rewrite S; reflexivity).
  split; [exact W |]. split; [exact R_ |]. split; [exact S |]. split; [exact E |].
  split; [unfold rho; rewrite W, E; unfold k; cbn [axis]; turns; reflexivity |].
  split; [unfold Jinv_row; rewrite R_, E; unfold k; cbn [axis]; turns; reflexivity |].
  rewrite !leg_vector_eq, R_, E. unfold k. cbn [axis]. turns. reflexivity.
Qed.

Lemma leg_turned : forall l, (reaches P l -> reaches Q (turned p l)) /\ joint (turned p l) Q = joint l P /\ row (turned p l) Q = turn p (row l P).
Proof.
  intros [l | a b k | n]; cbn [turned reaches joint row].
  - destruct (guided_turned l) as [_ [_ [S [_ [E [J _]]]]]]. rewrite S, E, J. split; [exact (fun h => h) | split; reflexivity].
  - unfold span, normalised. turns. split; [exact (fun h => h) | split; reflexivity].
  - unfold normalised. turns. turns. split; [exact (fun h => h) | split; reflexivity].
Qed.

Lemma vector_turned : forall l, vector_of (turned p l) Q = turn p (vector_of l P) /\ size_of (turned p l) Q = size_of l P.
Proof.
  intros [l | a b k | n]; cbn [turned vector_of size_of].
  - destruct (guided_turned l) as [_ [_ [_ [_ [_ [_ V]]]]]]. split; [exact V | reflexivity].
  - unfold span. turns. split; reflexivity.
  - unfold normalised. turns. split; reflexivity.
Qed.
End Leg.

Lemma moved_turned : forall p m, length m = 3%nat -> moved p (map (turned p) (moved (back p) (map (turned (back p)) m))) = m.
Proof.
  assert (T : forall p l, turned p (turned (back p) l) = l).
  { intros p [[a b c d e] | a b [k |] | n]; cbn [turned option_map axis base_point platform_offset leg_length working_mode]; rewrite !turn_back; reflexivity. }
  intros p [| a [| b [| d [|]]]] h; try discriminate. destruct p; cbn [back moved map]; rewrite ?(T Swapped), ?(T Forth), ?(T Back); reflexivity.
Qed.

Section Names.
Context {names : naming}.

Lemma turned_within : forall p t v, all_within t v -> all_within (turned_tolerances p t) (turn p v).
Proof. intros [] t v [h1 [h2 h3]]; unfold all_within; cbn; auto. Qed.

Lemma turned_is_leg : forall p d l, is_leg_of d l -> is_leg_of (turned_drive p d) (turned p l).
Proof.
  intros p [c | a b k | n] [l | a' b' k' | n'] h; cbn [is_leg_of turned_drive turned] in *; try contradiction.
  - destruct h as [[d [h1 h2]] [h3 [h4 [h5 h6]]]]. unfold is_leg. cbn. split; [exists (turn p d); split; [apply turned_within, h1 |] |].
    + rewrite turn_norm2, turn_scale, h2. reflexivity.
    + split; [apply turned_within, h3 |]. split; [apply turned_within, h4 |]. split; [exact h5 | exact h6].
  - destruct h as [h1 [h2 h3]]. split; [apply turned_within, h1 |]. split; [apply turned_within, h2 |].
    destruct k as [k |], k' as [k' |]; cbn [option_map]; try contradiction; try exact I. destruct h3 as [d [h3 ->]].
    exists (turn p d). split; [apply turned_within, h3 |]. unfold normalised. rewrite turn_norm2, turn_scale. reflexivity.
  - apply turned_within, h.
Qed.

Lemma turned_machine : forall p ds m, Forall2 is_leg_of ds m -> Forall2 is_leg_of (moved p (map (turned_drive p) ds)) (moved p (map (turned p) m)).
Proof.
  intros p ds m h. assert (G : Forall2 is_leg_of (map (turned_drive p) ds) (map (turned p) m)).
  { induction h as [| d l ds m h hs IH]; constructor; [apply turned_is_leg, h | exact IH]. }
  destruct G as [| d1 l1 ? ? g1 G]; [constructor |]. destruct G as [| d2 l2 ? ? g2 G]; [repeat constructor; assumption |].
  destruct G as [| d3 l3 ? ? g3 G]; [repeat constructor; assumption |]. destruct G as [| d4 l4 ? ? g4 G].
  - destruct p; cbn [moved]; repeat (apply Forall2_cons; [assumption |]); apply Forall2_nil.
  - cbn [moved]. repeat (apply Forall2_cons; [assumption |]). exact G.
Qed.

Section Machine.
Variables (c : claim) (p : axes) (P : vec) (l1 l2 l3 : leg).
Local Notation m := [l1; l2; l3].
Local Notation m' := (moved p (map (turned p) [l1; l2; l3])).
Local Notation Q := (turn p P).

Lemma leg_there : forall i l, nth_error m i = Some l -> nth_error m' (place_of p i) = Some (turned p l).
Proof. intros i l h. destruct p, i as [| [| [| i]]]; cbn in *; try (injection h as <-; reflexivity); destruct i; discriminate. Qed.

Lemma speed2_turned : forall v, speed2 m' Q (turn p v) = speed2 m P v.
Proof.
  intro v. assert (E : forall l, dot (row (turned p l) Q) (turn p v) = dot (row l P) v) by (intro l; rewrite (proj2 (proj2 (leg_turned p P l))); apply turn_dot).
  unfold speed2. destruct p; cbn [moved map fold_right] in *; rewrite !E; ring.
Qed.
Lemma speed2_there : forall v, speed2 m' Q v = speed2 m P (turn (back p) v).
Proof. intro v. rewrite <- speed2_turned, turn_back. reflexivity. Qed.
Lemma norm2_there : forall v, norm2 v = norm2 (turn (back p) v).
Proof. intro v. symmetry. apply turn_norm2. Qed.

Lemma fulfils_turned : forall r q, turned_requirement p r = Some q -> fulfils c m P r -> fulfils c m' Q q.
Proof.
  assert (Z : forall v, v <> vzero -> turn (back p) v <> vzero).
  { intros v h e. apply h. rewrite <- (turn_back p v), e. destruct p; reflexivity. }
  intros r q e F. destruct r; try discriminate; injection e as <-; cbn [fulfils] in *.
  - intros v nz. rewrite speed2_there. apply F, Z, nz.
  - intro v. rewrite speed2_there, norm2_there. apply F.
  - intro v. rewrite speed2_there, norm2_there. apply F.
  - destruct F as [l [h1 h2]]. exists (turned p l). split; [apply leg_there, h1 |]. rewrite (proj1 (proj2 (leg_turned p P l))). exact h2.
  - destruct F as [l [h1 h2]]. exists (turned p l). split; [apply leg_there, h1 |]. rewrite (proj1 (proj2 (leg_turned p P l))). exact h2.
  - destruct F as [l [h1 h2]]. exists (turned p l). split; [apply leg_there, h1 |]. intros v hv. rewrite (proj2 (proj2 (leg_turned p P l))), <- (turn_back p v), turn_dot. apply h2.
    rewrite turn_norm2. exact hv.
  - intros u v. rewrite !speed2_there, (norm2_there u), (norm2_there v). apply F.
  - destruct F as [k [h1 h2]]. eexists. split; [apply (leg_there _ _ h1) |]. destruct (guided_turned p P k) as [_ [_ [_ [E _]]]]. rewrite E. exact h2.
  - destruct F as [k1 [k2 [k3 [h1 h2]]]]. injection h1 as -> -> ->.
    destruct (vector_turned p P k1) as [E1 Z1], (vector_turned p P k2) as [E2 Z2], (vector_turned p P k3) as [E3 Z3].
    destruct p; cbn [moved map]; do 3 eexists; (split; [reflexivity |]); rewrite E1, E2, E3, Z1, Z2, Z3;
      match goal with |- _ <= Rabs (det ?M) => assert (D : Rabs (det M) = Rabs (det (Mat (vector_of k1 P) (vector_of k2 P) (vector_of k3 P)))) end.
    1,3,5: unfold det, cross, dot, turn; cbn [row1 row2 row3 vx vy vz]; first [apply f_equal; ring | rewrite <- Rabs_Ropp; apply f_equal; ring].
    all: rewrite D; lra.
Qed.

Lemma meets_turned : (forall q, In q (require c) -> exists r, In r (require c) /\ turned_requirement p r = Some q) -> meets c m P -> meets c m' Q.
Proof.
  intros H [h1 [h2 h3]]. inversion h1 as [| ? ? a1 h1']; subst. inversion h1' as [| ? ? a2 h1'']; subst. inversion h1'' as [| ? ? a3 _]; subst.
  apply (proj1 (leg_turned p P l1)) in a1. apply (proj1 (leg_turned p P l2)) in a2. apply (proj1 (leg_turned p P l3)) in a3.
  split; [destruct p; cbn [moved map]; repeat constructor; assumption |]. split.
  - exact (fulfils_turned NotSingular NotSingular eq_refl h2).
  - apply Forall_forall. intros q iq. destruct (H q iq) as [r [ir e]]. rewrite Forall_forall in h3. exact (fulfils_turned r q e (h3 r ir)).
Qed.
End Machine.

Lemma same_tolerance_sound : forall t u, same_tolerance t u = true -> t = u.
Proof. intros [a b] [a' b'] h. apply andb_true_iff in h as [h1 h2]. apply same_sound in h1, h2. cbn in *. congruence. Qed.
Lemma same_tolerances_sound : forall t u, same_tolerances t u = true -> t = u.
Proof.
  intros [x y z] [x' y' z'] h. apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2]. apply same_tolerance_sound in h1, h2, h3. cbn in *. congruence.
Qed.
Lemma same_drive_sound : forall d e, same_drive d e = true -> d = e.
Proof.
  intros [c | a b [k |] | n] [c' | a' b' [k' |] | n'] h; try discriminate; cbn [same_drive] in h.
  - apply andb_true_iff in h as [h h5]. apply andb_true_iff in h as [h h4]. apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2].
    apply same_tolerances_sound in h1, h2, h3. apply same_tolerance_sound in h4. apply eqb_prop in h5. destruct c, c'. cbn in *. congruence.
  - apply andb_true_iff in h as [h1 h2]. apply same_tolerances_sound in h1, h2. congruence.
  - apply same_tolerances_sound in h. congruence.
Qed.
Lemma same_requirement_sound : forall r q, same_requirement r q = true -> r = q.
Proof.
  intros [] [] h; try discriminate; cbn [same_requirement] in h; repeat (apply andb_true_iff in h as [h ?]);
    repeat match goal with h : same _ _ = true |- _ => apply same_sound in h | h : Nat.eqb _ _ = true |- _ => apply Nat.eqb_eq in h end; congruence.
Qed.

Lemma requirement_back : forall p r q, turned_requirement (back p) r = Some q -> turned_requirement p q = Some r.
Proof.
  assert (I : forall p i, place_of p (place_of (back p) i) = i) by (intros [] [| [| [| i]]]; reflexivity).
  intros p [] q h; try discriminate; injection h as <-; cbn [turned_requirement]; rewrite ?I; reflexivity.
Qed.

(** What holds at a point for every machine does so at the point that it comes to. *)
Theorem symmetric_sound : forall c p P, is_symmetric c = true -> (forall m, is_machine c m -> meets c m P) -> forall m, is_machine c m -> meets c m (turn p P).
Proof.
  intros c p P h H m hm. unfold is_symmetric in h. apply andb_true_iff in h as [h sym]. apply andb_true_iff in h as [l3 _]. apply Nat.eqb_eq in l3. rewrite forallb_forall in sym.
  assert (S : forall p, legs c = moved p (map (turned_drive p) (legs c)) /\ forall r, In r (require c) -> exists q, turned_requirement p r = Some q /\ In q (require c)).
  { intro q. specialize (sym q). assert (i : In q [Swapped; Forth; Back]) by (destruct q; cbn; auto). specialize (sym i). apply andb_true_iff in sym as [s1 s2]. rewrite forallb_forall in s1, s2. split.
    - destruct (legs c) as [| d1 [| d2 [| d3 [|]]]]; try discriminate. destruct q; cbn [map moved combine] in *;
        pose proof (same_drive_sound _ _ (s1 _ (or_introl eq_refl))); pose proof (same_drive_sound _ _ (s1 _ (or_intror (or_introl eq_refl))));
        pose proof (same_drive_sound _ _ (s1 _ (or_intror (or_intror (or_introl eq_refl))))); cbn [fst snd] in *; congruence.
    - intros r ir. specialize (s2 r ir). destruct (turned_requirement q r) as [r' |]; [| discriminate]. exists r'. split; [reflexivity |].
      apply existsb_exists in s2 as [r'' [i'' e]]. apply same_requirement_sound in e. congruence. }
  assert (lm : length m = 3%nat) by (rewrite <- l3; symmetry; clear - hm; unfold is_machine in hm; induction hm; cbn [length]; congruence).
  set (m0 := moved (back p) (map (turned (back p)) m)).
  assert (hm0 : is_machine c m0) by (unfold is_machine; rewrite (proj1 (S (back p))); apply turned_machine, hm).
  rewrite <- (moved_turned p m lm). fold m0. specialize (H m0 hm0).
  assert (l0 : length m0 = 3%nat) by (rewrite <- l3; symmetry; clear - hm0; unfold is_machine in hm0; induction hm0; cbn [length]; congruence). clearbody m0. destruct m0 as [| a [| b [| d [|]]]]; try discriminate.
  apply meets_turned; [| exact H]. intros q iq. destruct (proj2 (S (back p)) q iq) as [r [e ir]]. exists r. split; [exact ir | exact (requirement_back p q r e)].
Qed.
End Names.
