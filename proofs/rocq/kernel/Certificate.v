(** * Certificates: their text, what they mean, and which are accepted

    A certificate as [read] is a value of the types below; whoever reads it is not
    trusted.  [print] gives the only text that it stands for, so a text that differs
    from what is printed is refused; [means] is what it says; and what [verify]
    accepts is true ([verify_sound]).  To know what has been proved, read [print],
    [claim_of] and [means], with the definitions of Statement.v, Witness.v,
    Closed.v and Kinematics.v. *)

From Coq Require Import ZArith Reals Lra List Bool String Ascii DecimalString.
From Orthocert Require Import Vec3 SingularValues Kinematics Postulate Claim.
From Orthocert.kernel Require Import Statement Check Number Problem Faces Witness Closed.
Import ListNotations.
Local Open Scope list_scope.
Local Open Scope string_scope.
Local Notation length := List.length.

(** ** Certificates *)

Inductive operator := Addition | Subtraction | Multiplication | Division.

(** A number as it is written. *)
Inductive expression :=
  | Literal (whole decimals : Decimal.uint)
  | Negative (x : expression)
  | Binary (o : operator) (x y : expression)
  | Power (x : expression) (n : positive)
  | SquareRoot (x : expression).

Inductive quantity := One (x : expression) | Between (min max : expression).
Record triple (A : Type) := Triple { first : A; second : A; third : A }.
Arguments Triple {A}. Arguments first {A}. Arguments second {A}. Arguments third {A}.

Inductive written_leg :=
  | Slider_ (direction anchor platform : triple quantity) (length : quantity) (mode : bool)
  | Strut_ (anchor platform : triple quantity) (base_axis : option (triple quantity))
  | Planar_ (direction : triple quantity).

Inductive about := Transmission | JointRange | Speed_ | Condition_ | Serial_ | Parallel_ | Stiffness_ | Constraint_.
(** [leg_] is counted from one; [given_] is the platform's speed, of speeds, and the joints' stiffness, of stiffness. *)
Record written_requirement := Require_ { about_ : about; leg_ : option nat; given_ : option expression; is_max : bool; bound_ : expression }.

Inductive written_region :=
  | Box_ (min max : triple expression)
  | Cylinder_ (center_x center_y radius bottom top : expression).

Inductive subject :=
  (* legs that do not turn the platform *)
  | Machine_ (legs : list written_leg) (workspace : written_region) (require : list written_requirement)
  (* the Orthoglide on the paper's cube *)
  | Closed_ (offset side : expression) (require : list written_requirement)
  (* [None]: every psi *)
  | Postulate_ (psi : option quantity).

Inductive step :=
  | Plain (name : string)
  | Multiplied (name : string) (y : list (list Z)) (places : N)
  | AtCorner (f : face)
  | Conditioned_ (y : list (list Z)) (places : N) (mu : list Z)
  | Inside_ (s : step) (n : Z) (places : N).
Record node := Node { by_ : list (nat * step); split_ : option nat }.

Inductive violation := Reach | Obligation (number : nat) (directions : list (list Z)) | Row (number leg : nat).

Inductive proof :=
  | Nodes (precision : positive) (nodes : list node)
  (* [machine]: a value of each tolerance, in order *)
  | ByWitness (precision : positive) (point : list expression) (machine : list expression) (fails : violation).

Record certificate := Certificate { subject_ : subject; proof_ : proof; tool : string; version : string }.

(** ** Text: section 2 of FORMAT.md *)

Definition text := list string.

Fixpoint separated (l : list text) : text :=
  match l with [] => [] | [t] => t | t :: l' => t ++ "," :: separated l' end%list.
Definition array (l : list text) : text := ("[" :: separated l ++ ["]"])%list.
Definition object (l : list text) : text := ("{" :: separated l ++ ["}"])%list.
Definition quoted (s : string) : text := [""""; s; """"].
Definition field (key : string) (value : text) : text := (("""" ++ key ++ """:")%string :: value)%list.
(** A variant. *)
Definition variant (name : string) (value : text) : text := object [field name value].

Definition natural (n : nat) : text := [NilZero.string_of_uint (Nat.to_uint n)].
Definition positive_text (n : positive) : text := [NilZero.string_of_uint (Pos.to_uint n)].
Definition integer_text (n : Z) : text := [NilZero.string_of_int (Z.to_int n)].
Definition places_text (n : N) : text := [NilZero.string_of_uint (N.to_uint n)].

(** Section 3: how strong an expression holds its parts. *)
Definition strength (x : expression) : nat :=
  match x with
  | Binary (Addition | Subtraction) _ _ => 1
  | Binary (Multiplication | Division) _ _ => 2
  | Negative _ => 3
  | Power _ _ => 4
  | Literal _ _ | SquareRoot _ => 5
  end.
Definition symbol (o : operator) : string :=
  match o with Addition => "+" | Subtraction => "-" | Multiplication => "*" | Division => "/" end.

Fixpoint number_text (x : expression) : text :=
  let part (enough : nat) (y : expression) :=
    if Nat.leb enough (strength y) then number_text y else ("(" :: number_text y ++ [")"])%list in
  match x with
  | Literal w Decimal.Nil => [NilEmpty.string_of_uint w]
  | Literal w d => [NilEmpty.string_of_uint w; "."; NilEmpty.string_of_uint d]
  | Negative y => "-" :: part 3 y
  | Binary o y z => part (strength x) y ++ symbol o :: part (S (strength x)) z
  | Power y n => part 5 y ++ "^" :: positive_text n
  | SquareRoot y => "sqrt(" :: number_text y ++ [")"]
  end%list.

Definition number (x : expression) : text := ("""" :: number_text x ++ [""""])%list.
Definition quantity_text (q : quantity) : text :=
  match q with One x => number x | Between a b => object [field "min" (number a); field "max" (number b)] end.
Definition triple_text {A : Type} (f : A -> text) (t : triple A) : text := array [f (first t); f (second t); f (third t)].

Definition leg_text (l : written_leg) : text :=
  let vector := triple_text quantity_text in
  object match l with
  | Slider_ d a p len m => [field "drive" (quoted "slider"); field "direction" (vector d); field "anchor" (vector a);
      field "platform" (vector p); field "length" (quantity_text len); field "mode" (quoted (if m then "+" else "-"))]
  | Strut_ a p k => [field "drive" (quoted "strut"); field "anchor" (vector a); field "platform" (vector p)] ++
      match k with Some k => [field "base_axis" (vector k)] | None => [] end
  | Planar_ d => [field "drive" (quoted "planar"); field "direction" (vector d)]
  end%list.

Definition about_text (a : about) : string :=
  match a with
  | Transmission => "transmission" | JointRange => "joint_range" | Speed_ => "joint_speed"
  | Condition_ => "conditioning" | Serial_ => "serial_margin" | Parallel_ => "parallel_margin"
  | Stiffness_ => "stiffness" | Constraint_ => "constraint_margin"
  end.
Definition requirement_text (r : written_requirement) : text :=
  object (field "quantity" (quoted (about_text (about_ r))) ::
    match leg_ r with Some n => [field "leg" (natural n)] | None => [] end ++
    match given_ r with
    | Some x => [field "given" (variant (match about_ r with Stiffness_ => "joint" | _ => "tool" end) (array [number x]))]
    | None => []
    end ++
    [field "end" (quoted (if is_max r then "max" else "min")); field "bound" (number (bound_ r))])%list.

Definition region_text (w : written_region) : text :=
  match w with
  | Box_ a b => variant "box" (object [field "min" (triple_text number a); field "max" (triple_text number b)])
  | Cylinder_ x y r bottom top => variant "cylinder" (object
      [field "center" (array [number x; number y]); field "radius" (number r); field "z" (array [number bottom; number top])])
  end.

Definition subject_text (s : subject) : text :=
  match s with
  | Machine_ legs w rs => variant "machine" (object
      [field "mechanism" (variant "translational" (array (map leg_text legs)));
       field "workspace" (region_text w);
       field "require" (array (map requirement_text rs))])
  | Closed_ offset side rs => variant "machine" (object
      [field "mechanism" (variant "orthoglide" (object [field "offset" (number offset)]));
       field "workspace" (variant "cube" (object [field "side" (number side)]));
       field "require" (array (map requirement_text rs))])
  | Postulate_ psi => variant "postulate" (object
      [field "psi_max" (match psi with None => quoted "all" | Some q => quantity_text q end)])
  end.

Definition integers_text (l : list Z) : text := array (map integer_text l).

Definition multiplier_text (y : list (list Z)) (places : N) : text :=
  object [field "y" (array (map integers_text y)); field "places" (places_text places)].
Fixpoint evidence_text (s : step) : text :=
  match s with
  | Plain name => quoted name
  | Multiplied name y places => variant name (multiplier_text y places)
  | AtCorner f => variant "corner" (quoted (match f with Q1 => "Q1" | Q2 => "Q2" end))
  | Conditioned_ y places mu => variant "conditioning" (array [multiplier_text y places; integers_text mu])
  | Inside_ s n places => variant "inside" (array [evidence_text s; integer_text n; places_text places])
  end.
Definition step_text (s : nat * step) : text := array [natural (fst s); evidence_text (snd s)].
Definition node_text (n : node) : text :=
  object (match by_ n with [] => [] | l => [field "by" (array (map step_text l))] end ++
    match split_ n with Some k => [field "split" (natural k)] | None => [] end)%list.

Definition proof_text (p : proof) : text :=
  match p with
  | Nodes bits nodes => variant "tree" (object
      [field "precision" (positive_text bits); field "nodes" (array (map node_text nodes))])
  | ByWitness bits point machine fails => variant "witness" (object
      ([field "precision" (positive_text bits); field "point" (array (map number point))] ++
       match machine with [] => [] | l => [field "machine" (array (map number l))] end ++
       [field "fails" match fails with
         | Reach => quoted "reach"
         | Obligation i vs => variant "obligation" (array [natural i; array (map integers_text vs)])
         | Row i l => variant "row" (array [natural i; natural l])
         end]))
  end%list.

Definition print (c : certificate) : text :=
  (object [field "format" (quoted "orthocert/2"); field "claim" (subject_text (subject_ c));
    field "verdict" (quoted (match proof_ c with Nodes _ _ => "certified" | ByWitness _ _ _ _ => "refuted" end));
    field "proof" (proof_text (proof_ c));
    field "provenance" (object [field "tool" (quoted (tool c)); field "version" (quoted (version c))])]
   ++ [String "010" ""])%list.

(** Nothing in it ends a string of JSON. *)
Definition is_plain (s : string) : bool :=
  forallb (fun c => negb (c =? """")%char && negb (c =? "\")%char && Nat.leb 32 (nat_of_ascii c) && Nat.leb (nat_of_ascii c) 126)
    (list_ascii_of_string s).

Fixpoint is_plain_step (s : step) : bool :=
  match s with
  | Plain name | Multiplied name _ _ => is_plain name
  | Inside_ s _ _ => is_plain_step s
  | AtCorner _ | Conditioned_ _ _ _ => true
  end.
(** Every string of the certificate is one: its text has no other shape than that of [print]. *)
Definition is_plain_certificate (c : certificate) : bool :=
  is_plain (tool c) && is_plain (version c) &&
  match proof_ c with
  | Nodes _ nodes => forallb (fun n => forallb (fun s => is_plain_step (snd s)) (by_ n)) nodes
  | ByWitness _ _ _ _ => true
  end.

(** ** Meaning *)

Fixpoint product_of (base : Claim.number) (n : nat) : Claim.number :=
  match n with O => base | S m => Times (product_of base m) base end.

Fixpoint denoted (x : expression) : Claim.number :=
  match x with
  | Literal w d => Ratio (Z.of_uint (Decimal.app w d)) (Nat.iter (Decimal.nb_digits d) (Pos.mul 10) 1%positive)
  | Negative y => match denoted y with Ratio n d => Ratio (- n) d | k => Minus (0 // 1) k end
  | Binary o y z =>
      match o with Addition => Plus | Subtraction => Minus | Multiplication => Times | Division => Over end (denoted y) (denoted z)
  | Power y n => product_of (denoted y) (pred (Pos.to_nat n))
  | SquareRoot y => Root (denoted y)
  end.

Definition tolerance_of (q : quantity) : tolerance :=
  match q with One x => exactly (denoted x) | Between a b => Within (denoted a) (denoted b) end.
Definition tolerances_of (t : triple quantity) : tolerances :=
  Tolerances (tolerance_of (first t)) (tolerance_of (second t)) (tolerance_of (third t)).
Definition drive_of (l : written_leg) : drive :=
  match l with
  | Slider_ d a p len m => SliderLeg (Slider (tolerances_of d) (tolerances_of a) (tolerances_of p) (tolerance_of len) m)
  | Strut_ a p k => StrutLeg (tolerances_of a) (tolerances_of p) (option_map tolerances_of k)
  | Planar_ d => PlanarLeg (tolerances_of d)
  end.
Definition region_of (w : written_region) : region :=
  match w with
  | Box_ a b => let edge f := Within (denoted (f a)) (denoted (f b)) in Box (Tolerances (edge first) (edge second) (edge third))
  | Cylinder_ x y r bottom top => Cylinder (denoted x) (denoted y) (denoted r) (Within (denoted bottom) (denoted top))
  end.

(** Obligations, section 9: a bound on psi from above takes the place of freedom from singularities. *)
Definition psi_max_of (r : written_requirement) : list requirement :=
  match about_ r, is_max r with Transmission, true => [PsiMax (denoted (bound_ r))] | _, _ => [] end.
Definition other_of (legs : nat) (r : written_requirement) : list requirement :=
  let b := denoted (bound_ r) in
  let each f := map f match leg_ r with Some n => [pred n] | None => seq 0 legs end in
  match about_ r, is_max r, given_ r with
  | Transmission, true, _ => []
  | Transmission, false, _ => [PsiMin b]
  | JointRange, up, _ => each (fun i => if up then JointMax i b else JointMin i b)
  | Speed_, _, Some tool => each (fun i => JointSpeed i (denoted tool) b)
  | Speed_, _, None => []
  | Condition_, _, _ => [ConditionMax b]
  | Serial_, _, _ => each (fun i => SerialMargin i b)
  | Parallel_, _, _ => [ParallelMargin b]
  | Stiffness_, _, Some joint => [Stiffness (denoted joint) b]
  | Stiffness_, _, None => []
  | Constraint_, _, _ => [ConstraintMargin b]
  end.
(** The requirement has the keys and the end that it has to have. *)
Definition is_shaped (legs : nat) (r : written_requirement) : bool :=
  match about_ r, is_max r, leg_ r, given_ r with
  | Transmission, _, None, None | Condition_, true, None, None | Parallel_, false, None, None => true
  | Stiffness_, false, None, Some _ | Constraint_, false, None, None => true
  | JointRange, _, Some n, None | Serial_, false, Some n, None | Speed_, true, Some n, Some _ => Nat.leb 1 n && Nat.leb n legs
  | JointRange, _, None, None | Serial_, false, None, None | Speed_, true, None, Some _ => true
  | _, _, _, _ => false
  end.
Definition obligations (legs : nat) (rs : list written_requirement) : list requirement :=
  (match flat_map psi_max_of rs with [] => [NotSingular] | l => l end ++ flat_map (other_of legs) rs)%list.

Definition claim_of (ls : list written_leg) (w : written_region) (rs : list written_requirement) : claim :=
  MakeClaim (map drive_of ls) (region_of w) (obligations (length ls) rs).

(** The bounds on psi of the closed design, which asks for nothing else. *)
Definition closed_bounds (rs : list written_requirement) : option (Claim.number * Claim.number) :=
  match rs with
  | [Require_ Transmission None None false a; Require_ Transmission None None true b]
  | [Require_ Transmission None None true b; Require_ Transmission None None false a] => Some (denoted a, denoted b)
  | _ => None
  end.

Local Open Scope R_scope.

Definition postulate_for (psi : R) : Prop := forall L a e, 0 < L -> forall P, in_cube L psi P ->
  Kinematics.regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.

Definition means (c : certificate) : Prop :=
  match subject_ c, proof_ c with
  | Machine_ ls w rs, Nodes _ _ =>
      Statement.holds (claim_of ls w rs) /\ exists m P, is_about (claim_of ls w rs) m P
  | Machine_ ls w rs, ByWitness _ _ _ _ =>
      exists m P, is_about (claim_of ls w rs) m P /\ ~ meets (claim_of ls w rs) m P
  | Closed_ offset side rs, Nodes _ _ =>
      match closed_bounds rs with Some (least, greatest) => closed_design_holds (denoted side) least greatest (value (denoted offset)) | None => False end
  | Postulate_ None, Nodes _ _ => forall psi, 1 < psi -> postulate_for psi
  | Postulate_ (Some q), Nodes _ _ => 1 < value (greatest (tolerance_of q)) /\
      forall psi, 1 < psi -> within (tolerance_of q) psi -> postulate_for psi
  | _, ByWitness _ _ _ _ => False
  end.

(** ** What is accepted.  Nothing below has to be read: [verify_sound] holds of it. *)

Local Close Scope R_scope.

(** Units of lengths and directions: section 7.3. *)
Definition exact_bits : positive := 512.
Definition order_of (xs : list Claim.number) : Z :=
  let size x := match enclose exact_bits x with Some a => Z.max (Z.abs (Fixed.lo a)) (Z.abs (Fixed.hi a)) | None => 0%Z end in
  let most := fold_right (fun x m => Z.max (size x) m) 0%Z xs in
  if (0 <? most)%Z then (Z.log2 most - Zpos exact_bits)%Z else 0%Z.
Definition ends (t : tolerance) : list Claim.number := [least t; greatest t].
Definition ends3 (t : tolerances) : list Claim.number := (ends (tx t) ++ ends (ty t) ++ ends (tz t))%list.
Definition lengths_of (d : drive) : list Claim.number := match d with SliderLeg c => ends (Claim.length c) | _ => [] end.
Definition places_of (d : drive) : list Claim.number :=
  match d with SliderLeg c => (ends3 (anchor c) ++ ends3 (platform c))%list | StrutLeg a p _ => (ends3 a ++ ends3 p)%list | PlanarLeg _ => [] end.
Definition direction_order (d : drive) : Z :=
  match d with SliderLeg c => order_of (ends3 (direction c)) | PlanarLeg n => order_of (ends3 n) | StrutLeg _ _ (Some k) => order_of (ends3 k)
  | StrutLeg _ _ None => 0%Z end.
Definition length_order (ds : list drive) : Z :=
  let some := match flat_map lengths_of ds with [] => flat_map places_of ds | l => l end in
  (1 + order_of some)%Z.

Fixpoint evidence_of (s : step) : option evidence :=
  match s with
  | Plain name =>
      if name =? "test" then Some ByTest else if name =? "divided" then Some ByDivided else if name =? "mirror" then Some ByMirror else
      if name =? "negative" then Some ByNegative else if name =? "outside" then Some Outside else None
  | Multiplied name y places =>
      if name =? "lower" then Some (ByLower places y) else if name =? "lower_divided" then Some (ByLowerDivided places y) else
      if name =? "rank" then Some (ByRank places y) else None
  | AtCorner f => Some (ByCorner f)
  | Conditioned_ y places mu => Some (ByConditioning places y mu)
  | Inside_ s n places => match evidence_of s with Some e => Some (Inside e n places) | None => None end
  end.
Fixpoint steps_of (l : list (nat * step)) : option (list (nat * evidence)) :=
  match l with
  | [] => Some []
  | (i, s) :: l' => match evidence_of s, steps_of l' with Some e, Some k => Some ((i, e) :: k) | _, _ => None end
  end.

(** The tree that the first nodes are, and those that are left; [depth] is that of the nodes' list. *)
Fixpoint tree_of (depth : nat) (l : list node) : option (tree * list node) :=
  match depth, l with
  | S d, Node by_ split :: rest =>
      match steps_of by_, split with
      | Some s, None => Some (Leaf s, rest)
      | Some s, Some k =>
          match tree_of d rest with
          | Some (a, rest) => match tree_of d rest with Some (b, rest) => Some (Split s k a b, rest) | None => None end
          | None => None
          end
      | None, _ => None
      end
  | _, _ => None
  end.
Fixpoint trees_of (most : nat) (l : list node) : option (list tree) :=
  match most, l with
  | _, [] => Some []
  | S n, _ => match tree_of (length l) l with
      | Some (t, rest) => match trees_of n rest with Some ts => Some (t :: ts) | None => None end
      | None => None
      end
  | O, _ => None
  end.

(** A machine by the numbers that stand for its tolerances. *)
Definition take (q : quantity) (l : list Claim.number) : Claim.number * list Claim.number :=
  match q, l with
  | One x, _ => (denoted x, l)
  | Between _ _, x :: l' => (x, l')
  | Between a _, [] => (denoted a, [])
  end.
Definition take3 (t : triple quantity) (l : list Claim.number) : numbers * list Claim.number :=
  let (x, l) := take (first t) l in let (y, l) := take (second t) l in let (z, l) := take (third t) l in (Numbers x y z, l).
Definition take_leg (w : written_leg) (l : list Claim.number) : exact_leg * list Claim.number :=
  match w with
  | Slider_ d a p len m =>
      let (d, l) := take3 d l in let (a, l) := take3 a l in let (p, l) := take3 p l in let (len, l) := take len l in
      (ExactSlider d a p len m, l)
  | Strut_ a p k => let (a, l) := take3 a l in let (p, l) := take3 p l in
      match k with Some k => let (k, l) := take3 k l in (ExactStrut a p (Some k), l) | None => (ExactStrut a p None, l) end
  | Planar_ d => let (d, l) := take3 d l in (ExactPlanar d, l)
  end.
Fixpoint take_legs (ws : list written_leg) (l : list Claim.number) : list exact_leg * list Claim.number :=
  match ws with
  | [] => ([], l)
  | w :: ws' => let (e, l) := take_leg w l in let (es, l) := take_legs ws' l in (e :: es, l)
  end.

Definition failure_of (f : violation) : option failure :=
  match f with
  | Reach => Some OutOfReach
  | Obligation i [[a; b; c]] => Some (Fails i (a, b, c) (a, b, c))
  | Obligation i [[a; b; c]; [d; e; f]] => Some (Fails i (a, b, c) (d, e, f))
  | Obligation i [] => let none := (0, 0, 0)%Z in Some (Fails i none none)
  | Obligation _ _ => None
  | Row i leg => Some (FailsAlong i leg)
  end.

(** What the format asks of bounds. *)
Definition is_bound (r : requirement) : bool :=
  match r with
  | PsiMax b | PsiMin b | SerialMargin _ b | ParallelMargin b | ConstraintMargin b => certainly exact_bits true b
  | Stiffness joint b => certainly exact_bits true joint && certainly exact_bits true b
  | JointSpeed _ tool b => certainly exact_bits true tool && certainly exact_bits true b
  | ConditionMax b => certainly exact_bits true (Minus b (1 // 1))
  | NotSingular | JointMin _ _ | JointMax _ _ => true
  end.
(** A quantity, leg and end stand once. *)
Definition is_same (r q : written_requirement) : bool :=
  (about_text (about_ r) =? about_text (about_ q)) && Bool.eqb (is_max r) (is_max q) &&
  match leg_ r, leg_ q with Some n, Some m => Nat.eqb n m | None, None => true | _, _ => false end.
Fixpoint is_each_once (rs : list written_requirement) : bool :=
  match rs with [] => true | r :: rs' => negb (existsb (is_same r) rs') && is_each_once rs' end.

(** The ends of a tolerance differ. *)
Definition is_range (q : quantity) : bool :=
  match q with One _ => true | Between a b => certainly exact_bits true (Minus (denoted b) (denoted a)) end.
Definition three_of (t : triple quantity) : list quantity := [first t; second t; third t].
Definition quantities_of (l : written_leg) : list quantity :=
  match l with
  | Slider_ d a p len _ => three_of d ++ three_of a ++ three_of p ++ [len]
  | Strut_ a p k => three_of a ++ three_of p ++ match k with Some k => three_of k | None => [] end
  | Planar_ d => three_of d
  end%list.

Definition is_well_formed (ls : list written_leg) (rs : list written_requirement) (c : claim) : bool :=
  Nat.leb 3 (length ls) && forallb (is_shaped (length ls)) rs && is_each_once rs && forallb is_range (flat_map quantities_of ls) && forallb is_bound (require c).

Definition accept (c : certificate) : bool :=
  is_plain_certificate c &&
  match subject_ c, proof_ c with
  | Machine_ ls w rs, Nodes bits nodes =>
      let k := claim_of ls w rs in
      match tree_of (length nodes) nodes with
      | Some (t, []) => is_well_formed ls rs k &&
          certify exact_bits bits k (length_order (legs k)) (map direction_order (legs k)) t
      | _ => false
      end
  | Machine_ ls w rs, ByWitness bits point machine fails =>
      match point, take_legs ls (map denoted machine), failure_of fails with
      | [x; y; z], (m, []), Some f => is_well_formed ls rs (claim_of ls w rs) &&
          refute exact_bits (claim_of ls w rs) m (Numbers (denoted x) (denoted y) (denoted z)) f
      | _, _, _ => false
      end
  | Closed_ _ side rs, Nodes _ _ =>
      match closed_bounds rs with Some (least, greatest) => check_closed exact_bits (denoted side) least greatest | None => false end
  | Postulate_ None, Nodes bits nodes => match trees_of 4 nodes with Some ts => check_postulate bits ts | None => false end
  | Postulate_ (Some q), Nodes bits nodes =>
      match trees_of 4 nodes with Some ts => is_range q && check_postulate_up_to bits (greatest (tolerance_of q)) ts | None => false end
  | _, ByWitness _ _ _ _ => false
  end.

Theorem accept_sound : forall c, accept c = true -> means c.
Proof.
  intros [s p t v] h. unfold accept in h. apply andb_true_iff in h as [_ h]. unfold means. cbn [subject_ proof_] in *.
  destruct s as [ls w rs | offset side rs | [q |]], p as [bits nodes | bits point machine fails]; try discriminate.
  - cbv zeta in h. destruct (tree_of _ nodes) as [[tr [|]] |]; try discriminate. apply andb_true_iff in h as [_ h].
    exact (certify_sound _ _ _ _ _ _ h).
  - destruct point as [| x [| y [| z [|]]]]; try discriminate. destruct (take_legs _ _) as [m [|]]; [| discriminate].
    destruct (failure_of fails) as [f |]; [| discriminate]. apply andb_true_iff in h as [_ h].
    exact (refute_sound _ _ _ _ _ h).
  - destruct (closed_bounds rs) as [[k l] |]; [| discriminate]. exact (check_closed_sound _ _ _ _ h _).
  - destruct (trees_of 4 nodes) as [ts |]; [| discriminate]. apply andb_true_iff in h as [_ h]. split; [exact (check_postulate_greatest _ _ _ h) |].
    intros psi h1 [_ h2] L a e hL P hP. exact (check_postulate_up_to_sound _ _ _ h L a e hL psi (conj h1 h2) P hP).
  - destruct (trees_of 4 nodes) as [ts |]; [| discriminate]. intros psi h1 L a e hL P hP.
    exact (check_postulate_sound _ _ h L a e hL psi h1 P hP).
Qed.

(** A text, and what was read from it. *)
Definition verify (t : string) (c : certificate) : bool := String.eqb (String.concat "" (print c)) t && accept c.

Theorem verify_sound : forall t c, verify t c = true ->
  t = String.concat "" (print c) /\ is_plain_certificate c = true /\ means c.
Proof.
  intros t c h. apply andb_true_iff in h as [e h]. apply String.eqb_eq in e. split; [symmetry; exact e |].
  split; [| exact (accept_sound c h)]. unfold accept in h. apply andb_true_iff in h as [p _]. exact p.
Qed.
