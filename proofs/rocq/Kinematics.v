(** * Kinematics of translational parallel machines with fixed-length legs

    Notation of Chablat and Wenger, "Architecture Optimization of a 3-DOF
    Translational Parallel Mechanism for Machining Applications, the
    Orthoglide".  A leg is a rod B_i C_i of length L_i; B_i slides along a
    fixed axis (its position is the joint coordinate rho_i), C_i belongs to
    the platform, which only translates.  All lengths are in one unit, say mm. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues.
Local Open Scope R_scope.

(** ** One leg on a linear joint *)

Record leg := Leg {
  axis : vec;            (* n_i, unit vector of the linear joint *)
  base_point : vec;      (* A_i, where rho_i = 0 *)
  platform_offset : vec; (* C_i - P, constant because the platform only translates *)
  leg_length : R;        (* L_i *)
  working_mode : R       (* +1 or -1: on which side of C_i the slider stands *)
}.

Definition well_formed (l : leg) : Prop :=
  norm2 (axis l) = 1 /\ 0 < leg_length l /\ (working_mode l = 1 \/ working_mode l = -1).

(** C_i - A_i, and its part orthogonal to the joint axis. *)
Definition w (l : leg) (P : vec) : vec := vsub (vadd P (platform_offset l)) (base_point l).
Definition r (l : leg) (P : vec) : vec := vsub (w l P) (vscale (dot (axis l) (w l P)) (axis l)).
(** s_i: half the chord the axis cuts from the sphere of radius L_i about C_i.
    [0 < s] says that leg i reaches P and is not serially singular there.
    (Coq's [sqrt] is 0 on negative numbers, so [0 < s] covers both.) *)
Definition s (l : leg) (P : vec) : R := sqrt (leg_length l ^ 2 - norm2 (r l P)).
Definition eta (l : leg) (P : vec) : R := working_mode l * s l P.
(** Inverse kinematics: the joint coordinate at platform position P. *)
Definition rho (l : leg) (P : vec) : R := dot (axis l) (w l P) - eta l P.

Definition A_point (l : leg) : vec := base_point l.
Definition B_point (l : leg) (P : vec) : vec := vadd (A_point l) (vscale (rho l P) (axis l)).
Definition C_point (l : leg) (P : vec) : vec := vadd P (platform_offset l).
(** The leg vector c_i - b_i: row i of the parallel Jacobian A. *)
Definition leg_vector (l : leg) (P : vec) : vec := vsub (C_point l P) (B_point l P).

Lemma leg_vector_eq : forall l P, leg_vector l P = vadd (r l P) (vscale (eta l P) (axis l)).
Proof. intros. unfold leg_vector, C_point, B_point, A_point, r, rho, w. vec_ring. Qed.

Lemma s_squared : forall l P, 0 < s l P -> s l P ^ 2 = leg_length l ^ 2 - norm2 (r l P).
Proof.
  unfold s. intros l P h. destruct (Rle_dec 0 (leg_length l ^ 2 - norm2 (r l P))) as [p | n].
  - rewrite <- Rsqr_pow2. apply Rsqr_sqrt; exact p.
  - rewrite sqrt_neg_0 in h; lra.
Qed.

Lemma mode_squared : forall l, well_formed l -> working_mode l ^ 2 = 1.
Proof. intros l [_ [_ [e | e]]]; rewrite e; ring. Qed.

Lemma r_orthogonal : forall l P, well_formed l -> dot (axis l) (r l P) = 0.
Proof.
  intros l P [unit _]. unfold r.
  replace (dot (axis l) (vsub (w l P) (vscale (dot (axis l) (w l P)) (axis l))))
    with (dot (axis l) (w l P) * (1 - norm2 (axis l))) by (generalize (w l P) (axis l); vec_ring).
  rewrite unit. ring.
Qed.

(** |r + h n|^2 and (r + h n).n, for n a unit vector orthogonal to r. *)
Lemma pythagoras : forall l P h, well_formed l ->
  norm2 (vadd (r l P) (vscale h (axis l))) = norm2 (r l P) + h ^ 2 /\
  dot (vadd (r l P) (vscale h (axis l))) (axis l) = h.
Proof.
  intros l P h ok. pose proof (r_orthogonal l P ok) as o. destruct ok as [u _].
  generalize dependent (r l P). generalize dependent (axis l). intros n u q o. split.
  - replace (norm2 (vadd q (vscale h n))) with (norm2 q + 2 * h * dot n q + h ^ 2 * norm2 n) by vec_ring.
    rewrite o, u. ring.
  - replace (dot (vadd q (vscale h n)) n) with (dot n q + h * norm2 n) by vec_ring.
    rewrite o, u. ring.
Qed.

(** The rod has its length, and eta_i is its component along the joint axis. *)
Lemma leg_vector_length : forall l P,
  well_formed l -> 0 < s l P -> norm2 (leg_vector l P) = leg_length l ^ 2.
Proof.
  intros l P ok h. rewrite leg_vector_eq, (proj1 (pythagoras _ _ _ ok)). unfold eta.
  rewrite Rpow_mult_distr, mode_squared, s_squared by assumption. ring.
Qed.

Lemma leg_vector_axis : forall l P, well_formed l -> dot (leg_vector l P) (axis l) = eta l P.
Proof. intros l P ok. rewrite leg_vector_eq. apply (pythagoras _ _ _ ok). Qed.

(** rho_i is the only joint coordinate that closes the leg in its working mode. *)
Lemma rho_unique : forall l P rho', well_formed l -> 0 < s l P ->
  let b := vadd (A_point l) (vscale rho' (axis l)) in
  norm2 (vsub (C_point l P) b) = leg_length l ^ 2 ->
  0 < working_mode l * dot (vsub (C_point l P) b) (axis l) -> rho' = rho l P.
Proof.
  intros l P rho' ok hs b len side. pose proof (s_squared l P hs) as s2.
  pose proof (mode_squared l ok) as m2. set (h := dot (axis l) (w l P) - rho') in *.
  assert (E : vsub (C_point l P) b = vadd (r l P) (vscale h (axis l)))
    by (unfold b, C_point, A_point, r, h, w; vec_ring).
  rewrite E, (proj1 (pythagoras _ _ _ ok)) in len. rewrite E, (proj2 (pythagoras _ _ _ ok)) in side.
  unfold rho, eta. assert (e : working_mode l * h = s l P).
  { apply Rsqr_inj; [lra | lra |]. rewrite !Rsqr_pow2, Rpow_mult_distr, m2. lra. }
  rewrite <- e. replace (working_mode l * (working_mode l * h)) with (working_mode l ^ 2 * h) by ring.
  rewrite m2. unfold h. ring.
Qed.

(** ** The machine: A p' = B rho' *)

Record machine := Machine { leg1 : leg; leg2 : leg; leg3 : leg }.

Definition machine_well_formed (m : machine) : Prop :=
  well_formed (leg1 m) /\ well_formed (leg2 m) /\ well_formed (leg3 m).

(** Parallel Jacobian A: rows (c_i - b_i)^T.  Serial Jacobian B: diag(eta_i). *)
Definition A_matrix (m : machine) (P : vec) : mat :=
  Mat (leg_vector (leg1 m) P) (leg_vector (leg2 m) P) (leg_vector (leg3 m) P).
Definition B_matrix (m : machine) (P : vec) : mat :=
  mdiag (eta (leg1 m) P) (eta (leg2 m) P) (eta (leg3 m) P).
(** J^-1 = B^-1 A, so that rho' = J^-1 p'. *)
Definition Jinv (m : machine) (P : vec) : mat :=
  mulm (mdiag (/ eta (leg1 m) P) (/ eta (leg2 m) P) (/ eta (leg3 m) P)) (A_matrix m P).

(** [P] can be reached, and is neither serially (eta_i = 0) nor parallel
    (det A = 0) singular. *)
Definition regular (m : machine) (P : vec) : Prop :=
  0 < s (leg1 m) P /\ 0 < s (leg2 m) P /\ 0 < s (leg3 m) P /\ det (A_matrix m P) <> 0.

Lemma eta_nonzero : forall l P, well_formed l -> 0 < s l P -> eta l P <> 0.
Proof. intros l P [_ [_ [e | e]]] h; unfold eta; rewrite e; lra. Qed.

Lemma Jinv_velocity : forall m P pdot rhodot,
  eta (leg1 m) P <> 0 -> eta (leg2 m) P <> 0 -> eta (leg3 m) P <> 0 ->
  (mulv (A_matrix m P) pdot = mulv (B_matrix m P) rhodot <-> rhodot = mulv (Jinv m P) pdot).
Proof.
  intros m P pdot rhodot h1 h2 h3. unfold Jinv, A_matrix, B_matrix.
  set (a := eta (leg1 m) P) in *. set (b := eta (leg2 m) P) in *. set (c := eta (leg3 m) P) in *.
  generalize (leg_vector (leg1 m) P) (leg_vector (leg2 m) P) (leg_vector (leg3 m) P).
  clearbody a b c. clear m P. intros u v w0. destruct rhodot as [r1 r2 r3].
  rewrite mulv_mulm. split; intro h.
  - injection h as i1 i2 i3. unfold mulv at 1. cbn [row1 row2 row3 mdiag]. unfold_vec.
    f_equal; [rewrite i1 | rewrite i2 | rewrite i3]; field; auto.
  - injection h as -> -> ->. unfold_vec. f_equal; field; auto.
Qed.

(** Rows of J^-1, without the division of A by B: n_i + r_i / eta_i. *)
Definition Jinv_row (l : leg) (P : vec) : vec := vadd (axis l) (vscale (/ eta l P) (r l P)).

Lemma Jinv_rows : forall m P,
  eta (leg1 m) P <> 0 -> eta (leg2 m) P <> 0 -> eta (leg3 m) P <> 0 ->
  Jinv m P = Mat (Jinv_row (leg1 m) P) (Jinv_row (leg2 m) P) (Jinv_row (leg3 m) P).
Proof.
  intros m P h1 h2 h3. unfold Jinv, A_matrix, Jinv_row. rewrite !leg_vector_eq.
  generalize dependent (eta (leg1 m) P). generalize dependent (eta (leg2 m) P).
  generalize dependent (eta (leg3 m) P).
  generalize (r (leg1 m) P) (r (leg2 m) P) (r (leg3 m) P) (axis (leg1 m)) (axis (leg2 m)) (axis (leg3 m)).
  intros. unfold_vec. do 2 f_equal; field; assumption.
Qed.

Lemma det_Jinv : forall m P,
  det (Jinv m P) = / eta (leg1 m) P * / eta (leg2 m) P * / eta (leg3 m) P * det (A_matrix m P).
Proof.
  intros m P. unfold Jinv, A_matrix.
  generalize (/ eta (leg1 m) P) (/ eta (leg2 m) P) (/ eta (leg3 m) P)
    (leg_vector (leg1 m) P) (leg_vector (leg2 m) P) (leg_vector (leg3 m) P).
  vec_ring.
Qed.

(** A positive lower bound on the singular values excludes parallel singularities. *)
Lemma regular_from_bound : forall m P kappa,
  0 < kappa -> 0 < s (leg1 m) P -> 0 < s (leg2 m) P -> 0 < s (leg3 m) P ->
  sigma_at_least kappa (Jinv m P) -> regular m P.
Proof.
  intros m P kappa hk h1 h2 h3 low. repeat split; try assumption.
  intro d. apply (sigma_positive_det kappa (Jinv m P) hk low). rewrite det_Jinv, d. ring.
Qed.

(** ** The Orthoglide

    Three orthogonal axes through O, A_i = a e_i, C_i = P - e e_i, equal legs of
    length L on the positive side.  [a] and [e] only shift the joint
    coordinates: they do not enter J^-1. *)

Definition orthoglide (L a e : R) : machine :=
  let make n := Leg n (vscale a n) (vscale (- e) n) L 1 in
  Machine (make e1) (make e2) (make e3).

Lemma orthoglide_well_formed : forall L a e, 0 < L -> machine_well_formed (orthoglide L a e).
Proof.
  intros L a e h. repeat split; cbn; try exact h; try (left; reflexivity); unfold_vec; ring.
Qed.

(** Length of a leg along its own axis when its end is offset by u and v
    across it, for L = 1: sqrt(1 - u^2 - v^2). *)
Definition s_unit (u v : R) : R := sqrt (1 - u ^ 2 - v ^ 2).

(** The matrix M of the paper's model for L = 1. *)
Definition M (p : vec) : mat :=
  let (x, y, z) := p in
  Mat (Vec 1 (y / s_unit y z) (z / s_unit y z))
      (Vec (x / s_unit x z) 1 (z / s_unit x z))
      (Vec (x / s_unit x y) (y / s_unit x y) 1).

Definition reachable_unit (p : vec) : Prop :=
  0 < s_unit (vy p) (vz p) /\ 0 < s_unit (vx p) (vz p) /\ 0 < s_unit (vx p) (vy p).

Lemma s_scale : forall L u v, 0 < L -> sqrt (L ^ 2 - (u ^ 2 + v ^ 2)) = L * s_unit (/ L * u) (/ L * v).
Proof.
  intros L u v h. unfold s_unit. rewrite <- (sqrt_pow2 L) at 2 by lra.
  rewrite <- sqrt_mult_alt by nra. f_equal. field. lra.
Qed.

Section Orthoglide.
Variables L a e : R.
Hypothesis L_pos : 0 < L.
Let m := orthoglide L a e.

Lemma orthoglide_s : forall P, let p := vscale (/ L) P in
  s (leg1 m) P = L * s_unit (vy p) (vz p) /\
  s (leg2 m) P = L * s_unit (vx p) (vz p) /\
  s (leg3 m) P = L * s_unit (vx p) (vy p).
Proof.
  intros [x y z] p. cbn [p vscale vx vy vz].
  rewrite <- !s_scale by exact L_pos. unfold s, r, w, m, orthoglide.
  cbn [leg1 leg2 leg3 axis base_point platform_offset leg_length]. unfold_vec.
  repeat split; f_equal; ring.
Qed.

(** J^-1 depends on P/L alone, through the matrix M of the paper. *)
Theorem orthoglide_Jinv : forall P, reachable_unit (vscale (/ L) P) ->
  Jinv m P = M (vscale (/ L) P).
Proof.
  intros P h. pose proof (orthoglide_s P) as E. cbn zeta in E. destruct E as [E1 [E2 E3]].
  destruct P as [x y z]. destruct h as [h1 [h2 h3]]. cbn [vscale vx vy vz] in *.
  assert (T1 : eta (leg1 m) (Vec x y z) = L * s_unit (/ L * y) (/ L * z)) by (rewrite <- E1; unfold eta, m; cbn; ring).
  assert (T2 : eta (leg2 m) (Vec x y z) = L * s_unit (/ L * x) (/ L * z)) by (rewrite <- E2; unfold eta, m; cbn; ring).
  assert (T3 : eta (leg3 m) (Vec x y z) = L * s_unit (/ L * x) (/ L * y)) by (rewrite <- E3; unfold eta, m; cbn; ring).
  rewrite Jinv_rows; rewrite ?T1, ?T2, ?T3; try (apply Rmult_integral_contrapositive_currified; lra).
  unfold Jinv_row. rewrite T1, T2, T3. unfold M; cbn [vscale vx vy vz].
  set (s1 := s_unit (/ L * y) (/ L * z)) in *. set (s2 := s_unit (/ L * x) (/ L * z)) in *.
  set (s3 := s_unit (/ L * x) (/ L * y)) in *. clearbody s1 s2 s3.
  unfold r, w, m, orthoglide. cbn [leg1 leg2 leg3 axis base_point platform_offset].
  unfold_vec. vec_split; field; lra.
Qed.

(** The same matrix written in mm, as in the paper. *)
Corollary orthoglide_Jinv_mm : forall x y z,
  let s1 := sqrt (L ^ 2 - (y ^ 2 + z ^ 2)) in
  let s2 := sqrt (L ^ 2 - (x ^ 2 + z ^ 2)) in
  let s3 := sqrt (L ^ 2 - (x ^ 2 + y ^ 2)) in
  0 < s1 -> 0 < s2 -> 0 < s3 ->
  Jinv m (Vec x y z) = Mat (Vec 1 (y / s1) (z / s1)) (Vec (x / s2) 1 (z / s2)) (Vec (x / s3) (y / s3) 1).
Proof.
  intros x y z s1 s2 s3 h1 h2 h3. unfold s1, s2, s3 in *. rewrite !s_scale in * by exact L_pos.
  assert (C : forall t, 0 < L * t -> 0 < t) by (intros; nra).
  apply C in h1, h2, h3.
  rewrite orthoglide_Jinv by (unfold reachable_unit; cbn [vscale vx vy vz]; auto).
  unfold M; cbn [vscale vx vy vz]. clear s1 s2 s3.
  generalize dependent (s_unit (/ L * y) (/ L * z)). generalize dependent (s_unit (/ L * x) (/ L * z)).
  generalize dependent (s_unit (/ L * x) (/ L * y)). intros. vec_split; field; lra.
Qed.

(** All that has to be shown about M to conclude about the machine. *)
Theorem orthoglide_regular : forall P kappa,
  let p := vscale (/ L) P in
  0 < kappa -> reachable_unit p -> sigma_at_least kappa (M p) -> regular m P.
Proof.
  intros P kappa p hk h low. destruct (orthoglide_s P) as [E1 [E2 E3]]. fold p in E1, E2, E3.
  destruct h as [h1 [h2 h3]].
  apply (regular_from_bound m P kappa hk).
  1-3: rewrite ?E1, ?E2, ?E3; apply Rmult_lt_0_compat; assumption.
  rewrite orthoglide_Jinv by (repeat split; assumption). exact low.
Qed.
End Orthoglide.
