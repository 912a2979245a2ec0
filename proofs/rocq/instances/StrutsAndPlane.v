(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_legs : list written_leg := [
  Strut_ (Triple (-150*sqrt(3)) (-150) (Between (-1/10) (1/10))) (Triple 0 0 10) None;
  Strut_ (Triple (150*sqrt(3)) (-150) 0) (Triple 0 0 10) None;
  Strut_ (Triple 0 300 0) (Triple 0 0 10) None;
  Planar_ (Triple 1 2 (Between 1.99 2.01))].
Definition the_workspace : written_region := Box_ (Triple (-40) (-40) 180) (Triple 40 40 240).
Definition the_bodies : list written_body := [].
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ (2/3));
  Require_ Transmission None None (AtMost_ (23/20));
  Require_ JointRange (Some 4%nat) None (AtMost_ 250)].
Definition the_claim : claim := claim_of the_legs the_workspace the_bodies the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [(0, Multiplied "lower" [[12124; 4523; 8014]; [-14680; 6374; 9771]; [324; -15361; 11936]; [3397; 6794; 6592]]%Z 14); (2, Plain "test")] (Some 1) None []%Z;
  Node [(1, Plain "test")] None None []%Z;
  Node [(1, Plain "test")] None None []%Z].
Definition the_certificate : certificate := Certificate (Machine_ the_legs the_workspace the_bodies the_requirements) the_proof "test" "0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  holds the_claim /\ exists m P, is_about the_claim m P.
Proof. exact (accept_sound the_certificate accepted). Qed.
