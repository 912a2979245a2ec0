(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_legs : list written_leg := [
  Slider_ (Triple 0 0 1) (Triple (-124) (-124) (Between (-0.1) 0.1)) (Triple 0 0 0) (Between 332.9 333.1) false;
  Slider_ (Triple 0 0 1) (Triple 124 (-124) (Between (-0.1) 0.1)) (Triple 0 0 0) (Between 332.9 333.1) false;
  Slider_ (Triple 0 0 1) (Triple 124 124 (Between (-0.1) 0.1)) (Triple 0 0 0) (Between 332.9 333.1) false;
  Slider_ (Triple 0 0 1) (Triple (-124) 124 (Between (-0.1) 0.1)) (Triple 0 0 0) (Between 332.9 333.1) false].
Definition the_workspace : written_region := Box_ (Triple (-60) (-60) 0) (Triple 60 60 200).
Definition the_bodies : list written_body := [].
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ (9/20));
  Require_ Transmission None None (AtMost_ (6/5));
  Require_ JointRange (Some 1%nat) None (AtLeast_ 200)].
Definition the_claim : claim := claim_of the_legs the_workspace the_bodies the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [(2, Plain "test")] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[9311; 9046; -13477]; [-12484; 11238; -12835]; [-16555; -16802; -10900]; [12717; -13930; -12328]]%Z 14); (1, Plain "divided")] None None []%Z;
  Node [(0, Multiplied "lower" [[10262; 10525; -13068]; [-13534; 12786; -12169]; [-14828; -14580; -11530]; [11352; -12117; -12679]]%Z 14); (1, Plain "test")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[12484; 11238; -12835]; [-9311; 9046; -13477]; [-12717; -13930; -12328]; [16555; -16802; -10900]]%Z 14); (1, Plain "divided")] None None []%Z;
  Node [(0, Multiplied "lower" [[13534; 12786; -12169]; [-10262; 10525; -13068]; [-11352; -12117; -12679]; [14828; -14580; -11530]]%Z 14); (1, Plain "test")] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[11352; 12117; -12679]; [-14828; 14580; -11530]; [-13534; -12786; -12169]; [10262; -10525; -13068]]%Z 14); (1, Plain "test")] None None []%Z;
  Node [(0, Multiplied "lower" [[12717; 13930; -12328]; [-16555; 16802; -10900]; [-12484; -11238; -12835]; [9311; -9046; -13477]]%Z 14); (1, Plain "divided")] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[14828; 14580; -11530]; [-11352; 12117; -12679]; [-10262; -10525; -13068]; [13534; -12786; -12169]]%Z 14); (1, Plain "test")] None None []%Z;
  Node [(0, Multiplied "lower" [[16555; 16802; -10900]; [-12717; 13930; -12328]; [-9311; -9046; -13477]; [12484; -11238; -12835]]%Z 14); (1, Plain "divided")] None None []%Z].
Definition the_certificate : certificate := Certificate (Machine_ the_legs the_workspace the_bodies the_requirements) the_proof "test" "0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  holds the_claim /\ exists m P, is_about the_claim m P.
Proof. exact (accept_sound the_certificate accepted). Qed.
