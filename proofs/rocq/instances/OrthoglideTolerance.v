(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the numbers of
    the claim and the last theorem, with the definitions of Claim.v and Kinematics.v. *)

From Coq Require Import ZArith Reals List.
From Orthocert Require Import Vec3 SingularValues Kinematics Claim Checker.
Import ListNotations.
Local Open Scope R_scope.

(** direction, anchor, platform, length, mode *)
Definition leg_1 : slider :=
  Slider
    (Tolerances (exactly (1 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3113 // 10) (3117 // 10))
    true.

(** direction, anchor, platform, length, mode *)
Definition leg_2 : slider :=
  Slider
    (Tolerances (exactly (0 // 1)) (exactly (1 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3113 // 10) (3117 // 10))
    true.

(** direction, anchor, platform, length, mode *)
Definition leg_3 : slider :=
  Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3113 // 10) (3117 // 10))
    true.

Definition box : tolerances :=
  Tolerances
    (Within ((-366) // 5) (634 // 5))
    (Within ((-366) // 5) (634 // 5))
    (Within ((-366) // 5) (634 // 5)).

(** Transmission factors from psi_min to psi_max. *)
Definition claim : machine_claim :=
  MachineClaim leg_1 leg_2 leg_3 box (Some (1 // 2)) (Some (2 // 1)).

(** The proof: a bisection tree, and the rules that hold on its boxes. *)
Definition certificate : tree :=
  (Split [Upper] AlongX
    (Split [] AlongY
      (Split [] AlongZ
        (Leaf [Lower (1) (0) (0) (0) true])
        (Leaf [Lower (1) (0) (0) (0) true]))
      (Leaf [Lower (1) (0) (0) (0) true]))
    (Split [] AlongY
      (Leaf [Lower (1) (0) (0) (0) true])
      (Split [] AlongZ
        (Leaf [Lower (1) (0) (0) (0) true])
        (Split [] AlongX
          (Leaf [Lower (1) (0) (0) (0) true])
          (Split [] AlongY
            (Leaf [Lower (1) (0) (0) (0) true])
            (Split [] AlongZ
              (Leaf [Lower (1) (0) (0) (0) true])
              (Split [] AlongX
                (Leaf [Lower (1) (0) (0) (0) true])
                (Split [] AlongY
                  (Leaf [Lower (1) (0) (0) (0) true])
                  (Split [] AlongZ
                    (Leaf [Lower (1) (0) (0) (0) true])
                    (Split [] AlongX
                      (Leaf [Lower (1) (0) (0) (0) true])
                      (Split [] AlongY
                        (Leaf [Lower (1) (0) (0) (0) true])
                        (Split [] AlongZ
                          (Leaf [Lower (1) (0) (0) (0) true])
                          (Leaf [Lower (1) (0) (0) (0) true]))))))))))))).

Lemma checked : check 100 claim certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall m P, is_machine claim m -> all_within box P ->
  regular m P /\
  sigma_at_least (1 / value (2 // 1)) (Jinv m P) /\
  sigma_at_most (1 / value (1 // 2)) (Jinv m P).
Proof.
  intros m P hm hP. destruct (check_sound 100 claim certificate checked m P hm hP) as [reg [low up]].
  split; [exact reg |]. split; [exact (low _ eq_refl) | exact (up _ eq_refl)].
Qed.
