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

(** ** Values with derivatives and second ones: these by every two of some places in [by_], unknown where there are too few *)

Definition curve : Type := dual * list partial_rate.
Definition unknown : partial_rate := Some None.

Section Run.
Variables (coords params : list slope) (by_ : list nat) (pairs : list (nat * nat)).

Definition r_times (r s : partial_rate) : partial_rate :=
  match r, s with None, _ | _, None => None | Some a, Some b => Some (lift2 (fun a b => Some (s_mul bits a b)) a b) end.
Definition r_square (r : partial_rate) : partial_rate := option_map (option_map (s_sqr bits)) r.
Definition r_sub (r s : partial_rate) : partial_rate := r_add r (r_neg s).

(** Of places p and q and the second derivatives of what there is. *)
Fixpoint by_pairs (f : nat -> nat -> partial_rate -> partial_rate -> partial_rate -> partial_rate) (ps : list (nat * nat)) (a b c : list partial_rate) : list partial_rate :=
  match ps, a, b, c with (p, q) :: ps', r :: a', s :: b', t :: c' => f p q r s t :: by_pairs f ps' a' b' c' | _, _, _, _ => [] end.

Definition rate_at (d : dual) (p : nat) : partial_rate := nth p (snd d) unknown.
(** The product of derivatives of one formula. *)
Definition both (d : dual) (p q : nat) : partial_rate := if Nat.eqb p q then r_square (rate_at d p) else r_times (rate_at d p) (rate_at d q).

Definition seconds (o : op curve) (result : dual) : list partial_rate :=
  let one (a : curve) f := by_pairs (fun p q r _ _ => f p q r) pairs (snd a) (snd a) (snd a) in
  let two (a b : curve) f := by_pairs (fun p q r s _ => f p q r s) pairs (snd a) (snd b) (snd b) in
  match o with
  | Coord _ | Param _ | Integer _ => map (fun _ => None) pairs
  | Add a b => two a b (fun _ _ r s => r_add r s)
  | Sub a b => two a b (fun _ _ r s => r_sub r s)
  | Neg a => one a (fun _ _ r => r_neg r)
  | Mul a b => match fst (fst a), fst (fst b) with
      | Some f, Some g => let ra := rate_at (fst a) in let rb := rate_at (fst b) in
          two a b (fun p q r s => r_add (r_add (r_times (ra p) (rb q)) (r_times (ra q) (rb p))) (r_add (r_mul bits g r) (r_mul bits f s)))
      | _, _ => []
      end
  | Div a b => match fst result, fst (fst b) with
      | Some k, Some g => let rk := rate_at result in let rb := rate_at (fst b) in
          two a b (fun p q r s => r_div bits g (r_sub (r_sub r (r_add (r_times (rk q) (rb p)) (r_mul bits k s))) (r_times (rk p) (rb q))))
      | _, _ => []
      end
  | Sqr a => match fst (fst a) with
      | Some f => one a (fun p q r => r_mul bits (Tolerances.two bits) (r_add (both (fst a) p q) (r_mul bits f r)))
      | None => []
      end
  | Sqrt a => match fst result with
      | Some f => let twice := s_mul bits (Tolerances.two bits) f in
          one a (fun p q r => r_div bits twice (r_sub r (r_mul bits (Tolerances.two bits) (both result p q))))
      | None => []
      end
  | Elbow second a b t => match fst (fst a), fst (fst b), fst (fst t) with
      | Some f, Some g, Some h =>
          match s_elbow bits f g h with
          | Some (c, s) =>
              let m := r_mul bits in let plus := r_add in let two := Tolerances.two bits in
              let ra := rate_at (fst a) in let rb := rate_at (fst b) in let rt := rate_at (fst t) in
              let x := s_sub f c in let y := s_sub g s in let d := s_mul bits two (s_sub (s_mul bits g c) (s_mul bits f s)) in
              let n p := r_sub (m two (plus (m x (ra p)) (m y (rb p)))) (rt p) in
              let along u p := r_div bits d (m u (n p)) in
              let by_sine := along (s_neg s) in let by_cosine := along c in
              by_pairs (fun p q r r' r'' =>
                let cq := by_sine q in let sq := by_cosine q in
                let npq := r_sub (m two (plus (plus (r_times (r_sub (ra q) cq) (ra p)) (m x r)) (plus (r_times (r_sub (rb q) sq) (rb p)) (m y r')))) r'' in
                let dq := m two (r_sub (plus (m c (rb q)) (m g cq)) (plus (m s (ra q)) (m f sq))) in
                r_div bits d (r_sub (plus (r_times (if second then cq else r_neg sq) (n p)) (m (if second then c else s_neg s) npq)) (r_times (rate_at result p) dq)))
                pairs (snd a) (snd b) (snd t)
          | None => []
          end
      | _, _, _ => []
      end
  end.
Definition curve_op (o : op curve) : curve := let result := dual_op bits coords params by_ (map_op fst o) in (result, seconds o result).

Section Sound.
Variables (lambda xs cs theta : list R).
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.
Let none := constant zero.
Hypothesis coords_hold : forall k, holds bits lambda (nth k coords none) (nth k cs 0) (nth k xs 0).
Hypothesis params_hold : forall j, holds bits lambda (nth j params none) (nth j theta 0) (nth j theta 0).
Local Notation rate_is := (rate_is bits lambda).

Definition second_is (r : partial_rate) (p q : nat) (e : formula) : Prop :=
  rate_is r (second_rate cs theta (nth p by_ O) (nth q by_ O) e) (second_rate xs theta (nth p by_ O) (nth q by_ O) e).
Definition encloses_seconds (c : curve) (e : formula) : Prop :=
  encloses_rates bits by_ lambda xs cs theta (fst c) e /\
  forall k, second_is (nth k (snd c) unknown) (fst (nth k pairs (O, O))) (snd (nth k pairs (O, O))) e.

Lemma rate_times : forall r s a b c d, rate_is r a b -> rate_is s c d -> rate_is (r_times r s) (a * c) (b * d).
Proof.
  intros [[r |] |] [[s |] |] a b c d h k; cbn [r_times lift2 Tolerances.rate_is] in *; try exact I; try (destruct h; subst; split; ring); try (destruct k; subst; split; ring).
  apply (s_mul_holds bits lambda lambda_in); assumption.
Qed.
Lemma rate_square : forall r a b, rate_is r a b -> rate_is (r_square r) (a * a) (b * b).
Proof.
  intros [[r |] |] a b h; cbn [r_square option_map Tolerances.rate_is] in *; [| exact I | destruct h; subst; split; ring].
  replace (a * a) with (a ^ 2) by ring. replace (b * b) with (b ^ 2) by ring. apply (s_sqr_holds bits lambda lambda_in), h.
Qed.
Lemma rate_sub : forall r s a b c d, rate_is r a b -> rate_is s c d -> rate_is (r_sub r s) (a + - c) (b + - d).
Proof. intros. apply (rate_add bits lambda lambda_in); [assumption | apply rate_neg; assumption]. Qed.
Lemma rate_same : forall r a b a' b', rate_is r a b -> a' = a -> b' = b -> rate_is r a' b'.
Proof. intros; subst; assumption. Qed.

Lemma by_pairs_at : forall (P : nat -> nat -> partial_rate -> Prop) f, (forall p q, P p q unknown) -> forall k ps a b c,
  (forall p q, nth k ps (O, O) = (p, q) -> P p q (f p q (nth k a unknown) (nth k b unknown) (nth k c unknown))) ->
  P (fst (nth k ps (O, O))) (snd (nth k ps (O, O))) (nth k (by_pairs f ps a b c) unknown).
Proof.
  intros P f hu. induction k as [| k IH]; intros [| [p q] ps] [| r a] [| s b] [| t c] h; cbn [by_pairs nth] in *; try apply hu; [apply h; reflexivity | apply IH, h].
Qed.

Lemma curve_op_sound : forall (o : op address) f g, (forall i, encloses_seconds (f i) (g i)) -> encloses_seconds (curve_op (map_op f o)) (F (map_op g o)).
Proof.
  intros o f g h.
  assert (V : encloses_rates bits by_ lambda xs cs theta (dual_op bits coords params by_ (map_op fst (map_op f o))) (F (map_op g o))).
  { replace (map_op fst (map_op f o)) with (map_op (fun i => fst (f i)) o) by (destruct o; reflexivity).
    apply dual_op_sound; try assumption. intro i. exact (proj1 (h i)). }
  split; [exact V |]. intro k. unfold curve_op. cbv zeta. cbn [snd]. set (result := dual_op bits coords params by_ (map_op fst (map_op f o))) in *. clearbody result.
  destruct V as [V W]. fold unknown in W.
  assert (E : forall i s, fst (fst (f i)) = Some s -> holds bits lambda s (value cs theta (g i)) (value xs theta (g i)))
    by (intros i s e; pose proof (proj1 (proj1 (h i))) as K; rewrite e in K; apply K).
  assert (D : forall i p, rate_is (rate_at (fst (f i)) p) (rate cs theta (nth p by_ O) (g i)) (rate xs theta (nth p by_ O) (g i))) by (intros i p; exact (proj2 (proj1 (h i)) p)).
  assert (G : forall i p q, nth k pairs (O, O) = (p, q) -> second_is (nth k (snd (f i)) unknown) p q (g i)) by (intros i p q e; pose proof (proj2 (h i) k) as K; rewrite e in K; exact K).
  assert (U : forall e p q, second_is unknown p q e) by (intros; exact I).
  assert (B : forall d e, (forall p, rate_is (rate_at d p) (rate cs theta (nth p by_ O) e) (rate xs theta (nth p by_ O) e)) -> forall p q,
    rate_is (both d p q) (rate cs theta (nth p by_ O) e * rate cs theta (nth q by_ O) e) (rate xs theta (nth p by_ O) e * rate xs theta (nth q by_ O) e)).
  { intros d e hd p q. unfold both. destruct (Nat.eqb_spec p q) as [<- |]; [apply rate_square, hd | apply rate_times; apply hd]. }
  assert (Nothing : forall p q e, second_is (nth k [] unknown) p q e) by (intros; destruct k; exact I).
  destruct o as [i | j | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [map_op seconds] in *.
  - clear. revert k. induction pairs as [| p l IH]; intros [| k]; cbn [map nth]; try exact I; [split; reflexivity | apply IH].
  - clear. revert k. induction pairs as [| p l IH]; intros [| k]; cbn [map nth]; try exact I; [| apply IH].
    split; reflexivity.
  - clear. revert k. induction pairs as [| p l IH]; intros [| k]; cbn [map nth]; try exact I; [split; reflexivity | apply IH].
  - apply (by_pairs_at (fun p q r => second_is r p q (F (Add (g a) (g b))))); [intros; apply U |]. intros p q e. apply (rate_add bits lambda lambda_in); apply G, e.
  - apply (by_pairs_at (fun p q r => second_is r p q (F (Sub (g a) (g b))))); [intros; apply U |]. intros p q e. apply rate_sub; apply G, e.
  - apply (by_pairs_at (fun p q r => second_is r p q (F (Neg (g a))))); [intros; apply U |]. intros p q e. apply rate_neg, G, e.
  - destruct (fst (fst (f a))) as [s |] eqn:ea; [| apply Nothing]. destruct (fst (fst (f b))) as [t |] eqn:eb; [| apply Nothing].
    apply (by_pairs_at (fun p q r => second_is r p q (F (Mul (g a) (g b))))); [intros; apply U |]. intros p q e. unfold second_is. rewrite !second_mul.
    repeat apply (rate_add bits lambda lambda_in); first [apply rate_times; apply D | apply (rate_mul bits lambda lambda_in); [auto | apply G, e]].
  - destruct (fst result) as [s |] eqn:er; [| apply Nothing]. destruct (fst (fst (f b))) as [t |] eqn:eb; [| apply Nothing]. destruct V as [_ [_ V]].
    apply (by_pairs_at (fun p q r => second_is r p q (F (Div (g a) (g b))))); [intros; apply U |]. intros p q e. unfold second_is. rewrite !second_div.
    apply (rate_div bits lambda lambda_in); [auto |]. apply rate_sub; [apply rate_sub; [apply G, e |]; apply (rate_add bits lambda lambda_in) |].
    + apply rate_times; [apply W | apply D].
    + apply (rate_mul bits lambda lambda_in); [exact V | apply G, e].
    + apply rate_times; [apply W | apply D].
  - destruct (fst (fst (f a))) as [s |] eqn:ea; [| apply Nothing].
    apply (by_pairs_at (fun p q r => second_is r p q (F (Sqr (g a))))); [intros; apply U |]. intros p q e. unfold second_is. rewrite !second_sqr.
    apply (rate_mul bits lambda lambda_in); [apply two_holds |]. apply (rate_add bits lambda lambda_in); [apply B, D | apply (rate_mul bits lambda lambda_in); [auto | apply G, e]].
  - destruct (fst result) as [s |] eqn:er; [| apply Nothing]. destruct V as [_ [_ V]]. cbn [value map_op real_op] in V.
    apply (by_pairs_at (fun p q r => second_is r p q (F (Sqrt (g a))))); [intros; apply U |]. intros p q e. unfold second_is. rewrite !second_sqrt.
    apply (rate_div bits lambda lambda_in); [apply s_mul_holds; [exact lambda_in | apply two_holds | exact V] |]. apply rate_sub; [apply G, e |].
    apply (rate_mul bits lambda lambda_in); [apply two_holds | apply B; exact W].
  - destruct (fst (fst (f a))) as [sa |] eqn:ea; [| apply Nothing]. destruct (fst (fst (f b))) as [sb |] eqn:eb; [| apply Nothing].
    destruct (fst (fst (f t))) as [st |] eqn:et; [| apply Nothing]. apply E in ea, eb, et.
    destruct (s_elbow bits sa sb st) as [[c s] |] eqn:K; [| apply Nothing].
    destruct (s_elbow_holds bits lambda lambda_in _ _ _ _ _ _ _ _ _ _ K ea eb et) as [_ [_ [hc hs]]]. cbn [fst snd] in hc, hs.
    apply (by_pairs_at (fun p q r => second_is r p q (F (Elbow second (g a) (g b) (g t))))); [intros; apply U |]. intros p q e. unfold second_is. rewrite !second_elbow. cbv zeta.
    change (fst (elbow (value cs theta (g a)) (value cs theta (g b)) (value cs theta (g t)))) with (value cs theta (F (Elbow false (g a) (g b) (g t)))) in hc.
    change (fst (elbow (value xs theta (g a)) (value xs theta (g b)) (value xs theta (g t)))) with (value xs theta (F (Elbow false (g a) (g b) (g t)))) in hc.
    change (snd (elbow (value cs theta (g a)) (value cs theta (g b)) (value cs theta (g t)))) with (value cs theta (F (Elbow true (g a) (g b) (g t)))) in hs.
    change (snd (elbow (value xs theta (g a)) (value xs theta (g b)) (value xs theta (g t)))) with (value xs theta (F (Elbow true (g a) (g b) (g t)))) in hs.
    set (ec := F (Elbow false (g a) (g b) (g t))) in *. set (es := F (Elbow true (g a) (g b) (g t))) in *. pose proof (two_holds bits lambda) as h2.
    set (d := s_mul bits (Tolerances.two bits) (s_sub (s_mul bits sb c) (s_mul bits sa s))).
    set (n := fun p => r_sub (r_mul bits (Tolerances.two bits) (r_add (r_mul bits (s_sub sa c) (rate_at (fst (f a)) p)) (r_mul bits (s_sub sb s) (rate_at (fst (f b)) p)))) (rate_at (fst (f t)) p)).
    assert (hx : holds bits lambda (s_sub sa c) (value cs theta (g a) - value cs theta ec) (value xs theta (g a) - value xs theta ec)) by (apply s_sub_holds; assumption).
    assert (hy : holds bits lambda (s_sub sb s) (value cs theta (g b) - value cs theta es) (value xs theta (g b) - value xs theta es)) by (apply s_sub_holds; assumption).
    assert (hd : holds bits lambda d (2 * (value cs theta (g b) * value cs theta ec - value cs theta (g a) * value cs theta es)) (2 * (value xs theta (g b) * value xs theta ec - value xs theta (g a) * value xs theta es)))
      by (unfold d; repeat (apply s_mul_holds || apply s_sub_holds); assumption).
    assert (hn : forall p, rate_is (n p)
      (2 * ((value cs theta (g a) - value cs theta ec) * rate cs theta (nth p by_ O) (g a) + (value cs theta (g b) - value cs theta es) * rate cs theta (nth p by_ O) (g b)) + - rate cs theta (nth p by_ O) (g t))
      (2 * ((value xs theta (g a) - value xs theta ec) * rate xs theta (nth p by_ O) (g a) + (value xs theta (g b) - value xs theta es) * rate xs theta (nth p by_ O) (g b)) + - rate xs theta (nth p by_ O) (g t))).
    { intro p0. unfold n. apply rate_sub; [| apply D]. apply (rate_mul bits lambda lambda_in); [exact h2 |]. apply (rate_add bits lambda lambda_in); apply (rate_mul bits lambda lambda_in); try assumption; apply D. }
    assert (Alike : forall (z : list R), elbow (value z theta (g a)) (value z theta (g b)) (value z theta (g t)) = (value z theta ec, value z theta es))
      by (intro z; unfold ec, es; cbn [value map_op real_op]; destruct (elbow _ _ _); reflexivity).
    assert (hcq : forall q, rate_is (r_div bits d (r_mul bits (s_neg s) (n q))) (rate cs theta (nth q by_ O) ec) (rate xs theta (nth q by_ O) ec)).
    { intro q0. eapply rate_same; [apply (rate_div bits lambda lambda_in); [exact hd |]; apply (rate_mul bits lambda lambda_in); [apply s_neg_holds, hs | apply hn] | |];
        unfold ec at 1; cbn [rate]; rewrite Alike; reflexivity. }
    assert (hsq : forall q, rate_is (r_div bits d (r_mul bits c (n q))) (rate cs theta (nth q by_ O) es) (rate xs theta (nth q by_ O) es)).
    { intro q0. eapply rate_same; [apply (rate_div bits lambda lambda_in); [exact hd |]; apply (rate_mul bits lambda lambda_in); [exact hc | apply hn] | |];
        unfold es at 1; cbn [rate]; rewrite Alike; reflexivity. }
    clearbody ec es. pose proof (fun r z u v w => rate_mul bits lambda lambda_in r z u v w) as Rm. pose proof (fun r z u v w y => rate_add bits lambda lambda_in r z u v w y) as Ra.
    apply (rate_div bits lambda lambda_in); [exact hd |]. apply rate_sub; [apply Ra | apply rate_times; [apply W |]].
    + apply rate_times; [destruct second; [apply hcq | apply rate_neg, hsq] | apply hn].
    + apply Rm; [destruct second; [exact hc | apply s_neg_holds, hs] |]. apply rate_sub; [| apply G, e]. apply Rm; [exact h2 |].
      apply Ra; apply Ra; first [apply Rm; [assumption | apply G, e] | apply rate_times; [apply rate_sub; [apply D | first [apply hcq | apply hsq]] | apply D]].
    + apply Rm; [exact h2 |]. apply rate_sub; apply Ra; (apply Rm; [assumption | first [apply D | apply hcq | apply hsq]]).
Qed.

Theorem seconds_sound : forall keep tape, Forall2 encloses_seconds (run_kept curve ((None, []), []) curve_op keep tape) (formulas tape).
Proof.
  assert (never : forall f, encloses_seconds ((None, []), []) f).
  { intro f. split; [split; [exact I | intros [| p]; exact I] | intros [| k]; exact I]. }
  intros keep tape. apply (run_kept_related curve formula ((None, []), []) (integer 0) curve_op F encloses_seconds); [apply never | exact curve_op_sound | exact never].
Qed.
End Sound.
End Run.

(** ** What there is of a formula: of first derivatives those of the one machine by parameters that are moved first, and second ones by every two of these *)

Section Ends.
Variables (ends : list (nat * choice)) (curved : list nat).

Definition parameter_at (p : nat) : nat := nth p (map fst ends) O.
Fixpoint pairs_of (l : list nat) : list (nat * nat) := match l with [] => [] | p :: l' => map (pair p) l ++ pairs_of l' end.
Definition pairs : list (nat * nat) := pairs_of (filter (fun p => is_in (parameter_at p) curved) (seq 0 (length ends))).
(** Others by a number that no parameter has. *)
Definition of_the_one (params : list fixed) : list nat := map (fun e => if is_in (fst e) curved then fst e else length params) ends.

Fixpoint all_known (l : list partial_rate) : option (list slope) :=
  match l with
  | [] => Some []
  | r :: l' => match match r with None => Some (constant zero) | Some r => r end, all_known l' with Some s, Some ss => Some (s :: ss) | _, _ => None end
  end.
Definition rates_of (one : dual) (all : curve) : option (list slope) :=
  all_known (map (fun p => rate_at (if is_in (parameter_at p) curved then one else fst all) p) (seq 0 (length ends)) ++ map (fun k => nth k (snd all) unknown) (seq 0 (length pairs))).

Definition product (ss : list (list fixed)) (k : nat * nat) : list fixed :=
  if Nat.eqb (fst k) (snd k) then match nth (fst k) ss [] with r :: _ => [halve (mul bits r r)] | [] => [] end
  else flat_map (fun r => map (mul bits r) (nth (snd k) ss [])) (nth (fst k) ss []).
Definition steps (params : list fixed) : list (list fixed) := let ss := Tolerances.steps ends params in ss ++ map (product ss) pairs.

(** What these are steps of. *)
Definition difference (ds : list R) (k : nat * nat) : R := if Nat.eqb (fst k) (snd k) then nth (fst k) ds 0 ^ 2 / 2 else nth (fst k) ds 0 * nth (snd k) ds 0.
Definition differences (theta0 theta : list R) : list R :=
  let ds := map (fun e => nth (fst e) theta 0 - nth (fst e) theta0 0) ends in ds ++ map (difference ds) pairs.

Lemma none_moved_first : filter (fun p => is_in (parameter_at p) []) (seq 0 (length ends)) = [].
Proof. generalize (seq 0 (length ends)). induction l as [| p l IH]; [reflexivity | exact IH]. Qed.

Lemma share_times : forall m n, is_share m -> is_share n -> is_share (m * n).
Proof. intros m n [h1 h2] [k1 k2]. split; nra. Qed.

Lemma stride_square : forall a c ms, stepped bits (snd (start a c)) ms -> exists m r, is_share m /\ contains (hd zero (snd (start a c))) r /\ stride ms ^ 2 = m * (r * r).
Proof.
  intros a c ms h. pose proof (unit_R_pos bits) as u.
  assert (One : forall n, stepped bits [n] ms -> exists m r, is_share m /\ contains n r /\ stride ms ^ 2 = m * (r * r)).
  { clear h. intros n h. inversion h as [| ? [m r] ? ? [h1 h2] h3]; subst. inversion h3; subst. exists (m * m), r. split; [apply share_times; exact h1 |]. split; [exact h2 |]. unfold stride. cbn. ring. }
  destruct c; cbn [start snd hd] in *; [apply One, h .. |]. set (n := (hi a - _)%Z) in *.
  inversion h as [| ? [m r] ? ? [h1 h2] h3]; subst. inversion h3 as [| ? [m' r'] ? ? [k1 k2] k3]; subst. inversion k3; subst. cbn [fst snd] in *.
  assert (e : r' = - r).
  { destruct h2 as [l1 l2], k2 as [g1 g2]. cbn [lo hi] in *. match type of g1 with IZR ?z <= _ => replace z with (- n)%Z in g1, g2 by (unfold n; lia) end. rewrite opp_IZR in g1, g2.
    apply Rmult_eq_reg_r with (unit_R bits); lra. }
  subst r'. exists ((m - m') ^ 2), r. split; [destruct h1, k1; split; [apply pow2_ge_0 |]; assert (-1 <= m - m' <= 1) by lra; set (z := m - m') in *; nra |]. split; [exact h2 |]. unfold stride. cbn. ring.
Qed.

Lemma stepped_products : forall rs ts ms ns, stepped bits rs ms -> stepped bits ts ns ->
  exists ls, stepped bits (flat_map (fun r => map (mul bits r) ts) rs) ls /\ stride ls = stride ms * stride ns.
Proof.
  intros rs ts ms ns h k. induction h as [| r [m y] rs ms [h1 h2] h [ls [l1 l2]]]; cbn [flat_map]; [exists []; split; [constructor | unfold stride; cbn; ring] |].
  exists (map (fun n => (m * fst n, y * snd n)) ns ++ ls). split.
  - apply Forall2_app; [| exact l1]. eapply map_related; [| exact k]. intros t n [k1 k2]. cbn [fst snd] in *. split; [apply share_times; assumption | apply mul_sound; assumption].
  - unfold stride, sum_of in *. rewrite fold_right_app, l2. cbn [fold_right fst snd]. clear.
    assert (G : forall w, fold_right (fun p s => fst p * snd p + s) w (map (fun n : R * R => (m * fst n, y * snd n)) ns) = m * y * fold_right (fun p s => fst p * snd p + s) 0 ns + w)
      by (intro w; induction ns as [| n ns I]; cbn [map fold_right fst snd]; [ring | rewrite I; ring]).
    rewrite G. ring.
Qed.

Lemma steps_sound : forall params theta0 theta mss, Forall2 (stepped bits) (Tolerances.steps ends params) mss ->
  Forall2 (fun e ms => nth (fst e) theta 0 - nth (fst e) theta0 0 = stride ms) ends mss ->
  exists mss', Forall2 (stepped bits) (steps params) mss' /\ map stride mss' = differences theta0 theta.
Proof.
  intros params theta0 theta mss h d. unfold steps, differences. set (ss := Tolerances.steps ends params) in *.
  assert (E : map (fun e => nth (fst e) theta 0 - nth (fst e) theta0 0) ends = map stride mss).
  { clear h ss. induction d as [| e ms es mss h d IH]; [reflexivity |]. cbn [map]. rewrite h, IH. reflexivity. }
  rewrite E. cbv zeta.
  assert (N : forall p, stepped bits (nth p ss []) (nth p mss [])) by (intro p; clear - h; revert p; induction h as [| s ms ss mss h1 h IH]; intros [| p]; cbn [nth]; auto; constructor).
  assert (D : forall p, nth p (map stride mss) 0 = stride (nth p mss [])) by (intro p; exact (map_nth stride mss [] p)).
  assert (F : forall p, nth p ss [] = [] \/ exists a c, nth p ss [] = snd (start a c)).
  { intro p. unfold ss, Tolerances.steps. destruct (Nat.lt_ge_cases p (length ends)) as [l | l]; [right | left; apply nth_overflow; rewrite map_length; exact l].
    set (f := fun e : nat * choice => snd (start (nth (fst e) params zero) (snd e))). rewrite (nth_indep _ _ (f (O, FromLeast))) by (rewrite map_length; exact l).
    rewrite map_nth. unfold f. eexists _, _. reflexivity. }
  assert (K : forall k, exists ms, stepped bits (product ss k) ms /\ stride ms = difference (map stride mss) k).
  { intros [p q]. unfold product, difference. cbn [fst snd]. rewrite !D. specialize (N p) as hp. destruct (Nat.eqb_spec p q) as [<- | n].
    - destruct (F p) as [e | [a [c e]]]; rewrite e in *.
      + inversion hp. exists []. split; [constructor | unfold stride; cbn; field].
      + destruct (stride_square a c _ hp) as [m [r [h1 [h2 h3]]]]. rewrite h3. destruct (snd (start a c)) as [| s l] eqn:z; [destruct c; discriminate |]. cbn [hd] in h2.
        exists [(m, r * r / 2)]. split; [constructor; [split; [exact h1 | apply halve_sound, mul_sound; exact h2] | constructor] | unfold stride; cbn; field].
    - apply stepped_products; [exact hp | apply N]. }
  assert (G : forall l, exists mss', Forall2 (stepped bits) (map (product ss) l) mss' /\ map stride mss' = map (difference (map stride mss)) l).
  { induction l as [| k l [mss' [h1 h2]]]; [exists []; split; [constructor | reflexivity] |]. destruct (K k) as [ms [k1 k2]]. exists (ms :: mss'). split; [constructor; assumption |]. cbn [map]. rewrite k2, h2. reflexivity. }
  destruct (G pairs) as [mss' [h1 h2]]. exists (mss ++ mss'). split; [apply Forall2_app; assumption |]. rewrite map_app, h2. reflexivity.
Qed.

(** Sums over all two of some places, and over every two. *)
Definition total {A : Type} (l : list A) (f : A -> R) : R := fold_right (fun a s => f a + s) 0 l.
Lemma total_linear : forall (A : Type) (l : list A) k f g, total l (fun a => k * f a + g a) = k * total l f + total l g.
Proof. intros A l k f g. unfold total. induction l as [| a l IH]; cbn [fold_right]; [ring |]. rewrite IH. ring. Qed.
Lemma total_same : forall (A : Type) (l : list A) f g, (forall a, In a l -> f a = g a) -> total l f = total l g.
Proof. intros A l f g h. unfold total. induction l as [| a l IH]; [reflexivity |]. cbn [fold_right]. rewrite (h a) by (left; reflexivity). rewrite IH by (intros; apply h; right; assumption). reflexivity. Qed.
Lemma total_map : forall (A B : Type) (k : A -> B) l f, total (map k l) f = total l (fun a => f (k a)).
Proof. intros A B k l f. unfold total. induction l as [| a l IH]; [reflexivity |]. cbn [map fold_right]. rewrite IH. reflexivity. Qed.
Lemma total_app : forall (A : Type) (l m : list A) f, total (l ++ m) f = total l f + total m f.
Proof. intros A l m f. unfold total. induction l as [| a l IH]; cbn [app fold_right]; [ring |]. rewrite IH. ring. Qed.

Lemma total_pairs : forall (d : nat -> R) (s : nat -> nat -> R), (forall p q, s p q = s q p) -> forall l, NoDup l ->
  / 2 * total l (fun p => d p * total l (fun q => d q * s p q)) = total (pairs_of l) (fun k => (if Nat.eqb (fst k) (snd k) then d (fst k) ^ 2 / 2 else d (fst k) * d (snd k)) * s (fst k) (snd k)).
Proof.
  intros d s sym. induction l as [| p l IH]; intro nd; [unfold total; cbn; ring |]. inversion nd as [| ? ? no nd']; subst. cbn [pairs_of]. rewrite total_app, <- (IH nd'), total_map.
  set (g := fun a => (if Nat.eqb (fst (p, a)) (snd (p, a)) then d (fst (p, a)) ^ 2 / 2 else d (fst (p, a)) * d (snd (p, a))) * s (fst (p, a)) (snd (p, a))).
  set (T := total l (fun q => d q * s p q)). set (W := total l (fun p => d p * total l (fun q => d q * s p q))).
  change (total (p :: l) g) with (g p + total l g). assert (Gp : g p = d p ^ 2 / 2 * s p p) by (unfold g; cbn [fst snd]; rewrite Nat.eqb_refl; reflexivity).
  assert (Gl : total l g = d p * T).
  { unfold T. rewrite <- (Rplus_0_r (d p * total l (fun q => d q * s p q))). replace 0 with (total l (fun _ => 0)) by (clear; unfold total; induction l as [| a l I]; cbn [fold_right]; [| rewrite I]; ring).
    rewrite <- total_linear. apply total_same. intros q i. unfold g. cbn [fst snd]. destruct (Nat.eqb_spec p q) as [<- |]; [contradiction | ring]. }
  rewrite Gp, Gl. change (total (p :: l) (fun p0 => d p0 * total (p :: l) (fun q => d q * s p0 q))) with (d p * (d p * s p p + T) + total l (fun p0 => d p0 * (d p * s p0 p + total l (fun q => d q * s p0 q)))).
  rewrite (total_same _ l _ (fun p0 => d p * (d p0 * s p p0) + d p0 * total l (fun q => d q * s p0 q))) by (intros q _; rewrite (sym q p); ring).
  rewrite total_linear. fold T W. field.
Qed.

Lemma as_seq : forall (A : Type) (a : A) l, map (fun p => nth p l a) (seq 0 (length l)) = l.
Proof.
  intros A a l. assert (G : forall b, map (fun p => nth p (b ++ l) a) (seq (length b) (length l)) = l); [| exact (G [])].
  induction l as [| y l IH]; intro b; [reflexivity |]. cbn [length seq map]. f_equal.
  - rewrite app_nth2, Nat.sub_diag by lia. reflexivity.
  - specialize (IH (b ++ [y])). rewrite app_length, Nat.add_1_r, <- app_assoc in IH. exact IH.
Qed.
Lemma filter_mapped : forall (A B : Type) (p : B -> bool) (g : A -> B) l, filter p (map g l) = map g (filter (fun a => p (g a)) l).
Proof. intros A B p g l. induction l as [| a l IH]; [reflexivity |]. cbn [map filter]. destruct (p (g a)); cbn [map]; rewrite IH; reflexivity. Qed.
Lemma dot_mapped : forall (A : Type) (f g : A -> R) l, dot (map f l) (map g l) = total l (fun a => f a * g a).
Proof. intros A f g l. unfold total. induction l as [| a l IH]; [reflexivity |]. cbn [map dot fold_right]. rewrite IH. reflexivity. Qed.
Lemma dot_app : forall a b c e, length a = length b -> dot (a ++ c) (b ++ e) = dot a b + dot c e.
Proof. induction a as [| y a IH]; intros [| z b] c e l; try discriminate; cbn [app dot]; [ring |]. rewrite IH by (cbn in l; congruence). ring. Qed.

Lemma all_known_sound : forall lambda l vs, Forall2 (fun r (v : R * R) => Tolerances.rate_is bits lambda r (fst v) (snd v)) l vs -> forall ss, all_known l = Some ss ->
  exists es, Forall2 (entry_in bits) ss es /\ map (at_lambda lambda) es = map snd vs.
Proof.
  intros lambda. induction 1 as [| r [a b] l vs h hs IH]; intros ss k; cbn [all_known] in k; [injection k as <-; exists []; split; [constructor | reflexivity] |]. cbn [fst snd] in h.
  destruct (match r with None => _ | Some r => r end) as [s |] eqn:er; [| discriminate]. destruct (all_known l) as [ss' |]; [| discriminate]. injection k as <-.
  destruct (IH ss' eq_refl) as [es [k1 k2]].
  assert (X : exists e, entry_in bits s e /\ at_lambda lambda e = b).
  { destruct r as [[t |] |]; cbn [Tolerances.rate_is] in h; [| discriminate |].
    - injection er as <-. destruct h as [h1 [h2 [u [h3 h4]]]]. exists (a, u). split; [split; assumption |]. unfold at_lambda. cbn [fst snd]. lra.
    - injection er as <-. destruct h as [_ ->]. exists (0, []). split; [split; [apply zero_sound | constructor] | unfold at_lambda; cbn; ring]. }
  destruct X as [e [x1 x2]]. exists (e :: es). split; [constructor; assumption |]. cbn [map snd]. rewrite x2, k2. reflexivity.
Qed.

(** The value of a formula at another machine. *)
Theorem second_sound : forall lambda x cs params theta0 theta f one all s rs, NoDup (map fst ends) -> Forall2 contains params theta0 -> Forall2 contains params theta ->
  (forall th, Forall2 contains params th -> defined x th f) -> (forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0) ->
  encloses_rates bits (of_the_one params) lambda x cs theta0 one f -> (forall th, Forall2 contains params th -> encloses_seconds (map fst ends) pairs lambda x cs th all f) ->
  fst one = Some s -> rates_of one all = Some rs ->
  exists e, multi_in bits (s, rs) e /\ value x theta f = at_lambda lambda (moved (fst e) (differences theta0 theta) (snd e)).
Proof.
  intros lambda x cs params th0 th f one all s rs nd h0 h1 df same [V One] All e1 er.
  destruct (second_mean_value (map fst ends) curved x params th0 th f nd h0 h1 df same) as [t [t' [ht [ht' E]]]]. cbv zeta in E.
  rewrite e1 in V. destruct V as [_ [_ [m1 [_ [u [m2 m3]]]]]].
  set (js := map fst ends) in *. set (d := fun j => nth j th 0 - nth j th0 0).
  set (first := fun z j => if is_in j curved then rate z th0 j f else rate z t j f).
  set (second := fun z p q => second_rate z t' (nth p js O) (nth q js O) f).
  assert (F : Forall2 (fun r (v : R * R) => Tolerances.rate_is bits lambda r (fst v) (snd v))
    (map (fun p => rate_at (if is_in (parameter_at p) curved then one else fst all) p) (seq 0 (length ends)) ++ map (fun k => nth k (snd all) unknown) (seq 0 (length pairs)))
    (map (fun p => (first cs (nth p js O), first x (nth p js O))) (seq 0 (length ends)) ++
     map (fun k => let (p, q) := nth k pairs (O, O) in (second cs p q, second x p q)) (seq 0 (length pairs)))).
  { apply Forall2_app.
    - assert (L : forall l, (forall p, In p l -> (p < length ends)%nat) -> Forall2 (fun r (v : R * R) => Tolerances.rate_is bits lambda r (fst v) (snd v))
        (map (fun p => rate_at (if is_in (parameter_at p) curved then one else fst all) p) l) (map (fun p => (first cs (nth p js O), first x (nth p js O))) l)).
      { induction l as [| p l IH]; intro b; cbn [map]; constructor; [| apply IH; intros; apply b; right; assumption]. cbn [fst snd]. unfold first, parameter_at. fold js.
        destruct (is_in (nth p js O) curved) eqn:e; [| exact (proj2 (proj1 (All t ht)) p)]. specialize (One p). unfold of_the_one in One.
        set (g := fun e0 : nat * choice => if is_in (fst e0) curved then fst e0 else length params) in One.
        assert (G : nth p (map g ends) O = nth p js O); [| rewrite G in One; exact One].
        specialize (b p (or_introl eq_refl)). unfold js in e |- *. rewrite (nth_indep _ O (g (O, FromLeast))) by (rewrite map_length; exact b).
        rewrite (nth_indep _ O (fst (O, FromLeast))) in e |- * by (rewrite map_length; exact b). rewrite !map_nth in *. unfold g. rewrite e. reflexivity. }
      apply L. intros p i. apply in_seq in i. lia.
    - generalize (seq 0 (length pairs)). induction l as [| k l IH]; cbn [map]; constructor; [| exact IH]. pose proof (proj2 (All t' ht') k) as K. unfold second_is in K. fold js in K.
      destruct (nth k pairs (O, O)) as [p q]. exact K. }
  destruct (all_known_sound lambda _ _ F rs er) as [es [k1 k2]]. exists ((value cs th0 f, u), es). split; [split; [split; assumption | exact k1] |].
  cbn [fst snd]. rewrite at_moved, k2, map_app, !map_map. cbn [snd]. unfold differences.
  assert (X1 : map (fun p => first x (nth p js O)) (seq 0 (length ends)) = map (fun e => first x (fst e)) ends).
  { rewrite <- (map_map (fun p => nth p js O) (first x)), <- (map_map fst (first x)). f_equal. replace (length ends) with (length js) by apply map_length. apply as_seq. }
  assert (X2 : map (fun k => snd (let (p, q) := nth k pairs (O, O) in (second cs p q, second x p q))) (seq 0 (length pairs)) = map (fun k => second x (fst k) (snd k)) pairs).
  { rewrite <- (as_seq _ (O, O) pairs) at 2. rewrite map_map. apply map_ext. intro k. destruct (nth k pairs (O, O)); reflexivity. }
  cbn [snd] in *. rewrite X1, X2, dot_app by (rewrite !map_length; reflexivity). fold d. clear X1 X2. set (ds := map (fun e => nth (fst e) th 0 - nth (fst e) th0 0) ends).
  assert (Ds : forall p, (p < length ends)%nat -> nth p ds 0 = d (nth p js O)).
  { intros p l. unfold ds, js. change (fun e : nat * choice => nth (fst e) th 0 - nth (fst e) th0 0) with (fun e : nat * choice => d (fst e)). rewrite (nth_indep _ 0 (d (fst (O, FromLeast)))) by (rewrite map_length; exact l).
    rewrite (nth_indep _ O (fst (O, FromLeast))) by (rewrite map_length; exact l). rewrite (map_nth (fun e : nat * choice => d (fst e))), map_nth. reflexivity. }
  unfold ds at 1. rewrite !dot_mapped. rewrite E.
  assert (A0 : value x th0 f = at_lambda lambda (value cs th0 f, u)) by (unfold at_lambda; cbn [fst snd]; lra). rewrite A0, Rplus_assoc. f_equal. f_equal.
  - unfold js. rewrite sum_mapped. apply total_same. intros e _. unfold first, d. destruct (is_in (fst e) curved); reflexivity.
  - set (own := filter (fun p => is_in (parameter_at p) curved) (seq 0 (length ends))).
    assert (O : filter (fun j => is_in j curved) js = map (fun p => nth p js O) own).
    { symmetry. unfold own. replace (length ends) with (length js) by apply map_length.
      exact (eq_trans (eq_sym (filter_mapped _ _ (fun j => is_in j curved) (fun p => nth p js 0%nat) _)) (f_equal _ (as_seq nat 0%nat js))). }
    rewrite O. unfold pairs. fold own.
    assert (S : forall f0, sum_over (map (fun p => nth p js 0%nat) own) f0 = total own (fun p => f0 (nth p js 0%nat))) by (intro; apply sum_mapped).
    rewrite S. rewrite (total_same _ own _ (fun p => d (nth p js 0%nat) * total own (fun q => d (nth q js 0%nat) * second x p q))) by (intros p _; rewrite S; reflexivity).
    rewrite (total_pairs (fun p => d (nth p js 0%nat)) (second x)); [| intros; apply second_symmetric, df, ht' | apply NoDup_filter, seq_NoDup].
    assert (I : forall l, (forall p, In p l -> (p < length ends)%nat) -> forall k, In k (pairs_of l) -> (fst k < length ends)%nat /\ (snd k < length ends)%nat).
    { induction l as [| p l IH]; intros b k i; [contradiction |]. cbn [pairs_of] in i. apply in_app_or in i as [i | i].
      - apply in_map_iff in i as [q [<- i]]. split; apply b; [left; reflexivity | exact i].
      - apply IH; [| exact i]. intros q iq. apply b. right. exact iq. }
    apply total_same. intros k i. destruct (I own ltac:(intros p ip; apply filter_In in ip as [ip _]; apply in_seq in ip; lia) k i) as [l1 l2]. unfold difference. rewrite !Ds by assumption. reflexivity.
Qed.
End Ends.

Lemma none_of_second_order : forall ends theta0 theta, differences ends [] theta0 theta = map (fun e => nth (fst e) theta 0 - nth (fst e) theta0 0) ends.
Proof. intros. unfold differences, pairs. rewrite none_moved_first. apply app_nil_r. Qed.
End Precision.
