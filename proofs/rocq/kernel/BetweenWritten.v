(** * Points between which a mechanism by formulas is singular

    Formulas are continuous where they are defined.  Wherever a determinant of
    them changes its sign, halving leads to a point at which it is zero, or some
    formula is not defined. *)

From Coq Require Import ZArith Reals Lra Lia List Bool String.
From Orthocert Require Import Claim.
From Orthocert.kernel Require Import Statement Linear Number Formula Witness Configuration Drives Driven Written AtPoint Singular.
From Orthocert.kernel Require Gradient Inputs.
Import ListNotations.
Local Open Scope list_scope.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** Of any function that changes its sign. *)
Lemma changes_sign : forall f : R -> R, f 0 * f 1 < 0 -> exists u, 0 <= u <= 1 /\ (continuity_pt f u -> f u = 0).
Proof.
  assert (K : forall f : R -> R, f 0 < 0 -> 0 < f 1 -> exists u, 0 <= u <= 1 /\ (continuity_pt f u -> f u = 0)).
  { intros f a b. set (P := fun z => if Rlt_dec 0 (f z) then true else false). assert (o : 0 <= 1) by lra.
    destruct (dicho_lb_cv 0 1 P o) as [l hl]. destruct (dicho_up_cv 0 1 P o) as [m hm]. pose proof (cv_dicho 0 1 l m P o hl hm) as e. subst m. exists l. split.
    - exact (conj (growing_ineq _ l (dicho_lb_growing 0 1 P o) hl 0%nat) (decreasing_ineq _ l (dicho_up_decreasing 0 1 P o) hm 0%nat)).
    - assert (T : forall z, P z = true -> 0 < f z) by (intro z; unfold P; destruct (Rlt_dec _ _); [auto | discriminate]). assert (F : forall z, P z = false -> ~ 0 < f z) by (intro z; unfold P; destruct (Rlt_dec _ _); [discriminate | auto]).
      assert (P0 : P 0 = false) by (unfold P; destruct (Rlt_dec _ _); [lra | reflexivity]). assert (P1 : P 1 = true) by (unfold P; destruct (Rlt_dec _ _); [reflexivity | lra]).
      intro c. pose proof (continuity_seq f _ l c hl) as L. pose proof (continuity_seq f _ l c hm) as U. apply Rle_antisym; apply Rnot_lt_le; intro n.
      + destruct (L (f l)) as [i hi]; [lra |]. specialize (hi i (Nat.le_refl i)). pose proof (F _ (dicho_lb_car 0 1 P i P0)).
        unfold R_dist in hi. apply Rabs_def2 in hi. lra.
      + destruct (U (- f l)) as [i hi]; [lra |]. specialize (hi i (Nat.le_refl i)). pose proof (T _ (dicho_up_car 0 1 P i P1)).
        unfold R_dist in hi. apply Rabs_def2 in hi. lra. }
  intros f h. assert (z : f 0 <> 0) by (intro e; rewrite e in h; lra). destruct (Rlt_dec (f 0) 0) as [n | n].
  - apply K; [exact n | nra].
  - destruct (K (fun u => - f u)) as [u [hu k]]; [lra | nra |]. exists u. split; [exact hu |]. intro c. specialize (k (continuity_pt_opp f u c)). lra.
Qed.

(** Formulas of coordinates that are continuous at a point. *)
Fixpoint formula_continuous (th : list R) (x : R -> list R) (u : R) (f : formula) {struct f} : (forall k, continuity_pt (fun t => nth k (x t) 0) u) ->
  has_no_elbow f = true -> Formula.defined (x u) th f -> continuity_pt (fun t => Formula.value (x t) th f) u.
Proof.
  intros c e d. pose proof (fun g => formula_continuous th x u g c) as IH. assert (S : forall a : R, continuity_pt (fun _ => a) u) by (intro a; apply continuity_pt_const; intros y z; reflexivity).
  destruct f as [o]. destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | s a b t]; cbn [has_no_elbow Formula.defined map_op all_op defined_op] in *; cbn [Formula.value map_op real_op];
    try (apply andb_true_iff in e as [e1 e2]; destruct d as [d [d1 d2]]; specialize (IH a e1 d1) as ha; specialize (IH b e2 d2) as hb).
  - apply c.
  - apply S.
  - apply S.
  - exact (continuity_pt_plus _ _ _ ha hb).
  - exact (continuity_pt_minus _ _ _ ha hb).
  - destruct d as [_ d]. exact (continuity_pt_opp _ _ (IH a e d)).
  - exact (continuity_pt_mult _ _ _ ha hb).
  - exact (continuity_pt_div _ _ _ ha hb d).
  - destruct d as [_ d]. cbn [pow]. pose proof (IH a e d) as h. exact (continuity_pt_mult _ _ _ h (continuity_pt_mult _ _ _ h (S 1))).
  - destruct d as [p d]. apply (continuity_pt_comp (fun t => Formula.value (x t) th a) sqrt); [exact (IH a e d) | apply continuity_pt_sqrt; lra].
  - discriminate.
Qed.
Lemma determinant_continuous : forall n rows u, Forall (Forall (fun f => continuity_pt f u)) rows -> continuity_pt (fun t => detR n (values_at t rows)) u.
Proof.
  intros n rows u h. set (D := laplace (R -> R) (fun _ => 0) (fun _ => 1) (fun f g u => f u - g u) (fun f g u => f u * g u) n rows).
  assert (E : forall t, D t = detR n (values_at t rows)).
  { intro t. apply (laplace_related (R -> R) R (fun f a => f t = a)); try reflexivity; try (intros ? ? ? ? -> ->; reflexivity).
    unfold values_at. clear. induction rows as [| r rows IH]; constructor; [| exact IH]. induction r; constructor; [reflexivity | assumption]. }
  assert (C : continuity_pt D u).
  { assert (S : forall a : R, continuity_pt (fun _ => a) u) by (intro a; apply continuity_pt_const; intros y z; reflexivity).
    apply (laplace_related (R -> R) unit (fun f _ => continuity_pt f u) _ _ _ _ tt tt (fun _ _ => tt) (fun _ _ => tt)) with (rows' := map (map (fun _ => tt)) rows);
      try apply S; try (intros f a g b hf hg; first [exact (continuity_pt_minus f g u hf hg) | exact (continuity_pt_mult f g u hf hg)]).
    clear - h. induction h as [| r rows h _ IH]; constructor; [| exact IH]. induction h; constructor; assumption. }
  intros eps p. destruct (C eps p) as [a [a0 k]]. exists a. split; [exact a0 |]. intros y hy. rewrite <- !E. exact (k y hy).
Qed.

Section Named.
Context {names : naming}.

Lemma divided_defined : forall c theta x th n env, agrees x th env (environment_at c theta x) -> (forall name, Formula.defined x th (lookup (integer 0) env name)) ->
  forall js i ls, holds_at th i (flat_map joint_literals js) -> Forall (joint_defined c theta x) js -> Forall2 (is_good x th 0 n false) (all_joints n env js i) ls -> Forall (fun l => seen_reach l) ls ->
  Forall (Forall (Formula.defined x th)) (map d_divided (all_joints n env js i)).
Proof.
  intros c theta x th n env ag nd. induction js as [| j js IH]; intros i ls h d g r; cbn [all_joints map flat_map] in *; [constructor |].
  apply holds_app in h as [h1 h2]. inversion d as [| ? ? d1 d2]; subst. inversion g as [| ? l ? ls' g1 g2]; subst. inversion r as [| ? ? r1 r2]; subst.
  constructor; [| exact (IH _ _ h2 d2 g2 r2)]. clear IH h2 d2 g2 r2 g r d. destruct j as [es | e]; cbn [joint_literals joint_defined] in *.
  - cbn [of_joint d_divided]. clear g1. revert i h1. induction d1 as [| e es d ds IH]; intros i h; [constructor |]. cbn [all_literals flat_map row_of] in *. apply holds_app in h as [h1 h2].
    constructor; [exact (proj1 (formula_defined x th env _ ag nd e i h1 d)) | exact (IH _ h2)].
  - destruct (formula_defined x th env _ ag nd e i h1 d1) as [D _]. destruct g1 as [_ [_ [_ [p _]]]]. specialize (p r1). cbn [of_joint] in *.
    destruct (gradient_defined (seq 0 n) th x (swapped (formula_of env e i)) (defined_swapped _ _ _ D)) as [N E]. apply defined_swapped in E.
    set (g := Gradient.gradient (seq 0 n) (swapped (formula_of env e i))) in *.
    assert (F : coordinate_gradient n (formula_of env e i) = (map swapped (fst g), swapped (snd g))) by reflexivity. rewrite F in *. cbn [d_divided d_D] in *.
    rewrite (without_roots_value x th _ E) in p. rewrite !Forall_map. revert N. apply Forall_impl. intros a da. destruct (same _ _); [split; exact I |].
    apply over_defined; [apply defined_swapped, da | exact E |]. intro z. rewrite z in p. cbn in p. lra.
Qed.
Lemma all_joints_length : forall n env js i, length (all_joints n env js i) = length js.
Proof. intros n env. induction js as [| j js IH]; intro i; [reflexivity |]. cbn [all_joints length]. rewrite IH. reflexivity. Qed.

Section Precision.
Variable bits : positive.

Definition refute_between_written (c : written_claim) (thetas xs ys : list number) : bool :=
  let m := by_formulas c in let n := coordinates m in let rows := map d_divided (joints_of m) in
  let at_ xs := map (map (number_of xs (with_literals m thetas))) rows in
  all_parts bits (map snd (parameters m)) thetas && all_parts bits (box_of c) xs && all_parts bits (box_of c) ys && Nat.eqb (length xs) n && Nat.eqb (length ys) n &&
  are_shaped m (joint_forms m) && Nat.eqb (length (joint_forms m)) n && forallb (forallb has_no_elbow) rows && opposite bits n (at_ xs) (at_ ys).

Theorem refute_between_written_sound : forall c thetas xs ys, refute_between_written c thetas xs ys = true ->
  exists theta x, is_about_written c theta x /\ ~ exists M, Forall2 (is_row (by_formulas c) theta x) (joint_forms (by_formulas c)) M /\
    Configuration.meets (length (coordinate_names (by_formulas c))) (machine_at (by_formulas c) theta x M) (written_demands c).
Proof.
  intros c thetas xs ys h. unfold refute_between_written in h. cbv zeta in h. set (m := by_formulas c) in *. set (n := coordinates m) in *. set (rows := map d_divided (joints_of m)) in *.
  apply andb_true_iff in h as [h opp]. apply andb_true_iff in h as [h elbow]. apply andb_true_iff in h as [h square]. apply andb_true_iff in h as [h shapes]. apply andb_true_iff in h as [h ly]. apply andb_true_iff in h as [h lx].
  apply andb_true_iff in h as [h hy]. apply andb_true_iff in h as [hp hx]. apply Nat.eqb_eq in lx, ly, square. apply all_parts_sound in hx, hy.
  set (theta := map Claim.value thetas). set (th := map Claim.value (with_literals m thetas)).
  set (x := fun u => map (fun p => fst p + u * (snd p - fst p)) (combine (map Claim.value xs) (map Claim.value ys))).
  assert (lX : forall u, length (x u) = n) by (intro u; unfold x; rewrite map_length, combine_length, !map_length, lx, ly; apply Nat.min_id).
  assert (Ends : x 0 = map Claim.value xs /\ x 1 = map Claim.value ys).
  { unfold x. assert (e : length xs = length ys) by congruence. clear - e. revert ys e. induction xs as [| a l IH]; intros [| b ys] e; try discriminate; [split; reflexivity |].
    destruct (IH ys ltac:(cbn in e; congruence)) as [E1 E2]. cbn [map combine fst snd]. split; f_equal; try ring; assumption. }
  assert (Num : forall zs, length zs = n -> map (map Claim.value) (map (map (number_of zs (with_literals m thetas))) rows) = map (map (Formula.value (map Claim.value zs) th)) rows).
  { intros zs _. rewrite map_map. apply map_ext_in. intros r ir. rewrite map_map. apply map_ext_in. intros g ig. apply number_of_value. rewrite forallb_forall in elbow. specialize (elbow r ir). rewrite forallb_forall in elbow. exact (elbow g ig). }
  apply opposite_sound in opp. rewrite !Num in opp by assumption. destruct Ends as [E0 E1]. rewrite <- E0, <- E1 in opp.
  destruct (changes_sign (fun u => detR n (map (map (Formula.value (x u) th)) rows)) opp) as [u [hu z]]. exists theta, (x u). split.
  { split; [exact (are_within bits m thetas hp) |]. unfold x. clear - hu hx hy. revert hy. generalize (map Claim.value ys). induction hx as [| t a ts l ha hs IH]; intros l' hy; inversion hy as [| ? b ? ? hb hy']; subst; cbn [combine map]; constructor; [| apply IH; assumption].
    unfold within in *. cbn [fst snd]. nra. }
  intros [M [is [re [inj _]]]]. destruct (where_reached bits m thetas (x u) hp shapes (lX u) re) as [ag [nd [hl [_ [M' [RM good]]]]]]. fold theta th n in ag, nd, hl, RM, good.
  pose proof (rows_unique m theta (x u) M M' (lX u) is RM) as EM. subst M'.
  assert (Def : Forall (Forall (Formula.defined (x u) th)) rows).
  { refine (divided_defined m theta (x u) th n _ ag nd _ _ _ hl _ good _); [exact (proj2 re) | rewrite Forall_map; apply Forall_forall; intros; exact I]. }
  assert (EM : M = map (map (Formula.value (x u) th)) rows).
  { unfold rows. assert (lM : length (joint_forms m) = length M) by exact (related_length _ _ _ _ _ is). clear - good lM. revert M lM good. generalize (joints_of m).
    induction (joint_forms m) as [| jo js IH]; intros qs [| row M] l h; try discriminate l; cbn [combine map] in h; inversion h as [| q ? ? ? g hs]; subst; [reflexivity |].
    cbn [map]. f_equal; [| apply IH; [cbn in l; congruence | exact hs]]. destruct g as [_ [_ [_ [_ [_ g]]]]]. destruct (g I) as [_ [g' _]]. rewrite g'.
    change (/ two_to (Inputs.rate false 0)) with (/ two_to 0). change (two_to 0) with 1. cbn [seen_row fst snd]. rewrite <- (map_id row) at 1. apply map_ext. intro. field. }
  assert (Flow : Forall (Forall (fun f => continuity_pt f u)) (map (map (fun g t => Formula.value (x t) th g)) rows)).
  { rewrite Forall_map. apply Forall_forall. intros r ir. rewrite Forall_map. apply Forall_forall. intros g ig. apply formula_continuous.
    - intro k. unfold x. clear. generalize (combine (map Claim.value xs) (map Claim.value ys)). intro l. revert k. induction l as [| p l IH]; intros [| k]; cbn [map nth]; try apply IH;
        try (apply continuity_pt_const; intros y z; reflexivity). exact (flow_line (fst p) (snd p) u).
    - rewrite forallb_forall in elbow. specialize (elbow r ir). rewrite forallb_forall in elbow. exact (elbow g ig).
    - rewrite Forall_forall in Def. specialize (Def r ir). rewrite Forall_forall in Def. exact (Def g ig). }
  apply determinant_continuous with (n := n) in Flow. assert (V : forall t, values_at t (map (map (fun g t => Formula.value (x t) th g)) rows) = map (map (Formula.value (x t) th)) rows).
  { intro t. unfold values_at. rewrite map_map. apply map_ext. intro r. rewrite map_map. reflexivity. }
  assert (D : detR n M = 0).
  { rewrite EM. apply z. intros eps p. destruct (Flow eps p) as [a [a0 k]]. exists a. split; [exact a0 |]. intros y hy'. specialize (k y hy'). rewrite !V in k. exact k. }
  destruct (det_zero n M) as [v [lv [nz hv]]]; [rewrite EM; unfold rows; rewrite !map_length; unfold joints_of; rewrite all_joints_length; exact square | exact D |].
  specialize (inj v lv nz). cbn [jacobian machine_at] in inj. apply Rlt_not_le in inj. apply inj. clear - hv. unfold Configuration.speed2. induction hv as [| r M e _ IH]; cbn [fold_right]; [lra |]. rewrite e. lra.
Qed.
End Precision.
End Named.
