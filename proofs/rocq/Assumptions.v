(** * Statements and assumptions of the final theorems

    `make` compares the output of this file with `assumptions.expected`: a
    changed statement or a new axiom makes the build fail. *)

From Coq Require Import Reals.
From Orthocert Require Import Vec3 SingularValues Kinematics Postulate.
Local Open Scope R_scope.
Set Printing Width 100.

Check q1q2_postulate.
Print Assumptions q1q2_postulate.
Check tight_only_at_Q1_Q2.
Print Assumptions tight_only_at_Q1_Q2.
Check velocity_transmission.
Print Assumptions velocity_transmission.
Check transmission_factors.
Print Assumptions transmission_factors.
