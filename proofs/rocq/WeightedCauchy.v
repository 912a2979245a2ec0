(** * The algebraic core of the lower bound

    Divided by t, the form v^T M v - kappa |v|^2 of the Orthoglide is

      g |v|^2 + (sigma.v)(eta.v) - sum eta_i sigma_i v_i^2
        = sum D_i v_i^2 - ((eta - sigma).v)^2 / 4 + ((eta + sigma).v)^2 / 4

    with D_i = g - eta_i sigma_i.  Weights K_i with
    (eta_i - sigma_i)^2 <= K_i D_i and K_1 + K_2 + K_3 <= 4 make it
    nonnegative, by Cauchy's inequality.  The second half of the file finds
    such weights; it is where the position of the point in the cube matters. *)

From Coq Require Import Reals Lra Psatz.
Local Open Scope R_scope.

(** Cauchy's inequality with weights:
    (w_1 + w_2 + w_3)^2 <= (K_1 + K_2 + K_3)(w_1^2/K_1 + w_2^2/K_2 + w_3^2/K_3). *)
Lemma weighted_cauchy : forall K1 K2 K3 w1 w2 w3 D1 D2 D3,
  0 < K1 -> 0 < K2 -> 0 < K3 ->
  w1 ^ 2 <= K1 * D1 -> w2 ^ 2 <= K2 * D2 -> w3 ^ 2 <= K3 * D3 ->
  (w1 + w2 + w3) ^ 2 <= (K1 + K2 + K3) * (D1 + D2 + D3).
Proof.
  intros K1 K2 K3 w1 w2 w3 D1 D2 D3 k1 k2 k3 a1 a2 a3.
  assert (X : forall K w D, 0 < K -> w ^ 2 <= K * D -> exists x, w = K * x /\ K * x ^ 2 <= D).
  { intros K w D hK hw. exists (w / K). split; [field; lra |].
    apply Rmult_le_reg_l with K; [lra |].
    replace (K * (K * (w / K) ^ 2)) with (w ^ 2) by (field; lra). lra. }
  destruct (X _ _ _ k1 a1) as [x1 [-> b1]]. destruct (X _ _ _ k2 a2) as [x2 [-> b2]].
  destruct (X _ _ _ k3 a3) as [x3 [-> b3]].
  assert (E : (K1 * x1 + K2 * x2 + K3 * x3) ^ 2
    = (K1 + K2 + K3) * (K1 * x1 ^ 2 + K2 * x2 ^ 2 + K3 * x3 ^ 2)
      - (K1 * K2 * (x1 - x2) ^ 2 + K1 * K3 * (x1 - x3) ^ 2 + K2 * K3 * (x2 - x3) ^ 2)) by ring.
  assert (P : forall a b x, 0 < a -> 0 < b -> 0 <= a * b * x ^ 2)
    by (intros; apply Rmult_le_pos; [apply Rmult_le_pos; lra | apply pow2_ge_0]).
  pose proof (P K1 K2 (x1 - x2) k1 k2). pose proof (P K1 K3 (x1 - x3) k1 k3).
  pose proof (P K2 K3 (x2 - x3) k2 k3).
  assert ((K1 + K2 + K3) * (K1 * x1 ^ 2 + K2 * x2 ^ 2 + K3 * x3 ^ 2)
          <= (K1 + K2 + K3) * (D1 + D2 + D3)) by (apply Rmult_le_compat_l; lra).
  lra.
Qed.

(** [balanced g K e s]: weight [K] is enough for the coordinate with
    eta_i = [e] and sigma_i = [s]. *)
Definition balanced (g K e s : R) : Prop := (e - s) ^ 2 <= K * (g - e * s).

(** The form divided by t, as displayed above. *)
Definition scaled_form (g e1 e2 e3 s1 s2 s3 v1 v2 v3 : R) : R :=
  g * (v1 ^ 2 + v2 ^ 2 + v3 ^ 2) + (s1 * v1 + s2 * v2 + s3 * v3) * (e1 * v1 + e2 * v2 + e3 * v3)
  - (e1 * s1 * v1 ^ 2 + e2 * s2 * v2 ^ 2 + e3 * s3 * v3 ^ 2).

Section Form.
Variables g e1 e2 e3 s1 s2 s3 : R.

(** Four times the form, minus a square, in terms of the sum of the weights. *)
Lemma scaled_form_bound : forall K1 K2 K3 v1 v2 v3, 0 < K1 -> 0 < K2 -> 0 < K3 ->
  balanced g K1 e1 s1 -> balanced g K2 e2 s2 -> balanced g K3 e3 s3 ->
  (4 - (K1 + K2 + K3)) *
    ((g - e1 * s1) * v1 ^ 2 + (g - e2 * s2) * v2 ^ 2 + (g - e3 * s3) * v3 ^ 2)
  <= 4 * scaled_form g e1 e2 e3 s1 s2 s3 v1 v2 v3.
Proof.
  unfold balanced. intros K1 K2 K3 v1 v2 v3 k1 k2 k3 a1 a2 a3.
  assert (X : forall e s K v, (e - s) ^ 2 <= K * (g - e * s) ->
              ((e - s) * v) ^ 2 <= K * ((g - e * s) * v ^ 2)).
  { intros e s K v h. rewrite Rpow_mult_distr, <- Rmult_assoc.
    apply Rmult_le_compat_r; [apply pow2_ge_0 | exact h]. }
  pose proof (weighted_cauchy K1 K2 K3 _ _ _ _ _ _ k1 k2 k3
    (X _ _ _ v1 a1) (X _ _ _ v2 a2) (X _ _ _ v3 a3)) as C.
  pose proof (pow2_ge_0 ((e1 + s1) * v1 + (e2 + s2) * v2 + (e3 + s3) * v3)) as N.
  replace (4 * scaled_form g e1 e2 e3 s1 s2 s3 v1 v2 v3)
    with (4 * ((g - e1 * s1) * v1 ^ 2 + (g - e2 * s2) * v2 ^ 2 + (g - e3 * s3) * v3 ^ 2)
          - ((e1 - s1) * v1 + (e2 - s2) * v2 + (e3 - s3) * v3) ^ 2
          + ((e1 + s1) * v1 + (e2 + s2) * v2 + (e3 + s3) * v3) ^ 2) by (unfold scaled_form; ring).
  lra.
Qed.

Lemma scaled_form_nonneg : forall K1 K2 K3 v1 v2 v3, 0 < K1 -> 0 < K2 -> 0 < K3 ->
  K1 + K2 + K3 <= 4 ->
  balanced g K1 e1 s1 -> balanced g K2 e2 s2 -> balanced g K3 e3 s3 ->
  0 <= scaled_form g e1 e2 e3 s1 s2 s3 v1 v2 v3.
Proof.
  intros K1 K2 K3 v1 v2 v3 k1 k2 k3 sum a1 a2 a3.
  pose proof (scaled_form_bound K1 K2 K3 v1 v2 v3 k1 k2 k3 a1 a2 a3) as B. unfold balanced in *.
  assert (X : forall K e s v, 0 < K -> (e - s) ^ 2 <= K * (g - e * s) -> 0 <= (g - e * s) * v ^ 2).
  { intros K e s v hK h. apply Rmult_le_pos; [| apply pow2_ge_0].
    pose proof (pow2_ge_0 (e - s)). apply Rmult_le_reg_l with K; lra. }
  pose proof (X K1 e1 s1 v1 k1 a1). pose proof (X K2 e2 s2 v2 k2 a2). pose proof (X K3 e3 s3 v3 k3 a3).
  assert (0 <= (4 - (K1 + K2 + K3)) *
    ((g - e1 * s1) * v1 ^ 2 + (g - e2 * s2) * v2 ^ 2 + (g - e3 * s3) * v3 ^ 2))
    by (apply Rmult_le_pos; lra).
  lra.
Qed.

(** With room in the sum of the weights the form is positive definite. *)
Lemma scaled_form_pos : forall K1 K2 K3 v1 v2 v3, 0 < K1 -> 0 < K2 -> 0 < K3 ->
  K1 + K2 + K3 < 4 ->
  balanced g K1 e1 s1 -> balanced g K2 e2 s2 -> balanced g K3 e3 s3 ->
  0 < g - e1 * s1 -> 0 < g - e2 * s2 -> 0 < g - e3 * s3 ->
  v1 <> 0 \/ v2 <> 0 \/ v3 <> 0 ->
  0 < scaled_form g e1 e2 e3 s1 s2 s3 v1 v2 v3.
Proof.
  intros K1 K2 K3 v1 v2 v3 k1 k2 k3 sum a1 a2 a3 d1 d2 d3 nz.
  pose proof (scaled_form_bound K1 K2 K3 v1 v2 v3 k1 k2 k3 a1 a2 a3) as B.
  assert (X : forall d v, 0 < d -> 0 <= d * v ^ 2)
    by (intros; apply Rmult_le_pos; [lra | apply pow2_ge_0]).
  assert (Y : forall d v, 0 < d -> v <> 0 -> 0 < d * v ^ 2)
    by (intros; apply Rmult_lt_0_compat; [lra | rewrite <- Rsqr_pow2; apply Rsqr_pos_lt; assumption]).
  pose proof (X _ v1 d1). pose proof (X _ v2 d2). pose proof (X _ v3 d3).
  assert (0 < (g - e1 * s1) * v1 ^ 2 + (g - e2 * s2) * v2 ^ 2 + (g - e3 * s3) * v3 ^ 2).
  { destruct nz as [n | [n | n]];
      [pose proof (Y _ v1 d1 n) | pose proof (Y _ v2 d2 n) | pose proof (Y _ v3 d3 n)]; lra. }
  assert (0 < (4 - (K1 + K2 + K3)) *
    ((g - e1 * s1) * v1 ^ 2 + (g - e2 * s2) * v2 ^ 2 + (g - e3 * s3) * v3 ^ 2))
    by (apply Rmult_lt_0_compat; lra).
  lra.
Qed.
End Form.

(** A coordinate balanced with room to spare accepts a smaller weight. *)
Lemma smaller_weight : forall g K e s, 0 < K -> (e - s) ^ 2 < K * (g - e * s) ->
  exists K', 0 < K' < K /\ balanced g K' e s /\ 0 < g - e * s.
Proof.
  intros g K e s hK h. pose proof (pow2_ge_0 (e - s)).
  assert (d : 0 < g - e * s) by (apply Rmult_lt_reg_l with K; lra).
  set (a := (e - s) ^ 2) in *. set (D := g - e * s) in *.
  assert (E : a / D * D = a) by (field; lra).
  assert (0 <= a / D < K).
  { split; [apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat, d] |].
    apply Rmult_lt_reg_r with D; lra. }
  exists ((a / D + K) / 2). unfold balanced. fold a. fold D. repeat split; nra.
Qed.

(** ** The weights

    Region 1 of the cube, |P|_inf <= |q_1|: eta in [-1,1], sigma in [0,1],
    g >= 2, all three weights 4/3; tight at (eta, sigma) = (-1,1) only. *)
Lemma balanced_inner : forall g e s,
  2 <= g -> -1 <= e <= 1 -> 0 <= s <= 1 -> balanced g (4/3) e s.
Proof. unfold balanced. intros g e s hg [? ?] [? ?]. nra. Qed.

Lemma balanced_inner_strict : forall g e s,
  2 <= g -> -1 < e <= 1 -> 0 <= s <= 1 -> (e - s) ^ 2 < 4/3 * (g - e * s).
Proof. intros g e s hg [? ?] [? ?]. nra. Qed.

(** Region 2, where the largest coordinate exceeds |q_1|: that coordinate
    (eta = 1, sigma > 1/2) has weight 1/2 ... *)
Lemma balanced_max : forall g s, 1 <= g -> 1/2 <= s <= 1 -> balanced g (1/2) 1 s.
Proof. unfold balanced. intros g s ? [? ?]. nra. Qed.

Lemma balanced_max_strict : forall g s, 1 <= g -> 1/2 < s <= 1 -> 1 < g \/ s < 1 ->
  (1 - s) ^ 2 < 1/2 * (g - 1 * s).
Proof. intros g s ? [? ?] [? | ?]; nra. Qed.

(** ... and the two others (eta >= -p with p^2 <= g/2) have weight 7/4. *)
Lemma balanced_outer : forall g p e s,
  1 <= g -> 0 <= p <= 1 -> p ^ 2 <= g / 2 -> - p <= e <= 1 -> 0 <= s <= 1 ->
  balanced g (7/4) e s.
Proof.
  unfold balanced. intros g p e s hg [? ?] pp [? ?] [? ?]. assert (s ^ 2 <= s) by nra.
  (* convex in e and in s: e^2 is below its chord on [0,1], or at most p^2 *)
  destruct (Rle_dec 0 e).
  - assert (e ^ 2 <= e) by nra. assert (0 <= (1 - e) * (1 - s)) by nra. nra.
  - assert (e ^ 2 <= p ^ 2) by nra. assert (- (e * s) <= p * s) by nra. nra.
Qed.

Lemma balanced_outer_strict : forall g p e s,
  1 <= g -> 0 <= p <= 1 -> p ^ 2 <= g / 2 -> - p <= e <= 1 -> 0 <= s <= 1 ->
  1 < g \/ e < 1 \/ s < 1 -> (e - s) ^ 2 < 7/4 * (g - e * s).
Proof.
  intros g p e s hg [? ?] pp [? ?] [? ?] room. assert (s ^ 2 <= s) by nra.
  destruct (Rle_dec 0 e).
  - assert (e ^ 2 <= e) by nra. assert (0 <= (1 - e) * (1 - s)) by nra.
    destruct room as [? | [? | ?]]; nra.
  - assert (e ^ 2 <= p ^ 2) by nra. assert (- (e * s) <= p * s) by nra.
    assert (p * s <= p) by nra. assert (p <= 3/4 * g) by nra. nra.
Qed.
