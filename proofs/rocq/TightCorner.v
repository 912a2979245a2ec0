(** * A corner at which the bound is reached

    There sigma_min = kappa: the matrix of the lower bound is singular at a
    vertex of the box, and no test at all vertices can succeed.  It may be
    semidefinite at that vertex if it is definite at the others.  Of the
    kernel's evidence `corner` this is the argument. *)

From Coq Require Import Reals Lra Psatz.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal.
Local Open Scope R_scope.

(** The quadratic form v^T S v.  Only the symmetric part of S matters. *)
Definition quad (S : mat) (v : vec) : R := dot v (mulv S v).
Definition positive_definite (S : mat) : Prop := forall v, v <> vzero -> 0 < quad S v.
Definition positive_semidefinite (S : mat) : Prop := forall v, 0 <= quad S v.

Lemma positive_definite_semidefinite : forall S, positive_definite S -> positive_semidefinite S.
Proof.
  intros S h v. destruct (Req_dec (norm2 v) 0) as [z | n].
  - apply norm2_zero in z. subst v. apply Req_le. unfold quad. unfold_vec. ring.
  - apply Rlt_le, h. intro z. apply n. subst v. unfold_vec. ring.
Qed.

Lemma zero_or_not : forall v : vec, v = vzero \/ v <> vzero.
Proof.
  intro v. destruct (Req_dec (norm2 v) 0) as [e | n]; [left; apply norm2_zero; exact e |].
  right. intros ->. apply n. unfold_vec. ring.
Qed.

(** ** Boxes and their vertices *)

Definition in_range (lo hi d : vec) : Prop :=
  vx lo <= vx d <= vx hi /\ vy lo <= vy d <= vy hi /\ vz lo <= vz d <= vz hi.

Definition is_vertex (lo hi v : vec) : Prop :=
  (vx v = vx lo \/ vx v = vx hi) /\ (vy v = vy lo \/ vy v = vy hi) /\ (vz v = vz lo \/ vz v = vz hi).

Definition between (t : R) (u w : vec) : vec := vadd (vscale (1 - t) u) (vscale t w).

Definition convex (Q : vec -> Prop) : Prop :=
  forall t u w, 0 <= t <= 1 -> Q u -> Q w -> Q (between t u w).

(** A convex set that contains the eight vertices contains the box. *)
Theorem vertices_suffice : forall Q lo hi, convex Q ->
  (forall v, is_vertex lo hi v -> Q v) -> forall d, in_range lo hi d -> Q d.
Proof.
  intros Q [lx ly lz] [ux uy uz] C V [x y z] [hx [hy hz]]. cbn [vx vy vz] in *.
  (* one coordinate at a time: an edge is filled by its two ends *)
  assert (R1 : forall l h u, l <= u <= h -> exists t, 0 <= t <= 1 /\ u = (1 - t) * l + t * h).
  { intros l h u hu. destruct (Req_dec l h) as [e | ne].
    - exists 0. split; [lra |]. rewrite e in *. lra.
    - exists ((u - l) / (h - l)). assert (E : (u - l) / (h - l) * (h - l) = u - l) by (field; lra).
      split; [split; apply Rmult_le_reg_r with (h - l); lra | lra]. }
  assert (X : forall b c, (b = ly \/ b = uy) -> (c = lz \/ c = uz) -> Q (Vec x b c)).
  { intros b c hb hc. destruct (R1 _ _ _ hx) as [t [ht e]].
    replace (Vec x b c) with (between t (Vec lx b c) (Vec ux b c))
      by (unfold between; unfold_vec; vec_split; rewrite ?e; ring).
    apply C; [exact ht | |]; apply V; repeat split; cbn [vx vy vz]; auto. }
  assert (Y : forall c, (c = lz \/ c = uz) -> Q (Vec x y c)).
  { intros c hc. destruct (R1 _ _ _ hy) as [t [ht e]].
    replace (Vec x y c) with (between t (Vec x ly c) (Vec x uy c))
      by (unfold between; unfold_vec; vec_split; rewrite ?e; ring).
    apply C; [exact ht | |]; apply X; auto. }
  destruct (R1 _ _ _ hz) as [t [ht e]].
  replace (Vec x y z) with (between t (Vec x y lz) (Vec x y uz))
    by (unfold between; unfold_vec; vec_split; rewrite ?e; ring).
  apply C; [exact ht | |]; apply Y; auto.
Qed.

(** ** Affine matrix functions *)

(** A(d) = M0 + d_1 E_1 + d_2 E_2 + d_3 E_3. *)
Definition affine (M0 E1 E2 E3 : mat) (d : vec) : mat :=
  madd M0 (madd (mscale (vx d) E1) (madd (mscale (vy d) E2) (mscale (vz d) E3))).

Lemma mulv_affine : forall M0 E1 E2 E3 d v,
  mulv (affine M0 E1 E2 E3 d) v
  = vadd (mulv M0 v) (vadd (vscale (vx d) (mulv E1 v)) (vadd (vscale (vy d) (mulv E2 v)) (vscale (vz d) (mulv E3 v)))).
Proof. intros. unfold affine. rewrite !mulv_madd, !mulv_mscale. reflexivity. Qed.

Lemma affine_between : forall M0 E1 E2 E3 t u w v,
  mulv (affine M0 E1 E2 E3 (between t u w)) v
  = between t (mulv (affine M0 E1 E2 E3 u) v) (mulv (affine M0 E1 E2 E3 w) v).
Proof.
  intros. rewrite !mulv_affine. generalize (mulv M0 v) (mulv E1 v) (mulv E2 v) (mulv E3 v).
  unfold between. vec_ring.
Qed.

Lemma between_0 : forall u w, between 0 u w = u.
Proof. intros. unfold between. apply vec_ext; unfold_vec; ring. Qed.

Lemma between_1 : forall u w, between 1 u w = w.
Proof. intros. unfold between. apply vec_ext; unfold_vec; ring. Qed.

Lemma between_zero : forall t, between t vzero vzero = vzero.
Proof. intros. unfold between. vec_ring. Qed.

Lemma affine_zero : forall M0 E1 E2 E3, affine M0 E1 E2 E3 vzero = M0.
Proof.
  intros [[a11 a12 a13] [a21 a22 a23] [a31 a32 a33]] E1 E2 E3. unfold affine.
  unfold_vec. vec_split; ring.
Qed.

(** W A - kappa I, whose form is v^T W A v - kappa |v|^2. *)
Definition lower_test (W : mat) (kappa : R) (A : mat) : mat := msub (mulm W A) (mscale kappa midentity).

Lemma quad_lower_test : forall W kappa A v,
  quad (lower_test W kappa A) v = dot (mulv (transpose W) v) (mulv A v) - kappa * norm2 v.
Proof.
  intros. unfold quad, lower_test. rewrite mulv_msub, mulv_mscale, mulv_identity, mulv_mulm.
  rewrite <- dot_transpose. generalize (mulv A v). intro u. generalize (mulv W u). vec_ring.
Qed.

Lemma lower_test_between : forall W kappa M0 E1 E2 E3 t u w v,
  quad (lower_test W kappa (affine M0 E1 E2 E3 (between t u w))) v
  = (1 - t) * quad (lower_test W kappa (affine M0 E1 E2 E3 u)) v
    + t * quad (lower_test W kappa (affine M0 E1 E2 E3 w)) v.
Proof. intros. rewrite !quad_lower_test, affine_between. unfold between. vec_ring. Qed.

(** The bound that the test gives for one matrix. *)
Lemma lower_test_sound : forall W kappa A, orthogonal W -> 0 <= kappa ->
  positive_semidefinite (lower_test W kappa A) -> sigma_at_least kappa A.
Proof.
  intros W kappa A hW hk h. apply (symmetric_part W); [exact hW | exact hk |]. intro v.
  specialize (h v). rewrite quad_lower_test in h. rewrite mulv_mulm, dot_transpose. lra.
Qed.

(** ** One affine function *)

Section Affine.
Variables M0 E1 E2 E3 : mat.
Variables lo hi : vec.
Let A := affine M0 E1 E2 E3.

Lemma lower_convex : forall W kappa, convex (fun d => positive_semidefinite (lower_test W kappa (A d))).
Proof.
  intros W kappa t u w ht hu hw v. unfold A. rewrite lower_test_between.
  specialize (hu v). specialize (hw v).
  apply Rplus_le_le_0_compat; apply Rmult_le_pos; try lra; assumption.
Qed.

(** Tight corner: vertex 0 is only positive semidefinite (there the bound
    holds with equality), every other vertex is positive definite.  Then the
    bound holds on the box, and strictly everywhere but at d = 0.  A side of
    length 0 merges vertices with vertex 0 and asks nothing of them. *)
Theorem affine_tight_corner : forall W kappa, orthogonal W -> 0 <= kappa ->
  positive_semidefinite (lower_test W kappa (A vzero)) ->
  (forall v, is_vertex lo hi v -> v <> vzero -> positive_definite (lower_test W kappa (A v))) ->
  forall d, in_range lo hi d ->
    sigma_at_least kappa (A d) /\ (d <> vzero -> positive_definite (lower_test W kappa (A d))).
Proof.
  intros W kappa hW hk V0 V d hd.
  set (Q := fun d => positive_semidefinite (lower_test W kappa (A d)) /\
                     (d <> vzero -> positive_definite (lower_test W kappa (A d)))).
  assert (C : convex Q).
  { intros t u w ht [su du] [sw dw]. split; [apply lower_convex; assumption |].
    intros nz v hv. unfold A. rewrite lower_test_between. specialize (su v). specialize (sw v).
    fold (A u) in *. fold (A w) in *.
    pose proof (between_zero t) as Z.
    destruct (Req_dec t 0) as [t0 | t0]; [| destruct (Req_dec t 1) as [t1 | t1]].
    - (* the point u itself *)
      subst t. rewrite between_0 in nz.
      specialize (du nz v hv). lra.
    - subst t. rewrite between_1 in nz.
      specialize (dw nz v hv). lra.
    - destruct (zero_or_not u) as [-> | nu].
      + destruct (zero_or_not w) as [-> | nw]; [contradiction |]. specialize (dw nw v hv).
        assert (0 <= (1 - t) * quad (lower_test W kappa (A vzero)) v) by (apply Rmult_le_pos; lra).
        assert (0 < t * quad (lower_test W kappa (A w)) v) by (apply Rmult_lt_0_compat; lra). lra.
      + specialize (du nu v hv).
        assert (0 < (1 - t) * quad (lower_test W kappa (A u)) v) by (apply Rmult_lt_0_compat; lra).
        assert (0 <= t * quad (lower_test W kappa (A w)) v) by (apply Rmult_le_pos; lra). lra. }
  assert (QV : forall v, is_vertex lo hi v -> Q v).
  { intros v hv. destruct (zero_or_not v) as [-> | nz]; split.
    - exact V0. - intro n; contradiction.
    - apply positive_definite_semidefinite, V; assumption. - intros _. apply V; assumption. }
  destruct (vertices_suffice Q lo hi C QV d hd) as [s p].
  split; [apply (lower_test_sound W); assumption | exact p].
Qed.
End Affine.

(** ** A box of the workspace

    M(P) = M(c) + sum_k (P - c)_k E_k(P), where each E_k(P) is only known to
    lie in an enclosure, the same for the whole box.  What is tested at each
    vertex v is the whole family M(c) + sum_k v_k [E_k].  For a fixed P the
    matrices E_k(P) are fixed too, so the affine rules apply. *)

Section Box.
Variable Mfun : vec -> mat.
Variables lo hi c : vec.
Variables M0 : mat.
Variables Enc1 Enc2 Enc3 : mat -> Prop.
Let inside (P : vec) := in_range lo hi (vsub P c).
Hypothesis slopes : forall P, inside P ->
  exists E1 E2 E3, Enc1 E1 /\ Enc2 E2 /\ Enc3 E3 /\ Mfun P = affine M0 E1 E2 E3 (vsub P c).

Let family (test : mat -> Prop) (v : vec) : Prop :=
  forall E1 E2 E3, Enc1 E1 -> Enc2 E2 -> Enc3 E3 -> test (affine M0 E1 E2 E3 v).

(** [c] is the corner where the bound is tight, and M0 is exactly M(c). *)
Theorem tight_corner_rule : forall W kappa, orthogonal W -> 0 <= kappa ->
  positive_semidefinite (lower_test W kappa M0) ->
  (forall v, is_vertex lo hi v -> v <> vzero ->
     family (fun A => positive_definite (lower_test W kappa A)) v) ->
  forall P, inside P -> sigma_at_least kappa (Mfun P).
Proof.
  intros W kappa hW hk V0 V P hP. destruct (slopes P hP) as [E1 [E2 [E3 [e1 [e2 [e3 ->]]]]]].
  apply (affine_tight_corner M0 E1 E2 E3 lo hi W); auto.
  - rewrite affine_zero. exact V0.
  - intros v hv nz. apply V; assumption.
Qed.
End Box.

(** ** The matrix at a tight corner of the Orthoglide *)

(** In the basis (1,1,1), (1,-1,0), (1,1,-2), M(Q) - kappa I is diagonal. *)
Definition corner_basis : mat := Mat (Vec 1 1 1) (Vec 1 (-1) 1) (Vec 1 0 (-2)).

Lemma tight_corner_diagonal : forall m kappa,
  mulm (transpose corner_basis) (mulm (msub (constant_offdiagonal m) (mscale kappa midentity)) corner_basis)
  = mdiag (3 * (1 + 2 * m - kappa)) (2 * (1 - m - kappa)) (6 * (1 - m - kappa)).
Proof.
  intros m kappa. set (p := 1 + 2 * m - kappa). set (q := 1 - m - kappa).
  (* the basis consists of eigenvectors: first their images, then the products *)
  assert (E : mulm (msub (constant_offdiagonal m) (mscale kappa midentity)) corner_basis
            = Mat (Vec p q q) (Vec p (- q) q) (Vec p 0 (-2 * q)))
    by (unfold p, q, corner_basis, constant_offdiagonal; vec_ring).
  rewrite E. clearbody p q. clear. unfold corner_basis. vec_ring.
Qed.

(** So two rational comparisons decide the semidefiniteness at vertex 0. *)
Theorem tight_corner_semidefinite : forall m kappa,
  positive_semidefinite (lower_test midentity kappa (constant_offdiagonal m))
  <-> kappa <= 1 + 2 * m /\ kappa <= 1 - m.
Proof.
  intros m kappa.
  assert (Q : forall x y z, quad (lower_test midentity kappa (constant_offdiagonal m)) (Vec x y z)
    = ((1 + 2 * m - kappa) * (x + y + z) ^ 2
       + (1 - m - kappa) * ((x - y) ^ 2 + (x - z) ^ 2 + (y - z) ^ 2)) / 3)
    by (intros; unfold quad, lower_test, constant_offdiagonal; unfold_vec; field).
  split.
  - intro h. pose proof (h (Vec 1 1 1)) as h1. pose proof (h (Vec 1 (-1) 0)) as h2.
    rewrite Q in h1, h2. lra.
  - intros [h1 h2] [x y z]. rewrite Q. pose proof (pow2_ge_0 (x - y)). pose proof (pow2_ge_0 (x - z)).
    pose proof (pow2_ge_0 (y - z)).
    assert (0 <= (1 + 2 * m - kappa) * (x + y + z) ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]).
    assert (0 <= (1 - m - kappa) * ((x - y) ^ 2 + (x - z) ^ 2 + (y - z) ^ 2)) by (apply Rmult_le_pos; lra).
    lra.
Qed.
