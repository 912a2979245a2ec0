(** * A point with given values: Newton's method with one matrix

    Of as many numbers as coordinates, each of which is anywhere in its range: with
    x_k = (a_k + b_k)/2 + u_k (b_k - a_k)/2, the map u - C F(x) contracts the ball
    |u| <= 1 into itself where its slopes between all two points of the box, and
    what it is at the centre, are at most a half. At its fixed point C F = 0, and
    C is regular, as the slopes of C F are. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Linear Arithmetic Number Solve Twofold.
From Orthocert.kernel Require Slope Cell.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** The coordinates, those of what varies. *)
Definition part_at (u : list R) (k : nat) : R := Rmax 0 (Rmin 1 ((1 + nth k u 0) / 2)).
Lemma part_within : forall u k, 0 <= part_at u k <= 1.
Proof. intros u k. unfold part_at, Rmax, Rmin. repeat destruct (Rle_dec _ _); lra. Qed.
Definition spot (u : list R) : naming := {| Claim.along := part_at u; Claim.along_within := part_within u |}.
Lemma part_is : forall u k, size u <= 1 -> part_at u k = (1 + nth k u 0) / 2.
Proof.
  intros u k h. pose proof (norm_entry (length u) u k) as e. unfold norm, part in e. rewrite firstn_all, skipn_all in e.
  unfold size at 2 in e. cbn [dot] in e. rewrite sqrt_0, Rmax_left in e by apply size_nonneg.
  pose proof (Rle_abs (nth k u 0)). pose proof (Rle_abs (- nth k u 0)) as a. rewrite Rabs_Ropp in a.
  unfold part_at. rewrite Rmin_right, Rmax_right; lra.
Qed.

Lemma size_nought : forall n, size (nought n) = 0.
Proof. intro n. unfold size. rewrite dot_zero; [apply sqrt_0 | unfold nought; clear; induction n; constructor; auto]. Qed.
Lemma nothing : forall n v, length v = n -> size v <= 0 -> v = nought n.
Proof. intros n v l h. apply zeros_nought; [exact l |]. rewrite <- size_square. pose proof (size_nonneg v). replace (size v) with 0 by lra. lra. Qed.
Lemma whole_norm : forall n v, length v = n -> norm n v = size v.
Proof.
  intros n v <-. unfold norm, part. rewrite firstn_all, skipn_all. unfold size at 2. cbn [dot]. rewrite sqrt_0. apply Rmax_left, size_nonneg.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

(** ** Coordinates as slopes: at the centre; and of any two points *)

Definition at_centre (k : nat) (a b : Q) : option Slope.slope := Some (Slope.constant (ratio_of bits ((a + b) * (1 # 2)))).
Definition anywhere (n k : nat) (a b : Q) : option Slope.slope :=
  if Nat.ltb k n && Qle_bool a b then
    let r := Fixed (lo (ratio_of bits a)) (hi (ratio_of bits b)) in Some (Slope.Slope r r (repeat zero k ++ [ratio_of bits (b - a)]))
  else None.

Lemma centre_holds : forall n k a b s, at_centre k a b = Some s -> Slope.holds bits [] s (@value (spot (nought n)) (Varying k a b)) (@value (spot (nought n)) (Varying k a b)).
Proof.
  intros n k a b s h. injection h as <-. apply Slope.constant_holds. cbn [value Claim.along spot].
  rewrite part_is by (rewrite size_nought; lra). rewrite nought_entries.
  replace (Q2R a + (1 + 0) / 2 * (Q2R b - Q2R a)) with (Q2R ((a + b) * (1 # 2))); [apply ratio_of_sound |].
  rewrite Qreals.Q2R_mult, Qreals.Q2R_plus. unfold Q2R at 3. cbn. field.
Qed.

Definition lambda_of (n : nat) (u v : list R) : list R := map (fun k => part_at v k - part_at u k) (seq 0 n).
Lemma lambda_within : forall n u v, Forall (fun t => -1 <= t <= 1) (lambda_of n u v).
Proof. intros n u v. apply Forall_map, Forall_forall. intros k _. pose proof (part_within u k). pose proof (part_within v k). lra. Qed.
Lemma anywhere_holds : forall n u v k a b s, anywhere n k a b = Some s -> Slope.holds bits (lambda_of n u v) s (@value (spot u) (Varying k a b)) (@value (spot v) (Varying k a b)).
Proof.
  intros n u v k a b s h. unfold anywhere in h. destruct (Nat.ltb k n) eqn:hk; [| discriminate]. destruct (Qle_bool a b) eqn:le; [| discriminate]. cbn [andb] in h. cbv zeta in h. injection h as <-.
  apply Nat.ltb_lt in hk. apply Qle_bool_iff, Qreals.Qle_Rle in le. pose proof (ratio_of_sound bits a) as [la _]. pose proof (ratio_of_sound bits b) as [_ ub]. pose proof (unit_R_pos bits) as p.
  assert (R : forall w, contains (Fixed (lo (ratio_of bits a)) (hi (ratio_of bits b))) (@value (spot w) (Varying k a b))).
  { intro w. cbn [value Claim.along spot]. pose proof (part_within w k) as W. assert (Q2R a <= Q2R a + part_at w k * (Q2R b - Q2R a) <= Q2R b) as [g1 g2] by nra.
    apply (Rmult_le_compat_r (unit_R bits)) in g1, g2; try lra. unfold Fixed.contains. cbn [lo hi]. lra. }
  split; [apply R |]. split; [apply R |]. exists (repeat 0 k ++ [Q2R (b - a)]). split.
  - apply Forall2_app; [clear; induction k; cbn; constructor; auto using zero_sound | constructor; [apply ratio_of_sound | constructor]].
  - rewrite Cell.dot_unit. cbn [value Claim.along spot]. replace (nth k (lambda_of n u v) 0) with (part_at v k - part_at u k).
    + rewrite Qreals.Q2R_minus. ring.
    + unfold lambda_of. rewrite (nth_indep _ 0 (part_at v 0 - part_at u 0)) by (rewrite map_length, seq_length; exact hk).
      rewrite (map_nth (fun k => part_at v k - part_at u k)), seq_nth by exact hk. reflexivity.
Qed.

Fixpoint all_of {A : Type} (l : list (option A)) : option (list A) :=
  match l with [] => Some [] | x :: l' => match x, all_of l' with Some a, Some r => Some (a :: r) | _, _ => None end end.

Lemma all_of_related : forall (A B : Type) (f : A -> option B) (P : A -> B -> Prop), (forall a b, f a = Some b -> P a b) -> forall l r, all_of (map f l) = Some r -> Forall2 P l r.
Proof.
  intros A B f P h. induction l as [| a l IH]; intros r e; cbn [map all_of] in e; [injection e as <-; constructor |]. destruct (f a) as [b |] eqn:ea; [| discriminate].
  destruct (all_of (map f l)) as [q |]; [| discriminate]. injection e as <-. constructor; [exact (h _ _ ea) | exact (IH q eq_refl)].
Qed.
Lemma all_of_length : forall (A B : Type) (f : A -> option B) l r, all_of (map f l) = Some r -> length r = length l.
Proof. intros A B f l r e. symmetry. exact (related_length _ _ (fun _ _ => True) _ _ (all_of_related _ _ f _ (fun _ _ _ => I) l r e)). Qed.

(** ** Sums of intervals *)

Fixpoint total (w : list fixed) (M : list (list fixed)) : list fixed :=
  match w, M with t :: w', r :: M' => merge (mul bits t) (fun y => y) (fun x y => add (mul bits t x) y) r (total w' M') | _, _ => [] end.
Lemma total_sound : forall w M, forall u N, Forall2 contains w u -> Forall2 (Forall2 contains) M N -> Forall2 contains (total w M) (weighted_sum u N).
Proof.
  induction w as [| t w IH]; intros M u N h k; inversion h as [| ? b ? us hb hs]; subst; [constructor |]. inversion k as [| r q M' N' hr hM]; subst; cbn [total weighted_sum]; [constructor |].
  unfold comb. apply (merge_related _ _ _ _ _ _ contains contains contains); [| | | exact hr | apply IH; assumption].
  - intros i y hi. apply mul_sound; assumption.
  - intros i y hi. replace (1 * y) with y by ring. exact hi.
  - intros i y j z hi hj. replace (b * y + 1 * z) with (b * y + z) by ring. apply add_sound; [apply mul_sound; assumption | exact hj].
Qed.
Fixpoint inner (w r : list fixed) : fixed := match w, r with a :: w', b :: r' => add (mul bits a b) (inner w' r') | _, _ => zero end.
Lemma inner_sound : forall w r u v, Forall2 contains w u -> Forall2 contains r v -> contains (inner w r) (dot u v).
Proof.
  induction w as [| a w IH]; intros r u v h k; inversion h; subst; [apply zero_sound |]. inversion k; subst; cbn [inner dot]; [apply zero_sound |].
  apply add_sound; [apply mul_sound; assumption | auto].
Qed.
Definition squares (l : list fixed) : Z := fold_right (fun a s => magnitude a ^ 2 + s)%Z 0%Z l.
Lemma squares_sound : forall l u, Forall2 contains l u -> dot u u * unit_R bits ^ 2 <= IZR (squares l).
Proof.
  intros l u h. induction h as [| a x l u hx h IH]; cbn [squares fold_right dot]; [lra |]. fold (squares l). rewrite plus_IZR, Z.pow_2_r, mult_IZR.
  pose proof (magnitude_sound bits a x 1 hx ltac:(lra)) as B. rewrite Rmult_1_r in B. nra.
Qed.

Definition entry_row (j : nat) (w : list fixed) : list fixed :=
  merge (fun x => x) (fun y => neg (halve y)) (fun x y => sub x (halve y)) (repeat zero j ++ [Fixed.integer bits 1]) w.
(** [c]: the matrix. *)
Definition fits (fs : list number) (c : list (list Q)) : bool :=
  let n := length fs in
  match all_of (map (sloped_by bits at_centre) fs), all_of (map (sloped_by bits (anywhere n)) fs) with
  | Some f0, Some f1 =>
      let C := map (map (ratio_of bits)) c in let S := map Slope.slopes f1 in
      let at_ := map (fun row => inner row (map Slope.range f0)) C in
      let rest := map (fun p => entry_row (fst p) (total (snd p) S)) (combine (seq 0 n) C) in
      Nat.eqb (length c) n && forallb (fun row => Nat.eqb (length row) n) c &&
      (4 * squares at_ <=? unit_Z bits ^ 2)%Z && (4 * squares (concat rest) <=? unit_Z bits ^ 2)%Z
  | _, _ => false
  end.

Lemma dot_appended : forall a b c d, length a = length c -> dot (a ++ b) (c ++ d) = dot a c + dot b d.
Proof. induction a as [| x a IH]; intros b [| y c] d l; try discriminate; cbn [app dot]; [ring |]. rewrite IH by (cbn in l; congruence). ring. Qed.
(** The sum of all squares of a matrix bounds it. *)
Lemma image_below : forall E d, dot (image E d) (image E d) <= dot (concat E) (concat E) * dot d d.
Proof.
  induction E as [| r E IH]; intro d; cbn [image map dot concat]; [lra |]. rewrite dot_appended by reflexivity. specialize (IH d). unfold image in IH.
  pose proof (dot_cauchy r d). lra.
Qed.

Theorem fits_sound : forall fs c, fits fs c = true -> exists u, length u = length fs /\ size u <= 1 /\ Forall (fun f => @value (spot u) f = 0) fs.
Proof.
  intros fs c h. unfold fits in h. cbv zeta in h. set (n := length fs) in *.
  destruct (all_of (map (sloped_by bits at_centre) fs)) as [f0 |] eqn:e0; [| discriminate]. destruct (all_of (map (sloped_by bits (anywhere n)) fs)) as [f1 |] eqn:e1; [| discriminate].
  set (C := map (map (ratio_of bits)) c) in *. set (S := map Slope.slopes f1) in *. set (rest := map _ (combine (seq 0 n) C)) in *.
  apply andb_true_iff in h as [h small]. apply andb_true_iff in h as [h start]. apply andb_true_iff in h as [lc rc]. apply Nat.eqb_eq in lc. rewrite forallb_forall in rc.
  set (Cr := map (map Q2R) c). set (val := fun u => map (fun f => @value (spot u) f) fs).
  assert (lv : forall u, length (val u) = n) by (intro; apply map_length).
  assert (CC : Forall2 (Forall2 contains) C Cr).
  { unfold C, Cr. clear. induction c as [| r c IH]; constructor; [| exact IH]. induction r as [| q r IHr]; constructor; [apply ratio_of_sound | exact IHr]. }
  assert (lCr : length Cr = n) by (unfold Cr; rewrite map_length; exact lc).
  assert (im : forall w, length (image Cr w) = n) by (intro w; unfold image; rewrite map_length; exact lCr).
  (* slopes between two points *)
  assert (Slopes : forall u v, length u = n -> length v = n -> size u <= 1 -> size v <= 1 -> exists rs, Forall2 (Forall2 contains) S rs /\ forall i, nth i (val v) 0 - nth i (val u) 0 = / 2 * nth i (image rs (less v u)) 0).
  { intros u v lu lv' su sv. assert (L : lambda_of n u v = map (Rmult (/ 2)) (less v u)).
    { apply same_entries; [unfold lambda_of; rewrite !map_length, seq_length; symmetry; apply less_length; assumption |]. intro k. rewrite map_entries, less_entries. unfold lambda_of.
      destruct (Nat.lt_ge_cases k n) as [l | l].
      - rewrite (nth_indep _ 0 (part_at v 0 - part_at u 0)) by (rewrite map_length, seq_length; exact l). rewrite (map_nth (fun k => part_at v k - part_at u k)), seq_nth by exact l.
        cbn [Nat.add]. rewrite !part_is by assumption. field.
      - rewrite nth_overflow by (rewrite map_length, seq_length; exact l). rewrite !nth_overflow by lia. ring. }
    unfold S, val. assert (le : forall (A : Type) (l : list A) i, nth i (@nil R) 0 = 0) by (intros A l [| i]; reflexivity).
    clear - e1 L le. revert f1 e1. clearbody n. induction fs as [| f fs IH]; intros f1 e; cbn [map all_of] in e.
    - injection e as <-. exists []. split; [constructor |]. intro i. cbn. destruct i; ring.
    - destruct (sloped_by bits (anywhere n) f) as [s |] eqn:es; [| discriminate]. destruct (all_of _) as [r |]; [| discriminate]. injection e as <-.
      destruct (IH r eq_refl) as [rs [H1 H2]].
      destruct (sloped_by_sound bits (anywhere n) (lambda_of n u v) (spot u) (spot v) (lambda_within n u v) (anywhere_holds n u v) f s es) as [_ [_ [w [w1 w2]]]].
      exists (w :: rs). split; [constructor; assumption |]. intros [| i]; cbn [map nth image]; [| apply H2]. rewrite w2, L, dot_commutes, dot_map, dot_commutes. reflexivity. }
  assert (lS : length S = n).
  { unfold S. rewrite map_length. exact (all_of_length _ _ _ _ _ e1). }
  pose proof (unit_R_pos bits) as unit0. assert (U : IZR (unit_Z bits ^ 2) = unit_R bits ^ 2) by (rewrite Z.pow_2_r, mult_IZR; unfold unit_R; ring).
  (* d less half of C rs d *)
  assert (G : forall rs d, Forall2 (Forall2 contains) S rs -> length d = n -> size (comb 1 (- / 2) d (image Cr (image rs d))) <= / 2 * size d).
  { intros rs d hR ld. set (E := map (fun p => comb 1 (- / 2) (repeat 0 (fst p) ++ [1]) (weighted_sum (snd p) rs)) (combine (seq 0 n) Cr)).
    assert (EE : Forall2 (Forall2 contains) rest E).
    { unfold rest, E. assert (K : forall j, Forall2 (Forall2 contains) (map (fun p => entry_row (fst p) (total (snd p) S)) (combine (seq j n) C)) (map (fun p => comb 1 (- / 2) (repeat 0 (fst p) ++ [1]) (weighted_sum (snd p) rs)) (combine (seq j n) Cr))); [| exact (K 0%nat)].
      clear - CC hR. generalize n. intros m j. revert m j. induction CC as [| a r C Cr h hs IH]; intros [| m] j; cbn [seq combine map]; try constructor; [| apply IH].
      unfold entry_row, comb. cbn [fst snd]. apply (merge_related _ _ _ _ _ _ contains contains contains).
      - intros i y hi. rewrite Rmult_1_l. exact hi.
      - intros i y hi. replace (- / 2 * y) with (- (y / 2)) by field. apply neg_sound, halve_sound, hi.
      - intros i y i' z hi hi'. replace (1 * y + - / 2 * z) with (y - z / 2) by field. apply sub_sound; [exact hi | apply halve_sound, hi'].
      - apply Forall2_app; [clear; induction j; constructor; auto using zero_sound | constructor; [apply integer_sound | constructor]].
      - apply total_sound; assumption. }
    assert (Q : dot (concat E) (concat E) <= / 4).
    { assert (F : Forall2 contains (concat rest) (concat E)) by (clear - EE; induction EE; cbn [concat]; [constructor | apply Forall2_app; assumption]).
      pose proof (squares_sound _ _ F) as q. apply Z.leb_le, IZR_le in small. rewrite mult_IZR, U in small. apply Rmult_le_reg_r with (unit_R bits ^ 2); [apply pow_lt, unit0 |]. lra. }
    assert (I : comb 1 (- / 2) d (image Cr (image rs d)) = image E d).
    { apply same_entries.
      - rewrite comb_length by (rewrite im; exact ld). unfold image, E. rewrite !map_length, combine_length, seq_length, lCr, Nat.min_id. exact ld.
      - intro i. rewrite comb_entries, !image_entries. unfold E.
        destruct (Nat.lt_ge_cases i n) as [l | l].
        + set (g := fun p : nat * list R => comb 1 (- / 2) (repeat 0 (fst p) ++ [1]) (weighted_sum (snd p) rs)).
          assert (N : nth i (map g (combine (seq 0 n) Cr)) [] = g (i, nth i Cr [])).
          { rewrite (nth_indep (map g (combine (seq 0 n) Cr)) [] (g (0%nat, []))) by (rewrite map_length, combine_length, seq_length, lCr, Nat.min_id; exact l).
            rewrite (map_nth g), combine_nth by (rewrite seq_length; congruence). rewrite seq_nth by exact l. reflexivity. }
          rewrite N. unfold g. cbn [fst snd]. rewrite dot_comb, Cell.dot_unit, dot_weighted. unfold image. ring.
        + rewrite (nth_overflow d) by lia. rewrite (nth_overflow Cr) by lia. rewrite (nth_overflow (map _ (combine _ _))) by (rewrite map_length, combine_length, seq_length, lCr, Nat.min_id; exact l). cbn [dot]. ring. }
    rewrite I. apply size_below; [pose proof (size_nonneg d); lra |]. pose proof (image_below E d) as B. rewrite <- (size_square d) in B. replace ((/ 2 * size d) ^ 2) with (/ 4 * size d ^ 2) by field.
    assert (dot (concat E) (concat E) * size d ^ 2 <= / 4 * size d ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact Q]). lra. }
  set (T := fun u => less u (image Cr (val u))).
  assert (lT : forall u, length u = n -> length (T u) = n) by (intros u lu; apply less_length; [exact lu | apply im]).
  assert (Contracts : forall u v, length u = n -> length v = n -> size u <= 1 -> size v <= 1 -> size (less (T v) (T u)) <= / 2 * size (less v u)).
  { intros u v lu lv' su sv. destruct (Slopes u v lu lv' su sv) as [rs [hR ev]]. replace (less (T v) (T u)) with (comb 1 (- / 2) (less v u) (image Cr (image rs (less v u)))).
    - apply G; [exact hR | apply less_length; assumption].
    - apply same_entries; [rewrite comb_length; rewrite ?im, ?(less_length n); auto |]. intro i. rewrite comb_entries, !less_entries. unfold T. rewrite !less_entries, !image_entries.
      rewrite !(dot_commutes (nth i Cr [])). transitivity (nth i v 0 - nth i u 0 - (dot (val v) (nth i Cr []) - dot (val u) (nth i Cr []))); [| ring].
      assert (D : dot (val v) (nth i Cr []) - dot (val u) (nth i Cr []) = / 2 * dot (image rs (less v u)) (nth i Cr [])); [| rewrite D; field].
      replace (dot (val v) (nth i Cr []) - dot (val u) (nth i Cr [])) with (dot (comb 1 (-1) (val v) (val u)) (nth i Cr [])) by (rewrite dot_comb; ring).
      rewrite <- dot_map. apply dot_entries. intro k. rewrite comb_entries, map_entries, <- ev. ring. }
  assert (Start : size (T (nought n)) <= / 2).
  { replace (T (nought n)) with (map (Rmult (-1)) (image Cr (val (nought n)))).
    2: { apply same_entries; [rewrite map_length, im; symmetry; apply lT, repeat_length |]. intro i. unfold T. rewrite map_entries, less_entries, nought_entries. ring. }
    assert (V : Forall2 contains (map Slope.range f0) (val (nought n))).
    { unfold val. apply all_of_related with (P := fun f s => contains (Slope.range s) (@value (spot (nought n)) f)) in e0.
      - assert (K : forall (g : number -> R) l r, Forall2 (fun f s => contains (Slope.range s) (g f)) l r -> Forall2 contains (map Slope.range r) (map g l)) by (clear; intros g l r K; induction K; cbn [map]; [constructor | constructor; assumption]).
        exact (K _ _ _ e0).
      - intros f s es. exact (proj1 (proj2 (sloped_by_sound bits at_centre [] (spot (nought n)) (spot (nought n)) (Forall_nil _) (centre_holds n) f s es))). }
    assert (B : Forall2 contains (map (fun row => inner row (map Slope.range f0)) C) (image Cr (val (nought n)))).
    { unfold image. clear - CC V. induction CC; constructor; [apply inner_sound; assumption | assumption]. }
    pose proof (squares_sound _ _ B) as q. apply Z.leb_le, IZR_le in start. rewrite mult_IZR, U in start.
    apply size_below; [lra |]. rewrite dot_map, dot_commutes, dot_map. apply Rmult_le_reg_r with (unit_R bits ^ 2); [apply pow_lt, unit0 |]. lra. }
  destruct (fixed_point n n (/ 2) T ltac:(lra)) as [u [[lu su] fix_]].
  - intros u [lu su]. rewrite (whole_norm n u lu) in su. split; [apply lT, lu |]. rewrite (whole_norm n (T u) (lT u lu)). pose proof (lT _ (nought_length n)) as l0.
    pose proof (norm_less n n (T u) (T (nought n)) (lT u lu) l0) as N.
    rewrite (whole_norm n (T u) (lT u lu)), (whole_norm n _ l0), (whole_norm n _ (less_length n _ _ (lT u lu) l0)) in N.
    pose proof (Contracts (nought n) u (nought_length n) lu ltac:(rewrite size_nought; lra) su) as K.
    replace (less u (nought n)) with u in K; [lra |]. apply same_entries; [rewrite (less_length n); auto using nought_length |]. intro i. rewrite less_entries, nought_entries. ring.
  - intros u v [lu su] [lv' sv]. rewrite (whole_norm n u lu) in su. rewrite (whole_norm n v lv') in sv. rewrite !(whole_norm n) by auto using less_length. apply Contracts; assumption.
  - rewrite whole_norm in su by exact lu. exists u. split; [exact lu |]. split; [exact su |].
    assert (Z : image Cr (val u) = nought n).
    { apply same_entries; [rewrite im; symmetry; apply repeat_length |]. intro i. pose proof (f_equal (fun l => nth i l 0) fix_) as e. cbv beta in e. unfold T in e. rewrite less_entries in e. rewrite nought_entries. lra. }
    destruct (Slopes u u lu lu su su) as [rs [hR _]]. assert (lR : length rs = n) by (rewrite <- (related_length _ _ _ _ _ hR); exact lS).
    assert (Only : forall d, length d = n -> image Cr (image rs d) = nought n -> d = nought n).
    { intros d ld e. apply nothing; [exact ld |]. pose proof (G rs d hR ld) as g. rewrite e in g.
      replace (comb 1 (- / 2) d (nought n)) with d in g; [pose proof (size_nonneg d); lra |].
      apply same_entries; [rewrite comb_length; [reflexivity | rewrite nought_length; exact ld] |]. intro i. rewrite comb_entries, nought_entries. ring. }
    assert (Inj : forall v, length v = n -> image rs v = nought n -> v = nought n).
    { intros v lv' e. apply Only; [exact lv' |]. rewrite e. apply same_entries; [rewrite im; symmetry; apply repeat_length |]. intro i. rewrite image_entries, nought_entries, dot_commutes.
      assert (D : forall m w, dot (nought m) w = 0) by (induction m as [| m IH]; intros [| y w]; cbn; rewrite ?IH; ring). apply D. }
    destruct (solvable n rs (val u) lR (lv u) Inj) as [d [ld hd]]. pose proof (Only d ld ltac:(rewrite hd; exact Z)) as d0.
    assert (V0 : val u = nought n).
    { rewrite <- hd, d0. apply same_entries; [unfold image; rewrite map_length, nought_length; exact lR |]. intro i. rewrite image_entries, nought_entries. apply dot_zero. unfold nought. clear. induction n; constructor; auto. }
    apply Forall_forall. intros f hf. assert (hf' : In (@value (spot u) f) (val u)) by (apply in_map_iff; exists f; split; [reflexivity | exact hf]). rewrite V0 in hf'. unfold nought in hf'. apply repeat_spec in hf'. exact hf'.
Qed.
End Precision.
