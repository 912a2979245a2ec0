(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_offset : expression := 0.
Definition the_side : expression := 200.
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ 0.5);
  Require_ Transmission None None (AtMost_ 2)].

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [(1, Plain "cube")] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, AtCorner Check.Q1)] None None []%Z;
  Node [(0, Multiplied "lower_divided" [[1; 0; 0]; [0; 1; 0]; [0; 0; 1]]%Z 1)] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower_divided" [[1; 0; 0]; [0; 1; 0]; [0; 0; 1]]%Z 1)] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Multiplied "lower" [[1; 0; 0]; [0; 1; 0]; [0; 0; 1]]%Z 0)] None None []%Z;
  Node [(0, AtCorner Check.Q2)] None None []%Z].
Definition the_certificate : certificate := Certificate (Closed_ the_offset the_side the_requirements) the_proof "orthocert" "0.1.0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  means the_certificate.
Proof. exact (accept_sound the_certificate accepted). Qed.
