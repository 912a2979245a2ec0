(** * Reducing the postulate for all psi to a three-dimensional problem

    The analytic proof of the postulate needs none of this; it is what makes a
    certificate by subdivision possible for every psi at once: symmetry, the
    cubes' faces instead of their interiors, and a change of variables that
    is regular at kappa = 1, where the cubes shrink to the origin. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal CubeLower Scaling Postulate.
Local Open Scope R_scope.

(** v^T M v >= kappa |v|^2 at the point p, for L = 1. *)
Definition lower_form_at (kappa : R) (p : vec) : Prop :=
  forall v, kappa * norm2 v <= dot v (mulv (M p) v).

(** ** Symmetry: permuting the axes permutes the legs *)

Definition swap12 (v : vec) : vec := Vec (vy v) (vx v) (vz v).
Definition swap13 (v : vec) : vec := Vec (vz v) (vy v) (vx v).

(** M(pi P) = Pi M(P) Pi^T, in the form Pi^T M(pi P) v = M(P) Pi^T v. *)
Lemma M_swap12 : forall p v, mulv (M (swap12 p)) (swap12 v) = swap12 (mulv (M p) v).
Proof.
  intros [x y z] [a b c]. unfold M, swap12, mulv, dot; cbn [vx vy vz row1 row2 row3].
  rewrite (s_unit_sym y x). f_equal; ring.
Qed.

Lemma M_swap13 : forall p v, mulv (M (swap13 p)) (swap13 v) = swap13 (mulv (M p) v).
Proof.
  intros [x y z] [a b c]. unfold M, swap13, mulv, dot; cbn [vx vy vz row1 row2 row3].
  rewrite (s_unit_sym y x), (s_unit_sym z x), (s_unit_sym z y). f_equal; ring.
Qed.

Lemma lower_form_swap12 : forall kappa p, lower_form_at kappa (swap12 p) -> lower_form_at kappa p.
Proof.
  intros kappa p h v. specialize (h (swap12 v)). rewrite M_swap12 in h.
  replace (norm2 (swap12 v)) with (norm2 v) in h by (unfold swap12, norm2; cbn; ring).
  replace (dot (swap12 v) (swap12 (mulv (M p) v))) with (dot v (mulv (M p) v)) in h
    by (unfold swap12, dot; cbn [vx vy vz]; ring).
  exact h.
Qed.

Lemma lower_form_swap13 : forall kappa p, lower_form_at kappa (swap13 p) -> lower_form_at kappa p.
Proof.
  intros kappa p h v. specialize (h (swap13 v)). rewrite M_swap13 in h.
  replace (norm2 (swap13 v)) with (norm2 v) in h by (unfold swap13, norm2; cbn; ring).
  replace (dot (swap13 v) (swap13 (mulv (M p) v))) with (dot v (mulv (M p) v)) in h
    by (unfold swap13, dot; cbn [vx vy vz]; ring).
  exact h.
Qed.

(** ** The interval [q_1, q_2] as a function of kappa, L = 1 *)

Definition q1_unit (kappa : R) : R := - position_of_entry (t_1 kappa).
Definition q2_unit (kappa : R) : R := position_of_entry (t_2 kappa).
(** W(kappa). *)
Definition in_W (kappa : R) (p : vec) : Prop := in_box (q1_unit kappa) (q2_unit kappa) p.

(** The kappa whose interval ends at u (1 for u = 0). *)
Definition kappa_of (u : R) : R :=
  if Rlt_dec 0 u then
    let t := entry_of_position u in if Rle_dec (1/2) t then 1 - t else 1 / (1 + 2 * t)
  else if Rlt_dec u 0 then 1 - 2 * entry_of_position (- u) else 1.

Lemma t_2_kappa : forall t, 0 < t < 1 ->
  let kappa := if Rle_dec (1/2) t then 1 - t else 1 / (1 + 2 * t) in 0 < kappa < 1 /\ t_2 kappa = t.
Proof.
  intros t h kappa. unfold kappa. clear kappa. destruct (Rle_dec (1/2) t) as [ge | lt].
  - split; [lra |]. unfold t_2. destruct (Rle_dec (1 - t) (1/2)); lra.
  - assert (b : 1/2 < 1 / (1 + 2 * t) < 1).
    { assert (e : 1 / (1 + 2 * t) * (1 + 2 * t) = 1) by (field; lra).
      split; apply Rmult_lt_reg_r with (1 + 2 * t); lra. }
    split; [lra |]. unfold t_2. destruct (Rle_dec (1 / (1 + 2 * t)) (1/2)); [lra | field; lra].
Qed.

(** t_1 and t_2 decrease with kappa. *)
Lemma t_1_antitone : forall k k', t_1 k <= t_1 k' <-> k' <= k.
Proof. intros. unfold t_1. lra. Qed.

Lemma t_2_antitone : forall k k', 0 < k < 1 -> 0 < k' < 1 -> k' < k -> t_2 k < t_2 k'.
Proof.
  intros k k' h h' lt. unfold t_2.
  assert (i : 1 / k < 1 / k').
  { apply Rmult_lt_compat_l; [lra |]. apply Rinv_lt_contravar; [apply Rmult_lt_0_compat; lra | exact lt]. }
  destruct (Rle_dec k (1/2)) as [? | n], (Rle_dec k' (1/2)); try lra.
  assert (1 / k < 2); [| lra].
  apply Rmult_lt_reg_r with k; [lra |]. replace (1 / k * k) with 1 by (field; lra). lra.
Qed.

Lemma q_antitone : forall k k', 0 < k < 1 -> 0 < k' < 1 -> k' <= k ->
  q1_unit k' <= q1_unit k /\ q2_unit k <= q2_unit k'.
Proof.
  intros k k' h h' le. destruct (t_facts k h) as [T [T2 _]]. destruct (t_facts k' h') as [T' [T2' _]].
  pose proof (position_on_diagonal (t_1 k) ltac:(lra)) as A.
  pose proof (position_on_diagonal (t_1 k') ltac:(lra)) as A'.
  pose proof (position_on_diagonal (t_2 k) ltac:(lra)) as B.
  pose proof (position_on_diagonal (t_2 k') ltac:(lra)) as B'.
  unfold q1_unit, q2_unit. split.
  - apply Ropp_le_contravar, (diagonal_le _ _ _ _ A A'), t_1_antitone; exact le.
  - apply (diagonal_le _ _ _ _ B B').
    destruct le as [lt | ->]; [apply Rlt_le, t_2_antitone; assumption | apply Rle_refl].
Qed.

(** A nonzero coordinate within the interval of kappa is an end of the
    interval of kappa_of, which is not smaller than kappa. *)
Lemma kappa_of_end : forall kappa u, 0 < kappa < 1 -> q1_unit kappa <= u <= q2_unit kappa -> u <> 0 ->
  kappa <= kappa_of u < 1 /\ (u = q1_unit (kappa_of u) \/ u = q2_unit (kappa_of u)).
Proof.
  intros kappa u k [lo hi] nz. destruct (t_facts kappa k) as [T [T2 _]].
  pose proof (position_on_diagonal (t_1 kappa) ltac:(lra)) as A.
  pose proof (position_on_diagonal (t_2 kappa) ltac:(lra)) as B.
  unfold q1_unit, q2_unit in *. unfold kappa_of.
  destruct (Rlt_dec 0 u) as [pos | npos]; [| destruct (Rlt_dec u 0) as [neg | nneg]; [| lra]].
  - assert (D : on_diagonal u (entry_of_position u)).
    { apply entry_on_diagonal; [exact pos |]. pose proof (diagonal_reach _ _ B). nra. }
    set (t := entry_of_position u) in *. pose proof (proj1 (proj2 D)) as t0.
    assert (le : t <= t_2 kappa) by (apply (diagonal_le _ _ _ _ D B); exact hi).
    cbn zeta. destruct (t_2_kappa t ltac:(lra)) as [k' e]. cbn zeta in k', e.
    set (k2 := if Rle_dec (1/2) t then 1 - t else 1 / (1 + 2 * t)) in *.
    assert (le' : kappa <= k2).
    { apply Rnot_lt_le. intro lt. pose proof (t_2_antitone kappa k2 k k' lt). lra. }
    split; [lra |]. right. rewrite e.
    apply (diagonal_position_unique _ _ t D). apply position_on_diagonal; exact t0.
  - assert (D : on_diagonal (- u) (entry_of_position (- u))).
    { apply entry_on_diagonal; [lra |]. pose proof (diagonal_reach _ _ A). nra. }
    set (t := entry_of_position (- u)) in *. pose proof (proj1 (proj2 D)) as t0.
    assert (le : t <= t_1 kappa) by (apply (diagonal_le _ _ _ _ D A); lra).
    unfold t_1 in le. split; [lra |]. left.
    replace (t_1 (1 - 2 * t)) with t by (unfold t_1; lra).
    rewrite <- (diagonal_position_unique _ _ t D (position_on_diagonal t t0)). ring.
Qed.

(** Being in the interval of kappa is the same as kappa <= kappa_of. *)
Lemma in_interval_of : forall k0 k u, 0 < k0 < 1 -> q1_unit k0 <= u <= q2_unit k0 ->
  0 < k < 1 -> k <= kappa_of u -> q1_unit k <= u <= q2_unit k.
Proof.
  intros k0 k u h0 hu hk le. destruct (t_facts k hk) as [T [T2 _]].
  destruct (position_on_diagonal (t_1 k) ltac:(lra)) as [a _].
  destruct (position_on_diagonal (t_2 k) ltac:(lra)) as [b _].
  destruct (Req_dec u 0) as [-> | nz]; [unfold q1_unit, q2_unit; lra |].
  destruct (kappa_of_end k0 u h0 hu nz) as [b' e]. set (k' := kappa_of u) in *.
  assert (hk' : 0 < k' < 1) by lra. destruct (q_antitone k' k hk' hk le) as [l1 l2].
  destruct (t_facts k' hk') as [S [S2 _]].
  destruct (position_on_diagonal (t_1 k') ltac:(lra)) as [a' _].
  destruct (position_on_diagonal (t_2 k') ltac:(lra)) as [c' _].
  unfold q1_unit, q2_unit in *. destruct e as [e | e]; lra.
Qed.

(** ** Faces suffice *)

Definition on_face (kappa : R) (p : vec) : Prop :=
  in_W kappa p /\
  (vx p = q1_unit kappa \/ vx p = q2_unit kappa \/ vy p = q1_unit kappa \/ vy p = q2_unit kappa \/
   vz p = q1_unit kappa \/ vz p = q2_unit kappa).

(** Every point of W(kappa) but the origin is on the boundary of W(kappa')
    for some kappa' in [kappa, 1). *)
Lemma point_on_face : forall kappa p, 0 < kappa < 1 -> in_W kappa p -> p <> vzero ->
  exists kappa', kappa <= kappa' < 1 /\ on_face kappa' p.
Proof.
  intros kappa [x y z] k [hx [hy hz]] nz. cbn [vx vy vz] in *.
  assert (K : forall u, q1_unit kappa <= u <= q2_unit kappa ->
    kappa <= kappa_of u <= 1 /\ (kappa_of u < 1 -> u = q1_unit (kappa_of u) \/ u = q2_unit (kappa_of u)) /\
    (kappa_of u = 1 -> u = 0)).
  { intros u hu. destruct (Req_dec u 0) as [-> | n].
    - assert (E : kappa_of 0 = 1) by (unfold kappa_of; destruct (Rlt_dec 0 0); lra). rewrite E. lra.
    - destruct (kappa_of_end kappa u k hu n) as [b e]. split; [lra |]. split; [intros _; exact e |]. lra. }
  destruct (K x hx) as [kx [ex zx]]. destruct (K y hy) as [ky [ey zy]]. destruct (K z hz) as [kz [ez zz]].
  set (k' := Rmin (kappa_of x) (Rmin (kappa_of y) (kappa_of z))).
  assert (lx : k' <= kappa_of x) by apply Rmin_l.
  assert (ly : k' <= kappa_of y) by (eapply Rle_trans; [apply Rmin_r | apply Rmin_l]).
  assert (lz : k' <= kappa_of z) by (eapply Rle_trans; [apply Rmin_r | apply Rmin_r]).
  assert (lo : kappa <= k') by (unfold k'; repeat apply Rmin_glb; lra).
  assert (is : k' = kappa_of x \/ k' = kappa_of y \/ k' = kappa_of z)
    by (unfold k', Rmin; destruct (Rle_dec (kappa_of y) (kappa_of z)); destruct (Rle_dec (kappa_of x) _); tauto).
  assert (hi : k' < 1).
  { apply Rnot_le_lt. intro ge. apply nz. unfold vzero. rewrite zx, zy, zz by lra. reflexivity. }
  exists k'. split; [lra |]. split.
  - repeat split; cbn [vx vy vz]; apply (in_interval_of kappa k'); assumption || lra.
  - cbn [vx vy vz]. destruct is as [e | [e | e]]; rewrite e in *.
    + destruct (ex hi); tauto.
    + destruct (ey hi); tauto.
    + destruct (ez hi); tauto.
Qed.

Lemma lower_form_origin : forall kappa, kappa <= 1 -> lower_form_at kappa vzero.
Proof.
  intros kappa h v. replace (mulv (M vzero) v) with v.
  - rewrite <- norm2_dot. pose proof (norm2_nonneg v). nra.
  - unfold M, vzero, mulv, dot; cbn [vx vy vz row1 row2 row3]. destruct v as [a b c].
    unfold Rdiv. cbn [vx vy vz]. f_equal; ring.
Qed.

Theorem faces_suffice : forall kappa0, 0 < kappa0 < 1 ->
  (forall kappa p, kappa0 <= kappa < 1 -> on_face kappa p -> lower_form_at kappa p) ->
  forall p, in_W kappa0 p -> lower_form_at kappa0 p.
Proof.
  intros kappa0 k faces p h. destruct (Req_dec (norm2 p) 0) as [z | n].
  - apply norm2_zero in z. subst p. apply lower_form_origin. lra.
  - assert (nz : p <> vzero) by (intros ->; apply n; unfold_vec; ring).
    destruct (point_on_face kappa0 p k h nz) as [kappa [b f]].
    intro v. specialize (faces kappa p b f v). pose proof (norm2_nonneg v).
    assert (kappa0 * norm2 v <= kappa * norm2 v) by (apply Rmult_le_compat_r; lra). lra.
Qed.

(** With the symmetry, the two faces x = q_1 and x = q_2. *)
Theorem two_faces_suffice : forall kappa0, 0 < kappa0 < 1 ->
  (forall kappa p, kappa0 <= kappa < 1 -> in_W kappa p ->
     vx p = q1_unit kappa \/ vx p = q2_unit kappa -> lower_form_at kappa p) ->
  forall p, in_W kappa0 p -> lower_form_at kappa0 p.
Proof.
  intros kappa0 k faces. apply faces_suffice; [exact k |].
  intros kappa p b [[hx [hy hz]] f].
  assert (F1 := fun e => faces kappa p b (conj hx (conj hy hz)) e).
  assert (F2 : vy p = q1_unit kappa \/ vy p = q2_unit kappa -> lower_form_at kappa p)
    by (intro e; apply lower_form_swap12, faces; [exact b | repeat split; cbn; tauto | exact e]).
  assert (F3 : vz p = q1_unit kappa \/ vz p = q2_unit kappa -> lower_form_at kappa p)
    by (intro e; apply lower_form_swap13, faces; [exact b | repeat split; cbn; tauto | exact e]).
  tauto.
Qed.

(** ** Blow-up at kappa = 1

    With delta = 1 - kappa and p = delta u, M(p) = I + delta N with entries
    u_j / s_i, so v^T M v - kappa |v|^2 = delta (|v|^2 + v^T N v): the sign of
    2I + N + N^T decides, and it stays regular as delta goes to 0. *)

Definition blown_up (delta : R) (u : vec) : mat :=
  let (x, y, z) := u in
  Mat (Vec 0 (y / s_unit (delta * y) (delta * z)) (z / s_unit (delta * y) (delta * z)))
      (Vec (x / s_unit (delta * x) (delta * z)) 0 (z / s_unit (delta * x) (delta * z)))
      (Vec (x / s_unit (delta * x) (delta * y)) (y / s_unit (delta * x) (delta * y)) 0).

Theorem blow_up_identity : forall kappa u v, let delta := 1 - kappa in
  dot v (mulv (M (vscale delta u)) v) - kappa * norm2 v
  = delta * (norm2 v + dot v (mulv (blown_up delta u) v)).
Proof.
  intros kappa [x y z] [a b c] delta. unfold M, blown_up, vscale, mulv, dot, norm2, Rdiv.
  cbn [vx vy vz row1 row2 row3]. unfold delta. ring.
Qed.

Theorem blow_up : forall kappa u, kappa < 1 ->
  (lower_form_at kappa (vscale (1 - kappa) u)
   <-> forall v, 0 <= norm2 v + dot v (mulv (blown_up (1 - kappa) u) v)).
Proof.
  intros kappa u h. split; intros H v; specialize (H v); pose proof (blow_up_identity kappa u v) as E; cbn zeta in E.
  - apply Rmult_le_reg_l with (1 - kappa); lra.
  - assert (0 <= (1 - kappa) * (norm2 v + dot v (mulv (blown_up (1 - kappa) u) v))) by (apply Rmult_le_pos; lra).
    lra.
Qed.

(** In the new variables the cube is [-r_1, r_2]^3, away from 0 and bounded
    for every kappa in (0,1), up to both ends. *)
Definition r_1 (kappa : R) : R := (1/2) / sqrt (1 + 2 * t_1 kappa ^ 2).
Definition r_2 (kappa : R) : R :=
  (if Rle_dec kappa (1/2) then 1 else 1 / (2 * kappa)) / sqrt (1 + 2 * t_2 kappa ^ 2).

Lemma blown_up_interval : forall kappa, 0 < kappa < 1 ->
  q1_unit kappa = (1 - kappa) * - r_1 kappa /\ q2_unit kappa = (1 - kappa) * r_2 kappa.
Proof.
  intros kappa k. unfold q1_unit, q2_unit, position_of_entry, r_1, r_2.
  assert (S : forall t, 0 < sqrt (1 + 2 * t ^ 2)) by (intro t; apply sqrt_lt_R0; nra).
  pose proof (S (t_1 kappa)) as S1. pose proof (S (t_2 kappa)) as S2.
  set (a := sqrt (1 + 2 * t_1 kappa ^ 2)) in *. set (b := sqrt (1 + 2 * t_2 kappa ^ 2)) in *. clearbody a b.
  unfold t_1, t_2. split; [field; lra |]. destruct (Rle_dec kappa (1/2)); field; lra.
Qed.

(** 2I + N + N^T at a corner, where every off-diagonal entry of N is n
    (n = -1/2 at Q_1), has the form 2 [(1 + 2n)(sum v)^2 + (1 - n) sum (v_i - v_j)^2] / 3. *)
Lemma blow_up_corner : forall n x y z, let N := Mat (Vec 0 n n) (Vec n 0 n) (Vec n n 0) in
  2 * (norm2 (Vec x y z) + dot (Vec x y z) (mulv N (Vec x y z)))
  = 2 * ((1 + 2 * n) * (x + y + z) ^ 2 + (1 - n) * ((x - y) ^ 2 + (x - z) ^ 2 + (y - z) ^ 2)) / 3.
Proof. intros. unfold N. unfold_vec. field. Qed.
