(** * Refuted: accelerations of legs in any motion

    Along a path C of the joint on the platform a slider's coordinate has the acceleration row . C'' + m ((|C'|^2 - (n . C')^2)/s + (r . C')^2/s^3); with the arm's
    angular velocity w, direction g of the elbow's motion and f of the arm an arm's is row . C'' + (|C'|^2 - 2 r w g . C' + r w^2 f)/(r eta). *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Import Linear Configuration Statement Arithmetic Number Trig Machine Acceleration Witness Arm Orientation Turning Bend Onward Accelerated Legs LegBend.
From Orthocert.kernel Require Solve.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Definition arm_bent (l : arm) (C c : vec) : R :=
  let w := Vec3.dot (arm_row l C) c in
  (norm2 c - 2 * (arm_length l * w) * (arm_cosine l C * Vec3.dot (quarter l) c - arm_sine l C * Vec3.dot (motor_zero l) c) + arm_length l * w ^ 2 * forward l C) / (arm_length l * arm_eta l C).

Lemma arm_accelerates : forall l path V a, well_formed_arm l -> arm_reaches l (path 0) -> has_velocity path 0 (V 0) -> has_velocity V 0 a ->
  derivable_pt_lim (fun t => Vec3.dot (arm_row l (path t)) (V t)) 0 (Vec3.dot (arm_row l (path 0)) a + arm_bent l (path 0) (V 0)).
Proof.
  intros l path V a ok reach hp hv. destruct (angle_velocity l path 0 (V 0) ok reach hp) as [hc hs]. cbv zeta in hc, hs. set (w := Vec3.dot (arm_row l (path 0)) (V 0)) in *.
  pose proof (eta_squared l (path 0) ok reach) as ED. assert (h0 : arm_eta l (path 0) <> 0) by (intro z; rewrite z in ED; unfold arm_reaches in reach; lra).
  assert (ok' := ok). destruct ok' as [hk [he [ho [r0 [_ hm]]]]].
  assert (hw : has_velocity (fun u => from_motor l (path u)) 0 (V 0)) by exact (velocity_w (Leg vzero (motor l) (arm_offset l) 1 1) path 0 (V 0) hp).
  pose proof (velocity_dot _ 0 (V 0) (motor_zero l) hw) as hA. pose proof (velocity_dot _ 0 (V 0) (quarter l) hw) as hB. pose proof (velocity_dot _ 0 (V 0) (motor_axis l) hw) as hK. cbn beta in hA, hB, hK.
  (* the arm is reached near 0, and eta = c (q . w) - s (e . w) *)
  assert (Near : exists e, 0 < e /\ forall t, Rabs (t - 0) < e -> arm_reaches l (path t)).
  { assert (D : exists d, derivable_pt_lim (fun u => clearance l (path u)) 0 d).
    { eexists. unfold clearance, forward, Arm.along, across, height. eapply derivable_eq with (f := fun u => rod_length l ^ 2 + (-1 * Vec3.dot (motor_axis l) (from_motor l (path u)) ^ 2 +
        -1 * (/ (2 * arm_length l) * (Vec3.dot (motor_zero l) (from_motor l (path u)) ^ 2 + (Vec3.dot (quarter l) (from_motor l (path u)) ^ 2 + (Vec3.dot (motor_axis l) (from_motor l (path u)) ^ 2 + (arm_length l ^ 2 - rod_length l ^ 2)))) + - arm_length l) ^ 2));
        [| intro u; field; lra | reflexivity].
      apply derivable_add; [apply derivable_const |]. apply derivable_add; [apply (derivable_scal (-1)), derivable_square; exact hK |]. apply (derivable_scal (-1)), derivable_square.
      apply derivable_add; [| apply derivable_const]. apply derivable_scal. apply derivable_add; [apply derivable_square; exact hA |]. apply derivable_add; [apply derivable_square; exact hB |].
      apply derivable_add; [apply derivable_square; exact hK | apply derivable_const]. }
    destruct D as [d hd]. destruct (positive_near _ _ _ hd reach) as [e [e0 near]]. exists e. split; [exact e0 | exact near]. }
  destruct Near as [e [e0 near]]. set (r := arm_length l) in *. set (h := arm_eta l (path 0)) in *. set (f := forward l (path 0)) in *.
  set (g := arm_cosine l (path 0) * Vec3.dot (quarter l) (V 0) - arm_sine l (path 0) * Vec3.dot (motor_zero l) (V 0)).
  destruct (angle_splits l (path 0) ok reach) as [one [eg eh]]. fold f h in eg, eh.
  assert (Heta : derivable_pt_lim (fun u => arm_eta l (path u)) 0 (g - w * f)).
  { apply (derivable_near (fun u => arm_cosine l (path u) * Vec3.dot (quarter l) (from_motor l (path u)) + -1 * (arm_sine l (path u) * Vec3.dot (motor_zero l) (from_motor l (path u)))) _ _ _ e e0).
    - intros u hu. destruct (angle_splits l (path u) ok (near u hu)) as [_ [_ E]]. rewrite <- E. unfold across, Arm.along. ring.
    - eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_times _ _ _ _ _ hc hB) (derivable_scal (-1) _ _ _ (derivable_times _ _ _ _ _ hs hA))) | reflexivity |].
      cbv beta. unfold g. rewrite <- eg. unfold across, Arm.along. ring. }
  assert (Hrod : has_velocity (fun u => Arm.rod l (path u)) 0 (vsub (V 0) (vscale (r * w) (vsub (vscale (arm_cosine l (path 0)) (quarter l)) (vscale (arm_sine l (path 0)) (motor_zero l)))))).
  { destruct hw as [w1 [w2 w3]].
    assert (K : forall (part : vec -> R), (forall x y, part (vsub x y) = part x - part y) -> (forall x y, part (vadd x y) = part x + part y) -> (forall q x, part (vscale q x) = q * part x) ->
      derivable_pt_lim (fun u => part (from_motor l (path u))) 0 (part (V 0)) -> derivable_pt_lim (fun u => part (Arm.rod l (path u))) 0
        (part (vsub (V 0) (vscale (r * w) (vsub (vscale (arm_cosine l (path 0)) (quarter l)) (vscale (arm_sine l (path 0)) (motor_zero l))))))).
    { intros part p1 p2 p3 d. eapply derivable_eq with (f := fun u => part (from_motor l (path u)) + (-r) * (part (motor_zero l) * arm_cosine l (path u) + part (quarter l) * arm_sine l (path u))).
      - apply derivable_add; [exact d |]. apply derivable_scal, derivable_add; apply derivable_scal; [exact hc | exact hs].
      - intro u. unfold Arm.rod, elbow, from_motor. fold r. rewrite !p1, !p2, !p3, !p2, !p3. ring.
      - rewrite p1, p3, p1, !p3. ring. }
    split; [| split].
    - exact (K vx (fun _ _ => eq_refl) (fun _ _ => eq_refl) (fun _ _ => eq_refl) w1).
    - exact (K vy (fun _ _ => eq_refl) (fun _ _ => eq_refl) (fun _ _ => eq_refl) w2).
    - exact (K vz (fun _ _ => eq_refl) (fun _ _ => eq_refl) (fun _ _ => eq_refl) w3). }
  pose proof (velocity_product _ _ _ _ _ Hrod hv) as HN. cbv beta in HN.
  pose proof (derivable_scal r _ _ _ Heta) as HD. cbv beta in HD.
  pose proof (derivable_pt_lim_div _ _ 0 _ _ HN HD ltac:(cbv beta; fold h; apply Rmult_integral_contrapositive_currified; lra)) as H.
  assert (Ds : forall b c z, Vec3.dot (vscale b c) z = b * Vec3.dot c z) by (intros; unfold_vec; ring).
  assert (Row : forall C v, Vec3.dot (arm_row l C) v = Vec3.dot (Arm.rod l C) v / (r * arm_eta l C)) by (intros C v; unfold arm_row; fold r; rewrite Ds; unfold Rdiv; ring).
  assert (Nw : Vec3.dot (Arm.rod l (path 0)) (V 0) = w * (r * h)) by (unfold w; rewrite Row; fold h; field; split; [exact h0 | lra]).
  eapply derivable_eq; [exact H | intro u; rewrite Row; reflexivity |]. cbv beta. fold h. rewrite Nw, Row. fold h. unfold arm_bent. cbv zeta. fold w r h f g. unfold Rsqr.
  assert (P1 : Vec3.dot (vsub (V 0) (vscale (r * w) (vsub (vscale (arm_cosine l (path 0)) (quarter l)) (vscale (arm_sine l (path 0)) (motor_zero l))))) (V 0) = norm2 (V 0) - r * w * g)
    by (unfold g; generalize (V 0) (quarter l) (motor_zero l); intros [x y z] [x1 y1 z1] [x2 y2 z2]; unfold Vec3.dot, norm2, vsub, vscale; cbn [Vec3.vx Vec3.vy Vec3.vz]; ring).
  rewrite P1. field. split; [exact h0 | lra].
Qed.

Section Named.
Context {names : naming}.

Definition own_bent (l : driven) (C c : vec) : R :=
  match l with
  | Linear (Guided g) => working_mode g * ((norm2 c - Vec3.dot (axis g) c ^ 2) / Kinematics.s g C + Vec3.dot (r g C) c ^ 2 / Kinematics.s g C ^ 3)
  | Linear (Extensible base platform _) => let w := span base platform C in (norm2 c - Vec3.dot w c ^ 2 / norm2 w) / sqrt (norm2 w)
  | Linear (Plane _) => 0
  | Rotary a => arm_bent a C c
  end.
Lemma own_accelerates : forall l path V a, well_formed_driven l -> own_reach l (path 0) -> has_velocity path 0 (V 0) -> has_velocity V 0 a ->
  derivable_pt_lim (fun t => Vec3.dot (own_row l (path t)) (V t)) 0 (Vec3.dot (own_row l (path 0)) a + own_bent l (path 0) (V 0)).
Proof.
  intros [[g | base platform ax | n] | l] path V a ok reach hp hv; cbn [well_formed_driven well_formed_leg own_reach reaches own_row row own_bent] in *.
  - pose proof (slider_accelerates g path V a ok reach hp hv) as D. eapply derivable_eq; [exact D | reflexivity |]. f_equal.
    unfold Jinv_row, eta. f_equal. f_equal. pose proof (mode_squared g ok) as m2. generalize (r g (path 0)). intros [x y z]. unfold vscale. cbn [Vec3.vx Vec3.vy Vec3.vz].
    assert (M : working_mode g = 1 \/ working_mode g = -1) by (destruct (Req_dec (working_mode g) 1); [auto | right; nra]). destruct M as [-> | ->]; f_equal; field; lra.
  - pose proof (Acceleration.strut_accelerates base platform path V a reach hp hv) as D. cbv zeta in D. eapply derivable_eq; [exact D | reflexivity |]. cbv zeta. unfold normalised.
    pose proof (sqrt_lt_R0 _ reach) as z0. assert (zz : norm2 (span base platform (path 0)) = sqrt (norm2 (span base platform (path 0))) ^ 2) by (rewrite pow2_sqrt; lra).
    set (z := sqrt (norm2 (span base platform (path 0)))) in *. rewrite zz. generalize (span base platform (path 0)) (V 0). intros [u1 u2 u3] [v1 v2 v3]. destruct a as [a1 a2 a3]. unfold Rsqr, Vec3.dot, norm2, vscale. cbn [Vec3.vx Vec3.vy Vec3.vz]. field. lra.
  - pose proof (velocity_dot V 0 a (normalised n) hv) as D. eapply derivable_eq; [exact D | reflexivity | ring].
  - exact (arm_accelerates l path V a ok reach hp hv).
Qed.

(** Without what the platform's acceleration adds. *)
Definition leg_bent (l : driven) (P : vec) (Q : mat) (V W : vec) : R :=
  let r := mulv Q (offset l) in let u := own_row l (carried l P Q) in
  own_bent l (carried l P Q) (vadd V (cross W r)) + (Vec3.dot u W * Vec3.dot r W - Vec3.dot u r * norm2 W).
Lemma own_bent_scaled : forall l C t c, own_bent l C (vscale t c) = t ^ 2 * own_bent l C c.
Proof.
  assert (D : forall t c u, Vec3.dot u (vscale t c) = t * Vec3.dot u c) by (intros t [x y z] [x' y' z']; unfold Vec3.dot, vscale; cbn [Vec3.vx Vec3.vy Vec3.vz]; ring).
  assert (N : forall t c, norm2 (vscale t c) = t ^ 2 * norm2 c) by (intros; apply norm2_scale).
  intros [[g | base platform ax | n] | l] C t c; cbn [own_bent]; unfold arm_bent; cbv zeta; rewrite ?D, ?N; unfold Rdiv; ring.
Qed.
Lemma leg_bent_scaled : forall l P Q t V W, leg_bent l P Q (vscale t V) (vscale t W) = t ^ 2 * leg_bent l P Q V W.
Proof.
  intros l P Q t V W. unfold leg_bent. cbv zeta. generalize (own_row l (carried l P Q)) (mulv Q (offset l)). intros u r.
  replace (vadd (vscale t V) (cross (vscale t W) r)) with (vscale t (vadd V (cross W r))) by (destruct V, W, r; unfold vadd, vscale, cross; cbn [Vec3.vx Vec3.vy Vec3.vz]; f_equal; ring).
  rewrite own_bent_scaled. destruct u as [u1 u2 u3], r as [r1 r2 r3], W as [w1 w2 w3]. unfold Vec3.dot, norm2, vscale. cbn [Vec3.vx Vec3.vy Vec3.vz]. ring.
Qed.

Lemma leg_accelerates_only : forall k ell l P Q V W A B y, match k with Turns _ => ell <> 0 | _ => True end -> well_formed_driven l -> own_reach l (carried l P Q) -> has_velocities k V W ->
  leg_accelerates k ell l P Q (velocities k V (vscale ell W)) (velocities k A (vscale ell B)) y ->
  joint_unit l y = Linear.dot (driven_row k ell P Q l) (velocities k A (vscale ell B)) + leg_bent l P Q V W.
Proof.
  intros k ell l P Q V W A B y l0 ok reach hk h. set (position := fun t => vadd P (vscale t V)). set (velocity := fun t => vadd V (vscale t A)). set (omega := fun t => vadd W (vscale t B)).
  assert (Z : forall p q, vadd p (vscale 0 q) = p) by (intros [p1 p2 p3] [q1 q2 q3]; unfold vadd, vscale; cbn [Vec3.vx Vec3.vy Vec3.vz]; f_equal; ring).
  assert (eP : position 0 = P) by apply Z. assert (eV : velocity 0 = V) by apply Z. assert (eW : omega 0 = W) by apply Z. assert (eQ : spun Q W 0 = Q) by apply spun_start.
  assert (hp : has_velocity position 0 V) by apply along_line. assert (ht : turns (spun Q W) 0 W) by apply spun_turns.
  pose proof (carried_velocity l position (spun Q W) 0 V W hp ht) as hc. cbv beta in hc. rewrite eQ in hc.
  destruct (tip_moves k l (spun Q W) velocity omega V W A B eV eW ht (along_line V A) (along_line W B) hk) as [hD e]. cbv zeta in hD, e. rewrite eQ in hD, e.
  pose (path := fun t => carried l (position t) (spun Q W t)). pose (U := fun t => vadd (shifts_of k (velocity t)) (cross (spins_of k (omega t)) (mulv (spun Q W t) (offset l)))).
  assert (e' : U 0 = vadd V (cross W (mulv Q (offset l)))) by (unfold U; rewrite eQ; exact e).
  assert (p0 : path 0 = carried l P Q) by (unfold path; rewrite eP, eQ; reflexivity).
  pose proof (own_accelerates l path U _ ok ltac:(rewrite p0; exact reach) ltac:(rewrite e'; exact hc) hD) as D. rewrite p0, e' in D.
  rewrite <- eV in hp at 1. rewrite <- eW in ht at 2. assert (hk' : has_velocities k (velocity 0) (omega 0)) by (rewrite eV, eW; exact hk).
  specialize (h position (spun Q W) velocity omega A B eP eQ hp ht (along_line V A) (along_line W B) hk'). rewrite eV, eW in h. specialize (h eq_refl eq_refl).
  assert (D' : derivable_pt_lim (fun t => Linear.dot (driven_row k ell (position t) (spun Q W t) l) (velocities k (velocity t) (vscale ell (omega t)))) 0
    (Linear.dot (driven_row k ell P Q l) (velocities k A (vscale ell B)) + leg_bent l P Q V W)).
  { eapply derivable_eq; [exact D | intro t; unfold driven_row; cbv zeta; rewrite velocities_dot by exact l0; reflexivity |].
    unfold driven_row, leg_bent. cbv zeta. rewrite velocities_dot by exact l0. generalize (own_row l (carried l P Q)) (shifts_of k A) (spins_of k B) (mulv Q (offset l)) (own_bent l (carried l P Q) (vadd V (cross W (mulv Q (offset l))))). intros. unfold_vec. ring. }
  exact (uniqueness_limite _ _ _ _ h D').
Qed.

(** ** In exact numbers *)

Definition nshift_of (k : mobility) (v : list number) : numbers :=
  let at_ i := nth i v (0 // 1) in match k with Translates => Numbers (at_ 0%nat) (at_ 1%nat) (at_ 2%nat) | TranslatesInPlane => Numbers (at_ 0%nat) (at_ 1%nat) (0 // 1) | Turns k => nshift k v end.
Definition nspin_of (k : mobility) (v : list number) : numbers := match k with Turns k => nspin k v | _ => Numbers (0 // 1) (0 // 1) (0 // 1) end.
Definition shift_in (k : mobility) (v : list R) : vec :=
  match k with Translates => Vec (nth 0 v 0) (nth 1 v 0) (nth 2 v 0) | TranslatesInPlane => Vec (nth 0 v 0) (nth 1 v 0) 0 | Turns k => shift_of k v end.
Definition spin_in (k : mobility) (v : list R) : vec := match k with Turns k => spin_of k v | _ => vzero end.
Lemma nparts_of : forall k v, values (nshift_of k v) = shift_in k (map value v) /\ values (nspin_of k v) = spin_in k (map value v).
Proof.
  intros k v. assert (E : forall i, nth i (map value v) 0 = value (nth i v (0 // 1))) by (intro i; rewrite <- zero_value; apply map_nth).
  destruct k; [| | exact (nparts k v)]; unfold nshift_of, nspin_of, shift_in, spin_in, values, vzero; cbv zeta; cbn [nx ny nz]; rewrite !E, ?zero_value; split; reflexivity.
Qed.
Lemma is_velocities : forall k ell t v, match k with Turns _ => ell <> 0 | _ => True end -> length v = freedom k ->
  map (Rmult t) v = velocities k (vscale t (shift_in k v)) (vscale ell (vscale t (vscale (/ ell) (spin_in k v)))) /\ has_velocities k (vscale t (shift_in k v)) (vscale t (vscale (/ ell) (spin_in k v))).
Proof.
  intros k ell t v l0 lv. destruct k as [| | k]; cbn [freedom] in lv.
  - destruct v as [| a [| b [| c [| ? ?]]]]; try discriminate. cbn. split; [reflexivity |]. unfold vscale, vzero. cbn. f_equal; ring.
  - destruct v as [| a [| b [| ? ?]]]; try discriminate. cbn. split; [reflexivity |]. split; [ring |]. unfold vscale, vzero. cbn. f_equal; ring.
  - split.
    + cbn [velocities shift_in spin_in]. rewrite (is_twist k v lv) at 1. exact (Accelerated.twist_scaled k _ t _ _ l0).
    + cbn [has_velocities shift_in spin_in]. destruct k; cbn; [repeat split; ring | exact I | unfold vscale, vzero; cbn; f_equal; ring].
Qed.

Definition nown_bent (l : exact_driven) (C c : numbers) : number :=
  let sq x := Times x x in
  match l with
  | XLinear (ExactSlider d a p len m) => let e := signed_root m (clearance2 d a p len C) in
      Plus (Over (Minus (product c c) (sq (product (unit_of d) c))) e) (Over (sq (product (Witness.across d a p C) c)) (Times e (sq e)))
  | XLinear (ExactStrut a p _) => let w := nspan a p C in Over (Minus (product c c) (Over (sq (product w c)) (product w w))) (Root (product w w))
  | XLinear (ExactPlanar _) => 0 // 1
  | XRotary i => let w := product (xrow i C) c in
      Over (Plus (Minus (product c c) (Times (Times (2 // 1) (Times (xarm i) w)) (Minus (Times (xcosine i C) (product (xquarter i) c)) (Times (xsine i C) (product (xzero i) c)))))
        (Times (Times (xarm i) (sq w)) (xforward i C))) (Times (xarm i) (xeta i C))
  end.
Lemma value_own_bent : forall l C c, well_formed_driven (driven_of l) -> own_reach (driven_of l) (values C) -> value (nown_bent l C c) = own_bent (driven_of l) (values C) (values c).
Proof.
  intros [[d a p len m | a p ax | d] | i] C c ok reach; cbn [nown_bent own_bent driven_of leg_of well_formed_driven well_formed_leg own_reach reaches] in *; cbv zeta; cbn [value].
  - rewrite !value_product, value_signed_root, values_unit, (values_across d a p (value len) (if m then 1 else -1) C), <- norm2_dot. unfold eta. cbn [working_mode axis].
    set (z := Kinematics.s _ _) in *. set (w := r _ _). assert (M : (if m then 1 else -1) = 1 \/ (if m then 1 else -1) = -1) by (destruct m; auto). destruct M as [-> | ->]; field; lra.
  - rewrite !value_product, <- !norm2_dot. change (values (nspan a p C)) with (span (values a) (values p) (values C)) in *.
    change (sqrt (value (product (nspan a p C) (nspan a p C)))) with (sqrt (Vec3.dot (span (values a) (values p) (values C)) (span (values a) (values p) (values C)))). rewrite <- ?norm2_dot.
    pose proof (sqrt_lt_R0 _ reach). field. split; lra.
  - lra.
  - unfold arm_bent. cbv zeta. rewrite !value_product, values_xrow, value_xcosine, value_xsine, values_xquarter, values_xzero, value_xforward, value_xeta, <- norm2_dot. cbn [arm_length arm_of]. f_equal. ring_simplify. lra.
Qed.

Section Pose.
Variables (k : mobility) (ell : number) (o : option orientations) (c : list number) (P : numbers) (Q : mat).
Hypothesis is_turn : forall b, values (nturn o c b) = mulv Q (values b).
Definition nleg_bent (l : exact_driven) (v : list number) : number :=
  let r := nturn o c (xoffset l) in let C := xcarried o c P l in let W := scaled (Over (1 // 1) ell) (nspin_of k v) in
  let u := match l with XLinear i => nrow i C | XRotary i => xrow i C end in
  Plus (nown_bent l C (each2 Plus (nshift_of k v) (ncrossed W r))) (Minus (Times (product u W) (product r W)) (Times (product u r) (product W W))).
Lemma value_leg_bent : forall l v, well_formed_driven (driven_of l) -> own_reach (driven_of l) (carried (driven_of l) (values P) Q) ->
  value (nleg_bent l v) = leg_bent (driven_of l) (values P) Q (shift_in k (map value v)) (vscale (/ value ell) (spin_in k (map value v))).
Proof.
  intros l v ok reach. unfold nleg_bent, leg_bent. cbv zeta. pose proof (values_carried o c P Q is_turn l) as Cv.
  assert (O : values (xoffset l) = offset (driven_of l)) by (destruct l as [[d a p len m | a p q | d] | i]; try reflexivity; unfold values; cbn; unfold vzero; f_equal; lra).
  assert (U : values (match l with XLinear i => nrow i (xcarried o c P l) | XRotary i => xrow i (xcarried o c P l) end) = own_row (driven_of l) (values (xcarried o c P l)))
    by (destruct l as [i | i]; cbn [own_row driven_of]; [apply values_row | apply values_xrow]).
  assert (I : value (Over (1 // 1) ell) = / value ell) by (cbn [value]; unfold Rdiv; rewrite Rinv_1; ring). destruct (nparts_of k v) as [E1 E2].
  set (u := match l with XLinear i => nrow i _ | XRotary i => _ end) in *. cbn [value]. rewrite value_own_bent by (rewrite ?Cv; assumption).
  rewrite !value_product, U, values_plus, values_crossed, values_scaled, I, E1, E2, is_turn, O, Cv, <- norm2_dot. reflexivity.
Qed.
End Pose.

Section Precision.
Variable bits : positive.
Local Notation certainly := (certainly bits).

(** With the acceleration p, the speed q along [v] and the bound b: p |row| |v|^2 + q^2 |..| > b |v|^2, in either sign; of angles b is in degrees. *)
Definition is_hastened (k : mobility) (ell : number) (o : option orientations) (c : list number) (P : numbers) (l : exact_driven) (p q b : number) (v : list number) : bool :=
  let row := xdriven_row k ell o c P l in let size := ndot v v in
  let first := Times (Times p (Root (ndot row row))) size in let second := Times (Times q q) (nleg_bent k ell o c P l v) in let least := Times b size in
  Nat.eqb (length v) (freedom k) && certainly true size && match k with Turns _ => certainly true ell | _ => true end &&
  match l with
  | XLinear _ => certainly true (Minus (Plus first second) least) || certainly true (Minus (Minus first second) least)
  | XRotary _ => match enclose bits first, enclose bits second, enclose bits least with
      | Some f, Some s, Some b => match radians bits b with Some b => is_positive (Some (sub (add f s) b)) || is_positive (Some (sub (sub f s) b)) | None => false end
      | _, _, _ => false
      end
  end.

Lemma is_hastened_sound : forall k ell o c P l p q b v Q, (forall b, values (nturn o c b) = mulv Q (values b)) -> well_formed_driven (driven_of l) ->
  is_hastened k ell o c P l p q b v = true -> own_reach (driven_of l) (carried (driven_of l) (values P) Q) ->
  exists w a, length w = freedom k /\ length a = freedom k /\ Linear.dot w w <= value q ^ 2 /\ Linear.dot a a <= value p ^ 2 /\
    forall y, leg_accelerates k (value ell) (driven_of l) (values P) Q w a y -> value b < Rabs y.
Proof.
  intros k ell o c P l p q b v Q is_turn ok h reach. unfold is_hastened in h. cbv zeta in h. apply andb_true_iff in h as [h beyond]. apply andb_true_iff in h as [h l0]. apply andb_true_iff in h as [lv size].
  apply Nat.eqb_eq in lv. apply (positive_sound bits) in size. rewrite value_ndot in size.
  assert (ne : match k with Turns _ => value ell <> 0 | _ => True end) by (destruct k; [exact I | exact I | apply (positive_sound bits) in l0; lra]). clear l0.
  set (row := driven_row k (value ell) (values P) Q (driven_of l)).
  assert (Er : map value (xdriven_row k ell o c P l) = row).
  { pose proof (exact_legs_stand k ell o c P Q is_turn [] [l] ltac:(constructor; [exact ok | constructor])) as [J _]. cbn in J. injection J as J. symmetry. exact J. }
  assert (lr : length row = freedom k) by (unfold row, driven_row; cbv zeta; destruct k as [| | []]; reflexivity).
  pose proof (value_leg_bent k ell o c P Q is_turn l v ok reach) as EX. set (v' := map value v) in *. set (n := Linear.dot v' v') in *.
  set (V := shift_in k v') in *. set (W := vscale (/ value ell) (spin_in k v')) in *. set (X := leg_bent (driven_of l) (values P) Q V W) in *.
  set (g := sqrt (Linear.dot row row)). assert (g0 : 0 <= g) by apply sqrt_pos. assert (g2 : g * g = Linear.dot row row) by (apply sqrt_sqrt, Linear.dot_self).
  pose (b' := joint_unit (driven_of l) (value b)).
  assert (S : exists s, s * s = 1 /\ b' * n < value p * g * n + s * (value q * value q * X)).
  { assert (V1 : value (Times (Times p (Root (ndot (xdriven_row k ell o c P l) (xdriven_row k ell o c P l)))) (ndot v v)) = value p * g * n)
      by (cbn [value]; rewrite !value_ndot, Er; reflexivity).
    assert (V2 : value (Times (Times q q) (nleg_bent k ell o c P l v)) = value q * value q * X) by (cbn [value]; rewrite EX; reflexivity).
    assert (V3 : value (Times b (ndot v v)) = value b * n) by (cbn [value]; rewrite value_ndot; reflexivity).
    set (first := Times (Times p _) _) in *. set (second := Times (Times q q) _) in *. set (least := Times b _) in *.
    destruct l as [i | i]; cbn [driven_of joint_unit] in b'.
    - apply orb_true_iff in beyond as [beyond | beyond]; apply (positive_sound bits) in beyond; change (value (Minus (Plus first second) least)) with (value first + value second - value least) in beyond || change (value (Minus (Minus first second) least)) with (value first - value second - value least) in beyond;
        rewrite V1, V2, V3 in beyond; [exists 1 | exists (-1)]; (split; [ring | unfold b'; lra]).
    - destruct (enclose bits first) as [ff |] eqn:e1; [| discriminate]. destruct (enclose bits second) as [fs |] eqn:e2; [| discriminate]. destruct (enclose bits least) as [fl |] eqn:e3; [| discriminate].
      destruct (radians bits fl) as [fr |] eqn:e4; [| discriminate]. apply enclose_sound in e1, e2, e3. pose proof (radians_sound bits _ _ _ e4 e3) as R0. rewrite V1 in e1. rewrite V2 in e2. rewrite V3 in R0.
      assert (D : in_degrees (value b * n) = b' * n) by (unfold b', in_degrees; field). rewrite D in R0.
      apply orb_true_iff in beyond as [beyond | beyond]; [exists 1 | exists (-1)]; (split; [ring |]).
      + pose proof (is_positive_sound bits _ _ beyond (sub_sound bits _ _ _ _ (add_sound bits _ _ _ _ e1 e2) R0)). lra.
      + pose proof (is_positive_sound bits _ _ beyond (sub_sound bits _ _ _ _ (sub_sound bits _ _ _ _ e1 e2) R0)). lra. }
  destruct S as [s [ss big]]. set (t := value q / sqrt n). pose proof (sqrt_lt_R0 _ size) as n0. assert (n2 : sqrt n * sqrt n = n) by (apply sqrt_sqrt; lra).
  assert (t2 : t ^ 2 * n = value q ^ 2) by (unfold t; clear - n0 n2; revert n0 n2; generalize (sqrt n); intros z n0 n2; rewrite <- n2; field; lra).
  set (w := map (Rmult t) v'). set (a := map (Rmult (s * value p / g)) row).
  assert (ag : Linear.dot row a = s * value p * g /\ Linear.dot a a <= value p ^ 2).
  { assert (D : forall x, Linear.dot row (map (Rmult x) row) = x * (g * g)) by (intro x; rewrite Solve.dot_commutes, dot_map, g2; reflexivity). unfold a. rewrite dot_map, !D. clear D. destruct (Req_dec g 0) as [-> | nz].
    - split; [ring |]. rewrite Rmult_0_l, !Rmult_0_r. apply pow2_ge_0.
    - split; [field; exact nz |]. right. replace (s * value p / g * (s * value p / g * (g * g))) with (s * s * value p ^ 2) by (field; exact nz). rewrite ss. ring. }
  destruct ag as [a1 a2]. exists w, a.
  assert (la : length a = freedom k) by (unfold a; rewrite map_length; exact lr). assert (lv' : length v' = freedom k) by (unfold v'; rewrite map_length; exact lv).
  split; [unfold w; rewrite map_length; exact lv' |]. split; [exact la |].
  split; [unfold w; rewrite dot_map, Solve.dot_commutes, dot_map; fold n; lra |]. split; [exact a2 |].
  intros y hy. destruct (is_velocities k (value ell) t v' ne lv') as [Ew Of]. destruct (is_velocities k (value ell) 1 a ne la) as [Ea _].
  assert (A1 : map (Rmult 1) a = a) by (rewrite <- (map_id a) at 2; apply map_ext; intro; ring). rewrite A1 in Ea.
  fold w in Ew. rewrite Ew, Ea in hy. apply (leg_accelerates_only k _ _ _ _ _ _ _ _ _ ne ok reach Of) in hy. rewrite <- Ea in hy. fold row in hy. fold V W in hy. rewrite a1, leg_bent_scaled in hy. fold X in hy.
  assert (Y : b' < s * joint_unit (driven_of l) y).
  { apply Rmult_lt_reg_r with n; [exact size |]. rewrite hy. replace (s * (s * value p * g + t ^ 2 * X) * n) with (s * s * (value p * g * n) + s * ((t ^ 2 * n) * X)) by ring. rewrite ss, t2.
    replace (value q ^ 2) with (value q * value q) by ring. lra. }
  assert (Y' : value b < s * y).
  { unfold b' in Y. destruct l; cbn [driven_of joint_unit] in Y; [exact Y |]. unfold in_degrees in Y. pose proof PI_RGT_0 as p0. apply Rmult_lt_reg_r with (PI / 180); lra. }
  assert (A : Rabs s = 1) by (assert (s = 1 \/ s = -1) as [-> | ->] by (destruct (Req_dec s 1); [left; assumption | right; apply Rmult_eq_reg_l with (s - 1); [| lra]; ring_simplify; replace (s ^ 2) with (s * s) by ring; lra]); [apply Rabs_R1 | rewrite Rabs_left; lra]).
  apply Rlt_le_trans with (1 := Y'). rewrite <- (Rmult_1_l (Rabs y)), <- A, <- Rabs_mult. apply Rle_abs.
Qed.

(** A sign says how fast sliders and struts of platforms that do not turn are, in whichever of these directions there is. *)
Definition fastest (k : mobility) (l : exact_driven) (C : numbers) : list (list number) :=
  let every a := map (fun e => let u := ncrossed a e in [nx u; ny u; nz u]) [Numbers (1 // 1) (0 // 1) (0 // 1); Numbers (0 // 1) (1 // 1) (0 // 1); Numbers (0 // 1) (0 // 1) (1 // 1)] in
  let beside a := [[Minus (0 // 1) (ny a); nx a]] in
  match k, l with
  | Translates, XLinear (ExactSlider d a p _ _) => let r := Witness.across d a p C in [nx r; ny r; nz r] :: every d
  | Translates, XLinear (ExactStrut a p _) => every (nspan a p C)
  | TranslatesInPlane, XLinear (ExactSlider d _ _ _ _) => beside d
  | TranslatesInPlane, XLinear (ExactStrut a p _) => beside (nspan a p C)
  | _, _ => []
  end.
Definition directions_of (k : mobility) (l : exact_driven) (C : numbers) (vs : list (list Z)) : list (list number) :=
  match k, l, vs with
  | (Translates | TranslatesInPlane), XLinear (ExactSlider _ _ _ _ _ | ExactStrut _ _ _), [] => fastest k l C
  | (Translates | TranslatesInPlane), XLinear (ExactSlider _ _ _ _ _ | ExactStrut _ _ _), _ => []
  | _, _, [v] => [integers_of v]
  | _, _, _ => []
  end.
Definition refute_hastened (c : driven_claim) (ls : list exact_driven) (P : numbers) (t : list number) (test : nat) (vs : list (list Z)) : bool :=
  let k := mobility_of c in
  all_exact bits (drives c) ls && is_exact_pose bits c P t &&
  match test_at bits (parts_near k) test (driven_demands c) with
  | Some (AccelerationMax i p q b, _) => match nth_error ls i with
      | Some l => existsb (is_hastened k (length_of c) (turned_by c) t P l p q b) (directions_of k l (xcarried (turned_by c) t P l) vs)
      | None => false
      end
  | _ => false
  end.

Theorem refute_hastened_sound : forall c ls P t test vs, refute_hastened c ls P t test vs = true ->
  exists m P Q, Forall well_formed_driven m /\ is_about_driven c m P Q /\ ~ meets_driven c m P Q.
Proof.
  intros c ls P t test vs h. unfold refute_hastened in h. cbv zeta in h. apply andb_true_iff in h as [h r]. apply andb_true_iff in h as [h p]. destruct (all_exact_sound bits _ _ h) as [h1 h2].
  destruct (is_exact_pose_sound bits _ _ _ p) as [Q [q1 q2]]. exists (map driven_of ls), (values P), Q. split; [exact h2 |]. split; [split; assumption |].
  intros [reached [_ met]]. destruct (test_at _ _ _ _) as [[d which] |] eqn:e; [| discriminate]. destruct d; try discriminate. apply test_at_in in e. rewrite Forall_forall in met. specialize (met _ e).
  destruct (nth_error ls joint) as [l |] eqn:el; [| discriminate]. cbn [fulfils legs_at accelerates] in met. cbn [legs_at Configuration.reached] in reached.
  rewrite Forall_map, Forall_forall in reached. specialize (reached l (nth_error_In _ _ el)). rewrite Forall_map, Forall_forall in h2. specialize (h2 l (nth_error_In _ _ el)).
  apply existsb_exists in r as [v [_ r]]. destruct (is_hastened_sound _ _ _ _ _ _ _ _ _ _ _ q2 h2 r reached) as [w [a [lw [la [hw [ha far]]]]]]. destruct (met w a lw la hw ha) as [y [hy le]].
  cbn [legs_at accelerates] in hy. rewrite nth_error_map, el in hy. cbn [option_map] in hy. specialize (far y hy). lra.
Qed.
End Precision.
End Named.
