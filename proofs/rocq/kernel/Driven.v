(** * Certified claims about legs in any motion: tests, and what an accepted tree says *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Linear Arithmetic Slope Test Cell Check Number Trig Formula Machine Problem Witness Orientation Turning Control Chart Configuration Inputs Onward Poses Pose Arm Legs Recover Drives Locate LegBend.
From Orthocert.kernel Require Solve Load.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Tests *)

Definition edeterminant (rows : list (list formula)) : formula :=
  match rows with
  | [[a; b]; [c; d]] => minor a b c d
  | [[a; b; c]; [d; e; f]; [g; h; i]] => plus (minus (times a (minor e f h i)) (times b (minor d f g i))) (times c (minor d e g h))
  | _ => integer 0
  end.
Fixpoint lengths_of_all (fs : list pose_formulas) : option (list formula) :=
  match fs with [] => Some [] | f :: fs' => match d_rod f, lengths_of_all fs' with Some (_, len), Some l => Some (len :: l) | _, _ => None end end.

(** For each test, the formulas of which one is not negative; [q]: those of the demand's numbers. *)
Definition signs_of (fs : list pose_formulas) (q : list formula) (d : demand) : list (list formula) :=
  let b k := nth k q (integer 0) in
  let of_leg i (g : pose_formulas -> list (list formula)) := match nth_error fs i with Some f => g f | None => [] end in
  let fast f := [[fold_left (fun rest a => minus rest (square a)) (d_A f) (times (square (b 0%nat)) (d_D f))]] in
  let long f := match d_rod f with Some (e2, len) => [[minus e2 (times (square (b 0%nat)) (square len))]] | None => [] end in
  match d with
  | LengthMin i _ => of_leg i (fun f => match d_joint f with ELength r => [[minus r (b 0%nat)]] | _ => [] end)
  | LengthMax i _ => of_leg i (fun f => match d_joint f with ELength r => [[minus (b 0%nat) r]] | _ => [] end)
  | AngleWithin i _ _ => of_leg i (fun f => match d_joint f with
      | EAngle c s => [[minus (times s (b 0%nat)) (times c (b 1%nat))]; [minus (times (b 3%nat) c) (times (b 2%nat) s)]]
      | _ => []
      end)
  | SpeedMax i _ _ => of_leg i (fun f => match d_joint f with EAngle _ _ => [] | _ => fast f end)
  | TurnMax i _ _ => of_leg i (fun f => match d_joint f with EAngle _ _ => fast f | _ => [] end)
  | SerialMin i _ => of_leg i long
  | LegAngleMax i _ => of_leg i (fun f => match d_joint f with ELength _ => long f | _ => [] end)
  | ParallelMin _ => match lengths_of_all fs with
      | Some ls => let least := fold_left times ls (b 0%nat) in let det := edeterminant (map d_vector fs) in [[minus det least; opposite (plus det least)]]
      | None => []
      end
  | LoadMax i _ _ => of_leg i (fun f => let det := edeterminant (map d_A fs) in
      let beyond c := [minus det c; opposite (plus det c)] in let c := times (root (d_D f)) (edeterminant (replaced i q (map d_A fs))) in [beyond c; beyond (opposite c)])
  | _ => []
  end.
Definition pose_rows (fs : list pose_formulas) : rows formula := map (fun f => (d_A f, d_D f)) fs.
Definition pose_divided (fs : list pose_formulas) : rows formula := map (fun f => (d_divided f, integer 1)) fs.
Definition own_of (fs : list pose_formulas) (q : list formula) (d : demand) : list formula :=
  match d with StiffnessMin _ _ => entries (stiffened (pose_rows fs) q) | _ => concat (signs_of fs q d) end.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Definition tests_for (place : formula -> nat) (fs : list pose_formulas) (are_angles : bool) (s : Z) (q : list formula) (d : demand) : list (option test) :=
  let squared make x := [option_map (fun a => make (sqr bits a)) (enclose_parameter bits (exactly x, rate are_angles s))] in
  match d with
  | Nonsingular => [Some (SigmaMin zero)]
  | FactorMax b => squared SigmaMin (Over (1 // 1) b)
  | FactorMin b => squared SigmaMax (Over (1 // 1) b)
  | Conditioned b => [option_map (fun a => Conditioning (sqr bits a)) (enclose_parameter bits (exactly b, 0%Z))]
  | StiffnessMin ks b => [if certainly bits true b && forallb (certainly bits true) ks
      then Some (Least (map_rows place (stiffened (pose_rows fs) q)) (Fixed.integer bits 1)) else None]
  | ForceMax i tool b => match nth_error fs i with
      | Some _ => if certainly bits true tool && certainly bits true b then squared (Solved i) (Over tool b) else [None]
      | None => [None]
      end
  | _ =>
      let ok := match d with
        | AngleWithin _ a b => certainly bits true (Minus b a) && certainly bits true (Minus (Plus a (180 // 1)) b)
        | SpeedMax _ tool b | TurnMax _ tool b => certainly bits true tool && certainly bits false b
        | LoadMax _ force b => certainly bits true b && is_square (length force) (map d_A fs)
        | _ => true
        end in
      match (if ok then signs_of fs q d else []) with
      | [] => [None]
      | l => map (fun fs => match fs with [f] => Some (AtLeast (place f)) | [f; g] => Some (Either (place f) (place g)) | _ => None end) l
      end
  end.
Definition rules_out (d : demand) : bool := match d with Nonsingular | FactorMax _ => true | _ => false end.

Definition position_edges (k : mobility) (w : region) : list tolerance :=
  let t := hull w in match k with Translates => [tx t; ty t; tz t] | TranslatesInPlane => [tx t; ty t] | Turns m => position_tolerances m t end.
Definition is_flat_region (k : mobility) (w : region) : bool :=
  match k with Translates => true | TranslatesInPlane => is_flat InPlane (hull w) | Turns m => is_flat m (hull w) end.
Definition first_of (k : mobility) : nat := match k with Turns m => first_angle m | _ => 0 end.
Definition inside_region (k : mobility) (w : region) (s : Z) : list fixed -> option slope := match k with Translates => Problem.tangent bits w s | _ => fun _ => None end.
Definition are_angular (ds : list any_drive) : bool := match ds with RotaryDrive _ :: _ => true | _ => false end.
Definition is_angular_drive (d : any_drive) : bool := match d with RotaryDrive _ => true | LinearDrive _ => false end.
(** Orientations are given of platforms that turn, but about a point, and these have a length. *)
Definition is_oriented (c : driven_claim) : bool :=
  match mobility_of c, turned_by c with
  | Turns AboutPoint, _ => false
  | Turns _, Some o => certainly bits true (length_of c) && forallb (fun t => is_angle_number bits (least t) && is_angle_number bits (greatest t)) (angles_of o)
  | (Translates | TranslatesInPlane), None => true
  | _, _ => false
  end.

Definition is_with_end (d : any_drive) : bool := match d with LinearDrive (PlanarLeg _) => false | _ => true end.

(** Accuracy of platforms that turn: of legs with two ends, and angles of less than half a turn. *)
Definition may_be_near (k : mobility) (drs : list any_drive) (angle : number) : bool :=
  match k with Turns _ => certainly bits true angle && is_angle_number bits angle && forallb is_with_end drs | _ => true end.
Definition tangent_of (k : mobility) (angle : number) : option fixed := match k with Turns _ => enclose_tangent bits angle | _ => Some (Fixed.integer bits 1) end.

(** Of claims that no two poses have the same joint coordinates: the one matrix, and before which other test this is counted. *)
Variables (one_matrix : N * list (list Z)) (one_place : nat).

Definition curve_angles (c : driven_claim) : list number := match turned_by c with Some o => curved o | None => [] end.

Definition check_driven (c : driven_claim) (s : Z) (ds : list (Z * Z)) (t : tree) : bool :=
  let k := mobility_of c in let n := freedom k in let demands := driven_demands c in
  let lay := driven_layouts s ds (drives c) in let ell := (exactly (length_of c), s) in
  let j := S (length lay) in let angular := are_angular (drives c) in
  let turn := option_map (fun o => chart o (first_of k)) (turned_by c) in
  let fs := all_driven k turn (quantity ell (length lay)) s ds (drives c) 0 in
  let far q := map (row_off k (quantity ell (length lay)) (turn_unit q)) (all_drives k s (placed_off k turn) ds (drives c) 0) in
  let there q := map (fun f => (row_there k (quantity ell (length lay)) (turn_unit q) (d_divided f), integer 1)) fs in let js := map d_joint fs in
  let zs := all_from s ds (drives c) 0 in
  let own q d := match d with
    | OnePose _ _ _ => located_own lay (far q) (there q) js
    | AccelerationMax i _ _ _ => accelerated_own k (eturned turn) (quantity ell (length lay)) (length lay) fs zs q i
    | _ => own_of fs q d
    end in
  let built := flat_map d_built fs in let about := if only_pose c then map (fun f => (d_origin f, d_D f)) fs else [] in
  let wanted := entries (pose_rows fs) ++ entries (pose_divided fs) ++ built ++ of_each own angular s j demands ++ entries about in
  let tape := compile wanted in
  let all := formulas tape in let place := place all in
  let tests_of q d := match d with
    | OnePose error b angle => if may_be_near k (drives c) angle
        then located_tests bits place n (places_of k) (lasts_of k) angular lay s (far q) (there q) js (tangent_of k angle) error b else [None]
    | AccelerationMax i a v b => accelerated_tests bits place k (eturned turn) (quantity ell (length lay)) (length lay) fs zs q i a v b
    | _ => tests_for place fs angular s q d
    end in
  forallb (fun e => same (nth (place e) all (integer 0)) e) wanted && existsb rules_out demands && is_flat_region k (place_of c) && is_oriented c &&
  forallb (fun d => Bool.eqb (is_angular_drive d) angular) (drives c) &&
  (negb (only_pose c) || turns_less bits k (turned_by c) && forallb is_with_end (drives c)) &&
  match all_some (map (enclose_parameter bits) (lay ++ [ell])), all_some (map (enclose_input bits) (flat_map (inputs_of angular s) demands)),
        all_some (map (fun t => enclose_parameter bits (t, s)) (position_edges k (place_of c))),
        match turned_by c with Some o => all_some (map (end_box bits) (chart_ends o)) | None => Some [] end,
        all_some (map (enclose_tangent bits) (curve_angles c)),
        all_some (of_each tests_of angular s j demands) with
  | Some params, Some inputs, Some box, Some angles, Some tangents, Some tests =>
      let tests := if only_pose c then inserted one_place tests (Chords (map_rows place about) (fst one_matrix) (snd one_matrix)) else tests in
      Nat.eqb (length (box ++ angles)) n &&
      check bits tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place built) (params ++ inputs ++ tangents) tests
        (inside_region k (place_of c) s) (box ++ angles) (all_open tests) t
  | _, _, _, _, _, _ => false
  end.
End Precision.

(** ** Soundness *)

(** An angle between these, of less than half a turn, by the signs of two sines. *)
Lemma angle_between : forall a b c s, c ^ 2 + s ^ 2 = 1 -> 0 < b - a < 180 ->
  0 <= s * cos (in_degrees a) - c * sin (in_degrees a) -> 0 <= sin (in_degrees b) * c - cos (in_degrees b) * s ->
  exists angle, a <= angle <= b /\ c = cos (in_degrees angle) /\ s = sin (in_degrees angle).
Proof.
  intros a b c s one [h1 h2] h3 h4. pose proof PI_RGT_0 as p0. set (A := in_degrees a) in *. set (B := in_degrees b) in *.
  assert (BA : 0 < B - A < PI) by (unfold A, B, in_degrees; split; nra).
  pose proof (sin2_cos2 A) as u. unfold Rsqr in u.
  set (C := c * cos A + s * sin A). set (S := s * cos A - c * sin A) in *.
  assert (CS : C ^ 2 + S ^ 2 = 1) by (unfold C, S; transitivity ((c ^ 2 + s ^ 2) * (sin A * sin A + cos A * cos A)); [ring | rewrite one, u; ring]).
  assert (C1 : -1 <= C <= 1) by (split; nra).
  destruct (cosine_taken C C1) as [d [ab ca]]. assert (sa : sin d = S).
  { pose proof (sin_ge_0 d (proj1 ab) (proj2 ab)) as s0. pose proof (sin2_cos2 d) as v. unfold Rsqr in v. rewrite ca in v. nra. }
  assert (E : in_degrees (a + d * 180 / PI) = A + d) by (unfold A, in_degrees; field; lra).
  assert (ec : cos (A + d) = c).
  { rewrite cos_plus, ca, sa. unfold C, S. transitivity (c * (sin A * sin A + cos A * cos A)); [ring | rewrite u; ring]. }
  assert (es : sin (A + d) = s).
  { rewrite sin_plus, ca, sa. unfold C, S. transitivity (s * (sin A * sin A + cos A * cos A)); [ring | rewrite u; ring]. }
  exists (a + d * 180 / PI). rewrite E, ec, es. split; [| split; reflexivity]. split.
  - assert (0 <= d * 180 / PI) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat, p0]). lra.
  - assert (y0 : 0 <= B - (A + d)).
    { apply Rnot_lt_le. intro n. pose proof (sin_lt_0_var (B - (A + d)) ltac:(lra) n) as q. rewrite sin_minus, ec, es in q. lra. }
    apply Rmult_le_reg_r with (PI / 180); [lra |]. replace ((a + d * 180 / PI) * (PI / 180)) with (A + d) by (unfold A, in_degrees; field; lra).
    replace (b * (PI / 180)) with B by (unfold B, in_degrees; field). lra.
Qed.

Lemma value_less_squares : forall x theta l r, Formula.value x theta (fold_left (fun rest a => minus rest (square a)) l r)
  = Formula.value x theta r - Linear.dot (map (Formula.value x theta) l) (map (Formula.value x theta) l).
Proof.
  intros x theta. induction l as [| a l IH]; intro r; cbn [fold_left map Linear.dot]; [ring |]. rewrite IH, value_minus, Formula.value_square. ring.
Qed.
Lemma dot_scaled_self : forall c u, Linear.dot (map (Rmult c) u) (map (Rmult c) u) = c ^ 2 * Linear.dot u u.
Proof. intros c u. rewrite dot_map, Solve.dot_commutes, dot_map. ring. Qed.
Lemma value_edeterminant : forall x theta rows, Formula.value x theta (edeterminant rows) = determinant (map (map (Formula.value x theta)) rows).
Proof.
  intros x theta [| [| a [| b [| c [| ? ?]]]] [| [| d [| e [| y [| ? ?]]]] [| [| g [| h [| i [| ? ?]]]] [| ? ?]]]]; cbn [edeterminant determinant map]; try reflexivity;
    unfold minor; rewrite ?value_plus, ?value_minus, ?value_times, ?value_minus, ?value_times; ring.
Qed.
Lemma determinant_scaled : forall c rows, determinant (map (map (Rmult c)) rows) = c ^ length rows * determinant rows.
Proof.
  intros c [| [| a [| b [| e [| ? ?]]]] [| [| d [| f [| g [| ? ?]]]] [| [| h [| i [| j [| ? ?]]]] [| ? ?]]]]; cbn [determinant map length pow]; ring.
Qed.

(** Accelerations are shown in LegBend.v, and accuracy in Locate.v. *)
Lemma reached_aside : forall n J X T l p a r A B d, Configuration.fulfils n (Configuration J X T l p (fun _ _ _ _ => False) (fun _ _ _ => False) A) d -> Configuration.fulfils n (Configuration J X T l p a r B) d.
Proof. intros n J X T l p a r A B [] h; try exact h; cbn in *; [| destruct h]. intros v w lv lw hv hw. destruct (h v w lv lw hv hw) as [y [[] _]]. Qed.

(** What is asked of a joint at a point: its row of M, its coordinate, the leg, and where it is reached. *)
Record seen := Seen { seen_row : list R; seen_joint : coordinate; seen_rod : option Configuration.rod; seen_reach : Prop }.

Section Fulfilled.
Variable bits : positive.
Variables (x theta : list R) (s : Z) (n : nat) (are_angles : bool) (fs : list pose_formulas) (m : list seen) (here : vec -> vec).
Variables (tape : list (op address)) (params : list fixed) (partial : list nat).
Local Notation value := (Formula.value x theta).
Local Notation found := (place (formulas tape)).
Local Notation holds := (Check.holds bits tape (map_rows found (pose_rows fs)) (map_rows found (pose_divided fs)) partial params theta n x).
Let mu := / two_to (rate are_angles s).
Let conf := Configuration (map seen_row m) (map seen_joint m) (map seen_rod m) [] here (fun _ _ _ _ => False) (fun _ _ _ => False) True.
(** The formulas of a joint, in the unit of the check. *)
Definition is_good (f : pose_formulas) (l : seen) : Prop :=
  let mu := / two_to (rate are_angles s) in let u := / two_to s in
  length (seen_row l) = n /\
  match seen_joint l with Angle c a => mu = two_to s /\ (seen_reach l -> c ^ 2 + a ^ 2 = 1) | _ => mu = 1 end /\
  (0 < value (d_D f) -> seen_reach l) /\ (seen_reach l -> 0 < value (d_D f)) /\ (Forall (Formula.defined x theta) (d_divided f) -> seen_reach l) /\
  (seen_reach l ->
    (exists q, q ^ 2 = value (d_D f) /\ map value (d_A f) = map (Rmult (q * mu)) (seen_row l)) /\ map value (d_divided f) = map (Rmult mu) (seen_row l) /\
    joint_is x theta s (d_joint f) (seen_joint l) /\
    match d_rod f with
    | Some (e2, len) => exists q, seen_rod l = Some q /\ value e2 = (u * rod_eta q) ^ 2 /\ value len = u * rod_size q /\ map value (d_vector f) = map (Rmult u) (rod_vector q)
    | None => True
    end).
Hypothesis good : Forall2 is_good fs m.
Hypothesis whole_found : forall e, In e (entries (pose_rows fs)) -> formula_at tape (found e) = e.
Hypothesis divided_found : forall e, In e (entries (pose_divided fs)) -> formula_at tape (found e) = e.

Lemma mu_pos : 0 < mu.
Proof. apply Rinv_0_lt_compat, two_to_pos. Qed.

Lemma rows_energy : positive_D (map_rows value (pose_rows fs)) -> Forall seen_reach m /\ forall v, energy (map_rows value (pose_rows fs)) v = mu ^ 2 * Configuration.speed2 (jacobian conf) v.
Proof.
  unfold conf. cbn [jacobian]. induction good as [| f l fs' m' [_ [_ [s1 [_ [_ s4]]]]] hs IH]; intro p; [split; [constructor | intro; cbn; ring] |].
  cbn [pose_rows map] in p |- *. rewrite map_rows_cons in p |- *. inversion p as [| ? ? p1 p2]; subst. cbn [snd] in p1.
  destruct IH as [I1 I2]; try assumption.
  { intros e i. apply whole_found. apply in_flat_map in i as [r [i1 i2]]. apply in_flat_map. exists r. split; [right; exact i1 | exact i2]. }
  { intros e i. apply divided_found. apply in_flat_map in i as [r [i1 i2]]. apply in_flat_map. exists r. split; [right; exact i1 | exact i2]. }
  specialize (s1 p1). destruct (s4 s1) as [[q [q2 qA]] _]. fold mu in qA.
  split; [constructor; [exact s1 | exact I1] |]. intro v. fold (pose_rows fs'). cbn [energy]. unfold Configuration.speed2 in *. cbn [map fold_right]. rewrite I2, qA, dot_map, <- q2. cbn [snd] in p1. rewrite <- q2 in p1.
  assert (q <> 0) by (intro z; rewrite z in p1; lra). field. exact H.
Qed.

Lemma divided_energy : Forall (fun p => Forall (Formula.defined x theta) (fst p) /\ Formula.defined x theta (snd p)) (pose_divided fs) ->
  Forall seen_reach m /\ forall v, energy (map_rows value (pose_divided fs)) v = mu ^ 2 * Configuration.speed2 (jacobian conf) v.
Proof.
  unfold conf. cbn [jacobian]. induction good as [| f l fs' m' [_ [_ [_ [_ [s3 s4]]]]] hs IH]; intro p; [split; [constructor | intro; cbn; ring] |].
  cbn [pose_divided map] in p |- *. rewrite map_rows_cons. inversion p as [| ? ? [p1 _] p2]; subst. cbn [fst] in p1.
  destruct IH as [I1 I2]; try assumption.
  { intros e i. apply whole_found. apply in_flat_map in i as [r [i1 i2]]. apply in_flat_map. exists r. split; [right; exact i1 | exact i2]. }
  { intros e i. apply divided_found. apply in_flat_map in i as [r [i1 i2]]. apply in_flat_map. exists r. split; [right; exact i1 | exact i2]. }
  specialize (s3 p1). destruct (s4 s3) as [_ [qD _]]. fold mu in qD.
  split; [constructor; [exact s3 | exact I1] |]. intro v. fold (pose_divided fs'). cbn [energy]. unfold Configuration.speed2 in *. cbn [map fold_right]. rewrite I2, qD, dot_map.
  change (value (integer 1)) with 1. field.
Qed.

Lemma of_rows_energy : forall bound, of_rows tape (map_rows found (pose_rows fs)) (map_rows found (pose_divided fs)) theta x bound ->
  Forall seen_reach m /\ exists r, bound r /\ forall v, energy r v = mu ^ 2 * Configuration.speed2 (jacobian conf) v.
Proof.
  intros bound [r [which [[def pos] h]]]. rewrite (rows_found tape _ whole_found), (rows_found tape _ divided_found) in which.
  destruct which as [-> | ->]; [destruct (rows_energy pos) as [h1 h2] | destruct (divided_energy def) as [h1 h2]]; (split; [exact h1 |]; eexists; split; [exact h | exact h2]).
Qed.

Lemma low_sees : forall low c, contains bits low c -> 0 <= c -> holds (SigmaMin low) -> Configuration.injective n conf.
Proof.
  intros low c hc c0 [_ h] v lv nz. destruct (of_rows_energy _ h) as [_ [r [b e]]]. specialize (b c v hc lv nz). rewrite e in b. unfold nonzero in nz.
  pose proof (Rmult_le_pos _ _ c0 (Rlt_le _ _ nz)). pose proof (pow_lt _ 2 mu_pos). apply Rnot_le_lt. intro z. nra.
Qed.

Lemma good_at : forall i f, nth_error fs i = Some f -> exists l, nth_error m i = Some l /\ is_good f l.
Proof.
  intros i f. revert i. induction good as [| g l fs' m' h hs IH]; intros [| i] e; try discriminate; cbn [nth_error] in *.
  - injection e as <-. exists l. split; [reflexivity | exact h].
  - apply IH; try assumption.
    + intros e' i'. apply whole_found. apply in_flat_map in i' as [r [i1 i2]]. apply in_flat_map. exists r. split; [right; exact i1 | exact i2].
    + intros e' i'. apply divided_found. apply in_flat_map in i' as [r [i1 i2]]. apply in_flat_map. exists r. split; [right; exact i1 | exact i2].
Qed.

Hypothesis reach : Forall seen_reach m.
Lemma leg_at_pose : forall i f, nth_error fs i = Some f -> exists l, nth_error m i = Some l /\ 0 < value (d_D f) /\
  (exists q, q ^ 2 = value (d_D f) /\ map value (d_A f) = map (Rmult (q * mu)) (seen_row l)) /\ joint_is x theta s (d_joint f) (seen_joint l) /\
  match seen_joint l with Angle c a => mu = two_to s /\ c ^ 2 + a ^ 2 = 1 | _ => mu = 1 end /\
  match d_rod f with
  | Some (e2, len) => exists q, seen_rod l = Some q /\ value e2 = (/ two_to s * rod_eta q) ^ 2 /\ value len = / two_to s * rod_size q /\
      map value (d_vector f) = map (Rmult (/ two_to s)) (rod_vector q)
  | None => True
  end.
Proof.
  intros i f e. destruct (good_at i f e) as [l [nl [_ [K [_ [s2 [_ s4]]]]]]]. exists l. split; [exact nl |].
  assert (rl : seen_reach l) by (rewrite Forall_forall in reach; exact (reach l (nth_error_In _ _ nl))).
  destruct (s4 rl) as [A [_ [J R0]]]. split; [exact (s2 rl) |]. split; [exact A |]. split; [exact J |]. split; [| exact R0].
  fold mu in K. destruct (seen_joint l); [exact K | split; [exact (proj1 K) | exact (proj2 K rl)] | exact K].
Qed.

Lemma zero_speed : forall v, ~ nonzero v -> Linear.dot v v = 0 /\ Configuration.speed2 (jacobian conf) v = 0.
Proof.
  intros v z. pose proof (zero_vector v ltac:(apply Rnot_lt_le; exact z)) as F0. split; [apply dot_zero, F0 |].
  unfold Configuration.speed2. induction (jacobian conf) as [| row M IH]; cbn [fold_right]; [reflexivity |]. rewrite IH, (dot_zero v row F0). ring.
Qed.
Lemma is_zero_or_not : forall v, nonzero v \/ ~ nonzero v.
Proof. intro v. destruct (Rlt_dec 0 (Linear.dot v v)); auto. Qed.

Lemma squared_rate : forall y a, enclose_parameter bits (exactly y, rate are_angles s) = Some a -> contains bits (sqr bits a) ((Claim.value y * mu) ^ 2).
Proof. intros y a e. apply sqr_sound, (enclose_parameter_sound bits _ _ _ e), exact_within. Qed.

Lemma mu_square : forall y, (y * mu) ^ 2 = mu ^ 2 * y ^ 2.
Proof. intro y. ring. Qed.

Lemma twice_rate : forall r, two_to (r + r) = two_to r ^ 2.
Proof.
  intro r. unfold two_to. destruct (0 <=? r)%Z eqn:e.
  - apply Z.leb_le in e. replace (0 <=? r + r)%Z with true by (symmetry; apply Z.leb_le; lia). rewrite Z.pow_add_r, mult_IZR by lia. ring.
  - apply Z.leb_gt in e. replace (0 <=? r + r)%Z with false by (symmetry; apply Z.leb_gt; lia).
    replace (- (r + r))%Z with (- r + - r)%Z by lia. rewrite Z.pow_add_r, mult_IZR by lia.
    assert (p : 0 < IZR (2 ^ (- r))) by (apply IZR_lt, Z.pow_pos_nonneg; lia). field. lra.
Qed.

Variables (q : list formula) (d : demand).
Hypothesis numbers : map value q = map input_value (inputs_of are_angles s d).
Hypothesis own_found : forall f, In f (own_of fs q d) -> formula_at tape (found f) = f.
Hypothesis shown : forall o, In o (tests_for bits found fs are_angles s q d) -> exists t, o = Some t /\ holds t.

Lemma number_at : forall j, value (nth j q (integer 0)) = nth j (map input_value (inputs_of are_angles s d)) 0.
Proof. intro j. rewrite <- numbers. symmetry. exact (map_nth value q (integer 0) j). Qed.

(** The demands that signs decide. *)
Definition by_signs : Prop :=
  match d with LengthMin _ _ | LengthMax _ _ | AngleWithin _ _ _ | SpeedMax _ _ _ | TurnMax _ _ _ | SerialMin _ _ | LegAngleMax _ _ | ParallelMin _ | LoadMax _ _ _ => True | _ => False end.
Lemma signs_hold : by_signs -> signs_of fs q d <> [] /\ (match d with
    | AngleWithin _ a b => certainly bits true (Minus b a) && certainly bits true (Minus (Plus a (180 // 1)) b) = true
    | SpeedMax _ tool b | TurnMax _ tool b => certainly bits true tool && certainly bits false b = true
    | LoadMax _ force b => certainly bits true b && is_square (length force) (map d_A fs) = true
    | _ => True end) /\
  forall l, In l (signs_of fs q d) -> Exists (fun f => 0 <= value f) l.
Proof.
  intro by_. unfold by_signs in by_. assert (K : exists ok, (ok = true -> match d with
      | AngleWithin _ a b => certainly bits true (Minus b a) && certainly bits true (Minus (Plus a (180 // 1)) b) = true
      | SpeedMax _ tool b | TurnMax _ tool b => certainly bits true tool && certainly bits false b = true
      | LoadMax _ force b => certainly bits true b && is_square (length force) (map d_A fs) = true
      | _ => True end) /\ tests_for bits found fs are_angles s q d = match (if ok : bool then signs_of fs q d else []) with
      | [] => [None]
      | l => map (fun fs => match fs with [f] => Some (AtLeast (found f)) | [f; g] => Some (Either (found f) (found g)) | _ => None end) l
      end).
  { exists (match d with
      | AngleWithin _ a b => certainly bits true (Minus b a) && certainly bits true (Minus (Plus a (180 // 1)) b)
      | SpeedMax _ tool b | TurnMax _ tool b => certainly bits true tool && certainly bits false b
      | LoadMax _ force b => certainly bits true b && is_square (length force) (map d_A fs)
      | _ => true
      end). destruct d; try contradiction; (split; [| reflexivity]); intro h; try exact I; exact h. }
  destruct K as [ok [K1 K2]]. rewrite K2 in shown. destruct ok; [| destruct (shown None ltac:(left; reflexivity)) as [t [e _]]; discriminate].
  assert (ne : signs_of fs q d <> []) by (intro z; rewrite z in shown; destruct (shown None ltac:(left; reflexivity)) as [t [e _]]; discriminate).
  split; [exact ne |]. split; [exact (K1 eq_refl) |]. intros l i.
  assert (O : own_of fs q d = concat (signs_of fs q d)) by (destruct d; try contradiction; reflexivity).
  assert (F : forall f, In f l -> formula_at tape (found f) = f) by (intros f j; apply own_found; rewrite O; apply in_concat; exists l; split; assumption).
  destruct (shown (match l with [f] => Some (AtLeast (found f)) | [f; g] => Some (Either (found f) (found g)) | _ => None end)) as [t [e h]].
  { destruct (signs_of fs q d) as [| l0 ls]; [contradiction |]. apply (in_map (fun fs => match fs with [f] => Some (AtLeast (found f)) | [f; g] => Some (Either (found f) (found g)) | _ => None end) _ _ i). }
  destruct l as [| f [| g [| ? ?]]]; try discriminate; injection e as <-; cbn [Check.holds] in h; unfold is_nonneg in h.
  - rewrite F in h by (left; reflexivity). left. exact (proj2 h).
  - rewrite !F in h by (cbn [In]; auto). destruct h as [h | h]; [left | right; left]; exact (proj2 h).
Qed.

Lemma one_sign : by_signs -> forall f, signs_of fs q d = [[f]] -> 0 <= value f.
Proof. intros b f e. destruct (signs_hold b) as [_ [_ H]]. rewrite e in H. specialize (H _ (or_introl eq_refl)). inversion H; [assumption |]. inversion H1. Qed.

Lemma row_at : forall i l, nth_error m i = Some l -> nth_error (jacobian conf) i = Some (seen_row l).
Proof. intros i l e. unfold conf. cbn [jacobian]. rewrite nth_error_map, e. reflexivity. Qed.
Lemma joint_at : forall i l, nth_error m i = Some l -> nth_error (joints conf) i = Some (seen_joint l).
Proof. intros i l e. unfold conf. cbn [joints]. rewrite nth_error_map, e. reflexivity. Qed.
Lemma rod_at_pose : forall i l, nth_error m i = Some l -> nth_error (rods conf) i = Some (seen_rod l).
Proof. intros i l e. unfold conf. cbn [rods]. rewrite nth_error_map, e. reflexivity. Qed.

Lemma u_positive : 0 < / two_to s.
Proof. apply Rinv_0_lt_compat, two_to_pos. Qed.

(** Of a leg's row not longer than c mu, the joint is not faster than c tool. *)
Lemma slow_row : forall f l c tool, 0 < value (d_D f) -> (exists r, r ^ 2 = value (d_D f) /\ map value (d_A f) = map (Rmult (r * mu)) (seen_row l)) ->
  0 <= (c * mu) ^ 2 * value (d_D f) - Linear.dot (map value (d_A f)) (map value (d_A f)) -> 0 <= c -> 0 < tool ->
  forall v, Linear.dot v v <= tool ^ 2 -> Rabs (Linear.dot (seen_row l) v) <= c * tool.
Proof.
  pose proof mu_pos as m0. intros f l c tool D0 [r [r2 A]] h c0 t0 v hv. rewrite A, dot_scaled_self, <- r2 in h. rewrite <- r2 in D0.
  set (row := seen_row l) in *. assert (rr : Linear.dot row row <= c ^ 2).
  { apply Rmult_le_reg_l with ((r * mu) ^ 2); [rewrite Rpow_mult_distr; apply Rmult_lt_0_compat; [exact D0 | apply pow_lt, m0] |]. rewrite Rpow_mult_distr in *. lra. }
  pose proof (dot_cauchy row v) as C. pose proof (Linear.dot_self row). pose proof (Linear.dot_self v).
  assert (Linear.dot row v ^ 2 <= (c * tool) ^ 2) by (apply Rle_trans with (1 := C); rewrite Rpow_mult_distr; apply Rmult_le_compat; assumption).
  assert (0 <= c * tool) by (apply Rmult_le_pos; lra). apply Rabs_le. split; nra.
Qed.

(** Of each joint, the formulas' row of A is so many times that of M. *)
Lemma all_multiples : exists cs, length cs = length (jacobian conf) /\ Forall (fun c => c <> 0) cs /\
  map (map value) (map d_A fs) = Load.multiples (map (fun c => c * mu) cs) (jacobian conf) /\ forall i f, nth_error fs i = Some f -> value (d_D f) = nth i cs 0 ^ 2.
Proof.
  clear - good reach. unfold conf. cbn [jacobian]. revert reach. induction good as [| g l fs' m' [_ [_ [_ [s2 [_ s4]]]]] hs IH]; intro reach.
  - exists []. split; [reflexivity |]. split; [constructor |]. split; [reflexivity |]. intros [|] f e; discriminate e.
  - inversion reach as [| ? ? r1 r2]; subst. destruct (IH hs r2) as [cs [I1 [I2 [I3 I4]]]]. destruct (s4 r1) as [[c [c2 A]] _]. specialize (s2 r1). fold mu in A.
    exists (c :: cs). split; [cbn; congruence |]. split; [constructor; [intros ->; rewrite <- c2 in s2; lra | exact I2] |]. split.
    + unfold Load.multiples in *. cbn [map combine fst snd]. rewrite <- I3. f_equal. exact A.
    + intros [| i] f e; cbn [nth_error nth] in *; [injection e as <-; symmetry; exact c2 | exact (I4 i f e)].
Qed.

Hypothesis sees : Configuration.injective n conf.
Lemma load_met : forall i force b, d = LoadMax i force b -> Configuration.fulfils n conf d.
Proof.
  intros i force b ed. pose proof mu_pos as m0. pose proof numbers as Q. rewrite ed in Q. cbn [inputs_of] in Q. rewrite map_map in Q. cbn [input_value Claim.value] in Q.
  destruct (signs_hold ltac:(unfold by_signs; rewrite ed; exact I)) as [ne [ok H]]. rewrite ed in ne, ok, H |- *. cbn [signs_of] in ne, H. destruct (nth_error fs i) as [f |] eqn:ef; [| contradiction].
  apply andb_true_iff in ok as [b0 sq]. apply positive_sound in b0. rewrite <- (square_map _ _ value) in sq.
  destruct all_multiples as [cs [lc [nz [A D]]]]. specialize (D i f ef). cbn [Configuration.fulfils]. intros tau hF. assert (hF' := hF). destruct hF' as [lt' [lF _]]. rewrite map_length in lF.
  pose proof (H _ (or_introl eq_refl)) as h1. pose proof (H _ (or_intror (or_introl eq_refl))) as h2.
  assert (Two : forall (T : formula -> Prop) f1 f2, Exists T [f1; f2] -> T f1 \/ T f2) by (intros T f1 f2 e; inversion e as [| ? ? e']; subst; [left; assumption | right; inversion e' as [| ? ? e'']; subst; [assumption | inversion e'']]).
  apply Two in h1, h2. clear Two.
  rewrite value_opposite, value_minus, value_plus in h1, h2. rewrite value_opposite in h2. rewrite value_times, value_root, !value_edeterminant, map_replaced, D, A in h1, h2.
  assert (Eq : map value q = map (Rmult (mu / Claim.value b)) (map Claim.value force)).
  { rewrite Q, map_map. apply map_ext. intro y. unfold mu. pose proof (two_to_pos (rate are_angles s)). field. split; lra. }
  rewrite Eq in h1, h2.
  rewrite lF in sq. assert (li : (i < n)%nat) by (rewrite <- (Load.square_length _ _ _ sq), !map_length; apply nth_error_Some; congruence).
  rewrite A, Load.multiples_square in sq by (rewrite map_length; exact lc).
  exact (Load.load_bounded n cs (jacobian conf) mu tau (map Claim.value force) (Claim.value b) i sq lc nz m0 b0 sees li hF h1 h2).
Qed.

Theorem demand_met : Configuration.fulfils n conf d.
Proof.
  pose proof mu_pos as m0. pose proof u_positive as u0. assert (m2 : 0 < mu ^ 2) by (apply pow_lt, m0).
  assert (Low : forall low, holds (SigmaMin low) -> forall c v, contains bits low c -> length v = n -> nonzero v -> c * Linear.dot v v < mu ^ 2 * Configuration.speed2 (jacobian conf) v).
  { intros low [_ h] c v hc lv nz. destruct (of_rows_energy _ h) as [_ [r [b e]]]. rewrite <- e. exact (b c v hc lv nz). }
  assert (Num := number_at). assert (Signs := signs_hold). assert (One := one_sign). assert (Loaded := load_met). unfold by_signs in Signs, One.
  destruct d as [| b | b | i b | i b | i a b | b | i tool b | i tool b | a b | i tool b | i b | i b | b | i on j b | one other b | i acc spe b | err b ang | i force b]; cbn [Configuration.fulfils].
  19: exact (Loaded i force b eq_refl).
  15-18: exfalso; destruct (shown None ltac:(left; reflexivity)) as [t [e _]]; discriminate.
  - intros v lv nz. destruct (shown (Some (SigmaMin zero)) ltac:(left; reflexivity)) as [t [e h]]. injection e as <-.
    pose proof (Low zero h 0 v (zero_sound bits) lv nz) as q0. rewrite Rmult_0_l in q0. apply Rmult_lt_reg_l with (mu ^ 2); lra.
  - intros v lv. destruct (is_zero_or_not v) as [nz | z]; [| destruct (zero_speed v z) as [-> ->]; lra].
    destruct (shown _ ltac:(left; reflexivity)) as [t [e h]]. destruct (enclose_parameter bits _) as [w |] eqn:ew; [| discriminate]. injection e as <-.
    pose proof (Low _ h _ v (squared_rate _ _ ew) lv nz) as q0. cbn [Claim.value] in q0. replace (1 / 1) with 1 in q0 by field.
    rewrite mu_square, Rmult_assoc in q0. apply Rlt_le, Rmult_lt_reg_l with (mu ^ 2); assumption.
  - intros v lv. destruct (is_zero_or_not v) as [nz | z]; [| destruct (zero_speed v z) as [-> ->]; lra].
    destruct (shown _ ltac:(left; reflexivity)) as [t [e h]]. destruct (enclose_parameter bits _) as [w |] eqn:ew; [| discriminate]. injection e as <-.
    cbn [Check.holds] in h. destruct (of_rows_energy _ h) as [_ [r [q0 e0]]]. specialize (q0 _ v (squared_rate _ _ ew) lv nz). rewrite e0 in q0. cbn [Claim.value] in q0. replace (1 / 1) with 1 in q0 by field.
    rewrite mu_square, Rmult_assoc in q0. apply Rlt_le, Rmult_lt_reg_l with (mu ^ 2); assumption.
  - destruct (Signs I) as [ne _]. cbn [signs_of] in ne, One. destruct (nth_error fs i) as [f |] eqn:ef; [| contradiction].
    destruct (leg_at_pose i f ef) as [l [nl [_ [_ [J _]]]]]. destruct (d_joint f) as [r | ? ? |]; try contradiction.
    pose proof (One I _ eq_refl) as h. rewrite value_minus, Num in h. cbn [inputs_of map nth input_value] in h. rewrite (joint_at i l nl).
    destruct (seen_joint l) as [rho | ? ? |]; try contradiction. cbn [joint_is] in J. rewrite J in h. exists rho. split; [reflexivity |]. unfold Rdiv in h.
    apply Rmult_le_reg_l with (/ two_to s); [exact u0 | lra].
  - destruct (Signs I) as [ne _]. cbn [signs_of] in ne, One. destruct (nth_error fs i) as [f |] eqn:ef; [| contradiction].
    destruct (leg_at_pose i f ef) as [l [nl [_ [_ [J _]]]]]. destruct (d_joint f) as [r | ? ? |]; try contradiction.
    pose proof (One I _ eq_refl) as h. rewrite value_minus, Num in h. cbn [inputs_of map nth input_value] in h. rewrite (joint_at i l nl).
    destruct (seen_joint l) as [rho | ? ? |]; try contradiction. cbn [joint_is] in J. rewrite J in h. exists rho. split; [reflexivity |]. unfold Rdiv in h.
    apply Rmult_le_reg_l with (/ two_to s); [exact u0 | lra].
  - destruct (Signs I) as [ne [ok H]]. cbn [signs_of] in ne, H. destruct (nth_error fs i) as [f |] eqn:ef; [| contradiction].
    destruct (leg_at_pose i f ef) as [l [nl [_ [_ [J [K _]]]]]]. destruct (d_joint f) as [? | ec es |]; try contradiction.
    pose proof (H _ (or_introl eq_refl)) as h1. pose proof (H _ (or_intror (or_introl eq_refl))) as h2. apply Exists_cons in h1 as [h1 | h1]; [| inversion h1]. apply Exists_cons in h2 as [h2 | h2]; [| inversion h2].
    rewrite value_minus, !value_times, !Num in h1, h2. cbn [inputs_of map nth input_value] in h1, h2.
    apply andb_true_iff in ok as [o1 o2]. apply positive_sound in o1, o2. cbn [Claim.value] in o1, o2.
    rewrite (joint_at i l nl). destruct (seen_joint l) as [rho | c0 s0 |]; cbn [joint_is] in J; try contradiction. destruct J as [J1 J2]. rewrite J1, J2 in h1, h2. destruct K as [_ one].
    assert (ab : 0 < Claim.value b - Claim.value a < 180) by (split; [exact o1 | lra]).
    destruct (angle_between _ _ _ _ one ab h1 h2) as [angle [r0 [-> ->]]]. exists angle. split; [exact r0 | reflexivity].
  - intros v w lv lw. destruct (is_zero_or_not v) as [nv | z]; [| destruct (zero_speed v z) as [-> ->]; lra]. destruct (is_zero_or_not w) as [nw | z]; [| destruct (zero_speed w z) as [-> ->]; lra].
    destruct (shown _ ltac:(left; reflexivity)) as [t [e h]]. destruct (enclose_parameter bits _) as [y |] eqn:ey; [| discriminate]. injection e as <-.
    cbn [Check.holds] in h. destruct (of_rows_energy _ h) as [_ [r [q0 e0]]].
    assert (K : contains bits (sqr bits y) (Claim.value b ^ 2)).
    { apply sqr_sound, (enclose_parameter_sound bits _ _ _ ey). exists (Claim.value b). split; [split; apply Rle_refl |]. cbn [snd]. change (two_to 0) with 1. field. }
    specialize (q0 _ v w K lv lw nv nw). rewrite !e0 in q0. apply Rlt_le, Rmult_lt_reg_l with (mu ^ 2); [exact m2 |]. lra.
  - destruct (Signs I) as [ne [ok _]]. cbn [signs_of] in ne, One. destruct (nth_error fs i) as [f |] eqn:ef; [| contradiction].
    destruct (leg_at_pose i f ef) as [l [nl [D0 [A [J [K _]]]]]]. assert (M1 : mu = 1) by (destruct (d_joint f), (seen_joint l); cbn [joint_is] in J; try contradiction; exact K).
    assert (One' : forall f' : formula, match d_joint f with EAngle _ _ => @nil (list formula) | _ => [[f']] end = [[f']]) by (intro; destruct (d_joint f); try reflexivity; contradiction).
    pose proof (One I _ (One' _)) as h. rewrite value_less_squares, value_times, Formula.value_square, Num in h. cbn [inputs_of map nth input_value] in h.
    apply andb_true_iff in ok as [t0 b0]. apply positive_sound in t0. apply nonneg_sound in b0.
    exists (seen_row l). split; [exact (row_at i l nl) |]. intros v lv hv.
    assert (c0 : 0 <= Claim.value b / Claim.value tool) by (apply Rmult_le_pos; [exact b0 | apply Rlt_le, Rinv_0_lt_compat, t0]).
    replace (Claim.value b) with (Claim.value b / Claim.value tool * Claim.value tool) by (field; lra).
    refine (slow_row f l _ _ D0 A _ c0 t0 v hv). rewrite M1, Rmult_1_r. cbn [Claim.value] in h. change (two_to 0) with 1 in h.
    replace (Claim.value b / Claim.value tool / 1) with (Claim.value b / Claim.value tool) in h by (field; lra). exact h.
  - assert (K : exists f, nth_error fs i = Some f /\ certainly bits true tool && certainly bits true b = true /\
      exists w, enclose_parameter bits (exactly (Over tool b), rate are_angles s) = Some w /\ holds (Solved i (sqr bits w))).
    { cbn [tests_for] in shown. destruct (nth_error fs i) as [f |]; [| destruct (shown None ltac:(left; reflexivity)) as [t [e _]]; discriminate].
      destruct (certainly bits true tool && certainly bits true b); [| destruct (shown None ltac:(left; reflexivity)) as [t [e _]]; discriminate].
      destruct (shown _ ltac:(left; reflexivity)) as [t [e h]]. destruct (enclose_parameter bits _) as [w |]; [| discriminate]. injection e as <-.
      exists f. split; [reflexivity |]. split; [reflexivity |]. exists w. split; [reflexivity | exact h]. }
    destruct K as [f [ef [ok [w [ew h]]]]]. apply andb_true_iff in ok as [t0 b0]. apply positive_sound in t0, b0. cbn [Check.holds] in h.
    destruct h as [[_ pos] [lr H]]. rewrite (rows_found tape _ whole_found) in pos, lr, H.
    assert (Each : exists rs, Forall2 (fun p c => c <> 0 /\ snd p = c ^ 2) (map_rows value (pose_rows fs)) rs /\
      map fst (map_rows value (pose_rows fs)) = map (fun cr => map (Rmult (fst cr * mu)) (snd cr)) (combine rs (jacobian conf)) /\ length rs = length (jacobian conf)).
    { clear - good reach pos. unfold conf in *. cbn [jacobian] in *. revert reach pos. induction good as [| g l fs' m' [_ [_ [_ [_ [_ s4]]]]] hs IH]; intros reach pos; [exists []; repeat split; constructor |].
      inversion reach as [| ? ? r1 r2]; subst. cbn [pose_rows map] in pos |- *. rewrite map_rows_cons in pos |- *. inversion pos as [| ? ? p1 p2]; subst. cbn [snd] in p1.
      destruct (IH hs r2 p2) as [rs [I1 [I2 I3]]]. destruct (s4 r1) as [[c [c2 A]] _]. fold mu in A.
      exists (c :: rs). split; [constructor; [split; [intro z; rewrite z in c2; rewrite <- c2 in p1; lra | cbn [snd]; symmetry; exact c2] | exact I1] |].
      split; [cbn [map combine fst snd]; f_equal; [exact A | exact I2] | cbn [length]; f_equal; exact I3]. }
    destruct Each as [rs [R1 [R2 R3]]]. intros tau F [lt' [lF hF]] le.
    set (rows := map_rows value (pose_rows fs)) in *. set (As := map fst rows) in *.
    assert (U : exists u, length u = length rows /\ (forall v, Linear.dot u (map (fun row => Linear.dot row v) As) = Linear.dot tau (map (fun row => Linear.dot row v) (jacobian conf))) /\
      forall i, mu ^ 2 * (nth i (map snd rows) 0 * nth i u 0 ^ 2) = nth i tau 0 ^ 2).
    { clear - R1 R2 R3 lt' m0. unfold As in R2 |- *. clear As. revert R2 tau lt' R3. generalize (jacobian conf). induction R1 as [| p c rows rs [c0 c2] hs IH]; intros M R2 tau lt' R3.
      - destruct M; [| discriminate]. destruct tau; [| discriminate]. exists []. split; [reflexivity |]. split; [intro v; reflexivity |]. intros [| j]; cbn; ring.
      - destruct M as [| row M]; [discriminate |]. destruct tau as [| t tau]; [discriminate |]. cbn [combine map fst snd] in R2. injection R2 as Ra R2.
        destruct (IH M R2 tau ltac:(cbn in lt'; congruence) ltac:(cbn in R3; congruence)) as [u [lu [hu hi]]].
        exists (t / (c * mu) :: u). split; [cbn; congruence |]. split.
        + intro v. cbn [map Linear.dot]. rewrite hu, Ra, dot_map. field. split; [lra | exact c0].
        + intros [| j]; cbn [map nth]; [rewrite c2; field; split; [lra | exact c0] | apply hi]. }
    destruct U as [u [lu [hu hi]]]. set (p := Solve.weighted_sum u As) in *. specialize (hi i). set (du := nth i (map snd rows) 0 * nth i u 0 ^ 2) in *.
    set (T := Claim.value tool) in *. set (y := Claim.value b) in *.
    enough (Q2 : nth i tau 0 ^ 2 <= y ^ 2) by (apply Rabs_le; split; nra).
    destruct (is_zero_or_not u) as [nz | z].
    + assert (LA : Forall (fun row => length row = n) As).
      { unfold As, rows, pose_rows, map_rows. rewrite !map_map. apply Forall_map, Forall_forall. intros g ig. cbn [fst]. rewrite map_length.
        destruct (In_nth_error _ _ ig) as [j ej]. destruct (leg_at_pose j g ej) as [l [nl [_ [[c [_ A]] _]]]]. apply (f_equal (@length R)) in A. rewrite !map_length in A. rewrite A.
        destruct (good_at j g ej) as [l' [nl' [len _]]]. rewrite nl in nl'. injection nl' as <-. exact len. }
      assert (lp : length p = n).
      { apply weighted_length; [exact LA | unfold As; rewrite map_length; exact lu |]. intros ->. unfold nonzero in nz. cbn in nz. lra. }
      assert (pv : forall v, Linear.dot p v = Linear.dot tau (map (fun row => Linear.dot row v) (jacobian conf))) by (intro v; unfold p; rewrite Solve.dot_weighted; apply hu).
      assert (pp : Linear.dot p p = Linear.dot F F).
      { rewrite (pv p), <- (hF p lp), Solve.dot_commutes, (pv F). symmetry. apply hF, lF. }
      specialize (H _ u (squared_rate _ _ ew) (pow2_ge_0 _) lu nz). cbv zeta in H. fold As in H. fold p in H. fold du in H. rewrite pp in H. cbn [Claim.value] in H. fold T y in H.
      assert (E : (T / y * mu) ^ 2 * du = T ^ 2 * (nth i tau 0 / y) ^ 2).
      { replace ((T / y * mu) ^ 2 * du) with ((T / y) ^ 2 * (mu ^ 2 * du)) by ring. rewrite hi. field. lra. }
      rewrite E in H. assert (t2 : 0 < T ^ 2) by (apply pow_lt; exact t0). assert ((nth i tau 0 / y) ^ 2 < 1) by (apply Rmult_lt_reg_l with (T ^ 2); lra).
      replace (nth i tau 0 ^ 2) with ((nth i tau 0 / y) ^ 2 * y ^ 2) by (field; lra). pose proof (pow2_ge_0 y). nra.
    + pose proof (zero_vector u ltac:(apply Rnot_lt_le; exact z)) as Z0. assert (un : nth i u 0 = 0).
      { destruct (nth_in_or_default i u 0) as [i' | e']; [| exact e']. rewrite Forall_forall in Z0. symmetry. exact (Z0 _ i'). }
      rewrite <- hi. unfold du. rewrite un. pose proof (pow2_ge_0 y). nra.
  - intros v lv. destruct (shown _ ltac:(left; reflexivity)) as [t [e h]]. destruct (certainly bits true b && forallb _ _) eqn:ce; [| discriminate]. injection e as <-.
    apply andb_true_iff in ce as [b0 ks0]. apply positive_sound in b0. rewrite forallb_forall in ks0. cbn [Check.holds] in h. destruct h as [_ H].
    assert (KS : Forall (fun y => 0 < y) (map Claim.value a)) by (apply Forall_forall; intros y iy; apply in_map_iff in iy as [y' [<- iy]]; eapply positive_sound, ks0, iy).
    destruct (is_zero_or_not v) as [nz | z]; [| destruct (zero_speed v z) as [-> _]; rewrite Rmult_0_r; apply elastic_nonneg, KS].
    rewrite (rows_found tape _ own_found) in H. specialize (H 1 v (Fixed.integer_sound bits 1) lv nz). rewrite Rmult_1_l in H.
    assert (ROWS : Forall2 (fun p row => 0 < value (snd p) /\ Linear.dot (map value (fst p)) v ^ 2 / value (snd p) = mu ^ 2 * Linear.dot row v ^ 2) (pose_rows fs) (map seen_row m)).
    { clear - good reach. induction good as [| f l fs' m' [_ [_ [_ [s2 [_ s4]]]]] hs IH]; [constructor |]. cbn [pose_rows map]. inversion reach as [| ? ? r1 r2]; subst. constructor; [| exact (IH hs r2)].
      cbn [fst snd]. specialize (s2 r1). split; [exact s2 |]. destruct (s4 r1) as [[q [q2 qA]] _]. fold mu in qA. rewrite qA, dot_map, <- q2. rewrite <- q2 in s2. assert (q <> 0) by (intros ->; lra). field. exact H. }
    pose proof (stiffened_energy x theta (mu ^ 2) (mu ^ 2) (Claim.value b) v b0 m2 (pose_rows fs) _ ROWS (map Claim.value a) q KS) as E.
    specialize (E ltac:(rewrite numbers; cbn [inputs_of]; rewrite !map_map; apply map_ext; intro y; cbn [input_value Claim.value]; rewrite twice_rate; unfold mu, Rdiv; rewrite pow_inv; ring)).
    unfold conf. cbn [jacobian]. apply Rmult_le_reg_l with (mu ^ 2); [exact m2 |]. rewrite <- E. replace (mu ^ 2 * (Claim.value b * Linear.dot v v)) with (Linear.dot v v * (Claim.value b * mu ^ 2)) by ring.
    apply Rmult_le_compat_r; [apply Rlt_le, Rmult_lt_0_compat; assumption | lra].
  - destruct (Signs I) as [ne [ok _]]. cbn [signs_of] in ne, One. destruct (nth_error fs i) as [f |] eqn:ef; [| contradiction].
    destruct (leg_at_pose i f ef) as [l [nl [D0 [A [J [K _]]]]]]. destruct (d_joint f) as [? | ? ? |]; try contradiction.
    destruct (seen_joint l) as [? | ? ? |]; cbn [joint_is] in J; try contradiction. destruct K as [M0 _].
    pose proof (One I _ eq_refl) as h. rewrite value_less_squares, value_times, Formula.value_square, Num in h. cbn [inputs_of map nth input_value] in h.
    apply andb_true_iff in ok as [t0 b0]. apply positive_sound in t0. apply nonneg_sound in b0.
    exists (seen_row l). split; [exact (row_at i l nl) |]. intros v lv hv. cbn [Claim.value] in h.
    assert (M1 : mu = / two_to (- s)) by (rewrite M0; symmetry; apply two_to_opposite).
    assert (c0 : 0 <= in_degrees (Claim.value b / Claim.value tool)).
    { unfold in_degrees. pose proof PI_RGT_0. apply Rmult_le_pos; [| lra]. apply Rmult_le_pos; [| lra]. apply Rmult_le_pos; [exact b0 | apply Rlt_le, Rinv_0_lt_compat, t0]. }
    replace (in_degrees (Claim.value b)) with (in_degrees (Claim.value b / Claim.value tool) * Claim.value tool) by (unfold in_degrees; field; lra).
    refine (slow_row f l _ _ D0 A _ c0 t0 v hv). rewrite M1.
    replace (in_degrees (Claim.value b / Claim.value tool) * / two_to (- s)) with (in_degrees (Claim.value b / Claim.value tool / two_to (- s)))
      by (pose proof (two_to_pos (- s)); unfold in_degrees; field; split; lra). exact h.
  - destruct (Signs I) as [ne _]. cbn [signs_of] in ne, One. destruct (nth_error fs i) as [f |] eqn:ef; [| contradiction].
    destruct (leg_at_pose i f ef) as [l [nl [_ [_ [_ [_ R0]]]]]]. destruct (d_rod f) as [[e2 len] |]; [| contradiction].
    pose proof (One I _ eq_refl) as h. rewrite value_minus, value_times, !Formula.value_square, Num in h. cbn [inputs_of map nth input_value] in h. change (two_to 0) with 1 in h.
    destruct R0 as [r [o [v1 [v2 _]]]]. rewrite v1, v2 in h. exists r. split; [rewrite (rod_at_pose i l nl), o; reflexivity |].
    apply Rle_trans with (Rabs (Claim.value b * rod_size r)); [apply Rle_abs |]. apply Rsqr_le_abs_0. rewrite !Rsqr_pow2.
    apply Rmult_le_reg_l with ((/ two_to s) ^ 2); [apply pow_lt, u0 |]. replace (Claim.value b / 1) with (Claim.value b) in h by field. rewrite !Rpow_mult_distr in *. lra.
  - destruct (Signs I) as [ne _]. cbn [signs_of] in ne, One. destruct (nth_error fs i) as [f |] eqn:ef; [| contradiction].
    destruct (leg_at_pose i f ef) as [l [nl [_ [_ [J [_ R0]]]]]]. destruct (d_joint f) as [? | ? ? |]; try contradiction. destruct (d_rod f) as [[e2 len] |]; [| contradiction].
    pose proof (One I _ eq_refl) as h. rewrite value_minus, value_times, !Formula.value_square, Num in h. cbn [inputs_of map nth input_value] in h.
    destruct R0 as [r [o [v1 [v2 _]]]]. rewrite v1, v2 in h. exists r. split; [rewrite (rod_at_pose i l nl), o; reflexivity |].
    apply Rle_trans with (Rabs (cos (in_degrees (Claim.value b)) * rod_size r)); [apply Rle_abs |]. apply Rsqr_le_abs_0. rewrite !Rsqr_pow2.
    apply Rmult_le_reg_l with ((/ two_to s) ^ 2); [apply pow_lt, u0 |]. rewrite !Rpow_mult_distr in *. lra.
  - destruct (Signs I) as [ne [_ H]]. cbn [signs_of] in ne, H. destruct (lengths_of_all fs) as [ls |] eqn:el; [| contradiction]. specialize (H _ (or_introl eq_refl)).
    set (least := fold_left times ls (nth 0 q (integer 0))) in *. set (det := edeterminant (map d_vector fs)) in *.
    assert (K : exists qs, rods conf = map Some qs /\ length qs = length ls /\ length qs = length fs /\ map value ls = map (fun r => / two_to s * rod_size r) qs /\
      map (map value) (map d_vector fs) = map (map (Rmult (/ two_to s))) (map rod_vector qs)).
    { clear - good reach el. unfold conf in *. cbn [rods] in *. revert ls el reach. induction good as [| g l fs' m' [_ [_ [_ [_ [_ s4]]]]] hs IH]; intros ls el reach; cbn [lengths_of_all] in el; [injection el as <-; exists []; repeat split |].
      inversion reach as [| ? ? r1 r2]; subst. destruct (d_rod g) as [[e2 len] |] eqn:eg; [| discriminate]. destruct (lengths_of_all fs') as [l' |]; [| discriminate]. injection el as <-.
      destruct (IH hs l' eq_refl r2) as [qs [I1 [I2 [I3 [I4 I5]]]]]. destruct (s4 r1) as [_ [_ [_ R0]]].
      destruct R0 as [r [o [_ [v2 v3]]]]. exists (r :: qs). cbn [map length]. rewrite o, I1, I2, I4, v2, v3, I5. repeat split. f_equal. congruence. }
    destruct K as [qs [K1 [K2 [K3 [K4 K5]]]]].
    assert (VL : value least = (/ two_to s) ^ length qs * fold_left (fun p l => p * rod_size l) qs (Claim.value b)).
    { unfold least. pose proof (Num 0%nat) as N0. cbn [inputs_of map nth input_value] in N0. change (two_to 0) with 1 in N0.
      assert (G : forall (ls : list formula) (qs : list Configuration.rod) (c : formula) y, map value ls = map (fun r => / two_to s * rod_size r) qs -> value (fold_left times ls c) = (/ two_to s) ^ length qs * fold_left (fun p l => p * rod_size l) qs y \/ value c <> y).
      { clear. intro ls0. induction ls0 as [| z ls0 IH]; intros [| r qs0] c0 y e; try discriminate; cbn [fold_left length pow]; [destruct (Req_dec (value c0) y) as [-> | ne]; [left; ring | right; exact ne] |].
        cbn [map] in e. injection e as e1 e2. destruct (Req_dec (value c0) y) as [ec | ne]; [left | right; exact ne].
        destruct (IH qs0 (times c0 z) (value (times c0 z)) e2) as [I | I]; [| contradiction I; reflexivity]. rewrite I, value_times, ec, e1.
        assert (S : forall qs a y, fold_left (fun p l => p * rod_size l) qs (a * y) = a * fold_left (fun p l => p * rod_size l) qs y) by (clear; induction qs as [| r qs IH]; intros a y; cbn [fold_left]; [reflexivity | rewrite Rmult_assoc; apply IH]).
        replace (y * (/ two_to s * rod_size r)) with (/ two_to s * (y * rod_size r)) by ring. rewrite S. ring. }
      destruct (G ls qs (nth 0 q (integer 0)) (Claim.value b) K4) as [E | E]; [exact E | exfalso; apply E; rewrite N0; field]. }
    assert (VD : value det = (/ two_to s) ^ length qs * determinant (map rod_vector qs)) by (unfold det; rewrite value_edeterminant, K5, determinant_scaled, map_length; reflexivity).
    exists qs. split; [exact K1 |]. set (w := (/ two_to s) ^ length qs) in *. assert (w0 : 0 < w) by (apply pow_lt, u0).
    set (dd := determinant _) in *. set (ll := fold_left _ qs _) in *.
    apply Exists_cons in H as [h | H]; [| apply Exists_cons in H as [h | H]; [| inversion H]].
    + rewrite value_minus, VL, VD in h. apply Rle_trans with dd; [apply Rmult_le_reg_l with w; lra | apply Rle_abs].
    + rewrite value_opposite, value_plus, VL, VD in h. apply Rle_trans with (- dd); [apply Rmult_le_reg_l with w; lra | rewrite <- Rabs_Ropp; apply Rle_abs].
Qed.
End Fulfilled.

Lemma flat_place : forall k w P, is_flat_region k w = true -> in_region w P ->
  match k with Translates => True | TranslatesInPlane => is_position InPlane P | Turns m => is_position m P end.
Proof. intros [| | m] w P h p; [exact I | |]; exact (flat_position _ _ P h (hull_sound _ _ p)). Qed.
Lemma entries_found : forall tape (fs : list formula) r, (forall e, In e (entries r) -> In e fs) -> (forall e, In e fs -> formula_at tape (place (formulas tape) e) = e) ->
  forall e, In e (entries r) -> formula_at tape (place (formulas tape) e) = e.
Proof. intros tape fs r h k e i. apply k, h, i. Qed.
Lemma flat_pose : forall k w P, is_flat_region k w = true -> in_region w P -> is_place k P.
Proof. intros [| | []] w P h p; exact (flat_place _ w P h p). Qed.

(** What is shown, but for what accuracy says beside the nominal machine's being one that can be built. *)
Lemma check_driven_at : forall bits one_matrix one_place c s ds t, check_driven bits one_matrix one_place c s ds t = true -> forall m P Q, is_about_driven c m P Q ->
  Forall well_formed_driven m /\ (Forall well_formed_driven (map nominal_driven (drives c)) -> meets_driven c m P Q /\
  (only_pose c = true -> forall P' Q', is_pose c P' Q' -> Forall (fun l => own_joint l (carried l P' Q') = own_joint l (carried l P Q)) m -> P' = P /\ Q' = Q)).
Proof.
  intros bits one_matrix one_place c s ds t h m P Q [hm hPQ]. unfold check_driven in h. cbv zeta in h.
  set (k := mobility_of c) in *. set (demands := driven_demands c) in *. set (lay := driven_layouts s ds (drives c)) in *. set (pl := (exactly (length_of c), s)) in *.
  set (angular := are_angular (drives c)) in *. set (turn := option_map (fun o => chart o (first_of k)) (turned_by c)) in *. set (ell := quantity pl (length lay)) in *.
  set (fs := all_driven k turn ell s ds (drives c) 0) in *. set (built := flat_map d_built fs) in *.
  set (about := if only_pose c then map (fun f => (d_origin f, d_D f)) fs else []) in *. set (j := S (length lay)) in *.
  set (far := fun q => map (row_off k ell (turn_unit q)) (all_drives k s (placed_off k turn) ds (drives c) 0)) in *.
  set (there := fun q => map (fun f => (row_there k ell (turn_unit q) (d_divided f), integer 1)) fs) in *. set (js := map d_joint fs) in *.
  set (zs := all_from s ds (drives c) 0) in *.
  set (own_q := fun q d => match d with
    | OnePose _ _ _ => located_own lay (far q) (there q) js
    | AccelerationMax i _ _ _ => accelerated_own k (eturned turn) ell (length lay) fs zs q i
    | _ => own_of fs q d
    end) in *.
  set (own := of_each own_q angular s j demands) in *. set (wanted := entries (pose_rows fs) ++ entries (pose_divided fs) ++ built ++ own ++ entries about) in *.
  set (tape := compile wanted) in *. set (place := place (formulas tape)) in *.
  set (tests_q := fun q d => match d with
    | OnePose error b angle => if may_be_near bits k (drives c) angle
        then located_tests bits place (freedom k) (places_of k) (lasts_of k) angular lay s (far q) (there q) js (tangent_of bits k angle) error b else [None]
    | AccelerationMax i a v b => accelerated_tests bits place k (eturned turn) ell (length lay) fs zs q i a v b
    | _ => tests_for bits place fs angular s q d
    end) in *.
  apply andb_true_iff in h as [h C]. apply andb_true_iff in h as [h one]. apply andb_true_iff in h as [h kinds]. apply andb_true_iff in h as [h oriented]. apply andb_true_iff in h as [h flat]. apply andb_true_iff in h as [found ex].
  destruct (all_some (map (enclose_parameter bits) _)) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map (enclose_input bits) _)) as [inputs |] eqn:ei; [| discriminate].
  destruct (all_some (map _ (position_edges _ _))) as [box |] eqn:eb; [| discriminate].
  destruct (match turned_by c with Some o => _ | None => _ end) as [angles |] eqn:ea; [| discriminate].
  destruct (all_some (map (enclose_tangent bits) _)) as [tangents |] eqn:eg; [| discriminate].
  destruct (all_some (of_each _ _ _ _ _)) as [tests |] eqn:et; [| discriminate].
  cbv zeta in C. set (all_tests := if only_pose c then inserted _ _ _ else tests) in C.
  assert (Sub : forall u, In u tests -> In u all_tests) by (intros u iu; unfold all_tests; destruct (only_pose c); [apply inserted_in; right |]; exact iu).
  apply andb_true_iff in C as [len C]. apply Nat.eqb_eq in len.
  assert (Found : forall e, In e wanted -> formula_at tape (place e) = e) by (rewrite forallb_forall in found; intros e i; apply same_sound, found, i).
  destruct (legs_stand s (drives c) m hm ds) as [th [TH [FR [DR ST]]]]. set (ins := flat_map (inputs_of angular s) demands) in *.
  set (tt := map (fun a => tangent (Claim.value a)) (curve_angles c)). set (theta := th ++ [Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt).
  assert (lt : length th = length lay) by (symmetry; exact (related_length _ _ _ _ _ TH)).
  assert (AOK : forall o, turned_by c = Some o -> are_angles o /\ 0 < Claim.value (length_of c)).
  { intros o eo. unfold is_oriented in oriented. rewrite eo in oriented.
    assert (or' : certainly bits true (length_of c) && forallb (fun t => is_angle_number bits (least t) && is_angle_number bits (greatest t)) (angles_of o) = true) by (destruct (mobility_of c) as [| | []]; try discriminate; exact oriented).
    apply andb_true_iff in or' as [L0 ang]. apply positive_sound in L0. split; [| exact L0].
    unfold are_angles. rewrite forallb_forall in ang. apply Forall_forall. intros y iy. specialize (ang y iy). apply andb_true_iff in ang as [a b]. split; apply (is_angle_number_sound bits); assumption. }
  assert (TE : forall th', Forall2 scaled_within lay th' -> Forall2 (contains bits) (params ++ inputs ++ tangents) (th' ++ [Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt)).
  { intros th' h'. rewrite (app_assoc th'). apply Forall2_app; [| apply Forall2_app].
    - apply (enclosed_all bits _ _ _ ep). apply Forall2_app; [exact h' |]. constructor; [apply exact_within | constructor].
    - exact (inputs_enclosed bits _ _ ei).
    - unfold tt, curve_angles in *. destruct (turned_by c) as [o |] eqn:eo; [| injection eg as <-; constructor].
      apply (tangents_in bits); [intros a i; exact (curved_angles _ a (proj1 (AOK o eq_refl)) i) | exact eg]. }
  pose proof (TE th TH) as T. change (Forall2 (contains bits) (params ++ inputs ++ tangents) theta) in T.
  (* at one pose *)
  set (posed := fun P Q => map (fun l => (about_origin k (/ two_to s) (as_strut P Q l) P Q, 0)) m).
  enough (At : forall P Q, is_pose c P Q -> Forall well_formed_driven m /\ (Forall well_formed_driven (map nominal_driven (drives c)) -> meets_driven c m P Q /\ (only_pose c = true ->
    forall v, length v = freedom k -> nonzero v -> 0 < form (lower_weights (fst one_matrix) (snd one_matrix) v) (posed P Q) v))).
  { destruct (At P Q hPQ) as [A1 AN]. split; [exact A1 |]. intro nw. destruct (AN nw) as [A2 A3]. split; [exact A2 |]. intros o P' Q' hPQ' same. destruct (At P' Q' hPQ') as [_ BN]. destruct (BN nw) as [B2 B3].
    specialize (A3 o). specialize (B3 o). rewrite o in one. cbn [negb orb] in one. apply andb_true_iff in one as [less ends].
    destruct (turns_less_sound _ bits k (turned_by c) Q Q' less (proj2 hPQ) (proj2 hPQ')) as [v [tv mv]].
    assert (E : posed P' Q' = map (fun l => (about_origin k (/ two_to s) l P' Q', 0)) (map (as_strut P Q) m) /\
      Forall (fun l => strut_length l P' Q' = strut_length l P Q) (map (as_strut P Q) m)).
    { destruct A2 as [R1 _], B2 as [R2 _]. cbn [reached legs_at] in R1, R2. rewrite forallb_forall in ends.
      assert (NP : Forall (fun l => ~ is_plane l) m).
      { clear - hm ends. induction hm as [| d l drs m' hd_ hs IH]; constructor; [| apply IH; intros y i; apply ends; right; exact i].
        specialize (ends d (or_introl eq_refl)). destruct d as [[] |], l as [[] |]; cbn in *; tauto || discriminate. }
      unfold posed. clear - A1 R1 R2 same NP. induction m as [| l m' IH]; [split; constructor |]. inversion A1; inversion R1; inversion R2; inversion same; inversion NP; subst.
      destruct IH as [I1 I2]; try assumption. destruct (same_strut l P Q P' Q') as [S1 S2]; try assumption. cbn [map]. rewrite S1, I1. split; [reflexivity | constructor; assumption]. }
    destruct E as [E1 E2]. rewrite E1 in B3. unfold posed in A3. rewrite <- (map_map (as_strut P Q) (fun l => (about_origin k (/ two_to s) l P Q, 0))) in A3.
    refine (poses_differ k (/ two_to s) _ _ _ P Q P' Q' v _ tv _ _ mv A3 B3 E2).
    - apply Rinv_neq_0_compat, Rgt_not_eq, two_to_pos.
    - exact (flat_pose k _ P flat (proj1 hPQ)).
    - exact (flat_pose k _ P' flat (proj1 hPQ')). }
  clear P Q hPQ. intros P Q [hP hQ].
  (* coordinates *)
  pose proof (flat_place k _ P flat hP) as flatP. pose proof (hull_sound _ _ hP) as hH.
  set (places := match k with Translates => coordinates P | TranslatesInPlane => [vx P; vy P] | Turns m => position_list m P end).
  assert (BX : Forall2 (contains bits) box (map (Rmult (/ two_to s)) places)).
  { unfold position_edges in eb. unfold places. destruct k as [| | mo].
    - exact (position_boxes bits InSpace _ P s box hH eb).
    - exact (position_boxes bits InPlane _ P s box hH eb).
    - exact (position_boxes bits mo _ P s box hH eb). }
  assert (EL : forall x, Formula.value x theta ell = / two_to s * Claim.value (length_of c)).
    { intro x. unfold ell, theta. apply quantity_value; [exists (Claim.value (length_of c)); split; [split; apply Rle_refl | cbn [snd pl]; unfold Rdiv; ring] |].
      rewrite <- lt. cbn [app]. rewrite nth_middle. unfold Rdiv. ring. }
  assert (OR : exists cs, Forall2 (contains bits) angles cs /\ let x := map (Rmult (/ two_to s)) places ++ cs in
    (forall theta, val3 x theta (eplace k) = vscale (/ two_to s) P) /\
    (forall y th', length th' = length th -> (forall i, (i < length cs)%nat -> nth (places_of k + i) y 0 = nth i cs 0) -> let theta := th' ++ [Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt in
      match turn with Some (N, w) => exists W, 0 < W /\ valm y theta N = mscale W Q /\ Formula.value y theta w = W | None => Q = midentity end) /\
    match k with Turns _ => Claim.value (length_of c) <> 0 /\ Formula.value x theta ell = / two_to s * Claim.value (length_of c) | _ => True end /\
    k <> Turns AboutPoint).
  { unfold is_oriented in oriented. unfold turn, places. fold k in oriented. destruct k as [| | mo].
    - destruct (turned_by c) as [o |]; [discriminate |]. injection ea as <-. exists []. split; [constructor |]. cbv zeta. rewrite app_nil_r. cbn [option_map].
      split; [reflexivity |]. split; [intros _ _ _ _; exact hQ |]. split; [exact I | discriminate].
    - destruct (turned_by c) as [o |]; [discriminate |]. injection ea as <-. exists []. split; [constructor |]. cbv zeta. cbn [option_map].
      split; [intro theta'; exact (position_value InPlane P _ [] theta' flatP) |]. split; [intros _ _ _ _; exact hQ |]. split; [exact I | discriminate].
    - assert (NA : mo <> AboutPoint) by (intro z; subst mo; discriminate).
      destruct (turned_by c) as [o |] eqn:eo; [| destruct mo; discriminate]. destruct (AOK o eq_refl) as [ok L0].
      destruct (chart_sound _ _ hQ ok) as [cs [W [hcs [W0 CH]]]]. exists cs. split; [exact (box_sound bits _ cs angles ok hcs ea) |]. cbv zeta.
      split; [intro theta'; exact (position_value mo P _ cs theta' flatP) |]. cbn [option_map first_of]. split.
      2: { split; [split; [lra | apply EL] | intro z; injection z as z; exact (NA z)]. }
      intros y th' lth first. set (theta' := th' ++ [Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt).
      destruct (CH y theta' (first_angle mo) (length (th' ++ [Claim.value (length_of c) / two_to s] ++ map input_value ins)) first) as [hN [hw _]].
      { intros a i. unfold theta'. rewrite !app_assoc. rewrite <- (Nat.add_0_r (length _)). rewrite app_nth2_plus. unfold tt, curve_angles. rewrite eo. destruct o; cbn [curved] in *; try contradiction; destruct i as [-> | []]; reflexivity. }
      destruct (chart o (first_angle mo)) as [N w]. cbn [fst snd] in hN, hw. exists W. split; [exact W0 | split; [exact hN | exact hw]]. }
  destruct OR as [cs [AX [VP [VT [V3 V4]]]]]. set (x := map (Rmult (/ two_to s)) places ++ cs) in *.
  assert (cs_at : forall i, (i < length cs)%nat -> nth (places_of k + i) x 0 = nth i cs 0).
  { intros i _. unfold x. replace (places_of k) with (length (map (Rmult (/ two_to s)) places)) by (unfold places; destruct k as [| | []]; reflexivity). apply app_nth2_plus. }
  pose proof (VP theta) as V1. pose proof (VT x th eq_refl cs_at) as V2. cbv zeta in V2. change (th ++ [Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt) with theta in V2. fold x in VP.
  specialize (ST x [] ([Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt) k turn ell (Claim.value (length_of c)) P Q). cbv zeta in ST. cbn [app length] in ST.
  specialize (ST V1 V2 V3). change (Forall2 (stands_in x theta s k (Claim.value (length_of c)) P Q) fs m) in ST.
  assert (X : Forall2 (contains bits) (box ++ angles) x) by (apply Forall2_app; assumption).
  pose proof (check_all_open bits tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place built) (params ++ inputs ++ tangents) all_tests (inside_region bits k (place_of c) s) theta T
    (fun y => y = x)) as H.
  specialize (H ltac:(intros cell lambda y q e l a d; cbv beta in a; rewrite a in d; unfold inside_region in e; destruct k as [| | mo] eqn:ek; try discriminate;
    assert (cs = []) by (unfold is_oriented in oriented; fold k in oriented; rewrite ek in oriented; destruct (turned_by c); [discriminate |]; injection ea as <-; inversion AX; reflexivity); subst cs;
    unfold x, places in d; rewrite app_nil_r in d; exact (tangent_sound bits (place_of c) s P hP cell lambda q e l d)) t _ x C X eq_refl). rewrite len in H.
  assert (HT : forall d, In d demands -> exists q, (forall x, map (Formula.value x theta) q = map input_value (inputs_of angular s d)) /\
    (forall f, In f (own_q q d) -> formula_at tape (place f) = f) /\
    (forall o, In o (tests_q q d) -> exists t, o = Some t /\
      Check.holds bits tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place built) (params ++ inputs ++ tangents) theta (freedom k) x t)).
  { intros d id. destruct (of_each_anywhere angular s demands d (th ++ [Claim.value (length_of c) / two_to s]) tt id) as [q [q1 q2]]. fold ins in q1.
    rewrite <- app_assoc in q1. fold theta in q1. rewrite app_length, lt, Nat.add_1_r in q2. fold j in q2. exists q. split; [exact q1 |]. split.
    - intros f i. apply Found. unfold wanted. do 3 (apply in_or_app; right). apply in_or_app. left. exact (q2 _ _ _ i).
    - intros o i. destruct (all_some_in _ _ _ _ et (q2 _ tests_q o i)) as [u [e iu]]. exists u. split; [exact e | exact (H u (Sub u iu))]. }
  (* legs that can be built *)
  assert (Low : exists low c0, contains bits low c0 /\ 0 <= c0 /\ Check.holds bits tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place built) (params ++ inputs ++ tangents) theta (freedom k) x (SigmaMin low)).
  { apply existsb_exists in ex as [d [id e]]. destruct (HT d id) as [q [_ [_ q3]]]. destruct d; try discriminate; cbn [tests_q tests_for] in q3; destruct (q3 _ ltac:(left; reflexivity)) as [u [e1 hu]].
    - injection e1 as <-. exists zero, 0. split; [apply zero_sound |]. split; [lra | exact hu].
    - destruct (enclose_parameter bits _) as [a |] eqn:ew; [| discriminate]. injection e1 as <-. eexists; eexists. split; [exact (squared_rate bits s angular _ _ ew) |]. split; [apply pow2_ge_0 | exact hu]. }
  destruct Low as [low [c0 [hc0 [c00 [BU LOW]]]]].
  assert (WF : Forall well_formed_driven m).
  { assert (B : forall f, In f built -> Formula.defined x theta f).
    { intros f i. rewrite Forall_map, Forall_forall in BU. specialize (BU f i). rewrite Found in BU; [exact BU |]. unfold wanted. apply in_or_app. right. apply in_or_app. right. apply in_or_app. left. exact i. }
    unfold built in B. clear - ST B. induction ST as [| f l fs' m' [hb _] hs IH]; constructor.
    - apply hb. apply Forall_forall. intros g i. apply B. cbn [flat_map]. apply in_or_app. left. exact i.
    - apply IH. intros g i. apply B. cbn [flat_map]. apply in_or_app. right. exact i. }
  split; [exact WF |]. intro nominal_wf.
  set (L := Claim.value (length_of c)) in *. set (look := fun l => Seen (driven_row k L P Q l) (own_joint l (carried l P Q)) (driven_rod k P Q l) (own_reach l (carried l P Q))).
  assert (good : Forall2 (is_good x theta s (freedom k) angular) fs (map look m)).
  { rewrite forallb_forall in kinds. assert (KD : Forall (fun l => rate_unit s l = / two_to (rate angular s)) m).
    { clear - hm kinds. clearbody angular. induction hm as [| d l drs m' hd_ hs IH]; constructor; [| apply IH; intros y i; apply kinds; right; exact i].
      specialize (kinds d (or_introl eq_refl)). apply Bool.eqb_prop in kinds. destruct d, l; cbn [is_driven is_angular_drive rate_unit] in *; try contradiction; rewrite <- kinds; cbn [rate].
      - change (two_to 0) with 1. field.
      - symmetry. apply two_to_opposite. }
    clear - ST WF KD V4. induction ST as [| f l fs' m' [_ h] hs IH]; [constructor |]. inversion WF as [| ? ? wl WF']; subst. inversion KD as [| ? ? kl KD']; subst. cbn [map]. constructor; [| apply IH; assumption].
    destruct (h wl) as [h1 [h2 [h3 h4]]]. unfold is_good, look. cbv zeta. cbn [seen_row seen_joint seen_rod seen_reach]. rewrite <- kl.
    split; [unfold driven_row; cbv zeta; destruct k as [| | []]; reflexivity |]. split.
    { destruct l as [l | l]; cbn [own_joint rate_unit own_reach well_formed_driven] in *; [reflexivity |]. split; [reflexivity | intro re; exact (proj1 (angle_splits l _ wl re))]. }
    split; [exact h1 |]. split; [exact h2 |]. split; [intro d; exact (h3 d V4) |]. intro re. destruct (h4 re) as [x1 [x2 [x3 [x4 _]]]]. auto. }
  assert (W1 : forall e, In e (entries (pose_rows fs)) -> formula_at tape (place e) = e) by (intros e i; apply Found, in_or_app; left; exact i).
  assert (W2 : forall e, In e (entries (pose_divided fs)) -> formula_at tape (place e) = e) by (intros e i; apply Found, in_or_app; right; apply in_or_app; left; exact i).
  destruct (of_rows_energy x theta s (freedom k) angular fs (map look m) (fun b => vadd P (mulv Q b)) tape good W1 W2 _ LOW) as [RE _].
  pose proof (low_sees bits x theta s (freedom k) angular fs (map look m) (fun b => vadd P (mulv Q b)) tape (params ++ inputs ++ tangents) (map place built) good W1 W2 low c0 hc0 c00 (conj BU LOW)) as SEES.
  assert (EJ : map seen_row (map look m) = jacobian (legs_at k L (map nominal_driven (drives c)) m P Q)) by (rewrite map_map; reflexivity).
  unfold meets_driven. fold k demands L. 
  assert (RP : Forall (fun l => own_reach l (carried l P Q)) m) by (rewrite Forall_map in RE; exact RE).
  split; [split; [exact RP |]; split |].
  3: { intros o v lv nz. assert (IA : In (Chords (map_rows place about) (fst one_matrix) (snd one_matrix)) all_tests) by (unfold all_tests; rewrite o; apply inserted_in; left; reflexivity).
    pose proof (H _ IA) as K. cbn [Check.holds] in K. 
    assert (RF : map_rows (formula_at tape) (map_rows place about) = about) by (apply rows_found; intros e' i; apply Found; unfold wanted; do 4 (apply in_or_app; right); exact i). rewrite RF in K. destruct K as [_ K]. specialize (K v lv nz).
    rewrite o in one. cbn [negb orb] in one. apply andb_true_iff in one as [_ ends]. rewrite forallb_forall in ends.
    assert (E : map (fun p => (fst p, 0)) (map_rows (Formula.value x theta) about) = map (fun p => (map (Rmult (/ two_to s)) (fst p), 0)) (posed P Q)).
    { unfold about, posed. rewrite o. clear - ST WF RP hm ends. revert hm ends. generalize (drives c). induction ST as [| f l fs' m' [_ h] hs IH]; intros drs hm ends; [reflexivity |].
      inversion WF; inversion RP; inversion hm as [| d ? drs' ? hd_]; subst. cbn [map]. rewrite map_rows_cons. cbn [map fst snd].
      rewrite (IH ltac:(assumption) ltac:(assumption) drs' ltac:(assumption) ltac:(intros y i; apply ends; right; exact i)). f_equal. f_equal.
      destruct (h ltac:(assumption)) as [_ [_ [_ h4]]]. destruct (h4 ltac:(assumption)) as [_ [_ [_ [_ [p | e]]]]]; [| exact e]. exfalso.
      specialize (ends d (or_introl eq_refl)). destruct d as [[] |], l as [[] |]; cbn in *; tauto || discriminate. }
    rewrite E in K. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as u0. apply Rmult_lt_reg_l with (/ two_to s); [exact u0 |]. rewrite Rmult_0_r.
    match type of K with 0 < ?y => replace (/ two_to s * _) with y; [exact K |] end.
    clear. generalize (lower_weights (fst one_matrix) (snd one_matrix) v). unfold posed. induction m as [| l m' IH]; intros [| [y z] ws]; cbn [map form fst]; try ring.
    rewrite IH, dot_map. ring. }
  - unfold Configuration.injective in *. cbn [jacobian] in SEES. rewrite EJ in SEES. exact SEES.
  - apply Forall_forall. intros d id. destruct (HT d id) as [q [q1 [q2 q3]]].
    assert (Other : (forall error b angle, d <> OnePose error b angle) -> (forall i a v b, d <> AccelerationMax i a v b) -> Configuration.fulfils (freedom k) (legs_at k L (map nominal_driven (drives c)) m P Q) d).
    { intros no no'. assert (E1 : own_q q d = own_of fs q d) by (destruct d; try reflexivity; [contradiction (no' _ _ _ _ eq_refl) | contradiction (no _ _ _ eq_refl)]).
      assert (E2 : tests_q q d = tests_for bits place fs angular s q d) by (destruct d; try reflexivity; [contradiction (no' _ _ _ _ eq_refl) | contradiction (no _ _ _ eq_refl)]).
      rewrite E1 in q2. rewrite E2 in q3.
      pose proof (demand_met bits x theta s (freedom k) angular fs (map look m) (fun b => vadd P (mulv Q b)) tape (params ++ inputs ++ tangents) (map place built) good W1 W2 RE q d (q1 x) q2 q3 SEES) as met.
      rewrite !map_map in met. exact (reached_aside _ _ _ _ _ _ _ _ _ _ _ met). }
    destruct d as [| | | | | | | | | | | | | | | | i a v b | error b angle | ]; try (apply Other; discriminate); clear Other; cbn [Configuration.fulfils recovers accelerates legs_at]; cbn [own_q tests_q] in q2, q3.
    { unfold accelerated_own in q2. unfold accelerated_tests in q3. destruct (nth_error fs i) as [f |] eqn:ef; [| destruct (q3 None (or_introl eq_refl)) as [u [eu _]]; discriminate].
      destruct (nth_error zs i) as [z |] eqn:ez; [| destruct (q3 None (or_introl eq_refl)) as [u [eu _]]; discriminate].
      destruct (certainly bits true b && _) eqn:ce; [| destruct (q3 None (or_introl eq_refl)) as [u [eu _]]; discriminate].
      apply andb_true_iff in ce as [b0 ce]. apply andb_true_iff in ce as [p0 q0]. apply nonneg_sound in p0, q0. apply positive_sound in b0.
      destruct (q3 _ (or_introl eq_refl)) as [u [eu hu]].
      destruct (good_at x theta s (freedom k) angular fs (map look m) (fun b => vadd P (mulv Q b)) tape good W1 W2 i f ef) as [o [eo [_ [_ [_ [_ [_ go]]]]]]]. rewrite nth_error_map in eo.
      destruct (nth_error m i) as [l |] eqn:el; [| discriminate]. injection eo as <-. cbn [look seen_row seen_joint seen_rod seen_reach] in go.
      assert (rl : own_reach l (carried l P Q)) by (rewrite Forall_forall in RP; exact (RP l (nth_error_In _ _ el))). destruct (go rl) as [_ [rows [_ rods]]]. clear go.
      assert (wl : well_formed_driven l) by (rewrite Forall_forall in WF; exact (WF l (nth_error_In _ _ el))).
      assert (Fr : forall back, drives_from s x (th ++ back) z l) by (intro back; exact (related_at _ _ _ _ _ (FR x [] back) i z l ez el)).
      assert (Th : drives_there x theta s P Q (drive_at k (eturned turn) (fst z) (snd z)) l).
      { pose proof (DR x [] ([Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt) k (eturned turn) P Q V1 (turned_is x theta turn Q V2)) as D. cbn [app] in D. rewrite drives_of_from in D. fold zs theta in D.
        refine (related_at _ _ _ _ _ D i _ l _ el). change (length []) with 0%nat. fold zs. rewrite nth_error_map, ez. reflexivity. }
      assert (Kd : match fst z with RotaryDrive _ => true | _ => false end = angular /\ match fst z, l with LinearDrive (SliderLeg _), Linear (Guided _) | LinearDrive (StrutLeg _ _ _), Linear (Extensible _ _ _) | LinearDrive (PlanarLeg _), Linear (Plane _) | RotaryDrive _, Rotary _ => True | _, _ => False end).
      { rewrite forallb_forall in kinds. assert (G : nth_error (drives c) i = Some (fst z)).
        { clear - ez. unfold zs in ez. clear zs. revert ds i ez. generalize 0%nat. induction (drives c) as [| d drs IH]; intros j0 ds [| i] ez; try discriminate; cbn [all_from nth_error] in *; [injection ez as <-; reflexivity | exact (IH _ _ _ ez)]. }
        pose proof (kinds _ (nth_error_In _ _ G)) as kd. apply Bool.eqb_prop in kd. pose proof (related_at _ _ _ _ _ hm i _ l G el) as isd.
        destruct (fst z) as [[] |], l as [[] |]; cbn [is_driven is_leg_of is_angular_drive] in *; try contradiction; split; auto. }
      destruct Kd as [ka Kd].
      assert (mu_is : rate_unit s l = / two_to (rate angular s)).
      { rewrite <- ka. destruct (fst z) as [[] |], l as [[] |]; try contradiction; cbn [rate_unit rate]; try (change (two_to 0) with 1; field). symmetry. apply two_to_opposite. }
      refine (joint_met bits x th ([Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt) s k (eturned turn) ell L P Q tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place built) (params ++ inputs ++ tangents)
        f z l q a v b i Fr Th V1 _ wl rl _ _ Kd _ _ b0 p0 q0 u _ hu).
      - clear - V3 EL. destruct k; auto.
      - rewrite mu_is. exact rows.
      - destruct (d_rod f) as [[e2 size] |]; [| exact I]. destruct rods as [y [y1 [y2 [y3 _]]]]. exists y. auto.
      - rewrite ka. exact (q1 x).
      - rewrite lt. exact q2.
      - rewrite lt. exact eu. }
    destruct (may_be_near bits k (drives c) angle) eqn:may; [| destruct (q3 None (or_introl eq_refl)) as [u [eu _]]; discriminate].
    assert (PL : is_position_of k P) by (destruct k; exact flatP).
    assert (ANG : match k with Turns _ => 0 < Claim.value angle /\ is_angle (Claim.value angle) | _ => True end).
    { unfold may_be_near in may. destruct k; auto. apply andb_true_iff in may as [may _]. apply andb_true_iff in may as [a1 a2]. split; [exact (positive_sound bits _ a1) | exact (is_angle_number_sound bits _ a2)]. }
    assert (b0 : 0 < Claim.value b).
    { destruct (certainly bits true b) eqn:e; [exact (positive_sound bits _ e) |]. exfalso. unfold located_tests in q3. rewrite e, andb_false_r in q3.
      destruct (enclose_parameter bits (exactly b, s)), (tangent_of bits k angle), (all_some (map (joint_near bits place lay s error b) js)); destruct (q3 None (or_introl eq_refl)) as [u [eu _]]; discriminate. }
    assert (U : forall y, Formula.value y theta (turn_unit q) * / two_to s = tangent (Claim.value angle) / Claim.value b).
    { intro y. unfold turn_unit. rewrite value_over.
      assert (NumY : forall n, Formula.value y theta (nth n q (integer 0)) = nth n (map input_value (inputs_of angular s (OnePose error b angle))) 0)
        by (intro n; rewrite <- (q1 y); symmetry; exact (map_nth (Formula.value y theta) q (integer 0) n)).
      rewrite !NumY. cbn [inputs_of map nth input_value]. rewrite two_to_less. pose proof (two_to_pos s). pose proof (two_to_pos (order_of [b])). field. repeat split; lra. }
    refine (located_legs bits tape (map_rows place (pose_rows fs)) (map_rows place (pose_divided fs)) (map place built) (params ++ inputs ++ tangents) k turn ell (turn_unit q) s ds (drives c) m P Q L cs th
      ([Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt) error b angle angular (tangent_of bits k angle) V4 hm WF nominal_wf RP _ TH _ _ PL _ _ _ _ _ q2 ANG _ q3).
    + rewrite forallb_forall in kinds. clear - hm kinds. clearbody angular. induction hm as [| d l drs m' hd_ hs IH]; constructor; [| apply IH; intros y i; apply kinds; right; exact i].
      specialize (kinds d (or_introl eq_refl)). apply Bool.eqb_prop in kinds. destruct d, l; cbn [is_driven is_angular_drive rate_unit] in *; try contradiction; rewrite <- kinds; cbn [rate].
      * split; [change (two_to 0) with 1; field | exact I].
      * split; [symmetry; apply two_to_opposite | reflexivity].
    + exact TE.
    + intros y k' placed P' Q' h1 h2. exact (DR y [] ([Claim.value (length_of c) / two_to s] ++ map input_value ins ++ tt) k' placed P' Q' h1 h2).
    + change (length x = freedom k). rewrite <- (related_length _ _ _ _ _ X). exact len.
    + split; apply VP.
    + intros y th' lth first b'. exact (turned_is y _ turn Q (VT y th' lth first) b').
    + clear - V3 EL. destruct k; auto. destruct V3 as [L0 _]. split; [exact L0 | exact EL].
    + intro y. specialize (U y). clear - U. destruct k; auto.
    + unfold tangent_of. clear - ANG. intros t' e. destruct k; try (injection e as <-; apply Fixed.integer_sound). exact (enclose_tangent_sound bits angle t' e (proj2 ANG)).
Qed.

Lemma nominal_is_driven : forall drs m, Forall2 is_driven drs m -> Forall2 is_driven drs (map nominal_driven drs).
Proof.
  intros drs m h. induction h as [| d l drs m hd_ hs IH]; cbn [map]; constructor; [| exact IH]. destruct (nominal_along 0 (0, 0)%Z d l hd_) as [v [y [h _]]]. clear - h.
  destruct d as [dr | a]; cbn [nominal_driven is_driven is_driven_along] in *.
  - destruct dr as [c | a p ax | n]; cbn [nominal_leg is_leg_along is_leg_of] in *.
    + destruct h as [[h1 h2] h3]. split; [exists v; split; assumption | exact h3].
    + destruct h as [h1 [h2 h3]]. split; [exact h1 |]. split; [exact h2 |]. destruct ax; [exists v; exact h3 | exact I].
    + exact h.
  - destruct h as [[h1 [h2 [h3 h4]]] h5]. split; [exists v, y; auto | exact h5].
Qed.
Theorem check_driven_sound : forall bits one_matrix one_place c s ds t, check_driven bits one_matrix one_place c s ds t = true -> driven_holds c.
Proof.
  intros bits one_matrix one_place c s ds t h m P Q hm.
  destruct (check_driven_at bits one_matrix one_place c s ds t h m P Q hm) as [WF met]. split; [exact WF |]. apply met.
  exact (proj1 (check_driven_at bits one_matrix one_place c s ds t h _ P Q (conj (nominal_is_driven _ _ (proj1 hm)) (proj2 hm)))).
Qed.

(** ** Claims that are about something *)

Definition least_driven (d : any_drive) : exact_driven :=
  match d with
  | LinearDrive d => XLinear (least_leg d)
  | RotaryDrive a => XRotary (ExactArm (leasts (axis_within a)) (leasts (reference_within a)) (leasts (anchor_within a)) (leasts (platform_within a))
      (least (arm_within a)) (least (rod_within a)) (is_positive_mode a))
  end.
Definition certify_driven (exact bits : positive) (one_matrix : N * list (list Z)) (one_place : nat) (c : driven_claim) (s : Z) (ds : list (Z * Z)) (t : tree) : bool :=
  all_exact exact (drives c) (map least_driven (drives c)) && is_in exact (place_of c) (some_point (place_of c)) &&
  match turned_by c with Some o => forallb (is_met exact) (angles_of o) | None => true end && check_driven bits one_matrix one_place c s ds t.

Theorem certify_driven_sound : forall exact bits one_matrix one_place c s ds t, certify_driven exact bits one_matrix one_place c s ds t = true ->
  driven_holds c /\ exists m P Q, is_about_driven c m P Q.
Proof.
  intros exact bits one_matrix one_place c s ds t h. apply andb_true_iff in h as [h k]. apply andb_true_iff in h as [h o]. apply andb_true_iff in h as [l p].
  split; [exact (check_driven_sound bits one_matrix one_place c s ds t k) |]. destruct (all_exact_sound exact _ _ l) as [m _]. apply (is_in_sound exact) in p.
  assert (T : exists Q, match turned_by c with Some o => in_orientations o Q | None => Q = midentity end)
    by (destruct (turned_by c) as [a |]; [exact (some_orientation exact _ o) | exists midentity; reflexivity]).
  destruct T as [Q hQ]. eexists; eexists; exists Q. split; [exact m | split; [exact p | exact hQ]].
Qed.
End Named.
