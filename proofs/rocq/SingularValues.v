(** * Bounds on the singular values of a 3x3 matrix

    The singular values of [M] lie in [kappa, k] exactly when
    kappa |v| <= |M v| <= k |v| for every v.  That is how every bound is
    stated here: it needs no decomposition, and it is what the factors mean
    for a machine (|M v| is the joint speed that gives the platform the
    velocity v). *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3.
Local Open Scope R_scope.

(** kappa <= sigma_min(M), for kappa >= 0. *)
Definition sigma_at_least (kappa : R) (M : mat) : Prop :=
  forall v, kappa ^ 2 * norm2 v <= norm2 (mulv M v).
(** sigma_max(M) <= k, for k >= 0. *)
Definition sigma_at_most (k : R) (M : mat) : Prop :=
  forall v, norm2 (mulv M v) <= k ^ 2 * norm2 v.

(** [sigma] is a singular value of [M]: sigma^2 is an eigenvalue of M^T M. *)
Definition singular_value (sigma : R) (M : mat) : Prop :=
  0 <= sigma /\
  exists v, v <> vzero /\ mulv (transpose M) (mulv M v) = vscale (sigma ^ 2) v.

(** |M v| = sigma |v| for some direction v: the bound [sigma] is reached. *)
Definition stretches_by (sigma : R) (M : mat) : Prop :=
  exists v, v <> vzero /\ norm2 (mulv M v) = sigma ^ 2 * norm2 v.

Lemma sigma_at_least_weaken : forall kappa kappa' M,
  0 <= kappa' <= kappa -> sigma_at_least kappa M -> sigma_at_least kappa' M.
Proof.
  intros kappa kappa' M h H v. specialize (H v). pose proof (norm2_nonneg v).
  assert (kappa' ^ 2 <= kappa ^ 2) by (apply pow_incr; lra).
  assert (kappa' ^ 2 * norm2 v <= kappa ^ 2 * norm2 v) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Lemma sigma_at_most_weaken : forall k k' M,
  0 <= k <= k' -> sigma_at_most k M -> sigma_at_most k' M.
Proof.
  intros k k' M h H v. specialize (H v). pose proof (norm2_nonneg v).
  assert (k ^ 2 <= k' ^ 2) by (apply pow_incr; lra).
  assert (k ^ 2 * norm2 v <= k' ^ 2 * norm2 v) by (apply Rmult_le_compat_r; lra). lra.
Qed.

(** ** The two bounds are bounds on the singular values *)

Lemma singular_value_stretches : forall sigma M, singular_value sigma M -> stretches_by sigma M.
Proof.
  intros sigma M [_ [v [nz h]]]. exists v. split; [exact nz |].
  rewrite norm2_dot, dot_transpose, h. rewrite norm2_dot. vec_ring.
Qed.

Lemma singular_value_within : forall kappa k M sigma,
  0 <= kappa -> 0 <= k -> sigma_at_least kappa M -> sigma_at_most k M ->
  singular_value sigma M -> kappa <= sigma <= k.
Proof.
  intros kappa k M sigma hkappa hk low up h. pose proof (proj1 h) as s0.
  destruct (singular_value_stretches _ _ h) as [v [nz e]].
  pose proof (norm2_pos v nz) as p. specialize (low v). specialize (up v).
  rewrite e in low, up.
  assert (kappa ^ 2 <= sigma ^ 2) by (apply Rmult_le_reg_r with (norm2 v); lra).
  assert (sigma ^ 2 <= k ^ 2) by (apply Rmult_le_reg_r with (norm2 v); lra).
  split; apply Rsqr_incr_0_var; unfold Rsqr; lra.
Qed.

(** A quadratic t b + t^2 q that never goes below 0 has no linear part. *)
Lemma no_linear_part : forall b q, (forall t, 0 <= 2 * t * b + t ^ 2 * q) -> b = 0.
Proof.
  intros b q h. destruct (Req_dec b 0) as [e | ne]; [exact e | exfalso].
  pose proof (pow2_ge_0 b) as b2. assert (p : 0 < b ^ 2) by nra.
  assert (q1 : 0 < 1 + Rabs q) by (pose proof (Rabs_pos q); lra).
  specialize (h (- b / (1 + Rabs q))). pose proof (Rle_abs q).
  replace (2 * (- b / (1 + Rabs q)) * b + (- b / (1 + Rabs q)) ^ 2 * q)
    with (b ^ 2 * (q - 2 * (1 + Rabs q)) / (1 + Rabs q) ^ 2) in h by (field; lra).
  assert (n : b ^ 2 * (q - 2 * (1 + Rabs q)) < 0) by nra.
  assert (d : 0 < / (1 + Rabs q) ^ 2) by (apply Rinv_0_lt_compat, pow_lt; lra).
  unfold Rdiv in h. nra.
Qed.

(** A lower bound that is reached is the smallest singular value ... *)
Lemma reached_lower_bound : forall kappa M,
  0 <= kappa -> sigma_at_least kappa M -> stretches_by kappa M -> singular_value kappa M.
Proof.
  intros kappa M h0 low [v [nz e]]. split; [exact h0 |]. exists v. split; [exact nz |].
  set (d := vsub (mulv (transpose M) (mulv M v)) (vscale (kappa ^ 2) v)).
  assert (z : forall u, dot u d = 0).
  { intro u. apply no_linear_part with (norm2 (mulv M u) - kappa ^ 2 * norm2 u). intro t.
    specialize (low (vadd v (vscale t u))).
    replace (2 * t * dot u d + t ^ 2 * (norm2 (mulv M u) - kappa ^ 2 * norm2 u))
      with (norm2 (mulv M (vadd v (vscale t u))) - kappa ^ 2 * norm2 (vadd v (vscale t u))
            - (norm2 (mulv M v) - kappa ^ 2 * norm2 v)) by (unfold d; vec_ring).
    lra. }
  pose proof (z e1) as z1. pose proof (z e2) as z2. pose proof (z e3) as z3.
  unfold d in z1, z2, z3. clear - z1 z2 z3. apply vec_ext; unfold_vec; lra.
Qed.

(** ... and an upper bound that is reached is the largest one. *)
Lemma reached_upper_bound : forall k M,
  0 <= k -> sigma_at_most k M -> stretches_by k M -> singular_value k M.
Proof.
  intros k M h0 up [v [nz e]]. split; [exact h0 |]. exists v. split; [exact nz |].
  set (d := vsub (mulv (transpose M) (mulv M v)) (vscale (k ^ 2) v)).
  assert (z : forall u, - dot u d = 0).
  { intro u. apply no_linear_part with (k ^ 2 * norm2 u - norm2 (mulv M u)). intro t.
    specialize (up (vadd v (vscale t u))).
    replace (2 * t * - dot u d + t ^ 2 * (k ^ 2 * norm2 u - norm2 (mulv M u)))
      with (k ^ 2 * norm2 (vadd v (vscale t u)) - norm2 (mulv M (vadd v (vscale t u)))
            + (norm2 (mulv M v) - k ^ 2 * norm2 v)) by (unfold d; vec_ring).
    lra. }
  pose proof (z e1) as z1. pose proof (z e2) as z2. pose proof (z e3) as z3.
  unfold d in z1, z2, z3. clear - z1 z2 z3. apply vec_ext; unfold_vec; lra.
Qed.

(** ** Symmetric part lemma

    If W is orthogonal and v^T W M v >= kappa |v|^2 for every v (that is,
    sym(W M) - kappa I is positive semidefinite) then sigma_min(M) >= kappa.
    For the Orthoglide W = I is enough. *)

Definition orthogonal (W : mat) : Prop := mulm (transpose W) W = midentity.

Lemma orthogonal_isometry : forall W v, orthogonal W -> norm2 (mulv W v) = norm2 v.
Proof.
  intros W v h. rewrite norm2_dot, dot_transpose, <- mulv_mulm, h, mulv_identity.
  symmetry. apply norm2_dot.
Qed.

Lemma identity_orthogonal : orthogonal midentity.
Proof. unfold orthogonal. vec_ring. Qed.

(** kappa |v|^2 <= v.u gives kappa |v| <= |u| (Cauchy-Schwarz). *)
Lemma norm2_from_dot : forall kappa u v,
  0 <= kappa -> kappa * norm2 v <= dot v u -> kappa ^ 2 * norm2 v <= norm2 u.
Proof.
  intros kappa u v hk h. pose proof (cauchy_schwarz v u) as cs.
  pose proof (norm2_nonneg v) as nv. pose proof (norm2_nonneg u) as nu.
  destruct nv as [p | z]; [| rewrite <- z; lra].
  assert ((kappa * norm2 v) ^ 2 <= dot v u ^ 2) by (apply pow_incr; nra).
  apply Rmult_le_reg_l with (norm2 v); [exact p |]. nra.
Qed.

Lemma norm2_from_dot_strict : forall kappa u v,
  0 <= kappa -> v <> vzero -> kappa * norm2 v < dot v u -> kappa ^ 2 * norm2 v < norm2 u.
Proof.
  intros kappa u v hk nz h. pose proof (cauchy_schwarz v u) as cs. pose proof (norm2_pos v nz) as p.
  assert (0 <= kappa * norm2 v) by (apply Rmult_le_pos; lra).
  assert ((kappa * norm2 v) ^ 2 < dot v u ^ 2) by nra.
  apply Rmult_lt_reg_l with (norm2 v); [exact p |]. nra.
Qed.

Theorem symmetric_part : forall W M kappa,
  orthogonal W -> 0 <= kappa ->
  (forall v, kappa * norm2 v <= dot v (mulv (mulm W M) v)) -> sigma_at_least kappa M.
Proof.
  intros W M kappa hW hk h v. rewrite <- (orthogonal_isometry W (mulv M v) hW), <- mulv_mulm.
  apply norm2_from_dot; [exact hk | apply h].
Qed.

Lemma symmetric_part_identity : forall M kappa, 0 <= kappa ->
  (forall v, kappa * norm2 v <= dot v (mulv M v)) -> sigma_at_least kappa M.
Proof. intros M kappa hk h v. apply norm2_from_dot; [exact hk | apply h]. Qed.

(** ** No singularity: a positive lower bound makes the determinant nonzero *)

Lemma sigma_positive_kernel : forall kappa M v,
  0 < kappa -> sigma_at_least kappa M -> mulv M v = vzero -> v = vzero.
Proof.
  intros kappa M v hk low h. apply norm2_zero. specialize (low v). rewrite h in low.
  pose proof (norm2_nonneg v). assert (0 < kappa ^ 2) by (apply pow_lt; exact hk).
  replace (norm2 vzero) with 0 in low by (unfold_vec; ring). nra.
Qed.

(** If det M = 0, the cross products of the rows are in the kernel, hence 0;
    then so are the products of each row with e_1, e_2, e_3, so M = 0 and e_1
    is in the kernel. *)
Theorem trivial_kernel_det : forall M, (forall v, mulv M v = vzero -> v = vzero) -> det M <> 0.
Proof.
  intros M K d.
  destruct M as [a b c]. unfold det in d; cbn [row1 row2 row3] in d.
  assert (bc : cross b c = vzero)
    by (apply K; clear - d; apply vec_ext; unfold_vec; nra).
  assert (ca : cross c a = vzero)
    by (apply K; clear - d; apply vec_ext; unfold_vec; nra).
  assert (ab : cross a b = vzero)
    by (apply K; clear - d; apply vec_ext; unfold_vec; nra).
  assert (N : forall r, cross a r = vzero -> cross b r = vzero -> cross c r = vzero -> r = vzero).
  { intros r ra rb rc.
    assert (E : forall u, cross r u = vzero).
    { intro u. apply K. apply vec_ext; unfold mulv; cbn [vx vy vz row1 row2 row3 vzero].
      - replace (dot a (cross r u)) with (dot (cross a r) u) by vec_ring. rewrite ra. vec_ring.
      - replace (dot b (cross r u)) with (dot (cross b r) u) by vec_ring. rewrite rb. vec_ring.
      - replace (dot c (cross r u)) with (dot (cross c r) u) by vec_ring. rewrite rc. vec_ring. }
    pose proof (E e1) as E1. pose proof (E e2) as E2. clear - E1 E2. unfold_vec.
    injection E1; injection E2; intros; f_equal; lra. }
  assert (S : forall u v, cross u v = vzero -> cross v u = vzero).
  { intros u v h. replace (cross v u) with (vscale (-1) (cross u v)) by vec_ring. rewrite h. vec_ring. }
  assert (Z : forall u, cross u u = vzero) by vec_ring.
  assert (a0 : a = vzero) by (apply N; auto).
  assert (b0 : b = vzero) by (apply N; auto).
  assert (c0 : c = vzero) by (apply N; auto).
  subst. assert (e1 = vzero) as F by (apply K; vec_ring). injection F. lra.
Qed.

Theorem sigma_positive_det : forall kappa M,
  0 < kappa -> sigma_at_least kappa M -> det M <> 0.
Proof.
  intros kappa M hk low. apply trivial_kernel_det.
  intros v. apply (sigma_positive_kernel kappa); assumption.
Qed.
