(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the numbers of
    the claim and the last theorem, with the definitions of Claim.v and Kinematics.v. *)

From Coq Require Import ZArith Reals List.
From Orthocert Require Import Vec3 SingularValues Kinematics Claim Checker.
Import ListNotations.
Local Open Scope R_scope.

(** direction, anchor, platform, length, mode *)
Definition leg_1 : slider :=
  Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (699 // 4)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (exactly (333 // 1))
    false.

(** direction, anchor, platform, length, mode *)
Definition leg_2 : slider :=
  Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly ((-699) // 5)) (exactly ((-2097) // 20)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (exactly (333 // 1))
    false.

(** direction, anchor, platform, length, mode *)
Definition leg_3 : slider :=
  Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (699 // 5)) (exactly ((-2097) // 20)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (exactly (333 // 1))
    false.

Definition box : tolerances :=
  Tolerances
    (Within ((-60) // 1) (60 // 1))
    (Within ((-60) // 1) (60 // 1))
    (Within (0 // 1) (200 // 1)).

(** Transmission factors from psi_min to psi_max. *)
Definition claim : machine_claim :=
  MachineClaim leg_1 leg_2 leg_3 box (Some (1 // 2)) (Some (8 // 5)).

(** The proof: a bisection tree, and the rules that hold on its boxes. *)
Definition certificate : tree :=
  (Split [] AlongY
    (Split [Upper] AlongX
      (Split [] AlongY
        (Split [] AlongX
          (Leaf [Lower (4) (4) (1) (5) true])
          (Leaf [Lower (5) (4) (1) (6) true]))
        (Split [] AlongX
          (Leaf [Lower (4) (4) (1) (5) true])
          (Leaf [Lower (4) (4) (1) (6) true])))
      (Split [] AlongY
        (Split [] AlongX
          (Leaf [Lower (5) (3) (1) (6) true])
          (Leaf [Lower (5) (3) (1) (6) true]))
        (Split [] AlongX
          (Leaf [Lower (4) (3) (0) (6) true])
          (Leaf [Lower (4) (3) (0) (6) true]))))
    (Split [] AlongX
      (Split [Upper] AlongY
        (Leaf [Lower (17) (16) (2) (22) true])
        (Leaf [Lower (4) (4) (0) (5) true]))
      (Split [Upper] AlongY
        (Leaf [Lower (2) (2) (0) (3) true])
        (Leaf [Lower (2) (2) (0) (3) true])))).

Lemma checked : check 100 claim certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall m P, is_machine claim m -> all_within box P ->
  regular m P /\
  sigma_at_least (1 / value (8 // 5)) (Jinv m P) /\
  sigma_at_most (1 / value (1 // 2)) (Jinv m P).
Proof.
  intros m P hm hP. destruct (check_sound 100 claim certificate checked m P hm hP) as [reg [low up]].
  split; [exact reg |]. split; [exact (low _ eq_refl) | exact (up _ eq_refl)].
Qed.
