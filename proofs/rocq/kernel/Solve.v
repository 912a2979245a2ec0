(** * Columns of the inverse of M

    |M^-1 e_i| < 1/k if, for any matrix Y, A Y^T + Y A^T - Y Y^T - k^2 D_i e_i e_i^T is
    positive definite at the vertices: with u the joints' forces times B, p = A^T u is the force on the platform. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope Definite Test.
Import ListNotations.
Local Open Scope R_scope.

(** ** A Y^T + Y A^T - w Y Y^T - k D_i e_i e_i^T, a form in the joints' forces *)

Fixpoint weighted_sum (u : list R) (M : list (list R)) : list R :=
  match u, M with t :: u', r :: M' => comb t 1 r (weighted_sum u' M') | _, _ => [] end.
Lemma dot_weighted : forall u M v, dot (weighted_sum u M) v = dot u (map (fun r => dot r v) M).
Proof. induction u as [| t u IH]; intros [| r M] v; cbn [weighted_sum map dot]; try (destruct v; reflexivity). rewrite dot_comb, IH. ring. Qed.
Lemma dot_commutes : forall u v, dot u v = dot v u.
Proof. induction u as [| a u IH]; intros [| b v]; cbn [dot]; try reflexivity. rewrite IH. ring. Qed.
Lemma dot_cauchy : forall u v, dot u v ^ 2 <= dot u u * dot v v.
Proof.
  intros u v. destruct (Rlt_dec 0 (dot v v)) as [p | n].
  - pose proof (dot_self (comb (dot v v) (- dot u v) u v)) as q.
    rewrite dot_comb, !(dot_commutes _ (comb _ _ u v)), !dot_comb, (dot_commutes v u) in q.
    replace (dot v v * (dot v v * dot u u + - dot u v * dot u v) + - dot u v * (dot v v * dot u v + - dot u v * dot v v))
      with (dot v v * (dot u u * dot v v - dot u v ^ 2)) in q by ring.
    apply Rnot_lt_le. intro k. assert (dot v v * (dot u u * dot v v - dot u v ^ 2) < 0) by nra. lra.
  - rewrite (dot_zero v u (zero_vector v ltac:(lra))). pose proof (dot_self u). pose proof (dot_self v). nra.
Qed.

(** Fewer equations than coordinates have a solution that is not zero. *)
Lemma orthogonal_exists : forall n (L : list (list R)), (length L < n)%nat -> exists v, length v = n /\ nonzero v /\ Forall (fun y => dot y v = 0) L.
Proof.
  induction n as [| n IH]; intros L h; [lia |].
  assert (C : Forall (fun y => hd 0 y = 0) L \/ exists L1 y L2, L = L1 ++ y :: L2 /\ hd 0 y <> 0).
  { clear. induction L as [| y L [H | [L1 [z [L2 [-> hz]]]]]].
    - left. constructor.
    - destruct (Req_dec (hd 0 y) 0) as [e | e]; [left; constructor; assumption | right; exists [], y, L; split; [reflexivity | exact e]].
    - right. exists (y :: L1), z, L2. split; [reflexivity | exact hz]. }
  assert (D : forall y t v, dot y (t :: v) = hd 0 y * t + dot (tl y) v) by (intros [| a y] t v; cbn [dot hd tl]; [destruct v; cbn; ring | ring]).
  destruct C as [H | [L1 [y [L2 [-> hy]]]]].
  - exists (1 :: repeat 0 n). split; [cbn [length]; rewrite repeat_length; reflexivity |].
    assert (Z : Forall (eq 0) (repeat 0 n)) by (clear; induction n; cbn [repeat]; constructor; auto).
    split; [unfold nonzero; cbn [dot]; rewrite (dot_zero _ _ Z); lra |]. eapply Forall_impl; [| exact H]. intros y e. cbn beta in e. rewrite D, e, (dot_zero _ _ Z). ring.
  - set (less := fun z => comb 1 (- (hd 0 z / hd 0 y)) (tl z) (tl y)).
    destruct (IH (map less (L1 ++ L2))) as [v [lv [nv hv]]]; [rewrite map_length, app_length in *; cbn [length] in h; lia |].
    exists (- (dot (tl y) v / hd 0 y) :: v). split; [cbn; congruence |]. split.
    + unfold nonzero in *. cbn [dot]. pose proof (pow2_ge_0 (dot (tl y) v / hd 0 y)) as Q. set (t := dot (tl y) v / hd 0 y) in *. nra.
    + rewrite Forall_map in hv. assert (K : forall z, dot (less z) v = 0 -> dot z (- (dot (tl y) v / hd 0 y) :: v) = 0).
      { intros z e. unfold less in e. rewrite dot_comb in e. rewrite D. refine (eq_trans _ e). field. exact hy. }
      apply Forall_app in hv as [h1 h2]. apply Forall_app. split; [eapply Forall_impl; [| exact h1]; exact K |].
      constructor; [rewrite D; field; exact hy | eapply Forall_impl; [| exact h2]; exact K].
Qed.

Fixpoint real_gram (qs : list (list R * list R)) : list (list R) :=
  match qs with
  | [] => []
  | (h, z) :: rest => (2 * dot h z :: map (fun q => dot (fst q) z + dot h (snd q)) rest) :: real_gram rest
  end.
Lemma quad_gram : forall qs u, quad (real_gram qs) u = 2 * dot (weighted_sum u (map fst qs)) (weighted_sum u (map snd qs)).
Proof.
  induction qs as [| [h z] qs IH]; intros [| t u]; cbn [real_gram quad map weighted_sum dot]; try ring. rewrite IH. cbn [row_form fst snd].
  assert (B : dot (map (fun q => dot (fst q) z + dot h (snd q)) qs) u = dot (weighted_sum u (map fst qs)) z + dot h (weighted_sum u (map snd qs))).
  { rewrite (dot_commutes h), !dot_weighted, !map_map, (dot_commutes u), (dot_commutes u). clear. revert u. induction qs as [| q qs IH]; intros [| t u]; cbn [map dot]; try ring.
    rewrite IH, (dot_commutes h (snd q)). ring. }
  rewrite B, dot_comb, !(dot_commutes _ (comb t 1 _ _)), !dot_comb, (dot_commutes z h), (dot_commutes (weighted_sum u (map snd qs)) h), (dot_commutes z), (dot_commutes (weighted_sum u (map snd qs))). ring.
Qed.

Fixpoint solve_weights (i : nat) (k : R) (u : list R) : list (R * R) :=
  match u with
  | [] => []
  | t :: u' => match i with O => (2 * t, - k * t ^ 2) :: map (fun t => (2 * t, 0)) u' | S i' => (2 * t, 0) :: solve_weights i' k u' end
  end.

Lemma form_no_D : forall u r v, length u = length r -> form (map (fun t => (2 * t, 0)) u) r v = 2 * dot (weighted_sum u (map fst r)) v.
Proof. induction u as [| t u IH]; intros [| [a d] r] v l; try discriminate; cbn [map form weighted_sum fst dot]; [ring |]. rewrite IH, dot_comb by (cbn in l; congruence). ring. Qed.
Lemma form_solve : forall i k u r v, length u = length r ->
  form (solve_weights i k u) r v = 2 * dot (weighted_sum u (map fst r)) v - k * (nth i (map snd r) 0 * nth i u 0 ^ 2).
Proof.
  induction i as [| i IH]; intros k [| t u] [| [a d] r] v l; try discriminate; cbn [solve_weights form map weighted_sum fst snd nth dot]; try ring.
  - rewrite form_no_D, dot_comb by (cbn in l; congruence). ring.
  - rewrite IH, dot_comb by (cbn in l; congruence). ring.
Qed.

Section Precision.
Variable bits : positive.

Fixpoint half_product (places : N) (y : list Z) (z : list fixed) : fixed :=
  match y, z with n :: y', a :: z' => add (Arithmetic.dyadic n (places + 1) a) (half_product places y' z') | _, _ => zero end.
Fixpoint gram (places : N) (ps : list (list Z * list fixed)) : triangle :=
  match ps with
  | [] => []
  | (y, z) :: rest => let h := half_product places in
      (add (h y z) (h y z) :: map (fun q => add (h (fst q) z) (h y (snd q))) rest) :: gram places rest
  end.
Fixpoint solve_pairs (places : N) (Y : list (list Z)) (w : fixed) (r : rows fixed) : list (list Z * list fixed) :=
  match Y, r with y :: Y', (a, _) :: r' => (y, residual places a w y) :: solve_pairs places Y' w r' | _, _ => [] end.
Fixpoint solve_diagonal (i : nat) (k t : fixed) (r : rows fixed) {struct r} : triangle :=
  match r with
  | [] => []
  | (_, d) :: r' => match i with
      | O => [sub (neg (mul bits k (upper_end d))) t] :: map (fun _ => [sub zero t]) r'
      | S i' => [sub zero t] :: solve_diagonal i' k t r'
      end
  end.

Definition is_definite (n : nat) (t : triangle) : bool := if Nat.eqb (length t) n then is_positive_definite bits t else false.
Lemma half_product_sound : forall places y z v, Forall2 (contains bits) z v -> contains bits (half_product places y z) (dot (map (Y_half places) y) v).
Proof.
  intros places y z v h. revert y. induction h as [| a b z v hb h IH]; intros [| n y]; cbn [half_product map dot]; try apply zero_sound.
  apply add_sound; [apply Arithmetic.dyadic_sound, hb | apply IH].
Qed.
Lemma gram_sound : forall places ps qs, Forall2 (fun p q => fst q = map (Y_half places) (fst p) /\ Forall2 (contains bits) (snd p) (snd q)) ps qs ->
  triangle_in bits (gram places ps) (real_gram qs).
Proof.
  intros places. induction 1 as [| [y z] [h v] ps qs [e hz] hs IH]; cbn [gram real_gram]; constructor; [| exact IH]. cbn [fst snd] in *. subst h. constructor.
  - replace (2 * dot (map (Y_half places) y) v) with (dot (map (Y_half places) y) v + dot (map (Y_half places) y) v) by ring. apply add_sound; apply half_product_sound, hz.
  - clear IH. induction hs as [| p q ps qs [e k] hs IH]; cbn [map]; constructor; [| exact IH]. rewrite e. apply add_sound; apply half_product_sound; assumption.
Qed.

Definition real_pairs (places : N) (Y : list (list Z)) (w : R) (r : rows R) : list (list R * list R) :=
  map (fun p => (map (Y_half places) (fst p), comb 2 (- w) (fst (snd p)) (map (Y_value places) (fst p)))) (combine Y r).
Lemma solve_pairs_sound : forall places Y w W i r, contains bits w W -> rows_rel (contains bits) i r ->
  Forall2 (fun p q => fst q = map (Y_half places) (fst p) /\ Forall2 (contains bits) (snd p) (snd q)) (solve_pairs places Y w i) (real_pairs places Y W r).
Proof.
  intros places Y w W i r hw h. revert Y. induction h as [| [a d] [b e] i r [h1 h2] h IH]; intros [| y Y]; cbn; try constructor; [| apply IH].
  cbn [fst snd] in *. split; [reflexivity | apply residual_sound; assumption].
Qed.
Lemma quad_pairs : forall places Y w r u, length Y = length r -> let q := weighted_sum u (map (map (Y_value places)) Y) in
  quad (real_gram (real_pairs places Y w r)) u = 2 * dot (weighted_sum u (map fst r)) q - w * dot q q.
Proof.
  intros places Y w r u l q. rewrite quad_gram. unfold real_pairs. rewrite !map_map. cbn [fst snd].
  assert (E1 : forall v, 2 * dot (weighted_sum u (map (fun p : list Z * (list R * R) => map (Y_half places) (fst p)) (combine Y r))) v = dot q v).
  { intro v. unfold q. rewrite !dot_weighted, !map_map. clear q. revert Y r l. induction u as [| t u IH]; intros [| y Y] [| p r] l; try discriminate; cbn [combine map dot fst]; try ring.
    rewrite <- (IH Y r) by (cbn in l; congruence).
    assert (H : dot (map (Y_value places) y) v = 2 * dot (map (Y_half places) y) v) by (rewrite <- dot_map, map_map; f_equal; apply map_ext; exact (Y_half_eq places)). rewrite H. ring. }
  rewrite E1. rewrite dot_commutes.
  assert (E2 : forall v, dot (weighted_sum u (map (fun p : list Z * (list R * R) => comb 2 (- w) (fst (snd p)) (map (Y_value places) (fst p))) (combine Y r))) v
    = 2 * dot (weighted_sum u (map fst r)) v - w * dot q v).
  { intro v. unfold q. clear E1 q. rewrite !dot_weighted, !map_map. revert Y r l. induction u as [| t u IH]; intros [| y Y] [| p r] l; try discriminate; cbn [combine map dot fst snd]; try ring.
    rewrite IH, dot_comb by (cbn in l; congruence). ring. }
  apply E2.
Qed.
Lemma solve_diagonal_sound : forall i k K t T r s u, contains bits k K -> 0 <= K -> contains bits t T -> rows_rel (contains bits) r s -> length u = length s ->
  exists S, triangle_in bits (solve_diagonal i k t r) S /\ quad S u <= - K * (nth i (map snd s) 0 * nth i u 0 ^ 2) - T * dot u u.
Proof.
  intros i k K t T r s u hk K0 ht h.
  assert (T0 : contains bits (sub zero t) (- T)) by (replace (- T) with (0 - T) by ring; apply sub_sound; [apply zero_sound | exact ht]).
  assert (Rest : forall (r : rows fixed) (s : rows R), rows_rel (contains bits) r s -> forall u, length u = length s ->
    exists S, triangle_in bits (map (fun _ => [sub zero t]) r) S /\ quad S u = - T * dot u u).
  { clear - T0. induction 1 as [| p q r s _ h IH]; intros [| y u] l; try discriminate; [exists []; split; [constructor | cbn; ring] |].
    destruct (IH u ltac:(cbn in l; congruence)) as [S [hS e]]. exists ([- T] :: S). split; [cbn [map]; constructor; [constructor; [exact T0 | constructor] | exact hS] |].
    cbn [quad row_form dot]. rewrite e. ring. }
  revert i u. induction h as [| [a d] [b e] r s [_ hd] h IH]; intros i [| y u] l; try discriminate; [exists []; split; [cbn [solve_diagonal]; constructor | destruct i; cbn; lra] |].
  cbn [fst snd] in hd. destruct i as [| i]; cbn [solve_diagonal map snd nth].
  - destruct (Rest r s h u ltac:(cbn in l; congruence)) as [S [hS q]]. destruct (upper_end_sound bits d e hd) as [g [hg le]].
    exists ([- (K * g) - T] :: S). split; [constructor; [constructor; [apply sub_sound; [apply neg_sound, mul_sound; assumption | exact ht] | constructor] | exact hS] |].
    cbn [quad row_form dot]. rewrite q. pose proof (pow2_ge_0 y). assert (K * (e * y ^ 2) <= K * (g * y ^ 2)) by (apply Rmult_le_compat_l; [exact K0 | apply Rmult_le_compat_r; assumption]). lra.
  - destruct (IH i u ltac:(cbn in l; congruence)) as [S [hS q]]. exists ([- T] :: S). split; [constructor; [constructor; [exact T0 | constructor] | exact hS] |].
    cbn [quad row_form dot]. lra.
Qed.

(** ** At the vertices of a cell *)

Definition solved (m i : nat) (k2 : fixed) (less : option slope) (places : N) (Y : list (list Z)) (r : rows slope) : bool :=
  Nat.eqb (length r) m && Nat.eqb (length Y) m &&
  at_vertices m (with_bound match less with Some t => t | None => constant zero end r) (fun rows =>
    match rows with
    | (_, t) :: rows => Nat.eqb (length rows) m && is_definite m (triangle_add (solve_diagonal i k2 t rows) (gram places (solve_pairs places Y (Fixed.integer bits 1) rows)))
    | [] => false
    end).

Theorem solved_sound : forall i k2 less places Y r es lambda, solved (length lambda) i k2 less places Y r = true ->
  rows_rel (entry_in bits) r es -> Forall (fun t => -1 <= t <= 1) lambda ->
  match less with Some t => exists e, entry_in bits t e /\ 0 <= at_lambda lambda e | None => True end ->
  let R := map_rows (at_lambda lambda) es in
  length R = length lambda /\ forall k u, contains bits k2 k -> 0 <= k -> length u = length R -> nonzero u ->
  let p := weighted_sum u (map fst R) in k * (nth i (map snd R) 0 * nth i u 0 ^ 2) < dot p p.
Proof.
  intros i k2 less places Y r es lambda h hr hl hs R. unfold solved in h. apply andb_true_iff in h as [h D]. apply andb_true_iff in h as [l1 l2].
  apply Nat.eqb_eq in l1, l2. assert (lr : length R = length lambda) by (unfold R, map_rows; rewrite map_length, <- (related_length _ _ _ _ _ hr); exact l1).
  split; [exact lr |]. intros k u hk k0 lu nz p.
  assert (T : exists t e, match less with Some t => t | None => constant zero end = t /\ entry_in bits t e /\ 0 <= at_lambda lambda e).
  { destruct less as [t |]; [destruct hs as [e [h1 h2]]; exists t, e; auto |]. exists (constant zero), (0, []). split; [reflexivity |].
    split; [apply constant_in, zero_sound | unfold at_lambda; cbn; lra]. }
  destruct T as [t [e [et [he e0]]]]. rewrite et in D. set (q := weighted_sum u (map (map (Y_value places)) Y)).
  pose proof (at_vertices_sound bits _ _ _ lambda ((0, - dot u u) :: solve_weights i k u) (- dot q q) q D (with_bound_rel bits _ _ _ _ he hr) hl) as V.
  rewrite map_rows_cons in V. cbn [form] in V. fold R in V.
  assert (F : 0 < - dot q q + (0 * dot (map (at_lambda lambda) []) q + - dot u u * at_lambda lambda e + form (solve_weights i k u) R q)).
  { apply V. intros a s ha hrel. destruct hrel as [| [a0 d] [b0 t0] a s [_ hd] hrel]; [discriminate |]. cbn [snd] in hd.
    apply andb_true_iff in ha as [la ha]. apply Nat.eqb_eq in la.
    assert (ls : length u = length s) by (rewrite lu, lr, <- la; exact (related_length _ _ _ _ _ hrel)).
    destruct (solve_diagonal_sound i k2 k d t0 a s u hk k0 hd hrel ls) as [G [hG le]].
    pose proof (Fixed.integer_sound bits 1) as one.
    pose proof (triangle_add_sound bits _ _ _ _ hG (gram_sound places _ _ (solve_pairs_sound places Y _ 1 a s one hrel))) as hT.
    unfold is_definite in ha. destruct (Nat.eqb_spec (length (triangle_add (solve_diagonal i k2 d a) (gram places (solve_pairs places Y (Fixed.integer bits 1) a)))) (length lambda)) as [z | z]; [| discriminate].
    pose proof (is_positive_definite_sound bits _ _ ha hT u) as Q. rewrite (related_length _ _ _ _ _ hT) in z. specialize (Q ltac:(congruence) nz).
    rewrite quad_tcomb, quad_pairs in Q by congruence. fold q in Q. cbn [form]. rewrite form_solve by congruence. lra. }
  rewrite form_solve in F by congruence. fold p in F. set (B := nth i (map snd R) 0 * nth i u 0 ^ 2) in *.
  pose proof (dot_self (comb 1 (- 1) p q)) as N. rewrite dot_comb, !(dot_commutes _ (comb _ _ _ _)), !dot_comb, (dot_commutes q p) in N.
  assert (0 <= dot u u * at_lambda lambda e) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact e0]). lra.
Qed.
End Precision.
