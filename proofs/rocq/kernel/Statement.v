(** * Claims about machines with any number of legs

    What a certificate of the kernel is about, in exact numbers, and what it
    means.  An instance states its theorem with these definitions, those of
    Claim.v and those of Kinematics.v: they have to be read to know what is
    proved; the checker does not. *)

From Coq Require Import ZArith Reals List.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Claim.
Import ListNotations.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.


(** ** Machines *)

Inductive leg :=
  (* of fixed length, on a linear guide *)
  | Guided (l : Kinematics.leg)
  (* extensible, from its base joint to the platform's at P + platform *)
  (* and, of struts that keep the platform from turning, the unit vector of the joint axis in the base *)
  | Extensible (base platform : vec) (axis : option vec)
  (* a plane that is moved along its normal, which may have any length but zero *)
  | Plane (normal : vec).

Definition normalised (d : vec) : vec := vscale (/ sqrt (norm2 d)) d.

(** From the base joint of an extensible leg to its platform's. *)
Definition span (base platform P : vec) : vec := vsub (vadd P platform) base.

(** The joint coordinate rho_i. *)
Definition joint (l : leg) (P : vec) : R :=
  match l with
  | Guided l => rho l P
  | Extensible base platform _ => sqrt (norm2 (span base platform P))
  | Plane n => dot (normalised n) P
  end.

(** The leg reaches P and is not serially singular there. *)
Definition reaches (P : vec) (l : leg) : Prop :=
  match l with
  | Guided l => 0 < s l P
  | Extensible base platform _ => 0 < norm2 (span base platform P)
  | Plane _ => True
  end.

(** The row of M = J^-1: rho_i' = row . P' ([row_is_derivative] in Machine.v). *)
Definition row (l : leg) (P : vec) : vec :=
  match l with
  | Guided l => Jinv_row l P
  | Extensible base platform _ => normalised (span base platform P)
  | Plane n => normalised n
  end.

(** The couple that the leg constrains: the part of the leg orthogonal to the axis. *)
Definition couple (axis w : vec) : vec := vsub w (vscale (dot axis w) axis).
Definition couple_of (l : leg) (P : vec) : option vec :=
  match l with Extensible base platform (Some axis) => Some (couple axis (span base platform P)) | _ => None end.

(** Row i of A: the leg's vector, or a plane's normal. *)
Definition vector_of (l : leg) (P : vec) : vec :=
  match l with Guided l => leg_vector l P | Extensible base platform _ => span base platform P | Plane n => normalised n end.
(** |vector_of|, where a leg of fixed length reaches. *)
Definition size_of (l : leg) (P : vec) : R :=
  match l with Guided l => leg_length l | Extensible base platform _ => sqrt (norm2 (span base platform P)) | Plane _ => 1 end.

(** |M v|^2 *)
Definition speed2 (m : list leg) (P v : vec) : R := fold_right (fun l sum => dot (row l P) v ^ 2 + sum) 0 m.

(** v . M^T diag(joints) M v *)
Fixpoint elastic (joints : list number) (m : list leg) (P v : vec) : R :=
  match joints, m with k :: joints', l :: m' => value k * dot (row l P) v ^ 2 + elastic joints' m' P v | _, _ => 0 end.

(** The power of joint forces tau where the platform moves with v. *)
Fixpoint joint_power (m : list leg) (tau : list R) (P v : vec) : R :=
  match m, tau with l :: m', t :: tau' => t * dot (row l P) v + joint_power m' tau' P v | _, _ => 0 end.

(** ** Bodies: all within [radius] of a segment *)

Record position := Position { px : number; py : number; pz : number }.
Definition located (p : position) : vec := Vec (value (px p)) (value (py p)) (value (pz p)).

Inductive body :=
  (* along a leg, from [after_base] after its base end to [before_platform] before its platform end, and moved by [beside] *)
  | AlongLeg (leg : nat) (radius after_base before_platform : number) (beside : position)
  | OnBase (radius : number) (from to : position)
  | OnPlatform (radius : number) (from to : position).
Definition radius_of (b : body) : number := match b with AlongLeg _ r _ _ _ | OnBase r _ _ | OnPlatform r _ _ => r end.

(** A leg's platform end, the vector from its base end to there, and its length. *)
Definition rod_of (l : leg) (P : vec) : option (vec * vec * R) :=
  match l with
  | Guided l => Some (C_point l P, leg_vector l P, leg_length l)
  | Extensible base platform _ => Some (vadd P platform, span base platform P, sqrt (norm2 (span base platform P)))
  | Plane _ => None
  end.
(** [rods]: of each leg what [rod_of] is; [placed]: where points of the platform are. *)
Definition segment_along (rods : list (option (vec * vec * R))) (placed : vec -> vec) (b : body) : option (vec * vec) :=
  match b with
  | AlongLeg i _ t u o =>
      match nth_error rods i with
      | Some (Some (C, A, L)) => Some (vadd (vsub C (vscale (1 - value t / L) A)) (located o), vadd (vsub C (vscale (value u / L) A)) (located o))
      | _ => None
      end
  | OnBase _ p q => Some (located p, located q)
  | OnPlatform _ p q => Some (placed (located p), placed (located q))
  end.
Definition segment_of (m : list leg) (P : vec) : body -> option (vec * vec) := segment_along (map (fun l => rod_of l P) m) (vadd P).
Definition towards (t : R) (p q : vec) : vec := vadd (vscale (1 - t) p) (vscale t q).
(** The distance of two bodies is at least [b]. *)
Definition are_clear (segment : body -> option (vec * vec)) (one other : body) (b : number) : Prop :=
  exists p p' q q', segment one = Some (p, p') /\ segment other = Some (q, q') /\ forall s t, 0 <= s <= 1 -> 0 <= t <= 1 ->
    (value (radius_of one) + value (radius_of other) + value b) ^ 2 <= norm2 (vsub (towards s p p') (towards t q q')).

(** ** Claims *)

Inductive drive :=
  | SliderLeg (c : slider)
  | StrutLeg (anchor platform : tolerances) (base_axis : option tolerances)
  | PlanarLeg (direction : tolerances).

Definition is_leg_of (d : drive) (l : leg) : Prop :=
  match d, l with
  | SliderLeg c, Guided l => is_leg c l
  | StrutLeg a p k, Extensible base platform axis => all_within a base /\ all_within p platform /\
      match k, axis with
      | None, None => True
      | Some k, Some axis => exists d, all_within k d /\ axis = normalised d
      | _, _ => False
      end
  | PlanarLeg d, Plane n => all_within d n
  | _, _ => False
  end.

(** Of points of the platform: a box, or a cylinder parallel to z. *)
Inductive region :=
  | Box (edges : tolerances)
  | Cylinder (center_x center_y radius : number) (height : tolerance).

Definition in_region (w : region) (P : vec) : Prop :=
  match w with
  | Box edges => all_within edges P
  | Cylinder x y radius height =>
      (vx P - value x) ^ 2 + (vy P - value y) ^ 2 <= value radius ^ 2 /\ 0 <= value radius /\ within height (vz P)
  end.

(** Legs are counted from zero. *)
Inductive requirement :=
  | NotSingular
  | PsiMax (b : number) | PsiMin (b : number)          (* velocity transmission factors *)
  | JointMin (leg : nat) (b : number) | JointMax (leg : nat) (b : number)
  | JointSpeed (leg : nat) (tool b : number)           (* of no velocity of the platform up to [tool] *)
  | ConditionMax (b : number)                          (* sigma_max / sigma_min *)
  | SerialMargin (leg : nat) (b : number)              (* |eta| / L, of sliders *)
  | ParallelMargin (b : number)                        (* |det A| / (L_1 L_2 L_3), of three legs *)
  | Stiffness (joint b : number)                       (* M^T joint M, with rigid legs *)
  | ConstraintMargin (b : number)                      (* sigma_min of the unit couples, of struts with an axis *)
  | Clearance (one other : body) (b : number)          (* the distance of two bodies *)
  (* of the lines along a leg, moved by [one] and by [other]: two bodies beside each other on it *)
  | Beside (leg : nat) (one other : position) (distance : number)
  (* of no motion of the platform with these acceleration and speed at most *)
  | JointAcceleration (leg : nat) (acceleration speed b : number)
  | JointForce (leg : nat) (tool b : number)           (* of no static force on the platform up to [tool] *)
  | OneToOne                                           (* no two points of the workspace have the same joint coordinates *)
  (* the one position near that of the nominal machine, where joints are off by [error] at most *)
  | Accuracy (error b : number)
  | Stiffnesses (joints : list number) (b : number).   (* of joints that differ *)

Record claim := MakeClaim { legs : list drive; workspace : region; require : list requirement }.

(** [m] is one of the machines that the claim is about. *)
Definition is_machine (c : claim) (m : list leg) : Prop := Forall2 is_leg_of (legs c) m.

(** The machine in the middle of the tolerances. *)
Definition middle (t : tolerance) : R := (value (least t) + value (greatest t)) / 2.
Definition middles (t : tolerances) : vec := Vec (middle (tx t)) (middle (ty t)) (middle (tz t)).
Definition nominal_leg (d : drive) : leg :=
  match d with
  | SliderLeg c => Guided (Leg (normalised (middles (direction c))) (middles (anchor c)) (middles (Claim.platform c)) (middle (Claim.length c)) (if mode c then 1 else -1))
  | StrutLeg a p k => Extensible (middles a) (middles p) (match k with Some k => Some (normalised (middles k)) | None => None end)
  | PlanarLeg n => Plane (middles n)
  end.

(** M is injective: no motion of the platform leaves all joints at rest. *)
Definition injective (m : list leg) (P : vec) : Prop := forall v, v <> vzero -> 0 < speed2 m P v.

Definition fulfils (c : claim) (m : list leg) (P : vec) (r : requirement) : Prop :=
  match r with
  | NotSingular => injective m P
  | PsiMax b => forall v, (1 / value b) ^ 2 * norm2 v <= speed2 m P v
  | PsiMin b => forall v, speed2 m P v <= (1 / value b) ^ 2 * norm2 v
  | JointMin i b => exists l, nth_error m i = Some l /\ value b <= joint l P
  | JointMax i b => exists l, nth_error m i = Some l /\ joint l P <= value b
  | JointSpeed i tool b => exists l, nth_error m i = Some l /\
      forall v, norm2 v <= value tool ^ 2 -> dot (row l P) v ^ 2 <= value b ^ 2
  | ConditionMax b => forall u v, speed2 m P u * norm2 v <= value b ^ 2 * (speed2 m P v * norm2 u)
  | SerialMargin i b => exists k, nth_error m i = Some (Guided k) /\ (value b * leg_length k) ^ 2 <= eta k P ^ 2
  | ParallelMargin b => exists l1 l2 l3, m = [l1; l2; l3] /\
      value b * size_of l1 P * size_of l2 P * size_of l3 P <= Rabs (det (Mat (vector_of l1 P) (vector_of l2 P) (vector_of l3 P)))
  | Stiffness joint b => forall v, value b / value joint * norm2 v <= speed2 m P v
  | ConstraintMargin b => exists cs, Forall2 (fun l c => couple_of l P = Some c /\ c <> vzero) m cs /\
      forall v, value b ^ 2 * norm2 v <= fold_right (fun c sum => dot (normalised c) v ^ 2 + sum) 0 cs
  | Clearance one other b => are_clear (segment_of m P) one other b
  | Beside i one other distance => exists l C A L, nth_error m i = Some l /\ rod_of l P = Some (C, A, L) /\ forall t u,
      value distance ^ 2 <= norm2 (vsub (vadd (vsub C (vscale t A)) (located one)) (vadd (vsub C (vscale u A)) (located other)))
  (* row . V is the joint's speed *)
  | JointAcceleration i acceleration speed b => exists l, nth_error m i = Some l /\ forall path V a,
      path 0 = P -> has_velocity path 0 (V 0) -> has_velocity V 0 a -> norm2 (V 0) <= value speed ^ 2 -> norm2 a <= value acceleration ^ 2 ->
      exists y, derivable_pt_lim (fun t => dot (row l (path t)) (V t)) 0 y /\ Rabs y <= value b
  (* virtual work: the joint forces tau hold the force F on the platform *)
  | JointForce i tool b => (exists l, nth_error m i = Some l) /\ forall tau F, Datatypes.length tau = Datatypes.length m ->
      (forall v, dot F v = joint_power m tau P v) -> norm2 F <= value tool ^ 2 -> Rabs (nth i tau 0) <= value b
  | OneToOne => forall P', in_region (workspace c) P' -> Forall (reaches P') m -> Forall (fun l => joint l P' = joint l P) m -> P' = P
  (* rho: joint coordinates near those that the nominal machine has at P *)
  | Accuracy error b => forall rho, Forall2 (fun d r => Rabs (r - joint (nominal_leg d) P) <= value error) (legs c) rho ->
      let is_at P' := norm2 (vsub P' P) <= value b ^ 2 /\ Forall2 (fun l r => reaches P' l /\ joint l P' = r) m rho in
      exists P', is_at P' /\ forall P'', is_at P'' -> P'' = P'
  | Stiffnesses joints b => Datatypes.length joints = Datatypes.length m /\ forall v, value b * norm2 v <= elastic joints m P v
  end.

(** Every leg reaches [P], no singularity is there, and every requirement is met. *)
Definition meets (c : claim) (m : list leg) (P : vec) : Prop :=
  Forall (reaches P) m /\ injective m P /\ Forall (fulfils c m P) (require c).

Definition holds (c : claim) : Prop :=
  forall m P, is_machine c m -> in_region (workspace c) P -> meets c m P.
End Named.
