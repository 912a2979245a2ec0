(** Written by `orthocert export rocq`. What has to be read is the theorem at the end and the claim that it is about,
    which have the meaning that kernel/Certificate.v gives them; the evidence is not trusted, nor is the writer. *)

From Orthocert.kernel Require Import Notations.
Local Open Scope string_scope.
Local Open Scope written_scope.

Definition the_coordinates : list string := ["x"; "y"].
Definition the_parameters : list (string * quantity) := [
  ("a", 59);
  ("l", (Between 109.99 110.01));
  ("r", 90)].
Definition the_definitions : list (string * term string) := [
  ("u", (Name "x"+Name "a"));
  ("v", (Name "x"-Name "a"));
  ("n", (Name "u"^2+Name "y"^2));
  ("m", (Name "v"^2+Name "y"^2));
  ("p", ((1+(Name "r"^2-Name "l"^2)/Name "n")/2));
  ("q", (sqrt(Name "r"^2/Name "n"-Name "p"^2)));
  ("s", ((1+(Name "r"^2-Name "l"^2)/Name "m")/2));
  ("t", (sqrt(Name "r"^2/Name "m"-Name "s"^2)));
  ("e", (Name "p"*Name "u"-Name "q"*Name "y"));
  ("f", (Name "p"*Name "y"+Name "q"*Name "u"));
  ("g", (Name "u"-Name "e"));
  ("h", (Name "y"-Name "f"));
  ("i", (Name "s"*Name "v"+Name "t"*Name "y"));
  ("j", (Name "s"*Name "y"-Name "t"*Name "v"));
  ("k", (Name "v"-Name "i"));
  ("w", (Name "y"-Name "j"))].
Definition the_joints : list written_form := [
  Row_ [(Name "g"/(Name "h"*Name "e"-Name "g"*Name "f")); (Name "h"/(Name "h"*Name "e"-Name "g"*Name "f"))];
  Row_ [(Name "k"/(Name "w"*Name "i"-Name "k"*Name "j")); (Name "w"/(Name "w"*Name "i"-Name "k"*Name "j"))]].
Definition the_least : list expression := [(-20); 110].
Definition the_greatest : list expression := [20; 150].
Definition the_requirements : list written_requirement := [
  Require_ Transmission None None (AtLeast_ 50);
  Require_ Transmission None None (AtMost_ 300)].
Definition the_claim : written_claim := written_claim_of the_coordinates the_parameters the_definitions the_joints the_least the_greatest the_requirements.

(** The evidence. *)
Local Open Scope nat_scope.
Definition the_proof : proof := Nodes 46 None [
  Node [] (Some 1) None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "test")] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[-1; -1]; [-1; 1]]%Z 9)] None None []%Z;
  Node [(0, Multiplied "lower" [[-1; -1]; [-1; 1]]%Z 9)] None None []%Z;
  Node [(1, Plain "test")] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[-1; -1]; [-1; 1]]%Z 9)] None None []%Z;
  Node [(0, Multiplied "lower" [[-1; -1]; [-1; 1]]%Z 9)] None None []%Z;
  Node [] (Some 0) None []%Z;
  Node [(1, Plain "test")] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[-1; -1]; [-1; 1]]%Z 9)] None None []%Z;
  Node [(0, Multiplied "lower" [[-1; -1]; [-1; 1]]%Z 9)] None None []%Z;
  Node [(1, Plain "test")] (Some 1) None []%Z;
  Node [(0, Multiplied "lower" [[-1; -1]; [-1; 1]]%Z 9)] None None []%Z;
  Node [(0, Multiplied "lower" [[-1; -1]; [-1; 1]]%Z 9)] None None []%Z].
Definition the_certificate : certificate := Certificate (Formulas_ the_coordinates the_parameters the_definitions the_joints the_least the_greatest the_requirements) the_proof "orthocert" "0.1.0".

Lemma accepted : accept the_certificate = true.
Proof. vm_cast_no_check (eq_refl true). Qed.

Theorem certified :
  written_holds the_claim /\ exists theta x, is_about_written the_claim theta x.
Proof. exact (accept_sound the_certificate accepted). Qed.
