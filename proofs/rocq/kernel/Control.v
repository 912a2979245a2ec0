(** * Polynomials of degree two at most in each coordinate, at the control points of a cell

    A formula that is affine in each pair (x_k, x_k^2) is, at every point of a
    cell, a weighted mean of its values at control points, with the same weights
    for all such formulas: those of Bernstein's polynomials (control.rs). *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Formula Linear Arithmetic Slope Test Definite Cell.
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
  fix IH 1. intros [o] p q h. unfold at_pairs in *. destruct o as [j | j | n | a b | a b | a | a b | a b | a | a]; cbn [is_free] in h; cbn [value map_op real_op];
    [| exact eq_refl | exact eq_refl | | | | | | |]; try (apply andb_true_iff in h as [h1 h2]; rewrite (IH a p q h1), (IH b p q h2); exact eq_refl);
    try (rewrite (IH a p q h); exact eq_refl).
  apply andb_true_iff in h as [h1 h2]. rewrite (nth_at p), (nth_at q). destruct (Nat.eqb j k); [discriminate h1 |]. destruct (Nat.eqb j (m + k)); [discriminate h2 | exact eq_refl].
Qed.

Lemma affine_value : forall f u v w p q r, u + v + w = 1 -> is_affine m k f = true ->
  at_ f (mean u v w p q r) = u * at_ f p + v * at_ f q + w * at_ f r.
Proof.
  fix IH 1. intros [o] u v w p q r s h. assert (E : u = 1 - v - w) by lra. destruct o as [j | j | n | a b | a b | a | a b | a b | a | a].
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
Qed.
End Coordinate.
End Pairs.

(** There are [m] coordinates. *)
Fixpoint is_below (m : nat) (f : formula) : bool :=
  match f with
  | F o => match o with
      | Coord k => Nat.ltb k m
      | Param _ | Integer _ => true
      | Add a b | Sub a b | Mul a b | Div a b => is_below m a && is_below m b
      | Neg a | Sqr a | Sqrt a => is_below m a
      end
  end.

Definition parabola (x : list R) : list (R * R) := map (fun a => (a, a ^ 2)) x.

Lemma image_value : forall theta x f, is_below (length x) f = true -> at_pairs theta (image (length x) f) (parabola x) = value x theta f.
Proof.
  intros theta x. unfold at_pairs. set (X := point_of (parabola x)).
  assert (L : forall j, (j < length x)%nat -> nth j X 0 = nth j x 0 /\ nth (length x + j) X 0 = nth j x 0 ^ 2).
  { intros j h. unfold X, point_of, parabola. rewrite !map_map. cbn [fst snd]. rewrite map_id. split; [apply app_nth1; exact h |].
    rewrite app_nth2_plus. rewrite (nth_indep _ 0 ((fun a => a ^ 2) 0)) by (rewrite map_length; exact h). rewrite (map_nth (fun a => a ^ 2)). reflexivity. }
  fix IH 1. intros [o] h. destruct o as [j | j | n | a b | a b | a | a b | a b | a | a]; cbn [is_below] in h;
    try (apply andb_true_iff in h as [h1 h2]; cbn [image value map_op real_op]; rewrite (IH a h1), (IH b h2); reflexivity);
    try (cbn [image value map_op real_op]; rewrite (IH a h); reflexivity); try reflexivity.
  - apply Nat.ltb_lt in h. exact (proj1 (L j h)).
  - pose proof (IH a h) as K. destruct a as [[j | j | n | b c | b c | b | b c | b c | b | b]]; [| exact (f_equal (fun y => y ^ 2) K) ..].
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

(** ** Nodes of a range *)

Section Precision.
Variable bits : positive.
Local Notation unit := (unit_R bits).

(** The ends, with their squares, and between them no point of the parabola. *)
Definition nodes (a : fixed) : list (fixed * fixed) :=
  let l := Fixed (lo a) (lo a) in let h := Fixed (hi a) (hi a) in
  [(l, sqr bits l); (halve (add l h), mul bits l h); (h, sqr bits h)].
Definition in_pair (i : fixed * fixed) (p : R * R) : Prop := contains bits (fst i) (fst p) /\ contains bits (snd i) (snd p).

Definition real_nodes (a : fixed) : list (R * R) :=
  let l := IZR (lo a) / unit in let h := IZR (hi a) / unit in [(l, l ^ 2); ((l + h) / 2, l * h); (h, h ^ 2)].

Lemma real_nodes_in : forall a, Forall2 in_pair (nodes a) (real_nodes a).
Proof.
  intro a. unfold nodes. cbv zeta. pose proof (point_sound bits (lo a)) as L. pose proof (point_sound bits (hi a)) as H.
  apply Forall2_cons; [split | apply Forall2_cons; [split | apply Forall2_cons; [split | apply Forall2_nil]]]; cbn [fst snd];
    auto using sqr_sound, mul_sound, halve_sound, add_sound.
Qed.

Lemma real_nodes_mean : forall a x, contains bits a x -> is_mean (x, x ^ 2) (real_nodes a).
Proof.
  intros a x [l u]. unfold real_nodes. cbv zeta. pose proof (unit_R_pos bits) as u0. set (L := IZR (lo a) / unit). set (H := IZR (hi a) / unit).
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

(** All control points of a cell. *)
Fixpoint grid (cell : list fixed) : list (list (fixed * fixed)) :=
  match cell with [] => [[]] | a :: c => let rest := grid c in flat_map (fun n => map (cons n) rest) (nodes a) end.

Lemma grid_in : forall cell qs, Forall2 (fun q l => In q l) qs (map real_nodes cell) -> exists is, In is (grid cell) /\ Forall2 in_pair is qs.
Proof.
  induction cell as [| a cell IH]; intros qs h; inversion h as [| q l qs' l' hq h']; subst; [exists []; split; [left; reflexivity | constructor] |].
  destruct (IH qs' h') as [is [hi hr]].
  assert (N : exists i, In i (nodes a) /\ in_pair i q).
  { pose proof (real_nodes_in a) as R. revert hq. induction R as [| i r is' rs hir R IHR]; intros hq; [contradiction |].
    destruct hq as [<- | hq]; [exists i; split; [left; reflexivity | exact hir] |]. destruct (IHR hq) as [j [ij jq]]. exists j. split; [right; exact ij | exact jq]. }
  destruct N as [i [ii iq]]. exists (i :: is). split; [| constructor; assumption]. cbn [grid]. cbv zeta. apply in_flat_map. exists i. split; [exact ii |]. apply in_map, hi.
Qed.

(** ** Formulas at a control point, in intervals *)

Section Tape.
Variable tape : list (op nat).
Variable params : list fixed.
Variable theta : list R.
Hypothesis theta_in : Forall2 (contains bits) params theta.

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
  end.

Definition entry_at (i : nat) : formula := nth i (formulas tape) (integer 0).
Definition evaluate_at (q : list (fixed * fixed)) : list (option fixed) :=
  run (option fixed) None (fixed_op (map fst q ++ map snd q)) tape [].

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
  apply (run_related (option fixed) formula None (integer 0) _ F (has_value ps)); [exact I | | constructor].
  intros o f g H. unfold has_value, at_pairs in *. destruct o as [k | j | n | a b | a b | a | a b | a b | a | a];
    cbn [map_op fixed_op value real_op];
    try (pose proof (H a) as A; destruct (f a) as [ia |]; cbn [lift1 lift2]; [| exact I]);
    try (pose proof (H b) as B; destruct (f b) as [ib |]; cbn [lift1 lift2]; [| exact I]);
    auto using nth_contains, Fixed.integer_sound, add_sound, sub_sound, neg_sound, mul_sound, sqr_sound.
  - destruct (recip bits ib) as [r |] eqn:e; cbn [option_map]; [| exact I]. apply mul_sound; [exact A | apply (recip_sound bits ib _ _ e B)].
  - destruct (Fixed.root bits ia) as [r |] eqn:e; [| exact I]. apply (root_sound bits ia r _ e A).
Qed.

(** ** Tests: sigma_min^2 > k w, sigma_max^2 < k w, f >= 0 *)

Inductive polynomial_test :=
  | LeastOf (r : rows nat) (w : nat) (kappa2 : fixed)
  | GreatestOf (r : rows nat) (w : nat) (k2 : fixed)
  | SignOf (f : nat).

Fixpoint values_of (values : list (option fixed)) (a : list nat) : option (list fixed) :=
  match a with
  | [] => Some []
  | i :: a' => match nth i values None, values_of values a' with Some x, Some l => Some (x :: l) | _, _ => None end
  end.
(** Every D_i is positive. *)
Fixpoint rows_of (values : list (option fixed)) (r : rows nat) : option (rows fixed) :=
  match r with
  | [] => Some []
  | (a, d) :: r' =>
      match values_of values a, nth d values None, rows_of values r' with
      | Some a, Some d, Some rest => if (0 <? lo d)%Z then Some ((a, d) :: rest) else None
      | _, _, _ => None
      end
  end.

(** A multiple, [n] over [2^places], of a formula that is not negative, or none: the S-procedure. *)
Definition multiple : Type := option (nat * Z * N).
Definition multiple_at (l : multiple) (values : list (option fixed)) : option fixed :=
  match l with None => Some zero | Some (g, n, places) => option_map (Arithmetic.dyadic n places) (nth g values None) end.

Definition is_definite (n : nat) (t : triangle) : bool := if Nat.eqb (length t) n then is_positive_definite t else false.
Definition lower_at (n : nat) (places : N) (Y : list (list Z)) (r : rows nat) (w : nat) (k : fixed) (l : multiple) (values : list (option fixed)) : bool :=
  match rows_of values r, nth w values None, multiple_at l values with
  | Some rows, Some w, Some t => is_definite n (lower_triangle places Y rows (repeat [sub (neg (mul bits k w)) t] n))
  | _, _, _ => false
  end.
(** Full rank: the same with D = 0 and k = 0. *)
Definition rank_at (n : nat) (places : N) (Y : list (list Z)) (r : rows nat) (l : multiple) (values : list (option fixed)) : bool :=
  match rows_of values r, multiple_at l values with
  | Some rows, Some t => is_definite n (lower_triangle places Y (map (fun p => (fst p, zero)) rows) (repeat [sub zero t] n))
  | _, _ => false
  end.
Definition upper_at (n : nat) (r : rows nat) (w : nat) (k : fixed) (l : multiple) (values : list (option fixed)) : bool :=
  match rows_of values r, nth w values None, multiple_at l values with
  | Some rows, Some w, Some t => match upper_triangle rows (repeat [sub (mul bits k w) t] n) with Some t => is_definite n t | None => false end
  | _, _, _ => false
  end.
Definition sign_at (f : nat) (l : multiple) (values : list (option fixed)) : bool :=
  match nth f values None, multiple_at l values with Some a, Some t => (0 <=? lo (sub a t))%Z | _, _ => false end.

(** Formulas of the tape are affine in each pair. *)
Variable m : nat.
Definition all_places (r : rows nat) : list nat := flat_map (fun p => fst p ++ [snd p]) r.
Definition is_affine_at (i : nat) : bool := forallb (fun k => is_affine m k (entry_at i)) (seq 0 m).
Local Notation at_ ps i := (at_pairs theta (entry_at i) ps).

Lemma entry_affine : forall i, is_affine_at i = true -> affine_there m (fun ps => at_ ps i).
Proof.
  intros i h before after u v w p q r l s. unfold is_affine_at in h. rewrite forallb_forall in h.
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

Lemma multiple_at_sound : forall q ps l t, Forall2 in_pair q ps -> multiple_at l (evaluate_at q) = Some t -> contains bits t (less_at ps l).
Proof.
  intros q ps [[[g n] places] |] t h e; cbn [multiple_at less_at] in *; [| injection e as <-; apply zero_sound].
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

Lemma values_of_sound : forall q ps a s, Forall2 in_pair q ps -> values_of (evaluate_at q) a = Some s -> Forall2 (contains bits) s (map (fun i => at_ ps i) a).
Proof.
  intros q ps a s h. revert s. induction a as [| i a IH]; intros s e; cbn [values_of map] in *; [injection e as <-; constructor |].
  pose proof (evaluate_at_sound q ps h i) as V. destruct (nth i _ None) as [b |]; [| discriminate].
  destruct (values_of _ a) as [l |]; [| discriminate]. injection e as <-. constructor; auto.
Qed.

Lemma rows_of_sound : forall q ps r s, Forall2 in_pair q ps -> rows_of (evaluate_at q) r = Some s ->
  rows_rel (contains bits) s (map_rows (fun i => at_ ps i) r) /\ positive_D (map_rows (fun i => at_ ps i) r).
Proof.
  intros q ps r s h. revert s. induction r as [| [a d] r IH]; intros s e; cbn [rows_of] in e; [injection e as <-; split; constructor |].
  destruct (values_of _ a) as [b |] eqn:ea; [| discriminate]. pose proof (evaluate_at_sound q ps h d) as V.
  destruct (nth d _ None) as [c |]; [| discriminate]. destruct (rows_of _ r) as [rest |]; [| discriminate].
  destruct (0 <? lo c)%Z eqn:p; [| discriminate]. injection e as <-. apply Z.ltb_lt in p. destruct (IH rest eq_refl) as [I1 I2].
  rewrite map_rows_cons. split; constructor; auto.
  - split; [exact (values_of_sound q ps a b h ea) | exact V].
  - exact (contains_positive bits _ _ p V).
Qed.

(** ** What the tests show of a cell *)

Section OnCell.
Variable cell : list fixed.
Variable x : list R.
Hypothesis x_in : Forall2 (contains bits) cell x.
Hypothesis dimension : length cell = m.
Local Notation here i := (at_pairs theta (entry_at i) (parabola x)).

Lemma decide : forall good, is_convex good -> forall g, affine_there m g ->
  (forall q ps, In q (grid cell) -> Forall2 in_pair q ps -> good (g ps)) -> good (g (parabola x)).
Proof.
  intros good cv g ha H. apply (controls_decide good cv m g ha (parabola x) (map real_nodes cell)).
  - unfold parabola. rewrite map_length, <- (related_length _ _ _ _ _ x_in). exact dimension.
  - unfold parabola. clear - x_in. induction x_in; cbn [map]; constructor; auto. apply real_nodes_mean; assumption.
  - intros qs hq. destruct (grid_in cell qs hq) as [q [iq rq]]. exact (H q qs iq rq).
Qed.

Lemma regular_here : forall r, forallb is_affine_at (all_places r) = true ->
  (forall q, In q (grid cell) -> exists s, rows_of (evaluate_at q) r = Some s) -> positive_D (map_rows (fun i => here i) r).
Proof.
  intros r ha H. assert (K : forall a d, In (a, d) r -> 0 < here d).
  { intros a d i. apply (decide (fun y => 0 < y) positive_convex (fun ps => at_ ps d)).
    - apply entry_affine. rewrite forallb_forall in ha. apply ha, in_flat_map. exists (a, d). split; [exact i |]. apply in_or_app. right. left. reflexivity.
    - intros q ps iq rq. destruct (H q iq) as [s e]. destruct (rows_of_sound q ps r s rq e) as [_ P]. unfold positive_D, map_rows in P.
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

(** The multiple is of what is not negative here. *)
Variable l : multiple.
Hypothesis l_affine : is_affine_multiple l = true.
Hypothesis l_nonneg : 0 <= less_at (parabola x) l.

Theorem lower_shown : forall n places Y r w kappa2 k v, forallb is_affine_at (w :: all_places r) = true ->
  (forall q, In q (grid cell) -> lower_at n places Y r w kappa2 l (evaluate_at q) = true) ->
  contains bits kappa2 k -> length v = n -> nonzero v ->
  positive_D (map_rows (fun i => here i) r) /\ k * here w * dot v v < energy (map_rows (fun i => here i) r) v.
Proof.
  intros n places Y r w kappa2 k v ha H hk lv nz. assert (ha' := ha). cbn [forallb] in ha'. apply andb_true_iff in ha' as [_ hr].
  assert (P : positive_D (map_rows (fun i => here i) r)).
  { apply (regular_here r hr). intros q iq. specialize (H q iq). unfold lower_at in H. destruct (rows_of _ r) as [s |]; [exists s; reflexivity | discriminate]. }
  split; [exact P |]. apply Rlt_le_trans with (2 := lower_energy places Y _ v P).
  assert (0 <= dot v v * less_at (parabola x) l) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l_nonneg]).
  enough (0 < form (lower_weights places Y v) (map_rows (fun i => here i) r) v + - (k * dot v v) * here w + - dot v v * less_at (parabola x) l) by lra.
  apply (decide (fun y => 0 < y) positive_convex
    (fun ps => form (lower_weights places Y v) (map_rows (fun i => at_ ps i) r) v + - (k * dot v v) * at_ ps w + - dot v v * less_at ps l)).
  - apply weight_affine; assumption.
  - intros q ps iq rq. specialize (H q iq). unfold lower_at in H. pose proof (evaluate_at_sound q ps rq w) as W.
    destruct (rows_of (evaluate_at q) r) as [s |] eqn:es; [| discriminate]. destruct (nth w (evaluate_at q) None) as [b |]; [| discriminate].
    destruct (multiple_at l (evaluate_at q)) as [t |] eqn:et; [| discriminate]. pose proof (multiple_at_sound q ps l t rq et) as L.
    destruct (rows_of_sound q ps r s rq es) as [S _]. unfold is_definite in H.
    destruct (Nat.eqb_spec (length (lower_triangle places Y s (repeat [sub (neg (mul bits kappa2 b)) t] n))) n) as [e | e]; [| discriminate].
    destruct (lower_triangle_sound bits places Y s _ _ _ v S
      (diagonal_in bits _ _ n (sub_sound bits _ _ _ _ (neg_sound bits _ _ (mul_sound bits _ _ _ _ hk W)) L))) as [T [hT le]].
    pose proof (is_positive_definite_sound bits _ T H hT v) as Q. rewrite <- lv, quad_diagonal in le.
    rewrite (related_length _ _ _ _ _ hT) in e. specialize (Q ltac:(congruence) nz). lra.
Qed.

Lemma form_without_D : forall ws r v, form (map (fun p => (fst p, 0)) ws) r v = form ws (map (fun p => (fst p, 0)) r) v.
Proof. induction ws as [| [y z] ws IH]; intros [| [a d] r] v; try reflexivity. cbn [map form fst]. rewrite IH. ring. Qed.

Theorem rank_shown : forall n places Y r v, forallb is_affine_at (all_places r) = true ->
  (forall q, In q (grid cell) -> rank_at n places Y r l (evaluate_at q) = true) -> length v = n -> nonzero v ->
  positive_D (map_rows (fun i => here i) r) /\ 0 < energy (map_rows (fun i => here i) r) v.
Proof.
  intros n places Y r v ha H lv nz. assert (P : positive_D (map_rows (fun i => here i) r)).
  { apply (regular_here r ha). intros q iq. specialize (H q iq). unfold rank_at in H. destruct (rows_of _ r) as [s |]; [exists s; reflexivity | discriminate]. }
  split; [exact P |]. apply (rank_energy places Y _ v P). rewrite <- form_without_D.
  assert (0 <= dot v v * less_at (parabola x) l) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l_nonneg]).
  set (ws := map (fun p => (fst p, 0)) (lower_weights places Y v)).
  enough (0 < form ws (map_rows (fun i => here i) r) v + - dot v v * less_at (parabola x) l) by lra.
  apply (decide (fun y => 0 < y) positive_convex (fun ps => form ws (map_rows (fun i => at_ ps i) r) v + - dot v v * less_at ps l)).
  - intros before after a b c p q s len su. rewrite (rows_affine r ws v ha before after a b c p q s len su), (multiple_affine l l_affine before after a b c p q s len su). ring.
  - intros q ps iq rq. specialize (H q iq). unfold rank_at in H. unfold ws. rewrite form_without_D.
    destruct (rows_of (evaluate_at q) r) as [s |] eqn:es; [| discriminate].
    destruct (multiple_at l (evaluate_at q)) as [t |] eqn:et; [| discriminate]. pose proof (multiple_at_sound q ps l t rq et) as L.
    destruct (rows_of_sound q ps r s rq es) as [S _]. unfold is_definite in H.
    assert (S0 : rows_rel (contains bits) (map (fun p => (fst p, zero)) s) (map (fun p => (fst p, 0)) (map_rows (fun i => at_ ps i) r)))
      by (eapply map_related; [| exact S]; intros a b [k _]; split; [exact k | apply zero_sound]).
    destruct (Nat.eqb_spec (length (lower_triangle places Y (map (fun p => (fst p, zero)) s) (repeat [sub zero t] n))) n) as [e | e]; [| discriminate].
    destruct (lower_triangle_sound bits places Y _ _ _ _ v S0 (diagonal_in bits _ _ n (sub_sound bits _ _ _ _ (zero_sound bits) L))) as [T [hT le]].
    pose proof (is_positive_definite_sound bits _ T H hT v) as Q. rewrite <- lv, quad_diagonal in le.
    rewrite (related_length _ _ _ _ _ hT) in e. specialize (Q ltac:(congruence) nz). lra.
Qed.

Theorem upper_shown : forall n r w k2 k v, forallb is_affine_at (w :: all_places r) = true ->
  (forall q, In q (grid cell) -> upper_at n r w k2 l (evaluate_at q) = true) ->
  contains bits k2 k -> length v = n -> nonzero v ->
  positive_D (map_rows (fun i => here i) r) /\ energy (map_rows (fun i => here i) r) v < k * here w * dot v v.
Proof.
  intros n r w k2 k v ha H hk lv nz. assert (ha' := ha). cbn [forallb] in ha'. apply andb_true_iff in ha' as [_ hr].
  assert (P : positive_D (map_rows (fun i => here i) r)).
  { apply (regular_here r hr). intros q iq. specialize (H q iq). unfold upper_at in H. destruct (rows_of _ r) as [s |]; [exists s; reflexivity | discriminate]. }
  split; [exact P |]. destruct (upper_energy _ v P) as [u E].
  assert (0 <= dot v v * less_at (parabola x) l) by (apply Rmult_le_pos; [apply Rlt_le, nz | exact l_nonneg]).
  enough (0 < form (upper_weights u) (map_rows (fun i => here i) r) v + k * dot v v * here w + - dot v v * less_at (parabola x) l) by lra.
  apply (decide (fun y => 0 < y) positive_convex
    (fun ps => form (upper_weights u) (map_rows (fun i => at_ ps i) r) v + k * dot v v * at_ ps w + - dot v v * less_at ps l)).
  - apply weight_affine; assumption.
  - intros q ps iq rq. specialize (H q iq). unfold upper_at in H. pose proof (evaluate_at_sound q ps rq w) as W.
    destruct (rows_of (evaluate_at q) r) as [s |] eqn:es; [| discriminate]. destruct (nth w (evaluate_at q) None) as [b |]; [| discriminate].
    destruct (multiple_at l (evaluate_at q)) as [t |] eqn:et; [| discriminate]. pose proof (multiple_at_sound q ps l t rq et) as L.
    destruct (rows_of_sound q ps r s rq es) as [S _]. destruct (upper_triangle s (repeat [sub (mul bits k2 b) t] n)) as [T |] eqn:eu; [| discriminate].
    unfold is_definite in H. destruct (Nat.eqb_spec (length T) n) as [e | e]; [| discriminate].
    destruct (upper_triangle_sound bits s _ _ _ v T S (diagonal_in bits _ _ n (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ hk W) L)) eu) as [U [hU le]].
    pose proof (is_positive_definite_sound bits _ U H hU v) as Q. specialize (le u). rewrite <- lv, quad_diagonal in le.
    rewrite (related_length _ _ _ _ _ hU) in e. specialize (Q ltac:(congruence) nz). lra.
Qed.

Theorem sign_shown : forall f, is_affine_at f = true -> (forall q, In q (grid cell) -> sign_at f l (evaluate_at q) = true) -> 0 <= here f.
Proof.
  intros f ha H. enough (0 <= here f + - (1) * less_at (parabola x) l) by lra.
  apply (decide (fun y => 0 <= y) nonneg_convex (fun ps => at_ ps f + - (1) * less_at ps l)).
  - intros before after a b c p q s len su. rewrite (entry_affine f ha before after a b c p q s len su), (multiple_affine l l_affine before after a b c p q s len su). ring.
  - intros q ps iq rq. specialize (H q iq). unfold sign_at in H. pose proof (evaluate_at_sound q ps rq f) as W.
    destruct (nth f (evaluate_at q) None) as [a |]; [| discriminate]. destruct (multiple_at l (evaluate_at q)) as [t |] eqn:et; [| discriminate].
    apply Z.leb_le in H. pose proof (contains_nonneg bits _ _ H (sub_sound bits _ _ _ _ W (multiple_at_sound q ps l t rq et))). lra.
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
