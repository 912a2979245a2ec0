(** * A claim as formulas, a box and tests, and what an accepted tree says of it *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require MeanValue.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Linear Arithmetic Slope Definite Test Apart Cell Check Number Machine Formula Acceleration.
From Orthocert.kernel Require Compare Solve Gradient Near Accuracy.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.


(** ** The quantities of a claim: constants, where they are small integers, or parameters *)

Definition small (p : parameter) : option Z :=
  match fst p with
  | Within (Ratio n 1) (Ratio n' 1) =>
      if (n =? n')%Z && is_small n && ((snd p =? 0)%Z || (n =? 0)%Z) then Some n else None
  | _ => None
  end.
Definition quantity (p : parameter) (j : nat) : formula :=
  match small p with Some n => integer n | None => F (Param j) end.
Fixpoint numbered (j : nat) (l : list parameter) : list formula :=
  match l with [] => [] | p :: l' => quantity p j :: numbered (S j) l' end.

Lemma small_value : forall p n y, small p = Some n -> scaled_within p y -> y = IZR n.
Proof.
  intros [[a b] u] n y h [x [[h1 h2] ->]]. unfold small in h. cbn [fst snd least greatest] in *.
  destruct a as [k [| | ] | | | | | |]; try discriminate. destruct b as [k' [| | ] | | | | | |]; try discriminate.
  destruct ((k =? k')%Z && is_small k && ((u =? 0)%Z || (k =? 0)%Z)) eqn:e; [| discriminate]. injection h as <-.
  apply andb_true_iff in e as [e1 e2]. apply andb_true_iff in e1 as [e1 _]. apply Z.eqb_eq in e1. subst k'.
  cbn [Claim.value] in h1, h2. assert (x = IZR k) by lra. subst x.
  apply orb_true_iff in e2 as [z | z]; apply Z.eqb_eq in z; subst; unfold two_to; cbn; field.
  pose proof (two_to_pos u) as p. unfold two_to in p. cbn in p. lra.
Qed.

Lemma quantity_value : forall p y x theta j, scaled_within p y -> nth j theta 0 = y -> value x theta (quantity p j) = y.
Proof.
  intros p y x theta j h n. unfold quantity. destruct (small p) as [k |] eqn:e.
  - symmetry. exact (small_value p k y e h).
  - exact n.
Qed.

Lemma numbered_values : forall l th x front back, Forall2 scaled_within l th ->
  map (value x (front ++ th ++ back)) (numbered (length front) l) = th.
Proof.
  intros l th x front back h. revert front. induction h as [| p y l th hp h IH]; intro front; [reflexivity |].
  cbn [numbered map app]. f_equal.
  - apply quantity_value; [exact hp | apply nth_middle].
  - specialize (IH (front ++ [y])). rewrite app_length, <- app_assoc in IH. cbn [length app] in IH.
    rewrite Nat.add_1_r in IH. exact IH.
Qed.

Definition three (t : tolerances) (u : Z) : list parameter := [(tx t, u); (ty t, u); (tz t, u)].

Lemma three_within : forall t u v, all_within t v -> Forall2 scaled_within (three t u) (coordinates (vscale (/ two_to u) v)).
Proof.
  intros t u v [h1 [h2 h3]].
  apply Forall2_cons; [exists (vx v) | apply Forall2_cons; [exists (vy v) | apply Forall2_cons; [exists (vz v) | constructor]]];
    (split; [assumption | cbn; unfold Rdiv; ring]).
Qed.

(** ** Legs.  [s]: lengths are divided by 2^s; [d]: a direction by 2^d. *)

Definition layout (s d : Z) (dr : drive) : list parameter :=
  match dr with
  | SliderLeg c => three (direction c) d ++ three (anchor c) s ++ three (platform c) s ++ [(Claim.length c, s)]
  | StrutLeg a p k => three a s ++ three p s ++ match k with Some k => three k d | None => [] end
  | PlanarLeg n => three n d
  end.

Definition vector_at (q : list formula) (k : nat) : evec :=
  EVec (nth k q (integer 0)) (nth (1 + k) q (integer 0)) (nth (2 + k) q (integer 0)).
Definition from_base (anchor platform : evec) : evec := map2 minus (map2 plus point platform) anchor.

Definition drive_formulas (s d : Z) (dr : drive) (j : nat) : leg_formulas :=
  let q := numbered j (layout s d dr) in
  match dr with
  | SliderLeg c => slider_formulas (from_base (vector_at q 3) (vector_at q 6)) (unit_vector (vector_at q 0)) (map2 plus point (vector_at q 6)) (nth 9 q (integer 0)) (mode c)
  | StrutLeg _ _ k => strut_formulas (from_base (vector_at q 0) (vector_at q 3)) (map2 plus point (vector_at q 3))
      (match k with Some _ => Some (unit_vector (vector_at q 6)) | None => None end)
  | PlanarLeg _ => planar_formulas point (unit_vector (vector_at q 0))
  end.

Lemma value_at : forall P theta q th k, map (value (coordinates P) theta) q = th ->
  value (coordinates P) theta (nth k q (integer 0)) = nth k th 0.
Proof. intros P theta q th k <-. symmetry. exact (map_nth (value (coordinates P) theta) q (integer 0) k). Qed.

Lemma vvalue_at : forall P theta q th k, map (value (coordinates P) theta) q = th ->
  vvalue P theta (vector_at q k) = Vec (nth k th 0) (nth (1 + k) th 0) (nth (2 + k) th 0).
Proof. intros. unfold vvalue, vector_at. cbn [ex ey ez]. f_equal; apply value_at; assumption. Qed.

Lemma vvalue_from_base : forall P theta a p, vvalue P theta (from_base a p) = vsub (vadd P (vvalue P theta p)) (vvalue P theta a).
Proof. intros. unfold from_base. rewrite vvalue_minus, vvalue_plus, vvalue_point. reflexivity. Qed.

(** With [u] as the direction: what a leg's parameters are. *)
Definition is_leg_along (u : vec) (dr : drive) (l : leg) : Prop :=
  match dr, l with
  | SliderLeg c, Guided l => (all_within (direction c) u /\ axis l = normalised u) /\ all_within (anchor c) (base_point l) /\
      all_within (platform c) (platform_offset l) /\ within (Claim.length c) (leg_length l) /\ working_mode l = (if mode c then 1 else -1)
  | StrutLeg a p k, Extensible base platform axis => all_within a base /\ all_within p platform /\
      match k, axis with None, None => True | Some k, Some axis => all_within k u /\ axis = normalised u | _, _ => False end
  | PlanarLeg d, Plane n => all_within d n
  | _, _ => False
  end.
Definition parameters_of (s d : Z) (u : vec) (l : leg) : list R :=
  let of_length v := coordinates (vscale (/ two_to s) v) in
  match l with
  | Guided k => coordinates (vscale (/ two_to d) u) ++ of_length (base_point k) ++ of_length (platform_offset k) ++ [/ two_to s * leg_length k]
  | Extensible base platform axis => of_length base ++ of_length platform ++ match axis with Some _ => coordinates (vscale (/ two_to d) u) | None => [] end
  | Plane n => coordinates (vscale (/ two_to d) n)
  end.

Lemma is_leg_has_direction : forall dr l, is_leg_of dr l -> exists u, is_leg_along u dr l.
Proof.
  intros [c | a p [k |] | n] [l | base platform [axis |] | normal] h; cbn [is_leg_of is_leg_along] in *; try contradiction; try tauto.
  - destruct h as [[u hu] h]. exists u. split; assumption.
  - destruct h as [h1 [h2 [u hu]]]. exists u. auto.
  - exists vzero. auto.
  - exists vzero. exact h.
Qed.

Lemma parameters_represent : forall s d u dr l, is_leg_along u dr l -> Forall2 scaled_within (layout s d dr) (parameters_of s d u l) /\
  forall P front back, represents P (front ++ parameters_of s d u l ++ back) (drive_formulas s d dr (length front)) (resized (/ two_to s) l).
Proof.
  intros s d u dr l h. pose proof (Rinv_0_lt_compat _ (two_to_pos d)) as d0.
  destruct dr as [c | a p ax | n], l as [k | base platform axis | normal]; cbn [is_leg_along] in h; try contradiction.
  - destruct h as [[hu ax] [ha [hp [hl hm]]]].
    assert (L : Forall2 scaled_within (layout s d (SliderLeg c)) (parameters_of s d u (Guided k))).
    { cbn [layout parameters_of]. repeat apply Forall2_app; try (apply three_within; assumption).
      constructor; [| constructor]. exists (leg_length k). split; [exact hl | cbn [snd]; unfold Rdiv; ring]. }
    split; [exact L |]. intros P front back.
    pose proof (numbered_values _ _ (coordinates P) front back L) as V. cbn [drive_formulas resized] in *.
    apply slider_represents.
    + rewrite vvalue_from_base, !(vvalue_at _ _ _ _ _ V). reflexivity.
    + rewrite vvalue_plus, vvalue_point, (vvalue_at _ _ _ _ _ V). reflexivity.
    + rewrite vvalue_unit, (vvalue_at _ _ _ _ _ V). cbn [axis]. rewrite ax. exact (normalised_resized (/ two_to d) u d0).
    + rewrite (value_at _ _ _ _ _ V). reflexivity.
    + exact hm.
  - destruct h as [ha [hp hk]].
    assert (L : Forall2 scaled_within (layout s d (StrutLeg a p ax)) (parameters_of s d u (Extensible base platform axis))).
    { cbn [layout parameters_of]. apply Forall2_app; [apply three_within; exact ha |]. apply Forall2_app; [apply three_within; exact hp |].
      destruct ax as [k |], axis as [v |]; try contradiction; [apply three_within, hk | constructor]. }
    split; [exact L |]. intros P front back.
    pose proof (numbered_values _ _ (coordinates P) front back L) as V. cbn [drive_formulas resized].
    apply strut_represents.
    + rewrite vvalue_from_base, !(vvalue_at _ _ _ _ _ V). reflexivity.
    + rewrite vvalue_plus, vvalue_point, (vvalue_at _ _ _ _ _ V). reflexivity.
    + destruct ax as [k |], axis as [v |]; try contradiction; cbn [option_map]; [| reflexivity].
      rewrite vvalue_unit, (vvalue_at _ _ _ _ _ V). destruct hk as [_ ->]. f_equal. exact (normalised_resized (/ two_to d) u d0).
  - assert (L : Forall2 scaled_within (layout s d (PlanarLeg n)) (parameters_of s d u (Plane normal)))
      by (cbn [layout]; apply three_within; assumption).
    split; [exact L |]. intros P front back.
    pose proof (numbered_values _ _ (coordinates P) front back L) as V. cbn [drive_formulas resized].
    apply planar_represents; [apply vvalue_point |]. rewrite vvalue_unit, (vvalue_at _ _ _ _ _ V).
    exact (normalised_resized (/ two_to d) normal d0).
Qed.

Lemma drive_represents : forall s d dr l, is_leg_of dr l -> exists th, Forall2 scaled_within (layout s d dr) th /\
  forall P front back, represents P (front ++ th ++ back) (drive_formulas s d dr (length front)) (resized (/ two_to s) l).
Proof. intros s d dr l h. destruct (is_leg_has_direction dr l h) as [u hu]. eexists. exact (parameters_represent s d u dr l hu). Qed.

(** Of the nominal machine they are the middles. *)
Definition middle_of (p : parameter) : R := middle (fst p) / two_to (snd p).
Lemma middle_within : forall t x, within t x -> within t (middle t).
Proof. intros t x. unfold within, middle. lra. Qed.
Lemma middles_within : forall t v, all_within t v -> all_within t (middles t).
Proof. intros t v [h1 [h2 h3]]. split; [| split]; cbn [middles vx vy vz]; eapply middle_within; eassumption. Qed.
Lemma middles_three : forall t u, map middle_of (three t u) = coordinates (vscale (/ two_to u) (middles t)).
Proof. intros t u. unfold middle_of, coordinates, vscale, middles, Rdiv. cbn [three map fst snd vx vy vz]. f_equal; [ring |]. f_equal; [ring |]. f_equal. ring. Qed.
Lemma nominal_legs_along : forall s d dr l, is_leg_of dr l -> exists u, is_leg_along u dr (nominal_leg dr) /\ parameters_of s d u (nominal_leg dr) = map middle_of (layout s d dr).
Proof.
  intros s d dr l h.
  destruct dr as [c | a p [k |] | n], l as [g | base platform [axis |] | normal]; cbn [is_leg_of] in h; try contradiction; try tauto; cbn [nominal_leg is_leg_along layout parameters_of].
  - destruct h as [[u [hu _]] [ha [hp [hl _]]]]. exists (middles (direction c)). split.
    + split; [split; [exact (middles_within _ _ hu) | reflexivity] |]. split; [exact (middles_within _ _ ha) |]. split; [exact (middles_within _ _ hp) |]. split; [exact (middle_within _ _ hl) | reflexivity].
    + rewrite !map_app, !middles_three. cbn [base_point platform_offset leg_length map]. do 3 f_equal. unfold middle_of. cbn [fst snd]. f_equal. unfold Rdiv. ring.
  - destruct h as [ha [hp [u [hu _]]]]. exists (middles k). split; [| rewrite !map_app, !middles_three; reflexivity].
    split; [exact (middles_within _ _ ha) |]. split; [exact (middles_within _ _ hp) |]. split; [exact (middles_within _ _ hu) | reflexivity].
  - destruct h as [ha [hp _]]. exists vzero. split; [| rewrite !map_app, !middles_three; reflexivity]. split; [exact (middles_within _ _ ha) |]. split; [exact (middles_within _ _ hp) | exact I].
  - exists vzero. split; [exact (middles_within _ _ h) | symmetry; apply middles_three].
Qed.
Lemma nominal_represents : forall s d dr l, is_leg_of dr l -> Forall2 scaled_within (layout s d dr) (map middle_of (layout s d dr)) /\
  forall P front back, represents P (front ++ map middle_of (layout s d dr) ++ back) (drive_formulas s d dr (length front)) (resized (/ two_to s) (nominal_leg dr)).
Proof. intros s d dr l h. destruct (nominal_legs_along s d dr l h) as [u [hu <-]]. exact (parameters_represent s d u dr _ hu). Qed.

(** All legs; [ds] has the units of their directions. *)
Fixpoint layouts (s : Z) (ds : list Z) (drs : list drive) : list parameter :=
  match drs with [] => [] | dr :: r => layout s (hd 0%Z ds) dr ++ layouts s (tl ds) r end.
Fixpoint all_formulas (s : Z) (ds : list Z) (drs : list drive) (j : nat) : list leg_formulas :=
  match drs with
  | [] => []
  | dr :: r => drive_formulas s (hd 0%Z ds) dr j :: all_formulas s (tl ds) r (j + length (layout s (hd 0%Z ds) dr))
  end.

Lemma all_represent : forall s drs m, Forall2 is_leg_of drs m -> forall ds, exists th,
  Forall2 scaled_within (layouts s ds drs) th /\
  forall P front back, Forall2 (represents P (front ++ th ++ back)) (all_formulas s ds drs (length front)) (map (resized (/ two_to s)) m).
Proof.
  induction 1 as [| dr l drs m h hs IH]; intro ds; [exists []; split; [constructor | intros; constructor] |].
  destruct (drive_represents s (hd 0%Z ds) dr l h) as [t1 [L1 R1]]. destruct (IH (tl ds)) as [t2 [L2 R2]].
  exists (t1 ++ t2). split; [apply Forall2_app; assumption |]. intros P front back. cbn [all_formulas map]. constructor.
  - rewrite <- app_assoc. apply R1.
  - specialize (R2 P (front ++ t1) back). rewrite app_length, <- !app_assoc in R2.
    rewrite (related_length _ _ _ _ _ L1). rewrite <- app_assoc. exact R2.
Qed.

Lemma all_nominal_represent : forall s drs m, Forall2 is_leg_of drs m -> forall ds, let th := map middle_of (layouts s ds drs) in
  Forall2 scaled_within (layouts s ds drs) th /\
  forall P front back, Forall2 (represents P (front ++ th ++ back)) (all_formulas s ds drs (length front)) (map (resized (/ two_to s)) (map nominal_leg drs)).
Proof.
  intros s drs m. induction 1 as [| dr l drs m h hs IH]; intro ds; [split; [constructor | intros; constructor] |].
  destruct (nominal_represents s (hd 0%Z ds) dr l h) as [L1 R1]. destruct (IH (tl ds)) as [L2 R2]. cbv zeta in *. cbn [layouts]. rewrite map_app.
  split; [apply Forall2_app; assumption |]. intros P front back. cbn [all_formulas map]. rewrite <- app_assoc. constructor; [apply R1 |].
  specialize (R2 P (front ++ map middle_of (layout s (hd 0%Z ds) dr)) back). rewrite app_length, map_length, <- !app_assoc in R2. exact R2.
Qed.

Lemma slider_length : forall s drs m, Forall2 is_leg_of drs m -> forall ds j i f k,
  nth_error (all_formulas s ds drs j) i = Some f -> nth_error m i = Some (Guided k) -> f_length f <> None.
Proof.
  induction 1 as [| dr l drs m h hs IH]; intros ds j [| i] f k e n; try discriminate; cbn [all_formulas nth_error] in *; [| exact (IH _ _ _ _ _ e n)].
  injection e as <-. injection n as ->. destruct dr; try contradiction. discriminate.
Qed.

(** ** Requirements as tests *)

(** kappa = 1/psi_max, k = 1/psi_min, or the end of a joint's range. *)
Definition bound_of (s : Z) (r : requirement) : parameter :=
  match r with
  | NotSingular | OneToOne | Stiffnesses _ _ => (exactly (0 // 1), 0%Z)
  | PsiMax b | PsiMin b => (exactly (Over (1 // 1) b), 0%Z)
  | JointMin _ b | JointMax _ b => (exactly b, s)
  | JointSpeed _ tool b => (exactly (Over b tool), 0%Z)
  | Stiffness joint b => (exactly (Over b joint), 0%Z)
  | Clearance one other b => (exactly (Plus (Plus (radius_of one) (radius_of other)) b), s)
  | Beside _ _ _ distance => (exactly distance, s)
  | JointAcceleration _ a _ b => (exactly (Over a b), 0%Z)
  | JointForce _ tool b => (exactly (Over tool b), 0%Z)
  | Accuracy _ b => (exactly b, s)
  | ConditionMax b | SerialMargin _ b | ParallelMargin b | ConstraintMargin b => (exactly b, 0%Z)
  end.
Definition bound_value (s : Z) (r : requirement) : R := Claim.value (greatest (fst (bound_of s r))) / two_to (snd (bound_of s r)).

Lemma bound_within : forall s r, scaled_within (bound_of s r) (bound_value s r).
Proof.
  intros s r. unfold bound_value. exists (Claim.value (greatest (fst (bound_of s r)))). split; [| reflexivity].
  unfold within. destruct r; cbn; lra.
Qed.

Lemma bounds_within : forall s rs, Forall2 scaled_within (map (bound_of s) rs) (map (bound_value s) rs).
Proof. induction rs; cbn [map]; constructor; auto using bound_within. Qed.

(** The numbers of bodies: six each. *)
Definition position_numbers (s : Z) (p : Statement.position) : list parameter := [(exactly (px p), s); (exactly (py p), s); (exactly (pz p), s)].
Definition body_numbers (s : Z) (b : body) : list parameter :=
  match b with
  | AlongLeg _ _ t u o => [(exactly t, s); (exactly u, s)] ++ position_numbers s o ++ [(exactly (0 // 1), 0%Z)]
  | OnBase _ p q | OnPlatform _ p q => position_numbers s p ++ position_numbers s q
  end.
Definition extras (s : Z) (r : requirement) : list parameter :=
  match r with
  | Clearance one other _ => body_numbers s one ++ body_numbers s other
  | Beside _ one other _ => position_numbers s one ++ position_numbers s other
  | JointAcceleration _ _ v b => [(exactly (Over (Times v v) b), s)]
  | Stiffnesses ks b => map (fun k => (exactly (Over b k), 0%Z)) ks
  | _ => []
  end.
Definition exact_value (p : parameter) : R := Claim.value (greatest (fst p)) / two_to (snd p).

Lemma extras_within : forall s r, Forall2 scaled_within (extras s r) (map exact_value (extras s r)).
Proof.
  assert (E : forall x u, scaled_within (exactly x, u) (exact_value (exactly x, u)))
    by (intros x u; exists (Claim.value x); split; [unfold within, exactly; cbn; lra | reflexivity]).
  assert (B : forall s b, Forall2 scaled_within (body_numbers s b) (map exact_value (body_numbers s b)))
    by (intros s [i r t u o | r p q | r p q]; cbn; repeat constructor; apply E).
  intros s [| | | | | | | | | | | one other b | i o q d | i a v b | | | | ks b]; try exact (Forall2_nil _); cbn [extras]; rewrite ?map_app.
  - apply Forall2_app; apply B.
  - cbn. repeat constructor; apply E.
  - cbn. repeat constructor; apply E.
  - induction ks as [| k ks IH]; cbn [map]; constructor; [apply E | exact IH].
Qed.

Lemma all_extras_within : forall s rs, Forall2 scaled_within (flat_map (extras s) rs) (map exact_value (flat_map (extras s) rs)).
Proof.
  intros s rs. induction rs as [| r rs IH]; [constructor |]. cbn [flat_map]. rewrite map_app.
  apply Forall2_app; [apply extras_within | exact IH].
Qed.

(** Where a requirement's bound and its other numbers are among the parameters. *)
Definition next (s : Z) (r : requirement) (j : nat * nat) : nat * nat := (S (fst j), snd j + length (extras s r))%nat.

(** The base end of a leg whose vector is built as C - b, as of struts, is b. [first_end]: the point a part of the vector after it, else the
    rest of the vector before C. *)
Definition base_part (c a : formula) : option formula :=
  if same a c then Some (integer 0) else match a with F (Sub d b) => if same d c then Some b else None | _ => None end.
Definition first_end (tip A : evec) (x : formula) : evec :=
  match base_part (ex tip) (ex A), base_part (ey tip) (ey A), base_part (ez tip) (ez A) with
  | Some b, Some c, Some d => map2 plus (EVec b c d) (scaled x A)
  | _, _, _ => map2 minus tip (scaled (minus (integer 1) x) A)
  end.

(** The ends of a body's segment, by its numbers; [rods]: of each leg its platform end, vector and length. *)
Definition segment_formulas (rods : list (option (evec * evec * formula))) (placed : evec -> evec) (q : list formula) (b : body) : option (evec * evec) :=
  match b with
  | AlongLeg i _ _ _ _ =>
      match nth_error rods i with
      | Some (Some (tip, A, len)) =>
          Some (map2 plus (first_end tip A (over (nth 0 q (integer 0)) len)) (vector_at q 2),
            map2 plus (map2 minus tip (scaled (over (nth 1 q (integer 0)) len) A)) (vector_at q 2))
      | _ => None
      end
  | OnBase _ _ _ => Some (vector_at q 0, vector_at q 3)
  | OnPlatform _ _ _ => Some (placed (vector_at q 0), placed (vector_at q 3))
  end.
Definition segments_along (rods : list (option (evec * evec * formula))) (placed : evec -> evec) (q : list formula) (one other : body) : option (evec * evec * (evec * evec)) :=
  match segment_formulas rods placed (firstn 6 q) one, segment_formulas rods placed (skipn 6 q) other with Some a, Some b => Some (a, b) | _, _ => None end.
Definition rods_of (fs : list leg_formulas) : list (option (evec * evec * formula)) := map (fun f => option_map (fun tip => (tip, f_A f, rod f)) (f_tip f)) fs.
Definition segments (fs : list leg_formulas) (s : Z) (j : nat) (one other : body) : option (evec * evec * (evec * evec)) :=
  segments_along (rods_of fs) (map2 plus point) (numbered j (body_numbers s one ++ body_numbers s other)) one other.

(** |d|^2 - (d . A)^2/L^2 - R^2, d from the one line along the leg to the other. *)
Definition beside_formula (f : leg_formulas) (q : list formula) (b : formula) : formula :=
  let d := map2 minus (vector_at q 0) (vector_at q 3) in
  minus (minus (product d d) (over (square (product d (f_A f))) (square (rod f)))) (square b).

(** 1 - t (a + b t^2), t = L/|eta|, of sliders, and 1 - a - b of struts; [a] and [b] over the bound, [b] a speed's square over the length. *)
Definition acceleration_formula (f : leg_formulas) (a b : formula) : list formula :=
  let own := over b (rod f) in
  match f_length f, f_tip f with
  | Some len, _ => let t := over len (root (f_D f)) in [minus (integer 1) (times t (plus a (times own (square t))))]
  | None, Some _ => [minus (minus (integer 1) a) own]
  | None, None => []
  end.

Definition minor (p q r t : formula) : formula := minus (times p t) (times q r).
Definition determinant (a b c : evec) : formula :=
  plus (minus (times (ex a) (minor (ey b) (ez b) (ey c) (ez c))) (times (ey a) (minor (ex b) (ez b) (ex c) (ez c))))
    (times (ez a) (minor (ex b) (ey b) (ex c) (ey c))).

Definition entries (r : rows formula) : list formula := flat_map (fun p => fst p ++ [snd p]) r.

(** Rows of which the least singular value has a bound. *)
Definition stiff_rows (fs : list leg_formulas) (ratio : formula) : rows formula :=
  map (fun f => (list_of (f_A f), times (f_D f) ratio)) fs.
Fixpoint stiff_each (fs : list leg_formulas) (ratios : list formula) : rows formula :=
  match fs, ratios with f :: fs', q :: ratios' => (list_of (f_A f), times (f_D f) q) :: stiff_each fs' ratios' | _, _ => [] end.
Fixpoint couple_rows (fs : list leg_formulas) : option (rows formula) :=
  match fs with
  | [] => Some []
  | f :: fs' => match f_couple f, couple_rows fs' with Some c, Some r => Some ((list_of c, product c c) :: r) | _, _ => None end
  end.
Definition least_rows (fs : list leg_formulas) (s : Z) (j : nat * nat) (r : requirement) : option (rows formula) :=
  match r with
  | Stiffness _ _ => Some (stiff_rows fs (quantity (bound_of s r) (fst j)))
  | Stiffnesses ks _ => if Nat.eqb (length ks) (length fs) then Some (stiff_each fs (numbered (snd j) (extras s r))) else None
  | ConstraintMargin _ => couple_rows fs
  | _ => None
  end.

Definition is_least (r : requirement) : bool := match r with Stiffness _ _ | Stiffnesses _ _ | ConstraintMargin _ | Clearance _ _ _ | Beside _ _ _ _ | JointAcceleration _ _ _ _ | JointForce _ _ _ | OneToOne | Accuracy _ _ => true | _ => false end.

(** What is not to be negative: the formulas of one requirement, of which one has to be so.  [j] is the
    bound's place among the parameters. *)
Definition range_formula (fs : list leg_formulas) (s : Z) (j : nat * nat) (r : requirement) : list formula :=
  let b := quantity (bound_of s r) (fst j) in
  let of_leg i (g : leg_formulas -> list formula) := match nth_error fs i with Some f => g f | None => [] end in
  match r with
  | JointMin i _ => of_leg i (fun f => [minus (f_joint f) b])
  | JointMax i _ => of_leg i (fun f => [minus b (f_joint f)])
  | JointSpeed i _ _ => of_leg i (fun f => let a := f_A f in
      [minus (minus (minus (times (square b) (f_D f)) (square (ex a))) (square (ey a))) (square (ez a))])
  | SerialMargin i _ => of_leg i (fun f =>
      match f_length f with Some len => [minus (f_D f) (times (square b) (square len))] | None => [] end)
  | ParallelMargin _ =>
      match fs with
      | [f; g; h] =>
          let d := determinant (f_A f) (f_A g) (f_A h) in
          let least := times (times (times b (rod f)) (rod g)) (rod h) in
          [minus d least; opposite (plus d least)]
      | _ => []
      end
  | Stiffness _ _ | Stiffnesses _ _ | ConstraintMargin _ => match least_rows fs s j r with Some rs => entries rs | None => [] end
  | Clearance one other _ =>
      match segments fs s (snd j) one other with
      | Some ((a, b), (c, d)) => flat_map list_of [a; b; c; d]
      | None => []
      end
  | Beside i _ _ _ => of_leg i (fun f =>
      match f_tip f with Some _ => [beside_formula f (numbered (snd j) (extras s r)) b] | None => [] end)
  | JointAcceleration i _ _ _ => of_leg i (fun f => acceleration_formula f b (nth 0 (numbered (snd j) (extras s r)) (integer 0)))
  | NotSingular | PsiMax _ | PsiMin _ | ConditionMax _ | JointForce _ _ _ | OneToOne | Accuracy _ _ => []
  end.
Fixpoint range_formulas (fs : list leg_formulas) (s : Z) (j : nat * nat) (rs : list requirement) : list formula :=
  match rs with
  | [] => []
  | r :: rs' => range_formula fs s j r ++ range_formulas fs s (next s r j) rs'
  end.

(** Of accuracy: the parameters with two ends, and derivatives of joint coordinates by them. *)
Definition none : parameter := (exactly (0 // 1), 0%Z).
Definition has_two_ends (p : parameter) : bool := negb (Number.same (least (fst p)) (greatest (fst p))).
Definition toleranced (ps : list parameter) : list nat := filter (fun j => has_two_ends (nth j ps none)) (seq 0 (length ps)).
Definition slopes_from (ps : list parameter) (ds : list formula) : list (nat * formula) := filter (fun p => negb (is 0 (snd p))) (combine (toleranced ps) ds).
Definition slopes_of (ps : list parameter) (f : formula) : list (nat * formula) := slopes_from ps (Gradient.derivatives (toleranced ps) f).
Definition accuracy_formulas (ps : list parameter) (fs : list leg_formulas) (rs : list requirement) : list formula :=
  if existsb (fun r => match r with Accuracy _ _ => true | _ => false end) rs then flat_map (fun f => f_joint f :: map snd (slopes_of ps (f_joint f))) fs else [].
(** Half the width, over the distance. *)
Definition half_width (s : Z) (b : number) (p : parameter) : parameter :=
  (exactly (Over (Minus (greatest (fst p)) (least (fst p))) (Times (2 // 1) b)), (snd p - s)%Z).

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
(** The one matrix of [Chords]. *)
Variable one_matrix : N * list (list Z).

Definition ends_at (place : formula -> nat) (u : evec) : spatial nat := Spatial (place (ex u)) (place (ey u)) (place (ez u)).
(** Half widths, and where the derivatives by these parameters are. *)
Definition changes_from (place : formula -> nat) (ps : list parameter) (s : Z) (b : number) (sl : list (nat * formula)) : option (list (fixed * nat)) :=
  all_some (map (fun p => option_map (fun a => (a, place (snd p))) (enclose_parameter bits (half_width s b (nth (fst p) ps none)))) sl).
Definition changes_of (place : formula -> nat) (ps : list parameter) (s : Z) (b : number) (f : formula) : option (list (fixed * nat)) := changes_from place ps s b (slopes_of ps f).
Definition joint_test (place : formula -> nat) (ps : list parameter) (s : Z) (error b : number) (f : formula) : option (nat * (fixed * list (fixed * nat))) :=
  match enclose_parameter bits (exactly (Over error b), 0%Z), changes_of place ps s b f with
  | Some e, Some hs => Some (place f, (e, hs))
  | _, _ => None
  end.
Definition test_of (place : formula -> nat) (ps : list parameter) (fs : list leg_formulas) (s : Z) (j : nat * nat) (r : requirement) : option test :=
  match r with
  | NotSingular => Some (SigmaMin zero)
  | PsiMax _ => option_map (fun a => SigmaMin (sqr bits a)) (enclose_parameter bits (bound_of s r))
  | PsiMin _ => option_map (fun a => SigmaMax (sqr bits a)) (enclose_parameter bits (bound_of s r))
  | ConditionMax _ => option_map (fun a => Conditioning (sqr bits a)) (enclose_parameter bits (bound_of s r))
  | Stiffness _ _ => option_map (fun rs => Least (map_rows place rs) (Fixed.integer bits 1)) (least_rows fs s j r)
  | Stiffnesses ks b => if forallb (Compare.certainly bits true) (b :: ks)
      then option_map (fun rs => Least (map_rows place rs) (Fixed.integer bits 1)) (least_rows fs s j r) else None
  | ConstraintMargin _ =>
      match least_rows fs s j r, enclose_parameter bits (bound_of s r) with
      | Some rs, Some a => Some (Least (map_rows place rs) (sqr bits a))
      | _, _ => None
      end
  | Clearance one other _ =>
      match segments fs s (snd j) one other, enclose_parameter bits (bound_of s r) with
      | Some ((a, b), (c, d)), Some distance => if (0 <=? lo distance)%Z then
          let at_ := ends_at place in Some (Apart (at_ a) (at_ b) (at_ c) (at_ d) distance) else None
      | _, _ => None
      end
  | JointAcceleration _ a _ b =>
      match range_formula fs s j r with
      | [f] => if Compare.certainly bits false a && Compare.certainly bits true b then Some (AtLeast (place f)) else None
      | _ => None
      end
  | OneToOne => Some (Chords (map_rows place (whole_rows fs)) (fst one_matrix) (snd one_matrix))
  | Accuracy error b =>
      if Nat.eqb (length fs) 3 && Compare.certainly bits false error && Compare.certainly bits true b then
        match enclose_parameter bits (bound_of s r), all_some (map (fun f => joint_test place ps s error b (f_joint f)) fs) with
        | Some d, Some js => Some (Accurate d js)
        | _, _ => None
        end
      else None
  | JointForce i tool b => match nth_error fs i with
      | Some _ => if Compare.certainly bits true tool && Compare.certainly bits true b
          then option_map (fun a => Solved i (sqr bits a)) (enclose_parameter bits (bound_of s r)) else None
      | None => None
      end
  | _ => match range_formula fs s j r with
         | [f] => Some (AtLeast (place f))
         | [f; g] => Some (Either (place f) (place g))
         | _ => None
         end
  end.
Fixpoint tests_of (place : formula -> nat) (ps : list parameter) (fs : list leg_formulas) (s : Z) (j : nat * nat) (rs : list requirement) : list (option test) :=
  match rs with [] => [] | r :: rs' => test_of place ps fs s j r :: tests_of place ps fs s (next s r j) rs' end.

Definition is_lower (r : requirement) : bool := match r with NotSingular | PsiMax _ => true | _ => false end.
(** ** The workspace *)

(** A box around it. *)
Definition hull (w : region) : tolerances :=
  match w with
  | Box edges => edges
  | Cylinder x y r height => Tolerances (Within (Minus x r) (Plus x r)) (Within (Minus y r) (Plus y r)) height
  end.

Lemma hull_sound : forall w P, in_region w P -> all_within (hull w) P.
Proof.
  intros [edges | x y r height] P h; [exact h |]. destruct h as [h [r0 hz]].
  assert (B : forall a b, a ^ 2 + b ^ 2 <= Claim.value r ^ 2 -> - Claim.value r <= a <= Claim.value r).
  { intros a b k. pose proof (pow2_ge_0 b). split; apply Rnot_lt_le; intro n; nra. }
  pose proof (B _ _ h) as X. rewrite Rplus_comm in h. pose proof (B _ _ h) as Y.
  unfold all_within, within. cbn [hull tx ty tz least greatest Claim.value].
  split; [lra |]. split; [lra | exact hz].
Qed.

(** The tangent of R^2 - (x - x_0)^2 - (y - y_0)^2, a concave function, at the centre of a cell. *)
Definition tangent (w : region) (s : Z) (cell : list fixed) : option slope :=
  match w, cell with
  | Cylinder x y r _, [X; Y; _] =>
      match enclose_scaled bits s x, enclose_scaled bits s y, enclose_scaled bits s r with
      | Some x, Some y, Some r =>
          let dx := sub (Fixed (midpoint X) (midpoint X)) x in
          let dy := sub (Fixed (midpoint Y) (midpoint Y)) y in
          Some (Slope (sub (sub (sqr bits r) (sqr bits dx)) (sqr bits dy)) zero
            [mul bits (neg (add dx dx)) (Fixed (half X) (half X)); mul bits (neg (add dy dy)) (Fixed (half Y) (half Y))])
      | _, _, _ => None
      end
  | _, _ => None
  end.

Lemma tangent_sound : forall w s P, in_region w P -> forall cell lambda t, tangent w s cell = Some t ->
  length lambda = length cell ->
  Forall2 (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell
    (combine lambda (coordinates (vscale (/ two_to s) P))) ->
  exists e, entry_in bits t e /\ 0 <= at_lambda lambda e.
Proof.
  intros w s P hP cell lambda t h len hd. unfold tangent in h. destruct w as [| x y r height]; [discriminate |].
  destruct cell as [| X [| Y [| Z [|]]]]; try discriminate.
  destruct (enclose_scaled bits s x) as [ix |] eqn:e1; [| discriminate].
  destruct (enclose_scaled bits s y) as [iy |] eqn:e2; [| discriminate].
  destruct (enclose_scaled bits s r) as [ir |] eqn:e3; [| discriminate]. injection h as <-.
  destruct lambda as [| lx [| ly [| lz [|]]]]; try discriminate. clear len.
  apply enclose_scaled_sound in e1, e2, e3. destruct hP as [hP _]. pose proof (two_to_pos s) as s0.
  unfold coordinates in hd. cbn [combine vscale vx vy vz] in hd.
  inversion hd as [| ? ? ? ? hx hd1]. inversion hd1 as [| ? ? ? ? hy _]. subst. clear hd hd1. cbn [fst snd] in hx, hy.
  set (k := / two_to s) in *. assert (k0 : 0 < k) by (apply Rinv_0_lt_compat, s0). unfold Rdiv in e1, e2, e3. fold k in e1, e2, e3.
  set (cx := centre_of bits X) in *. set (cy := centre_of bits Y) in *.
  set (dx := cx - Claim.value x * k). set (dy := cy - Claim.value y * k). set (R := Claim.value r * k).
  set (hX := IZR (half X) / unit_R bits) in *. set (hY := IZR (half Y) / unit_R bits) in *.
  assert (Dx : contains (sub (Fixed (midpoint X) (midpoint X)) ix) dx) by (apply sub_sound; [apply point_sound | exact e1]).
  assert (Dy : contains (sub (Fixed (midpoint Y) (midpoint Y)) iy) dy) by (apply sub_sound; [apply point_sound | exact e2]).
  exists (R ^ 2 - dx ^ 2 - dy ^ 2, [- (dx + dx) * hX; - (dy + dy) * hY]). split; [split |].
  - cbn [at_c fst]. apply sub_sound; [apply sub_sound |]; apply sqr_sound; assumption.
  - cbn [slopes snd]. constructor; [| constructor; [| constructor]]; (apply mul_sound; [apply neg_sound, add_sound; assumption | apply point_sound]).
  - unfold at_lambda. cbn [fst snd dot].
    assert (G : (vx P - Claim.value x) ^ 2 * k ^ 2 + (vy P - Claim.value y) ^ 2 * k ^ 2 <= R ^ 2).
    { unfold R. rewrite Rpow_mult_distr. pose proof (pow_lt k 2 k0). nra. }
    assert (Ex : (vx P - Claim.value x) * k = dx + hX * lx) by (unfold dx; rewrite <- hx; ring).
    assert (Ey : (vy P - Claim.value y) * k = dy + hY * ly) by (unfold dy; rewrite <- hy; ring).
    rewrite <- !Rpow_mult_distr, Ex, Ey in G. pose proof (pow2_ge_0 (hX * lx)). pose proof (pow2_ge_0 (hY * ly)). nra.
Qed.

(** No leg within the tolerances has a direction that is zero, or a length that is not positive. *)
Definition is_nonzero (t : tolerances) (d : Z) : bool :=
  match map (enclose_parameter bits) (three t d) with
  | [Some x; Some y; Some z] => (0 <? lo (add (add (sqr bits x) (sqr bits y)) (sqr bits z)))%Z
  | _ => false
  end.
Definition is_buildable (s d : Z) (dr : drive) : bool :=
  match dr with
  | SliderLeg c => is_nonzero (direction c) d && match enclose_parameter bits (Claim.length c, s) with Some a => (0 <? lo a)%Z | None => false end
  | StrutLeg _ _ None => true
  | StrutLeg _ _ (Some n) | PlanarLeg n => is_nonzero n d
  end.
Fixpoint are_buildable (s : Z) (ds : list Z) (drs : list drive) : bool :=
  match drs with [] => true | dr :: r => is_buildable s (hd 0%Z ds) dr && are_buildable s (tl ds) r end.

Lemma scaled_positive : forall c x, 0 < x / two_to c -> 0 < x.
Proof.
  intros c x h. pose proof (two_to_pos c) as p. replace x with (x / two_to c * two_to c) by (field; lra). apply Rmult_lt_0_compat; assumption.
Qed.

Lemma is_nonzero_sound : forall t d v, is_nonzero t d = true -> all_within t v -> 0 < norm2 v.
Proof.
  intros t d v h w. pose proof (three_within t d v w) as W. unfold is_nonzero in h. cbn [map three] in h.
  destruct (enclose_parameter bits (tx t, d)) as [x |] eqn:ex; [| discriminate].
  destruct (enclose_parameter bits (ty t, d)) as [y |] eqn:ey; [| discriminate].
  destruct (enclose_parameter bits (tz t, d)) as [z |] eqn:ez; [| discriminate]. apply Z.ltb_lt in h.
  inversion W as [| ? ? ? ? h1 W1]; subst. inversion W1 as [| ? ? ? ? h2 W2]; subst. inversion W2 as [| ? ? ? ? h3 _]; subst.
  apply (enclose_parameter_sound bits _ _ _ ex) in h1. apply (enclose_parameter_sound bits _ _ _ ey) in h2. apply (enclose_parameter_sound bits _ _ _ ez) in h3.
  pose proof (contains_positive bits _ _ h (add_sound bits _ _ _ _ (add_sound bits _ _ _ _ (sqr_sound bits _ _ h1) (sqr_sound bits _ _ h2)) (sqr_sound bits _ _ h3))) as p.
  change (0 < norm2 (vscale (/ two_to d) v)) in p. rewrite norm2_scale in p. pose proof (norm2_nonneg v). pose proof (pow2_ge_0 (/ two_to d)). nra.
Qed.

Lemma is_buildable_sound : forall s d dr l, is_buildable s d dr = true -> is_leg_of dr l -> well_formed_leg l.
Proof.
  intros s d [c | a p [n |] | n] [k | base platform [axis |] | normal] h w; cbn [is_buildable is_leg_of well_formed_leg] in *; try contradiction; try exact I; try tauto.
  - apply andb_true_iff in h as [h h']. destruct w as [[u [hu ax]] [_ [_ [hl hm]]]]. unfold well_formed. rewrite ax. split; [| split].
    + apply normalised_norm, (is_nonzero_sound _ _ _ h hu).
    + destruct (enclose_parameter bits (Claim.length c, s)) as [i |] eqn:e; [| discriminate]. apply Z.ltb_lt in h'.
      apply (scaled_positive s), (contains_positive bits _ _ h'). apply (enclose_parameter_sound bits _ _ _ e). exists (leg_length k). split; [exact hl | reflexivity].
    + rewrite hm. destruct (mode c); auto.
  - destruct w as [_ [_ [u [hu ->]]]]. apply normalised_norm, (is_nonzero_sound _ _ _ h hu).
  - intro z. pose proof (is_nonzero_sound _ _ _ h w) as p. rewrite z in p. unfold norm2, vzero in p. cbn in p. lra.
Qed.

Lemma are_buildable_sound : forall s drs m, Forall2 is_leg_of drs m -> forall ds, are_buildable s ds drs = true -> Forall well_formed_leg m.
Proof.
  intros s drs m. induction 1 as [| dr l drs m h hs IH]; intros ds k; [constructor |]. cbn [are_buildable] in k.
  apply andb_true_iff in k as [k1 k2]. constructor; [exact (is_buildable_sound _ _ _ _ k1 h) | exact (IH _ k2)].
Qed.

(** The whole check: formulas, a tape that stands for them, enclosures, the tree.
    [s], [ds], the tape and the tree are evidence. *)
Definition check_claim_by (c : claim) (s : Z) (ds : list Z) (t : tree) : bool :=
  let ps := layouts s ds (legs c) in
  let fs := all_formulas s ds (legs c) 0 in
  let n := (length ps, length ps + length (require c))%nat in
  let needed := entries (whole_rows fs) ++ entries (divided_rows fs) ++ range_formulas fs s n (require c) ++ accuracy_formulas ps fs (require c) in
  let tape := compile needed in
  let found := formulas tape in let at_ := place found in
  if forallb (fun e => same (nth (at_ e) found (integer 0)) e) needed then
    if existsb is_lower (require c) && are_buildable s ds (legs c) then
      match all_some (map (enclose_parameter bits) (ps ++ map (bound_of s) (require c) ++ flat_map (extras s) (require c))),
            all_some (map (enclose_parameter bits) (three (hull (workspace c)) s)),
            all_some (tests_of at_ ps fs s n (require c)) with
      | Some params, Some box, Some tests =>
          check bits tape (map_rows at_ (whole_rows fs)) (map_rows at_ (divided_rows fs)) []
            params tests (tangent (workspace c) s) box (all_open tests) t
      | _, _, _ => false
      end
    else false
  else false.

(** ** Soundness *)

Lemma all_some_related : forall (A B : Type) (P : A -> B -> Prop) (f : A -> option B) l m,
  (forall a b, f a = Some b -> P a b) -> all_some (map f l) = Some m -> Forall2 P l m.
Proof.
  intros A B P f l m h. revert m. induction l as [| a l IH]; intros m e; cbn [map all_some] in e.
  - injection e as <-. constructor.
  - destruct (f a) as [b |] eqn:fa; [| discriminate]. destruct (all_some (map f l)) as [m' |]; [| discriminate].
    injection e as <-. constructor; auto.
Qed.

Lemma all_some_in : forall (A : Type) (l : list (option A)) m o, all_some l = Some m -> In o l -> exists a, o = Some a /\ In a m.
Proof.
  induction l as [| [a |] l IH]; intros m o e i; cbn [all_some] in e; try contradiction; try discriminate.
  destruct (all_some l) as [m' |]; [| discriminate]. injection e as <-. destruct i as [<- | i].
  - exists a. split; [reflexivity | left; reflexivity].
  - destruct (IH m' o eq_refl i) as [b [-> k]]. exists b. split; [reflexivity | right; exact k].
Qed.

Lemma enclosed_all : forall ps th a, all_some (map (enclose_parameter bits) ps) = Some a ->
  Forall2 scaled_within ps th -> Forall2 contains a th.
Proof.
  intros ps th a e h. revert a e. induction h as [| p y ps th hp h IH]; intros a e; cbn [map all_some] in e.
  - injection e as <-. constructor.
  - destruct (enclose_parameter bits p) as [b |] eqn:ep; [| discriminate].
    destruct (all_some (map _ ps)) as [a' |]; [| discriminate]. injection e as <-.
    constructor; [exact (enclose_parameter_sound bits p b y ep hp) | auto].
Qed.

Lemma rows_found : forall tape r, (forall e, In e (entries r) -> formula_at tape (place (formulas tape) e) = e) ->
  map_rows (formula_at tape) (map_rows (place (formulas tape)) r) = r.
Proof.
  induction r as [| [a d] r IH]; intro h; [reflexivity |]. rewrite !map_rows_cons. f_equal.
  - f_equal.
    + rewrite map_map. rewrite <- (map_id a) at 2. apply map_ext_in. intros e i. apply h.
      cbn [entries flat_map fst]. apply in_or_app. left. apply in_or_app. left. exact i.
    + apply h. cbn [entries flat_map snd]. apply in_or_app. left. apply in_or_app. right. left. reflexivity.
  - apply IH. intros e i. apply h. cbn [entries flat_map]. apply in_or_app. right. exact i.
Qed.

Lemma speed2_resized : forall c P m, 0 < c -> forall v, speed2 (map (resized c) m) (vscale c P) v = speed2 m P v.
Proof.
  intros c P m h v. induction m as [| l m IH]; [reflexivity |]. cbn [map speed2 fold_right].
  destruct (resized_same c P h l) as [-> _]. unfold speed2 in IH. rewrite IH. reflexivity.
Qed.

Lemma reaches_resized : forall c P m, 0 < c -> Forall (reaches (vscale c P)) (map (resized c) m) -> Forall (reaches P) m.
Proof.
  intros c P m h. induction m as [| l m IH]; intro k; [constructor |]. inversion k; subst.
  constructor; [| auto]. apply (resized_same c P h l). assumption.
Qed.

Lemma represents_nth : forall P theta fs m i f, Forall2 (represents P theta) fs m -> nth_error fs i = Some f ->
  exists l, nth_error m i = Some l /\ represents P theta f l.
Proof.
  intros P theta fs m i f h. revert i. induction h as [| g l fs m hg h IH]; intros [| i] e; try discriminate.
  - injection e as <-. exists l. auto.
  - exact (IH i e).
Qed.

Lemma nonzero_coordinates : forall v, v <> vzero -> nonzero (coordinates v).
Proof. intros v h. unfold nonzero. rewrite dot_coordinates, <- norm2_dot. apply norm2_pos, h. Qed.

Lemma speed2_zero : forall m P, speed2 m P vzero = 0.
Proof.
  intros m P. induction m as [| l m IH]; [reflexivity |]. cbn [speed2 fold_right]. unfold speed2 in IH. rewrite IH.
  unfold Vec3.dot, vzero. cbn. ring.
Qed.

Lemma vzero_dec : forall v, v = vzero \/ v <> vzero.
Proof.
  intro v. destruct (Req_dec (norm2 v) 0) as [z | z]; [left; apply norm2_zero, z | right].
  intro e. apply z. subst v. unfold norm2, vzero. cbn. ring.
Qed.

(** *** Bodies *)

Section Bodies.
Variables x theta : list R.
Variable s : Z.
Local Notation value := (value x theta).
Let ratio := / two_to s.
Definition located_at (u : evec) : vec := Vec (value (ex u)) (value (ey u)) (value (ez u)).
Definition rod_stands (unit : R) (f : option (evec * evec * formula)) (l : option (vec * vec * R)) : Prop :=
  match f with
  | Some (tip, A, len) => exists C V L, l = Some (C, V, L) /\ vscale unit C = located_at tip /\ vscale unit V = located_at A /\ unit * L = value len
  | None => True
  end.
Variable tape : list (op address).
Variables (params : list fixed) (rods : list (option (evec * evec * formula))) (placed : evec -> evec) (real : list (option (vec * vec * R))) (place_of : vec -> vec).
Hypothesis rods_are : Forall2 (rod_stands ratio) rods real.
Hypothesis placed_is : forall u v, located_at u = vscale ratio v -> located_at (placed u) = vscale ratio (place_of v).
Local Notation found := (place (formulas tape)).

Lemma quotient_resized : forall a b, ratio * a / (ratio * b) = a / b.
Proof.
  intros a b. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0. destruct (Req_dec b 0) as [-> | z]; [| field; lra].
  rewrite Rmult_0_r. unfold Rdiv. rewrite Rinv_0. ring.
Qed.

Lemma exact_in_unit : forall y, exact_value (exactly y, s) = ratio * Claim.value y.
Proof. intro y. unfold exact_value. cbn. unfold Rdiv. fold ratio. ring. Qed.

Lemma base_part_value : forall c a b, base_part c a = Some b -> value b = value c - value a.
Proof.
  intros c a b h. unfold base_part in h. destruct (same a c) eqn:e.
  - injection h as <-. apply same_sound in e. subst. change (value (integer 0)) with 0. ring.
  - destruct a as [o]. destruct o as [| | | | a d | | | | | |]; try discriminate h. destruct (same a c) eqn:g; [| discriminate h].
    injection h as <-. apply same_sound in g. subst. cbn. ring.
Qed.

Lemma first_end_value : forall tip A y, located_at (first_end tip A y) = located_at (map2 minus tip (scaled (minus (integer 1) y) A)).
Proof.
  intros tip A y. unfold first_end. destruct (base_part (ex tip) (ex A)) as [b |] eqn:eb; [| reflexivity].
  destruct (base_part (ey tip) (ey A)) as [c |] eqn:ec; [| reflexivity]. destruct (base_part (ez tip) (ez A)) as [d |] eqn:ed; [| reflexivity].
  apply base_part_value in eb, ec, ed. unfold located_at. cbn [map2 scaled ex ey ez]. rewrite !value_plus, !value_minus, !value_times, !value_minus, eb, ec, ed.
  change (value (integer 1)) with 1. f_equal; ring.
Qed.

Lemma segment_there : forall q b e e', map value q = map exact_value (body_numbers s b) -> segment_formulas rods placed q b = Some (e, e') ->
  exists p p', segment_along real place_of b = Some (p, p') /\ located_at e = vscale ratio p /\ located_at e' = vscale ratio p'.
Proof.
  intros q b e e' V h. pose proof exact_in_unit as N.
  assert (At : forall k, value (nth k q (integer 0)) = nth k (map exact_value (body_numbers s b)) 0)
    by (intro k; rewrite <- V; symmetry; exact (map_nth value q (integer 0) k)).
  assert (Three : forall k, located_at (vector_at q k) = Vec (nth k (map exact_value (body_numbers s b)) 0) (nth (1 + k) (map exact_value (body_numbers s b)) 0) (nth (2 + k) (map exact_value (body_numbers s b)) 0))
    by (intro k; unfold located_at, vector_at; cbn [ex ey ez]; rewrite !At; reflexivity).
  destruct b as [i rad tb up o | rad p p' | rad p p']; cbn [segment_formulas segment_along] in *.
  - destruct (nth_error rods i) as [[[[tip A] len] |] |] eqn:nf; try discriminate. injection h as <- <-.
    assert (R0 : exists C V L, nth_error real i = Some (Some (C, V, L)) /\ vscale ratio C = located_at tip /\ vscale ratio V = located_at A /\ ratio * L = value len).
    { clear - rods_are nf. revert i nf. induction rods_are as [| f l rods' real' hf hs IH]; intros [| i] nf; try discriminate; cbn [nth_error] in *.
      - injection nf as ->. destruct hf as [C [V [L [-> h]]]]. exists C, V, L. split; [reflexivity | exact h].
      - exact (IH hs i nf). }
    destruct R0 as [C [W [L [-> [e1 [e2 e3]]]]]]. eexists. eexists. split; [reflexivity |].
    pose proof (Three 2%nat) as O. pose proof (At 0%nat) as T0. pose proof (At 1%nat) as T1. cbn [body_numbers position_numbers map app nth Nat.add] in O, T0, T1. rewrite !N in O, T0, T1.
    unfold located_at in O, e1, e2. unfold vscale in e1, e2. injection O as o1 o2 o3. injection e1 as c1 c2 c3. injection e2 as a1 a2 a3.
    pose proof (first_end_value tip A (over (nth 0 q (integer 0)) len)) as B. unfold located_at in B. cbn [map2 scaled ex ey ez] in B. injection B as b1 b2 b3.
    unfold located_at. cbn [map2 scaled ex ey ez vector_at]. cbn [vector_at ex ey ez Nat.add] in o1, o2, o3. rewrite !value_plus, b1, b2, b3.
    rewrite !value_minus, !value_times, !value_minus, !value_over, T0, T1, <- e3, !quotient_resized. cbn [Nat.add]. rewrite o1, o2, o3, <- c1, <- c2, <- c3, <- a1, <- a2, <- a3, ?N.
    change (value (integer 1)) with 1. unfold vadd, vsub, vscale, located. cbn [vx vy vz]. split; f_equal; ring.
  - injection h as <- <-. eexists. eexists. split; [reflexivity |]. rewrite !Three. cbn [body_numbers position_numbers map app nth Nat.add]. rewrite !N. split; reflexivity.
  - injection h as <- <-. eexists. eexists. split; [reflexivity |].
    split; apply placed_is; rewrite Three; cbn [body_numbers position_numbers map app nth Nat.add]; rewrite !N; reflexivity.
Qed.

Lemma body_numbers_length : forall b, length (body_numbers s b) = 6%nat.
Proof. intros []; reflexivity. Qed.

Theorem bodies_apart : forall one other b q a a' c d distance n whole divided, map value q = map exact_value (body_numbers s one ++ body_numbers s other) ->
  segments_along rods placed q one other = Some ((a, a'), (c, d)) -> (forall k, In k (flat_map list_of [a; a'; c; d]) -> value (formula_at tape (found k)) = value k) ->
  contains distance (/ two_to s * (Claim.value (radius_of one) + Claim.value (radius_of other) + Claim.value b)) -> (0 <= lo distance)%Z ->
  Check.holds bits tape whole divided [] params theta n x (Apart (ends_at found a) (ends_at found a') (ends_at found c) (ends_at found d) distance) ->
  are_clear (segment_along real place_of) one other b.
Proof.
  intros one other b q a a' c d distance n whole divided V es E hd d0 H. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0, hd.
  unfold segments_along in es. destruct (segment_formulas rods placed (firstn 6 q) one) as [[e1 e1'] |] eqn:s1; [| discriminate].
  destruct (segment_formulas rods placed (skipn 6 q) other) as [[e2 e2'] |] eqn:s2; [| discriminate]. injection es as -> -> -> ->.
  rewrite map_app in V.
  assert (L : length (map exact_value (body_numbers s one)) = 6%nat) by (rewrite map_length; apply body_numbers_length).
  assert (V1 : map value (firstn 6 q) = map exact_value (body_numbers s one)).
  { rewrite <- firstn_map, V, <- L. rewrite firstn_app, Nat.sub_diag, firstn_O, app_nil_r. apply firstn_all. }
  assert (V2 : map value (skipn 6 q) = map exact_value (body_numbers s other)).
  { rewrite <- skipn_map, V, <- L. rewrite skipn_app, Nat.sub_diag, skipn_all. reflexivity. }
  destruct (segment_there _ _ _ _ V1 s1) as [p [p' [g1 [v1 v1']]]]. destruct (segment_there _ _ _ _ V2 s2) as [w [w' [g2 [v2 v2']]]].
  exists p, p', w, w'. split; [exact g1 |]. split; [exact g2 |]. intros y0 z0 hy hz.
  assert (At : forall y v, In y [a; a'; c; d] -> located_at y = vscale ratio v ->
    each (fun i => value (formula_at tape i)) (ends_at found y) = Spatial (ratio * vx v) (ratio * vy v) (ratio * vz v)).
  { intros y v iy e. unfold each, ends_at. cbn [along_x along_y along_z].
    assert (I : forall k, In k (list_of y) -> In k (flat_map list_of [a; a'; c; d])) by (intros k ik; apply in_flat_map; exists y; split; assumption).
    rewrite !E by (apply I; cbn; tauto). f_equal; [exact (f_equal vx e) | exact (f_equal vy e) | exact (f_equal vz e)]. }
  cbn [Check.holds] in H. cbv zeta in H.
  rewrite (At a p ltac:(cbn; tauto) v1), (At a' p' ltac:(cbn; tauto) v1'), (At c w ltac:(cbn; tauto) v2), (At d w' ltac:(cbn; tauto) v2') in H.
  specialize (H _ y0 z0 hd (contains_nonneg bits _ _ d0 hd) hy hz).
  apply Rmult_le_reg_l with (ratio ^ 2); [apply pow_lt, r0 |]. apply Rlt_le.
  rewrite Rpow_mult_distr in H. apply Rlt_le_trans with (1 := H).
  unfold inner, away, between, both, norm2, towards, vsub, vadd, vscale. cbn [along_x along_y along_z vx vy vz]. apply Req_le. ring.
Qed.
End Bodies.

Section Accepted.
Variables (c : claim) (s : Z) (ds : list Z) (m : list leg) (P : vec) (theta : list R) (params : list fixed).
Let ratio := / two_to s.
Let fs := all_formulas s ds (legs c) 0.
Variable tape : list (op address).
Local Notation Q := (vscale ratio P).
Local Notation x := (coordinates Q).
Local Notation found := (place (formulas tape)).
Hypothesis represented : Forall2 (represents Q theta) fs (map (resized ratio) m).
Hypothesis whole_found : forall e, In e (entries (whole_rows fs)) -> formula_at tape (found e) = e.
Hypothesis divided_found : forall e, In e (entries (divided_rows fs)) -> formula_at tape (found e) = e.

Lemma of_rows_speed : forall bound,
  of_rows tape (map_rows found (whole_rows fs)) (map_rows found (divided_rows fs)) theta x bound ->
  Forall (reaches P) m /\ exists r, bound r /\ forall v, energy r (coordinates v) = speed2 m P v.
Proof.
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0.
  intros bound [r [which [[def pos] h]]]. rewrite (rows_found tape _ whole_found), (rows_found tape _ divided_found) in which.
  assert (K : Forall (reaches Q) (map (resized ratio) m) /\
    forall v, energy (map_rows (value x theta) r) (coordinates v) = speed2 (map (resized ratio) m) Q v).
  { destruct which as [-> | ->]; [apply whole_speed | apply divided_speed]; assumption. }
  destruct K as [K1 K2]. split; [exact (reaches_resized ratio P m r0 K1) |].
  exists (map_rows (value x theta) r). split; [exact h |]. intro v. rewrite K2. apply speed2_resized, r0.
Qed.

Variable j : nat * nat.
Variable r : requirement.
Hypothesis bound_at : nth (fst j) theta 0 = bound_value s r.
Hypothesis extras_at : map (value x theta) (numbered (snd j) (extras s r)) = map exact_value (extras s r).
Hypothesis range_found : forall f, In f (range_formula fs s j r) -> formula_at tape (found f) = f.
Variable t : test.
Hypothesis is_test : test_of found (layouts s ds (legs c)) fs s j r = Some t.
Hypothesis test_holds : Check.holds bits tape (map_rows found (whole_rows fs)) (map_rows found (divided_rows fs)) [] params theta 3 x t.

Lemma two_to_0 : two_to 0 = 1.
Proof. reflexivity. Qed.

Lemma kappa_enclosed : forall q b a, bound_of s q = (exactly (Over (1 // 1) b), 0%Z) ->
  enclose_parameter bits (bound_of s q) = Some a -> contains (sqr bits a) ((1 / Claim.value b) ^ 2).
Proof.
  intros q b a e h. apply sqr_sound, (enclose_parameter_sound bits _ _ _ h). rewrite e.
  exists (1 / Claim.value b). cbn [fst snd]. rewrite two_to_0. unfold within, exactly. cbn [least greatest Claim.value].
  replace (1 / 1) with 1 by field. split; [lra | unfold Rdiv; rewrite Rinv_1; ring].
Qed.

Lemma lower_fulfilled : is_lower r = true -> Forall (reaches P) m /\ injective m P /\ fulfils c m P r.
Proof.
  intro low. destruct r as [| b | b | i b | i b | i tool b | b | i b | b | joint b | b | one other b | i one other b | i a v b | i tool b | | error b | ks kb]; try discriminate; cbn [test_of] in is_test.
  - injection is_test as <-. destruct (of_rows_speed _ (proj2 test_holds)) as [h1 [e [h2 h3]]].
    assert (I : injective m P).
    { intros v nz. rewrite <- h3. specialize (h2 0 (coordinates v) (zero_sound bits) eq_refl (nonzero_coordinates v nz)). lra. }
    split; [exact h1 |]. split; exact I.
  - destruct (enclose_parameter bits (bound_of s (PsiMax b))) as [a |] eqn:E; [| discriminate]. injection is_test as <-.
    destruct (of_rows_speed _ (proj2 test_holds)) as [h1 [e [h2 h3]]].
    assert (B : forall v, v <> vzero -> (1 / Claim.value b) ^ 2 * norm2 v < speed2 m P v).
    { intros v nz. rewrite <- h3, norm2_dot, <- dot_coordinates.
      apply (h2 _ (coordinates v) (kappa_enclosed (PsiMax b) b a eq_refl E) eq_refl (nonzero_coordinates v nz)). }
    split; [exact h1 |]. split.
    + intros v nz. specialize (B v nz). pose proof (pow2_ge_0 (1 / Claim.value b)). pose proof (norm2_nonneg v). nra.
    + intro v. destruct (vzero_dec v) as [-> | nz]; [| apply Rlt_le, B, nz].
      rewrite speed2_zero. unfold norm2, vzero. cbn. lra.
Qed.

Hypothesis reached : Forall (reaches P) m.
Hypothesis machine : Forall2 is_leg_of (legs c) m.
Hypothesis built : Forall well_formed_leg m.
Hypothesis apart : match r with OneToOne | Accuracy _ _ => fulfils c m P r | _ => True end.

Lemma nonneg_of : forall f, In f (range_formula fs s j r) -> is_nonneg tape theta x (found f) -> 0 <= value x theta f.
Proof. intros f i [_ h]. rewrite (range_found f i) in h. exact h. Qed.

Lemma bound_here : value x theta (quantity (bound_of s r) (fst j)) = bound_value s r.
Proof. exact (quantity_value _ _ x theta (fst j) (bound_within s r) bound_at). Qed.

(** Of leg [i]: its formulas stand for the leg in the unit of the check. *)
Lemma leg_at : forall i g, nth_error fs i = Some g ->
  exists l, nth_error m i = Some l /\ represents Q theta g (resized ratio l) /\ reaches P l.
Proof.
  intros i g n. destruct (represents_nth _ _ _ _ _ _ represented n) as [l' [k R]].
  rewrite nth_error_map in k. destruct (nth_error m i) as [l |] eqn:n0; [| discriminate]. injection k as <-.
  exists l. split; [reflexivity |]. split; [exact R |]. rewrite Forall_forall in reached.
  apply reached, (nth_error_In _ _ n0).
Qed.

Lemma ratio_pos : 0 < ratio.
Proof. apply Rinv_0_lt_compat, two_to_pos. Qed.

(** The requirements that one formula decides: [f], which is not negative. *)
Lemma sign_fulfilled : is_least r = false -> forall f, range_formula fs s j r = [f] -> 0 <= value x theta f -> fulfils c m P r.
Proof.
  pose proof ratio_pos as r0. pose proof bound_here as B.
  intros least f E h. destruct r as [| b | b | i b | i b | i tool b | b | i b | b | joint b | b | one other b | i one other b | i a v b | i tool b | | error b | ks kb]; try discriminate; cbn [range_formula bound_of] in E, B;
    try (destruct (nth_error fs i) as [g |] eqn:n; [| discriminate]; destruct (leg_at i g n) as [l [n0 [R0 re]]];
      destruct R0 as [R1 [_ [_ [J [R2 [R3 _]]]]]]); cbn [fulfils].
  - injection E as <-. exists l. split; [exact n0 |]. rewrite value_minus, J, B in h.
    destruct (resized_same ratio P r0 l) as [_ [e _]]. rewrite e in h. unfold bound_value in h. cbn in h.
    fold ratio in h. unfold Rdiv in h. fold ratio in h. apply Rmult_le_reg_l with ratio; [exact r0 | lra].
  - injection E as <-. exists l. split; [exact n0 |]. rewrite value_minus, J, B in h.
    destruct (resized_same ratio P r0 l) as [_ [e _]]. rewrite e in h. unfold bound_value in h. cbn in h.
    unfold Rdiv in h. fold ratio in h. apply Rmult_le_reg_l with ratio; [exact r0 | lra].
  - injection E as <-. exists l. split; [exact n0 |]. intros v hv.
    destruct (resized_same ratio P r0 l) as [er [_ eq]]. assert (D : 0 < value x theta (f_D g)) by (apply R2, eq, re).
    destruct (R1 D) as [_ hr]. specialize (hr v). rewrite er in hr. rewrite <- hr.
    rewrite !value_minus, value_times, !value_square, B in h. set (A := vvalue Q theta (f_A g)) in *.
    replace (value x theta (ex (f_A g))) with (vx A) in h by reflexivity.
    replace (value x theta (ey (f_A g))) with (vy A) in h by reflexivity.
    replace (value x theta (ez (f_A g))) with (vz A) in h by reflexivity.
    set (k := bound_value s (JointSpeed i tool b)) in *. set (d := value x theta (f_D g)) in *.
    assert (K : k ^ 2 * Claim.value tool ^ 2 <= Claim.value b ^ 2).
    { unfold k, bound_value. cbn [bound_of fst snd exactly greatest Claim.value]. rewrite two_to_0.
      destruct (Req_dec (Claim.value tool) 0) as [z | z].
      - rewrite z. pose proof (pow2_ge_0 (Claim.value b)). replace (0 ^ 2) with 0 by ring. lra.
      - apply Req_le. field. exact z. }
    clearbody k d. assert (C : Vec3.dot A v ^ 2 <= norm2 A * norm2 v).
    { pose proof (lagrange A v) as La. pose proof (norm2_nonneg (cross A v)). lra. }
    assert (N : norm2 A <= k ^ 2 * d) by (unfold norm2; lra).
    pose proof (norm2_nonneg v) as V0. pose proof (pow2_ge_0 k) as K0.
    apply Rle_trans with (k ^ 2 * norm2 v); [| apply Rle_trans with (2 := K); apply Rmult_le_compat_l; assumption].
    apply Rmult_le_reg_r with d; [exact D |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
    apply Rle_trans with (1 := C). replace (k ^ 2 * norm2 v * d) with (k ^ 2 * d * norm2 v) by ring.
    apply Rmult_le_compat_r; assumption.
  - destruct (f_length g) as [len |] eqn:el; [| discriminate]. injection E as <-.
    destruct (R3 len eq_refl) as [k [e1 [e2 [e3 _]]]]. destruct (guided_resized ratio P r0 l k e1) as [k' [-> [g1 [g2 _]]]].
    exists k'. split; [exact n0 |]. assert (D : 0 < value x theta (f_D g)) by (apply R2, (resized_same ratio P r0 _), re).
    rewrite value_minus, value_times, !value_square, B, e2, (e3 D), g1, g2 in h. unfold bound_value in h. cbn in h.
    replace (two_to 0) with 1 in h by reflexivity. unfold Rdiv in h. rewrite Rinv_1, Rmult_1_r in h.
    apply Rmult_le_reg_l with (ratio ^ 2); [apply pow_lt, r0 |]. nra.
  - destruct fs as [| f1 [| f2 [| f3 [|]]]]; try discriminate.
Qed.

Lemma cons_related : forall (A B : Type) (R : A -> B -> Prop) a b u v, Forall2 R (a :: u) (b :: v) -> R a b /\ Forall2 R u v.
Proof. intros A B R a b u v h. inversion h. auto. Qed.

Lemma determinant_value : forall a b c, value x theta (determinant a b c)
  = det (Mat (vvalue Q theta a) (vvalue Q theta b) (vvalue Q theta c)).
Proof.
  intros. unfold determinant, minor. rewrite !value_plus, !value_minus, !value_times, !value_minus, !value_times.
  unfold det, Vec3.dot, cross, vvalue. cbn [row1 row2 row3 vx vy vz]. ring.
Qed.

Lemma det_scaled : forall k k' k'' a b c, det (Mat (vscale k a) (vscale k' b) (vscale k'' c)) = k * k' * k'' * det (Mat a b c).
Proof. intros. unfold det, Vec3.dot, cross, vscale. cbn [row1 row2 row3 vx vy vz]. ring. Qed.

Lemma margin_fulfilled : is_least r = false -> forall f g, range_formula fs s j r = [f; g] -> 0 <= value x theta f \/ 0 <= value x theta g -> fulfils c m P r.
Proof.
  pose proof ratio_pos as r0. pose proof bound_here as B.
  intros least f g E h. destruct r as [| b | b | i b | i b | i tool b | b | i b | b | joint b | b | one other b | i one other b | i a v b | i tool b | | error b | ks kb]; try discriminate; cbn [range_formula bound_of] in E, B;
    try (destruct (nth_error fs i) as [k |]; [| discriminate]; try discriminate; destruct (f_length k); discriminate).
  pose proof represented as R0. fold fs in R0. destruct fs as [| f1 [| f2 [| f3 [|]]]]; try discriminate.
  injection E as <- <-. destruct m as [| m1 [| m2 [| m3 [| m4 rest]]]]; cbn [map] in R0; try (apply related_length in R0; discriminate).
  apply cons_related in R0 as [H1 R0]. apply cons_related in R0 as [H2 R0]. apply cons_related in R0 as [H3 _].
  destruct H1 as [_ [[_ [c1 b1]] _]]. destruct H2 as [_ [[_ [c2 b2]] _]]. destruct H3 as [_ [[_ [c3 b3]] _]].
  destruct (vector_resized ratio P r0 m1) as [k1 [p1 [v1 g1]]]. destruct (vector_resized ratio P r0 m2) as [k2 [p2 [v2 g2]]]. destruct (vector_resized ratio P r0 m3) as [k3 [p3 [v3 g3]]].
  exists m1, m2, m3. split; [reflexivity |].
  rewrite value_opposite, value_minus, value_plus, determinant_value, !value_times, B, b1, b2, b3, g1, g2, g3, c1, c2, c3, v1, v2, v3, det_scaled in h.
  unfold bound_value in h. cbn in h.
  replace (two_to 0) with 1 in h by reflexivity. unfold Rdiv in h. rewrite Rinv_1, Rmult_1_r in h.
  set (d := det _) in *. set (L := Claim.value b * size_of m1 P * size_of m2 P * size_of m3 P).
  assert (K : Claim.value b * (k1 * size_of m1 P) * (k2 * size_of m2 P) * (k3 * size_of m3 P) = k1 * k2 * k3 * L) by (unfold L; ring).
  assert (t0 : 0 < k1 * k2 * k3) by (repeat apply Rmult_lt_0_compat; assumption). rewrite K in h. clearbody d L. destruct h as [h | h].
  - apply Rle_trans with d; [| apply Rle_abs]. apply Rmult_le_reg_l with (k1 * k2 * k3); [exact t0 | lra].
  - apply Rle_trans with (- d); [| rewrite <- Rabs_Ropp; apply Rle_abs]. apply Rmult_le_reg_l with (k1 * k2 * k3); [exact t0 | lra].
Qed.

(** Rows with D times b/k, of a k of each joint. *)
Lemma each_energy : forall b l ks m0 qs, 0 < Claim.value b -> Forall (fun k => 0 < Claim.value k) ks ->
  Forall2 (represents Q theta) l (map (resized ratio) m0) -> Forall (reaches P) m0 -> length ks = length l ->
  map (value x theta) qs = map (fun k => Claim.value b / Claim.value k) ks -> forall v,
  Claim.value b * energy (map_rows (value x theta) (stiff_each l qs)) (coordinates v) = elastic ks m0 P v.
Proof.
  pose proof ratio_pos as r0. intros b l. induction l as [| f l IH]; intros ks m0 qs b0 k0 R0 RE lk eq v.
  - destruct m0; [| inversion R0]. destruct ks; [| discriminate]. cbn. ring.
  - destruct m0 as [| g m0]; [inversion R0 |]. destruct ks as [| k ks]; [discriminate |]. destruct qs as [| q qs]; [discriminate |].
    apply cons_related in R0 as [R1 R0]. inversion RE as [| ? ? re RE']. inversion k0 as [| ? ? k1 k0']. subst. cbn [map] in eq. injection eq as eq1 eq2.
    destruct R1 as [R1 [_ [_ [_ [R2 _]]]]]. destruct (resized_same ratio P r0 g) as [er [_ eqv]].
    assert (D : 0 < value x theta (f_D f)) by (apply R2, eqv, re). destruct (R1 D) as [_ hr]. specialize (hr v). rewrite er in hr.
    cbn [stiff_each elastic]. rewrite map_rows_cons. cbn [energy fst snd].
    rewrite Rmult_plus_distr_l, (IH ks m0 qs b0 k0' R0 RE' ltac:(cbn in lk; congruence) eq2), values_list, dot_coordinates, value_times, eq1, <- hr.
    f_equal. field. lra.
Qed.

Lemma least_found : forall rs, least_rows fs s j r = Some rs -> map_rows (formula_at tape) (map_rows found rs) = rs.
Proof.
  intros rs e. apply (rows_found tape rs). intros f i. apply range_found.
  destruct r; try discriminate; cbn [range_formula]; cbv zeta; rewrite e; exact i.
Qed.

Lemma stiff_energy : forall q l m0, 0 < value x theta q ->
  Forall2 (represents Q theta) l (map (resized ratio) m0) -> Forall (reaches P) m0 -> forall v,
  energy (map_rows (value x theta) (stiff_rows l q)) (coordinates v) = / value x theta q * speed2 m0 P v.
Proof.
  pose proof ratio_pos as r0. intros q l m0 q0 R0 RE v. revert m0 R0 RE. induction l as [| f l IH]; intros m0 R0 RE.
  - destruct m0; [| inversion R0]. cbn. ring.
  - destruct m0 as [| g m0]; [inversion R0 |]. apply cons_related in R0 as [R1 R0]. inversion RE as [| ? ? re RE']. subst.
    destruct R1 as [R1 [_ [_ [_ [R2 _]]]]]. destruct (resized_same ratio P r0 g) as [er [_ eq]].
    assert (D : 0 < value x theta (f_D f)) by (apply R2, eq, re). destruct (R1 D) as [_ hr]. specialize (hr v). rewrite er in hr.
    change (stiff_rows (f :: l) q) with ((list_of (f_A f), times (f_D f) q) :: stiff_rows l q).
    change (speed2 (g :: m0) P v) with (Vec3.dot (row g P) v ^ 2 + speed2 m0 P v).
    rewrite map_rows_cons. cbn [energy fst snd].
    rewrite (IH m0 R0 RE'), values_list, dot_coordinates, value_times, Rmult_plus_distr_l, <- hr. f_equal. field. lra.
Qed.

Lemma stiff_bound : forall q l m0, Forall2 (represents Q theta) l (map (resized ratio) m0) -> Forall (reaches P) m0 ->
  positive_D (map_rows (value x theta) (stiff_rows l q)) -> forall v, v <> vzero ->
  norm2 v < energy (map_rows (value x theta) (stiff_rows l q)) (coordinates v) -> value x theta q * norm2 v <= speed2 m0 P v.
Proof.
  intros q l m0 R0 RE pos v nz h. pose proof (norm2_pos v nz) as n0.
  assert (q0 : 0 < value x theta q).
  { destruct l as [| f l]; [cbn in h; lra |]. destruct m0 as [| g m0]; [inversion R0 |].
    change (stiff_rows (f :: l) q) with ((list_of (f_A f), times (f_D f) q) :: stiff_rows l q) in pos.
    rewrite map_rows_cons in pos. inversion pos as [| ? ? p1 _]. subst. cbn [snd] in p1. rewrite value_times in p1.
    apply cons_related in R0 as [R1 _]. destruct R1 as [_ [_ [_ [_ [R2 _]]]]]. inversion RE as [| ? ? re _]. subst.
    destruct (resized_same ratio P ratio_pos g) as [_ [_ eq]]. assert (D : 0 < value x theta (f_D f)) by (apply R2, eq, re).
    apply Rmult_lt_reg_l with (value x theta (f_D f)); [exact D | lra]. }
  rewrite (stiff_energy q l m0 q0 R0 RE) in h. apply Rlt_le.
  apply Rmult_lt_reg_l with (/ value x theta q); [apply Rinv_0_lt_compat, q0 |].
  rewrite <- Rmult_assoc, Rinv_l, Rmult_1_l by lra. exact h.
Qed.

Lemma couples_energy : forall l m0, Forall2 (represents Q theta) l (map (resized ratio) m0) ->
  forall rs, couple_rows l = Some rs -> positive_D (map_rows (value x theta) rs) ->
  exists cs, Forall2 (fun l c => couple_of l P = Some c /\ c <> vzero) m0 cs /\
    forall v, energy (map_rows (value x theta) rs) (coordinates v) = fold_right (fun c sum => Vec3.dot (normalised c) v ^ 2 + sum) 0 cs.
Proof.
  pose proof ratio_pos as r0. induction l as [| f l IH]; intros m0 R0 rs e p.
  - injection e as <-. destruct m0; [| inversion R0]. exists []. split; [constructor | reflexivity].
  - destruct m0 as [| g m0]; [inversion R0 |]. apply cons_related in R0 as [R1 R0]. cbn [couple_rows] in e.
    destruct (f_couple f) as [k |] eqn:ec; [| discriminate]. destruct (couple_rows l) as [rest |] eqn:el; [| discriminate].
    injection e as <-. rewrite map_rows_cons in p. inversion p as [| ? ? p1 p2]. subst. cbn [snd] in p1.
    destruct (IH m0 R0 rest eq_refl p2) as [cs [h1 h2]]. destruct R1 as [_ [_ [_ [_ [_ [_ [R1 _]]]]]]]. specialize (R1 k ec).
    rewrite couple_resized in R1 by exact r0. destruct (couple_of g P) as [u |] eqn:eu; [| discriminate]. cbn [option_map] in R1.
    assert (R1' : vscale ratio u = vvalue Q theta k) by congruence. clear R1. rename R1' into R1. rewrite value_product, <- norm2_dot, <- R1, norm2_scale in p1.
    assert (u0 : u <> vzero) by (intro z; subst u; unfold norm2, vzero in p1; cbn in p1; lra).
    exists (u :: cs). split; [constructor; [split; assumption | exact h1] |]. intro v.
    rewrite map_rows_cons. cbn [energy fst snd fold_right]. rewrite h2. f_equal.
    rewrite values_list, dot_coordinates, value_product, <- norm2_dot, <- R1, norm2_scale.
    pose proof (norm2_pos u u0) as n0. pose proof (sqrt_lt_R0 _ n0) as s0.
    assert (S : sqrt (norm2 u) ^ 2 = norm2 u) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra).
    assert (E1 : forall a, Vec3.dot (vscale a u) v = a * Vec3.dot u v) by (intro a; unfold Vec3.dot, vscale; cbn [vx vy vz]; ring).
    unfold normalised. rewrite !E1, !Rpow_mult_distr, pow_inv, S. field. split; lra.
Qed.

(** What the rods of formulas are. *)
Lemma rods_stand : Forall2 (rod_stands x theta ratio) (rods_of fs) (map (fun l => rod_of l P) m).
Proof.
  pose proof ratio_pos as r0. clear - represented r0. unfold rods_of. revert represented. generalize m. induction fs as [| f fs' IH]; intros [| l m'] h; try (inversion h; fail); cbn [map]; constructor.
  - inversion h as [| ? ? ? ? R0 _]; subst. destruct R0 as [_ [_ [_ [_ [_ [_ [_ R0]]]]]]]. destruct (f_tip f) as [tip |] eqn:et; cbn [option_map rod_stands]; [| exact I].
    specialize (R0 tip eq_refl). rewrite rod_resized in R0 by exact r0. destruct (rod_of l P) as [[[C A] L] |]; [| discriminate].
    exists C, A, L. split; [reflexivity |]. split; [exact (f_equal (fun o => match o with Some (C, _, _) => C | None => C end) R0) |].
    split; [exact (f_equal (fun o => match o with Some (_, A, _) => A | None => A end) R0) | exact (f_equal (fun o => match o with Some (_, _, L) => L | None => L end) R0)].
  - apply IH. inversion h. assumption.
Qed.

Lemma clearance_fulfilled : forall one other b a a' c' d' distance, r = Clearance one other b ->
  segments fs s (snd j) one other = Some ((a, a'), (c', d')) -> contains distance (bound_value s r) -> (0 <= lo distance)%Z ->
  Check.holds bits tape (map_rows found (whole_rows fs)) (map_rows found (divided_rows fs)) [] params theta 3 x
    (Apart (ends_at found a) (ends_at found a') (ends_at found c') (ends_at found d') distance) ->
  fulfils c m P r.
Proof.
  intros one other b a a' c' d' distance er es hd d0 H.
  pose proof range_found as RF. pose proof extras_at as EX. subst r. cbn [extras range_formula] in *. rewrite es in RF.
  refine (bodies_apart x theta s tape params (rods_of fs) (map2 plus point) _ (vadd P) rods_stand _ one other b _ _ _ _ _ distance _ _ _ EX es _ _ d0 H).
  - intros u v e. change (vvalue Q theta (map2 plus point u) = vscale ratio (vadd P v)). rewrite vvalue_plus, vvalue_point.
    change (vvalue Q theta u = vscale ratio v) in e. rewrite e. unfold vadd, vscale. cbn [vx vy vz]. f_equal; ring.
  - intros k ik. rewrite (RF k ik). reflexivity.
  - replace (/ two_to s * (Claim.value (radius_of one) + Claim.value (radius_of other) + Claim.value b)) with (bound_value s (Clearance one other b)); [exact hd |].
    unfold bound_value. cbn. unfold Rdiv. ring.
Qed.

Lemma rod_length : forall l C A L, well_formed_leg l -> reaches P l -> rod_of l P = Some (C, A, L) -> norm2 A = L ^ 2 /\ 0 < L ^ 2.
Proof.
  intros [k | base platform axis | n] C A L ok re e; cbn [rod_of well_formed_leg reaches] in *; [| | discriminate].
  - assert (E : leg_vector k P = A /\ leg_length k = L) by (split; congruence). destruct E as [<- <-].
    split; [exact (leg_vector_length k P ok re) | apply pow_lt, ok].
  - assert (E : span base platform P = A /\ sqrt (norm2 (span base platform P)) = L) by (split; congruence). destruct E as [<- <-].
    rewrite <- Rsqr_pow2, Rsqr_sqrt by lra. split; [reflexivity | exact re].
Qed.

Lemma beside_fulfilled : forall i one other b, r = Beside i one other b ->
  (exists f, range_formula fs s j r = [f] /\ 0 <= value x theta f) -> fulfils c m P r.
Proof.
  intros i one other b er [f [ef h]]. pose proof ratio_pos as r0. pose proof bound_here as B. pose proof extras_at as EX. subst r.
  cbn [range_formula] in ef. destruct (nth_error fs i) as [g |] eqn:ng; [| discriminate]. destruct (f_tip g) as [tip |] eqn:et; [| discriminate].
  set (q := numbered (snd j) (extras s (Beside i one other b))) in *.
  assert (e1 : beside_formula g q (quantity (bound_of s (Beside i one other b)) (fst j)) = f) by congruence. subst f. clear ef.
  destruct (leg_at i g ng) as [l [nl [R0 re]]]. destruct R0 as [_ [_ [_ [_ [_ [_ [_ R0]]]]]]]. specialize (R0 tip et).
  unfold ratio in R0. rewrite rod_resized in R0 by exact r0. fold ratio in R0. destruct (rod_of l P) as [[[C A] L] |] eqn:er; [| discriminate].
  assert (e2 : vscale ratio A = vvalue Q theta (f_A g)) by congruence. assert (e3 : ratio * L = value x theta (rod g)) by congruence.
  assert (ok : well_formed_leg l) by (apply (proj1 (Forall_forall _ _) built), (nth_error_In _ _ nl)).
  destruct (rod_length l C A L ok re er) as [A2 L2]. exists l, C, A, L. split; [exact nl |]. split; [exact er |]. intros t0 u0.
  assert (N : forall y, exact_value (exactly y, s) = ratio * Claim.value y) by (intro y; unfold exact_value; cbn; unfold Rdiv; fold ratio; ring).
  assert (O1 : vvalue Q theta (vector_at q 0) = vscale ratio (located one)) by (rewrite (vvalue_at _ _ _ _ _ EX); cbn [extras position_numbers map app nth Nat.add]; rewrite !N; reflexivity).
  assert (O2 : vvalue Q theta (vector_at q 3) = vscale ratio (located other)) by (rewrite (vvalue_at _ _ _ _ _ EX); cbn [extras position_numbers map app nth Nat.add]; rewrite !N; reflexivity).
  unfold beside_formula in h. cbv zeta in h. rewrite !value_minus, value_over, !value_square, !value_product, vvalue_minus, O1, O2, <- e2, <- e3, B in h.
  replace (bound_value s (Beside i one other b)) with (ratio * Claim.value b) in h by (unfold bound_value; cbn; unfold Rdiv; fold ratio; ring).
  set (d := vsub (located one) (located other)).
  replace (vsub (vscale ratio (located one)) (vscale ratio (located other))) with (vscale ratio d) in h by (unfold d, vsub, vscale; cbn [vx vy vz]; f_equal; ring).
  assert (S1 : forall a b c e, Vec3.dot (vscale a b) (vscale c e) = a * c * Vec3.dot b e) by (intros; unfold Vec3.dot, vscale; cbn [vx vy vz]; ring).
  rewrite !S1 in h. assert (L0 : L <> 0) by (intro z; rewrite z in L2; lra).
  replace ((ratio * ratio * Vec3.dot d A) ^ 2 / (ratio * L) ^ 2) with (ratio ^ 2 * (Vec3.dot d A ^ 2 / L ^ 2)) in h by (field; split; lra).
  assert (K : Claim.value b ^ 2 <= norm2 d - Vec3.dot d A ^ 2 / L ^ 2).
  { apply Rmult_le_reg_l with (ratio ^ 2); [apply pow_lt, r0 |]. rewrite norm2_dot. rewrite Rpow_mult_distr in h. lra. }
  apply Rle_trans with (1 := K).
  replace (norm2 (vsub (vadd (vsub C (vscale t0 A)) (located one)) (vadd (vsub C (vscale u0 A)) (located other))))
    with (norm2 d + 2 * (u0 - t0) * Vec3.dot d A + (u0 - t0) ^ 2 * norm2 A) by (unfold d, norm2, Vec3.dot, vsub, vadd, vscale; cbn [vx vy vz]; ring).
  rewrite A2. pose proof (pow2_ge_0 ((u0 - t0) * L + Vec3.dot d A / L)) as sq.
  replace (((u0 - t0) * L + Vec3.dot d A / L) ^ 2) with ((u0 - t0) ^ 2 * L ^ 2 + 2 * (u0 - t0) * Vec3.dot d A + Vec3.dot d A ^ 2 / L ^ 2) in sq by (field; exact L0). lra.
Qed.

(** A = q row, q^2 = D. *)
Lemma row_scaled : forall g l, represents Q theta g (resized ratio l) -> reaches P l ->
  exists q, q <> 0 /\ q ^ 2 = value x theta (f_D g) /\ forall v, Vec3.dot (vvalue Q theta (f_A g)) v = q * Vec3.dot (row l P) v.
Proof.
  intros g l [R1 [_ [_ [_ [R2 _]]]]] re. pose proof ratio_pos as r0. destruct (resized_same ratio P r0 l) as [er [_ eq]].
  pose proof (R2 (proj2 eq re)) as D. destruct (R1 D) as [_ h]. rewrite er in h. clear R1 R2 er eq.
  set (A := vvalue Q theta (f_A g)) in *. set (n := row l P) in *. set (d := value x theta (f_D g)) in *. clearbody A n d.
  assert (E : forall v, Vec3.dot A v ^ 2 = d * Vec3.dot n v ^ 2) by (intro v; rewrite <- h; field; lra).
  destruct (Req_dec (norm2 n) 0) as [z | z].
  - apply norm2_zero in z. subst n. exists (sqrt d). split; [apply Rgt_not_eq, sqrt_lt_R0, D |]. split; [rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra |].
    intro v. specialize (E v). unfold Vec3.dot, vzero in *. cbn [vx vy vz] in *. nra.
  - set (q := Vec3.dot A n / norm2 n). assert (q2 : q ^ 2 = d).
    { unfold q. unfold Rdiv. rewrite Rpow_mult_distr, E, <- norm2_dot. field. exact z. }
    assert (qn : q <> 0) by (intro k; rewrite k in q2; lra). exists q. split; [exact qn |]. split; [exact q2 |]. intro v.
    pose proof (E (vadd v n)) as S1. pose proof (E v) as S2. pose proof (E n) as S3.
    assert (Da : forall u, Vec3.dot u (vadd v n) = Vec3.dot u v + Vec3.dot u n) by (intro; unfold Vec3.dot, vadd; cbn [vx vy vz]; ring). rewrite !Da in S1.
    assert (M : Vec3.dot A v * Vec3.dot A n = d * (Vec3.dot n v * Vec3.dot n n)) by nra.
    rewrite <- norm2_dot in M. assert (An : Vec3.dot A n = q * norm2 n) by (unfold q; field; exact z). rewrite An, <- q2 in M.
    apply Rmult_eq_reg_r with (q * norm2 n); [| apply Rmult_integral_contrapositive_currified; assumption]. rewrite M. ring.
Qed.

Lemma whole_forces : forall l m0, Forall2 (represents Q theta) l (map (resized ratio) m0) -> Forall (reaches P) m0 ->
  forall tau, length tau = length m0 -> exists u, length u = length l /\
    (forall v, Linear.dot (Solve.weighted_sum u (map fst (map_rows (value x theta) (whole_rows l)))) (coordinates v) = joint_power m0 tau P v) /\
    (l <> [] -> exists w, Solve.weighted_sum u (map fst (map_rows (value x theta) (whole_rows l))) = coordinates w) /\
    forall i, nth i (map snd (map_rows (value x theta) (whole_rows l))) 0 * nth i u 0 ^ 2 = nth i tau 0 ^ 2.
Proof.
  induction l as [| f l IH]; intros [| g m0] R0 RE [| y tau] e; try discriminate; try (inversion R0; fail).
  - exists []. split; [reflexivity |]. split; [reflexivity |]. split; [intro n; contradiction |]. intros [| i]; cbn; ring.
  - cbn [map] in R0. apply cons_related in R0 as [R1 R0]. inversion RE as [| ? ? re RE']; subst.
    destruct (IH m0 R0 RE' tau ltac:(cbn in e; congruence)) as [u [lu [hu [hw hi]]]]. destruct (row_scaled f g R1 re) as [q [qn [q2 hq]]].
    exists (y / q :: u). change (whole_rows (f :: l)) with ((list_of (f_A f), f_D f) :: whole_rows l). rewrite map_rows_cons. cbn [map fst snd Solve.weighted_sum].
    split; [cbn; congruence |]. split; [| split].
    + intro v. rewrite dot_comb, hu, values_list, dot_coordinates, hq. cbn [joint_power]. field. exact qn.
    + intros _. rewrite values_list. destruct l as [| f' l'].
      * destruct u; [| discriminate]. exists (vscale (y / q) (vvalue Q theta (f_A f))). reflexivity.
      * destruct (hw ltac:(discriminate)) as [w ->]. exists (vadd (vscale (y / q) (vvalue Q theta (f_A f))) w).
        unfold coordinates, comb, vadd, vscale. cbn [merge vx vy vz]. f_equal; [ring |]. f_equal; [ring |]. f_equal; ring.
    + intros [| i]; cbn [nth]; [| apply hi]. rewrite <- q2. field. exact qn.
Qed.

Lemma force_fulfilled : forall i tool b k2 g, r = JointForce i tool b -> nth_error fs i = Some g -> 0 < Claim.value tool -> 0 < Claim.value b ->
  contains k2 ((Claim.value tool / Claim.value b) ^ 2) ->
  Check.holds bits tape (map_rows found (whole_rows fs)) (map_rows found (divided_rows fs)) [] params theta 3 x (Solved i k2) -> fulfils c m P r.
Proof.
  intros i tool b k2 g er ng t0 b0 K H. subst r. destruct (leg_at i g ng) as [l [nl _]]. cbn [fulfils]. split; [exists l; exact nl |].
  intros tau F lt hF le. cbn [Check.holds] in H. rewrite (rows_found tape _ whole_found) in H. destruct H as [_ [l3 H]].
  destruct (whole_forces fs m represented reached tau lt) as [u [lu [hu [hw hi]]]].
  assert (lr : length (map_rows (value x theta) (whole_rows fs)) = length fs) by (unfold map_rows, whole_rows; rewrite !map_length; reflexivity).
  destruct (hw ltac:(intro z; rewrite z in ng; destruct i; discriminate)) as [w ew].
  assert (wF : w = F).
  { assert (G : forall v, Vec3.dot w v = Vec3.dot F v) by (intro v; rewrite hF, <- hu, ew, dot_coordinates; reflexivity).
    pose proof (G e1) as G1. pose proof (G e2) as G2. pose proof (G e3) as G3. unfold Vec3.dot, e1, e2, e3 in G1, G2, G3. cbn [vx vy vz] in G1, G2, G3. apply vec_ext; lra. }
  subst w. specialize (hi i). set (tl_ := Claim.value tool) in *. set (y := Claim.value b) in *.
  enough (Q2 : nth i tau 0 ^ 2 <= y ^ 2) by (apply Rabs_le; split; nra).
  destruct (Rlt_dec 0 (Linear.dot u u)) as [nz | z].
  - specialize (H _ u K (pow2_ge_0 _) ltac:(congruence) nz). cbv zeta in H. rewrite ew, dot_coordinates, <- norm2_dot, hi in H.
    assert (E : (tl_ / y) ^ 2 * nth i tau 0 ^ 2 = tl_ ^ 2 * (nth i tau 0 / y) ^ 2) by (field; lra).
    assert (t2 : 0 < tl_ ^ 2) by (apply pow_lt; exact t0). assert ((nth i tau 0 / y) ^ 2 < 1) by (apply Rmult_lt_reg_l with (tl_ ^ 2); lra).
    replace (nth i tau 0 ^ 2) with ((nth i tau 0 / y) ^ 2 * y ^ 2) by (field; lra). pose proof (pow2_ge_0 y). nra.
  - pose proof (zero_vector u ltac:(lra)) as Z0. assert (un : nth i u 0 = 0).
    { destruct (nth_in_or_default i u 0) as [i' | e']; [| exact e']. rewrite Forall_forall in Z0. symmetry. exact (Z0 _ i'). }
    rewrite <- hi, un. pose proof (pow2_ge_0 y). lra.
Qed.

Lemma acceleration_fulfilled : forall i a v b, r = JointAcceleration i a v b -> 0 <= Claim.value a -> 0 < Claim.value b ->
  (exists f, range_formula fs s j r = [f] /\ 0 <= value x theta f) -> fulfils c m P r.
Proof.
  intros i a v b er a0 b0 [f [ef h]]. pose proof ratio_pos as r0. pose proof bound_here as B. pose proof extras_at as EX. subst r.
  cbn [range_formula] in ef. destruct (nth_error fs i) as [g |] eqn:ng; [| discriminate]. destruct (leg_at i g ng) as [l [nl [R0 re]]].
  assert (ok : well_formed_leg l) by (apply (proj1 (Forall_forall _ _) built), (nth_error_In _ _ nl)).
  set (q := numbered (snd j) (extras s (JointAcceleration i a v b))) in *.
  assert (K : value x theta (nth 0 q (integer 0)) = ratio * (Claim.value v ^ 2 / Claim.value b)).
  { rewrite (value_at _ _ _ _ _ EX). unfold exact_value. cbn. unfold Rdiv. fold ratio. ring. }
  assert (A : value x theta (quantity (bound_of s (JointAcceleration i a v b)) (fst j)) = Claim.value a / Claim.value b).
  { rewrite B. unfold bound_value. cbn [bound_of fst snd exactly greatest Claim.value]. rewrite two_to_0. unfold Rdiv. rewrite Rinv_1. ring. }
  set (fa := quantity (bound_of s (JointAcceleration i a v b)) (fst j)) in *. set (fb := nth 0 q (integer 0)) in *.
  destruct R0 as [_ [_ [_ [_ [R2 [R3 [_ R7]]]]]]]. destruct (resized_same ratio P r0 l) as [_ [_ eq]]. pose proof (R2 (proj2 eq re)) as D.
  cbn [fulfils]. exists l. split; [exact nl |]. intros path V e hp hv hc hV hA. unfold acceleration_formula in ef.
  destruct (f_length g) as [len |] eqn:el.
  - assert (e1 : minus (integer 1) (times (over len (root (f_D g))) (plus fa (times (over fb (rod g)) (square (over len (root (f_D g))))))) = f) by congruence.
    subst f. destruct (R3 len eq_refl) as [k' [e2 [e3 [e4 _]]]]. destruct (guided_resized ratio P r0 l k' e2) as [k [-> [g1 [g2 _]]]].
    cbn [row well_formed_leg reaches] in *. rewrite <- hp in re.
    destruct (slider_acceleration k path V e ok re hv hc) as [y [h1 h2]]. exists y. split; [exact h1 |].
    specialize (h2 (Claim.value a) (Claim.value v) a0 hV hA). cbv zeta in h2. apply Rle_trans with (1 := h2).
    rewrite value_minus, value_times, value_plus, value_times, value_square, !value_over, value_root, A, K in h. unfold rod in h. rewrite el, e3, g1, (e4 D), g2 in h.
    assert (Sq : sqrt ((ratio * eta k P) ^ 2) = ratio * Kinematics.s k P).
    { rewrite <- hp. unfold eta. rewrite Rpow_mult_distr, Rpow_mult_distr, (mode_squared k ok), Rmult_1_l, <- Rpow_mult_distr.
      apply sqrt_pow2. apply Rmult_le_pos; lra. }
    rewrite Sq in h. rewrite hp in *. change (value x theta (integer 1)) with 1 in h.
    set (z := Kinematics.s k P) in *. set (L := leg_length k) in *. assert (L0 : 0 < L) by apply ok.
    replace (ratio * L / (ratio * z)) with (L / z) in h by (field; split; lra).
    replace (ratio * (Claim.value v ^ 2 / Claim.value b) / (ratio * L)) with (Claim.value v ^ 2 / L / Claim.value b) in h by (field; repeat split; lra).
    set (A0 := Claim.value a) in *. set (V0 := Claim.value v ^ 2 / L) in *. set (T := L / z) in *. set (b' := Claim.value b) in *.
    replace (T * (A0 / b' + V0 / b' * T ^ 2)) with (T * (A0 + V0 * T ^ 2) * / b') in h by (field; lra).
    apply Rmult_le_reg_r with (/ b'); [apply Rinv_0_lt_compat, b0 |]. rewrite Rinv_r by lra. lra.
  - destruct (f_tip g) as [tip |] eqn:et; [| discriminate].
    assert (e1 : minus (minus (integer 1) fa) (over fb (rod g)) = f) by congruence. subst f.
    specialize (R7 tip eq_refl). unfold ratio in R7. rewrite rod_resized in R7 by exact r0. fold ratio in R7.
    destruct l as [k | base platform axis | n]; [| | discriminate].
    + exfalso. exact (slider_length s (legs c) m machine ds 0 i g k ng nl el).
    + cbn [rod_of] in R7. assert (e2 : value x theta (rod g) = ratio * sqrt (norm2 (span base platform P))) by congruence.
      cbn [row well_formed_leg reaches] in *. rewrite <- hp in re.
      destruct (strut_acceleration base platform path V e re hv hc) as [y [h1 h2]]. exists y. split; [exact h1 |].
      apply Rle_trans with (1 := h2 (Claim.value a) (Claim.value v) a0 hV hA). rewrite !value_minus, value_over, A, K, e2 in h.
      change (value x theta (integer 1)) with 1 in h. rewrite hp in *. pose proof (sqrt_lt_R0 _ re) as z0. set (z := sqrt (norm2 (span base platform P))) in *.
      replace (ratio * (Claim.value v ^ 2 / Claim.value b) / (ratio * z)) with (Claim.value v ^ 2 / z / Claim.value b) in h by (field; repeat split; lra).
      set (A0 := Claim.value a) in *. set (V0 := Claim.value v ^ 2 / z) in *. set (b' := Claim.value b) in *.
      apply Rmult_le_reg_r with (/ b'); [apply Rinv_0_lt_compat, b0 |]. rewrite Rinv_r by lra. unfold Rdiv in h. lra.
Qed.

Lemma fulfilled : fulfils c m P r.
Proof.
  pose proof is_test as T. pose proof test_holds as H. pose proof nonneg_of as NN.
  pose proof sign_fulfilled as SF. pose proof margin_fulfilled as MF. pose proof least_found as LF. pose proof bound_here as B. pose proof extras_at as EX. pose proof each_energy as EE.
  pose proof (couples_energy fs m represented) as CE. pose proof clearance_fulfilled as CF. pose proof beside_fulfilled as BF. pose proof acceleration_fulfilled as AF. pose proof force_fulfilled as FF.
  assert (Sign : match range_formula fs s j r with
      | [f] => Some (AtLeast (found f)) | [f; g] => Some (Either (found f) (found g)) | _ => None end = Some t ->
      is_least r = false -> fulfils c m P r).
  { intros E least. destruct (range_formula fs s j r) as [| f [| g [|]]]; try discriminate; injection E as <-; cbn [Check.holds] in H.
    - apply (SF least f eq_refl), (NN f); [left; reflexivity | exact H].
    - apply (MF least f g eq_refl). destruct H as [H | H]; [left | right]; (apply NN; [| exact H]).
      + left. reflexivity.
      + right. left. reflexivity. }
  destruct (is_lower r) eqn:low; [apply (lower_fulfilled low) |].
  destruct r as [| b | b | i b | i b | i tool b | b | i b | b | joint b | b | one other b | i one other b | i a v b | i tool b | | error b | ks kb]; try discriminate; cbn [test_of] in T; try exact (Sign T eq_refl).
  - destruct (enclose_parameter bits (bound_of s (PsiMin b))) as [a |] eqn:E; [| discriminate]. injection T as <-.
    destruct (of_rows_speed _ H) as [h1 [e [h2 h3]]]. intro v.
    destruct (vzero_dec v) as [-> | nz]; [rewrite speed2_zero; unfold norm2, vzero; cbn; lra |]. apply Rlt_le.
    rewrite <- h3, norm2_dot, <- dot_coordinates.
    apply (h2 _ (coordinates v) (kappa_enclosed (PsiMin b) b a eq_refl E) eq_refl (nonzero_coordinates v nz)).
  - destruct (enclose_parameter bits (bound_of s (ConditionMax b))) as [a |] eqn:E; [| discriminate]. injection T as <-.
    destruct (of_rows_speed _ H) as [h1 [e [h2 h3]]]. intros u v. cbn [fulfils].
    destruct (vzero_dec u) as [-> | nu]; [rewrite speed2_zero; unfold norm2, vzero; cbn; lra |].
    destruct (vzero_dec v) as [-> | nv]; [rewrite speed2_zero; unfold norm2, vzero; cbn; lra |]. apply Rlt_le.
    assert (C : contains (sqr bits a) (Claim.value b ^ 2)).
    { apply sqr_sound. pose proof (enclose_parameter_sound bits _ _ _ E (bound_within s (ConditionMax b))) as K.
      unfold bound_value in K. cbn in K. unfold two_to in K. cbn in K. unfold Rdiv in K. rewrite Rinv_1, Rmult_1_r in K. exact K. }
    pose proof (h2 _ (coordinates u) (coordinates v) C eq_refl eq_refl (nonzero_coordinates u nu) (nonzero_coordinates v nv)) as Z.
    rewrite !h3, !dot_coordinates, <- !norm2_dot in Z. lra.
  - cbn [least_rows option_map bound_of] in T, LF, B. injection T as <-. cbn [Check.holds] in H. specialize (LF _ eq_refl). rewrite LF in H.
    destruct H as [[_ pos] h]. set (q := quantity (exactly (Over b joint), 0%Z) (fst j)) in *.
    assert (K : value x theta q = Claim.value b / Claim.value joint).
    { rewrite B. unfold bound_value. cbn. change (two_to 0) with 1. unfold Rdiv at 1. rewrite Rinv_1. ring. }
    cbn [fulfils]. intro v. destruct (vzero_dec v) as [-> | nz]; [rewrite speed2_zero; unfold norm2, vzero; cbn; lra |].
    specialize (h 1 (coordinates v) ltac:(apply (Fixed.integer_sound bits 1)) eq_refl (nonzero_coordinates v nz)).
    rewrite <- K. apply (stiff_bound q fs m represented reached pos v nz).
    rewrite Rmult_1_l, dot_coordinates, <- norm2_dot in h. exact h.
  - cbn [least_rows] in T, LF. destruct (couple_rows fs) as [rs |] eqn:er; [| discriminate].
    destruct (enclose_parameter bits (bound_of s (ConstraintMargin b))) as [a |] eqn:E; [| discriminate]. injection T as <-.
    cbn [Check.holds] in H. specialize (LF _ eq_refl). rewrite LF in H. destruct H as [[_ pos] h].
    destruct (CE rs eq_refl pos) as [cs [h1 h2]]. exists cs. split; [exact h1 |]. intro v. rewrite <- h2.
    assert (C : contains (sqr bits a) (Claim.value b ^ 2)).
    { apply sqr_sound. pose proof (enclose_parameter_sound bits _ _ _ E (bound_within s (ConstraintMargin b))) as K.
      unfold bound_value in K. cbn in K. unfold two_to in K. cbn in K. unfold Rdiv in K. rewrite Rinv_1, Rmult_1_r in K. exact K. }
    destruct (vzero_dec v) as [-> | nz].
    + rewrite h2. replace (norm2 vzero) with 0 by (unfold norm2, vzero; cbn; ring). rewrite Rmult_0_r.
      clear. induction cs as [| c cs IH]; cbn [fold_right]; [lra |]. pose proof (pow2_ge_0 (Vec3.dot (normalised c) vzero)). lra.
    + apply Rlt_le. rewrite norm2_dot, <- dot_coordinates. exact (h _ (coordinates v) C eq_refl (nonzero_coordinates v nz)).
  - destruct (segments fs s (snd j) one other) as [[[a a'] [c' d']] |] eqn:es; [| discriminate].
    destruct (enclose_parameter bits (bound_of s (Clearance one other b))) as [distance |] eqn:ed; [| discriminate].
    destruct (0 <=? lo distance)%Z eqn:d0; [| discriminate]. injection T as <-.
    exact (CF one other b a a' c' d' distance eq_refl es (enclose_parameter_sound bits _ _ _ ed (bound_within s _)) (proj1 (Z.leb_le _ _) d0) H).
  - apply (BF i one other b eq_refl). destruct (range_formula fs s j (Beside i one other b)) as [| f [| g [|]]] eqn:E; try discriminate; injection T as <-.
    + exists f. split; [reflexivity |]. apply (NN f); [left; reflexivity | exact H].
    + exfalso. cbn [range_formula] in E. destruct (nth_error fs i) as [k |]; [| discriminate]. destruct (f_tip k); discriminate.
  - destruct (range_formula fs s j (JointAcceleration i a v b)) as [| f [|]] eqn:E; try discriminate.
    destruct (Compare.certainly bits false a && Compare.certainly bits true b) eqn:ce; [| discriminate]. injection T as <-.
    apply andb_true_iff in ce as [c1 c2]. apply (AF i a v b eq_refl (Compare.nonneg_sound _ _ c1) (Compare.positive_sound _ _ c2)).
    exists f. split; [reflexivity |]. apply (NN f); [left; reflexivity | exact H].
  - destruct (nth_error fs i) as [g |] eqn:ng; [| discriminate].
    destruct (Compare.certainly bits true tool && Compare.certainly bits true b) eqn:ce; [| discriminate]. apply andb_true_iff in ce as [c1 c2].
    destruct (enclose_parameter bits (bound_of s (JointForce i tool b))) as [a |] eqn:E; [| discriminate]. injection T as <-.
    apply (FF i tool b (sqr bits a) g eq_refl ng (Compare.positive_sound _ _ c1) (Compare.positive_sound _ _ c2)); [| exact H].
    apply sqr_sound. pose proof (enclose_parameter_sound bits _ _ _ E (bound_within s (JointForce i tool b))) as K.
    unfold bound_value in K. cbn [bound_of fst snd exactly greatest Claim.value] in K. rewrite two_to_0 in K. unfold Rdiv in K at 1. rewrite Rinv_1, Rmult_1_r in K. exact K.
  - exact apart.
  - exact apart.
  - cbn [least_rows] in T, LF. destruct (forallb _ (kb :: ks)) eqn:all0; [| discriminate]. destruct (Nat.eqb_spec (length ks) (length fs)) as [lk |]; [| discriminate].
    cbn [option_map] in T. injection T as <-. cbn [Check.holds] in H. specialize (LF _ eq_refl). cbn [extras] in LF, H. rewrite LF in H. destruct H as [[_ pos] h].
    cbn [forallb] in all0. apply andb_true_iff in all0 as [b0 k0]. apply Compare.positive_sound in b0.
    assert (K0 : Forall (fun k => 0 < Claim.value k) ks) by (apply Forall_forall; intros k ik; rewrite forallb_forall in k0; exact (Compare.positive_sound _ _ (k0 k ik))).
    cbn [extras] in EX. set (qs := numbered _ _) in *. rewrite map_map in EX.
    assert (EQ : map (value x theta) qs = map (fun k => Claim.value kb / Claim.value k) ks).
    { rewrite EX. apply map_ext. intro k. unfold exact_value. cbn [fst snd exactly greatest Claim.value]. rewrite two_to_0. unfold Rdiv at 1. rewrite Rinv_1. ring. }
    split; [rewrite lk, (related_length _ _ _ _ _ represented); apply map_length |]. intro v.
    rewrite <- (EE kb fs ks m qs b0 K0 represented reached lk EQ v). apply Rmult_le_compat_l; [lra |]. destruct (vzero_dec v) as [-> | nz].
    + replace (norm2 vzero) with 0 by (unfold norm2, vzero; cbn; ring). apply energy_nonneg, pos.
    + specialize (h 1 (coordinates v) ltac:(apply (Fixed.integer_sound bits 1)) eq_refl (nonzero_coordinates v nz)).
      rewrite Rmult_1_l, dot_coordinates, <- norm2_dot in h. apply Rlt_le, h.
Qed.
End Accepted.

(** Two bodies on one leg are as far apart as the lines along them. *)
Theorem beside_keeps : forall c m P i one other r r' t u t' u' b,
  fulfils c m P (Beside i one other (Plus (Plus r r') b)) -> fulfils c m P (Clearance (AlongLeg i r t u one) (AlongLeg i r' t' u' other) b).
Proof.
  intros c m P i one other r r' t u t' u' b [l [C [A [L [n [e h]]]]]]. unfold fulfils, are_clear, segment_of. cbn [segment_along]. rewrite nth_error_map, n. cbn [option_map]. rewrite e.
  do 4 eexists. split; [reflexivity |]. split; [reflexivity |]. intros y z _ _. cbn [radius_of].
  set (a1 := 1 - Claim.value t / L). set (a2 := Claim.value u / L). set (a3 := 1 - Claim.value t' / L). set (a4 := Claim.value u' / L).
  specialize (h ((1 - y) * a1 + y * a2) ((1 - z) * a3 + z * a4)). cbn [Claim.value] in h. apply Rle_trans with (1 := h), Req_le.
  f_equal. unfold towards, vsub, vadd, vscale. cbn [vx vy vz]. f_equal; ring.
Qed.

(** Every requirement has its test, and its numbers their places. *)
Lemma requirement_at : forall place ps fs s rs j k r, nth_error rs k = Some r -> exists i front back,
  i = (fst j + k, snd j + length front)%nat /\ flat_map (extras s) rs = front ++ extras s r ++ back /\
  In (test_of place ps fs s i r) (tests_of place ps fs s j rs) /\
  forall f, In f (range_formula fs s i r) -> In f (range_formulas fs s j rs).
Proof.
  intros place ps fs s rs. induction rs as [| q rs IH]; intros j [| k] r e; try discriminate.
  - injection e as ->. exists j, [], (flat_map (extras s) rs). rewrite !Nat.add_0_r. split; [apply surjective_pairing |].
    split; [reflexivity |]. split; [left; reflexivity |].
    intros f i. cbn [range_formulas]. apply in_or_app. left. exact i.
  - destruct (IH (next s q j) k r e) as [i [front [back [h1 [h2 [h3 h4]]]]]]. exists i, (extras s q ++ front), back.
    split; [rewrite h1; unfold next; cbn [fst snd]; rewrite app_length; f_equal; lia |].
    split; [cbn [flat_map]; rewrite h2, app_assoc; reflexivity |].
    split; [right; exact h3 |]. intros f g. cbn [range_formulas]. apply in_or_app. right. exact (h4 f g).
Qed.

Lemma numbers_at : forall x s rs th k r front back, nth_error rs k = Some r -> flat_map (extras s) rs = front ++ extras s r ++ back ->
  let theta := th ++ map (bound_value s) rs ++ map exact_value (flat_map (extras s) rs) in
  nth (length th + k) theta 0 = bound_value s r /\
  map (value x theta) (numbered (length th + length rs + length front) (extras s r)) = map exact_value (extras s r).
Proof.
  intros x s rs th k r front back e f theta. unfold theta. split.
  - rewrite app_nth2_plus, app_nth1; [| rewrite map_length; apply nth_error_Some; congruence].
    apply nth_error_nth. rewrite nth_error_map, e. reflexivity.
  - rewrite f, !map_app. rewrite !app_assoc, <- (app_assoc _ (map exact_value (extras s r))).
    replace (length th + length rs + length front)%nat with (length ((th ++ map (bound_value s) rs) ++ map exact_value front))
      by (rewrite !app_length, !map_length; lia).
    apply numbered_values, extras_within.
Qed.

(** Two points with the same joint coordinates: the form at the one is that at the other, of the opposite sign. *)
Lemma chords_cancel : forall s Y places m fs P P' theta,
  Forall2 (represents (vscale (/ two_to s) P) theta) fs (map (resized (/ two_to s)) m) ->
  Forall2 (represents (vscale (/ two_to s) P') theta) fs (map (resized (/ two_to s)) m) ->
  Forall well_formed_leg m -> Forall (reaches P) m -> Forall (reaches P') m -> Forall (fun l => joint l P' = joint l P) m ->
  let v := coordinates (vsub (vscale (/ two_to s) P') (vscale (/ two_to s) P)) in
  let form_at P := form (lower_weights places Y v) (map (fun p => (fst p, 0)) (map_rows (value (coordinates (vscale (/ two_to s) P)) theta) (whole_rows fs))) v in
  form_at P + form_at P' = 0.
Proof.
  intros s Y places m fs P P' theta h h' ok re re' e v form_at. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. set (ratio := / two_to s) in *.
  unfold form_at. clear form_at. revert Y m h h' ok re re' e. induction fs as [| f fs IH]; intros Y m h h' ok re re' e.
  - destruct Y; cbn; lra.
  - destruct m as [| l m]; [inversion h |]. cbn [map] in h, h'. apply cons_related in h as [hl h]. apply cons_related in h' as [hl' h'].
    apply Forall_cons_iff in ok as [ok1 ok]. apply Forall_cons_iff in re as [re1 re]. apply Forall_cons_iff in re' as [re1' re']. apply Forall_cons_iff in e as [e1 e].
    destruct Y as [| y Y]; [cbn; lra |]. specialize (IH Y m h h' ok re re' e).
    change (whole_rows (f :: fs)) with ((list_of (f_A f), f_D f) :: whole_rows fs). rewrite !map_rows_cons. cbn [map fst lower_weights form]. fold (lower_weights places Y v).
    destruct hl as [_ [[_ [hA _]] _]]. destruct hl' as [_ [[_ [hA' _]] _]]. rewrite !values_list, hA, hA'.
    assert (G : forall u, Linear.dot (coordinates u) v = Vec3.dot u (vsub (vscale ratio P') (vscale ratio P))) by (intro; apply dot_coordinates). rewrite !G.
    destruct (resized_same ratio P r0 l) as [_ [j1 q1]]. destruct (resized_same ratio P' r0 l) as [_ [j2 q2]].
    assert (C : Vec3.dot (vadd (vector_of (resized ratio l) (vscale ratio P)) (vector_of (resized ratio l) (vscale ratio P'))) (vsub (vscale ratio P') (vscale ratio P)) = 0).
    { apply chord; [apply (well_formed_resized ratio r0 l), ok1 | apply q1, re1 | apply q2, re1' | rewrite j1, j2, e1; reflexivity]. }
    assert (Da : forall a b w, Vec3.dot (vadd a b) w = Vec3.dot a w + Vec3.dot b w) by (intros; unfold Vec3.dot, vadd; cbn [vx vy vz]; ring). rewrite Da in C.
    set (t := Linear.dot (map (Y_value places) y) v) in *.
    set (a := Vec3.dot (vector_of (resized ratio l) (vscale ratio P)) _) in *. set (b := Vec3.dot (vector_of (resized ratio l) (vscale ratio P')) _) in *.
    assert (E0 : 2 * t * (a + b) = 0) by (rewrite C; ring). lra.
Qed.

Lemma one_to_one : forall s fs m P P' theta tape params, (forall e, In e (entries (whole_rows fs)) -> formula_at tape (place (formulas tape) e) = e) ->
  Forall2 (represents (vscale (/ two_to s) P) theta) fs (map (resized (/ two_to s)) m) ->
  Forall2 (represents (vscale (/ two_to s) P') theta) fs (map (resized (/ two_to s)) m) ->
  Forall well_formed_leg m -> Forall (reaches P) m -> Forall (reaches P') m -> Forall (fun l => joint l P' = joint l P) m ->
  forall places Y divided,
  Check.holds bits tape (map_rows (place (formulas tape)) (whole_rows fs)) divided [] params theta 3 (coordinates (vscale (/ two_to s) P)) (Chords (map_rows (place (formulas tape)) (whole_rows fs)) places Y) ->
  Check.holds bits tape (map_rows (place (formulas tape)) (whole_rows fs)) divided [] params theta 3 (coordinates (vscale (/ two_to s) P')) (Chords (map_rows (place (formulas tape)) (whole_rows fs)) places Y) ->
  P' = P.
Proof.
  intros s fs m P P' theta tape params found h h' ok re re' e places Y divided H H'.
  pose proof (chords_cancel s Y places m fs P P' theta h h' ok re re' e) as C. cbv zeta in C. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0.
  set (d := vsub (vscale (/ two_to s) P') (vscale (/ two_to s) P)) in *.
  destruct (vzero_dec d) as [z | nz].
  - unfold d, vsub, vscale, vzero in z. injection z as z1 z2 z3. apply vec_ext; apply Rmult_eq_reg_l with (/ two_to s); lra.
  - exfalso. cbn [Check.holds] in H, H'. rewrite (rows_found tape _ found) in H, H'. destruct H as [_ H], H' as [_ H'].
    specialize (H (coordinates d) eq_refl (nonzero_coordinates d nz)). specialize (H' (coordinates d) eq_refl (nonzero_coordinates d nz)). lra.
Qed.

(** ** Accuracy *)

Lemma two_to_power : forall s, two_to s = powerRZ 2 s.
Proof.
  assert (N : forall p, IZR (2 ^ Zpos p) = 2 ^ Pos.to_nat p) by (intro p; rewrite pow_IZR, positive_nat_Z; reflexivity).
  intros [| p | p]; unfold two_to; cbn [Z.leb Z.compare Z.opp powerRZ]; [reflexivity | apply N | rewrite N; reflexivity].
Qed.
Lemma two_to_less : forall a b, two_to (a - b) = two_to a / two_to b.
Proof. intros a b. rewrite !two_to_power. unfold Z.sub. rewrite powerRZ_add by lra. rewrite powerRZ_neg'. reflexivity. Qed.

(** The parameters on the way from a machine to the nominal one. *)
Definition on_the_way (t : R) (a b : list R) : list R := map (fun p => fst p + t * (snd p - fst p)) (combine a b).
Lemma on_the_way_nth : forall t tb a b j, length a = length b ->
  nth j (on_the_way t a b ++ tb) 0 = nth j (a ++ tb) 0 + t * (nth j (b ++ tb) 0 - nth j (a ++ tb) 0).
Proof.
  intros t tb. induction a as [| y a IH]; intros [| z b] j e; try discriminate; [cbn [on_the_way combine map app]; ring |].
  destruct j as [| j]; [reflexivity | exact (IH b j ltac:(cbn in e; congruence))].
Qed.
Lemma on_the_way_ends : forall a b, length a = length b -> on_the_way 0 a b = a /\ on_the_way 1 a b = b.
Proof.
  induction a as [| y a IH]; intros [| z b] e; try discriminate; [split; reflexivity |]. destruct (IH b ltac:(cbn in e; congruence)) as [h1 h2].
  unfold on_the_way in *. cbn [combine map fst snd]. rewrite h1, h2. split; f_equal; ring.
Qed.
Lemma on_the_way_within : forall t ps th, 0 <= t <= 1 -> Forall2 scaled_within ps th -> Forall2 scaled_within ps (on_the_way t th (map middle_of ps)).
Proof.
  intros t ps th ht. induction 1 as [| p y ps th [x [[h1 h2] ->]] h IH]; [constructor |]. unfold on_the_way in *. cbn [map combine fst snd]. constructor; [| exact IH].
  exists (x + t * (middle (fst p) - x)). split; [| unfold middle_of, Rdiv; ring]. unfold within, middle in *. set (l := Claim.value (least (fst p))) in *. set (g := Claim.value (greatest (fst p))) in *.
  assert (0 <= t * (g - l)) by (apply Rmult_le_pos; lra). assert (0 <= (1 - t) * (x - l)) by (apply Rmult_le_pos; lra). assert (0 <= (1 - t) * (g - x)) by (apply Rmult_le_pos; lra). lra.
Qed.

(** How far the nominal machine is. *)
Definition width (p : parameter) : R := (Claim.value (greatest (fst p)) - Claim.value (least (fst p))) / 2 / two_to (snd p).
Lemma way_length : forall tb ps th j, Forall2 scaled_within ps th -> let way := nth j (map middle_of ps ++ tb) 0 - nth j (th ++ tb) 0 in
  if Nat.ltb j (length ps) then Rabs way <= width (nth j ps none) else way = 0.
Proof.
  intros tb ps th j h. revert j. induction h as [| p y ps th [x [[h1 h2] ->]] h IH]; intro j; cbv zeta; [cbn; ring |].
  destruct j as [| j]; [| exact (IH j)]. cbn [map app nth length]. change (Nat.ltb 0 (S (length ps))) with true. cbv iota.
  unfold middle_of, middle, width. pose proof (two_to_pos (snd p)) as t0. set (l := Claim.value (least (fst p))) in *. set (g := Claim.value (greatest (fst p))) in *.
  replace ((l + g) / 2 / two_to (snd p) - x / two_to (snd p)) with (((l + g) / 2 - x) / two_to (snd p)) by (field; lra).
  pose proof (Rinv_0_lt_compat _ t0). unfold Rdiv at 1 2. rewrite Rabs_mult, (Rabs_pos_eq (/ two_to (snd p))) by lra. unfold Rdiv. apply Rmult_le_compat_r; [lra |]. apply Rabs_le. lra.
Qed.

Lemma toleranced_once : forall ps, NoDup (toleranced ps).
Proof. intro ps. apply NoDup_filter, seq_NoDup. Qed.
Lemma others_are_exact : forall tb ps th j, Forall2 scaled_within ps th -> ~ In j (toleranced ps) -> nth j (map middle_of ps ++ tb) 0 - nth j (th ++ tb) 0 = 0.
Proof.
  intros tb ps th j h n. pose proof (way_length tb ps th j h) as W. cbv zeta in W. destruct (Nat.ltb_spec j (length ps)) as [l |]; [| exact W].
  assert (E : has_two_ends (nth j ps none) = false).
  { destruct (has_two_ends (nth j ps none)) eqn:e; [| reflexivity]. exfalso. apply n. apply filter_In. split; [apply in_seq; lia | exact e]. }
  unfold has_two_ends in E. apply negb_false_iff, Number.same_sound in E. unfold width in W. rewrite E in W.
  set (way := _ - _) in *. assert (Rabs way <= 0) by (eapply Rle_trans; [exact W |]; apply Req_le; unfold Rdiv; ring).
  destruct (Req_dec way 0) as [z | z]; [exact z |]. pose proof (Rabs_pos_lt way z). lra.
Qed.

Lemma terms_of : forall (val : formula -> R) (rate : nat -> R) by_ ds, Linear.dot (map rate by_) (map val ds) =
  fold_right (fun p sum => rate (fst p) * val (snd p) + sum) 0 (combine by_ ds).
Proof. intros val rate. induction by_ as [| j b IH]; intros [| n ds]; cbn [map Linear.dot combine fold_right fst snd]; try reflexivity. rewrite IH. reflexivity. Qed.
Lemma without_zeros : forall x theta rate (l : list (nat * formula)),
  fold_right (fun p sum => rate (fst p) * value x theta (snd p) + sum) 0 l = fold_right (fun p sum => rate (fst p) * value x theta (snd p) + sum) 0 (filter (fun p => negb (is 0 (snd p))) l).
Proof.
  intros x theta rate. induction l as [| [j n] l IH]; [reflexivity |]. cbn [fold_right filter fst snd]. rewrite IH. destruct (is 0 n) eqn:z; cbn [negb fold_right fst snd]; [| reflexivity].
  rewrite (is_value _ _ _ _ z). ring.
Qed.

(** Rates on the way to the nominal machine, as half-widths have them. *)
Definition way_rate (ps : list parameter) (th tb : list R) (j : nat) : R := nth j (map middle_of ps ++ tb) 0 - nth j (th ++ tb) 0.
Lemma way_terms : forall s b ps th tb place x ds hs, Forall2 scaled_within ps th -> changes_from place ps s b (slopes_from ps ds) = Some hs -> 0 < Claim.value b ->
  map snd hs = map place (map snd (slopes_from ps ds)) /\ exists ts, Forall2 (fun h t => exists a, contains (fst h) a /\ Rabs t <= a) hs ts /\
  forall theta, Linear.dot (map (way_rate ps th tb) (toleranced ps)) (map (value x theta) ds) / (/ two_to s * Claim.value b) = Linear.dot ts (map (value x theta) (map snd (slopes_from ps ds))).
Proof.
  intros s b ps th tb place x ds hs hth eh b0.
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. set (D := / two_to s * Claim.value b). assert (D0 : 0 < D) by (apply Rmult_lt_0_compat; assumption). set (rate := way_rate ps th tb).
  assert (T : forall p, In p (slopes_from ps ds) -> forall a, enclose_parameter bits (half_width s b (nth (fst p) ps none)) = Some a -> exists v, contains a v /\ Rabs (rate (fst p) / D) <= v).
  { intros p ip a e. set (q := nth (fst p) ps none) in *. exists (width q / D). split.
    - apply (enclose_parameter_sound bits _ _ _ e). unfold half_width. eexists. split; [unfold within, exactly; cbn; split; apply Rle_refl |]. cbn [snd].
      rewrite two_to_less. unfold width, D. pose proof (two_to_pos s). pose proof (two_to_pos (snd q)). cbn. field. repeat split; lra.
    - apply filter_In in ip as [ip _]. destruct p as [k n]. apply in_combine_l in ip. apply filter_In in ip as [ip _]. apply in_seq in ip. cbn [fst] in *.
      pose proof (way_length tb ps th k hth) as W. cbv zeta in W. destruct (Nat.ltb_spec k (length ps)); [| lia].
      unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ D)) by (apply Rlt_le, Rinv_0_lt_compat, D0). apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, D0 | exact W]. }
  assert (G : forall sl hs, (forall p, In p sl -> In p (slopes_from ps ds)) -> changes_from place ps s b sl = Some hs ->
    map snd hs = map place (map snd sl) /\ Forall2 (fun h t => exists a, contains (fst h) a /\ Rabs t <= a) hs (map (fun p => rate (fst p) / D) sl) /\ forall theta,
    fold_right (fun p sum => rate (fst p) * value x theta (snd p) + sum) 0 sl / D = Linear.dot (map (fun p => rate (fst p) / D) sl) (map (value x theta) (map snd sl))).
  { unfold changes_from. induction sl as [| p sl IH]; intros hs' sub eh'; cbn [map all_some] in eh'; [injection eh' as <-; split; [reflexivity |]; split; [constructor | intro; cbn; field; lra] |].
    destruct (enclose_parameter bits (half_width s b (nth (fst p) ps none))) as [a |] eqn:ea; [| discriminate]. cbn [option_map] in eh'. destruct (all_some (map _ sl)) as [hs'' |]; [| discriminate]. injection eh' as <-.
    destruct (IH hs'' (fun q i => sub q (or_intror i)) eq_refl) as [I1 [I2 I3]]. cbn [map snd fold_right Linear.dot]. rewrite I1. split; [reflexivity |].
    split; [constructor; [exact (T p (sub p (or_introl eq_refl)) a ea) | exact I2] | intro theta; rewrite <- I3; field; lra]. }
  destruct (G _ hs (fun p i => i) eh) as [G1 [G2 G3]]. split; [exact G1 |]. exists (map (fun p => rate (fst p) / D) (slopes_from ps ds)). split; [exact G2 |].
  intro theta. rewrite <- G3, terms_of, without_zeros. reflexivity.
Qed.
(** Machines on the way, and how formulas change there. *)
Definition way_at (ps : list parameter) (th tb : list R) (t : R) : list R := on_the_way t th (map middle_of ps) ++ tb.
Lemma way_ends : forall ps th tb, Forall2 scaled_within ps th -> way_at ps th tb 0 = th ++ tb /\ way_at ps th tb 1 = map middle_of ps ++ tb.
Proof.
  intros ps th tb hth. assert (len : length th = length (map middle_of ps)) by (rewrite map_length, (related_length _ _ _ _ _ hth); reflexivity).
  destruct (on_the_way_ends _ _ len) as [w0 w1]. unfold way_at. rewrite w0, w1. split; reflexivity.
Qed.
Lemma way_derivative : forall ps th tb x f t, Forall2 scaled_within ps th -> defined x (way_at ps th tb t) f ->
  derivable_pt_lim (fun t => value x (way_at ps th tb t) f) t (Linear.dot (map (way_rate ps th tb) (toleranced ps)) (map (value x (way_at ps th tb t)) (Gradient.derivatives (toleranced ps) f))).
Proof.
  intros ps th tb x f t hth def. assert (len : length th = length (map middle_of ps)) by (rewrite map_length, (related_length _ _ _ _ _ hth); reflexivity).
  apply (Gradient.derivatives_sound (toleranced ps) x (way_at ps th tb) t (way_rate ps th tb) (toleranced_once ps)).
  - intro k. apply Velocity.derivable_eq with (fun u => nth k (th ++ tb) 0 + way_rate ps th tb k * u) (0 + way_rate ps th tb k * 1).
    + apply Velocity.derivable_add; [apply Velocity.derivable_const | apply Velocity.derivable_scal, derivable_pt_lim_id].
    + intro u. unfold way_at. rewrite on_the_way_nth by exact len. unfold way_rate. ring.
    + ring.
  - intros k n. exact (others_are_exact tb ps th k hth n).
  - exact def.
Qed.

(** What a formula differs by from that of the nominal machine: the mean value theorem, on the way there. *)
Lemma nominal_differs : forall s b ps th tb params place f x hs,
  Forall2 scaled_within ps th -> (forall th', Forall2 scaled_within ps th' -> Forall2 contains params (th' ++ tb)) ->
  changes_of place ps s b f = Some hs -> (forall th, Forall2 contains params th -> defined x th f) -> 0 < Claim.value b ->
  map snd hs = map place (map snd (slopes_of ps f)) /\ exists th' ts, Forall2 contains params th' /\ Forall2 (fun h t => exists a, contains (fst h) a /\ Rabs t <= a) hs ts /\
    (value x (map middle_of ps ++ tb) f - value x (th ++ tb) f) / (/ two_to s * Claim.value b) = Linear.dot ts (map (value x th') (map snd (slopes_of ps f))).
Proof.
  intros s b ps th tb params place f x hs hth E eh def b0. destruct (way_terms s b ps th tb place x _ hs hth eh b0) as [G1 [ts [G2 G3]]]. split; [exact G1 |].
  assert (In_ : forall t, 0 <= t <= 1 -> Forall2 contains params (way_at ps th tb t)) by (intros t h; apply E, on_the_way_within; assumption).
  destruct (MeanValue.mean_value_theorem _ _ 0 1 Rlt_0_1 (fun t h => way_derivative ps th tb x f t hth (def _ (In_ t h)))) as [t [M ht]]. cbv beta in M.
  destruct (way_ends ps th tb hth) as [w0 w1]. rewrite w0, w1 in M. exists (way_at ps th tb t), ts. split; [apply In_, ht |]. split; [exact G2 |].
  change (map (value x (way_at ps th tb t)) (map snd (slopes_of ps f))) with (map (value x (way_at ps th tb t)) (map snd (slopes_from ps (Gradient.derivatives (toleranced ps) f)))).
  rewrite <- G3. f_equal. lra.
Qed.

(** What a joint coordinate near that of the nominal machine is off by. *)
Lemma joint_is_off : forall s b error ps th tb params tape f x y y1 y0 j,
  let ratio := / two_to s in
  Forall2 scaled_within ps th -> (forall th', Forall2 scaled_within ps th' -> Forall2 contains params (th' ++ tb)) ->
  value x (th ++ tb) f = y1 -> value x (map middle_of ps ++ tb) f = y0 ->
  (forall e, In e (f :: map snd (slopes_of ps f)) -> formula_at tape (place (formulas tape) e) = e) ->
  joint_test (place (formulas tape)) ps s error b f = Some j -> (forall th, Forall2 contains params th -> defined x th (formula_at tape (fst j))) ->
  0 < Claim.value b -> Rabs (y - y0) <= ratio * Claim.value error ->
  may_be_off bits tape params x j ((y - y1) / (ratio * Claim.value b)).
Proof.
  intros s b error ps th tb params tape f x y y1 y0 j ratio hth E R1 R0 found ht def b0 hy.
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0. set (D := ratio * Claim.value b). assert (D0 : 0 < D) by (apply Rmult_lt_0_compat; assumption).
  unfold joint_test in ht. destruct (enclose_parameter bits (exactly (Over error b), 0%Z)) as [ie |] eqn:ee; [| discriminate].
  destruct (changes_of _ _ _ _ _) as [hs |] eqn:eh; [| discriminate]. injection ht as <-. cbn [fst snd] in def. rewrite (found f) in def by (left; reflexivity).
  destruct (nominal_differs s b ps th tb params _ f x hs hth E eh def b0) as [eq_ [th' [ts [h1 [h2 h3]]]]]. fold ratio D in h3. rewrite R1, R0 in h3.
  exists th', ((y - y0) / D), ts. cbn [fst snd]. split; [exact h1 |]. split.
  - exists (Claim.value error / Claim.value b). split.
    + apply (enclose_parameter_sound bits _ _ _ ee). exists (Claim.value error / Claim.value b). split; [unfold within, exactly; cbn; lra |]. cbn [snd]. change (two_to 0) with 1. field. lra.
    + unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ D)) by (apply Rlt_le, Rinv_0_lt_compat, D0).
      replace (Claim.value error * / Claim.value b) with (ratio * Claim.value error * / D) by (unfold D; field; lra). apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, D0 | exact hy].
  - split; [exact h2 |]. assert (Fo : forall e, In e (map snd (slopes_of ps f)) -> formula_at tape (place (formulas tape) e) = e) by (intros e i; apply found; right; exact i).
    clear found eh def. revert ts h2 h3. generalize dependent (map snd (slopes_of ps f)). intros l eq_ Fo ts h2 h3.
    replace ((y - y1) / D) with ((y - y0) / D + (y0 - y1) / D) by (field; lra). rewrite h3. clear h3. revert l eq_ Fo.
    induction h2 as [| [a i] t hs ts _ h2 IH]; intros [| e l] eq_ Fo; try discriminate; cbn [map Linear.dot combine fold_right fst snd]; [ring |].
    cbn [map snd] in eq_. injection eq_ as -> eq_. rewrite <- (IH l eq_ (fun e i => Fo e (or_intror i))), (Fo e (or_introl eq_refl)). ring.
Qed.

Lemma row_divided : forall tape f l Q theta, (forall e, In e (list_of (f_divided f)) -> formula_at tape (place (formulas tape) e) = e) -> represents Q theta f l ->
  map (fun i => value (coordinates Q) theta (formula_at tape i)) (map (place (formulas tape)) (list_of (f_divided f))) = coordinates (row l Q).
Proof.
  intros tape f l Q theta found [_ [_ [R _]]]. rewrite map_map, (map_ext_in _ (value (coordinates Q) theta)) by (intros e i; rewrite (found e i); reflexivity).
  rewrite values_list, R. reflexivity.
Qed.

Lemma size_of_squares : forall k u v, 0 <= k -> k ^ 2 * norm2 u <= norm2 v -> k * Accuracy.size u <= Accuracy.size v.
Proof.
  intros k u v k0 h. pose proof (Accuracy.size_nonneg u). pose proof (Accuracy.size_nonneg v). rewrite <- !Accuracy.size_square in h. apply Rnot_lt_le. intro n.
  assert (0 <= k * Accuracy.size u) by (apply Rmult_le_pos; assumption). nra.
Qed.

Lemma vadd_path : forall Q u v t, Velocity.has_velocity (fun x => vadd Q (vadd u (vscale x v))) t v.
Proof.
  intros Q u v t. assert (K : forall a b c, derivable_pt_lim (fun x => a + (b + x * c)) t c).
  { intros a b c. apply Velocity.derivable_eq with (fun x => (a + b) + c * x) (0 + c * 1); [| intro; ring | ring].
    apply Velocity.derivable_add; [apply Velocity.derivable_const | apply Velocity.derivable_scal, derivable_pt_lim_id]. }
  split; [| split]; apply K.
Qed.

(** Three joints near P: as [Accuracy.one_position] has them. *)
Lemma one_near : forall tape params theta Q (f1 f2 f3 : leg_formulas) (l1 l2 l3 : leg) d j1 j2 j3 y1 y2 y3 D,
  let fs := [f1; f2; f3] in let ls := [l1; l2; l3] in
  (forall Q, Forall2 (represents Q theta) fs ls) -> Forall well_formed_leg ls ->
  (forall e, In e (entries (divided_rows fs)) -> formula_at tape (place (formulas tape) e) = e) -> contains d D -> 0 < D ->
  accurate_at bits tape (map_rows (place (formulas tape)) (divided_rows fs)) params theta (coordinates Q) d [j1; j2; j3] ->
  may_be_off bits tape params (coordinates Q) j1 ((y1 - joint l1 Q) / D) -> may_be_off bits tape params (coordinates Q) j2 ((y2 - joint l2 Q) / D) ->
  may_be_off bits tape params (coordinates Q) j3 ((y3 - joint l3 Q) / D) ->
  let is_at Q' := Accuracy.size (vsub Q' Q) <= D /\ Forall2 (fun l y => reaches Q' l /\ joint l Q' = y) ls [y1; y2; y3] in
  exists Q', is_at Q' /\ forall Q'', is_at Q'' -> Q'' = Q'.
Proof.
  intros tape params theta Q f1 f2 f3 l1 l2 l3 d j1 j2 j3 y1 y2 y3 D fs ls Rep built found hd D0 [_ [g [kappa [z [g0 [gk [z0 [zg [Close First]]]]]]]]] b1 b2 b3 is_at.
  assert (Rows : forall Q', divided_at tape (map_rows (place (formulas tape)) (divided_rows fs)) theta (coordinates Q') = [coordinates (row l1 Q'); coordinates (row l2 Q'); coordinates (row l3 Q')]).
  { intro Q'. pose proof (Rep Q') as h. unfold fs, ls in h. apply cons_related in h as [h1 h]. apply cons_related in h as [h2 h]. apply cons_related in h as [h3 _].
    assert (Fo : forall f, In f fs -> forall e, In e (list_of (f_divided f)) -> formula_at tape (place (formulas tape) e) = e).
    { intros f i e ie. apply found. unfold entries. apply in_flat_map. exists (list_of (f_divided f), integer 1). split; [| cbn [fst]; apply in_or_app; left; exact ie].
      unfold divided_rows. apply in_map_iff. exists f. split; [reflexivity | exact i]. }
    unfold divided_at, fs, divided_rows, map_rows. cbn [map fst].
    rewrite (row_divided tape f1 l1 Q' theta (Fo f1 (or_introl eq_refl)) h1), (row_divided tape f2 l2 Q' theta (Fo f2 (or_intror (or_introl eq_refl))) h2),
      (row_divided tape f3 l3 Q' theta (Fo f3 (or_intror (or_intror (or_introl eq_refl)))) h3). reflexivity. }
  set (J u := Mat (row l1 (vadd Q u)) (row l2 (vadd Q u)) (row l3 (vadd Q u))).
  set (F u := Vec (joint l1 (vadd Q u)) (joint l2 (vadd Q u)) (joint l3 (vadd Q u))).
  assert (Ball : forall u, Accuracy.size u <= D -> Forall (reaches (vadd Q u)) ls /\ forall w, norm2 (mulv (msub (J u) (J vzero)) w) <= g ^ 2 * (norm2 w * (norm2 u / D ^ 2))).
  { intros u hu. destruct (Accuracy.component u) as [c1 [c2 c3]].
    assert (In_ : forall a, Rabs a <= Accuracy.size u -> -1 <= a / D <= 1).
    { intros a h. assert (k : Rabs a <= D) by lra. pose proof (Rle_abs a). pose proof (Rle_abs (- a)) as n. rewrite Rabs_Ropp in n.
      split; apply Rmult_le_reg_r with D; try exact D0; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra. }
    destruct (Close D (vx u / D) (vy u / D) (vz u / D) hd (Rlt_le _ _ D0) ltac:(repeat (apply Forall_cons; [apply In_; assumption |]); apply Forall_nil)) as [N1 N2].
    assert (Mv : Near.moved D (coordinates Q) [vx u / D; vy u / D; vz u / D] = coordinates (vadd Q u)).
    { unfold Near.moved, coordinates, vadd. cbn [combine map fst snd vx vy vz]. f_equal; [field; lra |]. f_equal; [field; lra |]. f_equal. field; lra. }
    rewrite Mv in N1, N2. split.
    - pose proof (Rep (vadd Q u)) as h. unfold fs, ls in h |- *. clear N2. unfold fs, divided_rows, map_rows in N1. cbn [map fst snd] in N1.
      assert (One : forall f l, In f fs -> represents (vadd Q u) theta f l ->
        Forall (fun i => defined (coordinates (vadd Q u)) theta (formula_at tape i)) (map (place (formulas tape)) (list_of (f_divided f))) -> reaches (vadd Q u) l).
      { intros f l i [_ [[h1 _] _]] h2. apply h1. apply Forall_forall. intros e ie. rewrite Forall_forall in h2.
        assert (Fe : formula_at tape (place (formulas tape) e) = e).
        { apply found. unfold entries. apply in_flat_map. exists (list_of (f_divided f), integer 1). split; [| cbn [fst]; apply in_or_app; left; exact ie].
          unfold divided_rows. apply in_map_iff. exists f. split; [reflexivity | exact i]. }
        rewrite <- Fe. apply h2, in_map, ie. }
      apply cons_related in h as [h1 h]. apply cons_related in h as [h2 h]. apply cons_related in h as [h3 _].
      apply Forall_cons_iff in N1 as [n1 N1]. apply Forall_cons_iff in N1 as [n2 N1]. apply Forall_cons_iff in N1 as [n3 _]. cbn [fst] in n1, n2, n3.
      constructor; [exact (One f1 l1 (or_introl eq_refl) h1 n1) |]. constructor; [exact (One f2 l2 (or_intror (or_introl eq_refl)) h2 n2) |].
      constructor; [exact (One f3 l3 (or_intror (or_intror (or_introl eq_refl))) h3 n3) | constructor].
    - intro w. specialize (N2 (vx w) (vy w) (vz w)). rewrite !Rows in N2.
      assert (E : changes [coordinates (row l1 (vadd Q u)); coordinates (row l2 (vadd Q u)); coordinates (row l3 (vadd Q u))] [coordinates (row l1 Q); coordinates (row l2 Q); coordinates (row l3 Q)] [vx w; vy w; vz w]
        = norm2 (mulv (msub (J u) (J vzero)) w)).
      { assert (Z : vadd Q vzero = Q) by (apply vec_ext; unfold vadd, vzero; cbn [vx vy vz]; ring). unfold J. rewrite Z.
        unfold coordinates, norm2, mulv, msub, Vec3.dot, vsub. cbn [changes Linear.dot row1 row2 row3 vx vy vz]. ring. }
      rewrite E in N2. apply Rle_trans with (1 := N2), Req_le. unfold norm2. field. lra. }
  assert (W : forall w, Solve.weighted_sum [vx w; vy w; vz w] (divided_at tape (map_rows (place (formulas tape)) (divided_rows fs)) theta (coordinates Q)) = coordinates (mulv (transpose (J vzero)) w)).
  { intro w. rewrite Rows. assert (Z : vadd Q vzero = Q) by (apply vec_ext; unfold vadd, vzero; cbn [vx vy vz]; ring). unfold J. rewrite Z.
    unfold coordinates, mulv, transpose, col1, col2, col3, Vec3.dot, comb. cbn [Solve.weighted_sum comb merge map row1 row2 row3 vx vy vz]. unfold comb. cbn [merge map]. f_equal; [ring |]. f_equal; [ring |]. f_equal; ring. }
  set (b := Vec (y1 - joint l1 Q) (y2 - joint l2 Q) (y3 - joint l3 Q)).
  destruct (Accuracy.one_position F J D g kappa z b D0 g0 gk z0 zg) as [u [[u1 u2] u3]].
  - intros u v hu hv t ht. pose proof (Accuracy.on_segment D u v t hu hv ht) as hs. destruct (Ball _ hs) as [re _].
    apply Forall_cons_iff in re as [r1 re]. apply Forall_cons_iff in re as [r2 re]. apply Forall_cons_iff in re as [r3 _].
    apply Forall_cons_iff in built as [k1 built]. apply Forall_cons_iff in built as [k2 built]. apply Forall_cons_iff in built as [k3 _].
    pose proof (vadd_path Q u (vsub v u) t) as hp.
    split; [| split]; cbn [F J mulv vx vy vz row1 row2 row3]; apply (row_is_derivative _ (fun x => vadd Q (vadd u (vscale x (vsub v u)))) t); assumption.
  - intros u w hu. destruct (Ball u hu) as [_ h]. specialize (h w). pose proof (Accuracy.size_nonneg u). pose proof (Accuracy.size_nonneg w).
    assert (G0 : 0 <= g / D) by (apply Rmult_le_pos; [exact g0 | apply Rlt_le, Rinv_0_lt_compat, D0]).
    apply Accuracy.size_below; [apply Rmult_le_pos; [apply Rmult_le_pos; assumption | assumption] |]. apply Rle_trans with (1 := h), Req_le.
    rewrite !Rpow_mult_distr, !Accuracy.size_square. unfold Rdiv. rewrite Rpow_mult_distr, pow_inv. field. lra.
  - intro w. destruct (First (vx w) (vy w) (vz w)) as [h _]. rewrite W in h. change [vx w; vy w; vz w] with (coordinates w) in h. rewrite !dot_coordinates, <- !norm2_dot in h.
    apply size_of_squares; [lra | exact h].
  - intros w t nz. destruct (First (vx w) (vy w) (vz w)) as [_ h]. rewrite W in h. change [vx w; vy w; vz w] with (coordinates w) in h. rewrite !dot_coordinates, <- !norm2_dot in h.
    specialize (h [(y1 - joint l1 Q) / D; (y2 - joint l2 Q) / D; (y3 - joint l3 Q) / D] (D * t) ltac:(repeat (apply Forall2_cons; [assumption |]); constructor)).
    assert (nz' : 0 < norm2 w + (D * t) ^ 2).
    { destruct (Req_dec t 0) as [-> | n]; [replace (D * 0) with (0 : R) by ring; lra |]. pose proof (norm2_nonneg w). assert (0 < (D * t) ^ 2); [| lra].
      rewrite <- Rsqr_pow2. apply Rsqr_pos_lt, Rmult_integral_contrapositive_currified; lra. }
    specialize (h nz').
    replace (Linear.dot [(y1 - joint l1 Q) / D; (y2 - joint l2 Q) / D; (y3 - joint l3 Q) / D] (coordinates w)) with (Vec3.dot b w / D) in h
      by (unfold b, coordinates, Vec3.dot; cbn [Linear.dot vx vy vz]; field; lra).
    replace (2 * (D * t) * (Vec3.dot b w / D)) with (2 * t * Vec3.dot b w) in h by (field; lra). rewrite !Rpow_mult_distr in h |- *. lra.
  - assert (Z : vadd Q vzero = Q) by (apply vec_ext; unfold vadd, vzero; cbn [vx vy vz]; ring).
    assert (Target : vadd (F vzero) b = Vec y1 y2 y3) by (unfold F, b, vadd at 1; rewrite Z; cbn [vx vy vz]; f_equal; ring). rewrite Target in u2. setoid_rewrite Target in u3.
    assert (Diff : forall v, vsub (vadd Q v) Q = v) by (intro v; apply vec_ext; unfold vsub, vadd; cbn [vx vy vz]; ring).
    exists (vadd Q u). split.
    + split; [rewrite Diff; exact u1 |]. destruct (Ball u u1) as [re _]. injection u2 as e1 e2 e3.
      apply Forall_cons_iff in re as [r1 re]. apply Forall_cons_iff in re as [r2 re]. apply Forall_cons_iff in re as [r3 _].
      repeat (apply Forall2_cons; [split; assumption |]). constructor.
    + intros Q'' [h1 h2]. assert (E : Q'' = vadd Q (vsub Q'' Q)) by (apply vec_ext; unfold vsub, vadd; cbn [vx vy vz]; ring).
      rewrite E. f_equal. apply u3; [exact h1 |]. unfold F. rewrite <- E. unfold ls in h2.
      apply cons_related in h2 as [[_ e1] h2]. apply cons_related in h2 as [[_ e2] h2]. apply cons_related in h2 as [[_ e3] _]. congruence.
Qed.

Lemma accuracy_fulfilled : forall c s ds m P th tb params tape whole error b t j, let ps := layouts s ds (legs c) in let fs := all_formulas s ds (legs c) 0 in
  Forall2 is_leg_of (legs c) m -> Forall well_formed_leg m -> Forall2 scaled_within ps th -> (forall th', Forall2 scaled_within ps th' -> Forall2 contains params (th' ++ tb)) ->
  (forall e, In e (entries (divided_rows fs)) -> formula_at tape (place (formulas tape) e) = e) ->
  (forall f, In f fs -> forall e, In e (f_joint f :: map snd (slopes_of ps (f_joint f))) -> formula_at tape (place (formulas tape) e) = e) ->
  (forall P, Forall2 (represents P (th ++ tb)) fs (map (resized (/ two_to s)) m)) ->
  test_of (place (formulas tape)) ps fs s j (Accuracy error b) = Some t ->
  Check.holds bits tape whole (map_rows (place (formulas tape)) (divided_rows fs)) [] params (th ++ tb) 3 (coordinates (vscale (/ two_to s) P)) t ->
  fulfils c m P (Accuracy error b).
Proof.
  intros c s ds m P th tb params tape whole error b t j ps fs hm built hth E FD FJ Rep ht H rho hrho is_at.
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. set (ratio := / two_to s) in *. set (Q := vscale ratio P) in *.
  destruct (all_nominal_represent s (legs c) m hm ds) as [_ Nom]. specialize (fun Q => Nom Q [] tb). cbn [app length] in Nom. fold ps ratio fs in Nom.
  cbn [test_of] in ht. destruct (Nat.eqb (length fs) 3 && Compare.certainly bits false error && Compare.certainly bits true b) eqn:g; [| discriminate].
  apply andb_true_iff in g as [g b0]. apply andb_true_iff in g as [l3 _]. apply Nat.eqb_eq in l3. apply Compare.positive_sound in b0.
  destruct (enclose_parameter bits (bound_of s (Accuracy error b))) as [d |] eqn:ed; [| discriminate]. destruct (all_some _) as [js |] eqn:ej; [| discriminate]. injection ht as <-.
  pose proof (enclose_parameter_sound bits _ _ _ ed (bound_within s (Accuracy error b))) as hd.
  assert (Ed : bound_value s (Accuracy error b) = ratio * Claim.value b) by (unfold bound_value; cbn; unfold Rdiv; fold ratio; ring). rewrite Ed in hd.
  assert (D0 : 0 < ratio * Claim.value b) by (apply Rmult_lt_0_compat; assumption).
  cbn [Check.holds] in H. specialize (H (ex_intro _ _ (conj hd (Rlt_le _ _ D0)))).
  revert l3 FD FJ Rep Nom ej H. generalize fs. clear fs. intros fs l3 FD FJ Rep Nom ej H.
  destruct fs as [| f1 [| f2 [| f3 [|]]]]; try discriminate. clear l3.
  pose proof (related_length _ _ _ _ _ (Rep Q)) as lm. rewrite map_length in lm. destruct m as [| l1 [| l2 [| l3 [|]]]]; try discriminate. clear lm. cbn [map] in Rep.
  revert Nom hrho. inversion hm as [| d1 ? ds1 ? m1 hm1 e1 e2]; subst. inversion hm1 as [| d2 ? ds2 ? m2 hm2]; subst. inversion hm2 as [| d3 ? ds3 ? m3 hm3]; subst. inversion hm3; subst.
  cbn [map]. intros Nom hrho. inversion hrho as [| ? y1 ? ? n1 hr1]; subst. inversion hr1 as [| ? y2 ? ? n2 hr2]; subst. inversion hr2 as [| ? y3 ? ? n3 hr3]; subst. inversion hr3; subst.
  cbn [map all_some] in ej.
  destruct (joint_test (place (formulas tape)) ps s error b (f_joint f1)) as [j1 |] eqn:t1; [| discriminate]. destruct (joint_test (place (formulas tape)) ps s error b (f_joint f2)) as [j2 |] eqn:t2; [| discriminate].
  destruct (joint_test (place (formulas tape)) ps s error b (f_joint f3)) as [j3 |] eqn:t3; [| discriminate]. injection ej as <-.
  assert (Ok : forall l, In l [l1; l2; l3] -> well_formed_leg (resized ratio l)) by (intros l i; apply (well_formed_resized ratio r0 l); rewrite Forall_forall in built; apply built, i).
  assert (Def : forall j, In j [j1; j2; j3] -> forall th, Forall2 contains params th -> defined (coordinates Q) th (formula_at tape (fst j))).
  { intros i ij th' h. destruct H as [H _]. specialize (H th' h). rewrite Forall_forall in H. exact (H i ij). }
  assert (Off : forall f l dr y i, In f [f1; f2; f3] -> In i [j1; j2; j3] -> joint_test (place (formulas tape)) ps s error b (f_joint f) = Some i ->
    represents Q (th ++ tb) f (resized ratio l) -> represents Q (map middle_of ps ++ tb) f (resized ratio (nominal_leg dr)) ->
    Rabs (y - joint (nominal_leg dr) P) <= Claim.value error -> may_be_off bits tape params (coordinates Q) i ((ratio * y - joint (resized ratio l) Q) / (ratio * Claim.value b))).
  { intros f l dr y i If Ij ht h1 h0 hy. destruct h1 as [_ [_ [_ [h1 _]]]]. destruct h0 as [_ [_ [_ [h0 _]]]].
    refine (joint_is_off s b error ps th tb params tape (f_joint f) (coordinates Q) (ratio * y) _ _ i hth E h1 h0 (FJ f If) ht (Def i Ij) b0 _).
    destruct (resized_same ratio P r0 (nominal_leg dr)) as [_ [e _]]. fold Q in e. rewrite e, <- Rmult_minus_distr_l, Rabs_mult, (Rabs_pos_eq ratio) by lra. fold ratio.
    apply Rmult_le_compat_l; [lra | exact hy]. }
  pose proof (Rep Q) as h. apply cons_related in h as [h1 h]. apply cons_related in h as [h2 h]. apply cons_related in h as [h3 _].
  pose proof (Nom Q) as h. apply cons_related in h as [k1 h]. apply cons_related in h as [k2 h]. apply cons_related in h as [k3 _].
  destruct (one_near tape params (th ++ tb) Q f1 f2 f3 (resized ratio l1) (resized ratio l2) (resized ratio l3) d j1 j2 j3 (ratio * y1) (ratio * y2) (ratio * y3) (ratio * Claim.value b)
    Rep ltac:(repeat (apply Forall_cons; [apply Ok; cbn; tauto |]); apply Forall_nil) FD hd D0 H
    (Off f1 l1 d1 y1 j1 ltac:(cbn; tauto) ltac:(cbn; tauto) t1 h1 k1 n1) (Off f2 l2 d2 y2 j2 ltac:(cbn; tauto) ltac:(cbn; tauto) t2 h2 k2 n2)
    (Off f3 l3 d3 y3 j3 ltac:(cbn; tauto) ltac:(cbn; tauto) t3 h3 k3 n3)) as [Q' [[u1 u2] u3]].
  set (P' := vscale (/ ratio) Q').
  assert (Back : forall A, vscale ratio (vscale (/ ratio) A) = A) by (intro A; apply vec_ext; unfold vscale; cbn [vx vy vz]; field; lra).
  assert (One : forall A l y, reaches (vscale ratio A) (resized ratio l) /\ joint (resized ratio l) (vscale ratio A) = ratio * y <-> reaches A l /\ joint l A = y).
  { intros A l y. destruct (resized_same ratio A r0 l) as [_ [e q]]. rewrite e. split; intros [a1 a2]; (split; [apply q, a1 |]); [apply Rmult_eq_reg_l with ratio; lra | congruence]. }
  assert (Dist : forall A, Accuracy.size (vsub (vscale ratio A) Q) <= ratio * Claim.value b <-> norm2 (vsub A P) <= Claim.value b ^ 2).
  { intro A. assert (e : vsub (vscale ratio A) Q = vscale ratio (vsub A P)) by (unfold Q; apply vec_ext; unfold vsub, vscale; cbn [vx vy vz]; ring).
    rewrite e, Accuracy.size_scaled by lra. split; intro a.
    - apply Accuracy.size_above. apply Rmult_le_reg_l with ratio; assumption.
    - apply Rmult_le_compat_l; [lra |]. apply Accuracy.size_below; [lra | exact a]. }
  exists P'. split.
  - split; [apply Dist; unfold P'; rewrite Back; exact u1 |].
    apply cons_related in u2 as [a1 u2]. apply cons_related in u2 as [a2 u2]. apply cons_related in u2 as [a3 _].
    repeat (apply Forall2_cons; [apply One; unfold P'; rewrite Back; assumption |]). constructor.
  - intros P'' [a a']. apply cons_related in a' as [a1 a']. apply cons_related in a' as [a2 a']. apply cons_related in a' as [a3 _].
    unfold P'. rewrite <- (u3 (vscale ratio P'')); [apply vec_ext; unfold vscale; cbn [vx vy vz]; field; lra |].
    split; [apply Dist, a |]. repeat (apply Forall2_cons; [apply One; assumption |]). constructor.
Qed.

(** Soundness: what the checker accepts is true of every machine and point of the claim. *)
Theorem check_claim_by_sound : forall c s ds t, check_claim_by c s ds t = true -> Statement.holds c.
Proof.
  intros c s ds t h m P0 hm hP0. unfold check_claim_by in h. cbn zeta in h.
  set (fs := all_formulas s ds (legs c) 0) in *. set (n := (length (layouts s ds (legs c)), length (layouts s ds (legs c)) + length (require c))%nat) in *.
  set (needed := entries (whole_rows fs) ++ entries (divided_rows fs) ++ range_formulas fs s n (require c) ++ accuracy_formulas (layouts s ds (legs c)) fs (require c)) in *.
  set (tape := compile needed) in *.
  destruct (forallb _ needed) eqn:found; [| discriminate].
  destruct (existsb is_lower (require c) && are_buildable s ds (legs c)) eqn:low; [| discriminate]. apply andb_true_iff in low as [low able].
  destruct (all_some (map (enclose_parameter bits) (layouts s ds (legs c) ++ map (bound_of s) (require c) ++ flat_map (extras s) (require c)))) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map (enclose_parameter bits) (three (hull (workspace c)) s))) as [box |] eqn:eb; [| discriminate].
  destruct (all_some (tests_of _ _ fs s n (require c))) as [tests |] eqn:et; [| discriminate].
  assert (Found : forall e, In e needed -> formula_at tape (place (formulas tape) e) = e).
  { rewrite forallb_forall in found. intros e i. apply same_sound, found, i. }
  destruct (all_represent s (legs c) m hm ds) as [th [L R]].
  set (tb := map (bound_value s) (require c) ++ map exact_value (flat_map (extras s) (require c))).
  pose proof (Forall2_app (bounds_within s (require c)) (all_extras_within s (require c))) as B. fold tb in B.
  pose proof (enclosed_all _ _ _ ep (Forall2_app L B)) as T.
  assert (W : forall e, In e (entries (whole_rows fs)) -> formula_at tape (place (formulas tape) e) = e)
    by (intros e i; apply Found, in_or_app; left; exact i).
  assert (V : forall e, In e (entries (divided_rows fs)) -> formula_at tape (place (formulas tape) e) = e)
    by (intros e i; apply Found, in_or_app; right; apply in_or_app; left; exact i).
  apply existsb_exists in low as [r0 [i0 l0]]. assert (ln : length (layouts s ds (legs c)) = length th) by apply (related_length _ _ _ _ _ L).
  assert (Point : forall P, in_region (workspace c) P -> Forall2 (represents (vscale (/ two_to s) P) (th ++ tb)) fs (map (resized (/ two_to s)) m) /\
    Forall (reaches P) m /\ injective m P /\ forall r, In r (require c) -> exists j u, nth (fst j) (th ++ tb) 0 = bound_value s r /\
    map (value (coordinates (vscale (/ two_to s) P)) (th ++ tb)) (numbered (snd j) (extras s r)) = map exact_value (extras s r) /\
    (forall f, In f (range_formula fs s j r) -> formula_at tape (place (formulas tape) f) = f) /\
    test_of (place (formulas tape)) (layouts s ds (legs c)) fs s j r = Some u /\
    Check.holds bits tape (map_rows (place (formulas tape)) (whole_rows fs)) (map_rows (place (formulas tape)) (divided_rows fs)) []
      params (th ++ tb) 3 (coordinates (vscale (/ two_to s) P)) u).
  { intros P hP.
  pose proof (enclosed_all _ _ _ eb (three_within (hull (workspace c)) s P (hull_sound _ _ hP))) as X.
  assert (three_of_them : length box = 3%nat) by (rewrite (related_length _ _ _ _ _ X); reflexivity).
  pose proof (check_all_open bits tape _ _ _ params tests (tangent (workspace c) s) (th ++ tb) T
    (fun y => y = coordinates (vscale (/ two_to s) P))
    (fun cell lambda y q e l a d => tangent_sound (workspace c) s P hP cell lambda q e l (eq_ind y (fun z => Forall2
      (fun a p => snd p - centre_of bits a = IZR (half a) / unit_R bits * fst p) cell (combine lambda z)) d _ a))
    t box _ h X eq_refl) as H. rewrite three_of_them in H.
  specialize (R (vscale (/ two_to s) P) [] tb). cbn [app length] in R.
  assert (Each : forall r, In r (require c) -> exists j u, nth (fst j) (th ++ tb) 0 = bound_value s r /\
    map (value (coordinates (vscale (/ two_to s) P)) (th ++ tb)) (numbered (snd j) (extras s r)) = map exact_value (extras s r) /\
    (forall f, In f (range_formula fs s j r) -> formula_at tape (place (formulas tape) f) = f) /\
    test_of (place (formulas tape)) (layouts s ds (legs c)) fs s j r = Some u /\
    Check.holds bits tape (map_rows (place (formulas tape)) (whole_rows fs)) (map_rows (place (formulas tape)) (divided_rows fs)) []
      params (th ++ tb) 3 (coordinates (vscale (/ two_to s) P)) u).
  { intros r i. destruct (In_nth_error _ _ i) as [k e].
    destruct (requirement_at (place (formulas tape)) (layouts s ds (legs c)) fs s (require c) n k r e) as [j [front [back [-> [h1 [h2 h3]]]]]].
    destruct (all_some_in _ _ _ _ et h2) as [u [e2 iu]]. exists (fst n + k, snd n + length front)%nat, u.
    destruct (numbers_at (coordinates (vscale (/ two_to s) P)) s (require c) th k r front back e h1) as [b1 b2]. rewrite <- ln in b1, b2.
    split; [exact b1 |]. split; [exact b2 |]. split; [| split].
    - intros f g. apply Found, in_or_app. right. apply in_or_app. right. apply in_or_app. left. exact (h3 f g).
    - exact e2.
    - exact (H u iu). }
  destruct (Each r0 i0) as [j0 [u0 [E1 [E0 [E2 [E3 E4]]]]]].
  destruct (lower_fulfilled c s ds m P (th ++ tb) params tape R W V j0 r0 E1 E0 E2 u0 E3 E4 l0) as [h1 [h2 _]].
  split; [exact R |]. split; [exact h1 |]. split; [exact h2 | exact Each]. }
  pose proof (are_buildable_sound s _ _ hm ds able) as built. destruct (Point P0 hP0) as [R0 [h1 [h2 Each]]].
  split; [exact h1 |]. split; [exact h2 |]. apply Forall_forall. intros r i.
  destruct (Each r i) as [j [u [F1 [F0 [F2 [F3 F4]]]]]].
  apply (fulfilled c s ds m P0 (th ++ tb) params tape R0 W V j r F1 F0 F2 u F3 F4 h1 hm built). destruct r as [| | | | | | | | | | | | | | | | error b | ks kb]; try exact I.
  - cbn [fulfils]. intros P1 hP1 reached1 same. destruct (Point P1 hP1) as [R1 [_ [_ Each1]]]. destruct (Each1 _ i) as [j1 [u1 [_ [_ [_ [G3 G4]]]]]].
    cbn [test_of] in F3, G3. injection F3 as <-. injection G3 as <-.
    exact (one_to_one s fs m P0 P1 (th ++ tb) tape params W R0 R1 built h1 reached1 same _ _ _ F4 G4).
  - refine (accuracy_fulfilled c s ds m P0 th tb params tape _ error b u j hm built L (fun th' L' => enclosed_all _ _ _ ep (Forall2_app L' B)) V _ (fun P => R P [] tb) F3 F4).
    intros f jf e ie. apply Found, in_or_app. right. apply in_or_app. right. apply in_or_app. right. unfold accuracy_formulas.
    destruct (existsb _ (require c)) eqn:x; [apply in_flat_map; exists f; split; assumption |].
    assert (existsb (fun r => match r with Accuracy _ _ => true | _ => false end) (require c) = true) by (apply existsb_exists; exists (Accuracy error b); split; [exact i | reflexivity]). congruence.
Qed.
End Precision.

Definition check_claim (bits : positive) : claim -> Z -> list Z -> tree -> bool := check_claim_by bits (0%N, []).
Corollary check_claim_sound : forall bits c s ds t, check_claim bits c s ds t = true -> Statement.holds c.
Proof. intro bits. apply check_claim_by_sound. Qed.
End Named.
