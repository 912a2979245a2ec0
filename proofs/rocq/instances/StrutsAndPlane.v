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
    (Tolerances (exactly (Times ((-150) // 1) (Root (3 // 1)))) (exactly ((-150) // 1)) (Within (Over ((-1) // 1) (10 // 1)) (Over (1 // 1) (10 // 1))))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (10 // 1)))
    None.

Definition leg_2 : drive :=
  StrutLeg
    (Tolerances (exactly (Times (150 // 1) (Root (3 // 1)))) (exactly ((-150) // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (10 // 1)))
    None.

Definition leg_3 : drive :=
  StrutLeg
    (Tolerances (exactly (0 // 1)) (exactly (300 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (10 // 1)))
    None.

Definition leg_4 : drive :=
  PlanarLeg
    (Tolerances (exactly (1 // 1)) (exactly (2 // 1)) (Within (199 // 100) (201 // 100))).

Definition the_workspace : region :=
  Box (Tolerances (Within ((-40) // 1) (40 // 1)) (Within ((-40) // 1) (40 // 1)) (Within (180 // 1) (240 // 1))).

Definition the_claim : claim :=
  MakeClaim [leg_1; leg_2; leg_3; leg_4] the_workspace [(PsiMax (Over (23 // 1) (20 // 1))); (PsiMin (Over (2 // 1) (3 // 1))); (JointMax 3 (250 // 1))].

(** The proof: a bisection tree, and what shows the requirements on its boxes. *)
Definition certificate : tree :=
  (Split [(0, ByLower 14 [[(12124); (4523); (8014)]; [(-14680); (6374); (9771)]; [(324); (-15361); (11936)]; [(3397); (6794); (6592)]]%Z); (2, ByTest)]%nat 1
    (Leaf [(1, ByTest)]%nat)
    (Leaf [(1, ByTest)]%nat)).

Lemma checked : check_claim 52 the_claim (9) [(0); (0); (0); (1)]%Z certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall m P, is_machine the_claim m -> in_region the_workspace P ->
  Forall (reaches P) m /\
  (forall v, v <> vzero -> 0 < speed2 m P v) /\
  (forall v, (1 / value (Over (23 // 1) (20 // 1))) ^ 2 * norm2 v <= speed2 m P v) /\
  (forall v, speed2 m P v <= (1 / value (Over (2 // 1) (3 // 1))) ^ 2 * norm2 v) /\
  (exists l, nth_error m 3 = Some l /\ joint l P <= value (250 // 1)).
Proof.
  intros m P hm hP.
  destruct (check_claim_sound _ _ _ _ _ checked m P hm hP) as [reached [regular met]].
  rewrite Forall_forall in met. split; [exact reached |]. split; [exact regular |].
  split; [exact (met (PsiMax (Over (23 // 1) (20 // 1))) (or_introl eq_refl)) |]. split; [exact (met (PsiMin (Over (2 // 1) (3 // 1))) (or_intror (or_introl eq_refl))) |]. exact (met (JointMax 3 (250 // 1)) (or_intror (or_intror (or_introl eq_refl)))).
Qed.
