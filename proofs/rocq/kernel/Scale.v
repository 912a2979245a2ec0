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

(** What is 0 of all machines has every power: [Some None]. *)
Definition degree_op (J : list nat) (o : op (option (option Z))) : option (option Z) :=
  match o with
  | Coord _ => Some (Some 0%Z)
  | Integer n => Some (if (n =? 0)%Z then None else Some 0%Z)
  | Param j => Some (Some (if is_in J j then 1 else 0)%Z)
  | Add (Some None) d | Add d (Some None) | Sub (Some None) d | Sub d (Some None) | Neg d => d
  | Add (Some (Some a)) (Some (Some b)) | Sub (Some (Some a)) (Some (Some b)) => if (a =? b)%Z then Some (Some a) else None
  | Mul (Some None) (Some _) | Mul (Some _) (Some None) | Div (Some None) (Some _) | Sqr (Some None) => Some None
  | Mul (Some (Some a)) (Some (Some b)) => Some (Some (a + b)%Z)
  | Div (Some (Some a)) (Some (Some b)) => Some (Some (a - b)%Z)
  | Sqr (Some (Some a)) => Some (Some (a + a)%Z)
  | Sqrt (Some (Some a)) => if Z.even a then Some (Some (a / 2)%Z) else None
  | Elbow _ (Some a) (Some b) (Some t) => if forallb (fun d => match d with Some k => (k =? 0)%Z | None => true end) [a; b; t] then Some (Some 0%Z) else None
  | _ => None
  end.
Definition degrees (J : list nat) (tape : list (op address)) : list (option Z) :=
  map (option_map (fun d => match d with Some k => k | None => 0%Z end)) (run (option (option Z)) None (degree_op J) tape).

Section Machines.
Variables (x theta scaled : list R) (s : R) (J : list nat).
Hypothesis s_positive : 0 < s.
Hypothesis is_scaled : forall j, nth j scaled 0 = (if is_in J j then s else 1) * nth j theta 0.

(** Of a formula that is defined of the scaled machine. *)
Definition is_scaled_by (d : option Z) (v w : R) : Prop := match d with Some k => v = powerRZ s k * w | None => v = 0 /\ w = 0 end.
Definition has_degree (d : option (option Z)) (f : formula) : Prop :=
  match d with Some e => defined x scaled f -> defined x theta f /\ is_scaled_by e (value x scaled f) (value x theta f) | None => True end.

Lemma power_positive : forall k, 0 < powerRZ s k.
Proof. intro k. apply powerRZ_lt, s_positive. Qed.
Lemma power_sum : forall a b, powerRZ s (a + b) = powerRZ s a * powerRZ s b.
Proof. intros. apply powerRZ_add. lra. Qed.
Lemma power_minus : forall a b, powerRZ s (a - b) = powerRZ s a / powerRZ s b.
Proof. intros a b. unfold Z.sub. rewrite power_sum, powerRZ_neg'. unfold Rdiv. reflexivity. Qed.

Lemma level_of : forall d v w, match d with Some k => (k =? 0)%Z | None => true end = true -> is_scaled_by d v w -> v = w.
Proof. intros [k |] v w h H; cbn [is_scaled_by] in H; [apply Z.eqb_eq in h; subst k; rewrite H; cbn [powerRZ]; ring | lra]. Qed.
Lemma not_zero_of : forall d v w, is_scaled_by d v w -> v <> 0 -> w <> 0.
Proof. intros [k |] v w H n z; cbn [is_scaled_by] in H; apply n; [rewrite H, z; ring | tauto]. Qed.
Lemma degree_op_sound : forall (o : op address) f g, (forall i, has_degree (f i) (g i)) -> has_degree (degree_op J (map_op f o)) (F (map_op g o)).
Proof.
  intros o f g H.
  destruct o as [k | j | n | a b | a b | a | a b | a b | a | a | second a b t]; cbn [map_op].
  - intros _. cbn [degree_op value defined real_op defined_op all_op powerRZ is_scaled_by map_op]. split; [tauto | ring].
  - intros _. cbn [degree_op value defined real_op defined_op all_op is_scaled_by map_op]. split; [tauto |]. rewrite is_scaled. destruct (is_in J j); [rewrite powerRZ_1 | cbn [powerRZ]]; ring.
  - intros _. cbn [degree_op value defined real_op defined_op all_op map_op]. split; [tauto |]. destruct (Z.eqb_spec n 0) as [-> |]; cbn [is_scaled_by powerRZ]; [split; reflexivity | ring].
  - pose proof (H a) as Ha. pose proof (H b) as Hb.
    destruct (f a) as [[p |] |], (f b) as [[q |] |]; cbn [degree_op]; try exact I; try (destruct (Z.eqb_spec p q) as [<- |]; [| exact I]);
      intros [_ [da db]]; cbn [has_degree all_op map_op is_scaled_by] in *; destruct (Ha da) as [ea va]; destruct (Hb db) as [eb vb];
      (split; [cbn; tauto |]); cbn [value map_op real_op]; try match type of va with _ /\ _ => destruct va as [va va']; rewrite va, va' end; try match type of vb with _ /\ _ => destruct vb as [vb vb']; rewrite vb, vb' end;
      try rewrite va; try rewrite vb; try (split; ring); ring.
  - pose proof (H a) as Ha. pose proof (H b) as Hb.
    destruct (f a) as [[p |] |], (f b) as [[q |] |]; cbn [degree_op]; try exact I; try (destruct (Z.eqb_spec p q) as [<- |]; [| exact I]);
      intros [_ [da db]]; cbn [has_degree all_op map_op is_scaled_by] in *; destruct (Ha da) as [ea va]; destruct (Hb db) as [eb vb];
      (split; [cbn; tauto |]); cbn [value map_op real_op]; try match type of va with _ /\ _ => destruct va as [va va']; rewrite va, va' end; try match type of vb with _ /\ _ => destruct vb as [vb vb']; rewrite vb, vb' end;
      try rewrite va; try rewrite vb; try (split; ring); ring.
  - pose proof (H a) as Ha. cbn [degree_op]. destruct (f a) as [[p |] |]; try exact I;
      intros [_ da]; cbn [has_degree all_op map_op is_scaled_by] in *; destruct (Ha da) as [ea va]; (split; [cbn; tauto |]); cbn [value map_op real_op];
      [rewrite va; ring | destruct va as [va va']; rewrite va, va'; split; ring].
  - pose proof (H a) as Ha. pose proof (H b) as Hb.
    destruct (f a) as [[p |] |], (f b) as [[q |] |]; cbn [degree_op]; try exact I;
      intros [_ [da db]]; cbn [has_degree all_op map_op is_scaled_by] in *; destruct (Ha da) as [ea va]; destruct (Hb db) as [eb vb];
      (split; [cbn; tauto |]); cbn [value map_op real_op]; try match type of va with _ /\ _ => destruct va as [va va']; rewrite va, va' end; try match type of vb with _ /\ _ => destruct vb as [vb vb']; rewrite vb, vb' end;
      try (split; ring); rewrite va, vb, power_sum; ring.
  - pose proof (H a) as Ha. pose proof (H b) as Hb.
    assert (E : forall d e, f a = Some d -> f b = Some e -> defined x scaled (F (Div (g a) (g b))) ->
      defined x theta (F (Div (g a) (g b))) /\ is_scaled_by d (value x scaled (g a)) (value x theta (g a)) /\
      is_scaled_by e (value x scaled (g b)) (value x theta (g b)) /\ value x scaled (g b) <> 0 /\ value x theta (g b) <> 0).
    { intros d e ea eb [n [da db]]. rewrite ea in Ha. rewrite eb in Hb. cbn [has_degree all_op map_op defined_op] in *. destruct (Ha da) as [ea' va]. destruct (Hb db) as [eb' vb].
      pose proof (not_zero_of _ _ _ vb n) as n'. split; [cbn; tauto | tauto]. }
    destruct (f a) as [[p |] |], (f b) as [[q |] |]; cbn [degree_op]; try exact I; intro d; destruct (E _ _ eq_refl eq_refl d) as [d' [va [vb [n n']]]];
      (split; [exact d' |]); cbn [is_scaled_by] in *; cbn [value map_op real_op].
    + rewrite va, vb, power_minus. field. split; [exact n' |]. pose proof (power_positive q). lra.
    + destruct va as [va va']. rewrite va, va'. unfold Rdiv. split; ring.
    + destruct va as [va va']. rewrite va, va'. unfold Rdiv. split; ring.
  - pose proof (H a) as Ha. destruct (f a) as [[p |] |]; cbn [degree_op]; try exact I;
      intros [_ da]; cbn [has_degree all_op map_op is_scaled_by] in *; destruct (Ha da) as [ea va]; (split; [cbn; tauto |]); cbn [value map_op real_op];
      [rewrite va, power_sum; ring | destruct va as [va va']; rewrite va, va'; split; ring].
  - pose proof (H a) as Ha. destruct (f a) as [[p |] |]; cbn [degree_op]; try exact I. destruct (Z.even p) eqn:e; [| exact I].
    intros [r da]. cbn [has_degree all_op map_op defined_op is_scaled_by] in *. destruct (Ha da) as [ea va]. apply Z.even_spec in e as [q ->]. replace (2 * q / 2)%Z with q by (rewrite Z.mul_comm, Z.div_mul; lia).
    replace (2 * q)%Z with (q + q)%Z in va by lia. rewrite power_sum in va. pose proof (power_positive q) as q0. set (u := powerRZ s q) in *. rewrite va in r.
    assert (r' : 0 < value x theta (g a)) by nra.
    split; [cbn; tauto |]. cbn [value map_op real_op]. rewrite va, sqrt_mult, sqrt_square by nra. reflexivity.
  - pose proof (H a) as Ha. pose proof (H b) as Hb. pose proof (H t) as Ht. destruct (f a) as [p |], (f b) as [q |], (f t) as [r |]; try exact I. cbn [degree_op].
    destruct (forallb _ [p; q; r]) eqn:e; [| exact I]. cbn [forallb] in e. apply andb_true_iff in e as [e1 e]. apply andb_true_iff in e as [e2 e]. apply andb_true_iff in e as [e3 _].
    intros [n [da [db dt]]]. cbn [has_degree all_op map_op defined_op] in *. destruct (Ha da) as [ea va]. destruct (Hb db) as [eb vb]. destruct (Ht dt) as [et vt].
    apply (level_of _ _ _ e1) in va. apply (level_of _ _ _ e2) in vb. apply (level_of _ _ _ e3) in vt.
    rewrite va, vb, vt in n. split; [cbn; tauto |]. cbn [value map_op real_op is_scaled_by powerRZ]. rewrite va, vb, vt. ring.
Qed.

Theorem degrees_sound : forall tape i, match nth i (degrees J tape) None with
  | Some k => let f := nth i (formulas tape) (integer 0) in defined x scaled f -> defined x theta f /\ value x scaled f = powerRZ s k * value x theta f
  | None => True
  end.
Proof.
  intros tape i. unfold degrees. change (@None Z) with (option_map (fun d => match d with Some k => k | None => 0%Z end) None). rewrite map_nth.
  assert (H : has_degree (nth i (run (option (option Z)) None (degree_op J) tape) None) (nth i (formulas tape) (integer 0))).
  { apply (nth_related _ _ _ _ has_degree); [exact I |].
    apply (run_related (option (option Z)) formula None (integer 0) (degree_op J) F has_degree); [exact I | exact degree_op_sound]. }
  destruct (nth i (run _ _ _ _) None) as [[k |] |]; cbn [option_map has_degree is_scaled_by] in *; [exact H | | exact I].
  intro d. destruct (H d) as [d' [v w]]. split; [exact d' |]. rewrite v, w. ring.
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

(** It is one of all. *)
Lemma of_one_scale_within : forall J params theta t, Forall2 contains params theta -> Forall2 contains (of_one_scale params J) t -> Forall2 contains params t.
Proof.
  intros J params theta t h. unfold of_one_scale. destruct (filter _ J) as [| j [|]]; auto. clear J. revert j t.
  induction h as [| a x params theta ha h IH]; intros [| j] t k; cbn [put_at nth] in k; inversion k as [| ? y ? t' k1 k2]; subst; constructor; try assumption.
  - destruct ha as [h1 h2], k1 as [g1 g2]. cbn [next_to_zero lo hi] in g1, g2. split; destruct (0 <? lo a)%Z; lra.
  - exact (IH j t' k2).
Qed.
Lemma all_of_one_scale_within : forall groups params theta t, Forall2 contains params theta -> Forall2 contains (fold_left of_one_scale groups params) t -> Forall2 contains params t.
Proof.
  induction groups as [| J groups IH]; intros params theta t h k; [exact k |]. cbn [fold_left] in k. destruct (of_one_scale_sound J params theta h) as [s [th [_ [h1 _]]]].
  exact (of_one_scale_within J params theta t h (IH _ th t h1 k)).
Qed.
End Precision.
