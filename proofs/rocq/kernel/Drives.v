(** * Legs in any motion as formulas: that they are the kinematics

    The formulas are those of machine/mod.rs and machine/motion.rs; [s]: lengths
    are divided by 2^s. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Elbow Statement Linear Test Number Formula Machine Problem Witness Orientation Turning Control Chart Bend Onward Pose Configuration Arm Legs Poses.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** A leg by the way from its base end to the platform's joint *)

Inductive ejoint := ELength (f : formula) | EAngle (c s : formula) | EUnknown.
(** A_i, D_i, the row divided by B_i; of legs of fixed length eta^2 and the length; and what is defined of a leg that can be built. *)
Record drive_formulas := DriveFormulas { b_A : evec; b_D : formula; b_divided : evec; b_joint : ejoint; b_rod : option (formula * formula); b_built : list formula }.

(** [d]: a direction, of any length but zero. *)
Definition slider_drive (w d : evec) (len : formula) (mode : bool) : drive_formulas :=
  let f := slider_formulas w (unit_vector d) w len mode in
  DriveFormulas (f_A f) (f_D f) (f_divided f) (ELength (f_joint f)) (Some (f_D f, len)) [root (Machine.product d d); root len].
Definition strut_drive (w : evec) (axis : option evec) : drive_formulas :=
  let f := strut_formulas w w None in
  DriveFormulas (f_A f) (f_D f) (f_divided f) (ELength (f_joint f)) (Some (integer 0, f_joint f)) (match axis with Some k => [root (Machine.product k k)] | None => [] end).
Definition plane_drive (w d : evec) : drive_formulas :=
  let f := planar_formulas w (unit_vector d) in
  DriveFormulas (f_A f) (f_D f) (f_divided f) (ELength (f_joint f)) None [root (Machine.product d d)].
Definition arm_part (k x : evec) : evec := map2 minus x (Machine.scaled (Machine.product k x) k).
Definition arm_drive_formulas (w axis reference : evec) (r len : formula) (mode : bool) : drive_formulas :=
  let k := unit_vector axis in let y := arm_part k reference in let e := unit_vector y in let f := ecross k e in
  let alpha := Machine.product w e in let beta := Machine.product w f in let kappa := Machine.product k w in
  let n := plus (square alpha) (square beta) in
  let x := minus (square len) (square kappa) in
  let g := over (plus n (minus (square r) x)) (times (integer 2) r) in
  let d := minus n (square g) in
  let eta := signed mode (times r (root d)) in
  let a := over alpha r in let b := signed mode (over beta r) in let t := over x (square r) in
  let c := elbow_of false a b t in let s := signed mode (elbow_of true a b t) in
  let A := map2 minus w (Machine.scaled r (map2 plus (Machine.scaled c e) (Machine.scaled s f))) in
  DriveFormulas A (times (square r) d) (divided_by A eta) (EAngle c s) (Some (d, len))
    [root (Machine.product axis axis); root (Machine.product y y); root r; root len].

(** Rates of lengths are those in any unit; those of angles are over a length. *)
Definition rate_unit (s : Z) (l : driven) : R := match l with Linear _ => 1 | Rotary _ => two_to s end.

Section Values.
Variables x theta : list R.
Variable s : Z.
Local Notation value := (Formula.value x theta).
Local Notation val3 := (val3 x theta).
Local Notation defined := (Formula.defined x theta).
Let u := / two_to s.

Lemma val3_unit : forall a, val3 (unit_vector a) = normalised (val3 a).
Proof. intro a. unfold unit_vector, normalised. rewrite val3_divided, value_root, value_dot, norm2_dot. reflexivity. Qed.
Lemma value_signed' : forall (mode : bool) a, value (signed mode a) = (if mode then 1 else -1) * value a.
Proof. intros [|] a; cbn [signed]; rewrite ?value_opposite; ring. Qed.
Lemma defined_root' : forall a, defined (root a) -> 0 < value a.
Proof. intros a. unfold root. destruct (is 1 a) eqn:q; [rewrite (is_value _ _ _ _ q); intros; lra | intros [h _]; exact h]. Qed.

Lemma defined_opposite : forall a, defined (opposite a) -> defined a.
Proof.
  intros [o] h. unfold opposite in h. destruct o; try exact (proj2 h); [split; exact I | split; [exact I | exact h]].
Qed.
Lemma defined_minus : forall a b, defined (minus a b) -> defined b.
Proof.
  intros a b. unfold minus. destruct (is 0 b) eqn:q; [intros _; exact (is_defined _ _ _ _ q) |]. destruct (is 0 a); [apply defined_opposite |].
  destruct a as [o]. destruct b as [o']. destruct o; try (intros [_ [_ h]]; exact h). destruct o'; try (intros [_ [_ h]]; exact h). intros _. split; exact I.
Qed.
Lemma defined_end : forall a (mode : bool) d, defined (minus a (signed mode (root d))) -> 0 < value d.
Proof.
  intros a mode d h. apply defined_minus in h. apply defined_root'. destruct mode; cbn [signed] in h; [exact h | apply defined_opposite, h].
Qed.

Definition joint_is (e : ejoint) (c : coordinate) : Prop :=
  match e, c with
  | ELength f, Length rho => value f = u * rho
  | EAngle a b, Angle c s => value a = c /\ value b = s
  | EUnknown, Unknown => True
  | _, _ => False
  end.

Definition joint_forms (j : ejoint) : list formula := match j with ELength f => [f] | EAngle c s => [c; s] | EUnknown => [] end.
(** Formulas of a drive are those of the leg, at C. *)
Definition drives_as (b : drive_formulas) (l : driven) (C : vec) : Prop :=
  (Forall defined (b_built b) -> well_formed_driven l) /\
  (well_formed_driven l ->
    (0 < value (b_D b) -> own_reach l C) /\ (own_reach l C -> 0 < value (b_D b)) /\ (defined (ex (b_divided b)) -> own_reach l C) /\ (Forall defined (joint_forms (b_joint b)) -> own_reach l C) /\
    (own_reach l C ->
      (exists q, q ^ 2 = value (b_D b) /\ val3 (b_A b) = vscale (q * rate_unit s l) (own_row l C)) /\
      val3 (b_divided b) = vscale (rate_unit s l) (own_row l C) /\ joint_is (b_joint b) (own_joint l C) /\
      match b_rod b with
      | Some (e2, len) => exists A eta L, own_rod l C = Some (A, eta, L) /\ value e2 = (u * eta) ^ 2 /\ value len = u * L /\ val3 (b_A b) = vscale u A
      | None => True
      end /\ (is_plane l \/ val3 (b_A b) = vscale u (vsub (vadd C (offset l)) (driven_end l C))))).

Lemma u_pos : 0 < u.
Proof. apply Rinv_0_lt_compat, two_to_pos. Qed.

Lemma slider_drives : forall w d len (mode : bool) l C v,
  val3 w = vscale u (Kinematics.w l C) -> axis l = normalised v -> (exists c, 0 < c /\ val3 d = vscale c v) -> value len = u * leg_length l ->
  working_mode l = (if mode then 1 else -1) -> drives_as (slider_drive w d len mode) (Linear (Guided l)) C.
Proof.
  pose proof u_pos as u0. intros w d len mode l C v hw ha [c [c0 hd]] hl hm.
  assert (hn : val3 (unit_vector d) = axis l) by (rewrite val3_unit, hd, ha; apply normalised_resized, c0).
  unfold slider_drive, slider_formulas. cbn zeta. cbn [f_A f_D f_divided f_joint].
  set (n := unit_vector d) in *. set (er := map2 minus w (Machine.scaled (Machine.product n w) n)). set (ed := minus (square len) (Machine.product er er)).
  set (ee := signed mode (root ed)).
  assert (R : val3 er = vscale u (r l C)).
  { unfold er, r. rewrite val3_minus, val3_scaled, value_dot, hn, hw. unfold vsub, vscale, Vec3.dot. cbn [vx vy vz]. f_equal; ring. }
  assert (D : value ed = u ^ 2 * (leg_length l ^ 2 - norm2 (r l C))).
  { unfold ed. rewrite value_minus, Formula.value_square, value_dot, R, hl, <- norm2_dot, norm2_scale. ring. }
  assert (E : value ee = u * eta l C).
  { unfold ee, eta, Kinematics.s. rewrite value_signed', value_root, D, hm, sqrt_resized by exact u0. ring. }
  assert (T : 0 < value ed -> 0 < Kinematics.s l C).
  { rewrite D. intro h. apply sqrt_lt_R0. apply Rmult_lt_reg_l with (u ^ 2); [apply pow_lt, u0 | lra]. }
  split; [| intro ok; split; [| split; [| split]]]; cbn [b_built b_D b_divided b_A b_joint b_rod own_reach own_row own_joint own_rod reaches row joint rate_unit well_formed_driven well_formed_leg].
  - intro h. inversion h as [| ? ? h1 h2]; subst. inversion h2 as [| ? ? h3 _]; subst. apply defined_root' in h1, h3.
    rewrite value_dot, hd, <- norm2_dot, norm2_scale in h1. rewrite hl in h3. pose proof (pow_lt c 2 c0).
    assert (n0 : 0 < norm2 v) by (apply Rmult_lt_reg_l with (c ^ 2); lra). unfold well_formed. rewrite ha, hm. split; [apply normalised_norm, n0 |].
    split; [apply Rmult_lt_reg_l with u; lra | destruct mode; auto].
  - exact T.
  - intro h. rewrite D. apply Rmult_lt_0_compat; [apply pow_lt, u0 |]. unfold Kinematics.s in h. destruct (Rlt_le_dec 0 (leg_length l ^ 2 - norm2 (r l C))) as [p | q]; [exact p |].
    rewrite sqrt_neg_0 in h by exact q. lra.
  - intro h. cbn [map2 ex] in h. apply defined_plus in h as [_ h]. cbn [divided_by ex] in h. apply defined_over in h. rewrite E in h.
    unfold eta in h. destruct (sqrt_pos (leg_length l ^ 2 - norm2 (r l C))) as [p | z]; [exact p |]. exfalso. apply h. unfold Kinematics.s. rewrite <- z. ring.
  - split.
    { cbn [joint_forms]. intro h. apply T. exact (defined_end _ mode ed (Forall_inv h)). }
    intro reach. pose proof (eta_nonzero l C ok reach) as e0.
    assert (Sq : value ed = (u * eta l C) ^ 2).
    { rewrite D. unfold eta. rewrite !Rpow_mult_distr, (s_squared l C reach), hm. destruct mode; ring. }
    assert (A : val3 (map2 plus er (Machine.scaled ee n)) = vscale u (leg_vector l C)).
    { rewrite val3_plus, val3_scaled, R, E, hn, leg_vector_eq. unfold vadd, vscale. cbn [vx vy vz]. f_equal; ring. }
    split; [| split; [| split; [| split; [| right; exact A]]]].
    + exists (u * eta l C). split; [symmetry; exact Sq |]. rewrite A, leg_vector_eq. unfold Jinv_row. generalize (r l C) (axis l). intros p q.
      unfold vadd, vscale. cbn [vx vy vz]. f_equal; field; exact e0.
    + rewrite val3_plus, val3_divided, R, E, hn. unfold Jinv_row. generalize (r l C) (axis l). intros p q. unfold vadd, vscale. cbn [vx vy vz]. f_equal; field; split; try exact e0; lra.
    + cbn [joint_is]. rewrite value_minus, value_dot, hn, hw, E. unfold rho. unfold Vec3.dot, vscale. cbn [vx vy vz]. ring.
    + exists (leg_vector l C), (eta l C), (leg_length l). split; [reflexivity |]. split; [exact Sq |]. split; [exact hl | exact A].
Qed.

Lemma strut_drives : forall w axis base platform ax C, val3 w = vscale u (span base platform C) ->
  match axis, ax with Some a, Some k => exists c v, 0 < c /\ val3 a = vscale c v /\ k = normalised v | None, None => True | _, _ => False end ->
  drives_as (strut_drive w axis) (Linear (Extensible base platform ax)) C.
Proof.
  pose proof u_pos as u0. intros w axis base platform ax C hw hk. unfold strut_drive, strut_formulas. cbn zeta. cbn [f_A f_D f_divided f_joint].
  assert (D : value (Machine.product w w) = u ^ 2 * norm2 (span base platform C)) by (rewrite value_dot, hw, <- norm2_dot, norm2_scale; reflexivity).
  assert (L : value (root (Machine.product w w)) = u * sqrt (norm2 (span base platform C))) by (rewrite value_root, D; apply sqrt_resized, u0).
  assert (T : 0 < value (Machine.product w w) -> 0 < norm2 (span base platform C)).
  { rewrite D. intro h. apply Rmult_lt_reg_l with (u ^ 2); [apply pow_lt, u0 | lra]. }
  split; [| intros _; split; [| split; [| split]]]; cbn [b_built b_D b_divided b_A b_joint b_rod own_reach own_row own_joint own_rod reaches row joint rate_unit well_formed_driven well_formed_leg].
  - intro h. destruct axis as [a |], ax as [k |]; try contradiction; [| exact I]. destruct hk as [c [v [c0 [ha ->]]]]. inversion h as [| ? ? h1 _]; subst. apply defined_root' in h1.
    rewrite value_dot, ha, <- norm2_dot, norm2_scale in h1. pose proof (pow_lt c 2 c0). apply normalised_norm. apply Rmult_lt_reg_l with (c ^ 2); lra.
  - exact T.
  - intro h. rewrite D. apply Rmult_lt_0_compat; [apply pow_lt, u0 | exact h].
  - cbn [divided_by ex]. intro h. apply defined_over in h. rewrite L in h. destruct (norm2_nonneg (span base platform C)) as [p | z]; [exact p |].
    exfalso. apply h. rewrite <- z, sqrt_0. ring.
  - split; [cbn [joint_forms]; intro h; exact (T (defined_root' _ (Forall_inv h))) |]. intro reach. pose proof (sqrt_lt_R0 _ reach) as s0. assert (S : sqrt (norm2 (span base platform C)) ^ 2 = norm2 (span base platform C)) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra).
    split; [| split; [| split; [exact L | split; [| right; exact hw]]]].
    + exists (u * sqrt (norm2 (span base platform C))). split; [rewrite D, Rpow_mult_distr, S; reflexivity |]. rewrite hw. unfold normalised. set (h := span base platform C) in *. clearbody h. unfold vscale. cbn [vx vy vz]. f_equal; field; lra.
    + rewrite val3_divided, L, hw. unfold normalised. set (h := span base platform C) in *. clearbody h. unfold vscale. cbn [vx vy vz]. f_equal; field; lra.
    + exists (span base platform C), 0, (sqrt (norm2 (span base platform C))). split; [reflexivity |]. split; [cbn; ring |]. split; [exact L | exact hw].
Qed.

Lemma plane_drives : forall w d n C, val3 w = vscale u C -> (exists c, 0 < c /\ val3 d = vscale c n) -> drives_as (plane_drive w d) (Linear (Plane n)) C.
Proof.
  intros w d n C hw [c [c0 hd]]. unfold plane_drive, planar_formulas. cbn [f_A f_D f_divided f_joint].
  assert (hn : val3 (unit_vector d) = normalised n) by (rewrite val3_unit, hd; apply normalised_resized, c0).
  split; [| intros _; split; [| split; [| split]]]; cbn [b_built b_D b_divided b_A b_joint b_rod own_reach own_row own_joint own_rod reaches row joint rate_unit well_formed_driven well_formed_leg]; auto.
  - intros h z. subst n. inversion h as [| ? ? h1 _]; subst. apply defined_root' in h1. rewrite value_dot, hd in h1. unfold Vec3.dot, vscale, vzero in h1. cbn in h1. lra.
  - intros _. cbn. lra.
  - split; [intros _; exact I |]. intros _. split; [exists 1; split; [cbn; ring |]; rewrite hn; unfold vscale; destruct (normalised n) as [n1 n2 n3]; cbn [vx vy vz]; f_equal; ring |].
    split; [rewrite hn; unfold vscale; destruct (normalised n) as [n1 n2 n3]; cbn [vx vy vz]; f_equal; ring |]. split; [| split; [exact I | left; exact I]].
    cbn [joint_is]. rewrite value_dot, hn, hw. unfold Vec3.dot, vscale. cbn [vx vy vz]. ring.
Qed.

Lemma dot_swapped : forall a b, Vec3.dot a b = Vec3.dot b a.
Proof. intros. unfold Vec3.dot. ring. Qed.
Lemma dot_scaled : forall c a b, Vec3.dot a (vscale c b) = c * Vec3.dot a b.
Proof. intros. unfold Vec3.dot, vscale. cbn [vx vy vz]. ring. Qed.

Lemma arm_drives : forall w axis reference r len (mode : bool) l C v y,
  val3 w = vscale u (from_motor l C) -> (exists c, 0 < c /\ val3 axis = vscale c v) -> (exists c, 0 < c /\ val3 reference = vscale c y) ->
  motor_axis l = normalised v -> motor_zero l = normalised (orthogonal_part (normalised v) y) -> value r = u * arm_length l -> value len = u * rod_length l ->
  arm_mode l = (if mode then 1 else -1) -> drives_as (arm_drive_formulas w axis reference r len mode) (Rotary l) C.
Proof.
  pose proof u_pos as u0. intros w axis reference r len mode l C v y hw [c1 [c10 ha]] [c2 [c20 hy]] hk he hr hL hm.
  assert (Ek : val3 (unit_vector axis) = motor_axis l) by (rewrite val3_unit, ha, hk; apply normalised_resized, c10).
  assert (Ey : val3 (arm_part (unit_vector axis) reference) = vscale c2 (orthogonal_part (normalised v) y)).
  { unfold arm_part, orthogonal_part. rewrite val3_minus, val3_scaled, value_dot, Ek, hk, hy. unfold vsub, vscale, Vec3.dot. cbn [vx vy vz]. f_equal; ring. }
  assert (Ee : val3 (unit_vector (arm_part (unit_vector axis) reference)) = motor_zero l) by (rewrite val3_unit, Ey, he; apply normalised_resized, c20).
  unfold arm_drive_formulas. cbv zeta. set (k := unit_vector axis) in *. set (e := unit_vector (arm_part k reference)) in *. set (f := ecross k e).
  assert (Ef : val3 f = quarter l) by (unfold f; rewrite val3_cross, Ek, Ee; reflexivity).
  set (alpha := Machine.product w e). set (beta := Machine.product w f). set (kappa := Machine.product k w).
  set (n := plus (square alpha) (square beta)). set (xq := minus (square len) (square kappa)). set (g := over (plus n (minus (square r) xq)) (times (integer 2) r)).
  set (d := minus n (square g)). set (sg := signed mode (times r (root d))). set (a := over alpha r). set (bl := signed mode (over beta r)). set (tq := over xq (square r)).
  set (ec := elbow_of false a bl tq). set (es := signed mode (elbow_of true a bl tq)).
  set (A := map2 minus w (Machine.scaled r (map2 plus (Machine.scaled ec e) (Machine.scaled es f)))).
  set (N0 := along l C ^ 2 + across l C ^ 2).
  assert (two : value (integer 2) = 2) by reflexivity. assert (one : value (integer 1) = 1) by reflexivity.
  split; [| intro ok].
  - cbn [b_built well_formed_driven]. intro h. inversion h as [| ? ? h1 H]; subst. inversion H as [| ? ? h2 H']; subst. inversion H' as [| ? ? h3 H'']; subst. inversion H'' as [| ? ? h4 _]; subst.
    apply defined_root' in h1, h2, h3, h4. rewrite value_dot, ha, <- norm2_dot, norm2_scale in h1. rewrite value_dot, Ey, <- norm2_dot, norm2_scale in h2. rewrite hr in h3. rewrite hL in h4.
    pose proof (pow_lt c1 2 c10). pose proof (pow_lt c2 2 c20). assert (n1 : 0 < norm2 v) by (apply Rmult_lt_reg_l with (c1 ^ 2); lra).
    assert (n2 : 0 < norm2 (orthogonal_part (normalised v) y)) by (apply Rmult_lt_reg_l with (c2 ^ 2); lra).
    unfold well_formed_arm. rewrite hk, he, hm. split; [apply normalised_norm, n1 |]. split; [apply normalised_norm, n2 |]. split; [| split; [| split]].
    + pose proof (normalised_norm v n1) as un. set (z := normalised v) in *. clearbody z. unfold normalised. set (t := / sqrt _). clearbody t. unfold orthogonal_part.
      assert (E : Vec3.dot z (vscale t (vsub y (vscale (Vec3.dot z y) z))) = t * (Vec3.dot z y * (1 - norm2 z))) by (clear; vec_ring). rewrite E, un. ring.
    + apply Rmult_lt_reg_l with u; lra.
    + apply Rmult_lt_reg_l with u; lra.
    + destruct mode; auto.
  - assert (ok' := ok). destruct ok' as [k1 [e1' [ke [r0 [L0 _]]]]]. cbn [b_D b_divided b_A b_joint b_rod own_reach own_row own_joint own_rod rate_unit].
    assert (Val : value alpha = u * along l C) by (unfold alpha; rewrite value_dot, hw, Ee, dot_swapped, dot_scaled; reflexivity).
    assert (Vbe : value beta = u * across l C) by (unfold beta; rewrite value_dot, hw, Ef, dot_swapped, dot_scaled; reflexivity).
    assert (Vk : value kappa = u * height l C) by (unfold kappa; rewrite value_dot, hw, Ek, dot_scaled; reflexivity).
    assert (Vn : value n = u ^ 2 * N0) by (unfold n; rewrite value_plus, !Formula.value_square, Val, Vbe; unfold N0; ring).
    assert (Vx : value xq = u ^ 2 * (rod_length l ^ 2 - height l C ^ 2)) by (unfold xq; rewrite value_minus, !Formula.value_square, Vk, hL; ring).
    assert (Vg : value g = u * forward l C).
    { unfold g. rewrite value_over, value_plus, value_minus, value_times, Formula.value_square, Vn, Vx, hr, two. unfold forward. fold N0. field. split; lra. }
    assert (Cl : N0 - forward l C ^ 2 = clearance l C) by (unfold clearance, forward; fold N0; field; lra).
    assert (Vd : value d = u ^ 2 * clearance l C) by (unfold d; rewrite value_minus, Formula.value_square, Vn, Vg, <- Cl; ring).
    assert (Va : value a = along l C / arm_length l) by (unfold a; rewrite value_over, Val, hr; field; split; lra).
    assert (Vt : value tq = (rod_length l ^ 2 - height l C ^ 2) / arm_length l ^ 2) by (unfold tq; rewrite value_over, Formula.value_square, Vx, hr; field; split; lra).
    assert (Vs : value sg = u ^ 2 * (arm_length l * arm_eta l C)).
    { unfold sg, arm_eta. rewrite value_signed', value_times, value_root, Vd, hr, hm, sqrt_resized by exact u0. ring. }
    assert (VD : value (times (square r) d) = u ^ 4 * (arm_length l ^ 2 * clearance l C)) by (rewrite value_times, Formula.value_square, Vd, hr; ring).
    pose proof (pow_lt u 4 u0) as u4. pose proof (pow_lt _ 2 r0) as r2.
    split; [| split; [| split]].
    + rewrite VD. intro h. unfold arm_reaches. apply Rmult_lt_reg_l with (u ^ 4 * arm_length l ^ 2); [apply Rmult_lt_0_compat; assumption | lra].
    + intro h. rewrite VD. apply Rmult_lt_0_compat; [exact u4 |]. apply Rmult_lt_0_compat; assumption.
    + cbn [divided_by ex]. intro h. apply defined_over in h. rewrite Vs in h. unfold arm_reaches. apply Rnot_le_lt. intro z. apply h. unfold arm_eta. rewrite sqrt_neg_0 by exact z. ring.
    + split.
      { cbn [joint_forms]. intro h. inversion h as [| ? ? h1 _]; subst. destruct h1 as [rad _]. cbn [map_op defined_op] in rad. unfold arm_reaches.
        assert (mm : arm_mode l * arm_mode l = 1) by (rewrite hm; destruct mode; ring).
        assert (Vbl : value bl = arm_mode l * (across l C / arm_length l)) by (unfold bl; rewrite value_signed', value_over, Vbe, hr, hm; field; split; lra).
        assert (E : elbow_radicand (value a) (value bl) (value tq) = (2 / arm_length l) ^ 2 * clearance l C).
        { unfold elbow_radicand. replace (value a ^ 2 + value bl ^ 2) with (N0 / arm_length l ^ 2)
            by (rewrite Va, Vbl; unfold N0; replace ((arm_mode l * (across l C / arm_length l)) ^ 2) with (arm_mode l * arm_mode l * (across l C / arm_length l) ^ 2) by ring; rewrite mm; field; lra).
          rewrite Vt, <- Cl. unfold forward. fold N0. field. lra. }
        rewrite E in rad. apply Rmult_lt_reg_l with ((2 / arm_length l) ^ 2); [apply pow_lt, Rdiv_lt_0_compat; lra | lra]. }
      intro reach. destruct (distance_split l C ok reach) as [_ NN]. fold N0 in NN. pose proof (eta_squared l C ok reach) as E2.
      assert (h0 : arm_eta l C <> 0) by (intro z; rewrite z in E2; unfold arm_reaches in reach; lra).
      assert (Vbl : value bl = arm_mode l * (across l C / arm_length l)) by (unfold bl; rewrite value_signed', value_over, Vbe, hr, hm; field; split; lra).
      assert (mm : arm_mode l * arm_mode l = 1) by (rewrite hm; destruct mode; ring).
      assert (Rad : sqrt (elbow_radicand (value a) (value bl) (value tq)) = 2 * sqrt (clearance l C) / arm_length l).
      { assert (E : elbow_radicand (value a) (value bl) (value tq) = (2 / arm_length l) ^ 2 * clearance l C).
        { unfold elbow_radicand. replace (value a ^ 2 + value bl ^ 2) with (N0 / arm_length l ^ 2)
            by (rewrite Va, Vbl; unfold N0; replace ((arm_mode l * (across l C / arm_length l)) ^ 2) with (arm_mode l * arm_mode l * (across l C / arm_length l) ^ 2) by ring; rewrite mm; field; lra).
          rewrite Vt, <- Cl. unfold forward. fold N0. field. lra. }
        rewrite E, sqrt_resized by (apply Rdiv_lt_0_compat; lra). field. lra. }
      assert (Nn : value a ^ 2 + value bl ^ 2 = N0 / arm_length l ^ 2)
        by (rewrite Va, Vbl; unfold N0; replace ((arm_mode l * (across l C / arm_length l)) ^ 2) with (arm_mode l * arm_mode l * (across l C / arm_length l) ^ 2) by ring; rewrite mm; field; lra).
      assert (Q : value a ^ 2 + value bl ^ 2 + 1 - value tq = 2 * (forward l C / arm_length l)) by (rewrite Nn, Vt; unfold forward; fold N0; field; lra).
      assert (Vc : value ec = arm_cosine l C).
      { change (value ec) with (fst (Elbow.elbow (value a) (value bl) (value tq))). unfold Elbow.elbow. cbn [fst]. rewrite Rad, Q, Nn, Va, Vbl. unfold arm_cosine, arm_eta. fold N0. field. split; lra. }
      assert (Vsn : value es = arm_sine l C).
      { unfold es. rewrite value_signed', <- hm. change (value (elbow_of true a bl tq)) with (snd (Elbow.elbow (value a) (value bl) (value tq))). unfold Elbow.elbow. cbn [snd]. rewrite Rad, Q, Nn, Va, Vbl.
        unfold arm_sine, arm_eta. fold N0.
        replace (arm_mode l * ((2 * (forward l C / arm_length l) * (arm_mode l * (across l C / arm_length l)) - 2 * sqrt (clearance l C) / arm_length l * (along l C / arm_length l)) / (2 * (N0 / arm_length l ^ 2))))
          with ((arm_mode l * arm_mode l * forward l C * across l C - arm_mode l * sqrt (clearance l C) * along l C) / N0) by (field; split; lra).
        rewrite mm. field. lra. }
      assert (VA : val3 A = vscale u (Arm.rod l C)).
      { unfold A. rewrite val3_minus, val3_scaled, val3_plus, !val3_scaled, Vc, Vsn, hw, Ee, Ef, hr.
        unfold Arm.rod, Arm.elbow, from_motor. generalize (motor_zero l) (quarter l). intros a0 b0. unfold vsub, vadd, vscale. cbn [vx vy vz]. f_equal; ring. }
      assert (UT : two_to s = / u) by (unfold u; rewrite Rinv_inv; reflexivity).
      split; [| split; [| split; [| split; [| right; exact VA]]]].
      * exists (u ^ 2 * (arm_length l * arm_eta l C)). split; [rewrite VD, <- E2; ring |]. rewrite VA, UT. unfold arm_row, vscale. cbn [vx vy vz]. f_equal; field; repeat split; try exact h0; lra.
      * rewrite val3_divided, VA, Vs, UT. unfold arm_row, vscale. cbn [vx vy vz]. f_equal; field; repeat split; try exact h0; lra.
      * cbn [joint_is]. split; [exact Vc | exact Vsn].
      * exists (Arm.rod l C), (arm_eta l C), (rod_length l). split; [reflexivity |]. split; [rewrite Vd, <- E2; ring |]. split; [exact hL | exact VA].
Qed.
End Values.

(** ** Formulas of legs in a pose *)

Definition eplace (k : mobility) : evec := match k with Translates => point | TranslatesInPlane => eposition InPlane | Turns k => eposition k end.
Definition evelocities (k : mobility) (v w : evec) : list formula :=
  match k with Translates => list_of v | TranslatesInPlane => [ex v; ey v] | Turns k => etwist k v w end.
Definition ecomponents (k : mobility) (a : evec) : list formula := match k with Translates => list_of a | TranslatesInPlane => [ex a; ey a] | Turns _ => [] end.

(** Units of directions: of an arm, of its axis and of its reference. *)
Definition driven_layout (s : Z) (d : Z * Z) (dr : any_drive) : list parameter :=
  match dr with
  | LinearDrive dr => layout s (fst d) dr
  | RotaryDrive a => three (axis_within a) (fst d) ++ three (reference_within a) (snd d) ++ three (anchor_within a) s ++ three (platform_within a) s ++
      [(arm_within a, s); (rod_within a, s)]
  end.

(** [d_origin]: of a leg's vector, with its moment about the origin. *)
Record pose_formulas := PoseFormulas { d_A : list formula; d_D : formula; d_divided : list formula; d_joint : ejoint;
  d_vector : list formula; d_rod : option (formula * formula); d_built : list formula; d_origin : list formula }.

Section Formulas.
Variables (k : mobility) (turn : option (emat * formula)) (ell : formula) (s : Z).
Definition eturned (b : evec) : evec := match turn with Some (N, w) => divided_by (emulv N b) w | None => b end.

(** By where the joint on the platform is. *)
Definition drive_from (C : evec) (dr : any_drive) (q : list formula) : drive_formulas :=
  let way a := map2 minus C (vector_at q a) in
  match dr with
  | LinearDrive (SliderLeg c) => slider_drive (way 3%nat) (vector_at q 0) (nth 9 q (integer 0)) (mode c)
  | LinearDrive (StrutLeg _ _ ax) => strut_drive (way 0%nat) match ax with Some _ => Some (vector_at q 6) | None => None end
  | LinearDrive (PlanarLeg _) => plane_drive C (vector_at q 0)
  | RotaryDrive a => arm_drive_formulas (way 6%nat) (vector_at q 0) (vector_at q 3) (nth 12 q (integer 0)) (nth 13 q (integer 0)) (is_positive_mode a)
  end.
(** [placed]: from the platform's point to where it is. *)
Definition way_to (placed : evec -> evec) (dr : any_drive) (q : list formula) : evec :=
  match dr with
  | LinearDrive (SliderLeg _) => placed (vector_at q 6)
  | LinearDrive (StrutLeg _ _ _) => placed (vector_at q 3)
  | LinearDrive (PlanarLeg _) => EVec (integer 0) (integer 0) (integer 0)
  | RotaryDrive _ => placed (vector_at q 9)
  end.
Definition tip_of (dr : any_drive) (r : evec) : evec := match dr with LinearDrive (PlanarLeg _) => eplace k | _ => map2 plus (eplace k) r end.
Definition drive_at (placed : evec -> evec) (dr : any_drive) (q : list formula) : drive_formulas * evec :=
  let r := way_to placed dr q in (drive_from (tip_of dr r) dr q, r).
Fixpoint all_drives (placed : evec -> evec) (ds : list (Z * Z)) (drs : list any_drive) (j : nat) : list (drive_formulas * evec) :=
  match drs with
  | [] => []
  | dr :: r => let d := hd (0, 0)%Z ds in
      drive_at placed dr (numbered j (driven_layout s d dr)) :: all_drives placed (tl ds) r (j + length (driven_layout s d dr))
  end.
Definition pose_of (b : drive_formulas) (r : evec) : pose_formulas :=
  let row a := evelocities k a (divided_by (ecross r a) ell) in
  PoseFormulas (row (b_A b)) (b_D b) (row (b_divided b)) (b_joint b) (ecomponents k (b_A b)) (b_rod b) (b_built b)
    (evelocities k (b_A b) (ecross (map2 plus (eplace k) r) (b_A b))).
Definition all_driven (ds : list (Z * Z)) (drs : list any_drive) (j : nat) : list pose_formulas := map (fun z => pose_of (fst z) (snd z)) (all_drives eturned ds drs j).
End Formulas.
Fixpoint driven_layouts (s : Z) (ds : list (Z * Z)) (drs : list any_drive) : list parameter :=
  match drs with [] => [] | dr :: r => driven_layout s (hd (0, 0)%Z ds) dr ++ driven_layouts s (tl ds) r end.

(** What the formulas of a leg are in a pose. *)
Definition stands_in (x theta : list R) (s : Z) (k : mobility) (L : R) (P : vec) (Q : mat) (f : pose_formulas) (l : driven) : Prop :=
  let value := Formula.value x theta in let u := / two_to s in let row := driven_row k L P Q l in let mu := rate_unit s l in
  let reach := own_reach l (carried l P Q) in
  (Forall (Formula.defined x theta) (d_built f) -> well_formed_driven l) /\
  (well_formed_driven l ->
    (0 < value (d_D f) -> reach) /\ (reach -> 0 < value (d_D f)) /\ (Forall (Formula.defined x theta) (d_divided f) -> k <> Turns AboutPoint -> reach) /\
    (reach ->
      (exists q, q ^ 2 = value (d_D f) /\ map value (d_A f) = map (Rmult (q * mu)) row) /\ map value (d_divided f) = map (Rmult mu) row /\
      joint_is x theta s (d_joint f) (own_joint l (carried l P Q)) /\
      match d_rod f with
      | Some (e2, len) => exists q, driven_rod k P Q l = Some q /\ value e2 = (u * rod_eta q) ^ 2 /\ value len = u * rod_size q /\ map value (d_vector f) = map (Rmult u) (rod_vector q)
      | None => True
      end /\ (is_plane l \/ map value (d_origin f) = map (Rmult u) (about_origin k u (as_strut P Q l) P Q)))).

Section Values.
Variables x theta : list R.
Variables (s : Z) (k : mobility) (turn : option (emat * formula)) (ell : formula) (L : R) (P : vec) (Q : mat).
Local Notation value := (Formula.value x theta).
Local Notation val3 := (val3 x theta).
Let u := / two_to s.
Hypothesis place_is : val3 (eplace k) = vscale u P.
Hypothesis turn_is : match turn with Some (N, w) => exists W, 0 < W /\ valm x theta N = mscale W Q /\ value w = W | None => Q = midentity end.
Hypothesis length_is : match k with Turns _ => L <> 0 /\ value ell = u * L | _ => True end.

Lemma turned_is : forall b, val3 (eturned turn b) = mulv Q (val3 b).
Proof.
  intro b. unfold eturned. destruct turn as [[N w] |].
  - destruct turn_is as [W [W0 [hN hw]]]. rewrite val3_divided, val3_mulv, hN, hw, mulv_mscale. unfold vscale. cbn [vx vy vz].
    destruct (mulv Q (val3 b)) as [a1 a2 a3]. cbn [vx vy vz]. f_equal; field; lra.
  - rewrite turn_is, mulv_identity. reflexivity.
Qed.

Lemma row_is : forall a r c l, val3 a = vscale c (own_row l (carried l P Q)) -> val3 r = vscale u (mulv Q (offset l)) ->
  map value (evelocities k a (divided_by (ecross r a) ell)) = map (Rmult c) (driven_row k L P Q l).
Proof.
  intros a r c l ha hr. unfold driven_row. cbv zeta. set (row := own_row l (carried l P Q)) in *. set (o := mulv Q (offset l)) in *.
  assert (T : forall m, k = Turns m -> val3 (divided_by (ecross r a) ell) = vscale c (vscale (/ L) (cross o row))).
  { intros m e. rewrite e in length_is. destruct length_is as [L0 hl]. rewrite val3_divided, val3_cross, ha, hr, hl. clearbody row o. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as u0. fold u in u0.
    unfold vscale, cross. cbn [vx vy vz]. f_equal; field; split; try exact L0; lra. }
  assert (A : [value (ex a); value (ey a); value (ez a)] = map (Rmult c) (coordinates row)) by (pose proof ha as h; unfold Chart.val3, vscale in h; injection h as -> -> ->; reflexivity).
  destruct k as [| | m]; cbn [evelocities velocities].
  - exact A.
  - cbn [map coordinates] in A |- *. injection A as -> -> _. reflexivity.
  - rewrite twist_values, ha, (T m eq_refl). apply twist_scaled.
Qed.

Lemma origin_is : forall a r l, val3 a = vscale u (vsub (vadd (carried l P Q) (offset l)) (driven_end l (carried l P Q))) -> val3 r = vscale u (mulv Q (offset l)) ->
  map value (evelocities k a (ecross (map2 plus (eplace k) r) a)) = map (Rmult u) (about_origin k u (as_strut P Q l) P Q).
Proof.
  intros a r l ha hr. rewrite <- as_strut_vector in ha. set (S := as_strut P Q l) in *.
  assert (M : val3 (ecross (map2 plus (eplace k) r) a) = vscale u (vscale u (cross (strut_base S) (strut_vector S P Q)))).
  { rewrite val3_cross, val3_plus, place_is, hr, ha. unfold strut_vector, arm_of_joint. change (strut_joint S) with (offset l). generalize (mulv Q (offset l)) (strut_base S). intros [b1 b2 b3] [e1 e2 e3].
    destruct P as [p1 p2 p3]. unfold vscale, cross, vadd, vsub. cbn [vx vy vz]. f_equal; ring. }
  unfold about_origin. cbv zeta. set (A := strut_vector S P Q) in *. set (B := cross (strut_base S) A) in *. clearbody A B.
  assert (E : forall v w, map value (evelocities k v w) = velocities k (val3 v) (val3 w)) by (intros v w; destruct k as [| | []]; reflexivity).
  rewrite E, ha, M. destruct k as [| | []]; reflexivity.
Qed.

Lemma pose_stands : forall b r l, drives_as x theta s b l (carried l P Q) -> val3 r = vscale u (mulv Q (offset l)) ->
  stands_in x theta s k L P Q (pose_of k ell b r) l.
Proof.
  intros b r l [B H] hr. unfold stands_in. cbv zeta. cbn [pose_of d_A d_D d_divided d_joint d_vector d_rod d_built d_origin].
  split; [exact B |]. intro ok. destruct (H ok) as [H1 [H2 [H3 [_ H4]]]]. split; [exact H1 |]. split; [exact H2 |]. split.
  - intros D nk. apply H3. destruct k as [| | []]; cbn [evelocities etwist list_of] in D; try (inversion D; assumption). contradiction nk; reflexivity.
  - intro reach. destruct (H4 reach) as [[q [q2 qA]] [D [J [R0 O]]]]. split; [exists q; split; [exact q2 | exact (row_is _ _ _ _ qA hr)] |].
    split; [exact (row_is _ _ _ _ D hr) |]. split; [exact J |]. split; [| destruct O as [O | O]; [left; exact O | right; exact (origin_is _ _ _ O hr)]].
    destruct (b_rod b) as [[e2 len] |]; [| exact I].
    destruct R0 as [A [eta [size [o [v1 [v2 v3]]]]]]. exists (Rod (components k A) eta size). split; [unfold driven_rod; rewrite o; reflexivity |].
    cbn [rod_eta rod_size rod_vector]. split; [exact v1 |]. split; [exact v2 |]. unfold Chart.val3, vscale in v3. injection v3 as a1 a2 a3.
    destruct k; cbn [ecomponents components list_of map coordinates]; rewrite ?a1, ?a2, ?a3; reflexivity.
Qed.
End Values.

Lemma two_to_scaled : forall d c, exists q, 0 < q /\ vscale (/ two_to d) c = vscale q c.
Proof. intros d c. exists (/ two_to d). split; [apply Rinv_0_lt_compat, two_to_pos | reflexivity]. Qed.

Lemma val3_at : forall x theta q th j, map (Formula.value x theta) q = th -> val3 x theta (vector_at q j) = Vec (nth j th 0) (nth (1 + j) th 0) (nth (2 + j) th 0).
Proof. intros x theta q th j <-. unfold val3, vector_at. cbn [ex ey ez]. f_equal; symmetry; exact (map_nth (Formula.value x theta) q (integer 0) _). Qed.
Lemma value_nth : forall x theta q th j, map (Formula.value x theta) q = th -> Formula.value x theta (nth j q (integer 0)) = nth j th 0.
Proof. intros x theta q th j <-. symmetry. exact (map_nth (Formula.value x theta) q (integer 0) _). Qed.

(** With [v], [y] as directions. *)
Definition is_driven_along (v y : vec) (dr : any_drive) (l : driven) : Prop :=
  match dr, l with
  | LinearDrive dr, Linear l => is_leg_along v dr l
  | RotaryDrive d, Rotary l => (all_within (axis_within d) v /\ all_within (reference_within d) y /\ motor_axis l = normalised v /\ motor_zero l = normalised (orthogonal_part (normalised v) y)) /\
      all_within (anchor_within d) (motor l) /\ all_within (platform_within d) (arm_offset l) /\ within (arm_within d) (arm_length l) /\ within (rod_within d) (rod_length l) /\
      arm_mode l = (if is_positive_mode d then 1 else -1)
  | _, _ => False
  end.
Definition driven_parameters (s : Z) (d : Z * Z) (v y : vec) (l : driven) : list R :=
  match l with
  | Linear l => parameters_of s (fst d) v l
  | Rotary l => coordinates (vscale (/ two_to (fst d)) v) ++ coordinates (vscale (/ two_to (snd d)) y) ++ coordinates (vscale (/ two_to s) (motor l)) ++
      coordinates (vscale (/ two_to s) (arm_offset l)) ++ [/ two_to s * arm_length l; / two_to s * rod_length l]
  end.
Lemma is_driven_has_directions : forall dr l, is_driven dr l -> exists v y, is_driven_along v y dr l.
Proof.
  intros [dr | a] [l | l] h; cbn [is_driven] in h; try contradiction; [destruct (is_leg_has_direction dr l h) as [v hv]; exists v, v; exact hv |].
  destruct h as [[v [y [hv [hy [ha he]]]]] rest]. exists v, y. split; [auto | exact rest].
Qed.

(** What each leg's formulas are, at the pose P, Q. *)
Definition drives_there (x theta : list R) (s : Z) (P : vec) (Q : mat) (z : drive_formulas * evec) (l : driven) : Prop :=
  drives_as x theta s (fst z) l (carried l P Q) /\ val3 x theta (snd z) = vscale (/ two_to s) (mulv Q (offset l)).
Lemma one_drive_from : forall s d v y dr l, is_driven_along v y dr l -> Forall2 scaled_within (driven_layout s d dr) (driven_parameters s d v y l) /\
  forall x front back, let theta := front ++ driven_parameters s d v y l ++ back in let q := numbered (length front) (driven_layout s d dr) in
    (forall C D, val3 x theta C = vscale (/ two_to s) (vadd D (offset l)) -> drives_as x theta s (drive_from C dr q) l D) /\
    forall placed Q, (forall b, val3 x theta (placed b) = mulv Q (val3 x theta b)) -> val3 x theta (way_to placed dr q) = vscale (/ two_to s) (mulv Q (offset l)).
Proof.
  intros s d v y dr l h. pose proof (Rinv_0_lt_compat _ (two_to_pos (fst d))) as d1. pose proof (Rinv_0_lt_compat _ (two_to_pos (snd d))) as d2.
  assert (Way : forall D o a, vsub (vscale (/ two_to s) (vadd D o)) (vscale (/ two_to s) a) = vscale (/ two_to s) (vsub (vadd D o) a))
    by (intros; unfold vsub, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
  assert (Zero : forall Q, vscale (/ two_to s) (mulv Q vzero) = vzero) by (intro Q; unfold mulv, Vec3.dot, vscale, vzero; cbn [vx vy vz]; f_equal; ring).
  destruct dr as [dr | a], l as [l | l]; cbn [is_driven_along] in h; try contradiction; cbn [driven_parameters].
  - rename h into hv. destruct (parameters_represent s (fst d) v dr l hv) as [L1 _]. split; [exact L1 |]. intros x front back. cbv zeta. set (theta := front ++ _ ++ back) in *.
    pose proof (numbered_values _ _ x front back L1) as V. fold theta in V.
    cbn [driven_layout]. set (q := numbered (length front) (layout s (fst d) dr)) in *.
    destruct dr as [c | a p ax | n], l as [i | base platform axis | normal]; cbn [is_leg_along] in hv; try contradiction; cbn [drive_from way_to offset]; (split; [intros C D hC | intros placed Q T]).
    + destruct hv as [[hu ax] [ha [hp' [hl' hm]]]]. apply (slider_drives x theta s _ _ _ _ _ _ v); [| exact ax | exists (/ two_to (fst d)); split; [exact d1 | rewrite (val3_at _ _ _ _ _ V); reflexivity] | rewrite (value_nth _ _ _ _ _ V); reflexivity | exact hm].
      rewrite val3_minus, hC, (val3_at _ _ _ _ _ V). cbn [parameters_of coordinates app nth Nat.add]. exact (Way D (platform_offset i) (base_point i)).
    + rewrite T, (val3_at _ _ _ _ _ V). exact (mulv_scale Q (/ two_to s) (platform_offset i)).
    + destruct hv as [ha [hp' hk]]. apply strut_drives; [| destruct ax as [a' |], axis as [k' |]; try contradiction; [| exact I]; exists (/ two_to (fst d)), v; split; [exact d1 |]; split; [rewrite (val3_at _ _ _ _ _ V); reflexivity | exact (proj2 hk)]].
      rewrite val3_minus, hC, (val3_at _ _ _ _ _ V). cbn [parameters_of coordinates app nth Nat.add]. exact (Way D platform base).
    + rewrite T, (val3_at _ _ _ _ _ V). exact (mulv_scale Q (/ two_to s) platform).
    + apply plane_drives; [| exists (/ two_to (fst d)); split; [exact d1 | rewrite (val3_at _ _ _ _ _ V); reflexivity]].
      rewrite hC. f_equal. destruct D as [p1 p2 p3]. unfold vadd, offset, vzero. cbn [vx vy vz]. f_equal; ring.
    + rewrite Zero. reflexivity.
  - destruct h as [[hv [hy [ha he]]] [hb [hp' [hr [hl' hm]]]]]. set (t1 := coordinates _ ++ _).
    assert (L1 : Forall2 scaled_within (driven_layout s d (RotaryDrive a)) t1).
    { unfold t1. cbn [driven_layout]. repeat apply Forall2_app; try (apply three_within; assumption).
      constructor; [exists (arm_length l); split; [exact hr | cbn [snd]; unfold Rdiv; ring] |].
      constructor; [exists (rod_length l); split; [exact hl' | cbn [snd]; unfold Rdiv; ring] | constructor]. }
    split; [exact L1 |]. intros x front back. cbv zeta. set (theta := front ++ _ ++ back) in *. pose proof (numbered_values _ _ x front back L1) as V. fold theta in V.
    set (q := numbered (length front) (driven_layout s d (RotaryDrive a))) in *. cbn [drive_from way_to offset]. split; [intros C D hC | intros placed Q T].
    + apply (arm_drives x theta s _ _ _ _ _ _ l _ v y); try assumption.
      * rewrite val3_minus, hC, (val3_at _ _ _ _ _ V). unfold t1. cbn [coordinates app nth Nat.add]. exact (Way D (arm_offset l) (motor l)).
      * exists (/ two_to (fst d)). split; [exact d1 | rewrite (val3_at _ _ _ _ _ V); reflexivity].
      * exists (/ two_to (snd d)). split; [exact d2 | rewrite (val3_at _ _ _ _ _ V); reflexivity].
      * rewrite (value_nth _ _ _ _ _ V). reflexivity.
      * rewrite (value_nth _ _ _ _ _ V). reflexivity.
    + rewrite T, (val3_at _ _ _ _ _ V). unfold t1. cbn [coordinates app nth Nat.add]. exact (mulv_scale Q (/ two_to s) (arm_offset l)).
Qed.
Lemma one_drives : forall s d v y dr l, is_driven_along v y dr l -> Forall2 scaled_within (driven_layout s d dr) (driven_parameters s d v y l) /\
  forall x front back k placed P Q, let theta := front ++ driven_parameters s d v y l ++ back in
    val3 x theta (eplace k) = vscale (/ two_to s) P -> (forall b, val3 x theta (placed b) = mulv Q (val3 x theta b)) ->
    drives_there x theta s P Q (drive_at k placed dr (numbered (length front) (driven_layout s d dr))) l.
Proof.
  intros s d v y dr l h. destruct (one_drive_from s d v y dr l h) as [L1 R1]. split; [exact L1 |]. intros x front back k placed P Q. cbv zeta. intros hp T.
  destruct (R1 x front back) as [R2 R3]. specialize (R3 placed Q T). unfold drive_at. cbv zeta. split; cbn [fst snd]; [| exact R3].
  apply R2. set (theta := front ++ _) in *. clearbody theta. clear R1 R2 L1.
  assert (E : val3 x theta (map2 plus (eplace k) (way_to placed dr (numbered (length front) (driven_layout s d dr)))) = vscale (/ two_to s) (vadd (carried l P Q) (offset l))).
  { rewrite val3_plus, hp, R3. unfold carried. generalize (offset l) (mulv Q (offset l)). intros o o'. unfold vscale, vadd, vsub. cbn [vx vy vz]. f_equal; ring. }
  destruct dr as [[] |]; try exact E. unfold tip_of. rewrite hp. f_equal. destruct l as [[] |]; try contradiction. destruct P as [p1 p2 p3].
  unfold carried. cbn [offset]. unfold mulv, Vec3.dot, vsub, vadd, vzero. cbn [vx vy vz]. f_equal; ring.
Qed.

(** Of the nominal legs, parameters are the middles. *)
Lemma nominal_along : forall s d dr l, is_driven dr l -> exists v y, is_driven_along v y dr (nominal_driven dr) /\ driven_parameters s d v y (nominal_driven dr) = map middle_of (driven_layout s d dr).
Proof.
  intros s d dr l h.
  destruct dr as [dr | a], l as [l | l]; cbn [is_driven] in h; try contradiction.
  - destruct (nominal_legs_along s (fst d) dr l h) as [v [h1 h2]]. exists v, v. split; [exact h1 | exact h2].
  - destruct h as [[v [y [hv [hy _]]]] [hb [hp [hr [hl _]]]]]. exists (middles (axis_within a)), (middles (reference_within a)). split.
    + cbn [is_driven_along nominal_driven motor_axis motor_zero motor arm_offset arm_length rod_length arm_mode]. split; [split; [exact (middles_within _ _ hv) |]; split; [exact (middles_within _ _ hy) |]; split; reflexivity |].
      split; [exact (middles_within _ _ hb) |]. split; [exact (middles_within _ _ hp) |]. split; [exact (middle_within _ _ hr) |]. split; [exact (middle_within _ _ hl) | reflexivity].
    + cbn [driven_parameters nominal_driven driven_layout motor arm_offset arm_length rod_length]. rewrite !map_app, !middles_three. cbn [map]. do 4 f_equal. unfold middle_of. cbn [fst snd]. f_equal; [unfold Rdiv; ring | f_equal; unfold Rdiv; ring].
Qed.

Section All.
Variable s : Z.
(** All legs by where their joints are, each from a place of its parameters. *)
Fixpoint all_from (ds : list (Z * Z)) (drs : list any_drive) (j : nat) : list (any_drive * list formula) :=
  match drs with
  | [] => []
  | dr :: r => let lay := driven_layout s (hd (0, 0)%Z ds) dr in (dr, numbered j lay) :: all_from (tl ds) r (j + length lay)
  end.
Definition drives_from (x theta : list R) (z : any_drive * list formula) (l : driven) : Prop :=
  forall C D, val3 x theta C = vscale (/ two_to s) (vadd D (offset l)) -> drives_as x theta s (drive_from C (fst z) (snd z)) l D.
Lemma drives_of_from : forall k placed drs ds j, all_drives k s placed ds drs j = map (fun z => drive_at k placed (fst z) (snd z)) (all_from ds drs j).
Proof. intros k placed. induction drs as [| dr drs IH]; intros ds j; [reflexivity |]. cbn [all_drives all_from map fst snd]. rewrite IH. reflexivity. Qed.
(** All legs, with these parameters; of the nominal ones, with the middles. *)
Lemma legs_drive : forall drs m, Forall2 is_driven drs m -> forall ds, exists th, Forall2 scaled_within (driven_layouts s ds drs) th /\
  (forall x front back, Forall2 (drives_from x (front ++ th ++ back)) (all_from ds drs (length front)) m) /\
  forall x front back k placed P Q, let theta := front ++ th ++ back in
    val3 x theta (eplace k) = vscale (/ two_to s) P -> (forall b, val3 x theta (placed b) = mulv Q (val3 x theta b)) ->
    Forall2 (drives_there x theta s P Q) (all_drives k s placed ds drs (length front)) m.
Proof.
  intros drs m h. induction h as [| dr l drs m h hs IH]; intro ds; [exists []; split; [constructor | split; intros; constructor] |].
  set (d := hd (0, 0)%Z ds). destruct (IH (tl ds)) as [t2 [L2 [F2 R2]]]. destruct (is_driven_has_directions dr l h) as [v [y hv]]. destruct (one_drives s d v y dr l hv) as [L1 R1].
  destruct (one_drive_from s d v y dr l hv) as [_ F1].
  exists (driven_parameters s d v y l ++ t2). split; [cbn [driven_layouts]; apply Forall2_app; assumption |]. split.
  - intros x front back. cbn [all_from]. fold d. cbv zeta. rewrite <- app_assoc. constructor; [exact (proj1 (F1 x front (t2 ++ back))) |].
    specialize (F2 x (front ++ driven_parameters s d v y l) back). rewrite app_length, <- (related_length _ _ _ _ _ L1) in F2. rewrite <- !app_assoc in F2. exact F2.
  - intros x front back k placed P Q. cbv zeta. intros hp T. cbn [all_drives]. fold d. rewrite <- app_assoc in *. constructor; [exact (R1 x front (t2 ++ back) k placed P Q hp T) |].
    specialize (R2 x (front ++ driven_parameters s d v y l) back k placed P Q). cbv zeta in R2. rewrite app_length, <- (related_length _ _ _ _ _ L1) in R2. rewrite <- !app_assoc in R2. exact (R2 hp T).
Qed.
Lemma nominal_legs_drive : forall drs m, Forall2 is_driven drs m -> forall ds, let th := map middle_of (driven_layouts s ds drs) in
  forall x front back k placed P Q, let theta := front ++ th ++ back in
    val3 x theta (eplace k) = vscale (/ two_to s) P -> (forall b, val3 x theta (placed b) = mulv Q (val3 x theta b)) ->
    Forall2 (drives_there x theta s P Q) (all_drives k s placed ds drs (length front)) (map nominal_driven drs).
Proof.
  intros drs m h. induction h as [| dr l drs m h hs IH]; intros ds th; [intros; constructor |]. unfold th. clear th.
  set (d := hd (0, 0)%Z ds). specialize (IH (tl ds)). destruct (nominal_along s d dr l h) as [v [y [hv e]]]. destruct (one_drives s d v y dr _ hv) as [L1 R1]. cbv zeta in IH.
  intros x front back k placed P Q. cbn [driven_layouts]. fold d. rewrite map_app. cbv zeta. intros hp T. cbn [all_drives map]. fold d. rewrite <- app_assoc in *. rewrite <- e in hp, T |- *.
  constructor; [exact (R1 x front (map middle_of (driven_layouts s (tl ds) drs) ++ back) k placed P Q hp T) |].
  specialize (IH x (front ++ driven_parameters s d v y (nominal_driven dr)) back k placed P Q). rewrite app_length, <- (related_length _ _ _ _ _ L1) in IH. rewrite <- !app_assoc in IH. exact (IH hp T).
Qed.
End All.

Lemma drives_stand : forall x theta s k ell L P Q, val3 x theta (eplace k) = vscale (/ two_to s) P ->
  match k with Turns _ => L <> 0 /\ Formula.value x theta ell = / two_to s * L | _ => True end ->
  forall zs m, Forall2 (drives_there x theta s P Q) zs m -> Forall2 (stands_in x theta s k L P Q) (map (fun z => pose_of k ell (fst z) (snd z)) zs) m.
Proof.
  intros x theta s k ell L P Q hp hl zs m h. induction h as [| z l zs m [h1 h2] hs IH]; cbn [map]; constructor; [exact (pose_stands x theta s k ell L P Q hp hl _ _ _ h1 h2) | exact IH].
Qed.
Lemma legs_stand : forall s drs m, Forall2 is_driven drs m -> forall ds, exists th, Forall2 scaled_within (driven_layouts s ds drs) th /\
  (forall x front back, Forall2 (drives_from s x (front ++ th ++ back)) (all_from s ds drs (length front)) m) /\
  (forall x front back k placed P Q, let theta := front ++ th ++ back in
    val3 x theta (eplace k) = vscale (/ two_to s) P -> (forall b, val3 x theta (placed b) = mulv Q (val3 x theta b)) ->
    Forall2 (drives_there x theta s P Q) (all_drives k s placed ds drs (length front)) m) /\
  forall x front back k turn ell L P Q, let theta := front ++ th ++ back in
    val3 x theta (eplace k) = vscale (/ two_to s) P ->
    match turn with Some (N, w) => exists W, 0 < W /\ valm x theta N = mscale W Q /\ Formula.value x theta w = W | None => Q = midentity end ->
    match k with Turns _ => L <> 0 /\ Formula.value x theta ell = / two_to s * L | _ => True end ->
    Forall2 (stands_in x theta s k L P Q) (all_driven k turn ell s ds drs (length front)) m.
Proof.
  intros s drs m h ds. destruct (legs_drive s drs m h ds) as [th [L1 [F1 R1]]]. exists th. split; [exact L1 |]. split; [exact F1 |]. split; [exact R1 |].
  intros x front back k turn ell L P Q. cbv zeta. intros hp ht hl. apply (drives_stand x _ s k ell L P Q hp hl). exact (R1 x front back k (eturned turn) P Q hp (turned_is x _ turn Q ht)).
Qed.
End Named.
