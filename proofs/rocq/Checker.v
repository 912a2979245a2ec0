(** * The checker for machines, and its soundness

    [check claim bits tree] is a boolean computed with integers alone.
    [check_sound]: where it is true, the claim holds.  The rules are those of
    FORMAT.md: [lower] (evidence: a quaternion and a sign) and [upper], the two
    vertex rules. *)

From Coq Require Import ZArith Reals Lra Lia Psatz Bool List.
From Orthocert Require Import Vec3 SingularValues Kinematics PositiveDefinite Rules Slopes Fixed Enclosure Claim.
From Orthocert.kernel Require Number.
Import ListNotations.
Local Open Scope R_scope.

Inductive axis_name := AlongX | AlongY | AlongZ.

(** A rule, with its evidence. *)
Inductive step :=
  | Lower (a b c d : Z) (positive_sign : bool)
  | Upper.

(** A bisection tree: what holds on a box holds on its halves. *)
Inductive tree :=
  | Leaf (by_ : list step)
  | Split (by_ : list step) (along : axis_name) (lower upper : tree).

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation contains_vec := (contains_vec bits).
Local Notation contains_mat := (contains_mat bits).

(** ** Numbers and parameters *)

Local Notation enclose := (Number.enclose bits).
Local Notation enclose_sound := (Number.enclose_sound bits).

Definition enclose_tolerance (t : tolerance) : option fixed :=
  match enclose (least t), enclose (greatest t) with Some a, Some b => Some (hull a b) | _, _ => None end.

Lemma enclose_tolerance_sound : forall t a x, enclose_tolerance t = Some a -> within t x -> contains a x.
Proof.
  intros t a x h w. unfold enclose_tolerance in h.
  destruct (enclose (least t)) as [b |] eqn:e1; [| discriminate].
  destruct (enclose (greatest t)) as [c |] eqn:e2; [| discriminate].
  assert (e : hull b c = a) by congruence. subst a. apply enclose_sound in e1, e2.
  apply (hull_sound bits b c _ _ x e1 e2). exact w.
Qed.

Definition vector_of (f : tolerance -> option fixed) (t : tolerances) : option ivec :=
  match f (tx t), f (ty t), f (tz t) with Some a, Some b, Some c => Some (IVec a b c) | _, _, _ => None end.

Lemma vector_of_sound : forall (f : tolerance -> option fixed) t a (u : vec),
  vector_of f t = Some a ->
  (forall b, f (tx t) = Some b -> contains b (vx u)) -> (forall b, f (ty t) = Some b -> contains b (vy u)) ->
  (forall b, f (tz t) = Some b -> contains b (vz u)) -> contains_vec a u.
Proof.
  intros f t a u h h1 h2 h3. unfold vector_of in h.
  destruct (f (tx t)) as [p |]; [| discriminate]. destruct (f (ty t)) as [q |]; [| discriminate].
  destruct (f (tz t)) as [s |]; [| discriminate]. injection h as <-.
  split; [| split]; [apply h1 | apply h2 | apply h3]; reflexivity.
Qed.

Lemma enclose_all_sound : forall t a v, vector_of enclose_tolerance t = Some a -> all_within t v -> contains_vec a v.
Proof.
  intros t a v h [h1 [h2 h3]]. apply (vector_of_sound _ _ _ _ h); intros b e;
    eapply enclose_tolerance_sound; eassumption.
Qed.

(** ** Legs *)

Record ileg := ILeg {
  in_axis : ivec;              (* n *)
  in_projection : imat;        (* I - n n^T *)
  in_length2 : fixed;          (* L^2 *)
  in_mode : bool;
  in_origin : ivec             (* w at the least corner of the workspace *)
}.

Definition contains_leg (a : ileg) (P0 : vec) (l : leg) : Prop :=
  well_formed l /\
  contains_vec (in_axis a) (axis l) /\ contains_mat (in_projection a) (projection (axis l)) /\
  contains (in_length2 a) (leg_length l ^ 2) /\ working_mode l = (if in_mode a then 1 else -1) /\
  contains_vec (in_origin a) (w l P0).

(** [corner]: the least corner of the workspace. *)
Definition enclose_leg (corner : ivec) (c : slider) : option ileg :=
  match vector_of enclose_tolerance (direction c), vector_of enclose_tolerance (anchor c),
        vector_of enclose_tolerance (platform c), enclose_tolerance (length c) with
  | Some d, Some a, Some p, Some len =>
      if (0 <? lo len)%Z then
        match root bits (inorm2 bits d) with
        | Some norm =>
            match recip bits norm with
            | Some inverse =>
                let n := iscale bits inverse d in
                Some (ILeg n (iprojection bits n) (sqr bits len) (mode c) (isub (iadd corner p) a))
            | None => None
            end
        | None => None
        end
      else None
  | _, _, _, _ => None
  end.

Lemma enclose_leg_sound : forall corner P0 c a l, contains_vec corner P0 ->
  enclose_leg corner c = Some a -> is_leg c l -> contains_leg a P0 l.
Proof.
  intros corner P0 c a l h0 h [[d [hd ax]] [ha [hp [hl hm]]]]. unfold enclose_leg in h.
  destruct (vector_of enclose_tolerance (direction c)) as [id |] eqn:e1; [| discriminate].
  destruct (vector_of enclose_tolerance (anchor c)) as [ia |] eqn:e2; [| discriminate].
  destruct (vector_of enclose_tolerance (platform c)) as [ip |] eqn:e3; [| discriminate].
  destruct (enclose_tolerance (length c)) as [il |] eqn:e4; [| discriminate].
  destruct (0 <? lo il)%Z eqn:pos; [| discriminate].
  destruct (root bits (inorm2 bits id)) as [nm |] eqn:e5; [| discriminate].
  destruct (recip bits nm) as [iv |] eqn:e6; [| discriminate].
  injection h as <-. apply Z.ltb_lt in pos.
  apply (enclose_all_sound _ _ _ e1) in hd. apply (enclose_all_sound _ _ _ e2) in ha.
  apply (enclose_all_sound _ _ _ e3) in hp. apply (enclose_tolerance_sound _ _ _ e4) in hl.
  destruct (root_sound _ _ _ _ e5 (inorm2_sound _ _ _ hd)) as [n0 [s0 hn]].
  destruct (recip_sound _ _ _ _ e6 hn) as [_ hi].
  assert (unit : norm2 (axis l) = 1).
  { rewrite ax, norm2_scale. pose proof (sqrt_sqrt (norm2 d) (Rlt_le _ _ n0)) as q.
    rewrite <- q at 2. field. lra. }
  assert (hax : contains_vec (iscale bits iv id) (axis l)) by (rewrite ax; apply iscale_sound; assumption).
  unfold contains_leg. cbn [in_axis in_projection in_length2 in_mode in_origin]. conjuncts.
  - unfold well_formed. split; [exact unit |]. split; [apply (contains_positive bits il); assumption |].
    rewrite hm. destruct (mode c); lra.
  - exact hax.
  - apply iprojection_sound; assumption.
  - apply sqr_sound; exact hl.
  - exact hm.
  - unfold w. apply isub_sound; [apply iadd_sound |]; assumption.
Qed.

Lemma r_projection : forall l P, r l P = mulv (projection (axis l)) (w l P).
Proof. intros. unfold r, projection, outer. generalize (w l P) (axis l). vec_ring. Qed.

Definition signed (positive_mode : bool) (a : fixed) : fixed := if positive_mode then a else neg a.

Lemma signed_sound : forall b a x, contains a x -> contains (signed b a) ((if b then 1 else -1) * x).
Proof.
  intros b a x h. destruct b; cbn [signed].
  - rewrite Rmult_1_l. exact h.
  - replace (-1 * x) with (- x) by ring. apply neg_sound; exact h.
Qed.

(** The row of J^-1 at the expansion point c and its slopes, from enclosures
    of w at c and over the box; None unless s > 0 at both. *)
Definition expand_leg (a : ileg) (at_c over : ivec) : option (ivec * imat) :=
  let rc := iapply bits (in_projection a) at_c in
  let rp := iapply bits (in_projection a) over in
  match root bits (sub (in_length2 a) (inorm2 bits rc)), root bits (sub (in_length2 a) (inorm2 bits rp)) with
  | Some sc, Some sp =>
      match recip bits sc, recip bits sp, recip bits (mul bits (mul bits sp sc) (add sp sc)) with
      | Some ic, Some ip, Some ik =>
          Some (iadd (in_axis a) (iscale bits (signed (in_mode a) ic) rc),
                imadd (imscale bits (signed (in_mode a) ip) (in_projection a))
                      (iouter bits (iscale bits (signed (in_mode a) ik) rc) (iadd rp rc)))
      | _, _, _ => None
      end
  | _, _ => None
  end.

Lemma expand_leg_sound : forall a P0 l P c at_c over row slope,
  contains_leg a P0 l -> contains_vec at_c (w l c) -> contains_vec over (w l P) ->
  expand_leg a at_c over = Some (row, slope) ->
  0 < s l P /\ 0 < s l c /\ contains_vec row (Jinv_row l c) /\ contains_mat slope (slider_slope l P c).
Proof.
  intros a P0 l P c at_c over row slope [wf [hn [hpi [hl [hm _]]]]] hc hp h. unfold expand_leg in h. cbn zeta in h.
  set (rc := iapply bits (in_projection a) at_c) in *. set (rp := iapply bits (in_projection a) over) in *.
  assert (hrc : contains_vec rc (r l c)) by (rewrite r_projection; apply iapply_sound; assumption).
  assert (hrp : contains_vec rp (r l P)) by (rewrite r_projection; apply iapply_sound; assumption).
  destruct (root bits (sub (in_length2 a) (inorm2 bits rc))) as [sc |] eqn:e1; [| discriminate].
  destruct (root bits (sub (in_length2 a) (inorm2 bits rp))) as [sp |] eqn:e2; [| discriminate].
  destruct (recip bits sc) as [ic |] eqn:e3; [| discriminate].
  destruct (recip bits sp) as [ip |] eqn:e4; [| discriminate].
  destruct (recip bits (mul bits (mul bits sp sc) (add sp sc))) as [ik |] eqn:e5; [| discriminate].
  assert (e : iadd (in_axis a) (iscale bits (signed (in_mode a) ic) rc) = row) by congruence.
  assert (e' : imadd (imscale bits (signed (in_mode a) ip) (in_projection a))
                 (iouter bits (iscale bits (signed (in_mode a) ik) rc) (iadd rp rc)) = slope) by congruence.
  clear h. subst row slope.
  destruct (root_sound _ _ _ _ e1 (sub_sound _ _ _ _ _ hl (inorm2_sound _ _ _ hrc))) as [_ [sc0 hsc]].
  destruct (root_sound _ _ _ _ e2 (sub_sound _ _ _ _ _ hl (inorm2_sound _ _ _ hrp))) as [_ [sp0 hsp]].
  fold (s l c) in sc0, hsc. fold (s l P) in sp0, hsp.
  destruct (recip_sound _ _ _ _ e3 hsc) as [_ hic]. destruct (recip_sound _ _ _ _ e4 hsp) as [_ hip].
  destruct (recip_sound _ _ _ _ e5 (mul_sound _ _ _ _ _ (mul_sound _ _ _ _ _ hsp hsc) (add_sound _ _ _ _ _ hsp hsc)))
    as [_ hik].
  split; [exact sp0 |]. split; [exact sc0 |]. split.
  - unfold Jinv_row. rewrite inv_eta, hm by assumption.
    apply iadd_sound; [exact hn |]. apply iscale_sound; [apply signed_sound; exact hic | exact hrc].
  - replace (slider_slope l P c) with
      (madd (mscale ((if in_mode a then 1 else -1) * / s l P) (projection (axis l)))
            (outer (vscale ((if in_mode a then 1 else -1) * / (s l P * s l c * (s l P + s l c))) (r l c))
                   (vadd (r l P) (r l c)))).
    + apply imadd_sound; [apply imscale_sound; [apply signed_sound; exact hip | exact hpi] |].
      apply iouter_sound; [apply iscale_sound; [apply signed_sound; exact hik | exact hrc] |].
      apply iadd_sound; assumption.
    + unfold slider_slope. rewrite hm. unfold outer. generalize (projection (axis l)) (r l P) (r l c).
      generalize (/ s l P) (/ (s l P * s l c * (s l P + s l c))) (if in_mode a then 1 else -1). vec_ring.
Qed.

(** ** Expansion over a cell

    A cell is a box of the unit cube; u in the unit cube stands for the point
    P0 + width u of the workspace. *)

Record expansion := Expansion { at_centre : imat; extent1 : imat; extent2 : imat; extent3 : imat }.

Definition minus_one : vec := Vec (-1) (-1) (-1).
Definition plus_one : vec := Vec 1 1 1.

(** [A] is M(c) + sum_k lambda_k E_k for some lambda_k from -1 to 1, M(c) and E_k enclosed. *)
Definition expands (x : expansion) (A : mat) : Prop :=
  exists M0 E1 E2 E3 lambda,
    contains_mat (at_centre x) M0 /\ contains_mat (extent1 x) E1 /\ contains_mat (extent2 x) E2 /\
    contains_mat (extent3 x) E3 /\ in_range minus_one plus_one lambda /\ A = affine M0 E1 E2 E3 lambda.

Definition midpoint (e : fixed) : Z := Z.shiftr (lo e + hi e) 1.

Lemma midpoint_spec : forall e, (2 * midpoint e <= lo e + hi e < 2 * midpoint e + 2)%Z.
Proof.
  intro e. unfold midpoint. rewrite Z.shiftr_div_pow2 by lia. change (2 ^ 1)%Z with 2%Z.
  pose proof (Z.div_mod (lo e + hi e) 2 ltac:(lia)). pose proof (Z.mod_pos_bound (lo e + hi e) 2 ltac:(lia)). lia.
Qed.

Lemma half_sound : forall e u, contains e u ->
  exists t, -1 <= t <= 1 /\
    u - IZR (midpoint e) / unit_R bits = IZR (hi e - midpoint e) / unit_R bits * t.
Proof.
  intros e u [l h]. pose proof (midpoint_spec e) as m. pose proof (unit_R_pos bits) as p.
  set (c := midpoint e) in *. assert (le : (lo e <= hi e)%Z) by (apply le_IZR; lra).
  set (y := u * unit_R bits - IZR c).
  assert (E : u - IZR c / unit_R bits = y / unit_R bits) by (unfold y; field; lra).
  destruct (Z.eq_dec (hi e) c) as [z | n].
  - exists 0. split; [lra |]. assert (lo e = c) as z' by lia. rewrite z, z' in *.
    assert (y = 0) as y0 by (unfold y; lra). rewrite E, y0. unfold Rdiv. ring.
  - assert (h0 : 0 < IZR (hi e - c)) by (apply IZR_lt; lia). exists (y / IZR (hi e - c)).
    assert (b : - IZR (hi e - c) <= y <= IZR (hi e - c)).
    { assert (g : (- (hi e - c) <= lo e - c)%Z) by lia. apply IZR_le in g.
      rewrite opp_IZR, !minus_IZR in *. unfold y. lra. }
    assert (F : y / IZR (hi e - c) * IZR (hi e - c) = y) by (field; lra).
    split; [split; apply Rmult_le_reg_r with (IZR (hi e - c)); lra |].
    rewrite E. field. lra.
Qed.

Definition icol1 (a : imat) : ivec := IVec (ix (irow1 a)) (ix (irow2 a)) (ix (irow3 a)).
Definition icol2 (a : imat) : ivec := IVec (iy (irow1 a)) (iy (irow2 a)) (iy (irow3 a)).
Definition icol3 (a : imat) : ivec := IVec (iz (irow1 a)) (iz (irow2 a)) (iz (irow3 a)).

Definition expand (a1 a2 a3 : ileg) (width cell : ivec) : option expansion :=
  let mx := midpoint (ix cell) in let my := midpoint (iy cell) in let mz := midpoint (iz cell) in
  let over := ihadamard bits width cell in
  let centre := ihadamard bits width (IVec (dyadic mx) (dyadic my) (dyadic mz)) in
  let half := ihadamard bits width
    (IVec (dyadic (hi (ix cell) - mx)) (dyadic (hi (iy cell) - my)) (dyadic (hi (iz cell) - mz))) in
  match expand_leg a1 (iadd (in_origin a1) centre) (iadd (in_origin a1) over),
        expand_leg a2 (iadd (in_origin a2) centre) (iadd (in_origin a2) over),
        expand_leg a3 (iadd (in_origin a3) centre) (iadd (in_origin a3) over) with
  | Some (r1, s1), Some (r2, s2), Some (r3, s3) =>
      Some (Expansion (IMat r1 r2 r3)
        (imscale bits (ix half) (IMat (icol1 s1) (icol1 s2) (icol1 s3)))
        (imscale bits (iy half) (IMat (icol2 s1) (icol2 s2) (icol2 s3)))
        (imscale bits (iz half) (IMat (icol3 s1) (icol3 s2) (icol3 s3))))
  | _, _, _ => None
  end.

Lemma w_displaced : forall l P0 d, w l (vadd P0 d) = vadd (w l P0) d.
Proof. intros. unfold w. generalize (platform_offset l) (base_point l). vec_ring. Qed.

Lemma icols_sound : forall a M, contains_mat a M ->
  contains_vec (icol1 a) (col1 M) /\ contains_vec (icol2 a) (col2 M) /\ contains_vec (icol3 a) (col3 M).
Proof.
  intros a M [[h11 [h12 h13]] [[h21 [h22 h23]] [h31 [h32 h33]]]].
  conjuncts; (split; [| split]); assumption.
Qed.

Theorem expand_sound : forall a1 a2 a3 P0 m width W cell u x,
  contains_leg a1 P0 (leg1 m) -> contains_leg a2 P0 (leg2 m) -> contains_leg a3 P0 (leg3 m) ->
  contains_vec width W -> contains_vec cell u -> expand a1 a2 a3 width cell = Some x ->
  let P := vadd P0 (hadamard W u) in legs_reach m P /\ expands x (Jinv m P).
Proof.
  intros a1 a2 a3 P0 m width W cell u x l1 l2 l3 hW hu h P. unfold expand in h. cbn zeta in h.
  set (mx := midpoint (ix cell)) in *. set (my := midpoint (iy cell)) in *. set (mz := midpoint (iz cell)) in *.
  set (over := ihadamard bits width cell) in *.
  set (centre := ihadamard bits width (IVec (dyadic mx) (dyadic my) (dyadic mz))) in *.
  set (half := ihadamard bits width
    (IVec (dyadic (hi (ix cell) - mx)) (dyadic (hi (iy cell) - my)) (dyadic (hi (iz cell) - mz)))) in *.
  set (U := unit_R bits) in *.
  set (mid := Vec (IZR mx / U) (IZR my / U) (IZR mz / U)).
  set (H := Vec (IZR (hi (ix cell) - mx) / U) (IZR (hi (iy cell) - my) / U) (IZR (hi (iz cell) - mz) / U)).
  assert (hover : contains_vec over (hadamard W u)) by (apply ihadamard_sound; assumption).
  assert (hcentre : contains_vec centre (hadamard W mid)).
  { apply ihadamard_sound; [exact hW |]. split; [| split]; apply dyadic_sound. }
  assert (hhalf : contains_vec half (hadamard W H)).
  { apply ihadamard_sound; [exact hW |]. split; [| split]; apply dyadic_sound. }
  destruct (expand_leg a1 _ _) as [[r1 s1] |] eqn:e1; [| discriminate].
  destruct (expand_leg a2 _ _) as [[r2 s2] |] eqn:e2; [| discriminate].
  destruct (expand_leg a3 _ _) as [[r3 s3] |] eqn:e3; [| discriminate].
  assert (E : Expansion (IMat r1 r2 r3)
        (imscale bits (ix half) (IMat (icol1 s1) (icol1 s2) (icol1 s3)))
        (imscale bits (iy half) (IMat (icol2 s1) (icol2 s2) (icol2 s3)))
        (imscale bits (iz half) (IMat (icol3 s1) (icol3 s2) (icol3 s3))) = x) by congruence.
  clear h. subst x. set (c := vadd P0 (hadamard W mid)).
  assert (O : forall a l, contains_leg a P0 l ->
    contains_vec (iadd (in_origin a) centre) (w l c) /\ contains_vec (iadd (in_origin a) over) (w l P)).
  { intros a l hl. unfold c, P. rewrite !w_displaced. destruct hl as [_ [_ [_ [_ [_ ho]]]]].
    split; apply iadd_sound; assumption. }
  destruct (O _ _ l1) as [o1 o1']. destruct (O _ _ l2) as [o2 o2']. destruct (O _ _ l3) as [o3 o3']. clear O.
  destruct (expand_leg_sound _ _ _ P c _ _ _ _ l1 o1 o1' e1) as [p1 [c1 [row1 slope1]]].
  destruct (expand_leg_sound _ _ _ P c _ _ _ _ l2 o2 o2' e2) as [p2 [c2 [row2 slope2]]].
  destruct (expand_leg_sound _ _ _ P c _ _ _ _ l3 o3 o3' e3) as [p3 [c3 [row3 slope3]]].
  assert (RP : legs_reach m P) by (unfold legs_reach; auto).
  assert (Rc : legs_reach m c) by (unfold legs_reach; auto).
  assert (wf : machine_well_formed m) by (split; [apply l1 | split; [apply l2 | apply l3]]).
  split; [exact RP |].
  destruct hu as [hux [huy huz]].
  destruct (half_sound _ _ hux) as [tx' [bx ex]]. destruct (half_sound _ _ huy) as [ty' [b_y ey]].
  destruct (half_sound _ _ huz) as [tz' [bz ez]]. fold mx in ex. fold my in ey. fold mz in ez. fold U in ex, ey, ez.
  destruct hhalf as [hhx [hhy hhz]]. unfold hadamard in hhx, hhy, hhz. cbn [vx vy vz H] in hhx, hhy, hhz.
  destruct (icols_sound _ _ slope1) as [s11 [s12 s13]]. destruct (icols_sound _ _ slope2) as [s21 [s22 s23]].
  destruct (icols_sound _ _ slope3) as [s31 [s32 s33]].
  exists (Jinv m c),
    (mscale (vx W * (IZR (hi (ix cell) - mx) / U)) (slope_1 m P c)),
    (mscale (vy W * (IZR (hi (iy cell) - my) / U)) (slope_2 m P c)),
    (mscale (vz W * (IZR (hi (iz cell) - mz) / U)) (slope_3 m P c)), (Vec tx' ty' tz').
  cbn [at_centre extent1 extent2 extent3]. conjuncts.
  - rewrite Jinv_rows by (apply eta_nonzero; (apply wf || assumption)). split; [| split]; assumption.
  - apply imscale_sound; [exact hhx |]. split; [| split]; assumption.
  - apply imscale_sound; [exact hhy |]. split; [| split]; assumption.
  - apply imscale_sound; [exact hhz |]. split; [| split]; assumption.
  - unfold in_range, minus_one, plus_one. cbn [vx vy vz]. auto.
  - rewrite (Jinv_slopes m P c wf RP Rc).
    replace (vsub P c) with
      (Vec (vx W * (IZR (hi (ix cell) - mx) / U) * tx') (vy W * (IZR (hi (iy cell) - my) / U) * ty')
           (vz W * (IZR (hi (iz cell) - mz) / U) * tz')).
    + generalize (vx W * (IZR (hi (ix cell) - mx) / U)) (vy W * (IZR (hi (iy cell) - my) / U))
        (vz W * (IZR (hi (iz cell) - mz) / U)) (Jinv m c) (slope_1 m P c) (slope_2 m P c) (slope_3 m P c).
      clear. intros. unfold affine. unfold_vec. vec_split; ring.
    + rewrite !Rmult_assoc, <- ex, <- ey, <- ez. unfold P, c, mid, hadamard, vadd, vsub. cbn [vx vy vz].
      f_equal; ring.
Qed.

(** ** The vertex rules *)

Definition both (f : bool -> bool) : bool := f true && f false.
Definition sign_of (b : bool) : R := if b then 1 else -1.

Lemma both_sound : forall f, both f = true -> forall b, f b = true.
Proof. intros f h b. apply andb_true_iff in h as [t f']. destruct b; assumption. Qed.

Lemma vertex_signs : forall v, is_vertex minus_one plus_one v ->
  exists b1 b2 b3, v = Vec (sign_of b1) (sign_of b2) (sign_of b3).
Proof.
  intros [x y z] [hx [hy hz]]. unfold minus_one, plus_one in *. cbn [vx vy vz] in *.
  assert (S : forall t, t = -1 \/ t = 1 -> exists b, t = sign_of b)
    by (intros t [-> | ->]; [exists false | exists true]; reflexivity).
  destruct (S x hx) as [b1 ->]. destruct (S y hy) as [b2 ->]. destruct (S z hz) as [b3 ->].
  exists b1, b2, b3. reflexivity.
Qed.

Definition pick (b : bool) (s t : isym) : isym := if b then isym_add s t else isym_sub s t.
Definition pick_R (b : bool) (S T : mat) : mat := if b then madd S T else msub S T.
Definition pick_mat (b : bool) (s t : imat) : imat := if b then imadd s t else imsub s t.

Lemma pick_sound : forall b s t S T, contains_sym bits s S -> contains_sym bits t T ->
  contains_sym bits (pick b s t) (pick_R b S T).
Proof. intros [|] s t S T h k; [apply isym_add_sound | apply isym_sub_sound]; assumption. Qed.

Lemma pick_mat_sound : forall b s t S T, contains_mat s S -> contains_mat t T ->
  contains_mat (pick_mat b s t) (pick_R b S T).
Proof. intros [|] s t S T h k; [apply imadd_sound | apply imsub_sound]; assumption. Qed.

(** sign Rot(q) and |q|^2 *)
Definition rotation_of (a b c d : Z) (positive_sign : bool) : zmat :=
  let s n := if positive_sign then n else (- n)%Z in
  ZMat (s (a * a + b * b - c * c - d * d)%Z) (s (2 * (b * c - a * d))%Z) (s (2 * (b * d + a * c))%Z)
       (s (2 * (b * c + a * d))%Z) (s (a * a - b * b + c * c - d * d)%Z) (s (2 * (c * d - a * b))%Z)
       (s (2 * (b * d - a * c))%Z) (s (2 * (c * d + a * b))%Z) (s (a * a - b * b - c * c + d * d)%Z).
Definition norm_of (a b c d : Z) : Z := (a * a + b * b + c * c + d * d)%Z.

Lemma rotation_of_orthogonal : forall a b c d sg, (0 < norm_of a b c d)%Z ->
  orthogonal (mscale (1 / IZR (norm_of a b c d)) (matrix_of (rotation_of a b c d sg))).
Proof.
  intros a b c d sg h.
  assert (N : IZR (norm_of a b c d) = IZR a ^ 2 + IZR b ^ 2 + IZR c ^ 2 + IZR d ^ 2)
    by (unfold norm_of; repeat (rewrite plus_IZR || rewrite mult_IZR); ring).
  assert (n0 : IZR a ^ 2 + IZR b ^ 2 + IZR c ^ 2 + IZR d ^ 2 <> 0) by (rewrite <- N; apply not_0_IZR; lia).
  pose proof (quaternion_orthogonal (sign_of sg) (IZR a) (IZR b) (IZR c) (IZR d)
    ltac:(destruct sg; cbn [sign_of]; [left | right]; reflexivity) n0) as Q.
  rewrite N. eapply eq_rect with (P := orthogonal); [exact Q |].
  unfold rotation, rotation_of, matrix_of, mscale, vscale, sign_of.
  cbn [z11 z12 z13 z21 z22 z23 z31 z32 z33 row1 row2 row3 vx vy vz].
  destruct sg; rewrite ?opp_IZR; repeat (rewrite plus_IZR || rewrite mult_IZR || rewrite minus_IZR);
    vec_split; field; exact n0.
Qed.

Definition check_lower (x : expansion) (kappa : fixed) (a b c d : Z) (sg : bool) : bool :=
  let w := rotation_of a b c d sg in let n := norm_of a b c d in
  let base := minus_identity (twice_rotated w (at_centre x)) (times (2 * n) kappa) in
  let e1 := twice_rotated w (extent1 x) in let e2 := twice_rotated w (extent2 x) in
  let e3 := twice_rotated w (extent3 x) in
  (0 <? n)%Z &&
  both (fun b1 => let t1 := pick b1 base e1 in
  both (fun b2 => let t2 := pick b2 t1 e2 in
  both (fun b3 => definite (pick b3 t2 e3)))).

Lemma quad_madd : forall S T v, quad (madd S T) v = quad S v + quad T v.
Proof. intros. unfold quad. rewrite mulv_madd. generalize (mulv S v) (mulv T v). vec_ring. Qed.
Lemma quad_msub : forall S T v, quad (msub S T) v = quad S v - quad T v.
Proof. intros. unfold quad. rewrite mulv_msub. generalize (mulv S v) (mulv T v). vec_ring. Qed.
Lemma quad_pick : forall b S T v, quad (pick_R b S T) v = quad S v + sign_of b * quad T v.
Proof. intros [|] S T v; cbn [pick_R sign_of]; [rewrite quad_madd | rewrite quad_msub]; ring. Qed.
Lemma quad_twice : forall B A v, quad (twice_sym (mulm B A)) v = 2 * dot (mulv (transpose B) v) (mulv A v).
Proof.
  intros. rewrite <- dot_transpose, <- mulv_mulm. unfold twice_sym, quad. generalize (mulm B A). vec_ring.
Qed.

Lemma lower_vertex : forall w n k M0 E1 E2 E3 b1 b2 b3 v, n <> 0 ->
  quad (pick_R b3 (pick_R b2 (pick_R b1
      (msub (twice_sym (mulm w M0)) (mscale (2 * n * k) midentity)) (twice_sym (mulm w E1)))
      (twice_sym (mulm w E2))) (twice_sym (mulm w E3))) v
  = 2 * n * quad (lower_test (mscale (1 / n) w) k
      (affine M0 E1 E2 E3 (Vec (sign_of b1) (sign_of b2) (sign_of b3)))) v.
Proof.
  intros. rewrite !quad_pick, quad_msub, !quad_twice, quad_lower_test, mulv_affine.
  replace (quad (mscale (2 * n * k) midentity) v) with (2 * n * k * norm2 v)
    by (unfold quad; rewrite mulv_mscale, mulv_identity; clear; vec_ring).
  replace (mulv (transpose (mscale (1 / n) w)) v) with (vscale (1 / n) (mulv (transpose w) v))
    by (clear; vec_ring).
  cbn [vx vy vz]. generalize (mulv (transpose w) v) (mulv M0 v) (mulv E1 v) (mulv E2 v) (mulv E3 v).
  generalize (sign_of b1) (sign_of b2) (sign_of b3). clear - H. intros. unfold_vec. field. exact H.
Qed.

Lemma lower_convex_strict : forall M0 E1 E2 E3 W kappa,
  convex (fun d => positive_definite (lower_test W kappa (affine M0 E1 E2 E3 d))).
Proof.
  intros M0 E1 E2 E3 W kappa t p q ht hp hq v nz. rewrite lower_test_between.
  specialize (hp v nz). specialize (hq v nz). destruct (Req_dec t 0) as [-> | n]; [lra |].
  assert (0 < t * quad (lower_test W kappa (affine M0 E1 E2 E3 q)) v) by (apply Rmult_lt_0_compat; lra).
  assert (0 <= (1 - t) * quad (lower_test W kappa (affine M0 E1 E2 E3 p)) v) by (apply Rmult_le_pos; lra). lra.
Qed.

(** A definite test leaves no kernel, whatever kappa >= 0. *)
Lemma lower_test_det : forall W kappa A, 0 <= kappa -> positive_definite (lower_test W kappa A) -> det A <> 0.
Proof.
  intros W kappa A hk h. apply trivial_kernel_det. intros v e.
  destruct (zero_or_not v) as [z | nz]; [exact z | exfalso].
  specialize (h v nz). rewrite quad_lower_test, e in h. pose proof (norm2_nonneg v).
  assert (0 <= kappa * norm2 v) by (apply Rmult_le_pos; assumption).
  replace (dot (mulv (transpose W) v) vzero) with 0 in h
    by (generalize (mulv (transpose W) v); clear; intro y; unfold_vec; ring).
  lra.
Qed.

Theorem check_lower_sound : forall x kappa k a b c d sg A,
  check_lower x kappa a b c d sg = true -> contains kappa k -> 0 <= k -> expands x A ->
  sigma_at_least k A /\ det A <> 0.
Proof.
  intros x kappa k a b c d sg A h hk k0 [M0 [E1 [E2 [E3 [lambda [m0 [m1 [m2 [m3 [hl ->]]]]]]]]]].
  unfold check_lower in h. cbn zeta in h. apply andb_true_iff in h as [n0 h]. apply Z.ltb_lt in n0.
  pose proof (rotation_of_orthogonal a b c d sg n0) as O.
  set (w := rotation_of a b c d sg) in *. set (n := norm_of a b c d) in *.
  set (W := mscale (1 / IZR n) (matrix_of w)) in *. apply IZR_lt in n0.
  assert (PD : positive_definite (lower_test W k (affine M0 E1 E2 E3 lambda))).
  { refine (vertices_suffice _ minus_one plus_one (lower_convex_strict M0 E1 E2 E3 W k) _ lambda hl).
    intros v hv. destruct (vertex_signs v hv) as [b1 [b2 [b3 ->]]].
    pose proof (both_sound _ (both_sound _ (both_sound _ h b1) b2) b3) as D. cbn beta zeta in D.
    eapply (definite_sound bits) in D;
      [| apply pick_sound; [apply pick_sound; [apply pick_sound |] |];
         [apply minus_identity_sound; [apply twice_rotated_sound; exact m0 | apply times_sound; exact hk] | ..];
         apply twice_rotated_sound; eassumption].
    rewrite mult_IZR in D. intros u nz. specialize (D u nz). rewrite lower_vertex in D by lra.
    fold W in D. apply Rmult_lt_reg_l with (2 * IZR n); lra. }
  split; [| apply (lower_test_det W k); assumption].
  apply (lower_test_sound W); [exact O | exact k0 | apply positive_definite_semidefinite; exact PD].
Qed.

Definition check_upper (x : expansion) (k2 : fixed) : bool :=
  both (fun b1 => let t1 := pick_mat b1 (at_centre x) (extent1 x) in
  both (fun b2 => let t2 := pick_mat b2 t1 (extent2 x) in
  both (fun b3 => definite (gram_test bits k2 (pick_mat b3 t2 (extent3 x)))))).

Lemma pick_affine : forall M0 E1 E2 E3 b1 b2 b3,
  pick_R b3 (pick_R b2 (pick_R b1 M0 E1) E2) E3
  = affine M0 E1 E2 E3 (Vec (sign_of b1) (sign_of b2) (sign_of b3)).
Proof.
  intros. assert (P : forall b S T, pick_R b S T = madd S (mscale (sign_of b) T))
    by (intros [|]; cbn [pick_R sign_of]; vec_ring).
  rewrite !P. unfold affine. cbn [vx vy vz]. generalize (sign_of b1) (sign_of b2) (sign_of b3). vec_ring.
Qed.

Theorem check_upper_sound : forall x k2 k A,
  check_upper x k2 = true -> contains k2 (k ^ 2) -> expands x A -> sigma_at_most k A.
Proof.
  intros x k2 k A h hk [M0 [E1 [E2 [E3 [lambda [m0 [m1 [m2 [m3 [hl ->]]]]]]]]]].
  apply (affine_upper M0 E1 E2 E3 minus_one plus_one); [| exact hl].
  intros v hv. destruct (vertex_signs v hv) as [b1 [b2 [b3 ->]]]. apply positive_definite_semidefinite.
  pose proof (both_sound _ (both_sound _ (both_sound _ h b1) b2) b3) as D. cbn beta zeta in D.
  eapply (definite_sound bits); [exact D |]. rewrite <- pick_affine.
  apply gram_test_sound; [exact hk |]. repeat apply pick_mat_sound; assumption.
Qed.

(** ** The tree *)

Definition first_half (e : fixed) : fixed := Fixed (lo e) (midpoint e).
Definition second_half (e : fixed) : fixed := Fixed (midpoint e) (hi e).
Definition on_axis (k : axis_name) (f : fixed -> fixed) (cell : ivec) : ivec :=
  match k with
  | AlongX => IVec (f (ix cell)) (iy cell) (iz cell)
  | AlongY => IVec (ix cell) (f (iy cell)) (iz cell)
  | AlongZ => IVec (ix cell) (iy cell) (f (iz cell))
  end.

Lemma halves_cover : forall k cell u, contains_vec cell u ->
  contains_vec (on_axis k first_half cell) u \/ contains_vec (on_axis k second_half cell) u.
Proof.
  intros k cell u [hx [hy hz]].
  assert (H : forall e t, contains e t -> contains (first_half e) t \/ contains (second_half e) t).
  { intros e t [l h]. unfold Fixed.contains, first_half, second_half. cbn [lo hi].
    destruct (Rle_dec (t * unit_R bits) (IZR (midpoint e))); [left | right]; lra. }
  destruct k; cbn [on_axis]; unfold Enclosure.contains_vec; cbn [ix iy iz].
  - destruct (H _ _ hx); auto.
  - destruct (H _ _ hy); auto.
  - destruct (H _ _ hz); auto.
Qed.

Section Walk.
Variables a1 a2 a3 : ileg.
Variable width : ivec.
Variable kappa : fixed.
Variable k2 : option fixed.

(** What the steps of a node establish: the lower bound, the upper bound. *)
Definition run_step (x : expansion) (s : step) : bool * bool :=
  match s with
  | Lower a b c d sg => (check_lower x kappa a b c d sg, false)
  | Upper => (false, match k2 with Some k2 => check_upper x k2 | None => false end)
  end.

Fixpoint run_steps (x : expansion) (steps : list step) : bool * bool :=
  match steps with
  | [] => (false, false)
  | s :: rest => let p := run_step x s in let q := run_steps x rest in (fst p || fst q, snd p || snd q)
  end.

Definition run_node (cell : ivec) (steps : list step) : bool * bool :=
  match steps with
  | [] => (false, false)
  | _ => match expand a1 a2 a3 width cell with Some x => run_steps x steps | None => (false, false) end
  end.

(** [low], [up]: whether the bounds are already established on the cell. *)
Fixpoint run (t : tree) (cell : ivec) (low up : bool) : bool :=
  match t with
  | Leaf steps => let p := run_node cell steps in (low || fst p) && (up || snd p)
  | Split steps k first second =>
      let p := run_node cell steps in
      run first (on_axis k first_half cell) (low || fst p) (up || snd p)
      && run second (on_axis k second_half cell) (low || fst p) (up || snd p)
  end.

Variable P0 W : vec.
Variable m : machine.
Variables k_low k_up : R.
Hypothesis leg1_ok : contains_leg a1 P0 (leg1 m).
Hypothesis leg2_ok : contains_leg a2 P0 (leg2 m).
Hypothesis leg3_ok : contains_leg a3 P0 (leg3 m).
Hypothesis width_ok : contains_vec width W.
Hypothesis kappa_ok : contains kappa k_low.
Hypothesis k_low_nonneg : 0 <= k_low.
(** Without [k2] nothing is claimed about an upper bound. *)
Hypothesis k2_ok : forall a, k2 = Some a -> contains a (k_up ^ 2).

Let place (u : vec) : vec := vadd P0 (hadamard W u).
Let low_at (u : vec) : Prop :=
  legs_reach m (place u) /\ sigma_at_least k_low (Jinv m (place u)) /\ det (Jinv m (place u)) <> 0.
Let up_at (u : vec) : Prop := k2 <> None -> sigma_at_most k_up (Jinv m (place u)).

Lemma run_steps_sound : forall x u steps, legs_reach m (place u) -> expands x (Jinv m (place u)) ->
  (fst (run_steps x steps) = true -> low_at u) /\ (snd (run_steps x steps) = true -> up_at u).
Proof.
  intros x u steps reach ex. induction steps as [| s rest [il iu]]; cbn [run_steps fst snd]; [split; discriminate |].
  split; intro h; apply orb_true_iff in h as [h | h]; auto.
  - destruct s as [a b c d sg |]; cbn [run_step fst] in h; [| discriminate].
    destruct (check_lower_sound _ _ _ _ _ _ _ _ _ h kappa_ok k_low_nonneg ex). split; auto.
  - destruct s as [a b c d sg |]; cbn [run_step snd] in h; [discriminate |].
    destruct k2 as [k |] eqn:e; [| discriminate]. intros _.
    apply (check_upper_sound x k); auto.
Qed.

Lemma run_node_sound : forall cell u steps, contains_vec cell u ->
  (fst (run_node cell steps) = true -> low_at u) /\ (snd (run_node cell steps) = true -> up_at u).
Proof.
  intros cell u steps hu. unfold run_node. destruct steps as [| s rest]; [split; discriminate |].
  destruct (expand a1 a2 a3 width cell) as [x |] eqn:e; [| split; discriminate].
  destruct (expand_sound a1 a2 a3 P0 m width W cell u x leg1_ok leg2_ok leg3_ok width_ok hu e) as [reach ex].
  apply run_steps_sound; assumption.
Qed.

Lemma run_sound : forall t cell low up, run t cell low up = true ->
  forall u, contains_vec cell u -> (low = true -> low_at u) -> (up = true -> up_at u) -> low_at u /\ up_at u.
Proof.
  induction t as [steps | steps k t1 h1 t2 h2]; intros cell low up h u hu hlow hup; cbn [run] in h;
    destruct (run_node_sound cell u steps hu) as [nl nu]; apply andb_true_iff in h as [p q].
  - apply orb_true_iff in p, q. split; [destruct p | destruct q]; auto.
  - assert (l : low || fst (run_node cell steps) = true -> low_at u)
      by (intro o; apply orb_true_iff in o as [o | o]; auto).
    assert (r : up || snd (run_node cell steps) = true -> up_at u)
      by (intro o; apply orb_true_iff in o as [o | o]; auto).
    destruct (halves_cover k cell u hu) as [c | c]; [apply (h1 _ _ _ p u c l r) | apply (h2 _ _ _ q u c l r)].
Qed.
End Walk.

(** ** The check *)

(** 1 / psi, psi certainly positive. *)
Definition inverse (psi : number) : option fixed :=
  match enclose psi with
  | Some a => if (0 <? lo a)%Z then recip bits a else None
  | None => None
  end.

Lemma inverse_sound : forall psi a, inverse psi = Some a -> 0 < 1 / value psi /\ contains a (1 / value psi).
Proof.
  intros psi a h. unfold inverse in h. destruct (enclose psi) as [b |] eqn:e; [| discriminate].
  destruct (0 <? lo b)%Z eqn:p; [| discriminate]. apply Z.ltb_lt in p. apply enclose_sound in e.
  pose proof (contains_positive bits b _ p e) as v0.
  replace (1 / value psi) with (/ value psi) by (unfold Rdiv; ring).
  split; [apply Rinv_0_lt_compat; exact v0 | apply (recip_sound bits b); assumption].
Qed.

Definition unit_cell : ivec := let e := Fixed 0 (unit_Z bits) in IVec e e e.

Definition check (c : machine_claim) (t : tree) : bool :=
  match vector_of (fun t => enclose (least t)) (workspace c),
        vector_of (fun t => enclose (greatest t)) (workspace c),
        match psi_max c with Some psi => inverse psi | None => Some (integer bits 0) end,
        match psi_min c with Some psi => match inverse psi with Some k => Some (Some k) | None => None end
                           | None => Some None end
  with
  | Some corner, Some far, Some kappa, Some k =>
      match enclose_leg corner (slider1 c), enclose_leg corner (slider2 c), enclose_leg corner (slider3 c) with
      | Some a1, Some a2, Some a3 =>
          let k2 := match k with Some k => Some (sqr bits k) | None => None end in
          run a1 a2 a3 (isub far corner) kappa k2 t unit_cell false
            match k2 with Some _ => false | None => true end
      | _, _, _ => false
      end
  | _, _, _, _ => false
  end.

(** Every point of a closed interval is lo + (hi - lo) u for some u of the unit interval. *)
Lemma parameter : forall lo hi x, lo <= x <= hi -> exists u, 0 <= u <= 1 /\ x = lo + (hi - lo) * u.
Proof.
  intros l h x b. destruct (Req_dec l h) as [e | n].
  - exists 0. split; [lra |]. rewrite e in *. lra.
  - exists ((x - l) / (h - l)). assert (E : (x - l) / (h - l) * (h - l) = x - l) by (field; lra).
    split; [split; apply Rmult_le_reg_r with (h - l); lra | lra].
Qed.

Theorem check_sound : forall c t, check c t = true -> holds c.
Proof.
  intros c t h m P [m1 [m2 m3]] [hx [hy hz]]. unfold check in h.
  destruct (vector_of (fun t => enclose (least t)) (workspace c)) as [corner |] eqn:e1; [| discriminate].
  destruct (vector_of (fun t => enclose (greatest t)) (workspace c)) as [far |] eqn:e2; [| discriminate].
  destruct (match psi_max c with Some psi => inverse psi | None => Some (integer bits 0) end)
    as [kappa |] eqn:e3; [| discriminate].
  destruct (match psi_min c with
    | Some psi => match inverse psi with Some k => Some (Some k) | None => None end
    | None => Some None end) as [k |] eqn:e4; [| discriminate].
  destruct (enclose_leg corner (slider1 c)) as [a1 |] eqn:l1; [| discriminate].
  destruct (enclose_leg corner (slider2 c)) as [a2 |] eqn:l2; [| discriminate].
  destruct (enclose_leg corner (slider3 c)) as [a3 |] eqn:l3; [| discriminate].
  cbn zeta in h.
  set (P0 := Vec (value (least (tx (workspace c)))) (value (least (ty (workspace c)))) (value (least (tz (workspace c))))).
  set (P1 := Vec (value (greatest (tx (workspace c)))) (value (greatest (ty (workspace c))))
                 (value (greatest (tz (workspace c))))).
  assert (c0 : contains_vec corner P0)
    by (apply (vector_of_sound _ _ _ _ e1); intros b eb; apply (enclose_sound _ _ eb)).
  assert (c1 : contains_vec far P1)
    by (apply (vector_of_sound _ _ _ _ e2); intros b eb; apply (enclose_sound _ _ eb)).
  destruct (parameter _ _ _ hx) as [ux [bx ex]]. destruct (parameter _ _ _ hy) as [uy [b_y ey]].
  destruct (parameter _ _ _ hz) as [uz [bz ez]].
  assert (E : P = vadd P0 (hadamard (vsub P1 P0) (Vec ux uy uz)))
    by (destruct P as [x y z]; unfold P0, P1, hadamard, vadd, vsub; cbn [vx vy vz] in *; f_equal; assumption).
  assert (U : contains_vec unit_cell (Vec ux uy uz)).
  { pose proof (unit_R_pos bits).
    assert (C : forall u, 0 <= u <= 1 -> contains (Fixed 0 (unit_Z bits)) u).
    { intros u b. unfold Fixed.contains. cbn [lo hi]. fold (unit_R bits). split; nra. }
    split; [| split]; apply C; assumption. }
  set (k_low := match psi_max c with Some psi => 1 / value psi | None => 0 end).
  set (k_up := match psi_min c with Some psi => 1 / value psi | None => 0 end).
  assert (K : contains kappa k_low /\ 0 <= k_low).
  { unfold k_low. destruct (psi_max c) as [psi |].
    - apply inverse_sound in e3. split; [apply e3 | lra].
    - assert (e : integer bits 0 = kappa) by congruence. subst kappa. split; [apply integer_sound | lra]. }
  set (k2 := match k with Some k => Some (sqr bits k) | None => None end) in *.
  assert (K2 : forall a, k2 = Some a -> contains a (k_up ^ 2)).
  { intros a ea. unfold k2 in ea. destruct k as [k' |]; [| discriminate].
    assert (e : sqr bits k' = a) by congruence. subst a. apply sqr_sound. unfold k_up.
    destruct (psi_min c) as [psi |]; [| discriminate].
    destruct (inverse psi) as [q |] eqn:i; [| discriminate]. assert (q = k') by congruence. subst q.
    apply inverse_sound; exact i. }
  assert (G1 := enclose_leg_sound corner P0 _ _ _ c0 l1 m1).
  assert (G2 := enclose_leg_sound corner P0 _ _ _ c0 l2 m2).
  assert (G3 := enclose_leg_sound corner P0 _ _ _ c0 l3 m3).
  destruct (run_sound a1 a2 a3 (isub far corner) kappa k2 P0 (vsub P1 P0) m k_low k_up G1 G2 G3
    (isub_sound _ _ _ _ _ c1 c0) (proj1 K) (proj2 K) K2 t unit_cell _ _ h (Vec ux uy uz) U) as [L Up].
  { discriminate. }
  { intros n nn. destruct k2; [discriminate | contradiction]. }
  cbv beta in L, Up. rewrite <- E in L, Up. destruct L as [[s1 [s2 s3]] [low dt]].
  split; [| split].
  - unfold regular. repeat (split; [assumption |]). intro z. apply dt. rewrite det_Jinv, z. ring.
  - intros psi e. unfold k_low in low. rewrite e in low. exact low.
  - intros psi e. unfold k_up in Up. rewrite e in Up. apply Up. unfold k2.
    rewrite e in e4. destruct (inverse psi); [| discriminate].
    assert (k = Some f) by congruence. subst k. discriminate.
Qed.
End Precision.
