(* orthocert_verify(text): "CERTIFIED", "REFUTED", "REJECTED" or "NOT COVERED: why". *)
let verdict text =
  match if Reader.is_paving text then Reader.Not_known "a paving is checked by orthocert-verified" else Reader.verdict text with
  | Certified -> "CERTIFIED"
  | Refuted -> "REFUTED"
  | Rejected -> "REJECTED"
  | Not_known why -> "NOT COVERED: " ^ why
  | exception _ -> "REJECTED"

(* Not by the library Js_of_ocaml, which brings printers of formats and exceptions along. *)
external export : (string -> string) -> unit = "oc_export"

let () = export verdict
