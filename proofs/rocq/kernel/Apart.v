(** * Two segments farther from each other than a distance

    With [g] affine on the cell, evidence, and for each end p of the one segment and each
    end q of the other g . (p - q) > R |g| at the vertices, the segments are farther apart
    than R: for a fixed unit vector u along g(x), g . (p - q) - R (u . g) is affine in lambda,
    and at the vertices no less than g . (p - q) - R |g|; so it is positive at x. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope Definite Test.
Import ListNotations.
Local Open Scope R_scope.

(** Three of a kind: the components of a vector. *)
Record spatial (A : Type) := Spatial { along_x : A; along_y : A; along_z : A }.
Arguments Spatial {A}. Arguments along_x {A}. Arguments along_y {A}. Arguments along_z {A}.
Definition each {A B : Type} (f : A -> B) (u : spatial A) : spatial B := Spatial (f (along_x u)) (f (along_y u)) (f (along_z u)).
Definition both {A B C : Type} (f : A -> B -> C) (u : spatial A) (v : spatial B) : spatial C :=
  Spatial (f (along_x u) (along_x v)) (f (along_y u) (along_y v)) (f (along_z u) (along_z v)).
Definition inner (u v : spatial R) : R := along_x u * along_x v + along_y u * along_y v + along_z u * along_z v.

(** The point between two ends. *)
Definition between (t : R) (p q : spatial R) : spatial R := both (fun a b => (1 - t) * a + t * b) p q.
Definition away (p q : spatial R) : spatial R := both Rminus p q.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation mul := (mul bits).

(** [n_0 + sum_k lambda_k n_k], over [2^places]. *)
Definition affine (places : N) (row : list Z) : slope :=
  let entry n := Arithmetic.dyadic n places (Fixed.integer bits 1) in
  match row with
  | n :: ns => let s := map entry ns in let c := entry n in Slope c (Fixed (lo c - reach s) (hi c + reach s)) s
  | [] => constant zero
  end.

(** The upper end of the root of the upper end. *)
Definition greatest_root (a : fixed) : fixed :=
  match root bits (Fixed (hi a) (hi a)) with Some b => Fixed (hi b) (hi b) | None => Fixed (hi a) (hi a) end.

Definition scalar (g d : spatial slope) : slope :=
  let m := both (s_mul bits) g d in
  s_add (s_add (s_add (constant (Fixed.integer bits 0)) (along_x m)) (along_y m)) (along_z m).

Definition size_there (s : list bool) (g : spatial slope) : fixed :=
  let q := each (fun g => sqr bits (at_vertex s g)) g in
  greatest_root (add (add (add (Fixed.integer bits 0) (along_x q)) (along_y q)) (along_z q)).

(** Of one end of each; [less] as in Check.v. *)
Definition is_beyond (m : nat) (less : option slope) (distance : fixed) (g p q : spatial slope) : bool :=
  let f := scalar g (both s_sub p q) in
  forallb (fun s =>
    let rest := sub (at_vertex s f) (mul distance (size_there s g)) in
    (0 <? lo match less with Some t => sub rest (at_vertex s t) | None => rest end)%Z) (signs m).

Definition are_apart (m : nat) (less : option slope) (distance : fixed) (places : N) (Y : list (list Z)) (p p' q q' : spatial slope) : bool :=
  match Y with
  | [a; b; c] =>
      let g := each (affine places) (Spatial a b c) in
      forallb (fun row => Nat.eqb (length row) (S m)) Y &&
      is_beyond m less distance g p q && is_beyond m less distance g p q' && is_beyond m less distance g p' q && is_beyond m less distance g p' q'
  | _ => false
  end.

(** ** Soundness *)

Lemma inner_cauchy : forall u v, inner u v ^ 2 <= inner u u * inner v v.
Proof.
  intros [a b c] [d e f]. unfold inner. cbn [along_x along_y along_z].
  pose proof (pow2_ge_0 (a * e - b * d)). pose proof (pow2_ge_0 (a * f - c * d)). pose proof (pow2_ge_0 (b * f - c * e)). nra.
Qed.

Lemma inner_nonneg : forall u, 0 <= inner u u.
Proof. intros [a b c]. unfold inner. cbn [along_x along_y along_z]. nra. Qed.

Lemma greatest_root_sound : forall a x y, contains a x -> y ^ 2 <= x -> exists z, y <= z /\ 0 <= z /\ contains (greatest_root a) z.
Proof.
  intros a x y [_ h] le. pose proof (unit_R_pos bits) as u0. set (w := IZR (hi a) / unit_R bits).
  assert (W : contains (Fixed (hi a) (hi a)) w) by (unfold w, Fixed.contains; cbn [lo hi]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
  assert (xw : x <= w) by (unfold w; apply Rmult_le_reg_r with (unit_R bits); [exact u0 |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
  pose proof (pow2_ge_0 y) as y0. unfold greatest_root. destruct (root bits (Fixed (hi a) (hi a))) as [b |] eqn:e.
  - destruct (root_sound bits _ _ _ e W) as [w0 [_ [_ k]]]. exists (IZR (hi b) / unit_R bits).
    assert (S : sqrt w <= IZR (hi b) / unit_R bits)
      by (apply Rmult_le_reg_r with (unit_R bits); [exact u0 |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
    pose proof (sqrt_pos w). split; [| split; [lra |]].
    + apply Rle_trans with (Rabs y); [apply Rle_abs |]. apply Rle_trans with (sqrt w); [| exact S].
      rewrite <- sqrt_Rsqr_abs. apply sqrt_le_1_alt. rewrite Rsqr_pow2. lra.
    + unfold Fixed.contains. cbn [lo hi]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
  - (* no root: then the upper end is 0 *)
    unfold root in e. cbn [lo] in e. destruct (0 <? hi a)%Z eqn:p; [discriminate |]. apply Z.ltb_ge, IZR_le in p.
    assert (w <= 0) by (unfold w; apply Rmult_le_reg_r with (unit_R bits); [exact u0 |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
    exists w. assert (w = 0) by lra. split; [nra | split; [lra | exact W]].
Qed.

Section Cell.
Variable lambda : list R.
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.

(** A slope for a value at x, with the value at c forgotten. *)
Definition stands (s : slope) (v : R) : Prop := exists vc, Slope.holds bits lambda s vc v.

Lemma stands_entry : forall s v, stands s v -> exists e, entry_in bits s e /\ at_lambda lambda e = v.
Proof.
  intros s v [vc [h1 [_ [u [h2 h3]]]]]. exists (vc, u). split; [split; assumption |]. unfold at_lambda. cbn [fst snd]. lra.
Qed.

Lemma affine_stands : forall places row, exists v, stands (affine places row) v.
Proof.
  intros places [| n ns]; [exists 0, 0; apply constant_holds, zero_sound |].
  assert (E : forall n, contains (Arithmetic.dyadic n places (Fixed.integer bits 1)) (IZR n / IZR (2 ^ Z.of_N places) * 1))
    by (intros; apply Arithmetic.dyadic_sound, Fixed.integer_sound).
  set (u := map (fun n => IZR n / IZR (2 ^ Z.of_N places) * 1) ns).
  assert (U : Forall2 contains (map (fun n => Arithmetic.dyadic n places (Fixed.integer bits 1)) ns) u) by (unfold u; induction ns; constructor; auto).
  set (y := IZR n / IZR (2 ^ Z.of_N places) * 1). exists (y + dot u lambda), y. split; [apply E |].
  assert (S : spans bits lambda (map (fun n => Arithmetic.dyadic n places (Fixed.integer bits 1)) ns) (y + dot u lambda - y))
    by (exists u; split; [exact U | ring]).
  split; [| exact S]. pose proof (reach_sound bits lambda lambda_in _ _ S) as r. pose proof (E n) as [a b]. fold y in a, b.
  unfold affine, Fixed.contains. cbn [range lo hi]. rewrite minus_IZR, plus_IZR. lra.
Qed.

Lemma scalar_stands : forall g d gv dv, stands (along_x g) (along_x gv) -> stands (along_y g) (along_y gv) -> stands (along_z g) (along_z gv) ->
  stands (along_x d) (along_x dv) -> stands (along_y d) (along_y dv) -> stands (along_z d) (along_z dv) -> stands (scalar g d) (inner gv dv).
Proof.
  intros g d gv dv [a1 g1] [a2 g2] [a3 g3] [b1 d1] [b2 d2] [b3 d3]. unfold scalar, inner, both. cbn [along_x along_y along_z].
  exists (0 + a1 * b1 + a2 * b2 + a3 * b3).
  replace (along_x gv * along_x dv + along_y gv * along_y dv + along_z gv * along_z dv)
    with (0 + along_x gv * along_x dv + along_y gv * along_y dv + along_z gv * along_z dv) by ring.
  repeat apply s_add_holds; try assumption; try (apply s_mul_holds; assumption). apply constant_holds, Fixed.integer_sound.
Qed.

Lemma sub_stands : forall p q a b, stands p a -> stands q b -> stands (s_sub p q) (a - b).
Proof. intros p q a b [x h] [y k]. exists (x - y). apply s_sub_holds; assumption. Qed.

Definition all_stand (s : spatial slope) (v : spatial R) : Prop :=
  stands (along_x s) (along_x v) /\ stands (along_y s) (along_y v) /\ stands (along_z s) (along_z v).

Lemma is_beyond_sound : forall less distance d g p q gv pv qv, is_beyond (length lambda) less distance g p q = true ->
  match less with Some t => exists e, entry_in bits t e /\ 0 <= at_lambda lambda e | None => True end ->
  contains distance d -> 0 <= d -> all_stand g gv -> all_stand p pv -> all_stand q qv ->
  d * sqrt (inner gv gv) < inner gv (away pv qv).
Proof.
  intros less distance d g p q gv pv qv h hl hd d0 [g1 [g2 g3]] [p1 [p2 p3]] [q1 [q2 q3]].
  assert (F : stands (scalar g (both s_sub p q)) (inner gv (away pv qv))) by (apply scalar_stands; try assumption; apply sub_stands; assumption).
  destruct (stands_entry _ _ F) as [ef [f1 f2]]. destruct (stands_entry _ _ g1) as [e1 [k1 l1]].
  destruct (stands_entry _ _ g2) as [e2 [k2 l2]]. destruct (stands_entry _ _ g3) as [e3 [k3 l3]].
  assert (T : exists et, 0 <= at_lambda lambda et /\ match less with Some t => entry_in bits t et | None => et = (0, []) end).
  { destruct less as [t |]; [destruct hl as [et [t1 t2]]; exists et; auto |]. exists (0, []). split; [unfold at_lambda; cbn; lra | reflexivity]. }
  destruct T as [et [t0 ht]].
  (* u: along g(x) *)
  set (n := sqrt (inner gv gv)). pose proof (sqrt_pos (inner gv gv)) as n0. fold n in n0. pose proof (inner_nonneg gv) as i0.
  assert (nn : n * n = inner gv gv) by (apply sqrt_sqrt, i0).
  assert (U : exists u, inner u gv = n /\ inner u u <= 1).
  { destruct (Req_dec n 0) as [z | z].
    - exists (Spatial 0 0 0). unfold inner. cbn [along_x along_y along_z]. rewrite z. split; lra.
    - exists (each (Rmult (/ n)) gv). unfold inner in *. cbn [each along_x along_y along_z].
      split; apply Rmult_eq_reg_l with (n * n) || apply Rmult_le_reg_l with (n * n); try nra.
      + replace (n * n * (/ n * along_x gv * along_x gv + / n * along_y gv * along_y gv + / n * along_z gv * along_z gv))
          with (n * (along_x gv * along_x gv + along_y gv * along_y gv + along_z gv * along_z gv)) by (field; exact z). rewrite <- nn. ring.
      + replace (n * n * (/ n * along_x gv * (/ n * along_x gv) + / n * along_y gv * (/ n * along_y gv) + / n * along_z gv * (/ n * along_z gv)))
          with (along_x gv * along_x gv + along_y gv * along_y gv + along_z gv * along_z gv) by (field; exact z). lra. }
  destruct U as [u [u1 u2]].
  set (h_ := fun l => at_lambda l ef - at_lambda l et - d * (along_x u * at_lambda l e1 + along_y u * at_lambda l e2 + along_z u * at_lambda l e3)).
  assert (P : 0 < h_ lambda).
  { apply (vertices_decide lambda h_ lambda_in).
    - intros before t after. unfold h_. rewrite (at_lambda_affine before t after ef), (at_lambda_affine before t after et),
        (at_lambda_affine before t after e1), (at_lambda_affine before t after e2), (at_lambda_affine before t after e3). field.
    - intros s es. unfold is_beyond in h. rewrite forallb_forall in h. specialize (h s). rewrite <- es in h. specialize (h (signs_all s)).
      pose proof (at_vertex_sound bits s _ _ f1) as V.
      pose proof (at_vertex_sound bits s _ _ k1) as V1. pose proof (at_vertex_sound bits s _ _ k2) as V2. pose proof (at_vertex_sound bits s _ _ k3) as V3.
      set (l := map corner s) in *. set (w := Spatial (at_lambda l e1) (at_lambda l e2) (at_lambda l e3)).
      assert (Sq : contains (add (add (add (Fixed.integer bits 0) (sqr bits (at_vertex s (along_x g)))) (sqr bits (at_vertex s (along_y g)))) (sqr bits (at_vertex s (along_z g)))) (inner w w)).
      { replace (inner w w) with (0 + at_lambda l e1 ^ 2 + at_lambda l e2 ^ 2 + at_lambda l e3 ^ 2) by (unfold inner, w; cbn [along_x along_y along_z]; ring).
        repeat apply add_sound; try (apply sqr_sound; assumption). apply Fixed.integer_sound. }
      assert (C : inner u w ^ 2 <= inner w w).
      { pose proof (inner_cauchy u w) as c. pose proof (inner_nonneg w). nra. }
      destruct (greatest_root_sound _ _ _ Sq C) as [z [z1 [z0 z2]]].
      pose proof (mul_sound bits _ _ _ _ hd z2) as M. pose proof (sub_sound bits _ _ _ _ V M) as R1.
      assert (R2 : 0 < at_lambda l ef - d * z - at_lambda l et).
      { destruct less as [t |].
        - apply Z.ltb_lt in h. exact (contains_positive bits _ _ h (sub_sound bits _ _ _ _ R1 (at_vertex_sound bits s _ _ ht))).
        - subst et. replace (at_lambda l (0, [])) with 0 by (unfold at_lambda; cbn; ring). apply Z.ltb_lt in h.
          pose proof (contains_positive bits _ _ h R1). lra. }
      unfold h_. assert (d * inner u w <= d * z) by (apply Rmult_le_compat_l; assumption).
      unfold inner, w in *. cbn [along_x along_y along_z] in *. lra. }
  unfold h_ in P. rewrite f2, l1, l2, l3 in P. fold (inner u gv) in P. rewrite u1 in P. lra.
Qed.

Theorem are_apart_sound : forall less distance d places Y p p' q q' pv pv' qv qv',
  are_apart (length lambda) less distance places Y p p' q q' = true ->
  match less with Some t => exists e, entry_in bits t e /\ 0 <= at_lambda lambda e | None => True end ->
  contains distance d -> 0 <= d -> all_stand p pv -> all_stand p' pv' -> all_stand q qv -> all_stand q' qv' ->
  forall s t, 0 <= s <= 1 -> 0 <= t <= 1 ->
  let w := away (between s pv pv') (between t qv qv') in d ^ 2 < inner w w.
Proof.
  intros less distance d places Y p p' q q' pv pv' qv qv' h hl hd d0 hp hp' hq hq' s t hs ht. cbv zeta.
  unfold are_apart in h. destruct Y as [| a [| b [| c [|]]]]; try discriminate. cbv zeta in h.
  do 3 (apply andb_true_iff in h as [h ?]). apply andb_true_iff in h as [_ h].
  destruct (affine_stands places a) as [ga A]. destruct (affine_stands places b) as [gb B]. destruct (affine_stands places c) as [gc C].
  set (gv := Spatial ga gb gc). assert (G : all_stand (each (affine places) (Spatial a b c)) gv) by (split; [| split]; assumption).
  pose proof (fun p q pv qv k => is_beyond_sound less distance d _ p q gv pv qv k hl hd d0 G) as Far.
  pose proof (Far _ _ _ _ h hp hq) as F1. pose proof (Far _ _ _ _ H1 hp hq') as F2.
  pose proof (Far _ _ _ _ H0 hp' hq) as F3. pose proof (Far _ _ _ _ H hp' hq') as F4.
  set (n := sqrt (inner gv gv)) in *. pose proof (sqrt_pos (inner gv gv)) as n0. fold n in n0.
  assert (nn : n * n = inner gv gv) by (apply sqrt_sqrt, inner_nonneg).
  set (w := away (between s pv pv') (between t qv qv')).
  assert (E : inner gv w = (1 - s) * ((1 - t) * inner gv (away pv qv) + t * inner gv (away pv qv'))
    + s * ((1 - t) * inner gv (away pv' qv) + t * inner gv (away pv' qv'))).
  { unfold w, away, between, inner, both. cbn [along_x along_y along_z]. ring. }
  assert (Mean : forall t a b, 0 <= t <= 1 -> d * n < a -> d * n < b -> d * n < (1 - t) * a + t * b).
  { clear. intros t a b h1 h2 h3. destruct (Req_dec t 0) as [-> | z]; [lra |]. assert (0 < t) by lra.
    assert (t * (d * n) < t * b) by (apply Rmult_lt_compat_l; assumption).
    assert ((1 - t) * (d * n) <= (1 - t) * a) by (apply Rmult_le_compat_l; lra). lra. }
  assert (K : d * n < inner gv w) by (rewrite E; apply Mean; [exact hs | apply Mean; assumption | apply Mean; assumption]).
  pose proof (inner_cauchy gv w) as Ca. pose proof (inner_nonneg w) as w0. rewrite <- nn in Ca.
  assert (0 <= d * n) by (apply Rmult_le_pos; assumption).
  assert (Sq : (d * n) ^ 2 < inner gv w ^ 2) by nra.
  assert (n * n * d ^ 2 < n * n * inner w w) by nra.
  assert (0 < n * n) by nra. apply Rmult_lt_reg_l with (n * n); assumption.
Qed.
End Cell.
End Precision.
