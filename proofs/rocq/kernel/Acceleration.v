(** * Joint accelerations

    The joint's speed is row . V ([row_is_derivative]); what is bounded is its derivative. *)

From Coq Require Import Reals Lra.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity.
From Orthocert.kernel Require Import Statement Machine.
Local Open Scope R_scope.

Lemma derivable_times : forall f g t d d', derivable_pt_lim f t d -> derivable_pt_lim g t d' ->
  derivable_pt_lim (fun u => f u * g u) t (d * g t + f t * d').
Proof. intros f g t d d' h h'. exact (derivable_pt_lim_mult f g t d d' h h'). Qed.

Lemma velocity_product : forall u v t U V, has_velocity u t U -> has_velocity v t V ->
  derivable_pt_lim (fun x => dot (u x) (v x)) t (dot U (v t) + dot (u t) V).
Proof.
  intros u v t U V [ux [uy uz]] [vx_ [vy_ vz_]]. unfold dot.
  eapply derivable_eq; [| intro; reflexivity |].
  - apply derivable_add; [apply derivable_add |]; apply derivable_times; eassumption.
  - cbn beta. ring.
Qed.

Lemma bounded_by_square : forall x y, 0 <= y -> x ^ 2 <= y ^ 2 -> - y <= x <= y.
Proof. intros x y h k. split; apply Rnot_lt_le; intro n; nra. Qed.

(** eta = n . A for the leg's vector A, t = L/|eta|. *)
Lemma slider_acceleration : forall l path V a, well_formed l -> 0 < s l (path 0) -> has_velocity path 0 (V 0) -> has_velocity V 0 a ->
  exists y, derivable_pt_lim (fun t => dot (Jinv_row l (path t)) (V t)) 0 y /\
    forall p q, 0 <= p -> norm2 (V 0) <= q ^ 2 -> norm2 a <= p ^ 2 ->
      let t := leg_length l / s l (path 0) in Rabs y <= t * (p + q ^ 2 / leg_length l * t ^ 2).
Proof.
  intros l path V a ok h hp hv. set (P := path 0) in *. pose proof (r_orthogonal l P ok) as o. pose proof (mode_squared l ok) as m2.
  pose proof (s_squared l P h) as s2. pose proof (velocity_s l path 0 (V 0) ok h hp) as hs. fold P in hs.
  pose proof (velocity_product _ _ _ _ _ (velocity_r l path 0 (V 0) hp) hv) as hr. cbn beta in hr. fold P in hr.
  pose proof (velocity_dot V 0 a (axis l) hv) as hn.
  set (n := axis l) in *. set (u := r l P) in *. set (v := V 0) in *. set (z := s l P) in *. set (md := working_mode l) in *.
  assert (mz : md * z <> 0) by (intro k; assert (md ^ 2 * z ^ 2 = 0) by (replace (md ^ 2 * z ^ 2) with ((md * z) * (md * z)) by ring; rewrite k; ring); rewrite m2 in *; pose proof (pow_lt z 2 h); lra).
  exists (dot n a + ((dot (vsub v (vscale (dot n v) n)) v + dot u a) * (md * z) - (md * (- dot u v / z)) * dot u v) / Rsqr (md * z)). split.
  - apply derivable_eq with (fun x => dot n (V x) + (fun x => dot (r l (path x)) (V x)) x / (fun x => md * s l (path x)) x)
      (dot n a + ((dot (vsub v (vscale (dot n v) n)) v + dot u a) * (md * z) - (md * (- dot u v / z)) * dot u v) / Rsqr (md * z)).
    + apply derivable_add; [exact hn |]. apply (derivable_pt_lim_div (fun x => dot (r l (path x)) (V x)) (fun x => md * s l (path x)) 0).
      * exact hr.
      * apply derivable_scal. exact hs.
      * exact mz.
    + intro x. unfold Jinv_row, eta. fold n md. generalize (r l (path x)) (V x) (s l (path x)). intros. unfold dot, vadd, vscale, Rdiv. cbn [vx vy vz]. ring.
    + reflexivity.
  - intros p q p0 hq ha. cbv zeta. destruct ok as [n1 [L0 _]]. fold n in n1. set (L := leg_length l) in *.
    set (X := norm2 v - dot n v ^ 2).
    assert (M : md = 1 \/ md = -1) by (destruct (Req_dec md 1); [auto | right; nra]).
    assert (E : dot n a + ((dot (vsub v (vscale (dot n v) n)) v + dot u a) * (md * z) - (md * (- dot u v / z)) * dot u v) / Rsqr (md * z)
      = dot (vadd n (vscale (md / z) u)) a + md * (X / z + dot u v ^ 2 / z ^ 3)).
    { replace (dot (vsub v (vscale (dot n v) n)) v) with X by (unfold X, norm2, dot, vsub, vscale; cbn [vx vy vz]; ring).
      replace (dot (vadd n (vscale (md / z) u)) a) with (dot n a + md / z * dot u a) by (unfold dot, vadd, vscale; cbn [vx vy vz]; ring).
      unfold Rsqr. replace (md * z * (md * z)) with (z ^ 2) by (transitivity (md ^ 2 * z ^ 2); [rewrite m2 |]; ring). field. lra. }
    rewrite E. clear E hr hs hn.
    assert (A1 : dot (vadd n (vscale (md / z) u)) a ^ 2 <= (L / z * p) ^ 2).
    { pose proof (cauchy_schwarz (vadd n (vscale (md / z) u)) a) as C.
      assert (N : norm2 (vadd n (vscale (md / z) u)) = (L / z) ^ 2).
      { replace (norm2 (vadd n (vscale (md / z) u))) with (norm2 n + 2 * (md / z) * dot n u + (md / z) ^ 2 * norm2 u) by (unfold norm2, dot, vadd, vscale; cbn [vx vy vz]; ring).
        rewrite o, n1. replace (norm2 u) with (L ^ 2 - z ^ 2) by lra. unfold Rdiv. rewrite !Rpow_mult_distr, m2. field. lra. }
      rewrite N in C. apply Rle_trans with (1 := C). rewrite (Rpow_mult_distr _ p). apply Rmult_le_compat_l; [apply pow2_ge_0 | exact ha]. }
    assert (zi : 0 < / z) by (apply Rinv_0_lt_compat, h).
    assert (t0 : 0 <= L / z * p) by (apply Rmult_le_pos; [apply Rmult_le_pos; lra | exact p0]).
    pose proof (bounded_by_square _ _ t0 A1) as A2.
    assert (X0 : 0 <= X).
    { pose proof (cauchy_schwarz n v) as C. rewrite n1 in C. unfold X. lra. }
    assert (X1 : X <= q ^ 2) by (unfold X; pose proof (pow2_ge_0 (dot n v)); lra).
    assert (Y1 : dot u v ^ 2 <= (L ^ 2 - z ^ 2) * q ^ 2).
    { apply Rle_trans with (1 := cauchy_schwarz u v). replace (norm2 u) with (L ^ 2 - z ^ 2) by lra. apply Rmult_le_compat_l; [| exact hq].
      pose proof (norm2_nonneg u). lra. }
    set (W := X / z + dot u v ^ 2 / z ^ 3).
    assert (z3 : 0 < / z ^ 3) by (apply Rinv_0_lt_compat, pow_lt, h).
    assert (W0 : 0 <= W) by (unfold W, Rdiv; pose proof (pow2_ge_0 (dot u v)); apply Rplus_le_le_0_compat; apply Rmult_le_pos; lra).
    assert (W1 : W <= q ^ 2 / L * (L / z) ^ 3).
    { apply Rle_trans with (q ^ 2 / z + (L ^ 2 - z ^ 2) * q ^ 2 / z ^ 3).
      - unfold W, Rdiv. apply Rplus_le_compat; apply Rmult_le_compat_r; lra.
      - apply Req_le. field. split; lra. }
    replace (L / z * (p + q ^ 2 / L * (L / z) ^ 2)) with (L / z * p + q ^ 2 / L * (L / z) ^ 3) by ring.
    apply Rabs_le. destruct M as [-> | ->]; lra.
Qed.

Lemma strut_acceleration : forall base platform path V a, 0 < norm2 (span base platform (path 0)) -> has_velocity path 0 (V 0) -> has_velocity V 0 a ->
  exists y, derivable_pt_lim (fun t => dot (normalised (span base platform (path t))) (V t)) 0 y /\
    forall p q, 0 <= p -> norm2 (V 0) <= q ^ 2 -> norm2 a <= p ^ 2 -> Rabs y <= p + q ^ 2 / sqrt (norm2 (span base platform (path 0))).
Proof.
  intros base platform path V a h hp hv.
  assert (W : has_velocity (fun u => span base platform (path u)) 0 (V 0)) by exact (velocity_w (Leg vzero base platform 1 1) path 0 (V 0) hp).
  pose proof (velocity_product _ _ _ _ _ W hv) as hr. cbn beta in hr.
  pose proof (row_is_derivative (Extensible base platform None) path 0 (V 0) I h hp) as hs. cbn [joint row] in hs.
  pose proof (sqrt_lt_R0 _ h) as z0. assert (z2 : sqrt (norm2 (span base platform (path 0))) ^ 2 = norm2 (span base platform (path 0))) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra).
  assert (Ds : forall b c e, dot (vscale b c) e = b * dot c e) by (intros; unfold dot, vscale; cbn [vx vy vz]; ring).
  unfold normalised in hs. rewrite Ds in hs.
  set (z := sqrt (norm2 (span base platform (path 0)))) in *. set (u := span base platform (path 0)) in *. set (v := V 0) in *.
  exists (((dot v v + dot u a) * z - (/ z * dot u v) * dot u v) / Rsqr z). split.
  - apply derivable_eq with (fun x => (fun x => dot (span base platform (path x)) (V x)) x / (fun x => sqrt (norm2 (span base platform (path x)))) x)
      (((dot v v + dot u a) * z - (/ z * dot u v) * dot u v) / Rsqr z).
    + apply (derivable_pt_lim_div (fun x => dot (span base platform (path x)) (V x)) (fun x => sqrt (norm2 (span base platform (path x)))) 0); [exact hr | exact hs |].
      cbn beta. fold u. fold z. lra.
    + intro x. unfold normalised. rewrite Ds. unfold Rdiv. ring.
    + reflexivity.
  - intros p q p0 hq ha. rewrite <- norm2_dot.
    replace (((norm2 v + dot u a) * z - (/ z * dot u v) * dot u v) / Rsqr z) with (dot u a / z + (norm2 v * z ^ 2 - dot u v ^ 2) / z ^ 3) by (unfold Rsqr; field; lra).
    assert (zi : 0 < / z) by (apply Rinv_0_lt_compat, z0). assert (z3 : 0 < / z ^ 3) by (apply Rinv_0_lt_compat, pow_lt, z0).
    assert (A1 : (dot u a / z) ^ 2 <= p ^ 2).
    { unfold Rdiv. rewrite Rpow_mult_distr, pow_inv. pose proof (cauchy_schwarz u a) as C. pose proof (pow_lt z 2 z0). rewrite <- z2 in C.
      apply Rmult_le_reg_r with (z ^ 2); [assumption |]. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra. nra. }
    pose proof (bounded_by_square _ _ p0 A1) as A2. pose proof (cauchy_schwarz u v) as C. rewrite <- z2 in C. pose proof (pow2_ge_0 (dot u v)).
    assert (B0 : 0 <= (norm2 v * z ^ 2 - dot u v ^ 2) / z ^ 3) by (apply Rmult_le_pos; lra).
    assert (B1 : (norm2 v * z ^ 2 - dot u v ^ 2) / z ^ 3 <= q ^ 2 / z).
    { apply Rle_trans with (q ^ 2 * z ^ 2 / z ^ 3); [| apply Req_le; field; lra]. unfold Rdiv. apply Rmult_le_compat_r; [lra |].
      pose proof (pow2_ge_0 z). assert (norm2 v * z ^ 2 <= q ^ 2 * z ^ 2) by (apply Rmult_le_compat_r; assumption). lra. }
    apply Rabs_le. lra.
Qed.
