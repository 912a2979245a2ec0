(** * The operations on intervals that formulas and tests need beside those of Fixed.v *)

From Coq Require Import ZArith Reals Lra Lia Psatz List Bool.
From Orthocert Require Import Fixed.
Local Open Scope R_scope.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation unit := (unit_R bits).

(** floor(n / 2^places) *)
Definition shifted (n : Z) (places : N) : Z := Z.shiftr n (Z.of_N places).

Lemma two_power : forall places, 0 < IZR (2 ^ Z.of_N places).
Proof. intro. apply IZR_lt, Z.pow_pos_nonneg; [reflexivity | apply N2Z.is_nonneg]. Qed.

Lemma shifted_sound : forall n places, IZR (shifted n places) * IZR (2 ^ Z.of_N places) <= IZR n.
Proof.
  intros n places. unfold shifted. rewrite Z.shiftr_div_pow2 by apply N2Z.is_nonneg.
  rewrite <- mult_IZR. apply IZR_le. rewrite Z.mul_comm. apply Z.mul_div_le.
  apply Z.pow_pos_nonneg; [reflexivity | apply N2Z.is_nonneg].
Qed.

(** [n a / 2^places], rounded outward. *)
Definition dyadic (n : Z) (places : N) (a : fixed) : fixed :=
  let (l, u) := if (0 <=? n)%Z then (lo a, hi a) else (hi a, lo a) in
  Fixed (shifted (n * l) places) (- shifted (- (n * u)) places).

Lemma dyadic_sound : forall n places a x, contains a x ->
  contains (dyadic n places a) (IZR n / IZR (2 ^ Z.of_N places) * x).
Proof.
  intros n places a x [l u]. unfold dyadic, Fixed.contains. pose proof (two_power places) as p.
  set (q := IZR (2 ^ Z.of_N places)) in *.
  assert (E : IZR n / q * x * unit * q = IZR n * (x * unit)) by (field; lra).
  assert (G : forall s t, IZR n * IZR s <= IZR n * (x * unit) <= IZR n * IZR t ->
    IZR (shifted (n * s) places) <= IZR n / q * x * unit <= IZR (- shifted (- (n * t)) places)).
  { intros s t [hs ht]. pose proof (shifted_sound (n * s) places) as A.
    pose proof (shifted_sound (- (n * t)) places) as B. fold q in A, B.
    rewrite opp_IZR in B |- *. rewrite mult_IZR in A, B.
    split; apply Rmult_le_reg_r with q; try lra. }
  destruct (0 <=? n)%Z eqn:e; cbn [lo hi]; apply G.
  - apply Z.leb_le, IZR_le in e. split; apply Rmult_le_compat_l; assumption.
  - apply Z.leb_gt, IZR_lt in e. split; apply Rmult_le_compat_neg_l; lra.
Qed.

(** [a / 2] *)
Definition halve (a : fixed) : fixed := Fixed (Z.shiftr (lo a) 1) (- Z.shiftr (- hi a) 1).

Lemma halve_sound : forall a x, contains a x -> contains (halve a) (x / 2).
Proof.
  intros a x [l u]. unfold halve, Fixed.contains. cbn [lo hi]. rewrite opp_IZR.
  pose proof (shifted_sound (lo a) 1) as A. pose proof (shifted_sound (- hi a) 1) as B.
  unfold shifted in A, B. change (Z.of_N 1) with 1%Z in A, B. change (2 ^ 1)%Z with 2%Z in A, B.
  rewrite opp_IZR in B. lra.
Qed.

(** [a b / c] for c > 0, rounded once.  A lower end is divided by the greatest
    divisor where it is not negative, else by the least; an upper one the
    other way round. *)
Definition ratio (a b c : fixed) : fixed :=
  let (p, q) := product_range (lo a) (hi a) (lo b) (hi b) in
  (Fixed (p / (if p <? 0 then lo c else hi c)) (div_ceil q (if q <? 0 then hi c else lo c)))%Z.

Lemma ratio_sound : forall a b c x y z, (0 < lo c)%Z -> contains a x -> contains b y -> contains c z ->
  contains (ratio a b c) (x * y / z).
Proof.
  intros a b c x y z c0 ha hb hc. pose proof (contains_positive bits c z c0 hc) as z0. destruct hc as [l u].
  pose proof (product_range_sound (lo a) (hi a) (lo b) (hi b) _ _ ha hb) as h. unfold ratio.
  destruct (product_range (lo a) (hi a) (lo b) (hi b)) as [p q]. cbn [fst snd] in h. unfold Fixed.contains. cbn [lo hi].
  pose proof (unit_R_pos bits) as u0. assert (c1 : (0 < hi c)%Z) by (apply lt_IZR; apply IZR_lt in c0; nra).
  set (w := z * unit) in *. assert (w0 : 0 < w) by (apply Rmult_lt_0_compat; lra).
  set (v := x * y / z * unit). assert (E : v * w = x * unit * (y * unit)) by (unfold v, w; field; lra).
  rewrite <- E in h. destruct h as [h1 h2]. apply IZR_lt in c0 as c0', c1 as c1'. split.
  - destruct (p <? 0)%Z eqn:s.
    + apply Z.ltb_lt, IZR_lt in s. pose proof (div_floor_sound p (lo c) c0) as d.
      apply Rmult_le_reg_r with (IZR (lo c)); [lra |]. apply Rle_trans with (IZR p); [exact d |].
      destruct (Rle_dec 0 v); [nra |]. nra.
    + apply Z.ltb_ge, IZR_le in s. pose proof (div_floor_sound p (hi c) c1) as d.
      apply Rmult_le_reg_r with (IZR (hi c)); [lra |]. apply Rle_trans with (IZR p); [exact d |].
      assert (0 <= v) by (apply Rmult_le_reg_r with w; lra). nra.
  - destruct (q <? 0)%Z eqn:s.
    + apply Z.ltb_lt, IZR_lt in s. pose proof (div_ceil_sound q (hi c) c1) as d.
      apply Rmult_le_reg_r with (IZR (hi c)); [lra |]. apply Rle_trans with (IZR q); [| exact d].
      assert (v <= 0) by (apply Rmult_le_reg_r with w; lra). nra.
    + apply Z.ltb_ge, IZR_le in s. pose proof (div_ceil_sound q (lo c) c0) as d.
      apply Rmult_le_reg_r with (IZR (lo c)); [lra |]. apply Rle_trans with (IZR q); [| exact d].
      destruct (Rle_dec 0 v); nra.
Qed.

(** The greatest absolute value. *)
Definition magnitude (a : fixed) : Z := Z.max (hi a) (- lo a).

Lemma magnitude_sound : forall a x t, contains a x -> -1 <= t <= 1 ->
  - IZR (magnitude a) <= x * t * unit <= IZR (magnitude a).
Proof.
  intros a x t [l u] h. unfold magnitude.
  assert (m : IZR (hi a) <= IZR (Z.max (hi a) (- lo a))) by (apply IZR_le; lia).
  assert (n : IZR (- lo a) <= IZR (Z.max (hi a) (- lo a))) by (apply IZR_le; lia).
  rewrite opp_IZR in n. replace (x * t * unit) with ((x * unit) * t) by ring.
  set (y := x * unit) in *. set (M := IZR (Z.max _ _)) in *. destruct (Rle_dec 0 y); split; nra.
Qed.

Definition zero : fixed := Fixed 0 0.

Lemma zero_sound : contains zero 0.
Proof. unfold Fixed.contains, zero. cbn. lra. Qed.

(** The ends of an interval as points. *)
Definition lower_end (a : fixed) : fixed := Fixed (lo a) (lo a).
Definition upper_end (a : fixed) : fixed := Fixed (hi a) (hi a).

Lemma point_sound : forall n, contains (Fixed n n) (IZR n / unit).
Proof. exact (Fixed.dyadic_sound bits). Qed.

Lemma lower_end_sound : forall a x, contains a x -> exists y, contains (lower_end a) y /\ y <= x.
Proof.
  intros a x [l u]. exists (IZR (lo a) / unit). split; [apply point_sound |].
  pose proof (unit_R_pos bits). apply Rmult_le_reg_r with unit; [assumption |].
  unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
Qed.

Lemma upper_end_sound : forall a x, contains a x -> exists y, contains (upper_end a) y /\ x <= y.
Proof.
  intros a x [l u]. exists (IZR (hi a) / unit). split; [apply point_sound |].
  pose proof (unit_R_pos bits). apply Rmult_le_reg_r with unit; [assumption |].
  unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
Qed.
End Precision.
