(** * Exact numbers, and sliders within tolerances

    An instance states its theorem with these definitions and those of
    kernel/Statement.v: they have to be read to know what is proved; the
    checker does not. *)

From Coq Require Import ZArith QArith Reals Lra.
From Orthocert Require Import Vec3 SingularValues Kinematics.
Local Open Scope R_scope.

(** ** Exact numbers *)

(** The values of the parameters of an atlas, in any cell of it: how far each is from the least value to the greatest. *)
Class naming := { along : nat -> R; along_within : forall k, 0 <= along k <= 1 }.

Inductive number :=
  | Ratio (n : Z) (d : positive)
  | Varying (k : nat) (a b : Q)     (* parameter [k] of an atlas, in a cell in which it is from [a] to [b] *)
  | Plus (x y : number)
  | Minus (x y : number)
  | Times (x y : number)
  | Over (x y : number)
  | Root (x : number).

Notation "n // d" := (Ratio n d) (at level 40).

Section Named.
Context {names : naming}.

Fixpoint value (x : number) : R :=
  match x with
  | Ratio n d => IZR n / IZR (Zpos d)
  | Varying k a b => Q2R a + along k * (Q2R b - Q2R a)
  | Plus x y => value x + value y
  | Minus x y => value x - value y
  | Times x y => value x * value y
  | Over x y => value x / value y
  | Root x => sqrt (value x)
  end.

(** A parameter: every value from [least] to [greatest]. *)
Record tolerance := Within { least : number; greatest : number }.
Definition within (t : tolerance) (x : R) : Prop := value (least t) <= x <= value (greatest t).
Definition exactly (x : number) : tolerance := Within x x.

(** The same for the three coordinates of a vector, independently. *)
Record tolerances := Tolerances { tx : tolerance; ty : tolerance; tz : tolerance }.
Definition all_within (t : tolerances) (v : vec) : Prop :=
  within (tx t) (vx v) /\ within (ty t) (vy v) /\ within (tz t) (vz v).

(** ** Machines *)

(** A leg of fixed length on a linear guide.  [direction] may have any length
    but zero; the axis is that vector normalised.  [mode]: whether the leg
    points along its guide's direction ([true]) or against it. *)
Record slider := Slider {
  direction : tolerances;
  anchor : tolerances;
  platform : tolerances;
  length : tolerance;
  mode : bool
}.

Definition is_leg (c : slider) (l : leg) : Prop :=
  (exists d, all_within (direction c) d /\ axis l = vscale (/ sqrt (norm2 d)) d) /\
  all_within (anchor c) (base_point l) /\
  all_within (platform c) (platform_offset l) /\
  within (length c) (leg_length l) /\
  working_mode l = (if mode c then 1 else -1).
End Named.

(** Where no number varies, all are the same. *)
#[export, refine] Instance unnamed : naming | 100 := {| along := fun _ => 0 |}.
Proof. intros _. lra. Defined.

(** A parameter has each value between the ends of a cell. *)
Lemma every_value : forall ranges : nat -> Q * Q, forall x : nat -> R, (forall k, Q2R (fst (ranges k)) <= x k <= Q2R (snd (ranges k))) ->
  exists names : naming, forall k, @value names (Varying k (fst (ranges k)) (snd (ranges k))) = x k.
Proof.
  intros ranges x h.
  set (t := fun k => (x k - Q2R (fst (ranges k))) / (Q2R (snd (ranges k)) - Q2R (fst (ranges k)))).
  set (c := fun k => Rmax 0 (Rmin 1 (t k))).
  assert (C : forall k, 0 <= c k <= 1) by (intro k; unfold c, Rmax, Rmin; repeat destruct (Rle_dec _ _); lra).
  exists {| along := c; along_within := C |}. intro k. cbn [value along]. specialize (h k). unfold c, t.
  set (a := Q2R (fst (ranges k))) in *. set (b := Q2R (snd (ranges k))) in *. destruct (Req_dec (b - a) 0) as [z | z].
  - rewrite z. lra.
  - assert (p : 0 < b - a) by lra. assert (0 <= (x k - a) / (b - a)).
    { apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat, p]. }
    assert ((x k - a) / (b - a) <= 1) by (apply Rmult_le_reg_r with (b - a); [exact p |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
    rewrite Rmin_right, Rmax_right by lra. field. lra.
Qed.
