(** * The paper's closed design: the Orthoglide on the cube of a given side

    By the postulate, with nothing to be computed but signs. *)

From Coq Require Import ZArith Reals Lra Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal Scaling Postulate Design Claim.
From Orthocert.kernel Require Import Witness.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.

(** ** What is claimed *)

(** The leg length that gives the cube [q_1, q_2]^3 this side. *)
Definition is_closed (side psi L : R) : Prop := 0 < L /\ q_2 L psi - q_1 L psi = side.

(** The machine of steps 1 to 3, with its base where the least joint coordinate
    on the cube is 0: no singularity, psi_min <= psi_i <= psi_max, and rho_i >= 0. *)
Definition closed_design_holds (side psi_min psi_max : number) (offset : R) : Prop :=
  (exists L, is_closed (value side) (value psi_max) L) /\
  forall L P, is_closed (value side) (value psi_max) L -> in_cube L (value psi_max) P ->
    let m := orthoglide L (q_1 L (value psi_max) - offset - L) offset in
    regular m P /\ (forall v, (1 / value psi_max) ^ 2 * norm2 v <= norm2 (mulv (Jinv m P) v)
      <= (1 / value psi_min) ^ 2 * norm2 v) /\
    0 <= rho (leg1 m) P /\ 0 <= rho (leg2 m) P /\ 0 <= rho (leg3 m) P.

Section Precision.
Variable bits : positive.

Definition check_closed (side psi_min psi_max : number) : bool :=
  certainly bits true side && certainly bits true (Minus psi_max (1 // 1)) &&
  certainly bits true psi_min && certainly bits false (Minus (Over (1 // 1) psi_max) psi_min).

Theorem check_closed_sound : forall side psi_min psi_max, check_closed side psi_min psi_max = true ->
  forall offset, closed_design_holds side psi_min psi_max offset.
Proof.
  intros side a b h offset. apply andb_true_iff in h as [h h4]. apply andb_true_iff in h as [h h3].
  apply andb_true_iff in h as [h1 h2]. apply positive_sound in h1, h2, h3. apply nonneg_sound in h4. cbn [value] in h2, h4.
  unfold closed_design_holds, is_closed. set (p := value b) in *. assert (p1 : 1 < p) by lra.
  assert (q : / p >= value a) by (unfold Rdiv in h4; rewrite Rinv_1 in h4; lra). clear h2 h4.
  pose proof (kappa_01 p p1) as k. destruct (t_facts _ k) as [T1 [T2 _]].
  assert (c1 : 0 < position_of_entry (t_1 (1 / p))) by (apply (position_on_diagonal (t_1 (1 / p))); lra).
  assert (c2 : 0 < position_of_entry (t_2 (1 / p))) by (apply (position_on_diagonal (t_2 (1 / p))); lra).
  split.
  - set (u := position_of_entry (t_1 (1 / p))) in *. set (v := position_of_entry (t_2 (1 / p))) in *.
    exists (value side / (v + u)). split; [apply Rdiv_lt_0_compat; lra |].
    unfold q_1, q_2. fold u v. field. lra.
  - intros L P [hL _] hP. cbv zeta.
    destruct (q1q2_postulate L (q_1 L p - offset - L) offset hL p p1 P hP) as [g t].
    split; [exact g |]. split; [| destruct (joint_range L offset p hL p1 P hP); tauto].
    intro v. destruct (t v) as [t1 t2]. split; [exact t1 |].
    apply Rle_trans with (1 := t2). apply Rmult_le_compat_r; [apply norm2_nonneg |].
    apply pow_incr. split; [lra |]. unfold Rdiv. rewrite Rmult_1_l.
    rewrite <- (Rinv_inv p). apply Rinv_le_contravar; lra.
Qed.
End Precision.
End Named.
