(** * Orientations: rotations by angles in degrees, and the tangents of their halves

    What is claimed of orientations is said by angles; coordinates of checks and
    witnesses are tangents of half angles, of which the sine and the cosine are
    rational: of one axis after another, or along the axis (Rodrigues). *)

From Coq Require Import ZArith QArith Qreals Reals Lra List Bool.
From Orthocert Require Import Vec3 Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Number Trig Witness.
Import ListNotations.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.

(** ** Rotations, and sets of them *)

Definition rotation_x (a : R) : mat := Mat (Vec 1 0 0) (Vec 0 (cos a) (- sin a)) (Vec 0 (sin a) (cos a)).
Definition rotation_y (a : R) : mat := Mat (Vec (cos a) 0 (sin a)) (Vec 0 1 0) (Vec (- sin a) 0 (cos a)).
Definition rotation_z (a : R) : mat := Mat (Vec (cos a) (- sin a) 0) (Vec (sin a) (cos a) 0) (Vec 0 0 1).

(** About the unit vector [u]: the images of the axes are the columns. *)
Definition rotated (u : vec) (a : R) (v : vec) : vec :=
  vadd (vadd (vscale (cos a) v) (vscale (sin a) (cross u v))) (vscale ((1 - cos a) * dot u v) u).
Definition rotation_about (u : vec) (a : R) : mat := transpose (Mat (rotated u a e1) (rotated u a e2) (rotated u a e3)).

(** Guards on the definition. *)
Lemma rotation_about_rotates : forall u a v, mulv (rotation_about u a) v = rotated u a v.
Proof. intros u a v. unfold rotation_about, rotated. vec_ring. Qed.
Lemma rotation_about_axes : forall a, rotation_about e1 a = rotation_x a /\ rotation_about e2 a = rotation_y a /\ rotation_about e3 a = rotation_z a.
Proof. intro a. unfold rotation_about, rotated, rotation_x, rotation_y, rotation_z. repeat split; unfold_vec; vec_split; ring. Qed.

(** Degrees. [Tilted]: the platform's z axis in any direction up to [tilt] from that of the base, and a torsion either way. *)
Inductive orientations :=
  | TurnedBy (angle : tolerance)                  (* in the plane *)
  | RollPitchYaw (roll pitch yaw : tolerance)
  | TurnedUpTo (angle : number)                   (* about any axis *)
  | Tilted (tilt torsion : number).

Definition in_orientations (o : orientations) (Q : mat) : Prop :=
  match o with
  | TurnedBy t => exists a, within t a /\ Q = rotation_z (in_degrees a)
  | RollPitchYaw r p y => exists a b c, within r a /\ within p b /\ within y c /\
      Q = mulm (rotation_z (in_degrees c)) (mulm (rotation_y (in_degrees b)) (rotation_x (in_degrees a)))
  | TurnedUpTo most => exists u a, norm2 u = 1 /\ 0 <= a <= value most /\ Q = rotation_about u (in_degrees a)
  | Tilted tilt torsion => exists a b s, 0 <= b <= value tilt /\ - value torsion <= s <= value torsion /\
      Q = mulm (rotation_z (in_degrees a)) (mulm (rotation_y (in_degrees b)) (rotation_z (in_degrees (s - a))))
  end.

Lemma rotations_keep : forall a b, norm2 (mulv (rotation_x a) b) = norm2 b /\ norm2 (mulv (rotation_y a) b) = norm2 b /\
  norm2 (mulv (rotation_z a) b) = norm2 b.
Proof.
  intros a [x y z]. pose proof (sin2_cos2 a) as S. unfold Rsqr in S. set (s := sin a) in *. set (c := cos a) in *.
  assert (K : forall u v, (c * u - s * v) ^ 2 + (s * u + c * v) ^ 2 = u ^ 2 + v ^ 2).
  { intros u v. replace ((c * u - s * v) ^ 2 + (s * u + c * v) ^ 2) with ((s * s + c * c) * (u ^ 2 + v ^ 2)) by ring. rewrite S. ring. }
  unfold mulv, rotation_x, rotation_y, rotation_z, norm2, Vec3.dot. fold s c. cbn [row1 row2 row3 vx vy vz].
  pose proof (K y z). pose proof (K z x). pose proof (K x y). repeat split; cbn [pow] in *; lra.
Qed.

Lemma rotation_about_keeps : forall u a b, norm2 u = 1 -> norm2 (mulv (rotation_about u a) b) = norm2 b.
Proof.
  intros u a b h. rewrite rotation_about_rotates. unfold rotated. pose proof (sin2_cos2 a) as S. unfold Rsqr in S.
  set (s := sin a) in *. set (c := cos a) in *. clearbody s c.
  assert (E : norm2 (vadd (vadd (vscale c b) (vscale s (cross u b))) (vscale ((1 - c) * dot u b) u)) =
    c * c * norm2 b + s * s * norm2 (cross u b) + (1 - c) * dot u b * dot u b * (2 * c + (1 - c) * norm2 u)) by (unfold_vec; ring).
  pose proof (lagrange u b) as L. rewrite h in *. rewrite E. replace (s * s) with (1 - c * c) by lra.
  replace (norm2 (cross u b)) with (norm2 b - dot u b ^ 2) by lra. ring.
Qed.

Lemma orientation_keeps : forall o Q, in_orientations o Q -> forall b, norm2 (mulv Q b) = norm2 b.
Proof.
  assert (K : forall A B, (forall b, norm2 (mulv A b) = norm2 b) -> (forall b, norm2 (mulv B b) = norm2 b) -> forall b, norm2 (mulv (mulm A B) b) = norm2 b)
    by (intros A B ha hb b; rewrite mulv_mulm, ha; apply hb).
  intros [t | r p y | m | t s] Q h; cbn [in_orientations] in h.
  - destruct h as [a [_ ->]]. intro b. apply rotations_keep.
  - destruct h as [a [e [d [_ [_ [_ ->]]]]]]. repeat apply K; intro b; apply rotations_keep.
  - destruct h as [u [a [hu [_ ->]]]]. intro b. apply rotation_about_keeps, hu.
  - destruct h as [a [b [c [_ [_ ->]]]]]. repeat apply K; intro v; apply rotations_keep.
Qed.

(** ** Angles by the tangents of their halves *)

(** [t] is the tangent of the half of the angle [x]. *)
Definition is_half_tangent (t x : R) : Prop :=
  cos (in_degrees x) = (1 - t ^ 2) / (1 + t ^ 2) /\ sin (in_degrees x) = 2 * t / (1 + t ^ 2).

Lemma half_tangent : forall t x, sin (in_degrees (x / 2)) = t * cos (in_degrees (x / 2)) -> is_half_tangent t x.
Proof.
  intros t x e. set (p := in_degrees (x / 2)) in *. assert (E : in_degrees x = 2 * p) by (unfold p, in_degrees; field).
  pose proof (sin2_cos2 p) as S. unfold Rsqr in S. rewrite e in S. pose proof (pow2_ge_0 t) as t0.
  assert (C : cos p * cos p = / (1 + t ^ 2)) by (apply Rmult_eq_reg_r with (1 + t ^ 2); [rewrite Rinv_l by lra; lra | lra]).
  unfold is_half_tangent. rewrite E, cos_2a, sin_2a, e. split.
  - replace (cos p * cos p - t * cos p * (t * cos p)) with (cos p * cos p * (1 - t ^ 2)) by ring. rewrite C. field. lra.
  - replace (2 * (t * cos p) * cos p) with (2 * t * (cos p * cos p)) by ring. rewrite C. field. lra.
Qed.

(** Between the half tangents of two angles are those of angles between. *)
Definition excess (t x : R) : R := sin (in_degrees (x / 2)) - t * cos (in_degrees (x / 2)).

Lemma half_tangent_between : forall t a b, a <= b -> excess t a <= 0 -> 0 <= excess t b -> exists x, a <= x <= b /\ is_half_tangent t x.
Proof.
  intros t a b le ha hb.
  assert (C : continuity (excess t)).
  { assert (L : continuity (fun x => in_degrees (x / 2))) by (intro x; unfold in_degrees; reg).
    intro x. apply continuity_pt_minus.
    - apply (continuity_pt_comp (fun x => in_degrees (x / 2)) sin); [apply L | apply continuity_sin].
    - apply (continuity_pt_scal (fun x => cos (in_degrees (x / 2)))).
      apply (continuity_pt_comp (fun x => in_degrees (x / 2)) cos); [apply L | apply continuity_cos]. }
  destruct (IVT_cor (excess t) a b C le ltac:(nra)) as [x [h z]]. exists x. split; [exact h |]. apply half_tangent. unfold excess in z. lra.
Qed.
(** The tangent of the half of an angle in degrees. *)
Definition tangent (x : R) : R := sin (in_degrees (x / 2)) / cos (in_degrees (x / 2)).
Definition is_angle (x : R) : Prop := -180 < x < 180.

Lemma half_cosine : forall x, is_angle x -> 0 < cos (in_degrees (x / 2)).
Proof. intros x [h1 h2]. pose proof PI_RGT_0. apply cos_gt_0; unfold in_degrees; nra. Qed.

Lemma tangent_is : forall x, is_angle x -> is_half_tangent (tangent x) x.
Proof. intros x h. pose proof (half_cosine x h). apply half_tangent. unfold tangent. field. lra. Qed.

Lemma tangent_increases : forall a b, is_angle a -> is_angle b -> a <= b -> tangent a <= tangent b.
Proof.
  intros a b ha hb le. pose proof (half_cosine a ha) as ca. pose proof (half_cosine b hb) as cb. destruct ha, hb. pose proof PI_RGT_0.
  assert (S : 0 <= sin (in_degrees (b / 2) - in_degrees (a / 2))) by (apply sin_ge_0; unfold in_degrees; nra).
  rewrite sin_minus in S. unfold tangent. set (p := cos (in_degrees (a / 2))) in *. set (q := cos (in_degrees (b / 2))) in *.
  set (u := sin (in_degrees (a / 2))) in *. set (v := sin (in_degrees (b / 2))) in *. clearbody p q u v.
  apply Rmult_le_reg_r with (p * q); [apply Rmult_lt_0_compat; assumption |]. replace (u / p * (p * q)) with (u * q) by (field; lra).
  replace (v / q * (p * q)) with (v * p) by (field; lra). lra.
Qed.

Lemma tangent_opposite : forall x, is_angle x -> tangent (- x) = - tangent x.
Proof.
  intros x h. unfold tangent. replace (in_degrees (- x / 2)) with (- in_degrees (x / 2)) by (unfold in_degrees; field).
  rewrite sin_neg, cos_neg. pose proof (half_cosine x h). field. lra.
Qed.
Lemma tangent_nonneg : forall x, 0 <= x -> is_angle x -> 0 <= tangent x.
Proof.
  intros x h a. replace 0 with (tangent 0); [apply tangent_increases; [split; lra | exact a | exact h] |].
  unfold tangent, in_degrees. replace (0 / 2 * PI / 180) with 0 by field. rewrite sin_0. unfold Rdiv. ring.
Qed.
Lemma between_tangents : forall x a, is_angle x -> 0 <= a <= x -> 0 <= tangent a <= tangent x.
Proof. intros x a h [a0 ax]. destruct h. split; [apply tangent_nonneg | apply tangent_increases]; try split; lra. Qed.

(** From 0 to the half tangent of an angle are those of angles up to it. *)
Lemma half_tangent_up_to : forall t x, 0 <= x -> is_angle x -> 0 <= t <= tangent x -> exists a, 0 <= a <= x /\ is_half_tangent t a.
Proof.
  intros t x x0 h [t0 tx]. pose proof (half_cosine x h) as c0. apply half_tangent_between; [exact x0 | |]; unfold excess.
  - unfold in_degrees. replace (0 / 2 * PI / 180) with 0 by field. rewrite sin_0, cos_0. lra.
  - replace (sin (in_degrees (x / 2))) with (tangent x * cos (in_degrees (x / 2))) by (unfold tangent; field; lra). nra.
Qed.

(** ** Tangents along the axis of a rotation *)

(** w Q, with w = 1 + |c|^2, of the rotation with the tangent |c| of its half angle, about c (Rodrigues). *)
Definition rodrigues (c : vec) : mat :=
  let x := vx c in let y := vy c in let z := vz c in let q := norm2 c in
  Mat (Vec (1 - q + 2 * x ^ 2) (2 * (x * y - z)) (2 * (x * z + y)))
      (Vec (2 * (x * y + z)) (1 - q + 2 * y ^ 2) (2 * (y * z - x)))
      (Vec (2 * (x * z - y)) (2 * (y * z + x)) (1 - q + 2 * z ^ 2)).

Lemma rodrigues_about : forall t u a, norm2 u = 1 -> is_half_tangent t a ->
  rodrigues (vscale t u) = mscale (1 + norm2 (vscale t u)) (rotation_about u (in_degrees a)).
Proof.
  intros t u a h [C S]. rewrite norm2_scale, h. unfold rotation_about, rotated. rewrite C, S. unfold rodrigues.
  rewrite norm2_scale, h. clear h C S. pose proof (pow2_ge_0 t). unfold_vec. vec_split; field; lra.
Qed.

(** The coordinates of a tilt with the half tangent [t] in the direction [a], and a torsion with [s]. *)
Definition tilted (t s a : R) : vec := Vec (t * (s * cos a - sin a)) (t * (cos a + s * sin a)) s.

Lemma norm2_tilted : forall t s a, 1 + norm2 (tilted t s a) = (1 + t ^ 2) * (1 + s ^ 2).
Proof. intros t s a. pose proof (sin2_cos2 a) as E. unfold Rsqr in E. unfold tilted, norm2. cbn [vx vy vz]. nra. Qed.

Lemma mulm_scaled : forall a b A B, mulm (mscale a A) (mscale b B) = mscale (a * b) (mulm A B).
Proof. intros a b [[] [] []] [[] [] []]. unfold mulm, mscale, mulv, transpose, col1, col2, col3, vscale, Vec3.dot. cbn. f_equal; f_equal; ring. Qed.
Lemma mscale_one : forall A, mscale 1 A = A.
Proof. intros [[] [] []]. unfold mscale, vscale. cbn. f_equal; f_equal; ring. Qed.
Lemma mscale_ext : forall A B C a b c w, A = vscale w a -> B = vscale w b -> C = vscale w c -> Mat A B C = mscale w (Mat a b c).
Proof. intros. subst. reflexivity. Qed.

Lemma rodrigues_tilted : forall t s a b d, is_half_tangent t b -> is_half_tangent s d ->
  rodrigues (tilted t s (in_degrees a)) = mscale (1 + norm2 (tilted t s (in_degrees a)))
    (mulm (rotation_z (in_degrees a)) (mulm (rotation_y (in_degrees b)) (rotation_z (in_degrees (d - a))))).
Proof.
  intros t s a b d [Cb Sb] [Cd Sd]. rewrite norm2_tilted. set (A := in_degrees a).
  assert (Y : mscale (1 + t ^ 2) (rotation_y (in_degrees b)) = Mat (Vec (1 - t ^ 2) 0 (2 * t)) (Vec 0 (1 + t ^ 2) 0) (Vec (- (2 * t)) 0 (1 - t ^ 2))).
  { unfold rotation_y. rewrite Cb, Sb. pose proof (pow2_ge_0 t). symmetry. apply mscale_ext; unfold vscale; cbn [vx vy vz]; f_equal; field; lra. }
  assert (Z : mscale (1 + s ^ 2) (rotation_z (in_degrees (d - a))) =
    let p := (1 - s ^ 2) * cos A + 2 * s * sin A in let q := 2 * s * cos A - (1 - s ^ 2) * sin A in
    Mat (Vec p (- q) 0) (Vec q p 0) (Vec 0 0 (1 + s ^ 2))).
  { replace (in_degrees (d - a)) with (in_degrees d - A) by (unfold A, in_degrees; field). unfold rotation_z. rewrite cos_minus, sin_minus, Cd, Sd.
    pose proof (pow2_ge_0 s). symmetry. cbv zeta. apply mscale_ext; unfold vscale; cbn [vx vy vz]; f_equal; field; lra. }
  replace ((1 + t ^ 2) * (1 + s ^ 2)) with (1 * ((1 + t ^ 2) * (1 + s ^ 2))) by ring.
  rewrite <- mulm_scaled, <- mulm_scaled, mscale_one, Y, Z. cbv zeta. pose proof (sin2_cos2 A) as E. unfold Rsqr in E.
  unfold rotation_z. set (x := cos A) in *. set (y := sin A) in *. assert (E' : y * y = 1 - x * x) by lra. unfold tilted. fold x y. clearbody x y. clear - E'.
  cbv [rodrigues mulm mulv transpose col1 col2 col3 norm2 dot row1 row2 row3 vx vy vz]. vec_split; ring [E'].
Qed.

(** Some angle has this cosine and sine. *)
Lemma an_angle : forall x y, x ^ 2 + y ^ 2 = 1 -> exists a, cos (in_degrees a) = x /\ sin (in_degrees a) = y.
Proof.
  intros x y h. assert (Q : in_degrees (180 / 2) = PI / 2 /\ in_degrees (-180 / 2) = - (PI / 2) /\ in_degrees 180 = PI) by (unfold in_degrees; repeat split; field).
  destruct Q as [Q1 [Q2 Q3]]. destruct (Req_dec x (-1)) as [-> | n].
  - exists 180. rewrite Q3, cos_PI, sin_PI. split; [reflexivity | nra].
  - assert (p : 0 < 1 + x) by nra. destruct (half_tangent_between (y / (1 + x)) (-180) 180) as [a [_ [C S]]]; [lra | unfold excess ..|].
    + rewrite Q2, sin_neg, cos_neg, sin_PI2, cos_PI2. lra.
    + rewrite Q1, sin_PI2, cos_PI2. lra.
    + assert (T : 1 + (y / (1 + x)) ^ 2 = 2 / (1 + x)) by (replace ((y / (1 + x)) ^ 2) with ((1 - x ^ 2) / (1 + x) ^ 2); [field; lra | replace (1 - x ^ 2) with (y ^ 2) by lra; field; lra]).
      exists a. rewrite C, S, T. replace (1 - (y / (1 + x)) ^ 2) with (2 - 2 / (1 + x)) by lra. split; field; lra.
Qed.

(** Coordinates of the sets: what is not negative at them. *)
Lemma up_to_coordinates : forall m Q, in_orientations (TurnedUpTo m) Q -> is_angle (value m) ->
  exists c, rodrigues c = mscale (1 + norm2 c) Q /\ norm2 c <= tangent (value m) ^ 2.
Proof.
  intros m Q [u [a [hu [ha ->]]]] h. destruct (between_tangents _ _ h ha) as [t0 tm]. exists (vscale (tangent a) u).
  split; [apply rodrigues_about; [exact hu | apply tangent_is; destruct h; split; lra] |]. rewrite norm2_scale, hu. nra.
Qed.

Lemma up_to_found : forall m c, 0 <= value m -> is_angle (value m) -> norm2 c <= tangent (value m) ^ 2 ->
  exists Q, in_orientations (TurnedUpTo m) Q /\ rodrigues c = mscale (1 + norm2 c) Q.
Proof.
  intros m c m0 h le. pose proof (norm2_nonneg c) as c0. set (t := sqrt (norm2 c)). assert (T2 : t ^ 2 = norm2 c) by (unfold t; apply pow2_sqrt, c0).
  assert (t0 : 0 <= t) by apply sqrt_pos. pose proof (tangent_nonneg _ m0 h) as m1.
  assert (U : exists u, norm2 u = 1 /\ c = vscale t u).
  { destruct (Req_dec t 0) as [z | z].
    - exists e1. split; [unfold_vec; ring |]. rewrite z in *. rewrite (norm2_zero c) by (rewrite <- T2; ring). unfold_vec. vec_split; ring.
    - exists (vscale (/ t) c). split; [rewrite norm2_scale, <- T2; field; exact z |]. unfold_vec. vec_split; field; exact z. }
  destruct U as [u [hu hc]]. destruct (half_tangent_up_to t (value m) m0 h ltac:(split; nra)) as [a [ha ta]].
  exists (rotation_about u (in_degrees a)). split; [exists u, a; auto |]. rewrite hc. apply rodrigues_about; assumption.
Qed.

Lemma tilt_coordinates : forall m n Q, in_orientations (Tilted m n) Q -> is_angle (value m) -> is_angle (value n) ->
  exists c, rodrigues c = mscale (1 + norm2 c) Q /\ vx c ^ 2 + vy c ^ 2 <= tangent (value m) ^ 2 * (1 + vz c ^ 2) /\
    - tangent (value n) <= vz c <= tangent (value n).
Proof.
  intros m n Q [a [b [s [hb [hs ->]]]]] hm hn. destruct (between_tangents _ _ hm hb) as [t0 tm].
  assert (ib : is_angle b) by (destruct hm; split; lra). assert (is : is_angle s) by (destruct hn; split; lra).
  exists (tilted (tangent b) (tangent s) (in_degrees a)). split; [apply rodrigues_tilted; apply tangent_is; assumption |]. unfold tilted. cbn [vx vy vz]. split.
  - pose proof (norm2_tilted (tangent b) (tangent s) (in_degrees a)) as N. unfold tilted, norm2 in N. cbn [vx vy vz] in N.
    pose proof (pow2_ge_0 (tangent s)). assert (tangent b ^ 2 <= tangent (value m) ^ 2) by nra. nra.
  - rewrite <- tangent_opposite by exact hn. assert (is_angle (- value n)) by (destruct hn; split; lra). split; apply tangent_increases; try assumption; lra.
Qed.

Lemma tilt_found : forall m n c s, 0 <= value m -> is_angle (value m) -> - value n <= s <= value n -> is_half_tangent (vz c) s ->
  vx c ^ 2 + vy c ^ 2 <= tangent (value m) ^ 2 * (1 + vz c ^ 2) -> exists Q, in_orientations (Tilted m n) Q /\ rodrigues c = mscale (1 + norm2 c) Q.
Proof.
  intros m n [x y z] s m0 h hs ts le. cbn [vx vy vz] in *. pose proof (pow2_ge_0 z) as z0. pose proof (pow2_ge_0 x) as x0. pose proof (pow2_ge_0 y) as y0.
  set (r := (x ^ 2 + y ^ 2) / (1 + z ^ 2)). assert (R0 : r * (1 + z ^ 2) = x ^ 2 + y ^ 2) by (unfold r; field; lra). assert (r0 : 0 <= r) by nra.
  set (t := sqrt r). assert (T2 : t ^ 2 = r) by (unfold t; apply pow2_sqrt, r0). assert (t0 : 0 <= t) by apply sqrt_pos. pose proof (tangent_nonneg _ m0 h) as m1.
  assert (tm : t <= tangent (value m)) by (apply Rnot_lt_le; intro l; assert (tangent (value m) ^ 2 < t ^ 2) by nra; nra).
  destruct (half_tangent_up_to t (value m) m0 h (conj t0 tm)) as [b [hb tb]].
  assert (A : exists a, Vec x y z = tilted t z (in_degrees a)).
  { destruct (Req_dec t 0) as [e | e].
    - exists 0. rewrite e in *. unfold tilted. assert (x ^ 2 + y ^ 2 = 0) by (rewrite <- R0, <- T2; ring). f_equal; nra.
    - destruct (an_angle ((z * x + y) / (t * (1 + z ^ 2))) ((z * y - x) / (t * (1 + z ^ 2)))) as [a [C S]].
      { replace (((z * x + y) / (t * (1 + z ^ 2))) ^ 2 + ((z * y - x) / (t * (1 + z ^ 2))) ^ 2)
          with ((x ^ 2 + y ^ 2) / (t ^ 2 * (1 + z ^ 2))) by (field; split; lra).
        rewrite <- R0, <- T2. field. split; lra. }
      exists a. unfold tilted. rewrite C, S. f_equal; field; split; lra. }
  destruct A as [a ->]. eexists. split; [exists a, b, s; split; [exact hb | split; [exact hs | reflexivity]] |]. apply rodrigues_tilted; assumption.
Qed.

(** ** In numbers *)

(** The cosine and the sine of an angle by the tangent of its half. *)
Definition tcosine (t : number) : number := Over (Minus (1 // 1) (Times t t)) (Plus (1 // 1) (Times t t)).
Definition tsine (t : number) : number := Over (Times (2 // 1) t) (Plus (1 // 1) (Times t t)).
Definition tturned (t p q : number) : number * number :=
  (Minus (Times (tcosine t) p) (Times (tsine t) q), Plus (Times (tsine t) p) (Times (tcosine t) q)).
Definition about_x (t : number) (b : numbers) : numbers := let (y, z) := tturned t (ny b) (nz b) in Numbers (nx b) y z.
Definition about_y (t : number) (b : numbers) : numbers := let (z, x) := tturned t (nz b) (nx b) in Numbers x (ny b) z.
Definition about_z (t : number) (b : numbers) : numbers := let (x, y) := tturned t (nx b) (ny b) in Numbers x y (nz b).

Lemma value_tcosine : forall t x, is_half_tangent (value t) x -> value (tcosine t) = cos (in_degrees x).
Proof. intros t x [-> _]. unfold tcosine. cbn [value]. f_equal; [field | f_equal; field]. Qed.
Lemma value_tsine : forall t x, is_half_tangent (value t) x -> value (tsine t) = sin (in_degrees x).
Proof. intros t x [_ ->]. unfold tsine. cbn [value]. f_equal; [field | f_equal; field]. Qed.

Lemma values_about : forall t x b, is_half_tangent (value t) x ->
  values (about_x t b) = mulv (rotation_x (in_degrees x)) (values b) /\
  values (about_y t b) = mulv (rotation_y (in_degrees x)) (values b) /\
  values (about_z t b) = mulv (rotation_z (in_degrees x)) (values b).
Proof.
  intros t x b h. pose proof (value_tcosine t x h) as C. pose proof (value_tsine t x h) as S.
  unfold about_x, about_y, about_z, tturned, values, mulv, Vec3.dot. cbn [nx ny nz value row1 row2 row3 vx vy vz rotation_x rotation_y rotation_z].
  rewrite C, S. repeat split; f_equal; ring.
Qed.

Definition ncrossed (a b : numbers) : numbers :=
  Numbers (Minus (Times (ny a) (nz b)) (Times (nz a) (ny b))) (Minus (Times (nz a) (nx b)) (Times (nx a) (nz b)))
    (Minus (Times (nx a) (ny b)) (Times (ny a) (nx b))).
Lemma values_crossed : forall a b, values (ncrossed a b) = cross (values a) (values b).
Proof. reflexivity. Qed.

(** N b/w = ((1 - |c|^2) b + 2 (c . b) c + 2 c x b)/(1 + |c|^2) *)
Definition along (c b : numbers) : numbers :=
  let q := product c c in
  scaled (Over (1 // 1) (Plus (1 // 1) q))
    (each2 Plus (each2 Plus (scaled (Minus (1 // 1) q) b) (scaled (Times (2 // 1) (product c b)) c)) (scaled (2 // 1) (ncrossed c b))).

Lemma values_along : forall c b Q, rodrigues (values c) = mscale (1 + norm2 (values c)) Q -> values (along c b) = mulv Q (values b).
Proof.
  intros c b Q h. pose proof (norm2_nonneg (values c)) as c0.
  assert (E : values (along c b) = vscale (/ (1 + norm2 (values c))) (mulv (rodrigues (values c)) (values b))).
  { unfold along. cbv zeta. rewrite values_scaled, !values_plus, !values_scaled, values_crossed. cbn [value]. rewrite value_square, value_product.
    replace (1 / 1 / (1 / 1 + norm2 (values c))) with (/ (1 + norm2 (values c))) by (field; lra). f_equal.
    generalize (values c) (values b). clear. intros [x y z] [p q r]. unfold rodrigues. unfold_vec. vec_split; field. }
  rewrite E, h, mulv_mscale. generalize (mulv Q (values b)). intros [x y z]. unfold_vec. vec_split; field; lra.
Qed.

(** A point of the platform, turned. *)
Definition turn (o : orientations) (c : list number) (b : numbers) : numbers :=
  match o, c with
  | TurnedBy _, [t] => about_z t b
  | RollPitchYaw _ _ _, [x; y; z] => about_z z (about_y y (about_x x b))
  | (TurnedUpTo _ | Tilted _ _), [x; y; z] => along (Numbers x y z) b
  | _, _ => b
  end.

(** ** Which coordinates are those of the set *)

Section Precision.
Variable bits : positive.

(** The excess of [t] over the half tangent of [x] is at most zero, or at least; of 0 degrees, it is -t. *)
Definition excess_of (t x : number) : option fixed :=
  match enclose bits t, cosine bits (Over x (2 // 1)), sine bits (Over x (2 // 1)) with
  | Some t, Some c, Some s => Some (sub s (mul bits t c))
  | _, _, _ => None
  end.
Definition is_zero (x : number) : bool := match rational x with Some q => Qeq_bool q 0 | None => false end.
Definition exceeds (is_more : bool) (t x : number) : bool :=
  if is_zero x then certainly bits false (if is_more then Minus (0 // 1) t else t)
  else match excess_of t x with Some a => if is_more then (0 <=? lo a)%Z else (hi a <=? 0)%Z | None => false end.

Lemma excess_of_sound : forall t x a, excess_of t x = Some a -> contains bits a (excess (value t) (value x)).
Proof.
  intros t x a h. unfold excess_of in h. destruct (enclose bits t) as [u |] eqn:e1; [| discriminate].
  destruct (cosine bits _) as [c |] eqn:e2; [| discriminate]. destruct (sine bits _) as [s |] eqn:e3; [| discriminate].
  assert (E : sub s (mul bits u c) = a) by congruence. subst a. apply cosine_sound in e2. apply sine_sound in e3. cbn [value] in e2, e3.
  replace (2 / 1) with 2 in e2, e3 by field. unfold excess. apply sub_sound; [exact e3 | apply mul_sound; [apply enclose_sound, e1 | exact e2]].
Qed.

Lemma exceeds_sound : forall t x (is_more : bool), exceeds is_more t x = true ->
  if is_more then 0 <= excess (value t) (value x) else excess (value t) (value x) <= 0.
Proof.
  intros t x is_more h. unfold exceeds in h. destruct (is_zero x) eqn:z.
  - unfold is_zero in z. destruct (rational x) as [q |] eqn:r; [| discriminate]. apply Qeq_bool_eq, Qeq_eqR in z.
    rewrite (rational_sound _ _ r), z. replace (Q2R 0) with 0 by (unfold Q2R; cbn; lra). unfold excess, in_degrees.
    replace (0 / 2 * PI / 180) with 0 by field. rewrite sin_0, cos_0. destruct is_more; apply nonneg_sound in h; cbn [value] in h; lra.
  - destruct (excess_of t x) as [a |] eqn:e; [| discriminate]. apply excess_of_sound in e. destruct is_more.
    + apply Z.leb_le in h. exact (contains_nonneg bits _ _ h e).
    + apply Z.leb_le, IZR_le in h. destruct e as [_ e]. pose proof (unit_R_pos bits). nra.
Qed.

Definition is_half_tangent_in (t : tolerance) (c : number) : bool :=
  below bits (least t) (greatest t) && exceeds false c (least t) && exceeds true c (greatest t).

Lemma is_half_tangent_in_sound : forall t c, is_half_tangent_in t c = true -> exists x, within t x /\ is_half_tangent (value c) x.
Proof.
  intros t c h. apply andb_true_iff in h as [h b]. apply andb_true_iff in h as [h a]. apply below_sound in h.
  apply exceeds_sound in a, b. cbn beta iota in a, b. exact (half_tangent_between _ _ _ h a b).
Qed.

(** The tangent of the half of an angle is sin/(1 + cos); of 0 it is 0. *)
Definition enclose_scaled_tangent (s : Z) (x : number) : option fixed :=
  if is_zero x then Some zero
  else let more := (bits + guard s)%positive in
    match cosine more x, sine more x with
    | Some c, Some u => option_map (fun q => cut s (mul more u q)) (recip more (add (Fixed.integer more 1) c))
    | _, _ => None
    end.
Definition enclose_tangent : number -> option fixed := enclose_scaled_tangent 0.
Lemma enclose_scaled_tangent_sound : forall s x a, enclose_scaled_tangent s x = Some a -> is_angle (Claim.value x) -> contains bits a (tangent (Claim.value x) / two_to s).
Proof.
  intros s x a h ok. unfold enclose_scaled_tangent in h. destruct (is_zero x) eqn:z.
  - injection h as <-. unfold is_zero in z. destruct (rational x) as [q |] eqn:r; [| discriminate]. apply QArith_base.Qeq_bool_eq, Qreals.Qeq_eqR in z.
    assert (q0 : Rdefinitions.Q2R q = 0) by (rewrite z; unfold Rdefinitions.Q2R; cbn; lra). rewrite (rational_sound _ _ r), q0. unfold tangent, in_degrees.
    replace (0 / 2 * PI / 180) with 0 by field. rewrite sin_0. unfold Rdiv. rewrite !Rmult_0_l. apply zero_sound.
  - cbv zeta in h. set (more := (bits + guard s)%positive) in *. destruct (cosine more x) as [c |] eqn:ec; [| discriminate]. destruct (sine more x) as [u |] eqn:es; [| discriminate].
    destruct (recip _ _) as [q |] eqn:eq; [| discriminate]. cbn [option_map] in h. assert (E : cut s (mul more u q) = a) by congruence. subst a.
    apply (cut_sound bits s). fold more. apply cosine_sound in ec. apply sine_sound in es.
    destruct (recip_sound more _ q (1 + cos (in_degrees (Claim.value x))) eq (add_sound _ _ _ _ _ (Fixed.integer_sound more 1) ec)) as [_ R].
    pose proof (half_cosine _ ok) as p0. assert (D : in_degrees (Claim.value x) = 2 * in_degrees (Claim.value x / 2)) by (unfold in_degrees; field).
    replace (tangent (Claim.value x)) with (sin (in_degrees (Claim.value x)) * / (1 + cos (in_degrees (Claim.value x)))); [apply mul_sound; assumption |].
    unfold tangent. rewrite D. set (p := in_degrees (Claim.value x / 2)) in *. rewrite sin_2a, cos_2a_cos. field. split; [lra |].
    replace (1 + (2 * cos p * cos p - 1)) with (2 * (cos p * cos p)) by ring. nra.
Qed.
Lemma enclose_tangent_sound : forall x a, enclose_tangent x = Some a -> is_angle (Claim.value x) -> contains bits a (tangent (Claim.value x)).
Proof. intros x a h ok. replace (tangent (Claim.value x)) with (tangent (Claim.value x) / two_to 0); [exact (enclose_scaled_tangent_sound 0 x a h ok) | change (two_to 0) with 1; field]. Qed.

Definition is_angle_number (x : number) : bool :=
  certainly bits true (Plus (180 // 1) x) && certainly bits true (Minus (180 // 1) x).

Lemma is_angle_number_sound : forall x, is_angle_number x = true -> is_angle (value x).
Proof. intros x h. apply andb_true_iff in h as [a b]. apply positive_sound in a, b. cbn [value] in a, b. split; lra. Qed.

Definition either_way (x : number) : tolerance := Within (Minus (0 // 1) x) x.

(** [x <= t^2 y], [t] the half tangent of [a], an angle from 0 to less than 180 degrees. *)
Definition is_up_to (a x y : number) : bool :=
  below bits (0 // 1) a && is_angle_number a &&
  match enclose_tangent a, enclose bits x, enclose bits y with
  | Some t, Some x, Some y => (0 <=? lo (sub (mul bits (sqr bits t) y) x))%Z
  | _, _, _ => false
  end.

Lemma is_up_to_sound : forall a x y, is_up_to a x y = true -> 0 <= value a /\ is_angle (value a) /\ value x <= tangent (value a) ^ 2 * value y.
Proof.
  intros a x y h. apply andb_true_iff in h as [h k]. apply andb_true_iff in h as [a0 ia]. apply below_sound in a0. apply is_angle_number_sound in ia.
  split; [cbn [value] in a0; lra |]. split; [exact ia |].
  destruct (enclose_tangent a) as [t |] eqn:et; [| discriminate]. destruct (enclose bits x) as [u |] eqn:ex; [| discriminate].
  destruct (enclose bits y) as [v |] eqn:ey; [| discriminate]. apply Z.leb_le in k. apply enclose_sound in ex, ey.
  pose proof (contains_nonneg bits _ _ k (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ (sqr_sound bits _ _ (enclose_tangent_sound _ _ et ia)) ey) ex)). lra.
Qed.

Definition is_orientation (o : orientations) (c : list number) : bool :=
  match o, c with
  | TurnedBy t, [x] => is_half_tangent_in t x
  | RollPitchYaw r p y, [x; z; w] => is_half_tangent_in r x && is_half_tangent_in p z && is_half_tangent_in y w
  | TurnedUpTo m, [x; y; z] => is_up_to m (product (Numbers x y z) (Numbers x y z)) (1 // 1)
  | Tilted m n, [x; y; z] => is_up_to m (Plus (Times x x) (Times y y)) (Plus (1 // 1) (Times z z)) && is_half_tangent_in (either_way n) z
  | _, _ => false
  end.

Lemma is_orientation_sound : forall o c, is_orientation o c = true ->
  exists Q, in_orientations o Q /\ forall b, values (turn o c b) = mulv Q (values b).
Proof.
  intros [t | r p y | m | m n] [| x [| z [| w [|]]]] h; try discriminate; cbn [is_orientation turn] in *.
  - destruct (is_half_tangent_in_sound _ _ h) as [a [ha ta]]. eexists. split; [exists a; split; [exact ha | reflexivity] |].
    intro b. apply (values_about _ _ _ ta).
  - apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2].
    destruct (is_half_tangent_in_sound _ _ h1) as [a [ha ta]]. destruct (is_half_tangent_in_sound _ _ h2) as [b [hb tb]].
    destruct (is_half_tangent_in_sound _ _ h3) as [d [hd td]]. eexists. split; [exists a, b, d; split; [exact ha | split; [exact hb | split; [exact hd | reflexivity]]] |].
    intro v. destruct (values_about _ _ (about_y z (about_x x v)) td) as [_ [_ ->]]. destruct (values_about _ _ (about_x x v) tb) as [_ [-> _]].
    destruct (values_about _ _ v ta) as [-> _]. rewrite !mulv_mulm. reflexivity.
  - destruct (is_up_to_sound _ _ _ h) as [m0 [im le]]. rewrite value_square in le. cbn [value] in le.
    destruct (up_to_found m (@values names (Numbers x z w)) m0 im ltac:(lra)) as [Q [hQ e]]. exists Q. split; [exact hQ |]. intro b. apply values_along, e.
  - apply andb_true_iff in h as [h k]. destruct (is_up_to_sound _ _ _ h) as [m0 [im le]]. destruct (is_half_tangent_in_sound _ _ k) as [s [hs ts]].
    cbn [value] in le. unfold either_way, within in hs. cbn [least greatest value] in hs.
    destruct (tilt_found m n (@values names (Numbers x z w)) s m0 im ltac:(lra) ts) as [Q [hQ e]]; [unfold values; cbn [nx ny nz vx vy vz]; lra |].
    exists Q. split; [exact hQ |]. intro b. apply values_along, e.
Qed.
End Precision.
End Named.
