(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_motion : mobility := TranslatesInPlane.
Definition the_legs : list written_driven := [
  AnyArm_ [] [1; 0] [(-59); 0] [0; 0] 90 (Between 109.99 110.01) false;
  AnyArm_ [] [1; 0] [59; 0] [0; 0] 90 (Between 109.99 110.01) true].
Definition the_length : option expression := None.
Definition the_workspace : written_place := AnyBox_ [(-20); 110] [20; 150].
Definition the_orientations : option written_orientation := None.
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ 50);
  Require_ Transmission None None (AtMost_ 300);
  Require_ Speed_ None (Some (Given_ 100)) (AtMost_ 200)].
Definition the_claim : driven_claim := driven_claim_of the_motion the_legs the_length the_workspace the_orientations the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [(2, Plain "test"); (3, Plain "test")] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[1; 1]; [-1; 1]]%Z 1); (1, Plain "test")] None None []%Z;
  Node [(0, Multiplied "lower" [[1; 1]; [-1; 1]]%Z 1); (1, Plain "test")] None None []%Z].
Definition the_certificate : certificate := Certificate (Legs_ the_motion the_legs the_length the_workspace the_orientations the_requirements) the_proof "orthocert" "0.1.0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  driven_holds the_claim /\ exists m P Q, is_about_driven the_claim m P Q.
Proof. exact (accept_sound the_certificate accepted). Qed.
