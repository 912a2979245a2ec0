(** * The mean value theorem, without classical logic

    That of the library rests on the greatest value of a continuous function, and that on
    P or not P.  Here an interval is halved again and again, each time to one of half its
    length over which the mean slope is the same: slopes over its two halves have that
    mean, and so by continuity some interval between them has it.  Where all of these meet, it is
    the derivative. *)

From Coq Require Import Reals Ranalysis5 Lra Lia.
Local Open Scope R_scope.

Section Halving.
Variables (f f' : R -> R) (a b : R).
Hypothesis order : a < b.
Hypothesis derivable : forall c, a <= c <= b -> derivable_pt_lim f c (f' c).
Let k := (f b - f a) / (b - a).

(** An interval with this slope. *)
Definition has_slope (len x : R) : Prop := a <= x /\ x + len <= b /\ f (x + len) - f x = k * len.

Lemma narrower : forall len x, 0 < len -> has_slope len x -> {y | (x <= y /\ y + len / 2 <= x + len) /\ has_slope (len / 2) y}.
Proof.
  intros len x p [ha [hb e]]. set (h := fun y => f (y + len / 2) - f y - k * (len / 2)).
  assert (D : forall y, x <= y <= x + len / 2 -> continuity_pt h y).
  { intros y hy. apply derivable_continuous_pt. exists (f' (y + len / 2) * (1 + 0) - f' y - 0). repeat apply derivable_pt_lim_minus.
    - apply (derivable_pt_lim_comp (fun y => y + len / 2) f); [| apply derivable; lra].
      apply derivable_pt_lim_plus; [apply derivable_pt_lim_id | apply derivable_pt_lim_const].
    - apply derivable. lra.
    - apply derivable_pt_lim_const. }
  assert (S : h x + h (x + len / 2) = 0) by (unfold h; replace (x + len / 2 + len / 2) with (x + len) by lra; lra).
  assert (G : {y | x <= y <= x + len / 2 /\ h y = 0}).
  { destruct (total_order_T (h x) 0) as [[n | z] | n].
    - destruct (IVT_interv h x (x + len / 2) D) as [y hy]; [lra .. | exists y; exact hy].
    - exists x. lra.
    - destruct (IVT_interv (fun y => - h y) x (x + len / 2)) as [y [hy z]]; [intros y hy; apply continuity_pt_opp, D, hy | lra .. |].
      exists y. lra. }
  destruct G as [y [hy z]]. exists y. unfold has_slope, h in *. lra.
Qed.

Let width (n : nat) : R := (b - a) / 2 ^ n.
Lemma width_pos : forall n, 0 < width n.
Proof. intro n. apply Rdiv_lt_0_compat; [lra | apply pow_lt; lra]. Qed.

Fixpoint left_end (n : nat) : {x | has_slope (width n) x}.
Proof.
  destruct n as [| n].
  - exists a. unfold has_slope, width, k. cbn [pow]. replace (a + (b - a) / 1) with b by lra. split; [lra |]. split; [lra |]. field. lra.
  - destruct (narrower _ _ (width_pos n) (proj2_sig (left_end n))) as [y [_ h]]. exists y.
    replace (width (S n)) with (width n / 2); [exact h |]. unfold width. cbn [pow]. field. apply pow_nonzero. lra.
Defined.
Lemma nested : forall n j, proj1_sig (left_end n) <= proj1_sig (left_end (n + j)) /\
  proj1_sig (left_end (n + j)) + width (n + j) <= proj1_sig (left_end n) + width n.
Proof.
  intros n j. induction j as [| j IH]; [rewrite Nat.add_0_r; lra |]. rewrite Nat.add_succ_r. cbn [left_end].
  destruct (narrower _ _ _ _) as [y [h ?]]. cbn [proj1_sig].
  replace (width (S (n + j))) with (width (n + j) / 2); [lra |]. unfold width. cbn [pow]. field. apply pow_nonzero. lra.
Qed.

(** The derivative somewhere is the mean slope. *)
Theorem mean_value_theorem : exists c, f b - f a = f' c * (b - a) /\ a <= c <= b.
Proof.
  destruct (completeness (fun x => exists n, x = proj1_sig (left_end n))) as [c [up least]].
  { exists b. intros x [n ->]. destruct (proj2_sig (left_end n)) as [_ [h _]]. pose proof (width_pos n). lra. }
  { exists a, O. reflexivity. }
  assert (In : forall n, proj1_sig (left_end n) <= c <= proj1_sig (left_end n) + width n).
  { intro n. split; [apply up; exists n; reflexivity |]. apply least. intros x [m ->].
    pose proof (width_pos (n + m)). pose proof (width_pos m). pose proof (nested n m). pose proof (nested m n) as M. rewrite Nat.add_comm in M. lra. }
  assert (hc : a <= c <= b) by (pose proof (In O) as h; pose proof (proj2_sig (left_end O)) as [h1 [h2 _]]; lra).
  exists c. split; [| exact hc]. enough (E : k = f' c) by (rewrite <- E; unfold k; field; lra).
  apply cond_eq. intros eps e0. destruct (derivable c hc (eps / 2) ltac:(lra)) as [delta near].
  assert (N : forall h, Rabs h < delta -> Rabs (f (c + h) - f c - f' c * h) <= eps / 2 * Rabs h).
  { intros h hd. destruct (Req_dec h 0) as [-> | nz]; [rewrite Rplus_0_r; replace (f c - f c - f' c * 0) with 0 by ring; rewrite Rabs_R0; lra |].
    specialize (near h nz hd). replace (f (c + h) - f c - f' c * h) with (((f (c + h) - f c) / h - f' c) * h) by (field; exact nz).
    rewrite Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos | lra]. }
  destruct (pow_lt_1_zero (/ 2) ltac:(rewrite Rabs_pos_eq; lra) (delta / (b - a)) ltac:(apply Rdiv_lt_0_compat; [apply cond_pos | lra])) as [n small].
  specialize (small n (le_n n)). rewrite Rabs_pos_eq, pow_inv in small by (apply pow_le; lra).
  assert (W : width n < delta).
  { unfold width, Rdiv. apply Rmult_lt_compat_l with (r := b - a) in small; [| lra]. replace ((b - a) * (delta / (b - a))) with (pos delta) in small by (field; lra). exact small. }
  specialize (In n). pose proof (width_pos n) as p. destruct (proj2_sig (left_end n)) as [_ [_ e]]. set (x := proj1_sig (left_end n)) in *. set (w := width n) in *.
  pose proof (N (x + w - c)) as N1. pose proof (N (x - c)) as N2.
  replace (c + (x + w - c)) with (x + w) in N1 by ring. replace (c + (x - c)) with x in N2 by ring.
  rewrite (Rabs_pos_eq (x + w - c)) in N1 by lra. rewrite (Rabs_left1 (x - c)) in N2 by lra. specialize (N1 ltac:(lra)). specialize (N2 ltac:(lra)).
  assert (Rabs (k - f' c) * w <= eps / 2 * w); [| apply Rle_lt_trans with (eps / 2); [apply Rmult_le_reg_r with w; assumption | lra]].
  rewrite <- (Rabs_pos_eq w) at 1 by lra. rewrite <- Rabs_mult. revert N1 N2. unfold Rabs. repeat destruct (Rcase_abs _); lra.
Qed.
End Halving.

(** And so it is at a point that is no end. *)
Theorem mean_value_inside : forall f f' a b, a < b -> (forall c, a <= c <= b -> derivable_pt_lim f c (f' c)) ->
  exists c, f b - f a = f' c * (b - a) /\ a < c < b.
Proof.
  intros f f' a b order derivable.
  enough (H : exists p q, a < p /\ p < q /\ q < b /\ f q - f p = (f b - f a) / (b - a) * (q - p)).
  { destruct H as [p [q [h1 [h2 [h3 e]]]]]. destruct (mean_value_theorem f f' p q h2 ltac:(intros c hc; apply derivable; lra)) as [c [E hc]].
    exists c. split; [| lra]. rewrite e in E. assert (K : (f b - f a) / (b - a) = f' c) by (apply Rmult_eq_reg_r with (q - p); lra). rewrite <- K. field. lra. }
  set (k := (f b - f a) / (b - a)). set (l := (b - a) / 2). set (m := a + l).
  destruct (narrower f f' a b derivable (b - a) a) as [y [hy [y1 [y2 e]]]]; [lra | |].
  { split; [lra |]. split; [lra |]. replace (a + (b - a)) with b by ring. field. lra. }
  fold k l in e. assert (l0 : 0 < l) by (unfold l; lra).
  destruct (Req_dec y a) as [ya | ya]; [| destruct (Req_dec y m) as [ym | ym]].
  3: { exists y, (y + l). unfold m, l in *. repeat split; lra. }
  - assert (F : f m - f a = k * l) by (subst y; exact e).
    destruct (narrower f f' a b derivable l a) as [z [hz [z1 [z2 g]]]]; [lra | split; [lra |]; split; [unfold l; lra | exact F] |].
    fold k in g. destruct (Req_dec z a) as [za | za].
    + exists (a + l / 2), m. subst z. unfold m, l in *. repeat split; lra.
    + exists z, (z + l / 2). unfold m, l in *. repeat split; lra.
  - assert (T : f b - f a = k * (b - a)) by (unfold k; field; lra).
    assert (F : f m - f a = k * l) by (subst y; replace (m + l) with b in e by (unfold m, l; field); unfold l in *; lra).
    destruct (narrower f f' a b derivable l a) as [z [hz [z1 [z2 g]]]]; [lra | split; [lra |]; split; [unfold l; lra | exact F] |].
    fold k in g. destruct (Req_dec z a) as [za | za].
    + exists (a + l / 2), m. subst z. unfold m, l in *. repeat split; lra.
    + exists z, (z + l / 2). unfold m, l in *. repeat split; lra.
Qed.
