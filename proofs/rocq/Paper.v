(** * The paper's cube, in one place

    D. Chablat and Ph. Wenger, "Architecture Optimization of a 3-DOF Translational Parallel Mechanism for Machining
    Applications, the Orthoglide".  The paper asks that the velocity transmission factors be in [1/psi, psi] on a cube;
    finds the corners Q_1 and Q_2 of the cube on the diagonal, where they reach their bounds; and postulates
    that it is enough to look there.  What is so of it, for every psi > 1, every leg length L, base distance a and
    tool offset e, is stated here; and what the paper does not say: that no two points of the cube have the
    same joint coordinates, since none are less than 1/psi of their distance apart in the space of joints. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity MeanValue Diagonal CubeLower CubeUpper Scaling Postulate Extremes.
Local Open Scope R_scope.

(** The joint coordinates at P. *)
Definition joints (m : machine) (P : vec) : vec := Vec (rho (leg1 m) P) (rho (leg2 m) P) (rho (leg3 m) P).

(** ** Between two points *)

Definition between (P Q : vec) (u : R) : vec := vadd P (vscale u (vsub Q P)).

Lemma between_velocity : forall P Q u, has_velocity (between P Q) u (vsub Q P).
Proof.
  intros [a b c] [a' b' c'] u. unfold has_velocity, between. unfold_vec.
  assert (X : forall x y, derivable_pt_lim (fun v => x + v * (y - x)) u (y - x)).
  { intros x y. apply derivable_eq with (fun v => x + (y - x) * v) (0 + (y - x) * 1); try (intros; ring).
    apply derivable_add; [apply derivable_const | apply derivable_scal, derivable_pt_lim_id]. }
  repeat split; apply X.
Qed.

Lemma between_in_box : forall lo hi P Q u, 0 <= u <= 1 -> in_box lo hi P -> in_box lo hi Q -> in_box lo hi (between P Q u).
Proof.
  intros lo hi [a b c] [a' b' c'] u hu. unfold in_box, between. unfold_vec. intros h h'. repeat split; nra.
Qed.

Section Machine.
Variables L a e psi : R.
Hypothesis L_pos : 0 < L.
Hypothesis psi_gt_1 : 1 < psi.
Let m := orthoglide L a e.

(** J^-1 turns no velocity by a right angle: |v|^2/psi <= v . J^-1 v. *)
Theorem forward : forall P v, in_cube L psi P -> 1 / psi * norm2 v <= dot v (mulv (Jinv m P) v).
Proof.
  intros P v h. pose proof (kappa_01 psi psi_gt_1) as k. destruct (t_facts _ k) as [T1 [T2 [E [F _]]]].
  destruct (corners psi psi_gt_1) as [D1 [D2 _]]. unfold m. rewrite orthoglide_Jinv by (assumption || (apply (cube_reachable L L_pos psi psi_gt_1), h)).
  apply (cube_lower_form (1 / psi) (position_of_entry (t_1 (1 / psi))) (position_of_entry (t_2 (1 / psi))) (t_1 (1 / psi)) (t_2 (1 / psi))); auto; try lra.
  apply (cube_scaled L L_pos psi), h.
Qed.

(** Along any direction u, joint coordinates of two points differ as the derivative somewhere between them says. *)
Lemma joints_between : forall P Q u, in_cube L psi P -> in_cube L psi Q ->
  exists C, in_cube L psi C /\ dot u (vsub (joints m Q) (joints m P)) = dot u (mulv (Jinv m C) (vsub Q P)).
Proof.
  intros P Q u hP hQ.
  assert (I : forall t, 0 <= t <= 1 -> in_cube L psi (between P Q t)) by (intros t ht; apply between_in_box; assumption).
  destruct (mean_value_theorem (fun t => dot u (joints m (between P Q t)))
    (fun t => dot u (mulv (Jinv m (between P Q t)) (vsub Q P))) 0 1 ltac:(lra)) as [c [E hc]].
  - intros t ht. destruct (q1q2_postulate L a e L_pos psi psi_gt_1 _ (I t ht)) as [[s1 [s2 [s3 _]]] _].
    apply velocity_dot. apply (Jinv_is_derivative m (between P Q)); [apply orthoglide_well_formed, L_pos | exact s1 | exact s2 | exact s3 | apply between_velocity].
  - exists (between P Q c). split; [apply I; lra |].
    replace (between P Q 1) with Q in E by (unfold between; destruct P, Q; unfold_vec; f_equal; ring).
    replace (between P Q 0) with P in E by (unfold between; destruct P, Q; unfold_vec; f_equal; ring).
    rewrite Rminus_0_r, Rmult_1_r in E. rewrite <- E. generalize (joints m Q) (joints m P). intros [x y z] [x' y' z']. destruct u. unfold_vec. ring.
Qed.

(** ** Joint coordinates are as far apart as points, but for the factor psi *)

Theorem joints_apart : forall P Q, in_cube L psi P -> in_cube L psi Q ->
  (1 / psi) ^ 2 * norm2 (vsub Q P) <= norm2 (vsub (joints m Q) (joints m P)) <= psi ^ 2 * norm2 (vsub Q P).
Proof.
  intros P Q hP hQ. destruct (kappa_range psi psi_gt_1) as [k _]. split.
  - apply norm2_from_dot; [lra |]. destruct (joints_between P Q (vsub Q P) hP hQ) as [C [hC E]]. rewrite E. apply forward, hC.
  - set (u := vsub (joints m Q) (joints m P)). destruct (joints_between P Q u hP hQ) as [C [hC E]]. fold u in E.
    destruct (q1q2_postulate L a e L_pos psi psi_gt_1 C hC) as [_ b]. specialize (b (vsub Q P)). fold m in b.
    pose proof (cauchy_schwarz u (mulv (Jinv m C) (vsub Q P))) as cs. rewrite <- E, <- norm2_dot in cs.
    pose proof (norm2_nonneg u). destruct (Req_dec (norm2 u) 0) as [z | nz].
    { rewrite z. pose proof (norm2_nonneg (vsub Q P)). apply Rmult_le_pos; [apply pow2_ge_0 | assumption]. }
    apply Rle_trans with (norm2 (mulv (Jinv m C) (vsub Q P))); [| apply b].
    apply Rmult_le_reg_l with (norm2 u); [lra |]. replace (norm2 u * norm2 u) with (norm2 u ^ 2) by ring. exact cs.
Qed.

(** Direct kinematics has one solution in the cube. *)
Corollary one_to_one : forall P Q, in_cube L psi P -> in_cube L psi Q -> joints m P = joints m Q -> P = Q.
Proof.
  intros P Q hP hQ E. destruct (joints_apart P Q hP hQ) as [h _]. rewrite E in h. destruct (kappa_range psi psi_gt_1) as [k _].
  replace (vsub (joints m Q) (joints m Q)) with vzero in h by (generalize (joints m Q); intros []; unfold_vec; f_equal; ring).
  assert (Z : norm2 (vsub Q P) = 0).
  { pose proof (norm2_nonneg (vsub Q P)). assert (0 < (1 / psi) ^ 2) by (apply pow_lt; lra).
    replace (norm2 vzero) with 0 in h by (unfold_vec; ring). nra. }
  apply norm2_zero in Z. destruct P as [x y z], Q as [x' y' z']. unfold vsub, vzero in Z. injection Z as e1 e2 e3.
  cbn [vx vy vz] in *. f_equal; lra.
Qed.
End Machine.

(** ** The cube of a required side *)

(** The side of the paper's cube, over L. *)
Definition side_over_length (psi : R) : R := position_of_entry (t_2 (1 / psi)) + position_of_entry (t_1 (1 / psi)).

Lemma side_pos : forall psi, 1 < psi -> 0 < side_over_length psi.
Proof. intros psi h. destruct (corners psi h) as [[p1 _] [[p2 _] _]]. unfold side_over_length. lra. Qed.

Lemma side_is : forall L psi, q_2 L psi - q_1 L psi = L * side_over_length psi.
Proof. intros. unfold q_1, q_2, side_over_length. ring. Qed.

(** What the paper's design has, for every psi > 1 and every side: with legs of length L = side / side_over_length psi, on the cube from Q_1 to Q_2,

    - no point is singular, and all transmission factors are within [1/psi, psi];
    - the bounds are reached at Q_1 and Q_2, and nowhere else;
    - no two points have the same joint coordinates;
    - no cube on the diagonal that is not part of it is as good: with shorter legs there is none of that side. *)
Theorem paper : forall psi side a e, 1 < psi -> 0 < side -> let L := side / side_over_length psi in let m := orthoglide L a e in
  0 < L /\ q_2 L psi - q_1 L psi = side /\
  (forall P, in_cube L psi P -> transmission_within psi m P) /\
  (forall P, in_cube L psi P ->
     (stretches_by (1 / psi) (Jinv m P) \/ stretches_by psi (Jinv m P) <-> P = Q_1 L psi \/ P = Q_2 L psi)) /\
  (forall P Q, in_cube L psi P -> in_cube L psi Q -> joints m P = joints m Q -> P = Q) /\
  (forall L' c1 c2, 0 < L' -> 0 < c1 -> 0 < c2 ->
     (forall P, in_box (- c1) c2 P -> transmission_within psi (orthoglide L' a e) P) -> side <= c1 + c2 -> L <= L').
Proof.
  intros psi side a e hpsi hs L m. pose proof (side_pos psi hpsi) as w.
  assert (L0 : 0 < L) by (apply Rdiv_lt_0_compat; assumption).
  assert (E : L * side_over_length psi = side) by (unfold L; field; lra).
  split; [exact L0 |]. split; [rewrite side_is; exact E |].
  split; [intros P h; apply q1q2_postulate; assumption |]. split; [intros P h; apply tight_only_at_Q1_Q2; assumption |].
  split; [intros P Q; apply one_to_one; assumption |]. intros L' c1 c2 p p1 p2 all le.
  apply (proj1 (largest_cube L' a e p psi c1 c2 hpsi p1 p2)) in all. pose proof (side_is L' psi) as S.
  apply Rmult_le_reg_r with (side_over_length psi); [exact w |]. lra.
Qed.
