(** * The point that has given values, in a set with two norms

    Of as many functions as coordinates. A point has two parts, the first coordinates and the last ones, each of length at most 1; its
    norm is that of the greater part. Where derivatives change by little, the functions take values near those at zero at exactly one
    point (steps 2 and 3 of test/accuracy.rs), as in Accuracy.v. *)

From Coq Require Import Reals Lra Lia Psatz List.
From Orthocert Require MeanValue.
From Orthocert Require Import Velocity.
From Orthocert.kernel Require Import Linear Solve.
From Orthocert.kernel Require Cell.
From Orthocert.kernel Require Accuracy.
Import ListNotations.
Local Open Scope R_scope.

(** ** Lists as vectors *)

Lemma same_entries : forall u v : list R, length u = length v -> (forall i, nth i u 0 = nth i v 0) -> u = v.
Proof. intros u v l h. apply (nth_ext u v 0 0 l). intros i _. apply h. Qed.

Lemma map_entries : forall a u i, nth i (map (Rmult a) u) 0 = a * nth i u 0.
Proof. intros a u i. rewrite <- (Rmult_0_r a) at 1. exact (map_nth (Rmult a) u 0 i). Qed.
Lemma comb_entries : forall a b u v i, nth i (comb a b u v) 0 = a * nth i u 0 + b * nth i v 0.
Proof.
  unfold comb. intros a b. induction u as [| x u IH]; intros v i; cbn [merge].
  - rewrite map_entries. destruct i; cbn [nth]; ring.
  - destruct v as [| y v]; [rewrite map_entries; destruct i; cbn [nth]; ring |]. destruct i; cbn [nth]; [reflexivity | apply IH].
Qed.
Lemma comb_length : forall a b u v, length u = length v -> length (comb a b u v) = length u.
Proof. unfold comb. intros a b. induction u as [| x u IH]; intros [| y v] l; try discriminate; [reflexivity |]. cbn [merge length]. rewrite IH by (cbn in l; congruence). reflexivity. Qed.
Lemma comb_first : forall a b k u v, firstn k (comb a b u v) = comb a b (firstn k u) (firstn k v).
Proof.
  unfold comb. intros a b. induction k as [| k IH]; intros u v; [reflexivity |]. destruct u as [| x u], v as [| y v]; cbn [merge firstn map]; try reflexivity.
  - rewrite firstn_map. reflexivity.
  - rewrite firstn_map. reflexivity.
  - rewrite IH. reflexivity.
Qed.
Lemma comb_rest : forall a b k u v, skipn k (comb a b u v) = comb a b (skipn k u) (skipn k v).
Proof.
  unfold comb. intros a b. induction k as [| k IH]; intros u v; [reflexivity |]. destruct u as [| x u], v as [| y v]; cbn [merge skipn map]; try reflexivity.
  - rewrite skipn_map. reflexivity.
  - rewrite skipn_map. destruct (skipn k u); reflexivity.
  - apply IH.
Qed.
Lemma rest_entries : forall k u i, nth i (skipn k u) 0 = nth (k + i) u 0.
Proof. induction k as [| k IH]; intros [| x u] i; cbn [skipn Nat.add nth]; try reflexivity; [destruct i; reflexivity | apply IH]. Qed.
Lemma dot_parts : forall k u v, dot u v = dot (firstn k u) (firstn k v) + dot (skipn k u) (skipn k v).
Proof. induction k as [| k IH]; intros [| x u] [| y v]; cbn [firstn skipn dot]; try ring; [destruct (skipn k u); cbn; ring |]. rewrite (IH u v). ring. Qed.
Lemma dot_right : forall a b w u v, dot w (comb a b u v) = a * dot w u + b * dot w v.
Proof. intros. rewrite !(dot_commutes w). apply dot_comb. Qed.

Definition size (v : list R) : R := sqrt (dot v v).
Lemma size_nonneg : forall v, 0 <= size v.
Proof. intro. apply sqrt_pos. Qed.
Lemma size_square : forall v, size v ^ 2 = dot v v.
Proof. intro. unfold size. apply pow2_sqrt, dot_self. Qed.
Lemma size_below : forall v a, 0 <= a -> dot v v <= a ^ 2 -> size v <= a.
Proof. intros v a h k. unfold size. rewrite <- (sqrt_pow2 a h). apply sqrt_le_1_alt, k. Qed.
Lemma dot_sizes : forall u v, dot u v <= size u * size v.
Proof.
  intros u v. pose proof (dot_cauchy u v) as c. rewrite <- !size_square in c. pose proof (size_nonneg u). pose proof (size_nonneg v).
  assert (0 <= size u * size v) by (apply Rmult_le_pos; assumption). apply Rnot_lt_le. intro n. nra.
Qed.
Lemma size_comb : forall a b u v, size (comb a b u v) <= Rabs a * size u + Rabs b * size v.
Proof.
  intros a b u v. pose proof (size_nonneg u) as p. pose proof (size_nonneg v) as q. pose proof (Rabs_pos a) as a0. pose proof (Rabs_pos b) as b0.
  apply size_below; [apply Rplus_le_le_0_compat; apply Rmult_le_pos; assumption |].
  rewrite dot_comb, !dot_right, (dot_commutes v u), <- !size_square. pose proof (dot_cauchy u v) as c. rewrite <- !size_square in c.
  assert (C : a * b * dot u v <= Rabs a * Rabs b * (size u * size v)).
  { rewrite <- Rabs_mult. apply Rle_trans with (Rabs (a * b * dot u v)); [apply Rle_abs |]. rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos |].
    apply Rabs_le. assert (0 <= size u * size v) by (apply Rmult_le_pos; assumption). split; apply Rnot_lt_le; intro n; nra. }
  replace (a * (a * size u ^ 2 + b * dot u v) + b * (a * dot u v + b * size v ^ 2)) with (a ^ 2 * size u ^ 2 + 2 * (a * b * dot u v) + b ^ 2 * size v ^ 2) by ring.
  rewrite <- (pow2_abs a), <- (pow2_abs b). nra.
Qed.

(** Length of v in the first [f] entries, or in the rest. *)
Definition part {A : Type} (f : nat) (last : bool) (v : list A) : list A := if last then skipn f v else firstn f v.
Definition norm (f : nat) (v : list R) : R := Rmax (size (part f false v)) (size (part f true v)).

Section Parts.
Variable f : nat.
Lemma part_size : forall p v, size (part f p v) <= norm f v.
Proof. intros [] v; [apply Rmax_r | apply Rmax_l]. Qed.
Lemma norm_below : forall v a, (forall p, size (part f p v) <= a) -> norm f v <= a.
Proof. intros v a h. apply Rmax_lub; apply h. Qed.
Lemma norm_nonneg : forall v, 0 <= norm f v.
Proof. intro v. apply Rle_trans with (size (part f false v)); [apply size_nonneg | apply part_size]. Qed.
Lemma part_comb : forall a b p u v, part f p (comb a b u v) = comb a b (part f p u) (part f p v).
Proof. intros a b [] u v; [apply comb_rest | apply comb_first]. Qed.
Lemma norm_comb : forall a b u v, norm f (comb a b u v) <= Rabs a * norm f u + Rabs b * norm f v.
Proof.
  intros a b u v. apply norm_below. intro p. rewrite part_comb. apply Rle_trans with (1 := size_comb _ _ _ _).
  apply Rplus_le_compat; apply Rmult_le_compat_l; auto using Rabs_pos, part_size.
Qed.
Lemma part_dot : forall p v, dot (part f p v) (part f p v) <= dot v v.
Proof.
  intros p v. rewrite (dot_parts f v v). pose proof (dot_self (firstn f v)). pose proof (dot_self (skipn f v)). destruct p; cbn [part]; lra.
Qed.
Lemma norm_entry : forall v i, Rabs (nth i v 0) <= norm f v.
Proof.
  assert (E : forall v i, Rabs (nth i v 0) <= size v).
  { intros v i. apply Rsqr_incr_0_var; [| apply size_nonneg]. rewrite !Rsqr_pow2, pow2_abs, size_square. revert i.
    induction v as [| x v IH]; intros [| i]; cbn [nth dot]; try lra; [pose proof (dot_self v); lra |]. specialize (IH i). pose proof (pow2_ge_0 x). lra. }
  intros v i. destruct (Nat.lt_ge_cases i f) as [l | g].
  - apply Rle_trans with (2 := part_size false v). cbn [part]. rewrite <- (firstn_skipn f v) at 1.
    destruct (Nat.lt_ge_cases i (length (firstn f v))) as [l' | g']; [rewrite app_nth1 by exact l'; apply E |].
    rewrite firstn_length in g'. rewrite nth_overflow by (rewrite firstn_skipn; lia). rewrite Rabs_R0. apply size_nonneg.
  - apply Rle_trans with (2 := part_size true v). cbn [part]. replace i with (f + (i - f))%nat by lia. rewrite <- rest_entries. apply E.
Qed.
Lemma norm_entries : forall v n a, length v = n -> (forall i, (i < n)%nat -> Rabs (nth i v 0) <= a) -> norm f v <= INR n * a.
Proof.
  assert (Sum : forall v, size v <= fold_right (fun x s => Rabs x + s) 0 v).
  { induction v as [| x v IH]; [unfold size; cbn [dot fold_right]; rewrite sqrt_0; apply Rle_refl |]. cbn [fold_right]. pose proof (size_nonneg v). pose proof (Rabs_pos x).
    apply size_below; [lra |]. cbn [dot]. rewrite <- size_square. replace (x * x) with (Rabs x ^ 2) by (rewrite pow2_abs; ring). nra. }
  intros v n a l h. apply norm_below. intro p. apply Rle_trans with (size v).
  - apply size_below; [apply size_nonneg |]. rewrite size_square. apply part_dot.
  - apply Rle_trans with (1 := Sum v). subst n. induction v as [| x v IH]; cbn [fold_right length]; [cbn; lra |].
    rewrite S_INR. pose proof (h 0%nat ltac:(cbn; lia)) as h0. cbn [nth] in h0. specialize (IH (fun i hi => h (S i) ltac:(cbn; lia))). lra.
Qed.
End Parts.

(** ** Banach's theorem *)

Definition less (u v : list R) : list R := comb 1 (-1) u v.
Definition nought (n : nat) : list R := repeat 0 n.

Lemma abs_minus_one : Rabs (-1) = 1.
Proof. rewrite Rabs_left; lra. Qed.

Section Spaces.
Variables f n : nat.
Local Notation norm := (norm f).
Local Notation inside u := (length u = n /\ norm u <= 1).

Lemma nought_entries : forall i, nth i (nought n) 0 = 0.
Proof. intro i. unfold nought. destruct (Nat.lt_ge_cases i n); [apply nth_repeat | apply nth_overflow; rewrite repeat_length; lia]. Qed.
Lemma nth_repeat_all : forall i k, nth i (repeat 0 k) 0 = 0.
Proof. intros i k. destruct (Nat.lt_ge_cases i k); [apply nth_repeat | apply nth_overflow; rewrite repeat_length; lia]. Qed.
Lemma nought_length : length (nought n) = n.
Proof. apply repeat_length. Qed.
Lemma less_length : forall u v, length u = n -> length v = n -> length (less u v) = n.
Proof. intros u v hu hv. unfold less. rewrite comb_length; congruence. Qed.
Lemma less_entries : forall u v i, nth i (less u v) 0 = nth i u 0 - nth i v 0.
Proof. intros. unfold less. rewrite comb_entries. ring. Qed.
Lemma dot_less : forall w u v, dot w (less u v) = dot w u - dot w v.
Proof. intros. unfold less. rewrite dot_right. ring. Qed.
Lemma small_zero : forall u, length u = n -> norm u <= 0 -> u = nought n.
Proof.
  intros u l h. apply same_entries; [rewrite nought_length; exact l |]. intro i. rewrite nought_entries. pose proof (norm_entry f u i) as e. pose proof (Rabs_pos (nth i u 0)).
  destruct (Req_dec (nth i u 0) 0) as [z | z]; [exact z | apply Rabs_pos_lt in z; lra].
Qed.
Lemma less_zero : forall u v, length u = n -> length v = n -> norm (less u v) <= 0 -> u = v.
Proof.
  intros u v hu hv h. apply small_zero in h; [| apply less_length; assumption]. apply same_entries; [congruence |]. intro i.
  pose proof (f_equal (fun l => nth i l 0) h) as e. cbv beta in e. rewrite less_entries, nought_entries in e. lra.
Qed.
Lemma less_between : forall u v w, length u = n -> length v = n -> length w = n -> norm (less u w) <= norm (less u v) + norm (less v w).
Proof.
  intros u v w hu hv hw. replace (less u w) with (comb 1 1 (less u v) (less v w)).
  - eapply Rle_trans; [apply norm_comb |]. rewrite Rabs_R1. lra.
  - apply same_entries; [rewrite comb_length, !less_length by (rewrite ?less_length; congruence); reflexivity |]. intro i. rewrite comb_entries, !less_entries. ring.
Qed.
Lemma less_opposite : forall u v, length u = n -> length v = n -> norm (less u v) <= norm (less v u).
Proof.
  intros u v hu hv. replace (less u v) with (comb 0 (-1) (less v u) (less v u)).
  - eapply Rle_trans; [apply norm_comb |]. rewrite Rabs_R0, abs_minus_one. lra.
  - apply same_entries; [rewrite comb_length, !less_length by (rewrite ?less_length; congruence); reflexivity |]. intro i. rewrite comb_entries, !less_entries. ring.
Qed.
Lemma nought_norm : norm (nought n) <= 0.
Proof.
  replace (nought n) with (comb 0 0 (nought n) (nought n)); [eapply Rle_trans; [apply norm_comb |]; rewrite Rabs_R0; lra |].
  apply same_entries; [rewrite comb_length; reflexivity |]. intro i. rewrite comb_entries, nought_entries. ring.
Qed.
Lemma norm_less : forall u v, length u = n -> length v = n -> norm u <= norm v + norm (less u v).
Proof.
  intros u v hu hv. replace u with (comb 1 1 v (less u v)) at 1.
  - eapply Rle_trans; [apply norm_comb |]. rewrite Rabs_R1. lra.
  - apply same_entries; [rewrite comb_length; rewrite ?less_length; congruence |]. intro i. rewrite comb_entries, less_entries. ring.
Qed.

Lemma entries_chosen : forall (P : nat -> R -> Prop), (forall i, exists x, P i x) -> forall k, exists l, length l = k /\ forall i, (i < k)%nat -> P i (nth i l 0).
Proof.
  intros P h. induction k as [| k [l [e H]]]; [exists []; split; [reflexivity | lia] |]. destruct (h k) as [x hx]. exists (l ++ [x]). split; [rewrite app_length; cbn; lia |].
  intros i hi. destruct (Nat.eq_dec i k) as [-> | d]; [rewrite <- e, nth_middle, e; exact hx | rewrite app_nth1 by lia; apply H; lia].
Qed.

Section Banach.
Variables (q : R) (F : list R -> list R).
Hypothesis q_below : 0 <= q < 1.
Hypothesis into : forall u, inside u -> inside (F u).
Hypothesis contracts : forall u v, inside u -> inside v -> norm (less (F u) (F v)) <= q * norm (less u v).

Fixpoint iterate (k : nat) : list R := match k with O => nought n | S k => F (iterate k) end.
Lemma iterate_in : forall k, inside (iterate k).
Proof. induction k as [| k IH]; cbn [iterate]; [split; [exact nought_length | pose proof nought_norm; lra] | apply into, IH]. Qed.

Let C := 2 / (1 - q).
Lemma C_nonneg : 0 <= C.
Proof. unfold C. apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]. Qed.
Lemma iterate_near : forall k j, norm (less (iterate (j + k)) (iterate j)) <= q ^ j * C.
Proof.
  pose proof C_nonneg as C0.
  assert (Step : forall j, norm (less (iterate (S j)) (iterate j)) <= q ^ j * 2).
  { induction j as [| j IH].
    - destruct (iterate_in 1) as [l1 h1]. destruct (iterate_in 0) as [l0 h0]. unfold less. eapply Rle_trans; [apply norm_comb |]. rewrite abs_minus_one, Rabs_R1. cbn [pow]. lra.
    - eapply Rle_trans; [exact (contracts _ _ (iterate_in (S j)) (iterate_in j)) |]. cbn [pow]. rewrite Rmult_assoc. apply Rmult_le_compat_l; [apply q_below | exact IH]. }
  induction k as [| k IH]; intro j.
  - rewrite Nat.add_0_r. apply Rle_trans with 0; [| apply Rmult_le_pos; [apply pow_le, q_below | exact C0]].
    replace (less (iterate j) (iterate j)) with (nought n); [exact nought_norm |]. destruct (iterate_in j) as [l _].
    apply same_entries; [rewrite less_length, nought_length by exact l; reflexivity |]. intro i. rewrite less_entries, nought_entries. ring.
  - eapply Rle_trans; [apply (less_between _ (iterate (S j))); apply iterate_in |]. replace (j + S k)%nat with (S j + k)%nat by lia.
    apply Rle_trans with (q ^ S j * C + q ^ j * 2); [apply Rplus_le_compat; [apply IH | apply Step] |].
    cbn [pow]. apply Req_le. unfold C. field. lra.
Qed.

Theorem fixed_point : exists u, inside u /\ F u = u.
Proof.
  assert (L : forall i, exists x, forall k, Rabs (x - nth i (iterate k) 0) <= q ^ k * C).
  { intro i. apply Accuracy.limit; [exact q_below |]. intros k j. rewrite <- less_entries. eapply Rle_trans; [apply (norm_entry f) | apply iterate_near]. }
  destruct (entries_chosen _ L n) as [u [lu hu]]. set (K := INR n * C). exists u.
  assert (Near : forall k, norm (less u (iterate k)) <= q ^ k * K).
  { intro k. unfold K. replace (q ^ k * (INR n * C)) with (INR n * (q ^ k * C)) by ring. destruct (iterate_in k) as [lk _]. apply norm_entries; [apply less_length; assumption |].
    intros i hi. rewrite less_entries. apply hu, hi. }
  assert (In : norm u <= 1).
  { apply (Accuracy.geometric q K); [exact q_below |]. intro k. destruct (iterate_in k) as [lk hk]. eapply Rle_trans; [apply (norm_less u (iterate k)); assumption |]. specialize (Near k). lra. }
  split; [split; assumption |]. destruct (into u (conj lu In)) as [lf _]. apply less_zero; [exact lf | exact lu |].
  apply (Accuracy.geometric q (2 * K)); [exact q_below |]. intro k. destruct (iterate_in k) as [lk hk]. destruct (iterate_in (S k)) as [ls hs].
  eapply Rle_trans; [apply (less_between _ (iterate (S k))); assumption |]. cbn [iterate] in *.
  pose proof (contracts u (iterate k) (conj lu In) (conj lk hk)) as h1. pose proof (less_opposite _ _ ls lu) as h2. pose proof (Near (S k)) as h3. cbn [iterate pow] in h3.
  pose proof (Near k) as h4. pose proof (norm_nonneg f (less u (iterate k))). pose proof (pow_le q k (proj1 q_below)).
  assert (q * norm (less u (iterate k)) <= 1 * (q ^ k * K)) by (apply Rmult_le_compat; lra).
  assert (q * q ^ k * K <= 1 * (q ^ k * K)) by (rewrite Rmult_assoc; apply Rmult_le_compat_r; lra). lra.
Qed.
End Banach.
End Spaces.

(** ** As many equations as unknowns *)

Definition image (rows : list (list R)) (v : list R) : list R := map (fun r => dot r v) rows.
Definition scaled (e v : list R) : list R := map (fun p => fst p * snd p) (combine e v).

Lemma dot_entries : forall u p q, (forall k, nth k p 0 = nth k q 0) -> dot p u = dot q u.
Proof.
  assert (D : forall p x u, dot p (x :: u) = nth 0 p 0 * x + dot (tl p) u) by (intros [| y p] x u; cbn; [destruct u; cbn; ring | ring]).
  induction u as [| x u IH]; intros p q h; [rewrite !(dot_commutes _ []); reflexivity |]. rewrite !D, (h 0%nat). f_equal. apply IH. intro k. specialize (h (S k)).
  destruct p, q; cbn [tl nth] in *; destruct k; auto.
Qed.
Lemma image_entries : forall rows v i, nth i (image rows v) 0 = dot (nth i rows []) v.
Proof. intros rows v i. exact (map_nth (fun r => dot r v) rows [] i). Qed.
Lemma scaled_entries : forall e v i, length e = length v -> nth i (scaled e v) 0 = nth i e 0 * nth i v 0.
Proof. induction e as [| x e IH]; intros [| y v] [| i] l; try discriminate; cbn; try ring. apply IH. cbn in l. congruence. Qed.
Lemma scaled_length : forall e v, length e = length v -> length (scaled e v) = length v.
Proof. intros e v l. unfold scaled. rewrite map_length, combine_length. lia. Qed.
Lemma dot_scaled : forall e r v, dot (scaled e r) v = dot r (scaled e v).
Proof.
  unfold scaled. induction e as [| x e IH]; intros [| y r] v; cbn [combine map dot]; try (destruct v; reflexivity).
  destruct v as [| z v]; cbn [combine map dot fst snd]; [reflexivity |]. rewrite IH. ring.
Qed.
Lemma weighted_entries : forall w M k, nth k (weighted_sum w M) 0 = dot w (map (fun r => nth k r 0) M).
Proof. induction w as [| t w IH]; intros [| r M] k; cbn [weighted_sum map dot]; try (destruct k; reflexivity). rewrite comb_entries, IH. ring. Qed.
Lemma zeros_nought : forall n v, length v = n -> dot v v <= 0 -> v = nought n.
Proof.
  intros n v l h. apply same_entries; [rewrite nought_length; exact l |]. intro i. rewrite nought_entries. apply zero_vector in h.
  destruct (nth_in_or_default i v 0) as [k | e]; [rewrite Forall_forall in h; symmetry; apply h, k | exact e].
Qed.

Lemma solvable : forall n rows y, length rows = n -> length y = n -> (forall v, length v = n -> image rows v = nought n -> v = nought n) ->
  exists v, length v = n /\ image rows v = y.
Proof.
  intros n rows y lr ly once. destruct (orthogonal_exists (S n) (map (fun p => - snd p :: fst p) (combine rows y))) as [w [lw [nz h]]]; [rewrite map_length, combine_length; lia |].
  destruct w as [| s v]; [discriminate |]. rewrite Forall_map in h.
  assert (E : forall i, dot (nth i rows []) v = s * nth i y 0).
  { assert (ll : length rows = length y) by congruence. clear lr ly once nz lw. revert y ll h. induction rows as [| r rows IH]; intros [| z y] ll h i; try discriminate; [destruct i; cbn; ring |].
    cbn [combine] in h. inversion h as [| ? ? h1 h2]; subst. cbn [fst snd dot] in h1. destruct i; cbn [nth]; [lra |]. apply IH; [cbn in ll; congruence | exact h2]. }
  destruct (Req_dec s 0) as [-> | s0].
  - exfalso. assert (Z : v = nought n).
    { apply once; [cbn in lw; congruence |]. apply same_entries; [unfold image; rewrite map_length, nought_length; exact lr |]. intro i. rewrite image_entries, nought_entries, E. ring. }
    unfold nonzero in nz. cbn [dot] in nz. rewrite Z in nz. assert (D : dot (nought n) (nought n) = 0) by (apply dot_zero; unfold nought; clear; induction n; constructor; auto). rewrite D in nz. lra.
  - exists (map (Rmult (/ s)) v). split; [rewrite map_length; cbn in lw; congruence |]. apply same_entries; [unfold image; rewrite map_length; congruence |]. intro i.
    rewrite image_entries, dot_commutes, dot_map, dot_commutes, E. field. exact s0.
Qed.

(** ** The theorem *)

Section Near.
Variables (f n : nat) (value : list R -> list R) (J : list R -> list (list R)) (g : R) (b : list R).
Local Notation norm := (norm f).
Local Notation inside u := (length u = n /\ norm u <= 1).
Let W := J (nought n).
Hypothesis value_length : forall u, length (value u) = n.
Hypothesis b_length : length b = n.
Hypothesis J_length : forall u, length (J u) = n.
Hypothesis row_length : Forall (fun r => length r = n) W.
Hypothesis g_nonneg : 0 <= g.
(** J has the derivatives, and changes by little. *)
Hypothesis smooth : forall u v, inside u -> inside v -> forall t, 0 <= t <= 1 -> forall i, (i < n)%nat ->
  derivable_pt_lim (fun x => nth i (value (comb 1 x u (less v u))) 0) t (dot (nth i (J (comb 1 t u (less v u))) []) (less v u)).
Hypothesis spread : forall u w, inside u -> length w = n -> size (less (image (J u) w) (image W w)) <= g * norm u * norm w.

(** What is shown of a part, columns of the other multiplied by some numbers. *)
Definition met (p : bool) : Prop := exists kappa z e, g < kappa /\ 0 <= z /\ z + g / (2 * kappa) <= 1 /\
  length e = n /\ (forall i, (i < n)%nat -> 0 < nth i e 0) /\ (forall i, (i < n)%nat -> (if p then f <= i else i < f)%nat -> nth i e 0 = 1) /\
  forall w, length w = n -> let q := weighted_sum w (map (scaled e) W) in kappa ^ 2 * dot w w <= dot q q /\
    forall s, 0 < dot w w + s ^ 2 -> 0 < dot q q + 2 * s * dot b w + z ^ 2 * s ^ 2.
Hypothesis each_met : forall p, part f p (nought n) = [] \/ met p.

Lemma first_entries : forall k u i, nth i (firstn k u) 0 = if Nat.ltb i k then nth i u 0 else 0.
Proof. induction k as [| k IH]; intros [| x u] [| i]; cbn [firstn nth]; try reflexivity; [destruct (Nat.ltb _ _); reflexivity |]. rewrite IH. reflexivity. Qed.

Lemma part_bounds : forall p, exists kappa z, g < kappa /\ 0 <= z /\ z + g / (2 * kappa) <= 1 /\
  forall a, length a = n -> kappa * size (part f p a) <= size (image W a) /\ (image W a = b -> size (part f p a) <= z).
Proof.
  intro p. destruct (each_met p) as [none | [kappa [z [e [gk [z0 [zg [le [e0 [e1 h]]]]]]]]]].
  - exists (g + 1), 0. split; [lra |]. split; [lra |].
    split; [apply Rmult_le_reg_r with (2 * (g + 1)); [lra |]; replace ((0 + g / (2 * (g + 1))) * (2 * (g + 1))) with g by (field; lra); lra |].
    intros a la. assert (E : size (part f p a) = 0).
    { apply (f_equal (@length R)) in none. assert (l : part f p a = []).
      { apply length_zero_iff_nil. transitivity (length (part f p (nought n))); [| exact none]. unfold part. destruct p; rewrite ?skipn_length, ?firstn_length, nought_length, la; reflexivity. }
      rewrite l. unfold size. cbn [dot]. apply sqrt_0. }
    rewrite E, Rmult_0_r. split; [apply size_nonneg | lra].
  - exists kappa, z. split; [exact gk |]. split; [exact z0 |]. split; [exact zg |]. intros a la. set (y := image W a). set (V := map (scaled e) W) in h.
    set (a' := scaled (map Rinv e) a). assert (li : length (map Rinv e) = length a) by (rewrite map_length; congruence).
    assert (la' : length a' = n) by (unfold a'; rewrite scaled_length; congruence).
    assert (Ea : forall i, nth i a 0 = nth i e 0 * nth i a' 0).
    { intro i. unfold a'. rewrite scaled_entries by exact li. destruct (Nat.lt_ge_cases i n) as [l | l].
      - rewrite (nth_indep (map Rinv e) 0 (/ 0)) by (rewrite map_length; lia). rewrite (map_nth Rinv). specialize (e0 i l). field. lra.
      - rewrite (nth_overflow a) by lia. ring. }
    assert (Es : scaled e a' = a).
    { apply same_entries; [rewrite scaled_length; congruence |]. intro i. rewrite scaled_entries by congruence. symmetry. apply Ea. }
    assert (Ey : image V a' = y).
    { unfold V, image, y. rewrite map_map. apply map_ext. intro r. rewrite dot_scaled, Es. reflexivity. }
    set (columns := map (fun k => map (fun r => nth k r 0) V) (seq 0 n)).
    assert (Cols : forall w, length (image columns w) = n /\ forall k, nth k (image columns w) 0 = nth k (weighted_sum w V) 0).
    { intro w. split; [unfold image, columns; rewrite !map_length, seq_length; reflexivity |]. intro k. rewrite image_entries, weighted_entries. unfold columns.
      destruct (Nat.lt_ge_cases k n) as [l | l].
      - rewrite (nth_indep _ [] (map (fun r => nth 0 r 0) V)) by (rewrite map_length, seq_length; exact l).
        rewrite (map_nth (fun k => map (fun r => nth k r 0) V)), seq_nth by exact l. apply dot_commutes.
      - rewrite (nth_overflow (map _ (seq 0 n)) []) by (rewrite map_length, seq_length; exact l). symmetry. apply dot_zero, Forall_forall. intros x ix.
        apply in_map_iff in ix as [r [<- ir]]. apply in_map_iff in ir as [r' [<- ir]]. rewrite Forall_forall in row_length. symmetry. apply nth_overflow.
        rewrite scaled_length; rewrite (row_length _ ir); [exact l | exact le]. }
    assert (Wn : length V = n) by (unfold V; rewrite map_length; apply J_length).
    destruct (solvable n columns a') as [w [lw hw]]; [unfold columns; rewrite map_length, seq_length; reflexivity | exact la' | |].
    { intros w lw hw. apply zeros_nought; [exact lw |]. destruct (h w lw) as [h1 _]. cbv zeta in h1. assert (Z : dot (weighted_sum w V) (weighted_sum w V) = 0).
      { apply dot_zero, Forall_forall. intros x ix. destruct (In_nth _ _ 0 ix) as [k [_ <-]]. rewrite <- (proj2 (Cols w)), hw. symmetry. apply nought_entries. }
      rewrite Z in h1. assert (0 < kappa ^ 2) by (apply pow_lt; lra). pose proof (dot_self w). nra. }
    assert (P : forall u, dot (weighted_sum w V) u = dot a' u) by (intro u; apply dot_entries; intro k; rewrite <- (proj2 (Cols w)), hw; reflexivity).
    assert (PP : dot (weighted_sum w V) (weighted_sum w V) = dot a' a') by (rewrite P, dot_commutes; apply P).
    destruct (h w lw) as [h1 h2]. cbv zeta in h1, h2. rewrite PP in h1, h2.
    assert (A : dot a' a' = dot w y) by (rewrite <- (P a'), dot_weighted; fold (image V a'); rewrite Ey; reflexivity).
    assert (Sa : size (part f p a) <= size a').
    { replace (part f p a) with (part f p a'); [apply size_below; [apply size_nonneg |]; rewrite size_square; apply part_dot |].
      apply same_entries; [destruct p; cbn [part]; rewrite ?skipn_length, ?firstn_length; congruence |]. intro i. destruct p; cbn [part].
      - rewrite !rest_entries, Ea. destruct (Nat.lt_ge_cases (f + i) n) as [l | l]; [rewrite (e1 _ l) by lia; ring | rewrite (nth_overflow a') by lia; ring].
      - rewrite !first_entries, Ea. destruct (Nat.ltb_spec i f) as [l | l]; [| reflexivity].
        destruct (Nat.lt_ge_cases i n) as [l' | l']; [rewrite (e1 _ l' l); ring | rewrite (nth_overflow a') by lia; ring]. }
    pose proof (size_nonneg a') as s0. pose proof (size_nonneg w) as w0. pose proof (size_nonneg y) as y0. split.
    + apply Rle_trans with (kappa * size a'); [apply Rmult_le_compat_l; lra |].
      assert (B : kappa * size w <= size a') by (apply Rnot_lt_le; intro k; rewrite <- !size_square in h1; assert (0 <= kappa * size w) by (apply Rmult_le_pos; lra); nra).
      pose proof (dot_sizes w y) as C. rewrite <- A, <- size_square in C. apply Rnot_lt_le. intro k.
      assert (0 < size a') by (apply Rnot_le_lt; intro k'; nra). nra.
    + intro eb. apply Rle_trans with (1 := Sa). apply size_below; [exact z0 |]. specialize (h2 (-1) ltac:(pose proof (dot_self w); lra)).
      rewrite <- eb, (dot_commutes y w), <- A in h2. lra.
Qed.

Lemma W_injective : forall v, length v = n -> image W v = nought n -> v = nought n.
Proof.
  intros v lv h. apply (small_zero f n v lv), norm_below. intro p. destruct (part_bounds p) as [kappa [z [gk [_ [_ B]]]]]. destruct (B v lv) as [h1 _]. rewrite h in h1.
  assert (Z : size (nought n) <= 0) by (apply size_below; [lra |]; rewrite dot_zero; [lra | unfold nought; clear; induction n; constructor; auto]).
  pose proof (size_nonneg (part f p v)). nra.
Qed.

Lemma inverse_exists : exists inv : list R -> list R, forall y, length y = n -> length (inv y) = n /\ image W (inv y) = y.
Proof.
  assert (U : forall i, exists a, (i < n)%nat -> length a = n /\ forall j, dot (nth j W []) a = if Nat.eqb j i then 1 else 0).
  { intro i. set (y := repeat 0 i ++ 1 :: repeat 0 (n - S i)). destruct (Nat.lt_ge_cases i n) as [l | l]; [| exists []; lia].
    destruct (solvable n W y) as [a [la ha]]; [apply J_length | unfold y; rewrite app_length; cbn [length]; rewrite !repeat_length; lia | exact W_injective |].
    exists a. intros _. split; [exact la |]. intro j. rewrite <- image_entries, ha. unfold y. destruct (Nat.eqb_spec j i) as [-> | d].
    - rewrite app_nth2, repeat_length, Nat.sub_diag by (rewrite repeat_length; lia). reflexivity.
    - destruct (Nat.lt_ge_cases j i) as [k | k]; [rewrite app_nth1 by (rewrite repeat_length; exact k); apply nth_repeat |].
      rewrite app_nth2 by (rewrite repeat_length; lia). rewrite repeat_length. destruct (j - i)%nat as [| k'] eqn:e; [lia |]. cbn [nth]. apply nth_repeat_all. }
  assert (Columns : exists B : list (list R), length B = n /\ forall i, (i < n)%nat -> length (nth i B []) = n /\ forall j, dot (nth j W []) (nth i B []) = if Nat.eqb j i then 1 else 0).
  { enough (K : forall k, exists B : list (list R), length B = k /\ forall i, (i < k)%nat -> (i < n)%nat -> length (nth i B []) = n /\ forall j, dot (nth j W []) (nth i B []) = if Nat.eqb j i then 1 else 0).
    { destruct (K n) as [B [l H]]. exists B. split; [exact l |]. intros i hi. apply H; exact hi. }
    induction k as [| k [B [l H]]]; [exists []; split; [reflexivity | lia] |]. destruct (U k) as [a ha]. exists (B ++ [a]). split; [rewrite app_length; cbn; lia |].
    intros i hi hn. destruct (Nat.eq_dec i k) as [-> | d]; [rewrite <- l at 1; rewrite <- l in ha |- *; rewrite nth_middle; apply ha; lia | rewrite app_nth1 by lia; apply H; lia]. }
  destruct Columns as [B [lB hB]]. exists (fun y => map (fun i => nth i (weighted_sum y B) 0) (seq 0 n)). intros y ly.
  assert (Over : forall i, (n <= i)%nat -> nth i (weighted_sum y B) 0 = 0).
  { intros i hi. rewrite weighted_entries. apply dot_zero, Forall_forall. intros x ix. apply in_map_iff in ix as [r [<- ir]]. destruct (In_nth _ _ [] ir) as [k [hk <-]].
    symmetry. apply nth_overflow. rewrite (proj1 (hB k ltac:(lia))). exact hi. }
  set (v := map _ (seq 0 n)). assert (lv : length v = n) by (unfold v; rewrite map_length, seq_length; reflexivity). split; [exact lv |].
  assert (Ev : forall i, nth i v 0 = nth i (weighted_sum y B) 0).
  { intro i. destruct (Nat.lt_ge_cases i n) as [l | l]; [| rewrite Over by exact l; apply nth_overflow; lia]. unfold v.
    rewrite (nth_indep _ 0 (nth 0 (weighted_sum y B) 0)) by (rewrite map_length, seq_length; exact l). rewrite (map_nth (fun i => nth i (weighted_sum y B) 0)), seq_nth by exact l. reflexivity. }
  apply same_entries; [unfold image, W; rewrite map_length, J_length; congruence |]. intro j. rewrite image_entries.
  destruct (Nat.lt_ge_cases j n) as [l | l]; [| rewrite (nth_overflow W) by (unfold W; rewrite J_length; exact l); rewrite (nth_overflow y) by lia; reflexivity].
  rewrite dot_commutes, (dot_entries _ _ _ Ev), dot_weighted, dot_commutes.
  rewrite (dot_entries y _ (repeat 0 j ++ [1])); [rewrite Cell.dot_unit; ring |]. intro k.
  destruct (Nat.lt_ge_cases k n) as [lk | lk].
  - rewrite (nth_indep _ 0 (dot [] (nth j W []))) by (rewrite map_length; lia). rewrite (map_nth (fun r => dot r (nth j W []))), dot_commutes. rewrite (proj2 (hB k lk)).
    destruct (Nat.eqb_spec j k) as [-> | d]; [rewrite app_nth2, repeat_length, Nat.sub_diag by (rewrite repeat_length; lia); reflexivity |].
    destruct (Nat.lt_ge_cases k j) as [c | c]; [rewrite app_nth1 by (rewrite repeat_length; exact c); symmetry; apply nth_repeat_all |].
    rewrite app_nth2 by (rewrite repeat_length; lia). rewrite repeat_length. destruct (k - j)%nat as [| k'] eqn:e; [lia |]. cbn [nth]. destruct k'; reflexivity.
  - rewrite !nth_overflow; [reflexivity | rewrite app_length, repeat_length; cbn; lia | rewrite map_length; lia].
Qed.
(** What values differ by from their first order. *)
Definition rest (u v : list R) : list R := less (less (value v) (value u)) (image W (less v u)).

Lemma on_segment : forall u v t, inside u -> inside v -> 0 <= t <= 1 -> inside (comb 1 t u (less v u)).
Proof.
  intros u v t [lu hu] [lv hv] ht. replace (comb 1 t u (less v u)) with (comb (1 - t) t u v).
  - split; [rewrite comb_length; congruence |]. eapply Rle_trans; [apply norm_comb |]. rewrite !Rabs_pos_eq by lra. nra.
  - apply same_entries; [rewrite !comb_length; rewrite ?less_length with (n := n); congruence |]. intro i. rewrite !comb_entries, less_entries. ring.
Qed.
Lemma image_length : forall u w, length (image (J u) w) = n.
Proof. intros. unfold image. rewrite map_length. apply J_length. Qed.
Lemma image_W_length : forall w, length (image W w) = n.
Proof. intro. apply image_length. Qed.
Lemma rest_length : forall u v, length (rest u v) = n.
Proof. intros. unfold rest. rewrite !(less_length n); auto using value_length, image_W_length. rewrite (less_length n); auto using value_length. Qed.

Lemma dot_derivable : forall e (h : R -> list R) t l, (forall i, derivable_pt_lim (fun x => nth i (h x) 0) t (nth i l 0)) -> derivable_pt_lim (fun x => dot e (h x)) t (dot e l).
Proof.
  assert (D : forall a e l, dot (a :: e) l = a * nth 0 l 0 + dot e (tl l)) by (intros a e [| x l]; cbn; [destruct e; cbn; ring | reflexivity]).
  induction e as [| a e IH]; intros h t l H; [exact (derivable_const 0 t) |].
  assert (T : forall i, derivable_pt_lim (fun x => nth i (tl (h x)) 0) t (nth i (tl l) 0)).
  { intro i. eapply derivable_eq; [exact (H (S i)) | |]; [intro x; cbv beta; destruct (h x) | destruct l]; cbn [tl nth]; destruct i; reflexivity. }
  eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_scal a _ _ _ (H 0%nat)) (IH (fun x => tl (h x)) t (tl l) T)) | intro; apply D | apply D].
Qed.

Lemma along : forall e u v, inside u -> inside v -> forall t, 0 <= t <= 1 ->
  derivable_pt_lim (fun x => dot e (value (comb 1 x u (less v u))) - x * dot e (image W (less v u))) t
    (dot e (less (image (J (comb 1 t u (less v u))) (less v u)) (image W (less v u)))).
Proof.
  intros e u v hu hv t ht.
  assert (H : forall i, derivable_pt_lim (fun x => nth i (value (comb 1 x u (less v u))) 0) t (nth i (image (J (comb 1 t u (less v u))) (less v u)) 0)).
  { intro i. rewrite image_entries. destruct (Nat.lt_ge_cases i n) as [l | l]; [apply smooth; assumption |].
    rewrite (nth_overflow (J _)) by (rewrite J_length; exact l). cbn [dot]. eapply derivable_eq; [exact (derivable_const 0 t) | | reflexivity]. intro x. apply nth_overflow. rewrite value_length. exact l. }
  eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (dot_derivable e _ t _ H) (derivable_scal (- dot e (image W (less v u))) _ _ _ (derivable_pt_lim_id t))) | |].
  - intro x. unfold id. ring.
  - rewrite dot_less. ring.
Qed.
Lemma rest_along : forall e u v, length u = n -> length v = n -> dot e (rest u v) =
  (dot e (value (comb 1 1 u (less v u))) - 1 * dot e (image W (less v u))) - (dot e (value (comb 1 0 u (less v u))) - 0 * dot e (image W (less v u))).
Proof.
  intros e u v lu lv. replace (comb 1 1 u (less v u)) with v.
  2: { apply same_entries; [rewrite comb_length, lu; [exact lv | rewrite less_length with (n := n); congruence] |]. intro i. rewrite comb_entries, less_entries. ring. }
  replace (comb 1 0 u (less v u)) with u.
  2: { apply same_entries; [rewrite comb_length; [reflexivity | rewrite less_length with (n := n); congruence] |]. intro i. rewrite comb_entries, less_entries. ring. }
  unfold rest. rewrite !dot_less. ring.
Qed.

Lemma rest_between : forall u v, inside u -> inside v -> size (rest u v) <= g * norm (less v u).
Proof.
  intros u v hu hv. set (e := rest u v). pose proof (size_nonneg e) as e0. pose proof (norm_nonneg f (less v u)) as d0.
  destruct (MeanValue.mean_value_theorem _ _ 0 1 Rlt_0_1 (fun t ht => along e u v hu hv t ht)) as [t [E ht]].
  rewrite <- rest_along in E by (apply hu || apply hv). fold e in E. rewrite <- size_square in E.
  pose proof (on_segment u v t hu hv ltac:(lra)) as hs. set (x := comb 1 t u (less v u)) in *.
  pose proof (spread x (less v u) hs (less_length n v u (proj1 hv) (proj1 hu))) as S. pose proof (dot_sizes e (less (image (J x) (less v u)) (image W (less v u)))) as C.
  assert (Y : g * norm x * norm (less v u) <= g * norm (less v u)).
  { rewrite Rmult_assoc. apply Rmult_le_compat_l; [exact g_nonneg |]. destruct hs as [_ hs]. nra. }
  apply Rnot_lt_le. intro k. assert (0 < size e) by (pose proof (Rmult_le_pos _ _ g_nonneg d0); lra). nra.
Qed.

Lemma rest_from_zero : forall u, inside u -> size (rest (nought n) u) <= g / 2.
Proof.
  intros u hu. set (e := rest (nought n) u). pose proof (size_nonneg e) as e0.
  assert (hz : inside (nought n)) by (split; [apply nought_length | pose proof (nought_norm f n); lra]). set (k := g / 2 * size e).
  assert (d : less u (nought n) = u) by (apply same_entries; [rewrite (less_length n), (proj1 hu) by (apply hu || apply nought_length); reflexivity |]; intro i; rewrite less_entries, nought_entries; ring).
  assert (H : forall t, 0 <= t <= 1 -> derivable_pt_lim (fun x => (dot e (value (comb 1 x (nought n) (less u (nought n)))) - x * dot e (image W (less u (nought n)))) + - k * x ^ 2) t
    (dot e (less (image (J (comb 1 t (nought n) (less u (nought n)))) (less u (nought n))) (image W (less u (nought n)))) + - k * (2 * t * 1))).
  { intros t ht. apply derivable_add; [apply along; assumption | apply derivable_scal, derivable_square, derivable_pt_lim_id]. }
  destruct (MeanValue.mean_value_theorem _ _ 0 1 Rlt_0_1 H) as [t [E ht]]. cbv beta in E. clear H.
  pose proof (rest_along e (nought n) u (proj1 hz) (proj1 hu)) as Q. fold e in Q. rewrite <- size_square in Q.
  assert (E2 : size e ^ 2 - k = dot e (less (image (J (comb 1 t (nought n) (less u (nought n)))) (less u (nought n))) (image W (less u (nought n)))) + - k * (2 * t * 1)) by lra.
  clear E Q. rewrite d in E2. pose proof (on_segment (nought n) u t hz hu ltac:(lra)) as hs. rewrite d in hs. set (x := comb 1 t (nought n) u) in *.
  pose proof (spread x u hs (proj1 hu)) as S. pose proof (dot_sizes e (less (image (J x) u) (image W u))) as C.
  assert (xt : norm x <= t).
  { unfold x. eapply Rle_trans; [apply norm_comb |]. rewrite Rabs_R1, Rabs_pos_eq by lra. pose proof (nought_norm f n). destruct hu as [_ hu]. nra. }
  assert (B : g * norm x * norm u <= g * t).
  { rewrite Rmult_assoc. apply Rmult_le_compat_l; [exact g_nonneg |]. pose proof (norm_nonneg f x). pose proof (norm_nonneg f u). destruct hu as [_ hu]. nra. }
  assert (B2 : size e * size (less (image (J x) u) (image W u)) <= size e * (g * t)) by (apply Rmult_le_compat_l; [exact e0 | lra]).
  assert (F : size e ^ 2 <= k) by (unfold k in *; nra). apply Rnot_lt_le. intro nn. unfold k in F. nra.
Qed.

Theorem one_point : exists u, (inside u /\ value u = comb 1 1 (value (nought n)) b) /\ forall v, inside v -> value v = comb 1 1 (value (nought n)) b -> v = u.
Proof.
  destruct inverse_exists as [inv hinv].
  destruct (part_bounds false) as [k1 [z1 [gk1 [z01 [zg1 B1]]]]]. destruct (part_bounds true) as [k2 [z2 [gk2 [z02 [zg2 B2]]]]]. set (k := Rmin k1 k2).
  assert (kg : g < k) by (apply Rmin_glb_lt; assumption). assert (k0 : 0 < k) by lra.
  assert (Whole : forall a, length a = n -> k * norm a <= size (image W a)).
  { intros a la. apply Rmult_le_reg_l with (/ k); [apply Rinv_0_lt_compat, k0 |]. rewrite <- Rmult_assoc, Rinv_l, Rmult_1_l by lra. apply norm_below. intro p.
    apply Rmult_le_reg_l with k; [exact k0 |]. rewrite <- Rmult_assoc, Rinv_r, Rmult_1_l by lra.
    assert (k <= k1 /\ k <= k2) by (split; [apply Rmin_l | apply Rmin_r]). pose proof (size_nonneg (part f p a)).
    destruct p; [eapply Rle_trans; [| apply (B2 a la)] | eapply Rle_trans; [| apply (B1 a la)]]; apply Rmult_le_compat_r; lra. }
  set (F := fun u => less (inv b) (inv (rest (nought n) u))).
  assert (lF : forall u, length (F u) = n) by (intro u; apply less_length; apply hinv; [exact b_length | apply rest_length]).
  assert (Linear : forall u v, length u = n -> length v = n -> image W (less u v) = less (image W u) (image W v)).
  { intros u v lu lv. apply same_entries; [rewrite (less_length n) by apply image_W_length; apply image_W_length |]. intro i. rewrite less_entries, !image_entries. rewrite dot_less. ring. }
  assert (WF : forall u, image W (F u) = less b (rest (nought n) u)).
  { intro u. unfold F. destruct (hinv b b_length) as [l1 e1]. destruct (hinv (rest (nought n) u) (rest_length _ _)) as [l2 e2]. rewrite Linear by assumption. congruence. }
  assert (hz : inside (nought n)) by (split; [apply nought_length | pose proof (nought_norm f n); lra]).
  assert (Rest : forall u v, length u = n -> length v = n -> less (rest (nought n) v) (rest (nought n) u) = rest u v).
  { intros u v lu lv. apply same_entries; [rewrite (less_length n), rest_length by apply rest_length; reflexivity |]. intro i. unfold rest. rewrite !less_entries, !image_entries.
    rewrite !dot_less. ring. }
  assert (q1 : g / k < 1) by (apply Rmult_lt_reg_r with k; [exact k0 |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l; lra).
  assert (q0 : 0 <= g / k) by (apply Rmult_le_pos; [exact g_nonneg | apply Rlt_le, Rinv_0_lt_compat, k0]).
  destruct (fixed_point f n (g / k) F (conj q0 q1)) as [u [hu e]].
  - intros u hu. split; [apply lF |]. apply norm_below. intro p. unfold F, less. rewrite part_comb. eapply Rle_trans; [apply size_comb |]. rewrite abs_minus_one, Rabs_R1, !Rmult_1_l.
    destruct (hinv b b_length) as [l1 e1]. destruct (hinv (rest (nought n) u) (rest_length _ _)) as [l2 e2]. pose proof (rest_from_zero u hu) as R0.
    assert (Each : forall kp zp, g < kp -> zp + g / (2 * kp) <= 1 -> size (part f p (inv b)) <= zp -> kp * size (part f p (inv (rest (nought n) u))) <= g / 2 ->
      size (part f p (inv b)) + size (part f p (inv (rest (nought n) u))) <= 1).
    { intros kp zp gk zg h1 h2. assert (size (part f p (inv (rest (nought n) u))) <= g / (2 * kp)); [| lra]. apply Rmult_le_reg_l with kp; [lra |].
      replace (kp * (g / (2 * kp))) with (g / 2) by (field; lra). exact h2. }
    destruct p.
    + destruct (B2 _ l1) as [_ c1]. destruct (B2 _ l2) as [c2 _]. rewrite e2 in c2. apply (Each k2 z2); auto. lra.
    + destruct (B1 _ l1) as [_ c1]. destruct (B1 _ l2) as [c2 _]. rewrite e2 in c2. apply (Each k1 z1); auto. lra.
  - intros u v hu hv. pose proof (Whole (less (F u) (F v)) (less_length n _ _ (lF u) (lF v))) as h. rewrite Linear, !WF in h by apply lF.
    replace (less (less b (rest (nought n) u)) (less b (rest (nought n) v))) with (rest u v) in h.
    + pose proof (rest_between u v hu hv) as h2. pose proof (less_opposite f n v u (proj1 hv) (proj1 hu)) as h3. apply Rmult_le_reg_l with k; [exact k0 |].
      replace (k * (g / k * norm (less u v))) with (g * norm (less u v)) by (field; lra). apply Rle_trans with (1 := h). apply Rle_trans with (1 := h2). apply Rmult_le_compat_l; assumption.
    + rewrite <- Rest by (apply hu || apply hv). apply same_entries; [rewrite !(less_length n); rewrite ?(less_length n); auto using rest_length |]. intro i. rewrite !less_entries. ring.
  - assert (Solves : value u = comb 1 1 (value (nought n)) b).
    { pose proof (WF u) as h. rewrite e in h. unfold rest in h. destruct hu as [lu _].
      apply same_entries; [rewrite comb_length; rewrite !value_length; congruence |]. intro i. pose proof (f_equal (fun l => nth i l 0) h) as hi. cbv beta in hi.
      rewrite !less_entries, !image_entries in hi. rewrite dot_less in hi.
      assert (Z : dot (nth i W []) (nought n) = 0) by (apply dot_zero; unfold nought; clear; induction n; constructor; auto).
      rewrite Z in hi. rewrite comb_entries. lra. }
    exists u. split; [split; assumption |]. intros v hv ev. apply (less_zero f n); [apply hv | apply hu |].
    pose proof (Whole (less v u) (less_length n _ _ (proj1 hv) (proj1 hu))) as h. pose proof (rest_between u v hu hv) as h2.
    assert (S : size (rest u v) = size (image W (less v u))).
    { unfold size. f_equal. unfold rest. replace (less (less (value v) (value u)) (image W (less v u))) with (map (Rmult (-1)) (image W (less v u))).
      - rewrite dot_map, dot_commutes, dot_map. ring.
      - rewrite ev, Solves. apply same_entries; [rewrite map_length, !(less_length n); auto using image_W_length; rewrite ?(less_length n); auto; rewrite comb_length; rewrite !value_length; congruence |].
        intro i. rewrite map_entries, !less_entries. ring. }
    rewrite S in h2. pose proof (norm_nonneg f (less v u)). nra.
Qed.
End Near.
