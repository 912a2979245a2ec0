(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_parameters : parameters_ := [
  ("psi_max", (1.2, 4));
  ("side", (0.1, 1))].
Definition the_legs : list written_leg := [
  Slider_ (Triple 1 0 0) (Triple 0 0 0) (Triple 0 0 0) 1 true;
  Slider_ (Triple 0 1 0) (Triple 0 0 0) (Triple 0 0 0) 1 true;
  Slider_ (Triple 0 0 1) (Triple 0 0 0) (Triple 0 0 0) 1 true].
Definition the_workspace : written_region := Box_ (Triple (-Name (Called "side")*(sqrt(3)-1)/2) (-Name (Called "side")*(sqrt(3)-1)/2) (-Name (Called "side")*(sqrt(3)-1)/2)) (Triple (Name (Called "side")*(3-sqrt(3))/2) (Name (Called "side")*(3-sqrt(3))/2) (Name (Called "side")*(3-sqrt(3))/2)).
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ (1/Name (Called "psi_max")));
  Require_ Transmission None None (AtMost_ (Name (Called "psi_max")))].
Definition the_certified_share : expression := (1/32).
Definition the_refuted_share : expression := (1/64).

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Cells [
  Cut 0;
  Cut 1;
  Cut 0;
  Cut 1;
  Cut 0;
  Undecided;
  Proved 52 None [
  Node [(0, Multiplied "lower" [[1; 0; 0]; [0; 1; 0]; [0; 0; 1]]%Z 0); (1, Plain "test")] None None []%Z];
  Cut 0;
  Cut 1;
  Undecided;
  Disproved 64 [0.277363; 0.277363; 0.277363]%written []%written (Obligation 1 [[1; 1; 1]]%Z);
  Undecided;
  Undecided;
  Undecided;
  Undecided].
Definition the_certificate : certificate := Certificate (Atlas_ the_parameters the_legs the_workspace the_requirements the_certified_share the_refuted_share) the_proof "orthocert" "0.1.0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  means the_certificate.
Proof. exact (accept_sound the_certificate accepted). Qed.
