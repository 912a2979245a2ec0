(** * Closed-form extremes on any diagonal cube

    For an Orthoglide with legs of length L and the cube [-c1, c2]^3, let T
    and U be the absolute values of the off-diagonal entries of J^-1 at the
    corners Q_1 = (-c1,-c1,-c1) and Q_2 = (c2,c2,c2).  If the cube stays short
    of the two parallel singularities on the diagonal (c1 < L/sqrt 6 and
    c2 < L/sqrt 3, that is 2T < 1 and U < 1) then

      min sigma_min = 1 - max(2T, U)         reached at Q_1 or Q_2,
      max sigma_max = 1 + 2U if c1 <= c2     reached at Q_2.

    So the bounds at Q_1 and Q_2 imply the bounds on the cube, and the paper's
    cube is the largest one. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal CubeLower CubeUpper Scaling Postulate.
Local Open Scope R_scope.

(** c / s(c,c,c): the off-diagonal entries of J^-1 at (c,c,c), in mm. *)
Definition corner_entry (L c : R) : R := c / sqrt (L ^ 2 - 2 * c ^ 2).

Section Extremes.
Variables L a e : R.
Hypothesis L_pos : 0 < L.
Let m := orthoglide L a e.

Lemma corner_entry_on_diagonal : forall c, 0 < c -> 2 * c ^ 2 < L ^ 2 ->
  on_diagonal (c / L) (corner_entry L c).
Proof.
  intros c c0 h. assert (L2 : 0 < L ^ 2) by (apply pow_lt; exact L_pos).
  assert (E : corner_entry L c = entry_of_position (c / L)).
  { unfold corner_entry, entry_of_position.
    replace (L ^ 2 - 2 * c ^ 2) with (L ^ 2 * (1 - 2 * (c / L) ^ 2)) by (field; lra).
    assert (p : 0 < 1 - 2 * (c / L) ^ 2).
    { apply Rmult_lt_reg_l with (L ^ 2); [exact L2 |].
      replace (L ^ 2 * (1 - 2 * (c / L) ^ 2)) with (L ^ 2 - 2 * c ^ 2) by (field; lra). lra. }
    rewrite sqrt_mult_alt by lra. rewrite sqrt_pow2 by lra. pose proof (sqrt_lt_R0 _ p). field. lra. }
  rewrite E. apply entry_on_diagonal; [apply Rdiv_lt_0_compat; assumption |].
  apply Rmult_lt_reg_l with (L ^ 2); [exact L2 |].
  replace (L ^ 2 * (2 * (c / L) ^ 2)) with (2 * c ^ 2) by (field; lra). lra.
Qed.

(** An entry below a given one, in terms of the position. *)
Lemma entry_below : forall c t n, on_diagonal (c / L) t -> 0 < n -> 0 < c ->
  (c ^ 2 * (1 + 2 * n ^ 2) < n ^ 2 * L ^ 2 <-> t < n).
Proof.
  intros c t n D n0 c0. pose proof (position_on_diagonal n n0) as N.
  pose proof (diagonal_lt _ _ _ _ D N) as lt. destruct N as [p0 [_ f]].
  set (p := position_of_entry n) in *. rewrite <- lt. clear lt D t.
  assert (L2 : 0 < L ^ 2) by (apply pow_lt; exact L_pos).
  assert (W : 0 < 1 + 2 * n ^ 2) by nra.
  assert (E : c = L * (c / L)) by (field; lra). set (d := c / L) in *.
  assert (d0 : 0 < d) by (apply Rdiv_lt_0_compat; assumption). rewrite E. clear E.
  replace ((L * d) ^ 2 * (1 + 2 * n ^ 2)) with (d ^ 2 * (L ^ 2 * (1 + 2 * n ^ 2))) by ring.
  replace (n ^ 2 * L ^ 2) with (p ^ 2 * (L ^ 2 * (1 + 2 * n ^ 2)))
    by (transitivity (p ^ 2 * (1 + 2 * n ^ 2) * L ^ 2); [ring | rewrite f; reflexivity]).
  assert (LW : 0 < L ^ 2 * (1 + 2 * n ^ 2)) by (apply Rmult_lt_0_compat; lra).
  split; intro h.
  - apply Rmult_lt_reg_r in h; [| exact LW]. apply Rsqr_incrst_0; try lra. rewrite !Rsqr_pow2. exact h.
  - apply Rmult_lt_compat_r; [exact LW |]. rewrite <- !Rsqr_pow2. apply Rsqr_incrst_1; lra.
Qed.

Section Cube.
Variables c1 c2 : R.
Hypothesis c1_pos : 0 < c1.
Hypothesis c2_pos : 0 < c2.
Hypothesis before_singularity_1 : 6 * c1 ^ 2 < L ^ 2.
Hypothesis before_singularity_2 : 3 * c2 ^ 2 < L ^ 2.
Let T := corner_entry L c1.
Let U := corner_entry L c2.

Lemma corner_1 : on_diagonal (c1 / L) T /\ 2 * T < 1.
Proof.
  assert (D : on_diagonal (c1 / L) T) by (apply corner_entry_on_diagonal; nra).
  split; [exact D |]. pose proof (proj1 (entry_below c1 T (1/2) D ltac:(lra) c1_pos) ltac:(lra)). lra.
Qed.

Lemma corner_2 : on_diagonal (c2 / L) U /\ U < 1.
Proof.
  assert (D : on_diagonal (c2 / L) U) by (apply corner_entry_on_diagonal; nra).
  split; [exact D |]. apply (entry_below c2 U 1 D); lra.
Qed.

Lemma box_scaled : forall P, in_box (- c1) c2 P <-> in_box (- (c1 / L)) (c2 / L) (vscale (/ L) P).
Proof.
  intro P. rewrite <- (in_box_scale L L_pos).
  replace (L * - (c1 / L)) with (- c1) by (field; lra). replace (L * (c2 / L)) with c2 by (field; lra).
  reflexivity.
Qed.

Lemma box_reachable : forall P, in_box (- c1) c2 P -> reachable_unit (vscale (/ L) P).
Proof.
  intros P h. apply box_scaled in h. destruct corner_1 as [D1 _]. destruct corner_2 as [D2 _].
  pose proof (proj1 D1). pose proof (proj1 D2). destruct (Rle_dec (c1 / L) (c2 / L)).
  - apply (in_box_reachable (c2 / L) U); [exact D2 | revert h; unfold in_box; lra].
  - apply (in_box_reachable (c1 / L) T); [exact D1 | revert h; unfold in_box; lra].
Qed.

Lemma M_at_corner_1 : Jinv m (diagonal (- c1)) = constant_offdiagonal (- T).
Proof.
  replace (- c1) with (L * - (c1 / L)) by (field; lra).
  apply Jinv_diagonal_neg; [exact L_pos | apply corner_1].
Qed.

Lemma M_at_corner_2 : Jinv m (diagonal c2) = constant_offdiagonal U.
Proof.
  replace c2 with (L * (c2 / L)) by (field; lra).
  apply Jinv_diagonal_pos; [exact L_pos | apply corner_2].
Qed.

Lemma corner_in_box : in_box (- c1) c2 (diagonal (- c1)) /\ in_box (- c1) c2 (diagonal c2).
Proof. unfold in_box, diagonal; cbn [vx vy vz]. lra. Qed.

(** The corners decide the lower bound. *)
Lemma lower_on_cube : forall kappa P, 0 <= kappa -> 2 * T <= 1 - kappa -> U <= 1 - kappa ->
  in_box (- c1) c2 P -> sigma_at_least kappa (Jinv m P).
Proof.
  intros kappa P k0 kT kU h. unfold m. rewrite orthoglide_Jinv by (assumption || (apply box_reachable; exact h)).
  apply (cube_lower kappa (c1 / L) (c2 / L) T U); auto; [apply corner_1 | apply corner_2 |].
  apply box_scaled; exact h.
Qed.

(** Every diagonal cube short of the singularities is free of singularities. *)
Theorem cube_regular : forall P, in_box (- c1) c2 P -> regular m P.
Proof.
  intros P h. destruct corner_1 as [_ t]. destruct corner_2 as [_ u].
  pose proof (Rmax_l (2 * T) U). pose proof (Rmax_r (2 * T) U).
  assert (Rmax (2 * T) U < 1) by (apply Rmax_lub_lt; assumption).
  assert (low : sigma_at_least (1 - Rmax (2 * T) U) (Jinv m P)) by (apply lower_on_cube; auto; lra).
  unfold m in *. rewrite orthoglide_Jinv in low by (assumption || (apply box_reachable; exact h)).
  apply (orthoglide_regular L a e L_pos P (1 - Rmax (2 * T) U)); [lra | apply box_reachable; exact h | exact low].
Qed.

Theorem min_sigma_min : let sigma := 1 - Rmax (2 * T) U in
  (forall P, in_box (- c1) c2 P -> sigma_at_least sigma (Jinv m P)) /\
  exists Q, (Q = diagonal (- c1) \/ Q = diagonal c2) /\ in_box (- c1) c2 Q /\ singular_value sigma (Jinv m Q).
Proof.
  intro sigma. destruct corner_1 as [_ t]. destruct corner_2 as [_ u].
  pose proof (Rmax_l (2 * T) U). pose proof (Rmax_r (2 * T) U).
  assert (Rmax (2 * T) U < 1) by (apply Rmax_lub_lt; assumption).
  assert (low : forall P, in_box (- c1) c2 P -> sigma_at_least sigma (Jinv m P))
    by (intros; apply lower_on_cube; auto; unfold sigma; lra).
  split; [exact low |].
  assert (X : forall Q, in_box (- c1) c2 Q -> stretches_by sigma (Jinv m Q) -> singular_value sigma (Jinv m Q))
    by (intros; apply reached_lower_bound; auto; unfold sigma; lra).
  destruct corner_in_box as [b1 b2].
  destruct (Rle_dec U (2 * T)) as [le | gt].
  - exists (diagonal (- c1)). split; [left; reflexivity |]. split; [exact b1 |]. apply X; [exact b1 |].
    rewrite M_at_corner_1. replace sigma with (1 + 2 * - T) by (unfold sigma; rewrite Rmax_left; lra).
    apply stretches_along.
  - exists (diagonal c2). split; [right; reflexivity |]. split; [exact b2 |]. apply X; [exact b2 |].
    rewrite M_at_corner_2. replace sigma with (1 - U) by (unfold sigma; rewrite Rmax_right; lra).
    apply stretches_across.
Qed.

Theorem max_sigma_max : c1 <= c2 ->
  (forall P, in_box (- c1) c2 P -> sigma_at_most (1 + 2 * U) (Jinv m P)) /\
  in_box (- c1) c2 (diagonal c2) /\ singular_value (1 + 2 * U) (Jinv m (diagonal c2)).
Proof.
  intro le. destruct corner_2 as [D2 u]. pose proof D2 as [_ [u0 _]].
  assert (le' : c1 / L <= c2 / L)
    by (apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat |]; assumption).
  assert (up : forall P, in_box (- c1) c2 P -> sigma_at_most (1 + 2 * U) (Jinv m P)).
  { intros P h. unfold m. rewrite orthoglide_Jinv by (assumption || (apply box_reachable; exact h)).
    apply (cube_upper (c2 / L)); [exact D2 |]. apply box_scaled in h. revert h. unfold in_box. lra. }
  destruct corner_in_box as [_ b2]. split; [exact up |]. split; [exact b2 |].
  apply reached_upper_bound; [lra | apply up; exact b2 |]. rewrite M_at_corner_2. apply stretches_along.
Qed.

(** ** Bounds at Q_1 and Q_2 imply bounds on the cube *)

Definition bounded_at (psi : R) (Q : vec) : Prop :=
  sigma_at_least (1 / psi) (Jinv m Q) /\ sigma_at_most psi (Jinv m Q).

Theorem corners_suffice : forall psi, 1 < psi ->
  bounded_at psi (diagonal (- c1)) -> bounded_at psi (diagonal c2) ->
  forall P, in_box (- c1) c2 P -> transmission_within psi m P.
Proof.
  intros psi hpsi [low1 _] [low2 up2] P h.
  destruct corner_1 as [D1 t]. destruct corner_2 as [D2 u]. pose proof D1 as [_ [t0 _]]. pose proof D2 as [_ [u0 _]].
  destruct (kappa_range psi hpsi) as [k _].
  rewrite M_at_corner_1 in low1. rewrite M_at_corner_2 in low2, up2.
  assert (len : 0 < norm2 (Vec 1 1 1) /\ 0 < norm2 (Vec 1 (-1) 0))
    by (split; apply norm2_pos; [apply ones_nonzero | apply difference_nonzero]).
  assert (sq : forall x y n, 0 <= x -> 0 <= y -> 0 < n -> x ^ 2 * n <= y ^ 2 * n -> x <= y).
  { intros x y n x0 y0 n0 hn. apply Rmult_le_reg_r in hn; [| exact n0].
    apply Rsqr_incr_0_var; [rewrite !Rsqr_pow2; exact hn | exact y0]. }
  specialize (low1 (Vec 1 1 1)). rewrite diagonal_stretch_along in low1. apply sq in low1; try lra.
  specialize (low2 (Vec 1 (-1) 0)). rewrite diagonal_stretch_across in low2. apply sq in low2; try lra.
  specialize (up2 (Vec 1 1 1)). rewrite diagonal_stretch_along in up2. apply sq in up2; try lra.
  (* the reciprocal bound at Q_1 also limits 1 + 2T: psi >= 1/(1-2T) >= 1+2T *)
  assert (upT : 1 + 2 * T <= psi).
  { assert (E : 1 / psi * psi = 1) by (field; lra). nra. }
  assert (low : sigma_at_least (1 / psi) (Jinv m P)) by (apply lower_on_cube; auto; lra).
  assert (up : sigma_at_most psi (Jinv m P)).
  { unfold m. rewrite orthoglide_Jinv by (assumption || (apply box_reachable; exact h)).
    apply box_scaled in h. destruct (Rle_dec (c1 / L) (c2 / L)).
    - apply sigma_at_most_weaken with (1 + 2 * U); [lra |]. apply (cube_upper (c2 / L)); [exact D2 |].
      revert h. unfold in_box. lra.
    - apply sigma_at_most_weaken with (1 + 2 * T); [lra |]. apply (cube_upper (c1 / L)); [exact D1 |].
      revert h. unfold in_box. lra. }
  split; [apply cube_regular; exact h |]. intro v. split; [apply low | apply up].
Qed.
End Cube.

(** ** The paper's cube is the largest *)

Theorem largest_cube : forall psi c1 c2, 1 < psi -> 0 < c1 -> 0 < c2 ->
  ((forall P, in_box (- c1) c2 P -> transmission_within psi m P)
   <-> c1 <= - q_1 L psi /\ c2 <= q_2 L psi).
Proof.
  intros psi c1 c2 hpsi p1 p2. destruct (kappa_range psi hpsi) as [k inv].
  destruct (t_facts _ k) as [T1 [T2 [E1 _]]]. destruct (corners psi hpsi) as [D1 [D2 _]].
  set (kappa := 1 / psi) in *.
  set (d1 := position_of_entry (t_1 kappa)) in *. set (d2 := position_of_entry (t_2 kappa)) in *.
  assert (q1e : - q_1 L psi = L * d1) by (unfold q_1; fold kappa; fold d1; ring).
  assert (q2e : q_2 L psi = L * d2) by reflexivity.
  assert (sq : forall x y n, 0 <= x -> 0 <= y -> 0 < n -> x ^ 2 * n <= y ^ 2 * n -> x <= y).
  { intros x y n x0 y0 n0 hn. apply Rmult_le_reg_r in hn; [| exact n0].
    apply Rsqr_incr_0_var; [rewrite !Rsqr_pow2; exact hn | exact y0]. }
  assert (len : 0 < norm2 (Vec 1 1 1) /\ 0 < norm2 (Vec 1 (-1) 0))
    by (split; apply norm2_pos; [apply ones_nonzero | apply difference_nonzero]).
  (* a point of the diagonal beyond d, but not beyond the singular one n *)
  assert (beyond : forall c d t n, 0 < c -> on_diagonal d t -> t < n -> L * d < c ->
    exists d' t', on_diagonal d' t' /\ t < t' <= n /\ L * d' <= c).
  { intros c d t n c0 D tn lt. pose proof D as [_ [t0 _]].
    pose proof (position_on_diagonal n ltac:(lra)) as N. set (f := position_of_entry n) in *.
    assert (Ec : L * (c / L) = c) by (field; lra).
    assert (dc : d < c / L) by (apply Rmult_lt_reg_l with L; lra).
    assert (df : d < f) by (apply (diagonal_lt _ _ _ _ D N); exact tn).
    set (d' := Rmin (c / L) f).
    assert (lo : d < d') by (apply Rmin_glb_lt; assumption).
    assert (hi : d' <= f) by apply Rmin_r.
    assert (D' : on_diagonal d' (entry_of_position d')).
    { pose proof (diagonal_reach _ _ N). pose proof (proj1 D). apply entry_on_diagonal; [lra | nra]. }
    exists d', (entry_of_position d'). split; [exact D' |]. split.
    - split; [apply (diagonal_lt _ _ _ _ D D'); exact lo | apply (diagonal_le _ _ _ _ D' N); exact hi].
    - rewrite <- Ec. apply Rmult_le_compat_l; [lra | apply Rmin_l]. }
  split.
  - intro all. rewrite q1e, q2e. split; apply Rnot_lt_le; intro lt.
    + destruct (beyond c1 d1 (t_1 kappa) (1/2) p1 D1 ltac:(lra) lt) as [d' [t' [D' [tr le]]]].
      pose proof (proj1 D') as d0.
      assert (in_b : in_box (- c1) c2 (diagonal (L * - d')))
        by (unfold in_box, diagonal; cbn [vx vy vz]; assert (0 < L * d') by nra; lra).
      destruct (all _ in_b) as [_ b]. specialize (b (Vec 1 1 1)). unfold m in b.
      rewrite (Jinv_diagonal_neg L a e L_pos _ _ D'), diagonal_stretch_along in b.
      destruct b as [b _]. fold kappa in b. apply sq in b; lra.
    + destruct (beyond c2 d2 (t_2 kappa) 1 p2 D2 ltac:(lra) lt) as [d' [t' [D' [tr le]]]].
      pose proof (proj1 D') as d0.
      assert (in_b : in_box (- c1) c2 (diagonal (L * d')))
        by (unfold in_box, diagonal; cbn [vx vy vz]; assert (0 < L * d') by nra; lra).
      destruct (all _ in_b) as [_ b]. unfold m in b. rewrite (Jinv_diagonal_pos L a e L_pos _ _ D') in b.
      pose proof (proj2 (b (Vec 1 1 1))) as b1. pose proof (proj1 (b (Vec 1 (-1) 0))) as b2.
      rewrite diagonal_stretch_along in b1. rewrite diagonal_stretch_across in b2. fold kappa in b2.
      apply sq in b1; try lra. apply sq in b2; try lra.
      unfold t_2 in tr. destruct (Rle_dec kappa (1/2)); [lra |]. rewrite inv in tr. lra.
  - intros [h1 h2] P h. apply q1q2_postulate; [exact L_pos | exact hpsi |].
    unfold in_cube. revert h. unfold in_box. lra.
Qed.
End Extremes.
