(** * What the checker refuses of single quantities

    An Orthoglide with legs of 310 mm within 0.1 mm on a small cube: each quantity
    is shown on one leaf, and not where the bound is beyond what is so, by other
    evidence, or of another leg. *)

From Coq Require Import ZArith NArith Reals List.
From Orthocert Require Import Claim.
From Orthocert.kernel Require Import Formula Tolerances Statement Check Problem.
Import ListNotations.

Definition point (x y z : Z) : tolerances := Tolerances (exactly (x // 1)) (exactly (y // 1)) (exactly (z // 1)).
Definition along (x y z : Z) : drive := SliderLeg (Slider (point x y z) (point 0 0 0) (point 0 0 0) (Within (3099 // 10) (3101 // 10)) true).
Definition side : tolerance := Within (-20 // 1) (30 // 1).
Definition claim_of (ls : list drive) (rs : list requirement) : claim := MakeClaim ls (Box (Tolerances side side side)) (NotSingular :: rs).
Definition sliders : list drive := [along 1 0 0; along 0 1 0; along 0 0 1].
(** The first test by this evidence, and those that follow by these. *)
Definition leaf (es : list evidence) : tree :=
  Leaf ((0, ByRank 0 [[1; 0; 0]; [0; 1; 0]; [0; 0; 1]]%Z) :: combine (seq 1 (List.length es)) es)%nat.
Local Notation accepts ls rs es := (check_claim 32 (claim_of ls rs) 9 [0; 0; 0]%Z (leaf es)).

Module Lines.
Definition at_ (x y z : Z) : position := Position (x // 1) (y // 1) (z // 1).
Example apart : accepts sliders [Beside 0 (at_ 0 40 0) (at_ 0 (-40) 0) (79 // 1)] [ByTest] = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example farther : accepts sliders [Beside 0 (at_ 0 40 0) (at_ 0 (-40) 0) (80 // 1)] [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** One behind the other, along the leg. *)
Example along_the_leg : accepts sliders [Beside 0 (at_ 40 0 0) (at_ (-40) 0 0) (20 // 1)] [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example on_each_other : accepts sliders [Beside 0 (at_ 0 40 0) (at_ 0 40 0) (1 // 1)] [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_the_other_sign : accepts sliders [Beside 0 (at_ 0 40 0) (at_ 0 (-40) 0) (79 // 1)] [ByNegative] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_such_leg : accepts sliders [Beside 3 (at_ 0 40 0) (at_ 0 (-40) 0) (79 // 1)] [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_a_plane : accepts [along 1 0 0; along 0 1 0; PlanarLeg (point 0 0 1)] [Beside 2 (at_ 0 40 0) (at_ 0 (-40) 0) (1 // 1)] [ByTest] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
(** A direction that may be zero, or a length that may be negative, is no machine. *)
Example no_direction : accepts [along 1 0 0; along 0 1 0; along 0 0 1; PlanarLeg (Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (0 // 1)))]
  [Beside 0 (at_ 0 40 0) (at_ 0 (-40) 0) (79 // 1)] [ByTest] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_length : accepts [along 1 0 0; along 0 1 0; SliderLeg (Slider (point 0 0 1) (point 0 0 0) (point 0 0 0) (exactly (-310 // 1)) true)]
  [Beside 0 (at_ 0 40 0) (at_ 0 (-40) 0) (79 // 1)] [ByTest] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
End Lines.

Module Accelerations.
Local Notation within_ leg a v b := [JointAcceleration leg (a // 1) (v // 1) (b // 1)].
Example certified : accepts sliders (within_ 0 9000 1200 14000) [ByTest] = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example less : accepts sliders (within_ 0 9000 1200 13800) [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_more_than_the_tool : accepts sliders (within_ 0 9000 0 9000) [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example faster : accepts sliders (within_ 0 9000 2000 15500) [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example negative_acceleration : accepts sliders (within_ 0 (-9000) 1200 15500) [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example negative_bound : accepts sliders (within_ 0 0 1 (-15500)) [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_such_leg : accepts sliders (within_ 3 1 1 15500) [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_a_plane : accepts [along 1 0 0; along 0 1 0; PlanarLeg (point 0 0 1)] (within_ 2 1 1 15500) [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End Accelerations.

Module Forces.
Definition Y (n : Z) : evidence := ByLower 3 [[n; 0; 0]; [0; n; 0]; [0; 0; n]]%Z.
Local Notation within_ leg tool b := [JointForce leg (tool // 1) (b // 1)].
Example certified : accepts sliders (within_ 0 56 85) [Y 5] = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example less : accepts sliders (within_ 0 56 55) [Y 5] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example greater_force : accepts sliders (within_ 0 90 85) [Y 5] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_multiplier : accepts sliders (within_ 0 56 85) [Y 0] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_the_other_sign : accepts sliders (within_ 0 56 85) [Y (-5)] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example by_a_sign : accepts sliders (within_ 0 56 85) [ByTest] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_such_leg : accepts sliders (within_ 3 56 85) [Y 5] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example negative_bound : accepts sliders (within_ 0 56 (-85)) [Y 5] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** Where there are more joints than coordinates, no force is determined. *)
Example four_joints : check_claim 32 (claim_of (sliders ++ [PlanarLeg (point 0 0 1)]) (within_ 0 56 1000)) 9 [0; 0; 0; 0]%Z
  (Leaf [(0, ByRank 0 [[1; 0; 0]; [0; 1; 0]; [0; 0; 1]; [0; 0; 0]]%Z); (1, ByLower 3 [[5; 0; 0]; [0; 5; 0]; [0; 0; 5]; [0; 0; 1]]%Z)]%nat) = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
End Forces.

(** Of two points: one matrix for all cells. *)
Module Positions.
Local Notation accepts_by Y t := (check_claim_by 32 (3%N, Y) (claim_of sliders [OneToOne]) 9 [0; 0; 0]%Z t).
Definition Y (n : Z) : list (list Z) := [[n; 0; 0]; [0; n; 0]; [0; 0; n]]%Z.
Definition halved (e f : evidence) : tree := Split [(0, ByRank 0 (Y 1))]%nat 0 (Leaf [(1, e)])%nat (Leaf [(1, f)])%nat.
Example certified : accepts_by (Y 8) (halved ByChords ByChords) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example no_matrix : accepts_by (Y 0) (halved ByChords ByChords) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_the_other_sign : accepts_by (Y (-8)) (halved ByChords ByChords) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** A matrix of each cell shows that it has full rank there, and nothing of two points. *)
Example a_matrix_of_each : accepts_by (Y 8) (halved (ByRank 3 (Y 8)) (ByRank 3 (Y 8))) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example one_cell_left_out : accepts_by (Y 8) (Split [(0, ByRank 0 (Y 1))]%nat 0 (Leaf [(1, ByChords)])%nat (Leaf [])) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example without_a_tree's_own : accepts sliders [OneToOne] [ByChords] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End Positions.

(** Where joint errors and tolerances put the platform: legs within 0.1 mm, and errors of thousandths of a mm. *)
Module Errors.
Definition near (n kappa : Z) : evidence := ByAccuracy 3 [[n; 0; 0]; [0; n; 0]; [0; 0; n]]%Z kappa 0%N.
Local Notation within_ error b := [Accuracy (error // 1000) (b // 1000)].
Example certified : accepts sliders (within_ 10 250) [near 8 1] = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example less : accepts sliders (within_ 10 200) [near 8 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_larger_errors : accepts sliders (within_ 40 250) [near 8 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** So far that the rows differ by more than kappa. *)
Example too_far : accepts sliders (within_ 10 60000) [near 8 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example out_of_reach : accepts sliders (within_ 10 300000) [near 8 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example negative_error : accepts sliders (within_ (-10) 250) [near 8 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example negative_bound : accepts sliders (within_ 10 (-250)) [near 8 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_matrix : accepts sliders (within_ 10 250) [near 0 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_the_other_sign : accepts sliders (within_ 10 250) [near (-8) 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_kappa : accepts sliders (within_ 10 250) [near 8 0] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example a_greater_kappa : accepts sliders (within_ 10 250) [near 8 8] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example by_rank : accepts sliders (within_ 10 250) [ByRank 3 [[8; 0; 0]; [0; 8; 0]; [0; 0; 8]]%Z] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** It shows nothing else. *)
Example of_another_test : accepts sliders [PsiMin (1 // 10)] [near 8 1] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** A tolerance counts: without it, the same bound is far from what is so. *)
Example exact : accepts (map (fun d => match d with SliderLeg c => SliderLeg (Slider (direction c) (anchor c) (Claim.platform c) (exactly (310 // 1)) true) | d => d end) sliders)
  (within_ 10 50) [near 8 1] = true.
Proof. vm_cast_no_check (eq_refl true). Qed.
(** More joints than coordinates: joint coordinates near those commanded belong to no position. *)
Example four_joints : check_claim 32 (claim_of (sliders ++ [PlanarLeg (point 0 0 1)]) (within_ 10 250)) 9 [0; 0; 0; 0]%Z
  (Leaf [(0, ByRank 0 [[1; 0; 0]; [0; 1; 0]; [0; 0; 1]; [0; 0; 0]]%Z); (1, ByAccuracy 3 [[8; 0; 0]; [0; 8; 0]; [0; 0; 8]; [0; 0; 1]]%Z 1%Z 0%N)]%nat) = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
End Errors.

(** Tolerances of second order: of parameters in [-1, 1], from the one machine in the middle, where the product of two has no derivative. *)
Module OfSecondOrder.
Definition between (f : formula) (ends : list (nat * choice)) (curved : list nat) : bool :=
  let tape := compile [f] in let cell := [Fixed.integer 32 1] in let params := repeat (Fixed.Fixed (- 2 ^ 32) (2 ^ 32)) 2 in
  shows_on 32 tape [] [] [] params (fun _ => None) (evaluate 32 tape params cell) cell (AtLeast (place (formulas tape) f)) (ByTolerances ByTest ends curved []).
Definition middle : list (nat * choice) := [(0, FromMiddle); (1, FromMiddle)]%nat.
Definition product (n : Z) : formula := F (Add (F (Mul (F (Param 0)) (F (Param 1)))) (integer n)).
Definition less_square (n : Z) : formula := F (Sub (integer n) (F (Sqr (F (Param 0))))).
Example of_both : between (product 2) middle [0; 1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example not_so : between (product 1) middle [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_one : between (product 2) middle [1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example of_none : between (product 3) middle [] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example that_much : between (product 4) middle [] = true. Proof. vm_cast_no_check (eq_refl true). Qed.
(** Half the square of a step is exact. *)
Example square : between (less_square 1) middle [0]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example more_than_square : between (less_square 0) middle [0]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example square_of_none : between (less_square 3) middle [] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example from_the_end : between (less_square 1) [(0, FromGreatest); (1, FromLeast)]%nat [0]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** Of no parameter that is apart, and of one twice. *)
Example of_another : between (product 9) (firstn 1 middle) [1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example twice : between (product 9) middle [0; 0]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End OfSecondOrder.

(** Tolerances looked at together: of parameters in [-1, 1], from the one machine at 0, and a row of one coordinate with D = 1. *)
Module LookedAtTogether.
Definition of_row (t : test) (by_ : evidence) (all : list (list Z)) (A : formula) (ends : list (nat * choice)) (curved : list nat) : bool :=
  let tape := compile [A; integer 1] in let cell := [Fixed.integer 32 1] in let params := repeat (Fixed.Fixed (- 2 ^ 32) (2 ^ 32)) 7 in
  shows_on 32 tape [([place (formulas tape) A], place (formulas tape) (integer 1))] [] [] params (fun _ => None) (evaluate 32 tape params cell) cell t
    (ByTolerances (ByTogether by_ 2 all) ends curved [[1%Z]]).
Definition centre (n : nat) : list (nat * choice) := map (fun j => (j, FromMiddle)) (seq 0 n).
Definition p : formula := F (Param 0).
Definition q : formula := F (Param 1).
Definition beyond := of_row (SigmaMin (Fixed.integer 32 0)) (ByLower 0 [[1%Z]]).
Definition below (n : Z) := of_row (SigmaMax (Fixed.integer 32 n)) ByTest.
(** 3 - p - q + p q is at least 2, and each by itself would leave 0. *)
Definition falling : formula := F (Add (F (Sub (F (Sub (integer 3) p)) q)) (F (Mul p q))).
Example certified : beyond [[9]]%Z falling (centre 2) [0; 1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example each_alone : beyond [[]] falling (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example too_little : beyond [[8]]%Z falling (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example too_much : beyond [[20]]%Z falling (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_one : beyond [[9]]%Z falling (centre 2) [0]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_none : beyond [[9]]%Z falling (centre 2) [] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example two_numbers : beyond [[9; 9]]%Z falling (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example two_rows : beyond [[9]; []]%Z falling (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example by_rank : of_row (SigmaMin (Fixed.integer 32 0)) (ByRank 0 [[1%Z]]) [[9]]%Z falling (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_other_rows : of_row (Least [([place (formulas (compile [falling; integer 1])) falling], place (formulas (compile [falling; integer 1])) (integer 1))] (Fixed.integer 32 0))
  (ByLower 0 [[1%Z]]) [[9]]%Z falling (centre 2) [0; 1]%nat = true.
Proof. vm_cast_no_check (eq_refl true). Qed.
(** The same with both turned round, with which the product stays; and with it turned round, of which 0 is left at an end. *)
Example turned_round : beyond [[9]]%Z (F (Add (F (Add (F (Add (integer 3) p)) q)) (F (Mul p q)))) (centre 2) [0; 1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example product_turned_round : beyond [[9]]%Z (F (Sub (F (Sub (F (Sub (integer 3) p)) q)) (F (Mul p q)))) (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** 2 + p + p^2 is less at -1/2 than at the ends. *)
Definition bent : formula := F (Add (F (Add (integer 2) p)) (F (Sqr p))).
Example in_between : beyond [[9]]%Z bent (centre 2) [0; 1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example of_the_ends_alone : beyond [[1]]%Z bent (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** From an end there is one step: nothing is looked at together, and R is taken off besides. *)
Example from_the_end : beyond [[9]]%Z falling [(0, FromLeast); (1, FromGreatest)]%nat [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example one_from_the_end : beyond [[9]]%Z (F (Sub (F (Sub (integer 4) p)) q)) [(0, FromMiddle); (1, FromLeast)]%nat [0; 1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
(** No more than six. *)
Definition sum (n : nat) : formula := fold_right (fun j e => F (Add e (F (Param j)))) (integer 9) (seq 0 n).
Example of_six : beyond [[49]]%Z (sum 6) (centre 6) (seq 0 6) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example of_seven : beyond [[57]]%Z (sum 7) (centre 7) (seq 0 7) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** With no change R alone is what has to be positive. *)
Example unchanged : beyond [[1]]%Z (integer 2) (centre 2) [0; 1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example unchanged_too_little : beyond [[0]]%Z (integer 2) (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example unchanged_too_much : beyond [[12]]%Z (integer 2) (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example unchanged_at_most : below 2 [[1; 0; 1]]%Z (integer 1) (centre 2) [0; 1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example unchanged_at_most_less : below 1 [[-1; 0; -1]]%Z (integer 1) (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** 1 + p + q - p q is between -2 and 2. *)
Definition rising : formula := F (Sub (F (Add (F (Add (integer 1) p)) q)) (F (Mul p q))).
Example at_most : below 6 [[3; 4; 22]]%Z rising (centre 2) [0; 1]%nat = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example at_most_alone : below 6 [[]] rising (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example at_most_less : below 5 [[3; 4; 22]]%Z rising (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_another_R : below 6 [[3; 0; 22]]%Z rising (centre 2) [0; 1]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** Either bound of a condition number, of 2 + p, with mu = m/4, and with m/4 + n p. *)
Definition bounded (c m : Z) (weights : list (list (nat * Z))) (lower upper : list (list Z)) (directions : list (list Z)) : bool :=
  let A := F (Add (integer 2) p) in
  let tape := compile [A; integer 1] in let cell := [Fixed.integer 32 1] in let params := repeat (Fixed.Fixed (- 2 ^ 32) (2 ^ 32)) 2 in
  let by_ all e directions := ByTolerances (ByTogether e 2 all) (centre 2) [0; 1]%nat directions in
  shows_step 32 tape [([place (formulas tape) A], place (formulas tape) (integer 1))] [] [] params (fun _ => None) (evaluate 32 tape params cell) cell (Conditioning (Fixed.integer 32 c))
    (ByBetween 2 [m; 0%Z] weights (by_ lower (ByLower 0 [[1%Z]]) directions) (by_ upper ByTest [[1%Z]])).
Example both_bounds : bounded 21 2 [] [[9]]%Z [[2; 0; 9]]%Z [[1]]%Z = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example no_upper_bound : bounded 18 2 [] [[9]]%Z [[2; 0; 9]]%Z [[1]]%Z = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_lower_bound : bounded 21 4 [] [[9]]%Z [[2; 0; 9]]%Z [[1]]%Z = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example with_weights : bounded 10 4 [[(0%nat, 2)]]%Z [[7]]%Z [[2; 4; 21]]%Z [[1]; [0]]%Z = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example across : bounded 10 4 [[(0%nat, 2)]]%Z [[7]]%Z [[2; 4; 21]]%Z [[1]; [1]]%Z = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example one_direction : bounded 10 4 [[(0%nat, 2)]]%Z [[7]]%Z [[2; 4; 21]]%Z [[1]]%Z = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example greater_weights : bounded 10 4 [[(0%nat, 4)]]%Z [[7]]%Z [[2; 4; 21]]%Z [[1]; [0]]%Z = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example weights_turned_round : bounded 10 4 [[(0%nat, -2)]]%Z [[7]]%Z [[2; 4; 21]]%Z [[1]; [0]]%Z = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example without_weights : bounded 10 4 [] [[7]]%Z [[2; 4; 21]]%Z [[1]]%Z = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End LookedAtTogether.
