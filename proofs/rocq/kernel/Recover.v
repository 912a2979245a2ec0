(** * The one pose near another one of legs in any motion

    As of struts (Onward.v), by the rows of M where a pose is off, of joints that are lengths or angles: an arm's angle is what its cosine and sine
    say, and turns by less than a radian nearby, so that these say what it is there. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require MeanValue.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Solve Test.
From Orthocert.kernel Require Import Linear Solve Twofold OnePose Statement Number Trig Formula Machine Orientation Turning Onward Angle Configuration Arm Legs.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** What a pose is off by *)

Definition shift_by (k : mobility) (u : list R) : vec :=
  match k with Translates => Vec (nth 0 u 0) (nth 1 u 0) (nth 2 u 0) | TranslatesInPlane => Vec (nth 0 u 0) (nth 1 u 0) 0 | Turns k => shift_of k u end.
Definition spin_by (k : mobility) (u : list R) : vec := match k with Turns k => spin_of k u | _ => vzero end.
Definition places_of (k : mobility) : nat := match k with Turns k => first_angle k | _ => freedom k end.

Lemma by_linear : forall k a b u v, shift_by k (comb a b u v) = vadd (vscale a (shift_by k u)) (vscale b (shift_by k v)) /\ spin_by k (comb a b u v) = vadd (vscale a (spin_by k u)) (vscale b (spin_by k v)).
Proof.
  intros [| | k] a b u v; [| | exact (parts_linear k a b u v)]; unfold shift_by, spin_by, vadd, vscale, vzero; cbn [vx vy vz]; rewrite ?comb_entries; split; f_equal; ring.
Qed.
Lemma velocities_by : forall k a c u, length u = freedom k -> Linear.dot (velocities k a c) u = Vec3.dot a (shift_by k u) + Vec3.dot c (spin_by k u).
Proof.
  intros [| | k] a c u l; cbn [freedom] in l; [| | exact (twist_parts k a c u l)].
  - destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. unfold velocities, coordinates, shift_by, spin_by, Vec3.dot, vzero. cbn. ring.
  - destruct u as [| u1 [| u2 [|]]]; try discriminate. unfold velocities, shift_by, spin_by, Vec3.dot, vzero. cbn. ring.
Qed.
Lemma by_sizes : forall k u, length u = freedom k ->
  size (part (places_of k) false u) = sqrt (norm2 (shift_by k u)) /\ size (part (places_of k) true u) = sqrt (norm2 (spin_by k u)).
Proof.
  intros [| | k] u l; cbn [freedom] in l; [| | exact (parts_sizes k u l)]; unfold size.
  - destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. split; f_equal; unfold norm2, part, vzero; cbn; ring.
  - destruct u as [| u1 [| u2 [|]]]; try discriminate. split; f_equal; unfold norm2, part, vzero; cbn; ring.
Qed.
Lemma velocities_length : forall k a c, length (velocities k a c) = freedom k.
Proof. intros [| | []] a c; reflexivity. Qed.
Lemma nothing_off : forall k, shift_by k (nought (freedom k)) = vzero /\ spin_by k (nought (freedom k)) = vzero.
Proof. intros [| | []]; split; reflexivity. Qed.

(** ** Joint coordinates *)

(** What one coordinate is off by from another one, and the coordinate that is off by this. *)
Definition off_from (c0 c : coordinate) : R :=
  match c0, c with Length a, Length b => b - a | Angle c0 s0, Angle c s => turn_between c0 s0 c s | _, _ => 0 end.
Definition moves_to (x : R) (c0 c : coordinate) : Prop :=
  match c0, c with Length a, Length b => b - a = x | Angle c0 s0, Angle c s => c = c0 * cos x - s0 * sin x /\ s = s0 * cos x + c0 * sin x | _, _ => False end.

Section Recover.
Variables (k : mobility) (m : list driven) (P : vec) (Q : mat) (mu dist tau g : R) (J : list R -> list (list R)).
Hypothesis mu_pos : 0 < mu.
Hypothesis dist_pos : 0 < dist.
Hypothesis g_nonneg : 0 <= g.
Local Notation n := (freedom k).
Local Notation f := (places_of k).
Local Notation inside u := (length u = n /\ norm f u <= 1).
Hypothesis m_length : length m = n.
Hypothesis J_length : forall u, length (J u) = n.
Hypothesis built : Forall well_formed_driven m.
Definition position_off (u : list R) : vec := vadd P (vscale dist (shift_by k u)).
Definition turn_off (u : list R) : mat := moved_on (vscale tau (spin_by k u)) Q.
Definition is_far_of (l : driven) (P' : vec) (Q' : mat) (C : vec) (row : list R) : Prop :=
  let unit := own_row l (carried l P' Q') in let m := cross (mulv Q' (offset l)) unit in
  own_reach l (carried l P' Q') /\ row = map (Rmult mu) (velocities k unit (vscale (tau / dist * (2 / (1 + norm2 C))) (vadd m (cross m C)))).
Hypothesis far : forall u, inside u -> Forall2 (fun row l => is_far_of l (position_off u) (turn_off u) (vscale tau (spin_by k u)) row) (J u) m.
Hypothesis slow : forall u v, inside u -> Forall (fun t => -1 <= t <= 1) v -> Forall2 (fun row l => match l with Rotary _ => Rabs (dist / mu * Linear.dot row v) < 1 | Linear _ => True end) (J u) m.
Hypothesis spread : forall u w, inside u -> length w = n -> size (less (image (J u) w) (image (J (nought n)) w)) <= g * norm f u * norm f w.
Variable bs : list R.
Hypothesis bs_length : length bs = n.
Hypothesis each_met : forall p, part f p (nought n) = [] \/ met f n J g bs p.

Local Notation none := (Linear (Plane vzero)).
Definition joint_off (l : driven) (u : list R) : coordinate := own_joint l (carried l (position_off u) (turn_off u)).

Lemma line_rate : forall u d t i, length u = n -> length d = n -> inside (comb 1 t u d) -> (i < n)%nat -> let l := nth i m none in
  let rho := dist / mu * Linear.dot (nth i (J (comb 1 t u d)) []) d in
  let at_ x := carried l (position_off (comb 1 x u d)) (turn_off (comb 1 x u d)) in
  match l with
  | Linear a => derivable_pt_lim (fun x => joint a (at_ x)) t rho
  | Rotary a => derivable_pt_lim (fun x => arm_cosine a (at_ x)) t (- arm_sine a (at_ t) * rho) /\ derivable_pt_lim (fun x => arm_sine a (at_ x)) t (arm_cosine a (at_ t) * rho) /\
      arm_cosine a (at_ t) ^ 2 + arm_sine a (at_ t) ^ 2 = 1
  end.
Proof.
  intros u d t i lu ld hs li l rho at_. rewrite <- m_length in li.
  destruct (at_index _ _ _ _ _ (far _ hs) i [] none li) as [reach row]. fold l in reach, row.
  assert (ok : well_formed_driven l) by (rewrite Forall_forall in built; apply built, nth_In, li).
  assert (EP : forall x, position_off (comb 1 x u d) = vadd (position_off u) (vscale x (vscale dist (shift_by k d)))).
  { intro x. unfold position_off. rewrite (proj1 (by_linear k 1 x u d)). generalize (shift_by k u) (shift_by k d). intros [a1 a2 a3] [b1 b2 b3]. unfold vadd, vscale. cbn [vx vy vz]. f_equal; ring. }
  assert (EC : forall x, vscale tau (spin_by k (comb 1 x u d)) = vadd (vscale tau (spin_by k u)) (vscale x (vscale tau (spin_by k d)))).
  { intro x. rewrite (proj2 (by_linear k 1 x u d)). generalize (spin_by k u) (spin_by k d). intros [a1 a2 a3] [b1 b2 b3]. unfold vadd, vscale. cbn [vx vy vz]. f_equal; ring. }
  set (C := vscale tau (spin_by k (comb 1 t u d))) in *. set (omega := vscale (2 / (1 + norm2 C)) (vadd (vscale tau (spin_by k d)) (cross C (vscale tau (spin_by k d))))).
  assert (HP : has_velocity (fun x => position_off (comb 1 x u d)) t (vscale dist (shift_by k d))).
  { assert (K : forall a b, derivable_pt_lim (fun x => a + x * b) t b).
    { intros a b. eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_const a t) (derivable_scal b _ _ _ (derivable_pt_lim_id t))) | intro x; unfold id; ring | ring]. }
    repeat split; cbn [vx vy vz vscale]; (eapply derivable_eq; [apply K | intro x; rewrite EP; cbn [vadd vscale vx vy vz]; reflexivity | reflexivity]). }
  assert (HQ : turns (fun x => turn_off (comb 1 x u d)) t omega).
  { intro b. pose proof (moves_on (vscale tau (spin_by k u)) (vscale tau (spin_by k d)) Q t b) as M. cbv beta zeta in M. rewrite <- EC in M. fold C in M. fold omega in M.
    destruct M as [m1 [m2 m3]].
    assert (K : forall (h : vec -> R) r, derivable_pt_lim (fun x => h (mulv (moved_on (vadd (vscale tau (spin_by k u)) (vscale x (vscale tau (spin_by k d)))) Q) b)) t r ->
      derivable_pt_lim (fun x => h (mulv (turn_off (comb 1 x u d)) b)) t r)
      by (intros h r hr; eapply derivable_eq; [exact hr | intro x; unfold turn_off; rewrite EC; reflexivity | reflexivity]).
    split; [exact (K vx _ m1) | split; [exact (K vy _ m2) | exact (K vz _ m3)]]. }
  set (r := mulv (turn_off (comb 1 t u d)) (offset l)) in *.
  assert (W : has_velocity at_ t (vadd (vscale dist (shift_by k d)) (cross omega r))).
  { destruct HP as [p1 [p2 p3]]. destruct (HQ (offset l)) as [q1 [q2 q3]].
    assert (K : forall f g d e c, derivable_pt_lim f t d -> derivable_pt_lim g t e -> derivable_pt_lim (fun u => f u + g u - c) t (d + e)).
    { intros f0 g0 d0 e c hf hg. apply derivable_eq with (fun u => f0 u + g0 u + - c) (d0 + e + 0); try (intros; ring).
      apply derivable_add; [apply derivable_add; assumption | apply derivable_const]. }
    unfold at_. split; [| split]; unfold carried; cbn [vsub vadd vx vy vz] in *; apply K; assumption. }
  assert (E : Vec3.dot (own_row l (at_ t)) (vadd (vscale dist (shift_by k d)) (cross omega r)) = rho).
  { unfold rho. rewrite row, dot_map, velocities_by by exact ld. cbv zeta in *. fold (at_ t). set (un := own_row l (at_ t)). unfold omega, turn_off in *. fold C in r |- *. fold r.
    pose proof (rate_of_length dist tau un r (2 / (1 + norm2 C)) C (shift_by k d) (spin_by k d)) as R0. rewrite <- R0 by lra. field. split; lra. }
  fold (at_ t) in reach. destruct l as [a | a]; cbn [own_row own_reach well_formed_driven] in *.
  - rewrite <- E. exact (row_is_derivative a at_ t _ ok reach W).
  - destruct (angle_velocity a at_ t _ ok reach W) as [c1 c2]. cbv zeta in c1, c2. rewrite E in c1, c2. split; [exact c1 |]. split; [exact c2 |]. exact (proj1 (angle_splits a _ ok reach)).
Qed.

Lemma zero_inside : inside (nought n).
Proof. split; [apply nought_length | pose proof (nought_norm f n); lra]. Qed.
Lemma line_from_nought : forall t u, length u = n -> comb 1 t (nought n) u = map (Rmult t) u.
Proof.
  intros t u lu. apply same_entries; [rewrite comb_length, map_length, nought_length; [congruence | rewrite nought_length; congruence] |]. intro i. rewrite comb_entries, map_entries, nought_entries. ring.
Qed.

(** Nearby, an arm turns by less than a quarter. *)
Lemma turns_little : forall w i a, inside w -> (i < n)%nat -> nth i m none = Rotary a ->
  let at_ u := carried (Rotary a) (position_off u) (turn_off u) in
  arm_cosine a (at_ (nought n)) ^ 2 + arm_sine a (at_ (nought n)) ^ 2 = 1 /\ arm_cosine a (at_ w) ^ 2 + arm_sine a (at_ w) ^ 2 = 1 /\
  0 < arm_cosine a (at_ w) * arm_cosine a (at_ (nought n)) + arm_sine a (at_ w) * arm_sine a (at_ (nought n)).
Proof.
  intros w i a hw li e at_. destruct hw as [lw nw].
  assert (IN : forall t, 0 <= t <= 1 -> inside (comb 1 t (nought n) w)).
  { intros t ht. split; [rewrite comb_length, nought_length; [reflexivity | rewrite nought_length; congruence] |]. eapply Rle_trans; [apply norm_comb |]. pose proof (nought_norm f n). pose proof (norm_nonneg f w). rewrite Rabs_R1, Rabs_pos_eq by lra. nra. }
  set (c := fun t => arm_cosine a (at_ (comb 1 t (nought n) w))). set (s := fun t => arm_sine a (at_ (comb 1 t (nought n) w))).
  set (rho := fun t => dist / mu * Linear.dot (nth i (J (comb 1 t (nought n) w)) []) w).
  assert (H : forall t, 0 <= t <= 1 -> c t ^ 2 + s t ^ 2 = 1 /\ derivable_pt_lim c t (- s t * rho t) /\ derivable_pt_lim s t (c t * rho t) /\ Rabs (rho t) < 1).
  { intros t ht. pose proof (line_rate (nought n) w t i (nought_length n) lw (IN t ht) li) as R0. cbv zeta in R0. rewrite e in R0. destruct R0 as [r1 [r2 r3]]. split; [exact r3 |]. split; [exact r1 |]. split; [exact r2 |].
    assert (E1 : Forall (fun t => -1 <= t <= 1) w) by (apply (Spread.inside_ends f n); split; assumption).
    pose proof (at_index _ _ _ _ _ (slow _ w (IN t ht) E1) i [] none ltac:(rewrite m_length; exact li)) as S. rewrite e in S. exact S. }
  assert (E0 : comb 1 0 (nought n) w = nought n).
  { rewrite line_from_nought by exact lw. apply same_entries; [rewrite map_length, nought_length; exact lw |]. intro j. rewrite map_entries, nought_entries. ring. }
  assert (E1 : comb 1 1 (nought n) w = w).
  { rewrite line_from_nought by exact lw. rewrite <- (map_id w) at 2. apply map_ext. intro. ring. }
  pose proof (turned_little c s rho H 1 ltac:(lra)) as p. destruct (H 0 ltac:(lra)) as [h0 _]. destruct (H 1 ltac:(lra)) as [h1 _].
  unfold c, s in p, h0, h1. rewrite E0 in p, h0. rewrite E1 in p, h1. auto.
Qed.

Definition values_off (u : list R) : list R := map (fun l => mu / dist * off_from (joint_off l (nought n)) (joint_off l u)) m.

Theorem legs_found : exists u, (inside u /\ values_off u = comb 1 1 (values_off (nought n)) bs) /\ forall v, inside v -> values_off v = comb 1 1 (values_off (nought n)) bs -> v = u.
Proof.
  apply (one_point f n values_off J g bs); try assumption.
  - intro u. unfold values_off. rewrite map_length. exact m_length.
  - specialize (far _ zero_inside). apply Forall_forall. intros row ir.
    destruct (In_nth _ _ [] ir) as [i [li <-]]. rewrite J_length, <- m_length in li. destruct (at_index _ _ _ _ _ far i [] none li) as [_ ->]. rewrite map_length. apply velocities_length.
  - intros u v hu hv t ht i li. set (d := less v u). pose proof (on_segment f n u v t hu hv ht) as hs. fold d in hs.
    assert (ld : length d = n) by (apply less_length; [apply hv | apply hu]).
    pose proof (line_rate u d t i (proj1 hu) ld hs li) as R0. cbv zeta in R0. set (l := nth i m none) in *. set (rho := dist / mu * Linear.dot (nth i (J (comb 1 t u d)) []) d) in *.
    assert (E : forall x, nth i (values_off (comb 1 x u d)) 0 = mu / dist * off_from (joint_off l (nought n)) (joint_off l (comb 1 x u d))).
    { intro x. unfold values_off. rewrite (nth_indep _ 0 ((fun l => mu / dist * off_from (joint_off l (nought n)) (joint_off l (comb 1 x u d))) none)) by (rewrite map_length, m_length; exact li).
      rewrite (map_nth (fun l => mu / dist * off_from (joint_off l (nought n)) (joint_off l (comb 1 x u d)))). reflexivity. }
    assert (D : derivable_pt_lim (fun x => off_from (joint_off l (nought n)) (joint_off l (comb 1 x u d))) t rho).
    { unfold joint_off. destruct l as [a | a] eqn:el; cbn [own_joint off_from].
      - eapply derivable_eq; [exact (derivable_add _ _ _ _ _ R0 (derivable_const (- joint a (carried (Linear a) (position_off (nought n)) (turn_off (nought n)))) t)) | intro x; cbv beta; ring | ring].
      - destruct R0 as [r1 [r2 r3]]. destruct (turns_little _ i a hs li el) as [o1 [o2 o3]].
        exact (turned_rate _ _ (fun x => arm_cosine a (carried (Rotary a) (position_off (comb 1 x u d)) (turn_off (comb 1 x u d)))) (fun x => arm_sine a (carried (Rotary a) (position_off (comb 1 x u d)) (turn_off (comb 1 x u d)))) t rho o1 o2 o3 r1 r2). }
    eapply derivable_eq; [exact (derivable_scal (mu / dist) _ _ _ D) | exact E |]. unfold rho. field. split; lra.
Qed.
End Recover.

(** ** The claim *)

Lemma arcsine_zero : arcsine 0 = 0.
Proof.
  pose proof PI_RGT_0 as p0. pose proof (arcsine_is 0 ltac:(lra)) as e. destruct (arcsine_between 0) as [a b].
  destruct (Rtotal_order (arcsine 0) 0) as [l | [z | r]]; [| exact z |]; exfalso.
  - assert (0 < sin (- arcsine 0)) by (apply sin_gt_0; lra). rewrite sin_neg in H. lra.
  - assert (0 < sin (arcsine 0)) by (apply sin_gt_0; lra). lra.
Qed.
Lemma not_off : forall c, off_from c c = 0.
Proof. intros [a | c s |]; cbn [off_from]; [ring | | reflexivity]. unfold turn_between. replace (s * c - c * s) with 0 by ring. exact arcsine_zero. Qed.

Section Named.
Context {names : naming}.

Lemma tangent_pos : forall angle : number, 0 < Claim.value angle -> is_angle (Claim.value angle) -> 0 < tangent (Claim.value angle).
Proof.
  intros angle a0 ia. unfold tangent. pose proof (half_cosine _ ia) as c0. apply Rmult_lt_0_compat; [| apply Rinv_0_lt_compat, c0]. destruct ia as [_ i2]. pose proof PI_RGT_0. apply sin_gt_0; unfold in_degrees; nra.
Qed.

(** Poses near another one are those that are off by u, of parts not longer than 1. *)
Lemma poses_near : forall k P Q (b angle : number) tau, 0 < Claim.value b -> 0 < tau ->
  match k with Turns _ => tau = tangent (Claim.value angle) /\ 0 < Claim.value angle /\ is_angle (Claim.value angle) | _ => True end ->
  (forall u, length u = freedom k /\ norm (places_of k) u <= 1 -> is_near_to k b angle P Q (position_off k P (Claim.value b) u) (turn_off k Q tau u)) /\
  forall P' Q', is_near_to k b angle P Q P' Q' -> exists u, (length u = freedom k /\ norm (places_of k) u <= 1) /\ position_off k P (Claim.value b) u = P' /\ turn_off k Q tau u = Q'.
Proof.
  intros k P Q b angle tau d0 t0 ht. set (dist := Claim.value b) in *.
  assert (Small : forall q, sqrt (norm2 q) <= 1 <-> norm2 q <= 1).
  { intro q. pose proof (norm2_nonneg q) as q0. split; intro h; [rewrite <- (sqrt_sqrt _ q0); pose proof (sqrt_pos (norm2 q)); nra | rewrite <- sqrt_1; apply sqrt_le_1_alt, h]. }
  assert (Sized : forall v, length v = freedom k -> norm (places_of k) v <= 1 <-> norm2 (shift_by k v) <= 1 /\ norm2 (spin_by k v) <= 1).
  { intros v lv. destruct (by_sizes k v lv) as [s1 s2]. rewrite <- !Small, <- s1, <- s2. split; [intro h; split; (eapply Rle_trans; [apply part_size | exact h]) | intros [h1 h2]; apply norm_below; intros []; assumption]. }
  assert (D : forall u, vsub (position_off k P dist u) P = vscale dist (shift_by k u)) by (intro u; unfold position_off; destruct P as [p1 p2 p3], (shift_by k u) as [q1 q2 q3]; unfold vsub, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
  assert (Near2 : forall u, length u = freedom k /\ norm (places_of k) u <= 1 -> norm2 (vsub (position_off k P dist u) P) <= dist ^ 2).
  { intros u [lu nu]. destruct (proj1 (Sized u lu) nu) as [s1 _]. rewrite D, norm2_scale. pose proof (pow2_ge_0 dist). nra. }
  assert (Z : vscale tau vzero = vzero) by (unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring). assert (NZ : norm2 vzero <= 1) by (unfold norm2, vzero; cbn; lra).
  assert (Back : forall P', vadd P (vscale dist (vscale (/ dist) (vsub P' P))) = P') by (intro P'; destruct P as [p1 p2 p3], P' as [q1 q2 q3]; unfold vadd, vsub, vscale; cbn [vx vy vz]; f_equal; field; lra).
  assert (Short : forall P', norm2 (vsub P' P) <= dist ^ 2 -> norm2 (vscale (/ dist) (vsub P' P)) <= 1).
  { intros P' h. rewrite norm2_scale. apply Rmult_le_reg_l with (dist ^ 2); [apply pow_lt, d0 |]. replace (dist ^ 2 * ((/ dist) ^ 2 * norm2 (vsub P' P))) with (norm2 (vsub P' P)) by (field; lra). lra. }
  destruct k as [| | k].
  - split.
    + intros u hu. split; [exact (Near2 u hu) |]. unfold turn_off. cbn [spin_by]. rewrite Z. apply not_moved.
    + intros P' Q' [h ->]. set (q := vscale (/ dist) (vsub P' P)). exists [vx q; vy q; vz q]. assert (E : shift_by Translates [vx q; vy q; vz q] = q) by (destruct q; reflexivity).
      split; [split; [reflexivity |]; apply (Sized [vx q; vy q; vz q] eq_refl); rewrite E; split; [exact (Short P' h) | exact NZ] |].
      split; [unfold position_off; rewrite E; apply Back | unfold turn_off; cbn [spin_by]; rewrite Z; apply not_moved].
  - split.
    + intros u hu. split; [unfold position_off; cbn [shift_by vadd vscale vz]; ring |]. split; [exact (Near2 u hu) |]. unfold turn_off. cbn [spin_by]. rewrite Z. apply not_moved.
    + intros P' Q' [hz [h ->]]. set (q := vscale (/ dist) (vsub P' P)). exists [vx q; vy q].
      assert (E : shift_by TranslatesInPlane [vx q; vy q] = q) by (unfold q, shift_by, vscale, vsub; cbn [nth vx vy vz]; rewrite hz; f_equal; ring).
      split; [split; [reflexivity |]; apply (Sized [vx q; vy q] eq_refl); rewrite E; split; [exact (Short P' h) | exact NZ] |].
      split; [unfold position_off; rewrite E; apply Back | unfold turn_off; cbn [spin_by]; rewrite Z; apply not_moved].
  - destruct ht as [et [a0 ia]]. cbn [freedom places_of is_near_to] in *. split.
    + intros u hu. destruct (proj1 (Sized u (proj1 hu)) (proj2 hu)) as [s1 s2]. destruct (parts_allowed k u) as [a1 a2]. cbn [shift_by spin_by] in *. split; [| split].
      * rewrite D. clear - a1. destruct k; cbn [is_of] in *; [destruct a1 as [e _]; unfold vscale; cbn [vx vy vz] in *; rewrite e; repeat split; ring | exact I | rewrite a1; unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring].
      * exact (Near2 u hu).
      * eexists. split; [| reflexivity]. apply turned_found; [exact a0 | exact ia | | rewrite norm2_scale, <- et; cbn [spin_by]; pose proof (pow2_ge_0 tau); nra].
        clear - a2. cbn [spin_by]. destruct k; cbn [may_turn] in *; auto. destruct a2 as [e1 e2]. unfold vscale. cbn [vx vy]. rewrite e1, e2. split; ring.
    + intros P'' Q'' [h1 [h2 [S [h3 h4]]]]. destruct (turned_coordinates k angle S a0 ia h3) as [c [c1 [c2 c3]]]. rewrite <- et in c3. fold dist in h2.
      assert (A1 : is_of k (vscale (/ dist) (vsub P'' P)) vzero) by (clear - h1; destruct k; cbn [is_of] in *; [destruct h1 as [e _]; unfold vscale; cbn [vx vy vz] in *; rewrite e; repeat split; ring | exact I | rewrite h1; unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring]).
      assert (A2 : may_turn k (vscale (/ tau) c)) by (clear - c1; destruct k; cbn [may_turn] in *; auto; destruct c1 as [e1 e2]; unfold vscale; cbn [vx vy]; rewrite e1, e2; split; ring).
      destruct (parts_exist k _ _ A1 A2) as [v [lv [e1 e2]]]. exists v. split; [split; [exact lv |]; apply (Sized v lv); cbn [shift_by spin_by]; rewrite e1, e2; split; [exact (Short P'' h2) |] |].
      { rewrite norm2_scale. apply Rmult_le_reg_l with (tau ^ 2); [apply pow_lt, t0 |]. replace (tau ^ 2 * ((/ tau) ^ 2 * norm2 c)) with (norm2 c) by (field; lra). lra. }
      split; [unfold position_off; cbn [shift_by]; rewrite e1; apply Back |]. unfold turn_off. cbn [spin_by]. rewrite e2, h4.
      assert (C : vscale tau (vscale (/ tau) c) = c) by (destruct c as [x y z]; unfold vscale; cbn [vx vy vz]; f_equal; field; lra). rewrite C. unfold moved_on. f_equal. rewrite c2.
      pose proof (norm2_nonneg c). destruct S as [[s1 s2 s3] [s4 s5 s6] [s7 s8 s9]]. unfold mscale, vscale. cbn [row1 row2 row3 vx vy vz]. f_equal; f_equal; field; lra.
Qed.

Theorem legs_recovered : forall k nominal m P Q (error b angle : number) J mu tau, let dist := Claim.value b in let n := freedom k in let f := places_of k in
  0 < mu -> 0 < dist -> 0 < tau -> match k with Turns _ => tau = tangent (Claim.value angle) /\ 0 < Claim.value angle /\ is_angle (Claim.value angle) | _ => True end ->
  length nominal = n -> length m = n -> (forall u, length (J u) = n) -> Forall well_formed_driven m ->
  (forall u, length u = n /\ norm f u <= 1 -> Forall2 (fun row l => is_far_of k mu dist tau l (position_off k P dist u) (turn_off k Q tau u) (vscale tau (spin_by k u)) row) (J u) m) ->
  (forall u v, length u = n /\ norm f u <= 1 -> Forall (fun t => -1 <= t <= 1) v -> Forall2 (fun row l => match l with Rotary _ => Rabs (dist / mu * Linear.dot row v) < 1 | Linear _ => True end) (J u) m) ->
  (forall rho, Forall2 (fun l r => is_off (Claim.value error) (own_joint l (carried l P Q)) r) nominal rho -> exists g xs, 0 <= g /\
    Forall2 (fun x lr => moves_to x (own_joint (fst lr) (carried (fst lr) P Q)) (snd lr)) xs (combine m rho) /\
    (forall u w, length u = n /\ norm f u <= 1 -> length w = n -> size (less (image (J u) w) (image (J (nought n)) w)) <= g * norm f u * norm f w) /\
    forall p, part f p (nought n) = [] \/ met f n J g (map (Rmult (mu / dist)) xs) p) ->
  legs_recover k nominal m P Q error b angle.
Proof.
  intros k nominal m P Q error b angle J mu tau dist n f mu0 d0 t0 ht ln lm lJ built far slow shown rho hr is_at.
  destruct (shown rho hr) as [g [xs [g0 [moves [spread met_]]]]]. destruct (poses_near k P Q b angle tau d0 t0 ht) as [NearBy Off]. fold dist n f in NearBy, Off.
  assert (lr : length rho = n) by (rewrite <- (related_length _ _ _ _ _ hr); exact ln).
  assert (lx : length xs = n) by (rewrite (related_length _ _ _ _ _ moves), combine_length; lia).
  assert (lb : length (map (Rmult (mu / dist)) xs) = n) by (rewrite map_length; exact lx).
  destruct (legs_found k m P Q mu dist tau g J mu0 d0 g0 lm lJ built far slow spread _ lb met_) as [u [[hu eu] only]].
  assert (P0 : position_off k P dist (nought n) = P).
  { unfold position_off. unfold n. rewrite (proj1 (nothing_off k)). destruct P as [p1 p2 p3]. unfold vadd, vscale, vzero. cbn [vx vy vz]. f_equal; ring. }
  assert (Q0 : turn_off k Q tau (nought n) = Q).
  { unfold turn_off, n. rewrite (proj2 (nothing_off k)). assert (Z : vscale tau vzero = vzero) by (unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring). rewrite Z. apply not_moved. }
  assert (Z0 : values_off k m P Q mu dist tau (nought n) = nought n).
  { unfold values_off. fold n. transitivity (map (fun _ : driven => 0) m); [apply map_ext; intro l; rewrite not_off; ring |]. unfold nought. rewrite <- lm. clear. induction m as [| l m' IH]; cbn [map repeat length]; congruence. }
  assert (OFF : Forall2 (fun x l => off_from (own_joint l (carried l P Q)) (own_joint l (carried l (position_off k P dist u) (turn_off k Q tau u))) = x) xs m).
  { fold n in eu. rewrite Z0 in eu. assert (EU : values_off k m P Q mu dist tau u = map (Rmult (mu / dist)) xs).
    { rewrite eu. apply same_entries; [rewrite comb_length; rewrite nought_length, ?map_length; congruence |]. intro i. rewrite comb_entries, nought_entries. ring. }
    unfold values_off, joint_off in EU. fold n in EU. rewrite P0, Q0 in EU. assert (mx : length xs = length m) by congruence. clear - EU mx mu0 d0. revert m mx EU.
    induction xs as [| x xs IH]; intros [| l m'] e EU; try discriminate; [constructor |]. cbn [map] in EU. injection EU as e1 e2. constructor; [| apply IH; [cbn in e; congruence | exact e2]].
    apply Rmult_eq_reg_l with (mu / dist); [exact e1 |]. apply Rgt_not_eq, Rdiv_lt_0_compat; assumption. }
  assert (TURN : forall i a, (i < n)%nat -> nth i m (Linear (Plane vzero)) = Rotary a -> let at_ u := carried (Rotary a) (position_off k P dist u) (turn_off k Q tau u) in
    arm_cosine a (at_ (nought n)) ^ 2 + arm_sine a (at_ (nought n)) ^ 2 = 1 /\ arm_cosine a (at_ u) ^ 2 + arm_sine a (at_ u) ^ 2 = 1 /\
    0 < arm_cosine a (at_ u) * arm_cosine a (at_ (nought n)) + arm_sine a (at_ u) * arm_sine a (at_ (nought n)))
    by (intros i a li e; exact (turns_little k m P Q mu dist tau J mu0 d0 lm built far slow u i a hu li e)).
  assert (SAME : Forall2 (fun l r => own_reach l (carried l (position_off k P dist u) (turn_off k Q tau u)) /\ own_joint l (carried l (position_off k P dist u) (turn_off k Q tau u)) = r) m rho).
  { assert (RE : Forall (fun l => own_reach l (carried l (position_off k P dist u) (turn_off k Q tau u))) m).
    { specialize (far u hu). clear - far. induction far as [| row l rs m' [h _] hs IH]; constructor; assumption. }
    assert (TURN' : Forall (fun l => match l with Rotary a => let at_ u := carried l (position_off k P dist u) (turn_off k Q tau u) in
      arm_cosine a (carried l P Q) ^ 2 + arm_sine a (carried l P Q) ^ 2 = 1 /\ arm_cosine a (at_ u) ^ 2 + arm_sine a (at_ u) ^ 2 = 1 /\
      0 < arm_cosine a (at_ u) * arm_cosine a (carried l P Q) + arm_sine a (at_ u) * arm_sine a (carried l P Q) | _ => True end) m).
    { apply Forall_forall. intros l il. destruct (In_nth _ _ (Linear (Plane vzero)) il) as [i [li e]]. destruct l as [a | a]; [exact I |]. cbv beta zeta. rewrite lm in li. specialize (TURN i a li e). cbv beta zeta in TURN. rewrite P0, Q0 in TURN. exact TURN. }
    assert (mr : length m = length rho) by congruence. clear - RE TURN' OFF moves mr. revert rho mr moves. induction OFF as [| x l xs m' hx hs IH]; intros [| r rho] e moves; try discriminate; [constructor |].
    inversion RE; inversion TURN'; inversion moves as [| ? ? ? ? mv mvs]; subst. constructor; [| apply IH; auto]. split; [assumption |]. cbn [fst snd] in mv.
    destruct l as [a | a]; cbn [own_joint off_from moves_to] in *; destruct r as [y | c s |]; try contradiction.
    - f_equal. lra.
    - cbv zeta in *. match goal with h : _ = 1 /\ _ = 1 /\ 0 < _ |- _ => destruct h as [t1 [t2 t3]] end. destruct (turned_angle _ _ _ _ t1 t2 t3) as [_ [_ [t4 t5]]]. destruct mv as [m1 m2]. f_equal; congruence. }
  exists (position_off k P dist u), (turn_off k Q tau u). split; [split; [exact (NearBy u hu) | exact SAME] |].
  intros P'' Q'' [near'' same'']. destruct (Off P'' Q'' near'') as [v [hv [ep eq_]]]. assert (V : v = u); [| rewrite <- ep, <- eq_, V; split; reflexivity].
  apply only; [exact hv |]. rewrite <- eu. unfold values_off, joint_off. fold n. rewrite ep, eq_. clear - SAME same''. revert same''.
  induction SAME as [| l r m' rho [_ h] hs IH]; intro same''; [reflexivity |]. inversion same'' as [| ? ? ? ? [_ h2] h3]; subst. cbn [map]. rewrite h2. f_equal. apply IH, h3.
Qed.
End Named.
