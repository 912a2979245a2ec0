(** * Two poses of a platform that turns with the same lengths of its struts

    Where neither orientation is a turn of 90 degrees or more, the two differ by
    less than half a turn, and there are a vector t and h, the axis times the
    tangent of half the angle between the orientations, that each strut's two
    vectors, with their moments about the origin, annihilate together. *)

From Coq Require Import Reals Lra List.
From Orthocert Require Import Vec3 Kinematics Claim.
From Orthocert.kernel Require Import Linear Test Machine Problem Orientation Turning.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** [A, r a x A], of the vector A of a strut from a, where r is a unit of length. *)
Definition about_origin (r : R) (l : strut) (P : vec) (Q : mat) : list R :=
  let A := strut_vector l P Q in coordinates A ++ coordinates (vscale r (cross (strut_base l) A)).

(** Of rotations along these vectors: c' c^-1. *)
Definition between (c c' : vec) : vec := vscale (/ (1 + Vec3.dot c c')) (vadd (vsub c' c) (cross c c')).

Lemma turned_apart : forall c c' Q Q' b, rodrigues c = mscale (1 + norm2 c) Q -> rodrigues c' = mscale (1 + norm2 c') Q' -> 0 < 1 + Vec3.dot c c' ->
  vsub (mulv Q' b) (mulv Q b) = cross (between c c') (vadd (mulv Q' b) (mulv Q b)).
Proof.
  intros c c' Q Q' b e e' d0. pose proof (norm2_nonneg c) as w0. pose proof (norm2_nonneg c') as w0'.
  assert (N : mulv (rodrigues c) b = vscale (1 + norm2 c) (mulv Q b)) by (rewrite e; apply mulv_mscale).
  assert (N' : mulv (rodrigues c') b = vscale (1 + norm2 c') (mulv Q' b)) by (rewrite e'; apply mulv_mscale).
  assert (I : vscale (1 + Vec3.dot c c') (vsub (vscale (1 + norm2 c) (mulv (rodrigues c') b)) (vscale (1 + norm2 c') (mulv (rodrigues c) b))) =
    cross (vadd (vsub c' c) (cross c c')) (vadd (vscale (1 + norm2 c) (mulv (rodrigues c') b)) (vscale (1 + norm2 c') (mulv (rodrigues c) b)))).
  { clear. destruct c as [x y z], c' as [p q r], b as [u v w]. unfold rodrigues, mulv, norm2, vsub, vadd, vscale, cross, Vec3.dot. cbn [row1 row2 row3 vx vy vz]. f_equal; ring. }
  rewrite N, N' in I. set (q := mulv Q b) in *. set (q' := mulv Q' b) in *. unfold between. set (h := vadd (vsub c' c) (cross c c')) in *.
  set (d := 1 + Vec3.dot c c') in *. set (W := 1 + norm2 c) in *. set (W' := 1 + norm2 c') in *. assert (WW : 0 < W * W') by (apply Rmult_lt_0_compat; unfold W, W'; lra).
  clearbody q q' h d. clear - I d0 WW. clearbody W W'. destruct q as [q1 q2 q3], q' as [p1 p2 p3], h as [h1 h2 h3].
  unfold vsub, vadd, vscale, cross in *. cbn [vx vy vz] in *. injection I as i1 i2 i3.
  f_equal; apply Rmult_eq_reg_l with (d * (W * W')); try (apply Rgt_not_eq, Rmult_lt_0_compat; assumption).
  - transitivity (d * (W * (W' * p1) - W' * (W * q1))); [ring |]. rewrite i1. field. lra.
  - transitivity (d * (W * (W' * p2) - W' * (W * q2))); [ring |]. rewrite i2. field. lra.
  - transitivity (d * (W * (W' * p3) - W' * (W * q3))); [ring |]. rewrite i3. field. lra.
Qed.

Lemma not_between : forall c c', 0 < 1 + Vec3.dot c c' -> between c c' = vzero -> c' = c.
Proof.
  intros [x y z] [p q r] d0 e. unfold between, vscale, vadd, vsub, cross, vzero, Vec3.dot in *. cbn [vx vy vz] in *. set (d := 1 + _) in *.
  assert (K : forall a, / d * a = 0 -> a = 0) by (intros a h; apply Rmult_eq_reg_l with (/ d); [lra | apply Rinv_neq_0_compat; lra]).
  injection e as e1 e2 e3. apply K in e1, e2, e3. clear K d d0.
  assert (S : (p - x) ^ 2 + (q - y) ^ 2 + (r - z) ^ 2 = 0).
  { replace ((p - x) ^ 2 + (q - y) ^ 2 + (r - z) ^ 2) with ((p - x) * (p - x + (y * r - z * q)) + (q - y) * (q - y + (z * p - x * r)) + (r - z) * (r - z + (x * q - y * p))) by ring.
    rewrite e1, e2, e3. ring. }
  pose proof (pow2_ge_0 (p - x)). pose proof (pow2_ge_0 (q - y)). pose proof (pow2_ge_0 (r - z)).
  assert (Z : forall a, a ^ 2 = 0 -> a = 0) by (intros a h; apply Rsqr_0_uniq; rewrite Rsqr_pow2; exact h).
  f_equal; apply Rminus_diag_uniq, Z; lra.
Qed.

(** What both vectors of a strut annihilate together. *)
Definition chord_of (r : R) (P P' h : vec) : list R := coordinates (vsub (vsub P' P) (cross h (vadd P P'))) ++ coordinates (vscale (2 / r) h).

Lemma pose_chord : forall r l P Q P' Q' h, r <> 0 ->
  vsub (mulv Q' (strut_joint l)) (mulv Q (strut_joint l)) = cross h (vadd (mulv Q' (strut_joint l)) (mulv Q (strut_joint l))) ->
  strut_length l P' Q' = strut_length l P Q ->
  Linear.dot (about_origin r l P Q) (chord_of r P P' h) + Linear.dot (about_origin r l P' Q') (chord_of r P P' h) = 0.
Proof.
  intros r l P Q P' Q' h r0 e same. unfold strut_length in same. apply sqrt_inj in same; try apply norm2_nonneg.
  unfold about_origin, chord_of, strut_vector, arm_of_joint in *. cbv zeta. set (q := mulv Q _) in *. set (q' := mulv Q' _) in *. set (a := strut_base l) in *.
  clearbody q q' a. clear - e same r0. destruct P as [x y z], P' as [x' y' z'], q as [q1 q2 q3], q' as [p1 p2 p3], a as [a1 a2 a3], h as [h1 h2 h3].
  unfold vsub, vadd, vscale, cross, norm2, coordinates in *. cbn [vx vy vz app Linear.dot] in *. injection e as i1 i2 i3.
  set (u1 := x' + p1 - a1 - (x + q1 - a1)) in *. set (u2 := y' + p2 - a2 - (y + q2 - a2)) in *. set (u3 := z' + p3 - a3 - (z + q3 - a3)) in *.
  transitivity ((x + q1 - a1 + (x' + p1 - a1)) * u1 + (y + q2 - a2 + (y' + p2 - a2)) * u2 + (z + q3 - a3 + (z' + p3 - a3)) * u3);
    [| unfold u1, u2, u3; lra].
  replace u1 with (x' - x + (h2 * (p3 + q3) - h3 * (p2 + q2))) by (unfold u1; lra).
  replace u2 with (y' - y + (h3 * (p1 + q1) - h1 * (p3 + q3))) by (unfold u2; lra).
  replace u3 with (z' - z + (h1 * (p2 + q2) - h2 * (p1 + q1))) by (unfold u3; lra). field. exact r0.
Qed.

Theorem poses_differ : forall r places Y m P Q c P' Q' c', r <> 0 ->
  rodrigues c = mscale (1 + norm2 c) Q -> rodrigues c' = mscale (1 + norm2 c') Q' -> norm2 c < 1 -> norm2 c' < 1 ->
  (forall v, length v = 6%nat -> nonzero v -> 0 < form (lower_weights places Y v) (map (fun l => (about_origin r l P Q, 0)) m) v) ->
  (forall v, length v = 6%nat -> nonzero v -> 0 < form (lower_weights places Y v) (map (fun l => (about_origin r l P' Q', 0)) m) v) ->
  Forall (fun l => strut_length l P' Q' = strut_length l P Q) m -> P' = P /\ Q' = Q.
Proof.
  intros r places Y m P Q c P' Q' c' r0 e e' n0 n0' H H' same.
  assert (d0 : 0 < 1 + Vec3.dot c c').
  { pose proof (norm2_nonneg (vadd c c')) as N. replace (norm2 (vadd c c')) with (norm2 c + 2 * Vec3.dot c c' + norm2 c') in N
      by (unfold norm2, vadd, Vec3.dot; cbn [vx vy vz]; ring). lra. }
  set (h := between c c'). set (v := chord_of r P P' h). destruct (Rlt_dec 0 (Linear.dot v v)) as [nz | z].
  - exfalso. specialize (H v eq_refl nz). specialize (H' v eq_refl nz).
    assert (S : forall w, form w (map (fun l => (about_origin r l P Q, 0)) m) v + form w (map (fun l => (about_origin r l P' Q', 0)) m) v = 0).
    { clear H H' nz. induction same as [| l m s1 s2 IH]; intros [| [p q] w]; cbn [map form]; try lra.
      pose proof (pose_chord r l P Q P' Q' h r0 (turned_apart c c' Q Q' (strut_joint l) e e' d0) s1) as K. fold v in K. specialize (IH w).
      set (a := Linear.dot (about_origin r l P Q) v) in *. set (b := Linear.dot (about_origin r l P' Q') v) in *. replace b with (- a) by lra. lra. }
    specialize (S (lower_weights places Y v)). lra.
  - assert (Z : Forall (eq 0) v) by (apply zero_vector; lra). unfold v, chord_of, coordinates in Z. cbn [app] in Z.
    inversion Z as [| ? ? z1 Z1]; subst. inversion Z1 as [| ? ? z2 Z2]; subst. inversion Z2 as [| ? ? z3 Z3]; subst.
    inversion Z3 as [| ? ? z4 Z4]; subst. inversion Z4 as [| ? ? z5 Z5]; subst. inversion Z5 as [| ? ? z6 _]; subst. clear Z Z1 Z2 Z3 Z4 Z5.
    assert (k0 : 2 / r <> 0) by (apply Rmult_integral_contrapositive_currified; [lra | apply Rinv_neq_0_compat, r0]).
    assert (h0 : h = vzero).
    { assert (G : forall u : vec, 0 = vx (vscale (2 / r) u) -> 0 = vy (vscale (2 / r) u) -> 0 = vz (vscale (2 / r) u) -> u = vzero).
      { intros [h1 h2 h3] y1 y2 y3. unfold vscale in y1, y2, y3. cbn [vx vy vz] in y1, y2, y3. unfold vzero. f_equal; apply Rmult_eq_reg_l with (2 / r); lra. }
      exact (G h z4 z5 z6). }
    pose proof (not_between c c' d0 h0) as ec. split.
    + assert (G : forall u, u = vzero -> let t := vsub (vsub P' P) (cross u (vadd P P')) in 0 = vx t -> 0 = vy t -> 0 = vz t -> P' = P).
      { intros u -> t y1 y2 y3. unfold t in *. destruct P as [x y z0], P' as [x' y' z0']. unfold vsub, vadd, cross, vzero in *. cbn [vx vy vz] in *. f_equal; lra. }
      exact (G h h0 z1 z2 z3).
    + rewrite ec, e in e'. pose proof (norm2_nonneg c). assert (w : 1 + norm2 c <> 0) by lra.
      assert (V : forall a b, vscale (1 + norm2 c) a = vscale (1 + norm2 c) b -> b = a).
      { intros [a1 a2 a3] [b1 b2 b3] q. unfold vscale in q. cbn [vx vy vz] in q. injection q as q1 q2 q3. f_equal; apply Rmult_eq_reg_l with (1 + norm2 c); auto. }
      pose proof (V _ _ (f_equal row1 e')) as q1. pose proof (V _ _ (f_equal row2 e')) as q2. pose proof (V _ _ (f_equal row3 e')) as q3.
      destruct Q as [u1 u2 u3], Q' as [w1 w2 w3]. cbn [row1 row2 row3] in *. congruence.
Qed.
