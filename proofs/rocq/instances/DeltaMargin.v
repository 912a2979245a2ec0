(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_legs : list written_leg := [
  Slider_ (Triple 0 0 1) (Triple 0 174.75 0) (Triple 0 0 0) 333 false;
  Slider_ (Triple 0 0 1) (Triple (-174.75*sqrt(3)/2) (-87.375) 0) (Triple 0 0 0) 333 false;
  Slider_ (Triple 0 0 1) (Triple (174.75*sqrt(3)/2) (-87.375) 0) (Triple 0 0 0) 333 false].
Definition the_workspace : written_region := Cylinder_ 0 0 80 0 100.
Definition the_bodies : list written_body := [].
Definition the_requirements : list written_requirement := [
  Require_ Parallel_ None None (AtLeast_ 0.6)].
Definition the_claim : claim := claim_of the_legs the_workspace the_bodies the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [(0, Multiplied "rank" [[0; -1; -1]; [1; 1; -1]; [-1; 1; -1]]%Z 1)] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "negative")] None None []%Z;
  Node [(1, Plain "negative")] None None []%Z].
Definition the_certificate : certificate := Certificate (Machine_ the_legs the_workspace the_bodies the_requirements) the_proof "orthocert" "0.1.0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  holds the_claim /\ exists m P, is_about the_claim m P.
Proof. exact (accept_sound the_certificate accepted). Qed.
