(** * From the scale-free matrix M to a machine in mm

    J^-1 of an Orthoglide with legs of length L at P is M(P/L); this file
    carries cubes, points of the diagonal and bounds across that scaling. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal CubeLower CubeUpper.
Local Open Scope R_scope.

(** What the paper requires of the machine at [P]: no singularity, and every
    velocity transmission factor 1/xi_i between 1/psi and psi. *)
Definition transmission_within (psi : R) (m : machine) (P : vec) : Prop :=
  regular m P /\ forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv m P) v) <= psi ^ 2 * norm2 v.

Lemma kappa_range : forall psi, 1 < psi -> 0 < 1 / psi < 1 /\ 1 / (1 / psi) = psi.
Proof.
  intros psi h. split; [| field; lra]. split; [apply Rdiv_lt_0_compat; lra |].
  apply Rmult_lt_reg_r with psi; [lra |]. replace (1 / psi * psi) with 1 by (field; lra). lra.
Qed.

Section Machine.
Variables L a e : R.
Hypothesis L_pos : 0 < L.

Lemma in_box_scale : forall lo hi P,
  in_box (L * lo) (L * hi) P <-> in_box lo hi (vscale (/ L) P).
Proof.
  intros lo hi [x y z]. unfold in_box; cbn [vscale vx vy vz].
  assert (X : forall u, L * lo <= u <= L * hi <-> lo <= / L * u <= hi).
  { intro u. assert (E : L * (/ L * u) = u) by (field; lra). split; intros [h1 h2].
    - split; apply Rmult_le_reg_l with L; lra.
    - rewrite <- E. split; apply Rmult_le_compat_l; lra. }
  rewrite !X. tauto.
Qed.

Lemma diagonal_scale : forall c P, vscale (/ L) P = diagonal c <-> P = diagonal (L * c).
Proof.
  intros c [x y z]. unfold diagonal, vscale; cbn [vx vy vz]. split; intro h.
  - injection h as hx hy hz. f_equal; [rewrite <- hx | rewrite <- hy | rewrite <- hz]; field; lra.
  - injection h as -> -> ->. f_equal; field; lra.
Qed.

(** Bounds on M at P/L are bounds on the machine at P. *)
Lemma transmission_from_M : forall psi P, let p := vscale (/ L) P in
  1 < psi -> reachable_unit p -> sigma_at_least (1 / psi) (M p) -> sigma_at_most psi (M p) ->
  transmission_within psi (orthoglide L a e) P.
Proof.
  intros psi P p hpsi reach low up. destruct (kappa_range psi hpsi) as [k _]. split.
  - apply (orthoglide_regular L a e L_pos P (1 / psi)); auto; lra.
  - intro v. rewrite orthoglide_Jinv by assumption. split; [apply low | apply up].
Qed.

(** J^-1 at (Lc,Lc,Lc) and at (-Lc,-Lc,-Lc). *)
Lemma diagonal_reachable : forall c t d, on_diagonal c t -> d = c \/ d = - c ->
  reachable_unit (vscale (/ L) (diagonal (L * d))).
Proof.
  intros c t d D h. rewrite (proj2 (diagonal_scale d _)) by reflexivity.
  apply (in_box_reachable c t); [exact D |]. destruct D as [c0 _].
  unfold in_box, diagonal; cbn [vx vy vz]. destruct h; lra.
Qed.

Lemma Jinv_diagonal_pos : forall c t, on_diagonal c t ->
  Jinv (orthoglide L a e) (diagonal (L * c)) = constant_offdiagonal t.
Proof.
  intros c t D. rewrite orthoglide_Jinv by (assumption || (apply (diagonal_reachable c t); auto)).
  rewrite (proj2 (diagonal_scale c _)) by reflexivity. apply M_diagonal_pos; exact D.
Qed.

Lemma Jinv_diagonal_neg : forall c t, on_diagonal c t ->
  Jinv (orthoglide L a e) (diagonal (L * - c)) = constant_offdiagonal (- t).
Proof.
  intros c t D. rewrite orthoglide_Jinv by (assumption || (apply (diagonal_reachable c t); auto)).
  rewrite (proj2 (diagonal_scale (- c) _)) by reflexivity. apply M_diagonal_neg; exact D.
Qed.
End Machine.
