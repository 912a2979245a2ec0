(** * Directions of one scale

    Formulas are made of the unit vector along a direction, which s > 0 times the
    direction has too.  [degrees] finds of each entry of a tape the power of s by
    which it changes, if that is one; those of power 0 are the same for a machine
    whose direction has a component at an end of its range, if 0 is among the
    values of the others: with the s that puts it there, s <= 1. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Formula Arithmetic.
Import ListNotations.
Local Open Scope R_scope.

Definition is_in (J : list nat) (j : nat) : bool := existsb (Nat.eqb j) J.

(** ** Powers of the scale of the parameters [J] *)

Definition degree_op (J : list nat) (o : op (option Z)) : option Z :=
  match o with
  | Coord _ | Integer _ => Some 0%Z
  | Param j => Some (if is_in J j then 1 else 0)%Z
  | Add (Some a) (Some b) | Sub (Some a) (Some b) => if (a =? b)%Z then Some a else None
  | Neg a => a
  | Mul (Some a) (Some b) => Some (a + b)%Z
  | Div (Some a) (Some b) => Some (a - b)%Z
  | Sqr (Some a) => Some (a + a)%Z
  | Sqrt (Some a) => if Z.even a then Some (a / 2)%Z else None
  | Elbow _ (Some a) (Some b) (Some t) => if ((a =? 0) && (b =? 0) && (t =? 0))%Z then Some 0%Z else None
  | _ => None
  end.
Definition degrees (J : list nat) (tape : list (op nat)) : list (option Z) := run (option Z) None (degree_op J) tape [].

Section Machines.
Variables (x theta scaled : list R) (s : R) (J : list nat).
Hypothesis s_positive : 0 < s.
Hypothesis is_scaled : forall j, nth j scaled 0 = (if is_in J j then s else 1) * nth j theta 0.

(** Of a formula that is defined of the scaled machine. *)
Definition has_degree (d : option Z) (f : formula) : Prop :=
  match d with Some k => defined x scaled f -> defined x theta f /\ value x scaled f = powerRZ s k * value x theta f | None => True end.

Lemma power_positive : forall k, 0 < powerRZ s k.
Proof. intro k. apply powerRZ_lt, s_positive. Qed.
Lemma power_sum : forall a b, powerRZ s (a + b) = powerRZ s a * powerRZ s b.
Proof. intros. apply powerRZ_add. lra. Qed.
Lemma power_minus : forall a b, powerRZ s (a - b) = powerRZ s a / powerRZ s b.
Proof. intros a b. unfold Z.sub. rewrite power_sum, powerRZ_neg'. unfold Rdiv. reflexivity. Qed.

Lemma degree_op_sound : forall (o : op nat) f g, (forall i, has_degree (f i) (g i)) -> has_degree (degree_op J (map_op f o)) (F (map_op g o)).
Proof.
  intros o f g H.
  destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [map_op degree_op].
  - intros _. cbn [map_op value defined real_op defined_op all_op powerRZ]. split; [tauto | ring].
  - intros _. cbn [map_op value defined real_op defined_op all_op]. split; [tauto |]. rewrite is_scaled. destruct (is_in J j); [rewrite powerRZ_1 | cbn [powerRZ]]; ring.
  - intros _. cbn [map_op value defined real_op defined_op all_op powerRZ]. split; [tauto | ring].
  - pose proof (H a) as Ha. pose proof (H b) as Hb. destruct (f a) as [p |], (f b) as [q |]; try exact I. destruct (Z.eqb_spec p q) as [<- |]; [| exact I].
    intros [_ [da db]]. cbn [has_degree all_op map_op] in *. destruct (Ha da) as [ea va]. destruct (Hb db) as [eb vb].
    split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va, vb. ring.
  - pose proof (H a) as Ha. pose proof (H b) as Hb. destruct (f a) as [p |], (f b) as [q |]; try exact I. destruct (Z.eqb_spec p q) as [<- |]; [| exact I].
    intros [_ [da db]]. cbn [has_degree all_op map_op] in *. destruct (Ha da) as [ea va]. destruct (Hb db) as [eb vb].
    split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va, vb. ring.
  - pose proof (H a) as Ha. destruct (f a) as [p |]; [| exact I].
    intros [_ da]. cbn [has_degree all_op map_op] in *. destruct (Ha da) as [ea va]. split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va. ring.
  - pose proof (H a) as Ha. pose proof (H b) as Hb. destruct (f a) as [p |], (f b) as [q |]; try exact I.
    intros [_ [da db]]. cbn [has_degree all_op map_op] in *. destruct (Ha da) as [ea va]. destruct (Hb db) as [eb vb].
    split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va, vb, power_sum. ring.
  - pose proof (H a) as Ha. pose proof (H b) as Hb. destruct (f a) as [p |], (f b) as [q |]; try exact I.
    intros [n [da db]]. cbn [has_degree all_op map_op defined_op] in *. destruct (Ha da) as [ea va]. destruct (Hb db) as [eb vb]. pose proof (power_positive q) as q0.
    rewrite vb in n. assert (n' : value x theta (g b) <> 0) by (intro z; apply n; rewrite z; ring).
    split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va, vb, power_minus. field. split; [exact n' | lra].
  - pose proof (H a) as Ha. destruct (f a) as [p |]; [| exact I].
    intros [_ da]. cbn [has_degree all_op map_op] in *. destruct (Ha da) as [ea va]. split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va, power_sum. ring.
  - pose proof (H a) as Ha. destruct (f a) as [p |]; [| exact I]. destruct (Z.even p) eqn:e; [| exact I].
    intros [r da]. cbn [has_degree all_op map_op defined_op] in *. destruct (Ha da) as [ea va]. apply Z.even_spec in e as [q ->]. replace (2 * q / 2)%Z with q by (rewrite Z.mul_comm, Z.div_mul; lia).
    replace (2 * q)%Z with (q + q)%Z in va by lia. rewrite power_sum in va. pose proof (power_positive q) as q0. set (u := powerRZ s q) in *. rewrite va in r.
    assert (r' : 0 < value x theta (g a)) by nra.
    split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va, sqrt_mult, sqrt_square by nra. reflexivity.
  - pose proof (H a) as Ha. pose proof (H b) as Hb. pose proof (H t) as Ht. destruct (f a) as [p |], (f b) as [q |], (f t) as [r |]; try exact I.
    destruct ((p =? 0) && (q =? 0) && (r =? 0))%Z eqn:e; [| exact I]. apply andb_true_iff in e as [e e3]. apply andb_true_iff in e as [e1 e2]. apply Z.eqb_eq in e1, e2, e3. subst p q r.
    intros [n [da [db dt]]]. cbn [has_degree all_op map_op defined_op powerRZ] in *. destruct (Ha da) as [ea va]. destruct (Hb db) as [eb vb]. destruct (Ht dt) as [et vt].
    rewrite Rmult_1_l in va, vb, vt. rewrite va, vb, vt in n. split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va, vb, vt. ring.
Qed.

Theorem degrees_sound : forall tape i, has_degree (nth i (degrees J tape) None) (nth i (formulas tape) (integer 0)).
Proof.
  intros tape. apply (nth_related _ _ _ _ has_degree); [exact I |].
  apply (run_related (option Z) formula None (integer 0) (degree_op J) F has_degree); [exact I | exact degree_op_sound | constructor].
Qed.
End Machines.

(** ** Parameters of one scale *)

Definition has_zero (a : fixed) : bool := (lo a <=? 0)%Z && (0 <=? hi a)%Z.
Definition next_to_zero (a : fixed) : fixed := let n := if (0 <? lo a)%Z then lo a else hi a in Fixed n n.
Fixpoint put_at {A : Type} (k : nat) (v : A) (l : list A) : list A :=
  match l, k with [], _ => [] | _ :: r, O => v :: r | a :: r, S j => a :: put_at j v r end.
Definition of_one_scale (params : list fixed) (J : list nat) : list fixed :=
  match filter (fun j => negb (has_zero (nth j params zero))) J with [j] => put_at j (next_to_zero (nth j params zero)) params | _ => params end.

Fixpoint scaled_from (i : nat) (J : list nat) (s : R) (theta : list R) : list R :=
  match theta with [] => [] | t :: r => (if is_in J i then s else 1) * t :: scaled_from (S i) J s r end.
Lemma nth_scaled : forall J s theta i j, nth j (scaled_from i J s theta) 0 = (if is_in J (i + j) then s else 1) * nth j theta 0.
Proof.
  intros J s. induction theta as [| t r IH]; intros i [| j]; cbn [scaled_from nth]; try ring.
  - rewrite Nat.add_0_r. reflexivity.
  - rewrite IH. replace (i + S j)%nat with (S i + j)%nat by lia. reflexivity.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Lemma by_places : forall a x, length a = length x -> (forall i, (i < length a)%nat -> contains (nth i a zero) (nth i x 0)) -> Forall2 contains a x.
Proof.
  induction a as [| p a IH]; intros [| t x] e h; try discriminate; constructor; [apply (h O); cbn; lia |].
  apply IH; [cbn in e; congruence |]. intros i hi. apply (h (S i)). cbn. lia.
Qed.
Lemma place_in : forall a x, Forall2 contains a x -> forall i, contains (nth i a zero) (nth i x 0).
Proof. induction 1; intros [| i]; cbn [nth]; auto using zero_sound. Qed.
Lemma put_length : forall (A : Type) (l : list A) k v, length (put_at k v l) = length l.
Proof. induction l as [| a l IH]; intros [| k] v; cbn; auto. Qed.
Lemma nth_put : forall (l : list fixed) k v i, nth i (put_at k v l) zero = if Nat.eqb i k && Nat.ltb k (length l) then v else nth i l zero.
Proof.
  induction l as [| a l IH]; intros [| k] v [| i]; cbn [put_at nth Nat.eqb Nat.ltb Nat.leb length andb]; try reflexivity; try (rewrite andb_false_r; reflexivity).
  rewrite IH. reflexivity.
Qed.

Theorem of_one_scale_sound : forall J params theta, Forall2 contains params theta ->
  exists s scaled, 0 < s /\ Forall2 contains (of_one_scale params J) scaled /\ forall j, nth j scaled 0 = (if is_in J j then s else 1) * nth j theta 0.
Proof.
  intros J params theta h. pose proof (unit_R_pos bits) as u0. pose proof (place_in _ _ h) as P.
  assert (len : length params = length theta) by (clear - h; induction h; cbn; congruence).
  assert (Same : exists s scaled, 0 < s /\ Forall2 contains params scaled /\ forall j, nth j scaled 0 = (if is_in J j then s else 1) * nth j theta 0).
  { exists 1, theta. split; [lra |]. split; [exact h |]. intro j. destruct (is_in J j); ring. }
  unfold of_one_scale. destruct (filter _ J) as [| j [|]] eqn:e; try exact Same. clear Same.
  assert (Others : forall k, In k J -> k <> j -> has_zero (nth k params zero) = true).
  { intros k i n. destruct (has_zero (nth k params zero)) eqn:z; [reflexivity |]. exfalso.
    assert (In k [j]) by (rewrite <- e; apply filter_In; split; [exact i | rewrite z; reflexivity]). destruct H as [-> | []]. apply n. reflexivity. }
  assert (Own : In j J /\ has_zero (nth j params zero) = false).
  { assert (In j [j]) by (left; reflexivity). rewrite <- e in H. apply filter_In in H as [i z]. apply negb_true_iff in z. split; assumption. }
  destruct Own as [ij nz]. set (a := nth j params zero) in *. set (t := nth j theta 0) in *. pose proof (P j) as Pj. fold a t in Pj. destruct Pj as [P1 P2].
  assert (within : (j < length params)%nat).
  { apply Nat.nle_gt. intro g. unfold a in nz. rewrite nth_overflow in nz by exact g. discriminate. }
  set (n := if (0 <? lo a)%Z then lo a else hi a). assert (S : exists s, 0 < s /\ s <= 1 /\ s * t * unit_R bits = IZR n).
  { unfold has_zero in nz. unfold n. destruct (Z.ltb_spec 0 (lo a)) as [l | l].
    - apply IZR_lt in l. assert (t0 : 0 < t * unit_R bits) by lra. exists (IZR (lo a) / (t * unit_R bits)).
      split; [apply Rdiv_lt_0_compat; assumption |]. split; [apply Rmult_le_reg_r with (t * unit_R bits); [exact t0 |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra |].
      field. split; [lra |]. intro z. rewrite z in t0. lra.
    - assert (g : (hi a < 0)%Z) by (apply andb_false_iff in nz as [z | z]; [apply Z.leb_gt in z; lia | apply Z.leb_gt in z; exact z]).
      apply IZR_lt in g. assert (t0 : t * unit_R bits < 0) by lra. exists (IZR (hi a) / (t * unit_R bits)).
      assert (E : IZR (hi a) / (t * unit_R bits) = - IZR (hi a) / (- (t * unit_R bits))) by (field; split; [lra |]; intro z; rewrite z in t0; lra).
      rewrite E. split; [apply Rdiv_lt_0_compat; lra |]. split; [apply Rmult_le_reg_r with (- (t * unit_R bits)); [lra |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra |].
      field. split; [lra |]. intro z. rewrite z in t0. lra. }
  destruct S as [s [s0 [s1 st]]]. exists s, (scaled_from 0 J s theta). split; [exact s0 |].
  assert (N : forall k, nth k (scaled_from 0 J s theta) 0 = (if is_in J k then s else 1) * nth k theta 0) by (intro k; rewrite nth_scaled; reflexivity).
  split; [| exact N]. apply by_places.
  - rewrite put_length, len. clear. generalize O. induction theta; intro i; cbn [scaled_from length]; [reflexivity | rewrite <- IHtheta; reflexivity].
  - intros k _. rewrite N, nth_put. destruct (Nat.eqb_spec k j) as [-> | nk].
    + assert (is_in J j = true) by (apply existsb_exists; exists j; split; [exact ij | apply Nat.eqb_refl]). rewrite H.
      assert (Nat.ltb j (length params) = true) by (apply Nat.ltb_lt; exact within). rewrite H0. cbn [andb]. fold t. split; cbn [next_to_zero lo hi]; fold n; rewrite st; lra.
    + cbn [andb]. destruct (is_in J k) eqn:ik; [| rewrite Rmult_1_l; apply P].
      apply existsb_exists in ik as [k' [ik eq]]. apply Nat.eqb_eq in eq. subst k'. specialize (Others k ik nk). unfold has_zero in Others.
      apply andb_true_iff in Others as [z1 z2]. apply Z.leb_le, IZR_le in z1. apply Z.leb_le, IZR_le in z2. destruct (P k) as [Q1 Q2].
      split; rewrite Rmult_assoc; set (v := nth k theta 0 * unit_R bits) in *;
        assert (B : 0 <= s * v <= v \/ v <= s * v <= 0) by (clearbody v; clear - s0 s1; destruct (Rle_dec 0 v); [left | right]; split; nra); lra.
Qed.
End Precision.
