(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the theorem
    `certified`, with the definitions of Postulate.v and Kinematics.v. *)

From Coq Require Import ZArith Reals.
From Orthocert Require Import Vec3 SingularValues Kinematics Postulate Claim Checker CheckerPostulate.
Local Open Scope R_scope.

Definition q1_low : face_tree :=
  (FaceSplit AlongX
    (FaceSplit AlongY
      (FaceSplit AlongZ
        (FaceLeaf EdgeRule)
        (FaceLeaf BlowUp))
      (FaceSplit AlongZ
        (FaceLeaf Mirror)
        (FaceSplit AlongX
          (FaceLeaf BlowUp)
          (FaceLeaf BlowUp))))
    (FaceSplit AlongY
      (FaceSplit AlongZ
        (FaceLeaf EdgeRule)
        (FaceLeaf BlowUp))
      (FaceSplit AlongX
        (FaceLeaf BlowUp)
        (FaceLeaf BlowUp)))).

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

Definition q2_low : face_tree :=
  (FaceSplit AlongX
    (FaceSplit AlongZ
      (FaceSplit AlongY
        (FaceSplit AlongZ
          (FaceSplit AlongY
            (FaceLeaf EdgeRule)
            (FaceLeaf Mirror))
          (FaceLeaf BlowUp))
        (FaceLeaf Mirror))
      (FaceSplit AlongX
        (FaceLeaf BlowUp)
        (FaceLeaf BlowUp)))
    (FaceSplit AlongZ
      (FaceSplit AlongY
        (FaceSplit AlongX
          (FaceLeaf EdgeRule)
          (FaceLeaf EdgeRule))
        (FaceLeaf Mirror))
      (FaceSplit AlongX
        (FaceLeaf BlowUp)
        (FaceLeaf BlowUp)))).

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

Lemma checked : check_postulate 64 q1_low q1_high q2_low q2_high = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified : forall L a e, 0 < L -> forall psi, 1 < psi -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof. exact (check_postulate_sound 64 q1_low q1_high q2_low q2_high checked). Qed.
