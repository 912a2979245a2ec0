(** * Certificates: their text, what they mean, and which are accepted

    A certificate as [read] is a value of the types below; whoever reads it is not
    trusted.  [print] gives the only text that it stands for, so a text that differs
    from what is printed is refused; [means] is what it says; and what [verify]
    accepts is true ([verify_sound]).  To know what has been proved, read [print],
    [claim_of] and [means], with the definitions of Statement.v, Witness.v,
    Cubes.v, Closed.v and Kinematics.v. *)

From Coq Require Import ZArith QArith Reals Lra List Bool String Ascii DecimalString.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal Scaling Postulate Paper Claim.
From Orthocert.kernel Require Import Configuration Arm Written AtPoint Orientation Turning Accelerated Singular Between BetweenWritten Twins TwinsDriven TwinsWritten Far FarWritten Legs Inputs Pose Driven Hastened.
From Orthocert.kernel Require Tolerances.
From Orthocert.kernel Require Import Statement Check Number Problem Faces Witness Closed Cubes NoCube.
Import ListNotations.
Local Open Scope nat_scope.
Local Open Scope list_scope.
Local Open Scope string_scope.
Local Notation length := List.length.

(** ** Certificates *)

Inductive operator := Addition | Subtraction | Multiplication | Division.

(** A number as it is written, and a formula, in which names stand. *)
Inductive term (N : Type) :=
  | Literal (whole decimals : Decimal.uint)
  | Name (n : N)
  | Negative (x : term N)
  | Binary (o : operator) (x y : term N)
  | Power (x : term N) (n : positive)
  | SquareRoot (x : term N).
Arguments Literal {N}. Arguments Name {N}. Arguments Negative {N}. Arguments Binary {N}. Arguments Power {N}. Arguments SquareRoot {N}.
(** What a name is: that of a parameter of an atlas; in a cell of it, its number, and from where to where it is there.
    No text has the second ([is_plain_certificate]). *)
Inductive reference := Called (name : string) | InCell (k : nat) (a b : Q).
Definition expression : Type := term reference.

Inductive quantity := One (x : expression) | Between (min max : expression).
Record triple (A : Type) := Triple { first : A; second : A; third : A }.
Arguments Triple {A}. Arguments first {A}. Arguments second {A}. Arguments third {A}.

Inductive written_leg :=
  | Slider_ (direction anchor platform : triple quantity) (length : quantity) (mode : bool)
  | Strut_ (anchor platform : triple quantity) (base_axis : option (triple quantity))
  | Planar_ (direction : triple quantity).

(** [leg] is counted from one. *)
Inductive written_body :=
  | AlongLeg_ (leg : nat) (radius after_base before_platform : expression) (offset : option (triple expression))
  | Fixed_ (on_platform : bool) (from to : triple expression) (radius : expression).

(** Legs of machines whose claims are those of Legs.v, their vectors of as many numbers as there are: rods on arms, of all legs or none. *)
Inductive written_driven :=
  | AnySlider_ (direction anchor platform : list quantity) (length : quantity) (mode : bool)
  | AnyStrut_ (anchor platform : list quantity) (base_axis : option (list quantity))
  | AnyPlanar_ (direction : list quantity)
  | AnyArm_ (axis reference anchor platform : list quantity) (arm rod : quantity) (mode : bool).

Inductive about := Transmission | JointRange | Speed_ | Condition_ | Serial_ | Parallel_ | Stiffness_ | Constraint_ | Force_ | Clearance_ | Acceleration_ | OneToOne_ | Accuracy_ | LegAngle_ | BaseJoint_ | PlatformJoint_ | Load_.
(** [leg_] is counted from one; [given_] is the platform's speed, of speeds, the force on it, of forces, the joints' stiffness, of stiffness,
    the joints' error, of accuracy, and the greatest angle if it turns, its acceleration and speed, of accelerations, an axis, of angles at joints, and a force on the platform, of loads. *)
Inductive written_given := Given_ (x : expression) | Each_ (xs : list expression) | Motion_ (acceleration speed : expression) | Near_ (error angle : expression).
Inductive written_end := AtLeast_ (b : expression) | AtMost_ (b : expression) | Within_ (a b : expression) | Holds_.
Record written_requirement := Require_ { about_ : about; leg_ : option nat; given_ : option written_given; end_ : written_end }.

Inductive written_region :=
  | Box_ (min max : triple expression)
  | Cylinder_ (center_x center_y radius bottom top : expression).
(** Of a box as many numbers as the platform has coordinates of place. *)
Inductive written_place := AnyBox_ (min max : list expression) | AnyCylinder_ (center_x center_y radius bottom top : expression).

(** A joint of a mechanism by formulas: its row of M, or its coordinate. *)
Inductive written_form := Row_ (row : list (term string)) | Rho_ (rho : term string).

(** Degrees. *)
Inductive written_orientation :=
  | Range_ (a b : expression)
  | RollPitchYaw_ (roll pitch yaw : expression * expression)
  | Angle_ (a : expression)
  | Tilt_ (tilt torsion : expression).

Inductive subject :=
  (* legs that do not turn the platform *)
  | Machine_ (legs : list written_leg) (workspace : written_region) (bodies : list written_body) (require : list written_requirement)
  (* legs in any motion; a length and orientations of platforms that turn *)
  | Legs_ (kind : mobility) (legs : list written_driven) (length : option expression) (workspace : written_place)
      (orientation : option written_orientation) (require : list written_requirement)
  (* struts of a platform that turns: its joint in the base and on the platform, each of two numbers in the plane *)
  | Turning_ (kind : motion) (struts : list (list quantity * list quantity)) (length : expression) (workspace : written_place)
      (orientation : written_orientation) (bodies : list written_body) (require : list written_requirement)
  (* by formulas: names, and all joints *)
  | Formulas_ (coordinates : list string) (parameters : list (string * quantity)) (definitions : list (string * term string))
      (joints : list written_form) (min max : list expression) (require : list written_requirement)
  (* the Orthoglide on the paper's cube *)
  | Closed_ (offset side : expression) (require : list written_requirement)
  (* no cube of this side, with its centre in the box *)
  | NoCube_ (legs : list written_leg) (min max : triple expression) (require : list written_requirement) (side : expression)
  (* [None]: every psi *)
  | Postulate_ (psi : option quantity)
  (* parameters by name, and from where to where; legs, workspace and requirements in whose numbers they are named; shares *)
  | Atlas_ (parameters : list (string * (expression * expression))) (legs : list written_leg) (workspace : written_region)
      (require : list written_requirement) (certified refuted : expression).

Inductive step :=
  | Plain (name : string)
  | Multiplied (name : string) (y : list (list Z)) (places : N)
  | AtCorner (f : face)
  | Conditioned_ (y : list (list Z)) (places : N) (mu : list Z)
  | Accurate_ (y : list (list Z)) (places : N) (kappa : Z) (q : N)
  | Inside_ (s : step) (n : Z) (places : N)
  | Turned_ (s : step) (n : Z) (places : N)
  | AtControls_ (s : step)
  (* [ends]: of each quantity with two ends, where the one machine is *)
  | Apart_ (s : step) (ends : string) (directions : list (list Z))
  | Fan_ (cs : list (list Z * Z * N * step))
  (* [weights]: of each row, of each quantity with two ends by what mu is more; or none *)
  | Between_ (mu : list Z) (places : N) (weights : list (list Z)) (lower upper : step)
  (* [rows]: of each row the upper triangle of a matrix, or nothing *)
  | Together_ (s : step) (rows : list (list Z)) (places : N).

Inductive violation :=
  | Reach | Obligation (number : nat) (directions : list (list Z)) | Row (number leg : nat) | Dependent_
  (* det M has the other sign at this point *)
  | Singular_ (other : list expression)
  (* a point of this box has the same joint coordinates, about which the matrix is the inverse of M *)
  | Same_ (number : nat) (least greatest : list expression) (y : list (list Z)) (places : N).

(** [fails_], [offset_]: of leaves on which, moved by so many 16ths of the side, a claim fails. *)
Record node := Node { by_ : list (nat * step); split_ : option nat; fails_ : option violation; offset_ : list Z }.

(** Of the box of an atlas's parameters, in preorder. *)
Inductive cell :=
  (* halved along a parameter *)
  | Cut (k : nat)
  | Proved (precision : positive) (chords : option (list (list Z) * N)) (nodes : list node)
  | Disproved (precision : positive) (point : list expression) (machine : list expression) (how : violation)
  | Undecided.

Inductive proof :=
  (* [chords]: the one matrix of the tree, over 2^places *)
  | Nodes (precision : positive) (chords : option (list (list Z) * N)) (nodes : list node)
  (* [machine]: a value of each tolerance, in order *)
  | ByWitness (precision : positive) (point : list expression) (machine : list expression) (how : violation)
  | Cells (cells : list cell).

Record certificate := Certificate { subject_ : subject; proof_ : proof; tool : string; version : string }.

(** ** Text: section 2 of FORMAT.md *)

Definition text := list string.

(** [a ++ b], with a stack that does not grow: texts are long. *)
Definition join (a b : text) : text := rev_append (rev_append a []) b.
Lemma join_app : forall a b, join a b = (a ++ b)%list.
Proof. intros. unfold join. rewrite !rev_append_rev, app_nil_r, rev_involutive. reflexivity. Qed.

Fixpoint separated (l : list text) : text :=
  match l with [] => [] | [t] => t | t :: l' => join t ("," :: separated l')%list end.
Definition array (l : list text) : text := "[" :: join (separated l) ["]"].
Definition object (l : list text) : text := "{" :: join (separated l) ["}"].
Definition quoted (s : string) : text := [""""; s; """"].
Definition field (key : string) (value : text) : text := (("""" ++ key ++ """:")%string :: value)%list.
(** A variant. *)
Definition variant (name : string) (value : text) : text := object [field name value].

Definition natural (n : nat) : text := [NilZero.string_of_uint (Nat.to_uint n)].
Definition positive_text (n : positive) : text := [NilZero.string_of_uint (Pos.to_uint n)].
Definition integer_text (n : Z) : text := [NilZero.string_of_int (Z.to_int n)].
Definition places_text (n : N) : text := [NilZero.string_of_uint (N.to_uint n)].

(** Section 3: how strong an expression holds its parts. *)
Definition strength {N : Type} (x : term N) : nat :=
  match x with
  | Binary (Addition | Subtraction) _ _ => 1
  | Binary (Multiplication | Division) _ _ => 2
  | Negative _ => 3
  | Power _ _ => 4
  | Literal _ _ | Name _ | SquareRoot _ => 5
  end.
Definition symbol (o : operator) : string :=
  match o with Addition => "+" | Subtraction => "-" | Multiplication => "*" | Division => "/" end.

Fixpoint term_text {N : Type} (name : N -> string) (x : term N) : text :=
  let part (enough : nat) (y : term N) :=
    if Nat.leb enough (strength y) then term_text name y else ("(" :: term_text name y ++ [")"])%list in
  match x with
  | Literal w Decimal.Nil => [NilEmpty.string_of_uint w]
  | Literal w d => [NilEmpty.string_of_uint w; "."; NilEmpty.string_of_uint d]
  | Name n => [name n]
  | Negative y => "-" :: part 3 y
  | Binary o y z => part (strength x) y ++ symbol o :: part (S (strength x)) z
  | Power y n => part 5 y ++ "^" :: positive_text n
  | SquareRoot y => "sqrt(" :: term_text name y ++ [")"]
  end%list.

Definition number (x : expression) : text := ("""" :: term_text (fun n => match n with Called s => s | InCell _ _ _ => "" end) x ++ [""""])%list.
Definition formula (x : term string) : text := ("""" :: term_text (fun n => n) x ++ [""""])%list.
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

Definition driven_text (l : written_driven) : text :=
  let vector v := array (map quantity_text v) in
  let mode (m : bool) := field "mode" (quoted (if m then "+" else "-")) in
  object match l with
  | AnySlider_ d a p len m => [field "drive" (quoted "slider"); field "direction" (vector d); field "anchor" (vector a);
      field "platform" (vector p); field "length" (quantity_text len); mode m]
  | AnyStrut_ a p k => [field "drive" (quoted "strut"); field "anchor" (vector a); field "platform" (vector p)] ++
      match k with Some k => [field "base_axis" (vector k)] | None => [] end
  | AnyPlanar_ d => [field "drive" (quoted "planar"); field "direction" (vector d)]
  | AnyArm_ k x a p r len m => [field "drive" (quoted "arm"); field "axis" (vector k); field "reference" (vector x); field "anchor" (vector a);
      field "platform" (vector p); field "arm" (quantity_text r); field "length" (quantity_text len); mode m]
  end.

Definition about_text (a : about) : string :=
  match a with
  | Transmission => "transmission" | JointRange => "joint_range" | Speed_ => "joint_speed"
  | Condition_ => "conditioning" | Serial_ => "serial_margin" | Parallel_ => "parallel_margin"
  | Stiffness_ => "stiffness" | Constraint_ => "constraint_margin"
  | Force_ => "joint_force" | Clearance_ => "clearance" | Acceleration_ => "joint_acceleration" | OneToOne_ => "one_to_one" | Accuracy_ => "accuracy"
  | LegAngle_ => "leg_angle" | BaseJoint_ => "base_joint" | PlatformJoint_ => "platform_joint" | Load_ => "load"
  end.
Definition end_text (e : written_end) : string := match e with AtLeast_ _ => "min" | AtMost_ _ => "max" | Within_ _ _ => "within" | Holds_ => "holds" end.
Definition bound_text (e : written_end) : list text :=
  match e with AtLeast_ b | AtMost_ b => [field "bound" (number b)] | Within_ a b => [field "bound" (array [number a; number b])] | Holds_ => [] end.
Definition requirement_text (r : written_requirement) : text :=
  object (field "quantity" (quoted (about_text (about_ r))) ::
    match leg_ r with Some n => [field "leg" (natural n)] | None => [] end ++
    match given_ r with
    | Some (Given_ x) => [field "given" (variant (match about_ r with Stiffness_ => "joint" | Accuracy_ => "joint_error" | _ => "tool" end) (array [number x]))]
    | Some (Each_ xs) => [field "given" (variant (match about_ r with BaseJoint_ | PlatformJoint_ => "axis" | Load_ => "force" | _ => "joint" end) (array (map number xs)))]
    | Some (Motion_ a v) => [field "given" (object [field "acceleration" (array [number a]); field "speed" (array [number v])])]
    | Some (Near_ e a) => [field "given" (object [field "joint_error" (array [number e]); field "max_angle" (array [number a])])]
    | None => []
    end ++
    field "end" (quoted (end_text (end_ r))) :: bound_text (end_ r))%list.

Definition region_text (w : written_region) : text :=
  match w with
  | Box_ a b => variant "box" (object [field "min" (triple_text number a); field "max" (triple_text number b)])
  | Cylinder_ x y r bottom top => variant "cylinder" (object
      [field "center" (array [number x; number y]); field "radius" (number r); field "z" (array [number bottom; number top])])
  end.

Definition place_text (w : written_place) : text :=
  match w with
  | AnyBox_ a b => variant "box" (object [field "min" (array (map number a)); field "max" (array (map number b))])
  | AnyCylinder_ x y r bottom top => region_text (Cylinder_ x y r bottom top)
  end.
Definition motion_text (k : motion) : string := match k with InPlane => "planar" | InSpace => "spatial" | AboutPoint => "spherical" end.
Definition turning_strut_text (l : list quantity * list quantity) : text :=
  let vector v := array (map quantity_text v) in
  object [field "drive" (quoted "strut"); field "anchor" (vector (fst l)); field "platform" (vector (snd l))].
Definition orientation_text (o : written_orientation) : text :=
  let two a b := array [number a; number b] in
  match o with
  | Range_ a b => variant "range" (two a b)
  | RollPitchYaw_ (a, b) (c, d) (e, f) => variant "roll_pitch_yaw" (object [field "roll" (two a b); field "pitch" (two c d); field "yaw" (two e f)])
  | Angle_ a => variant "angle" (number a)
  | Tilt_ a b => variant "tilt" (object [field "tilt" (number a); field "torsion" (number b)])
  end.

Definition body_text (b : written_body) : text :=
  let at_ := triple_text number in
  object match b with
  | AlongLeg_ i r t u o => [field "on" (quoted "leg"); field "leg" (natural i); field "radius" (number r);
      field "trim" (array [number t; number u])] ++ match o with Some o => [field "offset" (at_ o)] | None => [] end
  | Fixed_ moves p q r => [field "on" (quoted (if moves then "platform" else "base")); field "from" (at_ p); field "to" (at_ q);
      field "radius" (number r)]
  end%list.
Definition bodies_text (bs : list written_body) : list text := match bs with [] => [] | _ => [field "bodies" (array (map body_text bs))] end.
Definition machine_text (legs : list written_leg) (w : written_region) (bs : list written_body) (rs : list written_requirement) : text :=
  object ([field "mechanism" (variant "translational" (array (map leg_text legs))); field "workspace" (region_text w)] ++
    bodies_text bs ++ [field "require" (array (map requirement_text rs))])%list.
Definition subject_text (s : subject) : text :=
  match s with
  | Machine_ legs w bs rs => variant "machine" (machine_text legs w bs rs)
  | NoCube_ legs a b rs side => variant "no_cube" (object [field "machine" (machine_text legs (Box_ a b) [] rs); field "side" (number side)])
  | Legs_ k ls ell w o rs =>
      let legs := array (map driven_text ls) in
      let turning name := variant name (object (field "legs" legs :: match ell with Some x => [field "characteristic_length" (number x)] | None => [] end)) in
      variant "machine" (object (field "mechanism" match k with
          | Translates => variant "translational" legs
          | TranslatesInPlane => turning "planar"
          | Turns m => turning (motion_text m)
          end :: field "workspace" (place_text w) :: match o with Some o => [field "orientation" (orientation_text o)] | None => [] end ++
        [field "require" (array (map requirement_text rs))]))%list
  | Turning_ k ls ell w o bs rs => variant "machine" (object
      ([field "mechanism" (variant (motion_text k) (object
         [field "legs" (array (map turning_strut_text ls)); field "characteristic_length" (number ell)]));
       field "workspace" (place_text w);
       field "orientation" (orientation_text o)] ++ bodies_text bs ++
       [field "require" (array (map requirement_text rs))]))%list
  | Formulas_ xs ps ds rows a b rs => variant "machine" (object
      [field "mechanism" (variant "formulas" (object
         [field "coordinates" (array (map quoted xs)); field "parameters" (array (map (fun p => array [quoted (fst p); quantity_text (snd p)]) ps));
          field "definitions" (array (map (fun d => array [quoted (fst d); formula (snd d)]) ds));
          field "joints" (array (map (fun j => match j with Row_ r => variant "row" (array (map formula r)) | Rho_ x => variant "rho" (formula x) end) rows))]));
       field "workspace" (variant "box" (object [field "min" (array (map number a)); field "max" (array (map number b))]));
       field "require" (array (map requirement_text rs))])
  | Closed_ offset side rs => variant "machine" (object
      [field "mechanism" (variant "orthoglide" (object [field "offset" (number offset)]));
       field "workspace" (variant "cube" (object [field "side" (number side)]));
       field "require" (array (map requirement_text rs))])
  | Postulate_ psi => variant "postulate" (object
      [field "psi_max" (match psi with None => quoted "all" | Some q => quantity_text q end)])
  | Atlas_ ps legs w rs certified refuted => variant "atlas" (object
      [field "parameters" (array (map (fun p => object [field "name" (quoted (fst p)); field "min" (number (fst (snd p))); field "max" (number (snd (snd p)))]) ps));
       field "machine" (machine_text legs w [] rs); field "certified" (number certified); field "refuted" (number refuted)])
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
  | Accurate_ y places kappa q => variant "accuracy" (array [multiplier_text y places; integer_text kappa; places_text q])
  | Inside_ s n places => variant "inside" (array [evidence_text s; integer_text n; places_text places])
  | Turned_ s n places => variant "turned" (array [evidence_text s; integer_text n; places_text places])
  | AtControls_ s => variant "control" (evidence_text s)
  | Apart_ s ends vs => variant "tolerances" (array [evidence_text s; quoted ends; array (map integers_text vs)])
  | Fan_ cs => variant "fan" (array (map (fun p => let '(c, n, places, s) := p in array [integers_text c; integer_text n; places_text places; evidence_text s]) cs))
  | Between_ mu places weights lower upper => variant "between" (array [integers_text mu; places_text places; array (map integers_text weights); evidence_text lower; evidence_text upper])
  | Together_ s rows places => variant "together" (array [evidence_text s; array (map integers_text rows); places_text places])
  end.
Definition step_text (s : nat * step) : text := array [natural (fst s); evidence_text (snd s)].
Definition violation_text (f : violation) : text :=
  match f with
  | Reach => quoted "reach"
  | Dependent_ => quoted "dependent"
  | Obligation i vs => variant "obligation" (array [natural i; array (map integers_text vs)])
  | Row i l => variant "row" (array [natural i; natural l])
  | Singular_ other => variant "singular" (array (map number other))
  | Same_ i a b y places => variant "same" (object [field "obligation" (natural i); field "least" (array (map number a)); field "greatest" (array (map number b));
      field "inverse" (multiplier_text y places)])
  end.
Definition node_text (n : node) : text :=
  object (match by_ n with [] => [] | l => [field "by" (array (map step_text l))] end ++
    match split_ n with Some k => [field "split" (natural k)] | None => [] end ++
    match fails_ n with Some f => [field "fails" (violation_text f)] | None => [] end ++
    match offset_ n with [] => [] | l => [field "at" (integers_text l)] end)%list.

Definition tree_text (bits : positive) (chords : option (list (list Z) * N)) (nodes : list node) : text :=
  object (field "precision" (positive_text bits) :: match chords with Some (y, places) => [field "chords" (multiplier_text y places)] | None => [] end ++
    [field "nodes" (array (map node_text nodes))])%list.
Definition witness_text (bits : positive) (point machine : list expression) (how : violation) : text :=
  object ([field "precision" (positive_text bits); field "point" (array (map number point))] ++
    match machine with [] => [] | l => [field "machine" (array (map number l))] end ++
    [field "fails" (violation_text how)])%list.
Definition cell_text (c : cell) : text :=
  match c with
  | Cut k => variant "split" (natural k)
  | Proved bits chords nodes => variant "certified" (tree_text bits chords nodes)
  | Disproved bits point machine how => variant "refuted" (witness_text bits point machine how)
  | Undecided => quoted "undecided"
  end.
Definition proof_text (p : proof) : text :=
  match p with
  | Nodes bits chords nodes => variant "tree" (tree_text bits chords nodes)
  | ByWitness bits point machine how => variant "witness" (witness_text bits point machine how)
  | Cells cells => variant "atlas" (array (map cell_text cells))
  end.

Definition print (c : certificate) : text :=
  join (object [field "format" (quoted "orthocert/2"); field "claim" (subject_text (subject_ c));
    field "verdict" (quoted (match proof_ c with Nodes _ _ _ | Cells _ => "certified" | ByWitness _ _ _ _ => "refuted" end));
    field "proof" (proof_text (proof_ c));
    field "provenance" (object [field "tool" (quoted (tool c)); field "version" (quoted (version c))])])
    [String "010" ""].

(** Nothing in it ends a string of JSON. *)
Definition is_plain (s : string) : bool :=
  forallb (fun c => negb (c =? """")%char && negb (c =? "\")%char && Ascii.leb " " c && Ascii.leb c "~")
    (list_ascii_of_string s).

Fixpoint is_plain_step (s : step) : bool :=
  match s with
  | Plain name | Multiplied name _ _ => is_plain name
  | Inside_ s _ _ | Turned_ s _ _ | AtControls_ s | Together_ s _ _ => is_plain_step s
  | Apart_ s ends _ => is_plain ends && is_plain_step s
  | Fan_ cs => forallb (fun p => is_plain_step (snd p)) cs
  | Between_ _ _ _ lower upper => is_plain_step lower && is_plain_step upper
  | AtCorner _ | Conditioned_ _ _ _ | Accurate_ _ _ _ _ => true
  end.
(** Letters, digits and _, a letter first; [sqrt] is none. *)
Definition is_name (s : string) : bool :=
  let letter c := let n := nat_of_ascii c in Nat.leb 65 n && Nat.leb n 90 || Nat.leb 97 n && Nat.leb n 122 in
  let digit c := let n := nat_of_ascii c in Nat.leb 48 n && Nat.leb n 57 in
  match list_ascii_of_string s with
  | [] => false
  | c :: l => letter c && forallb (fun c => letter c || digit c || (c =? "_")%char) l && Nat.leb (length l) 31 && negb (s =? "sqrt")
  end.
Fixpoint are_names (x : term string) : bool :=
  match x with
  | Literal _ _ => true
  | Name n => is_name n
  | Negative y | Power y _ | SquareRoot y => are_names y
  | Binary _ y z => are_names y && are_names z
  end.

(** Section 3: digits, no zero before others, no zero last of decimals; exponents from 2 to 64. Without digits
    ["a--b"] would be [a - (-b)] and [(a - ) - b]. *)
Fixpoint is_written {N : Type} (x : term N) : bool :=
  match x with
  | Literal w d =>
      match w with Decimal.Nil => false | Decimal.D0 Decimal.Nil => true | Decimal.D0 _ => false | _ => true end &&
      match Decimal.rev d with Decimal.D0 _ => false | _ => true end
  | Name _ => true
  | Negative y | SquareRoot y => is_written y
  | Power y n => is_written y && Pos.leb 2 n && Pos.leb n 64
  | Binary _ y z => is_written y && is_written z
  end.

Definition in_quantity (q : quantity) : list expression := match q with One x => [x] | Between a b => [a; b] end.
Definition in_triple {A : Type} (t : triple A) : list A := [first t; second t; third t].
Definition in_vector (t : triple quantity) : list expression := flat_map in_quantity (in_triple t).
Definition in_leg (l : written_leg) : list expression :=
  match l with
  | Slider_ d a p len _ => in_vector d ++ in_vector a ++ in_vector p ++ in_quantity len
  | Strut_ a p k => in_vector a ++ in_vector p ++ match k with Some k => in_vector k | None => [] end
  | Planar_ d => in_vector d
  end%list.
Definition in_driven (l : written_driven) : list expression :=
  flat_map in_quantity match l with
  | AnySlider_ d a p len _ => d ++ a ++ p ++ [len]
  | AnyStrut_ a p k => a ++ p ++ match k with Some k => k | None => [] end
  | AnyPlanar_ d => d
  | AnyArm_ k x a p r len _ => k ++ x ++ a ++ p ++ [r; len]
  end%list.
Definition in_place (w : written_place) : list expression :=
  match w with AnyBox_ a b => a ++ b | AnyCylinder_ x y r bottom top => [x; y; r; bottom; top] end%list.
Definition in_region (w : written_region) : list expression :=
  match w with Box_ a b => in_triple a ++ in_triple b | Cylinder_ x y r bottom top => [x; y; r; bottom; top] end%list.
Definition in_orientation (o : written_orientation) : list expression :=
  match o with Range_ a b | Tilt_ a b => [a; b] | RollPitchYaw_ (a, b) (c, d) (e, f) => [a; b; c; d; e; f] | Angle_ a => [a] end.
Definition in_requirement (r : written_requirement) : list expression :=
  (match given_ r with Some (Given_ x) => [x] | Some (Each_ xs) => xs | Some (Motion_ a v) | Some (Near_ a v) => [a; v] | None => [] end ++
   match end_ r with AtLeast_ b | AtMost_ b => [b] | Within_ a b => [a; b] | Holds_ => [] end)%list.
Definition in_body (b : written_body) : list expression :=
  match b with
  | AlongLeg_ _ r t u o => r :: t :: u :: match o with Some o => in_triple o | None => [] end
  | Fixed_ _ p q r => in_triple p ++ in_triple q ++ [r]
  end%list.
Definition in_subject (s : subject) : list expression :=
  match s with
  | Machine_ ls w bs rs => flat_map in_leg ls ++ in_region w ++ flat_map in_body bs ++ flat_map in_requirement rs
  | Legs_ _ ls ell w o rs => flat_map in_driven ls ++ match ell with Some x => [x] | None => [] end ++ in_place w ++
      match o with Some o => in_orientation o | None => [] end ++ flat_map in_requirement rs
  | Turning_ _ ls ell w o bs rs =>
      flat_map (fun l => flat_map in_quantity (fst l ++ snd l)) ls ++ ell :: in_place w ++ in_orientation o ++ flat_map in_body bs ++ flat_map in_requirement rs
  | Formulas_ _ ps _ _ a b rs => flat_map (fun p => in_quantity (snd p)) ps ++ a ++ b ++ flat_map in_requirement rs
  | Closed_ offset side rs => offset :: side :: flat_map in_requirement rs
  | NoCube_ ls a b rs side => side :: flat_map in_leg ls ++ in_triple a ++ in_triple b ++ flat_map in_requirement rs
  | Postulate_ (Some q) => in_quantity q
  | Postulate_ None => []
  | Atlas_ _ ls w rs _ _ => flat_map in_leg ls ++ in_region w ++ flat_map in_requirement rs
  end%list.
(** Its numbers name these, and nothing else. *)
Fixpoint is_of (ns : list string) (x : expression) : bool :=
  match x with
  | Literal _ _ => true
  | Name (Called n) => existsb (String.eqb n) ns
  | Name (InCell _ _ _) => false
  | Negative y | Power y _ | SquareRoot y => is_of ns y
  | Binary _ y z => is_of ns y && is_of ns z
  end.
Definition are_written (ns : list string) (l : list expression) : bool := forallb (fun x => is_written x && is_of ns x) l.
Definition in_violation (f : violation) : list expression := match f with Singular_ other => other | Same_ _ a b _ _ => (a ++ b)%list | _ => [] end.
Definition is_precision (bits : positive) : bool := Pos.leb 32 bits && Pos.leb bits 1024.

(** Every string of the certificate is one, every number is written as section 3 writes it, and precisions are
    as section 7 has them: its text has no other shape than that of [print]. *)
Definition is_plain_certificate (c : certificate) : bool :=
  is_plain (tool c) && is_plain (version c) &&
  match subject_ c with
  | Formulas_ xs ps ds rows _ _ _ =>
      forallb is_name xs && forallb (fun p => is_name (fst p)) ps && forallb (fun d => is_name (fst d) && are_names (snd d) && is_written (snd d)) ds &&
      forallb (fun j => forallb (fun x => are_names x && is_written x) match j with Row_ r => r | Rho_ x => [x] end) rows
  | Atlas_ ps _ _ _ certified refuted => forallb (fun p => is_name (fst p) && are_written [] [fst (snd p); snd (snd p)]) ps && are_written [] [certified; refuted]
  | _ => true
  end &&
  let ns := match subject_ c with Atlas_ ps _ _ _ _ _ => map fst ps | _ => [] end in
  let is_tree bits nodes := is_precision bits && forallb (fun n => forallb (fun s => is_plain_step (snd s)) (by_ n) &&
    match fails_ n with Some f => are_written ns (in_violation f) | None => true end) nodes in
  let is_witness bits point machine how := is_precision bits && are_written ns (point ++ machine ++ in_violation how)%list in
  are_written ns (in_subject (subject_ c)) &&
  match proof_ c with
  | Nodes bits _ nodes => is_tree bits nodes
  | ByWitness bits point machine how => is_witness bits point machine how
  | Cells cells => forallb (fun x => match x with
      | Proved bits _ nodes => is_tree bits nodes
      | Disproved bits point machine how => is_witness bits point machine how
      | Cut _ | Undecided => true
      end) cells
  end.

(** ** Meaning *)

Fixpoint product_of (base : Claim.number) (n : nat) : Claim.number :=
  match n with O => base | S m => Times (product_of base m) base end.

Fixpoint denoted (x : expression) : Claim.number :=
  match x with
  | Name (Called _) => Over (1 // 1) (0 // 1)     (* no number *)
  | Name (InCell k a b) => Varying k a b
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

Definition position_of (t : triple expression) : position := Position (denoted (first t)) (denoted (second t)) (denoted (third t)).
Definition body_of (b : written_body) : body :=
  match b with
  | AlongLeg_ i r t u o => AlongLeg (pred i) (denoted r) (denoted t) (denoted u)
      match o with Some o => position_of o | None => Position (0 // 1) (0 // 1) (0 // 1) end
  | Fixed_ true p q r => OnPlatform (denoted r) (position_of p) (position_of q)
  | Fixed_ false p q r => OnBase (denoted r) (position_of p) (position_of q)
  end.
(** Two bodies on the base, on the platform, or on one leg, neither beside it. *)
Definition are_fixed (b c : written_body) : bool :=
  match b, c with
  | AlongLeg_ i _ _ _ None, AlongLeg_ j _ _ _ None => Nat.eqb i j
  | Fixed_ a _ _ _, Fixed_ b _ _ _ => Bool.eqb a b
  | _, _ => false
  end.
(** Each with all before it. *)
Fixpoint pairs_of (before bs : list written_body) : list (written_body * written_body) :=
  match bs with
  | [] => []
  | b :: bs' => filter (fun p => negb (are_fixed (fst p) (snd p))) (map (fun c => (b, c)) before) ++ pairs_of (before ++ [b]) bs'
  end%list.

(** Of two bodies on one leg, the lines along them. *)
Definition clearance_of (b c : written_body) (gap : Claim.number) : requirement :=
  match b, c with
  | AlongLeg_ i r _ _ o, AlongLeg_ j r' _ _ o' =>
      let offset o := match o with Some o => position_of o | None => Position (0 // 1) (0 // 1) (0 // 1) end in
      if Nat.eqb i j then Beside (pred i) (offset o) (offset o') (Plus (Plus (denoted r) (denoted r')) gap) else Clearance (body_of b) (body_of c) gap
  | _, _ => Clearance (body_of b) (body_of c) gap
  end.

(** Obligations, section 9: a bound on psi from above takes the place of freedom from singularities. *)
Definition psi_max_of (r : written_requirement) : list requirement :=
  match about_ r, end_ r with Transmission, AtMost_ b => [PsiMax (denoted b)] | _, _ => [] end.
Definition other_of (legs : nat) (bs : list written_body) (r : written_requirement) : list requirement :=
  let each f := map f match leg_ r with Some n => [pred n] | None => seq 0 legs end in
  match about_ r, end_ r, given_ r with
  | Transmission, AtLeast_ b, _ => [PsiMin (denoted b)]
  | JointRange, AtLeast_ b, _ => each (fun i => JointMin i (denoted b))
  | JointRange, AtMost_ b, _ => each (fun i => JointMax i (denoted b))
  | Speed_, AtMost_ b, Some (Given_ tool) => each (fun i => JointSpeed i (denoted tool) (denoted b))
  | Force_, AtMost_ b, Some (Given_ tool) => each (fun i => JointForce i (denoted tool) (denoted b))
  | Acceleration_, AtMost_ b, Some (Motion_ a v) => each (fun i => JointAcceleration i (denoted a) (denoted v) (denoted b))
  | Condition_, AtMost_ b, _ => [ConditionMax (denoted b)]
  | Serial_, AtLeast_ b, _ => each (fun i => SerialMargin i (denoted b))
  | Parallel_, AtLeast_ b, _ => [ParallelMargin (denoted b)]
  | Stiffness_, AtLeast_ b, Some (Given_ joint) => [Stiffness (denoted joint) (denoted b)]
  | Stiffness_, AtLeast_ b, Some (Each_ ks) => [Stiffnesses (map denoted ks) (denoted b)]
  | OneToOne_, Holds_, _ => [OneToOne]
  | Accuracy_, AtMost_ b, Some (Given_ error) => [Accuracy (denoted error) (denoted b)]
  | Constraint_, AtLeast_ b, _ => [ConstraintMargin (denoted b)]
  | Clearance_, AtLeast_ b, _ => map (fun p => clearance_of (fst p) (snd p) (denoted b)) (pairs_of [] bs)
  | _, _, _ => []
  end.
(** The requirement has the keys and the end that it has to have. *)
Definition is_shaped (legs : nat) (r : written_requirement) : bool :=
  let is_leg n := Nat.leb 1 n && Nat.leb n legs in
  match about_ r, end_ r, leg_ r, given_ r with
  | Transmission, (AtLeast_ _ | AtMost_ _), None, None | Condition_, AtMost_ _, None, None | Parallel_, AtLeast_ _, None, None => true
  | Force_, AtMost_ _, leg, Some (Given_ _) => Nat.eqb legs 3 && match leg with Some n => is_leg n | None => true end
  | Accuracy_, AtMost_ _, None, Some (Given_ _) => Nat.eqb legs 3
  | Stiffness_, AtLeast_ _, None, Some (Each_ ks) => Nat.eqb (length ks) legs
  | Stiffness_, AtLeast_ _, None, Some (Given_ _) | Constraint_, AtLeast_ _, None, None | Clearance_, AtLeast_ _, None, None | OneToOne_, Holds_, None, None => true
  | JointRange, (AtLeast_ _ | AtMost_ _), Some n, None | Serial_, AtLeast_ _, Some n, None | Speed_, AtMost_ _, Some n, Some (Given_ _) | Acceleration_, AtMost_ _, Some n, Some (Motion_ _ _) => is_leg n
  | JointRange, (AtLeast_ _ | AtMost_ _), None, None | Serial_, AtLeast_ _, None, None | Speed_, AtMost_ _, None, Some (Given_ _) | Acceleration_, AtMost_ _, None, Some (Motion_ _ _) => true
  | _, _, _, _ => false
  end.
Definition obligations (legs : nat) (bs : list written_body) (rs : list written_requirement) : list requirement :=
  (match flat_map psi_max_of rs with [] => [NotSingular] | l => l end ++ flat_map (other_of legs bs) rs)%list.

Definition claim_of (ls : list written_leg) (w : written_region) (bs : list written_body) (rs : list written_requirement) : claim :=
  MakeClaim (map drive_of ls) (region_of w) (obligations (length ls) bs rs).

(** The same of machines whose claims are those of Configuration.v; their joints are angles, or not. *)
Definition factor_max_of (r : written_requirement) : list demand :=
  match about_ r, end_ r with Transmission, AtMost_ b => [FactorMax (denoted b)] | _, _ => [] end.
Definition axis_of (xs : list expression) : position :=
  let at_ k := nth k (map denoted xs) (0 // 1) in Position (at_ 0) (at_ 1) (at_ 2).
Definition demand_of (are_angles : bool) (legs : nat) (bs : list written_body) (r : written_requirement) : list demand :=
  let each f := map f match leg_ r with Some n => [pred n] | None => seq 0 legs end in
  match about_ r, end_ r with
  | Transmission, AtLeast_ b => [FactorMin (denoted b)]
  | JointRange, AtLeast_ b => each (fun i => LengthMin i (denoted b))
  | JointRange, AtMost_ b => each (fun i => LengthMax i (denoted b))
  | JointRange, Within_ a b => each (fun i => AngleWithin i (denoted a) (denoted b))
  | Condition_, AtMost_ b => [Conditioned (denoted b)]
  | Speed_, AtMost_ b => match given_ r with Some (Given_ tool) => each (fun i => (if are_angles then TurnMax else SpeedMax) i (denoted tool) (denoted b)) | _ => [] end
  | Force_, AtMost_ b => match given_ r with Some (Given_ tool) => each (fun i => ForceMax i (denoted tool) (denoted b)) | _ => [] end
  | Stiffness_, AtLeast_ b => match given_ r with Some (Given_ k) => [StiffnessMin (repeat (denoted k) legs) (denoted b)] | Some (Each_ ks) => [StiffnessMin (map denoted ks) (denoted b)] | _ => [] end
  | Serial_, AtLeast_ b => each (fun i => SerialMin i (denoted b))
  | LegAngle_, AtMost_ b => each (fun i => LegAngleMax i (denoted b))
  | Parallel_, AtLeast_ b => [ParallelMin (denoted b)]
  | BaseJoint_, AtMost_ b => match given_ r with Some (Each_ xs) => each (fun i => JointAngleMax i false (axis_of xs) (denoted b)) | _ => [] end
  | PlatformJoint_, AtMost_ b => match given_ r with Some (Each_ xs) => each (fun i => JointAngleMax i true (axis_of xs) (denoted b)) | _ => [] end
  | Clearance_, AtLeast_ b => map (fun p => Clear (body_of (fst p)) (body_of (snd p)) (denoted b)) (pairs_of [] bs)
  | Load_, AtMost_ b => match given_ r with Some (Each_ force) => each (fun i => LoadMax i (map denoted force) (denoted b)) | _ => [] end
  | Accuracy_, AtMost_ b => match given_ r with Some (Near_ e a) => [OnePose (denoted e) (denoted b) (denoted a)] | Some (Given_ e) => [OnePose (denoted e) (denoted b) (0 // 1)] | _ => [] end
  | Acceleration_, AtMost_ b => match given_ r with Some (Motion_ a v) => each (fun i => AccelerationMax i (denoted a) (denoted v) (denoted b)) | _ => [] end
  | _, _ => []
  end.
Definition demands (are_angles : bool) (legs : nat) (bs : list written_body) (rs : list written_requirement) : list demand :=
  (match flat_map factor_max_of rs with [] => [Nonsingular] | l => l end ++ flat_map (demand_of are_angles legs bs) rs)%list.
(** What is claimed of two points of a workspace, which a cube is not. *)
Definition is_of_two_points (r : written_requirement) : bool := match about_ r with OneToOne_ => true | _ => false end.
Definition is_demand (are_angles : bool) (legs : nat) (r : written_requirement) : bool :=
  match about_ r, end_ r, leg_ r, given_ r with
  | Transmission, (AtLeast_ _ | AtMost_ _), None, None | Condition_, AtMost_ _, None, None => true
  | JointRange, e, leg, None => Bool.eqb are_angles match e with Within_ _ _ => true | _ => false end &&
      match leg with Some n => Nat.leb 1 n && Nat.leb n legs | None => true end
  | _, _, _, _ => false
  end.
(** Of platforms that turn; forces of as many struts as coordinates alone are determined. *)
Definition is_turning_demand (coordinates legs : nat) (r : written_requirement) : bool :=
  let is_leg := match leg_ r with Some n => Nat.leb 1 n && Nat.leb n legs | None => true end in
  match about_ r, end_ r, given_ r with
  | Speed_, AtMost_ _, Some (Given_ _) => is_leg
  | Force_, AtMost_ _, Some (Given_ _) => is_leg && Nat.eqb legs coordinates
  | Stiffness_, AtLeast_ _, Some (Given_ _) => match leg_ r with None => true | Some _ => false end
  | Stiffness_, AtLeast_ _, Some (Each_ ks) => Nat.eqb (length ks) legs && match leg_ r with None => true | Some _ => false end
  | _, _, _ => is_demand false legs r
  end.

(** Or of two points. *)
Definition is_asked (coordinates legs : nat) (r : written_requirement) : bool :=
  match about_ r, end_ r, leg_ r, given_ r with OneToOne_, Holds_, None, None => true | _, _, _, _ => is_turning_demand coordinates legs r end.

(** Or of bodies, of accelerations, and of angles at joints; an axis has [n] numbers. *)
Definition is_asked_of_struts (n coordinates legs : nat) (r : written_requirement) : bool :=
  let is_leg := match leg_ r with Some i => Nat.leb 1 i && Nat.leb i legs | None => true end in
  match about_ r, end_ r, leg_ r, given_ r with
  | BaseJoint_, AtMost_ _, _, Some (Each_ xs) | PlatformJoint_, AtMost_ _, _, Some (Each_ xs) => Nat.eqb (length xs) n && is_leg
  | Acceleration_, AtMost_ _, _, Some (Motion_ _ _) => is_leg
  | Accuracy_, AtMost_ _, None, Some (Near_ _ _) => Nat.eqb legs coordinates
  | Clearance_, AtLeast_ _, None, None => true
  | _, _, _, _ => is_asked coordinates legs r
  end.

(** Of legs in any motion; forces and determinants of as many as coordinates. *)
Definition is_driven_demand (are_angles : bool) (k : mobility) (legs : nat) (r : written_requirement) : bool :=
  let is_leg := match leg_ r with Some n => Nat.leb 1 n && Nat.leb n legs | None => true end in
  match about_ r, end_ r, given_ r with
  | Serial_, AtLeast_ _, None => is_leg
  | LegAngle_, AtMost_ _, None => is_leg && negb are_angles
  | Parallel_, AtLeast_ _, None => Nat.eqb legs (freedom k) && match k, leg_ r with Turns _, _ | _, Some _ => false | _, None => true end
  | JointRange, e, None => is_leg && Bool.eqb are_angles match e with Within_ _ _ => true | _ => false end
  | Load_, AtMost_ _, Some (Each_ force) => is_leg && Nat.eqb legs (freedom k) && Nat.eqb (length force) legs && match k with Turns _ => false | _ => true end
  | Acceleration_, AtMost_ _, Some (Motion_ _ _) => is_leg
  | Accuracy_, AtMost_ _, Some given => Nat.eqb legs (freedom k) && match k, leg_ r, given with Turns _, None, Near_ _ _ | (Translates | TranslatesInPlane), None, Given_ _ => true | _, _, _ => false end
  | _, _, _ => is_turning_demand (freedom k) legs r
  end.

Fixpoint written_of (x : term string) : written :=
  match x with
  | Literal w d => Constant (denoted (Literal w d))
  | Name n => Named n
  | Negative y => Opposite (written_of y)
  | Binary o y z =>
      match o with Addition => Sum | Subtraction => Difference | Multiplication => Product | Division => Quotient end (written_of y) (written_of z)
  | Power y n => Raised (written_of y) n
  | SquareRoot y => RootOf (written_of y)
  end.
Definition written_claim_of (xs : list string) (ps : list (string * quantity)) (ds : list (string * term string))
    (rows : list written_form) (a b : list expression) (rs : list written_requirement) : written_claim :=
  MakeWrittenClaim
    (Mechanism xs (map (fun p => (fst p, tolerance_of (snd p))) ps) (map (fun d => (fst d, written_of (snd d))) ds) (map (fun j => match j with Row_ r => ByRow (map written_of r) | Rho_ x => ByCoordinate (written_of x) end) rows))
    (map (fun p => Within (denoted (fst p)) (denoted (snd p))) (combine a b)) (demands false (length rows) [] rs) (existsb is_of_two_points rs).

(** A vector whose last components are 0 where they are not written. *)
Definition vector_of (l : list tolerance) : tolerances :=
  let at_ k := nth k l (exactly (0 // 1)) in Tolerances (at_ 0%nat) (at_ 1%nat) (at_ 2%nat).
Definition orientation_of (o : written_orientation) : orientations :=
  let range p := Within (denoted (fst p)) (denoted (snd p)) in
  match o with
  | Range_ a b => TurnedBy (range (a, b))
  | RollPitchYaw_ r p y => RollPitchYaw (range r) (range p) (range y)
  | Angle_ a => TurnedUpTo (denoted a)
  | Tilt_ a b => Tilted (denoted a) (denoted b)
  end.
Definition place_in (w : written_place) : region :=
  match w with
  | AnyBox_ a b => Box (vector_of (map (fun p => Within (denoted (fst p)) (denoted (snd p))) (combine a b)))
  | AnyCylinder_ x y r bottom top => region_of (Cylinder_ x y r bottom top)
  end.
Definition turning_claim_of (k : motion) (ls : list (list quantity * list quantity)) (ell : expression) (w : written_place)
    (o : written_orientation) (bs : list written_body) (rs : list written_requirement) : turning_claim :=
  let vector v := vector_of (map tolerance_of v) in
  MakeTurningClaim k (map (fun l => (vector (fst l), vector (snd l))) ls) (denoted ell) (place_in w) (orientation_of o) (demands false (length ls) bs rs) (existsb is_of_two_points rs).

(** In the plane arms turn about z. *)
Definition any_drive_of (k : mobility) (l : written_driven) : any_drive :=
  let vector v := vector_of (map tolerance_of v) in
  match l with
  | AnySlider_ d a p len m => LinearDrive (SliderLeg (Slider (vector d) (vector a) (vector p) (tolerance_of len) m))
  | AnyStrut_ a p k => LinearDrive (StrutLeg (vector a) (vector p) (option_map vector k))
  | AnyPlanar_ d => LinearDrive (PlanarLeg (vector d))
  | AnyArm_ axis x a p r len m =>
      let turns := match axis with [] => Tolerances (exactly (0 // 1)) (exactly (0 // 1)) (exactly (1 // 1)) | _ => vector axis end in
      RotaryDrive (ArmDrive turns (vector x) (vector a) (vector p) (tolerance_of r) (tolerance_of len) m)
  end.
Definition has_arms (ls : list written_driven) : bool := existsb (fun l => match l with AnyArm_ _ _ _ _ _ _ _ => true | _ => false end) ls.
Definition driven_claim_of (k : mobility) (ls : list written_driven) (ell : option expression) (w : written_place) (o : option written_orientation)
    (rs : list written_requirement) : driven_claim :=
  MakeDrivenClaim k (map (any_drive_of k) ls) (match ell with Some x => denoted x | None => 1 // 1 end) (place_in w) (option_map orientation_of o)
    (demands (has_arms ls) (length ls) [] rs) (existsb is_of_two_points rs).

(** Of legs that do not turn the platform: what is asked of them in the words of Legs.v alone, whatever else is. *)
Definition is_of_legs (r : written_requirement) : bool := match about_ r with Load_ | LegAngle_ => true | _ => false end.
Definition driven_leg (l : written_leg) : written_driven :=
  let three {A : Type} (t : triple A) := [first t; second t; third t] in
  match l with
  | Slider_ d a p len m => AnySlider_ (three d) (three a) (three p) len m
  | Strut_ a p k => AnyStrut_ (three a) (three p) (option_map three k)
  | Planar_ d => AnyPlanar_ (three d)
  end.
Definition any_place (w : written_region) : written_place :=
  match w with
  | Box_ a b => AnyBox_ [first a; second a; third a] [first b; second b; third b]
  | Cylinder_ x y r bottom top => AnyCylinder_ x y r bottom top
  end.
Definition claim_of_legs (ls : list written_leg) (w : written_region) (rs : list written_requirement) : driven_claim :=
  driven_claim_of Translates (map driven_leg ls) None (any_place w) None (filter is_of_legs rs).

(** *** The closed design *)

(** Its bounds on psi. *)
Definition is_of_psi (r : written_requirement) : bool := match about_ r with Transmission => true | _ => false end.
Definition closed_bounds (rs : list written_requirement) : option (expression * expression) :=
  match filter is_of_psi rs with
  | [Require_ _ None None (AtLeast_ a); Require_ _ None None (AtMost_ b)] | [Require_ _ None None (AtMost_ b); Require_ _ None None (AtLeast_ a)] => Some (a, b)
  | _ => None
  end.
(** What else is asked, but for joint coordinates from below. *)
Definition is_joint_min (r : written_requirement) : bool := match about_ r, end_ r with JointRange, AtLeast_ _ => true | _, _ => false end.
Definition is_by_theorem (r : written_requirement) : bool := is_of_psi r || is_joint_min r.
Definition closed_rest (rs : list written_requirement) : list written_requirement := filter (fun r => negb (is_by_theorem r)) rs.

(** Its machine and its cube, as section 8.5 writes them; [above]: psi_max is at least 2. *)
Section Steps1To3.
Variable above : bool.
Variables offset side psi : expression.
Let zero : expression := Literal (Decimal.D0 Decimal.Nil) Decimal.Nil.
Let one : expression := Literal (Decimal.D1 Decimal.Nil) Decimal.Nil.
Let two : expression := Literal (Decimal.D2 Decimal.Nil) Decimal.Nil.
Let less (x y : expression) := Binary Subtraction x y.
Let over_ (x y : expression) := Binary Division x y.
Let times_ (x y : expression) := Binary Multiplication x y.
Let plus_ (x y : expression) := Binary Addition x y.
Let rest := less one (over_ one psi).
Let entry_1 := over_ rest two.
Let entry_2 := if above then rest else over_ (less psi one) two.
Let sine (t : expression) := over_ t (SquareRoot (plus_ one (times_ two (times_ t t)))).
Definition closed_length : expression := over_ side (plus_ (sine entry_1) (sine entry_2)).
Definition closed_least : expression := Negative (times_ closed_length (sine entry_1)).
Definition closed_greatest : expression := times_ closed_length (sine entry_2).
Definition closed_base : expression := less (less closed_least offset) closed_length.
Definition closed_legs : list written_driven :=
  let along i x := map (fun k => One (if Nat.eqb i k then x else zero)) [0; 1; 2] in
  map (fun i => AnySlider_ (along i one) (along i closed_base) (along i (Negative offset)) (One closed_length) true) [0; 1; 2].
Definition closed_cube : written_place := AnyBox_ [closed_least; closed_least; closed_least] [closed_greatest; closed_greatest; closed_greatest].
Definition closed_claim : list written_requirement -> driven_claim := driven_claim_of Translates closed_legs None closed_cube None.

Local Open Scope R_scope.
(** These are the numbers of the paper. *)
Definition are_closed : Prop := exists L, is_closed (value (denoted side)) (value (denoted psi)) L /\ value (denoted closed_length) = L /\
  value (denoted closed_least) = q_1 L (value (denoted psi)) /\ value (denoted closed_greatest) = q_2 L (value (denoted psi)) /\
  value (denoted closed_base) = q_1 L (value (denoted psi)) - value (denoted offset) - L.

Lemma closed_numbers : 0 < value (denoted side) -> 1 < value (denoted psi) ->
  (if above then 2 <= value (denoted psi) else value (denoted psi) <= 2) -> are_closed.
Proof.
  intros h p1 hp. set (p := value (denoted psi)) in *.
  assert (E1 : value (denoted entry_1) = t_1 (1 / p)).
  { unfold entry_1, rest, less, over_, one, two, t_1. cbn. fold p. field. lra. }
  assert (E2 : value (denoted entry_2) = t_2 (1 / p)).
  { assert (hk : 1 / p * p = 1) by (field; lra). unfold entry_2, rest, less, over_, one, two, t_2.
    destruct above; cbn; fold p; destruct (Rle_dec (1 / p) (1 / 2)) as [g | g].
    - field. lra.
    - exfalso. apply g. apply Rmult_le_reg_r with p; [lra |]. rewrite hk. lra.
    - assert (p = 2); [| subst p; rewrite H; field].
      apply Rle_antisym; [exact hp |]. apply Rmult_le_compat_r with (r := p) in g; lra.
    - field. lra. }
  assert (S : forall t, value (denoted (sine t)) = position_of_entry (value (denoted t))).
  { intro t. unfold sine, over_, plus_, times_, one, two, position_of_entry. cbn [denoted value]. f_equal. f_equal. cbn. field. }
  pose proof (kappa_01 p p1) as k. destruct (t_facts _ k) as [T1 [T2 _]].
  assert (c1 : 0 < position_of_entry (t_1 (1 / p))) by (apply (position_on_diagonal (t_1 (1 / p))); lra).
  assert (c2 : 0 < position_of_entry (t_2 (1 / p))) by (apply (position_on_diagonal (t_2 (1 / p))); lra).
  assert (EL : value (denoted closed_length) = value (denoted side) / (position_of_entry (t_1 (1 / p)) + position_of_entry (t_2 (1 / p)))).
  { unfold closed_length, over_, plus_. cbn [denoted value]. rewrite !S, E1, E2. reflexivity. }
  assert (EQ : value (denoted closed_least) = - value (denoted closed_length) * position_of_entry (t_1 (1 / p))).
  { change (value (Minus (0 // 1) (Times (denoted closed_length) (denoted (sine entry_1)))) = - value (denoted closed_length) * position_of_entry (t_1 (1 / p))).
    cbn [value]. rewrite S, E1. field. }
  exists (value (denoted closed_length)). unfold is_closed, q_1, q_2. fold p.
  split; [rewrite EL; split; [apply Rdiv_lt_0_compat; lra | field; lra] |]. split; [reflexivity |]. split; [exact EQ |]. split.
  - unfold closed_greatest, times_. cbn [denoted value]. rewrite S, E2. reflexivity.
  - unfold closed_base, less. cbn [denoted value]. rewrite EQ. reflexivity.
Qed.
End Steps1To3.

(** *** Atlases *)

Definition parameters_ : Type := list (string * (expression * expression)).

(** Of each parameter, the part from n/2^level to (n + 1)/2^level of its range. *)
Definition part_ : Type := list (Z * nat).
Definition range_of (p : string * (expression * expression)) (part : Z * nat) : Q * Q :=
  match rational (denoted (fst (snd p))), rational (denoted (snd (snd p))) with
  | Some a, Some b => let at_ n := (a + (b - a) * (n # Nat.iter (snd part) xO xH))%Q in (at_ (fst part), at_ (fst part + 1)%Z)
  | _, _ => (0%Q, 0%Q)
  end.
Fixpoint references (k : nat) (ps : parameters_) (part : part_) : list (string * reference) :=
  match ps, part with
  | p :: ps', r :: part' => let (a, b) := range_of p r in (fst p, InCell k a b) :: references (S k) ps' part'
  | _, _ => []
  end.

(** Names replaced by what they are in a cell. *)
Section Over.
Variable rs : list (string * reference).
Fixpoint over (x : expression) : expression :=
  match x with
  | Literal w d => Literal w d
  | Name (Called n) => match find (fun r => n =? fst r) rs with Some r => Name (snd r) | None => x end
  | Name (InCell _ _ _) => x
  | Negative y => Negative (over y)
  | Binary o y z => Binary o (over y) (over z)
  | Power y n => Power (over y) n
  | SquareRoot y => SquareRoot (over y)
  end.
Definition quantity_over (q : quantity) : quantity := match q with One x => One (over x) | Between a b => Between (over a) (over b) end.
Definition triple_over {A : Type} (f : A -> A) (t : triple A) : triple A := Triple (f (first t)) (f (second t)) (f (third t)).
Definition leg_over (l : written_leg) : written_leg :=
  let vector := triple_over quantity_over in
  match l with
  | Slider_ d a p len m => Slider_ (vector d) (vector a) (vector p) (quantity_over len) m
  | Strut_ a p k => Strut_ (vector a) (vector p) (option_map vector k)
  | Planar_ d => Planar_ (vector d)
  end.
Definition region_over (w : written_region) : written_region :=
  match w with
  | Box_ a b => Box_ (triple_over over a) (triple_over over b)
  | Cylinder_ x y r bottom top => Cylinder_ (over x) (over y) (over r) (over bottom) (over top)
  end.
Definition requirement_over (r : written_requirement) : written_requirement :=
  Require_ (about_ r) (leg_ r)
    (match given_ r with Some (Given_ x) => Some (Given_ (over x)) | Some (Each_ xs) => Some (Each_ (map over xs)) | Some (Motion_ a v) => Some (Motion_ (over a) (over v)) | Some (Near_ e a) => Some (Near_ (over e) (over a)) | None => None end)
    match end_ r with AtLeast_ b => AtLeast_ (over b) | AtMost_ b => AtMost_ (over b) | Within_ a b => Within_ (over a) (over b) | Holds_ => Holds_ end.
End Over.

(** The tree that cells are in preorder; [depth] is that of the list. *)
Inductive atlas_tree := Halves (k : nat) (lower upper : atlas_tree) | Whole (c : cell).
Fixpoint atlas_of (depth : nat) (l : list cell) : option (atlas_tree * list cell) :=
  match depth, l with
  | S d, Cut k :: rest =>
      match atlas_of d rest with
      | Some (a, rest) => match atlas_of d rest with Some (b, rest) => Some (Halves k a b, rest) | None => None end
      | None => None
      end
  | S _, c :: rest => Some (Whole c, rest)
  | _, _ => None
  end.
Fixpoint halved (upper : bool) (k : nat) (part : part_) : part_ :=
  match part, k with
  | (n, level) :: rest, O => ((2 * n + if upper then 1 else 0)%Z, S level) :: rest
  | r :: rest, S j => r :: halved upper j rest
  | [], _ => []
  end.
Definition is_proved (c : cell) : bool := match c with Proved _ _ _ => true | _ => false end.
Definition is_disproved (c : cell) : bool := match c with Disproved _ _ _ _ => true | _ => false end.
(** The share of the box that these cells have: half of what they have of each half. *)
Fixpoint share (is : cell -> bool) (t : atlas_tree) : Q :=
  match t with Halves _ a b => ((share is a + share is b) * (1 # 2))%Q | Whole c => if is c then 1%Q else 0%Q end.
Definition whole_box (ps : parameters_) : part_ := map (fun _ => (0%Z, O)) ps.

(** The claim in a cell: in it parameters vary ([Claim.every_value]). *)
Definition claim_in (ps : parameters_) (part : part_) (ls : list written_leg) (w : written_region) (rs : list written_requirement) : claim :=
  let by_name := references 0 ps part in
  claim_of (map (leg_over by_name) ls) (region_over by_name w) [] (map (requirement_over by_name) rs).

Local Open Scope R_scope.

(** What is said of all cells. *)
Fixpoint is_atlas (ps : parameters_) (ls : list written_leg) (w : written_region) (rs : list written_requirement) (part : part_) (t : atlas_tree) : Prop :=
  match t with
  | Halves k a b => is_atlas ps ls w rs (halved false k part) a /\ is_atlas ps ls w rs (halved true k part) b
  | Whole (Proved _ _ _) => forall names : naming, let c := claim_in ps part ls w rs in
      @Statement.holds names c /\ exists m P, @is_about names c m P
  | Whole (Disproved _ _ _ _) => forall names : naming, let c := claim_in ps part ls w rs in
      exists m P, @is_about names c m P /\ ~ @meets names c m P
  | Whole (Cut _ | Undecided) => True
  end.

Definition postulate_for (psi : R) : Prop := forall L a e, 0 < L -> let m := orthoglide L a e in forall P, in_cube L psi P ->
  transmission_within psi m P /\ forall Q, in_cube L psi Q -> Paper.joints m Q = Paper.joints m P -> Q = P.

Definition means (c : certificate) : Prop :=
  match subject_ c, proof_ c with
  | Machine_ ls w bs rs, Nodes _ _ _ =>
      let whole := Statement.holds (claim_of ls w bs rs) /\ exists m P, is_about (claim_of ls w bs rs) m P in
      if existsb is_of_legs rs then whole /\ driven_holds (claim_of_legs ls w rs) else whole
  | Machine_ ls w bs rs, ByWitness _ _ _ _ =>
      let whole := exists m P, is_about (claim_of ls w bs rs) m P /\ ~ meets (claim_of ls w bs rs) m P in let c := claim_of_legs ls w rs in
      if existsb is_of_legs rs then whole \/ (exists m P Q, Forall well_formed_driven m /\ is_about_driven c m P Q /\ ~ meets_driven c m P Q) else whole
  | Legs_ k ls ell w o rs, Nodes _ _ _ => let c := driven_claim_of k ls ell w o rs in
      driven_holds c /\ exists m P Q, is_about_driven c m P Q
  | Legs_ k ls ell w o rs, ByWitness _ _ _ (Same_ _ _ _ _ _) => has_two_poses (driven_claim_of k ls ell w o rs)
  | Legs_ k ls ell w o rs, ByWitness _ _ _ _ => let c := driven_claim_of k ls ell w o rs in
      exists m P Q, Forall well_formed_driven m /\ is_about_driven c m P Q /\ ~ meets_driven c m P Q
  | Turning_ k ls ell w o bs rs, ByWitness _ _ _ (Same_ _ _ _ _ _) => let c := turning_claim_of k ls ell w o bs rs in
      one_pose c = true /\ exists m P Q P' Q', is_about_struts c m P Q /\ Statement.in_region (positions c) P' /\ in_orientations (turned c) Q' /\
        Forall (fun l => strut_length l P' Q' = strut_length l P Q) m /\ ~ (P' = P /\ Q' = Q)
  | Turning_ k ls ell w o bs rs, ByWitness _ _ _ _ => let c := turning_claim_of k ls ell w o bs rs in
      exists m P Q, is_about_struts c m P Q /\ ~ meets_turning c m P Q
  | Turning_ k ls ell w o bs rs, Nodes _ _ _ => let c := turning_claim_of k ls ell w o bs rs in
      turning_holds c /\ exists m P Q, is_about_struts c m P Q
  | Formulas_ xs ps ds rows a b rs, Nodes _ _ _ => let c := written_claim_of xs ps ds rows a b rs in
      written_holds c /\ exists theta x, is_about_written c theta x
  | Formulas_ xs ps ds rows a b rs, ByWitness _ _ _ (Same_ _ _ _ _ _) => has_two_points (written_claim_of xs ps ds rows a b rs)
  | Formulas_ xs ps ds rows a b rs, ByWitness _ _ _ _ => let c := written_claim_of xs ps ds rows a b rs in let m := by_formulas c in
      exists theta x, is_about_written c theta x /\ ~ exists M, Forall2 (is_row m theta x) (joint_forms m) M /\
        Configuration.meets (length (coordinate_names m)) (machine_at m theta x M) (written_demands c)
  | Closed_ offset side rs, Nodes _ _ _ =>
      match closed_bounds rs with
      | Some (least, greatest) => closed_design_holds (denoted side) (denoted least) (denoted greatest) (value (denoted offset)) /\
          Forall (fun r => match about_ r, end_ r with JointRange, AtLeast_ b => value (denoted b) <= 0 | _, _ => True end) rs /\
          (closed_rest rs = [] \/ exists above, are_closed above offset side greatest /\
            let c := closed_claim above offset side greatest (closed_rest rs) in driven_holds c /\ exists m P Q, is_about_driven c m P Q)
      | None => False
      end
  | Closed_ offset side rs, ByWitness _ _ _ _ =>
      match closed_bounds rs with
      | Some (_, greatest) => exists above, are_closed above offset side greatest /\
          let c := closed_claim above offset side greatest rs in exists m P Q, Forall well_formed_driven m /\ is_about_driven c m P Q /\ ~ meets_driven c m P Q
      | None => False
      end
  | NoCube_ ls a b rs side, Nodes _ _ _ => let c := claim_of ls (Box_ a b) [] rs in
      has_no_cube c (denoted side) /\ exists m C, is_about c m C
  | Postulate_ None, Nodes _ _ _ => forall psi, 1 < psi -> postulate_for psi
  | Postulate_ (Some q), Nodes _ _ _ => 1 < value (greatest (tolerance_of q)) /\
      forall psi, 1 < psi -> within (tolerance_of q) psi -> postulate_for psi
  | Atlas_ ps ls w rs certified refuted, Cells cells =>
      match atlas_of (length cells) cells with
      | Some (t, []) => is_atlas ps ls w rs (whole_box ps) t /\
          value (denoted certified) <= Q2R (share is_proved t) /\ value (denoted refuted) <= Q2R (share is_disproved t)
      | _ => False
      end
  | _, _ => False
  end.

(** ** What is accepted: [verify_sound] holds of it.

    [means] takes a claim's shape for granted: requirements of the form of their quantity, legs counted from one, as many
    numbers as there are coordinates, names given once. What [accept] demands of shapes, the functions [is_well_formed],
    [are_well_formed_legs], [is_turning] and [are_well_formed_formulas], has to be read for that, and nothing else below. *)

Local Close Scope R_scope.

(** Units of lengths and directions: section 7.3. *)
Definition lengths_of (d : drive) : list Claim.number := match d with SliderLeg c => ends (Claim.length c) | _ => [] end.
Definition places_of (d : drive) : list Claim.number :=
  match d with SliderLeg c => (ends3 (anchor c) ++ ends3 (platform c))%list | StrutLeg a p _ => (ends3 a ++ ends3 p)%list | PlanarLeg _ => [] end.
Definition direction_order (d : drive) : Z :=
  match d with SliderLeg c => order_of (ends3 (direction c)) | PlanarLeg n => order_of (ends3 n) | StrutLeg _ _ (Some k) => order_of (ends3 k)
  | StrutLeg _ _ None => 0%Z end.
Definition length_order (ds : list drive) : Z :=
  let some := match flat_map lengths_of ds with [] => flat_map places_of ds | l => l end in
  (1 + order_of some)%Z.

(** Where the one machine is, and whether the parameter is of second order. *)
Definition choice_of (c : ascii) : option (Tolerances.choice * bool) :=
  if (c =? "-")%char then Some (Tolerances.FromLeast, false) else if (c =? "+")%char then Some (Tolerances.FromGreatest, false)
  else if (c =? "0")%char then Some (Tolerances.FromMiddle, false)
  else if (c =? "<")%char then Some (Tolerances.FromLeast, true) else if (c =? ">")%char then Some (Tolerances.FromGreatest, true)
  else if (c =? "=")%char then Some (Tolerances.FromMiddle, true) else None.
(** For each of these parameters a character; those of second order, and those that directions of one scale leave no range. *)
Fixpoint ends_of (free : list nat) (l : list ascii) : option (list (nat * Tolerances.choice) * list nat * list nat) :=
  match free, l with
  | [], [] => Some ([], [], [])
  | j :: free', c :: l' => match ends_of free' l', choice_of c with
      | Some (r, curved, ones), Some (c, second) => Some ((j, c) :: r, if second then j :: curved else curved, ones)
      | Some (r, curved, ones), None => if (c =? "1")%char then Some (r, curved, j :: ones) else None
      | None, _ => None
      end
  | _, _ => None
  end.

(** Of each row a number for each of these parameters. *)
Definition weights_of (free : list nat) (rows : list (list Z)) : option (list (list (nat * Z))) :=
  if forallb (fun row => Nat.eqb (length row) (length free)) rows then Some (map (fun row => filter (fun p => negb (snd p =? 0)%Z) (combine free row)) rows) else None.

Section Steps.
(** Of how many coordinates, the parameters with two ends, and those that may be apart. *)
Variables (m : nat) (free apart : list nat).
(** The parameters of each direction. *)
Variable groups : list (list nat).

Fixpoint evidence_of (s : step) : option evidence :=
  match s with
  | Plain name =>
      if name =? "test" then Some ByTest else if name =? "divided" then Some ByDivided else if name =? "mirror" then Some ByMirror else
      if name =? "negative" then Some ByNegative else if name =? "chords" then Some ByChords else if name =? "outside" then Some Outside else None
  | Multiplied name y places =>
      if name =? "lower" then Some (ByLower places y) else if name =? "lower_divided" then Some (ByLowerDivided places y) else
      if name =? "rank" then Some (ByRank places y) else if name =? "direction" then Some (ByDirection places y) else None
  | AtCorner f => Some (ByCorner f)
  | Conditioned_ y places mu => Some (ByConditioning places y mu)
  | Accurate_ y places kappa q => Some (ByAccuracy places y kappa q)
  | Inside_ s n places => match evidence_of s with Some e => Some (Inside e n places) | None => None end
  | Turned_ s n places => match evidence_of s with Some e => Some (Turned e n places) | None => None end
  | AtControls_ s => option_map AtControls (evidence_of s)
  | Apart_ s ends vs =>
      match apart, evidence_of s, ends_of apart (list_ascii_of_string ends) with
      | _ :: _, Some e, Some (ends, curved, []) => Some (ByTolerances e ends curved vs)
      | _ :: _, Some e, Some (ends, curved, ones) => Some (OfOneScale groups ones (ByTolerances e ends curved vs))
      | _, _, _ => None
      end
  | Fan_ cs => option_map ByFan ((fix all ps := match ps with
      | [] => Some []
      | (c, n, places, s) :: ps' => match evidence_of s, all ps' with Some e, Some r => Some ((c, n, places, e) :: r) | _, _ => None end
      end) cs)
  | Between_ mu places weights lower upper => match weights_of apart weights, evidence_of lower, evidence_of upper with
      | Some weights, Some e, Some f => Some (ByBetween places mu weights e f)
      | _, _, _ => None
      end
  | Together_ s rows places => option_map (fun e => ByTogether e places rows) (evidence_of s)
  end.
Fixpoint steps_of (l : list (nat * step)) : option (list (nat * evidence)) :=
  match l with
  | [] => Some []
  | (i, s) :: l' => match evidence_of s, steps_of l' with Some e, Some k => Some ((i, e) :: k) | _, _ => None end
  end.

(** Counted from zero, coordinates are halved, and then parameters with two ends. *)
Definition halved_at (s : list (nat * evidence)) (k : nat) (a b : tree) : option tree :=
  if Nat.ltb k m then Some (Split s k a b) else option_map (fun j => Parts s j a b) (nth_error free (k - m)).
(** The tree that the first nodes are, and those that are left; [depth] is that of the nodes' list. *)
Fixpoint tree_of (depth : nat) (l : list node) : option (tree * list node) :=
  match depth, l with
  | S d, Node by_ split None [] :: rest =>
      match steps_of by_, split with
      | Some s, None => Some (Leaf s, rest)
      | Some s, Some k =>
          match tree_of d rest with
          | Some (a, rest) => match tree_of d rest with Some (b, rest) => option_map (fun t => (t, rest)) (halved_at s k a b) | None => None end
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

End Steps.

(** At one point. *)
Definition nfailure_of (f : violation) : option nfailure :=
  match f with
  | Reach => Some NOutOfReach | Obligation i vs => Some (NFails i vs) | Row i leg => Some (NFailsAlong i leg) | Dependent_ => Some NDependent
  | Singular_ _ | Same_ _ _ _ _ _ => None
  end.

(** The same of a tree whose leaves fail, and that has no steps. *)
Fixpoint failing_tree_of (free : list nat) (depth : nat) (l : list node) : option (failing_tree * list node) :=
  match depth, l with
  | S d, Node [] None (Some f) at_ :: rest => option_map (fun f => (Fails_ at_ f, rest)) (nfailure_of f)
  | S d, Node [] (Some k) None [] :: rest =>
      match failing_tree_of free d rest with
      | Some (a, rest) => match failing_tree_of free d rest with
          | Some (b, rest) => if Nat.ltb k 3 then Some (Halved k a b, rest) else option_map (fun j => (Parted j a b, rest)) (nth_error free (k - 3))
          | None => None
          end
      | None => None
      end
  | _, _ => None
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

(** How many directions a requirement fails in. *)
Definition directions_of (ds : list drive) (r : requirement) : nat :=
  match r with
  | JointAcceleration i _ _ _ => match nth_error ds i with Some (PlanarLeg _) => 1 | _ => 0 end
  | JointMin _ _ | JointMax _ _ | JointSpeed _ _ _ | SerialMargin _ _ | ParallelMargin _ | Beside _ _ _ _ => 0
  | ConditionMax _ => 2
  | _ => 1
  end.
(** Of forces, in the unit of lengths that formulas have: a plane's normal has none. *)
Definition in_unit (ds : list drive) (vs : list (list Z)) : list (list Z) :=
  let s := length_order ds in
  let scale d x := if Bool.eqb match d with PlanarLeg _ => true | _ => false end (0 <=? s)%Z then (x * 2 ^ Z.abs s)%Z else x in
  map (fun v => if Nat.eqb (length v) (length ds) then map (fun p => scale (fst p) (snd p)) (combine ds v) else v) vs.
Definition failure_of (k : claim) (f : violation) : option failure :=
  let rs := require k in
  match f with
  | Reach => Some OutOfReach
  | Obligation i vs =>
      let vs := match nth_error rs i with Some (JointForce _ _ _) => in_unit (legs k) vs | _ => vs end in
      match option_map (directions_of (legs k)) (nth_error rs i), vs with
      | Some 0%nat, [] => let none := (0, 0, 0)%Z in Some (Fails i none none)
      | Some 1%nat, [[a; b; c]] => Some (Fails i (a, b, c) (a, b, c))
      | Some 2%nat, [[a; b; c]; [d; e; f]] => Some (Fails i (a, b, c) (d, e, f))
      | _, _ => None
      end
  | Row i leg => match nth_error rs i with Some (PsiMin _) => Some (FailsAlong i leg) | _ => None end
  | Dependent_ => Some AreDependent
  | Singular_ _ | Same_ _ _ _ _ _ => None
  end.

Fixpoint take_list (v : list quantity) (l : list Claim.number) : list Claim.number * list Claim.number :=
  match v with
  | [] => ([], l)
  | q :: v' => let (x, l) := take q l in let (xs, l) := take_list v' l in (x :: xs, l)
  end.
Definition numbers_of (l : list Claim.number) : numbers :=
  let at_ k := nth k l (0 // 1) in Numbers (at_ 0%nat) (at_ 1%nat) (at_ 2%nat).
Fixpoint take_struts (ws : list (list quantity * list quantity)) (l : list Claim.number) : list exact_strut * list Claim.number :=
  match ws with
  | [] => ([], l)
  | (a, p) :: ws' => let (a, l) := take_list a l in let (p, l) := take_list p l in let (es, l) := take_struts ws' l in
      (StrutNumbers (numbers_of a) (numbers_of p) :: es, l)
  end.

Definition take_driven (w : written_driven) (l : list Claim.number) : exact_driven * list Claim.number :=
  match w with
  | AnySlider_ d a p len m =>
      let (d, l) := take_list d l in let (a, l) := take_list a l in let (p, l) := take_list p l in let (len, l) := take len l in
      (XLinear (ExactSlider (numbers_of d) (numbers_of a) (numbers_of p) len m), l)
  | AnyStrut_ a p k => let (a, l) := take_list a l in let (p, l) := take_list p l in
      match k with
      | Some k => let (k, l) := take_list k l in (XLinear (ExactStrut (numbers_of a) (numbers_of p) (Some (numbers_of k))), l)
      | None => (XLinear (ExactStrut (numbers_of a) (numbers_of p) None), l)
      end
  | AnyPlanar_ d => let (d, l) := take_list d l in (XLinear (ExactPlanar (numbers_of d)), l)
  | AnyArm_ k x a p r len m =>
      let (k', l) := take_list k l in let (x, l) := take_list x l in let (a, l) := take_list a l in let (p, l) := take_list p l in
      let (r, l) := take r l in let (len, l) := take len l in
      let axis := match k with [] => Numbers (0 // 1) (0 // 1) (1 // 1) | _ => numbers_of k' end in
      (XRotary (ExactArm axis (numbers_of x) (numbers_of a) (numbers_of p) r len m), l)
  end.
Fixpoint take_all_driven (ws : list written_driven) (l : list Claim.number) : list exact_driven * list Claim.number :=
  match ws with
  | [] => ([], l)
  | w :: ws' => let (e, l) := take_driven w l in let (es, l) := take_all_driven ws' l in (e :: es, l)
  end.

(** What the format asks of bounds. *)
Definition is_number : Claim.number -> bool := Compare.is_number exact_bits.
Definition is_bound (r : requirement) : bool :=
  match r with
  | PsiMax b | PsiMin b | SerialMargin _ b | ParallelMargin b | ConstraintMargin b => certainly exact_bits true b
  | Stiffness joint b => certainly exact_bits true joint && certainly exact_bits true b
  | Stiffnesses ks b => forallb (certainly exact_bits true) (b :: ks)
  | JointSpeed _ tool b => certainly exact_bits true tool && certainly exact_bits true b
  | ConditionMax b => certainly exact_bits true (Minus b (1 // 1))
  | Clearance _ _ b => certainly exact_bits false b
  | Beside _ _ _ (Plus _ b) => certainly exact_bits false b
  | Beside _ _ _ _ => false
  | JointForce _ tool b => certainly exact_bits true tool && certainly exact_bits true b
  | JointAcceleration _ a v b => certainly exact_bits false a && certainly exact_bits false v && certainly exact_bits true b
  | Accuracy error b => certainly exact_bits false error && certainly exact_bits true b
  | JointMin _ b | JointMax _ b => is_number b
  | NotSingular | OneToOne => true
  end.
Definition is_demand_bound (d : demand) : bool :=
  match d with
  | FactorMax b | FactorMin b => certainly exact_bits true b
  | Conditioned b => certainly exact_bits true (Minus b (1 // 1))
  | AngleWithin _ a b => certainly exact_bits true (Minus b a) && certainly exact_bits true (Minus (Plus a (180 // 1)) b)
      && certainly exact_bits false (Plus a (360 // 1)) && certainly exact_bits false (Minus (360 // 1) b)
  | LengthMin _ b | LengthMax _ b => is_number b
  | SerialMin _ b | ParallelMin b => certainly exact_bits true b
  | LegAngleMax _ b => certainly exact_bits true b && certainly exact_bits false (Minus (90 // 1) b)
  | SpeedMax _ a b | TurnMax _ a b | ForceMax _ a b => certainly exact_bits true a && certainly exact_bits true b
  | StiffnessMin ks b => forallb (certainly exact_bits true) (b :: ks)
  | JointAngleMax _ _ j b => is_axis j && certainly exact_bits true b && certainly exact_bits false (Minus (180 // 1) b)
  | Clear _ _ b => certainly exact_bits false b
  | AccelerationMax _ a v b => certainly exact_bits false a && certainly exact_bits false v && certainly exact_bits true b
  | LoadMax _ force b => forallb is_number force && existsb (fun x => certainly exact_bits true (Times x x)) force && certainly exact_bits true b
  | OnePose e b a => certainly exact_bits false e && certainly exact_bits true b && certainly exact_bits false a && certainly exact_bits true (Minus (180 // 1) a)
  | Nonsingular => true
  end.
(** A quantity, leg and end stand once. *)
Definition is_same (r q : written_requirement) : bool :=
  (about_text (about_ r) =? about_text (about_ q)) && (end_text (end_ r) =? end_text (end_ q)) &&
  match leg_ r, leg_ q with Some n, Some m => Nat.eqb n m | None, None => true | _, _ => false end.
Fixpoint is_each_once (rs : list written_requirement) : bool :=
  match rs with [] => true | r :: rs' => negb (existsb (is_same r) rs') && is_each_once rs' end.

(** It has a value, and the ends of a tolerance differ, but where they vary. *)
Definition is_range (q : quantity) : bool :=
  match q with
  | One x => is_number (denoted x)
  | Between a b => if varies (denoted a) || varies (denoted b) then below exact_bits (denoted a) (denoted b)
      else certainly exact_bits true (Minus (denoted b) (denoted a))
  end.
Definition three_of (t : triple quantity) : list quantity := [first t; second t; third t].
Definition quantities_of (l : written_leg) : list quantity :=
  match l with
  | Slider_ d a p len _ => three_of d ++ three_of a ++ three_of p ++ [len]
  | Strut_ a p k => three_of a ++ three_of p ++ match k with Some k => three_of k | None => [] end
  | Planar_ d => three_of d
  end%list.

(** Bodies that there are, if and only if their clearance is asked for. *)
Definition is_sized (b : written_body) : bool :=
  match b with
  | AlongLeg_ _ r t u o => certainly exact_bits true (denoted r) && certainly exact_bits false (denoted t) && certainly exact_bits false (denoted u) &&
      match o with Some o => forallb (fun x => is_number (denoted x)) (in_triple o) | None => true end
  | Fixed_ _ p q r => certainly exact_bits true (denoted r) && forallb (fun x => is_number (denoted x)) (in_triple p ++ in_triple q)%list
  end.
Definition is_on (ls : list written_leg) (b : written_body) : bool :=
  match b with
  | AlongLeg_ i _ _ _ _ => Nat.leb 1 i && match nth_error ls (pred i) with Some (Slider_ _ _ _ _ _ | Strut_ _ _ _) => true | _ => false end
  | Fixed_ _ _ _ _ => true
  end.
(** Of platforms that turn none is beside a leg. *)
Definition is_on_strut (struts : nat) (b : written_body) : bool :=
  match b with AlongLeg_ i _ _ _ o => Nat.leb 1 i && Nat.leb i struts && match o with Some _ => false | None => true end | Fixed_ _ _ _ _ => true end.
Definition are_bodies (is_on : written_body -> bool) (bs : list written_body) (rs : list written_requirement) : bool :=
  if existsb (fun r => match about_ r with Clearance_ => true | _ => false end) rs
  then Nat.leb (length bs) 24 && forallb (fun b => is_sized b && is_on b) bs && match pairs_of [] bs with [] => false | _ => true end
  else match bs with [] => true | _ => false end.

(** Numbers of a vector of the legs, and of the platform's point. *)
Definition places_in (k : motion) : nat := match k with InPlane => 2 | _ => 3 end.
Definition places_of_point (k : motion) : nat := match k with InPlane => 2 | InSpace => 3 | AboutPoint => 0 end.
Definition is_angle_range (t : tolerance) : bool :=
  certainly exact_bits true (Plus (180 // 1) (least t)) && below exact_bits (least t) (greatest t) && certainly exact_bits true (Minus (180 // 1) (greatest t)).
Definition is_less_than_half_turn (a : Claim.number) : bool := below exact_bits (0 // 1) a && certainly exact_bits true (Minus (180 // 1) a).
(** A box of [n] coordinates, or a cylinder, if [round]. *)
Definition is_place (n : nat) (round : bool) (w : written_place) : bool :=
  match w with
  | AnyBox_ a b => Nat.eqb (length a) n && Nat.eqb (length b) n && forallb (fun p => below exact_bits (denoted (fst p)) (denoted (snd p))) (combine a b)
  | AnyCylinder_ _ _ r bottom top => round && certainly exact_bits true (denoted r) && below exact_bits (denoted bottom) (denoted top)
  end.
Definition is_turning (k : motion) (ls : list (list quantity * list quantity)) (ell : expression) (w : written_place)
    (o : written_orientation) (bs : list written_body) (rs : list written_requirement) : bool :=
  let is_vector v := Nat.eqb (length v) (places_in k) && forallb is_range v in
  forallb (fun l => is_vector (fst l) && is_vector (snd l)) ls && Nat.leb (dimension k) (length ls) && Nat.leb (length ls) 12 &&
  certainly exact_bits true (denoted ell) && is_place (places_of_point k) match k with InSpace => true | _ => false end w &&
  match k, orientation_of o with
  | InPlane, TurnedBy t => is_angle_range t
  | (InSpace | AboutPoint), RollPitchYaw x y z => is_angle_range x && is_angle_range y && is_angle_range z
  | (InSpace | AboutPoint), TurnedUpTo a => is_less_than_half_turn a
  | (InSpace | AboutPoint), Tilted a b => is_less_than_half_turn a && is_less_than_half_turn b
  | _, _ => false
  end && are_bodies (is_on_strut (length ls)) bs rs && forallb (is_asked_of_struts (places_in k) (dimension k) (length ls)) rs && is_each_once rs &&
  forallb is_demand_bound (demands false (length ls) bs rs).

Definition quantities_of_driven (l : written_driven) : list quantity :=
  match l with AnySlider_ d a p len _ => d ++ a ++ p ++ [len] | AnyStrut_ a p k => a ++ p ++ match k with Some k => k | None => [] end | AnyPlanar_ d => d | AnyArm_ k x a p r len _ => k ++ x ++ a ++ p ++ [r; len] end%list.
Definition are_well_formed_legs (k : mobility) (ls : list written_driven) (ell : option expression) (w : written_place) (o : option written_orientation)
    (rs : list written_requirement) : bool :=
  let flat := match k with TranslatesInPlane | Turns InPlane => true | _ => false end in
  let is_vector (v : list quantity) := Nat.eqb (length v) (if flat then 2 else 3) in
  let arms := has_arms ls in
  forallb (fun l => match l with
    | AnySlider_ d a p _ _ => negb arms && is_vector d && is_vector a && is_vector p
    | AnyStrut_ a p axis => negb arms && is_vector a && is_vector p &&
        match k, axis with Turns _, _ => false | Translates, Some axis => is_vector axis | _, Some _ => false | _, None => true end
    | AnyPlanar_ d => negb arms && is_vector d && match k with Translates => true | _ => false end
    | AnyArm_ axis x a p _ _ _ => (if flat then match axis with [] => true | _ => false end else is_vector axis) && is_vector x && is_vector a && is_vector p
    end) ls &&
  Nat.leb (freedom k) (length ls) && Nat.leb (length ls) 12 && forallb is_range (flat_map quantities_of_driven ls) &&
  is_place (if flat then 2 else 3) match k with Translates => true | _ => false end w &&
  match k, ell, option_map orientation_of o with
  | (Translates | TranslatesInPlane), None, None => true
  | Turns InPlane, Some x, Some (TurnedBy t) => certainly exact_bits true (denoted x) && is_angle_range t
  | Turns InSpace, Some x, Some (RollPitchYaw a b c) => certainly exact_bits true (denoted x) && is_angle_range a && is_angle_range b && is_angle_range c
  | Turns InSpace, Some x, Some (TurnedUpTo a) => certainly exact_bits true (denoted x) && is_less_than_half_turn a
  | Turns InSpace, Some x, Some (Tilted a b) => certainly exact_bits true (denoted x) && is_less_than_half_turn a && is_less_than_half_turn b
  | _, _, _ => false
  end &&
  forallb (fun r => is_driven_demand arms k (length ls) r || is_of_two_points r && is_asked 0 0 r) rs &&
  forallb (fun r => match about_ r with
    | Serial_ | LegAngle_ => forallb (fun l => match l with AnySlider_ _ _ _ _ _ | AnyArm_ _ _ _ _ _ _ _ => true | _ => false end)
        match leg_ r with Some n => match nth_error ls (pred n) with Some l => [l] | None => [] end | None => ls end
    | _ => true
    end) rs && is_each_once rs && forallb is_demand_bound (demands arms (length ls) [] rs).

(** No machine within the tolerances has a direction that is zero. *)
Definition has_direction (d : drive) : bool :=
  match d with SliderLeg c => is_never_zero (direction c) | PlanarLeg n => is_never_zero n | StrutLeg _ _ (Some k) => is_never_zero k
  | StrutLeg _ _ None => true end.
Definition is_well_formed (ls : list written_leg) (bs : list written_body) (rs : list written_requirement) (c : claim) : bool :=
  are_bodies (is_on ls) bs rs && forallb has_direction (legs c) && Nat.leb 3 (length ls) && forallb (is_shaped (length ls)) rs && is_each_once rs && forallb is_range (flat_map quantities_of ls) && forallb is_bound (require c).

Definition are_well_formed_formulas (xs : list string) (ps : list (string * quantity)) (rows : list written_form) (a b : list expression) (rs : list written_requirement) : bool :=
  let n := length (xs) in
  let has_coordinate r := match about_ r with
    | JointRange => forallb (fun j => match nth_error rows j with Some (Rho_ _) => true | _ => false end)
        match leg_ r with Some k => [pred k] | None => seq 0 (length rows) end
    | OneToOne_ | Accuracy_ => forallb (fun j => match j with Rho_ _ => true | _ => false end) rows
    | _ => true
    end in
  let is_asked_here r := match about_ r, end_ r, leg_ r, given_ r with Accuracy_, AtMost_ _, None, Some (Given_ _) => Nat.eqb n (length rows) | _, _, _, _ => is_asked n (length rows) r end in
  Nat.eqb (length a) (length b) && forallb (fun r => is_asked_here r && has_coordinate r) rs && is_each_once rs &&
  forallb (fun p => is_range (snd p)) ps && forallb is_demand_bound (demands false (length rows) [] rs).

(** How many tests are before that of two points. *)
Fixpoint before_two_points (rs : list written_requirement) : list written_requirement :=
  match rs with r :: rs' => if is_of_two_points r then [] else r :: before_two_points rs' | [] => [] end.
Definition place_of_two_points (are_angles : bool) (parts legs : nat) (bs : list written_body) (rs : list written_requirement) : nat :=
  (length (match flat_map factor_max_of rs with [] => [Nonsingular] | l => l end) +
    list_sum (map (Configuration.tests_of exact_bits parts) (flat_map (demand_of are_angles legs bs) (before_two_points rs))))%nat.
(** Poses near another one have a test of each part. *)
Definition parts_of (k : motion) : nat := match k with AboutPoint => 1 | _ => 2 end.
(** What fails at one point, where tests of one point are counted alone. *)
Definition failure_at (are_angles : bool) (parts legs : nat) (bs : list written_body) (rs : list written_requirement) (how : violation) : option nfailure :=
  let place := place_of_two_points are_angles parts legs bs rs in
  let moved (f : nat -> nfailure) i :=
    if negb (existsb is_of_two_points rs) || Nat.ltb i place then Some (f i) else if Nat.eqb i place then None else Some (f (pred i)) in
  match nfailure_of how with
  | Some (NFails i vs) => moved (fun i => NFails i vs) i
  | Some (NFailsAlong i row) => moved (fun i => NFailsAlong i row) i
  | f => f
  end.

(** A witness has a number for each tolerance. *)
Definition is_one_each (qs : list quantity) (machine : list expression) : bool :=
  Nat.eqb (length machine) (length (filter (fun q => match q with Between _ _ => true | One _ => false end) qs)).

(** What is within tolerances, counted as formulas count it. *)
Definition with_two_ends (ps : list parameter) : list nat := map fst (filter (fun p => has_two_ends (snd p)) (combine (seq 0 (length ps)) ps)).
Definition parameters_of_claim (k : claim) : list parameter := layouts (length_order (legs k)) (map direction_order (legs k)) (legs k).
Definition free_parameters (k : claim) : list nat := with_two_ends (parameters_of_claim k).
(** Directions, of which no component is an integer but 0; of each leg, how many parameters it has, and where directions begin. *)
Fixpoint groups_from (j : nat) (ls : list (nat * list nat)) : list (list nat) :=
  match ls with [] => [] | (n, at_) :: r => (map (fun k => seq (j + k) 3) at_ ++ groups_from (j + n) r)%list end.
Definition groups_of (ps : list parameter) (ls : list (nat * list nat)) : list (list nat) :=
  let fits i := match nth_error ps i with Some p => match small p with Some n => (n =? 0)%Z | None => true end | None => false end in
  filter (forallb fits) (groups_from 0 ls).
Definition places_of_directions (d : drive) : nat * list nat :=
  match d with SliderLeg _ => (10, [0]) | StrutLeg _ _ (Some _) => (9, [6]) | StrutLeg _ _ None => (6, []) | PlanarLeg _ => (3, [0]) end.
Definition any_places_of_directions (d : any_drive) : nat * list nat := match d with LinearDrive d => places_of_directions d | RotaryDrive _ => (14, [0; 3]) end.
Definition matrix_of (chords : option (list (list Z) * N)) : N * list (list Z) := match chords with Some (y, places) => (places, y) | None => (0%N, []) end.
(** Tolerances are not taken apart in cells of atlases. *)
Definition accept_tree (of_cell : bool) (ls : list written_leg) (w : written_region) (bs : list written_body) (rs : list written_requirement)
    (bits : positive) (chords : option (list (list Z) * N)) (nodes : list node) : bool :=
  let k := claim_of ls w bs rs in
  match tree_of 3 (free_parameters k) (if of_cell then [] else free_parameters k) (groups_of (parameters_of_claim k) (map places_of_directions (legs k))) (length nodes) nodes with
  | Some (t, []) => is_well_formed ls bs rs k &&
      certify exact_bits bits (matrix_of chords) k (length_order (legs k)) (map direction_order (legs k)) t
  | _ => false
  end.
(** Units of legs in any motion. *)
Definition any_lengths (d : any_drive) : list Claim.number := match d with LinearDrive d => lengths_of d | RotaryDrive a => (ends (arm_within a) ++ ends (rod_within a))%list end.
Definition any_places (d : any_drive) : list Claim.number :=
  match d with LinearDrive d => places_of d | RotaryDrive a => (ends3 (anchor_within a) ++ ends3 (platform_within a))%list end.
Definition any_length_order (ds : list any_drive) : Z := (1 + order_of match flat_map any_lengths ds with [] => flat_map any_places ds | l => l end)%Z.
Definition any_direction_orders (d : any_drive) : Z * Z :=
  match d with LinearDrive d => (direction_order d, 0%Z) | RotaryDrive a => (order_of (ends3 (axis_within a)), order_of (ends3 (reference_within a))) end.
Definition accept_driven_tree (k : mobility) (ls : list written_driven) (ell : option expression) (w : written_place) (o : option written_orientation)
    (rs : list written_requirement) (bits : positive) (chords : option (list (list Z) * N)) (nodes : list node) : bool :=
  let c := driven_claim_of k ls ell w o rs in
  let s := any_length_order (drives c) in let ds := map any_direction_orders (drives c) in
  let ps := Drives.driven_layouts s ds (drives c) in
  match tree_of (freedom k) (with_two_ends ps) (with_two_ends ps) (groups_of ps (map any_places_of_directions (drives c))) (length nodes) nodes with
  | Some (t, []) => are_well_formed_legs k ls ell w o rs &&
      certify_driven exact_bits bits (matrix_of chords) (place_of_two_points (has_arms ls) 1 (length ls) [] rs) c s ds t
  | _ => false
  end.
Definition accept_driven_witness (k : mobility) (ls : list written_driven) (ell : option expression) (w : written_place) (o : option written_orientation)
    (rs : list written_requirement) (point machine : list expression) (how : violation) : bool :=
  let n := match k with Translates => 3 | TranslatesInPlane => 2 | Turns m => places_of_point m end in
  let point := map denoted point in let c := driven_claim_of k ls ell w o rs in
  match take_all_driven ls (map denoted machine) with
  | (m, []) => is_one_each (flat_map quantities_of_driven ls) machine && are_well_formed_legs k ls ell w o rs && Nat.eqb (length point) (freedom k) &&
      match how, failure_at (has_arms ls) (parts_near k) (length ls) [] rs how with
      | Singular_ other, _ => let other := map denoted other in
          refute_between_driven exact_bits c m (numbers_of (firstn n point)) (skipn n point) (numbers_of (firstn n other)) (skipn n other) && Nat.eqb (length other) (freedom k)
      | _, Some f => let P := numbers_of (firstn n point) in let t := skipn n point in match how with Dependent_ => negb (has_arms ls) | _ => true end &&
          (refute_driven exact_bits c m P t f || match f with NFails i vs => refute_hastened exact_bits c m P t i vs || match vs with [v] => refute_far_driven exact_bits c m P t i v | _ => false end | _ => false end)
      | _, None => false
      end
  | _ => false
  end.
(** Of two points: ends of the box, and the matrix of Same.v, of coordinates in the units 2^scales, those of joints 2^s. *)
Fixpoint all_rational (l : list expression) : option (list Q) :=
  match l with [] => Some [] | x :: l' => match rational (denoted x), all_rational l' with Some q, Some r => Some (Qred q :: r) | _, _ => None end end.
Definition power_of_two (s : Z) : Q := if (0 <=? s)%Z then inject_Z (2 ^ s) else (1 # Z.to_pos (2 ^ (- s)))%Q.
Definition inverse_of (scales : list Z) (least greatest : list Q) (y : list (list Z)) (places : N) : list (list Q) :=
  if Nat.eqb (length y) (length scales) then
    map (fun p => let '(s, (a, b), row) := p in
      let k := Qred (2 * power_of_two (s - Z.of_N places) / (b - a))%Q in map (fun n => Qred (inject_Z n * k)) row)
      (combine (combine scales (combine least greatest)) y)
  else [].
Definition accept_driven_twins (k : mobility) (ls : list written_driven) (ell : option expression) (w : written_place) (o : option written_orientation)
    (rs : list written_requirement) (point machine : list expression) (i : nat) (a b : list expression) (y : list (list Z)) (places : N) : bool :=
  let n := match k with Translates => 3 | TranslatesInPlane => 2 | Turns m => places_of_point m end in let turns := (freedom k - n)%nat in
  let point := map denoted point in let c := driven_claim_of k ls ell w o rs in let s := any_length_order (drives c) in
  match take_all_driven ls (map denoted machine), all_rational a, all_rational b with
  | (m, []), Some a, Some b => is_one_each (flat_map quantities_of_driven ls) machine && are_well_formed_legs k ls ell w o rs && Nat.eqb (length point) (freedom k) &&
      Nat.eqb i (place_of_two_points (has_arms ls) (parts_near k) (length ls) [] rs) &&
      refute_same_driven exact_bits n c m (numbers_of (firstn n point)) (skipn n point) a b
        (inverse_of (if has_arms ls then repeat s n ++ repeat 0 turns else repeat 0 n ++ repeat (- s) turns) a b y places)%Z
  | _, _, _ => false
  end.
Definition accept_witness (ls : list written_leg) (w : written_region) (bs : list written_body) (rs : list written_requirement)
    (point machine : list expression) (how : violation) : bool :=
  let k := claim_of ls w bs rs in
  let is_right := is_one_each (flat_map quantities_of ls) machine && is_well_formed ls bs rs k in
  match point, take_legs ls (map denoted machine), how with
  | [x; y; z], (m, []), Same_ i a b c places =>
      match nth_error (require k) i, all_rational a, all_rational b with
      | Some OneToOne, Some a, Some b => is_right &&
          refute_same exact_bits k m (Numbers (denoted x) (denoted y) (denoted z)) a b (inverse_of [0; 0; 0]%Z a b c places)
      | _, _, _ => false
      end
  | [x; y; z], (m, []), Singular_ [x'; y'; z'] => is_right &&
      refute_between_legs exact_bits k m (Numbers (denoted x) (denoted y) (denoted z)) (Numbers (denoted x') (denoted y') (denoted z'))
  | [x; y; z], (m, []), how =>
      match failure_of k how with
      | Some f => let P := Numbers (denoted x) (denoted y) (denoted z) in
          is_right && (refute exact_bits k m P f || match how with Obligation i [v] => refute_far exact_bits k m P i v | _ => false end)
      | None => false
      end
  | _, _, _ => false
  end.

(** One to three parameters, named once, with ranges. *)
Definition most_level : nat := 60.
Definition are_parameters (ps : parameters_) : bool :=
  Nat.leb 1 (length ps) && Nat.leb (length ps) most_parameters && differ (map fst ps) &&
  forallb (fun p => match rational (denoted (fst (snd p))), rational (denoted (snd (snd p))) with Some a, Some b => negb (Qle_bool b a) | _, _ => false end) ps.
Fixpoint accept_cells (ps : parameters_) (ls : list written_leg) (w : written_region) (rs : list written_requirement) (part : part_) (t : atlas_tree) : bool :=
  match t with
  | Halves k a b => match nth_error part k with Some (_, level) => Nat.ltb level most_level | None => false end &&
      accept_cells ps ls w rs (halved false k part) a && accept_cells ps ls w rs (halved true k part) b
  | Whole c =>
      let by_name := references 0 ps part in
      let ls := map (leg_over by_name) ls in let w := region_over by_name w in let rs := map (requirement_over by_name) rs in
      match c with
      | Proved bits chords nodes => accept_tree true ls w [] rs bits chords nodes
      | Disproved _ point machine how =>
          accept_witness ls w [] rs (map (over by_name) point) (map (over by_name) machine) match how with Singular_ other => Singular_ (map (over by_name) other) | _ => how end
      | Undecided => true
      | Cut _ => false
      end
  end.
Definition is_share (x : expression) (found : Q) : bool :=
  match rational (denoted x) with Some q => Qle_bool 0 q && Qle_bool q found | None => false end.

(** The number of a test among those that are left, but for the first. *)
Definition number_in (left : list bool) (i : nat) : option nat :=
  match i with
  | O => Some O
  | S j => if nth j left false then Some (S (length (filter (fun x => x) (firstn j left)))) else None
  end.
(** Which tests are of requirements of Legs.v. *)
Definition tests_of_legs (legs : nat) (bs : list written_body) (rs : list written_requirement) : list bool :=
  flat_map (fun r => if is_of_legs r then repeat true (list_sum (map (Configuration.tests_of exact_bits 1) (demand_of false legs [] r)))
    else repeat false (length (other_of legs bs r))) rs.
Definition nodes_in (left : list bool) (nodes : list node) : list node :=
  map (fun n => Node (flat_map (fun s => match number_in left (fst s) with Some i => [(i, snd s)] | None => [] end) (by_ n)) (split_ n) (fails_ n) (offset_ n)) nodes.
Definition violation_in (left : list bool) (how : violation) : option violation :=
  match how with
  | Obligation i vs => option_map (fun i => Obligation i vs) (number_in left i)
  | Row i leg => option_map (fun i => Row i leg) (number_in left i)
  | Same_ i a b y places => option_map (fun i => Same_ i a b y places) (number_in left i)
  | how => Some how
  end.
Definition accept_parts_tree (ls : list written_leg) (w : written_region) (bs : list written_body) (rs : list written_requirement)
    (bits : positive) (chords : option (list (list Z) * N)) (nodes : list node) : bool :=
  let left := tests_of_legs (length ls) bs rs in let others := filter (fun r => negb (is_of_legs r)) rs in
  if existsb is_of_legs rs then accept_tree false ls w bs others bits chords (nodes_in (map negb left) nodes) &&
    accept_driven_tree Translates (map driven_leg ls) None (any_place w) None (filter is_of_legs rs) bits None (nodes_in left nodes)
  else accept_tree false ls w bs rs bits chords nodes.
Definition accept_parts_witness (ls : list written_leg) (w : written_region) (bs : list written_body) (rs : list written_requirement)
    (point machine : list expression) (how : violation) : bool :=
  let left := tests_of_legs (length ls) bs rs in let others := filter (fun r => negb (is_of_legs r)) rs in
  if existsb is_of_legs rs then
    are_well_formed_legs Translates (map driven_leg ls) None (any_place w) None (filter is_of_legs rs) &&
    match violation_in (map negb left) how with Some how => accept_witness ls w bs others point machine how | None => false end ||
    is_well_formed ls bs others (claim_of ls w bs others) &&
    match violation_in left how with Some how => accept_driven_witness Translates (map driven_leg ls) None (any_place w) None (filter is_of_legs rs) point machine how | None => false end
  else accept_witness ls w bs rs point machine how.

(** Of the tree of a closed design, what it says of the rest; about a tight corner M has full rank, which is asked there. *)
Definition closed_nodes (rs : list written_requirement) (nodes : list node) : list node :=
  let left := flat_map (fun r => if is_of_two_points r then [true] else flat_map (fun d => repeat (negb (is_by_theorem r)) (Configuration.tests_of exact_bits 1 d)) (demand_of false 3 [] r)) rs in
  let step_of (s : nat * step) := match number_in left (fst s), snd s with
    | Some i, AtCorner _ => [(i, Multiplied "rank" [[1; 0; 0]; [0; 1; 0]; [0; 0; 1]]%Z 0)]
    | Some i, s => [(i, s)]
    | None, _ => []
    end in
  map (fun n => Node (flat_map step_of (by_ n)) (split_ n) (fails_ n) (offset_ n)) nodes.
Definition accept_closed (offset side : expression) (rs : list written_requirement) (bits : positive) (chords : option (list (list Z) * N)) (nodes : list node) : bool :=
  is_number (denoted offset) && match closed_bounds rs with
  | Some (least, greatest) => check_closed exact_bits (denoted side) (denoted least) (denoted greatest) && forallb (fun r => is_driven_demand false Translates 3 r || is_of_two_points r && is_asked 0 0 r) rs &&
      forallb (fun r => match about_ r, end_ r with JointRange, AtLeast_ b => certainly exact_bits false (Minus (0 // 1) (denoted b)) | _, _ => true end) rs &&
      match closed_rest rs with
      | [] => true
      | rest => let above := certainly exact_bits false (Minus (denoted greatest) (2 // 1)) in
          (above || certainly exact_bits false (Minus (2 // 1) (denoted greatest))) &&
          accept_driven_tree Translates (closed_legs above offset side greatest) None (closed_cube above side greatest) None rest bits chords (closed_nodes rs nodes)
      end
  | None => false
  end.

Definition accept_closed_witness (offset side : expression) (rs : list written_requirement) (point machine : list expression) (how : violation) : bool :=
  is_number (denoted offset) && match closed_bounds rs with
  | Some (_, greatest) => let above := certainly exact_bits false (Minus (denoted greatest) (2 // 1)) in
      certainly exact_bits true (denoted side) && certainly exact_bits true (Minus (denoted greatest) (1 // 1)) &&
      (above || certainly exact_bits false (Minus (2 // 1) (denoted greatest))) &&
      accept_driven_witness Translates (closed_legs above offset side greatest) None (closed_cube above side greatest) None rs point machine how
  | None => false
  end.

Definition accept (c : certificate) : bool :=
  is_plain_certificate c &&
  match subject_ c, proof_ c with
  | Machine_ ls w bs rs, Nodes bits chords nodes => accept_parts_tree ls w bs rs bits chords nodes
  | Machine_ ls w bs rs, ByWitness _ point machine how => accept_parts_witness ls w bs rs point machine how
  | Atlas_ ps ls w rs certified refuted, Cells cells =>
      match atlas_of (length cells) cells with
      | Some (t, []) => are_parameters ps && is_share certified (share is_proved t) && is_share refuted (share is_disproved t) &&
          accept_cells ps ls w rs (whole_box ps) t
      | _ => false
      end
  | NoCube_ ls a b rs side, Nodes bits _ nodes =>
      let k := claim_of ls (Box_ a b) [] rs in
      match failing_tree_of (free_parameters k) (length nodes) nodes with
      | Some (t, []) => is_well_formed ls [] rs k && negb (existsb is_of_two_points rs) &&
          (is_inhabited exact_bits k && check_no_cube bits exact_bits k (denoted side) (length_order (legs k)) (map direction_order (legs k)) t)
      | _ => false
      end
  | Legs_ k ls ell w o rs, Nodes bits chords nodes => accept_driven_tree k ls ell w o rs bits chords nodes
  | Legs_ k ls ell w o rs, ByWitness _ point machine (Same_ i a b y places) => accept_driven_twins k ls ell w o rs point machine i a b y places
  | Legs_ k ls ell w o rs, ByWitness _ point machine how => accept_driven_witness k ls ell w o rs point machine how
  | Turning_ k ls ell w o bs rs, ByWitness bits point machine how =>
      let point := map denoted point in
      let n := places_of_point k in
      match take_struts ls (map denoted machine) with
      | (m, []) => is_one_each (flat_map (fun l => fst l ++ snd l)%list ls) machine && is_turning k ls ell w o bs rs &&
          let c := turning_claim_of k ls ell w o bs rs in
          match how, failure_at false (parts_of k) (length ls) bs rs how with
          | Same_ i a b y places, _ =>
              match all_rational a, all_rational b with
              | Some a, Some b =>
                  let s := (1 + order_of (flat_map (fun l => ends3 (fst l) ++ ends3 (snd l))%list (struts c)))%Z in
                  Nat.eqb i (place_of_two_points false (parts_of k) (length ls) bs rs) &&
                  refute_same_pose exact_bits n c m (numbers_of (firstn n point)) (skipn n point) a b (inverse_of (repeat 0 n ++ repeat (- s) (length point - n)) a b y places)%Z
              | _, _ => false
              end
          | Singular_ other, _ => let other := map denoted other in
              refute_between exact_bits c m (numbers_of (firstn n point)) (skipn n point) (numbers_of (firstn n other)) (skipn n other)
          | _, Some f => let P := numbers_of (firstn n point) in let t := skipn n point in refute_turning exact_bits c m P t f ||
              match f with NFails i [v] => refute_accelerated exact_bits c m P t i v || refute_far_pose exact_bits c m P t i v | _ => false end
          | _, None => false
          end
      | _ => false
      end
  | Turning_ k ls ell w o bs rs, Nodes bits chords nodes =>
      let c := turning_claim_of k ls ell w o bs rs in
      let s := (1 + order_of (flat_map (fun l => ends3 (fst l) ++ ends3 (snd l))%list (struts c)))%Z in
      match tree_of (dimension k) (free_struts s (struts c)) (free_struts s (struts c)) [] (length nodes) nodes with
      | Some (t, []) => is_turning k ls ell w o bs rs &&
          certify_turning exact_bits bits (matrix_of chords) (place_of_two_points false (parts_of k) (length ls) bs rs) c s t
      | _ => false
      end
  | Formulas_ xs ps ds rows a b rs, Nodes bits chords nodes =>
      let free := with_two_ends (Written.inputs (by_formulas (written_claim_of xs ps ds rows a b rs))) in
      match tree_of (length xs) free free [] (length nodes) nodes with
      | Some (t, []) => are_well_formed_formulas xs ps rows a b rs &&
          certify_written exact_bits bits (matrix_of chords) (place_of_two_points false 1 (length rows) [] rs) (written_claim_of xs ps ds rows a b rs) t
      | _ => false
      end
  | Formulas_ xs ps ds rows a b rs, ByWitness _ point machine how =>
      let c := written_claim_of xs ps ds rows a b rs in
      match take_list (map snd ps) (map denoted machine) with
      | (thetas, []) => is_one_each (map snd ps) machine && are_well_formed_formulas xs ps rows a b rs && is_mechanism (by_formulas c) &&
          forallb (fun t => below exact_bits (least t) (greatest t)) (box_of c) &&
          match how, failure_at false 1 (length rows) [] rs how with
          | Singular_ other, _ => refute_between_written exact_bits c thetas (map denoted point) (map denoted other)
          | Same_ i a b y places, _ =>
              match all_rational a, all_rational b with
              | Some a, Some b => Nat.eqb i (place_of_two_points false 1 (length rows) [] rs) &&
                  refute_same_written exact_bits c thetas (map denoted point) a b (inverse_of (repeat 0%Z (length xs)) a b y places)
              | _, _ => false
              end
          | _, Some f => refute_written exact_bits c thetas (map denoted point) f ||
              match f with NFails i [v] => refute_far_written exact_bits c thetas (map denoted point) i v | _ => false end
          | _, None => false
          end
      | _ => false
      end
  | Closed_ offset side rs, Nodes bits chords nodes => accept_closed offset side rs bits chords nodes
  | Closed_ offset side rs, ByWitness _ point machine how => accept_closed_witness offset side rs point machine how
  | Postulate_ None, Nodes bits _ nodes => match trees_of 3 [] [] [] 4 nodes with Some ts => check_postulate bits ts | None => false end
  | Postulate_ (Some q), Nodes bits _ nodes =>
      match trees_of 3 [] [] [] 4 nodes with Some ts => is_range q && check_postulate_up_to bits (greatest (tolerance_of q)) ts | None => false end
  | _, _ => false
  end.

Lemma accept_tree_sound : forall (names : naming) of_cell ls w bs rs bits chords nodes, accept_tree of_cell ls w bs rs bits chords nodes = true ->
  let c := claim_of ls w bs rs in @Statement.holds names c /\ exists m P, @is_about names c m P.
Proof.
  intros names of_cell ls w bs rs bits chords nodes h. unfold accept_tree in h. destruct (tree_of _ _ _ _ _ nodes) as [[tr [|]] |]; try discriminate.
  apply andb_true_iff in h as [_ h]. exact (@certify_sound names _ _ _ _ _ _ _ h).
Qed.

Lemma accept_witness_sound : forall (names : naming) ls w bs rs point machine how, accept_witness ls w bs rs point machine how = true ->
  let c := claim_of ls w bs rs in exists m P, @is_about names c m P /\ ~ @meets names c m P.
Proof.
  intros names ls w bs rs point machine how h. unfold accept_witness in h. destruct point as [| x [| y [| z [|]]]]; try discriminate.
  cbv zeta in h. destruct (take_legs _ _) as [m [|]]; [| destruct how; discriminate].
  assert (B : forall other, how = Singular_ other -> exists P', refute_between_legs exact_bits (claim_of ls w bs rs) m (Numbers (denoted x) (denoted y) (denoted z)) P' = true \/ failure_of (claim_of ls w bs rs) how <> None).
  { intros other ->. destruct other as [| x' [| y' [| z' [|]]]]; cbn [failure_of nfailure_of] in h; try discriminate. apply andb_true_iff in h as [_ h]. eexists. left. exact h. }
  destruct how; try (destruct (B _ eq_refl) as [P' [h' | n]]; [exact (refute_between_legs_sound exact_bits _ _ _ _ h') | contradiction n; reflexivity]); clear B;
    try (destruct (failure_of _ _) as [f |]; [| discriminate]; apply andb_true_iff in h as [_ h]; apply orb_true_iff in h as [h | h]; [exact (@refute_sound names _ _ _ _ _ h) | try discriminate]).
  { destruct directions as [| v [|]]; try discriminate. exact (@refute_far_sound _ names _ _ _ _ _ h). }
  destruct (nth_error _ _) as [[] |]; try discriminate. destruct (all_rational least) as [a |]; [| discriminate]. destruct (all_rational greatest) as [b |]; [| discriminate].
  apply andb_true_iff in h as [_ h]. exact (@refute_same_sound names _ _ _ _ _ _ _ h).
Qed.

Lemma accept_cells_sound : forall ps ls w rs t part, accept_cells ps ls w rs part t = true -> is_atlas ps ls w rs part t.
Proof.
  intros ps ls w rs. induction t as [k a IHa b IHb | c]; intros part h; cbn [accept_cells is_atlas] in *.
  - apply andb_true_iff in h as [h hb]. apply andb_true_iff in h as [_ ha]. split; [apply IHa, ha | apply IHb, hb].
  - destruct c as [k | bits chords nodes | bits point machine how |]; try exact I; intro names; cbv zeta in h.
    + exact (accept_tree_sound names _ _ _ _ _ _ _ _ h).
    + exact (accept_witness_sound names _ _ _ _ _ _ _ h).
Qed.

Lemma is_share_sound : forall x q, is_share x q = true -> (value (denoted x) <= Q2R q)%R.
Proof.
  intros x q h. unfold is_share in h. destruct (rational (denoted x)) as [p |] eqn:e; [| discriminate].
  apply andb_true_iff in h as [_ h]. rewrite (rational_sound _ _ e). apply Qreals.Qle_Rle, Qle_bool_iff, h.
Qed.

Lemma accept_driven_tree_sound : forall k ls ell w o rs bits chords nodes, accept_driven_tree k ls ell w o rs bits chords nodes = true ->
  let c := driven_claim_of k ls ell w o rs in driven_holds c /\ exists m P Q, is_about_driven c m P Q.
Proof.
  intros k ls ell w o rs bits chords nodes h. unfold accept_driven_tree in h. cbv zeta in h. destruct (tree_of _ _ _ _ _ nodes) as [[tr [|]] |]; try discriminate.
  apply andb_true_iff in h as [_ h]. exact (certify_driven_sound _ _ _ _ _ _ _ _ h).
Qed.

Lemma accept_driven_witness_sound : forall k ls ell w o rs point machine how, accept_driven_witness k ls ell w o rs point machine how = true ->
  let c := driven_claim_of k ls ell w o rs in exists m P Q, Forall well_formed_driven m /\ is_about_driven c m P Q /\ ~ meets_driven c m P Q.
Proof.
  intros k ls ell w o rs point machine how h. unfold accept_driven_witness in h. cbv zeta in h. destruct (take_all_driven _ _) as [m [|]]; [| discriminate].
  apply andb_true_iff in h as [_ h].
  destruct how; try (apply andb_true_iff in h as [h _]; exact (refute_between_driven_sound _ _ _ _ _ _ _ h));
    (destruct (failure_at _ _ _ _ _ _) as [f |]; [| discriminate]; apply andb_true_iff in h as [_ h]; apply orb_true_iff in h as [h | h]; [exact (refute_driven_sound _ _ _ _ _ _ h) |];
     destruct f as [| i vs | |]; try discriminate; apply orb_true_iff in h as [h | h]; [exact (refute_hastened_sound _ _ _ _ _ _ _ h) |]; destruct vs as [| v [|]]; try discriminate; exact (refute_far_driven_sound _ _ _ _ _ _ _ h)).
Qed.

Lemma accept_driven_twins_sound : forall k ls ell w o rs point machine i a b y places, accept_driven_twins k ls ell w o rs point machine i a b y places = true -> has_two_poses (driven_claim_of k ls ell w o rs).
Proof.
  intros k ls ell w o rs point machine i a b y places h. unfold accept_driven_twins in h. cbv zeta in h. destruct (take_all_driven _ _) as [m [|]]; [| discriminate].
  destruct (all_rational a); [| discriminate]. destruct (all_rational b); [| discriminate]. apply andb_true_iff in h as [_ h]. exact (refute_same_driven_sound _ _ _ _ _ _ _ _ _ h).
Qed.

Lemma claim_of_others : forall ls w bs rs, claim_of ls w bs (filter (fun r => negb (is_of_legs r)) rs) = claim_of ls w bs rs.
Proof.
  assert (K : forall (A : Type) (f : written_requirement -> list A), (forall r, is_of_legs r = true -> f r = []) -> forall rs, flat_map f (filter (fun r => negb (is_of_legs r)) rs) = flat_map f rs).
  { intros A f h. induction rs as [| r rs IH]; [reflexivity |]. cbn [filter flat_map]. destruct (is_of_legs r) eqn:e; cbn [negb]; [rewrite (h r e); exact IH | cbn [flat_map]; rewrite IH; reflexivity]. }
  intros ls w bs rs. unfold claim_of, obligations. rewrite !K; [reflexivity | |]; intros [a l g e] h; destruct a; try discriminate h; reflexivity.
Qed.
Lemma accept_parts_tree_sound : forall ls w bs rs bits chords nodes tool version, accept_parts_tree ls w bs rs bits chords nodes = true -> means (Certificate (Machine_ ls w bs rs) (Nodes bits chords nodes) tool version).
Proof.
  intros ls w bs rs bits chords nodes tool version h. unfold means, accept_parts_tree in *. cbn [subject_ proof_]. cbv zeta in *. destruct (existsb is_of_legs rs); [| exact (accept_tree_sound _ _ _ _ _ _ _ _ _ h)].
  apply andb_true_iff in h as [h h']. pose proof (accept_tree_sound _ _ _ _ _ _ _ _ _ h) as H. cbv zeta in H. rewrite claim_of_others in H. split; [exact H |]. exact (proj1 (accept_driven_tree_sound _ _ _ _ _ _ _ _ _ h')).
Qed.
Lemma accept_parts_witness_sound : forall ls w bs rs bits point machine how tool version, accept_parts_witness ls w bs rs point machine how = true ->
  means (Certificate (Machine_ ls w bs rs) (ByWitness bits point machine how) tool version).
Proof.
  intros ls w bs rs bits point machine how tool version h. unfold means, accept_parts_witness in *. cbn [subject_ proof_]. cbv zeta in *. destruct (existsb is_of_legs rs); [| exact (accept_witness_sound _ _ _ _ _ _ _ _ h)].
  apply orb_true_iff in h as [h | h]; apply andb_true_iff in h as [_ h]; (destruct (violation_in _ how) as [how' |]; [| discriminate]).
  - left. pose proof (accept_witness_sound _ _ _ _ _ _ _ _ h) as H. cbv zeta in H. rewrite claim_of_others in H. exact H.
  - right. exact (accept_driven_witness_sound _ _ _ _ _ _ _ _ _ h).
Qed.

Lemma accept_closed_witness_sound : forall offset side rs bits point machine how tool version, accept_closed_witness offset side rs point machine how = true ->
  means (Certificate (Closed_ offset side rs) (ByWitness bits point machine how) tool version).
Proof.
  intros offset side rs bits point machine how tool version h. unfold means. cbn [subject_ proof_]. unfold accept_closed_witness in h. apply andb_true_iff in h as [_ h].
  destruct (closed_bounds rs) as [[a b] |]; [| discriminate]. cbv zeta in h. set (above := certainly exact_bits false (Minus (denoted b) (2 // 1))) in *.
  apply andb_true_iff in h as [h hw]. apply andb_true_iff in h as [h ha]. apply andb_true_iff in h as [h1 h2]. apply Compare.positive_sound in h1, h2. cbn [value] in h2.
  exists above. split; [| exact (accept_driven_witness_sound _ _ _ _ _ _ _ _ _ hw)]. apply closed_numbers; [exact h1 | lra |].
  destruct above eqn:e; [unfold above in e | cbn [orb] in ha]; [apply Compare.nonneg_sound in e; cbn [value] in e; lra |].
  apply Compare.nonneg_sound in ha. cbn [value] in ha. lra.
Qed.

Lemma accept_closed_sound : forall offset side rs bits chords nodes tool version, accept_closed offset side rs bits chords nodes = true ->
  means (Certificate (Closed_ offset side rs) (Nodes bits chords nodes) tool version).
Proof.
  intros offset side rs bits chords nodes tool version h. unfold means. cbn [subject_ proof_]. unfold accept_closed in h. apply andb_true_iff in h as [_ h].
  destruct (closed_bounds rs) as [[a b] |]; [| discriminate]. apply andb_true_iff in h as [h hr]. apply andb_true_iff in h as [h hm].
  apply andb_true_iff in h as [h _]. split; [exact (check_closed_sound _ _ _ _ h _) |]. split.
  - apply Forall_forall. intros r i. rewrite forallb_forall in hm. specialize (hm r i). destruct (about_ r); try exact I. destruct (end_ r); try exact I.
    apply Compare.nonneg_sound in hm. cbn [value] in hm. lra.
  - destruct (closed_rest rs) as [| r0 rest]; [left; reflexivity |]. right. cbv zeta in hr. apply andb_true_iff in hr as [ha hr].
    set (above := certainly exact_bits false (Minus (denoted b) (2 // 1))) in *. exists above. split; [| exact (accept_driven_tree_sound _ _ _ _ _ _ _ _ _ hr)].
    unfold check_closed in h. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [h1 h2].
    apply Compare.positive_sound in h1, h2. cbn [value] in h2. apply closed_numbers; [exact h1 | lra |].
    destruct above eqn:e; [unfold above in e | cbn [orb] in ha]; [apply Compare.nonneg_sound in e; cbn [value] in e; lra |].
    apply Compare.nonneg_sound in ha. cbn [value] in ha. lra.
Qed.

Theorem accept_sound : forall c, accept c = true -> means c.
Proof.
  intros [s p t v] h. unfold accept in h. apply andb_true_iff in h as [_ h]. unfold means. cbn [subject_ proof_] in *.
  destruct s as [ls w bs rs | k ls ell w o rs | k ls ell w o bs rs | xs ps ds rows a b rs | offset side rs | ls a b rs side | [q |] | ps ls w rs certified refuted],
    p as [bits chords nodes | bits point machine how | cells]; try discriminate.
  - exact (accept_parts_tree_sound ls w bs rs bits chords nodes t v h).
  - exact (accept_parts_witness_sound ls w bs rs bits point machine how t v h).
  - exact (accept_driven_tree_sound _ _ _ _ _ _ _ _ _ h).
  - destruct how; try exact (accept_driven_witness_sound _ _ _ _ _ _ _ _ _ h). exact (accept_driven_twins_sound _ _ _ _ _ _ _ _ _ _ _ _ _ h).
  - cbv zeta in h. destruct (tree_of _ _ _ _ _ nodes) as [[tr [|]] |]; try discriminate. apply andb_true_iff in h as [_ h].
    exact (certify_turning_sound _ _ _ _ _ _ _ h).
  - cbv zeta in h. destruct (take_struts _ _) as [m [|]]; [| discriminate]. apply andb_true_iff in h as [_ h].
    destruct how; try exact (refute_between_sound _ _ _ _ _ _ _ h);
      try (destruct (all_rational least); [| discriminate]; destruct (all_rational greatest); [| discriminate]; apply andb_true_iff in h as [_ h]; exact (refute_same_pose_sound _ _ _ _ _ _ _ _ _ h));
      (destruct (failure_at _ _ _ _ _ _) as [f |]; [| discriminate]; apply orb_true_iff in h as [h | h]; [exact (refute_turning_sound _ _ _ _ _ _ h) |]; destruct f as [| i [| d [|]] | |]; try discriminate;
       apply orb_true_iff in h as [h | h]; [exact (refute_accelerated_sound _ _ _ _ _ _ _ h) | exact (refute_far_pose_sound _ _ _ _ _ _ _ h)]).
  - cbv zeta in h. destruct (tree_of _ _ _ _ _ nodes) as [[tr [|]] |]; try discriminate. apply andb_true_iff in h as [_ h].
    exact (certify_written_sound _ _ _ _ _ _ h).
  - cbv zeta in h. destruct (take_list _ _) as [thetas [|]]; [| discriminate]. apply andb_true_iff in h as [_ h].
    destruct how; try exact (refute_between_written_sound _ _ _ _ _ h);
      try (destruct (all_rational least); [| discriminate]; destruct (all_rational greatest); [| discriminate]; apply andb_true_iff in h as [_ h]; exact (refute_same_written_sound _ _ _ _ _ _ _ h)); (destruct (failure_at _ _ _ _ _ _) as [f |]; [| discriminate]; apply orb_true_iff in h as [h | h]; [exact (refute_written_sound _ _ _ _ _ h) |];
      destruct f as [| i [| v' [|]] | |]; try discriminate; exact (refute_far_written_sound _ _ _ _ _ _ h)).
  - exact (accept_closed_sound offset side rs bits chords nodes t v h).
  - exact (accept_closed_witness_sound offset side rs bits point machine how t v h).
  - cbv zeta in h. destruct (failing_tree_of _ _ nodes) as [[tr [|]] |]; try discriminate. apply andb_true_iff in h as [_ h].
    exact (check_no_cube_certified _ _ _ _ _ _ _ h).
  - destruct (trees_of 3 [] [] [] 4 nodes) as [ts |]; [| discriminate]. apply andb_true_iff in h as [_ h]. split; [exact (check_postulate_greatest _ _ _ h) |].
    intros psi h1 [_ h2] L a e hL m P hP. split; [exact (check_postulate_up_to_sound _ _ _ h L a e hL psi (conj h1 h2) P hP) |].
    intros Q hQ. exact (Paper.one_to_one L a e psi hL h1 Q P hQ hP).
  - destruct (trees_of 3 [] [] [] 4 nodes) as [ts |]; [| discriminate]. intros psi h1 L a e hL m P hP.
    split; [exact (check_postulate_sound _ _ h L a e hL psi h1 P hP) |]. intros Q hQ. exact (Paper.one_to_one L a e psi hL h1 Q P hQ hP).
  - destruct (atlas_of _ cells) as [[t' [|]] |]; try discriminate. apply andb_true_iff in h as [h hc]. apply andb_true_iff in h as [h hr].
    apply andb_true_iff in h as [_ hs]. split; [exact (accept_cells_sound _ _ _ _ _ _ hc) |]. split; apply is_share_sound; assumption.
Qed.

(** A text, and what was read from it. *)
Definition verify (t : string) (c : certificate) : bool := String.eqb (String.concat "" (print c)) t && accept c.

Theorem verify_sound : forall t c, verify t c = true ->
  t = String.concat "" (print c) /\ is_plain_certificate c = true /\ means c.
Proof.
  intros t c h. apply andb_true_iff in h as [e h]. apply String.eqb_eq in e. split; [symmetry; exact e |].
  split; [| exact (accept_sound c h)]. unfold accept in h. apply andb_true_iff in h as [p _]. exact p.
Qed.
