(** * Refutations of accuracy: joint errors and a machine that has no position, or pose, near enough

    Polynomials h_i in what a pose is off by are zero where it has given joint coordinates.  The sum of them, with
    weights, is one polynomial, whose coefficients are sums: where its slopes tell that it is negative at all u of the
    ball, |u_t| <= 1 and |u_c| <= 1, no pose within the bound has these coordinates: nominal ones with the worst errors.
    In a cell of an atlas its parameters are coordinates of the slopes, too. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Number Trig Machine Witness Arm Orientation Turning Legs Configuration Singular Onward Accelerated Same Twins.
From Orthocert.kernel Require Linear Solve Slope Twofold.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** Weights may be any numbers: of few bits, rounded. *)
Definition few_bits : positive := 96.
Definition rounded (x : number) : number := match enclose few_bits x with Some a => hi a // (2 ^ few_bits) | None => 0 // 1 end.

Section Meant.
Context {names : naming}.

Definition nowhere : numbers := Numbers (0 // 1) (0 // 1) (0 // 1).
Lemma nowhere_is : values nowhere = vzero.
Proof. unfold values, nowhere, vzero. cbn [nx ny nz value]. f_equal; lra. Qed.

(** [s], [b] and [sigma]: s + b . u + sigma |u|^2, at P + u, is zero where the leg reaches this point and has the joint coordinate r there. *)
Record form := Form { s_of : number; b_of : numbers; sigma_of : number }.
Definition form_of (P : numbers) (l : exact_leg) (r : number) : form :=
  match l with
  | ExactSlider d a p len m => let A := each2 Minus (nspan a p P) (scaled r (unit_of d)) in Form (Minus (product A A) (Times len len)) (scaled (2 // 1) A) (1 // 1)
  | ExactStrut a p _ => let A := nspan a p P in Form (Minus (product A A) (Times r r)) (scaled (2 // 1) A) (1 // 1)
  | ExactPlanar d => Form (Minus (product (unit_of d) P) r) (unit_of d) (0 // 1)
  end.
(** The derivative of the form by the joint coordinate is nearly this times the weight's, so that [v] weighs coordinates. *)
Definition weight_of (P : numbers) (q : exact_leg * number * Z) : number :=
  let '(l, r, v) := q in
  match l with
  | ExactSlider d a p len m => rounded (Over (v // 1) (Plus (signed_root m (clearance2 d a p len P)) (Minus (product (unit_of d) (nspan a p P)) r)))
  | ExactStrut _ _ _ => rounded (Over (v // 1) (Plus r (njoint l P)))
  | ExactPlanar _ => v // 1
  end.
Definition form_value (w : form) (u : vec) : R := value (s_of w) + Vec3.dot (values (b_of w)) u + value (sigma_of w) * norm2 u.
Lemma form_zero : forall P l r u, well_formed_leg (leg_of l) -> reaches (vadd (values P) u) (leg_of l) -> joint (leg_of l) (vadd (values P) u) = value r -> form_value (form_of P l r) u = 0.
Proof.
  intros P [d a p len m | a p k | d] r u ok re e; unfold form_value; cbn [form_of leg_of] in *; cbv zeta; cbn [s_of b_of sigma_of value joint reaches well_formed_leg] in *; rewrite ?value_square, ?value_product, ?values_scaled.
  - pose proof (leg_vector_length _ _ ok re) as L. unfold leg_vector, C_point, B_point, A_point in L. cbn [axis base_point platform_offset leg_length] in L. rewrite e in L.
    rewrite values_minus, values_scaled, values_unit. replace (value len * value len) with (value len ^ 2) by ring. rewrite <- L.
    unfold nspan. rewrite values_minus, values_plus. generalize (normalised (values d)) (values P) (values a) (values p) (value r). cbn [value]. intros [n1 n2 n3] [x1 x2 x3] [a1 a2 a3] [p1 p2 p3] q. destruct u as [u1 u2 u3]. unfold norm2, Vec3.dot, vadd, vsub, vscale. cbn [vx vy vz]. field.
  - rewrite <- e. change (values (nspan a p P)) with (span (values a) (values p) (values P)). rewrite sqrt_sqrt by apply norm2_nonneg. unfold span. generalize (values P) (values a) (values p). cbn [value].
    intros [x1 x2 x3] [a1 a2 a3] [p1 p2 p3]. destruct u as [u1 u2 u3]. unfold norm2, Vec3.dot, vadd, vsub, vscale. cbn [vx vy vz]. field.
  - rewrite values_unit, <- e. generalize (normalised (values d)) (values P). intros [n1 n2 n3] [x1 x2 x3]. destruct u as [u1 u2 u3]. unfold norm2, Vec3.dot, vadd. cbn [vx vy vz]. field.
Qed.

Definition sum_of {A : Type} (f : A -> number) (l : list A) : number := fold_right (fun x sum => Plus (f x) sum) (0 // 1) l.
Definition sums_of {A : Type} (f : A -> numbers) (l : list A) : numbers := fold_right (fun x sum => each2 Plus (f x) sum) nowhere l.
Definition whole_form (P U : numbers) (l : list (exact_leg * number * Z)) : number :=
  let form q := form_of P (fst (fst q)) (snd (fst q)) in let w := weight_of P in
  Plus (Plus (sum_of (fun q => Times (w q) (s_of (form q))) l) (product (sums_of (fun q => scaled (w q) (b_of (form q))) l) U))
    (Times (sum_of (fun q => Times (w q) (sigma_of (form q))) l) (product U U)).
Lemma whole_form_is : forall P U l, value (whole_form P U l) = fold_right (fun q sum => value (weight_of P q) * form_value (form_of P (fst (fst q)) (snd (fst q))) (values U) + sum) 0 l.
Proof.
  intros P U l. unfold whole_form. cbv zeta. cbn [value]. rewrite !value_product, <- norm2_dot. set (u := values U).
  assert (Z0 : value (0 // 1) = 0) by (cbn; lra). induction l as [| q l IH]; cbn [sum_of sums_of fold_right]; [rewrite nowhere_is, Z0; unfold Vec3.dot, vzero; cbn; ring |].
  unfold sum_of, sums_of in *. rewrite values_plus, values_scaled. cbn [value]. unfold form_value at 1. rewrite <- IH. generalize (values (fold_right (fun x sum => each2 Plus (scaled (weight_of P x) (b_of (form_of P (fst (fst x)) (snd (fst x))))) sum) nowhere l)).
  intros [x1 x2 x3]. generalize (values (b_of (form_of P (fst (fst q)) (snd (fst q))))). intros [b1 b2 b3]. clear IH. destruct u as [u1 u2 u3]. unfold Vec3.dot, vadd, vscale. cbn [vx vy vz]. ring.
Qed.

(** Of a strut from a to P + u + S r, where D = P - a, and S keeps lengths. *)
Record lever := Lever { weight : number; length_of : number; D_of : numbers; r_of : numbers }.
Definition whole_pose (U c : numbers) (l : list lever) : number :=
  let two := 2 // 1 in let at_ k := sums_of (fun q => scaled (Times (weight q) (k (r_of q))) (D_of q)) l in let T := sum_of (fun q => Times (weight q) (product (D_of q) (r_of q))) l in let c2 := product c c in
  let turned := each2 Plus (each2 Plus (scaled (nx c) (at_ nx)) (scaled (ny c) (at_ ny))) (scaled (nz c) (at_ nz)) in
  Plus (Plus (Plus (sum_of (fun q => Times (weight q) (Minus (Plus (product (D_of q) (D_of q)) (product (r_of q) (r_of q))) (Times (length_of q) (length_of q)))) l)
      (Times two (product (sums_of (fun q => scaled (weight q) (D_of q)) l) U)))
    (Plus (Times (sum_of weight l) (product U U)) (Times two (product U (Orientation.along c (sums_of (fun q => scaled (weight q) (r_of q)) l))))))
    (Plus (Times two T) (Times (Over (4 // 1) (Plus (1 // 1) c2))
      (Minus (Plus (product c (sums_of (fun q => scaled (weight q) (ncrossed (r_of q) (D_of q))) l)) (product c turned)) (Times c2 T)))).
Lemma axis_onward : forall c b, mulv (along_axis c) b = onward c b.
Proof. intros c b. rewrite <- (mulv_identity b) at 2. rewrite <- moved_on_onward. unfold moved_on. rewrite mulv_mulm, mulv_identity. reflexivity. Qed.
Lemma whole_pose_is : forall U c l S, S = along_axis (values c) -> (forall b, values (Orientation.along c b) = mulv S (values b)) -> (forall b, norm2 (mulv S b) = norm2 b) ->
  value (whole_pose U c l) = fold_right (fun q sum => value (weight q) * (norm2 (vadd (vadd (values (D_of q)) (values U)) (mulv S (values (r_of q)))) - value (length_of q) ^ 2) + sum) 0 l.
Proof.
  intros U c l S is_S turn keeps. unfold whole_pose. cbv zeta. cbn [value]. rewrite !value_product, !turn, !values_plus, !values_scaled, <- !norm2_dot. set (u := values U).
  change (value (nx c)) with (vx (values c)). change (value (ny c)) with (vy (values c)). change (value (nz c)) with (vz (values c)).
  assert (Z0 : value (0 // 1) = 0) by (cbn; lra). assert (T : IZR 2 / IZR 1 = 2) by lra.
  set (k := 2 / (1 + norm2 (values c))). assert (F : IZR 4 / IZR 1 / (IZR 1 / IZR 1 + norm2 (values c)) = 2 * k) by (unfold k; pose proof (norm2_nonneg (values c)); field; lra). rewrite F, T. clear F T.
  induction l as [| q l IH]; unfold sum_of, sums_of in *; cbn [fold_right];
    [rewrite nowhere_is, Z0; clear; destruct S as [[s1 s2 s3] [s4 s5 s6] [s7 s8 s9]], u as [u1 u2 u3], (values c) as [c1 c2 c3]; unfold mulv, Vec3.dot, norm2, vadd, vscale, vzero; cbn [vx vy vz row1 row2 row3]; ring |].
  rewrite !values_plus, !values_scaled, values_crossed. cbn [value]. rewrite !value_product. rewrite <- IH. clear IH.
  assert (K : norm2 (vadd (vadd (values (D_of q)) u) (mulv S (values (r_of q)))) = norm2 (values (D_of q)) + norm2 u + norm2 (values (r_of q)) + 2 * Vec3.dot (values (D_of q)) u + 2 * Vec3.dot u (mulv S (values (r_of q))) +
    2 * (Vec3.dot (values (D_of q)) (values (r_of q)) + k * (Vec3.dot (values c) (cross (values (r_of q)) (values (D_of q))) + Vec3.dot (values (D_of q)) (values c) * Vec3.dot (values c) (values (r_of q)) - norm2 (values c) * Vec3.dot (values (D_of q)) (values (r_of q))))).
  { assert (O : Vec3.dot (values (D_of q)) (mulv S (values (r_of q))) = Vec3.dot (values (D_of q)) (values (r_of q)) + k * (Vec3.dot (values c) (cross (values (r_of q)) (values (D_of q))) + Vec3.dot (values (D_of q)) (values c) * Vec3.dot (values c) (values (r_of q)) - norm2 (values c) * Vec3.dot (values (D_of q)) (values (r_of q)))).
    { rewrite is_S, axis_onward. unfold onward. fold k. generalize k (values (D_of q)) (values (r_of q)) (values c). clear. intros k [x1 x2 x3] [y1 y2 y3] [c1 c2 c3]. unfold norm2, Vec3.dot, vadd, vscale, cross. cbn [vx vy vz]. ring. }
    rewrite <- O, <- (keeps (values (r_of q))). generalize (values (D_of q)) (mulv S (values (r_of q))). clear. intros [x1 x2 x3] [y1 y2 y3]. destruct u as [u1 u2 u3]. unfold norm2, Vec3.dot, vadd. cbn [vx vy vz]. ring. }
  rewrite K, <- !norm2_dot. clear K keeps turn is_S.
  change (value (nx (r_of q))) with (vx (values (r_of q))). change (value (ny (r_of q))) with (vy (values (r_of q))). change (value (nz (r_of q))) with (vz (values (r_of q))). clearbody k.
  repeat match goal with |- context [values (fold_right ?f ?a l)] => generalize (values (fold_right f a l)); let p := fresh "p" in let p' := fresh "p" in let p'' := fresh "p" in intros [p p' p''] end. repeat match goal with |- context [value (fold_right ?f ?a l)] => generalize (value (fold_right f a l)); let t := fresh "t" in intro t end.
  generalize (values (D_of q)) (values (r_of q)) (values c). intros [d1 d2 d3] [r1 r2 r3] [c1 c2 c3]. destruct S as [[s1 s2 s3] [s4 s5 s6] [s7 s8 s9]], u as [u1 u2 u3]. unfold norm2, mulv, Vec3.dot, vadd, vscale, cross. cbn [vx vy vz row1 row2 row3]. ring.
Qed.
End Meant.

(** Parameters of an atlas first, and then what a pose is off by. *)
Definition along_beside (names : naming) (u : list R) (k : nat) : R := if Nat.ltb k most_parameters then @Claim.along names k else part_at u (k - most_parameters).
Lemma beside_within : forall names u k, 0 <= along_beside names u k <= 1.
Proof. intros names u k. unfold along_beside. destruct (Nat.ltb k most_parameters); [apply Claim.along_within | apply part_within]. Qed.
Definition beside (names : naming) (u : list R) : naming := {| Claim.along := along_beside names u; Claim.along_within := beside_within names u |}.

Fixpoint is_named_number (x : number) : bool :=
  match x with
  | Ratio _ _ => true
  | Varying k _ _ => Nat.ltb k most_parameters
  | Plus x y | Minus x y | Times x y | Over x y => is_named_number x && is_named_number y
  | Root x => is_named_number x
  end.
Definition is_named (l : list number) : bool := forallb is_named_number l.
Lemma named_agrees : forall names u l, is_named l = true -> @agrees names (beside names u) l.
Proof.
  intros names u l h. unfold is_named in h. rewrite forallb_forall in h. apply Forall_forall. intros x ix. specialize (h x ix). clear ix.
  induction x as [n d | k p q | x hx y hy | x hx y hy | x hx y hy | x hx y hy | x hx]; cbn [is_named_number value] in *; try (apply andb_true_iff in h as [h1 h2]; rewrite hx, hy by assumption); try reflexivity.
  - cbn [Claim.along beside]. unfold along_beside. rewrite h. reflexivity.
  - rewrite hx by exact h. reflexivity.
Qed.
Lemma named_values : forall names u l, is_named l = true -> map (@value (beside names u)) l = map (@value names) l.
Proof. intros names u l h. pose proof (named_agrees names u l h) as A. induction A as [| x l hx hl IH]; [reflexivity |]. cbn [map]. rewrite hx, IH; [reflexivity |]. cbn [is_named forallb] in h. apply andb_true_iff in h. apply h. Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

(** ** A formula that is negative near a centre *)

Lemma sqrt_ceil_above : forall n, (0 <= n)%Z -> (0 <= sqrt_ceil n)%Z /\ (n <= sqrt_ceil n ^ 2)%Z.
Proof.
  intros n h. pose proof (Z.sqrt_spec n h) as [f g]. pose proof (Z.sqrt_nonneg n). unfold sqrt_ceil. destruct (Z.sqrt n * Z.sqrt n =? n)%Z eqn:q; [apply Z.eqb_eq in q | apply Z.eqb_neq in q]; nia.
Qed.
Lemma squares_nonneg : forall l, (0 <= squares l)%Z.
Proof. induction l as [| a l IH]; cbn [squares fold_right]; [lia |]. fold (squares l). nia. Qed.
Lemma size_above : forall l u, Forall2 contains l u -> Twofold.size u * unit_R bits <= IZR (sqrt_ceil (squares l)).
Proof.
  intros l u h. pose proof (squares_sound bits l u h) as s. destruct (sqrt_ceil_above _ (squares_nonneg l)) as [r0 r]. apply IZR_le in r, r0. rewrite Z.pow_2_r, mult_IZR in r.
  pose proof (Twofold.size_nonneg u). pose proof (unit_R_pos bits). rewrite <- Twofold.size_square in s. apply Rsqr_incr_0_var; [unfold Rsqr; nra | exact r0].
Qed.

Section Off.
(** Of so many coordinates, the first [f] of place. *)
Variables n f : nat.

Definition around (k : nat) (a b : Q) : option Slope.slope := if Nat.ltb k (most_parameters + n) && Qle_bool a b then Some (Number.coordinate bits k a b) else None.
Definition deviations (names : naming) (u : list R) : list R := @Number.lambdas_of (beside names u) (most_parameters + n).
Lemma around_holds : forall names u k a b s, around k a b = Some s -> Slope.holds bits (deviations names u) s (@value halfway (Varying k a b)) (@value (beside names u) (Varying k a b)).
Proof.
  intros names u k a b s h. unfold around in h. destruct (Nat.ltb k (most_parameters + n)) eqn:hk; [| discriminate]. destruct (Qle_bool a b) eqn:le; [| discriminate]. injection h as <-.
  apply (@Number.coordinate_holds (beside names u)); [apply Nat.ltb_lt, hk | apply Qreals.Qle_Rle, Qle_bool_iff, le].
Qed.
Definition is_near_centre (u : list R) : Prop := length u = n /\ Twofold.size (firstn f u) <= 1 /\ Twofold.size (skipn f u) <= 1.
Lemma part_near : forall u k, is_near_centre u -> part_at u k = (1 + nth k u 0) / 2.
Proof.
  intros u k [_ [h1 h2]]. pose proof (Twofold.norm_entry f u k) as e. assert (N : Twofold.norm f u <= 1) by (apply Twofold.norm_below; intros []; assumption).
  pose proof (Rle_abs (nth k u 0)). pose proof (Rle_abs (- nth k u 0)) as a. rewrite Rabs_Ropp in a. unfold part_at. rewrite Rmin_right, Rmax_right; lra.
Qed.
Lemma deviations_are : forall names u, is_near_centre u -> skipn most_parameters (deviations names u) = u /\ Forall (fun t => -1 <= t <= 1) (firstn most_parameters (deviations names u)).
Proof.
  intros names u h. assert (l : length u = n) by apply h. assert (W : Forall (fun t => -1 <= t <= 1) (deviations names u)) by apply Number.lambdas_within. split.
  - apply Twofold.same_entries; [unfold deviations, Number.lambdas_of; rewrite skipn_length, map_length, seq_length, l; lia |]. intro k. rewrite <- (firstn_skipn most_parameters (deviations names u)) in W.
    destruct (Nat.lt_ge_cases k n) as [hk | hk]; [| rewrite !nth_overflow; [reflexivity | lia | unfold deviations, Number.lambdas_of; rewrite skipn_length, map_length, seq_length; lia]].
    assert (E : nth k (skipn most_parameters (deviations names u)) 0 = nth (most_parameters + k) (deviations names u) 0).
    { rewrite <- (firstn_skipn most_parameters (deviations names u)) at 2. rewrite app_nth2; rewrite firstn_length_le by (unfold deviations, Number.lambdas_of; rewrite map_length, seq_length; lia); [f_equal; lia | lia]. }
    rewrite E. unfold deviations, Number.lambdas_of. set (g := fun k => 2 * Claim.along k - 1). rewrite (nth_indep _ 0 (g 0%nat)) by (rewrite map_length, seq_length; lia). rewrite map_nth, seq_nth by lia. unfold g.
    cbn [Claim.along beside]. unfold along_beside. replace (Nat.ltb (0 + (most_parameters + k)) most_parameters) with false by (symmetry; apply Nat.ltb_ge; lia).
    replace (0 + (most_parameters + k) - most_parameters)%nat with k by lia. rewrite (part_near u k h). field.
  - rewrite <- (firstn_skipn most_parameters (deviations names u)) in W. apply Forall_app in W. apply W.
Qed.

Definition stays_below (g : number) : bool :=
  match sloped_by bits around g with
  | Some s => let rest := skipn most_parameters (Slope.slopes s) in
      (hi (Slope.at_c s) <? - (Slope.reach (firstn most_parameters (Slope.slopes s)) + sqrt_ceil (squares (firstn f rest)) + sqrt_ceil (squares (skipn f rest))))%Z
  | None => false
  end.
Lemma stays_below_sound : forall names g u, stays_below g = true -> is_near_centre u -> @value (beside names u) g < 0.
Proof.
  intros names g u h near. unfold stays_below in h. destruct (sloped_by bits around g) as [s |] eqn:e; [| discriminate]. cbv zeta in h. apply Z.ltb_lt, IZR_lt in h. rewrite opp_IZR, !plus_IZR in h.
  destruct (sloped_by_sound bits around (deviations names u) halfway (beside names u) (@Number.lambdas_within (beside names u) _) (around_holds names u) g s e) as [[_ c] [_ [r [R E]]]].
  destruct (deviations_are names u near) as [D1 D2]. rewrite (Twofold.dot_parts most_parameters r (deviations names u)), D1, (Twofold.dot_parts f (skipn most_parameters r) u) in E. destruct near as [_ [n1 n2]]. pose proof (unit_R_pos bits) as p.
  assert (K : forall a b l, Twofold.size b <= 1 -> Forall2 contains l a -> Linear.dot a b * unit_R bits <= IZR (sqrt_ceil (squares l))).
  { intros a b l nb hl. apply Rle_trans with (2 := size_above l a hl). apply Rmult_le_compat_r; [lra |]. apply Rle_trans with (1 := Twofold.dot_sizes a b).
    pose proof (Twofold.size_nonneg a). rewrite <- (Rmult_1_r (Twofold.size a)) at 2. apply Rmult_le_compat_l; assumption. }
  assert (Parts : forall f l a, Forall2 contains l a -> Forall2 contains (firstn f l) (firstn f a) /\ Forall2 contains (skipn f l) (skipn f a)).
  { clear. induction f as [| m IH]; intros l a h; [split; [constructor | exact h] |]. destruct h as [| x y l a hx h]; [split; constructor |]. destruct (IH l a h). cbn [firstn skipn]. split; [constructor; assumption | assumption]. }
  destruct (Parts most_parameters _ _ R) as [R0 R']. destruct (Parts f _ _ R') as [R1 R2]. pose proof (K _ _ _ n1 R1). pose proof (K _ _ _ n2 R2). destruct (Slope.reach_sound bits _ D2 _ _ (ex_intro _ _ (conj R0 eq_refl))) as [_ K0]. apply Rmult_lt_reg_r with (unit_R bits); [exact p |].
  set (x := Linear.dot (firstn most_parameters r) (firstn most_parameters (deviations names u))) in *. set (y := Linear.dot (firstn f (skipn most_parameters r)) (firstn f u)) in *. set (z := Linear.dot (skipn f (skipn most_parameters r)) (skipn f u)) in *.
  set (b := @value (beside names u) g) in *. set (a := @value halfway g) in *.
  replace (b * unit_R bits) with (a * unit_R bits + x * unit_R bits + y * unit_R bits + z * unit_R bits) by (replace b with (a + (x + (y + z))) by lra; ring). lra.
Qed.
End Off.

Section Named.
Context {names : naming}.

(** ** What is asked for: the nominal coordinates, with the worst errors *)

Fixpoint asked_for (v : list Z) (nominal : list number) (e : number) : list number :=
  match v, nominal with z :: v', a :: nominal' => (if (z <? 0)%Z then Minus a e else Plus a e) :: asked_for v' nominal' e | _, _ => [] end.
Lemma asked_near : forall v nominal e, 0 <= value e -> length v = length nominal -> Forall2 (fun a r => Rabs (r - a) <= value e) (map value nominal) (map value (asked_for v nominal e)).
Proof.
  induction v as [| z v IH]; intros [| a nominal] e h l; try discriminate; cbn [asked_for map]; constructor; [| apply IH; [exact h | cbn in l; congruence]].
  destruct (z <? 0)%Z; cbn [value]; [replace (value a - value e - value a) with (- value e) by ring; rewrite Rabs_Ropp | replace (value a + value e - value a) with (value e) by ring]; rewrite Rabs_pos_eq; lra.
Qed.
(** What is zero of each leg, where the coordinate is the one that is asked for, is in any sum. *)
Lemma asked_zero : forall (A : Type) (H : A -> R -> Prop) u (zero : A -> number -> R) (weight : A * number * Z -> R) ls rhos v, is_named rhos = true -> Forall2 H ls (map value rhos) ->
  (forall l r, In l ls -> @value (beside names u) r = value r -> H l (value r) -> zero l r = 0) ->
  fold_right (fun p sum => weight p * zero (fst (fst p)) (snd (fst p)) + sum) 0 (combine (combine ls rhos) v) = 0.
Proof.
  intros A H u zero weight ls. induction ls as [| l ls IH]; intros [| r rhos] [| z v] s h k; try reflexivity; inversion h as [| ? ? ? ? h1 h2]; subst. cbn [combine fold_right fst snd].
  rewrite IH, (k l r); [ring | left; reflexivity | exact (f_equal (hd 0) (named_values names u _ s)) | exact h1 | cbn [is_named forallb] in s; apply andb_true_iff in s; apply s | exact h2 | intros; apply k; [right |..]; assumption].
Qed.

(** Not less than it. *)
Definition above (x : option fixed) : option Q := option_map (fun a => hi a # 2 ^ few_bits) x.
Lemma above_sound : forall a x q, above a = Some q -> (forall b, a = Some b -> Fixed.contains few_bits b x) -> x <= Q2R q.
Proof.
  intros a x q h k. destruct a as [b |]; [| discriminate]. assert (E : q = hi b # 2 ^ few_bits) by (unfold above, option_map in h; congruence). rewrite E. clear h E. destruct (k b eq_refl) as [_ u].
  unfold Q2R. cbn [Qnum Qden]. rewrite Pos2Z.inj_pow. change (IZR (2 ^ Z.pos few_bits)) with (unit_R few_bits). pose proof (unit_R_pos few_bits) as p. apply Rmult_le_reg_r with (unit_R few_bits); [exact p |]. rewrite Rmult_assoc, Rinv_l by lra. lra.
Qed.
Definition off (k : nat) (d : Q) : number := Varying (most_parameters + k) (- d)%Q d.
Lemma off_is : forall n f u k d, is_near_centre n f u -> @value (beside names u) (off k d) = Q2R d * nth k u 0.
Proof. intros n f u k d h. unfold off. cbn [value Claim.along beside]. unfold along_beside. replace (Nat.ltb (most_parameters + k) most_parameters) with false by (symmetry; apply Nat.ltb_ge; lia).
  replace (most_parameters + k - most_parameters)%nat with k by lia. rewrite (part_near n f u k h), Qreals.Q2R_opp. field. Qed.

Definition nmiddle (t : tolerance) : number := if same (least t) (greatest t) then least t else Over (Plus (least t) (greatest t)) (2 // 1).
Definition nmiddles (t : tolerances) : numbers := Numbers (nmiddle (tx t)) (nmiddle (ty t)) (nmiddle (tz t)).
Lemma middle_is : forall t, value (nmiddle t) = middle t.
Proof.
  intro t. unfold nmiddle, middle. destruct (same _ _) eqn:e; [apply same_sound in e; rewrite <- e; field |]. cbn [value]. unfold Rdiv. rewrite Rinv_1, Rmult_1_r. reflexivity.
Qed.
Lemma middles_are : forall t, values (nmiddles t) = middles t.
Proof. intro t. unfold nmiddles, values, middles. cbn [nx ny nz]. rewrite !middle_is. reflexivity. Qed.

(** ** Legs that do not turn the platform *)

Definition nominal_exact (d : drive) : exact_leg :=
  match d with
  | SliderLeg c => ExactSlider (nmiddles (direction c)) (nmiddles (anchor c)) (nmiddles (Claim.platform c)) (nmiddle (Claim.length c)) (mode c)
  | StrutLeg a p k => ExactStrut (nmiddles a) (nmiddles p) (option_map nmiddles k)
  | PlanarLeg n => ExactPlanar (nmiddles n)
  end.
Lemma nominal_is : forall d, leg_of (nominal_exact d) = nominal_leg d.
Proof. intros [c | a p [k |] | n]; cbn [nominal_exact leg_of nominal_leg option_map]; rewrite ?middles_are, ?middle_is; reflexivity. Qed.

Definition refute_far (c : claim) (ls : list exact_leg) (P : numbers) (i : nat) (v : list Z) : bool :=
  admits bits c ls P && is_named (in_numbers P) &&
  match nth_error (require c) i with
  | Some (Accuracy e b) => match above (enclose few_bits b) with
      | Some d => let U := Numbers (off 0 d) (off 1 d) (off 2 d) in
          certainly bits true b && certainly bits false e && Nat.eqb (length v) (length (legs c)) && forallb (fun l => is_named (leg_numbers l)) ls &&
          let rhos := asked_for v (map (fun d => njoint (nominal_exact d) P) (legs c)) e in is_named rhos &&
          stays_below 3 3 (whole_form P U (combine (combine ls rhos) v))
      | None => false
      end
  | _ => false
  end.

Theorem refute_far_sound : forall c ls P i v, refute_far c ls P i v = true -> exists m P, is_about c m P /\ ~ Statement.meets c m P.
Proof.
  intros c ls P i v h. unfold refute_far in h. apply andb_true_iff in h as [h rest]. apply andb_true_iff in h as [about place]. exists (map leg_of ls), (values P). pose proof (admits_sound bits c ls P about) as is_about_it. split; [exact is_about_it |].
  intros [_ [_ met]]. destruct (nth_error (require c) i) as [r |] eqn:er; [| discriminate]. destruct r; try discriminate. rewrite Forall_forall in met. specialize (met _ (nth_error_In _ _ er)). cbn [Statement.fulfils] in met.
  destruct (above (enclose few_bits b)) as [d |] eqn:ed; [| discriminate]. cbv zeta in rest. set (U := Numbers _ _ _) in *.
  apply andb_true_iff in rest as [rest far]. apply andb_true_iff in far as [same far]. apply andb_true_iff in rest as [rest steady]. apply andb_true_iff in rest as [rest l2]. apply andb_true_iff in rest as [b0 e0].
  apply Nat.eqb_eq in l2. apply (positive_sound bits) in b0. apply (nonneg_sound bits) in e0. rewrite forallb_forall in steady.
  pose proof (above_sound _ (value b) d ed ltac:(intros q hq; apply enclose_sound, hq)) as bd.
  set (nominal := map (fun d => njoint (nominal_exact d) P) (legs c)) in *.
  assert (EN : map value nominal = map (fun d => joint (nominal_leg d) (values P)) (legs c)) by (unfold nominal; rewrite map_map; apply map_ext; intro q; rewrite value_joint, nominal_is; reflexivity).
  set (rhos := asked_for v nominal error) in *. destruct (met (map value rhos)) as [P' [[near is_at] _]].
  { pose proof (asked_near v nominal error e0 ltac:(unfold nominal; rewrite map_length; exact l2)) as A. fold rhos in A. rewrite EN in A. clear - A. revert A. generalize (map value rhos).
    induction (legs c) as [| q l IH]; intros s A; inversion A; subst; constructor; auto. }
  set (u := coordinates (vscale (/ Q2R d) (vsub P' (values P)))).
  assert (N : is_near_centre 3 3 u).
  { split; [reflexivity |]. cbn [u coordinates firstn skipn]. split; [| unfold Twofold.size; cbn [Linear.dot]; rewrite sqrt_0; lra]. apply Twofold.size_below; [lra |].
    apply Rle_trans with (norm2 (vscale (/ Q2R d) (vsub P' (values P)))); [right; unfold norm2; cbn [Linear.dot vscale vx vy vz]; ring |]. rewrite norm2_scale.
    assert (I : 0 < / Q2R d) by (apply Rinv_0_lt_compat; lra). apply Rle_trans with ((/ Q2R d) ^ 2 * Q2R d ^ 2); [apply Rmult_le_compat_l; [apply pow2_ge_0 |]; nra | right; field; lra]. }
  assert (XU : vadd (@values (beside names u) P) (@values (beside names u) U) = P').
  { rewrite (numbers_agree _ _ (named_agrees names u _ place)). unfold U. unfold values at 2. cbn [nx ny nz]. rewrite !(off_is 3 3 u _ d N). cbn [u coordinates nth vscale vx vy vz].
    destruct P' as [x y z]. destruct (values P) as [p q r]. unfold vadd, vsub. cbn [vx vy vz]. f_equal; field; lra. }
  pose proof (stays_below_sound 3 3 names _ u far N) as below. rewrite (@whole_form_is (beside names u)) in below. destruct is_about_it as [_ [formed _]]. rewrite Forall_map, Forall_forall in formed.
  pose proof (asked_zero _ (fun l r => reaches P' (leg_of l) /\ joint (leg_of l) P' = r) u (fun l r => @form_value (beside names u) (form_of P l r) (@values (beside names u) U)) (fun q => @value (beside names u) (weight_of P q)) ls rhos v same) as none.
  rewrite none in below; [lra | |].
  - clear - is_at. revert is_at. generalize (map value rhos). induction ls as [| l ls IH]; intros s h; inversion h; subst; constructor; auto.
  - intros l r il es [re ej]. apply (@form_zero (beside names u)); rewrite ?XU, (leg_agrees l _ (named_agrees names u _ (steady l il))); [exact (formed l il) | exact re | rewrite es; exact ej].
Qed.

(** ** Levers, of which some would not close *)

Definition closes (q : lever) (U : vec) (S : mat) : Prop := norm2 (vadd (vadd (values (D_of q)) U) (mulv S (values (r_of q)))) = value (length_of q) ^ 2.
Definition is_named_lever (q : lever) : bool := is_named (in_numbers (D_of q)) && is_named (in_numbers (r_of q)) && is_named [length_of q].

Definition offs (k : motion) (d tau : Q) : list number := map (fun i => off i (if Nat.ltb i (first_angle k) then d else tau)) (seq 0 (dimension k)).
Definition first_turn (k : mobility) : nat := match k with Turns k => first_angle k | _ => freedom k end.
(** By so much a pose is off: the platform's place, and half tangents along its axis. *)
Definition moved_by (k : mobility) (d tau : Q) : numbers * numbers :=
  match k with
  | Translates => (Numbers (off 0 d) (off 1 d) (off 2 d), nowhere)
  | TranslatesInPlane => (Numbers (off 0 d) (off 1 d) (0 // 1), nowhere)
  | Turns k => (nshift k (offs k d tau), nspin k (offs k d tau))
  end.
Lemma offs_are : forall k d tau u, is_near_centre (dimension k) (first_angle k) u ->
  @values (beside names u) (nshift k (offs k d tau)) = vscale (Q2R d) (shift_of k u) /\ @values (beside names u) (nspin k (offs k d tau)) = vscale (Q2R tau) (spin_of k u).
Proof.
  intros k d tau u h. assert (O : forall i q, @value (beside names u) (off i q) = Q2R q * nth i u 0) by (intros i q; exact (off_is _ _ u i q h)).
  assert (Z : forall other, @value other (0 // 1) = 0) by (intro; cbn; lra).
  destruct k; cbn [offs dimension first_angle seq map Nat.ltb Nat.leb nshift nspin shift_of spin_of nth]; unfold values, vscale, vzero; cbn [nx ny nz vx vy vz];
    rewrite ?O, ?Z; split; f_equal; ring.
Qed.

Lemma scaled_below : forall x y q, 0 < q -> 0 <= y -> y <= q -> norm2 x <= y ^ 2 -> sqrt (norm2 (vscale (/ q) x)) <= 1.
Proof.
  intros x y q q0 y0 yq hx. rewrite norm2_scale. rewrite <- sqrt_1. apply sqrt_le_1_alt. apply Rle_trans with ((/ q) ^ 2 * q ^ 2); [apply Rmult_le_compat_l; [apply pow2_ge_0 | apply Rle_trans with (1 := hx), pow_incr; lra] | right; field; lra].
Qed.
Lemma scaled_back : forall q x, 0 < q -> vscale q (vscale (/ q) x) = x.
Proof. intros q [x1 x2 x3] q0. unfold vscale. cbn [vx vy vz]. f_equal; field; lra. Qed.

Lemma identity_mulm : forall Q, mulm midentity Q = Q.
Proof. intro Q. unfold_vec. f_equal; f_equal; ring. Qed.

Lemma size_of_vector : forall w, Twofold.size [vx w; vy w; vz w] = sqrt (norm2 w).
Proof. intro w. unfold Twofold.size, norm2. cbn. f_equal. ring. Qed.
Lemma size_flat : forall w, vz w = 0 -> Twofold.size [vx w; vy w] = sqrt (norm2 w).
Proof. intros w h. unfold Twofold.size, norm2. cbn. rewrite h. f_equal. ring. Qed.

(** A pose near another one is off by some [u]. *)
Lemma is_moved : forall k b angle d tau P Q P' Q', 0 < value b <= Q2R d ->
  match k with Turns _ => 0 < value angle /\ is_angle (value angle) /\ 0 < Q2R tau /\ tangent (value angle) <= Q2R tau | _ => True end -> is_near_to k b angle P Q P' Q' ->
  exists u y S, is_near_centre (freedom k) (first_turn k) u /\ Q' = mulm S Q /\ rodrigues y = mscale (1 + norm2 y) S /\ (forall v, norm2 (mulv S v) = norm2 v) /\
    @values (beside names u) (fst (moved_by k d tau)) = vsub P' P /\ @values (beside names u) (snd (moved_by k d tau)) = y.
Proof.
  intros k b angle d tau P Q P' Q' [b0 bd] turn near. assert (d0 : 0 < Q2R d) by lra.
  assert (Z : forall other, @value other (0 // 1) = 0) by (intro; cbn; lra). assert (N : forall other, @values other nowhere = vzero) by (intro; apply nowhere_is).
  assert (I : rodrigues vzero = mscale (1 + norm2 vzero) midentity) by (unfold rodrigues, mscale, vscale, norm2, midentity, vzero; cbn; f_equal; f_equal; ring).
  destruct k as [| | k]; cbn [is_near_to freedom first_turn moved_by fst snd] in *.
  - destruct near as [near ->]. set (w := vscale (/ Q2R d) (vsub P' P)).
    assert (C : is_near_centre 3 3 [vx w; vy w; vz w]).
    { split; [reflexivity |]. cbn [firstn skipn]. split; [| unfold Twofold.size; cbn [Linear.dot]; rewrite sqrt_0; lra].
      rewrite size_of_vector. exact (scaled_below _ _ _ d0 (Rlt_le _ _ b0) bd near). }
    exists [vx w; vy w; vz w], vzero, midentity. split; [exact C |]. split; [symmetry; apply identity_mulm |].
    split; [exact I |]. split; [intro; rewrite mulv_identity; reflexivity |]. split; [| apply N]. unfold values at 1. cbn [nx ny nz]. rewrite !(off_is 3 3 _ _ d C). cbn [nth].
    transitivity (vscale (Q2R d) w); [reflexivity | apply scaled_back, d0].
  - destruct near as [flat [near ->]]. set (w := vscale (/ Q2R d) (vsub P' P)). assert (wz : vz w = 0) by (unfold w, vscale, vsub; cbn [vz]; rewrite flat; ring).
    assert (C : is_near_centre 2 2 [vx w; vy w]).
    { split; [reflexivity |]. cbn [firstn skipn]. split; [| unfold Twofold.size; cbn [Linear.dot]; rewrite sqrt_0; lra].
      rewrite (size_flat w wz). exact (scaled_below _ _ _ d0 (Rlt_le _ _ b0) bd near). }
    exists [vx w; vy w], vzero, midentity. split; [exact C |]. split; [symmetry; apply identity_mulm |].
    split; [exact I |]. split; [intro; rewrite mulv_identity; reflexivity |]. split; [| apply N]. unfold values at 1. cbn [nx ny nz]. rewrite !(off_is 2 2 _ _ d C), Z. cbn [nth].
    transitivity (Vec (Q2R d * vx w) (Q2R d * vy w) (Q2R d * vz w)); [rewrite wz, Rmult_0_r; reflexivity | exact (scaled_back _ _ d0)].
  - destruct turn as [a0 [ia [t0 ad]]]. pose proof (tangent_nonneg _ (Rlt_le _ _ a0) ia) as tn. destruct near as [own [near [S [hS ->]]]].
    destruct (turned_coordinates _ _ _ a0 ia hS) as [y [may [hy small]]].
    destruct (parts_exist k (vscale (/ Q2R d) (vsub P' P)) (vscale (/ Q2R tau) y)) as [u [lu [su tu]]].
    { clear - own. destruct k; cbn [is_of] in *; [destruct own as [z _]; cbn [vscale vz vx vy vzero]; rewrite z; repeat split; ring | exact I | rewrite own; unfold vscale, vzero; cbn; f_equal; ring]. }
    { clear - may. destruct k; cbn [may_turn] in *; try exact I. destruct may as [e1 e2]. cbn [vscale vx vy]. rewrite e1, e2. split; ring. }
    assert (C : is_near_centre (dimension k) (first_angle k) u).
    { destruct (parts_sizes k u lu) as [s1 s2]. cbn [Twofold.part] in s1, s2. split; [exact lu |]. rewrite s1, s2, su, tu. split; [exact (scaled_below _ (value b) _ d0 (Rlt_le _ _ b0) bd near) | exact (scaled_below _ _ _ t0 tn ad small)]. }
    destruct (offs_are k d tau u C) as [O1 O2]. rewrite su, scaled_back in O1 by exact d0. rewrite tu, scaled_back in O2 by exact t0.
    exists u, y, S. split; [exact C |]. split; [reflexivity |]. split; [exact hy |]. split; [exact (orientation_keeps _ _ hS) |]. split; [exact O1 | exact O2].
Qed.

(** Near no pose all of these close. *)
Definition some_open (k : mobility) (b angle : number) (l : list lever) : bool :=
  match above (enclose few_bits b), match k with Turns _ => above (enclose_tangent few_bits angle) | _ => Some 1%Q end with
  | Some d, Some tau => certainly bits true b && match k with Turns _ => certainly bits true angle && is_angle_number bits angle && negb (Qle_bool tau 0) | _ => true end &&
      forallb is_named_lever l && stays_below (freedom k) (first_turn k) (whole_pose (fst (moved_by k d tau)) (snd (moved_by k d tau)) l)
  | _, _ => false
  end.
Lemma some_open_sound : forall k b angle l P Q P' Q', some_open k b angle l = true -> is_near_to k b angle P Q P' Q' ->
  exists S, Q' = mulm S Q /\ ~ Forall (fun q => closes q (vsub P' P) S) l.
Proof.
  intros k b angle l P Q P' Q' h near. unfold some_open in h. destruct (above (enclose few_bits b)) as [d |] eqn:ed; [| discriminate].
  set (tangent_of := match k with Turns _ => _ | _ => _ end) in h. destruct tangent_of as [tau |] eqn:et; [| discriminate]. unfold tangent_of in et. clear tangent_of.
  apply andb_true_iff in h as [h far]. apply andb_true_iff in h as [h steady]. apply andb_true_iff in h as [b0 turn]. apply (positive_sound bits) in b0. rewrite forallb_forall in steady.
  pose proof (above_sound _ (value b) d ed ltac:(intros q hq; apply enclose_sound, hq)) as bd.
  destruct (is_moved k b angle d tau P Q P' Q') as [u [y [S [C [eQ [hy [keeps [O1 O2]]]]]]]]; [split; assumption | | exact near |].
  { destruct k as [| | k]; try exact I. apply andb_true_iff in turn as [turn tau0]. apply andb_true_iff in turn as [a0 ia]. apply (positive_sound bits) in a0. apply (is_angle_number_sound bits) in ia.
    split; [exact a0 |]. split; [exact ia |]. split; [| exact (above_sound _ (tangent (value angle)) tau et ltac:(intros q hq; exact (enclose_tangent_sound few_bits _ _ hq ia)))].
    apply Rnot_le_lt. intro n. apply negb_true_iff in tau0. assert (Qle_bool tau 0 = true) by (apply Qle_bool_iff, Qreals.Rle_Qle; unfold Q2R at 2; cbn; lra). congruence. }
  exists S. split; [exact eQ |]. intro all. pose proof (stays_below_sound _ _ names _ u far C) as below.
  rewrite (@whole_pose_is (beside names u) _ _ _ S) in below; [| rewrite O2; symmetry; exact (along_axis_is y S hy) | | exact keeps].
  - rewrite O1 in below. assert (none : fold_right (fun q sum => @value (beside names u) (weight q) * (norm2 (vadd (vadd (@values (beside names u) (D_of q)) (vsub P' P)) (mulv S (@values (beside names u) (r_of q)))) - @value (beside names u) (length_of q) ^ 2) + sum) 0 l = 0).
    { clear - all steady. induction all as [| q l hq hl IH]; cbn [fold_right]; [reflexivity |]. rewrite IH by (intros z i; apply steady; right; exact i).
      specialize (steady q (or_introl eq_refl)). apply andb_true_iff in steady as [steady s3]. apply andb_true_iff in steady as [s1 s2].
      rewrite (numbers_agree _ _ (named_agrees names u _ s1)), (numbers_agree _ _ (named_agrees names u _ s2)). pose proof (f_equal (hd 0) (named_values names u _ s3)) as E. cbn [map hd] in E. rewrite E, hq. ring. }
    lra.
  - intro v. set (w := snd (moved_by k d tau)) in *. transitivity (mulv (along_axis (@values (beside names u) w)) (@values (beside names u) v)).
    + destruct w as [w1 w2 w3]. exact (@values_turned (beside names u) (TurnedUpTo (0 // 1)) [w1; w2; w3] v).
    + rewrite O2, (along_axis_is y S hy). reflexivity.
Qed.

(** ** Struts of platforms that turn *)

Definition strut_number (w : numbers) : number := Root (product w w).
Definition nominal_exact_strut (t : tolerances * tolerances) : exact_strut := StrutNumbers (nmiddles (fst t)) (nmiddles (snd t)).
Lemma nominal_struts_are : forall ts, map strut_of (map nominal_exact_strut ts) = nominal_struts ts.
Proof. intro ts. unfold nominal_struts. rewrite map_map. apply map_ext. intro t. unfold nominal_exact_strut, strut_of. cbn [xbase xjoint]. rewrite !middles_are. reflexivity. Qed.

Definition lever_of (o : orientations) (t : list number) (P : numbers) (q : exact_strut * number * Z) : lever :=
  let '(l, r, v) := q in Lever (rounded (Over (v // 1) (Plus r (strut_number (xvector o t P l))))) r (each2 Minus P (xbase l)) (turn o t (xjoint l)).

Definition refute_far_pose (c : turning_claim) (ls : list exact_strut) (P : numbers) (t : list number) (test : nat) (v : list Z) : bool :=
  let k := motion_of c in let o := turned c in
  is_about_exactly bits c ls P t &&
  match test_at bits (match k with AboutPoint => 1 | _ => 2 end) test (turning_demands c) with
  | Some (OnePose e b angle, _) => certainly bits false e && Nat.eqb (length v) (length (struts c)) &&
      some_open (Turns k) b angle (map (lever_of o t P) (combine (combine ls (asked_for v (map (fun q => strut_number (xvector o t P (nominal_exact_strut q))) (struts c)) e)) v))
  | _ => false
  end.

Theorem refute_far_pose_sound : forall c ls P t test v, refute_far_pose c ls P t test v = true ->
  exists m P Q, is_about_struts c m P Q /\ ~ meets_turning c m P Q.
Proof.
  intros c ls P t test v h. unfold refute_far_pose in h. cbv zeta in h. set (k := motion_of c) in *. set (o := turned c) in *.
  apply andb_true_iff in h as [h rest]. destruct (is_about_exactly_sound bits _ _ _ _ h) as [Q [about turnQ]]. fold o in turnQ. exists (map strut_of ls), (values P), Q. split; [exact about |].
  intros [_ [_ met]]. destruct (test_at _ _ _ _) as [[q which] |] eqn:e; [| discriminate]. destruct q; try discriminate. apply test_at_in in e. rewrite Forall_forall in met. specialize (met _ e).
  apply andb_true_iff in rest as [rest far]. apply andb_true_iff in rest as [e0 l2]. apply Nat.eqb_eq in l2. apply (nonneg_sound bits) in e0.
  cbn [Configuration.fulfils struts_at recovers] in met. rewrite <- nominal_struts_are in met.
  set (nominal := map (fun q => strut_number (xvector o t P (nominal_exact_strut q))) (struts c)) in *.
  assert (Own : forall l, value (strut_number (xvector o t P l)) = strut_length (strut_of l) (values P) Q).
  { intro l. unfold strut_number. cbn [value]. rewrite value_square, (values_xvector o t Q turnQ). reflexivity. }
  assert (EN : map value nominal = map (fun l => strut_length l (values P) Q) (map strut_of (map nominal_exact_strut (struts c)))).
  { unfold nominal. rewrite !map_map. apply map_ext. intro q. apply Own. }
  set (rhos := asked_for v nominal error) in *. destruct (met (map value rhos)) as [P' [Q' [[near is_at] _]]].
  { pose proof (asked_near v nominal error e0 ltac:(unfold nominal; rewrite map_length; exact l2)) as A. fold rhos in A. rewrite EN in A. clear - A. revert A. generalize (map value rhos).
    induction (map strut_of (map nominal_exact_strut (struts c))) as [| q l IH]; intros s A; inversion A; subst; constructor; auto. }
  destruct (some_open_sound (Turns k) b angle _ (values P) Q P' Q' far near) as [S [eQ none]]. apply none. rewrite eQ in is_at. clearbody rhos. clear - is_at turnQ. revert rhos is_at v.
  induction ls as [| l ls IH]; intros [| r rhos] is_at [| z v]; cbn [combine map]; try constructor; inversion is_at as [| ? ? ? ? [_ h1] h2]; subst; [| exact (IH rhos h2 v)].
  unfold closes, lever_of. cbn [D_of r_of length_of]. rewrite values_minus, turnQ, <- h1. unfold strut_length.
  replace (sqrt _ ^ 2) with (norm2 (strut_vector (strut_of l) P' (mulm S Q))) by (rewrite <- Rsqr_pow2; symmetry; apply Rsqr_sqrt, norm2_nonneg). f_equal.
  unfold strut_vector, arm_of_joint. cbn [strut_of strut_base strut_joint]. rewrite mulv_mulm. generalize (mulv S (mulv Q (values (xjoint l)))) (values (xbase l)) (values P).
  clear. intros [z1 z2 z3] [a1 a2 a3] [x1 x2 x3]. destruct P' as [y1 y2 y3]. unfold vadd, vsub. cbn [vx vy vz]. f_equal; ring.
Qed.

(** ** Legs in any motion *)

Definition nominal_exact_driven (d : any_drive) : exact_driven :=
  match d with
  | LinearDrive d => XLinear (nominal_exact d)
  | RotaryDrive d => XRotary (ExactArm (nmiddles (axis_within d)) (nmiddles (reference_within d)) (nmiddles (anchor_within d)) (nmiddles (platform_within d)) (nmiddle (arm_within d)) (nmiddle (rod_within d)) (is_positive_mode d))
  end.
Lemma nominal_driven_is : forall d, driven_of (nominal_exact_driven d) = nominal_driven d.
Proof.
  intros [d | d]; cbn [nominal_exact_driven driven_of nominal_driven]; [rewrite nominal_is; reflexivity |]. unfold arm_of. rewrite values_xpart. cbn [xaxis xreference xanchor xplatform xarm xrod xmode].
  rewrite !middles_are, !middle_is. reflexivity.
Qed.

(** An angle is off by the one with this tangent of its half, which is not more than the error. *)
Definition below (x : option fixed) : Q := match x with Some a => Z.max 0 (lo a) # 2 ^ few_bits | None => 0 end.
Lemma below_sound : forall e, 0 <= value e -> is_angle (value e) -> 0 <= Q2R (below (enclose_tangent few_bits e)) <= tangent (value e).
Proof.
  intros e e0 ie. pose proof (tangent_nonneg _ e0 ie) as t0. unfold below. destruct (enclose_tangent few_bits e) as [a |] eqn:h; [| unfold Q2R; cbn; lra].
  destruct (enclose_tangent_sound few_bits _ _ h ie) as [l _]. unfold Q2R. cbn [Qnum Qden]. rewrite Pos2Z.inj_pow. change (IZR (2 ^ Z.pos few_bits)) with (unit_R few_bits). pose proof (unit_R_pos few_bits) as p.
  assert (M : 0 <= IZR (Z.max 0 (lo a)) <= tangent (value e) * unit_R few_bits).
  { split; [apply IZR_le; lia |]. destruct (Z.max_spec 0 (lo a)) as [[_ ->] | [_ ->]]; [exact l | apply Rmult_le_pos; lra]. }
  split; apply Rmult_le_reg_r with (unit_R few_bits); try exact p; rewrite Rmult_assoc, Rinv_l by lra; lra.
Qed.
Definition asked (e : number) (h : Q) (z : Z) (x : ncoordinate) : ncoordinate :=
  match x with
  | NLength a => NLength (if (z <? 0)%Z then Minus a e else Plus a e)
  | NAngle c s => let t := of_Q (if (z <? 0)%Z then - h else h) in NAngle (Minus (Times c (tcosine t)) (Times s (tsine t))) (Plus (Times s (tcosine t)) (Times c (tsine t)))
  | NUnknown => NUnknown
  end.
Definition is_given (x : ncoordinate) : bool := match x with NUnknown => false | _ => true end.
Lemma asked_off : forall e h z x, 0 <= value e -> (forall c s, x = NAngle c s -> is_angle (value e) /\ 0 <= Q2R h <= tangent (value e)) -> is_given x = true -> is_off (value e) (coordinate_of x) (coordinate_of (asked e h z x)).
Proof.
  intros e h z [a | c s |] e0 ang given; [| | discriminate]; cbn [asked coordinate_of is_off].
  - destruct (z <? 0)%Z; cbn [value]; [replace (value a - value e - value a) with (- value e) by ring; rewrite Rabs_Ropp | replace (value a + value e - value a) with (value e) by ring]; rewrite Rabs_pos_eq; lra.
  - destruct (ang c s eq_refl) as [ie hh]. destruct (half_tangent_up_to (Q2R h) (value e) e0 ie hh) as [d [hd td]].
    assert (D : exists d', Rabs d' <= value e /\ is_half_tangent (@value names (of_Q (if (z <? 0)%Z then - h else h))) d').
    { rewrite of_Q_value. destruct (z <? 0)%Z; [exists (- d); rewrite Rabs_Ropp | exists d]; (split; [rewrite Rabs_pos_eq; lra |]); [| exact td].
      rewrite Qreals.Q2R_opp. destruct td as [tc ts]. unfold is_half_tangent. replace (in_degrees (- d)) with (- in_degrees d) by (unfold in_degrees; field). rewrite cos_neg, sin_neg, tc, ts.
      assert (0 < 1 + Q2R h ^ 2) by (pose proof (pow2_ge_0 (Q2R h)); lra). split; field; nra. }
    destruct D as [d' [le t]]. exists d'. split; [exact le |]. cbn [value]. rewrite (value_tcosine _ _ t), (value_tsine _ _ t). split; reflexivity.
Qed.

(** An angle that is nearly the one that is asked for, by a rational tangent of its half: of [c] and [s], elbows would have dozens. *)
Definition settled (e : number) (h : Q) (z : Z) (x : ncoordinate) : ncoordinate :=
  match x, asked e (h * (1 - (1 # 2 ^ 40)))%Q z x with
  | NAngle c s, NAngle c' s' =>
      let t := rounded (Over s' (Plus (1 // 1) c')) in let C := Plus (Times c (tcosine t)) (Times s (tsine t)) in let S := Minus (Times c (tsine t)) (Times s (tcosine t)) in
      let most := Times (of_Q h) (Plus (1 // 1) C) in
      if certainly bits true (Plus (1 // 1) C) && certainly bits false (Minus most S) && certainly bits false (Plus most S) then NAngle (tcosine t) (tsine t) else asked e h z x
  | _, _ => asked e h z x
  end.
Lemma settled_off : forall e h z x, 0 <= value e -> (forall c s, x = NAngle c s -> is_angle (value e) /\ 0 <= Q2R h <= tangent (value e) /\ value c ^ 2 + value s ^ 2 = 1) -> is_given x = true ->
  is_off (value e) (coordinate_of x) (coordinate_of (settled e h z x)).
Proof.
  intros e h z x e0 ang given. assert (A : is_off (value e) (coordinate_of x) (coordinate_of (asked e h z x))).
  { apply asked_off; [exact e0 | | exact given]. intros c s k. destruct (ang c s k) as [h1 [h2 _]]. split; assumption. }
  unfold settled. destruct x as [a | c s |]; try exact A. destruct (asked e (h * (1 - (1 # 2 ^ 40))) z (NAngle c s)) as [| c' s' |]; try exact A. cbv zeta.
  set (t := rounded _). set (C := Plus (Times c (tcosine t)) (Times s (tsine t))). set (S := Minus (Times c (tsine t)) (Times s (tcosine t))). assert (E : value (of_Q h) = Q2R h) by apply of_Q_value. revert E. generalize (of_Q h). intros most E. destruct (_ && _) eqn:k; [| exact A]. clear A. destruct (ang c s eq_refl) as [ie [hh one]].
  apply andb_true_iff in k as [k k3]. apply andb_true_iff in k as [k1 k2]. apply (positive_sound bits) in k1. apply (nonneg_sound bits) in k2, k3. cbn [value] in k1, k2, k3. rewrite E in k2, k3. clear E most.
  assert (U : value (tcosine t) ^ 2 + value (tsine t) ^ 2 = 1) by (unfold tcosine, tsine; cbn [value]; field; pose proof (pow2_ge_0 (value t)); nra).
  assert (EC : value C = value c * value (tcosine t) + value s * value (tsine t)) by reflexivity. assert (ES : value S = value c * value (tsine t) - value s * value (tcosine t)) by reflexivity.
  generalize dependent (value C). generalize dependent (value S). clear C S. intros S ES C k1 k2 k3 EC. replace (1 / 1) with 1 in * by field.
  cbn [coordinate_of is_off]. generalize dependent (value (tcosine t)). generalize dependent (value (tsine t)). clear t. intros q p U ES' EC'.
  assert (CS : C ^ 2 + S ^ 2 = 1) by (rewrite EC', ES'; replace ((value c * p + value s * q) ^ 2 + (value c * q - value s * p) ^ 2) with ((value c ^ 2 + value s ^ 2) * (p ^ 2 + q ^ 2)) by ring; rewrite one, U; ring).
  set (w := S / (1 + C)). assert (W : S = w * (1 + C)) by (unfold w; field; lra). assert (Two : (1 + w ^ 2) * (1 + C) = 2) by (apply Rmult_eq_reg_r with (1 + C); [| lra]; replace ((1 + w ^ 2) * (1 + C) * (1 + C)) with ((1 + C) ^ 2 + (w * (1 + C)) ^ 2) by ring; rewrite <- W; lra).
  assert (B : exists d, Rabs d <= value e /\ is_half_tangent w d).
  { destruct (Rle_dec 0 w) as [w0 | w0].
    - destruct (half_tangent_up_to w (value e) e0 ie) as [d [hd td]]; [split; [exact w0 | apply Rmult_le_reg_r with (1 + C); [lra | rewrite <- W; nra]] |]. exists d. split; [rewrite Rabs_pos_eq; lra | exact td].
    - destruct (half_tangent_up_to (- w) (value e) e0 ie) as [d [hd [tc ts]]]; [split; [lra | apply Rmult_le_reg_r with (1 + C); [lra | nra]] |]. exists (- d). split; [rewrite Rabs_Ropp, Rabs_pos_eq; lra |].
      unfold is_half_tangent. replace (in_degrees (- d)) with (- in_degrees d) by (unfold in_degrees; field). rewrite cos_neg, sin_neg, tc, ts. pose proof (pow2_ge_0 w). split; field; nra. }
  destruct B as [d [hd [tc ts]]]. assert (w2 : 0 < 1 + w ^ 2) by (pose proof (pow2_ge_0 w); lra).
  assert (Ec : cos (in_degrees d) = C) by (rewrite tc; apply Rmult_eq_reg_r with (1 + w ^ 2); [| lra]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
  assert (Es : sin (in_degrees d) = S) by (rewrite ts, W; apply Rmult_eq_reg_r with (1 + w ^ 2); [| lra]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; nra).
  exists d. split; [exact hd |]. rewrite Ec, Es, EC', ES'. split.
  - replace (value c * (value c * p + value s * q) - value s * (value c * q - value s * p)) with (p * (value c ^ 2 + value s ^ 2)) by ring. rewrite one. ring.
  - replace (value s * (value c * p + value s * q) + value c * (value c * q - value s * p)) with (q * (value c ^ 2 + value s ^ 2)) by ring. rewrite one. ring.
Qed.

(** With its joint coordinate a leg is a lever; the derivative by the coordinate is nearly the weight's over [v]. *)
Definition levers_of (k : mobility) (o : option orientations) (t : list number) (P : numbers) (q : exact_driven * ncoordinate * Z) : list lever :=
  let '(l, x, v) := q in let r := nturn o t (xoffset l) in let C := xcarried o t P l in
  match l, x with
  | XLinear (ExactSlider d a p len m), NLength rho =>
      [Lever (rounded (Over (v // 1) (Plus (signed_root m (clearance2 d a p len C)) (Minus (product (unit_of d) (nspan a p C)) rho)))) len (each2 Minus (each2 Minus P a) (scaled rho (unit_of d))) r]
  | XLinear (ExactStrut a p _ as l), NLength rho => [Lever (rounded (Over (v // 1) (Plus rho (njoint l C)))) rho (each2 Minus P a) r]
  | XRotary i, NAngle c s =>
      let across := Minus (Times c (xacross i C)) (Times s (xalong i C)) in
      [Lever (rounded (Over (v // 1) (Times (xarm i) (Plus (xeta i C) across)))) (xrod i) (each2 Minus P (each2 Plus (xanchor i) (scaled (xarm i) (each2 Plus (scaled c (xzero i)) (scaled s (xquarter i)))))) r]
  | _, _ => []
  end.
Lemma levers_close : forall k o t P Q l x v P' S, (forall b, values (nturn o t b) = mulv Q (values b)) -> well_formed_driven (driven_of l) ->
  own_reach (driven_of l) (carried (driven_of l) P' (mulm S Q)) -> own_joint (driven_of l) (carried (driven_of l) P' (mulm S Q)) = coordinate_of x ->
  Forall (fun q => closes q (vsub P' (values P)) S) (levers_of k o t P (l, x, v)).
Proof.
  intros k o t P Q l x v P' S turnQ ok re e. unfold levers_of.
  destruct l as [[d a p len m | a p b | d] | i], x as [rho | c s |]; try (constructor; fail); (constructor; [| constructor]); unfold closes; cbn [D_of r_of length_of driven_of own_reach own_joint well_formed_driven coordinate_of xoffset] in *; rewrite turnQ.
  - pose proof (leg_vector_length _ _ ok re) as L. assert (J : joint (leg_of (ExactSlider d a p len m)) (carried (Linear (leg_of (ExactSlider d a p len m))) P' (mulm S Q)) = value rho) by congruence.
    cbn [leg_of joint] in J. unfold leg_vector, C_point, B_point, A_point in L. cbn [leg_of axis base_point platform_offset leg_length] in L. rewrite J in L. rewrite <- L. unfold carried. cbn [leg_of offset platform_offset].
    rewrite !values_minus, values_scaled, values_unit, mulv_mulm. generalize (normalised (values d)) (values P) (values a) (values p) (value rho) (mulv S (mulv Q (values p))). clear. intros [n1 n2 n3] [x1 x2 x3] [a1 a2 a3] [p1 p2 p3] q [r1 r2 r3]. destruct P' as [y1 y2 y3].
    unfold norm2, Vec3.dot, vadd, vsub, vscale. cbn [vx vy vz]. ring.
  - assert (J : joint (leg_of (ExactStrut a p b)) (carried (Linear (leg_of (ExactStrut a p b))) P' (mulm S Q)) = value rho) by congruence. cbn [leg_of joint] in J. rewrite <- J.
    replace (sqrt _ ^ 2) with (norm2 (span (values a) (values p) (carried (Linear (leg_of (ExactStrut a p b))) P' (mulm S Q)))) by (rewrite <- Rsqr_pow2; symmetry; apply Rsqr_sqrt, norm2_nonneg). f_equal.
    unfold span, carried. cbn [leg_of offset]. rewrite values_minus, mulv_mulm. generalize (values P) (values a) (values p) (mulv S (mulv Q (values p))). clear. intros [x1 x2 x3] [a1 a2 a3] [p1 p2 p3] [r1 r2 r3]. destruct P' as [y1 y2 y3].
    unfold vadd, vsub. cbn [vx vy vz]. f_equal; ring.
  - destruct (rod_closes _ _ ok re) as [L _]. unfold Arm.rod, elbow in L. injection e as ec es. rewrite ec, es in L. cbn [arm_of rod_length arm_length motor arm_offset] in L. rewrite <- L. f_equal.
    rewrite !values_minus, values_plus, values_scaled, values_plus, !values_scaled, values_xzero, values_xquarter. unfold carried. cbn [offset arm_of arm_offset]. rewrite mulv_mulm.
    generalize (values P) (vadd (values (xanchor i)) (vscale (value (xarm i)) (vadd (vscale (value c) (motor_zero (arm_of i))) (vscale (value s) (quarter (arm_of i)))))) (values (xplatform i)) (mulv S (mulv Q (values (xplatform i)))).
    clear. intros [x1 x2 x3] [a1 a2 a3] [p1 p2 p3] [r1 r2 r3]. destruct P' as [y1 y2 y3]. unfold vadd, vsub. cbn [vx vy vz]. f_equal; ring.
Qed.

Definition refute_far_driven (c : driven_claim) (ls : list exact_driven) (P : numbers) (t : list number) (test : nat) (v : list Z) : bool :=
  let k := mobility_of c in let o := turned_by c in
  all_exact bits (drives c) ls && is_exact_pose bits c P t &&
  match test_at bits (parts_near k) test (driven_demands c) with
  | Some (OnePose e b angle, _) =>
      let nominal := map (fun d => let l := nominal_exact_driven d in xdriven_joint o t P l) (drives c) in let h := below (enclose_tangent few_bits e) in
      certainly bits false e && forallb (fun d => match nominal_exact_driven d with
        | XRotary i as l => is_angle_number bits e && is_exact_driven bits d l && certainly bits true (xclearance i (xcarried o t P l))
        | _ => true
        end) (drives c) && Nat.eqb (length v) (length (drives c)) &&
      some_open k b angle (flat_map (levers_of k o t P) (combine (combine ls (map (fun p => settled e h (fst p) (snd p)) (combine v nominal))) v))
  | _ => false
  end.

Theorem refute_far_driven_sound : forall c ls P t test v, refute_far_driven c ls P t test v = true ->
  exists m P Q, Forall well_formed_driven m /\ is_about_driven c m P Q /\ ~ meets_driven c m P Q.
Proof.
  intros c ls P t test v h. unfold refute_far_driven in h. cbv zeta in h. set (k := mobility_of c) in *. set (o := turned_by c) in *.
  apply andb_true_iff in h as [h rest]. apply andb_true_iff in h as [h p]. destruct (all_exact_sound bits _ _ h) as [h1 h2].
  destruct (is_exact_pose_sound bits _ _ _ p) as [Q [hQ turnQ]]. fold o in turnQ. exists (map driven_of ls), (values P), Q. split; [exact h2 |]. split; [split; assumption |].
  intros [_ [_ met]]. destruct (test_at _ _ _ _) as [[q which] |] eqn:e; [| discriminate]. destruct q; try discriminate. apply test_at_in in e. rewrite Forall_forall in met. specialize (met _ e).
  apply andb_true_iff in rest as [rest far]. apply andb_true_iff in rest as [rest l2]. apply andb_true_iff in rest as [e0 angles]. apply Nat.eqb_eq in l2. apply (nonneg_sound bits) in e0.
  cbn [Configuration.fulfils legs_at recovers] in met. fold k in met. set (nominal := map _ (drives c)) in *. set (g := below (enclose_tangent few_bits error)) in *.
  set (rhos := map (fun p => settled error g (fst p) (snd p)) (combine v nominal)) in *.
  assert (Own : forall l, own_joint (driven_of l) (carried (driven_of l) (values P) Q) = coordinate_of (xdriven_joint o t P l)).
  { intro l. rewrite <- (values_carried o t P Q turnQ). destruct l as [i | i]; cbn [own_joint driven_of xdriven_joint coordinate_of]; [rewrite value_joint | rewrite value_xcosine, value_xsine]; reflexivity. }
  destruct (met (map coordinate_of rhos)) as [P' [Q' [[near is_at] _]]].
  { rewrite forallb_forall in angles. assert (A : forall x, In x nominal -> forall z, is_off (value error) (coordinate_of x) (coordinate_of (settled error g z x))).
    { intros x ix z. unfold nominal in ix. apply in_map_iff in ix as [d [ed id]]. specialize (angles d id). apply settled_off; [exact e0 | | rewrite <- ed; destruct (nominal_exact_driven d); reflexivity].
      intros q s ex. rewrite ex in ed. clear ex. unfold xdriven_joint in ed. destruct (nominal_exact_driven d) as [| i] eqn:en; [discriminate |]. injection ed as <- <-.
      apply andb_true_iff in angles as [angles reach]. apply andb_true_iff in angles as [ie made]. apply (is_angle_number_sound bits) in ie. apply (positive_sound bits) in reach. rewrite value_xclearance in reach.
      split; [exact ie |]. split; [exact (below_sound error e0 ie) |]. destruct d as [d | d]; [discriminate |]. cbn [is_exact_driven] in made. destruct (is_exact_arm_sound bits _ _ made) as [_ ok].
      rewrite value_xcosine, value_xsine. exact (proj1 (angle_splits _ _ ok reach)). }
    unfold rhos. clear - A l2 Own. unfold nominal in *. clear nominal. revert v l2 A. induction (drives c) as [| d ds IH]; intros [| z v] l2 A; try discriminate; cbn [map combine]; constructor.
    - rewrite <- nominal_driven_is, Own. cbn [fst snd]. apply A. left. reflexivity.
    - apply IH; [cbn in l2; congruence |]. intros x ix. apply A. right. exact ix. }
  destruct (some_open_sound k b angle _ (values P) Q P' Q' far near) as [S [eQ none]]. apply none. rewrite eQ in is_at. clearbody rhos. clear - is_at turnQ h2. revert rhos is_at v.
  induction ls as [| l ls IH]; intros [| r rhos] is_at v; cbn [combine flat_map map] in *; try constructor; inversion is_at as [| ? ? ? ? [r1 r2] r3]; subst. inversion h2 as [| ? ? w1 w2]; subst.
  destruct v as [| z v]; [constructor |]. cbn [combine flat_map]. apply Forall_app. split; [exact (levers_close k o t P Q l r z P' S turnQ w1 r1 r2) | exact (IH w2 rhos r3 v)].
Qed.
End Named.
End Precision.
