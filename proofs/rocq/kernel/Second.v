(** * Tolerances to second order

    What one machine and another differ by, where some parameters are moved first: by their derivatives at the one
    machine, and by second derivatives at a machine between the two ([Taylor]); then others are, as in Tolerances.v.
    Second derivatives are enclosed beside values and derivatives as the tape is run, by every two of these parameters. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require MeanValue.
From Orthocert Require Import Fixed Velocity.
From Orthocert.kernel Require Import Elbow Formula Linear Arithmetic Slope Definite Test Acceleration Tolerances.
Import ListNotations.
Local Open Scope R_scope.

(** ** Derivatives by parameter [j], as formulas *)

Fixpoint derive (j : nat) (e : formula) : formula :=
  match e with F o =>
    match o with
    | Coord _ | Integer _ => integer 0
    | Param i => integer (if Nat.eqb i j then 1 else 0)
    | Add a b => F (Add (derive j a) (derive j b))
    | Sub a b => F (Add (derive j a) (F (Neg (derive j b))))
    | Neg a => F (Neg (derive j a))
    | Mul a b => F (Add (F (Mul b (derive j a))) (F (Mul a (derive j b))))
    | Div a b => F (Div (F (Add (derive j a) (F (Mul (F (Neg (F (Div a b)))) (derive j b))))) b)
    | Sqr a => F (Mul (F (Mul (integer 2) a)) (derive j a))
    | Sqrt a => F (Div (derive j a) (F (Mul (integer 2) (F (Sqrt a)))))
    | Elbow second a b t =>
        let c := F (Elbow false a b t) in let s := F (Elbow true a b t) in
        let along := F (Add (F (Mul (F (Sub a c)) (derive j a))) (F (Mul (F (Sub b s)) (derive j b)))) in
        F (Div (F (Mul (if second then c else F (Neg s)) (F (Add (F (Mul (integer 2) along)) (F (Neg (derive j t)))))))
          (F (Mul (integer 2) (F (Sub (F (Mul b c)) (F (Mul a s)))))))
    end
  end.

Section Derivatives.
Variables x theta : list R.
Local Notation value := (value x theta).
Local Notation defined := (defined x theta).

Lemma value_derive : forall j e, value (derive j e) = rate x theta j e.
Proof.
  intro j. fix IH 1. intros [o]. destruct o as [k | i | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [derive rate].
  - reflexivity.
  - cbn. destruct (Nat.eqb i j); reflexivity.
  - reflexivity.
  - cbn [Formula.value map_op real_op]. rewrite !IH. reflexivity.
  - cbn [Formula.value map_op real_op]. rewrite !IH. reflexivity.
  - cbn [Formula.value map_op real_op]. rewrite !IH. reflexivity.
  - cbn [Formula.value map_op real_op]. rewrite !IH. reflexivity.
  - cbn [Formula.value map_op real_op]. rewrite !IH. reflexivity.
  - cbn [Formula.value map_op real_op integer]. rewrite !IH. reflexivity.
  - cbn [Formula.value map_op real_op integer]. rewrite !IH. reflexivity.
  - destruct (elbow (value a) (value b) (value t)) as [c s] eqn:E. destruct second; cbn [Formula.value map_op real_op integer]; rewrite E, !IH; reflexivity.
Qed.

Lemma defined_derive : forall j e, defined e -> defined (derive j e).
Proof.
  intro j. fix IH 1. intros [o] d. destruct o as [k | i | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [Formula.defined map_op defined_op all_op] in d; cbn [derive].
  - cbn. auto.
  - cbn. auto.
  - cbn. auto.
  - destruct d as [_ [da db]]. cbn. auto 20.
  - destruct d as [_ [da db]]. cbn. auto 20.
  - destruct d as [_ da]. cbn. auto 20.
  - destruct d as [_ [da db]]. cbn. auto 20.
  - destruct d as [b0 [da db]]. cbn. auto 20.
  - destruct d as [_ da]. cbn. auto 20.
  - destruct d as [a0 da]. pose proof (sqrt_lt_R0 _ a0) as s0. cbn [Formula.defined map_op defined_op all_op integer]. split; [change (2 * sqrt (value a) <> 0); lra |]. auto 20.
  - destruct d as [r [da [db dt]]]. pose proof (elbow_is _ _ _ r) as K. pose proof (sqrt_lt_R0 _ r) as s0.
    assert (N : 2 * (value b * fst (elbow (value a) (value b) (value t)) - value a * snd (elbow (value a) (value b) (value t))) <> 0)
      by (destruct (elbow (value a) (value b) (value t)) as [c s]; cbn [fst snd]; lra).
    destruct second; cbn [Formula.defined map_op defined_op all_op integer]; (split; [exact N |]); auto 20.
Qed.

Definition second_rate (j l : nat) (e : formula) : R := rate x theta l (derive j e).

(** By the rules of the first ones. *)
Lemma second_mul : forall j l a b, second_rate j l (F (Mul a b)) =
  (rate x theta j a * rate x theta l b + rate x theta l a * rate x theta j b) + (value b * second_rate j l a + value a * second_rate j l b).
Proof. intros. unfold second_rate. cbn [derive rate]. rewrite !value_derive. ring. Qed.
Lemma second_div : forall j l a b, second_rate j l (F (Div a b)) =
  (second_rate j l a + - (rate x theta l (F (Div a b)) * rate x theta j b + value (F (Div a b)) * second_rate j l b) + - (rate x theta j (F (Div a b)) * rate x theta l b)) / value b.
Proof.
  intros. unfold second_rate. cbn [derive]. set (n := F (Add _ _)). assert (N : value n / value b = rate x theta j (F (Div a b))) by (unfold n; cbn [Formula.value map_op real_op rate]; rewrite !value_derive; reflexivity).
  change (rate x theta l (F (Div n b))) with ((rate x theta l n + - (value n / value b) * rate x theta l b) / value b). rewrite N. unfold n. clear N n. f_equal.
  change (rate x theta l (F (Add (derive j a) (F (Mul (F (Neg (F (Div a b)))) (derive j b)))))) with
    (rate x theta l (derive j a) + (value (derive j b) * - rate x theta l (F (Div a b)) + - value (F (Div a b)) * rate x theta l (derive j b))). rewrite value_derive. ring.
Qed.
Lemma second_sqr : forall j l a, second_rate j l (F (Sqr a)) = 2 * (rate x theta j a * rate x theta l a + value a * second_rate j l a).
Proof. intros. unfold second_rate. cbn [derive rate integer Formula.value map_op real_op]. rewrite !value_derive. ring. Qed.
Lemma second_sqrt : forall j l a, second_rate j l (F (Sqrt a)) = (second_rate j l a + - (2 * (rate x theta j (F (Sqrt a)) * rate x theta l (F (Sqrt a))))) / (2 * sqrt (value a)).
Proof.
  intros. unfold second_rate. cbn [derive]. change (rate x theta l (F (Div (derive j a) (F (Mul (integer 2) (F (Sqrt a))))))) with
    ((rate x theta l (derive j a) + - (value (derive j a) / (2 * sqrt (value a))) * (sqrt (value a) * 0 + 2 * rate x theta l (F (Sqrt a)))) / (2 * sqrt (value a))).
  rewrite value_derive. change (rate x theta j (F (Sqrt a))) with (rate x theta j a / (2 * sqrt (value a))). unfold Rdiv. ring.
Qed.
Lemma second_elbow : forall j l second a b t, let e := F (Elbow second a b t) in
  let c := value (F (Elbow false a b t)) in let s := value (F (Elbow true a b t)) in let D := 2 * (value b * c - value a * s) in
  let c_l := rate x theta l (F (Elbow false a b t)) in let s_l := rate x theta l (F (Elbow true a b t)) in
  let n_j := 2 * ((value a - c) * rate x theta j a + (value b - s) * rate x theta j b) + - rate x theta j t in
  let n_jl := 2 * ((rate x theta l a - c_l) * rate x theta j a + (value a - c) * second_rate j l a + ((rate x theta l b - s_l) * rate x theta j b + (value b - s) * second_rate j l b)) + - second_rate j l t in
  let D_l := 2 * (c * rate x theta l b + value b * c_l + - (s * rate x theta l a + value a * s_l)) in
  second_rate j l e = ((if second then c_l else - s_l) * n_j + (if second then c else - s) * n_jl + - (rate x theta j e * D_l)) / D.
Proof.
  intros. unfold second_rate. unfold e. cbn [derive]. set (ec := F (Elbow false a b t)) in *. set (es := F (Elbow true a b t)) in *.
  set (n := F (Mul (if second then ec else F (Neg es)) _)). set (d := F (Mul (integer 2) (F (Sub (F (Mul b ec)) (F (Mul a es)))))).
  assert (Q : value n / value d = rate x theta j e) by (rewrite <- value_derive; reflexivity).
  change (rate x theta l (F (Div n d))) with ((rate x theta l n + - (value n / value d) * rate x theta l d) / value d). rewrite Q. change (value d) with D. f_equal.
  assert (L : forall ec es, rate x theta l (F (Mul (integer 2) (F (Sub (F (Mul b ec)) (F (Mul a es)))))) =
    2 * (value ec * rate x theta l b + value b * rate x theta l ec + - (value es * rate x theta l a + value a * rate x theta l es)))
    by (intros; cbn [integer rate Formula.value map_op real_op]; ring).
  assert (N : forall u ec es, rate x theta l (F (Mul u (F (Add (F (Mul (integer 2) (F (Add (F (Mul (F (Sub a ec)) (derive j a))) (F (Mul (F (Sub b es)) (derive j b))))))) (F (Neg (derive j t))))))) =
    rate x theta l u * (2 * ((value a - value ec) * rate x theta j a + (value b - value es) * rate x theta j b) + - rate x theta j t) +
    value u * (2 * ((rate x theta l a - rate x theta l ec) * rate x theta j a + (value a - value ec) * rate x theta l (derive j a) +
      ((rate x theta l b - rate x theta l es) * rate x theta j b + (value b - value es) * rate x theta l (derive j b))) + - rate x theta l (derive j t)))
    by (intros; cbn [integer rate Formula.value map_op real_op]; rewrite !value_derive; ring).
  unfold n at 1, d. rewrite L, N. unfold n_j, n_jl, D_l, second_rate. fold c s c_l s_l.
  destruct second; change (rate x theta l (F (Neg es))) with (- s_l); change (value (F (Neg es))) with (- s); fold c c_l; unfold e; ring.
Qed.

(** In either order. *)
Theorem second_symmetric : forall j l e, defined e -> second_rate j l e = second_rate l j e.
Proof.
  intros j l. fix IH 1. intros [o] d. destruct o as [k | i | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [Formula.defined map_op defined_op all_op] in d.
  - reflexivity.
  - unfold second_rate. cbn. destruct (Nat.eqb i j), (Nat.eqb i l); reflexivity.
  - reflexivity.
  - destruct d as [_ [da db]]. pose proof (IH a da) as A. pose proof (IH b db) as B. unfold second_rate in *. cbn [derive rate]. rewrite A, B. reflexivity.
  - destruct d as [_ [da db]]. pose proof (IH a da) as A. pose proof (IH b db) as B. unfold second_rate in *. cbn [derive rate]. rewrite A, B. reflexivity.
  - destruct d as [_ da]. pose proof (IH a da) as A. unfold second_rate in *. cbn [derive rate]. rewrite A. reflexivity.
  - destruct d as [_ [da db]]. rewrite !second_mul, (IH a da), (IH b db). ring.
  - destruct d as [b0 [da db]]. rewrite !second_div, (IH a da), (IH b db). unfold Rdiv. ring.
  - destruct d as [_ da]. rewrite !second_sqr, (IH a da). ring.
  - destruct d as [_ da]. rewrite !second_sqrt, (IH a da). unfold Rdiv. ring.
  - destruct d as [r [da [db dt]]]. rewrite !second_elbow, (IH a da), (IH b db), (IH t dt). pose proof (elbow_is _ _ _ r) as K. pose proof (sqrt_lt_R0 _ r) as s0.
    cbn [rate Formula.value map_op real_op]. destruct (elbow (value a) (value b) (value t)) as [c s]. cbn [fst snd] in *. destruct K as [_ [_ [K _]]].
    set (D := 2 * (value b * c - value a * s)) in *. assert (D0 : D <> 0) by lra. clear K. destruct second; field_simplify_eq; try exact D0; unfold D; ring.
Qed.
End Derivatives.

(** ** From one machine to another, by first derivatives there and second ones between *)

Lemma taylor : forall g g' g'', (forall u, 0 <= u <= 1 -> derivable_pt_lim g u (g' u)) -> (forall u, 0 <= u <= 1 -> derivable_pt_lim g' u (g'' u)) ->
  exists u, 0 <= u <= 1 /\ g 1 = g 0 + g' 0 + / 2 * g'' u.
Proof.
  intros g g' g'' h1 h2. set (K := g 1 - g 0 - g' 0). set (h := fun t => g t + (1 + -1 * t) * g' t + K * (1 + -1 * t) ^ 2).
  assert (D : forall u, 0 <= u <= 1 -> derivable_pt_lim h u ((1 - u) * (g'' u - 2 * K))).
  { intros u hu. assert (L : derivable_pt_lim (fun t => 1 + -1 * t) u (0 + -1 * 1)) by (apply derivable_add; [apply derivable_const | apply derivable_scal, derivable_pt_lim_id]).
    eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_add _ _ _ _ _ (h1 u hu) (derivable_times _ _ _ _ _ L (h2 u hu))) (derivable_scal K _ _ _ (derivable_square _ _ _ L))) | reflexivity |].
    cbv beta. ring. }
  destruct (MeanValue.mean_value_inside h _ 0 1 Rlt_0_1 D) as [u [E hu]]. exists u. split; [lra |].
  assert (Z : (1 - u) * (g'' u - 2 * K) = 0) by (rewrite Rminus_0_r, Rmult_1_r in E; rewrite <- E; unfold h, K; ring).
  apply Rmult_integral in Z as [Z | Z]; [lra |]. unfold K in Z. lra.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Lemma ends_of_way : forall params a b, Forall2 contains params a -> Forall2 contains params b -> towards 0 a b = a /\ towards 1 a b = b.
Proof.
  intros params a b ha hb. pose proof (related_length _ _ _ _ _ ha) as la. pose proof (related_length _ _ _ _ _ hb) as lb. rewrite la in lb. clear - lb. revert b lb.
  induction a as [| y a IH]; intros [| z b] l; try discriminate; [split; reflexivity |]. cbn [length] in l. destruct (IH b ltac:(congruence)) as [I J].
  unfold towards, comb in *. cbn [merge]. rewrite I, J. split; f_equal; ring.
Qed.

Theorem to_second_order : forall by_ x params theta0 theta f, NoDup by_ -> Forall2 contains params theta0 -> Forall2 contains params theta ->
  (forall th, Forall2 contains params th -> defined x th f) -> (forall j, ~ In j by_ -> nth j theta0 0 = nth j theta 0) ->
  let d j := nth j theta 0 - nth j theta0 0 in
  exists th, Forall2 contains params th /\ value x theta f = value x theta0 f + sum_over by_ (fun j => d j * rate x theta0 j f) +
    / 2 * sum_over by_ (fun j => d j * sum_over by_ (fun l => d l * second_rate x th j l f)).
Proof.
  intros by_ x params th0 th f once h0 h1 df same d.
  assert (H : forall e, (forall th, Forall2 contains params th -> defined x th e) -> forall u, 0 <= u <= 1 ->
    derivable_pt_lim (fun u => value x (towards u th0 th) e) u (sum_over by_ (fun j => d j * rate x (towards u th0 th) j e))).
  { intros e de u hu. apply (total_sound by_ x (fun u => towards u th0 th) u d once).
    - intro j. apply derivable_eq with (fun u => d j * u + nth j th0 0) (d j * 1 + 0).
      + apply derivable_add; [apply derivable_scal, derivable_pt_lim_id | apply derivable_const].
      + intro v. rewrite towards_nth. unfold d. ring.
      + ring.
    - intros j n. unfold d. rewrite (same j n). ring.
    - apply de, (towards_in bits); assumption. }
  destruct (taylor (fun u => value x (towards u th0 th) f) (fun u => sum_over by_ (fun j => d j * rate x (towards u th0 th) j f))
    (fun u => sum_over by_ (fun j => d j * sum_over by_ (fun l => d l * second_rate x (towards u th0 th) j l f)))) as [u [hu E]].
  - exact (H f df).
  - intros u hu. clear once same. assert (G : forall l, derivable_pt_lim (fun u => sum_over l (fun j => d j * rate x (towards u th0 th) j f)) u
      (sum_over l (fun j => d j * sum_over by_ (fun l => d l * second_rate x (towards u th0 th) j l f)))); [| exact (G by_)].
    induction l as [| j l IH]; cbn [sum_over fold_right]; [apply derivable_const |]. apply derivable_add; [| exact IH]. apply derivable_scal.
    eapply derivable_eq; [exact (H (derive j f) (fun t ht => defined_derive x t j f (df t ht)) u hu) | intro v; cbv beta; symmetry; apply value_derive | reflexivity].
  - exists (towards u th0 th). split; [apply towards_in; assumption |]. destruct (ends_of_way _ _ _ h0 h1) as [E0 E1]. cbv beta in E. rewrite E0, E1 in E. exact E.
Qed.

(** ** Some parameters moved first *)

Definition is_in (j : nat) (l : list nat) : bool := existsb (Nat.eqb j) l.
Fixpoint partly (i : nat) (first : list nat) (a b : list R) : list R :=
  match a, b with y :: a', z :: b' => (if is_in i first then z else y) :: partly (S i) first a' b' | _, _ => [] end.
Lemma partly_in : forall first params a b i, Forall2 contains params a -> Forall2 contains params b -> Forall2 contains params (partly i first a b).
Proof.
  intros first params a b i h. revert b i. induction h as [| p y params a hp h IH]; intros b i k; inversion k; subst; cbn [partly]; constructor; [destruct (is_in i first); assumption | auto].
Qed.
Lemma partly_nth : forall first a b i j, length a = length b -> nth j (partly i first a b) 0 = if is_in (i + j) first then nth j b 0 else nth j a 0.
Proof.
  intros first. induction a as [| y a IH]; intros [| z b] i j l; try discriminate; cbn [partly]; [destruct j, (is_in _ first); reflexivity |].
  destruct j as [| j]; cbn [nth]; [rewrite Nat.add_0_r; reflexivity |]. rewrite IH by (cbn in l; congruence). replace (S i + j)%nat with (i + S j)%nat by lia. reflexivity.
Qed.

Lemma sum_split : forall (p : nat -> bool) l f g, sum_over (filter p l) f + sum_over (filter (fun j => negb (p j)) l) g = sum_over l (fun j => if p j then f j else g j).
Proof. intros p l f g. induction l as [| j l IH]; cbn [filter]; [unfold sum_over; cbn; ring |]. destruct (p j) eqn:e; cbn [negb]; unfold sum_over in *; cbn [fold_right]; rewrite e, <- IH; ring. Qed.
Lemma sum_same : forall l f g, (forall j, In j l -> f j = g j) -> sum_over l f = sum_over l g.
Proof. intros l f g h. unfold sum_over. induction l as [| j l IH]; [reflexivity |]. cbn [fold_right]. rewrite IH, (h j) by (intros; try apply h; cbn; auto). reflexivity. Qed.
Lemma sum_mapped : forall (A : Type) (g : A -> nat) (l : list A) f, sum_over (map g l) f = fold_right (fun a s => f (g a) + s) 0 l.
Proof. intros A g l f. induction l as [| a l IH]; [reflexivity |]. unfold sum_over in *. cbn [map fold_right]. rewrite IH. reflexivity. Qed.

(** Parameters that are moved first are of second order. *)
Theorem second_mean_value : forall by_ curved x params theta0 theta f, NoDup by_ -> Forall2 contains params theta0 -> Forall2 contains params theta ->
  (forall th, Forall2 contains params th -> defined x th f) -> (forall j, ~ In j by_ -> nth j theta0 0 = nth j theta 0) ->
  let d j := nth j theta 0 - nth j theta0 0 in let first := filter (fun j => is_in j curved) by_ in
  exists th th', Forall2 contains params th /\ Forall2 contains params th' /\
    value x theta f = value x theta0 f + sum_over by_ (fun j => d j * if is_in j curved then rate x theta0 j f else rate x th j f) +
      / 2 * sum_over first (fun j => d j * sum_over first (fun l => d l * second_rate x th' j l f)).
Proof.
  intros by_ curved x params th0 th f once h0 h1 df same d first. set (th1 := partly 0 curved th0 th).
  assert (ll : length th0 = length th) by (rewrite <- (related_length _ _ _ _ _ h0); exact (related_length _ _ _ _ _ h1)).
  pose proof (partly_in curved params th0 th 0 h0 h1) as hm. fold th1 in hm. assert (N : forall j, nth j th1 0 = if is_in j curved then nth j th 0 else nth j th0 0) by (intro; apply partly_nth, ll).
  destruct (to_second_order first x params th0 th1 f) as [t' [ht' E']]; [apply NoDup_filter, once | assumption .. | |].
  { intros j n. rewrite N. destruct (is_in j curved) eqn:e; [| reflexivity]. apply same. intro i. apply n, filter_In. split; assumption. }
  destruct (mean_value bits (filter (fun j => negb (is_in j curved)) by_) x params th1 th f) as [t [ht E]]; [apply NoDup_filter, once | assumption .. | |].
  { intros j n. rewrite N. destruct (is_in j curved) eqn:e; [reflexivity |]. apply same. intro i. apply n, filter_In. split; [exact i | rewrite e; reflexivity]. }
  exists t, t'. split; [exact ht |]. split; [exact ht' |]. cbv zeta in E'.
  assert (D : forall j, In j first -> nth j th1 0 - nth j th0 0 = d j) by (intros j i; apply filter_In in i as [_ i]; rewrite N, i; reflexivity).
  rewrite (sum_ext by_ _ (fun j => if is_in j curved then d j * rate x th0 j f else d j * rate x t j f)) by (intro j; destruct (is_in j curved); reflexivity).
  rewrite <- sum_split. fold first. rewrite E, E'.
  assert (S1 : sum_over first (fun j => (nth j th1 0 - nth j th0 0) * rate x th0 j f) = sum_over first (fun j => d j * rate x th0 j f))
    by (apply sum_same; intros j i; rewrite (D j i); reflexivity).
  assert (S2 : sum_over (filter (fun j => negb (is_in j curved)) by_) (fun j => (nth j th 0 - nth j th1 0) * rate x t j f) = sum_over (filter (fun j => negb (is_in j curved)) by_) (fun j => d j * rate x t j f))
    by (apply sum_same; intros j i; apply filter_In in i as [_ i]; apply negb_true_iff in i; rewrite N, i; reflexivity).
  assert (S3 : sum_over first (fun j => (nth j th1 0 - nth j th0 0) * sum_over first (fun l => (nth l th1 0 - nth l th0 0) * second_rate x t' j l f)) =
    sum_over first (fun j => d j * sum_over first (fun l => d l * second_rate x t' j l f)))
    by (apply sum_same; intros j i; rewrite (D j i); f_equal; apply sum_same; intros l k; rewrite (D l k); reflexivity).
  rewrite S1, S2, S3. ring.
Qed.
End Precision.
