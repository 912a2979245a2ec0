(** * Directions apart

    Of c_1, .., c_K and -c_1, the numbers c_j . v change their sign at some j, and
    where they do a multiple of (c_j . v)(c_(j+1) . v) is not positive: a form less what
    that adds has to be positive in the wedge alone ([fan_covers]).  Tolerances are
    then taken off in coordinates in which a direction of the wedge is along an
    axis: of a form, where x is C u for a regular C ([lower_toward_sound],
    [upper_toward_sound]). *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope Definite Test Solve Tolerances.
Import ListNotations.
Local Open Scope R_scope.

(** ** Wedges *)

Definition product_along (b c v : list R) : R := dot b v * dot c v.
Definition in_wedge (b c : list Z) (v : list R) : Prop := product_along (map IZR b) (map IZR c) v <= 0.

Lemma opposed : forall b v, dot (map IZR (map Z.opp b)) v = - dot (map IZR b) v.
Proof. induction b as [| n b IH]; intros [| t v]; cbn [map dot]; try ring. rewrite IH, opp_IZR. ring. Qed.
(** Pairs of each with the next one, of the last with the opposite of the first. *)
Fixpoint wedges_from (first : list Z) (cs : list (list Z)) : list (list Z * list Z) :=
  match cs with [] => [] | b :: r => (b, match r with c :: _ => c | [] => map Z.opp first end) :: wedges_from first r end.
Definition wedges (cs : list (list Z)) : list (list Z * list Z) := match cs with [] => [] | c :: _ => wedges_from c cs end.
Lemma fan_covers : forall cs v, cs <> [] -> exists p, In p (wedges cs) /\ in_wedge (fst p) (snd p) v.
Proof.
  intros [| c0 cs0] v n; [contradiction |]. clear n. unfold wedges. set (d := fun c => dot (map IZR c) v).
  assert (G : forall cs b, 0 <= d b * d c0 -> d c0 <> 0 -> d b <> 0 ->
    exists p, In p (wedges_from c0 (b :: cs)) /\ in_wedge (fst p) (snd p) v).
  { induction cs as [| c cs IH]; intros b s n0 nb.
    - exists (b, map Z.opp c0). split; [left; reflexivity |]. unfold in_wedge, product_along. cbn [fst snd]. rewrite opposed. fold (d b) (d c0). lra.
    - destruct (Rle_dec (d b * d c) 0) as [l | l]; [exists (b, c); split; [left; reflexivity | exact l] |].
      destruct (IH c) as [p [i w]]; [| exact n0 | intro z; apply l; rewrite z; lra |].
      + assert (0 < d b * d c) by lra. assert (0 <= (d b * d c0) * (d b * d c)) by (apply Rmult_le_pos; lra).
        assert (0 < d b * d b) by (assert (0 < Rsqr (d b)) by (apply Rsqr_pos_lt; exact nb); exact H1). apply Rnot_lt_le. intro g.
        assert (d b * d b * (d c * d c0) < 0) by nra. nra.
      + exists p. split; [right; exact i | exact w]. }
  destruct (Req_dec (d c0) 0) as [z | z].
  - destruct cs0 as [| c cs]; [exists (c0, map Z.opp c0) | exists (c0, c)]; (split; [left; reflexivity |]); unfold in_wedge, product_along; cbn [fst snd]; fold (d c0); rewrite z; lra.
  - apply G; auto. apply Rle_0_sqr.
Qed.

(** ** Coordinates in which a direction is along an axis *)

Fixpoint put_in {A : Type} (z : A) (k : nat) (y : A) (x : list A) : list A :=
  match k, x with
  | O, [] => [y] | O, _ :: r => y :: r
  | S j, [] => z :: put_in z j y [] | S j, a :: r => a :: put_in z j y r
  end.
Lemma dot_put : forall k y X u, dot (put_in 0 k y X) u = dot X u + (y - nth k X 0) * nth k u 0.
Proof.
  induction k as [| k IH]; intros y [| a X] [| t u]; cbn [put_in dot nth]; try ring; rewrite IH; cbn [dot]; try ring.
  destruct k; cbn [nth]; ring.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Lemma put_related : forall k y Y x X, contains y Y -> Forall2 contains x X -> Forall2 contains (put_in zero k y x) (put_in 0 k Y X).
Proof.
  induction k as [| k IH]; intros y Y x X hy h; destruct h as [| a b x X ha h]; cbn [put_in]; constructor; auto using zero_sound.
Qed.
Lemma along_sound : forall x X w W, Forall2 contains x X -> Forall2 contains w W -> contains (along bits x w) (dot X W).
Proof.
  intros x X w W h. revert w W. induction h as [| a b x X ha h IH]; intros w W k; [apply zero_sound |].
  destruct k as [| c d w W hc k]; [apply zero_sound |]. unfold along. cbn [combine fold_right dot fst snd]. apply add_sound; [apply mul_sound; assumption | apply IH, k].
Qed.

(** y g^T + g y^T *)
Fixpoint outer_of (y g : list fixed) : triangle :=
  match y, g with
  | y1 :: y', g1 :: g' => (mul bits (add y1 y1) g1 :: merge (mul bits y1) (mul bits g1) (fun a b => add (mul bits y1 a) (mul bits g1 b)) g' y') :: outer_of y' g'
  | _, _ => []
  end.
Lemma outer_of_sound : forall y Y g G, Forall2 contains y Y -> Forall2 contains g G -> triangle_in bits (outer_of y g) (outer Y G).
Proof.
  intros y Y g G h. revert g G. induction h as [| a A y Y ha h IH]; intros g G k; [constructor |]. destruct k as [| b B g G hb k]; [constructor |].
  cbn [outer_of outer]. constructor; [| apply IH; exact k]. constructor.
  - replace (2 * A * B) with ((A + A) * B) by ring. apply mul_sound; [apply add_sound |]; assumption.
  - eapply merge_related; try eassumption; intros; try (apply mul_sound; assumption). apply add_sound; apply mul_sound; assumption.
Qed.

Section Toward.
Variables (k : nat) (w : list fixed) (W : list R).
Hypothesis w_in : Forall2 contains w W.

Definition turned (x : list fixed) : list fixed := put_in zero k (along bits x w) x.
Definition real_turned (X : list R) : list R := put_in 0 k (dot X W) X.
(** C u *)
Definition stretched (u : list R) : list R := comb 1 (nth k u 0) (put_in 0 k 0 u) W.

Lemma turned_sound : forall x X, Forall2 contains x X -> Forall2 contains (turned x) (real_turned X).
Proof. intros x X h. apply put_related; [apply along_sound; assumption | exact h]. Qed.
Lemma dot_turned : forall X u, dot (real_turned X) u = dot X (stretched u).
Proof.
  intros X u. unfold real_turned, stretched. rewrite dot_put, (dot_commutes X (comb _ _ _ _)), dot_comb, dot_put, (dot_commutes W X), (dot_commutes u X). ring.
Qed.

(** It is regular. *)
Lemma reached : forall v, length v = length W -> (k < length v)%nat -> nth k W 0 <> 0 -> exists u, length u = length v /\ stretched u = v.
Proof.
  intros v lv lk n. set (t := nth k v 0 / nth k W 0). exists (put_in 0 k t (comb 1 (- t) v W)).
  assert (PL : forall j y (x : list R), (j < length x)%nat -> length (put_in 0 j y x) = length x).
  { induction j as [| j IH]; intros y [| a x] l; cbn in *; try lia; try reflexivity. rewrite IH by lia. reflexivity. }
  assert (PN : forall j y (x : list R) i, (j < length x)%nat -> nth i (put_in 0 j y x) 0 = if Nat.eqb i j then y else nth i x 0).
  { induction j as [| j IH]; intros y [| a x] [| i] l; cbn in *; try lia; try reflexivity. apply IH. lia. }
  assert (CL : forall a b (x y : list R), length x = length y -> length (comb a b x y) = length x).
  { unfold comb. intros a b. induction x as [| p x IH]; intros [| q y] e; cbn in *; try discriminate; auto. }
  assert (CN : forall a b (x y : list R) i, length x = length y -> nth i (comb a b x y) 0 = a * nth i x 0 + b * nth i y 0).
  { unfold comb. intros a b. induction x as [| p x IH]; intros [| q y] [| i] e; cbn in *; try discriminate; try ring. apply IH. congruence. }
  pose proof (CL 1 (- t) v W lv) as l1. assert (k1 : (k < length (comb 1 (- t) v W))%nat) by lia. pose proof (PL k t _ k1) as l2.
  split; [congruence |]. unfold stretched. rewrite PN by exact k1. rewrite Nat.eqb_refl.
  assert (k2 : (k < length (put_in 0%R k t (comb 1 (- t) v W)))%nat) by lia. pose proof (PL k 0 _ k2) as l3.
  apply nth_ext with 0 0; [rewrite CL; congruence |]. intros i hi. rewrite CN by congruence. rewrite PN by exact k2. destruct (Nat.eqb_spec i k) as [-> | ne].
  - unfold t. field. exact n.
  - rewrite PN by exact k1. destruct (Nat.eqb_spec i k); [contradiction |]. rewrite CN by exact lv. ring.
Qed.
Lemma still_nonzero : forall u, nonzero (stretched u) -> nonzero u.
Proof.
  intros u h. unfold nonzero. apply Rnot_le_lt. intro z. pose proof (zero_vector u z) as Z. unfold nonzero in h.
  rewrite <- dot_turned, (dot_zero u _ Z) in h. lra.
Qed.

(** c |x|^2, with one entry each; and what is not positive in a wedge. *)
Definition unit_from (m i : nat) : list fixed := unit_at bits i m.
Definition squares (m : nat) (c : fixed) (start : triangle) : triangle :=
  fold_right (fun i t => triangle_add t (square_of bits (neg c) (turned (unit_from m i)))) start (seq 0 m).
Lemma squares_sound : forall m c C start S, contains c C -> triangle_in bits start S ->
  exists U, triangle_in bits (squares m c start) U /\ forall u, length (stretched u) = m -> quad U u = quad S u + C * dot (stretched u) (stretched u).
Proof.
  intros m c C start S hc hS.
  assert (G : forall l, exists U, triangle_in bits (fold_right (fun i t => triangle_add t (square_of bits (neg c) (turned (unit_from m i)))) start l) U /\
    forall u, length (stretched u) = m -> quad U u = quad S u + C * fold_right (fun i s => nth i (stretched u) 0 ^ 2 + s) 0 l).
  { induction l as [| i l [U [h1 h2]]]; [exists S; split; [exact hS | intros; cbn; ring] |]. cbn [fold_right].
    set (E := map (fun j => if Nat.eqb j i then 1 else 0) (seq 0 m)).
    assert (hE : Forall2 contains (unit_from m i) E).
    { unfold unit_from, unit_at, E. generalize (seq 0 m). induction l0 as [| j l0 I]; cbn [map]; constructor; [| exact I]. destruct (Nat.eqb j i); [apply integer_sound | apply zero_sound]. }
    eexists. split; [apply triangle_add_sound; [exact h1 | apply square_of_sound; [apply neg_sound; exact hc | apply turned_sound; exact hE]] |].
    intros u lu. rewrite quad_tcomb, quad_square, dot_turned, (h2 u lu). unfold E. rewrite <- lu.
    pose proof (dot_unit_at (stretched u) i 0) as D. cbn [Nat.add] in D. rewrite D. ring. }
  destruct (G (seq 0 m)) as [U [h1 h2]]. exists U. split; [exact h1 |]. intros u lu. rewrite (h2 u lu). f_equal. f_equal.
  rewrite <- lu. generalize (stretched u). clear. intro v.
  assert (H : forall v b, fold_right (fun i s => nth i (b ++ v) 0 ^ 2 + s) 0 (seq (length b) (length v)) = dot v v).
  { induction v0 as [| t v' IH]; intro b; cbn [length seq fold_right dot]; [reflexivity |]. rewrite app_nth2, Nat.sub_diag by lia. cbn [nth].
    specialize (IH (b ++ [t])). rewrite <- app_assoc, app_length, Nat.add_1_r in IH. cbn [app] in IH. rewrite IH. ring. }
  exact (H v []).
Qed.
Definition less_wedge (b c : list Z) (n : Z) (places : N) (start : triangle) : triangle :=
  triangle_add start (outer_of (turned (map (fun i => Arithmetic.dyadic i (places + 1) (one bits)) b)) (turned (map (fun i => Fixed.integer bits (n * i)) c))).
Lemma less_wedge_sound : forall b c n places start S, triangle_in bits start S -> (0 <= n)%Z ->
  exists U, triangle_in bits (less_wedge b c n places start) U /\ forall u, in_wedge b c (stretched u) -> quad U u <= quad S u.
Proof.
  intros b c n places start S hS n0. eexists. split.
  - apply triangle_add_sound; [exact hS |]. apply outer_of_sound; apply turned_sound.
    + instantiate (1 := map (Y_half places) b). clear. induction b as [| i b I]; cbn [map]; constructor; [| exact I].
      replace (Y_half places i) with (Y_half places i * 1) by ring. apply Arithmetic.dyadic_sound, integer_sound.
    + instantiate (1 := map (Rmult (IZR n)) (map IZR c)). clear. induction c as [| i c I]; cbn [map]; constructor; [| exact I]. rewrite <- mult_IZR. apply integer_sound.
  - intros u h. rewrite quad_tcomb, quad_outer, !dot_turned, dot_map. unfold in_wedge, product_along in h.
    assert (E : map (Y_half places) b = map (Rmult (/ IZR (2 ^ Z.of_N (places + 1)))) (map IZR b)).
    { rewrite map_map. apply map_ext. intro i. unfold Y_half, Rdiv. ring. }
    rewrite E, dot_map. apply IZR_le in n0. pose proof (Rinv_0_lt_compat _ (two_power (places + 1))) as p.
    set (q := / IZR (2 ^ Z.of_N (places + 1))) in *. set (x := dot (map IZR b) (stretched u)) in *. set (y := dot (map IZR c) (stretched u)) in *. clearbody q x y.
    assert (0 <= q * IZR n * - (x * y)) by (apply Rmult_le_pos; [apply Rmult_le_pos; lra | lra]). lra.
Qed.

(** The direction there, [d]. *)
Variable d : list fixed.

Fixpoint lower_toward (places : N) (Y : list (list Z)) (r : list (varied fixed)) (start : triangle) : option triangle :=
  match Y, r with
  | y :: Y', ((a, e), cs) :: r' =>
      let own := turned (map (fun n => Arithmetic.dyadic n places (one bits)) y) in
      match less_changes bits d own (map (fun c => turned (map halve (residual places (fst c) (snd c) y))) cs)
        (triangle_add start (outer_of (map halve own) (turned (residual places a (upper_end e) y)))) with
      | Some t => lower_toward places Y' r' t
      | None => None
      end
  | _, _ => Some start
  end.

Lemma lower_toward_sound : forall places Y i r start S T, Forall2 (varied_in bits) i r -> triangle_in bits start S -> lower_toward places Y i start = Some T ->
  exists U, triangle_in bits T U /\ forall u, quad U u <= quad S u + form (lower_weights places Y (stretched u)) r (stretched u).
Proof.
  intros places. induction Y as [| y Y IH]; intros i r start S T h hS u; [injection u as <-; exists S; split; [exact hS | intro; cbn; lra] |].
  destruct h as [| [[a e] cs] [A D] i r [a0 [d0 [ms [ha [hd [hm [eA eD]]]]]]] h]; [injection u as <-; exists S; split; [exact hS | intro; cbn; lra] |]. cbn [fst snd] in *.
  cbn [lower_toward] in u. destruct (upper_end_sound bits e d0 hd) as [g [hg le]]. set (own := turned _) in *.
  destruct (less_changes _ _ _ _ _) as [t |] eqn:el in u; [| discriminate].
  assert (hY : Forall2 contains (map (fun n => Arithmetic.dyadic n places (one bits)) y) (map (Y_value places) y)).
  { clear. induction y as [| n y I]; cbn [map]; constructor; [| exact I]. replace (Y_value places n) with (Y_value places n * 1) by ring. apply Arithmetic.dyadic_sound, integer_sound. }
  pose proof (turned_sound _ _ hY) as hO. fold own in hO.
  assert (hH : Forall2 contains (map halve own) (map (Rmult (/ 2)) (real_turned (map (Y_value places) y)))).
  { eapply map_related; [| exact hO]. intros b x hb. replace (/ 2 * x) with (x / 2) by (unfold Rdiv; ring). apply halve_sound, hb. }
  pose proof (triangle_add_sound bits _ _ _ _ hS (outer_of_sound _ _ _ _ hH (turned_sound _ _ (residual_sound bits places a a0 _ g y ha hg)))) as hT.
  set (half := fun c : list R * R => real_turned (map (Rmult (/ 2)) (comb 2 (- snd c) (fst c) (map (Y_value places) y)))).
  assert (hC : Forall2 (fun s m => is_share (fst m) /\ Forall2 contains s (snd m)) (map (fun c => turned (map halve (residual places (fst c) (snd c) y))) cs) (map (fun m => (fst m, half (snd m))) ms)).
  { eapply map_related; [| exact hm]. intros c m [h1 [h2 h3]]. cbn [fst snd]. split; [exact h1 |]. unfold half. apply turned_sound. eapply map_related; [| apply residual_sound; eassumption].
    intros b x hb. replace (/ 2 * x) with (x / 2) by (unfold Rdiv; ring). apply halve_sound, hb. }
  destruct (less_changes_sound bits _ _ _ _ _ _ _ _ el hT hO hC) as [S1 [h1 q1]]. destruct (IH i r t S1 T h h1 u) as [U [hU q]]. exists U. split; [exact hU |].
  intro z. specialize (q z). specialize (q1 z). set (v := stretched z) in *. cbn [lower_weights map form]. fold (lower_weights places Y v).
  rewrite quad_tcomb, quad_outer, dot_map, !dot_turned, dot_comb in q1. fold v in q1.
  set (s := dot (map (Y_value places) y) v) in *. rewrite sum_mapped in q1.
  rewrite (sum_equal _ ms _ (fun c => 2 * s * dot (fst c) v + - s ^ 2 * snd c)) in q1 by (intro c; unfold half; rewrite dot_turned, dot_map, dot_comb; fold v; fold s; field).
  rewrite sum_plus in q1. rewrite eA, eD. pose proof (pow2_ge_0 s). nra.
Qed.

(** Of a row at its border: where the first coordinate is z + t u_k. *)
Definition sheared (t : fixed) (s : list fixed) : list fixed :=
  match s with [] => [] | b :: r => b :: put_in zero k (add (mul bits t b) (nth k r zero)) r end.
Definition real_sheared (t : R) (s : list R) : list R := match s with [] => [] | b :: r => b :: put_in 0 k (t * b + nth k r 0) r end.
Definition bordered (t : fixed) (e : fixed) (a : list fixed) (start : triangle) : triangle :=
  let axis := put_in zero k t [] in
  (e :: put_in zero k (add (mul bits t e) (nth k a zero)) a) :: triangle_add start (outer_of axis (put_in zero k (add (halve (mul bits t e)) (nth k a zero)) a)).
Fixpoint upper_toward (r : list (varied fixed)) (start : triangle) : option triangle :=
  match r with
  | [] => Some start
  | ((a, e), cs) :: r' =>
      let a := turned a in
      let lessened := match cs with
        | [] => Some ((lower_end e :: a) :: start)
        | _ => if (0 <? lo e)%Z then
            let t := lower_end (neg (Arithmetic.ratio (nth k a zero) (one bits) e)) in
            less_changes bits (zero :: d) (sheared t (one bits :: map (fun _ => zero) a)) (map (fun c => sheared t (halve (snd c) :: turned (fst c))) cs) (bordered t (lower_end e) a start)
            else None
        end in
      match lessened with
      | Some t => match eliminated bits t with Some t => upper_toward r' t | None => None end
      | None => None
      end
  end.

Lemma place_in : forall x X, Forall2 contains x X -> contains (nth k x zero) (nth k X 0).
Proof. intros x X h. revert k. induction h; intros [| j]; cbn [nth]; auto using zero_sound. Qed.
Lemma sheared_sound : forall t T s X, contains t T -> Forall2 contains s X -> Forall2 contains (sheared t s) (real_sheared T X).
Proof.
  intros t T s X ht h. destruct h as [| b B s X hb h]; [constructor |]. cbn [sheared real_sheared]. constructor; [exact hb |].
  apply put_related; [| exact h]. apply add_sound; [apply mul_sound; assumption | apply place_in, h].
Qed.
Lemma dot_sheared : forall T b X z u, dot (real_sheared T (b :: X)) (z :: u) = b * (z + T * nth k u 0) + dot X u.
Proof. intros. cbn [real_sheared dot]. rewrite dot_put. ring. Qed.
Lemma bordered_sound : forall t T e E a A start S, contains t T -> contains e E -> Forall2 contains a A -> triangle_in bits start S ->
  exists U, triangle_in bits (bordered t e a start) U /\ forall z u, quad U (z :: u) = E * (z + T * nth k u 0) ^ 2 + 2 * (z + T * nth k u 0) * dot A u + quad S u.
Proof.
  intros t T e E a A start S ht he ha hS. pose proof (place_in a A ha) as hk. eexists. split.
  - unfold bordered. constructor; [constructor; [exact he | apply put_related; [apply add_sound; [apply mul_sound; [exact ht | exact he] | exact hk] | exact ha]] |].
    apply triangle_add_sound; [exact hS |]. apply outer_of_sound; apply put_related; [exact ht | constructor | apply add_sound; [apply halve_sound, mul_sound; [exact ht | exact he] | exact hk] | exact ha].
  - intros z u. cbn [quad row_form]. rewrite quad_tcomb, quad_outer, !dot_put.
    assert (N : nth k (@nil R) 0 = 0) by (destruct k; reflexivity). rewrite N. cbn [dot]. field.
Qed.

Lemma upper_toward_sound : forall i r start S T, Forall2 (varied_in bits) i r -> triangle_in bits start S -> upper_toward i start = Some T ->
  exists U, triangle_in bits T U /\ forall u z, quad U u <= quad S u + form (upper_weights z) r (stretched u).
Proof.
  intros i r start S T h. revert start S. induction h as [| [[a e] cs] [A D] i r [a0 [d0 [ms [ha [hd [hm [eA eD]]]]]]] h IH]; intros start S hS u.
  - injection u as <-. exists S. split; [exact hS |]. intros v [| t z]; cbn; lra.
  - cbn [upper_toward] in u. cbn [fst snd] in *. cbv zeta in u. destruct (lower_end_sound bits e d0 hd) as [g [hg le]].
    pose proof (turned_sound a a0 ha) as hA. set (at_ := turned a) in *.
    match type of u with match ?x with Some _ => _ | None => _ end = _ => destruct x as [t |] eqn:el; [| discriminate u] end.
    destruct (eliminated bits t) as [t2 |] eqn:e2; [| discriminate].
    assert (L : exists (tau : R) S1, triangle_in bits t S1 /\ forall z v, let y := z + tau * nth k v 0 in let x := stretched v in
      quad S1 (z :: v) <= g * y ^ 2 + 2 * y * dot a0 x + quad S v + sum_of ms (fun c => 2 * y * dot (fst c) x + y ^ 2 * snd c)).
    { destruct hm as [| c m cs ms hc hm].
      - injection el as <-. exists 0, ((g :: real_turned a0) :: S). split; [constructor; [constructor; assumption | exact hS] |].
        intros z v. cbv zeta. cbn [quad row_form sum_of fold_right]. rewrite dot_turned. lra.
      - destruct (0 <? lo e)%Z; [| discriminate]. set (tt := lower_end _) in *.
        assert (ht : exists tau, contains tt tau).
        { unfold tt, lower_end. eexists. apply point_sound. }
        destruct ht as [tau ht]. destruct (bordered_sound tt tau (lower_end e) g at_ (real_turned a0) start S ht hg hA hS) as [B [hB qB]].
        assert (hE : Forall2 contains (one bits :: map (fun _ => zero) at_) (1 :: map (fun _ => 0) at_)).
        { constructor; [apply integer_sound |]. clear. induction at_; cbn; constructor; auto using zero_sound. }
        assert (hC : Forall2 (fun s m => is_share (fst m) /\ Forall2 contains s (snd m)) (map (fun c => sheared tt (halve (snd c) :: turned (fst c))) (c :: cs))
          (map (fun m => (fst m, real_sheared tau (snd (snd m) / 2 :: real_turned (fst (snd m))))) (m :: ms))).
        { eapply map_related; [| exact (Forall2_cons c m hc hm)]. intros c' m' [h1 [h2 h3]]. cbn [fst snd]. split; [exact h1 |]. apply sheared_sound; [exact ht |].
          constructor; [apply halve_sound, h3 | apply turned_sound, h2]. }
        destruct (less_changes_sound bits _ _ _ _ _ _ _ _ el hB (sheared_sound tt tau _ _ ht hE) hC) as [S1 [h1 q]]. exists tau, S1. split; [exact h1 |]. intros z v. cbv zeta. specialize (q (z :: v)).
        rewrite (sum_mapped _ _ (m :: ms) (fun c => real_sheared tau (snd c / 2 :: real_turned (fst c)))), qB, dot_turned in q.
        set (y := z + tau * nth k v 0) in *. set (x := stretched v) in *.
        assert (Z0 : dot (real_sheared tau (1 :: map (fun _ => 0) at_)) (z :: v) = y).
        { rewrite dot_sheared. assert (N : forall (l : list fixed) v, dot (map (fun _ => 0) l) v = 0) by (induction l as [| p l I]; intros [| q' l']; cbn [map dot]; try reflexivity; rewrite I; ring). rewrite N. fold y. ring. }
        rewrite (sum_equal _ _ _ (fun c => 2 * y * dot (fst c) x + y ^ 2 * snd c)) in q by (intro c'; rewrite Z0, dot_sheared, dot_turned; fold y; fold x; field). exact q. }
    destruct L as [tau [S1 [h1 q1]]]. clear el. revert e2 q1. destruct h1 as [| row real t S1 hr h1]; intros e2 q1; [discriminate |]. revert e2 q1. destruct hr as [| b x row u' hb hr]; intros e2 q1; [discriminate |].
    destruct (eliminated_sound bits _ _ _ _ _ _ _ e2 hb hr h1) as [x0 h2]. destruct (IH _ _ h2 u) as [U [hU q]]. exists U. split; [exact hU |].
    intros v z.
    assert (K : forall y, quad S1 v - / x * dot u' v ^ 2 <= quad S v + (2 * y * dot A (stretched v) + y ^ 2 * D)).
    { intro y. specialize (q1 (y - tau * nth k v 0) v). cbv zeta in q1. replace (y - tau * nth k v 0 + tau * nth k v 0) with y in q1 by ring. set (o := y - tau * nth k v 0) in *.
      rewrite sum_plus in q1. cbn [quad row_form] in q1. rewrite eA, eD. set (n := dot u' v) in *.
      assert (0 <= / x * (x * o + n) ^ 2) by (apply Rmult_le_pos; [apply Rlt_le, Rinv_0_lt_compat, x0 | apply pow2_ge_0]).
      replace (/ x * (x * o + n) ^ 2) with (x * o ^ 2 + 2 * o * n + / x * n ^ 2) in * by (field; lra).
      assert (g * y ^ 2 <= d0 * y ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact le]). lra. }
    destruct z as [| y z]; cbn [upper_weights map form].
    + specialize (q v []). rewrite quad_schur in q by lra. specialize (K 0). cbn in q. cbn. lra.
    + specialize (q v z). rewrite quad_schur in q by lra. specialize (K y). fold (upper_weights z). lra.
Qed.
End Toward.
End Precision.
