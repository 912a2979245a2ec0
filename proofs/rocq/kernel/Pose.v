(** * Platforms that turn: formulas, and certified claims

    With half-angle tangents c, R = N/w, and w A and w D of a strut are
    polynomials (motion.rs): tests at control points, a bisection tree. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert.kernel Require Import Linear Configuration.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Test Cell Check Number Trig Formula Machine Problem Witness Turning Control.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** The tree *)

Section Tree.
Variable bits : positive.
Variable tape : list (op nat).
Variable params : list fixed.
Variable tests : list polynomial_test.
Variables m n : nat.

Definition shows_at (points : list (list (option fixed))) (t : polynomial_test) (e : evidence) : bool :=
  match t, e with
  | LeastOf r w k, AtControls (ByLower places Y) => forallb (lower_at bits n places Y r w k) points
  | GreatestOf r w k, AtControls ByTest => forallb (upper_at bits n r w k) points
  | SignOf f, AtControls ByTest => forallb (sign_at f) points
  | _, _ => false
  end.
Fixpoint discharged (points : list (list (option fixed))) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  match steps with
  | [] => Some open
  | (i, e) :: rest =>
      match nth i open false, nth_error tests i with
      | true, Some t => if shows_at points t e then discharged points rest (clear i open) else None
      | _, _ => None
      end
  end.
Definition steps_at (cell : list fixed) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  match steps with [] => Some open | _ => discharged (map (evaluate_at bits tape params) (grid bits cell)) steps open end.
Fixpoint check_poses (cell : list fixed) (open : list bool) (t : tree) : bool :=
  match t with
  | Leaf steps => match steps_at cell steps open with Some last => forallb negb last | None => false end
  | Split steps k lower upper =>
      match steps_at cell steps open with
      | Some last => let (a, b) := halves k cell in if check_poses a last lower then check_poses b last upper else false
      | None => false
      end
  end.

Variable theta : list R.
Hypothesis theta_in : Forall2 (contains bits) params theta.
Definition test_places (t : polynomial_test) : list nat :=
  match t with LeastOf r w _ | GreatestOf r w _ => w :: all_places r | SignOf f => [f] end.
Hypothesis affine : forall t, In t tests -> forallb (is_affine_at tape m) (test_places t) = true.

Definition test_holds (x : list R) (t : polynomial_test) : Prop :=
  let here i := at_pairs theta (entry_at tape i) (parabola x) in
  match t with
  | LeastOf r w kappa2 => forall k v, contains bits kappa2 k -> length v = n -> nonzero v ->
      positive_D (map_rows here r) /\ k * here w * Linear.dot v v < energy (map_rows here r) v
  | GreatestOf r w k2 => forall k v, contains bits k2 k -> length v = n -> nonzero v ->
      positive_D (map_rows here r) /\ energy (map_rows here r) v < k * here w * Linear.dot v v
  | SignOf f => 0 <= here f
  end.

Lemma shows_at_sound : forall cell x t e, In t tests -> Forall2 (contains bits) cell x -> length cell = m ->
  shows_at (map (evaluate_at bits tape params) (grid bits cell)) t e = true -> test_holds x t.
Proof.
  intros cell x t e it hx len h. pose proof (affine t it) as ha.
  assert (K : forall good, forallb good (map (evaluate_at bits tape params) (grid bits cell)) = true ->
    forall q, In q (grid bits cell) -> good (evaluate_at bits tape params q) = true)
    by (intros good f q iq; rewrite forallb_forall in f; apply f, in_map, iq).
  destruct t as [r w k2 | r w k2 | f], e as [| | | | | | | | | | | [| | places Y | | | | | | | | |]]; cbn [shows_at test_holds test_places] in *; try discriminate.
  - intros k v. apply (lower_shown bits tape params theta theta_in m cell x hx len n places Y); [exact ha | exact (K _ h)].
  - intros k v. apply (upper_shown bits tape params theta theta_in m cell x hx len n); [exact ha | exact (K _ h)].
  - cbn [forallb] in ha. apply andb_true_iff in ha as [ha _]. exact (sign_shown bits tape params theta theta_in m cell x hx len f ha (K _ h)).
Qed.

Definition is_done (x : list R) (open : list bool) : Prop := forall i t, nth_error tests i = Some t -> nth i open false = false -> test_holds x t.

Lemma steps_at_sound : forall cell x steps open rest, Forall2 (contains bits) cell x -> length cell = m ->
  steps_at cell steps open = Some rest -> is_done x open -> is_done x rest.
Proof.
  intros cell x steps open rest hx len h.
  assert (h' : discharged (map (evaluate_at bits tape params) (grid bits cell)) steps open = Some rest) by (destruct steps; exact h). clear h.
  revert open h'. induction steps as [| [i e] steps IH]; intros open h D; cbn [discharged] in h; [injection h as <-; exact D |].
  destruct (nth i open false); [| discriminate]. destruct (nth_error tests i) as [t |] eqn:nt; [| discriminate].
  destruct (shows_at _ t e) eqn:s; [| discriminate]. apply (IH _ h). intros j u nj o.
  destruct (nth_clear i j open o) as [-> | o']; [| exact (D j u nj o')]. rewrite nt in nj. injection nj as <-.
  exact (shows_at_sound cell x t e (nth_error_In _ _ nt) hx len s).
Qed.

Theorem check_poses_sound : forall tr cell x open, check_poses cell open tr = true -> Forall2 (contains bits) cell x -> length cell = m ->
  is_done x open -> forall t, In t tests -> test_holds x t.
Proof.
  induction tr as [steps | steps k lower IHl upper IHu]; intros cell x open h hx len D t it; cbn [check_poses] in h;
    destruct (steps_at cell steps open) as [rest |] eqn:s; try discriminate; pose proof (steps_at_sound cell x steps open rest hx len s D) as D'.
  - destruct (In_nth_error _ _ it) as [i e]. apply (D' i t e). rewrite forallb_forall in h.
    destruct (nth_in_or_default i rest false) as [k | ->]; [| reflexivity]. apply h in k. destruct (nth i rest false); [discriminate | reflexivity].
  - pose proof (halves_sound bits k cell x hx) as c. destruct (halves_length k cell) as [La Lb]. destruct (halves k cell) as [a b]. cbn [fst snd] in *.
    destruct (check_poses a rest lower) eqn:ha; [| discriminate].
    destruct c as [c | c]; [exact (IHl a x rest ha c ltac:(congruence) D' t it) | exact (IHu b x rest h c ltac:(congruence) D' t it)].
Qed.

Lemma none_done : forall x, is_done x (map (fun _ => true) tests).
Proof.
  intros x i t e o. exfalso. rewrite (nth_indep _ false true) in o.
  - rewrite (map_nth (fun _ => true) tests (SignOf 0) i) in o. discriminate.
  - rewrite map_length. apply nth_error_Some. congruence.
Qed.
End Tree.

(** ** Formulas *)

Record emat := EMat { erow1 : evec; erow2 : evec; erow3 : evec }.
Definition eweight (t : formula) : formula := plus (integer 1) (square t).
Definition eabout (k : nat) (t : formula) : emat :=
  let w := eweight t in let c := minus (integer 1) (square t) in let s := times (integer 2) t in let z := integer 0 in
  match k with
  | 0%nat => EMat (EVec w z z) (EVec z c (opposite s)) (EVec z s c)
  | 1%nat => EMat (EVec c z s) (EVec z w z) (EVec (opposite s) z c)
  | _ => EMat (EVec c (opposite s) z) (EVec s c z) (EVec z z w)
  end.
Definition emulv (M : emat) (u : evec) : evec := EVec (Machine.product (erow1 M) u) (Machine.product (erow2 M) u) (Machine.product (erow3 M) u).
Definition emulm (A B : emat) : emat :=
  let column f := EVec (f (erow1 B)) (f (erow2 B)) (f (erow3 B)) in
  let row u := EVec (Machine.product u (column ex)) (Machine.product u (column ey)) (Machine.product u (column ez)) in
  EMat (row (erow1 A)) (row (erow2 A)) (row (erow3 A)).
Definition ecross (a b : evec) : evec :=
  EVec (minus (times (ey a) (ez b)) (times (ez a) (ey b))) (minus (times (ez a) (ex b)) (times (ex a) (ez b)))
    (minus (times (ex a) (ey b)) (times (ey a) (ex b))).
Definition expanded (a b : formula) : formula := plus (minus (square a) (times (times (integer 2) b) a)) (square b).
Definition etwist (k : motion) (v w : evec) : list formula :=
  match k with
  | InPlane => [ex v; ey v; ez w]
  | InSpace => [ex v; ey v; ez v; ex w; ey w; ez w]
  | AboutPoint => [ex w; ey w; ez w]
  end.

(** N and w of these coordinates. *)
Definition chart (o : orientations) (first : nat) : emat * formula :=
  let c k := F (Coord (first + k)) in
  match o with
  | TurnedBy _ => (eabout 2 (c 0%nat), eweight (c 0%nat))
  | RollPitchYaw _ _ _ =>
      (emulm (eabout 2 (c 2%nat)) (emulm (eabout 1 (c 1%nat)) (eabout 0 (c 0%nat))),
       times (eweight (c 2%nat)) (times (eweight (c 1%nat)) (eweight (c 0%nat))))
  end.
Definition eposition (k : motion) : evec :=
  match k with
  | InPlane => EVec (F (Coord 0)) (F (Coord 1)) (integer 0)
  | InSpace => point
  | AboutPoint => EVec (integer 0) (integer 0) (integer 0)
  end.
Definition first_angle (k : motion) : nat := match k with InPlane => 2 | InSpace => 3 | AboutPoint => 0 end.

(** w A and w D of a strut from [a] to [b]. *)
Definition scaled_row (k : motion) (N : emat) (w ell : formula) (a b : evec) : list formula * formula :=
  let p := eposition k in let h := map2 minus p a in let nb := emulv N b in
  let own := plus (plus (plus (Machine.product b b) (expanded (ex p) (ex a))) (expanded (ey p) (ey a))) (expanded (ez p) (ez a)) in
  (etwist k (map2 plus (Machine.scaled w h) nb) (divided_by (ecross nb h) ell),
   plus (times w own) (times (integer 2) (Machine.product nb h))).

Section Values.
Variables x theta : list R.
Local Notation value := (Formula.value x theta).
Definition val3 (u : evec) : vec := Vec (value (ex u)) (value (ey u)) (value (ez u)).
Definition valm (M : emat) : mat := Mat (val3 (erow1 M)) (val3 (erow2 M)) (val3 (erow3 M)).

Lemma value_dot : forall u v, value (Machine.product u v) = Vec3.dot (val3 u) (val3 v).
Proof. intros. unfold Machine.product. rewrite !value_plus, !value_times. reflexivity. Qed.
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
Lemma val3_mulv : forall M u, val3 (emulv M u) = mulv (valm M) (val3 u).
Proof. intros. unfold emulv, mulv. unfold val3 at 1. cbn [ex ey ez]. rewrite !value_dot. reflexivity. Qed.
Lemma valm_mulm : forall A B, valm (emulm A B) = mulm (valm A) (valm B).
Proof.
  intros A B. unfold emulm, mulm, valm at 1. cbv zeta. cbn [erow1 erow2 erow3]. unfold val3 at 1 2 3. cbn [ex ey ez]. rewrite !value_dot.
  unfold valm, mulv, transpose, col1, col2, col3, val3, Vec3.dot. cbn [row1 row2 row3 vx vy vz ex ey ez]. f_equal; f_equal; ring.
Qed.

Lemma value_weight : forall t, value (eweight t) = 1 + value t ^ 2.
Proof. intro t. unfold eweight. rewrite value_plus, Formula.value_square. reflexivity. Qed.

Lemma mscale_ext : forall A B C a b c w, A = vscale w a -> B = vscale w b -> C = vscale w c -> Mat A B C = mscale w (Mat a b c).
Proof. intros. subst. reflexivity. Qed.

Lemma valm_about : forall t a, is_half_tangent (value t) a ->
  valm (eabout 0 t) = mscale (1 + value t ^ 2) (rotation_x (in_degrees a)) /\
  valm (eabout 1 t) = mscale (1 + value t ^ 2) (rotation_y (in_degrees a)) /\
  valm (eabout 2 t) = mscale (1 + value t ^ 2) (rotation_z (in_degrees a)).
Proof.
  intros t a [C S]. pose proof (pow2_ge_0 (value t)) as t0. unfold valm, eabout, rotation_x, rotation_y, rotation_z. cbv zeta. cbn [erow1 erow2 erow3].
  rewrite C, S. unfold val3. cbn [ex ey ez]. rewrite !value_weight, !value_opposite, !value_minus, !value_times, !Formula.value_square.
  change (value (integer 0)) with 0. change (value (integer 1)) with 1. change (value (integer 2)) with 2.
  repeat split; apply mscale_ext; unfold vscale; cbn [vx vy vz]; f_equal; field; lra.
Qed.
End Values.

(** ** What they stand for *)

Lemma rotations_keep : forall a b, norm2 (mulv (rotation_x a) b) = norm2 b /\ norm2 (mulv (rotation_y a) b) = norm2 b /\
  norm2 (mulv (rotation_z a) b) = norm2 b.
Proof.
  intros a [x y z]. pose proof (sin2_cos2 a) as S. unfold Rsqr in S. set (s := sin a) in *. set (c := cos a) in *.
  assert (K : forall u v, (c * u - s * v) ^ 2 + (s * u + c * v) ^ 2 = u ^ 2 + v ^ 2).
  { intros u v. replace ((c * u - s * v) ^ 2 + (s * u + c * v) ^ 2) with ((s * s + c * c) * (u ^ 2 + v ^ 2)) by ring. rewrite S. ring. }
  unfold mulv, rotation_x, rotation_y, rotation_z, norm2, Vec3.dot. fold s c. cbn [row1 row2 row3 vx vy vz].
  pose proof (K y z). pose proof (K z x). pose proof (K x y). repeat split; cbn [pow] in *; lra.
Qed.

Lemma orientation_keeps : forall o Q, in_orientations o Q -> forall b, norm2 (mulv Q b) = norm2 b.
Proof.
  intros [t | r p y] Q h b; cbn [in_orientations] in h.
  - destruct h as [a [_ ->]]. apply rotations_keep.
  - destruct h as [a [e [d [_ [_ [_ ->]]]]]]. rewrite !mulm_mulv.
    destruct (rotations_keep (in_degrees d) (mulv (rotation_y (in_degrees e)) (mulv (rotation_x (in_degrees a)) b))) as [_ [_ ->]].
    destruct (rotations_keep (in_degrees e) (mulv (rotation_x (in_degrees a)) b)) as [_ [-> _]]. apply rotations_keep.
Qed.

(** The tangent of the half of an angle in degrees. *)
Definition tangent (x : R) : R := sin (in_degrees (x / 2)) / cos (in_degrees (x / 2)).
Definition is_angle (x : R) : Prop := -180 < x < 180.

Lemma half_cosine : forall x, is_angle x -> 0 < cos (in_degrees (x / 2)).
Proof. intros x [h1 h2]. pose proof PI_RGT_0. apply cos_gt_0; unfold in_degrees; nra. Qed.

Lemma tangent_is : forall x, is_angle x -> is_half_tangent (tangent x) x.
Proof. intros x h. pose proof (half_cosine x h). apply half_tangent. unfold tangent. field. lra. Qed.

Lemma tangent_increases : forall a b, is_angle a -> is_angle b -> a <= b -> tangent a <= tangent b.
Proof.
  intros a b ha hb le. pose proof (half_cosine a ha) as ca. pose proof (half_cosine b hb) as cb. destruct ha, hb. pose proof PI_RGT_0.
  assert (S : 0 <= sin (in_degrees (b / 2) - in_degrees (a / 2))) by (apply sin_ge_0; unfold in_degrees; nra).
  rewrite sin_minus in S. unfold tangent. set (p := cos (in_degrees (a / 2))) in *. set (q := cos (in_degrees (b / 2))) in *.
  set (u := sin (in_degrees (a / 2))) in *. set (v := sin (in_degrees (b / 2))) in *. clearbody p q u v.
  apply Rmult_le_reg_r with (p * q); [apply Rmult_lt_0_compat; assumption |]. replace (u / p * (p * q)) with (u * q) by (field; lra).
  replace (v / q * (p * q)) with (v * p) by (field; lra). lra.
Qed.

Lemma mulm_scaled : forall a b A B, mulm (mscale a A) (mscale b B) = mscale (a * b) (mulm A B).
Proof. intros a b [[] [] []] [[] [] []]. unfold mulm, mscale, mulv, transpose, col1, col2, col3, vscale, Vec3.dot. cbn. f_equal; f_equal; ring. Qed.
Lemma mulv_scaled : forall a A u, mulv (mscale a A) u = vscale a (mulv A u).
Proof. intros a [[] [] []] []. unfold mscale, mulv, vscale, Vec3.dot. cbn. f_equal; ring. Qed.
Lemma mulv_scale : forall a A u, mulv A (vscale a u) = vscale a (mulv A u).
Proof. intros a [[] [] []] []. unfold mulv, vscale, Vec3.dot. cbn. f_equal; ring. Qed.

Definition angles_of (o : orientations) : list tolerance := match o with TurnedBy t => [t] | RollPitchYaw r p y => [r; p; y] end.
Definition are_angles (o : orientations) : Prop := Forall (fun t => is_angle (Claim.value (least t)) /\ is_angle (Claim.value (greatest t))) (angles_of o).
Definition tangents_within (o : orientations) (cs : list R) : Prop :=
  Forall2 (fun t c => tangent (Claim.value (least t)) <= c <= tangent (Claim.value (greatest t))) (angles_of o) cs.

(** N = w Q in some coordinates of the box. *)
Lemma chart_sound : forall o Q, in_orientations o Q -> are_angles o -> exists cs w, tangents_within o cs /\ 0 < w /\
  forall x theta first, (forall k, nth (first + k) x 0 = nth k cs 0) ->
    valm x theta (fst (chart o first)) = mscale w Q /\ Formula.value x theta (snd (chart o first)) = w.
Proof.
  assert (B : forall t a, is_angle (Claim.value (least t)) /\ is_angle (Claim.value (greatest t)) -> within t a ->
    is_angle a /\ tangent (Claim.value (least t)) <= tangent a <= tangent (Claim.value (greatest t))).
  { intros t a [[h1 h2] [h3 h4]] [l g]. assert (is_angle a) by (split; lra). split; [assumption |].
    split; apply tangent_increases; try assumption; split; assumption. }
  intros [t | r p y] Q h ok; unfold are_angles, tangents_within in *; cbn [in_orientations angles_of chart fst snd] in *.
  - destruct h as [a [ha ->]]. inversion ok as [| ? ? o1 _]. subst. destruct (B t a o1 ha) as [ia ba].
    exists [tangent a], (1 + tangent a ^ 2). split; [constructor; [exact ba | constructor] |]. split; [pose proof (pow2_ge_0 (tangent a)); lra |].
    intros x theta first hx. assert (V : Formula.value x theta (F (Coord (first + 0))) = tangent a) by exact (hx 0%nat).
    pose proof (tangent_is a ia) as T. rewrite <- V in T. destruct (valm_about x theta _ a T) as [_ [_ M]]. rewrite V in M. split; [exact M |].
    rewrite value_weight, V. reflexivity.
  - destruct h as [a [b [c [ha [hb [hc ->]]]]]]. inversion ok as [| ? ? o1 ok1]. inversion ok1 as [| ? ? o2 ok2]. inversion ok2 as [| ? ? o3 _]. subst.
    destruct (B r a o1 ha) as [ia ba]. destruct (B p b o2 hb) as [ib bb]. destruct (B y c o3 hc) as [ic bc].
    exists [tangent a; tangent b; tangent c], ((1 + tangent c ^ 2) * ((1 + tangent b ^ 2) * (1 + tangent a ^ 2))).
    split; [repeat (constructor; [assumption |]); constructor |].
    pose proof (pow2_ge_0 (tangent a)). pose proof (pow2_ge_0 (tangent b)). pose proof (pow2_ge_0 (tangent c)).
    split; [apply Rmult_lt_0_compat; [lra | apply Rmult_lt_0_compat; lra] |].
    intros x theta first hx. assert (Va : Formula.value x theta (F (Coord (first + 0))) = tangent a) by exact (hx 0%nat).
    assert (Vb : Formula.value x theta (F (Coord (first + 1))) = tangent b) by exact (hx 1%nat).
    assert (Vc : Formula.value x theta (F (Coord (first + 2))) = tangent c) by exact (hx 2%nat).
    pose proof (tangent_is a ia) as Ta. rewrite <- Va in Ta. destruct (valm_about x theta _ a Ta) as [Ma _].
    pose proof (tangent_is b ib) as Tb. rewrite <- Vb in Tb. destruct (valm_about x theta _ b Tb) as [_ [Mb _]].
    pose proof (tangent_is c ic) as Tc. rewrite <- Vc in Tc. destruct (valm_about x theta _ c Tc) as [_ [_ Mc]].
    rewrite !valm_mulm, Ma, Mb, Mc, !mulm_scaled, !value_times, !value_weight, Va, Vb, Vc. split; reflexivity.
Qed.

Lemma twist_scaled : forall k c a b, twist k (vscale c a) (vscale c b) = map (Rmult c) (twist k a b).
Proof. intros [] c a b; reflexivity. Qed.
Lemma twist_values : forall x theta k a b, map (Formula.value x theta) (etwist k a b) = twist k (val3 x theta a) (val3 x theta b).
Proof. intros x theta [] a b; reflexivity. Qed.

Definition position_list (k : motion) (P : vec) : list R :=
  match k with InPlane => [vx P; vy P] | InSpace => [vx P; vy P; vz P] | AboutPoint => [] end.
Definition is_position (k : motion) (P : vec) : Prop :=
  match k with InPlane => vz P = 0 | InSpace => True | AboutPoint => P = vzero end.

Lemma position_value : forall k P r cs theta, is_position k P -> val3 (map (Rmult r) (position_list k P) ++ cs) theta (eposition k) = vscale r P.
Proof.
  intros [] [p q z] r cs theta h; cbn [is_position vz] in h.
  - subst. unfold val3, vscale. cbn. f_equal. ring.
  - reflexivity.
  - injection h as -> -> ->. unfold val3, vscale. cbn. f_equal; ring.
Qed.

Section Row.
Variables x theta : list R.
Variables (k : motion) (P : vec) (Q : mat) (W r L : R) (N : emat) (w ell a b : evec) (we le : formula).
Variable l : strut.
Hypothesis r0 : 0 < r.
Hypothesis W0 : 0 < W.
Hypothesis L0 : 0 < L.
Hypothesis keeps : forall b, norm2 (mulv Q b) = norm2 b.
Hypothesis hP : val3 x theta (eposition k) = vscale r P.
Hypothesis hN : valm x theta N = mscale W Q.
Hypothesis hw : Formula.value x theta we = W.
Hypothesis hl : Formula.value x theta le = r * L.
Hypothesis ha : val3 x theta a = vscale r (strut_base l).
Hypothesis hb : val3 x theta b = vscale r (strut_joint l).

Lemma scaled_row_values : let (A, D) := scaled_row k N we le a b in
  Formula.value x theta D = W * r ^ 2 * norm2 (strut_vector l P Q) /\
  map (Formula.value x theta) A = map (Rmult (W * r)) (twist k (strut_vector l P Q) (vscale (/ L) (cross (arm_of_joint l Q) (strut_vector l P Q)))).
Proof.
  unfold scaled_row. cbv zeta. pose proof (keeps (strut_joint l)) as K.
  assert (Nb : val3 x theta (emulv N b) = vscale (W * r) (arm_of_joint l Q)).
  { rewrite val3_mulv, hN, hb, mulv_scaled, mulv_scale. unfold arm_of_joint. unfold vscale. cbn [vx vy vz]. f_equal; ring. }
  assert (H : val3 x theta (map2 minus (eposition k) a) = vscale r (vsub P (strut_base l))).
  { rewrite val3_minus, hP, ha. unfold vsub, vscale. cbn [vx vy vz]. f_equal; ring. }
  split.
  - assert (X : forall p q, Formula.value x theta (expanded p q) = (Formula.value x theta p - Formula.value x theta q) ^ 2).
    { intros p q. unfold expanded. rewrite value_plus, value_minus, !value_times, !Formula.value_square. cbn. ring. }
    rewrite value_plus, !value_times, !value_plus, !X, !value_dot, Nb, H, hw, hb.
    unfold val3 in ha, hP. injection hP as p1 p2 p3. injection ha as a1 a2 a3. rewrite p1, p2, p3, a1, a2, a3.
    unfold strut_vector. fold (arm_of_joint l Q) in K. set (n := arm_of_joint l Q) in *. change (Formula.value x theta (integer 2)) with 2.
    replace (Vec3.dot (vscale r (strut_joint l)) (vscale r (strut_joint l))) with (r ^ 2 * norm2 (strut_joint l)) by (unfold Vec3.dot, norm2, vscale; cbn [vx vy vz]; ring).
    rewrite <- K. clearbody n. clear. destruct P as [p1 p2 p3], (strut_base l) as [b1 b2 b3], n as [n1 n2 n3].
    unfold norm2, Vec3.dot, vsub, vadd, vscale. cbn [vx vy vz]. ring.
  - rewrite twist_values, <- twist_scaled. rewrite val3_plus, val3_scaled, val3_divided, val3_cross, Nb, H, hw, hl.
    unfold strut_vector. set (n := arm_of_joint l Q). clearbody n. clear - r0 L0. f_equal.
    + destruct P as [p1 p2 p3], (strut_base l) as [b1 b2 b3], n as [n1 n2 n3]. unfold vsub, vadd, vscale. cbn [vx vy vz]. f_equal; ring.
    + destruct P as [p1 p2 p3], (strut_base l) as [b1 b2 b3], n as [n1 n2 n3]. unfold vsub, vadd, vscale, cross. cbn [vx vy vz]. f_equal; field; lra.
Qed.

Lemma scaled_row_speed : let (A, D) := scaled_row k N we le a b in
  (0 < Formula.value x theta D -> 0 < norm2 (strut_vector l P Q) /\
    forall v, Linear.dot (map (Formula.value x theta) A) v ^ 2 / Formula.value x theta D = W * Linear.dot (strut_row k L l P Q) v ^ 2) /\
  Formula.value x theta D = W * r ^ 2 * norm2 (strut_vector l P Q).
Proof.
  pose proof scaled_row_values as S. destruct (scaled_row k N we le a b) as [A D]. destruct S as [-> ->]. split; [| reflexivity].
  pose proof (pow_lt r 2 r0) as r2. pose proof (Rmult_lt_0_compat _ _ W0 r2) as wr. intro p.
  assert (n0 : 0 < norm2 (strut_vector l P Q)) by (apply Rmult_lt_reg_l with (W * r ^ 2); lra). split; [exact n0 |].
  intro v. unfold strut_row. cbv zeta. pose proof (sqrt_lt_R0 _ n0) as s0.
  assert (E : twist k (normalised (strut_vector l P Q)) (vscale (/ L) (cross (arm_of_joint l Q) (normalised (strut_vector l P Q))))
    = map (Rmult (/ sqrt (norm2 (strut_vector l P Q)))) (twist k (strut_vector l P Q) (vscale (/ L) (cross (arm_of_joint l Q) (strut_vector l P Q))))).
  { rewrite <- twist_scaled. unfold normalised. f_equal. set (c := / sqrt _). generalize (arm_of_joint l Q) (strut_vector l P Q). clear.
    intros [u1 u2 u3] [v1 v2 v3]. unfold vscale, cross. cbn [vx vy vz]. f_equal; ring. }
  rewrite E, !dot_map. assert (S2 : sqrt (norm2 (strut_vector l P Q)) ^ 2 = norm2 (strut_vector l P Q)) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra).
  rewrite !Rpow_mult_distr, pow_inv, S2. field. split; [lra | split; lra].
Qed.
End Row.

(** ** Checking *)

Definition strut_layout (s : Z) (t : tolerances * tolerances) : list parameter := three (fst t) s ++ three (snd t) s.
Fixpoint all_rows (k : motion) (N : emat) (w ell : formula) (s : Z) (ts : list (tolerances * tolerances)) (j : nat) : rows formula :=
  match ts with
  | [] => []
  | t :: ts' => let q := numbered j (strut_layout s t) in
      scaled_row k N w ell (vector_at q 0) (vector_at q 3) :: all_rows k N w ell s ts' (j + length (strut_layout s t))
  end.

Section Precision.
Variable bits : positive.

(** The tangent of the half of an angle is sin/(1 + cos); of 0 it is 0. *)
Definition enclose_tangent (x : number) : option fixed :=
  if is_zero x then Some zero
  else match cosine (bits + 64) x, sine (bits + 64) x with
    | Some c, Some s => option_map (fun q => shortened 64 (mul (bits + 64) s q)) (recip (bits + 64) (add (Fixed.integer (bits + 64) 1) c))
    | _, _ => None
    end.
Definition angle_box (t : tolerance) : option fixed :=
  match enclose_tangent (least t), enclose_tangent (greatest t) with Some a, Some b => Some (Fixed (lo a) (hi b)) | _, _ => None end.
Definition is_angle_number (x : number) : bool :=
  certainly bits true (Plus (180 // 1) x) && certainly bits true (Minus (180 // 1) x).

(** The bound of a leg's length, in the unit of the check, and what it is not to be negative. *)
Definition length_bound (s : Z) (d : demand) : parameter :=
  match d with LengthMin _ b | LengthMax _ b => (exactly b, s) | _ => (exactly (0 // 1), 0%Z) end.
Definition length_sign (rows : rows formula) (w : formula) (s : Z) (j : nat) (d : demand) : option formula :=
  let bound := times (square (quantity (length_bound s d) j)) w in
  match d with
  | LengthMin i b => match nth_error rows i with Some (_, D) => if certainly bits false b then Some (minus D bound) else None | None => None end
  | LengthMax i b => match nth_error rows i with Some (_, D) => if certainly bits false b then Some (minus bound D) else None | None => None end
  | _ => None
  end.
Definition pose_test (place : formula -> nat) (rows : rows formula) (w : formula) (s : Z) (j : nat) (d : demand) : option polynomial_test :=
  let squared make x := option_map (fun a => make (map_rows place rows) (place w) (sqr bits a)) (enclose_parameter bits (exactly x, 0%Z)) in
  match d with
  | Nonsingular => Some (LeastOf (map_rows place rows) (place w) zero)
  | FactorMax b => squared LeastOf (Over (1 // 1) b)
  | FactorMin b => squared GreatestOf (Over (1 // 1) b)
  | LengthMin _ _ | LengthMax _ _ => option_map (fun f => SignOf (place f)) (length_sign rows w s j d)
  | AngleWithin _ _ _ | Conditioned _ => None
  end.
Fixpoint pose_tests (place : formula -> nat) (rows : rows formula) (w : formula) (s : Z) (j : nat) (ds : list demand) : list (option polynomial_test) :=
  match ds with [] => [] | d :: ds' => pose_test place rows w s j d :: pose_tests place rows w s (S j) ds' end.
Fixpoint length_signs (rows : rows formula) (w : formula) (s : Z) (j : nat) (ds : list demand) : list formula :=
  match ds with [] => [] | d :: ds' => (match length_sign rows w s j d with Some f => [f] | None => [] end) ++ length_signs rows w s (S j) ds' end.
Definition excludes (d : demand) : bool := match d with Nonsingular | FactorMax _ => true | _ => false end.

Definition position_tolerances (k : motion) (t : tolerances) : list tolerance :=
  match k with InPlane => [tx t; ty t] | InSpace => [tx t; ty t; tz t] | AboutPoint => [] end.
Definition is_nothing (t : tolerance) : bool := Witness.same (least t) (0 // 1) && Witness.same (greatest t) (0 // 1).
Definition is_flat (k : motion) (t : tolerances) : bool :=
  match k with InPlane => is_nothing (tz t) | InSpace => true | AboutPoint => is_nothing (tx t) && is_nothing (ty t) && is_nothing (tz t) end.

Definition check_turning (c : turning_claim) (s : Z) (t : tree) : bool :=
  let k := motion_of c in let m := dimension k in
  let ps := flat_map (strut_layout s) (struts c) ++ [(exactly (characteristic_length c), s)] in
  let j := length ps in
  let ell := quantity (exactly (characteristic_length c), s) (length (flat_map (strut_layout s) (struts c))) in
  let (N, w) := chart (turned c) (first_angle k) in
  let rows := all_rows k N w ell s (struts c) 0 in
  let wanted := entries rows ++ w :: length_signs rows w s j (turning_demands c) in
  let tape := fst (compile (map (image m) wanted)) in
  let place f := Formula.place (formulas tape) (image m f) in
  forallb (fun f => Formula.same (nth (place f) (formulas tape) (integer 0)) (image m f)) wanted && forallb (is_below m) wanted &&
  existsb excludes (turning_demands c) && is_flat k (positions c) && certainly bits true (characteristic_length c) &&
  forallb (fun t => is_angle_number (least t) && is_angle_number (greatest t)) (angles_of (turned c)) &&
  match all_some (map (enclose_parameter bits) (ps ++ map (length_bound s) (turning_demands c))),
        all_some (map (fun t => enclose_parameter bits (t, s)) (position_tolerances k (positions c))),
        all_some (map angle_box (angles_of (turned c))),
        all_some (pose_tests place rows w s j (turning_demands c)) with
  | Some params, Some box, Some angles, Some tests =>
      Nat.eqb (length (box ++ angles)) m && forallb (fun t => forallb (is_affine_at tape m) (test_places t)) tests &&
      check_poses bits tape params tests m (box ++ angles) (map (fun _ => true) tests) t
  | _, _, _, _ => false
  end.

(** ** Soundness *)

Lemma enclose_tangent_sound : forall x a, enclose_tangent x = Some a -> is_angle (Claim.value x) -> contains bits a (tangent (Claim.value x)).
Proof.
  intros x a h ok. unfold enclose_tangent in h. destruct (is_zero x) eqn:z.
  - injection h as <-. unfold is_zero in z. destruct (rational x) as [q |] eqn:r; [| discriminate]. apply QArith_base.Qeq_bool_eq, Qreals.Qeq_eqR in z.
    assert (q0 : Rdefinitions.Q2R q = 0) by (rewrite z; unfold Rdefinitions.Q2R; cbn; lra). rewrite (rational_sound _ _ r), q0. unfold tangent, in_degrees.
    replace (0 / 2 * PI / 180) with 0 by field. rewrite sin_0. unfold Rdiv. rewrite Rmult_0_l. apply zero_sound.
  - destruct (cosine (bits + 64) x) as [c |] eqn:ec; [| discriminate]. destruct (sine (bits + 64) x) as [u |] eqn:es; [| discriminate].
    destruct (recip _ _) as [q |] eqn:eq; [| discriminate]. cbn [option_map] in h. assert (E : shortened 64 (mul (bits + 64) u q) = a) by congruence. subst a.
    apply (shortened_sound bits 64). apply cosine_sound in ec. apply sine_sound in es.
    destruct (recip_sound (bits + 64) _ q (1 + cos (in_degrees (Claim.value x))) eq (add_sound _ _ _ _ _ (Fixed.integer_sound (bits + 64) 1) ec)) as [_ R].
    pose proof (half_cosine _ ok) as p0. assert (D : in_degrees (Claim.value x) = 2 * in_degrees (Claim.value x / 2)) by (unfold in_degrees; field).
    replace (tangent (Claim.value x)) with (sin (in_degrees (Claim.value x)) * / (1 + cos (in_degrees (Claim.value x)))); [apply mul_sound; assumption |].
    unfold tangent. rewrite D. set (p := in_degrees (Claim.value x / 2)) in *. rewrite sin_2a, cos_2a_cos. field. split; [lra |].
    replace (1 + (2 * cos p * cos p - 1)) with (2 * (cos p * cos p)) by ring. nra.
Qed.

Lemma is_angle_number_sound : forall x, is_angle_number x = true -> is_angle (Claim.value x).
Proof. intros x h. apply andb_true_iff in h as [a b]. apply positive_sound in a, b. cbn [Claim.value] in a, b. split; lra. Qed.

Definition stands (x theta : list R) (k : motion) (P : vec) (Q : mat) (W r L : R) (row : list formula * formula) (l : strut) : Prop :=
  let (A, D) := row in
  (0 < Formula.value x theta D -> 0 < norm2 (strut_vector l P Q) /\
    forall v, Linear.dot (map (Formula.value x theta) A) v ^ 2 / Formula.value x theta D = W * Linear.dot (strut_row k L l P Q) v ^ 2) /\
  Formula.value x theta D = W * r ^ 2 * norm2 (strut_vector l P Q).

Lemma all_rows_stand : forall s ts m, Forall2 is_strut ts m -> exists th, Forall2 scaled_within (flat_map (strut_layout s) ts) th /\
  forall x front back k P Q W L N w ell, 0 < W -> 0 < L -> (forall b, norm2 (mulv Q b) = norm2 b) ->
    val3 x (front ++ th ++ back) (eposition k) = vscale (/ two_to s) P -> valm x (front ++ th ++ back) N = mscale W Q ->
    Formula.value x (front ++ th ++ back) w = W -> Formula.value x (front ++ th ++ back) ell = / two_to s * L ->
    Forall2 (stands x (front ++ th ++ back) k P Q W (/ two_to s) L) (all_rows k N w ell s ts (length front)) m.
Proof.
  intros s. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0.
  induction 1 as [| t l ts m [ha hb] hs [th2 [L2 R2]]]; [exists []; split; [constructor | intros; constructor] |].
  set (th1 := coordinates (vscale (/ two_to s) (strut_base l)) ++ coordinates (vscale (/ two_to s) (strut_joint l))).
  assert (L1 : Forall2 scaled_within (strut_layout s t) th1) by (apply Forall2_app; apply three_within; assumption).
  exists (th1 ++ th2). split; [cbn [flat_map]; apply Forall2_app; assumption |].
  intros x front back k P Q W L N w ell W0 L0 keeps hP hN hw hl. cbn [all_rows]. cbv zeta. constructor.
  - rewrite <- app_assoc in *. pose proof (numbered_values _ _ x front (th2 ++ back) L1) as V.
    apply (scaled_row_speed x (front ++ th1 ++ th2 ++ back) k P Q W (/ two_to s) L N _ _ w ell l); try assumption;
      unfold val3, vector_at; cbn [ex ey ez]; rewrite <- !(map_nth (Formula.value x (front ++ th1 ++ th2 ++ back))), V; reflexivity.
  - specialize (R2 x (front ++ th1) back k P Q W L N w ell W0 L0 keeps). rewrite app_length, <- (related_length _ _ _ _ _ L1) in R2.
    rewrite <- !app_assoc in *. apply R2; assumption.
Qed.

Lemma rows_speed : forall x theta k P Q W r L rows m, Forall2 (stands x theta k P Q W r L) rows m -> positive_D (map_rows (Formula.value x theta) rows) ->
  Forall (fun l => 0 < norm2 (strut_vector l P Q)) m /\
  forall v, energy (map_rows (Formula.value x theta) rows) v = W * Configuration.speed2 (map (fun l => strut_row k L l P Q) m) v.
Proof.
  intros x theta k P Q W r L. induction 1 as [| [A D] l rows m [h _] hs IH]; intro p; [split; [constructor | intro; cbn; ring] |].
  rewrite map_rows_cons in p. inversion p as [| ? ? p1 p2]. subst. destruct (IH p2) as [I1 I2]. destruct (h p1) as [h1 h2].
  split; [constructor; assumption |]. intro v. rewrite map_rows_cons. cbn [energy map]. unfold Configuration.speed2 in *. cbn [fold_right]. rewrite I2, h2. ring.
Qed.

(** A demand's own test, bound and formula. *)
Lemma demand_at : forall place rows w s ds j d, In d ds -> exists i, nth_error ds i = Some d /\
  In (pose_test place rows w s (j + i) d) (pose_tests place rows w s j ds) /\
  forall f, length_sign rows w s (j + i) d = Some f -> In f (length_signs rows w s j ds).
Proof.
  intros place rows w s ds. induction ds as [| q ds IH]; intros j d i; [contradiction |]. destruct i as [-> | i].
  - exists O. rewrite Nat.add_0_r. split; [reflexivity |]. split; [left; reflexivity |]. intros f e. cbn [length_signs]. rewrite e. left. reflexivity.
  - destruct (IH (S j) d i) as [n [h1 [h2 h3]]]. exists (S n). rewrite <- Nat.add_succ_comm. split; [exact h1 |]. split; [right; exact h2 |].
    intros f e. cbn [length_signs]. apply in_or_app. right. exact (h3 f e).
Qed.

Lemma is_nothing_sound : forall t y, is_nothing t = true -> within t y -> y = 0.
Proof.
  intros t y h [l g]. apply andb_true_iff in h as [a b]. apply Witness.same_sound in a, b. rewrite a in l. rewrite b in g. cbn in l, g. lra.
Qed.

Lemma flat_position : forall k t P, is_flat k t = true -> all_within t P -> is_position k P.
Proof.
  intros [] t [p q z] h [h1 [h2 h3]]; cbn [is_flat is_position vx vy vz] in *; [exact (is_nothing_sound _ _ h h3) | exact I |].
  apply andb_true_iff in h as [h b]. apply andb_true_iff in h as [a c]. rewrite (is_nothing_sound _ _ a h1), (is_nothing_sound _ _ c h2), (is_nothing_sound _ _ b h3). reflexivity.
Qed.

Lemma position_boxes : forall k t P s box, all_within t P ->
  all_some (map (fun t => enclose_parameter bits (t, s)) (position_tolerances k t)) = Some box ->
  Forall2 (contains bits) box (map (Rmult (/ two_to s)) (position_list k P)).
Proof.
  intros k t P s box [h1 [h2 h3]] e.
  assert (K : forall l box, Forall2 (fun t y => within t y) (map fst l) (map snd l) -> all_some (map (fun t => enclose_parameter bits (t, s)) (map fst l)) = Some box ->
    Forall2 (contains bits) box (map (Rmult (/ two_to s)) (map (@snd tolerance R) l))).
  { induction l as [| [a y] l IH]; intros b h q; cbn [map fst snd all_some] in *; [injection q as <-; constructor |].
    destruct (enclose_parameter bits (a, s)) as [i |] eqn:ei; [| discriminate].
    destruct (all_some (map (fun t => enclose_parameter bits (t, s)) (map fst l))) as [r |] eqn:er; [| discriminate].
    assert (E : b = i :: r) by congruence. subst b. inversion h; subst. constructor; [| apply IH; [assumption | reflexivity]]. apply (enclose_parameter_sound bits _ _ _ ei). exists y. split; [assumption |]. cbn [snd]. unfold Rdiv. ring. }
  destruct k; cbn [position_tolerances position_list] in *.
  - apply (K [(tx t, vx P); (ty t, vy P)] box); [cbn [map fst snd]; auto using Forall2_cons, Forall2_nil | exact e].
  - apply (K [(tx t, vx P); (ty t, vy P); (tz t, vz P)] box); [cbn [map fst snd]; auto using Forall2_cons, Forall2_nil | exact e].
  - injection e as <-. constructor.
Qed.

Lemma angle_boxes : forall o cs angles, are_angles o -> tangents_within o cs -> all_some (map (angle_box) (angles_of o)) = Some angles -> Forall2 (contains bits) angles cs.
Proof.
  intros o cs angles ok h. unfold are_angles, tangents_within in *. revert angles ok. induction h as [| t c ts cs hc h IH]; intros angles ok e; cbn [map all_some] in e; [injection e as <-; constructor |].
  inversion ok as [| ? ? [o1 o2] ok']. subst. unfold angle_box in e. destruct (enclose_tangent (least t)) as [a |] eqn:ea; [| discriminate].
  destruct (enclose_tangent (greatest t)) as [b |] eqn:eb; [| discriminate]. destruct (all_some _) as [r |]; [| discriminate]. injection e as <-.
  constructor; [| apply IH; [exact ok' | reflexivity]]. destruct (enclose_tangent_sound _ _ ea o1) as [l _]. destruct (enclose_tangent_sound _ _ eb o2) as [_ u].
  pose proof (unit_R_pos bits). unfold contains. cbn [lo hi]. split; nra.
Qed.

Lemma squared_in : forall x a, enclose_parameter bits (exactly x, 0%Z) = Some a -> contains bits (sqr bits a) (Claim.value x ^ 2).
Proof.
  intros x a e. apply sqr_sound, (enclose_parameter_sound bits _ _ _ e). exists (Claim.value x). unfold within, exactly. cbn [fst snd least greatest].
  split; [lra |]. change (two_to 0) with 1. field.
Qed.

Theorem check_turning_sound : forall c s t, check_turning c s t = true -> turning_holds c.
Proof.
  intros c s t h m P Q [hm [hP hQ]]. unfold check_turning in h. cbv zeta in h. destruct (chart (turned c) (first_angle (motion_of c))) as [N w] eqn:ch.
  set (k := motion_of c) in *. set (ts := struts c) in *. set (ds := turning_demands c) in *. set (lay := flat_map (strut_layout s) ts) in *.
  set (pl := (exactly (characteristic_length c), s)) in *. set (j := length (lay ++ [pl])) in *. set (ell := quantity pl (length lay)) in *.
  set (rows := all_rows k N w ell s ts 0) in *. set (wanted := entries rows ++ w :: length_signs rows w s j ds) in *.
  set (tape := fst (compile (map (image (dimension k)) wanted))) in *. set (place := fun f => Formula.place (formulas tape) (image (dimension k) f)) in *.
  apply andb_true_iff in h as [h C]. apply andb_true_iff in h as [h ang]. apply andb_true_iff in h as [h L0].
  apply andb_true_iff in h as [h flat]. apply andb_true_iff in h as [h ex]. apply andb_true_iff in h as [found below_].
  destruct (all_some (map (enclose_parameter bits) _)) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map _ (position_tolerances _ _))) as [box |] eqn:eb; [| discriminate].
  destruct (all_some (map angle_box _)) as [angles |] eqn:ea; [| discriminate].
  destruct (all_some (pose_tests _ _ _ _ _ _)) as [tests |] eqn:et; [| discriminate].
  apply andb_true_iff in C as [C tree_ok]. apply andb_true_iff in C as [len aff]. apply Nat.eqb_eq in len.
  apply positive_sound in L0. set (L := Claim.value (characteristic_length c)) in *.
  assert (ok : are_angles (turned c)).
  { unfold are_angles. rewrite forallb_forall in ang. apply Forall_forall. intros u iu. specialize (ang u iu). apply andb_true_iff in ang as [a b].
    split; apply (is_angle_number_sound); assumption. }
  destruct (chart_sound _ _ hQ ok) as [cs [W [hcs [W0 CH]]]].
  destruct (all_rows_stand s ts m hm) as [th [TH RS]]. set (bs := map (fun d => Claim.value (least (fst (length_bound s d))) / two_to (snd (length_bound s d))) ds).
  set (theta := th ++ [/ two_to s * L] ++ bs).
  assert (TL : Forall2 scaled_within (lay ++ [pl]) (th ++ [/ two_to s * L])).
  { apply Forall2_app; [exact TH |]. constructor; [| constructor]. exists L. split; [split; apply Rle_refl |]. cbn [snd pl]. unfold Rdiv. ring. }
  assert (TB : Forall2 scaled_within (map (length_bound s) ds) bs).
  { unfold bs. clear. induction ds as [| d l IH]; cbn [map]; constructor; [| exact IH]. eexists. split; [| reflexivity]. unfold within. destruct d; cbn; lra. }
  assert (T : Forall2 (contains bits) params theta) by (unfold theta; rewrite app_assoc; apply (enclosed_all bits _ _ _ ep); apply Forall2_app; assumption).
  set (x := map (Rmult (/ two_to s)) (position_list k P) ++ cs).
  assert (X : Forall2 (contains bits) (box ++ angles) x) by (apply Forall2_app; [exact (position_boxes k _ P s box hP eb) | exact (angle_boxes _ cs angles ok hcs ea)]).
  assert (lx : length x = dimension k) by (rewrite <- (related_length _ _ _ _ _ X); exact len).
  assert (first : forall i, nth (first_angle k + i) x 0 = nth i cs 0).
  { intro i. unfold x. replace (first_angle k) with (length (map (Rmult (/ two_to s)) (position_list k P))) by (destruct k; reflexivity). apply app_nth2_plus. }
  destruct (CH x theta (first_angle k) first) as [hN hw]. rewrite ch in hN, hw. cbn [fst snd] in hN, hw.
  assert (lt : length th = length lay) by (symmetry; exact (related_length _ _ _ _ _ TH)).
  assert (hl : Formula.value x theta ell = / two_to s * L).
  { unfold ell, theta. apply quantity_value; [exists L; split; [split; apply Rle_refl | cbn [snd pl]; unfold Rdiv; ring] |].
    rewrite <- lt. apply nth_middle. }
  pose proof (RS x [] ([/ two_to s * L] ++ bs) k P Q W L N w ell W0 L0 (orientation_keeps _ _ hQ)
    (position_value k P _ cs _ (flat_position _ _ _ flat hP)) hN hw hl) as ST.
  change (Forall2 (stands x theta k P Q W (/ two_to s) L) rows m) in ST.
  (* the tape *)
  rewrite forallb_forall in found, below_.
  assert (Found : forall f, In f wanted -> at_pairs theta (entry_at tape (place f)) (parabola x) = Formula.value x theta f).
  { intros f i. assert (E : entry_at tape (place f) = image (dimension k) f) by (apply Formula.same_sound, found, i).
    rewrite E, <- lx. apply image_value. rewrite lx. apply below_, i. }
  assert (Rows : map_rows (fun i => at_pairs theta (entry_at tape i) (parabola x)) (map_rows place rows) = map_rows (Formula.value x theta) rows).
  { assert (K : forall r, (forall f, In f (entries r) -> In f wanted) ->
      map_rows (fun i => at_pairs theta (entry_at tape i) (parabola x)) (map_rows place r) = map_rows (Formula.value x theta) r).
    { induction r as [| [A D] r IH]; intro i; [reflexivity |]. rewrite !map_rows_cons. f_equal.
      - f_equal; [rewrite map_map; apply map_ext_in; intros f q; apply Found, i; cbn [entries flat_map fst]; apply in_or_app; left; apply in_or_app; left; exact q |].
        apply Found, i. cbn [entries flat_map snd]. apply in_or_app. left. apply in_or_app. right. left. reflexivity.
      - apply IH. intros f q. apply i. cbn [entries flat_map]. apply in_or_app. right. exact q. }
    apply K. intros f q. apply in_or_app. left. exact q. }
  assert (Weight : at_pairs theta (entry_at tape (place w)) (parabola x) = W) by (rewrite Found; [exact hw | apply in_or_app; right; left; reflexivity]).
  rewrite forallb_forall in aff.
  pose proof (check_poses_sound bits tape params tests (dimension k) (dimension k) theta T aff t _ x _ tree_ok X len ltac:(apply none_done)) as HT.
  assert (Speed : positive_D (map_rows (Formula.value x theta) rows) -> Forall (fun l => 0 < norm2 (strut_vector l P Q)) m /\
    forall v, energy (map_rows (Formula.value x theta) rows) v = W * Configuration.speed2 (map (fun l => strut_row k L l P Q) m) v)
    by (apply (rows_speed x theta k P Q W (/ two_to s) L); exact ST).
  assert (Z : forall v, ~ nonzero v -> Linear.dot v v = 0 /\ Configuration.speed2 (map (fun l => strut_row k L l P Q) m) v = 0).
  { intros v z. pose proof (zero_vector v ltac:(apply Rnot_lt_le; exact z)) as F0. split; [apply dot_zero, F0 |].
    generalize (map (fun l => strut_row k L l P Q) m). intro M. unfold Configuration.speed2. induction M as [| row M IH]; cbn [fold_right]; [reflexivity |]. rewrite IH, (dot_zero v row F0). ring. }
  assert (NZ : forall v, nonzero v \/ ~ nonzero v) by (intro v; destruct (Rlt_dec 0 (Linear.dot v v)); auto).
  set (conf := struts_at k L m P Q).
  assert (Lower : forall low kappa, contains bits low kappa -> 0 <= kappa -> In (LeastOf (map_rows place rows) (place w) low) tests ->
    Forall (fun l => 0 < norm2 (strut_vector l P Q)) m /\ forall v, length v = dimension k -> nonzero v -> kappa * Linear.dot v v < Configuration.speed2 (jacobian conf) v).
  { intros low kappa hk k0 it. pose proof (HT _ it) as H. cbn [test_holds] in H.
    assert (PD : positive_D (map_rows (Formula.value x theta) rows)).
    { assert (U : exists v, length v = dimension k /\ nonzero v) by (exists (repeat 1 (dimension k)); destruct k; (split; [reflexivity | unfold nonzero; cbn; lra])).
      destruct U as [v [lv nv]]. destruct (H kappa v hk lv nv) as [p _]. rewrite Rows in p. exact p. }
    destruct (Speed PD) as [R1 R2]. split; [exact R1 |]. intros v lv nv. destruct (H kappa v hk lv nv) as [_ q]. rewrite Rows, Weight, R2 in q.
    apply Rmult_lt_reg_l with W; [exact W0 |]. cbn [jacobian conf struts_at]. unfold conf, struts_at. cbn [jacobian]. lra. }
  assert (Test : forall d, In d ds -> exists i u, nth_error ds i = Some d /\ pose_test place rows w s (j + i) d = Some u /\ In u tests /\
    forall f, length_sign rows w s (j + i) d = Some f -> In f wanted).
  { intros d id. destruct (demand_at place rows w s ds j d id) as [i [h1 [h2 h3]]]. destruct (all_some_in _ _ _ _ et h2) as [u [e iu]].
    exists i, u. split; [exact h1 |]. split; [exact e |]. split; [exact iu |]. intros f q. apply in_or_app. right. right. exact (h3 f q). }
  assert (Reach : exists low kappa, contains bits low kappa /\ 0 <= kappa /\ In (LeastOf (map_rows place rows) (place w) low) tests).
  { apply existsb_exists in ex as [d [id e]]. destruct (Test d id) as [i [u [_ [pu [iu _]]]]]. destruct d; try discriminate; cbn [pose_test] in pu.
    - injection pu as <-. exists zero, 0. split; [apply zero_sound |]. split; [lra | exact iu].
    - destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-. eexists; eexists. split; [apply squared_in, e1 |].
      split; [apply pow2_ge_0 | exact iu]. }
  destruct Reach as [low [kappa [hk [k0 it]]]]. destruct (Lower low kappa hk k0 it) as [reach_ low_].
  assert (INJ : Configuration.injective (dimension k) conf).
  { intros v lv nv. specialize (low_ v lv nv). unfold nonzero in nv. assert (0 <= kappa * Linear.dot v v) by (apply Rmult_le_pos; lra). lra. }
  unfold meets_turning. fold k L ds conf. split; [exact reach_ |]. split; [exact INJ |]. apply Forall_forall. intros d id.
  destruct (Test d id) as [i [u [nd [pu [iu signs]]]]].
  assert (Bound : forall b, length_bound s d = (exactly b, s) -> Formula.value x theta (quantity (length_bound s d) (j + i)) = / two_to s * Claim.value b).
  { intros b e. apply quantity_value; [rewrite e; exists (Claim.value b); split; [split; apply Rle_refl | cbn [snd]; unfold Rdiv; ring] |].
    unfold theta. rewrite app_assoc. replace j with (length (th ++ [/ two_to s * L])) by (unfold j; rewrite !app_length; cbn [length]; lia).
    rewrite app_nth2_plus. unfold bs. apply nth_error_nth. rewrite nth_error_map, nd. cbn [option_map]. rewrite e. cbn. f_equal. unfold Rdiv. ring. }
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. set (ratio := / two_to s) in *.
  assert (Leg : forall n A D, nth_error rows n = Some (A, D) -> exists l, nth_error m n = Some l /\ Formula.value x theta D = W * ratio ^ 2 * norm2 (strut_vector l P Q)).
  { clear - ST. intros n A D. revert n. induction ST as [| [A' D'] l rows' m' [_ hd] hs IH]; intros [| n] e; try discriminate; cbn [nth_error] in *.
    - injection e as -> ->. exists l. split; [reflexivity | exact hd].
    - exact (IH n e). }
  assert (Joint : forall n l, nth_error m n = Some l -> nth_error (joints conf) n = Some (Length (strut_length l P Q)))
    by (intros n l e; unfold conf, struts_at; cbn [joints]; rewrite nth_error_map, e; reflexivity).
  pose proof (pow_lt ratio 2 r0) as r2. pose proof (Rmult_lt_0_compat _ _ W0 r2) as wr.
  destruct d as [| b | b | n b | n b | n b b' | b]; cbn [pose_test] in pu; try discriminate; cbn [Configuration.fulfils].
  4-5: cbn [length_sign] in *; destruct (nth_error rows n) as [[A D] |] eqn:nr; [| discriminate]; destruct (certainly bits false b) eqn:b0; [| discriminate];
    cbn [option_map] in pu; injection pu as <-; apply nonneg_sound in b0; destruct (Leg n A D nr) as [l [nl vD]];
    pose proof (HT _ iu) as H; cbn [test_holds] in H; pose proof (Found _ (signs _ eq_refl)) as FF;
    match type of FF with _ = ?v => assert (G : 0 <= v) by (rewrite <- FF; exact H) end; clear H FF; rename G into H;
    rewrite value_minus, value_times, Formula.value_square, (Bound b eq_refl), vD in H; rewrite hw in H;
    exists (strut_length l P Q); (split; [exact (Joint n l nl) |]); unfold strut_length; rewrite <- (sqrt_pow2 (Claim.value b) b0); apply sqrt_le_1_alt;
    apply Rmult_le_reg_l with (W * ratio ^ 2); [exact wr |]; rewrite Rpow_mult_distr in H; lra.
  - exact INJ.
  - destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-. pose proof (squared_in _ _ e1) as K.
    cbn [Claim.value] in K. replace (1 / 1) with 1 in K by field. destruct (Lower _ _ K (pow2_ge_0 _) iu) as [_ G]. intros v lv.
    destruct (NZ v) as [nz | z]; [apply Rlt_le, G; assumption | destruct (Z v z) as [-> q]; unfold conf, struts_at; cbn [jacobian]; rewrite q; lra].
  - destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-. pose proof (squared_in _ _ e1) as K.
    cbn [Claim.value] in K. replace (1 / 1) with 1 in K by field. pose proof (HT _ iu) as H. cbn [test_holds] in H. intros v lv.
    unfold conf, struts_at. cbn [jacobian]. destruct (NZ v) as [nz | z]; [| destruct (Z v z) as [-> ->]; lra].
    destruct (H _ v K lv nz) as [p q]. rewrite Rows in p, q. rewrite Weight, (proj2 (Speed p)) in q. apply Rlt_le, Rmult_lt_reg_l with W; [exact W0 | lra].
Qed.
End Precision.

(** ** Claims that are about something *)

Definition is_met (exact : positive) (t : tolerance) : bool := below exact (least t) (greatest t).
Definition are_met (exact : positive) (t : tolerances) : bool := is_met exact (tx t) && is_met exact (ty t) && is_met exact (tz t).
Definition certify_turning (exact bits : positive) (c : turning_claim) (s : Z) (t : tree) : bool :=
  forallb (fun t => are_met exact (fst t) && are_met exact (snd t)) (struts c) && are_met exact (positions c) &&
  forallb (is_met exact) (angles_of (turned c)) && check_turning bits c s t.

Lemma least_within : forall exact t, is_met exact t = true -> within t (Claim.value (least t)).
Proof. intros exact t h. apply below_sound in h. split; [apply Rle_refl | exact h]. Qed.
Definition leasts_of (t : tolerances) : vec := Vec (Claim.value (least (tx t))) (Claim.value (least (ty t))) (Claim.value (least (tz t))).
Lemma leasts_within : forall exact t, are_met exact t = true -> all_within t (leasts_of t).
Proof.
  intros exact t h. apply andb_true_iff in h as [h z]. apply andb_true_iff in h as [x y].
  split; [| split]; apply (least_within exact); assumption.
Qed.

Theorem certify_turning_sound : forall exact bits c s t, certify_turning exact bits c s t = true ->
  turning_holds c /\ exists m P Q, is_about_struts c m P Q.
Proof.
  intros exact bits c s t h. apply andb_true_iff in h as [h k]. apply andb_true_iff in h as [h o]. apply andb_true_iff in h as [l p].
  split; [exact (check_turning_sound bits c s t k) |].
  assert (T : exists Q, in_orientations (turned c) Q).
  { rewrite forallb_forall in o. destruct (turned c) as [a | r q y]; cbn [angles_of in_orientations] in *.
    - eexists. exists (Claim.value (least a)). split; [apply (least_within exact), o; left; reflexivity | reflexivity].
    - eexists. exists (Claim.value (least r)), (Claim.value (least q)), (Claim.value (least y)).
      split; [apply (least_within exact), o; left; reflexivity |]. split; [apply (least_within exact), o; right; left; reflexivity |].
      split; [apply (least_within exact), o; right; right; left; reflexivity | reflexivity]. }
  destruct T as [Q hQ]. exists (map (fun t => Strut (leasts_of (fst t)) (leasts_of (snd t))) (struts c)), (leasts_of (positions c)), Q.
  split; [| split; [exact (leasts_within exact _ p) | exact hQ]]. rewrite forallb_forall in l.
  induction (struts c) as [| u ts IH]; cbn [map]; constructor; [| apply IH; intros v i; apply l; right; exact i].
  specialize (l u (or_introl eq_refl)). apply andb_true_iff in l as [a b]. split; apply (leasts_within exact); assumption.
Qed.
