(** * Comparing exact numbers *)

From Coq Require Import ZArith QArith Qreals Reals Lra List Bool.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Number.
Import ListNotations.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.

(** The number as a fraction, given the roots that are. *)
Section Roots.
Variable root : Q -> option Q.

Fixpoint fraction (x : number) : option Q :=
  let both f a b := match fraction a, fraction b with Some p, Some q => f p q | _, _ => None end in
  match x with
  | Ratio n d => Some (n # d)%Q
  | Plus a b => both (fun p q => Some (Qplus p q)) a b
  | Minus a b => both (fun p q => Some (Qminus p q)) a b
  | Times a b => both (fun p q => Some (Qmult p q)) a b
  | Over a b => both (fun p q => if Qeq_bool q 0 then None else Some (Qdiv p q)) a b
  | Root a => match fraction a with Some q => root q | None => None end
  | Varying _ _ _ => None
  end.

Hypothesis root_sound : forall q s, root q = Some s -> sqrt (Q2R q) = Q2R s.

Lemma fraction_sound : forall x q, fraction x = Some q -> value x = Q2R q.
Proof.
  induction x as [n d | k a b | a ha b hb | a ha b hb | a ha b hb | a ha b hb | a ha]; intros q h; cbn [fraction] in h; [| discriminate | | | | |];
    try (destruct (fraction a) as [p |]; [| discriminate]; destruct (fraction b) as [r |]; [| discriminate];
      cbn [value]; rewrite (ha p eq_refl), (hb r eq_refl)).
  - injection h as <-. reflexivity.
  - injection h as <-. symmetry. apply Q2R_plus.
  - injection h as <-. symmetry. apply Q2R_minus.
  - injection h as <-. symmetry. apply Q2R_mult.
  - destruct (Qeq_bool r 0) eqn:z; [discriminate |]. injection h as <-. symmetry. apply Q2R_div.
    intro e. apply Qeq_bool_iff in e. congruence.
  - destruct (fraction a) as [p |]; [| discriminate]. cbn [value]. rewrite (ha p eq_refl). apply root_sound, h.
Qed.
End Roots.

(** The number, where it has no roots. *)
Definition rational : number -> option Q := fraction (fun _ => None).

Lemma rational_sound : forall x q, rational x = Some q -> value x = Q2R q.
Proof. apply fraction_sound. discriminate. Qed.

Section Precision.
Variable bits : positive.

(** [0 <= x], or [0 < x]. *)
Definition certainly (strictly : bool) (x : number) : bool :=
  match rational x with
  | Some q => if strictly then negb (Qle_bool q 0) else Qle_bool 0 q
  | None => match enclose bits x with Some a => if strictly then (0 <? lo a)%Z else (0 <=? lo a)%Z | None => false end
  end.

Lemma positive_sound : forall x, certainly true x = true -> 0 < value x.
Proof.
  intros x h. unfold certainly in h. destruct (rational x) as [q |] eqn:r.
  - rewrite (rational_sound _ _ r). replace 0 with (Q2R 0) by (unfold Q2R; cbn; lra). apply Qlt_Rlt, Qnot_le_lt.
    intro l. apply Qle_bool_iff in l. rewrite l in h. discriminate.
  - destruct (enclose bits x) as [a |] eqn:e; [| discriminate]. apply Z.ltb_lt in h.
    exact (contains_positive bits _ _ h (enclose_sound bits _ _ e)).
Qed.

Lemma nonneg_sound : forall x, certainly false x = true -> 0 <= value x.
Proof.
  intros x h. unfold certainly in h. destruct (rational x) as [q |] eqn:r.
  - rewrite (rational_sound _ _ r). replace 0 with (Q2R 0) by (unfold Q2R; cbn; lra). apply Qle_Rle, Qle_bool_iff, h.
  - destruct (enclose bits x) as [a |] eqn:e; [| discriminate]. apply Z.leb_le in h.
    exact (contains_nonneg bits _ _ h (enclose_sound bits _ _ e)).
Qed.

(** A number without an enclosure is none: division is total here, and so is the root. *)
Definition is_number (x : number) : bool := match enclose bits x with Some _ => true | None => false end.

Definition below (x y : number) : bool := same x y && is_number x || certainly false (Minus y x).

Lemma below_sound : forall x y, below x y = true -> value x <= value y.
Proof.
  intros x y h. apply orb_true_iff in h as [h | h]; [apply andb_true_iff in h as [h _]; apply same_sound in h; subst; lra |].
  apply nonneg_sound in h. cbn [value] in h. lra.
Qed.
End Precision.
End Named.
