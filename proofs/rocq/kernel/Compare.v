(** * Comparing exact numbers *)

From Coq Require Import ZArith QArith Qreals Reals Lra List Bool.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Number.
Import ListNotations.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.

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
