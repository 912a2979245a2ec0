(** * Platforms that turn: kinematics, claims, and refutations

    Struts from the base to a platform in the plane, in space, or about a fixed
    point.  The platform's joint b is at P + R b; orientations are told by angles
    in degrees, and proved by the tangents of their halves. *)

From Coq Require Import ZArith Reals Lra List Bool.
From Orthocert.kernel Require Import Linear Configuration.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Import Statement Number Machine Witness Orientation.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Kinematics *)

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

(** The motion's own velocities. *)
Definition is_of (k : motion) (v omega : vec) : Prop :=
  match k with InPlane => vz v = 0 /\ vx omega = 0 /\ vy omega = 0 | InSpace => True | AboutPoint => v = vzero end.
(** Q' = [omega]x Q *)
Definition turns (Q : R -> mat) (t : R) (omega : vec) : Prop :=
  forall b, has_velocity (fun u => mulv (Q u) b) t (cross omega (mulv (Q t) b)).

(** The leg's acceleration: along every motion through the pose with the twist v, whose rate is a, row . twist, the leg's speed, has the derivative y. *)
Definition strut_accelerates (k : motion) (ell : R) (l : strut) (P : vec) (Q : mat) (v a : list R) (y : R) : Prop :=
  forall position turn velocity omega acceleration alpha, position 0 = P -> turn 0 = Q ->
    has_velocity position 0 (velocity 0) -> turns turn 0 (omega 0) -> has_velocity velocity 0 acceleration -> has_velocity omega 0 alpha -> is_of k (velocity 0) (omega 0) ->
    v = twist k (velocity 0) (vscale ell (omega 0)) -> a = twist k acceleration (vscale ell alpha) ->
    derivable_pt_lim (fun t => Linear.dot (strut_row k ell l (position t) (turn t)) (twist k (velocity t) (vscale ell (omega t)))) 0 y.

(** Poses near another one, from which they are turned by at most so many degrees. *)
Definition turned_by_less (k : motion) (angle : number) : orientations := match k with InPlane => TurnedBy (either_way angle) | _ => TurnedUpTo angle end.
Definition is_near (k : motion) (b angle : number) (P : vec) (Q : mat) (P' : vec) (Q' : mat) : Prop :=
  is_of k (vsub P' P) vzero /\ norm2 (vsub P' P) <= value b ^ 2 /\ exists S, in_orientations (turned_by_less k angle) S /\ Q' = mulm S Q.

(** The struts have lengths off by the error at most from those of the nominal ones in exactly one pose so near. *)
Definition struts_recover (k : motion) (nominal m : list strut) (P : vec) (Q : mat) (error b angle : number) : Prop :=
  forall rho, Forall2 (fun l r => Rabs (r - strut_length l P Q) <= value error) nominal rho ->
  let is_at P' Q' := is_near k b angle P Q P' Q' /\ Forall2 (fun l r => 0 < norm2 (strut_vector l P' Q') /\ strut_length l P' Q' = r) m rho in
  exists P' Q', is_at P' Q' /\ forall P'' Q'', is_at P'' Q'' -> P'' = P' /\ Q'' = Q'.

Definition struts_at (k : motion) (ell : R) (nominal m : list strut) (P : vec) (Q : mat) : configuration :=
  Configuration (map (fun l => strut_row k ell l P Q) m) (map (fun l => Length (strut_length l P Q)) m) (map (fun _ => None) m)
    (map (fun l => Some (vadd P (arm_of_joint l Q), strut_vector l P Q, strut_length l P Q)) m) (fun b => vadd P (mulv Q b))
    (fun i v a y => match nth_error m i with Some l => strut_accelerates k ell l P Q v a y | None => False end)
    (struts_recover k nominal m P Q)
    (Forall (fun l => 0 < norm2 (strut_vector l P Q)) m).

Lemma vector_velocity : forall l P Q t v omega, has_velocity P t v -> turns Q t omega ->
  has_velocity (fun u => strut_vector l (P u) (Q u)) t (vadd v (cross omega (arm_of_joint l (Q t)))).
Proof.
  intros l P Q t v omega [p1 [p2 p3]] hQ. destruct (hQ (strut_joint l)) as [q1 [q2 q3]].
  assert (K : forall f g d e c, derivable_pt_lim f t d -> derivable_pt_lim g t e -> derivable_pt_lim (fun u => f u + g u - c) t (d + e)).
  { intros f g d e c hf hg. apply derivable_eq with (fun u => f u + g u + - c) (d + e + 0); try (intros; ring).
    apply derivable_add; [apply derivable_add; assumption | apply derivable_const]. }
  split; [| split]; unfold strut_vector, arm_of_joint; cbn [vsub vadd vx vy vz] in *; apply K; assumption.
Qed.

(** A guard on the model: along any differentiable motion, the leg's length changes at the speed row . twist. *)
Theorem length_velocity : forall k ell l P Q t v omega, ell <> 0 -> 0 < norm2 (strut_vector l (P t) (Q t)) ->
  has_velocity P t v -> turns Q t omega -> is_of k v omega ->
  derivable_pt_lim (fun u => strut_length l (P u) (Q u)) t (Linear.dot (strut_row k ell l (P t) (Q t)) (twist k v (vscale ell omega))).
Proof.
  intros k ell l P Q t v omega e0 reach hP hQ hk. set (r := arm_of_joint l (Q t)). pose proof (vector_velocity l P Q t v omega hP hQ) as W. fold r in W.
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

(** In the plane z is 0 of all points; about a fixed point, the platform's is the origin. *)
(** [one_pose]: no two poses of the workspace have the same lengths of the legs. *)
Record turning_claim := MakeTurningClaim {
  motion_of : motion; struts : list (tolerances * tolerances); characteristic_length : number;
  positions : region; turned : orientations; turning_demands : list demand; one_pose : bool
}.

Definition is_strut (t : tolerances * tolerances) (l : strut) : Prop :=
  all_within (fst t) (strut_base l) /\ all_within (snd t) (strut_joint l).
(** The struts in the middle of the tolerances. *)
Definition nominal_struts (ts : list (tolerances * tolerances)) : list strut := map (fun t => Strut (middles (fst t)) (middles (snd t))) ts.
Definition is_about_struts (c : turning_claim) (m : list strut) (P : vec) (Q : mat) : Prop :=
  Forall2 is_strut (struts c) m /\ in_region (positions c) P /\ in_orientations (turned c) Q.
Definition meets_turning (c : turning_claim) (m : list strut) (P : vec) (Q : mat) : Prop :=
  Configuration.meets (dimension (motion_of c)) (struts_at (motion_of c) (value (characteristic_length c)) (nominal_struts (struts c)) m P Q) (turning_demands c).

Definition turning_holds (c : turning_claim) : Prop := forall m P Q, is_about_struts c m P Q -> meets_turning c m P Q /\
  (one_pose c = true -> forall P' Q', in_region (positions c) P' -> in_orientations (turned c) Q' ->
    Forall (fun l => strut_length l P' Q' = strut_length l P Q) m -> P' = P /\ Q' = Q).

(** ** A machine and a pose in exact numbers *)

Record exact_strut := StrutNumbers { xbase : numbers; xjoint : numbers }.
Definition strut_of (l : exact_strut) : strut := Strut (values (xbase l)) (values (xjoint l)).

Section Exact.
Definition xvector (o : orientations) (c : list number) (P : numbers) (l : exact_strut) : numbers :=
  each2 Minus (each2 Plus P (turn o c (xjoint l))) (xbase l).
Definition ntwist (k : motion) (v w : numbers) : list number :=
  match k with
  | InPlane => [nx v; ny v; nz w]
  | InSpace => [nx v; ny v; nz v; nx w; ny w; nz w]
  | AboutPoint => [nx w; ny w; nz w]
  end.
Definition xstrut_row (k : motion) (ell : number) (o : orientations) (c : list number) (P : numbers) (l : exact_strut) : list number :=
  let u := unit_of (xvector o c P l) in ntwist k u (scaled (Over (1 // 1) ell) (ncrossed (turn o c (xjoint l)) u)).

(** The row times the strut's length. *)
Definition xstrut_ray (k : motion) (ell : number) (o : orientations) (c : list number) (P : numbers) (l : exact_strut) : list number :=
  let w := xvector o c P l in ntwist k w (scaled (Over (1 // 1) ell) (ncrossed (turn o c (xjoint l)) w)).

Definition exact_struts_at (k : motion) (ell : number) (o : orientations) (c : list number) (P : numbers) (ls : list exact_strut) : nconfiguration :=
  let square l := product (xvector o c P l) (xvector o c P l) in
  NConfiguration (map (xstrut_row k ell o c P) ls) (map (fun l => NLength (Root (square l))) ls) (map (fun _ => None) ls)
    (map (fun l => Some (each2 Plus P (turn o c (xjoint l)), xvector o c P l, Root (square l))) ls) (fun b => each2 Plus P (turn o c b)) (map square ls)
    (map (fun l => Some (xstrut_ray k ell o c P l)) ls).
End Exact.

Section Stand.
Variables (o : orientations) (c : list number) (Q : mat).
Hypothesis is_turn : forall b, values (turn o c b) = mulv Q (values b).

Lemma values_xvector : forall P l, values (xvector o c P l) = strut_vector (strut_of l) (values P) Q.
Proof. intros. unfold xvector. rewrite values_minus, values_plus, is_turn. reflexivity. Qed.

Lemma exact_struts_stand : forall k ell nominal P ls,
  stands_for (exact_struts_at k ell o c P ls) (struts_at k (value ell) nominal (map strut_of ls) (values P) Q).
Proof.
  intros k ell nominal P ls.
  assert (S : forall l, value (product (xvector o c P l) (xvector o c P l)) = norm2 (strut_vector (strut_of l) (values P) Q))
    by (intro l; rewrite value_square, values_xvector; reflexivity).
  split; [| split; [| split; [| split; [| split]]]]; cbn [jacobian joints rods limbs placed reached njacobian njoints nrods nlimbs nplaced reserves nrays exact_struts_at struts_at]; rewrite ?map_map.
  - apply map_ext. intro l. unfold strut_row, xstrut_row. rewrite <- values_xvector, <- values_unit.
    assert (I : value (Over (1 // 1) ell) = / value ell) by (cbn [value]; unfold Rdiv; rewrite Rinv_1; ring).
    unfold arm_of_joint. cbn [strut_joint strut_of]. rewrite <- is_turn, <- I. destruct k; reflexivity.
  - apply map_ext. intro l. cbn [coordinate_of value]. rewrite S. reflexivity.
  - reflexivity.
  - apply map_ext. intro l. cbn [option_map real_rod]. rewrite values_plus, is_turn, values_xvector. cbn [value]. rewrite S. reflexivity.
  - intro b. rewrite values_plus, is_turn. reflexivity.
  - rewrite Forall_map. intro h. split; [rewrite Forall_map; revert h; apply Forall_impl; intros l h; rewrite S; exact h |].
    induction h as [| l ls h hs IH]; cbn [map]; constructor; [| exact IH]. exists (/ sqrt (norm2 (strut_vector (strut_of l) (values P) Q))).
    split; [apply Rinv_neq_0_compat, Rgt_not_eq, sqrt_lt_R0, h |].
    unfold strut_row, xstrut_ray. cbv zeta. rewrite <- values_xvector. unfold arm_of_joint. cbn [strut_joint strut_of]. rewrite <- is_turn.
    set (w := xvector o c P l). set (r := turn o c (xjoint l)). unfold normalised, twist, ntwist, vscale, cross, scaled, ncrossed.
    destruct k; cbn [map vx vy vz nx ny nz values value]; repeat (apply f_equal2; [unfold Rdiv; rewrite ?Rinv_1; ring |]); reflexivity.
Qed.
End Stand.

Section Precision.
Variable bits : positive.

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

(** The claim is about these struts in this pose. *)
Definition is_about_exactly (c : turning_claim) (ls : list exact_strut) (P : numbers) (t : list number) : bool :=
  all_struts (struts c) ls && is_in bits (positions c) P && is_orientation bits (turned c) t.
Lemma is_about_exactly_sound : forall c ls P t, is_about_exactly c ls P t = true ->
  exists Q, is_about_struts c (map strut_of ls) (values P) Q /\ forall b, values (turn (turned c) t b) = mulv Q (values b).
Proof.
  intros c ls P t h. apply andb_true_iff in h as [h o]. apply andb_true_iff in h as [h p]. destruct (is_orientation_sound bits _ _ o) as [Q [hQ turnQ]].
  exists Q. split; [split; [apply all_struts_sound, h | split; [exact (is_in_sound bits _ _ p) | exact hQ]] | exact turnQ].
Qed.

Definition refute_turning (c : turning_claim) (ls : list exact_strut) (P : numbers) (t : list number) (f : nfailure) : bool :=
  is_about_exactly c ls P t &&
  refutes bits (match motion_of c with AboutPoint => 1 | _ => 2 end) (dimension (motion_of c)) (exact_struts_at (motion_of c) (characteristic_length c) (turned c) t P ls) (turning_demands c) f.

(** A machine of the claim does not meet it in some pose of the workspace. *)
Theorem refute_turning_sound : forall c ls P t f, refute_turning c ls P t f = true ->
  exists m P Q, is_about_struts c m P Q /\ ~ meets_turning c m P Q.
Proof.
  intros c ls P t f h. apply andb_true_iff in h as [h r]. destruct (is_about_exactly_sound _ _ _ _ h) as [Q [about turnQ]]. exists (map strut_of ls), (values P), Q. split; [exact about |].
  exact (refutes_sound bits _ _ _ _ _ _ (exact_struts_stand _ _ Q turnQ _ _ _ _ _) r).
Qed.
End Precision.
End Named.
