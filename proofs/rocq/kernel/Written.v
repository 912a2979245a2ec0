(** * Mechanisms by formulas: claims, formulas on a tape, certificates and refutations

    A user names coordinates, parameters within tolerances and definitions, and
    gives each joint by its coordinate, or by its row of M. *)

From Coq Require Import ZArith Reals Lra Lia List Bool String.
From Orthocert Require Import Velocity Fixed Claim.
From Orthocert Require MeanValue.
From Orthocert.kernel Require Import Statement Linear Arithmetic Slope Test Cell Check Number Formula Problem Witness Configuration Inputs Drives Locate Driven.
From Orthocert.kernel Require Gradient Twofold Spread Nearby.
Import ListNotations.
Local Open Scope list_scope.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** What is written, and what it means *)

Inductive written :=
  | Constant (c : number)
  | Named (name : string)
  | Opposite (a : written)
  | Sum (a b : written) | Difference (a b : written) | Product (a b : written) | Quotient (a b : written)
  | Raised (a : written) (n : positive)
  | RootOf (a : written).

Definition environment (A : Type) : Type := list (string * A).
Fixpoint lookup {A : Type} (default : A) (env : environment A) (name : string) : A :=
  match env with [] => default | (n, a) :: env' => if String.eqb n name then a else lookup default env' name end.

Fixpoint meaning (env : environment R) (e : written) : R :=
  match e with
  | Constant c => Claim.value c
  | Named name => lookup 0 env name
  | Opposite a => - meaning env a
  | Sum a b => meaning env a + meaning env b
  | Difference a b => meaning env a - meaning env b
  | Product a b => meaning env a * meaning env b
  | Quotient a b => meaning env a / meaning env b
  | Raised a n => meaning env a ^ Pos.to_nat n
  | RootOf a => sqrt (meaning env a)
  end.

(** No divisor is zero, and every radicand positive. *)
Fixpoint is_defined (env : environment R) (e : written) : Prop :=
  match e with
  | Constant _ | Named _ => True
  | Opposite a | Raised a _ => is_defined env a
  | Sum a b | Difference a b | Product a b => is_defined env a /\ is_defined env b
  | Quotient a b => is_defined env a /\ is_defined env b /\ meaning env b <> 0
  | RootOf a => is_defined env a /\ 0 < meaning env a
  end.

(** A joint by the entries of its row of M, or by its coordinate. *)
Inductive written_joint := ByRow (row : list written) | ByCoordinate (rho : written).
Record mechanism := Mechanism {
  coordinate_names : list string;
  parameters : list (string * tolerance);
  definitions : list (string * written);
  joint_forms : list written_joint
}.
(** [one_to_one]: no two points of the box have the same joint coordinates. *)
Record written_claim := MakeWrittenClaim { by_formulas : mechanism; box_of : list tolerance; written_demands : list demand; one_to_one : bool }.

(** Values of all names, those of definitions from those before them. *)
Definition given {A : Type} (c : mechanism) (x theta : list A) : environment A :=
  combine (coordinate_names c) x ++ combine (map fst (parameters c)) theta.
Fixpoint extended (env : environment R) (ds : list (string * written)) : environment R :=
  match ds with [] => env | (n, e) :: ds' => extended ((n, meaning env e) :: env) ds' end.
Fixpoint all_defined (env : environment R) (ds : list (string * written)) : Prop :=
  match ds with [] => True | (n, e) :: ds' => is_defined env e /\ all_defined ((n, meaning env e) :: env) ds' end.

Definition environment_at (c : mechanism) (theta x : list R) : environment R := extended (given c x theta) (definitions c).
(** The row of M: as it is given, or with row . x' the rate of the joint's coordinate along every path of the coordinates. *)
Definition is_row (c : mechanism) (theta x : list R) (j : written_joint) (row : list R) : Prop :=
  let n := length (coordinate_names c) in
  match j with
  | ByRow es => row = map (meaning (environment_at c theta x)) es
  | ByCoordinate e => length row = n /\ forall path v, (forall t, length (path t) = n) -> path 0 = x ->
      (forall k, derivable_pt_lim (fun t => nth k (path t) 0) 0 (nth k v 0)) ->
      derivable_pt_lim (fun t => meaning (environment_at c theta (path t)) e) 0 (Linear.dot row v)
  end.
(** Joint coordinates, of joints that have one. *)
Definition joint_values (c : mechanism) (theta x : list R) : list coordinate :=
  map (fun j => match j with ByRow _ => Unknown | ByCoordinate e => Length (meaning (environment_at c theta x) e) end) (joint_forms c).
(** Everything that is written is defined. *)
Definition is_reached (c : mechanism) (theta x : list R) : Prop :=
  all_defined (given c x theta) (definitions c) /\
  Forall (fun j => match j with ByRow es => Forall (is_defined (environment_at c theta x)) es | ByCoordinate e => is_defined (environment_at c theta x) e end) (joint_forms c).
(** Joint coordinates off by the error at most from those with the parameters in the middle are those of exactly one point so near. *)
Definition forms_recover (c : mechanism) (theta x : list R) (error b _ : number) : Prop :=
  let nominal := map (fun p => middle (snd p)) (parameters c) in
  forall rho, Forall2 (is_off (Claim.value error)) (joint_values c nominal x) rho ->
  let is_at y := length y = length x /\ Linear.dot (Twofold.less y x) (Twofold.less y x) <= Claim.value b ^ 2 /\ is_reached c theta y /\ joint_values c theta y = rho in
  exists y, is_at y /\ forall z, is_at z -> z = y.
(** The machine with the parameters [theta] at the coordinates [x], with these rows. *)
Definition machine_at (c : mechanism) (theta x : list R) (M : list (list R)) : configuration :=
  Configuration M (joint_values c theta x) (map (fun _ => None) (joint_forms c)) [] (fun b => b) (fun _ _ _ _ => False) (forms_recover c theta x) (is_reached c theta x).

Definition is_about_written (c : written_claim) (theta x : list R) : Prop :=
  Forall2 (fun p y => within (snd p) y) (parameters (by_formulas c)) theta /\ Forall2 within (box_of c) x.

(** Every machine of the claim meets it at every point of the box. *)
Definition written_holds (c : written_claim) : Prop := forall theta x, is_about_written c theta x ->
  (exists M, Forall2 (is_row (by_formulas c) theta x) (joint_forms (by_formulas c)) M /\
    Configuration.meets (length (coordinate_names (by_formulas c))) (machine_at (by_formulas c) theta x M) (written_demands c)) /\
  (one_to_one c = true -> forall y, Forall2 within (box_of c) y -> joint_values (by_formulas c) theta y = joint_values (by_formulas c) theta x -> y = x).

(** ** As formulas: numbers are parameters of the tape, one each *)

Fixpoint literals (e : written) : list parameter :=
  match e with
  | Constant c => [(exactly c, 0%Z)]
  | Named _ => []
  | Opposite a | Raised a _ | RootOf a => literals a
  | Sum a b | Difference a b | Product a b | Quotient a b => literals a ++ literals b
  end.

(** x^2, times x^2 as often as it takes, and then x if n is odd. *)
Definition power (a : formula) (n : nat) : formula :=
  match n with
  | O => integer 1
  | S O => a
  | _ => let s := square a in
         let even := Nat.iter (pred (Nat.div2 n)) (fun p => times p s) s in
         if Nat.even n then even else times even a
  end.

Section Formulas.
Variable env : environment formula.
Fixpoint formula_of (e : written) (j : nat) : formula :=
  let second f a b := f (formula_of a j) (formula_of b (j + length (literals a))) in
  match e with
  | Constant c => quantity (exactly c, 0%Z) j
  | Named name => lookup (integer 0) env name
  | Opposite a => opposite (formula_of a j)
  | Sum a b => second plus a b
  | Difference a b => second minus a b
  | Product a b => second times a b
  | Quotient a b => second over a b
  | Raised a n => power (formula_of a j) (Pos.to_nat n)
  | RootOf a => root (formula_of a j)
  end.
(** Its quotients and roots. *)
Fixpoint partials (e : written) (j : nat) : list formula :=
  match e with
  | Constant _ | Named _ => []
  | Opposite a | Raised a _ => partials a j
  | Sum a b | Difference a b | Product a b => partials a j ++ partials b (j + length (literals a))
  | Quotient a b => formula_of e j :: partials a j ++ partials b (j + length (literals a))
  | RootOf a => formula_of e j :: partials a j
  end.
End Formulas.

Lemma value_power : forall x theta a n, value x theta (power a n) = value x theta a ^ n.
Proof.
  intros x theta a [| [| n]]; [reflexivity | cbn [power]; ring |]. unfold power. cbv zeta.
  set (m := S (S n)). assert (I : forall k, value x theta (Nat.iter k (fun p => times p (square a)) (square a)) = value x theta a ^ (2 * S k)).
  { induction k as [| k IH]; cbn [Nat.iter nat_rect]; [rewrite Formula.value_square; reflexivity |].
    rewrite value_times, Formula.value_square. change (nat_rect _ _ _ k) with (Nat.iter k (fun p => times p (square a)) (square a)). rewrite IH, <- pow_add. f_equal. lia. }
  assert (D : S (pred (Nat.div2 m)) = Nat.div2 m) by reflexivity. destruct (Nat.even m) eqn:e.
  - rewrite I, D. f_equal. apply Nat.even_spec in e. destruct e as [k e]. rewrite e, Nat.div2_double. reflexivity.
  - assert (o : Nat.odd m = true) by (rewrite <- Nat.negb_even, e; reflexivity). apply Nat.odd_spec in o. destruct o as [k o].
    rewrite value_times, I, D, o. replace (2 * k + 1)%nat with (S (2 * k)) by lia. rewrite Nat.div2_succ_double. cbn [pow]. ring.
Qed.


Section Values.
Variables x theta : list R.
Variable env : environment formula.
Variable renv : environment R.
Hypothesis agreed : forall name, value x theta (lookup (integer 0) env name) = lookup 0 renv name.

(** The parameters from [j] on are these numbers. *)
Definition holds_at (j : nat) (ps : list parameter) : Prop :=
  forall i p, nth_error ps i = Some p -> scaled_within p (nth (j + i) theta 0).

Lemma holds_app : forall j ps qs, holds_at j (ps ++ qs) -> holds_at j ps /\ holds_at (j + length ps) qs.
Proof.
  intros j ps qs h. split; intros i p n.
  - apply h. rewrite nth_error_app1; [exact n | apply nth_error_Some; congruence].
  - rewrite <- Nat.add_assoc. apply h. rewrite nth_error_app2 by lia. rewrite Nat.add_comm, Nat.add_sub. exact n.
Qed.

Lemma formula_value : forall e j, holds_at j (literals e) -> value x theta (formula_of env e j) = meaning renv e.
Proof.
  induction e as [c | n | a IH | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IH n | a IH]; intros j h; cbn [formula_of meaning literals] in *;
    try (apply holds_app in h as [h1 h2]; rewrite ?value_plus, ?value_minus, ?value_times, ?value_over, (IHa _ h1), (IHb _ h2); reflexivity).
  - specialize (h O _ eq_refl). rewrite Nat.add_0_r in h. rewrite (quantity_value _ _ x theta j h eq_refl).
    destruct h as [y [[h1 h2] h3]]. cbn [fst snd exactly least greatest] in *. rewrite h3. change (two_to 0) with 1. lra.
  - apply agreed.
  - rewrite value_opposite, (IH _ h). reflexivity.
  - rewrite value_power, (IH _ h). reflexivity.
  - rewrite value_root, (IH _ h). reflexivity.
Qed.

Lemma defined_root : forall a, defined x theta (root a) -> 0 < value x theta a.
Proof.
  intros a. unfold root. destruct (is 1 a) eqn:q; [rewrite (is_value _ _ _ _ q); intros; lra | intros [h _]; exact h].
Qed.

Lemma partials_defined : forall e j, holds_at j (literals e) -> Forall (defined x theta) (partials env e j) -> is_defined renv e.
Proof.
  induction e as [c | n | a IH | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IH n | a IH]; intros j h D; cbn [partials is_defined literals] in *;
    try exact I; try (apply (IH j); assumption);
    try (apply holds_app in h as [h1 h2]; apply Forall_app in D as [D1 D2]; split; [apply (IHa j) | apply (IHb (j + length (literals a))%nat)]; assumption).
  - apply holds_app in h as [h1 h2]. inversion D as [| ? ? D0 D']. subst. apply Forall_app in D' as [D1 D2].
    split; [apply (IHa j); assumption |]. split; [apply (IHb (j + length (literals a))%nat); assumption |].
    cbn [formula_of] in D0. apply defined_over in D0. rewrite (formula_value _ _ h2) in D0. exact D0.
  - inversion D as [| ? ? D0 D']. subst. split; [apply (IH j); assumption |].
    cbn [formula_of] in D0. apply defined_root in D0. rewrite (formula_value _ _ h) in D0. exact D0.
Qed.
End Values.

(** ** The whole mechanism *)

(** Formulas of definitions, in the environment of those before them; then of all entries of rows. *)
Fixpoint named (env : environment formula) (ds : list (string * written)) (j : nat) : environment formula :=
  match ds with [] => env | (n, e) :: ds' => named ((n, formula_of env e j) :: env) ds' (j + length (literals e)) end.
Fixpoint named_partials (env : environment formula) (ds : list (string * written)) (j : nat) : list formula :=
  match ds with
  | [] => []
  | (n, e) :: ds' => partials env e j ++ named_partials ((n, formula_of env e j) :: env) ds' (j + length (literals e))
  end.
Definition all_literals (es : list written) : list parameter := flat_map literals es.
Fixpoint row_of (env : environment formula) (es : list written) (j : nat) : list formula :=
  match es with [] => [] | e :: es' => formula_of env e j :: row_of env es' (j + length (literals e)) end.
Fixpoint row_partials (env : environment formula) (es : list written) (j : nat) : list formula :=
  match es with [] => [] | e :: es' => partials env e j ++ row_partials env es' (j + length (literals e)) end.
Definition joint_literals (j : written_joint) : list parameter := match j with ByRow es => all_literals es | ByCoordinate e => literals e end.
Definition joint_partials (env : environment formula) (j : written_joint) (i : nat) : list formula :=
  match j with ByRow es => row_partials env es i | ByCoordinate e => formula_of env e i :: partials env e i end.
Fixpoint joints_partials (env : environment formula) (js : list written_joint) (i : nat) : list formula :=
  match js with [] => [] | j :: js' => joint_partials env j i ++ joints_partials env js' (i + length (joint_literals j)) end.

(** *** Derivatives by coordinates: those by parameters, where these and coordinates change places *)

Fixpoint swapped (f : formula) : formula :=
  match f with F o => F match o with Coord k => Param k | Param k => Coord k | _ => map_op swapped o end end.
Definition coordinate_gradient (n : nat) (f : formula) : list formula * formula :=
  let g := Gradient.gradient (seq 0 n) (swapped f) in (map swapped (fst g), swapped (snd g)).

Fixpoint value_swapped (x theta : list R) (f : formula) {struct f} : value theta x (swapped f) = value x theta f.
Proof.
  destruct f as [o]. destruct o; cbn [swapped map_op value real_op]; rewrite ?(value_swapped x theta); reflexivity.
Qed.
Fixpoint defined_swapped (x theta : list R) (f : formula) {struct f} : defined x theta f -> defined theta x (swapped f).
Proof.
  destruct f as [o]. destruct o; cbn [swapped map_op defined all_op defined_op]; rewrite ?(value_swapped x theta); intro h; try exact h;
    repeat match goal with k : _ /\ _ |- _ => destruct k end; repeat split; auto using defined_swapped.
Qed.

(** square(sqrt x) = x, of formulas that are defined. *)
Fixpoint without_roots (a : formula) : formula :=
  match a with
  | F (Sqrt r) => r
  | F (Neg b) => without_roots b
  | F (Mul b c) => times (without_roots b) (without_roots c)
  | _ => square a
  end.
Fixpoint without_roots_value (x theta : list R) (a : formula) {struct a} : defined x theta a -> value x theta (without_roots a) = value x theta a ^ 2.
Proof.
  intro d. destruct a as [o]. destruct o as [k | j | n | b c | b c | b | b c | b c | b | b | ? b c e]; cbn [without_roots]; try (apply Formula.value_square).
  - destruct d as [_ d]. cbn [map_op all_op] in d. rewrite (without_roots_value x theta b d). cbn [value map_op real_op]. ring.
  - destruct d as [_ [d1 d2]]. rewrite value_times, (without_roots_value x theta b d1), (without_roots_value x theta c d2). cbn [value map_op real_op]. ring.
  - destruct d as [d _]. cbn [map_op defined_op] in d. cbn [value map_op real_op]. rewrite <- Rsqr_pow2, Rsqr_sqrt by lra. reflexivity.
Qed.

(** A derivative is defined where the formula is. *)
Fixpoint gradient_defined (by_ : list nat) (x theta : list R) (f : formula) {struct f} : defined x theta f ->
  Forall (defined x theta) (fst (Gradient.gradient by_ f)) /\ defined x theta (snd (Gradient.gradient by_ f)).
Proof.
  set (ok := fun g : Gradient.fraction => Forall (defined x theta) (fst g) /\ defined x theta (snd g)).
  assert (One : forall n, defined x theta (integer n)) by (intro n; split; exact I).
  assert (S : ok (Gradient.stays by_)) by (split; [cbn [fst]; apply Forall_forall; intros g i; apply in_map_iff in i as [k [<- _]]; apply One | apply One]).
  assert (M : forall l h, Forall (defined x theta) l -> (forall g, defined x theta g -> defined x theta (h g)) -> Forall (defined x theta) (map h l)) by (intros l h d k; rewrite Forall_map; revert d; apply Forall_impl, k).
  assert (C : forall a p b q, ok a -> ok b -> defined x theta p -> defined x theta q -> ok (Gradient.combined a p b q)).
  { assert (T : forall p q, defined x theta p -> defined x theta q -> forall l m, Forall (defined x theta) l -> Forall (defined x theta) m ->
      Forall (defined x theta) (map (fun n => plus (times p (fst n)) (times q (snd n))) (combine l m))).
    { intros p q dp dq. induction l as [| a l IH]; intros [| b m] hl hm; cbn [combine map]; constructor; inversion hl; inversion hm; subst; [| apply IH; assumption].
      apply plus_defined; apply times_defined; assumption. }
    intros a p b q [a1 a2] [b1 b2] dp dq. unfold Gradient.combined. destruct (same (snd a) (snd b)); (split; cbn [fst snd]; [apply T; try assumption; apply times_defined; assumption |]); [exact a2 | apply times_defined; assumption]. }
  assert (Z : forall g h, ok g -> defined x theta h -> ok (if forallb (is 0) (fst g) then g else (fst g, h))) by (intros g h [g1 g2] dh; destruct (forallb _ _); split; assumption).
  intro d. destruct f as [o]. destruct o as [k | j | n | b c | b c | b | b c | b c | b | b | second b c e]; cbn [Gradient.gradient]; try exact S.
  - destruct (existsb _ by_); [| exact S]. split; [cbn [fst]; apply Forall_forall; intros g i; apply in_map_iff in i as [k [<- _]]; apply One | apply One].
  - destruct d as [_ [d1 d2]]. apply C; try apply One; apply gradient_defined; assumption.
  - destruct d as [_ [d1 d2]]. apply C; try apply One; apply gradient_defined; assumption.
  - destruct d as [_ d]. destruct (gradient_defined by_ x theta b d) as [g1 g2]. split; [apply M; [exact g1 | apply opposite_defined] | exact g2].
  - destruct d as [_ [d1 d2]]. apply C; try assumption; apply gradient_defined; assumption.
  - assert (dd := d). destruct d as [_ [d1 d2]]. apply Z; [apply C; try apply One; [apply gradient_defined; assumption .. | apply opposite_defined, dd] |].
    apply times_defined; [apply C; try apply One; [apply gradient_defined; assumption .. | apply opposite_defined, dd] | exact d2].
  - destruct d as [_ d]. destruct (gradient_defined by_ x theta b d) as [g1 g2]. split; [| exact g2]. cbn [fst]. apply M; [exact g1 |].
    intros g dg. repeat apply times_defined; try assumption. apply One.
  - assert (dd := d). destruct d as [_ d]. destruct (gradient_defined by_ x theta b d) as [g1 g2]. cbv zeta.
    destruct (forallb _ _); (split; [exact g1 | cbn [snd]]); [apply One | repeat apply times_defined; try assumption; apply One].
  - assert (dd := d). destruct d as [r [d1 [d2 d3]]]. assert (E : forall s, defined x theta (F (Elbow s b c e))) by (intro s; split; [exact r | repeat split; assumption]). cbv zeta.
    set (g := Gradient.combined _ _ _ _). assert (G : ok g) by (unfold g; repeat apply C; try apply One; try (apply minus_defined; [assumption | apply E]); apply gradient_defined; assumption).
    destruct G as [g1 g2]. set (n := map _ (fst g)). assert (N : Forall (defined x theta) n) by (unfold n; apply M; [exact g1 |]; intros h dh; apply times_defined; [destruct second; [| apply opposite_defined]; apply E | exact dh]).
    destruct (forallb _ _); (split; [exact N | cbn [snd]]); [exact g2 |]. repeat apply times_defined; try apply One; try assumption.
    apply minus_defined; apply times_defined; try assumption; apply E.
Qed.

Definition of_joint (n : nat) (env : environment formula) (j : written_joint) (i : nat) : pose_formulas :=
  match j with
  | ByRow es => let r := row_of env es i in PoseFormulas r (integer 1) r EUnknown [] None [] []
  | ByCoordinate e => let f := formula_of env e i in let (N, E) := coordinate_gradient n f in
      PoseFormulas N (without_roots E) (map (fun a => if same a E then integer 1 else over a E) N) (ELength f) [] None [] []
  end.
Fixpoint all_joints (n : nat) (env : environment formula) (js : list written_joint) (i : nat) : list pose_formulas :=
  match js with [] => [] | j :: js' => of_joint n env j i :: all_joints n env js' (i + length (joint_literals j)) end.

Section Mechanism.
Variables x theta : list R.

Definition agrees (env : environment formula) (renv : environment R) : Prop :=
  forall name, value x theta (lookup (integer 0) env name) = lookup 0 renv name.

Lemma agrees_cons : forall env renv n f y, agrees env renv -> value x theta f = y -> agrees ((n, f) :: env) ((n, y) :: renv).
Proof. intros env renv n f y h e name. cbn [lookup]. destruct (String.eqb n name); [exact e | apply h]. Qed.

Lemma agrees_combine : forall ns fs ys env renv, map (value x theta) fs = ys -> agrees env renv ->
  agrees (combine ns fs ++ env) (combine ns ys ++ renv).
Proof.
  intros ns fs ys env renv <- h. revert fs. induction ns as [| n ns IH]; intros [| f fs]; try exact h.
  cbn [combine map app]. apply agrees_cons; [apply IH | reflexivity].
Qed.

Lemma named_agrees : forall ds env renv j, agrees env renv -> holds_at theta j (all_literals (map snd ds)) ->
  agrees (named env ds j) (extended renv ds) /\
  (Forall (defined x theta) (named_partials env ds j) -> all_defined renv ds).
Proof.
  induction ds as [| [n e] ds IH]; intros env renv j h H; [split; [exact h | exact (fun _ => I)] |].
  cbn [all_literals map snd flat_map] in H. apply holds_app in H as [H1 H2].
  pose proof (formula_value x theta env renv h e j H1) as V.
  destruct (IH _ _ (j + length (literals e))%nat (agrees_cons _ _ n _ _ h V) H2) as [I1 I2]. split; [exact I1 |].
  intro D. cbn [named_partials] in D. apply Forall_app in D as [D1 D2].
  split; [exact (partials_defined x theta env renv h e j H1 D1) | exact (I2 D2)].
Qed.

Lemma row_agrees : forall es env renv j, agrees env renv -> holds_at theta j (all_literals es) ->
  map (value x theta) (row_of env es j) = map (meaning renv) es /\
  (Forall (defined x theta) (row_partials env es j) -> Forall (is_defined renv) es).
Proof.
  induction es as [| e es IH]; intros env renv j h H; [split; [reflexivity | constructor] |].
  cbn [all_literals flat_map] in H. apply holds_app in H as [H1 H2]. destruct (IH _ _ _ h H2) as [I1 I2]. split.
  - cbn [row_of map]. rewrite (formula_value x theta env renv h e j H1), I1. reflexivity.
  - intro D. cbn [row_partials] in D. apply Forall_app in D as [D1 D2].
    constructor; [exact (partials_defined x theta env renv h e j H1 D1) | exact (I2 D2)].
Qed.

End Mechanism.

(** ** Checking *)

Definition exact_parameters (ps : list (string * tolerance)) : list parameter := map (fun p => (snd p, 0%Z)) ps.
Definition inputs (c : mechanism) : list parameter :=
  exact_parameters (parameters c) ++ all_literals (map snd (definitions c)) ++ flat_map joint_literals (joint_forms c).
Definition given_formulas (c : mechanism) : environment formula :=
  given c (map (fun k => F (Coord k)) (seq 0 (length (coordinate_names c)))) (numbered 0 (exact_parameters (parameters c))).

Section Precision.
Variable bits : positive.
(** Of claims that are one to one: the one matrix, and before which other test this is counted. *)
Variables (one_matrix : N * list (list Z)) (one_place : nat).

Definition check_written (c : written_claim) (t : tree) : bool :=
  let f := by_formulas c in let n := length (coordinate_names f) in let demands := written_demands c in
  let j := length (parameters f) in let i := (j + length (all_literals (map snd (definitions f))))%nat in
  let env := named (given_formulas f) (definitions f) j in
  let fs := all_joints n env (joint_forms f) i in
  let partial := named_partials (given_formulas f) (definitions f) j ++ joints_partials env (joint_forms f) i in
  let at_ := length (inputs f) in
  let ps := exact_parameters (parameters f) in let js := map d_joint fs in
  let own q d := match d with OnePose _ _ _ => located_own ps (map d_divided fs) (pose_divided fs) js | _ => own_of fs q d end in
  let wanted := entries (pose_rows fs) ++ entries (pose_divided fs) ++ partial ++ of_each own false 0 at_ demands in
  let tape := compile wanted in
  let all := formulas tape in let place := place all in
  let tests_of q d := match d with
    | OnePose error b _ => if forallb (fun j => match j with ByRow _ => false | ByCoordinate _ => true end) (joint_forms f)
        then located_tests bits place n n [false] false ps 0 (map d_divided fs) (pose_divided fs) js (Some (Fixed.integer bits 1)) error b else [None]
    | _ => tests_for bits place fs false 0 q d
    end in
  Nat.eqb (length (box_of c)) n && forallb (fun j => match j with ByRow es => Nat.eqb (length es) n | ByCoordinate _ => true end) (joint_forms f) &&
  forallb (fun e => Formula.same (nth (place e) all (integer 0)) e) wanted && existsb rules_out demands &&
  (negb (one_to_one c) || forallb (fun j => match j with ByRow _ => false | ByCoordinate _ => true end) (joint_forms f)) &&
  match all_some (map (enclose_parameter bits) (inputs f)), all_some (map (enclose_input bits) (flat_map (inputs_of false 0) demands)),
        all_some (map (fun b => enclose_parameter bits (b, 0%Z)) (box_of c)), all_some (of_each tests_of false 0 at_ demands) with
  | Some params, Some numbers, Some box, Some tests =>
      let tests := if one_to_one c then inserted one_place tests (Chords (map_rows place (pose_divided fs)) (fst one_matrix) (snd one_matrix)) else tests in
      check bits tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place partial) (params ++ numbers) tests (fun _ => None) box (all_open tests) t
  | _, _, _, _ => false
  end.

Lemma within_scaled : forall t y, within t y -> scaled_within (t, 0%Z) y.
Proof. intros t y h. exists y. split; [exact h |]. cbn [snd]. change (two_to 0) with 1. field. Qed.

Lemma literals_exact : forall e, Forall2 scaled_within (literals e) (map (fun p => Claim.value (least (fst p))) (literals e)).
Proof.
  induction e; cbn [literals]; try assumption; try (rewrite map_app; apply Forall2_app; assumption); [| constructor].
  constructor; [| constructor]. apply within_scaled. unfold within, exactly. cbn. lra.
Qed.

Lemma exact_list : forall (A : Type) (f : A -> list parameter),
  (forall a, exists y, Forall2 scaled_within (f a) y) -> forall l, exists y, Forall2 scaled_within (flat_map f l) y.
Proof.
  intros A f h. induction l as [| a l [y IH]]; [exists []; constructor |]. destruct (h a) as [z H].
  exists (z ++ y). cbn [flat_map]. apply Forall2_app; assumption.
Qed.

Lemma holds_at_of : forall front ps th back, Forall2 scaled_within ps th -> holds_at (front ++ th ++ back) (length front) ps.
Proof.
  intros front ps th back h i p n. rewrite app_nth2_plus. revert i n.
  induction h as [| q y ps th hq h IH]; intros [| i] n; try discriminate; cbn [nth_error app nth] in *; [injection n as <-; exact hq | exact (IH i n)].
Qed.

Lemma dot_rates : forall l v (r : nat -> R) a, (forall k, (k < length l)%nat -> r (a + k)%nat = nth k v 0) -> Linear.dot (map r (seq a (length l))) l = Linear.dot l v.
Proof.
  induction l as [| y l IH]; intros v r a h; [reflexivity |]. cbn [length seq map Linear.dot].
  pose proof (h O ltac:(cbn; lia)) as h0. rewrite Nat.add_0_r in h0. destruct v as [| b v].
  - rewrite (IH [] r (S a)) by (intros k hk; rewrite Nat.add_succ_comm, (h (S k)) by (cbn; lia); destruct k; reflexivity). cbn [nth] in h0. rewrite h0. destruct l; cbn; ring.
  - rewrite (IH v r (S a)) by (intros k hk; rewrite Nat.add_succ_comm; apply (h (S k)); cbn; lia). cbn [nth] in h0. rewrite h0. ring.
Qed.

(** What the formulas of a joint are. *)
Section Joints.
Variables (c : mechanism) (theta th x : list R).
Let n := length (coordinate_names c).
Variable env : environment formula.
Hypothesis agree : forall y, length y = n -> agrees y th env (environment_at c theta y).
Hypothesis lx : length x = n.
Definition coordinate_at (j : written_joint) : coordinate := match j with ByRow _ => Unknown | ByCoordinate e => Length (meaning (environment_at c theta x) e) end.
Definition joint_defined (j : written_joint) : Prop :=
  match j with ByRow es => Forall (is_defined (environment_at c theta x)) es | ByCoordinate e => is_defined (environment_at c theta x) e end.

Lemma joint_good : forall j i, holds_at th i (joint_literals j) -> match j with ByRow es => length es = n | ByCoordinate _ => True end ->
  Forall (defined x th) (joint_partials env j i) ->
  joint_defined j /\ exists row, is_row c theta x j row /\ is_good x th 0 n false (of_joint n env j i) (Seen row (coordinate_at j) None True).
Proof.
  assert (one : / two_to 0 = 1) by (change (two_to 0) with 1; field).
  intros j i h lj D. destruct j as [es | e]; cbn [joint_literals joint_partials joint_defined coordinate_at is_row of_joint] in *.
  - destruct (row_agrees x th es env (environment_at c theta x) i (agree x lx) h) as [V P0]. split; [exact (P0 D) |].
    exists (map (meaning (environment_at c theta x)) es). split; [reflexivity |]. unfold is_good. cbv zeta. cbn [seen_row seen_joint seen_rod seen_reach d_A d_D d_divided d_joint d_rod d_vector rate].
    rewrite one, map_length. split; [exact lj |]. split; [reflexivity |]. split; [exact (fun _ => I) |]. split; [intros _; cbn; lra |]. split; [exact (fun _ => I) |].
    intros _. split; [exists 1; split; [cbn; ring |] | split; [| split; exact I]]; rewrite V; symmetry; rewrite <- (map_id (map _ es)) at 2; apply map_ext; intro; ring.
  - inversion D as [| ? ? D0 D1]; subst. split; [exact (partials_defined x th env _ (agree x lx) e i h D1) |]. set (f := formula_of env e i) in *.
    assert (V : forall y, length y = n -> value y th f = meaning (environment_at c theta y) e) by (intros y ly; exact (formula_value y th env _ (agree y ly) e i h)).
    set (g := Gradient.gradient (seq 0 n) (swapped f)). assert (G : coordinate_gradient n f = (map swapped (fst g), swapped (snd g))) by reflexivity. rewrite G.
    assert (gl : length (fst g) = n) by (unfold g; rewrite Gradient.gradient_length, seq_length; reflexivity).
    assert (dE : defined x th (swapped (snd g))) by (apply defined_swapped; apply gradient_defined; apply defined_swapped; exact D0).
    set (E := value x th (swapped (snd g))). set (row := map (fun a => value x th a / E) (map swapped (fst g))).
    assert (Along : forall path v, (forall t, length (path t) = n) -> path 0 = x -> (forall k, derivable_pt_lim (fun t => nth k (path t) 0) 0 (nth k v 0)) ->
      E <> 0 /\ derivable_pt_lim (fun t => value (path t) th f) 0 (Linear.dot row v)).
    { intros path v lp p0 hp. set (r := fun k => if Nat.ltb k n then nth k v 0 else 0).
      assert (S : Gradient.is_derivative (seq 0 n) th path 0 r (swapped f) g).
      { apply Gradient.gradient_sound.
        - apply seq_NoDup.
        - intro k. unfold r. destruct (Nat.ltb_spec k n) as [l | l]; [apply hp |]. eapply derivable_eq; [apply (derivable_const 0) | | reflexivity].
          intro t. cbn beta. apply nth_overflow. rewrite lp. exact l.
        - intros k hk. unfold r. destruct (Nat.ltb_spec k n) as [l | l]; [exfalso; apply hk, in_seq; lia | reflexivity].
        - rewrite p0. apply defined_swapped. exact D0. }
      destruct S as [nz S]. rewrite p0, <- (value_swapped th x) in nz. split; [exact nz |].
      eapply derivable_eq; [exact S | intro t; cbn beta; symmetry; apply (value_swapped (path t) th) |].
      unfold Gradient.along. rewrite p0. rewrite <- (value_swapped th x (snd g)). fold E.
      assert (Q : map (value th x) (fst g) = map (value x th) (map swapped (fst g))) by (rewrite map_map; apply map_ext; intro a; symmetry; apply (value_swapped th x)).
      rewrite Q. pose proof (dot_rates (map (value x th) (map swapped (fst g))) v r 0) as K. rewrite !map_length, gl in K. rewrite K.
      - unfold row. generalize (map swapped (fst g)). intro l. clear - nz. revert v. induction l as [| a l IH]; intros [| b v]; cbn [map Linear.dot]; unfold Rdiv; try ring. rewrite IH. unfold Rdiv. ring.
      - intros k hk. cbn [Nat.add]. unfold r. destruct (Nat.ltb_spec k n); [reflexivity | lia]. }
    assert (nz : E <> 0).
    { destruct (Along (fun _ => x) [] (fun _ => lx) eq_refl) as [k _]; [| exact k]. intro k. destruct k; apply derivable_const. }
    exists row. split.
    + split; [unfold row; rewrite !map_length; exact gl |]. intros path v lp p0 hp. destruct (Along path v lp p0 hp) as [_ K].
      eapply derivable_eq; [exact K | intro t; cbn beta; symmetry; apply V, lp | reflexivity].
    + unfold is_good. cbv zeta. cbn [seen_row seen_joint seen_rod seen_reach d_A d_D d_divided d_joint d_rod d_vector rate].
      rewrite one. split; [unfold row; rewrite !map_length; exact gl |]. split; [reflexivity |]. split; [exact (fun _ => I) |].
      assert (VD : value x th (without_roots (swapped (snd g))) = E ^ 2) by (apply without_roots_value; exact dE).
      split; [intros _; rewrite VD, <- Rsqr_pow2; apply Rlt_0_sqr; exact nz |]. split; [exact (fun _ => I) |]. intros _. split; [| split; [| split; [| exact I]]].
      * exists E. split; [symmetry; exact VD |]. unfold row. generalize (map swapped (fst g)). intro N0. rewrite map_map. apply map_ext. intro a. field. exact nz.
      * unfold row. generalize (map swapped (fst g)). intro N0. rewrite !map_map. apply map_ext. intro a. destruct (same a (swapped (snd g))) eqn:sm.
        -- apply same_sound in sm. rewrite sm. fold E. cbn. field. exact nz.
        -- rewrite value_over. fold E. field. exact nz.
      * cbn [joint_is]. rewrite one, (V x lx). ring.
Qed.

Lemma joints_good : forall js i, holds_at th i (flat_map joint_literals js) -> Forall (fun j => match j with ByRow es => length es = n | ByCoordinate _ => True end) js ->
  Forall (defined x th) (joints_partials env js i) ->
  Forall joint_defined js /\ exists M, Forall2 (is_row c theta x) js M /\
    Forall2 (is_good x th 0 n false) (all_joints n env js i) (map (fun p => Seen (snd p) (coordinate_at (fst p)) None True) (combine js M)).
Proof.
  induction js as [| j js IH]; intros i h l D; [split; [constructor |]; exists []; split; constructor |].
  cbn [flat_map] in h. apply holds_app in h as [h1 h2]. inversion l as [| ? ? l1 l2]; subst. cbn [joints_partials] in D. apply Forall_app in D as [D1 D2].
  destruct (joint_good j i h1 l1 D1) as [J1 [row [R1 G1]]]. destruct (IH _ h2 l2 D2) as [J2 [M [R2 G2]]].
  split; [constructor; assumption |]. exists (row :: M). split; [constructor; assumption |]. cbn [all_joints combine map fst snd]. constructor; assumption.
Qed.
End Joints.

(** *** One to one: between two points of the box, sum_i w_i rho_i grows where the form that the one matrix shows is positive *)

Fixpoint weighted (w : list (R * R)) (rho : list R) : R :=
  match w, rho with (p, _) :: w', a :: rho' => p * a + weighted w' rho' | _, _ => 0 end.
Definition rho_of (c : mechanism) (theta x : list R) (j : written_joint) : R :=
  match j with ByRow _ => 0 | ByCoordinate e => meaning (environment_at c theta x) e end.

Lemma same_values : forall c theta x y, joint_values c theta y = joint_values c theta x ->
  map (rho_of c theta y) (joint_forms c) = map (rho_of c theta x) (joint_forms c).
Proof.
  intros c theta x y. unfold joint_values, rho_of. induction (joint_forms c) as [| [es | e] js IH]; cbn [map]; intro h; [reflexivity | |];
    injection h; intros; f_equal; auto.
Qed.

Lemma nth_way : forall t a b k, length a = length b -> nth k (on_the_way t a b) 0 = nth k a 0 + t * (nth k b 0 - nth k a 0).
Proof. intros t a b k l. pose proof (on_the_way_nth t [] a b k l) as H. rewrite !app_nil_r in H. exact H. Qed.
Lemma way_length : forall t a b, length a = length b -> length (on_the_way t a b) = length a.
Proof. intros t a b l. unfold on_the_way. rewrite map_length, combine_length, <- l. apply Nat.min_id. Qed.
Lemma way_within : forall t bs a b, 0 <= t <= 1 -> Forall2 within bs a -> Forall2 within bs b -> Forall2 within bs (on_the_way t a b).
Proof.
  intros t bs a b ht ha. revert b. induction ha as [| q x bs a hx ha IH]; intros [| y b] hb; inversion hb as [| ? ? ? ? hy hs]; subst; constructor; [| exact (IH b hs)].
  unfold within in *. cbn [fst snd]. nra.
Qed.

Lemma weighted_rate : forall c theta x d path t w js M, length d = length (coordinate_names c) ->
  (forall s, length (path s) = length (coordinate_names c)) -> path t = x -> (forall k, derivable_pt_lim (fun s => nth k (path s) 0) t (nth k d 0)) ->
  forallb (fun j => match j with ByRow _ => false | ByCoordinate _ => true end) js = true -> Forall2 (is_row c theta x) js M ->
  derivable_pt_lim (fun s => weighted w (map (rho_of c theta (path s)) js)) t (form w (map (fun row => (row, 0)) M) d).
Proof.
  intros c theta x d path t w js M ld lp pt hd co h.
  assert (Shift : forall g l, derivable_pt_lim (fun s => g (t + s)) 0 l -> derivable_pt_lim g t l).
  { intros g l H eps e0. destruct (H eps e0) as [delta D]. exists delta. intros u nz small. specialize (D u nz small). rewrite Rplus_0_r, Rplus_0_l in D. exact D. }
  revert w. induction h as [| j row js M hj h IH]; intros w; cbn [map forallb] in *.
  - eapply derivable_eq; [apply (derivable_const 0) | intro s; destruct w as [| [p q] w]; reflexivity | destruct w as [| [p q] w]; reflexivity].
  - apply andb_true_iff in co as [cj co]. destruct j as [| e]; [discriminate |]. destruct w as [| [p q] w].
    { eapply derivable_eq; [apply (derivable_const 0) | intro s; reflexivity | reflexivity]. }
    assert (K : derivable_pt_lim (fun s => rho_of c theta (path s) (ByCoordinate e)) t (Linear.dot row d)).
    { apply Shift. destruct hj as [_ hj]. apply (hj (fun s => path (t + s)) d); [intro; apply lp | rewrite Rplus_0_r; exact pt |].
      intros k eps e0. destruct (hd k eps e0) as [delta D]. exists delta. intros u nz small. specialize (D u nz small). rewrite Rplus_0_l, Rplus_0_r. exact D. }
    eapply derivable_eq; [apply derivable_add; [apply (derivable_pt_lim_scal _ p _ _ K) | exact (IH co w)] | intro s; reflexivity | cbn [form]; ring].
Qed.

(** Of rows as a function of the point. *)
Lemma chords_differ : forall c theta box places Y (M : list R -> list (list R)) x y, forallb (fun j => match j with ByRow _ => false | ByCoordinate _ => true end) (joint_forms c) = true ->
  (forall z, Forall2 within box z -> length z = length (coordinate_names c) /\ Forall2 (is_row c theta z) (joint_forms c) (M z) /\
    forall v, length v = length (coordinate_names c) -> nonzero v -> 0 < form (lower_weights places Y v) (map (fun row => (row, 0)) (M z)) v) ->
  Forall2 within box x -> Forall2 within box y -> joint_values c theta y = joint_values c theta x -> y = x.
Proof.
  intros c theta box places Y M x y co at_ hx hy e. apply same_values in e.
  destruct (at_ x hx) as [lx _]. destruct (at_ y hy) as [ly _]. assert (l : length x = length y) by congruence.
  set (d := map (fun p => snd p - fst p) (combine x y)).
  assert (ld : length d = length (coordinate_names c)) by (unfold d; rewrite map_length, combine_length, <- l, Nat.min_id; exact lx).
  assert (dn : forall k, nth k d 0 = nth k y 0 - nth k x 0).
  { intro k. pose proof (nth_way 1 x y k l) as W. assert (E : nth k d 0 = nth k (on_the_way 1 x y) 0 - nth k x 0); [| rewrite E, W; ring].
    unfold d, on_the_way. clear - l. revert y l k. induction x as [| a x IH]; intros [| b y] l k; try discriminate; destruct k as [| k]; cbn; try lra.
    apply (IH y). cbn in l. congruence. }
  destruct (Rlt_dec 0 (Linear.dot d d)) as [nz | z].
  - exfalso. set (w := lower_weights places Y d).
    assert (D : forall t, 0 <= t <= 1 -> derivable_pt_lim (fun s => weighted w (map (rho_of c theta (on_the_way s x y)) (joint_forms c))) t
      (form w (map (fun row => (row, 0)) (M (on_the_way t x y))) d)).
    { intros t ht. destruct (at_ _ (way_within t _ _ _ ht hx hy)) as [_ [R1 _]].
      apply (weighted_rate c theta (on_the_way t x y)); [exact ld | intro s; rewrite way_length by exact l; exact lx | reflexivity | | exact co | exact R1].
      intro k. eapply derivable_eq with (f := fun s => nth k x 0 + s * (nth k y 0 - nth k x 0));
        [apply derivable_add; [apply derivable_const | apply derivable_pt_lim_mult; [apply derivable_pt_lim_id | apply derivable_pt_lim_const]]
        | intro s; cbn beta; apply nth_way, l | rewrite dn; unfold fct_cte; ring]. }
    destruct (MeanValue.mean_value_theorem _ _ 0 1 ltac:(lra) D) as [t [E ht]]. cbn beta in E.
    destruct (at_ _ (way_within t _ _ _ ht hx hy)) as [_ [_ pos]]. specialize (pos d ld nz). fold w in pos.
    destruct (on_the_way_ends x y l) as [W0 W1]. rewrite W0, W1, e in E. lra.
  - apply nth_ext with 0 0; [congruence |]. intros k _. pose proof (zero_vector d ltac:(lra)) as Z. specialize (dn k).
    destruct (nth_in_or_default k d 0) as [i | i]; [rewrite Forall_forall in Z; specialize (Z _ i) | rewrite i in dn; lra]. lra.
Qed.

(** *** Accuracy *)

Lemma shifted_derivative : forall g l t, derivable_pt_lim (fun s => g (t + s)) 0 l -> derivable_pt_lim g t l.
Proof. intros g l t H eps e0. destruct (H eps e0) as [delta D]. exists delta. intros u nz small. specialize (D u nz small). rewrite Rplus_0_r, Rplus_0_l in D. exact D. Qed.
Lemma unshifted_derivative : forall g l t, derivable_pt_lim g t l -> derivable_pt_lim (fun s => g (t + s)) 0 l.
Proof. intros g l t H eps e0. destruct (H eps e0) as [delta D]. exists delta. intros u nz small. specialize (D u nz small). rewrite Rplus_0_r, Rplus_0_l. exact D. Qed.

(** Off by u, of n coordinates. *)
Lemma off_entries : forall x u d i, length x = length u -> nth i (Near.moved d x u) 0 = nth i x 0 + d * nth i u 0.
Proof. intros x u d. revert u. induction x as [| a x IH]; intros [| b u] i l; try discriminate; cbn [Near.moved combine map fst snd]; [destruct i; cbn; ring |]. destruct i as [| i]; [reflexivity |]. exact (IH u i ltac:(cbn in l; congruence)). Qed.

Section Located.
Variables (tape : list (op address)) (whole divided : rows nat) (partial : list nat) (params : list fixed).
Variables (c : mechanism) (theta x tb : list R) (fs : list pose_formulas) (error b angle : number).
Let n := length (coordinate_names c).
Let th := theta ++ tb.
Let ps := exact_parameters (parameters c).
Let found := place (formulas tape).
Let js := map d_joint fs.
Let es := joint_forms c.
Let dist := Claim.value b.
Hypothesis are_coordinates : forallb (fun j => match j with ByRow _ => false | ByCoordinate _ => true end) es = true.
Hypothesis x_length : length x = n.
Hypothesis enclosed : forall th', Forall2 scaled_within ps th' -> Forall2 (contains bits) params (th' ++ tb).
Hypothesis theta_within : Forall2 scaled_within ps theta.
(** What the formulas are wherever those that have to be are defined, and those of joint coordinates of every machine. *)
Hypothesis at_ : forall y, length y = n -> Forall (fun i => defined y th (formula_at tape i)) partial -> is_reached c theta y /\
  Forall2 (is_row c theta y) es (map (map (value y th)) (map d_divided fs)).
Hypothesis forms : Forall2 (fun e fm => exists g, d_joint fm = ELength g /\ forall th', Forall2 scaled_within ps th' -> rho_of c th' x e = value x (th' ++ tb) g) es fs.
Hypothesis all_found : forall f, In f (located_own ps (map d_divided fs) (pose_divided fs) js) -> formula_at tape (found f) = f.
Hypothesis shown : forall o, In o (located_tests bits found n n [false] false ps 0 (map d_divided fs) (pose_divided fs) js (Some (Fixed.integer bits 1)) error b) ->
  exists t, o = Some t /\ Check.holds bits tape whole divided partial params th n x t.

Lemma real_coordinates : forall th' y, joint_values c th' y = map Length (map (rho_of c th' y) es).
Proof.
  intros th' y. unfold joint_values, es in *. rewrite map_map. rewrite forallb_forall in are_coordinates. apply map_ext_in. intros j i. specialize (are_coordinates j i). destruct j; [discriminate | reflexivity].
Qed.
Lemma near_is : forall u, length u = n -> Spread.near_point n x dist 1 u = Near.moved dist x u.
Proof.
  intros u lu. unfold Spread.near_point. rewrite !firstn_all2, !skipn_all2 by lia. rewrite lu, Nat.sub_diag. cbn [repeat]. cbn [Near.moved combine map app]. rewrite !app_nil_r. reflexivity.
Qed.

Theorem forms_located : forms_recover c theta x error b angle.
Proof.
  unfold located_tests in shown.
  destruct (enclose_parameter bits (exactly b, 0%Z)) as [dd |] eqn:ed; [| destruct (shown None (or_introl eq_refl)) as [t [e _]]; discriminate].
  destruct (all_some (map (joint_near bits found ps 0 error b) js)) as [joints |] eqn:ej; [| destruct (shown None (or_introl eq_refl)) as [t [e _]]; discriminate].
  destruct (Nat.eqb (length js) n && Compare.certainly bits false error && Compare.certainly bits true b) eqn:g; [| destruct (shown None (or_introl eq_refl)) as [t [e _]]; discriminate].
  apply andb_true_iff in g as [g b0]. apply andb_true_iff in g as [ln _]. apply Nat.eqb_eq in ln. apply Compare.positive_sound in b0. fold dist in b0.
  set (a := Nearby.Nearby (map (map found) (map d_divided fs)) (map_rows found (pose_divided fs)) (map found (flat_map Drives.joint_forms js)) joints false dd (Fixed.integer bits 1) n false) in *.
  destruct (shown (Some (Located a)) (or_introl eq_refl)) as [t [et HL]]. injection et as <-. clear shown. cbn [Check.holds] in HL.
  assert (t1 : two_to 0 = 1) by reflexivity.
  assert (HD : contains bits dd dist) by (replace dist with (Claim.value b / two_to 0) by (rewrite t1; unfold dist; field); exact (enclose_parameter_sound bits _ _ _ ed (exact_within b 0))).
  destruct HL as [DEF [_ [_ [_ HL]]]]. destruct (HL dist 1 HD (Fixed.integer_sound bits 1) (Rlt_le _ _ b0) Rle_0_1) as [_ [g [g0 [G1 [kappa [z [e [k1 [k2 [k3 [k4 [k5 [k6 k7]]]]]]]]]]]]]. clear HL. cbn [a Nearby.l_first Nearby.l_rows Nearby.l_joints Nearby.l_defined] in *.
  set (near := fun u => Near.moved dist x u).
  assert (lf : length fs = n) by (rewrite <- ln; unfold js; rewrite map_length; reflexivity). assert (le : length es = n) by (rewrite (related_length _ _ _ _ _ forms); exact lf).
  assert (lnear : forall u, length u = n -> length (near u) = n) by (intros u lu; unfold near; rewrite Spread.moved_length; congruence).
  assert (enear : forall u i, length u = n -> nth i (near u) 0 = nth i x 0 + dist * nth i u 0) by (intros u i lu; apply off_entries; congruence).
  set (J := fun u => map (map (value (near u) th)) (map d_divided fs)).
  assert (InFar : forall fm f, In fm fs -> In f (d_divided fm) -> formula_at tape (found f) = f)
    by (intros fm f i1 i2; apply all_found; unfold located_own; apply in_or_app; left; apply in_concat; exists (d_divided fm); split; [apply in_map, i1 | exact i2]).
  assert (JE : forall u, length u = n -> Check.far_at tape th x a dist 1 u = J u).
  { intros u lu. unfold Check.far_at, Check.near_at. cbn [a Nearby.l_far Nearby.l_first]. rewrite near_is by exact lu. fold (near u). unfold J. rewrite !map_map. apply map_ext_in. intros fm i. rewrite map_map. apply map_ext_in. intros f i'.
    rewrite (InFar fm f i i'). reflexivity. }
  assert (AT : forall u, length u = n /\ Twofold.norm n u <= 1 -> is_reached c theta (near u) /\ Forall2 (is_row c theta (near u)) es (J u)).
  { intros u hu. apply at_; [exact (lnear u (proj1 hu)) |]. destruct (G1 u hu) as [d _]. apply Forall_app in d as [d _]. unfold Check.near_at in d. cbn [a Nearby.l_first] in d. rewrite near_is in d by apply hu. exact d. }
  assert (hz : length (Twofold.nought n) = n /\ Twofold.norm n (Twofold.nought n) <= 1) by (split; [apply Twofold.nought_length | pose proof (Twofold.nought_norm n n); lra]).
  assert (NZ : near (Twofold.nought n) = x).
  { apply Twofold.same_entries; [rewrite lnear; [congruence | apply hz] |]. intro i. rewrite enear, Twofold.nought_entries by apply hz. ring. }
  intros rho hr is_at.
  (* joint coordinates that are asked for *)
  assert (RHO : exists ys, rho = map Length ys /\ length ys = n /\ Forall2 (may_be_off bits tape params x) joints (map (fun p => (snd p - rho_of c theta x (fst p)) / dist) (combine es ys))).
  { assert (EM : map (fun p : string * tolerance => middle (snd p)) (parameters c) = map middle_of ps) by (unfold ps, exact_parameters; rewrite map_map; apply map_ext; intro p; unfold middle_of; cbn [fst snd]; rewrite t1; field).
    rewrite EM, real_coordinates in hr. clear EM.
    assert (MW : Forall2 scaled_within ps (map middle_of ps)).
    { pose proof (on_the_way_within 1 ps theta ltac:(lra) theta_within) as w. rewrite (proj2 (on_the_way_ends theta (map middle_of ps) ltac:(rewrite map_length; symmetry; exact (related_length _ _ _ _ _ theta_within)))) in w. exact w. }
    pose proof (all_some_each _ _ _ _ _ ej) as EJ. unfold js in EJ.
    assert (IN : forall fm g0, In fm fs -> d_joint fm = ELength g0 -> (forall q, In q (g0 :: map snd (slopes_of ps g0)) -> formula_at tape (found q) = q) /\ forall th', Forall2 (contains bits) params th' -> defined x th' g0).
    { intros fm g1 im eg. assert (ij : In (ELength g1) js) by (unfold js; rewrite <- eg; apply in_map, im).
      assert (F : forall q, In q (g1 :: map snd (slopes_of ps g1)) -> formula_at tape (found q) = q).
      { intros q iq. apply all_found. unfold located_own. apply in_or_app; right. apply in_or_app; right. apply in_flat_map. exists (ELength g1). split; [exact ij | exact iq]. }
      split; [exact F |]. intros th' h. specialize (DEF th' h). rewrite Forall_forall in DEF. specialize (DEF (found g1)). change (nth (found g1) (formulas tape) (integer 0)) with (formula_at tape (found g1)) in DEF.
      rewrite (F g1 (or_introl eq_refl)) in DEF. apply DEF, in_map, in_flat_map. exists (ELength g1). split; [exact ij | left; reflexivity]. }
    pose proof forms as FO. clear - hr FO EJ IN MW theta_within enclosed b0 t1 le lf. unfold es in *. revert rho hr joints EJ IN. rewrite <- le. clear le lf. 
    induction FO as [| j fm es' fs' [g1 [eg hg]] hs IH]; intros rho hr joints EJ IN; cbn [map] in hr, EJ; inversion hr as [| ? r ? rho' r1 r2]; subst; inversion EJ as [| ? jt ? joints' j1 j2]; subst; [exists []; repeat split; constructor |].
    destruct (IH rho' r2 joints' j2 (fun y g2 iy => IN y g2 (or_intror iy))) as [ys [y1 [y2 y3]]]. destruct r as [y' | ? ? |]; cbn [is_off] in r1; try contradiction.
    exists (y' :: ys). split; [cbn [map]; congruence |]. split; [cbn [length]; congruence |]. cbn [combine map fst snd]. constructor; [| exact y3].
    destruct (IN fm g1 (or_introl eq_refl) eg) as [F D]. rewrite eg in j1. cbn [joint_near] in j1.
    assert (Ej : fst jt = found g1) by (unfold joint_test in j1; destruct (enclose_parameter bits _); [| discriminate]; destruct (changes_of _ _ _ _ _ _); [| discriminate]; injection j1 as <-; reflexivity).
    pose proof (joint_is_off bits 0 b error ps theta tb params tape g1 x y' _ _ jt theta_within enclosed (eq_sym (hg theta theta_within)) (eq_sym (hg _ MW)) F j1) as K. cbv zeta in K. rewrite t1, Rinv_1, !Rmult_1_l in K.
    apply K; [intros th' h; rewrite Ej, (F g1 (or_introl eq_refl)); exact (D th' h) | exact b0 | exact r1]. }
  destruct RHO as [ys [er [ly OFF]]]. set (bs := map (fun p => (snd p - rho_of c theta x (fst p)) / dist) (combine es ys)) in *.
  set (vals := fun u => map (fun e => rho_of c theta (near u) e / dist) es).
  assert (lb : length bs = n) by (unfold bs; rewrite map_length, combine_length; lia).
  destruct (Twofold.one_point n n vals J g bs) as [u [[hu eu] only]]; try assumption.
  - intro u. unfold vals. rewrite map_length. exact le.
  - intro u. unfold J. rewrite !map_length. exact lf.
  - destruct (AT _ hz) as [_ R0]. rewrite forallb_forall in are_coordinates. clear - R0 are_coordinates. induction R0 as [| j row es' M h hs IH]; constructor; [| apply IH; intros y i; apply are_coordinates; right; exact i].
    specialize (are_coordinates j (or_introl eq_refl)). destruct j; [discriminate | exact (proj1 h)].
  - intros u v hu hv t ht i li. set (d := Twofold.less v u). pose proof (Twofold.on_segment n n u v t hu hv ht) as hs. fold d in hs.
    assert (ld : length d = n) by (apply Twofold.less_length; [apply hv | apply hu]).
    assert (lcomb : forall s, length (comb 1 s u d) = n) by (intro s; rewrite Twofold.comb_length; [apply hu | rewrite ld; apply hu]).
    destruct (AT _ hs) as [_ R0]. pose proof (Onward.at_index _ _ _ _ _ R0 i (ByRow []) [] ltac:(unfold J; rewrite !map_length, lf; exact li)) as hrow. set (ej_ := nth i es (ByRow [])) in *.
    assert (ic : match ej_ with ByRow _ => false | ByCoordinate _ => true end = true) by (rewrite forallb_forall in are_coordinates; apply are_coordinates, nth_In; rewrite le; exact li).
    assert (E : forall s, nth i (vals (comb 1 s u d)) 0 = rho_of c theta (near (comb 1 s u d)) ej_ / dist).
    { intro s. unfold vals. rewrite (nth_indep _ 0 ((fun e => rho_of c theta (near (comb 1 s u d)) e / dist) (ByRow []))) by (rewrite map_length, le; exact li).
      rewrite (map_nth (fun e => rho_of c theta (near (comb 1 s u d)) e / dist)). reflexivity. }
    destruct ej_ as [| ex]; [discriminate |]. destruct hrow as [lrow H].
    assert (D : derivable_pt_lim (fun s => meaning (environment_at c theta (near (comb 1 s u d))) ex) t (Linear.dot (nth i (J (comb 1 t u d)) []) (map (Rmult dist) d))).
    { apply shifted_derivative. apply (H (fun s => near (comb 1 (t + s) u d)) (map (Rmult dist) d)); [intro s; apply lnear, lcomb | rewrite Rplus_0_r; reflexivity |].
      intro k. apply (unshifted_derivative (fun s => nth k (near (comb 1 s u d)) 0) _ t).
      eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_const (nth k x 0 + dist * nth k u 0) t) (derivable_scal (dist * nth k d 0) _ _ _ (derivable_pt_lim_id t))) | |].
      - intro s. rewrite enear by apply lcomb. rewrite Twofold.comb_entries. unfold id. ring.
      - rewrite Twofold.map_entries. ring. }
    eapply derivable_eq; [exact (derivable_scal (/ dist) _ _ _ D) | intro s; rewrite E; cbn [rho_of]; unfold Rdiv; ring |].
    rewrite (Solve.dot_commutes _ (map _ _)), dot_map, Solve.dot_commutes. field. lra.
  - intros u w hu lw. destruct (G1 u hu) as [_ h]. specialize (h w lw). rewrite JE, JE in h by (apply hu || apply hz). lra.
  - intros [|]; [left; cbn [Twofold.part]; apply skipn_all2; rewrite Twofold.nought_length; lia |]. right. exists kappa, z, e. repeat (split; [assumption |]). intros w lw. cbv zeta. specialize (k7 w lw). cbv zeta in k7.
    assert (ROWS : map fst (map_rows (value x th) (map_rows (formula_at tape) (map_rows found (pose_divided fs)))) = J (Twofold.nought n)).
    { assert (RF : map_rows (formula_at tape) (map_rows found (pose_divided fs)) = pose_divided fs) by (apply rows_found; intros q iq; apply all_found; unfold located_own; apply in_or_app; right; apply in_or_app; left; exact iq).
      rewrite RF. unfold J. rewrite NZ. unfold pose_divided, map_rows. rewrite !map_map. reflexivity. }
    rewrite ROWS in k7. destruct k7 as [c1 c2]. split; [exact c1 |]. intros s nz. exact (c2 bs s OFF nz).
  - assert (V0 : forall y, length y = n -> map (fun e => rho_of c theta y e / dist) es = comb 1 1 (vals (Twofold.nought n)) bs <-> joint_values c theta y = rho).
    { intros y ly'. rewrite real_coordinates, er. unfold vals, bs. rewrite NZ. fold es. clear - b0 le ly. rewrite <- le in ly. clear le. revert ys ly. generalize es. induction es0 as [| e es0 IH]; intros [| y0 ys] l; try discriminate; [split; reflexivity |].
      cbn [combine map comb merge fst snd]. fold (comb 1 1). destruct (IH ys ltac:(cbn in l; congruence)) as [I1 I2]. split; intro h; injection h as h1 h2.
      - f_equal; [f_equal; apply Rmult_eq_reg_r with (/ dist); [unfold Rdiv in h1; lra | apply Rinv_neq_0_compat; lra] | exact (I1 h2)].
      - f_equal; [rewrite h1; unfold Rdiv; ring | exact (I2 h2)]. }
    assert (Norm : forall u1, length u1 = n -> Twofold.norm n u1 <= 1 <-> Linear.dot u1 u1 <= 1).
    { intros u1 lu. split; intro h.
      - pose proof (Twofold.part_size n false u1) as p. cbn [Twofold.part] in p. rewrite firstn_all2 in p by lia. rewrite <- Twofold.size_square. pose proof (Twofold.size_nonneg u1). nra.
      - apply Twofold.norm_below. intro p. apply Twofold.size_below; [lra |]. pose proof (Twofold.part_dot n p u1). lra. }
    assert (Less : forall u1, length u1 = n -> Linear.dot (Twofold.less (near u1) x) (Twofold.less (near u1) x) = dist ^ 2 * Linear.dot u1 u1).
    { intros u1 lu. assert (E : Twofold.less (near u1) x = map (Rmult dist) u1).
      { apply Twofold.same_entries; [rewrite map_length, (Twofold.less_length n); auto |]. intro i. rewrite Twofold.less_entries, enear, Twofold.map_entries by exact lu. ring. }
      rewrite E, dot_map, Solve.dot_commutes, dot_map. ring. }
    exists (near u). split.
    + split; [rewrite lnear by apply hu; congruence |]. split; [rewrite Less by apply hu; fold dist; pose proof (proj1 (Norm u (proj1 hu)) (proj2 hu)); pose proof (pow2_ge_0 dist); nra |].
      split; [exact (proj1 (AT u hu)) | apply (V0 (near u) (lnear u (proj1 hu))); exact eu].
    + intros y [l1 [l2 [_ l4]]]. assert (ly' : length y = n) by congruence. set (v := map (Rmult (/ dist)) (Twofold.less y x)).
      assert (lv : length v = n) by (unfold v; rewrite map_length; apply Twofold.less_length; assumption).
      assert (NY : near v = y).
      { apply Twofold.same_entries; [rewrite lnear by exact lv; congruence |]. intro i. rewrite enear by exact lv. unfold v. rewrite Twofold.map_entries, Twofold.less_entries. field. lra. }
      assert (hv : length v = n /\ Twofold.norm n v <= 1).
      { split; [exact lv |]. apply Norm; [exact lv |]. pose proof (Less v lv) as q. rewrite NY in q. rewrite q in l2. fold dist in l2. assert (0 < dist ^ 2) by (apply pow_lt; exact b0). apply Rmult_le_reg_l with (dist ^ 2); lra. }
      rewrite <- NY. f_equal. apply only; [exact hv |]. unfold vals at 1. rewrite NY. apply (V0 y ly'). exact l4.
Qed.
End Located.

Theorem check_written_sound : forall c t, check_written c t = true -> written_holds c.
Proof.
  intros c t h theta x [hp hb]. unfold check_written in h. cbv zeta in h. set (f := by_formulas c) in *.
  set (n := length (coordinate_names f)) in *. set (j := length (parameters f)) in *. set (demands := written_demands c) in *.
  set (i := (j + length (all_literals (map snd (definitions f))))%nat) in *.
  set (env := named (given_formulas f) (definitions f) j) in *. set (fs := all_joints n env (joint_forms f) i) in *.
  set (partial := named_partials (given_formulas f) (definitions f) j ++ joints_partials env (joint_forms f) i) in *. set (at_ := length (inputs f)) in *.
  set (ps := exact_parameters (parameters f)) in *. set (js := map d_joint fs) in *.
  set (own_q := fun q d => match d with OnePose _ _ _ => located_own ps (map d_divided fs) (pose_divided fs) js | _ => own_of fs q d end) in *.
  set (wanted := entries (pose_rows fs) ++ entries (pose_divided fs) ++ partial ++ of_each own_q false 0 at_ demands) in *.
  set (tape := compile wanted) in *. set (place := place (formulas tape)) in *.
  set (tests_q := fun q d => match d with
    | OnePose error b _ => if forallb (fun j => match j with ByRow _ => false | ByCoordinate _ => true end) (joint_forms f)
        then located_tests bits place n n [false] false ps 0 (map d_divided fs) (pose_divided fs) js (Some (Fixed.integer bits 1)) error b else [None]
    | _ => tests_for bits place fs false 0 q d
    end) in *.
  apply andb_true_iff in h as [h C]. apply andb_true_iff in h as [h coords]. apply andb_true_iff in h as [h low]. apply andb_true_iff in h as [h found]. apply andb_true_iff in h as [len shapes]. apply Nat.eqb_eq in len.
  destruct (all_some (map (enclose_parameter bits) (inputs f))) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map (enclose_input bits) _)) as [numbers |] eqn:ei; [| discriminate].
  destruct (all_some (map _ (box_of c))) as [box |] eqn:eb; [| discriminate].
  destruct (all_some (of_each _ _ _ _ _)) as [tests |] eqn:et; [| discriminate].
  (* parameters of the tape: those of the mechanism, and the numbers in its formulas *)
  assert (P : Forall2 scaled_within (exact_parameters (parameters f)) theta).
  { unfold exact_parameters. clear - hp. induction hp; cbn [map]; constructor; auto. apply within_scaled; assumption. }
  assert (Lit : forall es, exists y, Forall2 scaled_within (all_literals es) y) by exact (exact_list written literals (fun e => ex_intro _ _ (literals_exact e))).
  destruct (Lit (map snd (definitions f))) as [y1 D].
  destruct (exact_list written_joint joint_literals (fun a => match a with ByRow es => Lit es | ByCoordinate e => ex_intro _ _ (literals_exact e) end) (joint_forms f)) as [y2 J].
  set (ins := flat_map (inputs_of false 0) demands) in *. set (th := theta ++ y1 ++ y2 ++ map input_value ins).
  assert (lt : length theta = j) by (unfold j; rewrite <- (related_length _ _ _ _ _ P); apply map_length).
  assert (T : Forall2 (contains bits) (params ++ numbers) th).
  { unfold th. rewrite !app_assoc. apply Forall2_app; [rewrite <- app_assoc; apply (enclosed_all bits _ _ _ ep); repeat apply Forall2_app; assumption |].
    clear - ei. revert numbers ei. induction ins as [| a l IH]; intros numbers e; cbn [map all_some] in *; [injection e as <-; constructor |].
    destruct (enclose_input bits a) as [b |] eqn:e1; [| discriminate]. destruct (all_some _) as [r |]; [| discriminate]. injection e as <-. constructor; [exact (enclose_input_sound bits _ _ e1) | exact (IH r eq_refl)]. }
  cbv zeta in C. set (all_tests := if one_to_one c then _ else _) in C.
  assert (Sub : forall u, In u tests -> In u all_tests) by (intros u iu; unfold all_tests; destruct (one_to_one c); [apply inserted_in; right |]; exact iu).
  (* at one point *)
  enough (At : forall x, Forall2 within (box_of c) x -> length x = n /\ exists M, Forall2 (is_row f theta x) (joint_forms f) M /\
    Configuration.meets n (machine_at f theta x M) demands /\
    M = map (map (value x th)) (map d_divided fs) /\
    (one_to_one c = true -> forall v, length v = n -> nonzero v -> 0 < form (lower_weights (fst one_matrix) (snd one_matrix) v) (map (fun row => (row, 0)) M) v)).
  { split; [destruct (At x hb) as [_ [M [R1 [R2 _]]]]; exists M; split; assumption |]. intros o y hy e. rewrite o in coords.
    apply (chords_differ f theta (box_of c) (fst one_matrix) (snd one_matrix) (fun z => map (map (value z th)) (map d_divided fs)) x y coords); try assumption.
    intros z hz. destruct (At z hz) as [lz [M [R1 [_ [EM R3]]]]]. rewrite <- EM. split; [exact lz |]. split; [exact R1 | exact (R3 o)]. }
  clear x hb. intros x hb.
  assert (X : Forall2 (contains bits) box x).
  { clear - eb hb. revert box eb. induction hb as [| b y bs ys h hs IH]; intros box e; cbn [map all_some] in e; [injection e as <-; constructor |].
    destruct (enclose_parameter bits (b, 0%Z)) as [a |] eqn:ea; [| discriminate]. destruct (all_some _) as [l |]; [| discriminate].
    injection e as <-. constructor; [exact (enclose_parameter_sound bits _ _ _ ea (within_scaled _ _ h)) | auto]. }
  assert (lx : length x = n) by (rewrite <- (related_length _ _ _ _ _ hb); exact len).
  assert (lb : length box = n) by (rewrite (related_length _ _ _ _ _ X); exact lx).
  assert (H1 : holds_at th j (all_literals (map snd (definitions f)))) by (rewrite <- lt; apply holds_at_of; exact D).
  assert (Agree : forall y, length y = n -> agrees y th env (environment_at f theta y) /\
    (Forall (defined y th) (named_partials (given_formulas f) (definitions f) j) -> all_defined (given f y theta) (definitions f))).
  { intros y ly. apply named_agrees; [| exact H1]. apply agrees_combine.
    - rewrite map_map. fold n. rewrite <- ly. clear. change (map (fun k => nth k y 0) (seq 0 (length y)) = y).
      apply nth_ext with 0 0; rewrite map_length, seq_length; [reflexivity |]. intros k hk.
      rewrite (nth_indep _ 0 (nth 0 y 0)) by (rewrite map_length, seq_length; exact hk). rewrite (map_nth (fun k => nth k y 0)), seq_nth by exact hk. reflexivity.
    - rewrite <- (app_nil_r (combine _ (numbered _ _))), <- (app_nil_r (combine _ theta)). apply agrees_combine; [| intro; reflexivity].
      exact (numbered_values _ _ y [] (y1 ++ y2 ++ map input_value ins) P). }
  assert (TE : forall th', Forall2 scaled_within ps th' -> Forall2 (contains bits) (params ++ numbers) (th' ++ y1 ++ y2 ++ map input_value ins)).
  { intros th' h'. rewrite (app_assoc y1), (app_assoc th'). apply Forall2_app; [apply (enclosed_all bits _ _ _ ep); apply Forall2_app; [exact h' | apply Forall2_app; assumption] |].
    clear - ei. revert numbers ei. induction ins as [| a l IH]; intros numbers e; cbn [map all_some] in *; [injection e as <-; constructor |].
    destruct (enclose_input bits a) as [b |] eqn:e1; [| discriminate]. destruct (all_some _) as [r |]; [| discriminate]. injection e as <-. constructor; [exact (enclose_input_sound bits _ _ e1) | exact (IH r eq_refl)]. }
  assert (HoldAll : forall th', Forall2 scaled_within ps th' -> holds_at (th' ++ y1 ++ y2 ++ map input_value ins) i (flat_map joint_literals (joint_forms f))).
  { intros th' h'. pose proof (holds_at_of (th' ++ y1) _ y2 (map input_value ins) J) as K. rewrite <- app_assoc in K. unfold i.
    replace (j + length (all_literals (map snd (definitions f))))%nat with (length (th' ++ y1)); [exact K |].
    rewrite app_length. f_equal; [unfold j; rewrite <- (related_length _ _ _ _ _ h'); apply map_length | symmetry; exact (related_length _ _ _ _ _ D)]. }
  assert (AgreeAll : forall th', Forall2 scaled_within ps th' -> forall y, length y = n -> agrees y (th' ++ y1 ++ y2 ++ map input_value ins) env (environment_at f th' y)).
  { intros th' h' y ly. assert (lj : length th' = j) by (unfold j; rewrite <- (related_length _ _ _ _ _ h'); apply map_length).
    refine (proj1 (named_agrees y (th' ++ y1 ++ y2 ++ map input_value ins) (definitions f) (given_formulas f) (given f y th') j _ _)); [| rewrite <- lj; apply holds_at_of; exact D].
    apply agrees_combine.
    - rewrite map_map. fold n. rewrite <- ly. clear. change (map (fun k => nth k y 0) (seq 0 (length y)) = y).
      apply nth_ext with 0 0; rewrite map_length, seq_length; [reflexivity |]. intros k hk.
      rewrite (nth_indep _ 0 (nth 0 y 0)) by (rewrite map_length, seq_length; exact hk). rewrite (map_nth (fun k => nth k y 0)), seq_nth by exact hk. reflexivity.
    - rewrite <- (app_nil_r (combine _ (numbered _ _))), <- (app_nil_r (combine _ th')). apply agrees_combine; [| intro; reflexivity].
      exact (numbered_values _ _ y [] (y1 ++ y2 ++ map input_value ins) h'). }
  assert (H2 : holds_at th i (flat_map joint_literals (joint_forms f))).
  { pose proof (holds_at_of (theta ++ y1) _ y2 (map input_value ins) J) as K. rewrite <- app_assoc in K. unfold i, th.
    replace (j + length (all_literals (map snd (definitions f))))%nat with (length (theta ++ y1)); [exact K |].
    rewrite app_length, lt. f_equal. symmetry. exact (related_length _ _ _ _ _ D). }
  assert (Found : forall e, In e wanted -> formula_at tape (place e) = e) by (rewrite forallb_forall in found; intros e k; apply Formula.same_sound, found, k).
  pose proof (check_all_open bits tape _ _ _ (params ++ numbers) all_tests (fun _ => None) th T (fun _ => True)
    (fun _ _ _ _ e => ltac:(discriminate e)) t box x C X I) as H. rewrite lb in H.
  assert (la : length (theta ++ y1 ++ y2) = at_).
  { symmetry. unfold at_. apply (related_length _ _ scaled_within). unfold inputs. repeat apply Forall2_app; assumption. }
  assert (HT : forall d, In d demands -> exists q, map (value x th) q = map input_value (inputs_of false 0 d) /\
    (forall g, In g (own_q q d) -> formula_at tape (place g) = g) /\
    (forall o, In o (tests_q q d) -> exists t, o = Some t /\
      Check.holds bits tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place partial) (params ++ numbers) th n x t)).
  { intros d id. destruct (of_each_at false 0 demands d x (theta ++ y1 ++ y2) [] id) as [q [q1 q2]]. cbv zeta in q1. fold ins in q1.
    rewrite app_nil_r, <- !app_assoc in q1. fold th in q1. rewrite la in q2. exists q. split; [exact q1 |]. split.
    - intros g k. apply Found. unfold wanted. do 3 (apply in_or_app; right). exact (q2 _ _ _ k).
    - intros o k. destruct (all_some_in _ _ _ _ et (q2 _ tests_q o k)) as [u [e iu]]. exists u. split; [exact e | exact (H u (Sub u iu))]. }
  assert (Low : exists low c0, contains bits low c0 /\ 0 <= c0 /\ Check.holds bits tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place partial) (params ++ numbers) th n x (SigmaMin low)).
  { apply existsb_exists in low as [d [id e]]. destruct (HT d id) as [q [_ [_ q3]]]. destruct d; try discriminate; cbn [tests_q tests_for] in q3; destruct (q3 _ ltac:(left; reflexivity)) as [u [e1 hu]].
    - injection e1 as <-. exists zero, 0. split; [apply zero_sound |]. split; [lra | exact hu].
    - destruct (enclose_parameter bits _) as [a |] eqn:ew; [| discriminate]. injection e1 as <-. eexists; eexists. split; [exact (squared_rate bits 0 false _ _ ew) |]. split; [apply pow2_ge_0 | exact hu]. }
  destruct Low as [lowest [c0 [hc0 [c00 [BU LOW]]]]].
  assert (DP : Forall (defined x th) partial).
  { apply Forall_forall. intros g k. rewrite Forall_map, Forall_forall in BU. specialize (BU g k). rewrite Found in BU; [exact BU |]. unfold wanted. apply in_or_app. right. apply in_or_app. right. apply in_or_app. left. exact k. }
  apply Forall_app in DP as [DP1 DP2].
  assert (SH : Forall (fun j => match j with ByRow es => length es = n | ByCoordinate _ => True end) (joint_forms f)).
  { rewrite forallb_forall in shapes. apply Forall_forall. intros q k. specialize (shapes q k). destruct q; [apply Nat.eqb_eq, shapes | exact I]. }
  destruct (joints_good f theta th x env (fun y ly => proj1 (Agree y ly)) lx (joint_forms f) i H2 SH DP2) as [JD [M [RM good]]].
  split; [exact lx |]. exists M. split; [exact RM |]. set (looks := map (fun p => Seen (snd p) (coordinate_at f theta x (fst p)) None True) (combine (joint_forms f) M)) in *.
  assert (lM : length M = length (joint_forms f)) by (symmetry; exact (related_length _ _ _ _ _ RM)).
  assert (E1 : map seen_row looks = M /\ map seen_joint looks = map (coordinate_at f theta x) (joint_forms f) /\ map seen_rod looks = map (fun _ => None) (joint_forms f)).
  { unfold looks. clear - lM. revert M lM. induction (joint_forms f) as [| a l IH]; intros [| r M] e; try discriminate; [repeat split |]. destruct (IH M ltac:(cbn in e; congruence)) as [I1 [I2 I3]]. cbn [combine map seen_row seen_joint seen_rod fst snd]. rewrite I1, I2, I3. repeat split. }
  destruct E1 as [E1 [E2 E3]].
  assert (W1 : forall e, In e (entries (pose_rows fs)) -> formula_at tape (place e) = e) by (intros e k; apply Found, in_or_app; left; exact k).
  assert (W2 : forall e, In e (entries (pose_divided fs)) -> formula_at tape (place e) = e) by (intros e k; apply Found, in_or_app; right; apply in_or_app; left; exact k).
  destruct (of_rows_energy x th 0 n false fs looks (fun b => b) tape good W1 W2 _ LOW) as [RE _].
  pose proof (low_sees bits x th 0 n false fs looks (fun b => b) tape (params ++ numbers) (map place partial) good W1 W2 lowest c0 hc0 c00 (conj BU LOW)) as SEES.
  split.
  2: { assert (EM : M = map (map (value x th)) (map d_divided fs)).
    { assert (g0 : Forall2 (is_good x th 0 n false) fs (map (fun p => Seen (snd p) (coordinate_at f theta x (fst p)) None True) (combine (joint_forms f) M))) by exact good. clear - g0 lM. revert M lM g0. generalize fs. clear. induction (joint_forms f) as [| jo js IH]; intros qs [| row M] l h; try discriminate l; cbn [combine map] in h; inversion h as [| q ? ? ? g hs]; subst; [reflexivity |].
      cbn [map]. f_equal; [| apply IH; [cbn in l; congruence | exact hs]]. destruct g as [_ [_ [_ [_ [_ g]]]]]. destruct (g I) as [_ [g' _]]. rewrite g'.
      change (/ two_to (rate false 0)) with (/ two_to 0). change (two_to 0) with 1. cbn [seen_row fst snd]. rewrite <- (map_id row) at 1. apply map_ext. intro. field. }
    split; [exact EM |]. intros o v lv nz. pose proof (H (Chords (map_rows place (pose_divided fs)) (fst one_matrix) (snd one_matrix))) as K.
    unfold all_tests in K. rewrite o in K. destruct (K (proj2 (inserted_in _ _ _ _ _) (or_introl eq_refl))) as [_ G].
    replace (map_rows (formula_at tape) (map_rows place (pose_divided fs))) with (pose_divided fs) in G by (symmetry; exact (rows_found tape _ W2)).
    specialize (G v lv nz). rewrite EM. unfold pose_divided, map_rows in G. rewrite !map_map in *. exact G. }
  split; [split; [exact (proj2 (Agree x lx) DP1) | exact JD] |]. split; [unfold Configuration.injective in *; cbn [jacobian] in SEES; rewrite E1 in SEES; exact SEES |].
  apply Forall_forall. intros d id. destruct (HT d id) as [q [q1 [q2 q3]]].
  assert (Other : (forall error b angle, d <> OnePose error b angle) -> Configuration.fulfils n (machine_at f theta x M) d).
  { intro no. assert (E4 : own_q q d = own_of fs q d) by (destruct d; try reflexivity; contradiction (no _ _ _ eq_refl)). assert (E5 : tests_q q d = tests_for bits place fs false 0 q d) by (destruct d; try reflexivity; contradiction (no _ _ _ eq_refl)).
    rewrite E4 in q2. rewrite E5 in q3.
    pose proof (demand_met bits x th 0 n false fs looks (fun b => b) tape (params ++ numbers) (map place partial) good W1 W2 RE q d q1 q2 q3 SEES) as met.
    rewrite E1, E2, E3 in met. exact (reached_aside _ _ _ _ _ _ _ _ _ _ _ met). }
  destruct d as [| | | | | | | | | | | | | | | | | error b angle | ]; try (apply Other; discriminate). clear Other. cbn [Configuration.fulfils recovers machine_at]. cbn [own_q tests_q] in q2, q3.
  destruct (forallb (fun j => match j with ByRow _ => false | ByCoordinate _ => true end) (joint_forms f)) eqn:co; [| destruct (q3 None (or_introl eq_refl)) as [u [eu _]]; discriminate].
  refine (forms_located tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place partial) (params ++ numbers) f theta x (y1 ++ y2 ++ map input_value ins) fs error b angle co lx TE P _ _ q2 q3).
  - intros y ly D'. assert (DY : Forall (defined y th) partial).
    { apply Forall_forall. intros g k. rewrite Forall_map, Forall_forall in D'. specialize (D' g k). rewrite Found in D'; [exact D' |]. unfold wanted. apply in_or_app. right. apply in_or_app. right. apply in_or_app. left. exact k. }
    apply Forall_app in DY as [DY1 DY2]. destruct (joints_good f theta th y env (fun z lz => proj1 (Agree z lz)) ly (joint_forms f) i H2 SH DY2) as [JDy [My [RMy goody]]].
    split; [split; [exact (proj2 (Agree y ly) DY1) | exact JDy] |].
    assert (gy : Forall2 (is_good y th 0 n false) fs (map (fun p => Seen (snd p) (coordinate_at f theta y (fst p)) None True) (combine (joint_forms f) My))) by exact goody. clear goody.
    assert (EMy : My = map (map (value y th)) (map d_divided fs)).
    { pose proof (related_length _ _ _ _ _ RMy) as lMy. clear - gy lMy. revert My lMy gy. generalize fs. clear. induction (joint_forms f) as [| jo js IH]; intros qs [| row M] l h; try discriminate l; cbn [combine map] in h; inversion h as [| q ? ? ? g hs]; subst; [reflexivity |].
      cbn [map]. f_equal; [| apply IH; [cbn in l; congruence | exact hs]]. destruct g as [_ [_ [_ [_ [_ g]]]]]. destruct (g I) as [_ [g' _]]. rewrite g'.
      change (/ two_to (rate false 0)) with (/ two_to 0). change (two_to 0) with 1. cbn [seen_row fst snd]. rewrite <- (map_id row) at 1. apply map_ext. intro. field. }
    rewrite EMy in RMy. exact RMy.
  - assert (K : forall es0 i0, (forall th', Forall2 scaled_within ps th' -> holds_at (th' ++ y1 ++ y2 ++ map input_value ins) i0 (flat_map joint_literals es0)) ->
      forallb (fun j => match j with ByRow _ => false | ByCoordinate _ => true end) es0 = true ->
      Forall2 (fun e fm => exists g, d_joint fm = ELength g /\ forall th', Forall2 scaled_within ps th' -> rho_of f th' x e = value x (th' ++ y1 ++ y2 ++ map input_value ins) g) es0 (all_joints n env es0 i0)).
    { induction es0 as [| jo es0 IH]; intros i0 hold cc; cbn [all_joints]; constructor.
      - cbn [forallb] in cc. apply andb_true_iff in cc as [cj _]. destruct jo as [| e]; [discriminate |]. exists (formula_of env e i0). split; [cbn [of_joint]; destruct (coordinate_gradient n (formula_of env e i0)); reflexivity |].
        intros th' h'. cbn [rho_of]. symmetry. apply formula_value; [exact (AgreeAll th' h' x lx) |]. specialize (hold th' h'). cbn [flat_map joint_literals] in hold. apply holds_app in hold as [hold _]. exact hold.
      - apply IH; [intros th' h'; specialize (hold th' h'); cbn [flat_map] in hold; apply holds_app in hold as [_ hold]; exact hold |]. cbn [forallb] in cc. apply andb_true_iff in cc as [_ cc]. exact cc. }
    apply K; [exact HoldAll | exact co].
Qed.
End Precision.

(** ** Well-formed mechanisms, and claims that are about something *)

(** Names that stand for something. *)
Fixpoint is_bound_in (ns : list string) (e : written) : bool :=
  match e with
  | Constant _ => true
  | Named n => existsb (String.eqb n) ns
  | Opposite a | Raised a _ | RootOf a => is_bound_in ns a
  | Sum a b | Difference a b | Product a b | Quotient a b => is_bound_in ns a && is_bound_in ns b
  end.
Fixpoint are_bound_in (ns : list string) (ds : list (string * written)) : bool :=
  match ds with
  | [] => true
  | (n, e) :: ds' => negb (existsb (String.eqb n) ns) && is_bound_in ns e && are_bound_in (n :: ns) ds'
  end.
Fixpoint differ (ns : list string) : bool :=
  match ns with [] => true | n :: l => negb (existsb (String.eqb n) l) && differ l end.
Definition is_mechanism (c : mechanism) : bool :=
  let given := coordinate_names c ++ map fst (parameters c) in
  let n := length (coordinate_names c) in
  Nat.leb 1 n && Nat.leb n 6 && Nat.leb n (length (joint_forms c)) && Nat.leb (length (joint_forms c)) 12 && differ given && are_bound_in given (definitions c) &&
  forallb (fun j => forallb (is_bound_in (map fst (definitions c) ++ given)) match j with ByRow es => es | ByCoordinate e => [e] end) (joint_forms c).

Definition certify_written (exact bits : positive) (one_matrix : N * list (list Z)) (one_place : nat) (c : written_claim) (t : tree) : bool :=
  is_mechanism (by_formulas c) && forallb (fun p => below exact (least (snd p)) (greatest (snd p))) (parameters (by_formulas c)) &&
  forallb (fun b => below exact (least b) (greatest b)) (box_of c) && check_written bits one_matrix one_place c t.

Theorem certify_written_sound : forall exact bits one_matrix one_place c t, certify_written exact bits one_matrix one_place c t = true ->
  written_holds c /\ exists theta x, is_about_written c theta x.
Proof.
  intros exact bits one_matrix one_place c t h. apply andb_true_iff in h as [h k]. apply andb_true_iff in h as [h b]. apply andb_true_iff in h as [_ p].
  split; [exact (check_written_sound bits one_matrix one_place c t k) |]. exists (map (fun p => Claim.value (least (snd p))) (parameters (by_formulas c))), (map (fun b => Claim.value (least b)) (box_of c)).
  rewrite forallb_forall in p, b. split.
  - induction (parameters (by_formulas c)) as [| q l IH]; cbn [map]; constructor; [| apply IH; intros y i; apply p; right; exact i].
    specialize (p q (or_introl eq_refl)). apply below_sound in p. unfold within. lra.
  - induction (box_of c) as [| q l IH]; cbn [map]; constructor; [| apply IH; intros y i; apply b; right; exact i].
    specialize (b q (or_introl eq_refl)). apply below_sound in b. unfold within. lra.
Qed.
End Named.
