(** * The checker: formulas on a tape, tests, a bisection tree with evidence

    Every step shows a test on its node's cell, for every machine of the
    tolerance; what is shown of a cell holds on its parts, and on the path to
    each leaf every test is discharged. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Formula Linear Arithmetic Slope Definite Test Cell Apart.
From Orthocert.kernel Require Solve Near Nearby Spread Twofold Tolerances Second Curvature Scale Toward Weighted Together.
Import ListNotations.
Local Open Scope R_scope.

(** A face of the cube of the postulate, by its corner. *)
Inductive face := Q1 | Q2.

(** [Y] over [2^places]; the names are those of certificate.rs. *)
Inductive evidence :=
  | ByTest | ByDivided
  | ByLower (places : N) (Y : list (list Z)) | ByLowerDivided (places : N) (Y : list (list Z))
  | ByRank (places : N) (Y : list (list Z))
  (* condition numbers: [mu] at the centre, and its slopes *)
  | ByConditioning (places : N) (Y : list (list Z)) (mu : list Z)
  (* of what is far from zero: that it is negative *)
  | ByNegative
  (* of the postulate: see Faces.v *)
  | ByCorner (f : face) | ByMirror
  (* less a multiple, [n] over [2^places], of what is not negative in the workspace *)
  | Inside (e : evidence) (n : Z) (places : N)
  (* no point of the workspace is in the cell *)
  | Outside
  (* of polynomials: at control points (Pose.v) *)
  | AtControls (e : evidence)
  (* as [Inside], of what is not negative at the orientations *)
  | Turned (e : evidence) (n : Z) (places : N)
  (* of two bodies: three rows, affine on the cell *)
  | ByDirection (places : N) (Y : list (list Z))
  (* by the one matrix of the whole tree *)
  | ByChords
  (* of accuracy: kappa, over the 2^places of Y, and of platforms that turn 2^q, by which columns of the other part are multiplied *)
  | ByAccuracy (places : N) (Y : list (list Z)) (kappa : Z) (q : N)
  (* with tolerances apart: where the one machine is, by the numbers of its parameters, which of these are of second order, and directions *)
  | ByTolerances (e : evidence) (ends : list (nat * Tolerances.choice)) (curved : list nat) (directions : list (list Z))
  (* with directions of one scale, by the numbers of their parameters, and which of these are the same of all machines then *)
  | OfOneScale (groups : list (list nat)) (ones : list nat) (e : evidence)
  (* of the directions between each of these and the next one: less n over 2^places times what says so *)
  | ByFan (parts : list (list Z * Z * N * evidence))
  (* condition numbers: [mu] as of [ByConditioning], more by multiples of parameters, of each row its own, if there are some; and each bound by itself *)
  | ByBetween (places : N) (mu : list Z) (weights : list (list (nat * Z))) (lower upper : evidence)
  (* within tolerances: of each row what is not less than all that quantities of second order change of it, over 2^places, or nothing *)
  | ByTogether (e : evidence) (places : N) (all : list (list Z)).

(** Steps name tests by their number, counted from zero. *)
Inductive tree :=
  | Leaf (by_ : list (nat * evidence))
  | Split (by_ : list (nat * evidence)) (k : nat) (lower upper : tree)
  (* in halves of the range of parameter [j]: what follows is of the machines of each *)
  | Parts (by_ : list (nat * evidence)) (j : nat) (lower upper : tree).

(** kappa^2, k^2, c^2, and places of formulas: of the last test one of the two has to be not negative.  [Least]: the
    least singular value of other rows than those of the machine; [Apart]: of two segments, by their ends; [Solved i]: |M^-1 e_i| <= 1/k, of k^2;
    [Chords]: Y^T A + A^T Y > 0 of these rows A, by one matrix for all cells; [Accurate]: of each joint its coordinate, its error and, of each tolerance, the
    half-width with the derivative by it, errors and half-widths over the distance; [Located]: the same of any number of coordinates, in two parts; [Curved]: a |row| + b |H| < 1, of 2 H, where they are known of K^2 and s
    with |row|^2 <= K^2 - s^2, and of what has to be defined. *)
Inductive test :=
  | SigmaMin (kappa2 : fixed) | SigmaMax (k2 : fixed) | Conditioning (c2 : fixed) | AtLeast (f : nat)
  | Least (r : rows nat) (kappa2 : fixed) | Either (f g : nat) | Apart (p p' q q' : spatial nat) (distance : fixed)
  | Solved (i : nat) (k2 : fixed) | Chords (r : rows nat) (places : N) (Y : list (list Z))
  | Accurate (distance : fixed) (joints : list (nat * (fixed * list (fixed * nat))))
  | Located (a : Nearby.nearby)
  | Curved (row : list nat) (twice : list (list nat)) (a b : nat) (lever : option (nat * nat)) (also : list nat).
Definition lever_places (lever : option (nat * nat)) : list nat := match lever with Some (k2, s) => [k2; s] | None => [] end.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Variable tape : list (op address).
(** A and D of the machine, and the same divided by B. *)
Variables whole divided : rows nat.
(** Formulas that have to be defined besides, where singularities are excluded: those that a user gives. *)
Variable partial : list nat.
Variable params : list fixed.
Variable tests : list test.

(** ** Formulas over a cell *)

Definition evaluate_kept (keep : list bool) (cell : list fixed) : list (option slope) :=
  run_kept (option slope) None (slope_op bits (coords_from 0 cell) (map constant params)) keep tape.
Definition evaluate (cell : list fixed) : list (option slope) :=
  run (option slope) None (slope_op bits (coords_from 0 cell) (map constant params)) tape.
Lemma evaluate_all : forall cell, evaluate_kept [] cell = evaluate cell.
Proof. intro cell. apply run_kept_all. Qed.

Fixpoint all_some {A : Type} (l : list (option A)) : option (list A) :=
  match l with
  | [] => Some []
  | Some a :: l' => match all_some l' with Some m => Some (a :: m) | None => None end
  | None :: _ => None
  end.

(** Rows of which every entry is defined, and every D_i positive. *)
Fixpoint rows_over (values : list (option slope)) (r : rows nat) : option (rows slope) :=
  match r with
  | [] => Some []
  | (a, d) :: r' =>
      match all_some (map (fun i => nth i values None) a), nth d values None, rows_over values r' with
      | Some s, Some t, Some rest => if (0 <? lo (range t))%Z then Some ((s, t) :: rest) else None
      | _, _, _ => None
      end
  end.

Definition over_rows (values : list (option slope)) (r : rows nat) (holds : rows slope -> bool) : bool :=
  match rows_over values r with Some s => holds s | None => false end.

Definition are_defined (values : list (option slope)) : bool :=
  forallb (fun f => match nth f values None with Some _ => true | None => false end) partial.

(** Of a curved workspace: what is not negative at its points in a cell. *)
Variable inside : list fixed -> option slope.

(** A bound raised, or lowered, by what is not negative: the S-procedure. *)
Definition raised (less : option slope) (k : slope) : slope := match less with Some t => total k t | None => k end.
Definition lowered (less : option slope) (k : slope) : slope := match less with Some t => difference k t | None => k end.

Definition is_sign (values : list (option slope)) (m : nat) (less : option slope) (f : nat) : bool :=
  match nth f values None with
  | Some s => match less with None => (0 <=? lo (range s))%Z | Some t => sign_there m (difference s t) end
  | None => false
  end.

(** [mu] over [2^places], as a slope. *)
Definition mu_slope (places : N) (mu : list Z) : slope :=
  let entry n := Arithmetic.dyadic n places (Fixed.integer bits 1) in
  match mu with n :: ns => Slope (entry n) zero (map entry ns) | [] => constant zero end.
Definition conditioned (m : nat) (less : option slope) (c2 : fixed) (places : N) (Y : list (list Z)) (mu : slope) (r : rows slope) : bool :=
  positive_there m mu && sigma_min bits m (raised less mu) places Y r && sigma_max bits m (lowered less (multiple bits c2 mu)) r.

Definition end_there (values : list (option slope)) (p : spatial nat) : option (spatial slope) :=
  match nth (along_x p) values None, nth (along_y p) values None, nth (along_z p) values None with
  | Some a, Some b, Some c => Some (Spatial a b c)
  | _, _, _ => None
  end.

Definition slopes_of (values : list (option slope)) (l : list nat) : option (list slope) := all_some (map (fun i => nth i values None) l).

Definition shows (values : list (option slope)) (m : nat) (less : option slope) (t : test) (e : evidence) : bool :=
  match t, e with
  | SigmaMin low, ByLower places Y => are_defined values && over_rows values whole (sigma_min bits m (raised less (constant low)) places Y)
  | SigmaMin low, ByLowerDivided places Y => are_defined values && over_rows values divided (sigma_min bits m (raised less (constant low)) places Y)
  | SigmaMin low, ByRank places Y => are_defined values &&
      ((lo low =? 0)%Z && (hi low =? 0)%Z && over_rows values whole (chords bits m less places Y))
  | SigmaMax high, ByTest => over_rows values whole (sigma_max bits m (lowered less (constant high)))
  | SigmaMax high, ByDivided => over_rows values divided (sigma_max bits m (lowered less (constant high)))
  | Conditioning c2, ByConditioning places Y mu => over_rows values whole (conditioned m less c2 places Y (mu_slope places mu))
  | Least r low, ByLower places Y => over_rows values r (sigma_min bits m (raised less (constant low)) places Y)
  | AtLeast f, ByTest | Either f _, ByTest | Either _ f, ByNegative => is_sign values m less f
  | Apart p p' q q' distance, ByDirection places Y =>
      match end_there values p, end_there values p', end_there values q, end_there values q' with
      | Some p, Some p', Some q, Some q' => are_apart bits m less distance places Y p p' q q'
      | _, _, _, _ => false
      end
  | Chords r places Y, ByChords => over_rows values r (chords bits m less places Y)
  | Solved i k2, ByLower places Y => over_rows values whole (Solve.solved bits m i k2 less places Y)
  | Curved row twice a b lever also, ByTest =>
      match slopes_of values row, all_some (map (slopes_of values) twice), slopes_of values (a :: b :: lever_places lever), slopes_of values also with
      | Some row, Some twice, Some (a :: b :: lever), Some _ =>
          Curvature.curved bits m less row twice (range a) (range b) match lever with [k2; s] => Some (range k2, s) | _ => None end
      | _, _, _, _ => false
      end
  | _, _ => false
  end.

(** Slopes of each joint, and its coordinate defined. *)
Definition joint_over (values : list (option slope)) (j : nat * (fixed * list (fixed * nat))) : option (fixed * list (fixed * slope)) :=
  match nth (fst j) values None, all_some (map (fun h => option_map (pair (fst h)) (nth (snd h) values None)) (snd (snd j))) with
  | Some _, Some hs => Some (fst (snd j), hs)
  | _, _ => None
  end.
(** Accuracy is a test of the cell and what is near it. *)
Definition near_wanted (a : Nearby.nearby) : list nat := partial ++ concat (Nearby.l_far a).
Definition near_values (cell : list fixed) (a : Nearby.nearby) : list (option slope) :=
  run_kept (option slope) None (slope_op bits (Spread.near_cell (Nearby.l_first a) (length cell) cell (Nearby.l_distance a) (Nearby.l_turn a)) (map constant params))
    (kept (near_wanted a) tape) tape.
Definition shows_there (values : list (option slope)) (cell : list fixed) (less : option slope) (t : test) (e : evidence) : bool :=
  match t, e with
  | Accurate distance joints, ByAccuracy places Y kappa 0 =>
      let near := Near.evaluate_near bits tape params (kept (partial ++ flat_map (fun p => fst p ++ [snd p]) divided) tape) cell distance in
      Nat.eqb (length cell) 3 && are_defined near &&
      match rows_over near divided, rows_over values divided, all_some (map (joint_over values) joints) with
      | Some far, Some here, Some js =>
          match Near.triples far with Some far => Near.accurate bits less far here js places Y kappa | None => false end
      | _, _, _ => false
      end
  | Located a, ByAccuracy places Y kappa q =>
      let m := length cell in let near := near_values cell a in
      Nat.leb (Nearby.l_first a) m && Nat.eqb (length (Nearby.l_far a)) m && forallb (fun row => Nat.eqb (length row) m) (Nearby.l_far a) &&
      forallb (fun i => match nth i near None with Some _ => true | None => false end) (near_wanted a) &&
      forallb (fun i => match nth i values None with Some _ => true | None => false end) (Nearby.l_defined a) &&
      match all_some (map (slopes_of near) (Nearby.l_far a)), rows_over values (Nearby.l_rows a), all_some (map (joint_over values) (Nearby.l_joints a)) with
      | Some far, Some here, Some js => Nearby.located bits m less a far here js places Y kappa q
      | _, _, _ => false
      end
  | _, _ => shows values (length cell) less t e
  end.

(** What is looked at of the formulas. *)
Fixpoint is_of_divided (e : evidence) : bool :=
  match e with
  | ByLowerDivided _ _ | ByDivided => true
  | Inside e _ _ | ByTolerances e _ _ _ | OfOneScale _ _ e => is_of_divided e
  | ByFan parts => forallb (fun p => is_of_divided (snd p)) parts
  | _ => false
  end.
(** The same evidence about other rows. *)
Fixpoint of_rows_alone (e : evidence) : evidence :=
  match e with
  | ByLowerDivided places Y => ByLower places Y
  | ByDivided => ByTest
  | Inside e k p => Inside (of_rows_alone e) k p
  | ByTolerances e ends curved directions => ByTolerances (of_rows_alone e) ends curved directions
  | OfOneScale groups ones e => OfOneScale groups ones (of_rows_alone e)
  | _ => e
  end.
Definition places_of_rows (r : rows nat) : list nat := flat_map (fun p => fst p ++ [snd p]) r.
Definition wanted_by (t : test) (e : evidence) : list nat :=
  let own := places_of_rows (if is_of_divided e then divided else whole) in
  match t with
  | SigmaMin _ => partial ++ own
  | SigmaMax _ | Conditioning _ | Solved _ _ => own
  | AtLeast f => [f]
  | Either f g => [f; g]
  | Least r _ | Chords r _ _ => places_of_rows r
  | Apart p p' q q' _ => flat_map (fun p => [along_x p; along_y p; along_z p]) [p; p'; q; q']
  | Accurate _ joints => places_of_rows divided ++ flat_map (fun j => fst j :: map snd (snd (snd j))) joints
  | Located a => places_of_rows (Nearby.l_rows a) ++ Nearby.l_defined a ++ flat_map (fun j => fst j :: map snd (snd (snd j))) (Nearby.l_joints a)
  | Curved row twice a b lever also => row ++ concat twice ++ a :: b :: lever_places lever ++ also
  end.

(** *** Tolerances apart: of one machine at the vertices, less what all others differ by *)

Fixpoint are_once (l : list nat) : bool := match l with [] => true | j :: l' => negb (existsb (Nat.eqb j) l') && are_once l' end.
Definition multi_of (values machine : list (option slope)) (duals : list Tolerances.dual) (ends : list (nat * Tolerances.choice)) (i : nat) : option (Tolerances.multi slope) :=
  match nth i values None, nth i machine None, Tolerances.rates_from 0 ends (nth i duals (None, [])) with
  | Some _, Some s, Some rs => Some (s, rs)
  | _, _, _ => None
  end.
(** To second order too, if some are. *)
Definition second_multi_of (values : list (option slope)) (ones : list Tolerances.dual) (alls : list Second.curve) (ends : list (nat * Tolerances.choice)) (curved : list nat)
    (i : nat) : option (Tolerances.multi slope) :=
  let one := nth i ones (None, []) in
  match nth i values None, fst one, Second.rates_of ends curved one (nth i alls ((None, []), [])) with
  | Some _, Some s, Some rs => Some (s, rs)
  | _, _, _ => None
  end.
Definition machines (values : list (option slope)) (coords : list slope) (own : list bool) (ends : list (nat * Tolerances.choice)) (curved : list nat) : nat -> option (Tolerances.multi slope) :=
  let one := map constant (Tolerances.starts_from ends 0 params) in
  match curved with
  | [] =>
      let machine := run_kept (option slope) None (slope_op bits coords one) own tape in
      let duals := run_kept Tolerances.dual (None, []) (Tolerances.dual_op bits coords (map constant params) (map fst ends)) own tape in
      multi_of values machine duals ends
  | _ =>
      let ones := run_kept Tolerances.dual (None, []) (Tolerances.dual_op bits coords one (Second.of_the_one ends curved params)) own tape in
      let alls := run_kept Second.curve ((None, []), []) (Second.curve_op bits coords (map constant params) (map fst ends) (Second.pairs ends curved)) own tape in
      second_multi_of values ones alls ends curved
  end.
(** Each of these is one of those with tolerances, and once. *)
Definition are_among (curved : list nat) (ends : list (nat * Tolerances.choice)) : bool := forallb (fun j => Second.is_in j (map fst ends)) curved && are_once curved.
(** Of which all D_i are positive, for all machines. *)
Fixpoint rows_apart (values : list (option slope)) (of : nat -> option (Tolerances.multi slope)) (r : rows nat) : option (list (list (Tolerances.multi slope) * Tolerances.multi slope)) :=
  match r with
  | [] => Some []
  | (a, d) :: r' =>
      match all_some (map of a), of d, nth d values None, rows_apart values of r' with
      | Some s, Some t, Some u, Some rest => if (0 <? lo (range u))%Z then Some ((s, t) :: rest) else None
      | _, _, _, _ => None
      end
  end.

Definition shows_apart (values : list (option slope)) (cell : list fixed) (less : option slope) (t : test) (e : evidence)
    (ends : list (nat * Tolerances.choice)) (curved : list nat) (directions : list (list Z)) : bool :=
  let m := length cell in
  let coords := coords_from 0 cell in
  let own := kept (wanted_by t e) tape in
  let steps := Second.steps bits ends curved params in
  let of := machines values coords own ends curved in
  let direction v := map (Fixed.integer bits) v in
  let subtracted := match less with Some t => t | None => constant zero end in
  let at_vertices (r : list (list (Tolerances.multi slope) * Tolerances.multi slope)) (holds : list bool -> fixed -> list (Tolerances.varied fixed) -> bool) :=
    forallb (fun s => holds s (at_vertex s subtracted) (map (Tolerances.varied_at bits s steps) r)) (signs m) in
  let over (r : rows nat) holds := match rows_apart values of r with Some r => at_vertices r holds | None => false end in
  let definite t := match t with Some t => Solve.is_definite bits m t | None => false end in
  let lower v k places Y r := definite (Tolerances.lower_apart bits (direction v) places Y r (repeat [neg k] m)) in
  let upper v k r := definite (Tolerances.upper_apart bits (direction v) r (repeat [k] m)) in
  let sign f := match of f with Some q => at_vertices [([], q)] (fun _ t r => forallb (Tolerances.sign_apart t) r) | None => false end in
  forallb (fun j => Nat.ltb j (length params)) (map fst ends) && are_once (map fst ends) && (are_among curved ends && forallb (fun v => Nat.eqb (length v) m) directions) &&
  match t, e, directions with
  | SigmaMin low, ByLower places Y, [v] => are_defined values && over whole (fun _ t => lower v (add low t) places Y)
  | SigmaMin low, ByRank places Y, [v] => are_defined values &&
      ((lo low =? 0)%Z && (hi low =? 0)%Z && over whole (fun _ t r => lower v t places Y (map Tolerances.without_D r)))
  | Least r low, ByLower places Y, [v] => over r (fun _ t => lower v (add low t) places Y)
  | SigmaMax high, ByTest, [v] => over whole (fun _ t => upper v (sub high t))
  | Conditioning c2, ByConditioning places Y mu, [u; v] => let mu := mu_slope places mu in
      positive_there m mu &&
      over whole (fun s t r => let mu := at_vertex s mu in lower u (add mu t) places Y r && upper v (sub (mul bits c2 mu) t) r)
  | AtLeast f, ByTest, [] | Either f _, ByTest, [] | Either _ f, ByNegative, [] => sign f
  | Solved i k2, ByLower places Y, [v] => Nat.eqb (length whole) m && over whole (fun _ t => Tolerances.solved_apart bits (direction v) m i k2 t places Y)
  | _, _, _ => false
  end.

(** *** Of the directions of a wedge: in coordinates in which one of them is along an axis *)

(** The first of the greatest entries, the direction over 2^q, and the same in these coordinates. *)
Definition toward_of (v : list Z) : nat * list Z * N * list fixed :=
  let most := fold_right (fun x n => Z.max (Z.abs x) n) 0%Z v in
  let k := (fix first v := match v with [] => O | x :: v' => if (Z.abs x =? most)%Z then O else S (first v') end) v in
  if (most =? 0)%Z then (O, match v with [] => [] | _ :: v' => 1%Z :: v' end, 0%N, map (fun _ => zero) v)
  else let q := Z.to_N (Z.log2 most + 1) in (k, v, q, Toward.put_in zero k (Fixed.integer bits (2 ^ Z.of_N q)) (map (fun _ => zero) v)).

Definition shows_wedge (values : list (option slope)) (cell : list fixed) (less : option slope) (t : test) (e : evidence)
    (ends : list (nat * Tolerances.choice)) (curved : list nat) (direction b c : list Z) (n : Z) (places : N) : bool :=
  let m := length cell in
  let coords := coords_from 0 cell in
  let own := kept (wanted_by t e) tape in
  let steps := Second.steps bits ends curved params in
  let of := machines values coords own ends curved in
  let subtracted := match less with Some t => t | None => constant zero end in
  let over (r : rows nat) (holds : fixed -> list (Tolerances.varied fixed) -> bool) :=
    match rows_apart values of r with
    | Some r => forallb (fun s => holds (at_vertex s subtracted) (map (Tolerances.varied_at bits s steps) r)) (signs m)
    | None => false
    end in
  let '(k, w, q, d) := toward_of direction in
  let w' := map (fun x => Arithmetic.dyadic x q (Fixed.integer bits 1)) w in
  let start a := Toward.less_wedge bits k w' b c n places (Toward.squares bits k w' m a []) in
  let definite t := match t with Some t => Solve.is_definite bits m t | None => false end in
  let lower a places Y r := definite (Toward.lower_toward bits k w' d places Y r (start (neg a))) in
  let upper a r := definite (Toward.upper_toward bits k w' d r (start a)) in
  forallb (fun j => Nat.ltb j (length params)) (map fst ends) && are_once (map fst ends) &&
  Nat.eqb (length w) m && (are_among curved ends && Nat.eqb (length b) m) && (0 <=? n)%Z && (places <? 64)%N && Nat.ltb k m && negb (nth k w 0 =? 0)%Z &&
  match t, e with
  | SigmaMin low, ByLower places Y => are_defined values && over whole (fun t => lower (add low t) places Y)
  | SigmaMin low, ByRank places Y => are_defined values &&
      ((lo low =? 0)%Z && (hi low =? 0)%Z && over whole (fun t r => lower t places Y (map Tolerances.without_D r)))
  | Least r low, ByLower places Y => over r (fun t => lower (add low t) places Y)
  | SigmaMax high, ByTest => over whole (fun t => upper (sub high t))
  | _, _ => false
  end.
(** With no tolerances apart there is no direction of them. *)
Definition shows_along (values : list (option slope)) (cell : list fixed) (t : test) (b c : list Z) (n : Z) (places : N) (e : evidence) : bool :=
  let inside_of k p f := match inside cell with Some tangent => (0 <=? k)%Z && f (Some (dyadic_slope k p tangent)) | None => false end in
  let none := map (fun _ => 0%Z) cell in
  match e with
  | ByTolerances (Inside e k p) ends curved [v] => inside_of k p (fun less => shows_wedge values cell less t e ends curved v b c n places)
  | ByTolerances e ends curved [v] => shows_wedge values cell None t e ends curved v b c n places
  | ByTolerances _ _ _ _ => false
  | Inside e k p => inside_of k p (fun less => shows_wedge values cell less t e [] [] none b c n places)
  | e => shows_wedge values cell None t e [] [] none b c n places
  end.

(** One bound of a condition number, [mu], or where [upper] c^2 mu, at the vertices; of the directions of a wedge, or of all. *)
Definition shows_half (values : list (option slope)) (cell : list fixed) (upper : option fixed) (mu : slope) (wedge : option (list Z * list Z * Z * N))
    (less : option slope) (e : evidence) (ends : list (nat * Tolerances.choice)) (curved : list nat) (direction : list Z) : bool :=
  let m := length cell in
  let coords := coords_from 0 cell in
  let own := kept (places_of_rows whole) tape in
  let steps := Second.steps bits ends curved params in
  let of := machines values coords own ends curved in
  let subtracted := match less with Some t => t | None => constant zero end in
  let over (holds : list bool -> fixed -> list (Tolerances.varied fixed) -> bool) :=
    match rows_apart values of whole with
    | Some r => forallb (fun s => holds s (at_vertex s subtracted) (map (Tolerances.varied_at bits s steps) r)) (signs m)
    | None => false
    end in
  let definite t := match t with Some t => Solve.is_definite bits m t | None => false end in
  let least s t := neg (add (at_vertex s mu) t) in
  let greatest c2 s t := sub (mul bits c2 (at_vertex s mu)) t in
  forallb (fun j => Nat.ltb j (length params)) (map fst ends) && are_once (map fst ends) && (are_among curved ends && Nat.eqb (length direction) m) &&
  match wedge with
  | None =>
      let w := map (Fixed.integer bits) direction in
      match upper, e with
      | None, ByLower places Y => over (fun s t r => definite (Tolerances.lower_apart bits w places Y r (repeat [least s t] m)))
      | Some c2, ByTest => over (fun s t r => definite (Tolerances.upper_apart bits w r (repeat [greatest c2 s t] m)))
      | _, _ => false
      end
  | Some (b, c, n, pl) =>
      let '(k, w, q, d) := toward_of direction in
      let w' := map (fun x => Arithmetic.dyadic x q (Fixed.integer bits 1)) w in
      let start a := Toward.less_wedge bits k w' b c n pl (Toward.squares bits k w' m a []) in
      Nat.eqb (length w) m && Nat.eqb (length b) m && (0 <=? n)%Z && (pl <? 64)%N && Nat.ltb k m && negb (nth k w 0 =? 0)%Z &&
      match upper, e with
      | None, ByLower places Y => over (fun s t r => definite (Toward.lower_toward bits k w' d places Y r (start (least s t))))
      | Some c2, ByTest => over (fun s t r => definite (Toward.upper_toward bits k w' d r (start (greatest c2 s t))))
      | _, _ => false
      end
  end.
(** Some changes of rows looked at together: of |M v|^2 that it is more than [mu], or where [upper] less than c^2 mu, [mu] more by multiples of parameters if there are some. *)
Definition shows_together (values : list (option slope)) (cell : list fixed) (r : rows nat) (own : list bool) (upper : option fixed) (mu : slope) (pl : N) (weights : list (list (nat * Z)))
    (less : option slope) (e : evidence) (ends : list (nat * Tolerances.choice)) (curved : list nat) (directions : list (list Z)) (places : N) (all : list (list Z)) : bool :=
  let m := length cell in
  let coords := coords_from 0 cell in
  let steps := Second.steps bits ends curved params in
  let kinds := Together.kinds ends curved in
  let of := machines values coords own ends curved in
  let subtracted := match less with Some t => t | None => constant zero end in
  let mu := total mu (constant (Weighted.total_of pl (Tolerances.starts_from ends 0 params) weights)) in
  let nss := map (fun row => map (fun e => Weighted.multiple_for row (fst e)) ends) weights in
  let over (holds : list bool -> fixed -> list (list Z * Together.grouped) -> bool) :=
    match rows_apart values of r with
    | Some r => forallb (fun p => Weighted.are_related (fst p) (snd p)) (combine nss r) &&
        let r := map (fun p => (fst p, (fst (snd p), (Together.kinds_for (fst p) kinds 0 (snd (snd p)), snd (snd p))))) (combine all (combine nss r)) in
        forallb (fun s => holds s (at_vertex s subtracted) (map (fun p => (fst p, Together.grouped_at bits pl s steps (fst (snd p)) (fst (snd (snd p))) (snd (snd (snd p))))) r)) (signs m)
    | None => false
    end in
  let definite t := match t with Some t => Solve.is_definite bits m t | None => false end in
  let lower w across p Y := over (fun s t r => definite (Together.lower_grouped bits (map (Fixed.integer bits) w) across places p Y r (repeat [neg (add (at_vertex s mu) t)] m))) in
  forallb (fun j => Nat.ltb j (length params)) (map fst ends) && are_once (map fst ends) &&
  (are_among curved ends && forallb (fun v => Nat.eqb (length v) m) directions && Nat.eqb (length weights) (length r) && Nat.eqb (length all) (length r)) &&
  (match curved with [] => false | _ => true end && (places <? 64)%N) &&
  match upper, e, directions with
  | None, ByLower p Y, [w] => lower w None p Y
  | None, ByLower p Y, [w; d] => lower w (if forallb (fun x => (x =? 0)%Z) d then None else Some (map (fun x => Arithmetic.dyadic x 4 (Fixed.integer bits 1)) d)) p Y
  | Some c2, ByTest, [w] => over (fun s t r => definite (Together.upper_grouped bits (map (Fixed.integer bits) w) c2 places r (repeat [sub (mul bits c2 (at_vertex s mu)) t] m)))
  | _, _, _ => false
  end.
Definition unweighted (r : rows nat) : list (list (nat * Z)) := map (fun _ => []) r.

Definition half_within (values : list (option slope)) (cell : list fixed) (upper : option fixed) (mu : slope) (wedge : option (list Z * list Z * Z * N))
    (less : option slope) (e : evidence) (ends : list (nat * Tolerances.choice)) (curved : list nat) (direction : list Z) : bool :=
  match e with
  | ByTogether e places all => match wedge with
      | None => shows_together values cell whole (kept (places_of_rows whole) tape) upper mu 0 (unweighted whole) less e ends curved [direction] places all
      | Some _ => false
      end
  | _ => shows_half values cell upper mu wedge less e ends curved direction
  end.
Definition half_on (values : list (option slope)) (cell : list fixed) (upper : option fixed) (mu : slope) (wedge : option (list Z * list Z * Z * N)) (e : evidence) : bool :=
  let half := half_within values cell upper mu wedge in
  let inside_of k p f := match inside cell with Some tangent => (0 <=? k)%Z && f (Some (dyadic_slope k p tangent)) | None => false end in
  let none := map (fun _ => 0%Z) cell in
  match e with
  | ByTolerances (Inside e k p) ends curved [v] => inside_of k p (fun less => half less e ends curved v)
  | ByTolerances e ends curved [v] => half None e ends curved v
  | ByTolerances _ _ _ _ => false
  | Inside e k p => inside_of k p (fun less => half less e [] [] none)
  | e => half None e [] [] none
  end.

(** The same where [mu] is more by multiples of parameters: of each machine its own, of which some change with each row. *)
Definition weighted_half (values : list (option slope)) (cell : list fixed) (upper : option fixed) (mu : slope) (pl : N) (weights : list (list (nat * Z)))
    (less : option slope) (e : evidence) (ends : list (nat * Tolerances.choice)) (curved : list nat) (directions : list (list Z)) : bool :=
  let m := length cell in
  let coords := coords_from 0 cell in
  let own := kept (places_of_rows whole) tape in
  let steps := Second.steps bits ends curved params in
  let of := machines values coords own ends curved in
  let subtracted := match less with Some t => t | None => constant zero end in
  let mu := total mu (constant (Weighted.total_of pl (Tolerances.starts_from ends 0 params) weights)) in
  let nss := map (fun row => map (fun e => Weighted.multiple_for row (fst e)) ends) weights in
  let over (holds : list bool -> fixed -> list (Weighted.weighted fixed) -> bool) :=
    match rows_apart values of whole with
    | Some r => forallb (fun p => Weighted.are_related (fst p) (snd p)) (combine nss r) &&
        forallb (fun s => holds s (at_vertex s subtracted) (map (fun p => Weighted.weighted_at bits pl s steps (fst p) (snd p)) (combine nss r))) (signs m)
    | None => false
    end in
  let definite t := match t with Some t => Solve.is_definite bits m t | None => false end in
  forallb (fun j => Nat.ltb j (length params)) (map fst ends) && are_once (map fst ends) &&
  (are_among curved ends && forallb (fun v => Nat.eqb (length v) m) directions && Nat.eqb (length weights) (length whole)) &&
  match upper, e, directions with
  | None, ByLower places Y, [w; d] =>
      let across := if forallb (fun x => (x =? 0)%Z) d then None else Some (map (fun x => Arithmetic.dyadic x 4 (Fixed.integer bits 1)) d) in
      over (fun s t r => definite (Weighted.lower_weighted bits (map (Fixed.integer bits) w) across places Y r (repeat [neg (add (at_vertex s mu) t)] m)))
  | Some c2, ByTest, [w] => over (fun s t r => definite (Weighted.upper_weighted bits (map (Fixed.integer bits) w) c2 r (repeat [sub (mul bits c2 (at_vertex s mu)) t] m)))
  | _, _, _ => false
  end.
Definition weighted_within (values : list (option slope)) (cell : list fixed) (upper : option fixed) (mu : slope) (pl : N) (weights : list (list (nat * Z)))
    (less : option slope) (e : evidence) (ends : list (nat * Tolerances.choice)) (curved : list nat) (directions : list (list Z)) : bool :=
  match e with
  | ByTogether e places all => match upper, directions with
      | None, [_; _] | Some _, [_] => shows_together values cell whole (kept (places_of_rows whole) tape) upper mu pl weights less e ends curved directions places all
      | _, _ => false
      end
  | _ => weighted_half values cell upper mu pl weights less e ends curved directions
  end.
Definition weighted_half_on (values : list (option slope)) (cell : list fixed) (upper : option fixed) (mu : slope) (pl : N) (weights : list (list (nat * Z))) (e : evidence) : bool :=
  let half := weighted_within values cell upper mu pl weights in
  let inside_of k p f := match inside cell with Some tangent => (0 <=? k)%Z && f (Some (dyadic_slope k p tangent)) | None => false end in
  let none := map (fun _ => 0%Z) cell in
  let none := match upper with None => [none; none] | Some _ => [none] end in
  match e with
  | ByTolerances (Inside e k p) ends curved directions => inside_of k p (fun less => half less e ends curved directions)
  | ByTolerances e ends curved directions => half None e ends curved directions
  | Inside e k p => inside_of k p (fun less => half less e [] [] none)
  | e => half None e [] [] none
  end.

(** Of all that tolerances are about. *)
Definition shows_within (values : list (option slope)) (cell : list fixed) (less : option slope) (t : test) (e : evidence)
    (ends : list (nat * Tolerances.choice)) (curved : list nat) (directions : list (list Z)) : bool :=
  match e with
  | ByTogether e places all =>
      let together r upper k := shows_together values cell r (kept (wanted_by t e) tape) upper (constant k) 0 (unweighted r) less e ends curved directions places all in
      match t, directions with
      | SigmaMin low, [_] => are_defined values && together whole None low
      | Least r low, [_] => together r None low
      | SigmaMax high, [_] => together whole (Some (Fixed.integer bits 1)) high
      | _, _ => false
      end
  | _ => shows_apart values cell less t e ends curved directions
  end.

Definition shows_on (values : list (option slope)) (cell : list fixed) (t : test) (e : evidence) : bool :=
  match e with
  | ByTolerances (Inside e n places) ends curved directions =>
      match inside cell with
      | Some tangent => (0 <=? n)%Z && shows_within values cell (Some (dyadic_slope n places tangent)) t e ends curved directions
      | None => false
      end
  | ByTolerances e ends curved directions => shows_within values cell None t e ends curved directions
  | Inside e n places =>
      match inside cell with
      | Some tangent => (0 <=? n)%Z && shows_there values cell (Some (dyadic_slope n places tangent)) t e
      | None => false
      end
  | _ => shows_there values cell None t e
  end.

Definition is_outside (cell : list fixed) : bool :=
  match inside cell with Some tangent => negative_there (length cell) tangent | None => false end.

(** ** What it shows *)

Variable theta : list R.
Hypothesis theta_in : Forall2 contains params theta.

Definition formula_at (i : nat) : formula := nth i (formulas tape) (integer 0).

(** Every formula of the rows is defined at [x], and every D_i positive. *)
Definition regular (x : list R) (r : rows formula) : Prop :=
  Forall (fun p => Forall (defined x theta) (fst p) /\ defined x theta (snd p)) r /\
  positive_D (map_rows (value x theta) r).

(** [bound] holds of the rows' |M v|^2, for one of the two forms of the rows. *)
Definition of_these (x : list R) (r : rows formula) (bound : rows R -> Prop) : Prop := regular x r /\ bound (map_rows (value x theta) r).
Definition of_rows (x : list R) (bound : rows R -> Prop) : Prop :=
  exists r, (r = map_rows formula_at whole \/ r = map_rows formula_at divided) /\ of_these x r bound.

Definition is_nonneg (x : list R) (f : nat) : Prop := defined x theta (formula_at f) /\ 0 <= value x theta (formula_at f).

(** What joint coordinates may be off by: errors, and derivatives of each for machines of its own. *)
Definition may_be_off (x : list R) (j : nat * (fixed * list (fixed * nat))) (b : R) : Prop :=
  exists th e ts, Forall2 contains params th /\ (exists a, contains (fst (snd j)) a /\ Rabs e <= a) /\
    Forall2 (fun h t => exists a, contains (fst h) a /\ Rabs t <= a) (snd (snd j)) ts /\
    b = fold_right (fun p sum => snd p * value x th (formula_at (snd (fst p))) + sum) e (combine (snd (snd j)) ts).
(** |(A - B) w|^2 *)
Fixpoint changes (A B : list (list R)) (w : list R) : R :=
  match A, B with a :: A', b :: B' => (dot a w - dot b w) ^ 2 + changes A' B' w | _, _ => 0 end.
Definition divided_at (x : list R) : list (list R) := map (fun p => map (fun i => value x theta (formula_at i)) (fst p)) divided.
Definition accurate_at (x : list R) (distance : fixed) (joints : list (nat * (fixed * list (fixed * nat)))) : Prop :=
  (forall th, Forall2 contains params th -> Forall (fun j => defined x th (formula_at (fst j))) joints) /\
  exists g kappa z, 0 <= g /\ g < kappa /\ 0 <= z /\ z + g / (2 * kappa) <= 1 /\
  (forall d l0 l1 l2, contains distance d -> 0 <= d -> Forall (fun t => -1 <= t <= 1) [l0; l1; l2] -> let y := Near.moved d x [l0; l1; l2] in
    Forall (fun p => Forall (fun i => defined y theta (formula_at i)) (fst p)) divided /\
    forall w0 w1 w2, changes (divided_at y) (divided_at x) [w0; w1; w2] <= g ^ 2 * ((w0 ^ 2 + w1 ^ 2 + w2 ^ 2) * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2))) /\
  forall w0 w1 w2, let w := [w0; w1; w2] in let p := Solve.weighted_sum w (divided_at x) in
    kappa ^ 2 * dot w w <= dot p p /\
    forall bs s, Forall2 (may_be_off x) joints bs -> 0 < dot w w + s ^ 2 -> 0 < dot p p + 2 * s * dot bs w + z ^ 2 * s ^ 2.

(** Off by u, of so many coordinates. *)
Definition near_at (x : list R) (a : Nearby.nearby) (d tau : R) (u : list R) : list R := Spread.near_point (Nearby.l_first a) x d tau u.
Definition far_at (x : list R) (a : Nearby.nearby) (d tau : R) (u : list R) : list (list R) :=
  map (map (fun i => value (near_at x a d tau u) theta (formula_at i))) (Nearby.l_far a).
Definition is_half (h : fixed * nat) (t : R) : Prop := exists a, contains (fst h) a /\ Rabs t <= a.
Definition located_at (m : nat) (x : list R) (a : Nearby.nearby) : Prop :=
  let f := Nearby.l_first a in
  (forall th, Forall2 contains params th -> Forall (fun i => defined x th (formula_at i)) (Nearby.l_defined a)) /\
  (f <= m)%nat /\ length (Nearby.l_far a) = m /\ Forall (fun row => length row = m) (Nearby.l_far a) /\
  forall d tau, contains (Nearby.l_distance a) d -> contains (Nearby.l_turn a) tau -> 0 <= d -> 0 <= tau ->
  (Nearby.l_angular a = true ->
    (forall u v, Spread.inside f m u -> Forall (fun t => -1 <= t <= 1) v -> Forall (fun row => Rabs (d * dot row v) < 1) (far_at x a d tau u)) /\
    Forall (fun j => forall th ts, Forall2 contains params th -> Forall2 is_half (snd (snd j)) ts -> Rabs (d * dot ts (map (fun h => value x th (formula_at (snd h))) (snd (snd j)))) < 1)
      (Nearby.l_joints a)) /\
  exists g, 0 <= g /\
  (forall u, Spread.inside f m u -> Forall (fun i => defined (near_at x a d tau u) theta (formula_at i)) (near_wanted a) /\
    forall w, length w = m -> Twofold.size (Twofold.less (Twofold.image (far_at x a d tau u) w) (Twofold.image (far_at x a d tau (Twofold.nought m)) w)) <= g * (Twofold.norm f w * Twofold.norm f u)) /\
  exists kappa z e, g < kappa /\ 0 <= z /\ z + g / (2 * kappa) <= 1 /\ length e = m /\ (forall i, (i < m)%nat -> 0 < nth i e 0) /\
  (forall i, (i < m)%nat -> (if Nearby.l_last a then f <= i else i < f)%nat -> nth i e 0 = 1) /\
  forall w, length w = m -> let p := Solve.weighted_sum w (map (Twofold.scaled e) (map fst (map_rows (value x theta) (map_rows formula_at (Nearby.l_rows a))))) in
  kappa ^ 2 * dot w w <= dot p p /\
  forall bs s, Forall2 (may_be_off x) (Nearby.l_joints a) bs -> 0 < dot w w + s ^ 2 -> 0 < dot p p + 2 * s * dot bs w + z ^ 2 * s ^ 2.

Definition holds (m : nat) (x : list R) (t : test) : Prop :=
  match t with
  | Located a => located_at m x a
  | Accurate distance joints => (exists d, contains distance d /\ 0 <= d) -> accurate_at x distance joints
  | SigmaMin low => Forall (fun f => defined x theta (formula_at f)) partial /\
      of_rows x (fun r => forall kappa2 v, contains low kappa2 -> length v = m -> nonzero v -> kappa2 * dot v v < energy r v)
  | SigmaMax high => of_rows x (fun r => forall k2 v, contains high k2 -> length v = m -> nonzero v ->
      energy r v < k2 * dot v v)
  | Conditioning c2 => of_rows x (fun r => forall c u v, contains c2 c -> length u = m -> length v = m -> nonzero u -> nonzero v ->
      energy r u * dot v v < c * energy r v * dot u u)
  | AtLeast f => is_nonneg x f
  | Least r low => of_these x (map_rows formula_at r) (fun r => forall kappa2 v, contains low kappa2 -> length v = m -> nonzero v ->
      kappa2 * dot v v < energy r v)
  | Either f g => is_nonneg x f \/ is_nonneg x g
  | Apart p p' q q' distance => let at_ := each (fun i => value x theta (formula_at i)) in
      forall d s t, contains distance d -> 0 <= d -> 0 <= s <= 1 -> 0 <= t <= 1 ->
      let w := away (between s (at_ p) (at_ p')) (between t (at_ q) (at_ q')) in d ^ 2 < inner w w
  | Solved i k2 => of_these x (map_rows formula_at whole) (fun r => length r = m /\ forall k u, contains k2 k -> 0 <= k -> length u = length r -> nonzero u ->
      let p := Solve.weighted_sum u (map fst r) in k * (nth i (map snd r) 0 * nth i u 0 ^ 2) < dot p p)
  | Chords r places Y => of_these x (map_rows formula_at r) (fun r => forall v, length v = m -> nonzero v ->
      0 < form (lower_weights places Y v) (map (fun p => (fst p, 0)) r) v)
  | Curved row twice a b lever also => let at_ i := value x theta (formula_at i) in
      Forall (fun i => defined x theta (formula_at i)) also /\ (0 <= at_ a -> match lever with Some (k2, s) => dot (map at_ row) (map at_ row) <= at_ k2 - at_ s ^ 2 | None => True end -> forall e v, dot e e <= 1 -> length v = m -> nonzero v ->
      Rabs (at_ b / 2 * quad (map (map at_) twice) v) < (1 - at_ a * dot (map at_ row) e) * dot v v)
  end.

(** The same of some directions. *)
Definition holds_along (P : list R -> Prop) (m : nat) (x : list R) (t : test) : Prop :=
  match t with
  | SigmaMin low => Forall (fun f => defined x theta (formula_at f)) partial /\
      of_these x (map_rows formula_at whole) (fun r => forall kappa2 v, contains low kappa2 -> length v = m -> nonzero v -> P v -> kappa2 * dot v v < energy r v)
  | SigmaMax high => of_these x (map_rows formula_at whole) (fun r => forall k2 v, contains high k2 -> length v = m -> nonzero v -> P v -> energy r v < k2 * dot v v)
  | Least r low => of_these x (map_rows formula_at r) (fun r => forall kappa2 v, contains low kappa2 -> length v = m -> nonzero v -> P v -> kappa2 * dot v v < energy r v)
  | _ => False
  end.
Lemma energy_nonneg : forall r v, positive_D r -> 0 <= energy r v.
Proof.
  intros r v. induction 1 as [| [a d] q h1 _ IH]; cbn [energy snd] in *; [lra |].
  assert (0 <= dot a v ^ 2 / d) by (apply Rmult_le_pos; [apply pow2_ge_0 | apply Rlt_le, Rinv_0_lt_compat, h1]). lra.
Qed.

(** One bound of a condition number, with [mu] at the point: of some directions. *)
Definition half_holds (P : list R -> Prop) (m : nat) (x : list R) (upper : option fixed) (mu : R) : Prop :=
  of_these x (map_rows formula_at whole) (fun r => forall v, length v = m -> nonzero v -> P v ->
    match upper with None => mu * dot v v < energy r v | Some c2 => forall c, contains c2 c -> energy r v < c * mu * dot v v end).
Lemma half_of_fan : forall m x upper mu cs, cs <> [] -> (forall p, In p (Toward.wedges cs) -> half_holds (Toward.in_wedge (fst p) (snd p)) m x upper mu) -> half_holds (fun _ => True) m x upper mu.
Proof.
  intros m x upper mu cs n h. destruct (Toward.fan_covers cs [] n) as [p0 [i0 _]]. split; [exact (proj1 (h p0 i0)) |].
  intros v lv nz _. destruct (Toward.fan_covers cs v n) as [p [i w]]. exact (proj2 (h p i) v lv nz w).
Qed.
Lemma holds_of_halves : forall m x c2 mu, 0 < mu -> half_holds (fun _ => True) m x None mu -> half_holds (fun _ => True) m x (Some c2) mu -> holds m x (Conditioning c2).
Proof.
  intros m x c2 mu p [R A] [_ B]. exists (map_rows formula_at whole). split; [left; reflexivity |]. split; [exact R |]. intros c u v hc lu lv nu nv.
  specialize (A v lv nv I). specialize (B u lu nu I c hc). pose proof (energy_nonneg _ u (proj2 R)) as E0. set (M := map_rows (value x theta) (map_rows formula_at whole)) in *. clearbody M.
  unfold nonzero in nu, nv. set (U := dot u u) in *. set (V := dot v v) in *. clearbody U V.
  assert (c0 : 0 < c). { apply Rnot_le_lt. intro n. assert (c * mu <= 0) by nra. nra. }
  apply Rlt_trans with (c * mu * U * V); [apply Rmult_lt_compat_r; assumption |].
  replace (c * mu * U * V) with (c * U * (mu * V)) by ring. replace (c * energy M v * U) with (c * U * energy M v) by ring.
  apply Rmult_lt_compat_l; [apply Rmult_lt_0_compat |]; assumption.
Qed.
Definition is_of_rows (t : test) : bool := match t with SigmaMin _ | SigmaMax _ => true | _ => false end.
Lemma holds_of_fan : forall m x t cs, cs <> [] -> (forall p, In p (Toward.wedges cs) -> holds_along (Toward.in_wedge (fst p) (snd p)) m x t) -> holds m x t.
Proof.
  intros m x t cs n h.
  assert (One : exists p, In p (Toward.wedges cs)) by (destruct (Toward.fan_covers cs [] n) as [p [i _]]; exists p; exact i). destruct One as [p0 i0]. pose proof (h p0 i0) as h0.
  destruct t; cbn [holds_along holds] in *; try contradiction.
  - destruct h0 as [D [R _]]. split; [exact D |]. exists (map_rows formula_at whole). split; [left; reflexivity |]. split; [exact R |].
    intros K v hk lv nz. destruct (Toward.fan_covers cs v n) as [p [i w]]. destruct (h p i) as [_ [_ H]]. exact (H K v hk lv nz w).
  - destruct h0 as [R _]. exists (map_rows formula_at whole). split; [left; reflexivity |]. split; [exact R |].
    intros K v hk lv nz. destruct (Toward.fan_covers cs v n) as [p [i w]]. destruct (h p i) as [_ H]. exact (H K v hk lv nz w).
  - destruct h0 as [R _]. split; [exact R |]. intros K v hk lv nz. destruct (Toward.fan_covers cs v n) as [p [i w]]. destruct (h p i) as [_ H]. exact (H K v hk lv nz w).
Qed.

Section Cell.
Variables (cell : list fixed) (x lambda : list R).
Hypothesis lambda_length : length lambda = length cell.
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.
Let cs := map (centre_of bits) cell.
Variable keep : list bool.
Let values := evaluate_kept keep cell.
Hypothesis enclosed_at : forall i, encloses bits lambda x cs theta (nth i values None) (formula_at i).

(** The slope that belongs to [x]. *)
Definition entry_of (s : slope) (f : formula) (e : entry) : Prop :=
  entry_in bits s e /\ value x theta f = at_lambda lambda e.

Lemma entry_exists : forall i s, nth i values None = Some s ->
  defined x theta (formula_at i) /\ contains (range s) (value x theta (formula_at i)) /\
  exists e, entry_of s (formula_at i) e.
Proof.
  intros i s h. pose proof (enclosed_at i) as H. rewrite h in H. destruct H as [_ [d [h1 [h2 [u [h3 h4]]]]]].
  split; [exact d |]. split; [exact h2 |]. exists (value cs theta (formula_at i), u).
  split; [split; assumption |]. unfold at_lambda. cbn [fst snd]. lra.
Qed.
Lemma slopes_defined : forall l s, slopes_of values l = Some s -> Forall (fun i => defined x theta (formula_at i)) l.
Proof.
  unfold slopes_of. induction l as [| i l IH]; intros s e; [apply Forall_nil |]. cbn [map all_some] in e.
  destruct (nth i values None) as [y |] eqn:ey; [| discriminate]. destruct (all_some _) as [r |]; [| discriminate]. apply Forall_cons; [exact (proj1 (entry_exists i y ey)) | exact (IH r eq_refl)].
Qed.

Lemma all_some_entries : forall a s, all_some (map (fun i => nth i values None) a) = Some s ->
  Forall (defined x theta) (map formula_at a) /\
  exists e, Forall2 (entry_in bits) s e /\ map (value x theta) (map formula_at a) = map (at_lambda lambda) e.
Proof.
  induction a as [| i a IH]; intros s h; cbn [map all_some] in h.
  - injection h as <-. split; [constructor |]. exists []. split; [constructor | reflexivity].
  - destruct (nth i values None) as [s1 |] eqn:n; [| discriminate].
    destruct (all_some (map _ a)) as [s' |]; [| discriminate]. injection h as <-.
    destruct (IH s' eq_refl) as [d [e [h1 h2]]]. destruct (entry_exists i s1 n) as [d1 [_ [e1 [k1 k2]]]].
    split; [constructor; assumption |]. exists (e1 :: e). split; [constructor; assumption |]. cbn [map]. congruence.
Qed.

Lemma rows_over_sound : forall r s, rows_over values r = Some s ->
  regular x (map_rows formula_at r) /\
  exists es, rows_rel (entry_in bits) s es /\
    map_rows (value x theta) (map_rows formula_at r) = map_rows (at_lambda lambda) es.
Proof.
  induction r as [| [a d] r IH]; intros s h; cbn [rows_over] in h.
  - injection h as <-. split; [split; constructor |]. exists []. split; [constructor | reflexivity].
  - destruct (all_some (map _ a)) as [sa |] eqn:ea; [| discriminate].
    destruct (nth d values None) as [sd |] eqn:ed; [| discriminate].
    destruct (rows_over values r) as [rest |]; [| discriminate].
    destruct (0 <? lo (range sd))%Z eqn:p; [| discriminate]. injection h as <-. apply Z.ltb_lt in p.
    destruct (IH rest eq_refl) as [[H1 H2] [es [H3 H4]]]. destruct (all_some_entries a sa ea) as [d1 [e1 [k1 k2]]].
    destruct (entry_exists d sd ed) as [d2 [c2 [e2 [k3 k4]]]]. rewrite !map_rows_cons. split.
    + split; constructor; cbn [fst snd]; auto. exact (contains_positive bits _ _ p c2).
    + exists ((e1, e2) :: es). split; [constructor; [split |]; assumption |].
      rewrite map_rows_cons. rewrite <- H4, <- k2, <- k4. reflexivity.
Qed.

Lemma over_these_sound : forall r test (bound : rows R -> Prop), over_rows values r test = true ->
  (forall s es, test s = true -> rows_rel (entry_in bits) s es ->
     positive_D (map_rows (at_lambda lambda) es) -> bound (map_rows (at_lambda lambda) es)) ->
  of_these x (map_rows formula_at r) bound.
Proof.
  intros r test bound h H. unfold over_rows in h. destruct (rows_over values r) as [s |] eqn:e; [| discriminate].
  destruct (rows_over_sound r s e) as [reg [es [k1 k2]]]. split; [exact reg |]. destruct reg as [_ pos]. rewrite k2 in *.
  eapply H; eassumption.
Qed.

Lemma over_rows_sound : forall r test (bound : rows R -> Prop),
  r = whole \/ r = divided -> over_rows values r test = true ->
  (forall s es, test s = true -> rows_rel (entry_in bits) s es ->
     positive_D (map_rows (at_lambda lambda) es) -> bound (map_rows (at_lambda lambda) es)) ->
  of_rows x bound.
Proof.
  intros r test bound which h H. exists (map_rows formula_at r). split; [destruct which; subst r; auto |].
  exact (over_these_sound r test bound h H).
Qed.

Lemma are_defined_sound : are_defined values = true -> Forall (fun f => defined x theta (formula_at f)) partial.
Proof.
  unfold are_defined. rewrite forallb_forall, Forall_forall. intros h f i. specialize (h f i).
  destruct (nth f values None) as [s |] eqn:e; [| discriminate]. exact (proj1 (entry_exists f s e)).
Qed.

(** What is subtracted is not negative at [x]. *)
Definition harmless (less : option slope) : Prop :=
  match less with Some t => exists e, entry_in bits t e /\ 0 <= at_lambda lambda e | None => True end.

Lemma raised_in : forall less k e, harmless less -> entry_in bits k e ->
  exists e', entry_in bits (raised less k) e' /\ at_lambda lambda e <= at_lambda lambda e'.
Proof.
  intros [t |] k e h he; cbn [raised harmless] in *; [| exists e; split; [exact he | lra]].
  destruct h as [d [hd p]]. destruct (total_in bits _ _ _ _ he hd) as [e' [h1 h2]]. exists e'. rewrite h2. split; [exact h1 | lra].
Qed.

Lemma lowered_in : forall less k e, harmless less -> entry_in bits k e ->
  exists e', entry_in bits (lowered less k) e' /\ at_lambda lambda e' <= at_lambda lambda e.
Proof.
  intros [t |] k e h he; cbn [lowered harmless] in *; [| exists e; split; [exact he | lra]].
  destruct h as [d [hd p]]. destruct (difference_in bits _ _ _ _ he hd) as [e' [h1 h2]]. exists e'. rewrite h2. split; [exact h1 | lra].
Qed.

Lemma dot_self : forall v, 0 <= dot v v.
Proof. induction v as [| a v IH]; cbn [dot]; [lra |]. pose proof (Rle_0_sqr a) as p. unfold Rsqr in p. lra. Qed.

Lemma is_sign_sound : forall less f, harmless less -> is_sign values (length lambda) less f = true -> is_nonneg x f.
Proof.
  intros less f hs h. unfold is_sign in h. destruct (nth f values None) as [s |] eqn:n; [| discriminate].
  destruct (entry_exists f s n) as [d [c [e [k1 k2]]]]. split; [exact d |]. destruct less as [t |].
  - destruct hs as [e' [h1 p]]. destruct (difference_in bits _ _ _ _ k1 h1) as [d' [g1 g2]].
    pose proof (sign_there_sound bits _ _ _ h g1 lambda_in) as q. rewrite g2 in q. rewrite k2. lra.
  - apply Z.leb_le in h. exact (contains_nonneg bits _ _ h c).
Qed.

Lemma mu_slope_in : forall places mu, exists e, entry_in bits (mu_slope places mu) e.
Proof.
  assert (E : forall n places, contains (Arithmetic.dyadic n places (Fixed.integer bits 1)) (IZR n / IZR (2 ^ Z.of_N places) * 1))
    by (intros; apply Arithmetic.dyadic_sound, Fixed.integer_sound).
  intros places [| n ns]; [exists (0, []); apply constant_in, zero_sound |].
  exists (IZR n / IZR (2 ^ Z.of_N places) * 1, map (fun n => IZR n / IZR (2 ^ Z.of_N places) * 1) ns).
  split; [apply E |]. cbn [mu_slope slopes snd]. induction ns; cbn; constructor; auto.
Qed.

Lemma end_there_sound : forall p s, end_there values p = Some s -> all_stand bits lambda s (each (fun i => value x theta (formula_at i)) p).
Proof.
  intros p s h. unfold end_there in h.
  assert (S : forall i s, nth i values None = Some s -> stands bits lambda s (value x theta (formula_at i))).
  { intros i t e. pose proof (enclosed_at i) as H. rewrite e in H. destruct H as [_ [_ H]]. exists (value cs theta (formula_at i)). exact H. }
  destruct (nth (along_x p) values None) eqn:e1; [| discriminate]. destruct (nth (along_y p) values None) eqn:e2; [| discriminate].
  destruct (nth (along_z p) values None) eqn:e3; [| discriminate]. injection h as <-. split; [| split]; apply S; assumption.
Qed.

Lemma shows_sound : forall less t e, harmless less -> shows values (length cell) less t e = true -> holds (length cell) x t.
Proof.
  rewrite <- lambda_length. intros less t e hs h.
  destruct t as [low | high | c2 | f | r low | f g | p p' q q' distance | i k2 | r0 places0 Y0 | distance joints | near_ | row twice a b lever also], e as [| | places Y | places Y | places Y | places Y mu | | | | | | | | places Y | | places Y kappa | e0 ends0 directions0 | | | |];
    cbn [shows holds] in *; try discriminate.
  1-3: apply andb_true_iff in h as [hd h]; split; [exact (are_defined_sound hd) |].
  1-2: eapply over_rows_sound; [| exact h |]; [auto |]; cbn beta; intros s es sm rel pos kappa2 v hk len nz;
    destruct (raised_in less _ _ hs (constant_in bits _ _ hk)) as [e' [he le]];
    pose proof (sigma_min_sound bits _ _ _ _ _ _ _ _ sm he rel lambda_in len nz pos) as S;
    rewrite at_constant in le; pose proof (dot_self v);
    apply Rle_lt_trans with (2 := S), Rmult_le_compat_r; assumption.
  - apply andb_true_iff in h as [z h]. apply andb_true_iff in z as [z1 z2].
    apply Z.eqb_eq in z1, z2. eapply over_rows_sound; [| exact h |]; [auto |]. cbn beta.
    intros s es sm rel pos kappa2 v [k1 k2] len nz. rewrite z1 in k1. rewrite z2 in k2.
    pose proof (unit_R_pos bits). assert (kappa2 = 0) by nra. subst kappa2. rewrite Rmult_0_l.
    apply (rank_energy places Y _ v pos). eapply chords_sound; eassumption.
  - eapply over_rows_sound; [| exact h |]; [auto |]; cbn beta; intros s es sm rel pos k2 v hk len nz;
    destruct (lowered_in less _ _ hs (constant_in bits _ _ hk)) as [e' [he le]];
    pose proof (sigma_max_sound bits _ _ _ _ _ _ sm he rel lambda_in len nz pos) as S;
    rewrite at_constant in le; pose proof (dot_self v);
    apply Rlt_le_trans with (1 := S), Rmult_le_compat_r; assumption.
  - eapply over_rows_sound; [| exact h |]; [auto |]; cbn beta; intros s es sm rel pos k2 v hk len nz;
    destruct (lowered_in less _ _ hs (constant_in bits _ _ hk)) as [e' [he le]];
    pose proof (sigma_max_sound bits _ _ _ _ _ _ sm he rel lambda_in len nz pos) as S;
    rewrite at_constant in le; pose proof (dot_self v);
    apply Rlt_le_trans with (1 := S), Rmult_le_compat_r; assumption.
  - eapply over_rows_sound; [| exact h |]; [auto |]. cbn beta. intros s es sm rel pos c u v hc lu lv nu nv.
    unfold conditioned in sm. apply andb_true_iff in sm as [sm s3]. apply andb_true_iff in sm as [s1 s2].
    destruct (mu_slope_in places mu) as [q hq]. pose proof (positive_there_sound bits _ _ _ s1 hq lambda_in) as p.
    destruct (raised_in less _ _ hs hq) as [e1 [h1 le1]].
    destruct (multiple_in bits _ _ _ _ hc hq) as [q' [hq' eq']]. destruct (lowered_in less _ _ hs hq') as [e2 [h2 le2]].
    rewrite eq' in le2.
    pose proof (sigma_min_sound bits _ _ _ _ _ _ _ _ s2 h1 rel lambda_in lv nv pos) as A.
    pose proof (sigma_max_sound bits _ _ _ _ _ _ s3 h2 rel lambda_in lu nu pos) as B.
    pose proof (energy_nonneg _ u pos) as E0. set (M := map_rows (at_lambda lambda) es) in *. clearbody M.
    set (a := at_lambda lambda q) in *. set (b := at_lambda lambda e1) in *. set (d := at_lambda lambda e2) in *.
    clearbody a b d. unfold nonzero in nu, nv. set (U := dot u u) in *. set (V := dot v v) in *. clearbody U V.
    assert (c0 : 0 < c).
    { apply Rnot_le_lt. intro n. assert (c * a <= 0) by nra. assert (d <= 0) by lra. nra. }
    assert (B' : energy M u < c * a * U) by (apply Rlt_le_trans with (1 := B); apply Rmult_le_compat_r; lra).
    assert (A' : a * V < energy M v) by (apply Rle_lt_trans with (2 := A); apply Rmult_le_compat_r; lra).
    apply Rlt_trans with (c * a * U * V); [apply Rmult_lt_compat_r; assumption |].
    replace (c * a * U * V) with (c * U * (a * V)) by ring. replace (c * energy M v * U) with (c * U * energy M v) by ring.
    apply Rmult_lt_compat_l; [apply Rmult_lt_0_compat |]; assumption.
  - eapply is_sign_sound; eassumption.
  - eapply over_these_sound; [exact h |]. cbn beta. intros s es sm rel pos kappa2 v hk len nz.
    destruct (raised_in less _ _ hs (constant_in bits _ _ hk)) as [e' [he le]].
    pose proof (sigma_min_sound bits _ _ _ _ _ _ _ _ sm he rel lambda_in len nz pos) as S.
    rewrite at_constant in le. pose proof (dot_self v).
    apply Rle_lt_trans with (2 := S), Rmult_le_compat_r; assumption.
  - left. eapply is_sign_sound; eassumption.
  - right. eapply is_sign_sound; eassumption.
  - destruct (end_there values p) as [sp |] eqn:e1; [| discriminate]. destruct (end_there values p') as [sp' |] eqn:e2; [| discriminate].
    destruct (end_there values q) as [sq |] eqn:e3; [| discriminate]. destruct (end_there values q') as [sq' |] eqn:e4; [| discriminate].
    cbv zeta. intros d s t hd d0 h0 h1.
    exact (are_apart_sound bits lambda lambda_in less distance d places Y _ _ _ _ _ _ _ _ h hs hd d0
      (end_there_sound _ _ e1) (end_there_sound _ _ e2) (end_there_sound _ _ e3) (end_there_sound _ _ e4) s t h0 h1).
  - eapply over_these_sound; [exact h |]. cbn beta. intros s es sm rel pos. apply (Solve.solved_sound bits _ _ _ _ _ _ _ _ sm rel lambda_in).
    destruct less as [t |]; [exact hs | exact I].
  - eapply over_these_sound; [exact h |]. cbn beta. intros s es sm rel pos v len nz. eapply chords_sound; eassumption.
  - destruct (slopes_of values row) as [srow |] eqn:er; [| discriminate]. destruct (all_some (map (slopes_of values) twice)) as [sh |] eqn:eh; [| discriminate].
    destruct (slopes_of values (a :: b :: lever_places lever)) as [[| sa [| sb sl]] |] eqn:e4; try discriminate.
    destruct (slopes_of values also) as [sd |] eqn:ed; [| discriminate].
    split; [exact (slopes_defined also sd ed) |].
    assert (S : forall l s, slopes_of values l = Some s -> exists e, Forall2 (entry_in bits) s e /\ map (fun i => value x theta (formula_at i)) l = map (at_lambda lambda) e).
    { intros l s el. destruct (all_some_entries l s el) as [_ E]. rewrite map_map in E. exact E. }
    assert (T : exists H, Forall2 (Forall2 (entry_in bits)) sh H /\ map (map (fun i => value x theta (formula_at i))) twice = map (map (at_lambda lambda)) H).
    { clear h e4. revert sh eh. induction twice as [| l twice IH]; intros sh eh; cbn [map all_some] in eh; [injection eh as <-; exists []; split; [constructor | reflexivity] |].
      destruct (slopes_of values l) as [s |] eqn:el; [| discriminate]. destruct (all_some _) as [sh' |]; [| discriminate]. injection eh as <-.
      destruct (IH _ eq_refl) as [H [H1 H2]]. destruct (S l s el) as [e [k1 k2']]. exists (e :: H). split; [constructor; assumption |]. cbn [map]. congruence. }
    destruct T as [H [hH eqH]]. destruct (S row srow er) as [es [hes eqes]]. rewrite eqH, eqes.
    assert (One : forall i s, nth i values None = Some s -> contains (range s) (value x theta (formula_at i)) /\ exists e, entry_in bits s e /\ value x theta (formula_at i) = at_lambda lambda e).
    { intros i s ei. destruct (entry_exists i s ei) as [_ [c [e [k1 k2']]]]. split; [exact c | exists e; split; assumption]. }
    unfold slopes_of in e4. cbn [map all_some] in e4.
    destruct (nth a values None) as [s1 |] eqn:n1; [| discriminate]. destruct (nth b values None) as [s2 |] eqn:n2; [| discriminate].
    destruct (One _ _ n1) as [c1 _]. destruct (One _ _ n2) as [c2 _].
    destruct lever as [[k2 ls] |]; cbn [lever_places map all_some] in e4.
    + destruct (nth k2 values None) as [s3 |] eqn:n3; [| discriminate]. destruct (nth ls values None) as [s4 |] eqn:n4; [| discriminate]. injection e4 as <- <- <-.
      destruct (One _ _ n3) as [c3 _]. destruct (One _ _ n4) as [_ [e4 [k4 q4]]].
      intros a0 D e v he len nz.
      refine (Curvature.curved_sound bits lambda lambda_in less srow es sh H _ _ _ _ _ h _ hes hH c1 a0 c2 _ e v he len nz).
      * destruct less as [t |]; [exact hs | exact I].
      * exists (value x theta (formula_at k2)), e4. split; [exact c3 |]. split; [exact k4 |]. rewrite <- q4. exact D.
    + injection e4 as <- <- <-. intros a0 _ e v he len nz.
      refine (Curvature.curved_sound bits lambda lambda_in less srow es sh H _ _ _ _ _ h _ hes hH c1 a0 c2 I e v he len nz).
      destruct less as [t |]; [exact hs | exact I].
Qed.
End Cell.

(** ** What is shown with tolerances apart *)

Lemma are_once_sound : forall l, are_once l = true -> NoDup l.
Proof.
  induction l as [| j l IH]; intro h; constructor; cbn [are_once] in h; apply andb_true_iff in h as [h1 h2]; [| exact (IH h2)].
  intro i. apply negb_true_iff in h1. assert (T : existsb (Nat.eqb j) l = true) by (apply existsb_exists; exists j; split; [exact i | apply Nat.eqb_refl]). congruence.
Qed.

Section Apart.
Variables (cell : list fixed) (x lambda : list R).
Hypothesis lambda_length : length lambda = length cell.
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.
Let cs := map (centre_of bits) cell.
Hypothesis coords_hold : forall k, Slope.holds bits lambda (nth k (coords_from 0 cell) (constant zero)) (nth k cs 0) (nth k x 0).
Variable ends : list (nat * Tolerances.choice).
Hypothesis ends_exist : forallb (fun j => Nat.ltb j (length params)) (map fst ends) = true.
Hypothesis ends_once : are_once (map fst ends) = true.

Variables keep own : list bool.
Let values := evaluate_kept keep cell.
Let coords := coords_from 0 cell.
Variable curved : list nat.
Let of := machines values coords own ends curved.

Lemma strides : exists theta0 mss, Forall2 contains (Tolerances.starts_from ends 0 params) theta0 /\ Forall2 contains params theta0 /\
  (forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0) /\ Forall2 (Tolerances.stepped bits) (Tolerances.steps ends params) mss /\
  Forall2 (fun p ms => nth (fst p) theta 0 - nth (fst p) theta0 0 = Tolerances.stride ms) ends mss.
Proof.
  destruct (Tolerances.starts_sound bits ends params theta theta_in 0) as [theta0 [h1 [h2 h3]]]. cbn [Nat.add] in h3.
  pose proof (are_once_sound _ ends_once) as once. rewrite forallb_forall in ends_exist.
  assert (G : forall l, (forall p, In p l -> In p ends) -> exists mss, Forall2 (Tolerances.stepped bits) (map (fun p => snd (Tolerances.start (nth (fst p) params zero) (snd p))) l) mss /\
    Forall2 (fun p ms => nth (fst p) theta 0 - nth (fst p) theta0 0 = Tolerances.stride ms) l mss).
  { induction l as [| [j c] l IH]; intro sub; [exists []; split; constructor |]. destruct IH as [mss [k1 k2]]; [intros p i; apply sub; right; exact i |].
    assert (i : In (j, c) ends) by (apply sub; left; reflexivity).
    specialize (h3 j). rewrite (Tolerances.chosen ends j c once i) in h3.
    destruct h3 as [ms [g1 g2]]; [apply Nat.ltb_lt, ends_exist; exact (in_map fst _ _ i) |].
    exists (ms :: mss). split; constructor; try assumption. cbn [fst]. lra. }
  destruct (G ends (fun p i => i)) as [mss [k1 k2]]. exists theta0, mss. split; [exact h1 |]. split; [exact h2 |]. split; [| split; assumption].
  intros j n. specialize (h3 j). rewrite (Tolerances.not_chosen ends j n) in h3. exact h3.
Qed.

Lemma encloses_all : forall th, Forall2 contains params th -> forall i, encloses bits lambda x cs th (nth i values None) (formula_at i).
Proof.
  intros th h i. apply (nth_related _ _ _ _ (encloses bits lambda x cs th)); [exact I |].
  exact (evaluate_kept_sound bits lambda lambda_in x cs th _ _ coords_hold (params_hold bits lambda params th h) keep tape).
Qed.

(** Of second order too. *)
Lemma all_strides : exists theta0 mss, Forall2 contains (Tolerances.starts_from ends 0 params) theta0 /\ Forall2 contains params theta0 /\
  (forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0) /\ Forall2 (Tolerances.stepped bits) (Second.steps bits ends curved params) mss /\
  map Tolerances.stride mss = Second.differences ends curved theta0 theta.
Proof.
  destruct strides as [theta0 [mss [h0 [h1 [same [hm hd]]]]]]. destruct (Second.steps_sound bits ends curved params theta0 theta mss hm hd) as [mss' [k1 k2]].
  exists theta0, mss'. repeat (split; [assumption |]). exact k2.
Qed.

(** The value of a formula, of a machine that differs so from the one. *)
Definition value_of (mss : list (list (R * R))) (l : list R) (e : Tolerances.multi entry) : R := at_lambda l (Tolerances.moved (fst e) (map Tolerances.stride mss) (snd e)).

Lemma multi_sound : forall theta0 mss i q, Forall2 contains (Tolerances.starts_from ends 0 params) theta0 -> Forall2 contains params theta0 ->
  (forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0) ->
  map Tolerances.stride mss = Second.differences ends curved theta0 theta -> of i = Some q ->
  exists e, Tolerances.multi_in bits q e /\ value x theta (formula_at i) = value_of mss lambda e.
Proof.
  intros theta0 mss i q h0 h1 same hs h. unfold value_of. rewrite hs.
  assert (D : nth i values None <> None -> forall th, Forall2 contains params th -> defined x th (formula_at i)).
  { intros n th hth. pose proof (encloses_all th hth i) as E. destruct (nth i values None); [exact (proj1 (proj2 E)) | contradiction]. }
  unfold of, machines in h. set (one := map constant (Tolerances.starts_from ends 0 params)) in h. destruct curved as [| j0 others] eqn:second; cbv zeta in h.
  - unfold multi_of in h. set (machine := run_kept (option slope) _ _ _ _) in h. set (duals := run_kept Tolerances.dual _ _ _ _) in h.
    destruct (nth i values None) as [sv |] eqn:ev; [| discriminate]. specialize (D ltac:(discriminate)).
    destruct (nth i machine None) as [s0 |] eqn:e0; [| discriminate]. destruct (Tolerances.rates_from 0 ends (nth i duals (None, []))) as [rs |] eqn:er; [| discriminate].
    injection h as <-.
    destruct (Tolerances.mean_value bits (map fst ends) x params theta0 theta (formula_at i) (are_once_sound _ ends_once) h1 theta_in D same) as [th [hth V]].
    assert (M : encloses bits lambda x cs theta0 (nth i machine None) (formula_at i)).
    { apply (nth_related _ _ _ _ (encloses bits lambda x cs theta0)); [exact I |].
      exact (evaluate_kept_sound bits lambda lambda_in x cs theta0 _ _ coords_hold (params_hold bits lambda _ theta0 h0) own tape). }
    rewrite e0 in M. destruct M as [_ [_ [m1 [_ [u [m2 m3]]]]]].
    assert (Q : Tolerances.encloses_rates bits (map fst ends) lambda x cs th (nth i duals (None, [])) (formula_at i)).
    { apply (nth_related _ _ _ _ (Tolerances.encloses_rates bits (map fst ends) lambda x cs th)); [split; [exact I | intros [| p]; exact I] |].
      exact (Tolerances.duals_sound bits coords (map constant params) (map fst ends) lambda x cs th lambda_in coords_hold (params_hold bits lambda params th hth) own tape). }
    destruct Q as [_ Q].
    destruct (Tolerances.rates_from_sound bits lambda (fun j => Tolerances.rate x th j (formula_at i)) (fun j => Tolerances.rate cs th j (formula_at i)) ends _ 0 rs er Q) as [es [k1 k2]].
    exists ((value cs theta0 (formula_at i), u), es). split; [split; [split; assumption | exact k1] |].
    rewrite Tolerances.at_moved, Second.none_of_second_order. cbn [fst snd]. rewrite V. f_equal; [unfold at_lambda; cbn [fst snd]; lra |].
    clear - k2. induction k2 as [| p en l es e k IH]; [reflexivity |].
    cbn [map Tolerances.sum_over fold_right dot]. unfold Tolerances.sum_over in IH. rewrite IH, e. reflexivity.
  - rewrite <- second in *. clear second. unfold second_multi_of in h. set (ones := run_kept Tolerances.dual _ _ _ _) in h. set (alls := run_kept Second.curve _ _ _ _) in h.
    destruct (nth i values None) as [sv |] eqn:ev; [| discriminate]. specialize (D ltac:(discriminate)).
    destruct (fst (nth i ones (None, []))) as [s0 |] eqn:e0; [| discriminate]. destruct (Second.rates_of ends curved _ _) as [rs |] eqn:er; [| discriminate].
    injection h as <-. refine (Second.second_sound bits ends curved lambda x cs params theta0 theta (formula_at i) _ _ s0 rs (are_once_sound _ ends_once) h1 theta_in D same _ _ e0 er).
    + apply (nth_related _ _ _ _ (Tolerances.encloses_rates bits (Second.of_the_one ends curved params) lambda x cs theta0)); [split; [exact I | intros [| p]; exact I] |].
      exact (Tolerances.duals_sound bits coords one _ lambda x cs theta0 lambda_in coords_hold (params_hold bits lambda _ theta0 h0) own tape).
    + intros th hth. apply (nth_related _ _ _ _ (Second.encloses_seconds bits (map fst ends) (Second.pairs ends curved) lambda x cs th)); [split; [split; [exact I | intros [| p]; exact I] | intros [| k]; exact I] |].
      exact (Second.seconds_sound bits coords (map constant params) (map fst ends) _ lambda x cs th lambda_in coords_hold (params_hold bits lambda params th hth) own tape).
Qed.
(** A formula that it is known of is defined. *)
Lemma of_defined : forall i q, of i = Some q -> defined x theta (formula_at i).
Proof.
  intros i q h. pose proof (encloses_all theta theta_in i) as E. unfold of, machines, multi_of, second_multi_of in h.
  destruct curved; cbv zeta in h; (destruct (nth i values None); [exact (proj1 (proj2 E)) | discriminate]).
Qed.

Lemma multis_sound : forall theta0 mss a qs, Forall2 contains (Tolerances.starts_from ends 0 params) theta0 -> Forall2 contains params theta0 ->
  (forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0) ->
  map Tolerances.stride mss = Second.differences ends curved theta0 theta -> all_some (map of a) = Some qs ->
  Forall (defined x theta) (map formula_at a) /\
  exists es, Forall2 (Tolerances.multi_in bits) qs es /\ map (value x theta) (map formula_at a) = map (value_of mss lambda) es.
Proof.
  intros theta0 mss a qs h0 h1 same hs. revert qs. induction a as [| i a IH]; intros qs h; cbn [map all_some] in h.
  - injection h as <-. split; [constructor |]. exists []. split; [constructor | reflexivity].
  - destruct (of i) as [q |] eqn:e; [| discriminate]. destruct (all_some (map of a)) as [qs' |]; [| discriminate]. injection h as <-.
    destruct (IH qs' eq_refl) as [d [es [k1 k2]]]. destruct (multi_sound theta0 mss i q h0 h1 same hs e) as [en [g1 g2]].
    split.
    + cbn [map]. constructor; [| exact d]. exact (of_defined i q e).
    + exists (en :: es). split; [constructor; assumption |]. cbn [map]. rewrite g2, k2. reflexivity.
Qed.

Lemma rows_apart_sound : forall theta0 mss r srs, Forall2 contains (Tolerances.starts_from ends 0 params) theta0 -> Forall2 contains params theta0 ->
  (forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0) ->
  map Tolerances.stride mss = Second.differences ends curved theta0 theta -> rows_apart values of r = Some srs ->
  regular x (map_rows formula_at r) /\
  exists es, Forall2 (fun s e => Forall2 (Tolerances.multi_in bits) (fst s) (fst e) /\ Tolerances.multi_in bits (snd s) (snd e)) srs es /\
    map_rows (value x theta) (map_rows formula_at r) = map (fun e => (map (value_of mss lambda) (fst e), value_of mss lambda (snd e))) es.
Proof.
  intros theta0 mss r srs h0 h1 same hs. revert srs. induction r as [| [a d] r IH]; intros srs h; cbn [rows_apart] in h.
  - injection h as <-. split; [split; constructor |]. exists []. split; [constructor | reflexivity].
  - destruct (all_some (map of a)) as [sa |] eqn:ea; [| discriminate]. destruct (of d) as [sd |] eqn:ed; [| discriminate].
    destruct (nth d values None) as [u |] eqn:eu; [| discriminate]. destruct (rows_apart values of r) as [rest |]; [| discriminate].
    destruct (0 <? lo (range u))%Z eqn:p; [| discriminate]. injection h as <-. apply Z.ltb_lt in p.
    destruct (IH rest eq_refl) as [[R1 R2] [es [k1 k2]]]. destruct (multis_sound theta0 mss a sa h0 h1 same hs ea) as [d1 [e1 [g1 g2]]].
    destruct (multi_sound theta0 mss d sd h0 h1 same hs ed) as [e2 [f1 f2]].
    pose proof (encloses_all theta theta_in d) as E. rewrite eu in E. destruct E as [_ [dd [_ [c2 _]]]]. rewrite !map_rows_cons. split.
    + split; constructor; cbn [fst snd]; auto. exact (contains_positive bits _ _ p c2).
    + exists ((e1, e2) :: es). split; [constructor; [split; assumption | exact k1] |]. cbn [map fst snd]. rewrite <- k2, <- g2, <- f2. reflexivity.
Qed.

(** Vertices decide: of a form of the rows with a constant, and what is subtracted. *)
Lemma vertices_apart : forall mss (srs : list (list (Tolerances.multi slope) * Tolerances.multi slope)) es less el (holds_at : list bool -> fixed -> list (Tolerances.varied fixed) -> bool) c p w v,
  Forall2 (Tolerances.stepped bits) (Second.steps bits ends curved params) mss ->
  Forall2 (fun s e => Forall2 (Tolerances.multi_in bits) (fst s) (fst e) /\ Tolerances.multi_in bits (snd s) (snd e)) srs es -> entry_in bits less el ->
  forallb (fun s => holds_at s (at_vertex s less) (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs)) (signs (length cell)) = true ->
  (forall l l1 l2 a b, (forall e, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> c l = a * c l1 + b * c l2) ->
  (forall s t T i r, length s = length cell -> holds_at s t i = true -> contains t T -> Forall2 (Tolerances.varied_in bits) i r -> 0 < c (map corner s) + p * T + form w r v) ->
  0 < c lambda + p * at_lambda lambda el + form w (map (fun e => (map (value_of mss lambda) (fst e), value_of mss lambda (snd e))) es) v.
Proof.
  intros mss srs es less el holds_at c p w v hm hr he h affine H. rewrite forallb_forall in h.
  set (move := fun e : Tolerances.multi entry => Tolerances.moved (fst e) (map Tolerances.stride mss) (snd e)).
  set (E := map (fun e : list (Tolerances.multi entry) * Tolerances.multi entry => (map move (fst e), move (snd e))) es).
  assert (R0 : forall l, map (fun e : list (Tolerances.multi entry) * Tolerances.multi entry => (map (value_of mss l) (fst e), value_of mss l (snd e))) es = map_rows (at_lambda l) E).
  { intro l. unfold E, map_rows. rewrite map_map. apply map_ext. intros [a d]. cbn [fst snd]. rewrite map_map. reflexivity. }
  rewrite R0. apply (vertices_decide lambda (fun l => c l + p * at_lambda l el + form w (map_rows (at_lambda l) E) v) lambda_in).
  - intros before t after. rewrite (form_affine _ _ _ _ _ (at_lambda_affine before t after)).
    rewrite (affine _ _ _ _ _ (at_lambda_affine before t after)) by field. rewrite (at_lambda_affine before t after el). field.
  - intros s len. rewrite lambda_length in len. apply (H s (at_vertex s less) _ (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs)).
    + exact len.
    + apply h. rewrite <- len. apply signs_all.
    + apply at_vertex_sound, he.
    + rewrite <- R0. eapply map_related; [| exact hr]. intros q e [k1 k2]. exact (Tolerances.varied_at_sound bits s _ q (fst e) (snd e) mss k1 k2 hm).
Qed.
Lemma definite_apart : forall T S v m, match T with Some t => Solve.is_definite bits m t | None => false end = true -> (forall t, T = Some t -> triangle_in bits t S) ->
  length v = m -> nonzero v -> 0 < quad S v.
Proof.
  intros [t |] S v m h hS len nz; [| discriminate]. specialize (hS t eq_refl). unfold Solve.is_definite in h.
  destruct (Nat.eqb_spec (length t) m) as [l |]; [| discriminate]. apply (is_positive_definite_sound bits t S h hS v); [| exact nz].
  rewrite (related_length _ _ _ _ _ hS) in l. congruence.
Qed.

Lemma lower_apart_shows : forall u k K places Y i r v m, match Tolerances.lower_apart bits u places Y i (repeat [neg k] m) with Some t => Solve.is_definite bits m t | None => false end = true ->
  Forall2 (Tolerances.varied_in bits) i r -> contains k K -> length v = m -> nonzero v -> K * dot v v < form (lower_weights places Y v) r v.
Proof.
  intros u k K places Y i r v m h hr hk len nz. destruct (Tolerances.lower_apart bits u places Y i (repeat [neg k] m)) as [t |] eqn:e; [| discriminate].
  destruct (Tolerances.lower_apart_sound bits u places Y i r _ _ t hr (diagonal_in bits _ _ m (neg_sound bits _ _ hk)) e) as [U [hU q]].
  pose proof (definite_apart (Some t) U v m h ltac:(intros t' e'; injection e' as <-; exact hU) len nz) as P. specialize (q v). rewrite <- len, quad_diagonal in q. lra.
Qed.

Lemma upper_apart_shows : forall u k K i r v m, match Tolerances.upper_apart bits u i (repeat [k] m) with Some t => Solve.is_definite bits m t | None => false end = true ->
  Forall2 (Tolerances.varied_in bits) i r -> contains k K -> length v = m -> nonzero v -> forall z, 0 < K * dot v v + form (upper_weights z) r v.
Proof.
  intros u k K i r v m h hr hk len nz z. destruct (Tolerances.upper_apart bits u i (repeat [k] m)) as [t |] eqn:e; [| discriminate].
  destruct (Tolerances.upper_apart_sound bits u i r _ _ t hr (diagonal_in bits _ _ m hk) e) as [U [hU q]].
  pose proof (definite_apart (Some t) U v m h ltac:(intros t' e'; injection e' as <-; exact hU) len nz) as P. specialize (q v z). rewrite <- len, quad_diagonal in q. lra.
Qed.

Theorem shows_apart_sound : forall less t e directions, own = kept (wanted_by t e) tape -> harmless lambda less -> shows_apart values cell less t e ends curved directions = true -> holds (length cell) x t.
Proof.
  intros less t e directions eo hs h. unfold shows_apart in h. cbv zeta in h. rewrite <- eo in h. apply andb_true_iff in h as [_ h].
  destruct all_strides as [theta0 [mss [h0 [h1 [same [hm hd]]]]]].
  assert (L : exists el, entry_in bits match less with Some t => t | None => constant zero end el /\ 0 <= at_lambda lambda el).
  { destruct less as [s |]; [exact hs |]. exists (0, []). split; [apply constant_in, zero_sound | unfold at_lambda; cbn; lra]. }
  destruct L as [el [hel el0]]. set (subtracted := match less with Some t => t | None => constant zero end) in *.
  assert (Still : forall k l l1 l2 a b, (forall e : entry, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> (fun _ : list R => k) l = a * k + b * k).
  { intros k l l1 l2 a b _ s. replace (a * k + b * k) with ((a + b) * k) by ring. rewrite s. ring. }
  (* rows, with what is shown of them at the vertices *)
  assert (Over : forall r (holds_at : list bool -> fixed -> list (Tolerances.varied fixed) -> bool),
    match rows_apart values of r with Some srs => forallb (fun s => holds_at s (at_vertex s subtracted) (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs)) (signs (length cell)) | None => false end = true ->
    regular x (map_rows formula_at r) /\ forall c p w v,
      (forall l l1 l2 a b, (forall e, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> c l = a * c l1 + b * c l2) ->
      (forall s t T i real, length s = length cell -> holds_at s t i = true -> contains t T -> Forall2 (Tolerances.varied_in bits) i real -> length i = length r -> 0 < c (map corner s) + p * T + form w real v) ->
      0 < c lambda + p * at_lambda lambda el + form w (map_rows (value x theta) (map_rows formula_at r)) v).
  { intros r holds_at k. destruct (rows_apart values of r) as [srs |] eqn:er; [| discriminate].
    destruct (rows_apart_sound theta0 mss r srs h0 h1 same hd er) as [reg [es [e1 e2]]]. split; [exact reg |]. intros c p w v affine H. rewrite e2.
    assert (len : length srs = length r) by (rewrite (related_length _ _ _ _ _ e1); rewrite <- (map_length (fun e => (map (value_of mss lambda) (fst e), value_of mss lambda (snd e))) es), <- e2; unfold map_rows; rewrite !map_length; reflexivity).
    apply (vertices_apart mss srs es subtracted el (fun s t i => holds_at s t i && Nat.eqb (length i) (length r)) c p w v hm e1 hel).
    - rewrite forallb_forall in k |- *. intros s hin. rewrite (k s hin). cbn [andb]. apply Nat.eqb_eq. rewrite map_length. exact len.
    - exact affine.
    - intros s t' T i real ls hh ht hr. apply andb_true_iff in hh as [hh hl]. apply Nat.eqb_eq in hl. exact (H s t' T i real ls hh ht hr hl). }
  assert (Each : forall (r : rows nat) (f g : list bool -> fixed -> list (Tolerances.varied fixed) -> bool), (forall s t i, f s t i = true -> g s t i = true) ->
    match rows_apart values of r with Some srs => forallb (fun s => f s (at_vertex s subtracted) (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs)) (signs (length cell)) | None => false end = true ->
    match rows_apart values of r with Some srs => forallb (fun s => g s (at_vertex s subtracted) (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs)) (signs (length cell)) | None => false end = true).
  { intros r f g fg k. destruct (rows_apart values of r) as [srs |]; [| discriminate]. rewrite forallb_forall in *. intros s hin. apply fg, k, hin. }
  assert (Low : forall (bound : list bool -> fixed) K u places Y r v,
    (forall l l1 l2 a b, (forall e : entry, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> K l = a * K l1 + b * K l2) ->
    (forall s, length s = length cell -> contains (bound s) (K (map corner s))) -> length v = length cell -> nonzero v ->
    match rows_apart values of r with Some srs => forallb (fun s => match Tolerances.lower_apart bits u places Y (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs) (repeat [neg (add (bound s) (at_vertex s subtracted))] (length cell)) with
      Some t => Solve.is_definite bits (length cell) t | None => false end) (signs (length cell)) | None => false end = true ->
    regular x (map_rows formula_at r) /\ K lambda * dot v v < energy (map_rows (value x theta) (map_rows formula_at r)) v).
  { intros bound K u places Y r v affine hk len nz k.
    destruct (Over r (fun s t i => match Tolerances.lower_apart bits u places Y i (repeat [neg (add (bound s) t)] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) k) as [reg G].
    split; [exact reg |]. specialize (G (fun l => - (K l * dot v v)) (- dot v v) (lower_weights places Y v) v).
    pose proof (lower_energy places Y _ v (proj2 reg)) as E. pose proof (dot_self v) as d0.
    assert (0 < - (K lambda * dot v v) + - dot v v * at_lambda lambda el + form (lower_weights places Y v) (map_rows (value x theta) (map_rows formula_at r)) v).
    { apply G.
      - intros l l1 l2 a b h3 h4. rewrite (affine l l1 l2 a b h3 h4). ring.
      - intros s t' T i real ls hh ht hr _. pose proof (lower_apart_shows _ _ (K (map corner s) + T) _ _ _ _ _ _ hh hr (add_sound bits _ _ _ _ (hk s ls) ht) len nz). lra. }
    assert (0 <= dot v v * at_lambda lambda el) by (apply Rmult_le_pos; assumption). lra. }
  assert (Up : forall (bound : list bool -> fixed) K u r v,
    (forall l l1 l2 a b, (forall e : entry, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> K l = a * K l1 + b * K l2) ->
    (forall s, length s = length cell -> contains (bound s) (K (map corner s))) -> length v = length cell -> nonzero v ->
    match rows_apart values of r with Some srs => forallb (fun s => match Tolerances.upper_apart bits u (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs) (repeat [sub (bound s) (at_vertex s subtracted)] (length cell)) with
      Some t => Solve.is_definite bits (length cell) t | None => false end) (signs (length cell)) | None => false end = true ->
    regular x (map_rows formula_at r) /\ energy (map_rows (value x theta) (map_rows formula_at r)) v < K lambda * dot v v).
  { intros bound K u r v affine hk len nz k.
    destruct (Over r (fun s t i => match Tolerances.upper_apart bits u i (repeat [sub (bound s) t] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) k) as [reg G].
    split; [exact reg |]. destruct (upper_energy _ v (proj2 reg)) as [z E]. specialize (G (fun l => K l * dot v v) (- dot v v) (upper_weights z) v). pose proof (dot_self v) as d0.
    assert (0 < K lambda * dot v v + - dot v v * at_lambda lambda el + form (upper_weights z) (map_rows (value x theta) (map_rows formula_at r)) v).
    { apply G.
      - intros l l1 l2 a b h3 h4. rewrite (affine l l1 l2 a b h3 h4). ring.
      - intros s t' T i real ls hh ht hr _. pose proof (upper_apart_shows _ _ (K (map corner s) - T) _ _ _ _ hh hr (sub_sound bits _ _ _ _ (hk s ls) ht) len nz z). lra. }
    assert (0 <= dot v v * at_lambda lambda el) by (apply Rmult_le_pos; assumption). lra. }
  assert (Sign : forall f, match of f with Some q => forallb (fun s => forallb (Tolerances.sign_apart (at_vertex s subtracted)) [Tolerances.varied_at bits s (Second.steps bits ends curved params) ([], q)]) (signs (length cell)) | None => false end = true -> is_nonneg x f).
  { intros f k. destruct (of f) as [q |] eqn:ef; [| discriminate]. destruct (multi_sound theta0 mss f q h0 h1 same hd ef) as [en [g1 g2]]. split.
    - exact (of_defined f q ef).
    - rewrite g2. apply Rnot_lt_le. intro neg0.
      set (m := - value_of mss lambda en) in *. assert (m0 : 0 < m) by (unfold m; lra).
      pose proof (vertices_apart mss [([], q)] [([], en)] subtracted el (fun s t i => Nat.eqb (length i) 1 && forallb (Tolerances.sign_apart t) i) (fun _ => m) (-1) [(0, 1)] []
        hm (Forall2_cons (R := fun s e => Forall2 (Tolerances.multi_in bits) (fst s) (fst e) /\ Tolerances.multi_in bits (snd s) (snd e)) ([], q) ([], en) (conj (Forall2_nil _) g1) (Forall2_nil _)) hel) as W.
      specialize (W ltac:(cbn [map length Nat.eqb andb]; exact k) (Still _)). cbn [map form dot fst snd] in W.
      assert (0 < m + -1 * at_lambda lambda el + (0 * 0 + 1 * value_of mss lambda en + 0)); [| unfold m in *; lra].
      apply W. intros s t' T i real _ hh ht hr. apply andb_true_iff in hh as [hl hh]. destruct hr as [| v A i real hv hr]; [discriminate |]. destruct hr; [| discriminate].
      cbn [forallb] in hh. apply andb_true_iff in hh as [hh _]. pose proof (Tolerances.sign_apart_sound bits _ _ _ _ hh hv ht). destruct A as [A0 A1]. cbn [snd form fst] in *.
      replace (dot A0 []) with 0 by (destruct A0; reflexivity). lra. }
  assert (Constant : forall a k, contains a k -> forall s, length s = length cell -> contains ((fun _ : list bool => a) s) ((fun _ : list R => k) (map corner s))) by (intros; assumption).
  destruct t as [low | high | c2 | f | r low | f g | p p' q q' distance | i k2 | r0 places0 Y0 | distance joints | near_ | row twice a b lever also],
    e as [| | places Y | places Y | places Y | places Y mu | | | | | | | | places Y | | places Y kappa | e0 ends0 directions0 | | | |]; try discriminate; try (destruct directions; discriminate).
  - destruct directions as [| u [|]]; try discriminate. apply andb_true_iff in h as [hd' h]. cbn [holds]. split; [exact (are_defined_sound cell x lambda keep (encloses_all theta theta_in) hd') |].
    exists (map_rows formula_at whole). split; [left; reflexivity |].
    assert (Reg : regular x (map_rows formula_at whole)) by exact (proj1 (Over _ (fun s t i => match Tolerances.lower_apart bits (map (Fixed.integer bits) u) places Y i (repeat [neg (add low t)] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) h)).
    split; [exact Reg |]. intros kappa2 v hk len nz. exact (proj2 (Low (fun _ => low) (fun _ => kappa2) _ places Y whole v (Still _) (Constant _ _ hk) len nz h)).
  - destruct directions as [| u [|]]; try discriminate. apply andb_true_iff in h as [hd' h]. apply andb_true_iff in h as [z h]. apply andb_true_iff in z as [z1 z2]. apply Z.eqb_eq in z1, z2.
    cbn [holds]. split; [exact (are_defined_sound cell x lambda keep (encloses_all theta theta_in) hd') |].
    exists (map_rows formula_at whole). split; [left; reflexivity |].
    destruct (Over whole (fun s t i => match Tolerances.lower_apart bits (map (Fixed.integer bits) u) places Y (map Tolerances.without_D i) (repeat [neg t] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) h) as [reg G].
    split; [exact reg |]. intros kappa2 v [k1 k2] len nz. rewrite z1 in k1. rewrite z2 in k2. pose proof (unit_R_pos bits). assert (kappa2 = 0) by nra. subst kappa2. rewrite Rmult_0_l.
    apply (rank_energy places Y _ v (proj2 reg)).
    assert (W : forall w r, form (map (fun p => (fst p, 0)) w) r v = form w (map (fun p => (fst p, 0)) r) v).
    { induction w as [| [a b] w I]; intros [| [A D] r]; cbn [map form fst snd]; try reflexivity. rewrite I. ring. }
    rewrite <- W. specialize (G (fun _ => 0) (- dot v v) (map (fun p => (fst p, 0)) (lower_weights places Y v)) v (Still _)). cbv beta in G.
    pose proof (Rmult_le_pos _ _ (dot_self v) el0). enough (P0 : 0 < 0 + - dot v v * at_lambda lambda el + form (map (fun p => (fst p, 0)) (lower_weights places Y v)) (map_rows (value x theta) (map_rows formula_at whole)) v) by lra. apply G.
    intros s t' T i real _ hh ht hr _. rewrite W.
    assert (hr' : Forall2 (Tolerances.varied_in bits) (map Tolerances.without_D i) (map (fun A => (fst A, 0)) real)) by (eapply map_related; [| exact hr]; intros; apply Tolerances.without_D_sound; assumption).
    pose proof (lower_apart_shows _ _ T _ _ _ _ _ _ hh hr' ht len nz) as P. lra.
  - destruct directions as [| u [|]]; try discriminate. cbn [holds]. exists (map_rows formula_at whole). split; [left; reflexivity |].
    assert (Reg : regular x (map_rows formula_at whole)) by exact (proj1 (Over _ (fun s t i => match Tolerances.upper_apart bits (map (Fixed.integer bits) u) i (repeat [sub high t] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) h)).
    split; [exact Reg |]. intros k v hk len nz. exact (proj2 (Up (fun _ => high) (fun _ => k) _ whole v (Still _) (Constant _ _ hk) len nz h)).
  - destruct directions as [| u0 [| v0 [|]]]; try discriminate. apply andb_true_iff in h as [hp h]. cbn [holds]. exists (map_rows formula_at whole). split; [left; reflexivity |].
    pose (FL := fun (s : list bool) (t : fixed) i => match Tolerances.lower_apart bits (map (Fixed.integer bits) u0) places Y i (repeat [neg (add (at_vertex s (mu_slope places mu)) t)] (length cell)) with
      Some t => Solve.is_definite bits (length cell) t | None => false end).
    pose (FU := fun (s : list bool) (t : fixed) i => match Tolerances.upper_apart bits (map (Fixed.integer bits) v0) i (repeat [sub (mul bits c2 (at_vertex s (mu_slope places mu))) t] (length cell)) with
      Some t => Solve.is_definite bits (length cell) t | None => false end).
    pose proof (Each whole (fun s t i => FL s t i && FU s t i) FL (fun s t i k => proj1 (andb_prop _ _ k)) h) as hl.
    pose proof (Each whole (fun s t i => FL s t i && FU s t i) FU (fun s t i k => proj2 (andb_prop _ _ k)) h) as hu.
    pose proof (proj1 (Over _ FL hl)) as Reg. unfold FL in hl. unfold FU in hu.
    split; [exact Reg |]. intros c u v hc lu lv nu nv. destruct (mu_slope_in places mu) as [q hq]. rewrite <- lambda_length in hp. pose proof (positive_there_sound bits _ _ _ hp hq lambda_in) as p0.
    pose proof (proj2 (Low (fun s => at_vertex s (mu_slope places mu)) (fun l => at_lambda l q) (map (Fixed.integer bits) u0) places Y whole v (fun l l1 l2 a b h3 _ => h3 q) (fun s _ => at_vertex_sound bits s _ _ hq) lv nv hl)) as A.
    assert (B := proj2 (Up (fun s => mul bits c2 (at_vertex s (mu_slope places mu))) (fun l => c * at_lambda l q) (map (Fixed.integer bits) v0) whole u
      ltac:(intros l l1 l2 a b h3 _; cbv beta; rewrite (h3 q); ring) (fun s _ => mul_sound bits _ _ _ _ hc (at_vertex_sound bits s _ _ hq)) lu nu hu)). cbv beta in A, B.
    pose proof (energy_nonneg _ u (proj2 Reg)) as E0. set (M := map_rows (value x theta) (map_rows formula_at whole)) in *. clearbody M. set (a := at_lambda lambda q) in *. clearbody a.
    unfold nonzero in nu, nv. set (U := dot u u) in *. set (V := dot v v) in *. clearbody U V.
    assert (c0 : 0 < c). { apply Rnot_le_lt. intro n. assert (c * a <= 0) by nra. nra. }
    apply Rlt_trans with (c * a * U * V); [apply Rmult_lt_compat_r; assumption |].
    replace (c * a * U * V) with (c * U * (a * V)) by ring. replace (c * energy M v * U) with (c * U * energy M v) by ring.
    apply Rmult_lt_compat_l; [apply Rmult_lt_0_compat |]; assumption.
  - destruct directions; [| discriminate]. exact (Sign f h).
  - destruct directions as [| u [|]]; try discriminate. cbn [holds].
    assert (Reg : regular x (map_rows formula_at r)) by exact (proj1 (Over _ (fun s t i => match Tolerances.lower_apart bits (map (Fixed.integer bits) u) places Y i (repeat [neg (add low t)] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) h)).
    split; [exact Reg |]. intros kappa2 v hk len nz. exact (proj2 (Low (fun _ => low) (fun _ => kappa2) _ places Y r v (Still _) (Constant _ _ hk) len nz h)).
  - destruct directions; [| discriminate]. left. exact (Sign f h).
  - destruct directions; [| discriminate]. right. exact (Sign g h).
  - destruct directions as [| u0 [|]]; try discriminate. apply andb_true_iff in h as [lw h]. apply Nat.eqb_eq in lw. cbn [holds].
    destruct (Over whole (fun s t => Tolerances.solved_apart bits (map (Fixed.integer bits) u0) (length cell) i k2 t places Y) h) as [Reg G]. split; [exact Reg |].
    assert (lr : length (map_rows (value x theta) (map_rows formula_at whole)) = length cell) by (unfold map_rows; rewrite !map_length; exact lw).
    split; [exact lr |]. intros k u hk k0 lu nz. set (R := map_rows (value x theta) (map_rows formula_at whole)) in *. cbv zeta.
    set (q := Solve.weighted_sum u (map (map (Y_value places)) Y)). set (p := Solve.weighted_sum u (map fst R)).
    specialize (G (fun _ => - dot q q) (- dot u u) (Solve.solve_weights i k u) q (Still _)).
    assert (F : 0 < - dot q q + - dot u u * at_lambda lambda el + form (Solve.solve_weights i k u) R q).
    { apply G. intros s t' T i' real _ hh ht hr _. pose proof (Tolerances.solved_apart_sound bits _ _ _ _ k _ T _ _ _ _ u hh hr hk k0 ht ltac:(congruence) nz) as P. cbv zeta in P. fold q in P. lra. }
    rewrite Solve.form_solve in F by congruence. fold p in F. set (B := nth i (map snd R) 0 * nth i u 0 ^ 2) in *.
    pose proof (Linear.dot_self (comb 1 (- 1) p q)) as N. rewrite dot_comb, !(Solve.dot_commutes _ (comb _ _ _ _)), !dot_comb, (Solve.dot_commutes q p) in N.
    assert (0 <= dot u u * at_lambda lambda el) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact el0]). lra.
Qed.

Lemma rows_shown : forall less el r (holds_at : list bool -> fixed -> list (Tolerances.varied fixed) -> bool), entry_in bits less el ->
  match rows_apart values of r with Some srs => forallb (fun s => holds_at s (at_vertex s less) (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs)) (signs (length cell)) | None => false end = true ->
  regular x (map_rows formula_at r) /\ forall c p w v,
    (forall l l1 l2 a b, (forall e, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> c l = a * c l1 + b * c l2) ->
    (forall s t T i real, length s = length cell -> holds_at s t i = true -> contains t T -> Forall2 (Tolerances.varied_in bits) i real -> 0 < c (map corner s) + p * T + form w real v) ->
    0 < c lambda + p * at_lambda lambda el + form w (map_rows (value x theta) (map_rows formula_at r)) v.
Proof.
  intros less el r holds_at hel k. destruct all_strides as [theta0 [mss [h0 [h1 [same [hm hd]]]]]]. destruct (rows_apart values of r) as [srs |] eqn:er; [| discriminate].
  destruct (rows_apart_sound theta0 mss r srs h0 h1 same hd er) as [reg [es [e1 e2]]]. split; [exact reg |]. intros c p w v affine H. rewrite e2.
  exact (vertices_apart mss srs es less el holds_at c p w v hm e1 hel k affine H).
Qed.
Lemma still : forall (k : R) (l l1 l2 : list R) a b, (forall e : entry, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> (fun _ : list R => k) l = a * k + b * k.
Proof. intros k l l1 l2 a b _ s. replace (a * k + b * k) with ((a + b) * k) by ring. rewrite s. ring. Qed.

Section Wedge.
Variables (direction b c : list Z) (n : Z) (places : N).
Hypothesis n_nonneg : (0 <=? n)%Z = true.
Variables (k : nat) (w : list Z) (q : N) (d : list fixed).
Hypothesis w_length : length w = length cell.
Hypothesis k_below : Nat.ltb k (length cell) = true.
Hypothesis regular_there : negb (nth k w 0 =? 0)%Z = true.
Let w' := map (fun x => Arithmetic.dyadic x q (Fixed.integer bits 1)) w.
Let W := map (Y_value q) w.
Let start a := Toward.less_wedge bits k w' b c n places (Toward.squares bits k w' (length cell) a []).
Let in_w := Toward.in_wedge b c.

Lemma w_in : Forall2 contains w' W.
Proof.
  unfold w', W. clear. induction w as [| x l I]; cbn [map]; constructor; [| exact I]. replace (Y_value q x) with (Y_value q x * 1) by ring. apply Arithmetic.dyadic_sound, Fixed.integer_sound.
Qed.
Lemma wedge_reached : forall v, length v = length cell -> exists u, length u = length v /\ Toward.stretched k W u = v.
Proof.
  intros v lv. apply Nat.ltb_lt in k_below. apply Toward.reached; [unfold W; rewrite map_length; congruence | lia |].
  unfold W. change 0 with (IZR 0) at 1. rewrite (nth_indep _ 0 (Y_value q 0)) by (rewrite map_length; lia). rewrite map_nth.
  apply negb_true_iff, Z.eqb_neq in regular_there. unfold Y_value, Rdiv. apply Rmult_integral_contrapositive_currified; [apply not_0_IZR; exact regular_there |].
  apply Rinv_neq_0_compat. pose proof (two_power q). lra.
Qed.
Lemma start_shows : forall a A, contains a A -> exists S, triangle_in bits (start a) S /\
  forall u, length (Toward.stretched k W u) = length cell -> in_w (Toward.stretched k W u) -> quad S u <= A * dot (Toward.stretched k W u) (Toward.stretched k W u).
Proof.
  intros a A h. destruct (Toward.squares_sound bits k w' W w_in (length cell) a A [] [] h ltac:(constructor)) as [S1 [s1 s2]].
  apply Z.leb_le in n_nonneg. destruct (Toward.less_wedge_sound bits k w' W w_in b c n places _ S1 s1 n_nonneg) as [S [t1 t2]]. exists S. split; [exact t1 |].
  intros u lu i. specialize (t2 u i). rewrite (s2 u lu) in t2. cbn [quad] in t2. lra.
Qed.

Lemma lower_wedge_shows : forall a K pl Y i r v, match Toward.lower_toward bits k w' d pl Y i (start (neg a)) with Some t => Solve.is_definite bits (length cell) t | None => false end = true ->
  Forall2 (Tolerances.varied_in bits) i r -> contains a K -> length v = length cell -> nonzero v -> in_w v -> K * dot v v < form (lower_weights pl Y v) r v.
Proof.
  intros a K pl Y i r v h hr ha lv nz iv. destruct (Toward.lower_toward bits k w' d pl Y i (start (neg a))) as [t |] eqn:e; [| discriminate].
  destruct (start_shows _ _ (neg_sound bits _ _ ha)) as [S [s1 s2]].
  destruct (Toward.lower_toward_sound bits k w' W w_in d pl Y i r _ S t hr s1 e) as [U [hU qU]].
  destruct (wedge_reached v lv) as [u [lu eu]]. specialize (qU u). specialize (s2 u). rewrite eu in qU, s2.
  assert (nu : nonzero u) by (apply (Toward.still_nonzero k W); rewrite eu; exact nz).
  pose proof (definite_apart (Some t) U u (length cell) h ltac:(intros t' e'; injection e' as <-; exact hU) ltac:(congruence) nu) as P. specialize (s2 lv iv). lra.
Qed.
Lemma upper_wedge_shows : forall a K i r v, match Toward.upper_toward bits k w' d i (start a) with Some t => Solve.is_definite bits (length cell) t | None => false end = true ->
  Forall2 (Tolerances.varied_in bits) i r -> contains a K -> length v = length cell -> nonzero v -> in_w v -> forall z, 0 < K * dot v v + form (upper_weights z) r v.
Proof.
  intros a K i r v h hr ha lv nz iv z. destruct (Toward.upper_toward bits k w' d i (start a)) as [t |] eqn:e; [| discriminate].
  destruct (start_shows _ _ ha) as [S [s1 s2]].
  destruct (Toward.upper_toward_sound bits k w' W w_in d i r _ S t hr s1 e) as [U [hU qU]].
  destruct (wedge_reached v lv) as [u [lu eu]]. specialize (qU u z). specialize (s2 u). rewrite eu in qU, s2.
  assert (nu : nonzero u) by (apply (Toward.still_nonzero k W); rewrite eu; exact nz).
  pose proof (definite_apart (Some t) U u (length cell) h ltac:(intros t' e'; injection e' as <-; exact hU) ltac:(congruence) nu) as P. specialize (s2 lv iv). lra.
Qed.
End Wedge.

Theorem shows_wedge_sound : forall less t e direction b c n places, own = kept (wanted_by t e) tape -> harmless lambda less -> shows_wedge values cell less t e ends curved direction b c n places = true ->
  holds_along (Toward.in_wedge b c) (length cell) x t.
Proof.
  intros less t e direction b c n places eo hs h. unfold shows_wedge in h. cbv zeta in h. rewrite <- eo in h. destruct (toward_of direction) as [[[k w] q] d].
  apply andb_true_iff in h as [g h]. apply andb_true_iff in g as [g rg]. apply andb_true_iff in g as [g kb]. apply andb_true_iff in g as [g _]. apply andb_true_iff in g as [g n0].
  apply andb_true_iff in g as [g _]. apply andb_true_iff in g as [_ lw]. apply Nat.eqb_eq in lw.
  assert (L : exists el, entry_in bits match less with Some t => t | None => constant zero end el /\ 0 <= at_lambda lambda el).
  { destruct less as [s |]; [exact hs |]. exists (0, []). split; [apply constant_in, zero_sound | unfold at_lambda; cbn; lra]. }
  destruct L as [el [hel el0]]. set (subtracted := match less with Some t => t | None => constant zero end) in *.
  set (w' := map (fun x => Arithmetic.dyadic x q (Fixed.integer bits 1)) w) in *.
  assert (Low : forall low r pl Y, match rows_apart values of r with Some srs => forallb (fun s => match Toward.lower_toward bits k w' d pl Y (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs)
      (Toward.less_wedge bits k w' b c n places (Toward.squares bits k w' (length cell) (neg (add low (at_vertex s subtracted))) [])) with Some t => Solve.is_definite bits (length cell) t | None => false end) (signs (length cell)) | None => false end = true ->
    of_these x (map_rows formula_at r) (fun r => forall kappa2 v, contains low kappa2 -> length v = length cell -> nonzero v -> Toward.in_wedge b c v -> kappa2 * dot v v < energy r v)).
  { intros low r pl Y g1. destruct (rows_shown subtracted el r (fun s t i => match Toward.lower_toward bits k w' d pl Y i
      (Toward.less_wedge bits k w' b c n places (Toward.squares bits k w' (length cell) (neg (add low t)) [])) with Some t => Solve.is_definite bits (length cell) t | None => false end) hel g1) as [R G].
    split; [exact R |]. intros K v hk lv nz iv. pose proof (lower_energy pl Y _ v (proj2 R)) as E. pose proof (dot_self v) as d0.
    specialize (G (fun _ => - (K * dot v v)) (- dot v v) (lower_weights pl Y v) v (still _)). cbv beta in G.
    assert (0 < - (K * dot v v) + - dot v v * at_lambda lambda el + form (lower_weights pl Y v) (map_rows (value x theta) (map_rows formula_at r)) v).
    { apply G. intros s t' T i real ls hh ht hr.
      pose proof (lower_wedge_shows b c n places n0 k w q d lw kb rg (add low t') (K + T) pl Y i real v hh hr (add_sound bits _ _ _ _ hk ht) lv nz iv). lra. }
    assert (0 <= dot v v * at_lambda lambda el) by (apply Rmult_le_pos; assumption). lra. }
  destruct t as [low | high | c2 | f | r low | f f' | p p' q0 q' distance | i k2 | r0 places0 Y0 | distance joints | near_ | row twice a0 b0 lever also], e; try discriminate; cbn [holds_along].
  - apply andb_true_iff in h as [hd' h]. split; [exact (are_defined_sound cell x lambda keep (encloses_all theta theta_in) hd') |]. exact (Low low whole _ _ h).
  - apply andb_true_iff in h as [hd' h]. split; [exact (are_defined_sound cell x lambda keep (encloses_all theta theta_in) hd') |].
    apply andb_true_iff in h as [z h]. apply andb_true_iff in z as [z1 z2]. apply Z.eqb_eq in z1, z2.
    destruct (rows_shown subtracted el whole (fun s t i => match Toward.lower_toward bits k w' d places0 Y (map Tolerances.without_D i)
      (Toward.less_wedge bits k w' b c n places (Toward.squares bits k w' (length cell) (neg t) [])) with Some t => Solve.is_definite bits (length cell) t | None => false end) hel h) as [R G].
    split; [exact R |]. intros kappa2 v [k1 k2] lv nz iv. rewrite z1 in k1. rewrite z2 in k2. pose proof (unit_R_pos bits). assert (kappa2 = 0) by nra. subst kappa2. rewrite Rmult_0_l.
    apply (rank_energy places0 Y _ v (proj2 R)).
    assert (N : forall w r, form (map (fun p => (fst p, 0)) w) r v = form w (map (fun p => (fst p, 0)) r) v).
    { induction w0 as [| [a1 b1] w0 I]; intros [| [A D] r]; cbn [map form fst snd]; try reflexivity. rewrite I. ring. }
    rewrite <- N. specialize (G (fun _ => 0) (- dot v v) (map (fun p => (fst p, 0)) (lower_weights places0 Y v)) v (still _)). cbv beta in G.
    pose proof (Rmult_le_pos _ _ (dot_self v) el0). enough (P0 : 0 < 0 + - dot v v * at_lambda lambda el + form (map (fun p => (fst p, 0)) (lower_weights places0 Y v)) (map_rows (value x theta) (map_rows formula_at whole)) v) by lra. apply G.
    intros s t' T i real _ hh ht hr. rewrite N.
    assert (hr' : Forall2 (Tolerances.varied_in bits) (map Tolerances.without_D i) (map (fun A => (fst A, 0)) real)) by (eapply map_related; [| exact hr]; intros; apply Tolerances.without_D_sound; assumption).
    pose proof (lower_wedge_shows b c n places n0 k w q d lw kb rg t' T places0 Y _ _ v hh hr' ht lv nz iv) as P. lra.
  - destruct (rows_shown subtracted el whole (fun s t i => match Toward.upper_toward bits k w' d i
      (Toward.less_wedge bits k w' b c n places (Toward.squares bits k w' (length cell) (sub high t) [])) with Some t => Solve.is_definite bits (length cell) t | None => false end) hel h) as [R G].
    split; [exact R |]. intros K v hk lv nz iv. destruct (upper_energy _ v (proj2 R)) as [z E]. pose proof (dot_self v) as d0.
    specialize (G (fun _ => K * dot v v) (- dot v v) (upper_weights z) v (still _)). cbv beta in G.
    assert (0 < K * dot v v + - dot v v * at_lambda lambda el + form (upper_weights z) (map_rows (value x theta) (map_rows formula_at whole)) v).
    { apply G. intros s t' T i real ls hh ht hr.
      pose proof (upper_wedge_shows b c n places n0 k w q d lw kb rg (sub high t') (K - T) i real v hh hr (sub_sound bits _ _ _ _ hk ht) lv nz iv z). lra. }
    assert (0 <= dot v v * at_lambda lambda el) by (apply Rmult_le_pos; assumption). lra.
  - exact (Low low r _ _ h).
Qed.

Definition in_part (wedge : option (list Z * list Z * Z * N)) (v : list R) : Prop := match wedge with Some (b, c, _, _) => Toward.in_wedge b c v | None => True end.
Theorem shows_half_sound : forall upper mu q wedge less e direction, own = kept (places_of_rows whole) tape -> entry_in bits mu q -> harmless lambda less ->
  shows_half values cell upper mu wedge less e ends curved direction = true -> half_holds (in_part wedge) (length cell) x upper (at_lambda lambda q).
Proof.
  intros upper mu q wedge less e direction eo hq hs h. unfold shows_half in h. cbv zeta in h. rewrite <- eo in h. apply andb_true_iff in h as [_ h].
  assert (L : exists el, entry_in bits match less with Some t => t | None => constant zero end el /\ 0 <= at_lambda lambda el).
  { destruct less as [s |]; [exact hs |]. exists (0, []). split; [apply constant_in, zero_sound | unfold at_lambda; cbn; lra]. }
  destruct L as [el [hel el0]]. set (subtracted := match less with Some t => t | None => constant zero end) in *.
  assert (Low : forall (P : list R -> Prop) places Y (form_at : fixed -> list (Tolerances.varied fixed) -> option triangle),
    (forall a K i r v, match form_at (neg a) i with Some t => Solve.is_definite bits (length cell) t | None => false end = true -> Forall2 (Tolerances.varied_in bits) i r -> contains a K ->
      length v = length cell -> nonzero v -> P v -> K * dot v v < form (lower_weights places Y v) r v) ->
    match rows_apart values of whole with Some srs => forallb (fun s => match form_at (neg (add (at_vertex s mu) (at_vertex s subtracted))) (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs) with
      Some t => Solve.is_definite bits (length cell) t | None => false end) (signs (length cell)) | None => false end = true ->
    half_holds P (length cell) x None (at_lambda lambda q)).
  { intros P places Y form_at H g. destruct (rows_shown subtracted el whole (fun s t i => match form_at (neg (add (at_vertex s mu) t)) i with Some t => Solve.is_definite bits (length cell) t | None => false end) hel g) as [R G].
    split; [exact R |]. intros v lv nz iv. pose proof (lower_energy places Y _ v (proj2 R)) as E.
    specialize (G (fun l => - (at_lambda l q * dot v v)) (- dot v v) (lower_weights places Y v) v ltac:(intros l l1 l2 a b h3 _; cbv beta; rewrite (h3 q); ring)). cbv beta in G.
    pose proof (Rmult_le_pos _ _ (dot_self v) el0). enough (0 < - (at_lambda lambda q * dot v v) + - dot v v * at_lambda lambda el + form (lower_weights places Y v) (map_rows (value x theta) (map_rows formula_at whole)) v) by lra.
    apply G. intros s t T i real ls hh ht hr. pose proof (H _ _ i real v hh hr (add_sound bits _ _ _ _ (at_vertex_sound bits s _ _ hq) ht) lv nz iv). lra. }
  assert (Up : forall (P : list R -> Prop) c2 (form_at : fixed -> list (Tolerances.varied fixed) -> option triangle),
    (forall a K i r v, match form_at a i with Some t => Solve.is_definite bits (length cell) t | None => false end = true -> Forall2 (Tolerances.varied_in bits) i r -> contains a K ->
      length v = length cell -> nonzero v -> P v -> forall z, 0 < K * dot v v + form (upper_weights z) r v) ->
    match rows_apart values of whole with Some srs => forallb (fun s => match form_at (sub (mul bits c2 (at_vertex s mu)) (at_vertex s subtracted)) (map (Tolerances.varied_at bits s (Second.steps bits ends curved params)) srs) with
      Some t => Solve.is_definite bits (length cell) t | None => false end) (signs (length cell)) | None => false end = true ->
    half_holds P (length cell) x (Some c2) (at_lambda lambda q)).
  { intros P c2 form_at H g. destruct (rows_shown subtracted el whole (fun s t i => match form_at (sub (mul bits c2 (at_vertex s mu)) t) i with Some t => Solve.is_definite bits (length cell) t | None => false end) hel g) as [R G].
    split; [exact R |]. intros v lv nz iv c hc. destruct (upper_energy _ v (proj2 R)) as [z E].
    specialize (G (fun l => c * at_lambda l q * dot v v) (- dot v v) (upper_weights z) v ltac:(intros l l1 l2 a b h3 _; cbv beta; rewrite (h3 q); ring)). cbv beta in G.
    pose proof (Rmult_le_pos _ _ (dot_self v) el0). enough (0 < c * at_lambda lambda q * dot v v + - dot v v * at_lambda lambda el + form (upper_weights z) (map_rows (value x theta) (map_rows formula_at whole)) v) by lra.
    apply G. intros s t T i real ls hh ht hr. pose proof (H _ _ i real v hh hr (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ hc (at_vertex_sound bits s _ _ hq)) ht) lv nz iv z). lra. }
  destruct wedge as [[[[b c] n] pl] |]; cbn [in_part].
  - destruct (toward_of direction) as [[[k w] q0] d]. apply andb_true_iff in h as [g h]. apply andb_true_iff in g as [g rg]. apply andb_true_iff in g as [g kb]. apply andb_true_iff in g as [g _].
    apply andb_true_iff in g as [g n0]. apply andb_true_iff in g as [lw _]. apply Nat.eqb_eq in lw. set (w' := map (fun x => Arithmetic.dyadic x q0 (Fixed.integer bits 1)) w) in *. destruct upper as [c2 |], e; try discriminate.
    + refine (Up _ c2 (fun a i => Toward.upper_toward bits k w' d i (Toward.less_wedge bits k w' b c n pl (Toward.squares bits k w' (length cell) a []))) _ h).
      intros a K i r v g hr ha lv nz iv z. exact (upper_wedge_shows b c n pl n0 k w q0 d lw kb rg a K i r v g hr ha lv nz iv z).
    + refine (Low _ places Y (fun a i => Toward.lower_toward bits k w' d places Y i (Toward.less_wedge bits k w' b c n pl (Toward.squares bits k w' (length cell) a []))) _ h).
      intros a K i r v g hr ha lv nz iv. exact (lower_wedge_shows b c n pl n0 k w q0 d lw kb rg a K places Y i r v g hr ha lv nz iv).
  - destruct upper as [c2 |], e; try discriminate.
    + refine (Up (fun _ => True) c2 (fun a i => Tolerances.upper_apart bits (map (Fixed.integer bits) direction) i (repeat [a] (length cell))) _ h).
      intros a K i r v g hr ha lv nz _ z. exact (upper_apart_shows _ _ K _ _ _ _ g hr ha lv nz z).
    + refine (Low (fun _ => True) places Y (fun a i => Tolerances.lower_apart bits (map (Fixed.integer bits) direction) places Y i (repeat [a] (length cell))) _ h).
      intros a K i r v g hr ha lv nz _. exact (lower_apart_shows _ _ K _ _ _ _ _ _ g hr ha lv nz).
Qed.

Theorem weighted_half_sound : forall upper mu q pl weights less e directions, own = kept (places_of_rows whole) tape -> entry_in bits mu q -> harmless lambda less ->
  weighted_half values cell upper mu pl weights less e ends curved directions = true -> half_holds (fun _ => True) (length cell) x upper (at_lambda lambda q + Weighted.total_at pl theta weights).
Proof.
  intros upper mu q pl weights less e directions eo hq hs h. unfold weighted_half in h. cbv zeta in h. rewrite <- eo in h. apply andb_true_iff in h as [shape h]. apply andb_true_iff in shape as [_ shape].
  apply andb_true_iff in shape as [shape lw]. apply andb_true_iff in shape as [_ ld]. apply Nat.eqb_eq in lw. rewrite forallb_forall in ld.
  destruct all_strides as [theta0 [mss [h0 [h1 [same [hm hd]]]]]]. pose proof (are_once_sound _ ends_once) as once.
  assert (L : exists el, entry_in bits match less with Some t => t | None => constant zero end el /\ 0 <= at_lambda lambda el).
  { destruct less as [s |]; [exact hs |]. exists (0, []). split; [apply constant_in, zero_sound | unfold at_lambda; cbn; lra]. }
  destruct L as [el [hel el0]]. set (subtracted := match less with Some t => t | None => constant zero end) in *.
  set (W := Weighted.total_at pl theta weights). set (W0 := Weighted.total_at pl theta0 weights).
  destruct (total_in bits _ _ _ _ hq (constant_in bits _ _ (Weighted.total_sound bits pl _ theta0 weights h0))) as [q' [hq' eq']]. fold W0 in eq'.
  set (mu' := total mu _) in *. assert (at_q : forall l, at_lambda l q' = at_lambda l q + W0) by (intro l; rewrite eq', at_constant; reflexivity). clear eq'.
  set (nss := map (fun row => map (fun e => Weighted.multiple_for row (fst e)) ends) weights) in *.
  assert (ln : length nss = length whole) by (unfold nss; rewrite map_length; exact lw).
  (* by rows, mu changes by all that it differs by *)
  assert (Changed : forall (real : list (list R * R)), length real = length nss ->
    Weighted.changed (map (fun p => (snd p, dot (map (Y_value pl) (fst p)) (map Tolerances.stride mss))) (combine nss real)) = W - W0).
  { unfold nss, W, W0. clear - hd once same. induction weights as [| row rows IH]; intros [| r real] l; try discriminate; [cbn; ring |].
    cbn [map combine Weighted.changed fold_right fst snd Weighted.total_at]. unfold Weighted.changed, Weighted.total_at in IH. rewrite IH by (cbn in l; congruence). rewrite hd. unfold Second.differences. cbv zeta.
    rewrite <- (app_nil_r (map (Y_value pl) _)), Second.dot_app by (rewrite !map_length; reflexivity). cbn [dot].
    rewrite (Weighted.multiple_changes pl ends theta0 theta row once same). ring. }
  assert (Over : forall (holds_at : list bool -> fixed -> list (Weighted.weighted fixed) -> bool),
    match rows_apart values of whole with Some r => forallb (fun p => Weighted.are_related (fst p) (snd p)) (combine nss r) &&
      forallb (fun s => holds_at s (at_vertex s subtracted) (map (fun p => Weighted.weighted_at bits pl s (Second.steps bits ends curved params) (fst p) (snd p)) (combine nss r))) (signs (length cell)) | None => false end = true ->
    regular x (map_rows formula_at whole) /\ forall c p w v,
      (forall l l1 l2 a b, (forall e, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> c l = a * c l1 + b * c l2) ->
      (forall s t T i real, length s = length cell -> holds_at s t i = true -> contains t T -> Forall2 (Weighted.weighted_in bits) i real -> Weighted.changed real = W - W0 ->
        0 < c (map corner s) + p * T + form w (map fst real) v) ->
      0 < c lambda + p * at_lambda lambda el + form w (map_rows (value x theta) (map_rows formula_at whole)) v).
  { intros holds_at k. destruct (rows_apart values of whole) as [srs |] eqn:er; [| discriminate]. apply andb_true_iff in k as [_ k].
    destruct (rows_apart_sound theta0 mss whole srs h0 h1 same hd er) as [reg [es [e1 e2]]]. split; [exact reg |]. intros c p w v affine H. rewrite e2.
    assert (le : length es = length nss) by (rewrite ln; rewrite <- (map_length (fun e => (map (value_of mss lambda) (fst e), value_of mss lambda (snd e))) es), <- e2; unfold map_rows; rewrite !map_length; reflexivity).
    rewrite forallb_forall in k. set (move := fun e : Tolerances.multi entry => Tolerances.moved (fst e) (map Tolerances.stride mss) (snd e)).
    set (E := map (fun e : list (Tolerances.multi entry) * Tolerances.multi entry => (map move (fst e), move (snd e))) es).
    assert (R0 : forall l, map (fun e : list (Tolerances.multi entry) * Tolerances.multi entry => (map (value_of mss l) (fst e), value_of mss l (snd e))) es = map_rows (at_lambda l) E).
    { intro l. unfold E, map_rows. rewrite map_map. apply map_ext. intros [a d]. cbn [fst snd]. rewrite map_map. reflexivity. }
    rewrite R0. apply (vertices_decide lambda (fun l => c l + p * at_lambda l el + form w (map_rows (at_lambda l) E) v) lambda_in).
    - intros before t after. rewrite (form_affine _ _ _ _ _ (at_lambda_affine before t after)).
      rewrite (affine _ _ _ _ _ (at_lambda_affine before t after)) by field. rewrite (at_lambda_affine before t after el). field.
    - intros s len. rewrite lambda_length in len.
      assert (K : holds_at s (at_vertex s subtracted) (map (fun p => Weighted.weighted_at bits pl s (Second.steps bits ends curved params) (fst p) (snd p)) (combine nss srs)) = true) by (apply k; rewrite <- len; apply signs_all).
      rewrite <- R0. set (at_ := map _ es).
      assert (la : length at_ = length nss) by (unfold at_; rewrite map_length; exact le).
      specialize (H s (at_vertex s subtracted) _ _ (map (fun p => (snd p, dot (map (Y_value pl) (fst p)) (map Tolerances.stride mss))) (combine nss at_)) len K (at_vertex_sound bits s _ _ hel)).
      assert (F : map fst (map (fun p : list Z * (list R * R) => (snd p, dot (map (Y_value pl) (fst p)) (map Tolerances.stride mss))) (combine nss at_)) = at_).
      { rewrite map_map. cbn [fst]. clear - la. revert la. generalize nss. induction at_ as [| a l I]; intros [| n ns] e; try discriminate; [reflexivity |]. cbn [combine map snd]. rewrite I by (cbn in e; congruence). reflexivity. }
      rewrite F in H. apply H; [| apply Changed; exact la]. unfold at_. clear - e1 hm. generalize nss. induction e1 as [| q e srs es [k1 k2] e1 I]; intros [| n ns]; cbn [combine map]; constructor; [| apply I].
      cbn [fst snd]. exact (Weighted.weighted_at_sound bits pl s _ n q (fst e) (snd e) mss k1 k2 hm). }
  pose proof (dot_self) as d0.
  assert (W_in : forall w : list Z, Forall2 contains (map (Fixed.integer bits) w) (map IZR w)) by (induction w; cbn; constructor; auto using integer_sound).
  assert (D : forall T U v, match T with Some t => Solve.is_definite bits (length cell) t | None => false end = true -> (forall t, T = Some t -> triangle_in bits t U) -> length v = length cell -> nonzero v -> 0 < quad U v)
    by (intros T U v; exact (definite_apart T U v (length cell))).
  destruct upper as [c2 |], e as [| | places Y | places Y | places Y | places Y mu0 | | | | | | | | places Y | | places Y kappa | e0 ends0 directions0 | | | |]; try discriminate.
  - destruct directions as [| w [|]]; try discriminate. pose proof (ld w (or_introl eq_refl)) as lwd. apply Nat.eqb_eq in lwd.
    destruct (Over (fun s t i => match Weighted.upper_weighted bits (map (Fixed.integer bits) w) c2 i (repeat [sub (mul bits c2 (at_vertex s mu')) t] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) h) as [R G].
    split; [exact R |]. intros v lv nz _ c hc. destruct (upper_energy _ v (proj2 R)) as [z E].
    specialize (G (fun l => c * (at_lambda l q' + (W - W0)) * dot v v) (- dot v v) (upper_weights z) v ltac:(intros l l1 l2 a b h3 s; cbv beta; rewrite (h3 q'); replace (W - W0) with ((a + b) * (W - W0)) at 1 by (rewrite s; ring); ring)). cbv beta in G.
    assert (P : 0 < c * (at_lambda lambda q' + (W - W0)) * dot v v + - dot v v * at_lambda lambda el + form (upper_weights z) (map_rows (value x theta) (map_rows formula_at whole)) v).
    { apply G. intros s t T i real ls hh ht hr hch. destruct (Weighted.upper_weighted _ _ _ _ _) as [t' |] eqn:eu in hh; [| discriminate].
      destruct (Weighted.upper_weighted_sound bits _ _ c2 c i real _ _ t' (W_in w) hc hr (diagonal_in bits _ _ (length cell) (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ hc (at_vertex_sound bits s _ _ hq')) ht)) eu) as [U [hU qU]].
      pose proof (D (Some t') U v hh ltac:(intros t1 e'; injection e' as <-; exact hU) lv nz) as P. specialize (qU v z ltac:(rewrite map_length; congruence)). rewrite hch in qU. rewrite <- lv, quad_diagonal in qU. lra. }
    rewrite at_q in P. pose proof (Rmult_le_pos _ _ (dot_self v) el0). replace (at_lambda lambda q + W0 + (W - W0)) with (at_lambda lambda q + W) in P by ring. lra.
  - destruct directions as [| w [| d [|]]]; try discriminate. pose proof (ld w (or_introl eq_refl)) as lwd. apply Nat.eqb_eq in lwd. set (across := if forallb _ d then None else _) in h.
    assert (ok : Weighted.may_cross bits across 0).
    { unfold across, Weighted.may_cross. destruct (forallb _ d); [exact I |]. split; [reflexivity |]. exists (map (Y_value 4) d). clear. induction d as [| n d J]; cbn [map]; constructor; [| exact J].
      replace (Y_value 4 n) with (Y_value 4 n * 1) by ring. apply Arithmetic.dyadic_sound, Fixed.integer_sound. }
    destruct (Over (fun s t i => match Weighted.lower_weighted bits (map (Fixed.integer bits) w) across places Y i (repeat [neg (add (at_vertex s mu') t)] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) h) as [R G].
    split; [exact R |]. intros v lv nz _. pose proof (lower_energy places Y _ v (proj2 R)) as E.
    specialize (G (fun l => - ((at_lambda l q' + (W - W0)) * dot v v)) (- dot v v) (lower_weights places Y v) v ltac:(intros l l1 l2 a b h3 s; cbv beta; rewrite (h3 q'); replace (W - W0) with ((a + b) * (W - W0)) at 1 by (rewrite s; ring); ring)). cbv beta in G.
    assert (P : 0 < - ((at_lambda lambda q' + (W - W0)) * dot v v) + - dot v v * at_lambda lambda el + form (lower_weights places Y v) (map_rows (value x theta) (map_rows formula_at whole)) v).
    { apply G. intros s t T i real ls hh ht hr hch. destruct (Weighted.lower_weighted _ _ _ _ _ _ _) as [t' |] eqn:eu in hh; [| discriminate].
      destruct (Weighted.lower_weighted_sound bits _ _ across places Y i real _ _ t' (W_in w) ok hr (diagonal_in bits _ _ (length cell) (neg_sound bits _ _ (add_sound bits _ _ _ _ (at_vertex_sound bits s _ _ hq') ht))) eu) as [U [hU qU]].
      pose proof (D (Some t') U v hh ltac:(intros t1 e'; injection e' as <-; exact hU) lv nz) as P. specialize (qU v ltac:(rewrite map_length; congruence)). rewrite hch in qU. rewrite <- lv, quad_diagonal in qU. lra. }
    rewrite at_q in P. pose proof (Rmult_le_pos _ _ (dot_self v) el0). replace (at_lambda lambda q + W0 + (W - W0)) with (at_lambda lambda q + W) in P by ring. lra.
Qed.
(** Shares of first steps, too, of parameters of second order in the middle. *)
Lemma all_shares : exists theta0 mss z, Forall2 contains (Tolerances.starts_from ends 0 params) theta0 /\ Forall2 contains params theta0 /\
  (forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0) /\ Forall2 (Tolerances.stepped bits) (Second.steps bits ends curved params) mss /\
  map Tolerances.stride mss = Second.differences ends curved theta0 theta /\ (forall p, -1 <= z p <= 1) /\
  Together.are_so bits z (Together.kinds ends curved) (Second.steps bits ends curved params) (map Tolerances.stride mss).
Proof.
  destruct strides as [theta0 [mss [h0 [h1 [same [hm hd]]]]]]. destruct (Second.steps_sound bits ends curved params theta0 theta mss hm hd) as [mss' [k1 k2]]. destruct (Together.shares_sound bits ends curved params theta0 theta mss hm hd) as [z [k3 k4]].
  exists theta0, mss', z. rewrite k2. repeat (split; [assumption |]). split; [reflexivity |]. split; [exact k3 | exact k4].
Qed.
Theorem shows_together_sound : forall r upper mu pl weights less e directions places all, harmless lambda less ->
  shows_together values cell r own upper mu pl weights less e ends curved directions places all = true ->
  of_these x (map_rows formula_at r) (fun M => forall q v, entry_in bits mu q -> length v = length cell -> nonzero v -> let k := at_lambda lambda q + Weighted.total_at pl theta weights in
    match upper with None => k * dot v v < energy M v | Some c2 => forall c, contains c2 c -> energy M v < c * k * dot v v end).
Proof.
  intros r upper mu pl weights less e directions places all hs h. unfold shows_together in h. cbv zeta in h. apply andb_true_iff in h as [shape h]. apply andb_true_iff in shape as [shape _]. apply andb_true_iff in shape as [_ shape].
  apply andb_true_iff in shape as [shape la]. apply andb_true_iff in shape as [shape lw]. apply andb_true_iff in shape as [_ ld]. apply Nat.eqb_eq in lw, la. rewrite forallb_forall in ld.
  destruct all_shares as [theta0 [mss [z [h0 [h1 [same [hm [hd [hz hk]]]]]]]]]. pose proof (are_once_sound _ ends_once) as once.
  assert (L : exists el, entry_in bits match less with Some t => t | None => constant zero end el /\ 0 <= at_lambda lambda el).
  { destruct less as [s |]; [exact hs |]. exists (0, []). split; [apply constant_in, zero_sound | unfold at_lambda; cbn; lra]. }
  destruct L as [el [hel el0]]. set (subtracted := match less with Some t => t | None => constant zero end) in *.
  set (W := Weighted.total_at pl theta weights). set (W0 := Weighted.total_at pl theta0 weights).
  set (mu' := total mu _) in h.
  assert (Mu : forall q, entry_in bits mu q -> exists q', entry_in bits mu' q' /\ forall l, at_lambda l q' = at_lambda l q + W0).
  { intros q hq. destruct (total_in bits _ _ _ _ hq (constant_in bits _ _ (Weighted.total_sound bits pl _ theta0 weights h0))) as [q' [hq' eq']]. exists q'. split; [exact hq' |]. intro l. rewrite eq', at_constant. reflexivity. }
  set (nss := map (fun row => map (fun e => Weighted.multiple_for row (fst e)) ends) weights) in *.
  assert (ln : length nss = length r) by (unfold nss; rewrite map_length; exact lw).
  assert (Changed : forall (real : list (list R * R)), length real = length nss ->
    Weighted.changed (map (fun p => (snd p, dot (map (Y_value pl) (fst p)) (map Tolerances.stride mss))) (combine nss real)) = W - W0).
  { unfold nss, W, W0. clear - hd once same. induction weights as [| row rows IH]; intros [| p real] l; try discriminate; [cbn; ring |].
    cbn [map combine Weighted.changed fold_right fst snd Weighted.total_at]. unfold Weighted.changed, Weighted.total_at in IH. rewrite IH by (cbn in l; congruence). rewrite hd. unfold Second.differences. cbv zeta.
    rewrite <- (app_nil_r (map (Y_value pl) _)), Second.dot_app by (rewrite !map_length; reflexivity). cbn [dot].
    rewrite (Weighted.multiple_changes pl ends theta0 theta row once same). ring. }
  set (steps := Second.steps bits ends curved params) in *. set (kinds := Together.kinds ends curved) in *.
  set (as_rows := fun srs : list (list (Tolerances.multi slope) * Tolerances.multi slope) => map (fun p => (fst p, (fst (snd p), (Together.kinds_for (fst p) kinds 0 (snd (snd p)), snd (snd p))))) (combine all (combine nss srs))).
  set (at_row := fun s (p : list Z * (list Z * (list Together.kind * (list (Tolerances.multi slope) * Tolerances.multi slope)))) => (fst p, Together.grouped_at bits pl s steps (fst (snd p)) (fst (snd (snd p))) (snd (snd (snd p))))).
  assert (Over : forall (holds_at : list bool -> fixed -> list (list Z * Together.grouped) -> bool),
    match rows_apart values of r with Some srs => forallb (fun p => Weighted.are_related (fst p) (snd p)) (combine nss srs) &&
      forallb (fun s => holds_at s (at_vertex s subtracted) (map (at_row s) (as_rows srs))) (signs (length cell)) | None => false end = true ->
    regular x (map_rows formula_at r) /\ forall c p w v,
      (forall l l1 l2 a b, (forall e, at_lambda l e = a * at_lambda l1 e + b * at_lambda l2 e) -> a + b = 1 -> c l = a * c l1 + b * c l2) ->
      (forall s t T i real, length s = length cell -> holds_at s t i = true -> contains t T -> Forall2 (fun i r => Together.grouped_in bits z (snd i) r) i real -> Weighted.changed real = W - W0 ->
        0 < c (map corner s) + p * T + form w (map fst real) v) ->
      0 < c lambda + p * at_lambda lambda el + form w (map_rows (value x theta) (map_rows formula_at r)) v).
  { intros holds_at k. destruct (rows_apart values of r) as [srs |] eqn:er; [| discriminate]. apply andb_true_iff in k as [_ k].
    destruct (rows_apart_sound theta0 mss r srs h0 h1 same hd er) as [reg [es [e1 e2]]]. split; [exact reg |]. intros c p w v affine H. rewrite e2.
    assert (le : length es = length nss) by (rewrite ln; rewrite <- (map_length (fun e => (map (value_of mss lambda) (fst e), value_of mss lambda (snd e))) es), <- e2; unfold map_rows; rewrite !map_length; reflexivity).
    rewrite forallb_forall in k. set (move := fun e : Tolerances.multi entry => Tolerances.moved (fst e) (map Tolerances.stride mss) (snd e)).
    set (E := map (fun e : list (Tolerances.multi entry) * Tolerances.multi entry => (map move (fst e), move (snd e))) es).
    assert (R0 : forall l, map (fun e : list (Tolerances.multi entry) * Tolerances.multi entry => (map (value_of mss l) (fst e), value_of mss l (snd e))) es = map_rows (at_lambda l) E).
    { intro l. unfold E, map_rows. rewrite map_map. apply map_ext. intros [a d]. cbn [fst snd]. rewrite map_map. reflexivity. }
    rewrite R0. apply (vertices_decide lambda (fun l => c l + p * at_lambda l el + form w (map_rows (at_lambda l) E) v) lambda_in).
    - intros before t after. rewrite (form_affine _ _ _ _ _ (at_lambda_affine before t after)).
      rewrite (affine _ _ _ _ _ (at_lambda_affine before t after)) by field. rewrite (at_lambda_affine before t after el). field.
    - intros s len. rewrite lambda_length in len.
      assert (K : holds_at s (at_vertex s subtracted) (map (at_row s) (as_rows srs)) = true) by (apply k; rewrite <- len; apply signs_all).
      rewrite <- R0. set (at_ := map _ es).
      assert (l_at : length at_ = length nss) by (unfold at_; rewrite map_length; exact le).
      specialize (H s (at_vertex s subtracted) _ _ (map (fun p => (snd p, dot (map (Y_value pl) (fst p)) (map Tolerances.stride mss))) (combine nss at_)) len K (at_vertex_sound bits s _ _ hel)).
      assert (F : map fst (map (fun p : list Z * (list R * R) => (snd p, dot (map (Y_value pl) (fst p)) (map Tolerances.stride mss))) (combine nss at_)) = at_).
      { rewrite map_map. cbn [fst]. clear - l_at. revert l_at. generalize nss. induction at_ as [| a l I]; intros [| n ns] e; try discriminate; [reflexivity |]. cbn [combine map snd]. rewrite I by (cbn in e; congruence). reflexivity. }
      rewrite F in H. apply H; [| apply Changed; exact l_at]. unfold at_. assert (lr : length all = length nss) by congruence. clear - e1 hm hk lr. unfold as_rows. revert lr. generalize all, nss.
      induction e1 as [| q e srs es [k1 k2] e1 I]; intros [| l ls] [| n ns] e'; try discriminate; cbn [combine map]; constructor; [| apply I; cbn in e'; congruence].
      cbn [fst snd at_row]. exact (Together.grouped_at_sound bits pl s steps n kinds z l q (fst e) (snd e) mss k1 k2 hm hk). }
  pose proof (dot_self) as d0.
  assert (W_in : forall w : list Z, Forall2 contains (map (Fixed.integer bits) w) (map IZR w)) by (induction w; cbn; constructor; auto using integer_sound).
  assert (D : forall T U v, match T with Some t => Solve.is_definite bits (length cell) t | None => false end = true -> (forall t, T = Some t -> triangle_in bits t U) -> length v = length cell -> nonzero v -> 0 < quad U v)
    by (intros T U v; exact (definite_apart T U v (length cell))).
  assert (Low : forall w across p Y, length w = length cell -> Weighted.may_cross bits across 0 ->
    match rows_apart values of r with Some srs => forallb (fun p => Weighted.are_related (fst p) (snd p)) (combine nss srs) &&
      forallb (fun s => match Together.lower_grouped bits (map (Fixed.integer bits) w) across places p Y (map (at_row s) (as_rows srs)) (repeat [neg (add (at_vertex s mu') (at_vertex s subtracted))] (length cell)) with
        Some t => Solve.is_definite bits (length cell) t | None => false end) (signs (length cell)) | None => false end = true ->
    of_these x (map_rows formula_at r) (fun M => forall q v, entry_in bits mu q -> length v = length cell -> nonzero v -> (at_lambda lambda q + W) * dot v v < energy M v)).
  { intros w across p Y lwd ok g. destruct (Over (fun s t i => match Together.lower_grouped bits (map (Fixed.integer bits) w) across places p Y i (repeat [neg (add (at_vertex s mu') t)] (length cell)) with
      Some t => Solve.is_definite bits (length cell) t | None => false end) g) as [R G].
    split; [exact R |]. intros q v hq lv nz. destruct (Mu q hq) as [q' [hq' at_q]]. pose proof (lower_energy p Y _ v (proj2 R)) as E.
    specialize (G (fun l => - ((at_lambda l q' + (W - W0)) * dot v v)) (- dot v v) (lower_weights p Y v) v ltac:(intros l l1 l2 a b h3 s; cbv beta; rewrite (h3 q'); replace (W - W0) with ((a + b) * (W - W0)) at 1 by (rewrite s; ring); ring)). cbv beta in G.
    assert (P : 0 < - ((at_lambda lambda q' + (W - W0)) * dot v v) + - dot v v * at_lambda lambda el + form (lower_weights p Y v) (map_rows (value x theta) (map_rows formula_at r)) v).
    { apply G. intros s t T i real ls hh ht hr hch. destruct (Together.lower_grouped _ _ _ _ _ _ _ _) as [t' |] eqn:eu in hh; [| discriminate].
      destruct (Together.lower_grouped_sound bits _ _ across places p Y z i real _ _ t' (W_in w) ok hz hr (diagonal_in bits _ _ (length cell) (neg_sound bits _ _ (add_sound bits _ _ _ _ (at_vertex_sound bits s _ _ hq') ht))) eu) as [U [hU qU]].
      pose proof (D (Some t') U v hh ltac:(intros t1 e'; injection e' as <-; exact hU) lv nz) as P. specialize (qU v ltac:(rewrite map_length; congruence) nz). rewrite hch in qU. rewrite <- lv, quad_diagonal in qU. lra. }
    rewrite at_q in P. pose proof (Rmult_le_pos _ _ (dot_self v) el0). replace (at_lambda lambda q + W0 + (W - W0)) with (at_lambda lambda q + W) in P by ring. lra. }
  destruct upper as [c2 |], e as [| | p Y | p Y | p Y | p Y mu0 | | | | | | | | p Y | | p Y kappa | e0 ends0 directions0 | | | |]; try discriminate.
  - destruct directions as [| w [|]]; try discriminate. pose proof (ld w (or_introl eq_refl)) as lwd. apply Nat.eqb_eq in lwd.
    destruct (Over (fun s t i => match Together.upper_grouped bits (map (Fixed.integer bits) w) c2 places i (repeat [sub (mul bits c2 (at_vertex s mu')) t] (length cell)) with Some t => Solve.is_definite bits (length cell) t | None => false end) h) as [R G].
    split; [exact R |]. cbv zeta. intros q v hq lv nz c hc. destruct (Mu q hq) as [q' [hq' at_q]]. destruct (upper_energy _ v (proj2 R)) as [y E].
    specialize (G (fun l => c * (at_lambda l q' + (W - W0)) * dot v v) (- dot v v) (upper_weights y) v ltac:(intros l l1 l2 a b h3 s; cbv beta; rewrite (h3 q'); replace (W - W0) with ((a + b) * (W - W0)) at 1 by (rewrite s; ring); ring)). cbv beta in G.
    assert (P : 0 < c * (at_lambda lambda q' + (W - W0)) * dot v v + - dot v v * at_lambda lambda el + form (upper_weights y) (map_rows (value x theta) (map_rows formula_at r)) v).
    { apply G. intros s t T i real ls hh ht hr hch. destruct (Together.upper_grouped _ _ _ _ _ _) as [t' |] eqn:eu in hh; [| discriminate].
      destruct (Together.upper_grouped_sound bits _ _ c2 c places z i real _ _ t' (W_in w) hc hz hr (diagonal_in bits _ _ (length cell) (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ hc (at_vertex_sound bits s _ _ hq')) ht)) eu) as [U [hU qU]].
      pose proof (D (Some t') U v hh ltac:(intros t1 e'; injection e' as <-; exact hU) lv nz) as P. specialize (qU v y ltac:(rewrite map_length; congruence) nz). rewrite hch in qU. rewrite <- lv, quad_diagonal in qU. lra. }
    rewrite at_q in P. pose proof (Rmult_le_pos _ _ (dot_self v) el0). fold W. replace (at_lambda lambda q + W0 + (W - W0)) with (at_lambda lambda q + W) in P by ring. lra.
  - destruct directions as [| w [| d [|]]]; try discriminate; pose proof (ld w (or_introl eq_refl)) as lwd; apply Nat.eqb_eq in lwd.
    + exact (Low w None p Y lwd I h).
    + refine (Low w _ p Y lwd _ h). unfold Weighted.may_cross. destruct (forallb _ d); [exact I |]. split; [reflexivity |]. exists (map (Y_value 4) d). clear. induction d as [| n d J]; cbn [map]; constructor; [| exact J].
      replace (Y_value 4 n) with (Y_value 4 n * 1) by ring. apply Arithmetic.dyadic_sound, Fixed.integer_sound.
Qed.
(** With no multiples. *)
Lemma no_multiples : forall r, Weighted.total_at 0 theta (unweighted r) = 0.
Proof. unfold unweighted. induction r as [| row r IH]; cbn [map Weighted.total_at fold_right Weighted.multiple_at] in *; [reflexivity |]. unfold Weighted.total_at in IH. rewrite IH. ring. Qed.
End Apart.

Lemma together_holds : forall keep own cell x lambda r upper mu pl weights less e ends curved directions places all, length lambda = length cell -> Forall (fun t => -1 <= t <= 1) lambda ->
  (forall k, Slope.holds bits lambda (nth k (coords_from 0 cell) (constant zero)) (nth k (map (centre_of bits) cell) 0) (nth k x 0)) -> harmless lambda less ->
  shows_together (evaluate_kept keep cell) cell r own upper mu pl weights less e ends curved directions places all = true ->
  of_these x (map_rows formula_at r) (fun M => forall q v, entry_in bits mu q -> length v = length cell -> nonzero v -> let k := at_lambda lambda q + Weighted.total_at pl theta weights in
    match upper with None => k * dot v v < energy M v | Some c2 => forall c, contains c2 c -> energy M v < c * k * dot v v end).
Proof.
  intros keep own cell x lambda r upper mu pl weights less e ends curved directions places all el hlam C hl h. assert (k := h). unfold shows_together in k. cbv zeta in k. do 3 apply andb_true_iff in k as [k _]. apply andb_true_iff in k as [k1 k2].
  exact (shows_together_sound cell x lambda el hlam C ends k1 k2 keep own curved r upper mu pl weights less e directions places all hl h).
Qed.

(** [allowed x]: in the workspace. *)
Variable allowed : list R -> Prop.
Hypothesis inside_sound : forall cell lambda x t, inside cell = Some t -> length lambda = length cell -> allowed x ->
  Forall2 (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell (combine lambda x) ->
  exists e, entry_in bits t e /\ 0 <= at_lambda lambda e.

Lemma enclosed_entry : forall lambda x cs th s f, enclosed bits lambda x cs th s f ->
  defined x th f /\ exists e, entry_in bits s e /\ value x th f = at_lambda lambda e.
Proof.
  intros lambda x cs th s f [_ [d [h1 [h2 [u [h3 h4]]]]]]. split; [exact d |]. exists (value cs th f, u). split; [split; assumption |]. unfold at_lambda. cbn [fst snd]. lra.
Qed.

Lemma all_some_nth : forall (A B C : Type) (f : A -> option B) (g : C -> A) l m, all_some (map (fun i => f (g i)) l) = Some m -> Forall2 (fun i b => f (g i) = Some b) l m.
Proof.
  intros A B C f g. induction l as [| i l IH]; intros m h; cbn [map all_some] in h; [injection h as <-; constructor |].
  destruct (f (g i)) eqn:e; [| discriminate]. destruct (all_some _) as [m' |]; [| discriminate]. injection h as <-. constructor; auto.
Qed.

(** Rows near the cell: how they differ, by slopes. *)
Lemma rows_near : forall near l y x r far ts, (forall i, encloses bits l y x theta (nth i near None) (formula_at i)) ->
  rows_over near r = Some far -> Near.triples far = Some ts ->
  Forall (fun p => Forall (fun i => defined y theta (formula_at i)) (fst p)) r /\
  exists us, Forall2 (fun t u => forall j, Forall2 contains (slopes (Near.entry_of_row t j)) (u j)) ts us /\
  forall w0 w1 w2, let at_ z := map (fun p => map (fun i => value z theta (formula_at i)) (fst p)) r in
    changes (at_ y) (at_ x) [w0; w1; w2] = fold_right (fun u sum => (w0 * dot (u 0%nat) l + w1 * dot (u 1%nat) l + w2 * dot (u 2%nat) l) ^ 2 + sum) 0 us.
Proof.
  intros near l y x. induction r as [| [a d] r IH]; intros far ts E h k; cbn [rows_over] in h.
  - injection h as <-. injection k as <-. split; [constructor |]. exists []. split; [constructor | reflexivity].
  - destruct (all_some (map _ a)) as [sa |] eqn:ea; [| discriminate]. destruct (nth d near None); [| discriminate].
    destruct (rows_over near r) as [rest |]; [| discriminate]. destruct (0 <? lo (range s))%Z; [| discriminate]. injection h as <-.
    cbn [Near.triples] in k. destruct sa as [| s0 [| s1 [| s2 [|]]]]; try discriminate. destruct (Near.triples rest) as [ts' |] eqn:et; [| discriminate]. injection k as <-.
    destruct (IH rest ts' E eq_refl et) as [I1 [us [I2 I3]]].
    pose proof (all_some_nth _ _ _ (fun o => o) (fun i => nth i near None) _ _ ea) as G. cbn beta in G.
    assert (One : forall i s, nth i near None = Some s -> defined y theta (formula_at i) /\ exists u, Forall2 contains (slopes s) u /\
      value y theta (formula_at i) - value x theta (formula_at i) = dot u l).
    { intros i s' e. pose proof (E i) as H. rewrite e in H. destruct H as [_ [dd [_ [_ [u [h1 h2]]]]]]. split; [exact dd |]. exists u. split; assumption. }
    inversion G as [| i0 ? ? ? e0 G1]; subst. inversion G1 as [| i1 ? ? ? e1 G2]; subst. inversion G2 as [| i2 ? ? ? e2 G3]; subst. inversion G3; subst.
    destruct (One _ _ e0) as [d0 [u0 [v0 q0]]], (One _ _ e1) as [d1 [u1 [v1 q1]]], (One _ _ e2) as [d2 [u2 [v2 q2]]].
    split; [constructor; [cbn [fst]; repeat constructor; assumption | exact I1] |].
    exists ((fun j => match j with O => u0 | S O => u1 | _ => u2 end) :: us). split; [constructor; [intros [| [| j]]; assumption | exact I2] |].
    intros w0 w1 w2. cbv zeta in *. cbn [map fst changes fold_right]. rewrite I3. f_equal. rewrite <- q0, <- q1, <- q2. cbn [map dot]. ring.
Qed.

Lemma joints_bounded : forall values lambda x cs, (forall th, Forall2 contains params th -> forall i, encloses bits lambda x cs th (nth i values None) (formula_at i)) ->
  forall joints js bs, all_some (map (joint_over values) joints) = Some js -> Forall2 (may_be_off x) joints bs ->
  exists rs, Forall2 (Near.bounded_by bits) js rs /\ bs = map (Near.off_by lambda) rs.
Proof.
  intros values lambda x cs E joints js bs h k. revert js h. induction k as [| [i [error hs]] b joints bs hb k IH]; intros js h; cbn [map all_some] in h.
  - injection h as <-. exists []. split; constructor.
  - destruct (joint_over values (i, (error, hs))) as [j |] eqn:ej; [| discriminate]. destruct (all_some (map _ joints)) as [js' |]; [| discriminate]. injection h as <-.
    destruct (IH js' eq_refl) as [rs [I1 ->]]. unfold joint_over in ej. cbn [fst snd] in ej. destruct (nth i values None); [| discriminate].
    destruct (all_some (map _ hs)) as [ss |] eqn:es; [| discriminate]. injection ej as <-.
    destruct hb as [th [e [ts [hth [he [hts eb]]]]]]. cbn [fst snd] in *. specialize (E th hth).
    assert (X : exists r, Forall2 (fun h r => (exists a, contains (fst h) a /\ Rabs (fst r) <= a) /\ entry_in bits (snd h) (snd r)) ss r /\
      fold_right (fun p sum => snd p * value x th (formula_at (snd (fst p))) + sum) e (combine hs ts) = fold_right (fun r sum => fst r * at_lambda lambda (snd r) + sum) e r).
    { clear - E hts es. revert ss es. induction hts as [| [f d] y hs ts hy hts IH]; intros ss es; cbn [map all_some combine fold_right fst snd] in *; [injection es as <-; exists []; split; [constructor | reflexivity] |].
      destruct (nth d values None) as [sd |] eqn:ed; [| discriminate]. cbn [option_map] in es. destruct (all_some (map _ hs)) as [ss' |]; [| discriminate]. injection es as <-.
      destruct (IH ss' eq_refl) as [r [r1 r2]]. pose proof (E d) as Ed. rewrite ed in Ed. destruct (enclosed_entry _ _ _ _ _ _ Ed) as [_ [en [k1 k2]]].
      exists ((y, en) :: r). split; [constructor; [split; assumption | exact r1] |]. cbn [fold_right fst snd]. rewrite r2, k2. reflexivity. }
    destruct X as [r [x1 x2]]. exists ((e, r) :: rs). split; [constructor; [split; [exact he | exact x1] | exact I1] |]. cbn [map]. f_equal. rewrite eb, x2. reflexivity.
Qed.

Lemma accuracy_holds : forall keep cell x lambda, length lambda = length cell -> Forall (fun t => -1 <= t <= 1) lambda -> Forall2 contains cell x ->
  (forall th, Forall2 contains params th -> forall i, encloses bits lambda x (map (centre_of bits) cell) th (nth i (evaluate_kept keep cell) None) (formula_at i)) ->
  forall less distance joints places Y kappa, harmless lambda less ->
  shows_there (evaluate_kept keep cell) cell less (Accurate distance joints) (ByAccuracy places Y kappa 0) = true -> (exists d, contains distance d /\ 0 <= d) -> accurate_at x distance joints.
Proof.
  intros keep cell x lambda el hlam hx E less distance joints places Y k hless h [d0 [hd0 d00]]. cbn [shows_there] in h. set (values := evaluate_kept keep cell) in *. cbv zeta in h.
  set (near := Near.evaluate_near bits tape params _ cell distance) in *.
  apply andb_true_iff in h as [h1 h]. apply andb_true_iff in h1 as [l3 _]. apply Nat.eqb_eq in l3.
  destruct (rows_over near divided) as [far |] eqn:efar; [| discriminate]. destruct (rows_over values divided) as [here |] eqn:ehere; [| discriminate].
  destruct (all_some (map (joint_over values) joints)) as [js |] eqn:ejs; [| discriminate]. destruct (Near.triples far) as [ts |] eqn:ets; [| discriminate].
  assert (F : forall d l, contains distance d -> 0 <= d -> length l = 3%nat -> Forall (fun t => -1 <= t <= 1) l ->
    forall i, encloses bits l (Near.moved d x l) x theta (nth i near None) (formula_at i)).
  { intros d l hd d0' ll hl. apply Near.near_encloses; try assumption. congruence. }
  split.
  { intros th hth. specialize (E th hth). pose proof (all_some_nth _ _ _ (fun o => o) (joint_over values) _ _ ejs) as G. clear - E G.
    induction G as [| [i [error hs]] j joints js e G IH]; constructor; [| exact IH]. unfold joint_over in e. cbn [fst snd] in *.
    destruct (nth i values None) as [s |] eqn:n; [| discriminate]. pose proof (E i) as H. rewrite n in H. exact (proj1 (proj2 H)). }
  assert (Spread : exists g, contains (Near.spread bits ts) g /\ 0 <= g).
  { destruct (rows_near near _ _ x divided far ts (F d0 [0; 0; 0] hd0 d00 eq_refl ltac:(repeat constructor; lra)) efar ets) as [_ [us [hus _]]].
    destruct (Near.spread_sound bits ts us 0 0 0 0 0 0 hus) as [g [g1 [g2 _]]]. exists g. split; assumption. }
  destruct (Near.accurate_sound bits lambda ltac:(congruence) hlam less ts here js places Y k h hless Spread) as [kappa [z [a1 [a2 [a3 [a4 a5]]]]]].
  set (g := IZR (hi (Near.spread bits ts)) / unit_R bits) in *. exists g, kappa, z. split; [exact a1 |]. split; [exact a2 |]. split; [exact a3 |]. split; [exact a4 |]. split.
  - intros d l0 l1 l2 hd d1 hl y. destruct (rows_near near _ _ x divided far ts (F d [l0; l1; l2] hd d1 eq_refl hl) efar ets) as [G1 [us [G2 G3]]].
    split; [exact G1 |]. intros w0 w1 w2. specialize (G3 w0 w1 w2). cbv zeta in G3. unfold divided_at. unfold y. rewrite G3. destruct (Near.spread_sound bits ts us w0 w1 w2 l0 l1 l2 G2) as [g' [b1 [b2 b3]]].
    apply Rle_trans with (1 := b3). assert (gg : g' <= g).
    { destruct b1 as [_ b1]. unfold g. pose proof (unit_R_pos bits) as u0. apply Rmult_le_reg_r with (unit_R bits); [exact u0 |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
    apply Rmult_le_compat_r; [| nra]. pose proof (pow2_ge_0 w0). pose proof (pow2_ge_0 w1). pose proof (pow2_ge_0 w2). pose proof (pow2_ge_0 l0). pose proof (pow2_ge_0 l1). pose proof (pow2_ge_0 l2). apply Rmult_le_pos; lra.
  - intros w0 w1 w2 w p.
    destruct (rows_over_sound cell x lambda keep (E theta theta_in) divided here ehere) as [_ [es [r1 r2]]].
    assert (Ap : divided_at x = map fst (map_rows (at_lambda lambda) es)).
    { rewrite <- r2. unfold divided_at, map_rows. rewrite !map_map. apply map_ext. intros [a d]. cbn [fst snd]. rewrite map_map. reflexivity. }
    specialize (a5 es r1). cbv zeta in a5. rewrite <- Ap in a5. destruct (a5 w0 w1 w2) as [c1 c2]. split; [exact c1 |]. intros bs s hb nz.
    destruct (joints_bounded values lambda x _ E joints js bs ejs hb) as [rs [q1 ->]]. exact (c2 rs s q1 nz).
Qed.

Lemma located_holds : forall keep cell x lambda, length lambda = length cell -> Forall (fun t => -1 <= t <= 1) lambda -> Forall2 contains cell x ->
  (forall th, Forall2 contains params th -> forall i, encloses bits lambda x (map (centre_of bits) cell) th (nth i (evaluate_kept keep cell) None) (formula_at i)) ->
  forall less a places Y kappa q, harmless lambda less ->
  shows_there (evaluate_kept keep cell) cell less (Located a) (ByAccuracy places Y kappa q) = true -> located_at (length cell) x a.
Proof.
  intros keep cell x lambda el hlam hx E less a places Y k q hless h. cbn [shows_there] in h. cbv zeta in h. set (values := evaluate_kept keep cell) in *. set (near := near_values cell a) in *.
  set (m := length cell) in *. set (f := Nearby.l_first a) in *.
  apply andb_true_iff in h as [h body]. apply andb_true_iff in h as [h dv]. apply andb_true_iff in h as [h dn]. apply andb_true_iff in h as [h rowlen]. apply andb_true_iff in h as [lf lfar].
  apply Nat.leb_le in lf. apply Nat.eqb_eq in lfar. rewrite forallb_forall in dv, dn, rowlen.
  destruct (all_some (map (slopes_of near) (Nearby.l_far a))) as [far |] eqn:efar; [| discriminate]. destruct (rows_over values (Nearby.l_rows a)) as [here |] eqn:ehere; [| discriminate].
  destruct (all_some (map (joint_over values) (Nearby.l_joints a))) as [js |] eqn:ejs; [| discriminate]. pose proof (unit_R_pos bits) as u0.
  assert (lx : length x = m) by (symmetry; exact (related_length _ _ _ _ _ hx)).
  unfold located_at. cbv zeta. fold f. split.
  { intros th hth. apply Forall_forall. intros i ii. specialize (dv i ii). pose proof (E th hth i) as Ei. destruct (nth i values None) as [s |]; [exact (proj1 (proj2 Ei)) | discriminate]. }
  split; [exact lf |]. split; [exact lfar |]. split; [apply Forall_forall; intros row ir; apply Nat.eqb_eq, rowlen, ir |].
  intros d tau hd ht d0 t0.
  assert (N : forall u, Spread.inside f m u -> forall i, encloses bits u (near_at x a d tau u) (x ++ repeat 0 (m - f)) theta (nth i near None) (formula_at i)).
  { intros u hu i. apply (nth_related _ _ _ _ (encloses bits u (near_at x a d tau u) (x ++ repeat 0 (m - f)) theta)); [exact I |].
    apply (evaluate_kept_sound bits u (Spread.inside_ends f m u hu)); [exact (Spread.near_cell_holds bits f m cell x d tau (Nearby.l_distance a) (Nearby.l_turn a) u hd ht d0 t0 hx eq_refl lf hu) | apply params_hold, theta_in]. }
  pose proof (all_some_nth _ _ _ (fun o => o) (slopes_of near) _ _ efar) as FAR.
  assert (ROW : forall row sl, slopes_of near row = Some sl -> Forall2 (fun i s => nth i near None = Some s) row sl)
    by (intros row sl e; exact (all_some_nth _ _ _ (fun o => o) (fun i => nth i near None) _ _ e)).
  assert (S : forall u, Spread.inside f m u -> exists us, Forall2 (Forall2 (fun s v => Forall2 contains (slopes s) v)) far us /\ forall w,
    Forall2 (fun ab r => dot (fst ab) w - dot (snd ab) w = dot w (Twofold.image r u)) (combine (far_at x a d tau u) (far_at x a d tau (Twofold.nought m))) us).
  { intros u hu. specialize (N u hu). unfold far_at, near_at in *. fold f in N |- *. rewrite (Spread.near_point_centre f m x d tau lx lf). clear - N FAR ROW.
    induction FAR as [| row sl rows far hr h [us [I1 I2]]]; [exists []; split; [constructor | intro; constructor] |]. cbn beta in hr. apply ROW in hr.
    assert (One : exists v, Forall2 (fun s v => Forall2 contains (slopes s) v) sl v /\ forall w,
      dot (map (fun i => value (Spread.near_point f x d tau u) theta (formula_at i)) row) w - dot (map (fun i => value (x ++ repeat 0 (m - f)) theta (formula_at i)) row) w = dot w (Twofold.image v u)).
    { clear - N hr. induction hr as [| i s row sl hi h [v [v1 v2]]]; [exists []; split; [constructor | intros [| ? ?]; cbn; ring] |].
      pose proof (N i) as Ni. rewrite hi in Ni. destruct Ni as [_ [_ [_ [_ [v0 [w1 w2]]]]]]. exists (v0 :: v). split; [constructor; assumption |].
      intros [| t w]; cbn [map dot Twofold.image]; [ring |]. specialize (v2 w). unfold Twofold.image in v2. rewrite <- w2. lra. }
    destruct One as [v [v1 v2]]. exists (v :: us). split; [constructor; assumption |]. intro w. cbn [map combine]. constructor; [apply v2 | apply I2]. }
  assert (hz : Spread.inside f m (Twofold.nought m)) by (split; [apply Twofold.nought_length | pose proof (Twofold.nought_norm f m); lra]).
  assert (Spread_ : exists g, contains (Spread.spread bits m f far) g /\ 0 <= g).
  { destruct (S _ hz) as [us [s1 _]]. destruct (Spread.spread_sound bits m f far us s1) as [g' [g1 [g2 _]]]. exists g'. split; assumption. }
  split.
  { intro ang. unfold Nearby.located in body. cbv zeta in body. apply andb_true_iff in body as [body _]. apply andb_true_iff in body as [_ slow]. rewrite ang in slow. cbn [negb orb] in slow.
    apply andb_true_iff in slow as [slow1 slow2]. rewrite forallb_forall in slow1, slow2. split.
    - intros u v hu hv. specialize (N u hu). unfold far_at. clear - N FAR ROW slow1 hd d0 hv.
      induction FAR as [| row sl rows far hr h IH]; cbn [map]; constructor; [| apply IH; intros y iy; apply slow1; right; exact iy].
      cbn beta in hr. apply ROW in hr. specialize (slow1 sl (or_introl eq_refl)).
      destruct (Nearby.total_of_sound bits sl (map (fun i => value (near_at x a d tau u) theta (formula_at i)) row)) as [n [n1 [n0 n2]]].
      { clear - N hr. induction hr as [| i s row sl hi h IH]; cbn [map]; constructor; [| exact IH]. pose proof (N i) as Ni. rewrite hi in Ni. exact (proj1 (proj2 (proj2 (proj2 Ni)))). }
      pose proof (Nearby.is_less_sound bits _ _ _ _ slow1 hd n1) as L. specialize (n2 v hv). rewrite Rabs_mult, (Rabs_pos_eq d) by exact d0. apply Rle_lt_trans with (2 := L). apply Rmult_le_compat_l; assumption.
    - pose proof (all_some_nth _ _ _ (fun o => o) (joint_over values) _ _ ejs) as G. clear - G E slow2 hd d0.
      induction G as [| [i [error hs]] j joints js e G IH]; constructor; [| apply IH; intros y iy; apply slow2; right; exact iy].
      specialize (slow2 j (or_introl eq_refl)). intros th ts hth hts. cbn [snd] in *. specialize (E th hth). cbn beta in e. unfold joint_over in e. cbn [fst snd] in e. destruct (nth i values None); [| discriminate].
      destruct (all_some _) as [ss |] eqn:es; [| discriminate]. injection e as <-. cbn [snd] in slow2. pose proof (all_some_nth _ _ _ (fun o => o) (fun h : fixed * nat => option_map (pair (fst h)) (nth (snd h) values None)) _ _ es) as K.
      destruct (Nearby.total_off_sound bits ss ts (map (fun h => value x th (formula_at (snd h))) hs)) as [n [n1 [n0 n2]]].
      { clear - K hts. revert ts hts. induction K as [| h s hs ss e K IH]; intros ts hts; inversion hts as [| ? t ? ts' h1 h2]; subst; constructor; [| exact (IH _ h2)]. destruct (nth (snd h) values None); [| discriminate]. injection e as <-. exact h1. }
      { clear - K E. induction K as [| h s hs ss e K IH]; cbn [map]; constructor; [| exact IH]. pose proof (E (snd h)) as Eh. destruct (nth (snd h) values None); [| discriminate]. injection e as <-. exact (proj1 (proj2 (proj2 (proj2 Eh)))). }
      pose proof (Nearby.is_less_sound bits _ _ _ _ slow2 hd n1) as L. rewrite Rabs_mult, (Rabs_pos_eq d) by exact d0. apply Rle_lt_trans with (2 := L). apply Rmult_le_compat_l; assumption. }
  destruct (Nearby.located_sound bits m lambda el hlam less a far here js places Y k q body hless Spread_) as [kappa [z [e [a1 [a2 [a3 [a4 [a5 [a6 [a7 a8]]]]]]]]]].
  set (g := IZR (hi (Spread.spread bits m f far)) / unit_R bits) in *. exists g. split; [exact a1 |]. split.
  - intros u hu. split.
    + apply Forall_forall. intros i ii. specialize (dn i ii). pose proof (N u hu i) as Ni. destruct (nth i near None) as [s |]; [exact (proj1 (proj2 Ni)) | discriminate].
    + intros w _. destruct (S u hu) as [us [s1 s2]]. destruct (Spread.spread_sound bits m f far us s1) as [g' [b1 [b2 b3]]].
      apply Rle_trans with (1 := b3 _ _ w u (proj1 hu) (s2 w) ltac:(unfold far_at; rewrite !map_length; reflexivity)). apply Rmult_le_compat_r; [apply Rmult_le_pos; apply Twofold.norm_nonneg |].
      destruct b1 as [_ b1]. unfold g. apply Rmult_le_reg_r with (unit_R bits); [exact u0 |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
  - exists kappa, z, e. repeat (split; [assumption |]). intros w lw. cbv zeta.
    destruct (rows_over_sound cell x lambda keep (E theta theta_in) (Nearby.l_rows a) here ehere) as [_ [es [r1 r2]]]. rewrite r2.
    specialize (a8 es r1). cbv zeta in a8. destruct (a8 w lw) as [c1 c2]. split; [exact c1 |]. intros bs s hb nz.
    destruct (joints_bounded values lambda x _ E (Nearby.l_joints a) js bs ejs hb) as [rs [q1 ->]]. exact (c2 rs s q1 nz).
Qed.

(** Where nothing is subtracted. *)
Theorem shows_holds : forall keep cell x t e, Forall2 contains cell x -> shows (evaluate_kept keep cell) (length cell) None t e = true -> holds (length cell) x t.
Proof.
  intros keep cell x t e hx h. destruct (coords_from_hold bits cell x hx) as [lambda [el [hlam [_ C]]]]. specialize (C []). cbn [app length] in C.
  apply (shows_sound cell x lambda el hlam keep) with None e; [| exact I | exact h]. intro i.
  apply (nth_related _ _ _ _ (encloses bits lambda x (map (centre_of bits) cell) theta)); [exact I |].
  exact (evaluate_kept_sound bits lambda hlam x (map (centre_of bits) cell) theta _ _ C (params_hold bits lambda params theta theta_in) keep tape).
Qed.

Lemma kept_holds : forall keep cell x t e, Forall2 contains cell x -> allowed x ->
  shows_on (evaluate_kept keep cell) cell t e = true -> holds (length cell) x t.
Proof.
  intros keep cell x t e hx ok h. destruct (coords_from_hold bits cell x hx) as [lambda [el [hlam [hd C]]]].
  specialize (C []). cbn [app length] in C.
  pose proof (evaluate_kept_sound bits lambda hlam x (map (centre_of bits) cell) theta _ _ C
    (params_hold bits lambda params theta theta_in) keep tape) as S.
  assert (K : forall less e, harmless lambda less -> shows_there (evaluate_kept keep cell) cell less t e = true -> holds (length cell) x t).
  { intros less e' hl k.
    assert (Other : shows (evaluate_kept keep cell) (length cell) less t e' = true -> holds (length cell) x t).
    { clear k. intro k. apply (shows_sound cell x lambda el hlam keep) with less e'; [| exact hl | exact k].
    intro i. apply (nth_related _ _ _ _ (encloses bits lambda x (map (centre_of bits) cell) theta)); [exact I | exact S]. }
    assert (Each : forall th, Forall2 contains params th -> forall i, encloses bits lambda x (map (centre_of bits) cell) th (nth i (evaluate_kept keep cell) None) (formula_at i));
      [| destruct t; try exact (Other k); (destruct e'; try exact (Other k)); cbn [holds];
         [destruct q as [| q]; [| exact (Other k)]; exact (accuracy_holds keep cell x lambda el hlam hx Each less _ _ _ _ _ hl k) | exact (located_holds keep cell x lambda el hlam hx Each less _ _ _ _ _ hl k)]].
    intros th hth i. apply (nth_related _ _ _ _ (encloses bits lambda x (map (centre_of bits) cell) th)); [exact I |].
    exact (evaluate_kept_sound bits lambda hlam x (map (centre_of bits) cell) th _ _ C (params_hold bits lambda params th hth) keep tape). }
  assert (Apart : forall less e ends curved directions, harmless lambda less -> shows_within (evaluate_kept keep cell) cell less t e ends curved directions = true -> holds (length cell) x t).
  { intros less e' ends curved directions hl k.
    assert (Own : shows_apart (evaluate_kept keep cell) cell less t e' ends curved directions = true -> holds (length cell) x t).
    { clear k. intro k. assert (k' := k). unfold shows_apart in k'. cbv zeta in k'. apply andb_true_iff in k' as [k' _]. apply andb_true_iff in k' as [k' _].
      apply andb_true_iff in k' as [k1 k2]. exact (shows_apart_sound cell x lambda el hlam C ends k1 k2 keep _ curved less t e' directions eq_refl hl k). }
    destruct e' as [| | | | | | | | | | | | | | | | | | | | e' places all]; try exact (Own k). clear Own. cbn [shows_within] in k. cbv zeta in k.
    assert (Low : forall r a, shows_together (evaluate_kept keep cell) cell r (kept (wanted_by t e') tape) None (constant a) 0 (unweighted r) less e' ends curved directions places all = true ->
      of_these x (map_rows formula_at r) (fun M => forall y v, contains a y -> length v = length cell -> nonzero v -> y * dot v v < energy M v)).
    { intros r a g. destruct (together_holds keep _ cell x lambda r None _ _ _ less e' ends curved directions places all el hlam C hl g) as [R G]. split; [exact R |]. intros y v hy lv nz.
      specialize (G (y, []) v (constant_in bits _ _ hy) lv nz). cbv zeta in G. rewrite at_constant, no_multiples, Rplus_0_r in G. exact G. }
    destruct t as [low | high | c2 | f | r low | f g | p p' q q' distance | i k2 | r0 places0 Y0 | distance joints | near_ | row twice a b lever also]; try discriminate; destruct directions as [| w [|]]; try discriminate.
    - apply andb_true_iff in k as [kd k]. cbn [holds]. split; [apply (are_defined_sound cell x lambda keep); [| exact kd]; intro i; apply (nth_related _ _ _ _ (encloses bits lambda x (map (centre_of bits) cell) theta)); [exact I | exact S] |].
      exists (map_rows formula_at whole). split; [left; reflexivity | exact (Low _ _ k)].
    - cbn [holds]. exists (map_rows formula_at whole). split; [left; reflexivity |].
      destruct (together_holds keep _ cell x lambda whole _ _ _ _ less e' ends curved [w] places all el hlam C hl k) as [R G]. split; [exact R |]. intros y v hy lv nz.
      specialize (G (y, []) v (constant_in bits _ _ hy) lv nz 1 (Fixed.integer_sound bits 1)). rewrite at_constant, no_multiples, Rplus_0_r, Rmult_1_l in G. exact G.
    - exact (Low _ _ k). }
  assert (Tangent : forall tangent n places, inside cell = Some tangent -> (0 <=? n)%Z = true -> harmless lambda (Some (dyadic_slope n places tangent))).
  { intros tangent n places i n0. destruct (inside_sound _ _ _ _ i el ok hd) as [d [h1 h2]].
    destruct (dyadic_in bits n places _ _ h1) as [d' [g1 g2]]. exists d'. split; [exact g1 |]. rewrite g2.
    apply Z.leb_le, IZR_le in n0. pose proof (two_power places) as p.
    apply Rmult_le_pos; [| exact h2]. apply Rmult_le_pos; [exact n0 | apply Rlt_le, Rinv_0_lt_compat, p]. }
  destruct e as [| | | | | | | | | e' n places | | | | | | | e' ends curved directions | | | |]; try (apply (K None _ I h)).
  - cbn [shows_on] in h. destruct (inside cell) as [tangent |] eqn:i; [| discriminate h]. apply andb_true_iff in h as [n0 h].
    exact (K _ _ (Tangent tangent n places eq_refl n0) h).
  - unfold shows_on in h. destruct e' as [| | | | | | | | | e' n places | | | | | | | e' ends' curved' directions' | | | |]; try (exact (Apart None _ _ _ _ I h)).
    destruct (inside cell) as [tangent |] eqn:i; [| discriminate h]. apply andb_true_iff in h as [n0 h].
    exact (Apart _ _ _ _ _ (Tangent tangent n places eq_refl n0) h).
Qed.

Lemma tangent_harmless : forall lambda k p tangent d, (0 <=? k)%Z = true -> entry_in bits tangent d -> 0 <= at_lambda lambda d -> harmless lambda (Some (dyadic_slope k p tangent)).
Proof.
  intros lambda k p tangent d n0 h1 h2. destruct (dyadic_in bits k p _ _ h1) as [d' [g1 g2]]. exists d'. split; [exact g1 |]. rewrite g2.
  apply Z.leb_le, IZR_le in n0. pose proof (two_power p) as p0.
  apply Rmult_le_pos; [| exact h2]. apply Rmult_le_pos; [exact n0 | apply Rlt_le, Rinv_0_lt_compat, p0].
Qed.
Lemma along_holds : forall keep cell x t b c n places e, Forall2 contains cell x -> allowed x ->
  shows_along (evaluate_kept keep cell) cell t b c n places e = true -> holds_along (Toward.in_wedge b c) (length cell) x t.
Proof.
  intros keep cell x t b c n places e hx ok h. destruct (coords_from_hold bits cell x hx) as [lambda [el [hlam [hd C]]]]. specialize (C []). cbn [app length] in C.
  assert (One : forall less e ends curved direction, harmless lambda less -> shows_wedge (evaluate_kept keep cell) cell less t e ends curved direction b c n places = true ->
    holds_along (Toward.in_wedge b c) (length cell) x t).
  { intros less e' ends curved direction hl k. assert (k' := k). unfold shows_wedge in k'. cbv zeta in k'. destruct (toward_of direction) as [[[k0 w] q] d].
    apply andb_true_iff in k' as [k' _]. do 6 apply andb_true_iff in k' as [k' _]. apply andb_true_iff in k' as [k1 k2].
    exact (shows_wedge_sound cell x lambda el hlam C ends k1 k2 keep _ curved less t e' direction b c n places eq_refl hl k). }
  assert (Tangent : forall k p f, match inside cell with Some tangent => (0 <=? k)%Z && f (Some (dyadic_slope k p tangent)) | None => false end = true ->
    exists less, harmless lambda less /\ f less = true).
  { intros k p f g. destruct (inside cell) as [tangent |] eqn:i; [| discriminate]. apply andb_true_iff in g as [n0 g]. exists (Some (dyadic_slope k p tangent)). split; [| exact g].
    destruct (inside_sound _ _ _ _ i el ok hd) as [d [h1 h2]]. exact (tangent_harmless lambda k p tangent d n0 h1 h2). }
  unfold shows_along in h. destruct e as [| | | | | | | | | e k p | | | | | | | e ends curved directions | | | |]; try (exact (One None _ _ _ _ I h)).
  - destruct (Tangent k p (fun less => shows_wedge (evaluate_kept keep cell) cell less t e [] [] (map (fun _ => 0%Z) cell) b c n places) h) as [less [hl g]]. exact (One less _ _ _ _ hl g).
  - destruct e as [| | | | | | | | | e k p | | | | | | | | | | |]; try (destruct directions as [| v [|]]; try discriminate; exact (One None _ _ _ _ I h)).
    destruct directions as [| v [|]]; try discriminate. destruct (Tangent k p (fun less => shows_wedge (evaluate_kept keep cell) cell less t e ends curved v b c n places) h) as [less [hl g]]. exact (One less _ _ _ _ hl g).
Qed.

(** The same of a bound of a condition number, with [mu] at the point, which is that of [lambda]. *)
Lemma half_on_holds : forall keep cell x lambda upper mu q wedge e, entry_in bits mu q -> length lambda = length cell -> Forall (fun t => -1 <= t <= 1) lambda -> allowed x ->
  Forall2 (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell (combine lambda x) ->
  (forall k, Slope.holds bits lambda (nth k (coords_from 0 cell) (constant zero)) (nth k (map (centre_of bits) cell) 0) (nth k x 0)) ->
  half_on (evaluate_kept keep cell) cell upper mu wedge e = true -> half_holds (in_part wedge) (length cell) x upper (at_lambda lambda q).
Proof.
  intros keep cell x lambda upper mu q wedge e hq el hlam ok hd C h.
  assert (One : forall less e ends curved direction, harmless lambda less -> half_within (evaluate_kept keep cell) cell upper mu wedge less e ends curved direction = true -> half_holds (in_part wedge) (length cell) x upper (at_lambda lambda q)).
  { intros less e' ends curved direction hl k.
    assert (Own : shows_half (evaluate_kept keep cell) cell upper mu wedge less e' ends curved direction = true -> half_holds (in_part wedge) (length cell) x upper (at_lambda lambda q)).
    { clear k. intro k. assert (k' := k). unfold shows_half in k'. cbv zeta in k'. apply andb_true_iff in k' as [k' _]. apply andb_true_iff in k' as [k' _]. apply andb_true_iff in k' as [k1 k2].
      exact (shows_half_sound cell x lambda el hlam C ends k1 k2 keep _ curved upper mu q wedge less e' direction eq_refl hq hl k). }
    destruct e' as [| | | | | | | | | | | | | | | | | | | | e' places all]; try exact (Own k). cbn [half_within] in k. destruct wedge; [discriminate |].
    destruct (together_holds keep _ cell x lambda whole upper mu _ _ less e' ends curved [direction] places all el hlam C hl k) as [R G]. split; [exact R |]. intros v lv nz _.
    specialize (G q v hq lv nz). cbv zeta in G. rewrite no_multiples, Rplus_0_r in G. exact G. }
  assert (Tangent : forall k p f, match inside cell with Some tangent => (0 <=? k)%Z && f (Some (dyadic_slope k p tangent)) | None => false end = true ->
    exists less, harmless lambda less /\ f less = true).
  { intros k p f g. destruct (inside cell) as [tangent |] eqn:i; [| discriminate]. apply andb_true_iff in g as [n0 g]. exists (Some (dyadic_slope k p tangent)). split; [| exact g].
    destruct (inside_sound _ _ _ _ i el ok hd) as [d [h1 h2]]. exact (tangent_harmless lambda k p tangent d n0 h1 h2). }
  unfold half_on in h. cbv zeta in h. destruct e as [| | | | | | | | | e k p | | | | | | | e ends curved directions | | | |]; try (exact (One None _ _ _ _ I h)).
  - destruct (Tangent k p (fun less => half_within (evaluate_kept keep cell) cell upper mu wedge less e [] [] (map (fun _ => 0%Z) cell)) h) as [less [hl g]]. exact (One less _ _ _ _ hl g).
  - destruct e as [| | | | | | | | | e k p | | | | | | | | | | |]; try (destruct directions as [| v [|]]; try discriminate; exact (One None _ _ _ _ I h)).
    destruct directions as [| v [|]]; try discriminate. destruct (Tangent k p (fun less => half_within (evaluate_kept keep cell) cell upper mu wedge less e ends curved v) h) as [less [hl g]]. exact (One less _ _ _ _ hl g).
Qed.

Lemma weighted_half_on_holds : forall keep cell x lambda upper mu q pl weights e, entry_in bits mu q -> length lambda = length cell -> Forall (fun t => -1 <= t <= 1) lambda -> allowed x ->
  Forall2 (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell (combine lambda x) ->
  (forall k, Slope.holds bits lambda (nth k (coords_from 0 cell) (constant zero)) (nth k (map (centre_of bits) cell) 0) (nth k x 0)) ->
  weighted_half_on (evaluate_kept keep cell) cell upper mu pl weights e = true -> half_holds (fun _ => True) (length cell) x upper (at_lambda lambda q + Weighted.total_at pl theta weights).
Proof.
  intros keep cell x lambda upper mu q pl weights e hq el hlam ok hd C h.
  assert (One : forall less e ends curved directions, harmless lambda less -> weighted_within (evaluate_kept keep cell) cell upper mu pl weights less e ends curved directions = true ->
    half_holds (fun _ => True) (length cell) x upper (at_lambda lambda q + Weighted.total_at pl theta weights)).
  { intros less e' ends curved directions hl k.
    assert (Own : weighted_half (evaluate_kept keep cell) cell upper mu pl weights less e' ends curved directions = true -> half_holds (fun _ => True) (length cell) x upper (at_lambda lambda q + Weighted.total_at pl theta weights)).
    { clear k. intro k. assert (k' := k). unfold weighted_half in k'. cbv zeta in k'. apply andb_true_iff in k' as [k' _]. apply andb_true_iff in k' as [k' _]. apply andb_true_iff in k' as [k1 k2].
      exact (weighted_half_sound cell x lambda el hlam C ends k1 k2 keep _ curved upper mu q pl weights less e' directions eq_refl hq hl k). }
    destruct e' as [| | | | | | | | | | | | | | | | | | | | e' places all]; try exact (Own k). cbn [weighted_within] in k.
    assert (k' : shows_together (evaluate_kept keep cell) cell whole (kept (places_of_rows whole) tape) upper mu pl weights less e' ends curved directions places all = true)
      by (destruct upper; destruct directions as [| w [| d [|]]]; try discriminate; exact k).
    destruct (together_holds keep _ cell x lambda whole upper mu _ _ less e' ends curved directions places all el hlam C hl k') as [R G]. split; [exact R |]. intros v lv nz _. exact (G q v hq lv nz). }
  assert (Tangent : forall k p f, match inside cell with Some tangent => (0 <=? k)%Z && f (Some (dyadic_slope k p tangent)) | None => false end = true ->
    exists less, harmless lambda less /\ f less = true).
  { intros k p f g. destruct (inside cell) as [tangent |] eqn:i; [| discriminate]. apply andb_true_iff in g as [n0 g]. exists (Some (dyadic_slope k p tangent)). split; [| exact g].
    destruct (inside_sound _ _ _ _ i el ok hd) as [d [h1 h2]]. exact (tangent_harmless lambda k p tangent d n0 h1 h2). }
  unfold weighted_half_on in h. cbv zeta in h. destruct e as [| | | | | | | | | e k p | | | | | | | e ends curved directions | | | |]; try (exact (One None _ _ _ _ I h)).
  - destruct (Tangent k p (fun less => weighted_within (evaluate_kept keep cell) cell upper mu pl weights less e [] [] match upper with None => [map (fun _ => 0%Z) cell; map (fun _ => 0%Z) cell] | Some _ => [map (fun _ => 0%Z) cell] end) h) as [less [hl g]].
    exact (One less _ _ _ _ hl g).
  - destruct e as [| | | | | | | | | e k p | | | | | | | | | | |]; try (exact (One None _ _ _ _ I h)).
    destruct (Tangent k p (fun less => weighted_within (evaluate_kept keep cell) cell upper mu pl weights less e ends curved directions) h) as [less [hl g]]. exact (One less _ _ _ _ hl g).
Qed.

Lemma evaluate_holds : forall cell x t e, Forall2 contains cell x -> allowed x -> shows_on (evaluate cell) cell t e = true -> holds (length cell) x t.
Proof. intros cell x t e hx ok h. rewrite <- evaluate_all in h. exact (kept_holds [] cell x t e hx ok h). Qed.

Lemma outside_none : forall cell x, Forall2 contains cell x -> allowed x -> is_outside cell = true -> False.
Proof.
  intros cell x hx ok h. destruct (coords_from_hold bits cell x hx) as [lambda [el [hlam [hd _]]]].
  unfold is_outside in h. destruct (inside cell) as [tangent |] eqn:i; [| discriminate].
  destruct (inside_sound _ _ _ _ i el ok hd) as [d [h1 h2]]. rewrite <- el in h.
  pose proof (negative_there_sound bits _ _ _ h h1 hlam). lra.
Qed.

End Precision.

(** ** Steps; [open] has the tests that are not discharged yet *)

(** What accuracy says of one machine is about all others, too, and so is not shown of the machines of a half. *)
Definition is_of_each (t : test) : bool := match t with Accurate _ _ | Located _ => false | _ => true end.
Lemma holds_of_each : forall bits tape whole divided partial params theta all m x t, is_of_each t = true ->
  holds bits tape whole divided partial params theta m x t -> holds bits tape whole divided partial all theta m x t.
Proof. intros bits tape whole divided partial params theta all m x [] e h; try exact h; discriminate. Qed.

Section Steps.
Variable bits : positive.
Local Notation contains := (contains bits).
Variable tape : list (op address).
Variables whole divided : rows nat.
Variable partial : list nat.
Variable params : list fixed.
Variable tests : list test.
Variable inside : list fixed -> option slope.
Local Notation evaluate_kept keep cell := (Check.evaluate_kept bits tape params keep cell).
Local Notation wanted_by := (wanted_by whole divided partial).
Local Notation is_outside cell := (Check.is_outside inside cell).

(** Formulas that do not change with the scale of the parameters [J]. *)
Definition is_level (degrees : list (option Z)) (i : nat) : bool := match nth i degrees None with Some 0%Z => true | _ => false end.
(** Those that are defined for each of them, or for none. *)
Definition has_degree (degrees : list (option Z)) (i : nat) : bool := match nth i degrees None with Some _ => true | None => false end.
Definition are_level (t : test) (J : list nat) : bool :=
  let all l := let degrees := Scale.degrees J tape in
    forallb (has_degree degrees) partial && forallb (is_level degrees) (places_of_rows whole ++ places_of_rows divided ++ l) in
  match t with
  | SigmaMin _ | SigmaMax _ | Conditioning _ | Solved _ _ => all []
  | AtLeast f => all [f]
  | Either f g => all [f; g]
  | Least r _ => all (places_of_rows r)
  | Apart _ _ _ _ _ | Chords _ _ _ | Accurate _ _ | Located _ | Curved _ _ _ _ _ _ => false
  end.
Definition is_point (a : fixed) : bool := (lo a =? hi a)%Z.
Definition may_scale (t : test) (groups : list (list nat)) (ones : list nat) : bool :=
  is_of_each t && forallb (fun j => is_point (nth j (fold_left Scale.of_one_scale groups params) zero)) ones && forallb (are_level t) groups.
Definition scaled_values (groups : list (list nat)) (cell : list fixed) (t : test) (e : evidence) : list (option slope) :=
  Check.evaluate_kept bits tape (fold_left Scale.of_one_scale groups params) (kept (wanted_by t e) tape) cell.
(** Of one form of the rows, the same for all parts of a fan. *)
Definition shows_part (of_divided : bool) (values : list (option slope)) (cell : list fixed) (t : test) (wedge : list Z * list Z) (part : list Z * Z * N * evidence) : bool :=
  let '(_, n, places, e) := part in
  let r := if of_divided then divided else whole in let about e := if of_divided then of_rows_alone e else e in
  match e with
  | OfOneScale groups ones e => may_scale t groups ones &&
      shows_along bits tape r divided partial (fold_left Scale.of_one_scale groups params) inside (scaled_values groups cell t e) cell t (fst wedge) (snd wedge) n places (about e)
  | _ => shows_along bits tape r divided partial params inside values cell t (fst wedge) (snd wedge) n places (about e)
  end.
Definition half_of (values : list (option slope)) (cell : list fixed) (t : test) (upper : option fixed) (mu : slope) (wedge : option (list Z * list Z * Z * N)) (e : evidence) : bool :=
  match e with
  | OfOneScale groups ones e => may_scale t groups ones &&
      half_on bits tape whole (fold_left Scale.of_one_scale groups params) inside (scaled_values groups cell t e) cell upper mu wedge e
  | _ => half_on bits tape whole params inside values cell upper mu wedge e
  end.
Definition between_shows (values : list (option slope)) (cell : list fixed) (t : test) (upper : option fixed) (mu : slope) (e : evidence) : bool :=
  match e with
  | ByFan parts => negb (Nat.eqb (length parts) 0) && forallb (fun p => let '(_, n, places, e) := snd p in half_of values cell t upper mu (Some (fst (fst p), snd (fst p), n, places)) e)
      (combine (Toward.wedges (map (fun p => fst (fst (fst p))) parts)) parts)
  | _ => half_of values cell t upper mu None e
  end.
(** Of one scale alike, or one of them alone is. *)
Fixpoint are_same {A : Type} (same : A -> A -> bool) (l m : list A) : bool :=
  match l, m with [], [] => true | a :: l', b :: m' => same a b && are_same same l' m' | _, _ => false end.
Definition groups_of_scale (e : evidence) : option (list (list nat)) := match e with OfOneScale groups _ _ => Some groups | _ => None end.
Definition are_alike (e f : evidence) : bool := match groups_of_scale e, groups_of_scale f with Some g, Some h => are_same (are_same Nat.eqb) g h | _, _ => true end.
(** By parameters that have no range then, too, [mu] is more with a row that depends on them. *)
Definition depends_op (j : nat) (o : op bool) : bool :=
  match o with
  | Coord _ | Integer _ => false
  | Param i => Nat.eqb i j
  | Neg a | Sqr a | Sqrt a => a
  | Add a b | Sub a b | Mul a b | Div a b => a || b
  | Elbow _ a b t => a || b || t
  end.
Definition are_of_rows (ones : list nat) (weights : list (list (nat * Z))) : bool :=
  forallb (fun p => forallb (fun q => negb (Second.is_in (fst q) ones) || (let known := run bool false (depends_op (fst q)) tape in existsb (fun i => nth i known false) (places_of_rows [snd p]))) (fst p))
    (combine weights whole).
Definition weighted_of (values : list (option slope)) (cell : list fixed) (t : test) (upper : option fixed) (mu : slope) (places : N) (weights : list (list (nat * Z))) (e : evidence) : bool :=
  match e with
  | OfOneScale groups ones e => may_scale t groups ones && are_of_rows ones weights &&
      weighted_half_on bits tape whole (fold_left Scale.of_one_scale groups params) inside (scaled_values groups cell t e) cell upper mu places weights e
  | _ => weighted_half_on bits tape whole params inside values cell upper mu places weights e
  end.
Definition shows_step (values : list (option slope)) (cell : list fixed) (t : test) (e : evidence) : bool :=
  match e with
  | OfOneScale groups ones e => may_scale t groups ones &&
      shows_on bits tape whole divided partial (fold_left Scale.of_one_scale groups params) inside (scaled_values groups cell t e) cell t e
  | ByFan parts => negb (Nat.eqb (length parts) 0) && (negb (is_of_divided e) || is_of_rows t) &&
      forallb (fun p => shows_part (is_of_divided e) values cell t (fst p) (snd p)) (combine (Toward.wedges (map (fun p => fst (fst (fst p))) parts)) parts)
  | ByBetween places mu weights lower upper =>
      match t with
      | Conditioning c2 => let mu := mu_slope bits places mu in
          match weights with
          | [] => positive_there (length cell) mu && between_shows values cell t None mu lower && between_shows values cell t (Some c2) mu upper
          | _ => positive_there (length cell) (total mu (constant (Weighted.total_of places params weights))) && are_alike lower upper &&
              weighted_of values cell t None mu places weights lower && weighted_of values cell t (Some c2) mu places weights upper
          end
      | _ => false
      end
  | _ => shows_on bits tape whole divided partial params inside values cell t e
  end.

Fixpoint clear (i : nat) (open : list bool) : list bool :=
  match open, i with
  | [], _ => []
  | _ :: l, O => false :: l
  | b :: l, S j => b :: clear j l
  end.

Fixpoint discharge (values : list (option slope)) (cell : list fixed) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  match steps with
  | [] => Some open
  | (_, Outside) :: rest => if is_outside cell then discharge values cell rest (map (fun _ => false) open) else None
  | (i, e) :: rest =>
      match nth i open false, nth_error tests i with
      | true, Some t => if shows_step values cell t e then discharge values cell rest (clear i open) else None
      | _, _ => None
      end
  end.

Definition wanted_at (steps : list (nat * evidence)) : list nat :=
  flat_map (fun s => match snd s, nth_error tests (fst s) with Outside, _ | OfOneScale _ _ _, _ | _, None => [] | e, Some t => wanted_by t e end) steps.

Definition steps_on (cell : list fixed) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  match steps with [] => Some open | _ => discharge (evaluate_kept (kept (wanted_at steps) tape) cell) cell steps open end.

Section OneScale.
Variables (x theta scaled : list R) (s : R) (J : list nat).
Hypothesis s_positive : 0 < s.
Hypothesis is_scaled : forall j, nth j scaled 0 = (if Scale.is_in J j then s else 1) * nth j theta 0.
Local Notation formula_at := (Check.formula_at tape).

Lemma level_sound : forall i, is_level (Scale.degrees J tape) i = true -> defined x scaled (formula_at i) ->
  defined x theta (formula_at i) /\ value x scaled (formula_at i) = value x theta (formula_at i).
Proof.
  intros i h d. pose proof (Scale.degrees_sound x theta scaled s J s_positive is_scaled tape i) as H. unfold is_level in h.
  destruct (nth i (Scale.degrees J tape) None) as [[| |] |]; try discriminate. destruct (H d) as [d' v]. split; [exact d' |].
  change (powerRZ s 0) with 1 in v. rewrite Rmult_1_l in v. exact v.
Qed.
Lemma degree_defined : forall i, has_degree (Scale.degrees J tape) i = true -> defined x scaled (formula_at i) -> defined x theta (formula_at i).
Proof.
  intros i h d. pose proof (Scale.degrees_sound x theta scaled s J s_positive is_scaled tape i) as H. unfold has_degree in h.
  destruct (nth i (Scale.degrees J tape) None); [exact (proj1 (H d)) | discriminate].
Qed.
Lemma all_level : forall l, (forall i, In i l -> is_level (Scale.degrees J tape) i = true) -> Forall (defined x scaled) (map formula_at l) ->
  Forall (defined x theta) (map formula_at l) /\ map (value x scaled) (map formula_at l) = map (value x theta) (map formula_at l).
Proof.
  induction l as [| i l IH]; intros h d; [split; [constructor | reflexivity] |]. cbn [map] in *. inversion d as [| ? ? d1 d2]; subst.
  destruct (level_sound i (h i (or_introl eq_refl)) d1) as [e1 e2]. destruct (IH (fun j k => h j (or_intror k)) d2) as [f1 f2]. split; [constructor; assumption | congruence].
Qed.
Lemma rows_level : forall r, (forall i, In i (places_of_rows r) -> is_level (Scale.degrees J tape) i = true) -> regular scaled x (map_rows formula_at r) ->
  regular theta x (map_rows formula_at r) /\ map_rows (value x scaled) (map_rows formula_at r) = map_rows (value x theta) (map_rows formula_at r).
Proof.
  intros r h [d p]. assert (G : Forall (fun p => Forall (defined x theta) (fst p) /\ defined x theta (snd p)) (map_rows formula_at r) /\
      map_rows (value x scaled) (map_rows formula_at r) = map_rows (value x theta) (map_rows formula_at r)).
  { clear p. induction r as [| [a f] r IH]; [split; [constructor | reflexivity] |]. rewrite map_rows_cons in *. inversion d as [| ? ? [d1 d2] d3]; subst. cbn [fst snd] in *.
    destruct (all_level a (fun i k => h i (in_or_app _ _ _ (or_introl (in_or_app _ _ _ (or_introl k))))) d1) as [a1 a2].
    destruct (level_sound f (h f ltac:(apply in_or_app; left; apply in_or_app; right; left; reflexivity)) d2) as [f1 f2].
    destruct (IH (fun i k => h i (in_or_app _ _ _ (or_intror k))) d3) as [r1 r2]. split; [constructor; [split; assumption | exact r1] |]. rewrite !map_rows_cons. congruence. }
  destruct G as [G1 G2]. split; [split; [exact G1 | rewrite <- G2; exact p] | exact G2].
Qed.

Lemma holds_level : forall ps ps' m t, are_level t J = true -> holds bits tape whole divided partial ps scaled m x t -> holds bits tape whole divided partial ps' theta m x t.
Proof.
  intros ps ps' m t h H.
  assert (All : forall l, forallb (has_degree (Scale.degrees J tape)) partial && forallb (is_level (Scale.degrees J tape)) (places_of_rows whole ++ places_of_rows divided ++ l) = true ->
    (forall i, In i partial -> has_degree (Scale.degrees J tape) i = true) /\ (forall i, In i (places_of_rows whole) -> is_level (Scale.degrees J tape) i = true) /\
    (forall i, In i (places_of_rows divided) -> is_level (Scale.degrees J tape) i = true) /\ (forall i, In i l -> is_level (Scale.degrees J tape) i = true)).
  { intros l k. apply andb_true_iff in k as [p k]. rewrite forallb_forall in p, k. split; [exact p |]. split; [| split]; intros i hi; apply k; repeat rewrite in_app_iff; tauto. }
  assert (These : forall r bound, (forall i, In i (places_of_rows r) -> is_level (Scale.degrees J tape) i = true) ->
    of_these scaled x (map_rows formula_at r) bound -> of_these theta x (map_rows formula_at r) bound).
  { intros r bound k [H1 H2]. destruct (rows_level r k H1) as [G1 G2]. split; [exact G1 | rewrite <- G2; exact H2]. }
  assert (Rows : forall bound, (forall i, In i (places_of_rows whole) -> is_level (Scale.degrees J tape) i = true) ->
    (forall i, In i (places_of_rows divided) -> is_level (Scale.degrees J tape) i = true) ->
    of_rows tape whole divided scaled x bound -> of_rows tape whole divided theta x bound).
  { intros bound k1 k2 [r [e k]]. exists r. split; [exact e |]. destruct e as [-> | ->]; [exact (These whole bound k1 k) | exact (These divided bound k2 k)]. }
  assert (Sign : forall f, is_level (Scale.degrees J tape) f = true -> is_nonneg tape scaled x f -> is_nonneg tape theta x f).
  { intros f k [d v]. destruct (level_sound f k d) as [d' e]. split; [exact d' | rewrite <- e; exact v]. }
  destruct t; cbn [are_level] in h; try discriminate; apply All in h as [a1 [a2 [a3 a4]]]; cbn [holds] in *.
  - destruct H as [H1 H2]. split; [| exact (Rows _ a2 a3 H2)].
    rewrite Forall_forall in H1 |- *. intros f i. exact (degree_defined f (a1 f i) (H1 f i)).
  - exact (Rows _ a2 a3 H).
  - exact (Rows _ a2 a3 H).
  - exact (Sign f (a4 f (or_introl eq_refl)) H).
  - exact (These r _ a4 H).
  - destruct H as [H | H]; [left; exact (Sign f (a4 f (or_introl eq_refl)) H) | right; exact (Sign g (a4 g (or_intror (or_introl eq_refl))) H)].
  - exact (These whole _ a2 H).
Qed.
Lemma half_level : forall P m c2 upper mu, are_level (Conditioning c2) J = true -> half_holds bits tape whole scaled P m x upper mu -> half_holds bits tape whole theta P m x upper mu.
Proof.
  intros P m c2 upper mu h [H1 H2]. cbn [are_level] in h. apply andb_true_iff in h as [_ h]. rewrite forallb_forall in h.
  destruct (rows_level whole (fun i k => h i (in_or_app _ _ _ (or_introl k))) H1) as [G1 G2]. split; [exact G1 | rewrite <- G2; exact H2].
Qed.
Lemma along_level : forall r P m t, r = whole \/ r = divided -> are_level t J = true -> holds_along bits tape r partial scaled P m x t -> holds_along bits tape r partial theta P m x t.
Proof.
  intros r P m t er h H.
  assert (All : forall l, forallb (has_degree (Scale.degrees J tape)) partial && forallb (is_level (Scale.degrees J tape)) (places_of_rows whole ++ places_of_rows divided ++ l) = true ->
    (forall i, In i partial -> has_degree (Scale.degrees J tape) i = true) /\ (forall i, In i (places_of_rows r) -> is_level (Scale.degrees J tape) i = true) /\ (forall i, In i l -> is_level (Scale.degrees J tape) i = true)).
  { intros l k. apply andb_true_iff in k as [p k]. rewrite forallb_forall in p, k. split; [exact p |]. split; intros i hi; apply k; repeat rewrite in_app_iff; destruct er as [-> | ->]; tauto. }
  assert (These : forall r bound, (forall i, In i (places_of_rows r) -> is_level (Scale.degrees J tape) i = true) ->
    of_these scaled x (map_rows formula_at r) bound -> of_these theta x (map_rows formula_at r) bound).
  { intros q bound k [H1 H2]. destruct (rows_level q k H1) as [G1 G2]. split; [exact G1 | rewrite <- G2; exact H2]. }
  destruct t as [low | high | | | q low | | | | | | |]; cbn [holds_along] in *; try contradiction; cbn [are_level] in h; apply All in h as [a1 [a2 a3]].
  - destruct H as [H1 H2]. split; [| exact (These r _ a2 H2)]. rewrite Forall_forall in H1 |- *. intros f i. exact (degree_defined f (a1 f i) (H1 f i)).
  - exact (These r _ a2 H).
  - exact (These q _ a3 H).
Qed.
End OneScale.

Variable theta : list R.
Hypothesis theta_in : Forall2 contains params theta.
Variable allowed : list R -> Prop.
Hypothesis inside_sound : forall cell lambda x tangent, inside cell = Some tangent -> length lambda = length cell -> allowed x ->
  Forall2 (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell (combine lambda x) -> exists d, entry_in bits tangent d /\ 0 <= at_lambda lambda d.


(** There is a machine of one scale, of which all that is shown is so of this one. *)
Lemma scaled_shows : forall x m t groups ones, may_scale t groups ones = true ->
  exists scaled, Forall2 contains (fold_left Scale.of_one_scale groups params) scaled /\
    (forall ps, holds bits tape whole divided partial ps scaled m x t -> holds bits tape whole divided partial params theta m x t) /\
    (forall r P, r = whole \/ r = divided -> holds_along bits tape r partial scaled P m x t -> holds_along bits tape r partial theta P m x t) /\
    forall c2 P upper mu, t = Conditioning c2 -> half_holds bits tape whole scaled P m x upper mu -> half_holds bits tape whole theta P m x upper mu.
Proof.
  intros x m t groups ones h. unfold may_scale in h. apply andb_true_iff in h as [h0 h1]. apply andb_true_iff in h0 as [own _]. rewrite forallb_forall in h1.
  revert h1. generalize theta_in. generalize params, theta. induction groups as [| J groups IH]; intros ps th hth lv.
  - exists th. split; [exact hth |]. split; [| split; auto]. intros ps' H. exact (holds_of_each _ _ _ _ _ _ _ _ _ _ _ own H).
  - cbn [fold_left]. destruct (Scale.of_one_scale_sound bits J ps th hth) as [s [th1 [s0 [T1 N1]]]].
    destruct (IH (Scale.of_one_scale ps J) th1 T1 (fun K i => lv K (or_intror i))) as [th2 [T2 [H2 [G2 F2]]]]. exists th2. split; [exact T2 |]. split; [| split].
    + intros ps' H. exact (holds_level x th th1 s J s0 N1 _ _ _ t (lv J (or_introl eq_refl)) (H2 ps' H)).
    + intros r P er H. exact (along_level x th th1 s J s0 N1 r P _ t er (lv J (or_introl eq_refl)) (G2 r P er H)).
    + intros c2 P upper mu e H. pose proof (lv J (or_introl eq_refl)) as l. rewrite e in l. exact (half_level x th th1 s J s0 N1 P _ c2 upper mu l (F2 c2 P upper mu e H)).
Qed.

Lemma wedges_of_parts : forall parts : list (list Z * Z * N * evidence), length (Toward.wedges (map (fun p => fst (fst (fst p))) parts)) = length parts.
Proof.
  assert (G : forall first (l : list (list Z * Z * N * evidence)), length (Toward.wedges_from first (map (fun p => fst (fst (fst p))) l)) = length l)
    by (intro first; induction l as [| r l I]; cbn [map Toward.wedges_from length]; congruence).
  intros [| p parts]; [reflexivity |]. exact (G (fst (fst (fst p))) (p :: parts)).
Qed.

(** Of each wedge of a fan its part. *)
Lemma part_of_wedge : forall (parts : list (list Z * Z * N * evidence)) p, In p (Toward.wedges (map (fun p => fst (fst (fst p))) parts)) ->
  exists part, In (p, part) (combine (Toward.wedges (map (fun p => fst (fst (fst p))) parts)) parts).
Proof.
  intros parts p ip. pose proof (wedges_of_parts parts) as L. revert ip L. generalize (Toward.wedges (map (fun p => fst (fst (fst p))) parts)). clear. intro ws. revert parts.
  induction ws as [| r l I]; intros [| part parts] ip e; try discriminate; [contradiction |]. destruct ip as [-> | ip]; [exists part; left; reflexivity |].
  destruct (I parts ip ltac:(cbn in e; congruence)) as [y iy]. exists y. right. exact iy.
Qed.

Lemma between_holds : forall keep cell x lambda c2 upper mu q e, entry_in bits mu q -> length lambda = length cell -> Forall (fun t => -1 <= t <= 1) lambda -> allowed x ->
  Forall2 (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell (combine lambda x) ->
  (forall k, Slope.holds bits lambda (nth k (coords_from 0 cell) (constant zero)) (nth k (map (centre_of bits) cell) 0) (nth k x 0)) ->
  between_shows (evaluate_kept keep cell) cell (Conditioning c2) upper mu e = true -> half_holds bits tape whole theta (fun _ => True) (length cell) x upper (at_lambda lambda q).
Proof.
  intros keep cell x lambda c2 upper mu q e hq el hlam ok hd C h.
  assert (One : forall wedge e, half_of (evaluate_kept keep cell) cell (Conditioning c2) upper mu wedge e = true -> half_holds bits tape whole theta (in_part wedge) (length cell) x upper (at_lambda lambda q)).
  { intros wedge e' g.
    assert (Own : half_on bits tape whole params inside (evaluate_kept keep cell) cell upper mu wedge e' = true -> half_holds bits tape whole theta (in_part wedge) (length cell) x upper (at_lambda lambda q))
      by exact (half_on_holds bits tape whole params inside theta theta_in allowed inside_sound keep cell x lambda upper mu q wedge e' hq el hlam ok hd C).
    destruct e' as [| | | | | | | | | | | | | | | | | groups ones e' | | |]; try exact (Own g). cbn [half_of] in g. apply andb_true_iff in g as [g1 g].
    destruct (scaled_shows x (length cell) (Conditioning c2) groups ones g1) as [scaled [T [_ [_ H]]]]. apply (H c2 _ _ _ eq_refl).
    exact (half_on_holds bits tape whole _ inside scaled T allowed inside_sound _ cell x lambda upper mu q wedge e' hq el hlam ok hd C g). }
  destruct e; try exact (One None _ h). cbn [between_shows] in h. apply andb_true_iff in h as [h1 h]. apply negb_true_iff, Nat.eqb_neq in h1. rewrite forallb_forall in h.
  apply (half_of_fan bits tape whole theta (length cell) x upper _ (map (fun p : list Z * Z * N * evidence => fst (fst (fst p))) parts)); [destruct parts; [contradiction h1; reflexivity | discriminate] |].
  intros p ip. destruct (part_of_wedge parts p ip) as [[[[c0 n] places] e] iq]. specialize (h _ iq). cbn [fst snd] in h. exact (One _ _ h).
Qed.

Lemma holds_of_divided : forall m x t, is_of_rows t = true -> holds bits tape divided divided partial params theta m x t -> holds bits tape whole divided partial params theta m x t.
Proof.
  intros m x t h H. destruct t; try discriminate; cbn [holds] in *; [destruct H as [D H]; split; [exact D |] |];
    (destruct H as [r [e k]]; exists r; split; [right; destruct e; assumption | exact k]).
Qed.

(** Where [mu] is of each machine its own, both bounds are shown of the same one. *)
Lemma are_same_sound : forall (A : Type) (same : A -> A -> bool), (forall a b, same a b = true -> a = b) -> forall l m, are_same same l m = true -> l = m.
Proof.
  intros A same h. induction l as [| a l IH]; intros [| b m] e; try discriminate; [reflexivity |]. cbn [are_same] in e. apply andb_true_iff in e as [e1 e2]. rewrite (h a b e1), (IH m e2). reflexivity.
Qed.
Definition of_evidence (e : evidence) : list fixed := match groups_of_scale e with Some groups => fold_left Scale.of_one_scale groups params | None => params end.
Lemma weighted_of_holds : forall keep cell x lambda c2 upper mu q places weights e th, entry_in bits mu q -> length lambda = length cell -> Forall (fun t => -1 <= t <= 1) lambda -> allowed x ->
  Forall2 (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell (combine lambda x) ->
  (forall k, Slope.holds bits lambda (nth k (coords_from 0 cell) (constant zero)) (nth k (map (centre_of bits) cell) 0) (nth k x 0)) -> Forall2 contains (of_evidence e) th ->
  weighted_of (evaluate_kept keep cell) cell (Conditioning c2) upper mu places weights e = true ->
  half_holds bits tape whole th (fun _ => True) (length cell) x upper (at_lambda lambda q + Weighted.total_at places th weights).
Proof.
  intros keep cell x lambda c2 upper mu q places weights e th hq el hlam ok hd C hth h. unfold of_evidence in hth.
  destruct e as [| | | | | | | | | | | | | | | | | groups ones e | | |]; cbn [groups_of_scale] in hth; cbn [weighted_of] in h;
    try exact (weighted_half_on_holds bits tape whole params inside th hth allowed inside_sound keep cell x lambda upper mu q places weights _ hq el hlam ok hd C h).
  apply andb_true_iff in h as [_ h]. exact (weighted_half_on_holds bits tape whole _ inside th hth allowed inside_sound _ cell x lambda upper mu q places weights e hq el hlam ok hd C h).
Qed.
(** There is one machine that both are about, of which what is shown is so of this one. *)
Lemma one_machine : forall values cell m x c2 u v mu places weights lower upper, are_alike lower upper = true ->
  weighted_of values cell (Conditioning c2) u mu places weights lower = true -> weighted_of values cell (Conditioning c2) v mu places weights upper = true ->
  exists th, Forall2 contains params th /\ Forall2 contains (of_evidence lower) th /\ Forall2 contains (of_evidence upper) th /\
    forall ps, holds bits tape whole divided partial ps th m x (Conditioning c2) -> holds bits tape whole divided partial params theta m x (Conditioning c2).
Proof.
  intros values cell m x c2 u v mu places weights lower upper alike hl hu.
  assert (Scaled : forall upper e, weighted_of values cell (Conditioning c2) upper mu places weights e = true -> exists th, Forall2 contains params th /\ Forall2 contains (of_evidence e) th /\
    forall ps, holds bits tape whole divided partial ps th m x (Conditioning c2) -> holds bits tape whole divided partial params theta m x (Conditioning c2)).
  { intros w e h.
    assert (Own : groups_of_scale e = None -> exists th, Forall2 contains params th /\ Forall2 contains (of_evidence e) th /\
      forall ps, holds bits tape whole divided partial ps th m x (Conditioning c2) -> holds bits tape whole divided partial params theta m x (Conditioning c2)).
    { intro n. unfold of_evidence. rewrite n. exists theta. split; [exact theta_in |]. split; [exact theta_in | intros ps H; exact H]. }
    destruct e as [| | | | | | | | | | | | | | | | | groups ones e | | |]; try exact (Own eq_refl). cbn [weighted_of] in h. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [g _].
    destruct (scaled_shows x m (Conditioning c2) groups ones g) as [th [T [H _]]]. exists th. split; [exact (Scale.all_of_one_scale_within bits groups params theta th theta_in T) |]. split; [exact T | exact H]. }
  destruct (Scaled _ _ hl) as [th1 [T1 [L1 H1]]]. destruct (Scaled _ _ hu) as [th2 [T2 [L2 H2]]]. unfold are_alike in alike. unfold of_evidence in *.
  destruct (groups_of_scale lower) as [g |]; [| exists th2; repeat (split; [assumption |]); exact H2].
  destruct (groups_of_scale upper) as [g' |]; [| exists th1; repeat (split; [assumption |]); exact H1].
  apply (are_same_sound _ _ (are_same_sound _ _ (fun a b => proj1 (Nat.eqb_eq a b)))) in alike. subst g'. exists th1. repeat (split; [assumption |]). exact H1.
Qed.

Lemma shows_step_holds : forall keep cell x t e, Forall2 contains cell x -> allowed x ->
  shows_step (evaluate_kept keep cell) cell t e = true -> holds bits tape whole divided partial params theta (length cell) x t.
Proof.
  intros keep cell x t e hx ok h.
  assert (Other : shows_on bits tape whole divided partial params inside (evaluate_kept keep cell) cell t e = true -> holds bits tape whole divided partial params theta (length cell) x t)
    by exact (kept_holds bits tape whole divided partial params inside theta theta_in allowed inside_sound keep cell x t e hx ok).
  destruct e as [| | | | | | | | | | | | | | | | | groups ones e | parts | places mu weights lower upper |]; try exact (Other h); clear Other; cbn [shows_step] in h; [| | destruct t; try discriminate; destruct weights as [| row weights]; [| set (all := row :: weights) in *]]; apply andb_true_iff in h as [h1 h].
  - destruct (scaled_shows x (length cell) t groups ones h1) as [scaled [T [H _]]].
    exact (H _ (kept_holds bits tape whole divided partial _ inside scaled T allowed inside_sound _ cell x t e hx ok h)).
  - apply andb_true_iff in h1 as [h1 h2]. apply negb_true_iff, Nat.eqb_neq in h1. set (d := is_of_divided (ByFan parts)) in *. set (r := if d then divided else whole).
    assert (er : r = whole \/ r = divided) by (unfold r; destruct d; auto). set (cs := map (fun p : list Z * Z * N * evidence => fst (fst (fst p))) parts) in *.
    assert (ne : cs <> []) by (unfold cs; destruct parts; [contradiction h1; reflexivity | discriminate]).
    assert (F : holds bits tape r divided partial params theta (length cell) x t).
    { apply (holds_of_fan bits tape r divided partial params theta (length cell) x t cs ne). intros p ip. rewrite forallb_forall in h.
      destruct (part_of_wedge parts p ip) as [[[[c0 n] places] e] iq]. specialize (h _ iq). cbn [fst snd shows_part] in h. fold r in h.
      assert (Own : forall e, shows_along bits tape r divided partial params inside (evaluate_kept keep cell) cell t (fst p) (snd p) n places e = true -> holds_along bits tape r partial theta (Toward.in_wedge (fst p) (snd p)) (length cell) x t)
        by (intros e' k; exact (along_holds bits tape r divided partial params inside theta theta_in allowed inside_sound keep cell x t (fst p) (snd p) n places e' hx ok k)).
      destruct e as [| | | | | | | | | | | | | | | | | groups ones e | | |]; try exact (Own _ h). apply andb_true_iff in h as [h3 h].
      destruct (scaled_shows x (length cell) t groups ones h3) as [scaled [T [_ [H _]]]].
      exact (H r _ er (along_holds bits tape r divided partial _ inside scaled T allowed inside_sound _ cell x t (fst p) (snd p) n places _ hx ok h)). }
    unfold r in F. destruct d; [exact (holds_of_divided (length cell) x t h2 F) | exact F].
  - apply andb_true_iff in h1 as [h0 h1]. destruct (coords_from_hold bits cell x hx) as [lambda [el [hlam [hd C]]]]. specialize (C []). cbn [app length] in C.
    destruct (mu_slope_in bits places mu) as [q hq]. rewrite <- el in h0. pose proof (positive_there_sound bits _ _ _ h0 hq hlam) as p0.
    apply (holds_of_halves bits tape whole divided partial params theta (length cell) x c2 _ p0).
    + exact (between_holds keep cell x lambda c2 None _ q lower hq el hlam ok hd C h1).
    + exact (between_holds keep cell x lambda c2 (Some c2) _ q upper hq el hlam ok hd C h).
  - apply andb_true_iff in h1 as [h0 h1]. apply andb_true_iff in h0 as [h0 alike]. destruct (coords_from_hold bits cell x hx) as [lambda [el [hlam [hd C]]]]. specialize (C []). cbn [app length] in C.
    destruct (mu_slope_in bits places mu) as [q hq]. rewrite <- el in h0. destruct (one_machine _ cell (length cell) x c2 _ _ _ places all lower upper alike h1 h) as [th [T [Tl [Tu H]]]]. apply (H params).
    destruct (total_in bits _ _ _ _ hq (constant_in bits _ _ (Weighted.total_sound bits places params th all T))) as [q' [hq' eq']].
    pose proof (positive_there_sound bits _ _ _ h0 hq' hlam) as p0. rewrite eq', at_constant in p0.
    apply (holds_of_halves bits tape whole divided partial params th (length cell) x c2 _ p0).
    + exact (weighted_of_holds keep cell x lambda c2 None _ q places all lower th hq el hlam ok hd C Tl h1).
    + exact (weighted_of_holds keep cell x lambda c2 (Some c2) _ q places all upper th hq el hlam ok hd C Tu h).
Qed.

(** Every test that is not open holds. *)
Definition done (m : nat) (x : list R) (open : list bool) : Prop :=
  forall i t, nth_error tests i = Some t -> nth i open false = false -> holds bits tape whole divided partial params theta m x t.

Lemma nth_clear : forall i j open, nth j (clear i open) false = false -> j = i \/ nth j open false = false.
Proof.
  induction i as [| i IH]; intros [| j] [| b open] h; cbn in *; auto.
  destruct (IH j open h); auto.
Qed.
Lemma clear_leaves : forall i j open, nth j (clear i open) false = true -> nth j open false = true.
Proof.
  induction i as [| i IH]; intros [| j] [| b open] h; cbn in *; auto. discriminate.
Qed.

(** What steps show is of these parameters; [Q] what follows from it. *)
Lemma discharge_shows : forall (Q : test -> Prop) keep cell x steps open rest, Forall2 contains cell x -> allowed x ->
  (forall i t, nth_error tests i = Some t -> nth i open false = true -> holds bits tape whole divided partial params theta (length cell) x t -> Q t) ->
  discharge (evaluate_kept keep cell) cell steps open = Some rest ->
  (forall i t, nth_error tests i = Some t -> nth i open false = false -> Q t) ->
  (forall i t, nth_error tests i = Some t -> nth i rest false = false -> Q t) /\ forall i, nth i rest false = true -> nth i open false = true.
Proof.
  intros Q keep cell x steps open rest hx ok W h. revert open W h.
  induction steps as [| [i e] steps IH]; intros open W h D; cbn [discharge] in h; [injection h as <-; split; [exact D | auto] |].
  assert (Other : match nth i open false, nth_error tests i with
    | true, Some t => if shows_step (evaluate_kept keep cell) cell t e then discharge (evaluate_kept keep cell) cell steps (clear i open) else None
    | _, _ => None end = Some rest ->
    (forall i t, nth_error tests i = Some t -> nth i rest false = false -> Q t) /\ forall i, nth i rest false = true -> nth i open false = true).
  { clear h. intro h. destruct (nth i open false) eqn:o; [| discriminate]. destruct (nth_error tests i) as [t |] eqn:n; [| discriminate].
    destruct (shows_step (evaluate_kept keep cell) cell t e) eqn:s; [| discriminate].
    destruct (IH (clear i open) (fun j u nj oj => W j u nj (clear_leaves i j open oj)) h) as [I1 I2].
    - intros j u nj oj. destruct (nth_clear i j open oj) as [-> | o']; [| exact (D j u nj o')].
      rewrite n in nj. injection nj as <-. exact (W i t n o (shows_step_holds keep cell x t e hx ok s)).
    - split; [exact I1 |]. intros j r. exact (clear_leaves i j open (I2 j r)). }
  destruct e; try exact (Other h). destruct (is_outside cell) eqn:o; [| discriminate].
  destruct (outside_none bits inside allowed inside_sound cell x hx ok o).
Qed.

Lemma discharge_sound : forall keep cell x steps open rest, Forall2 contains cell x -> allowed x -> discharge (evaluate_kept keep cell) cell steps open = Some rest ->
  done (length cell) x open -> done (length cell) x rest.
Proof. intros keep cell x steps open rest hx ok h D. exact (proj1 (discharge_shows (holds bits tape whole divided partial params theta (length cell) x) keep cell x steps open rest hx ok (fun _ _ _ _ k => k) h D)). Qed.

Lemma steps_on_shows : forall (Q : test -> Prop) cell x steps open rest, Forall2 contains cell x -> allowed x ->
  (forall i t, nth_error tests i = Some t -> nth i open false = true -> holds bits tape whole divided partial params theta (length cell) x t -> Q t) ->
  steps_on cell steps open = Some rest ->
  (forall i t, nth_error tests i = Some t -> nth i open false = false -> Q t) ->
  (forall i t, nth_error tests i = Some t -> nth i rest false = false -> Q t) /\ forall i, nth i rest false = true -> nth i open false = true.
Proof.
  intros Q cell x steps open rest hx ok W h. destruct steps as [| s steps]; [injection h as <-; split; [assumption | auto] |].
  exact (discharge_shows Q _ cell x (s :: steps) open rest hx ok W h).
Qed.
End Steps.

(** ** The tree, in which parameters are narrowed *)

Lemma open_with : forall (A : Type) (l : list A) t i open, nth_error l i = Some t -> nth i open false = true -> In (t, true) (combine l open).
Proof.
  intros A. induction l as [| u l IH]; intros t [| i] [| b open] n o; cbn in n, o; try discriminate; cbn [combine].
  - injection n as ->. subst b. left. reflexivity.
  - right. exact (IH t i open n o).
Qed.
(** No test is open that is about more machines than one. *)
Definition may_part {A : Type} (is_of_each : A -> bool) (tests : list A) (open : list bool) : bool := forallb (fun p => is_of_each (fst p) || negb (snd p)) (combine tests open).
Lemma may_part_sound : forall (A : Type) (is_of_each : A -> bool) tests open i t, may_part is_of_each tests open = true -> nth_error tests i = Some t -> nth i open false = true -> is_of_each t = true.
Proof.
  unfold may_part. intros A is_of_each tests open i t h n o. rewrite forallb_forall in h. specialize (h (t, true) (open_with _ tests t i open n o)). cbn [fst snd] in h.
  rewrite orb_false_r in h. exact h.
Qed.

Section Tree.
Variable bits : positive.
Local Notation contains := (contains bits).
Variable tape : list (op address).
Variables whole divided : rows nat.
Variable partial : list nat.
Variable all : list fixed.
Variable tests : list test.
Variable inside : list fixed -> option slope.

Fixpoint check_for (params cell : list fixed) (open : list bool) (t : tree) : bool :=
  let then_ steps holds := match steps_on bits tape whole divided partial params tests inside cell steps open with Some last => holds last | None => false end in
  match t with
  | Leaf steps => then_ steps (forallb negb)
  | Split steps k lower upper => then_ steps (fun last =>
      let (a, b) := halves k cell in if check_for params a last lower then check_for params b last upper else false)
  | Parts steps j lower upper => then_ steps (fun last => if may_part is_of_each tests last then
      let (a, b) := halves j params in if check_for a cell last lower then check_for b cell last upper else false else false)
  end.
Definition check : list fixed -> list bool -> tree -> bool := check_for all.

Variable theta : list R.
Hypothesis theta_in : Forall2 contains all theta.
Variable allowed : list R -> Prop.
Hypothesis inside_sound : forall cell lambda x tangent, inside cell = Some tangent -> length lambda = length cell -> allowed x ->
  Forall2 (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell (combine lambda x) -> exists d, entry_in bits tangent d /\ 0 <= at_lambda lambda d.

Local Notation holds := (holds bits tape whole divided partial all theta).

(** Soundness: where the tree is accepted, every test holds at every point of the cell. *)
Theorem check_for_sound : forall tr params cell x open, check_for params cell open tr = true -> Forall2 contains params theta -> Forall2 contains cell x -> allowed x ->
  (forall i t, nth_error tests i = Some t -> nth i open false = true -> Check.holds bits tape whole divided partial params theta (length cell) x t -> holds (length cell) x t) ->
  (forall i t, nth_error tests i = Some t -> nth i open false = false -> holds (length cell) x t) -> forall t, In t tests -> holds (length cell) x t.
Proof.
  induction tr as [steps | steps k lower IHl upper IHu | steps k lower IHl upper IHu]; intros params cell x open h hp hx ok W D t ht; cbn [check_for] in h; cbv zeta in h;
    destruct (steps_on bits tape whole divided partial params tests inside cell steps open) as [rest |] eqn:s; try discriminate;
    destruct (steps_on_shows bits tape whole divided partial params tests inside theta hp allowed inside_sound (holds (length cell) x) cell x steps open rest hx ok W s D) as [D' L].
  - destruct (In_nth_error _ _ ht) as [i n]. apply (D' i t n). rewrite forallb_forall in h.
    destruct (nth_in_or_default i rest false) as [m | ->]; [| reflexivity].
    apply h in m. destruct (nth i rest false); [discriminate | reflexivity].
  - pose proof (halves_sound bits k cell x hx) as c. destruct (halves_length k cell) as [La Lb].
    destruct (halves k cell) as [a b]. cbn [fst snd] in *.
    assert (W' : forall i t, nth_error tests i = Some t -> nth i rest false = true -> Check.holds bits tape whole divided partial params theta (length cell) x t -> holds (length cell) x t)
      by (intros i u n o; exact (W i u n (L i o))).
    destruct (check_for params a rest lower) eqn:ha; [| discriminate].
    destruct c as [c | c].
    + rewrite <- La in *. exact (IHl params a x rest ha hp c ok W' D' t ht).
    + rewrite <- Lb in *. exact (IHu params b x rest h hp c ok W' D' t ht).
  - destruct (may_part is_of_each tests rest) eqn:e; [| discriminate]. pose proof (halves_sound bits k params theta hp) as c. destruct (halves k params) as [a b]. cbn [fst snd] in *.
    assert (W' : forall ps i t, nth_error tests i = Some t -> nth i rest false = true -> Check.holds bits tape whole divided partial ps theta (length cell) x t -> holds (length cell) x t)
      by (intros ps i u n o; exact (holds_of_each bits tape whole divided partial ps theta all _ x u (may_part_sound _ _ _ rest i u e n o))).
    destruct (check_for a cell rest lower) eqn:ha; [| discriminate].
    destruct c as [c | c].
    + exact (IHl a cell x rest ha c hx ok (W' a) D' t ht).
    + exact (IHu b cell x rest h c hx ok (W' b) D' t ht).
Qed.

Definition all_open : list bool := map (fun _ => true) tests.

Corollary check_all_open : forall tr cell x, check cell all_open tr = true -> Forall2 contains cell x -> allowed x ->
  forall t, In t tests -> holds (length cell) x t.
Proof.
  intros tr cell x h hx ok. apply (check_for_sound tr all cell x all_open h theta_in hx ok); [auto |].
  intros i t n o. exfalso. unfold all_open in o.
  rewrite (nth_indep _ false true) in o.
  - rewrite (map_nth (fun _ => true) tests (SigmaMin zero) i) in o. discriminate.
  - rewrite map_length. apply nth_error_Some. congruence.
Qed.
End Tree.
