(** * Accelerations of struts of platforms that turn

    With the leg's unit vector u, its lever r, U = du/dC of its end C = P + r, and C' = v + omega x r, the leg's speed row . (v, ell omega)
    has the derivative row . (v', ell omega') + C' . U C' + (u . omega) (r . omega) - (u . r) |omega|^2. As formulas: motion.rs. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Solve Check.
From Orthocert.kernel Require Import Linear Configuration Statement Formula Gradient Machine Acceleration Orientation Turning Chart.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** Formulas with others in the place of parameters *)

(** From [p] on. *)
Fixpoint attached (p : nat) (C : list formula) (f : formula) : formula :=
  match f with F o => match o with Param j => if Nat.ltb j p then f else nth (j - p) C (integer 0) | _ => F (map_op (attached p C) o) end end.

Lemma value_attached : forall x theta p C, (p <= length theta)%nat -> forall f, value x theta (attached p C f) = value x (firstn p theta ++ map (value x theta) C) f.
Proof.
  intros x theta p C lp. fix IH 1. intros [o]. destruct o; cbn [attached value map_op real_op]; rewrite ?IH; try reflexivity.
  assert (len : length (firstn p theta) = p) by (rewrite firstn_length; lia).
  destruct (Nat.ltb_spec j p) as [l | l].
  - cbn [value map_op real_op]. rewrite app_nth1 by lia. rewrite <- (firstn_skipn p theta) at 1. apply app_nth1. lia.
  - rewrite app_nth2, len by lia. symmetry. exact (map_nth (value x theta) C (integer 0) _).
Qed.

(** ** The derivative of a unit vector by where it ends *)

Definition own_unit (p : nat) (a : evec) : evec := let w := map2 minus (EVec (F (Param p)) (F (Param (S p))) (F (Param (S (S p))))) a in divided_by w (root (product w w)).
Definition moving (k : motion) (p : nat) : list nat := match k with InPlane => [p; S p] | _ => [p; S p; S (S p)] end.
Definition unit_slopes (k : motion) (p : nat) (a C : evec) (f : formula) : evec :=
  let d := map (attached p (list_of C)) (derivatives (moving k p) f) in EVec (nth 0 d (integer 0)) (nth 1 d (integer 0)) (nth 2 d (integer 0)).
Definition unit_gradient (k : motion) (p : nat) (a C : evec) : emat :=
  let u := own_unit p a in
  EMat (unit_slopes k p a C (ex u)) (unit_slopes k p a C (ey u))
    match k with InPlane => EVec (integer 0) (integer 0) (integer 0) | _ => unit_slopes k p a C (ez u) end.

(** ** 2 H *)

Definition ecross (a b : evec) : evec :=
  EVec (minus (times (ey a) (ez b)) (times (ez a) (ey b))) (minus (times (ez a) (ex b)) (times (ex a) (ez b)))
    (minus (times (ex a) (ey b)) (times (ey a) (ex b))).
Definition along (i : nat) (u : evec) : formula := match i with O => ex u | S O => ey u | _ => ez u end.
Definition unit_along (i : nat) : evec := let at_ j := integer (if Nat.eqb i j then 1 else 0) in EVec (at_ 0%nat) (at_ 1%nat) (at_ 2%nat).
(** How the end moves with each component of the twist, and of which component of omega that is. *)
Definition columns (k : motion) (r : evec) (ell : formula) : list (evec * option nat) :=
  let shift i := (unit_along i, None) in let spin i := (divided_by (ecross (unit_along i) r) ell, Some i) in
  match k with InPlane => [shift 0; shift 1; spin 2] | InSpace => [shift 0; shift 1; shift 2; spin 0; spin 1; spin 2] | AboutPoint => [spin 0; spin 1; spin 2] end%nat.
(** (U + U^T) c *)
Definition both_ways (U : emat) (c : evec) : evec :=
  let of (row : evec) (j : nat) :=
    plus (plus (plus (integer 0) (times (plus (ex row) (along j (erow1 U))) (ex c))) (times (plus (ey row) (along j (erow2 U))) (ey c))) (times (plus (ez row) (along j (erow3 U))) (ez c)) in
  EVec (of (erow1 U) 0%nat) (of (erow2 U) 1%nat) (of (erow3 U) 2%nat).
Definition bend_entry (U : emat) (u r : evec) (ell : formula) (c d : evec * option nat) : formula :=
  let own := product (fst c) (both_ways U (fst d)) in
  match snd c, snd d with
  | Some i, Some j =>
      let both := plus (times (along i u) (along j r)) (times (along j u) (along i r)) in
      plus own (over (if Nat.eqb i j then minus both (times (integer 2) (product u r)) else both) (square ell))
  | _, _ => own
  end.
Fixpoint upper {A B : Type} (f : A -> A -> B) (l : list A) : list (list B) := match l with [] => [] | c :: l' => map (f c) l :: upper f l' end.

Section Values.
Variables x theta : list R.
Local Notation value := (value x theta).
Local Notation val3 := (val3 x theta).
Local Notation valm := (valm x theta).

Lemma val3_minus : forall u v, val3 (map2 minus u v) = vsub (val3 u) (val3 v).
Proof. intros. unfold val3, map2, vsub. cbn [ex ey ez vx vy vz]. rewrite !value_minus. reflexivity. Qed.
Lemma val3_plus : forall u v, val3 (map2 plus u v) = vadd (val3 u) (val3 v).
Proof. intros. unfold val3, map2, vadd. cbn [ex ey ez vx vy vz]. rewrite !value_plus. reflexivity. Qed.
Lemma val3_scaled : forall a u, val3 (Machine.scaled a u) = vscale (value a) (val3 u).
Proof. intros. unfold val3, Machine.scaled, vscale. cbn [ex ey ez vx vy vz]. rewrite !value_times. reflexivity. Qed.
Lemma val3_divided : forall u a, val3 (divided_by u a) = vscale (/ value a) (val3 u).
Proof. intros. unfold val3, divided_by, vscale. cbn [ex ey ez vx vy vz]. rewrite !value_over. unfold Rdiv. f_equal; ring. Qed.
Lemma val3_cross : forall u v, val3 (ecross u v) = cross (val3 u) (val3 v).
Proof. intros. unfold val3, ecross, cross. cbn [ex ey ez vx vy vz]. rewrite !value_minus, !value_times. reflexivity. Qed.

Definition component (i : nat) (v : vec) : R := match i with O => vx v | S O => vy v | _ => vz v end.
Definition axis_along (i : nat) : vec := match i with O => e1 | S O => e2 | _ => e3 end.
Lemma value_along : forall i u, value (along i u) = component i (val3 u).
Proof. intros [| [|]] u; reflexivity. Qed.
Lemma val3_both_ways : forall U c, val3 (both_ways U c) = vadd (mulv (valm U) (val3 c)) (mulv (transpose (valm U)) (val3 c)).
Proof.
  intros U c. unfold val3 at 1, both_ways. cbv zeta. cbn [ex ey ez along]. rewrite !value_plus, !value_times, !value_plus.
  unfold mulv, transpose, col1, col2, col3, vadd, Vec3.dot, Chart.valm, Chart.val3. cbn [vx vy vz row1 row2 row3]. change (value (integer 0)) with 0. f_equal; ring.
Qed.
Definition real_entry (U : mat) (u r : vec) (ell : R) (c d : vec * option nat) : R :=
  Vec3.dot (fst c) (vadd (mulv U (fst d)) (mulv (transpose U) (fst d))) +
  match snd c, snd d with
  | Some i, Some j => (component i u * component j r + component j u * component i r - if Nat.eqb i j then 2 * Vec3.dot u r else 0) / ell ^ 2
  | _, _ => 0
  end.
Lemma value_entry : forall U u r ell c d, value (bend_entry U u r ell c d) =
  real_entry (valm U) (val3 u) (val3 r) (value ell) (val3 (fst c), snd c) (val3 (fst d), snd d).
Proof.
  intros U u r ell [c i] [d j]. unfold bend_entry, real_entry. cbv zeta. cbn [fst snd]. destruct i as [i |], j as [j |]; rewrite ?value_plus, value_dot, val3_both_ways; try ring.
  rewrite value_over, Formula.value_square. f_equal. f_equal. destruct (Nat.eqb i j).
  - rewrite value_minus, value_plus, !value_times, !value_along, value_dot. reflexivity.
  - rewrite value_plus, !value_times, !value_along. ring.
Qed.

Definition real_columns (k : motion) (r : vec) (ell : R) : list (vec * option nat) :=
  let shift i := (axis_along i, None) in let spin i := (vscale (/ ell) (cross (axis_along i) r), Some i) in
  match k with InPlane => [shift 0; shift 1; spin 2] | InSpace => [shift 0; shift 1; shift 2; spin 0; spin 1; spin 2] | AboutPoint => [spin 0; spin 1; spin 2] end%nat.
Lemma value_columns : forall k r ell, map (fun c => (val3 (fst c), snd c)) (columns k r ell) = real_columns k (val3 r) (value ell).
Proof.
  intros k r ell. assert (U : forall i, (i < 3)%nat -> val3 (unit_along i) = axis_along i) by (intros [| [| [|]]] h; try reflexivity; lia).
  assert (S : forall i, (i < 3)%nat -> val3 (divided_by (ecross (unit_along i) r) ell) = vscale (/ value ell) (cross (axis_along i) (val3 r)))
    by (intros i h; rewrite val3_divided, val3_cross, U by exact h; reflexivity).
  destruct k; unfold columns, real_columns; cbv zeta; cbn [map fst snd]; rewrite ?S, ?U by lia; reflexivity.
Qed.
Lemma map_upper : forall (A B C : Type) (f : A -> A -> B) (g : B -> C) l, map (map g) (upper f l) = upper (fun a b => g (f a b)) l.
Proof. induction l as [| c l IH]; cbn [upper map]; [reflexivity |]. rewrite IH, map_map. reflexivity. Qed.
Lemma upper_map : forall (A B C : Type) (f : A -> A -> B) (h : C -> A) l, upper f (map h l) = upper (fun a b => f (h a) (h b)) l.
Proof. induction l as [| c l IH]; cbn [upper map]; [reflexivity |]. rewrite IH, map_map. reflexivity. Qed.
Lemma upper_ext : forall (A B : Type) (f g : A -> A -> B) l, (forall a b, f a b = g a b) -> upper f l = upper g l.
Proof. intros A B f g l h. induction l as [| c l IH]; cbn [upper map]; [reflexivity |]. rewrite IH, h. do 2 f_equal. apply map_ext. apply h. Qed.
End Values.

Lemma quad_bend : forall k U u r ell v w, is_of k v w ->
  let C := vadd v (vscale (/ ell) (cross w r)) in
  quad (upper (real_entry U u r ell) (real_columns k r ell)) (twist k v w) =
    2 * Vec3.dot C (mulv U C) + 2 * (Vec3.dot u w * Vec3.dot r w - Vec3.dot u r * norm2 w) / ell ^ 2.
Proof.
  intros k [[a1 a2 a3] [b1 b2 b3] [c1 c2 c3]] [u1 u2 u3] [r1 r2 r3] ell [v1 v2 v3] [w1 w2 w3] h. cbv zeta.
  destruct k; cbn [is_of vx vy vz] in h; [destruct h as [-> [-> ->]] | clear h | injection h as -> -> ->];
    unfold real_columns, real_entry, axis_along, e1, e2, e3, cross, vscale, vadd, mulv, transpose, col1, col2, col3, Vec3.dot, norm2, twist, Rdiv;
    cbn [upper map fst snd Nat.eqb component quad row_form Linear.dot vx vy vz row1 row2 row3]; rewrite <- ?pow_inv; generalize (/ ell); intro i; ring.
Qed.

(** ** Kinematics *)

(** The components of a velocity and of an angular velocity that a motion has. *)
Definition shifts (k : motion) (v : vec) : vec := match k with InPlane => Vec (vx v) (vy v) 0 | InSpace => v | AboutPoint => vzero end.
Definition spins (k : motion) (w : vec) : vec := match k with InPlane => Vec 0 0 (vz w) | _ => w end.
Lemma twist_dot : forall k ell u r v w, ell <> 0 -> Linear.dot (twist k u (vscale (/ ell) (cross r u))) (twist k v (vscale ell w)) = Vec3.dot u (vadd (shifts k v) (cross (spins k w) r)).
Proof.
  intros k ell [u1 u2 u3] [r1 r2 r3] [v1 v2 v3] [w1 w2 w3] l0. destruct k; unfold twist, shifts, spins, Vec3.dot, vadd, vscale, cross, vzero; cbn [Linear.dot vx vy vz]; field; exact l0.
Qed.
Lemma own_parts : forall k v w, is_of k v w -> shifts k v = v /\ spins k w = w.
Proof. intros k [v1 v2 v3] [w1 w2 w3] h. destruct k; cbn [is_of vx vy vz] in h; [destruct h as [-> [-> ->]] | | injection h as -> -> ->]; split; reflexivity. Qed.
Lemma velocity_sum : forall f g t v w, has_velocity f t v -> has_velocity g t w -> has_velocity (fun u => vadd (f u) (g u)) t (vadd v w).
Proof. intros f g t v w [f1 [f2 f3]] [g1 [g2 g3]]. repeat split; cbn [vadd vx vy vz]; apply derivable_add; assumption. Qed.
Lemma velocity_cross : forall f g t v w, has_velocity f t v -> has_velocity g t w -> has_velocity (fun u => cross (f u) (g u)) t (vadd (cross v (g t)) (cross (f t) w)).
Proof.
  intros f g t v w [f1 [f2 f3]] [g1 [g2 g3]].
  assert (K : forall a b c d a' b' c' d' e, derivable_pt_lim a t a' -> derivable_pt_lim b t b' -> derivable_pt_lim c t c' -> derivable_pt_lim d t d' ->
    e = (a' * b t + a t * b') - (c' * d t + c t * d') -> derivable_pt_lim (fun u => a u * b u - c u * d u) t e)
    by (intros; subst; apply derivable_pt_lim_minus; apply derivable_times; assumption).
  repeat split; cbn [vadd cross vx vy vz]; eapply K; eauto; ring.
Qed.
Lemma velocity_parts : forall k f t v, has_velocity f t v -> has_velocity (fun u => shifts k (f u)) t (shifts k v) /\ has_velocity (fun u => spins k (f u)) t (spins k v).
Proof. intros k f t v [f1 [f2 f3]]. destruct k; repeat split; cbn [shifts spins vzero vx vy vz]; try assumption; apply derivable_const. Qed.

(** With the rate of the unit vector. *)
Lemma speed_bends : forall k ell l P Q V W position turn velocity omega acceleration alpha du, ell <> 0 ->
  position 0 = P -> turn 0 = Q -> velocity 0 = V -> omega 0 = W -> turns turn 0 W -> has_velocity velocity 0 acceleration -> has_velocity omega 0 alpha -> is_of k V W ->
  let u := normalised (strut_vector l P Q) in let r := arm_of_joint l Q in
  has_velocity (fun t => normalised (strut_vector l (position t) (turn t))) 0 du ->
  derivable_pt_lim (fun t => Linear.dot (strut_row k ell l (position t) (turn t)) (twist k (velocity t) (vscale ell (omega t)))) 0
    (Linear.dot (strut_row k ell l P Q) (twist k acceleration (vscale ell alpha)) + Vec3.dot du (vadd V (cross W r)) + (Vec3.dot u W * Vec3.dot r W - Vec3.dot u r * norm2 W)).
Proof.
  intros k ell l P Q V W position turn velocity omega acceleration alpha du l0 eP eQ eV eW ht hv hw hk u r hu. destruct (own_parts k V W hk) as [sV sW].
  pose proof (ht (strut_joint l)) as hr. rewrite eQ in hr. fold (arm_of_joint l Q) in hr. fold r in hr.
  pose proof (velocity_sum _ _ _ _ _ (proj1 (velocity_parts k _ _ _ hv)) (velocity_cross _ _ _ _ _ (proj2 (velocity_parts k _ _ _ hw)) hr)) as hD. cbv beta in hD.
  rewrite eQ, eW, sW in hD. fold (arm_of_joint l Q) in hD. fold r in hD. pose proof (velocity_product _ _ _ _ _ hu hD) as H. cbv beta in H. rewrite eP, eQ, eV, eW, sV, sW in H. fold u in H.
  change (mulv Q (strut_joint l)) with r in H.
  eapply derivable_eq; [exact H | |].
  - intro t. cbv beta. unfold strut_row. cbv zeta. rewrite twist_dot by exact l0. reflexivity.
  - unfold strut_row. cbv zeta. fold u r. rewrite twist_dot by exact l0. generalize (shifts k acceleration) (spins k alpha) u r. clear. intros. unfold_vec. ring.
Qed.

Section Unit.
Variables (x theta : list R) (p : nat) (k : motion) (l : strut) (ratio : R) (a C : evec).
Hypothesis r0 : 0 < ratio.
Hypothesis lp : (p <= length theta)%nat.
Hypothesis a_is : forall back, val3 x (firstn p theta ++ back) a = vscale ratio (strut_base l).
Hypothesis a_defined : forall y th, Forall (Formula.defined y th) (list_of a).

Lemma unit_moves : forall position turn V W, has_velocity position 0 V -> turns turn 0 W -> is_of k V W ->
  let A t := strut_vector l (position t) (turn t) in let c := vadd V (cross W (arm_of_joint l (turn 0))) in
  val3 x theta C = vscale ratio (vadd (A 0) (strut_base l)) -> 0 < norm2 (A 0) ->
  exists du, has_velocity (fun t => normalised (A t)) 0 du /\ Vec3.dot du c = ratio * Vec3.dot c (mulv (valm x theta (unit_gradient k p a C)) c).
Proof.
  intros position turn V W hp ht hk A c eC reach. pose proof (vector_velocity l position turn 0 V W hp ht) as hA. fold c in hA.
  assert (c3 : k = InPlane -> vz c = 0).
  { intros ->. cbn [is_of] in hk. destruct hk as [h1 [h2 h3]]. unfold c, vadd, cross. cbn [vx vy vz]. rewrite h1, h2, h3. ring. }
  set (th t := firstn p theta ++ coordinates (vscale ratio (vadd (A t) (strut_base l)))).
  assert (len : length (firstn p theta) = p) by (rewrite firstn_length; lia).
  assert (At : forall t, val3 x (th t) (map2 minus (EVec (F (Param p)) (F (Param (S p))) (F (Param (S (S p))))) a) = vscale ratio (A t)).
  { intro t. rewrite val3_minus. unfold th at 2. rewrite a_is. unfold val3, th. cbn [ex ey ez value map_op real_op]. rewrite !app_nth2 by lia. rewrite len.
    replace (p - p)%nat with 0%nat by lia. replace (S p - p)%nat with 1%nat by lia. replace (S (S p) - p)%nat with 2%nat by lia. cbn [coordinates nth vscale vadd vx vy vz].
    generalize (A t) (strut_base l). clear. vec_ring. }
  assert (Unit : forall t, val3 x (th t) (own_unit p a) = normalised (A t)).
  { intro t. unfold own_unit. cbv zeta. rewrite val3_divided, value_root, value_dot, At, <- norm2_dot. exact (normalised_resized ratio (A t) r0). }
  pose (rate j := if Nat.eqb j p then ratio * vx c else if Nat.eqb j (S p) then ratio * vy c else if Nat.eqb j (S (S p)) then ratio * vz c else 0).
  assert (moves : forall j, derivable_pt_lim (fun u => nth j (th u) 0) 0 (rate j)).
  { intro j. destruct hA as [h1 [h2 h3]].
    assert (M : forall f b d, derivable_pt_lim f 0 d -> derivable_pt_lim (fun u => ratio * (f u + b)) 0 (ratio * d)).
    { intros f b d h. apply derivable_scal. apply derivable_eq with (fun u => f u + b) (d + 0); [apply derivable_add; [exact h | apply derivable_const] | reflexivity | ring]. }
    unfold th, rate. destruct (Nat.ltb_spec j p) as [lj | lj].
    - destruct (Nat.eqb_spec j p); [lia |]. destruct (Nat.eqb_spec j (S p)); [lia |]. destruct (Nat.eqb_spec j (S (S p))); [lia |].
      eapply derivable_eq; [apply (derivable_const (nth j (firstn p theta) 0)) | | reflexivity]. intro u. cbv beta. apply app_nth1. lia.
    - assert (E : forall u, nth j (firstn p theta ++ coordinates (vscale ratio (vadd (A u) (strut_base l)))) 0 = nth (j - p) (coordinates (vscale ratio (vadd (A u) (strut_base l)))) 0)
        by (intro u; rewrite app_nth2, len by lia; reflexivity).
      destruct (Nat.eqb_spec j p) as [-> |]; [| destruct (Nat.eqb_spec j (S p)) as [-> |]; [| destruct (Nat.eqb_spec j (S (S p))) as [-> |]]].
      + eapply derivable_eq; [exact (M _ (vx (strut_base l)) _ h1) | | reflexivity]. intro u. rewrite E. replace (p - p)%nat with 0%nat by lia. reflexivity.
      + eapply derivable_eq; [exact (M _ (vy (strut_base l)) _ h2) | | reflexivity]. intro u. rewrite E. replace (S p - p)%nat with 1%nat by lia. reflexivity.
      + eapply derivable_eq; [exact (M _ (vz (strut_base l)) _ h3) | | reflexivity]. intro u. rewrite E. replace (S (S p) - p)%nat with 2%nat by lia. reflexivity.
      + eapply derivable_eq; [apply (derivable_const 0) | | reflexivity]. intro u. rewrite E. apply nth_overflow. cbn. lia. }
  assert (once : NoDup (moving k p)) by (destruct k; cbn [moving]; repeat constructor; cbn [In]; lia).
  assert (stay : forall j, ~ In j (moving k p) -> rate j = 0).
  { intros j n. unfold rate. destruct (Nat.eqb_spec j p) as [-> |]; [exfalso; apply n; destruct k; left; reflexivity |].
    destruct (Nat.eqb_spec j (S p)) as [-> |]; [exfalso; apply n; destruct k; right; left; reflexivity |].
    destruct (Nat.eqb_spec j (S (S p))) as [-> |]; [| reflexivity]. destruct k; [rewrite (c3 eq_refl); ring | exfalso; apply n; right; right; left; reflexivity ..]. }
  assert (A0 : forall w, Forall (defined x (th 0)) (list_of w) -> val3 x (th 0) w = vscale ratio (A 0) -> Forall (defined x (th 0)) (list_of (divided_by w (root (product w w))))).
  { intros w hw ew. assert (D : defined x (th 0) (product w w)).
    { inversion hw as [| ? ? d1 hw1]; subst. inversion hw1 as [| ? ? d2 hw2]; subst. inversion hw2 as [| ? ? d3 _]; subst. unfold product. repeat apply plus_defined; apply times_defined; assumption. }
    assert (N : 0 < value x (th 0) (product w w)) by (rewrite value_dot, ew, <- norm2_dot, norm2_scale; apply Rmult_lt_0_compat; [apply pow_lt, r0 | exact reach]).
    pose proof (root_defined _ _ _ D N) as R. assert (NZ : value x (th 0) (root (product w w)) <> 0) by (rewrite value_root; apply Rgt_not_eq, sqrt_lt_R0, N).
    unfold divided_by, list_of in *. cbn [ex ey ez]. inversion hw as [| ? ? d1 hw1]; subst. inversion hw1 as [| ? ? d2 hw2]; subst. inversion hw2 as [| ? ? d3 _]; subst.
    repeat constructor; apply over_defined; assumption. }
  specialize (A0 (map2 minus (EVec (F (Param p)) (F (Param (S p))) (F (Param (S (S p))))) a) ltac:(pose proof (a_defined x (th 0)) as ad; inversion ad as [| ? ? d1 ad1]; subst; inversion ad1 as [| ? ? d2 ad2]; subst; inversion ad2 as [| ? ? d3 _]; subst;
    cbn [list_of map2 ex ey ez]; repeat apply Forall_cons; try apply Forall_nil; apply minus_defined; first [assumption | cbn; auto]) (At 0)).
  fold (own_unit p a) in A0.
  assert (Slopes : forall f, defined x (th 0) f -> derivable_pt_lim (fun u => value x (th u) f) 0 (ratio * Vec3.dot (val3 x theta (unit_slopes k p a C f)) c)).
  { intros f d. eapply derivable_eq; [exact (derivatives_sound (moving k p) x th 0 rate once moves stay f d) | reflexivity |].
    assert (E : map (value x (th 0)) (derivatives (moving k p) f) = map (value x theta) (map (attached p (list_of C)) (derivatives (moving k p) f))).
    { rewrite map_map. apply map_ext. intro g. rewrite value_attached by exact lp. unfold th. do 2 f_equal. change (map (value x theta) (list_of C)) with (coordinates (val3 x theta C)). rewrite eC. reflexivity. }
    rewrite E. unfold unit_slopes. set (d' := map (attached p (list_of C)) (derivatives (moving k p) f)).
    assert (ld : length d' = length (moving k p)) by (unfold d', derivatives; rewrite !map_length; apply gradient_length).
    assert (rates : rate p = ratio * vx c /\ rate (S p) = ratio * vy c /\ rate (S (S p)) = ratio * vz c).
    { unfold rate. rewrite !Nat.eqb_refl. destruct (Nat.eqb_spec (S p) p); [lia |]. destruct (Nat.eqb_spec (S (S p)) p); [lia |]. destruct (Nat.eqb_spec (S (S p)) (S p)); [lia |]. auto. }
    destruct rates as [e1 [e2 e3]]. unfold Vec3.dot, val3. cbn [ex ey ez vx vy vz].
    destruct k; cbn [moving length] in ld; destruct d' as [| f1 [| f2 [| f3 [|]]]]; try discriminate; cbn [moving map Linear.dot nth]; rewrite ?e1, ?e2, ?e3; [rewrite (c3 eq_refl) |..]; ring. }
  inversion A0 as [| ? ? d1 A1]; subst. inversion A1 as [| ? ? d2 A2]; subst. inversion A2 as [| ? ? d3 _]; subst. clear A0 A1 A2.
  set (u := own_unit p a) in *. pose proof (Slopes _ d1) as s1. pose proof (Slopes _ d2) as s2. pose proof (Slopes _ d3) as s3.
  exists (Vec (ratio * Vec3.dot (val3 x theta (unit_slopes k p a C (ex u))) c) (ratio * Vec3.dot (val3 x theta (unit_slopes k p a C (ey u))) c) (ratio * Vec3.dot (val3 x theta (unit_slopes k p a C (ez u))) c)).
  split.
  - repeat split; cbn [vx vy vz].
    + eapply derivable_eq; [exact s1 | | reflexivity]. intro t. rewrite <- (Unit t). reflexivity.
    + eapply derivable_eq; [exact s2 | | reflexivity]. intro t. rewrite <- (Unit t). reflexivity.
    + eapply derivable_eq; [exact s3 | | reflexivity]. intro t. rewrite <- (Unit t). reflexivity.
  - unfold unit_gradient, valm. cbv zeta. fold u. cbn [erow1 erow2 erow3]. unfold mulv. cbn [row1 row2 row3]. unfold Vec3.dot at 1 5. cbn [vx vy vz].
    destruct k; [rewrite (c3 eq_refl) |..]; ring.
Qed.
End Unit.

(** ** Of a strut *)

Definition etwist (k : motion) (v w : evec) : list formula :=
  match k with
  | InPlane => [ex v; ey v; ez w]
  | InSpace => [ex v; ey v; ez v; ex w; ey w; ez w]
  | AboutPoint => [ex w; ey w; ez w]
  end.
Lemma twist_values : forall x theta k a b, map (Formula.value x theta) (etwist k a b) = twist k (val3 x theta a) (val3 x theta b).
Proof. intros x theta [] a b; reflexivity. Qed.

(** Its row, twice H, and K^2 and s with |row|^2 <= K^2 - s^2. *)
Record bend := Bend { bend_row : list formula; bend_twice : list (list formula); bend_square : formula; bend_along : formula }.
(** 1, but for platforms that turn about a point. *)
Definition translates (k : motion) : Z := match k with AboutPoint => 0 | _ => 1 end.
(** [r]: the way to the joint b; [C]: where it is; [A]: from the base end a to there; [h]: to the platform's point. *)
Definition bend_of (k : motion) (ell : formula) (a b r C A : evec) (len : formula) (h : evec) (p : nat) : bend :=
  let u := divided_by A len in
  Bend (etwist k u (divided_by (ecross r (divided_by h len)) ell)) (upper (bend_entry (unit_gradient k p a C) u r ell) (columns k r ell))
    (plus (integer (translates k)) (over (product b b) (square ell))) (over (product r u) ell).

Section Strut.
Variables (x theta : list R) (p : nat) (k : motion) (l : strut) (P : vec) (Q : mat) (ratio L : R) (ell : formula) (a b r C A : evec) (len : formula) (h : evec).
Hypothesis r0 : 0 < ratio.
Hypothesis L0 : 0 < L.
Hypothesis keeps : forall b, norm2 (mulv Q b) = norm2 b.
Hypothesis lp : (p <= length theta)%nat.
Hypothesis a_is : forall back, val3 x (firstn p theta ++ back) a = vscale ratio (strut_base l).
Hypothesis a_defined : forall y th, Forall (Formula.defined y th) (list_of a).
Hypothesis ell_is : value x theta ell = ratio * L.
Hypothesis b_is : val3 x theta b = vscale ratio (strut_joint l).
Hypothesis r_is : val3 x theta r = vscale ratio (arm_of_joint l Q).
Hypothesis C_is : val3 x theta C = vscale ratio (vadd P (arm_of_joint l Q)).
Hypothesis A_is : val3 x theta A = vscale ratio (strut_vector l P Q).
Hypothesis len_is : value x theta len = ratio * strut_length l P Q.
Hypothesis h_is : val3 x theta h = vscale ratio (vsub P (strut_base l)).
Hypothesis reach : 0 < norm2 (strut_vector l P Q).

Let bent := bend_of k ell a b r C A len h p.
Let u := normalised (strut_vector l P Q).

Lemma size_positive : 0 < strut_length l P Q.
Proof. exact (sqrt_lt_R0 _ reach). Qed.
Lemma unit_is : val3 x theta (divided_by A len) = u.
Proof.
  pose proof size_positive as q0. rewrite val3_divided, A_is, len_is. unfold u, normalised. fold (strut_length l P Q). revert q0. generalize (strut_length l P Q). intros q q0.
  generalize (strut_vector l P Q). intros [v1 v2 v3]. clear - r0 q0. unfold vscale. cbn [vx vy vz]. f_equal; field; lra.
Qed.

Lemma bend_row_is : map (Formula.value x theta) (bend_row bent) = strut_row k L l P Q.
Proof.
  pose proof size_positive as q0. unfold bent, bend_of. cbv zeta. cbn [bend_row]. rewrite twist_values, unit_is, val3_divided, val3_cross, val3_divided, r_is, h_is, len_is, ell_is.
  unfold strut_row. cbv zeta. fold u. f_equal. unfold u, normalised. fold (strut_length l P Q). revert q0. generalize (strut_length l P Q). intros q q0. unfold strut_vector.
  generalize (arm_of_joint l Q) (strut_base l). clear - r0 q0 L0. intros [r1 r2 r3] [b1 b2 b3]. destruct P as [p1 p2 p3]. unfold vscale, cross, vsub, vadd. cbn [vx vy vz]. f_equal; field; lra.
Qed.

Lemma bend_lever : Linear.dot (strut_row k L l P Q) (strut_row k L l P Q) <= Formula.value x theta (bend_square bent) - Formula.value x theta (bend_along bent) ^ 2.
Proof.
  unfold bent, bend_of. cbv zeta. cbn [bend_square bend_along]. rewrite value_plus, !value_over, Formula.value_square, !value_dot, unit_is, b_is, r_is, ell_is.
  pose proof (normalised_norm _ reach) as U. fold u in U. pose proof (keeps (strut_joint l)) as K. fold (arm_of_joint l Q) in K.
  change (Formula.value x theta (integer (translates k))) with (IZR (translates k)). unfold strut_row. cbv zeta. fold u. set (c := arm_of_joint l Q) in *. clearbody c u.
  replace (IZR (translates k) + Vec3.dot (vscale ratio (strut_joint l)) (vscale ratio (strut_joint l)) / (ratio * L) ^ 2 - (Vec3.dot (vscale ratio c) u / (ratio * L)) ^ 2)
    with (IZR (translates k) * norm2 u + (norm2 c * norm2 u - Vec3.dot c u ^ 2) * (/ L) ^ 2) by (rewrite U, K; unfold Vec3.dot, norm2, vscale; cbn [vx vy vz]; field; lra).
  rewrite lagrange. replace (Vec3.dot c u ^ 2 + norm2 (cross c u) - Vec3.dot c u ^ 2) with (norm2 (cross c u)) by ring.
  generalize (/ L) (cross c u). clear. intros i [x1 x2 x3]. destruct u as [u1 u2 u3]. unfold norm2. cbn [vx vy vz].
  destruct k; cbn [translates twist Linear.dot vx vy vz vscale]; pose proof (pow2_ge_0 u3); pose proof (pow2_ge_0 (i * x1)); pose proof (pow2_ge_0 (i * x2)); lra.
Qed.

Theorem bend_accelerates : forall v a', strut_accelerates k L l P Q v a'
  (Linear.dot (strut_row k L l P Q) a' + ratio / 2 * quad (map (map (Formula.value x theta)) (bend_twice bent)) v).
Proof.
  intros v a' position turn velocity omega acceleration alpha eP eQ hp ht hv hw hk -> ->.
  set (V := velocity 0) in *. set (W := omega 0) in *.
  destruct (unit_moves x theta p k l ratio a C r0 lp a_is a_defined position turn V W hp ht hk) as [du [hdu e]].
  { rewrite eP, eQ, C_is. unfold strut_vector. clear. generalize (arm_of_joint l Q) (strut_base l). intros [r1 r2 r3] [b1 b2 b3]. destruct P as [p1 p2 p3]. unfold vscale, vsub, vadd. cbn [vx vy vz]. f_equal; ring. }
  { rewrite eP, eQ. exact reach. }
  rewrite eQ in e. eapply derivable_eq; [exact (speed_bends k L l P Q V W position turn velocity omega acceleration alpha du ltac:(lra) eP eQ eq_refl eq_refl ht hv hw hk hdu) | reflexivity |].
  rewrite Rplus_assoc. f_equal. rewrite e. clear e hdu du. fold u.
  unfold bent, bend_of. cbv zeta. cbn [bend_twice]. rewrite map_upper.
  rewrite (upper_ext _ _ _ (fun c d => real_entry (valm x theta (unit_gradient k p a C)) u (vscale ratio (arm_of_joint l Q)) (ratio * L) (val3 x theta (fst c), snd c) (val3 x theta (fst d), snd d)))
    by (intros c d; rewrite value_entry, unit_is, r_is, ell_is; reflexivity).
  rewrite <- (upper_map _ _ _ (real_entry (valm x theta (unit_gradient k p a C)) u (vscale ratio (arm_of_joint l Q)) (ratio * L)) (fun c => (val3 x theta (fst c), snd c))).
  rewrite value_columns, r_is, ell_is, quad_bend by (clear - hk; destruct k; [destruct hk as [h1 [h2 h3]]; split; [exact h1 | cbn [vscale vx vy]; rewrite h2, h3; split; ring] | exact I | exact hk]).
  replace (vadd V (vscale (/ (ratio * L)) (cross (vscale L W) (vscale ratio (arm_of_joint l Q))))) with (vadd V (cross W (arm_of_joint l Q)))
    by (generalize V W (arm_of_joint l Q); clear - r0 L0; intros [v1 v2 v3] [w1 w2 w3] [r1 r2 r3]; unfold vscale, vadd, cross; cbn [vx vy vz]; f_equal; field; lra).
  generalize (Vec3.dot (vadd V (cross W (arm_of_joint l Q))) (mulv (valm x theta (unit_gradient k p a C)) (vadd V (cross W (arm_of_joint l Q))))). intro y.
  generalize W (arm_of_joint l Q). clear - r0 L0. intros [w1 w2 w3] [r1 r2 r3]. destruct u as [u1 u2 u3]. unfold Vec3.dot, norm2, vscale. cbn [vx vy vz]. field. lra.
Qed.
End Strut.

(** ** The bound *)

Lemma acceleration_bounded : forall n row a H v alpha beta half p q b, (0 < n)%nat -> 0 <= p -> 0 <= q -> 0 < b -> alpha = p / b -> beta = half * (q * q / b) ->
  (forall e v, Linear.dot e e <= 1 -> length v = n -> nonzero v -> Rabs (beta / 2 * quad H v) < (1 - alpha * Linear.dot row e) * Linear.dot v v) ->
  length v = n -> Linear.dot v v <= q ^ 2 -> Linear.dot a a <= p ^ 2 -> Rabs (Linear.dot row a + half / 2 * quad H v) <= b.
Proof.
  intros n row a H v alpha beta half p q b n0 p0 q0 b0 -> -> h lv hv ha.
  assert (K : forall w, length w = n -> nonzero w -> Rabs (half * (q * q / b) / 2 * quad H w) < (1 - Rabs (Linear.dot row a) / b) * Linear.dot w w).
  { intros w lw nz. destruct (Rle_lt_or_eq_dec 0 p p0) as [pp | <-].
    - set (sign := if Rcase_abs (Linear.dot row a) then -1 else 1).
      assert (S : sign * Linear.dot row a = Rabs (Linear.dot row a) /\ sign * sign = 1) by (unfold sign, Rabs; destruct (Rcase_abs _); split; ring). destruct S as [S1 S2].
      specialize (h (map (Rmult (sign / p)) a) w). rewrite dot_map, !(Solve.dot_commutes _ (map _ a)), !dot_map, (Solve.dot_commutes a row) in h.
      replace (p / b * (sign / p * Linear.dot row a)) with (sign * Linear.dot row a / b) in h by (field; lra). rewrite S1 in h. apply h; [| exact lw | exact nz].
      replace (sign / p * (sign / p * Linear.dot a a)) with (sign * sign * (Linear.dot a a / p ^ 2)) by (field; lra). rewrite S2, Rmult_1_l.
      pose proof (pow_lt p 2 pp). apply Rmult_le_reg_r with (p ^ 2); [assumption |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
    - pose proof (zero_vector a ltac:(lra)) as z. rewrite (dot_zero a row z), Rabs_R0. specialize (h [] w ltac:(cbn; lra) lw nz). replace (0 / b * Linear.dot row []) with 0 in h by (field; lra).
      replace (0 / b) with 0 by (field; lra). exact h. }
  set (r := Linear.dot row a) in *.
  assert (R1 : Rabs r <= b).
  { assert (nz : nonzero (1 :: repeat 0 (pred n))) by (unfold nonzero; cbn [Linear.dot]; pose proof (Check.dot_self (repeat 0 (pred n))); lra).
    specialize (K (1 :: repeat 0 (pred n)) ltac:(cbn [length]; rewrite repeat_length; lia) nz). unfold nonzero in nz.
    match type of K with ?y < _ => assert (0 <= y) by apply Rabs_pos end.
    assert (0 < 1 - Rabs r / b) by (apply Rmult_lt_reg_r with (Linear.dot (1 :: repeat 0 (pred n)) (1 :: repeat 0 (pred n))); [exact nz |]; lra).
    apply Rmult_le_reg_r with (/ b); [apply Rinv_0_lt_compat, b0 |]. rewrite Rinv_r by lra. unfold Rdiv in *. lra. }
  apply Rle_trans with (1 := Rabs_triang _ _).
  destruct (Rlt_dec 0 (Linear.dot v v)) as [nz | z].
  - specialize (K v lv nz). assert (qq : 0 < q * q) by (replace (q * q) with (q ^ 2) by ring; lra).
    assert (E : Rabs (half * (q * q / b) / 2 * quad H v) = q * q / b * Rabs (half / 2 * quad H v)).
    { replace (half * (q * q / b) / 2 * quad H v) with (q * q / b * (half / 2 * quad H v)) by (field; lra). rewrite Rabs_mult. f_equal. apply Rabs_right, Rle_ge, Rlt_le, Rdiv_lt_0_compat; assumption. }
    rewrite E in K. set (y := Rabs (half / 2 * quad H v)) in *.
    assert (Y : q * q / b * y <= (1 - Rabs r / b) * (q * q)).
    { apply Rle_trans with (1 := Rlt_le _ _ K). apply Rmult_le_compat_l; [| lra]. apply Rmult_le_reg_r with b; [exact b0 |]. replace ((1 - Rabs r / b) * b) with (b - Rabs r) by (field; lra). lra. }
    apply Rmult_le_reg_l with (q * q / b); [apply Rdiv_lt_0_compat; assumption |]. replace (q * q / b * (Rabs r + y)) with (q * q * (Rabs r / b) + q * q / b * y) by (field; lra).
    replace (q * q / b * b) with (q * q) by (field; lra). lra.
  - rewrite (quad_zero v H (zero_vector v ltac:(lra))), Rmult_0_r, Rabs_R0. lra.
Qed.
