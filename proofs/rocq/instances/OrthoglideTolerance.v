(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_legs : list written_leg := [
  Slider_ (Triple 1 0 0) (Triple 0 0 0) (Triple 0 0 0) (Between 311.3 311.7) true;
  Slider_ (Triple 0 1 0) (Triple 0 0 0) (Triple 0 0 0) (Between 311.3 311.7) true;
  Slider_ (Triple 0 0 1) (Triple 0 0 0) (Triple 0 0 0) (Between 311.3 311.7) true].
Definition the_workspace : written_region := Box_ (Triple (-73.2) (-73.2) (-73.2)) (Triple 126.8 126.8 126.8).
Definition the_bodies : list written_body := [].
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ (1/2));
  Require_ Transmission None None (AtMost_ 2)].
Definition the_claim : claim := claim_of the_legs the_workspace the_bodies the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 52 None [
  Node [(1, Plain "divided")] (Some 2) None []%Z;
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, Multiplied "lower_divided" [[8192; 0; 0]; [0; 8192; 0]; [0; 0; 8192]]%Z 14)] None None []%Z;
  Node [(0, Multiplied "lower" [[13158; -2258; -2258]; [2324; 13738; -197]; [2324; -197; 13738]]%Z 14)] None None []%Z;
  Node [(0, Multiplied "lower_divided" [[8140; 654; -646]; [-746; 8062; -1250]; [536; 1301; 8070]]%Z 14)] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower_divided" [[8140; -646; 654]; [536; 8070; 1301]; [-746; -1250; 8062]]%Z 14)] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, Multiplied "lower" [[14050; 2119; 2119]; [-2056; 13782; -153]; [-2056; -153; 13782]]%Z 14)] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Multiplied "lower" [[14092; -11; -554]; [-11; 14092; -554]; [565; 565; 14344]]%Z 14)] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[14449; -587; 591]; [548; 14699; 1206]; [-620; -1129; 14044]]%Z 14)] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, Multiplied "lower" [[15086; 1218; 1218]; [-1161; 14426; -47]; [-1161; -47; 14426]]%Z 14)] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Multiplied "lower" [[14948; -3; -317]; [-3; 14948; -317]; [322; 322; 15177]]%Z 14)] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[15208; -331; 330]; [321; 15442; 675]; [-339; -645; 14934]]%Z 14)] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, Multiplied "lower" [[15722; 686; 686]; [-662; 15201; -14]; [-662; -14; 15201]]%Z 14)] None None []%Z;
  Node [] (Some 2) None []%Z;
  Node [(0, Multiplied "lower" [[15599; -1; -176]; [-1; 15599; -176]; [178; 178; 15750]]%Z 14)] None None []%Z;
  Node [] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[15758; -181; 180]; [178; 15912; 365]; [-182; -356; 15594]]%Z 14)] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(0, Multiplied "lower" [[16080; 370; 370]; [-362; 15756; -4]; [-362; -4; 15756]]%Z 14)] None None []%Z;
  Node [(0, Multiplied "lower" [[16088; 0; 0]; [0; 16088; 0]; [0; 0; 16088]]%Z 14)] None None []%Z].
Definition the_certificate : certificate := Certificate (Machine_ the_legs the_workspace the_bodies the_requirements) the_proof "test" "0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  holds the_claim /\ exists m P, is_about the_claim m P.
Proof. exact (accept_sound the_certificate accepted). Qed.
