(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_legs : list written_leg := [
  Slider_ (Triple 1 0 0) (Triple 0 0 0) (Triple 0 0 0) 310 true;
  Slider_ (Triple 0 1 0) (Triple 0 0 0) (Triple 0 0 0) 310 true;
  Slider_ (Triple 0 0 1) (Triple 0 0 0) (Triple 0 0 0) 310 true].
Definition the_least : triple expression := (Triple 107 107 107).
Definition the_greatest : triple expression := (Triple 112 112 112).
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtMost_ 1.5)].
Definition the_side : expression := 40.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 32 None [
  Node [] (Some 0) None []%Z;
  Node [] None (Some (Obligation 0 [[10; -9; 1]]%Z)) [8; 8; 8]%Z;
  Node [] None (Some (Obligation 0 [[10; -9; 1]]%Z)) [8; 8; 8]%Z].
Definition the_certificate : certificate := Certificate (NoCube_ the_legs the_least the_greatest the_requirements the_side) the_proof "orthocert" "0.1.0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  let c := claim_of the_legs (Box_ the_least the_greatest) [] the_requirements in
  has_no_cube c (denoted the_side) /\ exists m C, is_about c m C.
Proof. exact (accept_sound the_certificate accepted). Qed.
