(** * The paper's design: psi_max = 2, a cube of side 200 mm

    Numbers for the design procedure of the paper (Step 1: the cube for L = 1,
    Step 2: the leg length for a prescribed side, Step 3: base distance and
    joint range). *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal CubeLower CubeUpper Scaling Postulate Extremes.
Local Open Scope R_scope.

(** ** Steps 1 and 2: the cube, and the leg length for a given side *)

(** Square roots by their squares: n / sqrt(n^2 a) = 1 / sqrt a. *)
Lemma div_sqrt : forall x a, 0 < x -> 0 < a -> x / sqrt (x ^ 2 * a) = 1 / sqrt a.
Proof.
  intros x a hx ha. rewrite sqrt_mult_alt by nra. rewrite sqrt_pow2 by lra.
  pose proof (sqrt_lt_R0 a ha). field. lra.
Qed.

Lemma q_1_psi_2 : forall L, q_1 L 2 = - L / sqrt 18.
Proof.
  intro L. unfold q_1, position_of_entry, t_1.
  replace (1 + 2 * ((1 - 1 / 2) / 2) ^ 2) with (((1 - 1 / 2) / 2) ^ 2 * 18) by field.
  rewrite div_sqrt by lra. field. apply Rgt_not_eq, sqrt_lt_R0. lra.
Qed.

Lemma q_2_psi_2 : forall L, q_2 L 2 = L / sqrt 6.
Proof.
  intro L. unfold q_2, position_of_entry, t_2. destruct (Rle_dec (1 / 2) (1 / 2)); [| lra].
  replace (1 + 2 * (1 - 1 / 2) ^ 2) with ((1 - 1 / 2) ^ 2 * 6) by field.
  rewrite div_sqrt by lra. field. apply Rgt_not_eq, sqrt_lt_R0. lra.
Qed.

(** L_workspace = q_2 - q_1 = L (1/sqrt 18 + 1/sqrt 6). *)
Definition side_for_unit_length : R := 1 / sqrt 18 + 1 / sqrt 6.
Definition leg_length_for (side : R) : R := side / side_for_unit_length.

Lemma sqrt_18_6 : sqrt 18 = 3 * sqrt 2 /\ sqrt 6 = sqrt 2 * sqrt 3.
Proof.
  split; [| rewrite <- sqrt_mult by lra; f_equal; lra].
  replace 18 with (3 ^ 2 * 2) by ring. rewrite sqrt_mult by lra. rewrite sqrt_pow2 by lra. reflexivity.
Qed.

Lemma side_for_unit_length_pos : 0 < side_for_unit_length.
Proof.
  unfold side_for_unit_length. pose proof (sqrt_lt_R0 18 ltac:(lra)). pose proof (sqrt_lt_R0 6 ltac:(lra)).
  apply Rplus_lt_0_compat; apply Rdiv_lt_0_compat; lra.
Qed.

Theorem side_psi_2 : forall L, q_2 L 2 - q_1 L 2 = L * side_for_unit_length.
Proof. intro L. rewrite q_1_psi_2, q_2_psi_2. unfold side_for_unit_length, Rdiv. ring. Qed.

Theorem prescribed_side : forall side, q_2 (leg_length_for side) 2 - q_1 (leg_length_for side) 2 = side.
Proof.
  intro side. rewrite side_psi_2. pose proof side_for_unit_length_pos. unfold leg_length_for. field. lra.
Qed.

(** ** The 200 mm Orthoglide *)

Definition L_200 : R := leg_length_for 200.

Lemma sqrt_2_3 : sqrt 2 ^ 2 = 2 /\ sqrt 3 ^ 2 = 3 /\ 0 < sqrt 2 /\ 0 < sqrt 3.
Proof. rewrite <- !Rsqr_pow2, !Rsqr_sqrt by lra. repeat split; try reflexivity; apply sqrt_lt_R0; lra. Qed.

Lemma L_200_closed_form : L_200 = 300 * sqrt 2 * (sqrt 3 - 1).
Proof.
  unfold L_200, leg_length_for, side_for_unit_length. destruct sqrt_18_6 as [-> ->].
  destruct sqrt_2_3 as [e2 [e3 [p2 p3]]]. set (u := sqrt 2) in *. set (v := sqrt 3) in *.
  assert (D : 1 / (3 * u) + 1 / (u * v) = (v + 3) / (3 * u * v)) by (field; lra). rewrite D.
  apply Rmult_eq_reg_r with ((v + 3) / (3 * u * v)).
  2: { apply Rgt_not_eq, Rdiv_lt_0_compat; nra. }
  replace (200 / ((v + 3) / (3 * u * v)) * ((v + 3) / (3 * u * v))) with 200 by (field; lra).
  replace (300 * u * (v - 1) * ((v + 3) / (3 * u * v))) with (100 * (v ^ 2 + 2 * v - 3) / v) by (field; lra).
  rewrite e3. field. lra.
Qed.

Lemma q_1_200 : q_1 L_200 2 = - (100 * (sqrt 3 - 1)).
Proof.
  rewrite q_1_psi_2, L_200_closed_form. destruct sqrt_18_6 as [-> _]. destruct sqrt_2_3 as [_ [_ [p2 _]]]. field. lra.
Qed.

Lemma q_2_200 : q_2 L_200 2 = 100 * (3 - sqrt 3).
Proof.
  rewrite q_2_psi_2, L_200_closed_form. destruct sqrt_18_6 as [_ ->]. destruct sqrt_2_3 as [_ [e3 [p2 p3]]].
  set (v := sqrt 3) in *. replace (100 * (3 - v)) with (100 * (3 * v - v ^ 2) / v) by (field; lra).
  rewrite e3. field. lra.
Qed.

(** In decimals: L = 310.582854..., q_1 = -73.2050807..., q_2 = 126.794919... *)
Lemma sqrt_bounds : forall a lo hi, 0 < lo -> lo ^ 2 < a < hi ^ 2 -> 0 < hi -> lo < sqrt a < hi.
Proof.
  intros a lo hi l [h1 h2] h. split; apply Rsqr_incrst_0; try apply sqrt_pos; try lra;
    rewrite Rsqr_sqrt by nra; rewrite Rsqr_pow2; lra.
Qed.

Theorem numbers_200 :
  310.582854 < L_200 < 310.582855 /\
  - 73.205081 < q_1 L_200 2 < - 73.205080 /\ 126.794919 < q_2 L_200 2 < 126.794920.
Proof.
  rewrite q_1_200, q_2_200, L_200_closed_form.
  pose proof (sqrt_bounds 2 1.4142135623 1.4142135624 ltac:(lra) ltac:(lra) ltac:(lra)).
  pose proof (sqrt_bounds 3 1.7320508075 1.7320508076 ltac:(lra) ltac:(lra) ltac:(lra)).
  repeat split; nra.
Qed.

(** The machine with L = 200 / (1/sqrt 18 + 1/sqrt 6) mm and the cube of side
    200 mm from -100 (sqrt 3 - 1) = -73.2 to 100 (3 - sqrt 3) = 126.8 mm. *)
Theorem orthoglide_200 : forall a e P,
  in_box (- (100 * (sqrt 3 - 1))) (100 * (3 - sqrt 3)) P ->
  transmission_within 2 (orthoglide L_200 a e) P.
Proof.
  intros a e P h. apply q1q2_postulate; [| lra |].
  - destruct numbers_200. lra.
  - unfold in_cube. rewrite q_1_200, q_2_200. exact h.
Qed.

(** With the rounded length L = 310 mm, no diagonal cube of side 199.625 mm
    satisfies the bounds. *)
Theorem L_310_too_short : forall a e c1 c2, 0 < c1 -> 0 < c2 ->
  (forall P, in_box (- c1) c2 P -> transmission_within 2 (orthoglide 310 a e) P) ->
  c1 + c2 < 199.625.
Proof.
  intros a e c1 c2 p1 p2 all. apply (largest_cube 310 a e ltac:(lra)) in all; try lra.
  assert (S : c1 + c2 <= 310 * side_for_unit_length) by (rewrite <- side_psi_2; lra).
  destruct numbers_200 as [b _].
  assert (E : L_200 * side_for_unit_length = 200)
    by (unfold L_200, leg_length_for; field; apply Rgt_not_eq, side_for_unit_length_pos).
  pose proof side_for_unit_length_pos. nra.
Qed.

(** ** Step 3: base distance and joint range

    With a = q_1 - e - L every joint coordinate stays in [0, rho_max],
    rho_max = (q_2 - q_1) + L - s(Q_2), on the cube; 0 is reached where the
    platform is on the joint's axis at q_1, rho_max at Q_2. *)

Section JointRange.
Variables L e psi : R.
Hypothesis L_pos : 0 < L.
Hypothesis psi_gt_1 : 1 < psi.
Let a := q_1 L psi - e - L.
Let m := orthoglide L a e.
Definition rho_max : R := q_2 L psi - q_1 L psi + L - L * (position_of_entry (t_2 (1 / psi)) / t_2 (1 / psi)).

Lemma rho_orthoglide : forall P, let p := vscale (/ L) P in
  rho (leg1 m) P = vx P - q_1 L psi + L - L * s_unit (vy p) (vz p) /\
  rho (leg2 m) P = vy P - q_1 L psi + L - L * s_unit (vx p) (vz p) /\
  rho (leg3 m) P = vz P - q_1 L psi + L - L * s_unit (vx p) (vy p).
Proof.
  intros [x y z] p. destruct (orthoglide_s L a e L_pos (Vec x y z)) as [E1 [E2 E3]]. fold p in E1, E2, E3.
  unfold rho, eta. fold m in E1, E2, E3. rewrite E1, E2, E3. clear E1 E2 E3. clearbody p.
  unfold w, m, orthoglide; cbn [leg1 leg2 leg3 axis base_point platform_offset working_mode].
  unfold vadd, vsub, vscale, dot, e1, e2, e3; cbn [vx vy vz]. unfold a.
  repeat split; ring.
Qed.

Theorem joint_range : forall P, in_cube L psi P ->
  0 <= rho (leg1 m) P <= rho_max /\ 0 <= rho (leg2 m) P <= rho_max /\ 0 <= rho (leg3 m) P <= rho_max.
Proof.
  intros P h. destruct (rho_orthoglide P) as [-> [-> ->]].
  destruct (corners psi psi_gt_1) as [_ [D2 _]].
  pose proof (cube_inside L L_pos psi psi_gt_1 P h) as [hx [hy hz]].
  assert (S : forall u v, - position_of_entry (t_2 (1 / psi)) <= u <= position_of_entry (t_2 (1 / psi)) ->
    - position_of_entry (t_2 (1 / psi)) <= v <= position_of_entry (t_2 (1 / psi)) ->
    L * (position_of_entry (t_2 (1 / psi)) / t_2 (1 / psi)) <= L * s_unit u v <= L).
  { intros u v hu hv. pose proof (s_unit_lower _ _ u v D2 hu hv). pose proof (s_unit_upper _ _ u v D2 hu hv).
    split; [apply Rmult_le_compat_l; lra |]. replace L with (L * 1) at 2 by ring.
    apply Rmult_le_compat_l; lra. }
  destruct h as [bx [by_ bz]]. unfold rho_max.
  pose proof (S _ _ hy hz). pose proof (S _ _ hx hz). pose proof (S _ _ hx hy). lra.
Qed.

Theorem joint_range_reached :
  rho (leg1 m) (Vec (q_1 L psi) 0 0) = 0 /\ rho (leg1 m) (Q_2 L psi) = rho_max.
Proof.
  split; [rewrite (proj1 (rho_orthoglide _)) | rewrite (proj1 (rho_orthoglide (Q_2 L psi)))];
    cbn [vscale vx vy vz Q_2 diagonal].
  - rewrite Rmult_0_r. unfold s_unit. replace (1 - 0 ^ 2 - 0 ^ 2) with 1 by ring. rewrite sqrt_1. ring.
  - destruct (corners psi psi_gt_1) as [_ [D2 _]]. unfold rho_max, q_2.
    replace (/ L * (L * position_of_entry (t_2 (1 / psi)))) with (position_of_entry (t_2 (1 / psi))) by (field; lra).
    rewrite (diagonal_s _ _ D2) by reflexivity. ring.
Qed.
End JointRange.

(** At psi = 2, rho_max = L - q_1 - q_2: 256.993 mm for the 200 mm machine. *)
Theorem rho_max_200 : 256.993 < rho_max L_200 2 < 256.994.
Proof.
  assert (E : rho_max L_200 2 = L_200 - q_1 L_200 2 - q_2 L_200 2).
  { assert (t : t_2 (1 / 2) = 1 / 2) by (unfold t_2; destruct (Rle_dec (1 / 2) (1 / 2)); lra).
    unfold rho_max, q_2. rewrite t. field. }
  rewrite E. destruct numbers_200 as [? [? ?]]. lra.
Qed.
