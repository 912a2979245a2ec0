(** * Mechanisms by formulas at one point: refutations

    The formulas of Written.v at exact numbers are numbers again, and so are the
    rows of M by their gradients. That all is defined there is what a claim says. *)

From Coq Require Import ZArith Reals Lra Lia List Bool String.
From Orthocert Require Import Velocity Claim.
From Orthocert.kernel Require Import Linear Number Formula Problem Witness Configuration Drives Driven Written.
From Orthocert.kernel Require Solve Twofold Inputs.
Import ListNotations.
Local Open Scope list_scope.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Where what is written is defined, its formulas are *)

Section Defined.
Variables x theta : list R.
Local Notation defined := (Formula.defined x theta).

Lemma power_defined : forall a n, defined a -> defined (power a n).
Proof.
  intros a n h. assert (S : forall b, defined b -> defined (square b)).
  { intros b hb. unfold square. destruct (integer_of b) as [m |]; [destruct (is_small m) |]; try (split; exact I); split; try exact I; exact hb. }
  destruct n as [| [| n]]; [split; exact I | exact h |]. unfold power. cbv zeta.
  assert (E : forall m, defined (Nat.iter m (fun p => times p (square a)) (square a))) by (induction m as [| m IH]; cbn; [apply S, h | apply times_defined; [exact IH | apply S, h]]).
  destruct (Nat.even _); [apply E | apply times_defined; [apply E | exact h]].
Qed.

Section At.
Variables (env : environment formula) (renv : environment R).
Hypothesis agreed : agrees x theta env renv.
Hypothesis names_defined : forall name, defined (lookup (integer 0) env name).

Lemma formula_defined : forall e j, holds_at theta j (literals e) -> is_defined renv e -> defined (formula_of env e j) /\ Forall defined (partials env e j).
Proof.
  induction e as [c | n | a IH | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IH n | a IH]; intros j h d; cbn [formula_of partials is_defined literals] in *.
  - split; [| constructor]. unfold quantity. destruct (small _); split; exact I.
  - split; [apply names_defined | constructor].
  - destruct (IH j h d) as [h1 h2]. split; [apply opposite_defined, h1 | exact h2].
  - apply holds_app in h as [h1 h2]. destruct d as [d1 d2]. destruct (IHa j h1 d1), (IHb _ h2 d2). split; [apply plus_defined; assumption | apply Forall_app; split; assumption].
  - apply holds_app in h as [h1 h2]. destruct d as [d1 d2]. destruct (IHa j h1 d1), (IHb _ h2 d2). split; [apply minus_defined; assumption | apply Forall_app; split; assumption].
  - apply holds_app in h as [h1 h2]. destruct d as [d1 d2]. destruct (IHa j h1 d1), (IHb _ h2 d2). split; [apply times_defined; assumption | apply Forall_app; split; assumption].
  - apply holds_app in h as [h1 h2]. destruct d as [d1 [d2 d3]]. destruct (IHa j h1 d1), (IHb _ h2 d2).
    assert (D : defined (over (formula_of env a j) (formula_of env b (j + length (literals a))))) by (apply over_defined; try assumption; rewrite (formula_value x theta env renv agreed b _ h2); exact d3).
    split; [exact D |]. constructor; [exact D |]. apply Forall_app; split; assumption.
  - destruct (IH j h d) as [h1 h2]. split; [apply power_defined, h1 | exact h2].
  - destruct d as [d1 d2]. destruct (IH j h d1) as [h1 h2].
    assert (D : defined (root (formula_of env a j))) by (apply root_defined; [exact h1 | rewrite (formula_value x theta env renv agreed a _ h); exact d2]).
    split; [exact D | constructor; assumption].
Qed.

Lemma joints_defined : forall js i, holds_at theta i (flat_map joint_literals js) ->
  Forall (fun j => match j with ByRow es => Forall (is_defined renv) es | ByCoordinate e => is_defined renv e end) js -> Forall defined (joints_partials env js i).
Proof.
  induction js as [| j js IH]; intros i h d; [constructor |]. cbn [flat_map joints_partials] in *. apply holds_app in h as [h1 h2]. inversion d as [| ? ? d1 d2]; subst.
  apply Forall_app. split; [| exact (IH _ h2 d2)]. destruct j as [es | e]; cbn [joint_literals joint_partials] in *.
  - clear - h1 d1 agreed names_defined. revert i h1. induction d1 as [| e es d ds IH]; intros i h; [constructor |]. cbn [all_literals flat_map row_partials] in *. apply holds_app in h as [h1 h2].
    apply Forall_app. split; [apply formula_defined; assumption | exact (IH _ h2)].
  - destruct (formula_defined e i h1 d1). constructor; assumption.
Qed.
End At.

Lemma named_defined : forall ds env renv j, agrees x theta env renv -> (forall name, defined (lookup (integer 0) env name)) ->
  holds_at theta j (all_literals (map snd ds)) -> all_defined renv ds ->
  (forall name, defined (lookup (integer 0) (named env ds j) name)) /\ Forall defined (named_partials env ds j).
Proof.
  induction ds as [| [n e] ds IH]; intros env renv j ag nd h d; [split; [exact nd | constructor] |]. cbn [all_literals map snd flat_map named named_partials all_defined] in *.
  apply holds_app in h as [h1 h2]. destruct d as [d1 d2]. destruct (formula_defined env renv ag nd e j h1 d1) as [f1 f2].
  destruct (IH ((n, formula_of env e j) :: env) _ (j + length (literals e))%nat (agrees_cons _ _ _ _ n _ _ ag (formula_value x theta env renv ag e j h1))) as [r1 r2].
  - intro name. cbn [lookup]. destruct (String.eqb n name); [exact f1 | apply nd].
  - exact h2.
  - exact d2.
  - split; [exact r1 | apply Forall_app; split; assumption].
Qed.
End Defined.

(** ** A row by the rate of the joint's coordinate is one *)

Lemma row_unique : forall c theta x j r r', length x = length (coordinate_names c) -> is_row c theta x j r -> is_row c theta x j r' -> r = r'.
Proof.
  intros c theta x [es | e] r r' lx h h'; cbn [is_row] in *; [congruence |]. destruct h as [l h], h' as [l' h']. set (n := length (coordinate_names c)) in *.
  set (d := Twofold.less r r'). assert (ld : length d = n) by (apply Twofold.less_length; assumption).
  assert (E : Linear.dot r d = Linear.dot r' d).
  { set (path := fun t => comb 1 t x d). assert (lp : forall t, length (path t) = n) by (intro t; unfold path; rewrite Twofold.comb_length; congruence).
    assert (p0 : path 0 = x).
    { apply Twofold.same_entries; [rewrite lp; congruence |]. intro i. unfold path. rewrite Twofold.comb_entries. ring. }
    assert (D : forall k, derivable_pt_lim (fun t => nth k (path t) 0) 0 (nth k d 0)).
    { intro k. eapply derivable_eq with (f := fun t => nth k x 0 + nth k d 0 * t);
        [apply derivable_add; [apply derivable_const | apply derivable_scal, derivable_pt_lim_id] | intro t; unfold path; rewrite Twofold.comb_entries; ring | ring]. }
    exact (uniqueness_limite _ _ _ _ (h path d lp p0 D) (h' path d lp p0 D)). }
  assert (Z : Linear.dot d d = 0) by (unfold d at 2; rewrite Twofold.dot_less, !(Solve.dot_commutes d); lra).
  pose proof (Twofold.zeros_nought n d ld ltac:(lra)) as N. apply Twofold.same_entries; [congruence |]. intro i.
  pose proof (Twofold.less_entries r r' i) as L. fold d in L. rewrite N, Twofold.nought_entries in L. lra.
Qed.

(** ** In numbers *)

Section Numbers.
Variables xs thetas : list number.

Definition number_op (o : op number) : number :=
  match o with
  | Coord k => nth k xs (0 // 1) | Param j => nth j thetas (0 // 1) | Integer n => n // 1
  | Add a b => Plus a b | Sub a b => Minus a b | Neg a => Minus (0 // 1) a
  | Mul a b => Times a b | Div a b => Over a b | Sqr a => Times a a | Sqrt a => Root a
  | Elbow _ _ _ _ => 0 // 1                        (* which no formula of a user has *)
  end.
Fixpoint number_of (f : formula) : number := match f with F o => number_op (map_op number_of o) end.
Fixpoint has_no_elbow (f : formula) : bool :=
  match f with F o => match o with
    | Coord _ | Param _ | Integer _ => true
    | Add a b | Sub a b | Mul a b | Div a b => has_no_elbow a && has_no_elbow b
    | Neg a | Sqr a | Sqrt a => has_no_elbow a
    | Elbow _ _ _ _ => false
    end end.

Fixpoint number_of_value (f : formula) {struct f} : has_no_elbow f = true -> Claim.value (number_of f) = Formula.value (map Claim.value xs) (map Claim.value thetas) f.
Proof.
  intro h. destruct f as [o]. destruct o; cbn [has_no_elbow number_of map_op number_op Formula.value real_op] in *; try discriminate;
    try (apply andb_true_iff in h as [h1 h2]; cbn [Claim.value]; rewrite (number_of_value _ h1), (number_of_value _ h2); reflexivity).
  - rewrite <- zero_value, map_nth. reflexivity.
  - rewrite <- zero_value, map_nth. reflexivity.
  - cbn [Claim.value]. field.
  - cbn [Claim.value]. rewrite (number_of_value _ h). field.
  - cbn [Claim.value]. rewrite (number_of_value _ h). ring.
  - cbn [Claim.value]. rewrite (number_of_value _ h). reflexivity.
Qed.

(** Where a quotient or a root is defined, this is positive. *)
Definition reserve_of (f : formula) : list number :=
  match f with F (Sqrt a) => [number_of a] | F (Div _ b) => let d := number_of b in [Times d d] | _ => [] end.

Definition joint_number (j : ejoint) : ncoordinate := match j with ELength f => NLength (number_of f) | _ => NUnknown end.
Definition exact_joints (fs : list pose_formulas) (partial : list formula) : nconfiguration :=
  NConfiguration (map (fun q => map number_of (d_divided q)) fs) (map (fun q => joint_number (d_joint q)) fs) (map (fun _ => None) fs) [] (fun b => b)
    (flat_map reserve_of partial) (map (fun q => Some (map number_of (d_A q))) fs).
End Numbers.

Section Precision.
Variable bits : positive.

Fixpoint all_parts (ts : list tolerance) (ys : list number) : bool :=
  match ts, ys with [], [] => true | t :: ts', y :: ys' => part bits t y && all_parts ts' ys' | _, _ => false end.
Lemma all_parts_sound : forall ts ys, all_parts ts ys = true -> Forall2 within ts (map Claim.value ys).
Proof.
  induction ts as [| t ts IH]; intros [| y ys] h; cbn [all_parts map] in *; try discriminate; constructor; apply andb_true_iff in h as [h1 h2];
    [exact (part_sound bits _ _ h1) | exact (IH _ h2)].
Qed.

Definition own_formulas (q : pose_formulas) : list formula := d_A q ++ d_divided q ++ match d_joint q with ELength f => [f] | _ => [] end.

(** Of a mechanism: where its numbers are among parameters, what its names stand for, joints, quotients and roots, and all parameters. *)
Section Mechanism.
Variable m : mechanism.
Definition coordinates : nat := length (coordinate_names m).
Definition first_of_joints : nat := length (parameters m) + length (all_literals (map snd (definitions m))).
Definition names_of : environment formula := named (given_formulas m) (definitions m) (length (parameters m)).
Definition joints_of : list pose_formulas := all_joints coordinates names_of (joint_forms m) first_of_joints.
Definition partials_of : list formula := named_partials (given_formulas m) (definitions m) (length (parameters m)) ++ joints_partials names_of (joint_forms m) first_of_joints.
Definition with_literals (thetas : list number) : list number :=
  thetas ++ map (fun p => least (fst p)) (all_literals (map snd (definitions m)) ++ flat_map joint_literals (joint_forms m)).
Definition are_shaped (js : list written_joint) : bool := forallb (fun j => match j with ByRow es => Nat.eqb (length es) coordinates | ByCoordinate _ => true end) js.

Lemma are_within : forall thetas, all_parts (map snd (parameters m)) thetas = true -> Forall2 (fun p y => within (snd p) y) (parameters m) (map Claim.value thetas).
Proof.
  intros thetas h. apply all_parts_sound in h. revert h. generalize (map Claim.value thetas). induction (parameters m) as [| p l IH]; intros th h; inversion h; subst; constructor; auto.
Qed.

(** At a point at which everything is defined, formulas are those of the machine. *)
Lemma where_reached : forall thetas y, let theta := map Claim.value thetas in let th := map Claim.value (with_literals thetas) in
  all_parts (map snd (parameters m)) thetas = true -> are_shaped (joint_forms m) = true -> length y = coordinates -> is_reached m theta y ->
  agrees y th names_of (environment_at m theta y) /\ (forall name, Formula.defined y th (lookup (integer 0) names_of name)) /\
  holds_at th first_of_joints (flat_map joint_literals (joint_forms m)) /\ Forall (Formula.defined y th) partials_of /\
  exists M, Forall2 (is_row m theta y) (joint_forms m) M /\
    Forall2 (is_good y th 0 coordinates false) joints_of (map (fun p => Seen (snd p) (coordinate_at m theta y (fst p)) None True) (combine (joint_forms m) M)).
Proof.
  intros thetas x theta th hp shapes lX [re1 re2]. pose proof (are_within thetas hp) as P. fold theta in P.
  set (lits := all_literals (map snd (definitions m)) ++ flat_map joint_literals (joint_forms m)).
  assert (Eth : th = theta ++ map (fun p => Claim.value (least (fst p))) lits) by (unfold th, with_literals; rewrite map_app, map_map; reflexivity).
  assert (Exact : forall es, Forall2 scaled_within (all_literals es) (map (fun p => Claim.value (least (fst p))) (all_literals es))).
  { induction es as [| e es IH]; [constructor |]. cbn [all_literals flat_map]. rewrite map_app. apply Forall2_app; [apply literals_exact | exact IH]. }
  assert (lt : length theta = length (parameters m)) by (symmetry; exact (related_length _ _ _ _ _ P)).
  assert (Joint : Forall2 scaled_within (flat_map joint_literals (joint_forms m)) (map (fun p => Claim.value (least (fst p))) (flat_map joint_literals (joint_forms m)))).
  { clear - Exact. induction (joint_forms m) as [| q l IH]; [constructor |]. cbn [flat_map]. rewrite map_app. apply Forall2_app; [| exact IH]. destruct q as [es | e]; cbn [joint_literals]; [apply Exact | apply literals_exact]. }
  assert (H1 : holds_at th (length (parameters m)) (all_literals (map snd (definitions m)))).
  { rewrite Eth. unfold lits. rewrite map_app, <- lt. apply holds_at_of, Exact. }
  assert (H2 : holds_at th first_of_joints (flat_map joint_literals (joint_forms m))).
  { rewrite Eth. unfold lits. rewrite map_app, app_assoc. pose proof (holds_at_of (theta ++ map (fun p => Claim.value (least (fst p))) (all_literals (map snd (definitions m)))) _ _ [] Joint) as K.
    rewrite app_nil_r, app_length, map_length, lt in K. exact K. }
  assert (Given : forall y, length y = coordinates -> agrees y th (given_formulas m) (given m y theta) /\ forall name, Formula.defined y th (lookup (integer 0) (given_formulas m) name)).
  { intros y ly. split.
    - apply agrees_combine.
      + rewrite map_map. fold coordinates. rewrite <- ly. clear. change (map (fun k => nth k y 0) (seq 0 (length y)) = y).
        apply nth_ext with 0 0; rewrite map_length, seq_length; [reflexivity |]. intros k hk.
        rewrite (nth_indep _ 0 (nth 0 y 0)) by (rewrite map_length, seq_length; exact hk). rewrite (map_nth (fun k => nth k y 0)), seq_nth by exact hk. reflexivity.
      + rewrite <- (app_nil_r (combine _ (numbered _ _))), <- (app_nil_r (combine _ theta)). apply agrees_combine; [| intro; reflexivity].
        rewrite Eth. assert (Q : Forall2 scaled_within (exact_parameters (parameters m)) theta).
        { unfold exact_parameters. clear - P. induction P; cbn [map]; constructor; auto. apply within_scaled; assumption. }
        exact (numbered_values _ _ y [] _ Q).
    - intro name. unfold given_formulas, given.
      assert (L : forall ns fs e0, Forall (Formula.defined y th) fs -> (forall name, Formula.defined y th (lookup (integer 0) e0 name)) -> forall name, Formula.defined y th (lookup (integer 0) (combine ns fs ++ e0) name)).
      { induction ns as [| a ns IH]; intros fs0 e0 h0 k nm; [apply k |]. destruct h0 as [| g fs0 g0 gs]; [apply k |]. cbn [combine app lookup]. destruct (String.eqb a nm); [exact g0 | apply IH; assumption]. }
      apply L; [apply Forall_forall; intros g ig; apply in_map_iff in ig as [k [<- _]]; split; exact I |]. intro nm.
      rewrite <- (app_nil_r (combine _ _)). apply L; [| intro; split; exact I]. generalize 0%nat (exact_parameters (parameters m)). intros a l. revert a.
      induction l as [| p l IH]; intro a; [constructor |]. cbn [numbered]. constructor; [unfold quantity; destruct (small p); split; exact I | apply IH]. }
  assert (Agree : forall y, length y = coordinates -> agrees y th names_of (environment_at m theta y)) by (intros y ly; apply named_agrees; [apply Given, ly | exact H1]).
  destruct (Given x lX) as [G1 G2]. destruct (named_defined x th (definitions m) _ _ (length (parameters m)) G1 G2 H1 re1) as [N1 N2].
  pose proof (joints_defined x th names_of _ (Agree x lX) N1 (joint_forms m) first_of_joints H2 re2) as N3.
  assert (SH : Forall (fun j => match j with ByRow es => length es = coordinates | ByCoordinate _ => True end) (joint_forms m)).
  { unfold are_shaped in shapes. rewrite forallb_forall in shapes. apply Forall_forall. intros q k. specialize (shapes q k). destruct q; [apply Nat.eqb_eq, shapes | exact I]. }
  split; [exact (Agree x lX) |]. split; [exact N1 |]. split; [exact H2 |]. split; [apply Forall_app; split; assumption |].
  exact (proj2 (joints_good m theta th x names_of Agree lX (joint_forms m) first_of_joints H2 SH N3)).
Qed.
Lemma rows_unique : forall theta x M M', length x = coordinates -> Forall2 (is_row m theta x) (joint_forms m) M -> Forall2 (is_row m theta x) (joint_forms m) M' -> M = M'.
Proof.
  intros theta x M M' lX rows. revert M'. induction rows as [| q r l M h hs IH]; intros M' RM; inversion RM; subst; [reflexivity |]. f_equal; [eapply row_unique; eassumption | auto].
Qed.
End Mechanism.

Definition refute_written (c : written_claim) (thetas xs : list number) (f : nfailure) : bool :=
  let m := by_formulas c in let n := coordinates m in let fs := joints_of m in let partial := partials_of m in let all := with_literals m thetas in
  all_parts (map snd (parameters m)) thetas && all_parts (box_of c) xs && Nat.eqb (length xs) n && are_shaped m (joint_forms m) &&
  forallb has_no_elbow (flat_map own_formulas fs ++ partial) &&
  refutes bits 1 n (exact_joints xs all fs partial) (written_demands c) f.

(** A machine of the claim does not meet it at some point of the box. *)
Theorem refute_written_sound : forall c thetas xs f, refute_written c thetas xs f = true ->
  exists theta x, is_about_written c theta x /\ ~ exists M, Forall2 (is_row (by_formulas c) theta x) (joint_forms (by_formulas c)) M /\
    Configuration.meets (length (coordinate_names (by_formulas c))) (machine_at (by_formulas c) theta x M) (written_demands c).
Proof.
  intros c thetas xs f h. unfold refute_written in h. cbv zeta in h. set (m := by_formulas c) in *. set (n := coordinates m) in *.
  set (fs := joints_of m) in *. set (partial := partials_of m) in *. set (all := with_literals m thetas) in *.
  apply andb_true_iff in h as [h r]. apply andb_true_iff in h as [h elbow]. apply andb_true_iff in h as [h shapes]. apply andb_true_iff in h as [h lx].
  apply andb_true_iff in h as [hp hb]. apply Nat.eqb_eq in lx. pose proof hp as hp'. pose proof (are_within m thetas hp) as P. apply all_parts_sound in hb. rewrite forallb_forall in elbow.
  set (theta := map Claim.value thetas) in *. set (x := map Claim.value xs) in *. exists theta, x.
  split; [split; assumption |]. intros [M [rows [re [inj met]]]].
  set (th := map Claim.value all). assert (lX : length x = n) by (unfold x; rewrite map_length; exact lx).
  destruct (where_reached m thetas x hp' shapes lX re) as [_ [_ [_ [N [M' [RM good]]]]]]. fold theta all th n fs in RM, good. destruct re as [re1 re2].
  pose proof (rows_unique m theta x M M' lX rows RM) as EM. subst M'.
  assert (Num : forall g, In g (flat_map own_formulas fs ++ partial) -> Claim.value (number_of xs all g) = Formula.value x th g) by (intros g ig; apply number_of_value, elbow, ig).
  enough (S : stands_for (exact_joints xs all fs partial) (machine_at m theta x M)) by exact (refutes_sound bits _ _ _ _ _ _ S r (conj (conj re1 re2) (conj inj met))).
  assert (Own : Forall2 (fun q p => Forall (fun g => Claim.value (number_of xs all g) = Formula.value x th g) (own_formulas q) /\ is_good x th 0 n false q (Seen (snd p) (coordinate_at m theta x (fst p)) None True)) fs (combine (joint_forms m) M)).
  { assert (Num' : forall g, In g (flat_map own_formulas fs) -> Claim.value (number_of xs all g) = Formula.value x th g) by (intros g ig; apply Num, in_or_app; left; exact ig).
    enough (K : forall l ps, Forall2 (is_good x th 0 n false) l (map (fun p => Seen (snd p) (coordinate_at m theta x (fst p)) None True) ps) ->
      (forall g, In g (flat_map own_formulas l) -> Claim.value (number_of xs all g) = Formula.value x th g) ->
      Forall2 (fun q p => Forall (fun g => Claim.value (number_of xs all g) = Formula.value x th g) (own_formulas q) /\ is_good x th 0 n false q (Seen (snd p) (coordinate_at m theta x (fst p)) None True)) l ps) by exact (K _ _ good Num').
    clear. intro l. induction l as [| q l IH]; intros [| p ps] g N; inversion g; subst; constructor.
    - split; [apply Forall_forall; intros e ie; apply N; cbn [flat_map]; apply in_or_app; left; exact ie | assumption].
    - apply IH; [assumption | intros e ie; apply N; cbn [flat_map]; apply in_or_app; right; exact ie]. }
  assert (one : / two_to 0 = 1) by (change (two_to 0) with 1; field).
  assert (lM : length (joint_forms m) = length M) by exact (related_length _ _ _ _ _ rows).
  assert (E1 : M = map snd (combine (joint_forms m) M) /\ joint_forms m = map fst (combine (joint_forms m) M)).
  { clear - lM. revert M lM. induction (joint_forms m) as [| a l IH]; intros [| r M] e; try discriminate; [split; reflexivity |]. destruct (IH M ltac:(cbn in e; congruence)) as [I1 I2].
    cbn [combine map fst snd]. rewrite <- I1, <- I2. split; reflexivity. }
  destruct E1 as [E1 E2]. split; [| split; [| split; [| split; [| split]]]]; cbn [jacobian joints rods limbs placed reached machine_at njacobian njoints nrods nlimbs nplaced reserves nrays exact_joints]; try reflexivity.
  - rewrite E1 at 1. clear - Own one. induction Own as [| q p l ps [h g] hs IH]; [reflexivity |]. cbn [map]. rewrite IH. f_equal.
    destruct g as [_ [_ [_ [_ [_ g]]]]]. destruct (g I) as [_ [g' _]]. cbn [Inputs.rate seen_row] in g'. rewrite one in g'. rewrite map_map.
    replace (snd p) with (map (Rmult 1) (snd p)) by (rewrite <- (map_id (snd p)) at 2; apply map_ext; intro; ring). rewrite <- g'.
    apply map_ext_in. intros e ie. symmetry. rewrite Forall_forall in h. apply h. unfold own_formulas. apply in_or_app. right. apply in_or_app. left. exact ie.
  - unfold joint_values. rewrite E2 at 1. rewrite map_map. clear - Own one. induction Own as [| q p l ps [h g] hs IH]; [reflexivity |]. cbn [map]. rewrite IH. f_equal.
    destruct g as [_ [_ [_ [_ [_ g]]]]]. destruct (g I) as [_ [_ [g' _]]]. cbn [seen_joint] in g'. unfold own_formulas in h. unfold coordinate_at in g'.
    destruct (fst p) as [es | e], (d_joint q) as [a | |]; cbn [joint_is joint_number coordinate_of] in *; try contradiction; [reflexivity |].
    rewrite one in g'. f_equal. rewrite Forall_forall in h. rewrite (h a) by (apply in_or_app; right; apply in_or_app; right; left; reflexivity). lra.
  - assert (L : length (joint_forms m) = length fs) by (rewrite (related_length _ _ _ _ _ Own), combine_length, <- lM; lia).
    assert (K : forall (A B C D : Type) (l : list A) (r : list B) (f : C -> D), length l = length r -> map (fun _ => @None D) l = map (option_map f) (map (fun _ => None) r)).
    { clear. intros A B C D. induction l as [| a l IH]; intros [| q r] f e; try discriminate; [reflexivity |]. cbn [map option_map]. f_equal. apply IH. cbn in e. congruence. }
    apply K, L.
  - intros _. split.
    + apply Forall_forall. intros y iy. apply in_flat_map in iy as [g [ig iy]]. assert (D : Formula.defined x th g).
      { rewrite Forall_forall in N. exact (N _ ig). }
      pose proof (elbow g (in_or_app _ _ _ (or_intror ig))) as el. destruct g as [o]. destruct o; cbn [reserve_of] in iy; try contradiction; destruct iy as [<- | []]; cbn [has_no_elbow] in el.
      * apply andb_true_iff in el as [_ el]. destruct D as [D _]. cbn [map_op defined_op] in D. cbn [Claim.value]. rewrite (number_of_value _ _ _ el). fold x th.
        assert (0 < Formula.value x th b ^ 2) by (rewrite <- Rsqr_pow2; apply Rlt_0_sqr; exact D). lra.
      * destruct D as [D _]. cbn [map_op defined_op] in D. rewrite (number_of_value _ _ _ el). exact D.
    + rewrite E1. clear - Own one. induction Own as [| q p l ps [h g] hs IH]; [constructor |]. cbn [map]. constructor; [| exact IH]. cbn [is_ray].
      destruct g as [_ [_ [_ [d0 [_ g]]]]]. specialize (d0 I). destruct (g I) as [[e [e2 ea]] _]. cbn [Inputs.rate seen_row] in ea. rewrite one in ea.
      assert (e0 : e <> 0) by (intro z; rewrite z in e2; lra). exists (/ e). split; [apply Rinv_neq_0_compat, e0 |]. rewrite map_map.
      transitivity (map (Rmult (/ e)) (map (Formula.value x th) (d_A q))).
      * rewrite ea, map_map. rewrite <- (map_id (snd p)) at 1. apply map_ext. intro y. field. exact e0.
      * rewrite map_map. apply map_ext_in. intros a ia. f_equal. symmetry. rewrite Forall_forall in h. apply h. unfold own_formulas. apply in_or_app. left. exact ia.
Qed.
End Precision.
End Named.
