(** * Sliders, struts and arms of platforms that turn or not: kinematics, claims, and refutations

    A leg meets the platform at its joint alone, so that its kinematics are those
    of a platform that does not turn, at another point. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert.kernel Require Import Linear.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Claim.
From Orthocert.kernel Require Import Statement Number Trig Machine Witness Configuration Arm Orientation Turning.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Kinematics *)

(** Without turning, in space or in the plane of x and y; or as platforms that turn move. *)
Inductive mobility := Translates | TranslatesInPlane | Turns (k : motion).
Definition velocities (k : mobility) (v omega : vec) : list R :=
  match k with Translates => coordinates v | TranslatesInPlane => [vx v; vy v] | Turns k => twist k v omega end.
Definition freedom (k : mobility) : nat := match k with Translates => 3 | TranslatesInPlane => 2 | Turns k => dimension k end.
Definition has_velocities (k : mobility) (v omega : vec) : Prop :=
  match k with Translates => omega = vzero | TranslatesInPlane => vz v = 0 /\ omega = vzero | Turns k => is_of k v omega end.

(** A leg whose joint coordinate is a length, or an angle. *)
Inductive driven := Linear (l : Statement.leg) | Rotary (l : arm).

(** From the platform's point to its joint, in its own frame. *)
Definition offset (l : driven) : vec :=
  match l with Linear (Guided k) => platform_offset k | Linear (Extensible _ p _) => p | Linear (Plane _) => vzero | Rotary k => arm_offset k end.
(** The platform that does not turn, and has this joint where it is: at P + Q offset. *)
Definition carried (l : driven) (P : vec) (Q : mat) : vec := vsub (vadd P (mulv Q (offset l))) (offset l).

Definition own_row (l : driven) (C : vec) : vec := match l with Linear k => row k C | Rotary k => arm_row k C end.
Definition own_joint (l : driven) (C : vec) : coordinate :=
  match l with Linear k => Length (joint k C) | Rotary k => Angle (arm_cosine k C) (arm_sine k C) end.
Definition own_reach (l : driven) (C : vec) : Prop := match l with Linear k => reaches C k | Rotary k => arm_reaches k C end.
(** Where the driven end is, of planes nowhere. *)
Definition driven_end (l : driven) (C : vec) : vec :=
  match l with Linear (Guided k) => B_point k C | Linear (Extensible a _ _) => a | Linear (Plane _) => vzero | Rotary k => elbow k C end.
(** The vector of a leg, eta, which of struts is put at 0, and its length. *)
Definition own_rod (l : driven) (C : vec) : option (vec * R * R) :=
  match l with
  | Linear (Guided k) => Some (leg_vector k C, eta k C, leg_length k)
  | Linear (Extensible a p _) => Some (span a p C, 0, sqrt (norm2 (span a p C)))
  | Rotary k => Some (Arm.rod k C, arm_eta k C, rod_length k)
  | _ => None
  end.

(** joint' = row . v + ((r x row)/ell) . (ell omega), r from the platform's point to its joint ([driven_velocity]). *)
Definition driven_row (k : mobility) (ell : R) (P : vec) (Q : mat) (l : driven) : list R :=
  let u := own_row l (carried l P Q) in velocities k u (vscale (/ ell) (cross (mulv Q (offset l)) u)).
(** Components of a vector that there are; of platforms that turn none are asked for. *)
Definition components (k : mobility) (a : vec) : list R :=
  match k with Translates => coordinates a | TranslatesInPlane => [vx a; vy a] | Turns _ => [] end.
Definition driven_rod (k : mobility) (P : vec) (Q : mat) (l : driven) : option Configuration.rod :=
  option_map (fun q => let '(a, eta, len) := q in Rod (components k a) eta len) (own_rod l (carried l P Q)).
(** Poses near another one; where the platform turns, as [is_near] says. *)
Definition is_near_to (k : mobility) (b angle : number) (P : vec) (Q : mat) (P' : vec) (Q' : mat) : Prop :=
  match k with
  | Translates => norm2 (vsub P' P) <= value b ^ 2 /\ Q' = Q
  | TranslatesInPlane => vz P' = vz P /\ norm2 (vsub P' P) <= value b ^ 2 /\ Q' = Q
  | Turns k => is_near k b angle P Q P' Q'
  end.
(** Joint coordinates off by the error at most from those of the nominal legs are those of exactly one pose so near. Angles are what their cosine and sine say. *)
Definition legs_recover (k : mobility) (nominal m : list driven) (P : vec) (Q : mat) (error b angle : number) : Prop :=
  forall rho, Forall2 (fun l r => is_off (value error) (own_joint l (carried l P Q)) r) nominal rho ->
  let is_at P' Q' := is_near_to k b angle P Q P' Q' /\ Forall2 (fun l r => own_reach l (carried l P' Q') /\ own_joint l (carried l P' Q') = r) m rho in
  exists P' Q', is_at P' Q' /\ forall P'' Q'', is_at P'' Q'' -> P'' = P' /\ Q'' = Q'.
(** The joint's acceleration, of angles in degrees: along every motion through the pose with the twist v, whose rate is a, row . twist, the joint's speed, has the derivative y. *)
Definition joint_unit (l : driven) (y : R) : R := match l with Linear _ => y | Rotary _ => in_degrees y end.
Definition leg_accelerates (k : mobility) (ell : R) (l : driven) (P : vec) (Q : mat) (v a : list R) (y : R) : Prop :=
  forall position turn velocity omega acceleration alpha, position 0 = P -> turn 0 = Q ->
    has_velocity position 0 (velocity 0) -> turns turn 0 (omega 0) -> has_velocity velocity 0 acceleration -> has_velocity omega 0 alpha -> has_velocities k (velocity 0) (omega 0) ->
    v = velocities k (velocity 0) (vscale ell (omega 0)) -> a = velocities k acceleration (vscale ell alpha) ->
    derivable_pt_lim (fun t => Linear.dot (driven_row k ell (position t) (turn t) l) (velocities k (velocity t) (vscale ell (omega t)))) 0 (joint_unit l y).
Definition legs_at (k : mobility) (ell : R) (nominal m : list driven) (P : vec) (Q : mat) : configuration :=
  Configuration (map (driven_row k ell P Q) m) (map (fun l => own_joint l (carried l P Q)) m) (map (driven_rod k P Q) m) [] (fun b => vadd P (mulv Q b))
    (fun i v a y => match nth_error m i with Some l => leg_accelerates k ell l P Q v a y | None => False end) (legs_recover k nominal m P Q)
    (Forall (fun l => own_reach l (carried l P Q)) m).

Definition well_formed_driven (l : driven) : Prop := match l with Linear k => well_formed_leg k | Rotary k => well_formed_arm k end.

(** A guard on the model: along any differentiable motion, the joint's coordinate changes at the speed row . twist. *)
Theorem driven_velocity : forall k ell l P Q t v omega, ell <> 0 -> well_formed_driven l -> own_reach l (carried l (P t) (Q t)) ->
  has_velocity P t v -> turns Q t omega -> has_velocities k v omega ->
  let rate := Linear.dot (driven_row k ell (P t) (Q t) l) (velocities k v (vscale ell omega)) in
  match l with
  | Linear i => derivable_pt_lim (fun u => joint i (carried l (P u) (Q u))) t rate
  | Rotary i => derivable_pt_lim (fun u => arm_cosine i (carried l (P u) (Q u))) t (- arm_sine i (carried l (P t) (Q t)) * rate) /\
      derivable_pt_lim (fun u => arm_sine i (carried l (P u) (Q u))) t (arm_cosine i (carried l (P t) (Q t)) * rate)
  end.
Proof.
  intros k ell l P Q t v omega e0 ok reach hP hQ hk. cbv zeta. set (r := mulv (Q t) (offset l)).
  assert (W : has_velocity (fun u => carried l (P u) (Q u)) t (vadd v (cross omega r))).
  { destruct hP as [p1 [p2 p3]]. destruct (hQ (offset l)) as [q1 [q2 q3]].
    assert (K : forall f g d e c, derivable_pt_lim f t d -> derivable_pt_lim g t e -> derivable_pt_lim (fun u => f u + g u - c) t (d + e)).
    { intros f g d e c hf hg. apply derivable_eq with (fun u => f u + g u + - c) (d + e + 0); try (intros; ring).
      apply derivable_add; [apply derivable_add; assumption | apply derivable_const]. }
    split; [| split]; unfold carried; cbn [vsub vadd vx vy vz] in *; apply K; assumption. }
  assert (E : Linear.dot (driven_row k ell (P t) (Q t) l) (velocities k v (vscale ell omega)) = Vec3.dot (own_row l (carried l (P t) (Q t))) (vadd v (cross omega r))).
  { unfold driven_row. cbv zeta. fold r. generalize (own_row l (carried l (P t) (Q t))) r. clear - e0 hk. intros [a b c] [p q s]. destruct v as [v1 v2 v3], omega as [o1 o2 o3].
    destruct k as [| | k]; cbn [has_velocities vz] in hk.
    - injection hk as -> -> ->. unfold Vec3.dot, vadd, vscale, cross. cbn. ring.
    - destruct hk as [-> hk]. injection hk as -> -> ->. unfold Vec3.dot, vadd, vscale, cross. cbn. ring.
    - destruct k; cbn [is_of vx vy vz] in hk.
      + destruct hk as [-> [-> ->]]. unfold Vec3.dot, vadd, vscale, cross. cbn. field. exact e0.
      + unfold Vec3.dot, vadd, vscale, cross. cbn. field. exact e0.
      + injection hk as -> -> ->. unfold Vec3.dot, vadd, vscale, cross. cbn. field. exact e0. }
  rewrite E. destruct l as [i | i]; cbn [own_row own_reach well_formed_driven] in *.
  - exact (row_is_derivative i _ t _ ok reach W).
  - exact (angle_velocity i _ t _ ok reach W).
Qed.

(** ** Claims *)

Inductive any_drive := LinearDrive (d : drive) | RotaryDrive (d : arm_drive).
Definition is_driven (d : any_drive) (l : driven) : Prop :=
  match d, l with LinearDrive d, Linear l => is_leg_of d l | RotaryDrive d, Rotary l => is_arm d l | _, _ => False end.

(** In the middle of the tolerances. *)
Definition nominal_driven (d : any_drive) : driven :=
  match d with
  | LinearDrive d => Linear (nominal_leg d)
  | RotaryDrive d => let k := normalised (middles (axis_within d)) in
      Rotary (Arm k (normalised (orthogonal_part k (middles (reference_within d)))) (middles (anchor_within d)) (middles (platform_within d)) (middle (arm_within d)) (middle (rod_within d))
        (if is_positive_mode d then 1 else -1))
  end.

(** In the plane z is 0 of all points; about a fixed point, the platform's is the origin. [only_pose]: no two poses of the workspace have the
    same joint coordinates. *)
Record driven_claim := MakeDrivenClaim {
  mobility_of : mobility; drives : list any_drive; length_of : number; place_of : region; turned_by : option orientations; driven_demands : list demand;
  only_pose : bool
}.
Definition is_pose (c : driven_claim) (P : vec) (Q : mat) : Prop :=
  in_region (place_of c) P /\ match turned_by c with Some o => in_orientations o Q | None => Q = midentity end.
Definition is_about_driven (c : driven_claim) (m : list driven) (P : vec) (Q : mat) : Prop := Forall2 is_driven (drives c) m /\ is_pose c P Q.
Definition meets_driven (c : driven_claim) (m : list driven) (P : vec) (Q : mat) : Prop :=
  Configuration.meets (freedom (mobility_of c)) (legs_at (mobility_of c) (value (length_of c)) (map nominal_driven (drives c)) m P Q) (driven_demands c).

(** Every machine of the claim can be built, and meets it in every pose. *)
Definition driven_holds (c : driven_claim) : Prop := forall m P Q, is_about_driven c m P Q -> Forall well_formed_driven m /\ meets_driven c m P Q /\
  (only_pose c = true -> forall P' Q', is_pose c P' Q' -> Forall (fun l => own_joint l (carried l P' Q') = own_joint l (carried l P Q)) m -> P' = P /\ Q' = Q).

(** ** A machine and a pose in exact numbers *)

Inductive exact_driven := XLinear (l : exact_leg) | XRotary (l : exact_arm).
Definition driven_of (l : exact_driven) : driven := match l with XLinear k => Linear (leg_of k) | XRotary k => Rotary (arm_of k) end.

Definition nvelocities (k : mobility) (v w : numbers) : list number :=
  match k with Translates => [nx v; ny v; nz v] | TranslatesInPlane => [nx v; ny v] | Turns k => ntwist k v w end.
Definition xoffset (l : exact_driven) : numbers :=
  match l with
  | XLinear (ExactSlider _ _ p _ _ | ExactStrut _ p _) => p
  | XLinear (ExactPlanar _) => Numbers (0 // 1) (0 // 1) (0 // 1)
  | XRotary k => xplatform k
  end.

Section Pose.
Variables (k : mobility) (ell : number) (o : option orientations) (c : list number) (P : numbers).
Definition nturn (b : numbers) : numbers := match o with Some o => turn o c b | None => b end.
Definition xcarried (l : exact_driven) : numbers := each2 Minus (each2 Plus P (nturn (xoffset l))) (xoffset l).
Definition xdriven_row (l : exact_driven) : list number :=
  let u := match l with XLinear i => nrow i (xcarried l) | XRotary i => xrow i (xcarried l) end in
  nvelocities k u (scaled (Over (1 // 1) ell) (ncrossed (nturn (xoffset l)) u)).
(** A multiple of the row: by the leg's vector. *)
Definition xdriven_ray (l : exact_driven) : option (list number) :=
  let u := match l with XLinear i => nray i (xcarried l) | XRotary i => each2 Minus (each2 Plus (xcarried l) (xplatform i)) (xelbow i (xcarried l)) end in
  Some (nvelocities k u (scaled (Over (1 // 1) ell) (ncrossed (nturn (xoffset l)) u))).
Definition xdriven_joint (l : exact_driven) : ncoordinate :=
  match l with XLinear i => NLength (njoint i (xcarried l)) | XRotary i => NAngle (xcosine i (xcarried l)) (xsine i (xcarried l)) end.
Definition ncomponents (a : numbers) : list number := match k with Translates => [nx a; ny a; nz a] | TranslatesInPlane => [nx a; ny a] | Turns _ => [] end.
Definition xdriven_rod (l : exact_driven) : option nrod :=
  let C := xcarried l in
  match l with
  | XLinear (ExactSlider d a p len m) =>
      let eta := signed_root m (clearance2 d a p len C) in Some (NRod (ncomponents (each2 Plus (Witness.across d a p C) (scaled eta (unit_of d)))) eta len)
  | XLinear (ExactStrut a p k as i) => Some (NRod (ncomponents (nray i C)) (0 // 1) (Root (product (nray i C) (nray i C))))
  | XRotary i => Some (NRod (ncomponents (each2 Minus (each2 Plus C (xplatform i)) (xelbow i C))) (xeta i C) (xrod i))
  | _ => None
  end.
Definition xreserves (l : exact_driven) : list number :=
  match l with XLinear i => match reserve i (xcarried l) with Some x => [x] | None => [] end | XRotary i => [xclearance i (xcarried l)] end.
Definition exact_legs_at (ls : list exact_driven) : nconfiguration :=
  NConfiguration (map xdriven_row ls) (map xdriven_joint ls) (map xdriven_rod ls) [] (fun b => each2 Plus P (nturn b)) (flat_map xreserves ls) (map xdriven_ray ls).

Variable Q : mat.
Hypothesis is_turn : forall b, values (nturn b) = mulv Q (values b).

Lemma values_carried : forall l, values (xcarried l) = carried (driven_of l) (values P) Q.
Proof.
  intro l. assert (O : values (xoffset l) = offset (driven_of l)).
  { destruct l as [[d a p len m | a p q | d] | i]; try reflexivity. unfold values. cbn. unfold vzero. f_equal; lra. }
  unfold xcarried, carried. rewrite values_minus, values_plus, is_turn, O. reflexivity.
Qed.

Lemma exact_legs_stand : forall nominal ls, Forall well_formed_driven (map driven_of ls) -> stands_for (exact_legs_at ls) (legs_at k (value ell) nominal (map driven_of ls) (values P) Q).
Proof.
  assert (O : forall l, values (xoffset l) = offset (driven_of l)).
  { intros [[d a p len m | a p q | d] | i]; try reflexivity. unfold values. cbn. unfold vzero. f_equal; lra. }
  assert (Elbow : forall i C, values (each2 Minus (each2 Plus C (xplatform i)) (xelbow i C)) = Arm.rod (arm_of i) (values C)).
  { intros. unfold Arm.rod, elbow, xelbow. rewrite !values_minus, !values_plus, values_scaled, values_plus, !values_scaled, values_xzero, values_xquarter, value_xcosine, value_xsine. reflexivity. }
  intros nominal ls ok. split; [| split; [| split; [| split; [| split]]]]; cbn [jacobian joints rods limbs placed reached njacobian njoints nrods nlimbs nplaced reserves nrays exact_legs_at legs_at]; rewrite ?map_map.
  - apply map_ext. intro l. unfold driven_row, xdriven_row. cbv zeta. rewrite <- values_carried.
    assert (U : own_row (driven_of l) (values (xcarried l)) = values (match l with XLinear i => nrow i (xcarried l) | XRotary i => xrow i (xcarried l) end))
      by (destruct l as [i | i]; cbn [own_row driven_of]; [rewrite values_row | rewrite values_xrow]; reflexivity).
    assert (I : value (Over (1 // 1) ell) = / value ell) by (cbn [value]; unfold Rdiv; rewrite Rinv_1; ring).
    rewrite U, <- O, <- is_turn, <- I. destruct k as [| | []]; reflexivity.
  - apply map_ext. intro l. rewrite <- values_carried. destruct l as [i | i]; cbn [own_joint driven_of xdriven_joint coordinate_of];
      [rewrite value_joint | rewrite value_xcosine, value_xsine]; reflexivity.
  - apply map_ext. intro l. unfold driven_rod, xdriven_rod. cbv zeta. rewrite <- values_carried. destruct l as [[d a p len m | a p q | d] | i]; cbn [own_rod driven_of leg_of option_map]; try reflexivity.
    + unfold real_rod. cbn [nrod_vector nrod_eta nrod_size]. rewrite value_signed_root.
      destruct (values_vector (ExactSlider d a p len m) (xcarried (XLinear (ExactSlider d a p len m)))) as [e2 _]. cbn [leg_of vector_of nray] in e2.
      rewrite <- e2. f_equal. f_equal. unfold ncomponents. destruct k as [| | []]; reflexivity.
    + unfold real_rod. cbn [nrod_vector nrod_eta nrod_size value]. rewrite value_product.
      destruct (values_vector (ExactStrut a p q) (xcarried (XLinear (ExactStrut a p q)))) as [e2 _]. cbn [leg_of vector_of] in e2.
      rewrite e2, <- norm2_dot, <- e2. f_equal. f_equal; [unfold ncomponents; destruct k as [| | []]; reflexivity | lra].
    + unfold real_rod. cbn [nrod_vector nrod_eta nrod_size]. rewrite value_xeta.
      rewrite <- Elbow. f_equal. f_equal. unfold ncomponents. destruct k as [| | []]; reflexivity.
  - reflexivity.
  - intro b. rewrite values_plus, is_turn. reflexivity.
  - rewrite Forall_map. intro h. induction h as [| l ls h hs IH]; [split; constructor |]. inversion ok as [| ? ? ok1 ok2]; subst. destruct (IH ok2) as [IH1 IH2]. clear IH.
    rewrite <- values_carried in h. split.
    2: { cbn [map]. constructor; [| exact IH2]. unfold xdriven_ray. cbv zeta. cbn [is_ray]. unfold driven_row. cbv zeta. rewrite <- values_carried, <- O, <- is_turn.
      set (u := match l with XLinear i => _ | XRotary i => _ end). assert (U : exists q, q <> 0 /\ own_row (driven_of l) (values (xcarried l)) = vscale q (values u)).
      { destruct l as [i | i]; cbn [own_row driven_of own_reach well_formed_driven] in *; [exact (values_ray i _ h) |]. exists (/ (arm_length (arm_of i) * arm_eta (arm_of i) (values (xcarried (XRotary i))))).
        split; [| unfold u; rewrite Elbow; reflexivity]. pose proof (eta_squared _ _ ok1 h) as E. destruct ok1 as [_ [_ [_ [r0 _]]]]. unfold arm_reaches in h.
        apply Rinv_neq_0_compat, Rmult_integral_contrapositive_currified; [lra |]. intro z. rewrite z in E. lra. }
      destruct U as [q [q0 e]]. exists q. split; [exact q0 |]. rewrite e. generalize u (nturn (xoffset l)). intros u' b. clear.
      unfold velocities, nvelocities, twist, ntwist, coordinates, vscale, cross, scaled, ncrossed.
      destruct k as [| | []]; cbn [map vx vy vz nx ny nz values value]; repeat (apply f_equal2; [unfold Rdiv; rewrite ?Rinv_1; ring |]); reflexivity. }
    cbn [flat_map]. apply Forall_app. split; [| exact IH1]. destruct l as [i | i]; cbn [xreserves own_reach driven_of] in *.
    + destruct (reserve i (xcarried (XLinear i))) as [x |] eqn:e; [| constructor]. constructor; [| constructor]. apply Rnot_le_lt. intro n. exact (reserve_sound i _ x e n h).
    + constructor; [| constructor]. rewrite value_xclearance. exact h.
Qed.
End Pose.

Section Precision.
Variable bits : positive.

Definition is_exact_driven (d : any_drive) (l : exact_driven) : bool :=
  match d, l with LinearDrive d, XLinear l => is_exact bits d l | RotaryDrive d, XRotary l => is_exact_arm bits d l | _, _ => false end.
Fixpoint all_exact (ds : list any_drive) (ls : list exact_driven) : bool :=
  match ds, ls with
  | [], [] => true
  | d :: ds', l :: ls' => is_exact_driven d l && all_exact ds' ls'
  | _, _ => false
  end.
Definition is_exact_pose (c : driven_claim) (P : numbers) (t : list number) : bool :=
  is_in bits (place_of c) P && match turned_by c, t with Some o, _ => is_orientation bits o t | None, [] => true | None, _ => false end.

Lemma all_exact_sound : forall ds ls, all_exact ds ls = true -> Forall2 is_driven ds (map driven_of ls) /\ Forall well_formed_driven (map driven_of ls).
Proof.
  induction ds as [| d ds IH]; intros [| l ls] h; cbn [all_exact map] in *; try discriminate; [split; constructor |].
  apply andb_true_iff in h as [h1 h2]. destruct (IH ls h2). destruct d, l; try discriminate; cbn [is_exact_driven driven_of] in *;
    [destruct (is_exact_sound bits _ _ h1) | destruct (is_exact_arm_sound bits _ _ h1)]; split; constructor; assumption.
Qed.

Lemma is_exact_pose_sound : forall c P t, is_exact_pose c P t = true -> exists Q, is_pose c (values P) Q /\ forall b, values (nturn (turned_by c) t b) = mulv Q (values b).
Proof.
  intros c P t h. apply andb_true_iff in h as [p h]. unfold is_pose, nturn. destruct (turned_by c) as [o |].
  - destruct (is_orientation_sound bits _ _ h) as [Q [q1 q2]]. exists Q. split; [split; [exact (is_in_sound bits _ _ p) | exact q1] | exact q2].
  - exists midentity. split; [split; [exact (is_in_sound bits _ _ p) | reflexivity] |]. intro b. rewrite mulv_identity. reflexivity.
Qed.

(** Poses near another one have a test of each part. *)
Definition parts_near (k : mobility) : nat := match k with Turns (InPlane | InSpace) => 2 | _ => 1 end.
Definition refute_driven (c : driven_claim) (ls : list exact_driven) (P : numbers) (t : list number) (f : nfailure) : bool :=
  all_exact (drives c) ls && is_exact_pose c P t &&
  refutes bits (parts_near (mobility_of c)) (freedom (mobility_of c)) (exact_legs_at (mobility_of c) (length_of c) (turned_by c) t P ls) (driven_demands c) f.

(** A machine of the claim that can be built does not meet it in some pose of the workspace. *)
Theorem refute_driven_sound : forall c ls P t f, refute_driven c ls P t f = true ->
  exists m P Q, Forall well_formed_driven m /\ is_about_driven c m P Q /\ ~ meets_driven c m P Q.
Proof.
  intros c ls P t f h. apply andb_true_iff in h as [h r]. apply andb_true_iff in h as [h p]. destruct (all_exact_sound _ _ h) as [h1 h2].
  destruct (is_exact_pose_sound _ _ _ p) as [Q [q1 q2]]. exists (map driven_of ls), (values P), Q. split; [exact h2 |]. split; [split; assumption |].
  exact (refutes_sound bits _ _ _ _ _ _ (exact_legs_stand _ _ _ _ _ Q q2 _ ls h2) r).
Qed.
End Precision.
End Named.
