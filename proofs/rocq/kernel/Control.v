(** * Polynomials of degree two at most in each coordinate, at the control points of a cell

    A formula that is affine in each pair (x_k, x_k^2) is, at every point of a
    cell, a weighted mean of its values at control points, with the same weights
    for all such formulas: those of Bernstein's polynomials (control.rs). *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Formula Linear Arithmetic Slope Test Definite Cell.
From Orthocert.kernel Require Export Solve.
Import ListNotations.
Local Open Scope R_scope.

(** Squares of coordinates as coordinates of their own, [m] places further. *)
Fixpoint image (m : nat) (f : formula) : formula :=
  match f with F (Sqr (F (Coord k))) => F (Coord (m + k)) | F o => F (map_op (image m) o) end.

(** Coordinate [k] and its square are not in the formula. *)
Fixpoint is_free (m k : nat) (f : formula) : bool :=
  match f with
  | F o => match o with
      | Coord j => negb (Nat.eqb j k) && negb (Nat.eqb j (m + k))
      | Param _ | Integer _ => true
      | Add a b | Sub a b | Mul a b | Div a b => is_free m k a && is_free m k b
      | Neg a | Sqr a | Sqrt a => is_free m k a
      | Elbow _ _ _ _ => false
      end
  end.
(** Certainly affine in the two. *)
Fixpoint is_affine (m k : nat) (f : formula) : bool :=
  match f with
  | F o => match o with
      | Coord _ | Param _ | Integer _ => true
      | Add a b | Sub a b => is_affine m k a && is_affine m k b
      | Neg a => is_affine m k a
      | Mul a b => is_free m k a && is_affine m k b || is_affine m k a && is_free m k b
      | Div a b => is_affine m k a && is_free m k b
      | Sqr a | Sqrt a => is_free m k a
      | Elbow _ _ _ _ => false
      end
  end.
(** Coordinate [j] is not in the formula. *)
Fixpoint is_without (j : nat) (f : formula) : bool :=
  match f with
  | F o => match o with
      | Coord k => negb (Nat.eqb k j)
      | Param _ | Integer _ => true
      | Add a b | Sub a b | Mul a b | Div a b => is_without j a && is_without j b
      | Neg a | Sqr a | Sqrt a => is_without j a
      | Elbow _ _ _ _ => false
      end
  end.
(** Certainly not the less for more of coordinate [j], where [w] is not negative. *)
Fixpoint rises (w : formula) (j : nat) (f : formula) : bool :=
  match f with
  | F o => match o with
      | Coord _ | Param _ | Integer _ => true
      | Add a b => rises w j a && rises w j b
      | Sub a b => rises w j a && is_without j b
      | Mul a b => is_without j a && (is_without j b || Formula.same a w && rises w j b)
      | _ => is_without j f
      end
  end.

(** ** Values at pairs *)

Definition point_of (ps : list (R * R)) : list R := map fst ps ++ map snd ps.

Section Pairs.
Variable theta : list R.
Definition at_pairs (f : formula) (ps : list (R * R)) : R := value (point_of ps) theta f.

Lemma nth_pairs : forall before p after j, let ps := before ++ p :: after in let k := length before in let m := length ps in
  nth j (point_of ps) 0 = if Nat.eqb j k then fst p else if Nat.eqb j (m + k) then snd p else
    nth j (point_of (before ++ (0, 0) :: after)) 0.
Proof.
  intros before p after j. cbv zeta. unfold point_of. rewrite !map_app. cbn [map].
  assert (L : length (before ++ p :: after) = length (before ++ (0, 0) :: after)) by (rewrite !app_length; reflexivity).
  rewrite L. set (m := length (before ++ (0, 0) :: after)).
  assert (M : forall q (f : R * R -> R), length (map f before ++ f q :: map f after) = m) by (intros; unfold m; rewrite !app_length; cbn [length]; rewrite !map_length; reflexivity).
  assert (N : forall (f : R * R -> R) q i, nth i (map f before ++ f q :: map f after) 0 = if Nat.eqb i (length before) then f q else
    nth i (map f before ++ f (0, 0) :: map f after) 0).
  { intros f q i. destruct (Nat.eqb_spec i (length before)) as [-> | n].
    - rewrite app_nth2; rewrite map_length; [rewrite Nat.sub_diag; reflexivity | lia].
    - destruct (Nat.lt_ge_cases i (length before)) as [l | g].
      + rewrite !app_nth1 by (rewrite map_length; exact l). reflexivity.
      + rewrite !app_nth2 by (rewrite map_length; lia). rewrite map_length. destruct (i - length before)%nat eqn:e; [lia | reflexivity]. }
  destruct (Nat.lt_ge_cases j m) as [l | g].
  - rewrite (app_nth1 (map fst before ++ fst p :: map fst after)), (app_nth1 (map fst before ++ fst (0, 0) :: map fst after)) by (rewrite (M _ fst); exact l). rewrite (N fst p j). destruct (Nat.eqb j (length before)); [reflexivity |].
    destruct (Nat.eqb_spec j (m + length before)); [lia | reflexivity].
  - rewrite (app_nth2 (map fst before ++ fst p :: map fst after)), (app_nth2 (map fst before ++ fst (0, 0) :: map fst after)) by (rewrite (M _ fst); exact g).
    rewrite !(M _ fst), (N snd p (j - m)%nat).
    assert (b : (length before < m)%nat) by (unfold m; rewrite app_length; cbn [length]; lia).
    destruct (Nat.eqb_spec j (length before)); [lia |].
    destruct (Nat.eqb_spec (j - m) (length before)), (Nat.eqb_spec j (m + length before)); try lia; reflexivity.
Qed.

(** A weighted mean of three pairs. *)
Definition mean (u v w : R) (p q r : R * R) : R * R := (u * fst p + v * fst q + w * fst r, u * snd p + v * snd q + w * snd r).

Section Coordinate.
Variables before after : list (R * R).
Local Notation m := (S (length before + length after)).
Local Notation k := (length before).
Local Notation at_ f p := (at_pairs f (before ++ p :: after)).

Lemma nth_at : forall p j, nth j (point_of (before ++ p :: after)) 0 = if Nat.eqb j k then fst p else if Nat.eqb j (m + k) then snd p else
  nth j (point_of (before ++ (0, 0) :: after)) 0.
Proof.
  intros p j. pose proof (nth_pairs before p after j) as N. cbv zeta in N. rewrite N.
  replace (length (before ++ p :: after)) with m by (rewrite app_length; cbn [length]; lia). reflexivity.
Qed.

Lemma free_value : forall f p q, is_free m k f = true -> at_ f p = at_ f q.
Proof.
  fix IH 1. intros [o] p q h. unfold at_pairs in *. destruct o as [j | j | n | a b | a b | a | a b | a b | a | a | ? a b e]; cbn [is_free] in h; cbn [value map_op real_op];
    [| exact eq_refl | exact eq_refl | | | | | | | | discriminate h]; try (apply andb_true_iff in h as [h1 h2]; rewrite (IH a p q h1), (IH b p q h2); exact eq_refl);
    try (rewrite (IH a p q h); exact eq_refl).
  apply andb_true_iff in h as [h1 h2]. rewrite (nth_at p), (nth_at q). destruct (Nat.eqb j k); [discriminate h1 |]. destruct (Nat.eqb j (m + k)); [discriminate h2 | exact eq_refl].
Qed.

Lemma without_value : forall f a s t, is_without (m + k) f = true -> at_ f (a, s) = at_ f (a, t).
Proof.
  fix IH 1. intros [o] c s t h. unfold at_pairs in *. destruct o as [j | j | n | a b | a b | a | a b | a b | a | a | ? a b e]; cbn [is_without] in h; cbn [value map_op real_op];
    [| exact eq_refl | exact eq_refl | | | | | | | | discriminate h]; try (apply andb_true_iff in h as [h1 h2]; rewrite (IH a c s t h1), (IH b c s t h2); exact eq_refl);
    try (rewrite (IH a c s t h); exact eq_refl).
  rewrite (nth_at (c, s)), (nth_at (c, t)). destruct (Nat.eqb j k); [exact eq_refl |]. destruct (Nat.eqb j (m + k)); [discriminate h | exact eq_refl].
Qed.

Lemma rises_value : forall w f a s t, rises w (m + k) f = true -> 0 <= at_ w (a, s) -> s <= t -> at_ f (a, s) <= at_ f (a, t).
Proof.
  intros w. fix IH 1. intros [o] c s t h w0 le. destruct o as [j | j | n | a b | a b | a | a b | a b | a | a | ? a b e];
    try (apply Req_le; exact (without_value _ c s t h)); cbn [rises] in h.
  - unfold at_pairs. cbn [value map_op real_op]. rewrite (nth_at (c, s)), (nth_at (c, t)). cbn [fst snd].
    destruct (Nat.eqb j k); [apply Rle_refl |]. destruct (Nat.eqb j (m + k)); [exact le | apply Rle_refl].
  - apply Rle_refl.
  - apply Rle_refl.
  - apply andb_true_iff in h as [h1 h2]. pose proof (IH a c s t h1 w0 le) as A. pose proof (IH b c s t h2 w0 le) as B.
    unfold at_pairs in *. cbn [value map_op real_op]. lra.
  - apply andb_true_iff in h as [h1 h2]. pose proof (IH a c s t h1 w0 le) as A. pose proof (without_value b c s t h2) as B.
    unfold at_pairs in *. cbn [value map_op real_op]. lra.
  - apply andb_true_iff in h as [h1 h]. pose proof (without_value a c s t h1) as A. apply orb_true_iff in h as [h | h].
    + pose proof (without_value b c s t h) as B. unfold at_pairs in *. cbn [value map_op real_op]. rewrite A, B. lra.
    + apply andb_true_iff in h as [e h]. apply Formula.same_sound in e. pose proof (IH b c s t h w0 le) as B. rewrite <- e in w0.
      unfold at_pairs in *. cbn [value map_op real_op]. rewrite <- A. apply Rmult_le_compat_l; assumption.
Qed.

Lemma affine_value : forall f u v w p q r, u + v + w = 1 -> is_affine m k f = true ->
  at_ f (mean u v w p q r) = u * at_ f p + v * at_ f q + w * at_ f r.
Proof.
  fix IH 1. intros [o] u v w p q r s h. assert (E : u = 1 - v - w) by lra. destruct o as [j | j | n | a b | a b | a | a b | a b | a | a | ? a b e].
  - unfold at_pairs. cbn [value map_op real_op]. rewrite (nth_at (mean u v w p q r)), (nth_at p), (nth_at q), (nth_at r). destruct (Nat.eqb j k); [exact eq_refl |].
    destruct (Nat.eqb j (m + k)); [exact eq_refl |]. rewrite E. ring.
  - unfold at_pairs. cbn [value map_op real_op]. rewrite E. ring.
  - unfold at_pairs. cbn [value map_op real_op]. rewrite E. ring.
  - cbn [is_affine] in h. apply andb_true_iff in h as [h1 h2]. pose proof (IH a u v w p q r s h1) as A. pose proof (IH b u v w p q r s h2) as B.
    unfold at_pairs in *. cbn [value map_op real_op]. rewrite A, B. ring.
  - cbn [is_affine] in h. apply andb_true_iff in h as [h1 h2]. pose proof (IH a u v w p q r s h1) as A. pose proof (IH b u v w p q r s h2) as B.
    unfold at_pairs in *. cbn [value map_op real_op]. rewrite A, B. ring.
  - cbn [is_affine] in h. pose proof (IH a u v w p q r s h) as A. unfold at_pairs in *. cbn [value map_op real_op]. rewrite A. ring.
  - cbn [is_affine] in h. apply orb_true_iff in h as [h | h]; apply andb_true_iff in h as [h1 h2].
    + pose proof (IH b u v w p q r s h2) as B. pose proof (fun x => free_value a x p h1) as A. unfold at_pairs in *. cbn [value map_op real_op].
      rewrite B, (A (mean u v w p q r)), (A q), (A r). ring.
    + pose proof (IH a u v w p q r s h1) as A. pose proof (fun x => free_value b x p h2) as B. unfold at_pairs in *. cbn [value map_op real_op].
      rewrite A, (B (mean u v w p q r)), (B q), (B r). ring.
  - cbn [is_affine] in h. apply andb_true_iff in h as [h1 h2].
    pose proof (IH a u v w p q r s h1) as A. pose proof (fun x => free_value b x p h2) as B. unfold at_pairs in *. cbn [value map_op real_op].
    rewrite A, (B (mean u v w p q r)), (B q), (B r). unfold Rdiv. ring.
  - cbn [is_affine] in h. pose proof (fun x => free_value a x p h) as A. unfold at_pairs in *. cbn [value map_op real_op].
    rewrite (A (mean u v w p q r)), (A q), (A r), E. ring.
  - cbn [is_affine] in h. pose proof (fun x => free_value a x p h) as A. unfold at_pairs in *. cbn [value map_op real_op].
    rewrite (A (mean u v w p q r)), (A q), (A r), E. ring.
  - discriminate h.
Qed.
End Coordinate.

(** The first coordinates do not matter to what is free of them. *)
Lemma prefix_value : forall f m before before' after, length before = length before' -> length (before ++ after) = m ->
  (forall k, (k < length before)%nat -> is_free m k f = true) -> at_pairs f (before ++ after) = at_pairs f (before' ++ after).
Proof.
  intros f m before before' after e L h.
  enough (K : forall pre, length (pre ++ before ++ after) = m -> (forall k, (length pre <= k < length pre + length before)%nat -> is_free m k f = true) ->
    at_pairs f (pre ++ before ++ after) = at_pairs f (pre ++ before' ++ after)) by (apply (K []); [exact L | intros k i; apply h; cbn [length] in i; lia]).
  clear h L. revert before' e. induction before as [| p b IH]; intros [| q b'] e pre L h; try discriminate; [reflexivity |].
  transitivity (at_pairs f (pre ++ q :: b ++ after)).
  - apply free_value. replace (S (length pre + length (b ++ after))) with m by (rewrite <- L, !app_length; cbn [length app]; rewrite ?app_length; lia).
    apply h. cbn [length]. lia.
  - specialize (IH b' ltac:(cbn in e; congruence) (pre ++ [q])). rewrite <- !app_assoc in IH. cbn [app] in IH. apply IH.
    + rewrite <- L, !app_length. cbn [length app]. rewrite ?app_length. lia.
    + intros k i. apply h. rewrite app_length in i. cbn [length] in *. lia.
Qed.
End Pairs.

(** There are [m] coordinates. *)
Fixpoint is_below (m : nat) (f : formula) : bool :=
  match f with
  | F o => match o with
      | Coord k => Nat.ltb k m
      | Param _ | Integer _ => true
      | Add a b | Sub a b | Mul a b | Div a b => is_below m a && is_below m b
      | Neg a | Sqr a | Sqrt a => is_below m a
      | Elbow _ _ _ _ => false
      end
  end.

Definition parabola (x : list R) : list (R * R) := map (fun a => (a, a ^ 2)) x.

Lemma image_value : forall theta x f, is_below (length x) f = true -> at_pairs theta (image (length x) f) (parabola x) = value x theta f.
Proof.
  intros theta x. unfold at_pairs. set (X := point_of (parabola x)).
  assert (L : forall j, (j < length x)%nat -> nth j X 0 = nth j x 0 /\ nth (length x + j) X 0 = nth j x 0 ^ 2).
  { intros j h. unfold X, point_of, parabola. rewrite !map_map. cbn [fst snd]. rewrite map_id. split; [apply app_nth1; exact h |].
    rewrite app_nth2_plus. rewrite (nth_indep _ 0 ((fun a => a ^ 2) 0)) by (rewrite map_length; exact h). rewrite (map_nth (fun a => a ^ 2)). reflexivity. }
  fix IH 1. intros [o] h. destruct o as [j | j | n | a b | a b | a | a b | a b | a | a | ? a b e]; cbn [is_below] in h; try discriminate h;
    try (apply andb_true_iff in h as [h1 h2]; cbn [image value map_op real_op]; rewrite (IH a h1), (IH b h2); reflexivity);
    try (cbn [image value map_op real_op]; rewrite (IH a h); reflexivity); try reflexivity.
  - apply Nat.ltb_lt in h. exact (proj1 (L j h)).
  - pose proof (IH a h) as K. destruct a as [[j | j | n | b c | b c | b | b c | b c | b | b | ? b c d]]; [| exact (f_equal (fun y => y ^ 2) K) ..].
    cbn [is_below] in h. apply Nat.ltb_lt in h. exact (proj2 (L j h)).
Qed.

(** ** What holds at control points *)

(** Of each coordinate, some nodes, of which its pair is a weighted mean. *)
Definition is_mean (p : R * R) (nodes : list (R * R)) : Prop :=
  exists u v w q r s, 0 <= u /\ 0 <= v /\ 0 <= w /\ u + v + w = 1 /\ In q nodes /\ In r nodes /\ In s nodes /\ p = mean u v w q r s.

Definition is_convex (good : R -> Prop) : Prop :=
  forall u v w a b c, 0 <= u -> 0 <= v -> 0 <= w -> u + v + w = 1 -> good a -> good b -> good c -> good (u * a + v * b + w * c).

(** [g] is affine in the pair of coordinate [length before]. *)
Definition affine_there (m : nat) (g : list (R * R) -> R) : Prop :=
  forall before after u v w p q r, length (before ++ p :: after) = m -> u + v + w = 1 ->
    g (before ++ mean u v w p q r :: after) = u * g (before ++ p :: after) + v * g (before ++ q :: after) + w * g (before ++ r :: after).

Lemma controls_decide : forall good, is_convex good -> forall m g, affine_there m g -> forall ps nodes, length ps = m ->
  Forall2 is_mean ps nodes -> (forall qs, Forall2 (fun q l => In q l) qs nodes -> good (g qs)) -> good (g ps).
Proof.
  intros good cv m g ha ps nodes lp h.
  enough (K : forall before, (length before + length ps)%nat = m ->
    (forall qs, Forall2 (fun q l => In q l) qs nodes -> good (g (before ++ qs))) -> good (g (before ++ ps))) by exact (K [] lp).
  clear lp. induction h as [| p l ps nodes hp h IH]; intros before lb H; [exact (H [] (Forall2_nil _)) |].
  destruct hp as [u [v [w [q [r [s [u0 [v0 [w0 [su [iq [ir [is ->]]]]]]]]]]]]].
  assert (Each : forall t, In t l -> good (g (before ++ t :: ps))).
  { intros t it. specialize (IH (before ++ [t])). rewrite <- app_assoc in IH. cbn [app] in IH. apply IH.
    - rewrite app_length. cbn [length] in *. lia.
    - intros qs hq. rewrite <- app_assoc. apply (H (t :: qs)). constructor; assumption. }
  rewrite ha; [apply cv; auto | rewrite app_length; exact lb | exact su].
Qed.

Lemma positive_convex : is_convex (fun a => 0 < a).
Proof.
  intros u v w a b c u0 v0 w0 s ha hb hc. destruct (Req_dec u 0) as [-> |]; [destruct (Req_dec v 0) as [-> |] |].
  - replace w with 1 by lra. lra.
  - assert (0 < v * b) by (apply Rmult_lt_0_compat; lra). pose proof (Rmult_le_pos w c w0 ltac:(lra)). lra.
  - assert (0 < u * a) by (apply Rmult_lt_0_compat; lra). pose proof (Rmult_le_pos v b v0 ltac:(lra)). pose proof (Rmult_le_pos w c w0 ltac:(lra)). lra.
Qed.
Lemma nonneg_convex : is_convex (fun a => 0 <= a).
Proof.
  intros u v w a b c u0 v0 w0 s ha hb hc. pose proof (Rmult_le_pos u a u0 ha). pose proof (Rmult_le_pos v b v0 hb). pose proof (Rmult_le_pos w c w0 hc). lra.
Qed.

(** A pair that is a mean of two points, or another of these above it. *)
Definition is_below_mean (p : R * R) (nodes : list (R * R)) : Prop :=
  exists t q r, 0 <= t <= 1 /\ In q nodes /\ In r nodes /\ fst p = fst (mean (1 - t) t 0 q r r) /\ snd p <= snd (mean (1 - t) t 0 q r r).

(** [g] is the easier to show positive the less the squares of the first [e] coordinates of [x] are. *)
Definition falls (e : nat) (x : list R) (g : list (R * R) -> R) : Prop :=
  forall before front z after s, x = front ++ z :: after -> length before = length front -> (length front < e)%nat -> z ^ 2 <= s ->
    g (before ++ (z, s) :: parabola after) <= g (before ++ (z, z ^ 2) :: parabola after).

Lemma ends_decide : forall m g, affine_there m g -> forall x e, length x = m -> falls e x g -> forall nodes,
  Forall2 (fun z l => is_mean (z, z ^ 2) (fst l) /\ is_below_mean (z, z ^ 2) (snd l)) x nodes ->
  (forall qs, Forall2 (fun q l => In q l) qs (map (fun l => snd l) (firstn e nodes) ++ map (fun l => fst l) (skipn e nodes)) -> 0 < g qs) ->
  0 < g (parabola x).
Proof.
  intros m g ha x e lx fall nodes h H.
  enough (K : forall x' nodes', Forall2 (fun z l => is_mean (z, z ^ 2) (fst l) /\ is_below_mean (z, z ^ 2) (snd l)) x' nodes' ->
    forall e' front before, x = front ++ x' -> length before = length front -> (length front + e' = e \/ e' = 0)%nat ->
    (forall qs, Forall2 (fun q l => In q l) qs (map (fun l => snd l) (firstn e' nodes') ++ map (fun l => fst l) (skipn e' nodes')) -> 0 < g (before ++ qs)) ->
    0 < g (before ++ parabola x')) by exact (K x nodes h e [] [] eq_refl eq_refl (or_introl eq_refl) H).
  clear h H. induction 1 as [| z l x' nodes' [hm hb] h IH]; intros e' front before ex lb he H.
  - apply (H []). destruct e'; constructor.
  - assert (L : forall p, length (before ++ p :: parabola x') = m)
      by (intro p; rewrite <- lx, ex, !app_length; cbn [length]; unfold parabola; rewrite map_length; lia).
    assert (Each : forall e'' t, (length (front ++ [z]) + e'' = e \/ e'' = 0)%nat ->
      (forall qs, Forall2 (fun q l => In q l) qs (map (fun l => snd l) (firstn e'' nodes') ++ map (fun l => fst l) (skipn e'' nodes')) -> 0 < g (before ++ t :: qs)) ->
      0 < g (before ++ t :: parabola x')).
    { intros e'' t he'' H'. specialize (IH e'' (front ++ [z]) (before ++ [t])). rewrite <- !app_assoc in IH. cbn [app] in IH. apply IH; auto.
      - rewrite !app_length. cbn [length]. lia.
      - intros qs hq. rewrite <- app_assoc. exact (H' qs hq). }
    cbn [parabola map]. fold (parabola x'). destruct e' as [| e'].
    + destruct hm as [u [v [w [q [r [s [u0 [v0 [w0 [su [iq [ir [is ->]]]]]]]]]]]]].
      assert (N : forall t, In t (fst l) -> 0 < g (before ++ t :: parabola x')).
      { intros t it. apply (Each O t (or_intror eq_refl)). intros qs hq. apply H. cbn [firstn skipn map app]. constructor; [exact it | exact hq]. }
      rewrite ha; [apply positive_convex; auto | apply L | exact su].
    + destruct he as [he |]; [| discriminate]. destruct hb as [t [q [r [[t0 t1] [iq [ir [e1 e2]]]]]]].
      assert (N : forall t, In t (snd l) -> 0 < g (before ++ t :: parabola x')).
      { intros y iy. apply (Each e' y); [left; rewrite app_length; cbn [length]; lia |]. intros qs hq. apply H. cbn [firstn skipn map app]. constructor; [exact iy | exact hq]. }
      apply Rlt_le_trans with (g (before ++ mean (1 - t) t 0 q r r :: parabola x')).
      * rewrite ha; [apply positive_convex; auto; lra | apply L | lra].
      * pose proof (fall before front z x' (snd (mean (1 - t) t 0 q r r)) ex lb ltac:(lia) e2) as B. rewrite (surjective_pairing (mean _ _ _ _ _ _)).
        cbn [fst] in e1. rewrite <- e1. exact B.
Qed.

(** ** Nodes of a range *)

Section Precision.
Variable bits : positive.
Local Notation unit := (unit_R bits).
Local Notation solve_diagonal := (solve_diagonal bits).
Local Notation gram_sound := (gram_sound bits).
Local Notation solve_pairs_sound := (solve_pairs_sound bits).
Local Notation solve_diagonal_sound := (solve_diagonal_sound bits).

(** The ends, with their squares, and between them no point of the parabola. *)
Inductive which := Low | Middle | High.
Definition node (a : fixed) (j : which) : fixed * fixed :=
  let l := Fixed (lo a) (lo a) in let h := Fixed (hi a) (hi a) in
  match j with Low => (l, sqr bits l) | Middle => (halve (add l h), mul bits l h) | High => (h, sqr bits h) end.
Definition in_pair (i : fixed * fixed) (p : R * R) : Prop := contains bits (fst i) (fst p) /\ contains bits (snd i) (snd p).

Definition real_node (a : fixed) (j : which) : R * R :=
  let l := IZR (lo a) / unit in let h := IZR (hi a) / unit in match j with Low => (l, l ^ 2) | Middle => ((l + h) / 2, l * h) | High => (h, h ^ 2) end.
Definition real_nodes (a : fixed) : list (R * R) := map (real_node a) [Low; Middle; High].
Definition real_ends (a : fixed) : list (R * R) := map (real_node a) [Low; High].

Lemma real_node_in : forall a j, in_pair (node a j) (real_node a j).
Proof.
  intros a j. unfold node, real_node. cbv zeta. pose proof (point_sound bits (lo a)) as L. pose proof (point_sound bits (hi a)) as H.
  destruct j; split; cbn [fst snd]; auto using sqr_sound, mul_sound, halve_sound, add_sound.
Qed.

Lemma real_nodes_mean : forall a x, contains bits a x -> is_mean (x, x ^ 2) (real_nodes a).
Proof.
  intros a x [l u]. unfold real_nodes, real_node. cbn [map]. cbv zeta. pose proof (unit_R_pos bits) as u0. set (L := IZR (lo a) / unit). set (H := IZR (hi a) / unit).
  assert (E : forall z, IZR z / unit * unit = IZR z) by (intro; field; lra).
  assert (hl : L <= x) by (apply Rmult_le_reg_r with unit; [exact u0 | unfold L; rewrite E; exact l]).
  assert (hh : x <= H) by (apply Rmult_le_reg_r with unit; [exact u0 | unfold H; rewrite E; exact u]). clearbody L H.
  destruct (Req_dec L H) as [e | n].
  - exists 1, 0, 0, (L, L ^ 2), (L, L ^ 2), (L, L ^ 2). repeat split; try lra; try (left; reflexivity). assert (x = L) by lra. subst x. unfold mean. cbn [fst snd]. f_equal; ring.
  - set (t := (x - L) / (H - L)). assert (T : x = L + t * (H - L)) by (unfold t; field; lra).
    assert (t0 : 0 <= t) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]).
    assert (t1 : t <= 1) by (apply Rmult_le_reg_r with (H - L); [lra |]; lra). clearbody t.
    exists ((1 - t) ^ 2), (2 * t * (1 - t)), (t ^ 2), (L, L ^ 2), ((L + H) / 2, L * H), (H, H ^ 2).
    repeat split; try nra; [left; reflexivity | right; left; reflexivity | right; right; left; reflexivity |].
    unfold mean. cbn [fst snd]. rewrite T. f_equal; field.
Qed.

Lemma real_ends_mean : forall a x, contains bits a x -> is_below_mean (x, x ^ 2) (real_ends a).
Proof.
  intros a x [l u]. unfold real_ends, real_node. cbn [map]. cbv zeta. pose proof (unit_R_pos bits) as u0. set (L := IZR (lo a) / unit). set (H := IZR (hi a) / unit).
  assert (E : forall z, IZR z / unit * unit = IZR z) by (intro; field; lra).
  assert (hl : L <= x) by (apply Rmult_le_reg_r with unit; [exact u0 | unfold L; rewrite E; exact l]).
  assert (hh : x <= H) by (apply Rmult_le_reg_r with unit; [exact u0 | unfold H; rewrite E; exact u]). clearbody L H.
  unfold is_below_mean, mean. cbn [fst snd]. destruct (Req_dec L H) as [e | n].
  - exists 0, (L, L ^ 2), (H, H ^ 2). assert (x = L) by lra. subst x. repeat split; try lra; [left; reflexivity | right; left; reflexivity | |]; cbn [fst snd]; lra.
  - set (t := (x - L) / (H - L)). assert (T : x = L + t * (H - L)) by (unfold t; field; lra).
    assert (t0 : 0 <= t) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]).
    assert (t1 : t <= 1) by (apply Rmult_le_reg_r with (H - L); [lra |]; lra). clearbody t.
    exists t, (L, L ^ 2), (H, H ^ 2). repeat split; try assumption; [left; reflexivity | right; left; reflexivity | |]; cbn [fst snd]; rewrite T; [ring |].
    enough (0 <= t * (1 - t) * (H - L) ^ 2) by lra. apply Rmult_le_pos; [apply Rmult_le_pos; lra | apply pow2_ge_0].
Qed.

(** A control point of a cell; of the first [e] coordinates an end. *)
Fixpoint points (cell : list fixed) (p : list which) : list (fixed * fixed) :=
  match cell, p with a :: cell', j :: p' => node a j :: points cell' p' | _, _ => [] end.
Fixpoint ends_first (e : nat) (p : list which) : Prop :=
  match e, p with S e', j :: p' => j <> Middle /\ ends_first e' p' | _, _ => True end.

Lemma points_in : forall cell e qs,
  Forall2 (fun q l => In q l) qs (map (fun l => snd l) (firstn e (map (fun a => (real_nodes a, real_ends a)) cell))
    ++ map (fun l => fst l) (skipn e (map (fun a => (real_nodes a, real_ends a)) cell))) ->
  exists p, length p = length cell /\ ends_first e p /\ Forall2 in_pair (points cell p) qs.
Proof.
  induction cell as [| a cell IH]; intros e qs h.
  - destruct e; cbn [map firstn skipn app] in h; inversion h; subst; exists []; split; [reflexivity | split; [exact I | constructor] | reflexivity | split; [exact I | constructor]].
  - destruct e as [| e]; cbn [map firstn skipn app fst snd] in h; inversion h as [| q l qs' l' hq h']; subst.
    + destruct (IH O qs' h') as [p [lp [_ hp]]]. apply in_map_iff in hq as [j [<- ij]]. exists (j :: p). split; [cbn; congruence |].
      split; [exact I |]. cbn [points]. constructor; [apply real_node_in | exact hp].
    + destruct (IH e qs' h') as [p [lp [ep hp]]]. apply in_map_iff in hq as [j [<- ij]]. exists (j :: p). split; [cbn; congruence |].
      split; [split; [destruct ij as [<- | [<- | []]]; discriminate | exact ep] |]. cbn [points]. constructor; [apply real_node_in | exact hp].
Qed.

(** ** Formulas at a control point, in intervals *)

(** *** Of a tape, the entries that some others are made of; in place of all else nothing is evaluated *)

Definition nothing : op address := Elbow false Here Here Here.
Definition is_thinned : list (op address) -> list (op address) -> Prop := Forall2 (fun o' o => o' = o \/ o' = nothing).
(** Last first. *)
Fixpoint thinned_back (l : list (op address)) (needed : stack bool) : list (op address) :=
  match l, pop bool needed with
  | o :: l', Some (b, rest) => if b then o :: thinned_back l' (fold_right mark rest (parts_of o)) else nothing :: thinned_back l' rest
  | o :: l', None => o :: thinned_back l' Bottom
  | [], _ => []
  end.
Definition thinned (wanted : list nat) (tape : list (op address)) : list (op address) := rev_append (thinned_back (rev_append tape []) (marked wanted tape)) [].

Lemma thinned_is : forall wanted tape, is_thinned (thinned wanted tape) tape.
Proof.
  intros wanted tape. unfold thinned. rewrite <- !rev_alt. generalize (marked wanted tape). intro needed.
  assert (B : forall l needed, is_thinned (thinned_back l needed) l).
  { induction l as [| o l IH]; intro s; cbn [thinned_back]; [constructor |]. destruct (pop bool s) as [[[|] rest] |]; constructor; auto; apply IH. }
  assert (R0 : forall l' l, is_thinned l' l -> is_thinned (rev l') (rev l)).
  { induction 1 as [| o' o l' l h hs IH]; [constructor |]. cbn [rev]. apply Forall2_app; [exact IH | constructor; [exact h | constructor]]. }
  rewrite <- (rev_involutive tape) at 2. apply R0, B.
Qed.
Lemma thinned_not_at_all : forall tape, is_thinned tape tape.
Proof. induction tape; constructor; auto. Qed.

Theorem run_thinned : forall (V W : Type) (dv : V) (dw : W) (ev : op V -> V) (ew : op W -> W) (P : V -> W -> Prop),
  P dv dw -> (forall w, P dv w) -> (forall f, ev (map_op f nothing) = dv) -> (forall (o : op address) f g, (forall i, P (f i) (g i)) -> P (ev (map_op f o)) (ew (map_op g o))) ->
  forall tape' tape, is_thinned tape' tape -> Forall2 P (run V dv ev tape') (run W dw ew tape).
Proof.
  intros V W dv dw ev ew P start never none step tape' tape h. apply listed_related. assert (B := Bottoms V W P). revert B. generalize (@Bottom V) (@Bottom W).
  induction h as [| o' o tape' tape h hs IH]; intros s s' r; [exact r |]. cbn [run_on]. apply IH, push_related; [| exact r].
  destruct h as [-> | ->]; [apply step; intro i; exact (look_related V W dv dw P start s s' r i) | rewrite none; apply never].
Qed.

Section Tape.
Variable tape : list (op address).
Variable params : list fixed.
Variable theta : list R.
Hypothesis theta_in : Forall2 (contains bits) params theta.
(** Of which there are values. *)
Variable thin : list (op address).
Hypothesis thin_is : is_thinned thin tape.

Definition lift1 (f : fixed -> option fixed) (a : option fixed) : option fixed := match a with Some a => f a | None => None end.
Definition lift2 (f : fixed -> fixed -> option fixed) (a b : option fixed) : option fixed := lift1 (fun a => lift1 (f a) b) a.
Definition fixed_op (coords : list fixed) (o : op (option fixed)) : option fixed :=
  match o with
  | Coord k => Some (nth k coords zero)
  | Param j => Some (nth j params zero)
  | Integer n => Some (Fixed.integer bits n)
  | Add a b => lift2 (fun a b => Some (add a b)) a b
  | Sub a b => lift2 (fun a b => Some (sub a b)) a b
  | Neg a => lift1 (fun a => Some (neg a)) a
  | Mul a b => lift2 (fun a b => Some (mul bits a b)) a b
  | Div a b => lift2 (fun a b => option_map (mul bits a) (recip bits b)) a b
  | Sqr a => lift1 (fun a => Some (sqr bits a)) a
  | Sqrt a => lift1 (Fixed.root bits) a
  | Elbow _ _ _ _ => None
  end.

Definition entry_at (i : nat) : formula := nth i (formulas tape) (integer 0).
Definition evaluate_at (q : list (fixed * fixed)) : list (option fixed) :=
  run (option fixed) None (fixed_op (map fst q ++ map snd q)) thin.

Definition has_value (ps : list (R * R)) (a : option fixed) (f : formula) : Prop :=
  match a with Some a => contains bits a (at_pairs theta f ps) | None => True end.

Lemma nth_contains : forall a x, Forall2 (contains bits) a x -> forall i, contains bits (nth i a zero) (nth i x 0).
Proof. induction 1 as [| a x l y h hs IH]; intros [| i]; cbn [nth]; auto using zero_sound. Qed.

Lemma evaluate_at_sound : forall q ps, Forall2 in_pair q ps -> forall i, has_value ps (nth i (evaluate_at q) None) (entry_at i).
Proof.
  intros q ps h.
  assert (C : Forall2 (contains bits) (map fst q ++ map snd q) (point_of ps)).
  { unfold point_of. apply Forall2_app; eapply map_related; try exact h; intros ? ? [? ?]; assumption. }
  apply (nth_related _ _ None (integer 0) (has_value ps)); [exact I |].
  apply (run_thinned (option fixed) formula None (integer 0) _ F (has_value ps)); [exact I | intro; exact I | reflexivity | | exact thin_is].
  intros o f g H. unfold has_value, at_pairs in *. destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | ? a b e];
    cbn [map_op fixed_op value real_op];
    try (pose proof (H a) as A; destruct (f a) as [ia |]; cbn [lift1 lift2]; [| exact I]);
    try (pose proof (H b) as B; destruct (f b) as [ib |]; cbn [lift1 lift2]; [| exact I]);
    auto using nth_contains, Fixed.integer_sound, add_sound, sub_sound, neg_sound, mul_sound, sqr_sound.
  - destruct (recip bits ib) as [r |] eqn:e; cbn [option_map]; [| exact I]. apply mul_sound; [exact A | apply (recip_sound bits ib _ _ e B)].
  - destruct (Fixed.root bits ia) as [r |] eqn:e; [| exact I]. apply (root_sound bits ia r _ e A).
Qed.

(** ** Formulas at all control points: a branch for each node of a coordinate that matters *)

Inductive tensor := Constant (a : option fixed) | Same (t : tensor) | Each (low middle high : tensor).
Definition pick {A : Type} (j : which) (l m h : A) : A := match j with Low => l | Middle => m | High => h end.
Definition branch (j : which) (t : tensor) : tensor := match t with Constant _ => t | Same t => t | Each l m h => pick j l m h end.
Definition last_value (t : tensor) : option fixed := match t with Constant a => a | _ => None end.
Fixpoint value_at (t : tensor) (p : list which) : option fixed := match p with [] => last_value t | j :: p' => value_at (branch j t) p' end.

Fixpoint tensor1 (f : option fixed -> option fixed) (t : tensor) : tensor :=
  match t with Constant a => Constant (f a) | Same t => Same (tensor1 f t) | Each l m h => Each (tensor1 f l) (tensor1 f m) (tensor1 f h) end.
Fixpoint tensor2 (f : option fixed -> option fixed -> option fixed) (s t : tensor) : tensor :=
  match s with
  | Constant a => tensor1 (f a) t
  | Same s' => match t with
      | Constant b => Same (tensor1 (fun a => f a b) s')
      | Same t' => Same (tensor2 f s' t')
      | Each l m h => Each (tensor2 f s' l) (tensor2 f s' m) (tensor2 f s' h)
      end
  | Each l m h => match t with
      | Constant b => let g := tensor1 (fun a => f a b) in Each (g l) (g m) (g h)
      | Same t' => Each (tensor2 f l t') (tensor2 f m t') (tensor2 f h t')
      | Each l' m' h' => Each (tensor2 f l l') (tensor2 f m m') (tensor2 f h h')
      end
  end.

Lemma value_tensor1 : forall f p t, f None = None -> value_at (tensor1 f t) p = f (value_at t p).
Proof.
  intros f p t n. revert t. induction p as [| j p IH]; intros [a | t | l m h]; cbn [value_at tensor1 last_value branch]; auto.
  - exact (IH (Constant a)).
  - destruct j; apply IH.
Qed.
Lemma value_constant : forall a p, value_at (Constant a) p = a.
Proof. intros a p. induction p; [reflexivity | exact IHp]. Qed.
Lemma value_tensor2 : forall f p s t, (forall a, f a None = None) -> (forall b, f None b = None) ->
  value_at (tensor2 f s t) p = f (value_at s p) (value_at t p).
Proof.
  intros f p s t n n'. revert s t. induction p as [| j p IH]; intros s t.
  - destruct s as [a | s | l m h], t as [b | t | l' m' h']; cbn [value_at tensor2 tensor1 last_value]; auto; rewrite ?n, ?n'; reflexivity.
  - cbn [value_at]. destruct s as [a | s | l m h].
    + cbn [tensor2 branch]. rewrite value_constant.
      replace (branch j (tensor1 (f a) t)) with (tensor1 (f a) (branch j t)) by (destruct t, j; reflexivity). apply value_tensor1, n.
    + destruct t as [b | t | l' m' h']; cbn [tensor2 branch]; [rewrite value_constant; apply (value_tensor1 (fun a => f a b)), n' | apply IH | destruct j; apply IH].
    + destruct t as [b | t | l' m' h']; cbn [tensor2 branch]; [| destruct j; apply IH | destruct j; apply IH].
      rewrite value_constant. destruct j; apply (value_tensor1 (fun a => f a b)), n'.
Qed.

Fixpoint axes (f : fixed * fixed -> fixed) (cell : list fixed) : list tensor :=
  match cell with
  | [] => []
  | a :: cell' => let at_ j := Constant (Some (f (node a j))) in Each (at_ Low) (at_ Middle) (at_ High) :: map Same (axes f cell')
  end.
Lemma value_axes : forall f cell p, length p = length cell ->
  map (fun t => value_at t p) (axes f cell) = map Some (map f (points cell p)).
Proof.
  intro f. induction cell as [| a cell IH]; intros [| j p] l; try discriminate; [reflexivity |]. cbn [axes map points].
  f_equal; [cbn [value_at branch]; destruct j; apply value_constant |]. rewrite map_map. apply IH. cbn in l. congruence.
Qed.

Definition tensor_op (coords : list tensor) (o : op tensor) : tensor :=
  match o with
  | Coord k => nth k coords (Constant (Some zero))
  | Param j => Constant (Some (nth j params zero))
  | Integer n => Constant (Some (Fixed.integer bits n))
  | Add a b => tensor2 (lift2 (fun a b => Some (add a b))) a b
  | Sub a b => tensor2 (lift2 (fun a b => Some (sub a b))) a b
  | Neg a => tensor1 (lift1 (fun a => Some (neg a))) a
  | Mul a b => tensor2 (lift2 (fun a b => Some (mul bits a b))) a b
  | Div a b => tensor2 (lift2 (fun a b => option_map (mul bits a) (recip bits b))) a b
  | Sqr a => tensor1 (lift1 (fun a => Some (sqr bits a))) a
  | Sqrt a => tensor1 (lift1 (Fixed.root bits)) a
  | Elbow _ _ _ _ => Constant None
  end.
Definition tensors (cell : list fixed) : list tensor :=
  run tensor (Constant None) (tensor_op (axes fst cell ++ axes snd cell)) thin.

Theorem tensors_value : forall cell p, length p = length cell ->
  forall i, value_at (nth i (tensors cell) (Constant None)) p = nth i (evaluate_at (points cell p)) None.
Proof.
  intros cell p l. unfold tensors, evaluate_at. set (q := points cell p).
  assert (C : map (fun t => value_at t p) (axes fst cell ++ axes snd cell) = map Some (map fst q ++ map snd q))
    by (rewrite map_app, !value_axes, map_app by exact l; reflexivity).
  apply (nth_related _ _ (Constant None) None (fun t a => value_at t p = a)); [apply value_constant |].
  apply (run_related tensor (option fixed) (Constant None) None _ _ (fun t a => value_at t p = a)); [apply value_constant |].
  assert (N1 : forall g a, lift2 g a None = None) by (intros g []; reflexivity).
  intros o f g H. destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | ? a b e]; cbn [map_op tensor_op fixed_op];
    try apply value_constant; try (rewrite value_tensor2, (H a), (H b) by (try apply N1; reflexivity); reflexivity);
    try (rewrite value_tensor1, (H a) by reflexivity; reflexivity).
  rewrite <- (map_nth Some), <- C. pose proof (map_nth (fun t => value_at t p) (axes fst cell ++ axes snd cell) (Constant (Some zero)) k) as M.
  cbn beta in M. rewrite value_constant in M. symmetry. exact M.
Qed.

(** ** Tests: sigma_min^2 > k w, sigma_max^2 < k w, f >= 0 *)

Fixpoint all_known (a : list (option fixed)) : option (list fixed) :=
  match a with
  | [] => Some []
  | x :: a' => match x, all_known a' with Some x, Some l => Some (x :: l) | _, _ => None end
  end.
(** Every D_i is positive. *)
Fixpoint known_rows (r : rows (option fixed)) : option (rows fixed) :=
  match r with
  | [] => Some []
  | (a, d) :: r' =>
      match all_known a, d, known_rows r' with
      | Some a, Some d, Some rest => if (0 <? lo d)%Z then Some ((a, d) :: rest) else None
      | _, _, _ => None
      end
  end.

(** A multiple, [n] over [2^places], of a formula that is not negative, or none: the S-procedure. *)
Definition multiple : Type := option (nat * Z * N).

(** What a test needs: rows, a weight or what is not to be negative, and what a multiple is of. *)
Record sample (A : Type) := Sample { s_rows : rows A; s_weight : A; s_less : option (A * Z * N) }.
Arguments Sample {A}. Arguments s_rows {A}. Arguments s_weight {A}. Arguments s_less {A}.
Definition map_sample {A B : Type} (f : A -> B) (s : sample A) : sample B :=
  Sample (map_rows f (s_rows s)) (f (s_weight s)) (option_map (fun l => (f (fst (fst l)), snd (fst l), snd l)) (s_less s)).
Definition sample_of (r : rows nat) (w : nat) (l : multiple) : sample nat := Sample r w l.

Lemma map_sample_map : forall (A B C : Type) (f : A -> B) (g : B -> C) s, map_sample g (map_sample f s) = map_sample (fun a => g (f a)) s.
Proof.
  intros A B C f g [r w l]. unfold map_sample. cbn [s_rows s_weight s_less]. f_equal.
  - unfold map_rows. rewrite map_map. apply map_ext. intros [a d]. cbn [fst snd]. rewrite map_map. reflexivity.
  - destruct l as [[[x n] places] |]; reflexivity.
Qed.
Lemma map_sample_ext : forall (A B : Type) (f g : A -> B) s, (forall a, f a = g a) -> map_sample f s = map_sample g s.
Proof.
  intros A B f g [r w l] e. unfold map_sample. cbn [s_rows s_weight s_less]. rewrite e. f_equal.
  - unfold map_rows. apply map_ext. intros [a d]. cbn [fst snd]. rewrite e. f_equal. apply map_ext, e.
  - destruct l as [[[x n] places] |]; cbn; rewrite ?e; reflexivity.
Qed.

(** At all control points, at ends alone of the first [e] coordinates, with a number of each point: the sum of the [mus], one a coordinate, times -1, 0 or 1
    as its node is the first, the middle or the last. [K]: samples of whatever kind. *)
Section Everywhere.
Context {K : Type -> Type}.
Variable map_K : forall A B, (A -> B) -> K A -> K B.
Arguments map_K {A B}.
Hypothesis map_K_map : forall A B C (f : A -> B) (g : B -> C) s, map_K g (map_K f s) = map_K (fun a => g (f a)) s.

Fixpoint everywhere_by (good : Z -> K (option fixed) -> bool) (e : nat) (mus : list Z) (sum : Z) (s : K tensor) : bool :=
  match mus with
  | [] => good sum (map_K last_value s)
  | mu :: rest =>
      let at_ j sum := everywhere_by good (pred e) rest sum (map_K (branch j) s) in
      if at_ Low (sum - mu)%Z then if at_ High (sum + mu)%Z then match e with O => at_ Middle sum | S _ => true end else false else false
  end.
Definition everywhere (e m : nat) (good : K (option fixed) -> bool) : K tensor -> bool := everywhere_by (fun _ => good) e (repeat 0%Z m) 0.

Lemma everywhere_by_sound : forall good mus e sum s, everywhere_by good e mus sum s = true ->
  forall p, length p = length mus -> ends_first e p -> exists mu, good mu (map_K (fun t => value_at t p) s) = true.
Proof.
  intro good. induction mus as [| mu mus IH]; intros e sum s h [| j p] l i; try discriminate; [exists sum; exact h |]. cbn [everywhere_by] in h. cbv zeta in h.
  destruct (everywhere_by _ _ _ (sum - mu) _) eqn:lw; [| discriminate]. destruct (everywhere_by _ _ _ (sum + mu) _) eqn:hg; [| discriminate].
  assert (E : exists sum, everywhere_by good (pred e) mus sum (map_K (branch j) s) = true)
    by (destruct j; [eexists; exact lw | destruct e; [eexists; exact h | exfalso; exact (proj1 i eq_refl)] | eexists; exact hg]).
  destruct E as [q E]. destruct (IH _ _ _ E p ltac:(cbn in l; congruence)) as [z G]; [destruct e; [destruct p; exact I | exact (proj2 i)] |].
  exists z. rewrite <- G, map_K_map. reflexivity.
Qed.
Lemma everywhere_sound : forall good m e s, everywhere e m good s = true ->
  forall p, length p = m -> ends_first e p -> good (map_K (fun t => value_at t p) s) = true.
Proof.
  intros good m e s h p l i. destruct (everywhere_by_sound _ _ _ _ _ h p ltac:(rewrite repeat_length; exact l) i) as [_ G]. exact G.
Qed.
End Everywhere.

Definition known_multiple (l : option (option fixed * Z * N)) : option fixed :=
  match l with None => Some zero | Some (g, n, places) => option_map (Arithmetic.dyadic n places) g end.

Definition lower_at (n : nat) (places : N) (Y : list (list Z)) (k : fixed) (s : sample (option fixed)) : bool :=
  match known_rows (s_rows s), s_weight s, known_multiple (s_less s) with
  | Some rows, Some w, Some t => is_definite bits n (lower_triangle places Y rows (repeat [sub (neg (mul bits k w)) t] n))
  | _, _, _ => false
  end.
(** Full rank: the same with D = 0 and k = 0. *)
Definition rank_at (n : nat) (places : N) (Y : list (list Z)) (s : sample (option fixed)) : bool :=
  match known_rows (s_rows s), known_multiple (s_less s) with
  | Some rows, Some t => is_definite bits n (lower_triangle places Y (map (fun p => (fst p, zero)) rows) (repeat [sub zero t] n))
  | _, _ => false
  end.
Definition upper_at (n : nat) (k : fixed) (s : sample (option fixed)) : bool :=
  match known_rows (s_rows s), s_weight s, known_multiple (s_less s) with
  | Some rows, Some w, Some t => are_below bits n rows (sub (mul bits k w) t)
  | _, _, _ => false
  end.
(** mu = first w + sum, and both bounds: w sigma_min^2 > mu, w sigma_max^2 < c^2 mu. *)
Definition conditioned_at (n : nat) (c2 : fixed) (places : N) (Y : list (list Z)) (first sum : Z) (s : sample (option fixed)) : bool :=
  match known_rows (s_rows s), s_weight s, known_multiple (s_less s) with
  | Some rows, Some w, Some t =>
      let number k := Arithmetic.dyadic k places (Fixed.integer bits 1) in
      let mu := add (mul bits (number first) w) (number sum) in
      (0 <? lo mu)%Z && is_definite bits n (lower_triangle places Y rows (repeat [sub (neg mu) t] n)) &&
      match upper_triangle bits rows (repeat [sub (mul bits c2 mu) t] n) with Some t => is_definite bits n t | None => false end
  | _, _, _ => false
  end.
(** As many rows of A, and of Y, as coordinates. *)
Definition solve_at (n i : nat) (places : N) (Y : list (list Z)) (k : fixed) (s : sample (option fixed)) : bool :=
  match known_rows (s_rows s), s_weight s, known_multiple (s_less s) with
  | Some rows, Some w, Some t => Nat.eqb (length rows) n && Nat.eqb (length Y) n &&
      is_definite bits n (triangle_add (solve_diagonal i k t rows) (gram places (solve_pairs places Y w rows)))
  | _, _, _ => false
  end.
Definition sign_at (s : sample (option fixed)) : bool :=
  match s_weight s, known_multiple (s_less s) with Some a, Some t => (0 <=? lo (sub a t))%Z | _, _ => false end.

(** Formulas of the tape are affine in each pair. *)
Variable m : nat.
Definition all_places (r : rows nat) : list nat := flat_map (fun p => fst p ++ [snd p]) r.
Definition affine_in (fs : list formula) (i : nat) : bool := let f := nth i fs (integer 0) in forallb (fun k => is_affine m k f) (seq 0 m).
Definition is_affine_at (i : nat) : bool := affine_in (formulas tape) i.
Local Notation at_ ps i := (at_pairs theta (entry_at i) ps).

Lemma entry_affine : forall i, is_affine_at i = true -> affine_there m (fun ps => at_ ps i).
Proof.
  intros i h before after u v w p q r l s. unfold is_affine_at, affine_in in h. cbv zeta in h. rewrite forallb_forall in h.
  assert (E : m = S (length before + length after)) by (rewrite <- l, app_length; cbn [length]; lia).
  specialize (h (length before) ltac:(apply in_seq; lia)). rewrite E in h. apply affine_value; assumption.
Qed.

Definition less_at (ps : list (R * R)) (l : multiple) : R :=
  match l with None => 0 | Some (g, n, places) => IZR n / IZR (2 ^ Z.of_N places) * at_ ps g end.
Definition is_affine_multiple (l : multiple) : bool := match l with None => true | Some (g, _, _) => is_affine_at g end.

Lemma multiple_affine : forall l, is_affine_multiple l = true -> affine_there m (fun ps => less_at ps l).
Proof.
  intros [[[g n] places] |] h before after u v w p q r e s; cbn [less_at].
  - rewrite (entry_affine g h before after u v w p q r e s). ring.
  - ring.
Qed.

Local Notation look q := (fun i => nth i (evaluate_at q) None).
Lemma multiple_sound : forall q ps r w l t, Forall2 in_pair q ps ->
  known_multiple (s_less (map_sample (look q) (sample_of r w l))) = Some t -> contains bits t (less_at ps l).
Proof.
  intros q ps r w [[[g n] places] |] t h e; cbn [known_multiple less_at map_sample sample_of s_less option_map fst snd] in *; [| injection e as <-; apply zero_sound].
  pose proof (evaluate_at_sound q ps h g) as V. destruct (nth g _ None) as [a |]; [| discriminate]. injection e as <-. apply Arithmetic.dyadic_sound, V.
Qed.

Lemma rows_affine : forall r weights x, forallb is_affine_at (all_places r) = true ->
  affine_there m (fun ps => form weights (map_rows (fun i => at_ ps i) r) x).
Proof.
  intros r weights x h before after u v w p q s l e. revert weights h.
  assert (D : forall a x, forallb is_affine_at a = true ->
    dot (map (fun i => at_ (before ++ mean u v w p q s :: after) i) a) x = u * dot (map (fun i => at_ (before ++ p :: after) i) a) x
      + v * dot (map (fun i => at_ (before ++ q :: after) i) a) x + w * dot (map (fun i => at_ (before ++ s :: after) i) a) x).
  { induction a as [| i a IH]; intros [| y z] h; cbn [map dot]; try ring. cbn [forallb] in h. apply andb_true_iff in h as [h1 h2].
    rewrite (IH z h2), (entry_affine i h1 before after u v w p q s l e). ring. }
  induction r as [| [a d] r IH]; intros [| [y z] weights] h; try (cbn [map_rows map form]; ring). rewrite !map_rows_cons. cbn [form].
  cbn [all_places flat_map fst snd] in h. rewrite forallb_app in h. apply andb_true_iff in h as [h h3]. rewrite forallb_app in h.
  apply andb_true_iff in h as [h1 h2]. cbn [forallb] in h2. apply andb_true_iff in h2 as [h2 _].
  rewrite (D a x h1), (entry_affine d h2 before after u v w p q s l e), (IH weights h3). ring.
Qed.

Lemma all_known_sound : forall q ps a s, Forall2 in_pair q ps -> all_known (map (look q) a) = Some s -> Forall2 (contains bits) s (map (fun i => at_ ps i) a).
Proof.
  intros q ps a s h. revert s. induction a as [| i a IH]; intros s e; cbn [all_known map] in *; [injection e as <-; constructor |].
  pose proof (evaluate_at_sound q ps h i) as V. destruct (nth i _ None) as [b |]; [| discriminate].
  destruct (all_known _) as [l |]; [| discriminate]. injection e as <-. constructor; auto.
Qed.

Lemma known_rows_sound : forall q ps r s, Forall2 in_pair q ps -> known_rows (map_rows (look q) r) = Some s ->
  rows_rel (contains bits) s (map_rows (fun i => at_ ps i) r) /\ positive_D (map_rows (fun i => at_ ps i) r).
Proof.
  intros q ps r s h. revert s. induction r as [| [a d] r IH]; intros s e; [injection e as <-; split; constructor |]. rewrite map_rows_cons in e. cbn [known_rows] in e.
  destruct (all_known _) as [b |] eqn:ea; [| discriminate]. pose proof (evaluate_at_sound q ps h d) as V.
  destruct (nth d _ None) as [c |]; [| discriminate]. destruct (known_rows _) as [rest |]; [| discriminate].
  destruct (0 <? lo c)%Z eqn:p; [| discriminate]. injection e as <-. apply Z.ltb_lt in p. destruct (IH rest eq_refl) as [I1 I2].
  rewrite map_rows_cons. split; constructor; auto.
  - split; [exact (all_known_sound q ps a b h ea) | exact V].
  - exact (contains_positive bits _ _ p V).
Qed.

(** ** What the tests show of a cell *)

Section OnCell.
Variable cell : list fixed.
Variable x : list R.
Hypothesis x_in : Forall2 (contains bits) cell x.
Hypothesis dimension : length cell = m.
Local Notation here i := (at_pairs theta (entry_at i) (parabola x)).

Definition at_controls (e : nat) (good : sample (option fixed) -> bool) (s : sample nat) : Prop :=
  forall p, length p = m -> ends_first e p -> good (map_sample (look (points cell p)) s) = true.

Lemma everywhere_shown : forall e good s, everywhere (@map_sample) e m good (map_sample (fun i => nth i (tensors cell) (Constant None)) s) = true -> at_controls e good s.
Proof.
  intros e good s h p l i. pose proof (everywhere_sound _ map_sample_map good m e _ h p l i) as K. rewrite map_sample_map in K. rewrite <- K. f_equal.
  apply map_sample_ext. intro j. symmetry. apply tensors_value. congruence.
Qed.

Lemma x_length : length x = m.
Proof. rewrite <- (related_length _ _ _ _ _ x_in). exact dimension. Qed.

Lemma decide_weakly : forall good, is_convex good -> forall g, affine_there m g ->
  (forall p ps, length p = m -> Forall2 in_pair (points cell p) ps -> good (g ps)) -> good (g (parabola x)).
Proof.
  intros good cv g ha H. apply (controls_decide good cv m g ha (parabola x) (map real_nodes cell)).
  - unfold parabola. rewrite map_length. exact x_length.
  - unfold parabola. clear - x_in. induction x_in; cbn [map]; constructor; auto. apply real_nodes_mean; assumption.
  - intros qs hq. destruct (points_in cell O qs) as [p [lp [_ hp]]]; [cbn [firstn skipn map app]; rewrite map_map; exact hq |].
    exact (H p qs ltac:(congruence) hp).
Qed.

Lemma decide : forall g e, affine_there m g -> falls e x g ->
  (forall p ps, length p = m -> ends_first e p -> Forall2 in_pair (points cell p) ps -> 0 < g ps) -> 0 < g (parabola x).
Proof.
  intros g e ha fall H. apply (ends_decide m g ha x e x_length fall (map (fun a => (real_nodes a, real_ends a)) cell)).
  - clear - x_in. induction x_in; cbn [map]; constructor; auto. split; [apply real_nodes_mean | apply real_ends_mean]; assumption.
  - intros qs hq. destruct (points_in cell e qs hq) as [p [lp [ep hp]]]. exact (H p qs ltac:(congruence) ep hp).
Qed.
Lemma falls_none : forall g, falls O x g.
Proof. intros g before front z after s _ _ l. lia. Qed.

Lemma regular_here : forall r w l, forallb is_affine_at (all_places r) = true ->
  at_controls O (fun s => match known_rows (s_rows s) with Some _ => true | None => false end) (sample_of r w l) -> positive_D (map_rows (fun i => here i) r).
Proof.
  intros r w l ha H. assert (K : forall a d, In (a, d) r -> 0 < here d).
  { intros a d i. apply (decide_weakly (fun y => 0 < y) positive_convex (fun ps => at_ ps d)).
    - apply entry_affine. rewrite forallb_forall in ha. apply ha, in_flat_map. exists (a, d). split; [exact i |]. apply in_or_app. right. left. reflexivity.
    - intros p ps lp rq. specialize (H p lp I). cbn [map_sample sample_of s_rows] in H. destruct (known_rows _) as [s |] eqn:e; [| discriminate].
      destruct (known_rows_sound _ ps r s rq e) as [_ P]. unfold positive_D, map_rows in P.
      rewrite Forall_map, Forall_forall in P. exact (P (a, d) i). }
  unfold positive_D, map_rows. rewrite Forall_map. apply Forall_forall. intros [a d] i. exact (K a d i).
Qed.

Lemma weight_affine : forall r weights w c l d v, forallb is_affine_at (w :: all_places r) = true -> is_affine_multiple l = true ->
  affine_there m (fun ps => form weights (map_rows (fun i => at_ ps i) r) v + c * at_ ps w + d * less_at ps l).
Proof.
  intros r weights w c l d v h k before after a b e p q s len su. cbn [forallb] in h. apply andb_true_iff in h as [h1 h2].
  rewrite (rows_affine r weights v h2 before after a b e p q s len su), (entry_affine w h1 before after a b e p q s len su),
    (multiple_affine l k before after a b e p q s len su). ring.
Qed.

(** ** Ends alone *)

(** Squares of the first [e] coordinates are in D alone, with the factor w. *)
Definition eased_in (fs : list formula) (e : nat) (r : rows nat) (w : nat) (l : multiple) : bool :=
  let at_ i := nth i fs (integer 0) in
  let weight := at_ w in
  forallb (fun k => is_free m k weight
    && forallb (fun p => forallb (fun i => is_without (m + k) (at_ i)) (fst p) && rises weight (m + k) (at_ (snd p))) r
    && match l with Some (g, _, _) => is_without (m + k) (at_ g) | None => true end) (seq 0 e).
Definition is_eased (e : nat) (r : rows nat) (w : nat) (l : multiple) : bool := eased_in (formulas tape) e r w l.

Lemma weighted_falls : forall e r w l weights c d v, is_eased e r w l = true -> 0 <= here w -> Forall (fun q => snd q <= 0) weights ->
  falls e x (fun ps => form weights (map_rows (fun i => at_ ps i) r) v + c * at_ ps w + d * less_at ps l).
Proof.
  intros e r w l weights c d v h w0 hw before front z after s ex lb le zs. unfold is_eased, eased_in in h. cbv zeta in h. fold (entry_at w) in h. rewrite forallb_forall in h.
  assert (E : m = S (length before + length after)) by (rewrite <- x_length, ex, app_length, lb; cbn [length]; lia).
  assert (Lp : length (parabola after) = length after) by apply map_length.
  assert (hk := h (length before) ltac:(apply in_seq; lia)). apply andb_true_iff in hk as [hk hl]. apply andb_true_iff in hk as [fw hr].
  assert (W : forall i, is_without (m + length before) (entry_at i) = true -> at_ (before ++ (z, s) :: parabola after) i = at_ (before ++ (z, z ^ 2) :: parabola after) i).
  { intros i q. apply without_value. rewrite Lp, <- E. exact q. }
  assert (WW : at_ (before ++ (z, s) :: parabola after) w = at_ (before ++ (z, z ^ 2) :: parabola after) w).
  { apply free_value. rewrite Lp, <- E. exact fw. }
  assert (W0 : 0 <= at_ (before ++ (z, z ^ 2) :: parabola after) w).
  { replace (at_ (before ++ (z, z ^ 2) :: parabola after) w) with (here w); [exact w0 |]. rewrite ex. unfold parabola. rewrite map_app. cbn [map]. fold (parabola after).
    apply (prefix_value theta (entry_at w) m); [rewrite map_length; congruence | rewrite app_length, map_length; cbn [length]; rewrite Lp; lia |].
    intros k i. rewrite map_length in i. specialize (h k ltac:(apply in_seq; lia)). apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [h _]. exact h. }
  assert (LL : less_at (before ++ (z, s) :: parabola after) l = less_at (before ++ (z, z ^ 2) :: parabola after) l).
  { destruct l as [[[g n] places] |]; cbn [less_at]; [rewrite (W g hl); reflexivity | reflexivity]. }
  rewrite WW, LL. apply Rplus_le_compat_r, Rplus_le_compat_r. clear h LL WW. revert r hr. induction hw as [| [y q] ws q0 hw IH]; intros [| [a b] r] hr; try apply Rle_refl. rewrite !map_rows_cons. cbn [form].
  cbn [forallb fst snd] in hr. apply andb_true_iff in hr as [hr1 hr]. apply andb_true_iff in hr1 as [ha hb]. specialize (IH r hr).
  assert (A : map (fun i => at_ (before ++ (z, s) :: parabola after) i) a = map (fun i => at_ (before ++ (z, z ^ 2) :: parabola after) i) a).
  { apply map_ext_in. intros i ii. apply W. rewrite forallb_forall in ha. apply ha, ii. }
  assert (B : at_ (before ++ (z, z ^ 2) :: parabola after) b <= at_ (before ++ (z, s) :: parabola after) b).
  { apply (rises_value theta before (parabola after) (entry_at w)); [rewrite Lp, <- E; exact hb | exact W0 | exact zs]. }
  rewrite A. cbn [snd] in q0. pose proof (Rmult_le_compat_neg_l q _ _ q0 B). lra.
Qed.

(** A strut of length zero has a row of zeros. *)
Definition grounded (r : rows R) : Prop := Forall (fun p => 0 <= snd p /\ (snd p = 0 -> forall v, dot (fst p) v = 0)) r.

Lemma orthogonal_form : forall places Y r v, Forall (fun y => dot y v = 0) (firstn (length r) (map (map (Y_value places)) Y)) -> form (lower_weights places Y v) r v = 0.
Proof.
  intros places. induction Y as [| y Y IH]; intros [| [a d] r] v h; try reflexivity. cbn [map length firstn] in h. inversion h as [| ? ? h1 h2]; subst.
  cbn [lower_weights map form]. fold (lower_weights places Y v). rewrite h1, (IH r v h2). ring.
Qed.
Lemma orthogonal_here : forall places Y r, grounded r -> ~ positive_D r -> exists L, (length L < length r)%nat /\
  forall v, Forall (fun y => dot y v = 0) L -> form (lower_weights places Y v) r v = 0 /\ form (lower_weights places Y v) (map (fun p => (fst p, 0)) r) v = 0.
Proof.
  intros places Y r g. revert Y. induction g as [| [a d] r [d0 hd] g IH]; intros Y n; [destruct n; constructor |]. cbn [fst snd] in *.
  destruct Y as [| y Y]; [exists []; split; [cbn; lia | intros; split; reflexivity] |]. destruct (Rle_lt_or_eq_dec 0 d d0) as [p | e].
  - destruct (IH Y) as [L [l h]]; [intro q; apply n; constructor; assumption |]. exists (map (Y_value places) y :: L). split; [cbn [length]; lia |].
    intros v hv. inversion hv as [| ? ? h1 h2]; subst. destruct (h v h2) as [k1 k2]. cbn [lower_weights map form fst]. fold (lower_weights places Y v). rewrite h1, k1, k2. split; ring.
  - exists (firstn (length r) (map (map (Y_value places)) Y)). split; [cbn [length]; pose proof (firstn_le_length (length r) (map (map (Y_value places)) Y)); lia |].
    intros v hv. cbn [lower_weights map form fst]. fold (lower_weights places Y v). rewrite (hd (eq_sym e)), <- e, (orthogonal_form places Y r v hv).
    rewrite (orthogonal_form places Y (map (fun p => (fst p, 0)) r) v) by (rewrite map_length; exact hv). split; ring.
Qed.

(** Where ends alone are looked at: as many rows as coordinates. *)
Definition ends_suffice (e n : nat) (r : rows nat) (w : nat) (l : multiple) : Prop :=
  e = O \/ is_eased e r w l = true /\ length r = n /\ grounded (map_rows (fun i => here i) r) /\ 0 < here w.

Lemma regular_by_form : forall places Y r n, length r = n -> grounded (map_rows (fun i => here i) r) ->
  (forall v, length v = n -> nonzero v -> 0 < form (lower_weights places Y v) (map_rows (fun i => here i) r) v \/
    0 < form (lower_weights places Y v) (map (fun p => (fst p, 0)) (map_rows (fun i => here i) r)) v) ->
  positive_D (map_rows (fun i => here i) r).
Proof.
  intros places Y r n lr g H. set (R := map_rows (fun i => here i) r) in *. assert (LR : length R = n) by (unfold R, map_rows; rewrite map_length; exact lr).
  destruct (Forall_dec (fun p : list Rdefinitions.R * Rdefinitions.R => 0 < snd p) (fun p => Rlt_dec 0 (snd p)) R) as [p | p]; [exact p |]. exfalso.
  destruct (orthogonal_here places Y R g p) as [L [l h]]. destruct (orthogonal_exists n L ltac:(lia)) as [v [lv [nv hv]]].
  destruct (h v hv) as [z1 z2]. destruct (H v lv nv); lra.
Qed.

Lemma falls_suffices : forall e n r w l weights c d v, ends_suffice e n r w l -> Forall (fun q => snd q <= 0) weights ->
  falls e x (fun ps => form weights (map_rows (fun i => at_ ps i) r) v + c * at_ ps w + d * less_at ps l).
Proof.
  intros e n r w l weights c d v [-> | [h [_ [_ w0]]]] hw; [apply falls_none |]. apply weighted_falls; [exact h | lra | exact hw].
Qed.

(** The multiple is of what is not negative here. *)
Variable l : multiple.
Hypothesis l_affine : is_affine_multiple l = true.
Hypothesis l_nonneg : 0 <= less_at (parabola x) l.

Lemma known_everywhere : forall e good r w, at_controls e good (sample_of r w l) ->
  (forall s, good s = true -> exists rows, known_rows (s_rows s) = Some rows) ->
  at_controls e (fun s => match known_rows (s_rows s) with Some _ => true | None => false end) (sample_of r w l).
Proof. intros e good r w H K p lp ep. destruct (K _ (H p lp ep)) as [rows ->]. reflexivity. Qed.

Theorem lower_shown : forall e n places Y r w kappa2 k v, forallb is_affine_at (w :: all_places r) = true -> ends_suffice e n r w l ->
  at_controls e (lower_at n places Y kappa2) (sample_of r w l) ->
  contains bits kappa2 k -> 0 <= k -> length v = n -> nonzero v ->
  positive_D (map_rows (fun i => here i) r) /\ k * here w * dot v v < energy (map_rows (fun i => here i) r) v.
Proof.
  intros e n places Y r w kappa2 k v ha he H hk k0 lv nz. assert (ha' := ha). cbn [forallb] in ha'. apply andb_true_iff in ha' as [_ hr].
  assert (T : forall v, length v = n -> nonzero v ->
    0 < form (lower_weights places Y v) (map_rows (fun i => here i) r) v + - (k * dot v v) * here w + - dot v v * less_at (parabola x) l).
  { clear v lv nz. intros v lv nz. apply (decide (fun ps => form (lower_weights places Y v) (map_rows (fun i => at_ ps i) r) v + - (k * dot v v) * at_ ps w + - dot v v * less_at ps l) e).
    - apply weight_affine; assumption.
    - apply (falls_suffices e n); [exact he |]. unfold lower_weights. rewrite Forall_map. apply Forall_forall. intros y _. cbn [snd].
      pose proof (pow2_ge_0 (dot (map (Y_value places) y) v)). lra.
    - intros p ps lp ep rq. specialize (H p lp ep). unfold lower_at in H. pose proof (evaluate_at_sound _ ps rq w) as W.
      destruct (known_rows _) as [s |] eqn:es; [| discriminate]. cbn [map_sample sample_of s_rows s_weight] in es, H.
      destruct (nth w (evaluate_at _) None) as [b |]; [| discriminate].
      match type of H with context [known_multiple ?u] => destruct (known_multiple u) as [t |] eqn:et; [| discriminate] end. pose proof (multiple_sound _ ps r w l t rq et) as L.
      destruct (known_rows_sound _ ps r s rq es) as [S _]. unfold is_definite in H.
      destruct (Nat.eqb_spec (length (lower_triangle places Y s (repeat [sub (neg (mul bits kappa2 b)) t] n))) n) as [q | q]; [| discriminate].
      destruct (lower_triangle_sound bits places Y s _ _ _ v S
        (diagonal_in bits _ _ n (sub_sound bits _ _ _ _ (neg_sound bits _ _ (mul_sound bits _ _ _ _ hk W)) L))) as [T [hT le]].
      pose proof (is_positive_definite_sound bits _ T H hT v) as Q. rewrite <- lv, quad_diagonal in le.
      rewrite (related_length _ _ _ _ _ hT) in q. specialize (Q ltac:(congruence) nz). lra. }
  assert (P : positive_D (map_rows (fun i => here i) r)).
  { destruct he as [-> | [_ [lr [g w0]]]].
    - apply (regular_here r w l hr), (known_everywhere O (lower_at n places Y kappa2) r w H). intros s h. unfold lower_at in h.
      destruct (known_rows _) as [rows |]; [exists rows; reflexivity | discriminate].
    - apply (regular_by_form places Y r n lr g). intros u lu nu. left. specialize (T u lu nu). unfold nonzero in nu.
      pose proof (Rmult_le_pos (k * dot u u) (here w) ltac:(apply Rmult_le_pos; lra) ltac:(lra)). pose proof (Rmult_le_pos (dot u u) _ ltac:(lra) l_nonneg). lra. }
  split; [exact P |]. apply Rlt_le_trans with (2 := lower_energy places Y _ v P). specialize (T v lv nz).
  assert (0 <= dot v v * less_at (parabola x) l) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l_nonneg]). lra.
Qed.

Lemma form_without_D : forall ws r v, form (map (fun p => (fst p, 0)) ws) r v = form ws (map (fun p => (fst p, 0)) r) v.
Proof. induction ws as [| [y z] ws IH]; intros [| [a d] r] v; try reflexivity. cbn [map form fst]. rewrite IH. ring. Qed.

(** What shows full rank, as a form; of chords that is all. *)
Lemma rank_form : forall e n places Y r w v, forallb is_affine_at (w :: all_places r) = true -> ends_suffice e n r w l ->
  at_controls e (rank_at n places Y) (sample_of r w l) -> length v = n -> nonzero v ->
  0 < form (lower_weights places Y v) (map (fun p => (fst p, 0)) (map_rows (fun i => here i) r)) v + - dot v v * less_at (parabola x) l.
Proof.
  intros e n places Y r w v ha he H lv nz. set (ws := map (fun p => (fst p, 0)) (lower_weights places Y v)). rewrite <- form_without_D. fold ws.
    enough (0 < form ws (map_rows (fun i => here i) r) v + 0 * here w + - dot v v * less_at (parabola x) l) by lra.
    apply (decide (fun ps => form ws (map_rows (fun i => at_ ps i) r) v + 0 * at_ ps w + - dot v v * less_at ps l) e).
    - apply weight_affine; assumption.
    - apply (falls_suffices e n); [exact he |]. unfold ws. rewrite Forall_map. apply Forall_forall. intros y _. apply Rle_refl.
    - intros p ps lp ep rq. specialize (H p lp ep). unfold rank_at in H. unfold ws. rewrite form_without_D.
      destruct (known_rows _) as [s |] eqn:es; [| discriminate]. cbn [map_sample sample_of s_rows] in es.
      match type of H with context [known_multiple ?u] => destruct (known_multiple u) as [t |] eqn:et; [| discriminate] end. pose proof (multiple_sound _ ps r w l t rq et) as L.
      destruct (known_rows_sound _ ps r s rq es) as [S _]. unfold is_definite in H.
      assert (S0 : rows_rel (contains bits) (map (fun p => (fst p, zero)) s) (map (fun p => (fst p, 0)) (map_rows (fun i => at_ ps i) r)))
        by (eapply map_related; [| exact S]; intros a b [k _]; split; [exact k | apply zero_sound]).
      destruct (Nat.eqb_spec (length (lower_triangle places Y (map (fun p => (fst p, zero)) s) (repeat [sub zero t] n))) n) as [q | q]; [| discriminate].
      destruct (lower_triangle_sound bits places Y _ _ _ _ v S0 (diagonal_in bits _ _ n (sub_sound bits _ _ _ _ (zero_sound bits) L))) as [T [hT le]].
      pose proof (is_positive_definite_sound bits _ T H hT v) as Q. rewrite <- lv, quad_diagonal in le.
      rewrite (related_length _ _ _ _ _ hT) in q. specialize (Q ltac:(congruence) nz). lra.
Qed.

Theorem chords_shown : forall n places Y r w v, forallb is_affine_at (w :: all_places r) = true ->
  at_controls O (rank_at n places Y) (sample_of r w l) -> length v = n -> nonzero v ->
  0 < form (lower_weights places Y v) (map (fun p => (fst p, 0)) (map_rows (fun i => here i) r)) v.
Proof.
  intros n places Y r w v ha H lv nz. pose proof (rank_form O n places Y r w v ha (or_introl eq_refl) H lv nz).
  assert (0 <= dot v v * less_at (parabola x) l) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l_nonneg]). lra.
Qed.

Theorem rank_shown : forall e n places Y r w v, forallb is_affine_at (w :: all_places r) = true -> ends_suffice e n r w l ->
  at_controls e (rank_at n places Y) (sample_of r w l) -> length v = n -> nonzero v ->
  positive_D (map_rows (fun i => here i) r) /\ 0 < energy (map_rows (fun i => here i) r) v.
Proof.
  intros e n places Y r w v ha he H lv nz. assert (ha' := ha). cbn [forallb] in ha'. apply andb_true_iff in ha' as [_ hr].
  assert (T := fun v => rank_form e n places Y r w v ha he H).
  assert (P : positive_D (map_rows (fun i => here i) r)).
  { destruct he as [-> | [_ [lr [g w0]]]].
    - apply (regular_here r w l hr), (known_everywhere O (rank_at n places Y) r w H). intros s h. unfold rank_at in h.
      destruct (known_rows _) as [rows |]; [exists rows; reflexivity | discriminate].
    - apply (regular_by_form places Y r n lr g). intros u lu nu. right. specialize (T u lu nu). unfold nonzero in nu. pose proof (Rmult_le_pos (dot u u) _ ltac:(lra) l_nonneg). lra. }
  split; [exact P |]. apply (rank_energy places Y _ v P). specialize (T v lv nz).
  assert (0 <= dot v v * less_at (parabola x) l) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l_nonneg]). lra.
Qed.

Theorem upper_shown : forall n r w k2 k v, forallb is_affine_at (w :: all_places r) = true ->
  at_controls O (upper_at n k2) (sample_of r w l) ->
  contains bits k2 k -> length v = n -> nonzero v ->
  positive_D (map_rows (fun i => here i) r) /\ energy (map_rows (fun i => here i) r) v < k * here w * dot v v.
Proof.
  intros n r w k2 k v ha H hk lv nz. assert (ha' := ha). cbn [forallb] in ha'. apply andb_true_iff in ha' as [_ hr].
  assert (P : positive_D (map_rows (fun i => here i) r)).
  { apply (regular_here r w l hr), (known_everywhere O (upper_at n k2) r w H). intros s h. unfold upper_at in h.
    destruct (known_rows _) as [rows |]; [exists rows; reflexivity | discriminate]. }
  split; [exact P |]. destruct (upper_energy _ v P) as [u E].
  assert (0 <= dot v v * less_at (parabola x) l) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l_nonneg]).
  enough (0 < form (upper_weights u) (map_rows (fun i => here i) r) v + k * dot v v * here w + - dot v v * less_at (parabola x) l) by lra.
  apply (decide (fun ps => form (upper_weights u) (map_rows (fun i => at_ ps i) r) v + k * dot v v * at_ ps w + - dot v v * less_at ps l) O).
  - apply weight_affine; assumption.
  - apply falls_none.
  - intros p ps lp ep rq. specialize (H p lp ep). unfold upper_at in H. pose proof (evaluate_at_sound _ ps rq w) as W.
    destruct (known_rows _) as [s |] eqn:es; [| discriminate]. cbn [map_sample sample_of s_rows s_weight] in es, H. destruct (nth w (evaluate_at _) None) as [b |]; [| discriminate].
    match type of H with context [known_multiple ?u] => destruct (known_multiple u) as [t |] eqn:et; [| discriminate] end. pose proof (multiple_sound _ ps r w l t rq et) as L.
    destruct (known_rows_sound _ ps r s rq es) as [S _].
    pose proof (are_below_sound bits n s _ _ _ v u H S (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ hk W) L) lv nz). lra.
Qed.

(** The number of each control point is that of both bounds, and so is no number of the two together. *)
Theorem conditioned_shown : forall n places Y r w c2 mu mus c u v, forallb is_affine_at (w :: all_places r) = true ->
  Nat.eqb (length mus) m && everywhere_by (@map_sample) (conditioned_at n c2 places Y mu) 0 mus 0 (map_sample (fun i => nth i (tensors cell) (Constant None)) (sample_of r w l)) = true ->
  contains bits c2 c -> 0 <= c -> length u = n -> length v = n -> nonzero u -> nonzero v ->
  positive_D (map_rows (fun i => here i) r) /\ energy (map_rows (fun i => here i) r) u * dot v v < c * energy (map_rows (fun i => here i) r) v * dot u u.
Proof.
  intros n places Y r w c2 mu mus c u v ha h hc c0 lu lv nu nv. apply andb_true_iff in h as [lm h]. apply Nat.eqb_eq in lm. assert (ha' := ha). cbn [forallb] in ha'. apply andb_true_iff in ha' as [_ hr].
  assert (H : forall p, length p = m -> exists sum, conditioned_at n c2 places Y mu sum (map_sample (look (points cell p)) (sample_of r w l)) = true).
  { intros p lp. destruct (everywhere_by_sound _ map_sample_map _ _ _ _ _ h p ltac:(congruence) ltac:(destruct p; exact I)) as [sum K]. exists sum. rewrite map_sample_map in K. rewrite <- K. f_equal.
    apply map_sample_ext. intro j. symmetry. apply tensors_value. congruence. }
  assert (P : positive_D (map_rows (fun i => here i) r)).
  { apply (regular_here r w l hr). intros p lp _. destruct (H p lp) as [sum K]. unfold conditioned_at in K. destruct (known_rows _); [reflexivity | discriminate]. }
  split; [exact P |]. destruct (upper_energy _ u P) as [q E]. pose proof (lower_energy places Y _ v P) as F.
  unfold nonzero in nu, nv. set (U := dot u u) in *. set (V := dot v v) in *.
  enough (0 < c * U * form (lower_weights places Y v) (map_rows (fun i => here i) r) v + V * form (upper_weights q) (map_rows (fun i => here i) r) u
    + - ((c + 1) * U * V) * less_at (parabola x) l) as G.
  { pose proof (Rmult_le_pos ((c + 1) * U * V) _ ltac:(apply Rmult_le_pos; [apply Rmult_le_pos |]; lra) l_nonneg).
    pose proof (Rmult_le_compat_l (c * U) _ _ ltac:(apply Rmult_le_pos; lra) F). rewrite E in G. lra. }
  apply (decide (fun ps => c * U * form (lower_weights places Y v) (map_rows (fun i => at_ ps i) r) v + V * form (upper_weights q) (map_rows (fun i => at_ ps i) r) u
    + - ((c + 1) * U * V) * less_at ps l) O).
  - intros before after a b d p z s len su. rewrite (rows_affine r (lower_weights places Y v) v hr before after a b d p z s len su),
      (rows_affine r (upper_weights q) u hr before after a b d p z s len su), (multiple_affine l l_affine before after a b d p z s len su). ring.
  - apply falls_none.
  - intros p ps lp _ rq. destruct (H p lp) as [sum K]. unfold conditioned_at in K. pose proof (evaluate_at_sound _ ps rq w) as W.
    destruct (known_rows _) as [s |] eqn:es; [| discriminate]. cbn [map_sample sample_of s_rows s_weight] in es, K. destruct (nth w (evaluate_at _) None) as [b |]; [| discriminate].
    match type of K with context [known_multiple ?u] => destruct (known_multiple u) as [t |] eqn:et; [| discriminate] end. pose proof (multiple_sound _ ps r w l t rq et) as L.
    destruct (known_rows_sound _ ps r s rq es) as [S _]. cbv zeta in K. apply andb_true_iff in K as [K up]. apply andb_true_iff in K as [_ low].
    set (one := Fixed.integer bits 1) in *. pose proof (Fixed.integer_sound bits 1) as one_. fold one in one_.
    pose proof (add_sound bits _ _ _ _ (mul_sound bits _ _ _ _ (Arithmetic.dyadic_sound bits mu places _ _ one_) W) (Arithmetic.dyadic_sound bits sum places _ _ one_)) as M.
    set (mu_ := add _ _) in *. match type of M with contains _ _ ?y => set (k := y) in *; clearbody k end.
    assert (Low : 0 < form (lower_weights places Y v) (map_rows (fun i => at_ ps i) r) v + - k * V + - less_at ps l * V).
    { unfold is_definite in low. destruct (Nat.eqb_spec (length (lower_triangle places Y s (repeat [sub (neg mu_) t] n))) n) as [e | e]; [| discriminate].
      destruct (lower_triangle_sound bits places Y s _ _ _ v S (diagonal_in bits _ _ n (sub_sound bits _ _ _ _ (neg_sound bits _ _ M) L))) as [T [hT le]].
      pose proof (is_positive_definite_sound bits _ T low hT v) as Q. rewrite <- lv, quad_diagonal in le. fold V in le. rewrite (related_length _ _ _ _ _ hT) in e. specialize (Q ltac:(congruence) nv). lra. }
    assert (Up : 0 < form (upper_weights q) (map_rows (fun i => at_ ps i) r) u + c * k * U + - less_at ps l * U).
    { destruct (upper_triangle bits s (repeat [sub (mul bits c2 mu_) t] n)) as [T |] eqn:eu; [| discriminate].
      unfold is_definite in up. destruct (Nat.eqb_spec (length T) n) as [e | e]; [| discriminate].
      destruct (upper_triangle_sound bits s _ _ _ u T S (diagonal_in bits _ _ n (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ hc M) L)) eu) as [X [hX le]].
      pose proof (is_positive_definite_sound bits _ X up hX u) as Q. specialize (le q). rewrite <- lu, quad_diagonal in le. fold U in le.
      rewrite (related_length _ _ _ _ _ hX) in e. specialize (Q ltac:(congruence) nu). lra. }
    clear - Low Up c0 nu nv. set (a := form _ _ v) in *. set (b := form _ _ u) in *. set (t := less_at ps l) in *. clearbody a b t U V.
    pose proof (Rmult_le_pos (c * U) _ ltac:(apply Rmult_le_pos; lra) (Rlt_le _ _ Low)). pose proof (Rmult_lt_0_compat _ _ nv Up). lra.
Qed.

Theorem solve_shown : forall e n i places Y r w k2 k u, forallb is_affine_at (w :: all_places r) = true -> ends_suffice e n r w l ->
  at_controls e (solve_at n i places Y k2) (sample_of r w l) ->
  contains bits k2 k -> 0 <= k -> 0 < here w -> length u = length r -> nonzero u ->
  let p := weighted_sum u (map fst (map_rows (fun i => here i) r)) in
  k * here w * (nth i (map snd (map_rows (fun i => here i) r)) 0 * nth i u 0 ^ 2) < dot p p.
Proof.
  intros e n i places Y r w k2 k u ha he H hk k0 w0 lu nz p. set (q := weighted_sum u (map (map (Y_value places)) Y)).
  assert (T : 0 < form (solve_weights i k u) (map_rows (fun i => here i) r) q + - dot q q * here w + - dot u u * less_at (parabola x) l).
  { apply (decide (fun ps => form (solve_weights i k u) (map_rows (fun i => at_ ps i) r) q + - dot q q * at_ ps w + - dot u u * less_at ps l) e).
    - apply weight_affine; assumption.
    - apply (falls_suffices e n); [exact he |]. clear - k0. revert i. induction u as [| t u IH]; intros [| i]; cbn [solve_weights]; constructor; cbn [snd]; try lra; [| | apply IH].
      + pose proof (Rmult_le_pos k (t ^ 2) k0 (pow2_ge_0 t)). lra.
      + rewrite Forall_map. apply Forall_forall. intros y _. cbn [snd]. lra.
    - intros c ps lp ep rq. specialize (H c lp ep). unfold solve_at in H. pose proof (evaluate_at_sound _ ps rq w) as W.
      destruct (known_rows _) as [s |] eqn:es; [| discriminate]. cbn [map_sample sample_of s_rows s_weight] in es, H.
      destruct (nth w (evaluate_at _) None) as [b |]; [| discriminate].
      match type of H with context [known_multiple ?u] => destruct (known_multiple u) as [t |] eqn:et; [| discriminate] end. pose proof (multiple_sound _ ps r w l t rq et) as L.
      destruct (known_rows_sound _ ps r s rq es) as [S _]. apply andb_true_iff in H as [H D]. apply andb_true_iff in H as [l1 l2]. apply Nat.eqb_eq in l1, l2.
      pose proof (related_length _ _ _ _ _ S) as ls. set (R := map_rows (fun i => at_ ps i) r) in *. assert (lr : length R = length r) by (unfold R, map_rows; apply map_length).
      destruct (solve_diagonal_sound i k2 k t _ s R u hk k0 L S ltac:(congruence)) as [G [hG le]].
      pose proof (triangle_add_sound bits _ _ _ _ hG (gram_sound places _ _ (solve_pairs_sound places Y b _ s R W S))) as hT.
      unfold is_definite in D. destruct (Nat.eqb_spec (length (triangle_add (solve_diagonal i k2 t s) (gram places (solve_pairs places Y b s)))) n) as [z | z]; [| discriminate].
      pose proof (is_positive_definite_sound bits _ _ D hT u) as Q. rewrite (related_length _ _ _ _ _ hT) in z. specialize (Q ltac:(congruence) nz).
      rewrite quad_tcomb, quad_pairs in Q by congruence. fold q in Q. rewrite form_solve by congruence. lra. }
  rewrite form_solve in T by (unfold map_rows; rewrite map_length; exact lu). fold p in T.
  set (W := here w) in *. set (B := nth i (map snd (map_rows (fun i => here i) r)) 0 * nth i u 0 ^ 2) in *.
  pose proof (dot_self (comb 1 (- W) p q)) as N. rewrite dot_comb, !(dot_commutes _ (comb _ _ _ _)), !dot_comb, (dot_commutes q p) in N.
  assert (0 <= dot u u * less_at (parabola x) l) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l_nonneg]).
  assert (0 < 2 * dot p q - k * B - W * dot q q) by lra.
  assert (0 < W * (2 * dot p q - k * B - W * dot q q)) by (apply Rmult_lt_0_compat; assumption). nra.
Qed.

Theorem sign_shown : forall f, is_affine_at f = true -> at_controls O sign_at (sample_of [] f l) -> 0 <= here f.
Proof.
  intros f ha H. enough (0 <= here f + - (1) * less_at (parabola x) l) by lra.
  apply (decide_weakly (fun y => 0 <= y) nonneg_convex (fun ps => at_ ps f + - (1) * less_at ps l)).
  - intros before after a b c p q s len su. rewrite (entry_affine f ha before after a b c p q s len su), (multiple_affine l l_affine before after a b c p q s len su). ring.
  - intros p ps lp rq. specialize (H p lp I). unfold sign_at in H. pose proof (evaluate_at_sound _ ps rq f) as W. cbn [map_sample sample_of s_weight] in H.
    destruct (nth f (evaluate_at _) None) as [a |]; [| discriminate].
    match type of H with context [known_multiple ?u] => destruct (known_multiple u) as [t |] eqn:et; [| discriminate] end.
    apply Z.leb_le in H. pose proof (contains_nonneg bits _ _ H (sub_sound bits _ _ _ _ W (multiple_sound _ ps [] f l t rq et))). lra.
Qed.

(** Formulas over the whole cell. *)
Lemma range_sound : forall f a, nth f (evaluate_at (map (fun a => (a, sqr bits a)) cell)) None = Some a -> contains bits a (here f).
Proof.
  intros f a e. assert (H : Forall2 in_pair (map (fun a => (a, sqr bits a)) cell) (parabola x)).
  { unfold parabola. clear - x_in. induction x_in; cbn [map]; constructor; auto. split; [assumption | apply sqr_sound; assumption]. }
  pose proof (evaluate_at_sound _ _ H f) as V. rewrite e in V. exact V.
Qed.
End OnCell.
End Tape.
End Precision.
