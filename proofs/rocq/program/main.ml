(* orthocert-verified FILE..: exit codes as those of orthocert-check, and 3 for what is not covered. *)
let usage = "usage: orthocert-verified FILE..\n\
Checks certificates and pavings by the program extracted from the formal development, and prints a\n\
line for each: CERTIFIED, REFUTED, REJECTED, or NOT COVERED and why.\n\
Exit codes: 0 certified, 1 refuted, 2 a file cannot be read, 3 not covered,\n\
5 rejected; of several files the greatest.\n"

let verdict channel =
  let beginning = Bytes.create 64 in
  let n = input channel beginning 0 64 in
  seek_in channel 0;
  if Reader.is_paving (Bytes.sub_string beginning 0 n) then Paving.verdict (Paving.of_channel channel)
  else Reader.verdict (really_input_string channel (in_channel_length channel))

let check path =
  match
    let channel = open_in_bin path in
    Fun.protect ~finally:(fun () -> close_in channel) (fun () -> verdict channel)
  with
  | Certified -> print_endline "CERTIFIED"; 0
  | Refuted -> print_endline "REFUTED"; 1
  | Rejected -> print_endline "REJECTED"; 5
  | Not_known why -> print_endline ("NOT COVERED: " ^ why); 3
  | exception (Sys_error why | Failure why) -> prerr_endline ("error: " ^ why); 2
  | exception Stack_overflow -> print_endline "REJECTED"; 5

(* Of what a cell leaves behind little lives on, and memory is less dear than looking for it. *)
let () = Gc.set { (Gc.get ()) with minor_heap_size = 1 lsl 20; space_overhead = 400 }

let () =
  match Array.to_list Sys.argv with
  | _ :: [] -> prerr_string usage; exit 2
  | _ :: [ ("--help" | "-h") ] -> print_string usage
  | _ :: paths -> exit (List.fold_left (fun worst path -> max worst (check path)) 0 paths)
  | [] -> exit 2
