(** * Slope arithmetic: a formula over a cell

    A point of the cell is x = c + sum_k lambda_k h_k e_k with lambda_k in
    [-1, 1].  A formula is carried by its value at c, its range, and slopes S
    with f(x) = f(c) + S . lambda; each operation rests on one identity, which
    stands in slope.rs. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Elbow Formula Linear Arithmetic.
Import ListNotations.
Local Open Scope R_scope.

Record slope := Slope { at_c : fixed; range : fixed; slopes : list fixed }.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation unit := (unit_R bits).
Local Notation mul := (mul bits).

(** ** Slopes *)

Section Cell.
Variable lambda : list R.
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.

(** [d] = f(x) - f(c) is spanned by slopes in [s]. *)
Definition spans (s : list fixed) (d : R) : Prop := exists u, Forall2 contains s u /\ d = dot u lambda.

Lemma spans_nil : spans [] 0.
Proof. exists []. split; [constructor | reflexivity]. Qed.

Lemma spans_map : forall f a s d, (forall i y, contains i y -> contains (f i) (a * y)) ->
  spans s d -> spans (map f s) (a * d).
Proof.
  intros f a s d hf [u [h ->]]. exists (map (Rmult a) u). rewrite dot_map. split; [| reflexivity].
  eapply map_related; [| exact h]. exact hf.
Qed.

Lemma spans_merge : forall f g fg a b s t d e,
  (forall i y, contains i y -> contains (f i) (a * y)) -> (forall j z, contains j z -> contains (g j) (b * z)) ->
  (forall i y j z, contains i y -> contains j z -> contains (fg i j) (a * y + b * z)) ->
  spans s d -> spans t e -> spans (merge f g fg s t) (a * d + b * e).
Proof.
  intros until e. intros hf hg hfg [u [h ->]] [v [k ->]]. exists (comb a b u v). rewrite dot_comb.
  split; [| reflexivity]. eapply merge_related; eauto.
Qed.

(** No point of the cell is further from the value at c than this. *)
Definition reach (s : list fixed) : Z := fold_right (fun a n => (magnitude a + n)%Z) 0%Z s.

Lemma reach_sound : forall s d, spans s d -> - IZR (reach s) <= d * unit <= IZR (reach s).
Proof.
  intros s d [u [h ->]]. revert lambda lambda_in. induction h as [| a x s u hx h IH]; intros l hl; cbn [reach fold_right].
  - cbn [dot]. lra.
  - fold (reach s). rewrite plus_IZR. destruct hl as [| t l ht hl]; cbn [dot].
    + specialize (IH [] (Forall_nil _)). destruct u; cbn [dot] in IH.
      all: pose proof (magnitude_sound bits a x 0 hx ltac:(lra)) as m; rewrite Rmult_0_r, Rmult_0_l in m; lra.
    + specialize (IH l hl). pose proof (magnitude_sound bits a x t hx ht). lra.
Qed.

(** ** Operations *)

(** [s] encloses values [vc] at c and [v] at x. *)
Definition holds (s : slope) (vc v : R) : Prop :=
  contains (at_c s) vc /\ contains (range s) v /\ spans (slopes s) (v - vc).

(** The range, cut by what the slopes say.  Both contain f(x), so that they meet;
    slopes from two identities may not be cut so: they are of different S. *)
Definition tight (c r : fixed) (s : list fixed) : slope :=
  let far := reach s in Slope c (Fixed (Z.max (lo r) (lo c - far)) (Z.min (hi r) (hi c + far))) s.

Lemma tight_sound : forall c r s vc v d, contains c vc -> contains r v -> spans s d -> d = v - vc -> holds (tight c r s) vc v.
Proof.
  intros c r s vc v d hc hr hs ->. split; [exact hc |]. split; [| exact hs].
  pose proof (reach_sound _ _ hs) as b. unfold tight, Fixed.contains in *. cbv zeta. cbn [range lo hi].
  destruct hc as [c1 c2], hr as [r1 r2]. split.
  - apply (Z.max_case (lo r) (lo c - reach s) (fun m => IZR m <= v * unit)); intros; subst; try assumption.
    rewrite minus_IZR. lra.
  - apply (Z.min_case (hi r) (hi c + reach s) (fun m => v * unit <= IZR m)); intros; subst; try assumption.
    rewrite plus_IZR. lra.
Qed.

Definition constant (a : fixed) : slope := Slope a a [].
Definition s_add (f g : slope) : slope :=
  tight (add (at_c f) (at_c g)) (add (range f) (range g)) (merge (fun a => a) (fun b => b) add (slopes f) (slopes g)).
Definition s_sub (f g : slope) : slope :=
  tight (sub (at_c f) (at_c g)) (sub (range f) (range g)) (merge (fun a => a) neg sub (slopes f) (slopes g)).
Definition s_neg (f : slope) : slope := Slope (neg (at_c f)) (neg (range f)) (map neg (slopes f)).
Definition s_mul (f g : slope) : slope :=
  let p := add (range g) (at_c g) in let q := add (range f) (at_c f) in
  tight (mul (at_c f) (at_c g)) (mul (range f) (range g))
    (merge (fun a => halve (mul p a)) (fun b => halve (mul q b)) (fun a b => halve (add (mul p a) (mul q b)))
       (slopes f) (slopes g)).
Definition s_sqr (f : slope) : slope :=
  tight (sqr bits (at_c f)) (sqr bits (range f)) (map (mul (add (range f) (at_c f))) (slopes f)).
Definition s_sqrt (f : slope) : option slope :=
  match Fixed.root bits (at_c f), Fixed.root bits (range f) with
  | Some a, Some b =>
      match recip bits (add b a) with Some k => Some (tight a b (map (mul k) (slopes f))) | None => None end
  | _, _ => None
  end.
Definition s_div (f g : slope) : option slope :=
  match recip bits (at_c g), recip bits (range g) with
  | Some a, Some b =>
      let q := mul (at_c f) a in
      Some (tight q (mul (range f) b)
             (map (mul b) (merge (fun s => s) (fun t => neg (mul q t)) (fun s t => sub s (mul q t)) (slopes f) (slopes g))))
  | _, _ => None
  end.

(** An elbow as it is written, and its slopes by the equations that it solves: those of slope.rs. *)
Definition lift {A : Type} (f : A -> option A) (a : option A) : option A := match a with Some x => f x | None => None end.
Definition s_crossing (a b t : slope) : option (slope * slope) :=
  let n := s_add (s_sqr a) (s_sqr b) in
  let q := s_sub (s_add n (constant (Fixed.integer bits 1))) t in
  let over := s_mul (constant (Fixed.integer bits 2)) n in
  match s_sqrt (s_sub (s_mul (constant (Fixed.integer bits 4)) n) (s_sqr q)) with
  | Some h =>
      match s_div (s_add (s_mul q a) (s_mul h b)) over, s_div (s_sub (s_mul q b) (s_mul h a)) over with
      | Some c, Some s => Some (c, s) | _, _ => None
      end
  | None => None
  end.
Definition s_mean (f : slope) : slope := tight (at_c f) (halve (add (range f) (at_c f))) (map halve (slopes f)).
Definition s_implicit (a b t : slope) (u : slope * slope) : option (slope * slope) :=
  let x := s_mean a in let y := s_mean b in let c := s_mean (fst u) in let s := s_mean (snd u) in
  match s_div (constant (Fixed.integer bits 1)) (s_sub (s_mul y c) (s_mul x s)) with
  | Some over =>
      let p := s_mul (s_sub x c) over in let q := s_mul (s_sub y s) over in
      let times f i := s_mul f (constant i) in
      let along := merge (times p) (times q) (fun i j => s_add (times p i) (times q j)) (slopes a) (slopes b) in
      let z := merge range (fun i => range (s_neg (times over (halve i)))) (fun l i => range (s_sub l (times over (halve i)))) along (slopes t) in
      Some (tight (at_c (fst u)) (range (fst u)) (map (mul (neg (range s))) z),
            tight (at_c (snd u)) (range (snd u)) (map (mul (range c)) z))
  | None => None
  end.
Definition s_elbow (a b t : slope) : option (slope * slope) :=
  lift (s_implicit a b t) (lift (s_implicit a b t) (s_crossing a b t)).

Lemma constant_holds : forall a v, contains a v -> holds (constant a) v v.
Proof. intros a v h. split; [exact h |]. split; [exact h |]. rewrite Rminus_diag_eq by reflexivity. apply spans_nil. Qed.

Lemma same : forall i y, contains i y -> contains i (1 * y).
Proof. intros. rewrite Rmult_1_l. assumption. Qed.

Lemma opposite : forall i y, contains i y -> contains (neg i) (-1 * y).
Proof. intros i y h. replace (-1 * y) with (- y) by ring. apply neg_sound, h. Qed.

Lemma s_add_holds : forall f g a b a' b', holds f a b -> holds g a' b' -> holds (s_add f g) (a + a') (b + b').
Proof.
  intros f g a b a' b' [h1 [h2 h3]] [k1 [k2 k3]].
  eapply tight_sound; [apply add_sound; assumption .. | apply (spans_merge _ _ _ 1 1 _ _ (b - a) (b' - a')) | ring]; try eassumption.
  - exact same. - exact same.
  - intros. rewrite !Rmult_1_l. apply add_sound; assumption.
Qed.

Lemma s_sub_holds : forall f g a b a' b', holds f a b -> holds g a' b' -> holds (s_sub f g) (a - a') (b - b').
Proof.
  intros f g a b a' b' [h1 [h2 h3]] [k1 [k2 k3]].
  eapply tight_sound; [apply sub_sound; assumption .. | apply (spans_merge _ _ _ 1 (-1) _ _ (b - a) (b' - a')) | ring]; try eassumption.
  - exact same. - exact opposite.
  - intros i y j z hi hj. replace (1 * y + -1 * z) with (y - z) by ring. apply sub_sound; assumption.
Qed.

Lemma s_neg_holds : forall f a b, holds f a b -> holds (s_neg f) (- a) (- b).
Proof.
  intros f a b [h1 [h2 h3]]. split; [| split]; try (apply neg_sound; assumption).
  replace (- b - - a) with (-1 * (b - a)) by ring. apply spans_map; [exact opposite | assumption].
Qed.

Lemma s_mul_holds : forall f g a b a' b', holds f a b -> holds g a' b' -> holds (s_mul f g) (a * a') (b * b').
Proof.
  intros f g a b a' b' [h1 [h2 h3]] [k1 [k2 k3]].
  assert (p : contains (add (range g) (at_c g)) (b' + a')) by (apply add_sound; assumption).
  assert (q : contains (add (range f) (at_c f)) (b + a)) by (apply add_sound; assumption).
  eapply tight_sound; [apply mul_sound; assumption .. | apply (spans_merge _ _ _ ((b' + a') / 2) ((b + a) / 2) _ _ (b - a) (b' - a')) | field];
    try eassumption.
  - intros i y hi. replace ((b' + a') / 2 * y) with ((b' + a') * y / 2) by field. apply halve_sound, mul_sound; assumption.
  - intros i y hi. replace ((b + a) / 2 * y) with ((b + a) * y / 2) by field. apply halve_sound, mul_sound; assumption.
  - intros i y j z hi hj. replace (_ + _) with (((b' + a') * y + (b + a) * z) / 2) by field.
    apply halve_sound, add_sound; apply mul_sound; assumption.
Qed.

Lemma s_sqr_holds : forall f a b, holds f a b -> holds (s_sqr f) (a ^ 2) (b ^ 2).
Proof.
  intros f a b [h1 [h2 h3]].
  eapply tight_sound; [apply sqr_sound; assumption .. | apply (spans_map _ (b + a) _ (b - a)) | ring]; try eassumption.
  intros. apply mul_sound; [apply add_sound |]; assumption.
Qed.

Lemma s_sqrt_holds : forall f s a b, s_sqrt f = Some s -> holds f a b -> 0 < a /\ 0 < b /\ holds s (sqrt a) (sqrt b).
Proof.
  intros f s a b e [h1 [h2 h3]]. unfold s_sqrt in e.
  destruct (Fixed.root bits (at_c f)) as [i |] eqn:r1; [| discriminate].
  destruct (Fixed.root bits (range f)) as [j |] eqn:r2; [| discriminate].
  destruct (recip bits (add j i)) as [k |] eqn:r3; [| discriminate]. injection e as <-.
  destruct (root_sound _ _ _ _ r1 h1) as [a0 [sa hi]]. destruct (root_sound _ _ _ _ r2 h2) as [b0 [sb hj]].
  destruct (recip_sound _ _ _ _ r3 (add_sound _ _ _ _ _ hj hi)) as [_ hk].
  split; [exact a0 |]. split; [exact b0 |].
  eapply tight_sound; [assumption .. | apply (spans_map _ (/ (sqrt b + sqrt a)) _ (b - a)) |]; try eassumption.
  - intros. apply mul_sound; assumption.
  - pose proof (sqrt_sqrt a (Rlt_le _ _ a0)) as ea. pose proof (sqrt_sqrt b (Rlt_le _ _ b0)) as eb.
    replace (b - a) with ((sqrt b + sqrt a) * (sqrt b - sqrt a)) by lra. field. lra.
Qed.

Lemma s_div_holds : forall f g s a b a' b', s_div f g = Some s -> holds f a b -> holds g a' b' ->
  a' <> 0 /\ b' <> 0 /\ holds s (a / a') (b / b').
Proof.
  intros f g s a b a' b' e [h1 [h2 h3]] [k1 [k2 k3]]. unfold s_div in e.
  destruct (recip bits (at_c g)) as [i |] eqn:r1; [| discriminate].
  destruct (recip bits (range g)) as [j |] eqn:r2; [| discriminate]. cbn zeta in e. injection e as <-.
  destruct (recip_sound _ _ _ _ r1 k1) as [a0 hi]. destruct (recip_sound _ _ _ _ r2 k2) as [b0 hj].
  split; [exact a0 |]. split; [exact b0 |].
  assert (q : contains (mul (at_c f) i) (a / a')) by (apply mul_sound; assumption).
  eapply tight_sound; [exact q | apply mul_sound; eassumption | apply (spans_map _ (/ b') _ (1 * (b - a) + - (a / a') * (b' - a'))) |].
  - intros. apply mul_sound; assumption.
  - apply (spans_merge _ _ _ 1 (- (a / a'))); try assumption.
    + exact same.
    + intros. rewrite Ropp_mult_distr_l_reverse. apply neg_sound, mul_sound; assumption.
    + intros. replace (_ + _) with (y - a / a' * z) by ring. apply sub_sound; [| apply mul_sound]; assumption.
  - field. split; assumption.
Qed.

Lemma s_crossing_holds : forall a b t u ac ax bc bx tc tx, s_crossing a b t = Some u ->
  holds a ac ax -> holds b bc bx -> holds t tc tx ->
  0 < elbow_radicand ac bc tc /\ 0 < elbow_radicand ax bx tx /\
  holds (fst u) (fst (elbow ac bc tc)) (fst (elbow ax bx tx)) /\ holds (snd u) (snd (elbow ac bc tc)) (snd (elbow ax bx tx)).
Proof.
  intros a b t u ac ax bc bx tc tx e ha hb ht. unfold s_crossing in e.
  assert (C : forall n, holds (constant (Fixed.integer bits n)) (IZR n) (IZR n)) by (intro; apply constant_holds, integer_sound).
  set (n := s_add (s_sqr a) (s_sqr b)) in *. set (q := s_sub (s_add n (constant (Fixed.integer bits 1))) t) in *.
  assert (hn : holds n (ac ^ 2 + bc ^ 2) (ax ^ 2 + bx ^ 2)) by (apply s_add_holds; apply s_sqr_holds; assumption).
  assert (hq : holds q (ac ^ 2 + bc ^ 2 + 1 - tc) (ax ^ 2 + bx ^ 2 + 1 - tx)) by (apply s_sub_holds; [apply s_add_holds; [exact hn | apply C] | exact ht]).
  destruct (s_sqrt _) as [h |] eqn:eh; [| discriminate].
  destruct (s_sqrt_holds _ _ (elbow_radicand ac bc tc) (elbow_radicand ax bx tx) eh) as [rc [rx hh]].
  { apply s_sub_holds; [apply s_mul_holds; [apply C | exact hn] | apply s_sqr_holds, hq]. }
  destruct (s_div (s_add _ _) _) as [c |] eqn:ec; [| discriminate]. destruct (s_div (s_sub _ _) _) as [s |] eqn:es; [| discriminate]. injection e as <-.
  split; [exact rc |]. split; [exact rx |]. cbn [fst snd].
  split; [refine (proj2 (proj2 (s_div_holds _ _ _ _ _ _ _ ec _ _))) | refine (proj2 (proj2 (s_div_holds _ _ _ _ _ _ _ es _ _)))];
    try (apply s_mul_holds; [apply C | exact hn]); [apply s_add_holds | apply s_sub_holds]; apply s_mul_holds; assumption.
Qed.

Lemma s_mean_holds : forall f c v, holds f c v -> holds (s_mean f) c ((v + c) / 2).
Proof.
  intros f c v [h1 [h2 h3]]. eapply tight_sound; [exact h1 | apply halve_sound, add_sound; assumption | apply (spans_map _ (/ 2) _ (v - c)); [| exact h3] | field].
  intros i y hi. replace (/ 2 * y) with (y / 2) by field. apply halve_sound, hi.
Qed.

Lemma s_implicit_holds : forall a b t u u' ac ax bc bx tc tx, s_implicit a b t u = Some u' ->
  0 < elbow_radicand ac bc tc -> 0 < elbow_radicand ax bx tx -> holds a ac ax -> holds b bc bx -> holds t tc tx ->
  holds (fst u) (fst (elbow ac bc tc)) (fst (elbow ax bx tx)) -> holds (snd u) (snd (elbow ac bc tc)) (snd (elbow ax bx tx)) ->
  holds (fst u') (fst (elbow ac bc tc)) (fst (elbow ax bx tx)) /\ holds (snd u') (snd (elbow ac bc tc)) (snd (elbow ax bx tx)).
Proof.
  intros a b t u u' ac ax bc bx tc tx e rc rx ha hb ht hc hs. unfold s_implicit in e. cbv zeta in e. pose proof (elbow_moves ac bc tc ax bx tx rc rx) as M.
  destruct (elbow ac bc tc) as [cc sc], (elbow ax bx tx) as [cx sx]. cbn [fst snd] in *. cbv zeta in M.
  pose proof (s_mean_holds _ _ _ ha) as hx. pose proof (s_mean_holds _ _ _ hb) as hy. pose proof (s_mean_holds _ _ _ hc) as hp. pose proof (s_mean_holds _ _ _ hs) as hq.
  set (x := s_mean a) in *. set (y := s_mean b) in *. set (c := s_mean (fst u)) in *. set (s := s_mean (snd u)) in *.
  set (vx := (ax + ac) / 2) in *. set (vy := (bx + bc) / 2) in *. set (vc := (cx + cc) / 2) in *. set (vs := (sx + sc) / 2) in *.
  destruct (s_div _ _) as [over |] eqn:eo; [| discriminate]. injection e as <-. cbn [fst snd].
  destruct (s_div_holds _ _ _ 1 1 (bc * cc - ac * sc) (vy * vc - vx * vs) eo) as [_ [d0 ho]];
    [apply constant_holds, integer_sound | apply s_sub_holds; apply s_mul_holds; assumption |].
  assert (hP := s_mul_holds _ _ _ _ _ _ (s_sub_holds _ _ _ _ _ _ hx hp) ho). assert (hQ := s_mul_holds _ _ _ _ _ _ (s_sub_holds _ _ _ _ _ _ hy hq) ho).
  set (p := s_mul (s_sub x c) over) in *. set (q := s_mul (s_sub y s) over) in *. set (D := vy * vc - vx * vs) in *.
  assert (T : forall f k v i z, holds f k v -> contains i z -> holds (s_mul f (constant i)) (k * z) (v * z))
    by (intros; apply s_mul_holds; [assumption | apply constant_holds; assumption]).
  destruct ha as [_ [_ [ua [ka ea]]]], hb as [_ [_ [ub [kb eb]]]], ht as [_ [_ [ut [kt et]]]].
  set (al := merge _ _ _ (slopes a) (slopes b)). set (zs := merge _ _ _ al (slopes t)).
  set (P := (vx - vc) * (1 / D)) in *. set (Q := (vy - vs) * (1 / D)) in *. set (O := 1 / D) in *.
  assert (A : Forall2 (fun f v => exists k, holds f k v) al (comb P Q ua ub)).
  { unfold al, comb. eapply merge_related; [| | | exact ka | exact kb].
    - intros i z h. eexists. apply T; eassumption.
    - intros i z h. eexists. apply T; eassumption.
    - intros i z j v h k. eexists. apply s_add_holds; apply T; eassumption. }
  assert (Z : spans zs (P * (ax - ac) + Q * (bx - bc) - O * ((tx - tc) / 2))).
  { exists (comb 1 (- (O / 2)) (comb P Q ua ub) ut). split; [| rewrite !dot_comb, <- ea, <- eb, <- et; field].
    unfold zs. unfold comb at 1. eapply merge_related; [| | | exact A | exact kt].
    - intros f v [k [_ [h _]]]. rewrite Rmult_1_l. exact h.
    - intros i z h. replace (- (O / 2) * z) with (- (O * (z / 2))) by field. pose proof (s_neg_holds _ _ _ (T _ _ _ _ _ ho (halve_sound _ _ _ h))) as [_ [R _]]. exact R.
    - intros f v i z [k hf] h. replace (1 * v + - (O / 2) * z) with (v - O * (z / 2)) by field.
      pose proof (s_sub_holds _ _ _ _ _ _ hf (T _ _ _ _ _ ho (halve_sound _ _ _ h))) as [_ [R _]]. exact R. }
  assert (E : P * (ax - ac) + Q * (bx - bc) - O * ((tx - tc) / 2) = ((vx - vc) * (ax - ac) + (vy - vs) * (bx - bc) - (tx - tc) / 2) / D)
    by (unfold P, Q, O; field; exact d0). rewrite E in Z. destruct M as [M1 M2]. set (w := (vx - vc) * (ax - ac) + (vy - vs) * (bx - bc) - (tx - tc) / 2) in *.
  destruct hc as [c1 [c2 _]], hs as [s1 [s2 _]], hp as [_ [p2 _]], hq as [_ [q2 _]]. split.
  - eapply tight_sound; [exact c1 | exact c2 | apply (spans_map _ (- vs) _ (w / D)); [| exact Z] |].
    + intros. apply mul_sound; [apply neg_sound, q2 | assumption].
    + apply Rmult_eq_reg_l with D; [rewrite M1; field; exact d0 | exact d0].
  - eapply tight_sound; [exact s1 | exact s2 | apply (spans_map _ vc _ (w / D)); [| exact Z] |].
    + intros. apply mul_sound; assumption.
    + apply Rmult_eq_reg_l with D; [rewrite M2; field; exact d0 | exact d0].
Qed.

Lemma s_elbow_holds : forall a b t u ac ax bc bx tc tx, s_elbow a b t = Some u -> holds a ac ax -> holds b bc bx -> holds t tc tx ->
  0 < elbow_radicand ac bc tc /\ 0 < elbow_radicand ax bx tx /\
  holds (fst u) (fst (elbow ac bc tc)) (fst (elbow ax bx tx)) /\ holds (snd u) (snd (elbow ac bc tc)) (snd (elbow ax bx tx)).
Proof.
  intros a b t u ac ax bc bx tc tx e ha hb ht. unfold s_elbow in e. destruct (s_crossing a b t) as [u0 |] eqn:e0; [| discriminate]. cbn [lift] in e.
  destruct (s_crossing_holds _ _ _ _ _ _ _ _ _ _ e0 ha hb ht) as [rc [rx [c0 s0]]]. destruct (s_implicit a b t u0) as [u1 |] eqn:e1; [| discriminate]. cbn [lift] in e.
  destruct (s_implicit_holds _ _ _ _ _ _ _ _ _ _ _ e1 rc rx ha hb ht c0 s0) as [c1 s1]. split; [exact rc |]. split; [exact rx |].
  exact (s_implicit_holds _ _ _ _ _ _ _ _ _ _ _ e rc rx ha hb ht c1 s1).
Qed.

(** ** Tapes: an entry that is undefined, or depends on one, is [None] *)

Variables xs cs theta : list R.
Variables coords params : list slope.
Let none := constant zero.
Hypothesis coords_hold : forall k, holds (nth k coords none) (nth k cs 0) (nth k xs 0).
Hypothesis params_hold : forall j, holds (nth j params none) (nth j theta 0) (nth j theta 0).

Definition lift2 {A : Type} (f : A -> A -> option A) (a b : option A) : option A :=
  match a, b with Some x, Some y => f x y | _, _ => None end.

Definition slope_op (o : op (option slope)) : option slope :=
  match o with
  | Coord k => Some (nth k coords none) | Param j => Some (nth j params none)
  | Integer n => Some (constant (Fixed.integer bits n))
  | Add f g => lift2 (fun f g => Some (s_add f g)) f g | Sub f g => lift2 (fun f g => Some (s_sub f g)) f g
  | Mul f g => lift2 (fun f g => Some (s_mul f g)) f g | Div f g => lift2 s_div f g
  | Sqr f => lift (fun f => Some (s_sqr f)) f | Sqrt f => lift s_sqrt f | Neg f => lift (fun f => Some (s_neg f)) f
  | Elbow second a b t =>
      match a, b, t with Some a, Some b, Some t => option_map (if second then snd else fst) (s_elbow a b t) | _, _, _ => None end
  end.

(** The formula [e] is defined and differentiable at c and x, and enclosed. *)
Definition enclosed (s : slope) (e : formula) : Prop :=
  defined cs theta e /\ defined xs theta e /\ holds s (value cs theta e) (value xs theta e).
Definition encloses (s : option slope) (e : formula) : Prop := match s with Some s => enclosed s e | None => True end.

Lemma lift_sound : forall f a e e', encloses a e -> (forall s s', f s = Some s' -> enclosed s e -> enclosed s' e') ->
  encloses (lift f a) e'.
Proof.
  intros f [s |] e e' h H; cbn [lift]; [| exact I]. destruct (f s) as [s' |] eqn:E; [exact (H s s' E h) | exact I].
Qed.

Lemma lift2_sound : forall f a b d e e', encloses a d -> encloses b e ->
  (forall s t s', f s t = Some s' -> enclosed s d -> enclosed t e -> enclosed s' e') -> encloses (lift2 f a b) e'.
Proof.
  intros f [s |] [t |] d e e' h k H; cbn [lift2]; try exact I.
  destruct (f s t) as [s' |] eqn:E; [exact (H s t s' E h k) | exact I].
Qed.

Local Ltac binary a b lemma :=
  match goal with h : forall i, encloses _ _ |- _ => apply (lift2_sound _ _ _ _ _ _ (h a) (h b)) end;
  intros s t s' E [? [? ?]] [? [? ?]]; injection E as <-; unfold enclosed;
  cbn [defined value map_op defined_op all_op real_op]; auto 10 using lemma.
Local Ltac unary a lemma :=
  match goal with h : forall i, encloses _ _ |- _ => apply (lift_sound _ _ _ _ (h a)) end;
  intros s s' E [? [? ?]]; injection E as <-; unfold enclosed;
  cbn [defined value map_op defined_op all_op real_op]; auto 10 using lemma.

Lemma slope_op_sound : forall (A : Type) (o : op A) f g, (forall i, encloses (f i) (g i)) ->
  encloses (slope_op (map_op f o)) (F (map_op g o)).
Proof.
  intros A o f g h. destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [map_op slope_op].
  - unfold encloses, enclosed. cbn. auto using coords_hold.
  - unfold encloses, enclosed. cbn. auto using params_hold.
  - unfold encloses, enclosed. cbn. auto using constant_holds, integer_sound.
  - binary a b s_add_holds.
  - binary a b s_sub_holds.
  - unary a s_neg_holds.
  - binary a b s_mul_holds.
  - apply (lift2_sound _ _ _ _ _ _ (h a) (h b)). intros s t s' E [? [? p]] [? [? q]].
    destruct (s_div_holds _ _ _ _ _ _ _ E p q) as [? [? ?]]. unfold enclosed.
    cbn [defined value map_op defined_op all_op real_op]. auto 10.
  - unary a s_sqr_holds.
  - apply (lift_sound _ _ _ _ (h a)). intros s s' E [? [? p]].
    destruct (s_sqrt_holds _ _ _ _ E p) as [? [? ?]]. unfold enclosed.
    cbn [defined value map_op defined_op all_op real_op]. auto 10.
  - pose proof (h a) as pa. pose proof (h b) as pb. pose proof (h t) as pt. unfold encloses in pa, pb, pt.
    destruct (f a) as [sa |], (f b) as [sb |], (f t) as [st |]; try exact I.
    destruct (s_elbow sa sb st) as [u |] eqn:E; cbn [option_map]; [| exact I]. destruct pa as [? [? pa]], pb as [? [? pb]], pt as [? [? pt]].
    destruct (s_elbow_holds _ _ _ _ _ _ _ _ _ _ E pa pb pt) as [? [? [? ?]]]. unfold encloses, enclosed.
    cbn [defined value map_op defined_op all_op real_op]. destruct second; auto 10.
Qed.

(** Soundness: what the tape evaluates to over a cell encloses its formulas there. *)
Theorem evaluate_sound : forall tape,
  Forall2 encloses (run (option slope) None slope_op tape) (formulas tape).
Proof.
  intro tape. apply (run_related (option slope) formula None (integer 0) slope_op F encloses); [exact I | exact (slope_op_sound address)].
Qed.


Theorem evaluate_kept_sound : forall keep tape, Forall2 encloses (run_kept (option slope) None slope_op keep tape) (formulas tape).
Proof.
  intros keep tape. apply (run_kept_related (option slope) formula None (integer 0) slope_op F encloses);
    [exact I | exact (slope_op_sound address) | intro; exact I].
Qed.

End Cell.
End Precision.
