(** * What is off near a cell

    Of machines with as many joints as coordinates (test/accuracy.rs): formulas near a cell, how much rows differ there, in blocks of both
    parts of what a pose is off by, and matrices with a border. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Formula Linear Arithmetic Slope Definite Test Cell Apart Solve Near Twofold.

Import ListNotations.
Local Open Scope R_scope.

(** ** Schur's test *)

Definition total (l : list R) : R := fold_right Rplus 0 l.
Definition squares (u : list R) : list R := map (fun x => x ^ 2) u.
Lemma squares_total : forall u, total (squares u) = dot u u.
Proof. induction u as [| x u IH]; cbn [squares map total fold_right dot]; [reflexivity |]. unfold squares, total in IH. rewrite IH. ring. Qed.

Lemma row_cauchy : forall m u, Forall (fun x => 0 <= x) m ->
  dot m (map Rabs u) ^ 2 <= total m * dot m (squares u) /\ 0 <= total m /\ 0 <= dot m (squares u).
Proof.
  induction m as [| s m IH]; intros u h; [destruct u; cbn; lra |]. inversion h as [| ? ? s0 h']; subst. destruct u as [| x u].
  - destruct (IH [] h') as [_ [I _]]. cbn [dot map squares total fold_right]. unfold total in I. lra.
  - destruct (IH u h') as [I1 [I2 I3]]. destruct (cauchy_step _ _ _ s 1 (Rabs x) I1 I2 I3 s0) as [K1 [K2 K3]]. rewrite pow2_abs in *.
    cbn [dot map squares total fold_right]. unfold total, squares in *. split; [| split; lra].
    replace ((s * Rabs x + dot m (map Rabs u)) ^ 2) with ((dot m (map Rabs u) + s * (1 * Rabs x)) ^ 2) by ring. eapply Rle_trans; [exact K1 |]. apply Req_le. ring.
Qed.
Lemma row_below : forall s m u, Forall2 (fun s m => Rabs s <= m) s m -> Rabs (dot s u) <= dot m (map Rabs u).
Proof.
  intros s m u h. revert u. induction h as [| a b s m h hs IH]; intros [| x u]; cbn [dot map]; try (rewrite Rabs_R0; lra).
  eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_mult. pose proof (Rabs_pos x). specialize (IH u). apply Rplus_le_compat; [apply Rmult_le_compat_r; assumption | exact IH].
Qed.
Definition columns (M : list (list R)) : list R := fold_right (comb 1 1) [] M.
Lemma columns_dot : forall M v, dot (columns M) v = total (image M v).
Proof. induction M as [| r M IH]; intro v; [reflexivity |]. cbn [columns image map fold_right total]. rewrite dot_comb. fold (columns M). rewrite IH. unfold image, total. ring. Qed.
Lemma dot_most : forall c v C, 0 <= C -> (forall k, nth k c 0 <= C) -> Forall (fun x => 0 <= x) v -> dot c v <= C * total v.
Proof.
  intros c v C C0 h hv. revert c h. induction hv as [| x v x0 hv IH]; intros c h; [rewrite dot_commutes; cbn; lra |].
  destruct c as [| y c]; cbn [dot total fold_right].
  - assert (0 <= total v) by (clear - hv; induction hv; cbn [total fold_right]; unfold total in *; lra). unfold total in *. nra.
  - specialize (IH c (fun k => h (S k))). pose proof (h 0%nat) as h0. cbn [nth] in h0. unfold total in *. nra.
Qed.

Lemma schur_lists : forall S M w u P C, Forall2 (Forall2 (fun s m => Rabs s <= m)) S M -> 0 <= P -> 0 <= C ->
  Forall (fun r => total r <= P) M -> (forall k, nth k (columns M) 0 <= C) -> dot w (image S u) ^ 2 <= P * C * (dot w w * dot u u).
Proof.
  intros S M w u P C h P0 C0 hP hC.
  assert (Nonneg : forall s m, Forall2 (fun s m => Rabs s <= m) s m -> Forall (fun x => 0 <= x) m).
  { induction 1 as [| a b s m k hs IH]; constructor; [eapply Rle_trans; [apply Rabs_pos | exact k] | exact IH]. }
  assert (Y : dot (image S u) (image S u) <= P * total (image M (squares u))).
  { clear hC. induction h as [| s m S M hm h IH]; cbn [image map total fold_right dot]; [lra |]. inversion hP as [| ? ? p1 p2]; subst. specialize (IH p2).
    destruct (row_cauchy m u (Nonneg _ _ hm)) as [K1 [K2 K3]]. pose proof (row_below s m u hm) as B.
    assert (Q : dot s u * dot s u <= P * dot m (squares u)).
    { apply Rle_trans with (dot m (map Rabs u) ^ 2); [| eapply Rle_trans; [exact K1 | apply Rmult_le_compat_r; assumption]].
      replace (dot s u * dot s u) with (Rabs (dot s u) ^ 2) by (rewrite pow2_abs; ring). pose proof (Rabs_pos (dot s u)). nra. }
    unfold image, total in *. lra. }
  pose proof (dot_cauchy w (image S u)) as K. apply Rle_trans with (1 := K). pose proof (dot_self w). rewrite <- columns_dot in Y.
  assert (Z : dot (columns M) (squares u) <= C * dot u u).
  { rewrite <- squares_total. apply dot_most; [exact C0 | exact hC |]. unfold squares. rewrite Forall_map. apply Forall_forall. intros x _. apply pow2_ge_0. }
  assert (P * dot (columns M) (squares u) <= P * (C * dot u u)) by (apply Rmult_le_compat_l; assumption).
  replace (P * C * (dot w w * dot u u)) with (dot w w * (P * (C * dot u u))) by ring. apply Rmult_le_compat_l; lra.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation unit := (unit_R bits).

(** ** How much rows differ *)

Definition zcolumns (M : list (list Z)) : list Z := fold_right (merge (fun x => x) (fun x => x) Z.add) [] M.
Definition block_norm (M : list (list Z)) : fixed :=
  let greatest := fold_right Z.max 0%Z in
  greatest_root bits (mul bits (Near.point_of (greatest (map (fold_right Z.add 0%Z) M))) (Near.point_of (greatest (zcolumns M)))).
Definition in_real (z : Z) : R := IZR z / unit.

Lemma in_real_sum : forall l, total (map in_real l) = in_real (fold_right Z.add 0%Z l).
Proof.
  pose proof (unit_R_pos bits). induction l as [| z l IH]; cbn [map total fold_right]; [unfold in_real, Rdiv; ring |]. unfold total in IH. rewrite IH. unfold in_real. rewrite plus_IZR. field. lra.
Qed.
Lemma zcolumns_entries : forall M k, nth k (columns (map (map in_real) M)) 0 = in_real (nth k (zcolumns M) 0%Z).
Proof.
  pose proof (unit_R_pos bits) as u0. assert (Z0 : in_real 0 = 0) by (unfold in_real, Rdiv; ring).
  assert (E : forall l k, nth k (map in_real l) 0 = in_real (nth k l 0%Z)) by (intros l k; rewrite <- Z0; apply map_nth).
  induction M as [| r M IH]; intro k; cbn [map columns zcolumns fold_right]; [destruct k; symmetry; exact Z0 |]. fold (columns (map (map in_real) M)). fold (zcolumns M). rewrite comb_entries, IH, E.
  generalize (zcolumns M). clear IH. revert k. induction r as [| y r IH]; intros k l; cbn [merge].
  - rewrite map_id. replace (nth k [] 0%Z) with 0%Z by (destruct k; reflexivity). rewrite Z0. ring.
  - destruct l as [| z l]; [rewrite map_id; replace (nth k [] 0%Z) with 0%Z by (destruct k; reflexivity); rewrite Z0; ring |].
    destruct k as [| k]; cbn [nth]; [unfold in_real; rewrite plus_IZR; field; lra | apply IH].
Qed.
Lemma greatest_above : forall l z, In z l \/ z = 0%Z -> (z <= fold_right Z.max 0 l)%Z.
Proof. induction l as [| y l IH]; intros z [i | e]; cbn [fold_right]; try contradiction; [lia | destruct i as [-> | i]; [lia | specialize (IH z (or_introl i)); lia] | specialize (IH z (or_intror e)); lia]. Qed.

Lemma block_norm_sound : forall S M, Forall2 (Forall2 (fun s m => Rabs s <= in_real m)) S M -> exists n, contains (block_norm M) n /\ 0 <= n /\
  forall w u, Rabs (dot w (image S u)) <= n * (size w * size u).
Proof.
  intros S M h. pose proof (unit_R_pos bits) as p0. unfold block_norm. cbv zeta. set (gr := fold_right Z.max 0%Z _). set (gc := fold_right Z.max 0%Z (zcolumns M)).
  assert (Le : forall a b, (a <= b)%Z -> in_real a <= in_real b) by (intros a b k; apply IZR_le in k; apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, p0 | exact k]).
  assert (Z0 : in_real 0 = 0) by (unfold in_real, Rdiv; ring).
  assert (R0 : 0 <= in_real gr) by (rewrite <- Z0; apply Le, greatest_above; right; reflexivity). assert (C0 : 0 <= in_real gc) by (rewrite <- Z0; apply Le, greatest_above; right; reflexivity).
  assert (RC : contains (mul bits (Near.point_of gr) (Near.point_of gc)) (in_real gr * in_real gc)) by (apply mul_sound; apply point_sound).
  pose proof (Rmult_le_pos _ _ R0 C0) as q0.
  destruct (greatest_root_sound bits _ _ (sqrt (in_real gr * in_real gc)) RC ltac:(rewrite <- Rsqr_pow2, Rsqr_sqrt by exact q0; apply Rle_refl)) as [n [h1 [h2 h3]]].
  exists n. split; [exact h3 |]. split; [exact h2 |]. intros w u.
  assert (K : dot w (image S u) ^ 2 <= in_real gr * in_real gc * (dot w w * dot u u)).
  { apply (schur_lists S (map (map in_real) M)); try assumption.
    - clear - h. induction h as [| s m S M hm h IH]; cbn [map]; constructor; [| exact IH]. clear - hm. induction hm; cbn [map]; constructor; assumption.
    - rewrite Forall_map. apply Forall_forall. intros r ir. rewrite in_real_sum. apply Le, greatest_above. left. apply (in_map (fold_right Z.add 0%Z)), ir.
    - intro k. rewrite zcolumns_entries. apply Le, greatest_above. destruct (nth_in_or_default k (zcolumns M) 0%Z); auto. }
  pose proof (size_nonneg w). pose proof (size_nonneg u). rewrite <- !size_square in K.
  assert (Q : in_real gr * in_real gc <= n ^ 2) by (rewrite <- (sqrt_sqrt _ q0); pose proof (sqrt_pos (in_real gr * in_real gc)); nra).
  assert (S0 : 0 <= size w * size u) by (apply Rmult_le_pos; assumption).
  assert (T : dot w (image S u) ^ 2 <= (n * (size w * size u)) ^ 2).
  { apply Rle_trans with (1 := K). replace ((n * (size w * size u)) ^ 2) with (n ^ 2 * (size w ^ 2 * size u ^ 2)) by ring.
    apply Rmult_le_compat_r; [apply Rmult_le_pos; apply pow2_ge_0 | exact Q]. }
  rewrite <- pow2_abs in T. pose proof (Rabs_pos (dot w (image S u))). assert (0 <= n * (size w * size u)) by (apply Rmult_le_pos; assumption).
  apply Rnot_lt_le. intro k. nra.
Qed.

Definition magnitudes (m : nat) (s : slope) : list Z := map (fun k => magnitude (nth k (slopes s) zero)) (seq 0 m).
Definition row_spread (f : nat) (M : list (list Z)) : fixed :=
  let block a b := block_norm (map (part f b) (part f a M)) in
  add (add (add (block false false) (block false true)) (block true false)) (block true true).
Definition spread (m f : nat) (far : list (list slope)) : fixed :=
  greatest_root bits (fold_right (fun r sum => add sum (sqr bits (row_spread f (map (magnitudes m) r)))) zero far).

Lemma part_map : forall (A B : Type) (g : A -> B) f p l, part f p (map g l) = map g (part f p l).
Proof. intros A B g f [] l; cbn [part]; [apply skipn_map | apply firstn_map]. Qed.
Lemma part_related : forall (A B : Type) (Q : A -> B -> Prop) f p l m, Forall2 Q l m -> Forall2 Q (part f p l) (part f p m).
Proof.
  intros A B Q f p l m h. destruct p; cbn [part]; revert l m h; induction f as [| f IH]; intros l m h; cbn [firstn skipn]; try constructor; try assumption; destruct h; try constructor; auto.
Qed.

Lemma row_spread_sound : forall f S M, Forall2 (Forall2 (fun s m => Rabs s <= in_real m)) S M -> exists n, contains (row_spread f M) n /\ 0 <= n /\
  forall w u, Rabs (dot w (image S u)) <= n * (norm f w * norm f u).
Proof.
  intros f S M h. unfold row_spread. cbv zeta.
  assert (B : forall a b, exists n, contains (block_norm (map (part f b) (part f a M))) n /\ 0 <= n /\ forall w u, Rabs (dot w (image (map (part f b) (part f a S)) u)) <= n * (size w * size u)).
  { intros a b. apply block_norm_sound. apply (map_related _ _ _ _ (Forall2 (fun s m => Rabs s <= in_real m))); [intros; apply part_related; assumption | apply part_related; exact h]. }
  destruct (B false false) as [n1 [c1 [p1 h1]]], (B false true) as [n2 [c2 [p2 h2]]], (B true false) as [n3 [c3 [p3 h3]]], (B true true) as [n4 [c4 [p4 h4]]].
  exists (n1 + n2 + n3 + n4). split; [repeat apply add_sound; assumption |]. split; [lra |]. intros w u.
  assert (E : forall p, part f p (image S u) = comb 1 1 (image (map (part f false) (part f p S)) (part f false u)) (image (map (part f true) (part f p S)) (part f true u))).
  { intro p. unfold image. rewrite part_map, !map_map. induction (part f p S) as [| r l IH]; [reflexivity |]. cbn [map comb merge]. fold (comb 1 1). f_equal; [rewrite (dot_parts f r u); cbn [part]; ring | exact IH]. }
  assert (D : dot w (image S u) = dot (part f false w) (part f false (image S u)) + dot (part f true w) (part f true (image S u))) by apply dot_parts.
  rewrite !E, !dot_right in D.
  assert (N : forall n a b X, 0 <= n -> Rabs X <= n * (size (part f a w) * size (part f b u)) -> Rabs X <= n * (norm f w * norm f u)).
  { intros n a b X n0 k. apply Rle_trans with (1 := k). apply Rmult_le_compat_l; [exact n0 |]. apply Rmult_le_compat; auto using size_nonneg, part_size. }
  pose proof (N _ false false _ p1 (h1 (part f false w) (part f false u))). pose proof (N _ false true _ p2 (h2 (part f false w) (part f true u))).
  pose proof (N _ true false _ p3 (h3 (part f true w) (part f false u))). pose proof (N _ true true _ p4 (h4 (part f true w) (part f true u))).
  assert (T : forall a b c d n, Rabs a <= n1 * n -> Rabs b <= n2 * n -> Rabs c <= n3 * n -> Rabs d <= n4 * n -> Rabs (1 * a + 1 * b + (1 * c + 1 * d)) <= (n1 + n2 + n3 + n4) * n).
  { intros a b c d n ha hb hc hd. replace (1 * a + 1 * b + (1 * c + 1 * d)) with (a + b + c + d) by ring.
    pose proof (Rabs_triang (a + b + c) d). pose proof (Rabs_triang (a + b) c). pose proof (Rabs_triang a b). lra. }
  rewrite D. apply T; assumption.
Qed.

Lemma dot_first : forall l u, dot (map (fun k => nth k u 0) (seq 0 (length l))) l = dot u l.
Proof.
  induction l as [| x l IH]; intros u; [destruct u; reflexivity |]. cbn [length seq map dot]. rewrite <- seq_shift, map_map.
  destruct u as [| y u]; [| cbn [nth dot]; rewrite <- (IH u); reflexivity].
  transitivity (0 * x + dot (map (fun k => nth k [] 0) (seq 0 (length l))) l); [f_equal; f_equal; apply map_ext; intros []; reflexivity | rewrite IH; cbn [dot]; ring].
Qed.
Lemma magnitudes_above : forall m s u, Forall2 contains (slopes s) u -> Forall2 (fun s m => Rabs s <= in_real m) (map (fun k => nth k u 0) (seq 0 m)) (magnitudes m s).
Proof.
  intros m s u h. unfold magnitudes. generalize (seq 0 m). induction l as [| k l IH]; cbn [map]; constructor; [| exact IH]. exact (magnitude_above bits _ _ (nth_contains bits _ _ h k)).
Qed.

(** Of rows that differ by slopes times u. *)
Lemma spread_sound : forall m f far (us : list (list (list R))), Forall2 (Forall2 (fun s u => Forall2 contains (slopes s) u)) far us ->
  exists g, contains (spread m f far) g /\ 0 <= g /\
  forall (A B : list (list R)) w u, length u = m -> Forall2 (fun ab r => dot (fst ab) w - dot (snd ab) w = dot w (image r u)) (combine A B) us -> length A = length B ->
    size (less (image A w) (image B w)) <= g * (norm f w * norm f u).
Proof.
  intros m f far us h. unfold spread. set (sum := fold_right _ zero far).
  assert (K : exists n, contains sum n /\ 0 <= n /\ forall (A B : list (list R)) w u, length u = m ->
    Forall2 (fun ab r => dot (fst ab) w - dot (snd ab) w = dot w (image r u)) (combine A B) us -> length A = length B ->
    dot (less (image A w) (image B w)) (less (image A w) (image B w)) <= n * (norm f w * norm f u) ^ 2).
  { unfold sum. clear sum. induction h as [| r v far us h1 h [n [k1 [k2 k3]]]]; cbn [fold_right].
    - exists 0. split; [apply zero_sound |]. split; [apply Rle_refl |]. intros [| a A] [| b B] w u lu hab l; try discriminate; [cbn; lra | inversion hab].
    - destruct (row_spread_sound f (map (fun u => map (fun k => nth k u 0) (seq 0 m)) v) (map (magnitudes m) r)) as [q [q1 [q2 q3]]].
      { clear - h1. induction h1 as [| s u r v hs h IH]; cbn [map]; constructor; [apply magnitudes_above, hs | exact IH]. }
      exists (n + q ^ 2). split; [apply add_sound; [exact k1 | apply sqr_sound, q1] |]. pose proof (pow2_ge_0 q). split; [lra |].
      intros [| a A] [| b B] w u lu hab l; try discriminate; [inversion hab |]. cbn [combine] in hab. inversion hab as [| ? ? ? ? e hab']; subst. cbn [fst snd] in e.
      specialize (k3 A B w u eq_refl hab' ltac:(cbn in l; congruence)). specialize (q3 w u).
      assert (E : image (map (fun u0 => map (fun k => nth k u0 0) (seq 0 (length u))) v) u = image v u) by (unfold image; rewrite map_map; apply map_ext; intro x; apply dot_first).
      rewrite E, <- e in q3. unfold less, comb in *. cbn [image map merge dot]. fold (comb 1 (-1)) in *.
      replace (1 * dot a w + -1 * dot b w) with (dot a w - dot b w) by ring. set (d := dot a w - dot b w) in *.
      assert (d * d <= (q * (norm f w * norm f u)) ^ 2).
      { replace (d * d) with (Rabs d ^ 2) by (rewrite pow2_abs; ring). pose proof (Rabs_pos d). nra. }
      unfold image in k3. lra. }
  destruct K as [n [k1 [k2 k3]]]. destruct (greatest_root_sound bits _ n (sqrt n) k1 ltac:(rewrite <- Rsqr_pow2, Rsqr_sqrt by exact k2; apply Rle_refl)) as [g [g1 [g2 g3]]].
  exists g. split; [exact g3 |]. split; [exact g2 |]. intros A B w u lu hab l. specialize (k3 A B w u lu hab l).
  assert (N0 : 0 <= norm f w * norm f u) by (apply Rmult_le_pos; apply norm_nonneg).
  apply size_below; [apply Rmult_le_pos; assumption |]. apply Rle_trans with (1 := k3). rewrite (Rpow_mult_distr g (norm f w * norm f u)). apply Rmult_le_compat_r; [apply pow2_ge_0 |].
  rewrite <- (sqrt_sqrt n k2). pose proof (sqrt_pos n). nra.
Qed.

(** ** Matrices with a border *)

(** What columns are multiplied by: 1 those of the part, 2^q the others. *)
Definition weights_of (n f : nat) (last : bool) (q : N) : list Z :=
  map (fun i => if (if last then Nat.leb f i else Nat.ltb i f) then 1%Z else (2 ^ Z.of_N q)%Z) (seq 0 n).
Definition weighted (ws : list Z) (a : list fixed) : list fixed := map (fun p => Arithmetic.dyadic (fst p) 0 (snd p)) (combine ws a).
Definition bordered_by (t : triangle) (b : list fixed) (c : fixed) : triangle := map (fun p => fst p ++ [snd p]) (combine t b) ++ [[c]].
Fixpoint is_shaped {A : Type} (n : nat) (t : list (list A)) : bool :=
  match t, n with [], O => true | r :: t', S k => Nat.eqb (length r) n && is_shaped k t' | _, _ => false end.
Definition signed (z : list bool) (b : list fixed) : list fixed := map (fun p : bool * fixed => if fst p then neg (snd p) else snd p) (combine z b).

Lemma quad_singles : forall l w, quad (map (fun a => [a]) l) w = dot l (squares w).
Proof. induction l as [| a l IH]; intros [| x w]; cbn [map quad row_form dot squares]; try reflexivity. unfold squares in IH. rewrite IH. cbn. ring. Qed.
Lemma quad_bordered : forall S b C w s, is_shaped (length w) S = true -> length b = length w ->
  quad (map (fun p => fst p ++ [snd p]) (combine S b) ++ [[C]]) (w ++ [s]) = quad S w + 2 * s * dot b w + C * s ^ 2.
Proof.
  assert (D : forall r w y s, length r = length w -> dot (r ++ [y]) (w ++ [s]) = dot r w + y * s).
  { induction r as [| a r IH]; intros [| x w] y s l; try discriminate; cbn [app dot]; [ring |]. rewrite IH by (cbn in l; congruence). ring. }
  induction S as [| r S IH]; intros b C [| x w] s sh lb; cbn [is_shaped length] in sh; try discriminate.
  - destruct b; [| discriminate]. cbn. ring.
  - apply andb_true_iff in sh as [l sh]. apply Nat.eqb_eq in l. destruct b as [| y b]; [discriminate |]. destruct r as [| a r]; [discriminate |].
    cbn [combine map app fst snd quad row_form dot]. rewrite (IH b C w s sh) by (cbn in lb; congruence). rewrite D by (cbn in l; congruence). ring.
Qed.
Lemma shaped_related : forall n t S, triangle_in bits t S -> is_shaped n t = is_shaped n S.
Proof. intros n t S h. revert n. induction h as [| r u t S hr h IH]; intros [| n]; cbn [is_shaped]; try reflexivity. rewrite IH, (related_length _ _ _ _ _ hr). reflexivity. Qed.
Lemma bordered_by_sound : forall t S b y c C, triangle_in bits t S -> Forall2 contains b y -> contains c C ->
  triangle_in bits (bordered_by t b c) (map (fun p => fst p ++ [snd p]) (combine S y) ++ [[C]]).
Proof.
  intros t S b y c C ht hb hc. unfold bordered_by. apply Forall2_app; [| constructor; [constructor; [exact hc | constructor] | constructor]]. revert b y hb.
  induction ht as [| r u t S hr ht IH]; intros b y hb; cbn [combine map]; [constructor |]. destruct hb as [| a x b y ha hb]; cbn [combine map]; constructor; [| apply IH, hb].
  cbn [fst snd]. apply Forall2_app; [exact hr | constructor; [exact ha | constructor]].
Qed.
Definition sign_of (z : bool) : R := if z then -1 else 1.
Lemma signed_sound : forall z b y, Forall2 contains b y -> Forall2 contains (signed z b) (map (fun p => sign_of (fst p) * snd p) (combine z y)).
Proof.
  unfold signed. intros z b y h. revert z. induction h as [| a x b y ha h IH]; intros [| s z]; cbn [combine map]; constructor; [| apply IH]. cbn [fst snd].
  destruct s; cbn [sign_of]; [replace (-1 * x) with (- x) by ring; apply neg_sound, ha | rewrite Rmult_1_l; exact ha].
Qed.
(** Signs with which s b . w is least. *)
Lemma worst_signs : forall s w, exists z, length z = length w /\ forall y, length y = length w -> s * dot (map (fun p => sign_of (fst p) * snd p) (combine z y)) w = - Rabs s * dot y (map Rabs w).
Proof.
  intros s. induction w as [| x w [z [lz hz]]]; [exists []; split; [reflexivity |]; intros [| y0 y1] e; try discriminate; cbn; ring |].
  exists ((if Rle_dec 0 (s * x) then true else false) :: z). split; [cbn; congruence |]. intros [| a y] l; try discriminate. cbn [combine map dot fst snd].
  rewrite Rmult_plus_distr_l, hz by (cbn in l; congruence). assert (E : Rabs s * Rabs x = Rabs (s * x)) by (symmetry; apply Rabs_mult).
  destruct (Rle_dec 0 (s * x)) as [p | n]; cbn [sign_of]; [rewrite (Rabs_pos_eq (s * x)) in E by exact p | rewrite (Rabs_left (s * x)) in E by lra];
    (transitivity (- (Rabs s * Rabs x) * a + - Rabs s * dot y (map Rabs w)); [rewrite E; ring | ring]).
Qed.
Lemma flipped : forall z y w, dot (map (fun p => sign_of (fst p) * snd p) (combine (map negb z) y)) w = - dot (map (fun p => sign_of (fst p) * snd p) (combine z y)) w.
Proof. induction z as [| s z IH]; intros [| a y] [| x w]; cbn [map combine dot fst snd]; try ring. rewrite IH. destruct s; cbn [negb sign_of]; ring. Qed.

(** The last of the signs may be taken as minus: all signs change with that of s. *)
Lemma worst_signs_but_last : forall s v y, length y = length v -> exists z s', length z = pred (length v) /\ s' ^ 2 = s ^ 2 /\
  s' * dot (map (fun p => sign_of (fst p) * snd p) (combine (z ++ [false]) y)) v = - Rabs s * dot y (map Rabs v).
Proof.
  intros s v y ly. destruct (worst_signs s v) as [z [lz hz]]. specialize (hz y ly). destruct (list_eq_dec Bool.bool_dec z []) as [e0 | e0].
  - subst z. destruct v; [| discriminate]. exists [], s. split; [reflexivity |]. split; [reflexivity |]. rewrite !(dot_commutes _ []). cbn [map dot]. ring.
  - destruct (exists_last e0) as [z' [last ez]]. subst z. rewrite app_length in lz. cbn [length] in lz. destruct last.
    + exists (map negb z'), (- s). split; [rewrite map_length; lia |]. split; [ring |]. change [false] with (map negb [true]). rewrite <- map_app, flipped, <- hz. ring.
    + exists z', s. split; [lia |]. split; [reflexivity | exact hz].
Qed.

Lemma weighted_sound : forall ws a x, Forall2 contains a x -> Forall2 contains (weighted ws a) (scaled (map IZR ws) x).
Proof.
  unfold weighted, scaled. intros ws a x h. revert ws. induction h as [| b y a x hb h IH]; intros [| n ws]; cbn [map combine]; constructor; [| apply IH]. cbn [fst snd].
  replace (IZR n * y) with (IZR n / IZR (2 ^ Z.of_N 0) * y) by (change (IZR (2 ^ Z.of_N 0)) with 1; field). apply Arithmetic.dyadic_sound, hb.
Qed.

Lemma form_both : forall w us r v, length us = length w -> length r = length w ->
  form (combine (map (Rmult 2) w) us) r v = 2 * dot (weighted_sum w (map fst r)) v + dot us (map snd r).
Proof.
  induction w as [| t w IH]; intros [| u us] [| [a d] r] v lu lr; try discriminate; cbn [map combine form weighted_sum dot fst snd]; [cbn; ring |].
  rewrite IH by (cbn in *; congruence). rewrite dot_comb. ring.
Qed.
Lemma dot_le : forall a b v, Forall2 Rle a b -> Forall (fun x => 0 <= x) v -> dot a v <= dot b v \/ length a <> length v.
Proof.
  intros a b v h hv. destruct (Nat.eq_dec (length a) (length v)) as [l | l]; [left | right; exact l]. revert v hv l.
  induction h as [| x y a b le h IH]; intros [| t v] hv l; try discriminate; cbn [dot]; [lra |]. inversion hv as [| ? ? t0 hv']; subst.
  specialize (IH v hv' ltac:(cbn in l; lia)). pose proof (Rmult_le_compat_r t x y t0 le). lra.
Qed.

Lemma weights_entries : forall m f last q i, (i < m)%nat -> nth i (map IZR (weights_of m f last q)) 0 = if (if last then Nat.leb f i else Nat.ltb i f) then 1 else IZR (2 ^ Z.of_N q).
Proof.
  intros m f last q i l. unfold weights_of. rewrite map_map.
  rewrite (nth_indep _ 0 ((fun i => IZR (if (if last then Nat.leb f i else Nat.ltb i f) then 1%Z else (2 ^ Z.of_N q)%Z)) 0%nat)) by (rewrite map_length, seq_length; exact l).
  rewrite (map_nth (fun i => IZR (if (if last then Nat.leb f i else Nat.ltb i f) then 1%Z else (2 ^ Z.of_N q)%Z))), seq_nth by exact l. cbn [Nat.add]. destruct (if last then Nat.leb f i else Nat.ltb i f); reflexivity.
Qed.

(** ** Formulas near a cell *)

(** What is off by u: the first [f] coordinates by d times u, others are those of the cell, and further ones are tau times the rest of u. *)
Definition near_cell (f m : nat) (cell : list fixed) (d tau : fixed) : list slope :=
  near_coords 0 (firstn f cell) d ++ (map constant (skipn f cell) ++ near_coords f (repeat zero (m - f)) tau).
Definition near_point (f : nat) (x : list R) (d tau : R) (u : list R) : list R :=
  moved d (firstn f x) (firstn f u) ++ (skipn f x ++ moved tau (repeat 0 (length u - f)) (skipn f u)).
Definition inside (f m : nat) (u : list R) : Prop := length u = m /\ norm f u <= 1.

Lemma joined : forall (P : slope -> R -> R -> Prop) A B a b c d, length A = length a -> length A = length c ->
  (forall k, P (nth k A (constant zero)) (nth k a 0) (nth k c 0)) -> (forall k, P (nth k B (constant zero)) (nth k b 0) (nth k d 0)) ->
  forall k, P (nth k (A ++ B) (constant zero)) (nth k (a ++ b) 0) (nth k (c ++ d) 0).
Proof.
  intros P A B a b c d l1 l2 h1 h2 k. destruct (Nat.lt_ge_cases k (length A)) as [l | g].
  - rewrite !app_nth1 by lia. apply h1.
  - rewrite !app_nth2 by lia. rewrite <- l1, <- l2. apply h2.
Qed.
Lemma near_coords_length : forall cell j d, length (near_coords j cell d) = length cell.
Proof. induction cell as [| a cell IH]; intros j d; cbn [near_coords length]; [reflexivity | rewrite IH; reflexivity]. Qed.
Lemma moved_length : forall d x u, length u = length x -> length (moved d x u) = length x.
Proof. intros d x u l. unfold moved. rewrite map_length, combine_length. lia. Qed.
Lemma inside_ends : forall f m u, inside f m u -> Forall (fun t => -1 <= t <= 1) u.
Proof.
  intros f m u [_ h]. apply Forall_forall. intros t it. destruct (In_nth _ _ 0 it) as [k [_ <-]]. pose proof (norm_entry f u k) as e.
  pose proof (Rle_abs (nth k u 0)). pose proof (Rle_abs (- nth k u 0)) as q. rewrite Rabs_Ropp in q. lra.
Qed.
Lemma near_cell_holds : forall f m cell x d tau dist turn u, contains dist d -> contains turn tau -> 0 <= d -> 0 <= tau -> Forall2 contains cell x -> length cell = m -> (f <= m)%nat ->
  inside f m u -> forall k, holds bits u (nth k (near_cell f m cell dist turn) (constant zero)) (nth k (x ++ repeat 0 (m - f)) 0) (nth k (near_point f x d tau u) 0).
Proof.
  intros f m cell x d tau dist turn u hd ht d0 t0 hx lc lf hu k. pose proof (inside_ends f m u hu) as ends. destruct hu as [lu _]. pose proof (related_length _ _ _ _ _ hx) as lx.
  rewrite <- (firstn_skipn f u) in ends. apply Forall_app in ends as [e1 e2]. rewrite <- (firstn_skipn f x) at 1. rewrite <- app_assoc. unfold near_cell, near_point.
  assert (l1 : length (firstn f u) = f) by (rewrite firstn_length; lia). assert (l2 : length (skipn f u) = (m - f)%nat) by (rewrite skipn_length; lia).
  assert (l3 : length (firstn f cell) = f) by (rewrite firstn_length; lia). assert (l4 : length (firstn f x) = f) by (rewrite firstn_length; lia).
  revert k. apply joined; [rewrite near_coords_length; congruence | rewrite near_coords_length, moved_length; congruence | |].
  - intro k. pose proof (near_hold bits dist d hd d0 (firstn f cell) (firstn f x) (part_related _ _ contains f false _ _ hx) (firstn f u) ltac:(congruence) e1 (skipn f u) [] k) as N.
    cbn [app length] in N. rewrite firstn_skipn in N. exact N.
  - apply joined; [rewrite map_length, !skipn_length; congruence | rewrite map_length, !skipn_length; congruence | |].
    + intro k. pose proof (part_related _ _ contains f true _ _ hx) as hs. cbn [part] in hs. clear - hs. revert k. induction hs as [| a y c x' h hs IH]; intros [| k]; cbn [map nth]; try apply constant_holds; auto using zero_sound; apply IH.
    + intro k. rewrite lu.
      pose proof (near_hold bits turn tau ht t0 (repeat zero (m - f)) (repeat 0 (m - f)) ltac:(clear; induction (m - f)%nat; cbn [repeat]; constructor; auto using zero_sound) (skipn f u)
        ltac:(rewrite repeat_length; congruence) e2 [] (firstn f u) k) as N. rewrite l1, app_nil_r, firstn_skipn in N. exact N.
Qed.
Lemma near_point_centre : forall f m x d tau, length x = m -> (f <= m)%nat -> near_point f x d tau (nought m) = x ++ repeat 0 (m - f).
Proof.
  intros f m x d tau lx lf. unfold near_point. rewrite nought_length. rewrite <- (firstn_skipn f x) at 3. rewrite <- app_assoc.
  assert (Z : forall d y u, Forall (eq 0) u -> length u = length y -> moved d y u = y).
  { intros d' y u h. revert y. induction h as [| t u <- h IH]; intros [| a y] l; try discriminate; [reflexivity |]. unfold moved in *. cbn [combine map fst snd]. rewrite IH by (cbn in l; congruence). f_equal. ring. }
  assert (N : forall p, Forall (eq 0) (part f p (nought m))).
  { intro p. apply Forall_forall. intros t it. unfold nought in it. destruct p; cbn [part] in it; symmetry.
    - apply (repeat_spec m 0 t). rewrite <- (firstn_skipn f). apply in_or_app. right. exact it.
    - apply (repeat_spec m 0 t). rewrite <- (firstn_skipn f). apply in_or_app. left. exact it. }
  rewrite (Z d), (Z tau); [reflexivity | exact (N true) | rewrite skipn_length, nought_length, repeat_length; reflexivity | exact (N false) | rewrite !firstn_length, nought_length; lia].
Qed.

End Precision.
