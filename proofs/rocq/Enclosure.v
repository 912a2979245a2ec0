(** * Vectors and matrices of fixed-point intervals, and definiteness

    The interval counterparts of [Vec3.v], of the slopes and of the two vertex
    tests.  [contains_vec a v], [contains_mat a M]: entry by entry. *)

From Coq Require Import ZArith Reals Lra Lia Psatz Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics PositiveDefinite Rules Slopes Fixed.
Local Open Scope R_scope.

Record ivec := IVec { ix : fixed; iy : fixed; iz : fixed }.
Record imat := IMat { irow1 : ivec; irow2 : ivec; irow3 : ivec }.
(** A symmetric matrix: its diagonal, and its entries (1,2), (1,3), (2,3). *)
Record isym := ISym { i11 : fixed; i22 : fixed; i33 : fixed; i12 : fixed; i13 : fixed; i23 : fixed }.
(** An integer matrix, by rows. *)
Record zmat := ZMat { z11 : Z; z12 : Z; z13 : Z; z21 : Z; z22 : Z; z23 : Z; z31 : Z; z32 : Z; z33 : Z }.

(** [split] alone would go on into the definition of [contains]. *)
Ltac conjuncts := lazymatch goal with |- _ /\ _ => split; [| conjuncts] | _ => idtac end.

Section Precision.
Variable bits : positive.

Definition contains_vec (a : ivec) (v : vec) : Prop :=
  contains bits (ix a) (vx v) /\ contains bits (iy a) (vy v) /\ contains bits (iz a) (vz v).
Definition contains_mat (a : imat) (M : mat) : Prop :=
  contains_vec (irow1 a) (row1 M) /\ contains_vec (irow2 a) (row2 M) /\ contains_vec (irow3 a) (row3 M).
(** Of a symmetric matrix only the upper triangle is stored. *)
Definition contains_sym (a : isym) (S : mat) : Prop :=
  S = sym (vx (row1 S)) (vy (row1 S)) (vz (row1 S)) (vy (row2 S)) (vz (row2 S)) (vz (row3 S)) /\
  contains bits (i11 a) (vx (row1 S)) /\ contains bits (i22 a) (vy (row2 S)) /\
  contains bits (i33 a) (vz (row3 S)) /\ contains bits (i12 a) (vy (row1 S)) /\
  contains bits (i13 a) (vz (row1 S)) /\ contains bits (i23 a) (vz (row2 S)).

(** Closes goals about the operations below, operation by operation. *)
Ltac enclose :=
  repeat match goal with
    | h : contains_vec _ _ |- _ => destruct h as [? [? ?]]
    | h : contains_mat _ _ |- _ => destruct h as [? [? ?]]
    | |- contains_mat _ _ => split; [| split]
    | |- contains_vec _ _ => split; [| split]
    end;
  cbn [ix iy iz irow1 irow2 irow3 vx vy vz row1 row2 row3];
  repeat first
    [ assumption | apply add_sound | apply sub_sound | apply neg_sound | apply mul_sound | apply sqr_sound
    | apply integer_sound | apply dyadic_sound ].

(** ** Linear algebra *)

Definition iadd (a b : ivec) : ivec := IVec (add (ix a) (ix b)) (add (iy a) (iy b)) (add (iz a) (iz b)).
Definition iscale (c : fixed) (a : ivec) : ivec :=
  IVec (mul bits c (ix a)) (mul bits c (iy a)) (mul bits c (iz a)).
Definition idot (a b : ivec) : fixed :=
  add (add (mul bits (ix a) (ix b)) (mul bits (iy a) (iy b))) (mul bits (iz a) (iz b)).
Definition inorm2 (a : ivec) : fixed := add (add (sqr bits (ix a)) (sqr bits (iy a))) (sqr bits (iz a)).
Definition iapply (a : imat) (v : ivec) : ivec := IVec (idot (irow1 a) v) (idot (irow2 a) v) (idot (irow3 a) v).
Definition imadd (a b : imat) : imat :=
  IMat (iadd (irow1 a) (irow1 b)) (iadd (irow2 a) (irow2 b)) (iadd (irow3 a) (irow3 b)).
Definition isub (a b : ivec) : ivec := IVec (sub (ix a) (ix b)) (sub (iy a) (iy b)) (sub (iz a) (iz b)).
Definition imsub (a b : imat) : imat :=
  IMat (isub (irow1 a) (irow1 b)) (isub (irow2 a) (irow2 b)) (isub (irow3 a) (irow3 b)).
Definition imscale (c : fixed) (a : imat) : imat :=
  IMat (iscale c (irow1 a)) (iscale c (irow2 a)) (iscale c (irow3 a)).
Definition iouter (u v : ivec) : imat := IMat (iscale (ix u) v) (iscale (iy u) v) (iscale (iz u) v).
(** Coordinate by coordinate. *)
Definition ihadamard (a b : ivec) : ivec :=
  IVec (mul bits (ix a) (ix b)) (mul bits (iy a) (iy b)) (mul bits (iz a) (iz b)).
Definition hadamard (u v : vec) : vec := Vec (vx u * vx v) (vy u * vy v) (vz u * vz v).

Lemma iadd_sound : forall a b u v, contains_vec a u -> contains_vec b v -> contains_vec (iadd a b) (vadd u v).
Proof. intros. enclose. Qed.
Lemma isub_sound : forall a b u v, contains_vec a u -> contains_vec b v -> contains_vec (isub a b) (vsub u v).
Proof. intros. enclose. Qed.
Lemma iscale_sound : forall c a x v, contains bits c x -> contains_vec a v -> contains_vec (iscale c a) (vscale x v).
Proof. intros. enclose. Qed.
Lemma idot_sound : forall a b u v, contains_vec a u -> contains_vec b v -> contains bits (idot a b) (dot u v).
Proof. intros. unfold dot, idot. enclose. Qed.
Lemma inorm2_sound : forall a v, contains_vec a v -> contains bits (inorm2 a) (norm2 v).
Proof. intros. unfold norm2, inorm2. enclose. Qed.
Lemma ihadamard_sound : forall a b u v,
  contains_vec a u -> contains_vec b v -> contains_vec (ihadamard a b) (hadamard u v).
Proof. intros. enclose. Qed.
Lemma iapply_sound : forall a M b v, contains_mat a M -> contains_vec b v -> contains_vec (iapply a b) (mulv M v).
Proof. intros a M b v [h1 [h2 h3]] k. split; [| split]; apply idot_sound; assumption. Qed.
Lemma imadd_sound : forall a b M N, contains_mat a M -> contains_mat b N -> contains_mat (imadd a b) (madd M N).
Proof. intros a b M N [h1 [h2 h3]] [k1 [k2 k3]]. split; [| split]; apply iadd_sound; assumption. Qed.
Lemma imsub_sound : forall a b M N, contains_mat a M -> contains_mat b N -> contains_mat (imsub a b) (msub M N).
Proof. intros a b M N [h1 [h2 h3]] [k1 [k2 k3]]. split; [| split]; apply isub_sound; assumption. Qed.
Lemma imscale_sound : forall c a x M, contains bits c x -> contains_mat a M -> contains_mat (imscale c a) (mscale x M).
Proof. intros c a x M h [h1 [h2 h3]]. split; [| split]; apply iscale_sound; assumption. Qed.
Lemma iouter_sound : forall a b u v, contains_vec a u -> contains_vec b v -> contains_mat (iouter a b) (outer u v).
Proof. intros a b u v [h1 [h2 h3]] k. split; [| split]; apply iscale_sound; assumption. Qed.

(** I - n n^T, the diagonal as sums of squares: n is a unit vector. *)
Definition iprojection (n : ivec) : imat :=
  let xx := sqr bits (ix n) in let yy := sqr bits (iy n) in let zz := sqr bits (iz n) in
  let xy := neg (mul bits (ix n) (iy n)) in let xz := neg (mul bits (ix n) (iz n)) in
  let yz := neg (mul bits (iy n) (iz n)) in
  IMat (IVec (add yy zz) xy xz) (IVec xy (add xx zz) yz) (IVec xz yz (add xx yy)).

Lemma iprojection_sound : forall a n, norm2 n = 1 -> contains_vec a n -> contains_mat (iprojection a) (projection n).
Proof.
  intros a [x y z] u h. unfold norm2 in u; cbn [vx vy vz] in u.
  replace (projection (Vec x y z))
    with (Mat (Vec (y ^ 2 + z ^ 2) (- (x * y)) (- (x * z))) (Vec (- (x * y)) (x ^ 2 + z ^ 2) (- (y * z)))
              (Vec (- (x * z)) (- (y * z)) (x ^ 2 + y ^ 2)))
    by (unfold projection, outer; unfold_vec; vec_split; nra).
  destruct h as [h1 [h2 h3]]. cbn [vx vy vz] in *.
  unfold iprojection. cbn zeta. enclose.
Qed.

(** Multiplication by an integer, exactly. *)
Definition times (n : Z) (a : fixed) : fixed :=
  if (0 <=? n)%Z then Fixed (n * lo a) (n * hi a) else Fixed (n * hi a) (n * lo a).

Lemma times_sound : forall n a x, contains bits a x -> contains bits (times n a) (IZR n * x).
Proof.
  intros n a x [l u]. unfold times, contains. rewrite Rmult_assoc.
  destruct (0 <=? n)%Z eqn:e; cbn [lo hi]; rewrite !mult_IZR.
  - apply Z.leb_le, IZR_le in e. split; apply Rmult_le_compat_l; assumption.
  - apply Z.leb_gt, IZR_lt in e. split; apply Rmult_le_compat_neg_l; lra.
Qed.

Definition matrix_of (w : zmat) : mat :=
  Mat (Vec (IZR (z11 w)) (IZR (z12 w)) (IZR (z13 w))) (Vec (IZR (z21 w)) (IZR (z22 w)) (IZR (z23 w)))
      (Vec (IZR (z31 w)) (IZR (z32 w)) (IZR (z33 w))).

(** B + B^T for B = w A. *)
Definition twice_sym (B : mat) : mat := madd B (transpose B).

Definition combination (p q r : Z) (a b c : fixed) : fixed := add (add (times p a) (times q b)) (times r c).
Definition twice_rotated (w : zmat) (a : imat) : isym :=
  let c1 p q r := combination p q r (ix (irow1 a)) (ix (irow2 a)) (ix (irow3 a)) in
  let c2 p q r := combination p q r (iy (irow1 a)) (iy (irow2 a)) (iy (irow3 a)) in
  let c3 p q r := combination p q r (iz (irow1 a)) (iz (irow2 a)) (iz (irow3 a)) in
  ISym (times 2 (c1 (z11 w) (z12 w) (z13 w))) (times 2 (c2 (z21 w) (z22 w) (z23 w)))
       (times 2 (c3 (z31 w) (z32 w) (z33 w)))
       (add (c2 (z11 w) (z12 w) (z13 w)) (c1 (z21 w) (z22 w) (z23 w)))
       (add (c3 (z11 w) (z12 w) (z13 w)) (c1 (z31 w) (z32 w) (z33 w)))
       (add (c3 (z21 w) (z22 w) (z23 w)) (c2 (z31 w) (z32 w) (z33 w))).

Lemma combination_sound : forall p q r a b c x y z,
  contains bits a x -> contains bits b y -> contains bits c z ->
  contains bits (combination p q r a b c) (IZR p * x + IZR q * y + IZR r * z).
Proof. intros. repeat apply add_sound; apply times_sound; assumption. Qed.

Lemma twice_rotated_sound : forall w a A, contains_mat a A ->
  contains_sym (twice_rotated w a) (twice_sym (mulm (matrix_of w) A)).
Proof.
  intros w a [[a11 a12 a13] [a21 a22 a23] [a31 a32 a33]] h.
  destruct h as [[h11 [h12 h13]] [[h21 [h22 h23]] [h31 [h32 h33]]]]. cbn [row1 row2 row3 vx vy vz] in *.
  replace (twice_sym (mulm (matrix_of w) (Mat (Vec a11 a12 a13) (Vec a21 a22 a23) (Vec a31 a32 a33))))
    with (sym (2 * (IZR (z11 w) * a11 + IZR (z12 w) * a21 + IZR (z13 w) * a31))
              ((IZR (z11 w) * a12 + IZR (z12 w) * a22 + IZR (z13 w) * a32) + (IZR (z21 w) * a11 + IZR (z22 w) * a21 + IZR (z23 w) * a31))
              ((IZR (z11 w) * a13 + IZR (z12 w) * a23 + IZR (z13 w) * a33) + (IZR (z31 w) * a11 + IZR (z32 w) * a21 + IZR (z33 w) * a31))
              (2 * (IZR (z21 w) * a12 + IZR (z22 w) * a22 + IZR (z23 w) * a32))
              ((IZR (z21 w) * a13 + IZR (z22 w) * a23 + IZR (z23 w) * a33) + (IZR (z31 w) * a12 + IZR (z32 w) * a22 + IZR (z33 w) * a32))
              (2 * (IZR (z31 w) * a13 + IZR (z32 w) * a23 + IZR (z33 w) * a33)))
    by (clear; unfold twice_sym, matrix_of, sym; unfold_vec; vec_split; ring).
  unfold contains_sym, twice_rotated, sym. cbn zeta. cbn [row1 row2 row3 vx vy vz i11 i22 i33 i12 i13 i23].
  conjuncts; first
    [ reflexivity | apply times_sound, combination_sound; assumption
    | apply add_sound; apply combination_sound; assumption ].
Qed.

(** ** Sums and differences over symmetric matrices *)

Definition isym_add (a b : isym) : isym :=
  ISym (add (i11 a) (i11 b)) (add (i22 a) (i22 b)) (add (i33 a) (i33 b))
       (add (i12 a) (i12 b)) (add (i13 a) (i13 b)) (add (i23 a) (i23 b)).
Definition isym_sub (a b : isym) : isym :=
  ISym (sub (i11 a) (i11 b)) (sub (i22 a) (i22 b)) (sub (i33 a) (i33 b))
       (sub (i12 a) (i12 b)) (sub (i13 a) (i13 b)) (sub (i23 a) (i23 b)).
(** T - c I *)
Definition minus_identity (a : isym) (c : fixed) : isym :=
  ISym (sub (i11 a) c) (sub (i22 a) c) (sub (i33 a) c) (i12 a) (i13 a) (i23 a).

Lemma isym_add_sound : forall a b S T, contains_sym a S -> contains_sym b T -> contains_sym (isym_add a b) (madd S T).
Proof.
  intros a b [[s11 s12 s13] [s21 s22 s23] [s31 s32 s33]] [[t11 t12 t13] [t21 t22 t23] [t31 t32 t33]] [e h] [f k].
  unfold sym in e, f. cbn [row1 row2 row3 vx vy vz] in *. injection e as -> -> ->. injection f as -> -> ->.
  destruct h as [? [? [? [? [? ?]]]]]. destruct k as [? [? [? [? [? ?]]]]].
  unfold contains_sym, isym_add, madd, vadd, sym. cbn [row1 row2 row3 vx vy vz i11 i22 i33 i12 i13 i23].
  conjuncts; first [reflexivity | apply add_sound; assumption].
Qed.

Lemma isym_sub_sound : forall a b S T, contains_sym a S -> contains_sym b T -> contains_sym (isym_sub a b) (msub S T).
Proof.
  intros a b [[s11 s12 s13] [s21 s22 s23] [s31 s32 s33]] [[t11 t12 t13] [t21 t22 t23] [t31 t32 t33]] [e h] [f k].
  unfold sym in e, f. cbn [row1 row2 row3 vx vy vz] in *. injection e as -> -> ->. injection f as -> -> ->.
  destruct h as [? [? [? [? [? ?]]]]]. destruct k as [? [? [? [? [? ?]]]]].
  unfold contains_sym, isym_sub, msub, vsub, sym. cbn [row1 row2 row3 vx vy vz i11 i22 i33 i12 i13 i23].
  conjuncts; first [reflexivity | apply sub_sound; assumption].
Qed.

Lemma minus_identity_sound : forall a c S x, contains_sym a S -> contains bits c x ->
  contains_sym (minus_identity a c) (msub S (mscale x midentity)).
Proof.
  intros a c [[s11 s12 s13] [s21 s22 s23] [s31 s32 s33]] x [e h] k.
  unfold sym in e. cbn [row1 row2 row3 vx vy vz] in *. injection e as -> -> ->.
  destruct h as [h1 [h2 [h3 [h4 [h5 h6]]]]].
  unfold contains_sym, minus_identity, msub, vsub, mscale, vscale, midentity, mdiag, sym.
  cbn [row1 row2 row3 vx vy vz i11 i22 i33 i12 i13 i23].
  split; [vec_split; ring |]. rewrite !Rmult_1_r, !Rmult_0_r, !Rminus_0_r.
  conjuncts; first [assumption | apply sub_sound; assumption].
Qed.

(** k2 I - A^T A *)
Definition gram_test (k2 : fixed) (a : imat) : isym :=
  let column f := IVec (f (irow1 a)) (f (irow2 a)) (f (irow3 a)) in
  let c1 := column ix in let c2 := column iy in let c3 := column iz in
  ISym (sub k2 (inorm2 c1)) (sub k2 (inorm2 c2)) (sub k2 (inorm2 c3))
       (neg (idot c1 c2)) (neg (idot c1 c3)) (neg (idot c2 c3)).

Lemma gram_test_sound : forall k2 a k A, contains bits k2 (k ^ 2) -> contains_mat a A ->
  contains_sym (gram_test k2 a) (upper_test k A).
Proof.
  intros k2 a k A hk [[h11 [h12 h13]] [[h21 [h22 h23]] [h31 [h32 h33]]]].
  assert (c1 : contains_vec (IVec (ix (irow1 a)) (ix (irow2 a)) (ix (irow3 a))) (col1 A)) by enclose.
  assert (c2 : contains_vec (IVec (iy (irow1 a)) (iy (irow2 a)) (iy (irow3 a))) (col2 A)) by enclose.
  assert (c3 : contains_vec (IVec (iz (irow1 a)) (iz (irow2 a)) (iz (irow3 a))) (col3 A)) by enclose.
  replace (upper_test k A) with
    (sym (k ^ 2 - norm2 (col1 A)) (- dot (col1 A) (col2 A)) (- dot (col1 A) (col3 A))
         (k ^ 2 - norm2 (col2 A)) (- dot (col2 A) (col3 A)) (k ^ 2 - norm2 (col3 A)))
    by (clear; unfold upper_test, sym; unfold_vec; vec_split; ring).
  unfold contains_sym, gram_test, sym. cbn zeta. cbn [row1 row2 row3 vx vy vz i11 i22 i33 i12 i13 i23].
  split; [reflexivity |].
  conjuncts; first [ apply sub_sound; [assumption | apply inorm2_sound; assumption]
                   | apply neg_sound, idot_sound; assumption ].
Qed.

(** ** Positive definiteness: Hertz's four vertices, leading minors *)

Definition minors (a b c x y z : Z) : bool :=
  if (0 <? a)%Z then
    let second := (a * b - x * x)%Z in
    if (0 <? second)%Z then (0 <? c * second - y * (b * y - x * z) - z * (a * z - x * y))%Z else false
  else false.

Definition definite (t : isym) : bool :=
  let a := lo (i11 t) in let b := lo (i22 t) in let c := lo (i33 t) in
  let x := lo (i12 t) in let y := lo (i13 t) in let z := lo (i23 t) in
  let x' := hi (i12 t) in let y' := hi (i13 t) in let z' := hi (i23 t) in
  minors a b c x y z && minors a b c x' y' z && minors a b c x' y z' && minors a b c x y' z'.

Lemma minors_sound : forall a b c x y z, minors a b c x y z = true ->
  positive_definite (sym (IZR a) (IZR x) (IZR y) (IZR b) (IZR z) (IZR c)).
Proof.
  intros a b c x y z h. unfold minors in h. destruct (0 <? a)%Z eqn:h1; [| discriminate].
  cbn zeta in h. destruct (0 <? a * b - x * x)%Z eqn:h2; [| discriminate].
  apply Z.ltb_lt, IZR_lt in h, h1, h2.
  apply leading_minors; [exact h1 | |]; unfold minor2, det, sym, cross, dot; cbn [row1 row2 row3 vx vy vz];
    [eapply Rlt_le_trans; [exact h2 |] | eapply Rlt_le_trans; [exact h |]]; apply Req_le;
    repeat (rewrite minus_IZR || rewrite mult_IZR); ring.
Qed.

Theorem definite_sound : forall t S, definite t = true -> contains_sym t S -> positive_definite S.
Proof.
  intros t S h [e [h1 [h2 [h3 [h4 [h5 h6]]]]]]. unfold definite in h. cbn zeta in h.
  apply andb_true_iff in h as [h v4]. apply andb_true_iff in h as [h v3]. apply andb_true_iff in h as [v1 v2].
  apply minors_sound in v1, v2, v3, v4. pose proof (unit_R_pos bits) as u. unfold contains in *.
  assert (P : positive_definite (mscale (unit_R bits) S)).
  { apply (hertz (IZR (lo (i11 t))) (IZR (lo (i22 t))) (IZR (lo (i33 t))) (IZR (lo (i12 t))) (IZR (hi (i12 t)))
             (IZR (lo (i13 t))) (IZR (hi (i13 t))) (IZR (lo (i23 t))) (IZR (hi (i23 t)))).
    - split; [exact v1 |]. split; [exact v2 |]. split; assumption.
    - rewrite e. eexists _, _, _, _, _, _. split.
      + unfold mscale, vscale, sym. cbn [row1 row2 row3 vx vy vz]. reflexivity.
      + rewrite !(Rmult_comm (unit_R bits)). lra. }
  intros v nz. specialize (P v nz).
  replace (quad (mscale (unit_R bits) S) v) with (unit_R bits * quad S v) in P
    by (unfold quad; rewrite mulv_mscale; generalize (mulv S v); clear; vec_ring).
  apply Rmult_lt_reg_l with (unit_R bits); lra.
Qed.
End Precision.
