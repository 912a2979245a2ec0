(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.


(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, AtCorner Check.Q1)] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Plain "mirror")] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [] (Some 2) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, AtCorner Check.Q1)] None None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [(0, AtCorner Check.Q1)] None None []%Z;
  Node [(0, AtCorner Check.Q1)] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Plain "mirror")] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Plain "mirror")] None None []%Z;
  Node [(0, AtCorner Check.Q2)] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, AtCorner Check.Q2)] None None []%Z;
  Node [(0, AtCorner Check.Q2)] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [] (Some 2) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Plain "mirror")] None None []%Z;
  Node [(0, AtCorner Check.Q2)] None None []%Z;
  Node [(0, Plain "test")] None None []%Z;
  Node [(0, Plain "test")] None None []%Z].
Definition the_certificate : certificate := Certificate (Postulate_ None) the_proof "test" "0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  forall psi, (1 < psi)%R -> postulate_for psi.
Proof. exact (accept_sound the_certificate accepted). Qed.
