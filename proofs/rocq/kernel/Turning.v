(** * Platforms that turn: kinematics, claims, and refutations

    Struts from the base to a platform in the plane, in space, or about a fixed
    point.  The platform's joint b is at P + R b; orientations are told by angles
    in degrees, and proved by the tangents of their halves. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert.kernel Require Import Linear Configuration.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Number Trig Machine Witness.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** Kinematics *)

Definition rotation_x (a : R) : mat := Mat (Vec 1 0 0) (Vec 0 (cos a) (- sin a)) (Vec 0 (sin a) (cos a)).
Definition rotation_y (a : R) : mat := Mat (Vec (cos a) 0 (sin a)) (Vec 0 1 0) (Vec (- sin a) 0 (cos a)).
Definition rotation_z (a : R) : mat := Mat (Vec (cos a) (- sin a) 0) (Vec (sin a) (cos a) 0) (Vec 0 0 1).

Record strut := Strut { strut_base : vec; strut_joint : vec }.

(** The leg, and the way to its joint from the platform's point. *)
Definition arm_of_joint (l : strut) (Q : mat) : vec := mulv Q (strut_joint l).
Definition strut_vector (l : strut) (P : vec) (Q : mat) : vec := vsub (vadd P (arm_of_joint l Q)) (strut_base l).
Definition strut_length (l : strut) (P : vec) (Q : mat) : R := sqrt (norm2 (strut_vector l P Q)).

(** The components of the platform's velocity and of its angular velocity that there are. *)
Inductive motion := InPlane | InSpace | AboutPoint.
Definition twist (k : motion) (v omega : vec) : list R :=
  match k with
  | InPlane => [vx v; vy v; vz omega]
  | InSpace => [vx v; vy v; vz v; vx omega; vy omega; vz omega]
  | AboutPoint => [vx omega; vy omega; vz omega]
  end.
Definition dimension (k : motion) : nat := match k with InSpace => 6 | _ => 3 end.

(** With the leg's unit vector u: length' = u . v + ((r x u)/ell) . (ell omega)  ([length_velocity]). *)
Definition strut_row (k : motion) (ell : R) (l : strut) (P : vec) (Q : mat) : list R :=
  let u := normalised (strut_vector l P Q) in twist k u (vscale (/ ell) (cross (arm_of_joint l Q) u)).

Definition struts_at (k : motion) (ell : R) (m : list strut) (P : vec) (Q : mat) : configuration :=
  Configuration (map (fun l => strut_row k ell l P Q) m) (map (fun l => Length (strut_length l P Q)) m)
    (Forall (fun l => 0 < norm2 (strut_vector l P Q)) m).

(** The motion's own velocities. *)
Definition is_of (k : motion) (v omega : vec) : Prop :=
  match k with InPlane => vz v = 0 /\ vx omega = 0 /\ vy omega = 0 | InSpace => True | AboutPoint => v = vzero end.
(** Q' = [omega]x Q *)
Definition turns (Q : R -> mat) (t : R) (omega : vec) : Prop :=
  forall b, has_velocity (fun u => mulv (Q u) b) t (cross omega (mulv (Q t) b)).

(** A guard on the model: along any differentiable motion, the leg's length changes at the speed row . twist. *)
Theorem length_velocity : forall k ell l P Q t v omega, ell <> 0 -> 0 < norm2 (strut_vector l (P t) (Q t)) ->
  has_velocity P t v -> turns Q t omega -> is_of k v omega ->
  derivable_pt_lim (fun u => strut_length l (P u) (Q u)) t (Linear.dot (strut_row k ell l (P t) (Q t)) (twist k v (vscale ell omega))).
Proof.
  intros k ell l P Q t v omega e0 reach hP hQ hk. set (r := arm_of_joint l (Q t)).
  assert (W : has_velocity (fun u => strut_vector l (P u) (Q u)) t (vadd v (cross omega r))).
  { destruct hP as [p1 [p2 p3]]. destruct (hQ (strut_joint l)) as [q1 [q2 q3]].
    assert (K : forall f g d e c, derivable_pt_lim f t d -> derivable_pt_lim g t e -> derivable_pt_lim (fun u => f u + g u - c) t (d + e)).
    { intros f g d e c hf hg. apply derivable_eq with (fun u => f u + g u + - c) (d + e + 0); try (intros; ring).
      apply derivable_add; [apply derivable_add; assumption | apply derivable_const]. }
    split; [| split]; unfold strut_vector, arm_of_joint; cbn [vsub vadd vx vy vz] in *; apply K; assumption. }
  pose proof (velocity_norm2 _ t _ W) as N. cbn beta in N. set (w := strut_vector l (P t) (Q t)) in *.
  apply derivable_eq with (comp sqrt (fun u => norm2 (strut_vector l (P u) (Q u))))
    (/ (2 * sqrt (norm2 w)) * (2 * Vec3.dot w (vadd v (cross omega r)))).
  - exact (derivable_pt_lim_comp _ sqrt t _ _ N (derivable_pt_lim_sqrt _ reach)).
  - reflexivity.
  - pose proof (sqrt_lt_R0 _ reach) as s0. unfold strut_row. fold w r. unfold normalised. set (q := sqrt (norm2 w)) in *. clearbody q w r.
    destruct w as [w1 w2 w3], r as [r1 r2 r3], v as [v1 v2 v3], omega as [o1 o2 o3]. destruct k; cbn [is_of vx vy vz] in hk.
    + destruct hk as [-> [-> ->]]. unfold Vec3.dot, vadd, vscale, cross. cbn. field. split; lra.
    + unfold Vec3.dot, vadd, vscale, cross. cbn. field. split; lra.
    + injection hk as -> -> ->. unfold Vec3.dot, vadd, vscale, cross. cbn. field. split; lra.
Qed.

(** ** Claims *)

(** Degrees. *)
Inductive orientations :=
  | TurnedBy (angle : tolerance)                  (* in the plane *)
  | RollPitchYaw (roll pitch yaw : tolerance).

Definition in_orientations (o : orientations) (Q : mat) : Prop :=
  match o with
  | TurnedBy t => exists a, within t a /\ Q = rotation_z (in_degrees a)
  | RollPitchYaw r p y => exists a b c, within r a /\ within p b /\ within y c /\
      Q = mulm (rotation_z (in_degrees c)) (mulm (rotation_y (in_degrees b)) (rotation_x (in_degrees a)))
  end.

(** In the plane z is 0 of all points; about a fixed point, the platform's is the origin. *)
Record turning_claim := MakeTurningClaim {
  motion_of : motion; struts : list (tolerances * tolerances); characteristic_length : number;
  positions : tolerances; turned : orientations; turning_demands : list demand
}.

Definition is_strut (t : tolerances * tolerances) (l : strut) : Prop :=
  all_within (fst t) (strut_base l) /\ all_within (snd t) (strut_joint l).
Definition is_about_struts (c : turning_claim) (m : list strut) (P : vec) (Q : mat) : Prop :=
  Forall2 is_strut (struts c) m /\ all_within (positions c) P /\ in_orientations (turned c) Q.
Definition meets_turning (c : turning_claim) (m : list strut) (P : vec) (Q : mat) : Prop :=
  Configuration.meets (dimension (motion_of c)) (struts_at (motion_of c) (value (characteristic_length c)) m P Q) (turning_demands c).

Definition turning_holds (c : turning_claim) : Prop := forall m P Q, is_about_struts c m P Q -> meets_turning c m P Q.

(** ** Angles by the tangents of their halves *)

(** [t] is the tangent of the half of the angle [x]. *)
Definition is_half_tangent (t x : R) : Prop :=
  cos (in_degrees x) = (1 - t ^ 2) / (1 + t ^ 2) /\ sin (in_degrees x) = 2 * t / (1 + t ^ 2).

Lemma half_tangent : forall t x, sin (in_degrees (x / 2)) = t * cos (in_degrees (x / 2)) -> is_half_tangent t x.
Proof.
  intros t x e. set (p := in_degrees (x / 2)) in *. assert (E : in_degrees x = 2 * p) by (unfold p, in_degrees; field).
  pose proof (sin2_cos2 p) as S. unfold Rsqr in S. rewrite e in S. pose proof (pow2_ge_0 t) as t0.
  assert (C : cos p * cos p = / (1 + t ^ 2)) by (apply Rmult_eq_reg_r with (1 + t ^ 2); [rewrite Rinv_l by lra; lra | lra]).
  unfold is_half_tangent. rewrite E, cos_2a, sin_2a, e. split.
  - replace (cos p * cos p - t * cos p * (t * cos p)) with (cos p * cos p * (1 - t ^ 2)) by ring. rewrite C. field. lra.
  - replace (2 * (t * cos p) * cos p) with (2 * t * (cos p * cos p)) by ring. rewrite C. field. lra.
Qed.

(** Between the half tangents of two angles are those of angles between. *)
Definition excess (t x : R) : R := sin (in_degrees (x / 2)) - t * cos (in_degrees (x / 2)).

Lemma half_tangent_between : forall t a b, a <= b -> excess t a <= 0 -> 0 <= excess t b -> exists x, a <= x <= b /\ is_half_tangent t x.
Proof.
  intros t a b le ha hb.
  assert (C : continuity (excess t)).
  { assert (L : continuity (fun x => in_degrees (x / 2))) by (intro x; unfold in_degrees; reg).
    intro x. apply continuity_pt_minus.
    - apply (continuity_pt_comp (fun x => in_degrees (x / 2)) sin); [apply L | apply continuity_sin].
    - apply (continuity_pt_scal (fun x => cos (in_degrees (x / 2)))).
      apply (continuity_pt_comp (fun x => in_degrees (x / 2)) cos); [apply L | apply continuity_cos]. }
  destruct (IVT_cor (excess t) a b C le ltac:(nra)) as [x [h z]]. exists x. split; [exact h |]. apply half_tangent. unfold excess in z. lra.
Qed.

(** ** A machine and a pose in exact numbers *)

Record exact_strut := StrutNumbers { xbase : numbers; xjoint : numbers }.
Definition strut_of (l : exact_strut) : strut := Strut (values (xbase l)) (values (xjoint l)).

Section Exact.
(** The cosine and the sine of an angle by the tangent of its half. *)
Definition tcosine (t : number) : number := Over (Minus (1 // 1) (Times t t)) (Plus (1 // 1) (Times t t)).
Definition tsine (t : number) : number := Over (Times (2 // 1) t) (Plus (1 // 1) (Times t t)).
Definition tturned (t p q : number) : number * number :=
  (Minus (Times (tcosine t) p) (Times (tsine t) q), Plus (Times (tsine t) p) (Times (tcosine t) q)).
Definition about_x (t : number) (b : numbers) : numbers := let (y, z) := tturned t (ny b) (nz b) in Numbers (nx b) y z.
Definition about_y (t : number) (b : numbers) : numbers := let (z, x) := tturned t (nz b) (nx b) in Numbers x (ny b) z.
Definition about_z (t : number) (b : numbers) : numbers := let (x, y) := tturned t (nx b) (ny b) in Numbers x y (nz b).

Lemma value_tcosine : forall t x, is_half_tangent (value t) x -> value (tcosine t) = cos (in_degrees x).
Proof. intros t x [-> _]. unfold tcosine. cbn [value]. f_equal; [field | f_equal; field]. Qed.
Lemma value_tsine : forall t x, is_half_tangent (value t) x -> value (tsine t) = sin (in_degrees x).
Proof. intros t x [_ ->]. unfold tsine. cbn [value]. f_equal; [field | f_equal; field]. Qed.

Lemma values_about : forall t x b, is_half_tangent (value t) x ->
  values (about_x t b) = mulv (rotation_x (in_degrees x)) (values b) /\
  values (about_y t b) = mulv (rotation_y (in_degrees x)) (values b) /\
  values (about_z t b) = mulv (rotation_z (in_degrees x)) (values b).
Proof.
  intros t x b h. pose proof (value_tcosine t x h) as C. pose proof (value_tsine t x h) as S.
  unfold about_x, about_y, about_z, tturned, values, mulv, Vec3.dot. cbn [nx ny nz value row1 row2 row3 vx vy vz rotation_x rotation_y rotation_z].
  rewrite C, S. repeat split; f_equal; ring.
Qed.

(** The platform's joint, turned. *)
Definition turn (o : orientations) (c : list number) (b : numbers) : numbers :=
  match o, c with
  | TurnedBy _, [t] => about_z t b
  | RollPitchYaw _ _ _, [x; y; z] => about_z z (about_y y (about_x x b))
  | _, _ => b
  end.

Definition xvector (o : orientations) (c : list number) (P : numbers) (l : exact_strut) : numbers :=
  each2 Minus (each2 Plus P (turn o c (xjoint l))) (xbase l).
Definition ntwist (k : motion) (v w : numbers) : list number :=
  match k with
  | InPlane => [nx v; ny v; nz w]
  | InSpace => [nx v; ny v; nz v; nx w; ny w; nz w]
  | AboutPoint => [nx w; ny w; nz w]
  end.
Definition ncrossed (a b : numbers) : numbers :=
  Numbers (Minus (Times (ny a) (nz b)) (Times (nz a) (ny b))) (Minus (Times (nz a) (nx b)) (Times (nx a) (nz b)))
    (Minus (Times (nx a) (ny b)) (Times (ny a) (nx b))).
Definition xstrut_row (k : motion) (ell : number) (o : orientations) (c : list number) (P : numbers) (l : exact_strut) : list number :=
  let u := unit_of (xvector o c P l) in ntwist k u (scaled (Over (1 // 1) ell) (ncrossed (turn o c (xjoint l)) u)).

Definition exact_struts_at (k : motion) (ell : number) (o : orientations) (c : list number) (P : numbers) (ls : list exact_strut) : nconfiguration :=
  let square l := product (xvector o c P l) (xvector o c P l) in
  NConfiguration (map (xstrut_row k ell o c P) ls) (map (fun l => NLength (Root (square l))) ls) (map square ls).
End Exact.

Section Stand.
Variables (o : orientations) (c : list number) (Q : mat).
Hypothesis is_turn : forall b, values (turn o c b) = mulv Q (values b).

Lemma values_xvector : forall P l, values (xvector o c P l) = strut_vector (strut_of l) (values P) Q.
Proof. intros. unfold xvector. rewrite values_minus, values_plus, is_turn. reflexivity. Qed.

Lemma exact_struts_stand : forall k ell P ls,
  stands_for (exact_struts_at k ell o c P ls) (struts_at k (value ell) (map strut_of ls) (values P) Q).
Proof.
  intros k ell P ls.
  assert (S : forall l, value (product (xvector o c P l) (xvector o c P l)) = norm2 (strut_vector (strut_of l) (values P) Q))
    by (intro l; rewrite value_square, values_xvector; reflexivity).
  split; [| split]; cbn [jacobian joints reached njacobian njoints reserves exact_struts_at struts_at]; rewrite ?map_map.
  - apply map_ext. intro l. unfold strut_row, xstrut_row. rewrite <- values_xvector, <- values_unit.
    assert (I : value (Over (1 // 1) ell) = / value ell) by (cbn [value]; unfold Rdiv; rewrite Rinv_1; ring).
    unfold arm_of_joint. cbn [strut_joint strut_of]. rewrite <- is_turn, <- I. destruct k; reflexivity.
  - apply map_ext. intro l. cbn [coordinate_of value]. rewrite S. reflexivity.
  - rewrite Forall_map. intro h. rewrite Forall_map. revert h. apply Forall_impl. intros l h. rewrite S. exact h.
Qed.
End Stand.

Section Precision.
Variable bits : positive.

(** The excess of [t] over the half tangent of [x] is at most zero, or at least; of 0 degrees, it is -t. *)
Definition excess_of (t x : number) : option fixed :=
  match enclose bits t, cosine bits (Over x (2 // 1)), sine bits (Over x (2 // 1)) with
  | Some t, Some c, Some s => Some (sub s (mul bits t c))
  | _, _, _ => None
  end.
Definition is_zero (x : number) : bool := match rational x with Some q => Qeq_bool q 0 | None => false end.
Definition exceeds (is_more : bool) (t x : number) : bool :=
  if is_zero x then certainly bits false (if is_more then Minus (0 // 1) t else t)
  else match excess_of t x with Some a => if is_more then (0 <=? lo a)%Z else (hi a <=? 0)%Z | None => false end.

Lemma excess_of_sound : forall t x a, excess_of t x = Some a -> contains bits a (excess (value t) (value x)).
Proof.
  intros t x a h. unfold excess_of in h. destruct (enclose bits t) as [u |] eqn:e1; [| discriminate].
  destruct (cosine bits _) as [c |] eqn:e2; [| discriminate]. destruct (sine bits _) as [s |] eqn:e3; [| discriminate].
  assert (E : sub s (mul bits u c) = a) by congruence. subst a. apply cosine_sound in e2. apply sine_sound in e3. cbn [value] in e2, e3.
  replace (2 / 1) with 2 in e2, e3 by field. unfold excess. apply sub_sound; [exact e3 | apply mul_sound; [apply enclose_sound, e1 | exact e2]].
Qed.

Lemma exceeds_sound : forall t x (is_more : bool), exceeds is_more t x = true ->
  if is_more then 0 <= excess (value t) (value x) else excess (value t) (value x) <= 0.
Proof.
  intros t x is_more h. unfold exceeds in h. destruct (is_zero x) eqn:z.
  - unfold is_zero in z. destruct (rational x) as [q |] eqn:r; [| discriminate]. apply Qeq_bool_eq, Qeq_eqR in z.
    rewrite (rational_sound _ _ r), z. replace (Q2R 0) with 0 by (unfold Q2R; cbn; lra). unfold excess, in_degrees.
    replace (0 / 2 * PI / 180) with 0 by field. rewrite sin_0, cos_0. destruct is_more; apply nonneg_sound in h; cbn [value] in h; lra.
  - destruct (excess_of t x) as [a |] eqn:e; [| discriminate]. apply excess_of_sound in e. destruct is_more.
    + apply Z.leb_le in h. exact (contains_nonneg bits _ _ h e).
    + apply Z.leb_le, IZR_le in h. destruct e as [_ e]. pose proof (unit_R_pos bits). nra.
Qed.

Definition is_half_tangent_in (t : tolerance) (c : number) : bool :=
  below bits (least t) (greatest t) && exceeds false c (least t) && exceeds true c (greatest t).

Lemma is_half_tangent_in_sound : forall t c, is_half_tangent_in t c = true -> exists x, within t x /\ is_half_tangent (value c) x.
Proof.
  intros t c h. apply andb_true_iff in h as [h b]. apply andb_true_iff in h as [h a]. apply below_sound in h.
  apply exceeds_sound in a, b. cbn beta iota in a, b. exact (half_tangent_between _ _ _ h a b).
Qed.

Definition is_orientation (o : orientations) (c : list number) : bool :=
  match o, c with
  | TurnedBy t, [x] => is_half_tangent_in t x
  | RollPitchYaw r p y, [x; z; w] => is_half_tangent_in r x && is_half_tangent_in p z && is_half_tangent_in y w
  | _, _ => false
  end.

Lemma mulm_mulv : forall A B v, mulv (mulm A B) v = mulv A (mulv B v).
Proof. intros [a b c] B v. unfold mulm, mulv. cbn [row1 row2 row3]. destruct B as [d e f]. unfold transpose, col1, col2, col3, Vec3.dot. cbn [row1 row2 row3 vx vy vz]. f_equal; ring. Qed.

Lemma is_orientation_sound : forall o c, is_orientation o c = true ->
  exists Q, in_orientations o Q /\ forall b, values (turn o c b) = mulv Q (values b).
Proof.
  intros [t | r p y] [| x [| z [| w [|]]]] h; try discriminate; cbn [is_orientation turn in_orientations] in *.
  - destruct (is_half_tangent_in_sound _ _ h) as [a [ha ta]]. eexists. split; [exists a; split; [exact ha | reflexivity] |].
    intro b. apply (values_about _ _ _ ta).
  - apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2].
    destruct (is_half_tangent_in_sound _ _ h1) as [a [ha ta]]. destruct (is_half_tangent_in_sound _ _ h2) as [b [hb tb]].
    destruct (is_half_tangent_in_sound _ _ h3) as [d [hd td]]. eexists. split; [exists a, b, d; split; [exact ha | split; [exact hb | split; [exact hd | reflexivity]]] |].
    intro v. destruct (values_about _ _ (about_y z (about_x x v)) td) as [_ [_ ->]]. destruct (values_about _ _ (about_x x v) tb) as [_ [-> _]].
    destruct (values_about _ _ v ta) as [-> _]. rewrite !mulm_mulv. reflexivity.
Qed.

Fixpoint all_struts (ts : list (tolerances * tolerances)) (ls : list exact_strut) : bool :=
  match ts, ls with
  | [], [] => true
  | t :: ts', l :: ls' => parts bits (fst t) (xbase l) && parts bits (snd t) (xjoint l) && all_struts ts' ls'
  | _, _ => false
  end.

Lemma all_struts_sound : forall ts ls, all_struts ts ls = true -> Forall2 is_strut ts (map strut_of ls).
Proof.
  induction ts as [| t ts IH]; intros [| l ls] h; cbn [all_struts map] in *; try discriminate; constructor.
  - apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [a b]. split; apply (parts_sound bits); assumption.
  - apply andb_true_iff in h as [_ h]. apply IH, h.
Qed.

Definition refute_turning (c : turning_claim) (ls : list exact_strut) (P : numbers) (t : list number) (f : nfailure) : bool :=
  all_struts (struts c) ls && parts bits (positions c) P && is_orientation (turned c) t &&
  refutes bits (dimension (motion_of c)) (exact_struts_at (motion_of c) (characteristic_length c) (turned c) t P ls) (turning_demands c) f.

(** A machine of the claim does not meet it in some pose of the workspace. *)
Theorem refute_turning_sound : forall c ls P t f, refute_turning c ls P t f = true ->
  exists m P Q, is_about_struts c m P Q /\ ~ meets_turning c m P Q.
Proof.
  intros c ls P t f h. apply andb_true_iff in h as [h r]. apply andb_true_iff in h as [h o]. apply andb_true_iff in h as [h p].
  destruct (is_orientation_sound _ _ o) as [Q [hQ turnQ]]. exists (map strut_of ls), (values P), Q.
  split; [split; [apply all_struts_sound, h | split; [exact (parts_sound bits _ _ p) | exact hQ]] |].
  exact (refutes_sound bits _ _ _ _ _ (exact_struts_stand _ _ Q turnQ _ _ _ _) r).
Qed.
End Precision.
