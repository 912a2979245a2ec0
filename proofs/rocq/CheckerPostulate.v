(** * The checker for the postulate, for a range of psi or every psi at once

    A second proof of [q1q2_postulate]'s lower bound, by subdivision: the faces
    x = q_1 and x = q_2 suffice ([AllPsi.v]); on a face the form
    v^T M v - kappa |v|^2 has, in normalised coordinates, coefficients that can
    be enclosed for a whole range of kappa up to kappa = 1.  The rules are
    those of the certificates: [BlowUp] (vertices about the centre of a box),
    [EdgeRule] (vertices about the corner Q(kappa)), [Mirror].

    On a face, points are given by w_y, w_z in [0,1]: the distances from the
    corner, as parts of the edge.  With s0 = -1 on the face of q_1 and s0 = 1 on
    that of q_2, P / (s0 |q|) = (1, 1 - w_y span, 1 - w_z span). *)

From Coq Require Import ZArith Reals Lra Lia Psatz Bool List.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal CubeLower CubeUpper Scaling Postulate
  PositiveDefinite AllPsi WeightedCauchy Fixed Enclosure Claim Checker.
Local Open Scope R_scope.

(** ** The form on a face *)

Definition S_of (T a b : R) : R := sqrt (1 + T * (2 - a ^ 2 - b ^ 2)).

Definition g12 (T a b : R) : R := a / S_of T a b + 1 / S_of T 1 b.
Definition g13 (T a b : R) : R := b / S_of T a b + 1 / S_of T 1 a.
Definition g23 (T a b : R) : R := a / S_of T 1 a + b / S_of T 1 b.

Definition form (d o12 o13 o23 : R) (v : vec) : R := quad (sym d o12 o13 d o23 d) v.

Definition good (s0 d T a b : R) : Prop :=
  forall v, 0 <= form d (s0 * g12 T a b) (s0 * g13 T a b) (s0 * g23 T a b) v.

Lemma form_eq : forall d o12 o13 o23 x y z,
  form d o12 o13 o23 (Vec x y z) = d * (x ^ 2 + y ^ 2 + z ^ 2) + 2 * (o12 * (x * y) + o13 * (x * z) + o23 * (y * z)).
Proof. intros. unfold form, quad, sym. unfold_vec. ring. Qed.

(** ** Slopes *)

Lemma root_slope : forall S Sc e, 0 < S -> 0 < Sc -> Sc ^ 2 - S ^ 2 = e -> 1 / S - 1 / Sc = e / (S * Sc * (S + Sc)).
Proof. intros S Sc e h h' <-. field. lra. Qed.

Lemma S_square : forall T a b, 0 < S_of T a b -> S_of T a b ^ 2 = 1 + T * (2 - a ^ 2 - b ^ 2).
Proof.
  intros T a b p. unfold S_of in *. rewrite <- Rsqr_pow2. apply Rsqr_sqrt.
  destruct (Rle_dec 0 (1 + T * (2 - a ^ 2 - b ^ 2))) as [q | q]; [exact q |]. rewrite sqrt_neg_0 in p; lra.
Qed.

(** T / (S S_c (S + S_c)) *)
Definition curvature (T S Sc : R) : R := T * / (S * Sc * (S + Sc)).

Section Slopes.
Variables T a b ac bc : R.
Let S1 := S_of T a b. Let S1c := S_of T ac bc.
Let S2 := S_of T 1 b. Let S2c := S_of T 1 bc.
Let S3 := S_of T 1 a. Let S3c := S_of T 1 ac.
Let k1 := curvature T S1 S1c. Let k2 := curvature T S2 S2c. Let k3 := curvature T S3 S3c.
Hypothesis p1 : 0 < S1. Hypothesis p1c : 0 < S1c. Hypothesis p2 : 0 < S2.
Hypothesis p2c : 0 < S2c. Hypothesis p3 : 0 < S3. Hypothesis p3c : 0 < S3c.

Definition a12 := / S1 + ac * ((a + ac) * k1).
Definition a13 := bc * ((a + ac) * k1) + (a + ac) * k3.
Definition a23 := / S3 + ac * ((a + ac) * k3).
Definition b12 := ac * ((b + bc) * k1) + (b + bc) * k2.
Definition b13 := / S1 + bc * ((b + bc) * k1).
Definition b23 := / S2 + bc * ((b + bc) * k2).

Lemma face_slopes :
  g12 T a b = g12 T ac bc + ((a - ac) * a12 + (b - bc) * b12) /\
  g13 T a b = g13 T ac bc + ((a - ac) * a13 + (b - bc) * b13) /\
  g23 T a b = g23 T ac bc + ((a - ac) * a23 + (b - bc) * b23).
Proof.
  assert (R1 : 1 / S1 - 1 / S1c = ((a - ac) * (a + ac) + (b - bc) * (b + bc)) * k1).
  { unfold k1, curvature. rewrite <- Rmult_assoc. apply root_slope; [exact p1 | exact p1c |].
    unfold S1, S1c. rewrite !S_square by assumption. ring. }
  assert (R2 : 1 / S2 - 1 / S2c = (b - bc) * (b + bc) * k2).
  { unfold k2, curvature. rewrite <- Rmult_assoc. apply root_slope; [exact p2 | exact p2c |].
    unfold S2, S2c. rewrite !S_square by assumption. ring. }
  assert (R3 : 1 / S3 - 1 / S3c = (a - ac) * (a + ac) * k3).
  { unfold k3, curvature. rewrite <- Rmult_assoc. apply root_slope; [exact p3 | exact p3c |].
    unfold S3, S3c. rewrite !S_square by assumption. ring. }
  unfold g12, g13, g23, a12, a13, a23, b12, b13, b23. fold S1 S1c S2 S2c S3 S3c.
  unfold Rdiv in *. rewrite !Rmult_1_l in *. clearbody k1 k2 k3.
  replace (/ S1c) with (/ S1 - ((a - ac) * (a + ac) + (b - bc) * (b + bc)) * k1) by lra.
  replace (/ S2c) with (/ S2 - (b - bc) * (b + bc) * k2) by lra.
  replace (/ S3c) with (/ S3 - (a - ac) * (a + ac) * k3) by lra.
  repeat split; ring.
Qed.
End Slopes.

(** A function affine on a rectangle is nonnegative if it is at the vertices. *)
Lemma vertices_centre : forall q qa qb s t, -1 <= s <= 1 -> -1 <= t <= 1 ->
  0 <= q + qa + qb -> 0 <= q + qa - qb -> 0 <= q - qa + qb -> 0 <= q - qa - qb -> 0 <= q + s * qa + t * qb.
Proof.
  intros. assert (X : 0 <= q + s * qa + qb) by nra. assert (Y : 0 <= q + s * qa - qb) by nra. nra.
Qed.

Lemma vertices_corner : forall q qa qb s t, 0 <= s <= 1 -> 0 <= t <= 1 ->
  0 <= q -> 0 <= q + qa -> 0 <= q + qb -> 0 <= q + qa + qb -> 0 <= q + s * qa + t * qb.
Proof.
  intros. assert (X : 0 <= q + s * qa) by nra. assert (Y : 0 <= q + s * qa + qb) by nra. nra.
Qed.

Inductive face_rule := BlowUp | EdgeRule | Mirror.
Inductive face_tree :=
  | FaceLeaf (by_ : face_rule)
  | FaceSplit (along : axis_name) (first second : face_tree).   (* AlongX: kappa *)

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

(** Enclosures of 1/S_1, 1/S_2, 1/S_3 and the curvatures, from those of a, b (over the box) and a_c, b_c. *)
Record face_expansion := FaceExpansion {
  f12 : fixed; f13 : fixed; f23 : fixed;
  fa12 : fixed; fa13 : fixed; fa23 : fixed; fb12 : fixed; fb13 : fixed; fb23 : fixed }.

Definition iS (T a b : fixed) : option fixed :=
  root bits (add (integer bits 1) (mul bits T (sub (sub (integer bits 2) (sqr bits a)) (sqr bits b)))).

Lemma iS_sound : forall iT ia ib T a b x, contains iT T -> contains ia a -> contains ib b ->
  iS iT ia ib = Some x -> 0 < S_of T a b /\ contains x (S_of T a b).
Proof.
  intros iT ia ib T a b x hT ha hb h. apply (root_sound bits _ _ (1 + T * (2 - a ^ 2 - b ^ 2))) in h.
  - unfold S_of. tauto.
  - apply add_sound; [apply integer_sound |]. apply mul_sound; [exact hT |].
    apply sub_sound; [apply sub_sound; [apply integer_sound |] |]; apply sqr_sound; assumption.
Qed.

Definition icurvature (T S Sc : fixed) : option fixed :=
  match recip bits (mul bits (mul bits S Sc) (add S Sc)) with Some k => Some (mul bits T k) | None => None end.

Lemma icurvature_sound : forall iT iS iSc T S Sc x, contains iT T -> contains iS S -> contains iSc Sc ->
  icurvature iT iS iSc = Some x -> contains x (curvature T S Sc).
Proof.
  intros iT iS' iSc T S Sc x hT hS hSc h. unfold icurvature in h.
  destruct (recip bits (mul bits (mul bits iS' iSc) (add iS' iSc))) as [k |] eqn:e; [| discriminate].
  assert (E : mul bits iT k = x) by congruence. subst x. apply mul_sound; [exact hT |].
  apply (recip_sound bits _ _ _ e). apply mul_sound; [apply mul_sound | apply add_sound]; assumption.
Qed.

Definition expand_face (T a b ac bc : fixed) : option face_expansion :=
  match iS T a b, iS T ac bc, iS T (integer bits 1) b, iS T (integer bits 1) bc,
        iS T (integer bits 1) a, iS T (integer bits 1) ac with
  | Some s1, Some s1c, Some s2, Some s2c, Some s3, Some s3c =>
      match icurvature T s1 s1c, icurvature T s2 s2c, icurvature T s3 s3c,
            recip bits s1, recip bits s2, recip bits s3, recip bits s1c, recip bits s2c, recip bits s3c with
      | Some k1, Some k2, Some k3, Some r1, Some r2, Some r3, Some r1c, Some r2c, Some r3c =>
          let sa := add a ac in let sb := add b bc in
          Some (FaceExpansion
            (add (mul bits ac r1c) r2c) (add (mul bits bc r1c) r3c) (add (mul bits ac r3c) (mul bits bc r2c))
            (add r1 (mul bits ac (mul bits sa k1)))
            (add (mul bits bc (mul bits sa k1)) (mul bits sa k3))
            (add r3 (mul bits ac (mul bits sa k3)))
            (add (mul bits ac (mul bits sb k1)) (mul bits sb k2))
            (add r1 (mul bits bc (mul bits sb k1)))
            (add r2 (mul bits bc (mul bits sb k2))))
      | _, _, _, _, _, _, _, _, _ => None
      end
  | _, _, _, _, _, _ => None
  end.

Lemma expand_face_sound : forall iT ia ib iac ibc T a b ac bc x,
  contains iT T -> contains ia a -> contains ib b -> contains iac ac -> contains ibc bc ->
  expand_face iT ia ib iac ibc = Some x ->
  exists A12 A13 A23 B12 B13 B23,
    contains (f12 x) (g12 T ac bc) /\ contains (f13 x) (g13 T ac bc) /\ contains (f23 x) (g23 T ac bc) /\
    contains (fa12 x) A12 /\ contains (fa13 x) A13 /\ contains (fa23 x) A23 /\
    contains (fb12 x) B12 /\ contains (fb13 x) B13 /\ contains (fb23 x) B23 /\
    g12 T a b = g12 T ac bc + ((a - ac) * A12 + (b - bc) * B12) /\
    g13 T a b = g13 T ac bc + ((a - ac) * A13 + (b - bc) * B13) /\
    g23 T a b = g23 T ac bc + ((a - ac) * A23 + (b - bc) * B23).
Proof.
  intros iT ia ib iac ibc T a b ac bc x hT ha hb hac hbc h. unfold expand_face in h.
  pose proof (integer_sound bits 1) as one.
  destruct (iS iT ia ib) as [s1 |] eqn:e1; [| discriminate].
  destruct (iS iT iac ibc) as [s1c |] eqn:e1c; [| discriminate].
  destruct (iS iT (integer bits 1) ib) as [s2 |] eqn:e2; [| discriminate].
  destruct (iS iT (integer bits 1) ibc) as [s2c |] eqn:e2c; [| discriminate].
  destruct (iS iT (integer bits 1) ia) as [s3 |] eqn:e3; [| discriminate].
  destruct (iS iT (integer bits 1) iac) as [s3c |] eqn:e3c; [| discriminate].
  destruct (icurvature iT s1 s1c) as [k1 |] eqn:c1; [| discriminate].
  destruct (icurvature iT s2 s2c) as [k2 |] eqn:c2; [| discriminate].
  destruct (icurvature iT s3 s3c) as [k3 |] eqn:c3; [| discriminate].
  destruct (recip bits s1) as [r1 |] eqn:q1; [| discriminate].
  destruct (recip bits s2) as [r2 |] eqn:q2; [| discriminate].
  destruct (recip bits s3) as [r3 |] eqn:q3; [| discriminate].
  destruct (recip bits s1c) as [r1c |] eqn:q1c; [| discriminate].
  destruct (recip bits s2c) as [r2c |] eqn:q2c; [| discriminate].
  destruct (recip bits s3c) as [r3c |] eqn:q3c; [| discriminate].
  cbn zeta in h.
  destruct (iS_sound _ _ _ _ _ _ _ hT ha hb e1) as [p1 h1]. destruct (iS_sound _ _ _ _ _ _ _ hT hac hbc e1c) as [p1c h1c].
  destruct (iS_sound _ _ _ _ _ _ _ hT one hb e2) as [p2 h2]. destruct (iS_sound _ _ _ _ _ _ _ hT one hbc e2c) as [p2c h2c].
  destruct (iS_sound _ _ _ _ _ _ _ hT one ha e3) as [p3 h3]. destruct (iS_sound _ _ _ _ _ _ _ hT one hac e3c) as [p3c h3c].
  pose proof (icurvature_sound _ _ _ _ _ _ _ hT h1 h1c c1) as K1.
  pose proof (icurvature_sound _ _ _ _ _ _ _ hT h2 h2c c2) as K2.
  pose proof (icurvature_sound _ _ _ _ _ _ _ hT h3 h3c c3) as K3.
  destruct (recip_sound _ _ _ _ q1 h1) as [_ I1]. destruct (recip_sound _ _ _ _ q2 h2) as [_ I2].
  destruct (recip_sound _ _ _ _ q3 h3) as [_ I3]. destruct (recip_sound _ _ _ _ q1c h1c) as [_ I1c].
  destruct (recip_sound _ _ _ _ q2c h2c) as [_ I2c]. destruct (recip_sound _ _ _ _ q3c h3c) as [_ I3c].
  pose proof (face_slopes T a b ac bc p1 p1c p2 p2c p3 p3c) as F.
  exists (a12 T a b ac bc), (a13 T a b ac bc), (a23 T a ac), (b12 T a b ac bc), (b13 T a b ac bc), (b23 T b bc).
  injection h as <-. cbn [f12 f13 f23 fa12 fa13 fa23 fb12 fb13 fb23].
  unfold g12, g13, g23, a12, a13, a23, b12, b13, b23 in *. unfold Rdiv in *. rewrite !Rmult_1_l in *.
  conjuncts; try apply F;
    repeat first [assumption | apply add_sound | apply mul_sound].
Qed.

(** ** The vertex rules *)

(** The matrix at the vertex with signs (u, v). *)
Definition vertex (q2 : bool) (d ha hb : fixed) (o12 o13 o23 : fixed) (x : face_expansion) (u v : Z) : isym :=
  let off o fa fb := signed q2 (add (add o (times u (mul bits ha fa))) (times v (mul bits hb fb))) in
  ISym d d d (off o12 (fa12 x) (fb12 x)) (off o13 (fa13 x) (fb13 x)) (off o23 (fa23 x) (fb23 x)).

Definition sgn (q2 : bool) : R := if q2 then 1 else -1.

Lemma vertex_sound : forall q2 id iha ihb io12 io13 io23 x u v d ha hb o12 o13 o23 A12 A13 A23 B12 B13 B23,
  definite (vertex q2 id iha ihb io12 io13 io23 x u v) = true ->
  contains id d -> contains iha ha -> contains ihb hb ->
  contains io12 o12 -> contains io13 o13 -> contains io23 o23 ->
  contains (fa12 x) A12 -> contains (fa13 x) A13 -> contains (fa23 x) A23 ->
  contains (fb12 x) B12 -> contains (fb13 x) B13 -> contains (fb23 x) B23 ->
  forall y, 0 <= form d (sgn q2 * (o12 + IZR u * (ha * A12) + IZR v * (hb * B12)))
                        (sgn q2 * (o13 + IZR u * (ha * A13) + IZR v * (hb * B13)))
                        (sgn q2 * (o23 + IZR u * (ha * A23) + IZR v * (hb * B23))) y.
Proof.
  intros until B23. intros h hd hha hhb h12 h13 h23 a1 a2 a3 b1 b2 b3 y.
  apply (positive_definite_semidefinite (sym d _ _ d _ d)). apply (definite_sound bits _ _ h).
  unfold contains_sym, vertex, sym, sgn. cbn zeta. cbn [row1 row2 row3 vx vy vz i11 i22 i33 i12 i13 i23].
  conjuncts; first [ reflexivity | exact hd
    | apply signed_sound; repeat first [assumption | apply add_sound | apply times_sound | apply mul_sound] ].
Qed.

Definition centre_rule (q2 : bool) (d T span y z : fixed) : bool :=
  let one := integer bits 1 in
  let at_ w := sub one (mul bits w span) in
  let my := midpoint y in let mz := midpoint z in
  match expand_face T (at_ y) (at_ z) (at_ (dyadic my)) (at_ (dyadic mz)) with
  | Some x =>
      let ha := mul bits (dyadic (hi y - my)) span in let hb := mul bits (dyadic (hi z - mz)) span in
      let test u v := definite (vertex q2 d ha hb (f12 x) (f13 x) (f23 x) x u v) in
      test 1 1 && test 1 (-1) && test (-1) 1 && test (-1) (-1)
  | None => false
  end%Z.

Lemma good_affine : forall s0 d T a b o12 o13 o23 A12 A13 A23 B12 B13 B23 s t ha hb,
  g12 T a b = o12 + (s * ha * A12 + t * hb * B12) ->
  g13 T a b = o13 + (s * ha * A13 + t * hb * B13) ->
  g23 T a b = o23 + (s * ha * A23 + t * hb * B23) ->
  let F u v := form d (s0 * (o12 + u * (ha * A12) + v * (hb * B12)))
                      (s0 * (o13 + u * (ha * A13) + v * (hb * B13)))
                      (s0 * (o23 + u * (ha * A23) + v * (hb * B23))) in
  forall y, form d (s0 * g12 T a b) (s0 * g13 T a b) (s0 * g23 T a b) y
    = F 0 0 y + s * (F 1 0 y - F 0 0 y) + t * (F 0 1 y - F 0 0 y) /\
    forall u v, F u v y = F 0 0 y + u * (F 1 0 y - F 0 0 y) + v * (F 0 1 y - F 0 0 y).
Proof.
  intros until hb. intros -> -> -> F [x1 x2 x3]. unfold F. rewrite !form_eq. split; [ring |].
  intros. rewrite !form_eq. ring.
Qed.

Lemma centre_rule_sound : forall q2 id iT ispan y z d T span wy wz,
  centre_rule q2 id iT ispan y z = true -> contains id d -> contains iT T -> contains ispan span ->
  contains y wy -> contains z wz -> good (sgn q2) d T (1 - wy * span) (1 - wz * span).
Proof.
  intros q2 id iT ispan y z d T span wy wz h hd hT hs hy hz. unfold centre_rule in h. cbn zeta in h.
  set (my := midpoint y) in *. set (mz := midpoint z) in *.
  assert (A : forall w u, contains w u -> contains (sub (integer bits 1) (mul bits w ispan)) (1 - u * span))
    by (intros; apply sub_sound; [apply integer_sound | apply mul_sound; assumption]).
  destruct (expand_face iT _ _ _ _) as [x |] eqn:e; [| discriminate].
  destruct (expand_face_sound _ _ _ _ _ T _ _ _ _ _ hT (A _ _ hy) (A _ _ hz)
    (A _ _ (dyadic_sound bits my)) (A _ _ (dyadic_sound bits mz)) e)
    as [A12 [A13 [A23 [B12 [B13 [B23 [c1 [c2 [c3 [c4 [c5 [c6 [c7 [c8 [c9 [E1 [E2 E3]]]]]]]]]]]]]]]]].
  apply andb_true_iff in h as [h v4]. apply andb_true_iff in h as [h v3]. apply andb_true_iff in h as [v1 v2].
  destruct (half_sound bits y wy hy) as [s [bs es]]. destruct (half_sound bits z wz hz) as [t [bt et]].
  fold my in es. fold mz in et.
  set (hya := IZR (hi y - my) / unit_R bits) in *. set (hzb := IZR (hi z - mz) / unit_R bits) in *.
  assert (ha : contains (mul bits (dyadic (hi y - my)) ispan) (hya * span)) by (apply mul_sound; [apply dyadic_sound | exact hs]).
  assert (hb : contains (mul bits (dyadic (hi z - mz)) ispan) (hzb * span)) by (apply mul_sound; [apply dyadic_sound | exact hs]).
  assert (X : 1 - wy * span - (1 - IZR my / unit_R bits * span) = - s * (hya * span))
    by (replace wy with (IZR my / unit_R bits + hya * s) by lra; ring).
  assert (Y : 1 - wz * span - (1 - IZR mz / unit_R bits * span) = - t * (hzb * span))
    by (replace wz with (IZR mz / unit_R bits + hzb * t) by lra; ring).
  rewrite X, Y in E1, E2, E3. intro v.
  destruct (good_affine (sgn q2) d T _ _ _ _ _ A12 A13 A23 B12 B13 B23 (- s) (- t) (hya * span) (hzb * span) E1 E2 E3 v)
    as [G F]. cbv beta zeta in G, F. rewrite G.
  pose proof (vertex_sound _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ v1 hd ha hb c1 c2 c3 c4 c5 c6 c7 c8 c9 v) as V1.
  pose proof (vertex_sound _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ v2 hd ha hb c1 c2 c3 c4 c5 c6 c7 c8 c9 v) as V2.
  pose proof (vertex_sound _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ v3 hd ha hb c1 c2 c3 c4 c5 c6 c7 c8 c9 v) as V3.
  pose proof (vertex_sound _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ v4 hd ha hb c1 c2 c3 c4 c5 c6 c7 c8 c9 v) as V4.
  rewrite F in V1, V2, V3, V4. clear F G.
  apply vertices_centre; lra.
Qed.

Definition corner_rule (q2 : bool) (d T span y z : fixed) : bool :=
  let one := integer bits 1 in
  let at_ w := sub one (mul bits w span) in
  match expand_face T (at_ y) (at_ z) one one with
  | Some x =>
      let ha := neg (mul bits (dyadic (hi y)) span) in let hb := neg (mul bits (dyadic (hi z)) span) in
      let two := integer bits 2 in
      let test u v := definite (vertex q2 d ha hb two two two x u v) in
      (lo y =? 0) && (lo z =? 0) && test 1 0 && test 0 1 && test 1 1
  | None => false
  end%Z.

Lemma S_corner : forall T, S_of T 1 1 = 1.
Proof. intro T. unfold S_of. replace (1 + T * (2 - 1 ^ 2 - 1 ^ 2)) with 1 by ring. apply sqrt_1. Qed.

Lemma part_of : forall e w, lo e = 0%Z -> contains e w -> exists s, 0 <= s <= 1 /\ w = s * (IZR (hi e) / unit_R bits).
Proof.
  intros e w z [l h]. rewrite z in l. pose proof (unit_R_pos bits).
  destruct (Req_dec (IZR (hi e)) 0) as [h0 | n].
  - exists 0. split; [lra |]. rewrite h0 in *. assert (w * unit_R bits = 0) by lra.
    assert (w = 0) by (apply Rmult_eq_reg_r with (unit_R bits); lra). lra.
  - exists (w * unit_R bits / IZR (hi e)).
    assert (E : w * unit_R bits / IZR (hi e) * IZR (hi e) = w * unit_R bits) by (field; exact n).
    split; [split; apply Rmult_le_reg_r with (IZR (hi e)); lra | field; split; lra].
Qed.

Lemma corner_rule_sound : forall q2 id iT ispan y z d T span wy wz,
  corner_rule q2 id iT ispan y z = true -> contains id d -> contains iT T -> contains ispan span ->
  (if q2 then 2 <= d else 4 <= d) ->
  contains y wy -> contains z wz -> good (sgn q2) d T (1 - wy * span) (1 - wz * span).
Proof.
  intros q2 id iT ispan y z d T span wy wz h hd hT hs d0 hy hz. unfold corner_rule in h. cbn zeta in h.
  assert (A : forall w u, contains w u -> contains (sub (integer bits 1) (mul bits w ispan)) (1 - u * span))
    by (intros; apply sub_sound; [apply integer_sound | apply mul_sound; assumption]).
  pose proof (integer_sound bits 1) as one.
  destruct (expand_face iT _ _ _ _) as [x |] eqn:e; [| discriminate].
  destruct (expand_face_sound _ _ _ _ _ T _ _ _ _ _ hT (A _ _ hy) (A _ _ hz) one one e)
    as [A12 [A13 [A23 [B12 [B13 [B23 [_ [_ [_ [c4 [c5 [c6 [c7 [c8 [c9 [E1 [E2 E3]]]]]]]]]]]]]]]]].
  apply andb_true_iff in h as [h v3]. apply andb_true_iff in h as [h v2]. apply andb_true_iff in h as [h v1].
  apply andb_true_iff in h as [zy zz]. apply Z.eqb_eq in zy, zz.
  destruct (part_of y wy zy hy) as [s [bs es]]. destruct (part_of z wz zz hz) as [t [bt et]].
  set (hya := IZR (hi y) / unit_R bits) in *. set (hzb := IZR (hi z) / unit_R bits) in *.
  assert (ha : contains (neg (mul bits (dyadic (hi y)) ispan)) (- (hya * span)))
    by (apply neg_sound, mul_sound; [apply dyadic_sound | exact hs]).
  assert (hb : contains (neg (mul bits (dyadic (hi z)) ispan)) (- (hzb * span)))
    by (apply neg_sound, mul_sound; [apply dyadic_sound | exact hs]).
  assert (X : 1 - wy * span - 1 = s * - (hya * span)) by (rewrite es; ring).
  assert (Y : 1 - wz * span - 1 = t * - (hzb * span)) by (rewrite et; ring).
  rewrite X, Y in E1, E2, E3.
  assert (O : g12 T 1 1 = 2 /\ g13 T 1 1 = 2 /\ g23 T 1 1 = 2)
    by (unfold g12, g13, g23; rewrite S_corner; lra).
  destruct O as [O1 [O2 O3]]. rewrite O1 in E1. rewrite O2 in E2. rewrite O3 in E3.
  pose proof (integer_sound bits 2) as two. intro v.
  destruct (good_affine (sgn q2) d T _ _ _ _ _ A12 A13 A23 B12 B13 B23 s t _ _ E1 E2 E3 v)
    as [G F]. cbv beta zeta in G, F. rewrite G.
  pose proof (vertex_sound _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ v1 hd ha hb two two two c4 c5 c6 c7 c8 c9 v) as V1.
  pose proof (vertex_sound _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ v2 hd ha hb two two two c4 c5 c6 c7 c8 c9 v) as V2.
  pose proof (vertex_sound _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ v3 hd ha hb two two two c4 c5 c6 c7 c8 c9 v) as V3.
  rewrite F in V1, V2, V3.
  assert (V0 : 0 <= form d (sgn q2 * (2 + 0 * (- (hya * span) * A12) + 0 * (- (hzb * span) * B12)))
                      (sgn q2 * (2 + 0 * (- (hya * span) * A13) + 0 * (- (hzb * span) * B13)))
                      (sgn q2 * (2 + 0 * (- (hya * span) * A23) + 0 * (- (hzb * span) * B23))) v).
  { destruct v as [p q w]. rewrite form_eq, !Rmult_0_l, !Rplus_0_r. clear - d0.
    pose proof (pow2_ge_0 (p - q)). pose proof (pow2_ge_0 (p - w)). pose proof (pow2_ge_0 (q - w)).
    pose proof (pow2_ge_0 (p + q + w)). pose proof (pow2_ge_0 p). pose proof (pow2_ge_0 q). pose proof (pow2_ge_0 w).
    destruct q2; cbn [sgn].
    - assert (0 <= (d - 2) * (p ^ 2 + q ^ 2 + w ^ 2)) by (apply Rmult_le_pos; lra). lra.
    - assert (0 <= (d - 4) * (p ^ 2 + q ^ 2 + w ^ 2)) by (apply Rmult_le_pos; lra). lra. }
  clear F G. apply vertices_corner; lra.
Qed.

(** ** The constants of a face, for a range of kappa *)

Definition corner_t (q2 : bool) (kappa : R) : R := if q2 then t_2 kappa else t_1 kappa.
Definition corner_c (q2 : bool) (kappa : R) : R := position_of_entry (corner_t q2 kappa).
(** 2 (1 - kappa) / t *)
Definition diagonal_of (q2 : bool) (kappa : R) : R := 2 * (1 - kappa) / corner_t q2 kappa.
(** (q_2 - q_1) / |q| *)
Definition span_of (q2 : bool) (kappa : R) : R := 1 + corner_c (negb q2) kappa / corner_c q2 kappa.

(** kappa <= 1/2, or kappa >= 1/2. *)
Definition in_half (high : bool) (kappa : R) : Prop := if high then 1/2 <= kappa else kappa <= 1/2.

Definition constants (q2 high : bool) (kappa : fixed) : option (fixed * fixed * fixed) :=
  let n k := integer bits k in
  let delta := sub (n 1%Z) kappa in let d2 := sqr bits delta in let sum := add (n 2%Z) d2 in
  match recip bits sum with
  | Some over_sum =>
      let rest := if high then mul bits (mul bits (times 2 delta) (add (n 1%Z) kappa)) over_sum
                  else mul bits (ratio bits 3 2) over_sum in
      match root bits (sub (n 1%Z) rest) with
      | Some p =>
          match (if q2 then Some p else recip bits p),
                (if q2 then if high then match recip bits (times 4 (sqr bits kappa)) with
                                         | Some k => Some (mul bits d2 k) | None => None end
                            else Some d2
                 else Some (mul bits d2 (ratio bits 1 4)))
          with
          | Some r, Some T =>
              Some (if q2 then if high then times 4 kappa else n 2%Z else n 4%Z, T, add (n 1%Z) r)
          | _, _ => None
          end
      | None => None
      end
  | None => None
  end.

Lemma t_2_half : forall high kappa, 0 < kappa < 1 -> in_half high kappa ->
  t_2 kappa = if high then (1 - kappa) / (2 * kappa) else 1 - kappa.
Proof.
  intros [|] kappa k h; cbn [in_half] in h; unfold t_2; destruct (Rle_dec kappa (1/2)) as [l | l]; try lra.
  - replace kappa with (1/2) by lra. field.
  - field. lra.
Qed.

(** (q_1 / q_2)^2 *)
Lemma ratio_square : forall high kappa, 0 < kappa < 1 -> in_half high kappa ->
  (corner_c false kappa / corner_c true kappa) ^ 2
  = 1 - (if high then 2 * (1 - kappa) * (1 + kappa) * / (2 + (1 - kappa) ^ 2) else 3 / 2 * / (2 + (1 - kappa) ^ 2)).
Proof.
  intros high kappa k h. destruct (t_facts kappa k) as [T1 [T2 _]].
  assert (C1 : on_diagonal (corner_c false kappa) (t_1 kappa)) by (apply position_on_diagonal; lra).
  assert (C2 : on_diagonal (corner_c true kappa) (t_2 kappa)) by (apply position_on_diagonal; lra).
  destruct C1 as [p1 [_ e1]]. destruct C2 as [p2 [_ e2]].
  set (c1 := corner_c false kappa) in *. set (c2 := corner_c true kappa) in *. clearbody c1 c2.
  assert (n1 : 0 < 1 + 2 * t_1 kappa ^ 2) by nra. assert (n2 : 0 < 1 + 2 * t_2 kappa ^ 2) by nra.
  assert (E1 : c1 ^ 2 = t_1 kappa ^ 2 / (1 + 2 * t_1 kappa ^ 2)) by (apply Rmult_eq_reg_r with (1 + 2 * t_1 kappa ^ 2); [rewrite e1; field; lra | lra]).
  assert (E2 : c2 ^ 2 = t_2 kappa ^ 2 / (1 + 2 * t_2 kappa ^ 2)) by (apply Rmult_eq_reg_r with (1 + 2 * t_2 kappa ^ 2); [rewrite e2; field; lra | lra]).
  replace ((c1 / c2) ^ 2) with (c1 ^ 2 / c2 ^ 2) by (field; lra). rewrite E1, E2.
  rewrite (t_2_half high kappa k h) in *. unfold t_1 in *. clear E1 E2 e1 e2 T1 h.
  assert (0 < 2 + (1 - kappa) ^ 2) by nra.
  destruct high; field; repeat split; try nra; try lra.
Qed.

Lemma constants_sound : forall q2 high ik id iT ispan kappa,
  constants q2 high ik = Some (id, iT, ispan) -> contains ik kappa -> 0 < kappa < 1 -> in_half high kappa ->
  contains id (diagonal_of q2 kappa) /\ contains iT (corner_t q2 kappa ^ 2) /\ contains ispan (span_of q2 kappa).
Proof.
  intros q2 high ik id iT ispan kappa h hk k hh. unfold constants in h. cbn zeta in h.
  assert (D : contains (sub (integer bits 1) ik) (1 - kappa)) by (apply sub_sound; [apply integer_sound | exact hk]).
  pose proof (sqr_sound bits _ _ D) as D2.
  set (delta := sub (integer bits 1) ik) in *. set (d2 := sqr bits delta) in *.
  destruct (recip bits (add (integer bits 2) d2)) as [os |] eqn:e1; [| discriminate].
  destruct (recip_sound bits _ _ (2 + (1 - kappa) ^ 2) e1) as [_ O];
    [apply add_sound; [apply integer_sound | exact D2] |].
  destruct (root bits _) as [p |] eqn:e2; [| discriminate].
  destruct (if q2 then Some p else recip bits p) as [r |] eqn:e3; [| discriminate].
  destruct (if q2 then if high then match recip bits (times 4 (sqr bits ik)) with
      | Some k => Some (mul bits d2 k) | None => None end else Some d2 else Some (mul bits d2 (ratio bits 1 4)))
    as [T |] eqn:e4; [| discriminate].
  pose proof (ratio_square high kappa k hh) as RS. destruct (t_facts kappa k) as [T1 [T2 _]].
  assert (P1 : 0 < corner_c false kappa) by (apply (position_on_diagonal (t_1 kappa)); lra).
  assert (P2 : 0 < corner_c true kappa) by (apply (position_on_diagonal (t_2 kappa)); lra).
  assert (PP : 0 < corner_c false kappa / corner_c true kappa) by (apply Rdiv_lt_0_compat; assumption).
  assert (hp : contains p (corner_c false kappa / corner_c true kappa)).
  { rewrite <- (sqrt_pow2 (corner_c false kappa / corner_c true kappa)) by lra. rewrite RS.
    apply (root_sound bits _ _ _ e2). apply sub_sound; [apply integer_sound |].
    destruct high; (apply mul_sound; [| exact O]).
    - apply mul_sound; [apply times_sound; exact D | apply add_sound; [apply integer_sound | exact hk]].
    - apply ratio_sound. }
  assert (hr : contains r (corner_c (negb q2) kappa / corner_c q2 kappa)).
  { destruct q2; cbn [negb].
    - assert (p = r) by congruence. subst r. exact hp.
    - replace (corner_c true kappa / corner_c false kappa) with (/ (corner_c false kappa / corner_c true kappa))
        by (field; lra).
      apply (recip_sound bits _ _ _ e3 hp). }
  assert (hT : contains T (corner_t q2 kappa ^ 2)).
  { destruct q2; cbn [corner_t].
    - rewrite (t_2_half high kappa k hh). destruct high.
      + destruct (recip bits (times 4 (sqr bits ik))) as [k' |] eqn:e5; [| discriminate].
        assert (E : mul bits d2 k' = T) by congruence. subst T.
        replace (((1 - kappa) / (2 * kappa)) ^ 2) with ((1 - kappa) ^ 2 * / (4 * kappa ^ 2)) by (field; lra).
        apply mul_sound; [exact D2 |]. apply (recip_sound bits _ _ _ e5). apply times_sound, sqr_sound; exact hk.
      + assert (d2 = T) by congruence. subst T. exact D2.
    - assert (E : mul bits d2 (ratio bits 1 4) = T) by congruence. subst T. unfold t_1.
      replace (((1 - kappa) / 2) ^ 2) with ((1 - kappa) ^ 2 * (1 / 4)) by field.
      apply mul_sound; [exact D2 | apply ratio_sound]. }
  assert (E : (if q2 then if high then times 4 ik else integer bits 2 else integer bits 4, T, add (integer bits 1) r)
    = (id, iT, ispan)) by congruence.
  clear h. injection E as <- <- <-. split; [| split].
  - unfold diagonal_of. destruct q2; cbn [corner_t].
    + rewrite (t_2_half high kappa k hh). destruct high.
      * replace (2 * (1 - kappa) / ((1 - kappa) / (2 * kappa))) with (4 * kappa) by (field; lra).
        apply times_sound; exact hk.
      * replace (2 * (1 - kappa) / (1 - kappa)) with 2 by (field; lra). apply integer_sound.
    + unfold t_1. replace (2 * (1 - kappa) / ((1 - kappa) / 2)) with 4 by (field; lra). apply integer_sound.
  - exact hT.
  - unfold span_of. apply add_sound; [apply integer_sound | exact hr].
Qed.

Lemma diagonal_enough : forall (q2 high : bool) kappa, 0 < kappa < 1 -> in_half high kappa ->
  if q2 then 2 <= diagonal_of q2 kappa else 4 <= diagonal_of q2 kappa.
Proof.
  intros q2 high kappa k hh. unfold diagonal_of. destruct q2; cbn [corner_t].
  - rewrite (t_2_half high kappa k hh). destruct high; cbn [in_half] in hh.
    + replace (2 * (1 - kappa) / ((1 - kappa) / (2 * kappa))) with (4 * kappa) by (field; lra). lra.
    + replace (2 * (1 - kappa) / (1 - kappa)) with 2 by (field; lra). lra.
  - unfold t_1. replace (2 * (1 - kappa) / ((1 - kappa) / 2)) with 4 by (field; lra). lra.
Qed.

(** ** The tree of a face

    Points with w_y <= w_z are followed; the others are their mirror images.
    At a split of y the midpoint goes to the first half, at a split of z to the
    second: so a followed point never ends in a box with w_y >= w_z throughout,
    and such a box needs no proof ([Mirror]). *)

Definition in_y (e : fixed) (u : R) : Prop := contains e u /\ (lo e = 0%Z \/ IZR (lo e) < u * unit_R bits).
Definition in_z (e : fixed) (u : R) : Prop := contains e u /\ (hi e = unit_Z bits \/ u * unit_R bits < IZR (hi e)).

Definition run_rule (q2 high : bool) (by_ : face_rule) (kappa y z : fixed) : bool :=
  match by_ with
  | Mirror => (hi z <=? lo y)%Z
  | BlowUp => match constants q2 high kappa with
              | Some (d, T, span) => centre_rule q2 d T span y z | None => false end
  | EdgeRule => match constants q2 high kappa with
                | Some (d, T, span) => corner_rule q2 d T span y z | None => false end
  end.

Fixpoint run_face (q2 high : bool) (t : face_tree) (kappa y z : fixed) : bool :=
  match t with
  | FaceLeaf by_ => run_rule q2 high by_ kappa y z
  | FaceSplit AlongX t1 t2 =>
      run_face q2 high t1 (first_half kappa) y z && run_face q2 high t2 (second_half kappa) y z
  | FaceSplit AlongY t1 t2 =>
      run_face q2 high t1 kappa (first_half y) z && run_face q2 high t2 kappa (second_half y) z
  | FaceSplit AlongZ t1 t2 =>
      run_face q2 high t1 kappa y (first_half z) && run_face q2 high t2 kappa y (second_half z)
  end.

Theorem run_face_sound : forall q2 high t ik y z kappa wy wz,
  run_face q2 high t ik y z = true -> 0 < kappa < 1 -> in_half high kappa -> contains ik kappa ->
  in_y y wy -> in_z z wz -> 0 <= wy <= 1 -> 0 <= wz <= 1 -> wy <= wz ->
  good (sgn q2) (diagonal_of q2 kappa) (corner_t q2 kappa ^ 2)
    (1 - wy * span_of q2 kappa) (1 - wz * span_of q2 kappa).
Proof.
  intros q2 high t. induction t as [by_ | k t1 h1 t2 h2]; intros ik y z kappa wy wz h k0 hh hk hy hz by' bz le; cbn [run_face] in h.
  - destruct by_; cbn [run_rule] in h.
    + destruct (constants q2 high ik) as [[[d T] span] |] eqn:e; [| discriminate].
      destruct (constants_sound _ _ _ _ _ _ _ e hk k0 hh) as [c1 [c2 c3]].
      eapply centre_rule_sound; try eassumption; [apply hy | apply hz].
    + destruct (constants q2 high ik) as [[[d T] span] |] eqn:e; [| discriminate].
      destruct (constants_sound _ _ _ _ _ _ _ e hk k0 hh) as [c1 [c2 c3]].
      eapply corner_rule_sound; try eassumption; [eapply diagonal_enough; eassumption | apply hy | apply hz].
    + exfalso. apply Z.leb_le in h. pose proof (unit_R_pos bits) as u. destruct hy as [hy [y0 | y0]], hz as [hz [z1 | z1]].
      * rewrite y0, z1 in h. pose proof (unit_Z_pos bits). lia.
      * rewrite y0 in h. apply IZR_le in h. assert (0 <= wz * unit_R bits) by (apply Rmult_le_pos; lra). lra.
      * rewrite z1 in h. apply IZR_le in h. fold (unit_R bits) in h.
        assert (wy * unit_R bits <= 1 * unit_R bits) by (apply Rmult_le_compat_r; lra). lra.
      * apply IZR_le in h. assert (wy * unit_R bits <= wz * unit_R bits) by (apply Rmult_le_compat_r; lra). lra.
  - destruct k; apply andb_true_iff in h as [g1 g2].
    + destruct (Rle_dec (kappa * unit_R bits) (IZR (midpoint ik))) as [c | c].
      * apply (h1 _ _ _ _ _ _ g1); auto. split; [apply hk | exact c].
      * apply (h2 _ _ _ _ _ _ g2); auto. split; [apply Rlt_le, Rnot_le_lt, c | apply hk].
    + destruct hy as [[l r] o]. destruct (Rle_dec (wy * unit_R bits) (IZR (midpoint y))) as [c | c].
      * apply (h1 _ _ _ _ _ _ g1); auto. split; [split; assumption | exact o].
      * apply (h2 _ _ _ _ _ _ g2); auto. split; [split; [apply Rlt_le, Rnot_le_lt, c | exact r] | right; apply Rnot_le_lt, c].
    + destruct hz as [[l r] o]. destruct (Rlt_dec (wz * unit_R bits) (IZR (midpoint z))) as [c | c].
      * apply (h1 _ _ _ _ _ _ g1); auto. split; [split; [exact l | apply Rlt_le, c] | right; exact c].
      * apply (h2 _ _ _ _ _ _ g2); auto. split; [split; [apply Rnot_lt_le, c | exact r] | exact o].
Qed.

Definition half_unit : Z := 2 ^ (Zpos bits - 1).
Definition from_half : fixed := Fixed half_unit (unit_Z bits).
Definition unit_edge : fixed := Fixed 0 (unit_Z bits).

(** The trees of a face: for kappa up to and from 1/2; where kappa >= 1/2 throughout, one. *)
Inductive halves :=
  | Both (low high : face_tree)
  | HighOnly (high : face_tree).

(** A face, for kappa from least / 2^bits. *)
Definition check_face (least : Z) (q2 : bool) (trees : halves) : bool :=
  match trees with
  | Both low high =>
      run_face q2 false low (Fixed least half_unit) unit_edge unit_edge
      && run_face q2 true high from_half unit_edge unit_edge
  | HighOnly high =>
      (half_unit <=? least)%Z && run_face q2 true high (Fixed least (unit_Z bits)) unit_edge unit_edge
  end.

(** Both faces. *)
Definition check_from (least : Z) (q1 q2 : halves) : bool := check_face least false q1 && check_face least true q2.

(** Every psi > 1: the faces of q_1 and of q_2, kappa up to and from 1/2. *)
Definition check_postulate (t1 t2 t3 t4 : face_tree) : bool := check_from 0 (Both t1 t2) (Both t3 t4).

(** Every psi from 1 to a greatest one, which is more than 1. *)
Definition check_postulate_up_to (greatest : number) (q1 q2 : halves) : bool :=
  match inverse bits greatest with
  | Some k => (hi k <? unit_Z bits)%Z && check_from (lo k) q1 q2
  | None => false
  end.

Lemma half_unit_value : IZR half_unit = unit_R bits / 2.
Proof.
  unfold half_unit, unit_R, unit_Z. replace (2 ^ Z.pos bits)%Z with (2 * 2 ^ (Z.pos bits - 1))%Z.
  - rewrite mult_IZR. field.
  - rewrite <- Z.pow_succ_r by lia. f_equal. lia.
Qed.

Lemma good_mirror : forall s0 d T a b, good s0 d T a b -> good s0 d T b a.
Proof.
  intros s0 d T a b h [x y z]. specialize (h (Vec x z y)). rewrite form_eq in *.
  assert (S : S_of T b a = S_of T a b) by (unfold S_of; f_equal; ring).
  unfold g12, g13, g23 in *. rewrite S. lra.
Qed.

Lemma check_face_sound : forall least q2 trees kappa wy wz, check_face least q2 trees = true ->
  IZR least <= kappa * unit_R bits -> 0 < kappa < 1 -> 0 <= wy <= 1 -> 0 <= wz <= 1 ->
  good (sgn q2) (diagonal_of q2 kappa) (corner_t q2 kappa ^ 2)
    (1 - wy * span_of q2 kappa) (1 - wz * span_of q2 kappa).
Proof.
  intros least q2 trees kappa wy wz h l k by' bz. pose proof (unit_R_pos bits) as u. pose proof half_unit_value as H.
  assert (Y : forall w, 0 <= w <= 1 -> in_y unit_edge w /\ in_z unit_edge w).
  { intros w b. assert (contains unit_edge w) by (split; cbn [unit_edge lo hi]; fold (unit_R bits); nra).
    split; (split; [assumption | left; reflexivity]). }
  assert (G : forall high t ik, run_face q2 high t ik unit_edge unit_edge = true -> contains ik kappa -> in_half high kappa ->
    good (sgn q2) (diagonal_of q2 kappa) (corner_t q2 kappa ^ 2)
      (1 - wy * span_of q2 kappa) (1 - wz * span_of q2 kappa)).
  { intros high t ik r hk hh. destruct (Rle_dec wy wz) as [c | c].
    - apply (run_face_sound q2 high t ik unit_edge unit_edge); auto; apply Y; assumption.
    - apply good_mirror. apply (run_face_sound q2 high t ik unit_edge unit_edge); auto; try lra; apply Y; assumption. }
  assert (U : kappa * unit_R bits <= unit_R bits) by nra.
  destruct trees as [low high | high]; cbn [check_face] in h; apply andb_true_iff in h as [h1 h2].
  - destruct (Rle_dec kappa (1 / 2)) as [c | c].
    + apply (G false low _ h1); [| exact c]. split; cbn [lo hi]; [exact l |]. rewrite H. nra.
    + apply (G true high _ h2); [| cbn [in_half]; lra]. split; cbn [from_half lo hi]; [| exact U]. rewrite H. nra.
  - apply Z.leb_le, IZR_le in h1. rewrite H in h1.
    apply (G true high _ h2); [split; [exact l | exact U] |]. cbn [in_half]. nra.
Qed.
End Precision.

(** ** From the form to the machine *)

Lemma s_unit_corner : forall s0 t a b, s0 ^ 2 = 1 -> 0 < t ->
  s_unit (s0 * position_of_entry t * a) (s0 * position_of_entry t * b) = S_of (t ^ 2) a b / sqrt (1 + 2 * t ^ 2).
Proof.
  intros s0 t a b hs ht. destruct (position_on_diagonal t ht) as [_ [_ e]]. set (c := position_of_entry t) in *.
  assert (n : 0 < 1 + 2 * t ^ 2) by nra. unfold s_unit, S_of. rewrite <- sqrt_div_alt by exact n. f_equal.
  assert (E : c ^ 2 = t ^ 2 / (1 + 2 * t ^ 2)).
  { apply Rmult_eq_reg_r with (1 + 2 * t ^ 2); [rewrite e; field; lra | lra]. }
  rewrite !Rpow_mult_distr, hs, E. field. lra.
Qed.

Lemma entry_corner : forall s0 t a S, 0 < t ->
  s0 * position_of_entry t * a / (S / sqrt (1 + 2 * t ^ 2)) = s0 * t * (a * / S).
Proof.
  intros s0 t a S ht. unfold position_of_entry. assert (n : 0 < sqrt (1 + 2 * t ^ 2)) by (apply sqrt_lt_R0; nra).
  set (N := sqrt (1 + 2 * t ^ 2)) in *. unfold Rdiv. rewrite Rinv_mult, Rinv_inv.
  generalize (/ S). intro i. field. lra.
Qed.

Lemma good_lower_form : forall (q2 : bool) kappa a b, 0 < kappa < 1 ->
  good (sgn q2) (diagonal_of q2 kappa) (corner_t q2 kappa ^ 2) a b ->
  let c := sgn q2 * corner_c q2 kappa in lower_form_at kappa (Vec (c * 1) (c * a) (c * b)).
Proof.
  intros q2 kappa a b k h c [x y z]. destruct (t_facts kappa k) as [T1 [T2 _]].
  assert (t0 : 0 < corner_t q2 kappa) by (destruct q2; cbn [corner_t]; lra).
  assert (hs : sgn q2 ^ 2 = 1) by (destruct q2; cbn [sgn]; ring).
  specialize (h (Vec x y z)). rewrite form_eq in h. unfold diagonal_of in h. unfold c, corner_c.
  set (t := corner_t q2 kappa) in *. set (s0 := sgn q2) in *. clearbody t s0. clear c T1 T2.
  unfold M, mulv, dot, norm2. cbn [vx vy vz row1 row2 row3].
  rewrite !s_unit_corner by assumption. rewrite !entry_corner by assumption.
  unfold g12, g13, g23, Rdiv in h.
  generalize dependent (/ S_of (t ^ 2) a b). generalize dependent (/ S_of (t ^ 2) 1 b).
  generalize dependent (/ S_of (t ^ 2) 1 a). intros i3 i2 i1 h.
  apply Rmult_le_compat_l with (r := t / 2) in h; [| lra]. rewrite Rmult_0_r in h.
  match type of h with 0 <= ?e => assert (E : e = (1 - kappa) * (x ^ 2 + y ^ 2 + z ^ 2)
    + s0 * t * ((a * i1 + 1 * i2) * (x * y) + (b * i1 + 1 * i3) * (x * z) + (a * i3 + b * i2) * (y * z)))
    by (field; lra) end.
  rewrite E in h. lra.
Qed.

(** Every coordinate of the cube, from the corner of the face. *)
Lemma edge_part : forall s0 c c' y, s0 = 1 \/ s0 = -1 -> 0 < c -> 0 < c' -> - c' <= s0 * y <= c ->
  exists w, 0 <= w <= 1 /\ y = s0 * c * (1 - w * (1 + c' / c)).
Proof.
  intros s0 c c' y hs hc hc' b. exists ((c - s0 * y) / (c + c')).
  assert (E : (c - s0 * y) / (c + c') * (c + c') = c - s0 * y) by (field; lra).
  split; [split; apply Rmult_le_reg_r with (c + c'); lra |].
  destruct hs as [-> | ->]; field; lra.
Qed.

(** Faces checked for kappa from least / 2^bits prove the postulate for every psi with 1/psi in that range. *)
Lemma check_from_sound : forall bits least q1 q2, check_from bits least q1 q2 = true ->
  forall L a e, 0 < L -> forall psi, 1 < psi -> IZR least <= 1 / psi * unit_R bits -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros bits least q1 q2 h L a e hL psi hpsi from P hP. pose proof (unit_R_pos bits) as u.
  apply andb_true_iff in h as [h1 h2].
  destruct (kappa_range psi hpsi) as [k _].
  assert (reach : reachable_unit (vscale (/ L) P)) by (eapply cube_reachable; eassumption).
  apply transmission_from_M; [exact hL | exact hpsi | exact reach | |].
  - apply symmetric_part_identity; [lra |].
    assert (box : in_W (1 / psi) (vscale (/ L) P)) by (apply (cube_scaled L hL psi); exact hP).
    generalize dependent (vscale (/ L) P). intros p _ box.
    apply (two_faces_suffice (1 / psi) k); [| exact box]. clear p box.
    intros kappa [x y z] b [hx [hy hz]] face. cbn [vx vy vz] in *.
    assert (k' : 0 < kappa < 1) by lra. destruct (t_facts kappa k') as [T1 [T2 _]].
    assert (P1 : 0 < corner_c false kappa) by (apply (position_on_diagonal (t_1 kappa)); lra).
    assert (P2 : 0 < corner_c true kappa) by (apply (position_on_diagonal (t_2 kappa)); lra).
    unfold q1_unit, q2_unit in *. fold (corner_c false kappa) in *. fold (corner_c true kappa) in *.
    change (position_of_entry (t_1 kappa)) with (corner_c false kappa) in *.
    change (position_of_entry (t_2 kappa)) with (corner_c true kappa) in *.
    assert (G : forall q2 wy wz, 0 <= wy <= 1 -> 0 <= wz <= 1 ->
      good (sgn q2) (diagonal_of q2 kappa) (corner_t q2 kappa ^ 2)
        (1 - wy * span_of q2 kappa) (1 - wz * span_of q2 kappa)).
    { assert (l : IZR least <= kappa * unit_R bits)
        by (apply Rle_trans with (1 := from), Rmult_le_compat_r; lra).
      intros [|] wy wz by' bz; eapply check_face_sound; eassumption. }
    destruct face as [fx | fx].
    + destruct (edge_part (-1) (corner_c false kappa) (corner_c true kappa) y ltac:(auto) P1 P2 ltac:(lra)) as [wy [by' ey]].
      destruct (edge_part (-1) (corner_c false kappa) (corner_c true kappa) z ltac:(auto) P1 P2 ltac:(lra)) as [wz [bz ez]].
      pose proof (good_lower_form false kappa _ _ k' (G false wy wz by' bz)) as F. cbn zeta in F.
      unfold span_of in F. cbn [sgn negb] in F. rewrite <- ey, <- ez in F.
      replace (-1 * corner_c false kappa * 1) with x in F by lra. exact F.
    + destruct (edge_part 1 (corner_c true kappa) (corner_c false kappa) y ltac:(auto) P2 P1 ltac:(lra)) as [wy [by' ey]].
      destruct (edge_part 1 (corner_c true kappa) (corner_c false kappa) z ltac:(auto) P2 P1 ltac:(lra)) as [wz [bz ez]].
      pose proof (good_lower_form true kappa _ _ k' (G true wy wz by' bz)) as F. cbn zeta in F.
      unfold span_of in F. cbn [sgn negb] in F. rewrite <- ey, <- ez in F.
      replace (1 * corner_c true kappa * 1) with x in F by lra. exact F.
  - destruct (t_facts _ k) as [T1 [T2 _]].
    apply sigma_at_most_weaken with (1 + 2 * t_2 (1 / psi)).
    + pose proof (sum_below_psi psi hpsi). lra.
    + apply (cube_upper (position_of_entry (t_2 (1 / psi)))); [apply position_on_diagonal; lra |].
      apply (cube_inside L hL psi hpsi). exact hP.
Qed.

(** A certificate by faces proves the postulate, for every psi > 1. *)
Theorem check_postulate_sound : forall bits t1 t2 t3 t4, check_postulate bits t1 t2 t3 t4 = true ->
  forall L a e, 0 < L -> forall psi, 1 < psi -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros bits t1 t2 t3 t4 h L a e hL psi hpsi. apply (check_from_sound bits _ _ _ h); [exact hL | exact hpsi |].
  pose proof (unit_R_pos bits). destruct (kappa_range psi hpsi). apply Rmult_le_pos; lra.
Qed.

Lemma greatest_checked : forall bits greatest q1 q2, check_postulate_up_to bits greatest q1 q2 = true ->
  1 < value greatest /\ exists least, IZR least <= 1 / value greatest * unit_R bits /\ check_from bits least q1 q2 = true.
Proof.
  intros bits greatest q1 q2 h. unfold check_postulate_up_to in h. pose proof (unit_R_pos bits) as u.
  destruct (inverse bits greatest) as [k |] eqn:e; [| discriminate].
  apply andb_true_iff in h as [h1 h2]. apply Z.ltb_lt, IZR_lt in h1. fold (unit_R bits) in h1.
  destruct (inverse_sound bits _ _ e) as [i [l r]]. set (g := value greatest) in *.
  assert (i1 : 1 / g < 1) by (apply Rmult_lt_reg_r with (unit_R bits); lra).
  assert (g0 : 0 < g) by (rewrite <- (Rinv_inv g); apply Rinv_0_lt_compat; lra).
  split; [| exists (lo k); split; assumption].
  apply Rmult_lt_reg_l with (1 / g); [exact i |]. replace (1 / g * g) with 1 by (field; lra). lra.
Qed.

(** The greatest psi is an admissible one. *)
Lemma check_postulate_greatest : forall bits greatest q1 q2, check_postulate_up_to bits greatest q1 q2 = true ->
  1 < value greatest.
Proof. intros bits greatest q1 q2 h. apply (greatest_checked _ _ _ _ h). Qed.

(** The same for every psi up to a greatest one: smaller cubes need only the faces with kappa >= 1 / psi. *)
Theorem check_postulate_up_to_sound : forall bits greatest q1 q2, check_postulate_up_to bits greatest q1 q2 = true ->
  forall L a e, 0 < L -> forall psi, 1 < psi <= value greatest -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros bits greatest q1 q2 h L a e hL psi [hpsi le]. destruct (greatest_checked _ _ _ _ h) as [g [least [l c]]].
  apply (check_from_sound bits _ _ _ c); [exact hL | exact hpsi |]. apply Rle_trans with (1 := l).
  apply Rmult_le_compat_r; [apply Rlt_le, unit_R_pos |]. unfold Rdiv. rewrite !Rmult_1_l.
  apply Rinv_le_contravar; lra.
Qed.
