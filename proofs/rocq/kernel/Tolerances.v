(** * Tolerances taken apart: one machine, and how all others differ from it

    A formula of another machine differs by its derivatives, each times what its parameter differs by: the same for
    all formulas, while the machine at which derivatives are taken may be another for each ([apart]).  Derivatives
    are enclosed as the tape is run, beside values. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require MeanValue.
From Orthocert Require Import Fixed Velocity.
From Orthocert.kernel Require Import Elbow Formula Linear Arithmetic Slope Definite Test Cell Acceleration.
From Orthocert.kernel Require Solve.
Import ListNotations.
Local Open Scope R_scope.

(** ** Derivatives by parameter [j] *)

Fixpoint rate (x theta : list R) (j : nat) (e : formula) : R :=
  match e with F o =>
    match o with
    | Coord _ | Integer _ => 0
    | Param i => if Nat.eqb i j then 1 else 0
    | Add a b => rate x theta j a + rate x theta j b
    | Sub a b => rate x theta j a + - rate x theta j b
    | Neg a => - rate x theta j a
    | Mul a b => value x theta b * rate x theta j a + value x theta a * rate x theta j b
    | Div a b => (rate x theta j a + - (value x theta a / value x theta b) * rate x theta j b) / value x theta b
    | Sqr a => 2 * value x theta a * rate x theta j a
    | Sqrt a => rate x theta j a / (2 * sqrt (value x theta a))
    | Elbow second a b t =>
        let (c, s) := elbow (value x theta a) (value x theta b) (value x theta t) in
        (if second then c else - s) * (2 * ((value x theta a - c) * rate x theta j a + (value x theta b - s) * rate x theta j b) + - rate x theta j t) /
          (2 * (value x theta b * c - value x theta a * s))
    end
  end.

Definition sum_over (l : list nat) (f : nat -> R) : R := fold_right (fun j s => f j + s) 0 l.
Lemma sum_linear : forall l p q f g, sum_over l (fun j => p * f j + q * g j) = p * sum_over l f + q * sum_over l g.
Proof. intros l p q f g. induction l as [| j l IH]; cbn [sum_over fold_right] in *; [ring |]. unfold sum_over in IH. rewrite IH. ring. Qed.
Lemma sum_ext : forall l f g, (forall j, f j = g j) -> sum_over l f = sum_over l g.
Proof. intros l f g h. induction l as [| j l IH]; cbn [sum_over fold_right] in *; [reflexivity |]. unfold sum_over in IH. rewrite IH, h. reflexivity. Qed.

Section Moving.
Variables (by_ : list nat) (x : list R) (theta : R -> list R) (t : R) (speed : nat -> R).
Hypothesis once : NoDup by_.
Hypothesis moves : forall j, derivable_pt_lim (fun u => nth j (theta u) 0) t (speed j).
Hypothesis others_stay : forall j, ~ In j by_ -> speed j = 0.
Local Notation val := (value x (theta t)).
Let total (e : formula) : R := sum_over by_ (fun j => speed j * rate x (theta t) j e).

Lemma total_is : forall e p q a b, (forall j, rate x (theta t) j e = p * rate x (theta t) j a + q * rate x (theta t) j b) ->
  total e = p * total a + q * total b.
Proof.
  intros e p q a b h. unfold total. rewrite <- sum_linear. apply sum_ext. intro j. rewrite h. ring.
Qed.

Lemma total_param : forall i, total (F (Param i)) = speed i.
Proof.
  intro i. unfold total. cbn [rate]. destruct (in_dec Nat.eq_dec i by_) as [h | n].
  - clear others_stay total moves. revert h. induction once as [| j l no once' IH]; intro h; [contradiction |]. cbn [sum_over fold_right].
    assert (Z : forall k, ~ In i k -> sum_over k (fun j => speed j * (if Nat.eqb i j then 1 else 0)) = 0).
    { induction k as [| a k I]; intro n; [reflexivity |]. cbn [sum_over fold_right]. unfold sum_over in I. rewrite I by (intro; apply n; right; assumption).
      destruct (Nat.eqb_spec i a) as [-> |]; [exfalso; apply n; left; reflexivity | ring]. }
    destruct (Nat.eqb_spec i j) as [<- | n].
    + unfold sum_over in Z. rewrite (Z l no). ring.
    + unfold sum_over in IH. rewrite IH by (destruct h as [-> |]; [contradiction | assumption]). ring.
  - rewrite (others_stay i n). clear moves others_stay total once. induction by_ as [| a k I]; [reflexivity |]. cbn [sum_over fold_right]. unfold sum_over in I.
    rewrite I by (intro; apply n; right; assumption). destruct (Nat.eqb_spec i a) as [-> |]; [exfalso; apply n; left; reflexivity | ring].
Qed.

Theorem total_sound : forall e, defined x (theta t) e -> derivable_pt_lim (fun u => value x (theta u) e) t (total e).
Proof.
  fix IH 1. intros [o] d. destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | second a b e]; cbn [defined map_op defined_op all_op] in d.
  - apply (derivable_eq _ _ _ _ _ (derivable_const (nth k x 0) t)); [reflexivity |]. rewrite (total_is _ 0 0 (integer 0) (integer 0)); [ring | intro; cbn; ring].
  - rewrite total_param. apply moves.
  - apply (derivable_eq _ _ _ _ _ (derivable_const (IZR n) t)); [reflexivity |]. rewrite (total_is _ 0 0 (integer 0) (integer 0)); [ring | intro; cbn; ring].
  - destruct d as [_ [da db]]. eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (IH a da) (IH b db)) | reflexivity |].
    rewrite (total_is _ 1 1 a b); [ring | intro; cbn [rate]; ring].
  - destruct d as [_ [da db]]. eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (IH a da) (derivable_scal (-1) _ _ _ (IH b db))) | intro; cbn [value map_op real_op]; ring |].
    rewrite (total_is _ 1 (-1) a b); [ring | intro; cbn [rate]; ring].
  - destruct d as [_ da]. eapply derivable_eq; [exact (derivable_scal (-1) _ _ _ (IH a da)) | intro; cbn [value map_op real_op]; ring |].
    rewrite (total_is _ (-1) 0 a a); [ring | intro; cbn [rate]; ring].
  - destruct d as [_ [da db]]. eapply derivable_eq; [exact (derivable_times _ _ _ _ _ (IH a da) (IH b db)) | reflexivity |].
    cbv beta. rewrite (total_is _ (val b) (val a) a b); [ring | intro; reflexivity].
  - destruct d as [b0 [da db]]. eapply derivable_eq; [exact (derivable_pt_lim_div _ _ t _ _ (IH a da) (IH b db) b0) | reflexivity |].
    rewrite (total_is _ (/ val b) (- (val a / val b) / val b) a b); [unfold Rsqr; field; exact b0 | intro; cbn [rate]; field; exact b0].
  - destruct d as [_ da]. eapply derivable_eq; [exact (derivable_square _ _ _ (IH a da)) | reflexivity |].
    cbv beta. rewrite (total_is _ (2 * val a) 0 a a); [ring | intro; cbn [rate]; ring].
  - destruct d as [a0 da]. pose proof (sqrt_lt_R0 _ a0) as s0.
    eapply derivable_eq; [exact (derivable_pt_lim_comp _ sqrt t _ _ (IH a da) (derivable_pt_lim_sqrt _ a0)) | reflexivity |].
    rewrite (total_is _ (/ (2 * sqrt (val a))) 0 a a); [ring | intro; cbn [rate]; unfold Rdiv; ring].
  - destruct d as [r [da [db de]]]. pose proof (elbow_rates _ _ _ t _ _ _ (IH a da) (IH b db) (IH e de) r) as R. cbv zeta in R.
    destruct (elbow (val a) (val b) (val e)) as [c s] eqn:E. destruct R as [h0 [Rc Rs]].
    set (w := (if second then c else - s) / (2 * (val b * c - val a * s))).
    assert (T : total (F (Elbow second a b e)) = w * (2 * ((val a - c) * total a + (val b - s) * total b) + - total e)).
    { unfold total. replace (w * (2 * ((val a - c) * sum_over by_ (fun j => speed j * rate x (theta t) j a) + (val b - s) * sum_over by_ (fun j => speed j * rate x (theta t) j b)) + - sum_over by_ (fun j => speed j * rate x (theta t) j e)))
        with (1 * (2 * w * (val a - c) * sum_over by_ (fun j => speed j * rate x (theta t) j a) + 2 * w * (val b - s) * sum_over by_ (fun j => speed j * rate x (theta t) j b)) + - w * sum_over by_ (fun j => speed j * rate x (theta t) j e)) by ring.
      rewrite <- !sum_linear. apply sum_ext. intro j. cbn [rate]. rewrite E. unfold w. field. lra. }
    rewrite T. destruct second; [eapply derivable_eq; [exact Rs | reflexivity |] | eapply derivable_eq; [exact Rc | reflexivity |]]; unfold w; field; lra.
Qed.
End Moving.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

(** ** From one machine to another *)

Lemma contains_between : forall a y z u, contains a y -> contains a z -> 0 <= u <= 1 -> contains a ((1 - u) * y + u * z).
Proof. intros a y z u [l1 h1] [l2 h2] [u0 u1]. unfold Fixed.contains. split; nra. Qed.

Definition towards (u : R) (a b : list R) : list R := comb (1 - u) u a b.
Lemma towards_nth : forall u a b j, nth j (towards u a b) 0 = (1 - u) * nth j a 0 + u * nth j b 0.
Proof.
  intros u a b j. unfold towards, comb.
  assert (M : forall k l i, nth i (map (Rmult k) l) 0 = k * nth i l 0) by (intros k l i; rewrite <- (Rmult_0_r k) at 1; apply (map_nth (Rmult k))).
  revert b j. induction a as [| y a IH]; intros [| z b] [| j]; cbn [merge nth map]; rewrite ?M, ?IH; cbn [nth]; ring.
Qed.
Lemma towards_in : forall u params a b, 0 <= u <= 1 -> Forall2 contains params a -> Forall2 contains params b -> Forall2 contains params (towards u a b).
Proof.
  intros u params a b hu h. revert b. induction h as [| p y params a hp h IH]; intros b k; inversion k; subst; cbn [towards comb merge map]; constructor.
  - apply contains_between; assumption.
  - apply IH; assumption.
Qed.

Theorem mean_value : forall by_ x params theta0 theta f, NoDup by_ -> Forall2 contains params theta0 -> Forall2 contains params theta ->
  (forall th, Forall2 contains params th -> defined x th f) -> (forall j, ~ In j by_ -> nth j theta0 0 = nth j theta 0) ->
  exists th, Forall2 contains params th /\
    value x theta f = value x theta0 f + sum_over by_ (fun j => (nth j theta 0 - nth j theta0 0) * rate x th j f).
Proof.
  intros by_ x params th0 th f once h0 h1 d same.
  assert (H : forall u, 0 <= u <= 1 -> derivable_pt_lim (fun u => value x (towards u th0 th) f) u
    (sum_over by_ (fun j => (nth j th 0 - nth j th0 0) * rate x (towards u th0 th) j f))).
  { intros u hu. apply (total_sound by_ x (fun u => towards u th0 th) u (fun j => nth j th 0 - nth j th0 0) once).
    - intro j. apply derivable_eq with (fun u => (nth j th 0 - nth j th0 0) * u + nth j th0 0) ((nth j th 0 - nth j th0 0) * 1 + 0).
      + apply derivable_add; [apply derivable_scal, derivable_pt_lim_id | apply derivable_const].
      + intro v. rewrite towards_nth. ring.
      + ring.
    - intros j n. rewrite (same j n). ring.
    - apply d, towards_in; assumption. }
  destruct (MeanValue.mean_value_theorem _ _ 0 1 Rlt_0_1 H) as [u [E hu]]. exists (towards u th0 th). split; [apply towards_in; [lra | assumption ..] |].
  assert (E0 : towards 0 th0 th = th0 /\ towards 1 th0 th = th).
  { pose proof (related_length _ _ _ _ _ h0) as l0. pose proof (related_length _ _ _ _ _ h1) as l1. rewrite l0 in l1. clear - l1. revert th l1.
    induction th0 as [| y a IH]; intros [| z b] l; try discriminate; [split; reflexivity |]. cbn [length] in l. destruct (IH b ltac:(congruence)) as [I J].
    unfold towards, comb in *. cbn [merge]. rewrite I, J. split; f_equal; ring. }
  destruct E0 as [E0 E1]. cbv beta in E. rewrite E0, E1 in E. lra.
Qed.

(** ** Values with derivatives: [None] is 0, [Some None] not known; as many as there are parameters in [by_] *)

Definition partial_rate : Type := option (option slope).
Definition dual : Type := option slope * list partial_rate.

Section Run.
Variables (coords params : list slope) (by_ : list nat).

Definition r_neg (r : partial_rate) : partial_rate := option_map (option_map s_neg) r.
Definition r_mul (p : slope) (r : partial_rate) : partial_rate := option_map (option_map (s_mul bits p)) r.
Definition r_div (q : slope) (r : partial_rate) : partial_rate := option_map (lift (fun s => s_div bits s q)) r.
Definition r_add (r s : partial_rate) : partial_rate :=
  match r, s with None, s => s | r, None => r | Some a, Some b => Some (lift2 (fun a b => Some (s_add a b)) a b) end.
Definition r_sum (l m : list partial_rate) : list partial_rate := map (fun p => r_add (fst p) (snd p)) (combine l m).

Definition two : slope := constant (Fixed.integer bits 2).
Definition still : list partial_rate := map (fun _ => None) by_.
Definition rates (o : op dual) (result : option slope) : list partial_rate :=
  match o with
  | Coord _ | Integer _ => still
  | Param i => map (fun j => if Nat.eqb i j then Some (Some (constant (Fixed.integer bits 1))) else None) by_
  | Add a b => r_sum (snd a) (snd b)
  | Sub a b => r_sum (snd a) (map r_neg (snd b))
  | Neg a => map r_neg (snd a)
  | Mul a b => match fst a, fst b with Some f, Some g => r_sum (map (r_mul g) (snd a)) (map (r_mul f) (snd b)) | _, _ => [] end
  | Div a b => match result, fst b with Some q, Some g => map (r_div g) (r_sum (snd a) (map (r_mul (s_neg q)) (snd b))) | _, _ => [] end
  | Sqr a => match fst a with Some f => map (r_mul (s_mul bits two f)) (snd a) | None => [] end
  | Sqrt a => match result with Some f => map (r_div (s_mul bits two f)) (snd a) | None => [] end
  | Elbow second a b t =>
      match fst a, fst b, fst t with
      | Some f, Some g, Some h =>
          match s_elbow bits f g h with
          | Some (c, s) =>
              let along := r_sum (map (r_mul (s_sub f c)) (snd a)) (map (r_mul (s_sub g s)) (snd b)) in
              let n := map (r_mul (if second then c else s_neg s)) (r_sum (map (r_mul two) along) (map r_neg (snd t))) in
              map (r_div (s_mul bits two (s_sub (s_mul bits g c) (s_mul bits f s)))) n
          | None => []
          end
      | _, _, _ => []
      end
  end.
Definition dual_op (o : op dual) : dual := let result := slope_op bits coords params (map_op fst o) in (result, rates o result).

Section Sound.
Variables (lambda xs cs theta : list R).
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.
Let none := constant zero.
Hypothesis coords_hold : forall k, holds bits lambda (nth k coords none) (nth k cs 0) (nth k xs 0).
Hypothesis params_hold : forall j, holds bits lambda (nth j params none) (nth j theta 0) (nth j theta 0).

Definition rate_is (r : partial_rate) (a b : R) : Prop :=
  match r with None => a = 0 /\ b = 0 | Some None => True | Some (Some s) => holds bits lambda s a b end.
Definition encloses_rates (d : dual) (e : formula) : Prop :=
  encloses bits lambda xs cs theta (fst d) e /\
  forall p, rate_is (nth p (snd d) (Some None)) (rate cs theta (nth p by_ O) e) (rate xs theta (nth p by_ O) e).

Lemma rate_neg : forall r a b, rate_is r a b -> rate_is (r_neg r) (- a) (- b).
Proof. intros [[s |] |] a b h; cbn [r_neg option_map rate_is] in *; [apply (s_neg_holds bits lambda), h | exact I | destruct h; subst; split; ring]. Qed.
Lemma rate_mul : forall p c v r a b, holds bits lambda p c v -> rate_is r a b -> rate_is (r_mul p r) (c * a) (v * b).
Proof. intros p c v [[s |] |] a b hp h; cbn [r_mul option_map rate_is] in *; [apply s_mul_holds; assumption | exact I | destruct h; subst; split; ring]. Qed.
Lemma rate_div : forall q c v r a b, holds bits lambda q c v -> rate_is r a b -> rate_is (r_div q r) (a / c) (b / v).
Proof.
  intros q c v [[s |] |] a b hq h; cbn [r_div option_map lift rate_is] in *; [| exact I | destruct h; subst; unfold Rdiv; split; ring].
  destruct (s_div bits s q) as [d |] eqn:e; [| exact I]. exact (proj2 (proj2 (s_div_holds bits lambda lambda_in _ _ _ _ _ _ _ e h hq))).
Qed.
Lemma rate_add : forall r s a b c d, rate_is r a b -> rate_is s c d -> rate_is (r_add r s) (a + c) (b + d).
Proof.
  intros [[r |] |] [[s |] |] a b c d h k; cbn [r_add lift2 rate_is] in *; try exact I.
  - apply (s_add_holds bits lambda lambda_in); assumption.
  - destruct k as [-> ->]. rewrite !Rplus_0_r. exact h.
  - destruct h as [-> ->]. rewrite !Rplus_0_l. exact k.
  - destruct h as [-> ->], k as [-> ->]. split; ring.
Qed.
Lemma nth_map : forall (f : partial_rate -> partial_rate) l p, f (Some None) = Some None -> nth p (map f l) (Some None) = f (nth p l (Some None)).
Proof. intros f l p e. rewrite <- e at 1. apply map_nth. Qed.
Lemma nth_sum : forall l m p a b c d, rate_is (nth p l (Some None)) a b -> rate_is (nth p m (Some None)) c d -> rate_is (nth p (r_sum l m) (Some None)) (a + c) (b + d).
Proof.
  unfold r_sum. induction l as [| r l IH]; intros [| s m] [| p] a b c d h k; cbn [combine map nth] in *; try exact I; [apply rate_add; assumption | apply IH; assumption].
Qed.
Lemma still_zero : forall p, rate_is (nth p still (Some None)) 0 0.
Proof. unfold still. induction by_ as [| j l IH]; intros [| p]; cbn; auto. Qed.

Lemma two_holds : holds bits lambda two 2 2.
Proof. apply constant_holds, integer_sound. Qed.

Lemma dual_op_sound : forall (o : op address) f g, (forall i, encloses_rates (f i) (g i)) -> encloses_rates (dual_op (map_op f o)) (F (map_op g o)).
Proof.
  intros o f g h.
  assert (V : encloses bits lambda xs cs theta (slope_op bits coords params (map_op fst (map_op f o))) (F (map_op g o))).
  { replace (map_op fst (map_op f o)) with (map_op (fun i => fst (f i)) o) by (destruct o; reflexivity).
    apply slope_op_sound; try assumption. intro i. exact (proj1 (h i)). }
  split; [exact V |]. intro p. unfold dual_op. cbn [snd]. pose proof (fun i => proj2 (h i) p) as D.
  assert (W : forall i s, fst (f i) = Some s -> holds bits lambda s (value cs theta (g i)) (value xs theta (g i)))
    by (intros i s e; pose proof (proj1 (h i)) as E; rewrite e in E; apply E).
  destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [map_op rates snd fst].
  - apply still_zero.
  - cbn [rate]. clear. revert p. induction by_ as [| i l IH]; intros [| p]; cbn [map nth]; try exact I; [| apply IH].
    destruct (Nat.eqb j i); [apply constant_holds, integer_sound | split; reflexivity].
  - apply still_zero.
  - apply nth_sum; apply D.
  - apply nth_sum; [apply D |]. rewrite nth_map by reflexivity. apply rate_neg, D.
  - rewrite nth_map by reflexivity. apply rate_neg, D.
  - destruct (fst (f a)) as [s |] eqn:ea; [| destruct p; exact I]. destruct (fst (f b)) as [t |] eqn:eb; [| destruct p; exact I].
    cbn [rate]. apply nth_sum; rewrite nth_map by reflexivity; apply rate_mul; auto.
  - cbn [map_op] in V. destruct (slope_op bits coords params (Div (fst (f a)) (fst (f b)))) as [q |] eqn:eq; [| destruct p; exact I].
    destruct (fst (f b)) as [t |] eqn:eb; [| destruct p; exact I]. destruct V as [_ [_ hq]]. cbn [value map_op real_op] in hq.
    cbn [rate]. rewrite nth_map by reflexivity. apply rate_div; [auto |]. apply nth_sum; [apply D |].
    rewrite nth_map by reflexivity. apply rate_mul; [apply s_neg_holds, hq | apply D].
  - destruct (fst (f a)) as [s |] eqn:ea; [| destruct p; exact I]. cbn [rate]. rewrite nth_map by reflexivity.
    apply rate_mul; [apply s_mul_holds; [exact lambda_in | exact two_holds | auto] | apply D].
  - cbn [map_op] in V. destruct (slope_op bits coords params (Sqrt (fst (f a)))) as [q |] eqn:eq; [| destruct p; exact I]. destruct V as [_ [_ hq]]. cbn [value map_op real_op] in hq.
    cbn [rate]. rewrite nth_map by reflexivity. apply rate_div; [apply s_mul_holds; [exact lambda_in | exact two_holds | exact hq] | apply D].
  - destruct (fst (f a)) as [sa |] eqn:ea; [| destruct p; exact I]. destruct (fst (f b)) as [sb |] eqn:eb; [| destruct p; exact I].
    destruct (fst (f t)) as [st |] eqn:et; [| destruct p; exact I]. apply W in ea, eb, et.
    destruct (s_elbow bits sa sb st) as [[c s] |] eqn:E; [| destruct p; exact I].
    destruct (s_elbow_holds bits lambda lambda_in _ _ _ _ _ _ _ _ _ _ E ea eb et) as [_ [_ [hc hs]]]. cbn [rate fst snd] in *.
    destruct (elbow (value cs theta (g a)) _ _) as [cc sc], (elbow (value xs theta (g a)) _ _) as [cx sx]. cbn [fst snd] in *.
    rewrite nth_map by reflexivity. apply rate_div.
    + repeat (apply s_mul_holds || apply s_sub_holds); auto using two_holds.
    + rewrite nth_map by reflexivity. apply rate_mul; [destruct second; [exact hc | apply s_neg_holds, hs] |].
      apply nth_sum; [| rewrite nth_map by reflexivity; apply rate_neg, D]. rewrite nth_map by reflexivity. apply rate_mul; [exact two_holds |].
      apply nth_sum; rewrite nth_map by reflexivity; apply rate_mul; auto; apply s_sub_holds; auto.
Qed.

Theorem duals_sound : forall keep tape, Forall2 encloses_rates (run_kept dual (None, []) dual_op keep tape) (formulas tape).
Proof.
  assert (never : forall f, encloses_rates (None, []) f) by (intro f; split; [exact I | intros [| p]; exact I]).
  intros keep tape. apply (run_kept_related dual formula (None, []) (integer 0) dual_op F encloses_rates); [apply never | exact dual_op_sound | exact never].
Qed.
End Sound.
End Run.
(** ** Matrices less what tolerances change: T - p p^T/(2 tau), p = tau s - e, for changes m (e s^T + s e^T), 0 <= m <= 1 *)

Fixpoint real_square (h : R) (p : list R) : list (list R) :=
  match p with [] => [] | a :: p' => map (Rmult (- (h * a))) p :: real_square h p' end.
Lemma quad_square : forall h p v, quad (real_square h p) v = - h * dot p v ^ 2.
Proof.
  intros h. induction p as [| a p IH]; intros [| t w]; cbn [real_square quad map row_form dot]; try ring.
  rewrite IH, dot_map. ring.
Qed.
Fixpoint square_of (half : fixed) (p : list fixed) : triangle :=
  match p with [] => [] | a :: p' => map (fun b => neg (mul bits (mul bits half a) b)) p :: square_of half p' end.
Lemma square_of_sound : forall half h p P, contains half h -> Forall2 contains p P -> triangle_in bits (square_of half p) (real_square h P).
Proof.
  intros half h p P hh k. induction k as [| a x p P ha k IH]; cbn [square_of real_square]; constructor; [| exact IH].
  eapply map_related; [| constructor; eassumption]. intros b y hb. rewrite Ropp_mult_distr_l_reverse. apply neg_sound, mul_sound; [apply mul_sound; assumption | exact hb].
Qed.

Definition is_null (x : list fixed) : bool := forallb (fun a => (lo a =? 0)%Z && (hi a =? 0)%Z) x.
Lemma null_sound : forall x y, is_null x = true -> Forall2 contains x y -> forall v, dot y v = 0.
Proof.
  intros x y h k. induction k as [| a t x y ha k IH]; intros [| u v]; cbn [dot]; try reflexivity. cbn [is_null forallb] in h.
  apply andb_true_iff in h as [h1 h2]. apply andb_true_iff in h1 as [l g]. apply Z.eqb_eq in l, g. rewrite (IH h2).
  destruct ha as [hl hg]. rewrite l in hl. rewrite g in hg. pose proof (unit_R_pos bits). assert (t = 0) by nra. subst t. ring.
Qed.

(** |x . w| and the absolute values of x. *)
Definition along (x w : list fixed) : fixed := fold_right (fun p s => add (mul bits (fst p) (snd p)) s) zero (combine x w).
Definition size (w x : list fixed) : Z := fold_right (fun a n => (magnitude a + n)%Z) (magnitude (along x w)) x.
Definition one : fixed := Fixed.integer bits 1.

Definition less_change (w e s : list fixed) (t : triangle) : option triangle :=
  if is_null e || is_null s then Some t
  else
    let n := size w s in
    let tau := lo (Arithmetic.ratio (Fixed (size w e) (size w e)) one (Fixed n n)) in
    if (0 <? n)%Z && (0 <? tau)%Z then
      let half := halve (recip_positive bits (Fixed tau tau)) in
      Some (triangle_add t (square_of half (merge (mul bits (Fixed tau tau)) neg (fun a b => sub (mul bits (Fixed tau tau) a) b) s e)))
    else None.
Fixpoint less_changes (w e : list fixed) (ss : list (list fixed)) (t : triangle) : option triangle :=
  match ss with [] => Some t | s :: ss' => match less_change w e s t with Some t' => less_changes w e ss' t' | None => None end end.

Definition sum_of {A : Type} (ms : list (R * A)) (f : A -> R) : R := fold_right (fun m s => fst m * f (snd m) + s) 0 ms.
Definition is_share (m : R) : Prop := 0 <= m <= 1.

Lemma less_change_sound : forall w e s t t' S E C, less_change w e s t = Some t' -> triangle_in bits t S -> Forall2 contains e E -> Forall2 contains s C ->
  exists S', triangle_in bits t' S' /\ forall m v, is_share m -> quad S' v <= quad S v + m * (2 * dot E v * dot C v).
Proof.
  intros w e s t t' S E C h hS he hs. unfold less_change in h. destruct (is_null e || is_null s) eqn:z.
  - injection h as <-. exists S. split; [exact hS |]. intros m v _. apply orb_true_iff in z as [z | z]; rewrite (null_sound _ _ z ltac:(eassumption)); lra.
  - cbv zeta in h. set (tau := lo _) in h. destruct ((0 <? size w s)%Z && (0 <? tau)%Z) eqn:p; [| discriminate]. injection h as <-.
    apply andb_true_iff in p as [_ p]. apply Z.ltb_lt in p. pose proof (point_sound bits tau) as ht. set (y := IZR tau / unit_R bits) in *.
    pose proof (contains_positive bits (Fixed tau tau) y p ht) as y0.
    pose proof (halve_sound bits _ _ (recip_positive_sound bits (Fixed tau tau) y p ht)) as hh.
    exists (tcomb 1 1 S (real_square (/ y / 2) (comb y (-1) C E))). split.
    + apply triangle_add_sound; [exact hS |]. apply square_of_sound; [exact hh |]. eapply merge_related; try eassumption.
      * intros a x ha. apply mul_sound; assumption.
      * intros b x hb. replace (-1 * x) with (- x) by ring. apply neg_sound, hb.
      * intros a x b x' ha hb. replace (y * x + -1 * x') with (y * x - x') by ring. apply sub_sound; [apply mul_sound |]; assumption.
    + intros m v [m0 m1]. rewrite quad_tcomb, quad_square, dot_comb. set (c := dot C v). set (d := dot E v).
      assert (N : 0 <= (1 - m) * (y * c + -1 * d) ^ 2 + m * (y * c + d) ^ 2).
      { apply Rplus_le_le_0_compat; apply Rmult_le_pos; try lra; apply pow2_ge_0. }
      assert (Q : 0 <= / y / 2 * ((1 - m) * (y * c + -1 * d) ^ 2 + m * (y * c + d) ^ 2)).
      { apply Rmult_le_pos; [| exact N]. pose proof (Rinv_0_lt_compat _ y0). lra. }
      replace (/ y / 2 * ((1 - m) * (y * c + -1 * d) ^ 2 + m * (y * c + d) ^ 2)) with (/ y / 2 * (y * c + -1 * d) ^ 2 + m * (2 * d * c)) in Q by (field; lra). lra.
Qed.

Lemma less_changes_sound : forall w e ss E ms t t' S, less_changes w e ss t = Some t' -> triangle_in bits t S -> Forall2 contains e E ->
  Forall2 (fun s m => is_share (fst m) /\ Forall2 contains s (snd m)) ss ms ->
  exists S', triangle_in bits t' S' /\ forall v, quad S' v <= quad S v + sum_of ms (fun C => 2 * dot E v * dot C v).
Proof.
  intros w e ss E ms t t' S h hS he hs. revert t S h hS. induction hs as [| s m ss ms [hm hc] hs IH]; intros t S h hS; cbn [less_changes sum_of fold_right] in *.
  - injection h as <-. exists S. split; [exact hS | intro; lra].
  - destruct (less_change w e s t) as [t1 |] eqn:e1; [| discriminate]. destruct (less_change_sound _ _ _ _ _ _ _ _ e1 hS he hc) as [S1 [h1 q1]].
    destruct (IH t1 S1 h h1) as [S' [h2 q2]]. exists S'. split; [exact h2 |]. intro v. specialize (q2 v). specialize (q1 (fst m) v hm). unfold sum_of in q2. lra.
Qed.

Lemma sum_scaled : forall (A : Type) (ms : list (R * A)) k f, sum_of ms (fun c => k * f c) = k * sum_of ms f.
Proof. intros A ms k f. induction ms as [| m ms IH]; cbn [sum_of fold_right] in *; [ring |]. unfold sum_of in IH. rewrite IH. ring. Qed.
Lemma sum_plus : forall (A : Type) (ms : list (R * A)) p q f g, sum_of ms (fun c => p * f c + q * g c) = p * sum_of ms f + q * sum_of ms g.
Proof. intros A ms p q f g. induction ms as [| m ms IH]; cbn [sum_of fold_right] in *; [ring |]. unfold sum_of in IH. rewrite IH. ring. Qed.
Lemma sum_equal : forall (A : Type) (ms : list (R * A)) f g, (forall c, f c = g c) -> sum_of ms f = sum_of ms g.
Proof. intros A ms f g h. induction ms as [| m ms IH]; cbn [sum_of fold_right] in *; [reflexivity |]. unfold sum_of in IH. rewrite IH, h. reflexivity. Qed.
Lemma sum_mapped : forall (A B : Type) (ms : list (R * A)) (k : A -> B) f, sum_of (map (fun m => (fst m, k (snd m))) ms) f = sum_of ms (fun c => f (k c)).
Proof. intros A B ms k f. induction ms as [| m ms IH]; cbn [sum_of fold_right map fst snd] in *; [reflexivity |]. unfold sum_of in IH. rewrite IH. reflexivity. Qed.

(** ** A row of one machine, with changes *)

Definition varied (A : Type) : Type := (list A * A) * list (list A * A).
Definition varied_in (i : varied fixed) (r : list R * R) : Prop :=
  exists a d ms, Forall2 contains (fst (fst i)) a /\ contains (snd (fst i)) d /\
    Forall2 (fun c m => is_share (fst m) /\ Forall2 contains (fst c) (fst (snd m)) /\ contains (snd c) (snd (snd m))) (snd i) ms /\
    (forall v, dot (fst r) v = dot a v + sum_of ms (fun c => dot (fst c) v)) /\ snd r = d + sum_of ms snd.

(** Of A alone. *)
Definition without_D (r : varied fixed) : varied fixed := ((fst (fst r), zero), map (fun c => (fst c, zero)) (snd r)).
Lemma without_D_sound : forall r A, varied_in r A -> varied_in (without_D r) (fst A, 0).
Proof.
  intros r A [a [d [ms [h1 [h2 [h3 [h4 _]]]]]]]. exists a, 0, (map (fun m => (fst m, (fst (snd m), 0))) ms). split; [exact h1 |]. split; [apply zero_sound |]. split; [| split].
  - cbn [without_D snd]. eapply map_related; [| exact h3]. intros c m [k1 [k2 _]]. cbn [fst snd]. split; [exact k1 |]. split; [exact k2 | apply zero_sound].
  - intro v. cbn [fst]. rewrite h4, (sum_mapped _ _ ms (fun c : list R * R => (fst c, 0)) (fun c => dot (fst c) v)). reflexivity.
  - cbn [snd]. rewrite (sum_mapped _ _ ms (fun c : list R * R => (fst c, 0)) snd), (sum_equal _ ms _ (fun _ => 0 * 0)) by (intro; cbn; ring). rewrite sum_scaled. ring.
Qed.

Fixpoint lower_apart (w : list fixed) (places : N) (Y : list (list Z)) (r : list (varied fixed)) (start : triangle) : option triangle :=
  match Y, r with
  | y :: Y', ((a, d), cs) :: r' =>
      match less_changes w (map (fun n => Arithmetic.dyadic n places one) y) (map (fun c => map halve (residual places (fst c) (snd c) y)) cs)
        (triangle_add start (Test.halves places y (residual places a (upper_end d) y))) with
      | Some t => lower_apart w places Y' r' t
      | None => None
      end
  | _, _ => Some start
  end.

Lemma lower_apart_sound : forall w places Y i r start S T, Forall2 varied_in i r -> triangle_in bits start S -> lower_apart w places Y i start = Some T ->
  exists U, triangle_in bits T U /\ forall v, quad U v <= quad S v + form (lower_weights places Y v) r v.
Proof.
  intros w places. induction Y as [| y Y IH]; intros i r start S T h hS u; [injection u as <-; exists S; split; [exact hS | intro; cbn; lra] |].
  destruct h as [| [[a d] cs] [A D] i r [a0 [d0 [ms [ha [hd [hm [eA eD]]]]]]] h]; [injection u as <-; exists S; split; [exact hS | intro; cbn; lra] |]. cbn [fst snd] in *.
  cbn [lower_apart] in u. destruct (upper_end_sound bits d d0 hd) as [g [hg le]].
  destruct (less_changes _ _ _ _) as [t |] eqn:el in u; [| discriminate].
  pose proof (triangle_add_sound bits _ _ _ _ hS (Test.halves_sound bits places y _ _ (residual_sound bits places a a0 _ g y ha hg))) as hT.
  assert (hY : Forall2 contains (map (fun n => Arithmetic.dyadic n places one) y) (map (Y_value places) y)).
  { clear. induction y as [| n y I]; cbn [map]; constructor; [| exact I]. replace (Y_value places n) with (Y_value places n * 1) by ring. apply Arithmetic.dyadic_sound, integer_sound. }
  set (half := fun c : list R * R => map (Rmult (/ 2)) (comb 2 (- snd c) (fst c) (map (Y_value places) y))).
  assert (hC : Forall2 (fun s m => is_share (fst m) /\ Forall2 contains s (snd m)) (map (fun c => map halve (residual places (fst c) (snd c) y)) cs) (map (fun m => (fst m, half (snd m))) ms)).
  { eapply map_related; [| exact hm]. intros c m [h1 [h2 h3]]. cbn [fst snd]. split; [exact h1 |]. unfold half. eapply map_related; [| apply residual_sound; eassumption].
    intros b x hb. replace (/ 2 * x) with (x / 2) by (unfold Rdiv; ring). apply halve_sound, hb. }
  destruct (less_changes_sound _ _ _ _ _ _ _ _ el hT hY hC) as [S1 [h1 q1]]. destruct (IH i r t S1 T h h1 u) as [U [hU q]]. exists U. split; [exact hU |].
  intro v. specialize (q v). specialize (q1 v). cbn [lower_weights map form]. fold (lower_weights places Y v). rewrite quad_tcomb, quad_outer, dot_comb in q1.
  assert (E : dot (map (Y_value places) y) v = 2 * dot (map (Y_half places) y) v).
  { rewrite <- dot_map, map_map. f_equal. apply map_ext. exact (Y_half_eq places). }
  set (s := dot (map (Y_value places) y) v) in *. rewrite sum_mapped in q1.
  rewrite (sum_equal _ ms _ (fun c => 2 * s * dot (fst c) v + - s ^ 2 * snd c)) in q1 by (intro c; unfold half; rewrite dot_map, dot_comb; fold s; field).
  rewrite sum_plus in q1. rewrite eA, eD. replace (dot (map (Y_half places) y) v) with (s / 2) in q1 by lra. pose proof (pow2_ge_0 s). nra.
Qed.

Fixpoint upper_apart (w : list fixed) (r : list (varied fixed)) (start : triangle) : option triangle :=
  match r with
  | [] => Some start
  | ((a, d), cs) :: r' =>
      let bordered := (lower_end d :: a) :: start in
      let lessened := match cs with
        | [] => Some bordered
        | _ => if (0 <? lo d)%Z then less_changes (neg (Arithmetic.ratio (along a w) one d) :: w) (one :: map (fun _ => zero) a) (map (fun c => halve (snd c) :: fst c) cs) bordered
            else None
        end in
      match lessened with
      | Some t => match eliminated bits t with Some t => upper_apart w r' t | None => None end
      | None => None
      end
  end.

Lemma upper_apart_sound : forall w i r start S T, Forall2 varied_in i r -> triangle_in bits start S -> upper_apart w i start = Some T ->
  exists U, triangle_in bits T U /\ forall v z, quad U v <= quad S v + form (upper_weights z) r v.
Proof.
  intros w i r start S T h. revert start S. induction h as [| [[a d] cs] [A D] i r [a0 [d0 [ms [ha [hd [hm [eA eD]]]]]]] h IH]; intros start S hS u.
  - injection u as <-. exists S. split; [exact hS |]. intros v [| t z]; cbn; lra.
  - cbn [upper_apart] in u. cbn [fst snd] in *. cbv zeta in u. destruct (lower_end_sound bits d d0 hd) as [g [hg le]].
    assert (hB : triangle_in bits ((lower_end d :: a) :: start) ((g :: a0) :: S)) by (constructor; [constructor; assumption | exact hS]).
    match type of u with match ?x with Some _ => _ | None => _ end = _ => destruct x as [t |] eqn:el; [| discriminate u] end.
    destruct (eliminated bits t) as [t2 |] eqn:e2; [| discriminate].
    assert (L : exists S1, triangle_in bits t S1 /\ forall z v, quad S1 (z :: v) <= g * z ^ 2 + 2 * z * dot a0 v + quad S v + sum_of ms (fun c => 2 * z * dot (fst c) v + z ^ 2 * snd c)).
    { destruct hm as [| c m cs ms hc hm].
      - injection el as <-. exists ((g :: a0) :: S). split; [exact hB |]. intros z v. cbn [quad row_form sum_of fold_right]. lra.
      - destruct (0 <? lo d)%Z; [| discriminate].
        assert (hE : Forall2 contains (one :: map (fun _ => zero) a) (1 :: map (fun _ => 0) a)).
        { constructor; [apply integer_sound |]. clear. induction a; cbn; constructor; auto using zero_sound. }
        assert (hC : Forall2 (fun s m => is_share (fst m) /\ Forall2 contains s (snd m)) (map (fun c => halve (snd c) :: fst c) (c :: cs)) (map (fun m => (fst m, snd (snd m) / 2 :: fst (snd m))) (m :: ms))).
        { eapply map_related; [| exact (Forall2_cons c m hc hm)]. intros c' m' [h1 [h2 h3]]. cbn [fst snd]. split; [exact h1 |]. constructor; [apply halve_sound, h3 | exact h2]. }
        destruct (less_changes_sound _ _ _ _ _ _ _ _ el hB hE hC) as [S1 [h1 q]]. exists S1. split; [exact h1 |]. intros z v. specialize (q (z :: v)).
        rewrite (sum_mapped _ _ (m :: ms) (fun c => snd c / 2 :: fst c)) in q. cbn [quad row_form] in q.
        assert (Z0 : dot (1 :: map (fun _ => 0) a) (z :: v) = z).
        { cbn [dot]. assert (N : forall (l : list fixed) v, dot (map (fun _ => 0) l) v = 0) by (induction l as [| x l I]; intros [| y k]; cbn [map dot]; try reflexivity; rewrite I; ring). rewrite N. ring. }
        rewrite (sum_equal _ _ _ (fun c => 2 * z * dot (fst c) v + z ^ 2 * snd c)) in q by (intro c'; rewrite Z0; cbn [dot]; field). exact q. }
    destruct L as [S1 [h1 q1]]. clear el. revert e2 q1. destruct h1 as [| row real t S1 hr h1]; intros e2 q1; [discriminate |]. revert e2 q1. destruct hr as [| b x row u' hb hr]; intros e2 q1; [discriminate |].
    destruct (eliminated_sound bits _ _ _ _ _ _ _ e2 hb hr h1) as [x0 h2]. destruct (IH _ _ h2 u) as [U [hU q]]. exists U. split; [exact hU |].
    intros v z.
    assert (K : forall y, quad S1 v - / x * dot u' v ^ 2 <= quad S v + (2 * y * dot A v + y ^ 2 * D)).
    { intro y. specialize (q1 y v). rewrite sum_plus in q1. cbn [quad row_form] in q1. rewrite eA, eD. set (k := dot u' v) in *.
      assert (0 <= / x * (x * y + k) ^ 2) by (apply Rmult_le_pos; [apply Rlt_le, Rinv_0_lt_compat, x0 | apply pow2_ge_0]).
      replace (/ x * (x * y + k) ^ 2) with (x * y ^ 2 + 2 * y * k + / x * k ^ 2) in * by (field; lra).
      assert (g * y ^ 2 <= d0 * y ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact le]). lra. }
    destruct z as [| y z]; cbn [upper_weights map form].
    + specialize (q v []). rewrite quad_schur in q by lra. specialize (K 0). cbn in q. cbn. lra.
    + specialize (q v z). rewrite quad_schur in q by lra. specialize (K y). fold (upper_weights z). lra.
Qed.
(** What enclosures of a varied row hold, and the row that it is. *)
Definition parts : Type := (list R * R) * list (R * (list R * R)).
Definition holds_parts (i : varied fixed) (e : parts) : Prop :=
  Forall2 contains (fst (fst i)) (fst (fst e)) /\ contains (snd (fst i)) (snd (fst e)) /\
  Forall2 (fun c m => is_share (fst m) /\ Forall2 contains (fst c) (fst (snd m)) /\ contains (snd c) (snd (snd m))) (snd i) (snd e).
Definition is_of_parts (e : parts) (r : list R * R) : Prop :=
  (forall v, dot (fst r) v = dot (fst (fst e)) v + sum_of (snd e) (fun c => dot (fst c) v)) /\ snd r = snd (fst e) + sum_of (snd e) snd.
Lemma parts_of : forall i r, Forall2 varied_in i r -> exists es, Forall2 holds_parts i es /\ Forall2 is_of_parts es r.
Proof.
  induction 1 as [| i r is rs [a [d [ms [h1 [h2 [h3 [h4 h5]]]]]]] h [es [k1 k2]]]; [exists []; split; constructor |].
  exists (((a, d), ms) :: es). split; constructor; try assumption; [split; [exact h1 | split; assumption] | split; assumption].
Qed.

(** A form changes by that of the changes. *)
Fixpoint change_form (w : list (R * R)) (es : list parts) (q : list R) : R :=
  match w, es with
  | p :: w', e :: es' => sum_of (snd e) (fun c => fst p * dot (fst c) q + snd p * snd c) + change_form w' es' q
  | _, _ => 0
  end.
Lemma form_changes : forall w es r q, Forall2 is_of_parts es r -> form w r q = form w (map fst es) q + change_form w es q.
Proof.
  intros w es r q h. revert w. induction h as [| [[a d] ms] [A D] es r [h1 h2] h IH]; intros [| [p c] w]; cbn [form map change_form fst snd] in *; try ring.
  rewrite IH, h1, h2, sum_plus. ring.
Qed.

(** ** Columns of the inverse *)

Definition unit_at (j n : nat) : list fixed := map (fun k => if Nat.eqb k j then one else zero) (seq 0 n).
Fixpoint scalar (places : N) (y : list Z) (a : list fixed) : fixed :=
  match y, a with n :: y', b :: a' => add (Arithmetic.dyadic n places b) (scalar places y' a') | _, _ => zero end.
Definition column (own : bool) (k2 : fixed) (places : N) (Y : list (list Z)) (j : nat) (c : list fixed * fixed) : list fixed :=
  map (fun p => let s := scalar places (snd p) (fst c) in if own && Nat.eqb (fst p) j then sub s (halve (mul bits k2 (snd c))) else s) (combine (seq 0 (length Y)) Y).
Fixpoint solve_changes (w : list fixed) (n i j : nat) (k2 : fixed) (places : N) (Y : list (list Z)) (r : list (varied fixed)) (t : triangle) : option triangle :=
  match r with
  | [] => Some t
  | (_, cs) :: r' =>
      match less_changes w (unit_at j n) (map (column (Nat.eqb j i) k2 places Y j) cs) t with
      | Some t' => solve_changes w n i (S j) k2 places Y r' t'
      | None => None
      end
  end.

Lemma scalar_sound : forall places y a v, Forall2 contains a v -> contains (scalar places y a) (dot (map (Y_value places) y) v).
Proof.
  intros places y a v h. revert y. induction h as [| a b z v hb h IH]; intros [| n y]; cbn [scalar map dot]; try apply zero_sound.
  apply add_sound; [apply Arithmetic.dyadic_sound, hb | apply IH].
Qed.

Lemma dot_unit_at : forall u j s, dot (map (fun k => if Nat.eqb k (s + j) then 1 else 0) (seq s (length u))) u = nth j u 0.
Proof.
  assert (Z : forall u s b, (s < b)%nat -> dot (map (fun k => if Nat.eqb k s then 1 else 0) (seq b (length u))) u = 0).
  { induction u as [| t u IH]; intros s b h; [reflexivity |]. cbn [length seq map dot]. rewrite IH by lia. destruct (Nat.eqb_spec b s); [lia | ring]. }
  induction u as [| t u IH]; intros j s; [destruct j; reflexivity |]. cbn [length seq map dot]. destruct j as [| j]; cbn [nth].
  - rewrite Nat.add_0_r, Nat.eqb_refl, Z by lia. ring.
  - replace (s + S j)%nat with (S s + j)%nat by lia. rewrite IH. destruct (Nat.eqb_spec s (S s + j)); [lia | ring].
Qed.

Lemma column_sound : forall own k2 k places Y j c C, contains k2 k -> Forall2 contains (fst c) (fst C) -> contains (snd c) (snd C) -> (j < length Y)%nat ->
  exists s, Forall2 contains (column own k2 places Y j c) s /\ forall u, length u = length Y ->
    dot s u = dot (Solve.weighted_sum u (map (map (Y_value places)) Y)) (fst C) - if own then k * snd C / 2 * nth j u 0 else 0.
Proof.
  intros own k2 k places Y j c C hk h1 h2 hj. unfold column.
  set (real := fun p : nat * list Z => dot (map (Y_value places) (snd p)) (fst C) - if own && Nat.eqb (fst p) j then k * snd C / 2 else 0).
  exists (map real (combine (seq 0 (length Y)) Y)). split.
  - generalize (combine (seq 0 (length Y)) Y). induction l as [| p l IH]; cbn [map]; constructor; [| exact IH]. unfold real. cbv zeta.
    destruct (own && Nat.eqb (fst p) j).
    + apply sub_sound; [apply scalar_sound, h1 | apply halve_sound, mul_sound; assumption].
    + rewrite Rminus_0_r. apply scalar_sound, h1.
  - intros u lu. rewrite Solve.dot_weighted, map_map. unfold real. clear real.
    assert (G : forall Y u b, length u = length Y -> dot (map (fun p : nat * list Z => dot (map (Y_value places) (snd p)) (fst C) - if own && Nat.eqb (fst p) j then k * snd C / 2 else 0) (combine (seq b (length Y)) Y)) u
      = dot u (map (fun y => dot (map (Y_value places) y) (fst C)) Y) - (if own then k * snd C / 2 else 0) * dot (map (fun n => if Nat.eqb n j then 1 else 0) (seq b (length u))) u).
    { clear. induction Y as [| y Y IH]; intros [| t u] b l; try discriminate; cbn [length seq combine map dot]; [ring |]. cbn [fst snd].
      rewrite IH by (cbn in l; congruence). destruct own, (Nat.eqb b j); cbn [andb]; ring. }
    rewrite G by exact lu. pose proof (dot_unit_at u j 0) as D. cbn [Nat.add] in D. rewrite D. destruct own; ring.
Qed.

Lemma nth_solve_weights : forall u i j k, fst (nth j (Solve.solve_weights i k u) (0, 0)) = 2 * nth j u 0 /\
  snd (nth j (Solve.solve_weights i k u) (0, 0)) = if Nat.eqb j i then - k * nth j u 0 ^ 2 else 0.
Proof.
  assert (M : forall (u : list R) j, nth j (map (fun t => (2 * t, 0)) u) (0, 0) = (2 * nth j u 0, 0)).
  { induction u as [| t u IH]; intros [| j]; cbn [map nth]; try apply IH; f_equal; ring. }
  induction u as [| t u IH]; intros i j k; [destruct j, i; cbn; split; try ring; destruct (Nat.eqb j i); ring |].
  destruct i as [| i], j as [| j]; cbn [Solve.solve_weights nth Nat.eqb fst snd].
  - split; ring.
  - rewrite M. split; reflexivity.
  - split; reflexivity.
  - apply IH.
Qed.

Lemma skipped : forall (w : list (R * R)) j es q, change_form (skipn j w) es q =
  match es with [] => 0 | e :: es' => sum_of (snd e) (fun c => fst (nth j w (0, 0)) * dot (fst c) q + snd (nth j w (0, 0)) * snd c) + change_form (skipn (S j) w) es' q end.
Proof.
  induction w as [| p w IH]; intros [| j] [| e es] q; try reflexivity; try (cbn [skipn change_form]; destruct (skipn j w); reflexivity).
  - cbn [skipn change_form nth fst snd]. rewrite (sum_equal _ _ _ (fun _ => 0 * 0)) by (intro; ring). rewrite sum_scaled. ring.
  - cbn [skipn change_form nth fst snd]. rewrite (sum_equal _ _ _ (fun _ => 0 * 0)) by (intro; ring). rewrite sum_scaled. ring.
  - exact (IH j (e :: es) q).
Qed.

Lemma solve_changes_sound : forall w i k2 k places Y, contains k2 k -> forall r es, Forall2 holds_parts r es -> forall j t T S, (j + length r <= length Y)%nat ->
  solve_changes w (length Y) i j k2 places Y r t = Some T -> triangle_in bits t S ->
  exists U, triangle_in bits T U /\ forall u, length u = length Y ->
    quad U u <= quad S u + change_form (skipn j (Solve.solve_weights i k u)) es (Solve.weighted_sum u (map (map (Y_value places)) Y)).
Proof.
  intros w i k2 k places Y hk r es h. induction h as [| [[a d] cs] e r es [_ [_ hm]] h IH]; intros j t T S hj s hS.
  - injection s as <-. exists S. split; [exact hS |]. intros u _. rewrite skipped. lra.
  - cbn [solve_changes] in s. cbn [fst snd length] in *. destruct (less_changes _ _ _ _) as [t1 |] eqn:el in s; [| discriminate].
    assert (hE : Forall2 contains (unit_at j (length Y)) (map (fun n => if Nat.eqb n j then 1 else 0) (seq 0 (length Y)))).
    { unfold unit_at. generalize (seq 0 (length Y)). induction l as [| n l I]; cbn [map]; constructor; [| exact I]. destruct (Nat.eqb n j); [apply integer_sound | apply zero_sound]. }
    set (q := fun u => Solve.weighted_sum u (map (map (Y_value places)) Y)).
    assert (hC : exists ms, Forall2 (fun s m => is_share (fst m) /\ Forall2 contains s (snd m)) (map (column (Nat.eqb j i) k2 places Y j) cs) ms /\
      forall u, length u = length Y -> sum_of ms (fun s => dot s u) = sum_of (snd e) (fun c => dot (q u) (fst c) - if Nat.eqb j i then k * snd c / 2 * nth j u 0 else 0)).
    { clear el. induction hm as [| c m cs ms [h1 [h2 h3]] hm IHm]; [exists []; split; [constructor | reflexivity] |]. destruct IHm as [l [k1 k2']].
      destruct (column_sound (Nat.eqb j i) k2 k places Y j c (snd m) hk h2 h3 ltac:(lia)) as [s' [g1 g2]]. exists ((fst m, s') :: l). split.
      - cbn [map]. constructor; [split; assumption | exact k1].
      - intros u lu. specialize (k2' u lu). specialize (g2 u lu). cbn [sum_of fold_right fst snd] in *. unfold sum_of in k2'. rewrite k2', g2. reflexivity. }
    destruct hC as [ms [hC eC]]. destruct (less_changes_sound _ _ _ _ _ _ _ _ el hS hE hC) as [S1 [h1 q1]].
    destruct (IH (Datatypes.S j) t1 T S1 ltac:(lia) s h1) as [U [hU qU]]. exists U. split; [exact hU |]. intros u lu. specialize (qU u lu). specialize (q1 u). rewrite skipped.
    destruct (nth_solve_weights u i j k) as [-> ->]. pose proof (dot_unit_at u j 0) as D. cbn [Nat.add] in D. rewrite lu in D.
    rewrite (sum_equal _ _ _ (fun s => 2 * nth j u 0 * dot s u)) in q1 by (intro; rewrite D; ring). rewrite sum_scaled, (eC u lu), <- sum_scaled in q1.
    rewrite (sum_equal _ _ _ (fun c => 2 * nth j u 0 * dot (fst c) (q u) + (if Nat.eqb j i then - k * nth j u 0 ^ 2 else 0) * snd c)) in q1.
    + fold (q u) in qU |- *. lra.
    + intro c. rewrite (Solve.dot_commutes (q u)). destruct (Nat.eqb j i); field.
Qed.

Definition solved_apart (w : list fixed) (m i : nat) (k2 t : fixed) (places : N) (Y : list (list Z)) (r : list (varied fixed)) : bool :=
  Nat.eqb (length r) m && Nat.eqb (length Y) m &&
  match solve_changes w (length Y) i 0 k2 places Y r
    (triangle_add (Solve.solve_diagonal bits i k2 t (map fst r)) (Solve.gram places (Solve.solve_pairs places Y one (map fst r)))) with
  | Some T => Solve.is_definite bits m T
  | None => false
  end.

Lemma solved_apart_sound : forall w m i k2 k t T places Y r real u, solved_apart w m i k2 t places Y r = true -> Forall2 varied_in r real ->
  contains k2 k -> 0 <= k -> contains t T -> length u = m -> nonzero u ->
  let q := Solve.weighted_sum u (map (map (Y_value places)) Y) in 0 < - dot q q + (- dot u u * T + form (Solve.solve_weights i k u) real q).
Proof.
  intros w m i k2 k t T places Y r real u h hr hk k0 ht lu nz q. unfold solved_apart in h. apply andb_true_iff in h as [h D]. apply andb_true_iff in h as [l1 l2].
  apply Nat.eqb_eq in l1, l2. destruct (solve_changes _ _ _ _ _ _ _ _ _) as [V |] eqn:s in D; [| discriminate].
  destruct (parts_of _ _ hr) as [es [he hp]]. assert (R0 : rows_rel contains (map fst r) (map fst es)).
  { eapply map_related; [| exact he]. intros a b [k1 [k2' _]]. split; assumption. }
  assert (ls : length u = length (map fst es)) by (rewrite map_length; transitivity m; [exact lu |]; rewrite <- l1; exact (related_length _ _ _ _ _ he)).
  destruct (Solve.solve_diagonal_sound bits i k2 k t T _ _ u hk k0 ht R0 ls) as [G [hG le]].
  pose proof (Fixed.integer_sound bits 1) as hone.
  pose proof (triangle_add_sound bits _ _ _ _ hG (Solve.gram_sound bits places _ _ (Solve.solve_pairs_sound bits places Y _ 1 _ _ hone R0))) as hT.
  destruct (solve_changes_sound w i k2 k places Y hk r es he 0 _ V _ ltac:(lia) s hT) as [U [hU qU]]. specialize (qU u ltac:(congruence)).
  unfold Solve.is_definite in D. destruct (Nat.eqb_spec (length V) m) as [lv | lv]; [| discriminate].
  pose proof (is_positive_definite_sound bits _ U D hU u) as P. rewrite (related_length _ _ _ _ _ hU) in lv. specialize (P ltac:(congruence) nz).
  rewrite quad_tcomb, Solve.quad_pairs in qU by congruence. fold q in qU. cbn [skipn] in qU.
  rewrite (form_changes _ es real q hp). rewrite Solve.form_solve by exact ls. lra.
Qed.

(** ** A sign *)

Definition sign_apart (t : fixed) (r : varied fixed) : bool :=
  (0 <=? lo (snd (fst r)) - fold_right (fun c s => Z.max 0 (- lo (snd c)) + s) 0 (snd r) - hi t)%Z.
Lemma sign_apart_sound : forall t T r A, sign_apart t r = true -> varied_in r A -> contains t T -> T <= snd A.
Proof.
  intros t T r A h [a [d [ms [_ [hd [hm [_ ->]]]]]]] [_ ht]. unfold sign_apart in h. apply Z.leb_le, IZR_le in h. rewrite !minus_IZR in h.
  pose proof (unit_R_pos bits) as p. destruct hd as [hd _].
  assert (L : - IZR (fold_right (fun c s => Z.max 0 (- lo (snd c)) + s)%Z 0%Z (snd r)) <= sum_of ms snd * unit_R bits).
  { clear - hm p. induction hm as [| c m cs ms [[m0 m1] [_ [hc _]]] hm IH]; cbn [fold_right sum_of] in *; [lra |]. rewrite plus_IZR. unfold sum_of in IH.
    assert (K : - IZR (Z.max 0 (- lo (snd c))) <= fst m * snd (snd m) * unit_R bits).
    { pose proof (IZR_max 0 (- lo (snd c))) as [k0 k1]. rewrite opp_IZR in k1. set (n := IZR (Z.max 0 (- lo (snd c)))) in *. set (y := snd (snd m) * unit_R bits) in *.
      replace (fst m * snd (snd m) * unit_R bits) with (fst m * y) by (unfold y; ring). assert (- n <= y) by lra. nra. }
    lra. }
  apply Rmult_le_reg_r with (unit_R bits); [exact p |]. lra.
Qed.
(** ** The one machine, and steps from it to all others *)

Inductive choice := FromLeast | FromGreatest | FromMiddle.
Definition start (a : fixed) (c : choice) : fixed * list fixed :=
  let at_ n := Fixed n n in
  match c with
  | FromLeast => (at_ (lo a), [at_ (hi a - lo a)%Z])
  | FromGreatest => (at_ (hi a), [at_ (lo a - hi a)%Z])
  | FromMiddle => let m := Z.shiftr (lo a + hi a) 1 in (at_ m, [at_ (hi a - m)%Z; at_ (m - hi a)%Z])
  end.

Lemma part_of : forall d r, 0 <= d <= r -> exists m, is_share m /\ d = m * r.
Proof.
  intros d r [h k]. destruct (Req_dec r 0) as [z | z]; [exists 0; split; [split; lra | lra] |]. exists (d / r). assert (0 < r) by lra. split; [split |].
  - apply Rmult_le_pos; [exact h | apply Rlt_le, Rinv_0_lt_compat; assumption].
  - apply Rmult_le_reg_r with r; [assumption |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
  - field. exact z.
Qed.

Definition stepped (rs : list fixed) (ms : list (R * R)) : Prop := Forall2 (fun r m => is_share (fst m) /\ contains r (snd m)) rs ms.
Definition stride (ms : list (R * R)) : R := sum_of ms (fun r => r).

Lemma start_sound : forall a c y, contains a y ->
  exists y0 ms, contains (fst (start a c)) y0 /\ contains a y0 /\ stepped (snd (start a c)) ms /\ y = y0 + stride ms.
Proof.
  intros a c y [l h]. pose proof (unit_R_pos bits) as p. assert (V : forall n, IZR n / unit_R bits * unit_R bits = IZR n) by (intro; field; lra).
  assert (Q : forall n, contains (Fixed n n) (IZR n / unit_R bits)) by (apply point_sound).
  assert (In : forall n, (lo a <= n <= hi a)%Z -> contains a (IZR n / unit_R bits)).
  { intros n [h1 h2]. apply IZR_le in h1, h2. unfold Fixed.contains. rewrite V. lra. }
  assert (le : (lo a <= hi a)%Z) by (apply le_IZR; lra).
  destruct c; unfold stepped, stride; cbn [start fst snd].
  - destruct (part_of (y - IZR (lo a) / unit_R bits) (IZR (hi a - lo a) / unit_R bits)) as [m [hm e]].
    { rewrite minus_IZR. split; apply Rmult_le_reg_r with (unit_R bits); try exact p; [rewrite Rmult_minus_distr_r, V; lra |]. rewrite Rmult_minus_distr_r, V. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
    exists (IZR (lo a) / unit_R bits), [(m, IZR (hi a - lo a) / unit_R bits)]. split; [apply Q |]. split; [apply In; lia |]. split; [constructor; [split; [exact hm | apply Q] | constructor] |]. cbn. lra.
  - destruct (part_of (IZR (hi a) / unit_R bits - y) (IZR (hi a - lo a) / unit_R bits)) as [m [hm e]].
    { rewrite minus_IZR. split; apply Rmult_le_reg_r with (unit_R bits); try exact p; [rewrite Rmult_minus_distr_r, V; lra |]. rewrite Rmult_minus_distr_r, V. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
    exists (IZR (hi a) / unit_R bits), [(m, IZR (lo a - hi a) / unit_R bits)]. split; [apply Q |]. split; [apply In; lia |]. split; [constructor; [split; [exact hm | apply Q] | constructor] |]. cbn [sum_of fold_right fst snd].
    replace (IZR (lo a - hi a)) with (- IZR (hi a - lo a)) by (rewrite <- opp_IZR; f_equal; lia). unfold Rdiv in *. lra.
  - set (n := Z.shiftr (lo a + hi a) 1).
    assert (B : (2 * n <= lo a + hi a < 2 * n + 2)%Z).
    { unfold n. rewrite Z.shiftr_div_pow2 by lia. change (2 ^ 1)%Z with 2%Z.
      pose proof (Z.div_mod (lo a + hi a) 2 ltac:(lia)). pose proof (Z.mod_pos_bound (lo a + hi a) 2 ltac:(lia)). lia. }
    set (r := IZR (hi a - n) / unit_R bits).
    assert (r0 : 0 <= r) by (apply Rmult_le_pos; [apply IZR_le; lia | apply Rlt_le, Rinv_0_lt_compat, p]).
    assert (Both : - r <= y - IZR n / unit_R bits <= r).
    { assert (g : (n - hi a <= lo a - n)%Z) by lia. apply IZR_le in g. rewrite !minus_IZR in g. unfold r. rewrite minus_IZR.
      split; apply Rmult_le_reg_r with (unit_R bits); try exact p; rewrite ?Ropp_mult_distr_l_reverse, Rmult_minus_distr_r, V; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra. }
    assert (Neg : IZR (n - hi a) / unit_R bits = - r).
    { unfold r. replace (IZR (n - hi a)) with (- IZR (hi a - n)) by (rewrite <- opp_IZR; f_equal; lia). unfold Rdiv. ring. }
    exists (IZR n / unit_R bits).
    destruct (Rle_lt_dec 0 (y - IZR n / unit_R bits)) as [s | s].
    + destruct (part_of (y - IZR n / unit_R bits) r) as [m [hm e]]; [lra |]. exists [(m, r); (0, - r)].
      split; [apply Q |]. split; [apply In; lia |]. split; [constructor; [split; [exact hm | apply Q] |]; constructor; [split; [split; cbn; lra |] | constructor]; cbn [snd]; rewrite <- Neg; apply Q |]. cbn [sum_of fold_right fst snd]. lra.
    + destruct (part_of (IZR n / unit_R bits - y) r) as [m [hm e]]; [lra |]. exists [(0, r); (m, - r)].
      split; [apply Q |]. split; [apply In; lia |]. split; [constructor; [split; [split; cbn; lra | apply Q] |]; constructor; [split; [exact hm |] | constructor]; cbn [snd]; rewrite <- Neg; apply Q |]. cbn [sum_of fold_right fst snd]. lra.
Qed.

Section Ends.
(** Of parameters with tolerances, by their number: where the one machine is. *)
Variable ends : list (nat * choice).
Definition choice_of (j : nat) : option choice := option_map snd (find (fun p => Nat.eqb (fst p) j) ends).
Fixpoint starts_from (j : nat) (params : list fixed) : list fixed :=
  match params with [] => [] | a :: l => match choice_of j with Some c => fst (start a c) | None => a end :: starts_from (S j) l end.
Definition steps (params : list fixed) : list (list fixed) := map (fun p => snd (start (nth (fst p) params zero) (snd p))) ends.

Lemma chosen : forall j c, NoDup (map fst ends) -> In (j, c) ends -> choice_of j = Some c.
Proof.
  unfold choice_of. induction ends as [| [k d] l IH]; intros j c once h; [contradiction |]. cbn [find fst]. inversion once as [| ? ? no once']; subst. destruct h as [e | h].
  - injection e as -> ->. rewrite Nat.eqb_refl. reflexivity.
  - destruct (Nat.eqb_spec k j) as [-> |]; [exfalso; apply no; exact (in_map fst _ _ h) | exact (IH j c once' h)].
Qed.
Lemma not_chosen : forall j, ~ In j (map fst ends) -> choice_of j = None.
Proof.
  unfold choice_of. induction ends as [| [k d] l IH]; intros j n; [reflexivity |]. cbn [find fst]. destruct (Nat.eqb_spec k j) as [-> |]; [exfalso; apply n; left; reflexivity |].
  apply IH. intro i. apply n. right. exact i.
Qed.

Lemma starts_sound : forall params theta, Forall2 contains params theta -> forall b, exists theta0, Forall2 contains (starts_from b params) theta0 /\ Forall2 contains params theta0 /\
  forall j, match choice_of (b + j) with
    | Some c => (j < length params)%nat -> exists ms, stepped (snd (start (nth j params zero) c)) ms /\ nth j theta 0 = nth j theta0 0 + stride ms
    | None => nth j theta0 0 = nth j theta 0
    end.
Proof.
  induction 1 as [| a y params theta h hs IH]; intro b.
  - exists []. split; [constructor |]. split; [constructor |]. intro j. destruct (choice_of (b + j)); [cbn; lia | reflexivity].
  - destruct (IH (S b)) as [t [h1 [h2 h3]]].
    assert (K : exists y0, contains (match choice_of b with Some c => fst (start a c) | None => a end) y0 /\ contains a y0 /\
      match choice_of b with Some c => exists ms, stepped (snd (start a c)) ms /\ y = y0 + stride ms | None => y0 = y end).
    { destruct (choice_of b) as [c |]; [| exists y; auto]. destruct (start_sound a c y h) as [y0 [ms [k1 [k2 [k3 k4]]]]]. exists y0. split; [exact k1 |]. split; [exact k2 |]. exists ms. split; assumption. }
    destruct K as [y0 [k1 [k2 k3]]]. exists (y0 :: t). split; [cbn [starts_from]; constructor; assumption |]. split; [constructor; assumption |].
    intros [| j]; cbn [nth].
    + rewrite Nat.add_0_r. destruct (choice_of b) as [c |]; [intro; exact k3 | exact k3].
    + specialize (h3 j). replace (b + S j)%nat with (S b + j)%nat by lia. destruct (choice_of (S b + j)) as [c |]; [| exact h3]. intro l. apply h3. cbn in l. lia.
Qed.
End Ends.

(** ** Rows as slopes: of the one machine, and of derivatives by each parameter *)

Definition multi (A : Type) : Type := A * list A.
Definition multi_in (s : multi slope) (e : multi entry) : Prop := entry_in bits (fst s) (fst e) /\ Forall2 (entry_in bits) (snd s) (snd e).
Let still_slope : slope := constant zero.
Let no_entry : entry := (0, []).

Fixpoint changes_at (s : list bool) (p : nat) (steps : list (list fixed)) (r : list (multi slope) * multi slope) : list (list fixed * fixed) :=
  match steps with
  | [] => []
  | rs :: steps' =>
      let f q := at_vertex s (nth p (snd q) still_slope) in
      let a := map f (fst r) in let d := f (snd r) in
      map (fun r => (map (mul bits r) a, mul bits r d)) rs ++ changes_at s (S p) steps' r
  end.
Definition varied_at (s : list bool) (steps : list (list fixed)) (r : list (multi slope) * multi slope) : varied fixed :=
  let f q := at_vertex s (fst q) in ((map f (fst r), f (snd r)), changes_at s 0 steps r).

(** The entry of a machine that differs by so much. *)
Fixpoint moved (b : entry) (ds : list R) (es : list entry) : entry :=
  match ds, es with D :: ds', e :: es' => moved (fst b + D * fst e, comb 1 D (snd b) (snd e)) ds' es' | _, _ => b end.
Lemma at_moved : forall l ds es b, at_lambda l (moved b ds es) = at_lambda l b + dot ds (map (at_lambda l) es).
Proof.
  intro l. induction ds as [| D ds IH]; intros [| e es] b; cbn [moved map dot]; try ring. rewrite IH. unfold at_lambda at 1. cbn [fst snd]. rewrite dot_comb. unfold at_lambda. ring.
Qed.

Lemma dot_skipped : forall (ds : list R) es l p, dot ds (map (at_lambda l) (skipn p es)) =
  match ds with [] => 0 | D :: ds' => D * at_lambda l (nth p es no_entry) + dot ds' (map (at_lambda l) (skipn (S p) es)) end.
Proof.
  intros [| D ds] es l p; [reflexivity |]. revert p. induction es as [| e es IH]; intros [| p]; try reflexivity; try (exact (IH p)).
  - cbn. unfold no_entry, at_lambda. cbn. destruct ds; cbn; ring.
  - cbn. unfold no_entry, at_lambda. cbn. destruct ds; cbn; ring.
Qed.

Lemma varied_at_sound : forall s steps r a d mss, Forall2 multi_in (fst r) a -> multi_in (snd r) d -> Forall2 stepped steps mss ->
  let l := map corner s in let m e := at_lambda l (moved (fst e) (map stride mss) (snd e)) in varied_in (varied_at s steps r) (map m a, m d).
Proof.
  intros s steps r a d mss ha hd hm l m.
  assert (At : forall q e p, multi_in q e -> contains (at_vertex s (nth p (snd q) still_slope)) (at_lambda l (nth p (snd e) no_entry))).
  { intros q e p [_ h]. apply at_vertex_sound. revert p. induction h as [| u v us vs k h IH]; intros [| p]; cbn [nth]; auto.
    - split; [apply zero_sound | constructor].
    - split; [apply zero_sound | constructor]. }
  assert (C : forall p, exists ms, Forall2 (fun c m => is_share (fst m) /\ Forall2 contains (fst c) (fst (snd m)) /\ contains (snd c) (snd (snd m))) (changes_at s p steps r) ms /\
    (forall v, sum_of ms (fun c => dot (fst c) v) = dot (map (fun e => dot (map stride mss) (map (at_lambda l) (skipn p (snd e)))) a) v) /\
    sum_of ms snd = dot (map stride mss) (map (at_lambda l) (skipn p (snd d)))).
  { induction hm as [| rs ns steps mss h hm IH]; intro p; cbn [changes_at].
    - exists []. split; [constructor |]. split; [| reflexivity]. intro v. cbn [sum_of fold_right map]. symmetry. clear. revert v. induction a as [| e a IH]; intros [| t v]; cbn [map dot]; try reflexivity.
      rewrite IH. ring.
    - destruct (IH (S p)) as [ms [h1 [h2 h3]]]. set (g (e : multi entry) := at_lambda l (nth p (snd e) no_entry)).
      exists (map (fun n : R * R => (fst n, (map (fun e => snd n * g e) a, snd n * g d))) ns ++ ms). split; [| split].
      + apply Forall2_app; [| exact h1]. eapply map_related; [| exact h]. intros q n [k1 k2]. cbn [fst snd]. split; [exact k1 |]. split; [| apply mul_sound; [exact k2 | apply At, hd]].
        rewrite map_map. eapply map_related; [| exact ha]. intros u e k. apply mul_sound; [exact k2 | apply At, k].
      + intro v. unfold sum_of in *. rewrite fold_right_app, h2.
        assert (S1 : forall z, fold_right (fun (m : R * (list R * R)) s0 => fst m * dot (fst (snd m)) v + s0) z (map (fun n : R * R => (fst n, (map (fun e => snd n * g e) a, snd n * g d))) ns) = stride ns * dot (map g a) v + z).
        { intro z. unfold stride. clear. induction ns as [| n ns I]; cbn [map fold_right sum_of fst snd]; [ring |]. rewrite I. unfold sum_of.
          assert (G : dot (map (fun e => snd n * g e) a) v = snd n * dot (map g a) v) by (rewrite <- dot_map, map_map; reflexivity). rewrite G. ring. }
        rewrite S1.
        assert (P : forall e : multi entry, dot (map stride (ns :: mss)) (map (at_lambda l) (skipn p (snd e))) = stride ns * g e + dot (map stride mss) (map (at_lambda l) (skipn (S p) (snd e))))
          by (intro e; exact (dot_skipped (stride ns :: map stride mss) (snd e) l p)).
        rewrite (map_ext _ _ P). clear. revert v. induction a as [| e a I]; intros [| t v]; cbn [map]; try (cbn [dot]; ring).
        match goal with |- _ * dot (?b :: ?bs) _ + dot (?c :: ?cs) _ = dot (?d :: ?ds) _ => change (stride ns * (b * t + dot bs v) + (c * t + dot cs v) = d * t + dot ds v) end. rewrite <- I. ring.
      + unfold sum_of in *. rewrite fold_right_app, h3.
        assert (S1 : forall z, fold_right (fun (m : R * (list R * R)) s0 => fst m * snd (snd m) + s0) z (map (fun n : R * R => (fst n, (map (fun e => snd n * g e) a, snd n * g d))) ns) = stride ns * g d + z).
        { intro z. unfold stride. clear. induction ns as [| n ns I]; cbn [map fold_right sum_of fst snd]; [ring |]. rewrite I. unfold sum_of. ring. }
        rewrite S1. cbn [map]. rewrite (dot_skipped (stride ns :: map stride mss)). reflexivity. }
  destruct (C 0%nat) as [ms [h1 [h2 h3]]]. exists (map (fun e => at_lambda l (fst e)) a), (at_lambda l (fst d)), ms. unfold varied_at. cbn [fst snd].
  split; [| split; [| split; [exact h1 | split]]].
  - eapply map_related; [| exact ha]. intros q e [k _]. apply at_vertex_sound, k.
  - apply at_vertex_sound, hd.
  - intro v. rewrite h2. unfold m. clear. revert v. induction a as [| e a I]; intros [| t v]; cbn [map dot]; try ring. rewrite I, at_moved. cbn [skipn]. ring.
  - rewrite h3. unfold m. rewrite at_moved. reflexivity.
Qed.

(** Slopes of the derivatives of a formula, one for each parameter. *)
Fixpoint rates_from (p : nat) (ends : list (nat * choice)) (d : dual) : option (list slope) :=
  match ends with
  | [] => Some []
  | _ :: ends' =>
      match match nth p (snd d) (Some None) with None => Some still_slope | Some r => r end, rates_from (S p) ends' d with
      | Some r, Some rs => Some (r :: rs)
      | _, _ => None
      end
  end.

Lemma rates_from_sound : forall lambda (at_x at_c : nat -> R) ends d p rs, rates_from p ends d = Some rs ->
  (forall q, rate_is lambda (nth (p + q) (snd d) (Some None)) (at_c (nth q (map fst ends) O)) (at_x (nth q (map fst ends) O))) ->
  exists es, Forall2 (entry_in bits) rs es /\ Forall2 (fun k e => at_lambda lambda e = at_x (fst k)) ends es.
Proof.
  intros lambda at_x at_c. induction ends as [| k ends IH]; intros d p rs h D; cbn [rates_from] in h; [injection h as <-; exists []; split; constructor |].
  destruct (match nth p (snd d) (Some None) with None => Some still_slope | Some r => r end) as [r |] eqn:er; [| discriminate].
  destruct (rates_from (S p) ends d) as [rest |] eqn:e; [| discriminate]. injection h as <-.
  destruct (IH d (S p) rest e) as [es [k1 k2]].
  { intro q. specialize (D (S q)). replace (p + S q)%nat with (S p + q)%nat in D by lia. exact D. }
  specialize (D 0%nat). rewrite Nat.add_0_r in D. cbn [map nth] in D.
  assert (X : exists e', entry_in bits r e' /\ at_lambda lambda e' = at_x (fst k)).
  { destruct (nth p (snd d) (Some None)) as [[s |] |]; cbn [rate_is] in D.
    - injection er as <-. destruct D as [h1 [h2 [u [h3 h4]]]]. exists (at_c (fst k), u). split; [split; assumption |]. unfold at_lambda. cbn [fst snd]. lra.
    - discriminate.
    - injection er as <-. destruct D as [_ ->]. exists (0, []). split; [split; [apply zero_sound | constructor] | unfold at_lambda; cbn; ring]. }
  destruct X as [e' [x1 x2]]. exists (e' :: es). split; constructor; assumption.
Qed.
End Precision.
