(** * Platforms that are turned on

    By the rotation with the half-angle tangents c, after the one that they are turned by: R b becomes
    r + 2 (c x r + c x (c x r))/(1 + |c|^2), r = R b, and along c the angular velocity is 2 (c' + c x c')/(1 + |c|^2)
    (machine/motion.rs). A strut's length has the derivatives [u, 2 (mu + mu x c)/(1 + |c|^2)] by the position and by c, mu = r x u. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Solve Test.
From Orthocert.kernel Require Import Linear Solve Twofold OnePose Configuration Statement Number Trig Formula Machine Orientation Turning Chart Bend.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** Kinematics *)

Definition onward (c r : vec) : vec := vadd r (vscale (2 / (1 + norm2 c)) (vadd (cross c r) (cross c (cross c r)))).
Definition moved_on (c : vec) (Q : mat) : mat := mulm (mscale (/ (1 + norm2 c)) (rodrigues c)) Q.

Lemma moved_on_onward : forall c Q b, mulv (moved_on c Q) b = onward c (mulv Q b).
Proof.
  intros c Q b. unfold moved_on. rewrite mulv_mulm. set (r := mulv Q b). clearbody r. pose proof (norm2_nonneg c) as p. destruct c as [x y z], r as [a b' d].
  unfold onward, rodrigues, mscale, mulv, Vec3.dot, vadd, vscale, cross, norm2 in *. cbn [vx vy vz row1 row2 row3] in *. f_equal; field; lra.
Qed.

(** Quotients of polynomials of degree two. *)
Lemma quotient_rate : forall a p0 p1 p2 q0 q1 q2 t, q0 + q1 * t + q2 * t ^ 2 <> 0 ->
  derivable_pt_lim (fun u => a + 2 / (q0 + q1 * u + q2 * u ^ 2) * (p0 + p1 * u + p2 * u ^ 2)) t
    (2 * ((p1 + 2 * p2 * t) * (q0 + q1 * t + q2 * t ^ 2) - (p0 + p1 * t + p2 * t ^ 2) * (q1 + 2 * q2 * t)) / (q0 + q1 * t + q2 * t ^ 2) ^ 2).
Proof.
  intros a p0 p1 p2 q0 q1 q2 t n0.
  assert (P : forall a b c, derivable_pt_lim (fun u => a + b * u + c * u ^ 2) t (b + 2 * c * t)).
  { intros b c d. eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_add _ _ _ _ _ (derivable_const b t) (derivable_scal c _ _ _ (derivable_pt_lim_id t))) (derivable_scal d _ _ _ (derivable_square _ _ _ (derivable_pt_lim_id t)))) | |].
    - intro u. unfold id. ring.
    - unfold id. ring. }
  eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_const a t) (derivable_scal 2 _ _ _ (derivable_pt_lim_div _ _ _ _ _ (P p0 p1 p2) (P q0 q1 q2) n0))) | |].
  - intro u. unfold div_fct. unfold Rdiv. ring.
  - unfold Rsqr. field. exact n0.
Qed.

Lemma onward_velocity : forall c d r t, let C := vadd c (vscale t d) in
  has_velocity (fun u => onward (vadd c (vscale u d)) r) t (cross (vscale (2 / (1 + norm2 C)) (vadd d (cross C d))) (onward C r)).
Proof.
  intros c d r t C. pose proof (norm2_nonneg C) as n0. assert (E : norm2 C = norm2 c + 2 * Vec3.dot c d * t + norm2 d * t ^ 2) by (unfold C, norm2, Vec3.dot, vadd, vscale; cbn [vx vy vz]; ring).
  destruct c as [c1 c2 c3], d as [d1 d2 d3], r as [r1 r2 r3]. unfold C in *. unfold norm2, Vec3.dot, vadd, vscale in E, n0. cbn [vx vy vz] in E, n0.
  set (q0 := 1 + (c1 ^ 2 + c2 ^ 2 + c3 ^ 2)) in *. set (q1 := 2 * (c1 * d1 + c2 * d2 + c3 * d3)) in *. set (q2 := d1 ^ 2 + d2 ^ 2 + d3 ^ 2) in *.
  assert (N : q0 + q1 * t + q2 * t ^ 2 <> 0) by (unfold q0; lra).
  assert (K : forall (f : vec -> R) a p0 p1 p2 v, (forall u, f (onward (vadd (Vec c1 c2 c3) (vscale u (Vec d1 d2 d3))) (Vec r1 r2 r3)) = a + 2 / (q0 + q1 * u + q2 * u ^ 2) * (p0 + p1 * u + p2 * u ^ 2)) ->
    v = 2 * ((p1 + 2 * p2 * t) * (q0 + q1 * t + q2 * t ^ 2) - (p0 + p1 * t + p2 * t ^ 2) * (q1 + 2 * q2 * t)) / (q0 + q1 * t + q2 * t ^ 2) ^ 2 ->
    derivable_pt_lim (fun u => f (onward (vadd (Vec c1 c2 c3) (vscale u (Vec d1 d2 d3))) (Vec r1 r2 r3))) t v).
  { intros f a p0 p1 p2 v h e. eapply derivable_eq; [exact (quotient_rate a p0 p1 p2 q0 q1 q2 t N) | exact h | exact e]. }
  assert (D : forall u, 1 + norm2 (vadd (Vec c1 c2 c3) (vscale u (Vec d1 d2 d3))) = q0 + q1 * u + q2 * u ^ 2) by (intro u; unfold q0, q1, q2, norm2, vadd, vscale; cbn [vx vy vz]; ring).
  repeat split; cbn [vx vy vz].
  - eapply (K vx r1 ((c2 * r3 - c3 * r2) + (c2 * (c1 * r2 - c2 * r1) - c3 * (c3 * r1 - c1 * r3)))
      ((d2 * r3 - d3 * r2) + (d2 * (c1 * r2 - c2 * r1) - d3 * (c3 * r1 - c1 * r3)) + (c2 * (d1 * r2 - d2 * r1) - c3 * (d3 * r1 - d1 * r3)))
      (d2 * (d1 * r2 - d2 * r1) - d3 * (d3 * r1 - d1 * r3))).
    + intro u. unfold onward. rewrite D. unfold vadd, vscale, cross. cbn [vx vy vz]. ring.
    + unfold onward. rewrite D. unfold vadd, vscale, cross. cbn [vx vy vz]. unfold q0, q1, q2 in *. field. exact N.
  - eapply (K vy r2 ((c3 * r1 - c1 * r3) + (c3 * (c2 * r3 - c3 * r2) - c1 * (c1 * r2 - c2 * r1)))
      ((d3 * r1 - d1 * r3) + (d3 * (c2 * r3 - c3 * r2) - d1 * (c1 * r2 - c2 * r1)) + (c3 * (d2 * r3 - d3 * r2) - c1 * (d1 * r2 - d2 * r1)))
      (d3 * (d2 * r3 - d3 * r2) - d1 * (d1 * r2 - d2 * r1))).
    + intro u. unfold onward. rewrite D. unfold vadd, vscale, cross. cbn [vx vy vz]. ring.
    + unfold onward. rewrite D. unfold vadd, vscale, cross. cbn [vx vy vz]. unfold q0, q1, q2 in *. field. exact N.
  - eapply (K vz r3 ((c1 * r2 - c2 * r1) + (c1 * (c3 * r1 - c1 * r3) - c2 * (c2 * r3 - c3 * r2)))
      ((d1 * r2 - d2 * r1) + (d1 * (c3 * r1 - c1 * r3) - d2 * (c2 * r3 - c3 * r2)) + (c1 * (d3 * r1 - d1 * r3) - c2 * (d2 * r3 - d3 * r2)))
      (d1 * (d3 * r1 - d1 * r3) - d2 * (d2 * r3 - d3 * r2))).
    + intro u. unfold onward. rewrite D. unfold vadd, vscale, cross. cbn [vx vy vz]. ring.
    + unfold onward. rewrite D. unfold vadd, vscale, cross. cbn [vx vy vz]. unfold q0, q1, q2 in *. field. exact N.
Qed.

Lemma moves_on : forall c d Q t, let C := vadd c (vscale t d) in
  turns (fun u => moved_on (vadd c (vscale u d)) Q) t (vscale (2 / (1 + norm2 C)) (vadd d (cross C d))).
Proof.
  intros c d Q t C b. destruct (onward_velocity c d (mulv Q b) t) as [h1 [h2 h3]]. rewrite moved_on_onward.
  assert (K : forall (g : vec -> R) v, derivable_pt_lim (fun u => g (onward (vadd c (vscale u d)) (mulv Q b))) t v -> derivable_pt_lim (fun u => g (mulv (moved_on (vadd c (vscale u d)) Q) b)) t v)
    by (intros g v h; eapply derivable_eq; [exact h | intro u; cbv beta; rewrite moved_on_onward; reflexivity | reflexivity]).
  repeat split; apply K; assumption.
Qed.

(** ** The parts of what a pose is off by *)

Definition shift_of (k : motion) (u : list R) : vec :=
  match k with InPlane => Vec (nth 0 u 0) (nth 1 u 0) 0 | InSpace => Vec (nth 0 u 0) (nth 1 u 0) (nth 2 u 0) | AboutPoint => vzero end.
Definition spin_of (k : motion) (u : list R) : vec :=
  match k with InPlane => Vec 0 0 (nth 2 u 0) | InSpace => Vec (nth 3 u 0) (nth 4 u 0) (nth 5 u 0) | AboutPoint => Vec (nth 0 u 0) (nth 1 u 0) (nth 2 u 0) end.
Definition first_angle (k : motion) : nat := match k with InPlane => 2 | InSpace => 3 | AboutPoint => 0 end.
Definition may_turn (k : motion) (c : vec) : Prop := match k with InPlane => vx c = 0 /\ vy c = 0 | _ => True end.

Lemma parts_linear : forall k a b u v, shift_of k (comb a b u v) = vadd (vscale a (shift_of k u)) (vscale b (shift_of k v)) /\ spin_of k (comb a b u v) = vadd (vscale a (spin_of k u)) (vscale b (spin_of k v)).
Proof. intros k a b u v. destruct k; unfold shift_of, spin_of, vadd, vscale, vzero; cbn [vx vy vz]; rewrite ?comb_entries; split; f_equal; ring. Qed.
Lemma twist_parts : forall k a c u, length u = dimension k -> Linear.dot (twist k a c) u = Vec3.dot a (shift_of k u) + Vec3.dot c (spin_of k u).
Proof.
  intros k a c u l. destruct k; cbn [dimension] in l.
  - destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. unfold twist, shift_of, spin_of, Vec3.dot. cbn. ring.
  - destruct u as [| u1 [| u2 [| u3 [| u4 [| u5 [| u6 [|]]]]]]]; try discriminate. unfold twist, shift_of, spin_of, Vec3.dot. cbn. ring.
  - destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. unfold twist, shift_of, spin_of, Vec3.dot, vzero. cbn. ring.
Qed.
Lemma parts_sizes : forall k u, length u = dimension k ->
  size (part (first_angle k) false u) = sqrt (norm2 (shift_of k u)) /\ size (part (first_angle k) true u) = sqrt (norm2 (spin_of k u)).
Proof.
  intros k u l. unfold size. destruct k; cbn [dimension] in l.
  - destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. split; f_equal; unfold norm2, part; cbn; ring.
  - destruct u as [| u1 [| u2 [| u3 [| u4 [| u5 [| u6 [|]]]]]]]; try discriminate. split; f_equal; unfold norm2, part; cbn; ring.
  - destruct u as [| u1 [| u2 [| u3 [|]]]]; try discriminate. split; f_equal; unfold norm2, part; cbn; ring.
Qed.
Lemma parts_exist : forall k v c, is_of k v vzero -> may_turn k c -> exists u, length u = dimension k /\ shift_of k u = v /\ spin_of k u = c.
Proof.
  intros k [v1 v2 v3] [c1 c2 c3] hv hc. destruct k; cbn [is_of may_turn vx vy vz] in *.
  - destruct hv as [-> _], hc as [-> ->]. exists [v1; v2; c3]. repeat split.
  - exists [v1; v2; v3; c1; c2; c3]. repeat split.
  - injection hv as -> -> ->. exists [c1; c2; c3]. repeat split.
Qed.
Lemma parts_allowed : forall k u, is_of k (shift_of k u) vzero /\ may_turn k (spin_of k u).
Proof. intros k u. destruct k; cbn; auto. Qed.
Lemma parts_same : forall k u v, length u = dimension k -> length v = dimension k -> shift_of k u = shift_of k v -> spin_of k u = spin_of k v -> u = v.
Proof.
  intros k u v lu lv es et. destruct k; cbn [dimension] in lu, lv.
  - destruct u as [| u1 [| u2 [| u3 [|]]]], v as [| v1 [| v2 [| v3 [|]]]]; try discriminate. injection es as -> ->. injection et as ->. reflexivity.
  - destruct u as [| u1 [| u2 [| u3 [| u4 [| u5 [| u6 [|]]]]]]], v as [| v1 [| v2 [| v3 [| v4 [| v5 [| v6 [|]]]]]]]; try discriminate. injection es as -> -> ->. injection et as -> -> ->. reflexivity.
  - destruct u as [| u1 [| u2 [| u3 [|]]]], v as [| v1 [| v2 [| v3 [|]]]]; try discriminate. injection et as -> -> ->. reflexivity.
Qed.

(** ** The one pose *)

Lemma at_index : forall (A B : Type) (T : A -> B -> Prop) l m, Forall2 T l m -> forall i a b, (i < length m)%nat -> T (nth i l a) (nth i m b).
Proof. induction 1 as [| x y l m h hs IH]; intros [| i] a b li; cbn in *; try lia; [exact h | apply IH; lia]. Qed.

Section Recover.
Variables (k : motion) (m : list strut) (P : vec) (Q : mat) (dist tau g : R) (J : list R -> list (list R)).
Hypothesis dist_pos : 0 < dist.
Hypothesis tau_pos : 0 < tau.
Hypothesis g_nonneg : 0 <= g.
Local Notation n := (dimension k).
Local Notation f := (first_angle k).
Local Notation inside u := (length u = n /\ norm f u <= 1).
Hypothesis m_length : length m = n.
Hypothesis J_length : forall u, length (J u) = n.
(** Where it is off by u. *)
Definition position_at (u : list R) : vec := vadd P (vscale dist (shift_of k u)).
Definition turn_at (u : list R) : mat := moved_on (vscale tau (spin_of k u)) Q.
Definition is_far_row (l : strut) (P' : vec) (Q' : mat) (C : vec) (row : list R) : Prop :=
  let unit := normalised (strut_vector l P' Q') in let mu := cross (arm_of_joint l Q') unit in
  0 < norm2 (strut_vector l P' Q') /\ row = twist k unit (vscale (tau / dist * (2 / (1 + norm2 C))) (vadd mu (cross mu C))).
Hypothesis far : forall u, inside u -> Forall2 (fun row l => is_far_row l (position_at u) (turn_at u) (vscale tau (spin_of k u)) row) (J u) m.
Hypothesis spread : forall u w, inside u -> length w = n -> size (less (image (J u) w) (image (J (nought n)) w)) <= g * norm f u * norm f w.
Variable bs : list R.
Hypothesis bs_length : length bs = n.
Hypothesis each_met : forall p, part f p (nought n) = [] \/ met f n J g bs p.

Definition lengths_at (u : list R) : list R := map (fun l => strut_length l (position_at u) (turn_at u) / dist) m.

Lemma rate_of_length : forall u r h C (v : vec) w, dist <> 0 ->
  / dist * Vec3.dot u (vadd (vscale dist v) (cross (vscale h (vadd (vscale tau w) (cross C (vscale tau w)))) r)) =
  Vec3.dot u v + Vec3.dot (vscale (tau / dist * h) (vadd (cross r u) (cross (cross r u) C))) w.
Proof.
  intros u r h C v w d0. set (mu := cross r u).
  assert (E : Vec3.dot u (cross (vscale h (vadd (vscale tau w) (cross C (vscale tau w)))) r) = h * tau * (Vec3.dot mu w + Vec3.dot (cross mu C) w)).
  { unfold mu. destruct u as [u1 u2 u3], r as [r1 r2 r3], C as [c1 c2 c3], w as [w1 w2 w3]. unfold Vec3.dot, vadd, vscale, cross. cbn [vx vy vz]. ring. }
  assert (D : forall a b c, Vec3.dot a (vadd b c) = Vec3.dot a b + Vec3.dot a c) by (intros [a1 a2 a3] [b1 b2 b3] [c1 c2 c3]; unfold Vec3.dot, vadd; cbn [vx vy vz]; ring).
  assert (D2 : forall a b c, Vec3.dot (vadd b c) a = Vec3.dot b a + Vec3.dot c a) by (intros [a1 a2 a3] [b1 b2 b3] [c1 c2 c3]; unfold Vec3.dot, vadd; cbn [vx vy vz]; ring).
  assert (S : forall q a b, Vec3.dot a (vscale q b) = q * Vec3.dot a b) by (intros q [a1 a2 a3] [b1 b2 b3]; unfold Vec3.dot, vscale; cbn [vx vy vz]; ring).
  assert (S2 : forall q a b, Vec3.dot (vscale q b) a = q * Vec3.dot b a) by (intros q [a1 a2 a3] [b1 b2 b3]; unfold Vec3.dot, vscale; cbn [vx vy vz]; ring).
  rewrite D, S, E, S2, D2. field. exact d0.
Qed.

Theorem pose_recovered : exists u, (inside u /\ lengths_at u = comb 1 1 (lengths_at (nought n)) bs) /\ forall v, inside v -> lengths_at v = comb 1 1 (lengths_at (nought n)) bs -> v = u.
Proof.
  apply (one_point f n lengths_at J g bs); try assumption.
  - intro u. unfold lengths_at. rewrite map_length. exact m_length.
  - assert (z : inside (nought n)) by (split; [apply nought_length | pose proof (nought_norm f n); lra]). specialize (far _ z). apply Forall_forall. intros row ir.
    destruct (In_nth _ _ [] ir) as [i [li <-]]. rewrite J_length, <- m_length in li. destruct (at_index _ _ _ _ _ far i [] (Strut vzero vzero) li) as [_ ->]. destruct k; reflexivity.
  - intros u v hu hv t ht i li. set (d := less v u). pose proof (on_segment f n u v t hu hv ht) as hs. fold d in hs.
    rewrite <- m_length in li. destruct (at_index _ _ _ _ _ (far _ hs) i [] (Strut vzero vzero) li) as [reach row]. set (l := nth i m (Strut vzero vzero)) in *.
    assert (EP : forall x, position_at (comb 1 x u d) = vadd (position_at u) (vscale x (vscale dist (shift_of k d)))).
    { intro x. unfold position_at. rewrite (proj1 (parts_linear k 1 x u d)). generalize (shift_of k u) (shift_of k d). intros [a1 a2 a3] [b1 b2 b3]. unfold vadd, vscale. cbn [vx vy vz]. f_equal; ring. }
    assert (EC : forall x, vscale tau (spin_of k (comb 1 x u d)) = vadd (vscale tau (spin_of k u)) (vscale x (vscale tau (spin_of k d)))).
    { intro x. rewrite (proj2 (parts_linear k 1 x u d)). generalize (spin_of k u) (spin_of k d). intros [a1 a2 a3] [b1 b2 b3]. unfold vadd, vscale. cbn [vx vy vz]. f_equal; ring. }
    set (C := vscale tau (spin_of k (comb 1 t u d))) in *. set (omega := vscale (2 / (1 + norm2 C)) (vadd (vscale tau (spin_of k d)) (cross C (vscale tau (spin_of k d))))).
    assert (HP : has_velocity (fun x => position_at (comb 1 x u d)) t (vscale dist (shift_of k d))).
    { assert (K : forall a b, derivable_pt_lim (fun x => a + x * b) t b).
      { intros a b. eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_const a t) (derivable_scal b _ _ _ (derivable_pt_lim_id t))) | intro x; unfold id; ring | ring]. }
      repeat split; cbn [vx vy vz vscale]; (eapply derivable_eq; [apply K | intro x; rewrite EP; cbn [vadd vscale vx vy vz]; reflexivity | reflexivity]). }
    assert (HQ : turns (fun x => turn_at (comb 1 x u d)) t omega).
    { intro b. pose proof (moves_on (vscale tau (spin_of k u)) (vscale tau (spin_of k d)) Q t b) as M. cbv beta zeta in M. rewrite <- EC in M. fold C in M. fold omega in M.
      destruct M as [m1 [m2 m3]].
      assert (K : forall (h : vec -> R) r, derivable_pt_lim (fun x => h (mulv (moved_on (vadd (vscale tau (spin_of k u)) (vscale x (vscale tau (spin_of k d)))) Q) b)) t r ->
        derivable_pt_lim (fun x => h (mulv (turn_at (comb 1 x u d)) b)) t r)
        by (intros h r hr; eapply derivable_eq; [exact hr | intro x; unfold turn_at; rewrite EC; reflexivity | reflexivity]).
      split; [exact (K vx _ m1) | split; [exact (K vy _ m2) | exact (K vz _ m3)]]. }
    assert (OF : is_of k (vscale dist (shift_of k d)) omega).
    { unfold omega, C. destruct k; cbn [is_of shift_of spin_of]; unfold vscale, vadd, cross, vzero; cbn [vx vy vz]; [repeat split; ring | exact I | f_equal; ring]. }
    pose proof (length_velocity k 1 l _ _ t _ omega ltac:(lra) reach HP HQ OF) as D. cbv beta in D. unfold strut_row in D. cbv zeta in D. rewrite twist_dot in D by lra.
    destruct (own_parts k _ _ OF) as [o1 o2]. rewrite o1, o2 in D.
    eapply derivable_eq; [exact (derivable_scal (/ dist) _ _ _ D) | |].
    + intro x. unfold lengths_at. rewrite (nth_indep _ 0 ((fun l => strut_length l (position_at (comb 1 x u d)) (turn_at (comb 1 x u d)) / dist) (Strut vzero vzero))) by (rewrite map_length; exact li).
      rewrite (map_nth (fun l => strut_length l (position_at (comb 1 x u d)) (turn_at (comb 1 x u d)) / dist)). fold l. unfold Rdiv. ring.
    + rewrite row. rewrite twist_parts by (unfold d; apply less_length; [apply hv | apply hu]). unfold omega. symmetry. apply rate_of_length. lra.
Qed.
End Recover.

(** ** Rotations by less than half a turn *)

Section Named.
Context {names : naming}.

Lemma turned_coordinates : forall k (angle : number) S, 0 < Claim.value angle -> is_angle (Claim.value angle) -> in_orientations (turned_by_less k angle) S ->
  exists c, may_turn k c /\ rodrigues c = mscale (1 + norm2 c) S /\ norm2 c <= tangent (Claim.value angle) ^ 2.
Proof.
  intros k angle S a0 ia h. destruct k; cbn [turned_by_less may_turn] in *; try (destruct (up_to_coordinates angle S h ia) as [c [h1 h2]]; exists c; auto).
  destruct h as [a [ha ->]]. unfold within, either_way in ha. cbn [least greatest Claim.value] in ha.
  assert (I : is_angle a) by (destruct ia; split; cbn in *; lra). exists (vscale (tangent a) e3). split; [split; unfold vscale, e3; cbn; ring |].
  split; [rewrite <- (proj2 (proj2 (rotation_about_axes (in_degrees a)))); apply rodrigues_about; [unfold norm2, e3; cbn; ring | apply tangent_is, I] |].
  rewrite norm2_scale. assert (E : norm2 e3 = 1) by (unfold norm2, e3; cbn; ring). rewrite E, Rmult_1_r.
  assert (IM : is_angle (- Claim.value angle)) by (destruct ia; split; lra).
  pose proof (tangent_increases _ _ I ia ltac:(cbn in *; lra)). pose proof (tangent_increases _ _ IM I ltac:(cbn in *; lra)) as L. rewrite tangent_opposite in L by exact ia. nra.
Qed.
Lemma turned_found : forall k (angle : number) c, 0 < Claim.value angle -> is_angle (Claim.value angle) -> may_turn k c -> norm2 c <= tangent (Claim.value angle) ^ 2 ->
  in_orientations (turned_by_less k angle) (mscale (/ (1 + norm2 c)) (rodrigues c)).
Proof.
  intros k angle c a0 ia hc le. pose proof (norm2_nonneg c) as c0.
  assert (Inv : forall S, rodrigues c = mscale (1 + norm2 c) S -> mscale (/ (1 + norm2 c)) (rodrigues c) = S).
  { intros S ->. generalize dependent (norm2 c). intros n _ n0. destruct S as [[a b d] [e f g] [h i j]]. unfold mscale, vscale. cbn [row1 row2 row3 vx vy vz]. f_equal; f_equal; field; lra. }
  assert (Up : in_orientations (TurnedUpTo angle) (mscale (/ (1 + norm2 c)) (rodrigues c))) by (destruct (up_to_found angle c (Rlt_le _ _ a0) ia le) as [S [h1 h2]]; rewrite (Inv S h2); exact h1).
  destruct k; cbn [turned_by_less may_turn] in *; try exact Up. clear Up.
  destruct c as [c1 c2 t]. cbn [vx vy] in hc. destruct hc as [-> ->]. pose proof (tangent_nonneg _ (Rlt_le _ _ a0) ia) as t0.
  assert (N : norm2 (Vec 0 0 t) = t ^ 2) by (unfold norm2; cbn; ring). rewrite N in le. pose proof (square_between _ _ t0 le) as B.
  assert (X : exists a, - Claim.value angle <= a <= Claim.value angle /\ is_half_tangent t a).
  { apply half_tangent_between; [lra | |]; unfold excess.
    - assert (IM : is_angle (- Claim.value angle)) by (destruct ia; split; lra). pose proof (half_cosine _ IM) as p. pose proof (tangent_opposite _ ia) as T. unfold tangent at 1 in T.
      assert (E : sin (in_degrees (- Claim.value angle / 2)) = - tangent (Claim.value angle) * cos (in_degrees (- Claim.value angle / 2))) by (rewrite <- T; field; lra). rewrite E. nra.
    - pose proof (half_cosine _ ia) as p. assert (E : sin (in_degrees (Claim.value angle / 2)) = tangent (Claim.value angle) * cos (in_degrees (Claim.value angle / 2))) by (unfold tangent; field; lra). rewrite E. nra. }
  destruct X as [a [ha h]]. exists a. split; [unfold within, either_way; cbn [least greatest Claim.value]; lra |]. apply Inv.
  replace (Vec 0 0 t) with (vscale t e3) by (unfold vscale, e3; cbn; f_equal; ring). rewrite <- (proj2 (proj2 (rotation_about_axes (in_degrees a)))).
  apply rodrigues_about; [unfold norm2, e3; cbn; ring | exact h].
Qed.

Lemma not_moved : forall Q, moved_on vzero Q = Q.
Proof.
  intros [[a b c] [d e f] [g h i]]. unfold moved_on, rodrigues, mscale, mulm, mulv, transpose, col1, col2, col3, Vec3.dot, norm2, vscale, vzero. cbn [vx vy vz row1 row2 row3].
  f_equal; f_equal; field; lra.
Qed.
Definition offsets (m : list strut) (P : vec) (Q : mat) (dist : R) (rho : list R) : list R := map (fun p => (snd p - strut_length (fst p) P Q) / dist) (combine m rho).

Theorem struts_recovered : forall k nominal m P Q (error b angle : number) J, let dist := Claim.value b in let tau := tangent (Claim.value angle) in let n := dimension k in
  0 < dist -> 0 < Claim.value angle -> is_angle (Claim.value angle) -> length nominal = n -> length m = n -> (forall u, length (J u) = n) ->
  (forall u, length u = n /\ norm (first_angle k) u <= 1 ->
    Forall2 (fun row l => is_far_row k dist tau l (position_at k P dist u) (turn_at k Q tau u) (vscale tau (spin_of k u)) row) (J u) m) ->
  (forall rho, Forall2 (fun l r => Rabs (r - strut_length l P Q) <= Claim.value error) nominal rho -> exists g, 0 <= g /\
    (forall u w, length u = n /\ norm (first_angle k) u <= 1 -> length w = n -> size (less (image (J u) w) (image (J (nought n)) w)) <= g * norm (first_angle k) u * norm (first_angle k) w) /\
    forall p, part (first_angle k) p (nought n) = [] \/ met (first_angle k) n J g (offsets m P Q dist rho) p) ->
  struts_recover k nominal m P Q error b angle.
Proof.
  intros k nominal m P Q error b angle J dist tau n d0 a0 ia ln lm lJ far shown rho hr is_at.
  assert (t0 : 0 < tau).
  { unfold tau, tangent. pose proof (half_cosine _ ia) as c0. apply Rmult_lt_0_compat; [| apply Rinv_0_lt_compat, c0]. destruct ia as [_ i2]. pose proof PI_RGT_0. apply sin_gt_0; unfold in_degrees; nra. }
  destruct (shown rho hr) as [g [g0 [spread met_]]]. set (bs := offsets m P Q dist rho) in *.
  assert (lr : length rho = n) by (rewrite <- (related_length _ _ _ _ _ hr); exact ln).
  assert (lb : length bs = n) by (unfold bs, offsets; rewrite map_length, combine_length; lia).
  destruct (pose_recovered k m P Q dist tau g J d0 g0 lm lJ far spread bs lb met_) as [u [[hu eu] only]].
  assert (P0 : position_at k P dist (nought n) = P).
  { unfold position_at. assert (Z : shift_of k (nought n) = vzero) by (unfold n; destruct k; reflexivity). rewrite Z. destruct P as [p1 p2 p3]. unfold vadd, vscale, vzero. cbn [vx vy vz]. f_equal; ring. }
  assert (Q0 : turn_at k Q tau (nought n) = Q).
  { unfold turn_at. assert (Z : vscale tau (spin_of k (nought n)) = vzero) by (assert (Z : spin_of k (nought n) = vzero) by (unfold n; destruct k; reflexivity); rewrite Z; unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring). rewrite Z. apply not_moved. }
  assert (Same : forall v, length v = n -> lengths_at k m P Q dist tau v = comb 1 1 (lengths_at k m P Q dist tau (nought n)) bs <->
    Forall2 (fun l r => strut_length l (position_at k P dist v) (turn_at k Q tau v) = r) m rho).
  { intros v lv. unfold lengths_at. rewrite P0, Q0. unfold bs, offsets. generalize (position_at k P dist v) (turn_at k Q tau v). intros P' Q'.
    rewrite <- lr in lm. clear - lm d0. revert rho lm. induction m as [| l m' IH]; intros [| r rho] e; try discriminate; [split; [constructor | reflexivity] |].
    cbn [combine map comb merge fst snd]. fold (comb 1 1). specialize (IH rho ltac:(cbn in e; congruence)). split; intro h.
    - injection h as h1 h2. constructor; [| apply IH, h2]. apply Rmult_eq_reg_r with (/ dist); [| apply Rinv_neq_0_compat; lra]. unfold Rdiv in h1. lra.
    - inversion h as [| ? ? ? ? h1 h2]; subst. f_equal; [unfold Rdiv; ring | apply IH, h2]. }
  assert (Reach : forall v, length v = n /\ norm (first_angle k) v <= 1 -> Forall (fun l => 0 < norm2 (strut_vector l (position_at k P dist v) (turn_at k Q tau v))) m).
  { intros v hv. specialize (far v hv). clear - far. induction far as [| row l rs m' [h _] hs IH]; constructor; assumption. }
  assert (Both : forall v, length v = n /\ norm (first_angle k) v <= 1 -> lengths_at k m P Q dist tau v = comb 1 1 (lengths_at k m P Q dist tau (nought n)) bs ->
    Forall2 (fun l r => 0 < norm2 (strut_vector l (position_at k P dist v) (turn_at k Q tau v)) /\ strut_length l (position_at k P dist v) (turn_at k Q tau v) = r) m rho).
  { intros v hv ev. apply (Same v (proj1 hv)) in ev. specialize (Reach v hv). clear - ev Reach. induction ev as [| l r m' rho h hs IH]; constructor; inversion Reach; subst; auto. }
  assert (Small : forall q, sqrt (norm2 q) <= 1 <-> norm2 q <= 1).
  { intro q. pose proof (norm2_nonneg q) as q0. split; intro h; [rewrite <- (sqrt_sqrt _ q0); pose proof (sqrt_pos (norm2 q)); nra | rewrite <- sqrt_1; apply sqrt_le_1_alt, h]. }
  assert (Sized : forall v, length v = n -> norm (first_angle k) v <= 1 <-> norm2 (shift_of k v) <= 1 /\ norm2 (spin_of k v) <= 1).
  { intros v lv. destruct (parts_sizes k v lv) as [s1 s2]. rewrite <- !Small, <- s1, <- s2. split; [intro h; split; (eapply Rle_trans; [apply part_size | exact h]) | intros [h1 h2]; apply norm_below; intros []; assumption]. }
  exists (position_at k P dist u), (turn_at k Q tau u). split.
  - split; [| apply Both; assumption]. destruct (proj1 (Sized u (proj1 hu)) (proj2 hu)) as [s1 s2]. destruct (parts_allowed k u) as [a1 a2].
    assert (D : vsub (position_at k P dist u) P = vscale dist (shift_of k u)) by (unfold position_at; destruct P as [p1 p2 p3], (shift_of k u) as [q1 q2 q3]; unfold vsub, vadd, vscale; cbn [vx vy vz]; f_equal; ring).
    split; [| split].
    + rewrite D. clear - a1. destruct k; cbn [is_of] in *; [destruct a1 as [e _]; unfold vscale; cbn [vx vy vz] in *; rewrite e; repeat split; ring | exact I | rewrite a1; unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring].
    + rewrite D, norm2_scale. fold dist. pose proof (pow2_ge_0 dist). nra.
    + eexists. split; [| reflexivity]. apply turned_found; [exact a0 | exact ia | | rewrite norm2_scale; fold tau; pose proof (pow2_ge_0 tau); nra].
      clear - a2. destruct k; cbn [may_turn] in *; auto. destruct a2 as [e1 e2]. unfold vscale. cbn [vx vy]. rewrite e1, e2. split; ring.
  - intros P'' Q'' [[h1 [h2 [S [h3 h4]]]] h5]. destruct (turned_coordinates k angle S a0 ia h3) as [c [c1 [c2 c3]]]. fold tau in c3. fold dist in h2.
    assert (A1 : is_of k (vscale (/ dist) (vsub P'' P)) vzero) by (clear - h1; destruct k; cbn [is_of] in *; [destruct h1 as [e _]; unfold vscale; cbn [vx vy vz] in *; rewrite e; repeat split; ring | exact I | rewrite h1; unfold vscale, vzero; cbn [vx vy vz]; f_equal; ring]).
    assert (A2 : may_turn k (vscale (/ tau) c)) by (clear - c1; destruct k; cbn [may_turn] in *; auto; destruct c1 as [e1 e2]; unfold vscale; cbn [vx vy]; rewrite e1, e2; split; ring).
    destruct (parts_exist k _ _ A1 A2) as [v [lv [e1 e2]]].
    assert (E1 : position_at k P dist v = P'') by (unfold position_at; rewrite e1; destruct P as [p1 p2 p3], P'' as [q1 q2 q3]; unfold vadd, vsub, vscale; cbn [vx vy vz]; f_equal; field; lra).
    assert (E2 : turn_at k Q tau v = Q'').
    { unfold turn_at. rewrite e2, h4. assert (C : vscale tau (vscale (/ tau) c) = c) by (destruct c as [x y z]; unfold vscale; cbn [vx vy vz]; f_equal; field; lra). rewrite C. unfold moved_on. f_equal. rewrite c2.
      pose proof (norm2_nonneg c). destruct S as [[s1 s2 s3] [s4 s5 s6] [s7 s8 s9]]. unfold mscale, vscale. cbn [row1 row2 row3 vx vy vz]. f_equal; f_equal; field; lra. }
    assert (IN : length v = n /\ norm (first_angle k) v <= 1).
    { split; [exact lv |]. apply (Sized v lv). rewrite e1, e2, !norm2_scale. split; [apply Rmult_le_reg_l with (dist ^ 2); [apply pow_lt, d0 |]; replace (dist ^ 2 * ((/ dist) ^ 2 * norm2 (vsub P'' P))) with (norm2 (vsub P'' P)) by (field; lra); lra |].
      apply Rmult_le_reg_l with (tau ^ 2); [apply pow_lt, t0 |]. replace (tau ^ 2 * ((/ tau) ^ 2 * norm2 c)) with (norm2 c) by (field; lra). lra. }
    assert (V : v = u).
    { apply only; [exact IN |]. apply Same; [exact lv |]. rewrite E1, E2. clear - h5. induction h5 as [| l r m' rho [_ h] hs IH]; constructor; assumption. }
    rewrite <- E1, <- E2, V. split; reflexivity.
Qed.
End Named.

(** ** As formulas *)

Definition eposition (k : motion) : evec :=
  match k with
  | InPlane => EVec (F (Coord 0)) (F (Coord 1)) (integer 0)
  | InSpace => point
  | AboutPoint => EVec (integer 0) (integer 0) (integer 0)
  end.

Definition eturned (N : emat) (w : formula) (b : evec) : evec := divided_by (emulv N b) w.
Definition position_list (k : motion) (P : vec) : list R :=
  match k with InPlane => [vx P; vy P] | InSpace => [vx P; vy P; vz P] | AboutPoint => [] end.
Definition is_position (k : motion) (P : vec) : Prop :=
  match k with InPlane => vz P = 0 | InSpace => True | AboutPoint => P = vzero end.

Lemma position_value : forall k P r cs theta, is_position k P -> val3 (map (Rmult r) (position_list k P) ++ cs) theta (eposition k) = vscale r P.
Proof.
  intros [] [p q z] r cs theta h; cbn [is_position vz] in h.
  - subst. unfold val3, vscale. cbn. f_equal. ring.
  - reflexivity.
  - injection h as -> -> ->. unfold val3, vscale. cbn. f_equal; ring.
Qed.


Definition spin_formulas (k : motion) (m : nat) : evec :=
  match k with InPlane => EVec (integer 0) (integer 0) (F (Coord m)) | _ => EVec (F (Coord m)) (F (Coord (S m))) (F (Coord (S (S m)))) end.
Definition onward_rate (c : evec) : formula := over (integer 2) (plus (integer 1) (product c c)).
Definition eonward (c r : evec) : evec := let across := ecross c r in map2 plus r (Machine.scaled (onward_rate c) (map2 plus across (ecross c across))).
(** The joint's lever, the strut's vector and its length, of a platform that is turned on by c. *)
Definition moved_strut (k : motion) (N : emat) (w : formula) (a b c : evec) : evec * evec * formula :=
  let r := eonward c (eturned N w b) in let A := map2 minus (map2 plus (eposition k) r) a in (r, A, root (product A A)).
Definition moved_row (k : motion) (N : emat) (w : formula) (a b c : evec) (unit : formula) : list formula :=
  let '(r, A, len) := moved_strut k N w a b c in let u := divided_by A len in let mu := ecross r u in
  let t := Machine.scaled (onward_rate c) (map2 plus mu (ecross mu c)) in etwist k u (EVec (times (ex t) unit) (times (ey t) unit) (times (ez t) unit)).

Lemma value_onward_rate : forall x theta c, Formula.value x theta (onward_rate c) = 2 / (1 + norm2 (val3 x theta c)).
Proof. intros. unfold onward_rate. rewrite value_over, value_plus, value_dot, <- norm2_dot. reflexivity. Qed.
Lemma onward_scaled : forall c q r, onward c (vscale q r) = vscale q (onward c r).
Proof. intros [c1 c2 c3] q [r1 r2 r3]. unfold onward. generalize (2 / (1 + norm2 (Vec c1 c2 c3))). intro h. unfold vadd, vscale, cross. cbn [vx vy vz]. f_equal; ring. Qed.

Lemma moved_row_values : forall x theta k P' Q C W ratio dist tau N w a b c unit l, 0 < ratio -> 0 < W ->
  val3 x theta (eposition k) = vscale ratio P' -> valm x theta N = mscale W Q -> Formula.value x theta w = W ->
  val3 x theta a = vscale ratio (strut_base l) -> val3 x theta b = vscale ratio (strut_joint l) -> val3 x theta c = C -> Formula.value x theta unit * ratio = tau / dist ->
  Formula.defined x theta (snd (moved_strut k N w a b c)) -> is_far_row k dist tau l P' (moved_on C Q) C (map (Formula.value x theta) (moved_row k N w a b c unit)).
Proof.
  intros x theta k P' Q C W ratio dist tau N w a b c unit l r0 W0 hP hN hw ha hb hc hu def. unfold moved_row, moved_strut in *. cbv zeta. cbn [snd] in def.
  set (r := eonward c (eturned N w b)) in *. set (A := map2 minus (map2 plus (eposition k) r) a) in *.
  assert (T : val3 x theta (eturned N w b) = vscale ratio (mulv Q (strut_joint l))).
  { unfold eturned. rewrite val3_divided, val3_mulv, hN, hb, hw, mulv_mscale, mulv_scale. generalize (mulv Q (strut_joint l)). intros [v1 v2 v3]. unfold vscale. cbn [vx vy vz]. f_equal; field; lra. }
  assert (R_ : val3 x theta r = vscale ratio (arm_of_joint l (moved_on C Q))).
  { unfold r, eonward. cbv zeta. rewrite val3_plus, val3_scaled, val3_plus, !val3_cross, value_onward_rate, hc, T. unfold arm_of_joint. rewrite moved_on_onward, <- onward_scaled. reflexivity. }
  assert (V : val3 x theta A = vscale ratio (strut_vector l P' (moved_on C Q))).
  { unfold A. rewrite val3_minus, val3_plus, hP, R_, ha. unfold strut_vector. destruct P' as [p1 p2 p3], (arm_of_joint l (moved_on C Q)) as [q1 q2 q3], (strut_base l) as [b1 b2 b3]. unfold vadd, vsub, vscale. cbn [vx vy vz]. f_equal; ring. }
  assert (N0 : 0 < norm2 (strut_vector l P' (moved_on C Q))).
  { assert (Pos : 0 < Formula.value x theta (product A A)).
    { unfold root in def. destruct (is 1 (product A A)) eqn:one; [rewrite (is_value _ _ _ _ one); lra | exact (proj1 def)]. }
    rewrite value_dot, V, <- norm2_dot, norm2_scale in Pos. pose proof (pow_lt ratio 2 r0). apply Rmult_lt_reg_l with (ratio ^ 2); lra. }
  unfold is_far_row. cbv zeta. split; [exact N0 |]. rewrite twist_values. set (sv := strut_vector l P' (moved_on C Q)) in *. set (arm := arm_of_joint l (moved_on C Q)) in *.
  assert (U : val3 x theta (divided_by A (root (product A A))) = normalised sv).
  { rewrite val3_divided, value_root, value_dot, V, <- norm2_dot. exact (normalised_resized ratio sv r0). }
  rewrite U. f_equal. unfold Chart.val3. cbn [ex ey ez]. rewrite !value_times.
  assert (MU : val3 x theta (ecross r (divided_by A (root (product A A)))) = vscale ratio (cross arm (normalised sv))).
  { rewrite val3_cross, R_, U. destruct arm as [q1 q2 q3], (normalised sv) as [n1 n2 n3]. unfold cross, vscale. cbn [vx vy vz]. f_equal; ring. }
  set (mu := ecross r (divided_by A (root (product A A)))) in *.
  assert (X : val3 x theta (Machine.scaled (onward_rate c) (map2 plus mu (ecross mu c))) = vscale (2 / (1 + norm2 C)) (vadd (vscale ratio (cross arm (normalised sv))) (cross (vscale ratio (cross arm (normalised sv))) C)))
    by (rewrite val3_scaled, val3_plus, val3_cross, value_onward_rate, hc, MU; reflexivity).
  set (t := Machine.scaled (onward_rate c) (map2 plus mu (ecross mu c))) in *. pose proof (f_equal vx X) as x1. pose proof (f_equal vy X) as x2. pose proof (f_equal vz X) as x3.
  unfold Chart.val3 in x1, x2, x3. cbn [vx vy vz] in x1, x2, x3. rewrite x1, x2, x3, <- hu. set (un := Formula.value x theta unit). set (h := 2 / (1 + norm2 C)).
  destruct (cross arm (normalised sv)) as [m1 m2 m3]. destruct C as [c1 c2 c3]. unfold vscale, vadd, cross. cbn [vx vy vz]. f_equal; ring.
Qed.

(** ** What control points show *)

Lemma scaled_multiple : forall e q r, Twofold.scaled e (map (Rmult q) r) = map (Rmult q) (Twofold.scaled e r).
Proof. unfold Twofold.scaled. induction e as [| x e IH]; intros q [| y r]; cbn [map combine]; try reflexivity. cbn [fst snd]. rewrite IH. f_equal. ring. Qed.
Lemma rows_resized : forall W e R_ J0, 0 < W -> Forall2 (fun p row => exists q, 0 < q /\ q ^ 2 = W * snd p /\ fst p = map (Rmult q) row) R_ J0 -> forall w, length w = length J0 ->
  exists v, length v = length w /\ (forall k, dot v (map (fun r => nth k r 0) (map (Twofold.scaled e) (map fst R_))) = dot w (map (fun r => nth k r 0) (map (Twofold.scaled e) J0))) /\
    W * dot (map snd R_) (squares v) = dot w w /\
    forall bs Bs, Forall2 (is_bounded W) bs (combine R_ Bs) -> Rabs (dot bs w) <= dot Bs (map Rabs v).
Proof.
  intros W e R_ J0 W0. induction 1 as [| [A D] row R_ J0 [q [q0 [q2 eA]]] h IH]; intros [| t w] l; try discriminate.
  - exists []. split; [reflexivity |]. split; [reflexivity |]. split; [cbn; ring |]. intros bs Bs hb. inversion hb; subst. rewrite (dot_commutes Bs). cbn. rewrite Rabs_R0. lra.
  - destruct (IH w ltac:(cbn in l; congruence)) as [v [v1 [v2 [v3 v4]]]]. cbn [fst snd] in *. exists (t / q :: v). split; [cbn; congruence |]. split; [| split].
    + intro k. cbn [map dot fst]. rewrite v2, eA, scaled_multiple, map_entries. field. lra.
    + cbn [map dot squares snd]. fold (squares v). rewrite Rmult_plus_distr_l, v3. replace (W * (D * (t / q) ^ 2)) with (W * D * (t / q) ^ 2) by ring. rewrite <- q2. field. lra.
    + intros bs [| B Bs] hb; cbn [combine] in hb; inversion hb as [| b ? bs' ? b1 b2]; subst; [cbn; rewrite Rabs_R0; lra |].
      assert (G : Rabs b * Rabs t <= B * Rabs (t / q)).
      { replace (Rabs t) with (q * Rabs (t / q)) by (unfold Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ q)) by (apply Rlt_le, Rinv_0_lt_compat, q0); field; lra).
        rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [apply Rabs_pos | exact (b1 q (Rlt_le _ _ q0) q2)]. }
      specialize (v4 bs' Bs b2). cbn [map dot]. eapply Rle_trans; [apply Rabs_triang |]. rewrite Rabs_mult. apply Rplus_le_compat; [exact G | exact v4].
Qed.

Lemma met_of : forall f n J g bs p W R_ kappa z e Bs, 0 < W -> length (J (nought n)) = n ->
  Forall2 (fun p row => exists q, 0 < q /\ q ^ 2 = W * snd p /\ fst p = map (Rmult q) row) R_ (J (nought n)) ->
  g < kappa -> 0 <= z -> z + g / (2 * kappa) <= 1 -> length e = n -> (forall i, (i < n)%nat -> 0 < nth i e 0) ->
  (forall i, (i < n)%nat -> (if p : bool then f <= i else i < f)%nat -> nth i e 0 = 1) -> Forall2 (is_bounded W) bs (combine R_ Bs) ->
  (forall v, length v = n -> let p := weighted_sum v (map (Twofold.scaled e) (map fst R_)) in
    kappa ^ 2 * W * dot (map snd R_) (squares v) <= dot p p /\
    forall s, 0 < dot v v + s ^ 2 -> 0 < dot p p - 2 * Rabs s * W * dot Bs (map Rabs v) + W ^ 2 * z ^ 2 * s ^ 2) ->
  met f n J g bs p.
Proof.
  intros f n J g bs p W R_ kappa z e Bs W0 lJ rows gk z0 zg le e0 e1 off shown. exists kappa, z, e. repeat (split; [assumption |]). intros w lw. cbv zeta.
  destruct (rows_resized W e R_ _ W0 rows w ltac:(congruence)) as [v [lv [v2 [v3 v4]]]]. destruct (shown v ltac:(congruence)) as [h1 h2].
  set (q := weighted_sum w (map (Twofold.scaled e) (J (nought n)))). set (q' := weighted_sum v (map (Twofold.scaled e) (map fst R_))) in *.
  assert (E : forall k, nth k q' 0 = nth k q 0) by (intro k; unfold q, q'; rewrite !weighted_entries; apply v2).
  assert (D : dot q' q' = dot q q) by (rewrite (dot_entries q' q' q E), (dot_commutes q q'); apply dot_entries, E). rewrite D in h1, h2.
  split; [rewrite <- v3; lra |]. intros s nz.
  assert (nz' : 0 < dot v v + (s / W) ^ 2).
  { pose proof (dot_self v) as d0. pose proof (pow2_ge_0 (s / W)) as s0. destruct (Rle_lt_dec (dot v v + (s / W) ^ 2) 0) as [bad |]; [| assumption]. exfalso.
    assert (V0 : dot v v <= 0) by lra. assert (S0 : (s / W) ^ 2 = 0) by lra. apply zero_vector in V0.
    assert (Z : dot (map snd R_) (squares v) = 0) by (apply dot_zero; unfold squares; rewrite Forall_map; revert V0; apply Forall_impl; intros a <-; ring). rewrite Z in v3.
    assert (s ^ 2 = (s / W) ^ 2 * W ^ 2) by (field; lra). rewrite S0 in H. lra. }
  specialize (h2 _ nz'). specialize (v4 bs Bs off). set (B := dot Bs (map Rabs v)) in *.
  replace (W ^ 2 * z ^ 2 * (s / W) ^ 2) with (z ^ 2 * s ^ 2) in h2 by (field; lra).
  assert (A : 2 * Rabs (s / W) * W = 2 * Rabs s) by (unfold Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ W)) by (apply Rlt_le, Rinv_0_lt_compat, W0); field; lra). rewrite A in h2.
  assert (C : - (Rabs s * B) <= s * dot bs w).
  { pose proof (Rle_abs (- (s * dot bs w))) as c. rewrite Rabs_Ropp, Rabs_mult in c. pose proof (Rmult_le_compat_l (Rabs s) _ _ (Rabs_pos s) v4). lra. }
  lra.
Qed.
