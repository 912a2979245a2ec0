(** * Drives as formulas: A_i, D_i, the row divided by B_i, and the joint

    The formulas are those of machine/mod.rs.  That they are the kinematics
    of Kinematics.v and Statement.v is proved here, and that rows are
    derivatives of joint coordinates. *)

From Coq Require Import ZArith Reals Lra Lia List.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Claim.
From Orthocert.kernel Require Import Statement Linear Number Test Formula.
Import ListNotations.
Local Open Scope R_scope.

(** ** Vectors of formulas *)

Record evec := EVec { ex : formula; ey : formula; ez : formula }.
Definition list_of (u : evec) : list formula := [ex u; ey u; ez u].
Definition map2 (f : formula -> formula -> formula) (u v : evec) : evec := EVec (f (ex u) (ex v)) (f (ey u) (ey v)) (f (ez u) (ez v)).
Definition scaled (a : formula) (u : evec) : evec := EVec (times a (ex u)) (times a (ey u)) (times a (ez u)).
Definition divided_by (u : evec) (a : formula) : evec := EVec (over (ex u) a) (over (ey u) a) (over (ez u) a).
Definition product (u v : evec) : formula := plus (plus (times (ex u) (ex v)) (times (ey u) (ey v))) (times (ez u) (ez v)).
Definition unit_vector (u : evec) : evec := divided_by u (root (product u u)).
Definition point : evec := EVec (F (Coord 0)) (F (Coord 1)) (F (Coord 2)).

(** ** Drives, by w from the base joint to the platform's *)

(** [f_length]: of sliders; [f_couple]: of struts with a base axis; [f_tip]: the platform end, of legs with two ends. *)
Record leg_formulas := LegFormulas { f_A : evec; f_D : formula; f_divided : evec; f_joint : formula; f_length : option formula; f_couple : option evec; f_tip : option evec }.
(** Of a leg that reaches, |A_i|: the length of a slider or strut, 1 of a plane. *)
Definition rod (f : leg_formulas) : formula := match f_length f with Some len => len | None => root (f_D f) end.

Definition signed (mode : bool) (a : formula) : formula := if mode then a else opposite a.

Definition slider_formulas (w n tip : evec) (len : formula) (mode : bool) : leg_formulas :=
  let along := product n w in
  let r := map2 minus w (scaled along n) in
  let d := minus (square len) (product r r) in
  let eta := signed mode (root d) in
  LegFormulas (map2 plus r (scaled eta n)) d (map2 plus n (divided_by r eta)) (minus along eta) (Some len) None (Some tip).

Definition strut_formulas (w tip : evec) (axis : option evec) : leg_formulas :=
  let d := product w w in let len := root d in
  LegFormulas w d (divided_by w len) len None (option_map (fun k => map2 minus w (scaled (product k w) k)) axis) (Some tip).

Definition planar_formulas (w n : evec) : leg_formulas := LegFormulas n (integer 1) n (product n w) None None None.

(** ** Meaning *)

Definition coordinates (v : vec) : list R := [vx v; vy v; vz v].

Section Point.
Variable P : vec.
Variable theta : list R.
Local Notation value := (value (coordinates P) theta).
Local Notation defined := (defined (coordinates P) theta).

Definition vvalue (u : evec) : vec := Vec (value (ex u)) (value (ey u)) (value (ez u)).

Lemma vvalue_minus : forall u v, vvalue (map2 minus u v) = vsub (vvalue u) (vvalue v).
Proof. intros. unfold vvalue, vsub. cbn [map2 ex ey ez vx vy vz]. rewrite !value_minus. reflexivity. Qed.
Lemma vvalue_plus : forall u v, vvalue (map2 plus u v) = vadd (vvalue u) (vvalue v).
Proof. intros. unfold vvalue, vadd. cbn [map2 ex ey ez vx vy vz]. rewrite !value_plus. reflexivity. Qed.
Lemma vvalue_scaled : forall a u, vvalue (scaled a u) = vscale (value a) (vvalue u).
Proof. intros. unfold vvalue, vscale. cbn [scaled ex ey ez vx vy vz]. rewrite !value_times. reflexivity. Qed.
Lemma vvalue_divided : forall a u, vvalue (divided_by u a) = vscale (/ value a) (vvalue u).
Proof.
  intros. unfold vvalue, vscale. cbn [divided_by ex ey ez vx vy vz]. rewrite !value_over.
  f_equal; unfold Rdiv; ring.
Qed.
Lemma value_product : forall u v, value (product u v) = Vec3.dot (vvalue u) (vvalue v).
Proof. intros. unfold product. rewrite !value_plus, !value_times. reflexivity. Qed.
Lemma vvalue_unit : forall u, vvalue (unit_vector u) = normalised (vvalue u).
Proof.
  intro u. unfold unit_vector, normalised. rewrite vvalue_divided, value_root, value_product, norm2_dot. reflexivity.
Qed.
Lemma vvalue_point : vvalue point = P.
Proof. apply vec_ext; reflexivity. Qed.
Lemma values_list : forall u, map value (list_of u) = coordinates (vvalue u).
Proof. reflexivity. Qed.
Lemma dot_coordinates : forall u v, Linear.dot (coordinates u) (coordinates v) = Vec3.dot u v.
Proof. intros [a b c] [d e f]. unfold Vec3.dot. cbn. ring. Qed.

(** The formulas are those of the leg at [P]. *)
Definition represents (f : leg_formulas) (l : leg) : Prop :=
  (0 < value (f_D f) -> reaches P l /\ forall v, Vec3.dot (vvalue (f_A f)) v ^ 2 / value (f_D f) = Vec3.dot (row l P) v ^ 2) /\
  ((Forall defined (list_of (f_divided f)) -> reaches P l) /\ vvalue (f_A f) = vector_of l P /\ value (rod f) = size_of l P) /\
  vvalue (f_divided f) = row l P /\ value (f_joint f) = joint l P /\
  (reaches P l -> 0 < value (f_D f)) /\
  (forall len, f_length f = Some len -> exists k, l = Guided k /\ value len = leg_length k /\
    (0 < value (f_D f) -> value (f_D f) = eta k P ^ 2) /\ vvalue (f_A f) = leg_vector k P) /\
  (forall c, f_couple f = Some c -> couple_of l P = Some (vvalue c)) /\
  (forall tip, f_tip f = Some tip -> rod_of l P = Some (vvalue tip, vvalue (f_A f), value (rod f))).

Lemma value_signed : forall (mode : bool) a, value (signed mode a) = (if mode then 1 else -1) * value a.
Proof. intros [|] a; cbn [signed]; rewrite ?value_opposite; ring. Qed.

Lemma slider_represents : forall ew en etip el (mode : bool) l,
  vvalue ew = w l P -> vvalue etip = C_point l P -> vvalue en = axis l -> value el = leg_length l -> working_mode l = (if mode then 1 else -1) ->
  represents (slider_formulas ew en etip el mode) (Guided l).
Proof.
  intros ew en etip el mode l hw ht hn hl hm. unfold slider_formulas. cbn zeta.
  set (er := map2 minus ew (scaled (product en ew) en)). set (ed := minus (square el) (product er er)).
  set (eeta := signed mode (root ed)).
  assert (R : vvalue er = r l P).
  { unfold er, r. rewrite vvalue_minus, vvalue_scaled, value_product, hn, hw. reflexivity. }
  assert (D : value ed = leg_length l ^ 2 - norm2 (r l P)).
  { unfold ed. rewrite value_minus, value_square, value_product, R, hl, norm2_dot. reflexivity. }
  assert (E : value eeta = eta l P).
  { unfold eeta, eta, s. rewrite value_signed, value_root, D, hm. reflexivity. }
  assert (T : 0 < value ed -> 0 < s l P) by (rewrite D; apply sqrt_lt_R0).
  assert (N : value eeta <> 0 -> 0 < s l P).
  { rewrite E. unfold eta. intro h. destruct (sqrt_pos (leg_length l ^ 2 - norm2 (r l P))) as [p | z]; [exact p |].
    exfalso. apply h. unfold s. rewrite <- z. ring. }
  assert (Sq : 0 < value ed -> value ed = eta l P ^ 2).
  { intro h. unfold eta. rewrite Rpow_mult_distr, hm, (s_squared l P (T h)), D. destruct mode; ring. }
  split; [| split; [| split; [| split; [| split; [| split; [| split]]]]]]; cbn [f_A f_D f_divided f_joint f_length f_couple f_tip reaches row joint].
  - intro h. split; [exact (T h) |]. intro v. pose proof (Sq h) as Q.
    rewrite vvalue_plus, vvalue_scaled, R, E, hn, Q. unfold Jinv_row. rewrite Q in h.
    assert (H : eta l P <> 0) by (intro z; rewrite z in h; lra).
    clear - H. generalize dependent (eta l P). intros a a0. generalize (r l P) (axis l). intros q n.
    unfold Vec3.dot, vadd, vscale. cbn [vx vy vz]. field. exact a0.
  - split; [| split; [rewrite vvalue_plus, vvalue_scaled, R, E, hn; symmetry; apply leg_vector_eq | exact hl]].
    intro h. apply N. inversion h as [| ? ? h1 _]. subst. cbn [map2 ex] in h1.
    apply defined_plus in h1. destruct h1 as [_ h1]. exact (defined_over _ _ _ _ h1).
  - rewrite vvalue_plus, vvalue_divided, R, E, hn. reflexivity.
  - rewrite value_minus, value_product, hn, hw, E. reflexivity.
  - intro h. rewrite D. unfold s in h. destruct (Rlt_le_dec 0 (leg_length l ^ 2 - norm2 (r l P))) as [p | n]; [exact p |].
    rewrite sqrt_neg_0 in h by exact n. lra.
  - intros len h. injection h as <-. exists l. split; [reflexivity |]. split; [exact hl |]. split; [exact Sq |].
    rewrite vvalue_plus, vvalue_scaled, R, E, hn. symmetry. apply leg_vector_eq.
  - discriminate.
  - intros tip h. injection h as <-. unfold rod. cbn [f_length rod_of]. rewrite ht, hl, vvalue_plus, vvalue_scaled, R, E, hn, leg_vector_eq. reflexivity.
Qed.

Lemma strut_represents : forall ew etip base platform ek axis, vvalue ew = span base platform P -> vvalue etip = vadd P platform ->
  option_map vvalue ek = axis -> represents (strut_formulas ew etip ek) (Extensible base platform axis).
Proof.
  intros ew etip base platform ek axis hw ht hk. unfold strut_formulas. cbn zeta.
  assert (D : value (product ew ew) = norm2 (span base platform P)) by (rewrite value_product, hw, norm2_dot; reflexivity).
  split; [| split; [| split; [| split; [| split; [| split; [| split]]]]]]; cbn [f_A f_D f_divided f_joint f_length f_couple f_tip reaches row joint].
  - rewrite D, hw. intro h. split; [exact h |]. intro v. unfold normalised.
    assert (E : forall a u, Vec3.dot (vscale a u) v = a * Vec3.dot u v) by (intros; unfold Vec3.dot; cbn; ring).
    rewrite E, Rpow_mult_distr. pose proof (sqrt_lt_R0 _ h) as s0. rewrite pow_inv.
    replace (sqrt (norm2 (span base platform P)) ^ 2) with (norm2 (span base platform P))
      by (rewrite <- Rsqr_pow2, Rsqr_sqrt by lra; reflexivity).
    field. lra.
  - split; [| split; [exact hw | unfold rod; cbn [f_length f_D]; rewrite value_root, D; reflexivity]]. intro h. inversion h as [| ? ? h1 _]. subst. cbn [divided_by ex] in h1. apply defined_over in h1.
    rewrite value_root, D in h1. destruct (norm2_nonneg (span base platform P)) as [p | z]; [exact p |].
    exfalso. apply h1. rewrite <- z. apply sqrt_0.
  - rewrite vvalue_divided, value_root, D, hw. reflexivity.
  - rewrite value_root, D. reflexivity.
  - rewrite D. auto.
  - discriminate.
  - intros c h. destruct ek as [k |]; [| discriminate]. cbn [option_map] in h, hk. injection h as <-. subst axis.
    cbn [couple_of]. unfold couple. rewrite vvalue_minus, vvalue_scaled, value_product, hw. reflexivity.
  - intros tip h. injection h as <-. unfold rod. cbn [f_length f_D rod_of]. rewrite ht, hw, value_root, D. reflexivity.
Qed.

Lemma planar_represents : forall ew en n, vvalue ew = P -> vvalue en = normalised n ->
  represents (planar_formulas ew en) (Plane n).
Proof.
  intros ew en n hw hn. unfold planar_formulas.
  split; [| split; [| split; [| split; [| split; [| split; [| split]]]]]]; cbn [f_A f_D f_divided f_joint f_length f_couple f_tip reaches row joint].
  - intros _. split; [exact I |]. intro v. rewrite hn. cbn. field.
  - split; [intros _; exact I | split; [exact hn |]]. unfold rod. cbn [f_length f_D]. rewrite value_root. apply sqrt_1.
  - exact hn.
  - rewrite value_product, hn, hw. reflexivity.
  - intros _. cbn. lra.
  - discriminate.
  - discriminate.
  - discriminate.
Qed.

(** ** All legs *)

Definition whole_rows (fs : list leg_formulas) : rows formula := map (fun f => (list_of (f_A f), f_D f)) fs.
Definition divided_rows (fs : list leg_formulas) : rows formula := map (fun f => (list_of (f_divided f), integer 1)) fs.

Lemma whole_speed : forall fs m, Forall2 represents fs m -> positive_D (map_rows value (whole_rows fs)) ->
  Forall (reaches P) m /\ forall v, energy (map_rows value (whole_rows fs)) (coordinates v) = speed2 m P v.
Proof.
  induction 1 as [| f l fs m [h _] hs IH]; intro p; [split; [constructor | reflexivity] |].
  inversion p as [| ? ? p1 p2]; subst. cbn [snd] in p1. destruct (IH p2) as [I1 I2]. destruct (h p1) as [h1 h2].
  split; [constructor; assumption |]. intro v. cbn [whole_rows map map_rows energy fst snd speed2 fold_right].
  unfold speed2, map_rows, whole_rows in I2. rewrite I2, <- h2. rewrite values_list, dot_coordinates. reflexivity.
Qed.

Lemma divided_speed : forall fs m, Forall2 represents fs m ->
  Forall (fun p => Forall defined (fst p) /\ defined (snd p)) (divided_rows fs) ->
  Forall (reaches P) m /\ forall v, energy (map_rows value (divided_rows fs)) (coordinates v) = speed2 m P v.
Proof.
  induction 1 as [| f l fs m [_ [[h1 _] [h2 _]]] hs IH]; intro p; [split; [constructor | reflexivity] |].
  inversion p as [| ? ? [p1 _] p2]; subst. cbn [fst] in p1. destruct (IH p2) as [I1 I2].
  split; [constructor; auto |]. intro v. cbn [divided_rows map map_rows energy fst snd speed2 fold_right].
  unfold speed2, map_rows, divided_rows in I2. rewrite I2, values_list, dot_coordinates, h2. cbn. field.
Qed.
End Point.

(** ** The unit of length does not matter *)

Definition resized (c : R) (l : leg) : leg :=
  match l with
  | Guided l => Guided (Leg (axis l) (vscale c (base_point l)) (vscale c (platform_offset l)) (c * leg_length l) (working_mode l))
  | Extensible base platform axis => Extensible (vscale c base) (vscale c platform) axis
  | Plane n => Plane n
  end.

Lemma sqrt_resized : forall c x, 0 < c -> sqrt (c ^ 2 * x) = c * sqrt x.
Proof.
  intros c x h. rewrite sqrt_mult_alt by apply pow2_ge_0. rewrite sqrt_pow2 by lra. reflexivity.
Qed.

Lemma normalised_resized : forall c u, 0 < c -> normalised (vscale c u) = normalised u.
Proof.
  intros c u h. unfold normalised. rewrite norm2_scale, sqrt_resized by exact h.
  destruct (norm2_nonneg u) as [p | z].
  - pose proof (sqrt_lt_R0 _ p). destruct u. unfold vscale. cbn. f_equal; field; lra.
  - symmetry in z. apply norm2_zero in z. subst u. unfold vscale, vzero. cbn. f_equal; ring.
Qed.

Lemma normalised_norm : forall v, 0 < norm2 v -> norm2 (normalised v) = 1.
Proof.
  intros v h. unfold normalised. rewrite norm2_scale. pose proof (sqrt_lt_R0 _ h) as p.
  rewrite <- Rsqr_pow2, Rsqr_inv', Rsqr_sqrt by lra. field. lra.
Qed.

Section Resized.
Variables (c : R) (P : vec).
Hypothesis c_pos : 0 < c.

Lemma r_resized : forall l, r (Leg (axis l) (vscale c (base_point l)) (vscale c (platform_offset l)) (c * leg_length l) (working_mode l))
  (vscale c P) = vscale c (r l P).
Proof.
  intros [n a d len mode]. unfold r, w. cbn [axis base_point platform_offset]. unfold vsub, vadd, vscale, Vec3.dot. cbn [vx vy vz]. f_equal; ring.
Qed.

Lemma resized_same : forall l,
  row (resized c l) (vscale c P) = row l P /\ joint (resized c l) (vscale c P) = c * joint l P /\
  (reaches (vscale c P) (resized c l) <-> reaches P l).
Proof.
  intros [l | base platform k | n]; cbn [resized row joint reaches].
  - assert (S : s (Leg (axis l) (vscale c (base_point l)) (vscale c (platform_offset l)) (c * leg_length l) (working_mode l)) (vscale c P)
      = c * s l P).
    { unfold s. rewrite r_resized. cbn [leg_length]. rewrite norm2_scale, <- sqrt_resized by exact c_pos. f_equal. ring. }
    split; [| split].
    + unfold Jinv_row, eta. rewrite r_resized, S. cbn [axis working_mode]. destruct (Req_dec (working_mode l * s l P) 0) as [z | z].
      * replace (working_mode l * (c * s l P)) with (c * (working_mode l * s l P)) by ring.
        rewrite z, Rmult_0_r, Rinv_0. unfold vscale. cbn. rewrite !Rmult_0_l. reflexivity.
      * apply (f_equal (vadd (axis l))). unfold vscale. cbn [vx vy vz].
        set (e := working_mode l) in *. set (h := s l P) in *. assert (e <> 0 /\ h <> 0) by (split; intro k; apply z; rewrite k; ring).
        f_equal; field; repeat split; try tauto; lra.
    + unfold rho, eta, w. rewrite S. cbn [axis base_point platform_offset working_mode].
      unfold vsub, vadd, vscale, Vec3.dot. cbn [vx vy vz]. ring.
    + rewrite S. split; intro h; [apply Rmult_lt_reg_l with c; lra | apply Rmult_lt_0_compat; assumption].
  - assert (W : span (vscale c base) (vscale c platform) (vscale c P) = vscale c (span base platform P))
      by (unfold span, vsub, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
    rewrite W, norm2_scale. split; [apply normalised_resized, c_pos |].
    split; [apply sqrt_resized, c_pos |]. pose proof (pow_lt c 2 c_pos).
    split; intro h; [apply Rmult_lt_reg_l with (c ^ 2); lra | apply Rmult_lt_0_compat; assumption].
  - split; [reflexivity |]. split; [| tauto]. unfold Vec3.dot, vscale. cbn [vx vy vz]. ring.
Qed.
Lemma couple_resized : forall l, couple_of (resized c l) (vscale c P) = option_map (vscale c) (couple_of l P).
Proof.
  intros [l | base platform [k |] | n]; try reflexivity. cbn [resized couple_of option_map]. f_equal. unfold couple, span.
  unfold vsub, vadd, vscale, Vec3.dot. cbn [vx vy vz]. f_equal; ring.
Qed.

Lemma guided_resized : forall l k, resized c l = Guided k -> exists k', l = Guided k' /\ leg_length k = c * leg_length k' /\
  eta k (vscale c P) = c * eta k' P /\ leg_vector k (vscale c P) = vscale c (leg_vector k' P).
Proof.
  intros [l | ? ? ? | ?] k h; try discriminate. cbn [resized] in h. injection h as <-. exists l. split; [reflexivity |]. split; [reflexivity |].
  assert (E : eta (Leg (axis l) (vscale c (base_point l)) (vscale c (platform_offset l)) (c * leg_length l) (working_mode l)) (vscale c P)
      = c * eta l P).
  { unfold eta, s. rewrite r_resized. cbn [leg_length working_mode]. rewrite norm2_scale.
    replace ((c * leg_length l) ^ 2 - c ^ 2 * norm2 (r l P)) with (c ^ 2 * (leg_length l ^ 2 - norm2 (r l P))) by ring.
    rewrite sqrt_resized by exact c_pos. ring. }
  split; [exact E |]. rewrite !leg_vector_eq, E, r_resized. cbn [axis]. generalize (r l P) (axis l) (eta l P). intros a b t.
  unfold vadd, vscale. cbn [vx vy vz]. f_equal; ring.
Qed.

Lemma well_formed_resized : forall l, match l with Guided l => well_formed l | Extensible _ _ (Some k) => norm2 k = 1 | Extensible _ _ None => True | Plane n => n <> vzero end ->
  match resized c l with Guided l => well_formed l | Extensible _ _ (Some k) => norm2 k = 1 | Extensible _ _ None => True | Plane n => n <> vzero end.
Proof.
  intros [l | base platform [k |] | n] h; cbn [resized]; try exact h. destruct h as [h1 [h2 h3]]. split; [exact h1 |]. split; [| exact h3].
  cbn [leg_length]. apply Rmult_lt_0_compat; assumption.
Qed.

(** Its vector and its size alike, of a plane not at all. *)
Lemma vector_resized : forall l, exists k, 0 < k /\ vector_of (resized c l) (vscale c P) = vscale k (vector_of l P) /\ size_of (resized c l) (vscale c P) = k * size_of l P.
Proof.
  intros [l | base platform k | n]; cbn [resized vector_of size_of].
  - exists c. destruct (guided_resized (Guided l) _ eq_refl) as [l' [e [_ [_ v]]]]. injection e as <-. split; [exact c_pos |]. split; [exact v | reflexivity].
  - exists c. assert (W : span (vscale c base) (vscale c platform) (vscale c P) = vscale c (span base platform P))
      by (unfold span, vsub, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
    rewrite W, norm2_scale, sqrt_resized by exact c_pos. split; [exact c_pos | split; reflexivity].
  - exists 1. split; [lra |]. split; [destruct (normalised n) as [a b d]; unfold vscale; cbn [vx vy vz]; f_equal; ring | ring].
Qed.

Lemma rod_resized : forall l, rod_of (resized c l) (vscale c P) =
  match rod_of l P with Some (C, A, L) => Some (vscale c C, vscale c A, c * L) | None => None end.
Proof.
  intros [l | base platform k | n]; try reflexivity.
  - cbn [resized rod_of]. destruct (guided_resized (Guided l) _ eq_refl) as [l' [e [_ [_ v]]]]. injection e as <-. rewrite v.
    f_equal. f_equal. f_equal. unfold C_point, vadd, vscale. cbn [platform_offset vx vy vz]. f_equal; ring.
  - cbn [resized rod_of].
    assert (W : span (vscale c base) (vscale c platform) (vscale c P) = vscale c (span base platform P))
      by (unfold span, vsub, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
    rewrite W, norm2_scale, sqrt_resized by exact c_pos. f_equal. f_equal. f_equal. unfold vadd, vscale. cbn [vx vy vz]. f_equal; ring.
Qed.
End Resized.

(** ** Rows are derivatives: a guard on the model *)

Definition well_formed_leg (l : leg) : Prop :=
  match l with Guided l => well_formed l | Extensible _ _ k => match k with Some k => norm2 k = 1 | None => True end | Plane n => n <> vzero end.

(** The chord between two points with the same joint coordinate is orthogonal to the sum of the leg's vectors there. *)
Theorem chord : forall l P P', well_formed_leg l -> reaches P l -> reaches P' l -> joint l P' = joint l P ->
  Vec3.dot (vadd (vector_of l P) (vector_of l P')) (vsub P' P) = 0.
Proof.
  assert (K : forall A A' d, vsub A' A = d -> norm2 A' = norm2 A -> Vec3.dot (vadd A A') d = 0).
  { intros A A' d <- h. replace (Vec3.dot (vadd A A') (vsub A' A)) with (norm2 A' - norm2 A) by (unfold norm2, Vec3.dot, vadd, vsub; cbn [vx vy vz]; ring). lra. }
  intros [l | base platform k | n] P P' ok h h' e; cbn [vector_of well_formed_leg reaches joint] in *.
  - apply K; [| rewrite !leg_vector_length by assumption; reflexivity].
    unfold leg_vector, B_point, C_point. rewrite e. unfold vsub, vadd, vscale. cbn [vx vy vz]. f_equal; ring.
  - apply K; [unfold span, vsub, vadd; cbn [vx vy vz]; f_equal; ring |].
    apply sqrt_inj; [apply norm2_nonneg | apply norm2_nonneg | exact e].
  - replace (Vec3.dot (vadd (normalised n) (normalised n)) (vsub P' P)) with (2 * (Vec3.dot (normalised n) P' - Vec3.dot (normalised n) P))
      by (unfold Vec3.dot, vadd, vsub; cbn [vx vy vz]; ring). rewrite e. ring.
Qed.

(** Along any differentiable trajectory P(t), rho_i' = row_i . P'. *)
Theorem row_is_derivative : forall l P t V, well_formed_leg l -> reaches (P t) l -> has_velocity P t V ->
  derivable_pt_lim (fun u => joint l (P u)) t (Vec3.dot (row l (P t)) V).
Proof.
  intros [l | base platform k | n] P t V ok h hv; cbn [joint row reaches well_formed_leg] in *.
  - apply joint_velocity; assumption.
  - set (f := fun u => norm2 (span base platform (P u))).
    assert (W : has_velocity (fun u => span base platform (P u)) t V)
      by exact (velocity_w (Leg vzero base platform 1 1) P t V hv).
    pose proof (velocity_norm2 _ t _ W) as N. cbn beta in N. fold f in N.
    apply derivable_eq with (comp sqrt f) (/ (2 * sqrt (f t)) * (2 * Vec3.dot (span base platform (P t)) V)).
    + exact (derivable_pt_lim_comp f sqrt t _ _ N (derivable_pt_lim_sqrt (f t) h)).
    + reflexivity.
    + unfold normalised. change (norm2 (span base platform (P t))) with (f t). pose proof (sqrt_lt_R0 _ h) as p.
      change (0 < sqrt (f t)) in p. generalize (span base platform (P t)). intro w. unfold Vec3.dot, vscale. cbn [vx vy vz]. field. lra.
  - apply velocity_dot, hv.
Qed.

(** Three guided legs are the machine of Kinematics.v: speed2 = |Jinv v|^2. *)
Theorem three_guided : forall m P v,
  eta (leg1 m) P <> 0 -> eta (leg2 m) P <> 0 -> eta (leg3 m) P <> 0 ->
  speed2 [Guided (leg1 m); Guided (leg2 m); Guided (leg3 m)] P v = norm2 (mulv (Jinv m P) v).
Proof.
  intros m P v h1 h2 h3. rewrite Jinv_rows by assumption. unfold speed2, norm2, mulv. cbn [fold_right row row1 row2 row3 vx vy vz]. ring.
Qed.
