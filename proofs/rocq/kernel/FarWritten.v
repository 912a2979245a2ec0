(** * Refutations of accuracy of mechanisms by formulas

    As in Far.v, where the joint coordinates themselves, as they are written,
    are what is summed. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool String.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Statement Number Witness Configuration Same Twins Far Written AtPoint.
From Orthocert.kernel Require Linear Twofold.
Import ListNotations.
Local Open Scope list_scope.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** What is written, in numbers *)

Fixpoint power_of (x : number) (n : positive) : number :=
  match n with xH => x | xO n => let y := power_of x n in Times y y | xI n => let y := power_of x n in Times (Times y y) x end.
Fixpoint number_at (env : environment number) (e : written) : number :=
  match e with
  | Constant c => c
  | Named name => lookup (0 // 1) env name
  | Opposite a => Minus (0 // 1) (number_at env a)
  | Sum a b => Plus (number_at env a) (number_at env b)
  | Difference a b => Minus (number_at env a) (number_at env b)
  | Product a b => Times (number_at env a) (number_at env b)
  | Quotient a b => Over (number_at env a) (number_at env b)
  | Raised a n => power_of (number_at env a) n
  | RootOf a => Root (number_at env a)
  end.
Fixpoint all_numbers (env : environment number) (ds : list (string * written)) : environment number :=
  match ds with [] => env | (n, e) :: ds' => all_numbers ((n, number_at env e) :: env) ds' end.
Definition numbers_at (c : mechanism) (thetas xs : list number) : environment number := all_numbers (given c xs thetas) (definitions c).
Fixpoint is_constant (e : written) : bool :=
  match e with
  | Constant c => negb (varies c)
  | Named _ => true
  | Opposite a | Raised a _ | RootOf a => is_constant a
  | Sum a b | Difference a b | Product a b | Quotient a b => is_constant a && is_constant b
  end.

Section Named.
Context {names : naming}.

Definition stand_for (other : naming) (env : environment number) (renv : environment R) : Prop := forall name, @Claim.value other (lookup (0 // 1) env name) = lookup 0 renv name.
Lemma number_at_is : forall other env renv e, stand_for other env renv -> is_constant e = true -> @Claim.value other (number_at env e) = @meaning names renv e.
Proof.
  intros other env renv e agree.
  induction e as [c | n | a IH | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IH n | a IH]; intro h; cbn [number_at meaning is_constant Claim.value] in *;
    try (apply andb_true_iff in h as [h1 h2]; rewrite IHa, IHb by assumption; reflexivity).
  - apply steady_value. destruct (varies c); [discriminate | reflexivity].
  - apply agree.
  - rewrite IH by exact h. lra.
  - rewrite <- (IH h). generalize (number_at env a). clear. intro x. induction n as [n IH | n IH |]; cbn [power_of Claim.value].
    + rewrite IH, Pos2Nat.inj_xI. cbn [pow]. replace (2 * Pos.to_nat n)%nat with (Pos.to_nat n + Pos.to_nat n)%nat by lia. rewrite pow_add. ring.
    + rewrite IH, Pos2Nat.inj_xO. replace (2 * Pos.to_nat n)%nat with (Pos.to_nat n + Pos.to_nat n)%nat by lia. rewrite pow_add. ring.
    + change (Pos.to_nat 1) with 1%nat. ring.
  - rewrite IH by exact h. reflexivity.
Qed.
Lemma all_numbers_are : forall other ds env renv, stand_for other env renv -> forallb (fun d => is_constant (snd d)) ds = true -> stand_for other (all_numbers env ds) (@extended names renv ds).
Proof.
  intros other. induction ds as [| [n e] ds IH]; intros env renv agree h; [exact agree |]. cbn [forallb snd all_numbers extended] in *. apply andb_true_iff in h as [h1 h2]. apply IH; [| exact h2].
  intro name. cbn [lookup]. destruct (String.eqb n name); [exact (number_at_is other env renv e agree h1) | apply agree].
Qed.
Lemma given_are : forall other c xs thetas, stand_for other (given c xs thetas) (given c (map (@Claim.value other) xs) (map (@Claim.value other) thetas)).
Proof.
  intros other c xs thetas. assert (Z : @Claim.value other (0 // 1) = 0) by (cbn; lra).
  assert (L : forall ns l e r, stand_for other e r -> stand_for other (combine ns l ++ e) (combine ns (map (@Claim.value other) l) ++ r)).
  { induction ns as [| n ns IH]; intros [| a l] e r h; try exact h. intro name. cbn [map combine app lookup]. destruct (String.eqb n name); [reflexivity | exact (IH l e r h name)]. }
  unfold given. apply L. rewrite <- (app_nil_r (combine _ thetas)), <- (app_nil_r (combine _ (map _ thetas))). apply L. intro name. exact Z.
Qed.

Lemma same_lengths : forall l r, map Length l = map Length r -> l = r.
Proof. induction l as [| a l IH]; intros [| b r] h; try discriminate; [reflexivity |]. injection h as -> h. f_equal. exact (IH r h). Qed.

(** ** A machine that is nowhere near enough *)

Section Precision.
Variable bits : positive.

Fixpoint all_coordinates (js : list written_joint) : option (list written) :=
  match js with [] => Some [] | ByCoordinate e :: js' => option_map (cons e) (all_coordinates js') | ByRow _ :: _ => None end.
Lemma all_coordinates_sound : forall js es, all_coordinates js = Some es -> js = map ByCoordinate es.
Proof.
  induction js as [| [r | e] js IH]; intros es h; cbn [all_coordinates] in h; try discriminate; [injection h as <-; reflexivity |].
  destruct (all_coordinates js) as [l |]; [| discriminate]. injection h as <-. cbn [map]. rewrite (IH l eq_refl). reflexivity.
Qed.

Definition refute_far_written (c : written_claim) (thetas xs : list number) (test : nat) (v : list Z) : bool :=
  let m := by_formulas c in let n := length (coordinate_names m) in
  all_parts bits (map snd (parameters m)) thetas && all_parts bits (box_of c) xs && Nat.eqb (length xs) n && is_named (thetas ++ xs) && forallb (fun d => is_constant (snd d)) (definitions m) &&
  match test_at bits 1 test (written_demands c), all_coordinates (joint_forms m) with
  | Some (OnePose e b _, _), Some es => match above (enclose few_bits b) with
      | Some d => certainly bits true b && certainly bits false e && Nat.eqb (length v) (length es) && forallb is_constant es &&
          let rhos := asked_for v (map (number_at (numbers_at m (map (fun p => nmiddle (snd p)) (parameters m)) xs)) es) e in is_named rhos &&
          let moved := map (fun p => Plus (fst p) (off (snd p) d)) (combine xs (seq 0 n)) in
          stays_below bits n n (sum_of (fun q => Times (snd q // 1) (Minus (fst (fst q)) (snd (fst q)))) (combine (combine (map (number_at (numbers_at m thetas moved)) es) rhos) v))
      | None => false
      end
  | _, _ => false
  end.

Theorem refute_far_written_sound : forall c thetas xs test v, refute_far_written c thetas xs test v = true ->
  exists theta x, is_about_written c theta x /\ ~ exists M, Forall2 (is_row (by_formulas c) theta x) (joint_forms (by_formulas c)) M /\
    Configuration.meets (length (coordinate_names (by_formulas c))) (machine_at (by_formulas c) theta x M) (written_demands c).
Proof.
  intros c thetas xs test v h. unfold refute_far_written in h. cbv zeta in h. set (m := by_formulas c) in *. set (n := length (coordinate_names m)) in *.
  apply andb_true_iff in h as [h rest]. apply andb_true_iff in h as [h fixed_]. apply andb_true_iff in h as [h steady]. apply andb_true_iff in h as [h lx]. apply andb_true_iff in h as [hp hb].
  apply Nat.eqb_eq in lx. apply all_parts_sound in hp, hb. unfold is_named in steady. rewrite forallb_app in steady. apply andb_true_iff in steady as [st sx].
  set (theta := map Claim.value thetas) in *. set (x := map Claim.value xs) in *. exists theta, x.
  assert (P : Forall2 (fun p y => within (snd p) y) (parameters m) theta).
  { clear - hp. revert hp. generalize theta. induction (parameters m) as [| p l IH]; intros th hp; inversion hp; subst; constructor; auto. }
  split; [split; assumption |]. intros [M [_ [_ [_ met]]]].
  destruct (test_at _ _ _ _) as [[q which] |] eqn:e; [| discriminate]. destruct q; try discriminate. apply test_at_in in e. rewrite Forall_forall in met. specialize (met _ e).
  destruct (all_coordinates (joint_forms m)) as [es |] eqn:ec; [| discriminate]. apply all_coordinates_sound in ec.
  destruct (above (enclose few_bits b)) as [d |] eqn:ed; [| discriminate]. apply andb_true_iff in rest as [rest far]. apply andb_true_iff in far as [sr far]. apply andb_true_iff in rest as [rest ce]. apply andb_true_iff in rest as [rest l2].
  apply andb_true_iff in rest as [b0 e0]. apply Nat.eqb_eq in l2. apply (positive_sound bits) in b0. apply (nonneg_sound bits) in e0.
  pose proof (above_sound _ (Claim.value b) d ed ltac:(intros z hz; apply enclose_sound, hz)) as bd. assert (d0 : 0 < Q2R d) by lra.
  assert (Stand : forall other ths ys, stand_for other (numbers_at m ths ys) (@environment_at names m (map (@Claim.value other) ths) (map (@Claim.value other) ys)))
    by (intros; apply all_numbers_are; [apply given_are | exact fixed_]).
  rewrite forallb_forall in ce. assert (Each : forall other ths ys, map (@Claim.value other) (map (number_at (numbers_at m ths ys)) es) = map (@meaning names (@environment_at names m (map (@Claim.value other) ths) (map (@Claim.value other) ys))) es).
  { intros. rewrite map_map. apply map_ext_in. intros z iz. apply number_at_is; [apply Stand | exact (ce z iz)]. }
  set (mid := map (fun p => nmiddle (snd p)) (parameters m)) in *. set (nominal := map (number_at (numbers_at m mid xs)) es) in *. set (rhos := asked_for v nominal error) in *.
  assert (EM : map Claim.value mid = map (fun p => middle (snd p)) (parameters m)) by (unfold mid; rewrite map_map; apply map_ext; intro; apply middle_is).
  assert (JV : forall th y, joint_values m th y = map (fun e => Length (meaning (environment_at m th y) e)) es) by (intros; unfold joint_values; rewrite ec, map_map; reflexivity).
  cbn [fulfils machine_at recovers] in met. unfold forms_recover in met. cbv zeta in met. fold m in met.
  destruct (met (map (fun r => Length (Claim.value r)) rhos)) as [y [[ly [near [_ is_at]]] _]].
  { rewrite JV. fold m. rewrite <- EM. pose proof (asked_near v nominal error e0 ltac:(unfold nominal; rewrite map_length; exact l2)) as A. fold rhos in A. unfold nominal in A. rewrite (Each names mid xs) in A.
    rewrite <- (map_map Claim.value Length rhos). fold x in A. clear - A. revert A. generalize (map Claim.value rhos). induction es as [| a es IH]; intros r A; inversion A; subst; cbn [map]; constructor; [assumption | apply IH; assumption]. }
  assert (lX : length x = n) by (unfold x; rewrite map_length; exact lx). set (w := Twofold.less y x) in *. assert (lw : length w = n) by (apply Twofold.less_length; congruence).
  set (u := map (Rmult (/ Q2R d)) w). assert (lu : length u = n) by (unfold u; rewrite map_length; exact lw).
  assert (N : is_near_centre n n u).
  { split; [exact lu |]. rewrite <- lu, firstn_all, skipn_all. split; [| unfold Twofold.size; cbn [Linear.dot]; rewrite sqrt_0; lra]. apply Twofold.size_below; [lra |].
    unfold u. rewrite Linear.dot_map, (Solve.dot_commutes w), Linear.dot_map. assert (I : 0 < / Q2R d) by (apply Rinv_0_lt_compat; lra). fold w in near.
    apply Rle_trans with (/ Q2R d * (/ Q2R d * Q2R d ^ 2)); [| right; field; lra]. do 2 (apply Rmult_le_compat_l; [lra |]). nra. }
  set (moved := map (fun p => Plus (fst p) (off (snd p) d)) (combine xs (seq 0 n))) in *.
  assert (Y : map (@Claim.value (beside names u)) moved = y).
  { apply Twofold.same_entries; [unfold moved; rewrite !map_length, combine_length, seq_length, lx; rewrite ly, lX; lia |]. intro k. unfold moved. rewrite map_map.
    destruct (Nat.lt_ge_cases k n) as [hk | hk]; [| rewrite !nth_overflow; [reflexivity | rewrite ly, lX; exact hk | rewrite map_length, combine_length, seq_length, lx; lia]].
    set (f := fun p => @Claim.value (beside names u) (Plus (fst p) (off (snd p) d))). rewrite (nth_indep _ 0 (f (0 // 1, 0%nat))) by (rewrite map_length, combine_length, seq_length, lx; lia).
    rewrite map_nth, combine_nth by (rewrite seq_length; exact lx). rewrite seq_nth by exact hk. unfold f. cbn [fst snd Claim.value]. change (@Claim.value (beside names u) (nth k xs (0 // 1)) + @Claim.value (beside names u) (off k d) = nth k y 0).
    rewrite (off_is n n u k d N). unfold u. replace 0 with (/ Q2R d * 0) at 1 by ring. rewrite map_nth. unfold w. rewrite Twofold.less_entries. cbn [Nat.add].
    assert (E : @Claim.value (beside names u) (nth k xs (0 // 1)) = nth k x 0).
    { pose proof (named_values names u xs sx) as S. fold x in S. rewrite <- S. rewrite (nth_indep _ 0 (@Claim.value (beside names u) (0 // 1))) by (rewrite map_length, lx; exact hk). rewrite map_nth. reflexivity. }
    eapply eq_trans; [exact (f_equal (fun z => z + Q2R d * (/ Q2R d * (nth k y 0 - nth k x 0))) E) |]. field. lra. }
  pose proof (stays_below_sound bits n n names _ u far N) as below. assert (T : map (@Claim.value (beside names u)) thetas = theta) by exact (named_values names u thetas st).
  assert (F : map (@Claim.value (beside names u)) (map (number_at (numbers_at m thetas moved)) es) = map (@Claim.value names) rhos).
  { rewrite (Each (beside names u) thetas moved), T, Y. apply same_lengths. rewrite !map_map. etransitivity; [| exact is_at]. symmetry. exact (JV _ _). }
  rewrite <- (named_values names u rhos sr) in F. revert F below. generalize (map (number_at (numbers_at m thetas moved)) es) rhos. clear. intros l r F below.
  enough (@Claim.value (beside names u) (sum_of (fun q : number * number * Z => Times (snd q // 1) (Minus (fst (fst q)) (snd (fst q)))) (combine (combine l r) v)) = 0) by lra.
  clear below. revert r F v. induction l as [| a l IH]; intros [| q r] F [| z v]; try discriminate; try (cbn; lra). cbn [map] in F. injection F as F1 F2.
  cbn [combine sum_of fold_right fst snd Claim.value]. unfold sum_of in IH. rewrite (IH r F2 v), F1. ring.
Qed.
End Precision.
End Named.
