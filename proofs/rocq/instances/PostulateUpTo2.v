(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the theorem
    `certified`, with the definitions of Postulate.v and Kinematics.v. *)

From Coq Require Import ZArith Reals.
From Orthocert Require Import Vec3 SingularValues Kinematics Postulate Claim Checker CheckerPostulate.
Local Open Scope R_scope.

Definition q1_high : face_tree :=
  (FaceSplit AlongX
    (FaceSplit AlongX
      (FaceSplit AlongY
        (FaceSplit AlongZ
          (FaceLeaf EdgeRule)
          (FaceLeaf BlowUp))
        (FaceSplit AlongZ
          (FaceLeaf Mirror)
          (FaceSplit AlongX
            (FaceSplit AlongX
              (FaceLeaf BlowUp)
              (FaceLeaf BlowUp))
            (FaceLeaf BlowUp))))
      (FaceLeaf EdgeRule))
    (FaceLeaf EdgeRule)).

Definition q2_high : face_tree :=
  (FaceSplit AlongX
    (FaceSplit AlongX
      (FaceSplit AlongX
        (FaceSplit AlongZ
          (FaceSplit AlongY
            (FaceLeaf EdgeRule)
            (FaceLeaf Mirror))
          (FaceSplit AlongX
            (FaceLeaf BlowUp)
            (FaceLeaf BlowUp)))
        (FaceLeaf BlowUp))
      (FaceLeaf BlowUp))
    (FaceLeaf BlowUp)).

Definition q1 : halves := HighOnly q1_high.
Definition q2 : halves := HighOnly q2_high.

Lemma checked : check_postulate_up_to 64 (2 // 1) q1 q2 = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Lemma greatest_psi : value (2 // 1) = 2.
Proof. cbn [value]. unfold Rdiv. rewrite ?Rinv_1, ?Rmult_1_r. reflexivity. Qed.

Theorem certified : forall L a e, 0 < L -> forall psi, 1 < psi <= 2 -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros L a e hL psi h. apply (check_postulate_up_to_sound 64 (2 // 1) q1 q2 checked); [exact hL |].
  rewrite greatest_psi. exact h.
Qed.

Corollary at_greatest : forall L a e, 0 < L -> forall P, in_cube L 2 P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / 2) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= 2 ^ 2 * norm2 v.
Proof.
  intros L a e hL. apply (certified L a e hL 2). split; [| apply Rle_refl].
  rewrite <- greatest_psi. exact (check_postulate_greatest 64 (2 // 1) q1 q2 checked).
Qed.
