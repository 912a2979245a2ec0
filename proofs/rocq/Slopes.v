(** * Slopes: the rows of J^-1 as affine functions with enclosed coefficients

    For a fixed expansion point c, J^-1(P) = J^-1(c) + sum_k (P - c)_k E_k(P)
    exactly.  The identities below use square roots only; enclosing the E_k
    over a box is what lets the vertex rules decide it.  Each entry uses one
    identity: mixing the enclosures of two different ones would not be sound. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Rules.
Local Open Scope R_scope.

(** u v^T *)
Definition outer (u v : vec) : mat := Mat (vscale (vx u) v) (vscale (vy u) v) (vscale (vz u) v).

Lemma mulv_outer : forall u v d, mulv (outer u v) d = vscale (dot v d) u.
Proof. unfold outer. vec_ring. Qed.

(** I - n n^T: projection on the plane orthogonal to the unit vector n. *)
Definition projection (n : vec) : mat := msub midentity (outer n n).

(** ** The Orthoglide's entry u / sqrt(L^2 - u^2 - v^2) *)

Theorem entry_slope : forall L u v c d,
  let s := sqrt (L ^ 2 - u ^ 2 - v ^ 2) in
  let s_c := sqrt (L ^ 2 - c ^ 2 - d ^ 2) in
  let K := s * s_c * (s + s_c) in
  0 < s -> 0 < s_c ->
  u / s - c / s_c = (u - c) * (1 / s + c * (u + c) / K) + (v - d) * (c * (v + d) / K).
Proof.
  intros L u v c d s s_c K h h'.
  assert (sq : forall x, 0 < sqrt x -> sqrt x ^ 2 = x).
  { intros x p. rewrite <- Rsqr_pow2. apply Rsqr_sqrt. destruct (Rle_dec 0 x) as [q | q]; [exact q |].
    rewrite sqrt_neg_0 in p; lra. }
  assert (e : s ^ 2 = L ^ 2 - u ^ 2 - v ^ 2) by (apply sq; exact h).
  assert (e' : s_c ^ 2 = L ^ 2 - c ^ 2 - d ^ 2) by (apply sq; exact h').
  clearbody s s_c. unfold K. apply Rminus_diag_uniq.
  (* the difference vanishes because s_c^2 - s^2 = u^2 + v^2 - c^2 - d^2 *)
  replace (u / s - c / s_c - ((u - c) * (1 / s + c * (u + c) / (s * s_c * (s + s_c)))
             + (v - d) * (c * (v + d) / (s * s_c * (s + s_c)))))
    with (c * (s_c ^ 2 - s ^ 2 - (u ^ 2 + v ^ 2 - c ^ 2 - d ^ 2)) / (s * s_c * (s + s_c)))
    by (field; lra).
  replace (s_c ^ 2 - s ^ 2 - (u ^ 2 + v ^ 2 - c ^ 2 - d ^ 2)) with 0 by lra. unfold Rdiv. ring.
Qed.

(** ** Slider legs: the row n + r / eta and the joint coordinate rho *)

Lemma r_difference : forall l P c,
  vsub (r l P) (r l c) = mulv (projection (axis l)) (vsub P c).
Proof.
  intros l P c. unfold r, w, projection, outer.
  generalize (axis l) (platform_offset l) (base_point l). vec_ring.
Qed.

(** s_c^2 - s^2 = |r|^2 - |r_c|^2 = (r + r_c).(P - c), since r is orthogonal to n. *)
Lemma s_difference : forall l P c, well_formed l -> 0 < s l P -> 0 < s l c ->
  s l c ^ 2 - s l P ^ 2 = dot (vadd (r l P) (r l c)) (vsub P c).
Proof.
  intros l P c ok h h'. rewrite !s_squared by assumption.
  pose proof (r_orthogonal l P ok) as o. pose proof (r_orthogonal l c ok) as o'.
  transitivity (dot (vadd (r l P) (r l c)) (vsub (r l P) (r l c)));
    [generalize (r l P) (r l c); vec_ring |].
  rewrite r_difference. generalize dependent (r l P). generalize dependent (r l c).
  intros rc o' rp o. generalize dependent (axis l). intros n o' o. generalize (vsub P c). intro d.
  transitivity (dot (vadd rp rc) d - (dot n rp + dot n rc) * dot n d);
    [unfold projection, outer; vec_ring | rewrite o, o'; ring].
Qed.

(** The slope matrix of row i:
    S = m [ Pi / s + r_c (r + r_c)^T / (s s_c (s + s_c)) ], m the working mode. *)
Definition slider_slope (l : leg) (P c : vec) : mat :=
  mscale (working_mode l)
    (madd (mscale (/ s l P) (projection (axis l)))
          (mscale (/ (s l P * s l c * (s l P + s l c))) (outer (r l c) (vadd (r l P) (r l c))))).

Lemma inv_eta : forall l P, well_formed l -> 0 < s l P -> / eta l P = working_mode l * / s l P.
Proof. intros l P [_ [_ [e | e]]] h; unfold eta; rewrite e; field; lra. Qed.

Theorem slider_row_slope : forall l P c, well_formed l -> 0 < s l P -> 0 < s l c ->
  Jinv_row l P = vadd (Jinv_row l c) (mulv (slider_slope l P c) (vsub P c)).
Proof.
  intros l P c ok h h'. unfold Jinv_row, slider_slope. rewrite !inv_eta by assumption.
  rewrite mulv_mscale, mulv_madd, !mulv_mscale, mulv_outer.
  rewrite <- r_difference, <- (s_difference l P c ok h h').
  generalize dependent (s l P). generalize dependent (s l c). intros sc h' sp h.
  generalize (r l P) (r l c) (axis l) (working_mode l). intros rp rc n m.
  unfold_vec. vec_split; field; lra.
Qed.

(** rho - rho_c = [n + m (r + r_c)/(s + s_c)].(P - c) *)
Theorem slider_rho_slope : forall l P c, well_formed l -> 0 < s l P -> 0 < s l c ->
  rho l P - rho l c
  = dot (vadd (axis l) (vscale (working_mode l / (s l P + s l c)) (vadd (r l P) (r l c)))) (vsub P c).
Proof.
  intros l P c ok h h'.
  assert (E : forall n u f d, dot (vadd n (vscale f u)) d = dot n d + f * dot u d) by vec_ring.
  rewrite E, <- (s_difference l P c ok h h'). unfold rho, eta.
  assert (W : dot (axis l) (w l P) - dot (axis l) (w l c) = dot (axis l) (vsub P c)).
  { unfold w. generalize (axis l) (platform_offset l) (base_point l). vec_ring. }
  rewrite <- W. field. lra.
Qed.

(** ** The three rows together, in the form the vertex rules use *)

(** Column k of the three slope matrices: the coefficient of (P - c)_k. *)
Definition slope_1 (m : machine) (P c : vec) : mat :=
  Mat (col1 (slider_slope (leg1 m) P c)) (col1 (slider_slope (leg2 m) P c)) (col1 (slider_slope (leg3 m) P c)).
Definition slope_2 (m : machine) (P c : vec) : mat :=
  Mat (col2 (slider_slope (leg1 m) P c)) (col2 (slider_slope (leg2 m) P c)) (col2 (slider_slope (leg3 m) P c)).
Definition slope_3 (m : machine) (P c : vec) : mat :=
  Mat (col3 (slider_slope (leg1 m) P c)) (col3 (slider_slope (leg2 m) P c)) (col3 (slider_slope (leg3 m) P c)).

Definition legs_reach (m : machine) (P : vec) : Prop :=
  0 < s (leg1 m) P /\ 0 < s (leg2 m) P /\ 0 < s (leg3 m) P.

Theorem Jinv_slopes : forall m P c, machine_well_formed m -> legs_reach m P -> legs_reach m c ->
  Jinv m P = affine (Jinv m c) (slope_1 m P c) (slope_2 m P c) (slope_3 m P c) (vsub P c).
Proof.
  intros m P c [w1 [w2 w3]] [p1 [p2 p3]] [c1 [c2 c3]].
  rewrite !Jinv_rows by (apply eta_nonzero; assumption).
  rewrite (slider_row_slope (leg1 m) P c), (slider_row_slope (leg2 m) P c),
    (slider_row_slope (leg3 m) P c) by assumption.
  unfold slope_1, slope_2, slope_3.
  generalize (slider_slope (leg1 m) P c) (slider_slope (leg2 m) P c) (slider_slope (leg3 m) P c)
    (Jinv_row (leg1 m) c) (Jinv_row (leg2 m) c) (Jinv_row (leg3 m) c) (vsub P c).
  intros S1 S2 S3 j1 j2 j3 d. unfold affine. unfold_vec. vec_split; ring.
Qed.
