(** * The test of accuracy of platforms that turn

    Of as many rows as coordinates (test/accuracy.rs): the matrices at control points, with the derivatives of w D by what has a tolerance. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Check.
From Orthocert.kernel Require Import Formula Linear Arithmetic Slope Definite Test Cell Apart Near Control Twofold.
From Orthocert.kernel Require Export Spread.

Import ListNotations.
Local Open Scope R_scope.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation unit := (unit_R bits).
Local Notation in_real := (Spread.in_real bits).
Local Notation spread := (Spread.spread bits).

(** ** The matrices at a control point *)

Fixpoint known_all (r : rows (option fixed)) : option (rows fixed) :=
  match r with
  | [] => Some []
  | (a, d) :: r' => match all_known a, d, known_all r' with Some a, Some d, Some rest => Some ((a, d) :: rest) | _, _, _ => None end
  end.
(** Of a joint d delta^2/2, its error over d, q, and half widths over d of what has a tolerance. *)
Record near_joint := NearJoint { j_square : fixed; j_error : fixed; j_root : fixed; j_halves : list fixed }.
Definition change_at (halves rates : list fixed) : fixed := fold_right (fun p sum => add (mul bits (fst p) (Near.point_of (magnitude (snd p)))) sum) zero (combine halves rates).
(** sum_j (r_j/d) |d(w D)/d theta_j|/2 + w d delta^2/2 + (e/d) (w D/q + q w)/2 *)
Definition bound_at (j : near_joint) (rates : list fixed) (d w : fixed) : fixed :=
  upper_end (add (add (halve (change_at (j_halves j) rates)) (mul bits (j_square j) w))
    (mul bits (j_error j) (add (halve (Arithmetic.ratio d (Fixed.integer bits 1) (j_root j))) (halve (mul bits (j_root j) w))))).
(** Of rows with these derivatives behind their [n] columns. *)
Fixpoint bounds_at (n : nat) (js : list near_joint) (w : fixed) (r : rows fixed) : list fixed :=
  match js, r with j :: l, (a, d) :: r' => bound_at j (skipn n a) d w :: bounds_at n l w r' | _, _ => [] end.
Definition pose_at (n : nat) (ws : list Z) (places : N) (Y : list (list Z)) (k2 z2 : fixed) (js : list near_joint) (s : sample (option fixed)) : bool :=
  match known_all (s_rows (option fixed) s), s_weight (option fixed) s, known_multiple (s_less (option fixed) s) with
  | Some rows, Some w, Some t =>
      let bs := bounds_at n js w rows in let rows := map (fun p => (weighted ws (fst p), snd p)) rows in
      let below := triangle_add (repeat [neg t] n) (gram places (solve_pairs places Y w rows)) in let corner := sub (mul bits w z2) t in
      Nat.eqb (length rows) n && Nat.eqb (length bs) n && is_shaped n below &&
      is_definite bits n (triangle_add (map (fun p => [neg (mul bits k2 (snd p))]) rows) below) &&
      forallb (fun z => is_definite bits (S n) (bordered_by below (signed (z ++ [false]) bs) corner)) (signs (pred n))
  | _, _, _ => false
  end.

Section Shown.
Variable tape : list (op address).
Variable params : list fixed.
Variable theta : list R.
Hypothesis theta_in : Forall2 contains params theta.
Variable thin : list (op address).
Hypothesis thin_is : is_thinned thin tape.
Variables (m : nat) (cell : list fixed) (x : list R).
Hypothesis x_in : Forall2 contains cell x.
Hypothesis dimension : length cell = m.
Local Notation at_ ps i := (at_pairs theta (entry_at tape i) ps).
Local Notation here i := (at_pairs theta (entry_at tape i) (parabola x)).
Local Notation look q := (fun i => nth i (evaluate_at bits params thin q) None).

Lemma known_all_sound : forall q ps r s, Forall2 (in_pair bits) q ps -> known_all (map_rows (look q) r) = Some s ->
  rows_rel contains s (map_rows (fun i => at_ ps i) r).
Proof.
  intros q ps r s h. revert s. induction r as [| [a d] r IH]; intros s e; [injection e as <-; constructor |]. rewrite map_rows_cons in e. cbn [known_all] in e.
  destruct (all_known _) as [b |] eqn:ea; [| discriminate]. pose proof (evaluate_at_sound bits tape params theta theta_in thin thin_is q ps h d) as V.
  destruct (nth d _ None) as [c |]; [| discriminate]. destruct (known_all _) as [rest |]; [| discriminate]. injection e as <-.
  rewrite map_rows_cons. constructor; [split; [exact (all_known_sound bits tape params theta theta_in thin thin_is q ps a b h ea) | exact V] | apply IH; reflexivity].
Qed.

(** *** What bounds stand for: rates are those of one machine for each joint, with what it differs by *)

Record real_joint := RealJoint { r_square : R; r_error : R; r_root : R; r_rates : list (R * (list R * nat)) }.
Definition change_real (rates : list (R * (list R * nat))) (ps : list (R * R)) : R :=
  total (map (fun t => fst t * at_pairs (fst (snd t)) (entry_at tape (snd (snd t))) ps) rates).
Definition bound_real (j : real_joint) (c d w : R) : R := c / 2 + r_square j * w + r_error j * (d / r_root j / 2 + r_root j * w / 2).
Fixpoint bounds_real (w : nat) (l : list real_joint) (ps : list (R * R)) (r : rows nat) : list R :=
  match l, r with j :: l', (_, d) :: r' => bound_real j (change_real (r_rates j) ps) (at_ ps d) (at_ ps w) :: bounds_real w l' ps r' | _, _ => [] end.
Definition is_rate (h : fixed * nat) (t : R * (list R * nat)) : Prop :=
  snd (snd t) = snd h /\ Forall2 contains params (fst (snd t)) /\ exists a, contains (fst h) a /\ Rabs (fst t) <= a.
Definition is_joint (n : nat) (j : near_joint) (a : list nat) (q : real_joint) : Prop :=
  contains (j_square j) (r_square q) /\ contains (j_error j) (r_error q) /\ contains (j_root j) (r_root q) /\ 0 <= r_error q /\ (0 < lo (j_root j))%Z /\
  Forall2 is_rate (combine (j_halves j) (skipn n a)) (r_rates q).
Fixpoint are_joints (n : nat) (js : list near_joint) (r : rows nat) (l : list real_joint) : Prop :=
  match js, r, l with [], [], [] => True | j :: js', p :: r', q :: l' => is_joint n j (fst p) q /\ are_joints n js' r' l' | _, _, _ => False end.

Lemma all_known_rest : forall n a s, all_known a = Some s -> all_known (skipn n a) = Some (skipn n s).
Proof.
  induction n as [| n IH]; intros a s h; [exact h |]. destruct a as [| [x0 |] a]; cbn [all_known] in h; [injection h as <-; reflexivity | | discriminate].
  destruct (all_known a) as [s' |] eqn:e; [| discriminate]. injection h as <-. exact (IH a s' e).
Qed.
Lemma change_sound : forall q ps, Forall2 (in_pair bits) q ps -> forall hs is vs ts, all_known (map (look q) is) = Some vs -> Forall2 is_rate (combine hs is) ts ->
  exists c, contains (change_at hs vs) c /\ Rabs (change_real ts ps) <= c.
Proof.
  intros q ps hq. unfold change_at, change_real, total. induction hs as [| h hs IH]; intros [| i is] vs ts hv ht; cbn [combine] in ht |- *; inversion ht as [| ? t ? ts' ht1 ht']; subst;
    cbn [map fold_right]; try (cbn in hv; injection hv as <-); try (exists 0; split; [apply zero_sound | rewrite Rabs_R0; apply Rle_refl]). destruct ht1 as [e [hth [a [ha la]]]].
  cbn [map all_known] in hv. destruct (nth i (evaluate_at bits params thin q) None) as [v |] eqn:ev; [| discriminate]. destruct (all_known _) as [vs' |] eqn:evs; [| discriminate]. injection hv as <-.
  destruct (IH is vs' ts' evs ht') as [c [c1 c2]]. cbn [combine fold_right fst snd] in *. rewrite e.
  pose proof (evaluate_at_sound bits tape params _ hth thin thin_is q ps hq i) as V. rewrite ev in V. cbn [has_value] in V. pose proof (magnitude_above bits _ _ V) as M.
  exists (a * (IZR (magnitude v) / unit) + c). split; [apply add_sound; [apply mul_sound; [exact ha | apply point_sound] | exact c1] |].
  eapply Rle_trans; [apply Rabs_triang |]. apply Rplus_le_compat; [| exact c2]. rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos.
Qed.
Lemma bounds_sound : forall n w q ps, Forall2 (in_pair bits) q ps -> forall js r l rows b, are_joints n js r l -> contains b (at_ ps w) -> known_all (map_rows (look q) r) = Some rows ->
  exists y, Forall2 contains (bounds_at n js b rows) y /\ Forall2 Rle (bounds_real w l ps r) y /\ length y = length (bounds_at n js b rows).
Proof.
  intros n w q ps hq. induction js as [| j js IH]; intros [| [a d] r] [| t l] rows b hj hw h; try contradiction; [injection h as <-; exists []; repeat split; constructor |].
  destruct hj as [[h1 [h2 [h3 [h4 [h5 h6]]]]] hj]. rewrite map_rows_cons in h. cbn [known_all fst] in *. destruct (all_known _) as [vs |] eqn:ea; [| discriminate].
  pose proof (evaluate_at_sound bits tape params theta theta_in thin thin_is q ps hq d) as V. destruct (nth d _ None) as [c |]; [| discriminate].
  destruct (known_all _) as [rest |] eqn:er; [| discriminate]. injection h as <-. destruct (IH r l rest b hj hw er) as [y [y1 [y2 y3]]].
  pose proof (all_known_rest n _ _ ea) as er'. rewrite skipn_map in er'. destruct (change_sound q ps hq _ _ _ _ er' h6) as [v [v1 v2]]. cbn [bounds_at bounds_real].
  assert (B : contains (add (add (halve (change_at (j_halves j) (skipn n vs))) (mul bits (j_square j) b))
    (mul bits (j_error j) (add (halve (Arithmetic.ratio c (Fixed.integer bits 1) (j_root j))) (halve (mul bits (j_root j) b))))) (bound_real t v (at_ ps d) (at_ ps w))).
  { unfold bound_real. repeat apply add_sound; [apply halve_sound, v1 | apply mul_sound; assumption |]. apply mul_sound; [exact h2 |]. apply add_sound; apply halve_sound; [| apply mul_sound; assumption].
    replace (at_ ps d / r_root t) with (at_ ps d * 1 / r_root t) by (unfold Rdiv; ring). apply Arithmetic.ratio_sound; [exact h5 | exact V | apply Fixed.integer_sound | exact h3]. }
  destruct (upper_end_sound bits _ _ B) as [z [z1 z2]]. exists (z :: y). split; [constructor; [exact z1 | exact y1] |]. split; [constructor; [| assumption] | cbn; congruence].
  eapply Rle_trans; [| exact z2]. unfold bound_real. pose proof (Rle_abs (change_real (r_rates t) ps)). lra.
Qed.
Lemma joints_positive : forall n js r l, are_joints n js r l -> Forall (fun q => 0 <= r_error q /\ 0 < r_root q) l.
Proof.
  intros n. induction js as [| j js IH]; intros [| p r] [| q l] h; try contradiction; constructor; [| exact (IH r l (proj2 h))].
  destruct h as [[_ [_ [h3 [h4 [h5 _]]]]] _]. split; [exact h4 | exact (contains_positive bits _ _ h5 h3)].
Qed.

(** The parts of D and of the weight in the bounds, and that of the rates. *)
Definition of_D (s : R) (l : list real_joint) (v : list R) : list R := map (fun p => - s * (r_error (fst p) / r_root (fst p) * Rabs (snd p))) (combine l v).
Definition of_W (l : list real_joint) (v : list R) : R := total (map (fun p => (2 * r_square (fst p) + r_error (fst p) * r_root (fst p)) * Rabs (snd p)) (combine l v)).
Definition of_rates (l : list real_joint) (v : list R) (ps : list (R * R)) : R := total (map (fun p => Rabs (snd p) * change_real (r_rates (fst p)) ps) (combine l v)).
Lemma bounds_split : forall w ps s l r v, Forall (fun q => 0 <= r_error q /\ 0 < r_root q) l -> length l = length v -> length r = length v ->
  2 * s * dot (bounds_real w l ps r) (map Rabs v) = - dot (of_D s l v) (map snd (map_rows (fun i => at_ ps i) r)) + s * at_ ps w * of_W l v + s * of_rates l v ps.
Proof.
  intros w ps s l r v h. revert r v. induction h as [| q l [b0 q0] h IH]; intros [| [a d] r] [| y v] l1 l2; try discriminate; [unfold of_D, of_W, of_rates, total; cbn; ring |].
  unfold of_D, of_W, of_rates, total in *. rewrite map_rows_cons. cbn [bounds_real map combine dot fst snd fold_right] in *. specialize (IH r v ltac:(cbn in l1; lia) ltac:(cbn in l2; lia)).
  rewrite Rmult_plus_distr_l, IH. unfold bound_real. field. lra.
Qed.

Variables (l : multiple) (e n : nat) (places : N) (Y : list (list Z)) (r : rows nat) (w : nat) (k2 z2 : fixed) (K Z_ : R) (ws : list Z)
  (js : list near_joint) (lr : list real_joint).
Hypothesis affine : forallb (is_affine_at tape m) (w :: all_places r) = true.
Hypothesis l_affine : is_affine_multiple tape m l = true.
Hypothesis l_nonneg : 0 <= less_at tape theta (parabola x) l.
Hypothesis eased : e = O \/ is_eased tape m e r w l = true.
Hypothesis w_positive : 0 < here w.
Hypothesis shown : at_controls bits params thin m cell e (pose_at n ws places Y k2 z2 js) (sample_of r w l).
Hypothesis K_in : contains k2 K.
Hypothesis Z_in : contains z2 Z_.
Hypothesis K_nonneg : 0 <= K.
Hypothesis joints_ : are_joints n js r lr.
Hypothesis Y_length : length Y = n.
Hypothesis r_length : length r = n.
Hypothesis lr_length : length lr = n.
Let e_ : list R := map IZR ws.

Section Direction.
Variable v : list R.
Hypothesis v_length : length v = n.
Let y := weighted_sum v (map (map (Y_value places)) Y).
Let u := scaled e_ y.
Let below (R_ : rows R) := weighted_sum v (map (scaled e_) (map fst R_)).

Lemma below_dot : forall R_, dot (weighted_sum v (map fst R_)) u = dot (below R_) y.
Proof. intro R_. unfold below, u. rewrite !dot_weighted. f_equal. unfold image. rewrite !map_map. apply map_ext. intro p. symmetry. apply dot_scaled. Qed.

Lemma at_point : forall c ps, length c = m -> ends_first e c -> Forall2 (in_pair bits) (points bits cell c) ps ->
  let R_ := map_rows (fun i => at_ ps i) r in let W := at_ ps w in let L := less_at tape theta ps l in
  (nonzero v -> 0 < 2 * dot (below R_) y - W * dot y y - L * dot v v - K * dot (map snd R_) (squares v)) /\
  forall s, 0 < dot v v + s ^ 2 -> 0 < 2 * dot (below R_) y - W * dot y y - L * dot v v - 2 * Rabs s * dot (bounds_real w lr ps r) (map Rabs v) + (W * Z_ - L) * s ^ 2.
Proof.
  intros c ps lc ec hp R_ W L. specialize (shown c lc ec). unfold pose_at in shown. pose proof (evaluate_at_sound bits tape params theta theta_in thin thin_is _ ps hp w) as hw.
  destruct (known_all _) as [rows |] eqn:er; [| discriminate]. cbn [map_sample sample_of s_rows s_weight] in er, shown. destruct (nth w (evaluate_at _ _ _ _) None) as [a |]; [| discriminate].
  match type of shown with context [known_multiple ?q] => destruct (known_multiple q) as [t |] eqn:et; [| discriminate] end.
  pose proof (multiple_sound bits tape params theta theta_in thin thin_is _ ps r w l t hp et) as hL. fold L in hL. cbn [has_value] in hw. fold W in hw.
  pose proof (known_all_sound _ ps r rows hp er) as hr. fold R_ in hr. cbv zeta in shown.
  set (rowsE := map (fun p => (weighted ws (fst p), snd p)) rows) in *. set (RE := map (fun p => (scaled e_ (fst p), snd p)) R_).
  assert (hE : rows_rel contains rowsE RE).
  { unfold rowsE, RE. apply (map_related _ _ _ _ (fun p q => Forall2 contains (fst p) (fst q) /\ contains (snd p) (snd q))); [| exact hr].
    intros p q [h1 h2]. split; [apply weighted_sound, h1 | exact h2]. }
  set (t_ := triangle_add (repeat [neg t] n) _) in *. set (bs := bounds_at n js a rows) in *.
  apply andb_true_iff in shown as [shown signs_]. apply andb_true_iff in shown as [shown first]. apply andb_true_iff in shown as [shown shape]. apply andb_true_iff in shown as [l1 l2].
  apply Nat.eqb_eq in l1, l2.
  assert (lRE : length RE = n) by (rewrite <- l1; symmetry; exact (related_length _ _ _ _ _ hE)).
  assert (fstE : map fst RE = map (scaled e_) (map fst R_)) by (unfold RE; rewrite !map_map; reflexivity).
  assert (sndE : map snd RE = map snd R_) by (unfold RE; rewrite map_map; reflexivity).
  pose proof (gram_sound bits places _ _ (solve_pairs_sound bits places Y a W rowsE RE hw hE)) as hg.
  pose proof (triangle_add_sound bits _ _ _ _ (diagonal_in bits _ _ n (neg_sound bits _ _ hL)) hg) as ht. fold t_ in ht. set (T := tcomb 1 1 (diagonal n (- L)) _) in ht.
  assert (QT : quad T v = 2 * dot (below R_) y - W * dot y y - L * dot v v).
  { unfold T. rewrite quad_tcomb. rewrite <- v_length at 1. rewrite quad_diagonal, quad_pairs by congruence. rewrite fstE. fold y. fold (below R_). ring. }
  assert (lT : length T = n).
  { rewrite (shaped_related bits n t_ T ht) in shape. clear - shape. revert shape. generalize T. induction n as [| k IH]; intros [| r0 T0] h; cbn [is_shaped] in h; try discriminate; [reflexivity |].
    apply andb_true_iff in h as [_ h]. cbn [length]. rewrite (IH T0 h). reflexivity. }
  split.
  - intro nz. unfold is_definite in first. destruct (Nat.eqb_spec (length (triangle_add (map (fun p => [neg (mul bits k2 (snd p))]) rowsE) t_)) n) as [q | q]; [| discriminate].
    assert (hd : triangle_in bits (map (fun p => [neg (mul bits k2 (snd p))]) rowsE) (map (fun a => [a]) (map (fun d => - (K * d)) (map snd RE)))).
    { rewrite !map_map. apply (map_related _ _ _ _ (fun p q => Forall2 contains (fst p) (fst q) /\ contains (snd p) (snd q))); [| exact hE].
      intros p0 q0 [_ h2]. constructor; [apply neg_sound, mul_sound; assumption | constructor]. }
    pose proof (triangle_add_sound bits _ _ _ _ hd ht) as hT. pose proof (is_positive_definite_sound bits _ _ first hT v) as Q.
    rewrite (related_length _ _ _ _ _ hT) in q. specialize (Q ltac:(congruence) nz). rewrite quad_tcomb, quad_singles, QT, sndE in Q.
    assert (M : forall ds, dot (map (fun d => - (K * d)) ds) (squares v) = - K * dot ds (squares v)).
    { intro ds. rewrite <- dot_map. f_equal. apply map_ext. intro d. ring. }
    rewrite M in Q. lra.
  - intros s nz. destruct (bounds_sound n w _ ps hp js r lr rows a joints_ hw er) as [b [b1 [b2 b3]]]. fold bs in b1, b3.
    assert (lb : length b = length v) by congruence.
    destruct (worst_signs_but_last s v b lb) as [z' [s' [lz' [es hz']]]]. rewrite v_length in lz'. rewrite forallb_forall in signs_. specialize (signs_ z' ltac:(rewrite <- lz'; apply signs_all)). unfold is_definite in signs_.
    destruct (Nat.eqb_spec (length (bordered_by t_ (signed (z' ++ [false]) bs) (sub (mul bits a z2) t))) (S n)) as [q |]; [| discriminate].
    pose proof (bordered_by_sound bits t_ T _ _ _ _ ht (signed_sound bits (z' ++ [false]) bs b b1) (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ hw Z_in) hL)) as hB.
    pose proof (is_positive_definite_sound bits _ _ signs_ hB (v ++ [s'])) as Q. rewrite (related_length _ _ _ _ _ hB) in q. specialize (Q ltac:(rewrite q, app_length; cbn [length]; lia)).
    assert (D2 : dot (v ++ [s']) (v ++ [s']) = dot v v + s ^ 2).
    { rewrite <- es. clear. induction v as [| x0 v0 IH]; cbn [app dot]; [ring | rewrite IH; ring]. }
    unfold nonzero in Q. rewrite D2 in Q. specialize (Q nz).
    rewrite quad_bordered in Q; [| rewrite <- (shaped_related bits _ _ _ ht), v_length; exact shape | rewrite map_length, combine_length, app_length; cbn [length]; lia].
    rewrite QT, es in Q. replace (2 * s' * dot _ v) with (2 * (s' * dot (map (fun p => sign_of (fst p) * snd p) (combine (z' ++ [false]) b)) v)) in Q by ring. rewrite hz' in Q.
    pose proof (Rabs_pos s) as s0. assert (V0 : Forall (fun x0 => 0 <= x0) (map Rabs v)) by (rewrite Forall_map; apply Forall_forall; intros; apply Rabs_pos).
    destruct (dot_le _ _ _ b2 V0) as [le | bad]; [| exfalso; apply bad; rewrite (related_length _ _ _ _ _ b2), map_length; exact lb].
    assert (Rabs s * dot (bounds_real w lr ps r) (map Rabs v) <= Rabs s * dot b (map Rabs v)) by (apply Rmult_le_compat_l; assumption). lra.
Qed.

Let R_ := map_rows (fun i => here i) r.
Let W := here w.
Lemma ds_length : length (map snd R_) = n.
Proof. unfold R_, map_rows. rewrite !map_length. exact r_length. Qed.
Lemma v_nonneg : 0 <= dot v v.
Proof. apply dot_self. Qed.

(** |p - W y|^2 >= 0 *)
Lemma below_square_ : W * (2 * dot (below R_) y - W * dot y y) <= dot (below R_) (below R_).
Proof.
  set (p := below R_). pose proof (dot_self (comb 1 (- W) p y)) as N. rewrite dot_comb, !dot_right, (dot_commutes y p) in N. nra.
Qed.

Lemma falls_ : forall us c d, Forall (fun z => z <= 0) us ->
  falls e x (fun ps => form (combine (map (Rmult 2) v) us) (map_rows (fun i => at_ ps i) r) u + c * at_ ps w + d * less_at tape theta ps l).
Proof.
  intros us c d h. destruct eased as [-> | E]; [intros before front z after s _ _ i _; lia |]. apply (weighted_falls bits tape theta m cell x x_in dimension); [exact E | lra |].
  apply Forall_forall. intros [a b] i. apply in_combine_r in i. rewrite Forall_forall in h. exact (h b i).
Qed.
Lemma rows_at : forall ps, length (map_rows (fun i => at_ ps i) r) = length v.
Proof. intro ps. unfold map_rows. rewrite map_length. congruence. Qed.

Theorem lower_here : nonzero v -> K * W * dot (map snd R_) (squares v) <= dot (below R_) (below R_).
Proof.
  intro nz. set (us := map (fun t => - K * t ^ 2) v).
  assert (T : 0 < form (combine (map (Rmult 2) v) us) R_ u + - dot y y * W + - dot v v * less_at tape theta (parabola x) l).
  { apply (decide bits m cell x x_in dimension (fun ps => form (combine (map (Rmult 2) v) us) (map_rows (fun i => at_ ps i) r) u + - dot y y * at_ ps w + - dot v v * less_at tape theta ps l) e).
    - apply weight_affine; assumption.
    - apply falls_. unfold us. rewrite Forall_map. apply Forall_forall. intros t _. pose proof (pow2_ge_0 t). nra.
    - intros c ps lc ec hp. pose proof (proj1 (at_point c ps lc ec hp) nz) as Q. cbv zeta in Q. rewrite form_both by (rewrite ?rows_at; unfold us; rewrite ?map_length; reflexivity). rewrite below_dot.
      assert (E : dot us (map snd (map_rows (fun i => at_ ps i) r)) = - K * dot (map snd (map_rows (fun i => at_ ps i) r)) (squares v)).
      { rewrite (dot_commutes (map snd _)), <- dot_map. unfold us, squares. rewrite map_map. reflexivity. }
      rewrite E. lra. }
  rewrite form_both in T by (unfold R_; rewrite ?rows_at; unfold us; rewrite ?map_length; reflexivity). rewrite below_dot in T.
  assert (E : dot us (map snd R_) = - K * dot (map snd R_) (squares v)).
  { rewrite (dot_commutes (map snd _)), <- dot_map. unfold us, squares. rewrite map_map. reflexivity. }
  rewrite E in T. pose proof below_square_ as B. pose proof v_nonneg as V0. assert (0 <= dot v v * less_at tape theta (parabola x) l) by (apply Rmult_le_pos; assumption).
  assert (0 <= W * (2 * dot (below R_) y - W * dot y y - K * dot (map snd R_) (squares v))) by (apply Rmult_le_pos; unfold W in *; lra). lra.
Qed.

(** Rates are affine, too, and have no squares where there are ends alone. *)
Lemma rates_in : forall t, In t (flat_map r_rates lr) -> In (snd (snd t)) (flat_map fst r).
Proof.
  intros t i. clear - i joints_. revert r lr joints_ i. induction js as [| j js' IH]; intros [| [a d] r'] [| q lr'] h i; try contradiction. destruct h as [[_ [_ [_ [_ [_ h]]]]] h'].
  cbn [flat_map fst] in *. apply in_app_or in i as [i | i]; apply in_or_app; [left | right; exact (IH r' lr' h' i)]. clear - h i.
  assert (In (snd (snd t)) (skipn n a)); [| rewrite <- (firstn_skipn n a); apply in_or_app; right; assumption].
  revert h. generalize (skipn n a) (j_halves j). intros is hs h. assert (K : exists p, In p (combine hs is) /\ snd (snd t) = snd p).
  { induction h as [| p t' ps ts [e _] h IH]; [contradiction |]. destruct i as [-> | i]; [exists p; split; [left; reflexivity | exact e] | destruct (IH i) as [p' [i' e']]; exists p'; split; [right; exact i' | exact e']]. }
  destruct K as [[p i'] [ip ->]]. exact (in_combine_r _ _ _ _ ip).
Qed.
Lemma of_rates_from : forall P : (list (R * R) -> R) -> Prop, P (fun _ => 0) -> (forall f g, P f -> P g -> P (fun ps => f ps + g ps)) -> (forall c f, P f -> P (fun ps => c * f ps)) ->
  (forall th i, In i (flat_map fst r) -> P (fun ps => at_pairs th (entry_at tape i) ps)) -> P (of_rates lr v).
Proof.
  intros P p0 p1 p2 p3. pose proof rates_in as I. clear - I p0 p1 p2 p3. unfold of_rates, change_real, total. revert v I. induction lr as [| q lr' IH]; intros [| y v'] I; cbn [combine map fold_right]; try exact p0.
  cbn [fst snd]. apply p1; [apply p2 | apply IH; intros t i; apply I; cbn [flat_map]; apply in_or_app; right; exact i].
  assert (J : forall t, In t (r_rates q) -> In (snd (snd t)) (flat_map fst r)) by (intros t i; apply I; cbn [flat_map]; apply in_or_app; left; exact i). clear - J p0 p1 p2 p3.
  induction (r_rates q) as [| t ts IH]; cbn [map fold_right]; [exact p0 |]. apply p1; [apply p2, p3, J; left; reflexivity | apply IH; intros t' i; apply J; right; exact i].
Qed.
Lemma rates_affine : affine_there m (of_rates lr v).
Proof.
  apply of_rates_from.
  - intros before after a b c p q s _ _. ring.
  - intros f g hf hg before after a b c p q s len su. rewrite (hf before after a b c p q s len su), (hg before after a b c p q s len su). ring.
  - intros k f hf before after a b c p q s len su. rewrite (hf before after a b c p q s len su). ring.
  - intros th i ii. apply entry_affine. cbn [forallb] in affine. apply andb_true_iff in affine as [_ h]. rewrite forallb_forall in h. apply h.
    apply in_flat_map in ii as [p [ip ii]]. apply in_flat_map. exists p. split; [exact ip | apply in_or_app; left; exact ii].
Qed.
Lemma rates_stay : forall before front z after s, x = front ++ z :: after -> length before = length front -> (length front < e)%nat ->
  of_rates lr v (before ++ (z, s) :: parabola after) = of_rates lr v (before ++ (z, z ^ 2) :: parabola after).
Proof.
  intros before front z after s ex lb le. apply (of_rates_from (fun g => g (before ++ (z, s) :: parabola after) = g (before ++ (z, z ^ 2) :: parabola after))); [reflexivity | | |].
  - intros f g -> ->. reflexivity.
  - intros c f ->. reflexivity.
  - intros th i ii. destruct eased as [e0 | E]; [lia |]. unfold is_eased, eased_in in E. cbv zeta in E. rewrite forallb_forall in E.
    assert (L : m = S (length before + length (parabola after))).
    { unfold parabola. rewrite map_length. rewrite <- dimension, (related_length _ _ _ _ _ x_in), ex, app_length, lb. cbn [length]. lia. }
    specialize (E (length before) ltac:(apply in_seq; lia)). apply andb_true_iff in E as [E _]. apply andb_true_iff in E as [_ E]. rewrite forallb_forall in E.
    apply in_flat_map in ii as [p [ip ii]]. specialize (E p ip). apply andb_true_iff in E as [E _]. rewrite forallb_forall in E. apply without_value. rewrite <- L. exact (E i ii).
Qed.

Theorem first_here : forall s, 0 < dot v v + s ^ 2 -> 0 < dot (below R_) (below R_) - 2 * Rabs s * W * dot (bounds_real w lr (parabola x) r) (map Rabs v) + W ^ 2 * Z_ * s ^ 2.
Proof.
  intros s nz. pose proof (joints_positive _ _ _ _ joints_) as pp.
  set (c0 := - dot y y - Rabs s * of_W lr v + Z_ * s ^ 2).
  assert (Split := fun ps => bounds_split w ps (Rabs s) lr r v pp ltac:(congruence) ltac:(congruence)).
  assert (lD : length (of_D (Rabs s) lr v) = length v) by (unfold of_D; rewrite map_length, combine_length; lia).
  set (base := fun ps => form (combine (map (Rmult 2) v) (of_D (Rabs s) lr v)) (map_rows (fun i => at_ ps i) r) u + c0 * at_ ps w + - (dot v v + s ^ 2) * less_at tape theta ps l).
  assert (T : 0 < base (parabola x) + - Rabs s * of_rates lr v (parabola x)).
  { apply (decide bits m cell x x_in dimension (fun ps => base ps + - Rabs s * of_rates lr v ps) e).
    - intros before after a b c p q t len su. rewrite (rates_affine before after a b c p q t len su). unfold base.
      rewrite (weight_affine tape theta m r (combine (map (Rmult 2) v) (of_D (Rabs s) lr v)) w c0 l (- (dot v v + s ^ 2)) u affine l_affine before after a b c p q t len su). ring.
    - intros before front z after t ex lb le zs. rewrite (rates_stay before front z after t ex lb le). apply Rplus_le_compat_r. refine (falls_ _ _ _ _ before front z after t ex lb le zs).
      unfold of_D. rewrite Forall_map. apply Forall_forall. intros [q t'] i. apply in_combine_l in i. rewrite Forall_forall in pp. destruct (pp _ i) as [b0 q0]. cbn [fst snd] in *.
      assert (0 <= r_error q / r_root q * Rabs t') by (apply Rmult_le_pos; [apply Rmult_le_pos; [exact b0 | apply Rlt_le, Rinv_0_lt_compat, q0] | apply Rabs_pos]).
      pose proof (Rabs_pos s). assert (0 <= Rabs s * (r_error q / r_root q * Rabs t')) by (apply Rmult_le_pos; assumption). lra.
    - intros c ps lc ec hp. pose proof (proj2 (at_point c ps lc ec hp) s nz) as Q. cbv zeta in Q. rewrite Split in Q. unfold base. rewrite form_both by (rewrite ?rows_at; congruence). rewrite below_dot. unfold c0. lra. }
  unfold base in T. fold R_ W in T. rewrite form_both in T by (unfold R_; rewrite ?rows_at; congruence). rewrite below_dot in T. specialize (Split (parabola x)). fold R_ in Split. fold W in Split.
  assert (T2 : 0 < 2 * dot (below R_) y - W * dot y y - 2 * Rabs s * dot (bounds_real w lr (parabola x) r) (map Rabs v) + W * Z_ * s ^ 2).
  { assert (0 <= (dot v v + s ^ 2) * less_at tape theta (parabola x) l) by (apply Rmult_le_pos; lra). rewrite Split. unfold c0 in T. lra. }
  pose proof below_square_ as B. assert (T3 : 0 < W * (2 * dot (below R_) y - W * dot y y - 2 * Rabs s * dot (bounds_real w lr (parabola x) r) (map Rabs v) + W * Z_ * s ^ 2)) by (apply Rmult_lt_0_compat; assumption).
  lra.
Qed.
End Direction.
End Shown.

(** ** The test *)

(** Rows with derivatives of w D behind their columns, and with each joint the half widths that these are multiplied by. *)
Record near_test := NearTest { n_rows : rows nat; n_weight : nat; n_ends : nat; n_far : list (list nat); n_reach : list nat;
  n_joints : list (nat * (fixed * list (fixed * nat)) * list fixed); n_distance : fixed; n_turn : fixed; n_first : nat; n_last : bool }.

(** d delta^2/2: on the cell, tolerances put a joint off by at most d delta. *)
Definition square_off (values : list (option slope)) (d : fixed) (j : nat * (fixed * list (fixed * nat))) : option fixed :=
  match nth (fst j) values None, Check.all_some (map (fun h => option_map (fun s => range s) (nth (snd h) values None)) (snd (snd j))) with
  | Some _, Some rates => Some (upper_end (halve (mul bits d (sqr bits (change_at (map fst (snd (snd j))) rates)))))
  | _, _ => None
  end.
Definition joint_near (p : fixed * fixed * (nat * (fixed * list (fixed * nat)) * list fixed)) : near_joint :=
  NearJoint (fst (fst p)) (fst (snd (fst (snd p)))) (snd (fst p)) (snd (snd p)).
(** sqrt(D/w) at the first control point and the last, in the middle of both. *)
Definition root_of (ts : list tensor) (m w : nat) (row : list nat * nat) : option fixed :=
  let at_ j := match value_at (nth (snd row) ts (Constant None)) (repeat j m), value_at (nth w ts (Constant None)) (repeat j m) with
    | Some d, Some w => Fixed.root bits (lower_end (Arithmetic.ratio d (Fixed.integer bits 1) w))
    | _, _ => None
    end in
  match at_ Low, at_ High with
  | Some a, Some b => let q := lower_end (halve (add a b)) in if (0 <? lo q)%Z then Some q else None
  | _, _ => None
  end.
Definition are_all (values : list (option slope)) (l : list nat) : option (list slope) := Check.all_some (map (fun i => nth i values None) l).
Definition near_values (plain : list (op address)) (params cell : list fixed) (m : nat) (a : near_test) : list (option slope) :=
  run_kept (option slope) None (slope_op bits (near_cell (n_first a) m cell (n_distance a) (n_turn a)) (map constant params))
    (kept (concat (n_far a) ++ n_reach a) plain) plain.
Definition shows_pose (plain : list (op address)) (params cell : list fixed) (values : list (option slope)) (ts : list tensor) (m : nat) (a : near_test) (l : multiple)
    (places : N) (Y : list (list Z)) (kappa : Z) (q : N) : bool :=
  let f := n_first a in let near := near_values plain params cell m a in
  (N.eqb q 0 || (N.leb q 16 && Nat.ltb 0 f && Nat.ltb f m)) && Nat.leb f m && Nat.eqb (length cell) m && Nat.eqb (length Y) m && Nat.eqb (length (n_rows a)) m &&
  Nat.eqb (length (n_joints a)) m && Nat.eqb (length (n_far a)) m && forallb (fun row => Nat.eqb (length row) m) (n_far a) &&
  match Check.all_some (map (are_all near) (n_far a)), are_all near (n_reach a), Check.all_some (map (fun j => square_off values (n_distance a) (fst j)) (n_joints a)),
    Check.all_some (map (root_of ts m (n_weight a)) (n_rows a)) with
  | Some far, Some _, Some offs, Some roots =>
      let g := spread m f far in let k := Arithmetic.dyadic kappa places (Fixed.integer bits 1) in
      (0 <? lo (sub k g))%Z &&
      match recip bits k with
      | Some r => let z := sub (Fixed.integer bits 1) (halve (mul bits g r)) in
          everywhere (@map_sample) (n_ends a) m (pose_at m (weights_of m f (n_last a) q) places Y (sqr bits k) (sqr bits z) (map joint_near (combine (combine offs roots) (n_joints a))))
            (map_sample (fun i => nth i ts (Constant None)) (sample_of (n_rows a) (n_weight a) l))
      | None => false
      end
  | _, _, _, _ => false
  end.

(** |b| rho <= B, rho^2 = D/w, all times w. *)
Definition is_bounded (W : R) (b : R) (p : list R * R * R) : Prop := forall q, 0 <= q -> q ^ 2 = W * snd (fst p) -> Rabs b * q <= snd p.

Lemma bound_holds : forall W D d q t off e c a sq, 0 < W -> 0 < t -> 0 <= q -> q ^ 2 = W * D -> q * off = c / 2 - W * d * off ^ 2 / 2 -> d * off ^ 2 / 2 <= sq -> 0 <= d -> Rabs e <= a ->
  Rabs (off + e) * q <= Rabs c / 2 + sq * W + a * (D / t / 2 + t * W / 2).
Proof.
  intros W D d q t off e c a sq W0 t0 q0 q2 h hs d0 ha.
  assert (O : Rabs off * q <= Rabs c / 2 + sq * W).
  { rewrite <- (Rabs_pos_eq q) at 1 by exact q0. rewrite <- Rabs_mult, Rmult_comm, h. pose proof (pow2_ge_0 off). assert (N : 0 <= W * d * off ^ 2 / 2).
    { apply Rmult_le_pos; [apply Rmult_le_pos; [apply Rmult_le_pos; lra | assumption] | lra]. }
    assert (W * (d * off ^ 2 / 2) <= W * sq) by (apply Rmult_le_compat_l; lra).
    pose proof (Rle_abs c). pose proof (Rle_abs (- c)) as c'. rewrite Rabs_Ropp in c'. apply Rabs_le. lra. }
  assert (Q : q <= D / t / 2 + t * W / 2).
  { apply Rmult_le_reg_r with (2 * t * W); [repeat apply Rmult_lt_0_compat; lra |]. replace ((D / t / 2 + t * W / 2) * (2 * t * W)) with (W * D + t ^ 2 * W ^ 2) by (field; lra).
    rewrite <- q2. pose proof (pow2_ge_0 (q - t * W)). lra. }
  pose proof (Rabs_triang off e). pose proof (Rabs_pos e). assert (Rabs e * q <= a * (D / t / 2 + t * W / 2)) by (apply Rmult_le_compat; assumption).
  assert (Rabs (off + e) * q <= (Rabs off + Rabs e) * q) by (apply Rmult_le_compat_r; assumption). lra.
Qed.

Section Whole.
Variables tape plain : list (op address).
Variable params : list fixed.
Variable theta : list R.
Hypothesis theta_in : Forall2 contains params theta.
Variable m : nat.
Local Notation plain_at i := (nth i (formulas plain) (integer 0)).
Local Notation here x i := (at_pairs theta (entry_at tape i) (parabola x)).

(** J, near the point x. *)
Definition far_rows (x : list R) (a : near_test) (d tau : R) (u : list R) : list (list R) :=
  map (map (fun i => value (near_point (n_first a) x d tau u) theta (plain_at i))) (n_far a).
(** What a function of the machine differs by: derivatives, of one machine, by as much as these parameters may differ. *)
Definition differs_by (f : list R -> nat -> R) (hs : list (fixed * nat)) (c : R) : Prop :=
  exists th ts, Forall2 contains params th /\ Forall2 (fun h t => exists a, contains (fst h) a /\ Rabs t <= a) hs ts /\ c = dot ts (map (fun h => f th (snd h)) hs).
(** An error, and what tolerances put a joint off by, over d: rho off = c/2 - d off^2/2, c what rho^2 differs by over d. *)
Definition off_by (x : list R) (d : R) (w : nat) (p : nat * (fixed * list (fixed * nat)) * list fixed * (list nat * nat)) (b : R) : Prop :=
  exists off e c, b = off + e /\ (exists a, contains (fst (snd (fst (fst p)))) a /\ Rabs e <= a) /\
    differs_by (fun th i => value x th (plain_at i)) (snd (snd (fst (fst p)))) off /\
    differs_by (fun th i => at_pairs th (entry_at tape i) (parabola x)) (combine (snd (fst p)) (skipn m (fst (snd p)))) c /\
    forall q, 0 <= q -> q ^ 2 = here x w * here x (snd (snd p)) -> q * off = c / 2 - here x w * d * off ^ 2 / 2.
Definition own_columns (r : rows R) : rows R := map (fun p => (firstn m (fst p), snd p)) r.
Definition pose_found (x : list R) (a : near_test) : Prop := 0 < here x (n_weight a) ->
  (forall th, Forall2 contains params th -> Forall (fun j => defined x th (plain_at (fst (fst j)))) (n_joints a)) /\
  (n_first a <= m)%nat /\ length (n_rows a) = m /\ length (n_far a) = m /\ length (n_joints a) = m /\ Forall (fun row => length row = m) (n_far a) /\
  forall d tau, contains (n_distance a) d -> contains (n_turn a) tau -> 0 <= d -> 0 <= tau ->
  forall bs, Forall2 (off_by x d (n_weight a)) (combine (n_joints a) (n_rows a)) bs -> exists g, 0 <= g /\
  (forall u, inside (n_first a) m u -> Forall (fun i => defined (near_point (n_first a) x d tau u) theta (plain_at i)) (n_reach a) /\
    forall w, length w = m -> size (less (image (far_rows x a d tau u) w) (image (far_rows x a d tau (nought m)) w)) <= g * (norm (n_first a) w * norm (n_first a) u)) /\
  exists kappa z e Bs, g < kappa /\ 0 <= z /\ z + g / (2 * kappa) <= 1 /\ length e = m /\ (forall i, (i < m)%nat -> 0 < nth i e 0) /\
    (forall i, (i < m)%nat -> (if n_last a then n_first a <= i else i < n_first a)%nat -> nth i e 0 = 1) /\
    let R_ := own_columns (map_rows (fun i => here x i) (n_rows a)) in let W := here x (n_weight a) in
    Forall2 (is_bounded W) bs (combine R_ Bs) /\
    forall v, length v = m -> let p := weighted_sum v (map (scaled e) (map fst R_)) in
      kappa ^ 2 * W * dot (map snd R_) (squares v) <= dot p p /\
      forall s, 0 < dot v v + s ^ 2 -> 0 < dot p p - 2 * Rabs s * W * dot Bs (map Rabs v) + W ^ 2 * z ^ 2 * s ^ 2.

Lemma all_some_related : forall (A B : Type) (f : A -> option B) l m, Check.all_some (map f l) = Some m -> Forall2 (fun a b => f a = Some b) l m.
Proof.
  intros A B f. induction l as [| a l IH]; intros k e; cbn [map Check.all_some] in e; [injection e as <-; constructor |].
  destruct (f a) as [b |] eqn:fa; [| discriminate]. destruct (Check.all_some (map f l)) as [k' |]; [| discriminate]. injection e as <-. constructor; [exact fa | apply IH; reflexivity].
Qed.

Lemma square_off_sound : forall values x cs lambda, (forall th, Forall2 contains params th -> forall i, encloses bits lambda x cs th (nth i values None) (plain_at i)) ->
  forall dist d j sq off, contains dist d -> 0 <= d -> square_off values dist j = Some sq -> differs_by (fun th i => value x th (plain_at i)) (snd (snd j)) off ->
  contains sq (in_real (hi sq)) /\ d * off ^ 2 / 2 <= in_real (hi sq).
Proof.
  intros values x cs lambda E dist d [i [error hs]] sq off hd d0 e [th [ts [hth [hts eb]]]]. unfold square_off in e. cbn [fst snd] in *. specialize (E th hth).
  destruct (nth i values None); [| discriminate]. destruct (Check.all_some _) as [rs |] eqn:er; [| discriminate]. injection e as <-.
  assert (K : forall hs ts rs, Forall2 (fun h t => exists a, contains (fst h) a /\ Rabs t <= a) hs ts -> Forall2 (fun h r => option_map (fun s => range s) (nth (snd h) values None) = Some r) hs rs ->
    exists n, contains (change_at (map fst hs) rs) n /\ Rabs (dot ts (map (fun h => value x th (plain_at (snd h))) hs)) <= n).
  { clear - E. unfold change_at. induction hs as [| [h1 k] hs IH]; intros ts rs ht hr; inversion ht as [| ? t ? ts' ha ht']; subst; inversion hr as [| ? r ? rs' er hr']; subst; cbn [map combine fold_right dot].
    - exists 0. split; [apply zero_sound | rewrite Rabs_R0; apply Rle_refl].
    - destruct ha as [a [ha la]]. cbn [fst snd] in *. destruct (nth k values None) as [s0 |] eqn:ed; [| discriminate]. injection er as <-. cbn [fst snd].
      pose proof (E k) as Ed. rewrite ed in Ed. destruct Ed as [_ [_ [_ [hv _]]]]. pose proof (magnitude_above bits _ _ hv) as M. set (v := value x th (plain_at k)) in *.
      destruct (IH ts' rs' ht' hr') as [n [n1 n2]]. exists (a * (IZR (magnitude (range s0)) / unit) + n). split; [apply add_sound; [apply mul_sound; [exact ha | apply point_sound] | exact n1] |].
      eapply Rle_trans; [apply Rabs_triang |]. apply Rplus_le_compat; [| exact n2]. rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos. }
  destruct (K hs ts rs hts (all_some_related _ _ _ _ _ er)) as [n [n1 n2]]. rewrite <- eb in n2. clear K.
  destruct (upper_end_sound bits _ _ (halve_sound bits _ _ (mul_sound bits _ _ _ _ hd (sqr_sound bits _ _ n1)))) as [z [z1 z2]]. set (sq := upper_end _) in *.
  assert (P : contains sq (in_real (hi sq))) by (unfold sq, upper_end; cbn [hi]; apply point_sound). split; [exact P |]. apply Rle_trans with (d * n ^ 2 / 2).
  - assert (off ^ 2 <= n ^ 2) by (rewrite <- (pow2_abs off); pose proof (Rabs_pos off); nra). assert (d * off ^ 2 <= d * n ^ 2) by (apply Rmult_le_compat_l; assumption). lra.
  - apply Rle_trans with (1 := z2). destruct z1 as [_ z1]. pose proof (unit_R_pos bits) as u0. unfold in_real. apply Rmult_le_reg_r with unit; [exact u0 |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
Qed.

(** Of each joint one machine, and signs with which its derivatives bound the change. *)
Lemma rates_found : forall x hs c, differs_by (fun th i => at_pairs th (entry_at tape i) (parabola x)) hs c -> exists rates, Forall2 (is_rate params) hs rates /\ change_real tape rates (parabola x) = Rabs c.
Proof.
  intros x hs c [th [ts [hth [hts ->]]]]. set (f := fun i => at_pairs th (entry_at tape i) (parabola x)).
  assert (K : forall s, s = 1 \/ s = -1 -> exists rates, Forall2 (is_rate params) hs rates /\ change_real tape rates (parabola x) = s * dot ts (map (fun h => f (snd h)) hs)).
  { intros s hs1. exists (map (fun p => (s * snd p, (th, snd (fst p)))) (combine hs ts)). unfold change_real, total. induction hts as [| h t hs' ts' [a [ha la]] h' [I1 I2]]; cbn [combine map fold_right dot fst snd]; [split; [constructor | ring] |].
    split; [| rewrite I2; unfold f; ring]. constructor; [| exact I1]. unfold is_rate. cbn [fst snd]. split; [reflexivity |]. split; [exact hth |]. exists a. split; [exact ha |].
    replace (Rabs (s * t)) with (Rabs t); [exact la |]. destruct hs1 as [-> | ->]; [rewrite Rmult_1_l; reflexivity | replace (-1 * t) with (- t) by ring; rewrite Rabs_Ropp; reflexivity]. }
  set (c := dot ts (map (fun h => f (snd h)) hs)) in *. change (dot ts (map (fun h => at_pairs th (entry_at tape (snd h)) (parabola x)) hs)) with c.
  destruct (Rle_dec 0 c) as [p | n]; [destruct (K 1 (or_introl eq_refl)) as [rates [k1 k2]] | destruct (K (-1) (or_intror eq_refl)) as [rates [k1 k2]]]; exists rates; split; try exact k1; rewrite k2;
    [rewrite Rabs_pos_eq by exact p; ring | rewrite Rabs_left by lra; ring].
Qed.

Lemma joints_found : forall values x cs lambda, (forall th, Forall2 contains params th -> forall i, encloses bits lambda x cs th (nth i values None) (plain_at i)) ->
  forall ts w dist d, contains dist d -> 0 <= d -> 0 < here x w -> forall joints rows offs roots bs, length joints = length rows ->
  Forall2 (fun j sq => square_off values dist (fst j) = Some sq) joints offs -> Forall2 (fun row q => root_of ts m w row = Some q) rows roots -> Forall2 (off_by x d w) (combine joints rows) bs ->
  exists lr, are_joints params m (map joint_near (combine (combine offs roots) joints)) rows lr /\
    Forall2 (is_bounded (here x w)) bs (combine (own_columns (map_rows (fun i => here x i) rows)) (bounds_real tape theta w lr (parabola x) rows)).
Proof.
  intros values x cs lambda E ts w dist d hd d0 w0. induction joints as [| [j halves] joints IH]; intros [| [A D] rows] offs roots bs len ho hr hb; try discriminate; cbn [combine] in hb; inversion ho; inversion hr; inversion hb; subst;
    [exists []; split; [exact I | constructor] |].
  match goal with h : Forall2 _ joints ?o, h' : Forall2 _ rows ?q, h'' : Forall2 _ (combine joints rows) ?b |- _ => destruct (IH rows o q b ltac:(cbn in len; congruence) h h' h'') as [lr [I1 I2]] end.
  match goal with h : square_off _ _ _ = Some ?s, h' : root_of _ _ _ _ = Some ?q, h'' : off_by _ _ _ _ ?b |- _ => rename h into hs; rename h' into hq; rename h'' into hj; set (sq := s) in *; set (root_ := q) in *; set (b1 := b) in * end.
  destruct hj as [off [e [c [eb [[a [ha la]] [h1 [h2 h3]]]]]]]. cbn [fst snd] in *. destruct (square_off_sound values x cs lambda E dist d j sq off hd d0 hs h1) as [s1 s2].
  assert (Rt : lo root_ = hi root_ /\ (0 < lo root_)%Z).
  { unfold root_of in hq. cbv zeta in hq. cbn [fst snd] in hq. destruct (match value_at _ (repeat Low m) with Some _ => _ | None => _ end); [| discriminate].
    destruct (match value_at _ (repeat High m) with Some _ => _ | None => _ end); [| discriminate]. destruct (0 <? lo (lower_end (halve (add f f0))))%Z eqn:e0; [| discriminate]. injection hq as <-. split; [reflexivity | apply Z.ltb_lt, e0]. }
  assert (Rin : contains root_ (in_real (lo root_))) by (destruct root_ as [l0 h0]; cbn [lo hi] in *; destruct Rt as [-> _]; apply point_sound).
  destruct Rt as [_ r0]. pose proof (contains_positive bits _ _ r0 Rin) as t0. destruct (rates_found x _ c h2) as [rates [k1 k2]].
  exists (RealJoint (in_real (hi sq)) a (in_real (lo root_)) rates :: lr). cbn [combine map are_joints]. split.
  - split; [| exact I1]. unfold is_joint, joint_near. cbn [fst snd j_square j_error j_root j_halves r_square r_error r_root r_rates]. repeat (split; [assumption |]). split; [eapply Rle_trans; [apply Rabs_pos | exact la] |]. split; [exact r0 | exact k1].
  - rewrite map_rows_cons. cbn [own_columns map bounds_real combine]. constructor; [| exact I2]. intros q q0 q2. cbn [fst snd] in *. rewrite eb. unfold bound_real. cbn [r_square r_error r_root r_rates]. rewrite k2.
    exact (bound_holds _ _ d q _ off e c a _ w0 t0 q0 q2 (h3 q q0 q2) s2 d0 la).
Qed.


Lemma far_entries : forall near y x0 u far row, (forall i, encloses bits u y x0 theta (nth i near None) (plain_at i)) -> are_all near row = Some far ->
  exists us, Forall2 (fun s v => Forall2 contains (slopes s) v) far us /\
    forall w, dot (map (fun i => value y theta (plain_at i)) row) w - dot (map (fun i => value x0 theta (plain_at i)) row) w = dot w (image us u).
Proof.
  intros near y x0 u far row E h. apply all_some_related in h. induction h as [| i s row far hi h [us [IH1 IH2]]]; [exists []; split; [constructor | intros [| ? ?]; cbn; ring] |].
  pose proof (E i) as Ei. rewrite hi in Ei. destruct Ei as [_ [_ [_ [_ [v [v1 v2]]]]]]. exists (v :: us). split; [constructor; assumption |].
  intros [| t w]; cbn [map dot image]; [ring |]. specialize (IH2 w). unfold image in IH2. rewrite <- v2. lra.
Qed.

Theorem shows_pose_sound : forall thin, is_thinned thin tape -> forall keep cell x a l places Y kappa q, Forall2 contains cell x ->
  forallb (is_affine_at tape m) (n_weight a :: all_places (n_rows a)) = true -> is_affine_multiple tape m l = true -> 0 <= less_at tape theta (parabola x) l ->
  (n_ends a = O \/ is_eased tape m (n_ends a) (n_rows a) (n_weight a) l = true) ->
  shows_pose plain params cell (Check.evaluate_kept bits plain params keep cell) (tensors bits params thin cell) m a l places Y kappa q = true -> pose_found x a.
Proof.
  intros thin thin_is keep cell x a l places Y kappa q hx aff laff l0 he h w0. unfold shows_pose in h. cbv zeta in h. set (near := near_values plain params cell m a) in *.
  set (values := Check.evaluate_kept bits plain params keep cell) in *. set (ts := tensors bits params thin cell) in *. set (f := n_first a) in *.
  apply andb_true_iff in h as [h body]. apply andb_true_iff in h as [h rowlen]. apply andb_true_iff in h as [h lfar]. apply andb_true_iff in h as [h ljoints]. apply andb_true_iff in h as [h lrows].
  apply andb_true_iff in h as [h lY]. apply andb_true_iff in h as [h lcell]. apply andb_true_iff in h as [_ lf]. apply Nat.eqb_eq in lfar, ljoints, lrows, lY, lcell. apply Nat.leb_le in lf.
  destruct (Check.all_some (map (are_all near) (n_far a))) as [far |] eqn:efar; [| discriminate]. destruct (are_all near (n_reach a)) as [reach |] eqn:ereach; [| discriminate].
  destruct (Check.all_some (map (fun j => square_off values (n_distance a) (fst j)) (n_joints a))) as [offs |] eqn:eoffs; [| discriminate].
  destruct (Check.all_some (map (root_of ts m (n_weight a)) (n_rows a))) as [roots |] eqn:eroots; [| discriminate].
  apply andb_true_iff in body as [below body]. apply Z.ltb_lt in below. set (kf := Arithmetic.dyadic kappa places (Fixed.integer bits 1)) in *. set (gf := spread m f far) in *.
  destruct (recip bits kf) as [rf |] eqn:er; [| discriminate]. pose proof (unit_R_pos bits) as u0.
  assert (lx : length x = m) by (rewrite <- (related_length _ _ _ _ _ hx); exact lcell).
  (* on the cell *)
  destruct (coords_from_hold bits cell x hx) as [lambda [el [hlam [_ C]]]]. specialize (C []). cbn [app length] in C.
  assert (E : forall th, Forall2 contains params th -> forall i, encloses bits lambda x (map (centre_of bits) cell) th (nth i values None) (plain_at i)).
  { intros th hth i. apply (nth_related _ _ _ _ (encloses bits lambda x (map (centre_of bits) cell) th)); [exact I |].
    exact (evaluate_kept_sound bits lambda hlam x (map (centre_of bits) cell) th _ _ C (params_hold bits lambda params th hth) keep plain). }
  split.
  { intros th hth. apply all_some_related in eoffs. specialize (E th hth). clear - E eoffs. induction eoffs as [| j b js bs hj h IH]; constructor; [| exact IH].
    unfold square_off in hj. pose proof (E (fst (fst j))) as Ej. destruct (nth (fst (fst j)) values None) as [s |]; [exact (proj1 (proj2 Ej)) | discriminate]. }
  split; [exact lf |]. split; [exact lrows |]. split; [exact lfar |]. split; [exact ljoints |].
  split; [rewrite forallb_forall in rowlen; apply Forall_forall; intros row ir; apply Nat.eqb_eq, rowlen, ir |].
  intros d tau hd ht d0 t0 bs hbs.
  (* near it *)
  assert (N : forall u, inside f m u -> forall i, encloses bits u (near_point f x d tau u) (x ++ repeat 0 (m - f)) theta (nth i near None) (plain_at i)).
  { intros u hu i. apply (nth_related _ _ _ _ (encloses bits u (near_point f x d tau u) (x ++ repeat 0 (m - f)) theta)); [exact I |].
    apply (evaluate_kept_sound bits u (inside_ends f m u hu)); [exact (near_cell_holds bits f m cell x d tau (n_distance a) (n_turn a) u hd ht d0 t0 hx lcell lf hu) | apply params_hold, theta_in]. }
  set (g := in_real (hi gf)).
  assert (S : forall u, inside f m u -> exists us, Forall2 (Forall2 (fun s v => Forall2 contains (slopes s) v)) far us /\ forall w,
    Forall2 (fun ab r => dot (fst ab) w - dot (snd ab) w = dot w (image r u)) (combine (far_rows x a d tau u) (far_rows x a d tau (nought m))) us).
  { intros u hu. specialize (N u hu). unfold far_rows. fold f. rewrite (near_point_centre f m x d tau lx lf). apply all_some_related in efar. clear - N efar.
    induction efar as [| row s rows far hr h [us [I1 I2]]]; [exists []; split; [constructor | intro; constructor] |].
    destruct (far_entries near _ _ u s row N hr) as [v [v1 v2]]. exists (v :: us). split; [constructor; assumption |]. intro w. cbn [map combine]. constructor; [apply v2 | apply I2]. }
  assert (Spread : forall u, inside f m u -> forall w, size (less (image (far_rows x a d tau u) w) (image (far_rows x a d tau (nought m)) w)) <= g * (norm f w * norm f u)).
  { intros u hu w. destruct (S u hu) as [us [s1 s2]]. destruct (spread_sound bits m f far us s1) as [g' [g1 [g2 g3]]].
    apply Rle_trans with (1 := g3 _ _ w u (proj1 hu) (s2 w) ltac:(unfold far_rows; rewrite !map_length; reflexivity)). apply Rmult_le_compat_r; [apply Rmult_le_pos; apply norm_nonneg |].
    destruct g1 as [_ g1]. unfold g, in_real. apply Rmult_le_reg_r with unit; [exact u0 |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. fold gf in g1. lra. }
  assert (hz : inside f m (nought m)) by (split; [apply nought_length | pose proof (nought_norm f m); lra]).
  assert (g0 : 0 <= g /\ contains gf g).
  { destruct (S (nought m) hz) as [us [s1 _]]. destruct (spread_sound bits m f far us s1) as [g' [[g1 g1'] [g2 _]]]. fold gf in g1, g1'. unfold g, in_real. assert (G : IZR (hi gf) / unit * unit = IZR (hi gf)) by (field; lra).
    split; [apply Rmult_le_reg_r with unit; [exact u0 |]; nra | split; rewrite G; lra]. }
  destruct g0 as [g0 hg]. exists g. split; [exact g0 |]. split.
  { intros u hu. split; [| intros w _; apply Spread, hu]. unfold are_all in ereach. apply all_some_related in ereach. specialize (N u hu). clear - N ereach.
    induction ereach as [| i s l r hi h IH]; constructor; [| exact IH]. pose proof (N i) as Ni. rewrite hi in Ni. exact (proj1 (proj2 Ni)). }
  pose proof (Arithmetic.dyadic_sound bits kappa places _ 1 (Fixed.integer_sound bits 1)) as hk. fold kf in hk. set (k := IZR kappa / IZR (2 ^ Z.of_N places) * 1) in *.
  pose proof (contains_positive bits _ _ below (sub_sound bits _ _ _ _ hk hg)) as gk. destruct (recip_sound bits _ _ _ er hk) as [_ hr].
  pose proof (sub_sound bits _ _ _ _ (Fixed.integer_sound bits 1) (halve_sound bits _ _ (mul_sound bits _ _ _ _ hg hr))) as hzf. set (z := 1 - g * / k / 2) in *.
  assert (q1 : g * / k < 1) by (apply Rmult_lt_reg_r with k; [lra |]; rewrite Rmult_assoc, Rinv_l; lra).
  apply all_some_related in eoffs. apply all_some_related in eroots.
  destruct (joints_found values x (map (centre_of bits) cell) lambda E ts (n_weight a) (n_distance a) d hd d0 w0 (n_joints a) (n_rows a) offs roots bs ltac:(congruence) eoffs eroots hbs) as [lr [Joints Bounded]].
  assert (llr : length lr = m).
  { rewrite <- lrows. clear - Joints. revert Joints. generalize (map joint_near (combine (combine offs roots) (n_joints a))) (n_rows a) lr. induction l as [| j js IH]; intros [| p r] [| q l'] h; try contradiction; [reflexivity | cbn [length]; rewrite (IH r l' (proj2 h)); reflexivity]. }
  set (Bs := bounds_real tape theta (n_weight a) lr (parabola x) (n_rows a)) in *.
  exists k, z, (map IZR (weights_of m f (n_last a) q)), Bs.
  split; [lra |]. split; [unfold z; lra |]. split; [unfold z; apply Req_le; field; lra |].
  split; [unfold weights_of; rewrite !map_length, seq_length; reflexivity |].
  split. { intros i li. rewrite weights_entries by exact li. destruct (if n_last a then Nat.leb f i else Nat.ltb i f); [lra |]. apply IZR_lt, Z.pow_pos_nonneg; lia. }
  split. { intros i li hp. rewrite weights_entries by exact li. destruct (n_last a); [destruct (Nat.leb_spec f i) | destruct (Nat.ltb_spec i f)]; try reflexivity; lia. }
  cbv zeta. split; [exact Bounded |]. intros v lv.
  assert (Cut : forall R_, map snd (own_columns R_) = map snd R_ /\ map (scaled (map IZR (weights_of m f (n_last a) q))) (map fst (own_columns R_)) = map (scaled (map IZR (weights_of m f (n_last a) q))) (map fst R_)).
  { intro R_. unfold own_columns. rewrite !map_map. split; [reflexivity |]. apply map_ext. intro p. cbn [fst]. unfold scaled.
    assert (G : forall e l : list R, combine e (firstn (length e) l) = combine e l) by (induction e as [| t e IH]; intros [| y l']; cbn [length firstn combine]; try reflexivity; rewrite IH; reflexivity).
    assert (L : length (map IZR (weights_of m f (n_last a) q)) = m) by (unfold weights_of; rewrite !map_length, seq_length; reflexivity). revert L. generalize (map IZR (weights_of m f (n_last a) q)) as c. intros c L. rewrite <- L, G. reflexivity. }
  destruct (Cut (map_rows (fun i => here x i) (n_rows a))) as [-> ->]. pose proof (everywhere_shown bits params thin m cell lcell _ _ _ body) as SH.
  assert (KK : 0 <= k ^ 2) by apply pow2_ge_0.
  split.
  - destruct (Rle_lt_dec (dot v v) 0) as [zero_ | nz].
    + assert (Zv : dot (map snd (map_rows (fun i => here x i) (n_rows a))) (squares v) = 0).
      { apply dot_zero. unfold squares. rewrite Forall_map. apply zero_vector in zero_. revert zero_. apply Forall_impl. intros t <-. ring. }
      rewrite Zv, Rmult_0_r. apply dot_self.
    + exact (lower_here tape params theta theta_in thin thin_is m cell x hx lcell l (n_ends a) m places Y (n_rows a) (n_weight a) _ _ (k ^ 2) (z ^ 2) _ _ lr aff laff l0 he w0 SH (sqr_sound bits _ _ hk) (sqr_sound bits _ _ hzf) KK Joints lY lrows llr v lv nz).
  - intros s nz.
    exact (first_here tape params theta theta_in thin thin_is m cell x hx lcell l (n_ends a) m places Y (n_rows a) (n_weight a) _ _ (k ^ 2) (z ^ 2) _ _ lr aff laff l0 he w0 SH (sqr_sound bits _ _ hk) (sqr_sound bits _ _ hzf) Joints lY lrows llr v lv s nz).
Qed.
End Whole.

End Precision.
