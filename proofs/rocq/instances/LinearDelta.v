(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_legs : list written_leg := [
  Slider_ (Triple 0 0 1) (Triple 0 174.75 0) (Triple 0 0 0) 333 false;
  Slider_ (Triple 0 0 1) (Triple (-139.8) (-104.85) 0) (Triple 0 0 0) 333 false;
  Slider_ (Triple 0 0 1) (Triple 139.8 (-104.85) 0) (Triple 0 0 0) 333 false].
Definition the_workspace : written_region := Box_ (Triple (-60) (-60) 0) (Triple 60 60 200).
Definition the_bodies : list written_body := [].
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ (1/2));
  Require_ Transmission None None (AtMost_ (8/5))].
Definition the_claim : claim := claim_of the_legs the_workspace the_bodies the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [] (Some 1) None []%Z;
  Node [(1, Plain "test")] (Some 0) None []%Z;
  Node [(0, Multiplied "lower" [[-1058; -17077; -10541]; [11239; 6307; -11347]; [-14301; 7169; -10179]]%Z 14)] None None []%Z;
  Node [(0, Multiplied "lower" [[1058; -17077; -10541]; [14301; 7169; -10179]; [-11239; 6307; -11347]]%Z 14)] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, Multiplied "lower" [[-1024; -13068; -11701]; [12150; 8732; -10815]; [-15572; 9800; -9582]]%Z 14); (1, Plain "divided")] None None []%Z;
  Node [(0, Multiplied "lower" [[1024; -13068; -11701]; [15572; 9800; -9582]; [-12150; 8732; -10815]]%Z 14); (1, Plain "divided")] None None []%Z].
Definition the_certificate : certificate := Certificate (Machine_ the_legs the_workspace the_bodies the_requirements) the_proof "test" "0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  holds the_claim /\ exists m P, is_about the_claim m P.
Proof. exact (accept_sound the_certificate accepted). Qed.
