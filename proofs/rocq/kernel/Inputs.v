(** * Numbers of what is asked, as formulas have them: in a unit, or the cosine of an angle *)

From Coq Require Import ZArith Reals Lra List Bool.
From Orthocert Require Import Vec3 Fixed Claim.
From Orthocert.kernel Require Import Statement Linear Arithmetic Test Check Number Trig Formula Machine Problem Configuration Orientation.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Units: section 7.3 of FORMAT.md *)
Definition exact_bits : positive := 512.
Definition order_of (xs : list number) : Z :=
  let size x := match enclose exact_bits x with Some a => Z.max (Z.abs (Fixed.lo a)) (Z.abs (Fixed.hi a)) | None => 0%Z end in
  let most := fold_right (fun x m => Z.max (size x) m) 0%Z xs in
  if (0 <? most)%Z then (Z.log2 most - Zpos exact_bits)%Z else 0%Z.
Definition ends (t : tolerance) : list number := [least t; greatest t].
Definition ends3 (t : tolerances) : list number := (ends (tx t) ++ ends (ty t) ++ ends (tz t))%list.
(** No vector within the tolerances is zero. *)
Definition is_never_zero (t : tolerances) : bool := is_nonzero exact_bits t (order_of (ends3 t)).
Lemma is_never_zero_sound : forall t v, is_never_zero t = true -> all_within t v -> 0 < norm2 v.
Proof. intros t v h. exact (is_nonzero_sound exact_bits _ _ v h). Qed.

(** ** Numbers of a demand that are in formulas *)

(** An exact number, an angle in radians over 2^u, the cosine or sine of an angle in degrees, or the tangent of half of one over 2^u. *)
Inductive input := InUnit (x : number) (u : Z) | Radians (x : number) (u : Z) | Cosine (x : number) | Sine (x : number) | Tangent (x : number) (u : Z).
Definition input_value (i : input) : R :=
  match i with
  | InUnit x u => Claim.value x / two_to u
  | Radians x u => in_degrees (Claim.value x / two_to u)
  | Cosine x => cos (in_degrees (Claim.value x))
  | Sine x => sin (in_degrees (Claim.value x))
  | Tangent x u => tangent (Claim.value x) / two_to u
  end.
Definition input_formula (i : input) (j : nat) : formula := match i with InUnit x u => quantity (exactly x, u) j | _ => F (Param j) end.
Fixpoint input_formulas (j : nat) (l : list input) : list formula :=
  match l with [] => [] | i :: l' => input_formula i j :: input_formulas (S j) l' end.

Lemma exact_within : forall x u, scaled_within (exactly x, u) (Claim.value x / two_to u).
Proof. intros x u. exists (Claim.value x). split; [split; apply Rle_refl | reflexivity]. Qed.
Lemma input_formulas_value : forall l x front back, map (Formula.value x (front ++ map input_value l ++ back)) (input_formulas (length front) l) = map input_value l.
Proof.
  induction l as [| i l IH]; intros x front back; [reflexivity |]. cbn [map input_formulas app]. f_equal.
  - destruct i as [y u | | | |]; cbn [input_formula]; [apply quantity_value; [exact (exact_within y u) |] | | | |]; apply nth_middle.
  - specialize (IH x (front ++ [input_value i]) back). rewrite app_length, <- app_assoc in IH. cbn [length app] in IH. rewrite Nat.add_1_r in IH. exact IH.
Qed.

Definition distance_of (one other : body) (b : number) : number := Plus (Plus (radius_of one) (radius_of other)) b.

(** M is in the unit 2^[rate] of the check: of angles, over a length. *)
Definition rate (are_angles : bool) (s : Z) : Z := if are_angles then (- s)%Z else 0%Z.
Definition inputs_of (are_angles : bool) (s : Z) (d : demand) : list input :=
  match d with
  | LengthMin _ b | LengthMax _ b => [InUnit b s]
  | AngleWithin _ a b => [Cosine a; Sine a; Cosine b; Sine b]
  | SpeedMax _ tool b => [InUnit (Over b tool) 0]
  | TurnMax _ tool b => [Radians (Over b tool) (- s)]
  | StiffnessMin ks b => map (fun k => InUnit (Over b k) (rate are_angles s + rate are_angles s)) ks
  | SerialMin _ b | ParallelMin b => [InUnit b 0]
  | LegAngleMax _ b => [Cosine b]
  | JointAngleMax _ _ j b => let u := order_of [px j; py j; pz j] in [Cosine b; InUnit (px j) u; InUnit (py j) u; InUnit (pz j) u]
  | AccelerationMax _ a v b => if are_angles then [InUnit (Over a b) s; InUnit (Over (Times v v) b) (s + s); Radians (1 // 1) 0] else [InUnit (Over a b) 0; InUnit (Over (Times v v) b) s]
  | OnePose _ b angle => let u := order_of [b] in [Tangent angle (u - s); InUnit b u]
  | LoadMax _ force b => map (fun x => InUnit (Over x b) (rate are_angles s)) force
  | Clear one other b => InUnit (distance_of one other b) s :: map (fun p => InUnit (greatest (fst p)) (snd p)) (body_numbers s one ++ body_numbers s other)
  | _ => []
  end.

(** What is made of each demand, with the formulas of its numbers; [j] is the place of the first. *)
Fixpoint of_each {A : Type} (g : list formula -> demand -> list A) (are_angles : bool) (s : Z) (j : nat) (ds : list demand) : list A :=
  match ds with
  | [] => []
  | d :: ds' => g (input_formulas j (inputs_of are_angles s d)) d ++ of_each g are_angles s (j + length (inputs_of are_angles s d)) ds'
  end.

Lemma of_each_anywhere : forall are_angles s ds d front back, In d ds ->
  let theta := front ++ map input_value (flat_map (inputs_of are_angles s) ds) ++ back in
  exists q, (forall x, map (Formula.value x theta) q = map input_value (inputs_of are_angles s d)) /\
    forall A (g : list formula -> demand -> list A) a, In a (g q d) -> In a (of_each g are_angles s (length front) ds).
Proof.
  intros are_angles s. induction ds as [| d0 ds IH]; intros d front back i; [contradiction |]. cbv zeta. cbn [flat_map of_each]. destruct i as [-> | i].
  - exists (input_formulas (length front) (inputs_of are_angles s d)). split; [intro x; rewrite map_app, <- app_assoc; apply input_formulas_value |].
    intros A g a k. apply in_or_app. left. exact k.
  - destruct (IH d (front ++ map input_value (inputs_of are_angles s d0)) back i) as [q [h1 h2]]. exists q. rewrite map_app, <- !app_assoc in *.
    split; [exact h1 |]. intros A g a k. apply in_or_app. right. specialize (h2 A g a k). rewrite app_length, map_length in h2. exact h2.
Qed.
Lemma of_each_at : forall are_angles s ds d x front back, In d ds ->
  let theta := front ++ map input_value (flat_map (inputs_of are_angles s) ds) ++ back in
  exists q, map (Formula.value x theta) q = map input_value (inputs_of are_angles s d) /\
    forall A (g : list formula -> demand -> list A) a, In a (g q d) -> In a (of_each g are_angles s (length front) ds).
Proof. intros are_angles s ds d x front back i. destruct (of_each_anywhere are_angles s ds d front back i) as [q [h1 h2]]. exists q. split; [apply h1 | exact h2]. Qed.

(** M^T diag(k_i) M >= b I is sigma_min >= 1 of the rows with D_i b/k_i. *)
Definition stiffened (r : rows formula) (q : list formula) : rows formula := map (fun p => (fst (fst p), times (snd (fst p)) (snd p))) (combine r q).
Lemma stiffened_energy : forall x theta w u b v, 0 < b -> 0 < u -> forall r M,
  Forall2 (fun p row => 0 < Formula.value x theta (snd p) /\ Linear.dot (map (Formula.value x theta) (fst p)) v ^ 2 / Formula.value x theta (snd p) = w * Linear.dot row v ^ 2) r M ->
  forall ks q, Forall (fun k => 0 < k) ks -> map (Formula.value x theta) q = map (fun k => b / k * u) ks ->
  energy (map_rows (Formula.value x theta) (stiffened r q)) v * (b * u) = w * elastic ks M v.
Proof.
  intros x theta w u b v b0 u0. unfold stiffened. induction 1 as [| [A D] row r M [d0 e] hs IH]; intros [| k ks] [| f q] hk hq; try discriminate; cbn [combine map elastic]; try (cbn [map_rows map energy]; ring).
  cbn [map] in hq. injection hq as h1 h2. inversion hk as [| ? ? k0 hk']; subst. specialize (IH ks q hk' h2). cbn [fst snd] in *. rewrite map_rows_cons. cbn [energy]. rewrite value_times, h1.
  rewrite Rmult_plus_distr_r, IH, Rmult_plus_distr_l. f_equal. replace (w * (k * Linear.dot row v ^ 2)) with (k * (w * Linear.dot row v ^ 2)) by ring. rewrite <- e. field. repeat split; lra.
Qed.
Lemma entries_stiffened : forall r q f, In f (entries (stiffened r q)) -> In f (entries r) \/ In f (map snd (stiffened r q)).
Proof.
  intros r q f i. apply in_flat_map in i as [[A D] [i1 i2]]. apply in_app_or in i2 as [i2 | [<- | []]]; [left | right; apply in_map_iff; exists (A, D); split; [reflexivity | exact i1]].
  apply in_map_iff in i1 as [[[A' D'] g] [e1 i1]]. injection e1 as <- _. apply in_flat_map. exists (A', D'). split; [exact (in_combine_l _ _ _ _ i1) | apply in_or_app; left; exact i2].
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Definition enclose_input (i : input) : option fixed :=
  match i with
  | InUnit x u => enclose_parameter bits (exactly x, u)
  | Radians x u => match enclose_parameter bits (exactly x, u) with Some a => radians bits a | None => None end
  | Cosine x => cosine bits x
  | Sine x => sine bits x
  | Tangent x u => if is_angle_number bits x then enclose_scaled_tangent bits u x else None
  end.
Lemma enclose_input_sound : forall i a, enclose_input i = Some a -> contains a (input_value i).
Proof.
  intros [x u | x u | x | x | x u] a h; cbn [enclose_input input_value] in *.
  - exact (enclose_parameter_sound bits _ _ _ h (exact_within x u)).
  - destruct (enclose_parameter bits (exactly x, u)) as [e |] eqn:ee; [| discriminate]. exact (radians_sound bits _ _ _ h (enclose_parameter_sound bits _ _ _ ee (exact_within x u))).
  - exact (cosine_sound bits _ _ h).
  - exact (sine_sound bits _ _ h).
  - destruct (is_angle_number bits x) eqn:e; [| discriminate]. exact (enclose_scaled_tangent_sound bits u x a h (is_angle_number_sound bits x e)).
Qed.

Lemma inputs_enclosed : forall l a, all_some (map enclose_input l) = Some a -> Forall2 contains a (map input_value l).
Proof.
  induction l as [| i l IH]; intros a e; cbn [map all_some] in *; [injection e as <-; constructor |].
  destruct (enclose_input i) as [x |] eqn:e1; [| discriminate]. destruct (all_some _) as [r |]; [| discriminate]. injection e as <-.
  constructor; [exact (enclose_input_sound _ _ e1) | exact (IH r eq_refl)].
Qed.
End Precision.
End Named.
