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

(** Along a path with the velocity v and the acceleration a, of the component s of the leg along its guide. *)
Lemma slider_accelerates : forall l path V a, well_formed l -> 0 < s l (path 0) -> has_velocity path 0 (V 0) -> has_velocity V 0 a ->
  derivable_pt_lim (fun t => dot (Jinv_row l (path t)) (V t)) 0 (dot (vadd (axis l) (vscale (working_mode l / s l (path 0)) (r l (path 0)))) a +
    working_mode l * ((norm2 (V 0) - dot (axis l) (V 0) ^ 2) / s l (path 0) + dot (r l (path 0)) (V 0) ^ 2 / s l (path 0) ^ 3)).
Proof.
  intros l path V a ok h hp hv. set (P := path 0) in *. pose proof (mode_squared l ok) as m2.
  pose proof (velocity_s l path 0 (V 0) ok h hp) as hs. fold P in hs.
  pose proof (velocity_product _ _ _ _ _ (velocity_r l path 0 (V 0) hp) hv) as hr. cbn beta in hr. fold P in hr.
  pose proof (velocity_dot V 0 a (axis l) hv) as hn.
  set (n := axis l) in *. set (u := r l P) in *. set (v := V 0) in *. set (z := s l P) in *. set (md := working_mode l) in *.
  assert (mz : md * z <> 0) by (intro k; assert (md ^ 2 * z ^ 2 = 0) by (replace (md ^ 2 * z ^ 2) with ((md * z) * (md * z)) by ring; rewrite k; ring); rewrite m2 in *; pose proof (pow_lt z 2 h); lra).
  set (X := norm2 v - dot n v ^ 2).
  assert (M : md = 1 \/ md = -1) by (destruct (Req_dec md 1); [auto | right; nra]).
  assert (E : dot n a + ((dot (vsub v (vscale (dot n v) n)) v + dot u a) * (md * z) - (md * (- dot u v / z)) * dot u v) / Rsqr (md * z)
    = dot (vadd n (vscale (md / z) u)) a + md * (X / z + dot u v ^ 2 / z ^ 3)).
  { replace (dot (vsub v (vscale (dot n v) n)) v) with X by (unfold X, norm2, dot, vsub, vscale; cbn [vx vy vz]; ring).
    replace (dot (vadd n (vscale (md / z) u)) a) with (dot n a + md / z * dot u a) by (unfold dot, vadd, vscale; cbn [vx vy vz]; ring).
    unfold Rsqr. replace (md * z * (md * z)) with (z ^ 2) by (transitivity (md ^ 2 * z ^ 2); [rewrite m2 |]; ring). field. lra. }
  rewrite <- E.
  apply derivable_eq with (fun x => dot n (V x) + (fun x => dot (r l (path x)) (V x)) x / (fun x => md * s l (path x)) x)
    (dot n a + ((dot (vsub v (vscale (dot n v) n)) v + dot u a) * (md * z) - (md * (- dot u v / z)) * dot u v) / Rsqr (md * z)).
  - apply derivable_add; [exact hn |]. apply (derivable_pt_lim_div (fun x => dot (r l (path x)) (V x)) (fun x => md * s l (path x)) 0).
    + exact hr.
    + apply derivable_scal. exact hs.
    + exact mz.
  - intro x. unfold Jinv_row, eta. fold n md. generalize (r l (path x)) (V x) (s l (path x)). intros. unfold dot, vadd, vscale, Rdiv. cbn [vx vy vz]. ring.
  - reflexivity.
Qed.

(** eta = n . A for the leg's vector A, t = L/|eta|. *)
Lemma slider_acceleration : forall l path V a, well_formed l -> 0 < s l (path 0) -> has_velocity path 0 (V 0) -> has_velocity V 0 a ->
  exists y, derivable_pt_lim (fun t => dot (Jinv_row l (path t)) (V t)) 0 y /\
    forall p q, 0 <= p -> norm2 (V 0) <= q ^ 2 -> norm2 a <= p ^ 2 ->
      let t := leg_length l / s l (path 0) in Rabs y <= t * (p + q ^ 2 / leg_length l * t ^ 2).
Proof.
  intros l path V a ok h hp hv. eexists. split; [exact (slider_accelerates l path V a ok h hp hv) |].
  set (P := path 0) in *. pose proof (r_orthogonal l P ok) as o. pose proof (mode_squared l ok) as m2.
  pose proof (s_squared l P h) as s2. set (n := axis l) in *. set (u := r l P) in *. set (v := V 0) in *. set (z := s l P) in *. set (md := working_mode l) in *.
  assert (M : md = 1 \/ md = -1) by (destruct (Req_dec md 1); [auto | right; nra]).
  intros p q p0 hq ha. cbv zeta. destruct ok as [n1 [L0 _]]. fold n in n1. set (L := leg_length l) in *.
    set (X := norm2 v - dot n v ^ 2).
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

Lemma strut_accelerates : forall base platform path V a, 0 < norm2 (span base platform (path 0)) -> has_velocity path 0 (V 0) -> has_velocity V 0 a ->
  let u := span base platform (path 0) in let z := sqrt (norm2 u) in
  derivable_pt_lim (fun t => dot (normalised (span base platform (path t))) (V t)) 0 (((norm2 (V 0) + dot u a) * z - (/ z * dot u (V 0)) * dot u (V 0)) / Rsqr z).
Proof.
  intros base platform path V a h hp hv.
  assert (W : has_velocity (fun u => span base platform (path u)) 0 (V 0)) by exact (velocity_w (Leg vzero base platform 1 1) path 0 (V 0) hp).
  pose proof (velocity_product _ _ _ _ _ W hv) as hr. cbn beta in hr.
  pose proof (row_is_derivative (Extensible base platform None) path 0 (V 0) I h hp) as hs. cbn [joint row] in hs.
  pose proof (sqrt_lt_R0 _ h) as z0.
  assert (Ds : forall b c e, dot (vscale b c) e = b * dot c e) by (intros; unfold dot, vscale; cbn [vx vy vz]; ring).
  unfold normalised in hs. rewrite Ds in hs. cbv zeta. rewrite norm2_dot at 1.
  set (z := sqrt (norm2 (span base platform (path 0)))) in *. set (u := span base platform (path 0)) in *. set (v := V 0) in *.
  apply derivable_eq with (fun x => (fun x => dot (span base platform (path x)) (V x)) x / (fun x => sqrt (norm2 (span base platform (path x)))) x)
    (((dot v v + dot u a) * z - (/ z * dot u v) * dot u v) / Rsqr z).
  - apply (derivable_pt_lim_div (fun x => dot (span base platform (path x)) (V x)) (fun x => sqrt (norm2 (span base platform (path x)))) 0); [exact hr | exact hs |].
    cbn beta. fold u. fold z. lra.
  - intro x. unfold normalised. rewrite Ds. unfold Rdiv. ring.
  - reflexivity.
Qed.

Lemma strut_acceleration : forall base platform path V a, 0 < norm2 (span base platform (path 0)) -> has_velocity path 0 (V 0) -> has_velocity V 0 a ->
  exists y, derivable_pt_lim (fun t => dot (normalised (span base platform (path t))) (V t)) 0 y /\
    forall p q, 0 <= p -> norm2 (V 0) <= q ^ 2 -> norm2 a <= p ^ 2 -> Rabs y <= p + q ^ 2 / sqrt (norm2 (span base platform (path 0))).
Proof.
  intros base platform path V a h hp hv. eexists. split; [exact (strut_accelerates base platform path V a h hp hv) |].
  pose proof (sqrt_lt_R0 _ h) as z0. assert (z2 : sqrt (norm2 (span base platform (path 0))) ^ 2 = norm2 (span base platform (path 0))) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra).
  set (z := sqrt (norm2 (span base platform (path 0)))) in *. set (u := span base platform (path 0)) in *. set (v := V 0) in *.
  intros p q p0 hq ha.
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

(** *** The greatest accelerations are reached *)

Definition moved (P v a : vec) (t : R) : vec := vadd P (vadd (vscale t v) (vscale (t ^ 2 / 2) a)).
Lemma moved_velocity : forall P v a, moved P v a 0 = P /\ has_velocity (moved P v a) 0 (vadd v (vscale 0 a)) /\ has_velocity (fun t => vadd v (vscale t a)) 0 a.
Proof.
  intros P v a. split; [unfold moved, vadd, vscale; destruct P; cbn; f_equal; field |].
  assert (K : forall p q c, derivable_pt_lim (fun t => p + (t * q + t ^ 2 / 2 * c)) 0 (q + 0 * c)).
  { intros p q c. eapply derivable_eq with (f := fun t => p + (q * t + c / 2 * t ^ 2)); [apply derivable_add; [apply derivable_const | apply derivable_add;
      [apply derivable_scal, derivable_pt_lim_id | apply derivable_scal, derivable_square, derivable_pt_lim_id]] | intro t; field | unfold id; field]. }
  assert (L : forall q c, derivable_pt_lim (fun t => q + t * c) 0 c).
  { intros q c. eapply derivable_eq with (f := fun t => q + c * t); [apply derivable_add; [apply derivable_const | apply derivable_scal, derivable_pt_lim_id] | intro t; ring | ring]. }
  split; (split; [| split]); cbv [moved vadd vscale Vec3.vx Vec3.vy Vec3.vz]; apply K || apply L.
Qed.

Lemma across_exists : forall u, exists w, norm2 w = 1 /\ dot u w = 0.
Proof.
  intros [x y z]. destruct (Req_dec (y ^ 2 + z ^ 2) 0) as [e | e].
  - exists (Vec 0 1 0). assert (y = 0) by nra. subst. unfold norm2, dot. cbn [vx vy vz]. split; ring.
  - assert (p : 0 < y ^ 2 + z ^ 2) by nra. pose proof (sqrt_lt_R0 _ p) as s0. assert (S : sqrt (y ^ 2 + z ^ 2) ^ 2 = y ^ 2 + z ^ 2) by (apply pow2_sqrt; lra).
    set (q := sqrt (y ^ 2 + z ^ 2)) in *. exists (Vec 0 (z / q) (- y / q)). unfold norm2, dot. cbn [vx vy vz]. split; [| field; lra].
    replace (0 ^ 2 + (z / q) ^ 2 + (- y / q) ^ 2) with ((y ^ 2 + z ^ 2) / q ^ 2) by (field; lra). rewrite S. field. lra.
Qed.

(** A path at P up to these acceleration and speed, along which row . V has the derivative y, |y| = t. *)
Definition accelerates_by (row : vec -> vec) (P : vec) (p q t : R) : Prop :=
  exists path V a y, path 0 = P /\ has_velocity path 0 (V 0) /\ has_velocity V 0 a /\ norm2 (V 0) <= q ^ 2 /\ norm2 a <= p ^ 2 /\
    derivable_pt_lim (fun x => dot (row (path x)) (V x)) 0 y /\ t <= Rabs y.

Lemma slider_reaches : forall l P p q, well_formed l -> 0 < s l P -> 0 <= p -> 0 <= q ->
  let t := leg_length l / s l P in accelerates_by (Jinv_row l) P p q (t * (p + q ^ 2 / leg_length l * t ^ 2)).
Proof.
  intros l P p q ok h p0 q0. cbv zeta. pose proof (r_orthogonal l P ok) as o. pose proof (mode_squared l ok) as m2. pose proof (s_squared l P h) as s2. assert (ok' := ok).
  destruct ok' as [n1 [L0 _]]. set (n := axis l) in *. set (u := r l P) in *. set (z := s l P) in *. set (md := working_mode l) in *. set (L := leg_length l) in *.
  assert (M : md = 1 \/ md = -1) by (destruct (Req_dec md 1); [auto | right; nra]).
  (* of a unit vector w the curvature is L^2/z^3 *)
  assert (W : exists w, norm2 w = 1 /\ (norm2 w - dot n w ^ 2) / z + dot u w ^ 2 / z ^ 3 = L ^ 2 / z ^ 3).
  { destruct (Req_dec (norm2 u) 0) as [e | e].
    - destruct (across_exists n) as [w [w1 w2]]. exists w. split; [exact w1 |]. rewrite w1, w2. pose proof (cauchy_schwarz u w) as C. rewrite e, Rmult_0_l in C.
      assert (D : dot u w ^ 2 = 0) by (pose proof (pow2_ge_0 (dot u w)); lra). rewrite D. replace (L ^ 2) with (z ^ 2) by lra. field. lra.
    - pose proof (norm2_nonneg u) as u0. assert (u1 : 0 < norm2 u) by lra. pose proof (sqrt_lt_R0 _ u1) as s0. assert (S : sqrt (norm2 u) ^ 2 = norm2 u) by (apply pow2_sqrt; lra).
      exists (vscale (/ sqrt (norm2 u)) u). assert (N : norm2 (vscale (/ sqrt (norm2 u)) u) = 1) by (rewrite norm2_scale, pow_inv, S; field; lra). split; [exact N |]. rewrite N.
      assert (Ds : forall b c e, dot e (vscale b c) = b * dot e c) by (intros; unfold dot, vscale; cbn [vx vy vz]; ring). rewrite !Ds, o, <- norm2_dot.
      replace ((/ sqrt (norm2 u) * norm2 u) ^ 2) with (norm2 u) by (rewrite Rpow_mult_distr, pow_inv, S; field; lra). replace (L ^ 2) with (norm2 u + z ^ 2) by lra. field. lra. }
  destruct W as [w [w1 w2]]. set (row := vadd n (vscale (md / z) u)).
  assert (N : norm2 row = (L / z) ^ 2).
  { unfold row. replace (norm2 (vadd n (vscale (md / z) u))) with (norm2 n + 2 * (md / z) * dot n u + (md / z) ^ 2 * norm2 u) by (unfold norm2, dot, vadd, vscale; cbn [vx vy vz]; ring).
    rewrite o, n1. replace (norm2 u) with (L ^ 2 - z ^ 2) by lra. unfold Rdiv. rewrite !Rpow_mult_distr, m2. field. lra. }
  set (a := vscale (md * p * z / L) row). destruct (moved_velocity P (vscale q w) a) as [M0 [M1 M2]]. set (V := fun t => vadd (vscale q w) (vscale t a)) in *.
  assert (V0 : V 0 = vscale q w) by (unfold V, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
  exists (moved P (vscale q w) a), V, a, (md * (L / z * (p + q ^ 2 / L * (L / z) ^ 2))). split; [exact M0 |]. split; [exact M1 |]. split; [exact M2 |].
  split; [rewrite V0, norm2_scale, w1; lra |]. split.
  - unfold a. rewrite norm2_scale, N. right. replace ((md * p * z / L) ^ 2 * (L / z) ^ 2) with (md ^ 2 * p ^ 2) by (field; lra). rewrite m2. ring.
  - split.
    + eapply derivable_eq; [apply (slider_accelerates l (moved P (vscale q w) a) V a ok); [rewrite M0; exact h | exact M1 | exact M2] | reflexivity |]. rewrite M0, V0. fold n u z md row.
      assert (Ds : forall b c e, dot e (vscale b c) = b * dot e c) by (intros; unfold dot, vscale; cbn [vx vy vz]; ring).
      unfold a. rewrite !Ds, <- norm2_dot, N, norm2_scale. symmetry. transitivity (md * (p * (L / z) + q ^ 2 * ((norm2 w - dot n w ^ 2) / z + dot u w ^ 2 / z ^ 3))); [field; lra |].
      rewrite w2. field. lra.
    + rewrite Rabs_mult. replace (Rabs md) with 1 by (destruct M as [-> | ->]; [rewrite Rabs_R1 | rewrite Rabs_left by lra; lra]; reflexivity || lra). rewrite Rmult_1_l. apply Rle_abs.
Qed.

Lemma strut_reaches : forall base platform P p q, 0 < norm2 (span base platform P) -> 0 <= p -> 0 <= q ->
  accelerates_by (fun P => normalised (span base platform P)) P p q (p + q ^ 2 / sqrt (norm2 (span base platform P))).
Proof.
  intros base platform P p q h p0 q0. set (u := span base platform P) in *. destruct (across_exists u) as [w [w1 w2]]. pose proof (sqrt_lt_R0 _ h) as z0.
  assert (Z : sqrt (norm2 u) ^ 2 = norm2 u) by (apply pow2_sqrt; lra). set (z := sqrt (norm2 u)) in *.
  set (a := vscale (p / z) u). destruct (moved_velocity P (vscale q w) a) as [M0 [M1 M2]]. set (V := fun t => vadd (vscale q w) (vscale t a)) in *.
  assert (V0 : V 0 = vscale q w) by (unfold V, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
  assert (Ds : forall b c e, dot e (vscale b c) = b * dot e c) by (intros; unfold dot, vscale; cbn [vx vy vz]; ring).
  exists (moved P (vscale q w) a), V, a, (p + q ^ 2 / z). split; [exact M0 |]. split; [exact M1 |]. split; [exact M2 |].
  split; [rewrite V0, norm2_scale, w1; lra |]. split; [unfold a; rewrite norm2_scale, <- Z; right; field; lra |]. split; [| apply Rle_abs].
  eapply derivable_eq; [apply (strut_accelerates base platform (moved P (vscale q w) a) V a); [rewrite M0; exact h | exact M1 | exact M2] | reflexivity |]. cbv zeta. rewrite M0, V0. fold u z.
  unfold a. rewrite !Ds, w2, norm2_scale, w1, <- norm2_dot, <- Z. unfold Rsqr. field. lra.
Qed.

Lemma plane_reaches : forall n P p q, norm2 (normalised n) = 1 -> 0 <= p -> accelerates_by (fun _ => normalised n) P p q p.
Proof.
  intros n P p q n1 p0. set (k := normalised n) in *. destruct (moved_velocity P vzero (vscale p k)) as [M0 [M1 M2]].
  assert (D : forall t, dot k (vadd vzero (vscale t (vscale p k))) = t * p).
  { intro t. transitivity (t * p * norm2 k); [unfold norm2, dot, vadd, vscale, vzero; cbn; ring | rewrite n1; ring]. }
  exists (moved P vzero (vscale p k)), (fun t => vadd vzero (vscale t (vscale p k))), (vscale p k), p. split; [exact M0 |]. split; [exact M1 |]. split; [exact M2 |].
  split; [replace (norm2 _) with 0 by (unfold norm2, vadd, vscale, vzero; cbn; ring); apply pow2_ge_0 |]. split; [rewrite norm2_scale, n1; lra |]. split; [| apply Rle_abs].
  eapply derivable_eq with (f := fun t => p * t); [apply derivable_scal, derivable_pt_lim_id | intro t; rewrite D; ring | ring].
Qed.
