(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the theorem
    `certified`, with the definitions of Postulate.v and Kinematics.v. *)

From Coq Require Import ZArith Reals List.
From Orthocert.kernel Require Import Check Faces.
From Orthocert Require Import Vec3 SingularValues Kinematics Postulate Claim.
Import ListNotations.
Local Open Scope R_scope.

Definition q1_low : tree :=
  (Split [] 0
    (Split [] 1
      (Leaf [(0, ByCorner Q1)]%nat)
      (Split [] 2
        (Leaf [(0, ByTest)]%nat)
        (Leaf [(0, ByTest)]%nat)))
    (Split [] 1
      (Leaf [(0, ByMirror)]%nat)
      (Split [] 2
        (Split [] 2
          (Leaf [(0, ByTest)]%nat)
          (Leaf [(0, ByTest)]%nat))
        (Split [] 2
          (Leaf [(0, ByTest)]%nat)
          (Leaf [(0, ByTest)]%nat))))).

Definition q1_high : tree :=
  (Split [] 2
    (Split [] 2
      (Split [] 0
        (Leaf [(0, ByCorner Q1)]%nat)
        (Leaf [(0, ByTest)]%nat))
      (Leaf [(0, ByCorner Q1)]%nat))
    (Leaf [(0, ByCorner Q1)]%nat)).

Definition q2_low : tree :=
  (Split [] 0
    (Split [] 2
      (Leaf [(0, ByTest)]%nat)
      (Split [] 2
        (Leaf [(0, ByTest)]%nat)
        (Leaf [(0, ByTest)]%nat)))
    (Split [] 1
      (Leaf [(0, ByMirror)]%nat)
      (Split [] 2
        (Split [] 0
          (Leaf [(0, ByTest)]%nat)
          (Split [] 1
            (Leaf [(0, ByMirror)]%nat)
            (Leaf [(0, ByCorner Q2)]%nat)))
        (Split [] 2
          (Leaf [(0, ByCorner Q2)]%nat)
          (Leaf [(0, ByCorner Q2)]%nat))))).

Definition q2_high : tree :=
  (Split [] 2
    (Split [] 2
      (Split [] 0
        (Leaf [(0, ByTest)]%nat)
        (Split [] 1
          (Leaf [(0, ByMirror)]%nat)
          (Leaf [(0, ByCorner Q2)]%nat)))
      (Leaf [(0, ByTest)]%nat))
    (Leaf [(0, ByTest)]%nat)).

Definition trees : list tree := [q1_low; q1_high; q2_low; q2_high].

Lemma checked : check_postulate 52 trees = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall L a e, 0 < L -> forall psi, 1 < psi -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof. exact (check_postulate_sound 52 trees checked). Qed.
