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
    (Tolerances (exactly (Over (Times ((-699) // 4) (Root (3 // 1))) (2 // 1))) (exactly ((-699) // 8)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (exactly (333 // 1)) false).

Definition leg_3 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (Over (Times (699 // 4) (Root (3 // 1))) (2 // 1))) (exactly ((-699) // 8)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (exactly (333 // 1)) false).

Definition the_workspace : region :=
  Cylinder (0 // 1) (0 // 1) (80 // 1) (Within (0 // 1) (100 // 1)).

Definition the_claim : claim :=
  MakeClaim [leg_1; leg_2; leg_3] the_workspace [NotSingular; (ParallelMargin (3 // 5))].

(** The proof: a bisection tree, and what shows the requirements on its boxes. *)
Definition certificate : tree :=
  (Split [(0, ByRank 1 [[(0); (-1); (-1)]; [(1); (1); (-1)]; [(-1); (1); (-1)]]%Z)]%nat 0
    (Split [] 1
      (Split [] 1
        (Split [] 0
          (Split [] 1
            (Leaf [(1, ByNegative)]%nat)
            (Leaf [(1, ByNegative)]%nat))
          (Split [] 1
            (Leaf [(1, ByNegative)]%nat)
            (Leaf [(1, ByNegative)]%nat)))
        (Split [] 0
          (Split [] 0
            (Leaf [(1, ByNegative)]%nat)
            (Leaf [(1, ByNegative)]%nat))
          (Split [] 1
            (Split [] 0
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat))
            (Split [] 0
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat)))))
      (Split [] 0
        (Split [] 1
          (Split [] 0
            (Leaf [(1, ByNegative)]%nat)
            (Split [] 1
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat)))
          (Split [] 0
            (Leaf [(1, ByNegative)]%nat)
            (Leaf [(1, ByNegative)]%nat)))
        (Split [] 1
          (Split [] 0
            (Split [] 1
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat))
            (Split [] 1
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat)))
          (Split [] 1
            (Split [] 0
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat))
            (Leaf [(1, ByNegative)]%nat)))))
    (Split [] 1
      (Split [] 1
        (Split [] 0
          (Split [] 1
            (Leaf [(1, ByNegative)]%nat)
            (Leaf [(1, ByNegative)]%nat))
          (Split [] 1
            (Leaf [(1, ByNegative)]%nat)
            (Leaf [(1, ByNegative)]%nat)))
        (Split [] 0
          (Split [] 1
            (Split [] 0
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat))
            (Split [] 0
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat)))
          (Split [] 0
            (Leaf [(1, ByNegative)]%nat)
            (Leaf [(1, ByNegative)]%nat))))
      (Split [] 0
        (Split [] 1
          (Split [] 0
            (Split [] 1
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat))
            (Split [] 1
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat)))
          (Split [] 1
            (Split [] 0
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat))
            (Leaf [(1, ByNegative)]%nat)))
        (Split [] 1
          (Split [] 0
            (Split [] 1
              (Leaf [(1, ByNegative)]%nat)
              (Leaf [(1, ByNegative)]%nat))
            (Leaf [(1, ByNegative)]%nat))
          (Split [] 0
            (Leaf [(1, ByNegative)]%nat)
            (Leaf [(1, ByNegative)]%nat)))))).

Lemma checked : check_claim 52 the_claim (9) [(0); (0); (0)]%Z certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall m P, is_machine the_claim m -> in_region the_workspace P ->
  Forall (reaches P) m /\
  (forall v, v <> vzero -> 0 < speed2 m P v) /\
  (exists l1 l2 l3, m = [l1; l2; l3] /\ value (3 // 5) * size_of l1 P * size_of l2 P * size_of l3 P <= Rabs (det (Mat (vector_of l1 P) (vector_of l2 P) (vector_of l3 P)))).
Proof.
  intros m P hm hP.
  destruct (check_claim_sound _ _ _ _ _ checked m P hm hP) as [reached [regular met]].
  rewrite Forall_forall in met. split; [exact reached |]. split; [exact regular |].
  exact (met (ParallelMargin (3 // 5)) (or_intror (or_introl eq_refl))).
Qed.
