(** The verified checker as a program: [verify] and what builds its arguments.

    [Z], [N] and [positive] become integers of any size, zarith's natively and
    BigInt in JavaScript; strings and their comparison become the machine's.  These
    realizers are trusted; ExtrOcamlZBigInt and ExtrOcamlNativeString are Coq's own,
    the others are here, with what they have to be. *)
From Coq Require Import Extraction ExtrOcamlBasic ExtrOcamlZBigInt ExtrOcamlNativeString ZArith.
From Orthocert.kernel Require Import Certificate Paving Own PavingText.

Extract Constant Z.ltb => "Big_int_Z.lt_big_int".
Extract Constant Z.leb => "Big_int_Z.le_big_int".
(* The floor of a root; 0 below 0. *)
Extract Constant Z.sqrt =>
  "(fun x -> if Big_int_Z.sign_big_int x <= 0 then Big_int_Z.zero_big_int else Big_int_Z.sqrt_big_int x)".
(* 0 for negative exponents. *)
Extract Constant Z.pow =>
  "(fun x y -> if Big_int_Z.sign_big_int y < 0 then Big_int_Z.zero_big_int
     else Big_int_Z.power_big_int_positive_int x (Big_int_Z.int_of_big_int y))".
(* Floors, also of negative numbers; the other way for negative places. *)
Extract Constant Z.shiftl =>
  "(fun x y -> let n = Big_int_Z.int_of_big_int y in
     if n >= 0 then Big_int_Z.shift_left_big_int x n else Big_int_Z.shift_right_big_int x (- n))".
Extract Constant Z.shiftr =>
  "(fun x y -> let n = Big_int_Z.int_of_big_int y in
     if n >= 0 then Big_int_Z.shift_right_big_int x n else Big_int_Z.shift_left_big_int x (- n))".

Definition of_positive (p : positive) : Z := Zpos p.
Definition of_natural (n : N) : Z := Z.of_N n.

Extraction "verified.ml" verify open_paving start_paving read_node close_paving own Z.add Z.mul Z.opp Z.to_pos Z.to_N of_positive of_natural.
