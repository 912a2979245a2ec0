(** * Determinants of opposite signs

    A determinant that is continuous along a path and has opposite signs at its
    ends vanishes on it, and rows of which it vanishes annihilate a direction.  So
    two poses show that a platform is singular somewhere between them, where the
    workspace is connected. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Number Compare Trig Witness Linear Configuration Orientation Turning.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** Determinants, by the first column *)

Section Determinant.
Variables (A : Type) (zero one : A) (less times : A -> A -> A).
(** [front]: rows before those that are left, of which each is taken out in turn. *)
Fixpoint expansion (minor : list (list A) -> A) (front back : list (list A)) : A :=
  match back with
  | [] => zero
  | r :: back' => less (times (hd zero r) (minor (map (@tl A) (front ++ back')))) (expansion minor (front ++ [r]) back')
  end.
Fixpoint laplace (n : nat) (rows : list (list A)) : A :=
  match n with O => match rows with [] => one | _ => zero end | S m => expansion (laplace m) [] rows end.
End Determinant.

Lemma laplace_related : forall (A B : Type) (P : A -> B -> Prop) z o s t z' o' s' t', P z z' -> P o o' ->
  (forall a a' b b', P a a' -> P b b' -> P (s a b) (s' a' b')) -> (forall a a' b b', P a a' -> P b b' -> P (t a b) (t' a' b')) ->
  forall n rows rows', Forall2 (Forall2 P) rows rows' -> P (laplace A z o s t n rows) (laplace B z' o' s' t' n rows').
Proof.
  intros A B P z o s t z' o' s' t' hz ho hs ht. induction n as [| n IH]; intros rows rows' h.
  - destruct h; assumption.
  - cbn [laplace]. assert (E : forall front front', Forall2 (Forall2 P) front front' ->
      P (expansion A z s t (laplace A z o s t n) front rows) (expansion B z' s' t' (laplace B z' o' s' t' n) front' rows')).
    { induction h as [| r r' rows rows' hr h IHr]; intros front front' hf; [exact hz |]. cbn [expansion]. apply hs; [apply ht |].
      - destruct hr; assumption.
      - apply IH, (map_related _ _ _ _ (Forall2 P)); [intros ? ? []; [constructor | assumption] | apply Forall2_app; assumption].
      - apply IHr, Forall2_app; [assumption | repeat constructor; assumption]. }
    apply E. constructor.
Qed.

Notation detR := (laplace R 0 1 Rminus Rmult).

Section Rows.
Implicit Types (rows front back : list (list R)) (u w r : list R).

Lemma tl_comb : forall a b u w, tl (comb a b u w) = comb a b (tl u) (tl w).
Proof. intros a b [| x u] [| y w]; try reflexivity. destruct u; reflexivity. Qed.
Lemma hd_comb : forall a b u w, hd 0 (comb a b u w) = a * hd 0 u + b * hd 0 w.
Proof. intros a b [| x u] [| y w]; unfold comb; cbn; ring. Qed.

Definition is_linear (D : list (list R) -> R) : Prop := forall a b front u w back,
  D (front ++ comb a b u w :: back) = a * D (front ++ u :: back) + b * D (front ++ w :: back).
Definition alternates (D : list (list R) -> R) : Prop := forall front u back, D (front ++ u :: u :: back) = 0.

Lemma expansion_linear : forall D, is_linear D -> is_linear (expansion R 0 Rminus Rmult D []).
Proof.
  intros D lin. set (E := expansion R 0 Rminus Rmult D).
  assert (L1 : forall a b u w back front f2, E (front ++ comb a b u w :: f2) back = a * E (front ++ u :: f2) back + b * E (front ++ w :: f2) back).
  { intros a b u w. induction back as [| r back IH]; intros front f2; cbn [E expansion]; [ring |].
    rewrite <- !app_assoc. cbn [app]. rewrite !map_app. cbn [map]. rewrite tl_comb, lin. fold E. rewrite (IH front (f2 ++ [r])). ring. }
  assert (L2 : forall a b u w b2 b1 front, E front (b1 ++ comb a b u w :: b2) = a * E front (b1 ++ u :: b2) + b * E front (b1 ++ w :: b2)).
  { intros a b u w b2. induction b1 as [| r b1 IH]; intro front; cbn [app E expansion].
    - fold E. rewrite hd_comb, (L1 a b u w b2 front []). ring.
    - fold E. rewrite !(app_assoc front b1), !map_app. cbn [map]. rewrite tl_comb, lin, IH. ring. }
  intros a b front u w back. apply L2.
Qed.

Lemma expansion_alternates : forall D, alternates D -> alternates (expansion R 0 Rminus Rmult D []).
Proof.
  intros D alt. set (E := expansion R 0 Rminus Rmult D).
  assert (L1 : forall u back front f2, E (front ++ u :: u :: f2) back = 0).
  { intro u. induction back as [| r back IH]; intros front f2; cbn [E expansion]; [reflexivity |].
    rewrite <- !app_assoc. cbn [app]. rewrite map_app. cbn [map]. rewrite alt. fold E. rewrite (IH front (f2 ++ [r])). ring. }
  assert (L2 : forall u b2 b1 front, E front (b1 ++ u :: u :: b2) = 0).
  { intros u b2. induction b1 as [| r b1 IH]; intro front; cbn [app E expansion]; fold E.
    - rewrite <- !app_assoc. cbn [app]. rewrite (L1 u b2 front []). ring.
    - rewrite (app_assoc front b1), map_app. cbn [map]. rewrite alt, IH. ring. }
  intros front u back. apply L2.
Qed.

Lemma det_linear : forall n, is_linear (detR n).
Proof.
  induction n as [| n IH]; [| exact (expansion_linear _ IH)]. intros a b front u w back. destruct front; cbn [app laplace]; ring.
Qed.
Lemma det_alternates : forall n, alternates (detR n).
Proof.
  induction n as [| n IH]; [| exact (expansion_alternates _ IH)]. intros [] u back; reflexivity.
Qed.

Lemma det_swapped : forall n front u w back, detR n (front ++ u :: w :: back) = - detR n (front ++ w :: u :: back).
Proof.
  intros n front u w back. pose proof (det_alternates n) as alt. pose proof (alt front (comb 1 1 u w) back) as H. rewrite (det_linear n) in H.
  assert (S : forall x, detR n (front ++ x :: comb 1 1 u w :: back) = detR n (front ++ x :: u :: back) + detR n (front ++ x :: w :: back)).
  { intro x. pose proof (det_linear n 1 1 (front ++ [x]) u w back) as L. rewrite <- !app_assoc in L. cbn [app] in L. lra. }
  rewrite !S, !alt in H. lra.
Qed.
Lemma det_moved : forall n r back front a, detR n (a ++ front ++ r :: back) = 0 <-> detR n (a ++ r :: front ++ back) = 0.
Proof.
  intros n r back. induction front as [| x front IH]; intro a; [reflexivity |]. cbn [app].
  specialize (IH (a ++ [x])). rewrite <- !app_assoc in IH. cbn [app] in IH. rewrite IH, (det_swapped n a r x). split; lra.
Qed.
Lemma det_reduced : forall n r c rows front, detR n (r :: front ++ map (fun w => comb 1 (c w) w r) rows) = detR n (r :: front ++ rows).
Proof.
  intros n r c. induction rows as [| w rows IH]; intro front; [reflexivity |]. cbn [map].
  pose proof (det_linear n 1 (c w) (r :: front) w r (map (fun w => comb 1 (c w) w r) rows)) as L. cbn [app] in L. rewrite L.
  assert (Z : detR n (r :: front ++ r :: map (fun w => comb 1 (c w) w r) rows) = 0).
  { apply (det_moved n r _ front [r]). cbn [app]. apply (det_alternates n []). }
  rewrite Z. specialize (IH (front ++ [w])). rewrite <- !app_assoc in IH. cbn [app] in IH. rewrite IH. ring.
Qed.

Lemma expansion_zero : forall D rows front, Forall (fun r => hd 0 r = 0) rows -> expansion R 0 Rminus Rmult D front rows = 0.
Proof. intros D rows front h. revert front. induction h as [| r rows e _ IH]; intro f; cbn [expansion]; [reflexivity |]. rewrite e, IH. ring. Qed.

(** Rows of which the determinant vanishes have a direction that none of them sees. *)
Theorem det_zero : forall n rows, length rows = n -> detR n rows = 0 ->
  exists v, length v = n /\ nonzero v /\ Forall (fun r => dot r v = 0) rows.
Proof.
  assert (Z : forall u m, dot u (repeat 0 m) = 0) by (induction u as [| x u IH]; intros [| m]; cbn [repeat dot]; rewrite ?IH; ring).
  induction n as [| n IH]; intros rows l d.
  - destruct rows; [| discriminate]. cbn [laplace] in d. lra.
  - assert (F : Forall (fun r => hd 0 r = 0) rows \/ exists front r back, rows = front ++ r :: back /\ hd 0 r <> 0).
    { clear. induction rows as [| r rows [IH | [front [q [back [-> h]]]]]]; [left; constructor | |].
      - destruct (Req_dec (hd 0 r) 0) as [e | e]; [left; constructor; assumption | right; exists [], r, rows; split; [reflexivity | exact e]].
      - right. exists (r :: front), q, back. split; [reflexivity | exact h]. }
    destruct F as [F | [front [r [back [-> h]]]]].
    + exists (1 :: repeat 0 n). split; [cbn [length]; rewrite repeat_length; reflexivity |]. split; [unfold nonzero; cbn [dot]; rewrite Z; lra |].
      revert F. apply Forall_impl. intros [| x r] e; cbn [hd dot] in *; [reflexivity |]. rewrite Z. lra.
    + apply (det_moved _ r back front []) in d. cbn [app] in d. set (c w := - hd 0 w / hd 0 r).
      rewrite <- (det_reduced _ r c (front ++ back) []) in d. cbn [app] in d. set (rest := map _ (front ++ back)) in d.
      assert (H0 : Forall (fun w => hd 0 w = 0) rest).
      { unfold rest. rewrite Forall_map. apply Forall_forall. intros w _. rewrite hd_comb. unfold c. field. exact h. }
      assert (d' : detR n (map (@tl R) rest) = 0).
      { cbn [laplace expansion] in d. rewrite expansion_zero in d by exact H0. cbn [app] in d. apply Rmult_eq_reg_l with (hd 0 r); lra. }
      destruct (IH (map (@tl R) rest)) as [v [lv [nz hv]]]; [unfold rest; rewrite !map_length; rewrite !app_length in *; cbn [length] in l; lia | exact d' |].
      exists (- dot (tl r) v / hd 0 r :: v). split; [cbn [length]; congruence |].
      split; [unfold nonzero in *; cbn [dot]; pose proof (Rle_0_sqr (- dot (tl r) v / hd 0 r)) as s; unfold Rsqr in s; lra |].
      assert (E : forall w, dot w (- dot (tl r) v / hd 0 r :: v) = hd 0 w * (- dot (tl r) v / hd 0 r) + dot (tl w) v) by (intros []; cbn; ring).
      assert (K : Forall (fun w => dot w (- dot (tl r) v / hd 0 r :: v) = 0) (front ++ back)).
      { unfold rest in hv. rewrite !Forall_map in hv. revert hv. apply Forall_impl. intros w e. rewrite tl_comb, dot_comb in e. rewrite E.
        unfold c in e. refine (eq_trans _ e). field. exact h. }
      apply Forall_app in K as [K1 K2]. apply Forall_app. split; [exact K1 |]. constructor; [| exact K2]. rewrite E. field. exact h.
Qed.
End Rows.

(** ** Along a path *)

Definition flows (v : R -> vec) : Prop := continuity (fun u => vx (v u)) /\ continuity (fun u => vy (v u)) /\ continuity (fun u => vz (v u)).

Lemma flow_plus : forall f g : R -> R, continuity f -> continuity g -> continuity (fun u => f u + g u).
Proof. exact continuity_plus. Qed.
Lemma flow_minus : forall f g : R -> R, continuity f -> continuity g -> continuity (fun u => f u - g u).
Proof. exact continuity_minus. Qed.
Lemma flow_times : forall f g : R -> R, continuity f -> continuity g -> continuity (fun u => f u * g u).
Proof. exact continuity_mult. Qed.
Lemma flow_constant : forall a : R, continuity (fun _ => a).
Proof. intro a. apply continuity_const. intros x y. reflexivity. Qed.
Lemma flow_opposite : forall f : R -> R, continuity f -> continuity (fun u => - f u).
Proof. exact continuity_opp. Qed.
Lemma flow_same : forall f g : R -> R, (forall u, f u = g u) -> continuity f -> continuity g.
Proof.
  intros f g e h u eps p. destruct (h u eps p) as [a [a0 k]]. exists a. split; [exact a0 |]. intros y hy. rewrite <- !e. exact (k y hy).
Qed.
Lemma flow_square : forall f : R -> R, continuity f -> continuity (fun u => f u ^ 2).
Proof. intros f h. cbn [pow]. repeat apply flow_times; try exact h. apply flow_constant. Qed.
Lemma flow_over : forall f g : R -> R, continuity f -> continuity g -> (forall u, g u <> 0) -> continuity (fun u => f u / g u).
Proof. intros f g hf hg n. exact (continuity_div f g hf hg n). Qed.
Lemma flow_root : forall f : R -> R, continuity f -> (forall u, 0 <= f u) -> continuity (fun u => sqrt (f u)).
Proof. intros f h p u. apply (continuity_pt_comp f sqrt); [apply h | apply continuity_pt_sqrt, p]. Qed.
Lemma flow_line : forall a b : R, continuity (fun u => a + u * (b - a)).
Proof. intros a b. apply flow_plus; [apply flow_constant |]. apply flow_times; [| apply flow_constant]. apply derivable_continuous, derivable_id. Qed.

Ltac flow := repeat first [assumption | apply flow_plus | apply flow_minus | apply flow_times | apply flow_opposite | apply flow_constant | apply flow_square].

Lemma flows_add : forall v w, flows v -> flows w -> flows (fun u => vadd (v u) (w u)).
Proof. intros v w [? [? ?]] [? [? ?]]. split; [| split]; cbn [vadd vx vy vz]; flow. Qed.
Lemma flows_sub : forall v w, flows v -> flows w -> flows (fun u => vsub (v u) (w u)).
Proof. intros v w [? [? ?]] [? [? ?]]. split; [| split]; cbn [vsub vx vy vz]; flow. Qed.
Lemma flows_scale : forall f v, continuity f -> flows v -> flows (fun u => vscale (f u) (v u)).
Proof. intros f v h [? [? ?]]. split; [| split]; cbn [vscale vx vy vz]; flow. Qed.
Lemma flows_cross : forall v w, flows v -> flows w -> flows (fun u => cross (v u) (w u)).
Proof. intros v w [? [? ?]] [? [? ?]]. split; [| split]; cbn [cross vx vy vz]; flow. Qed.
Lemma flows_constant : forall v, flows (fun _ => v).
Proof. intro v. split; [| split]; apply flow_constant. Qed.
Lemma flows_mulv : forall M v, flows (fun u => row1 (M u)) -> flows (fun u => row2 (M u)) -> flows (fun u => row3 (M u)) -> flows v -> flows (fun u => mulv (M u) (v u)).
Proof.
  intros M v [? [? ?]] [? [? ?]] [? [? ?]] [? [? ?]]. split; [| split]; cbn [mulv vx vy vz]; unfold Vec3.dot; flow.
Qed.
Lemma flows_line : forall a b, flows (fun u => vadd a (vscale u (vsub b a))).
Proof. intros a b. split; [| split]; cbn [vadd vscale vsub vx vy vz]; apply flow_line. Qed.

(** Rows of functions, and of their values. *)
Definition values_at (u : R) (rows : list (list (R -> R))) : list (list R) := map (map (fun f => f u)) rows.

(** Where a determinant changes its sign along a path, some direction is not seen on it. *)
Theorem singular_between : forall n rows, Forall (Forall continuity) rows -> length rows = n ->
  detR n (values_at 0 rows) * detR n (values_at 1 rows) <= 0 ->
  exists u v, 0 <= u <= 1 /\ length v = n /\ nonzero v /\ Forall (fun r => dot r v = 0) (values_at u rows).
Proof.
  intros n rows c l h. set (D := laplace (R -> R) (fun _ => 0) (fun _ => 1) (fun f g u => f u - g u) (fun f g u => f u * g u) n rows).
  assert (E : forall u, D u = detR n (values_at u rows)).
  { intro u. apply (laplace_related (R -> R) R (fun f a => f u = a)); try reflexivity; try (intros ? ? ? ? -> ->; reflexivity).
    unfold values_at. clear. induction rows as [| r rows IH]; constructor; [| exact IH]. induction r; constructor; [reflexivity | assumption]. }
  assert (C : continuity D).
  { apply (laplace_related (R -> R) unit (fun f _ => continuity f) _ _ _ _ tt tt (fun _ _ => tt) (fun _ _ => tt)) with (rows' := map (map (fun _ => tt)) rows);
      try apply flow_constant; try (intros f a g b hf hg; first [exact (flow_minus f g hf hg) | exact (flow_times f g hf hg)]).
    clear - c. induction c as [| r rows h _ IH]; constructor; [| exact IH]. induction h; constructor; assumption. }
  destruct (IVT_cor D 0 1 C ltac:(lra)) as [u [hu z]]; [rewrite !E; exact h |]. rewrite E in z.
  destruct (det_zero n (values_at u rows)) as [v [lv [nz hv]]]; [unfold values_at; rewrite map_length; exact l | exact z |].
  exists u, v. repeat split; tauto.
Qed.

Section Named.
Context {names : naming}.

(** ** Orientations by coordinates that are real numbers *)

Definition half_cosine_of (t : R) : R := (1 - t ^ 2) / (1 + t ^ 2).
Definition half_sine_of (t : R) : R := 2 * t / (1 + t ^ 2).
Definition half_x (t : R) : mat := Mat (Vec 1 0 0) (Vec 0 (half_cosine_of t) (- half_sine_of t)) (Vec 0 (half_sine_of t) (half_cosine_of t)).
Definition half_y (t : R) : mat := Mat (Vec (half_cosine_of t) 0 (half_sine_of t)) (Vec 0 1 0) (Vec (- half_sine_of t) 0 (half_cosine_of t)).
Definition half_z (t : R) : mat := Mat (Vec (half_cosine_of t) (- half_sine_of t) 0) (Vec (half_sine_of t) (half_cosine_of t) 0) (Vec 0 0 1).
Definition along_axis (c : vec) : mat := mscale (/ (1 + norm2 c)) (rodrigues c).

Lemma half_is : forall t x, is_half_tangent t x ->
  half_x t = rotation_x (in_degrees x) /\ half_y t = rotation_y (in_degrees x) /\ half_z t = rotation_z (in_degrees x).
Proof. intros t x [C S]. unfold half_x, half_y, half_z, half_cosine_of, half_sine_of, rotation_x, rotation_y, rotation_z. rewrite C, S. repeat split. Qed.
Lemma along_axis_is : forall c Q, rodrigues c = mscale (1 + norm2 c) Q -> along_axis c = Q.
Proof.
  intros c Q e. unfold along_axis. rewrite e. pose proof (norm2_nonneg c). set (w := 1 + norm2 c) in *. assert (n : w <> 0) by (unfold w; lra).
  clearbody w. destruct Q as [[a1 a2 a3] [b1 b2 b3] [c1 c2 c3]]. unfold mscale, vscale. cbn [row1 row2 row3 vx vy vz]. f_equal; f_equal; field; exact n.
Qed.

Definition orientation_at (o : orientations) (c : list R) : mat :=
  match o, c with
  | TurnedBy _, [t] => half_z t
  | RollPitchYaw _ _ _, [x; y; z] => mulm (half_z z) (mulm (half_y y) (half_x x))
  | (TurnedUpTo _ | Tilted _ _), [x; y; z] => along_axis (Vec x y z)
  | _, _ => midentity
  end.

(** The coordinates that are proved to be those of a set's orientations. *)
Definition is_half_in (t : tolerance) (x : R) : Prop := value (least t) <= value (greatest t) /\ excess x (value (least t)) <= 0 /\ 0 <= excess x (value (greatest t)).
Definition is_coordinate (o : orientations) (c : list R) : Prop :=
  match o, c with
  | TurnedBy t, [x] => is_half_in t x
  | RollPitchYaw r p y, [a; b; d] => is_half_in r a /\ is_half_in p b /\ is_half_in y d
  | TurnedUpTo m, [x; y; z] => 0 <= value m /\ is_angle (value m) /\ norm2 (Vec x y z) <= tangent (value m) ^ 2
  | Tilted m n, [x; y; z] => 0 <= value m /\ is_angle (value m) /\ x ^ 2 + y ^ 2 <= tangent (value m) ^ 2 * (1 + z ^ 2) /\ is_half_in (either_way n) z
  | _, _ => False
  end.

Lemma is_half_in_sound : forall t x, is_half_in t x -> exists a, within t a /\ is_half_tangent x a.
Proof. intros t x [le [a b]]. exact (half_tangent_between x _ _ le a b). Qed.

Lemma is_coordinate_sound : forall o c, is_coordinate o c -> in_orientations o (orientation_at o c).
Proof.
  intros [t | r p y | m | m n] [| a [| b [| d [|]]]] h; try contradiction; cbn [is_coordinate orientation_at] in *.
  - destruct (is_half_in_sound _ _ h) as [x [hx tx]]. exists x. split; [exact hx |]. apply half_is, tx.
  - destruct h as [h1 [h2 h3]]. destruct (is_half_in_sound _ _ h1) as [x1 [k1 t1]]. destruct (is_half_in_sound _ _ h2) as [x2 [k2 t2]].
    destruct (is_half_in_sound _ _ h3) as [x3 [k3 t3]]. exists x1, x2, x3. repeat split; try apply k1; try apply k2; try apply k3.
    destruct (half_is _ _ t1) as [-> _]. destruct (half_is _ _ t2) as [_ [-> _]]. destruct (half_is _ _ t3) as [_ [_ ->]]. reflexivity.
  - destruct h as [h0 [h1 h2]]. destruct (up_to_found m _ h0 h1 h2) as [Q [hQ e]]. rewrite (along_axis_is _ _ e). exact hQ.
  - destruct h as [h0 [h1 [h2 h3]]]. destruct (is_half_in_sound _ _ h3) as [s [hs ts]]. unfold either_way, within in hs. cbn [least greatest value] in hs.
    destruct (tilt_found m n (Vec a b d) s h0 h1 ltac:(lra) ts h2) as [Q [hQ e]]. rewrite (along_axis_is _ _ e). exact hQ.
Qed.

Lemma is_orientation_coordinate : forall bits o c, is_orientation bits o c = true -> is_coordinate o (map value c).
Proof.
  assert (H : forall bits t c, is_half_tangent_in bits t c = true -> is_half_in t (value c)).
  { intros bits t c h. apply andb_true_iff in h as [h b]. apply andb_true_iff in h as [h a]. apply (Compare.below_sound bits) in h.
    apply (exceeds_sound bits) in a, b. split; [exact h | split; [exact a | exact b]]. }
  intros bits [t | r p y | m | m n] [| a [| b [| d [|]]]] h; try discriminate; cbn [is_orientation is_coordinate map] in *.
  - exact (H _ _ _ h).
  - apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2]. split; [| split]; eapply H; eassumption.
  - destruct (is_up_to_sound bits _ _ _ h) as [m0 [im le]]. rewrite value_square in le. cbn [value] in le. split; [exact m0 | split; [exact im |]].
    change (Vec (value a) (value b) (value d)) with (values (Numbers a b d)). lra.
  - apply andb_true_iff in h as [h k]. destruct (is_up_to_sound bits _ _ _ h) as [m0 [im le]]. cbn [value] in le.
    split; [exact m0 | split; [exact im | split; [lra | exact (H _ _ _ k)]]].
Qed.

Lemma values_turn : forall o c b, is_coordinate o (map value c) -> values (turn o c b) = mulv (orientation_at o (map value c)) (values b).
Proof.
  intros [t | r p y | m | m n] [| x [| z [| w [|]]]] b h; try contradiction; cbn [is_coordinate orientation_at turn map] in *.
  - destruct (is_half_in_sound _ _ h) as [a [_ ta]]. destruct (half_is _ _ ta) as [_ [_ ->]]. apply (values_about _ _ _ ta).
  - destruct h as [h1 [h2 h3]]. destruct (is_half_in_sound _ _ h1) as [x1 [_ t1]]. destruct (is_half_in_sound _ _ h2) as [x2 [_ t2]].
    destruct (is_half_in_sound _ _ h3) as [x3 [_ t3]]. destruct (half_is _ _ t1) as [-> _]. destruct (half_is _ _ t2) as [_ [-> _]]. destruct (half_is _ _ t3) as [_ [_ ->]].
    destruct (values_about _ _ (about_y z (about_x x b)) t3) as [_ [_ ->]]. destruct (values_about _ _ (about_x x b) t2) as [_ [-> _]].
    destruct (values_about _ _ b t1) as [-> _]. rewrite !mulv_mulm. reflexivity.
  - destruct h as [h0 [h1 h2]]. destruct (up_to_found m _ h0 h1 h2) as [Q [_ e]]. rewrite (along_axis_is _ _ e). apply (values_along (Numbers x z w)), e.
  - destruct h as [h0 [h1 [h2 h3]]]. destruct (is_half_in_sound _ _ h3) as [s [hs ts]]. unfold either_way, within in hs. cbn [least greatest value] in hs.
    destruct (tilt_found m n (Vec (value x) (value z) (value w)) s h0 h1 ltac:(lra) ts h2) as [Q [_ e]]. rewrite (along_axis_is _ _ e). apply (values_along (Numbers x z w)), e.
Qed.

(** *** Between two orientations of a set *)

Lemma flow_half : forall f, continuity f -> continuity (fun u => half_cosine_of (f u)) /\ continuity (fun u => half_sine_of (f u)).
Proof.
  intros f h. assert (n : forall u, 1 + f u ^ 2 <> 0) by (intro u; pose proof (pow2_ge_0 (f u)); lra).
  split; apply flow_over; flow; exact n.
Qed.
Lemma flows_half : forall f v, continuity f -> flows v ->
  flows (fun u => mulv (half_x (f u)) (v u)) /\ flows (fun u => mulv (half_y (f u)) (v u)) /\ flows (fun u => mulv (half_z (f u)) (v u)).
Proof.
  intros f v h hv. destruct (flow_half f h) as [C S]. split; [| split]; apply flows_mulv; try exact hv;
    (split; [| split]; cbn [half_x half_y half_z row1 row2 row3 vx vy vz]; flow).
Qed.
Lemma flows_along : forall c b, flows c -> flows (fun u => mulv (along_axis (c u)) b).
Proof.
  intros c b [h1 [h2 h3]]. assert (n : forall u, 1 + norm2 (c u) <> 0) by (intro u; pose proof (norm2_nonneg (c u)); lra).
  assert (N : continuity (fun u => / (1 + norm2 (c u)))).
  { assert (D : continuity (fun u => 1 / (1 + norm2 (c u)))) by (apply flow_over; [apply flow_constant | unfold norm2; flow | exact n]).
    revert D. apply flow_same. intro u. unfold Rdiv. ring. }
  apply flows_mulv; try apply flows_constant; unfold along_axis, mscale, rodrigues; cbn [row1 row2 row3];
    (split; [| split]; cbn [vscale vx vy vz]; unfold norm2 in *; flow).
Qed.

Lemma excess_between : forall a b u x, excess (a + u * (b - a)) x = excess a x + u * (excess b x - excess a x).
Proof. intros. unfold excess. ring. Qed.
Lemma half_between : forall t a b u, 0 <= u <= 1 -> is_half_in t a -> is_half_in t b -> is_half_in t (a + u * (b - a)).
Proof. intros t a b u hu [le [a1 a2]] [_ [b1 b2]]. split; [exact le |]. rewrite !excess_between. split; nra. Qed.

Lemma convex_square : forall p q u, 0 <= u <= 1 -> (p + u * (q - p)) ^ 2 <= p ^ 2 + u * (q ^ 2 - p ^ 2).
Proof. intros p q u hu. pose proof (pow2_ge_0 (q - p)). assert (0 <= u * (1 - u)) by nra. nra. Qed.

Lemma orientations_connected : forall o c c', is_coordinate o c -> is_coordinate o c' ->
  exists path, path 0 = c /\ path 1 = c' /\ (forall u, 0 <= u <= 1 -> is_coordinate o (path u)) /\ forall b, flows (fun u => mulv (orientation_at o (path u)) b).
Proof.
  assert (E0 : forall a b, a + 0 * (b - a) = a) by (intros; ring). assert (E1 : forall a b, a + 1 * (b - a) = b) by (intros; ring).
  intros [t | r p y | m | m n] [| a [| b [| d [|]]]] [| a' [| b' [| d' [|]]]] h h'; try contradiction; cbn [is_coordinate] in *.
  - exists (fun u => [a + u * (a' - a)]). rewrite E0, E1. split; [reflexivity | split; [reflexivity | split]].
    + intros u hu. apply half_between; assumption.
    + intro v. apply (flows_half (fun u => a + u * (a' - a)) (fun _ => v) (flow_line a a') (flows_constant v)).
  - exists (fun u => [a + u * (a' - a); b + u * (b' - b); d + u * (d' - d)]). rewrite !E0, !E1. split; [reflexivity | split; [reflexivity | split]].
    + intros u hu. destruct h as [? [? ?]], h' as [? [? ?]]. split; [| split]; apply half_between; assumption.
    + intro v. cbn [orientation_at]. pose proof (proj1 (flows_half _ _ (flow_line a a') (flows_constant v))) as X.
      pose proof (proj1 (proj2 (flows_half _ _ (flow_line b b') X))) as Y. pose proof (proj2 (proj2 (flows_half _ _ (flow_line d d') Y))) as Z.
      assert (G : forall A B C : R -> mat, flows (fun u => mulv (A u) (mulv (B u) (mulv (C u) v))) -> flows (fun u => mulv (mulm (A u) (mulm (B u) (C u))) v)).
      { intros A B C [z1 [z2 z3]]. split; [revert z1 | split; [revert z2 | revert z3]]; apply flow_same; intro u; rewrite !mulv_mulm; reflexivity. }
      apply (G (fun u => half_z (d + u * (d' - d))) (fun u => half_y (b + u * (b' - b))) (fun u => half_x (a + u * (a' - a)))). exact Z.
  - exists (fun u => [a + u * (a' - a); b + u * (b' - b); d + u * (d' - d)]). rewrite !E0, !E1. split; [reflexivity | split; [reflexivity | split]].
    + intros u hu. destruct h as [h0 [h1 h2]], h' as [_ [_ h2']]. split; [exact h0 | split; [exact h1 |]]. unfold norm2 in *. cbn [vx vy vz] in *.
      pose proof (convex_square a a' u hu). pose proof (convex_square b b' u hu). pose proof (convex_square d d' u hu). nra.
    + intro v. cbn [orientation_at]. apply (flows_along (fun u => Vec (a + u * (a' - a)) (b + u * (b' - b)) (d + u * (d' - d)))).
      split; [| split]; cbn [vx vy vz]; apply flow_line.
  - (* the first two over the root of 1 + c_3^2 along a segment *)
    destruct h as [h0 [h1 [h2 h3]]], h' as [_ [_ [h2' h3']]]. set (z u := d + u * (d' - d)). set (w u := sqrt (1 + z u ^ 2)).
    assert (z0 : forall u, 0 < 1 + z u ^ 2) by (intro u; pose proof (pow2_ge_0 (z u)); lra).
    assert (w0 : forall u, 0 < w u) by (intro u; apply sqrt_lt_R0, z0). assert (w2 : forall u, w u ^ 2 = 1 + z u ^ 2) by (intro u; apply pow2_sqrt, Rlt_le, z0).
    set (x u := a / w 0 + u * (a' / w 1 - a / w 0)). set (y u := b / w 0 + u * (b' / w 1 - b / w 0)).
    assert (Z0 : z 0 = d) by (unfold z; ring). assert (Z1 : z 1 = d') by (unfold z; ring).
    pose proof (w0 0) as p0. pose proof (w0 1) as p1. pose proof (w2 0) as q0. pose proof (w2 1) as q1. rewrite Z0 in q0. rewrite Z1 in q1.
    exists (fun u => [w u * x u; w u * y u; z u]). split; [rewrite Z0; unfold x, y; f_equal; [| f_equal]; field; split; lra |].
    split; [rewrite Z1; unfold x, y; f_equal; [| f_equal]; field; split; lra |]. split.
    + intros u hu. split; [exact h0 | split; [exact h1 | split; [| exact (half_between _ _ _ u hu h3 h3')]]].
      set (T := tangent (value m) ^ 2) in *.
      assert (K : forall p q W, 0 < W -> p ^ 2 + q ^ 2 <= T * W ^ 2 -> (p / W) ^ 2 + (q / W) ^ 2 <= T).
      { intros p q W W0 k. replace ((p / W) ^ 2 + (q / W) ^ 2) with ((p ^ 2 + q ^ 2) / W ^ 2) by (field; lra).
        apply Rmult_le_reg_r with (W ^ 2); [nra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by nra. lra. }
      pose proof (K a b (w 0) p0 ltac:(rewrite q0; exact h2)) as K0. pose proof (K a' b' (w 1) p1 ltac:(rewrite q1; exact h2')) as K1.
      pose proof (convex_square (a / w 0) (a' / w 1) u hu) as X. pose proof (convex_square (b / w 0) (b' / w 1) u hu) as Y. fold (x u) in X. fold (y u) in Y.
      replace ((w u * x u) ^ 2 + (w u * y u) ^ 2) with ((x u ^ 2 + y u ^ 2) * w u ^ 2) by ring. rewrite <- w2.
      apply Rmult_le_compat_r; [apply pow2_ge_0 |]. nra.
    + intro v. cbn [orientation_at]. assert (Cz : continuity z) by (unfold z; apply flow_line).
      assert (Cw : continuity w) by (apply flow_root; [flow | intro u; apply Rlt_le, z0]).
      assert (Cx : continuity x) by (unfold x; apply flow_line). assert (Cy : continuity y) by (unfold y; apply flow_line).
      apply (flows_along (fun u => Vec (w u * x u) (w u * y u) (z u))). split; [| split]; cbn [vx vy vz]; flow.
Qed.

Lemma region_convex : forall r P P' u, 0 <= u <= 1 -> in_region r P -> in_region r P' -> in_region r (vadd P (vscale u (vsub P' P))).
Proof.
  assert (S : forall t x y u, 0 <= u <= 1 -> within t x -> within t y -> within t (x + u * (y - x))) by (unfold within; intros; split; nra).
  intros [edges | x y r height] P P' u hu h h'; cbn [in_region] in *; unfold vadd, vscale, vsub; cbn [vx vy vz].
  - destruct h as [? [? ?]], h' as [? [? ?]]. split; [| split]; cbn [vx vy vz]; apply S; assumption.
  - destruct h as [h [r0 hz]], h' as [h' [_ hz']]. split; [| split; [exact r0 | apply S; assumption]].
    pose proof (convex_square (vx P - value x) (vx P' - value x) u hu) as X. pose proof (convex_square (vy P - value y) (vy P' - value y) u hu) as Y.
    replace (vx P + u * (vx P' - vx P) - value x) with (vx P - value x + u * (vx P' - value x - (vx P - value x))) by ring.
    replace (vy P + u * (vy P' - vy P) - value y) with (vy P - value y + u * (vy P' - value y - (vy P - value y))) by ring. nra.
Qed.

(** ** Two poses *)

(** A row times the strut's length. *)
Definition strut_ray (k : motion) (ell : R) (l : strut) (P : vec) (Q : mat) : list R :=
  let w := strut_vector l P Q in twist k w (vscale (/ ell) (cross (arm_of_joint l Q) w)).
Lemma row_of_ray : forall k ell l P Q v, dot (strut_ray k ell l P Q) v = 0 -> dot (strut_row k ell l P Q) v = 0.
Proof.
  intros k ell l P Q v h. set (w := strut_vector l P Q) in *. set (r := arm_of_joint l Q) in *. set (q := / sqrt (norm2 w)).
  assert (E : strut_row k ell l P Q = map (Rmult q) (strut_ray k ell l P Q)).
  { unfold strut_row, strut_ray. fold w r. unfold normalised. fold q. destruct k; cbn [twist map vx vy vz vscale cross];
      repeat (apply f_equal2; [ring |]); reflexivity. }
  rewrite E, dot_map, h. ring.
Qed.

Definition is_strut_path (k : motion) (ell : R) (l : strut) (P : R -> vec) (Q : R -> mat) : list (R -> R) :=
  let w u := strut_vector l (P u) (Q u) in let m u := vscale (/ ell) (cross (arm_of_joint l (Q u)) (w u)) in
  match k with
  | InPlane => [fun u => vx (w u); fun u => vy (w u); fun u => vz (m u)]
  | InSpace => [fun u => vx (w u); fun u => vy (w u); fun u => vz (w u); fun u => vx (m u); fun u => vy (m u); fun u => vz (m u)]
  | AboutPoint => [fun u => vx (m u); fun u => vy (m u); fun u => vz (m u)]
  end.

Section Precision.
Variable bits : positive.

Definition enclosed_determinant (n : nat) (rows : list (list number)) : option fixed :=
  option_map (laplace fixed zero (Fixed.integer bits 1) sub (mul bits) n) (all_rows_enclosed bits rows).

Lemma enclosed_determinant_sound : forall n rows a, enclosed_determinant n rows = Some a -> contains bits a (detR n (map (map value) rows)).
Proof.
  intros n rows a h. unfold enclosed_determinant in h. destruct (all_rows_enclosed bits rows) as [q |] eqn:e; [| discriminate]. injection h as <-.
  apply laplace_related; [apply zero_sound | apply Fixed.integer_sound | intros; apply sub_sound; assumption | intros; apply mul_sound; assumption | exact (all_rows_enclosed_sound bits _ _ e)].
Qed.

Definition opposite (n : nat) (rows rows' : list (list number)) : bool :=
  match enclosed_determinant n rows, enclosed_determinant n rows' with
  | Some a, Some b => (0 <? lo a)%Z && (hi b <? 0)%Z || (hi a <? 0)%Z && (0 <? lo b)%Z
  | _, _ => false
  end.
Lemma opposite_sound : forall n rows rows', opposite n rows rows' = true -> detR n (map (map value) rows) * detR n (map (map value) rows') < 0.
Proof.
  intros n rows rows' opp. unfold opposite in opp.
  destruct (enclosed_determinant _ rows) as [a |] eqn:ea; [| discriminate]. destruct (enclosed_determinant _ rows') as [b |] eqn:eb; [| discriminate].
  apply enclosed_determinant_sound in ea, eb. set (x := detR _ _) in *. set (y := detR n (map (map value) rows')) in *.
  assert (N : forall a x, (hi a <? 0)%Z = true -> contains bits a x -> x < 0).
  { intros f z l [_ g]. apply Z.ltb_lt, IZR_lt in l. pose proof (unit_R_pos bits). nra. }
  assert (Y : forall a x, (0 <? lo a)%Z = true -> contains bits a x -> 0 < x) by (intros f z l g; apply Z.ltb_lt in l; exact (contains_positive bits f z l g)).
  apply orb_true_iff in opp as [q | q]; apply andb_true_iff in q as [q1 q2].
  - pose proof (Y _ _ q1 ea). pose proof (N _ _ q2 eb). nra.
  - pose proof (N _ _ q1 ea). pose proof (Y _ _ q2 eb). nra.
Qed.

Definition refute_between (c : turning_claim) (ls : list exact_strut) (P : numbers) (t : list number) (P' : numbers) (t' : list number) : bool :=
  is_about_exactly bits c ls P t && is_about_exactly bits c ls P' t' && Nat.eqb (length ls) (dimension (motion_of c)) &&
  let rays P t := map (xstrut_ray (motion_of c) (characteristic_length c) (turned c) t P) ls in opposite (dimension (motion_of c)) (rays P t) (rays P' t').

Lemma ray_values : forall k ell o c P l, is_coordinate o (map value c) ->
  map value (xstrut_ray k ell o c P l) = strut_ray k (value ell) (strut_of l) (values P) (orientation_at o (map value c)).
Proof.
  intros k ell o c P l h. unfold strut_ray, xstrut_ray. cbv zeta. pose proof (values_turn o c (xjoint l) h) as T.
  assert (W : values (xvector o c P l) = strut_vector (strut_of l) (values P) (orientation_at o (map value c)))
    by (unfold xvector, strut_vector, arm_of_joint; cbn [strut_of strut_base strut_joint]; rewrite <- T; reflexivity).
  rewrite <- W. unfold arm_of_joint. cbn [strut_joint strut_of]. rewrite <- T. set (w := xvector o c P l). set (r := turn o c (xjoint l)).
  unfold twist, ntwist, vscale, cross, scaled, ncrossed.
  destruct k; cbn [map vx vy vz nx ny nz values value]; repeat (apply f_equal2; [unfold Rdiv; rewrite ?Rinv_1; ring |]); reflexivity.
Qed.

Theorem refute_between_sound : forall c ls P t P' t', refute_between c ls P t P' t' = true ->
  exists m P Q, is_about_struts c m P Q /\ ~ meets_turning c m P Q.
Proof.
  intros c ls P t P' t' h. apply andb_true_iff in h as [h opp]. apply andb_true_iff in h as [h n]. apply andb_true_iff in h as [h h']. apply Nat.eqb_eq in n.
  apply andb_true_iff in h as [h o]. apply andb_true_iff in h as [s p]. apply andb_true_iff in h' as [h' o']. apply andb_true_iff in h' as [_ p'].
  apply is_orientation_coordinate in o, o'. apply is_in_sound in p, p'.
  destruct (orientations_connected _ _ _ o o') as [path [e0 [e1 [on flow]]]].
  set (k := motion_of c) in *. set (ell := value (characteristic_length c)) in *. set (m := map strut_of ls).
  set (at_ u := vadd (values P) (vscale u (vsub (values P') (values P)))). set (Q u := orientation_at (turned c) (path u)).
  set (rows := map (fun l => is_strut_path k ell l at_ Q) m).
  assert (V : forall u, values_at u rows = map (fun l => strut_ray k ell l (at_ u) (Q u)) m).
  { intro u. unfold values_at, rows. rewrite map_map. apply map_ext. intro l. unfold is_strut_path, strut_ray. destruct k; reflexivity. }
  assert (A0 : at_ 0 = values P) by (unfold at_; generalize (values P) (values P'); clear; intros [x y z] [x' y' z']; unfold vadd, vscale, vsub; cbn [vx vy vz]; f_equal; ring).
  assert (A1 : at_ 1 = values P') by (unfold at_; generalize (values P) (values P'); clear; intros [x y z] [x' y' z']; unfold vadd, vscale, vsub; cbn [vx vy vz]; f_equal; ring).
  destruct (singular_between (dimension k) rows) as [u [v [hu [lv [nz hv]]]]].
  - unfold rows. rewrite Forall_map. apply Forall_forall. intros l _.
    assert (W : flows (fun u => strut_vector l (at_ u) (Q u))).
    { unfold strut_vector, arm_of_joint. apply flows_sub; [| apply flows_constant]. apply flows_add; [apply flows_line | apply flow]. }
    assert (M : flows (fun u => vscale (/ ell) (cross (arm_of_joint l (Q u)) (strut_vector l (at_ u) (Q u))))).
    { apply flows_scale; [apply flow_constant |]. apply flows_cross; [apply flow | exact W]. }
    destruct W as [? [? ?]], M as [? [? ?]]. unfold is_strut_path. cbv zeta. destruct k; repeat constructor; assumption.
  - unfold rows, m. rewrite !map_length. exact n.
  - rewrite !V, A0, A1. unfold Q. rewrite e0, e1. unfold m. cbv zeta in opp. apply opposite_sound in opp. rewrite !map_map in opp |- *.
    rewrite (map_ext _ _ (fun l => ray_values k (characteristic_length c) _ _ P l o)), (map_ext _ _ (fun l => ray_values k (characteristic_length c) _ _ P' l o')) in opp. fold ell in opp. lra.
  - exists m, (at_ u), (Q u). split.
    + split; [exact (all_struts_sound bits _ _ s) | split; [apply region_convex; assumption | apply is_coordinate_sound, on, hu]].
    + intros [_ [inj _]]. specialize (inj v lv nz). rewrite V, Forall_map in hv. apply Rlt_not_le in inj. apply inj. clear inj.
      cbn [jacobian struts_at]. fold k ell. apply Req_le. clear - hv. unfold speed2. induction hv as [| l m z _ IH]; cbn [map fold_right]; [reflexivity |].
      rewrite IH, (row_of_ray k ell l _ _ v z). ring.
Qed.
End Precision.
End Named.
