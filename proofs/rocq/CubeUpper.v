(** * Upper bound on diagonal cubes, L = 1

    Schur's test: if every off-diagonal entry of M is at most t in absolute
    value, then sigma_max(M) <= 1 + 2t.  On [-c1, c2]^3 with c1 <= c2 the
    entries are at most U, the entry at Q_2, where 1 + 2U is reached. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal CubeLower.
Local Open Scope R_scope.

(** One row (1, m, n) of M, |m| <= t and |n| <= t. *)
Lemma row_bound : forall t m n a b c, 0 <= t -> Rabs m <= t -> Rabs n <= t ->
  Rabs (a + m * b + n * c) <= Rabs a + t * Rabs b + t * Rabs c.
Proof.
  intros t m n a b c ht hm hn.
  eapply Rle_trans; [apply Rabs_triang |]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang |].
  rewrite !Rabs_mult. pose proof (Rabs_pos b). pose proof (Rabs_pos c).
  assert (Rabs m * Rabs b <= t * Rabs b) by (apply Rmult_le_compat_r; lra).
  assert (Rabs n * Rabs c <= t * Rabs c) by (apply Rmult_le_compat_r; lra). lra.
Qed.

(** The sum of the squared row bounds, with its defect. *)
Lemma schur_identity : forall t A B C,
  (1 + 2 * t) ^ 2 * (A ^ 2 + B ^ 2 + C ^ 2)
  - ((A + t * B + t * C) ^ 2 + (B + t * A + t * C) ^ 2 + (C + t * A + t * B) ^ 2)
  = t * (2 + t) * ((A - B) ^ 2 + (A - C) ^ 2 + (B - C) ^ 2).
Proof. intros. ring. Qed.

Section Schur.
Variables t m12 m13 m21 m23 m31 m32 : R.
Let N := Mat (Vec 1 m12 m13) (Vec m21 1 m23) (Vec m31 m32 1).
Hypothesis t0 : 0 < t.
Hypothesis h12 : Rabs m12 <= t.
Hypothesis h13 : Rabs m13 <= t.
Hypothesis h21 : Rabs m21 <= t.
Hypothesis h23 : Rabs m23 <= t.
Hypothesis h31 : Rabs m31 <= t.
Hypothesis h32 : Rabs m32 <= t.

Lemma schur_rows : forall a b c,
  let u := mulv N (Vec a b c) in
  Rabs (vx u) <= Rabs a + t * Rabs b + t * Rabs c /\
  Rabs (vy u) <= Rabs b + t * Rabs a + t * Rabs c /\
  Rabs (vz u) <= Rabs c + t * Rabs a + t * Rabs b.
Proof.
  intros a b c. unfold N, mulv, dot; cbn [vx vy vz row1 row2 row3]. repeat split.
  - rewrite Rmult_1_l. apply row_bound; lra.
  - replace (m21 * a + 1 * b + m23 * c) with (b + m21 * a + m23 * c) by ring. apply row_bound; lra.
  - replace (m31 * a + m32 * b + 1 * c) with (c + m31 * a + m32 * b) by ring. apply row_bound; lra.
Qed.

Theorem schur_test : sigma_at_most (1 + 2 * t) N.
Proof.
  intros [a b c]. destruct (schur_rows a b c) as [r1 [r2 r3]]. cbn zeta in *.
  destruct (mulv N (Vec a b c)) as [u1 u2 u3]. unfold norm2; cbn [vx vy vz] in *.
  pose proof (schur_identity t (Rabs a) (Rabs b) (Rabs c)) as I.
  rewrite <- (pow2_abs a), <- (pow2_abs b), <- (pow2_abs c), <- (pow2_abs u1), <- (pow2_abs u2), <- (pow2_abs u3).
  pose proof (pow_incr _ _ 2 (conj (Rabs_pos u1) r1)). pose proof (pow_incr _ _ 2 (conj (Rabs_pos u2) r2)).
  pose proof (pow_incr _ _ 2 (conj (Rabs_pos u3) r3)).
  assert (0 <= t * (2 + t) * ((Rabs a - Rabs b) ^ 2 + (Rabs a - Rabs c) ^ 2 + (Rabs b - Rabs c) ^ 2)).
  { apply Rmult_le_pos; [nra |]. pose proof (pow2_ge_0 (Rabs a - Rabs b)).
    pose proof (pow2_ge_0 (Rabs a - Rabs c)). pose proof (pow2_ge_0 (Rabs b - Rabs c)). lra. }
  lra.
Qed.

(** If the bound is reached, |v_1| = |v_2| = |v_3| and no row is below its bound. *)
Lemma schur_reached : stretches_by (1 + 2 * t) N ->
  exists a b c, 0 < Rabs a /\ Rabs b = Rabs a /\ Rabs c = Rabs a /\
    let u := mulv N (Vec a b c) in
    Rabs (vx u) = (1 + 2 * t) * Rabs a /\ Rabs (vy u) = (1 + 2 * t) * Rabs a /\
    Rabs (vz u) = (1 + 2 * t) * Rabs a.
Proof.
  intros [[a b c] [nz e]]. exists a, b, c. destruct (schur_rows a b c) as [r1 [r2 r3]]. cbn zeta in *.
  destruct (mulv N (Vec a b c)) as [u1 u2 u3]. unfold norm2 in e; cbn [vx vy vz] in *.
  pose proof (schur_identity t (Rabs a) (Rabs b) (Rabs c)) as I.
  rewrite <- (pow2_abs a), <- (pow2_abs b), <- (pow2_abs c), <- (pow2_abs u1), <- (pow2_abs u2), <- (pow2_abs u3) in e.
  pose proof (pow_incr _ _ 2 (conj (Rabs_pos u1) r1)) as q1. pose proof (pow_incr _ _ 2 (conj (Rabs_pos u2) r2)) as q2.
  pose proof (pow_incr _ _ 2 (conj (Rabs_pos u3) r3)) as q3.
  assert (nz' : ~ (Rabs a = 0 /\ Rabs b = 0 /\ Rabs c = 0)).
  { intros [za [zb zc]]. apply nz. unfold vzero.
    f_equal; match goal with |- ?w = 0 =>
      destruct (Req_dec w 0) as [z | n]; [exact z | apply Rabs_no_R0 in n; lra] end. }
  pose proof (Rabs_pos a). pose proof (Rabs_pos b). pose proof (Rabs_pos c).
  pose proof (Rabs_pos u1). pose proof (Rabs_pos u2). pose proof (Rabs_pos u3).
  set (A := Rabs a) in *. set (B := Rabs b) in *. set (C := Rabs c) in *.
  set (V1 := Rabs u1) in *. set (V2 := Rabs u2) in *. set (V3 := Rabs u3) in *.
  clearbody A B C V1 V2 V3. clear nz.
  assert (S : (A - B) ^ 2 + (A - C) ^ 2 + (B - C) ^ 2 <= 0)
    by (apply Rmult_le_reg_l with (t * (2 + t)); [nra | lra]).
  pose proof (pow2_ge_0 (A - B)). pose proof (pow2_ge_0 (A - C)). pose proof (pow2_ge_0 (B - C)).
  assert (sq : forall x, x ^ 2 = 0 -> x = 0) by (intros x h; apply Rsqr_0_uniq; rewrite Rsqr_pow2; exact h).
  assert (A - B = 0) by (apply sq; lra). assert (A - C = 0) by (apply sq; lra).
  assert (B = A) by lra. assert (C = A) by lra. subst B C.
  assert (0 < A) by (destruct (Req_dec A 0); [tauto | lra]).
  replace (A + t * A + t * A) with ((1 + 2 * t) * A) in * by ring.
  assert (fin : forall V, 0 <= V -> V ^ 2 = ((1 + 2 * t) * A) ^ 2 -> V = (1 + 2 * t) * A).
  { intros V hV hE. apply Rsqr_inj; [exact hV | nra | rewrite !Rsqr_pow2; exact hE]. }
  repeat split; try assumption; apply fin; try assumption; lra.
Qed.

(** Reaching the bound needs an entry of absolute value t in every row. *)
Lemma schur_reached_entries : stretches_by (1 + 2 * t) N ->
  Rabs m12 = t /\ Rabs m13 = t /\ Rabs m21 = t /\ Rabs m23 = t /\ Rabs m31 = t /\ Rabs m32 = t.
Proof.
  intro h. destruct (schur_reached h) as [a [b [c [a0 [eb [ec [u1 [u2 u3]]]]]]]].
  unfold N, mulv, dot in u1, u2, u3; cbn [vx vy vz row1 row2 row3] in u1, u2, u3.
  assert (X : forall m n x y z, Rabs x = Rabs a -> Rabs y = Rabs a -> Rabs z = Rabs a ->
    Rabs m <= t -> Rabs n <= t -> Rabs (x + m * y + n * z) = (1 + 2 * t) * Rabs a ->
    Rabs m = t /\ Rabs n = t).
  { intros m n x y z ex ey ez hm hn e.
    pose proof (Rabs_triang (x + m * y) (n * z)) as tr1. pose proof (Rabs_triang x (m * y)) as tr2.
    rewrite Rabs_mult in tr1, tr2. rewrite ez in tr1. rewrite ex, ey in tr2.
    assert (Rabs m * Rabs a <= t * Rabs a) by (apply Rmult_le_compat_r; lra).
    assert (Rabs n * Rabs a <= t * Rabs a) by (apply Rmult_le_compat_r; lra).
    split; apply Rmult_eq_reg_r with (Rabs a); lra. }
  rewrite Rmult_1_l in u1.
  replace (m21 * a + 1 * b + m23 * c) with (b + m21 * a + m23 * c) in u2 by ring.
  replace (m31 * a + m32 * b + 1 * c) with (c + m31 * a + m32 * b) in u3 by ring.
  destruct (X _ _ _ _ _ eq_refl eb ec h12 h13 u1). destruct (X _ _ _ _ _ eb eq_refl ec h21 h23 u2).
  destruct (X _ _ _ _ _ ec eq_refl eb h31 h32 u3). repeat split; assumption.
Qed.
End Schur.

(** ** On a cube *)

(** On |P|_inf <= c the largest singular value is at most 1 + 2t. *)
Theorem cube_upper : forall c t p, on_diagonal c t -> in_box (- c) c p ->
  sigma_at_most (1 + 2 * t) (M p).
Proof.
  intros c t [x y z] D [hx [hy hz]]. cbn [vx vy vz] in *. pose proof (proj2 (diagonal_pos _ _ D)).
  apply schur_test; try assumption;
    first [apply (entry_bound c); assumption | rewrite s_unit_sym; apply (entry_bound c); assumption].
Qed.

(** On [-c1, c]^3 with c1 < c only (c,c,c) can reach 1 + 2t. *)
Theorem cube_upper_reached : forall c1 c t p, on_diagonal c t -> 0 < c1 < c -> in_box (- c1) c p ->
  stretches_by (1 + 2 * t) (M p) -> p = diagonal c.
Proof.
  intros c1 c t [x y z] D h [hx [hy hz]] top. cbn [vx vy vz] in *.
  assert (B : forall u, - c1 <= u <= c -> - c <= u <= c) by (intros; lra).
  assert (E : forall u v, - c1 <= u <= c -> - c1 <= v <= c ->
    Rabs (u / s_unit u v) <= t /\ Rabs (v / s_unit u v) <= t).
  { intros u v hu hv. split; [| rewrite s_unit_sym]; apply (entry_bound c); auto. }
  assert (F : forall u v, - c1 <= u <= c -> - c1 <= v <= c -> Rabs (u / s_unit u v) = t -> u = c).
  { intros u v hu hv e. destruct (Req_dec u c) as [q | q]; [exact q | exfalso].
    assert (Rabs (u / s_unit u v) < t) by (apply (entry_bound_strict c); auto; lra). lra. }
  apply schur_reached_entries in top; try (apply E; assumption); [| apply (diagonal_pos _ _ D)].
  destruct top as [ey [ez [ex _]]]. unfold diagonal.
  f_equal; [apply (F x z) | apply (F y z) | rewrite s_unit_sym in ez; apply (F z y)]; assumption.
Qed.
