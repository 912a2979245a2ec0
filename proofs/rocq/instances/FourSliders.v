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
    (Tolerances (exactly ((-124) // 1)) (exactly ((-124) // 1)) (Within ((-1) // 10) (1 // 10)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3329 // 10) (3331 // 10)) false).

Definition leg_2 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (124 // 1)) (exactly ((-124) // 1)) (Within ((-1) // 10) (1 // 10)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3329 // 10) (3331 // 10)) false).

Definition leg_3 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly (124 // 1)) (exactly (124 // 1)) (Within ((-1) // 10) (1 // 10)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3329 // 10) (3331 // 10)) false).

Definition leg_4 : drive :=
  SliderLeg (Slider
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)))
    (Tolerances (exactly ((-124) // 1)) (exactly (124 // 1)) (Within ((-1) // 10) (1 // 10)))
    (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))
    (Within (3329 // 10) (3331 // 10)) false).

Definition the_workspace : region :=
  Box (Tolerances (Within ((-60) // 1) (60 // 1)) (Within ((-60) // 1) (60 // 1)) (Within (0 // 1) (200 // 1))).

Definition the_claim : claim :=
  MakeClaim [leg_1; leg_2; leg_3; leg_4] the_workspace [(PsiMax (Over (6 // 1) (5 // 1))); (PsiMin (Over (9 // 1) (20 // 1))); (JointMin 0 (200 // 1))].

(** The proof: a bisection tree, and what shows the requirements on its boxes. *)
Definition certificate : tree :=
  (Split [(2, ByTest)]%nat 1
    (Split [] 0
      (Split [] 1
        (Leaf [(0, ByLower 14 [[(9311); (9046); (-13477)]; [(-12484); (11238); (-12835)]; [(-16555); (-16802); (-10900)]; [(12717); (-13930); (-12328)]]%Z); (1, ByDivided)]%nat)
        (Leaf [(0, ByLower 14 [[(10262); (10525); (-13068)]; [(-13534); (12786); (-12169)]; [(-14828); (-14580); (-11530)]; [(11352); (-12117); (-12679)]]%Z); (1, ByTest)]%nat))
      (Split [] 1
        (Leaf [(0, ByLower 14 [[(12484); (11238); (-12835)]; [(-9311); (9046); (-13477)]; [(-12717); (-13930); (-12328)]; [(16555); (-16802); (-10900)]]%Z); (1, ByDivided)]%nat)
        (Leaf [(0, ByLower 14 [[(13534); (12786); (-12169)]; [(-10262); (10525); (-13068)]; [(-11352); (-12117); (-12679)]; [(14828); (-14580); (-11530)]]%Z); (1, ByTest)]%nat)))
    (Split [] 0
      (Split [] 1
        (Leaf [(0, ByLower 14 [[(11352); (12117); (-12679)]; [(-14828); (14580); (-11530)]; [(-13534); (-12786); (-12169)]; [(10262); (-10525); (-13068)]]%Z); (1, ByTest)]%nat)
        (Leaf [(0, ByLower 14 [[(12717); (13930); (-12328)]; [(-16555); (16802); (-10900)]; [(-12484); (-11238); (-12835)]; [(9311); (-9046); (-13477)]]%Z); (1, ByDivided)]%nat))
      (Split [] 1
        (Leaf [(0, ByLower 14 [[(14828); (14580); (-11530)]; [(-11352); (12117); (-12679)]; [(-10262); (-10525); (-13068)]; [(13534); (-12786); (-12169)]]%Z); (1, ByTest)]%nat)
        (Leaf [(0, ByLower 14 [[(16555); (16802); (-10900)]; [(-12717); (13930); (-12328)]; [(-9311); (-9046); (-13477)]; [(12484); (-11238); (-12835)]]%Z); (1, ByDivided)]%nat)))).

Lemma checked : check_claim 52 the_claim (9) [(0); (0); (0); (0)]%Z certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall m P, is_machine the_claim m -> in_region the_workspace P ->
  Forall (reaches P) m /\
  (forall v, v <> vzero -> 0 < speed2 m P v) /\
  (forall v, (1 / value (Over (6 // 1) (5 // 1))) ^ 2 * norm2 v <= speed2 m P v) /\
  (forall v, speed2 m P v <= (1 / value (Over (9 // 1) (20 // 1))) ^ 2 * norm2 v) /\
  (exists l, nth_error m 0 = Some l /\ value (200 // 1) <= joint l P).
Proof.
  intros m P hm hP.
  destruct (check_claim_sound _ _ _ _ _ checked m P hm hP) as [reached [regular met]].
  rewrite Forall_forall in met. split; [exact reached |]. split; [exact regular |].
  split; [exact (met (PsiMax (Over (6 // 1) (5 // 1))) (or_introl eq_refl)) |]. split; [exact (met (PsiMin (Over (9 // 1) (20 // 1))) (or_intror (or_introl eq_refl))) |]. exact (met (JointMin 0 (200 // 1)) (or_intror (or_intror (or_introl eq_refl)))).
Qed.
