(** * Legs on arms that turn: kinematics, and in exact numbers

    A rod of length L joins the platform to an arm of length r, which turns about
    a fixed axis; the joint coordinate is the arm's angle. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert.kernel Require Import Elbow Linear Configuration.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Claim.
From Orthocert.kernel Require Import Statement Machine Witness.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Kinematics *)

Record arm := Arm {
  motor_axis : vec;        (* k, a unit vector *)
  motor_zero : vec;        (* e, that of the arm at the angle 0: orthogonal to k *)
  motor : vec;             (* the point of the axis about which the arm turns *)
  arm_offset : vec;        (* C - P, from the platform's point to its joint *)
  arm_length : R;          (* r *)
  rod_length : R;          (* L *)
  arm_mode : R             (* +1 or -1: the sign of eta *)
}.

Definition well_formed_arm (l : arm) : Prop :=
  norm2 (motor_axis l) = 1 /\ norm2 (motor_zero l) = 1 /\ dot (motor_axis l) (motor_zero l) = 0 /\
  0 < arm_length l /\ 0 < rod_length l /\ (arm_mode l = 1 \/ arm_mode l = -1).

Section At.
Variable l : arm.
Variable P : vec.

(** From the motor to the platform's joint: along e, along f = k x e, and along the axis. *)
Definition from_motor : vec := vsub (vadd P (arm_offset l)) (motor l).
Definition quarter : vec := cross (motor_axis l) (motor_zero l).
Definition along : R := dot (motor_zero l) from_motor.
Definition across : R := dot quarter from_motor.
Definition height : R := dot (motor_axis l) from_motor.

(** The component in the direction of the arm, by the law of cosines; and eta, that orthogonal to
    it, of the rod too: the rod's component along the motion of the elbow. *)
Definition forward : R := (along ^ 2 + across ^ 2 + (height ^ 2 + (arm_length l ^ 2 - rod_length l ^ 2))) / (2 * arm_length l).
Definition clearance : R := rod_length l ^ 2 - height ^ 2 - (forward - arm_length l) ^ 2.
Definition arm_eta : R := arm_mode l * sqrt clearance.

(** The arm's angle. *)
Definition arm_cosine : R := (forward * along + arm_eta * across) / (along ^ 2 + across ^ 2).
Definition arm_sine : R := (forward * across - arm_eta * along) / (along ^ 2 + across ^ 2).
Definition elbow : vec :=
  vadd (motor l) (vscale (arm_length l) (vadd (vscale arm_cosine (motor_zero l)) (vscale arm_sine quarter))).
Definition rod : vec := vsub (vadd P (arm_offset l)) elbow.

(** The leg reaches P and is not serially singular there. *)
Definition arm_reaches : Prop := 0 < clearance.
(** The row of M: angle' = row . P', in radians ([angle_velocity]). *)
Definition arm_row : vec := vscale (/ (arm_length l * arm_eta)) rod.
End At.

(** ** That these are the kinematics *)

Lemma gram : forall k e w, norm2 k = 1 -> norm2 e = 1 -> dot k e = 0 ->
  norm2 w = dot e w ^ 2 + dot (cross k e) w ^ 2 + dot k w ^ 2.
Proof.
  intros k e w hk he ho.
  assert (G : dot (cross k e) w ^ 2 = norm2 w * norm2 k * norm2 e + 2 * dot k w * dot k e * dot e w
    - norm2 w * dot k e ^ 2 - norm2 k * dot e w ^ 2 - norm2 e * dot k w ^ 2)
    by (clear; vec_ring).
  rewrite G, hk, he, ho. ring.
Qed.

Lemma norm2_across : forall w e q r c s, norm2 (vsub w (vscale r (vadd (vscale c e) (vscale s q))))
  = norm2 w - 2 * r * (c * dot e w + s * dot q w) + r ^ 2 * (c ^ 2 * norm2 e + s ^ 2 * norm2 q + 2 * c * s * dot q e).
Proof. vec_ring. Qed.
Lemma dot_across : forall w e q r c s,
  dot (vsub w (vscale r (vadd (vscale c e) (vscale s q)))) (vsub (vscale c q) (vscale s e))
  = c * dot q w - s * dot e w - r * (c * s * (norm2 q - norm2 e) + (c ^ 2 - s ^ 2) * dot q e).
Proof. vec_ring. Qed.
Lemma cross_orthogonal : forall k e, dot (cross k e) e = 0.
Proof. vec_ring. Qed.

Section Closure.
Variable l : arm.
Variable P : vec.
Hypothesis ok : well_formed_arm l.
Hypothesis reach : arm_reaches l P.
Let N := along l P ^ 2 + across l P ^ 2.

Lemma eta_squared : arm_eta l P ^ 2 = clearance l P.
Proof.
  destruct ok as [_ [_ [_ [_ [_ m]]]]]. unfold arm_eta. rewrite Rpow_mult_distr, <- (Rsqr_pow2 (sqrt _)), Rsqr_sqrt by (apply Rlt_le, reach).
  destruct m as [-> | ->]; ring.
Qed.

Lemma distance_split : N = forward l P ^ 2 + arm_eta l P ^ 2 /\ 0 < N.
Proof.
  destruct ok as [_ [_ [_ [r0 _]]]]. assert (E : N = forward l P ^ 2 + arm_eta l P ^ 2).
  { rewrite eta_squared. unfold clearance.
    assert (F : 2 * arm_length l * forward l P = N + (height l P ^ 2 + (arm_length l ^ 2 - rod_length l ^ 2)))
      by (unfold forward, N; field; lra). lra. }
  split; [exact E |]. rewrite E, eta_squared. pose proof (pow2_ge_0 (forward l P)). unfold arm_reaches in reach. lra.
Qed.

(** The arm's direction is a unit vector, and the joint's components in it are forward and eta. *)
Lemma angle_splits : arm_cosine l P ^ 2 + arm_sine l P ^ 2 = 1 /\
  arm_cosine l P * along l P + arm_sine l P * across l P = forward l P /\
  arm_cosine l P * across l P - arm_sine l P * along l P = arm_eta l P.
Proof.
  destruct distance_split as [E N0]. unfold arm_cosine, arm_sine. fold N.
  set (g := forward l P) in *. set (h := arm_eta l P) in *. set (a := along l P) in *. set (b := across l P) in *.
  assert (EN : N = a ^ 2 + b ^ 2) by reflexivity. clearbody N g h a b. split; [| split].
  - replace (((g * a + h * b) / N) ^ 2 + ((g * b - h * a) / N) ^ 2) with ((g ^ 2 + h ^ 2) * (a ^ 2 + b ^ 2) / N ^ 2) by (field; lra).
    rewrite <- E, <- EN. field. lra.
  - replace ((g * a + h * b) / N * a + (g * b - h * a) / N * b) with (g * (a ^ 2 + b ^ 2) / N) by (field; lra). rewrite <- EN. field. lra.
  - replace ((g * a + h * b) / N * b - (g * b - h * a) / N * a) with (h * (a ^ 2 + b ^ 2) / N) by (field; lra). rewrite <- EN. field. lra.
Qed.

(** The rod has its length, and eta is its component along the motion of the elbow. *)
Theorem rod_closes : norm2 (rod l P) = rod_length l ^ 2 /\
  dot (rod l P) (vsub (vscale (arm_cosine l P) (quarter l)) (vscale (arm_sine l P) (motor_zero l))) = arm_eta l P.
Proof.
  destruct angle_splits as [u [g h]]. destruct distance_split as [E N0]. pose proof eta_squared as D.
  destruct ok as [hk [he [ho [r0 _]]]]. unfold clearance in D. fold N in E.
  pose proof (gram _ _ (from_motor l P) hk he ho) as W. fold (quarter l) (along l P) (across l P) (height l P) in W.
  assert (Q : norm2 (quarter l) = 1) by (unfold quarter; pose proof (lagrange (motor_axis l) (motor_zero l)) as La; rewrite hk, he, ho in La; lra).
  assert (Z : dot (quarter l) (motor_zero l) = 0) by (apply cross_orthogonal).
  assert (R : rod l P = vsub (from_motor l P) (vscale (arm_length l) (vadd (vscale (arm_cosine l P) (motor_zero l)) (vscale (arm_sine l P) (quarter l)))))
    by (unfold rod, elbow, from_motor, vsub, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
  rewrite R. unfold N, along, across in E. unfold along, across in g, h, W. set (c := arm_cosine l P) in *. set (s := arm_sine l P) in *. set (w := from_motor l P) in *.
  set (q := quarter l) in *. set (e := motor_zero l) in *. set (r := arm_length l) in *. set (f := forward l P) in *.
  set (t := arm_eta l P) in *. split.
  - rewrite norm2_across.
    rewrite g, he, Q, Z, W, E. clearbody f t c s r.
    replace (r ^ 2 * (c ^ 2 * 1 + s ^ 2 * 1 + 2 * c * s * 0)) with (r ^ 2 * (c ^ 2 + s ^ 2)) by ring. rewrite u, D. ring.
  - rewrite dot_across.
    rewrite h, he, Q, Z. ring.
Qed.
End Closure.

Lemma gram_product : forall k e w v, norm2 k = 1 -> norm2 e = 1 -> dot k e = 0 ->
  dot w v = dot e w * dot e v + dot (cross k e) w * dot (cross k e) v + dot k w * dot k v.
Proof.
  intros k e w v hk he ho. pose proof (gram k e (vadd w v) hk he ho) as S. pose proof (gram k e w hk he ho) as A.
  pose proof (gram k e v hk he ho) as B. assert (D : forall u, dot u (vadd w v) = dot u w + dot u v) by (clear; vec_ring).
  assert (N : norm2 (vadd w v) = norm2 w + norm2 v + 2 * dot w v) by (clear; vec_ring). rewrite !D, N in S. lra.
Qed.

(** A guard on the model: along any differentiable trajectory P(t), the arm turns at the speed row . P'. *)
Theorem angle_velocity : forall l P t V, well_formed_arm l -> arm_reaches l (P t) -> has_velocity P t V ->
  let rate := dot (arm_row l (P t)) V in
  derivable_pt_lim (fun u => arm_cosine l (P u)) t (- arm_sine l (P t) * rate) /\
  derivable_pt_lim (fun u => arm_sine l (P u)) t (arm_cosine l (P t) * rate).
Proof.
  intros l P t V ok reach hv. cbv zeta. destruct (angle_splits l (P t) ok reach) as [u [eg eh]].
  destruct (distance_split l (P t) ok reach) as [EN N0]. pose proof (eta_squared l (P t) ok reach) as ED.
  destruct ok as [hk [he [ho [r0 [_ hm]]]]].
  assert (hw : has_velocity (fun u => from_motor l (P u)) t V)
    by exact (velocity_w (Leg vzero (motor l) (arm_offset l) 1 1) P t V hv).
  pose proof (velocity_dot _ t V (motor_zero l) hw) as hA. pose proof (velocity_dot _ t V (quarter l) hw) as hB.
  pose proof (velocity_dot _ t V (motor_axis l) hw) as hK. cbn beta in hA, hB, hK.
  fold (along l (P t)) in *. set (a := dot (motor_zero l) V) in *. set (b := dot (quarter l) V) in *. set (k := dot (motor_axis l) V) in *.
  set (A := along l (P t)) in *. set (B := across l (P t)) in *. set (K := height l (P t)) in *. set (r := arm_length l) in *.
  set (c := arm_cosine l (P t)) in *. set (s := arm_sine l (P t)) in *. set (g := forward l (P t)) in *. set (h := arm_eta l (P t)) in *.
  assert (h0 : h <> 0) by (intro z; rewrite z in ED; unfold arm_reaches in reach; lra).
  set (g' := (A * a + B * b + K * k) / r).
  assert (hN : derivable_pt_lim (fun u => along l (P u) ^ 2 + across l (P u) ^ 2) t (2 * A * a + 2 * B * b))
    by (apply derivable_add; apply derivable_square; assumption).
  assert (hg : derivable_pt_lim (fun u => forward l (P u)) t g').
  { eapply derivable_eq.
    - apply (derivable_scal (/ (2 * r))). apply derivable_add; [exact hN |]. apply derivable_add;
        [apply derivable_square; exact hK | apply (derivable_const (r ^ 2 - rod_length l ^ 2))].
    - intro u0. cbn beta. unfold forward, height. fold r. unfold Rdiv. ring.
    - unfold g', K, height. fold r. field. lra. }
  assert (hD : derivable_pt_lim (fun u => clearance l (P u)) t (- (2 * (K * k)) - 2 * (g - r) * g')).
  { eapply derivable_eq.
    - apply derivable_add; [apply (derivable_const (rod_length l ^ 2)) |]. apply derivable_add;
        [apply (derivable_scal (-1)), derivable_square; exact hK |].
      apply (derivable_scal (-1)), derivable_square. apply derivable_add; [exact hg | apply (derivable_const (- r))].
    - intro u0. cbn beta. unfold clearance, height. fold r. ring.
    - unfold K, height. fold g. ring. }
  assert (hh : derivable_pt_lim (fun u => arm_eta l (P u)) t ((A * a + B * b - g * g') / h)).
  { eapply derivable_eq.
    - apply (derivable_scal (arm_mode l)). exact (derivable_pt_lim_comp _ sqrt t _ _ hD (derivable_pt_lim_sqrt _ reach)).
    - reflexivity.
    - pose proof (sqrt_lt_R0 _ reach) as q0. unfold h, arm_eta. set (q := sqrt (clearance l (P t))) in *. clearbody q.
      assert (G : r * g' = A * a + B * b + K * k) by (unfold g'; field; lra).
      replace (K * k) with (r * g' - A * a - B * b) by lra. destruct hm as [-> | ->]; field; lra. }
  assert (E : dot (arm_row l (P t)) V = (g' - c * a - s * b) / h).
  { unfold arm_row, rod, elbow. fold r c s h.
    replace (dot (vscale (/ (r * h)) _) V) with (/ (r * h) * (dot (from_motor l (P t)) V - r * (c * a + s * b)))
      by (unfold a, b, from_motor; generalize (quarter l) (motor_zero l); clear; intros; unfold dot, vscale, vsub, vadd; cbn [vx vy vz]; ring).
    rewrite (gram_product _ _ (from_motor l (P t)) V hk he ho). fold (quarter l) a b k. fold (along l (P t)) (across l (P t)) (height l (P t)).
    fold A B K. unfold g'. field. split; [lra | exact h0]. }
  destruct (rates c s g h A B a b g' h0 u eg eh) as [Rc Rs]. rewrite E. rewrite <- EN in Rc, Rs.
  assert (N1 : A ^ 2 + B ^ 2 <> 0) by lra.
  assert (C : g * A + h * B = c * (A ^ 2 + B ^ 2)) by (unfold c, arm_cosine; fold g A h B; field; exact N1).
  assert (S : g * B - h * A = s * (A ^ 2 + B ^ 2)) by (unfold s, arm_sine; fold g A h B; field; exact N1).
  set (h' := (A * a + B * b - g * g') / h) in *.
  pose proof (derivable_add _ _ t _ _ (derivable_pt_lim_mult _ _ t _ _ hg hA) (derivable_pt_lim_mult _ _ t _ _ hh hB)) as hc.
  pose proof (derivable_add _ _ t _ _ (derivable_pt_lim_mult _ _ t _ _ hg hB) (derivable_scal (-1) _ t _ (derivable_pt_lim_mult _ _ t _ _ hh hA))) as hs.
  pose proof (derivable_pt_lim_div _ _ t _ _ hc hN N1) as dc. pose proof (derivable_pt_lim_div _ _ t _ _ hs hN N1) as ds.
  set (n := A ^ 2 + B ^ 2) in *. split.
  - eapply derivable_eq; [exact dc | reflexivity |].
    change (- s * ((g' - c * a - s * b) / h)
      = ((g' * A + g * a + (h' * B + h * b)) * n - (2 * A * a + 2 * B * b) * (g * A + h * B)) / Rsqr n).
    rewrite C. unfold Rsqr. replace (g' * A + g * a + (h' * B + h * b))
      with (n * (- s * ((g' - c * a - s * b) / h)) + 2 * (A * a + B * b) * c) by (rewrite <- Rc; ring). field. split; assumption.
  - eapply derivable_eq; [exact ds | intro u0; unfold div_fct, mult_fct, arm_sine; f_equal; unfold along, across; ring |].
    change (c * ((g' - c * a - s * b) / h)
      = ((g' * B + g * b + -1 * (h' * A + h * a)) * n - (2 * A * a + 2 * B * b) * (g * B + -1 * (h * A))) / Rsqr n).
    replace (g * B + -1 * (h * A)) with (s * n) by lra. unfold Rsqr. replace (g' * B + g * b + -1 * (h' * A + h * a))
      with (n * (c * ((g' - c * a - s * b) / h)) + 2 * (A * a + B * b) * s) by (rewrite <- Rs; ring). field. split; assumption.
Qed.

(** ** Arms within tolerances *)

(** An axis and a reference of any length but zero; the arm at the angle 0 is along the part of the
    reference that is orthogonal to the axis. *)
Record arm_drive := ArmDrive {
  axis_within : tolerances; reference_within : tolerances; anchor_within : tolerances; platform_within : tolerances;
  arm_within : tolerance; rod_within : tolerance; is_positive_mode : bool
}.

Definition orthogonal_part (k x : vec) : vec := vsub x (vscale (dot k x) k).

Definition is_arm (d : arm_drive) (l : arm) : Prop :=
  (exists k x, all_within (axis_within d) k /\ all_within (reference_within d) x /\
    motor_axis l = normalised k /\ motor_zero l = normalised (orthogonal_part (normalised k) x)) /\
  all_within (anchor_within d) (motor l) /\ all_within (platform_within d) (arm_offset l) /\
  within (arm_within d) (arm_length l) /\ within (rod_within d) (rod_length l) /\
  arm_mode l = (if is_positive_mode d then 1 else -1).

(** ** A leg and a point in exact numbers *)

Record exact_arm := ExactArm {
  xaxis : numbers; xreference : numbers; xanchor : numbers; xplatform : numbers; xarm : number; xrod : number; xmode : bool }.

Definition xpart (l : exact_arm) : numbers :=
  let k := unit_of (xaxis l) in each2 Minus (xreference l) (scaled (product k (xreference l)) k).
Definition arm_of (l : exact_arm) : arm :=
  Arm (normalised (values (xaxis l))) (normalised (values (xpart l))) (values (xanchor l)) (values (xplatform l))
    (value (xarm l)) (value (xrod l)) (if xmode l then 1 else -1).

Lemma values_xpart : forall l, values (xpart l) = orthogonal_part (normalised (values (xaxis l))) (values (xreference l)).
Proof. intro l. unfold xpart. cbv zeta. rewrite values_minus, values_scaled, value_product, values_unit. reflexivity. Qed.

Definition ncross (a b : numbers) : numbers :=
  Numbers (Minus (Times (ny a) (nz b)) (Times (nz a) (ny b))) (Minus (Times (nz a) (nx b)) (Times (nx a) (nz b)))
    (Minus (Times (nx a) (ny b)) (Times (ny a) (nx b))).
Definition nsquare (x : number) : number := Times x x.

Section Exact.
Variable l : exact_arm.
Variable P : numbers.

Definition xzero : numbers := unit_of (xpart l).
Definition xquarter : numbers := ncross (unit_of (xaxis l)) xzero.
Definition xfrom : numbers := nspan (xanchor l) (xplatform l) P.
Definition xalong : number := product xzero xfrom.
Definition xacross : number := product xquarter xfrom.
Definition xheight : number := product (unit_of (xaxis l)) xfrom.
Definition xdistance : number := Plus (nsquare xalong) (nsquare xacross).
Definition xforward : number :=
  Over (Plus xdistance (Plus (nsquare xheight) (Minus (nsquare (xarm l)) (nsquare (xrod l))))) (Times (2 // 1) (xarm l)).
Definition xclearance : number :=
  Minus (Minus (nsquare (xrod l)) (nsquare xheight)) (nsquare (Minus xforward (xarm l))).
Definition xeta : number := signed_root (xmode l) xclearance.
Definition xcosine : number := Over (Plus (Times xforward xalong) (Times xeta xacross)) xdistance.
Definition xsine : number := Over (Minus (Times xforward xacross) (Times xeta xalong)) xdistance.
Definition xelbow : numbers :=
  each2 Plus (xanchor l) (scaled (xarm l) (each2 Plus (scaled xcosine xzero) (scaled xsine xquarter))).
Definition xrow : numbers :=
  scaled (Over (1 // 1) (Times (xarm l) xeta)) (each2 Minus (each2 Plus P (xplatform l)) xelbow).

Local Notation l' := (arm_of l).
Local Notation P' := (values P).

Lemma values_xzero : values xzero = motor_zero l'.
Proof. unfold xzero. apply values_unit. Qed.
Lemma values_xquarter : values xquarter = quarter l'.
Proof. unfold quarter. rewrite <- values_xzero. cbn [motor_axis arm_of]. rewrite <- values_unit. reflexivity. Qed.
Lemma value_xalong : value xalong = along l' P'.
Proof. unfold xalong. rewrite value_product, values_xzero. reflexivity. Qed.
Lemma value_xacross : value xacross = across l' P'.
Proof. unfold xacross. rewrite value_product, values_xquarter. reflexivity. Qed.
Lemma value_xheight : value xheight = height l' P'.
Proof. unfold xheight. rewrite value_product, values_unit. reflexivity. Qed.
Lemma value_xforward : value xforward = forward l' P'.
Proof.
  unfold xforward, xdistance, nsquare, forward. cbn [value]. rewrite value_xalong, value_xacross, value_xheight.
  cbn [arm_length rod_length arm_of]. f_equal; [ring |]. lra.
Qed.
Lemma value_xclearance : value xclearance = clearance l' P'.
Proof. unfold xclearance, nsquare, clearance. cbn [value]. rewrite value_xforward, value_xheight. cbn [arm_length rod_length arm_of]. ring. Qed.
Lemma value_xeta : value xeta = arm_eta l' P'.
Proof.
  unfold xeta, arm_eta. rewrite <- value_xclearance. cbn [arm_mode arm_of].
  destruct (xmode l); cbn [signed_root value]; unfold Rdiv; rewrite ?Rmult_0_l; ring.
Qed.
Lemma value_xcosine : value xcosine = arm_cosine l' P'.
Proof.
  unfold xcosine, xdistance, nsquare, arm_cosine. cbn [value]. rewrite value_xforward, value_xalong, value_xacross, value_xeta.
  f_equal. ring.
Qed.
Lemma value_xsine : value xsine = arm_sine l' P'.
Proof.
  unfold xsine, xdistance, nsquare, arm_sine. cbn [value]. rewrite value_xforward, value_xalong, value_xacross, value_xeta.
  f_equal. ring.
Qed.
Lemma values_xrow : values xrow = arm_row l' P'.
Proof.
  unfold xrow, xelbow, arm_row, rod, elbow.
  rewrite values_scaled, !values_minus, !values_plus, values_scaled, values_plus, !values_scaled, values_xzero, values_xquarter, value_xcosine, value_xsine.
  cbn [value]. rewrite value_xeta. f_equal. cbn [arm_of arm_length]. unfold Rdiv. rewrite Rinv_1. ring.
Qed.
End Exact.

Section Precision.
Variable bits : positive.

Definition is_exact_arm (d : arm_drive) (l : exact_arm) : bool :=
  parts bits (axis_within d) (xaxis l) && parts bits (reference_within d) (xreference l) &&
  parts bits (anchor_within d) (xanchor l) && parts bits (platform_within d) (xplatform l) &&
  part bits (arm_within d) (xarm l) && part bits (rod_within d) (xrod l) && certainly bits true (xarm l) && certainly bits true (xrod l) &&
  certainly bits true (product (xaxis l) (xaxis l)) && certainly bits true (product (xpart l) (xpart l)) && Bool.eqb (is_positive_mode d) (xmode l).

Lemma is_exact_arm_sound : forall d l, is_exact_arm d l = true -> is_arm d (arm_of l) /\ well_formed_arm (arm_of l).
Proof.
  intros d l h. unfold is_exact_arm in h. do 10 (apply andb_true_iff in h as [h ?]).
  repeat match goal with
  | k : parts _ _ _ = true |- _ => apply parts_sound in k
  | k : part _ _ _ = true |- _ => apply part_sound in k
  | k : certainly _ true _ = true |- _ => apply positive_sound in k
  end.
  rewrite !value_square in *. match goal with k : Bool.eqb _ _ = true |- _ => apply Bool.eqb_prop in k as m end.
  split.
  - split; [exists (values (xaxis l)), (values (xreference l)); rewrite <- values_xpart; auto |]. rewrite m. auto.
  - unfold well_formed_arm. cbn [arm_of motor_axis motor_zero arm_length rod_length arm_mode].
    split; [apply normalised_norm; assumption |]. split; [apply normalised_norm; assumption |]. split; [| split; [assumption | split; [assumption |]]].
    + rewrite values_xpart. pose proof (normalised_norm (@values names (xaxis l)) ltac:(assumption)) as u.
      generalize dependent (normalised (values (xaxis l))). intros k u. generalize (values (xreference l)). intro x.
      unfold normalised. set (q := / sqrt _). clearbody q. unfold orthogonal_part.
      assert (E : dot k (vscale q (vsub x (vscale (dot k x) k))) = q * (dot k x * (1 - norm2 k))) by (clear; vec_ring).
      rewrite E, u. ring.
    + destruct (xmode l); auto.
Qed.
End Precision.
End Named.
