(** * The numbers of a claim, enclosed

    A number with roots is enclosed by intervals with more bits than the
    checker's; a power of two is the unit of lengths, so that the integers of
    a check have one size whatever the claim's unit. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Arithmetic.
From Orthocert.kernel Require Slope.
Import ListNotations.
Local Open Scope R_scope.

Fixpoint varies (x : number) : bool :=
  match x with
  | Ratio _ _ => false
  | Varying _ _ _ => true
  | Plus x y | Minus x y | Times x y | Over x y => varies x || varies y
  | Root x => varies x
  end.

(** The same expression. *)
Fixpoint same (x y : number) : bool :=
  match x, y with
  | Ratio n d, Ratio n' d' => (n =? n')%Z && (d =? d')%positive
  | Varying k a b, Varying k' a' b' => Nat.eqb k k' && (Qnum a =? Qnum a')%Z && (Qden a =? Qden a')%positive && (Qnum b =? Qnum b')%Z && (Qden b =? Qden b')%positive
  | Plus a b, Plus a' b' | Minus a b, Minus a' b' | Times a b, Times a' b' | Over a b, Over a' b' => same a a' && same b b'
  | Root a, Root a' => same a a'
  | _, _ => false
  end.

Lemma same_sound : forall x y, same x y = true -> x = y.
Proof.
  induction x as [n d | i [n d] [n' d'] | x hx y hy | x hx y hy | x hx y hy | x hx y hy | x hx]; intros [m e | j [m e] [m' e'] | | | | |] h; cbn [same Qnum Qden] in h; try discriminate;
    repeat match goal with k : _ && _ = true |- _ => apply andb_true_iff in k as [k ?] end;
    repeat match goal with
    | k : (_ =? _)%Z = true |- _ => apply Z.eqb_eq in k
    | k : (_ =? _)%positive = true |- _ => apply Pos.eqb_eq in k
    | k : Nat.eqb _ _ = true |- _ => apply Nat.eqb_eq in k
    end; subst; f_equal; auto.
Qed.

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
Local Notation contains := (contains bits).

(** A root of what may be zero: of its part from zero on. *)
Definition root_from_zero (a : fixed) : option fixed :=
  if (0 <? hi a)%Z then option_map (fun b => Fixed 0 (hi b)) (root bits (Fixed (hi a) (hi a))) else if (hi a =? 0)%Z then Some zero else None.
Lemma root_from_zero_sound : forall a b x, root_from_zero a = Some b -> contains a x -> contains b (sqrt x).
Proof.
  intros a b x e [_ u]. pose proof (unit_R_pos bits) as u0. unfold root_from_zero in e. destruct (0 <? hi a)%Z.
  - destruct (root bits (Fixed (hi a) (hi a))) as [r |] eqn:er; [| discriminate]. cbn [option_map] in e. injection e as <-.
    set (w := IZR (hi a) / unit_R bits). assert (ew : w * unit_R bits = IZR (hi a)) by (unfold w; field; lra).
    assert (W : contains (Fixed (hi a) (hi a)) w) by (split; cbn [lo hi]; lra).
    destruct (root_sound bits _ _ _ er W) as [_ [_ [_ k]]]. split; cbn [lo hi]; [pose proof (Rmult_le_pos _ _ (sqrt_pos x) (Rlt_le _ _ u0)); lra |].
    apply Rle_trans with (2 := k), Rmult_le_compat_r; [lra |]. apply sqrt_le_1_alt. apply Rmult_le_reg_r with (unit_R bits); lra.
  - destruct (hi a =? 0)%Z eqn:z; [| discriminate]. injection e as <-. apply Z.eqb_eq in z. rewrite z in u.
    rewrite sqrt_neg_0 by nra. apply zero_sound.
Qed.
Definition is_negative_fraction (x : number) : bool := match rational x with Some q => negb (Qle_bool 0 q) | None => false end.

(** Of numbers that do not vary. *)
Fixpoint steady (x : number) : option fixed :=
  match x with
  | Ratio n d => Some (Fixed.ratio bits n d)
  | Varying _ _ _ => None
  | Plus x y => match steady x, steady y with Some a, Some b => Some (add a b) | _, _ => None end
  | Minus x y => match steady x, steady y with Some a, Some b => Some (sub a b) | _, _ => None end
  | Times x y => match steady x, steady y with Some a, Some b => Some (mul bits a b) | _, _ => None end
  | Over x y =>
      match steady x, steady y with
      | Some a, Some b => match recip bits b with Some c => Some (mul bits a c) | None => None end
      | _, _ => None
      end
  | Root x => match steady x with
      | Some a => if (0 <? lo a)%Z then root bits a else if is_negative_fraction x then None else root_from_zero a
      | None => None
      end
  end.

Lemma steady_sound : forall x a, steady x = Some a -> contains a (value x).
Proof.
  induction x as [n d | k p q | x hx y hy | x hx y hy | x hx y hy | x hx y hy | x hx]; intros a h; cbn [steady] in h.
  - assert (e : Fixed.ratio bits n d = a) by congruence. subst a. apply Fixed.ratio_sound.
  - discriminate.
  - destruct (steady x) as [b |], (steady y) as [c |]; try discriminate.
    assert (e : add b c = a) by congruence. subst a. apply add_sound; auto.
  - destruct (steady x) as [b |], (steady y) as [c |]; try discriminate.
    assert (e : sub b c = a) by congruence. subst a. apply sub_sound; auto.
  - destruct (steady x) as [b |], (steady y) as [c |]; try discriminate.
    assert (e : mul bits b c = a) by congruence. subst a. apply mul_sound; auto.
  - destruct (steady x) as [b |], (steady y) as [c |]; try discriminate.
    destruct (recip bits c) as [d |] eqn:r; [| discriminate].
    assert (e : mul bits b d = a) by congruence. subst a. apply mul_sound; [auto |].
    apply (recip_sound bits c); auto.
  - destruct (steady x) as [b |]; [| discriminate]. destruct (0 <? lo b)%Z; [apply (root_sound bits b); auto |].
    destruct (is_negative_fraction x); [discriminate |]. apply (root_from_zero_sound b); auto.
Qed.

(** The others by their slopes in what varies, so that what cancels does: parameter [k] is half its range's width times
    lambda_k from the middle. *)
Definition most_parameters : nat := 3.
Definition ratio_of (q : Q) : fixed := Fixed.ratio bits (Qnum q) (Qden q).
Definition coordinate (k : nat) (a b : Q) : Slope.slope :=
  Slope.Slope (ratio_of ((a + b) * (1 # 2))) (Fixed (lo (ratio_of a)) (hi (ratio_of b))) (repeat zero k ++ [ratio_of ((b - a) * (1 # 2))]).

Fixpoint sloped_by (coordinate : nat -> Q -> Q -> option Slope.slope) (x : number) : option Slope.slope :=
  let own := sloped_by coordinate in
  if varies x then
    match x with
    | Ratio _ _ => None
    | Varying k a b => coordinate k a b
    | Plus x y => Slope.lift2 (fun f g => Some (Slope.s_add f g)) (own x) (own y)
    | Minus x y => Slope.lift2 (fun f g => Some (Slope.s_sub f g)) (own x) (own y)
    | Times x y => if same x y then Slope.lift (fun f => Some (Slope.s_sqr bits f)) (own x)
        else Slope.lift2 (fun f g => Some (Slope.s_mul bits f g)) (own x) (own y)
    | Over x y => Slope.lift2 (Slope.s_div bits) (own x) (own y)
    | Root x => Slope.lift (Slope.s_sqrt bits) (own x)
    end
  else option_map Slope.constant (steady x).
Definition sloped : number -> option Slope.slope :=
  sloped_by (fun k a b => if Nat.ltb k most_parameters && Qle_bool a b then Some (coordinate k a b) else None).

Definition enclose (x : number) : option fixed := if varies x then option_map Slope.range (sloped x) else steady x.

Definition halfway : naming.
Proof. refine {| along := fun _ => 1 / 2 |}. intros _. lra. Defined.
Definition lambdas_of (n : nat) : list R := map (fun k => 2 * along k - 1) (seq 0 n).
Definition lambdas : list R := lambdas_of most_parameters.

Lemma lambdas_within : forall n, Forall (fun t => -1 <= t <= 1) (lambdas_of n).
Proof. intro n. apply Forall_map, Forall_forall. intros k _. pose proof (along_within k). lra. Qed.

Lemma steady_value : forall x other, varies x = false -> @value other x = @value names x.
Proof.
  induction x as [n d | k p q | x hx y hy | x hx y hy | x hx y hy | x hx y hy | x hx]; intros other h; cbn [varies] in h; try discriminate;
    try (apply orb_false_iff in h as [h k]); cbn [value]; rewrite ?hx, ?hy by assumption; reflexivity.
Qed.

Lemma ratio_of_sound : forall q, contains (ratio_of q) (Q2R q).
Proof. intros [n d]. apply Fixed.ratio_sound. Qed.

Lemma coordinate_holds : forall n k a b, (k < n)%nat -> Q2R a <= Q2R b ->
  Slope.holds bits (lambdas_of n) (coordinate k a b) (@value halfway (Varying k a b)) (value (Varying k a b)).
Proof.
  intros n k a b hk le. pose proof (along_within k) as W. cbn [value along halfway]. split; [| split]; unfold coordinate; cbn [Slope.at_c Slope.range Slope.slopes].
  - replace (Q2R a + 1 / 2 * (Q2R b - Q2R a)) with (Q2R ((a + b) * (1 # 2))); [apply ratio_of_sound |].
    rewrite Qreals.Q2R_mult, Qreals.Q2R_plus. unfold Q2R at 3. cbn. field.
  - pose proof (ratio_of_sound a) as [l _]. pose proof (ratio_of_sound b) as [_ u]. pose proof (unit_R_pos bits) as p.
    assert (Q2R a <= Q2R a + along k * (Q2R b - Q2R a) <= Q2R b) as [g1 g2] by nra.
    apply (Rmult_le_compat_r (unit_R bits)) in g1, g2; try lra. unfold Fixed.contains. cbn [lo hi]. lra.
  - exists (repeat 0 k ++ [Q2R ((b - a) * (1 # 2))]). split.
    + apply Forall2_app; [clear; induction k; cbn; constructor; auto using zero_sound | constructor; [apply ratio_of_sound | constructor]].
    + assert (D : forall j h l, Linear.dot (repeat 0 j ++ [h]) l = h * nth j l 0) by (induction j as [| j IH]; intros h [| t l]; cbn [repeat app Linear.dot nth]; try rewrite IH; ring).
      rewrite D. replace (nth k (lambdas_of n) 0) with (2 * along k - 1).
      * rewrite Qreals.Q2R_mult, Qreals.Q2R_minus. replace (Q2R (1 # 2)) with (/ 2) by (unfold Q2R; cbn; lra). lra.
      * unfold lambdas_of. rewrite (nth_indep _ 0 (2 * along 0%nat - 1)) by (rewrite map_length, seq_length; exact hk).
        rewrite (map_nth (fun k => 2 * along k - 1)), seq_nth by exact hk. reflexivity.
Qed.

(** Between two values of what varies, of which the slopes of each coordinate tell. *)
Lemma sloped_by_sound : forall coordinate lambda (one other : naming), Forall (fun t => -1 <= t <= 1) lambda ->
  (forall k a b s, coordinate k a b = Some s -> Slope.holds bits lambda s (@value one (Varying k a b)) (@value other (Varying k a b))) ->
  forall x s, sloped_by coordinate x = Some s -> Slope.holds bits lambda s (@value one x) (@value other x).
Proof.
  intros coordinate lambda one other within_ holds_.
  assert (C : forall x s, varies x = false -> option_map Slope.constant (steady x) = Some s -> Slope.holds bits lambda s (@value one x) (@value other x)).
  { intros x s v h. destruct (steady x) as [a |] eqn:e; [| discriminate]. injection h as <-. rewrite (steady_value x one v), (steady_value x other v).
    apply Slope.constant_holds, steady_sound, e. }
  assert (L : forall f a s, Slope.lift f a = Some s -> exists t : Slope.slope, a = Some t /\ f t = Some s)
    by (intros f [t |] s h; [exists t; split; [reflexivity | exact h] | discriminate]).
  assert (L2 : forall f a b s, Slope.lift2 f a b = Some s -> exists t u : Slope.slope, a = Some t /\ b = Some u /\ f t u = Some s)
    by (intros f [t |] [u |] s h; try discriminate; exists t, u; split; [reflexivity | split; [reflexivity | exact h]]).
  induction x as [n d | k p q | x hx y hy | x hx y hy | x hx y hy | x hx y hy | x hx]; intros s h; cbn [sloped_by] in h; cbv zeta in h;
    match type of h with (if varies ?z then _ else _) = _ => destruct (varies z) eqn:v; [| exact (C _ s v h)] end.
  - discriminate.
  - exact (holds_ k p q s h).
  - destruct (L2 _ _ _ _ h) as [t [u [e1 [e2 e]]]]. injection e as <-. exact (Slope.s_add_holds bits _ within_ _ _ _ _ _ _ (hx _ e1) (hy _ e2)).
  - destruct (L2 _ _ _ _ h) as [t [u [e1 [e2 e]]]]. injection e as <-. exact (Slope.s_sub_holds bits _ within_ _ _ _ _ _ _ (hx _ e1) (hy _ e2)).
  - destruct (same x y) eqn:S.
    + apply same_sound in S. subst y. destruct (L _ _ _ h) as [t [e1 e]]. injection e as <-. cbn [value].
      replace (@value one x * @value one x) with (@value one x ^ 2) by ring. replace (@value other x * @value other x) with (@value other x ^ 2) by ring.
      exact (Slope.s_sqr_holds bits _ within_ _ _ _ (hx _ e1)).
    + destruct (L2 _ _ _ _ h) as [t [u [e1 [e2 e]]]]. injection e as <-. exact (Slope.s_mul_holds bits _ within_ _ _ _ _ _ _ (hx _ e1) (hy _ e2)).
  - destruct (L2 _ _ _ _ h) as [t [u [e1 [e2 e]]]]. exact (proj2 (proj2 (Slope.s_div_holds bits _ within_ _ _ _ _ _ _ _ e (hx _ e1) (hy _ e2)))).
  - destruct (L _ _ _ h) as [t [e1 e]]. exact (proj2 (proj2 (Slope.s_sqrt_holds bits _ within_ _ _ _ _ e (hx _ e1)))).
Qed.

Lemma sloped_sound : forall x s, sloped x = Some s -> Slope.holds bits lambdas s (@value halfway x) (value x).
Proof.
  apply sloped_by_sound; [exact (lambdas_within _) |]. intros k a b s h. destruct (Nat.ltb k most_parameters) eqn:hk; [| discriminate]. destruct (Qle_bool a b) eqn:le; [| discriminate].
  injection h as <-. apply coordinate_holds; [apply Nat.ltb_lt, hk | apply Qreals.Qle_Rle, Qle_bool_iff, le].
Qed.

Lemma enclose_sound : forall x a, enclose x = Some a -> contains a (value x).
Proof.
  intros x a h. unfold enclose in h. destruct (varies x); [| exact (steady_sound x a h)].
  destruct (sloped x) as [s |] eqn:e; [| discriminate]. injection h as <-. exact (proj1 (proj2 (sloped_sound x s e))).
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

(** What is found with so many more bits, over 2^s. *)
Definition cut (s : Z) (a : fixed) : fixed := Fixed (shifted (lo a) (cut_off s)) (- shifted (- hi a) (cut_off s)).
Lemma cut_sound : forall s b x, Fixed.contains (bits + guard s) b x -> contains (cut s b) (x / two_to s).
Proof.
  intros s b x [l u].
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
  rewrite E in l, u. unfold Fixed.contains, cut. cbn [lo hi]. fold places.
  pose proof (shifted_sound (lo b) places) as A. pose proof (shifted_sound (- hi b) places) as B.
  rewrite opp_IZR in B |- *. replace (x / two_to s * unit_R bits) with (x * (unit_R bits / two_to s)) by (field; lra).
  set (w := IZR (2 ^ Z.of_N places)) in *. set (y := unit_R bits / two_to s) in *. clearbody w y.
  split; apply Rmult_le_reg_r with w; lra.
Qed.

(** [x / 2^s] *)
Definition enclose_scaled (s : Z) (x : number) : option fixed := option_map (cut s) (enclose (bits + guard s) x).
Lemma enclose_scaled_sound : forall s x a, enclose_scaled s x = Some a -> contains a (value x / two_to s).
Proof.
  intros s x a h. unfold enclose_scaled in h. destruct (enclose (bits + guard s) x) as [b |] eqn:e; [| discriminate].
  injection h as <-. apply cut_sound, enclose_sound, e.
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
End Named.
