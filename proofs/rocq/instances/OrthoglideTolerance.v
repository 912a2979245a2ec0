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
    (Tolerances (exactly (1 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3113 // 10) (3117 // 10)) true).

Definition leg_2 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (1 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3113 // 10) (3117 // 10)) true).

Definition leg_3 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3113 // 10) (3117 // 10)) true).

Definition the_workspace : region :=
  Box (Tolerances (Within ((-366) // 5) (634 // 5)) (Within ((-366) // 5) (634 // 5)) (Within ((-366) // 5) (634 // 5))).

Definition the_claim : claim :=
  MakeClaim [leg_1; leg_2; leg_3] the_workspace [(PsiMax (2 // 1)); (PsiMin (Over (1 // 1) (2 // 1)))].

(** The proof: a bisection tree, and what shows the requirements on its boxes. *)
Definition certificate : tree :=
  (Split [(1, ByDivided)]%nat 2
    (Split [] 1
      (Split [] 0
        (Leaf [(0, ByLowerDivided 14 [[(8192); (0); (0)]; [(0); (8192); (0)]; [(0); (0); (8192)]]%Z)]%nat)
        (Leaf [(0, ByLower 14 [[(13158); (-2258); (-2258)]; [(2324); (13738); (-197)]; [(2324); (-197); (13738)]]%Z)]%nat))
      (Leaf [(0, ByLowerDivided 14 [[(8140); (654); (-646)]; [(-746); (8062); (-1250)]; [(536); (1301); (8070)]]%Z)]%nat))
    (Split [] 1
      (Leaf [(0, ByLowerDivided 14 [[(8140); (-646); (654)]; [(536); (8070); (1301)]; [(-746); (-1250); (8062)]]%Z)]%nat)
      (Split [] 0
        (Leaf [(0, ByLower 14 [[(14050); (2119); (2119)]; [(-2056); (13782); (-153)]; [(-2056); (-153); (13782)]]%Z)]%nat)
        (Split [] 2
          (Leaf [(0, ByLower 14 [[(14092); (-11); (-554)]; [(-11); (14092); (-554)]; [(565); (565); (14344)]]%Z)]%nat)
          (Split [] 1
            (Leaf [(0, ByLower 14 [[(14449); (-587); (591)]; [(548); (14699); (1206)]; [(-620); (-1129); (14044)]]%Z)]%nat)
            (Split [] 0
              (Leaf [(0, ByLower 14 [[(15086); (1218); (1218)]; [(-1161); (14426); (-47)]; [(-1161); (-47); (14426)]]%Z)]%nat)
              (Split [] 2
                (Leaf [(0, ByLower 14 [[(14948); (-3); (-317)]; [(-3); (14948); (-317)]; [(322); (322); (15177)]]%Z)]%nat)
                (Split [] 1
                  (Leaf [(0, ByLower 14 [[(15208); (-331); (330)]; [(321); (15442); (675)]; [(-339); (-645); (14934)]]%Z)]%nat)
                  (Split [] 0
                    (Leaf [(0, ByLower 14 [[(15722); (686); (686)]; [(-662); (15201); (-14)]; [(-662); (-14); (15201)]]%Z)]%nat)
                    (Split [] 2
                      (Leaf [(0, ByLower 14 [[(15599); (-1); (-176)]; [(-1); (15599); (-176)]; [(178); (178); (15750)]]%Z)]%nat)
                      (Split [] 1
                        (Leaf [(0, ByLower 14 [[(15758); (-181); (180)]; [(178); (15912); (365)]; [(-182); (-356); (15594)]]%Z)]%nat)
                        (Split [] 0
                          (Leaf [(0, ByLower 14 [[(16080); (370); (370)]; [(-362); (15756); (-4)]; [(-362); (-4); (15756)]]%Z)]%nat)
                          (Leaf [(0, ByLower 14 [[(16088); (0); (0)]; [(0); (16088); (0)]; [(0); (0); (16088)]]%Z)]%nat))))))))))))).

Lemma checked : check_claim 52 the_claim (9) [(0); (0); (0)]%Z certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall m P, is_machine the_claim m -> in_region the_workspace P ->
  Forall (reaches P) m /\
  (forall v, v <> vzero -> 0 < speed2 m P v) /\
  (forall v, (1 / value (2 // 1)) ^ 2 * norm2 v <= speed2 m P v) /\
  (forall v, speed2 m P v <= (1 / value (Over (1 // 1) (2 // 1))) ^ 2 * norm2 v).
Proof.
  intros m P hm hP.
  destruct (check_claim_sound _ _ _ _ _ checked m P hm hP) as [reached [regular met]].
  rewrite Forall_forall in met. split; [exact reached |]. split; [exact regular |].
  split; [exact (met (PsiMax (2 // 1)) (or_introl eq_refl)) |]. exact (met (PsiMin (Over (1 // 1) (2 // 1))) (or_intror (or_introl eq_refl))).
Qed.
