(** * A row and a symmetric matrix

    If (1 - a |row|) I + b H and (1 - a |row|) I - b H are positive definite at the vertices, then
    a |row . e| + b |v . H v| < 1 on the cell for all unit vectors e and v: for fixed e and v, a row . e is affine.
    Where |row|^2 <= K^2 - s^2, (K^2 - s_0 s)/sqrt(K^2 - s_0^2) is not less than |row|, for any s_0, and affine. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope Definite Test Apart Solve.
Import ListNotations.
Local Open Scope R_scope.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

(** At a vertex: |row|, and what is not less, of K^2 and s. *)
Definition row_size (row : list slope) (s : list bool) : option fixed :=
  Some (greatest_root bits (fold_right (fun f sum => add (sqr bits (at_vertex s f)) sum) zero row)).
Definition lever_size (k2 : fixed) (l : slope) (s : list bool) : option fixed :=
  let c := lower_end (at_c l) in
  match root bits (sub k2 (sqr bits c)) with
  | Some r => option_map (mul bits (sub k2 (mul bits c (at_vertex s l)))) (recip bits r)
  | None => None
  end.

(** [H]: the upper triangle of 2 H. *)
Definition bent (m : nat) (less : option slope) (H : list (list slope)) (a b : fixed) (size : list bool -> option fixed) : bool :=
  forallb (fun s => match size s with
    | Some n =>
        let d := sub (Fixed.integer bits 1) (mul bits a n) in
        let d := match less with Some t => sub d (at_vertex s t) | None => d end in
        let part b := is_definite bits m (triangle_add (repeat [d] m) (map (map (fun h => mul bits b (at_vertex s h))) H)) in
        part (halve b) && part (neg (halve b))
    | None => false
    end) (signs m).
Definition curved (m : nat) (less : option slope) (row : list slope) (H : list (list slope)) (a b : fixed) (lever : option (fixed * slope)) : bool :=
  bent m less H a b (row_size row) || match lever with Some (k2, l) => bent m less H a b (lever_size k2 l) | None => false end.

(** ** Soundness *)

Section Cell.
Variable lambda : list R.
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.
Let m := length lambda.

Definition real_triangle (l : list R) (H : list (list entry)) : list (list R) := map (map (at_lambda l)) H.

Lemma real_triangle_affine : forall p q l l1 l2, (forall e, at_lambda l e = p * at_lambda l1 e + q * at_lambda l2 e) ->
  forall H, real_triangle l H = tcomb p q (real_triangle l1 H) (real_triangle l2 H).
Proof.
  intros p q l l1 l2 h. unfold real_triangle, tcomb, comb. induction H as [| row H IH]; cbn [map merge]; [reflexivity |]. f_equal; [| exact IH].
  clear IH. induction row as [| e row IH]; cbn [map merge]; [reflexivity |]. rewrite h, IH. reflexivity.
Qed.

(** What is affine, and at the vertices not more than [size], is so of the row. *)
Lemma bent_sound : forall less H Hs a A b B size (N : list R -> R),
  bent m less H a b size = true -> match less with Some t => exists e, entry_in bits t e /\ 0 <= at_lambda lambda e | None => True end ->
  Forall2 (Forall2 (entry_in bits)) H Hs -> contains a A -> 0 <= A -> contains b B ->
  (forall before t after, N (before ++ t :: after) = (1 + t) / 2 * N (before ++ 1 :: after) + (1 - t) / 2 * N (before ++ -1 :: after)) ->
  (forall s n, length s = m -> size s = Some n -> exists y, contains n y /\ N (map corner s) <= y) ->
  forall v, length v = m -> nonzero v -> Rabs (B / 2 * quad (real_triangle lambda Hs) v) < (1 - A * N lambda) * dot v v.
Proof.
  intros less H Hs a A b B size N h hl hH ha A0 hb affine small v len nz. unfold bent in h. rewrite forallb_forall in h.
  assert (L : exists e, match less with Some t => entry_in bits t e | None => e = (0, []) end /\ 0 <= at_lambda lambda e).
  { destruct less as [t |]; [exact hl | exists (0, []); split; [reflexivity | unfold at_lambda; cbn; lra]]. }
  destruct L as [el [he e0]]. pose proof (dot_self v) as v0.
  assert (Part : forall sign, sign = 1 \/ sign = -1 -> 0 < (1 - A * N lambda - at_lambda lambda el) * dot v v + sign * (B / 2 * quad (real_triangle lambda Hs) v)).
  { intros sign hs. apply (vertices_decide lambda (fun l => (1 - A * N l - at_lambda l el) * dot v v + sign * (B / 2 * quad (real_triangle l Hs) v)) lambda_in).
    - intros before t after. rewrite affine, (at_lambda_affine before t after el), (real_triangle_affine _ _ _ _ _ (at_lambda_affine before t after)), quad_tcomb. field.
    - intros s ls. fold m in ls. specialize (h s ltac:(rewrite <- ls; apply signs_all)). destruct (size s) as [n |] eqn:en; [| discriminate].
      destruct (small s n ls en) as [y [hy le]]. apply andb_true_iff in h as [h1 h2].
      set (d := match less with Some t => sub _ _ | None => _ end) in *.
      assert (hd : contains d (1 - A * y - at_lambda (map corner s) el)).
      { unfold d. destruct less as [t |].
        - apply sub_sound; [apply sub_sound; [apply integer_sound | apply mul_sound; assumption] | apply at_vertex_sound, he].
        - rewrite he. unfold at_lambda. cbn [fst snd dot]. replace (1 - A * y - (0 + 0)) with (1 - A * y) by ring. apply sub_sound; [apply integer_sound | apply mul_sound; assumption]. }
      assert (K : forall b' B', contains b' B' -> is_definite bits m (triangle_add (repeat [d] m) (map (map (fun h => mul bits b' (at_vertex s h))) H)) = true ->
        0 < (1 - A * N (map corner s) - at_lambda (map corner s) el) * dot v v + B' * quad (real_triangle (map corner s) Hs) v).
      { intros b' B' hb' k. unfold is_definite in k. destruct (Nat.eqb_spec (length (triangle_add (repeat [d] m) (map (map (fun h => mul bits b' (at_vertex s h))) H))) m) as [lt |]; [| discriminate].
        assert (T : triangle_in bits (triangle_add (repeat [d] m) (map (map (fun h => mul bits b' (at_vertex s h))) H))
          (tcomb 1 1 (diagonal m (1 - A * y - at_lambda (map corner s) el)) (map (map (Rmult B')) (real_triangle (map corner s) Hs)))).
        { apply triangle_add_sound; [apply diagonal_in, hd |]. unfold real_triangle. rewrite map_map. apply (map_related _ _ _ _ (Forall2 (entry_in bits))); [| exact hH].
          intros u w hu. rewrite map_map. apply (map_related _ _ _ _ (entry_in bits)); [| exact hu]. intros f e hf. apply mul_sound; [exact hb' | apply at_vertex_sound, hf]. }
        rewrite (related_length _ _ _ _ _ T) in lt. pose proof (is_positive_definite_sound bits _ _ k T v ltac:(congruence) nz) as P.
        rewrite quad_tcomb, quad_map, <- len, quad_diagonal in P.
        assert ((1 - A * y - at_lambda (map corner s) el) * dot v v <= (1 - A * N (map corner s) - at_lambda (map corner s) el) * dot v v); [| lra].
        apply Rmult_le_compat_r; [exact v0 |]. assert (A * N (map corner s) <= A * y) by (apply Rmult_le_compat_l; assumption). lra. }
      destruct hs as [-> | ->].
      + specialize (K _ _ (halve_sound bits _ _ hb) h1). lra.
      + specialize (K _ _ (neg_sound bits _ _ (halve_sound bits _ _ hb)) h2). lra. }
  pose proof (Part 1 (or_introl eq_refl)) as P1. pose proof (Part (-1) (or_intror eq_refl)) as P2.
  assert (0 <= at_lambda lambda el * dot v v) by (apply Rmult_le_pos; assumption). apply Rabs_def1; lra.
Qed.

Lemma row_size_sound : forall row es e s n, Forall2 (entry_in bits) row es -> dot e e <= 1 -> row_size row s = Some n ->
  exists y, contains n y /\ dot (map (at_lambda (map corner s)) es) e <= y.
Proof.
  intros row es e s n h he h'. injection h' as <-. set (r := map (at_lambda (map corner s)) es).
  assert (S : contains (fold_right (fun f sum => add (sqr bits (at_vertex s f)) sum) zero row) (dot r r)).
  { unfold r. clear r. induction h as [| f y row es hf h IH]; cbn [fold_right map dot]; [apply zero_sound |]. apply add_sound; [| exact IH].
    replace (at_lambda (map corner s) y * at_lambda (map corner s) y) with (at_lambda (map corner s) y ^ 2) by ring. apply sqr_sound, at_vertex_sound, hf. }
  pose proof (dot_cauchy r e) as C. pose proof (dot_self r) as r0. pose proof (dot_self e) as e0.
  destruct (greatest_root_sound bits _ _ (dot r e) S) as [z [h1 [_ h2]]]; [nra |]. exists z. split; assumption.
Qed.

(** (K^2 - s_0 s)^2 - (K^2 - s^2) (K^2 - s_0^2) = K^2 (s - s_0)^2 *)
Lemma lever_size_least : forall K2 s0 s r y, 0 < K2 - s0 ^ 2 -> r ^ 2 = K2 - s0 ^ 2 -> 0 < r -> y ^ 2 <= K2 - s ^ 2 -> y <= (K2 - s0 * s) / r.
Proof.
  intros K2 s0 s r y p r2 r0 h. pose proof (pow2_ge_0 y) as y0. pose proof (pow2_ge_0 s0).
  assert (I : (K2 - s0 * s) ^ 2 = (K2 - s ^ 2) * (K2 - s0 ^ 2) + K2 * (s - s0) ^ 2) by ring.
  assert (K0 : 0 < K2) by lra. assert (0 <= K2 * (s - s0) ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]).
  assert (Q : 0 < K2 - s0 * s) by (pose proof (pow2_ge_0 (s - s0)); nra).
  apply Rmult_le_reg_r with r; [exact r0 |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  assert ((y * r) ^ 2 <= (K2 - s0 * s) ^ 2).
  { rewrite Rpow_mult_distr, r2, I. assert (y ^ 2 * (K2 - s0 ^ 2) <= (K2 - s ^ 2) * (K2 - s0 ^ 2)) by (apply Rmult_le_compat_r; lra). lra. }
  apply Rnot_lt_le. intro n. nra.
Qed.

Theorem curved_sound : forall less row es H Hs a A b B lever,
  curved m less row H a b lever = true -> match less with Some t => exists e, entry_in bits t e /\ 0 <= at_lambda lambda e | None => True end ->
  Forall2 (entry_in bits) row es -> Forall2 (Forall2 (entry_in bits)) H Hs -> contains a A -> 0 <= A -> contains b B ->
  let real := map (at_lambda lambda) es in
  match lever with Some (k2, l) => exists K2 e, contains k2 K2 /\ entry_in bits l e /\ dot real real <= K2 - at_lambda lambda e ^ 2 | None => True end ->
  forall e v, dot e e <= 1 -> length v = m -> nonzero v -> Rabs (B / 2 * quad (real_triangle lambda Hs) v) < (1 - A * dot real e) * dot v v.
Proof.
  intros less row es H Hs a A b B lever h hl hr hH ha A0 hb real hlever e v he len nz. unfold curved in h. apply orb_true_iff in h as [h | h].
  - apply (bent_sound less H Hs a A b B _ (fun l => dot (map (at_lambda l) es) e) h hl hH ha A0 hb); [| | exact len | exact nz].
    + intros before t after. clear. revert e. induction es as [| f es IH]; intros [| y e]; cbn [map dot]; try field. rewrite (at_lambda_affine before t after f), (IH e). field.
    + intros s n _ en. exact (row_size_sound row es e s n hr he en).
  - destruct lever as [[k2 l] |]; [| discriminate]. destruct hlever as [K2 [el [hk [hel D]]]].
    pose proof (dot_self v) as v0.
    destruct (lower_end_sound bits _ _ (proj1 hel)) as [s0 [hs0 _]].
    destruct (root bits (sub k2 (sqr bits (lower_end (at_c l))))) as [r |] eqn:er.
    2: { exfalso. unfold bent in h. rewrite forallb_forall in h. assert (i : In (repeat true m) (signs m)) by (rewrite <- (repeat_length true m) at 2; apply signs_all).
      specialize (h _ i). unfold lever_size in h. rewrite er in h. discriminate. }
    destruct (root_sound bits _ _ _ er (sub_sound bits _ _ _ _ hk (sqr_sound bits _ _ hs0))) as [p [r0 hr0]]. set (R := sqrt (K2 - s0 ^ 2)) in *.
    assert (R2 : R ^ 2 = K2 - s0 ^ 2) by (unfold R; apply pow2_sqrt; lra).
    pose proof (bent_sound less H Hs a A b B _ (fun l => (K2 - s0 * at_lambda l el) / R) h hl hH ha A0 hb) as G.
    apply Rlt_le_trans with ((1 - A * ((K2 - s0 * at_lambda lambda el) / R)) * dot v v).
    + apply G; [| | exact len | exact nz].
      * intros before t after. rewrite (at_lambda_affine before t after el). field. lra.
      * intros s n _ en. unfold lever_size in en. rewrite er in en. destruct (recip bits r) as [q |] eqn:eq; [| discriminate]. injection en as <-.
        exists ((K2 - s0 * at_lambda (map corner s) el) / R). split; [| apply Rle_refl].
        apply mul_sound; [apply sub_sound; [exact hk | apply mul_sound; [exact hs0 | apply at_vertex_sound, hel]] | exact (proj2 (recip_sound bits _ _ _ eq hr0))].
    + apply Rmult_le_compat_r; [exact v0 |]. apply Rplus_le_compat_l, Ropp_le_contravar, Rmult_le_compat_l; [exact A0 |].
      apply lever_size_least; try assumption. pose proof (dot_cauchy real e) as C. pose proof (dot_self real). pose proof (dot_self e). nra.
Qed.
End Cell.
End Precision.
