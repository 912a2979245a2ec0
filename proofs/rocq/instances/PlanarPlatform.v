(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_motion : motion := InPlane.
Definition the_struts : list (list quantity * list quantity) := [
  ([0; 400], [(50*sqrt(3)); 50]);
  ([(-200*sqrt(3)); (-200)], [(-50*sqrt(3)); 50]);
  ([(200*sqrt(3)); (-200)], [0; (-100)])].
Definition the_length : expression := 100.
Definition the_workspace : written_place := AnyBox_ [(-50); (-50)] [50; 50].
Definition the_orientations : written_orientation := Range_ (-20) 20.
Definition the_bodies : list written_body := [].
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ 0.5);
  Require_ Transmission None None (AtMost_ 1.1);
  Require_ JointRange None None (AtLeast_ 250);
  Require_ JointRange None None (AtMost_ 480)].
Definition the_claim : turning_claim := turning_claim_of the_motion the_struts the_length the_workspace the_orientations the_bodies the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [(0, AtControls_ (Multiplied "lower" [[0; -1; -1]; [1; 1; -1]; [-1; 0; -1]]%Z 0)); (1, AtControls_ (Plain "test")); (2, AtControls_ (Plain "test")); (3, AtControls_ (Plain "test")); (4, AtControls_ (Plain "test")); (5, AtControls_ (Plain "test")); (6, AtControls_ (Plain "test")); (7, AtControls_ (Plain "test"))] None None []%Z].
Definition the_certificate : certificate := Certificate (Turning_ the_motion the_struts the_length the_workspace the_orientations the_bodies the_requirements) the_proof "orthocert" "0.1.0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  turning_holds the_claim /\ exists m P Q, is_about_struts the_claim m P Q.
Proof. exact (accept_sound the_certificate accepted). Qed.
