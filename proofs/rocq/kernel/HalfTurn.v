(** * Sets of orientations of which no two differ by half a turn

    By unit quaternions, of which two have a product that is not zero. *)

From Coq Require Import ZArith Reals Lra List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Number Trig Witness Orientation.
Import ListNotations.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.

(** Q' = (I - [h]x)^-1 (I + [h]x) Q *)
Definition is_turned_by (h : vec) (Q Q' : mat) : Prop := forall b, vsub (mulv Q' b) (mulv Q b) = cross h (vadd (mulv Q' b) (mulv Q b)).

Lemma not_turned : forall Q Q', is_turned_by vzero Q Q' -> Q' = Q.
Proof.
  intros [[a b c] [d e f] [g h i]] [[a' b' c'] [d' e' f'] [g' h' i']] t.
  pose proof (t e1) as t1. pose proof (t e2) as t2. pose proof (t e3) as t3. clear t.
  unfold mulv, vsub, vadd, cross, vzero, e1, e2, e3, Vec3.dot in *. cbn [row1 row2 row3 vx vy vz] in *.
  injection t1 as p1 p2 p3. injection t2 as q1 q2 q3. injection t3 as r1 r2 r3. f_equal; f_equal; lra.
Qed.

Lemma same_turned : forall Q, is_turned_by vzero Q Q.
Proof. intros Q b. destruct (mulv Q b) as [x y z]. unfold vsub, vadd, cross, vzero. cbn [vx vy vz]. f_equal; ring. Qed.

(** The rotation of the quaternion [s + v], of length one. *)
Definition rotation_of (s : R) (v : vec) : mat :=
  let x := vx v in let y := vy v in let z := vz v in
  Mat (Vec (s ^ 2 + x ^ 2 - y ^ 2 - z ^ 2) (2 * (x * y - s * z)) (2 * (x * z + s * y)))
      (Vec (2 * (x * y + s * z)) (s ^ 2 - x ^ 2 + y ^ 2 - z ^ 2) (2 * (y * z - s * x)))
      (Vec (2 * (x * z - s * y)) (2 * (y * z + s * x)) (s ^ 2 - x ^ 2 - y ^ 2 + z ^ 2)).
Definition is_quaternion (s : R) (v : vec) (Q : mat) : Prop := s ^ 2 + norm2 v = 1 /\ Q = rotation_of s v.

Lemma quaternion_product : forall s v t u A B, is_quaternion s v A -> is_quaternion t u B ->
  is_quaternion (s * t - Vec3.dot v u) (vadd (vadd (vscale s u) (vscale t v)) (cross v u)) (mulm A B).
Proof.
  intros s [x y z] t [p q r] A B [n ->] [m ->]. split.
  - transitivity ((s ^ 2 + norm2 (Vec x y z)) * (t ^ 2 + norm2 (Vec p q r))); [| rewrite n, m; ring].
    unfold norm2, Vec3.dot, vadd, vscale, cross. cbn [vx vy vz]. ring.
  - clear. unfold rotation_of, mulm, mulv, transpose, col1, col2, col3, Vec3.dot, vadd, vscale, cross. cbn [row1 row2 row3 vx vy vz]. f_equal; f_equal; ring.
Qed.

Lemma quaternions_apart : forall s v t u Q Q', is_quaternion s v Q -> is_quaternion t u Q' -> 0 < s * t + Vec3.dot v u ->
  is_turned_by (vscale (/ (s * t + Vec3.dot v u)) (vadd (vsub (vscale s u) (vscale t v)) (cross v u))) Q Q'.
Proof.
  intros s v t u Q Q' [n ->] [m ->] d0 b. set (d := s * t + Vec3.dot v u) in *. set (h := vadd (vsub (vscale s u) (vscale t v)) (cross v u)).
  assert (I : vscale d (vsub (vscale (s ^ 2 + norm2 v) (mulv (rotation_of t u) b)) (vscale (t ^ 2 + norm2 u) (mulv (rotation_of s v) b))) =
    cross h (vadd (vscale (s ^ 2 + norm2 v) (mulv (rotation_of t u) b)) (vscale (t ^ 2 + norm2 u) (mulv (rotation_of s v) b)))).
  { unfold d, h. clear. destruct v as [x y z], u as [p q r], b as [i j k]. unfold rotation_of, mulv, norm2, vsub, vadd, vscale, cross, Vec3.dot.
    cbn [row1 row2 row3 vx vy vz]. f_equal; ring. }
  rewrite n, m in I. clear n m. set (q := mulv (rotation_of s v) b) in *. set (q' := mulv (rotation_of t u) b) in *. clearbody q q' h d. clear - I d0.
  destruct q as [q1 q2 q3], q' as [p1 p2 p3], h as [h1 h2 h3]. unfold vsub, vadd, vscale, cross in *. cbn [vx vy vz] in *. injection I as i1 i2 i3.
  f_equal; apply Rmult_eq_reg_l with d; try lra; rewrite ?i1, ?i2, ?i3.
  - transitivity (d * (1 * p1 - 1 * q1)); [ring |]. rewrite i1. field. lra.
  - transitivity (d * (1 * p2 - 1 * q2)); [ring |]. rewrite i2. field. lra.
  - transitivity (d * (1 * p3 - 1 * q3)); [ring |]. rewrite i3. field. lra.
Qed.

(** ** Rotations by angles *)

Section Halves.
Variable a : R.
Let c := cos (in_degrees (a / 2)).
Let s := sin (in_degrees (a / 2)).
Lemma halved : cos (in_degrees a) = c ^ 2 - s ^ 2 /\ sin (in_degrees a) = 2 * s * c /\ c ^ 2 + s ^ 2 = 1.
Proof.
  assert (E : in_degrees a = 2 * in_degrees (a / 2)) by (unfold in_degrees; field). rewrite E, cos_2a, sin_2a. fold c s.
  pose proof (sin2_cos2 (in_degrees (a / 2))) as u. unfold Rsqr in u. fold c s in u. repeat split; try ring. lra.
Qed.
Lemma quaternion_of_axes : is_quaternion c (Vec s 0 0) (rotation_x (in_degrees a)) /\ is_quaternion c (Vec 0 s 0) (rotation_y (in_degrees a)) /\
  is_quaternion c (Vec 0 0 s) (rotation_z (in_degrees a)).
Proof.
  destruct halved as [C [S u]]. unfold is_quaternion, rotation_x, rotation_y, rotation_z, rotation_of, norm2. cbn [vx vy vz]. rewrite C, S.
  repeat split; try lra; f_equal; f_equal; lra.
Qed.
Lemma quaternion_about : forall u, norm2 u = 1 -> is_quaternion c (vscale s u) (rotation_about u (in_degrees a)).
Proof.
  intros u n. destruct halved as [C [S k]]. split; [rewrite norm2_scale, n; lra |].
  assert (E : 1 - (c ^ 2 - s ^ 2) = 2 * s ^ 2) by lra. unfold rotation_about, rotated. rewrite C, S, E. clear C S E. unfold norm2 in n. destruct u as [x y z]. cbn [vx vy vz] in n.
  unfold rotation_of, transpose, col1, col2, col3, vadd, vscale, cross, e1, e2, e3, Vec3.dot. cbn [row1 row2 row3 vx vy vz].
  assert (z2 : z ^ 2 = 1 - x ^ 2 - y ^ 2) by lra. f_equal; f_equal; try ring; ring [z2].
Qed.
End Halves.

Lemma degrees_minus : forall a b, in_degrees (a / 2) - in_degrees (b / 2) = in_degrees ((a - b) / 2).
Proof. intros. unfold in_degrees. field. Qed.
Lemma degrees_plus : forall a b, in_degrees (a / 2) + in_degrees (b / 2) = in_degrees ((a + b) / 2).
Proof. intros. unfold in_degrees. field. Qed.
Lemma acute : forall x, -90 < x < 90 -> 0 < cos (in_degrees x).
Proof. intros x [h1 h2]. pose proof PI_RGT_0. apply cos_gt_0; unfold in_degrees; nra. Qed.

Section Precision.
Variable bits : positive.

Definition is_less_than_half_a_turn (o : orientations) : bool :=
  let less x d := certainly bits true (Minus (d // 1) x) in let span t := Minus (greatest t) (least t) in
  match o with
  | TurnedBy t => less (span t) 180%Z
  | RollPitchYaw r p y => less (Minus (0 // 1) (least p)) 90%Z && less (greatest p) 90%Z && less (Plus (span r) (span y)) 180%Z
  | TurnedUpTo a => less a 90%Z
  | Tilted a b => less (Plus a b) 90%Z
  end.

Theorem never_half_a_turn : forall o Q Q', is_less_than_half_a_turn o = true -> in_orientations o Q -> in_orientations o Q' ->
  exists h, is_turned_by h Q Q' /\ match o with TurnedBy _ => vx h = 0 /\ vy h = 0 | _ => True end.
Proof.
  intros [t | r p y | m | m n] Q Q' less hQ hQ'; cbn [is_less_than_half_a_turn in_orientations] in *.
  - apply positive_sound in less. cbn [Claim.value] in less. destruct hQ as [a [[a1 a2] ->]], hQ' as [b [[b1 b2] ->]].
    destruct (quaternion_of_axes a) as [_ [_ A]]. destruct (quaternion_of_axes b) as [_ [_ B]].
    eexists. split; [apply (quaternions_apart _ _ _ _ _ _ A B) |]; unfold vscale, vadd, vsub, cross, Vec3.dot; cbn [vx vy vz]; [| split; ring].
    match goal with |- 0 < ?e => replace e with (cos (in_degrees ((a - b) / 2))) by (rewrite <- degrees_minus, cos_minus; ring) end. apply acute. lra.
  - apply andb_true_iff in less as [less l3]. apply andb_true_iff in less as [l1 l2]. apply positive_sound in l1, l2, l3. cbn [Claim.value] in l1, l2, l3.
    destruct hQ as [a [b [c [[a1 a2] [[b1 b2] [[c1 c2] ->]]]]]], hQ' as [a' [b' [c' [[a1' a2'] [[b1' b2'] [[c1' c2'] ->]]]]]].
    assert (K : forall a b c, exists s v, is_quaternion s v (mulm (rotation_z (in_degrees c)) (mulm (rotation_y (in_degrees b)) (rotation_x (in_degrees a)))) /\
      let A := in_degrees (a / 2) in let B := in_degrees (b / 2) in let C := in_degrees (c / 2) in
      s = cos A * cos B * cos C + sin A * sin B * sin C /\
      v = Vec (sin A * cos B * cos C - cos A * sin B * sin C) (cos A * sin B * cos C + sin A * cos B * sin C) (cos A * cos B * sin C - sin A * sin B * cos C)).
    { clear. intros a b c. destruct (quaternion_of_axes a) as [A _]. destruct (quaternion_of_axes b) as [_ [B _]]. destruct (quaternion_of_axes c) as [_ [_ C]].
      eexists; eexists. split; [exact (quaternion_product _ _ _ _ _ _ C (quaternion_product _ _ _ _ _ _ B A)) |]. cbv zeta.
      unfold vscale, vadd, vsub, cross, Vec3.dot. cbn [vx vy vz]. split; [ring | f_equal; ring]. }
    destruct (K a b c) as [s [v [H [es ev]]]]. destruct (K a' b' c') as [s' [v' [H' [es' ev']]]]. clear K. eexists. split; [apply (quaternions_apart _ _ _ _ _ _ H H') | exact I].
    clear H H'. subst s v s' v'. unfold Vec3.dot. cbn [vx vy vz].
    set (A := in_degrees (a / 2)). set (B := in_degrees (b / 2)). set (C := in_degrees (c / 2)). set (A' := in_degrees (a' / 2)). set (B' := in_degrees (b' / 2)). set (C' := in_degrees (c' / 2)).
    match goal with |- 0 < ?e => replace e with (cos (A - A') * cos (C - C') * cos (B - B') + sin (A - A') * sin (C - C') * sin (B + B'))
      by (rewrite !cos_minus, !sin_minus, sin_plus; ring) end.
    assert (P : 0 < cos (B - B') - sin (B + B') /\ 0 < cos (B - B') + sin (B + B')).
    { assert (One : forall b, - 90 < b < 90 -> 0 < cos (in_degrees (b / 2)) - sin (in_degrees (b / 2)) /\ 0 < cos (in_degrees (b / 2)) + sin (in_degrees (b / 2))).
      { clear. intros b [h1 h2]. destruct (halved b) as [C0 [_ _]]. pose proof (acute b (conj h1 h2)) as k. rewrite C0 in k. pose proof (acute (b / 2) ltac:(lra)) as c0. split; nra. }
      destruct (One b ltac:(lra)) as [p1 p2]. destruct (One b' ltac:(lra)) as [p3 p4]. fold B in p1, p2. fold B' in p3, p4.
      rewrite cos_minus, sin_plus. split.
      - replace (cos B * cos B' + sin B * sin B' - (sin B * cos B' + cos B * sin B')) with ((cos B - sin B) * (cos B' - sin B')) by ring. apply Rmult_lt_0_compat; assumption.
      - replace (cos B * cos B' + sin B * sin B' + (sin B * cos B' + cos B * sin B')) with ((cos B + sin B) * (cos B' + sin B')) by ring. apply Rmult_lt_0_compat; assumption. }
    assert (R0 : 0 < cos (A - A') * cos (C - C') - sin (A - A') * sin (C - C') /\ 0 < cos (A - A') * cos (C - C') + sin (A - A') * sin (C - C')).
    { rewrite <- cos_plus, <- cos_minus. unfold A, A', C, C'. rewrite !degrees_minus, degrees_plus. split; apply acute; lra. }
    set (p1 := cos (A - A') * cos (C - C')) in *. set (p2 := sin (A - A') * sin (C - C')) in *. set (q1 := cos (B - B')) in *. set (q2 := sin (B + B')) in *.
    destruct P as [k1 k2], R0 as [k3 k4]. pose proof (Rmult_lt_0_compat _ _ k1 k3). pose proof (Rmult_lt_0_compat _ _ k2 k4). lra.
  - apply positive_sound in less. cbn [Claim.value] in less. destruct hQ as [u [a [nu [[a1 a2] ->]]]], hQ' as [v [b [nv [[b1 b2] ->]]]].
    eexists. split; [apply (quaternions_apart _ _ _ _ _ _ (quaternion_about a u nu) (quaternion_about b v nv)) | exact I].
    pose proof (acute ((a + b) / 2) ltac:(lra)) as k. rewrite <- degrees_plus, cos_plus in k. set (A := in_degrees (a / 2)) in *. set (B := in_degrees (b / 2)) in *.
    assert (d1 : - 1 <= Vec3.dot u v).
    { pose proof (norm2_nonneg (vadd u v)) as g. replace (norm2 (vadd u v)) with (norm2 u + 2 * Vec3.dot u v + norm2 v) in g by (unfold norm2, vadd, Vec3.dot; cbn [vx vy vz]; ring). lra. }
    replace (Vec3.dot (vscale (sin A) u) (vscale (sin B) v)) with (sin A * sin B * Vec3.dot u v) by (unfold Vec3.dot, vscale; cbn [vx vy vz]; ring).
    assert (0 <= sin A * sin B) by (pose proof PI_RGT_0; apply Rmult_le_pos; apply sin_ge_0; unfold A, B, in_degrees; nra). nra.
  - apply positive_sound in less. cbn [Claim.value] in less. destruct hQ as [a [b [s [[b1 b2] [[s1 s2] ->]]]]], hQ' as [a' [b' [s' [[b1' b2'] [[s1' s2'] ->]]]]].
    assert (K : forall a b s, exists q v, is_quaternion q v (mulm (rotation_z (in_degrees a)) (mulm (rotation_y (in_degrees b)) (rotation_z (in_degrees (s - a))))) /\
      let B := in_degrees (b / 2) in let S := in_degrees (s / 2) in let D := in_degrees (a - s / 2) in
      q = cos B * cos S /\ v = Vec (- (sin B * sin D)) (sin B * cos D) (cos B * sin S)).
    { clear. intros a b s. destruct (quaternion_of_axes a) as [_ [_ A]]. destruct (quaternion_of_axes b) as [_ [B _]]. destruct (quaternion_of_axes (s - a)) as [_ [_ C]].
      eexists; eexists. split; [exact (quaternion_product _ _ _ _ _ _ A (quaternion_product _ _ _ _ _ _ B C)) |]. cbv zeta.
      replace (in_degrees (s / 2)) with (in_degrees (a / 2) + in_degrees ((s - a) / 2)) by (unfold in_degrees; field).
      replace (in_degrees (a - s / 2)) with (in_degrees (a / 2) - in_degrees ((s - a) / 2)) by (unfold in_degrees; field).
      rewrite cos_plus, sin_plus, cos_minus, sin_minus. unfold vscale, vadd, vsub, cross, Vec3.dot. cbn [vx vy vz]. split; [ring | f_equal; ring]. }
    destruct (K a b s) as [q [v [H [eq ev]]]]. destruct (K a' b' s') as [q' [v' [H' [eq' ev']]]]. clear K. eexists. split; [apply (quaternions_apart _ _ _ _ _ _ H H') | exact I].
    clear H H'. subst q v q' v'. unfold Vec3.dot. cbn [vx vy vz].
    set (B := in_degrees (b / 2)) in *. set (B' := in_degrees (b' / 2)) in *. set (S := in_degrees (s / 2)). set (S' := in_degrees (s' / 2)).
    set (D := in_degrees (a - s / 2)). set (D' := in_degrees (a' - s' / 2)).
    match goal with |- 0 < ?e => replace e with (cos B * cos B' * cos (S - S') + sin B * sin B' * cos (D - D')) by (rewrite !cos_minus; ring) end.
    set (T := in_degrees (Claim.value m / 2)). set (N := in_degrees (Claim.value n)). pose proof PI_RGT_0 as p0.
    assert (sines : 0 <= sin B <= sin T /\ 0 <= sin B' <= sin T).
    { repeat split; [apply sin_ge_0; unfold B, in_degrees; nra | apply sin_incr_1; unfold B, T, in_degrees; nra | apply sin_ge_0; unfold B', in_degrees; nra | apply sin_incr_1; unfold B', T, in_degrees; nra]. }
    assert (cosines : cos T <= cos B /\ cos T <= cos B' /\ 0 < cos T).
    { repeat split; [apply cos_decr_1; unfold B, T, in_degrees; nra | apply cos_decr_1; unfold B', T, in_degrees; nra | apply acute; lra]. }
    assert (torsion : cos N <= cos (S - S')).
    { unfold S, S'. rewrite degrees_minus. fold N. destruct (Rle_dec 0 (s - s')) as [g | g].
      - apply cos_decr_1; unfold N, in_degrees; nra.
      - rewrite <- (cos_neg (in_degrees ((s - s') / 2))). apply cos_decr_1; unfold N, in_degrees; nra. }
    destruct (halved (Claim.value m)) as [CM [SM u]]. fold T in CM, SM, u.
    assert (more : sin (in_degrees (Claim.value m)) < cos N).
    { rewrite <- sin_shift. apply sin_increasing_1; unfold N, in_degrees; nra. }
    assert (CM0 : 0 < cos (in_degrees (Claim.value m))) by (apply acute; lra). rewrite CM in CM0. rewrite SM in more. clear CM SM.
    pose proof (COS_bound (D - D')) as [d1 _]. destruct sines as [[i1 i2] [i3 i4]]. destruct cosines as [j1 [j2 j3]].
    set (c := cos T) in *. set (w := sin T) in *. assert (w0 : 0 <= w) by lra.
    assert (wc : w <= c) by nra. assert (c2 : 1 <= 2 * c ^ 2) by lra.
    assert (A1 : sin B * sin B' * cos (D - D') >= - w ^ 2).
    { assert (sin B * sin B' <= w * w) by (apply Rmult_le_compat; assumption). assert (0 <= sin B * sin B') by (apply Rmult_le_pos; assumption). nra. }
    assert (A2 : c ^ 2 <= cos B * cos B') by (replace (c ^ 2) with (c * c) by ring; apply Rmult_le_compat; lra).
    assert (A3 : 2 * w * c < cos (S - S')) by lra. assert (0 <= 2 * w * c) by nra.
    assert (A4 : c ^ 2 * (2 * w * c) < cos B * cos B' * cos (S - S')) by (apply Rlt_le_trans with (c ^ 2 * cos (S - S')); [apply Rmult_lt_compat_l; [apply pow_lt, j3 | exact A3] | apply Rmult_le_compat_r; lra]).
    assert (w ^ 2 <= c ^ 2 * (2 * w * c)) by (replace (c ^ 2 * (2 * w * c)) with (2 * c ^ 2 * (w * c)) by ring; nra). lra.
Qed.
End Precision.
End Named.
