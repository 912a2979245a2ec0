(** * Refutations of accelerations of struts of platforms that turn

    With the leg's unit vector u, its lever r, its length s and C' = v + omega x r, the leg's speed has the derivative
    row . a + (|C'|^2 - (u . C')^2)/s + (u . omega)(r . omega) - (u . r) |omega|^2 ([speed_bends]).  The speed is greatest
    in the direction that a witness names, and the acceleration along the row. *)

From Coq Require Import ZArith Reals Lra List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Solve.
From Orthocert.kernel Require Import Linear Configuration Statement Machine Acceleration Witness Orientation Turning Bend Onward.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** One motion through each pose *)

Definition spun (Q : mat) (W : vec) (t : R) : mat :=
  mulm (Mat (Vec 1 (- (t * vz W)) (t * vy W)) (Vec (t * vz W) 1 (- (t * vx W))) (Vec (- (t * vy W)) (t * vx W) 1)) Q.
Lemma spun_image : forall Q W t b, mulv (spun Q W t) b = vadd (mulv Q b) (vscale t (cross W (mulv Q b))).
Proof. intros Q W t b. unfold spun. rewrite mulv_mulm. generalize (mulv Q b). clear. intros [x y z]. destruct W as [p q r]. unfold mulv, Vec3.dot, cross, vadd, vscale. cbn [row1 row2 row3 vx vy vz]. f_equal; ring. Qed.
Lemma along_line : forall v a, has_velocity (fun t => vadd v (vscale t a)) 0 a.
Proof. intros v a. exact (proj2 (proj2 (moved_velocity v v a))). Qed.
Lemma spun_start : forall Q W, spun Q W 0 = Q.
Proof. intros Q W. unfold spun. unfold_vec. f_equal; f_equal; ring. Qed.
Lemma spun_turns : forall Q W, turns (spun Q W) 0 W.
Proof.
  intros Q W b. pose proof (along_line (mulv Q b) (cross W (mulv Q b))) as [h1 [h2 h3]]. rewrite spun_start. unfold has_velocity.
  split; [apply (derivable_eq _ _ _ _ _ h1) | split; [apply (derivable_eq _ _ _ _ _ h2) | apply (derivable_eq _ _ _ _ _ h3)]]; try reflexivity; intro t; rewrite spun_image; reflexivity.
Qed.

Lemma unit_velocity : forall A C, has_velocity A 0 C -> 0 < norm2 (A 0) ->
  has_velocity (fun t => normalised (A t)) 0 (vscale (/ sqrt (norm2 (A 0))) (vsub C (vscale (Vec3.dot (normalised (A 0)) C) (normalised (A 0))))).
Proof.
  intros A C h reach. pose proof (sqrt_lt_R0 _ reach) as s0. pose proof (velocity_norm2 A 0 C h) as N.
  assert (S : derivable_pt_lim (fun t => sqrt (norm2 (A t))) 0 (Vec3.dot (normalised (A 0)) C)).
  { eapply derivable_eq; [exact (derivable_pt_lim_comp _ sqrt 0 _ _ N (derivable_pt_lim_sqrt _ reach)) | reflexivity |].
    unfold normalised. set (q := sqrt (norm2 (A 0))) in *. unfold Vec3.dot, vscale. cbn [vx vy vz]. field. lra. }
  set (q := sqrt (norm2 (A 0))) in *. set (d := Vec3.dot (normalised (A 0)) C) in *.
  assert (K : forall f f', derivable_pt_lim f 0 f' -> derivable_pt_lim (fun t => / sqrt (norm2 (A t)) * f t) 0 (/ q * (f' - d * (/ q * f 0)))).
  { intros f f' hf. eapply derivable_eq; [exact (derivable_pt_lim_div f (fun t => sqrt (norm2 (A t))) 0 _ _ hf S ltac:(cbv beta; fold q; lra)) | intro t; unfold div_fct, Rdiv; ring |].
    cbv beta. fold q. unfold Rsqr. field. lra. }
  destruct h as [h1 [h2 h3]]. unfold normalised at 2. fold q. repeat split; cbn [normalised vscale vsub vx vy vz]; apply K; assumption.
Qed.

(** What the acceleration is without that of the platform, where it has the velocity V and the angular velocity W. *)
Definition bent (l : strut) (P : vec) (Q : mat) (V W : vec) : R :=
  let u := normalised (strut_vector l P Q) in let r := arm_of_joint l Q in let C := vadd V (cross W r) in
  (norm2 C - Vec3.dot u C ^ 2) / strut_length l P Q + (Vec3.dot u W * Vec3.dot r W - Vec3.dot u r * norm2 W).
Lemma bent_scaled : forall l P Q t V W, bent l P Q (vscale t V) (vscale t W) = t ^ 2 * bent l P Q V W.
Proof.
  intros l P Q t V W. unfold bent. cbv zeta. generalize (normalised (strut_vector l P Q)) (arm_of_joint l Q) (strut_length l P Q). intros [u1 u2 u3] [r1 r2 r3] s.
  destruct V as [v1 v2 v3], W as [w1 w2 w3]. unfold Vec3.dot, norm2, vadd, vscale, cross, Rdiv. cbn [vx vy vz]. ring.
Qed.

Lemma accelerates_only : forall k ell l P Q V W A B y, ell <> 0 -> 0 < norm2 (strut_vector l P Q) -> is_of k V W ->
  strut_accelerates k ell l P Q (twist k V (vscale ell W)) (twist k A (vscale ell B)) y ->
  y = Linear.dot (strut_row k ell l P Q) (twist k A (vscale ell B)) + bent l P Q V W.
Proof.
  intros k ell l P Q V W A B y l0 reach hk h. set (position := fun t => vadd P (vscale t V)). set (velocity := fun t => vadd V (vscale t A)). set (omega := fun t => vadd W (vscale t B)).
  assert (Z : forall p q, vadd p (vscale 0 q) = p) by (intros [p1 p2 p3] [q1 q2 q3]; unfold vadd, vscale; cbn [vx vy vz]; f_equal; ring).
  assert (eP : position 0 = P) by apply Z. assert (eV : velocity 0 = V) by apply Z. assert (eW : omega 0 = W) by apply Z. assert (eQ : spun Q W 0 = Q) by apply spun_start.
  assert (hp : has_velocity position 0 V) by apply along_line. assert (ht : turns (spun Q W) 0 W) by apply spun_turns.
  pose proof (vector_velocity l position (spun Q W) 0 V W hp ht) as hA. cbv beta in hA. rewrite eQ in hA.
  pose proof (unit_velocity _ _ hA) as hu. cbv beta in hu. rewrite eP, eQ in hu. specialize (hu reach).
  pose proof (speed_bends k ell l P Q V W position (spun Q W) velocity omega A B _ l0 eP eQ eV eW ht (along_line V A) (along_line W B) hk hu) as D.
  rewrite <- eV in hp at 1. rewrite <- eW in ht at 2.
  specialize (h position (spun Q W) velocity omega A B eP eQ hp ht (along_line V A) (along_line W B)). rewrite eV, eW in h. specialize (h hk eq_refl eq_refl).
  rewrite (uniqueness_limite _ _ _ _ h D). cbv zeta. rewrite Rplus_assoc. f_equal. unfold bent. cbv zeta. f_equal. fold (strut_length l P Q).
  generalize (normalised (strut_vector l P Q)) (vadd V (cross W (arm_of_joint l Q))) (strut_length l P Q). clear. intros [u1 u2 u3] [c1 c2 c3] s.
  unfold Vec3.dot, norm2, vsub, vscale, Rdiv. cbn [vx vy vz]. ring.
Qed.

Lemma is_twist : forall k v, length v = dimension k -> v = twist k (shift_of k v) (spin_of k v).
Proof.
  intros k v h. destruct k; cbn [dimension] in h; [destruct v as [| ? [| ? [| ? [|]]]] | destruct v as [| ? [| ? [| ? [| ? [| ? [| ? [|]]]]]]] | destruct v as [| ? [| ? [| ? [|]]]]]; try discriminate; reflexivity.
Qed.
Lemma vscale_one : forall v, vscale 1 v = v.
Proof. intros [x y z]. unfold vscale. cbn [vx vy vz]. f_equal; ring. Qed.
Lemma twist_scaled : forall k ell t V S, ell <> 0 -> map (Rmult t) (twist k V S) = twist k (vscale t V) (vscale ell (vscale t (vscale (/ ell) S))).
Proof. intros k ell t V S h. destruct k; unfold twist, vscale; cbn [map vx vy vz]; repeat (apply f_equal2; [solve [reflexivity | field; exact h] |]); reflexivity. Qed.

Section Named.
Context {names : naming}.

Definition nshift (k : motion) (v : list number) : numbers :=
  let at_ i := nth i v (0 // 1) in let zero := 0 // 1 in
  match k with InPlane => Numbers (at_ 0%nat) (at_ 1%nat) zero | InSpace => Numbers (at_ 0%nat) (at_ 1%nat) (at_ 2%nat) | AboutPoint => Numbers zero zero zero end.
Definition nspin (k : motion) (v : list number) : numbers :=
  let at_ i := nth i v (0 // 1) in let zero := 0 // 1 in
  match k with InPlane => Numbers zero zero (at_ 2%nat) | InSpace => Numbers (at_ 3%nat) (at_ 4%nat) (at_ 5%nat) | AboutPoint => Numbers (at_ 0%nat) (at_ 1%nat) (at_ 2%nat) end.
Lemma nparts : forall k v, values (nshift k v) = shift_of k (map value v) /\ values (nspin k v) = spin_of k (map value v).
Proof.
  intros k v. assert (E : forall i, nth i (map value v) 0 = value (nth i v (0 // 1))) by (intro i; rewrite <- zero_value; apply map_nth).
  destruct k; unfold nshift, nspin, shift_of, spin_of, values, vzero; cbv zeta; cbn [nx ny nz]; rewrite !E, ?zero_value; split; reflexivity.
Qed.

(** What is [bent], times the length. *)
Definition nbent (k : motion) (ell : number) (o : orientations) (c : list number) (P : numbers) (l : exact_strut) (v : list number) : number :=
  let w := xvector o c P l in let r := turn o c (xjoint l) in
  let W := scaled (Over (1 // 1) ell) (nspin k v) in let C := each2 Plus (nshift k v) (ncrossed W r) in
  let along := product w C in
  Plus (Minus (product C C) (Over (Times along along) (product w w))) (Minus (Times (product w W) (product r W)) (Times (product w r) (product W W))).

Section Precision.
Variable bits : positive.
Local Notation certainly := (certainly bits).

(** With the acceleration p, the speed q along [v] and the bound b: p |row| |v|^2 + q^2 |..| > b |v|^2, in either sign, all times the length. *)
Definition is_accelerated (k : motion) (ell : number) (o : orientations) (c : list number) (P : numbers) (l : exact_strut) (p q b : number) (v : list number) : bool :=
  let ray := xstrut_ray k ell o c P l in let w := xvector o c P l in let size := ndot v v in
  let first := Times (Times p (Root (ndot ray ray))) size in let second := Times (Times q q) (nbent k ell o c P l v) in let least := Times (Times b size) (Root (product w w)) in
  Nat.eqb (length v) (dimension k) && certainly true size && certainly true ell &&
  (certainly true (Minus (Plus first second) least) || certainly true (Minus (Minus first second) least)).

Lemma is_accelerated_sound : forall k ell o c P l p q b v Q, (forall b, values (turn o c b) = mulv Q (values b)) ->
  is_accelerated k ell o c P l p q b v = true -> 0 < norm2 (strut_vector (strut_of l) (values P) Q) ->
  exists w a, length w = dimension k /\ length a = dimension k /\ Linear.dot w w <= value q ^ 2 /\ Linear.dot a a <= value p ^ 2 /\
    forall y, strut_accelerates k (value ell) (strut_of l) (values P) Q w a y -> value b < Rabs y.
Proof.
  intros k ell o c P l p q b v Q is_turn h reach. unfold is_accelerated in h. cbv zeta in h. apply andb_true_iff in h as [h beyond]. apply andb_true_iff in h as [h l0]. apply andb_true_iff in h as [lv size].
  apply Nat.eqb_eq in lv. apply (positive_sound bits) in size, l0. rewrite value_ndot in size.
  set (row := strut_row k (value ell) (strut_of l) (values P) Q).
  pose proof (sqrt_lt_R0 _ reach) as z0. fold (strut_length (strut_of l) (values P) Q) in z0. set (z := strut_length (strut_of l) (values P) Q) in *.
  assert (zz : z * z = norm2 (strut_vector (strut_of l) (values P) Q)) by (apply sqrt_sqrt, norm2_nonneg).
  assert (Er : map value (xstrut_ray k ell o c P l) = map (Rmult z) row).
  { unfold row, strut_row, xstrut_ray. cbv zeta. unfold normalised. fold (strut_length (strut_of l) (values P) Q). fold z.
    assert (I : value (Over (1 // 1) ell) = / value ell) by (cbn [value]; unfold Rdiv; rewrite Rinv_1; ring).
    assert (X : forall a b, map value (ntwist k a b) = twist k (values a) (values b)) by (intros; destruct k; reflexivity).
    rewrite X, values_scaled, values_crossed, is_turn, (values_xvector o c Q is_turn), I. change (mulv Q (values (xjoint l))) with (arm_of_joint (strut_of l) Q).
    generalize (strut_vector (strut_of l) (values P) Q) (arm_of_joint (strut_of l) Q). clear - z0 l0. clearbody z. intros [x1 x2 x3] [r1 r2 r3].
    destruct k; unfold twist, vscale, cross; cbn [map vx vy vz]; repeat (apply f_equal2; [field; lra |]); reflexivity. }
  assert (lr : length row = dimension k) by (unfold row, strut_row; cbv zeta; destruct k; reflexivity).
  destruct (nparts k v) as [E1 E2]. set (v' := map value v) in *. set (n := Linear.dot v' v') in *.
  set (V := shift_of k v') in *. set (W := vscale (/ value ell) (spin_of k v')). set (X := bent (strut_of l) (values P) Q V W).
  assert (EX : value (nbent k ell o c P l v) = z * X).
  { unfold nbent, X, bent. cbv zeta. cbn [value]. rewrite !value_product, values_plus, values_crossed, values_scaled, E1, E2, is_turn, (values_xvector o c Q is_turn).
    assert (I : value (Over (1 // 1) ell) = / value ell) by (cbn [value]; unfold Rdiv; rewrite Rinv_1; ring). rewrite I. fold V W.
    change (mulv Q (values (xjoint l))) with (arm_of_joint (strut_of l) Q). unfold normalised. fold (strut_length (strut_of l) (values P) Q). fold z. rewrite <- !norm2_dot, <- zz.
    set (C := vadd V (cross W (arm_of_joint (strut_of l) Q))). generalize (strut_vector (strut_of l) (values P) Q) (arm_of_joint (strut_of l) Q) C W. clear - z0. clearbody z. intros [x1 x2 x3] [r1 r2 r3] [c1 c2 c3] [w1 w2 w3]. unfold Vec3.dot, norm2, vscale. cbn [vx vy vz]. field. lra. }
  set (g := sqrt (Linear.dot row row)). assert (g0 : 0 <= g) by apply sqrt_pos. assert (g2 : g * g = Linear.dot row row) by (apply sqrt_sqrt, Linear.dot_self).
  assert (S : exists s, s * s = 1 /\ value b * n < value p * g * n + s * (value q * value q * X)).
  { assert (RY : sqrt (Linear.dot (map (Rmult z) row) (map (Rmult z) row)) = z * g).
    { rewrite dot_map, (Solve.dot_commutes row), dot_map. replace (z * (z * Linear.dot row row)) with (z ^ 2 * Linear.dot row row) by ring. rewrite sqrt_mult_alt by apply pow2_ge_0. rewrite sqrt_pow2 by lra. reflexivity. }
    assert (WW : sqrt (value (product (xvector o c P l) (xvector o c P l))) = z) by (rewrite value_square, (values_xvector o c Q is_turn); reflexivity).
    apply orb_true_iff in beyond as [beyond | beyond]; apply (positive_sound bits) in beyond; cbn [value] in beyond; rewrite !value_ndot, EX, Er, RY in beyond; fold v' n in beyond;
      change (sqrt _) with (sqrt (value (product (xvector o c P l) (xvector o c P l)))) in beyond; rewrite WW in beyond; [exists 1 | exists (-1)]; (split; [ring |]); apply Rmult_lt_reg_l with z; try exact z0; lra. }
  destruct S as [s [ss big]]. set (t := value q / sqrt n). pose proof (sqrt_lt_R0 _ size) as n0. assert (n2 : sqrt n * sqrt n = n) by (apply sqrt_sqrt; lra).
  assert (t2 : t ^ 2 * n = value q ^ 2) by (unfold t; clear - n0 n2; revert n0 n2; generalize (sqrt n); intros z n0 n2; rewrite <- n2; field; lra).
  set (w := map (Rmult t) v'). set (a := map (Rmult (s * value p / g)) row).
  assert (ag : Linear.dot row a = s * value p * g /\ Linear.dot a a <= value p ^ 2).
  { assert (D : forall x, Linear.dot row (map (Rmult x) row) = x * (g * g)) by (intro x; rewrite Solve.dot_commutes, dot_map, g2; reflexivity). unfold a. rewrite dot_map, !D. clear D. destruct (Req_dec g 0) as [-> | ne].
    - split; [ring |]. rewrite Rmult_0_l, !Rmult_0_r. apply pow2_ge_0.
    - split; [field; exact ne |]. right. replace (s * value p / g * (s * value p / g * (g * g))) with (s * s * value p ^ 2) by (field; exact ne). rewrite ss. ring. }
  destruct ag as [a1 a2]. exists w, a. unfold w at 1, a at 1. rewrite !map_length. unfold v' at 1. rewrite map_length. split; [exact lv |]. split; [exact lr |].
  split; [unfold w; rewrite dot_map, Solve.dot_commutes, dot_map; fold n; lra |]. split; [exact a2 |].
  assert (la : length a = dimension k) by (unfold a; rewrite map_length; exact lr). assert (lv' : length v' = dimension k) by (unfold v'; rewrite map_length; exact lv).
  intros y hy. assert (ne : value ell <> 0) by lra.
  assert (Ew : w = twist k (vscale t V) (vscale (value ell) (vscale t W))).
  { unfold w. rewrite (is_twist k v' lv') at 1. exact (twist_scaled k _ t _ _ ne). }
  assert (Ea : a = twist k (shift_of k a) (vscale (value ell) (vscale (/ value ell) (spin_of k a)))).
  { rewrite (is_twist k a la) at 1. rewrite <- (map_id (twist _ _ _)). pose proof (twist_scaled k _ 1 (shift_of k a) (spin_of k a) ne) as T. rewrite !(vscale_one (shift_of k a)) in T.
    rewrite vscale_one in T. rewrite <- T. apply map_ext. intro x. ring. }
  assert (Of : is_of k (vscale t V) (vscale t W)).
  { unfold V, W. destruct k; cbn; [repeat split; ring | exact I | unfold vscale, vzero; cbn; f_equal; ring]. }
  rewrite Ew, Ea in hy. apply (accelerates_only k _ _ _ _ _ _ _ _ _ ne reach Of) in hy. rewrite <- Ea in hy. fold row in hy. rewrite a1, bent_scaled in hy. fold X in hy.
  assert (Y : value b < s * y).
  { apply Rmult_lt_reg_r with n; [exact size |]. rewrite hy. replace (s * (s * value p * g + t ^ 2 * X) * n) with (s * s * (value p * g * n) + s * ((t ^ 2 * n) * X)) by ring. rewrite ss, t2.
    replace (value q ^ 2) with (value q * value q) by ring. lra. }
  assert (A : Rabs s = 1) by (assert (s = 1 \/ s = -1) as [-> | ->] by (destruct (Req_dec s 1); [left; assumption | right; apply Rmult_eq_reg_l with (s - 1); [| lra]; ring_simplify; replace (s ^ 2) with (s * s) by ring; lra]); [apply Rabs_R1 | rewrite Rabs_left; lra]).
  apply Rlt_le_trans with (1 := Y). rewrite <- (Rmult_1_l (Rabs y)), <- A, <- Rabs_mult. apply Rle_abs.
Qed.

Definition refute_accelerated (c : turning_claim) (ls : list exact_strut) (P : numbers) (t : list number) (test : nat) (v : list Z) : bool :=
  let k := motion_of c in
  is_about_exactly bits c ls P t &&
  match test_at bits (match k with AboutPoint => 1 | _ => 2 end) test (turning_demands c) with
  | Some (AccelerationMax i p q b, _) => match nth_error ls i with
      | Some l => is_accelerated k (characteristic_length c) (turned c) t P l p q b (integers_of v)
      | None => false
      end
  | _ => false
  end.

Theorem refute_accelerated_sound : forall c ls P t test v, refute_accelerated c ls P t test v = true ->
  exists m P Q, is_about_struts c m P Q /\ ~ meets_turning c m P Q.
Proof.
  intros c ls P t test v h. unfold refute_accelerated in h. cbv zeta in h. apply andb_true_iff in h as [h r].
  destruct (is_about_exactly_sound bits _ _ _ _ h) as [Q [about turnQ]]. exists (map strut_of ls), (values P), Q. split; [exact about |].
  intros [reached [_ met]]. destruct (test_at _ _ _ _) as [[d which] |] eqn:e; [| discriminate]. destruct d; try discriminate. apply test_at_in in e. rewrite Forall_forall in met. specialize (met _ e).
  destruct (nth_error ls joint) as [l |] eqn:el; [| discriminate]. cbn [fulfils struts_at accelerates] in met. cbn [struts_at Configuration.reached] in reached.
  rewrite Forall_map, Forall_forall in reached. specialize (reached l (nth_error_In _ _ el)).
  destruct (is_accelerated_sound _ _ _ _ _ _ _ _ _ _ _ turnQ r reached) as [w [a [lw [la [hw [ha far]]]]]]. destruct (met w a lw la hw ha) as [y [hy le]].
  cbn [struts_at accelerates] in hy. rewrite nth_error_map, el in hy. cbn [option_map] in hy. specialize (far y hy). lra.
Qed.
End Precision.
End Named.
