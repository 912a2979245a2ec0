(** * Evidence that is not given in a paving: what proofs/kernel/src/step/own.rs finds

    Nothing rests on it: any matrix is admissible, and any direction ([Paving.read_node] is
    sound with every [finder]). *)

From Coq Require Import ZArith List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Arithmetic Slope Test Check Paving.
From Orthocert.kernel Require Configuration.
Import ListNotations.
Local Open Scope Z_scope.
Local Notation length := Datatypes.length.

Section Own.
Variable bits : positive.
Variable b : board.

(** 2^places times the middle. *)
Definition rounded (a : fixed) (places : Z) : Z := Z.shiftr (Z.shiftr (lo a + hi a) 1) (Zpos bits - places).

Section Values.
Variable values : list (option slope).
Definition centre (i : nat) : option fixed := option_map at_c (nth i values None).
Definition positive_centre (i : nat) : option fixed := match centre i with Some d => if 0 <? lo d then Some d else None | None => None end.

(** A_i/D_i, and A_i. *)
Definition multiplier_places : N := 20.
Definition of_row (r : list nat * nat) : option (list Z) :=
  match positive_centre (snd r) with
  | Some d => all_some (map (fun i => option_map (fun a => rounded (ratio a (Fixed.integer bits 1) d) (Z.of_N multiplier_places)) (centre i)) (fst r))
  | None => None
  end.
Definition of_rows (of : list nat * nat -> option (list Z)) (r : rows nat) : list (list Z) := match all_some (map of r) with Some y => y | None => [] end.

(** ** Along which M at the centre stretches most, or least: a column of a high power of M^T M, or of its adjugate *)

Definition square : Type := list (list Z).
Definition at2 (g : square) (i j : nat) : Z := nth j (nth i g []) 0.
Definition made (f : nat -> nat -> Z) : square := map (fun i => map (f i) [0; 1; 2]%nat) [0; 1; 2]%nat.
Definition next (k by_ : nat) : nat := Nat.modulo (k + by_) 3.
Definition adjugate (g : square) : square := made (fun i j => let a := next j 1 in let b := next j 2 in let c := next i 1 in let d := next i 2 in
  at2 g a c * at2 g b d - at2 g a d * at2 g b c).
Definition bits_of_entries : Z := 28.
Definition sized (g : square) : option square :=
  let most := fold_right (fun x m => Z.max (Z.abs x) m) 0 (concat g) in
  if 0 <? most then let own := Z.log2 most + 1 in
    Some (map (map (fun x => if bits_of_entries <? own then Z.shiftr x (own - bits_of_entries) else Z.shiftl x (bits_of_entries - own))) g) else None.
Fixpoint power (n : nat) (g : square) : option square :=
  match sized g, n with
  | Some g, S n => power n (made (fun i j => at2 g i 0 * at2 g 0 j + at2 g i 1 * at2 g 1 j + at2 g i 2 * at2 g 2 j))
  | g, _ => g
  end.
Definition direction_places : Z := 20.
Definition dominant (g : square) : option (list Z) :=
  match power 7 g with
  | Some g => let longer i j := if at2 g j j <? at2 g i i then i else j in
      let k := longer (longer 0 1)%nat 2%nat in
      Some (map (fun i => Z.shiftr (at2 g i k + Z.shiftl 1 (direction_places - 1)) direction_places) [0; 1; 2]%nat)
  | None => None
  end.

Definition entry_of (r : rows nat) (j k : nat) : option fixed :=
  fold_left (fun sum row => match sum, positive_centre (snd row), centre (nth j (fst row) 0%nat), centre (nth k (fst row) 0%nat) with
    | Some s, Some d, Some x, Some y => Some (add s (ratio x y d))
    | _, _, _, _ => None
    end) r (Some zero).
Definition direction (greatest : bool) (r : rows nat) : option (list Z) :=
  match all_some (map (fun p => entry_of r (fst p) (snd p)) [(0, 0); (0, 1); (0, 2); (1, 1); (1, 2); (2, 2)]%nat) with
  | Some [a; b; c; d; e; f] =>
      let trace := add (add a d) f in
      match recip bits (Fixed (hi trace) (hi trace)) with
      | Some unit =>
          let x a := rounded (mul bits a unit) bits_of_entries in
          let g := [[x a; x b; x c]; [x b; x d; x e]; [x c; x e; x f]] in
          dominant (if greatest then g else adjugate g)
      | None => None
      end
  | _ => None
  end.
End Values.

Definition own : finder := Finder
  (fun values i =>
    match nth_error (its_tests b) i with
    | Some (SigmaMin k) => let y := of_rows (of_row values) (its_whole b) in
        if (lo k =? 0) && (hi k =? 0) then ByRank multiplier_places y else ByLower multiplier_places y
    | Some (Least r _) => ByLower multiplier_places (of_rows (of_row values) r)
    | Some (Either f _) => match nth f values None with Some s => if 0 <=? lo (range s) then ByTest else ByNegative | None => ByTest end
    | _ => ByTest
    end)
  (fun values i =>
    let along l := match all_some l with Some vs => [Configuration.NFails i vs] | None => [] end in
    match nth_error (its_tests b) i with
    | Some (SigmaMin _) => along [direction values false (its_whole b)]
    | Some (SigmaMax _) => along [direction values true (its_whole b)] ++ map (Configuration.NFailsAlong i) (seq 0 (length (its_whole b)))
    | Some (Conditioning _) => along [direction values true (its_whole b); direction values false (its_whole b)]
    | Some (Least r _) => along [direction values false r]
    | Some (AtLeast _ | Either _ _) => [Configuration.NFails i []]
    | _ => []
    end).
End Own.
