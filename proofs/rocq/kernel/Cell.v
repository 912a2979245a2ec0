(** * Boxes of the bisection tree

    A cell is, for each coordinate, a range with ends in multiples of
    2^-bits.  Coordinate k of its points is c_k + lambda_k h_k. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope.
Import ListNotations.
Local Open Scope R_scope.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation unit := (unit_R bits).

(** ** Centre and half-width: h = hi - floor((lo + hi)/2) *)

Definition midpoint (a : fixed) : Z := Z.shiftr (lo a + hi a) 1.
Definition half (a : fixed) : Z := hi a - midpoint a.
Definition centre_of (a : fixed) : R := IZR (midpoint a) / unit.

Lemma half_sound : forall a x, contains a x ->
  exists t, -1 <= t <= 1 /\ x - centre_of a = IZR (half a) / unit * t.
Proof.
  intros a x [l h]. unfold centre_of, half. pose proof (unit_R_pos bits) as p.
  assert (m : (2 * midpoint a <= lo a + hi a < 2 * midpoint a + 2)%Z).
  { unfold midpoint. rewrite Z.shiftr_div_pow2 by lia. change (2 ^ 1)%Z with 2%Z.
    pose proof (Z.div_mod (lo a + hi a) 2 ltac:(lia)). pose proof (Z.mod_pos_bound (lo a + hi a) 2 ltac:(lia)). lia. }
  set (c := midpoint a) in *. assert (le : (lo a <= hi a)%Z) by (apply le_IZR; lra).
  set (y := x * unit - IZR c). assert (E : x - IZR c / unit = y / unit) by (unfold y; field; lra).
  assert (b : - IZR (hi a - c) <= y <= IZR (hi a - c)).
  { assert (g : (- (hi a - c) <= lo a - c)%Z) by lia. apply IZR_le in g.
    rewrite opp_IZR, !minus_IZR in *. unfold y. lra. }
  destruct (Z.eq_dec (hi a - c) 0) as [z | n].
  - exists 0. rewrite z in *. split; [lra |]. rewrite E. replace y with 0 by lra. field. lra.
  - assert (h0 : 0 < IZR (hi a - c)) by (apply IZR_lt; lia). exists (y / IZR (hi a - c)).
    assert (F : y / IZR (hi a - c) * IZR (hi a - c) = y) by (field; lra).
    split; [split; apply Rmult_le_reg_r with (IZR (hi a - c)); lra |]. rewrite E. field. lra.
Qed.

(** Coordinate j + k of the cell: its own slope, in place j + k. *)
Fixpoint coords_from (j : nat) (cell : list fixed) : list slope :=
  match cell with
  | [] => []
  | a :: rest =>
      Slope (Fixed (midpoint a) (midpoint a)) a (repeat zero j ++ [Fixed (half a) (half a)])
        :: coords_from (S j) rest
  end.

Lemma dot_unit : forall j h l, dot (repeat 0 j ++ [h]) l = h * nth j l 0.
Proof. induction j as [| j IH]; intros h [| t l]; cbn; rewrite ?IH; ring. Qed.

Let none := constant zero.

Lemma none_holds : forall l, holds bits l none 0 0.
Proof. intro l. apply constant_holds, zero_sound. Qed.

Lemma params_hold : forall l p th, Forall2 contains p th ->
  forall j, holds bits l (nth j (map constant p) none) (nth j th 0) (nth j th 0).
Proof.
  induction 1 as [| a y p th h hs IH]; intros [| j]; cbn [map nth]; try apply none_holds.
  - apply constant_holds; exact h.
  - apply IH.
Qed.

Lemma exact_in : forall n, contains (Fixed n n) (IZR n / unit).
Proof. exact (point_sound bits). Qed.

Lemma coords_from_hold : forall cell x, Forall2 contains cell x ->
  exists lambda, length lambda = length cell /\ Forall (fun t => -1 <= t <= 1) lambda /\
    Forall2 (fun a p => snd p - centre_of a = IZR (half a) / unit * fst p) cell (combine lambda x) /\
    forall before k, holds bits (before ++ lambda) (nth k (coords_from (length before) cell) none)
      (nth k (map centre_of cell) 0) (nth k x 0).
Proof.
  induction 1 as [| a y cell x h hs IH].
  - exists []. split; [reflexivity |]. split; [constructor |]. split; [constructor |]. intros before [| k]; cbn; apply none_holds.
  - destruct IH as [l [e [hl [hd IH]]]]. destruct (half_sound a y h) as [t [ht E]]. exists (t :: l).
    split; [cbn; congruence |]. split; [constructor; assumption |]. split; [constructor; [exact E | exact hd] |].
    intros before [| k]; cbn [coords_from map nth].
    + split; [apply exact_in |]. split; [exact h |].
      exists (repeat 0 (length before) ++ [IZR (half a) / unit]). split.
      * apply Forall2_app; [clear; induction (length before); cbn; constructor; auto using zero_sound | constructor; [apply exact_in | constructor]].
      * rewrite dot_unit, nth_middle. exact E.
    + specialize (IH (before ++ [t]) k). rewrite app_length, <- app_assoc in IH.
      rewrite Nat.add_1_r in IH. exact IH.
Qed.

(** ** Both halves along coordinate k: together they are the cell *)

Fixpoint halves (k : nat) (cell : list fixed) : list fixed * list fixed :=
  match cell, k with
  | a :: c, O => (Fixed (lo a) (midpoint a) :: c, Fixed (midpoint a) (hi a) :: c)
  | a :: c, S j => let (l, u) := halves j c in (a :: l, a :: u)
  | [], _ => ([], [])
  end.

Lemma halves_sound : forall k cell x, Forall2 contains cell x ->
  Forall2 contains (fst (halves k cell)) x \/ Forall2 contains (snd (halves k cell)) x.
Proof.
  intros k cell x h. revert k. induction h as [| a y cell x h hs IH]; intros [| k]; cbn [halves].
  1-2: left; constructor.
  - destruct h as [l u]. destruct (Rle_lt_dec (y * unit) (IZR (midpoint a))); [left | right];
      constructor; try exact hs; split; cbn [lo hi]; lra.
  - specialize (IH k). destruct (halves k cell) as [p q]. cbn [fst snd] in *.
    destruct IH as [IH | IH]; [left | right]; constructor; assumption.
Qed.

Lemma halves_length : forall k cell, length (fst (halves k cell)) = length cell /\ length (snd (halves k cell)) = length cell.
Proof.
  intros k cell. revert k. induction cell as [| a c IH]; intros [| j]; cbn [halves]; auto. specialize (IH j).
  destruct (halves j c). cbn in *. lia.
Qed.
End Precision.
