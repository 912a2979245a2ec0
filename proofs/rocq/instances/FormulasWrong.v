(** * Wrong certificates of platforms that turn, and of mechanisms by formulas, are refused; so are misread texts *)

From Coq Require Import ZArith NArith List String Decimal.
From Orthocert Require Import Claim.
From Orthocert.kernel Require Import Statement Check Configuration Written Orientation Turning Pose.
From Orthocert.kernel Require Formula Control Certificate.
Import ListNotations.

(** The 3-RPR of certificates/planar-3-rpr.cert.json, with two of its requirements. *)
Module Planar.
Local Open Scope Z_scope.
Definition root3 (n : Z) : number := Times (n // 1) (Root (3 // 1)).
Definition vector (x y : number) : tolerances := Tolerances (exactly x) (exactly y) (exactly (0 // 1)).
Definition claim_of (d : demand) (length : number) : turning_claim :=
  MakeTurningClaim InPlane
    [(vector (0 // 1) (400 // 1), vector (root3 50) (50 // 1));
     (vector (root3 (-200)) (-200 // 1), vector (root3 (-50)) (50 // 1));
     (vector (root3 200) (-200 // 1), vector (0 // 1) (-100 // 1))]
    (100 // 1)
    (Box (Tolerances (Within (-50 // 1) (50 // 1)) (Within (-50 // 1) (50 // 1)) (exactly (0 // 1))))
    (TurnedBy (Within (-20 // 1) (20 // 1)))
    [d; LengthMax 0 length] false.
Definition claim (psi : number) : number -> turning_claim := claim_of (FactorMax psi).
Definition Y := [[0; -1; -1]; [1; 1; -1]; [-1; 0; -1]].
Definition by_lower (Y : list (list Z)) : nat * evidence := (0%nat, AtControls (ByLower 0%N Y)).
Definition by_test : nat * evidence := (1%nat, AtControls ByTest).
Definition accepts (c : turning_claim) (steps : list (nat * evidence)) : bool := check_turning 52 (0%N, []) 0 c 9 (Leaf steps).
Local Notation right := (claim (11 // 10) (480 // 1)).

Example as_it_is : accepts right [by_lower Y; by_test] = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example psi_tighter : accepts (claim (1 // 1) (480 // 1)) [by_lower Y; by_test] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example shorter : accepts (claim (11 // 10) (450 // 1)) [by_lower Y; by_test] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example another_Y : accepts right [by_lower [[0; -1; -1]; [1; 1; 1]; [-1; 0; -1]]; by_test] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example without_a_step : accepts right [by_lower Y] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example not_at_controls : accepts right [(0%nat, ByLower 0%N Y); by_test] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_the_other_test : accepts right [(0%nat, AtControls ByTest); by_test] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** Full rank, and nothing more. *)
Definition by_rank (Y : list (list Z)) : nat * evidence := (0%nat, AtControls (ByRank 0%N Y)).
Example rank : accepts (claim_of Nonsingular (480 // 1)) [by_rank Y; by_test] = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example rank_of_another_Y : accepts (claim_of Nonsingular (480 // 1)) [by_rank [[0; 1; 1]; [-1; -1; 1]; [1; 0; 1]]; by_test] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example rank_alone : accepts right [by_rank Y; by_test] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** No inequality of orientations in the plane. *)
Example turned : accepts right [by_lower Y; (1%nat, AtControls (Turned ByTest 0 0%N))] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example outside : accepts right [(0%nat, Outside)] = false. Proof. vm_cast_no_check (eq_refl false). Qed.

(** Joint speeds and forces, and stiffness. *)
Definition asks (d : demand) (e : evidence) : bool :=
  accepts (MakeTurningClaim InPlane (struts right) (100 // 1) (positions right) (Turning.turned right) [FactorMax (11 // 10); d] false) [by_lower Y; (1%nat, AtControls e)].
Definition no : evidence := ByLower 0%N [[0]].
(** The square root of 2 at the lever's right angle to the leg, of tools at 100. *)
Example speed : asks (SpeedMax 0 (100 // 1) (142 // 1)) no = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example speed_less : asks (SpeedMax 0 (100 // 1) (141 // 1)) no = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example speed_of_none : asks (SpeedMax 3 (100 // 1) (142 // 1)) no = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example tool_at_rest : asks (SpeedMax 0 (0 // 1) (142 // 1)) no = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example speed_by_a_sign : asks (SpeedMax 0 (100 // 1) (142 // 1)) ByTest = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example speed_by_three : asks (SpeedMax 0 (100 // 1) (142 // 1)) (ByLower 0%N Y) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** Less, where the leg leans towards the middle at every pose. *)
Definition near (b : Z) (y : Z) : bool :=
  let little := Within (-5 // 1) (5 // 1) in
  accepts (MakeTurningClaim InPlane (struts right) (100 // 1) (Box (Tolerances little little (exactly (0 // 1)))) (TurnedBy (Within (-2 // 1) (2 // 1)))
    [FactorMax (11 // 10); SpeedMax 0 (100 // 1) (b // 1)] false) [by_lower Y; (1%nat, AtControls (ByLower 7%N [[y]]))].
Example leaning : near 140 (-10) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example leaning_outwards : near 140 10 = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example leaning_less : near 139 (-10) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Definition Y2 := [[0; -2; -2]; [2; 2; -2]; [-2; 0; -2]].
Example stiff : asks (StiffnessMin [2 // 1; 2 // 1; 2 // 1] (1 // 1)) (ByLower 0%N Y2) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example stiff_of_two : asks (StiffnessMin [2 // 1; 2 // 1] (1 // 1)) (ByLower 0%N Y2) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example stiffer : asks (StiffnessMin [2 // 1; 2 // 1; 2 // 1] (3 // 1)) (ByLower 0%N Y2) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example joints_negative : asks (StiffnessMin [-2 // 1; -2 // 1; -2 // 1] (-1 // 1)) (ByLower 0%N Y2) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Definition Y8 := [[1; -5; -5]; [4; 4; -5]; [-5; 2; -5]].
Example force : asks (ForceMax 0 (100 // 1) (120 // 1)) (ByLower 3%N Y8) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example force_less : asks (ForceMax 0 (100 // 1) (60 // 1)) (ByLower 3%N Y8) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example force_by_another_Y : asks (ForceMax 0 (100 // 1) (120 // 1)) (ByLower 3%N [[1; -5; 5]; [4; 4; -5]; [-5; 2; -5]]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** Condition numbers, by a number of each control point; positions in a cylinder. *)
Definition Y3 := [[0; -8; -8]; [8; 8; -8]; [-8; 0; -8]].
Example conditioned : asks (Conditioned (3 // 1)) (ByConditioning 3%N Y3 [6; 0; 0; 0]) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example better_conditioned : asks (Conditioned (5 // 4)) (ByConditioning 3%N Y3 [6; 0; 0; 0]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_number : asks (Conditioned (3 // 1)) (ByConditioning 3%N Y3 [0; 0; 0; 0]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example too_great_somewhere : asks (Conditioned (3 // 1)) (ByConditioning 3%N Y3 [6; 0; 4; 0]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example one_too_few : asks (Conditioned (3 // 1)) (ByConditioning 3%N Y3 [6; 0; 0]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Definition round (radius : number) : bool :=
  accepts (MakeTurningClaim InPlane (struts right) (100 // 1) (Cylinder (0 // 1) (0 // 1) radius (exactly (0 // 1))) (Turning.turned right) [FactorMax (11 // 10)] false) [by_lower Y].
Example in_a_cylinder : round (50 // 1) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example in_a_wider_one : round (200 // 1) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example force_by_test : asks (ForceMax 0 (100 // 1) (120 // 1)) ByTest = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End Planar.

(** Where ends alone of positions will do: in the plane, coordinates 3 and 4 are the squares of 0 and 1. *)
Module Ends.
Import Formula Control.
Definition w : formula := F (Param 0).
Definition square (k : nat) : formula := F (Coord (3 + k)).
Definition times (a b : formula) : formula := F (Mul a b).
Definition minus (a b : formula) : formula := F (Sub a b).
Definition plus (a b : formula) : formula := F (Add a b).
(** How many coordinates have ends alone: of [n] struts with [a] in their rows and [d] for D, and a weight. *)
Definition ends (n : nat) (a d weight : formula) (g : option formula) : nat :=
  ends_of ([a; d; weight] ++ match g with Some g => [g] | None => [] end) 3 InPlane (repeat ([0%nat], 1%nat) n) 2
    (option_map (fun _ => 3%nat) g).
Definition x : formula := F (Coord 0).
Definition d : formula := plus (minus (times w (plus (square 0) (square 1))) x) (square 2).

Example as_it_is : ends 3 x d w (Some (minus w (square 2))) = 2%nat. Proof. reflexivity. Qed.
Example more_struts : ends 4 x d w None = 0%nat. Proof. reflexivity. Qed.
Example fewer_struts : ends 2 x d w None = 0%nat. Proof. reflexivity. Qed.
Example another_factor : ends 3 x (times (F (Param 1)) (square 0)) w None = 0%nat. Proof. reflexivity. Qed.
Example other_sign : ends 3 x (minus d (times w (square 1))) w None = 0%nat. Proof. reflexivity. Qed.
Example in_the_row : ends 3 (square 0) d w None = 0%nat. Proof. reflexivity. Qed.
Example in_the_weight : ends 3 x d (square 1) None = 0%nat. Proof. reflexivity. Qed.
Example in_the_inequality : ends 3 x d w (Some (minus w (square 1))) = 0%nat. Proof. reflexivity. Qed.

(** A middle node that is looked at, or not. *)
Definition sign (low middle high : Z) : tensor :=
  let at_ n := Constant (Some (Fixed.Fixed n n)) in Each (at_ low) (at_ middle) (at_ high).
Definition everywhere_positive (e : nat) (t : tensor) : bool := everywhere (@map_sample) e 1 sign_at (Sample _ [] t None).
Example at_ends : everywhere_positive 1 (sign 1 (-1) 1) = true. Proof. reflexivity. Qed.
Example at_all : everywhere_positive 0 (sign 1 (-1) 1) = false. Proof. reflexivity. Qed.
Example at_low : everywhere_positive 1 (sign (-1) 1 1) = false. Proof. reflexivity. Qed.
Example at_high : everywhere_positive 1 (sign 1 1 (-1)) = false. Proof. reflexivity. Qed.
End Ends.

(** A spherical platform on three struts, as in certificates/spherical-3-ups.cert.json, with tilt and torsion, or up to an angle. *)
Module Spherical.
Local Open Scope Z_scope.
Definition root3 (n : Z) : number := Times (n // 1) (Root (3 // 1)).
Definition vector (x y z : number) : tolerances := Tolerances (exactly x) (exactly y) (exactly z).
Definition claim (o : orientations) (psi : number) : turning_claim :=
  MakeTurningClaim AboutPoint
    [(vector (150 // 1) (0 // 1) (-150 // 1), vector (0 // 1) (100 // 1) (0 // 1));
     (vector (-75 // 1) (root3 75) (-150 // 1), vector (root3 (-50)) (-50 // 1) (0 // 1));
     (vector (-75 // 1) (root3 (-75)) (-150 // 1), vector (root3 50) (-50 // 1) (0 // 1))]
    (100 // 1) (Box (vector (0 // 1) (0 // 1) (0 // 1))) o [FactorMax psi; LengthMin 0 (181 // 1)] false.
Definition Y := [[14; 0; 10]; [-7; 12; 10]; [-7; -12; 10]].
Definition less (n : Z) : nat * evidence := (0%nat, AtControls (Turned (ByLower 5%N Y) n 1%N)).
Definition by_test : nat * evidence := (1%nat, AtControls ByTest).
Definition accepts (c : turning_claim) (t : tree) : bool := check_turning 52 (0%N, []) 0 c 8 t.
Definition tilt (a b : Z) : orientations := Tilted (a // 1) (b // 1).
Local Notation right := (claim (tilt 20 10) (2 // 1)).

Example as_it_is : accepts right (Leaf [less 3; by_test]) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example tilt_greater : accepts (claim (tilt 25 10) (2 // 1)) (Leaf [less 3; by_test]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example torsion_greater : accepts (claim (tilt 20 20) (2 // 1)) (Leaf [less 3; by_test]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example another_set : accepts (claim (TurnedUpTo (25 // 1)) (2 // 1)) (Leaf [less 3; by_test]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** Without the inequality, with its sign changed, and twice. *)
Example without : accepts right (Leaf [(0%nat, AtControls (ByLower 5%N Y)); by_test]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example other_sign : accepts right (Leaf [less (-3); by_test]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example twice : accepts right (Leaf [(0%nat, AtControls (Turned (Turned (ByLower 5%N Y) 3 1%N) 0 0%N)); by_test]) = false. Proof. vm_cast_no_check (eq_refl false). Qed.

(** Of the square about the disc of tilts, the eighth next to a corner has none of them, and the quarter has. *)
Definition upper (k : nat) (t : tree) : tree := Split [] k (Leaf []) t.
Definition corner (t : tree) : tree := Split [less 3; by_test] 0 (Leaf []) (upper 0 (upper 1 (upper 1 t))).
Example outside : accepts right (corner (upper 0 (upper 1 (Leaf [(0%nat, Outside)])))) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example not_outside : accepts right (corner (Leaf [(0%nat, Outside)])) = false. Proof. vm_cast_no_check (eq_refl false). Qed.

(** Coordinates of a witness: tangents of 5, 8 and 10 degrees are 0.0875, 0.1405 and 0.1763. *)
Definition is_in (o : orientations) (x y z : Z) : bool := is_orientation 64 o [(x // 10000); (y // 10000); (z // 10000)].
Example up_to_20 : is_in (TurnedUpTo (20 // 1)) 1000 (-1000) 1000 = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example not_to_20 : is_in (TurnedUpTo (20 // 1)) 1000 (-1000) 1100 = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example in_tilt : is_in (tilt 20 10) 1405 1067 (-874) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example beyond_tilt : is_in (tilt 20 10) 1405 1080 (-874) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example beyond_torsion : is_in (tilt 20 10) 0 0 (-876) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_turn : is_in (TurnedUpTo (0 // 1)) 0 0 0 = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example half_a_turn : is_in (TurnedUpTo (180 // 1)) 0 0 0 = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example negative_angle : is_in (TurnedUpTo (-1 // 1)) 0 0 0 = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End Spherical.

(** One joint whose rate is 1 + x^2 times that of x, for x from 1 to 2. *)
Module Formulas.
Local Open Scope string_scope.
Local Notation x := (Named "x").
Local Notation one := (Constant (1 // 1)).
Definition claim (definitions : list (string * written)) (entry : written) : written_claim :=
  MakeWrittenClaim (Mechanism ["x"] [] definitions [ByRow [entry]]) [Within (1 // 1) (2 // 1)] [Nonsingular] false.
Definition accepts (c : written_claim) : bool := certify_written 512 52 (0%N, []) 0 c (Leaf [(0%nat, ByLower 0%N [[1%Z]])]).
Local Notation rate := (Sum one (Raised x 2)).

Example as_it_is : accepts (claim [] rate) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example zero_rate : accepts (claim [] (Difference x x)) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
(** What is not used has to be defined, though a product with 0 is written as 0. *)
Example divisor_zero : accepts (claim [("y", Quotient one (Difference x x))] rate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example times_zero : accepts (claim [] (Sum rate (Product (Constant (0 // 1)) (Quotient one (Difference x x))))) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example radicand_negative : accepts (claim [("y", RootOf (Difference x (Constant (3 // 1))))] rate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_such_name : accepts (claim [] (Sum rate (Named "y"))) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example a_name_twice : accepts (claim [("x", one)] rate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.

(** No two points have the same x^2, from 1 to 2; of a joint by its row nothing is said. *)
Definition once (joint : written_joint) (y : Z) (steps : list (nat * evidence)) : bool :=
  certify_written 512 52 (0%N, [[y]]) 1 (MakeWrittenClaim (Mechanism ["x"] [] [] [joint]) [Within (1 // 1) (2 // 1)] [Nonsingular] true) (Leaf steps).
Local Notation shown := [(0, ByLower 0%N [[1%Z]]); (1, ByChords)]%nat.
Example one_to_one_ : once (ByCoordinate (Raised x 2)) 1 shown = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example the_other_sign : once (ByCoordinate (Raised x 2)) (-1) shown = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example by_a_row : once (ByRow [rate]) 1 shown = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example not_shown : once (ByCoordinate (Raised x 2)) 1 [(0, ByLower 0%N [[1%Z]])]%nat = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End Formulas.

(** One joint with the row -2 x, x from 1 to 2: the text ["2*-x"] has one reading, whatever a reader makes of it. *)
Module Texts.
Import Certificate.
Local Open Scope string_scope.
Definition digit (d : uint) : term string := Literal d Nil.
Definition certificate (row : term string) : certificate :=
  Certificate (Formulas_ ["x"] [] [] [Row_ [row]] [Literal (D1 Nil) Nil] [Literal (D2 Nil) Nil]
    [Require_ Transmission None None (AtLeast_ (Literal (D0 Nil) (D2 Nil)))])
    (Nodes 52 None [Node [(0%nat, Multiplied "lower" [[(-1)%Z]] 0); (1%nat, Plain "test")] None None []]) "t" "1".
Definition right := certificate (Binary Multiplication (digit (D2 Nil)) (Negative (Name "x"))).
(** [(2 * ) - x]: a number without digits. *)
Definition misread := certificate (Binary Subtraction (Binary Multiplication (digit (D2 Nil)) (digit Nil)) (Name "x")).
Definition text := String.concat "" (print right).

Example one_text : String.concat "" (print misread) = text. Proof. vm_compute. reflexivity. Qed.
Example as_it_is : verify text right = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example without_digits : verify text misread = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example a_zero_before : is_written (digit (D0 (D5 Nil))) = false. Proof. reflexivity. Qed.
Example a_zero_last : is_written (Literal (N := string) (D5 Nil) (D1 (D0 Nil))) = false. Proof. reflexivity. Qed.
Example to_the_first : is_written (Power (Name "x") 1) = false. Proof. reflexivity. Qed.
End Texts.
