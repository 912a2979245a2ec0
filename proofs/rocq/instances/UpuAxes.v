(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_legs : list written_leg := [
  Strut_ (Triple 200 0 0) (Triple 50 0 0) (Some (Triple 0 1 0));
  Strut_ (Triple (-100) (100*sqrt(3)) 0) (Triple (-25) (25*sqrt(3)) 0) (Some (Triple (-sqrt(3)/2) (-0.5) 0));
  Strut_ (Triple (-100) (-100*sqrt(3)) 0) (Triple (-25) (-25*sqrt(3)) 0) (Some (Triple (sqrt(3)/2) (-0.5) 0))].
Definition the_workspace : written_region := Box_ (Triple (-30) (-30) 100) (Triple 30 30 130).
Definition the_bodies : list written_body := [].
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ 0.84);
  Require_ Transmission None None (AtMost_ 1.25);
  Require_ Constraint_ None None (AtLeast_ 0.8)].
Definition the_claim : claim := claim_of the_legs the_workspace the_bodies the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [(0, Multiplied "lower" [[-4; 0; 3]; [2; -3; 3]; [2; 3; 3]]%Z 2); (2, Multiplied "lower" [[-2; 0; 1]; [1; -2; 1]; [1; 2; 1]]%Z 1)] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "test")] None None []%Z;
  Node [(1, Plain "test")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "test")] None None []%Z;
  Node [(1, Plain "test")] None None []%Z].
Definition the_certificate : certificate := Certificate (Machine_ the_legs the_workspace the_bodies the_requirements) the_proof "orthocert" "0.1.0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  holds the_claim /\ exists m P, is_about the_claim m P.
Proof. exact (accept_sound the_certificate accepted). Qed.
