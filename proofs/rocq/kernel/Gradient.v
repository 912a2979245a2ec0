(** * Derivatives of formulas by parameters

    As formula.rs has them: a fraction with one denominator for all, which is not zero where the formula is
    defined ([gradient_sound]). *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Velocity.
From Orthocert.kernel Require Import Elbow Formula Linear Acceleration.
Import ListNotations.
Local Open Scope R_scope.

Definition fraction : Type := list formula * formula.

(** p f' + q g' *)
Definition combined (f : fraction) (p : formula) (g : fraction) (q : formula) : fraction :=
  let sum p q := map (fun n => plus (times p (fst n)) (times q (snd n))) (combine (fst f) (fst g)) in
  if same (snd f) (snd g) then (sum p q, snd f) else (sum (times p (snd g)) (times q (snd f)), times (snd f) (snd g)).

Section By.
(** The parameters by which formulas are derived. *)
Variable by_ : list nat.

Definition stays : fraction := (map (fun _ => integer 0) by_, integer 1).
Fixpoint gradient (f : formula) : fraction :=
  match f with F o =>
    match o with
    | Coord _ | Integer _ => stays
    | Param j => if existsb (Nat.eqb j) by_ then (map (fun k => integer (if Nat.eqb k j then 1 else 0)) by_, integer 1) else stays
    | Add a b => combined (gradient a) (integer 1) (gradient b) (integer 1)
    | Sub a b => combined (gradient a) (integer 1) (gradient b) (integer (-1))
    | Neg a => let g := gradient a in (map opposite (fst g), snd g)
    | Mul a b => combined (gradient a) b (gradient b) a
    | Div a b =>
        let g := combined (gradient a) (integer 1) (gradient b) (opposite f) in
        if forallb (is 0) (fst g) then g else (fst g, times (snd g) b)
    | Sqr a => let g := gradient a in (map (times (times (integer 2) a)) (fst g), snd g)
    | Sqrt a => let g := gradient a in
        if forallb (is 0) (fst g) then (fst g, integer 1) else (fst g, times (snd g) (times (integer 2) f))
    | Elbow second a b t =>
        let c := F (Elbow false a b t) in let s := F (Elbow true a b t) in
        let along := combined (gradient a) (minus a c) (gradient b) (minus b s) in
        let g := combined along (integer 2) (gradient t) (integer (-1)) in
        let n := map (times (if second then c else opposite s)) (fst g) in
        if forallb (is 0) n then (n, snd g) else (n, times (snd g) (times (integer 2) (minus (times b c) (times a s))))
    end
  end.
Definition derivatives (f : formula) : list formula :=
  let g := gradient f in map (fun n => if is 0 n then n else over n (snd g)) (fst g).

Lemma combined_length : forall f p g q, length (fst f) = length by_ -> length (fst g) = length by_ -> length (fst (combined f p g q)) = length by_.
Proof. intros f p g q h k. unfold combined. destruct (same (snd f) (snd g)); cbn [fst]; rewrite map_length, combine_length; lia. Qed.

Fixpoint gradient_length (f : formula) : length (fst (gradient f)) = length by_.
Proof.
  destruct f as [o]. destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | second a b e]; cbn [gradient]; try (apply map_length);
    try (apply combined_length; apply gradient_length).
  - destruct (existsb _ by_); apply map_length.
  - cbn [fst]. rewrite map_length. apply gradient_length.
  - match goal with |- context [forallb _ (fst ?g)] => assert (e : length (fst g) = length by_) by (apply combined_length; apply gradient_length) end.
    destruct (forallb _ _); exact e.
  - cbn [fst]. rewrite map_length. apply gradient_length.
  - destruct (forallb _ _); apply gradient_length.
  - cbv zeta. set (g := combined _ _ _ _). assert (l : length (fst g) = length by_) by (unfold g; repeat apply combined_length; apply gradient_length).
    destruct (forallb _ _); cbn [fst]; rewrite map_length; exact l.
Qed.

(** ** What they are *)

Variables (x : list R) (theta : R -> list R) (t : R) (rate : nat -> R).
Local Notation val := (value x (theta t)).

Definition along (l : list formula) : R := dot (map rate by_) (map val l).

Lemma dot_sum : forall p q r l m, length l = length m ->
  dot r (map val (map (fun n => plus (times p (fst n)) (times q (snd n))) (combine l m))) = val p * dot r (map val l) + val q * dot r (map val m).
Proof.
  intros p q. induction r as [| y r IH]; intros [| n l] [| k m] e; try discriminate; cbn [combine map dot fst snd]; try ring.
  rewrite (IH l m) by (cbn in *; congruence). rewrite value_plus, !value_times. ring.
Qed.
Lemma along_sum : forall p q l m, length l = length by_ -> length m = length by_ ->
  along (map (fun n => plus (times p (fst n)) (times q (snd n))) (combine l m)) = val p * along l + val q * along m.
Proof. intros p q l m el em. apply dot_sum. congruence. Qed.

Lemma along_map : forall (g : formula -> formula) a l, (forall n, val (g n) = a * val n) -> along (map g l) = a * along l.
Proof.
  unfold along. intros g a l h. generalize (map rate by_) as r. induction l as [| n l IH]; intros [| y r]; cbn [map dot]; try ring. rewrite IH, h. ring.
Qed.

Lemma along_zero : forall l, forallb (is 0) l = true -> along l = 0.
Proof.
  unfold along. intro l. generalize (map rate by_) as r. induction l as [| n l IH]; intros [| y r] h; cbn [map dot]; try reflexivity.
  cbn [forallb] in h. apply andb_true_iff in h as [h1 h2]. rewrite (is_value x (theta t) _ _ h1), (IH r h2). ring.
Qed.

Lemma own_rate : forall j b, NoDup b -> In j b -> dot (map rate b) (map val (map (fun k => integer (if Nat.eqb k j then 1 else 0)) b)) = rate j.
Proof.
  intro j. induction b as [| k b IH]; intros once h; [contradiction |]. cbn [map dot]. inversion once as [| ? ? no once']; subst.
  assert (None : forall c, ~ In j c -> dot (map rate c) (map val (map (fun k => integer (if Nat.eqb k j then 1 else 0)) c)) = 0).
  { induction c as [| i c I]; intro n; [reflexivity |]. cbn [map dot]. rewrite I by (intro; apply n; right; assumption).
    destruct (Nat.eqb_spec i j) as [-> |]; [exfalso; apply n; left; reflexivity | cbn; ring]. }
  destruct (Nat.eqb_spec k j) as [-> | n].
  - rewrite (None b no). cbn. ring.
  - rewrite (IH once') by (destruct h; [contradiction | assumption]). cbn. ring.
Qed.

Hypothesis once : NoDup by_.
Hypothesis moves : forall j, derivable_pt_lim (fun u => nth j (theta u) 0) t (rate j).
Hypothesis others_stay : forall j, ~ In j by_ -> rate j = 0.

Definition is_derivative (f : formula) (g : fraction) : Prop :=
  val (snd g) <> 0 /\ derivable_pt_lim (fun u => value x (theta u) f) t (along (fst g) / val (snd g)).

Lemma stays_sound : forall f, derivable_pt_lim (fun u => value x (theta u) f) t 0 -> is_derivative f stays.
Proof.
  intros f h. split; [cbn; lra |]. unfold stays. cbn [fst snd]. rewrite along_zero by (clear; induction by_; cbn; auto).
  cbn. replace (0 / 1) with 0 by field. exact h.
Qed.

Lemma combined_sound : forall a b p q y z f, length (fst a) = length by_ -> length (fst b) = length by_ -> val (snd a) <> 0 -> val (snd b) <> 0 ->
  derivable_pt_lim f t (val p * (along (fst a) / val (snd a)) + val q * (along (fst b) / val (snd b))) ->
  combined a p b q = (y, z) -> val z <> 0 /\ derivable_pt_lim f t (along y / val z).
Proof.
  intros a b p q y z f la lb na nb h e. unfold combined in e. destruct (same (snd a) (snd b)) eqn:s; injection e as <- <-.
  - apply same_sound in s. split; [exact na |]. rewrite along_sum by assumption. rewrite <- s in *.
    replace ((val p * along (fst a) + val q * along (fst b)) / val (snd a)) with (val p * (along (fst a) / val (snd a)) + val q * (along (fst b) / val (snd a))) by (field; exact na).
    exact h.
  - rewrite value_times. split; [apply Rmult_integral_contrapositive_currified; assumption |]. rewrite along_sum, !value_times by assumption.
    replace ((val p * val (snd b) * along (fst a) + val q * val (snd a) * along (fst b)) / (val (snd a) * val (snd b)))
      with (val p * (along (fst a) / val (snd a)) + val q * (along (fst b) / val (snd b))) by (field; split; assumption).
    exact h.
Qed.

Lemma value_integer : forall n, val (integer n) = IZR n.
Proof. reflexivity. Qed.

Theorem gradient_sound : forall f, defined x (theta t) f -> is_derivative f (gradient f).
Proof.
  fix IH 1. intros [o] d. pose proof gradient_length as Len. unfold is_derivative. destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | second a b e]; cbn [defined map_op defined_op all_op] in d.
  - apply stays_sound. apply derivable_pt_lim_const.
  - cbn [gradient]. destruct (existsb (Nat.eqb j) by_) eqn:e.
    + apply existsb_exists in e as [k [i ek]]. apply Nat.eqb_eq in ek. subst k. cbn [fst snd]. unfold along. rewrite (own_rate j by_ once i), value_integer.
      split; [lra |]. replace (rate j / 1) with (rate j) by field. apply moves.
    + apply stays_sound. apply (derivable_eq _ _ _ _ 0 (moves j)); [reflexivity |]. symmetry. apply others_stay. intro i.
      assert (T : existsb (Nat.eqb j) by_ = true) by (apply existsb_exists; exists j; split; [exact i | apply Nat.eqb_refl]). congruence.
  - apply stays_sound. apply derivable_pt_lim_const.
  - destruct d as [_ [da db]]. destruct (IH a da) as [na ha], (IH b db) as [nb hb]. change (gradient (F (Add a b))) with (combined (gradient a) (integer 1) (gradient b) (integer 1)).
    destruct (combined (gradient a) (integer 1) (gradient b) (integer 1)) as [y z] eqn:e. refine (combined_sound _ _ _ _ _ _ _ (Len a) (Len b) na nb _ e).
    rewrite value_integer, !Rmult_1_l. exact (derivable_add _ _ _ _ _ ha hb).
  - destruct d as [_ [da db]]. destruct (IH a da) as [na ha], (IH b db) as [nb hb]. change (gradient (F (Sub a b))) with (combined (gradient a) (integer 1) (gradient b) (integer (-1))).
    destruct (combined (gradient a) (integer 1) (gradient b) (integer (-1))) as [y z] eqn:e. refine (combined_sound _ _ _ _ _ _ _ (Len a) (Len b) na nb _ e).
    rewrite !value_integer. eapply derivable_eq; [exact (derivable_add _ _ _ _ _ ha (derivable_scal (-1) _ _ _ hb)) | |]; [intro; cbn [value map_op real_op]; ring | ring].
  - destruct d as [_ da]. destruct (IH a da) as [na ha]. cbn [gradient]. cbn [fst snd]. split; [exact na |].
    rewrite (along_map opposite (-1)) by (intro; rewrite value_opposite; ring).
    eapply derivable_eq; [exact (derivable_scal (-1) _ _ _ ha) | |]; [intro; cbn [value map_op real_op]; ring | field; exact na].
  - destruct d as [_ [da db]]. destruct (IH a da) as [na ha], (IH b db) as [nb hb]. change (gradient (F (Mul a b))) with (combined (gradient a) b (gradient b) a).
    destruct (combined (gradient a) b (gradient b) a) as [y z] eqn:e. refine (combined_sound _ _ _ _ _ _ _ (Len a) (Len b) na nb _ e).
    eapply derivable_eq; [exact (derivable_times _ _ _ _ _ ha hb) | |]; [reflexivity | cbn beta; ring].
  - destruct d as [b0 [da db]]. destruct (IH a da) as [na ha], (IH b db) as [nb hb].
    change (gradient (F (Div a b))) with (let g := combined (gradient a) (integer 1) (gradient b) (opposite (F (Div a b))) in if forallb (is 0) (fst g) then g else (fst g, times (snd g) b)).
    pose proof (derivable_pt_lim_div _ _ t _ _ ha hb b0) as H.
    assert (K : forall y z, combined (gradient a) (integer 1) (gradient b) (opposite (F (Div a b))) = (y, z) -> val z <> 0 /\
      derivable_pt_lim (fun u => val b * (value x (theta u) a / value x (theta u) b)) t (along y / val z)).
    { intros y z e. refine (combined_sound _ _ _ _ _ _ _ (Len a) (Len b) na nb _ e).
      rewrite value_integer, value_opposite. eapply derivable_eq; [exact (derivable_scal (val b) _ _ _ H) | reflexivity |].
      cbn [value map_op real_op]. unfold Rsqr. field. split; [assumption |]. split; assumption. }
    cbv zeta. destruct (combined (gradient a) (integer 1) (gradient b) (opposite (F (Div a b)))) as [y z] eqn:e. destruct (K y z eq_refl) as [nz hz]. cbn [fst snd].
    pose proof (derivable_scal (/ val b) _ _ _ hz) as Hz.
    assert (G : forall d, d = / val b * (along y / val z) -> derivable_pt_lim (fun u => value x (theta u) (F (Div a b))) t d).
    { intros d e'. eapply derivable_eq; [exact Hz | | exact e']. intro u. cbv beta. rewrite <- Rmult_assoc, Rinv_l, Rmult_1_l by exact b0. reflexivity. }
    destruct (forallb (is 0) y) eqn:zero; cbn [fst snd].
    + split; [exact nz |]. apply G. rewrite (along_zero y zero). field. split; assumption.
    + rewrite value_times. split; [apply Rmult_integral_contrapositive_currified; assumption |]. apply G. field. split; assumption.
  - destruct d as [_ da]. destruct (IH a da) as [na ha]. cbn [gradient]. cbn [fst snd]. split; [exact na |].
    rewrite (along_map (times (times (integer 2) a)) (2 * val a)) by (intro; rewrite !value_times; cbn; ring).
    eapply derivable_eq; [exact (derivable_square _ _ _ ha) | |]; [reflexivity | cbv beta; field; exact na].
  - destruct d as [a0 da]. destruct (IH a da) as [na ha].
    pose proof (derivable_pt_lim_comp _ sqrt t _ _ ha (derivable_pt_lim_sqrt _ a0)) as H. pose proof (sqrt_lt_R0 _ a0) as s0.
    assert (G : forall d, d = / (2 * sqrt (val a)) * (along (fst (gradient a)) / val (snd (gradient a))) -> derivable_pt_lim (fun u => value x (theta u) (F (Sqrt a))) t d)
      by (intros d ->; exact H).
    change (gradient (F (Sqrt a))) with (let g := gradient a in if forallb (is 0) (fst g) then (fst g, integer 1) else (fst g, times (snd g) (times (integer 2) (F (Sqrt a))))).
    cbv zeta. destruct (forallb (is 0) (fst (gradient a))) eqn:zero; cbn [fst snd].
    + split; [cbn; lra |]. apply G. rewrite (along_zero _ zero), value_integer. field. split; assumption || lra.
    + rewrite !value_times. cbn [value map_op real_op] in *. rewrite value_integer. split; [repeat apply Rmult_integral_contrapositive_currified; lra |].
      apply G. field. split; assumption || lra.
  - destruct d as [r [da [db de]]]. destruct (IH a da) as [na ha], (IH b db) as [nb hb], (IH e de) as [ne he]. cbn [gradient].
    set (fc := F (Elbow false a b e)). set (fs := F (Elbow true a b e)). pose proof (elbow_rates _ _ _ t _ _ _ ha hb he r) as R. cbv zeta in R.
    assert (vc : val fc = fst (elbow (val a) (val b) (val e))) by reflexivity. assert (vs : val fs = snd (elbow (val a) (val b) (val e))) by reflexivity.
    destruct (elbow (val a) (val b) (val e)) as [c s]. cbn [fst snd] in vc, vs. destruct R as [h0 [Rc Rs]].
    set (da' := along (fst (gradient a)) / val (snd (gradient a))) in *. set (db' := along (fst (gradient b)) / val (snd (gradient b))) in *.
    set (de' := along (fst (gradient e)) / val (snd (gradient e))) in *.
    (* Along the line through the values at t. *)
    assert (line : forall y, derivable_pt_lim (fun u => y * (u - t)) t y)
      by (intro y; eapply derivable_eq; [exact (derivable_scal y _ _ _ (derivable_add _ _ _ _ _ (derivable_pt_lim_id t) (derivable_const (- t) t))) | intro u; unfold id; ring | ring]).
    destruct (combined (gradient a) (minus a fc) (gradient b) (minus b fs)) as [y z] eqn:ey.
    destruct (combined_sound _ _ _ _ _ _ _ (Len a) (Len b) na nb (line _) ey) as [nz hz]. pose proof (combined_length (gradient a) (minus a fc) (gradient b) (minus b fs) (Len a) (Len b)) as ly. rewrite ey in ly. cbn [fst] in ly.
    pose proof (uniqueness_limite _ _ _ _ (line _) hz) as Ey. clear hz. rewrite !value_minus, vc, vs in Ey. fold da' db' in Ey.
    destruct (combined (y, z) (integer 2) (gradient e) (integer (-1))) as [k l] eqn:ek. cbv zeta. cbn [fst snd].
    destruct (combined_sound (y, z) (gradient e) (integer 2) (integer (-1)) k l _ ly (Len e) nz ne (line _) ek) as [nl hl].
    pose proof (uniqueness_limite _ _ _ _ (line _) hl) as Ek. clear hl. cbn [fst snd] in Ek. rewrite !value_integer, <- Ey in Ek. fold de' in Ek.
    assert (G : forall w, w = val (if second then fc else opposite fs) * (along k / val l) / (2 * (val b * c - val a * s)) ->
      derivable_pt_lim (fun u => value x (theta u) (F (Elbow second a b e))) t w).
    { intros w ->. rewrite <- Ek. destruct second; [rewrite vc | rewrite value_opposite, vs].
      - eapply derivable_eq; [exact Rs | reflexivity | field; lra].
      - eapply derivable_eq; [exact Rc | reflexivity | field; lra]. }
    set (by_s := if second then fc else opposite fs) in *.
    assert (M : along (map (times by_s) k) = val by_s * along k) by (apply along_map; intro; apply value_times).
    destruct (forallb (is 0) (map (times by_s) k)) eqn:zero; cbn [fst snd].
    + split; [exact nl |]. apply G. rewrite (along_zero _ zero). rewrite (along_zero _ zero) in M. replace (val by_s * (along k / val l)) with (val by_s * along k / val l) by (unfold Rdiv; ring).
      rewrite <- M. field. split; first [exact nl | lra].
    + rewrite !value_times, value_minus, !value_times, vc, vs, value_integer. split; [apply Rmult_integral_contrapositive_currified; [exact nl | lra] |].
      apply G. rewrite M. field. split; first [exact nl | lra].
Qed.

Corollary derivatives_sound : forall f, defined x (theta t) f ->
  derivable_pt_lim (fun u => value x (theta u) f) t (dot (map rate by_) (map val (derivatives f))).
Proof.
  intros f d. destruct (gradient_sound f d) as [nz h]. eapply derivable_eq; [exact h | reflexivity |]. unfold derivatives. fold (along (map (fun n => if is 0 n then n else over n (snd (gradient f))) (fst (gradient f)))).
  rewrite (along_map _ (/ val (snd (gradient f)))); [unfold Rdiv; ring |]. intro n. destruct (is 0 n) eqn:z; [rewrite (is_value _ _ _ _ z); ring | rewrite value_over; unfold Rdiv; ring].
Qed.
End By.
