(** * The diagonal of the workspace, L = 1

    At the point (c,c,c) the off-diagonal entries of M are all equal to
    t = c / sqrt(1 - 2 c^2), so M = (1 - t) I + t 11^T has the singular values
    |1 + 2t| (direction (1,1,1)) and |1 - t| (twice).  Positions and entries
    determine each other, and grow together. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics.
Local Open Scope R_scope.

(** Position on the diagonal with entry [t], and entry at position [c]. *)
Definition position_of_entry (t : R) : R := t / sqrt (1 + 2 * t ^ 2).
Definition entry_of_position (c : R) : R := c / sqrt (1 - 2 * c ^ 2).

(** The relation between the two that the proofs use: no square root. *)
Definition on_diagonal (c t : R) : Prop := 0 < c /\ 0 < t /\ c ^ 2 * (1 + 2 * t ^ 2) = t ^ 2.

Lemma position_on_diagonal : forall t, 0 < t -> on_diagonal (position_of_entry t) t.
Proof.
  intros t h. assert (p : 0 < 1 + 2 * t ^ 2) by nra. pose proof (sqrt_lt_R0 _ p) as q.
  pose proof (sqrt_sqrt _ (Rlt_le _ _ p)) as e. unfold on_diagonal, position_of_entry.
  repeat split; [apply Rdiv_lt_0_compat; lra | exact h |].
  set (u := sqrt (1 + 2 * t ^ 2)) in *. rewrite <- e at 1. field. lra.
Qed.

Lemma entry_on_diagonal : forall c, 0 < c -> 2 * c ^ 2 < 1 -> on_diagonal c (entry_of_position c).
Proof.
  intros c h h2. assert (p : 0 < 1 - 2 * c ^ 2) by lra. pose proof (sqrt_lt_R0 _ p) as q.
  pose proof (sqrt_sqrt _ (Rlt_le _ _ p)) as e. unfold on_diagonal, entry_of_position.
  repeat split; [exact h | apply Rdiv_lt_0_compat; lra |].
  set (u := sqrt (1 - 2 * c ^ 2)) in *.
  replace (c ^ 2) with (c ^ 2 / (u * u) * (1 - 2 * c ^ 2)) at 1 by (rewrite <- e; field; lra).
  replace ((c / u) ^ 2) with (c ^ 2 / (u * u)) by (field; lra).
  transitivity (c ^ 2 / (u * u) * ((1 - 2 * c ^ 2) + 2 * (c ^ 2 / (u * u) * (1 - 2 * c ^ 2)))); [ring |].
  replace (c ^ 2 / (u * u) * (1 - 2 * c ^ 2)) with (c ^ 2) by (rewrite <- e; field; lra). ring.
Qed.

Section Relation.
Variables c t : R.
Hypothesis D : on_diagonal c t.

Lemma diagonal_pos : 0 < c /\ 0 < t.
Proof. destruct D as [? [? _]]; split; assumption. Qed.

Lemma diagonal_reach : 2 * c ^ 2 < 1.
Proof. destruct D as [? [? e]]. assert (0 < t ^ 2) by nra. nra. Qed.

(** c/t is the length s of every leg along its axis at (c,c,c). *)
Lemma diagonal_ratio : 0 < c / t /\ (c / t) ^ 2 = 1 - 2 * c ^ 2.
Proof.
  destruct D as [c0 [t0 e]]. split; [apply Rdiv_lt_0_compat; assumption |].
  apply Rmult_eq_reg_r with (t ^ 2); [| nra].
  replace ((c / t) ^ 2 * t ^ 2) with (c ^ 2) by (field; lra). lra.
Qed.

Lemma diagonal_s : forall d, d ^ 2 = c ^ 2 -> s_unit d d = c / t.
Proof.
  intros d e. destruct diagonal_ratio as [p q]. unfold s_unit.
  replace (1 - d ^ 2 - d ^ 2) with ((c / t) ^ 2) by lra. apply sqrt_pow2; lra.
Qed.

(** M at (c,c,c) and at (-c,-c,-c). *)
Definition constant_offdiagonal (m : R) : mat := Mat (Vec 1 m m) (Vec m 1 m) (Vec m m 1).

Lemma M_diagonal_pos : M (diagonal c) = constant_offdiagonal t.
Proof.
  destruct D as [c0 [t0 _]]. unfold M, diagonal, constant_offdiagonal.
  rewrite diagonal_s by reflexivity. repeat f_equal; field; lra.
Qed.

Lemma M_diagonal_neg : M (diagonal (- c)) = constant_offdiagonal (- t).
Proof.
  destruct D as [c0 [t0 _]]. unfold M, diagonal, constant_offdiagonal.
  rewrite diagonal_s by ring. repeat f_equal; field; lra.
Qed.
End Relation.

(** ** The singular values on the diagonal *)

Lemma ones_nonzero : Vec 1 1 1 <> vzero.
Proof. intro h. injection h. lra. Qed.
Lemma difference_nonzero : Vec 1 (-1) 0 <> vzero.
Proof. intro h. injection h. lra. Qed.

(** Along (1,1,1) the stretch is |1 + 2m|, across it |1 - m|. *)
Lemma diagonal_stretch_along : forall m,
  norm2 (mulv (constant_offdiagonal m) (Vec 1 1 1)) = (1 + 2 * m) ^ 2 * norm2 (Vec 1 1 1).
Proof. unfold constant_offdiagonal. vec_ring. Qed.
Lemma diagonal_stretch_across : forall m,
  norm2 (mulv (constant_offdiagonal m) (Vec 1 (-1) 0)) = (1 - m) ^ 2 * norm2 (Vec 1 (-1) 0).
Proof. unfold constant_offdiagonal. vec_ring. Qed.

Lemma stretches_along : forall m, stretches_by (1 + 2 * m) (constant_offdiagonal m).
Proof. intro m. exists (Vec 1 1 1). split; [exact ones_nonzero | apply diagonal_stretch_along]. Qed.
Lemma stretches_across : forall m, stretches_by (1 - m) (constant_offdiagonal m).
Proof. intro m. exists (Vec 1 (-1) 0). split; [exact difference_nonzero | apply diagonal_stretch_across]. Qed.

(** ** Monotony *)

Lemma diagonal_le : forall c t c' t', on_diagonal c t -> on_diagonal c' t' -> (c <= c' <-> t <= t').
Proof.
  intros c t c' t' D D'. pose proof (diagonal_reach _ _ D). pose proof (diagonal_reach _ _ D').
  destruct D as [c0 [t0 e]]. destruct D' as [c0' [t0' e']].
  assert (E : (c' ^ 2 - c ^ 2) * ((1 + 2 * t ^ 2) * (1 + 2 * t' ^ 2)) = t' ^ 2 - t ^ 2)
    by (replace (t' ^ 2) with (c' ^ 2 * (1 + 2 * t' ^ 2)) at 2 by lra;
        replace (t ^ 2) with (c ^ 2 * (1 + 2 * t ^ 2)) at 2 by lra; nra).
  assert (W : 0 < (1 + 2 * t ^ 2) * (1 + 2 * t' ^ 2)) by (apply Rmult_lt_0_compat; nra).
  split; intro h; apply Rsqr_incr_0_var; try lra; rewrite !Rsqr_pow2; apply Rminus_le.
  - assert (0 <= c' ^ 2 - c ^ 2) by nra.
    assert (0 <= (c' ^ 2 - c ^ 2) * ((1 + 2 * t ^ 2) * (1 + 2 * t' ^ 2))) by (apply Rmult_le_pos; lra). lra.
  - assert (0 <= t' ^ 2 - t ^ 2) by nra.
    assert (0 <= c' ^ 2 - c ^ 2) by (apply Rmult_le_reg_r with ((1 + 2 * t ^ 2) * (1 + 2 * t' ^ 2)); lra). lra.
Qed.

Lemma diagonal_lt : forall c t c' t', on_diagonal c t -> on_diagonal c' t' -> (c < c' <-> t < t').
Proof.
  intros c t c' t' D D'. pose proof (diagonal_le _ _ _ _ D' D) as [i j].
  split; intro h; apply Rnot_le_lt; intro n; [apply j in n | apply i in n]; lra.
Qed.

Lemma diagonal_entry_unique : forall c t t', on_diagonal c t -> on_diagonal c t' -> t = t'.
Proof.
  intros c t t' D D'. apply Rle_antisym;
    [apply (diagonal_le c t c t') | apply (diagonal_le c t' c t)]; auto; apply Rle_refl.
Qed.

Lemma diagonal_position_unique : forall c c' t, on_diagonal c t -> on_diagonal c' t -> c = c'.
Proof.
  intros c c' t D D'. apply Rle_antisym;
    [apply (diagonal_le c t c' t) | apply (diagonal_le c' t c t)]; auto; apply Rle_refl.
Qed.

(** ** Coordinates bounded by a diagonal position *)

Lemma s_unit_sym : forall u v, s_unit u v = s_unit v u.
Proof. intros. unfold s_unit. f_equal. ring. Qed.

Section Bounded.
Variables c t u v : R.
Hypothesis D : on_diagonal c t.
Hypothesis bu : - c <= u <= c.
Hypothesis bv : - c <= v <= c.

Lemma s_unit_square : s_unit u v ^ 2 = 1 - u ^ 2 - v ^ 2 /\ 1 - 2 * c ^ 2 <= 1 - u ^ 2 - v ^ 2.
Proof.
  pose proof (diagonal_reach _ _ D). assert (u ^ 2 <= c ^ 2) by nra. assert (v ^ 2 <= c ^ 2) by nra.
  unfold s_unit. rewrite <- Rsqr_pow2. rewrite Rsqr_sqrt; lra.
Qed.

(** The leg reaches at least as far along its axis as at (c,c,c). *)
Lemma s_unit_lower : c / t <= s_unit u v.
Proof.
  destruct s_unit_square as [e l]. destruct (diagonal_ratio _ _ D) as [p q].
  apply Rsqr_incr_0_var; [rewrite !Rsqr_pow2; lra | apply sqrt_pos].
Qed.

Lemma s_unit_pos : 0 < s_unit u v.
Proof. pose proof s_unit_lower. destruct (diagonal_ratio _ _ D). lra. Qed.

Lemma s_unit_upper : s_unit u v <= 1.
Proof.
  destruct s_unit_square as [e _]. apply Rsqr_incr_0_var; [rewrite !Rsqr_pow2 | lra].
  pose proof (pow2_ge_0 u). pose proof (pow2_ge_0 v). lra.
Qed.

(** Off-diagonal entries of M are at most t in absolute value ... *)
Lemma entry_bound : Rabs (u / s_unit u v) <= t.
Proof.
  pose proof s_unit_pos as p. pose proof s_unit_lower as l. destruct D as [c0 [t0 _]].
  unfold Rdiv. rewrite Rabs_mult, Rabs_inv, (Rabs_pos_eq (s_unit u v)) by lra.
  apply Rmult_le_reg_r with (s_unit u v); [exact p |].
  rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  assert (Rabs u <= c) by (apply Rabs_le; lra).
  assert (t * (c / t) <= t * s_unit u v) by (apply Rmult_le_compat_l; lra).
  replace (t * (c / t)) with c in H0 by (field; lra). lra.
Qed.

(** ... and less than t when the coordinate is not extreme. *)
Lemma entry_bound_strict : - c < u < c -> Rabs (u / s_unit u v) < t.
Proof.
  intro bu'. pose proof s_unit_pos as p. pose proof s_unit_lower as l. destruct D as [c0 [t0 _]].
  unfold Rdiv. rewrite Rabs_mult, Rabs_inv, (Rabs_pos_eq (s_unit u v)) by lra.
  apply Rmult_lt_reg_r with (s_unit u v); [exact p |].
  rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  assert (Rabs u < c) by (apply Rabs_def1; lra).
  assert (t * (c / t) <= t * s_unit u v) by (apply Rmult_le_compat_l; lra).
  replace (t * (c / t)) with c in H0 by (field; lra). lra.
Qed.

(** sigma = (c/t)/s, the leg's normalised inverse, for t <= 1. *)
Lemma sigma_range : t <= 1 -> 1/2 < c / t / s_unit u v <= 1.
Proof.
  intro t1. pose proof s_unit_pos as p. pose proof s_unit_lower as l. pose proof s_unit_upper as w.
  destruct (diagonal_ratio _ _ D) as [q e]. destruct D as [c0 [t0 d]].
  assert (c ^ 2 <= 1/3) by nra. assert (1/2 < c / t) by nra.
  split.
  - apply Rmult_lt_reg_r with (s_unit u v); [exact p |].
    replace (c / t / s_unit u v * s_unit u v) with (c / t) by (field; lra). lra.
  - apply Rmult_le_reg_r with (s_unit u v); [exact p |].
    replace (c / t / s_unit u v * s_unit u v) with (c / t) by (field; lra). lra.
Qed.

(** sigma = 1 only at the corners |u| = |v| = c. *)
Lemma sigma_strict : - c < u < c \/ - c < v < c -> c / t / s_unit u v < 1.
Proof.
  intro h. pose proof s_unit_pos as p. destruct s_unit_square as [e _].
  destruct (diagonal_ratio _ _ D) as [q f]. destruct D as [c0 [t0 _]].
  assert (c / t < s_unit u v).
  { apply Rsqr_incrst_0; [| lra | lra]. rewrite !Rsqr_pow2.
    assert (u ^ 2 <= c ^ 2) by nra. assert (v ^ 2 <= c ^ 2) by nra.
    destruct h as [? | ?]; [assert (u ^ 2 < c ^ 2) by nra | assert (v ^ 2 < c ^ 2) by nra]; lra. }
  apply Rmult_lt_reg_r with (s_unit u v); [exact p |].
  replace (c / t / s_unit u v * s_unit u v) with (c / t) by (field; lra). lra.
Qed.
End Bounded.
