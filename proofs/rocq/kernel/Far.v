(** * Refutations of accuracy: joint errors and a machine that has no position, or pose, near enough

    Polynomials h_i in what a pose is off by are zero where it has given joint coordinates.  The sum of them, with
    weights, is one polynomial, whose coefficients are sums: where its slopes tell that it is negative at all u of the
    ball, |u_t| <= 1 and |u_c| <= 1, no pose within the bound has these coordinates: nominal ones with the worst errors. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Number Machine Witness Orientation Turning Configuration Singular Onward Accelerated Same Twins.
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

Definition around (k : nat) (a b : Q) : option Slope.slope := if Nat.ltb k n && Qle_bool a b then Some (Number.coordinate bits k a b) else None.
Definition deviations (u : list R) : list R := map (fun k => 2 * part_at u k - 1) (seq 0 n).
Lemma deviations_within : forall u, Forall (fun t => -1 <= t <= 1) (deviations u).
Proof. intro u. apply Forall_map, Forall_forall. intros k _. pose proof (part_within u k). lra. Qed.
Lemma around_holds : forall u k a b s, around k a b = Some s -> Slope.holds bits (deviations u) s (@value halfway (Varying k a b)) (@value (spot u) (Varying k a b)).
Proof.
  intros u k a b s h. unfold around in h. destruct (Nat.ltb k n) eqn:hk; [| discriminate]. destruct (Qle_bool a b) eqn:le; [| discriminate]. cbn [andb] in h. injection h as <-.
  apply Nat.ltb_lt in hk. apply Qle_bool_iff, Qreals.Qle_Rle in le. pose proof (part_within u k) as W. pose proof (unit_R_pos bits) as p.
  cbn [value Claim.along halfway spot]. split; [| split]; unfold Number.coordinate; cbn [Slope.at_c Slope.range Slope.slopes].
  - replace (Q2R a + 1 / 2 * (Q2R b - Q2R a)) with (Q2R ((a + b) * (1 # 2))); [apply ratio_of_sound |].
    rewrite Qreals.Q2R_mult, Qreals.Q2R_plus. unfold Q2R at 3. cbn. field.
  - pose proof (ratio_of_sound bits a) as [l _]. pose proof (ratio_of_sound bits b) as [_ r].
    assert (Q2R a <= Q2R a + part_at u k * (Q2R b - Q2R a) <= Q2R b) as [g1 g2] by nra.
    apply (Rmult_le_compat_r (unit_R bits)) in g1, g2; try lra. unfold Fixed.contains. cbn [lo hi]. lra.
  - exists (repeat 0 k ++ [Q2R ((b - a) * (1 # 2))]). split.
    + apply Forall2_app; [clear; induction k; cbn; constructor; auto using zero_sound | constructor; [apply ratio_of_sound | constructor]].
    + rewrite Cell.dot_unit. replace (nth k (deviations u) 0) with (2 * part_at u k - 1).
      * rewrite Qreals.Q2R_mult, Qreals.Q2R_minus. replace (Q2R (1 # 2)) with (/ 2) by (unfold Q2R; cbn; lra). lra.
      * unfold deviations. rewrite (nth_indep _ 0 (2 * part_at u 0 - 1)) by (rewrite map_length, seq_length; exact hk).
        rewrite (map_nth (fun k => 2 * part_at u k - 1)), seq_nth by exact hk. reflexivity.
Qed.
Definition is_near_centre (u : list R) : Prop := length u = n /\ Twofold.size (firstn f u) <= 1 /\ Twofold.size (skipn f u) <= 1.
Lemma part_near : forall u k, is_near_centre u -> part_at u k = (1 + nth k u 0) / 2.
Proof.
  intros u k [_ [h1 h2]]. pose proof (Twofold.norm_entry f u k) as e. assert (N : Twofold.norm f u <= 1) by (apply Twofold.norm_below; intros []; assumption).
  pose proof (Rle_abs (nth k u 0)). pose proof (Rle_abs (- nth k u 0)) as a. rewrite Rabs_Ropp in a. unfold part_at. rewrite Rmin_right, Rmax_right; lra.
Qed.
Lemma deviations_are : forall u, is_near_centre u -> deviations u = u.
Proof.
  intros u h. assert (l : length u = n) by apply h. apply Twofold.same_entries; [unfold deviations; rewrite map_length, seq_length; congruence |]. intro k. unfold deviations. destruct (Nat.lt_ge_cases k n) as [hk | hk].
  - rewrite (nth_indep _ 0 (2 * part_at u 0 - 1)) by (rewrite map_length, seq_length; exact hk). rewrite (map_nth (fun k => 2 * part_at u k - 1)), seq_nth by exact hk. cbn [Nat.add]. rewrite (part_near u k h). field.
  - rewrite !nth_overflow; [reflexivity | lia | rewrite map_length, seq_length; exact hk].
Qed.

Definition stays_below (g : number) : bool :=
  match sloped_by bits around g with
  | Some s => (hi (Slope.at_c s) <? - (sqrt_ceil (squares (firstn f (Slope.slopes s))) + sqrt_ceil (squares (skipn f (Slope.slopes s)))))%Z
  | None => false
  end.
Lemma stays_below_sound : forall g u, stays_below g = true -> is_near_centre u -> @value (spot u) g < 0.
Proof.
  intros g u h near. unfold stays_below in h. destruct (sloped_by bits around g) as [s |] eqn:e; [| discriminate]. apply Z.ltb_lt, IZR_lt in h. rewrite opp_IZR, plus_IZR in h.
  destruct (sloped_by_sound bits around (deviations u) halfway (spot u) (deviations_within u) (around_holds u) g s e) as [[_ c] [_ [r [R E]]]].
  rewrite (deviations_are u near), (Twofold.dot_parts f r u) in E. destruct near as [_ [n1 n2]]. pose proof (unit_R_pos bits) as p.
  assert (K : forall a b l, Twofold.size b <= 1 -> Forall2 contains l a -> Linear.dot a b * unit_R bits <= IZR (sqrt_ceil (squares l))).
  { intros a b l nb hl. apply Rle_trans with (2 := size_above l a hl). apply Rmult_le_compat_r; [lra |]. apply Rle_trans with (1 := Twofold.dot_sizes a b).
    pose proof (Twofold.size_nonneg a). rewrite <- (Rmult_1_r (Twofold.size a)) at 2. apply Rmult_le_compat_l; assumption. }
  assert (Parts : forall l a, Forall2 contains l a -> Forall2 contains (firstn f l) (firstn f a) /\ Forall2 contains (skipn f l) (skipn f a)).
  { clear. induction f as [| m IH]; intros l a h; [split; [constructor | exact h] |]. destruct h as [| x y l a hx h]; [split; constructor |]. destruct (IH l a h). cbn [firstn skipn]. split; [constructor; assumption | assumption]. }
  destruct (Parts _ _ R) as [R1 R2]. pose proof (K _ _ _ n1 R1). pose proof (K _ _ _ n2 R2). apply Rmult_lt_reg_r with (unit_R bits); [exact p |].
  set (y := Linear.dot (firstn f r) (firstn f u)) in *. set (z := Linear.dot (skipn f r) (skipn f u)) in *. set (b := @value (spot u) g) in *. set (a := @value halfway g) in *.
  replace (b * unit_R bits) with (a * unit_R bits + y * unit_R bits + z * unit_R bits) by (replace b with (a + (y + z)) by lra; ring). lra.
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
Lemma asked_zero : forall (A : Type) (H : A -> R -> Prop) u (zero : A -> number -> R) (weight : A * number * Z -> R) ls rhos v, is_steady rhos = true -> Forall2 H ls (map value rhos) ->
  (forall l r, In l ls -> @value (spot u) r = value r -> H l (value r) -> zero l r = 0) ->
  fold_right (fun p sum => weight p * zero (fst (fst p)) (snd (fst p)) + sum) 0 (combine (combine ls rhos) v) = 0.
Proof.
  intros A H u zero weight ls. induction ls as [| l ls IH]; intros [| r rhos] [| z v] s h k; try reflexivity; inversion h as [| ? ? ? ? h1 h2]; subst. cbn [combine fold_right fst snd].
  rewrite IH, (k l r); [ring | left; reflexivity | exact (f_equal (hd 0) (steady_values _ s (spot u))) | exact h1 | cbn [is_steady forallb] in s; apply andb_true_iff in s; apply s | exact h2 | intros; apply k; [right |..]; assumption].
Qed.

(** Not less than it. *)
Definition above (x : option fixed) : option Q := option_map (fun a => hi a # 2 ^ few_bits) x.
Lemma above_sound : forall a x q, above a = Some q -> (forall b, a = Some b -> Fixed.contains few_bits b x) -> x <= Q2R q.
Proof.
  intros a x q h k. destruct a as [b |]; [| discriminate]. assert (E : q = hi b # 2 ^ few_bits) by (unfold above, option_map in h; congruence). rewrite E. clear h E. destruct (k b eq_refl) as [_ u].
  unfold Q2R. cbn [Qnum Qden]. rewrite Pos2Z.inj_pow. change (IZR (2 ^ Z.pos few_bits)) with (unit_R few_bits). pose proof (unit_R_pos few_bits) as p. apply Rmult_le_reg_r with (unit_R few_bits); [exact p |]. rewrite Rmult_assoc, Rinv_l by lra. lra.
Qed.
Definition off (k : nat) (d : Q) : number := Varying k (- d)%Q d.
Lemma off_is : forall n f u k d, is_near_centre n f u -> @value (spot u) (off k d) = Q2R d * nth k u 0.
Proof. intros n f u k d h. unfold off. cbn [value Claim.along spot]. rewrite (part_near n f u k h), Qreals.Q2R_opp. field. Qed.

Definition nmiddle (t : tolerance) : number := Over (Plus (least t) (greatest t)) (2 // 1).
Definition nmiddles (t : tolerances) : numbers := Numbers (nmiddle (tx t)) (nmiddle (ty t)) (nmiddle (tz t)).
Lemma middle_is : forall t, value (nmiddle t) = middle t.
Proof. intro t. unfold nmiddle, middle. cbn [value]. unfold Rdiv. rewrite Rinv_1, Rmult_1_r. reflexivity. Qed.
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
  admits bits c ls P && is_steady (in_numbers P) &&
  match nth_error (require c) i with
  | Some (Accuracy e b) => match above (enclose few_bits b) with
      | Some d => let U := Numbers (off 0 d) (off 1 d) (off 2 d) in
          certainly bits true b && certainly bits false e && Nat.eqb (length v) (length (legs c)) && forallb (fun l => is_steady (leg_numbers l)) ls &&
          let rhos := asked_for v (map (fun d => njoint (nominal_exact d) P) (legs c)) e in is_steady rhos &&
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
  assert (XU : vadd (@values (spot u) P) (@values (spot u) U) = P').
  { rewrite (steady_numbers _ place (spot u)). unfold U. unfold values at 2. cbn [nx ny nz]. rewrite !(off_is 3 3 u _ d N). cbn [u coordinates nth vscale vx vy vz].
    destruct P' as [x y z]. destruct (values P) as [p q r]. unfold vadd, vsub. cbn [vx vy vz]. f_equal; field; lra. }
  pose proof (stays_below_sound 3 3 _ u far N) as below. rewrite (@whole_form_is (spot u)) in below. destruct is_about_it as [_ [formed _]]. rewrite Forall_map, Forall_forall in formed.
  pose proof (asked_zero _ (fun l r => reaches P' (leg_of l) /\ joint (leg_of l) P' = r) u (fun l r => @form_value (spot u) (form_of P l r) (@values (spot u) U)) (fun q => @value (spot u) (weight_of P q)) ls rhos v same) as none.
  rewrite none in below; [lra | |].
  - clear - is_at. revert is_at. generalize (map value rhos). induction ls as [| l ls IH]; intros s h; inversion h; subst; constructor; auto.
  - intros l r il es [re ej]. apply (@form_zero (spot u)); rewrite ?XU, (steady_leg l (steady l il) (spot u)); [exact (formed l il) | exact re | rewrite es; exact ej].
Qed.

(** ** Struts of platforms that turn *)

Definition offs (k : motion) (d tau : Q) : list number := map (fun i => off i (if Nat.ltb i (first_angle k) then d else tau)) (seq 0 (dimension k)).
Lemma offs_are : forall k d tau u, is_near_centre (dimension k) (first_angle k) u ->
  @values (spot u) (nshift k (offs k d tau)) = vscale (Q2R d) (shift_of k u) /\ @values (spot u) (nspin k (offs k d tau)) = vscale (Q2R tau) (spin_of k u).
Proof.
  intros k d tau u h. assert (O : forall i q, @value (spot u) (off i q) = Q2R q * nth i u 0) by (intros i q; exact (off_is _ _ u i q h)).
  assert (Z : forall other, @value other (0 // 1) = 0) by (intro; cbn; lra).
  destruct k; cbn [offs dimension first_angle seq map Nat.ltb Nat.leb nshift nspin shift_of spin_of nth]; unfold values, vscale, vzero; cbn [nx ny nz vx vy vz];
    rewrite ?O, ?Z; split; f_equal; ring.
Qed.

Definition strut_number (w : numbers) : number := Root (product w w).
Definition nominal_exact_strut (t : tolerances * tolerances) : exact_strut := StrutNumbers (nmiddles (fst t)) (nmiddles (snd t)).
Lemma nominal_struts_are : forall ts, map strut_of (map nominal_exact_strut ts) = nominal_struts ts.
Proof. intro ts. unfold nominal_struts. rewrite map_map. apply map_ext. intro t. unfold nominal_exact_strut, strut_of. cbn [xbase xjoint]. rewrite !middles_are. reflexivity. Qed.

Definition lever_of (o : orientations) (t : list number) (P : numbers) (q : exact_strut * number * Z) : lever :=
  let '(l, r, v) := q in Lever (rounded (Over (v // 1) (Plus r (strut_number (xvector o t P l))))) r (each2 Minus P (xbase l)) (turn o t (xjoint l)).

Definition refute_far_pose (c : turning_claim) (ls : list exact_strut) (P : numbers) (t : list number) (test : nat) (v : list Z) : bool :=
  let k := motion_of c in let o := turned c in
  all_struts bits (struts c) ls && is_in bits (positions c) P && is_orientation bits o t && is_steady (in_numbers P) &&
  match test_at bits (match k with AboutPoint => 1 | _ => 2 end) test (turning_demands c) with
  | Some (OnePose e b angle, _) => match above (enclose few_bits b), above (enclose_tangent few_bits angle) with
      | Some d, Some tau => let U := nshift k (offs k d tau) in let w := nspin k (offs k d tau) in
          certainly bits true b && certainly bits false e && certainly bits true angle && is_angle_number bits angle && negb (Qle_bool tau 0) && Nat.eqb (length v) (length (struts c)) &&
          forallb (fun l => is_steady (in_numbers (xbase l)) && is_steady (in_numbers (turn o t (xjoint l)))) ls &&
          let rhos := asked_for v (map (fun q => strut_number (xvector o t P (nominal_exact_strut q))) (struts c)) e in is_steady rhos &&
          stays_below (dimension k) (first_angle k) (whole_pose U w (map (lever_of o t P) (combine (combine ls rhos) v)))
      | _, _ => false
      end
  | _ => false
  end.

Theorem refute_far_pose_sound : forall c ls P t test v, refute_far_pose c ls P t test v = true ->
  exists m P Q, is_about_struts c m P Q /\ ~ meets_turning c m P Q.
Proof.
  intros c ls P t test v h. unfold refute_far_pose in h. cbv zeta in h. set (k := motion_of c) in *. set (o := turned c) in *.
  apply andb_true_iff in h as [h rest]. apply andb_true_iff in h as [h place]. apply andb_true_iff in h as [h ori]. apply andb_true_iff in h as [h p].
  destruct (is_orientation_sound bits _ _ ori) as [Q [hQ turnQ]]. exists (map strut_of ls), (values P), Q.
  split; [split; [apply (all_struts_sound bits), h | split; [exact (is_in_sound bits _ _ p) | exact hQ]] |].
  intros [_ [_ met]]. destruct (test_at _ _ _ _) as [[q which] |] eqn:e; [| discriminate]. destruct q; try discriminate. apply test_at_in in e. rewrite Forall_forall in met. specialize (met _ e).
  destruct (above (enclose few_bits b)) as [d |] eqn:ed; [| discriminate]. destruct (above (enclose_tangent few_bits angle)) as [tau |] eqn:et; [| discriminate]. set (U := nshift k _) in *. set (w := nspin k _) in *.
  apply andb_true_iff in rest as [rest far]. apply andb_true_iff in far as [same far]. apply andb_true_iff in rest as [rest steady]. apply andb_true_iff in rest as [rest l2]. apply andb_true_iff in rest as [rest tau0].
  apply andb_true_iff in rest as [rest ia]. apply andb_true_iff in rest as [rest a0]. apply andb_true_iff in rest as [b0 e0].
  apply Nat.eqb_eq in l2. apply (positive_sound bits) in b0, a0. apply (nonneg_sound bits) in e0. apply (is_angle_number_sound bits) in ia. rewrite forallb_forall in steady.
  pose proof (above_sound _ (value b) d ed ltac:(intros q hq; apply enclose_sound, hq)) as bd.
  pose proof (above_sound _ (tangent (value angle)) tau et ltac:(intros q hq; exact (enclose_tangent_sound few_bits _ _ hq ia))) as ad.
  assert (t0 : 0 < Q2R tau).
  { apply Rnot_le_lt. intro l. apply negb_true_iff in tau0. assert (Qle_bool tau 0 = true) by (apply Qle_bool_iff, Qreals.Rle_Qle; unfold Q2R at 2; cbn; lra). congruence. }
  pose proof (tangent_nonneg _ (Rlt_le _ _ a0) ia) as tn.
  cbn [Configuration.fulfils struts_at recovers] in met. rewrite <- nominal_struts_are in met.
  set (nominal := map (fun q => strut_number (xvector o t P (nominal_exact_strut q))) (struts c)) in *.
  assert (Own : forall l, value (strut_number (xvector o t P l)) = strut_length (strut_of l) (values P) Q).
  { intro l. unfold strut_number. cbn [value]. rewrite value_square, (values_xvector o t Q turnQ). reflexivity. }
  assert (EN : map value nominal = map (fun l => strut_length l (values P) Q) (map strut_of (map nominal_exact_strut (struts c)))).
  { unfold nominal. rewrite !map_map. apply map_ext. intro q. apply Own. }
  set (rhos := asked_for v nominal error) in *. destruct (met (map value rhos)) as [P' [Q' [[near is_at] _]]].
  { pose proof (asked_near v nominal error e0 ltac:(unfold nominal; rewrite map_length; exact l2)) as A. fold rhos in A. rewrite EN in A. clear - A. revert A. generalize (map value rhos).
    induction (map strut_of (map nominal_exact_strut (struts c))) as [| q l IH]; intros s A; inversion A; subst; constructor; auto. }
  destruct near as [own [near [S [hS ->]]]]. destruct (turned_coordinates _ _ _ a0 ia hS) as [y [may [hy small]]]. fold k in own, may.
  assert (d0 : 0 < Q2R d) by lra.
  destruct (parts_exist k (vscale (/ Q2R d) (vsub P' (values P))) (vscale (/ Q2R tau) y)) as [u [lu [su tu]]].
  { clear - own. destruct k; cbn [is_of] in *; [destruct own as [z _]; cbn [vscale vz vx vy vzero]; rewrite z; repeat split; ring | exact I | rewrite own; unfold vscale, vzero; cbn; f_equal; ring]. }
  { clear - may. destruct k; cbn [may_turn] in *; try exact I. destruct may as [e1 e2]. cbn [vscale vx vy]. rewrite e1, e2. split; ring. }
  assert (Below : forall x y q, 0 < q -> 0 <= y -> y <= q -> norm2 x <= y ^ 2 -> sqrt (norm2 (vscale (/ q) x)) <= 1).
  { intros x z q q0 z0 zq hx. rewrite norm2_scale. rewrite <- sqrt_1. apply sqrt_le_1_alt. apply Rle_trans with ((/ q) ^ 2 * q ^ 2); [apply Rmult_le_compat_l; [apply pow2_ge_0 | apply Rle_trans with (1 := hx), pow_incr; lra] | right; field; lra]. }
  assert (N : is_near_centre (dimension k) (first_angle k) u).
  { destruct (parts_sizes k u lu) as [s1 s2]. cbn [Twofold.part] in s1, s2. split; [exact lu |]. rewrite s1, s2, su, tu. split; [exact (Below _ (value b) _ d0 (Rlt_le _ _ b0) bd near) | exact (Below _ _ _ t0 tn ad small)]. }
  destruct (offs_are k d tau u N) as [O1 O2]. rewrite su in O1. rewrite tu in O2.
  assert (Back : forall q x, 0 < q -> vscale q (vscale (/ q) x) = x) by (intros q [x1 x2 x3] q0; unfold vscale; cbn [vx vy vz]; f_equal; field; lra). rewrite Back in O1, O2 by assumption.
  assert (XU : vadd (@values (spot u) P) (@values (spot u) U) = P').
  { rewrite (steady_numbers _ place (spot u)). unfold U. rewrite O1. destruct P' as [p1 p2 p3]. destruct (values P) as [r1 r2 r3]. unfold vadd, vsub. cbn [vx vy vz]. f_equal; ring. }
  pose proof (stays_below_sound (dimension k) (first_angle k) _ u far N) as below.
  rewrite (@whole_pose_is (spot u) U w _ S) in below; [| unfold w; rewrite O2; symmetry; exact (along_axis_is y S hy) | |].
  - assert (Each : forall l, fold_right (fun q sum => @value (spot u) (weight q) * (norm2 (vadd (vadd (@values (spot u) (D_of q)) (@values (spot u) U)) (mulv S (@values (spot u) (r_of q)))) - @value (spot u) (length_of q) ^ 2) + sum) 0 (map (lever_of o t P) l) =
      fold_right (fun p sum => @value (spot u) (weight (lever_of o t P p)) * (norm2 (vadd (vadd (@values (spot u) (each2 Minus P (xbase (fst (fst p))))) (@values (spot u) U)) (mulv S (@values (spot u) (turn o t (xjoint (fst (fst p))))))) - @value (spot u) (snd (fst p)) ^ 2) + sum) 0 l)
      by (induction l as [| [[l r] z] rest IH]; cbn [map fold_right fst snd]; [reflexivity | rewrite IH; reflexivity]).
    rewrite Each in below. clear Each.
    pose proof (asked_zero _ (fun l r => strut_length (strut_of l) P' (mulm S Q) = r) u
      (fun l r => norm2 (vadd (vadd (@values (spot u) (each2 Minus P (xbase l))) (@values (spot u) U)) (mulv S (@values (spot u) (turn o t (xjoint l))))) - @value (spot u) r ^ 2) (fun p => @value (spot u) (weight (lever_of o t P p))) ls rhos v same) as none.
    rewrite none in below; [lra | |].
    + clear - is_at. revert is_at. generalize (map value rhos). induction ls as [| l ls IH]; intros s h; inversion h as [| ? ? ? ? [_ h1] h2]; subst; constructor; auto.
    + intros l r il er ej. specialize (steady l il). apply andb_true_iff in steady as [k1 k2]. rewrite (@values_minus (spot u)), er, <- ej, (steady_numbers _ k1 (spot u)), (steady_numbers _ k2 (spot u)), turnQ, <- XU.
      unfold strut_length. replace (sqrt _ ^ 2) with (norm2 (strut_vector (strut_of l) (vadd (@values (spot u) P) (@values (spot u) U)) (mulm S Q))) by (rewrite <- Rsqr_pow2; symmetry; apply Rsqr_sqrt, norm2_nonneg).
      apply Rminus_diag_eq. f_equal. unfold strut_vector, arm_of_joint. cbn [strut_of strut_base strut_joint]. rewrite mulv_mulm. generalize (@values (spot u) P) (@values (spot u) U) (mulv S (mulv Q (values (xjoint l)))) (values (xbase l)).
      clear. intros [x1 x2 x3] [y1 y2 y3] [z1 z2 z3] [a1 a2 a3]. unfold vadd, vsub. cbn [vx vy vz]. f_equal; ring.
  - intro b'. unfold w. transitivity (mulv (along_axis (@values (spot u) (nspin k (offs k d tau)))) (@values (spot u) b')).
    + destruct (nspin k _) as [w1 w2 w3]. exact (@values_turned (spot u) (TurnedUpTo (0 // 1)) [w1; w2; w3] b').
    + rewrite O2, (along_axis_is y S hy). reflexivity.
  - exact (orientation_keeps _ _ hS).
Qed.
End Named.
End Precision.
