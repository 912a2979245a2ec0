(** * The test of accuracy at vertices

    Of as many joints as coordinates (test/accuracy.rs), by the slopes of rows on a cell and near it. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Formula Linear Arithmetic Slope Definite Test Cell Apart Solve Near Twofold Spread.

Import ListNotations.
Local Open Scope R_scope.

(** Rows where a pose is off, in the columns of what it is off by, and where it is not; formulas of joint coordinates; of each joint a formula,
    its error and, of each tolerance, the half-width with the derivative by it, errors and half-widths over the distance. Joints are angles or lengths.
    The first coordinates are those of place; of platforms that turn, further ones are what these are turned by, up to [l_turn]. *)
Record nearby := Nearby { l_far : list (list nat); l_rows : rows nat; l_defined : list nat; l_joints : list (nat * (fixed * list (fixed * nat)));
  l_angular : bool; l_distance : fixed; l_turn : fixed; l_first : nat; l_last : bool }.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation unit := (unit_R bits).

(** [l]: of what is not negative, the value at the vertex. *)
Definition located_at (n : nat) (ws : list Z) (places : N) (Y : list (list Z)) (k2 z2 l : fixed) (rows : rows fixed) (bs : list fixed) : bool :=
  let rows := map (fun p => (weighted ws (fst p), snd p)) rows in
  let below := triangle_add (repeat [neg l] n) (gram places (solve_pairs places Y (Fixed.integer bits 1) rows)) in
  Nat.eqb (length rows) n && Nat.eqb (length bs) n && is_shaped n below && is_definite bits n (triangle_add (repeat [neg k2] n) below) &&
  forallb (fun z => is_definite bits (S n) (bordered_by below (signed (z ++ [false]) bs) (sub z2 l))) (signs (pred n)).

(** Less than a radian. *)
Definition is_less (d sum : fixed) : bool := (0 <? lo (sub (Fixed.integer bits 1) (mul bits d sum)))%Z.
Definition total_of (l : list slope) : fixed := fold_right (fun s sum => add (point_of (magnitude (range s))) sum) zero l.
Definition total_off (hs : list (fixed * slope)) : fixed := fold_right (fun h sum => add (mul bits (fst h) (point_of (magnitude (range (snd h))))) sum) zero hs.

Definition located (m : nat) (less : option slope) (a : nearby) (far : list (list slope)) (here : rows slope) (joints : list (fixed * list (fixed * slope)))
    (places : N) (Y : list (list Z)) (kappa : Z) (q : N) : bool :=
  let f := l_first a in let g := spread bits m f far in let k := Arithmetic.dyadic kappa places (Fixed.integer bits 1) in
  (N.eqb q 0 || (N.leb q 16 && Nat.ltb 0 f && Nat.ltb f m)) && (0 <? lo (sub k g))%Z && Nat.eqb (length Y) m && Nat.eqb (length here) m &&
  (negb (l_angular a) || forallb (fun row => is_less (l_distance a) (total_of row)) far && forallb (fun j => is_less (l_distance a) (total_off (snd j))) joints) &&
  match recip bits k with
  | Some r => let z := sub (Fixed.integer bits 1) (halve (mul bits g r)) in
      forallb (fun s => located_at m (weights_of m f (l_last a) q) places Y (sqr bits k) (sqr bits z) match less with Some t => at_vertex s t | None => zero end
        (map_rows (at_vertex s) here) (map (fun j => off_at bits s (fst j) (snd j)) joints)) (signs m)
  | None => false
  end.

(** The matrices at a vertex, for any b within these numbers. *)
Lemma located_at_shown : forall n ws places Y k2 z2 l rows bs K Z L r beta, located_at n ws places Y k2 z2 l rows bs = true -> length Y = n -> length r = n ->
  contains k2 K -> contains z2 Z -> contains l L -> rows_rel contains rows r -> Forall2 contains bs beta ->
  forall v, length v = n -> let y := weighted_sum v (map (map (Y_value places)) Y) in
  let form := 2 * dot (weighted_sum v (map (scaled (map IZR ws)) (map fst r))) y - dot y y in
  (0 < dot v v -> 0 < form - K * dot v v - L * dot v v) /\
  forall s b, Forall2 (fun b c => Rabs b <= c) b beta -> 0 < dot v v + s ^ 2 -> 0 < form + 2 * s * dot b v + Z * s ^ 2 - L * (dot v v + s ^ 2).
Proof.
  intros n ws places Y k2 z2 l rows bs K Z L r beta h lY lr hK hZ hL hr hb v lv y form. unfold located_at in h. cbv zeta in h.
  set (rowsE := map (fun p => (weighted ws (fst p), snd p)) rows) in *. set (RE := map (fun p => (scaled (map IZR ws) (fst p), snd p)) r).
  assert (hE : rows_rel contains rowsE RE).
  { unfold rowsE, RE. apply (map_related _ _ _ _ (fun p q => Forall2 contains (fst p) (fst q) /\ contains (snd p) (snd q))); [| exact hr].
    intros p q [h1 h2]. split; [apply weighted_sound, h1 | exact h2]. }
  set (t := triangle_add (repeat [neg l] n) _) in *.
  apply andb_true_iff in h as [h signs_]. apply andb_true_iff in h as [h first]. apply andb_true_iff in h as [h shape]. apply andb_true_iff in h as [l1 l2]. apply Nat.eqb_eq in l1, l2.
  assert (lRE : length RE = n) by (unfold RE; rewrite map_length; exact lr).
  assert (fstE : map fst RE = map (scaled (map IZR ws)) (map fst r)) by (unfold RE; rewrite !map_map; reflexivity).
  pose proof (gram_sound bits places _ _ (solve_pairs_sound bits places Y _ 1 rowsE RE (Fixed.integer_sound bits 1) hE)) as hg.
  pose proof (triangle_add_sound bits _ _ _ _ (diagonal_in bits _ _ n (neg_sound bits _ _ hL)) hg) as ht. fold t in ht. set (T := tcomb 1 1 (diagonal n (- L)) _) in ht.
  assert (QT : quad T v = form - L * dot v v).
  { unfold T. rewrite quad_tcomb. rewrite <- lv at 1. rewrite quad_diagonal, quad_pairs by congruence. rewrite fstE. fold y. unfold form. ring. }
  split.
  - intro nz. unfold is_definite in first. destruct (Nat.eqb_spec (length (triangle_add (repeat [neg k2] n) t)) n) as [q |]; [| discriminate].
    pose proof (triangle_add_sound bits _ _ _ _ (diagonal_in bits _ _ n (neg_sound bits _ _ hK)) ht) as hT. pose proof (is_positive_definite_sound bits _ _ first hT v) as Q.
    rewrite (related_length _ _ _ _ _ hT) in q. specialize (Q ltac:(congruence) nz). rewrite quad_tcomb in Q. rewrite <- lv in Q at 1. rewrite quad_diagonal, QT in Q. lra.
  - intros s b hbb nz. assert (lbeta : length beta = length v) by (rewrite <- (related_length _ _ _ _ _ hb); congruence).
    destruct (worst_signs_but_last s v beta lbeta) as [z' [s' [lz' [es hz']]]]. rewrite lv in lz'. rewrite forallb_forall in signs_. specialize (signs_ z' ltac:(rewrite <- lz'; apply signs_all)). unfold is_definite in signs_.
    destruct (Nat.eqb_spec (length (bordered_by t (signed (z' ++ [false]) bs) (sub z2 l))) (S n)) as [q |]; [| discriminate].
    pose proof (bordered_by_sound bits t T _ _ _ _ ht (signed_sound bits (z' ++ [false]) bs beta hb) (sub_sound bits _ _ _ _ hZ hL)) as hB.
    pose proof (is_positive_definite_sound bits _ _ signs_ hB (v ++ [s'])) as Q. rewrite (related_length _ _ _ _ _ hB) in q. specialize (Q ltac:(rewrite q, app_length; cbn [length]; lia)).
    assert (D2 : dot (v ++ [s']) (v ++ [s']) = dot v v + s ^ 2).
    { rewrite <- es. clear. induction v as [| x0 v0 IH]; cbn [app dot]; [ring | rewrite IH; ring]. }
    unfold nonzero in Q. rewrite D2 in Q. specialize (Q nz).
    rewrite quad_bordered in Q; [| rewrite <- (shaped_related bits _ _ _ ht), lv; exact shape | rewrite map_length, combine_length, app_length; cbn [length]; lia].
    rewrite QT, es in Q. replace (2 * s' * dot _ v) with (2 * (s' * dot (map (fun p => sign_of (fst p) * snd p) (combine (z' ++ [false]) beta)) v)) in Q by ring. rewrite hz' in Q.
    assert (B : Rabs (dot b v) <= dot beta (map Rabs v)).
    { clear - hbb. revert v. induction hbb as [| x c b beta h hs IH]; intros [| t v]; cbn [map dot]; try (rewrite Rabs_R0; lra).
      eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_mult. pose proof (Rabs_pos t). specialize (IH v). apply Rplus_le_compat; [apply Rmult_le_compat_r; assumption | exact IH]. }
    assert (S2 : - (Rabs s * dot beta (map Rabs v)) <= s * dot b v).
    { pose proof (Rle_abs (- (s * dot b v))) as c. rewrite Rabs_Ropp, Rabs_mult in c. pose proof (Rmult_le_compat_l (Rabs s) _ _ (Rabs_pos s) B). lra. }
    lra.
Qed.

(** Less than a radian: of rows, and of what tolerances put a joint off by. *)
Lemma is_less_sound : forall d sum D S, is_less d sum = true -> contains d D -> contains sum S -> D * S < 1.
Proof.
  intros d sum D S h hd hs. apply Z.ltb_lt in h. pose proof (contains_positive bits _ _ h (sub_sound bits _ _ _ _ (Fixed.integer_sound bits 1) (mul_sound bits _ _ _ _ hd hs))). lra.
Qed.
Lemma total_of_sound : forall l xs, Forall2 (fun s x => contains (range s) x) l xs -> exists n, contains (total_of l) n /\ 0 <= n /\ forall v, Forall (fun t => -1 <= t <= 1) v -> Rabs (dot xs v) <= n.
Proof.
  intros l xs h. unfold total_of. induction h as [| s x l xs hs h [n [n1 [n0 n2]]]]; cbn [fold_right]; [exists 0; split; [apply zero_sound |]; split; [lra |]; intros v _; cbn; rewrite Rabs_R0; lra |].
  pose proof (magnitude_above bits _ _ hs) as M. exists (IZR (magnitude (range s)) / unit + n). split; [apply add_sound; [apply point_sound | exact n1] |].
  pose proof (Rabs_pos x). split; [lra |]. intros [| t v] hv; cbn [dot]; [rewrite Rabs_R0; lra |]. inversion hv as [| ? ? ht hv']; subst. specialize (n2 v hv').
  eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_mult. assert (Rabs t <= 1) by (apply Rabs_le; lra). pose proof (Rabs_pos t). nra.
Qed.
Lemma total_off_sound : forall hs ts xs, Forall2 (fun h t => exists a, contains (fst h) a /\ Rabs t <= a) hs ts -> Forall2 (fun h x => contains (range (snd h)) x) hs xs ->
  exists n, contains (total_off hs) n /\ 0 <= n /\ Rabs (dot ts xs) <= n.
Proof.
  intros hs ts xs h. unfold total_off. revert xs. induction h as [| s t hs ts [a [ha la]] h IH]; intros xs hx; inversion hx as [| ? x ? xs' h1 h2]; subst; cbn [fold_right dot].
  - exists 0. split; [apply zero_sound |]. split; [lra | rewrite Rabs_R0; lra].
  - destruct (IH xs' h2) as [n [n1 [n0 n2]]]. pose proof (magnitude_above bits _ _ h1) as M. exists (a * (IZR (magnitude (range (snd s))) / unit) + n).
    split; [apply add_sound; [apply mul_sound; [exact ha | apply point_sound] | exact n1] |]. pose proof (Rabs_pos x). pose proof (Rabs_pos t).
    assert (0 <= a * (IZR (magnitude (range (snd s))) / unit)) by (apply Rmult_le_pos; lra). split; [lra |].
    eapply Rle_trans; [apply Rabs_triang |]. apply Rplus_le_compat; [| exact n2]. rewrite Rabs_mult. apply Rmult_le_compat; assumption.
Qed.

(** What is shown, of rows A and all b: with g = [spread], kappa, z and what columns are multiplied by. *)
Theorem located_sound : forall m lambda, length lambda = m -> Forall (fun t => -1 <= t <= 1) lambda ->
  forall less a far here joints places Y k q, located m less a far here joints places Y k q = true -> harmless_by bits lambda less ->
  (exists g, contains (spread bits m (l_first a) far) g /\ 0 <= g) ->
  let g := IZR (hi (spread bits m (l_first a) far)) / unit in
  exists kappa z e, 0 <= g /\ g < kappa /\ 0 <= z /\ z + g / (2 * kappa) <= 1 /\ length e = m /\ (forall i, (i < m)%nat -> 0 < nth i e 0) /\
  (forall i, (i < m)%nat -> (if l_last a then l_first a <= i else i < l_first a)%nat -> nth i e 0 = 1) /\ forall es, rows_rel (entry_in bits) here es ->
  let A := map fst (map_rows (at_lambda lambda) es) in forall w, length w = m -> let p := weighted_sum w (map (scaled e) A) in
  kappa ^ 2 * dot w w <= dot p p /\
  forall bs s, Forall2 (bounded_by bits) joints bs -> 0 < dot w w + s ^ 2 -> 0 < dot p p + 2 * s * dot (map (off_by lambda) bs) w + z ^ 2 * s ^ 2.
Proof.
  intros m lambda llam hlam less a far here joints places Y k q h hl [g0 [hg0 g00]] g. unfold located in h. cbv zeta in h. set (f := l_first a) in *. set (gf := spread bits m f far) in *.
  apply andb_true_iff in h as [h D]. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [h lh]. apply andb_true_iff in h as [h lY]. apply andb_true_iff in h as [_ below].
  apply Z.ltb_lt in below. apply Nat.eqb_eq in lY, lh.
  pose proof (unit_R_pos bits) as p0. assert (gu : g * unit = IZR (hi gf)) by (unfold g; field; lra).
  assert (hg : contains gf g) by (destruct hg0 as [a1 a2]; split; rewrite gu; [lra | apply Rle_refl]).
  assert (g1 : 0 <= g) by (destruct hg0 as [_ a2]; apply Rmult_le_reg_r with unit; [exact p0 |]; nra).
  pose proof (Arithmetic.dyadic_sound bits k places _ 1 (Fixed.integer_sound bits 1)) as hk. set (kappa := IZR k / IZR (2 ^ Z.of_N places) * 1) in *.
  pose proof (contains_positive bits _ _ below (sub_sound bits _ _ _ _ hk hg)) as gk.
  destruct (recip bits (Arithmetic.dyadic k places (Fixed.integer bits 1))) as [r |] eqn:er; [| discriminate]. destruct (recip_sound bits _ _ _ er hk) as [_ hr].
  pose proof (sub_sound bits _ _ _ _ (Fixed.integer_sound bits 1) (halve_sound bits _ _ (mul_sound bits _ _ _ _ hg hr))) as hz. set (z := 1 - g * / kappa / 2) in *.
  set (ws := weights_of m f (l_last a) q) in *. set (e := map IZR ws).
  exists kappa, z, e. split; [exact g1 |]. split; [lra |].
  assert (q1 : g * / kappa < 1) by (apply Rmult_lt_reg_r with kappa; [lra |]; rewrite Rmult_assoc, Rinv_l; lra).
  split; [unfold z; lra |]. split; [unfold z; apply Req_le; field; lra |].
  split; [unfold e, ws, weights_of; rewrite !map_length, seq_length; reflexivity |].
  split. { intros i li. unfold e, ws. rewrite weights_entries by exact li. destruct (if l_last a then Nat.leb f i else Nat.ltb i f); [lra |]. apply IZR_lt, Z.pow_pos_nonneg; lia. }
  split. { intros i li hp. unfold e, ws. rewrite weights_entries by exact li. destruct (l_last a); [destruct (Nat.leb_spec f i) | destruct (Nat.ltb_spec i f)]; try reflexivity; lia. }
  intros es hes A w lw p. set (y := weighted_sum w (map (map (Y_value places)) Y)).
  assert (les : length es = m) by (rewrite <- (related_length _ _ _ _ _ hes); exact lh).
  assert (T : exists le, match less with Some f => entry_in bits f le | None => le = (0, []) end /\ 0 <= at_lambda lambda le).
  { destruct less as [t |]; [exact hl |]. exists (0, []). split; [reflexivity | unfold at_lambda; cbn; lra]. }
  destruct T as [le [hle le0]].
  assert (Vertex : forall s, contains match less with Some f => at_vertex s f | None => zero end (at_lambda (map corner s) le)).
  { intro s. destruct less as [t |]; [apply at_vertex_sound, hle |]. subst le. unfold at_lambda. cbn. rewrite Rplus_0_r. apply zero_sound. }
  rewrite forallb_forall in D.
  assert (Below : forall B, dot (weighted_sum w B) (scaled e y) = dot (weighted_sum w (map (scaled e) B)) y).
  { intro B. rewrite !dot_weighted. f_equal. rewrite !map_map. apply map_ext. intro row. symmetry. apply dot_scaled. }
  set (form l := 2 * dot (weighted_sum w (map fst (map_rows (at_lambda l) es))) (scaled e y) - dot y y).
  assert (Affine : forall before t after, form (before ++ t :: after) = (1 + t) / 2 * form (before ++ 1 :: after) + (1 - t) / 2 * form (before ++ -1 :: after)).
  { intros before t after. assert (F : forall l, form l = Test.form (map (fun t => (2 * t, 0)) w) (map_rows (at_lambda l) es) (scaled e y) - dot y y)
      by (intro l; unfold form; rewrite form_no_D; [reflexivity | unfold map_rows; rewrite map_length, les; congruence]).
    rewrite !F, (form_affine _ _ _ _ _ (at_lambda_affine before t after)). field. }
  assert (Rows : forall s, rows_rel contains (map_rows (at_vertex s) here) (map_rows (at_lambda (map corner s)) es))
    by (intro s; eapply map_rows_rel; [| exact hes]; intros b c i; apply at_vertex_sound; exact i).
  assert (len : forall s, length (map_rows (at_lambda (map corner s)) es) = m) by (intro s; unfold map_rows; rewrite map_length; exact les).
  assert (In_signs : forall s, length s = length lambda -> In s (signs m)) by (intros s l; rewrite <- llam, <- l; apply signs_all).
  assert (Square : form lambda <= dot p p).
  { pose proof (dot_self (comb 1 (- 1) p y)) as N. rewrite dot_comb, !(dot_commutes _ (comb _ _ _ _)), !dot_comb, (dot_commutes y p) in N. unfold form. fold A. rewrite Below. fold p. lra. }
  pose proof (dot_self w) as w_nonneg. split.
  - destruct (Rle_lt_dec (dot w w) 0) as [zero | nz]; [assert (E : dot w w = 0) by lra; rewrite E, Rmult_0_r; apply dot_self |].
    enough (0 < form lambda + - kappa ^ 2 * dot w w + - (at_lambda lambda le * dot w w)) by (assert (0 <= at_lambda lambda le * dot w w) by (apply Rmult_le_pos; assumption); lra).
    apply (vertices_decide lambda (fun l => form l + - kappa ^ 2 * dot w w + - (at_lambda l le * dot w w)) hlam).
    + intros before t after. rewrite (Affine before t after), (at_lambda_affine before t after le). field.
    + intros s l. specialize (D s (In_signs s l)).
      assert (B : exists beta, Forall2 contains (map (fun j => off_at bits s (fst j) (snd j)) joints) beta).
      { exists (map (fun j => IZR (lo (off_at bits s (fst j) (snd j))) / unit) joints). clear. induction joints as [| j js IH]; cbn [map]; constructor; [apply (point_sound bits) | exact IH]. }
      destruct B as [beta hb].
      pose proof (proj1 (located_at_shown _ _ _ _ _ _ _ _ _ _ _ _ _ _ D lY (len s) (sqr_sound bits _ _ hk) (sqr_sound bits _ _ hz) (Vertex s) (Rows s) hb w lw) nz) as V. cbv zeta in V.
      fold y e in V. rewrite <- Below in V. unfold form. lra.
  - intros bs s hbs nz.
    enough (0 < form lambda + 2 * s * dot (map (off_by lambda) bs) w + z ^ 2 * s ^ 2 + - (at_lambda lambda le * (dot w w + s ^ 2)))
      by (assert (0 <= at_lambda lambda le * (dot w w + s ^ 2)) by (apply Rmult_le_pos; lra); lra).
    apply (vertices_decide lambda (fun l => form l + 2 * s * dot (map (off_by l) bs) w + z ^ 2 * s ^ 2 + - (at_lambda l le * (dot w w + s ^ 2))) hlam).
    + intros before t after. assert (O : dot (map (off_by (before ++ t :: after)) bs) w = (1 + t) / 2 * dot (map (off_by (before ++ 1 :: after)) bs) w + (1 - t) / 2 * dot (map (off_by (before ++ -1 :: after)) bs) w).
      { generalize w. clear. induction bs as [| b bs IH]; intros [| x v]; cbn [map dot]; try field. rewrite IH, (off_by_affine before t after b). field. }
      rewrite O, (Affine before t after), (at_lambda_affine before t after le). field.
    + intros v l. specialize (D v (In_signs v l)).
      assert (B : exists beta, Forall2 contains (map (fun j => off_at bits v (fst j) (snd j)) joints) beta /\ Forall2 (fun b beta => Rabs b <= beta) (map (off_by (map corner v)) bs) beta).
      { clear - hbs. induction hbs as [| j b joints bs h _ [beta [IH1 IH2]]]; [exists []; split; constructor |].
        destruct (bounded_sound bits j b v h) as [x [x1 x2]]. exists (x :: beta). split; constructor; assumption. }
      destruct B as [beta [hb1 hb2]].
      pose proof (proj2 (located_at_shown _ _ _ _ _ _ _ _ _ _ _ _ _ _ D lY (len v) (sqr_sound bits _ _ hk) (sqr_sound bits _ _ hz) (Vertex v) (Rows v) hb1 w lw) s _ hb2 nz) as V. cbv zeta in V.
      fold y e in V. rewrite <- Below in V. unfold form. lra.
Qed.
End Precision.
