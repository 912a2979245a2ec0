(** * The test of accuracy: formulas near a cell, and at its vertices

    Of machines with three joints and three coordinates (test/accuracy.rs). Formulas near a cell have its points as
    expansion points, and what is off by at most the distance as their range: coordinate k is x_k + d lambda_k. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Formula Linear Arithmetic Slope Definite Test Cell Apart Solve.
Import ListNotations.
Local Open Scope R_scope.

Lemma cauchy_step : forall A B C s x y, A ^ 2 <= B * C -> 0 <= B -> 0 <= C -> 0 <= s ->
  (A + s * (x * y)) ^ 2 <= (B + s * x ^ 2) * (C + s * y ^ 2) /\ 0 <= B + s * x ^ 2 /\ 0 <= C + s * y ^ 2.
Proof.
  intros A B C s x y h b c s0. pose proof (pow2_ge_0 x). pose proof (pow2_ge_0 y).
  assert (0 <= s * x ^ 2) by (apply Rmult_le_pos; assumption). assert (0 <= s * y ^ 2) by (apply Rmult_le_pos; assumption).
  split; [| split; lra].
  assert (K : 2 * A * (x * y) <= B * y ^ 2 + C * x ^ 2).
  { assert (P : 0 <= B * y ^ 2 + C * x ^ 2) by (apply Rplus_le_le_0_compat; apply Rmult_le_pos; assumption).
    assert (S : (2 * A * (x * y)) ^ 2 <= (B * y ^ 2 + C * x ^ 2) ^ 2).
    { pose proof (pow2_ge_0 (B * y ^ 2 - C * x ^ 2)). assert (0 <= x ^ 2 * y ^ 2) by (apply Rmult_le_pos; assumption).
      assert (A ^ 2 * (x ^ 2 * y ^ 2) <= B * C * (x ^ 2 * y ^ 2)) by (apply Rmult_le_compat_r; assumption). nra. }
    apply Rnot_lt_le. intro n. nra. }
  assert (s * (2 * A * (x * y)) <= s * (B * y ^ 2 + C * x ^ 2)) by (apply Rmult_le_compat_l; assumption). nra.
Qed.

(** Nine numbers: |w^T S l|^2 <= (greatest sum of a row) (greatest sum of a column) |w|^2 |l|^2. *)
Lemma schur_test : forall (S M : nat -> nat -> R) R_ C_ w0 w1 w2 l0 l1 l2, (forall j k, Rabs (S j k) <= M j k) ->
  (forall j, M j 0%nat + M j 1%nat + M j 2%nat <= R_) -> (forall k, M 0%nat k + M 1%nat k + M 2%nat k <= C_) ->
  let along j := S j 0%nat * l0 + S j 1%nat * l1 + S j 2%nat * l2 in
  (w0 * along 0%nat + w1 * along 1%nat + w2 * along 2%nat) ^ 2 <= R_ * C_ * ((w0 ^ 2 + w1 ^ 2 + w2 ^ 2) * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2)).
Proof.
  intros S M R_ C_ w0 w1 w2 l0 l1 l2 hM hR hC along.
  assert (M0 : forall j k, 0 <= M j k) by (intros j k; eapply Rle_trans; [apply Rabs_pos | apply hM]).
  set (a0 := Rabs w0). set (a1 := Rabs w1). set (a2 := Rabs w2). set (b0 := Rabs l0). set (b1 := Rabs l1). set (b2 := Rabs l2).
  assert (Sq : forall x, Rabs x ^ 2 = x ^ 2) by (intro; apply pow2_abs).
  assert (T : forall j k w l, w * (S j k * l) <= M j k * (Rabs w * Rabs l) /\ - (w * (S j k * l)) <= M j k * (Rabs w * Rabs l)).
  { intros j k w l. assert (E : Rabs (w * (S j k * l)) <= M j k * (Rabs w * Rabs l)).
    { rewrite !Rabs_mult. replace (Rabs w * (Rabs (S j k) * Rabs l)) with (Rabs (S j k) * (Rabs w * Rabs l)) by ring. apply Rmult_le_compat_r; [apply Rmult_le_pos; apply Rabs_pos | apply hM]. }
    pose proof (Rle_abs (w * (S j k * l))). pose proof (Rle_abs (- (w * (S j k * l)))) as n. rewrite Rabs_Ropp in n. lra. }
  set (A := 0 + M 0%nat 0%nat * (a0 * b0) + M 0%nat 1%nat * (a0 * b1) + M 0%nat 2%nat * (a0 * b2) + M 1%nat 0%nat * (a1 * b0) + M 1%nat 1%nat * (a1 * b1)
    + M 1%nat 2%nat * (a1 * b2) + M 2%nat 0%nat * (a2 * b0) + M 2%nat 1%nat * (a2 * b1) + M 2%nat 2%nat * (a2 * b2)).
  assert (le : (w0 * along 0%nat + w1 * along 1%nat + w2 * along 2%nat) ^ 2 <= A ^ 2).
  { assert (H : - A <= w0 * along 0%nat + w1 * along 1%nat + w2 * along 2%nat <= A).
    { pose proof (T 0%nat 0%nat w0 l0). pose proof (T 0%nat 1%nat w0 l1). pose proof (T 0%nat 2%nat w0 l2). pose proof (T 1%nat 0%nat w1 l0). pose proof (T 1%nat 1%nat w1 l1).
      pose proof (T 1%nat 2%nat w1 l2). pose proof (T 2%nat 0%nat w2 l0). pose proof (T 2%nat 1%nat w2 l1). pose proof (T 2%nat 2%nat w2 l2).
      unfold A, along, a0, a1, a2, b0, b1, b2. lra. }
    nra. }
  apply Rle_trans with (1 := le).
  assert (I0 : 0 ^ 2 <= 0 * 0) by lra.
  destruct (cauchy_step 0 0 0 _ a0 b0 I0 (Rle_refl 0) (Rle_refl 0) (M0 0%nat 0%nat)) as [I1 [B1 C1]].
  destruct (cauchy_step _ _ _ _ a0 b1 I1 B1 C1 (M0 0%nat 1%nat)) as [I2 [B2 C2]]. destruct (cauchy_step _ _ _ _ a0 b2 I2 B2 C2 (M0 0%nat 2%nat)) as [I3 [B3 C3]].
  destruct (cauchy_step _ _ _ _ a1 b0 I3 B3 C3 (M0 1%nat 0%nat)) as [I4 [B4 C4]]. destruct (cauchy_step _ _ _ _ a1 b1 I4 B4 C4 (M0 1%nat 1%nat)) as [I5 [B5 C5]].
  destruct (cauchy_step _ _ _ _ a1 b2 I5 B5 C5 (M0 1%nat 2%nat)) as [I6 [B6 C6]]. destruct (cauchy_step _ _ _ _ a2 b0 I6 B6 C6 (M0 2%nat 0%nat)) as [I7 [B7 C7]].
  destruct (cauchy_step _ _ _ _ a2 b1 I7 B7 C7 (M0 2%nat 1%nat)) as [I8 [B8 C8]]. destruct (cauchy_step _ _ _ _ a2 b2 I8 B8 C8 (M0 2%nat 2%nat)) as [I9 [B9 C9]].
  apply Rle_trans with (1 := I9).
  match type of I9 with _ <= ?b * ?c => set (B := b) in *; set (C := c) in * end.
  assert (HB : B <= R_ * (w0 ^ 2 + w1 ^ 2 + w2 ^ 2)).
  { unfold B, a0, a1, a2. rewrite !Sq. pose proof (pow2_ge_0 w0). pose proof (pow2_ge_0 w1). pose proof (pow2_ge_0 w2).
    pose proof (Rmult_le_compat_r _ _ _ (pow2_ge_0 w0) (hR 0%nat)). pose proof (Rmult_le_compat_r _ _ _ (pow2_ge_0 w1) (hR 1%nat)). pose proof (Rmult_le_compat_r _ _ _ (pow2_ge_0 w2) (hR 2%nat)). lra. }
  assert (HC : C <= C_ * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2)).
  { unfold C, b0, b1, b2. rewrite !Sq.
    pose proof (Rmult_le_compat_r _ _ _ (pow2_ge_0 l0) (hC 0%nat)). pose proof (Rmult_le_compat_r _ _ _ (pow2_ge_0 l1) (hC 1%nat)). pose proof (Rmult_le_compat_r _ _ _ (pow2_ge_0 l2) (hC 2%nat)). lra. }
  replace (R_ * C_ * ((w0 ^ 2 + w1 ^ 2 + w2 ^ 2) * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2))) with (R_ * (w0 ^ 2 + w1 ^ 2 + w2 ^ 2) * (C_ * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2))) by ring.
  apply Rmult_le_compat; assumption.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation unit := (unit_R bits).

(** ** Formulas near a cell *)

Fixpoint near_coords (j : nat) (cell : list fixed) (d : fixed) : list slope :=
  match cell with
  | [] => []
  | a :: rest => Slope a (Fixed (lo a - hi d) (hi a + hi d)) (repeat zero j ++ [d]) :: near_coords (S j) rest d
  end.
Definition moved (d : R) (x lambda : list R) : list R := map (fun p => fst p + d * snd p) (combine x lambda).

Lemma near_hold : forall dist d, contains dist d -> 0 <= d -> forall cell x, Forall2 contains cell x ->
  forall lambda, length lambda = length cell -> Forall (fun t => -1 <= t <= 1) lambda -> forall after before k,
  holds bits (before ++ lambda ++ after) (nth k (near_coords (length before) cell dist) (constant zero)) (nth k x 0) (nth k (moved d x lambda) 0).
Proof.
  intros dist d hd d0. induction 1 as [| a y cell x h hs IH]; intros [| t lambda] e hl after before [| k]; try discriminate; cbn [near_coords moved combine map nth fst snd];
    try (apply constant_holds, zero_sound).
  - inversion hl as [| ? ? ht hl']; subst. split; [exact h |]. split.
    + pose proof (unit_R_pos bits) as p. destruct h as [l u], hd as [l' u'].
      assert (h1 : d * t * unit <= d * unit) by (apply Rmult_le_compat_r; nra). assert (h2 : - d * unit <= d * t * unit) by (apply Rmult_le_compat_r; nra).
      split; cbn [range lo hi]; rewrite ?minus_IZR, ?plus_IZR; lra.
    + exists (repeat 0 (length before) ++ [d]). split.
      * apply Forall2_app; [clear; induction (length before); cbn; constructor; auto using zero_sound | constructor; [exact hd | constructor]].
      * cbn [app]; rewrite dot_unit, nth_middle. ring.
  - inversion hl as [| ? ? ht hl']; subst. specialize (IH lambda ltac:(cbn in e; congruence) hl' after (before ++ [t]) k).
    rewrite app_length, <- app_assoc in IH. rewrite Nat.add_1_r in IH. exact IH.
Qed.

Variable tape : list (op address).
Variable params : list fixed.
Local Notation formula_at i := (nth i (formulas tape) (integer 0)).

Definition evaluate_near (keep : list bool) (cell : list fixed) (d : fixed) : list (option slope) :=
  run_kept (option slope) None (slope_op bits (near_coords 0 cell d) (map constant params)) keep tape.

Lemma near_encloses : forall keep dist d cell x lambda theta, contains dist d -> 0 <= d -> Forall2 contains cell x -> length lambda = length cell ->
  Forall (fun t => -1 <= t <= 1) lambda -> Forall2 contains params theta ->
  forall i, encloses bits lambda (moved d x lambda) x theta (nth i (evaluate_near keep cell dist) None) (formula_at i).
Proof.
  intros keep dist d cell x lambda theta hd d0 hx el hl ht i.
  apply (nth_related _ _ _ _ (encloses bits lambda (moved d x lambda) x theta)); [exact I |].
  apply (evaluate_kept_sound bits lambda hl (moved d x lambda) x theta).
  - pose proof (near_hold dist d hd d0 cell x hx lambda el hl [] []) as N. cbn [app length] in N. rewrite app_nil_r in N. exact N.
  - apply params_hold, ht.
Qed.

(** ** How much the rows differ near a cell *)

Definition point_of (n : Z) : fixed := Fixed n n.
Definition triple : Type := slope * slope * slope.
Fixpoint triples (r : rows slope) : option (list triple) :=
  match r with
  | [] => Some []
  | ([a; b; c], _) :: r' => option_map (cons (a, b, c)) (triples r')
  | _ => None
  end.
Definition entry_of_row (r : triple) (j : nat) : slope := let '(a, b, c) := r in match j with O => a | S O => b | _ => c end.
(** Entry k of the slopes of entry j of a row. *)
Definition magnitude_of (r : triple) (j k : nat) : Z := magnitude (nth k (slopes (entry_of_row r j)) zero).
Definition row_norm (r : triple) : fixed :=
  let m := magnitude_of r in
  let greatest f := Z.max (f 0%nat) (Z.max (f 1%nat) (f 2%nat)) in
  greatest_root bits (mul bits (point_of (greatest (fun j => m j 0%nat + m j 1%nat + m j 2%nat)%Z)) (point_of (greatest (fun k => m 0%nat k + m 1%nat k + m 2%nat k)%Z))).
Definition spread (rs : list triple) : fixed :=
  greatest_root bits (fold_right (fun r sum => add sum (sqr bits (row_norm r))) zero rs).

Lemma magnitude_above : forall a x, contains a x -> Rabs x <= IZR (magnitude a) / unit.
Proof.
  intros a x h. pose proof (unit_R_pos bits) as p. pose proof (magnitude_sound bits a x 1 h ltac:(lra)) as m. rewrite Rmult_1_r in m.
  apply Rmult_le_reg_r with unit; [exact p |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  rewrite <- (Rabs_pos_eq unit) at 1 by lra. rewrite <- Rabs_mult. apply Rabs_le. lra.
Qed.

Lemma nth_contains : forall s u, Forall2 contains s u -> forall k, contains (nth k s zero) (nth k u 0).
Proof. induction 1; intros [| k]; cbn [nth]; auto using zero_sound. Qed.

Lemma dot_three : forall u a b c, dot u [a; b; c] = nth 0 u 0 * a + nth 1 u 0 * b + nth 2 u 0 * c.
Proof. intros [| p [| q [| r [| s u]]]] a b c; cbn; ring. Qed.

Lemma row_norm_sound : forall r (u : nat -> list R) w0 w1 w2 l0 l1 l2, (forall j, Forall2 contains (slopes (entry_of_row r j)) (u j)) ->
  exists n, contains (row_norm r) n /\ 0 <= n /\
  (w0 * dot (u 0%nat) [l0; l1; l2] + w1 * dot (u 1%nat) [l0; l1; l2] + w2 * dot (u 2%nat) [l0; l1; l2]) ^ 2 <= n ^ 2 * ((w0 ^ 2 + w1 ^ 2 + w2 ^ 2) * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2)).
Proof.
  intros r u w0 w1 w2 l0 l1 l2 hu. unfold row_norm. cbv zeta. set (m := magnitude_of r).
  set (gr := Z.max (m 0%nat 0%nat + m 0%nat 1%nat + m 0%nat 2%nat) (Z.max (m 1%nat 0%nat + m 1%nat 1%nat + m 1%nat 2%nat) (m 2%nat 0%nat + m 2%nat 1%nat + m 2%nat 2%nat))).
  set (gc := Z.max (m 0%nat 0%nat + m 1%nat 0%nat + m 2%nat 0%nat) (Z.max (m 0%nat 1%nat + m 1%nat 1%nat + m 2%nat 1%nat) (m 0%nat 2%nat + m 1%nat 2%nat + m 2%nat 2%nat))).
  pose proof (unit_R_pos bits) as p. set (R_ := IZR gr / unit). set (C_ := IZR gc / unit).
  assert (M0 : forall j k, 0 <= IZR (m j k) / unit) by (intros j k; eapply Rle_trans; [apply Rabs_pos | apply (magnitude_above _ _ (nth_contains _ _ (hu j) k))]).
  pose proof (schur_test (fun j k => match j, k with (0 | 1 | 2)%nat, (0 | 1 | 2)%nat => nth k (u j) 0 | _, _ => 0 end)
    (fun j k => match j, k with (0 | 1 | 2)%nat, (0 | 1 | 2)%nat => IZR (m j k) / unit | _, _ => 0 end) R_ C_ w0 w1 w2 l0 l1 l2) as S. cbv beta in S.
  assert (Le : forall z g, (z <= g)%Z -> IZR z / unit <= IZR g / unit) by (intros z g h; apply IZR_le in h; apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, p | exact h]).
  assert (Sum : forall a b c, IZR a / unit + IZR b / unit + IZR c / unit = IZR (a + b + c) / unit) by (intros; rewrite !plus_IZR; field; lra).
  assert (R0 : 0 <= R_) by (eapply Rle_trans; [| apply (Le (m 0%nat 0%nat + m 0%nat 1%nat + m 0%nat 2%nat)%Z); unfold gr; lia]; rewrite <- Sum; pose proof (M0 0 0)%nat; pose proof (M0 0 1)%nat; pose proof (M0 0 2)%nat; lra).
  assert (C0 : 0 <= C_) by (eapply Rle_trans; [| apply (Le (m 0%nat 0%nat + m 1%nat 0%nat + m 2%nat 0%nat)%Z); unfold gc; lia]; rewrite <- Sum; pose proof (M0 0 0)%nat; pose proof (M0 1 0)%nat; pose proof (M0 2 0)%nat; lra).
  assert (Final : (w0 * dot (u 0%nat) [l0; l1; l2] + w1 * dot (u 1%nat) [l0; l1; l2] + w2 * dot (u 2%nat) [l0; l1; l2]) ^ 2 <= R_ * C_ * ((w0 ^ 2 + w1 ^ 2 + w2 ^ 2) * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2))).
  { rewrite !dot_three. apply S.
    - intros [| [| [| j]]] [| [| [| k]]]; try (rewrite Rabs_R0; apply Rle_refl); apply (magnitude_above _ _ (nth_contains _ _ (hu _) _)).
    - intros [| [| [| j]]]; rewrite ?Sum; try (apply Le; unfold gr; lia). lra.
    - intros [| [| [| k]]]; rewrite ?Sum; try (apply Le; unfold gc; lia). lra. }
  assert (RC : contains (mul bits (point_of gr) (point_of gc)) (R_ * C_)) by (apply mul_sound; apply point_sound).
  destruct (greatest_root_sound bits _ (R_ * C_) (sqrt (R_ * C_)) RC ltac:(rewrite <- Rsqr_pow2, Rsqr_sqrt by (apply Rmult_le_pos; assumption); apply Rle_refl)) as [n [h1 [h2 h3]]].
  exists n. split; [exact h3 |]. split; [exact h2 |]. apply Rle_trans with (1 := Final).
  assert (R_ * C_ <= n ^ 2) by (pose proof (Rmult_le_pos _ _ R0 C0) as q; rewrite <- (sqrt_sqrt _ q); pose proof (sqrt_pos (R_ * C_)); nra).
  apply Rmult_le_compat_r; [| assumption]. apply Rmult_le_pos; pose proof (pow2_ge_0 w0); pose proof (pow2_ge_0 w1); pose proof (pow2_ge_0 w2); pose proof (pow2_ge_0 l0); pose proof (pow2_ge_0 l1); pose proof (pow2_ge_0 l2); lra.
Qed.

Lemma spread_sound : forall rs (u : list (nat -> list R)) w0 w1 w2 l0 l1 l2, Forall2 (fun r u => forall j, Forall2 contains (slopes (entry_of_row r j)) (u j)) rs u ->
  let along u := w0 * dot (u 0%nat) [l0; l1; l2] + w1 * dot (u 1%nat) [l0; l1; l2] + w2 * dot (u 2%nat) [l0; l1; l2] in
  exists g, contains (spread rs) g /\ 0 <= g /\
  fold_right (fun u sum => along u ^ 2 + sum) 0 u <= g ^ 2 * ((w0 ^ 2 + w1 ^ 2 + w2 ^ 2) * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2)).
Proof.
  intros rs u w0 w1 w2 l0 l1 l2 h along. set (N := (w0 ^ 2 + w1 ^ 2 + w2 ^ 2) * (l0 ^ 2 + l1 ^ 2 + l2 ^ 2)).
  assert (N0 : 0 <= N) by (unfold N; apply Rmult_le_pos; pose proof (pow2_ge_0 w0); pose proof (pow2_ge_0 w1); pose proof (pow2_ge_0 w2); pose proof (pow2_ge_0 l0); pose proof (pow2_ge_0 l1); pose proof (pow2_ge_0 l2); lra).
  assert (K : exists n, contains (fold_right (fun r sum => add sum (sqr bits (row_norm r))) zero rs) n /\ 0 <= n /\ fold_right (fun u sum => along u ^ 2 + sum) 0 u <= n * N).
  { induction h as [| r v rs u h1 h [n [k1 [k2 k3]]]]; cbn [fold_right].
    - exists 0. split; [apply zero_sound |]. split; [apply Rle_refl | lra].
    - destruct (row_norm_sound r v w0 w1 w2 l0 l1 l2 h1) as [q [q1 [q2 q3]]]. fold N in q3. fold (along v) in q3. exists (n + q ^ 2).
      split; [apply add_sound; [exact k1 | apply sqr_sound, q1] |]. pose proof (pow2_ge_0 q). split; [lra |]. lra. }
  destruct K as [n [k1 [k2 k3]]].
  destruct (greatest_root_sound bits _ n (sqrt n) k1 ltac:(rewrite <- Rsqr_pow2, Rsqr_sqrt by exact k2; apply Rle_refl)) as [g [g1 [g2 g3]]].
  exists g. split; [exact g3 |]. split; [exact g2 |]. apply Rle_trans with (1 := k3). apply Rmult_le_compat_r; [exact N0 |].
  rewrite <- (sqrt_sqrt n k2). pose proof (sqrt_pos n). nra.
Qed.

(** ** What is shown at a vertex *)

(** The greatest that joint i is off by, over the distance: error, and half-widths with the slopes of the joint's coordinate in them. *)
Definition off_at (s : list bool) (error : fixed) (hs : list (fixed * slope)) : fixed :=
  upper_end (fold_left (fun sum h => add sum (mul bits (fst h) (point_of (magnitude (at_vertex s (snd h)))))) hs error).

Definition bordered (t : triangle) (b0 b1 b2 corner : fixed) : triangle :=
  match t with
  | [[a; b; c]; [d; e]; [g]] => [[a; b; c; b0]; [d; e; b1]; [g; b2]; [corner]]
  | _ => []
  end.

(** [l]: of what is not negative at x, the value at the vertex. *)
Definition at_vertex_holds (places : N) (Y : list (list Z)) (k2 z2 l : fixed) (rows : rows fixed) (b : list fixed) : bool :=
  let t := triangle_add (repeat [neg l] 3) (gram places (solve_pairs places Y (Fixed.integer bits 1) rows)) in
  match b with
  | [b0; b1; b2] =>
      is_definite bits 3 (triangle_add (repeat [neg k2] 3) t) &&
      forallb (fun s : bool * bool => is_definite bits 4 (bordered t (if fst s then b0 else neg b0) (if snd s then b1 else neg b1) b2 (sub z2 l)))
        [(true, true); (false, true); (true, false); (false, false)]
  | _ => false
  end.

Definition accurate (less : option slope) (near : list triple) (here : rows slope) (joints : list (fixed * list (fixed * slope)))
    (places : N) (Y : list (list Z)) (kappa : Z) : bool :=
  let g := spread near in
  let k := Arithmetic.dyadic kappa places (Fixed.integer bits 1) in
  (0 <? lo (sub k g))%Z && Nat.eqb (length Y) 3 && Nat.eqb (length here) 3 &&
  match recip bits k with
  | Some r =>
      let z := sub (Fixed.integer bits 1) (halve (mul bits g r)) in
      forallb (fun s => at_vertex_holds places Y (sqr bits k) (sqr bits z) match less with Some f => at_vertex s f | None => zero end
        (map_rows (at_vertex s) here) (map (fun j => off_at s (fst j) (snd j)) joints)) (signs 3)
  | None => false
  end.

Lemma off_sound : forall s error e hs (rs : list (R * entry)), contains error e -> 0 <= e ->
  Forall2 (fun h r => contains (fst h) (fst r) /\ 0 <= fst r /\ entry_in bits (snd h) (snd r)) hs rs ->
  exists beta, contains (off_at s error hs) beta /\ fold_right (fun r sum => fst r * Rabs (at_lambda (map corner s) (snd r)) + sum) e rs <= beta.
Proof.
  intros s error e hs rs he e0 h. unfold off_at.
  assert (K : forall error e, contains error e -> exists n, contains (fold_left (fun sum h => add sum (mul bits (fst h) (point_of (magnitude (at_vertex s (snd h)))))) hs error) n /\
    fold_right (fun r sum => fst r * Rabs (at_lambda (map corner s) (snd r)) + sum) e rs <= n).
  { clear he e0 error e. induction h as [| [a f] [r t] hs rs [h1 [h2 h3]] h IH]; intros error e he; cbn [fold_left fold_right fst snd] in *.
    - exists e. split; [exact he | apply Rle_refl].
    - pose proof (magnitude_above _ _ (at_vertex_sound bits s f t h3)) as M.
      destruct (IH (add error (mul bits a (point_of (magnitude (at_vertex s f))))) (e + r * (IZR (magnitude (at_vertex s f)) / unit))) as [n [n1 n2]].
      { apply add_sound; [exact he | apply mul_sound; [exact h1 | apply point_sound]]. }
      exists n. split; [exact n1 |]. apply Rle_trans with (2 := n2).
      assert (G : forall q p (l : list (R * entry)), q <= p -> fold_right (fun r sum => fst r * Rabs (at_lambda (map corner s) (snd r)) + sum) q l + 0 <=
        fold_right (fun r sum => fst r * Rabs (at_lambda (map corner s) (snd r)) + sum) p l) by (intros q p l; induction l as [| y l I]; cbn [fold_right]; intro le; [lra | specialize (I le); lra]).
      assert (G2 : forall q p (l : list (R * entry)), fold_right (fun r sum => fst r * Rabs (at_lambda (map corner s) (snd r)) + sum) (q + p) l =
        p + fold_right (fun r sum => fst r * Rabs (at_lambda (map corner s) (snd r)) + sum) q l) by (intros q p l; induction l as [| y l I]; cbn [fold_right]; [ring | rewrite I; ring]).
      rewrite G2. apply Rplus_le_compat_r. apply Rmult_le_compat_l; assumption. }
  destruct (K error e he) as [n [n1 n2]]. destruct (upper_end_sound bits _ _ n1) as [y [y1 y2]]. exists y. split; [exact y1 | lra].
Qed.

Lemma bordered_shown : forall t S b0 b1 b2 c x0 x1 x2 C w0 w1 w2 v, is_definite bits 4 (bordered t b0 b1 b2 c) = true -> triangle_in bits t S ->
  contains b0 x0 -> contains b1 x1 -> contains b2 x2 -> contains c C -> 0 < w0 ^ 2 + w1 ^ 2 + w2 ^ 2 + v ^ 2 ->
  0 < quad S [w0; w1; w2] + 2 * v * (x0 * w0 + x1 * w1 + x2 * w2) + C * v ^ 2.
Proof.
  intros t S b0 b1 b2 c x0 x1 x2 C w0 w1 w2 v h ht h0 h1 h2 hc nz. unfold is_definite in h.
  destruct t as [| [| a [| b [| e [|]]]] [| [| d [| f [|]]] [| [| g [|]] [|]]]]; try discriminate. cbn [bordered length Nat.eqb] in h.
  unfold triangle_in in ht. repeat match goal with k : Forall2 _ (_ :: _) _ |- _ => inversion k; clear k; subst | k : Forall2 _ [] _ |- _ => inversion k; clear k; subst end.
  match goal with |- 0 < quad [[?a'; ?b'; ?c']; [?d'; ?e']; [?g']] _ + _ + _ =>
    assert (K : triangle_in bits [[a; b; e; b0]; [d; f; b1]; [g; b2]; [c]] [[a'; b'; c'; x0]; [d'; e'; x1]; [g'; x2]; [C]])
      by (unfold triangle_in; repeat first [assumption | apply Forall2_nil | apply Forall2_cons]) end.
  pose proof (is_positive_definite_sound bits _ _ h K [w0; w1; w2; v] eq_refl) as Q.
  unfold nonzero in Q. cbn [dot] in Q. specialize (Q ltac:(lra)). eapply Rlt_le_trans; [exact Q |]. apply Req_le. cbn [quad row_form dot]. ring.
Qed.

(** The matrices at a vertex, for any b within these numbers. *)
Lemma at_vertex_shown : forall places Y k2 z2 l rows b K Z L r (beta : list R), at_vertex_holds places Y k2 z2 l rows b = true -> length Y = 3%nat -> length r = 3%nat ->
  contains k2 K -> contains z2 Z -> contains l L -> rows_rel contains rows r -> Forall2 contains b beta ->
  forall w0 w1 w2 s b0 b1 b2, let w := [w0; w1; w2] in let q := weighted_sum w (map (map (Y_value places)) Y) in
  let form := 2 * dot (weighted_sum w (map fst r)) q - dot q q in
  (0 < dot w w -> 0 < form - K * dot w w - L * dot w w) /\
  (Rabs b0 <= nth 0 beta 0 -> Rabs b1 <= nth 1 beta 0 -> Rabs b2 <= nth 2 beta 0 -> 0 < dot w w + s ^ 2 ->
    0 < form + 2 * s * (b0 * w0 + b1 * w1 + b2 * w2) + Z * s ^ 2 - L * (dot w w + s ^ 2)).
Proof.
  intros places Y k2 z2 l rows b K Z L r beta h lY lr hK hZ hL hr hb w0 w1 w2 s b0 b1 b2 w q form. unfold at_vertex_holds in h. cbv zeta in h.
  pose proof (gram_sound bits places _ _ (solve_pairs_sound bits places Y _ 1 rows r (Fixed.integer_sound bits 1) hr)) as hg.
  pose proof (triangle_add_sound bits _ _ _ _ (diagonal_in bits _ _ 3 (neg_sound bits _ _ hL)) hg) as ht.
  set (t := triangle_add (repeat [neg l] 3) _) in *. set (S := tcomb 1 1 _ _) in ht.
  assert (T : quad S w = form - L * dot w w).
  { unfold S. change 3%nat with (length w). rewrite quad_tcomb, quad_diagonal, quad_pairs by congruence. fold q. unfold form. ring. }
  destruct hb as [| f0 beta0 fl bl hb0 hb]; [discriminate |]. destruct hb as [| f1 beta1 fl bl hb1 hb]; [discriminate |].
  destruct hb as [| f2 beta2 fl bl hb2 hb]; [discriminate |]. destruct hb; [| discriminate]. cbn [nth].
  apply andb_true_iff in h as [h1 h2]. split.
  - intro nz. unfold is_definite in h1. destruct (Nat.eqb_spec (length (triangle_add (repeat [neg k2] 3) t)) 3) as [l3 |]; [| discriminate].
    pose proof (triangle_add_sound bits _ _ _ _ (diagonal_in bits _ _ 3 (neg_sound bits _ _ hK)) ht) as hT.
    pose proof (is_positive_definite_sound bits _ _ h1 hT w) as Q. rewrite (related_length _ _ _ _ _ hT) in l3. specialize (Q ltac:(cbn [w length]; symmetry; exact l3) nz).
    change 3%nat with (length w) in Q. rewrite quad_tcomb, quad_diagonal, T in Q. lra.
  - intros hb0' hb1' hb2' nz. rewrite forallb_forall in h2. assert (nw : dot w w = w0 ^ 2 + w1 ^ 2 + w2 ^ 2) by (cbn; ring).
    assert (Corner : forall x0 x1 v, (x0 = beta0 \/ x0 = - beta0) -> (x1 = beta1 \/ x1 = - beta1) -> 0 < dot w w + v ^ 2 ->
      0 < form - L * dot w w + 2 * v * (x0 * w0 + x1 * w1 + beta2 * w2) + (Z - L) * v ^ 2).
    { intros x0 x1 v e0 e1 nv.
      assert (G : exists c0 c1 : bool, contains (if c0 then f0 else neg f0) x0 /\ contains (if c1 then f1 else neg f1) x1 /\ In (c0, c1) [(true, true); (false, true); (true, false); (false, false)]).
      { destruct e0 as [-> | ->], e1 as [-> | ->]; [exists true, true | exists true, false | exists false, true | exists false, false]; (split; [| split]); try assumption; try (apply neg_sound; assumption); cbn; tauto. }
      destruct G as [c0 [c1 [g0 [g1 gi]]]]. specialize (h2 _ gi). cbn [fst snd] in h2. rewrite <- T.
      apply (bordered_shown _ _ _ _ _ _ _ _ _ _ _ _ _ _ h2 ht g0 g1 hb2 (sub_sound bits _ _ _ _ hZ hL)). lra. }
    assert (Each : forall x0 x1 x2, (x0 = beta0 \/ x0 = - beta0) -> (x1 = beta1 \/ x1 = - beta1) -> (x2 = beta2 \/ x2 = - beta2) ->
      0 < form - L * dot w w + 2 * s * (x0 * w0 + x1 * w1 + x2 * w2) + (Z - L) * s ^ 2).
    { intros x0 x1 x2 e0 e1 [-> | ->]; [apply Corner; assumption |].
      pose proof (Corner (- x0) (- x1) (- s) ltac:(destruct e0; [right | left]; lra) ltac:(destruct e1; [right | left]; lra) ltac:(replace ((- s) ^ 2) with (s ^ 2) by ring; exact nz)) as E.
      replace ((- s) ^ 2) with (s ^ 2) in E by ring. lra. }
    assert (Pick : forall x b v, Rabs x <= b -> exists y, (y = b \/ y = - b) /\ s * (y * v) <= s * (x * v)).
    { intros x b v hx. pose proof (Rle_abs x). pose proof (Rle_abs (- x)) as hn. rewrite Rabs_Ropp in hn.
      destruct (Rle_dec 0 (s * v)); [exists (- b) | exists b]; (split; [auto | nra]). }
    destruct (Pick b0 beta0 w0 hb0') as [x0 [d0 m0]], (Pick b1 beta1 w1 hb1') as [x1 [d1 m1]], (Pick b2 beta2 w2 hb2') as [x2 [d2 m2]].
    pose proof (Each x0 x1 x2 d0 d1 d2) as E. lra.
Qed.

(** ** On the cell *)

(** eps + sum_j t_j D_j *)
Definition off_by (l : list R) (b : R * list (R * entry)) : R := fold_right (fun r sum => fst r * at_lambda l (snd r) + sum) (fst b) (snd b).
Lemma off_by_affine : forall before t after b, off_by (before ++ t :: after) b = (1 + t) / 2 * off_by (before ++ 1 :: after) b + (1 - t) / 2 * off_by (before ++ -1 :: after) b.
Proof.
  intros before t after [e rs]. unfold off_by. cbn [fst snd]. induction rs as [| [y d] rs IH]; cbn [fold_right fst snd]; [field |].
  rewrite IH, (at_lambda_affine before t after d). field.
Qed.

(** A joint may be off by this: its error and half-widths bound it. *)
Definition bounded_by (j : fixed * list (fixed * slope)) (b : R * list (R * entry)) : Prop :=
  (exists e, contains (fst j) e /\ Rabs (fst b) <= e) /\
  Forall2 (fun h r => (exists a, contains (fst h) a /\ Rabs (fst r) <= a) /\ entry_in bits (snd h) (snd r)) (snd j) (snd b).

Lemma bounded_sound : forall j b s, bounded_by j b -> exists beta, contains (off_at s (fst j) (snd j)) beta /\ Rabs (off_by (map corner s) b) <= beta.
Proof.
  intros [error hs] [eps rs] s [[e [h1 h2]] h]. cbn [fst snd] in *.
  assert (X : exists rs', Forall2 (fun h r => contains (fst h) (fst r) /\ 0 <= fst r /\ entry_in bits (snd h) (snd r)) hs rs' /\ forall e, Rabs eps <= e ->
    Rabs (off_by (map corner s) (eps, rs)) <= fold_right (fun r sum => fst r * Rabs (at_lambda (map corner s) (snd r)) + sum) e rs').
  { clear h1 h2 e error. unfold off_by. cbn [fst snd]. induction h as [| [f d] [y g] hs rs [[a [k1 k2]] k3] h [rs' [IH1 IH2]]]; [exists []; split; [constructor | cbn; auto] |].
    cbn [fst snd] in *. exists ((a, g) :: rs'). split; [constructor; [| exact IH1]; cbn [fst snd]; split; [exact k1 |]; split; [| exact k3]; eapply Rle_trans; [apply Rabs_pos | exact k2] |].
    intros e he. cbn [fold_right fst snd]. eapply Rle_trans; [apply Rabs_triang |]. apply Rplus_le_compat; [| apply IH2, he].
    rewrite Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos | exact k2]. }
  destruct X as [rs' [x1 x2]].
  destruct (off_sound s error e hs rs' h1 ltac:(eapply Rle_trans; [apply Rabs_pos | exact h2]) x1) as [beta [b1 b2]]. exists beta. split; [exact b1 |]. specialize (x2 e h2). lra.
Qed.

Section Cell.
Variable lambda : list R.
Hypothesis lambda_length : length lambda = 3%nat.
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.

Definition harmless_by (less : option slope) : Prop := match less with Some t => exists e, entry_in bits t e /\ 0 <= at_lambda lambda e | None => True end.

(** What is shown, of rows A and all b: with g = [spread], kappa and z. *)
Theorem accurate_sound : forall less near here joints places Y k, accurate less near here joints places Y k = true -> harmless_by less ->
  (exists g, contains (spread near) g /\ 0 <= g) ->
  let g := IZR (hi (spread near)) / unit in
  exists kappa z, 0 <= g /\ g < kappa /\ 0 <= z /\ z + g / (2 * kappa) <= 1 /\ forall es, rows_rel (entry_in bits) here es ->
  let A := map fst (map_rows (at_lambda lambda) es) in forall w0 w1 w2, let w := [w0; w1; w2] in let p := weighted_sum w A in
  kappa ^ 2 * dot w w <= dot p p /\
  forall bs s, Forall2 bounded_by joints bs -> 0 < dot w w + s ^ 2 -> 0 < dot p p + 2 * s * dot (map (off_by lambda) bs) w + z ^ 2 * s ^ 2.
Proof.
  intros less near here joints places Y k h hl [g0 [hg0 g00]] g. unfold accurate in h. cbv zeta in h.
  apply andb_true_iff in h as [h D]. apply andb_true_iff in h as [h lh]. apply andb_true_iff in h as [below lY]. apply Z.ltb_lt in below. apply Nat.eqb_eq in lY, lh.
  pose proof (unit_R_pos bits) as p0. assert (gu : g * unit = IZR (hi (spread near))) by (unfold g; field; lra).
  assert (hg : contains (spread near) g) by (destruct hg0 as [a1 a2]; split; rewrite gu; [lra | apply Rle_refl]).
  assert (g1 : 0 <= g) by (destruct hg0 as [_ a2]; apply Rmult_le_reg_r with unit; [exact p0 |]; nra).
  pose proof (Arithmetic.dyadic_sound bits k places _ 1 (Fixed.integer_sound bits 1)) as hk. set (kappa := IZR k / IZR (2 ^ Z.of_N places) * 1) in *.
  pose proof (contains_positive bits _ _ below (sub_sound bits _ _ _ _ hk hg)) as gk.
  destruct (recip bits (Arithmetic.dyadic k places (Fixed.integer bits 1))) as [r |] eqn:er; [| discriminate]. destruct (recip_sound bits _ _ _ er hk) as [_ hr].
  pose proof (sub_sound bits _ _ _ _ (Fixed.integer_sound bits 1) (halve_sound bits _ _ (mul_sound bits _ _ _ _ hg hr))) as hz. set (z := 1 - g * / kappa / 2) in *.
  exists kappa, z. split; [exact g1 |]. split; [lra |].
  assert (q1 : g * / kappa < 1) by (apply Rmult_lt_reg_r with kappa; [lra |]; rewrite Rmult_assoc, Rinv_l; lra).
  split; [unfold z; lra |]. split; [unfold z; apply Req_le; field; lra |].
  intros es hes A w0 w1 w2 w p. set (q := weighted_sum w (map (map (Y_value places)) Y)).
  assert (les : length es = 3%nat) by (rewrite <- (related_length _ _ _ _ _ hes); exact lh).
  assert (T : exists le, match less with Some f => entry_in bits f le | None => le = (0, []) end /\ 0 <= at_lambda lambda le).
  { destruct less as [f |]; [exact hl |]. exists (0, []). split; [reflexivity | unfold at_lambda; cbn; lra]. }
  destruct T as [le [hle le0]].
  assert (Vertex : forall s, contains match less with Some f => at_vertex s f | None => zero end (at_lambda (map corner s) le)).
  { intro s. destruct less as [f |]; [apply at_vertex_sound, hle |]. subst le. unfold at_lambda. cbn. rewrite Rplus_0_r. apply zero_sound. }
  rewrite forallb_forall in D.
  set (form l := 2 * dot (weighted_sum w (map fst (map_rows (at_lambda l) es))) q - dot q q).
  assert (Affine : forall before t after, form (before ++ t :: after) = (1 + t) / 2 * form (before ++ 1 :: after) + (1 - t) / 2 * form (before ++ -1 :: after)).
  { intros before t after. assert (F : forall l, form l = Test.form (map (fun t => (2 * t, 0)) w) (map_rows (at_lambda l) es) q - dot q q)
      by (intro l; unfold form; rewrite form_no_D; [reflexivity | unfold map_rows; rewrite map_length, les; reflexivity]).
    rewrite !F, (form_affine _ _ _ _ _ (at_lambda_affine before t after)). field. }
  assert (Rows : forall s, rows_rel contains (map_rows (at_vertex s) here) (map_rows (at_lambda (map corner s)) es))
    by (intro s; eapply map_rows_rel; [| exact hes]; intros a b i; apply at_vertex_sound; exact i).
  assert (len : forall s, length (map_rows (at_lambda (map corner s)) es) = 3%nat) by (intro s; unfold map_rows; rewrite map_length; exact les).
  assert (In_signs : forall s, length s = length lambda -> In s (signs 3)) by (intros s e; rewrite <- lambda_length, <- e; apply signs_all).
  assert (Square : form lambda <= dot p p).
  { pose proof (dot_self (comb 1 (- 1) p q)) as N. rewrite dot_comb, !(dot_commutes _ (comb _ _ _ _)), !dot_comb, (dot_commutes q p) in N. unfold form. fold A. fold p. lra. }
  pose proof (dot_self w) as w_nonneg. split.
  - destruct (Rle_lt_dec (dot w w) 0) as [zero | nz]; [assert (E : dot w w = 0) by lra; rewrite E, Rmult_0_r; apply dot_self |].
    enough (0 < form lambda + - kappa ^ 2 * dot w w + - (at_lambda lambda le * dot w w)) by (assert (0 <= at_lambda lambda le * dot w w) by (apply Rmult_le_pos; assumption); lra).
    apply (vertices_decide lambda (fun l => form l + - kappa ^ 2 * dot w w + - (at_lambda l le * dot w w)) lambda_in).
    + intros before t after. rewrite (Affine before t after), (at_lambda_affine before t after le). field.
    + intros s e. specialize (D s (In_signs s e)).
      assert (B : exists beta, Forall2 contains (map (fun j => off_at s (fst j) (snd j)) joints) beta).
      { exists (map (fun j => IZR (lo (off_at s (fst j) (snd j))) / unit) joints). clear. induction joints as [| j js IH]; cbn [map]; constructor; [apply (point_sound bits) | exact IH]. }
      destruct B as [beta hb].
      pose proof (proj1 (at_vertex_shown _ _ _ _ _ _ _ _ _ _ _ _ D lY (len s) (sqr_sound bits _ _ hk) (sqr_sound bits _ _ hz) (Vertex s) (Rows s) hb w0 w1 w2 0 0 0 0) nz) as V. cbv zeta in V.
      fold w in V. fold q in V. unfold form. lra.
  - intros bs s hbs nz.
    enough (0 < form lambda + 2 * s * dot (map (off_by lambda) bs) w + z ^ 2 * s ^ 2 + - (at_lambda lambda le * (dot w w + s ^ 2)))
      by (assert (0 <= at_lambda lambda le * (dot w w + s ^ 2)) by (apply Rmult_le_pos; lra); lra).
    apply (vertices_decide lambda (fun l => form l + 2 * s * dot (map (off_by l) bs) w + z ^ 2 * s ^ 2 + - (at_lambda l le * (dot w w + s ^ 2))) lambda_in).
    + intros before t after. assert (O : dot (map (off_by (before ++ t :: after)) bs) w = (1 + t) / 2 * dot (map (off_by (before ++ 1 :: after)) bs) w + (1 - t) / 2 * dot (map (off_by (before ++ -1 :: after)) bs) w).
      { generalize w. clear. induction bs as [| b bs IH]; intros [| y v]; cbn [map dot]; try field. rewrite IH, (off_by_affine before t after b). field. }
      rewrite O, (Affine before t after), (at_lambda_affine before t after le). field.
    + intros v e. specialize (D v (In_signs v e)).
      assert (B : exists beta, Forall2 contains (map (fun j => off_at v (fst j) (snd j)) joints) beta /\ Forall2 (fun b beta => Rabs (off_by (map corner v) b) <= beta) bs beta).
      { clear - hbs. induction hbs as [| j b joints bs h _ [beta [IH1 IH2]]]; [exists []; split; constructor |].
        destruct (bounded_sound j b v h) as [y [y1 y2]]. exists (y :: beta). split; constructor; assumption. }
      destruct B as [beta [hb1 hb2]]. pose proof D as D'. unfold at_vertex_holds in D'. cbv zeta in D'.
      destruct joints as [| j0 [| j1 [| j2 [|]]]]; try discriminate. clear D'.
      inversion hb1 as [| ? beta0 ? ? y0 hb3]; subst. inversion hb3 as [| ? beta1 ? ? y1 hb4]; subst. inversion hb4 as [| ? beta2 ? ? y2 hb5]; subst. inversion hb5; subst.
      inversion hb2 as [| b0 ? ? ? x0 hb6]; subst. inversion hb6 as [| b1 ? ? ? x1 hb7]; subst. inversion hb7 as [| b2 ? ? ? x2 hb8]; subst. inversion hb8; subst.
      pose proof (proj2 (at_vertex_shown _ _ _ _ _ _ _ _ _ _ _ _ D lY (len v) (sqr_sound bits _ _ hk) (sqr_sound bits _ _ hz) (Vertex v) (Rows v) hb1 w0 w1 w2 s _ _ _) x0 x1 x2 nz) as V. cbv zeta in V.
      fold w in V. fold q in V. unfold form. cbn [map]. change (dot [off_by (map corner v) b0; off_by (map corner v) b1; off_by (map corner v) b2] w)
        with (off_by (map corner v) b0 * w0 + (off_by (map corner v) b1 * w1 + (off_by (map corner v) b2 * w2 + 0))). lra.
Qed.
End Cell.
End Precision.
