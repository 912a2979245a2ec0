(** * Claims about machines within tolerances

    What a certificate is about, in exact numbers, and what it means.  An
    instance states its theorem with these definitions: they have to be read
    to know what is proved; the checker does not. *)

From Coq Require Import ZArith Reals.
From Orthocert Require Import Vec3 SingularValues Kinematics.
Local Open Scope R_scope.

(** ** Exact numbers *)

Inductive number :=
  | Ratio (n : Z) (d : positive)
  | Plus (x y : number)
  | Minus (x y : number)
  | Times (x y : number)
  | Over (x y : number)
  | Root (x : number).

Notation "n // d" := (Ratio n d) (at level 40).

Fixpoint value (x : number) : R :=
  match x with
  | Ratio n d => IZR n / IZR (Zpos d)
  | Plus x y => value x + value y
  | Minus x y => value x - value y
  | Times x y => value x * value y
  | Over x y => value x / value y
  | Root x => sqrt (value x)
  end.

(** A parameter: every value from [least] to [greatest]. *)
Record tolerance := Within { least : number; greatest : number }.
Definition within (t : tolerance) (x : R) : Prop := value (least t) <= x <= value (greatest t).
Definition exactly (x : number) : tolerance := Within x x.

(** The same for the three coordinates of a vector, independently. *)
Record tolerances := Tolerances { tx : tolerance; ty : tolerance; tz : tolerance }.
Definition all_within (t : tolerances) (v : vec) : Prop :=
  within (tx t) (vx v) /\ within (ty t) (vy v) /\ within (tz t) (vz v).

(** ** Machines *)

(** A leg of fixed length on a linear guide.  [direction] may have any length
    but zero; the axis is that vector normalised.  [mode]: whether the leg
    points along its guide's direction ([true]) or against it. *)
Record slider := Slider {
  direction : tolerances;
  anchor : tolerances;
  platform : tolerances;
  length : tolerance;
  mode : bool
}.

Definition is_leg (c : slider) (l : leg) : Prop :=
  (exists d, all_within (direction c) d /\ axis l = vscale (/ sqrt (norm2 d)) d) /\
  all_within (anchor c) (base_point l) /\
  all_within (platform c) (platform_offset l) /\
  within (length c) (leg_length l) /\
  working_mode l = (if mode c then 1 else -1).

Record machine_claim := MachineClaim {
  slider1 : slider;
  slider2 : slider;
  slider3 : slider;
  workspace : tolerances;      (* the box: least and greatest coordinates *)
  psi_min : option number;     (* bounds on the velocity transmission factors *)
  psi_max : option number
}.

(** [m] is one of the machines that the claim is about. *)
Definition is_machine (c : machine_claim) (m : machine) : Prop :=
  is_leg (slider1 c) (leg1 m) /\ is_leg (slider2 c) (leg2 m) /\ is_leg (slider3 c) (leg3 m).

(** No singularity at [P], and every velocity transmission factor, 1 over a
    singular value of J^-1, from psi_min to psi_max (where these are given). *)
Definition meets (c : machine_claim) (m : machine) (P : vec) : Prop :=
  regular m P /\
  (forall psi, psi_max c = Some psi -> sigma_at_least (1 / value psi) (Jinv m P)) /\
  (forall psi, psi_min c = Some psi -> sigma_at_most (1 / value psi) (Jinv m P)).

Definition holds (c : machine_claim) : Prop :=
  forall m P, is_machine c m -> all_within (workspace c) P -> meets c m P.
