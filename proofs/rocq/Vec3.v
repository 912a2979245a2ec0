(** * Vectors and 3x3 matrices over the reals

    Plain records, so that every statement about a mechanism can be unfolded
    to an equation between real numbers and closed by [ring], [field], [lra]
    or [nra].  A matrix is given by its rows, because each row of the inverse
    Jacobian belongs to one leg. *)

From Coq Require Import Reals Lra Psatz.
Local Open Scope R_scope.

(** ** Vectors *)

Record vec := Vec { vx : R; vy : R; vz : R }.

Definition vzero : vec := Vec 0 0 0.
Definition vadd (u v : vec) : vec := Vec (vx u + vx v) (vy u + vy v) (vz u + vz v).
Definition vsub (u v : vec) : vec := Vec (vx u - vx v) (vy u - vy v) (vz u - vz v).
Definition vscale (a : R) (v : vec) : vec := Vec (a * vx v) (a * vy v) (a * vz v).

Definition dot (u v : vec) : R := vx u * vx v + vy u * vy v + vz u * vz v.
(** Squared Euclidean length |v|^2. *)
Definition norm2 (v : vec) : R := vx v ^ 2 + vy v ^ 2 + vz v ^ 2.
Definition cross (u v : vec) : vec :=
  Vec (vy u * vz v - vz u * vy v) (vz u * vx v - vx u * vz v) (vx u * vy v - vy u * vx v).

Definition e1 : vec := Vec 1 0 0.
Definition e2 : vec := Vec 0 1 0.
Definition e3 : vec := Vec 0 0 1.
(** The point (c,c,c) of the diagonal; the Orthoglide's Q_1 and Q_2 are of this form. *)
Definition diagonal (c : R) : vec := Vec c c c.

(** ** Matrices *)

Record mat := Mat { row1 : vec; row2 : vec; row3 : vec }.

(** M v *)
Definition mulv (M : mat) (v : vec) : vec := Vec (dot (row1 M) v) (dot (row2 M) v) (dot (row3 M) v).
Definition col1 (M : mat) : vec := Vec (vx (row1 M)) (vx (row2 M)) (vx (row3 M)).
Definition col2 (M : mat) : vec := Vec (vy (row1 M)) (vy (row2 M)) (vy (row3 M)).
Definition col3 (M : mat) : vec := Vec (vz (row1 M)) (vz (row2 M)) (vz (row3 M)).
Definition transpose (M : mat) : mat := Mat (col1 M) (col2 M) (col3 M).
Definition mulm (M N : mat) : mat :=
  let T := transpose N in Mat (mulv T (row1 M)) (mulv T (row2 M)) (mulv T (row3 M)).
Definition madd (M N : mat) : mat :=
  Mat (vadd (row1 M) (row1 N)) (vadd (row2 M) (row2 N)) (vadd (row3 M) (row3 N)).
Definition msub (M N : mat) : mat :=
  Mat (vsub (row1 M) (row1 N)) (vsub (row2 M) (row2 N)) (vsub (row3 M) (row3 N)).
Definition mscale (a : R) (M : mat) : mat :=
  Mat (vscale a (row1 M)) (vscale a (row2 M)) (vscale a (row3 M)).
Definition mdiag (a b c : R) : mat := Mat (Vec a 0 0) (Vec 0 b 0) (Vec 0 0 c).
Definition midentity : mat := mdiag 1 1 1.
Definition det (M : mat) : R := dot (row1 M) (cross (row2 M) (row3 M)).

(** Goals that are equations or inequalities between explicit coordinates.
    Not for use where a section variable is a vector or a matrix: [destruct]
    cannot remove it, and the loop does not end. *)
Ltac unfold_vec :=
  repeat match goal with
    | M : mat |- _ => destruct M
    | v : vec |- _ => destruct v
    end;
  unfold midentity, mdiag, det, mulm, transpose, madd, msub, mscale, mulv, col1, col2, col3,
    diagonal, e1, e2, e3, cross, vadd, vsub, vscale, vzero, norm2, dot in *;
  cbn [vx vy vz row1 row2 row3] in *.
Ltac vec_split :=
  repeat match goal with
    | |- Vec _ _ _ = Vec _ _ _ => f_equal
    | |- Mat _ _ _ = Mat _ _ _ => f_equal
    end.
Ltac vec_ring := intros; unfold_vec; vec_split; ring.

(** ** The identities used elsewhere *)

Lemma vec_ext : forall u v, vx u = vx v -> vy u = vy v -> vz u = vz v -> u = v.
Proof. intros [ux uy uz] [wx wy wz]; cbn; intros; subst; reflexivity. Qed.

Lemma norm2_dot : forall v, norm2 v = dot v v.
Proof. vec_ring. Qed.

Lemma norm2_scale : forall a v, norm2 (vscale a v) = a ^ 2 * norm2 v.
Proof. vec_ring. Qed.

Lemma dot_transpose : forall M u v, dot u (mulv M v) = dot (mulv (transpose M) u) v.
Proof. vec_ring. Qed.

Lemma mulv_mulm : forall M N v, mulv (mulm M N) v = mulv M (mulv N v).
Proof. vec_ring. Qed.

Lemma mulv_identity : forall v, mulv midentity v = v.
Proof. intros. apply vec_ext; unfold_vec; ring. Qed.

Lemma mulv_madd : forall M N v, mulv (madd M N) v = vadd (mulv M v) (mulv N v).
Proof. vec_ring. Qed.

Lemma mulv_msub : forall M N v, mulv (msub M N) v = vsub (mulv M v) (mulv N v).
Proof. vec_ring. Qed.

Lemma mulv_mscale : forall a M v, mulv (mscale a M) v = vscale a (mulv M v).
Proof. vec_ring. Qed.

Lemma mulv_scale : forall M a v, mulv M (vscale a v) = vscale a (mulv M v).
Proof. vec_ring. Qed.

Lemma norm2_nonneg : forall v, 0 <= norm2 v.
Proof. intros. unfold_vec. nra. Qed.

Lemma norm2_zero : forall v, norm2 v = 0 -> v = vzero.
Proof. intros [x y z] h. unfold_vec. f_equal; nra. Qed.

Lemma norm2_pos : forall v, v <> vzero -> 0 < norm2 v.
Proof.
  intros v h. destruct (norm2_nonneg v) as [p | p]; [exact p |].
  exfalso; apply h, norm2_zero; symmetry; exact p.
Qed.

(** Lagrange's identity: |u|^2 |v|^2 = (u.v)^2 + |u x v|^2. *)
Lemma lagrange : forall u v, norm2 u * norm2 v = dot u v ^ 2 + norm2 (cross u v).
Proof. vec_ring. Qed.

Lemma cauchy_schwarz : forall u v, dot u v ^ 2 <= norm2 u * norm2 v.
Proof. intros. rewrite lagrange. pose proof (norm2_nonneg (cross u v)). lra. Qed.
