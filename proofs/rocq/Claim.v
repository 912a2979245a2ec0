(** * Exact numbers, and sliders within tolerances

    An instance states its theorem with these definitions and those of
    kernel/Statement.v: they have to be read to know what is proved; the
    checker does not. *)

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
