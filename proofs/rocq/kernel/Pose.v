(** * Platforms that turn: formulas, and certified claims

    With the coordinates of orientation c, R = N/w, and w A and w D of a strut are
    polynomials (motion.rs): tests at control points, a bisection tree. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert.kernel Require Import Linear Twofold Configuration.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Slope Test Cell Check Number Trig Formula Machine Problem Witness Inputs Orientation Turning Poses Control Varied Chart Bend OnePose Onward.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Tests *)

Inductive pose_test :=
  (* sigma_min^2 > k w; of the first [e] coordinates, ends alone *)
  | LeastOf (r : rows nat) (w : nat) (kappa2 : fixed) (e : nat)
  (* sigma_max^2 < k w *)
  | GreatestOf (r : rows nat) (w : nat) (k2 : fixed)
  (* |M u|^2 |v|^2 < c^2 |M v|^2 |u|^2 *)
  | ConditionOf (r : rows nat) (w : nat) (c2 : fixed)
  (* |A^T u|^2 > k w D_i u_i^2: a column of the inverse *)
  | SolveOf (i : nat) (r : rows nat) (w : nat) (k2 : fixed) (e : nat)
  | SignOf (f : nat)
  (* (A . u)^2 > w D |u|^2 of one row of one entry *)
  | LeverOf (r : rows nat) (w : nat)
  (* (A . u)^2 < w D |u|^2 of one row of three entries *)
  | AxisOf (r : rows nat) (w : nat)
  (* Y^T A + A^T Y > 0, with one Y for all cells *)
  | ChordsOf (r : rows nat) (w : nat) (places : N) (Y : list (list Z))
  (* as many joints as coordinates, and the pose that these are off by *)
  | NearOf (a : near_test)
  (* of formulas that are no polynomials, by their slopes *)
  | OnSlopes (t : test).

Definition test_places (t : pose_test) : list nat :=
  match t with
  | LeastOf r w _ _ | GreatestOf r w _ | SolveOf _ r w _ _ | ConditionOf r w _ | ChordsOf r w _ _ | LeverOf r w | AxisOf r w => w :: all_places r
  | SignOf f => [f]
  | NearOf a => n_weight a :: all_places (n_rows a)
  | OnSlopes _ => []
  end.

(** ** The tree *)

Section Tree.
Variable bits : positive.
(** Of polynomials, with squares of coordinates as coordinates, and of other formulas. *)
Variables tape plain : list (op address).
Variable params : list fixed.
Variable tests : list pose_test.
Variables m n : nat.
(** Where it is curved, what is not negative at the orientations. *)
Variable g : option nat.
(** Rows and their factor, of whose least singular value something is shown of a cell with tolerances apart. *)
Variables (main : rows nat) (main_w : nat) (varied : list fixed -> fixed -> nat -> evidence -> bool).

Definition shows_less (cell : list fixed) (values : list (option slope)) (ts : list tensor) (l : multiple) (t : pose_test) (e : evidence) : bool :=
  let at_all e good r w := everywhere (@map_sample) e m good (map_sample (fun i => nth i ts (Constant None)) (sample_of r w l)) in
  match t, e with
  | LeastOf r w k ends, ByLower places Y => at_all ends (lower_at bits n places Y k) r w
  | LeastOf r w k ends, ByRank places Y => (lo k =? 0)%Z && (hi k =? 0)%Z && at_all ends (rank_at bits n places Y) r w
  | SolveOf i r w k ends, ByLower places Y => at_all ends (solve_at bits n i places Y k) r w
  | GreatestOf r w k, ByTest => at_all 0%nat (upper_at bits n k) r w
  | ConditionOf r w c2, ByConditioning places Y (mu :: mus) =>
      Nat.eqb (length mus) m && everywhere_by (@map_sample) (conditioned_at bits n c2 places Y mu) 0 mus 0 (map_sample (fun i => nth i ts (Constant None)) (sample_of r w l))
  | ChordsOf r w places Y, ByChords => at_all 0%nat (rank_at bits n places Y) r w
  | SignOf f, ByTest => at_all 0%nat sign_at [] f
  | LeverOf r w, ByLower places [[y]] => at_all 0%nat (lower_at bits 1 places [[y]] (Fixed.integer bits 1)) r w
  | AxisOf r w, ByTest => at_all 0%nat (upper_at bits 3 (Fixed.integer bits 1)) r w
  | NearOf a, ByAccuracy places Y kappa q => shows_pose bits plain params cell values ts m a l places Y kappa q
  | _, _ => false
  end.
Definition same_row : forall p q : list nat * nat, {p = q} + {p <> q}.
Proof. decide equality; [apply Nat.eq_dec | apply (list_eq_dec Nat.eq_dec)]. Defined.
Definition same_rows (r s : rows nat) : bool := if list_eq_dec same_row r s then true else false.
Definition shows_at (cell : list fixed) (ts : list tensor) (values : list (option slope)) (t : pose_test) (e : evidence) : bool :=
  match e with
  | AtControls (Turned e k places) =>
      match g with Some g => (0 <=? k)%Z && (places <? 64)%N && shows_less cell values ts (Some (g, k, places)) t e | None => false end
  | AtControls e => shows_less cell values ts None t e
  | ByTest | ByDirection _ _ => match t with OnSlopes t => shows bits [] [] [] values m None t e | _ => false end
  | ByTolerances _ _ _ _ | ByFan _ => match t with LeastOf r w k ends => same_rows r main && Nat.eqb w main_w && varied cell k ends e | _ => false end
  | _ => false
  end.
(** No orientation of the set is in the cell. *)
Definition is_outside_at (cell : list fixed) : bool :=
  match g with
  | Some g => match nth g (evaluate_at bits params tape (map (fun a => (a, sqr bits a)) cell)) None with Some a => (hi a <? 0)%Z | None => false end
  | None => false
  end.
Fixpoint discharged (cell : list fixed) (ts : list tensor) (values : list (option slope)) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  match steps with
  | [] => Some open
  | (O, Outside) :: rest => if is_outside_at cell then discharged cell ts values rest (map (fun _ => false) open) else None
  | (i, e) :: rest =>
      match nth i open false, nth_error tests i with
      | true, Some t => if shows_at cell ts values t e then discharged cell ts values rest (clear i open) else None
      | _, _ => None
      end
  end.
(** Formulas at control points, and in slopes, where they are asked for. *)
Definition of_controls (s : nat * evidence) : bool := match snd s with AtControls _ => true | _ => false end.
Definition of_slopes (s : nat * evidence) : bool := match snd s with ByTest | ByDirection _ _ | AtControls _ => true | _ => false end.
Definition places_in (steps : list (nat * evidence)) : list nat :=
  match g with Some i => [i] | None => [] end ++ flat_map (fun s => if of_controls s then match nth_error tests (fst s) with Some t => test_places t | None => [] end else []) steps.
Definition slopes_in (steps : list (nat * evidence)) : list nat :=
  flat_map (fun s => match nth_error tests (fst s) with
    | Some (OnSlopes t) => wanted_by [] [] [] t (snd s)
    | Some (NearOf a) => flat_map (fun j => fst (fst j) :: map snd (snd (snd (fst j)))) (n_joints a)
    | _ => []
    end) steps.
Definition steps_at (cell : list fixed) (steps : list (nat * evidence)) (open : list bool) : option (list bool) :=
  discharged cell (if existsb of_controls steps then tensors bits params (thinned (places_in steps) tape) cell else [])
    (if existsb of_slopes steps then evaluate_kept bits plain params (kept (slopes_in steps) plain) cell else []) steps open.

Variable theta : list R.
Hypothesis theta_in : Forall2 (contains bits) params theta.
(** Rows and weight of a test that has ends alone of some coordinates. *)
Definition with_ends (t : pose_test) : option (rows nat * nat * nat) :=
  match t with LeastOf r w _ e | SolveOf _ r w _ e => Some (r, w, e) | _ => None end.
Hypothesis affine : forall t, In t tests -> forallb (is_affine_at tape m) (test_places t) = true.
Hypothesis g_affine : forall i, g = Some i -> is_affine_at tape m i = true.
Hypothesis eased_near : forall a, In (NearOf a) tests -> n_ends a = O \/ is_eased tape m (n_ends a) (n_rows a) (n_weight a) None = true /\
  forall i k places, g = Some i -> is_eased tape m (n_ends a) (n_rows a) (n_weight a) (Some (i, k, places)) = true.
Hypothesis eased : forall t r w ends, In t tests -> with_ends t = Some (r, w, ends) -> ends = O \/ length r = n /\
  is_eased tape m ends r w None = true /\ forall i k places, g = Some i -> is_eased tape m ends r w (Some (i, k, places)) = true.
(** Rows are those of struts, and the orientation is of the set. *)
Definition is_turned (x : list R) : Prop :=
  let here i := at_pairs theta (entry_at tape i) (parabola x) in
  (forall i, g = Some i -> 0 <= here i) /\ (forall t r w e, In t tests -> with_ends t = Some (r, w, e) -> e = O \/ grounded (map_rows here r) /\ 0 < here w).

Definition test_holds (x : list R) (t : pose_test) : Prop :=
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
  | AxisOf r w => forall v, length v = 3%nat -> nonzero v -> positive_D (map_rows here r) /\ energy (map_rows here r) v < here w * Linear.dot v v
  | NearOf a => pose_found bits tape plain params theta m x a
  | OnSlopes t => Check.holds bits plain [] [] [] params theta m x t
  | ChordsOf r w places Y => forall v, length v = n -> nonzero v -> 0 < form (lower_weights places Y v) (map (fun p => (fst p, 0)) (map_rows here r)) v
  end.

Hypothesis varied_holds : forall cell x k ends e, In (LeastOf main main_w k ends) tests -> Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  varied cell k ends e = true -> test_holds x (LeastOf main main_w k ends).

Section Thin.
Variable thin : list (op address).
Hypothesis thin_is : is_thinned thin tape.
Variable keep : list bool.
Local Notation tensors_here cell := (tensors bits params thin cell).

Lemma shows_less_sound : forall cell x l t e, In t tests -> Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  (l = None \/ exists i k places, g = Some i /\ l = Some (i, k, places)) ->
  is_affine_multiple tape m l = true -> 0 <= less_at tape theta (parabola x) l ->
  shows_less cell (evaluate_kept bits plain params keep cell) (tensors_here cell) l t e = true -> test_holds x t.
Proof.
  intros cell x l t e it hx len ht hl la l0 h. pose proof (affine t it) as ha.
  pose proof (fun e good s => everywhere_shown bits params thin m cell len e good s) as K.
  assert (E : forall r w c, with_ends t = Some (r, w, c) -> ends_suffice tape theta m x c n r w l).
  { intros r w c i. destruct (eased t r w c it i) as [e0 | [lr [h1 h2]]]; [left; exact e0 |]. destruct (proj2 ht t r w c it i) as [e0 | G]; [left; exact e0 | right].
    split; [| split; [exact lr | exact G]].
    destruct hl as [-> | [j [q [places [eg ->]]]]]; [exact h1 | exact (h2 j q places eg)]. }
  destruct t as [r w k2 ends | r w k2 | r w c2 | i r w k2 ends | f | r w | r w | r w places Y | a | t], e; cbn [shows_less test_holds test_places] in *; cbv zeta in h; try discriminate.
  - intros k v. apply (lower_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 ends n places Y); [exact ha | exact (E r w ends eq_refl) | exact (K _ _ _ h)].
  - apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2]. apply Z.eqb_eq in h1, h2.
    intros k v [l1 l2] k0 lv nz. rewrite h1 in l1. rewrite h2 in l2. pose proof (unit_R_pos bits). assert (z : k = 0) by nra. subst k. rewrite !Rmult_0_l.
    exact (rank_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 ends n places Y r w v ha (E r w ends eq_refl) (K _ _ _ h3) lv nz).
  - intros k v. apply (upper_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 n); [exact ha | exact (K _ _ _ h)].
  - destruct mu as [| mu mus]; [discriminate |]. intros c u v.
    exact (conditioned_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 n places Y r w c2 mu mus c u v ha h).
  - intros k u hk k0 w0 lu nz. exact (solve_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 ends n i places Y r w k2 k u ha (E r w ends eq_refl) (K _ _ _ h) hk k0 w0 lu nz).
  - cbn [forallb] in ha. apply andb_true_iff in ha as [ha _]. exact (sign_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 f ha (K _ _ _ h)).
  - destruct Y as [| [| y [|]] [|]]; try discriminate.
    destruct (lower_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 0%nat 1%nat places [[y]] r w _ 1 [1] ha (or_introl eq_refl) (K _ _ _ h) (Fixed.integer_sound bits 1)) as [p q];
      [lra | reflexivity | unfold nonzero; cbn; lra |]. split; [exact p |]. cbn [Linear.dot] in q. lra.
  - intros v lv nz. rewrite <- (Rmult_1_l (at_pairs _ _ _)).
    exact (upper_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 3%nat r w _ 1 v ha (K _ _ _ h) (Fixed.integer_sound bits 1) lv nz).
  - intros v. exact (chords_shown bits tape params theta theta_in thin thin_is m cell x hx len l la l0 n places Y r w v ha (K _ _ _ h)).
  - refine (shows_pose_sound bits tape plain params theta theta_in m thin thin_is keep cell x a l _ _ _ _ hx ha la l0 _ h).
    destruct (eased_near a it) as [e0 | [h1 h2]]; [left; exact e0 | right]. destruct hl as [-> | [j [z [places' [eg ->]]]]]; [exact h1 | exact (h2 j z places' eg)].
Qed.

Lemma shows_at_sound : forall cell x t e, In t tests -> Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  shows_at cell (tensors_here cell) (evaluate_kept bits plain params keep cell) t e = true -> test_holds x t.
Proof.
  intros cell x t e it hx len ht h.
  assert (None_ : forall e, shows_less cell (evaluate_kept bits plain params keep cell) (tensors_here cell) None t e = true -> test_holds x t)
    by (intros e' h'; exact (shows_less_sound cell x None t e' it hx len ht (or_introl eq_refl) eq_refl (Rle_refl 0) h')).
  assert (Slopes : forall e, (match t with OnSlopes t => shows bits [] [] [] (evaluate_kept bits plain params keep cell) m None t e | _ => false end) = true -> test_holds x t).
  { intros e' k. destruct t; try discriminate. cbn [test_holds]. rewrite <- len in k |- *. exact (shows_holds bits plain [] [] [] params theta theta_in keep cell x _ e' hx k). }
  destruct e as [| | | | | | | | | | | e | | | | | e0 es dirs | | | |]; cbn [shows_at] in h; try discriminate; try exact (Slopes _ h).
  2-3: destruct t as [r w k ends | | | | | | | | |]; try discriminate; apply andb_true_iff in h as [h v]; apply andb_true_iff in h as [h1 h2]; apply Nat.eqb_eq in h2; subst w;
    unfold same_rows in h1; destruct (list_eq_dec same_row r main) as [-> |]; [| discriminate]; exact (varied_holds cell x k ends _ it hx len ht v).
  destruct e as [| | | | | | | | | | | | e k places | | | | | | | |]; try exact (None_ _ h).
  assert (G : exists i, g = Some i /\ (0 <=? k)%Z && (places <? 64)%N && shows_less cell (evaluate_kept bits plain params keep cell) (tensors_here cell) (Some (i, k, places)) t e = true)
    by (clear - h; destruct g as [i |]; [exists i; split; [reflexivity | exact h] | discriminate]).
  destruct G as [i [eg h']]. clear h. apply andb_true_iff in h' as [h s]. apply andb_true_iff in h as [k0 _]. apply Z.leb_le, IZR_le in k0.
  apply (shows_less_sound cell x (Some (i, k, places)) t e it hx len ht); [right; exists i, k, places; auto | exact (g_affine i eg) | | exact s].
  cbn [less_at]. apply Rmult_le_pos; [| exact (proj1 ht i eg)]. pose proof (two_power places). apply Rmult_le_pos; [exact k0 | apply Rlt_le, Rinv_0_lt_compat; assumption].
Qed.

End Thin.

Lemma is_outside_at_sound : forall cell x, Forall2 (contains bits) cell x -> is_outside_at cell = true -> ~ is_turned x.
Proof.
  intros cell x hx h ht. unfold is_outside_at in h. destruct g as [i |] eqn:eg; [| discriminate].
  destruct (nth i _ None) as [a |] eqn:ea; [| discriminate]. apply Z.ltb_lt, IZR_lt in h.
  destruct (range_sound bits tape params theta theta_in tape (thinned_not_at_all tape) cell x hx i a ea) as [_ u]. pose proof (proj1 ht i eg). pose proof (unit_R_pos bits). nra.
Qed.

Lemma discharged_needs : forall cell ts ts' vs vs' steps open, (existsb of_controls steps = true -> ts = ts') -> (existsb of_slopes steps = true -> vs = vs') ->
  discharged cell ts vs steps open = discharged cell ts' vs' steps open.
Proof.
  intros cell ts ts' vs vs'. induction steps as [| [i e] steps IH]; intros open hc hs; [reflexivity |]. cbn [existsb] in hc, hs.
  assert (Rest : forall open, discharged cell ts vs steps open = discharged cell ts' vs' steps open)
    by (intro o; apply IH; intro k; [apply hc | apply hs]; rewrite k; apply orb_true_r).
  assert (E : forall t, shows_at cell ts vs t e = shows_at cell ts' vs' t e).
  { intro t. destruct e; try reflexivity; [rewrite (hs eq_refl) | rewrite (hc eq_refl), (hs eq_refl) | rewrite (hs eq_refl)]; reflexivity. }
  destruct i, e; cbn [discharged]; try (destruct (is_outside_at cell); [apply Rest | reflexivity]);
    match goal with |- match nth ?j open false with _ => _ end = _ => destruct (nth j open false); [destruct (nth_error tests j); [rewrite E, Rest |] |]; reflexivity end.
Qed.

(** What steps show is of these parameters; [S] what follows from it. *)
Lemma steps_at_sound : forall (S : pose_test -> Prop) cell x steps open rest, Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  (forall i t, nth_error tests i = Some t -> nth i open false = true -> test_holds x t -> S t) ->
  steps_at cell steps open = Some rest -> (forall i t, nth_error tests i = Some t -> nth i open false = false -> S t) ->
  (forall i t, nth_error tests i = Some t -> nth i rest false = false -> S t) /\ forall i, nth i rest false = true -> nth i open false = true.
Proof.
  intros S cell x steps open rest hx len ht W h. set (thin := thinned (places_in steps) tape) in *. set (ts := tensors bits params thin cell) in *. set (keep := kept (slopes_in steps) plain) in *. set (vs := evaluate_kept bits plain params keep cell) in *.
  assert (h' : discharged cell ts vs steps open = Some rest)
    by (rewrite <- h; unfold steps_at; fold thin; fold keep; fold ts vs; apply discharged_needs; intros ->; reflexivity). clear h.
  assert (TI : is_thinned thin tape) by apply thinned_is. clearbody thin keep.
  set (Done := fun open rest : list bool => (forall i t, nth_error tests i = Some t -> nth i rest false = false -> S t) /\ forall i, nth i rest false = true -> nth i open false = true).
  change ((forall i t, nth_error tests i = Some t -> nth i open false = false -> S t) -> Done open rest).
  assert (Own : forall i e steps, (forall open, (forall i t, nth_error tests i = Some t -> nth i open false = true -> test_holds x t -> S t) ->
      discharged cell ts vs steps open = Some rest -> (forall i t, nth_error tests i = Some t -> nth i open false = false -> S t) -> Done open rest) ->
    forall open, (forall i t, nth_error tests i = Some t -> nth i open false = true -> test_holds x t -> S t) -> match nth i open false, nth_error tests i with
      | true, Some t => if shows_at cell ts vs t e then discharged cell ts vs steps (clear i open) else None
      | _, _ => None end = Some rest -> (forall i t, nth_error tests i = Some t -> nth i open false = false -> S t) -> Done open rest).
  { clear open W h'. intros i e steps' IH open W h D. destruct (nth i open false) eqn:o; [| discriminate]. destruct (nth_error tests i) as [t |] eqn:nt; [| discriminate].
    destruct (shows_at _ _ _ t e) eqn:s; [| discriminate].
    destruct (IH (clear i open) (fun j u nj oj => W j u nj (clear_leaves i j open oj)) h) as [I1 I2].
    - intros j u nj oj. destruct (nth_clear i j open oj) as [-> | o']; [| exact (D j u nj o')]. rewrite nt in nj. injection nj as <-.
      exact (W i t nt o (shows_at_sound thin TI keep cell x t e (nth_error_In _ _ nt) hx len ht s)).
    - split; [exact I1 |]. intros j r. exact (clear_leaves i j open (I2 j r)). }
  revert open W h'. induction steps as [| [i e] steps IH]; intros open W h D; cbn [discharged] in h; [injection h as <-; split; [exact D | auto] |].
  pose proof (Own i e steps IH open W) as O1. destruct i as [| i], e; try exact (O1 h D).
  destruct (is_outside_at cell) eqn:o; [| discriminate h]. exfalso. exact (is_outside_at_sound cell x hx o ht).
Qed.
End Tree.

(** ** The tree, in which parameters are narrowed *)

(** What accuracy says of one machine is about all others, too. *)
Definition is_of_each_pose (t : pose_test) : bool := match t with NearOf _ => false | OnSlopes t => is_of_each t | _ => true end.

Section Trees.
Variable bits : positive.
Variables tape plain : list (op address).
Variable all : list fixed.
Variable tests : list pose_test.
Variables m n : nat.
Variable g : option nat.
Variables (main : rows nat) (main_w : nat) (varied : list fixed -> list fixed -> fixed -> nat -> evidence -> bool).

Fixpoint check_for (params cell : list fixed) (open : list bool) (t : tree) : bool :=
  let then_ steps good := match steps_at bits tape plain params tests m n g main main_w (varied params) cell steps open with Some last => good last | None => false end in
  match t with
  | Leaf steps => then_ steps (forallb negb)
  | Split steps k lower upper => then_ steps (fun last =>
      let (a, b) := halves k cell in if check_for params a last lower then check_for params b last upper else false)
  | Parts steps j lower upper => then_ steps (fun last => if may_part is_of_each_pose tests last then
      let (a, b) := halves j params in if check_for a cell last lower then check_for b cell last upper else false else false)
  end.
Definition check_poses : list fixed -> list bool -> tree -> bool := check_for all.

Variable theta : list R.
Hypothesis theta_in : Forall2 (contains bits) all theta.
Hypothesis affine : forall t, In t tests -> forallb (is_affine_at tape m) (test_places t) = true.
Hypothesis g_affine : forall i, g = Some i -> is_affine_at tape m i = true.
Hypothesis eased_near : forall a, In (NearOf a) tests -> n_ends a = O \/ is_eased tape m (n_ends a) (n_rows a) (n_weight a) None = true /\
  forall i k places, g = Some i -> is_eased tape m (n_ends a) (n_rows a) (n_weight a) (Some (i, k, places)) = true.
Hypothesis eased : forall t r w ends, In t tests -> with_ends t = Some (r, w, ends) -> ends = O \/ length r = n /\
  is_eased tape m ends r w None = true /\ forall i k places, g = Some i -> is_eased tape m ends r w (Some (i, k, places)) = true.
Local Notation is_turned := (is_turned tape tests g theta).
Local Notation test_holds_for params := (test_holds bits tape plain params m n theta).
Local Notation test_holds := (test_holds_for all).
Hypothesis varied_holds : forall params, Forall2 (contains bits) params theta -> are_above all params ->
  forall cell x k ends e, In (LeastOf main main_w k ends) tests -> Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  varied params cell k ends e = true -> test_holds x (LeastOf main main_w k ends).

Lemma holds_of_each_pose : forall params x t, is_of_each_pose t = true -> test_holds_for params x t -> test_holds x t.
Proof.
  intros params x t e h. destruct t; try exact h; [discriminate |]. exact (holds_of_each bits plain [] [] [] params theta all m x _ e h).
Qed.

Theorem check_for_sound : forall tr params cell x open, check_for params cell open tr = true -> Forall2 (contains bits) params theta -> are_above all params ->
  Forall2 (contains bits) cell x -> length cell = m -> is_turned x ->
  (forall i t, nth_error tests i = Some t -> nth i open false = true -> test_holds_for params x t -> test_holds x t) ->
  (forall i t, nth_error tests i = Some t -> nth i open false = false -> test_holds x t) -> forall t, In t tests -> test_holds x t.
Proof.
  induction tr as [steps | steps k lower IHl upper IHu | steps k lower IHl upper IHu]; intros params cell x open h hp hr hx len ht W D t it; cbn [check_for] in h; cbv zeta in h;
    destruct (steps_at _ _ _ _ _ _ _ _ _ _ _ cell steps open) as [rest |] eqn:s; try discriminate;
    destruct (steps_at_sound bits tape plain params tests m n g main main_w (varied params) theta hp affine g_affine eased_near eased
      (fun c y k e v i hc lc hy q => varied_holds params hp hr c y k e v i hc lc hy q) (test_holds x) cell x steps open rest hx len ht W s D) as [D' L].
  - destruct (In_nth_error _ _ it) as [i e]. apply (D' i t e). rewrite forallb_forall in h.
    destruct (nth_in_or_default i rest false) as [k | ->]; [| reflexivity]. apply h in k. destruct (nth i rest false); [discriminate | reflexivity].
  - assert (W' : forall i t, nth_error tests i = Some t -> nth i rest false = true -> test_holds_for params x t -> test_holds x t)
      by (intros i u e o; exact (W i u e (L i o))).
    pose proof (halves_sound bits k cell x hx) as c. destruct (halves_length k cell) as [La Lb]. destruct (halves k cell) as [a b]. cbn [fst snd] in *.
    destruct (check_for params a rest lower) eqn:ha; [| discriminate].
    destruct c as [c | c]; [exact (IHl params a x rest ha hp hr c ltac:(congruence) ht W' D' t it) | exact (IHu params b x rest h hp hr c ltac:(congruence) ht W' D' t it)].
  - destruct (may_part is_of_each_pose tests rest) eqn:e; [| discriminate].
    assert (W' : forall ps i t, nth_error tests i = Some t -> nth i rest false = true -> test_holds_for ps x t -> test_holds x t)
      by (intros ps i u q o; exact (holds_of_each_pose ps x u (may_part_sound _ _ _ rest i u e q o))).
    destruct (above_halved bits k params theta hp all hr) as [r1 r2]. pose proof (halves_sound bits k params theta hp) as c. destruct (halves k params) as [a b]. cbn [fst snd] in *.
    destruct (check_for a cell rest lower) eqn:ha; [| discriminate].
    destruct c as [c | c]; [exact (IHl a cell x rest ha c r1 hx len ht (W' a) D' t it) | exact (IHu b cell x rest h c r2 hx len ht (W' b) D' t it)].
Qed.

Theorem check_poses_sound : forall tr cell x, check_poses cell (map (fun _ => true) tests) tr = true -> Forall2 (contains bits) cell x -> length cell = m ->
  is_turned x -> forall t, In t tests -> test_holds x t.
Proof.
  intros tr cell x h hx len ht. apply (check_for_sound tr all cell x _ h theta_in); try assumption; [| auto |].
  - clear. induction all; constructor; [lia | assumption].
  - intros i t e o. exfalso. rewrite (nth_indep _ false true) in o.
    + rewrite (map_nth (fun _ => true) tests (SignOf 0) i) in o. discriminate.
    + rewrite map_length. apply nth_error_Some. congruence.
Qed.
End Trees.

(** ** Formulas *)

Definition expanded (a b : formula) : formula := plus (minus (square a) (times (times (integer 2) b) a)) (square b).
(** w times the vector of a strut from [a] to [b], in the base or in the platform's frame. *)
Definition etransposed (N : emat) : emat :=
  let column f := EVec (f (erow1 N)) (f (erow2 N)) (f (erow3 N)) in EMat (column ex) (column ey) (column ez).
Definition way (k : motion) (N : emat) (w : formula) (a b : evec) (on_platform : bool) : evec :=
  let h := map2 minus (eposition k) a in
  if on_platform then map2 plus (Machine.scaled w b) (emulv (etransposed N) h) else map2 plus (Machine.scaled w h) (emulv N b).

(** w A and w D. *)
Definition scaled_row (k : motion) (N : emat) (w ell : formula) (a b : evec) : list formula * formula :=
  let p := eposition k in let h := map2 minus p a in let nb := emulv N b in
  let own := plus (plus (plus (Machine.product b b) (expanded (ex p) (ex a))) (expanded (ey p) (ey a))) (expanded (ez p) (ez a)) in
  (etwist k (way k N w a b false) (divided_by (ecross nb h) ell),
   plus (times w own) (times (integer 2) (Machine.product nb h))).

(** Of a strut, of which r is its joint's lever from P: w r . A, and for the greatest ratio k of
    the joint's speed to the platform's, w (|b|^2 - (k^2 - q) ell^2), q = 0 if the platform turns about a point and 1 else. *)
Definition lever (k : motion) (N : emat) (w ell : formula) (a b : evec) : formula * (formula -> formula) :=
  let q := match k with AboutPoint => 0%Z | _ => 1%Z end in
  (Machine.product (way k N w a b true) b, fun ratio => times w (minus (Machine.product b b) (times (minus (square ratio) (integer q)) (square ell)))).

(** Not polynomials: the platform end, the vector and the length. *)
Definition eplaced (k : motion) (N : emat) (w : formula) (b : evec) : evec := map2 plus (eposition k) (eturned N w b).
Definition limb (k : motion) (N : emat) (w : formula) (a b : evec) : evec * evec * formula :=
  let tip := eplaced k N w b in let A := map2 minus tip a in (tip, A, root (Machine.product A A)).

(** [A, a x A]: of a strut its vector w A with its moment about the origin, of which a is the base end; about a fixed point that is its row. *)
Definition origin_row (k : motion) (a : evec) (row : list formula * formula) : list formula * formula :=
  match k, fst row with
  | InPlane, x :: y :: _ => ([x; y; ez (ecross a (EVec x y (integer 0)))], snd row)
  | InSpace, x :: y :: z :: _ => let m := ecross a (EVec x y z) in ([x; y; z; ex m; ey m; ez m], snd row)
  | _, A => (A, snd row)
  end.

(** ** What they stand for *)

Lemma orthonormal_whole : forall a b c v, norm2 a = 1 -> norm2 b = 1 -> norm2 c = 1 -> Vec3.dot a b = 0 -> Vec3.dot a c = 0 -> Vec3.dot b c = 0 ->
  vadd (vadd (vscale (Vec3.dot a v) a) (vscale (Vec3.dot b v) b)) (vscale (Vec3.dot c v) c) = v.
Proof.
  intros a b c v ha hb hc ab ac bc. set (u := vadd _ _). set (w := vsub v u). set (d := Vec3.dot a (cross b c)).
  assert (D : d ^ 2 = 1).
  { assert (E : d ^ 2 = norm2 a * norm2 b * norm2 c + 2 * Vec3.dot a b * Vec3.dot a c * Vec3.dot b c - norm2 a * Vec3.dot b c ^ 2 - norm2 b * Vec3.dot a c ^ 2 - norm2 c * Vec3.dot a b ^ 2)
      by (unfold d; clear; vec_ring). rewrite E, ha, hb, hc, ab, ac, bc. ring. }
  assert (S : forall p, Vec3.dot p w = Vec3.dot p v - (Vec3.dot a v * Vec3.dot p a + Vec3.dot b v * Vec3.dot p b + Vec3.dot c v * Vec3.dot p c)) by (intro p; unfold w, u; clear; vec_ring).
  assert (C : forall p q, Vec3.dot p q = Vec3.dot q p) by (intros; unfold Vec3.dot; ring).
  assert (A : Vec3.dot a w = 0) by (rewrite S, <- norm2_dot, ha, ab, ac; ring).
  assert (B : Vec3.dot b w = 0) by (rewrite S, (C b a), <- norm2_dot, hb, ab, bc; ring).
  assert (G : Vec3.dot c w = 0) by (rewrite S, (C c a), (C c b), <- norm2_dot, hc, ac, bc; ring).
  assert (Z : vscale d w = vzero).
  { transitivity (vadd (vadd (vscale (Vec3.dot a w) (cross b c)) (vscale (Vec3.dot b w) (cross c a))) (vscale (Vec3.dot c w) (cross a b)));
      [unfold d; generalize w; clear; intro w; vec_ring | rewrite A, B, G; unfold vadd, vscale, vzero; cbn [vx vy vz]; f_equal; ring]. }
  assert (W : w = vzero).
  { transitivity (vscale d (vscale d w)); [| rewrite Z; unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring].
    clearbody w. clear - D. destruct w as [x y z]. unfold vscale. cbn [vx vy vz]. f_equal; rewrite <- Rmult_assoc; replace (d * d) with (d ^ 2) by ring; rewrite D; ring. }
  clearbody u. unfold w in W. clear - W. destruct v as [x y z], u as [p q r]. unfold vsub, vzero in W. cbn [vx vy vz] in W. injection W as e1 e2 e3. f_equal; lra.
Qed.
Lemma vadd_vscale : forall r u v, vadd (vscale r u) (vscale r v) = vscale r (vadd u v).
Proof. vec_ring. Qed.
Lemma vsub_vscale : forall r u v, vsub (vscale r u) (vscale r v) = vscale r (vsub u v).
Proof. vec_ring. Qed.
Lemma transpose_mscale : forall a M, transpose (mscale a M) = mscale a (transpose M).
Proof. vec_ring. Qed.
Lemma mulv_back : forall M P n B, mulv M (vsub (vadd P n) B) = vadd (mulv M (vsub P B)) (mulv M n).
Proof. vec_ring. Qed.
Lemma way_on_platform : forall w r c n, vadd (vscale w (vscale r c)) (vscale w (vscale r n)) = vscale (w * r) (vadd n c).
Proof. vec_ring. Qed.
Lemma way_in_base : forall w r P n B, vadd (vscale w (vscale r (vsub P B))) (vscale w (vscale r n)) = vscale (w * r) (vsub (vadd P n) B).
Proof. vec_ring. Qed.
Lemma placed_difference : forall P M v, vsub (vadd P (mulv M v)) (vadd P (mulv M vzero)) = mulv M v.
Proof. vec_ring. Qed.
Lemma axis_on_platform : forall a o M A v, Vec3.dot (vscale a (mulv (transpose M) A)) (vscale o v) = a * o * Vec3.dot A (mulv M v).
Proof. vec_ring. Qed.
Lemma lever_dot : forall w r M A c, Vec3.dot (vscale (w * r) (mulv (transpose M) A)) (vscale r c) = w * r ^ 2 * Vec3.dot (mulv M c) A.
Proof. vec_ring. Qed.
(** What keeps lengths has its transpose as its inverse, on both sides. *)
Lemma rotations_invert : forall Q, (forall b, norm2 (mulv Q b) = norm2 b) -> forall b, mulv (transpose Q) (mulv Q b) = b /\ mulv Q (mulv (transpose Q) b) = b.
Proof.
  intros Q keeps.
  pose proof (keeps (Vec 1 0 0)) as k1. pose proof (keeps (Vec 0 1 0)) as k2. pose proof (keeps (Vec 0 0 1)) as k3.
  pose proof (keeps (Vec 1 1 0)) as k4. pose proof (keeps (Vec 1 0 1)) as k5. pose proof (keeps (Vec 0 1 1)) as k6.
  destruct Q as [[a1 a2 a3] [b1 b2 b3] [c1 c2 c3]]. unfold mulv, norm2, Vec3.dot in k1, k2, k3, k4, k5, k6. cbn [row1 row2 row3 vx vy vz] in k1, k2, k3, k4, k5, k6.
  assert (n1 : a1 ^ 2 + b1 ^ 2 + c1 ^ 2 = 1) by lra. assert (n2 : a2 ^ 2 + b2 ^ 2 + c2 ^ 2 = 1) by lra. assert (n3 : a3 ^ 2 + b3 ^ 2 + c3 ^ 2 = 1) by lra.
  assert (o1 : a1 * a2 + b1 * b2 + c1 * c2 = 0) by lra. assert (o2 : a1 * a3 + b1 * b3 + c1 * c3 = 0) by lra. assert (o3 : a2 * a3 + b2 * b3 + c2 * c3 = 0) by lra.
  clear k1 k2 k3 k4 k5 k6. intros [x y z]. split.
  - unfold mulv, transpose, col1, col2, col3, Vec3.dot. cbn [row1 row2 row3 vx vy vz].
    f_equal; [transitivity ((a1 ^ 2 + b1 ^ 2 + c1 ^ 2) * x + (a1 * a2 + b1 * b2 + c1 * c2) * y + (a1 * a3 + b1 * b3 + c1 * c3) * z) |
      transitivity ((a1 * a2 + b1 * b2 + c1 * c2) * x + (a2 ^ 2 + b2 ^ 2 + c2 ^ 2) * y + (a2 * a3 + b2 * b3 + c2 * c3) * z) |
      transitivity ((a1 * a3 + b1 * b3 + c1 * c3) * x + (a2 * a3 + b2 * b3 + c2 * c3) * y + (a3 ^ 2 + b3 ^ 2 + c3 ^ 2) * z)]; try ring; rewrite ?n1, ?n2, ?n3, ?o1, ?o2, ?o3; ring.
  - pose proof (orthonormal_whole (Vec a1 b1 c1) (Vec a2 b2 c2) (Vec a3 b3 c3) (Vec x y z) n1 n2 n3 o1 o2 o3) as E. rewrite <- E at 2.
    unfold mulv, transpose, col1, col2, col3, vadd, vscale, Vec3.dot. cbn [row1 row2 row3 vx vy vz]. f_equal; ring.
Qed.

Lemma twist_scaled : forall k c a b, twist k (vscale c a) (vscale c b) = map (Rmult c) (twist k a b).
Proof. intros [] c a b; reflexivity. Qed.

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

Lemma transposed_is : valm x theta (etransposed N) = transpose (mscale W Q).
Proof. rewrite <- hN. reflexivity. Qed.
Lemma way_values : forall on, val3 x theta (way k N we a b on) = vscale (W * r) (if on then mulv (transpose Q) (strut_vector l P Q) else strut_vector l P Q).
Proof.
  pose proof (proj1 (rotations_invert Q keeps (strut_joint l))) as I. intros [|]; unfold way; cbv zeta; rewrite val3_plus, val3_scaled, val3_mulv, val3_minus, hP, ha, hb, hw.
  - rewrite transposed_is, transpose_mscale, vsub_vscale, mulv_mscale, mulv_scale. unfold strut_vector, arm_of_joint. rewrite mulv_back, I. apply way_on_platform.
  - rewrite hN, vsub_vscale, mulv_mscale, mulv_scale. unfold strut_vector, arm_of_joint. apply way_in_base.
Qed.

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
  - rewrite twist_values, <- twist_scaled, way_values, val3_divided, val3_cross, Nb, H, hl.
    unfold strut_vector. set (n := arm_of_joint l Q). clearbody n. clear - r0 L0. f_equal.
    destruct P as [p1 p2 p3], (strut_base l) as [b1 b2 b3], n as [n1 n2 n3]. unfold vsub, vadd, vscale, cross. cbn [vx vy vz]. f_equal; field; lra.
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
  unfold is_lever, lever. cbv zeta. cbn [fst snd]. split.
  - rewrite value_dot, way_values, hb. apply lever_dot.
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

Lemma turned_values : forall u v, val3 x theta u = vscale r v -> val3 x theta (eturned N we u) = vscale r (mulv Q v).
Proof.
  intros u v e. unfold eturned. rewrite val3_divided, val3_mulv, hN, e, hw, mulv_mscale, mulv_scale. generalize (mulv Q v). clear - W0. intros [v1 v2 v3].
  unfold vscale. cbn [vx vy vz]. f_equal; field; lra.
Qed.
Lemma placed_values : forall u v, val3 x theta u = vscale r v -> val3 x theta (eplaced k N we u) = vscale r (vadd P (mulv Q v)).
Proof. intros u v e. unfold eplaced. rewrite val3_plus, hP, (turned_values u v e). apply vadd_vscale. Qed.
Lemma limb_values : rod_stands x theta r (Some (limb k N we a b)) (Some (vadd P (arm_of_joint l Q), strut_vector l P Q, strut_length l P Q)).
Proof.
  pose proof (placed_values b (strut_joint l) hb) as T. fold (arm_of_joint l Q) in T. unfold limb. cbv zeta. cbn [rod_stands].
  assert (A : val3 x theta (map2 minus (eplaced k N we b) a) = vscale r (strut_vector l P Q)).
  { rewrite val3_minus, T, ha. apply vsub_vscale. }
  do 3 eexists. split; [reflexivity |]. split; [symmetry; exact T |]. split; [symmetry; exact A |].
  rewrite value_root, value_dot, A, <- norm2_dot, norm2_scale, sqrt_resized by exact r0. reflexivity.
Qed.

Definition origin_scale : R := match k with AboutPoint => W / L | _ => W * r end.
Lemma origin_scale_pos : 0 < origin_scale.
Proof. clear - r0 W0 L0. unfold origin_scale. destruct k; [exact (Rmult_lt_0_compat _ _ W0 r0) | exact (Rmult_lt_0_compat _ _ W0 r0) | exact (Rdiv_lt_0_compat _ _ W0 L0)]. Qed.
Lemma origin_row_values : is_position k P ->
  map (Formula.value x theta) (fst (origin_row k a (scaled_row k N we le a b))) = map (Rmult origin_scale) (about_origin (Legs.Turns k) r l P Q).
Proof.
  intro place. pose proof scaled_row_values as S. unfold origin_scale, about_origin. cbv zeta. unfold scaled_row in *. cbv zeta in *. destruct S as [_ S].
  set (A := way _ _ _ _ _ _) in *. remember (strut_vector l P Q) as q eqn:Eq. unfold strut_vector in Eq. remember (arm_of_joint l Q) as n eqn:En. clear En. clearbody A. set (B := divided_by _ _) in *. clearbody B. destruct k; cbn [etwist twist map fst origin_row is_position Legs.velocities] in *; injection S as s1 s2 s3.
  - pose proof (val3_cross x theta a (EVec (ex A) (ey A) (integer 0))) as M. rewrite ha in M. apply (f_equal vz) in M. cbn [vz val3 ex ey ez] in M. rewrite M. unfold val3. cbn [ex ey ez]. rewrite s1, s2.
    clear. generalize (strut_base l) q. intros [b1 b2 b3] [q1 q2 q3]. unfold cross, vscale. cbn [vx vy vz]. repeat (f_equal; try ring).
  - assert (V : val3 x theta (EVec (ex A) (ey A) (ez A)) = vscale (W * r) q) by (unfold val3, vscale; cbn [ex ey ez]; rewrite s1, s2, s3; reflexivity).
    pose proof (val3_cross x theta a (EVec (ex A) (ey A) (ez A))) as M. rewrite V, ha in M.
    pose proof (f_equal vx M) as m1. pose proof (f_equal vy M) as m2. pose proof (f_equal vz M) as m3. cbn [vx vy vz val3] in m1, m2, m3.
    rewrite s1, s2, s3, m1, m2, m3. clear. generalize (strut_base l) q. intros [b1 b2 b3] [q1 q2 q3]. unfold cross, vscale. cbn [vx vy vz]. repeat (f_equal; try ring).
  - rewrite s1, s2, s3. rewrite Eq, place. clear - L0. generalize (strut_base l) n. intros [b1 b2 b3] [q1 q2 q3].
    unfold cross, vscale, vsub, vadd, vzero. cbn [vx vy vz]. repeat (apply f_equal2; [field; lra |]). reflexivity.
Qed.
End Row.

(** ** Checking *)

Definition strut_layout (s : Z) (t : tolerances * tolerances) : list parameter := three (fst t) s ++ three (snd t) s.
(** What is made of each strut, of its two ends. *)
Fixpoint each_strut {A : Type} (f : evec -> evec -> A) (s : Z) (ts : list (tolerances * tolerances)) (j : nat) : list A :=
  match ts with
  | [] => []
  | t :: ts' => let q := numbered j (strut_layout s t) in f (vector_at q 0) (vector_at q 3) :: each_strut f s ts' (j + length (strut_layout s t))
  end.
Record posed_strut := PosedStrut { z_row : list formula * formula; z_lever : formula * (formula -> formula); z_way : bool -> evec; z_limb : evec * evec * formula; z_bend : unit -> bend;
  (* turned on, with tau/d: the derivatives of its length, and that *)
  z_moved : formula -> list formula * formula }.
(** [p]: the first of three parameters that are no others. *)
Definition formulas_of (k : motion) (N : emat) (w ell : formula) (p : nat) (a b : evec) : posed_strut :=
  PosedStrut (scaled_row k N w ell a b) (lever k N w ell a b) (way k N w a b) (limb k N w a b)
    (fun _ => let '(C, A, len) := limb k N w a b in bend_of k ell a b (eturned N w b) C A len (map2 minus (eposition k) a) p)
    (fun unit => let c := spin_formulas k (dimension k) in (moved_row k N w a b c unit, snd (moved_strut k N w a b c))).

Section Precision.
Variable bits : positive.
(** Of claims that no two poses have the same lengths: the one matrix, and before which other test this is counted. *)
Variables (one_matrix : N * list (list Z)) (one_place : nat).
(** Of a pose, with the formulas of its struts. *)
Section Asked.
Variables (s : Z) (k : motion) (N : emat) (w : formula) (zs : list posed_strut) (ell : formula) (ps : list parameter).
Let rows : rows formula := map z_row zs.

Definition length_sign (q : list formula) (d : demand) : option formula :=
  let bound := times (square (nth 0 q (integer 0))) w in
  match d with
  | LengthMin i b => match nth_error zs i with Some z => if certainly bits false b then Some (minus (snd (z_row z)) bound) else None | None => None end
  | LengthMax i b => match nth_error zs i with Some z => if certainly bits false b then Some (minus bound (snd (z_row z))) else None | None => None end
  | _ => None
  end.
(** Of a joint's speed: w r . A, and what is less than its square over w D. *)
Definition lever_of (q : list formula) (d : demand) : option (formula * formula) :=
  match d with SpeedMax i _ _ => option_map (fun z => (fst (z_lever z), snd (z_lever z) (nth 0 q (integer 0)))) (nth_error zs i) | _ => None end.

(** Of an angle up to 90 degrees at a joint: w U . j >= 0, and (cos(b) |j| w |U|)^2 <= (w U . j)^2 for less than 90, U the strut's vector where j is.
    Of others A . j - cos(b) |j| |A|. *)
Definition up_to_90 (b : number) : bool := certainly exact_bits false (Minus (90 // 1) b).
Definition least_cosine (q : list formula) : formula := times (nth 0 q (integer 0)) (root (Machine.product (vector_at q 1) (vector_at q 1))).
Definition angle_row (q : list formula) (U : evec) : list formula * formula :=
  (list_of (Machine.scaled (least_cosine q) U), Machine.product U (vector_at q 1)).
Definition angle_sign (q : list formula) (on_platform : bool) (l : evec * evec * formula) : formula :=
  let '(_, A, len) := l in
  minus (Machine.product A (if on_platform then eturned N w (vector_at q 1) else vector_at q 1)) (times (least_cosine q) len).

Definition limb_segments (q : list formula) (one other : body) : option (evec * evec * (evec * evec)) :=
  segments_along (map (fun z => Some (z_limb z)) zs) (eplaced k N w) (tl q) one other.

(** Of accuracy: tau/d, and scaled rows by what a pose is off by, of which the length is what a strut's limb has. *)
Definition turn_unit (q : list formula) : formula := over (nth 0 q (integer 0)) (nth 1 q (integer 0)).
Definition turned_row (q : list formula) (z : posed_strut) : list formula * formula :=
  let twice := times (times (integer 2) ell) (turn_unit q) in let A := fst (z_row z) in
  (firstn (first_angle k) A ++ map (fun e => times e twice) (skipn (first_angle k) A), snd (z_row z)).
Definition own_length (z : posed_strut) : formula := snd (z_limb z).
(** With the derivatives of w D behind its columns. *)
Definition changed_row (q : list formula) (z : posed_strut) : list formula * formula :=
  (fst (turned_row q z) ++ map snd (slopes_of ps (snd (z_row z))), snd (z_row z)).

Definition own_formulas (q : list formula) (d : demand) : list formula :=
  match d with
  | StiffnessMin _ _ => map snd (stiffened rows q)
  | SpeedMax _ _ _ => match lever_of q d with Some (f, b) => [f; b] | None => [] end
  | JointAngleMax i on _ b => match nth_error zs i with
      | Some z => if up_to_90 b then let (A, D) := angle_row q (z_way z on) in A ++ [D] else []
      | None => []
      end
  | OnePose _ _ _ => flat_map (fun z => fst (changed_row q z)) zs
  | _ => match length_sign q d with Some f => [f] | None => [] end
  end.
(** Of these, slopes. *)
Definition plain_formulas (q : list formula) (d : demand) : list formula :=
  match d with
  | JointAngleMax i on _ b => match nth_error zs i with Some z => if up_to_90 b then [] else [angle_sign q on (z_limb z)] | None => [] end
  | Clear one other _ => match limb_segments q one other with Some ((a, b), (c, d)) => flat_map list_of [a; b; c; d] | None => [] end
  | AccelerationMax i _ _ _ => match nth_error zs i with
      | Some z => let t := z_bend z tt in bend_row t ++ concat (bend_twice t) ++ [nth 0 q (integer 0); nth 1 q (integer 0); bend_square t; bend_along t]
      | None => []
      end
  | OnePose _ _ _ => flat_map (fun z => fst (z_moved z (turn_unit q)) ++ [snd (z_moved z (turn_unit q))]) zs ++ flat_map (fun z => own_length z :: map snd (slopes_of ps (own_length z))) zs
  | _ => []
  end.

Variables (place plain : formula -> nat) (ends : nat) (ends_for : Test.rows nat -> nat).
Definition pose_test_of (q : list formula) (d : demand) : option pose_test :=
  let squared make r x := option_map (fun a => make (map_rows place r) (place w) (sqr bits a)) (enclose_parameter bits (exactly x, 0%Z)) in
  let least r w k := LeastOf r w k ends in
  match d with
  | Nonsingular => Some (least (map_rows place rows) (place w) zero)
  | FactorMax b => squared least rows (Over (1 // 1) b)
  | FactorMin b => squared GreatestOf rows (Over (1 // 1) b)
  | LengthMin _ _ | LengthMax _ _ => option_map (fun f => SignOf (place f)) (length_sign q d)
  | SpeedMax i tool b => match nth_error zs i, lever_of q d with
      | Some z, Some (f, b') => if certainly bits true tool && certainly bits true b then Some (LeverOf [([place f], place (snd (z_row z)))] (place b')) else None
      | _, _ => None
      end
  | StiffnessMin ks b => if certainly bits true b && forallb (certainly bits true) ks
      then Some (LeastOf (map_rows place (stiffened rows q)) (place w) (Fixed.integer bits 1) O) else None
  | ForceMax i tool b => match nth_error zs i with
      | Some _ => if certainly bits true tool && certainly bits true b then squared (fun r w k => SolveOf i r w k ends) rows (Over tool b) else None
      | None => None
      end
  | Conditioned b => option_map (fun a => ConditionOf (map_rows place rows) (place w) (sqr bits a)) (enclose_parameter bits (exactly b, 0%Z))
  | Clear one other b => match limb_segments q one other, enclose_parameter bits (exactly (distance_of one other b), s) with
      | Some ((a, b), (c, d)), Some distance => if (0 <=? lo distance)%Z then
          let at_ := ends_at plain in Some (OnSlopes (Apart (at_ a) (at_ b) (at_ c) (at_ d) distance)) else None
      | _, _ => None
      end
  | AccelerationMax i a v b => match nth_error zs i with
      | Some z => if certainly bits true b && (certainly bits false a && certainly bits false v) then let t := z_bend z tt in
          Some (OnSlopes (Curved (map plain (bend_row t)) (map (map plain) (bend_twice t)) (plain (nth 0 q (integer 0))) (plain (nth 1 q (integer 0))) (Some (plain (bend_square t), plain (bend_along t))) []))
          else None
      | None => None
      end
  | _ => None
  end.
Definition angle_tests (q : list formula) (z : posed_strut) (on : bool) (b : number) : list pose_test :=
  if up_to_90 b then let (A, D) := angle_row q (z_way z on) in
    SignOf (place D) :: if certainly exact_bits false (Minus b (90 // 1)) then [] else [AxisOf [(map place A, place D)] (place D)]
  else [OnSlopes (AtLeast (plain (angle_sign q on (z_limb z))))].
(** What its length and w D, which has no quotient, change by. *)
Definition near_joint_of (error b : number) (z : posed_strut) : option (nat * (fixed * list (fixed * nat)) * list fixed) :=
  match joint_test bits plain ps s error b (own_length z), changes_of bits place ps s b (snd (z_row z)) with
  | Some j, Some hs => if is_polynomial [] [] (snd (z_row z)) then Some (j, map fst hs) else None
  | _, _ => None
  end.
Definition near_tests (q : list formula) (error b angle : number) : list (option pose_test) :=
  if Nat.eqb (length zs) (dimension k) && certainly bits false error && certainly bits true b && certainly bits true angle && is_angle_number bits angle then
    match enclose_parameter bits (exactly b, s), enclose_tangent bits angle, all_some (map (near_joint_of error b) zs) with
    | Some d, Some t, Some js =>
        let rows := map_rows place (map (changed_row q) zs) in
        let test last := Some (NearOf (NearTest rows (place w) (ends_for rows) (map (fun z => map plain (fst (z_moved z (turn_unit q)))) zs)
          (map (fun z => plain (snd (z_moved z (turn_unit q)))) zs) js d t (first_angle k) last)) in
        match k with AboutPoint => [test true] | _ => [test false; test true] end
    | _, _, _ => [None]
    end
  else [None].
Definition is_axis (j : Statement.position) : bool := is_never_zero (Tolerances (exactly (px j)) (exactly (py j)) (exactly (pz j))).
Definition tests_of_demand (q : list formula) (d : demand) : list (option pose_test) :=
  match d with
  | JointAngleMax i on j b => match nth_error zs i with
      | Some z => if is_axis j && certainly bits false b && certainly bits false (Minus (180 // 1) b) then map Some (angle_tests q z on b) else [None]
      | None => [None]
      end
  | OnePose error b angle => near_tests q error b angle
  | _ => [pose_test_of q d]
  end.
End Asked.
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

(** The parameters of struts with tolerances, where these are apart somewhere in a tree. *)
Definition free_struts (s : Z) (ts : list (tolerances * tolerances)) : list nat :=
  let lay := flat_map (strut_layout s) ts in map fst (filter (fun p => has_two_ends (snd p)) (combine (seq 0 (length lay)) lay)).
Definition is_apart (s : nat * evidence) : bool := match snd s with ByTolerances _ _ _ _ | ByFan _ => true | _ => false end.
Fixpoint has_apart (t : tree) : bool :=
  match t with Leaf steps => existsb is_apart steps | Split steps _ lower upper | Parts steps _ lower upper => existsb is_apart steps || has_apart lower || has_apart upper end.

Definition check_turning (c : turning_claim) (s : Z) (t : tree) : bool :=
  let k := motion_of c in let m := dimension k in let ds := turning_demands c in
  let lay := flat_map (strut_layout s) (struts c) in let pl := (exactly (characteristic_length c), s) in let j := S (length lay) in
  let ins := flat_map (inputs_of false s) ds in
  let (N, w) := chart (turned c) (first_angle k) in let ell := quantity pl (length lay) in
  let zs := each_strut (formulas_of k N w ell (length lay)) s (struts c) 0 in let rows := map z_row zs in
  let g := curve (turned c) (first_angle k) (j + length ins) in
  let about := if one_pose c then each_strut (fun a b => origin_row k a (scaled_row k N w (quantity pl (length lay)) a b)) s (struts c) 0 else [] in
  let wanted := entries rows ++ w :: of_each (own_formulas k w zs ell (lay ++ [pl])) false s j ds ++ match g with Some g => [g] | None => [] end ++ entries about in
  let others := of_each (plain_formulas k N w zs (lay ++ [pl])) false s j ds in
  let tape := compile (map (image m) wanted) in let plain := compile others in
  let fs := formulas tape in let plain_fs := formulas plain in
  let at_ := Formula.place fs in let place f := at_ (image m f) in let plain_place := Formula.place plain_fs in
  let ends_for r := match positions c with Box _ => ends_of fs m k r (place w) (option_map place g) | _ => O end in let ends := ends_for (map_rows place rows) in
  forallb (fun f => Formula.same (nth (place f) fs (integer 0)) (image m f)) wanted && forallb (is_below m) wanted &&
  forallb (fun f => Formula.same (nth (plain_place f) plain_fs (integer 0)) f) others &&
  existsb excludes ds && (negb (one_pose c) || turns_less bits (Legs.Turns k) (Some (turned c))) && is_flat k (hull (positions c)) && certainly bits true (characteristic_length c) &&
  forallb (fun t => is_angle_number bits (least t) && is_angle_number bits (greatest t)) (angles_of (turned c)) &&
  match all_some (map (enclose_parameter bits) (lay ++ [pl])), all_some (map (enclose_input bits) ins),
        all_some (map (fun t => enclose_parameter bits (t, s)) (position_tolerances k (hull (positions c)))),
        all_some (map (end_box bits) (chart_ends (turned c))),
        all_some (map (enclose_tangent bits) (curved (turned c))),
        all_some (of_each (tests_of_demand s k N w zs ell (lay ++ [pl]) place plain_place ends ends_for) false s j ds) with
  | Some params, Some inputs, Some box, Some angles, Some tangents, Some tests =>
      let tests := if one_pose c then inserted one_place tests (ChordsOf (map_rows place about) (place w) (fst one_matrix) (snd one_matrix)) else tests in
      Nat.eqb (length (box ++ angles)) m && forallb (fun t => forallb (affine_in m fs) (test_places t)) tests &&
      match g with Some g => affine_in m fs (place g) | None => true end &&
      let all := params ++ inputs ++ tangents in
      let apart := has_apart t in let free := free_struts s (struts c) in
      let F := if apart then own_multis m rows free else [] in
      let apart_tape := if apart then compile (varied_wanted m w g F) else [] in
      let apart_fs := formulas apart_tape in let apart_place := Formula.place apart_fs in
      let apart_rows := map_multis apart_place apart_place F in let apart_w := apart_place (image m w) in let apart_g := option_map (fun g => apart_place (image m g)) g in
      let fit := negb apart || (Nat.eqb (length rows) m && are_fit m ends rows w g all free F apart_fs) in
      fit && check_poses bits tape plain all tests m m (option_map place g) (map_rows place rows) (place w)
        (fun all cell k e by_ => apart && shows_varied bits m ends all free apart_tape apart_rows apart_w apart_g cell k e by_) (box ++ angles) (map (fun _ => true) tests) t
  | _, _, _, _, _, _ => false
  end.

(** ** Soundness *)

Definition stands (x theta : list R) (k : motion) (P : vec) (Q : mat) (W r L : R) (row : list formula * formula) (l : strut) : Prop :=
  let (A, D) := row in
  (0 < Formula.value x theta D -> 0 < norm2 (strut_vector l P Q) /\
    exists q, q ^ 2 = W * Formula.value x theta D /\ forall v, Linear.dot (map (Formula.value x theta) A) v = q * Linear.dot (strut_row k L l P Q) v) /\
  Formula.value x theta D = W * r ^ 2 * norm2 (strut_vector l P Q) /\
  (Formula.value x theta D = 0 -> forall v, Linear.dot (map (Formula.value x theta) A) v = 0) /\ length A = dimension k.

Definition are_numbers (front : list R) (a : evec) (v : vec) : Prop :=
  (forall x back, val3 x (front ++ back) a = v) /\ forall x theta, Forall (Formula.defined x theta) (list_of a).
Definition strut_numbers (s : Z) (m : list strut) : list R :=
  flat_map (fun l => coordinates (vscale (/ two_to s) (strut_base l)) ++ coordinates (vscale (/ two_to s) (strut_joint l))) m.
Lemma each_strut_stands : forall s ts m, Forall2 is_strut ts m -> exists th, (th = strut_numbers s m /\ Forall2 scaled_within (flat_map (strut_layout s) ts) th) /\
  forall A (f : evec -> evec -> A) (good : A -> strut -> Prop) front,
    (forall a b l, are_numbers (front ++ th) a (vscale (/ two_to s) (strut_base l)) -> are_numbers (front ++ th) b (vscale (/ two_to s) (strut_joint l)) -> good (f a b) l) ->
    Forall2 good (each_strut f s ts (length front)) m.
Proof.
  intros s. induction 1 as [| t l ts m [ha hb] hs [th2 [[E2 L2] R2]]]; [exists []; split; [split; [reflexivity | constructor] | constructor] |].
  set (th1 := coordinates (vscale (/ two_to s) (strut_base l)) ++ coordinates (vscale (/ two_to s) (strut_joint l))).
  assert (L1 : Forall2 scaled_within (strut_layout s t) th1) by (apply Forall2_app; apply three_within; assumption).
  exists (th1 ++ th2). split; [split; [unfold strut_numbers; cbn [flat_map]; fold (strut_numbers s m); rewrite E2; reflexivity | cbn [flat_map]; apply Forall2_app; assumption] |].
  intros A f good front h. rewrite app_assoc in h. cbn [each_strut]. cbv zeta. constructor.
  - assert (Own : forall i v, Vec (nth i th1 0) (nth (1 + i) th1 0) (nth (2 + i) th1 0) = v -> are_numbers ((front ++ th1) ++ th2) (vector_at (numbered (length front) (strut_layout s t)) i) v).
    { intros i v <-. split.
      - intros x back. rewrite <- !app_assoc. pose proof (numbered_values _ _ x front (th2 ++ back) L1) as V.
        unfold val3, vector_at. cbn [ex ey ez]. rewrite <- !(map_nth (Formula.value x (front ++ th1 ++ th2 ++ back))), V. reflexivity.
      - intros x theta. assert (D : forall l j, Forall (Formula.defined x theta) (numbered j l)).
        { induction l0 as [| q l' IH]; intro j; cbn [numbered]; constructor; [| apply IH]. unfold quantity. destruct (small q); cbn; auto. }
        assert (N : forall j, Formula.defined x theta (nth j (numbered (length front) (strut_layout s t)) (integer 0))).
        { intro j. destruct (nth_in_or_default j (numbered (length front) (strut_layout s t)) (integer 0)) as [i' | ->]; [| cbn; auto].
          pose proof (D (strut_layout s t) (length front)) as F0. rewrite Forall_forall in F0. exact (F0 _ i'). }
        unfold vector_at, list_of. cbn [ex ey ez]. repeat apply Forall_cons; try apply Forall_nil; apply N. }
    apply h; apply Own; reflexivity.
  - specialize (R2 A f good (front ++ th1)). rewrite app_length, <- (related_length _ _ _ _ _ L1) in R2. exact (R2 h).
Qed.

Definition strut_stands (x theta : list R) (k : motion) (P : vec) (Q : mat) (W r L : R) (z : posed_strut) (l : strut) : Prop :=
  stands x theta k P Q W r L (z_row z) l /\ is_lever x theta k P Q W r L l (z_lever z) /\
  (forall on, val3 x theta (z_way z on) = vscale (W * r) (if on then mulv (transpose Q) (strut_vector l P Q) else strut_vector l P Q)) /\
  rod_stands x theta r (Some (z_limb z)) (Some (vadd P (arm_of_joint l Q), strut_vector l P Q, strut_length l P Q)) /\
  (0 < norm2 (strut_vector l P Q) -> let t := z_bend z tt in let at_ := Formula.value x theta in map at_ (bend_row t) = strut_row k L l P Q /\
    Linear.dot (strut_row k L l P Q) (strut_row k L l P Q) <= at_ (bend_square t) - at_ (bend_along t) ^ 2 /\
    forall v a, strut_accelerates k L l P Q v a (Linear.dot (strut_row k L l P Q) a + r / 2 * quad (map (map at_) (bend_twice t)) v)).

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

Lemma all_some_back : forall (A : Type) (l : list (option A)) m a, all_some l = Some m -> In a m -> In (Some a) l.
Proof.
  intros A. induction l as [| o l IH]; intros m a e i; cbn [all_some] in e; [injection e as <-; contradiction |].
  destruct o as [b |]; [| discriminate]. destruct (all_some l) as [r |]; [| discriminate]. injection e as <-. destruct i as [-> | i]; [left; reflexivity | right; exact (IH r a eq_refl i)].
Qed.
Lemma of_each_back : forall (A : Type) (f : list formula -> demand -> list A) are_angles s ds j a, In a (of_each f are_angles s j ds) -> exists q d, In a (f q d).
Proof.
  intros A f are_angles s. induction ds as [| d ds IH]; intros j a i; [contradiction |]. cbn [of_each] in i. apply in_app_or in i as [i | i]; [eauto | exact (IH _ _ i)].
Qed.

(** Where ends alone are looked at, it is of these rows. *)
Lemma least_tests : forall s k N w zs ell ps place plain ends ends_for q d t r v e, In (Some t) (tests_of_demand s k N w zs ell ps place plain ends ends_for q d) -> with_ends t = Some (r, v, e) ->
  e = O \/ e = ends /\ r = map_rows place (map z_row zs) /\ v = place w.
Proof.
  intros s k N w zs ell ps place plain ends ends_for q d t r v e i we.
  assert (Near : forall error b angle, In (Some t) (near_tests s k w zs ell ps place plain ends_for q error b angle) -> with_ends t = None).
  { intros error b angle h. unfold near_tests in h. destruct (_ && _ && _ && _ && _); [| destruct h as [h | []]; discriminate].
    destruct (enclose_parameter bits _); [| destruct h as [h | []]; discriminate]. destruct (enclose_tangent bits angle); [| destruct h as [h | []]; discriminate].
    destruct (all_some _); [| destruct h as [h | []]; discriminate]. cbv zeta in h.
    destruct k; cbn [In] in h; repeat (destruct h as [h | h]; [injection h as <-; reflexivity |]); contradiction. }
  assert (Angles : forall z on b, In (Some t) (map Some (angle_tests N w place plain q z on b)) -> with_ends t = None).
  { intros z on b h. apply in_map_iff in h as [u [eu h]]. injection eu as ->. unfold angle_tests in h. destruct (up_to_90 b).
    - destruct (angle_row q (z_way z on)). destruct h as [<- | h]; [reflexivity |]. destruct (certainly _ _ _); [contradiction | destruct h as [<- | []]; reflexivity].
    - destruct h as [<- | []]. reflexivity. }
  destruct d; cbn [tests_of_demand] in i; try (rewrite (Near _ _ _ i) in we; discriminate);
    try (destruct (nth_error zs _) as [z |]; [| destruct i as [i | []]; discriminate]; destruct (is_axis _ && _ && _); [| destruct i as [i | []]; discriminate]; rewrite (Angles _ _ _ i) in we; discriminate);
    destruct i as [i | []]; cbn [pose_test_of] in i; try discriminate; try (destruct (length_sign _ _ _ _); [cbn [option_map] in i | discriminate]);
    try (destruct (nth_error _ _) as [? |]; [| discriminate]); try (destruct (lever_of _ _ _) as [[? ?] |]; [| discriminate]); try (destruct (limb_segments _ _ _ _ _ _ _) as [[[? ?] [? ?]] |]; [| discriminate]);
    try (destruct (certainly _ _ _ && _); [| discriminate]);
    try (destruct (enclose_parameter bits _); [cbn [option_map] in i |]; try discriminate); try (destruct (0 <=? lo _)%Z; [| discriminate]); cbv zeta in i; injection i as <-; cbn [with_ends] in we; try discriminate;
    injection we; intros; subst; auto.
Qed.

Lemma nominal_is : forall s ts m, Forall2 is_strut ts m -> Forall2 is_strut ts (nominal_struts ts) /\ strut_numbers s (nominal_struts ts) = map middle_of (flat_map (strut_layout s) ts).
Proof.
  intros s. induction 1 as [| t l ts m [ha hb] hs [I1 I2]]; [split; [constructor | reflexivity] |]. cbn [nominal_struts map]. split.
  - constructor; [split; cbn [strut_base strut_joint]; eapply middles_within; eassumption | exact I1].
  - unfold strut_numbers. cbn [flat_map strut_base strut_joint]. fold (strut_numbers s (nominal_struts ts)). unfold nominal_struts in I2. unfold strut_layout at 1. rewrite !map_app, !middles_three, <- I2. reflexivity.
Qed.
Lemma near_coordinates : forall k P r cs d tau u theta, let x := map (Rmult r) (position_list k P) ++ cs in is_position k P -> length x = dimension k -> length u = dimension k ->
  let x' := near_point (first_angle k) x (r * d) tau u in
  val3 x' theta (eposition k) = vscale r (position_at k P d u) /\ (forall i, (i < length cs)%nat -> nth (first_angle k + i) x' 0 = nth i cs 0) /\
  val3 x' theta (spin_formulas k (dimension k)) = vscale tau (spin_of k u).
Proof.
  intros k [p1 p2 p3] r cs d tau u theta x hp lx lu x'. unfold x', x, near_point, Near.moved, position_at. clear x'. unfold x in lx. clear x.
  destruct k; cbn [position_list is_position first_angle dimension map vx vy vz app length] in *.
  - subst p3. destruct cs as [| c1 [|]]; try discriminate. destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. unfold val3, eposition, spin_formulas, shift_of, spin_of, vadd, vscale. cbn.
    repeat split; [f_equal; ring | intros [| i] l; [reflexivity | lia] | f_equal; ring].
  - destruct cs as [| c1 [| c2 [| c3 [|]]]]; try discriminate. destruct u as [| u1 [| u2 [| u3 [| u4 [| u5 [| u6 [|]]]]]]]; try discriminate. unfold val3, eposition, point, spin_formulas, shift_of, spin_of, vadd, vscale. cbn.
    repeat split; [f_equal; ring | intros [| [| [| i]]] l; try reflexivity; lia | f_equal; ring].
  - injection hp as -> -> ->. destruct cs as [| c1 [| c2 [| c3 [|]]]]; try discriminate. destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. unfold val3, eposition, spin_formulas, shift_of, spin_of, vadd, vscale, vzero. cbn.
    repeat split; [f_equal; ring | intros [| [| [| i]]] l; try reflexivity; lia | f_equal; ring].
Qed.

Lemma whole_defined : forall x th f, is_polynomial [] [] f = true -> Formula.defined x th f.
Proof.
  intros x th. fix IH 1. intros [o] h. destruct o as [i | i | n | a b | a b | a | a b | a b | a | a | ? a b e]; cbn [is_polynomial] in h; try discriminate h;
    cbn [Formula.defined map_op defined_op all_op]; try (split; exact I); try (apply andb_true_iff in h as [h1 h2]; split; [exact I | split; [exact (IH a h1) | exact (IH b h2)]]);
    try (split; [exact I | exact (IH a h)]).
  apply andb_true_iff in h as [_ h]. destruct b as [[| [|] | | | | | | | | |]]; discriminate h.
Qed.
Lemma values_at : forall (g : nat -> R) (val : formula -> R) (at_ : formula -> nat) (hs : list (fixed * nat)) l, map snd hs = map at_ l -> (forall e, In e l -> g (at_ e) = val e) -> map (fun h => g (snd h)) hs = map val l.
Proof. intros g val at_ hs l e h. rewrite <- (map_map snd g), e, map_map. apply map_ext_in, h. Qed.
Lemma combine_back : forall (A B : Type) (l : list (A * B)), combine (map fst l) (map snd l) = l.
Proof. induction l as [| [a b] l IH]; [reflexivity |]. cbn [map combine fst snd]. rewrite IH. reflexivity. Qed.

Lemma motion_dec : forall k : motion, k = AboutPoint \/ k <> AboutPoint.
Proof. intros []; [right; discriminate | right; discriminate | left; reflexivity]. Qed.

Lemma near_is : forall s k N w zs ell ps place plain ends ends_for q d a, In (Some (NearOf a)) (tests_of_demand s k N w zs ell ps place plain ends ends_for q d) ->
  n_ends a = ends_for (n_rows a) /\ n_weight a = place w.
Proof.
  intros s k N w zs ell ps place plain ends ends_for q d a i.
  assert (Angles : forall z on b, ~ In (Some (NearOf a)) (map Some (angle_tests N w place plain q z on b))).
  { intros z on b h. apply in_map_iff in h as [u [eu h]]. injection eu as ->. unfold angle_tests in h. destruct (up_to_90 b).
    - destruct (angle_row q (z_way z on)). destruct h as [h | h]; [discriminate |]. destruct (certainly _ _ _); [contradiction | destruct h as [h | []]; discriminate].
    - destruct h as [h | []]. discriminate. }
  destruct d; cbn [tests_of_demand] in i;
    try (destruct (nth_error zs _) as [z |]; [| destruct i as [i | []]; discriminate]; destruct (is_axis _ && _ && _); [| destruct i as [i | []]; discriminate]; destruct (Angles _ _ _ i)).
  17: { unfold near_tests in i. destruct (_ && _ && _ && _ && _); [| destruct i as [i | []]; discriminate].
    destruct (enclose_parameter bits _); [| destruct i as [i | []]; discriminate]. destruct (enclose_tangent bits angle); [| destruct i as [i | []]; discriminate].
    destruct (all_some _); [| destruct i as [i | []]; discriminate]. cbv zeta in i.
    destruct k; cbn [In] in i; repeat (destruct i as [i | i]; [injection i as <-; split; reflexivity |]); contradiction. }
  all: destruct i as [i | []]; cbn [pose_test_of] in i; try discriminate; try (destruct (length_sign _ _ _ _); [cbn [option_map] in i | discriminate]);
    try (destruct (nth_error _ _) as [? |]; [| discriminate]); try (destruct (lever_of _ _ _) as [[? ?] |]; [| discriminate]); try (destruct (limb_segments _ _ _ _ _ _ _) as [[[? ?] [? ?]] |]; [| discriminate]);
    try (destruct (certainly _ _ _ && _); [| discriminate]);
    try (destruct (enclose_parameter bits _); [cbn [option_map] in i |]; try discriminate); try (destruct (0 <=? lo _)%Z; [| discriminate]); cbv zeta in i; discriminate.
Qed.

(** An angle whose cosine is not less than that of the greatest. *)
Lemma angle_found : forall A a b, 0 < norm2 A -> 0 < norm2 a -> 0 <= b <= 180 -> cos (in_degrees b) * (sqrt (norm2 A) * sqrt (norm2 a)) <= Vec3.dot A a ->
  exists angle, 0 <= angle <= b /\ Vec3.dot A a = sqrt (norm2 A) * sqrt (norm2 a) * cos (in_degrees angle).
Proof.
  intros A a b hA ha [b0 b1] h. pose proof PI_RGT_0 as p0. pose proof (sqrt_lt_R0 _ hA) as sA. pose proof (sqrt_lt_R0 _ ha) as sa. set (p := sqrt (norm2 A) * sqrt (norm2 a)) in *.
  assert (pp : 0 < p) by (apply Rmult_lt_0_compat; assumption).
  assert (P2 : p ^ 2 = norm2 A * norm2 a) by (unfold p; rewrite Rpow_mult_distr, !pow2_sqrt by lra; reflexivity).
  pose proof (cauchy_schwarz A a) as C. rewrite <- P2 in C. set (D := Vec3.dot A a) in *. clearbody D.
  assert (C1 : -1 <= D / p <= 1) by (split; apply Rmult_le_reg_r with p; try exact pp; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; nra).
  destruct (cosine_taken _ C1) as [d [[d0 d1] ec]].
  assert (E : in_degrees (d * 180 / PI) = d) by (unfold in_degrees; field; lra).
  exists (d * 180 / PI). rewrite E, ec. split; [split | field; lra].
  - apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat, p0].
  - assert (L : cos (in_degrees b) <= cos d) by (rewrite ec; apply Rmult_le_reg_r with p; [exact pp |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
    assert (R0 : 0 <= in_degrees b <= PI) by (unfold in_degrees; split; nra).
    assert (dB : d <= in_degrees b) by (apply Rnot_lt_le; intro n; pose proof (cos_decreasing_1 _ _ (proj1 R0) (proj2 R0) d0 d1 n); lra).
    apply Rmult_le_reg_r with (PI / 180); [lra |]. replace (d * 180 / PI * (PI / 180)) with d by (field; lra). unfold in_degrees in dB. lra.
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
  set (pl := (exactly (characteristic_length c), s)) in *. set (j := S (length lay)) in *. set (ell := quantity pl (length lay)) in *. set (ins := flat_map (inputs_of false s) ds) in *.
  set (zs := each_strut (formulas_of k N w ell (length lay)) s ts 0) in *. set (rows := map z_row zs) in *.
  set (g := curve (turned c) (first_angle k) (j + length ins)) in *. set (gs := match g with Some g => [g] | None => [] end) in *.
  set (about := if one_pose c then each_strut (fun a b => origin_row k a (scaled_row k N w ell a b)) s ts 0 else []) in *.
  set (wanted := entries rows ++ w :: of_each (own_formulas k w zs ell (lay ++ [pl])) false s j ds ++ gs ++ entries about) in *. set (others := of_each (plain_formulas k N w zs (lay ++ [pl])) false s j ds) in *.
  set (tape := compile (map (image (dimension k)) wanted)) in *. set (place := fun f => Formula.place (formulas tape) (image (dimension k) f)) in *.
  set (plain := compile others) in *. set (plain_place := Formula.place (formulas plain)) in *.
  apply andb_true_iff in h as [h C]. apply andb_true_iff in h as [h ang]. apply andb_true_iff in h as [h L0].
  apply andb_true_iff in h as [h flat]. apply andb_true_iff in h as [h below_half]. apply andb_true_iff in h as [h ex]. apply andb_true_iff in h as [h there]. apply andb_true_iff in h as [found below_].
  destruct (all_some (map (enclose_parameter bits) _)) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map (enclose_input bits) _)) as [inputs |] eqn:ei; [| discriminate].
  destruct (all_some (map _ (position_tolerances _ _))) as [box |] eqn:eb; [| discriminate].
  destruct (all_some (map (end_box bits) _)) as [angles |] eqn:ea; [| discriminate].
  destruct (all_some (map (enclose_tangent bits) _)) as [tangents |] eqn:eg; [| discriminate].
  destruct (all_some (of_each _ _ _ _ _)) as [tests |] eqn:et; [| discriminate].
  cbv zeta in C. set (all_tests := if one_pose c then inserted _ _ _ else tests) in C.
  assert (Sub : forall u, In u tests -> In u all_tests) by (intros u iu; unfold all_tests; destruct (one_pose c); [apply inserted_in; right |]; exact iu).
  assert (Own : forall u, In u all_tests -> In u tests \/ with_ends u = None)
    by (intros u iu; unfold all_tests in iu; destruct (one_pose c); [apply inserted_in in iu as [-> | iu]; [right; reflexivity |] |]; left; exact iu).
  apply andb_true_iff in C as [C tree_ok]. apply andb_true_iff in tree_ok as [fits tree_ok]. apply andb_true_iff in C as [C gaff]. apply andb_true_iff in C as [len aff]. apply Nat.eqb_eq in len.
  apply positive_sound in L0. set (L := Claim.value (characteristic_length c)) in *.
  assert (ok : are_angles (turned c)).
  { unfold are_angles. rewrite forallb_forall in ang. apply Forall_forall. intros u iu. specialize (ang u iu). apply andb_true_iff in ang as [a b].
    split; apply (is_angle_number_sound bits); assumption. }
  destruct (each_strut_stands s ts m hm) as [th [[ETH TH] RS]].
  set (ts_ := map (fun a => tangent (Claim.value a)) (curved (turned c))).
  set (theta := th ++ [/ two_to s * L] ++ map input_value ins ++ ts_).
  assert (TT : Forall2 (contains bits) tangents ts_).
  { apply (tangents_in bits); [intros a i; exact (curved_angles _ a ok i) | exact eg]. }
  assert (T : Forall2 (contains bits) (params ++ inputs ++ tangents) theta).
  { unfold theta. rewrite (app_assoc th). apply Forall2_app; [| apply Forall2_app; [exact (inputs_enclosed bits _ _ ei) | exact TT]].
    apply (enclosed_all bits _ _ _ ep). apply Forall2_app; [exact TH |]. constructor; [| constructor]. exists L. split; [split; apply Rle_refl |]. cbn [snd pl]. unfold Rdiv. ring. }
  assert (lt : length th = length lay) by (symmetry; exact (related_length _ _ _ _ _ TH)).
  assert (tangent_at : forall a, In a (curved (turned c)) -> nth (j + length ins) theta 0 = tangent (Claim.value a)).
  { intros a i. unfold theta. rewrite !app_assoc. replace (j + length ins)%nat with (length ((th ++ [(/ two_to s * L)%R]) ++ map input_value ins) + 0)%nat
      by (unfold j; rewrite !app_length, map_length, lt; cbn [length]; lia).
    rewrite app_nth2_plus. unfold ts_. destruct (turned c); cbn [curved] in *; try contradiction; destruct i as [-> | []]; reflexivity. }
  (* at one pose *)
  enough (At : forall P Q, in_region (positions c) P /\ in_orientations (turned c) Q -> meets_turning c m P Q /\ (one_pose c = true ->
    forall v, length v = dimension k -> nonzero v -> 0 < form (lower_weights (fst one_matrix) (snd one_matrix) v) (map (fun l => (about_origin (Legs.Turns k) (/ two_to s) l P Q, 0)) m) v)).
  { split; [exact (proj1 (At P Q hPQ)) |]. intros o P' Q' hP' hQ' same. rewrite o in below_half. destruct hPQ as [hP hQ].
    destruct (turns_less_sound _ bits _ _ Q Q' below_half hQ hQ') as [v [tv mv]].
    apply (poses_differ (Legs.Turns k) (/ two_to s) (fst one_matrix) (snd one_matrix) m P Q P' Q' v); try assumption; try exact (proj2 (At P Q (conj hP hQ)) o); try exact (proj2 (At P' Q' (conj hP' hQ')) o).
    - apply Rinv_neq_0_compat, Rgt_not_eq, two_to_pos.
    - exact (flat_position k _ P flat (hull_sound _ _ hP)).
    - exact (flat_position k _ P' flat (hull_sound _ _ hP')). }
  clear P Q hPQ. intros P Q [hP hQ]. apply hull_sound in hP. destruct (chart_sound _ _ hQ ok) as [cs [W [hcs [W0 CH]]]].
  set (x := map (Rmult (/ two_to s)) (position_list k P) ++ cs).
  assert (X : Forall2 (contains bits) (box ++ angles) x) by (apply Forall2_app; [exact (position_boxes k _ P s box hP eb) | exact (box_sound bits _ cs angles ok hcs ea)]).
  assert (lx : length x = dimension k) by (rewrite <- (related_length _ _ _ _ _ X); exact len).
  assert (first : forall i, nth (first_angle k + i) x 0 = nth i cs 0).
  { intro i. unfold x. replace (first_angle k) with (length (map (Rmult (/ two_to s)) (position_list k P))) by (destruct k; reflexivity). apply app_nth2_plus. }
  destruct (CH x theta (first_angle k) (j + length ins)%nat (fun i _ => first i) tangent_at) as [hN [hw hg]]. rewrite ch in hN, hw. cbn [fst snd] in hN, hw.
  assert (hl : Formula.value x theta ell = / two_to s * L).
  { unfold ell, theta. apply quantity_value; [exists L; split; [split; apply Rle_refl | cbn [snd pl]; unfold Rdiv; ring] |].
    rewrite <- lt. apply nth_middle. }
  set (ratio := / two_to s) in *. assert (r0 : 0 < ratio) by apply Rinv_0_lt_compat, two_to_pos.
  pose proof (orientation_keeps _ _ hQ) as keeps. assert (hPv : val3 x theta (eposition k) = vscale ratio P) by exact (position_value k P _ cs _ (flat_position _ _ _ flat hP)).
  assert (ZS : Forall2 (strut_stands x theta k P Q W ratio L) zs m).
  { apply (RS _ _ _ []). intros a b l [Ha Da] [Hb _]. cbn [app] in Ha, Hb. pose proof (Ha x ([ratio * L] ++ map input_value ins ++ ts_)) as hsa. pose proof (Hb x ([ratio * L] ++ map input_value ins ++ ts_)) as hsb. fold theta in hsa, hsb.
    split; [exact (scaled_row_speed x theta k P Q W ratio L N a b w ell l r0 W0 L0 keeps hPv hN hw hl hsa hsb) |].
    split; [exact (lever_values x theta k P Q W ratio L N a b w ell l keeps hPv hN hw hl hsa hsb) |].
    split; [exact (way_values x theta k P Q W ratio N a b w l keeps hPv hN hw hsa hsb) |].
    pose proof (limb_values x theta k P Q W ratio N a b w l r0 W0 hPv hN hw hsa hsb) as LV. split; [exact LV |]. intro reach_. cbv zeta. cbn [z_bend formulas_of].
    destruct (limb k N w a b) as [[C A] len_] eqn:el. cbn [rod_stands] in LV. destruct LV as [C' [A' [n' [e1 [e2 [e3 e4]]]]]]. injection e1 as <- <- <-.
    assert (hn : (length lay <= length theta)%nat) by (unfold theta; rewrite app_length, lt; lia).
    assert (hf : firstn (length lay) theta = th) by (unfold theta; rewrite firstn_app, lt, Nat.sub_diag, <- lt, firstn_all; apply app_nil_r).
    assert (ha' : forall back, val3 x (firstn (length lay) theta ++ back) a = vscale ratio (strut_base l)) by (intro back; rewrite hf; apply Ha).
    pose proof (turned_values x theta Q W ratio N w W0 hN hw b (strut_joint l) hsb) as hr. fold (arm_of_joint l Q) in hr.
    assert (hh : val3 x theta (map2 minus (eposition k) a) = vscale ratio (vsub P (strut_base l))) by (rewrite val3_minus, hPv, hsa; apply vsub_vscale).
    split; [exact (bend_row_is x theta (length lay) k l P Q ratio L ell a b _ C A len_ _ r0 L0 hl hr (eq_sym e3) (eq_sym e4) hh reach_) |].
    split; [exact (bend_lever x theta (length lay) k l P Q ratio L ell a b _ C A len_ _ r0 L0 keeps hl hsb hr (eq_sym e3) (eq_sym e4) reach_) |].
    exact (bend_accelerates x theta (length lay) k l P Q ratio L ell a b _ C A len_ _ r0 L0 hn ha' Da hl hr (eq_sym e2) (eq_sym e3) (eq_sym e4) reach_). }
  assert (ST : Forall2 (stands x theta k P Q W ratio L) rows m)
    by (unfold rows; clear - ZS; induction ZS as [| z l zs' m' [h _] hs IH]; constructor; assumption).
  set (scale := origin_scale k W ratio L). assert (scale0 : 0 < scale) by exact (origin_scale_pos k W ratio L r0 W0 L0).
  assert (ORIGIN : map (fun row => map (Formula.value x theta) (fst row)) (each_strut (fun a b => origin_row k a (scaled_row k N w ell a b)) s ts 0) =
    map (fun l => map (Rmult scale) (about_origin (Legs.Turns k) ratio l P Q)) m).
  { assert (F : Forall2 (fun row l => map (Formula.value x theta) (fst row) = map (Rmult scale) (about_origin (Legs.Turns k) ratio l P Q)) (each_strut (fun a b => origin_row k a (scaled_row k N w ell a b)) s ts 0) m).
    { apply (RS _ _ _ []). intros a b l [Ha _] [Hb _]. cbn [app] in Ha, Hb. pose proof (Ha x ([ratio * L] ++ map input_value ins ++ ts_)) as hsa. pose proof (Hb x ([ratio * L] ++ map input_value ins ++ ts_)) as hsb. fold theta in hsa, hsb.
      exact (origin_row_values x theta k P Q W ratio L N a b w ell l r0 L0 keeps hPv hN hw hl hsa hsb (flat_position k _ P flat hP)). }
    clear - F. induction F as [| row l rs m' h hs IH]; [reflexivity |]. cbn [map]. rewrite h, IH. reflexivity. }
  (* the tape *)
  rewrite forallb_forall in found, below_, there.
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
  set (ends_for := fun r : Test.rows nat => match positions c with Box _ => ends_of (formulas tape) (dimension k) k r (place w) (option_map place g) | _ => O end).
  change (all_some (of_each (tests_of_demand s k N w zs ell (lay ++ [pl]) place plain_place ends ends_for) false s j ds) = Some tests) in et.
  assert (LT : forall u r v e, In u tests -> with_ends u = Some (r, v, e) -> e = O \/ e = ends /\ r = map_rows place rows /\ v = place w).
  { intros u r v e i we. destruct (of_each_back _ _ _ _ _ _ _ (all_some_back _ _ _ _ et i)) as [q [d iq]]. exact (least_tests s k N w zs ell (lay ++ [pl]) place plain_place ends _ q d u r v e iq we). }
  assert (eased : forall u r v e, In u all_tests -> with_ends u = Some (r, v, e) -> e = O \/ length r = dimension k /\ is_eased tape (dimension k) e r v None = true /\
    forall i n places, option_map place g = Some i -> is_eased tape (dimension k) e r v (Some (i, n, places)) = true).
  { intros u r v e0 i we. destruct (Own u i) as [i1 | no]; [| congruence]. destruct (LT u r v _ i1 we) as [-> | [-> [-> ->]]]; [left; reflexivity |].
    clear fits tree_ok. unfold ends, ends_of. cbv zeta. destruct (positions c); [| left; reflexivity]. destruct (Nat.eqb _ _ && _) eqn:e; [right | left; reflexivity]. apply andb_true_iff in e as [e1 e2]. apply Nat.eqb_eq in e1.
    split; [exact e1 |]. clear - e2. destruct g as [f |]; cbn [option_map] in *.
    - split; [| intros i n places e; injection e as <-; exact e2]. unfold is_eased, eased_in in *. cbv zeta in *. rewrite forallb_forall in *. intros y iy. specialize (e2 y iy).
      apply andb_true_iff in e2 as [e2 _]. apply andb_true_iff. split; [exact e2 | reflexivity].
    - split; [exact e2 | discriminate]. }
  assert (easedN : forall a, In (NearOf a) all_tests -> n_ends a = O \/ is_eased tape (dimension k) (n_ends a) (n_rows a) (n_weight a) None = true /\
    forall i n places, option_map place g = Some i -> is_eased tape (dimension k) (n_ends a) (n_rows a) (n_weight a) (Some (i, n, places)) = true).
  { intros a i. assert (i1 : In (NearOf a) tests) by (unfold all_tests in i; destruct (one_pose c); [apply inserted_in in i as [i | i]; [discriminate | exact i] | exact i]).
    destruct (of_each_back _ _ _ _ _ _ _ (all_some_back _ _ _ _ et i1)) as [q [d iq]]. destruct (near_is s k N w zs ell (lay ++ [pl]) place plain_place ends ends_for q d a iq) as [-> ->].
    clear fits tree_ok. unfold ends_for, ends_of. cbv zeta. destruct (positions c); [| left; reflexivity]. destruct (Nat.eqb _ _ && _) eqn:e; [right | left; reflexivity]. apply andb_true_iff in e as [_ e2].
    clear - e2. destruct g as [f |]; cbn [option_map] in *.
    - split; [| intros i n places e; injection e as <-; exact e2]. unfold is_eased, eased_in in *. cbv zeta in *. rewrite forallb_forall in *. intros y iy. specialize (e2 y iy).
      apply andb_true_iff in e2 as [e2 _]. apply andb_true_iff. split; [exact e2 | reflexivity].
    - split; [exact e2 | discriminate]. }
  assert (turn : is_turned tape all_tests (option_map place g) theta x).
  { split; [| intros u r v e i we; destruct (Own u i) as [i1 | no]; [| congruence]; destruct (LT u r v _ i1 we) as [-> | [-> [-> ->]]]; [left; reflexivity | right]; split;
      [rewrite Rows; exact (rows_grounded x theta k P Q W _ L rows m W0 ST) | rewrite Weight; exact W0]].
    intros i e. destruct g as [f |] eqn:eg'; [| discriminate]. injection e as <-. rewrite Found; [apply hg; exact eg' |].
    apply in_or_app. right. right. apply in_or_app. right. left. reflexivity. }
  cbv zeta in fits, tree_ok. set (apart := has_apart t) in *. set (multis := if apart then own_multis _ _ _ else []) in *. set (apart_tape := if apart then compile _ else []) in *.
  assert (VH : forall all, Forall2 (contains bits) all theta -> are_above (params ++ inputs ++ tangents) all -> forall cell y k' e by_, In (LeastOf (map_rows place rows) (place w) k' e) all_tests -> Forall2 (contains bits) cell y -> length cell = dimension k ->
    is_turned tape all_tests (option_map place g) theta y -> apart && shows_varied bits (dimension k) ends all (free_struts s ts) apart_tape
      (map_multis (Formula.place (formulas apart_tape)) (Formula.place (formulas apart_tape)) multis) (Formula.place (formulas apart_tape) (image (dimension k) w))
      (option_map (fun g => Formula.place (formulas apart_tape) (image (dimension k) g)) g) cell k' e by_ = true ->
    test_holds bits tape plain (params ++ inputs ++ tangents) (dimension k) (dimension k) theta y (LeastOf (map_rows place rows) (place w) k' e)).
  { intros all TA RA cell y k' e by_ it hy ly [hg' hturn] h'. apply andb_true_iff in h' as [ha h']. rewrite ha in fits. cbn [negb orb] in fits. apply andb_true_iff in fits as [lr fit]. apply Nat.eqb_eq in lr.
    assert (eF : multis = own_multis (dimension k) rows (free_struts s ts)) by (unfold multis; rewrite ha; reflexivity). rewrite eF in fit, h'. apply (fit_above (dimension k) ends rows w g _ all (free_struts s ts) _ _ RA) in fit.
    assert (ly' : length y = dimension k) by (rewrite <- (related_length _ _ _ _ _ hy); exact ly).
    assert (FoundY : forall f, In f wanted -> at_pairs theta (entry_at tape (place f)) (parabola y) = Formula.value y theta f).
    { intros f i. assert (E : entry_at tape (place f) = image (dimension k) f) by (apply Formula.same_sound, found, i). rewrite E, <- ly'. apply image_value. rewrite ly'. apply below_, i. }
    assert (RowsY : map_rows (fun i => at_pairs theta (entry_at tape i) (parabola y)) (map_rows place rows) = map_rows (Formula.value y theta) rows).
    { assert (G : forall r, (forall f, In f (entries r) -> In f wanted) -> map_rows (fun i => at_pairs theta (entry_at tape i) (parabola y)) (map_rows place r) = map_rows (Formula.value y theta) r).
      { induction r as [| [A D] r IH]; intro i; [reflexivity |]. rewrite !map_rows_cons. f_equal.
        - f_equal; [rewrite map_map; apply map_ext_in; intros f q; apply FoundY, i; cbn [entries flat_map fst]; apply in_or_app; left; apply in_or_app; left; exact q |].
          apply FoundY, i. cbn [entries flat_map snd]. apply in_or_app. left. apply in_or_app. right. left. reflexivity.
        - apply IH. intros f q. apply i. cbn [entries flat_map]. apply in_or_app. right. exact q. }
      apply G. intros f q. apply in_or_app. left. exact q. }
    assert (iw : In w wanted) by (apply in_or_app; right; left; reflexivity).
    assert (ig : forall f, g = Some f -> In f wanted) by (intros f ef; unfold wanted, gs; rewrite ef; apply in_or_app; right; right; apply in_or_app; right; left; reflexivity).
    (* ends alone *)
    assert (e1 : e = ends /\ (0 < ends)%nat).
    { unfold shows_varied in h'. apply andb_true_iff in h' as [h' _]. apply andb_true_iff in h' as [q1 q2].
      apply Nat.eqb_eq in q1. apply Nat.ltb_lt in q2. split; assumption. }
    destruct e1 as [ee e0]. destruct (hturn _ _ _ _ it eq_refl) as [z | [gr w1]]; [lia |]. cbv zeta in gr, w1. rewrite RowsY in gr. rewrite (FoundY w iw) in w1.
    intros kappa v hk k0 lv nz. cbv zeta. rewrite RowsY, (FoundY w iw).
    apply (shows_varied_sound bits (dimension k) ends rows w g all (free_struts s ts) apart_tape fit theta cell y TA hy ly k' e by_ kappa h' lr gr w1); try assumption.
    - intros f ef _. rewrite <- (FoundY f (ig f ef)). apply hg'. rewrite ef. reflexivity.
    - apply below_, iw.
    - destruct g as [f |]; [apply below_, ig; reflexivity | reflexivity]. }
  pose proof (check_poses_sound bits tape plain (params ++ inputs ++ tangents) all_tests (dimension k) (dimension k) (option_map place g) (map_rows place rows) (place w) _ theta T aff gaff' easedN eased VH t _ x tree_ok X len turn) as HT0.
  pose proof (fun u iu => HT0 u (Sub u iu)) as HT.
  assert (Speed : positive_D (map_rows (Formula.value x theta) rows) -> Forall (fun l => 0 < norm2 (strut_vector l P Q)) m /\
    forall v, energy (map_rows (Formula.value x theta) rows) v = W * Configuration.speed2 (map (fun l => strut_row k L l P Q) m) v)
    by (apply (rows_speed x theta k P Q W ratio L); exact ST).
  assert (Z : forall v, ~ nonzero v -> Linear.dot v v = 0 /\ Configuration.speed2 (map (fun l => strut_row k L l P Q) m) v = 0).
  { intros v z. pose proof (zero_vector v ltac:(apply Rnot_lt_le; exact z)) as F0. split; [apply dot_zero, F0 |].
    generalize (map (fun l => strut_row k L l P Q) m). intro M. unfold Configuration.speed2. induction M as [| row M IH]; cbn [fold_right]; [reflexivity |]. rewrite IH, (dot_zero v row F0). ring. }
  assert (NZ : forall v, nonzero v \/ ~ nonzero v) by (intro v; destruct (Rlt_dec 0 (Linear.dot v v)); auto).
  set (conf := struts_at k L (nominal_struts ts) m P Q).
  assert (Lower : forall low kappa, contains bits low kappa -> 0 <= kappa -> In (LeastOf (map_rows place rows) (place w) low ends) tests ->
    Forall (fun l => 0 < norm2 (strut_vector l P Q)) m /\ positive_D (map_rows (Formula.value x theta) rows) /\
    forall v, length v = dimension k -> nonzero v -> kappa * Linear.dot v v < Configuration.speed2 (jacobian conf) v).
  { intros low kappa hk k0 it. pose proof (HT _ it) as H. cbn [test_holds] in H.
    assert (PD : positive_D (map_rows (Formula.value x theta) rows)).
    { assert (U : exists v, length v = dimension k /\ nonzero v) by (exists (repeat 1 (dimension k)); destruct k; (split; [reflexivity | unfold nonzero; cbn; lra])).
      destruct U as [v [lv nv]]. destruct (H kappa v hk k0 lv nv) as [p _]. rewrite Rows in p. exact p. }
    destruct (Speed PD) as [R1 R2]. split; [exact R1 |]. split; [exact PD |]. intros v lv nv. destruct (H kappa v hk k0 lv nv) as [_ q]. rewrite Rows, Weight, R2 in q.
    apply Rmult_lt_reg_l with W; [exact W0 |]. cbn [jacobian conf struts_at]. unfold conf, struts_at. cbn [jacobian]. lra. }
  assert (Test : forall d, In d ds -> exists q, (forall y, map (Formula.value y theta) q = map input_value (inputs_of false s d)) /\
    (forall f, In f (own_formulas k w zs ell (lay ++ [pl]) q d) -> In f wanted) /\ (forall f, In f (plain_formulas k N w zs (lay ++ [pl]) q d) -> formula_at plain (plain_place f) = f) /\
    forall o, In o (tests_of_demand s k N w zs ell (lay ++ [pl]) place plain_place ends ends_for q d) -> exists u, o = Some u /\ In u tests).
  { intros d id. destruct (of_each_anywhere false s ds d (th ++ [ratio * L]) ts_ id) as [q [q1 q2]]. cbv zeta in q1. fold ins in q1. rewrite <- app_assoc in q1. fold theta in q1.
    rewrite app_length, lt in q2. cbn [length] in q2. rewrite Nat.add_1_r in q2. fold j in q2. exists q. split; [exact q1 |].
    split; [intros f i; apply in_or_app; right; right; apply in_or_app; left; exact (q2 _ _ _ i) |].
    split; [intros f i; apply Formula.same_sound, there; exact (q2 _ _ _ i) |]. intros o i. exact (all_some_in _ _ _ _ et (q2 _ _ _ i)). }
  assert (Reach : exists low kappa, contains bits low kappa /\ 0 <= kappa /\ In (LeastOf (map_rows place rows) (place w) low ends) tests).
  { apply existsb_exists in ex as [d [id e]]. destruct (Test d id) as [q [_ [_ [_ shown]]]]. destruct d; try discriminate; cbn [tests_of_demand] in shown;
      destruct (shown _ (or_introl eq_refl)) as [u [pu iu]]; cbn [pose_test_of] in pu.
    - injection pu as <-. exists zero, 0. split; [apply zero_sound |]. split; [lra | exact iu].
    - destruct (enclose_parameter bits _) as [a |] eqn:e1; [| discriminate]. injection pu as <-. eexists; eexists. split; [apply squared_in, e1 |].
      split; [apply pow2_ge_0 | exact iu]. }
  destruct Reach as [low [kappa [hk [k0 it]]]]. destruct (Lower low kappa hk k0 it) as [reach_ [PDR low_]].
  assert (INJ : Configuration.injective (dimension k) conf).
  { intros v lv nv. specialize (low_ v lv nv). unfold nonzero in nv. assert (0 <= kappa * Linear.dot v v) by (apply Rmult_le_pos; lra). lra. }
  split.
  2: { intros o v lv nz. assert (IA : In (ChordsOf (map_rows place about) (place w) (fst one_matrix) (snd one_matrix)) all_tests)
        by (unfold all_tests; rewrite o; apply inserted_in; left; reflexivity).
      pose proof (HT0 _ IA) as K. cbn [test_holds] in K. specialize (K v lv nz).
      rewrite RowsOf in K by (intros f i; apply in_or_app; right; right; do 2 (apply in_or_app; right); exact i).
      assert (EA : map (fun p => (fst p, 0)) (map_rows (Formula.value x theta) about) =
        map (fun l => (map (Rmult scale) (about_origin (Legs.Turns k) ratio l P Q), 0)) m).
      { unfold map_rows. rewrite map_map. cbn [fst]. unfold about. rewrite o.
        rewrite <- (map_map (fun l => map (Rmult scale) (about_origin (Legs.Turns k) ratio l P Q)) (fun A => (A, 0))), <- (map_map (fun p => map (Formula.value x theta) (fst p)) (fun A => (A, 0))).
        f_equal. exact ORIGIN. }
      rewrite EA in K. apply Rmult_lt_reg_l with scale; [exact scale0 |]. rewrite Rmult_0_r. match type of K with 0 < ?y => replace (scale * _) with y; [exact K |] end.
      clear. generalize (lower_weights (fst one_matrix) (snd one_matrix) v). induction m as [| l m' IH]; intros [| [y z] ws]; cbn [map form]; try ring.
      rewrite IH, dot_map. ring. }
  unfold meets_turning. fold k L ds conf. split; [exact reach_ |]. split; [exact INJ |]. apply Forall_forall. intros d id.
  destruct (Test d id) as [ns [qv_ [signs [plains shown]]]]. pose proof (qv_ x) as qv.
  assert (Num : forall n, Formula.value x theta (nth n ns (integer 0)) = nth n (map input_value (inputs_of false s d)) 0)
    by (intro n; rewrite <- qv; symmetry; exact (map_nth (Formula.value x theta) ns (integer 0) n)).
  assert (LegOf : forall n z, nth_error zs n = Some z -> exists l, nth_error m n = Some l /\ strut_stands x theta k P Q W ratio L z l).
  { clear - ZS. intros n z. revert n. induction ZS as [| z' l zs' m' hd hs IH]; intros [| n] e; try discriminate; cbn [nth_error] in *.
    - injection e as ->. exists l. split; [reflexivity | exact hd].
    - exact (IH n e). }
  assert (Size : forall z l, strut_stands x theta k P Q W ratio L z l -> Formula.value x theta (snd (z_row z)) = W * ratio ^ 2 * norm2 (strut_vector l P Q))
    by (intros z l [hs _]; unfold stands in hs; destruct (z_row z) as [A D]; exact (proj1 (proj2 hs))).
  assert (Joint : forall n l, nth_error m n = Some l -> nth_error (joints conf) n = Some (Length (strut_length l P Q)))
    by (intros n l e; unfold conf, struts_at; cbn [joints]; rewrite nth_error_map, e; reflexivity).
  assert (Over1 : forall y, y / 1 = y) by (intro; field). pose proof (pow_lt ratio 2 r0) as r2. pose proof (Rmult_lt_0_compat _ _ W0 r2) as wr.
  destruct d as [| b | b | n b | n b | n b b' | b | n b b' | n b b' | b b' | n b b' | n b | n b | b | n on ax b | one other b | n p q b | error b angle | n force b]; cbn [Configuration.fulfils];
    try (destruct (shown _ (or_introl eq_refl)) as [u [pu iu]]; cbn [pose_test_of] in pu; fold rows in pu; try discriminate).
  4-5: cbn [own_formulas length_sign] in *; destruct (nth_error zs n) as [z |] eqn:nz; [| discriminate]; destruct (certainly bits false b) eqn:b0; [| discriminate];
    cbn [option_map] in pu; injection pu as <-; apply nonneg_sound in b0; destruct (LegOf n z nz) as [l [nl sl]]; pose proof (Size z l sl) as vD;
    pose proof (HT _ iu) as H; cbn [test_holds] in H; pose proof (Found _ (signs _ (or_introl eq_refl))) as FF;
    match type of FF with _ = ?v => assert (G : 0 <= v) by (rewrite <- FF; exact H) end; clear H FF; rename G into H;
    rewrite value_minus, value_times, Formula.value_square, Num, vD, hw in H; cbn [inputs_of map nth input_value] in H;
    replace (Claim.value b / two_to s) with (ratio * Claim.value b) in H by (unfold ratio, Rdiv; ring);
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
  - cbn [own_formulas lever_of] in *. destruct (nth_error zs n) as [z |] eqn:nz; [| discriminate]. cbn [option_map] in *.
    destruct (certainly bits true b && certainly bits true b') eqn:ce; [| discriminate].
    apply andb_true_iff in ce as [t0 b0]. apply positive_sound in t0, b0. injection pu as <-. pose proof (HT _ iu) as H. cbn [test_holds] in H. destruct H as [p qq].
    destruct (LegOf n z nz) as [l [nl sl]]. pose proof (Size z l sl) as vD. exists (strut_row k L l P Q). split; [unfold conf, struts_at; cbn [jacobian]; rewrite nth_error_map, nl; reflexivity |].
    destruct (proj1 (proj2 sl)) as [vf vb]. set (k2 := nth 0 ns (integer 0)) in *.
    specialize (vb k2). unfold k2 in vb at 2. rewrite Num in vb. cbn [inputs_of map nth input_value Claim.value] in vb. change (two_to 0) with 1 in vb. rewrite Over1 in vb.
    rewrite map_rows_cons in p, qq. cbn [map_rows map fst snd energy Linear.dot] in p, qq. apply Forall_inv in p. cbn [snd] in p.
    assert (iD : In (snd (z_row z)) wanted).
    { apply in_or_app. left. apply in_flat_map. exists (z_row z). split; [apply in_map, (nth_error_In _ _ nz) | apply in_or_app; right; left; reflexivity]. }
    rewrite (Found _ iD) in p, qq. rewrite (Found _ (signs _ (or_introl eq_refl))), (Found _ (signs _ (or_intror (or_introl eq_refl)))) in qq. rewrite vD in p, qq. rewrite vf, vb in qq.
    set (y := Claim.value b') in *. set (tool := Claim.value b) in *. set (n2 := norm2 (strut_vector l P Q)) in *. set (along := Vec3.dot (arm_of_joint l Q) (strut_vector l P Q)) in *.
    assert (n0 : 0 < n2) by (apply Rmult_lt_reg_l with (W * ratio ^ 2); lra).
    assert (R : Linear.dot (strut_row k L l P Q) (strut_row k L l P Q) <= (y / tool) ^ 2).
    { apply (lever_bounds k P Q L l L0 keeps); [exact n0 |]. fold along. fold n2. apply Rmult_lt_reg_l with (W * ratio ^ 2); [exact wr |].
      replace (W * ratio ^ 2 * (along ^ 2 / n2)) with ((W * ratio ^ 2 * along * 1 + 0) ^ 2 / (W * ratio ^ 2 * n2) + 0) by (field; split; [lra | split; lra]). exact qq. }
    intros v lv le. apply Rabs_le. enough (Q2 : Linear.dot (strut_row k L l P Q) v ^ 2 <= y ^ 2) by (split; nra).
    pose proof (Solve.dot_cauchy (strut_row k L l P Q) v) as CS. pose proof (Linear.dot_self v). pose proof (pow2_ge_0 (y / tool)).
    assert ((y / tool) ^ 2 * tool ^ 2 = y ^ 2) by (field; lra). nra.
  - destruct (nth_error zs n) as [z0 |] eqn:there0; [| discriminate]. destruct (certainly bits true b && certainly bits true b') eqn:ce; [| discriminate].
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
  - destruct (certainly bits true b' && forallb _ _) eqn:ce; [| discriminate]. apply andb_true_iff in ce as [b0 ks0]. apply positive_sound in b0. rewrite forallb_forall in ks0.
    injection pu as <-. pose proof (HT _ iu) as H. cbn [test_holds] in H. cbn [own_formulas] in signs. fold rows in signs. intros v lv.
    assert (KS : Forall (fun y => 0 < y) (map Claim.value b)) by (apply Forall_forall; intros y iy; apply in_map_iff in iy as [y' [<- iy]]; eapply positive_sound, ks0, iy).
    destruct (NZ v) as [nz | z]; [| destruct (Z v z) as [-> _]; rewrite Rmult_0_r; apply elastic_nonneg, KS].
    destruct (H 1 v (Fixed.integer_sound bits 1) ltac:(lra) lv nz) as [_ q].
    rewrite RowsOf in q by (intros f i'; destruct (entries_stiffened _ _ _ i') as [i2 | i2]; [apply in_or_app; left; exact i2 | exact (signs _ i2)]). rewrite Weight in q.
    assert (ROWS : Forall2 (fun p row => 0 < Formula.value x theta (snd p) /\ Linear.dot (map (Formula.value x theta) (fst p)) v ^ 2 / Formula.value x theta (snd p) = W * Linear.dot row v ^ 2) rows (map (fun l => strut_row k L l P Q) m)).
    { clear - ST PDR W0. revert PDR. induction ST as [| [A D] l rows' m' [h _] hs IH]; intro p; cbn [map]; constructor; rewrite map_rows_cons in p; inversion p as [| ? ? p1 p2]; subst; [| exact (IH p2)].
      cbn [fst snd] in p1 |- *. split; [exact p1 |]. destruct (h p1) as [_ [y [y2 hy]]]. rewrite hy, Rpow_mult_distr, y2. field. lra. }
    pose proof (stiffened_energy x theta W 1 (Claim.value b') v b0 Rlt_0_1 rows _ ROWS (map Claim.value b) ns) as E. unfold conf, struts_at. cbn [jacobian].
    specialize (E KS ltac:(rewrite qv; cbn [inputs_of]; rewrite !map_map; apply map_ext; intro y; cbn [input_value Claim.value]; change (two_to (rate false s + rate false s)) with 1; rewrite Over1; ring)).
    rewrite !Rmult_1_r in E. apply Rmult_le_reg_l with W; [exact W0 |]. rewrite <- E. rewrite Rmult_1_l in q. replace (W * (Claim.value b' * Linear.dot v v)) with (W * Linear.dot v v * Claim.value b') by ring.
    apply Rmult_le_compat_r; lra.
  - cbn [tests_of_demand own_formulas plain_formulas] in *. destruct (nth_error zs n) as [z |] eqn:nz; [| destruct (shown _ (or_introl eq_refl)) as [u [eu _]]; discriminate].
    destruct (is_axis ax && certainly bits false b && certainly bits false (Minus (180 // 1) b)) eqn:ce; [| destruct (shown _ (or_introl eq_refl)) as [u [eu _]]; discriminate].
    apply andb_true_iff in ce as [ce b1]. apply andb_true_iff in ce as [axis b0]. apply nonneg_sound in b0, b1. cbn [Claim.value] in b1.
    destruct (LegOf n z nz) as [l [nl [_ [_ [WAY LIMB]]]]]. set (A := strut_vector l P Q) in *.
    assert (A0 : 0 < norm2 A) by (rewrite Forall_forall in reach_; exact (reach_ l (nth_error_In _ _ nl))).
    assert (J0 : 0 < norm2 (located ax)) by (apply (is_never_zero_sound _ (located ax) axis); repeat split; apply Rle_refl).
    set (a := if on then mulv Q (located ax) else located ax). assert (a0 : norm2 a = norm2 (located ax)) by (unfold a; destruct on; [apply keeps | reflexivity]).
    exists (vadd P (arm_of_joint l Q)), A, (strut_length l P Q). unfold conf, struts_at. cbn [limbs placed]. split; [rewrite nth_error_map, nl; reflexivity |].
    assert (eqa : (if on then vsub (vadd P (mulv Q (located ax))) (vadd P (mulv Q vzero)) else located ax) = a) by (unfold a; destruct on; [apply placed_difference | reflexivity]).
    cbv zeta. rewrite eqa. split; [exact A0 |]. split; [rewrite a0; exact J0 |].
    assert (B : 0 <= Claim.value b <= 180) by lra.
    apply (angle_found A a (Claim.value b) A0 ltac:(rewrite a0; exact J0) B). rewrite a0.
    set (o := order_of [px ax; py ax; pz ax]) in *. pose proof (Rinv_0_lt_compat _ (two_to_pos o)) as o0. set (c0 := cos (in_degrees (Claim.value b))) in *.
    assert (AX : val3 x theta (vector_at ns 1) = vscale (/ two_to o) (located ax)).
    { unfold val3, vector_at. cbn [Machine.ex Machine.ey Machine.ez Nat.add]. rewrite !Num. cbn [inputs_of map nth input_value]. fold o. unfold vscale, located. cbn [vx vy vz]. unfold Rdiv. f_equal; ring. }
    pose proof (sqrt_lt_R0 _ J0) as sj. pose proof (sqrt_lt_R0 _ A0) as sA.
    assert (LC : Formula.value x theta (least_cosine ns) = / two_to o * (c0 * sqrt (norm2 (located ax)))).
    { unfold least_cosine. rewrite value_times, Num, value_root, value_dot, AX, <- norm2_dot, norm2_scale, sqrt_resized by exact o0. cbn [inputs_of map nth input_value]. fold c0. ring. }
    unfold angle_tests in shown. destruct (up_to_90 b) eqn:up.
    + unfold angle_row in shown, signs. cbv beta iota in shown, signs. set (U := z_way z on) in *. set (row := list_of (Machine.scaled (least_cosine ns) U)) in *. set (D := Machine.product U (vector_at ns 1)) in *.
      assert (FD : at_pairs theta (entry_at tape (place D)) (parabola x) = Formula.value x theta D) by (apply Found, signs, in_or_app; right; left; reflexivity).
      assert (DV : Formula.value x theta D = W * ratio * / two_to o * Vec3.dot A a).
      { unfold D. rewrite value_dot, (WAY on : val3 x theta U = _), AX. unfold a. destruct on; [apply axis_on_platform | unfold Vec3.dot, vscale; cbn [vx vy vz]; ring]. }
      assert (wo : 0 < W * ratio * / two_to o) by (repeat apply Rmult_lt_0_compat; assumption).
      destruct (shown _ (or_introl eq_refl)) as [u0 [e0 i0]]. injection e0 as <-. pose proof (HT _ i0) as H0. cbn [test_holds] in H0. rewrite FD, DV in H0.
      destruct (certainly exact_bits false (Minus b (90 // 1))) eqn:right.
      * apply nonneg_sound in right. cbn [Claim.value] in right. assert (Aa : 0 <= Vec3.dot A a) by (apply Rmult_le_reg_l with (W * ratio * / two_to o); [exact wo | lra]).
        assert (c1 : c0 <= 0).
        { unfold c0. replace 0 with (cos (PI / 2)) by apply cos_PI2. pose proof PI_RGT_0. destruct (Rle_lt_or_eq_dec (PI / 2) (in_degrees (Claim.value b))) as [gl | gl]; [unfold in_degrees; nra | | rewrite <- gl; apply Rle_refl].
          apply Rlt_le, cos_decreasing_1; try exact gl; unfold in_degrees; nra. }
        assert (0 < sqrt (norm2 A) * sqrt (norm2 (located ax))) by (apply Rmult_lt_0_compat; assumption). nra.
      * destruct (shown _ (or_intror (or_introl eq_refl))) as [u1 [e1 i1]]. injection e1 as <-. pose proof (HT _ i1) as H1. cbn [test_holds] in H1.
        assert (UV : norm2 (val3 x theta U) = (W * ratio) ^ 2 * norm2 A).
        { rewrite (WAY on : val3 x theta U = _), norm2_scale. destruct on; [| reflexivity]. rewrite <- (keeps (mulv (transpose Q) A)), (proj2 (rotations_invert Q keeps A)). reflexivity. }
        assert (U0 : 0 < (W * ratio) ^ 2 * norm2 A) by (apply Rmult_lt_0_compat; [apply pow_lt, Rmult_lt_0_compat; assumption | exact A0]).
        specialize (H1 (coordinates (val3 x theta U)) eq_refl ltac:(unfold nonzero; rewrite dot_coordinates, <- norm2_dot, UV; exact U0)).
        assert (MR : map_rows (fun i => at_pairs theta (entry_at tape i) (parabola x)) [(map place row, place D)] = [(map (Rmult (Formula.value x theta (least_cosine ns))) (coordinates (val3 x theta U)), Formula.value x theta D)]).
        { unfold map_rows. cbn [map fst snd]. rewrite FD, map_map. f_equal. f_equal. transitivity (map (Formula.value x theta) row).
          - apply map_ext_in. intros f i. apply Found, signs, in_or_app. left. exact i.
          - unfold row, list_of, Machine.scaled. cbn [map Machine.ex Machine.ey Machine.ez coordinates val3 vx vy vz]. rewrite !value_times. reflexivity. }
        unfold row in MR. cbn [list_of Machine.scaled Machine.ex Machine.ey Machine.ez map] in MR. rewrite MR, FD in H1. destruct H1 as [p1 qq]. pose proof (Forall_inv p1) as p2. cbn [snd] in p2. cbn [energy] in qq. rewrite dot_map, dot_coordinates, <- norm2_dot, UV, LC in qq. rewrite DV in p2, qq.
        set (S := (W * ratio) ^ 2 * norm2 A) in *. set (E := W * ratio * / two_to o * Vec3.dot A a) in *. set (C := / two_to o * (c0 * sqrt (norm2 (located ax)))) in *.
        assert (K : C ^ 2 * S < E ^ 2).
        { apply Rmult_lt_reg_r with S; [exact U0 |]. apply Rmult_lt_reg_r with (/ E); [apply Rinv_0_lt_compat, p2 |].
          replace (C ^ 2 * S * S * / E) with ((C * S) ^ 2 / E + 0) by (field; lra). replace (E ^ 2 * S * / E) with (E * S) by (field; lra). exact qq. }
        assert (SS : S = (W * ratio * sqrt (norm2 A)) ^ 2) by (unfold S; rewrite (Rpow_mult_distr (W * ratio) (sqrt (norm2 A))), pow2_sqrt by lra; reflexivity).
        assert (w2 : 0 < W * ratio * sqrt (norm2 A)) by (repeat apply Rmult_lt_0_compat; assumption). rewrite SS, <- Rpow_mult_distr in K.
        assert (M : C * (W * ratio * sqrt (norm2 A)) <= E) by (apply Rnot_lt_le; intro gl; assert (E ^ 2 < (C * (W * ratio * sqrt (norm2 A))) ^ 2) by nra; lra).
        unfold C, E in M. apply Rmult_le_reg_l with (W * ratio * / two_to o); [exact wo | lra].
    + destruct (shown _ (or_introl eq_refl)) as [u0 [e0 i0]]. injection e0 as <-. pose proof (HT _ i0) as H0. cbn [test_holds Check.holds] in H0. unfold is_nonneg in H0. destruct H0 as [_ H0].
      rewrite (plains _ (or_introl eq_refl)) in H0. unfold angle_sign in H0. destruct (z_limb z) as [[tip eA] size] eqn:ez. cbn [rod_stands] in LIMB.
      destruct LIMB as [[C [V [size0 [e1 [_ [e2 e3]]]]]] _]. injection e1 as e4 e5 e6. fold A in e5. unfold strut_length in e6. fold A in e6. rewrite <- e5 in e2. rewrite <- e6 in e3.
      assert (TV : val3 x theta (if on then eturned N w (vector_at ns 1) else vector_at ns 1) = vscale (/ two_to o) a).
      { unfold a. destruct on; [| exact AX]. exact (turned_values x theta Q W (/ two_to o) N w W0 hN hw _ _ AX). }
      rewrite value_minus, value_times, value_dot, TV, LC, <- e3 in H0. change (val3 x theta eA) with (located_at x theta eA) in H0. rewrite <- e2 in H0.
      assert (ro : 0 < ratio * / two_to o) by (apply Rmult_lt_0_compat; assumption).
      replace (Vec3.dot (vscale ratio A) (vscale (/ two_to o) a)) with (ratio * / two_to o * Vec3.dot A a) in H0 by (unfold Vec3.dot, vscale; cbn [vx vy vz]; ring).
      apply Rmult_le_reg_l with (ratio * / two_to o); [exact ro | lra].
  - cbn [plain_formulas] in plains. destruct (limb_segments k N w zs ns one other) as [[[a a'] [e e']] |] eqn:es; [| discriminate].
    destruct (enclose_parameter bits _) as [distance |] eqn:ed; [| discriminate]. destruct (0 <=? lo distance)%Z eqn:d0; [| discriminate]. apply Z.leb_le in d0. injection pu as <-.
    pose proof (HT _ iu) as H. cbn [test_holds] in H.
    assert (RODS : Forall2 (rod_stands x theta (/ two_to s)) (map (fun z => Some (z_limb z)) zs) (limbs conf)).
    { unfold conf, struts_at. cbn [limbs]. fold ratio. clear - ZS. induction ZS as [| z l zs' m' [_ [_ [_ [h _]]]] hs IH]; cbn [map]; constructor; assumption. }
    assert (QV : map (Formula.value x theta) (tl ns) = map exact_value (body_numbers s one ++ body_numbers s other)).
    { destruct ns as [| q0 ns']; [discriminate qv |]. cbn [inputs_of map] in qv. cbn [tl]. apply (f_equal (@tl R)) in qv. cbn [tl map] in qv. rewrite qv, map_map. reflexivity. }
    assert (PL : forall u v, located_at x theta u = vscale (/ two_to s) v -> located_at x theta (eplaced k N w u) = vscale (/ two_to s) (placed conf v))
      by (intros u v; exact (placed_values x theta k P Q W ratio N w W0 hPv hN hw u v)).
    refine (bodies_apart bits one_matrix x theta s plain (params ++ inputs ++ tangents) _ _ _ _ RODS PL one other b (tl ns) a a' e e' distance (dimension k) [] [] QV es _ _ d0 H).
    + intros f i. exact (f_equal (Formula.value x theta) (plains f i)).
    + replace (/ two_to s * _) with (Claim.value (distance_of one other b) / two_to s) by (cbn [distance_of Claim.value]; unfold Rdiv; ring).
      exact (enclose_parameter_sound bits _ _ _ ed (exact_within _ _)).
  - cbn [plain_formulas] in plains. destruct (nth_error zs n) as [z |] eqn:nz; [| discriminate]. destruct (certainly bits true b && _) eqn:ce; [| discriminate].
    apply andb_true_iff in ce as [b0 ce]. apply andb_true_iff in ce as [p0 q0]. apply nonneg_sound in p0, q0. apply positive_sound in b0. injection pu as <-.
    destruct (LegOf n z nz) as [l [nl [_ [_ [_ [_ BEND]]]]]]. rewrite Forall_forall in reach_. destruct (BEND (reach_ l (nth_error_In _ _ nl))) as [B1 [B2 B3]]. clear BEND. cbv zeta in plains.
    pose proof (HT _ iu) as H. cbn [test_holds Check.holds] in H. cbv zeta in H. destruct H as [_ H]. set (t' := z_bend z tt) in *.
    assert (V : forall f, In f (bend_row t' ++ concat (bend_twice t') ++ [nth 0 ns (integer 0); nth 1 ns (integer 0); bend_square t'; bend_along t']) ->
      Formula.value x theta (Check.formula_at plain (plain_place f)) = Formula.value x theta f) by (intros f i; exact (f_equal (Formula.value x theta) (plains f i))).
    rewrite !(V (nth 0 ns (integer 0))), !(V (nth 1 ns (integer 0))), !(V (bend_square t')), !(V (bend_along t')) in H by (do 2 (apply in_or_app; right); cbn [In]; tauto).
    assert (R1 : map (fun i => Formula.value x theta (Check.formula_at plain i)) (map plain_place (bend_row t')) = strut_row k L l P Q)
      by (rewrite map_map, <- B1; apply map_ext_in; intros f i; apply V, in_or_app; left; exact i).
    assert (R2 : map (map (fun i => Formula.value x theta (Check.formula_at plain i))) (map (map plain_place) (bend_twice t')) = map (map (Formula.value x theta)) (bend_twice t')).
    { rewrite map_map. apply map_ext_in. intros r ir. rewrite map_map. apply map_ext_in. intros f i. apply V, in_or_app. right. apply in_or_app. left. apply in_concat. exists r. split; assumption. }
    rewrite R1, R2, !Num in H. cbn [inputs_of map nth input_value Claim.value] in H. change (two_to 0) with 1 in H. rewrite Over1 in H.
    specialize (H ltac:(apply Rmult_le_pos; [exact p0 | apply Rlt_le, Rinv_0_lt_compat, b0]) B2). intros v a lv la hv ha.
    exists (Linear.dot (strut_row k L l P Q) a + ratio / 2 * quad (map (map (Formula.value x theta)) (bend_twice t')) v). split.
    + unfold conf, struts_at. cbn [accelerates]. rewrite nl. exact (B3 v a).
    + assert (units : Claim.value q * Claim.value q / Claim.value b / two_to s = ratio * (Claim.value q * Claim.value q / Claim.value b)) by (unfold ratio, Rdiv; ring).
      exact (acceleration_bounded (dimension k) _ a _ v _ _ ratio (Claim.value p) (Claim.value q) (Claim.value b) ltac:(destruct k; cbn; lia) p0 q0 b0 eq_refl units H lv hv ha).
  - cbn [tests_of_demand own_formulas plain_formulas] in *. unfold near_tests in shown.
    destruct (Nat.eqb (length zs) (dimension k) && certainly bits false error && certainly bits true b && certainly bits true angle && is_angle_number bits angle) eqn:cond;
      [| destruct (shown _ (or_introl eq_refl)) as [u [eu _]]; discriminate].
    apply andb_true_iff in cond as [cond ia]. apply andb_true_iff in cond as [cond a0]. apply andb_true_iff in cond as [cond b0]. apply andb_true_iff in cond as [lz er0].
    apply Nat.eqb_eq in lz. apply positive_sound in a0, b0. apply nonneg_sound in er0. apply (is_angle_number_sound bits) in ia.
    destruct (enclose_parameter bits (exactly b, s)) as [dd |] eqn:ed; [| destruct (shown _ (or_introl eq_refl)) as [u [eu _]]; discriminate].
    destruct (enclose_tangent bits angle) as [tt_ |] eqn:ett; [| destruct (shown _ (or_introl eq_refl)) as [u [eu _]]; discriminate].
    destruct (all_some (map (near_joint_of s (lay ++ [pl]) place plain_place error b) zs)) as [js |] eqn:ej; [| destruct (shown _ (or_introl eq_refl)) as [u [eu _]]; discriminate].
    cbv zeta in shown. set (unit := turn_unit ns) in *. set (arows := map (changed_row k ell (lay ++ [pl]) ns) zs) in *. set (trows := map (turned_row k ell ns) zs).
    set (mk := fun last => NearTest (map_rows place arows) (place w) (ends_for (map_rows place arows)) (map (fun z => map plain_place (fst (z_moved z unit))) zs)
      (map (fun z => plain_place (snd (z_moved z unit))) zs) js dd tt_ (first_angle k) last).
    assert (Found_ : forall last, (last = false -> k <> AboutPoint) -> In (NearOf (mk last)) tests).
    { intros last hq. assert (S : exists u, Some (NearOf (mk last)) = Some u /\ In u tests).
      { apply shown. clear - hq. clearbody k. destruct k, last; cbn [In]; auto; exfalso; apply hq; reflexivity. }
      destruct S as [u [eu iu]]. injection eu as <-. exact iu. }
    assert (PF : forall last, (last = false -> k <> AboutPoint) -> pose_found bits tape plain (params ++ inputs ++ tangents) theta (dimension k) x (mk last))
      by (intros last hq; exact (HT _ (Found_ last hq))).
    assert (lm : length m = dimension k) by (rewrite <- lz; symmetry; exact (related_length _ _ _ _ _ ZS)).
    set (dist := Claim.value b) in *. set (tau := tangent (Claim.value angle)) in *.
    assert (HD : contains bits dd (ratio * dist)) by (replace (ratio * dist) with (dist / two_to s) by (unfold ratio, Rdiv; ring); exact (enclose_parameter_sound bits _ _ _ ed (exact_within b s))).
    pose proof (enclose_tangent_sound bits angle tt_ ett ia) as HTau. fold tau in HTau. pose proof (tangent_nonneg _ (Rlt_le _ _ a0) ia) as t0. fold tau in t0.
    assert (D0 : 0 <= ratio * dist) by (apply Rmult_le_pos; lra).
    assert (UNIT : forall y, Formula.value y theta unit * ratio = tau / dist).
    { intro y. unfold unit, turn_unit. rewrite value_over.
      assert (NumY : forall n, Formula.value y theta (nth n ns (integer 0)) = nth n (map input_value (inputs_of false s (OnePose error b angle))) 0)
        by (intro n; rewrite <- (qv_ y); symmetry; exact (map_nth (Formula.value y theta) ns (integer 0) n)).
      rewrite !NumY. cbn [inputs_of map nth input_value]. rewrite two_to_less. fold tau dist. unfold ratio. pose proof (two_to_pos s). pose proof (two_to_pos (order_of [b])). field. repeat split; lra. }
    set (back := [ratio * L] ++ map input_value ins ++ ts_).
    set (f := first_angle k). set (near u := near_point f x (ratio * dist) tau u).
    assert (AT : forall u, length u = dimension k -> val3 (near u) theta (eposition k) = vscale ratio (position_at k P dist u) /\ valm (near u) theta N = mscale W Q /\
      Formula.value (near u) theta w = W /\ val3 (near u) theta (spin_formulas k (dimension k)) = vscale tau (spin_of k u)).
    { intros u lu. destruct (near_coordinates k P ratio cs dist tau u theta (flat_position _ _ _ flat hP) lx lu) as [n1 [n2 n3]]. split; [exact n1 |].
      destruct (CH (near u) theta (first_angle k) (j + length ins)%nat n2 tangent_at) as [c1 [c2 _]]. rewrite ch in c1, c2. cbn [fst snd] in c1, c2. split; [exact c1 | split; [exact c2 | exact n3]]. }
    assert (FAR : Forall2 (fun z l => forall u, length u = dimension k -> Formula.defined (near u) theta (snd (z_moved z unit)) ->
      is_far_row k dist tau l (position_at k P dist u) (turn_at k Q tau u) (vscale tau (spin_of k u)) (map (Formula.value (near u) theta) (fst (z_moved z unit)))) zs m).
    { apply (RS _ _ _ []). intros a b' l [Ha _] [Hb _]. cbn [app] in Ha, Hb. intros u lu def. cbn [z_moved formulas_of fst snd] in def |- *.
      pose proof (Ha (near u) back) as hsa. pose proof (Hb (near u) back) as hsb. destruct (AT u lu) as [n1 [n2 [n3 n4]]].
      exact (moved_row_values (near u) theta k _ Q _ W ratio dist tau N w a b' _ unit l r0 W0 n1 n2 n3 hsa hsb n4 (UNIT (near u)) def). }
    assert (Plain : forall z, In z zs -> forall f, In f (fst (z_moved z unit) ++ [snd (z_moved z unit)]) -> formula_at plain (plain_place f) = f)
      by (intros z iz f' i'; apply plains, in_or_app; left; apply in_flat_map; exists z; split; assumption).
    set (J := far_rows plain theta x (mk true) (ratio * dist) tau).
    assert (JE : forall u, J u = map (fun z => map (Formula.value (near u) theta) (fst (z_moved z unit))) zs).
    { intro u. unfold J, far_rows. cbn [mk n_far n_first]. rewrite map_map. apply map_ext_in. intros z iz. rewrite map_map. apply map_ext_in. intros f' i'.
      exact (f_equal (Formula.value (near u) theta) (Plain z iz f' (in_or_app _ _ _ (or_introl i')))). }
    assert (Columns : forall z, In z zs -> length (fst (turned_row k ell ns z)) = dimension k).
    { intros z iz. assert (A : length (fst (z_row z)) = dimension k) by (clear - ZS iz; induction ZS as [| y l zs' m' [h _] hs IH]; [contradiction |]; destruct iz as [<- | iz]; [unfold stands in h; destruct (z_row y); exact (proj2 (proj2 (proj2 h))) | exact (IH iz)]).
      unfold turned_row. cbn [fst]. rewrite app_length, map_length, <- app_length, firstn_skipn. exact A. }
    (* lengths, of both machines *)
    destruct (nominal_is s ts m hm) as [hm0 E0]. destruct (each_strut_stands s ts _ hm0) as [th0 [[ETH0 TH0] RS0]]. rewrite E0 in ETH0.
    set (theta0 := th0 ++ back).
    assert (lt0 : length th0 = length lay) by (symmetry; exact (related_length _ _ _ _ _ TH0)).
    assert (tangent_at0 : forall a, In a (curved (turned c)) -> nth (j + length ins) theta0 0 = tangent (Claim.value a)).
    { intros a i. rewrite <- (tangent_at a i). change theta with (th ++ back). unfold theta0. rewrite (app_nth2 th0 back), (app_nth2 th back) by (unfold j; lia). rewrite lt, lt0. reflexivity. }
    destruct (CH x theta0 (first_angle k) (j + length ins)%nat (fun i _ => first i) tangent_at0) as [hN0 [hw0 _]]. rewrite ch in hN0, hw0. cbn [fst snd] in hN0, hw0.
    assert (Len : forall theta' a b' l, valm x theta' N = mscale W Q -> Formula.value x theta' w = W -> val3 x theta' (eposition k) = vscale ratio P ->
      val3 x theta' a = vscale ratio (strut_base l) -> val3 x theta' b' = vscale ratio (strut_joint l) -> Formula.value x theta' (snd (limb k N w a b')) = ratio * strut_length l P Q).
    { intros theta' a b' l h1 h2 h3 h4 h5. pose proof (limb_values x theta' k P Q W ratio N a b' w l r0 W0 h3 h1 h2 h4 h5) as LV. destruct (limb k N w a b') as [[C A] len_]. cbn [rod_stands] in LV.
      destruct LV as [C' [A' [n' [e1 [_ [_ e4]]]]]]. injection e1 as <- <- <-. cbn [snd]. symmetry. exact e4. }
    assert (LEN : Forall2 (fun z l => Formula.value x theta (own_length z) = ratio * strut_length l P Q) zs m).
    { apply (RS _ _ _ []). intros a b' l [Ha _] [Hb _]. cbn [app] in Ha, Hb. exact (Len theta a b' l hN hw hPv (Ha x back) (Hb x back)). }
    assert (LEN0 : Forall2 (fun z l => Formula.value x theta0 (own_length z) = ratio * strut_length l P Q) zs (nominal_struts ts)).
    { apply (RS0 _ _ _ []). intros a b' l [Ha _] [Hb _]. cbn [app] in Ha, Hb. apply (Len theta0 a b' l hN0 hw0); [exact (position_value k P _ cs _ (flat_position _ _ _ flat hP)) | exact (Ha x back) | exact (Hb x back)]. }
    assert (hl0 : Formula.value x theta0 ell = ratio * L) by (unfold ell, theta0, back; apply quantity_value; [exists L; split; [split; apply Rle_refl | cbn [snd pl]; unfold ratio, Rdiv; ring] | rewrite <- lt0; apply nth_middle]).
    assert (SQ : Forall2 (fun z l => Formula.value x theta (snd (z_row z)) = W * ratio ^ 2 * norm2 (strut_vector l P Q)) zs m).
    { apply (RS _ _ _ []). intros a b' l [Ha _] [Hb _]. cbn [app] in Ha, Hb. pose proof (scaled_row_values x theta k P Q W ratio L N a b' w ell l r0 L0 keeps hPv hN hw hl (Ha x back) (Hb x back)) as SV.
      cbn [z_row formulas_of]. destruct (scaled_row k N w ell a b') as [A D]. exact (proj1 SV). }
    assert (SQ0 : Forall2 (fun z l => Formula.value x theta0 (snd (z_row z)) = W * ratio ^ 2 * norm2 (strut_vector l P Q)) zs (nominal_struts ts)).
    { apply (RS0 _ _ _ []). intros a b' l [Ha _] [Hb _]. cbn [app] in Ha, Hb.
      pose proof (scaled_row_values x theta0 k P Q W ratio L N a b' w ell l r0 L0 keeps (position_value k P _ cs _ (flat_position _ _ _ flat hP)) hN0 hw0 hl0 (Ha x back) (Hb x back)) as SV.
      cbn [z_row formulas_of]. destruct (scaled_row k N w ell a b') as [A D]. exact (proj1 SV). }
    set (all := params ++ inputs ++ tangents) in *. set (ps := lay ++ [pl]) in *. set (tb := map input_value ins ++ ts_).
    assert (OFFS : (forall th, Forall2 (contains bits) all th -> Forall (fun j => Formula.defined x th (formula_at plain (fst (fst j)))) js) ->
      forall rho, Forall2 (fun l r => Rabs (r - strut_length l P Q) <= Claim.value error) (nominal_struts ts) rho ->
      Forall2 (off_by bits tape plain all theta (dimension k) x (ratio * dist) (place w)) (combine js (map_rows place arows)) (offsets m P Q dist rho)).
    { intros Def rho hr.
      assert (PSI : Forall2 scaled_within ps (th ++ [ratio * L])) by (apply Forall2_app; [exact TH |]; constructor; [| constructor]; exists L; split; [split; apply Rle_refl | cbn [snd pl]; unfold ratio, Rdiv; ring]).
      assert (MID : map middle_of ps ++ tb = theta0).
      { unfold ps, theta0, tb, back. rewrite map_app, ETH0, <- app_assoc. f_equal. cbn [map app]. f_equal. unfold middle_of, middle, pl, exactly. cbn [fst snd least greatest]. fold L. unfold ratio. field. apply Rgt_not_eq, two_to_pos. }
      assert (Enc : forall th', Forall2 scaled_within ps th' -> Forall2 (contains bits) all (th' ++ tb)).
      { intros th' h. unfold all, tb. apply Forall2_app; [exact (enclosed_all bits _ _ _ ep h) |]. apply Forall2_app; [exact (inputs_enclosed bits _ _ ei) | exact TT]. }
      assert (Length2 : forall l, strut_length l P Q ^ 2 = norm2 (strut_vector l P Q)) by (intro l; apply pow2_sqrt; unfold norm2; nra).
      assert (One : forall z l l0 jt r, In z zs -> In jt js -> Formula.value x theta (own_length z) = ratio * strut_length l P Q -> Formula.value x theta0 (own_length z) = ratio * strut_length l0 P Q ->
        Formula.value x theta (snd (z_row z)) = W * ratio ^ 2 * norm2 (strut_vector l P Q) -> Formula.value x theta0 (snd (z_row z)) = W * ratio ^ 2 * norm2 (strut_vector l0 P Q) ->
        near_joint_of s ps place plain_place error b z = Some jt -> Rabs (r - strut_length l0 P Q) <= Claim.value error ->
        off_by bits tape plain all theta (dimension k) x (ratio * dist) (place w) (jt, (map place (fst (changed_row k ell ps ns z)), place (snd (z_row z)))) ((r - strut_length l P Q) / dist)).
      { intros z l l0 jt r iz ij v1 v0 s1 s0 hj hy. unfold near_joint_of in hj. destruct (joint_test _ _ _ _ _ _ _) as [jt1 |] eqn:e1; [| discriminate]. destruct (changes_of bits place _ _ _ _) as [hs2 |] eqn:e2; [| discriminate].
        destruct (is_polynomial [] [] (snd (z_row z))) eqn:po; [| discriminate]. injection hj as <-. unfold joint_test in e1. destruct (enclose_parameter bits (exactly (Over error b), 0%Z)) as [err |] eqn:ee; [| discriminate].
        destruct (changes_of bits plain_place _ _ _ _) as [hs1 |] eqn:e3; [| discriminate]. injection e1 as <-.
        assert (Fo : forall e, In e (own_length z :: map snd (slopes_of ps (own_length z))) -> formula_at plain (plain_place e) = e)
          by (intros e i; apply plains, in_or_app; right; apply in_flat_map; exists z; split; assumption).
        assert (In_ : forall f', In f' (map snd (slopes_of ps (snd (z_row z)))) -> In f' wanted)
          by (intros f' i; apply signs, in_flat_map; exists z; split; [exact iz | apply in_or_app; right; exact i]).
        destruct (nominal_differs bits s b ps (th ++ [ratio * L]) tb all plain_place (own_length z) x hs1 PSI Enc e3) as [q1 [th1 [t1 [a1 [a2 a3]]]]];
          [intros th' hth'; specialize (Def th' hth'); rewrite Forall_forall in Def; specialize (Def _ ij); cbn [fst] in Def; rewrite (Fo _ (or_introl eq_refl)) in Def; exact Def | exact b0 |].
        destruct (nominal_differs bits s b ps (th ++ [ratio * L]) tb all place (snd (z_row z)) x hs2 PSI Enc e2 (fun th' _ => whole_defined x th' _ po) b0) as [q2 [th2 [t2 [c1 [c2 c3]]]]].
        fold ratio dist in a3, c3. rewrite <- app_assoc, MID in a3, c3. change (th ++ [ratio * L] ++ tb) with theta in a3, c3. rewrite v1, v0 in a3. rewrite s1, s0 in c3.
        exists ((ratio * strut_length l0 P Q - ratio * strut_length l P Q) / (ratio * dist)), ((r - strut_length l0 P Q) / dist),
          ((W * ratio ^ 2 * norm2 (strut_vector l0 P Q) - W * ratio ^ 2 * norm2 (strut_vector l P Q)) / (ratio * dist)). split; [| split; [| split; [exists th1, t1; split; [exact a1 | split; [exact a2 |]] | split; [exists th2, t2; split; [exact c1 | split; [| ]] |]]]].
        - field. split; lra.
        - cbn [fst snd]. exists (Claim.value error / dist). split.
          + apply (enclose_parameter_sound bits _ _ _ ee). exists (Claim.value error / dist). split; [unfold within, exactly; cbn; split; apply Rle_refl |]. cbn [snd]. change (two_to 0) with 1. field. lra.
          + unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ dist)) by (apply Rlt_le, Rinv_0_lt_compat, b0). apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, b0 | exact hy].
        - cbn [fst snd]. rewrite a3. f_equal. symmetry. apply (values_at (fun i => Formula.value x th1 (formula_at plain i)) _ plain_place hs1 _ q1). intros e i. rewrite (Fo e (or_intror i)). reflexivity.
        - cbn [fst snd]. unfold changed_row. cbn [fst]. rewrite map_app, <- (Columns z iz), <- (map_length place), skipn_app, skipn_all, Nat.sub_diag. cbn [app skipn]. rewrite <- q2, combine_back. exact c2.
        - cbn [fst snd]. unfold changed_row. cbn [fst]. rewrite map_app, <- (Columns z iz), <- (map_length place), skipn_app, skipn_all, Nat.sub_diag. cbn [app skipn]. rewrite <- q2, combine_back.
          rewrite c3. f_equal. symmetry. apply (values_at (fun i => at_pairs th2 (entry_at tape i) (parabola x)) _ place hs2 _ q2). intros e i.
          assert (E : entry_at tape (place e) = image (dimension k) e) by (apply Formula.same_sound, found, In_, i). rewrite E, <- lx. apply image_value. rewrite lx. apply below_, In_, i.
        - cbn [fst snd]. intros q q0 eq_. rewrite Weight, (Found (snd (z_row z))), s1, <- !Length2 in *
            by (apply in_or_app; left; apply in_flat_map; exists (z_row z); split; [apply in_map, iz | apply in_or_app; right; left; reflexivity]).
          assert (e : q = W * (ratio * strut_length l P Q)).
          { assert (p : 0 <= W * (ratio * strut_length l P Q)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; [lra | apply sqrt_pos]]). assert (q ^ 2 = (W * (ratio * strut_length l P Q)) ^ 2) by (rewrite eq_; ring). nra. }
          rewrite e. field. split; lra. }
      apply all_some_related in ej. unfold offsets. clear - ej LEN LEN0 SQ SQ0 hr One.
      assert (K : forall zs' m' l0s' rho' js', (forall z, In z zs' -> In z zs) -> (forall q, In q js' -> In q js) -> Forall2 (fun z l => Formula.value x theta (own_length z) = ratio * strut_length l P Q) zs' m' ->
        Forall2 (fun z l => Formula.value x theta0 (own_length z) = ratio * strut_length l P Q) zs' l0s' -> Forall2 (fun l r => Rabs (r - strut_length l P Q) <= Claim.value error) l0s' rho' ->
        Forall2 (fun z l => Formula.value x theta (snd (z_row z)) = W * ratio ^ 2 * norm2 (strut_vector l P Q)) zs' m' ->
        Forall2 (fun z l => Formula.value x theta0 (snd (z_row z)) = W * ratio ^ 2 * norm2 (strut_vector l P Q)) zs' l0s' ->
        Forall2 (fun z jt => near_joint_of s ps place plain_place error b z = Some jt) zs' js' ->
        Forall2 (off_by bits tape plain all theta (dimension k) x (ratio * dist) (place w)) (combine js' (map_rows place (map (changed_row k ell ps ns) zs'))) (map (fun p => (snd p - strut_length (fst p) P Q) / dist) (combine m' rho'))).
      { induction zs' as [| z zs' IH]; intros m' l0s' rho' js' sub1 sub2 h1 h2 h3 h5 h6 h4; inversion h1 as [| ? l ? m'' a1 a2]; subst; inversion h2 as [| ? l0 ? l0s'' b1 b2]; subst; inversion h3 as [| ? r ? rho'' c1 c2]; subst;
          inversion h4 as [| ? jt ? js'' d1 d2]; subst; inversion h5 as [| ? ? ? ? f1 f2]; subst; inversion h6 as [| ? ? ? ? g1 g2]; subst; cbn [combine map map_rows]; constructor.
        - cbn [fst snd]. exact (One z l l0 jt r (sub1 _ (or_introl eq_refl)) (sub2 _ (or_introl eq_refl)) a1 b1 f1 g1 d1 c1).
        - exact (IH _ _ _ _ (fun y i => sub1 y (or_intror i)) (fun y i => sub2 y (or_intror i)) a2 b2 c2 f2 g2 d2). }
      exact (K zs m _ rho js (fun _ i => i) (fun _ i => i) LEN LEN0 hr SQ SQ0 ej). }
    (* what each part shows *)
    assert (PART : forall last, (last = false -> k <> AboutPoint) -> forall rho, Forall2 (fun l r => Rabs (r - strut_length l P Q) <= Claim.value error) (nominal_struts ts) rho -> exists g_, 0 <= g_ /\
      (forall u, inside f (dimension k) u -> Forall (fun z => Formula.defined (near u) theta (snd (z_moved z unit))) zs /\
        forall v, length v = dimension k -> size (less (Twofold.image (J u) v) (Twofold.image (J (nought (dimension k))) v)) <= g_ * (norm f v * norm f u)) /\
      exists kappa z e Bs, g_ < kappa /\ 0 <= z /\ z + g_ / (2 * kappa) <= 1 /\ length e = dimension k /\ (forall i, (i < dimension k)%nat -> 0 < nth i e 0) /\
        (forall i, (i < dimension k)%nat -> (if last : bool then f <= i else i < f)%nat -> nth i e 0 = 1) /\ Forall2 (is_bounded W) (offsets m P Q dist rho) (combine (map_rows (Formula.value x theta) trows) Bs) /\
        forall v, length v = dimension k -> let R_ := map_rows (Formula.value x theta) trows in let p := Solve.weighted_sum v (map (Twofold.scaled e) (map fst R_)) in
          kappa ^ 2 * W * Linear.dot (map snd R_) (squares v) <= Linear.dot p p /\
          forall q, 0 < Linear.dot v v + q ^ 2 -> 0 < Linear.dot p p - 2 * Rabs q * W * Linear.dot Bs (map Rabs v) + W ^ 2 * z ^ 2 * q ^ 2).
    { intros last hq rho hr. pose proof (PF last hq) as F. unfold pose_found in F. cbn [mk n_weight n_joints n_first n_rows n_far n_reach n_distance n_turn n_last] in F. rewrite Weight in F.
      destruct (F W0) as [Def [_ [_ [_ [_ [_ G]]]]]]. specialize (G (ratio * dist) tau HD HTau D0 t0 (offsets m P Q dist rho) (OFFS Def rho hr)). destruct G as [g_ [g0 [G1 G2]]]. exists g_. split; [exact g0 |]. split.
      - intros u hu. destruct (G1 u hu) as [d1 d2]. split; [| exact d2]. rewrite Forall_map in d1. rewrite Forall_forall in d1 |- *. intros z iz.
        pose proof (d1 z iz) as dz. cbv beta in dz. change (nth (plain_place (snd (z_moved z unit))) (formulas plain) (integer 0)) with (formula_at plain (plain_place (snd (z_moved z unit)))) in dz.
        rewrite (Plain z iz) in dz by (apply in_or_app; right; left; reflexivity). exact dz.
      - assert (RA : own_columns (dimension k) (map_rows (fun i => at_pairs theta (entry_at tape i) (parabola x)) (map_rows place arows)) = map_rows (Formula.value x theta) trows).
        { rewrite RowsOf; [unfold own_columns, map_rows, arows, trows; rewrite !map_map; apply map_ext_in; intros z iz; cbn [fst snd changed_row]; f_equal;
            rewrite map_app, <- (Columns z iz), <- (map_length (Formula.value x theta)), firstn_app, firstn_all, Nat.sub_diag; apply app_nil_r |]. intros f' i'. apply in_flat_map in i' as [row [ir i']]. unfold arows in ir. apply in_map_iff in ir as [z [<- iz]]. apply in_app_or in i' as [i' | [<- | []]].
          - apply signs. apply in_flat_map. exists z. split; assumption.
          - apply in_or_app. left. apply in_flat_map. exists (z_row z). split; [apply in_map, iz | apply in_or_app; right; left; reflexivity]. }
        rewrite RA in G2. exact G2. }
    assert (hz : inside f (dimension k) (nought (dimension k))) by (split; [apply nought_length | pose proof (nought_norm f (dimension k)); lra]).
    set (rho0 := map (fun l => strut_length l P Q) (nominal_struts ts)).
    assert (hr0 : Forall2 (fun l r => Rabs (r - strut_length l P Q) <= Claim.value error) (nominal_struts ts) rho0).
    { unfold rho0. generalize (nominal_struts ts). induction l as [| l l' IH]; cbn [map]; constructor; [| exact IH]. unfold Rminus. rewrite Rplus_opp_r, Rabs_R0. exact er0. }
    assert (FARS : forall u, inside f (dimension k) u -> Forall2 (fun row l => is_far_row k dist tau l (position_at k P dist u) (turn_at k Q tau u) (vscale tau (spin_of k u)) row) (J u) m).
    { intros u hu. destruct (PART true ltac:(discriminate) rho0 hr0) as [g_ [_ [G _]]]. destruct (G u hu) as [d _]. rewrite JE. clear - FAR d hu. induction FAR as [| z l zs' m' h hs IH]; cbn [map]; constructor.
      - inversion d; subst. apply h; [exact (proj1 hu) | assumption].
      - inversion d; subst. apply IH. assumption. }
    (* rows at control points are those, times some numbers *)
    assert (ROWS : Forall2 (fun p row => exists q, 0 < q /\ q ^ 2 = W * snd p /\ fst p = map (Rmult q) row) (map_rows (Formula.value x theta) trows) (J (nought (dimension k)))).
    { assert (TR : Forall2 (fun z l => forall row, is_far_row k dist tau l P Q vzero row -> exists q, 0 < q /\ q ^ 2 = W * Formula.value x theta (snd (turned_row k ell ns z)) /\
        map (Formula.value x theta) (fst (turned_row k ell ns z)) = map (Rmult q) row) zs m).
      { apply (RS _ _ _ []). intros a b' l [Ha _] [Hb _]. cbn [app] in Ha, Hb. pose proof (Ha x back) as hsa. pose proof (Hb x back) as hsb.
        pose proof (scaled_row_values x theta k P Q W ratio L N a b' w ell l r0 L0 keeps hPv hN hw hl hsa hsb) as SV. intros row [n0 erow]. unfold turned_row. cbn [z_row formulas_of fst snd].
        destruct (scaled_row k N w ell a b') as [A D]. destruct SV as [SD SA]. cbn [fst snd]. pose proof (sqrt_lt_R0 _ n0) as s0. exists (W * ratio * sqrt (norm2 (strut_vector l P Q))).
        split; [repeat apply Rmult_lt_0_compat; assumption |]. split; [rewrite SD, !Rpow_mult_distr, pow2_sqrt by lra; ring |].
        assert (TW : Formula.value x theta (times (times (integer 2) ell) (turn_unit ns)) = 2 * L * (tau / dist)).
        { rewrite !value_times, hl. change (Formula.value x theta (integer 2)) with 2. fold unit. rewrite <- (UNIT x). ring. }
        assert (ME : forall l0, map (Formula.value x theta) (map (fun e => times e (times (times (integer 2) ell) (turn_unit ns))) l0) = map (Rmult (2 * L * (tau / dist))) (map (Formula.value x theta) l0))
          by (intro l0; rewrite !map_map; apply map_ext; intro e; rewrite value_times, TW; ring).
        rewrite map_app, ME, <- firstn_map, <- skipn_map, SA, erow. clear - s0 L0 b0. unfold normalised.
        set (sv := strut_vector l P Q) in *. set (arm := arm_of_joint l Q). set (root_ := sqrt (norm2 sv)) in *. assert (N0 : norm2 vzero = 0) by (unfold norm2, vzero; cbn; ring). rewrite N0.
        destruct sv as [v1 v2 v3], arm as [r1 r2 r3]. destruct k; cbn [first_angle twist map firstn skipn app]; unfold vscale, vadd, cross, vzero; cbn [vx vy vz]; repeat (apply f_equal2; [field; repeat split; lra |]); reflexivity. }
      rewrite JE. pose proof (FARS _ hz) as FZ. rewrite JE in FZ.
      assert (P0 : position_at k P dist (nought (dimension k)) = P) by (unfold position_at; assert (Z1 : shift_of k (nought (dimension k)) = vzero) by (destruct k; reflexivity); rewrite Z1; destruct P as [p1 p2 p3]; unfold vadd, vscale, vzero; cbn [vx vy vz]; f_equal; ring).
      assert (C0 : vscale tau (spin_of k (nought (dimension k))) = vzero) by (assert (Z1 : spin_of k (nought (dimension k)) = vzero) by (destruct k; reflexivity); rewrite Z1; unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring).
      unfold turn_at in FZ. rewrite P0, C0, not_moved in FZ. unfold trows, map_rows. rewrite map_map. clear - TR FZ. revert FZ. generalize (near (nought (dimension k))). intros y FZ.
      revert FZ. induction TR as [| z l zs' m' h hs IH]; intro FZ; cbn [map] in *; constructor; inversion FZ as [| ? ? ? ? f1 f2]; subst; [cbn [fst snd]; exact (h _ f1) | exact (IH f2)]. }
    apply (struts_recovered k (nominal_struts ts) m P Q error b angle J b0 a0 ia).
    + unfold nominal_struts. rewrite map_length, <- lm. exact (related_length _ _ _ _ _ hm).
    + exact lm.
    + intro u. rewrite JE, map_length. exact lz.
    + exact FARS.
    + intros rho hr. fold dist. destruct (PART true ltac:(discriminate) rho hr) as [g1 [g10 [G1 [k1 [z1 [e1 [Bs1 [c1 [c2 [c3 [c4 [c5 [c6 [c7 c8]]]]]]]]]]]]]].
      assert (LJ : length (J (nought (dimension k))) = dimension k) by (rewrite JE, map_length; exact lz).
      assert (Less : forall g_ kp z, 0 <= g_ -> forall g', 0 <= g' <= g_ -> g_ < kp -> z + g_ / (2 * kp) <= 1 -> g' < kp /\ z + g' / (2 * kp) <= 1).
      { intros g_ kp z p0 g' [p1 p2] p3 p4. split; [lra |]. assert (g' / (2 * kp) <= g_ / (2 * kp)); [| lra]. unfold Rdiv. apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; lra | exact p2]. }
      destruct (motion_dec k) as [ek | nk].
      * exists g1. split; [exact g10 |]. split; [intros u v hu lv; destruct (G1 u hu) as [_ h]; specialize (h v lv); fold f; lra |]. intros [|].
        -- right. apply (met_of f (dimension k) J g1 _ true W _ k1 z1 e1 Bs1 W0 LJ ROWS); assumption.
        -- left. rewrite ek. reflexivity.
      * destruct (PART false ltac:(intros _; exact nk) rho hr) as [g2 [g20 [G2 [k2 [z2 [e2 [Bs2 [d1 [d2 [d3 [d4 [d5 [d6 [d7 d8]]]]]]]]]]]]]].
        exists (Rmin g1 g2). assert (M1 : 0 <= Rmin g1 g2 <= g1) by (split; [apply Rmin_glb; assumption | apply Rmin_l]). assert (M2 : 0 <= Rmin g1 g2 <= g2) by (split; [apply Rmin_glb; assumption | apply Rmin_r]).
        split; [apply M1 |]. split.
        { intros u v hu lv. destruct (G1 u hu) as [_ h1], (G2 u hu) as [_ h2]. specialize (h1 v lv). specialize (h2 v lv). fold f. unfold Rmin. destruct (Rle_dec g1 g2); lra. }
        intros [|]; right.
        -- destruct (Less g1 k1 z1 g10 _ M1 c1 c3) as [q1 q2]. apply (met_of f (dimension k) J _ _ true W _ k1 z1 e1 Bs1 W0 LJ ROWS); assumption.
        -- destruct (Less g2 k2 z2 g20 _ M2 d1 d3) as [q1 q2]. apply (met_of f (dimension k) J _ _ false W _ k2 z2 e2 Bs2 W0 LJ ROWS); assumption.
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
