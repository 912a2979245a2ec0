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
      Integer (span from (fun c -> c >= '0' && c <= '9'))
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
let places v = Z.to_N (natural (digits v))
(* Counts of what is in a file: small. *)
let count v =
  let s = digits v in
  if String.length s > 6 then raise Malformed;
  let rec nat n : nat = if n <= 0 then O else S (nat (n - 1)) in
  nat (int_of_string s)

(* Numbers: section 3 of FORMAT.md *)
let expression text =
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
    else
      let whole = digits () in
      let decimals = if is '.' then (incr at; Some (digits ())) else None in
      if whole = "" || (String.length whole > 1 && whole.[0] = '0') then raise Malformed;
      match decimals with
      | None -> Literal (decimal whole, Nil)
      | Some d when d = "" || d.[String.length d - 1] = '0' -> raise Malformed
      | Some d -> Literal (decimal whole, decimal d) in
  let x = sum 0 in
  if !at < n then raise Malformed else x

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

let requirement v =
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
    | quantity -> not_covered [ "the quantity \""; quantity; "\"" ] in
  let is_max = match string (get l "end") with
    | "max" -> true
    | "min" -> false
    | bound -> not_covered [ "a bound \""; bound; "\"" ] in
  let given v = match about_, members v with
    | Speed_, [ ("tool", Array [ x ]) ] | Stiffness_, [ ("joint", Array [ x ]) ] -> number x
    | Stiffness_, [ ("joint", Array _) ] -> not_covered [ "a stiffness for each joint" ]
    | _ -> raise Malformed in
  { about_; leg_ = optional count (find l "leg"); given_ = optional given (find l "given"); is_max; bound_ = number (get l "bound") }

let two f v = match array v with [ x; y ] -> (f x, f y) | _ -> raise Malformed

let subject v =
  match variant v with
  | "postulate", v -> Postulate_ (match get (members v) "psi_max" with String "all" -> None | v -> Some (quantity v))
  | "machine", v ->
    let l = members v in
    let require () = List.map requirement (array (get l "require")) in
    (match variant (get l "mechanism"), variant (get l "workspace") with
     | _ when find l "orientation" <> None || find l "bodies" <> None -> not_covered [ "a platform that turns, or one with bodies," ]
     | ("translational", legs), ("box", box) ->
       let box = members box in
       let region = Box_ (triple number (get box "min"), triple number (get box "max")) in
       Machine_ (List.map leg (array legs), region, require ())
     | ("translational", legs), ("cylinder", cylinder) ->
       let l = members cylinder in
       let x, y = two number (get l "center") and bottom, top = two number (get l "z") in
       Machine_ (List.map leg (array legs), Cylinder_ (x, y, number (get l "radius"), bottom, top), require ())
     | ("orthoglide", o), ("cube", cube) ->
       Closed_ (number (get (members o) "offset"), number (get (members cube) "side"), require ())
     | ("translational", _), (workspace, _) -> not_covered [ "the workspace \""; workspace; "\"" ]
     | (mechanism, _), _ -> not_covered [ "the mechanism \""; mechanism; "\"" ])
  | claim, _ -> not_covered [ "a claim of the kind \""; claim; "\"" ]

(* Proofs *)
let integers v = List.map integer (array v)
let face v = match string v with "Q1" -> Q1 | "Q2" -> Q2 | s -> raise Malformed
(* [n] legs: so many rows of three entries. *)
let rec evidence n v =
  let row length v = let l = integers v in if List.length l <> length then raise Malformed else l in
  let multiplier f v =
    let l = members v in
    let y = List.map (row 3) (array (get l "y")) in
    if List.length y <> n then raise Malformed else f y (places (get l "places")) in
  match v with
  | String name -> Plain name
  | Object [ ("corner", f) ] -> AtCorner (face f)
  | Object [ ("inside", Array [ e; k; p ]) ] -> Inside_ (evidence n e, integer k, places p)
  | Object [ ("conditioning", Array [ y; mu ]) ] -> multiplier (fun y places -> Conditioned_ (y, places, row 4 mu)) y
  | Object [ (("lower" | "lower_divided" | "rank") as name, y) ] -> multiplier (fun y places -> Multiplied (name, y, places)) y
  | Object [ (name, _) ] -> not_covered [ "the evidence \""; name; "\"" ]
  | _ -> raise Malformed
let step n v =
  match array v with
  | [ i; String "outside" ] when digits i <> "0" -> raise Malformed
  | [ i; e ] -> (count i, evidence n e)
  | _ -> raise Malformed
let node n v =
  let l = members v in
  if find l "fails" <> None then not_covered [ "a leaf that fails" ];
  { by_ = (match find l "by" with Some v -> List.map (step n) (array v) | None -> []); split_ = optional count (find l "split") }
let fails v =
  match variant v with
  | "reach", _ -> Reach
  | "obligation", Array [ i; vs ] -> Obligation (count i, List.map integers (array vs))
  | "row", Array [ i; leg ] -> Row (count i, count leg)
  | name, _ -> not_covered [ "the failure \""; name; "\"" ]
let proof n v =
  match variant v with
  | "tree", t ->
    let l = members t in
    Nodes (positive (get l "precision"), List.map (node n) (array (get l "nodes")))
  | "witness", w ->
    let l = members w in
    let machine = match find l "machine" with Some v -> List.map number (array v) | None -> [] in
    ByWitness (positive (get l "precision"), List.map number (array (get l "point")), machine, fails (get l "fails"))
  | name, _ -> not_covered [ "a proof of the kind \""; name; "\"" ]

let certificate text =
  let l = members (parse text) in
  (match string (get l "format") with
   | "orthocert/2" -> ()
   | format -> raise Malformed);
  let subject_ = subject (get l "claim") in
  let legs = match subject_ with Machine_ (legs, _, _) -> List.length legs | Closed_ _ | Postulate_ _ -> 3 in
  let proof_ = proof legs (get l "proof") in
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
  | { proof_ = Nodes _; _ } -> Certified
  | { proof_ = ByWitness _; _ } -> Refuted
