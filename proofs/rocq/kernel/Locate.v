(** * Accuracy of legs in any motion, and of mechanisms by formulas: tests

    Formulas are those of the legs, and of platforms that turn those of the same legs where the platform is turned on (quantity/accuracy.rs). *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require MeanValue Velocity.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Elbow Statement Linear Arithmetic Slope Test Cell Check Nearby Number Trig Formula Machine Problem Witness Orientation Turning Control Chart Bend Onward Pose Configuration Inputs Angle Arm Legs Recover Drives.
From Orthocert.kernel Require Gradient Solve Twofold Spread Compare.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

Lemma two_to_opposite : forall s, / two_to (- s) = two_to s.
Proof.
  intro s. unfold two_to. destruct (Z.leb_spec 0 s), (Z.leb_spec 0 (- s)); try lia.
  - replace s with 0%Z by lia. cbn. field.
  - rewrite Z.opp_involutive, Rinv_inv. reflexivity.
  - reflexivity.
Qed.

(** ** Rows where the platform is off *)

Section Formulas.
Variables (k : mobility) (turn : option (emat * formula)) (ell unit : formula).
Definition spin_off : evec := match k with Turns m => spin_formulas m (dimension m) | _ => EVec (integer 0) (integer 0) (integer 0) end.
Definition placed_off (b : evec) : evec := match k with Turns _ => eonward spin_off (eturned turn b) | _ => eturned turn b end.
Definition row_off (z : drive_formulas * evec) : list formula :=
  let u := b_divided (fst z) in
  match k with
  | Turns m => let moment := ecross (snd z) u in let t := Machine.scaled (onward_rate spin_off) (map2 plus moment (ecross moment spin_off)) in
      etwist m u (EVec (times (ex t) unit) (times (ey t) unit) (times (ez t) unit))
  | _ => evelocities k u (divided_by (ecross (snd z) u) ell)
  end.
(** Rows of M in the same columns. *)
Definition row_there (A : list formula) : list formula :=
  match k with Turns m => firstn (first_angle m) A ++ map (fun e => times e (times (times (integer 2) ell) unit)) (skipn (first_angle m) A) | _ => A end.
End Formulas.

Definition angle_slopes (ps : list parameter) (c s : formula) : list formula :=
  map (fun p => minus (times c (snd p)) (times s (fst p))) (combine (Gradient.derivatives (toleranced ps) c) (Gradient.derivatives (toleranced ps) s)).
Definition joint_slopes (ps : list parameter) (j : ejoint) : list (nat * formula) :=
  match j with ELength f => slopes_of ps f | EAngle c s => slopes_from ps (angle_slopes ps c s) | EUnknown => [] end.
(** Of these tests. *)
Definition located_own (ps : list parameter) (far : list (list formula)) (rows : rows formula) (js : list ejoint) : list formula :=
  concat far ++ entries rows ++ flat_map (fun j => joint_forms j ++ map snd (joint_slopes ps j)) js.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Definition joint_near (place : formula -> nat) (ps : list parameter) (s : Z) (error b : number) (j : ejoint) : option (nat * (fixed * list (fixed * nat))) :=
  match j with
  | ELength f => joint_test bits place ps s error b f
  | EAngle c a => match enclose_input bits (Radians (Over error b) (- s)), changes_from bits place ps s b (slopes_from ps (angle_slopes ps c a)) with
      | Some e, Some hs => Some (place c, (e, hs))
      | _, _ => None
      end
  | EUnknown => None
  end.
(** [lasts]: the parts that there are; [turn]: tau. *)
Definition located_tests (place : formula -> nat) (n first : nat) (lasts : list bool) (angular : bool) (ps : list parameter) (s : Z) (far : list (list formula)) (rows : rows formula)
    (js : list ejoint) (turn : option fixed) (error b : number) : list (option test) :=
  match enclose_parameter bits (exactly b, s), turn, all_some (map (joint_near place ps s error b) js) with
  | Some d, Some t, Some joints =>
      if Nat.eqb (length js) n && certainly bits false error && certainly bits true b then
        map (fun last => Some (Located (Nearby (map (map place) far) (map_rows place rows) (map place (flat_map joint_forms js)) joints angular d t first last))) lasts
      else [None]
  | _, _, _ => [None]
  end.

(** ** What joints are off by *)

Lemma dot_differences : forall (val : formula -> R) c s r l m, length l = length m ->
  Linear.dot r (map (fun p => c * val (snd p) - s * val (fst p)) (combine l m)) = c * Linear.dot r (map val m) - s * Linear.dot r (map val l).
Proof.
  intros val c s. induction r as [| y r IH]; intros [| a l] [| b m] e; try discriminate; cbn [combine map Linear.dot fst snd]; try ring. rewrite IH by (cbn in e; congruence). ring.
Qed.

(** An arm's angle on the way to the nominal one. *)
Lemma angle_on_the_way : forall ps th tb x A B T (mode : bool) t, let c := elbow_of false A B T in let s := signed mode (elbow_of true A B T) in
  Forall2 scaled_within ps th -> defined x (way_at ps th tb t) c ->
  let cv t := value x (way_at ps th tb t) c in let sv t := value x (way_at ps th tb t) s in
  let rho := Linear.dot (map (way_rate ps th tb) (toleranced ps)) (map (value x (way_at ps th tb t)) (angle_slopes ps c s)) in
  cv t ^ 2 + sv t ^ 2 = 1 /\ derivable_pt_lim cv t (- sv t * rho) /\ derivable_pt_lim sv t (cv t * rho).
Proof.
  intros ps th tb x A B T mode t c s hth def cv sv rho. assert (def' := def). destruct def' as [rad [dA [dB dT]]]. cbn [map_op all_op defined_op] in rad, dA, dB, dT.
  assert (ds : defined x (way_at ps th tb t) s).
  { assert (d2 : defined x (way_at ps th tb t) (elbow_of true A B T)) by (split; [exact rad | split; [exact dA | split; assumption]]). destruct mode; cbn [s signed]; [exact d2 | split; [exact I | exact d2]]. }
  pose proof (elbow_rates _ _ _ t _ _ _ (way_derivative ps th tb x A t hth dA) (way_derivative ps th tb x B t hth dB) (way_derivative ps th tb x T t hth dT) rad) as R0.
  pose proof (elbow_is _ _ _ rad) as U. cbv beta zeta in R0.
  assert (vc : cv t = fst (Elbow.elbow (value x (way_at ps th tb t) A) (value x (way_at ps th tb t) B) (value x (way_at ps th tb t) T))) by reflexivity.
  assert (vs : sv t = (if mode then 1 else -1) * snd (Elbow.elbow (value x (way_at ps th tb t) A) (value x (way_at ps th tb t) B) (value x (way_at ps th tb t) T)))
    by (unfold sv, s; rewrite value_signed'; reflexivity).
  destruct (Elbow.elbow (value x (way_at ps th tb t) A) (value x (way_at ps th tb t) B) (value x (way_at ps th tb t) T)) as [c0 s0]. cbn [fst snd] in vc, vs. destruct U as [U _]. destruct R0 as [_ [Rc Rs]].
  match type of Rc with derivable_pt_lim _ _ (_ * ?q) => set (w := q) in * end.
  pose proof (way_derivative ps th tb x c t hth def) as Dc. pose proof (way_derivative ps th tb x s t hth ds) as Ds.
  set (kc := Linear.dot _ _) in Dc. set (ks := Linear.dot _ _) in Ds.
  assert (Ec : kc = - s0 * w) by exact (uniqueness_limite _ _ _ _ Dc Rc).
  assert (Es : ks = (if mode then 1 else -1) * (c0 * w)).
  { apply (uniqueness_limite (fun t => value x (way_at ps th tb t) s) t); [exact Ds |]. eapply Velocity.derivable_eq; [exact (Velocity.derivable_scal (if mode then 1 else -1) _ _ _ Rs) | intro u; unfold s; rewrite value_signed'; reflexivity | reflexivity]. }
  assert (Er : rho = cv t * ks - sv t * kc).
  { unfold rho, angle_slopes. rewrite map_map.
    rewrite (map_ext _ (fun p => cv t * value x (way_at ps th tb t) (snd p) - sv t * value x (way_at ps th tb t) (fst p))) by (intro p; rewrite value_minus, !value_times; reflexivity).
    apply dot_differences. unfold Gradient.derivatives. rewrite !map_length, !Gradient.gradient_length. reflexivity. }
  assert (Ew : rho = (if mode then 1 else -1) * w).
  { rewrite Er, Ec, Es, vc, vs. replace (c0 * ((if mode then 1 else -1) * (c0 * w)) - (if mode then 1 else -1) * s0 * (- s0 * w)) with ((if mode then 1 else -1) * w * (c0 ^ 2 + s0 ^ 2)) by ring. rewrite U. ring. }
  split; [rewrite vc, vs; transitivity (c0 ^ 2 + s0 ^ 2); [destruct mode; ring | exact U] |]. split.
  - assert (E : - sv t * rho = kc) by (rewrite Ew, vs, Ec; destruct mode; ring). rewrite E. exact Dc.
  - assert (E : cv t * rho = ks) by (rewrite Ew, vc, Es; ring). rewrite E. exact Ds.
Qed.

Definition half := is_half bits.
Lemma angle_is_off : forall s b error ps th tb params tape A B T (mode : bool) x e hs r, let c := elbow_of false A B T in let a := signed mode (elbow_of true A B T) in
  let ratio := / two_to s in let sl := slopes_from ps (angle_slopes ps c a) in
  Forall2 scaled_within ps th -> (forall th', Forall2 scaled_within ps th' -> Forall2 contains params (th' ++ tb)) ->
  (forall f, In f (map snd sl) -> formula_at tape (place (formulas tape) f) = f) ->
  enclose_input bits (Radians (Over error b) (- s)) = Some e -> changes_from bits (place (formulas tape)) ps s b sl = Some hs ->
  (forall th, Forall2 contains params th -> defined x th c) -> 0 < Claim.value b -> 0 <= Claim.value error ->
  (forall th ts, Forall2 contains params th -> Forall2 half hs ts -> Rabs (ratio * Claim.value b * Linear.dot ts (map (fun h => value x th (formula_at tape (snd h))) hs)) < 1) ->
  is_off (Claim.value error) (Angle (value x (map middle_of ps ++ tb) c) (value x (map middle_of ps ++ tb) a)) r ->
  exists y, moves_to y (Angle (value x (th ++ tb) c) (value x (th ++ tb) a)) r /\ may_be_off bits tape params x (place (formulas tape) c, (e, hs)) (y / (ratio * Claim.value b)).
Proof.
  intros s b error ps th tb params tape A B T mode x e hs r c a ratio sl hth E found ee eh def b0 e0 slow hr.
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0. set (D := ratio * Claim.value b) in *. assert (D0 : 0 < D) by (apply Rmult_lt_0_compat; assumption).
  destruct (way_terms bits s b ps th tb _ x _ hs hth eh b0) as [G1 [ts [G2 G3]]]. fold ratio D sl in G1, G3.
  assert (In_ : forall t, 0 <= t <= 1 -> Forall2 contains params (way_at ps th tb t)) by (intros t h; apply E, on_the_way_within; assumption).
  set (cv := fun t => value x (way_at ps th tb t) c). set (sv := fun t => value x (way_at ps th tb t) a).
  set (rho := fun t => Linear.dot (map (way_rate ps th tb) (toleranced ps)) (map (value x (way_at ps th tb t)) (angle_slopes ps c a))).
  assert (Terms : forall theta, map (fun h => value x theta (formula_at tape (snd h))) hs = map (value x theta) (map snd sl)).
  { intro theta. rewrite <- (map_map snd (fun i => value x theta (formula_at tape i))), G1, map_map. apply map_ext_in. intros f i. rewrite (found f i). reflexivity. }
  assert (H : forall t, 0 <= t <= 1 -> cv t ^ 2 + sv t ^ 2 = 1 /\ derivable_pt_lim cv t (- sv t * rho t) /\ derivable_pt_lim sv t (cv t * rho t) /\ Rabs (rho t) < 1).
  { intros t ht. destruct (angle_on_the_way ps th tb x A B T mode t hth (def _ (In_ t ht))) as [h1 [h2 h3]]. split; [exact h1 |]. split; [exact h2 |]. split; [exact h3 |].
    specialize (slow (way_at ps th tb t) ts (In_ t ht) G2). rewrite Terms, <- G3 in slow. fold (rho t) in slow. replace (D * (rho t / D)) with (rho t) in slow by (field; lra). exact slow. }
  destruct (way_ends ps th tb hth) as [w0 w1].
  assert (Little : forall t, 0 <= t <= 1 -> 0 < cv t * cv 0 + sv t * sv 0) by exact (turned_little cv sv rho H).
  assert (Dv : forall t, 0 <= t <= 1 -> derivable_pt_lim (fun t => turn_between (cv 0) (sv 0) (cv t) (sv t)) t (rho t)).
  { intros t ht. destruct (H 0 ltac:(lra)) as [u0 _]. destruct (H t ht) as [u1 [h1 [h2 _]]]. apply turned_rate; auto. }
  destruct (MeanValue.mean_value_theorem _ _ 0 1 Rlt_0_1 Dv) as [t [M ht]]. cbv beta in M.
  pose proof (not_off (Angle (cv 0) (sv 0))) as Z. cbn [off_from] in Z. rewrite Z in M. destruct (H 0 ltac:(lra)) as [u0 _]. destruct (H 1 ltac:(lra)) as [u1 _].
  destruct (turned_angle _ _ _ _ u0 u1 (Little 1 ltac:(lra))) as [_ [_ [q1 q2]]]. set (delta := turn_between (cv 0) (sv 0) (cv 1) (sv 1)) in *.
  assert (C0 : cv 0 = value x (th ++ tb) c /\ sv 0 = value x (th ++ tb) a) by (unfold cv, sv; rewrite w0; split; reflexivity).
  assert (C1 : cv 1 = value x (map middle_of ps ++ tb) c /\ sv 1 = value x (map middle_of ps ++ tb) a) by (unfold cv, sv; rewrite w1; split; reflexivity).
  destruct C0 as [C0 C0'], C1 as [C1 C1']. rewrite <- C0, <- C0'. rewrite <- C1, <- C1' in hr.
  destruct r as [? | c' s' |]; cbn [is_off] in hr; try contradiction. destruct hr as [d [hd [hc hs_]]].
  exists (delta + in_degrees d). split.
  - cbn [moves_to]. rewrite cos_plus, sin_plus, hc, hs_, q1, q2. split; ring.
  - exists (way_at ps th tb t), (in_degrees d / D), ts. cbn [fst snd]. split; [apply In_, ht |]. split; [| split; [exact G2 |]].
    + exists (in_degrees (Claim.value error) / D). split.
      * pose proof (enclose_input_sound bits _ _ ee) as K. cbn [input_value Claim.value] in K.
        replace (in_degrees (Claim.value error) / D) with (in_degrees (Claim.value error / Claim.value b / two_to (- s))); [exact K |].
        unfold D, ratio. rewrite <- (two_to_opposite s). pose proof (two_to_pos (- s)). unfold in_degrees. field. split; lra.
      * unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ D)) by (apply Rlt_le, Rinv_0_lt_compat, D0). apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, D0 |].
        pose proof PI_RGT_0. assert (ID : forall y, in_degrees y = y * (PI / 180)) by (intro y; unfold in_degrees; field). rewrite !ID, Rabs_mult, (Rabs_pos_eq (PI / 180)) by lra. apply Rmult_le_compat_r; [lra | exact hd].
    + assert (Sum : fold_right (fun p sum => snd p * value x (way_at ps th tb t) (formula_at tape (snd (fst p))) + sum) (in_degrees d / D) (combine hs ts) =
        in_degrees d / D + Linear.dot ts (map (fun h => value x (way_at ps th tb t) (formula_at tape (snd h))) hs)).
      { clear - G2. induction G2 as [| h t' hs ts _ _ IH]; cbn [combine fold_right map Linear.dot fst snd]; [ring | rewrite IH; ring]. }
      rewrite Sum, Terms, <- G3. fold (rho t). replace (rho t) with delta by lra. field. lra.
Qed.

(** ** Legs in any motion *)

Definition place_list (k : mobility) (P : vec) : list R := match k with Translates => coordinates P | TranslatesInPlane => [vx P; vy P] | Turns m => position_list m P end.
Definition lasts_of (k : mobility) : list bool := match k with Turns _ => [false; true] | _ => [false] end.
Definition is_position_of (k : mobility) (P : vec) : Prop := match k with Translates => True | TranslatesInPlane => is_position InPlane P | Turns m => is_position m P end.

Lemma near_places : forall k P r cs d tau u theta, let x := map (Rmult r) (place_list k P) ++ cs in is_position_of k P -> k <> Turns AboutPoint -> length x = freedom k -> length u = freedom k ->
  let x' := Spread.near_point (places_of k) x (r * d) tau u in
  val3 x' theta (eplace k) = vscale r (position_off k P d u) /\ (forall i, (i < length cs)%nat -> nth (places_of k + i) x' 0 = nth i cs 0) /\
  val3 x' theta (spin_off k) = vscale tau (spin_by k u).
Proof.
  intros k P r cs d tau u theta x hp nk lx lu. unfold x in *. clear x. destruct k as [| | m]; [| | exact (near_coordinates m P r cs d tau u theta hp lx lu)]; destruct P as [p1 p2 p3]; cbn [place_list coordinates places_of freedom map app length vx vy vz is_position_of is_position] in *.
  - destruct cs; [| discriminate]. destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. unfold Spread.near_point, Near.moved, position_off, shift_by, spin_off, spin_by, val3, eplace, point, vadd, vscale, vzero. cbn.
    split; [f_equal; ring | split; [intros i l; lia | f_equal; ring]].
  - subst p3. destruct cs; [| discriminate]. destruct u as [| u1 [| u2 [|]]]; try discriminate. unfold Spread.near_point, Near.moved, position_off, shift_by, spin_off, spin_by, val3, eplace, eposition, vadd, vscale, vzero. cbn.
    split; [f_equal; ring | split; [intros i l; lia | f_equal; ring]].
Qed.

Section One.
Variables (k : mobility) (ell unit : formula) (s : Z) (dist tau : R).
Let ratio := / two_to s.
Hypothesis dist_pos : 0 < dist.
Hypothesis not_about : k <> Turns AboutPoint.

(** The row where the platform is off. *)
Lemma row_is_far : forall y theta z l P' Q' C, drives_there y theta s P' Q' z l -> well_formed_driven l -> val3 y theta (spin_off k) = C ->
  match k with Turns _ => value y theta unit * ratio = tau / dist | _ => True end -> Forall (defined y theta) (row_off k ell unit z) ->
  is_far_of k (rate_unit s l) dist tau l P' Q' C (map (value y theta) (row_off k ell unit z)).
Proof.
  intros y theta z l P' Q' C [[_ B] hr] ok hC hu def. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0, hr.
  destruct (B ok) as [_ [_ [B3 [_ B4]]]]. set (D := b_divided (fst z)) in *.
  assert (re : own_reach l (carried l P' Q')).
  { apply B3. unfold row_off in def. fold D in def. destruct k as [| | []]; try exact (Forall_inv def). contradiction not_about; reflexivity. }
  destruct (B4 re) as [_ [V _]]. unfold is_far_of. cbv zeta. split; [exact re |]. set (un := own_row l (carried l P' Q')) in *. set (mu := rate_unit s l) in *. set (o := mulv Q' (offset l)) in *.
  unfold row_off. fold D. destruct k as [| | m]; cbn [evelocities velocities].
  - change (map (value y theta) (list_of D)) with (coordinates (val3 y theta D)). rewrite V. reflexivity.
  - change (map (value y theta) [ex D; ey D]) with [vx (val3 y theta D); vy (val3 y theta D)]. rewrite V. reflexivity.
  - cbv zeta. rewrite twist_values, V. set (moment := ecross (snd z) D).
    assert (M : val3 y theta moment = vscale (ratio * mu) (cross o un)) by (unfold moment; rewrite val3_cross, hr, V; unfold cross, vscale; cbn [vx vy vz]; f_equal; ring).
    set (t := Machine.scaled (onward_rate (spin_off (Turns m))) (map2 plus moment (ecross moment (spin_off (Turns m))))).
    assert (T : val3 y theta t = vscale (2 / (1 + norm2 C)) (vadd (vscale (ratio * mu) (cross o un)) (cross (vscale (ratio * mu) (cross o un)) C)))
      by (unfold t; rewrite val3_scaled, val3_plus, val3_cross, value_onward_rate, hC, M; reflexivity).
    pose proof (f_equal vx T) as t1. pose proof (f_equal vy T) as t2. pose proof (f_equal vz T) as t3. unfold Chart.val3 in t1, t2, t3. cbn [vx vy vz] in t1, t2, t3.
    rewrite <- Pose.twist_scaled. f_equal. unfold Chart.val3. cbn [ex ey ez]. rewrite !value_times, t1, t2, t3, <- hu. set (v := value y theta unit). set (h := 2 / (1 + norm2 C)).
    destruct (cross o un) as [c1 c2 c3], C as [a1 a2 a3]. unfold vscale, vadd, cross. cbn [vx vy vz]. f_equal; ring.
Qed.

(** The row of M is that where it is not. *)
Lemma row_is_there : forall x theta L P Q f l mu, map (value x theta) (d_divided f) = map (Rmult mu) (driven_row k L P Q l) ->
  match k with Turns _ => L <> 0 /\ value x theta ell = ratio * L | _ => True end -> match k with Turns _ => value x theta unit * ratio = tau / dist | _ => True end ->
  map (value x theta) (row_there k ell unit (d_divided f)) = map (Rmult mu) (velocities k (own_row l (carried l P Q))
    (vscale (tau / dist * (2 / (1 + norm2 vzero))) (vadd (cross (mulv Q (offset l)) (own_row l (carried l P Q))) (cross (cross (mulv Q (offset l)) (own_row l (carried l P Q))) vzero)))).
Proof.
  intros x theta L P Q f l mu h hl hu. unfold driven_row in h. cbv zeta in h. set (un := own_row l (carried l P Q)) in *. set (o := mulv Q (offset l)) in *.
  destruct k as [| | m]; cbn [row_there velocities] in *; try exact h. destruct hl as [L0 hl].
  assert (TW : value x theta (times (times (integer 2) ell) unit) = 2 * L * (tau / dist)) by (rewrite !value_times, hl, <- hu; change (value x theta (integer 2)) with 2; ring).
  assert (ME : forall l0, map (value x theta) (map (fun e => times e (times (times (integer 2) ell) unit)) l0) = map (fun a => a * (2 * L * (tau / dist))) (map (value x theta) l0))
    by (intro l0; rewrite !map_map; apply map_ext; intro e; rewrite value_times, TW; ring).
  assert (N0 : norm2 vzero = 0) by (unfold norm2, vzero; cbn; ring).
  rewrite map_app, ME, <- firstn_map, <- skipn_map, h, N0. destruct un as [u1 u2 u3], o as [o1 o2 o3].
  destruct m; cbn [first_angle twist map firstn skipn app]; unfold vscale, vadd, cross, vzero; cbn [vx vy vz map app]; repeat (apply f_equal2; [field; repeat split; lra |]); reflexivity.
Qed.
End One.

Section Located.
Variables (tape : list (op address)) (whole divided : rows nat) (partial : list nat) (params : list fixed).
Variables (k : mobility) (turn : option (emat * formula)) (ell unit : formula) (s : Z) (ds : list (Z * Z)) (drs : list any_drive) (m : list driven) (P : vec) (Q : mat) (L : R).
Variables (cs th tb : list R) (error b angle : number) (angular : bool) (turned : option fixed).
Let ps := driven_layouts s ds drs.
Let theta := th ++ tb.
Let ratio := / two_to s.
Let x := map (Rmult ratio) (place_list k P) ++ cs.
Let found := place (formulas tape).
Let zs := all_drives k s (placed_off k turn) ds drs 0.
Let fs := all_driven k turn ell s ds drs 0.
Let far := map (row_off k ell unit) zs.
Let there := map (fun f => (row_there k ell unit (d_divided f), integer 1)) fs.
Let js := map d_joint fs.
Let dist := Claim.value b.
Let tau := match k with Turns _ => tangent (Claim.value angle) | _ => 1 end.
Let mu := / two_to (rate angular s).
Hypothesis not_about : k <> Turns AboutPoint.
Hypothesis drives_are : Forall2 is_driven drs m.
Hypothesis built : Forall well_formed_driven m.
Hypothesis nominal_built : Forall well_formed_driven (map nominal_driven drs).
Hypothesis reach : Forall (fun l => own_reach l (carried l P Q)) m.
Hypothesis units : Forall (fun l => rate_unit s l = mu /\ match l with Rotary _ => angular = true | Linear _ => True end) m.
Hypothesis th_within : Forall2 scaled_within ps th.
Hypothesis enclosed : forall th', Forall2 scaled_within ps th' -> Forall2 (contains) params (th' ++ tb).
Hypothesis legs : forall y k placed P Q, val3 y theta (eplace k) = vscale ratio P -> (forall b, val3 y theta (placed b) = mulv Q (val3 y theta b)) ->
  Forall2 (drives_there y theta s P Q) (all_drives k s placed ds drs 0) m.
Hypothesis place_is : is_position_of k P.
Hypothesis x_length : length x = freedom k.
Hypothesis place_at : val3 x theta (eplace k) = vscale ratio P /\ val3 x (map middle_of ps ++ tb) (eplace k) = vscale ratio P.
Hypothesis turn_is : forall y th', length th' = length th -> (forall i, (i < length cs)%nat -> nth (places_of k + i) y 0 = nth i cs 0) -> forall b, val3 y (th' ++ tb) (eturned turn b) = mulv Q (val3 y (th' ++ tb) b).
Hypothesis ell_is : match k with Turns _ => L <> 0 /\ forall y, value y theta ell = ratio * L | _ => True end.
Hypothesis unit_is : forall y, match k with Turns _ => value y theta unit * ratio = tau / dist | _ => True end.
Hypothesis all_found : forall f, In f (located_own ps far there js) -> formula_at tape (found f) = f.
Hypothesis angle_is : match k with Turns _ => 0 < Claim.value angle /\ is_angle (Claim.value angle) | _ => True end.
Hypothesis turned_is : forall t, turned = Some t -> contains t tau.
Hypothesis shown : forall o, In o (located_tests found (freedom k) (places_of k) (lasts_of k) angular ps s far there js turned error b) ->
  exists t, o = Some t /\ Check.holds bits tape whole divided partial params theta (freedom k) x t.

Lemma all_some_each : forall (A B : Type) (f : A -> option B) l m, all_some (map f l) = Some m -> Forall2 (fun a b => f a = Some b) l m.
Proof.
  intros A B f. induction l as [| a l IH]; intros r e; cbn [map all_some] in e; [injection e as <-; constructor |].
  destruct (f a) as [c |] eqn:fa; [| discriminate]. destruct (all_some (map f l)) as [r' |]; [| discriminate]. injection e as <-. constructor; [exact fa | apply IH; reflexivity].
Qed.
Lemma drives_length : forall k s placed drs ds j, length (all_drives k s placed ds drs j) = length drs.
Proof. intros k0 s0 placed0. induction drs0 as [| d l IH]; intros q j; cbn [all_drives length]; [reflexivity | rewrite IH; reflexivity]. Qed.
Lemma angle_form : forall k s placed ds drs j z, In z (all_drives k s placed ds drs j) ->
  match b_joint (fst z) with EAngle c a => exists A B T mode, c = elbow_of false A B T /\ a = signed mode (elbow_of true A B T) | _ => True end.
Proof.
  intros k0 s0 placed ds0 drs0. revert ds0. induction drs0 as [| dr drs0 IH]; intros ds0 j z i; [contradiction |]. cbn [all_drives] in i. destruct i as [<- | i]; [| exact (IH _ _ _ i)].
  destruct dr as [[c | a p [ax |] | n] | a]; try exact I. cbn [drive_at drive_from way_to tip_of fst arm_drive_formulas b_joint]. cbv zeta. do 4 eexists. split; reflexivity.
Qed.

(** Of a joint of the machine and of that of the nominal one. *)
Lemma leg_is_off : forall z l l0 j r, let theta0 := map middle_of ps ++ tb in
  drives_there x theta s P Q z l -> drives_there x theta0 s P Q z l0 -> well_formed_driven l -> well_formed_driven l0 -> own_reach l (carried l P Q) -> rate_unit s l = mu ->
  match b_joint (fst z) with EAngle c a => exists A B T mode, c = elbow_of false A B T /\ a = signed mode (elbow_of true A B T) | _ => True end ->
  joint_near found ps s error b (b_joint (fst z)) = Some j -> (forall e, In e (joint_forms (b_joint (fst z)) ++ map snd (joint_slopes ps (b_joint (fst z)))) -> formula_at tape (found e) = e) ->
  (forall th, Forall2 contains params th -> Forall (defined x th) (joint_forms (b_joint (fst z)))) -> 0 < dist -> 0 <= Claim.value error ->
  match l with Rotary _ => forall th ts, Forall2 contains params th -> Forall2 half (snd (snd j)) ts -> Rabs (ratio * dist * Linear.dot ts (map (fun h => value x th (formula_at tape (snd h))) (snd (snd j)))) < 1 | Linear _ => True end ->
  is_off (Claim.value error) (own_joint l0 (carried l0 P Q)) r -> exists y, moves_to y (own_joint l (carried l P Q)) r /\ may_be_off bits tape params x j (mu / dist * y).
Proof.
  intros z l l0 j r theta0 [[_ B1] _] [[_ B0] _] ok ok0 re hu form ej fnd def b0 e0 slow hr. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0.
  destruct (B1 ok) as [_ [_ [_ [_ J1]]]]. destruct (B0 ok0) as [_ [_ [_ [D0 J0]]]].
  assert (IN0 : Forall2 contains params theta0).
  { apply enclosed. pose proof (on_the_way_within 1 ps th ltac:(lra) th_within) as w. rewrite (proj2 (on_the_way_ends th (map middle_of ps) ltac:(rewrite map_length; symmetry; exact (related_length _ _ _ _ _ th_within)))) in w. exact w. }
  specialize (J1 re). specialize (J0 (D0 (def _ IN0))). destruct J1 as [_ [_ [J1 _]]]. destruct J0 as [_ [_ [J0 _]]].
  destruct (b_joint (fst z)) as [fm | c a |]; [| | discriminate].
  - destruct l as [l | l]; cbn [own_joint joint_is] in J1; [| contradiction]. destruct l0 as [l0 | l0]; cbn [own_joint joint_is] in J0; [| contradiction]. cbn [own_joint is_off rate_unit] in *.
    destruct r as [y' | ? ? |]; try contradiction. exists (y' - joint l (carried (Linear l) P Q)). split; [reflexivity |].
    pose proof (joint_is_off bits s b error ps th tb params tape fm x (ratio * y') _ _ j th_within enclosed J1 J0) as K. cbv zeta in K. fold ratio in K. cbn [joint_near] in ej.
    assert (Ej : fst j = found fm) by (unfold joint_test in ej; destruct (enclose_parameter bits _); [| discriminate]; destruct (changes_of _ _ _ _ _ _); [| discriminate]; injection ej as <-; reflexivity).
    specialize (K fnd ej). replace (mu / dist * (y' - joint l (carried (Linear l) P Q))) with ((ratio * y' - / two_to s * joint l (carried (Linear l) P Q)) / (ratio * Claim.value b)).
    + apply K; [| exact b0 |].
      * intros th' h. rewrite Ej, (fnd fm (or_introl eq_refl)). exact (Forall_inv (def th' h)).
      * fold ratio. rewrite <- Rmult_minus_distr_l, Rabs_mult, (Rabs_pos_eq ratio) by lra. apply Rmult_le_compat_l; [lra | exact hr].
    + fold ratio dist. rewrite <- hu. field. split; lra.
  - destruct l as [l | l]; cbn [own_joint joint_is] in J1; [contradiction |]. destruct l0 as [l0 | l0]; cbn [own_joint joint_is] in J0; [contradiction |]. cbn [own_joint rate_unit] in *.
    destruct form as [A [B [T [mode [-> ->]]]]]. destruct J1 as [j1 j2], J0 as [k1 k2]. rewrite <- k1, <- k2 in hr. rewrite <- j1, <- j2. cbn [joint_near] in ej.
    destruct (enclose_input bits (Radians (Over error b) (- s))) as [e |] eqn:ee; [| discriminate]. destruct (changes_from bits found ps s b _) as [hs |] eqn:eh; [| discriminate]. injection ej as <-. cbn [fst snd] in slow.
    destruct (angle_is_off s b error ps th tb params tape A B T mode x e hs r th_within enclosed) as [y [y1 y2]]; try assumption.
    + intros g ig. apply fnd. cbn [joint_forms joint_slopes]. apply in_or_app. right. exact ig.
    + intros th' h. exact (Forall_inv (def th' h)).
    + exists y. split; [exact y1 |]. replace (mu / dist * y) with (y / (ratio * Claim.value b)); [exact y2 |]. fold dist. rewrite <- hu. unfold ratio. pose proof (two_to_pos s). field. split; lra.
Qed.

Theorem located_legs : legs_recover k (map nominal_driven drs) m P Q error b angle.
Proof.
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. fold ratio in r0. unfold located_tests in shown.
  destruct (enclose_parameter bits (exactly b, s)) as [dd |] eqn:ed; [| destruct (shown None (or_introl eq_refl)) as [u [e _]]; discriminate].
  destruct turned as [tt |] eqn:et; [| destruct (shown None (or_introl eq_refl)) as [u [e _]]; discriminate].
  destruct (all_some (map (joint_near found ps s error b) js)) as [joints |] eqn:ej; [| destruct (shown None (or_introl eq_refl)) as [u [e _]]; discriminate].
  destruct (Nat.eqb (length js) (freedom k) && certainly bits false error && certainly bits true b) eqn:g; [| destruct (shown None (or_introl eq_refl)) as [u [e _]]; discriminate].
  apply andb_true_iff in g as [g b0]. apply andb_true_iff in g as [ln e0]. apply Nat.eqb_eq in ln. apply (positive_sound bits) in b0. apply (nonneg_sound bits) in e0. fold dist in b0.
  set (a := fun last => Nearby (map (map found) far) (map_rows found there) (map found (flat_map joint_forms js)) joints angular dd tt (places_of k) last) in *.
  assert (At : forall last, In last (lasts_of k) -> Check.located_at bits tape partial params theta (freedom k) x (a last)).
  { intros last i. destruct (shown _ (in_map (fun last => Some (Located (a last))) _ _ i)) as [u [e h]]. injection e as <-. exact h. }
  clear shown. assert (f_in : In false (lasts_of k)) by (destruct k; left; reflexivity).
  assert (HD : contains dd (ratio * dist)) by (replace (ratio * dist) with (dist / two_to s) by (unfold ratio, Rdiv; ring); exact (enclose_parameter_sound bits _ _ _ ed (exact_within b s))).
  pose proof (turned_is tt eq_refl) as HT. assert (t0 : 0 < tau) by (unfold tau; destruct k; try lra; destruct angle_is as [a0 ia]; exact (tangent_pos angle a0 ia)).
  assert (D0 : 0 <= ratio * dist) by (apply Rmult_le_pos; lra).
  set (n := freedom k) in *. set (f := places_of k) in *. set (near := fun u => Check.near_at x (a false) (ratio * dist) tau u).
  set (J := fun u => Check.far_at tape theta x (a false) (ratio * dist) tau u).
  assert (InFar : forall z e, In z zs -> In e (row_off k ell unit z) -> formula_at tape (found e) = e).
  { intros z e iz ie. apply all_found. unfold located_own. apply in_or_app. left. apply in_concat. exists (row_off k ell unit z). split; [apply in_map, iz | exact ie]. }
  assert (InThere : forall e, In e (entries there) -> formula_at tape (found e) = e) by (intros e ie; apply all_found; unfold located_own; apply in_or_app; right; apply in_or_app; left; exact ie).
  assert (InJoint : forall j e, In j js -> In e (joint_forms j ++ map snd (joint_slopes ps j)) -> formula_at tape (found e) = e)
    by (intros j e ij ie; apply all_found; unfold located_own; apply in_or_app; right; apply in_or_app; right; apply in_flat_map; exists j; split; assumption).
  assert (JE : forall u, J u = map (fun z => map (value (near u) theta) (row_off k ell unit z)) zs).
  { intro u. unfold J, Check.far_at. cbn [a l_far]. unfold far. rewrite !map_map. apply map_ext_in. intros z iz. rewrite map_map. apply map_ext_in. intros e ie. exact (f_equal (value (near u) theta) (InFar z e iz ie)). }
  assert (NEAR : forall u, length u = n -> val3 (near u) theta (eplace k) = vscale ratio (position_off k P dist u) /\ (forall i, (i < length cs)%nat -> nth (f + i) (near u) 0 = nth i cs 0) /\
    val3 (near u) theta (spin_off k) = vscale tau (spin_by k u)) by (intros u lu; exact (near_places k P ratio cs dist tau u theta place_is not_about x_length lu)).
  assert (Z3 : vscale tau vzero = vzero) by (unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring).
  assert (PLACED : forall u, length u = n -> forall c, val3 (near u) theta (placed_off k turn c) = mulv (turn_off k Q tau u) (val3 (near u) theta c)).
  { intros u lu c. destruct (NEAR u lu) as [_ [n2 n3]]. pose proof (turn_is (near u) th eq_refl n2 c) as T. fold theta in T. unfold placed_off, turn_off. destruct k as [| | mo]; cbn [spin_by] in *; try (rewrite Z3, not_moved; exact T).
    unfold eonward. cbv zeta. rewrite val3_plus, val3_scaled, val3_plus, !val3_cross, value_onward_rate, n3, T, moved_on_onward. reflexivity. }
  assert (ZS : forall u, length u = n -> Forall2 (drives_there (near u) theta s (position_off k P dist u) (turn_off k Q tau u)) zs m) by (intros u lu; exact (legs (near u) k _ _ _ (proj1 (NEAR u lu)) (PLACED u lu))).
  assert (hz : length (Twofold.nought n) = n /\ Twofold.norm f (Twofold.nought n) <= 1) by (split; [apply Twofold.nought_length | pose proof (Twofold.nought_norm f n); lra]).
  assert (lz : length zs = length m) by exact (related_length _ _ _ _ _ (ZS _ (proj1 hz))).
  assert (lm : length m = n) by (transitivity (length drs); [symmetry; exact (related_length _ _ _ _ _ drives_are) | transitivity (length js); [unfold js, fs, all_driven; rewrite !map_length; symmetry; apply drives_length | exact ln]]).
  assert (lJ : forall u, length (J u) = n).
  { intro u. rewrite JE, map_length, lz. exact lm. }
  (* as one where the platform turns only *)
  destruct (At false f_in) as [DEF [lf [lfar [rowlen G0]]]]. cbn [a l_defined l_first l_far l_angular l_distance l_turn l_joints l_rows l_last] in *.
  assert (FAR : forall u, length u = n /\ Twofold.norm f u <= 1 -> Forall2 (fun row l => is_far_of k mu dist tau l (position_off k P dist u) (turn_off k Q tau u) (vscale tau (spin_by k u)) row) (J u) m).
  { intros u hu. destruct (G0 (ratio * dist) tau HD HT D0 (Rlt_le _ _ t0)) as [_ [g_ [_ [G _]]]]. destruct (G u hu) as [d _]. apply Forall_app in d as [_ d].
    rewrite JE. pose proof (ZS u (proj1 hu)) as Z. assert (Dz : forall z, In z zs -> Forall (defined (near u) theta) (row_off k ell unit z)).
    { intros z iz. apply Forall_forall. intros e ie. rewrite Forall_forall in d. specialize (d (found e)). change (nth (found e) (formulas tape) (integer 0)) with (formula_at tape (found e)) in d. rewrite (InFar z e iz ie) in d. apply d.
      apply in_concat. exists (map found (row_off k ell unit z)). split; [change (In (map found (row_off k ell unit z)) (map (map found) (map (row_off k ell unit) zs))); apply in_map, in_map, iz | apply in_map, ie]. }
    clear - Z built units Dz not_about b0 NEAR hu unit_is r0. revert built units. revert Dz Z. generalize zs. intros zs' Dz Z. induction Z as [| z l zs' m' hzl hs IH]; intros built units; cbn [map]; constructor.
    - inversion built; inversion units as [| ? ? [hu1 _] _]; subst. rewrite <- hu1. pose proof (Dz z (or_introl eq_refl)) as dz. destruct (NEAR u (proj1 hu)) as [_ [_ n3]].
      exact (row_is_far k ell unit s dist tau not_about (near u) theta z l _ _ _ hzl ltac:(assumption) n3 (unit_is (near u)) dz).
    - apply IH; [intros y iy; apply Dz; right; exact iy | inversion built; assumption | inversion units; assumption]. }
  assert (P0 : position_off k P dist (Twofold.nought n) = P).
  { unfold position_off, n. rewrite (proj1 (nothing_off k)). destruct P as [p1 p2 p3]. unfold vadd, vscale, vzero. cbn [vx vy vz]. f_equal; ring. }
  assert (Q0 : turn_off k Q tau (Twofold.nought n) = Q) by (unfold turn_off, n; rewrite (proj2 (nothing_off k)), Z3; apply not_moved).
  assert (SLOW : forall u v, length u = n /\ Twofold.norm f u <= 1 -> Forall (fun t => -1 <= t <= 1) v -> Forall2 (fun row l => match l with Rotary _ => Rabs (dist / mu * Linear.dot row v) < 1 | Linear _ => True end) (J u) m).
  { intros u v hu hv. pose proof (FAR u hu) as F. destruct (Bool.bool_dec angular true) as [ea | na].
    - destruct (G0 (ratio * dist) tau HD HT D0 (Rlt_le _ _ t0)) as [ang _]. destruct (ang ea) as [S _]. specialize (S u v hu hv). fold (J u) in S.
      assert (E : dist / mu = ratio * dist) by (unfold mu; rewrite ea; cbn [rate]; rewrite two_to_opposite; unfold ratio; field; pose proof (two_to_pos s); lra).
      rewrite E. clear - F S. revert S. induction F as [| row l rs m' _ hs IH]; intro S; constructor; [destruct l; [exact I | exact (Forall_inv S)] | apply IH; exact (Forall_inv_tail S)].
    - clear - F units na. revert units. induction F as [| row l rs m' _ hs IH]; intro units; constructor; [destruct l; [exact I | destruct (Forall_inv units) as [_ e]; contradiction] | apply IH; exact (Forall_inv_tail units)]. }
  set (Z0 := all_drives k s (eturned turn) ds drs 0).
  assert (cs_at : forall i, (i < length cs)%nat -> nth (f + i) x 0 = nth i cs 0).
  { intros i _. unfold f, x. replace (places_of k) with (length (map (Rmult ratio) (place_list k P))) by (destruct k as [| | []]; reflexivity). apply app_nth2_plus. }
  assert (lt : length (map middle_of ps) = length th) by (rewrite map_length; exact (related_length _ _ _ _ _ th_within)).
  assert (THERE : Forall2 (drives_there x theta s P Q) Z0 m) by exact (legs x k (eturned turn) P Q (proj1 place_at) (turn_is x th eq_refl cs_at)).
  assert (THERE0 : Forall2 (drives_there x (map middle_of ps ++ tb) s P Q) Z0 (map nominal_driven drs))
    by exact (nominal_legs_drive s drs m drives_are ds x [] tb k (eturned turn) P Q (proj2 place_at) (turn_is x (map middle_of ps) lt cs_at)).
  assert (ROWS : map fst (map_rows (value x theta) (map_rows (formula_at tape) (map_rows found there))) = J (Twofold.nought n)).
  { assert (RF : map_rows (formula_at tape) (map_rows found there) = there) by exact (rows_found tape there InThere). rewrite RF. clear RF. pose proof (FAR _ hz) as F. rewrite P0, Q0 in F. unfold n in F at 1 2. rewrite (proj2 (nothing_off k)), Z3 in F.
    pose proof (drives_stand x theta s k ell L P Q (proj1 place_at) ltac:(destruct k; auto; destruct ell_is as [a1 a2]; split; [exact a1 | apply a2]) Z0 m THERE) as ST. fold fs in ST. fold n in F.
    unfold there. clear - F ST not_about built reach units ell_is unit_is b0 r0. revert F. generalize (J (Twofold.nought n)). revert built reach units.
    change (map (fun z => pose_of k ell (fst z) (snd z)) Z0) with fs in ST. revert ST. generalize fs. intros fs' ST. induction ST as [| p l fs' m' h hs IH]; intros built reach units rs F; inversion F as [| row ? rs' ? f1 f2]; subst; [reflexivity |].
    cbn [map]. rewrite map_rows_cons. cbn [map fst]. f_equal; [| apply IH; [exact (Forall_inv_tail built) | exact (Forall_inv_tail reach) | exact (Forall_inv_tail units) | exact f2]].
    destruct f1 as [_ ->]. destruct h as [_ h]. destruct (h (Forall_inv built)) as [_ [_ [_ h4]]]. destruct (h4 (Forall_inv reach)) as [_ [h5 _]]. rewrite (proj1 (Forall_inv units)) in h5.
    apply (row_is_there k ell unit s dist tau b0 not_about x theta L P Q p l mu h5); [destruct k; auto; destruct ell_is as [a1 a2]; split; [exact a1 | apply a2] | apply unit_is]. }
  assert (OFFS : forall rho, Forall2 (fun l r => is_off (Claim.value error) (own_joint l (carried l P Q)) r) (map nominal_driven drs) rho -> exists xs,
    Forall2 (fun y lr => moves_to y (own_joint (fst lr) (carried (fst lr) P Q)) (snd lr)) xs (combine m rho) /\ Forall2 (may_be_off bits tape params x) joints (map (Rmult (mu / dist)) xs)).
  { intros rho hr. pose proof (all_some_each _ _ _ _ _ ej) as EJ. unfold js, fs, all_driven in EJ. rewrite map_map in EJ. fold Z0 in EJ.
    assert (SL : angular = true -> Forall (fun j => forall th ts, Forall2 contains params th -> Forall2 half (snd (snd j)) ts -> Rabs (ratio * dist * Linear.dot ts (map (fun h => value x th (formula_at tape (snd h))) (snd (snd j)))) < 1) joints).
    { intro ea. destruct (G0 (ratio * dist) tau HD HT D0 (Rlt_le _ _ t0)) as [ang _]. exact (proj2 (ang ea)). }
    assert (FORM : forall z, In z Z0 -> match b_joint (fst z) with EAngle c a => exists A B T mode, c = elbow_of false A B T /\ a = signed mode (elbow_of true A B T) | _ => True end) by (intros z iz; exact (angle_form _ _ _ _ _ _ z iz)).
    assert (INJ : forall z, In z Z0 -> In (b_joint (fst z)) js) by (intros z iz; unfold js, fs, all_driven; rewrite map_map; exact (in_map (fun z => b_joint (fst z)) Z0 z iz)).
    assert (DEFZ : forall z, In z Z0 -> forall th, Forall2 contains params th -> Forall (defined x th) (joint_forms (b_joint (fst z)))).
    { intros z iz th' h. specialize (DEF th' h). apply Forall_forall. intros e ie. rewrite Forall_forall in DEF.
      assert (K : In (found e) (map found (flat_map joint_forms js))) by (apply in_map, in_flat_map; exists (b_joint (fst z)); split; [exact (INJ z iz) | exact ie]).
      specialize (DEF (found e) K). change (nth (found e) (formulas tape) (integer 0)) with (formula_at tape (found e)) in DEF. rewrite (InJoint (b_joint (fst z)) e (INJ z iz) (in_or_app _ _ _ (or_introl ie))) in DEF. exact DEF. }
    assert (FOUND : forall z, In z Z0 -> forall e, In e (joint_forms (b_joint (fst z)) ++ map snd (joint_slopes ps (b_joint (fst z)))) -> formula_at tape (found e) = e) by (intros z iz e ie; exact (InJoint _ e (INJ z iz) ie)).
    clear - THERE THERE0 EJ SL FORM DEFZ FOUND hr built nominal_built reach units b0 e0 th_within enclosed.
    revert rho hr joints EJ SL THERE0 nominal_built built reach units FORM DEFZ FOUND. generalize (map nominal_driven drs). intros l0s rho hr joints EJ SL THERE0. revert l0s THERE0 rho hr joints EJ SL.
    induction THERE as [| z l zs' m' h hs IH]; intros l0s T0 rho hr joints EJ SL nb wf re un FORM DEFZ FOUND; inversion T0 as [| ? l0 ? l0s' t1 t2]; subst; inversion hr as [| ? r ? rho' r1 r2]; subst; cbn [map] in EJ; inversion EJ as [| ? j ? joints' j1 j2]; subst.
    - exists []. split; constructor.
    - destruct (IH _ t2 _ r2 _ j2 (fun ea => Forall_inv_tail (SL ea)) (Forall_inv_tail nb) (Forall_inv_tail wf) (Forall_inv_tail re) (Forall_inv_tail un) (fun y iy => FORM y (or_intror iy)) (fun y iy => DEFZ y (or_intror iy)) (fun y iy => FOUND y (or_intror iy))) as [xs [x1 x2]].
      destruct (leg_is_off z l l0 j r h t1 (Forall_inv wf) (Forall_inv nb) (Forall_inv re) (proj1 (Forall_inv un)) (FORM z (or_introl eq_refl)) j1 (FOUND z (or_introl eq_refl)) (DEFZ z (or_introl eq_refl)) b0 e0) as [y [y1 y2]];
        [destruct l; [exact I | exact (Forall_inv (SL (proj2 (Forall_inv un))))] | exact r1 |].
      exists (y :: xs). cbn [combine map]. split; constructor; assumption. }
  assert (PART : forall last, In last (lasts_of k) -> forall xs, Forall2 (may_be_off bits tape params x) joints (map (Rmult (mu / dist)) xs) -> exists g, 0 <= g /\
    (forall u w, length u = n /\ Twofold.norm f u <= 1 -> length w = n -> Twofold.size (Twofold.less (Twofold.image (J u) w) (Twofold.image (J (Twofold.nought n)) w)) <= g * Twofold.norm f u * Twofold.norm f w) /\
    forall g', 0 <= g' <= g -> Twofold.met f n J g' (map (Rmult (mu / dist)) xs) last).
  { intros last il xs hxs. destruct (At last il) as [_ [_ [_ [_ G]]]]. destruct (G (ratio * dist) tau HD HT D0 (Rlt_le _ _ t0)) as [_ [g [g0 [G1 [kappa [z [e [k1 [k2 [k3 [k4 [k5 [k6 k7]]]]]]]]]]]]].
    exists g. split; [exact g0 |]. split.
    - intros u w hu lw. destruct (G1 u hu) as [_ h]. specialize (h w lw). change (Check.far_at tape theta x (a last) (ratio * dist) tau) with J in h. fold n f in h. cbn [a l_first] in h. fold f in h. lra.
    - intros g' [q1 q2]. exists kappa, z, e. split; [lra |]. split; [exact k2 |]. split.
      + assert (g' / (2 * kappa) <= g / (2 * kappa)); [| lra]. unfold Rdiv. apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; lra | exact q2].
      + split; [exact k4 |]. split; [exact k5 |]. split; [exact k6 |]. intros w lw. cbv zeta. specialize (k7 w lw). cbv zeta in k7. cbn [a l_rows l_joints] in k7. rewrite ROWS in k7. destruct k7 as [c1 c2]. split; [exact c1 |]. intros t nz. exact (c2 _ t hxs nz). }
  apply (legs_recovered k (map nominal_driven drs) m P Q error b angle J mu tau); try assumption.
  - apply Rinv_0_lt_compat, two_to_pos.
  - unfold tau. destruct k; auto.
  - rewrite map_length. transitivity (length m); [exact (related_length _ _ _ _ _ drives_are) | exact lm].
  - intros rho hr. destruct (OFFS rho hr) as [xs [x1 x2]]. destruct (PART false f_in xs x2) as [g1 [g10 [s1 m1]]].
    destruct k as [| | mo] eqn:ek.
    + exists g1, xs. split; [exact g10 |]. split; [exact x1 |]. split; [exact s1 |]. intros [|]; [left; reflexivity | right; apply m1; lra].
    + exists g1, xs. split; [exact g10 |]. split; [exact x1 |]. split; [exact s1 |]. intros [|]; [left; reflexivity | right; apply m1; lra].
    + destruct (PART true (or_intror (or_introl eq_refl)) xs x2) as [g2 [g20 [s2 m2]]]. exists (Rmin g1 g2), xs.
      assert (M1 : 0 <= Rmin g1 g2 <= g1) by (split; [apply Rmin_glb; assumption | apply Rmin_l]). assert (M2 : 0 <= Rmin g1 g2 <= g2) by (split; [apply Rmin_glb; assumption | apply Rmin_r]).
      split; [apply M1 |]. split; [exact x1 |]. split; [intros u w hu lw; specialize (s1 u w hu lw); specialize (s2 u w hu lw); unfold Rmin; destruct (Rle_dec g1 g2); assumption |].
      intros [|]; right; [apply m2, M2 | apply m1, M1].
Qed.
End Located.
End Precision.
End Named.
