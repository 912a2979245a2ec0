(* orthocert_verify(text): "CERTIFIED", "REFUTED", "REJECTED" or "NOT COVERED: why". *)
let verdict text =
  match if Reader.is_paving text then Reader.Not_known "a paving is checked by orthocert-verified" else Reader.verdict text with
  | Certified -> "CERTIFIED"
  | Refuted -> "REFUTED"
  | Rejected -> "REJECTED"
  | Not_known why -> "NOT COVERED: " ^ why
  | exception _ -> "REJECTED"

let () =
  Js_of_ocaml.Js.export "orthocert_verify"
    (Js_of_ocaml.Js.wrap_callback (fun text -> Js_of_ocaml.Js.bytestring (verdict (Js_of_ocaml.Js.to_bytestring text))))
