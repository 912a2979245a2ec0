(** * The position near a point that has given joint coordinates

    Joint coordinates f near a point, of which the derivative changes by little, take a value near f(0) at
    exactly one position (step 2 and 3 of accuracy.rs): u -> W^-1 (b - (f(u) - f(0) - W u)) maps the ball into itself
    and contracts it, and so has one fixed point. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require MeanValue.
From Orthocert Require Import Vec3 SingularValues Velocity.
Local Open Scope R_scope.

(** ** Lengths of vectors *)

Definition size (v : vec) : R := sqrt (norm2 v).

Lemma size_nonneg : forall v, 0 <= size v.
Proof. intro v. apply sqrt_pos. Qed.
Lemma size_square : forall v, size v ^ 2 = norm2 v.
Proof. intro v. unfold size. rewrite <- Rsqr_pow2. apply Rsqr_sqrt, norm2_nonneg. Qed.
Lemma size_dot : forall v, size v * size v = dot v v.
Proof. intro v. rewrite <- norm2_dot, <- size_square. ring. Qed.
Lemma size_below : forall v a, 0 <= a -> norm2 v <= a ^ 2 -> size v <= a.
Proof. intros v a h k. unfold size. rewrite <- (sqrt_pow2 a h). apply sqrt_le_1_alt, k. Qed.
Lemma size_above : forall v a, size v <= a -> norm2 v <= a ^ 2.
Proof. intros v a h. rewrite <- size_square. pose proof (size_nonneg v). nra. Qed.
Lemma size_zero : size vzero = 0.
Proof. unfold size, norm2, vzero. cbn [vx vy vz]. replace (0 ^ 2 + 0 ^ 2 + 0 ^ 2) with 0 by ring. apply sqrt_0. Qed.
Lemma zero_size : forall v, size v <= 0 -> v = vzero.
Proof. intros v h. apply norm2_zero. pose proof (size_nonneg v). rewrite <- size_square. replace (size v) with 0 by lra. ring. Qed.

Lemma same_vector : forall u v, vsub u v = vzero -> u = v.
Proof. intros [a b c] [d e f] h. unfold vsub, vzero in h. cbn [vx vy vz] in h. injection h as h1 h2 h3. f_equal; lra. Qed.

Lemma dot_sizes : forall u v, dot u v <= size u * size v.
Proof.
  intros u v. pose proof (cauchy_schwarz u v) as c. rewrite <- !size_square in c. pose proof (size_nonneg u). pose proof (size_nonneg v).
  assert (0 <= size u * size v) by (apply Rmult_le_pos; assumption). apply Rnot_lt_le. intro n. nra.
Qed.

Lemma size_plus : forall u v, size (vadd u v) <= size u + size v.
Proof.
  intros u v. pose proof (size_nonneg u). pose proof (size_nonneg v). apply size_below; [lra |].
  replace (norm2 (vadd u v)) with (norm2 u + 2 * dot u v + norm2 v) by (unfold norm2, dot, vadd; cbn [vx vy vz]; ring).
  rewrite <- !size_square. pose proof (dot_sizes u v). nra.
Qed.

Lemma size_scaled : forall a v, 0 <= a -> size (vscale a v) = a * size v.
Proof. intros a v h. unfold size. rewrite norm2_scale, sqrt_mult_alt by apply pow2_ge_0. rewrite sqrt_pow2 by exact h. reflexivity. Qed.

Lemma size_opposite : forall u v, size (vsub u v) = size (vsub v u).
Proof. intros. unfold size. f_equal. unfold norm2, vsub. cbn [vx vy vz]. ring. Qed.

Lemma size_between : forall u v w, size (vsub u w) <= size (vsub u v) + size (vsub v w).
Proof.
  intros u v w. replace (vsub u w) with (vadd (vsub u v) (vsub v w)) by (unfold vadd, vsub; cbn [vx vy vz]; f_equal; ring). apply size_plus.
Qed.

Lemma component : forall v, Rabs (vx v) <= size v /\ Rabs (vy v) <= size v /\ Rabs (vz v) <= size v.
Proof.
  intro v. pose proof (size_nonneg v) as p. assert (K : forall a, a ^ 2 <= norm2 v -> Rabs a <= size v).
  { intros a h. rewrite <- size_square in h. apply Rabs_le. split; apply Rnot_lt_le; intro n; nra. }
  pose proof (pow2_ge_0 (vx v)). pose proof (pow2_ge_0 (vy v)). pose proof (pow2_ge_0 (vz v)).
  split; [| split]; apply K; unfold norm2; lra.
Qed.

Lemma size_components : forall v a, Rabs (vx v) <= a -> Rabs (vy v) <= a -> Rabs (vz v) <= a -> size v <= 2 * a.
Proof.
  assert (K : forall x a, Rabs x <= a -> x ^ 2 <= a ^ 2).
  { intros x a h. rewrite <- (pow2_abs x). pose proof (Rabs_pos x). nra. }
  intros v a hx hy hz. pose proof (Rabs_pos (vx v)). apply size_below; [lra |]. unfold norm2.
  apply K in hx, hy, hz. pose proof (pow2_ge_0 a). lra.
Qed.

(** ** Banach's theorem, in a ball *)

Lemma geometric : forall q C a b, 0 <= q < 1 -> (forall n, a <= b + q ^ n * C) -> a <= b.
Proof.
  intros q C a b [q0 q1] h. apply Rnot_lt_le. intro n.
  assert (e0 : 0 < (a - b) / (Rabs C + 1)) by (apply Rmult_lt_0_compat; [lra | apply Rinv_0_lt_compat; pose proof (Rabs_pos C); lra]).
  destruct (pow_lt_1_zero q ltac:(rewrite Rabs_pos_eq; lra) _ e0) as [k hk]. specialize (hk k (le_n k)). specialize (h k).
  rewrite Rabs_pos_eq in hk by (apply pow_le, q0). pose proof (Rabs_pos C). pose proof (Rle_abs C). pose proof (pow_le q k q0).
  assert (q ^ k * (Rabs C + 1) < a - b).
  { apply Rmult_lt_reg_r with (/ (Rabs C + 1)); [apply Rinv_0_lt_compat; lra |]. rewrite Rmult_assoc, Rinv_r by lra. unfold Rdiv in hk. lra. }
  nra.
Qed.

Lemma limit : forall q C (a : nat -> R), 0 <= q < 1 -> (forall n k, Rabs (a (n + k)%nat - a n) <= q ^ n * C) ->
  exists l, forall n, Rabs (l - a n) <= q ^ n * C.
Proof.
  intros q C a hq h.
  assert (Cauchy : Cauchy_crit a).
  { intros e e0. destruct hq as [q0 q1]. assert (f0 : 0 < e / (2 * (Rabs C + 1))) by (apply Rmult_lt_0_compat; [lra | apply Rinv_0_lt_compat; pose proof (Rabs_pos C); lra]).
    destruct (pow_lt_1_zero q ltac:(rewrite Rabs_pos_eq; lra) _ f0) as [N hN]. specialize (hN N (le_n N)). rewrite Rabs_pos_eq in hN by (apply pow_le, q0).
    exists N. intros n m hn hm. unfold R_dist.
    assert (K : forall n, (n >= N)%nat -> Rabs (a n - a N) <= q ^ N * C).
    { intros p hp. replace p with (N + (p - N))%nat by lia. apply h. }
    pose proof (K n hn) as h1. pose proof (K m hm) as h2. pose proof (pow_le q N q0). pose proof (Rle_abs C). pose proof (Rabs_pos C).
    assert (q ^ N * (2 * (Rabs C + 1)) < e).
    { apply Rmult_lt_reg_r with (/ (2 * (Rabs C + 1))); [apply Rinv_0_lt_compat; lra |]. rewrite Rmult_assoc, Rinv_r by lra. unfold Rdiv in hN. lra. }
    replace (a n - a m) with ((a n - a N) + - (a m - a N)) by ring. eapply Rle_lt_trans; [apply Rabs_triang |]. rewrite Rabs_Ropp. nra. }
  destruct (R_complete a Cauchy) as [l hl]. exists l. intro n. apply Rnot_lt_le. intro bad.
  destruct (hl (Rabs (l - a n) - q ^ n * C) ltac:(lra)) as [N hN]. specialize (hN (n + N)%nat ltac:(lia)). unfold R_dist in hN. specialize (h n N).
  assert (Rabs (l - a n) <= Rabs (a (n + N)%nat - l) + Rabs (a (n + N)%nat - a n)); [| lra].
  replace (l - a n) with (- (a (n + N)%nat - l) + (a (n + N)%nat - a n)) by ring. eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_Ropp. lra.
Qed.

Section Ball.
Variables (D q : R) (F : vec -> vec).
Hypothesis D_nonneg : 0 <= D.
Hypothesis q_below : 0 <= q < 1.
Hypothesis into : forall u, size u <= D -> size (F u) <= D.
Hypothesis contracts : forall u v, size u <= D -> size v <= D -> size (vsub (F u) (F v)) <= q * size (vsub u v).

Fixpoint iterate (n : nat) : vec := match n with O => vzero | S k => F (iterate k) end.

Lemma iterate_in : forall n, size (iterate n) <= D.
Proof. induction n as [| n IH]; cbn [iterate]; [rewrite size_zero; exact D_nonneg | apply into, IH]. Qed.

Let C := D / (1 - q).

Lemma iterate_near : forall k n, size (vsub (iterate (n + k)) (iterate n)) <= q ^ n * C.
Proof.
  assert (C0 : 0 <= C) by (unfold C; apply Rmult_le_pos; [exact D_nonneg | apply Rlt_le, Rinv_0_lt_compat; lra]).
  assert (Step : forall n, size (vsub (iterate (S n)) (iterate n)) <= q ^ n * D).
  { induction n as [| n IH]; cbn [iterate].
    - replace (vsub (F vzero) vzero) with (F vzero) by (apply vec_ext; unfold vsub, vzero; cbn [vx vy vz]; ring). rewrite pow_O, Rmult_1_l. apply into.
      rewrite size_zero. exact D_nonneg.
    - eapply Rle_trans; [apply contracts; [apply (iterate_in (S n)) | apply iterate_in] |]. cbn [pow]. rewrite Rmult_assoc.
      apply Rmult_le_compat_l; [apply q_below | exact IH]. }
  induction k as [| k IH]; intro n.
  - rewrite Nat.add_0_r. replace (vsub (iterate n) (iterate n)) with vzero by (unfold vsub, vzero; f_equal; ring). rewrite size_zero.
    apply Rmult_le_pos; [apply pow_le, q_below | exact C0].
  - eapply Rle_trans; [apply (size_between _ (iterate (S n))) |]. replace (n + S k)%nat with (S n + k)%nat by lia.
    apply Rle_trans with (q ^ S n * C + q ^ n * D); [apply Rplus_le_compat; [apply IH | apply Step] |].
    cbn [pow]. apply Req_le. unfold C. field. lra.
Qed.

Theorem fixed_point : exists u, (size u <= D /\ F u = u) /\ forall v, size v <= D -> F v = v -> v = u.
Proof.
  assert (L : forall f, (forall v w, Rabs (f v - f w) <= size (vsub v w)) -> exists l, forall n, Rabs (l - f (iterate n)) <= q ^ n * C).
  { intros f hf. apply limit; [exact q_below |]. intros n k. eapply Rle_trans; [apply hf | apply iterate_near]. }
  destruct (L vx) as [x hx]; [intros v w; apply (component (vsub v w)) |].
  destruct (L vy) as [y hy]; [intros v w; apply (component (vsub v w)) |].
  destruct (L vz) as [z hz]; [intros v w; apply (component (vsub v w)) |].
  set (u := Vec x y z).
  assert (Near : forall n, size (vsub u (iterate n)) <= q ^ n * (2 * C)).
  { intro n. replace (q ^ n * (2 * C)) with (2 * (q ^ n * C)) by ring. apply size_components; [apply hx | apply hy | apply hz]. }
  clearbody u. clear x y z hx hy hz L.
  assert (In : size u <= D).
  { apply (geometric q (2 * C)); [exact q_below |]. intro n.
    replace u with (vadd (iterate n) (vsub u (iterate n))) by (apply vec_ext; unfold vadd, vsub; cbn [vx vy vz]; ring).
    eapply Rle_trans; [apply size_plus |]. pose proof (iterate_in n). pose proof (Near n). lra. }
  assert (Fix : F u = u).
  { assert (Z : size (vsub (F u) u) <= 0).
    { apply (geometric q (4 * C)); [exact q_below |]. intro n. eapply Rle_trans; [apply (size_between _ (iterate (S n))) |]. cbn [iterate].
      pose proof (contracts u (iterate n) In (iterate_in n)) as h1. pose proof (Near (S n)) as h2. rewrite size_opposite in h2. cbn [iterate pow] in h2.
      pose proof (Near n) as h3. pose proof (size_nonneg (vsub u (iterate n))). pose proof (pow_le q n (proj1 q_below)).
      assert (q * size (vsub u (iterate n)) <= 1 * (q ^ n * (2 * C))) by (apply Rmult_le_compat; lra).
      assert (q * (q ^ n * (2 * C)) <= 1 * (q ^ n * (2 * C))) by (apply Rmult_le_compat_r; [eapply Rle_trans; [apply size_nonneg | exact h3] | lra]). lra. }
    exact (same_vector _ _ (zero_size _ Z)). }
  exists u. split; [split; assumption |]. intros v hv e.
    pose proof (contracts v u hv In) as h. rewrite e, Fix in h. pose proof (size_nonneg (vsub v u)).
    assert (Z : size (vsub v u) <= 0) by nra. exact (same_vector _ _ (zero_size _ Z)).
Qed.
End Ball.

(** ** The theorem *)

(** M^-1 b. *)
Definition solution (M : mat) (b : vec) : vec :=
  vscale (/ det M) (vadd (vadd (vscale (vx b) (cross (row2 M) (row3 M))) (vscale (vy b) (cross (row3 M) (row1 M)))) (vscale (vz b) (cross (row1 M) (row2 M)))).

Lemma solution_solves : forall M b, det M <> 0 -> mulv M (solution M b) = b.
Proof.
  intros [r1 r2 r3] b h. unfold solution. set (d := det (Mat r1 r2 r3)) in *.
  assert (E : forall r a, dot r (vscale (/ d) a) = / d * dot r a) by (intros; unfold dot, vscale; cbn [vx vy vz]; ring).
  unfold mulv. cbn [row1 row2 row3]. rewrite !E.
  assert (X : d = dot r1 (cross r2 r3)) by reflexivity.
  apply vec_ext; cbn [vx vy vz]; apply Rmult_eq_reg_l with d; try exact h; rewrite <- Rmult_assoc, Rinv_r, Rmult_1_l by exact h; rewrite X;
    unfold dot, cross, vadd, vscale; cbn [vx vy vz]; ring.
Qed.

Lemma det_transpose : forall M, det (transpose M) = det M.
Proof. intros [r1 r2 r3]. unfold det, transpose, col1, col2, col3, dot, cross. cbn [row1 row2 row3 vx vy vz]. ring. Qed.

Section Near.
Variables (f : vec -> vec) (J : vec -> mat) (D g kappa z : R) (b : vec).
Let W := J vzero.
Hypothesis D_pos : 0 < D.
Hypothesis g_nonneg : 0 <= g.
Hypothesis g_below : g < kappa.
Hypothesis z_nonneg : 0 <= z.
Hypothesis z_below : z + g / (2 * kappa) <= 1.
(** J is the derivative of f in the ball, and changes by little there. *)
Hypothesis smooth : forall u v, size u <= D -> size v <= D -> forall t, 0 <= t <= 1 ->
  has_velocity (fun x => f (vadd u (vscale x (vsub v u)))) t (mulv (J (vadd u (vscale t (vsub v u)))) (vsub v u)).
Hypothesis spread : forall u w, size u <= D -> size (mulv (msub (J u) W) w) <= g / D * size u * size w.
Hypothesis lower : forall w, kappa * size w <= size (mulv (transpose W) w).
(** What is in the bordered matrix. *)
Hypothesis first_order : forall w s, 0 < norm2 w + s ^ 2 -> 0 < norm2 (mulv (transpose W) w) + 2 * s * dot b w + (z * D) ^ 2 * s ^ 2.

Lemma kappa_pos : 0 < kappa.
Proof. lra. Qed.

Lemma regular_transpose : det (transpose W) <> 0.
Proof.
  apply trivial_kernel_det. intros v e. apply zero_size. pose proof (lower v) as h. rewrite e, size_zero in h.
  pose proof kappa_pos. pose proof (size_nonneg v). nra.
Qed.
Lemma regular_W : det W <> 0.
Proof. rewrite <- det_transpose. exact regular_transpose. Qed.

Lemma inverse_below : forall y, kappa * size (solution W y) <= size y.
Proof.
  intro y. set (a := solution W y). set (c := solution (transpose W) a). pose proof kappa_pos as k0.
  pose proof (solution_solves W y regular_W) as ea. fold a in ea. pose proof (solution_solves (transpose W) a regular_transpose) as ec. fold c in ec.
  pose proof (lower c) as h. rewrite ec in h.
  assert (E : size a * size a = dot c y) by (rewrite size_dot, <- ea; rewrite <- ec at 1; symmetry; apply dot_transpose).
  pose proof (dot_sizes c y) as C. rewrite <- E in C. pose proof (size_nonneg a). pose proof (size_nonneg c). pose proof (size_nonneg y).
  apply Rnot_lt_le. intro n. assert (a0 : 0 < size a) by (apply Rnot_le_lt; intro q; nra).
  assert (kappa * (size c * size y) <= size a * size y) by (rewrite <- Rmult_assoc; apply Rmult_le_compat_r; assumption). nra.
Qed.

Lemma first_below : size (solution W b) <= z * D.
Proof.
  set (a := solution W b). set (c := solution (transpose W) a).
  pose proof (solution_solves W b regular_W) as ea. fold a in ea. pose proof (solution_solves (transpose W) a regular_transpose) as ec. fold c in ec.
  pose proof (first_order (vscale (-1) c) 1 ltac:(pose proof (norm2_nonneg (vscale (-1) c)); lra)) as h.
  rewrite mulv_scale, ec, norm2_scale in h.
  assert (E : dot b (vscale (-1) c) = - norm2 a).
  { replace (dot b (vscale (-1) c)) with (- dot c b) by (unfold dot, vscale; cbn [vx vy vz]; ring). rewrite <- ea, dot_transpose, ec, norm2_dot. reflexivity. }
  rewrite E in h. apply size_below; [apply Rmult_le_pos; lra | lra].
Qed.

Lemma minus_zero : forall u, vsub u vzero = u.
Proof. intro. apply vec_ext; unfold vsub, vzero; cbn [vx vy vz]; ring. Qed.

(** What f differs by from its first order. *)
Definition rest (u v : vec) : vec := vsub (vsub (f v) (f u)) (mulv W (vsub v u)).

Lemma on_segment : forall u v t, size u <= D -> size v <= D -> 0 <= t <= 1 -> size (vadd u (vscale t (vsub v u))) <= D.
Proof.
  intros u v t hu hv ht. replace (vadd u (vscale t (vsub v u))) with (vadd (vscale (1 - t) u) (vscale t v)) by (unfold vadd, vsub, vscale; cbn [vx vy vz]; f_equal; ring).
  eapply Rle_trans; [apply size_plus |]. rewrite !size_scaled by lra. pose proof (size_nonneg u). pose proof (size_nonneg v). nra.
Qed.

Lemma along : forall e u v, size u <= D -> size v <= D -> forall t, 0 <= t <= 1 ->
  derivable_pt_lim (fun x => dot e (f (vadd u (vscale x (vsub v u)))) - x * dot e (mulv W (vsub v u))) t
    (dot e (mulv (msub (J (vadd u (vscale t (vsub v u)))) W) (vsub v u))).
Proof.
  intros e u v hu hv t ht. pose proof (velocity_dot _ _ _ e (smooth u v hu hv t ht)) as h. cbn beta in h.
  apply derivable_eq with (fun x => dot e (f (vadd u (vscale x (vsub v u)))) + - dot e (mulv W (vsub v u)) * x)
    (dot e (mulv (J (vadd u (vscale t (vsub v u)))) (vsub v u)) + - dot e (mulv W (vsub v u)) * 1).
  - apply derivable_add; [exact h | apply derivable_scal, derivable_pt_lim_id].
  - intro x. ring.
  - rewrite mulv_msub. generalize (mulv (J (vadd u (vscale t (vsub v u)))) (vsub v u)) (mulv W (vsub v u)). intros p q. unfold dot, vsub. cbn [vx vy vz]. ring.
Qed.

Lemma rest_along : forall e u v, dot e (rest u v) =
  (dot e (f (vadd u (vscale 1 (vsub v u)))) - 1 * dot e (mulv W (vsub v u))) - (dot e (f (vadd u (vscale 0 (vsub v u)))) - 0 * dot e (mulv W (vsub v u))).
Proof.
  intros e u v. replace (vadd u (vscale 1 (vsub v u))) with v by (apply vec_ext; unfold vadd, vsub, vscale; cbn [vx vy vz]; ring).
  replace (vadd u (vscale 0 (vsub v u))) with u by (apply vec_ext; unfold vadd, vsub, vscale; cbn [vx vy vz]; ring).
  unfold rest. generalize (f v) (f u) (mulv W (vsub v u)). intros p q y. unfold dot, vsub. cbn [vx vy vz]. ring.
Qed.

Lemma rest_between : forall u v, size u <= D -> size v <= D -> size (rest u v) <= g * size (vsub v u).
Proof.
  intros u v hu hv. set (e := rest u v). pose proof (size_nonneg e) as e0. pose proof (size_nonneg (vsub v u)) as d0.
  destruct (MeanValue.mean_value_theorem _ _ 0 1 Rlt_0_1 (fun t ht => along e u v hu hv t ht)) as [t [E ht]].
  rewrite <- rest_along in E. fold e in E. rewrite <- size_dot in E.
  pose proof (on_segment u v t hu hv ltac:(lra)) as hs. pose proof (spread _ (vsub v u) hs) as S.
  pose proof (dot_sizes e (mulv (msub (J (vadd u (vscale t (vsub v u)))) W) (vsub v u))) as C.
  set (y := size (mulv (msub (J (vadd u (vscale t (vsub v u)))) W) (vsub v u))) in *.
  assert (Y : y <= g * size (vsub v u)).
  { eapply Rle_trans; [exact S |]. apply Rmult_le_compat_r; [exact d0 |].
    apply Rle_trans with (g / D * D); [apply Rmult_le_compat_l; [apply Rmult_le_pos; [exact g_nonneg | apply Rlt_le, Rinv_0_lt_compat, D_pos] | exact hs] | apply Req_le; field; lra]. }
  apply Rnot_lt_le. intro n. assert (0 < size e) by (pose proof (Rmult_le_pos _ _ g_nonneg d0); lra). nra.
Qed.

Lemma rest_from_zero : forall u, size u <= D -> size (rest vzero u) <= g / (2 * D) * size u ^ 2.
Proof.
  intros u hu. set (e := rest vzero u). pose proof (size_nonneg e) as e0. pose proof (size_nonneg u) as u0.
  assert (z0 : size vzero <= D) by (rewrite size_zero; lra). set (k := g / (2 * D) * size e * size u ^ 2).
  assert (H : forall t, 0 <= t <= 1 -> derivable_pt_lim (fun x => (dot e (f (vadd vzero (vscale x (vsub u vzero)))) - x * dot e (mulv W (vsub u vzero))) + - k * x ^ 2) t
    (dot e (mulv (msub (J (vadd vzero (vscale t (vsub u vzero)))) W) (vsub u vzero)) + - k * (2 * t * 1))).
  { intros t ht. apply derivable_add; [apply along; assumption | apply derivable_scal, derivable_square, derivable_pt_lim_id]. }
  destruct (MeanValue.mean_value_theorem _ _ 0 1 Rlt_0_1 H) as [t [E ht]]. cbv beta in E.
  pose proof (rest_along e vzero u) as R. fold e in R. rewrite <- size_dot in R.
  assert (E2 : size e * size e - k = dot e (mulv (msub (J (vadd vzero (vscale t (vsub u vzero)))) W) (vsub u vzero)) + - k * (2 * t * 1)) by lra.
  replace (vadd vzero (vscale t (vsub u vzero))) with (vscale t u) in E2 by (apply vec_ext; unfold vadd, vsub, vscale, vzero; cbn [vx vy vz]; ring).
  rewrite minus_zero in E2. clear E R H.
  assert (st : size (vscale t u) = t * size u) by (apply size_scaled; lra).
  pose proof (spread (vscale t u) u ltac:(rewrite st; nra)) as S. rewrite st in S.
  pose proof (dot_sizes e (mulv (msub (J (vscale t u)) W) u)) as C.
  assert (B : size e * size (mulv (msub (J (vscale t u)) W) u) <= size e * (g / D * (t * size u) * size u)) by (apply Rmult_le_compat_l; assumption).
  assert (K : size e * (g / D * (t * size u) * size u) = k * (2 * t)) by (unfold k; field; lra).
  assert (F : size e * size e <= k) by lra. apply Rnot_lt_le. intro n. unfold k in F.
  assert (0 <= g / (2 * D) * size u ^ 2).
  { apply Rmult_le_pos; [apply Rmult_le_pos; [exact g_nonneg | apply Rlt_le, Rinv_0_lt_compat; lra] | apply pow2_ge_0]. } nra.
Qed.

Lemma solution_minus : forall M x y, solution M (vsub x y) = vsub (solution M x) (solution M y).
Proof. intros. unfold solution. apply vec_ext; unfold vsub, vadd, vscale, cross; cbn [vx vy vz]; ring. Qed.

Lemma solution_unique : forall x, solution W (mulv W x) = x.
Proof.
  intro x. pose proof (solution_solves W (mulv W x) regular_W) as e. set (y := solution W (mulv W x)) in *.
  assert (Z : mulv W (vsub y x) = vzero).
  { replace (mulv W (vsub y x)) with (vsub (mulv W y) (mulv W x)) by (generalize W; intro M; unfold mulv, vsub, dot; cbn [vx vy vz]; f_equal; ring).
    rewrite e. apply vec_ext; unfold vsub, vzero; cbn [vx vy vz]; ring. }
  assert (K : forall v, mulv W v = vzero -> v = vzero).
  { intros v hv. assert (T : forall w, dot (mulv (transpose W) w) v = 0).
    { intro w. rewrite <- dot_transpose, hv. unfold dot, vzero. cbn [vx vy vz]. ring. }
    specialize (T (solution (transpose W) v)). rewrite (solution_solves _ _ regular_transpose), <- norm2_dot in T. apply norm2_zero, T. }
  exact (same_vector _ _ (K _ Z)).
Qed.

Theorem one_position : exists u, (size u <= D /\ f u = vadd (f vzero) b) /\ forall v, size v <= D -> f v = vadd (f vzero) b -> v = u.
Proof.
  set (F := fun u => solution W (vsub b (rest vzero u))). pose proof kappa_pos as k0. assert (q1 : g / kappa < 1) by (apply Rmult_lt_reg_r with kappa; [exact k0 |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l; lra).
  assert (q0 : 0 <= g / kappa) by (apply Rmult_le_pos; [exact g_nonneg | apply Rlt_le, Rinv_0_lt_compat, k0]).
  assert (Below : forall y a, size y <= a -> size (solution W y) <= a / kappa).
  { intros y a h. pose proof (inverse_below y). apply Rmult_le_reg_r with kappa; [exact k0 |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
  assert (Fixed : forall u, F u = u <-> f u = vadd (f vzero) b).
  { intro u. unfold F. assert (E : rest vzero u = vsub (vsub (f u) (f vzero)) (mulv W u)) by (unfold rest; rewrite minus_zero; reflexivity). split; intro h.
    - assert (h' : vsub b (rest vzero u) = mulv W u) by (rewrite <- h at 2; symmetry; apply solution_solves, regular_W).
      rewrite E in h'. generalize dependent (mulv W u). intros w _ h'. unfold vsub in h'. destruct w as [w1 w2 w3]. injection h' as h1 h2 h3. cbn [vx vy vz] in *.
      apply vec_ext; unfold vadd; cbn [vx vy vz]; lra.
    - replace (vsub b (rest vzero u)) with (mulv W u); [apply solution_unique |]. rewrite E, h. generalize (mulv W u) (f vzero). intros w y.
      apply vec_ext; unfold vsub, vadd; cbn [vx vy vz]; ring. }
  destruct (fixed_point D (g / kappa) F (Rlt_le _ _ D_pos) (conj q0 q1)) as [u [[h1 h2] h3]].
  - intros u hu. unfold F. rewrite solution_minus.
    replace (vsub (solution W b) (solution W (rest vzero u))) with (vadd (solution W b) (vscale (-1) (solution W (rest vzero u)))) by (apply vec_ext; unfold vsub, vadd, vscale; cbn [vx vy vz]; ring).
    eapply Rle_trans; [apply size_plus |].
    replace (size (vscale (-1) (solution W (rest vzero u)))) with (size (solution W (rest vzero u))) by (unfold size; rewrite norm2_scale; f_equal; ring).
    pose proof first_below as B1. pose proof (Below _ _ (rest_from_zero u hu)) as B2.
    assert (S : g / (2 * D) * size u ^ 2 / kappa <= g / (2 * kappa) * D).
    { pose proof (size_nonneg u). assert (size u ^ 2 <= D ^ 2) by nra. apply Rle_trans with (g / (2 * D) * D ^ 2 / kappa); [| apply Req_le; field; lra].
      unfold Rdiv. apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, k0 |]. apply Rmult_le_compat_l; [| assumption].
      apply Rmult_le_pos; [exact g_nonneg | apply Rlt_le, Rinv_0_lt_compat; lra]. }
    assert ((z + g / (2 * kappa)) * D <= 1 * D) by (apply Rmult_le_compat_r; lra). lra.
  - intros u v hu hv. unfold F. rewrite <- solution_minus.
    replace (vsub (vsub b (rest vzero u)) (vsub b (rest vzero v))) with (rest u v).
    + replace (g / kappa * size (vsub u v)) with (g * size (vsub u v) / kappa) by (field; lra). apply Below. rewrite (size_opposite u v). apply rest_between; assumption.
    + unfold rest. rewrite !minus_zero. replace (mulv W (vsub v u)) with (vsub (mulv W v) (mulv W u)) by (generalize W; intro M; unfold mulv, vsub, dot; cbn [vx vy vz]; f_equal; ring).
      generalize (mulv W v) (mulv W u) (f u) (f v) (f vzero). intros. apply vec_ext; unfold vsub; cbn [vx vy vz]; ring.
  - exists u. split; [split; [exact h1 | apply Fixed, h2] |]. intros v hv e. apply h3; [exact hv | apply Fixed, e].
Qed.
End Near.
