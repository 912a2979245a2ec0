(** * Positive definiteness of interval matrices of any size *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic.
Import ListNotations.
Local Open Scope R_scope.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

(** The upper triangle: row i holds the entries (i, i), (i, i + 1), ... *)
Definition triangle := list (list fixed).
Definition triangle_in (a : triangle) (S : list (list R)) : Prop := Forall2 (Forall2 contains) a S.

Definition triangle_add : triangle -> triangle -> triangle :=
  merge (fun r => r) (fun r => r) (merge (fun a => a) (fun a => a) add).

Lemma one_sound : forall i y, contains i y -> contains i (1 * y).
Proof. intros. rewrite Rmult_1_l. assumption. Qed.
Lemma map_one : forall r u, Forall2 contains r u -> Forall2 contains r (map (Rmult 1) u).
Proof. induction 1; cbn; constructor; auto using one_sound. Qed.

Lemma triangle_add_sound : forall a b S T, triangle_in a S -> triangle_in b T ->
  triangle_in (triangle_add a b) (tcomb 1 1 S T).
Proof.
  intros a b S T h k. eapply merge_related; try eassumption; try exact map_one.
  intros. eapply merge_related; try eassumption; try exact one_sound.
  intros. rewrite !Rmult_1_l. apply add_sound; assumption.
Qed.

(** ** Elimination, row by row: c_jk - (b_j / a) b_k *)

Fixpoint eliminate (a : fixed) (b : list fixed) (C : triangle) : triangle :=
  match b with
  | [] => C
  | b1 :: b' =>
      let part := ratio b1 (Fixed.integer bits 1) a in
      match C with
      | [] => map (fun y => neg (mul bits part y)) b :: eliminate a b' []
      | row :: C' =>
          merge (fun x => x) (fun y => neg (mul bits part y)) (fun x y => sub x (mul bits part y)) row b
            :: eliminate a b' C'
      end
  end.

Lemma eliminate_sound : forall a b x v C S, (0 < lo a)%Z -> contains a x -> Forall2 contains b v -> triangle_in C S ->
  triangle_in (eliminate a b C) (schur x v S).
Proof.
  intros a b x v C S p h hb. revert C S. induction hb as [| b1 v1 b v h1 hb IH]; intros C S hC; cbn [eliminate schur]; [exact hC |].
  set (part := ratio b1 (Fixed.integer bits 1) a).
  assert (K : forall i y, contains i y -> contains (mul bits part i) (v1 * / x * y)).
  { intros i y k. apply mul_sound; [| exact k]. replace (v1 * / x) with (v1 * 1 / x) by (unfold Rdiv; ring).
    apply ratio_sound; try assumption. apply Fixed.integer_sound. }
  assert (N : forall i y, contains i y -> contains (neg (mul bits part i)) (- (v1 * / x) * y))
    by (intros; rewrite Ropp_mult_distr_l_reverse; apply neg_sound, K; assumption).
  destruct hC as [| row u C S hr hC].
  - constructor; [| apply IH; constructor]. eapply map_related; [exact N |]. constructor; assumption.
  - constructor; [| apply IH; exact hC].
    eapply merge_related; try exact N; try exact one_sound; [| exact hr | constructor; eassumption].
    intros i y j z hi hj. replace (1 * y + - (v1 * / x) * z) with (y - v1 * / x * z) by ring.
    apply sub_sound; [| apply K]; assumption.
Qed.

(** The Schur complement of the first entry, if that is certainly positive. *)
Definition eliminated (S : triangle) : option triangle :=
  match S with (a :: b) :: C => if (0 <? lo a)%Z then Some (eliminate a b C) else None | _ => None end.

Lemma eliminated_sound : forall a b C t x u S, eliminated ((a :: b) :: C) = Some t ->
  contains a x -> Forall2 contains b u -> triangle_in C S -> 0 < x /\ triangle_in t (schur x u S).
Proof.
  intros a b C t x u S h hx hu hS. cbn [eliminated] in h. destruct (0 <? lo a)%Z eqn:p; [| discriminate].
  apply Z.ltb_lt in p. injection h as <-. split; [exact (contains_positive bits a x p hx) |].
  apply eliminate_sound; assumption.
Qed.

(** The fuel is the size. *)
Fixpoint eliminates (n : nat) (S : triangle) : bool :=
  match S, n with
  | [], _ => true
  | _, Datatypes.S n' => match eliminated S with Some t => eliminates n' t | None => false end
  | _, _ => false
  end.

Theorem eliminates_sound : forall n a S, eliminates n a = true -> triangle_in a S ->
  forall v, (length v <= length S)%nat -> nonzero v -> 0 < quad S v.
Proof.
  induction n as [| n IH]; intros a S h hS v len nz; destruct v as [| t w];
    try (unfold nonzero in nz; cbn in nz; lra); destruct hS as [| row u C S hr hC]; cbn in len; try lia;
    cbn [eliminates] in h; [discriminate |].
  destruct (eliminated (row :: C)) as [T |] eqn:e; [| discriminate].
  destruct hr as [| a1 x b u h1 hb]; [discriminate |].
  destruct (eliminated_sound a1 b C T x u S e h1 hb hC) as [x0 hT].
  cbn [quad row_form]. unfold nonzero in nz. cbn [dot] in nz.
  replace (x * t ^ 2 + 2 * t * dot u w + quad S w)
    with (x * (t + / x * dot u w) ^ 2 + (quad S w - / x * dot u w ^ 2)) by (field; lra).
  assert (0 <= x * (t + / x * dot u w) ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]).
  destruct (Rlt_le_dec 0 (dot w w)) as [p | z].
  - assert (0 < quad (schur x u S) w).
    { apply (IH T); try assumption. pose proof (schur_length x u S). lia. }
    rewrite quad_schur in * by lra. lra.
  - apply zero_vector in z. rewrite (dot_zero w u z), (quad_zero w S z) in *.
    rewrite (dot_zero w w z) in nz. replace (x * _ ^ 2 + _) with (x * (t * t)) by ring.
    apply Rmult_lt_0_compat; lra.
Qed.

(** ** Sign vertices (Hertz): the lower end of entry (i, j) where v_i and v_j
       have one sign, and the upper end elsewhere *)

Fixpoint ends (b : bool) (z : list bool) (row : list fixed) : list fixed :=
  match z, row with
  | c :: z', a :: row' => (if eqb b c then lower_end a else upper_end a) :: ends b z' row'
  | _, _ => []
  end.
Fixpoint sign_vertex (z : list bool) (S : triangle) : triangle :=
  match z, S with b :: z', row :: S' => ends b z row :: sign_vertex z' S' | _, _ => [] end.

(** [true] for numbers below zero. *)
Definition has_sign (b : bool) (t : R) : Prop := if b then t <= 0 else 0 <= t.

Lemma end_sound : forall b c a x s t, contains a x -> has_sign b s -> has_sign c t ->
  exists y, contains (if eqb b c then lower_end a else upper_end a) y /\ s * (y * t) <= s * (x * t).
Proof.
  intros b c a x s t h hs ht. destruct (lower_end_sound bits a x h) as [y [hy ly]].
  destruct (upper_end_sound bits a x h) as [z [hz lz]].
  assert (S : forall k, eqb b c = k -> if k then 0 <= s * t else s * t <= 0).
  { intros k e. destruct b, c; cbn in e; subst k; cbn in hs, ht; nra. }
  specialize (S _ eq_refl). destruct (eqb b c); [exists y | exists z]; split; try assumption; nra.
Qed.

Lemma ends_sound : forall b s, has_sign b s -> forall z w, Forall2 has_sign z w -> forall row r, Forall2 contains row r ->
  exists y, Forall2 contains (ends b z row) y /\ s * dot y w <= s * dot r w.
Proof.
  intros b s hs z w h. induction h as [| c t z w ht h IH]; intros row r hr; cbn [ends].
  - exists []. split; [constructor |]. destruct r; cbn; lra.
  - destruct hr as [| a x row r hx hr]; [exists []; split; [constructor | cbn; lra] |].
    destruct (IH row r hr) as [y [hy l]]. destruct (end_sound b c a x s t hx hs ht) as [y1 [h1 l1]].
    exists (y1 :: y). split; [constructor; assumption |]. cbn [dot]. lra.
Qed.

Lemma sign_vertex_sound : forall z v, Forall2 has_sign z v -> forall a S, triangle_in a S ->
  exists T, triangle_in (sign_vertex z a) T /\ quad T v <= quad S v /\ (length v <= length S -> length v <= length T)%nat.
Proof.
  intros z v h. induction h as [| b t z v ht h IH]; intros a S hS; cbn [sign_vertex].
  - exists []. split; [constructor |]. split; [destruct S; cbn; lra | cbn; lia].
  - destruct hS as [| row r a S hr hS]; [exists []; split; [constructor |]; split; [cbn; lra | cbn; lia] |].
    destruct (IH a S hS) as [T [hT [l len]]]. cbn [ends]. destruct hr as [| x r1 row r h1 hr].
    + exists ([] :: T). split; [constructor; [constructor | exact hT] |]. cbn. split; [lra | lia].
    + destruct (end_sound b b x r1 t t h1 ht ht) as [y1 [k1 l1]].
      destruct (ends_sound b t ht z v h row r hr) as [y [hy ly]].
      exists ((y1 :: y) :: T). split; [constructor; [constructor; assumption | exact hT] |].
      split; [cbn [quad row_form]; lra | cbn; lia].
Qed.

(** All lists of [n] signs. *)
Fixpoint signs (n : nat) : list (list bool) :=
  match n with O => [[]] | Datatypes.S k => map (cons false) (signs k) ++ map (cons true) (signs k) end.

Lemma signs_all : forall z, In z (signs (length z)).
Proof.
  induction z as [| b z IH]; cbn [signs length]; [left; reflexivity |].
  apply in_or_app. destruct b; [right | left]; apply in_map; exact IH.
Qed.

(** Elimination, or else elimination at each sign vertex: z and -z give the same. *)
Definition is_positive_definite (a : triangle) : bool :=
  let m := length a in
  if eliminates m a then true
  else forallb (fun z => eliminates m (sign_vertex (false :: z) a)) (signs (pred m)).

Lemma signs_of : forall v, exists z, Forall2 has_sign z v.
Proof.
  induction v as [| t v [z IH]]; [exists []; constructor |].
  destruct (Rle_lt_dec 0 t); [exists (false :: z) | exists (true :: z)]; constructor; cbn; try assumption; lra.
Qed.

Theorem is_positive_definite_sound : forall a S, is_positive_definite a = true -> triangle_in a S ->
  forall v, length v = length S -> nonzero v -> 0 < quad S v.
Proof.
  intros a S h hS v len nz. unfold is_positive_definite in h. cbn zeta in h.
  destruct (eliminates (length a) a) eqn:e; [apply (eliminates_sound _ _ _ e hS); [lia | exact nz] |].
  rewrite forallb_forall in h.
  assert (Pos : forall t w, length (t :: w) = length S -> nonzero (t :: w) -> 0 <= t -> 0 < quad S (t :: w)).
  { intros t w l n ht. destruct (signs_of w) as [z hz].
    destruct (sign_vertex_sound (false :: z) (t :: w) (Forall2_cons (R := has_sign) false t ht hz) a S hS) as [T [hT [q lT]]].
    assert (E : pred (length a) = length z).
    { rewrite (related_length _ _ _ _ _ hS), (related_length _ _ _ _ _ hz), <- l. reflexivity. }
    apply Rlt_le_trans with (quad T (t :: w)); [| exact q].
    apply (eliminates_sound (length a) (sign_vertex (false :: z) a)); try assumption; [| lia].
    apply h. rewrite E. apply signs_all. }
  destruct v as [| t w]; [unfold nonzero in nz; cbn in nz; lra |].
  destruct (Rle_lt_dec 0 t) as [p | n]; [apply Pos; assumption |].
  rewrite <- quad_opposite. cbn [map]. apply Pos; [rewrite <- len; cbn; rewrite map_length; reflexivity | | lra].
  unfold nonzero in *. rewrite <- (norm_opposite (t :: w)) in nz. exact nz.
Qed.
End Precision.
