(* From a file to a header, nodes and a summary of verified paving code, one node after the other. Nothing
   here is trusted: first and last line are printed again by verified code, and nodes are evidence. *)
open Verified
open Reader

let whole v = Z.to_N (natural (digits v))

(* What is read: its bytes, and the end of the file as [None]. *)
type source = { byte : unit -> char option }
let of_channel channel = { byte = fun () -> match input_char channel with c -> Some c | exception End_of_file -> None }

let next source = match source.byte () with Some c -> Char.code c | None -> raise Malformed
let most_line = 1 lsl 20
let line source =
  let buffer = Buffer.create 4096 in
  let rec go () = match source.byte () with
    | Some '\n' -> Buffer.contents buffer
    | Some c when Buffer.length buffer + 1 < most_line -> Buffer.add_char buffer c; go ()
    | _ -> raise Malformed in
  go ()

let rec nat n : nat = if n <= 0 then O else S (nat (n - 1))
let coordinate v : nat = match string v with "x" -> O | "y" -> nat 1 | "z" -> nat 2 | _ -> raise Malformed

let header line =
  let l = members (parse line) in
  (match string (get l "format") with "orthocert-paving/3" -> () | _ -> raise Malformed);
  let l' = match get l "claim" with Object [ ("machine", v) ] -> members v | _ -> raise Malformed in
  if find l' "orientation" <> None then not_covered [ "a paving of a platform that turns" ];
  match subject (get l "claim") with
  | Machine_ (legs_, Box_ (min_, max_), [], require_) ->
    if has_each require_ then not_covered [ "a stiffness for each joint in a paving" ];
    List.iter (fun r -> match r.about_ with
      | Transmission | JointRange | Speed_ | Condition_ | Serial_ | Parallel_ | Stiffness_ | Constraint_ -> ()
      | OneToOne_ -> raise Malformed
      | _ -> not_covered [ "this quantity in a paving" ]) require_;
    let p = members (get l "provenance") in
    { legs_; min_; max_; require_; coordinates_ = optional (fun v -> List.map coordinate (array v)) (find l "coordinates");
      precision_ = positive (get l "precision"); depth_ = whole (get l "depth");
      symmetry_ = (match find l "symmetry" with None -> false | Some v -> if string v = "permutations" then true else raise Malformed);
      tool_ = string (get p "tool"); version_ = string (get p "version") }
  | Machine_ (_, Box_ _, _, _) -> not_covered [ "a paving of a machine with bodies" ]
  | Machine_ _ -> not_covered [ "a paving of a cylinder" ]
  | _ -> not_covered [ "a paving of such a mechanism" ]

let summary line =
  let l = members (parse line) in
  let fraction key =
    match String.split_on_char '/' (string (get l key)) with
    | [ n ] -> (Z.to_N (natural n), Z.to_pos (natural "1"))
    | [ n; d ] ->
      (* In lowest terms: an odd numerator over a power of two. *)
      if n = "" || (Char.code n.[String.length n - 1]) land 1 = 0 || d = "1" then raise Malformed;
      (Z.to_N (natural n), Z.to_pos (natural d))
    | _ -> raise Malformed in
  let count key = whole (get l key) in
  { splits_ = count "splits"; inners_ = count "inner"; outers_ = count "outer"; boundaries_ = count "boundary";
    mirrored_ = count "mirrored"; inner_part = fraction "inner_share"; boundary_part = fraction "boundary_share" }

(* Nodes: section 18 of FORMAT.md *)
let most = 16
let count source = let n = next source in if n > most then raise Malformed else n
let big n = Big_int_Z.big_int_of_int n
(* Seven bits a byte, as few bytes as there can be, of 64 bits; then 2 n, or -2 n - 1. *)
let integer source =
  let rec go n shift =
    let byte = next source in
    let part = byte land 0x7f in
    if shift > 63 || (shift = 63 && part > 1) || (byte = 0 && shift > 0) then raise Malformed;
    let n = Big_int_Z.add_big_int n (Big_int_Z.shift_left_big_int (big part) shift) in
    if byte >= 0x80 then go n (shift + 7)
    else
      let half = Big_int_Z.shift_right_big_int n 1 in
      if Big_int_Z.sign_big_int (Big_int_Z.mod_big_int n (big 2)) = 0 then half else Big_int_Z.minus_big_int (Big_int_Z.succ_big_int half) in
  go (big 0) 0
let list source item = List.init (count source) (fun _ -> item source)
let integers source = list source integer
let matrix source = let places = next source in (big places, list source integers)
let rec evidence least source =
  let small l = match l with
    | [ n; p ] when Big_int_Z.sign_big_int p >= 0 && Big_int_Z.le_big_int p (big 255) -> (n, p)
    | _ -> raise Malformed in
  match next source with
  | (9 | 10 | 11) as tag when tag >= least ->
    let numbers = integers source in
    let of_ = evidence (tag + 1) source in
    (match tag with
     | 9 -> if numbers = [] then AtControls of_ else raise Malformed
     | 10 -> let n, p = small numbers in Turned (of_, n, p)
     | _ -> let n, p = small numbers in Inside (of_, n, p))
  | 0 -> ByTest
  | 1 -> ByDivided
  | 8 -> ByNegative
  | 2 -> let p, y = matrix source in ByLower (p, y)
  | 3 -> let p, y = matrix source in ByLowerDivided (p, y)
  | 4 -> let p, y = matrix source in ByRank (p, y)
  | 7 -> let p, y = matrix source in ByDirection (p, y)
  | 5 -> let p, y = matrix source in let mu = integers source in ByConditioning (p, y, mu)
  | 6 ->
    let p, y = matrix source in
    (match integers source with
     | [ kappa ] -> ByAccuracy (p, y, kappa, big 0)
     | [ _; q ] when Big_int_Z.sign_big_int q > 0 && Big_int_Z.le_big_int q (big 255) -> ByTest
     | _ -> raise Malformed)
  | _ -> raise Malformed
(* Matrices are of the machine's rows, by places that are admissible. *)
let is_shaped legs e =
  let is_of (p, y) = List.length y = legs && List.for_all (fun r -> List.length r = 3) y && Big_int_Z.lt_big_int p (big 64) in
  match e with
  | ByLower (p, y) | ByLowerDivided (p, y) | ByRank (p, y) -> is_of (p, y)
  | ByConditioning (p, y, mu) -> is_of (p, y) && List.length mu = 4
  | _ -> true

let plain = function
  | 0 -> Inner
  | 1 -> Boundary
  | 2 -> Mirrored
  | n -> Outer (None, ByOwn (nat (n - 3)))
(* The nodes that a byte begins, in order: one, or a split with its halves. *)
let nodes legs paved source =
  let axis k = match List.nth_opt paved k with Some k -> Halve k | None -> raise Malformed in
  let rec go steps at =
    if List.length steps > 128 then raise Malformed;
    let one kind = [ { steps_ = List.rev steps; kind_ = (match at, kind with
      | None, kind -> kind
      | Some at, Outer (None, by_) -> Outer (Some at, by_)
      | _ -> raise Malformed) } ] in
    let given f = one (Outer (None, ByGiven f)) in
    match next source with
    | code when code >= 0x10 && code < 0x20 -> go ((nat (code - 0x10), None) :: steps) at
    | 9 ->
      let o = next source in
      let e = evidence 0 source in
      go ((nat o, Some (if is_shaped legs e then e else AtControls e)) :: steps) at
    | 0x0a when at = None -> go steps (Some (integers source))
    | 0x0b -> raise Malformed
    | 0x0c -> not_covered [ "a cell that is cut" ]
    | code when code >= 0x20 && code < 0x25 -> one (InParts (nat (code - 0x20)))
    | code when code < 3 -> one (axis code)
    | 3 -> one Inner
    | 4 -> one Boundary
    | 5 -> one Mirrored
    | 6 -> given NOutOfReach
    | 7 -> let o = next source in let leg = next source in given (NFailsAlong (nat o, nat leg))
    | 8 -> let o = next source in let vs = list source integers in given (NFails (nat o, vs))
    | code when code >= 0x40 && code < 0x80 -> one (Outer (None, ByOwn (nat (code - 0x40))))
    | code when code >= 0x80 && code < 0x80 + 75 ->
      let n = code - 0x80 in
      let half n = { steps_ = []; kind_ = plain n } in
      one (axis (n / 25)) @ [ half (n / 5 mod 5); half (n mod 5) ]
    | _ -> raise Malformed in
  go [] None

(* Calls of verified code decide: [open_paving], [read_node] and [close_paving]. *)
let verdict source =
  let read () =
    let first = line source in
    let h = header first in
    match open_paving first h with
    | None -> Rejected
    | Some b ->
      let found = own h.precision_ b in
      let legs = List.length h.legs_ in
      let rec go state =
        if state.to_read = [] then
          let last = line source in
          if source.byte () = None && close_paving state last (summary last) then Certified else Rejected
        else
          let rec each state = function
            | [] -> Some state
            | item :: rest -> (match read_node h.precision_ b found state item with Some state -> each state rest | None -> None) in
          match each state (nodes legs b.its_paved source) with Some state -> go state | None -> Rejected in
      go (start_paving b) in
  match read () with
  | exception Not_covered why -> Not_known why
  | exception Malformed -> Rejected
  | v -> v
