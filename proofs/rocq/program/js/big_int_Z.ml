(* What the extracted code uses of zarith's Big_int_Z, over JavaScript's BigInt (bigint.js). *)
type big_int

external add_big_int : big_int -> big_int -> big_int = "oc_add"
external sub_big_int : big_int -> big_int -> big_int = "oc_sub"
external mult_big_int : big_int -> big_int -> big_int = "oc_mul"
external minus_big_int : big_int -> big_int = "oc_neg"
external abs_big_int : big_int -> big_int = "oc_abs"
external eq_big_int : big_int -> big_int -> bool = "oc_eq"
external le_big_int : big_int -> big_int -> bool = "oc_le"
external lt_big_int : big_int -> big_int -> bool = "oc_lt"
external compare_big_int : big_int -> big_int -> int = "oc_compare"
external sign_big_int : big_int -> int = "oc_sign"
external big_int_of_int : int -> big_int = "oc_of_int"
external int_of_big_int : big_int -> int = "oc_to_int"

(* Euclidean: no remainder is negative. *)
external div_big_int : big_int -> big_int -> big_int = "oc_ediv"
external mod_big_int : big_int -> big_int -> big_int = "oc_emod"
external shift_left_big_int : big_int -> int -> big_int = "oc_shl"
external shift_right_big_int : big_int -> int -> big_int = "oc_shr"
external sqrt_big_int : big_int -> big_int = "oc_sqrt"

let zero_big_int = big_int_of_int 0
let unit_big_int = big_int_of_int 1
let succ_big_int x = add_big_int x unit_big_int
let pred_big_int x = sub_big_int x unit_big_int
let add_int_big_int n x = add_big_int (big_int_of_int n) x
let mult_int_big_int n x = mult_big_int (big_int_of_int n) x
let quomod_big_int x y = (div_big_int x y, mod_big_int x y)
let min_big_int x y = if le_big_int x y then x else y
let max_big_int x y = if le_big_int x y then y else x

let power_big_int_positive_int x n =
  let rec go power x n =
    if n = 0 then power
    else go (if n land 1 = 1 then mult_big_int power x else power) (mult_big_int x x) (n lsr 1) in
  if n < 0 then invalid_arg "power" else go unit_big_int x n
