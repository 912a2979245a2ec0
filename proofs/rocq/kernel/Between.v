(** * Points between which the rows of a machine's legs are singular

    A multiple of each row is continuous wherever the leg reaches or not: the
    leg's vector, of a rod on an arm times the square of the elbow's lever.  Where
    the determinant of these changes its sign, no motion is seen by the rows, or
    some leg does not reach. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Number Trig Machine Witness Linear Configuration Arm Orientation Turning Legs Singular.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** The square root of what may be negative, which is 0 then. *)
Lemma flow_any_root : forall f : R -> R, continuity f -> continuity (fun u => sqrt (f u)).
Proof.
  intros f h. apply flow_same with (fun u => sqrt (f u * / 2 + Rabs (f u) * / 2)).
  - intro u. destruct (Rle_dec 0 (f u)) as [p | n].
    + rewrite Rabs_pos_eq by exact p. f_equal. field.
    + rewrite Rabs_left, (sqrt_neg_0 (f u)) by lra. replace (f u * / 2 + - f u * / 2) with 0 by ring. apply sqrt_0.
  - apply flow_root.
    + apply flow_plus; apply flow_times; try apply flow_constant; [exact h | exact (continuity_comp f Rabs h Rcontinuity_abs)].
    + intro u. pose proof (Rle_abs (- f u)) as n. rewrite Rabs_Ropp in n. lra.
Qed.
Lemma flow_dot : forall v w, flows v -> flows w -> continuity (fun u => Vec3.dot (v u) (w u)).
Proof. intros v w [? [? ?]] [? [? ?]]. unfold Vec3.dot. flow. Qed.
Lemma flow_norm2 : forall v, flows v -> continuity (fun u => norm2 (v u)).
Proof. intros v [? [? ?]]. unfold norm2. flow. Qed.
Lemma flows_same : forall v w : R -> vec, (forall u, v u = w u) -> flows v -> flows w.
Proof. intros v w e [h1 [h2 h3]]. split; [| split]; [revert h1 | revert h2 | revert h3]; apply flow_same; intro u; rewrite e; reflexivity. Qed.

(** ** Multiples of rows *)

(** The way from the elbow to the platform's joint, times the square of the way from the motor's axis to that. *)
Definition arm_ray (l : arm) (C : vec) : vec :=
  let a := Arm.along l C in let b := Arm.across l C in let f := forward l C in let h := arm_eta l C in
  vsub (vscale (a ^ 2 + b ^ 2) (from_motor l C)) (vscale (arm_length l) (vadd (vscale (f * a + h * b) (motor_zero l)) (vscale (f * b - h * a) (quarter l)))).
Definition leg_ray (l : driven) (C : vec) : vec := match l with Linear k => vector_of k C | Rotary k => arm_ray k C end.

Lemma arm_ray_is : forall l C, well_formed_arm l -> arm_reaches l C -> exists q, arm_row l C = vscale q (arm_ray l C).
Proof.
  intros l C ok reach. destruct (distance_split l C ok reach) as [_ n0]. set (n := Arm.along l C ^ 2 + Arm.across l C ^ 2) in *.
  exists (/ (arm_length l * arm_eta l C) * / n). unfold arm_row, Arm.rod, elbow, arm_cosine, arm_sine, arm_ray. cbv zeta. fold n.
  set (k := / (arm_length l * arm_eta l C)). unfold from_motor. generalize (motor l) (motor_zero l) (quarter l) (arm_offset l).
  set (x := forward l C * Arm.along l C + arm_eta l C * Arm.across l C). set (y := forward l C * Arm.across l C - arm_eta l C * Arm.along l C). clearbody k n x y.
  intros [m1 m2 m3] [e1 e2 e3] [q1 q2 q3] [o1 o2 o3]. unfold vscale, vsub, vadd. cbn [vx vy vz]. f_equal; field; lra.
Qed.

Lemma leg_ray_is : forall l C, well_formed_driven l -> own_reach l C -> exists q, own_row l C = vscale q (leg_ray l C).
Proof.
  intros [[l | a p x | n] | l] C ok reach; cbn [own_row leg_ray row vector_of own_reach reaches well_formed_driven well_formed_leg] in *.
  - pose proof (eta_nonzero l C ok reach) as e0. exists (/ eta l C). rewrite leg_vector_eq. unfold Jinv_row. generalize (r l C) (axis l). intros u v.
    unfold vadd, vscale. cbn [vx vy vz]. f_equal; field; exact e0.
  - eexists. reflexivity.
  - exists 1. destruct (normalised n) as [u v w]. unfold vscale. cbn [vx vy vz]. f_equal; ring.
  - exact (arm_ray_is l C ok reach).
Qed.

Lemma flows_ray : forall l C, flows C -> flows (fun u => leg_ray l (C u)).
Proof.
  assert (K : forall (a : vec) (v : R -> vec), flows v -> continuity (fun u => Vec3.dot a (v u))) by (intros a v h; apply flow_dot; [apply flows_constant | exact h]).
  intros [[l | a p x | n] | l] C h; cbn [leg_ray vector_of].
  - assert (W : flows (fun u => w l (C u))) by (unfold w; repeat first [exact h | apply flows_constant | apply flows_sub | apply flows_add]).
    assert (R' : flows (fun u => r l (C u))).
    { unfold r. apply flows_sub; [exact W |]. apply flows_scale; [apply K, W | apply flows_constant]. }
    apply flows_same with (fun u => vadd (r l (C u)) (vscale (eta l (C u)) (axis l))); [intro u; symmetry; apply leg_vector_eq |].
    apply flows_add; [exact R' |]. apply flows_scale; [| apply flows_constant]. unfold eta, s. apply flow_times; [apply flow_constant |].
    apply flow_any_root, flow_minus; [apply flow_constant | apply flow_norm2, R'].
  - unfold span. repeat first [exact h | apply flows_constant | apply flows_sub | apply flows_add].
  - apply flows_constant.
  - assert (W : flows (fun u => from_motor l (C u))) by (unfold from_motor; repeat first [exact h | apply flows_constant | apply flows_sub | apply flows_add]).
    assert (A : continuity (fun u => Arm.along l (C u))) by (apply K, W). assert (B : continuity (fun u => Arm.across l (C u))) by (apply K, W).
    assert (H : continuity (fun u => height l (C u))) by (apply K, W).
    assert (F : continuity (fun u => forward l (C u))) by (unfold forward, Rdiv; flow).
    assert (E : continuity (fun u => arm_eta l (C u))) by (unfold arm_eta; apply flow_times; [apply flow_constant | apply flow_any_root; unfold clearance; flow]).
    unfold arm_ray. cbv zeta. apply flows_sub; [apply flows_scale; [flow | exact W] |]. apply flows_scale; [apply flow_constant |].
    apply flows_add; (apply flows_scale; [flow | apply flows_constant]).
Qed.

(** ** Along a path *)

Definition ray_row (k : mobility) (ell : R) (P : vec) (Q : mat) (l : driven) : list R :=
  let a := leg_ray l (carried l P Q) in velocities k a (vscale (/ ell) (cross (mulv Q (offset l)) a)).
Definition velocity_paths (k : mobility) (v w : R -> vec) : list (R -> R) :=
  let x a u := vx (a u) in let y a u := vy (a u) in let z a u := vz (a u) in
  match k with
  | Translates => [x v; y v; z v]
  | TranslatesInPlane => [x v; y v]
  | Turns InPlane => [x v; y v; z w]
  | Turns InSpace => [x v; y v; z v; x w; y w; z w]
  | Turns AboutPoint => [x w; y w; z w]
  end.

Theorem singular_on_path : forall k ell m (P : R -> vec) (Q : R -> mat), flows P -> (forall b, flows (fun u => mulv (Q u) b)) -> length m = freedom k ->
  detR (freedom k) (map (ray_row k ell (P 0) (Q 0)) m) * detR (freedom k) (map (ray_row k ell (P 1) (Q 1)) m) <= 0 ->
  exists u v, 0 <= u <= 1 /\ length v = freedom k /\ nonzero v /\
    (Forall well_formed_driven m -> Forall (fun l => own_reach l (carried l (P u) (Q u))) m -> speed2 (map (driven_row k ell (P u) (Q u)) m) v = 0).
Proof.
  intros k ell m P Q hP hQ lm opposite.
  set (a l u := leg_ray l (carried l (P u) (Q u))). set (moment l u := vscale (/ ell) (cross (mulv (Q u) (offset l)) (a l u))).
  set (rows := map (fun l => velocity_paths k (a l) (moment l)) m).
  assert (V : forall u, values_at u rows = map (ray_row k ell (P u) (Q u)) m).
  { intro u. unfold values_at, rows. rewrite map_map. apply map_ext. intro l. destruct k as [| | []]; reflexivity. }
  destruct (singular_between (freedom k) rows) as [u [v [hu [lv [nz hv]]]]].
  - unfold rows. rewrite Forall_map. apply Forall_forall. intros l _.
    assert (A : flows (a l)).
    { unfold a. apply (flows_ray l (fun u => carried l (P u) (Q u))). unfold carried. apply flows_sub; [| apply flows_constant]. apply flows_add; [exact hP | apply hQ]. }
    assert (M : flows (moment l)) by (unfold moment; apply flows_scale; [apply flow_constant |]; apply flows_cross; [apply hQ | exact A]).
    destruct A as [? [? ?]], M as [? [? ?]]. unfold velocity_paths. cbv zeta. destruct k as [| | []]; repeat constructor; assumption.
  - unfold rows. rewrite map_length. exact lm.
  - rewrite !V. exact opposite.
  - exists u, v. split; [exact hu |]. split; [exact lv |]. split; [exact nz |]. rewrite V in hv. clear - hv. intros ok reach. unfold speed2.
    induction m as [| l m IH]; [reflexivity |]. inversion ok as [| ? ? ok1 ok2]; inversion reach as [| ? ? re1 re2]; subst. cbn [map] in hv. inversion hv as [| ? ? v1 v2]; subst.
    cbn [map fold_right]. rewrite (IH v2 ok2 re2). destruct (leg_ray_is l _ ok1 re1) as [q e].
    assert (E : driven_row k ell (P u) (Q u) l = map (Rmult q) (ray_row k ell (P u) (Q u) l)).
    { unfold driven_row, ray_row. cbv zeta. rewrite e. set (c := carried l (P u) (Q u)). generalize (leg_ray l c) (mulv (Q u) (offset l)). clear.
      intros [x y z] [o1 o2 o3]. destruct k as [| | []]; unfold velocities, twist, coordinates, vscale, cross; cbn [map vx vy vz]; repeat (apply f_equal2; [ring |]); reflexivity. }
    rewrite E, dot_map, v1. ring.
Qed.

Section Named.
Context {names : naming}.

(** ** In exact numbers *)

Definition xarm_ray (l : exact_arm) (C : numbers) : numbers :=
  let a := xalong l C in let b := xacross l C in let f := xforward l C in let h := xeta l C in
  each2 Minus (scaled (xdistance l C) (xfrom l C)) (scaled (xarm l)
    (each2 Plus (scaled (Plus (Times f a) (Times h b)) (xzero l)) (scaled (Minus (Times f b) (Times h a)) (xquarter l)))).
Definition xray_row (k : mobility) (ell : number) (o : option orientations) (c : list number) (P : numbers) (l : exact_driven) : list number :=
  let C := xcarried o c P l in let a := match l with XLinear i => nray i C | XRotary i => xarm_ray i C end in
  nvelocities k a (scaled (Over (1 // 1) ell) (ncrossed (nturn o c (xoffset l)) a)).

Lemma values_arm_ray : forall l C, values (xarm_ray l C) = arm_ray (arm_of l) (values C).
Proof.
  intros l C. unfold xarm_ray, arm_ray. cbv zeta. rewrite values_minus, !values_scaled, values_plus, !values_scaled, values_xzero, values_xquarter.
  cbn [value]. unfold xdistance, nsquare. cbn [value]. rewrite !value_xalong, !value_xacross, !value_xforward, !value_xeta.
  f_equal. f_equal. ring.
Qed.
Lemma ray_row_values : forall k ell o c P Q l, (forall b, values (nturn o c b) = mulv Q (values b)) ->
  map value (xray_row k ell o c P l) = ray_row k (value ell) (values P) Q (driven_of l).
Proof.
  intros k ell o c P Q l hQ. unfold xray_row, ray_row. cbv zeta. pose proof (values_carried o c P Q hQ l) as C. rewrite <- C.
  assert (O : values (xoffset l) = offset (driven_of l)).
  { destruct l as [[d a p len m | a p q | d] | i]; try reflexivity. unfold values. cbn. unfold vzero. f_equal; lra. }
  rewrite <- O, <- hQ. set (b := nturn o c (xoffset l)).
  assert (A : leg_ray (driven_of l) (values (xcarried o c P l)) = values match l with XLinear i => nray i (xcarried o c P l) | XRotary i => xarm_ray i (xcarried o c P l) end).
  { destruct l as [i | i]; cbn [driven_of leg_ray]; symmetry; [apply values_vector | apply values_arm_ray]. }
  rewrite A. generalize (match l with XLinear i => nray i (xcarried o c P l) | XRotary i => xarm_ray i (xcarried o c P l) end). clear. intro a.
  unfold velocities, nvelocities, twist, ntwist, coordinates, vscale, cross, scaled, ncrossed.
  destruct k as [| | []]; cbn [map vx vy vz nx ny nz values value]; repeat (apply f_equal2; [unfold Rdiv; rewrite ?Rinv_1; ring |]); reflexivity.
Qed.

Section Precision.
Variable bits : positive.

Definition is_set_coordinate (o : option orientations) (t : list number) : bool :=
  match o, t with Some o, _ => is_orientation bits o t | None, [] => true | None, _ => false end.
Lemma set_connected : forall o t t', is_set_coordinate o t = true -> is_set_coordinate o t' = true ->
  exists Q : R -> mat, (forall b, flows (fun u => mulv (Q u) b)) /\ (forall u, 0 <= u <= 1 -> match o with Some o => in_orientations o (Q u) | None => Q u = midentity end) /\
    (forall b, values (nturn o t b) = mulv (Q 0) (values b)) /\ (forall b, values (nturn o t' b) = mulv (Q 1) (values b)).
Proof.
  intros [o |] t t' h h'; cbn [is_set_coordinate nturn] in *.
  - apply is_orientation_coordinate in h, h'. destruct (orientations_connected _ _ _ h h') as [path [e0 [e1 [on flow_]]]].
    exists (fun u => orientation_at o (path u)). split; [exact flow_ |]. split; [intros u hu; apply is_coordinate_sound, on, hu |].
    rewrite e0, e1. split; intro b; apply values_turn; assumption.
  - exists (fun _ => midentity). split; [intro b; apply flows_constant |]. split; [reflexivity |]. split; intro b; rewrite mulv_identity; reflexivity.
Qed.

Definition on_segment (P P' : vec) (u : R) : vec := vadd P (vscale u (vsub P' P)).
Lemma segment_ends : forall P P', on_segment P P' 0 = P /\ on_segment P P' 1 = P'.
Proof. intros [x y z] [x' y' z']. unfold on_segment, vadd, vscale, vsub. cbn [vx vy vz]. split; f_equal; ring. Qed.

(** Two poses of one machine in [k], with these orientations. *)
Definition are_legs_opposite (k : mobility) (ell : number) (o : option orientations) (ls : list exact_driven) (P : numbers) (t : list number) (P' : numbers) (t' : list number) : bool :=
  Nat.eqb (length ls) (freedom k) && is_set_coordinate o t && is_set_coordinate o t' &&
  opposite bits (freedom k) (map (xray_row k ell o t P) ls) (map (xray_row k ell o t' P') ls).

Lemma legs_singular : forall k ell o ls P t P' t', are_legs_opposite k ell o ls P t P' t' = true -> Forall well_formed_driven (map driven_of ls) ->
  exists u Q v, 0 <= u <= 1 /\ match o with Some o => in_orientations o Q | None => Q = midentity end /\ length v = freedom k /\ nonzero v /\
    let C := on_segment (values P) (values P') u in (Forall (fun l => own_reach l (carried l C Q)) (map driven_of ls) -> speed2 (map (driven_row k (value ell) C Q) (map driven_of ls)) v = 0).
Proof.
  intros k ell o ls P t P' t' h ok. unfold are_legs_opposite in h. apply andb_true_iff in h as [h opp]. apply andb_true_iff in h as [h o']. apply andb_true_iff in h as [n o1].
  apply Nat.eqb_eq in n. apply opposite_sound in opp. destruct (set_connected o t t' o1 o') as [Q [fQ [onQ [q0 q1]]]]. destruct (segment_ends (values P) (values P')) as [s0 s1].
  destruct (singular_on_path k (value ell) (map driven_of ls) (on_segment (values P) (values P')) Q) as [u [v [hu [lv [nz hv]]]]].
  - apply flows_line.
  - exact fQ.
  - rewrite map_length. exact n.
  - rewrite s0, s1, !map_map. rewrite !map_map in opp.
    rewrite (map_ext _ _ (fun l => ray_row_values k ell o t P (Q 0) l q0)), (map_ext _ _ (fun l => ray_row_values k ell o t' P' (Q 1) l q1)) in opp. lra.
  - exists u, (Q u), v. split; [exact hu |]. split; [exact (onQ u hu) |]. split; [exact lv |]. split; [exact nz |]. cbv zeta. intro reach. exact (hv ok reach).
Qed.

Definition refute_between_driven (c : driven_claim) (ls : list exact_driven) (P : numbers) (t : list number) (P' : numbers) (t' : list number) : bool :=
  all_exact bits (drives c) ls && is_in bits (place_of c) P && is_in bits (place_of c) P' &&
  are_legs_opposite (mobility_of c) (length_of c) (turned_by c) ls P t P' t'.
Theorem refute_between_driven_sound : forall c ls P t P' t', refute_between_driven c ls P t P' t' = true ->
  exists m P Q, Forall well_formed_driven m /\ is_about_driven c m P Q /\ ~ meets_driven c m P Q.
Proof.
  intros c ls P t P' t' h. apply andb_true_iff in h as [h o]. apply andb_true_iff in h as [h p']. apply andb_true_iff in h as [h p].
  destruct (all_exact_sound bits _ _ h) as [h1 h2]. apply is_in_sound in p, p'. destruct (legs_singular _ _ _ _ _ _ _ _ o h2) as [u [Q [v [hu [hQ [lv [nz hv]]]]]]]. cbv zeta in hv.
  exists (map driven_of ls), (on_segment (values P) (values P') u), Q. split; [exact h2 |]. split; [split; [exact h1 | split; [apply region_convex; assumption | exact hQ]] |].
  intros [reach [inj _]]. specialize (inj v lv nz). cbn [jacobian legs_at reached] in inj, reach. rewrite (hv reach) in inj. exact (Rlt_irrefl 0 inj).
Qed.

(** Of legs of platforms that do not turn. *)
Definition refute_between_legs (c : claim) (ls : list exact_leg) (P P' : numbers) : bool :=
  admits bits c ls P && is_in bits (workspace c) P' && are_legs_opposite Translates (1 // 1) None (map XLinear ls) P [] P' [].
Theorem refute_between_legs_sound : forall c ls P P', refute_between_legs c ls P P' = true -> exists m P, is_about c m P /\ ~ Statement.meets c m P.
Proof.
  intros c ls P P' h. apply andb_true_iff in h as [h o]. apply andb_true_iff in h as [h p']. destruct (admits_sound bits _ _ _ h) as [a1 [a2 a3]]. apply is_in_sound in p'.
  assert (E : map driven_of (map XLinear ls) = map Linear (map leg_of ls)) by (rewrite !map_map; reflexivity).
  destruct (legs_singular _ _ _ _ _ _ _ _ o) as [u [Q [v [hu [hQ [lv [nz hv]]]]]]]; [rewrite E, Forall_map; exact a2 |]. cbv zeta in hv. rewrite E in hv. subst Q.
  set (C := on_segment (values P) (values P') u) in *.
  assert (D : forall l, carried (Linear l) C midentity = C).
  { intro l. unfold carried. rewrite mulv_identity. destruct C as [x y z], (offset (Linear l)) as [d e f]. unfold vsub, vadd. cbn [vx vy vz]. f_equal; ring. }
  exists (map leg_of ls), C. split; [split; [exact a1 | split; [exact a2 | apply region_convex; assumption]] |]. intros [reach [inj _]].
  destruct v as [| x [| y [| z [|]]]]; try discriminate lv.
  assert (Z : Statement.speed2 (map leg_of ls) C (Vec x y z) = 0).
  { rewrite <- hv.
    - generalize (map leg_of ls). clear - D. unfold Statement.speed2, speed2. induction l as [| l m IH]; [reflexivity |]. cbn [map fold_right]. rewrite IH. f_equal. f_equal.
      unfold driven_row. cbv zeta. rewrite D. cbn [own_row velocities]. unfold Vec3.dot, coordinates. cbn [Linear.dot vx vy vz]. ring.
    - rewrite Forall_map. revert reach. apply Forall_impl. intros l r0. rewrite D. exact r0. }
  specialize (inj (Vec x y z)). rewrite Z in inj. apply (Rlt_irrefl 0), inj. intro e. injection e as -> -> ->. unfold nonzero in nz. cbn in nz. lra.
Qed.
End Precision.
End Named.
