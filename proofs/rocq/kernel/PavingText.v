(** * Pavings as files: the text of a header and of a summary, and what they mean

    The nodes between both are evidence: whoever reads them is not trusted, as that a cover
    by cells with the shares of the summary is there does not rest on which bytes stood for it.  To know what has been
    proved, read [print_header], [print_summary] and [means_paving], with the definitions that
    these are made of. *)

From Coq Require Import ZArith Reals Lra Lia List Bool String.
From Orthocert Require Import Claim.
From Orthocert.kernel Require Import Inputs.
From Orthocert.kernel Require Import Statement Problem Witness Paving Certificate.
Import ListNotations.
Local Open Scope string_scope.
Local Open Scope list_scope.
Local Notation length := List.length.

(** The machine and the box, the coordinates that are paved, x, y and z as 0, 1 and 2, where not all are, and how nodes are shown. *)
Record header := Header {
  legs_ : list written_leg; min_ : triple expression; max_ : triple expression; require_ : list written_requirement;
  coordinates_ : option (list nat); precision_ : positive; depth_ : N; symmetry_ : bool; tool_ : string; version_ : string }.

Definition coordinate_text (k : nat) : text := quoted match k with O => "x" | 1%nat => "y" | _ => "z" end.
Definition print_header (h : header) : text :=
  object ([field "format" (quoted "orthocert-paving/3"); field "claim" (variant "machine" (machine_text (legs_ h) (Box_ (min_ h) (max_ h)) [] (require_ h)))] ++
    match coordinates_ h with Some l => [field "coordinates" (array (map coordinate_text l))] | None => [] end ++
    [field "precision" (positive_text (precision_ h)); field "depth" (places_text (depth_ h))] ++
    (if symmetry_ h then [field "symmetry" (quoted "permutations")] else []) ++
    [field "provenance" (object [field "tool" (quoted (tool_ h)); field "version" (quoted (version_ h))])]).

(** A share of the box's volume, as a fraction; how many nodes there are of each kind. *)
Record summary := Summary { splits_ : N; inners_ : N; outers_ : N; boundaries_ : N; mirrored_ : N; inner_part : N * positive; boundary_part : N * positive }.
Definition fraction_text (q : N * positive) : text :=
  ("""" :: places_text (fst q) ++ (if (snd q =? 1)%positive then [] else "/" :: positive_text (snd q)) ++ [""""]).
Definition print_summary (s : summary) : text :=
  object [field "splits" (places_text (splits_ s)); field "inner" (places_text (inners_ s)); field "outer" (places_text (outers_ s));
    field "boundary" (places_text (boundaries_ s)); field "mirrored" (places_text (mirrored_ s));
    field "inner_share" (fraction_text (inner_part s)); field "boundary_share" (fraction_text (boundary_part s))].

Definition claim_in_header (h : header) : claim := claim_of (legs_ h) (Box_ (min_ h) (max_ h)) [] (require_ h).
Definition edges_of (h : header) : tolerances := hull (workspace (claim_in_header h)).
Definition paved_of (h : header) : list nat := match coordinates_ h with Some l => l | None => [0; 1; 2]%nat end.

Local Open Scope R_scope.

Definition has_share (q : N * positive) (n : Z) : Prop := IZR n / IZR (2 ^ share_places) = IZR (Z.of_N (fst q)) / IZR (Zpos (snd q)).

(** The claim is about something, and there are cells that pave its box and have these shares. *)
Definition means_paving (h : header) (s : summary) : Prop :=
  (exists m P, is_about (claim_in_header h) m P) /\
  exists inner outer rest, is_paving (claim_in_header h) (edges_of h) (paved_of h) (symmetry_ h) inner outer rest /\
    has_share (inner_part s) (weights (symmetry_ h) inner) /\ has_share (boundary_part s) (weights (symmetry_ h) rest).

Local Close Scope R_scope.

(** ** What is accepted *)

Fixpoint are_different (l : list nat) : bool := match l with [] => true | k :: l' => negb (existsb (Nat.eqb k) l') && are_different l' end.
Definition is_plain_header (h : header) : bool :=
  is_plain (tool_ h) && is_plain (version_ h) && is_precision (precision_ h) && (depth_ h <=? 120)%N &&
  are_written [] (in_subject (Machine_ (legs_ h) (Box_ (min_ h) (max_ h)) [] (require_ h))) &&
  match coordinates_ h with Some l => forallb (fun k => Nat.ltb k 3) l && are_different l && Nat.leb 1 (length l) | None => true end &&
  match coordinates_ h with Some _ => negb (symmetry_ h) | None => true end.
(** Most obligations. *)
Definition most_obligations : nat := 128.

Definition board_for (h : header) : option board :=
  let c := claim_in_header h in
  if is_well_formed (legs_ h) [] (require_ h) c && Nat.leb (length (require c)) most_obligations then
    board_of exact_bits (precision_ h) c (edges_of h) (length_order (legs c)) (map direction_order (legs c)) (paved_of h) (depth_ h) (symmetry_ h)
  else None.
(** A first line, and what was read from it. *)
Definition open_paving (line : string) (h : header) : option board :=
  if String.eqb (String.concat "" (print_header h)) line && is_plain_header h then board_for h else None.

Definition is_share_of (q : N * positive) (n : Z) : bool := (n * Zpos (snd q) =? Z.of_N (fst q) * 2 ^ share_places)%Z.
(** A last line, and what was read from it. *)
Definition close_paving (st : state) (line : string) (s : summary) : bool :=
  match to_read st with [] => true | _ => false end && String.eqb (String.concat "" (print_summary s)) line &&
  let t := tally_ st in
  (splits t =? Z.of_N (splits_ s))%Z && (inners t =? Z.of_N (inners_ s))%Z && (outers t =? Z.of_N (outers_ s))%Z && (boundaries t =? Z.of_N (boundaries_ s))%Z &&
  (mirrored t =? Z.of_N (mirrored_ s))%Z && (inner_share t + outer_share t + boundary_share t =? 2 ^ share_places)%Z && is_share_of (inner_part s) (inner_share t) && is_share_of (boundary_part s) (boundary_share t).

Lemma is_share_of_sound : forall q n, is_share_of q n = true -> has_share q n.
Proof.
  intros q n h. apply Z.eqb_eq in h. apply (f_equal IZR) in h. rewrite !mult_IZR in h. unfold has_share.
  assert (0 < IZR (2 ^ share_places))%R by (apply IZR_lt; reflexivity). assert (0 < IZR (Zpos (snd q)))%R by (apply IZR_lt; reflexivity).
  apply Rmult_eq_reg_r with (IZR (2 ^ share_places) * IZR (Zpos (snd q)))%R; [| apply Rgt_not_eq, Rmult_lt_0_compat; assumption].
  field_simplify; lra.
Qed.

Theorem verify_paving_sound : forall first h b find items st last s, open_paving first h = Some b ->
  after (precision_ h) b find (start_paving b) items = Some st -> close_paving st last s = true ->
  first = String.concat "" (print_header h) /\ last = String.concat "" (print_summary s) /\ is_plain_header h = true /\ means_paving h s.
Proof.
  intros first h b find items st last s o r k. unfold open_paving in o. destruct (_ && _) eqn:e in o; [| discriminate]. apply andb_true_iff in e as [e1 e2].
  apply String.eqb_eq in e1. unfold close_paving in k. cbv zeta in k. repeat (apply andb_true_iff in k as [k ?]). 
  repeat match goal with h : _ && _ = true |- _ => apply andb_true_iff in h as [? h] end.
  destruct (to_read st) as [| w l] eqn:er; [| discriminate]. match goal with h : (_ =? last)%string = true |- _ => apply String.eqb_eq in h; rename h into e3 end.
  split; [symmetry; exact e1 |]. split; [symmetry; exact e3 |]. split; [exact e2 |]. unfold board_for in o. destruct (_ && _) in o; [| discriminate].
  assert (total : (inner_share (tally_ st) + outer_share (tally_ st) + boundary_share (tally_ st) = 2 ^ share_places)%Z) by (apply Z.eqb_eq; assumption).
  destruct (paving_sound exact_bits (precision_ h) (claim_in_header h) (edges_of h) _ _ _ _ _ b find eq_refl o items st r er total) as [i [x [y [P [E1 E2]]]]]. split.
  - apply (inhabited exact_bits). exact (is_about_something _ _ _ _ _ _ _ _ _ (board_is _ _ _ _ _ _ _ _ _ _ o)).
  - exists i, x, y. split; [exact P |]. rewrite E1, E2. split; apply is_share_of_sound; assumption.
Qed.
