(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the numbers of
    the claim and the last theorem, with the definitions of kernel/Statement.v, Claim.v and
    Kinematics.v. *)

From Coq Require Import ZArith NArith Reals List.
From Orthocert Require Import Vec3 SingularValues Kinematics Claim.
From Orthocert.kernel Require Import Statement Check Problem.
Import ListNotations.
Local Open Scope R_scope.

Definition leg_1 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (699 // 4)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (exactly (333 // 1)) false).

Definition leg_2 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly ((-699) // 5)) (exactly ((-2097) // 20)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (exactly (333 // 1)) false).

Definition leg_3 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (699 // 5)) (exactly ((-2097) // 20)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (exactly (333 // 1)) false).

Definition the_workspace : region :=
  Box (Tolerances (Within ((-60) // 1) (60 // 1)) (Within ((-60) // 1) (60 // 1)) (Within (0 // 1) (200 // 1))).

Definition the_claim : claim :=
  MakeClaim [leg_1; leg_2; leg_3] the_workspace [(PsiMax (Over (8 // 1) (5 // 1))); (PsiMin (Over (1 // 1) (2 // 1)))].

(** The proof: a bisection tree, and what shows the requirements on its boxes. *)
Definition certificate : tree :=
  (Split [] 1
    (Split [(1, ByTest)]%nat 0
      (Leaf [(0, ByLower 14 [[(-1058); (-17077); (-10541)]; [(11239); (6307); (-11347)]; [(-14301); (7169); (-10179)]]%Z)]%nat)
      (Leaf [(0, ByLower 14 [[(1058); (-17077); (-10541)]; [(14301); (7169); (-10179)]; [(-11239); (6307); (-11347)]]%Z)]%nat))
    (Split [] 0
      (Leaf [(0, ByLower 14 [[(-1024); (-13068); (-11701)]; [(12150); (8732); (-10815)]; [(-15572); (9800); (-9582)]]%Z); (1, ByDivided)]%nat)
      (Leaf [(0, ByLower 14 [[(1024); (-13068); (-11701)]; [(15572); (9800); (-9582)]; [(-12150); (8732); (-10815)]]%Z); (1, ByDivided)]%nat))).

Lemma checked : check_claim 52 the_claim (9) [(0); (0); (0)]%Z certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall m P, is_machine the_claim m -> in_region the_workspace P ->
  Forall (reaches P) m /\
  (forall v, v <> vzero -> 0 < speed2 m P v) /\
  (forall v, (1 / value (Over (8 // 1) (5 // 1))) ^ 2 * norm2 v <= speed2 m P v) /\
  (forall v, speed2 m P v <= (1 / value (Over (1 // 1) (2 // 1))) ^ 2 * norm2 v).
Proof.
  intros m P hm hP.
  destruct (check_claim_sound _ _ _ _ _ checked m P hm hP) as [reached [regular met]].
  rewrite Forall_forall in met. split; [exact reached |]. split; [exact regular |].
  split; [exact (met (PsiMax (Over (8 // 1) (5 // 1))) (or_introl eq_refl)) |]. exact (met (PsiMin (Over (1 // 1) (2 // 1))) (or_intror (or_introl eq_refl))).
Qed.
