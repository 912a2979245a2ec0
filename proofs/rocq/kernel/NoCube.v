(** * No cube: leaves on whose moved cells a claim fails throughout

    Every leaf has an offset, a multiple of a 16th of the side for each coordinate, and
    names what is not met at the cell's points moved by it: the cell is one of centres, and
    their cubes have these points.  Formulas are enclosed over the moved cell; what is
    certain of an enclosure is true of all that it holds. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Linear Arithmetic Slope Test Cell Check Number Machine Formula Problem Witness Cubes.
From Orthocert.kernel Require Configuration.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Expressions of entries of a tape *)

Inductive expr := Entry (i : nat) | Apply (o : op expr).

Definition sum_of (l : list expr) : expr := fold_left (fun s e => Apply (Add s e)) l (Apply (Integer 0)).
Definition product_with (a : list nat) (v : list Z) : expr :=
  sum_of (map (fun p => Apply (Mul (Entry (fst p)) (Apply (Integer (snd p))))) (combine a v)).
(** |v|^2, and |M v|^2 = sum_i (A_i . v)^2/D_i. *)
Definition square_of (v : list Z) : expr := sum_of (map (fun n => Apply (Sqr (Apply (Integer n)))) v).
Definition image_of (r : rows nat) (v : list Z) : expr :=
  sum_of (map (fun p => Apply (Div (Apply (Sqr (product_with (fst p) v))) (Entry (snd p)))) r).

Section Values.
Variable tape : list (op address).
Variables x theta : list R.

Fixpoint formula_of (e : expr) : formula := match e with Entry i => formula_at tape i | Apply o => F (map_op formula_of o) end.
Definition val (e : expr) : R := value x theta (formula_of e).
Local Notation at_ := (fun i => value x theta (formula_at tape i)).

Lemma val_sum : forall l, val (sum_of l) = fold_right (fun e s => val e + s) 0 l.
Proof.
  assert (G : forall l a, val (fold_left (fun s e => Apply (Add s e)) l a) = val a + fold_right (fun e s => val e + s) 0 l).
  { induction l as [| e l IH]; intro a; cbn [fold_left fold_right]; [lra |]. rewrite IH.
    change (val (Apply (Add a e))) with (val a + val e). lra. }
  intro l. unfold sum_of. rewrite G. change (val (Apply (Integer 0))) with 0. lra.
Qed.

Lemma val_product : forall a v, val (product_with a v) = Linear.dot (map at_ a) (map IZR v).
Proof.
  intros a v. unfold product_with. rewrite val_sum. revert v.
  induction a as [| i a IH]; intros [| n v]; cbn [combine map fold_right Linear.dot]; try reflexivity.
  rewrite IH. reflexivity.
Qed.

Lemma val_square : forall v, val (square_of v) = Linear.dot (map IZR v) (map IZR v).
Proof.
  intro v. unfold square_of. rewrite val_sum. induction v as [| n v IH]; cbn [map fold_right Linear.dot]; [reflexivity |].
  rewrite IH. change (val (Apply (Sqr (Apply (Integer n))))) with (IZR n ^ 2). ring.
Qed.

Lemma val_image : forall r v, val (image_of r v) = energy (map_rows at_ r) (map IZR v).
Proof.
  intros r v. unfold image_of. rewrite val_sum. induction r as [| [a d] r IH]; cbn [map fold_right]; [reflexivity |].
  rewrite map_rows_cons. cbn [energy]. rewrite IH. cbn [fst snd].
  change (val (Apply (Div (Apply (Sqr (product_with a v))) (Entry d)))) with (val (product_with a v) ^ 2 / at_ d).
  rewrite val_product. reflexivity.
Qed.
End Values.

(** ** Over a cell *)

Section Precision.
Variable bits : positive.

Fixpoint eval (coords params : list slope) (values : list (option slope)) (e : expr) : option slope :=
  match e with
  | Entry i => nth i values None
  | Apply o => slope_op bits coords params (map_op (eval coords params values) o)
  end.

Definition is_positive (s : option slope) : bool := match s with Some s => (0 <? lo (range s))%Z | None => false end.

Section Cell.
Variable lambda : list R.
Hypothesis lambda_in : Forall (fun t => -1 <= t <= 1) lambda.
Variables xs cs theta : list R.
Variables coords params : list slope.
Hypothesis coords_hold : forall k, Slope.holds bits lambda (nth k coords (constant zero)) (nth k cs 0) (nth k xs 0).
Hypothesis params_hold : forall j, Slope.holds bits lambda (nth j params (constant zero)) (nth j theta 0) (nth j theta 0).
Variable tape : list (op address).
Let values := run (option slope) None (slope_op bits coords params) tape.

Lemma eval_sound : forall e, encloses bits lambda xs cs theta (eval coords params values e) (formula_of tape e).
Proof.
  pose proof (slope_op_sound bits lambda lambda_in xs cs theta coords params coords_hold params_hold nat) as S.
  fix IH 1. intros [i | o]; cbn [eval formula_of].
  - apply (nth_related _ _ None (integer 0) (encloses bits lambda xs cs theta)); [exact I |].
    exact (evaluate_sound bits lambda lambda_in xs cs theta coords params coords_hold params_hold tape).
  - assert (Two : forall a b, forall i, encloses bits lambda xs cs theta
        (match i with O => eval coords params values a | _ => eval coords params values b end)
        (match i with O => formula_of tape a | _ => formula_of tape b end)) by (intros a b [| i]; apply IH).
    destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [map_op].
    + exact (S (Coord k) (fun _ => None) (fun _ => integer 0) (fun _ => I)).
    + exact (S (Param j) (fun _ => None) (fun _ => integer 0) (fun _ => I)).
    + exact (S (Integer n) (fun _ => None) (fun _ => integer 0) (fun _ => I)).
    + exact (S (Add 0 1)%nat _ _ (Two a b)).
    + exact (S (Sub 0 1)%nat _ _ (Two a b)).
    + exact (S (Neg 0%nat) _ _ (Two a a)).
    + exact (S (Mul 0 1)%nat _ _ (Two a b)).
    + exact (S (Div 0 1)%nat _ _ (Two a b)).
    + exact (S (Sqr 0%nat) _ _ (Two a a)).
    + exact (S (Sqrt 0%nat) _ _ (Two a a)).
    + refine (S (Elbow second 0 1 2)%nat (fun i => eval coords params values (match i with O => a | 1%nat => b | _ => t end)) (fun i => formula_of tape (match i with O => a | 1%nat => b | _ => t end)) _).
      intros [| [| i]]; apply IH.
Qed.

Lemma is_positive_sound : forall e, is_positive (eval coords params values e) = true -> 0 < val tape xs theta e.
Proof.
  intros e h. pose proof (eval_sound e) as S. destruct (eval coords params values e) as [s |]; [| discriminate].
  destruct S as [_ [_ [_ [c _]]]]. apply Z.ltb_lt in h. exact (contains_positive bits _ _ h c).
Qed.
End Cell.

(** ** What has to be positive, that something fails *)

Definition is_direction (v : list Z) : bool := Nat.eqb (length v) 3 && existsb (fun n => negb (n =? 0)%Z) v.

(** What fails, by the places of its formulas: along which directions what is then positive. [k]: a bound's square. *)
Inductive failing :=
  | Short (r : rows nat) (k : expr)     (* k |v|^2 - |M v|^2 *)
  | Long (r : rows nat) (k : expr)      (* |M v|^2 - k |v|^2 *)
  | Uneven (r : rows nat) (k : expr)    (* |M u|^2 |v|^2 - k |M v|^2 |u|^2 *)
  | Below (fs : list nat).              (* the opposite of each *)

(** [j] is the place of the requirement's bound. *)
Definition failing_of (place : formula -> nat) (fs : list leg_formulas) (s : Z) (j : nat * nat) (r : requirement) : option failing :=
  let whole := map_rows place (whole_rows fs) in
  let bound2 := Apply (Sqr (Apply (Param (fst j)))) in
  let least k := option_map (fun rs => Short (map_rows place rs) k) (least_rows fs s j r) in
  let below := match range_formula fs s j r with [] => None | l => Some (Below (map place l)) end in
  match r with
  | PsiMax _ => Some (Short whole bound2)
  | PsiMin _ => Some (Long whole bound2)
  | ConditionMax _ => Some (Uneven whole bound2)
  | Stiffness joint b => if certainly bits true (Over b joint) then least (Apply (Integer 1)) else None
  | ConstraintMargin _ => least bound2
  | JointSpeed _ tool _ => if certainly bits true tool then below else None
  | JointMin _ _ | JointMax _ _ | SerialMargin _ _ | ParallelMargin _ => below
  | _ => None
  end.

(** Rows of which all D_i, and expressions which have to be positive. *)
Definition fails_along (f : failing) (directions : list (list Z)) : option (rows nat * list expr) :=
  match f, directions with
  | Short r k, [v] => Some (r, [Apply (Sub (Apply (Mul k (square_of v))) (image_of r v))])
  | Long r k, [v] => Some (r, [Apply (Sub (image_of r v) (Apply (Mul k (square_of v))))])
  | Uneven r k, [u; v] => Some (r, [Apply (Sub (Apply (Mul (image_of r u) (square_of v)))
      (Apply (Mul k (Apply (Mul (image_of r v) (square_of u))))))])
  | Below l, [] => Some ([], map (fun f => Apply (Neg (Entry f))) l)
  | _, _ => None
  end.

(** By the row of a leg that is longer than 1/psi_min: |A_i|^2 > k^2 D_i, or it does not reach. *)
Definition row_fails (rod d j : nat) : expr := Apply (Sub (Apply (Sqr (Entry rod))) (Apply (Mul (Apply (Sqr (Apply (Param j)))) (Entry d)))).

(** What may fail of a claim. *)
Record failings := Failings { its_D : list nat; its_rods : list nat; its_requirements : list (option failing) }.
Definition place_of (n : nat * nat) (s : Z) (rs : list requirement) (i : nat) : nat * nat :=
  (fst n + i, snd n + length (flat_map (extras s) (firstn i rs)))%nat.
Definition failings_of (place : formula -> nat) (fs : list leg_formulas) (s : Z) (n : nat * nat) (rs : list requirement) : failings :=
  Failings (map (fun f => place (f_D f)) fs) (map (fun f => place (rod f)) fs)
    (map (fun i => match nth_error rs i with Some r => failing_of place fs s (place_of n s rs i) r | None => None end) (seq 0 (length rs))).

(** [first] is the place of the first bound; what has to be positive is tested by [positive], D_i by their ranges. *)
Definition fails_over (first : nat) (rs : list requirement) (b : failings) (positive : option slope -> bool)
    (coords params : list slope) (values : list (option slope)) (f : Configuration.nfailure) : bool :=
  let is e := positive (eval coords params values e) in
  match f with
  | Configuration.NOutOfReach => existsb (fun d => match nth d values None with Some d => (hi (range d) <=? 0)%Z | None => false end) (its_D b)
  | Configuration.NFails i directions => forallb is_direction directions &&
      match nth i (its_requirements b) None with
      | Some f => match fails_along f directions with
          | Some (rows, es) => forallb (fun p => is_positive (nth (snd p) values None)) rows && forallb is es
          | None => false
          end
      | None => false
      end
  | Configuration.NFailsAlong i leg =>
      match nth_error rs i, nth_error (its_D b) leg, nth_error (its_rods b) leg with Some (PsiMin _), Some d, Some rod => is (row_fails rod d (first + i)) | _, _, _ => false end
  | Configuration.NDependent => false
  end.

(** *** What it shows *)

Section Shown.
Variables (c : claim) (s : Z) (ds : list Z) (m : list leg) (P : vec) (theta : list R).
Let ratio := / two_to s.
Let fs := all_formulas s ds (legs c) 0.
Variable tape : list (op address).
Local Notation Q := (vscale ratio P).
Local Notation x := (coordinates Q).
Local Notation found := (place (formulas tape)).
Local Notation val := (val tape x theta).
Hypothesis represented : Forall2 (represents Q theta) fs (map (resized ratio) m).
Hypothesis built : Forall well_formed_leg m.
Hypothesis of_them : Forall2 is_leg_of (legs c) m.
Variable n : nat * nat.
Hypothesis bounds_at : forall k r, nth_error (require c) k = Some r -> nth (fst n + k) theta 0 = bound_value s r.
Hypothesis is_found : forall e, In e (entries (whole_rows fs) ++ map rod fs ++ range_formulas fs s n (require c)) ->
  formula_at tape (found e) = e.

Lemma ratio_positive : 0 < ratio.
Proof. apply Rinv_0_lt_compat, two_to_pos. Qed.

Lemma whole_found : map_rows (formula_at tape) (map_rows found (whole_rows fs)) = whole_rows fs.
Proof. apply rows_found. intros e i. apply is_found, in_or_app. left. exact i. Qed.

Lemma entry_found : forall f, formula_at tape (found f) = f -> val (Entry (found f)) = value x theta f.
Proof. intros f e. unfold Named.val. cbn [formula_of]. rewrite e. reflexivity. Qed.

(** Rows on the tape have the values of their formulas. *)
Lemma rows_at : forall r, map_rows (formula_at tape) (map_rows found r) = r ->
  map_rows (fun i => value x theta (formula_at tape i)) (map_rows found r) = map_rows (value x theta) r.
Proof.
  intros r e. rewrite <- e at 2. unfold map_rows. rewrite !map_map. apply map_ext. intros [a d]. cbn [fst snd].
  rewrite !map_map. reflexivity.
Qed.

Lemma positive_rows : forall r, map_rows (formula_at tape) (map_rows found r) = r ->
  Forall (fun p => 0 < val (Entry (snd p))) (map_rows found r) -> positive_D (map_rows (value x theta) r).
Proof.
  intros r e h. rewrite <- (rows_at r e). unfold positive_D, map_rows at 1. apply Forall_map.
  eapply Forall_impl; [| exact h]. intros [a d] k. exact k.
Qed.

Lemma speeds : positive_D (map_rows (value x theta) (whole_rows fs)) ->
  forall v, energy (map_rows (value x theta) (whole_rows fs)) (coordinates v) = speed2 m P v.
Proof.
  intros p v. destruct (whole_speed Q theta fs _ represented p) as [_ h]. rewrite h. apply speed2_resized, ratio_positive.
Qed.

Lemma direction_vector : forall v, is_direction v = true -> exists u, map IZR v = coordinates u /\ u <> vzero.
Proof.
  intros v h. apply andb_true_iff in h as [h e]. destruct v as [| a [| b [| d [|]]]]; try discriminate.
  exists (Vec (IZR a) (IZR b) (IZR d)). split; [reflexivity |]. intro z. unfold vzero in z. injection z as z1 z2 z3.
  apply eq_IZR in z1, z2, z3. subst. discriminate.
Qed.

Lemma plain_bound : forall r b, bound_of s r = (exactly b, 0%Z) -> bound_value s r = Claim.value b.
Proof. intros r b e. unfold bound_value. rewrite e. cbn. change (two_to 0) with 1. unfold Rdiv. rewrite Rinv_1. ring. Qed.

Lemma length_bound : forall r b, bound_of s r = (exactly b, s) -> bound_value s r = ratio * Claim.value b.
Proof. intros r b e. unfold bound_value. rewrite e. cbn [fst snd exactly greatest]. unfold Rdiv. fold ratio. ring. Qed.

Lemma psi_bound : forall r b, bound_of s r = (exactly (Over (1 // 1) b), 0%Z) -> bound_value s r ^ 2 = (1 / Claim.value b) ^ 2.
Proof. intros r b e. rewrite (plain_bound _ _ e). cbn [Claim.value]. replace (1 / 1) with 1 by field. reflexivity. Qed.

Section Requirement.
Variables (i : nat) (r : requirement).
Hypothesis is_required : nth_error (require c) i = Some r.
Let j := (fst n + i, snd n + length (flat_map (extras s) (firstn i (require c))))%nat.

Lemma bound_is : nth (fst j) theta 0 = bound_value s r.
Proof. apply bounds_at, is_required. Qed.

Lemma bound2_val : val (Apply (Sqr (Apply (Param (fst j))))) = bound_value s r ^ 2.
Proof. change (nth (fst j) theta 0 ^ 2 = bound_value s r ^ 2). rewrite bound_is. reflexivity. Qed.

Lemma range_found : forall f, In f (range_formula fs s j r) -> formula_at tape (found f) = f.
Proof.
  intros f h. apply is_found, in_or_app. right. apply in_or_app. right.
  assert (G : forall l k q, nth_error l k = Some q -> forall n,
    In f (range_formula fs s (fst n + k, snd n + length (flat_map (extras s) (firstn k l)))%nat q) -> In f (range_formulas fs s n l)).
  { induction l as [| p l IH]; intros [| k] q e n' g; try discriminate; cbn [range_formulas]; apply in_or_app.
    - injection e as <-. cbn [firstn flat_map length] in g. rewrite !Nat.add_0_r, <- surjective_pairing in g. left. exact g.
    - right. apply (IH k q e). unfold next. cbn [fst snd]. cbn [firstn flat_map] in g. rewrite app_length in g.
      replace (S (fst n') + k)%nat with (fst n' + S k)%nat by lia. rewrite <- Nat.add_assoc. exact g. }
  exact (G (require c) i r is_required n h).
Qed.

Hypothesis reached : Forall (reaches P) m.

Lemma ratio_lt : forall a b, ratio * a < ratio * b -> a < b.
Proof. intros a b h. apply Rmult_lt_reg_l with ratio; [exact ratio_positive | exact h]. Qed.

(** The row's norm, by that of A. *)
Lemma row_norm : forall f l, represents Q theta f (resized ratio l) -> reaches P l ->
  0 < value x theta (f_D f) /\ norm2 (row l P) * value x theta (f_D f) = norm2 (vvalue Q theta (f_A f)).
Proof.
  intros f l R re. destruct R as [R1 [_ [_ [_ [R2 _]]]]]. destruct (resized_same ratio P ratio_positive l) as [er [_ eq]].
  assert (D : 0 < value x theta (f_D f)) by (apply R2, eq, re). split; [exact D |]. destruct (R1 D) as [_ h].
  rewrite er in h. set (d := value x theta (f_D f)) in *. set (A := vvalue Q theta (f_A f)) in *. clearbody d A.
  set (q := row l P) in *. clearbody q. clear - h D.
  assert (E : forall v, Vec3.dot q v ^ 2 * d = Vec3.dot A v ^ 2) by (intro v; rewrite <- h; field; lra).
  pose proof (E (Vec 1 0 0)) as X. pose proof (E (Vec 0 1 0)) as Y. pose proof (E (Vec 0 0 1)) as Z.
  unfold Vec3.dot in X, Y, Z. cbn [vx vy vz] in X, Y, Z. unfold norm2. nra.
Qed.

Lemma signs_fail : forall f, In f (range_formula fs s j r) -> value x theta f < 0 ->
  (forall g, In g (range_formula fs s j r) -> value x theta g < 0) ->
  match r with JointSpeed _ tool _ => 0 < Claim.value tool | _ => True end -> is_least r = false -> ~ fulfils c m P r.
Proof.
  intros f i0 neg all given least F. pose proof (leg_at c s ds m P theta represented reached) as At. fold fs in At. fold ratio in At.
  pose proof ratio_positive as r0. pose proof bound_is as Bj.
  pose proof (bound_here s P theta j r Bj) as B. fold ratio in B.
  destruct r as [| b | b | k b | k b | k tool b | b | k b | b | joint b | b | one other b | k one other b | k a v b | k tool b | | error b | ks kb]; cbn [range_formula is_least] in *; try contradiction; try discriminate;
    try (destruct (nth_error fs k) as [g |] eqn:ng; [| contradiction]; destruct (At k g ng) as [l [nl [R re]]]).
  - destruct i0 as [<- |]; [| contradiction]. destruct F as [l' [n' F]]. rewrite nl in n'. injection n' as <-.
    destruct R as [_ [_ [_ [J _]]]]. rewrite value_minus, J, B, (length_bound (JointMin k b) b eq_refl) in neg.
    destruct (resized_same ratio P r0 l) as [_ [e _]]. rewrite e in neg.
    assert (ratio * Claim.value b <= ratio * joint l P) by (apply Rmult_le_compat_l; lra). lra.
  - destruct i0 as [<- |]; [| contradiction]. destruct F as [l' [n' F]]. rewrite nl in n'. injection n' as <-.
    destruct R as [_ [_ [_ [J _]]]]. rewrite value_minus, J, B, (length_bound (JointMax k b) b eq_refl) in neg.
    destruct (resized_same ratio P r0 l) as [_ [e _]]. rewrite e in neg.
    assert (ratio * joint l P <= ratio * Claim.value b) by (apply Rmult_le_compat_l; lra). lra.
  - destruct i0 as [<- |]; [| contradiction]. destruct F as [l' [n' F]]. rewrite nl in n'. injection n' as <-.
    destruct (row_norm g l R re) as [D N].
    rewrite !value_minus, value_times, !Formula.value_square, B, (plain_bound (JointSpeed k tool b) (Over b tool) eq_refl) in neg.
    cbn [Claim.value] in neg. set (t := Claim.value tool) in *. set (y := Claim.value b) in *.
    assert (G : (y / t) ^ 2 * value x theta (f_D g) < norm2 (row l P) * value x theta (f_D g)).
    { rewrite N. unfold norm2, vvalue. cbn [vx vy vz]. lra. }
    apply Rmult_lt_reg_r in G; [| exact D]. set (q := row l P) in *. clearbody q.
    assert (y ^ 2 < t ^ 2 * norm2 q).
    { replace (y ^ 2) with (t ^ 2 * (y / t) ^ 2) by (field; lra). apply Rmult_lt_compat_l; [apply pow_lt, given | exact G]. }
    assert (n0 : 0 < norm2 q) by (pose proof (pow2_ge_0 (y / t)); lra). pose proof (sqrt_lt_R0 _ n0) as s0.
    assert (S : sqrt (norm2 q) ^ 2 = norm2 q) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra).
    specialize (F (vscale (t / sqrt (norm2 q)) q)). rewrite norm2_scale in F. unfold Rdiv in F.
    rewrite Rpow_mult_distr, pow_inv, S in F. rewrite Rmult_assoc, Rinv_l, Rmult_1_r in F by lra. specialize (F (Rle_refl _)).
    assert (E : Vec3.dot q (vscale (t * / sqrt (norm2 q)) q) = t * / sqrt (norm2 q) * norm2 q)
      by (rewrite norm2_dot; unfold Vec3.dot, vscale; cbn [vx vy vz]; ring).
    rewrite E, !Rpow_mult_distr, pow_inv, S in F. replace (t ^ 2 * / norm2 q * norm2 q ^ 2) with (t ^ 2 * norm2 q) in F by (field; lra). lra.
  - destruct (f_length g) as [len |] eqn:el; [| contradiction]. destruct i0 as [<- |]; [| contradiction].
    destruct F as [k' [n' F]]. rewrite nl in n'. injection n' as ->.
    destruct (row_norm g _ R re) as [D _]. destruct R as [_ [_ [_ [_ [_ [R3 _]]]]]]. destruct (R3 len el) as [k0 [e1 [e2 [e3 _]]]].
    destruct (guided_resized ratio P r0 _ _ e1) as [p [ep [g1 [g2 _]]]]. injection ep as <-.
    rewrite value_minus, value_times, !Formula.value_square, B, e2, (e3 D), g1, g2, (plain_bound (SerialMargin k b) b eq_refl) in neg.
    pose proof (pow_lt ratio 2 r0) as p0. assert (ratio ^ 2 * (Claim.value b * leg_length k') ^ 2 <= ratio ^ 2 * eta k' P ^ 2)
      by (apply Rmult_le_compat_l; lra). nra.
  - destruct F as [k1 [k2 [k3 [em F]]]].
    assert (RE : Forall2 (represents Q theta) fs (map (resized ratio) [k1; k2; k3])) by (rewrite <- em; exact represented).
    destruct fs as [| f1 [| f2 [| f3 [|]]]] eqn:efs; try contradiction.
    pose proof (all _ (or_introl eq_refl)) as n1. pose proof (all _ (or_intror (or_introl eq_refl))) as n2. clear neg all i0.
    cbn [map] in RE. apply cons_related in RE as [H1 RE]. apply cons_related in RE as [H2 RE]. apply cons_related in RE as [H3 _].
    destruct H1 as [_ [[_ [c1 b1]] _]]. destruct H2 as [_ [[_ [c2 b2]] _]]. destruct H3 as [_ [[_ [c3 b3]] _]].
    destruct (vector_resized ratio P r0 k1) as [q1 [p1 [v1 g1]]]. destruct (vector_resized ratio P r0 k2) as [q2 [p2 [v2 g2]]]. destruct (vector_resized ratio P r0 k3) as [q3 [p3 [v3 g3]]].
    pose proof (determinant_value s P theta) as DV. fold ratio in DV.
    rewrite value_minus, DV, !value_times, B, b1, b2, b3, g1, g2, g3, c1, c2, c3, v1, v2, v3, det_scaled,
      (plain_bound (ParallelMargin b) b eq_refl) in n1.
    rewrite value_opposite, value_plus, DV, !value_times, B, b1, b2, b3, g1, g2, g3, c1, c2, c3, v1, v2, v3, det_scaled,
      (plain_bound (ParallelMargin b) b eq_refl) in n2.
    set (d := det _) in *. set (L := Claim.value b * size_of k1 P * size_of k2 P * size_of k3 P) in *.
    replace (Claim.value b * (q1 * size_of k1 P) * (q2 * size_of k2 P) * (q3 * size_of k3 P)) with (q1 * q2 * q3 * L) in n1, n2 by (unfold L; ring).
    assert (t0 : 0 < q1 * q2 * q3) by (repeat apply Rmult_lt_0_compat; assumption). clearbody d L.
    assert (d < L) by (apply Rmult_lt_reg_l with (q1 * q2 * q3); [exact t0 | lra]).
    assert (- L < d) by (apply Rmult_lt_reg_l with (q1 * q2 * q3); [exact t0 | lra]).
    unfold Rabs in F. destruct (Rcase_abs d); lra.
Qed.

Lemma requirement_fails_sound : forall f directions rows es, failing_of found fs s j r = Some f -> forallb is_direction directions = true ->
  fails_along f directions = Some (rows, es) ->
  Forall (fun p => 0 < val (Entry (snd p))) rows -> Forall (fun e => 0 < val e) es -> ~ fulfils c m P r.
Proof.
  intros f directions rows es hf dirs h pos hes.
  pose proof bound_is as B1. pose proof bound2_val as B2. pose proof signs_fail as SF. pose proof range_found as RF.
  pose proof (fun p => speeds (positive_rows _ whole_found p)) as SP.
  pose proof (rows_at _ whole_found) as RA.
  assert (Dir : forall v, In v directions -> exists u, map IZR v = coordinates u /\ u <> vzero)
    by (intros v i0; rewrite forallb_forall in dirs; apply direction_vector, dirs, i0).
  assert (Sq : forall v u, map IZR v = coordinates u -> val (square_of v) = norm2 u)
    by (intros v u e; rewrite val_square, e, dot_coordinates, norm2_dot; reflexivity).
  assert (Im : Forall (fun p => 0 < val (Entry (snd p))) (map_rows found (whole_rows fs)) ->
    forall v u, map IZR v = coordinates u -> val (image_of (map_rows found (whole_rows fs)) v) = speed2 m P u)
    by (intros p v u e; rewrite val_image, RA, e; apply SP, p).
  assert (Sub_ : forall a b, val (Apply (Sub a b)) = val a - val b) by reflexivity.
  assert (Mul_ : forall a b, val (Apply (Mul a b)) = val a * val b) by reflexivity.
  assert (Neg_ : forall g, formula_at tape (found g) = g -> val (Apply (Neg (Entry (found g)))) = - value x theta g)
    by (intros g e; change (- val (Entry (found g)) = - value x theta g); rewrite entry_found by exact e; reflexivity).
  unfold failing_of in hf. set (k2 := Apply (Sqr (Apply (Param (fst j))))) in *.
  assert (Signs : match range_formula fs s j r with [] => None | l => Some (Below (map found l)) end = Some f ->
      match r with JointSpeed _ tool _ => 0 < Claim.value tool | _ => True end -> is_least r = false -> ~ fulfils c m P r).
  { intros e t l. destruct (range_formula fs s j r) as [| g fl] eqn:er; [discriminate |]. injection e as <-.
    destruct directions; [| discriminate]. cbn [fails_along] in h. injection h as <- <-.
    change (Forall (fun e => 0 < val e) (map (fun f => Apply (Neg (Entry f))) (map found (g :: fl)))) in hes. rewrite map_map in hes.
    assert (N : forall k, In k (g :: fl) -> value x theta k < 0).
    { intros k ik. pose proof (proj1 (Forall_forall _ _) hes _ (in_map (fun f => Apply (Neg (Entry (found f)))) (g :: fl) k ik)) as z.
      cbv beta in z. rewrite (Neg_ k (RF k ik)) in z. lra. }
    apply (SF g); [left; reflexivity | apply N; left; reflexivity | exact N | exact t | exact l]. }
  destruct r as [| b | b | k b | k b | k tool b | b | k b | b | joint b | b | one other b | k one other b | k a v b | k tool b | | error b | ks kb]; cbn [is_least] in *;
    try discriminate; try exact (Signs hf I eq_refl).
  - injection hf as <-. destruct directions as [| v [|]]; try discriminate. injection h as <- <-. intro F.
    destruct (Dir v (or_introl eq_refl)) as [u [eu nz]]. apply Forall_inv in hes.
    rewrite Sub_, Mul_, B2, (Sq v u eu), (Im pos v u eu), (psi_bound (PsiMax b) b eq_refl) in hes. specialize (F u). lra.
  - injection hf as <-. destruct directions as [| v [|]]; try discriminate. injection h as <- <-. intro F.
    destruct (Dir v (or_introl eq_refl)) as [u [eu nz]]. apply Forall_inv in hes.
    rewrite Sub_, Mul_, B2, (Sq v u eu), (Im pos v u eu), (psi_bound (PsiMin b) b eq_refl) in hes. specialize (F u). lra.
  - destruct (certainly bits true tool) eqn:given; [| discriminate]. apply (Signs hf); [apply (positive_sound bits), given | reflexivity].
  - injection hf as <-. destruct directions as [| v [| w [|]]]; try discriminate. injection h as <- <-. intro F.
    destruct (Dir v (or_introl eq_refl)) as [u [eu _]]. destruct (Dir w (or_intror (or_introl eq_refl))) as [t [et _]].
    apply Forall_inv in hes. rewrite Sub_, !Mul_, B2, (Sq v u eu), (Sq w t et), (Im pos v u eu), (Im pos w t et),
      (plain_bound (ConditionMax b) b eq_refl) in hes. specialize (F u t). lra.
  - destruct (certainly bits true (Over b joint)) eqn:given; [| discriminate]. cbn [least_rows option_map] in hf. injection hf as <-.
    destruct directions as [| v [|]]; try discriminate. injection h as <- <-. intro F.
    destruct (Dir v (or_introl eq_refl)) as [u [eu nz]]. apply Forall_inv in hes.
    set (q := quantity (exactly (Over b joint), 0%Z) (fst n + i)%nat) in *.
    assert (LF : map_rows (formula_at tape) (map_rows found (stiff_rows fs q)) = stiff_rows fs q).
    { apply rows_found. intros e ie. apply RF. exact ie. }
    apply (positive_sound bits) in given. cbn [Claim.value] in given.
    assert (K : value x theta q = Claim.value b / Claim.value joint).
    { assert (e : value x theta q = bound_value s (Stiffness joint b)) by exact (bound_here s P theta j (Stiffness joint b) B1). rewrite e.
      apply (plain_bound (Stiffness joint b) (Over b joint) eq_refl). }
    rewrite Sub_, Mul_, (Sq v u eu) in hes. rewrite val_image, (rows_at _ LF), eu in hes.
    unfold ratio in K, hes. rewrite (stiff_energy s P theta q fs m) in hes; try assumption; [| rewrite K; exact given].
    change (val (Apply (Integer 1))) with 1 in hes. rewrite K in hes. specialize (F u). cbn [fulfils] in F.
    set (y := Claim.value b / Claim.value joint) in *. clearbody y.
    assert (y * norm2 u - speed2 m P u > 0); [| lra].
    replace (y * norm2 u - speed2 m P u) with (y * (1 * norm2 u - / y * speed2 m P u)) by (field; lra).
    apply Rmult_lt_0_compat; assumption.
  - cbn [least_rows option_map] in hf. destruct (couple_rows fs) as [rs |] eqn:er; [| discriminate]. injection hf as <-.
    destruct directions as [| v [|]]; try discriminate. injection h as <- <-. intro F. destruct (Dir v (or_introl eq_refl)) as [u [eu nz]]. apply Forall_inv in hes.
    assert (LF : map_rows (formula_at tape) (map_rows found rs) = rs).
    { apply rows_found. intros e ie. apply RF. cbn [range_formula least_rows]. rewrite er. exact ie. }
    destruct (couples_energy s P theta fs m represented rs er (positive_rows _ LF pos)) as [cs [c1 c2]].
    destruct F as [cs' [d1 d2]].
    assert (cs' = cs).
    { clear - c1 d1. revert cs' d1. induction c1 as [| l a m cs [e _] c1 IH]; intros cs' d1; inversion d1 as [| ? ? ? ? [e' _] d]; subst; [reflexivity |].
      f_equal; [congruence | apply IH; assumption]. }
    subst cs'. rewrite Sub_, Mul_, B2, (Sq v u eu), (plain_bound (ConstraintMargin b) b eq_refl) in hes.
    rewrite val_image, (rows_at _ LF), eu in hes. unfold ratio in hes. rewrite c2 in hes.
    specialize (d2 u). lra.
Qed.
End Requirement.

(** ** By a leg *)

Hypothesis reached : Forall (reaches P) m.

Lemma rods : forall i f, nth_error fs i = Some f -> exists l, nth_error m i = Some l /\
  0 < value x theta (f_D f) /\ norm2 (row l P) * value x theta (f_D f) = value x theta (rod f) ^ 2.
Proof.
  intros i f e. pose proof ratio_positive as r0.
  destruct (leg_at c s ds m P theta represented reached i f e) as [l [nl [R re]]]. fold ratio in R.
  exists l. split; [exact nl |]. destruct (row_norm f l R re) as [D N]. split; [exact D |].
  assert (ok : well_formed_leg l) by (rewrite Forall_forall in built; apply built, (nth_error_In _ _ nl)).
  assert (G : f_length f = None -> match l with Guided _ => False | _ => True end).
  { unfold fs in e. clear - e nl of_them. revert i e nl. generalize O. generalize ds.
    induction of_them as [| d k drs ms h hs IH]; intros ds0 j i e nl; [destruct i; discriminate |].
    cbn [all_formulas] in e. destruct i as [| i]; [| exact (IH hs _ _ i e nl)].
    cbn [nth_error] in e, nl. injection nl as ->. injection e as <-. destruct d, l; try contradiction; try exact (fun _ => I). discriminate. }
  unfold rod. destruct (f_length f) as [len |] eqn:el.
  - destruct R as [_ [_ [_ [_ [_ [R3 _]]]]]]. destruct (R3 len el) as [k [e1 [e2 [_ e4]]]].
    destruct (guided_resized ratio P r0 l k e1) as [k' [-> [g1 [_ g3]]]].
    rewrite N, e4, g3, norm2_scale, e2, g1, (leg_vector_length k' P ok re). ring.
  - specialize (G eq_refl). rewrite value_root. rewrite <- Rsqr_pow2, Rsqr_sqrt by lra.
    destruct l as [| a p k | d]; [contradiction | |]; cbn [row].
    + rewrite normalised_norm by exact re. ring.
    + rewrite normalised_norm by (apply norm2_pos; exact ok). ring.
Qed.

Lemma row_fails_sound : forall i b leg f, nth_error (require c) i = Some (PsiMin b) -> nth_error fs leg = Some f ->
  0 < val (row_fails (found (rod f)) (found (f_D f)) (fst n + i)) -> ~ fulfils c m P (PsiMin b).
Proof.
  intros i b leg f er ef h F. destruct (rods leg f ef) as [l [nl [D N]]].
  assert (E : val (row_fails (found (rod f)) (found (f_D f)) (fst n + i)) = value x theta (rod f) ^ 2 - bound_value s (PsiMin b) ^ 2 * value x theta (f_D f)).
  { change (val (Entry (found (rod f))) ^ 2 - nth (fst n + i) theta 0 ^ 2 * val (Entry (found (f_D f))) = value x theta (rod f) ^ 2 - bound_value s (PsiMin b) ^ 2 * value x theta (f_D f)).
    rewrite (bounds_at i _ er), !entry_found; [reflexivity | |]; apply is_found.
    - apply in_or_app. left. unfold entries, whole_rows. rewrite flat_map_concat_map, in_concat. rewrite map_map.
      eexists. split; [apply in_map_iff; exists f; split; [reflexivity | exact (nth_error_In _ _ ef)] |]. cbn [snd fst]. apply in_or_app. right. left. reflexivity.
    - apply in_or_app. right. apply in_or_app. left. apply in_map, (nth_error_In _ _ ef). }
  rewrite E, <- N, (psi_bound (PsiMin b) b eq_refl) in h. specialize (F (row l P)). set (q := row l P) in *.
  assert (G : (1 / Claim.value b) ^ 2 < norm2 q).
  { apply Rmult_lt_reg_r with (value x theta (f_D f)); [exact D | lra]. }
  assert (S : norm2 q ^ 2 <= speed2 m P q).
  { rewrite norm2_dot. clear - nl. unfold q. revert leg nl. induction m as [| k ms IH]; intros [| i] e; try discriminate; cbn [nth_error speed2 fold_right] in *.
    - injection e as ->. assert (0 <= fold_right (fun l0 sum => Vec3.dot (row l0 P) (row l P) ^ 2 + sum) 0 ms); [| lra].
      clear. induction ms as [| k ms IH]; cbn [fold_right]; [lra |]. pose proof (pow2_ge_0 (Vec3.dot (row k P) (row l P))). lra.
    - specialize (IH i e). unfold speed2 in IH. pose proof (pow2_ge_0 (Vec3.dot (row k P) (row l P))). lra. }
  pose proof (pow2_ge_0 (1 / Claim.value b)). nra.
Qed.

Lemma fails_over_sound : forall lambda cs coords params values positive f, let b := failings_of found fs s n (require c) in
  (forall e, encloses bits lambda x cs theta (eval coords params values e) (formula_of tape e)) ->
  (forall e, positive (eval coords params values e) = true -> 0 < val e) ->
  fails_over (fst n) (require c) b positive coords params values f = true -> ~ Forall (fulfils c m P) (require c).
Proof.
  intros lambda cs coords params values positive f b E Pos hf met. rewrite Forall_forall in met.
  destruct f as [| i dirs | i leg |]; [| | | discriminate]; cbn [fails_over] in hf; unfold b, failings_of in hf; cbn [its_D its_rods its_requirements] in hf.
  - apply existsb_exists in hf as [g' [ig hf]]. apply in_map_iff in ig as [g [<- ig]]. destruct (nth (found (f_D g)) values None) as [d |] eqn:ed; [| discriminate].
    destruct (In_nth_error _ _ ig) as [k ek]. destruct (leg_at c s ds m P theta represented reached k g ek) as [l [_ [Rl re]]].
    destruct (row_norm g l Rl re) as [D _]. pose proof (E (Entry (found (f_D g)))) as V.
    cbn [eval formula_of] in V. rewrite ed in V. destruct V as [_ [_ [_ [V _]]]]. rewrite is_found in V.
    + apply Z.leb_le, IZR_le in hf. destruct V as [_ V]. pose proof (unit_R_pos bits). nra.
    + apply in_or_app. left. unfold entries, whole_rows. rewrite flat_map_concat_map, in_concat, map_map.
      eexists. split; [apply in_map_iff; exists g; split; [reflexivity | exact ig] |]. cbn [snd fst]. apply in_or_app. right. left. reflexivity.
  - apply andb_true_iff in hf as [hd hf]. destruct (nth i (map _ (seq 0 (length (require c)))) None) as [g |] eqn:eg; [| discriminate].
    assert (li : (i < length (require c))%nat).
    { apply Nat.lt_nge. intro ge. rewrite nth_overflow in eg by (rewrite map_length, seq_length; exact ge). discriminate. }
    match type of eg with nth _ (map ?h _) _ = _ => set (of := h) in eg end.
    rewrite (nth_indep _ None (of O)), map_nth, seq_nth in eg by (rewrite ?map_length, ?seq_length; exact li). unfold of in eg. cbn [Nat.add] in eg.
    destruct (nth_error (require c) i) as [r |] eqn:er; [| discriminate].
    destruct (fails_along g dirs) as [[rows es] |] eqn:ef; [| discriminate].
    apply andb_true_iff in hf as [h1 h2]. rewrite forallb_forall in h1, h2.
    apply (requirement_fails_sound i r er reached g dirs rows es eg hd ef).
    + apply Forall_forall. intros p ip. specialize (h1 p ip). pose proof (E (Entry (snd p))) as V. cbn [eval formula_of] in V.
      destruct (nth (snd p) values None) as [d |]; [| discriminate]. destruct V as [_ [_ [_ [V _]]]]. apply Z.ltb_lt in h1. exact (contains_positive bits _ _ h1 V).
    + apply Forall_forall. intros e ie. apply Pos, h2, ie.
    + apply met, (nth_error_In _ _ er).
  - destruct (nth_error (require c) i) as [q |] eqn:er; [| discriminate]. destruct q as [| | b' | | | | | | | | | | | | | | |]; try discriminate.
    rewrite !nth_error_map in hf. destruct (nth_error fs leg) as [g |] eqn:eg; [| discriminate]. cbn [option_map] in hf.
    apply (row_fails_sound i b' leg g er eg); [apply Pos, hf |].
    apply met, (nth_error_In _ _ er).
Qed.
End Shown.

(** ** Leaves, and the tree *)

(** Coordinates of the cell's points, moved by multiples of [part]. *)
Fixpoint moved_by (part : fixed) (l : list slope) (at_ : list Z) : list slope :=
  match l, at_ with
  | t :: l', n :: at' => let by_ := mul bits (Fixed.integer bits n) part in
      Slope (add (at_c t) by_) (add (range t) by_) (slopes t) :: moved_by part l' at'
  | _, _ => []
  end.
Definition moved (y : R) (x : list R) (at_ : list Z) : list R := map (fun p => fst p + IZR (snd p) * y) (combine x at_).

Lemma moved_by_hold : forall lambda part y l at_ cs xs, contains bits part y -> length at_ = length l -> length cs = length l -> length xs = length l ->
  (forall k, Slope.holds bits lambda (nth k l (constant zero)) (nth k cs 0) (nth k xs 0)) ->
  forall k, Slope.holds bits lambda (nth k (moved_by part l at_) (constant zero)) (nth k (moved y cs at_) 0) (nth k (moved y xs at_) 0).
Proof.
  intros lambda part y l at_ cs xs hp. revert at_ cs xs. induction l as [| t l IH]; intros [| n at_] [| a cs] [| b xs] h1 h2 h3 H k; try discriminate.
  - destruct k; apply none_holds.
  - destruct k as [| k].
    + destruct (H O) as [u1 [u2 u3]]. cbn [moved_by moved combine map nth fst snd] in *.
      assert (B : contains bits (mul bits (Fixed.integer bits n) part) (IZR n * y)) by (apply mul_sound; [apply Fixed.integer_sound | exact hp]).
      split; [apply add_sound; assumption |]. split; [apply add_sound; assumption |].
      cbn [slopes]. replace (b + IZR n * y - (a + IZR n * y)) with (b - a) by ring. exact u3.
    + cbn [moved_by moved combine map nth]. apply IH; [injection h1 as h; exact h | injection h2 as h; exact h | injection h3 as h; exact h |].
      intro i. exact (H (S i)).
Qed.

(** At most half of the side, either way. *)
Definition is_offset (at_ : list Z) : bool := Nat.eqb (length at_) 3 && forallb (fun n => (-8 <=? n)%Z && (n <=? 8)%Z) at_.

Inductive failing_tree :=
  | Fails_ (at_ : list Z) (f : Configuration.nfailure)
  | Halved (k : nat) (lower upper : failing_tree)
  (* in halves of the range of parameter [j] *)
  | Parted (j : nat) (lower upper : failing_tree).

Section Tree.
Variables (first : nat) (rs : list requirement) (b : failings) (tape : list (op address)) (part : fixed).
Let values_at (params : list fixed) (coords : list slope) := run (option slope) None (slope_op bits coords (map constant params)) tape.

Definition may_halve (k : nat) (l : list fixed) : bool := match nth_error l k with Some a => negb (midpoint a =? lo a)%Z | None => false end.
Fixpoint fails_everywhere (params cell : list fixed) (t : failing_tree) : bool :=
  match t with
  | Fails_ at_ f => is_offset at_ &&
      let coords := moved_by part (coords_from 0 cell) at_ in fails_over first rs b is_positive coords (map constant params) (values_at params coords) f
  | Halved k lower upper => may_halve k cell && let (p, q) := halves k cell in fails_everywhere params p lower && fails_everywhere params q upper
  | Parted j lower upper => may_halve j params && let (p, q) := halves j params in fails_everywhere p cell lower && fails_everywhere q cell upper
  end.

Lemma fails_everywhere_sound : forall y th t params cell x, contains bits part y -> length cell = 3%nat -> Forall2 (contains bits) params th -> Forall2 (contains bits) cell x ->
  fails_everywhere params cell t = true ->
  exists params at_ f coords cs lambda, Forall2 (contains bits) params th /\ is_offset at_ = true /\ Forall (fun t => -1 <= t <= 1) lambda /\
    (forall k, Slope.holds bits lambda (nth k coords (constant zero)) (nth k cs 0) (nth k (moved y x at_) 0)) /\
    fails_over first rs b is_positive coords (map constant params) (values_at params coords) f = true.
Proof.
  intros y th t params cell x hp. revert params cell x. induction t as [at_ f | k lower IHl upper IHu | k lower IHl upper IHu]; intros params cell x len ht hx h; cbn [fails_everywhere] in h.
  - apply andb_true_iff in h as [o h]. destruct (coords_from_hold bits cell x hx) as [lambda [el [hl [_ C]]]]. specialize (C []). cbn [app length] in C.
    exists params, at_, f, (moved_by part (coords_from 0 cell) at_), (moved y (map (centre_of bits) cell) at_), lambda.
    split; [exact ht |]. split; [exact o |]. split; [exact hl |]. split; [| exact h]. apply andb_true_iff in o as [o _]. apply Nat.eqb_eq in o.
    assert (L : forall j l, length (coords_from j l) = length l) by (intros j l; revert j; induction l; intro j; cbn [coords_from length]; congruence).
    apply moved_by_hold; [exact hp | rewrite L; congruence | rewrite map_length, L; reflexivity | rewrite <- (related_length _ _ _ _ _ hx), L; reflexivity | exact C].
  - apply andb_true_iff in h as [_ h]. pose proof (halves_sound bits k cell x hx) as hh. destruct (halves_length k cell) as [La Lb].
    destruct (halves k cell) as [p q]. cbn [fst snd] in *. apply andb_true_iff in h as [h1 h2].
    destruct hh as [hh | hh]; [apply (IHl params p) | apply (IHu params q)]; congruence || assumption.
  - apply andb_true_iff in h as [_ h]. pose proof (halves_sound bits k params th ht) as hh.
    destruct (halves k params) as [p q]. cbn [fst snd] in *. apply andb_true_iff in h as [h1 h2].
    destruct hh as [hh | hh]; [apply (IHl p cell) | apply (IHu q cell)]; assumption.
Qed.
End Tree.

(** ** The whole check.  [exact]: the bits with which signs of numbers are found. *)
Definition check_no_cube (exact : positive) (c : claim) (side : number) (s : Z) (ds : list Z) (t : failing_tree) : bool :=
  let ps := layouts s ds (legs c) in
  let fs := all_formulas s ds (legs c) 0 in
  let n := (length ps, length ps + length (require c))%nat in
  let needed := entries (whole_rows fs) ++ map rod fs ++ range_formulas fs s n (require c) in
  let tape := compile needed in
  let found := formulas tape in let at_ := place found in
  match workspace c with
  | Box edges =>
      forallb (fun e => Formula.same (nth (at_ e) found (integer 0)) e) needed && certainly exact true side &&
      match all_some (map (enclose_parameter bits) (ps ++ map (bound_of s) (require c) ++ flat_map (extras s) (require c))),
            all_some (map (enclose_parameter bits) (three edges s)), enclose_scaled bits s (Over side (16 // 1)) with
      | Some params, Some box, Some part =>
          fails_everywhere (fst n) (require c) (failings_of at_ fs s n (require c)) tape part params box t
      | _, _, _ => false
      end
  | Cylinder _ _ _ _ => false
  end.

Lemma offset_within : forall n y, (-8 <=? n)%Z && (n <=? 8)%Z = true -> 0 < y -> Rabs (y / 16 * IZR n) <= y / 2.
Proof.
  intros n y h p. apply andb_true_iff in h as [h1 h2]. apply Z.leb_le, IZR_le in h1. apply Z.leb_le, IZR_le in h2.
  apply Rabs_le. nra.
Qed.

Theorem check_no_cube_sound : forall exact c side s ds t, check_no_cube exact c side s ds t = true -> has_no_cube c side.
Proof.
  intros exact c side s ds t h m C [hm [built hC]]. unfold check_no_cube in h. cbv zeta in h.
  set (fs := all_formulas s ds (legs c) 0) in *. set (n := (length (layouts s ds (legs c)), length (layouts s ds (legs c)) + length (require c))%nat) in *.
  set (needed := entries (whole_rows fs) ++ map rod fs ++ range_formulas fs s n (require c)) in *.
  set (tape := compile needed) in *. destruct (workspace c) as [edges |]; [| discriminate].
  apply andb_true_iff in h as [h ht]. apply andb_true_iff in h as [found side_pos]. apply positive_sound in side_pos.
  destruct (all_some (map (enclose_parameter bits) (layouts s ds (legs c) ++ map (bound_of s) (require c) ++ flat_map (extras s) (require c)))) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (map (enclose_parameter bits) (three edges s))) as [box |] eqn:eb; [| discriminate].
  destruct (enclose_scaled bits s (Over side (16 // 1))) as [part |] eqn:epart; [| discriminate].
  assert (Found : forall e, In e needed -> formula_at tape (place (formulas tape) e) = e).
  { rewrite forallb_forall in found. intros e i. apply Formula.same_sound, found, i. }
  destruct (all_represent s (legs c) m hm ds) as [th [L R]].
  set (tb := map (bound_value s) (require c) ++ map exact_value (flat_map (extras s) (require c))).
  pose proof (Forall2_app (bounds_within s (require c)) (all_extras_within s (require c))) as B. fold tb in B.
  pose proof (enclosed_all _ _ _ _ ep (Forall2_app L B)) as T.
  pose proof (enclosed_all _ _ _ _ eb (three_within edges s C hC)) as X.
  assert (three_of_them : length box = 3%nat) by (rewrite (related_length _ _ _ _ _ X); reflexivity).
  set (y := Claim.value side / 16 / two_to s).
  assert (Y : contains bits part y).
  { apply enclose_scaled_sound in epart. cbn [Claim.value] in epart. replace (16 / 1) with 16 in epart by field. exact epart. }
  destruct (fails_everywhere_sound _ _ _ tape part y _ t params box _ Y three_of_them T X ht) as [own [at_ [f [coords [cs [lambda [O [o [hl [hc hf]]]]]]]]]].
  apply andb_true_iff in o as [o1 o2]. destruct at_ as [| n0 [| n1 [| n2 [|]]]]; try discriminate. clear o1.
  cbn [forallb] in o2. apply andb_true_iff in o2 as [w0 o2]. apply andb_true_iff in o2 as [w1 o2]. apply andb_true_iff in o2 as [w2 _].
  set (P := vadd C (vscale (Claim.value side / 16) (Vec (IZR n0) (IZR n1) (IZR n2)))).
  exists P. split.
  { unfold in_cube_about, P, vadd, vscale. cbn [vx vy vz].
    replace (vx C + Claim.value side / 16 * IZR n0 - vx C) with (Claim.value side / 16 * IZR n0) by ring.
    replace (vy C + Claim.value side / 16 * IZR n1 - vy C) with (Claim.value side / 16 * IZR n1) by ring.
    replace (vz C + Claim.value side / 16 * IZR n2 - vz C) with (Claim.value side / 16 * IZR n2) by ring.
    split; [| split]; apply offset_within; assumption. }
  assert (E : moved y (coordinates (vscale (/ two_to s) C)) [n0; n1; n2] = coordinates (vscale (/ two_to s) P)).
  { pose proof (two_to_pos s) as s0. unfold moved, P, y, coordinates, vadd, vscale. cbn [combine map fst snd vx vy vz].
    apply (f_equal2 cons); [field; lra |]. apply (f_equal2 cons); [field; lra |]. apply (f_equal2 cons); [field; lra | reflexivity]. }
  rewrite E in hc. clear E hC X w0 w1 w2.
  assert (ln : length (layouts s ds (legs c)) = length th) by apply (related_length _ _ _ _ _ L).
  specialize (R (vscale (/ two_to s) P) [] tb). cbn [app length] in R.
  pose proof (params_hold bits lambda own (th ++ tb) O) as ph.
  assert (bounds_at : forall k r, nth_error (require c) k = Some r -> nth (fst n + k) (th ++ tb) 0 = bound_value s r).
  { intros k r e. unfold n. cbn [fst]. rewrite ln, app_nth2_plus. unfold tb.
    rewrite app_nth1 by (rewrite map_length; apply nth_error_Some; congruence).
    apply nth_error_nth. rewrite nth_error_map, e. reflexivity. }
  intros [reached [_ met]]. refine (fails_over_sound c s ds m P (th ++ tb) tape R built hm n bounds_at Found reached lambda cs coords _ _ is_positive f
    (eval_sound lambda hl _ cs (th ++ tb) coords (map constant own) hc ph tape) (is_positive_sound lambda hl _ cs (th ++ tb) coords (map constant own) hc ph tape) hf met).
Qed.
End Precision.

(** Of a claim that is about something. *)
Theorem check_no_cube_certified : forall exact bits c side s ds t, is_inhabited exact c && check_no_cube bits exact c side s ds t = true ->
  has_no_cube c side /\ exists m C, is_about c m C.
Proof.
  intros exact bits c side s ds t h. apply andb_true_iff in h as [i h].
  split; [exact (check_no_cube_sound bits exact c side s ds t h) | exact (inhabited exact c i)].
Qed.
End Named.
