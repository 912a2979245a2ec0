(** * The tests: what is shown of formulas over a cell

    A machine is n rows (A_i, D_i) with D_i > 0; the rows of D^(-1/2) A are
    those of its inverse Jacobian M, so sum_i (A_i . v)^2 / D_i = |M v|^2.

    What is to be shown is affine in the rows, and these are affine in lambda:
    the vertices of the cell decide.  At a vertex D enters sigma_min at its
    upper end and sigma_max at its lower end. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope Definite.
Import ListNotations.
Local Open Scope R_scope.

Definition rows (A : Type) : Type := list (list A * A).
Definition map_rows {A B : Type} (f : A -> B) : rows A -> rows B := map (fun r => (map f (fst r), f (snd r))).
Definition rows_rel {A B : Type} (P : A -> B -> Prop) : rows A -> rows B -> Prop :=
  Forall2 (fun r s => Forall2 P (fst r) (fst s) /\ P (snd r) (snd s)).

Lemma map_rows_rel : forall (A B C D : Type) (P : A -> B -> Prop) (Q : C -> D -> Prop) f g,
  (forall a b, P a b -> Q (f a) (g b)) -> forall r s, rows_rel P r s -> rows_rel Q (map_rows f r) (map_rows g s).
Proof.
  intros until g. intros h r s. apply map_related. intros a b [h1 h2]. split; [| apply h; exact h2].
  eapply map_related; eassumption.
Qed.

Lemma map_rows_cons : forall (A B : Type) (f : A -> B) a d r, map_rows f ((a, d) :: r) = (map f a, f d) :: map_rows f r.
Proof. reflexivity. Qed.

(** |D^(-1/2) A v|^2 *)
Fixpoint energy (r : rows R) (v : list R) : R :=
  match r with [] => 0 | (a, d) :: r' => dot a v ^ 2 / d + energy r' v end.
Definition positive_D (r : rows R) : Prop := Forall (fun p => 0 < snd p) r.

(** ** A value at c, with its slopes *)

Definition entry : Type := R * list R.
Definition at_lambda (l : list R) (e : entry) : R := fst e + dot (snd e) l.

(** sum_i alpha_i A_i . v + beta_i D_i *)
Fixpoint form (w : list (R * R)) (r : rows R) (v : list R) : R :=
  match w, r with (p, q) :: w', (a, d) :: r' => p * dot a v + q * d + form w' r' v | _, _ => 0 end.

Lemma form_affine : forall p q l l1 l2, (forall e, at_lambda l e = p * at_lambda l1 e + q * at_lambda l2 e) ->
  forall w es v, form w (map_rows (at_lambda l) es) v
    = p * form w (map_rows (at_lambda l1) es) v + q * form w (map_rows (at_lambda l2) es) v.
Proof.
  intros p q l l1 l2 h.
  assert (D : forall a v, dot (map (at_lambda l) a) v = p * dot (map (at_lambda l1) a) v + q * dot (map (at_lambda l2) a) v).
  { induction a as [| e a IH]; intros [| t v]; cbn [map dot]; rewrite ?h, ?IH; ring. }
  induction w as [| [s t] w IH]; intros [| [a d] es] v; try (cbn; ring).
  rewrite !map_rows_cons. cbn [form]. rewrite IH, D, h. ring.
Qed.

Lemma at_lambda_affine : forall before t after e, at_lambda (before ++ t :: after) e
  = (1 + t) / 2 * at_lambda (before ++ 1 :: after) e + (1 - t) / 2 * at_lambda (before ++ -1 :: after) e.
Proof.
  intros before t after [f u]. unfold at_lambda. cbn [fst snd].
  assert (D : forall b u, dot u (b ++ t :: after)
    = (1 + t) / 2 * dot u (b ++ 1 :: after) + (1 - t) / 2 * dot u (b ++ -1 :: after)).
  { induction b as [| y b IH]; intros [| a w]; cbn [app dot]; try rewrite IH; field. }
  rewrite D. field.
Qed.

(** ** Vertices decide *)

Definition corner (b : bool) : R := if b then 1 else -1.

Lemma vertices_decide : forall lambda (g : list R -> R), Forall (fun t => -1 <= t <= 1) lambda ->
  (forall before t after, g (before ++ t :: after)
     = (1 + t) / 2 * g (before ++ 1 :: after) + (1 - t) / 2 * g (before ++ -1 :: after)) ->
  (forall s, length s = length lambda -> 0 < g (map corner s)) -> 0 < g lambda.
Proof.
  induction lambda as [| t l IH]; intros g hl affine h; [exact (h [] eq_refl) |].
  inversion hl as [| ? ? ht hl' ]; subst.
  assert (K : forall b, 0 < g (corner b :: l)).
  { intro b. apply (IH (fun m => g (corner b :: m)) hl').
    - intros before u after. exact (affine (corner b :: before) u after).
    - intros s e. apply (h (b :: s)). cbn. congruence. }
  pose proof (K true) as p. pose proof (K false) as m. cbn [corner] in p, m.
  pose proof (affine [] t l) as E. cbn [app] in E. rewrite E.
  destruct (Rlt_le_dec t 0).
  - assert (0 <= (1 + t) / 2 * g (1 :: l)) by (apply Rmult_le_pos; lra).
    assert (0 < (1 - t) / 2 * g (-1 :: l)) by (apply Rmult_lt_0_compat; lra). lra.
  - assert (0 < (1 + t) / 2 * g (1 :: l)) by (apply Rmult_lt_0_compat; lra).
    assert (0 <= (1 - t) / 2 * g (-1 :: l)) by (apply Rmult_le_pos; lra). lra.
Qed.

(** The same, where the vertices may be zero. *)
Lemma vertices_decide_weakly : forall lambda (g : list R -> R), Forall (fun t => -1 <= t <= 1) lambda ->
  (forall before t after, g (before ++ t :: after)
     = (1 + t) / 2 * g (before ++ 1 :: after) + (1 - t) / 2 * g (before ++ -1 :: after)) ->
  (forall s, length s = length lambda -> 0 <= g (map corner s)) -> 0 <= g lambda.
Proof.
  intros lambda g hl affine h. apply Rnot_lt_le. intro n.
  assert (p : 0 < g lambda + - g lambda); [| lra].
  apply (vertices_decide lambda (fun l => g l + - g lambda) hl).
  - intros. rewrite affine. field.
  - intros s e. specialize (h s e). lra.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

(** The value at a vertex. *)
Fixpoint vertex_value (s : list bool) (sum : fixed) (terms : list fixed) : fixed :=
  match s, terms with
  | b :: s', a :: terms' => vertex_value s' (if b then add sum a else sub sum a) terms'
  | _, _ => sum
  end.
Definition at_vertex (s : list bool) (f : slope) : fixed := vertex_value s (at_c f) (slopes f).

(** The slope of one formula, at one x. *)
Definition entry_in (f : slope) (e : entry) : Prop := contains (at_c f) (fst e) /\ Forall2 contains (slopes f) (snd e).

Lemma at_vertex_sound : forall s f e, entry_in f e -> contains (at_vertex s f) (at_lambda (map corner s) e).
Proof.
  intros s [c r t] [y u]. unfold entry_in, at_vertex, at_lambda. cbn [at_c slopes fst snd]. intros [hc h].
  revert s c y hc. induction h as [| a x t u hx h IH]; intros [| b s] c y hc; cbn [vertex_value map dot];
    try (rewrite Rplus_0_r; exact hc).
  rewrite <- Rplus_assoc. apply IH. destruct b; cbn [corner].
  - rewrite Rmult_1_r. apply add_sound; assumption.
  - replace (y + x * -1) with (y - x) by ring. apply sub_sound; assumption.
Qed.

Definition at_vertices (m : nat) (r : rows slope) (holds : rows fixed -> bool) : bool :=
  forallb (fun s => holds (map_rows (at_vertex s) r)) (signs m).

(** A constant and a form that are positive at the vertices are positive at x. *)
Lemma at_vertices_sound : forall r holds es lambda w c v,
  at_vertices (length lambda) r holds = true -> rows_rel entry_in r es -> Forall (fun t => -1 <= t <= 1) lambda ->
  (forall i s, holds i = true -> rows_rel contains i s -> 0 < c + form w s v) ->
  0 < c + form w (map_rows (at_lambda lambda) es) v.
Proof.
  intros r holds es lambda w c v h hr hl H. unfold at_vertices in h. rewrite forallb_forall in h.
  apply (vertices_decide lambda (fun l => c + form w (map_rows (at_lambda l) es) v) hl).
  - intros before t after. rewrite (form_affine _ _ _ _ _ (at_lambda_affine before t after)). field.
  - intros s e. apply (H (map_rows (at_vertex s) r)).
    + apply h. rewrite <- e. apply signs_all.
    + eapply map_rows_rel; [| exact hr]. intros a b k. apply at_vertex_sound; exact k.
Qed.

(** ** sigma_min: Y^T A + A^T Y - Y^T D Y - kappa^2 I, for any Y = y / 2^places *)

Section Lower.
Variable places : N.
Definition Y_value (n : Z) : R := IZR n / IZR (2 ^ Z.of_N places).
Definition Y_half (n : Z) : R := IZR n / IZR (2 ^ Z.of_N (places + 1)).

Lemma Y_half_eq : forall n, Y_value n = 2 * Y_half n.
Proof.
  intro n. unfold Y_value, Y_half. rewrite N2Z.inj_add, Z.pow_add_r by (try apply N2Z.is_nonneg; discriminate).
  rewrite mult_IZR. change (2 ^ Z.of_N 1)%Z with 2%Z. pose proof (two_power places). field. lra.
Qed.

(** (Y_i^T z + z^T Y_i) / 2 *)
Fixpoint halves (y : list Z) (z : list fixed) : triangle :=
  match y, z with
  | y1 :: y', z1 :: z' =>
      let half n a := dyadic n (places + 1) a in
      (add (half y1 z1) (half y1 z1)
         :: merge (half y1) (fun n => half n z1) (fun a n => add (half y1 a) (half n z1)) z' y') :: halves y' z'
  | _, _ => []
  end.

Lemma halves_sound : forall y z h, Forall2 contains z h -> triangle_in bits (halves y z) (outer (map Y_half y) h).
Proof.
  assert (H : forall n a x, contains a x -> contains (dyadic n (places + 1) a) (Y_half n * x))
    by (intros; apply dyadic_sound; assumption).
  induction y as [| y1 y IH]; intros z h k; [constructor |]. destruct k as [| z1 h1 z h k1 k]; [constructor |].
  cbn [halves outer map]. constructor; [| apply IH; exact k]. constructor.
  - replace (2 * Y_half y1 * h1) with (Y_half y1 * h1 + Y_half y1 * h1) by ring. apply add_sound; apply H; exact k1.
  - eapply (merge_related _ _ _ _ _ _ contains (fun n r => r = Y_half n)); try exact k.
    + intros. apply H; assumption.
    + intros b b' ->. rewrite Rmult_comm. apply H; assumption.
    + intros a a' b b' ha ->. rewrite (Rmult_comm h1). apply add_sound; apply H; assumption.
    + clear. induction y; cbn; constructor; auto.
Qed.

(** z = 2 A_i - D_i Y_i *)
Definition residual (a : list fixed) (d : fixed) (y : list Z) : list fixed :=
  merge (fun x => add x x) (fun n => neg (dyadic n places d)) (fun x n => sub (add x x) (dyadic n places d)) a y.

Lemma residual_sound : forall a b d e y, Forall2 contains a b -> contains d e ->
  Forall2 contains (residual a d y) (comb 2 (- e) b (map Y_value y)).
Proof.
  assert (H : forall n a x, contains a x -> contains (dyadic n places a) (Y_value n * x))
    by (intros; apply dyadic_sound; assumption).
  intros a b d e y h hd. eapply (merge_related _ _ _ _ _ _ contains (fun n s => s = Y_value n)); try exact h.
  - intros x x' hx. replace (2 * x') with (x' + x') by ring. apply add_sound; assumption.
  - intros n s ->. replace (- e * Y_value n) with (- (Y_value n * e)) by ring. apply neg_sound, H; assumption.
  - intros x x' n s hx ->. replace (_ + _) with (x' + x' - Y_value n * e) by ring.
    apply sub_sound; [apply add_sound | apply H]; assumption.
  - clear. induction y; cbn; constructor; auto.
Qed.

Fixpoint lower_triangle (Y : list (list Z)) (r : rows fixed) (start : triangle) : triangle :=
  match Y, r with
  | y :: Y', (a, d) :: r' => lower_triangle Y' r' (triangle_add start (halves y (residual a (upper_end d) y)))
  | _, _ => start
  end.

(** With s_i = Y_i . v: 2 s_i A_i . v - s_i^2 D_i. *)
Definition lower_weights (Y : list (list Z)) (v : list R) : list (R * R) :=
  map (fun y => let s := dot (map Y_value y) v in (2 * s, - s ^ 2)) Y.

Lemma lower_triangle_sound : forall Y i r start S v, rows_rel contains i r -> triangle_in bits start S ->
  exists T, triangle_in bits (lower_triangle Y i start) T /\ quad T v <= quad S v + form (lower_weights Y v) r v.
Proof.
  induction Y as [| y Y IH]; intros i r start S v h hS; [exists S; split; [exact hS | cbn; lra] |].
  destruct h as [| [a d] [b e] i r [h1 h2] h]; [exists S; split; [exact hS | cbn; lra] |]. cbn [fst snd] in *.
  cbn [lower_triangle]. destruct (upper_end_sound bits d e h2) as [g [hg le]].
  destruct (IH i r _ _ v h (triangle_add_sound bits _ _ _ _ hS (halves_sound y _ _ (residual_sound a b _ g y h1 hg))))
    as [T [hT q]]. exists T. split; [exact hT |]. eapply Rle_trans; [exact q |]. cbn [lower_weights map form].
  rewrite quad_tcomb, quad_outer, dot_comb. fold (lower_weights Y v).
  assert (E : dot (map Y_value y) v = 2 * dot (map Y_half y) v).
  { rewrite <- dot_map, map_map. f_equal. apply map_ext. exact Y_half_eq. }
  rewrite E. pose proof (pow2_ge_0 (dot (map Y_half y) v)). nra.
Qed.

(** The square: (A_i.v - D_i s_i)^2 >= 0. *)
Lemma lower_energy : forall Y r v, positive_D r -> form (lower_weights Y v) r v <= energy r v.
Proof.
  intros Y r v h. revert Y. induction h as [| [a d] r h1 h IH]; intro Y; cbn [energy snd] in *.
  - destruct Y; cbn; lra.
  - destruct Y as [| y Y]; cbn [lower_weights map form].
    + specialize (IH []). cbn in IH. assert (0 <= dot a v ^ 2 / d)
        by (apply Rmult_le_pos; [apply pow2_ge_0 | apply Rlt_le, Rinv_0_lt_compat, h1]). lra.
    + specialize (IH Y). fold (lower_weights Y v). set (s := dot (map Y_value y) v). set (t := dot a v).
      assert (0 <= (t - d * s) ^ 2 / d) by (apply Rmult_le_pos; [apply pow2_ge_0 | apply Rlt_le, Rinv_0_lt_compat, h1]).
      replace (t ^ 2 / d) with (2 * s * t + - s ^ 2 * d + (t - d * s) ^ 2 / d) by (field; lra). lra.
Qed.
End Lower.

(** A bound may differ from vertex to vertex: it is a slope, as if it were the D of a row before the others. *)
Definition with_bound (k : slope) (r : rows slope) : rows slope := ([], k) :: r.

Lemma with_bound_rel : forall k e r es, entry_in k e -> rows_rel entry_in r es ->
  rows_rel entry_in (with_bound k r) (([], e) :: es).
Proof. intros. constructor; [split; [constructor | assumption] | assumption]. Qed.

Definition sigma_min (m : nat) (k : slope) (places : N) (Y : list (list Z)) (r : rows slope) : bool :=
  at_vertices m (with_bound k r) (fun i =>
    match i with
    | (_, kappa2) :: i' =>
        let t := lower_triangle places Y i' (repeat [neg kappa2] m) in
        if Nat.eqb (length t) m then is_positive_definite bits t else false
    | [] => false
    end).

Lemma diagonal_in : forall a c n, contains a c -> triangle_in bits (repeat [a] n) (diagonal n c).
Proof. intros a c n h. unfold diagonal, triangle_in. induction n; cbn [repeat]; constructor; auto. Qed.

(** What definite matrices at the vertices show, of rows with any D. *)
Lemma sigma_min_form : forall k places Y r es e lambda v,
  sigma_min (length lambda) k places Y r = true -> entry_in k e ->
  rows_rel entry_in r es -> Forall (fun t => -1 <= t <= 1) lambda -> length v = length lambda -> nonzero v ->
  at_lambda lambda e * dot v v < form (lower_weights places Y v) (map_rows (at_lambda lambda) es) v.
Proof.
  intros k places Y r es e lambda v h hk hr hl len nz.
  pose proof (at_vertices_sound _ _ _ _ ((0, - dot v v) :: lower_weights places Y v) 0 v h (with_bound_rel _ _ _ _ hk hr) hl) as V.
  rewrite map_rows_cons in V. cbn [form] in V.
  enough (0 < 0 + (0 * dot (map (at_lambda lambda) []) v + - dot v v * at_lambda lambda e + form (lower_weights places Y v)
    (map_rows (at_lambda lambda) es) v)) by lra.
  apply V. intros i s t hs. destruct hs as [| [a0 d] [b0 k2] i s [_ hd] hs]; [discriminate |]. cbn [snd] in hd. cbn zeta in t.
  destruct (Nat.eqb_spec (length (lower_triangle places Y i (repeat [neg d] (length lambda)))) (length lambda)) as [l | l];
    [| discriminate].
  destruct (lower_triangle_sound places Y i s _ _ v hs (diagonal_in _ _ (length lambda) (neg_sound bits _ _ hd))) as [T [hT le]].
  pose proof (is_positive_definite_sound bits _ T t hT v) as P.
  rewrite <- len, quad_diagonal in le. rewrite (related_length _ _ _ _ _ hT) in l. specialize (P ltac:(congruence) nz).
  cbn [form]. lra.
Qed.

Theorem sigma_min_sound : forall k places Y r es e lambda v,
  sigma_min (length lambda) k places Y r = true -> entry_in k e ->
  rows_rel entry_in r es -> Forall (fun t => -1 <= t <= 1) lambda ->
  length v = length lambda -> nonzero v -> positive_D (map_rows (at_lambda lambda) es) ->
  at_lambda lambda e * dot v v < energy (map_rows (at_lambda lambda) es) v.
Proof.
  intros k places Y r es e lambda v h hk hr hl len nz hp. apply Rlt_le_trans with (2 := lower_energy places Y _ v hp).
  eapply sigma_min_form; eassumption.
Qed.

(** ** sigma_max: [[D, A], [A^T, k^2 I]], the D_i eliminated first *)

Fixpoint upper_triangle (r : rows fixed) (start : triangle) : option triangle :=
  match r with
  | [] => Some start
  | (a, d) :: r' => match eliminated bits ((lower_end d :: a) :: start) with Some t => upper_triangle r' t | None => None end
  end.

(** w^T D w + 2 w . A v *)
Definition upper_weights (w : list R) : list (R * R) := map (fun t => (2 * t, t ^ 2)) w.

Lemma upper_triangle_sound : forall i r start S v T, rows_rel contains i r -> triangle_in bits start S ->
  upper_triangle i start = Some T ->
  exists U, triangle_in bits T U /\ forall w, quad U v <= quad S v + form (upper_weights w) r v.
Proof.
  intros i r start S v T h. revert start S. induction h as [| [a d] [b e] i r [h1 h2] h IH]; intros start S hS u.
  - injection u as <-. exists S. split; [exact hS |]. intros [| t w]; cbn; lra.
  - cbn [upper_triangle] in u. cbn [fst snd] in h1, h2.
    destruct (eliminated bits ((lower_end d :: a) :: start)) as [t |] eqn:el; [| discriminate].
    destruct (lower_end_sound bits d e h2) as [g [hg le]].
    destruct (eliminated_sound bits _ _ _ _ _ _ _ el hg h1 hS) as [g0 ht].
    destruct (IH _ _ ht u) as [U [hU q]]. exists U. split; [exact hU |]. rewrite quad_schur in q by lra.
    assert (0 <= / g * dot b v ^ 2) by (apply Rmult_le_pos; [apply Rlt_le, Rinv_0_lt_compat, g0 | apply pow2_ge_0]).
    intros [| x w]; cbn [upper_weights map form]; [specialize (q []); cbn in q; lra |].
    specialize (q w). fold (upper_weights w). set (y := dot b v) in *.
    assert (0 <= / g * (g * x + y) ^ 2) by (apply Rmult_le_pos; [apply Rlt_le, Rinv_0_lt_compat, g0 | apply pow2_ge_0]).
    replace (/ g * (g * x + y) ^ 2) with (g * x ^ 2 + 2 * x * y + / g * y ^ 2) in * by (field; lra).
    assert (g * x ^ 2 <= e * x ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact le]). lra.
Qed.

(** Of one row, k > 0, D > 0 and |A|^2 < k D: nothing is divided, nor rounded. *)
Definition squares (a : list fixed) : Z := fold_right (fun x sum => (magnitude x * magnitude x + sum)%Z) 0%Z a.
Definition are_below (n : nat) (r : rows fixed) (k : fixed) : bool :=
  match r with
  | [(a, d)] => (0 <? lo k)%Z && (0 <? lo d)%Z && (squares a <? lo k * lo d)%Z
  | _ => match upper_triangle r (repeat [k] n) with Some t => Nat.eqb (length t) n && is_positive_definite bits t | None => false end
  end.

Lemma squares_sound : forall a b, Forall2 contains a b -> dot b b * unit_R bits ^ 2 <= IZR (squares a).
Proof.
  induction 1 as [| x y a b h _ IH]; cbn [squares fold_right dot]; [rewrite Rmult_0_l; apply Rle_refl |]. fold (squares a).
  rewrite plus_IZR, mult_IZR. pose proof (magnitude_sound bits x y 1 h ltac:(lra)) as M. rewrite Rmult_1_r in M.
  set (z := IZR (magnitude x)) in *. set (u := unit_R bits) in *. replace ((y * y + dot b b) * u ^ 2) with ((y * u) ^ 2 + dot b b * u ^ 2) by ring.
  assert ((y * u) ^ 2 <= z * z) by nra. lra.
Qed.

Lemma one_row_below : forall k d a v x, 0 < k -> dot a a < k * d -> nonzero v -> 0 < k * dot v v + (2 * x * dot a v + x ^ 2 * d).
Proof.
  intros k d a v x k0 h nz. unfold nonzero in nz.
  assert (N : forall u, 0 <= dot u u) by (induction u as [| y u IH]; cbn [dot]; [lra | nra]).
  assert (C : forall u w, dot u w = dot w u) by (induction u as [| y u IH]; intros [| z w]; cbn [dot]; rewrite ?IH; ring).
  pose proof (N (comb k x v a)) as S. rewrite dot_comb, (C v), (C a), !dot_comb, (C v a) in S.
  apply Rmult_lt_reg_l with k; [exact k0 |]. rewrite Rmult_0_r. destruct (Req_dec x 0) as [-> | n].
  - replace (k * (k * dot v v + (2 * 0 * dot a v + 0 ^ 2 * d))) with (k * (k * dot v v)) by ring. repeat apply Rmult_lt_0_compat; assumption.
  - assert (0 < x ^ 2 * (k * d - dot a a)) by (apply Rmult_lt_0_compat; [rewrite <- Rsqr_pow2; apply Rlt_0_sqr, n | lra]).
    replace (k * (k * dot v v + (2 * x * dot a v + x ^ 2 * d))) with
      (k * (k * dot v v + x * dot a v) + x * (k * dot a v + x * dot a a) + x ^ 2 * (k * d - dot a a)) by ring. lra.
Qed.

Lemma are_below_sound : forall n i r b k v w, are_below n i b = true -> rows_rel contains i r -> contains b k -> length v = n -> nonzero v ->
  0 < k * dot v v + form (upper_weights w) r v.
Proof.
  intros n i r b k v w h hr hb lv nz.
  assert (More : match upper_triangle i (repeat [b] n) with Some t => Nat.eqb (length t) n && is_positive_definite bits t | None => false end = true ->
    0 < k * dot v v + form (upper_weights w) r v).
  { clear h. intro h. destruct (upper_triangle i (repeat [b] n)) as [T |] eqn:u; [| discriminate]. apply andb_true_iff in h as [e h]. apply Nat.eqb_eq in e.
    destruct (upper_triangle_sound i r _ _ v T hr (diagonal_in _ _ n hb) u) as [U [hU le]].
    pose proof (is_positive_definite_sound bits _ U h hU v) as Q. specialize (le w). rewrite <- lv, quad_diagonal in le.
    rewrite (related_length _ _ _ _ _ hU) in e. specialize (Q ltac:(congruence) nz). lra. }
  unfold are_below in h. destruct hr as [| [a d] [a' d'] i r [h1 h2] hr]; [exact (More h) |]. destruct hr; [| exact (More h)].
  clear More. cbn [fst snd] in h1, h2. apply andb_true_iff in h as [h q]. apply andb_true_iff in h as [p p']. apply Z.ltb_lt in p, p', q.
  pose proof (contains_positive bits _ _ p hb) as k0. pose proof (squares_sound _ _ h1) as S. apply IZR_lt in q. rewrite mult_IZR in q.
  assert (g : dot a' a' < k * d').
  { pose proof (unit_R_pos bits) as u0. destruct hb as [kl _], h2 as [dl _]. apply IZR_lt in p, p'. apply Rmult_lt_reg_r with (unit_R bits ^ 2); [nra |].
    apply Rle_lt_trans with (1 := S), Rlt_le_trans with (1 := q). replace (k * d' * unit_R bits ^ 2) with (k * unit_R bits * (d' * unit_R bits)) by ring.
    apply Rmult_le_compat; lra. }
  destruct w as [| x w]; cbn [upper_weights map form].
  - pose proof (Rmult_lt_0_compat _ _ k0 nz). lra.
  - pose proof (one_row_below k d' a' v x k0 g nz) as O. destruct w; cbn [form map]; lra.
Qed.

Definition sigma_max (m : nat) (k : slope) (r : rows slope) : bool :=
  at_vertices m (with_bound k r) (fun i =>
    match i with
    | (_, k2) :: i' =>
        match upper_triangle i' (repeat [k2] m) with
        | Some t => if Nat.eqb (length t) m then is_positive_definite bits t else false
        | None => false
        end
    | [] => false
    end).

Lemma upper_energy : forall r v, positive_D r -> exists w, form (upper_weights w) r v = - energy r v.
Proof.
  induction 1 as [| [a d] r h1 h [w IH]]; [exists []; cbn; ring |].
  exists (- (dot a v / d) :: w). cbn [upper_weights map form energy snd] in *. fold (upper_weights w). rewrite IH. field. lra.
Qed.

Theorem sigma_max_sound : forall k r es e lambda v,
  sigma_max (length lambda) k r = true -> entry_in k e ->
  rows_rel entry_in r es -> Forall (fun t => -1 <= t <= 1) lambda ->
  length v = length lambda -> nonzero v -> positive_D (map_rows (at_lambda lambda) es) ->
  energy (map_rows (at_lambda lambda) es) v < at_lambda lambda e * dot v v.
Proof.
  intros k r es e lambda v h hk hr hl len nz hp. destruct (upper_energy _ v hp) as [w E].
  pose proof (at_vertices_sound _ _ _ _ ((0, dot v v) :: upper_weights w) 0 v h (with_bound_rel _ _ _ _ hk hr) hl) as V.
  rewrite map_rows_cons in V. cbn [form] in V.
  enough (0 < 0 + (0 * dot (map (at_lambda lambda) []) v + dot v v * at_lambda lambda e + form (upper_weights w)
    (map_rows (at_lambda lambda) es) v)) by lra.
  apply V. intros i s t hs. destruct hs as [| [a0 d] [b0 k2] i s [_ hd] hs]; [discriminate |]. cbn [snd] in hd.
  destruct (upper_triangle i (repeat [d] (length lambda))) as [T |] eqn:u; [| discriminate].
  destruct (Nat.eqb_spec (length T) (length lambda)) as [l | l]; [| discriminate].
  destruct (upper_triangle_sound i s _ _ v T hs (diagonal_in _ _ (length lambda) hd) u) as [U [hU le]].
  pose proof (is_positive_definite_sound bits _ U t hU v) as P.
  specialize (le w). rewrite <- len, quad_diagonal in le. rewrite (related_length _ _ _ _ _ hU) in l.
  specialize (P ltac:(congruence) nz). cbn [form]. lra.
Qed.

(** ** Full rank: Y^T A + A^T Y, with no D *)

Definition without_D (z : slope) (r : rows slope) : rows slope := map (fun p => (fst p, z)) r.
Lemma rank_energy : forall places Y r v, positive_D r ->
  0 < form (lower_weights places Y v) (map (fun p => (fst p, 0)) r) v -> 0 < energy r v.
Proof.
  intros places Y r v h. assert (N : forall r, positive_D r -> 0 <= energy r v).
  { induction 1 as [| [a d] q h1 _ IH]; cbn [energy snd] in *; [lra |].
    assert (0 <= dot a v ^ 2 / d) by (apply Rmult_le_pos; [apply pow2_ge_0 | apply Rlt_le, Rinv_0_lt_compat, h1]). lra. }
  revert Y. induction h as [| [a d] r h1 h IH]; intros [| y Y] p; cbn [lower_weights map form energy fst snd] in *; try lra.
  specialize (N r h). destruct (Req_dec (dot a v) 0) as [z | z].
  - rewrite z in *. set (s := dot (map (Y_value places) y) v) in *. change (map _ Y) with (lower_weights places Y v) in p.
    clearbody s. rewrite !Rmult_0_r, !Rplus_0_l in p. specialize (IH Y). replace (0 ^ 2 / d) with 0 by (unfold Rdiv; ring).
    specialize (IH p). lra.
  - assert (0 < dot a v ^ 2 / d); [| lra]. apply Rdiv_lt_0_compat; [| exact h1].
    rewrite <- Rsqr_pow2. apply Rlt_0_sqr, z.
Qed.

(** The form, where [less] is not negative. *)
Definition chords (m : nat) (less : option slope) (places : N) (Y : list (list Z)) (r : rows slope) : bool :=
  sigma_min m match less with Some t => t | None => Slope zero zero [] end places Y (without_D (Slope zero zero []) r).

Theorem chords_sound : forall less places Y r es lambda v, chords (length lambda) less places Y r = true ->
  rows_rel entry_in r es -> Forall (fun t => -1 <= t <= 1) lambda ->
  match less with Some t => exists e, entry_in t e /\ 0 <= at_lambda lambda e | None => True end ->
  length v = length lambda -> nonzero v ->
  0 < form (lower_weights places Y v) (map (fun p => (fst p, 0)) (map_rows (at_lambda lambda) es)) v.
Proof.
  intros less places Y r es lambda v h hr hl hs len nz.
  assert (Z : entry_in (Slope zero zero []) (0, [])) by (split; [apply zero_sound | constructor]).
  assert (T : exists e, entry_in match less with Some t => t | None => Slope zero zero [] end e /\ 0 <= at_lambda lambda e).
  { destruct less as [t |]; [exact hs |]. exists (0, []). split; [exact Z | unfold at_lambda; cbn; lra]. }
  destruct T as [e [he e0]]. set (es0 := map (fun p => (fst p, (0, [] : list R))) es).
  assert (R0 : rows_rel entry_in (without_D (Slope zero zero []) r) es0)
    by (eapply map_related; [| exact hr]; intros a b [k _]; split; [exact k | exact Z]).
  assert (E : map_rows (at_lambda lambda) es0 = map (fun p => (fst p, 0)) (map_rows (at_lambda lambda) es)).
  { unfold es0, map_rows. rewrite !map_map. apply map_ext. intros [a d]. cbn [fst snd]. unfold at_lambda at 2. cbn. f_equal. ring. }
  pose proof (sigma_min_form _ _ _ _ _ _ lambda v h he R0 hl len nz) as F. rewrite E in F.
  assert (0 <= at_lambda lambda e * dot v v) by (apply Rmult_le_pos; [exact e0 | apply Rlt_le, nz]). lra.
Qed.

(** ** A sign at the vertices *)

Definition sign_there (m : nat) (f : slope) : bool := forallb (fun s => (0 <=? lo (at_vertex s f))%Z) (signs m).

Theorem sign_there_sound : forall f e lambda, sign_there (length lambda) f = true -> entry_in f e ->
  Forall (fun t => -1 <= t <= 1) lambda -> 0 <= at_lambda lambda e.
Proof.
  intros f e lambda h he hl. unfold sign_there in h. rewrite forallb_forall in h.
  apply (vertices_decide_weakly lambda (fun l => at_lambda l e) hl).
  - intros before t after. apply at_lambda_affine.
  - intros s len. apply (contains_nonneg bits (at_vertex s f)).
    + apply Z.leb_le, h. rewrite <- len. apply signs_all.
    + apply at_vertex_sound, he.
Qed.

Definition positive_there (m : nat) (f : slope) : bool := forallb (fun s => (0 <? lo (at_vertex s f))%Z) (signs m).

Theorem positive_there_sound : forall f e lambda, positive_there (length lambda) f = true -> entry_in f e ->
  Forall (fun t => -1 <= t <= 1) lambda -> 0 < at_lambda lambda e.
Proof.
  intros f e lambda h he hl. unfold positive_there in h. rewrite forallb_forall in h.
  apply (vertices_decide lambda (fun l => at_lambda l e) hl).
  - intros before t after. apply at_lambda_affine.
  - intros s len. apply (contains_positive bits (at_vertex s f)).
    + apply Z.ltb_lt, h. rewrite <- len. apply signs_all.
    + apply at_vertex_sound, he.
Qed.

(** Negative at the vertices, and so not to be found. *)
Definition negative_there (m : nat) (f : slope) : bool := forallb (fun s => (hi (at_vertex s f) <? 0)%Z) (signs m).

Theorem negative_there_sound : forall f e lambda, negative_there (length lambda) f = true -> entry_in f e ->
  Forall (fun t => -1 <= t <= 1) lambda -> at_lambda lambda e < 0.
Proof.
  intros f e lambda h he hl. unfold negative_there in h. rewrite forallb_forall in h.
  enough (0 < - at_lambda lambda e) by lra.
  apply (vertices_decide lambda (fun l => - at_lambda l e) hl).
  - intros before t after. rewrite at_lambda_affine. field.
  - intros s len. specialize (h s). rewrite <- len in h. specialize (h (signs_all s)). apply Z.ltb_lt in h.
    destruct (at_vertex_sound s f e he) as [_ u]. pose proof (unit_R_pos bits). apply IZR_lt in h.
    assert (at_lambda (map corner s) e * unit_R bits < 0) by lra. nra.
Qed.

(** ** Sums of slopes as functions of lambda *)

Definition dyadic_slope (n : Z) (places : N) (t : slope) : slope :=
  Slope (dyadic n places (at_c t)) (range t) (map (dyadic n places) (slopes t)).
Definition total (f t : slope) : slope :=
  Slope (add (at_c f) (at_c t)) (range f) (merge (fun a => a) (fun b => b) add (slopes f) (slopes t)).
Definition multiple (a : fixed) (t : slope) : slope := Slope (mul bits a (at_c t)) (range t) (map (mul bits a) (slopes t)).
Definition difference (f t : slope) : slope :=
  Slope (sub (at_c f) (at_c t)) (range f) (merge (fun a => a) neg sub (slopes f) (slopes t)).

Lemma dyadic_in : forall n places t e, entry_in t e ->
  exists e', entry_in (dyadic_slope n places t) e' /\ forall l, at_lambda l e' = IZR n / IZR (2 ^ Z.of_N places) * at_lambda l e.
Proof.
  intros n places t [y u] [h1 h2]. set (q := IZR n / IZR (2 ^ Z.of_N places)). exists (q * y, map (Rmult q) u). split.
  - split; [apply dyadic_sound, h1 |]. cbn [dyadic_slope slopes snd] in *. eapply map_related; [| exact h2].
    intros a x h. apply dyadic_sound, h.
  - intro l. unfold at_lambda. cbn [fst snd]. rewrite dot_map. ring.
Qed.

Lemma multiple_in : forall a x t e, contains a x -> entry_in t e ->
  exists e', entry_in (multiple a t) e' /\ forall l, at_lambda l e' = x * at_lambda l e.
Proof.
  intros a x t [y u] h [h1 h2]. exists (x * y, map (Rmult x) u). split.
  - split; [apply mul_sound; assumption |]. cbn [multiple slopes snd] in *. eapply map_related; [| exact h2].
    intros b z k. apply mul_sound; assumption.
  - intro l. unfold at_lambda. cbn [fst snd]. rewrite dot_map. ring.
Qed.

Lemma total_in : forall f t e d, entry_in f e -> entry_in t d ->
  exists e', entry_in (total f t) e' /\ forall l, at_lambda l e' = at_lambda l e + at_lambda l d.
Proof.
  intros f t [y u] [z w] [h1 h2] [k1 k2]. exists (y + z, comb 1 1 u w). split.
  - split; [apply add_sound; assumption |]. cbn [total slopes snd] in *.
    eapply (merge_related _ _ _ _ _ _ contains contains contains); try eassumption.
    + intros a x h. rewrite Rmult_1_l. exact h.
    + intros a x h. rewrite Rmult_1_l. exact h.
    + intros a x b x' h k. rewrite !Rmult_1_l. apply add_sound; assumption.
  - intro l. unfold at_lambda. cbn [fst snd]. rewrite dot_comb. ring.
Qed.

Lemma constant_in : forall a x, contains a x -> entry_in (constant a) (x, []).
Proof. intros a x h. split; [exact h | constructor]. Qed.

Lemma at_constant : forall l x, at_lambda l (x, []) = x.
Proof. intros. unfold at_lambda. cbn. ring. Qed.

Lemma difference_in : forall f t e d, entry_in f e -> entry_in t d ->
  exists e', entry_in (difference f t) e' /\ forall l, at_lambda l e' = at_lambda l e - at_lambda l d.
Proof.
  intros f t [y u] [z w] [h1 h2] [k1 k2]. exists (y - z, comb 1 (-1) u w). split.
  - split; [apply sub_sound; assumption |]. cbn [difference slopes snd] in *.
    eapply (merge_related _ _ _ _ _ _ contains contains contains); try eassumption.
    + intros a x h. rewrite Rmult_1_l. exact h.
    + intros a x h. replace (-1 * x) with (- x) by ring. apply neg_sound, h.
    + intros a x b x' h k. replace (1 * x + -1 * x') with (x - x') by ring. apply sub_sound; assumption.
  - intro l. unfold at_lambda. cbn [fst snd]. rewrite dot_comb. ring.
Qed.
End Precision.
