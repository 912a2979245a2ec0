(** * Fixed-point intervals over the integers

    The only arithmetic a check rests on.  [Fixed lo hi] stands for the real
    interval [lo / 2^bits, hi / 2^bits].  Addition and subtraction are exact;
    multiplication, division and square root round outward to the next
    multiple of 2^-bits.  Every operation has a lemma [..._sound]: what is
    enclosed before is enclosed after. *)

From Coq Require Import ZArith Reals Lra Lia Psatz Bool.
Local Open Scope Z_scope.

Record fixed := Fixed { lo : Z; hi : Z }.

Section Precision.
(** Fractional bits. *)
Variable bits : positive.

Definition unit_Z : Z := 2 ^ Zpos bits.
Definition unit_R : R := IZR unit_Z.

(** [x] lies in the interval [a]. *)
Definition contains (a : fixed) (x : R) : Prop := (IZR (lo a) <= x * unit_R <= IZR (hi a))%R.

Lemma unit_Z_pos : 0 < unit_Z.
Proof. apply Z.pow_pos_nonneg; [reflexivity | apply Pos2Z.is_nonneg]. Qed.

Lemma unit_R_pos : (0 < unit_R)%R.
Proof. apply IZR_lt, unit_Z_pos. Qed.

(** ** Rounding: floor and ceiling of n / 2^bits and of n / d *)

Definition shift_floor (n : Z) : Z := Z.shiftr n (Zpos bits).
Definition shift_ceil (n : Z) : Z := - Z.shiftr (- n) (Zpos bits).
Definition div_ceil (n d : Z) : Z := - ((- n) / d).

Lemma shift_floor_sound : forall n, (IZR (shift_floor n) * unit_R <= IZR n)%R.
Proof.
  intro n. unfold shift_floor, unit_R, unit_Z. rewrite Z.shiftr_div_pow2 by apply Pos2Z.is_nonneg.
  rewrite <- mult_IZR. apply IZR_le. rewrite Z.mul_comm. apply Z.mul_div_le, unit_Z_pos.
Qed.

Lemma shift_ceil_sound : forall n, (IZR n <= IZR (shift_ceil n) * unit_R)%R.
Proof.
  intro n. unfold shift_ceil. pose proof (shift_floor_sound (- n)) as h. unfold shift_floor in h.
  rewrite !opp_IZR in *. lra.
Qed.

Lemma div_floor_sound : forall n d, 0 < d -> (IZR (n / d) * IZR d <= IZR n)%R.
Proof.
  intros n d h. rewrite <- mult_IZR. apply IZR_le. rewrite Z.mul_comm. apply Z.mul_div_le, h.
Qed.

Lemma div_ceil_sound : forall n d, 0 < d -> (IZR n <= IZR (div_ceil n d) * IZR d)%R.
Proof.
  intros n d h. unfold div_ceil. pose proof (div_floor_sound (- n) d h). rewrite !opp_IZR in *. lra.
Qed.

(** ** Points *)

Definition integer (n : Z) : fixed := let m := Z.shiftl n (Zpos bits) in Fixed m m.
(** The point n / 2^bits. *)
Definition dyadic (n : Z) : fixed := Fixed n n.
(** The tightest enclosure of n / d. *)
Definition ratio (n : Z) (d : positive) : fixed :=
  let m := Z.shiftl n (Zpos bits) in Fixed (m / Zpos d) (div_ceil m (Zpos d)).

Lemma shiftl_unit : forall n, Z.shiftl n (Zpos bits) = n * unit_Z.
Proof. intro n. rewrite Z.shiftl_mul_pow2 by apply Pos2Z.is_nonneg. reflexivity. Qed.

Lemma integer_sound : forall n, contains (integer n) (IZR n).
Proof.
  intro n. unfold contains, integer. cbn [lo hi]. rewrite shiftl_unit, mult_IZR. fold unit_R. lra.
Qed.

Lemma dyadic_sound : forall n, contains (dyadic n) (IZR n / unit_R).
Proof.
  intro n. unfold contains, dyadic. cbn [lo hi]. pose proof unit_R_pos.
  replace (IZR n / unit_R * unit_R)%R with (IZR n) by (field; lra). lra.
Qed.

Lemma ratio_sound : forall n d, contains (ratio n d) (IZR n / IZR (Zpos d)).
Proof.
  intros n d. unfold contains, ratio. cbn [lo hi]. rewrite shiftl_unit.
  assert (d0 : (0 < IZR (Zpos d))%R) by (apply IZR_lt, Pos2Z.is_pos).
  pose proof (div_floor_sound (n * unit_Z) (Zpos d) (Pos2Z.is_pos d)) as f.
  pose proof (div_ceil_sound (n * unit_Z) (Zpos d) (Pos2Z.is_pos d)) as c.
  rewrite !mult_IZR in f, c. fold unit_R in f, c.
  assert (E : (IZR n / IZR (Zpos d) * unit_R * IZR (Zpos d) = IZR n * unit_R)%R) by (field; lra).
  split; apply Rmult_le_reg_r with (IZR (Zpos d)); lra.
Qed.

(** ** Addition, subtraction, negation *)

Definition add (a b : fixed) : fixed := Fixed (lo a + lo b) (hi a + hi b).
Definition sub (a b : fixed) : fixed := Fixed (lo a - hi b) (hi a - lo b).
Definition neg (a : fixed) : fixed := Fixed (- hi a) (- lo a).

Lemma add_sound : forall a b x y, contains a x -> contains b y -> contains (add a b) (x + y).
Proof. unfold contains, add. intros. cbn [lo hi]. rewrite !plus_IZR. lra. Qed.

Lemma sub_sound : forall a b x y, contains a x -> contains b y -> contains (sub a b) (x - y).
Proof. unfold contains, sub. intros. cbn [lo hi]. rewrite !minus_IZR. lra. Qed.

Lemma neg_sound : forall a x, contains a x -> contains (neg a) (- x).
Proof. unfold contains, neg. intros. cbn [lo hi]. rewrite !opp_IZR. lra. Qed.

(** ** Multiplication, by the signs of the ends *)

Definition product_range (a b c d : Z) : Z * Z :=
  if 0 <=? a then
    if 0 <=? c then (a * c, b * d)
    else if d <=? 0 then (b * c, a * d) else (b * c, b * d)
  else if b <=? 0 then
    if 0 <=? c then (a * d, b * c)
    else if d <=? 0 then (b * d, a * c) else (a * d, a * c)
  else
    if 0 <=? c then (a * d, b * d)
    else if d <=? 0 then (b * c, a * c)
    else (Z.min (a * d) (b * c), Z.max (a * c) (b * d)).

Lemma IZR_min : forall a b, (IZR (Z.min a b) <= IZR a)%R /\ (IZR (Z.min a b) <= IZR b)%R.
Proof. intros. split; apply IZR_le; lia. Qed.

Lemma IZR_max : forall a b, (IZR a <= IZR (Z.max a b))%R /\ (IZR b <= IZR (Z.max a b))%R.
Proof. intros. split; apply IZR_le; lia. Qed.

Lemma product_range_sound : forall a b c d x y,
  (IZR a <= x <= IZR b)%R -> (IZR c <= y <= IZR d)%R ->
  (IZR (fst (product_range a b c d)) <= x * y <= IZR (snd (product_range a b c d)))%R.
Proof.
  intros a b c d x y [h1 h2] [h3 h4]. unfold product_range.
  assert (Y : forall n, (0 <=? n) = true -> (0 <= IZR n)%R) by (intros n e; apply IZR_le; lia).
  assert (N : forall n, (0 <=? n) = false -> (IZR n <= 0)%R) by (intros n e; apply IZR_le; lia).
  assert (Y' : forall n, (n <=? 0) = true -> (IZR n <= 0)%R) by (intros n e; apply IZR_le; lia).
  assert (N' : forall n, (n <=? 0) = false -> (0 <= IZR n)%R) by (intros n e; apply IZR_le; lia).
  destruct (0 <=? a) eqn:sa; [apply Y in sa | apply N in sa; destruct (b <=? 0) eqn:sb;
    [apply Y' in sb | apply N' in sb]];
  (destruct (0 <=? c) eqn:sc; [apply Y in sc | apply N in sc; destruct (d <=? 0) eqn:sd;
    [apply Y' in sd | apply N' in sd]]); cbn [fst snd];
  [.. | pose proof (IZR_min (a * d) (b * c)) as mn; pose proof (IZR_max (a * c) (b * d)) as mx];
  clear Y N Y' N'; rewrite ?mult_IZR in *;
  set (A := IZR a) in *; set (B := IZR b) in *; set (C := IZR c) in *; set (D := IZR d) in *;
  try (split; nra).
  destruct (Rle_dec 0 x), (Rle_dec 0 y); split; nra.
Qed.

Definition mul (a b : fixed) : fixed :=
  let pq := product_range (lo a) (hi a) (lo b) (hi b) in
  Fixed (shift_floor (fst pq)) (shift_ceil (snd pq)).

(** Ends n, m of an interval around a product, in units of 2^(-2 bits). *)
Lemma round_product : forall n m z, (IZR n <= z * unit_R * unit_R <= IZR m)%R ->
  contains (Fixed (shift_floor n) (shift_ceil m)) z.
Proof.
  intros n m z h. unfold contains. cbn [lo hi]. pose proof unit_R_pos.
  pose proof (shift_floor_sound n). pose proof (shift_ceil_sound m).
  split; apply Rmult_le_reg_r with unit_R; lra.
Qed.

Lemma mul_sound : forall a b x y, contains a x -> contains b y -> contains (mul a b) (x * y).
Proof.
  intros a b x y h k. apply round_product.
  replace (x * y * unit_R * unit_R)%R with ((x * unit_R) * (y * unit_R))%R by ring.
  apply product_range_sound; assumption.
Qed.

(** ** Squares: never below zero *)

Definition sqr (a : fixed) : fixed :=
  let p := lo a * lo a in let q := hi a * hi a in
  Fixed (if (lo a <? 0) && (0 <? hi a) then 0 else shift_floor (Z.min p q)) (shift_ceil (Z.max p q)).

Lemma sqr_sound : forall a x, contains a x -> contains (sqr a) (x ^ 2).
Proof.
  intros a x h. unfold contains in h.
  assert (E : (x ^ 2 * unit_R * unit_R = (x * unit_R) ^ 2)%R) by ring.
  pose proof (pow2_ge_0 (x * unit_R)) as sq0. pose proof unit_R_pos as u.
  pose proof (IZR_max (lo a * lo a) (hi a * hi a)) as mx. pose proof (IZR_min (lo a * lo a) (hi a * hi a)) as mn.
  assert (top : (x ^ 2 * unit_R * unit_R <= IZR (Z.max (lo a * lo a) (hi a * hi a)))%R).
  { rewrite E. rewrite !mult_IZR in mx. destruct (Rle_dec 0 (x * unit_R)); nra. }
  unfold sqr. cbn zeta. destruct ((lo a <? 0) && (0 <? hi a)) eqn:st.
  - unfold contains. cbn [lo hi]. pose proof (shift_ceil_sound (Z.max (lo a * lo a) (hi a * hi a))).
    split; [| apply Rmult_le_reg_r with unit_R; lra].
    apply Rmult_le_pos; [apply pow2_ge_0 | lra].
  - apply round_product. split; [| exact top]. rewrite E.
    assert (side : 0 <= lo a \/ hi a <= 0) by (apply andb_false_iff in st; lia).
    rewrite !mult_IZR in mn. destruct side as [s | s]; apply IZR_le in s; nra.
Qed.

(** ** Reciprocal and square root: only where they are certainly defined *)

Definition recip_positive (a : fixed) : fixed :=
  let one := Z.shiftl unit_Z (Zpos bits) in Fixed (one / hi a) (div_ceil one (lo a)).

Definition recip (a : fixed) : option fixed :=
  if 0 <? lo a then Some (recip_positive a)
  else if hi a <? 0 then Some (neg (recip_positive (neg a))) else None.

Lemma contains_positive : forall a x, 0 < lo a -> contains a x -> (0 < x)%R.
Proof.
  intros a x h [l _]. apply IZR_lt in h. pose proof unit_R_pos.
  apply Rmult_lt_reg_r with unit_R; lra.
Qed.

Lemma recip_positive_sound : forall a x, 0 < lo a -> contains a x -> contains (recip_positive a) (/ x).
Proof.
  intros a x h c. pose proof (contains_positive a x h c) as x0. destruct c as [l u].
  pose proof unit_R_pos as u0. apply IZR_lt in h as h'.
  assert (hh : 0 < hi a) by (apply lt_IZR; lra).
  unfold contains, recip_positive. cbn zeta. cbn [lo hi]. rewrite shiftl_unit.
  pose proof (div_floor_sound (unit_Z * unit_Z) (hi a) hh) as f.
  pose proof (div_ceil_sound (unit_Z * unit_Z) (lo a) h) as g.
  rewrite !mult_IZR in f, g. fold unit_R in f, g. apply IZR_lt in hh.
  assert (E : (/ x * unit_R * (x * unit_R) = unit_R * unit_R)%R) by (field; lra).
  assert (v0 : (0 < / x * unit_R)%R) by (apply Rmult_lt_0_compat; [apply Rinv_0_lt_compat |]; lra).
  set (v := (/ x * unit_R)%R) in *. set (X := (x * unit_R)%R) in *. split.
  - apply Rmult_le_reg_r with (IZR (hi a)); [lra |]. apply Rle_trans with (v * X)%R; [lra |].
    apply Rmult_le_compat_l; lra.
  - apply Rmult_le_reg_r with (IZR (lo a)); [lra |]. apply Rle_trans with (v * X)%R; [| lra].
    apply Rmult_le_compat_l; lra.
Qed.

Lemma recip_sound : forall a b x, recip a = Some b -> contains a x -> x <> 0%R /\ contains b (/ x).
Proof.
  intros a b x e h. unfold recip in e. destruct (0 <? lo a) eqn:p.
  - injection e as <-. apply Z.ltb_lt in p. split; [| apply recip_positive_sound; assumption].
    pose proof (contains_positive a x p h). lra.
  - destruct (hi a <? 0) eqn:n; [| discriminate]. injection e as <-. apply Z.ltb_lt in n.
    assert (n' : 0 < lo (neg a)) by (cbn; lia). apply neg_sound in h.
    pose proof (contains_positive _ _ n' h) as x0. split; [lra |].
    replace (/ x)%R with (- / (- x))%R by (field; lra).
    apply neg_sound, recip_positive_sound; assumption.
Qed.

Definition sqrt_ceil (n : Z) : Z := let r := Z.sqrt n in if r * r =? n then r else r + 1.

Definition root_positive (a : fixed) : fixed :=
  Fixed (Z.sqrt (Z.shiftl (lo a) (Zpos bits))) (sqrt_ceil (Z.shiftl (hi a) (Zpos bits))).

Definition root (a : fixed) : option fixed := if 0 <? lo a then Some (root_positive a) else None.

Lemma root_sound : forall a b x, root a = Some b -> contains a x ->
  (0 < x)%R /\ (0 < sqrt x)%R /\ contains b (sqrt x).
Proof.
  intros a b x e h. unfold root in e. destruct (0 <? lo a) eqn:p; [| discriminate]. injection e as <-.
  apply Z.ltb_lt in p. pose proof (contains_positive a x p h) as x0. destruct h as [l u].
  split; [exact x0 |]. split; [apply sqrt_lt_R0; exact x0 |].
  unfold contains, root_positive. cbn [lo hi]. rewrite !shiftl_unit. pose proof unit_R_pos as u0. pose proof unit_Z_pos as z0.
  pose proof (sqrt_sqrt x (Rlt_le _ _ x0)) as ss. pose proof (sqrt_pos x) as s0.
  set (y := (sqrt x * unit_R)%R). assert (y0 : (0 <= y)%R) by (apply Rmult_le_pos; lra).
  assert (E : (y * y = x * unit_R * unit_R)%R) by (unfold y; rewrite <- ss at 3; ring).
  assert (hi0 : 0 < hi a) by (apply IZR_lt in p; apply lt_IZR; lra).
  split.
  - pose proof (Z.sqrt_spec (lo a * unit_Z) ltac:(nia)) as [f _].
    pose proof (Z.sqrt_nonneg (lo a * unit_Z)) as r0. apply IZR_le in f, r0.
    rewrite !mult_IZR in f. fold unit_R in f. apply Rsqr_incr_0_var; [unfold Rsqr; nra | exact y0].
  - set (n := hi a * unit_Z).
    assert (F : forall r, 0 <= r -> n <= r * r -> (y <= IZR r)%R).
    { intros r r0 f. apply IZR_le in f, r0. unfold n in f. rewrite !mult_IZR in f. fold unit_R in f.
      apply Rsqr_incr_0_var; [unfold Rsqr; nra | exact r0]. }
    pose proof (Z.sqrt_spec n ltac:(unfold n; nia)) as [f g]. pose proof (Z.sqrt_nonneg n).
    unfold sqrt_ceil. destruct (Z.sqrt n * Z.sqrt n =? n) eqn:q; apply F; lia.
Qed.

Lemma contains_nonneg : forall a x, 0 <= lo a -> contains a x -> (0 <= x)%R.
Proof.
  intros a x h [l _]. apply IZR_le in h. pose proof unit_R_pos.
  apply Rmult_le_reg_r with unit_R; lra.
Qed.
End Precision.
