(** * The Q1/Q2 postulate of the Orthoglide

    For a required bound psi > 1 on the velocity transmission factors and
    their inverses, the paper computes two points Q_1 and Q_2 of the diagonal
    where the bound holds with equality, and takes [q_1,q_2]^3 as workspace,
    on the (numerically supported) postulate that the bound then holds on the
    whole cube.  Here it is a theorem, for every psi > 1, every leg length L,
    every base distance a and every tool offset e. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal CubeLower CubeUpper Scaling.
Local Open Scope R_scope.

(** ** The paper's cube *)

(** Off-diagonal entries of M at Q_1 (where they are -t_1) and at Q_2,
    for kappa = 1/psi. *)
Definition t_1 (kappa : R) : R := (1 - kappa) / 2.
Definition t_2 (kappa : R) : R := if Rle_dec kappa (1/2) then 1 - kappa else (1 / kappa - 1) / 2.

Definition q_1 (L psi : R) : R := - L * position_of_entry (t_1 (1 / psi)).
Definition q_2 (L psi : R) : R := L * position_of_entry (t_2 (1 / psi)).
Definition Q_1 (L psi : R) : vec := diagonal (q_1 L psi).
Definition Q_2 (L psi : R) : vec := diagonal (q_2 L psi).
(** W = [q_1, q_2]^3. *)
Definition in_cube (L psi : R) (P : vec) : Prop := in_box (q_1 L psi) (q_2 L psi) P.

(** All that the proof needs to know about t_1 and t_2. *)
Lemma t_facts : forall kappa, 0 < kappa < 1 ->
  0 < t_1 kappa < 1/2 /\ t_1 kappa < t_2 kappa < 1 /\
  2 * t_1 kappa = 1 - kappa /\ t_2 kappa <= 1 - kappa /\ 1 + 2 * t_2 kappa <= 1 / kappa.
Proof.
  intros kappa [h0 h1]. unfold t_1, t_2. assert (e : kappa * (1 / kappa) = 1) by (field; lra).
  set (i := 1 / kappa) in *. destruct (Rle_dec kappa (1/2)); repeat split; try lra; nra.
Qed.

Section Machine.
Variables L a e : R.
Hypothesis L_pos : 0 < L.

(** ** The theorem *)

Section Postulate.
Variable psi : R.
Hypothesis psi_gt_1 : 1 < psi.
Let kappa := 1 / psi.
Let c1 := position_of_entry (t_1 kappa).
Let c2 := position_of_entry (t_2 kappa).

Lemma kappa_01 : 0 < kappa < 1.
Proof. exact (proj1 (kappa_range psi psi_gt_1)). Qed.

Lemma corners : on_diagonal c1 (t_1 kappa) /\ on_diagonal c2 (t_2 kappa) /\ c1 < c2.
Proof.
  pose proof kappa_01 as k. destruct (t_facts _ k) as [[T0 _] [[T1 _] _]].
  assert (D1 : on_diagonal c1 (t_1 kappa)) by (apply position_on_diagonal; lra).
  assert (D2 : on_diagonal c2 (t_2 kappa)) by (apply position_on_diagonal; lra).
  split; [exact D1 |]. split; [exact D2 |]. apply (diagonal_lt _ _ _ _ D1 D2). exact T1.
Qed.

Lemma cube_scaled : forall P, in_cube L psi P <-> in_box (- c1) c2 (vscale (/ L) P).
Proof.
  intro P. rewrite <- (in_box_scale L L_pos). unfold in_cube, q_1, q_2. fold kappa. fold c1. fold c2.
  replace (L * - c1) with (- L * c1) by ring. reflexivity.
Qed.

Lemma cube_inside : forall P, in_cube L psi P -> in_box (- c2) c2 (vscale (/ L) P).
Proof.
  intros P h. apply cube_scaled in h. destruct corners as [_ [_ lt]]. revert h. unfold in_box. lra.
Qed.

Lemma cube_reachable : forall P, in_cube L psi P -> reachable_unit (vscale (/ L) P).
Proof.
  intros P h. destruct corners as [_ [D2 _]]. apply (in_box_reachable c2 (t_2 kappa)); [exact D2 |].
  apply cube_inside; exact h.
Qed.

Lemma sum_below_psi : 1 + 2 * t_2 kappa <= psi.
Proof.
  destruct (kappa_range psi psi_gt_1) as [_ e']. pose proof kappa_01 as k. destruct (t_facts _ k) as [_ [_ [_ [_ h]]]].
  fold kappa in e'. rewrite e' in h. exact h.
Qed.

Theorem q1q2_postulate : forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros P h. pose proof kappa_01 as k.
  destruct (t_facts _ k) as [T1 [T2 [E [F _]]]]. destruct corners as [D1 [D2 _]].
  apply transmission_from_M; [exact L_pos | exact psi_gt_1 | apply cube_reachable; exact h | |].
  - fold kappa. apply (cube_lower kappa c1 c2 (t_1 kappa) (t_2 kappa)); auto; try lra.
    apply cube_scaled; exact h.
  - apply sigma_at_most_weaken with (1 + 2 * t_2 kappa); [pose proof sum_below_psi; lra |].
    apply (cube_upper c2); [exact D2 | apply cube_inside; exact h].
Qed.

(** ** Tightness: the bounds are reached at Q_1 and Q_2, and only there *)

Lemma M_at_Q_1 : Jinv (orthoglide L a e) (Q_1 L psi) = constant_offdiagonal (- t_1 kappa).
Proof.
  unfold Q_1, q_1. fold kappa. fold c1. replace (- L * c1) with (L * - c1) by ring.
  apply Jinv_diagonal_neg; [exact L_pos | apply corners].
Qed.

Lemma M_at_Q_2 : Jinv (orthoglide L a e) (Q_2 L psi) = constant_offdiagonal (t_2 kappa).
Proof. apply Jinv_diagonal_pos; [exact L_pos | apply corners]. Qed.

(** At Q_1 the smallest singular value is 1/psi, whatever psi ... *)
Theorem tight_at_Q_1 : stretches_by (1 / psi) (Jinv (orthoglide L a e) (Q_1 L psi)).
Proof.
  rewrite M_at_Q_1. fold kappa. replace kappa with (1 + 2 * - t_1 kappa) by (unfold t_1; lra).
  replace (- t_1 (1 + 2 * - t_1 kappa)) with (- t_1 kappa) by (unfold t_1; lra). apply stretches_along.
Qed.

(** ... at Q_2 it is 1/psi for psi >= 2, and the largest is psi for psi <= 2. *)
Theorem tight_at_Q_2_lower : 2 <= psi -> stretches_by (1 / psi) (Jinv (orthoglide L a e) (Q_2 L psi)).
Proof.
  intro h. rewrite M_at_Q_2. fold kappa.
  assert (k : kappa <= 1/2).
  { unfold kappa. apply Rmult_le_reg_r with psi; [lra |]. replace (1 / psi * psi) with 1 by (field; lra). lra. }
  assert (E : t_2 kappa = 1 - kappa) by (unfold t_2; destruct (Rle_dec kappa (1/2)); lra).
  rewrite E. replace kappa with (1 - (1 - kappa)) at 1 by ring. apply stretches_across.
Qed.

Theorem tight_at_Q_2_upper : psi <= 2 -> stretches_by psi (Jinv (orthoglide L a e) (Q_2 L psi)).
Proof.
  intro h. rewrite M_at_Q_2. destruct (kappa_range psi psi_gt_1) as [_ inv]. fold kappa in inv.
  assert (k : 1/2 <= kappa).
  { unfold kappa. apply Rmult_le_reg_r with psi; [lra |]. replace (1 / psi * psi) with 1 by (field; lra). lra. }
  assert (E : 1 + 2 * t_2 kappa = psi).
  { unfold t_2. destruct (Rle_dec kappa (1/2)) as [le | gt]; [| lra].
    assert (kappa = 1/2) as K by lra. rewrite K in *. lra. }
  rewrite <- E at 1. apply stretches_along.
Qed.

Theorem tight_only_at_Q1_Q2 : forall P, in_cube L psi P ->
  (stretches_by (1 / psi) (Jinv (orthoglide L a e) P) \/ stretches_by psi (Jinv (orthoglide L a e) P)
   <-> P = Q_1 L psi \/ P = Q_2 L psi).
Proof.
  intros P h. pose proof kappa_01 as k.
  destruct (t_facts _ k) as [T1 [T2 [E [F _]]]]. destruct corners as [D1 [D2 lt]].
  assert (S1 : vscale (/ L) P = diagonal (- c1) <-> P = Q_1 L psi).
  { rewrite (diagonal_scale L L_pos). unfold Q_1, q_1. fold kappa. fold c1.
    replace (L * - c1) with (- L * c1) by ring. reflexivity. }
  assert (S2 : vscale (/ L) P = diagonal c2 <-> P = Q_2 L psi) by (apply diagonal_scale; exact L_pos).
  split.
  - rewrite orthoglide_Jinv by (assumption || apply cube_reachable, h). rewrite <- S1, <- S2.
    intros [low | [v [nz up]]].
    + apply (cube_lower_reached kappa c1 c2 (t_1 kappa) (t_2 kappa)); auto; try lra.
      apply cube_scaled; exact h.
    + right. apply (cube_upper_reached c1 c2 (t_2 kappa)); auto.
      { split; [apply D1 | exact lt]. } { apply cube_scaled; exact h. }
      (* psi |v| = |M v| <= (1 + 2 t_2)|v| <= psi |v| *)
      exists v. split; [exact nz |]. apply Rle_antisym.
      { apply (cube_upper c2); [exact D2 | apply cube_inside; exact h]. }
      rewrite up. apply Rmult_le_compat_r; [apply norm2_nonneg |].
      apply pow_incr. pose proof sum_below_psi. lra.
  - intros [-> | ->].
    + left. apply tight_at_Q_1.
    + destruct (Rle_dec psi 2); [right; apply tight_at_Q_2_upper | left; apply tight_at_Q_2_lower]; lra.
Qed.
End Postulate.

(** ** What it means for the machine *)

(** For any platform velocity in the cube, the platform moves at most psi
    times faster, and at most psi times slower, than the joints. *)
Corollary velocity_transmission : forall psi P pdot rhodot, 1 < psi -> in_cube L psi P ->
  let m := orthoglide L a e in
  mulv (A_matrix m P) pdot = mulv (B_matrix m P) rhodot ->
  (1 / psi) ^ 2 * norm2 rhodot <= norm2 pdot <= psi ^ 2 * norm2 rhodot.
Proof.
  intros psi P pdot rhodot hpsi h m eq. destruct (q1q2_postulate psi hpsi P h) as [[s1 [s2 [s3 _]]] b].
  destruct (orthoglide_well_formed L a e L_pos) as [w1 [w2 w3]].
  apply Jinv_velocity in eq; [| apply eta_nonzero; assumption ..].
  subst rhodot. specialize (b pdot). fold m in b.
  assert (X : (1 / psi) ^ 2 * psi ^ 2 = 1) by (field; lra).
  assert (0 <= (1 / psi) ^ 2) by apply pow2_ge_0. assert (0 <= psi ^ 2) by apply pow2_ge_0.
  split.
  - replace (norm2 pdot) with ((1 / psi) ^ 2 * (psi ^ 2 * norm2 pdot))
      by (rewrite <- Rmult_assoc, X; ring).
    apply Rmult_le_compat_l; lra.
  - replace (norm2 pdot) with (psi ^ 2 * ((1 / psi) ^ 2 * norm2 pdot))
      by (rewrite <- Rmult_assoc, (Rmult_comm (psi ^ 2)), X; ring).
    apply Rmult_le_compat_l; lra.
Qed.

(** Every singular value xi_i of J^-1, hence every factor psi_i = 1/xi_i, is in [1/psi, psi]. *)
Corollary transmission_factors : forall psi P xi, 1 < psi -> in_cube L psi P ->
  singular_value xi (Jinv (orthoglide L a e) P) -> 1 / psi <= xi <= psi /\ 1 / psi <= 1 / xi <= psi.
Proof.
  intros psi P xi hpsi h sv. destruct (q1q2_postulate psi hpsi P h) as [_ b].
  destruct (kappa_range psi hpsi) as [k _].
  assert (xb : 1 / psi <= xi <= psi)
    by (apply (singular_value_within _ _ (Jinv (orthoglide L a e) P)); try lra; auto; intro v; apply b).
  split; [exact xb |]. destruct (kappa_range psi hpsi) as [_ inv].
  split.
  - apply Rmult_le_compat_l; [lra |]. apply Rinv_le_contravar; lra.
  - rewrite <- inv at 1. apply Rmult_le_compat_l; [lra |]. apply Rinv_le_contravar; lra.
Qed.
End Machine.
