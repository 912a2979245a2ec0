(** * Lower bound on diagonal cubes, L = 1

    On the cube [-c1, c2]^3 with corner entries T (of c1) and U (of c2),
    sigma_min(M) >= kappa as soon as kappa <= 1 - 2T and kappa <= 1 - U:
    the values of sigma_min at the corners Q_1 = (-c1,-c1,-c1) and
    Q_2 = (c2,c2,c2).  Nowhere else is the bound reached. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics WeightedCauchy Diagonal.
Local Open Scope R_scope.

(** The cube [-c1, c2]^3, and the same with any bounds. *)
Definition in_box (lo hi : R) (p : vec) : Prop :=
  lo <= vx p <= hi /\ lo <= vy p <= hi /\ lo <= vz p <= hi.

Lemma in_box_reachable : forall c t p, on_diagonal c t -> in_box (- c) c p -> reachable_unit p.
Proof. intros c t p D [hx [hy hz]]. repeat split; apply (s_unit_pos c t); assumption. Qed.

(** eta_i and sigma_i of the point p in the scale of c, and the form. *)
Section Scaled.
Variables c t kappa x y z : R.
Hypothesis D : on_diagonal c t.
Hypothesis bounds : in_box (- c) c (Vec x y z).
Let g := (1 - kappa) / t.

Lemma form_scaled : forall v1 v2 v3,
  dot (Vec v1 v2 v3) (mulv (M (Vec x y z)) (Vec v1 v2 v3)) - kappa * norm2 (Vec v1 v2 v3)
  = t * scaled_form g (x / c) (y / c) (z / c)
          (c / t / s_unit y z) (c / t / s_unit x z) (c / t / s_unit x y) v1 v2 v3.
Proof.
  intros v1 v2 v3. destruct (in_box_reachable c t _ D bounds) as [h1 [h2 h3]]. cbn in h1, h2, h3.
  destruct D as [c0 [t0 _]]. unfold g, scaled_form, M, mulv, dot, norm2; cbn [vx vy vz row1 row2 row3].
  field. lra.
Qed.
End Scaled.

(** Three weights that prove the bound, and, where [room], leave a margin. *)
Definition weights (g e1 e2 e3 s1 s2 s3 : R) (room : Prop) : Prop :=
  exists K1 K2 K3, (0 < K1 /\ 0 < K2 /\ 0 < K3 /\ K1 + K2 + K3 <= 4) /\
    (balanced g K1 e1 s1 /\ balanced g K2 e2 s2 /\ balanced g K3 e3 s3) /\
    (room -> (0 < g - e1 * s1 /\ 0 < g - e2 * s2 /\ 0 < g - e3 * s3) /\
      ((e1 - s1) ^ 2 < K1 * (g - e1 * s1) \/ (e2 - s2) ^ 2 < K2 * (g - e2 * s2) \/
       (e3 - s3) ^ 2 < K3 * (g - e3 * s3))).

Lemma weights_nonneg : forall g e1 e2 e3 s1 s2 s3 room v1 v2 v3,
  weights g e1 e2 e3 s1 s2 s3 room -> 0 <= scaled_form g e1 e2 e3 s1 s2 s3 v1 v2 v3.
Proof.
  intros g e1 e2 e3 s1 s2 s3 room v1 v2 v3 [K1 [K2 [K3 [[k1 [k2 [k3 sum]]] [[a1 [a2 a3]] _]]]]].
  apply (scaled_form_nonneg _ _ _ _ _ _ _ K1 K2 K3); assumption.
Qed.

Lemma weights_pos : forall g e1 e2 e3 s1 s2 s3 (room : Prop) v1 v2 v3,
  weights g e1 e2 e3 s1 s2 s3 room -> room -> v1 <> 0 \/ v2 <> 0 \/ v3 <> 0 ->
  0 < scaled_form g e1 e2 e3 s1 s2 s3 v1 v2 v3.
Proof.
  intros g e1 e2 e3 s1 s2 s3 room v1 v2 v3 [K1 [K2 [K3 [[k1 [k2 [k3 sum]]] [[a1 [a2 a3]] r]]]]] hr nz.
  destruct (r hr) as [[d1 [d2 d3]] [st | [st | st]]].
  - destruct (smaller_weight _ _ _ _ k1 st) as [K' [k' [b' _]]].
    apply (scaled_form_pos _ _ _ _ _ _ _ K' K2 K3); try assumption; lra.
  - destruct (smaller_weight _ _ _ _ k2 st) as [K' [k' [b' _]]].
    apply (scaled_form_pos _ _ _ _ _ _ _ K1 K' K3); try assumption; lra.
  - destruct (smaller_weight _ _ _ _ k3 st) as [K' [k' [b' _]]].
    apply (scaled_form_pos _ _ _ _ _ _ _ K1 K2 K'); try assumption; lra.
Qed.

(** ** Region 1: |P|_inf <= c1, in the scale of c1 *)

Lemma weights_inner : forall g c t x y z, on_diagonal c t -> t <= 1 -> 2 <= g ->
  in_box (- c) c (Vec x y z) ->
  weights g (x / c) (y / c) (z / c)
    (c / t / s_unit y z) (c / t / s_unit x z) (c / t / s_unit x y)
    (~ (x = - c /\ y = - c /\ z = - c)).
Proof.
  intros g c t x y z D t1 hg [hx [hy hz]]. cbn [vx vy vz] in *.
  pose proof (proj1 D) as c0.
  assert (N : forall u, - c <= u <= c -> -1 <= u / c <= 1).
  { intros u h. split; apply Rmult_le_reg_r with c; try exact c0; unfold Rdiv; rewrite Rmult_assoc, Rinv_l; lra. }
  assert (N' : forall u, - c <= u <= c -> u <> - c -> -1 < u / c <= 1).
  { intros u h n. split; [| apply N; exact h].
    apply Rmult_lt_reg_r with c; [exact c0 |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
  assert (S : forall u v, - c <= u <= c -> - c <= v <= c -> 0 <= c / t / s_unit u v <= 1)
    by (intros u v hu hv; pose proof (sigma_range c t u v D hu hv t1); lra).
  assert (G : forall e s, -1 <= e <= 1 -> 0 <= s <= 1 -> 0 < g - e * s)
    by (intros e s [? ?] [? ?]; nra).
  exists (4/3), (4/3), (4/3). split; [lra |]. split.
  { repeat split; apply balanced_inner; auto. }
  intro room. split; [repeat split; apply G; auto |].
  destruct (Req_dec x (- c)); [destruct (Req_dec y (- c)); [destruct (Req_dec z (- c)); [tauto |] |] |].
  - right; right. apply balanced_inner_strict; auto.
  - right; left. apply balanced_inner_strict; auto.
  - left. apply balanced_inner_strict; auto.
Qed.

(** ** Region 2: the largest coordinate m exceeds c1, in the scale of m *)

Section Outer.
Variables g c1 m t : R.
Hypothesis D : on_diagonal m t.
Hypothesis t1 : t <= 1.
Hypothesis c1m : 0 < c1 < m.
Hypothesis g1 : 1 <= g.
Hypothesis pp : (c1 / m) ^ 2 <= g / 2.

Let range (u : R) := - c1 <= u <= m.
(** Room: g > 1, or the point is not the corner (m,m,m). *)
Let room (u v w : R) := 1 < g \/ ~ (u = m /\ v = m /\ w = m).

Lemma normalised : forall u, range u -> - (c1 / m) <= u / m <= 1.
Proof.
  intros u [lo hi]. assert (u / m * m = u) by (field; lra). assert (- (c1 / m) * m = - c1) by (field; lra).
  split; apply Rmult_le_reg_r with m; lra.
Qed.

Lemma normalised_strict : forall u, u < m -> u / m < 1.
Proof. intros u h. assert (u / m * m = u) by (field; lra). apply Rmult_lt_reg_r with m; lra. Qed.

Lemma ratio_range : 0 <= c1 / m <= 1.
Proof.
  assert (c1 / m * m = c1) by (field; lra).
  split; apply Rmult_le_reg_r with m; lra.
Qed.

(** Either this coordinate or the sigma of its leg is below 1. *)
Lemma room_cases : forall u v w, range u -> range v -> range w -> room u v w ->
  1 < g \/ u / m < 1 \/ m / t / s_unit v w < 1.
Proof.
  unfold range. intros u v w hu hv hw [h | h]; [left; exact h | right].
  destruct (Req_dec u m); [| left; apply normalised_strict; lra].
  right. apply sigma_strict; try assumption; lra.
Qed.

Lemma largest_balanced : forall u v w, m = u -> range v -> range w ->
  balanced g (1/2) (u / m) (m / t / s_unit v w) /\
  (room u v w -> (u / m - m / t / s_unit v w) ^ 2 < 1/2 * (g - u / m * (m / t / s_unit v w))).
Proof.
  intros u v w <- hv hw.
  pose proof (sigma_range m t v w D ltac:(unfold range in *; lra) ltac:(unfold range in *; lra) t1) as S.
  assert (one : m / m = 1) by (field; lra).
  split; [rewrite one; apply balanced_max; lra |].
  intro h. assert (hm : range m) by (unfold range; lra).
  destruct (room_cases m v w hm hv hw h) as [? | [n | ?]]; try lra;
    rewrite one; apply balanced_max_strict; tauto.
Qed.

Lemma other_balanced : forall u v w, range u -> range v -> range w ->
  balanced g (7/4) (u / m) (m / t / s_unit v w) /\
  (room u v w -> (u / m - m / t / s_unit v w) ^ 2 < 7/4 * (g - u / m * (m / t / s_unit v w))).
Proof.
  intros u v w hu hv hw.
  pose proof (sigma_range m t v w D ltac:(unfold range in *; lra) ltac:(unfold range in *; lra) t1) as S.
  pose proof ratio_range. pose proof (normalised u hu). split.
  - apply (balanced_outer g (c1 / m)); auto; lra.
  - intro h. apply (balanced_outer_strict g (c1 / m)); auto; try lra. apply room_cases; auto.
Qed.

Lemma slack_pos : forall K e s, 0 < K -> (e - s) ^ 2 < K * (g - e * s) -> 0 < g - e * s.
Proof. intros K e s hK h. pose proof (pow2_ge_0 (e - s)). apply Rmult_lt_reg_l with K; lra. Qed.

Lemma weights_outer : forall x y z, range x -> range y -> range z -> m = x \/ m = y \/ m = z ->
  weights g (x / m) (y / m) (z / m)
    (m / t / s_unit y z) (m / t / s_unit x z) (m / t / s_unit x y) (room x y z).
Proof.
  intros x y z hx hy hz big.
  assert (R2 : room x y z -> room y x z) by (unfold room; tauto).
  assert (R3 : room x y z -> room z x y) by (unfold room; tauto).
  pose proof (other_balanced x y z hx hy hz) as [b1 s1].
  pose proof (other_balanced y x z hy hx hz) as [b2 s2].
  pose proof (other_balanced z x y hz hx hy) as [b3 s3].
  pose proof (slack_pos (7/4)) as pos.
  destruct big as [e | [e | e]].
  - pose proof (largest_balanced x y z e hy hz) as [b s].
    exists (1/2), (7/4), (7/4). split; [lra |]. split; [repeat split; assumption |].
    intro h. split; [| left; apply s; exact h].
    repeat split; apply pos; try lra; [apply s1 | apply s2 | apply s3]; auto.
  - pose proof (largest_balanced y x z e hx hz) as [b s].
    exists (7/4), (1/2), (7/4). split; [lra |]. split; [repeat split; assumption |].
    intro h. split; [| right; left; apply s; auto].
    repeat split; apply pos; try lra; [apply s1 | apply s2 | apply s3]; auto.
  - pose proof (largest_balanced z x y e hx hy) as [b s].
    exists (7/4), (7/4), (1/2). split; [lra |]. split; [repeat split; assumption |].
    intro h. split; [| right; right; apply s; auto].
    repeat split; apply pos; try lra; [apply s1 | apply s2 | apply s3]; auto.
Qed.
End Outer.

(** ** The bound on the whole cube *)

Section Cube.
Variables kappa c1 c2 T U : R.
Hypothesis D1 : on_diagonal c1 T.
Hypothesis D2 : on_diagonal c2 U.
Hypothesis kappa_range : 0 <= kappa.
Hypothesis at_Q1 : 2 * T <= 1 - kappa.
Hypothesis at_Q2 : U <= 1 - kappa.

(** Region 2: with t the entry at m, T < t <= U, the ratio p = c1/m is small
    enough because (t - T)(1 - 2 T t) >= 0. *)
Lemma outer_ratio : forall m t, on_diagonal m t -> c1 < m <= c2 ->
  1 <= (1 - kappa) / t /\ (c1 / m) ^ 2 <= (1 - kappa) / t / 2.
Proof.
  intros m t D [lo hi]. pose proof (proj1 (diagonal_lt _ _ _ _ D1 D) lo) as tT.
  pose proof (proj1 (diagonal_le _ _ _ _ D D2) hi) as tU.
  destruct D1 as [p1 [T0 f1]]. destruct D as [m0 [t0 fm]]. split.
  - apply Rmult_le_reg_r with t; [exact t0 |]. replace ((1 - kappa) / t * t) with (1 - kappa) by (field; lra). lra.
  - apply Rle_trans with (T / t).
    2: { apply Rmult_le_reg_r with t; [exact t0 |].
         replace ((1 - kappa) / t / 2 * t) with ((1 - kappa) / 2) by (field; lra).
         replace (T / t * t) with T by (field; lra). lra. }
    replace ((c1 / m) ^ 2) with (c1 ^ 2 / m ^ 2) by (field; lra).
    apply Rmult_le_reg_r with (m ^ 2 * t); [apply Rmult_lt_0_compat; nra |].
    replace (c1 ^ 2 / m ^ 2 * (m ^ 2 * t)) with (c1 ^ 2 * t) by (field; lra).
    replace (T / t * (m ^ 2 * t)) with (T * m ^ 2) by (field; lra).
    apply Rmult_le_reg_r with ((1 + 2 * T ^ 2) * (1 + 2 * t ^ 2)); [apply Rmult_lt_0_compat; nra |].
    replace (c1 ^ 2 * t * ((1 + 2 * T ^ 2) * (1 + 2 * t ^ 2)))
      with ((c1 ^ 2 * (1 + 2 * T ^ 2)) * t * (1 + 2 * t ^ 2)) by ring.
    replace (T * m ^ 2 * ((1 + 2 * T ^ 2) * (1 + 2 * t ^ 2)))
      with (T * (m ^ 2 * (1 + 2 * t ^ 2)) * (1 + 2 * T ^ 2)) by ring.
    rewrite f1, fm. assert (2 * T * t <= 1) by nra.
    assert (0 <= T * t * ((t - T) * (1 - 2 * T * t)))
      by (apply Rmult_le_pos; [nra | apply Rmult_le_pos; lra]). nra.
Qed.

Lemma cube_weights : forall x y z, in_box (- c1) c2 (Vec x y z) ->
  exists c t, on_diagonal c t /\ in_box (- c) c (Vec x y z) /\
    weights ((1 - kappa) / t) (x / c) (y / c) (z / c)
      (c / t / s_unit y z) (c / t / s_unit x z) (c / t / s_unit x y)
      (Vec x y z <> diagonal (- c1) /\ Vec x y z <> diagonal c2).
Proof.
  assert (W : forall g e1 e2 e3 s1 s2 s3 (A B : Prop), (B -> A) ->
    weights g e1 e2 e3 s1 s2 s3 A -> weights g e1 e2 e3 s1 s2 s3 B).
  { intros g e1 e2 e3 s1 s2 s3 A B BA [K1 [K2 [K3 [k [b r]]]]]. exists K1, K2, K3. auto. }
  intros x y z [[x0 x1] [[y0 y1] [z0 z1]]]. cbn [vx vy vz] in *.
  set (m := Rmax x (Rmax y z)).
  assert (mx : x <= m) by apply Rmax_l.
  assert (my : y <= m) by (eapply Rle_trans; [apply Rmax_l | apply Rmax_r]).
  assert (mz : z <= m) by (eapply Rle_trans; [apply Rmax_r | apply Rmax_r]).
  assert (m2 : m <= c2) by (unfold m; repeat apply Rmax_lub; assumption).
  assert (me : m = x \/ m = y \/ m = z)
    by (unfold m, Rmax; destruct (Rle_dec y z); destruct (Rle_dec x _); tauto).
  destruct (diagonal_pos _ _ D1) as [p1 T0].
  destruct (Rle_dec m c1) as [inner | outer].
  - exists c1, T. split; [exact D1 |].
    assert (box : in_box (- c1) c1 (Vec x y z)) by (unfold in_box; cbn [vx vy vz]; lra).
    split; [exact box |]. eapply W; [| apply weights_inner; try assumption; try lra].
    + intros [n _] [-> [-> ->]]. apply n. reflexivity.
    + apply Rmult_le_reg_r with T; [exact T0 |].
      replace ((1 - kappa) / T * T) with (1 - kappa) by (field; lra). exact at_Q1.
  - apply Rnot_le_lt in outer. exists m, (entry_of_position m).
    assert (D : on_diagonal m (entry_of_position m)).
    { apply entry_on_diagonal; [lra |]. pose proof (diagonal_reach _ _ D2). nra. }
    set (t := entry_of_position m) in *. split; [exact D |].
    split; [unfold in_box; cbn [vx vy vz]; lra |].
    destruct (outer_ratio m t D (conj outer m2)) as [g1 pp].
    assert (tU : t <= U) by (apply (diagonal_le _ _ _ _ D D2); exact m2).
    eapply W; [| apply (weights_outer _ c1); try assumption; lra].
    intros [_ n]. destruct (Rlt_dec m c2) as [lt | nlt].
    + left. pose proof (proj1 (diagonal_lt _ _ _ _ D D2) lt). destruct D as [_ [t0 _]].
      apply Rmult_lt_reg_r with t; [exact t0 |]. replace ((1 - kappa) / t * t) with (1 - kappa) by (field; lra). lra.
    + right. intros [ex [ey ez]]. apply n. unfold diagonal. f_equal; lra.
Qed.

Theorem cube_lower_form : forall p v, in_box (- c1) c2 p ->
  kappa * norm2 v <= dot v (mulv (M p) v).
Proof.
  intros [x y z] [v1 v2 v3] h. destruct (cube_weights x y z h) as [c [t [D [b w]]]].
  pose proof (form_scaled c t kappa x y z D b v1 v2 v3) as E.
  pose proof (weights_nonneg _ _ _ _ _ _ _ _ v1 v2 v3 w) as N.
  destruct D as [_ [t0 _]]. assert (F := Rmult_le_pos _ _ (Rlt_le _ _ t0) N). lra.
Qed.

Theorem cube_lower_form_strict : forall p v, in_box (- c1) c2 p ->
  p <> diagonal (- c1) -> p <> diagonal c2 -> v <> vzero ->
  kappa * norm2 v < dot v (mulv (M p) v).
Proof.
  intros [x y z] [v1 v2 v3] h n1 n2 nz. destruct (cube_weights x y z h) as [c [t [D [b w]]]].
  pose proof (form_scaled c t kappa x y z D b v1 v2 v3) as E.
  assert (nz' : v1 <> 0 \/ v2 <> 0 \/ v3 <> 0).
  { destruct (Req_dec v1 0); [destruct (Req_dec v2 0); [destruct (Req_dec v3 0) |] |]; auto.
    exfalso. apply nz. subst. reflexivity. }
  pose proof (weights_pos _ _ _ _ _ _ _ _ v1 v2 v3 w (conj n1 n2) nz') as N.
  destruct D as [_ [t0 _]]. assert (F := Rmult_lt_0_compat _ _ t0 N). lra.
Qed.

(** sigma_min(M) >= kappa on the cube ... *)
Theorem cube_lower : forall p, in_box (- c1) c2 p -> sigma_at_least kappa (M p).
Proof.
  intros p h. apply symmetric_part_identity; [exact kappa_range |].
  intro v. apply cube_lower_form; exact h.
Qed.

(** ... and only Q_1 and Q_2 can reach it. *)
Theorem cube_lower_reached : forall p, in_box (- c1) c2 p -> stretches_by kappa (M p) ->
  p = diagonal (- c1) \/ p = diagonal c2.
Proof.
  assert (dec : forall u v : vec, u = v \/ u <> v).
  { intros [a b c] [a' b' c']. destruct (Req_dec a a'); [destruct (Req_dec b b'); [destruct (Req_dec c c') |] |];
      [left; congruence | | |]; right; intro h; injection h; auto. }
  intros p h [v [nz e]]. destruct (dec p (diagonal (- c1))) as [e1 | n1]; [left; exact e1 | right].
  destruct (dec p (diagonal c2)) as [e2 | n2]; [exact e2 | exfalso].
  pose proof (norm2_from_dot_strict kappa (mulv (M p) v) v kappa_range nz
    (cube_lower_form_strict p v h n1 n2 nz)). lra.
Qed.
End Cube.
