(* orthocert-verified CERT.json..: exit codes as those of orthocert-check, and 3 for what is not covered. *)
let usage = "usage: orthocert-verified CERT.json..\n\
Checks certificates by the program extracted from the formal development, and prints a\n\
line for each: CERTIFIED, REFUTED, REJECTED, or NOT COVERED and why.\n\
Exit codes: 0 certified, 1 refuted, 2 a file cannot be read, 3 not covered,\n\
5 rejected; of several files the greatest.\n"

let read path =
  let channel = open_in_bin path in
  Fun.protect ~finally:(fun () -> close_in channel) (fun () -> really_input_string channel (in_channel_length channel))

let check path =
  match Reader.verdict (read path) with
  | Certified -> print_endline "CERTIFIED"; 0
  | Refuted -> print_endline "REFUTED"; 1
  | Rejected -> print_endline "REJECTED"; 5
  | Not_known why -> print_endline ("NOT COVERED: " ^ why); 3
  | exception (Sys_error why | Failure why) -> prerr_endline ("error: " ^ why); 2
  | exception Stack_overflow -> print_endline "REJECTED"; 5

let () =
  match Array.to_list Sys.argv with
  | _ :: [] -> prerr_string usage; exit 2
  | _ :: [ ("--help" | "-h") ] -> print_string usage
  | _ :: paths -> exit (List.fold_left (fun worst path -> max worst (check path)) 0 paths)
  | [] -> exit 2
