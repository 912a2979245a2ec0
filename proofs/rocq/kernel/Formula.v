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

(** ** Stacks: a list as trees of 1, 3, 7, .. entries, of which two of one size become one with what is put on top *)

Inductive trees (A : Type) := Tip (a : A) | Fork (a : A) (l r : trees A).
(** Trees with how often they fork, the last one first. *)
Inductive stack (A : Type) := Bottom | On (k : nat) (t : trees A) (s : stack A).
Arguments Tip {A}. Arguments Fork {A}. Arguments Bottom {A}. Arguments On {A}.
(** Where an entry is: in the next tree, at the top of one, or in its first or second part. *)
Inductive address := Here | First (p : address) | Second (p : address) | Beyond (p : address).

Section Stack.
Variable A : Type.
Variable default : A.

Definition push (a : A) (s : stack A) : stack A :=
  match s with
  | On k t (On k' t' rest) => if Nat.eqb k k' then On (S k) (Fork a t t') rest else On O (Tip a) s
  | _ => On O (Tip a) s
  end.
Fixpoint look_in (p : address) (t : trees A) {struct t} : A :=
  match t, p with Fork _ l _, First p' => look_in p' l | Fork _ _ r, Second p' => look_in p' r | Tip a, _ | Fork a _ _, _ => a end.
Fixpoint look (p : address) (s : stack A) {struct s} : A :=
  match s with Bottom => default | On _ t rest => match p with Beyond p' => look p' rest | _ => look_in p t end end.
Fixpoint listed_before (t : trees A) (l : list A) : list A :=
  match t with Tip a => a :: l | Fork a t t' => a :: listed_before t (listed_before t' l) end.
(** Last first. *)
Fixpoint listed (s : stack A) : list A := match s with Bottom => [] | On _ t rest => listed_before t (listed rest) end.

Definition pop (s : stack A) : option (A * stack A) :=
  match s with
  | Bottom => None
  | On _ (Tip a) rest => Some (a, rest)
  | On k (Fork a t t') rest => Some (a, On (pred k) t (On (pred k) t' rest))
  end.
End Stack.

(** What is put in place of an entry. *)
Section Put_in.
Variables (A : Type) (a : A).
Fixpoint with_in (p : address) (t : trees A) {struct t} : trees A :=
  match t, p with
  | Fork b l r, First p' => Fork b (with_in p' l) r
  | Fork b l r, Second p' => Fork b l (with_in p' r)
  | Fork _ l r, _ => Fork a l r
  | Tip _, _ => Tip a
  end.
Fixpoint with_at (p : address) (s : stack A) {struct s} : stack A :=
  match s with Bottom => Bottom | On k t rest => match p with Beyond p' => On k t (with_at p' rest) | _ => On k (with_in p t) rest end end.
End Put_in.

Section Related.
Variables V W : Type.
Variables (dv : V) (dw : W) (P : V -> W -> Prop).
Hypothesis start : P dv dw.

Inductive trees_related : trees V -> trees W -> Prop :=
  | Tips : forall a b, P a b -> trees_related (Tip a) (Tip b)
  | Forks : forall a b t u t' u', P a b -> trees_related t u -> trees_related t' u' -> trees_related (Fork a t t') (Fork b u u').
Inductive related : stack V -> stack W -> Prop :=
  | Bottoms : related Bottom Bottom
  | Ons : forall k t u s s', trees_related t u -> related s s' -> related (On k t s) (On k u s').

Lemma push_related : forall a b s s', P a b -> related s s' -> related (push V a s) (push W b s').
Proof.
  intros a b s s' p h. destruct h as [| k t u s s' ht h]; [repeat constructor; exact p |]. destruct h as [| k' t' u' s s' ht' h]; cbn [push]; [| destruct (Nat.eqb k k')];
    auto using Ons, Tips, Forks, Bottoms.
Qed.
Lemma look_in_related : forall t u, trees_related t u -> forall p, P (look_in V p t) (look_in W p u).
Proof. induction 1 as [a b h | a b t u t' u' h ht IH ht' IH']; intro p; cbn [look_in]; [exact h | destruct p; auto]. Qed.
Lemma look_related : forall s s', related s s' -> forall p, P (look V dv p s) (look W dw p s').
Proof. induction 1 as [| k t u s s' ht h IH]; intro p; cbn [look]; [exact start |]. destruct p; auto using look_in_related. Qed.
Lemma listed_before_related : forall t u, trees_related t u -> forall l l', Forall2 P l l' -> Forall2 P (listed_before V t l) (listed_before W u l').
Proof. induction 1; intros; cbn [listed_before]; auto. Qed.
Lemma listed_related : forall s s', related s s' -> Forall2 P (listed V s) (listed W s').
Proof. induction 1; cbn [listed]; auto using listed_before_related. Qed.
End Related.

(** ** Tapes: arguments are where entries are among those before *)

Section Run.
Variable V : Type.
Variable default : V.
Variable eval : op V -> V.

Fixpoint run_on (tape : list (op address)) (entries : stack V) : stack V :=
  match tape with
  | [] => entries
  | o :: rest => run_on rest (push V (eval (map_op (fun i => look V default i entries) o)) entries)
  end.
Definition run (tape : list (op address)) : list V := listed V (run_on tape Bottom).

(** The entries alone that are kept; once the list is at its end, all. *)
Fixpoint run_kept_on (keep : list bool) (tape : list (op address)) (entries : stack V) : stack V :=
  match tape with
  | [] => entries
  | o :: rest =>
      match keep with
      | false :: keep' => run_kept_on keep' rest (push V default entries)
      | _ => run_kept_on (tl keep) rest (push V (eval (map_op (fun i => look V default i entries) o)) entries)
      end
  end.
Definition run_kept (keep : list bool) (tape : list (op address)) : list V := listed V (run_kept_on keep tape Bottom).
Lemma run_kept_all : forall tape, run_kept [] tape = run tape.
Proof.
  intro tape. unfold run_kept, run. f_equal. generalize (@Bottom V). induction tape as [| o rest IH]; intro entries; cbn [run_on run_kept_on tl]; [reflexivity | apply IH].
Qed.
End Run.

(** *** Which entries some others are made of *)

Definition parts_of (o : op address) : list address :=
  match o with
  | Coord _ | Param _ | Integer _ => []
  | Add a b | Sub a b | Mul a b | Div a b => [a; b]
  | Neg a | Sqr a | Sqrt a => [a]
  | Elbow _ a b c => [a; b; c]
  end.
Definition mark : address -> stack bool -> stack bool := with_at bool true.
(** Entries i steps before the last one, in order: each by how many steps it is before the one ahead of it. *)
Fixpoint steps_apart (i j : nat) : nat + nat := match i, j with O, d => inr d | d, O => inl d | S i', S j' => steps_apart i' j' end.
Fixpoint with_step (i : nat) (gaps : list nat) : list nat :=
  match gaps with
  | [] => [i]
  | g :: rest => match steps_apart g i with inr O => gaps | inr d => g :: with_step d rest | inl d => i :: d :: rest end
  end.
Fixpoint are_at (gaps : list nat) (tape : list (op address)) : list bool :=
  match tape, gaps with
  | [], _ => []
  | _ :: rest, [] => false :: are_at [] rest
  | _ :: rest, S n :: gaps' => false :: are_at (n :: gaps') rest
  | _ :: rest, O :: gaps' => true :: are_at (match gaps' with d :: ds => pred d :: ds | [] => [] end) rest
  end.
(** Of a tape those that are looked at. *)
Definition marked (wanted : list nat) (tape : list (op address)) : stack bool := fold_right (push bool) Bottom (are_at (fold_left (fun gaps i => with_step i gaps) wanted []) tape).
(** Of a tape and of what is needed, both last first, what is kept, first first. *)
Fixpoint kept_back (l : list (op address)) (needed : stack bool) (keep : list bool) : list bool :=
  match l, pop bool needed with
  | o :: l', Some (b, rest) => kept_back l' (if b then fold_right mark rest (parts_of o) else rest) (b :: keep)
  | _, _ => keep
  end.
Definition kept (wanted : list nat) (tape : list (op address)) : list bool := kept_back (rev_append tape []) (marked wanted tape) [].

(** The formulas a tape stands for, last first. *)
Definition formulas (tape : list (op address)) : list formula := run formula (integer 0) F tape.

Section Relation.
Variables V W : Type.
Variables (dv : V) (dw : W) (ev : op V -> V) (ew : op W -> W) (P : V -> W -> Prop).
Hypothesis start : P dv dw.
Hypothesis step : forall (o : op address) f g, (forall i, P (f i) (g i)) -> P (ev (map_op f o)) (ew (map_op g o)).

Lemma nth_related : forall vs ws, Forall2 P vs ws -> forall i, P (nth i vs dv) (nth i ws dw).
Proof. induction 1; intros [| i]; cbn; auto. Qed.

(** What every operation respects, a tape respects. *)
Theorem run_related : forall tape, Forall2 P (run V dv ev tape) (run W dw ew tape).
Proof.
  intro tape. apply listed_related. assert (B := Bottoms V W P). revert B. generalize (@Bottom V) (@Bottom W).
  induction tape as [| o rest IH]; intros s s' h; cbn [run_on]; [exact h |]. apply IH, push_related; [apply step, look_related |]; assumption.
Qed.

(** And what is not kept is nothing. *)
Theorem run_kept_related : (forall w, P dv w) -> forall keep tape, Forall2 P (run_kept V dv ev keep tape) (run W dw ew tape).
Proof.
  intros never keep tape. apply listed_related. assert (B := Bottoms V W P). revert keep B. generalize (@Bottom V) (@Bottom W).
  induction tape as [| o rest IH]; intros s s' keep h; cbn [run_on run_kept_on]; [exact h |].
  assert (L := fun i => look_related V W dv dw P start s s' h i). destruct keep as [| [|] keep]; apply IH, push_related; auto.
Qed.
End Relation.

(** ** From formulas to a tape

    Nothing here needs a proof: its result is compared with the formulas. *)

Module Placing.
Definition tag (o : op formula) : nat :=
  match o with
  | Coord _ => 0 | Param _ => 1 | Integer _ => 2 | Add _ _ => 3 | Sub _ _ => 4 | Neg _ => 5 | Mul _ _ => 6 | Div _ _ => 7 | Sqr _ => 8 | Sqrt _ => 9 | Elbow _ _ _ _ => 10
  end.
(** By the upper operations alone if there is a limit. *)
Fixpoint order (limit : option nat) (e f : formula) {struct e} : comparison :=
  match limit, e, f with
  | Some O, _, _ => Eq
  | _, F o, F o' =>
      let next := option_map pred limit in
      match o, o' with
      | Coord k, Coord k' | Param k, Param k' => Nat.compare k k'
      | Integer n, Integer n' => Z.compare n n'
      | Add a b, Add a' b' | Sub a b, Sub a' b' | Mul a b, Mul a' b' | Div a b, Div a' b' => match order next b b' with Eq => order next a a' | c => c end
      | Neg a, Neg a' | Sqr a, Sqr a' | Sqrt a, Sqrt a' => order next a a'
      | Elbow true _ _ _, Elbow false _ _ _ => Gt
      | Elbow false _ _ _, Elbow true _ _ _ => Lt
      | Elbow _ a b t, Elbow _ a' b' t' => match order next t t' with Eq => match order next b b' with Eq => order next a a' | c => c end | c => c end
      | _, _ => Nat.compare (tag o) (tag o')
      end
  end.
Definition compared (e f : formula) : comparison := match order (Some 4%nat) e f with Eq => order None e f | c => c end.

(** Red-black trees of formulas. *)
Inductive index (V : Type) := Nowhere | At (red : bool) (l : index V) (e : formula) (v : V) (r : index V).
Arguments Nowhere {V}. Arguments At {V}.
Section Index.
Variable V : Type.
Fixpoint find (e : formula) (t : index V) : option V :=
  match t with
  | Nowhere => None
  | At _ l f v r => match compared e f with Eq => Some v | Lt => find e l | Gt => find e r end
  end.
Definition balanced (l : index V) (e : formula) (v : V) (r : index V) : index V :=
  match l with
  | At true (At true a x p b) y q c | At true a x p (At true b y q c) => At true (At false a x p b) y q (At false c e v r)
  | _ =>
      match r with
      | At true (At true b y q c) z s d | At true b y q (At true c z s d) => At true (At false l e v b) y q (At false c z s d)
      | _ => At false l e v r
      end
  end.
Fixpoint insert_in (e : formula) (v : V) (t : index V) : index V :=
  match t with
  | Nowhere => At true Nowhere e v Nowhere
  | At red l f w r =>
      let node := if red then At true else balanced in
      match compared e f with Eq => t | Lt => node (insert_in e v l) f w r | Gt => node l f w (insert_in e v r) end
  end.
Definition insert (e : formula) (v : V) (t : index V) : index V :=
  match insert_in e v t with At _ l f w r => At false l f w r | Nowhere => Nowhere end.
End Index.

(** Where formulas are in a list of them: of one list, for all that are asked for. *)
Definition place (l : list formula) : formula -> nat :=
  let places := snd (fold_left (fun st f => (S (fst st), insert nat f (fst st) (snd st))) l (O, Nowhere)) in
  fun e => match find nat e places with Some i => i | None => O end.

(** Formulas placed so far, with their numbers, which are on a stack, too, and the tape, last first. *)
Record placed := Placed { numbers : index Z; numbered : stack Z; next : Z; code : list (op address) }.
(** Of entries that are their numbers: those below are less. *)
Definition top (t : trees Z) : Z := match t with Tip a | Fork a _ _ => a end.
Fixpoint address_in (i : Z) (t : trees Z) : address :=
  match t with
  | Tip _ => Here
  | Fork a l r => if (i =? a)%Z then Here else if (i <=? top r)%Z then Second (address_in i r) else First (address_in i l)
  end.
Fixpoint address_of (i : Z) (s : stack Z) : address :=
  match s with
  | On _ t rest => if match rest with On _ u _ => (i <=? top u)%Z | Bottom => false end then Beyond (address_of i rest) else address_in i t
  | Bottom => Here
  end.
Fixpoint put (e : formula) (st : placed) {struct e} : Z * placed :=
  match find Z e (numbers st) with
  | Some n => (n, st)
  | None =>
      match e with
      | F o =>
          let new (st : placed) (at_ : (Z -> address) -> op address) :=
            (next st, Placed (insert Z e (next st) (numbers st)) (push Z (next st) (numbered st)) (next st + 1) (at_ (fun i => address_of i (numbered st)) :: code st)) in
          let one a by_ := let (i, st) := put a st in new st (fun w => by_ (w i)) in
          let two a b by_ := let (i, st) := put a st in let (j, st) := put b st in new st (fun w => by_ (w i) (w j)) in
          match o with
          | Coord k => new st (fun _ => Coord k) | Param j => new st (fun _ => Param j) | Integer n => new st (fun _ => Integer n)
          | Add a b => two a b Add | Sub a b => two a b Sub | Mul a b => two a b Mul | Div a b => two a b Div
          | Neg a => one a Neg | Sqr a => one a Sqr | Sqrt a => one a Sqrt
          | Elbow s a b t => let (i, st) := put a st in let (j, st) := put b st in let (k, st) := put t st in new st (fun w => Elbow s (w i) (w j) (w k))
          end
      end
  end.

(** A tape of some formulas. *)
Definition tape_of (l : list formula) : list (op address) := rev_append (code (fold_left (fun st e => snd (put e st)) l (Placed Nowhere Bottom 0 []))) [].
End Placing.
Definition place := Placing.place.
Definition compile := Placing.tape_of.
