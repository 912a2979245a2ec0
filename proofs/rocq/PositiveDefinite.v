(** * Positive definiteness of 3x3 matrices, and of intervals of them

    The certificate rules reduce every bound to the positive definiteness of
    a symmetric matrix that is known entry by entry up to an interval.  Three
    leading minors decide one matrix; four sign vertices decide an interval
    (Hertz, Rohn). *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues.
Local Open Scope R_scope.

(** The quadratic form v^T S v.  Only the symmetric part of S matters. *)
Definition quad (S : mat) (v : vec) : R := dot v (mulv S v).
Definition positive_definite (S : mat) : Prop := forall v, v <> vzero -> 0 < quad S v.
Definition positive_semidefinite (S : mat) : Prop := forall v, 0 <= quad S v.

Definition sym_part (S : mat) : mat := mscale (1/2) (madd S (transpose S)).

Lemma quad_sym_part : forall S v, quad (sym_part S) v = quad S v.
Proof. unfold quad, sym_part. intros. unfold_vec. field. Qed.

Lemma positive_definite_sym_part : forall S, positive_definite (sym_part S) <-> positive_definite S.
Proof.
  intro S. split; intros h v nz; specialize (h v nz); rewrite quad_sym_part in *; exact h.
Qed.

Lemma sym_part_symmetric : forall S, transpose (sym_part S) = sym_part S.
Proof. unfold sym_part. intros. unfold_vec. vec_split; field. Qed.

Lemma positive_definite_semidefinite : forall S, positive_definite S -> positive_semidefinite S.
Proof.
  intros S h v. destruct (Req_dec (norm2 v) 0) as [z | n].
  - apply norm2_zero in z. subst v. apply Req_le. unfold quad. unfold_vec. ring.
  - apply Rlt_le, h. intro z. apply n. subst v. unfold_vec. ring.
Qed.

Lemma vec_nonzero : forall x y z, Vec x y z <> vzero <-> x <> 0 \/ y <> 0 \/ z <> 0.
Proof.
  intros x y z. split.
  - intro h. destruct (Req_dec x 0); [destruct (Req_dec y 0); [destruct (Req_dec z 0) |] |]; auto.
    exfalso. apply h. subst. reflexivity.
  - intros h e. injection e. tauto.
Qed.

Lemma zero_or_not : forall v : vec, v = vzero \/ v <> vzero.
Proof.
  intro v. destruct (Req_dec (norm2 v) 0) as [e | n]; [left; apply norm2_zero; exact e |].
  right. intros ->. apply n. unfold_vec. ring.
Qed.

(** ** Leading minors *)

(** The symmetric matrix with rows (a b c), (b d e), (c e f). *)
Definition sym (a b c d e f : R) : mat := Mat (Vec a b c) (Vec b d e) (Vec c e f).

Definition minor2 (S : mat) : R := vx (row1 S) * vy (row2 S) - vy (row1 S) * vx (row2 S).

(** S_11 minor_2 v^T S v as a sum of three squares (Lagrange). *)
Lemma sum_of_squares : forall a b c d e f x y z,
  let S := sym a b c d e f in
  a * minor2 S * quad S (Vec x y z)
  = minor2 S * (a * x + b * y + c * z) ^ 2 + (minor2 S * y + (a * e - b * c) * z) ^ 2
    + a * det S * z ^ 2.
Proof. intros. unfold S, quad, sym, minor2, det. unfold_vec. ring. Qed.

Theorem leading_minors : forall a b c d e f, let S := sym a b c d e f in
  0 < a -> 0 < minor2 S -> 0 < det S -> positive_definite S.
Proof.
  intros a b c d e f S h1 h2 h3 [x y z] nz. apply vec_nonzero in nz.
  pose proof (sum_of_squares a b c d e f x y z) as E. fold S in E. cbn zeta in E.
  set (m2 := minor2 S) in *. set (m3 := det S) in *. clearbody m2 m3.
  apply Rmult_lt_reg_l with (a * m2); [apply Rmult_lt_0_compat; assumption |]. rewrite Rmult_0_r, E. clear E.
  assert (P : forall k u, 0 < k -> 0 <= k * u ^ 2) by (intros; apply Rmult_le_pos; [lra | apply pow2_ge_0]).
  assert (Q : forall k u, 0 < k -> u <> 0 -> 0 < k * u ^ 2)
    by (intros; apply Rmult_lt_0_compat; [assumption | rewrite <- Rsqr_pow2; apply Rsqr_pos_lt; assumption]).
  assert (h4 : 0 < a * m3) by (apply Rmult_lt_0_compat; assumption).
  pose proof (P m2 (a * x + b * y + c * z) h2). pose proof (pow2_ge_0 (m2 * y + (a * e - b * c) * z)).
  pose proof (P (a * m3) z h4).
  destruct (Req_dec z 0) as [-> | nz3]; [| pose proof (Q (a * m3) z h4 nz3); lra].
  destruct (Req_dec y 0) as [-> | nz2].
  - assert (x <> 0) by tauto. pose proof (Q m2 (a * x + b * 0 + c * 0) h2 ltac:(nra)). lra.
  - pose proof (Q 1 (m2 * y + (a * e - b * c) * 0) ltac:(lra) ltac:(nra)). lra.
Qed.

(** The test loses nothing. *)
Theorem leading_minors_complete : forall a b c d e f, let S := sym a b c d e f in
  positive_definite S -> 0 < a /\ 0 < minor2 S /\ 0 < det S.
Proof.
  intros a b c d e f S h.
  assert (h1 : 0 < a).
  { replace a with (quad S (Vec 1 0 0)) by (unfold S, quad, sym; unfold_vec; ring).
    apply h, vec_nonzero. lra. }
  assert (h2 : 0 < minor2 S).
  { apply Rmult_lt_reg_l with a; [exact h1 |]. rewrite Rmult_0_r.
    replace (a * minor2 S) with (quad S (Vec (- b) a 0)) by (unfold S, quad, minor2, sym; unfold_vec; ring).
    apply h, vec_nonzero. lra. }
  split; [exact h1 |]. split; [exact h2 |].
  (* the third row of the adjugate *)
  apply Rmult_lt_reg_r with (minor2 S); [exact h2 |]. rewrite Rmult_0_l.
  replace (det S * minor2 S) with (quad S (cross (Vec a b c) (Vec b d e)))
    by (unfold S, quad, minor2, sym; unfold_vec; ring).
  apply h. unfold cross; cbn [vx vy vz]. apply vec_nonzero. right; right.
  unfold minor2, S, sym in h2; cbn [row1 row2 vx vy vz] in h2. lra.
Qed.

(** ** Hertz's four sign vertices

    A symmetric matrix whose entries range over intervals is positive definite
    for every choice if it is at the four vertices that take the lower end on
    the diagonal and, off it, the end that hurts most for one pattern of signs
    of v (v and -v give the same pattern, hence four and not eight). *)

Section Hertz.
(** Lower ends on the diagonal; both ends off it. *)
Variables lo11 lo22 lo33 lo12 hi12 lo13 hi13 lo23 hi23 : R.

Definition hertz_vertices (good : mat -> Prop) : Prop :=
  good (sym lo11 lo12 lo13 lo22 lo23 lo33) /\  (* signs + + + *)
  good (sym lo11 hi12 hi13 lo22 lo23 lo33) /\  (* signs - + + *)
  good (sym lo11 hi12 lo13 lo22 hi23 lo33) /\  (* signs + - + *)
  good (sym lo11 lo12 hi13 lo22 hi23 lo33).    (* signs + + - *)

Definition in_interval (S : mat) : Prop :=
  exists a b c d e f, S = sym a b c d e f /\
    lo11 <= a /\ lo22 <= d /\ lo33 <= f /\
    lo12 <= b <= hi12 /\ lo13 <= c <= hi13 /\ lo23 <= e <= hi23.

(** Every v^T S v is at least the value of one of the four vertices at v. *)
Lemma hertz_below : forall S v, in_interval S ->
  quad (sym lo11 lo12 lo13 lo22 lo23 lo33) v <= quad S v \/
  quad (sym lo11 hi12 hi13 lo22 lo23 lo33) v <= quad S v \/
  quad (sym lo11 hi12 lo13 lo22 hi23 lo33) v <= quad S v \/
  quad (sym lo11 lo12 hi13 lo22 hi23 lo33) v <= quad S v.
Proof.
  intros S [x y z] [a [b [c [d [e [f [-> [ha [hd [hf [hb [hc he]]]]]]]]]]]].
  assert (Q : forall a b c d e f, quad (sym a b c d e f) (Vec x y z)
    = a * x ^ 2 + d * y ^ 2 + f * z ^ 2 + 2 * (b * (x * y) + c * (x * z) + e * (y * z)))
    by (intros; unfold quad, sym; unfold_vec; ring).
  rewrite !Q.
  assert (D : forall p q u, p <= q -> p * u ^ 2 <= q * u ^ 2)
    by (intros; apply Rmult_le_compat_r; [apply pow2_ge_0 | assumption]).
  pose proof (D _ _ x ha). pose proof (D _ _ y hd). pose proof (D _ _ z hf).
  (* an off-diagonal term is least at one end of its interval, by the sign of its product *)
  assert (P : forall lo hi p u, lo <= p <= hi -> 0 <= u -> lo * u <= p * u) by (intros; nra).
  assert (N : forall lo hi p u, lo <= p <= hi -> u <= 0 -> hi * u <= p * u) by (intros; nra).
  assert (S : (0 <= x * y /\ 0 <= x * z /\ 0 <= y * z) \/ (x * y <= 0 /\ x * z <= 0 /\ 0 <= y * z) \/
              (x * y <= 0 /\ 0 <= x * z /\ y * z <= 0) \/ (0 <= x * y /\ x * z <= 0 /\ y * z <= 0)).
  { assert (U : forall u v, 0 <= u -> 0 <= v -> 0 <= u * v) by (intros; nra).
    assert (V : forall u v, u <= 0 -> 0 <= v -> u * v <= 0) by (intros; nra).
    assert (V' : forall u v, 0 <= u -> v <= 0 -> u * v <= 0) by (intros; nra).
    assert (W : forall u v, u <= 0 -> v <= 0 -> 0 <= u * v) by (intros; nra).
    destruct (Rle_lt_dec 0 x) as [? | X], (Rle_lt_dec 0 y) as [? | Y], (Rle_lt_dec 0 z) as [? | Z];
      try apply Rlt_le in X; try apply Rlt_le in Y; try apply Rlt_le in Z; auto 10. }
  destruct S as [[sb [sc se]] | [[sb [sc se]] | [[sb [sc se]] | [sb [sc se]]]]].
  - left. pose proof (P _ _ _ _ hb sb). pose proof (P _ _ _ _ hc sc). pose proof (P _ _ _ _ he se). lra.
  - right; left. pose proof (N _ _ _ _ hb sb). pose proof (N _ _ _ _ hc sc). pose proof (P _ _ _ _ he se). lra.
  - right; right; left. pose proof (N _ _ _ _ hb sb). pose proof (P _ _ _ _ hc sc). pose proof (N _ _ _ _ he se). lra.
  - right; right; right. pose proof (P _ _ _ _ hb sb). pose proof (N _ _ _ _ hc sc). pose proof (N _ _ _ _ he se). lra.
Qed.

Theorem hertz : hertz_vertices positive_definite -> forall S, in_interval S -> positive_definite S.
Proof.
  intros [h1 [h2 [h3 h4]]] S hS v nz. specialize (h1 v nz). specialize (h2 v nz).
  specialize (h3 v nz). specialize (h4 v nz). destruct (hertz_below S v hS) as [? | [? | [? | ?]]]; lra.
Qed.

Theorem hertz_semidefinite :
  hertz_vertices positive_semidefinite -> forall S, in_interval S -> positive_semidefinite S.
Proof.
  intros [h1 [h2 [h3 h4]]] S hS v. specialize (h1 v). specialize (h2 v). specialize (h3 v). specialize (h4 v).
  destruct (hertz_below S v hS) as [? | [? | [? | ?]]]; lra.
Qed.
End Hertz.
