(** * Platforms that turn: formulas, and certified claims

    With the coordinates of orientation c, R = N/w, and w A and w D of a strut are
    polynomials (motion.rs): tests at control points, a bisection tree. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert.kernel Require Import Linear Configuration.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Test Cell Check Number Trig Formula Machine Problem Witness Orientation Turning Poses Control Chart.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** The tree *)

Section Tree.
Variable bits : positive.
Variable tape : list (op nat).
Variable params : list fixed.
Variable tests : list polynomial_test.
Variables m n : nat.
(** Where it is curved, what is not negative at the orientations. *)
Variable g : option nat.


Definition shows_less (ts : list tensor) (l : multiple) (t : polynomial_test) (e : evidence) : bool :=
  let at_all e good r w := everywhere e m good (map_sample (fun i => nth i ts (Constant None)) (sample_of r w l)) in
  match t, e with
  | LeastOf r w k ends, ByLower places Y => at_all ends (lower_at bits n places Y k) r w
  | LeastOf r w k ends, ByRank places Y => (lo k =? 0)%Z && (hi k =? 0)%Z && at_all ends (rank_at n places Y) r w
  | SolveOf i r w k ends, ByLower places Y => at_all ends (solve_at bits n i places Y k) r w
  | GreatestOf r w k, ByTest => at_all 0%nat (upper_at bits n k) r w
  | ConditionOf r w c2, ByConditioning places Y (mu :: mus) =>
      everywhere_by m (conditioned_at bits n c2 places Y mu) mus 0 (map_sample (fun i => nth i ts (Constant None)) (sample_of r w l))
  | ChordsOf r w places Y, ByChords => at_all 0%nat (rank_at n places Y) r w
  | SignOf f, ByTest => at_all 0%nat sign_at [] f
  | LeverOf r w, ByLower places [[y]] => at_all 0%nat (lower_at bits 1 places [[y]] (Fixed.integer bits 1)) r w
  | _, _ => false
  end.
Definition shows_at (ts : list tensor) (t : polynomial_test) (e : evidence) : bool :=
  match e with
  | AtControls (Turned e k places) =>
      match g with Some g => (0 <=? k)%Z && (places <? 64)%N && shows_less ts (Some (g, k, places)) t e | None => false end
  | AtControls e => shows_less ts None t e
  | _ => false
  end.
(** No orientation of the set is in the cell. *)
Definition is_outside_at (cell : list fixed) : bool :=
  match g with
  | Some g => match nth g (evaluate_at bits tape params (map (fun a => (a, sqr bits a)) cell)) None with Some a => (hi a <? 0)%Z | None => false end
  | None => false
  end.
Fixpoint discharged (cell : list fixed) (ts : list tensor) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  match steps with
  | [] => Some open
  | (O, Outside) :: rest => if is_outside_at cell then discharged cell ts rest (map (fun _ => false) open) else None
  | (i, e) :: rest =>
      match nth i open false, nth_error tests i with
      | true, Some t => if shows_at ts t e then discharged cell ts rest (clear i open) else None
      | _, _ => None
      end
  end.
Definition is_outside (s : nat * evidence) : bool := match s with (O, Outside) => true | _ => false end.
(** With formulas at control points where there is a test. *)
Definition steps_at (cell : list fixed) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  discharged cell (if forallb is_outside steps then [] else tensors bits tape params cell) steps open.
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
  match t with LeastOf r w _ _ | GreatestOf r w _ | SolveOf _ r w _ _ | ConditionOf r w _ | ChordsOf r w _ _ | LeverOf r w => w :: all_places r | SignOf f => [f] end.
(** Rows and weight of a test that has ends alone of some coordinates. *)
Definition with_ends (t : polynomial_test) : option (rows nat * nat * nat) :=
  match t with LeastOf r w _ e | SolveOf _ r w _ e => Some (r, w, e) | _ => None end.
Hypothesis affine : forall t, In t tests -> forallb (is_affine_at tape m) (test_places t) = true.
Hypothesis g_affine : forall i, g = Some i -> is_affine_at tape m i = true.
Hypothesis eased : forall t r w ends, In t tests -> with_ends t = Some (r, w, ends) -> ends = O \/ length r = n /\
  is_eased tape m ends r w None = true /\ forall i k places, g = Some i -> is_eased tape m ends r w (Some (i, k, places)) = true.
(** Rows are those of struts, and the orientation is of the set. *)
Definition is_turned (x : list R) : Prop :=
  let here i := at_pairs theta (entry_at tape i) (parabola x) in
  (forall i, g = Some i -> 0 <= here i) /\ (forall t r w e, In t tests -> with_ends t = Some (r, w, e) -> e = O \/ grounded (map_rows here r) /\ 0 < here w).

Definition test_holds (x : list R) (t : polynomial_test) : Prop :=
  let here i := at_pairs theta (entry_at tape i) (parabola x) in
  match t with
  | LeastOf r w kappa2 _ => forall k v, contains bits kappa2 k -> 0 <= k -> length v = n -> nonzero v ->
      positive_D (map_rows here r) /\ k * here w * Linear.dot v v < energy (map_rows here r) v
  | SolveOf i r w k2 _ => forall k u, contains bits k2 k -> 0 <= k -> 0 < here w -> length u = length r -> nonzero u ->
      let p := weighted_sum u (map fst (map_rows here r)) in
      k * here w * (nth i (map snd (map_rows here r)) 0 * nth i u 0 ^ 2) < Linear.dot p p
  | GreatestOf r w k2 => forall k v, contains bits k2 k -> length v = n -> nonzero v ->
      positive_D (map_rows here r) /\ energy (map_rows here r) v < k * here w * Linear.dot v v
  | ConditionOf r w c2 => forall c u v, contains bits c2 c -> 0 <= c -> length u = n -> length v = n -> nonzero u -> nonzero v ->
      positive_D (map_rows here r) /\ energy (map_rows here r) u * Linear.dot v v < c * energy (map_rows here r) v * Linear.dot u u
  | SignOf f => 0 <= here f
  | LeverOf r w => positive_D (map_rows here r) /\ here w < energy (map_rows here r) [1]
  | ChordsOf r w places Y => forall v, length v = n -> nonzero v -> 0 < form (lower_weights places Y v) (map (fun p => (fst p, 0)) (map_rows here r)) v
  end.

Lemma shows_less_sound : forall cell x l t e, In t tests -> Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  (l = None \/ exists i k places, g = Some i /\ l = Some (i, k, places)) ->
  is_affine_multiple tape m l = true -> 0 <= less_at tape theta (parabola x) l ->
  shows_less (tensors bits tape params cell) l t e = true -> test_holds x t.
Proof.
  intros cell x l t e it hx len ht hl la l0 h. pose proof (affine t it) as ha.
  pose proof (fun e good s => everywhere_shown bits tape params m cell len e good s) as K.
  assert (E : forall r w c, with_ends t = Some (r, w, c) -> ends_suffice tape theta m x c n r w l).
  { intros r w c i. destruct (eased t r w c it i) as [e0 | [lr [h1 h2]]]; [left; exact e0 |]. destruct (proj2 ht t r w c it i) as [e0 | G]; [left; exact e0 | right].
    split; [| split; [exact lr | exact G]].
    destruct hl as [-> | [j [q [places [eg ->]]]]]; [exact h1 | exact (h2 j q places eg)]. }
  destruct t as [r w k2 ends | r w k2 | r w c2 | i r w k2 ends | f | r w | r w places Y], e; cbn [shows_less test_holds test_places] in *; cbv zeta in h; try discriminate.
  - intros k v. apply (lower_shown bits tape params theta theta_in m cell x hx len l la l0 ends n places Y); [exact ha | exact (E r w ends eq_refl) | exact (K _ _ _ h)].
  - apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2]. apply Z.eqb_eq in h1, h2.
    intros k v [l1 l2] k0 lv nz. rewrite h1 in l1. rewrite h2 in l2. pose proof (unit_R_pos bits). assert (z : k = 0) by nra. subst k. rewrite !Rmult_0_l.
    exact (rank_shown bits tape params theta theta_in m cell x hx len l la l0 ends n places Y r w v ha (E r w ends eq_refl) (K _ _ _ h3) lv nz).
  - intros k v. apply (upper_shown bits tape params theta theta_in m cell x hx len l la l0 n); [exact ha | exact (K _ _ _ h)].
  - destruct mu as [| mu mus]; [discriminate |]. intros c u v.
    exact (conditioned_shown bits tape params theta theta_in m cell x hx len l la l0 n places Y r w c2 mu mus c u v ha h).
  - intros k u hk k0 w0 lu nz. exact (solve_shown bits tape params theta theta_in m cell x hx len l la l0 ends n i places Y r w k2 k u ha (E r w ends eq_refl) (K _ _ _ h) hk k0 w0 lu nz).
  - cbn [forallb] in ha. apply andb_true_iff in ha as [ha _]. exact (sign_shown bits tape params theta theta_in m cell x hx len l la l0 f ha (K _ _ _ h)).
  - destruct Y as [| [| y [|]] [|]]; try discriminate.
    destruct (lower_shown bits tape params theta theta_in m cell x hx len l la l0 0%nat 1%nat places [[y]] r w _ 1 [1] ha (or_introl eq_refl) (K _ _ _ h) (Fixed.integer_sound bits 1)) as [p q];
      [lra | reflexivity | unfold nonzero; cbn; lra |]. split; [exact p |]. cbn [Linear.dot] in q. lra.
  - intros v. exact (chords_shown bits tape params theta theta_in m cell x hx len l la l0 n places Y r w v ha (K _ _ _ h)).
Qed.

Lemma shows_at_sound : forall cell x t e, In t tests -> Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  shows_at (tensors bits tape params cell) t e = true -> test_holds x t.
Proof.
  intros cell x t e it hx len ht h.
  assert (None_ : forall e, shows_less (tensors bits tape params cell) None t e = true -> test_holds x t)
    by (intros e' h'; exact (shows_less_sound cell x None t e' it hx len ht (or_introl eq_refl) eq_refl (Rle_refl 0) h')).
  destruct e as [| | | | | | | | | | | e | | | | |]; cbn [shows_at] in h; try discriminate. destruct e as [| | | | | | | | | | | | e k places | | | |]; try exact (None_ _ h).
  assert (G : exists i, g = Some i /\ (0 <=? k)%Z && (places <? 64)%N && shows_less (tensors bits tape params cell) (Some (i, k, places)) t e = true)
    by (clear - h; destruct g as [i |]; [exists i; split; [reflexivity | exact h] | discriminate]).
  destruct G as [i [eg h']]. clear h. apply andb_true_iff in h' as [h s]. apply andb_true_iff in h as [k0 _]. apply Z.leb_le, IZR_le in k0.
  apply (shows_less_sound cell x (Some (i, k, places)) t e it hx len ht); [right; exists i, k, places; auto | exact (g_affine i eg) | | exact s].
  cbn [less_at]. apply Rmult_le_pos; [| exact (proj1 ht i eg)]. pose proof (two_power places). apply Rmult_le_pos; [exact k0 | apply Rlt_le, Rinv_0_lt_compat; assumption].
Qed.

Lemma is_outside_at_sound : forall cell x, Forall2 (contains bits) cell x -> is_outside_at cell = true -> ~ is_turned x.
Proof.
  intros cell x hx h ht. unfold is_outside_at in h. destruct g as [i |] eqn:eg; [| discriminate].
  destruct (nth i _ None) as [a |] eqn:ea; [| discriminate]. apply Z.ltb_lt, IZR_lt in h.
  destruct (range_sound bits tape params theta theta_in cell x hx i a ea) as [_ u]. pose proof (proj1 ht i eg). pose proof (unit_R_pos bits). nra.
Qed.

Definition is_done (x : list R) (open : list bool) : Prop := forall i t, nth_error tests i = Some t -> nth i open false = false -> test_holds x t.

Lemma steps_at_tensors : forall cell steps open, steps_at cell steps open = discharged cell (tensors bits tape params cell) steps open.
Proof.
  intros cell steps open. unfold steps_at. destruct (forallb is_outside steps) eqn:h; [| reflexivity]. revert open h.
  induction steps as [| [i e] steps IH]; intros open h; [reflexivity |]. cbn [forallb] in h. apply andb_true_iff in h as [h1 h2].
  destruct i, e; try discriminate h1. cbn [discharged]. destruct (is_outside_at cell); [apply IH, h2 | reflexivity].
Qed.

Lemma steps_at_sound : forall cell x steps open rest, Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  steps_at cell steps open = Some rest -> is_done x open -> is_done x rest.
Proof.
  intros cell x steps open rest hx len ht h.
  assert (h' : discharged cell (tensors bits tape params cell) steps open = Some rest) by (rewrite <- steps_at_tensors; exact h). clear h.
  assert (Own : forall i e steps, (forall open, discharged cell (tensors bits tape params cell) steps open = Some rest -> is_done x open -> is_done x rest) ->
    forall open, match nth i open false, nth_error tests i with
      | true, Some t => if shows_at (tensors bits tape params cell) t e
          then discharged cell (tensors bits tape params cell) steps (clear i open) else None
      | _, _ => None end = Some rest -> is_done x open -> is_done x rest).
  { intros i e steps' IH open' h D. destruct (nth i open' false); [| discriminate]. destruct (nth_error tests i) as [t |] eqn:nt; [| discriminate].
    destruct (shows_at _ t e) eqn:s; [| discriminate]. apply (IH _ h). intros j u nj o.
    destruct (nth_clear i j open' o) as [-> | o']; [| exact (D j u nj o')]. rewrite nt in nj. injection nj as <-.
    exact (shows_at_sound cell x t e (nth_error_In _ _ nt) hx len ht s). }
  revert open h'. induction steps as [| [i e] steps IH]; intros open h D; cbn [discharged] in h; [injection h as <-; exact D |].
  pose proof (Own i e steps IH open) as O1. destruct i as [| i], e; try exact (O1 h D).
  destruct (is_outside_at cell) eqn:o; [| discriminate h]. exfalso. exact (is_outside_at_sound cell x hx o ht).
Qed.

Theorem check_poses_sound : forall tr cell x open, check_poses cell open tr = true -> Forall2 (contains bits) cell x -> length cell = m ->
  is_turned x -> is_done x open -> forall t, In t tests -> test_holds x t.
Proof.
  induction tr as [steps | steps k lower IHl upper IHu]; intros cell x open h hx len ht D t it; cbn [check_poses] in h;
    destruct (steps_at cell steps open) as [rest |] eqn:s; try discriminate; pose proof (steps_at_sound cell x steps open rest hx len ht s D) as D'.
  - destruct (In_nth_error _ _ it) as [i e]. apply (D' i t e). rewrite forallb_forall in h.
    destruct (nth_in_or_default i rest false) as [k | ->]; [| reflexivity]. apply h in k. destruct (nth i rest false); [discriminate | reflexivity].
  - pose proof (halves_sound bits k cell x hx) as c. destruct (halves_length k cell) as [La Lb]. destruct (halves k cell) as [a b]. cbn [fst snd] in *.
    destruct (check_poses a rest lower) eqn:ha; [| discriminate].
    destruct c as [c | c]; [exact (IHl a x rest ha c ltac:(congruence) ht D' t it) | exact (IHu b x rest h c ltac:(congruence) ht D' t it)].
Qed.

Lemma none_done : forall x, is_done x (map (fun _ => true) tests).
Proof.
  intros x i t e o. exfalso. rewrite (nth_indep _ false true) in o.
  - rewrite (map_nth (fun _ => true) tests (SignOf 0) i) in o. discriminate.
  - rewrite map_length. apply nth_error_Some. congruence.
Qed.
End Tree.

(** ** Formulas *)

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

(** Of a strut, of which r is its joint's lever from P: w r . A, by the vector w A in the platform's frame, and for the greatest ratio k of
    the joint's speed to the platform's, w (|b|^2 - (k^2 - q) ell^2), q = 0 if the platform turns about a point and 1 else. *)
Definition etransposed (N : emat) : emat :=
  let column f := EVec (f (erow1 N)) (f (erow2 N)) (f (erow3 N)) in EMat (column ex) (column ey) (column ez).
Definition lever (k : motion) (N : emat) (w ell : formula) (a b : evec) : formula * (formula -> formula) :=
  let own := map2 plus (Machine.scaled w b) (emulv (etransposed N) (map2 minus (eposition k) a)) in
  let q := match k with AboutPoint => 0%Z | _ => 1%Z end in
  (Machine.product own b, fun ratio => times w (minus (Machine.product b b) (times (minus (square ratio) (integer q)) (square ell)))).

(** [A, a x A]: of a strut in space, its vector w A with its moment about the origin, of which a is the base end. *)
Definition origin_row (a : evec) (row : list formula * formula) : list formula * formula :=
  match fst row with
  | x :: y :: z :: _ => let m := ecross a (EVec x y z) in ([x; y; z; ex m; ey m; ez m], snd row)
  | A => (A, snd row)
  end.

Section Values.
Variables x theta : list R.
Local Notation value := (Formula.value x theta).
Local Notation val3 := (val3 x theta).
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
End Values.

(** ** What they stand for *)

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
  { rewrite val3_mulv, hN, hb, mulv_mscale, mulv_scale. unfold arm_of_joint. unfold vscale. cbn [vx vy vz]. f_equal; ring. }
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
    exists q, q ^ 2 = W * Formula.value x theta D /\ forall v, Linear.dot (map (Formula.value x theta) A) v = q * Linear.dot (strut_row k L l P Q) v) /\
  Formula.value x theta D = W * r ^ 2 * norm2 (strut_vector l P Q) /\
  (Formula.value x theta D = 0 -> forall v, Linear.dot (map (Formula.value x theta) A) v = 0) /\ length A = dimension k.
Proof.
  assert (len : length (fst (scaled_row k N we le a b)) = dimension k) by (destruct k; reflexivity).
  pose proof scaled_row_values as S. destruct (scaled_row k N we le a b) as [A D]. destruct S as [-> ->].
  pose proof (pow_lt r 2 r0) as r2. pose proof (Rmult_lt_0_compat _ _ W0 r2) as wr. split; [| split; [reflexivity | split; [| exact len]]].
  2: { intros z v. apply Rmult_integral in z as [z | z]; [lra |]. rewrite (norm2_zero _ z), dot_map. generalize (arm_of_joint l Q). clear. intros [a b c].
    destruct k, v as [| v1 [| v2 [| v3 [| v4 [| v5 [| v6 v]]]]]]; unfold twist, vscale, cross, vzero; cbn [Linear.dot vx vy vz]; ring. }
  intro p.
  assert (n0 : 0 < norm2 (strut_vector l P Q)) by (apply Rmult_lt_reg_l with (W * r ^ 2); lra). split; [exact n0 |].
  exists (W * r * sqrt (norm2 (strut_vector l P Q))). unfold strut_row. cbv zeta. pose proof (sqrt_lt_R0 _ n0) as s0.
  assert (E : twist k (normalised (strut_vector l P Q)) (vscale (/ L) (cross (arm_of_joint l Q) (normalised (strut_vector l P Q))))
    = map (Rmult (/ sqrt (norm2 (strut_vector l P Q)))) (twist k (strut_vector l P Q) (vscale (/ L) (cross (arm_of_joint l Q) (strut_vector l P Q))))).
  { rewrite <- twist_scaled. unfold normalised. f_equal. set (c := / sqrt _). generalize (arm_of_joint l Q) (strut_vector l P Q). clear.
    intros [u1 u2 u3] [v1 v2 v3]. unfold vscale, cross. cbn [vx vy vz]. f_equal; ring. }
  assert (S2 : sqrt (norm2 (strut_vector l P Q)) ^ 2 = norm2 (strut_vector l P Q)) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra).
  split; [rewrite !Rpow_mult_distr, S2; ring |]. intro v. rewrite E, !dot_map. field. lra.
Qed.

Definition is_lever (p : formula * (formula -> formula)) : Prop :=
  Formula.value x theta (fst p) = W * r ^ 2 * Vec3.dot (arm_of_joint l Q) (strut_vector l P Q) /\
  forall ratio, Formula.value x theta (snd p ratio) =
    W * r ^ 2 * (norm2 (strut_joint l) - (Formula.value x theta ratio ^ 2 - match k with AboutPoint => 0 | _ => 1 end) * L ^ 2).
Lemma lever_values : is_lever (lever k N we le a b).
Proof.
  pose proof (keeps (strut_joint l)) as K. unfold is_lever, lever. cbv zeta. cbn [fst snd]. split.
  - assert (T : valm x theta (etransposed N) = transpose (mscale W Q)) by (rewrite <- hN; reflexivity).
    rewrite value_dot, val3_plus, val3_scaled, val3_mulv, T, val3_minus, hP, ha, hb, hw.
    replace (vsub (vscale r P) (vscale r (strut_base l))) with (vscale r (vsub P (strut_base l))) by (unfold vsub, vscale; cbn [vx vy vz]; f_equal; ring).
    set (h := vsub P (strut_base l)). set (c := strut_joint l) in *.
    transitivity (W * r ^ 2 * norm2 c + Vec3.dot (mulv (transpose (mscale W Q)) (vscale r h)) (vscale r c)); [unfold Vec3.dot, norm2, vadd, vscale; cbn [vx vy vz]; ring |].
    rewrite <- dot_transpose, mulv_mscale, mulv_scale. unfold strut_vector, arm_of_joint. fold c. rewrite <- K. subst h. generalize (mulv Q c). clear. intros [n1 n2 n3].
    destruct P as [p1 p2 p3], (strut_base l) as [b1 b2 b3]. unfold norm2, Vec3.dot, vsub, vadd, vscale. cbn [vx vy vz]. ring.
  - intro ratio. rewrite value_times, value_minus, value_dot, value_times, value_minus, !Formula.value_square, hw, hl, hb.
    assert (Q0 : Formula.value x theta (integer match k with AboutPoint => 0 | _ => 1 end) = match k with AboutPoint => 0 | _ => 1 end) by (destruct k; reflexivity).
    rewrite Q0. unfold Vec3.dot, norm2, vscale. cbn [vx vy vz]. ring.
Qed.
(** Where (r . A)^2/|A|^2 is so great, the square of the row is small. *)
Lemma lever_bounds : forall s, 0 < norm2 (strut_vector l P Q) ->
  norm2 (strut_joint l) - (s - match k with AboutPoint => 0 | _ => 1 end) * L ^ 2 < Vec3.dot (arm_of_joint l Q) (strut_vector l P Q) ^ 2 / norm2 (strut_vector l P Q) ->
  Linear.dot (strut_row k L l P Q) (strut_row k L l P Q) <= s.
Proof.
  clear - L0 keeps. intros s n0 h. rewrite <- (keeps (strut_joint l)) in h. unfold strut_row. cbv zeta. unfold arm_of_joint in *. set (c := mulv Q (strut_joint l)) in *. set (v := strut_vector l P Q) in *.
  assert (U : norm2 (normalised v) = 1).
  { unfold normalised. pose proof (sqrt_lt_R0 _ n0) as s0. transitivity (norm2 v * (/ sqrt (norm2 v)) ^ 2); [unfold norm2, vscale; cbn [vx vy vz]; ring |].
    rewrite pow_inv, pow2_sqrt by lra. field. lra. }
  assert (D : Vec3.dot c v ^ 2 / norm2 v = Vec3.dot c (normalised v) ^ 2).
  { unfold normalised. pose proof (sqrt_lt_R0 _ n0) as s0. transitivity (Vec3.dot c v ^ 2 * (/ sqrt (norm2 v)) ^ 2); [rewrite pow_inv, pow2_sqrt by lra; field; lra |].
    unfold Vec3.dot, vscale; cbn [vx vy vz]; ring. }
  rewrite D in h. set (u := normalised v) in *. clearbody u c. clear v n0 D.
  assert (X : norm2 (cross c u) = norm2 c - Vec3.dot c u ^ 2) by (transitivity (norm2 c * norm2 u - Vec3.dot c u ^ 2); [unfold norm2, cross, Vec3.dot; cbn [vx vy vz]; ring | rewrite U; ring]).
  assert (R : / L ^ 2 * norm2 (cross c u) < s - match k with AboutPoint => 0 | _ => 1 end).
  { pose proof (pow_lt L 2 L0). apply Rmult_lt_reg_l with (L ^ 2); [assumption |]. replace (L ^ 2 * (/ L ^ 2 * norm2 (cross c u))) with (norm2 (cross c u)) by (field; lra). lra. }
  assert (E : Linear.dot (twist k u (vscale (/ L) (cross c u))) (twist k u (vscale (/ L) (cross c u))) <= match k with AboutPoint => 0 | _ => 1 end + / L ^ 2 * norm2 (cross c u)).
  { rewrite <- pow_inv. generalize (/ L) (cross c u). intros i [x1 x2 x3]. destruct u as [u1 u2 u3]. unfold norm2 in *. cbn [vx vy vz] in *.
    destruct k; cbn [twist Linear.dot vx vy vz vscale]; pose proof (pow2_ge_0 u3); pose proof (pow2_ge_0 (i * x1)); pose proof (pow2_ge_0 (i * x2)); nra. }
  lra.
Qed.

Lemma origin_row_values : k = InSpace -> map (Formula.value x theta) (fst (origin_row a (scaled_row k N we le a b))) = map (Rmult (W * r)) (about_origin r l P Q).
Proof.
  intro hk. pose proof scaled_row_values as S. rewrite hk in *. unfold scaled_row in *. cbv zeta in *. destruct S as [_ S].
  set (A := map2 plus _ _) in *. cbn [etwist twist map fst origin_row] in *. set (q := strut_vector l P Q) in *.
  pose proof (f_equal (fun u => nth 0 u 0) S) as s1. pose proof (f_equal (fun u => nth 1 u 0) S) as s2. pose proof (f_equal (fun u => nth 2 u 0) S) as s3.
  cbn [nth map] in s1, s2, s3. clear S.
  assert (V : val3 x theta (EVec (ex A) (ey A) (ez A)) = vscale (W * r) q) by (unfold val3, vscale; cbn [ex ey ez]; rewrite s1, s2, s3; reflexivity).
  pose proof (val3_cross x theta a (EVec (ex A) (ey A) (ez A))) as M. rewrite V, ha in M. unfold about_origin. fold q.
  pose proof (f_equal vx M) as m1. pose proof (f_equal vy M) as m2. pose proof (f_equal vz M) as m3. cbn [vx vy vz val3] in m1, m2, m3.
  cbv zeta. unfold coordinates. cbn [map app vx vy vz vscale]. rewrite s1, s2, s3, m1, m2, m3.
  generalize (strut_base l) q. clear. intros [b1 b2 b3] [q1 q2 q3]. unfold cross, vscale. cbn [vx vy vz]. repeat (f_equal; try ring).
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

Fixpoint origin_rows (k : motion) (N : emat) (w ell : formula) (s : Z) (ts : list (tolerances * tolerances)) (j : nat) : rows formula :=
  match ts with
  | [] => []
  | t :: ts' => let q := numbered j (strut_layout s t) in
      origin_row (vector_at q 0) (scaled_row k N w ell (vector_at q 0) (vector_at q 3)) :: origin_rows k N w ell s ts' (j + length (strut_layout s t))
  end.

Fixpoint all_levers (k : motion) (N : emat) (w ell : formula) (s : Z) (ts : list (tolerances * tolerances)) (j : nat) : list (formula * (formula -> formula)) :=
  match ts with
  | [] => []
  | t :: ts' => let q := numbered j (strut_layout s t) in
      lever k N w ell (vector_at q 0) (vector_at q 3) :: all_levers k N w ell s ts' (j + length (strut_layout s t))
  end.

Section Precision.
Variable bits : positive.
(** Of claims that no two poses have the same lengths: the one matrix, and before which other test this is counted. *)
Variables (one_matrix : N * list (list Z)) (one_place : nat).
(** In space, of turns about any axis that are less than 90 degrees: two of them differ by less than half a turn. *)
Definition is_less_than_quarter (k : motion) (o : orientations) : bool :=
  match k, o with InSpace, TurnedUpTo a => certainly bits true (Minus (90 // 1) a) | _, _ => false end.

(** The number of a demand that is in formulas: the bound of a leg's length, in the unit of the check, b/k of a stiffness, or b/tool of a joint's speed. *)
Definition length_bound (s : Z) (d : demand) : parameter :=
  match d with LengthMin _ b | LengthMax _ b => (exactly b, s) | StiffnessMin k b => (exactly (Over b k), 0%Z) | SpeedMax _ tool b => (exactly (Over b tool), 0%Z) | _ => (exactly (0 // 1), 0%Z) end.
Definition length_sign (rows : rows formula) (w : formula) (s : Z) (j : nat) (d : demand) : option formula :=
  let bound := times (square (quantity (length_bound s d) j)) w in
  match d with
  | LengthMin i b => match nth_error rows i with Some (_, D) => if certainly bits false b then Some (minus D bound) else None | None => None end
  | LengthMax i b => match nth_error rows i with Some (_, D) => if certainly bits false b then Some (minus bound D) else None | None => None end
  | _ => None
  end.
(** M^T k M >= b I is sigma_min >= 1 of the rows with D b/k. *)
Definition stiff_rows (rows : rows formula) (s : Z) (j : nat) (d : demand) : Test.rows formula :=
  map (fun p => (fst p, times (snd p) (quantity (length_bound s d) j))) rows.
(** Of a joint's speed: w r . A, and what is less than its square over w D. *)
Definition lever_of (levers : list (formula * (formula -> formula))) (s : Z) (j : nat) (d : demand) : option (formula * formula) :=
  match d with SpeedMax i _ _ => option_map (fun p => (fst p, snd p (quantity (length_bound s d) j))) (nth_error levers i) | _ => None end.
Definition own_formulas (rows : rows formula) (levers : list (formula * (formula -> formula))) (w : formula) (s : Z) (j : nat) (d : demand) : list formula :=
  match d with
  | StiffnessMin _ _ => map snd (stiff_rows rows s j d)
  | SpeedMax _ _ _ => match lever_of levers s j d with Some (f, b) => [f; b] | None => [] end
  | _ => match length_sign rows w s j d with Some f => [f] | None => [] end
  end.
Definition pose_test (place : formula -> nat) (ends : nat) (rows : rows formula) (levers : list (formula * (formula -> formula))) (w : formula) (s : Z) (j : nat) (d : demand) : option polynomial_test :=
  let squared make r x := option_map (fun a => make (map_rows place r) (place w) (sqr bits a)) (enclose_parameter bits (exactly x, 0%Z)) in
  let least r w k := LeastOf r w k ends in
  match d with
  | Nonsingular => Some (least (map_rows place rows) (place w) zero)
  | FactorMax b => squared least rows (Over (1 // 1) b)
  | FactorMin b => squared GreatestOf rows (Over (1 // 1) b)
  | LengthMin _ _ | LengthMax _ _ => option_map (fun f => SignOf (place f)) (length_sign rows w s j d)
  | SpeedMax i tool b => match nth_error rows i, lever_of levers s j d with
      | Some (_, D), Some (f, b') => if certainly bits true tool && certainly bits true b then Some (LeverOf [([place f], place D)] (place b')) else None
      | _, _ => None
      end
  | StiffnessMin k b => if certainly bits true k && certainly bits true b
      then Some (LeastOf (map_rows place (stiff_rows rows s j d)) (place w) (Fixed.integer bits 1) O) else None
  | ForceMax i tool b => match nth_error rows i with
      | Some _ => if certainly bits true tool && certainly bits true b then squared (fun r w k => SolveOf i r w k ends) rows (Over tool b) else None
      | None => None
      end
  | Conditioned b => option_map (fun a => ConditionOf (map_rows place rows) (place w) (sqr bits a)) (enclose_parameter bits (exactly b, 0%Z))
  | _ => None
  end.
Fixpoint pose_tests (place : formula -> nat) (ends : nat) (rows : rows formula) (levers : list (formula * (formula -> formula))) (w : formula) (s : Z) (j : nat) (ds : list demand) : list (option polynomial_test) :=
  match ds with [] => [] | d :: ds' => pose_test place ends rows levers w s j d :: pose_tests place ends rows levers w s (S j) ds' end.
Fixpoint demand_formulas (rows : rows formula) (levers : list (formula * (formula -> formula))) (w : formula) (s : Z) (j : nat) (ds : list demand) : list formula :=
  match ds with [] => [] | d :: ds' => own_formulas rows levers w s j d ++ demand_formulas rows levers w s (S j) ds' end.
Definition excludes (d : demand) : bool := match d with Nonsingular | FactorMax _ => true | _ => false end.

Definition position_tolerances (k : motion) (t : tolerances) : list tolerance :=
  match k with InPlane => [tx t; ty t] | InSpace => [tx t; ty t; tz t] | AboutPoint => [] end.
Definition is_nothing (t : tolerance) : bool := Number.same (least t) (0 // 1) && Number.same (greatest t) (0 // 1).
Definition is_flat (k : motion) (t : tolerances) : bool :=
  match k with InPlane => is_nothing (tz t) | InSpace => true | AboutPoint => is_nothing (tx t) && is_nothing (ty t) && is_nothing (tz t) end.

(** With as many struts as coordinates, positions have ends alone. *)
Definition ends_of (fs : list formula) (m : nat) (k : motion) (r : rows nat) (w : nat) (g : option nat) : nat :=
  let e := first_angle k in
  if Nat.eqb (length r) m && eased_in m fs e r w (option_map (fun g => (g, 0%Z, 0%N)) g) then e else O.

Definition check_turning (c : turning_claim) (s : Z) (t : tree) : bool :=
  let k := motion_of c in let m := dimension k in
  let ps := flat_map (strut_layout s) (struts c) ++ [(exactly (characteristic_length c), s)] in
  let j := length ps in
  let ell := quantity (exactly (characteristic_length c), s) (length (flat_map (strut_layout s) (struts c))) in
  let (N, w) := chart (turned c) (first_angle k) in
  let rows := all_rows k N w ell s (struts c) 0 in let levers := all_levers k N w ell s (struts c) 0 in
  let g := curve (turned c) (first_angle k) (j + length (turning_demands c)) in
  let about := if one_pose c then origin_rows k N w ell s (struts c) 0 else [] in
  let wanted := entries rows ++ w :: demand_formulas rows levers w s j (turning_demands c) ++ match g with Some g => [g] | None => [] end ++ entries about in
  let tape := fst (compile (map (image m) wanted)) in
  let fs := formulas tape in
  let place f := Formula.place fs (image m f) in
  let ends := match positions c with Box _ => ends_of fs m k (map_rows place rows) (place w) (option_map place g) | _ => O end in
  forallb (fun f => Formula.same (nth (place f) fs (integer 0)) (image m f)) wanted && forallb (is_below m) wanted &&
  existsb excludes (turning_demands c) && (negb (one_pose c) || is_less_than_quarter k (turned c)) && is_flat k (hull (positions c)) && certainly bits true (characteristic_length c) &&
  forallb (fun t => is_angle_number bits (least t) && is_angle_number bits (greatest t)) (angles_of (turned c)) &&
  match all_some (map (enclose_parameter bits) (ps ++ map (length_bound s) (turning_demands c))),
        all_some (map (fun t => enclose_parameter bits (t, s)) (position_tolerances k (hull (positions c)))),
        all_some (map (end_box bits) (chart_ends (turned c))),
        all_some (map (enclose_tangent bits) (curved (turned c))),
        all_some (pose_tests place ends rows levers w s j (turning_demands c)) with
  | Some params, Some box, Some angles, Some tangents, Some tests =>
      let tests := if one_pose c then inserted one_place tests (ChordsOf (map_rows place about) (place w) (fst one_matrix) (snd one_matrix)) else tests in
      Nat.eqb (length (box ++ angles)) m && forallb (fun t => forallb (affine_in m fs) (test_places t)) tests &&
      match g with Some g => affine_in m fs (place g) | None => true end &&
      check_poses bits tape (params ++ tangents) tests m m (option_map place g) (box ++ angles) (map (fun _ => true) tests) t
  | _, _, _, _, _ => false
  end.

(** ** Soundness *)

Definition stands (x theta : list R) (k : motion) (P : vec) (Q : mat) (W r L : R) (row : list formula * formula) (l : strut) : Prop :=
  let (A, D) := row in
  (0 < Formula.value x theta D -> 0 < norm2 (strut_vector l P Q) /\
    exists q, q ^ 2 = W * Formula.value x theta D /\ forall v, Linear.dot (map (Formula.value x theta) A) v = q * Linear.dot (strut_row k L l P Q) v) /\
  Formula.value x theta D = W * r ^ 2 * norm2 (strut_vector l P Q) /\
  (Formula.value x theta D = 0 -> forall v, Linear.dot (map (Formula.value x theta) A) v = 0) /\ length A = dimension k.

Lemma all_rows_stand : forall s ts m, Forall2 is_strut ts m -> exists th, Forall2 scaled_within (flat_map (strut_layout s) ts) th /\
  forall x front back k P Q W L N w ell, 0 < W -> 0 < L -> (forall b, norm2 (mulv Q b) = norm2 b) ->
    val3 x (front ++ th ++ back) (eposition k) = vscale (/ two_to s) P -> valm x (front ++ th ++ back) N = mscale W Q ->
    Formula.value x (front ++ th ++ back) w = W -> Formula.value x (front ++ th ++ back) ell = / two_to s * L ->
    Forall2 (stands x (front ++ th ++ back) k P Q W (/ two_to s) L) (all_rows k N w ell s ts (length front)) m /\
    Forall2 (fun p l => is_lever x (front ++ th ++ back) k P Q W (/ two_to s) L l p) (all_levers k N w ell s ts (length front)) m /\
    (k = InSpace -> map (fun row => map (Formula.value x (front ++ th ++ back)) (fst row)) (origin_rows k N w ell s ts (length front)) =
      map (fun l => map (Rmult (W * / two_to s)) (about_origin (/ two_to s) l P Q)) m).
Proof.
  intros s. pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0.
  induction 1 as [| t l ts m [ha hb] hs [th2 [L2 R2]]]; [exists []; split; [constructor | intros; split; [constructor | split; [constructor | reflexivity]]] |].
  set (th1 := coordinates (vscale (/ two_to s) (strut_base l)) ++ coordinates (vscale (/ two_to s) (strut_joint l))).
  assert (L1 : Forall2 scaled_within (strut_layout s t) th1) by (apply Forall2_app; apply three_within; assumption).
  exists (th1 ++ th2). split; [cbn [flat_map]; apply Forall2_app; assumption |].
  intros x front back k P Q W L N w ell W0 L0 keeps hP hN hw hl. cbn [all_rows all_levers origin_rows]. cbv zeta.
  rewrite <- app_assoc in hP, hN, hw, hl. pose proof (numbered_values _ _ x front (th2 ++ back) L1) as V.
  assert (Own : forall i, val3 x (front ++ th1 ++ th2 ++ back) (vector_at (numbered (length front) (strut_layout s t)) i) = Vec (nth i th1 0) (nth (1 + i) th1 0) (nth (2 + i) th1 0)).
  { intro i. unfold val3, vector_at. cbn [ex ey ez]. rewrite <- !(map_nth (Formula.value x (front ++ th1 ++ th2 ++ back))), V. reflexivity. }
  specialize (R2 x (front ++ th1) back k P Q W L N w ell W0 L0 keeps). rewrite app_length, <- (related_length _ _ _ _ _ L1), <- !app_assoc in R2.
  destruct (R2 hP hN hw hl) as [I1 [I3 I2]]. rewrite <- !app_assoc. split; [| split].
  - constructor; [| exact I1]. apply (scaled_row_speed x (front ++ th1 ++ th2 ++ back) k P Q W (/ two_to s) L N _ _ w ell l); try assumption; rewrite Own; reflexivity.
  - constructor; [| exact I3]. apply (lever_values x (front ++ th1 ++ th2 ++ back) k P Q W (/ two_to s) L N); try assumption; rewrite Own; reflexivity.
  - intro hk. cbn [map]. f_equal; [| exact (I2 hk)]. apply (origin_row_values x (front ++ th1 ++ th2 ++ back) k P Q W (/ two_to s) L N); try assumption; rewrite Own; reflexivity.
Qed.

Lemma rows_speed : forall x theta k P Q W r L rows m, Forall2 (stands x theta k P Q W r L) rows m -> positive_D (map_rows (Formula.value x theta) rows) ->
  Forall (fun l => 0 < norm2 (strut_vector l P Q)) m /\
  forall v, energy (map_rows (Formula.value x theta) rows) v = W * Configuration.speed2 (map (fun l => strut_row k L l P Q) m) v.
Proof.
  intros x theta k P Q W r L. induction 1 as [| [A D] l rows m [h _] hs IH]; intro p; [split; [constructor | intro; cbn; ring] |].
  rewrite map_rows_cons in p. inversion p as [| ? ? p1 p2]. subst. destruct (IH p2) as [I1 I2]. destruct (h p1) as [h1 h2].
  split; [constructor; assumption |]. intro v. rewrite map_rows_cons. cbn [energy map]. unfold Configuration.speed2 in *. cbn [fold_right].
  destruct h2 as [q [q2 h2]]. cbn [snd] in p1. rewrite I2, h2, Rpow_mult_distr, q2. field. lra.
Qed.

(** Forces of the joints, scaled as rows are. *)
Lemma scaled_forces : forall x theta k P Q W r L rows m, 0 < W -> Forall2 (stands x theta k P Q W r L) rows m -> positive_D (map_rows (Formula.value x theta) rows) ->
  forall tau, length tau = length m -> exists u, length u = length rows /\
    (forall v, Linear.dot u (map (fun row => Linear.dot row v) (map fst (map_rows (Formula.value x theta) rows)))
      = Linear.dot tau (map (fun row => Linear.dot row v) (map (fun l => strut_row k L l P Q) m))) /\
    forall i, W * (nth i (map snd (map_rows (Formula.value x theta) rows)) 0 * nth i u 0 ^ 2) = nth i tau 0 ^ 2.
Proof.
  intros x theta k P Q W r L rows m W0. induction 1 as [| [A D] l rows m [h _] hs IH]; intros p [| t tau] e; try discriminate.
  - exists []. split; [reflexivity |]. split; [reflexivity |]. intros [| i]; cbn; ring.
  - rewrite map_rows_cons in p |- *. inversion p as [| ? ? p1 p2]. subst. cbn [snd] in p1. destruct (IH p2 tau ltac:(cbn in e; congruence)) as [u [lu [hu hi]]].
    destruct (h p1) as [_ [q [q2 hq]]]. pose proof (Rmult_lt_0_compat _ _ W0 p1) as wd. assert (qn : q <> 0) by (intros ->; rewrite <- q2 in wd; lra).
    exists (t / q :: u). split; [cbn; congruence |]. split.
    + intro v. cbn [map fst Linear.dot]. rewrite hu, hq. field. exact qn.
    + intros [| i]; cbn [map snd nth]; [| apply hi]. transitivity (W * Formula.value x theta D * (t / q) ^ 2); [ring |]. rewrite <- q2. field. exact qn.
Qed.

Lemma weighted_length : forall n M u, Forall (fun r : list R => length r = n) M -> length u = length M -> u <> [] -> length (weighted_sum u M) = n.
Proof.
  intro n. assert (C : forall t s a b, length (comb t s a b) = Nat.max (length a) (length b)).
  { unfold comb. intros t s. induction a as [| y a IH]; intros [| z b]; cbn [merge length]; rewrite ?map_length; try reflexivity. rewrite IH. reflexivity. }
  induction M as [| r M IH]; intros [| t u] h l ne; try discriminate; [contradiction |]. inversion h as [| ? ? h1 h2]; subst. cbn [weighted_sum]. rewrite C.
  destruct u as [| t' u]; [cbn [weighted_sum length]; lia |]. rewrite (IH (t' :: u) h2) by (try discriminate; cbn in *; congruence). lia.
Qed.

Lemma rows_grounded : forall x theta k P Q W r L rows m, 0 < W -> Forall2 (stands x theta k P Q W r L) rows m -> grounded (map_rows (Formula.value x theta) rows).
Proof.
  intros x theta k P Q W r L rows m W0. induction 1 as [| [A D] l rows m [_ [hd [hz _]]] hs IH]; [constructor |]. rewrite map_rows_cons. constructor; [| exact IH].
  cbn [fst snd]. split; [| exact hz]. rewrite hd. apply Rmult_le_pos; [apply Rmult_le_pos; [lra | apply pow2_ge_0] |]. unfold norm2.
  destruct (strut_vector l P Q) as [a b c]. cbn [vx vy vz]. pose proof (pow2_ge_0 a). pose proof (pow2_ge_0 b). pose proof (pow2_ge_0 c). lra.
Qed.

(** Where ends alone are looked at, it is of these rows. *)
Lemma least_tests : forall place ends rows levers w s ds j tests t r v e, all_some (pose_tests place ends rows levers w s j ds) = Some tests -> In t tests -> with_ends t = Some (r, v, e) ->
  e = O \/ e = ends /\ r = map_rows place rows /\ v = place w.
Proof.
  intros place ends rows levers w s. induction ds as [| d ds IH]; intros j tests t r v e h i we; cbn [pose_tests all_some] in h; [injection h as <-; contradiction |].
  destruct (pose_test place ends rows levers w s j d) as [u |] eqn:eu; [| discriminate]. destruct (all_some _) as [rest |] eqn:er; [| discriminate]. assert (E : tests = u :: rest) by congruence. subst tests.
  destruct i as [-> | i]; [| exact (IH (S j) rest t r v e er i we)].
  destruct d; cbn [pose_test] in eu; try discriminate; try (destruct (length_sign _ _ _ _ _); [cbn [option_map] in eu | discriminate]); try (destruct (nth_error _ _) as [[? ?] |]; [| discriminate]); try (destruct (lever_of _ _ _ _) as [[? ?] |]; [| discriminate]);
    try (destruct (certainly _ _ _ && _); [| discriminate]);
    try (destruct (enclose_parameter bits _); [cbn [option_map] in eu |]; try discriminate); injection eu as <-; cbn [with_ends] in we; try discriminate;
    injection we; intros; subst; auto.
Qed.

(** A demand's own test, bound and formulas. *)
Lemma demand_at : forall place ends rows levers w s ds j d, In d ds -> exists i, nth_error ds i = Some d /\
  In (pose_test place ends rows levers w s (j + i) d) (pose_tests place ends rows levers w s j ds) /\
  forall f, In f (own_formulas rows levers w s (j + i) d) -> In f (demand_formulas rows levers w s j ds).
Proof.
  intros place ends rows levers w s ds. induction ds as [| q ds IH]; intros j d i; [contradiction |]. destruct i as [-> | i].
  - exists O. rewrite Nat.add_0_r. split; [reflexivity |]. split; [left; reflexivity |]. intros f e. cbn [demand_formulas]. apply in_or_app. left. exact e.
  - destruct (IH (S j) d i) as [n [h1 [h2 h3]]]. exists (S n). rewrite <- Nat.add_succ_comm. split; [exact h1 |]. split; [right; exact h2 |].
    intros f e. cbn [demand_formulas]. apply in_or_app. right. exact (h3 f e).
Qed.

(** Rows with D times q. *)
Lemma stiff_energy : forall x theta rows s j d q v, Formula.value x theta (quantity (length_bound s d) j) = q -> 0 < q ->
  positive_D (map_rows (Formula.value x theta) (stiff_rows rows s j d)) ->
  positive_D (map_rows (Formula.value x theta) rows) /\
  energy (map_rows (Formula.value x theta) rows) v = q * energy (map_rows (Formula.value x theta) (stiff_rows rows s j d)) v.
Proof.
  intros x theta rows s j d q v hq q0. induction rows as [| [A D] rows IH]; intro p; [split; [constructor | cbn; ring] |].
  cbn [stiff_rows map fst snd] in p |- *. fold (stiff_rows rows s j d) in *. rewrite map_rows_cons in p |- *. rewrite map_rows_cons. inversion p as [| ? ? p1 p2]; subst.
  cbn [snd] in p1. rewrite value_times in p1. destruct (IH p2) as [I1 I2]. set (q := Formula.value x theta (quantity (length_bound s d) j)) in *.
  assert (D0 : 0 < Formula.value x theta D) by (apply Rmult_lt_reg_r with q; lra).
  split; [constructor; assumption |]. cbn [energy]. rewrite value_times, I2. fold q. field. split; lra.
Qed.

Lemma is_nothing_sound : forall t y, is_nothing t = true -> within t y -> y = 0.
Proof.
  intros t y h [l g]. apply andb_true_iff in h as [a b]. apply Number.same_sound in a, b. rewrite a in l. rewrite b in g. cbn in l, g. lra.
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

Lemma squared_in : forall x a, enclose_parameter bits (exactly x, 0%Z) = Some a -> contains bits (sqr bits a) (Claim.value x ^ 2).
Proof.
  intros x a e. apply sqr_sound, (enclose_parameter_sound bits _ _ _ e). exists (Claim.value x). unfold within, exactly. cbn [fst snd least greatest].
  split; [lra |]. change (two_to 0) with 1. field.
Qed.

Theorem check_turning_sound : forall c s t, check_turning c s t = true -> turning_holds c.
Proof.
  intros c s t h m P Q [hm hPQ]. unfold check_turning in h. cbv zeta in h. destruct (chart (turned c) (first_angle (motion_of c))) as [N w] eqn:ch.
  set (k := motion_of c) in *. set (ts := struts c) in *. set (ds := turning_demands c) in *. set (lay := flat_map (strut_layout s) ts) in *.
  set (pl := (exactly (characteristic_length c), s)) in *. set (j := length (lay ++ [pl])) in *. set (ell := quantity pl (length lay)) in *.
  set (rows := all_rows k N w ell s ts 0) in *. set (levers := all_levers k N w ell s ts 0) in *.
  set (g := curve (turned c) (first_angle k) (j + length ds)) in *. set (gs := match g with Some g => [g] | None => [] end) in *.
  set (about := if one_pose c then origin_rows k N w ell s ts 0 else []) in *.
  set (wanted := entries rows ++ w :: demand_formulas rows levers w s j ds ++ gs ++ entries about) in *.
  set (tape := fst (compile (map (image (dimension k)) wanted))) in *. set (place := fun f => Formula.place (formulas tape) (image (dimension k) f)) in *.
  apply andb_true_iff in h as [h C]. apply andb_true_iff in h as [h ang]. apply andb_true_iff in h as [h L0].
  apply andb_true_iff in h as [h flat]. apply andb_true_iff in h as [h quarter]. apply andb_true_iff in h as [h ex]. apply andb_true_iff in h as [found below_].
  destruct (all_some (map (enclose_parameter bits) _)) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map _ (position_tolerances _ _))) as [box |] eqn:eb; [| discriminate].
  destruct (all_some (map (end_box bits) _)) as [angles |] eqn:ea; [| discriminate].
  destruct (all_some (map (enclose_tangent bits) _)) as [tangents |] eqn:eg; [| discriminate].
  destruct (all_some (pose_tests _ _ _ _ _ _ _ _)) as [tests |] eqn:et; [| discriminate].
  cbv zeta in C. set (all_tests := if one_pose c then inserted _ _ _ else tests) in C.
  assert (Sub : forall u, In u tests -> In u all_tests) by (intros u iu; unfold all_tests; destruct (one_pose c); [apply inserted_in; right |]; exact iu).
  assert (Own : forall u, In u all_tests -> In u tests \/ with_ends u = None)
    by (intros u iu; unfold all_tests in iu; destruct (one_pose c); [apply inserted_in in iu as [-> | iu]; [right; reflexivity |] |]; left; exact iu).
  apply andb_true_iff in C as [C tree_ok]. apply andb_true_iff in C as [C gaff]. apply andb_true_iff in C as [len aff]. apply Nat.eqb_eq in len.
  apply positive_sound in L0. set (L := Claim.value (characteristic_length c)) in *.
  assert (ok : are_angles (turned c)).
  { unfold are_angles. rewrite forallb_forall in ang. apply Forall_forall. intros u iu. specialize (ang u iu). apply andb_true_iff in ang as [a b].
    split; apply (is_angle_number_sound bits); assumption. }
  destruct (all_rows_stand s ts m hm) as [th [TH RS]]. set (bs := map (fun d => Claim.value (least (fst (length_bound s d))) / two_to (snd (length_bound s d))) ds).
  set (tt := map (fun a => tangent (Claim.value a)) (curved (turned c))).
  set (theta := th ++ [/ two_to s * L] ++ bs ++ tt).
  assert (TL : Forall2 scaled_within (lay ++ [pl]) (th ++ [/ two_to s * L])).
  { apply Forall2_app; [exact TH |]. constructor; [| constructor]. exists L. split; [split; apply Rle_refl |]. cbn [snd pl]. unfold Rdiv. ring. }
  assert (TB : Forall2 scaled_within (map (length_bound s) ds) bs).
  { unfold bs. clear. induction ds as [| d l IH]; cbn [map]; constructor; [| exact IH]. eexists. split; [| reflexivity]. unfold within. destruct d; cbn; lra. }
  assert (TT : Forall2 (contains bits) tangents tt).
  { apply (tangents_in bits); [intros a i; exact (curved_angles _ a ok i) | exact eg]. }
  assert (T : Forall2 (contains bits) (params ++ tangents) theta).
  { unfold theta. rewrite !app_assoc. apply Forall2_app; [| exact TT]. apply (enclosed_all bits _ _ _ ep). apply Forall2_app; assumption. }
  assert (lb : length bs = length ds) by apply map_length.
  assert (lt : length th = length lay) by (symmetry; exact (related_length _ _ _ _ _ TH)).
  assert (tangent_at : forall a, In a (curved (turned c)) -> nth (j + length ds) theta 0 = tangent (Claim.value a)).
  { intros a i. unfold theta. rewrite !app_assoc. replace (j + length ds)%nat with (length ((th ++ [(/ two_to s * L)%R]) ++ bs) + 0)%nat
      by (unfold j; rewrite !app_length, lb, lt; cbn [length]; lia).
    rewrite app_nth2_plus. unfold tt. destruct (turned c); cbn [curved] in *; try contradiction; destruct i as [-> | []]; reflexivity. }
  (* at one pose *)
  enough (At : forall P Q, in_region (positions c) P /\ in_orientations (turned c) Q -> meets_turning c m P Q /\ (one_pose c = true ->
    exists u, rodrigues u = mscale (1 + norm2 u) Q /\ norm2 u < 1 /\
      forall v, length v = 6%nat -> nonzero v -> 0 < form (lower_weights (fst one_matrix) (snd one_matrix) v) (map (fun l => (about_origin (/ two_to s) l P Q, 0)) m) v)).
  { split; [exact (proj1 (At P Q hPQ)) |]. intros o P' Q' hP' hQ' same. destruct (proj2 (At P Q hPQ) o) as [u [u1 [u2 u3]]].
    destruct (proj2 (At P' Q' (conj hP' hQ')) o) as [v [v1 [v2 v3]]].
    apply (poses_differ (/ two_to s) (fst one_matrix) (snd one_matrix) m P Q u P' Q' v); try assumption. apply Rinv_neq_0_compat, Rgt_not_eq, two_to_pos. }
  clear P Q hPQ. intros P Q [hP hQ]. apply hull_sound in hP. destruct (chart_sound _ _ hQ ok) as [cs [W [hcs [W0 CH]]]].
  set (x := map (Rmult (/ two_to s)) (position_list k P) ++ cs).
  assert (X : Forall2 (contains bits) (box ++ angles) x) by (apply Forall2_app; [exact (position_boxes k _ P s box hP eb) | exact (box_sound bits _ cs angles ok hcs ea)]).
  assert (lx : length x = dimension k) by (rewrite <- (related_length _ _ _ _ _ X); exact len).
  assert (first : forall i, nth (first_angle k + i) x 0 = nth i cs 0).
  { intro i. unfold x. replace (first_angle k) with (length (map (Rmult (/ two_to s)) (position_list k P))) by (destruct k; reflexivity). apply app_nth2_plus. }
  destruct (CH x theta (first_angle k) (j + length ds)%nat first tangent_at) as [hN [hw hg]]. rewrite ch in hN, hw. cbn [fst snd] in hN, hw.
  assert (hl : Formula.value x theta ell = / two_to s * L).
  { unfold ell, theta. apply quantity_value; [exists L; split; [split; apply Rle_refl | cbn [snd pl]; unfold Rdiv; ring] |].
    rewrite <- lt. apply nth_middle. }
  pose proof (RS x [] ([/ two_to s * L] ++ bs ++ tt) k P Q W L N w ell W0 L0 (orientation_keeps _ _ hQ)
    (position_value k P _ cs _ (flat_position _ _ _ flat hP)) hN hw hl) as [ST [LV ORIGIN]].
  change (Forall2 (stands x theta k P Q W (/ two_to s) L) rows m) in ST.
  (* the tape *)
  rewrite forallb_forall in found, below_.
  assert (Found : forall f, In f wanted -> at_pairs theta (entry_at tape (place f)) (parabola x) = Formula.value x theta f).
  { intros f i. assert (E : entry_at tape (place f) = image (dimension k) f) by (apply Formula.same_sound, found, i).
    rewrite E, <- lx. apply image_value. rewrite lx. apply below_, i. }
  assert (RowsOf : forall r, (forall f, In f (entries r) -> In f wanted) ->
      map_rows (fun i => at_pairs theta (entry_at tape i) (parabola x)) (map_rows place r) = map_rows (Formula.value x theta) r).
  { induction r as [| [A D] r IH]; intro i; [reflexivity |]. rewrite !map_rows_cons. f_equal.
      - f_equal; [rewrite map_map; apply map_ext_in; intros f q; apply Found, i; cbn [entries flat_map fst]; apply in_or_app; left; apply in_or_app; left; exact q |].
        apply Found, i. cbn [entries flat_map snd]. apply in_or_app. left. apply in_or_app. right. left. reflexivity.
      - apply IH. intros f q. apply i. cbn [entries flat_map]. apply in_or_app. right. exact q. }
  assert (Rows : map_rows (fun i => at_pairs theta (entry_at tape i) (parabola x)) (map_rows place rows) = map_rows (Formula.value x theta) rows)
    by (apply RowsOf; intros f q; apply in_or_app; left; exact q).
  assert (Weight : at_pairs theta (entry_at tape (place w)) (parabola x) = W) by (rewrite Found; [exact hw | apply in_or_app; right; left; reflexivity]).
  rewrite forallb_forall in aff.
  assert (gaff' : forall i, option_map place g = Some i -> is_affine_at tape (dimension k) i = true)
    by (intros i e; destruct g as [f |]; [injection e as <-; exact gaff | discriminate]).
  set (ends := match positions c with Box _ => _ | _ => _ end) in *.
  assert (eased : forall u r v e, In u all_tests -> with_ends u = Some (r, v, e) -> e = O \/ length r = dimension k /\ is_eased tape (dimension k) e r v None = true /\
    forall i n places, option_map place g = Some i -> is_eased tape (dimension k) e r v (Some (i, n, places)) = true).
  { intros u r v e0 i we. destruct (Own u i) as [i1 | no]; [| congruence]. destruct (least_tests _ _ _ _ _ _ _ _ _ _ _ _ _ et i1 we) as [-> | [-> [-> ->]]]; [left; reflexivity |].
    unfold ends, ends_of. cbv zeta. destruct (positions c); [| left; reflexivity]. destruct (Nat.eqb _ _ && _) eqn:e; [right | left; reflexivity]. apply andb_true_iff in e as [e1 e2]. apply Nat.eqb_eq in e1.
    split; [exact e1 |]. clear - e2. destruct g as [f |]; cbn [option_map] in *.
    - split; [| intros i n places e; injection e as <-; exact e2]. unfold is_eased, eased_in in *. cbv zeta in *. rewrite forallb_forall in *. intros y iy. specialize (e2 y iy).
      apply andb_true_iff in e2 as [e2 _]. apply andb_true_iff. split; [exact e2 | reflexivity].
    - split; [exact e2 | discriminate]. }
  assert (turn : is_turned tape all_tests (option_map place g) theta x).
  { split; [| intros u r v e i we; destruct (Own u i) as [i1 | no]; [| congruence]; destruct (least_tests _ _ _ _ _ _ _ _ _ _ _ _ _ et i1 we) as [-> | [-> [-> ->]]]; [left; reflexivity | right]; split;
      [rewrite Rows; exact (rows_grounded x theta k P Q W _ L rows m W0 ST) | rewrite Weight; exact W0]].
    intros i e. destruct g as [f |] eqn:eg'; [| discriminate]. injection e as <-. rewrite Found; [apply hg; exact eg' |].
    apply in_or_app. right. right. apply in_or_app. right. left. reflexivity. }
  pose proof (check_poses_sound bits tape (params ++ tangents) all_tests (dimension k) (dimension k) (option_map place g) theta T aff gaff' eased t _ x _ tree_ok X len turn ltac:(apply none_done)) as HT0.
  pose proof (fun u iu => HT0 u (Sub u iu)) as HT.
  assert (Speed : positive_D (map_rows (Formula.value x theta) rows) -> Forall (fun l => 0 < norm2 (strut_vector l P Q)) m /\
    forall v, energy (map_rows (Formula.value x theta) rows) v = W * Configuration.speed2 (map (fun l => strut_row k L l P Q) m) v)
    by (apply (rows_speed x theta k P Q W (/ two_to s) L); exact ST).
  assert (Z : forall v, ~ nonzero v -> Linear.dot v v = 0 /\ Configuration.speed2 (map (fun l => strut_row k L l P Q) m) v = 0).
  { intros v z. pose proof (zero_vector v ltac:(apply Rnot_lt_le; exact z)) as F0. split; [apply dot_zero, F0 |].
    generalize (map (fun l => strut_row k L l P Q) m). intro M. unfold Configuration.speed2. induction M as [| row M IH]; cbn [fold_right]; [reflexivity |]. rewrite IH, (dot_zero v row F0). ring. }
  assert (NZ : forall v, nonzero v \/ ~ nonzero v) by (intro v; destruct (Rlt_dec 0 (Linear.dot v v)); auto).
  set (conf := struts_at k L m P Q).
  assert (Lower : forall low kappa, contains bits low kappa -> 0 <= kappa -> In (LeastOf (map_rows place rows) (place w) low ends) tests ->
    Forall (fun l => 0 < norm2 (strut_vector l P Q)) m /\ positive_D (map_rows (Formula.value x theta) rows) /\
    forall v, length v = dimension k -> nonzero v -> kappa * Linear.dot v v < Configuration.speed2 (jacobian conf) v).
  { intros low kappa hk k0 it. pose proof (HT _ it) as H. cbn [test_holds] in H.
    assert (PD : positive_D (map_rows (Formula.value x theta) rows)).
    { assert (U : exists v, length v = dimension k /\ nonzero v) by (exists (repeat 1 (dimension k)); destruct k; (split; [reflexivity | unfold nonzero; cbn; lra])).
      destruct U as [v [lv nv]]. destruct (H kappa v hk k0 lv nv) as [p _]. rewrite Rows in p. exact p. }
    destruct (Speed PD) as [R1 R2]. split; [exact R1 |]. split; [exact PD |]. intros v lv nv. destruct (H kappa v hk k0 lv nv) as [_ q]. rewrite Rows, Weight, R2 in q.
    apply Rmult_lt_reg_l with W; [exact W0 |]. cbn [jacobian conf struts_at]. unfold conf, struts_at. cbn [jacobian]. lra. }
  assert (Test : forall d, In d ds -> exists i u, nth_error ds i = Some d /\ pose_test place ends rows levers w s (j + i) d = Some u /\ In u tests /\
    forall f, In f (own_formulas rows levers w s (j + i) d) -> In f wanted).
  { intros d id. destruct (demand_at place ends rows levers w s ds j d id) as [i [h1 [h2 h3]]]. destruct (all_some_in _ _ _ _ et h2) as [u [e iu]].
    exists i, u. split; [exact h1 |]. split; [exact e |]. split; [exact iu |]. intros f q. apply in_or_app. right. right. apply in_or_app. left. exact (h3 f q). }
  assert (Reach : exists low kappa, contains bits low kappa /\ 0 <= kappa /\ In (LeastOf (map_rows place rows) (place w) low ends) tests).
  { apply existsb_exists in ex as [d [id e]]. destruct (Test d id) as [i [u [_ [pu [iu _]]]]]. destruct d; try discriminate; cbn [pose_test] in pu.
    - injection pu as <-. exists zero, 0. split; [apply zero_sound |]. split; [lra | exact iu].
    - destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-. eexists; eexists. split; [apply squared_in, e1 |].
      split; [apply pow2_ge_0 | exact iu]. }
  destruct Reach as [low [kappa [hk [k0 it]]]]. destruct (Lower low kappa hk k0 it) as [reach_ [PDR low_]].
  assert (INJ : Configuration.injective (dimension k) conf).
  { intros v lv nv. specialize (low_ v lv nv). unfold nonzero in nv. assert (0 <= kappa * Linear.dot v v) by (apply Rmult_le_pos; lra). lra. }
  split.
  2: { intro o. rewrite o in quarter. cbn [negb orb] in quarter. unfold is_less_than_quarter in quarter.
    destruct k eqn:ek; try discriminate. destruct (turned c) as [| | a |] eqn:et'; try discriminate. apply positive_sound in quarter. cbn [Claim.value] in quarter.
    cbn [chart] in ch. injection ch as chN chw. set (u' := EVec (F (Coord (first_angle InSpace + 0))) (F (Coord (first_angle InSpace + 1))) (F (Coord (first_angle InSpace + 2)))) in *.
    set (u := val3 x theta u'). assert (EW : W = 1 + norm2 u).
    { rewrite <- hw, <- chw, value_plus, value_dot. fold u. rewrite <- norm2_dot. reflexivity. }
    exists u. rewrite <- EW. split; [rewrite <- hN, <- chN, valm_rodrigues; reflexivity |]. split.
    - pose proof (hg _ eq_refl) as G. rewrite value_minus, Formula.value_square, value_dot, <- norm2_dot in G. change (val3 x theta (EVec _ _ _)) with u in G.
      specialize (tangent_at a (or_introl eq_refl)). cbn [Formula.value map_op real_op] in G. rewrite tangent_at in G.
      destruct hQ as [e [b [_ [ab _]]]]. inversion ok as [| ? ? [_ ia] _]; subst. cbn [either_way greatest] in ia. destruct (tangent_is _ ia) as [CO _].
      assert (CP : 0 < cos (in_degrees (Claim.value a))) by (pose proof PI_RGT_0; apply cos_gt_0; unfold in_degrees; nra).
      set (t2 := tangent (Claim.value a) ^ 2) in *. assert (t0 : 0 <= t2) by apply pow2_ge_0. rewrite CO in CP.
      enough (t2 < 1) by lra. apply Rnot_le_lt. intro n. assert ((1 - t2) / (1 + t2) <= 0); [| lra].
      unfold Rdiv. rewrite <- (Rmult_0_l (/ (1 + t2))). apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; lra | lra].
    - intros v lv nz. assert (IA : In (ChordsOf (map_rows place about) (place w) (fst one_matrix) (snd one_matrix)) all_tests)
        by (unfold all_tests; rewrite o; apply inserted_in; left; reflexivity).
      pose proof (HT0 _ IA) as K. cbn [test_holds] in K. specialize (K v lv nz).
      rewrite RowsOf in K by (intros f i; apply in_or_app; right; right; do 2 (apply in_or_app; right); exact i).
      specialize (ORIGIN eq_refl). assert (EA : map (fun p => (fst p, 0)) (map_rows (Formula.value x theta) about) =
        map (fun l => (map (Rmult (W * / two_to s)) (about_origin (/ two_to s) l P Q), 0)) m).
      { unfold map_rows. rewrite map_map. cbn [fst]. unfold about. rewrite o.
        rewrite <- (map_map (fun l => map (Rmult (W * / two_to s)) (about_origin (/ two_to s) l P Q)) (fun A => (A, 0))), <- (map_map (fun p => map (Formula.value x theta) (fst p)) (fun A => (A, 0))).
        f_equal. exact ORIGIN. }
      rewrite EA in K. set (q := W * / two_to s) in *. assert (q0 : 0 < q) by (apply Rmult_lt_0_compat; [exact W0 | apply Rinv_0_lt_compat, two_to_pos]).
      apply Rmult_lt_reg_l with q; [exact q0 |]. rewrite Rmult_0_r. match type of K with 0 < ?y => replace (q * _) with y; [exact K |] end.
      clear. generalize (lower_weights (fst one_matrix) (snd one_matrix) v). induction m as [| l m' IH]; intros [| [y z] ws]; cbn [map form]; try ring.
      rewrite IH, dot_map. ring. }
  unfold meets_turning. fold k L ds conf. split; [exact reach_ |]. split; [exact INJ |]. apply Forall_forall. intros d id.
  destruct (Test d id) as [i [u [nd [pu [iu signs]]]]].
  assert (Bound : forall b z, length_bound s d = (exactly b, z) -> Formula.value x theta (quantity (length_bound s d) (j + i)) = / two_to z * Claim.value b).
  { intros b z e. apply quantity_value; [rewrite e; exists (Claim.value b); split; [split; apply Rle_refl | cbn [snd]; unfold Rdiv; ring] |].
    unfold theta. rewrite (app_assoc th). replace j with (length (th ++ [/ two_to s * L])) by (unfold j; rewrite !app_length; cbn [length]; lia).
    rewrite app_nth2_plus, app_nth1 by (rewrite lb; apply nth_error_Some; congruence). unfold bs. apply nth_error_nth. rewrite nth_error_map, nd. cbn [option_map]. rewrite e. cbn. f_equal. unfold Rdiv. ring. }
  assert (Ratio : forall b b', length_bound s d = (exactly (Over b b'), 0%Z) -> Formula.value x theta (quantity (length_bound s d) (j + i)) = Claim.value b / Claim.value b')
    by (intros b b' e; rewrite (Bound _ _ e); change (two_to 0) with 1; rewrite Rinv_1; apply Rmult_1_l).
  pose proof (Rinv_0_lt_compat _ (two_to_pos s)) as r0. set (ratio := / two_to s) in *.
  assert (LegOf : forall n row, nth_error rows n = Some row -> exists l, nth_error m n = Some l /\ stands x theta k P Q W ratio L row l).
  { clear - ST. intros n row. revert n. induction ST as [| row' l rows' m' hd hs IH]; intros [| n] e; try discriminate; cbn [nth_error] in *.
    - injection e as ->. exists l. split; [reflexivity | exact hd].
    - exact (IH n e). }
  assert (LeverOf_ : forall n p, nth_error levers n = Some p -> exists l, nth_error m n = Some l /\ is_lever x theta k P Q W ratio L l p).
  { clear - LV. intros n p. revert n. change (Forall2 (fun p l => is_lever x theta k P Q W ratio L l p) levers m) in LV. induction LV as [| p' l levers' m' hd hs IH]; intros [| n] e; try discriminate; cbn [nth_error] in *.
    - injection e as ->. exists l. split; [reflexivity | exact hd].
    - exact (IH n e). }
  assert (Leg : forall n A D, nth_error rows n = Some (A, D) -> exists l, nth_error m n = Some l /\ Formula.value x theta D = W * ratio ^ 2 * norm2 (strut_vector l P Q)).
  { intros n A D e. destruct (LegOf n _ e) as [l [e' [_ [hd _]]]]. exists l. split; [exact e' | exact hd]. }
  assert (Joint : forall n l, nth_error m n = Some l -> nth_error (joints conf) n = Some (Length (strut_length l P Q)))
    by (intros n l e; unfold conf, struts_at; cbn [joints]; rewrite nth_error_map, e; reflexivity).
  pose proof (pow_lt ratio 2 r0) as r2. pose proof (Rmult_lt_0_compat _ _ W0 r2) as wr.
  destruct d as [| b | b | n b | n b | n b b' | b | n b b' | n b b' | b b' | n b b' | n b | n b | b]; cbn [pose_test] in pu; try discriminate; cbn [Configuration.fulfils].
  4-5: cbn [own_formulas length_sign] in *; destruct (nth_error rows n) as [[A D] |] eqn:nr; [| discriminate]; destruct (certainly bits false b) eqn:b0; [| discriminate];
    cbn [option_map] in pu; injection pu as <-; apply nonneg_sound in b0; destruct (Leg n A D nr) as [l [nl vD]];
    pose proof (HT _ iu) as H; cbn [test_holds] in H; pose proof (Found _ (signs _ (or_introl eq_refl))) as FF;
    match type of FF with _ = ?v => assert (G : 0 <= v) by (rewrite <- FF; exact H) end; clear H FF; rename G into H;
    rewrite value_minus, value_times, Formula.value_square, (Bound b s eq_refl), vD in H; fold ratio in H; rewrite hw in H;
    exists (strut_length l P Q); (split; [exact (Joint n l nl) |]); unfold strut_length; rewrite <- (sqrt_pow2 (Claim.value b) b0); apply sqrt_le_1_alt;
    apply Rmult_le_reg_l with (W * ratio ^ 2); [exact wr |]; rewrite Rpow_mult_distr in H; lra.
  - exact INJ.
  - destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-. pose proof (squared_in _ _ e1) as K.
    cbn [Claim.value] in K. replace (1 / 1) with 1 in K by field. destruct (Lower _ _ K (pow2_ge_0 _) iu) as [_ [_ G]]. intros v lv.
    destruct (NZ v) as [nz | z]; [apply Rlt_le, G; assumption | destruct (Z v z) as [-> q]; unfold conf, struts_at; cbn [jacobian]; rewrite q; lra].
  - destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-. pose proof (squared_in _ _ e1) as K.
    cbn [Claim.value] in K. replace (1 / 1) with 1 in K by field. pose proof (HT _ iu) as H. cbn [test_holds] in H. intros v lv.
    unfold conf, struts_at. cbn [jacobian]. destruct (NZ v) as [nz | z]; [| destruct (Z v z) as [-> ->]; lra].
    destruct (H _ v K lv nz) as [p q]. rewrite Rows in p, q. rewrite Weight, (proj2 (Speed p)) in q. apply Rlt_le, Rmult_lt_reg_l with W; [exact W0 | lra].
  - destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-. pose proof (squared_in _ _ e1) as K.
    pose proof (HT _ iu) as H. cbn [test_holds] in H. intros u v lu lv. unfold conf, struts_at. cbn [jacobian].
    destruct (NZ u) as [nu | z]; [| destruct (Z u z) as [-> ->]; lra]. destruct (NZ v) as [nv | z]; [| destruct (Z v z) as [-> ->]; lra].
    destruct (H _ u v K (pow2_ge_0 _) lu lv nu nv) as [p q]. rewrite Rows in p, q. rewrite !(proj2 (Speed p)) in q.
    apply Rlt_le, Rmult_lt_reg_l with W; [exact W0 | lra].
  - destruct (nth_error rows n) as [[A D] |] eqn:nr; [| discriminate]. cbn [own_formulas lever_of length_bound] in *.
    destruct (nth_error levers n) as [[f bound] |] eqn:nv; [| discriminate]. cbn [option_map fst snd] in *.
    destruct (certainly bits true b && certainly bits true b') eqn:ce; [| discriminate].
    apply andb_true_iff in ce as [t0 b0]. apply positive_sound in t0, b0. injection pu as <-. pose proof (HT _ iu) as H. cbn [test_holds] in H. destruct H as [p q].
    destruct (Leg n A D nr) as [l [nl vD]]. exists (strut_row k L l P Q). split; [unfold conf, struts_at; cbn [jacobian]; rewrite nth_error_map, nl; reflexivity |].
    destruct (LeverOf_ n _ nv) as [l' [nl' [vf vb]]]. assert (l' = l) by congruence. subst l'. cbn [fst snd] in vf, vb. set (k2 := quantity (exactly (Over b' b), 0%Z) (j + i)) in *.
    specialize (vb k2). rewrite (Ratio b' b eq_refl : Formula.value x theta k2 = _) in vb.
    rewrite map_rows_cons in p, q. cbn [map_rows map fst snd energy Linear.dot] in p, q. apply Forall_inv in p. cbn [snd] in p.
    assert (iD : In D wanted) by (apply in_or_app; left; apply in_flat_map; exists (A, D); split; [exact (nth_error_In _ _ nr) | apply in_or_app; right; left; reflexivity]).
    rewrite (Found D iD) in p, q. rewrite (Found f (signs f (or_introl eq_refl))), (Found (bound k2) (signs _ (or_intror (or_introl eq_refl)))) in q. rewrite vD in p, q. rewrite vf, vb in q.
    set (y := Claim.value b') in *. set (tool := Claim.value b) in *. set (n2 := norm2 (strut_vector l P Q)) in *. set (along := Vec3.dot (arm_of_joint l Q) (strut_vector l P Q)) in *.
    assert (n0 : 0 < n2) by (apply Rmult_lt_reg_l with (W * ratio ^ 2); lra).
    assert (R : Linear.dot (strut_row k L l P Q) (strut_row k L l P Q) <= (y / tool) ^ 2).
    { apply (lever_bounds k P Q L l L0 (orientation_keeps _ _ hQ)); [exact n0 |]. fold along. fold n2. apply Rmult_lt_reg_l with (W * ratio ^ 2); [exact wr |].
      replace (W * ratio ^ 2 * (along ^ 2 / n2)) with ((W * ratio ^ 2 * along * 1 + 0) ^ 2 / (W * ratio ^ 2 * n2) + 0) by (field; split; [lra | split; lra]). exact q. }
    intros v lv le. apply Rabs_le. enough (Q2 : Linear.dot (strut_row k L l P Q) v ^ 2 <= y ^ 2) by (split; nra).
    pose proof (Solve.dot_cauchy (strut_row k L l P Q) v) as CS. pose proof (Linear.dot_self v). pose proof (pow2_ge_0 (y / tool)).
    assert ((y / tool) ^ 2 * tool ^ 2 = y ^ 2) by (field; lra). nra.
  - destruct (nth_error rows n) as [row |] eqn:nr; [| discriminate]. destruct (certainly bits true b && certainly bits true b') eqn:ce; [| discriminate].
    apply andb_true_iff in ce as [t0 b0]. apply positive_sound in t0, b0. destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-.
    pose proof (squared_in _ _ e1) as K. cbn [Claim.value] in K. pose proof (HT _ iu) as H. cbn [test_holds] in H. rewrite Rows, Weight in H.
    unfold conf, struts_at. cbn [jacobian]. intros tau F [lt' [lF hF]] le. rewrite map_length in lt'.
    destruct (scaled_forces x theta k P Q W ratio L rows m W0 ST PDR tau lt') as [u [lu [hu hi]]]. set (As := map fst (map_rows (Formula.value x theta) rows)) in *.
    set (p := weighted_sum u As) in *. specialize (hi n). set (du := nth n (map snd _) 0 * nth n u 0 ^ 2) in *. set (tool := Claim.value b) in *. set (y := Claim.value b') in *.
    enough (Q2 : nth n tau 0 ^ 2 <= y ^ 2) by (apply Rabs_le; split; nra).
    destruct (NZ u) as [nz | z].
    + assert (LA : Forall (fun row => length row = dimension k) As).
      { unfold As. clear - ST. induction ST as [| [A D] l rows' m' [_ [_ [_ hl]]] hs IH]; [constructor |]. rewrite map_rows_cons. cbn [map fst]. constructor; [rewrite map_length; exact hl | exact IH]. }
      assert (lp : length p = dimension k).
      { apply weighted_length; [exact LA | unfold As, map_rows; rewrite !map_length; exact lu |]. intros ->. unfold nonzero in nz. cbn in nz. lra. }
      assert (pv : forall v, Linear.dot p v = Linear.dot tau (map (fun row => Linear.dot row v) (map (fun l => strut_row k L l P Q) m)))
        by (intro v; unfold p; rewrite dot_weighted; apply hu).
      assert (pp : Linear.dot p p = Linear.dot F F).
      { rewrite (pv p), <- (hF p lp), dot_commutes, (pv F). symmetry. apply hF, lF. }
      specialize (H ((tool / y) ^ 2) u K (pow2_ge_0 _) W0 ltac:(unfold map_rows; rewrite map_length; exact lu) nz). cbv zeta in H. fold p in H. fold du in H. rewrite pp in H.
      assert ((tool / y) ^ 2 * nth n tau 0 ^ 2 < tool ^ 2) by (rewrite <- hi; set (c2 := (tool / y) ^ 2) in *; clearbody c2; lra).
      assert (E : (tool / y) ^ 2 * nth n tau 0 ^ 2 = tool ^ 2 * (nth n tau 0 / y) ^ 2) by (field; lra).
      assert (t2 : 0 < tool ^ 2) by (apply pow_lt; exact t0). assert ((nth n tau 0 / y) ^ 2 < 1) by (apply Rmult_lt_reg_l with (tool ^ 2); lra).
      replace (nth n tau 0 ^ 2) with ((nth n tau 0 / y) ^ 2 * y ^ 2) by (field; lra). pose proof (pow2_ge_0 y). nra.
    + pose proof (zero_vector u ltac:(apply Rnot_lt_le; exact z)) as Z0. assert (un : nth n u 0 = 0).
      { destruct (nth_in_or_default n u 0) as [i' | e']; [| exact e']. rewrite Forall_forall in Z0. symmetry. exact (Z0 _ i'). }
      rewrite <- hi. unfold du. rewrite un. pose proof (pow2_ge_0 y). lra.
  - destruct (certainly bits true b && certainly bits true b') eqn:ce; [| discriminate]. apply andb_true_iff in ce as [k0' b0]. apply positive_sound in k0', b0.
    injection pu as <-. pose proof (HT _ iu) as H. cbn [test_holds] in H. cbn [own_formulas] in signs. intros v lv.
    pose proof (Ratio b' b eq_refl) as Number.
    assert (q0 : 0 < Claim.value b' / Claim.value b) by (apply Rdiv_lt_0_compat; assumption).
    destruct (NZ v) as [nz | z]; [| destruct (Z v z) as [-> q]; unfold conf, struts_at; cbn [jacobian]; rewrite q; lra].
    destruct (H 1 v (Fixed.integer_sound bits 1) ltac:(lra) lv nz) as [p q].
    rewrite RowsOf in p, q by (intros f i'; apply in_flat_map in i' as [[A D] [i1 i2]]; apply in_app_or in i2 as [i2 | [<- | []]];
      [apply in_map_iff in i1 as [[A' D'] [e1 i1]]; injection e1 as <- <-; apply in_or_app; left; apply in_flat_map; exists (A', D'); split; [exact i1 | apply in_or_app; left; exact i2]
      | apply signs, in_map_iff; exists (A, D); split; [reflexivity | exact i1]]).
    destruct (stiff_energy x theta rows s (j + i) _ _ v Number q0 p) as [p' E]. rewrite (proj2 (Speed p')) in E. rewrite Weight in q.
    unfold conf, struts_at. cbn [jacobian]. set (S2 := Configuration.speed2 _ v) in *. set (y := Claim.value b') in *. set (e := Claim.value b) in *.
    assert (y / e * (W * Linear.dot v v) < W * S2) by (rewrite E; apply Rmult_lt_compat_l; [exact q0 | lra]).
    assert (y / e * Linear.dot v v < S2) by (apply Rmult_lt_reg_l with W; lra).
    replace (y * Linear.dot v v) with (e * (y / e * Linear.dot v v)) by (field; lra). apply Rmult_le_compat_l; lra.
Qed.
End Precision.

(** ** Claims that are about something *)

Definition is_met (exact : positive) (t : tolerance) : bool := below exact (least t) (greatest t).
Definition are_met (exact : positive) (t : tolerances) : bool := is_met exact (tx t) && is_met exact (ty t) && is_met exact (tz t).
Definition certify_turning (exact bits : positive) (one_matrix : N * list (list Z)) (one_place : nat) (c : turning_claim) (s : Z) (t : tree) : bool :=
  forallb (fun t => are_met exact (fst t) && are_met exact (snd t)) (struts c) && is_in exact (positions c) (some_point (positions c)) &&
  forallb (is_met exact) (angles_of (turned c)) && check_turning bits one_matrix one_place c s t.

Lemma least_within : forall exact t, is_met exact t = true -> within t (Claim.value (least t)).
Proof. intros exact t h. apply below_sound in h. split; [apply Rle_refl | exact h]. Qed.
Lemma either_met : forall exact x, is_met exact (either_way x) = true -> 0 <= 0 <= Claim.value x.
Proof. intros exact x h. apply below_sound in h. cbn [either_way least greatest Claim.value] in h. lra. Qed.
Definition leasts_of (t : tolerances) : vec := Vec (Claim.value (least (tx t))) (Claim.value (least (ty t))) (Claim.value (least (tz t))).
Lemma leasts_within : forall exact t, are_met exact t = true -> all_within t (leasts_of t).
Proof.
  intros exact t h. apply andb_true_iff in h as [h z]. apply andb_true_iff in h as [x y].
  split; [| split]; apply (least_within exact); assumption.
Qed.

Lemma some_orientation : forall exact o, forallb (is_met exact) (angles_of o) = true -> exists Q, in_orientations o Q.
Proof.
  intros exact o' o. rewrite forallb_forall in o. destruct o' as [a | r q y | m | m n]; cbn [angles_of in_orientations] in *.
  - eexists. exists (Claim.value (least a)). split; [apply (least_within exact), o; left; reflexivity | reflexivity].
  - eexists. exists (Claim.value (least r)), (Claim.value (least q)), (Claim.value (least y)).
    split; [apply (least_within exact), o; left; reflexivity |]. split; [apply (least_within exact), o; right; left; reflexivity |].
    split; [apply (least_within exact), o; right; right; left; reflexivity | reflexivity].
  - destruct (either_met exact m (o _ (or_introl eq_refl))) as [z0 z1]. eexists. exists e1, 0. split; [unfold norm2; cbn; ring | split; [exact (conj z0 z1) | reflexivity]].
  - pose proof (either_met exact m (o _ (or_introl eq_refl))) as hm. pose proof (either_met exact n (o _ (or_intror (or_introl eq_refl)))) as hn.
    eexists. exists 0, 0, 0. split; [exact hm | split; [lra | reflexivity]].
Qed.

Theorem certify_turning_sound : forall exact bits one_matrix one_place c s t, certify_turning exact bits one_matrix one_place c s t = true ->
  turning_holds c /\ exists m P Q, is_about_struts c m P Q.
Proof.
  intros exact bits one_matrix one_place c s t h. apply andb_true_iff in h as [h k]. apply andb_true_iff in h as [h o]. apply andb_true_iff in h as [l p].
  split; [exact (check_turning_sound bits one_matrix one_place c s t k) |].
  pose proof (some_orientation exact _ o) as T.
  destruct T as [Q hQ]. exists (map (fun t => Strut (leasts_of (fst t)) (leasts_of (snd t))) (struts c)), (values (some_point (positions c))), Q.
  split; [| split; [exact (is_in_sound exact _ _ p) | exact hQ]]. rewrite forallb_forall in l.
  induction (struts c) as [| u ts IH]; cbn [map]; constructor; [| apply IH; intros v i; apply l; right; exact i].
  specialize (l u (or_introl eq_refl)). apply andb_true_iff in l as [a b]. split; apply (leasts_within exact); assumption.
Qed.
End Named.
