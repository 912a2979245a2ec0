(** * Accelerations of legs in any motion

    A leg's row depends on where its joint on the platform is alone: with the row u of a platform that does not turn, U = du/dC of that place C = P + r,
    and C' = v + omega x r, the joint's speed has the derivative row . (v', ell omega') + C' . U C' + (u . omega) (r . omega) - (u . r) |omega|^2,
    as of struts ([speed_bends]). As formulas: motion.rs. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Import Statement Linear Test Check Number Trig Formula Gradient Machine Acceleration Problem Witness Orientation Turning Chart Bend Configuration Inputs Arm Legs Onward Pose Drives.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

Lemma related_at : forall (A B : Type) (T : A -> B -> Prop) s t, Forall2 T s t -> forall i a b, nth_error s i = Some a -> nth_error t i = Some b -> T a b.
Proof. intros A B T s t h. induction h as [| a b s t h1 h2 IH]; intros [| i] x y e f; try discriminate; cbn [nth_error] in *; [congruence | exact (IH i x y e f)]. Qed.

(** ** Kinematics *)

(** The components that there are. *)
Definition shifts_of (k : mobility) (v : vec) : vec := match k with Translates => v | TranslatesInPlane => shifts InPlane v | Turns k => shifts k v end.
Definition spins_of (k : mobility) (w : vec) : vec := match k with Turns k => spins k w | _ => vzero end.

Lemma velocities_dot : forall k ell u r v w, match k with Turns _ => ell <> 0 | _ => True end ->
  Linear.dot (velocities k u (vscale (/ ell) (cross r u))) (velocities k v (vscale ell w)) = Vec3.dot u (vadd (shifts_of k v) (cross (spins_of k w) r)).
Proof.
  intros [| | k] ell u r v w l0; [| | exact (twist_dot k ell u r v w l0)]; destruct u, r, v, w; cbn; unfold Vec3.dot, vadd, cross, vzero; cbn; ring.
Qed.
Lemma own_velocities : forall k v w, has_velocities k v w -> shifts_of k v = v /\ spins_of k w = w.
Proof.
  intros [| | k] v w h; cbn [has_velocities] in h; [subst w; split; reflexivity | | exact (own_parts k v w h)].
  destruct h as [h ->]. split; [| reflexivity]. destruct v as [a b c]. cbn [vz] in h. subst c. reflexivity.
Qed.
Lemma velocity_parts_of : forall k f t v, has_velocity f t v -> has_velocity (fun u => shifts_of k (f u)) t (shifts_of k v) /\ has_velocity (fun u => spins_of k (f u)) t (spins_of k v).
Proof.
  assert (Z : forall t, has_velocity (fun _ => vzero) t vzero) by (intro t; repeat split; apply derivable_const).
  intros [| | k] f t v h; [split; [exact h | apply Z] | split; [exact (proj1 (velocity_parts InPlane f t v h)) | apply Z] | exact (velocity_parts k f t v h)].
Qed.

Lemma carried_velocity : forall l P Q t v omega, has_velocity P t v -> turns Q t omega ->
  has_velocity (fun u => carried l (P u) (Q u)) t (vadd v (cross omega (mulv (Q t) (offset l)))).
Proof.
  intros l P Q t v omega hP hQ. destruct hP as [p1 [p2 p3]]. destruct (hQ (offset l)) as [q1 [q2 q3]].
  assert (K : forall f g d e c, derivable_pt_lim f t d -> derivable_pt_lim g t e -> derivable_pt_lim (fun u => f u + g u - c) t (d + e)).
  { intros f g d e c hf hg. apply derivable_eq with (fun u => f u + g u + - c) (d + e + 0); try (intros; ring).
    apply derivable_add; [apply derivable_add; assumption | apply derivable_const]. }
  split; [| split]; unfold carried; cbn [vsub vadd vx vy vz] in *; apply K; assumption.
Qed.

(** The velocity of the joint on the platform, and its rate. *)
Lemma tip_moves : forall k l turn velocity omega V W acceleration alpha, velocity 0 = V -> omega 0 = W -> turns turn 0 W ->
  has_velocity velocity 0 acceleration -> has_velocity omega 0 alpha -> has_velocities k V W -> let r := mulv (turn 0) (offset l) in
  has_velocity (fun t => vadd (shifts_of k (velocity t)) (cross (spins_of k (omega t)) (mulv (turn t) (offset l)))) 0
    (vadd (shifts_of k acceleration) (vadd (cross (spins_of k alpha) r) (cross W (cross W r)))) /\ vadd (shifts_of k (velocity 0)) (cross (spins_of k (omega 0)) r) = vadd V (cross W r).
Proof.
  intros k l turn velocity omega V W acceleration alpha eV eW ht hv hw hk r. destruct (own_velocities k V W hk) as [sV sW].
  pose proof (velocity_sum _ _ _ _ _ (proj1 (velocity_parts_of k _ _ _ hv)) (velocity_cross _ _ _ _ _ (proj2 (velocity_parts_of k _ _ _ hw)) (ht (offset l)))) as hD. cbv beta in hD.
  fold r in hD. rewrite eW, sW in hD. split; [exact hD |]. rewrite eV, eW, sV, sW. reflexivity.
Qed.

(** With the rate of the row. *)
Lemma joint_bends : forall k ell l P Q V W position turn velocity omega acceleration alpha du, match k with Turns _ => ell <> 0 | _ => True end ->
  position 0 = P -> turn 0 = Q -> velocity 0 = V -> omega 0 = W -> turns turn 0 W -> has_velocity velocity 0 acceleration -> has_velocity omega 0 alpha -> has_velocities k V W ->
  let u := own_row l (carried l P Q) in let r := mulv Q (offset l) in
  has_velocity (fun t => own_row l (carried l (position t) (turn t))) 0 du ->
  derivable_pt_lim (fun t => Linear.dot (driven_row k ell (position t) (turn t) l) (velocities k (velocity t) (vscale ell (omega t)))) 0
    (Linear.dot (driven_row k ell P Q l) (velocities k acceleration (vscale ell alpha)) + Vec3.dot du (vadd V (cross W r)) + (Vec3.dot u W * Vec3.dot r W - Vec3.dot u r * norm2 W)).
Proof.
  intros k ell l P Q V W position turn velocity omega acceleration alpha du l0 eP eQ eV eW ht hv hw hk u r hu.
  destruct (tip_moves k l turn velocity omega V W acceleration alpha eV eW ht hv hw hk) as [hD e]. cbv zeta in hD, e. rewrite eQ in hD, e. fold r in hD, e.
  pose proof (velocity_product _ _ _ _ _ hu hD) as H. cbv beta in H. rewrite eQ in H. fold r in H. rewrite e, eP in H. fold u in H.
  eapply derivable_eq; [exact H | |].
  - intro t. cbv beta. unfold driven_row. cbv zeta. rewrite velocities_dot by exact l0. reflexivity.
  - unfold driven_row. cbv zeta. fold u r. rewrite velocities_dot by exact l0. generalize (shifts_of k acceleration) (spins_of k alpha) u r. clear. intros. unfold_vec. ring.
Qed.

(** ** Functions that agree near a point *)

Lemma derivable_near : forall f g t d e, 0 < e -> (forall u, Rabs (u - t) < e -> g u = f u) -> derivable_pt_lim f t d -> derivable_pt_lim g t d.
Proof.
  intros f g t d e e0 h hf eps p. destruct (hf eps p) as [del hd]. assert (m0 : 0 < Rmin del e) by (apply Rmin_glb_lt; [apply cond_pos | exact e0]).
  exists (mkposreal _ m0). intros y y0 hy. cbn [pos] in hy. rewrite (h t), (h (t + y)).
  - apply hd; [exact y0 | apply Rlt_le_trans with (1 := hy), Rmin_l].
  - replace (t + y - t) with y by ring. apply Rlt_le_trans with (1 := hy), Rmin_r.
  - rewrite Rminus_diag_eq, Rabs_R0 by reflexivity. exact e0.
Qed.
Lemma positive_near : forall f t d, derivable_pt_lim f t d -> 0 < f t -> exists e, 0 < e /\ forall u, Rabs (u - t) < e -> 0 < f u.
Proof.
  intros f t d h p. assert (D : derivable_pt f t) by (exists d; exact h). pose proof (derivable_continuous_pt _ _ D) as C.
  destruct (C (f t) p) as [e [e0 he]]. exists e. split; [exact e0 |]. intros u hu. destruct (Req_dec t u) as [<- | ne]; [exact p |].
  specialize (he u (conj (conj I ne) hu)). cbn in he. unfold R_dist in he. apply Rabs_def2 in he. lra.
Qed.

(** ** As formulas *)

Definition motion_of (k : mobility) : motion := match k with Translates => InSpace | TranslatesInPlane => InPlane | Turns k => k end.
(** Where the joint is, as parameters from [p] on. *)
Definition free_tip (p : nat) : evec := EVec (F (Param p)) (F (Param (S p))) (F (Param (S (S p)))).
Definition slopes_by (k : mobility) (p : nat) (C : evec) (f : formula) : evec := unit_slopes (motion_of k) p C C f.
Definition tip_gradient (k : mobility) (p : nat) (C u : evec) : emat :=
  EMat (slopes_by k p C (ex u)) (slopes_by k p C (ey u)) match motion_of k with InPlane => EVec (integer 0) (integer 0) (integer 0) | _ => slopes_by k p C (ez u) end.
Definition columns_of (k : mobility) (r : evec) (ell : formula) : list (evec * option nat) :=
  let shift i := (unit_along i, None) in
  match k with Translates => [shift 0; shift 1; shift 2] | TranslatesInPlane => [shift 0; shift 1] | Turns k => columns k r ell end%nat.
Definition real_columns_of (k : mobility) (r : vec) (ell : R) : list (vec * option nat) :=
  let shift i := (axis_along i, None) in
  match k with Translates => [shift 0; shift 1; shift 2] | TranslatesInPlane => [shift 0; shift 1] | Turns k => real_columns k r ell end%nat.
(** 2 H, of the drive [g] by where its joint is, which is C. *)
Definition twice_bent (k : mobility) (ell : formula) (p : nat) (g : evec -> drive_formulas) (r C : evec) : list (list formula) :=
  upper (bend_entry (tip_gradient k p C (b_divided (g (free_tip p)))) (b_divided (g C)) r ell) (columns_of k r ell).
(** What has to be defined. *)
Definition tip_formulas (p : nat) (g : evec -> drive_formulas) : list formula := let b := g (free_tip p) in [ex (b_divided b); ey (b_divided b); ez (b_divided b); b_D b].
Definition tip_built (p : nat) (g : evec -> drive_formulas) (C : evec) : list formula := map (attached p (list_of C)) (tip_formulas p g).

Lemma value_columns_of : forall x theta k r ell, map (fun c => (val3 x theta (fst c), snd c)) (columns_of k r ell) = real_columns_of k (val3 x theta r) (Formula.value x theta ell).
Proof. intros x theta [| | k] r ell; [reflexivity | reflexivity | exact (value_columns x theta k r ell)]. Qed.
Lemma quad_bent : forall k U u r ell v w, has_velocities k v w -> let C := vadd v (vscale (/ ell) (cross w r)) in
  quad (upper (real_entry U u r ell) (real_columns_of k r ell)) (velocities k v w) = 2 * Vec3.dot C (mulv U C) + 2 * (Vec3.dot u w * Vec3.dot r w - Vec3.dot u r * norm2 w) / ell ^ 2.
Proof.
  intros [| | k] U u r ell v w h; [| | exact (quad_bend k U u r ell v w h)]; cbn [has_velocities] in h; cbv zeta.
  - subst w. destruct U as [[a1 a2 a3] [b1 b2 b3] [c1 c2 c3]], u as [u1 u2 u3], r as [r1 r2 r3], v as [v1 v2 v3].
    unfold real_columns_of, real_entry, axis_along, e1, e2, e3, cross, vscale, vadd, mulv, transpose, col1, col2, col3, Vec3.dot, norm2, velocities, coordinates, vzero, Rdiv;
    cbn [upper map fst snd Nat.eqb component quad row_form Linear.dot vx vy vz row1 row2 row3]. rewrite <- ?pow_inv; generalize (/ ell); intro i; ring.
  - destruct h as [h ->]. destruct U as [[a1 a2 a3] [b1 b2 b3] [c1 c2 c3]], u as [u1 u2 u3], r as [r1 r2 r3], v as [v1 v2 v3]. cbn [vz] in h. subst v3.
    unfold real_columns_of, real_entry, axis_along, e1, e2, e3, cross, vscale, vadd, mulv, transpose, col1, col2, col3, Vec3.dot, norm2, velocities, coordinates, vzero, Rdiv;
    cbn [upper map fst snd Nat.eqb component quad row_form Linear.dot vx vy vz row1 row2 row3]. rewrite <- ?pow_inv; generalize (/ ell); intro i; ring.
Qed.

Fixpoint attached_defined (x theta : list R) (p : nat) (C : list formula) (lp : (p <= length theta)%nat) (f : formula) {struct f} :
  Formula.defined x theta (attached p C f) -> Formula.defined x (firstn p theta ++ map (Formula.value x theta) C) f.
Proof.
  destruct f as [o]. destruct o; cbn [attached Formula.defined map_op all_op defined_op]; rewrite <- ?(value_attached x theta p C lp); intro h; try exact h;
    repeat match goal with k : _ /\ _ |- _ => destruct k end; repeat split; eauto using attached_defined.
Qed.

Lemma rate_unit_pos : forall s l, 0 < rate_unit s l.
Proof. intros s [l | l]; cbn [rate_unit]; [lra | apply two_to_pos]. Qed.

Section Tip.
Variables (x theta : list R) (p : nat) (k : mobility) (s : Z) (l : driven) (g : evec -> drive_formulas) (C : evec).
Let ratio := / two_to s.
Let mu := rate_unit s l.
Hypothesis lp : (p <= length theta)%nat.
(** The drive's formulas are those of the leg, with whatever is in the place of other parameters. *)
Hypothesis drives : forall back F D, let th := firstn p theta ++ back in val3 x th F = vscale ratio (vadd D (offset l)) -> drives_as x th s (g F) l D.
Hypothesis well : well_formed_driven l.
Hypothesis built : Forall (Formula.defined x theta) (tip_built p g C).

Lemma row_moves : forall path c, has_velocity path 0 c -> own_reach l (path 0) -> (motion_of k = InPlane -> vz c = 0) -> val3 x theta C = vscale ratio (vadd (path 0) (offset l)) ->
  exists du, has_velocity (fun t => own_row l (path t)) 0 du /\
    mu * Vec3.dot du c = ratio * Vec3.dot c (mulv (valm x theta (tip_gradient k p C (b_divided (g (free_tip p))))) c).
Proof.
  intros path c hA reach c3 eC. assert (r0 : 0 < ratio) by (apply Rinv_0_lt_compat, two_to_pos).
  assert (mu0 : 0 < mu) by apply rate_unit_pos.
  set (th t := firstn p theta ++ coordinates (vscale ratio (vadd (path t) (offset l)))).
  assert (len : length (firstn p theta) = p) by (rewrite firstn_length; lia).
  assert (Free : forall t, val3 x (th t) (free_tip p) = vscale ratio (vadd (path t) (offset l))).
  { intro t. unfold val3, th, free_tip. cbn [ex ey ez Formula.value map_op real_op]. rewrite !app_nth2 by lia. rewrite len.
    replace (p - p)%nat with 0%nat by lia. replace (S p - p)%nat with 1%nat by lia. replace (S (S p) - p)%nat with 2%nat by lia. reflexivity. }
  assert (Drive : forall t, drives_as x (th t) s (g (free_tip p)) l (path t)) by (intro t; apply drives, Free).
  assert (Def : forall f, In f (tip_formulas p g) -> Formula.defined x (th 0) f).
  { intros f i. rewrite Forall_forall in built. pose proof (built _ (in_map (attached p (list_of C)) _ _ i)) as h. apply (attached_defined x theta p _ lp) in h.
    change (map (Formula.value x theta) (list_of C)) with (coordinates (val3 x theta C)) in h. rewrite eC in h. exact h. }
  pose (rate j := if Nat.eqb j p then ratio * vx c else if Nat.eqb j (S p) then ratio * vy c else if Nat.eqb j (S (S p)) then ratio * vz c else 0).
  assert (moves : forall j, derivable_pt_lim (fun u => nth j (th u) 0) 0 (rate j)).
  { intro j. destruct hA as [h1 [h2 h3]].
    assert (M : forall f b d, derivable_pt_lim f 0 d -> derivable_pt_lim (fun u => ratio * (f u + b)) 0 (ratio * d)).
    { intros f b d h. apply derivable_scal. apply derivable_eq with (fun u => f u + b) (d + 0); [apply derivable_add; [exact h | apply derivable_const] | reflexivity | ring]. }
    unfold th, rate. destruct (Nat.ltb_spec j p) as [lj | lj].
    - destruct (Nat.eqb_spec j p); [lia |]. destruct (Nat.eqb_spec j (S p)); [lia |]. destruct (Nat.eqb_spec j (S (S p))); [lia |].
      eapply derivable_eq; [apply (derivable_const (nth j (firstn p theta) 0)) | | reflexivity]. intro u. cbv beta. apply app_nth1. lia.
    - assert (E : forall u, nth j (firstn p theta ++ coordinates (vscale ratio (vadd (path u) (offset l)))) 0 = nth (j - p) (coordinates (vscale ratio (vadd (path u) (offset l)))) 0)
        by (intro u; rewrite app_nth2, len by lia; reflexivity).
      destruct (Nat.eqb_spec j p) as [-> |]; [| destruct (Nat.eqb_spec j (S p)) as [-> |]; [| destruct (Nat.eqb_spec j (S (S p))) as [-> |]]].
      + eapply derivable_eq; [exact (M _ (vx (offset l)) _ h1) | | reflexivity]. intro u. rewrite E. replace (p - p)%nat with 0%nat by lia. reflexivity.
      + eapply derivable_eq; [exact (M _ (vy (offset l)) _ h2) | | reflexivity]. intro u. rewrite E. replace (S p - p)%nat with 1%nat by lia. reflexivity.
      + eapply derivable_eq; [exact (M _ (vz (offset l)) _ h3) | | reflexivity]. intro u. rewrite E. replace (S (S p) - p)%nat with 2%nat by lia. reflexivity.
      + eapply derivable_eq; [apply (derivable_const 0) | | reflexivity]. intro u. rewrite E. apply nth_overflow. cbn. lia. }
  set (mo := motion_of k) in *.
  assert (once : NoDup (moving mo p)) by (destruct mo; cbn [moving]; repeat constructor; cbn [In]; lia).
  assert (stay : forall j, ~ In j (moving mo p) -> rate j = 0).
  { intros j n. unfold rate. destruct (Nat.eqb_spec j p) as [-> |]; [exfalso; apply n; destruct mo; left; reflexivity |].
    destruct (Nat.eqb_spec j (S p)) as [-> |]; [exfalso; apply n; destruct mo; right; left; reflexivity |].
    destruct (Nat.eqb_spec j (S (S p))) as [-> |]; [| reflexivity]. destruct mo; [rewrite (c3 eq_refl); ring | exfalso; apply n; right; right; left; reflexivity ..]. }
  assert (Gradient : forall f, Formula.defined x (th 0) f -> derivable_pt_lim (fun u => Formula.value x (th u) f) 0 (ratio * Vec3.dot (val3 x theta (slopes_by k p C f)) c)).
  { intros f d. eapply derivable_eq; [exact (derivatives_sound (moving mo p) x th 0 rate once moves stay f d) | reflexivity |].
    assert (E : map (Formula.value x (th 0)) (derivatives (moving mo p) f) = map (Formula.value x theta) (map (attached p (list_of C)) (derivatives (moving mo p) f))).
    { rewrite map_map. apply map_ext. intro h. rewrite value_attached by exact lp. unfold th. do 2 f_equal. change (map (Formula.value x theta) (list_of C)) with (coordinates (val3 x theta C)). rewrite eC. reflexivity. }
    rewrite E. unfold slopes_by, unit_slopes. fold mo. set (d' := map (attached p (list_of C)) (derivatives (moving mo p) f)).
    assert (ld : length d' = length (moving mo p)) by (unfold d', derivatives; rewrite !map_length; apply gradient_length).
    assert (rates : rate p = ratio * vx c /\ rate (S p) = ratio * vy c /\ rate (S (S p)) = ratio * vz c).
    { unfold rate. rewrite !Nat.eqb_refl. destruct (Nat.eqb_spec (S p) p); [lia |]. destruct (Nat.eqb_spec (S (S p)) p); [lia |]. destruct (Nat.eqb_spec (S (S p)) (S p)); [lia |]. auto. }
    destruct rates as [q1 [q2 q3]]. unfold Vec3.dot, val3. cbn [ex ey ez vx vy vz].
    destruct mo; cbn [moving length] in ld; destruct d' as [| f1 [| f2 [| f3 [|]]]]; try discriminate; cbn [moving map Linear.dot nth]; rewrite ?q1, ?q2, ?q3; [rewrite (c3 eq_refl) |..]; ring. }
  set (u := b_divided (g (free_tip p))) in *.
  (* near 0 the leg is reached *)
  assert (Near : exists e, 0 < e /\ forall t, Rabs (t - 0) < e -> own_reach l (path t)).
  { pose proof (Gradient _ (Def (b_D (g (free_tip p))) ltac:(unfold tip_formulas; cbn [In]; auto))) as hD.
    destruct (Drive 0) as [_ D0]. destruct (D0 well) as [_ [D1 _]]. destruct (positive_near _ _ _ hD (D1 reach)) as [e [e0 he]]. exists e. split; [exact e0 |].
    intros t ht. destruct (Drive t) as [_ Dt]. exact (proj1 (Dt well) (he t ht)). }
  destruct Near as [e [e0 near]].
  assert (Row : forall t, Rabs (t - 0) < e -> own_row l (path t) = vscale (/ mu) (val3 x (th t) u)).
  { intros t ht. destruct (Drive t) as [_ Dt]. destruct (Dt well) as [_ [_ [_ [_ D4]]]]. destruct (D4 (near t ht)) as [_ [E _]]. fold u mu in E. rewrite E.
    generalize (own_row l (path t)). intros [a b c']. unfold vscale. cbn [vx vy vz]. f_equal; field; lra. }
  exists (vscale (ratio / mu) (Vec (Vec3.dot (val3 x theta (slopes_by k p C (ex u))) c) (Vec3.dot (val3 x theta (slopes_by k p C (ey u))) c) (Vec3.dot (val3 x theta (slopes_by k p C (ez u))) c))).
  split.
  - assert (Each : forall (part : vec -> R) f, In f (tip_formulas p g) -> (forall q v, part (vscale q v) = q * part v) -> (forall t, part (val3 x (th t) u) = Formula.value x (th t) f) ->
      derivable_pt_lim (fun t => part (own_row l (path t))) 0 (ratio / mu * Vec3.dot (val3 x theta (slopes_by k p C f)) c)).
    { intros part f i lin is_part. apply (derivable_near (fun t => / mu * Formula.value x (th t) f) _ _ _ e e0).
      - intros t ht. rewrite (Row t ht), lin, is_part. reflexivity.
      - eapply derivable_eq; [exact (derivable_scal (/ mu) _ _ _ (Gradient f (Def f i))) | reflexivity | unfold Rdiv; ring]. }
    repeat split; cbn [vscale vx vy vz].
    + apply (Each vx (ex u)); [unfold tip_formulas; cbn [In]; auto | reflexivity | reflexivity].
    + apply (Each vy (ey u)); [unfold tip_formulas; cbn [In]; auto | reflexivity | reflexivity].
    + apply (Each vz (ez u)); [unfold tip_formulas; cbn [In]; auto | reflexivity | reflexivity].
  - unfold tip_gradient, valm. cbv zeta. fold mo. cbn [erow1 erow2 erow3]. unfold mulv. cbn [row1 row2 row3]. unfold Vec3.dot at 1 5. cbn [vx vy vz vscale].
    destruct mo; [rewrite (c3 eq_refl) |..]; field; lra.
Qed.

(** With the leg in a pose. *)
Variables (L : R) (P : vec) (Q : mat) (ell : formula) (r : evec).
Hypothesis reach : own_reach l (carried l P Q).
Hypothesis r_is : val3 x theta r = vscale ratio (mulv Q (offset l)).
Hypothesis C_is : val3 x theta C = vscale ratio (vadd P (mulv Q (offset l))).
Hypothesis length_is : match k with Turns _ => L <> 0 /\ Formula.value x theta ell = ratio * L | _ => True end.
(** The drive with its joint there; this value is that of its parameters alone. *)
Hypothesis drives_there : drives_as x theta s (g C) l (carried l P Q).

Definition bent_speed (v a : list R) : R :=
  Linear.dot (driven_row k L P Q l) a + ratio / mu / 2 * quad (map (map (Formula.value x theta)) (twice_bent k ell p g r C)) v.

Theorem leg_accelerates_so : forall v a y, joint_unit l y = bent_speed v a -> leg_accelerates k L l P Q v a y.
Proof.
  intros v a y ey. assert (r0 : 0 < ratio) by (apply Rinv_0_lt_compat, two_to_pos).
  assert (mu0 : 0 < mu) by apply rate_unit_pos.
  assert (L0 : match k with Turns _ => L <> 0 | _ => True end) by (destruct k; [exact I | exact I | exact (proj1 length_is)]).
  intros position turn velocity omega acceleration alpha eP eQ hp ht hv hw hk -> ->. rewrite ey. unfold bent_speed.
  set (V := velocity 0) in *. set (W := omega 0) in *. set (o := mulv Q (offset l)) in *.
  pose proof (carried_velocity l position turn 0 V W hp ht) as hc. cbv beta in hc. rewrite eQ in hc. fold o in hc. set (c := vadd V (cross W o)) in *.
  assert (c3 : motion_of k = InPlane -> vz c = 0).
  { intro e. unfold c, vadd, cross. cbn [vx vy vz]. destruct k as [| | []]; cbn [motion_of] in e; try discriminate; cbn [has_velocities is_of] in hk.
    - destruct hk as [h1 ->]. rewrite h1. unfold vzero. cbn [vx vy vz]. ring.
    - destruct hk as [h1 [h2 h3]]. rewrite h1, h2, h3. ring. }
  assert (e0 : vadd (carried l (position 0) (turn 0)) (offset l) = vadd P o).
  { rewrite eP, eQ. unfold carried. fold o. generalize o (offset l). intros [r1 r2 r3] [b1 b2 b3]. destruct P as [p1 p2 p3]. unfold vadd, vsub. cbn [vx vy vz]. f_equal; ring. }
  destruct (row_moves (fun t => carried l (position t) (turn t)) c hc) as [du [hdu e]]; [rewrite eP, eQ; exact reach | exact c3 | rewrite e0; exact C_is |].
  eapply derivable_eq; [exact (joint_bends k L l P Q V W position turn velocity omega acceleration alpha du L0 eP eQ eq_refl eq_refl ht hv hw hk hdu) | reflexivity |].
  rewrite Rplus_assoc. f_equal. fold o c. set (u := own_row l (carried l P Q)).
  assert (eu : val3 x theta (b_divided (g C)) = vscale mu u) by (destruct drives_there as [_ D]; destruct (D well) as [_ [_ [_ [_ D4]]]]; exact (proj1 (proj2 (D4 reach)))).
  unfold twice_bent. rewrite map_upper. set (U := tip_gradient k p C (b_divided (g (free_tip p)))) in *.
  rewrite (upper_ext _ _ _ (fun c d => real_entry (valm x theta U) (vscale mu u) (vscale ratio o) (Formula.value x theta ell) (val3 x theta (fst c), snd c) (val3 x theta (fst d), snd d)))
    by (intros; rewrite value_entry, eu, r_is; reflexivity).
  rewrite <- (upper_map _ _ _ (real_entry (valm x theta U) (vscale mu u) (vscale ratio o) (Formula.value x theta ell)) (fun c => (val3 x theta (fst c), snd c))), value_columns_of, r_is.
  assert (e' : Vec3.dot du c = ratio / mu * Vec3.dot c (mulv (valm x theta U) c)) by (apply Rmult_eq_reg_l with mu; [rewrite e; field; lra | lra]). rewrite e'. clear e e' hdu du.
  assert (hk' : has_velocities k V (vscale L W)).
  { clearbody V W. clear - hk. destruct k as [| | []]; cbn [has_velocities is_of] in *.
    - rewrite hk. unfold vscale, vzero. cbn [vx vy vz]. f_equal; ring.
    - destruct hk as [h1 ->]. split; [exact h1 |]. unfold vscale, vzero. cbn [vx vy vz]. f_equal; ring.
    - destruct hk as [h1 [h2 h3]]. split; [exact h1 |]. cbn [vscale vx vy]. rewrite h2, h3. split; ring.
    - exact I.
    - exact hk. }
  rewrite quad_bent by exact hk'.
  assert (K : match k with Turns _ => True | _ => W = vzero end) by (destruct k; cbn [has_velocities] in hk; [exact hk | exact (proj2 hk) | exact I]).
  assert (G : L <> 0 /\ Formula.value x theta ell = ratio * L \/ W = vzero) by (destruct k; [right; exact K | right; exact K | left; exact length_is]).
  destruct G as [[Ln el] | W0].
  - rewrite el. replace (vadd V (vscale (/ (ratio * L)) (cross (vscale L W) (vscale ratio o)))) with c
      by (unfold c; generalize V W o; intros [v1 v2 v3] [w1 w2 w3] [r1 r2 r3]; unfold vscale, vadd, cross; cbn [vx vy vz]; f_equal; field; split; assumption || lra).
    generalize (Vec3.dot c (mulv (valm x theta U) c)). intro z. generalize W o u. intros [w1 w2 w3] [r1 r2 r3] [u1 u2 u3].
    unfold Vec3.dot, norm2, vscale. cbn [vx vy vz]. field. repeat split; lra || assumption.
  - replace (vadd V (vscale (/ Formula.value x theta ell) (cross (vscale L W) (vscale ratio o)))) with c
      by (unfold c; rewrite W0; generalize V o; intros [v1 v2 v3] [r1 r2 r3]; unfold vscale, vadd, cross, vzero; cbn [vx vy vz]; f_equal; ring).
    generalize (Vec3.dot c (mulv (valm x theta U) c)). intro z. rewrite W0. generalize o u. intros [r1 r2 r3] [u1 u2 u3].
    unfold Rdiv. generalize (/ Formula.value x theta ell ^ 2). intro i.
    unfold Vec3.dot, norm2, vscale, vzero. cbn [vx vy vz]. field. lra.
Qed.
End Tip.

(** ** Tests *)

(** Sliders and struts of platforms that do not turn have their greatest accelerations by a sign, with t = L/|eta|. *)
Definition sign_of (f : pose_formulas) (dr : any_drive) (a b : formula) : option formula :=
  match dr, d_rod f with
  | LinearDrive (SliderLeg _), Some (e2, len) => let t := over len (root e2) in Some (minus (integer 1) (times t (plus a (times (over b len) (square t)))))
  | LinearDrive (StrutLeg _ _ _), Some (_, len) => Some (minus (minus (integer 1) a) (over b len))
  | _, _ => None
  end.
Definition may_turn (k : mobility) : bool := match k with Turns _ => true | _ => false end.
Definition is_by_sign (k : mobility) (dr : any_drive) : bool := negb (may_turn k) && match dr with LinearDrive _ => true | RotaryDrive _ => false end.
Definition is_plane_drive (dr : any_drive) : bool := match dr with LinearDrive (PlanarLeg _) => true | _ => false end.

Section Joint.
Variables (k : mobility) (placed : evec -> evec) (ell : formula) (p : nat) (f : pose_formulas) (z : any_drive * list formula) (q : list formula).
Let number n := nth n q (integer 0).
Let dr := fst z.
Definition greatest_of : formula * formula :=
  match dr with RotaryDrive _ => (over (number 0%nat) (number 2%nat), over (number 1%nat) (number 2%nat)) | LinearDrive _ => (number 0%nat, number 1%nat) end.
Definition joint_tip : evec := tip_of k dr (way_to placed dr (snd z)).
Definition joint_twice : list (list formula) := twice_bent k ell p (fun F => drive_from F dr (snd z)) (way_to placed dr (snd z)) joint_tip.
Definition joint_built : list formula := tip_built p (fun F => drive_from F dr (snd z)) joint_tip.
Definition joint_own : list formula :=
  let (a, b) := greatest_of in
  if is_by_sign k dr then match sign_of f dr a b with Some g => [g] | None => [] end
  else if is_plane_drive dr then [] else d_divided f ++ concat joint_twice ++ [a; b] ++ joint_built.
Definition joint_test (place : formula -> nat) : option test :=
  let (a, b) := greatest_of in
  if is_by_sign k dr then option_map (fun g => AtLeast (place g)) (sign_of f dr a b)
  else if is_plane_drive dr then None else Some (Curved (map place (d_divided f)) (map (map place) joint_twice) (place a) (place b) None (map place joint_built)).
End Joint.

Section Precision.
Variable bits : positive.
Definition accelerated_own (k : mobility) (placed : evec -> evec) (ell : formula) (p : nat) (fs : list pose_formulas) (zs : list (any_drive * list formula)) (q : list formula) (i : nat) : list formula :=
  match nth_error fs i, nth_error zs i with Some f, Some z => joint_own k placed ell p f z q | _, _ => [] end.
Definition accelerated_tests (place : formula -> nat) (k : mobility) (placed : evec -> evec) (ell : formula) (p : nat) (fs : list pose_formulas) (zs : list (any_drive * list formula)) (q : list formula)
    (i : nat) (a v b : number) : list (option test) :=
  [match nth_error fs i, nth_error zs i with
   | Some f, Some z => if certainly bits true b && (certainly bits false a && certainly bits false v) then joint_test k placed ell p f z q place else None
   | _, _ => None
   end].
End Precision.

(** ** Soundness *)

(** Platforms that do not turn: a path, and the vectors of these components. *)
Definition vector_in (l : list R) : vec := Vec (nth 0 l 0) (nth 1 l 0) (nth 2 l 0).
Lemma shifted : forall k ell l P Q position turn velocity omega acceleration alpha, may_turn k = false -> position 0 = P -> turn 0 = Q ->
  has_velocity position 0 (velocity 0) -> turns turn 0 (omega 0) -> has_velocity velocity 0 acceleration -> has_velocities k (velocity 0) (omega 0) ->
  let path t := carried l (position t) (turn t) in let V t := shifts_of k (velocity t) in
  path 0 = carried l P Q /\ has_velocity path 0 (V 0) /\ has_velocity V 0 (shifts_of k acceleration) /\
  V 0 = vector_in (velocities k (velocity 0) (vscale ell (omega 0))) /\ shifts_of k acceleration = vector_in (velocities k acceleration (vscale ell alpha)) /\
  forall t, Linear.dot (driven_row k ell (position t) (turn t) l) (velocities k (velocity t) (vscale ell (omega t))) = Vec3.dot (own_row l (path t)) (V t).
Proof.
  intros k ell l P Q position turn velocity omega acceleration alpha nt eP eQ hp ht hv hk path V. destruct (own_velocities k _ _ hk) as [sV _].
  assert (W : omega 0 = vzero) by (destruct k; [exact hk | exact (proj2 hk) | discriminate]).
  assert (S : forall w, shifts_of k w = vector_in (velocities k w (vscale ell vzero))) by (intros [a b c]; destruct k; [reflexivity | reflexivity | discriminate]).
  assert (S' : forall w w', velocities k w w' = velocities k w (vscale ell vzero)) by (intros w w'; destruct k; [reflexivity | reflexivity | discriminate]).
  split; [unfold path; rewrite eP, eQ; reflexivity |]. split.
  { pose proof (carried_velocity l position turn 0 _ _ hp ht) as h. cbv beta in h. unfold V. rewrite sV, W in *. replace (vadd (velocity 0) (cross vzero (mulv (turn 0) (offset l)))) with (velocity 0) in h; [exact h |].
    generalize (velocity 0) (mulv (turn 0) (offset l)). intros [a b c] [d e f]. unfold vadd, cross, vzero. cbn [vx vy vz]. f_equal; ring. }
  split; [exact (proj1 (velocity_parts_of k _ _ _ hv)) |]. split; [unfold V; rewrite (S' _ (vscale ell (omega 0))); apply S |]. split; [rewrite (S' _ (vscale ell alpha)); apply S |].
  intro t. unfold driven_row. cbv zeta. rewrite velocities_dot by (destruct k; [exact I | exact I | discriminate]). fold (path t). f_equal. unfold V.
  replace (spins_of k (omega t)) with vzero by (destruct k; [reflexivity | reflexivity | discriminate]).
  generalize (shifts_of k (velocity t)) (mulv (turn t) (offset l)). intros [a b c] [d e f]. unfold vadd, cross, vzero. cbn [vx vy vz]. f_equal; ring.
Qed.

Lemma vector_size : forall k v, may_turn k = false -> length v = freedom k -> norm2 (vector_in v) = Linear.dot v v.
Proof.
  intros k v nt lv. destruct k; [| | discriminate]; cbn [freedom] in lv; destruct v as [| a [| b [| c [| ? ?]]]]; try discriminate; unfold norm2, vector_in; cbn; ring.
Qed.

Lemma twice_two : forall r, two_to (r + r) = two_to r ^ 2.
Proof. intro r. rewrite !two_to_power, powerRZ_add by lra. ring. Qed.

(** What a leg's acceleration is along one path it is along all with that velocity. *)
Lemma accelerates_as : forall k ell l P Q (f : vec -> vec -> R) p q b, may_turn k = false ->
  (forall path V a, path 0 = carried l P Q -> has_velocity path 0 (V 0) -> has_velocity V 0 a -> derivable_pt_lim (fun t => Vec3.dot (own_row l (path t)) (V t)) 0 (f (V 0) a) /\
    (norm2 (V 0) <= q ^ 2 -> norm2 a <= p ^ 2 -> Rabs (f (V 0) a) <= b)) ->
  match l with Linear _ => True | Rotary _ => False end ->
  forall v a, length v = freedom k -> length a = freedom k -> Linear.dot v v <= q ^ 2 -> Linear.dot a a <= p ^ 2 -> exists y, leg_accelerates k ell l P Q v a y /\ Rabs y <= b.
Proof.
  intros k ell l P Q f p q b nt h lin v a lv la hv ha. exists (f (vector_in v) (vector_in a)). split.
  - intros position turn velocity omega acceleration alpha eP eQ hp ht hvel _ hk ev ea.
    destruct (shifted k ell l P Q position turn velocity omega acceleration alpha nt eP eQ hp ht hvel hk) as [e0 [h1 [h2 [e1 [e2 e3]]]]]. destruct l as [l | l]; [| contradiction]. cbn [joint_unit].
    rewrite ev, ea, <- e1, <- e2. eapply derivable_eq; [exact (proj1 (h _ (fun t => shifts_of k (velocity t)) _ e0 h1 h2)) | exact e3 | reflexivity].
  - destruct (moved_velocity (carried l P Q) (vector_in v) (vector_in a)) as [m0 [m1 m2]].
    pose proof (h (moved (carried l P Q) (vector_in v) (vector_in a)) (fun t => vadd (vector_in v) (vscale t (vector_in a))) (vector_in a) m0 m1 m2) as [_ K]. cbv beta in K.
    replace (vadd (vector_in v) (vscale 0 (vector_in a))) with (vector_in v) in K by (generalize (vector_in v) (vector_in a); intros [c d e] [c' d' e']; unfold vadd, vscale; cbn [vx vy vz]; f_equal; ring).
    apply K; rewrite (vector_size k) by assumption; assumption.
Qed.

Section Fulfilled.
Variable bits : positive.
Variables (x th rest : list R) (s : Z) (k : mobility) (placed : evec -> evec) (ell : formula) (L : R) (P : vec) (Q : mat) (tape : list (op address)) (whole divided : rows nat) (partial : list nat) (params : list fixed).
Let theta := th ++ rest.
Local Notation value := (Formula.value x theta).
Local Notation found := (place (formulas tape)).
Variables (f : pose_formulas) (z : any_drive * list formula) (l : driven) (q : list formula) (a v b : number) (i : nat).
Hypothesis drives : forall back, drives_from s x (th ++ back) z l.
Hypothesis there : drives_there x theta s P Q (drive_at k placed (fst z) (snd z)) l.
Hypothesis place_is : val3 x theta (eplace k) = vscale (/ two_to s) P.
Hypothesis length_is : match k with Turns _ => L <> 0 /\ value ell = / two_to s * L | _ => True end.
Hypothesis well : well_formed_driven l.
Hypothesis reach : own_reach l (carried l P Q).
Hypothesis row_is : map value (d_divided f) = map (Rmult (rate_unit s l)) (driven_row k L P Q l).
Hypothesis rod_is : match d_rod f with Some (e2, len) => exists o, driven_rod k P Q l = Some o /\ value e2 = (/ two_to s * rod_eta o) ^ 2 /\ value len = / two_to s * rod_size o | None => True end.
Hypothesis same_kind : match fst z, l with LinearDrive (SliderLeg _), Linear (Guided _) | LinearDrive (StrutLeg _ _ _), Linear (Extensible _ _ _) | LinearDrive (PlanarLeg _), Linear (Plane _) | RotaryDrive _, Rotary _ => True | _, _ => False end.
Hypothesis numbers : map value q = map input_value (inputs_of match fst z with RotaryDrive _ => true | _ => false end s (AccelerationMax i a v b)).
Hypothesis own_found : forall g, In g (joint_own k placed ell (length th) f z q) -> formula_at tape (found g) = g.
Hypothesis b0 : 0 < Claim.value b.
Hypothesis a0 : 0 <= Claim.value a.
Hypothesis v0 : 0 <= Claim.value v.

Lemma joint_number : forall j, value (nth j q (integer 0)) = nth j (map input_value (inputs_of match fst z with RotaryDrive _ => true | _ => false end s (AccelerationMax i a v b))) 0.
Proof. intro j. rewrite <- numbers. symmetry. exact (map_nth value q (integer 0) j). Qed.

Theorem joint_met : forall t, joint_test k placed ell (length th) f z q found = Some t -> Check.holds bits tape whole divided partial params theta (freedom k) x t ->
  forall v' a', length v' = freedom k -> length a' = freedom k -> Linear.dot v' v' <= Claim.value v ^ 2 -> Linear.dot a' a' <= Claim.value a ^ 2 ->
  exists y, leg_accelerates k L l P Q v' a' y /\ Rabs y <= Claim.value b.
Proof.
  intros t et H. assert (u0 : 0 < / two_to s) by (apply Rinv_0_lt_compat, two_to_pos). pose proof joint_number as Num. unfold joint_test, joint_own in *. destruct (greatest_of z q) as [fa fb] eqn:eg. unfold greatest_of in eg.
  assert (n0 : (0 < freedom k)%nat) by (destruct k as [| | []]; cbn; lia).
  destruct (is_by_sign k (fst z)) eqn:by_sign.
  - apply andb_true_iff in by_sign as [nt _]. apply negb_true_iff in nt. destruct (sign_of f (fst z) fa fb) as [g |] eqn:sg; [| discriminate]. injection et as <-.
    cbn [Check.holds] in H. unfold is_nonneg in H. rewrite own_found in H by (left; reflexivity). destruct H as [_ H]. unfold sign_of in sg.
    destruct (fst z) as [[c | ? ? ? | ?] | ?]; try discriminate; injection eg as <- <-; cbn [inputs_of map nth input_value Claim.value] in Num; pose proof (Num 0%nat) as N0; pose proof (Num 1%nat) as N1; cbn [nth] in N0, N1.
    + destruct l as [[g' | ? ? ? | ?] | ?]; try contradiction. destruct (d_rod f) as [[e2 len] |]; [| discriminate]. injection sg as <-. destruct rod_is as [o [eo [v1 v2]]].
      cbn [driven_rod own_rod option_map] in eo. injection eo as <-. cbn [rod_eta rod_size] in v1, v2. set (C := carried (Linear (Guided g')) P Q) in *. cbn [own_reach reaches] in reach. cbn [well_formed_driven well_formed_leg] in well.
      assert (E : sqrt ((/ two_to s * eta g' C) ^ 2) = / two_to s * Kinematics.s g' C).
      { assert (Sq : (/ two_to s * eta g' C) ^ 2 = (/ two_to s * Kinematics.s g' C) ^ 2) by (unfold eta; rewrite !Rpow_mult_distr, (mode_squared g' well); ring).
        rewrite Sq. apply sqrt_pow2, Rmult_le_pos; lra. }
      set (T := leg_length g' / Kinematics.s g' C). assert (L0 : 0 < leg_length g') by exact (proj1 (proj2 well)).
      assert (B : T * (Claim.value a + Claim.value v ^ 2 / leg_length g' * T ^ 2) <= Claim.value b).
      { rewrite value_minus, value_times, value_plus, value_times, Formula.value_square, !value_over, value_root, v1, E, v2, N0, N1 in H. change (value (integer 1)) with 1 in H. change (two_to 0) with 1 in H.
        replace (/ two_to s * leg_length g' / (/ two_to s * Kinematics.s g' C)) with T in H by (unfold T; field; repeat split; try lra; apply Rgt_not_eq, two_to_pos).
        replace (Claim.value v * Claim.value v / Claim.value b / two_to s / (/ two_to s * leg_length g')) with (Claim.value v ^ 2 / leg_length g' / Claim.value b) in H by (pose proof (two_to_pos s); field; repeat split; lra).
        apply Rmult_le_reg_r with (/ Claim.value b); [apply Rinv_0_lt_compat, b0 |]. rewrite Rinv_r by lra.
        replace (T * (Claim.value a + Claim.value v ^ 2 / leg_length g' * T ^ 2) * / Claim.value b) with (T * (Claim.value a / Claim.value b / 1 + Claim.value v ^ 2 / leg_length g' / Claim.value b * T ^ 2)) by (field; lra). lra. }
      refine (accelerates_as k L (Linear (Guided g')) P Q (fun V A => Vec3.dot (vadd (axis g') (vscale (working_mode g' / Kinematics.s g' C) (r g' C))) A +
        working_mode g' * ((norm2 V - Vec3.dot (axis g') V ^ 2) / Kinematics.s g' C + Vec3.dot (r g' C) V ^ 2 / Kinematics.s g' C ^ 3)) _ _ _ nt _ I).
      intros path V A e0 hp hv. fold C in e0. assert (re : 0 < Kinematics.s g' (path 0)) by (rewrite e0; exact reach). pose proof (slider_accelerates g' path V A well re hp hv) as D. rewrite e0 in D. split; [exact D |].
      intros hV hA. destruct (slider_acceleration g' path V A well re hp hv) as [y [hy bound]]. rewrite e0 in bound. rewrite <- (uniqueness_limite _ _ _ _ hy D).
      exact (Rle_trans _ _ _ (bound _ _ a0 hV hA) B).
    + destruct l as [[? | e0_ e1_ ax | ?] | ?]; try contradiction. destruct (d_rod f) as [[e2 len] |]; [| discriminate]. injection sg as <-. destruct rod_is as [o [eo [_ v2]]].
      cbn [driven_rod own_rod option_map] in eo. injection eo as <-. cbn [rod_size] in v2. set (C := carried (Linear (Extensible e0_ e1_ ax)) P Q) in *. cbn [own_reach reaches] in reach.
      pose proof (sqrt_lt_R0 _ reach) as z0. set (w := sqrt (norm2 (span e0_ e1_ C))) in *.
      assert (B : Claim.value a + Claim.value v ^ 2 / w <= Claim.value b).
      { rewrite !value_minus, value_over, v2, N0, N1 in H. change (value (integer 1)) with 1 in H. change (two_to 0) with 1 in H.
        replace (Claim.value v * Claim.value v / Claim.value b / two_to s / (/ two_to s * w)) with (Claim.value v ^ 2 / w / Claim.value b) in H by (pose proof (two_to_pos s); field; repeat split; lra).
        apply Rmult_le_reg_r with (/ Claim.value b); [apply Rinv_0_lt_compat, b0 |]. rewrite Rinv_r by lra.
        replace ((Claim.value a + Claim.value v ^ 2 / w) * / Claim.value b) with (Claim.value a / Claim.value b / 1 + Claim.value v ^ 2 / w / Claim.value b) by (field; lra). lra. }
      refine (accelerates_as k L (Linear (Extensible e0_ e1_ ax)) P Q (fun V A => ((norm2 V + Vec3.dot (span e0_ e1_ C) A) * w - (/ w * Vec3.dot (span e0_ e1_ C) V) * Vec3.dot (span e0_ e1_ C) V) / Rsqr w) _ _ _ nt _ I).
      intros path V A e0 hp hv. fold C in e0. assert (re : 0 < norm2 (span e0_ e1_ (path 0))) by (rewrite e0; exact reach). pose proof (Acceleration.strut_accelerates e0_ e1_ path V A re hp hv) as D. cbv zeta in D. rewrite e0 in D. fold w in D. split; [exact D |].
      intros hV hA. destruct (strut_acceleration e0_ e1_ path V A re hp hv) as [y [hy bound]]. rewrite e0 in bound. fold w in bound. rewrite <- (uniqueness_limite _ _ _ _ hy D).
      exact (Rle_trans _ _ _ (bound _ _ a0 hV hA) B).
  - destruct (is_plane_drive (fst z)) eqn:plane; [discriminate |]. injection et as <-. cbn [Check.holds] in H. cbv zeta in H. destruct H as [built H].
    assert (built' : Forall (fun n => Formula.defined x theta (formula_at tape n)) (map found (joint_built k placed (length th) z))) by exact built. clear built. rename built' into built.
    set (g := fun F => drive_from F (fst z) (snd z)) in *. set (r := way_to placed (fst z) (snd z)) in *. set (C := tip_of k (fst z) r) in *.
    fold (joint_tip k placed z) in C. 
    assert (F : forall e, In e (d_divided f ++ concat (joint_twice k placed ell (length th) z) ++ [fa; fb] ++ joint_built k placed (length th) z) -> value (formula_at tape (found e)) = value e) by (intros e ie; rewrite own_found by exact ie; reflexivity).
    assert (R1 : map (fun n => value (formula_at tape n)) (map found (d_divided f)) = map (Rmult (rate_unit s l)) (driven_row k L P Q l))
      by (rewrite map_map, <- row_is; apply map_ext_in; intros e ie; apply F, in_or_app; left; exact ie).
    assert (R2 : map (map (fun n => value (formula_at tape n))) (map (map found) (joint_twice k placed ell (length th) z)) = map (map value) (joint_twice k placed ell (length th) z)).
    { rewrite map_map. apply map_ext_in. intros w iw. rewrite map_map. apply map_ext_in. intros e ie. apply F. apply in_or_app. right. apply in_or_app. left. apply in_concat. exists w. split; assumption. }
    assert (R3 : value (formula_at tape (found fa)) = value fa /\ value (formula_at tape (found fb)) = value fb) by (split; apply F; do 2 (apply in_or_app; right); cbn [app In]; auto).
    destruct R3 as [R3 R4]. rewrite R1, R2, R3, R4 in H.
    assert (B : Forall (Formula.defined x theta) (tip_built (length th) g C)).
    { apply Forall_forall. intros e ie. rewrite Forall_map, Forall_forall in built. specialize (built e ie). rewrite own_found in built; [exact built |]. do 3 (apply in_or_app; right). exact ie. }
    assert (firstn_th : firstn (length th) theta = th) by (unfold theta; rewrite firstn_app, firstn_all, Nat.sub_diag; cbn [firstn]; apply app_nil_r).
    assert (lp : (length th <= length theta)%nat) by (unfold theta; rewrite app_length; lia).
    destruct there as [T1 T2]. cbn [drive_at fst snd] in T1, T2. fold r in T1, T2. fold C in T1.
    assert (Ct : val3 x theta C = vscale (/ two_to s) (vadd P (mulv Q (offset l)))).
    { unfold C, joint_tip, tip_of. fold r. destruct (fst z) as [[] |]; try discriminate; rewrite val3_plus, place_is, T2; generalize (mulv Q (offset l)); intros [o1 o2 o3]; destruct P as [p1 p2 p3]; unfold vadd, vscale; cbn [vx vy vz]; f_equal; ring. }
    pose proof (rate_unit_pos s l) as m0. set (mu := rate_unit s l) in *. set (row := driven_row k L P Q l) in *. set (Hs := map (map value) (joint_twice k placed ell (length th) z)) in *.
    pose (b' := match l with Linear _ => Claim.value b | Rotary _ => in_degrees (Claim.value b) end).
    assert (d0 : 0 < in_degrees 1) by (unfold in_degrees; pose proof PI_RGT_0; lra).
    assert (b0' : 0 < b') by (unfold b'; destruct l; [exact b0 | unfold in_degrees; pose proof PI_RGT_0; apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; assumption | lra]]).
    assert (V : value fa * mu = Claim.value a / b' /\ value fb = / two_to s / mu * (Claim.value v * Claim.value v / b')).
    { unfold mu, b'. pose proof (two_to_pos s) as t0. destruct (fst z) as [dr | dr], l as [l' | l']; try (destruct dr; contradiction); injection eg as <- <-; cbn [rate_unit]; rewrite ?value_over, ?Num; cbn [inputs_of map nth input_value Claim.value];
        change (two_to 0) with 1.
      - split; field; repeat split; lra.
      - rewrite twice_two. replace (in_degrees (1 / 1 / 1)) with (in_degrees 1) by (f_equal; field). replace (in_degrees (Claim.value b)) with (Claim.value b * in_degrees 1) by (unfold in_degrees; field). split; field; repeat split; lra. }
    destruct V as [V1 V2].
    assert (nonneg_a : 0 <= value fa).
    { apply Rmult_le_reg_r with mu; [exact m0 |]. rewrite Rmult_0_l, V1. apply Rmult_le_pos; [exact a0 | apply Rlt_le, Rinv_0_lt_compat, b0']. }
    specialize (H nonneg_a I). intros v' a' lv la hv ha.
    assert (bound : Rabs (bent_speed x theta (length th) k s l g C L P Q ell r v' a') <= b').
    { apply (acceleration_bounded (freedom k) row a' Hs v' (value fa * mu) (value fb) (/ two_to s / mu) (Claim.value a) (Claim.value v) b' n0 a0 v0 b0' V1 V2); try assumption.
      intros e w he lw nz. specialize (H e w he lw nz). rewrite dot_map in H. replace (value fa * mu * Linear.dot row e) with (value fa * (mu * Linear.dot row e)) by ring. exact H. }
    assert (All : forall y, joint_unit l y = bent_speed x theta (length th) k s l g C L P Q ell r v' a' -> leg_accelerates k L l P Q v' a' y).
    { intros y ey. refine (leg_accelerates_so x theta (length th) k s l g C lp _ well B L P Q ell r reach T2 Ct length_is T1 v' a' y ey).
      intros back F' D. cbv zeta. rewrite firstn_th. exact (drives back F' D). }
    set (y0 := bent_speed _ _ _ _ _ _ _ _ _ _ _ _ _ _ _) in *.
    destruct l as [l' | l']; unfold b' in bound; cbn [joint_unit] in All.
    + exists y0. split; [apply All; reflexivity | exact bound].
    + exists (y0 * 180 / PI). pose proof PI_RGT_0 as p0. split; [apply All; unfold in_degrees; field; lra |].
      replace (y0 * 180 / PI) with (y0 * (180 / PI)) by (field; lra). rewrite Rabs_mult, (Rabs_right (180 / PI)) by (apply Rle_ge, Rlt_le, Rdiv_lt_0_compat; lra).
      apply Rmult_le_reg_r with (PI / 180); [lra |]. replace (Rabs y0 * (180 / PI) * (PI / 180)) with (Rabs y0) by (field; lra). unfold in_degrees in bound. lra.
Qed.
End Fulfilled.
End Named.
