(** * Formulas, and tapes that share their parts

    A formula is an operation on formulas.  A tape is a list of operations on
    earlier entries.  [run] evaluates a tape in any number type; in the free
    one it gives the formulas the tape stands for.

    The functions [plus], [times] and so on build the formulas that
    formula.rs builds: sums with 0, products with 1, and the like are not
    written down.  A tape is evidence: that it stands for the formulas of a
    machine is found by comparing ([same]). *)

From Coq Require Import ZArith Reals Lra List Bool.
From Orthocert.kernel Require Import Elbow.
Import ListNotations.
Local Open Scope R_scope.

(** One operation on arguments of type [A]. *)
Inductive op (A : Type) :=
  | Coord (k : nat) | Param (j : nat) | Integer (n : Z)
  | Add (a b : A) | Sub (a b : A) | Neg (a : A) | Mul (a b : A) | Div (a b : A) | Sqr (a : A) | Sqrt (a : A)
  | Elbow (second : bool) (a b t : A).
Arguments Coord {A}. Arguments Param {A}. Arguments Integer {A}. Arguments Add {A}. Arguments Sub {A}.
Arguments Neg {A}. Arguments Mul {A}. Arguments Div {A}. Arguments Sqr {A}. Arguments Sqrt {A}. Arguments Elbow {A}.

Definition map_op {A B : Type} (f : A -> B) (o : op A) : op B :=
  match o with
  | Coord k => Coord k | Param j => Param j | Integer n => Integer n
  | Add a b => Add (f a) (f b) | Sub a b => Sub (f a) (f b) | Neg a => Neg (f a)
  | Mul a b => Mul (f a) (f b) | Div a b => Div (f a) (f b) | Sqr a => Sqr (f a) | Sqrt a => Sqrt (f a)
  | Elbow s a b t => Elbow s (f a) (f b) (f t)
  end.

Inductive formula := F (o : op formula).

(** ** Meaning: a total function, and where it may be trusted *)

Section Point.
Variables x theta : list R.

Definition real_op (o : op R) : R :=
  match o with
  | Coord k => nth k x 0 | Param j => nth j theta 0 | Integer n => IZR n
  | Add a b => a + b | Sub a b => a - b | Neg a => - a
  | Mul a b => a * b | Div a b => a / b | Sqr a => a ^ 2 | Sqrt a => sqrt a
  | Elbow s a b t => (if s then snd else fst) (elbow a b t)
  end.

Fixpoint value (e : formula) : R := match e with F o => real_op (map_op value o) end.

(** Divisors are not 0 and radicands are positive, all the way down. *)
Definition defined_op (o : op R) : Prop := match o with Div _ b => b <> 0 | Sqrt a => 0 < a | Elbow _ a b t => 0 < elbow_radicand a b t | _ => True end.

Definition all_op (o : op Prop) : Prop :=
  match o with
  | Coord _ | Param _ | Integer _ => True
  | Add a b | Sub a b | Mul a b | Div a b => a /\ b
  | Sqr a | Sqrt a | Neg a => a
  | Elbow _ a b t => a /\ b /\ t
  end.

Fixpoint defined (e : formula) : Prop :=
  match e with F o => defined_op (map_op value o) /\ all_op (map_op defined o) end.
End Point.

(** ** Equal formulas *)

Fixpoint same (e f : formula) {struct e} : bool :=
  match e, f with
  | F o, F o' =>
      match o, o' with
      | Coord k, Coord k' | Param k, Param k' => Nat.eqb k k'
      | Integer n, Integer n' => Z.eqb n n'
      | Add a b, Add a' b' | Sub a b, Sub a' b' | Mul a b, Mul a' b' | Div a b, Div a' b' => same a a' && same b b'
      | Neg a, Neg a' | Sqr a, Sqr a' | Sqrt a, Sqrt a' => same a a'
      | Elbow s a b t, Elbow s' a' b' t' => Bool.eqb s s' && (same a a' && (same b b' && same t t'))
      | _, _ => false
      end
  end.

Fixpoint same_sound (e f : formula) {struct e} : same e f = true -> e = f.
Proof.
  destruct e as [o], f as [o']. destruct o, o'; cbn [same]; intro h; try discriminate;
    try (apply andb_true_iff in h as [h h']; apply same_sound in h, h'; congruence);
    try (apply same_sound in h; congruence).
  1-2: apply Nat.eqb_eq in h; congruence.
  - apply Z.eqb_eq in h; congruence.
  - repeat (apply andb_true_iff in h as [? h]). apply Bool.eqb_prop in H. apply same_sound in H0, H1, h. congruence.
Qed.

(** ** Building, as formula.rs does *)

Definition integer_of (e : formula) : option Z := match e with F (Integer n) => Some n | _ => None end.
Definition is (n : Z) (e : formula) : bool := match integer_of e with Some m => Z.eqb n m | None => false end.
Definition is_small (n : Z) : bool := Z.ltb (Z.abs n) 32768.

Definition integer (n : Z) : formula := F (Integer n).
Definition plus (a b : formula) : formula :=
  if is 0 a then b else if is 0 b then a else
  match integer_of a, integer_of b with
  | Some n, Some m => if is_small n && is_small m then integer (n + m) else F (Add a b)
  | _, _ => F (Add a b)
  end.
Definition opposite (a : formula) : formula :=
  match a with
  | F (Integer n) => if is_small n then integer (- n) else F (Neg a)
  | F (Neg b) => b
  | _ => F (Neg a)
  end.
Definition minus (a b : formula) : formula :=
  if is 0 b then a else if is 0 a then opposite b else
  match a, b with
  | F (Coord j), F (Coord k) => if Nat.eqb j k then integer 0 else F (Sub a b)
  | _, _ => F (Sub a b)
  end.
Definition square (a : formula) : formula :=
  match integer_of a with Some n => if is_small n then integer (n * n) else F (Sqr a) | None => F (Sqr a) end.
Definition times (a b : formula) : formula :=
  if is 0 a || is 1 b then a else if is 0 b || is 1 a then b else if same a b then square a else F (Mul a b).
Definition over (a b : formula) : formula := if is 1 b then a else F (Div a b).
Definition root (a : formula) : formula := if is 1 a then a else F (Sqrt a).
Definition elbow_of (second : bool) (a b t : formula) : formula := F (Elbow second a b t).

Section Values.
Variables x theta : list R.
Local Notation value := (value x theta).
Local Notation defined := (defined x theta).

Lemma is_value : forall n e, is n e = true -> value e = IZR n.
Proof.
  intros n [o] h. destruct o; try discriminate. unfold is in h. cbn in h. apply Z.eqb_eq in h. subst. reflexivity.
Qed.

Lemma integer_of_value : forall e n, integer_of e = Some n -> value e = IZR n.
Proof. intros [o] n h. destruct o; try discriminate. cbn in h. injection h as ->. reflexivity. Qed.

Lemma value_plus : forall a b, value (plus a b) = value a + value b.
Proof.
  intros a b. unfold plus. destruct (is 0 a) eqn:p; [rewrite (is_value _ _ p); ring |].
  destruct (is 0 b) eqn:q; [rewrite (is_value _ _ q); ring |].
  destruct (integer_of a) as [n |] eqn:e; [| reflexivity]. destruct (integer_of b) as [m |] eqn:f; [| reflexivity].
  destruct (is_small n && is_small m); [| reflexivity].
  rewrite (integer_of_value _ _ e), (integer_of_value _ _ f). cbn. apply plus_IZR.
Qed.

Lemma value_opposite : forall a, value (opposite a) = - value a.
Proof.
  intros [o]. destruct o; try reflexivity.
  - unfold opposite. destruct (is_small n); [| reflexivity]. cbn. apply opp_IZR.
  - cbn. ring.
Qed.

Lemma value_minus : forall a b, value (minus a b) = value a - value b.
Proof.
  intros a b. unfold minus. destruct (is 0 b) eqn:q; [rewrite (is_value _ _ q); ring |].
  destruct (is 0 a) eqn:p; [rewrite (is_value _ _ p), value_opposite; ring |].
  destruct a as [[j | | | | | | | | | |]]; try reflexivity. destruct b as [[k | | | | | | | | | |]]; try reflexivity.
  destruct (Nat.eqb_spec j k) as [-> |]; [cbn; ring | reflexivity].
Qed.

Lemma value_square : forall a, value (square a) = value a ^ 2.
Proof.
  intro a. unfold square. destruct (integer_of a) as [n |] eqn:e; [| reflexivity].
  destruct (is_small n); [| reflexivity]. rewrite (integer_of_value _ _ e). cbn. rewrite mult_IZR. ring.
Qed.

Lemma value_times : forall a b, value (times a b) = value a * value b.
Proof.
  intros a b. unfold times. destruct (is 0 a) eqn:p; [cbn; rewrite (is_value _ _ p); ring |].
  destruct (is 1 b) eqn:q; [cbn; rewrite (is_value _ _ q); ring |]. cbn [orb].
  destruct (is 0 b) eqn:p'; [cbn; rewrite (is_value _ _ p'); ring |].
  destruct (is 1 a) eqn:q'; [cbn; rewrite (is_value _ _ q'); ring |]. cbn [orb].
  destruct (same a b) eqn:s; [| reflexivity]. apply same_sound in s. subst b. rewrite value_square. ring.
Qed.

Lemma value_over : forall a b, value (over a b) = value a / value b.
Proof. intros a b. unfold over. destruct (is 1 b) eqn:q; [rewrite (is_value _ _ q); field | reflexivity]. Qed.

Lemma value_root : forall a, value (root a) = sqrt (value a).
Proof. intro a. unfold root. destruct (is 1 a) eqn:q; [rewrite (is_value _ _ q), sqrt_1; reflexivity | reflexivity]. Qed.

(** Where a sum or a quotient is defined. *)
Lemma is_defined : forall n e, is n e = true -> defined e.
Proof. intros n [o] h. destruct o; try discriminate. cbn. auto. Qed.

Lemma defined_plus : forall a b, defined (plus a b) -> defined a /\ defined b.
Proof.
  intros a b. unfold plus. destruct (is 0 a) eqn:p; [pose proof (is_defined _ _ p); auto |].
  destruct (is 0 b) eqn:q; [pose proof (is_defined _ _ q); auto |]. intro h.
  assert (N : forall e n, integer_of e = Some n -> defined e)
    by (intros [o] n e; destruct o; try discriminate; cbn; auto).
  destruct (integer_of a) as [n |] eqn:e; [| apply h]. destruct (integer_of b) as [m |] eqn:f; [| apply h].
  split; [apply (N _ _ e) | apply (N _ _ f)].
Qed.

Lemma plus_defined : forall a b, defined a -> defined b -> defined (plus a b).
Proof.
  intros a b ha hb. unfold plus. destruct (is 0 a); [exact hb |]. destruct (is 0 b); [exact ha |]. assert (S : defined (F (Add a b))) by (cbn; auto).
  destruct (integer_of a); [| exact S]. destruct (integer_of b); [| exact S]. destruct (_ && _); [cbn; auto | exact S].
Qed.
Lemma opposite_defined : forall a, defined a -> defined (opposite a).
Proof. intros [o] h. destruct o; cbn in *; try tauto. destruct (is_small n); cbn; auto. Qed.
Lemma minus_defined : forall a b, defined a -> defined b -> defined (minus a b).
Proof.
  intros a b ha hb. unfold minus. destruct (is 0 b); [exact ha |]. destruct (is 0 a); [apply opposite_defined, hb |].
  assert (S : defined (F (Sub a b))) by (cbn; auto). destruct a as [[]]; try exact S. destruct b as [[]]; try exact S. destruct (Nat.eqb _ _); [cbn; auto | exact S].
Qed.
Lemma times_defined : forall a b, defined a -> defined b -> defined (times a b).
Proof.
  intros a b ha hb. unfold times. destruct (_ || _); [exact ha |]. destruct (_ || _); [exact hb |]. destruct (same a b); [| cbn; auto].
  unfold square. destruct (integer_of a); [destruct (is_small z) |]; cbn; auto.
Qed.
Lemma over_defined : forall a b, defined a -> defined b -> value b <> 0 -> defined (over a b).
Proof. intros a b ha hb n. unfold over. destruct (is 1 b); [exact ha | cbn; auto]. Qed.
Lemma root_defined : forall a, defined a -> 0 < value a -> defined (root a).
Proof. intros a h p. unfold root. destruct (is 1 a); [exact h | cbn; auto]. Qed.

Lemma defined_over : forall a b, defined (over a b) -> value b <> 0.
Proof.
  intros a b. unfold over. destruct (is 1 b) eqn:q; [rewrite (is_value _ _ q); intros; lra | intros [h _]; exact h].
Qed.
End Values.

(** ** Tapes: argument i is the entry i steps before the last one *)

Section Run.
Variable V : Type.
Variable default : V.
Variable eval : op V -> V.

Fixpoint run (tape : list (op nat)) (entries : list V) : list V :=
  match tape with
  | [] => entries
  | o :: rest => run rest (eval (map_op (fun i => nth i entries default) o) :: entries)
  end.

(** The entries alone that are kept; once the list is at its end, all. *)
Fixpoint run_kept (keep : list bool) (tape : list (op nat)) (entries : list V) : list V :=
  match tape with
  | [] => entries
  | o :: rest =>
      match keep with
      | false :: keep' => run_kept keep' rest (default :: entries)
      | _ => run_kept (tl keep) rest (eval (map_op (fun i => nth i entries default) o) :: entries)
      end
  end.
Lemma run_kept_all : forall tape entries, run_kept [] tape entries = run tape entries.
Proof. induction tape as [| o rest IH]; intro entries; cbn [run run_kept tl]; [reflexivity | apply IH]. Qed.
End Run.

(** *** Which entries some others are made of *)

Fixpoint mark (i : nat) (l : list bool) : list bool :=
  match l, i with [], _ => [] | _ :: l', O => true :: l' | b :: l', S j => b :: mark j l' end.
Definition parts_of (o : op nat) : list nat :=
  match o with
  | Coord _ | Param _ | Integer _ => []
  | Add a b | Sub a b | Mul a b | Div a b => [a; b]
  | Neg a | Sqr a | Sqrt a => [a]
  | Elbow _ a b c => [a; b; c]
  end.
(** Of a tape and of what is needed, both last first, what is kept, first first. *)
Fixpoint kept_back (l : list (op nat)) (needed : list bool) (keep : list bool) : list bool :=
  match l, needed with
  | o :: l', b :: rest => kept_back l' (if b then fold_right mark rest (parts_of o) else rest) (b :: keep)
  | _, _ => keep
  end.
Definition kept (wanted : list nat) (tape : list (op nat)) : list bool :=
  kept_back (rev_append tape []) (fold_right mark (map (fun _ => false) tape) wanted) [].

(** The formulas a tape stands for, last first. *)
Definition formulas (tape : list (op nat)) : list formula := run formula (integer 0) F tape [].

Section Relation.
Variables V W : Type.
Variables (dv : V) (dw : W) (ev : op V -> V) (ew : op W -> W) (P : V -> W -> Prop).
Hypothesis start : P dv dw.
Hypothesis step : forall (o : op nat) f g, (forall i, P (f i) (g i)) -> P (ev (map_op f o)) (ew (map_op g o)).

Lemma nth_related : forall vs ws, Forall2 P vs ws -> forall i, P (nth i vs dv) (nth i ws dw).
Proof. induction 1; intros [| i]; cbn; auto. Qed.

(** What every operation respects, a tape respects. *)
Theorem run_related : forall tape vs ws, Forall2 P vs ws -> Forall2 P (run V dv ev tape vs) (run W dw ew tape ws).
Proof. induction tape as [| o rest IH]; intros vs ws h; cbn [run]; auto using nth_related. Qed.

(** And what is not kept is nothing. *)
Theorem run_kept_related : (forall w, P dv w) -> forall tape keep vs ws, Forall2 P vs ws -> Forall2 P (run_kept V dv ev keep tape vs) (run W dw ew tape ws).
Proof.
  intro never. induction tape as [| o rest IH]; intros keep vs ws h; cbn [run run_kept]; [exact h |].
  destruct keep as [| [|] keep]; apply IH; constructor; auto using nth_related.
Qed.
End Relation.

(** ** From formulas to a tape

    Nothing here needs a proof: its result is compared with the formulas. *)

Fixpoint position (e : formula) (l : list formula) (i : nat) : nat :=
  match l with [] => O | f :: l' => if same e f then i else position e l' (S i) end.
Definition place (l : list formula) (e : formula) : nat := position e l O.

(** Formulas placed so far, last first, and the tape, last first. *)
Fixpoint put (e : formula) (st : list formula * list (op nat)) {struct e} : list formula * list (op nat) :=
  if existsb (same e) (fst st) then st
  else
    match e with
    | F o =>
        let st' :=
          match o with
          | Coord _ | Param _ | Integer _ => st
          | Add a b | Sub a b | Mul a b | Div a b => put b (put a st)
          | Sqr a | Sqrt a | Neg a => put a st
          | Elbow _ a b t => put t (put b (put a st))
          end in
        (e :: fst st', map_op (place (fst st')) o :: snd st')
    end.

(** A tape of some formulas, and where they are on it. *)
Definition compile (l : list formula) : list (op nat) * list nat :=
  let st := fold_left (fun st e => put e st) l ([], []) in (rev (snd st), map (place (fst st)) l).
