(** * Two poses of a platform with the same joint coordinates

    A leg is a strut from where its driven end is, which has one length. Where the
    orientations differ by less than half a turn, there are a vector t and h, the
    axis times the tangent of half the angle between the orientations, that each
    strut's two vectors, with their moments about the origin, annihilate together. *)

From Coq Require Import ZArith Reals Lra List Bool.
From Orthocert Require Import Vec3 Kinematics Claim.
From Orthocert.kernel Require Import Statement Linear Test Machine Problem Arm Orientation HalfTurn Turning Legs.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** [A, r a x A], of the vector A of a strut from a, where r is a unit of length. *)
Definition about_origin (k : mobility) (r : R) (l : strut) (P : vec) (Q : mat) : list R :=
  let A := strut_vector l P Q in velocities k A (vscale r (cross (strut_base l) A)).

(** What both vectors of a strut annihilate together. *)
Definition chord_of (P P' h : vec) : vec := vsub (vsub P' P) (cross h (vadd P P')).
Definition chord_along (k : mobility) (r : R) (P P' h : vec) : list R := velocities k (chord_of P P' h) (vscale (2 / r) h).

(** A platform's point, in this motion; and how it turns. *)
Definition is_place (k : mobility) (P : vec) : Prop :=
  match k with Translates | Turns InSpace => True | TranslatesInPlane | Turns InPlane => vz P = 0 | Turns AboutPoint => P = vzero end.
Definition may_turn_by (k : mobility) (h : vec) : Prop :=
  match k with Translates | TranslatesInPlane => h = vzero | Turns InPlane => vx h = 0 /\ vy h = 0 | Turns _ => True end.
Lemma chord_moves : forall k P P' h c, is_place k P -> is_place k P' -> may_turn_by k h -> has_velocities k (chord_of P P' h) (vscale c h).
Proof.
  intros k [x y z] [x' y' z'] [p q s] c hP hP' hh. unfold chord_of, vsub, vadd, cross, vscale. destruct k as [| | []]; cbn [has_velocities is_of is_place may_turn_by vx vy vz] in *; auto.
  - injection hh as -> -> ->. unfold vzero. f_equal; ring.
  - injection hh as -> -> ->. subst z z'. split; [ring | unfold vzero; f_equal; ring].
  - destruct hh as [-> ->]. subst z z'. repeat split; ring.
  - injection hP as -> -> ->. injection hP' as -> -> ->. unfold vzero. f_equal; ring.
Qed.

Lemma dot_velocities : forall k a m v w, has_velocities k v w -> Linear.dot (velocities k a m) (velocities k v w) = Vec3.dot a v + Vec3.dot m w.
Proof.
  intros k [a b c] [d e f] [x y z] [p q s] h. destruct k as [| | []]; cbn [has_velocities is_of velocities twist vx vy vz] in *; unfold Vec3.dot; cbn.
  - injection h as -> -> ->. ring.
  - destruct h as [-> h]. injection h as -> -> ->. ring.
  - destruct h as [-> [-> ->]]. ring.
  - ring.
  - injection h as -> -> ->. ring.
Qed.
Lemma no_velocities : forall k v w, has_velocities k v w -> Forall (eq 0) (velocities k v w) -> v = vzero /\ w = vzero.
Proof.
  assert (K : forall l : list R, Forall (eq 0) l -> match l with a :: l' => 0 = a /\ Forall (eq 0) l' | [] => True end) by (intros l []; auto).
  intros k [x y z] [p q s] h f. unfold vzero in *.
  destruct k as [| | []]; unfold velocities, coordinates, vzero in *; cbn [has_velocities is_of twist vx vy vz] in *; unfold vzero in h; repeat match type of f with Forall _ (_ :: _) => apply K in f; destruct f as [? f] end; cbn [vx vy vz] in *;
    repeat match goal with e : _ /\ _ |- _ => destruct e | e : Vec _ _ _ = Vec _ _ _ |- _ => injection e as ? ? ? end; subst; split; reflexivity.
Qed.

Lemma pose_chord : forall k r l P Q P' Q' h, r <> 0 -> has_velocities k (chord_of P P' h) (vscale (2 / r) h) ->
  vsub (mulv Q' (strut_joint l)) (mulv Q (strut_joint l)) = cross h (vadd (mulv Q' (strut_joint l)) (mulv Q (strut_joint l))) ->
  strut_length l P' Q' = strut_length l P Q ->
  Linear.dot (about_origin k r l P Q) (chord_along k r P P' h) + Linear.dot (about_origin k r l P' Q') (chord_along k r P P' h) = 0.
Proof.
  intros k r l P Q P' Q' h r0 hk e same. unfold strut_length in same. apply sqrt_inj in same; try apply norm2_nonneg.
  unfold about_origin, chord_along. cbv zeta. rewrite !dot_velocities by exact hk. clear hk. unfold chord_of, strut_vector, arm_of_joint in *.
  set (q := mulv Q _) in *. set (q' := mulv Q' _) in *. set (a := strut_base l) in *.
  clearbody q q' a. clear - e same r0. destruct P as [x y z], P' as [x' y' z'], q as [q1 q2 q3], q' as [p1 p2 p3], a as [a1 a2 a3], h as [h1 h2 h3].
  unfold vsub, vadd, vscale, cross, norm2, Vec3.dot in *. cbn [vx vy vz] in *. injection e as i1 i2 i3.
  set (u1 := x' + p1 - a1 - (x + q1 - a1)) in *. set (u2 := y' + p2 - a2 - (y + q2 - a2)) in *. set (u3 := z' + p3 - a3 - (z + q3 - a3)) in *.
  transitivity ((x + q1 - a1 + (x' + p1 - a1)) * u1 + (y + q2 - a2 + (y' + p2 - a2)) * u2 + (z + q3 - a3 + (z' + p3 - a3)) * u3);
    [| unfold u1, u2, u3; lra].
  replace u1 with (x' - x + (h2 * (p3 + q3) - h3 * (p2 + q2))) by (unfold u1; lra).
  replace u2 with (y' - y + (h3 * (p1 + q1) - h1 * (p3 + q3))) by (unfold u2; lra).
  replace u3 with (z' - z + (h1 * (p2 + q2) - h2 * (p1 + q1))) by (unfold u3; lra). field. exact r0.
Qed.

Theorem poses_differ : forall k r places Y m P Q P' Q' h, r <> 0 -> is_turned_by h Q Q' -> is_place k P -> is_place k P' -> may_turn_by k h ->
  (forall v, length v = freedom k -> nonzero v -> 0 < form (lower_weights places Y v) (map (fun l => (about_origin k r l P Q, 0)) m) v) ->
  (forall v, length v = freedom k -> nonzero v -> 0 < form (lower_weights places Y v) (map (fun l => (about_origin k r l P' Q', 0)) m) v) ->
  Forall (fun l => strut_length l P' Q' = strut_length l P Q) m -> P' = P /\ Q' = Q.
Proof.
  intros k r places Y m P Q P' Q' h r0 e p p' ht H H' same. pose proof (chord_moves k P P' h (2 / r) p p' ht) as hk.
  set (v := chord_along k r P P' h). destruct (Rlt_dec 0 (Linear.dot v v)) as [nz | z].
  - exfalso. assert (lv : length v = freedom k) by (unfold v, chord_along; destruct k as [| | []]; reflexivity). specialize (H v lv nz). specialize (H' v lv nz).
    assert (S : forall w, form w (map (fun l => (about_origin k r l P Q, 0)) m) v + form w (map (fun l => (about_origin k r l P' Q', 0)) m) v = 0).
    { clear H H' nz. induction same as [| l m s1 s2 IH]; intros [| [x q] w]; cbn [map form]; try lra.
      pose proof (pose_chord k r l P Q P' Q' h r0 hk (e (strut_joint l)) s1) as K. fold v in K. specialize (IH w).
      set (a := Linear.dot (about_origin k r l P Q) v) in *. set (b := Linear.dot (about_origin k r l P' Q') v) in *. replace b with (- a) by lra. lra. }
    specialize (S (lower_weights places Y v)). lra.
  - assert (Z : Forall (eq 0) v) by (apply zero_vector; lra). destruct (no_velocities k _ _ hk Z) as [t0 k0]. clear - t0 k0 e r0.
    assert (h0 : h = vzero).
    { assert (i0 : 2 / r <> 0) by (apply Rmult_integral_contrapositive_currified; [lra | apply Rinv_neq_0_compat, r0]).
      destruct h as [h1 h2 h3]. unfold vscale, vzero in *. cbn [vx vy vz] in k0. injection k0 as y1 y2 y3. f_equal; apply Rmult_eq_reg_l with (2 / r); lra. }
    subst h. split; [| exact (not_turned Q Q' e)]. destruct P as [x y z], P' as [x' y' z']. unfold chord_of, vsub, vadd, cross, vzero in t0. cbn [vx vy vz] in t0. injection t0 as y1 y2 y3. f_equal; lra.
Qed.

(** ** Legs as struts *)

Definition is_plane (l : driven) : Prop := match l with Linear (Plane _) => True | _ => False end.
Definition as_strut (P : vec) (Q : mat) (l : driven) : strut := Strut (driven_end l (carried l P Q)) (offset l).

Lemma as_strut_vector : forall P Q l, strut_vector (as_strut P Q l) P Q = vsub (vadd (carried l P Q) (offset l)) (driven_end l (carried l P Q)).
Proof.
  intros P Q l. unfold strut_vector, as_strut, arm_of_joint. cbn [strut_base strut_joint]. set (B := driven_end _ _). clearbody B. unfold carried.
  destruct (mulv Q (offset l)) as [a b c], (offset l) as [d e f], P as [x y z], B as [p q s]. unfold vsub, vadd. cbn [vx vy vz]. f_equal; ring.
Qed.

Lemma same_strut : forall l P Q P' Q', ~ is_plane l -> well_formed_driven l -> own_reach l (carried l P Q) -> own_reach l (carried l P' Q') ->
  own_joint l (carried l P' Q') = own_joint l (carried l P Q) ->
  as_strut P' Q' l = as_strut P Q l /\ strut_length (as_strut P Q l) P' Q' = strut_length (as_strut P Q l) P Q.
Proof.
  intros l P Q P' Q' np ok h h' e. assert (B : driven_end l (carried l P' Q') = driven_end l (carried l P Q)).
  { destruct l as [[k | a p x | n] | k]; cbn [driven_end own_joint joint is_plane] in *; try (injection e as e); try tauto.
    - unfold B_point. rewrite e. reflexivity.
    - unfold elbow. rewrite e, H. reflexivity. }
  assert (S : as_strut P' Q' l = as_strut P Q l) by (unfold as_strut; rewrite B; reflexivity). split; [exact S |]. unfold strut_length. rewrite <- S at 1. rewrite !as_strut_vector.
  destruct l as [[k | a p x | n] | k]; cbn [driven_end own_joint joint is_plane offset own_reach well_formed_driven well_formed_leg reaches] in *; try tauto.
  - change (sqrt (norm2 (leg_vector k (carried (Linear (Guided k)) P' Q'))) = sqrt (norm2 (leg_vector k (carried (Linear (Guided k)) P Q)))).
    rewrite !leg_vector_length by assumption. reflexivity.
  - injection e as e. exact e.
  - change (sqrt (norm2 (Arm.rod k (carried (Rotary k) P' Q'))) = sqrt (norm2 (Arm.rod k (carried (Rotary k) P Q)))).
    rewrite (proj1 (rod_closes _ _ ok h)), (proj1 (rod_closes _ _ ok h')). reflexivity.
Qed.

(** ** Orientations that differ by less than half a turn *)

Definition of_set {names : naming} (o : option orientations) (Q : mat) : Prop := match o with Some o => in_orientations o Q | None => Q = midentity end.
Definition turns_less (bits : positive) (k : mobility) (o : option orientations) : bool :=
  match o with
  | Some o => is_less_than_half_a_turn bits o && match k, o with Turns InPlane, TurnedBy _ => true | (Turns InPlane | Translates | TranslatesInPlane), _ => false | _, _ => true end
  | None => true
  end.
Lemma turns_less_sound : forall (names : naming) bits k o Q Q', turns_less bits k o = true -> of_set o Q -> of_set o Q' -> exists h, is_turned_by h Q Q' /\ may_turn_by k h.
Proof.
  intros names bits k [o |] Q Q' h hQ hQ'; cbn [turns_less of_set] in *.
  - apply andb_true_iff in h as [h hk]. destruct (never_half_a_turn bits o Q Q' h hQ hQ') as [v [t b]]. exists v. split; [exact t |].
    destruct k as [| | []]; try discriminate; cbn [may_turn_by]; try exact I. destruct o; try discriminate. exact b.
  - subst Q Q'. exists vzero. split; [apply same_turned | destruct k as [| | []]; cbn; auto].
Qed.
