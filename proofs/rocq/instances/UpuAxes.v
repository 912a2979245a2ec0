(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the numbers of
    the claim and the last theorem, with the definitions of kernel/Statement.v, Claim.v and
    Kinematics.v. *)

From Coq Require Import ZArith NArith Reals List.
From Orthocert Require Import Vec3 SingularValues Kinematics Claim.
From Orthocert.kernel Require Import Statement Check Problem.
Import ListNotations.
Local Open Scope R_scope.

Definition leg_1 : drive :=
  StrutLeg
    (Tolerances (exactly (200 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (50 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Some (Tolerances (exactly (0 // 1)) (exactly (1 // 1)) (exactly (0 // 1)))).

Definition leg_2 : drive :=
  StrutLeg
    (Tolerances (exactly ((-100) // 1)) (exactly (Times (100 // 1) (Root (3 // 1)))) (exactly (0 // 1)))
    (Tolerances (exactly ((-25) // 1)) (exactly (Times (25 // 1) (Root (3 // 1)))) (exactly (0 // 1)))
    (Some (Tolerances (exactly (Over (Minus (0 // 1) (Root (3 // 1))) (2 // 1))) (exactly ((-1) // 2)) (exactly (0 // 1)))).

Definition leg_3 : drive :=
  StrutLeg
    (Tolerances (exactly ((-100) // 1)) (exactly (Times ((-100) // 1) (Root (3 // 1)))) (exactly (0 // 1)))
    (Tolerances (exactly ((-25) // 1)) (exactly (Times ((-25) // 1) (Root (3 // 1)))) (exactly (0 // 1)))
    (Some (Tolerances (exactly (Over (Root (3 // 1)) (2 // 1))) (exactly ((-1) // 2)) (exactly (0 // 1)))).

Definition the_workspace : region :=
  Box (Tolerances (Within ((-30) // 1) (30 // 1)) (Within ((-30) // 1) (30 // 1)) (Within (100 // 1) (130 // 1))).

Definition the_claim : claim :=
  MakeClaim [leg_1; leg_2; leg_3] the_workspace [(PsiMax (5 // 4)); (PsiMin (21 // 25)); (ConstraintMargin (4 // 5))].

(** The proof: a bisection tree, and what shows the requirements on its boxes. *)
Definition certificate : tree :=
  (Split [(0, ByLower 2 [[(-4); (0); (3)]; [(2); (-3); (3)]; [(2); (3); (3)]]%Z); (2, ByLower 1 [[(-2); (0); (1)]; [(1); (-2); (1)]; [(1); (2); (1)]]%Z)]%nat 0
    (Split [] 1
      (Leaf [(1, ByTest)]%nat)
      (Leaf [(1, ByTest)]%nat))
    (Split [] 1
      (Leaf [(1, ByTest)]%nat)
      (Leaf [(1, ByTest)]%nat))).

Lemma checked : check_claim 52 the_claim (8) [(0); (-1); (-1)]%Z certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall m P, is_machine the_claim m -> in_region the_workspace P ->
  Forall (reaches P) m /\
  (forall v, v <> vzero -> 0 < speed2 m P v) /\
  (forall v, (1 / value (5 // 4)) ^ 2 * norm2 v <= speed2 m P v) /\
  (forall v, speed2 m P v <= (1 / value (21 // 25)) ^ 2 * norm2 v) /\
  (exists cs, Forall2 (fun l c => couple_of l P = Some c /\ c <> vzero) m cs /\ forall v, value (4 // 5) ^ 2 * norm2 v <= fold_right (fun c sum => dot (normalised c) v ^ 2 + sum) 0 cs).
Proof.
  intros m P hm hP.
  destruct (check_claim_sound _ _ _ _ _ checked m P hm hP) as [reached [regular met]].
  rewrite Forall_forall in met. split; [exact reached |]. split; [exact regular |].
  split; [exact (met (PsiMax (5 // 4)) (or_introl eq_refl)) |]. split; [exact (met (PsiMin (21 // 25)) (or_intror (or_introl eq_refl))) |]. exact (met (ConstraintMargin (4 // 5)) (or_intror (or_intror (or_introl eq_refl)))).
Qed.
