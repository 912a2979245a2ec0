(** * Two poses of legs in any motion with the same joint coordinates

    As in Twins.v. Angles are the same where the sine of their difference is zero,
    and its cosine positive. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Number Machine Witness Configuration Arm Orientation Turning Legs Singular Same Twins.
From Orthocert.kernel Require Linear.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** Two poses of the workspace, which one machine that can be built reaches with the same joint coordinates. *)
Definition has_two_poses {names : naming} (c : driven_claim) : Prop :=
  only_pose c = true /\ exists m P Q P' Q', Forall well_formed_driven m /\ is_about_driven c m P Q /\ is_pose c P' Q' /\
    Forall (fun l => own_reach l (carried l P Q) /\ own_reach l (carried l P' Q') /\ own_joint l (carried l P' Q') = own_joint l (carried l P Q)) m /\ ~ (P' = P /\ Q' = Q).

Section Meant.
Context {names : naming}.

Definition turned_at (o : option orientations) (c : list R) : mat := match o with Some o => orientation_at o c | None => midentity end.
Lemma values_nturn : forall o c b, values (nturn o c b) = mulv (turned_at o (map value c)) (values b).
Proof. intros [o |] c b; cbn [nturn turned_at]; [apply values_turned | rewrite mulv_identity; reflexivity]. Qed.
Lemma joint_at : forall o c P l, coordinate_of (xdriven_joint o c P l) = own_joint (driven_of l) (carried (driven_of l) (values P) (turned_at o (map value c))).
Proof.
  intros o c P l. rewrite <- (values_carried o c P _ (values_nturn o c)). destruct l as [i | i]; cbn [xdriven_joint coordinate_of own_joint driven_of]; [rewrite value_joint | rewrite value_xcosine, value_xsine]; reflexivity.
Qed.
Lemma reached_at : forall o c P l, Forall (fun x => 0 < value x) (xreserves o c P l) -> own_reach (driven_of l) (carried (driven_of l) (values P) (turned_at o (map value c))).
Proof.
  intros o c P l h. rewrite <- (values_carried o c P _ (values_nturn o c)). destruct l as [i | i]; cbn [xreserves own_reach driven_of] in *.
  - apply reserve_reaches. destruct (reserve i _); [inversion h; assumption | exact I].
  - inversion h as [| ? ? h1 _]; subst. rewrite value_xclearance in h1. exact h1.
Qed.
(** By how much the one is off; and what is positive where that of angles is less than a right angle. *)
Definition off_joint (x y : ncoordinate) : number :=
  match x, y with NLength a, NLength b => Minus a b | NAngle c s, NAngle c' s' => Minus (Times s c') (Times c s') | _, _ => 1 // 1 end.
Definition facing (x y : ncoordinate) : list number := match x, y with NAngle c s, NAngle c' s' => [Plus (Times c c') (Times s s')] | _, _ => [] end.
Lemma same_angles : forall c s c' s', c ^ 2 + s ^ 2 = 1 -> c' ^ 2 + s' ^ 2 = 1 -> s * c' - c * s' = 0 -> 0 < c * c' + s * s' -> c = c' /\ s = s'.
Proof.
  intros c s c' s' u v z p. assert (e : c * c' + s * s' = 1) by (assert ((c * c' + s * s') ^ 2 = 1) by (replace 1 with ((c ^ 2 + s ^ 2) * (c' ^ 2 + s' ^ 2) - (s * c' - c * s') ^ 2) by (rewrite u, v, z; ring); ring); nra).
  assert (Z : (c - c') ^ 2 + (s - s') ^ 2 = 0) by (replace ((c - c') ^ 2 + (s - s') ^ 2) with ((c ^ 2 + s ^ 2) + (c' ^ 2 + s' ^ 2) - 2 * (c * c' + s * s')) by ring; lra).
  pose proof (pow2_ge_0 (c - c')). pose proof (pow2_ge_0 (s - s')). split; apply Rminus_diag_uniq; apply Rsqr_0_uniq; unfold Rsqr; lra.
Qed.
Definition on_circle (x : coordinate) : Prop := match x with Angle c s => c ^ 2 + s ^ 2 = 1 | _ => True end.
Lemma same_joints : forall x y, value (off_joint x y) = 0 -> Forall (fun z => 0 < value z) (facing x y) -> on_circle (coordinate_of x) -> on_circle (coordinate_of y) -> coordinate_of x = coordinate_of y.
Proof.
  intros [a | c s |] [b | c' s' |] z f u v; cbn [off_joint facing coordinate_of on_circle value] in *; try lra; [f_equal; lra |].
  inversion f as [| ? ? p _]; subst. cbn [value] in p. destruct (same_angles _ _ _ _ u v z p) as [-> ->]. reflexivity.
Qed.
Lemma joint_on_circle : forall l C, well_formed_driven l -> own_reach l C -> on_circle (own_joint l C).
Proof. intros [l | l] C ok reach; [exact I | exact (proj1 (angle_splits l C ok reach))]. Qed.
End Meant.

Section Named.
Context {names : naming}.

Definition driven_numbers (l : exact_driven) : list number :=
  match l with
  | XLinear i => leg_numbers i
  | XRotary i => in_numbers (xaxis i) ++ in_numbers (xreference i) ++ in_numbers (xanchor i) ++ in_numbers (xplatform i) ++ [xarm i; xrod i]
  end.
Lemma driven_agrees : forall l other, @agrees names other (driven_numbers l) -> @driven_of other l = @driven_of names l.
Proof.
  intros [i | [k x a p r len m]] other h; cbn [driven_of driven_numbers xaxis xreference xanchor xplatform xarm xrod] in *; [exact (f_equal Linear (@leg_agrees names i other h)) |].
  apply Forall_app in h as [h1 h]. apply Forall_app in h as [h2 h]. apply Forall_app in h as [h3 h]. apply Forall_app in h as [h4 h]. inversion h as [| ? ? h5 h']; subst. inversion h' as [| ? ? h6 _]; subst.
  unfold arm_of. cbn [xaxis xanchor xplatform xarm xrod xmode]. rewrite !(@values_xpart other), !(@values_xpart names). cbn [xaxis xreference]. rewrite (@numbers_agree names _ _ h1), (@numbers_agree names _ _ h2), (@numbers_agree names _ _ h3), (@numbers_agree names _ _ h4), h5, h6. reflexivity.
Qed.

Definition joint_numbers (x : ncoordinate) : list number := match x with NLength x => [x] | NAngle c s => [c; s] | NUnknown => [] end.
Lemma steady_joint : forall x other, is_steady (joint_numbers x) = true -> @coordinate_of other x = @coordinate_of names x.
Proof.
  intros x other h. pose proof (@steady_agrees names _ h other) as A. destruct x as [x | c s |]; cbn [joint_numbers coordinate_of] in *; [inversion A as [| ? ? E _]; subst; rewrite E | inversion A as [| ? ? E A']; subst; inversion A' as [| ? ? E' _]; subst; rewrite E, E' |]; reflexivity.
Qed.

Section Precision.
Variable bits : positive.

Definition are_turned (o : option orientations) (t : list number) (least greatest : list Q) : bool :=
  match o with
  | Some o => Nat.eqb (length t) match o with TurnedBy _ => 1 | _ => 3 end && are_oriented bits o least greatest
  | None => Nat.eqb (length t) 0
  end.
(** The first [places] coordinates are those of the position. *)
Definition refute_same_driven (places : nat) (c : driven_claim) (ls : list exact_driven) (P : numbers) (t : list number) (least greatest : list Q) (C : list (list Q)) : bool :=
  let o := turned_by c in let X := somewhere 0 least greatest in let P' := placed_by (firstn places X) in let t' := skipn places X in
  only_pose c && all_exact bits (drives c) ls && is_exact_pose bits c P t && Nat.leb places 3 && Nat.eqb (length least) (places + length t) &&
  are_ordered least greatest && is_box_in bits (place_of c) (padded (firstn places least)) (padded (firstn places greatest)) && are_turned o t (skipn places least) (skipn places greatest) &&
  (is_beside bits (firstn places least) (firstn places greatest) (firstn places (in_numbers P)) ||
   match o with Some o => tells o && is_beside bits (skipn places least) (skipn places greatest) t | None => false end) &&
  forallb (fun l => let here := xdriven_joint o t P l in
    is_steady (driven_numbers l ++ joint_numbers here) && forallb (certainly bits true) (xreserves o t P l) &&
    forallb (is_certain bits (length least)) (xreserves o t' P' l ++ facing (xdriven_joint o t' P' l) here)) ls &&
  fits bits (map (fun l => off_joint (xdriven_joint o t' P' l) (xdriven_joint o t P l)) ls) C.

Theorem refute_same_driven_sound : forall places c ls P t least greatest C, refute_same_driven places c ls P t least greatest C = true -> has_two_poses c.
Proof.
  intros places c ls P t least greatest C h. unfold refute_same_driven in h. cbv zeta in h. set (o := turned_by c) in *. set (X := somewhere 0 least greatest) in *.
  apply andb_true_iff in h as [h fit]. apply andb_true_iff in h as [h each]. apply andb_true_iff in h as [h beside]. apply andb_true_iff in h as [h oriented]. apply andb_true_iff in h as [h box].
  apply andb_true_iff in h as [h ordered]. apply andb_true_iff in h as [h ll]. apply andb_true_iff in h as [h p3].
  apply andb_true_iff in h as [h pose]. apply andb_true_iff in h as [one s]. apply Nat.eqb_eq in ll. apply Nat.leb_le in p3. rewrite forallb_forall in each. split; [exact one |].
  destruct (all_exact_sound bits _ _ s) as [drives_ ok]. destruct (fits_sound bits _ _ fit) as [u [_ [_ zero]]]. rewrite Forall_map, Forall_forall in zero. pose proof (somewhere_between u _ _ ordered) as B. fold X in B.
  set (y := map (@value (spot u)) X) in *. assert (le : length least = length greatest) by (apply andb_true_iff in ordered as [l _]; apply Nat.eqb_eq, l).
  assert (lX : length y = length least) by (rewrite <- (Linear.related_length _ _ _ _ _ B), combine_length, <- le; apply Nat.min_id).
  destruct (in_two_parts places least greatest y B) as [B1 B2].
  set (P' := @values (spot u) (placed_by (firstn places X))). set (Q := turned_at o (map value t)). set (Q' := turned_at o (skipn places y)).
  assert (ey : map (@value (spot u)) (skipn places X) = skipn places y) by (unfold y; symmetry; apply skipn_map).
  assert (ep : map (@value (spot u)) (firstn places X) = firstn places y) by (unfold y; symmetry; apply firstn_map).
  exists (map driven_of ls), (values P), Q, P', Q'. unfold is_exact_pose in pose. fold o in pose. apply andb_true_iff in pose as [place ori]. apply is_in_sound in place.
  split; [exact ok |]. split.
  { split; [exact drives_ |]. split; [exact place |]. fold o. unfold Q. destruct o as [o' |]; [apply is_orientation_coordinate in ori; apply is_coordinate_sound, ori | reflexivity]. }
  split.
  { split.
    - assert (At : forall i, Q2R (nth i (firstn places least) 0%Q) <= @value (spot u) (nth i (firstn places X) (0 // 1)) <= Q2R (nth i (firstn places greatest) 0%Q)).
      { assert (E : forall i, @value (spot u) (nth i (firstn places X) (0 // 1)) = nth i (firstn places y) 0).
        { intro i. rewrite <- ep. assert (z : @value (spot u) (0 // 1) = 0) by (cbn; lra). rewrite <- z. symmetry. apply map_nth. }
        intro i. rewrite E. apply at_each; [exact B1 | rewrite !firstn_length, le; reflexivity]. }
      unfold P', placed_by, values. cbn [nx ny nz]. unfold padded in box. apply (is_box_in_sound _ _ _ _ _ _ _ _ _ _ _ box); apply At.
    - fold o. unfold Q', are_turned in *. destruct o as [o' |]; [| reflexivity]. apply andb_true_iff in oriented as [_ oriented]. exact (are_oriented_sound _ _ _ _ _ oriented B2). }
  split.
  - rewrite Forall_map, Forall_forall. intros l il. specialize (each l il). cbv zeta in each. apply andb_true_iff in each as [each sure]. apply andb_true_iff in each as [k near_]. apply steady_app in k as [k0 k1].
    rewrite forallb_app in sure. apply andb_true_iff in sure as [far_ face].
    assert (L : @driven_of (spot u) l = driven_of l) by (apply driven_agrees, steady_agrees, k0).
    assert (R0 : own_reach (driven_of l) (carried (driven_of l) (values P) Q)).
    { apply reached_at, Forall_forall. intros x ix. rewrite forallb_forall in near_. exact (positive_sound bits _ (near_ x ix)). }
    assert (R1 : own_reach (driven_of l) (carried (driven_of l) P' Q')).
    { rewrite <- L. unfold Q'. rewrite <- ey. apply (@reached_at (spot u)), Forall_forall. intros x ix. rewrite forallb_forall in far_. exact (is_certain_sound bits _ u x (far_ x ix)). }
    split; [exact R0 |]. split; [exact R1 |]. pose proof (joint_at o t P l) as J0. fold Q in J0. pose proof (@joint_at (spot u) o (skipn places X) (placed_by (firstn places X)) l) as J1. rewrite L, ey in J1. fold P' Q' in J1.
    specialize (zero l il). rewrite <- (steady_joint _ (spot u) k1) in J0. set (here := xdriven_joint o t P l) in *. set (there := xdriven_joint o (skipn places X) (placed_by (firstn places X)) l) in *.
    assert (OK : well_formed_driven (driven_of l)) by (rewrite Forall_map, Forall_forall in ok; exact (ok l il)).
    assert (S : @coordinate_of (spot u) there = @coordinate_of (spot u) here).
    { apply same_joints; [exact zero | | rewrite J1; apply joint_on_circle; assumption | rewrite J0; apply joint_on_circle; assumption].
      apply Forall_forall. intros x ix. rewrite forallb_forall in face. exact (is_certain_sound bits _ u x (face x ix)). }
    rewrite J0, J1 in S. exact S.
  - intros [e1 e2]. apply orb_true_iff in beside as [b | b].
    + apply (is_beside_sound _ _ _ _ _ b B1). rewrite <- ep, <- (firstn_map (@value names)). change (map value (in_numbers P)) with [vx (values P); vy (values P); vz (values P)]. rewrite <- e1. unfold P', placed_by, values. cbn [nx ny nz].
      assert (l : length (firstn places X) = places) by (rewrite firstn_length; unfold y in lX; rewrite map_length in lX; lia).
      clear - l p3. destruct (firstn places X) as [| x1 [| x2 [| x3 [|]]]]; cbn [length] in l; subst places; try reflexivity. cbn in p3. lia.
    + unfold are_turned in oriented. unfold Q, Q' in e2. destruct o as [o' |]; [| discriminate]. apply andb_true_iff in oriented as [lt _]. apply Nat.eqb_eq in lt. apply andb_true_iff in b as [tell b].
      apply (is_beside_sound _ _ _ _ _ b B2). apply (tells_sound o'); [exact tell | rewrite map_length; exact lt | rewrite map_length, skipn_length; lia | exact e2].
Qed.
End Precision.
End Named.
