(** * Elbows: the unit vector u with |(a, b) - u|^2 = t that has (a, b) on its left

    Where a leg on an arm of length 1 has its joint, and how that moves. *)

From Coq Require Import Reals Lra.
From Orthocert Require Import Velocity.
Local Open Scope R_scope.

Definition elbow_radicand (a b t : R) : R := 4 * (a ^ 2 + b ^ 2) - (a ^ 2 + b ^ 2 + 1 - t) ^ 2.
Definition elbow (a b t : R) : R * R :=
  let n := a ^ 2 + b ^ 2 in let q := n + 1 - t in let h := sqrt (elbow_radicand a b t) in
  ((q * a + h * b) / (2 * n), (q * b - h * a) / (2 * n)).

Lemma elbow_is : forall a b t, 0 < elbow_radicand a b t -> let (c, s) := elbow a b t in
  c ^ 2 + s ^ 2 = 1 /\ (a - c) ^ 2 + (b - s) ^ 2 = t /\ 2 * (b * c - a * s) = sqrt (elbow_radicand a b t) /\ 0 < a ^ 2 + b ^ 2.
Proof.
  intros a b t r. unfold elbow. set (n := a ^ 2 + b ^ 2). set (q := n + 1 - t). pose proof (sqrt_sqrt _ (Rlt_le _ _ r)) as e.
  set (h := sqrt (elbow_radicand a b t)) in *. assert (E : h ^ 2 = 4 * n - q ^ 2) by (replace (h ^ 2) with (h * h) by ring; rewrite e; reflexivity).
  assert (n0 : 0 < n) by (unfold elbow_radicand in r; fold n in r; pose proof (pow2_ge_0 (n + 1 - t)); lra).
  assert (N : n = a ^ 2 + b ^ 2) by reflexivity. assert (Q : q = n + 1 - t) by reflexivity. clearbody n q h. clear e r.
  assert (U : ((q * a + h * b) / (2 * n)) ^ 2 + ((q * b - h * a) / (2 * n)) ^ 2 = 1).
  { replace (((q * a + h * b) / (2 * n)) ^ 2 + ((q * b - h * a) / (2 * n)) ^ 2) with ((q ^ 2 + h ^ 2) * (a ^ 2 + b ^ 2) / (4 * n ^ 2)) by (field; lra).
    rewrite E, <- N. field. lra. }
  split; [exact U |]. split; [| split; [| exact n0]].
  - set (c := (q * a + h * b) / (2 * n)) in *. set (s := (q * b - h * a) / (2 * n)) in *.
    assert (W : a * c + b * s = q / 2) by (unfold c, s; replace (a * ((q * a + h * b) / (2 * n)) + b * ((q * b - h * a) / (2 * n))) with (q * (a ^ 2 + b ^ 2) / (2 * n)) by (field; lra); rewrite <- N; field; lra).
    replace ((a - c) ^ 2 + (b - s) ^ 2) with (a ^ 2 + b ^ 2 - 2 * (a * c + b * s) + (c ^ 2 + s ^ 2)) by ring. rewrite W, U, <- N, Q. field.
  - replace (2 * (b * ((q * a + h * b) / (2 * n)) - a * ((q * b - h * a) / (2 * n)))) with (h * (a ^ 2 + b ^ 2) / n) by (field; lra). rewrite <- N. field. lra.
Qed.

(** What the difference of both equations says. *)
Lemma elbow_moves : forall a b t a' b' t', 0 < elbow_radicand a b t -> 0 < elbow_radicand a' b' t' ->
  let (c, s) := elbow a b t in let (c', s') := elbow a' b' t' in
  let x := (a' + a) / 2 in let y := (b' + b) / 2 in let p := (c' + c) / 2 in let q := (s' + s) / 2 in
  let along := (x - p) * (a' - a) + (y - q) * (b' - b) - (t' - t) / 2 in
  (y * p - x * q) * (c' - c) = - q * along /\ (y * p - x * q) * (s' - s) = p * along.
Proof.
  intros a b t a' b' t' r r'. pose proof (elbow_is a b t r) as e. pose proof (elbow_is a' b' t' r') as e'.
  destruct (elbow a b t) as [c s], (elbow a' b' t') as [c' s']. destruct e as [e1 [e2 _]], e' as [e1' [e2' _]]. cbv zeta.
  set (p := (c' + c) / 2). set (q := (s' + s) / 2). set (x := (a' + a) / 2). set (y := (b' + b) / 2).
  assert (U : p * (c' - c) + q * (s' - s) = 0) by (unfold p, q; lra).
  assert (W : x * (c' - c) + y * (s' - s) = (x - p) * (a' - a) + (y - q) * (b' - b) - (t' - t) / 2) by (unfold x, y, p, q; lra).
  rewrite <- W. clearbody p q x y. split.
  - replace ((y * p - x * q) * (c' - c)) with (y * (p * (c' - c) + q * (s' - s)) - q * (x * (c' - c) + y * (s' - s))) by ring. rewrite U. ring.
  - replace ((y * p - x * q) * (s' - s)) with (p * (x * (c' - c) + y * (s' - s)) - x * (p * (c' - c) + q * (s' - s))) by ring. rewrite U. ring.
Qed.

(** The rates of the quotients that are the cosine and the sine, in real numbers. *)
Lemma rates : forall c s g h A B a b g', h <> 0 -> c ^ 2 + s ^ 2 = 1 -> c * A + s * B = g -> c * B - s * A = h ->
  let h' := (A * a + B * b - g * g') / h in let rate := (g' - c * a - s * b) / h in
  g' * A + g * a + (h' * B + h * b) - 2 * (A * a + B * b) * c = (g ^ 2 + h ^ 2) * (- s * rate) /\
  g' * B + g * b - (h' * A + h * a) - 2 * (A * a + B * b) * s = (g ^ 2 + h ^ 2) * (c * rate).
Proof.
  intros c s g h A B a b g' nz u hg hh. cbv zeta. assert (EA : A = c * g - s * h).
  { rewrite <- hg, <- hh. replace (c * (c * A + s * B) - s * (c * B - s * A)) with (A * (c ^ 2 + s ^ 2)) by ring. rewrite u. ring. }
  assert (EB : B = s * g + c * h).
  { rewrite <- hg, <- hh. replace (s * (c * A + s * B) + c * (c * B - s * A)) with (B * (c ^ 2 + s ^ 2)) by ring. rewrite u. ring. }
  clear hg hh. subst A B. assert (es : s ^ 2 = 1 - c ^ 2) by lra.
  assert (e3 : s ^ 3 = s * (1 - c ^ 2)) by (replace (s ^ 3) with (s * s ^ 2) by ring; rewrite es; reflexivity).
  split; (apply Rmult_eq_reg_r with h; [| exact nz]); field_simplify; try exact nz; rewrite ?e3, ?es; field_simplify; try exact nz; ring.
Qed.

Lemma elbow_rates : forall A B T x a b t, derivable_pt_lim A x a -> derivable_pt_lim B x b -> derivable_pt_lim T x t ->
  0 < elbow_radicand (A x) (B x) (T x) ->
  let (c, s) := elbow (A x) (B x) (T x) in
  let rate := (2 * ((A x - c) * a + (B x - s) * b) - t) / (2 * (B x * c - A x * s)) in
  0 < 2 * (B x * c - A x * s) /\
  derivable_pt_lim (fun u => fst (elbow (A u) (B u) (T u))) x (- s * rate) /\
  derivable_pt_lim (fun u => snd (elbow (A u) (B u) (T u))) x (c * rate).
Proof.
  intros A B T x a b t ha hb ht r. pose proof (elbow_is _ _ _ r) as e. destruct (elbow (A x) (B x) (T x)) as [c s] eqn:E. cbv zeta. destruct e as [U [W [H n0]]].
  pose proof (sqrt_lt_R0 _ r) as h0. rewrite H. split; [exact h0 |]. rewrite <- H in h0.
  set (n' := 2 * A x * a + 2 * B x * b).
  assert (hn : derivable_pt_lim (fun u => A u ^ 2 + B u ^ 2) x n') by (apply derivable_add; apply derivable_square; assumption).
  assert (hq : derivable_pt_lim (fun u => A u ^ 2 + B u ^ 2 + 1 - T u) x (n' - t)).
  { eapply derivable_eq; [exact (derivable_add _ _ _ _ _ hn (derivable_add _ _ _ _ _ (derivable_const 1 x) (derivable_scal (-1) _ _ _ ht))) | intro u; cbn beta; ring | ring]. }
  set (q := fun u => A u ^ 2 + B u ^ 2 + 1 - T u) in *. set (g := q x / 2). set (g' := (n' - t) / 2).
  assert (G : c * A x + s * B x = g) by (unfold g, q; lra).
  set (h := c * B x - s * A x). assert (Hh : sqrt (elbow_radicand (A x) (B x) (T x)) = 2 * h) by (unfold h; lra). assert (h1 : 0 < h) by (unfold h; lra).
  pose proof (rates c s g h (A x) (B x) a b g' (Rgt_not_eq _ _ h1) U G eq_refl) as K. cbv zeta in K. destruct K as [Kc Ks].
  assert (N : A x ^ 2 + B x ^ 2 = g ^ 2 + h ^ 2).
  { unfold h. rewrite <- G. replace ((c * A x + s * B x) ^ 2 + (c * B x - s * A x) ^ 2) with ((c ^ 2 + s ^ 2) * (A x ^ 2 + B x ^ 2)) by ring. rewrite U. ring. }
  set (h' := (A x * a + B x * b - g * g') / h) in *.
  assert (hr : derivable_pt_lim (fun u => sqrt (elbow_radicand (A u) (B u) (T u))) x (2 * h')).
  { assert (R : derivable_pt_lim (fun u => elbow_radicand (A u) (B u) (T u)) x (4 * n' + -1 * (2 * q x * (n' - t))))
      by (eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_scal 4 _ _ _ hn) (derivable_scal (-1) _ _ _ (derivable_square _ _ _ hq))) | intro u; unfold elbow_radicand, q; ring | reflexivity]).
    eapply derivable_eq; [exact (derivable_pt_lim_comp _ sqrt x _ _ R (derivable_pt_lim_sqrt _ r)) | reflexivity |].
    rewrite Hh. unfold h', g', g, n'. field. lra. }
  set (k := fun u => sqrt (elbow_radicand (A u) (B u) (T u))) in *.
  assert (Q0 : q x = 2 * g) by (unfold g; field). assert (K0 : k x = 2 * h) by exact Hh.
  assert (d0 : 2 * (A x ^ 2 + B x ^ 2) <> 0) by lra.
  pose proof (derivable_scal 2 _ _ _ hn) as hd.
  pose proof (derivable_add _ _ x _ _ (derivable_pt_lim_mult _ _ x _ _ hq ha) (derivable_pt_lim_mult _ _ x _ _ hr hb)) as hc.
  pose proof (derivable_add _ _ x _ _ (derivable_pt_lim_mult _ _ x _ _ hq hb) (derivable_scal (-1) _ x _ (derivable_pt_lim_mult _ _ x _ _ hr ha))) as hs.
  pose proof (derivable_pt_lim_div _ _ x _ _ hc hd d0) as dc. pose proof (derivable_pt_lim_div _ _ x _ _ hs hd d0) as ds.
  assert (Z : (2 * ((A x - c) * a + (B x - s) * b) - t) / (2 * h) = (g' - c * a - s * b) / h) by (unfold g', n'; field; lra).
  change (sqrt (elbow_radicand (A x) (B x) (T x))) with (k x). rewrite K0, Z. set (z := (g' - c * a - s * b) / h) in *. unfold elbow in E. fold (q x) (k x) in E. injection E as Ec Es.
  assert (C : q x * A x + k x * B x = c * (2 * (A x ^ 2 + B x ^ 2))) by (rewrite <- Ec; field; lra).
  assert (S : q x * B x - k x * A x = s * (2 * (A x ^ 2 + B x ^ 2))) by (rewrite <- Es; field; lra).
  assert (n'E : n' = 2 * (A x * a + B x * b)) by (unfold n'; ring). assert (Q' : n' - t = 2 * g') by (unfold g'; field). split.
  - eapply derivable_eq; [exact dc | reflexivity |].
    change (- s * z = (((n' - t) * A x + q x * a + (2 * h' * B x + k x * b)) * (2 * (A x ^ 2 + B x ^ 2)) - 2 * n' * (q x * A x + k x * B x)) / Rsqr (2 * (A x ^ 2 + B x ^ 2))).
    rewrite C, Q', Q0, K0, n'E. rewrite <- N in Kc.
    replace (2 * g' * A x + 2 * g * a + (2 * h' * B x + 2 * h * b)) with (2 * ((A x ^ 2 + B x ^ 2) * (- s * z) + 2 * (A x * a + B x * b) * c)) by (rewrite <- Kc; ring).
    unfold Rsqr. field. lra.
  - eapply derivable_eq; [exact ds | intro u; unfold elbow, div_fct, mult_fct; cbn [snd]; f_equal; unfold q, k; ring |].
    change (c * z = (((n' - t) * B x + q x * b + -1 * (2 * h' * A x + k x * a)) * (2 * (A x ^ 2 + B x ^ 2)) - 2 * n' * (q x * B x + -1 * (k x * A x))) / Rsqr (2 * (A x ^ 2 + B x ^ 2))).
    replace (q x * B x + -1 * (k x * A x)) with (s * (2 * (A x ^ 2 + B x ^ 2))) by lra. rewrite Q', Q0, K0, n'E. rewrite <- N in Ks.
    replace (2 * g' * B x + 2 * g * b + -1 * (2 * h' * A x + 2 * h * a)) with (2 * ((A x ^ 2 + B x ^ 2) * (c * z) + 2 * (A x * a + B x * b) * s)) by (rewrite <- Ks; ring).
    unfold Rsqr. field. lra.
Qed.
