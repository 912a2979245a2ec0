(** * The numbers of a claim, enclosed

    A number with roots is enclosed by intervals with more bits than the
    checker's; a power of two is the unit of lengths, so that the integers of
    a check have one size whatever the claim's unit. *)

From Coq Require Import ZArith Reals Lra Lia.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Arithmetic.
Local Open Scope R_scope.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Fixpoint enclose (x : number) : option fixed :=
  match x with
  | Ratio n d => Some (Fixed.ratio bits n d)
  | Plus x y => match enclose x, enclose y with Some a, Some b => Some (add a b) | _, _ => None end
  | Minus x y => match enclose x, enclose y with Some a, Some b => Some (sub a b) | _, _ => None end
  | Times x y => match enclose x, enclose y with Some a, Some b => Some (mul bits a b) | _, _ => None end
  | Over x y =>
      match enclose x, enclose y with
      | Some a, Some b => match recip bits b with Some c => Some (mul bits a c) | None => None end
      | _, _ => None
      end
  | Root x => match enclose x with Some a => root bits a | None => None end
  end.

Lemma enclose_sound : forall x a, enclose x = Some a -> contains a (value x).
Proof.
  induction x as [n d | x hx y hy | x hx y hy | x hx y hy | x hx y hy | x hx]; intros a h; cbn [enclose] in h.
  - assert (e : Fixed.ratio bits n d = a) by congruence. subst a. apply Fixed.ratio_sound.
  - destruct (enclose x) as [b |], (enclose y) as [c |]; try discriminate.
    assert (e : add b c = a) by congruence. subst a. apply add_sound; auto.
  - destruct (enclose x) as [b |], (enclose y) as [c |]; try discriminate.
    assert (e : sub b c = a) by congruence. subst a. apply sub_sound; auto.
  - destruct (enclose x) as [b |], (enclose y) as [c |]; try discriminate.
    assert (e : mul bits b c = a) by congruence. subst a. apply mul_sound; auto.
  - destruct (enclose x) as [b |], (enclose y) as [c |]; try discriminate.
    destruct (recip bits c) as [d |] eqn:r; [| discriminate].
    assert (e : mul bits b d = a) by congruence. subst a. apply mul_sound; [auto |].
    apply (recip_sound bits c); auto.
  - destruct (enclose x) as [b |]; [| discriminate]. apply (root_sound bits b); auto.
Qed.
End Precision.

(** 2^s *)
Definition two_to (s : Z) : R := if (0 <=? s)%Z then IZR (2 ^ s) else / IZR (2 ^ (- s)).

Lemma power_pos : forall n, (0 <= n)%Z -> 0 < IZR (2 ^ n).
Proof. intros n h. apply IZR_lt, Z.pow_pos_nonneg; [reflexivity | exact h]. Qed.

Lemma two_to_pos : forall s, 0 < two_to s.
Proof.
  intro s. unfold two_to. destruct (0 <=? s)%Z eqn:e.
  - apply power_pos, Z.leb_le, e.
  - apply Z.leb_gt in e. apply Rinv_0_lt_compat, power_pos. lia.
Qed.

Section Scaled.
Variable bits : positive.
Local Notation contains := (contains bits).

(** Bits that are cut off after the division: 64, and those that it brings. *)
Definition guard (s : Z) : positive := Z.to_pos (64 + Z.max (- s) 0).
Definition cut_off (s : Z) : N := Z.to_N (Zpos (guard s) + s).

(** [x / 2^s] *)
Definition enclose_scaled (s : Z) (x : number) : option fixed :=
  match enclose (bits + guard s) x with
  | Some a => Some (Fixed (shifted (lo a) (cut_off s)) (- shifted (- hi a) (cut_off s)))
  | None => None
  end.

Lemma enclose_scaled_sound : forall s x a, enclose_scaled s x = Some a -> contains a (value x / two_to s).
Proof.
  intros s x a h. unfold enclose_scaled in h. destruct (enclose (bits + guard s) x) as [b |] eqn:e; [| discriminate].
  injection h as <-. apply enclose_sound in e. destruct e as [l u].
  assert (G : Zpos (guard s) = (64 + Z.max (- s) 0)%Z) by (unfold guard; apply Z2Pos.id; lia).
  set (places := cut_off s) in *.
  assert (P : Z.of_N places = (Zpos (guard s) + s)%Z) by (unfold places, cut_off; apply Z2N.id; lia).
  pose proof (two_power places) as p0. pose proof (two_to_pos s) as t0.
  assert (E : unit_R (bits + guard s) = unit_R bits / two_to s * IZR (2 ^ Z.of_N places)).
  { unfold unit_R, unit_Z, two_to. rewrite P, Pos2Z.inj_add. destruct (0 <=? s)%Z eqn:q.
    - apply Z.leb_le in q. rewrite (Z.pow_add_r 2 (Zpos bits)), (Z.pow_add_r 2 (Zpos (guard s)) s), !mult_IZR by lia.
      pose proof (power_pos s q). field. lra.
    - apply Z.leb_gt in q. rewrite (Z.pow_add_r 2 (Zpos bits)), mult_IZR by lia.
      assert (F : (2 ^ Zpos (guard s) = 2 ^ (- s) * 2 ^ (Zpos (guard s) + s))%Z).
      { rewrite <- (Z.pow_add_r 2 (- s)) by lia. f_equal. lia. }
      rewrite F, mult_IZR. pose proof (power_pos (- s) ltac:(lia)). field. lra. }
  rewrite E in l, u. unfold Fixed.contains. cbn [lo hi].
  pose proof (shifted_sound (lo b) places) as A. pose proof (shifted_sound (- hi b) places) as B.
  rewrite opp_IZR in B |- *. replace (value x / two_to s * unit_R bits) with (value x * (unit_R bits / two_to s)) by (field; lra).
  set (w := IZR (2 ^ Z.of_N places)) in *. set (y := unit_R bits / two_to s) in *. clearbody w y.
  split; apply Rmult_le_reg_r with w; lra.
Qed.

(** A parameter with the unit that formulas have it in. *)
Definition parameter : Type := tolerance * Z.
Definition scaled_within (p : parameter) (y : R) : Prop := exists x, within (fst p) x /\ y = x / two_to (snd p).

Definition enclose_parameter (p : parameter) : option fixed :=
  match enclose_scaled (snd p) (least (fst p)), enclose_scaled (snd p) (greatest (fst p)) with
  | Some a, Some b => Some (Fixed (lo a) (hi b))
  | _, _ => None
  end.

Lemma enclose_parameter_sound : forall p a y, enclose_parameter p = Some a -> scaled_within p y -> contains a y.
Proof.
  intros [t s] a y h [x [[h1 h2] ->]]. unfold enclose_parameter in h. cbn [fst snd] in *.
  destruct (enclose_scaled s (least t)) as [b |] eqn:e1; [| discriminate].
  destruct (enclose_scaled s (greatest t)) as [c |] eqn:e2; [| discriminate]. injection h as <-.
  apply enclose_scaled_sound in e1 as [l _], e2 as [_ u]. unfold Fixed.contains. cbn [lo hi].
  pose proof (unit_R_pos bits). pose proof (two_to_pos s) as t0.
  assert (C : forall p q, p <= q -> p / two_to s * unit_R bits <= q / two_to s * unit_R bits).
  { intros p q k. apply Rmult_le_compat_r; [lra |]. apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, t0 | exact k]. }
  pose proof (C _ _ h1). pose proof (C _ _ h2). lra.
Qed.
End Scaled.
