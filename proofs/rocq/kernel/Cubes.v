(** * Cubes that do not fit

    What is claimed of the largest cube: with the side [a], none is met everywhere, wherever
    its centre is in the box that is the claim's workspace. *)

From Coq Require Import Reals.
From Orthocert Require Import Vec3 SingularValues Kinematics Claim.
From Orthocert.kernel Require Import Statement Witness.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.

(** [P] is in the closed cube with the side [a], the centre [C] and edges along the axes. *)
Definition in_cube_about (a : R) (C P : vec) : Prop :=
  Rabs (vx P - vx C) <= a / 2 /\ Rabs (vy P - vy C) <= a / 2 /\ Rabs (vz P - vz C) <= a / 2.

(** Of every machine that can be built, and every centre, the cube has a point at which [c] is not met. *)
Definition has_no_cube (c : claim) (side : number) : Prop :=
  forall m C, is_about c m C -> exists P, in_cube_about (value side) C P /\ ~ meets c m P.
End Named.
