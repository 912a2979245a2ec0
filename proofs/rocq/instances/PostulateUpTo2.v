(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the theorem
    `certified`, with the definitions of Postulate.v and Kinematics.v. *)

From Coq Require Import ZArith Reals List.
From Orthocert.kernel Require Import Check Faces.
From Orthocert Require Import Vec3 SingularValues Kinematics Postulate Claim.
Import ListNotations.
Local Open Scope R_scope.

Definition q1_high : tree :=
  (Split [] 2
    (Split [] 2
      (Split [] 0
        (Leaf [(0, ByCorner Q1)]%nat)
        (Leaf [(0, ByTest)]%nat))
      (Leaf [(0, ByCorner Q1)]%nat))
    (Leaf [(0, ByCorner Q1)]%nat)).

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

Definition trees : list tree := [q1_high; q2_high].

Lemma checked : check_postulate_up_to 52 (2 // 1) trees = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Lemma greatest_psi : value (2 // 1) = 2.
Proof. cbn [value]. unfold Rdiv. rewrite ?Rinv_1, ?Rmult_1_r. reflexivity. Qed.

Theorem certified : forall L a e, 0 < L -> forall psi, 1 < psi <= 2 -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros L a e hL psi h. apply (check_postulate_up_to_sound 52 (2 // 1) trees checked); [exact hL |].
  rewrite greatest_psi. exact h.
Qed.

Corollary at_greatest : forall L a e, 0 < L -> forall P, in_cube L 2 P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / 2) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= 2 ^ 2 * norm2 v.
Proof.
  intros L a e hL. apply (certified L a e hL 2). split; [| apply Rle_refl].
  rewrite <- greatest_psi. exact (check_postulate_greatest 52 (2 // 1) trees checked).
Qed.
