(** * Two points, or poses, with the same joint coordinates

    The second is somewhere in a box of the workspace that the first is not in
    (Same.v): what is enclosed of it is a number whose coordinates vary. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Number Machine Witness Orientation Turning Singular Same.
From Orthocert.kernel Require Linear Slope Twofold.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Meant.
Context {names : naming}.

Lemma reserve_reaches : forall l P, match reserve l P with Some x => 0 < value x | None => True end -> reaches (values P) (leg_of l).
Proof.
  intros [d a p len m | a p k | d] P h; cbn [reserve leg_of reaches] in *; [| rewrite value_square in h; exact h | exact I].
  rewrite (value_clearance2 d a p len (if m then 1 else -1) P) in h. unfold s. cbn [leg_length]. apply sqrt_lt_R0, h.
Qed.

Lemma values_turned : forall o c b, values (turn o c b) = mulv (orientation_at o (map value c)) (values b).
Proof.
  assert (Z : forall t b, values (about_x t b) = mulv (half_x (value t)) (values b) /\ values (about_y t b) = mulv (half_y (value t)) (values b) /\ values (about_z t b) = mulv (half_z (value t)) (values b)).
  { intros t b. pose proof (pow2_ge_0 (value t)). unfold about_x, about_y, about_z, tturned, tcosine, tsine, values, mulv, Vec3.dot, half_x, half_y, half_z, half_cosine_of, half_sine_of.
    cbn [nx ny nz value row1 row2 row3 vx vy vz]. repeat split; f_equal; field; nra. }
  assert (A : forall c b, values (along c b) = mulv (along_axis (values c)) (values b)).
  { intros c b. apply values_along. unfold along_axis. pose proof (norm2_nonneg (values c)). set (w := 1 + norm2 (values c)). generalize (rodrigues (values c)). intros [[p1 p2 p3] [q1 q2 q3] [r1 r2 r3]].
    unfold mscale, vscale. cbn [row1 row2 row3 vx vy vz]. f_equal; f_equal; field; unfold w; lra. }
  intros [t | r p y | m | m n] [| x [| z [| w [|]]]] b; cbn [turn orientation_at map]; try (symmetry; apply mulv_identity).
  - apply Z.
  - destruct (Z w (about_y z (about_x x b))) as [_ [_ ->]]. destruct (Z z (about_x x b)) as [_ [-> _]]. destruct (Z x b) as [-> _]. rewrite !mulv_mulm. reflexivity.
  - exact (A (Numbers x z w) b).
  - exact (A (Numbers x z w) b).
Qed.

End Meant.

Section Named.
Context {names : naming}.

(** ** Numbers that do not vary, and those of a box *)

Definition is_steady (l : list number) : bool := forallb (fun x => negb (varies x)) l.
Lemma steady_values : forall l, is_steady l = true -> forall other, map (@value other) l = map (@value names) l.
Proof.
  intros l h other. apply map_ext_in. intros x ix. unfold is_steady in h. rewrite forallb_forall in h. specialize (h x ix). apply steady_value. destruct (varies x); [discriminate | reflexivity].
Qed.
Definition in_numbers (a : numbers) : list number := [nx a; ny a; nz a].
(** Numbers that are the same with other names. *)
Definition agrees (other : naming) (l : list number) : Prop := Forall (fun x => @value other x = @value names x) l.
Lemma numbers_agree : forall a other, agrees other (in_numbers a) -> @values other a = @values names a.
Proof. intros a other h. inversion h as [| ? ? h1 h']; subst. inversion h' as [| ? ? h2 h'']; subst. inversion h'' as [| ? ? h3]; subst. unfold values. rewrite h1, h2, h3. reflexivity. Qed.
Lemma steady_agrees : forall l, is_steady l = true -> forall other, agrees other l.
Proof. intros l h other. apply Forall_forall. intros x ix. unfold is_steady in h. rewrite forallb_forall in h. specialize (h x ix). apply steady_value. destruct (varies x); [discriminate | reflexivity]. Qed.
Lemma steady_numbers : forall a, is_steady (in_numbers a) = true -> forall other, @values other a = @values names a.
Proof. intros a h other. apply numbers_agree, steady_agrees, h. Qed.
Lemma steady_app : forall a b, is_steady (a ++ b) = true -> is_steady a = true /\ is_steady b = true.
Proof. intros a b h. unfold is_steady in *. rewrite forallb_app in h. apply andb_true_iff in h. exact h. Qed.

Definition of_Q (q : Q) : number := Qnum q // Qden q.
Lemma of_Q_value : forall q other, @value other (of_Q q) = Q2R q.
Proof. intros [n d] other. reflexivity. Qed.

Definition are_ordered (least greatest : list Q) : bool := Nat.eqb (length least) (length greatest) && forallb (fun p => Qle_bool (fst p) (snd p)) (combine least greatest).
Definition somewhere (j : nat) (least greatest : list Q) : list number := map (fun p => Varying (fst p) (fst (snd p)) (snd (snd p))) (combine (seq j (length least)) (combine least greatest)).
Lemma somewhere_between : forall u least greatest, are_ordered least greatest = true -> Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine least greatest) (map (@value (spot u)) (somewhere 0 least greatest)).
Proof.
  intros u least greatest h. apply andb_true_iff in h as [l h]. apply Nat.eqb_eq in l. unfold somewhere. generalize 0%nat. revert greatest l h.
  induction least as [| a least IH]; intros [| b greatest] l h j; try discriminate; cbn [length seq combine map]; constructor.
  - cbn [combine forallb fst snd] in *. apply andb_true_iff in h as [h _]. apply Qle_bool_iff, Qreals.Qle_Rle in h. cbn [value Claim.along spot]. pose proof (part_within u j). nra.
  - cbn [combine forallb] in h. apply andb_true_iff in h as [_ h]. apply IH; [cbn in l; congruence | exact h].
Qed.

Section Precision.
Variable bits : positive.

(** Some coordinate is certainly not in its range. *)
Fixpoint is_beside (least greatest : list Q) (point : list number) : bool :=
  match least, greatest, point with
  | a :: least', b :: greatest', x :: point' => certainly bits true (Minus (of_Q a) x) || certainly bits true (Minus x (of_Q b)) || is_beside least' greatest' point'
  | _, _, _ => false
  end.
Lemma is_beside_sound : forall least greatest point ys, is_beside least greatest point = true ->
  Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine least greatest) ys -> ys <> map value point.
Proof.
  induction least as [| a least IH]; intros [| b greatest] [| x point] ys h k; try discriminate. cbn [is_beside combine] in *. inversion k as [| ? y ? ys' k1 k2]; subst. cbn [fst snd] in k1.
  apply orb_true_iff in h as [h | h]; [| intro e; injection e as _ e; exact (IH _ _ _ h k2 e)].
  intro e. injection e as e _. apply orb_true_iff in h as [h | h]; apply positive_sound in h; cbn [value] in h; rewrite of_Q_value in h; lra.
Qed.

Definition is_certain (n : nat) (x : number) : bool := match sloped_by bits (anywhere bits n) x with Some s => (0 <? lo (Slope.range s))%Z | None => false end.
Lemma is_certain_sound : forall n u x, is_certain n x = true -> 0 < @value (spot u) x.
Proof.
  intros n u x h. unfold is_certain in h. destruct (sloped_by bits (anywhere bits n) x) as [s |] eqn:e; [| discriminate]. apply Z.ltb_lt in h.
  destruct (sloped_by_sound bits _ _ (spot u) (spot u) (lambda_within n u u) (anywhere_holds bits n u u) x s e) as [_ [r _]]. exact (contains_positive bits _ _ h r).
Qed.

(** A box is in a region if its corners are. *)
Definition is_box_in (w : region) (a b : Q * Q * Q) : bool :=
  let '(a1, a2, a3) := a in let '(b1, b2, b3) := b in
  forallb (fun x => forallb (fun y => forallb (fun z => is_in bits w (Numbers (of_Q x) (of_Q y) (of_Q z))) [a3; b3]) [a2; b2]) [a1; b1].
Lemma is_box_in_sound : forall w a1 a2 a3 b1 b2 b3 x y z, is_box_in w (a1, a2, a3) (b1, b2, b3) = true ->
  Q2R a1 <= x <= Q2R b1 -> Q2R a2 <= y <= Q2R b2 -> Q2R a3 <= z <= Q2R b3 -> in_region w (Vec x y z).
Proof.
  intros w a1 a2 a3 b1 b2 b3 x y z h hx hy hz. unfold is_box_in in h. cbn [forallb] in h.
  assert (K : forall a b t, a <= t <= b -> exists l, 0 <= l <= 1 /\ t = a + l * (b - a)).
  { intros a b t ht. destruct (Req_dec a b) as [<- | n]; [exists 0; lra |]. exists ((t - a) / (b - a)). assert (p : 0 < b - a) by lra. split; [| field; lra].
    split; apply Rmult_le_reg_r with (b - a); try exact p; unfold Rdiv; rewrite Rmult_assoc, Rinv_l, ?Rmult_0_l by lra; lra. }
  assert (Line : forall P P' l X, 0 <= l <= 1 -> vadd P (vscale l (vsub P' P)) = X -> in_region w P -> in_region w P' -> in_region w X) by (intros P P' l X hl <-; apply region_convex, hl).
  assert (Corner : forall p q r, is_in bits w (Numbers (of_Q p) (of_Q q) (of_Q r)) = true -> in_region w (Vec (Q2R p) (Q2R q) (Q2R r))) by (intros p q r e; apply is_in_sound in e; exact e).
  repeat match goal with k : _ && _ = true |- _ => apply andb_true_iff in k as [? ?] end.
  destruct (K _ _ _ hx) as [lx [px ->]], (K _ _ _ hy) as [ly [py ->]], (K _ _ _ hz) as [lz [pz ->]].
  assert (Z : forall p q, in_region w (Vec p q (Q2R a3)) -> in_region w (Vec p q (Q2R b3)) -> in_region w (Vec p q (Q2R a3 + lz * (Q2R b3 - Q2R a3))))
    by (intros p q g g'; apply (Line _ _ lz _ pz) with (2 := g) (3 := g'); unfold vadd, vscale, vsub; cbn [vx vy vz]; f_equal; ring).
  assert (Y : forall p r, in_region w (Vec p (Q2R a2) r) -> in_region w (Vec p (Q2R b2) r) -> in_region w (Vec p (Q2R a2 + ly * (Q2R b2 - Q2R a2)) r))
    by (intros p r g g'; apply (Line _ _ ly _ py) with (2 := g) (3 := g'); unfold vadd, vscale, vsub; cbn [vx vy vz]; f_equal; ring).
  apply (Line (Vec (Q2R a1) (Q2R a2 + ly * (Q2R b2 - Q2R a2)) (Q2R a3 + lz * (Q2R b3 - Q2R a3))) (Vec (Q2R b1) (Q2R a2 + ly * (Q2R b2 - Q2R a2)) (Q2R a3 + lz * (Q2R b3 - Q2R a3))) lx);
    [exact px | unfold vadd, vscale, vsub; cbn [vx vy vz]; f_equal; ring | |]; apply Y; apply Z; apply Corner; assumption.
Qed.

(** ** Legs that do not turn the platform *)

Definition leg_numbers (l : exact_leg) : list number :=
  match l with
  | ExactSlider d a p len _ => in_numbers d ++ in_numbers a ++ in_numbers p ++ [len]
  | ExactStrut a p k => in_numbers a ++ in_numbers p ++ match k with Some k => in_numbers k | None => [] end
  | ExactPlanar d => in_numbers d
  end.
Lemma leg_agrees : forall l other, agrees other (leg_numbers l) -> @leg_of other l = @leg_of names l.
Proof.
  intros [d a p len m | a p k | d] other h; cbn [leg_numbers leg_of] in *.
  - apply Forall_app in h as [h1 h]. apply Forall_app in h as [h2 h]. apply Forall_app in h as [h3 h4]. inversion h4 as [| ? ? E]; subst.
    rewrite E, (numbers_agree _ _ h1), (numbers_agree _ _ h2), (numbers_agree _ _ h3). reflexivity.
  - apply Forall_app in h as [h1 h]. apply Forall_app in h as [h2 h]. rewrite (numbers_agree _ _ h1), (numbers_agree _ _ h2). destruct k as [k |]; [| reflexivity]. cbn [option_map]. rewrite (numbers_agree _ _ h). reflexivity.
  - rewrite (numbers_agree _ _ h). reflexivity.
Qed.
Lemma steady_leg : forall l, is_steady (leg_numbers l) = true -> forall other, @leg_of other l = @leg_of names l.
Proof. intros l h other. apply leg_agrees, steady_agrees, h. Qed.

Definition refute_same (c : claim) (ls : list exact_leg) (P : numbers) (least greatest : list Q) (C : list (list Q)) : bool :=
  match least, greatest with
  | [a1; a2; a3], [b1; b2; b3] =>
      let X := Numbers (Varying 0 a1 b1) (Varying 1 a2 b2) (Varying 2 a3 b3) in
      admits bits c ls P && existsb (fun r => match r with OneToOne => true | _ => false end) (require c) &&
      are_ordered least greatest && is_box_in (workspace c) (a1, a2, a3) (b1, b2, b3) && is_beside least greatest (in_numbers P) &&
      forallb (fun l => is_steady (leg_numbers l) && is_steady [njoint l P] && match reserve l X with Some x => is_certain 3 x | None => true end) ls &&
      fits bits (map (fun l => Minus (njoint l X) (njoint l P)) ls) C
  | _, _ => false
  end.

Theorem refute_same_sound : forall c ls P least greatest C, refute_same c ls P least greatest C = true -> exists m P, is_about c m P /\ ~ meets c m P.
Proof.
  intros c ls P least greatest C h. unfold refute_same in h. destruct least as [| a1 [| a2 [| a3 [|]]]], greatest as [| b1 [| b2 [| b3 [|]]]]; try discriminate. cbv zeta in h.
  set (X := Numbers _ _ _) in *. apply andb_true_iff in h as [h fit]. apply andb_true_iff in h as [h each]. apply andb_true_iff in h as [h beside]. apply andb_true_iff in h as [h box].
  apply andb_true_iff in h as [h ordered]. apply andb_true_iff in h as [about asked]. rewrite forallb_forall in each. exists (map leg_of ls), (values P).
  split; [apply (admits_sound bits), about |]. intros [_ [_ met]]. apply existsb_exists in asked as [r [ir asked]]. destruct r; try discriminate. rewrite Forall_forall in met. specialize (met _ ir). cbn [fulfils] in met.
  destruct (fits_sound bits _ _ fit) as [u [_ [_ zero]]]. rewrite Forall_map, Forall_forall in zero.
  pose proof (somewhere_between u _ _ ordered) as B. unfold somewhere in B. cbn [length seq combine map fst snd] in B.
  inversion B as [| ? ? ? ? B1 B']; subst. inversion B' as [| ? ? ? ? B2 B'']; subst. inversion B'' as [| ? ? ? ? B3 _]; subst. cbn [fst snd] in B1, B2, B3.
  apply (is_beside_sound _ _ _ _ beside B). change (map value (in_numbers P)) with [vx (values P); vy (values P); vz (values P)].
  assert (E : @values (spot u) X = values P).
  { apply met.
    - exact (is_box_in_sound _ _ _ _ _ _ _ _ _ _ box B1 B2 B3).
    - rewrite Forall_map, Forall_forall. intros l il. specialize (each l il). apply andb_true_iff in each as [each k]. apply andb_true_iff in each as [k1 _].
      rewrite <- (steady_leg l k1 (spot u)). apply (@reserve_reaches (spot u)). destruct (reserve l X); [exact (is_certain_sound 3 u _ k) | exact I].
    - rewrite Forall_map, Forall_forall. intros l il. specialize (each l il). apply andb_true_iff in each as [each _]. apply andb_true_iff in each as [k1 k2].
      pose proof (zero l il) as z. cbn [value] in z. rewrite (@value_joint (spot u)), (steady_leg l k1) in z. pose proof (f_equal (hd 0) (steady_values _ k2 (spot u))) as k3. cbn [map hd] in k3. rewrite k3, value_joint in z. lra. }
  rewrite <- E. reflexivity.
Qed.

(** ** Struts of platforms that turn *)

(** Which sets tell coordinates from an orientation. *)
Definition tells (o : orientations) : bool := match o with RollPitchYaw _ _ _ => false | _ => true end.
Lemma tells_sound : forall o c c', tells o = true -> length c = match o with TurnedBy _ => 1%nat | _ => 3%nat end -> length c' = length c -> orientation_at o c' = orientation_at o c -> c' = c.
Proof.
  assert (A : forall a b, along_axis a = along_axis b -> a = b).
  { intros a b e. pose proof (norm2_nonneg a) as a0. pose proof (norm2_nonneg b) as b0.
    assert (T : 4 / (1 + norm2 a) = 4 / (1 + norm2 b)).
    { assert (K : forall c, 0 <= norm2 c -> vx (row1 (along_axis c)) + vy (row2 (along_axis c)) + vz (row3 (along_axis c)) = 4 / (1 + norm2 c) - 1).
      { intros [x y z] h. unfold along_axis, mscale, rodrigues, vscale, norm2 in *. cbn [row1 row2 row3 vx vy vz] in *. field. lra. }
      rewrite <- (Rplus_0_r (4 / (1 + norm2 a))), <- (Rplus_0_r (4 / (1 + norm2 b))). pose proof (K a a0) as ka. pose proof (K b b0) as kb. rewrite e in ka. lra. }
    assert (N : norm2 a = norm2 b).
    { assert (P : (1 + norm2 a) * (1 + norm2 b) <> 0) by (apply Rmult_integral_contrapositive_currified; lra). apply (f_equal (fun t => t * ((1 + norm2 a) * (1 + norm2 b)))) in T. field_simplify in T; lra. }
    assert (V : forall c, 0 <= norm2 c -> c = vscale ((1 + norm2 c) / 4) (Vec (vy (row3 (along_axis c)) - vz (row2 (along_axis c))) (vz (row1 (along_axis c)) - vx (row3 (along_axis c))) (vx (row2 (along_axis c)) - vy (row1 (along_axis c))))).
    { intros [x y z] h. unfold along_axis, mscale, rodrigues, vscale, norm2 in *. cbn [row1 row2 row3 vx vy vz] in *. f_equal; field; lra. }
    rewrite (V a a0), (V b b0), e, N. reflexivity. }
  intros [t | r p y | m | m n] c c' h lc lc' e; try discriminate.
  - destruct c as [| x [|]]; try discriminate. destruct c' as [| x' [|]]; try discriminate. cbn [orientation_at] in e. f_equal.
    assert (K : forall t, 2 * t / (1 + t ^ 2) = t * (1 + (1 - t ^ 2) / (1 + t ^ 2))) by (intro; field; nra). unfold half_z in e. injection e as e1 _ e2 _. unfold half_cosine_of in e1. unfold half_sine_of in e2.
    rewrite !K, e1 in e2. assert (1 + (1 - x ^ 2) / (1 + x ^ 2) <> 0) by (replace (1 + (1 - x ^ 2) / (1 + x ^ 2)) with (2 / (1 + x ^ 2)) by (field; nra); apply Rgt_not_eq, Rdiv_lt_0_compat; nra). nra.
  - destruct c as [| x [| y [| z [|]]]]; try discriminate. destruct c' as [| x' [| y' [| z' [|]]]]; try discriminate. cbn [orientation_at] in e. apply A in e. injection e as -> -> ->. reflexivity.
  - destruct c as [| x [| y [| z [|]]]]; try discriminate. destruct c' as [| x' [| y' [| z' [|]]]]; try discriminate. cbn [orientation_at] in e. apply A in e. injection e as -> -> ->. reflexivity.
Qed.

(** Coordinates between these are those of the set. *)
Definition farther (a b : Q) : Q := if Qle_bool (a * a) (b * b) then b else a.
Definition nearer (a b : Q) : Q := if Qle_bool a 0 && Qle_bool 0 b then 0%Q else if Qle_bool (a * a) (b * b) then a else b.
Definition is_range_in (t : tolerance) (a b : Q) : bool := is_half_tangent_in bits t (of_Q a) && is_half_tangent_in bits t (of_Q b).
Definition are_oriented (o : orientations) (least greatest : list Q) : bool :=
  match o, least, greatest with
  | TurnedBy t, [a], [b] => is_range_in t a b
  | RollPitchYaw r p y, [a1; a2; a3], [b1; b2; b3] => is_range_in r a1 b1 && is_range_in p a2 b2 && is_range_in y a3 b3
  | TurnedUpTo _, [a1; a2; a3], [b1; b2; b3] => is_orientation bits o [of_Q (farther a1 b1); of_Q (farther a2 b2); of_Q (farther a3 b3)]
  | Tilted _ n, [a1; a2; a3], [b1; b2; b3] => is_orientation bits o [of_Q (farther a1 b1); of_Q (farther a2 b2); of_Q (nearer a3 b3)] && is_range_in (either_way n) a3 b3
  | _, _, _ => false
  end.

Lemma squares_between : forall a b x, Q2R a <= x <= Q2R b -> Q2R (nearer a b) ^ 2 <= x ^ 2 <= Q2R (farther a b) ^ 2.
Proof.
  assert (S : forall p q, Qle_bool (p * p) (q * q) = true -> Q2R p ^ 2 <= Q2R q ^ 2).
  { intros p q h. apply Qle_bool_iff, Qreals.Qle_Rle in h. rewrite !Qreals.Q2R_mult in h. lra. }
  assert (N : forall p q, Qle_bool (p * p) (q * q) = false -> Q2R q ^ 2 <= Q2R p ^ 2).
  { intros p q h. apply Rnot_lt_le. intro l. assert (k : Qle_bool (p * p) (q * q) = true) by (apply Qle_bool_iff, Qreals.Rle_Qle; rewrite !Qreals.Q2R_mult; lra). congruence. }
  assert (L : forall p q, Qle_bool p q = true -> Q2R p <= Q2R q) by (intros p q h; apply Qreals.Qle_Rle, Qle_bool_iff, h).
  assert (G : forall p q, Qle_bool p q = false -> Q2R q < Q2R p).
  { intros p q h. apply Rnot_le_lt. intro l. assert (k : Qle_bool p q = true) by (apply Qle_bool_iff, Qreals.Rle_Qle, l). congruence. }
  assert (Z0 : Q2R 0 = 0) by (unfold Q2R; cbn; lra).
  intros a b x [h1 h2]. split.
  - unfold nearer. destruct (Qle_bool a 0) eqn:e1; [destruct (Qle_bool 0 b) eqn:e2 |]; cbn [andb].
    + rewrite Z0. pose proof (pow2_ge_0 x). lra.
    + apply G in e2. rewrite Z0 in e2. assert (Q2R b ^ 2 <= x ^ 2) by nra. destruct (Qle_bool (a * a) (b * b)) eqn:e; [apply S in e | apply N in e]; lra.
    + apply G in e1. rewrite Z0 in e1. assert (Q2R a ^ 2 <= x ^ 2) by nra. destruct (Qle_bool (a * a) (b * b)) eqn:e; [apply S in e | apply N in e]; lra.
  - assert (x ^ 2 <= Q2R a ^ 2 \/ x ^ 2 <= Q2R b ^ 2) by (destruct (Rle_dec 0 x); [right | left]; nra). unfold farther. destruct (Qle_bool (a * a) (b * b)) eqn:e; [apply S in e | apply N in e]; lra.
Qed.

Lemma are_oriented_sound : forall o least greatest c, are_oriented o least greatest = true ->
  Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine least greatest) c -> in_orientations o (orientation_at o c).
Proof.
  assert (H : forall t a b x, is_range_in t a b = true -> Q2R a <= x <= Q2R b -> is_half_in t x).
  { intros t a b x h hx. apply andb_true_iff in h as [h1 h2].
    assert (K : forall q, is_half_tangent_in bits t (of_Q q) = true -> is_half_in t (Q2R q)).
    { intros q h. pose proof (is_orientation_coordinate bits (TurnedBy t) [of_Q q] h) as k. cbn [is_coordinate map] in k. rewrite of_Q_value in k. exact k. }
    apply K in h1, h2. destruct (Req_dec (Q2R a) (Q2R b)) as [e | n]; [replace x with (Q2R a) by lra; exact h1 |].
    replace x with (Q2R a + (x - Q2R a) / (Q2R b - Q2R a) * (Q2R b - Q2R a)) by (field; lra). apply half_between; [| exact h1 | exact h2].
    assert (p : 0 < Q2R b - Q2R a) by lra. split; apply Rmult_le_reg_r with (Q2R b - Q2R a); try exact p; unfold Rdiv; rewrite Rmult_assoc, Rinv_l, ?Rmult_0_l by lra; lra. }
  intros o least greatest c h k. apply is_coordinate_sound.
  destruct o as [t | r p y | m | m n]; cbn [are_oriented] in h.
  - destruct least as [| a [|]], greatest as [| b [|]]; try discriminate. inversion k as [| ? x ? ? k1 k']; subst. inversion k'; subst. exact (H _ _ _ _ h k1).
  - destruct least as [| a1 [| a2 [| a3 [|]]]], greatest as [| b1 [| b2 [| b3 [|]]]]; try discriminate.
    inversion k as [| ? x ? ? k1 k']; subst. inversion k' as [| ? x2 ? ? k2 k'']; subst. inversion k'' as [| ? x3 ? ? k3 k0]; subst. inversion k0; subst. cbn [fst snd] in *.
    apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2]. split; [exact (H _ _ _ _ h1 k1) | split; [exact (H _ _ _ _ h2 k2) | exact (H _ _ _ _ h3 k3)]].
  - destruct least as [| a1 [| a2 [| a3 [|]]]], greatest as [| b1 [| b2 [| b3 [|]]]]; try discriminate.
    inversion k as [| ? x ? ? k1 k']; subst. inversion k' as [| ? x2 ? ? k2 k'']; subst. inversion k'' as [| ? x3 ? ? k3 k0]; subst. inversion k0; subst. cbn [fst snd] in *.
    apply is_orientation_coordinate in h. cbn [is_coordinate map] in *. rewrite !of_Q_value in h. destruct h as [h1 [h2 h3]]. split; [exact h1 | split; [exact h2 |]].
    pose proof (squares_between _ _ _ k1). pose proof (squares_between _ _ _ k2). pose proof (squares_between _ _ _ k3). unfold norm2 in *. cbn [vx vy vz] in *. lra.
  - destruct least as [| a1 [| a2 [| a3 [|]]]], greatest as [| b1 [| b2 [| b3 [|]]]]; try discriminate.
    inversion k as [| ? x ? ? k1 k']; subst. inversion k' as [| ? x2 ? ? k2 k'']; subst. inversion k'' as [| ? x3 ? ? k3 k0]; subst. inversion k0; subst. cbn [fst snd] in *.
    apply andb_true_iff in h as [h hz]. apply is_orientation_coordinate in h. cbn [is_coordinate map] in *. rewrite !of_Q_value in h. destruct h as [h1 [h2 [h3 _]]].
    split; [exact h1 | split; [exact h2 | split; [| exact (H _ _ _ _ hz k3)]]].
    pose proof (squares_between _ _ _ k1). pose proof (squares_between _ _ _ k2). pose proof (squares_between _ _ _ k3).
    apply Rle_trans with (Q2R (farther a1 b1) ^ 2 + Q2R (farther a2 b2) ^ 2); [lra |]. apply Rle_trans with (1 := h3). apply Rmult_le_compat_l; [apply pow2_ge_0 | lra].
Qed.

Lemma in_two_parts : forall places least greatest ys, Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine least greatest) ys ->
  Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine (firstn places least) (firstn places greatest)) (firstn places ys) /\
  Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine (skipn places least) (skipn places greatest)) (skipn places ys).
Proof.
  induction places as [| k IH]; intros least greatest ys B; [split; [constructor | exact B] |].
  destruct least as [| a least], greatest as [| b greatest]; cbn [combine] in B; inversion B as [| ? v ? ys' h1 h2]; subst; cbn [firstn skipn combine]; rewrite ?combine_nil;
    try (split; constructor; fail).
  destruct (IH least greatest ys' h2) as [i1 i2]. split; [constructor; assumption | exact i2].
Qed.
Lemma at_each : forall least greatest ys i, Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine least greatest) ys -> length least = length greatest ->
  Q2R (nth i least 0%Q) <= nth i ys 0 <= Q2R (nth i greatest 0%Q).
Proof.
  assert (z : Q2R 0 = 0) by (unfold Q2R; cbn; lra).
  induction least as [| a least IH]; intros [| b greatest] ys i k l; try discriminate; cbn [combine] in k; inversion k as [| ? v ? ys' h1 h2]; subst.
  - destruct i; cbn [nth]; rewrite z; lra.
  - destruct i; cbn [nth fst snd] in *; [assumption |]. apply IH; [assumption | cbn in l; congruence].
Qed.

(** The first [places] coordinates are those of the position. *)
Definition placed_by (l : list number) : numbers := Numbers (nth 0 l (0 // 1)) (nth 1 l (0 // 1)) (nth 2 l (0 // 1)).
Definition padded (l : list Q) : Q * Q * Q := (nth 0 l 0%Q, nth 1 l 0%Q, nth 2 l 0%Q).
Definition square_length (o : orientations) (c : list number) (P : numbers) (l : exact_strut) : number := product (xvector o c P l) (xvector o c P l).
Definition refute_same_pose (places : nat) (c : turning_claim) (ls : list exact_strut) (P : numbers) (t : list number) (least greatest : list Q) (C : list (list Q)) : bool :=
  let o := turned c in let X := somewhere 0 least greatest in
  one_pose c && is_about_exactly bits c ls P t && Nat.leb places 3 && Nat.eqb (length least) (places + length t) && Nat.eqb (length t) match o with TurnedBy _ => 1 | _ => 3 end &&
  are_ordered least greatest && is_box_in (positions c) (padded (firstn places least)) (padded (firstn places greatest)) && are_oriented o (skipn places least) (skipn places greatest) &&
  (is_beside (firstn places least) (firstn places greatest) (firstn places (in_numbers P)) || tells o && is_beside (skipn places least) (skipn places greatest) t) &&
  forallb (fun l => is_steady (in_numbers (xbase l) ++ in_numbers (xjoint l)) && is_steady [square_length o t P l]) ls &&
  fits bits (map (fun l => Minus (Root (square_length o (skipn places X) (placed_by (firstn places X)) l)) (Root (square_length o t P l))) ls) C.

Theorem refute_same_pose_sound : forall places c ls P t least greatest C, refute_same_pose places c ls P t least greatest C = true ->
  one_pose c = true /\ exists m P Q P' Q', is_about_struts c m P Q /\ in_region (positions c) P' /\ in_orientations (turned c) Q' /\
    Forall (fun l => strut_length l P' Q' = strut_length l P Q) m /\ ~ (P' = P /\ Q' = Q).
Proof.
  intros places c ls P t least greatest C h. unfold refute_same_pose in h. cbv zeta in h. set (o := turned c) in *. set (X := somewhere 0 least greatest) in *.
  apply andb_true_iff in h as [h fit]. apply andb_true_iff in h as [h each]. apply andb_true_iff in h as [h beside]. apply andb_true_iff in h as [h oriented]. apply andb_true_iff in h as [h box].
  apply andb_true_iff in h as [h ordered]. apply andb_true_iff in h as [h lt]. apply andb_true_iff in h as [h ll]. apply andb_true_iff in h as [h p3]. apply andb_true_iff in h as [one h].
  apply andb_true_iff in h as [h ori]. apply andb_true_iff in h as [s place]. apply Nat.eqb_eq in lt, ll. apply Nat.leb_le in p3. rewrite forallb_forall in each. split; [exact one |].
  destruct (fits_sound bits _ _ fit) as [u [_ [_ zero]]]. rewrite Forall_map, Forall_forall in zero. pose proof (somewhere_between u _ _ ordered) as B. fold X in B.
  set (y := map (@value (spot u)) X) in *.
  assert (lX : length y = length least).
  { pose proof (Linear.related_length _ _ _ _ _ B) as e. rewrite <- e, combine_length. apply andb_true_iff in ordered as [l _]. apply Nat.eqb_eq in l. rewrite <- l. apply Nat.min_id. }
  assert (Parts : Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine (firstn places least) (firstn places greatest)) (firstn places y) /\
    Forall2 (fun p y => Q2R (fst p) <= y <= Q2R (snd p)) (combine (skipn places least) (skipn places greatest)) (skipn places y)).
  { exact (in_two_parts places least greatest y B). }
  destruct Parts as [B1 B2].
  set (P' := @values (spot u) (placed_by (firstn places X))). set (Q := orientation_at o (map value t)). set (Q' := orientation_at o (skipn places y)).
  assert (ey : map (@value (spot u)) (skipn places X) = skipn places y) by (unfold y; symmetry; apply skipn_map).
  assert (ep : map (@value (spot u)) (firstn places X) = firstn places y) by (unfold y; symmetry; apply firstn_map).
  exists (map strut_of ls), (values P), Q, P', Q'. apply is_in_sound in place. apply is_orientation_coordinate in ori. split; [split; [exact (all_struts_sound bits _ _ s) | split; [exact place | apply is_coordinate_sound, ori]] |].
  split; [| split; [exact (are_oriented_sound _ _ _ _ oriented B2) | split]].
  - assert (At : forall i, Q2R (nth i (firstn places least) 0%Q) <= @value (spot u) (nth i (firstn places X) (0 // 1)) <= Q2R (nth i (firstn places greatest) 0%Q)).
    { assert (E : forall i, @value (spot u) (nth i (firstn places X) (0 // 1)) = nth i (firstn places y) 0).
      { intro i. rewrite <- ep. assert (z : @value (spot u) (0 // 1) = 0) by (cbn; lra). rewrite <- z. symmetry. apply map_nth. }
      intro i. rewrite E. apply at_each; [exact B1 |].
      apply andb_true_iff in ordered as [l _]. apply Nat.eqb_eq in l. rewrite !firstn_length, l. reflexivity. }
    unfold P', placed_by, values. cbn [nx ny nz]. unfold padded in box. apply (is_box_in_sound _ _ _ _ _ _ _ _ _ _ box); apply At.
  - rewrite Forall_map, Forall_forall. intros l il. specialize (each l il). apply andb_true_iff in each as [k1 k2]. apply steady_app in k1 as [k0 k1].
    pose proof (f_equal (hd 0) (steady_values _ k2 (spot u))) as k3. cbn [map hd] in k3. pose proof (zero l il) as z. cbn [value] in z. rewrite k3 in z. unfold square_length in z.
    rewrite !value_square in z. unfold strut_length.
    assert (V : @values (spot u) (xvector o (skipn places X) (placed_by (firstn places X)) l) = strut_vector (strut_of l) P' Q').
    { unfold xvector, strut_vector, arm_of_joint. rewrite values_minus, values_plus, values_turned, ey. cbn [strut_of strut_base strut_joint]. rewrite (steady_numbers _ k0), (steady_numbers _ k1). reflexivity. }
    assert (V0 : values (xvector o t P l) = strut_vector (strut_of l) (values P) Q) by (unfold xvector, strut_vector, arm_of_joint; rewrite values_minus, values_plus, values_turned; reflexivity).
    rewrite V, V0 in z. lra.
  - intros [e1 e2]. apply orb_true_iff in beside as [b | b].
    + apply (is_beside_sound _ _ _ _ b B1). rewrite <- ep, <- (firstn_map (@value names)). change (map value (in_numbers P)) with [vx (values P); vy (values P); vz (values P)]. rewrite <- e1. unfold P', placed_by, values. cbn [nx ny nz].
      assert (l : length (firstn places X) = places) by (rewrite firstn_length; unfold y in lX; rewrite map_length in lX; lia).
      clear - l p3. destruct (firstn places X) as [| x1 [| x2 [| x3 [|]]]]; cbn [length] in l; subst places; try reflexivity. cbn in p3. lia.
    + apply andb_true_iff in b as [tell b]. apply (is_beside_sound _ _ _ _ b B2). apply (tells_sound o); [exact tell | rewrite map_length; exact lt | rewrite map_length, skipn_length; lia | exact e2].
Qed.
End Precision.
End Named.
