(* From JSON to a certificate of the verified checker. Nothing here is trusted: what is read is
   printed again by verified code, and has to be the text, byte for byte. *)
open Verified

(* No certificate, or one of a kind that the checker does not know. *)
exception Malformed
exception Not_covered of string

type json = Object of (string * json) list | Array of json list | String of string | Integer of string

(* Most brackets that are open at once. *)
let most_depth = 64

let parse text =
  let n = String.length text and at = ref 0 in
  let peek () = if !at < n then text.[!at] else raise Malformed in
  let take c = if peek () = c then incr at else raise Malformed in
  let span from is = while !at < n && is text.[!at] do incr at done; String.sub text from (!at - from) in
  let string () =
    take '"';
    let s = span !at (fun c -> c <> '"' && c <> '\\' && c >= ' ') in
    take '"'; s in
  let list item close =
    if peek () = close then (incr at; [])
    else
      let rec go items =
        let items = item () :: items in
        if peek () = ',' then (incr at; go items) else (take close; List.rev items) in
      go [] in
  let rec value depth () =
    if depth > most_depth then raise Malformed;
    match peek () with
    | '{' ->
      incr at;
      Object (list (fun () -> let key = string () in take ':'; let v = value (depth + 1) () in (key, v)) '}')
    | '[' -> incr at; Array (list (value (depth + 1)) ']')
    | '"' -> String (string ())
    | '-' | '0' .. '9' ->
      let from = !at in
      incr at;
      (match span from (fun c -> c >= '0' && c <= '9') with "-" -> raise Malformed | s -> Integer s)
    | _ -> raise Malformed in
  let v = value 0 () in
  if !at < n && text.[!at] = '\n' then incr at;
  if !at < n then raise Malformed;
  v

(* Shapes *)
let members = function Object l -> l | _ -> raise Malformed
let array = function Array l -> l | _ -> raise Malformed
let string = function String s -> s | _ -> raise Malformed
let digits = function Integer s -> s | _ -> raise Malformed
let find l key = List.assoc_opt key l
let get l key = match find l key with Some v -> v | None -> raise Malformed
let optional f = function Some v -> Some (f v) | None -> None
let variant = function
  | Object [ (name, v) ] -> (name, v)
  | String name -> (name, Array [])
  | _ -> raise Malformed
let triple f v = match List.map f (array v) with
  | [ first; second; third ] -> { first; second; third }
  | _ -> raise Malformed

(* Integers, by the extracted operations alone *)
let decimal (s : string) : uint =
  String.fold_right (fun c (l : uint) : uint -> match c with
    | '0' -> D0 l | '1' -> D1 l | '2' -> D2 l | '3' -> D3 l | '4' -> D4 l
    | '5' -> D5 l | '6' -> D6 l | '7' -> D7 l | '8' -> D8 l | '9' -> D9 l
    | _ -> raise Malformed) s Nil
let natural s = Z.of_uint (decimal s)
let integer v =
  let s = digits v in
  if s.[0] = '-' then Z.opp (natural (String.sub s 1 (String.length s - 1))) else natural s
let positive v = Z.to_pos (natural (digits v))
let places v = match digits v with s when String.length s <= 2 && int_of_string s < 64 -> Z.to_N (natural s) | _ -> raise Malformed
(* Counts of what is in a file: small. *)
let count v =
  let s = digits v in
  if String.length s > 6 then raise Malformed;
  let rec nat n : nat = if n <= 0 then O else S (nat (n - 1)) in
  nat (int_of_string s)

(* Numbers: section 3 of FORMAT.md *)
let is_letter c = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
let term name text =
  let n = String.length text and at = ref 0 in
  let is c = !at < n && text.[!at] = c in
  let digits () =
    let from = !at in
    while !at < n && text.[!at] >= '0' && text.[!at] <= '9' do incr at done;
    String.sub text from (!at - from) in
    let rec sum depth =
    if depth > most_depth then raise Malformed;
    let rec go x =
      if is '+' then (incr at; let y = product depth in go (Binary (Addition, x, y)))
      else if is '-' then (incr at; let y = product depth in go (Binary (Subtraction, x, y)))
      else x in
    go (product depth)
  and product depth =
    let rec go x =
      if is '*' then (incr at; let y = factor depth in go (Binary (Multiplication, x, y)))
      else if is '/' then (incr at; let y = factor depth in go (Binary (Division, x, y)))
      else x in
    go (factor depth)
  and factor depth =
    if depth > most_depth then raise Malformed;
    if is '-' then (incr at; Negative (factor (depth + 1)))
    else
      let x = atom depth in
      if is '^' then (incr at; match digits () with
        | "" -> raise Malformed
        | s when String.length s <= 2 && 2 <= int_of_string s && int_of_string s <= 64 -> Power (x, Z.to_pos (natural s))
        | _ -> raise Malformed)
      else x
  and parenthesised depth = incr at; let x = sum (depth + 1) in if is ')' then (incr at; x) else raise Malformed
  and atom depth =
    if is '(' then parenthesised depth
    else if !at + 5 <= n && String.sub text !at 5 = "sqrt(" then (at := !at + 4; SquareRoot (parenthesised depth))
    else if !at < n && is_letter text.[!at] then begin
      let from = !at in
      while !at < n && (is_letter text.[!at] || text.[!at] = '_' || (text.[!at] >= '0' && text.[!at] <= '9')) do incr at done;
      Name (name (String.sub text from (!at - from)))
    end else
      let whole = digits () in
      let decimals = if is '.' then (incr at; Some (digits ())) else None in
      if whole = "" || (String.length whole > 1 && whole.[0] = '0') then raise Malformed;
      match decimals with
      | None -> Literal (decimal whole, Nil)
      | Some d when d = "" || d.[String.length d - 1] = '0' -> raise Malformed
      | Some d -> Literal (decimal whole, decimal d) in
  let x = sum 0 in
  if !at < n then raise Malformed else x
let expression text = term (fun name -> Called name) text
let formula v = term (fun name -> name) (string v)

(* Formulas are proved with their definitions written out: at most so many operations of them, and of definitions. *)
let most_written_out = 32768
let written_out definitions terms =
  let rec size known x = min (most_written_out + 1) (match x with
    | Literal _ -> 1
    | Name name -> Option.value (List.assoc_opt name known) ~default:1
    | Negative x | SquareRoot x -> 1 + size known x
    | Binary (_, x, y) -> 1 + size known x + size known y
    | Power (x, n) -> size known x * Big_int_Z.int_of_big_int n) in
  let known = List.fold_left (fun known (name, x) -> (name, size known x) :: known) [] definitions in
  List.fold_left (+) 0 (List.map snd known @ List.map (size known) terms)

let number v = expression (string v)
let quantity = function
  | String s -> One (expression s)
  | v -> let l = members v in Between (number (get l "min"), number (get l "max"))

(* Claims *)
let not_covered what = raise (Not_covered (String.concat "" what ^ " is not covered by the verified checker"))
let mode v = match string v with "+" -> true | "-" -> false | s -> raise Malformed
let leg v =
  let l = members v in
  let vector key = triple quantity (get l key) in
  match string (get l "drive") with
  | "slider" ->
    Slider_ (vector "direction", vector "anchor", vector "platform", quantity (get l "length"), mode (get l "mode"))
  | "strut" -> Strut_ (vector "anchor", vector "platform", optional (triple quantity) (find l "base_axis"))
  | "planar" -> Planar_ (vector "direction")
  | drive -> not_covered [ "the drive \""; drive; "\"" ]
let is_arm v = match members v with ("drive", String "arm") :: _ -> true | _ -> false
(* A leg in any motion. *)
let driven v =
  let l = members v in
  let vector key = List.map quantity (array (get l key)) in
  match string (get l "drive"), optional (fun v -> List.map quantity (array v)) (find l "base_axis") with
  | "slider", None -> AnySlider_ (vector "direction", vector "anchor", vector "platform", quantity (get l "length"), mode (get l "mode"))
  | "strut", axis -> AnyStrut_ (vector "anchor", vector "platform", axis)
  | "planar", None -> AnyPlanar_ (vector "direction")
  | "arm", None -> AnyArm_ (vector "axis", vector "reference", vector "anchor", vector "platform", quantity (get l "arm"), quantity (get l "length"), mode (get l "mode"))
  | drive, _ -> not_covered [ "the drive \""; drive; "\" of such a machine" ]
let is_slider v = match members v with ("drive", String "slider") :: _ -> true | _ -> false
let is_plane v = match members v with ("drive", String "planar") :: _ -> true | _ -> false
let is_strut v = match members v with ("drive", String "strut") :: _ -> true | _ -> false

let two f v = match array v with [ x; y ] -> (f x, f y) | _ -> raise Malformed

let requirement ?(turns = false) v =
  let l = members v in
  let about_ = match string (get l "quantity") with
    | "transmission" -> Transmission
    | "joint_range" -> JointRange
    | "joint_speed" -> Speed_
    | "conditioning" -> Condition_
    | "serial_margin" -> Serial_
    | "parallel_margin" -> Parallel_
    | "stiffness" -> Stiffness_
    | "constraint_margin" -> Constraint_
    | "joint_force" -> Force_
    | "joint_acceleration" -> Acceleration_
    | "one_to_one" -> OneToOne_
    | "accuracy" -> Accuracy_
    | "clearance" -> Clearance_
    | "leg_angle" -> LegAngle_
    | "load" -> Load_
    | "base_joint" when turns -> BaseJoint_
    | "platform_joint" when turns -> PlatformJoint_
    | quantity -> not_covered [ "the quantity \""; quantity; "\"" ] in
  let bound () = get l "bound" in
  let end_ = match string (get l "end") with
    | "max" -> AtMost_ (number (bound ()))
    | "min" -> AtLeast_ (number (bound ()))
    | "within" -> let a, b = two number (bound ()) in Within_ (a, b)
    | "holds" -> Holds_
    | bound -> not_covered [ "a bound \""; bound; "\"" ] in
  let given v = match about_, members v with
    | (Speed_ | Force_), [ ("tool", Array [ x ]) ] | Stiffness_, [ ("joint", Array [ x ]) ] | Accuracy_, [ ("joint_error", Array [ x ]) ] -> Given_ (number x)
    | Acceleration_, [ ("acceleration", Array [ a ]); ("speed", Array [ v ]) ] -> Motion_ (number a, number v)
    | (BaseJoint_ | PlatformJoint_), [ ("axis", Array l) ] -> Each_ (List.map number l)
    | Accuracy_, [ ("joint_error", Array [ e ]); ("max_angle", Array [ a ]) ] when turns -> Near_ (number e, number a)
    | Stiffness_, [ ("joint", Array l) ] | Load_, [ ("force", Array l) ] -> Each_ (List.map number l)
    | _ -> raise Malformed in
  { about_; leg_ = optional count (find l "leg"); given_ = optional given (find l "given"); end_ }

(* Of machines of Configuration.v, and of these of platforms that turn. *)
let demand v =
  let r = requirement ~turns:true v in
  match r.about_ with
  | Transmission | JointRange | Condition_ -> r
  | _ -> not_covered [ "this quantity of such a mechanism" ]
let turning_demand v =
  let r = requirement ~turns:true v in
  match r.about_ with
  | Speed_ | Force_ | Stiffness_ -> r
  | _ -> demand v

let two_points_demand v =
  let r = requirement ~turns:true v in
  if r.about_ = OneToOne_ then r else turning_demand v
let formulas_demand v =
  let r = requirement ~turns:true v in
  if r.about_ = Accuracy_ then r else two_points_demand v
let strut_demand v =
  let r = requirement ~turns:true v in
  match r.about_ with
  | BaseJoint_ | PlatformJoint_ | Clearance_ | Acceleration_ | Accuracy_ -> r
  | _ -> two_points_demand v
let driven_demand v =
  let r = requirement ~turns:true v in
  match r.about_ with
  | Serial_ | Parallel_ | LegAngle_ | Load_ | OneToOne_ | Acceleration_ | Accuracy_ -> r
  | _ -> turning_demand v

let region (kind, v) =
  let l = members v in
  match kind with
  | "box" -> Box_ (triple number (get l "min"), triple number (get l "max"))
  | _ ->
    let x, y = two number (get l "center") and bottom, top = two number (get l "z") in
    Cylinder_ (x, y, number (get l "radius"), bottom, top)

let place (kind, v) =
  let l = members v in
  match kind with
  | "box" -> AnyBox_ (List.map number (array (get l "min")), List.map number (array (get l "max")))
  | _ -> let x, y = two number (get l "center") and bottom, top = two number (get l "z") in
    AnyCylinder_ (x, y, number (get l "radius"), bottom, top)

let body v =
  let l = members v in
  let number key = number (get l key) and triple key = triple number (get l key) in
  match string (get l "on") with
  | "leg" ->
    let a, b = two Fun.id (get l "trim") in
    AlongLeg_ (count (get l "leg"), number "radius", expression (string a), expression (string b), optional (fun _ -> triple "offset") (find l "offset"))
  | ("base" | "platform") as on -> Fixed_ (on = "platform", triple "from", triple "to", number "radius")
  | _ -> raise Malformed

let rec subject v =
  match variant v with
  | "postulate", v -> Postulate_ (match get (members v) "psi_max" with String "all" -> None | v -> Some (quantity v))
  | "machine", v ->
    let l = members v in
    let require () = List.map requirement (array (get l "require")) in
    let bodies = match find l "bodies" with Some v -> List.map body (array v) | None -> [] in
    let without_bodies () = if bodies <> [] then not_covered [ "such a machine with bodies" ] in
    (match variant (get l "mechanism"), variant (get l "workspace") with
     | (("planar" | "spatial" | "spherical") as kind, t), (workspace, w as region) ->
       let t = members t in
       let ell = optional number (find t "characteristic_length") in
       let orientation v = match variant v with
         | "range", v -> let a, b = two number v in Range_ (a, b)
         | "roll_pitch_yaw", v ->
           let range key = two number (get (members v) key) in
           RollPitchYaw_ (range "roll", range "pitch", range "yaw")
         | "angle", v -> Angle_ (number v)
         | "tilt", v -> Tilt_ (number (get (members v) "tilt"), number (get (members v) "torsion"))
         | _ -> raise Malformed in
       let orientation = optional orientation (find l "orientation") in
       let motion = match kind with "planar" -> InPlane | "spatial" -> InSpace | _ -> AboutPoint in
       let legs = array (get t "legs") in
       (match ell, orientation with
        | Some ell, Some orientation when List.for_all is_strut legs ->
          let strut v =
            let l = members v in
            let vector key = List.map quantity (array (get l key)) in
            if find l "base_axis" <> None then not_covered [ "a base axis of such a platform" ];
            (vector "anchor", vector "platform") in
          let require = List.map strut_demand (array (get l "require")) in
          Turning_ (motion, List.map strut legs, ell, place region, orientation, bodies, require)
        | _ ->
          without_bodies ();
          let kind = match ell with None when kind = "planar" -> TranslatesInPlane | _ -> Turns motion in
          if orientation <> None && List.exists is_strut legs then not_covered [ "a platform that turns on struts and other drives" ];
          Legs_ (kind, List.map driven legs, ell, place region, orientation, List.map driven_demand (array (get l "require"))))
     | _ when find l "orientation" <> None -> raise Malformed
     | ("translational", legs), (("box" | "cylinder"), _ as workspace) ->
       let legs = array legs in
       let require = require () in
       let asks = List.exists (fun r -> match r.about_ with
         | Constraint_ | Clearance_ | Acceleration_ | Accuracy_ -> true
         | OneToOne_ -> List.exists is_plane legs
         | Parallel_ -> not (List.for_all is_slider legs)
         | _ -> false) require in
       if List.exists is_arm legs || List.exists is_of_legs require && not asks then begin
         without_bodies ();
         Legs_ (Translates, List.map driven legs, None, place workspace, None, List.map driven_demand (array (get l "require")))
       end else begin
         let legs = List.map leg legs in
         Machine_ (legs, region workspace, bodies, require)
       end
     | ("formulas", f), ("box", box) ->
       without_bodies ();
       let f = members f and box = members box in
       let pairs item v = List.map (fun v -> match array v with [ name; x ] -> (string name, item x) | _ -> raise Malformed) (array v) in
       let row v = match members v with
         | [ ("row", row) ] -> Row_ (List.map formula (array row))
         | [ ("rho", rho) ] -> Rho_ (formula rho)
         | _ -> raise Malformed in
       let definitions = pairs formula (get f "definitions") and rows = List.map row (array (get f "joints")) in
       if written_out definitions (List.concat_map (function Row_ row -> row | Rho_ x -> [ x ]) rows) > most_written_out then
         not_covered [ "a mechanism of more than "; string_of_int most_written_out; " operations, with its definitions written out," ];
       Formulas_ (List.map string (array (get f "coordinates")), pairs quantity (get f "parameters"), definitions, rows,
         List.map number (array (get box "min")), List.map number (array (get box "max")),
         List.map formulas_demand (array (get l "require")))
     | ("orthoglide", o), ("cube", cube) ->
       without_bodies ();
       let require = List.map driven_demand (array (get l "require")) in
       (match List.filter (fun r -> r.about_ = Transmission) require with
        | [ { end_ = AtLeast_ _; _ }; { end_ = AtMost_ _; _ } ] | [ { end_ = AtMost_ _; _ }; { end_ = AtLeast_ _; _ } ] -> ()
        | _ -> not_covered [ "the closed design with other bounds on psi than one from below and one from above" ]);
       Closed_ (number (get (members o) "offset"), number (get (members cube) "side"), require)
     | (("translational" | "formulas"), _), (workspace, _) -> not_covered [ "the workspace \""; workspace; "\"" ]
     | (mechanism, _), _ -> not_covered [ "the mechanism \""; mechanism; "\"" ])
  | "no_cube", v ->
    let l = members v in
    (match subject (Object [ ("machine", get l "machine") ]) with
     | Machine_ (legs, Box_ (min, max), [], require) when not (List.exists is_of_legs require) -> NoCube_ (legs, min, max, require, number (get l "side"))
     | _ -> not_covered [ "a claim that no cube of such a machine fits" ])
  | "atlas", v ->
    let l = members v in
    let parameter v = let p = members v in (string (get p "name"), (number (get p "min"), number (get p "max"))) in
    (match subject (Object [ ("machine", get l "machine") ]) with
     | Machine_ (legs, region, [], require) when not (List.exists is_of_legs require) ->
       Atlas_ (List.map parameter (array (get l "parameters")), legs, region, require, number (get l "certified"), number (get l "refuted"))
     | _ -> not_covered [ "an atlas of such a machine" ])
  | claim, _ -> not_covered [ "a claim of the kind \""; claim; "\"" ]

(* Proofs *)
let integers v = List.map integer (array v)
let face v = match string v with "Q1" -> Q1 | "Q2" -> Q2 | s -> raise Malformed
(* [n] legs: so many rows of [m] entries. *)
let row length v = let l = integers v in if List.length l <> length then raise Malformed else l
let matrix (n, m) v =
  let l = members v in
  let y = List.map (row m) (array (get l "y")) in
  if List.length y <> n then raise Malformed else (y, places (get l "places"))
let rec evidence shape v =
  (* Of the test of one leg, one number. *)
  let (_, m as shape) = match v with Object [ ("lower", Object [ ("y", Array [ Array [ _ ] ]); _ ]) ] -> (1, 1) | _ -> shape in
  let multiplier f v = let y, places = matrix shape v in f y places in
  match v with
  | String name -> Plain name
  | Object [ ("corner", f) ] -> AtCorner (face f)
  | Object [ ("control", e) ] -> AtControls_ (at_controls shape e)
  | Object [ ("tolerances", Array [ e; ends; directions ]) ] -> Apart_ (evidence shape e, string ends, List.map integers (array directions))
  | Object [ ("inside", Array [ e; k; p ]) ] -> Inside_ (evidence shape e, integer k, places p)
  | Object [ ("accuracy", Array [ y; kappa; q ]) ] ->
    multiplier (fun y p -> Accurate_ (y, p, integer kappa, places q)) y
  | Object [ ("conditioning", Array [ y; mu ]) ] -> multiplier (fun y places -> Conditioned_ (y, places, row (m + 1) mu)) y
  | Object [ (("lower" | "lower_divided" | "rank") as name, y) ] -> multiplier (fun y places -> Multiplied (name, y, places)) y
  | Object [ ("direction", y) ] ->
    let l = members y in
    let rows = List.map (row (m + 1)) (array (get l "y")) in
    if List.length rows <> 3 then raise Malformed else Multiplied ("direction", rows, places (get l "places"))
  | Object [ ("fan", Array parts) ] ->
    let rec is_of_fan = function
      | String ("test" | "divided") | Object [ (("tolerances" | "lower" | "lower_divided" | "rank"), _) ] -> true
      | Object [ ("inside", Array (e :: _)) ] -> is_of_fan e
      | _ -> false in
    let rec is_of_divided = function
      | String "divided" | Object [ ("lower_divided", _) ] -> true
      | Object [ (("inside" | "tolerances"), Array (e :: _)) ] -> is_of_divided e
      | _ -> false in
    let part = function
      | Array [ c; n; p; e ] when is_of_fan e -> (is_of_divided e, (((integers c, integer n), places p), evidence shape e))
      | Array [ _; _; _; _ ] -> not_covered [ "this evidence \"fan\"" ]
      | _ -> raise Malformed in
    let parts = List.map part parts in
    if List.exists fst parts && not (List.for_all fst parts) then not_covered [ "evidence \"fan\" about \"divided\" and other rows" ];
    Fan_ (List.map snd parts)
  | Object [ ("between", Array [ mu; p; weights; e; f ]) ] -> Between_ (row (m + 1) mu, places p, List.map integers (array weights), evidence shape e, evidence shape f)
  | Object [ ("together", Array [ e; rows; p ]) ] -> Together_ (evidence shape e, List.map integers (array rows), places p)
  | Object [ (name, _) ] -> not_covered [ "the evidence \""; name; "\"" ]
  | _ -> raise Malformed
and at_controls shape v =
  match v with
  | Object [ ("turned", Array [ (String ("test" | "chords") | Object [ (("lower" | "rank" | "conditioning" | "accuracy"), _) ]) as e; n; p ]) ] -> Turned_ (evidence shape e, integer n, places p)
  | String ("test" | "chords") | Object [ (("lower" | "rank" | "conditioning" | "accuracy"), _) ] -> evidence shape v
  | _ -> not_covered [ "this evidence at control points" ]
let step n v =
  match array v with
  | [ i; String "outside" ] when digits i <> "0" -> raise Malformed
  | [ i; e ] -> (count i, evidence n e)
  | _ -> raise Malformed
let fails v =
  match variant v with
  | "reach", _ -> Reach
  | "obligation", Array [ i; vs ] -> Obligation (count i, List.map integers (array vs))
  | "row", Array [ i; leg ] -> Row (count i, count leg)
  | "dependent", Array [] -> Dependent_
  | "singular", other -> Singular_ (List.map number (array other))
  | "same", v ->
    let l = members v in
    let numbers key = List.map number (array (get l key)) and inverse = members (get l "inverse") in
    Same_ (count (get l "obligation"), numbers "least", numbers "greatest", List.map integers (array (get inverse "y")), places (get inverse "places"))
  | name, _ -> not_covered [ "the failure \""; name; "\"" ]
let node n v =
  let l = members v in
  let list f key = match find l key with Some v -> List.map f (array v) | None -> [] in
  { by_ = list (step n) "by"; split_ = optional count (find l "split"); fails_ = optional fails (find l "fails"); offset_ = list integer "at" }
let tree n t =
  let l = members t in
  (positive (get l "precision"), optional (matrix n) (find l "chords"), List.map (node n) (array (get l "nodes")))
let witness w =
  let l = members w in
  let machine = match find l "machine" with Some v -> List.map number (array v) | None -> [] in
  (positive (get l "precision"), List.map number (array (get l "point")), machine, fails (get l "fails"))
let cell n v =
  match variant v with
  | "split", k -> Cut (count k)
  | "certified", t -> let bits, chords, nodes = tree n t in Proved (bits, chords, nodes)
  | "refuted", w -> let bits, point, machine, fails = witness w in Disproved (bits, point, machine, fails)
  | "undecided", _ -> Undecided
  | _ -> raise Malformed
let proof n v =
  match variant v with
  | "tree", t -> let bits, chords, nodes = tree n t in Nodes (bits, chords, nodes)
  | "witness", w -> let bits, point, machine, fails = witness w in ByWitness (bits, point, machine, fails)
  | "atlas", cells -> Cells (List.map (cell n) (array cells))
  | name, _ -> not_covered [ "a proof of the kind \""; name; "\"" ]

let is_certified_only r = match r.about_ with Force_ | Acceleration_ | OneToOne_ | Accuracy_ -> true | _ -> false
let has_each = List.exists (fun r -> match r.given_ with Some (Each_ _) -> true | _ -> false)
(* By slopes are angles of more than 90 degrees at joints, and accelerations. *)
let is_by_slopes r = match r.about_, r.end_ with
  | (BaseJoint_ | PlatformJoint_), AtMost_ b -> not (up_to_90 (denoted b))
  | about, _ -> about = Acceleration_
let is_pose_step rs (_, s) = match s with
  | AtControls_ _ | Plain "outside" | Multiplied ("direction", _, _) | Apart_ _ | Fan_ _ -> true
  | Plain "test" -> List.exists is_by_slopes rs
  | _ -> false

let certificate text =
  let l = members (parse text) in
  (match string (get l "format") with
   | "orthocert/2" -> ()
   | format -> raise Malformed);
  let subject_ = subject (get l "claim") in
  let shape = match subject_ with
    | Machine_ (legs, _, _, _) | NoCube_ (legs, _, _, _, _) | Atlas_ (_, legs, _, _, _, _) -> (List.length legs, 3)
    | Formulas_ (coordinates, _, _, rows, _, _, _) -> (List.length rows, List.length coordinates)
    | Turning_ (kind, legs, _, _, _, _, _) -> (List.length legs, match kind with InSpace -> 6 | _ -> 3)
    | Legs_ (kind, legs, _, _, _, _) -> (List.length legs, match kind with TranslatesInPlane -> 2 | Turns InSpace -> 6 | _ -> 3)
    | Closed_ _ | Postulate_ _ -> (3, 3) in
  let proof_ = proof shape (get l "proof") in
  let accelerates = List.exists (fun r -> r.about_ = Acceleration_) in
  let plane_accelerates legs rs = accelerates rs && List.exists (function Planar_ _ -> true | _ -> false) legs in
  (* Apart are all that is shown of M, at control points, of as many struts as coordinates, over a box. *)
  let has_other_apart kind legs w nodes =
    let is_square = List.length legs = (match kind with InSpace -> 6 | _ -> 3) && (match kind, w with AboutPoint, _ | _, AnyCylinder_ _ -> false | _ -> true) in
    let is_lower = function Apart_ (AtControls_ (Multiplied ("lower", _, _) | Turned_ (Multiplied ("lower", _, _), _, _)), _, _) -> is_square | _ -> false in
    let is_other = function
      | O, (Apart_ _ as s) -> not (is_lower s)
      | O, Fan_ parts -> not (List.for_all (fun (_, s) -> is_lower s) parts)
      | _, (Apart_ _ | Fan_ _) -> true
      | _ -> false in
    List.exists (fun n -> List.exists is_other n.by_) nodes in
  let has_failure = List.exists (fun n -> n.fails_ <> None) in
  (match subject_, proof_ with
   | Turning_ (kind, legs, _, w, _, _, _), Nodes (_, _, nodes) when has_other_apart kind legs w nodes ->
     not_covered [ "this evidence \"tolerances\" of a platform that turns" ]
   | Legs_ _, Nodes (_, _, nodes) when List.exists (fun n -> List.exists (fun (_, s) -> match s with Turned_ _ | AtControls_ _ -> true | _ -> false) n.by_) nodes ->
     not_covered [ "this set of orientations with such drives" ]
   | Turning_ (_, _, _, _, _, _, rs), Nodes (_, _, nodes) when not (List.for_all (fun n -> List.for_all (is_pose_step rs) n.by_) nodes) ->
     not_covered [ "a step of a platform that turns that is not at control points" ]
   | Atlas_ _, Cells cells when List.exists (function Disproved (_, _, _, Same_ _) -> true | _ -> false) cells -> not_covered [ "the failure \"same\" of such a mechanism" ]
   | (Machine_ (legs, _, _, rs), Nodes _ | Atlas_ (_, legs, _, rs, _, _), _) when plane_accelerates legs rs ->
     not_covered [ "the acceleration of a joint of a machine with a plane" ]
   | Legs_ (_, legs, _, _, _, rs), Nodes _ when accelerates rs && List.exists (function AnyPlanar_ _ -> true | _ -> false) legs ->
     not_covered [ "the acceleration of a joint of a machine with a plane" ]
   | NoCube_ (_, _, _, rs, _), _ when List.exists is_certified_only rs -> not_covered [ "this quantity in a claim that is refuted" ]
   | NoCube_ _, Nodes (_, _, nodes) when List.exists (fun n -> n.by_ <> []) nodes -> not_covered [ "a step in a proof that no cube fits" ]
   | (NoCube_ (_, _, _, rs, _) | Atlas_ (_, _, _, rs, _, _)), _ when has_each rs ->
     not_covered [ "a stiffness for each joint in such a claim" ]
   | NoCube_ _, _ -> ()
   | Atlas_ _, Cells cells ->
     let is_outside cell = match cell with Proved (_, _, nodes) -> has_failure nodes | _ -> false in
     if List.exists is_outside cells then not_covered [ "a leaf that fails" ]
   | _, Nodes (_, _, nodes) when has_failure nodes -> not_covered [ "a leaf that fails" ]
   | _ -> ());
  let p = members (get l "provenance") in
  { subject_; proof_; tool = string (get p "tool"); version = string (get p "version") }

type verdict =
  | Certified (* the claim holds of every machine, and there is one *)
  | Refuted (* a machine of the claim does not meet it *)
  | Rejected (* no certificate in canonical text, or its proof shows nothing *)
  | Not_known of string (* of a kind that is not covered *)

(* The only call of verified code that decides. *)
let verdict text =
  match certificate text with
  | exception Not_covered why -> Not_known why
  | exception Malformed -> Rejected
  | c when not (verify text c) -> Rejected
  | { proof_ = Nodes _ | Cells _; _ } -> Certified
  | { proof_ = ByWitness _; _ } -> Refuted

(* What orthocert-check takes for a paving. *)
let is_paving text =
  let name = "\"orthocert-paving/" in
  let n = min 64 (String.length text) - String.length name in
  let rec at i = i <= n && (String.sub text i (String.length name) = name || at (i + 1)) in
  at 0
