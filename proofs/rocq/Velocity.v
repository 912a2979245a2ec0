(** * J^-1 is the derivative of the inverse kinematics

    A guard on the model: along any differentiable trajectory P(t) of the
    platform, the joint coordinate rho_i moves at the speed (row i of J^-1).P'.
    So the matrix whose singular values are bounded is the one that relates
    joint and platform velocities, and not merely a matrix of that name. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics.
Local Open Scope R_scope.

(** P'(t) = V, coordinate by coordinate. *)
Definition has_velocity (P : R -> vec) (t : R) (V : vec) : Prop :=
  derivable_pt_lim (fun u => vx (P u)) t (vx V) /\
  derivable_pt_lim (fun u => vy (P u)) t (vy V) /\
  derivable_pt_lim (fun u => vz (P u)) t (vz V).

(** The standard rules, for functions equal at every point to those wanted. *)
Lemma derivable_eq : forall f g t d d', derivable_pt_lim f t d -> (forall u, g u = f u) -> d' = d ->
  derivable_pt_lim g t d'.
Proof.
  intros f g t d d' h e ->. intros eps he. destruct (h eps he) as [delta D]. exists delta.
  intros k nz small. rewrite !e. apply D; assumption.
Qed.

Lemma derivable_const : forall c t, derivable_pt_lim (fun _ => c) t 0.
Proof. intros. apply derivable_pt_lim_const. Qed.

Lemma derivable_scal : forall c f t d, derivable_pt_lim f t d -> derivable_pt_lim (fun u => c * f u) t (c * d).
Proof. intros c f t d h. exact (derivable_pt_lim_scal f c t d h). Qed.

Lemma derivable_add : forall f g t d d', derivable_pt_lim f t d -> derivable_pt_lim g t d' ->
  derivable_pt_lim (fun u => f u + g u) t (d + d').
Proof. intros f g t d d' h h'. exact (derivable_pt_lim_plus f g t d d' h h'). Qed.

Lemma derivable_square : forall f t d, derivable_pt_lim f t d -> derivable_pt_lim (fun u => f u ^ 2) t (2 * f t * d).
Proof.
  intros f t d h. apply derivable_eq with (fun u => f u * f u) (d * f t + f t * d); try (intros; ring).
  exact (derivable_pt_lim_mult f f t d d h h).
Qed.

(** Derivatives of the vectors w and r of a leg: P' and its projection. *)
Lemma velocity_dot : forall P t V n, has_velocity P t V ->
  derivable_pt_lim (fun u => dot n (P u)) t (dot n V).
Proof.
  intros P t V n [hx [hy hz]]. unfold dot. repeat apply derivable_add; apply derivable_scal; assumption.
Qed.

Lemma velocity_w : forall l P t V, has_velocity P t V -> has_velocity (fun u => w l (P u)) t V.
Proof.
  intros l P t V [hx [hy hz]]. unfold w, vsub, vadd; repeat split; cbn [vx vy vz].
  - apply derivable_eq with (fun u => vx (P u) + (vx (platform_offset l) - vx (base_point l))) (vx V + 0);
      try (intros; ring). apply derivable_add; [assumption | apply derivable_const].
  - apply derivable_eq with (fun u => vy (P u) + (vy (platform_offset l) - vy (base_point l))) (vy V + 0);
      try (intros; ring). apply derivable_add; [assumption | apply derivable_const].
  - apply derivable_eq with (fun u => vz (P u) + (vz (platform_offset l) - vz (base_point l))) (vz V + 0);
      try (intros; ring). apply derivable_add; [assumption | apply derivable_const].
Qed.

Lemma velocity_r : forall l P t V, has_velocity P t V ->
  has_velocity (fun u => r l (P u)) t (vsub V (vscale (dot (axis l) V) (axis l))).
Proof.
  intros l P t V h. pose proof (velocity_w l P t V h) as hw.
  pose proof (velocity_dot _ t V (axis l) hw) as hd. destruct hw as [hx [hy hz]].
  unfold r, vsub, vscale; repeat split; cbn [vx vy vz].
  - apply derivable_eq with (fun u => vx (w l (P u)) + - vx (axis l) * dot (axis l) (w l (P u)))
      (vx V + - vx (axis l) * dot (axis l) V); try (intros; ring).
    apply derivable_add; [exact hx | apply derivable_scal; exact hd].
  - apply derivable_eq with (fun u => vy (w l (P u)) + - vy (axis l) * dot (axis l) (w l (P u)))
      (vy V + - vy (axis l) * dot (axis l) V); try (intros; ring).
    apply derivable_add; [exact hy | apply derivable_scal; exact hd].
  - apply derivable_eq with (fun u => vz (w l (P u)) + - vz (axis l) * dot (axis l) (w l (P u)))
      (vz V + - vz (axis l) * dot (axis l) V); try (intros; ring).
    apply derivable_add; [exact hz | apply derivable_scal; exact hd].
Qed.

Lemma velocity_norm2 : forall P t V, has_velocity P t V ->
  derivable_pt_lim (fun u => norm2 (P u)) t (2 * dot (P t) V).
Proof.
  intros P t V [hx [hy hz]]. unfold norm2, dot.
  apply derivable_eq with (fun u => vx (P u) ^ 2 + vy (P u) ^ 2 + vz (P u) ^ 2)
    (2 * vx (P t) * vx V + 2 * vy (P t) * vy V + 2 * vz (P t) * vz V); try (intros; ring).
  repeat apply derivable_add; apply derivable_square; assumption.
Qed.

(** s' = - (r.V) / s *)
Lemma velocity_s : forall l P t V, well_formed l -> 0 < s l (P t) -> has_velocity P t V ->
  derivable_pt_lim (fun u => s l (P u)) t (- (dot (r l (P t)) V) / s l (P t)).
Proof.
  intros l P t V ok h hv. pose proof (r_orthogonal l (P t) ok) as o.
  pose proof (velocity_norm2 _ t _ (velocity_r l P t V hv)) as hn. cbn beta in hn.
  assert (D : dot (r l (P t)) (vsub V (vscale (dot (axis l) V) (axis l))) = dot (r l (P t)) V).
  { transitivity (dot (r l (P t)) V - dot (axis l) V * dot (axis l) (r l (P t)));
      [generalize (r l (P t)) (axis l); vec_ring | rewrite o; ring]. }
  rewrite D in hn. clear D o.
  set (f := fun u => leg_length l ^ 2 - norm2 (r l (P u))).
  assert (hf : derivable_pt_lim f t (- (2 * dot (r l (P t)) V))).
  { apply derivable_eq with (fun u => leg_length l ^ 2 + -1 * norm2 (r l (P u))) (0 + -1 * (2 * dot (r l (P t)) V));
      try (intros; unfold f; ring).
    apply derivable_add; [apply derivable_const | apply derivable_scal; exact hn]. }
  assert (pos : 0 < f t).
  { unfold f. rewrite <- s_squared by exact h. apply pow_lt; exact h. }
  apply derivable_eq with (comp sqrt f) (/ (2 * sqrt (f t)) * - (2 * dot (r l (P t)) V)).
  - exact (derivable_pt_lim_comp f sqrt t _ _ hf (derivable_pt_lim_sqrt (f t) pos)).
  - reflexivity.
  - change (sqrt (f t)) with (s l (P t)). field. lra.
Qed.

(** rho' = (n + r/eta).V *)
Theorem joint_velocity : forall l P t V, well_formed l -> 0 < s l (P t) -> has_velocity P t V ->
  derivable_pt_lim (fun u => rho l (P u)) t (dot (Jinv_row l (P t)) V).
Proof.
  intros l P t V ok h hv. unfold rho, eta.
  pose proof (velocity_dot _ t V (axis l) (velocity_w l P t V hv)) as hd.
  pose proof (velocity_s l P t V ok h hv) as hs.
  apply derivable_eq with (fun u => dot (axis l) (w l (P u)) + - working_mode l * s l (P u))
    (dot (axis l) V + - working_mode l * (- (dot (r l (P t)) V) / s l (P t))); try (intros; ring).
  - apply derivable_add; [exact hd | apply derivable_scal; exact hs].
  - assert (E : forall n u f d, dot (vadd n (vscale f u)) d = dot n d + f * dot u d) by vec_ring.
    unfold Jinv_row. rewrite E. pose proof (mode_squared l ok) as m2.
    assert (I : / eta l (P t) = working_mode l / s l (P t)).
    { unfold eta. replace (working_mode l / s l (P t)) with (working_mode l ^ 2 / (working_mode l * s l (P t)));
        [rewrite m2; field | field]; split; try lra; intro z; rewrite z in m2; lra. }
    rewrite I. field. lra.
Qed.

(** All three joints at once. *)
Theorem Jinv_is_derivative : forall m P t V, machine_well_formed m ->
  0 < s (leg1 m) (P t) -> 0 < s (leg2 m) (P t) -> 0 < s (leg3 m) (P t) -> has_velocity P t V ->
  has_velocity (fun u => Vec (rho (leg1 m) (P u)) (rho (leg2 m) (P u)) (rho (leg3 m) (P u))) t
    (mulv (Jinv m (P t)) V).
Proof.
  intros m P t V [w1 [w2 w3]] h1 h2 h3 hv. rewrite Jinv_rows by (apply eta_nonzero; assumption).
  unfold mulv; repeat split; cbn [vx vy vz row1 row2 row3]; apply joint_velocity; assumption.
Qed.
