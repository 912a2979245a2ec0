(** * Cosines and sines of angles in degrees, enclosed

    The cosine by its series up to 2, beyond by doubling; pi by the sign of the
    cosine at the half of two numbers, which may be any. *)

From Coq Require Import ZArith Reals Lra Lia Bool.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Arithmetic Number.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.

Definition in_degrees (x : R) : R := x * PI / 180.

(** Ends with more places than wanted, rounded outward. *)
Definition shortened (places : N) (a : fixed) : fixed := Fixed (shifted (lo a) places) (- shifted (- hi a) places).

Lemma shortened_sound : forall bits g a x, contains (bits + g) a x -> contains bits (shortened (Npos g) a) x.
Proof.
  intros bits g a x [l u]. pose proof (shifted_sound (lo a) (Npos g)) as A. pose proof (shifted_sound (- hi a) (Npos g)) as B.
  assert (E : unit_R (bits + g) = unit_R bits * IZR (2 ^ Z.of_N (Npos g))).
  { unfold unit_R, unit_Z. rewrite Pos2Z.inj_add, Z.pow_add_r, mult_IZR by lia. reflexivity. }
  rewrite E in l, u. pose proof (two_power (Npos g)) as p. unfold contains, shortened. cbn [lo hi]. rewrite opp_IZR in B |- *.
  set (w := IZR (2 ^ Z.of_N (Npos g))) in *. clearbody w. split; apply Rmult_le_reg_r with w; lra.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

(** [a / d] *)
Definition over (a : fixed) (d : positive) : fixed := Fixed (lo a / Zpos d) (div_ceil (hi a) (Zpos d)).

Lemma over_sound : forall a d x, contains a x -> contains (over a d) (x / IZR (Zpos d)).
Proof.
  intros a d x [l u]. unfold Fixed.contains, over. cbn [lo hi]. assert (d0 : 0 < IZR (Zpos d)) by (apply IZR_lt, Pos2Z.is_pos).
  pose proof (div_floor_sound (lo a) (Zpos d) (Pos2Z.is_pos d)). pose proof (div_ceil_sound (hi a) (Zpos d) (Pos2Z.is_pos d)).
  assert (E : x / IZR (Zpos d) * unit_R bits * IZR (Zpos d) = x * unit_R bits) by (field; lra).
  split; apply Rmult_le_reg_r with (IZR (Zpos d)); lra.
Qed.

(** ** The cosine's series: y^n/(2n)! and the sum up to there, for y = a^2 *)

(** From what is of m to what is of m + 1, whose term is divided by (2m + 1)(2m + 2). *)
Definition next (y : fixed) (m : nat) (p : fixed * fixed) : fixed * fixed :=
  let (t, sum) := p in let k := Pos.of_succ_nat m in
  let t' := over (mul bits t y) (Pos.pred_double k * k~0) in
  (t', if Nat.even m then sub sum t' else add sum t').
Fixpoint series (y : fixed) (n : nat) : fixed * fixed :=
  match n with
  | O => (Fixed.integer bits 1, Fixed.integer bits 1)
  | S m => next y m (series y m)
  end.

Lemma power_sign : forall n, (-1) ^ n = if Nat.even n then 1 else -1.
Proof.
  induction n as [| n IH]; [reflexivity |]. rewrite Nat.even_succ, <- Nat.negb_even. cbn [pow]. rewrite IH.
  destruct (Nat.even n); cbn [negb]; ring.
Qed.

Lemma series_sound : forall y a n, contains y (a ^ 2) ->
  contains (fst (series y n)) (a ^ (2 * n) / INR (fact (2 * n))) /\ contains (snd (series y n)) (cos_approx a n).
Proof.
  intros y a n h. induction n as [| m [IH1 IH2]].
  - split; cbn [series fst snd]; [replace (a ^ (2 * 0) / INR (fact (2 * 0))) with 1 by (cbn; field)
      | replace (cos_approx a 0) with 1 by (unfold cos_approx, cos_term; cbn; field)]; apply (Fixed.integer_sound bits 1).
  - cbn [series]. destruct (series y m) as [t sum]. cbn [next fst snd] in *.
    assert (D : (Pos.pred_double (Pos.of_succ_nat m) * (Pos.of_succ_nat m)~0 = Pos.of_succ_nat (2 * m) * Pos.of_succ_nat (2 * m + 1))%positive) by (f_equal; lia).
    rewrite D. set (d := (Pos.of_succ_nat (2 * m) * Pos.of_succ_nat (2 * m + 1))%positive).
    assert (E : a ^ (2 * S m) / INR (fact (2 * S m)) = a ^ (2 * m) / INR (fact (2 * m)) * a ^ 2 / IZR (Zpos d)).
    { replace (2 * S m)%nat with (S (S (2 * m))) by lia. rewrite !fact_simpl, !mult_INR. unfold d.
      rewrite Pos2Z.inj_mul, mult_IZR, !Zpos_P_of_succ_nat, <- !Nat2Z.inj_succ, <- !INR_IZR_INZ. replace (2 * m + 1)%nat with (S (2 * m)) by lia.
      cbn [pow]. pose proof (INR_fact_neq_0 (2 * m)). pose proof (not_0_INR (S (2 * m)) ltac:(lia)).
      pose proof (not_0_INR (S (S (2 * m))) ltac:(lia)). field. auto. }
    assert (T : contains (over (mul bits t y) d) (a ^ (2 * S m) / INR (fact (2 * S m))))
      by (rewrite E; apply over_sound, mul_sound; assumption).
    split; [exact T |]. unfold cos_approx. cbn [sum_f_R0]. fold (cos_approx a m). unfold cos_term. rewrite power_sign.
    rewrite Nat.even_succ, <- Nat.negb_even. destruct (Nat.even m); cbn [negb]; [| rewrite Rmult_1_l; apply add_sound; assumption].
    replace (cos_approx a m + -1 * (a ^ (2 * S m) / INR (fact (2 * S m))))
      with (cos_approx a m - a ^ (2 * S m) / INR (fact (2 * S m))) by ring. apply sub_sound; assumption.
Qed.

(** Terms that are enough for so many bits. *)
Definition terms : nat := 16 + Pos.to_nat bits / 8.

(** cos a by a^2, for |a| <= 2. *)
Definition cos_below_two (y : fixed) : option fixed :=
  if (hi y <=? 4 * unit_Z bits)%Z
  then let n := (2 * terms + 1)%nat in let p := series y n in Some (Fixed (lo (snd p)) (hi (snd (next y n p)))) else None.

Lemma cos_below_two_sound : forall y a c, cos_below_two y = Some c -> contains y (a ^ 2) -> contains c (cos a).
Proof.
  intros y a c e h. unfold cos_below_two in e. destruct (hi y <=? _)%Z eqn:b; [| discriminate].
  cbv zeta in e. change (next y (2 * terms + 1) (series y (2 * terms + 1))) with (series y (S (2 * terms + 1))) in e.
  replace (S (2 * terms + 1)) with (2 * (terms + 1))%nat in e by lia.
  assert (E : Fixed (lo (snd (series y (2 * terms + 1)))) (hi (snd (series y (2 * (terms + 1))))) = c) by congruence. subst c. clear e.
  apply Z.leb_le, IZR_le in b. rewrite mult_IZR in b. pose proof (unit_R_pos bits) as u. fold (unit_R bits) in b.
  assert (a ^ 2 <= 4) by (destruct h as [_ h]; apply Rmult_le_reg_r with (unit_R bits); lra).
  destruct (pre_cos_bound a terms ltac:(apply Rnot_lt_le; intro; nra) ltac:(apply Rnot_lt_le; intro; nra)) as [l m].
  destruct (series_sound y a (2 * terms + 1) h) as [_ [L _]]. destruct (series_sound y a (2 * (terms + 1)) h) as [_ [_ M]].
  split; [apply Rle_trans with (1 := L) | apply Rle_trans with (2 := M)]; (apply Rmult_le_compat_r; [lra | assumption]).
Qed.

(** ** pi *)

(** 2^bits atan(1/n), nearly: Machin's formula gives numbers to try. *)
Fixpoint atan_inverse (steps : nat) (n power sum odd : Z) : Z :=
  match steps with
  | O => sum
  | S k => atan_inverse k n (- (power / (n * n))) (sum + power / odd) (odd + 2)
  end.
Definition pi_nearly : Z :=
  let atan n := atan_inverse (Pos.to_nat bits) n (unit_Z bits / n) 0 1 in (16 * atan 5 - 4 * atan 239)%Z.

(** The cosine of the half of [p] over [2^bits]. *)
Definition cos_half (p : Z) : option fixed := if (0 <=? p)%Z then cos_below_two (over (sqr bits (Fixed p p)) 4) else None.

Lemma cos_half_sound : forall p c, cos_half p = Some c ->
  0 <= IZR p / unit_R bits / 2 <= 2 /\ contains c (cos (IZR p / unit_R bits / 2)).
Proof.
  intros p c h. unfold cos_half in h. destruct (0 <=? p)%Z eqn:p0; [| discriminate]. apply Z.leb_le, IZR_le in p0.
  pose proof (unit_R_pos bits) as u. set (x := IZR p / unit_R bits).
  assert (x0 : 0 <= x) by (unfold x; apply Rmult_le_pos; [exact p0 | apply Rlt_le, Rinv_0_lt_compat, u]).
  assert (C : contains (over (sqr bits (Fixed p p)) 4) ((x / 2) ^ 2)).
  { replace ((x / 2) ^ 2) with (x ^ 2 / 4) by field. apply over_sound, sqr_sound, point_sound. }
  split; [| exact (cos_below_two_sound _ _ _ h C)]. unfold cos_below_two in h. destruct (hi _ <=? _)%Z eqn:b; [| discriminate].
  apply Z.leb_le, IZR_le in b. rewrite mult_IZR in b. fold (unit_R bits) in b. destruct C as [_ C].
  assert ((x / 2) ^ 2 <= 4) by (apply Rmult_le_reg_r with (unit_R bits); lra). split; [lra | apply Rnot_lt_le; intro; nra].
Qed.

Definition pi : option fixed :=
  let a := (pi_nearly - 4096)%Z in let b := (pi_nearly + 4096)%Z in
  match cos_half a, cos_half b with
  | Some p, Some n => if (0 <? lo p)%Z && (hi n <? 0)%Z then Some (Fixed a b) else None
  | _, _ => None
  end.

Lemma pi_sound : forall p, pi = Some p -> contains p PI.
Proof.
  intros p h. unfold pi in h. cbv zeta in h. set (a := (pi_nearly - 4096)%Z) in *. set (b := (pi_nearly + 4096)%Z) in *.
  destruct (cos_half a) as [c |] eqn:ea; [| discriminate]. destruct (cos_half b) as [d |] eqn:eb; [| discriminate].
  destruct ((0 <? lo c)%Z && (hi d <? 0)%Z) eqn:s; [| discriminate]. assert (E : Fixed a b = p) by congruence. subst p. clear h.
  apply andb_true_iff in s as [s1 s2]. apply Z.ltb_lt in s1. apply Z.ltb_lt, IZR_lt in s2.
  destruct (cos_half_sound _ _ ea) as [[a0 a2] ca]. destruct (cos_half_sound _ _ eb) as [[b0 b2] [_ cb]].
  pose proof (unit_R_pos bits) as u. pose proof pi2_int as pi0. assert (pi1 : PI = 2 * PI2) by reflexivity. pose proof (contains_positive bits _ _ s1 ca) as pa.
  assert (lower : IZR a / unit_R bits / 2 < PI / 2) by (apply Rnot_le_lt; intro n; pose proof (cos_le_0 _ n ltac:(lra)); lra).
  assert (nb : cos (IZR b / unit_R bits / 2) < 0) by (apply Rmult_lt_reg_r with (unit_R bits); lra).
  assert (upper : PI / 2 < IZR b / unit_R bits / 2) by (apply Rnot_le_lt; intro n; pose proof (cos_ge_0 (IZR b / unit_R bits / 2) ltac:(lra) n); lra).
  unfold Fixed.contains. cbn [lo hi]. assert (K : forall z, IZR z / unit_R bits * unit_R bits = IZR z) by (intro; field; lra).
  split; [rewrite <- (K a) | rewrite <- (K b)]; apply Rmult_le_compat_r; lra.
Qed.

(** ** Angles in degrees *)

Definition doubled (c : fixed) : fixed := let s := sqr bits c in sub (add s s) (Fixed.integer bits 1).

Lemma doubled_sound : forall c a, contains c (cos a) -> contains (doubled c) (cos (2 * a)).
Proof.
  intros c a h. rewrite cos_2a_cos. unfold doubled. cbv zeta.
  replace (2 * cos a * cos a - 1) with (cos a ^ 2 + cos a ^ 2 - 1) by ring.
  apply sub_sound; [apply add_sound; apply sqr_sound, h | apply (Fixed.integer_sound bits 1)].
Qed.

Definition cos_of (degrees : fixed) : option fixed :=
  match pi with
  | Some p => option_map (fun c => doubled (doubled c)) (cos_below_two (sqr bits (over (mul bits degrees p) 720)))
  | None => None
  end.

Lemma cos_of_sound : forall d x c, cos_of d = Some c -> contains d x -> contains c (cos (in_degrees x)).
Proof.
  intros d x c h hd. unfold cos_of in h. destruct pi as [p |] eqn:ep; [| discriminate].
  destruct (cos_below_two _) as [e |] eqn:ec; [| discriminate]. injection h as <-.
  replace (in_degrees x) with (2 * (2 * (x * PI / 720))) by (unfold in_degrees; field).
  apply doubled_sound, doubled_sound, (cos_below_two_sound _ _ _ ec), sqr_sound, over_sound, mul_sound; [exact hd | apply pi_sound, ep].
Qed.
End Precision.

Definition cosine (bits : positive) (degrees : number) : option fixed :=
  match enclose (bits + 64) degrees with
  | Some d => option_map (shortened 64) (cos_of (bits + 64) d)
  | None => None
  end.
Definition radians (bits : positive) (degrees : fixed) : option fixed :=
  option_map (fun p => over (mul bits degrees (shortened 64 p)) 180) (pi (bits + 64)).
(** The sine of an angle is the cosine of 90 degrees less. *)
Definition sine (bits : positive) (degrees : number) : option fixed := cosine bits (Minus degrees (90 // 1)).

Lemma cosine_sound : forall bits x c, cosine bits x = Some c -> contains bits c (cos (in_degrees (value x))).
Proof.
  intros bits x c h. unfold cosine in h. destruct (enclose (bits + 64) x) as [d |] eqn:e; [| discriminate].
  destruct (cos_of (bits + 64) d) as [c' |] eqn:ec; [| discriminate]. injection h as <-.
  apply shortened_sound, (cos_of_sound _ _ _ _ ec), enclose_sound, e.
Qed.

Lemma radians_sound : forall bits d x r, radians bits d = Some r -> contains bits d x -> contains bits r (in_degrees x).
Proof.
  intros bits d x r h hd. unfold radians in h. destruct (pi (bits + 64)) as [p |] eqn:e; [| discriminate]. injection h as <-.
  apply over_sound, mul_sound; [exact hd | apply shortened_sound, pi_sound, e].
Qed.

(** Every cosine is that of an angle up to half a turn. *)
Lemma cosine_taken : forall C, -1 <= C <= 1 -> exists d, 0 <= d <= PI /\ cos d = C.
Proof.
  intros C C1. pose proof PI_RGT_0 as p0. destruct (IVT_cor (fun t => C - cos t) 0 PI) as [d [d0 dz]].
  - apply continuity_minus; [apply continuity_const; intros y z; reflexivity | exact continuity_cos].
  - lra.
  - rewrite cos_0, cos_PI. nra.
  - exists d. split; [exact d0 | lra].
Qed.

Lemma sine_sound : forall bits x c, sine bits x = Some c -> contains bits c (sin (in_degrees (value x))).
Proof.
  intros bits x c h. apply cosine_sound in h. cbn [value] in h. rewrite <- cos_shift, <- cos_neg.
  replace (- (PI / 2 - in_degrees (value x))) with (in_degrees (value x - 90 / 1)) by (unfold in_degrees; field). exact h.
Qed.
End Named.
