(** * Wrong certificates are refused

    Each example damages a certificate or a claim of this directory and shows
    that the check is then [false]: no instance could be closed with it. *)

From Coq Require Import ZArith List.
From Orthocert Require Import Claim Checker.
From Orthocert.instances Require OrthoglideTolerance LinearDelta.
Import ListNotations.

(** The first leaf left without a rule. *)
Fixpoint without_first_leaf (t : tree) : tree :=
  match t with
  | Leaf _ => Leaf []
  | Split steps k first second => Split steps k (without_first_leaf first) second
  end.

(** The last leaf left without a rule. *)
Fixpoint without_last_leaf (t : tree) : tree :=
  match t with
  | Leaf _ => Leaf []
  | Split steps k first second => Split steps k first (without_last_leaf second)
  end.

(** The tree without the split at its root: the rules of the first leaf for all. *)
Fixpoint first_leaf (t : tree) : tree :=
  match t with
  | Leaf steps => Leaf steps
  | Split steps _ first _ =>
      match first_leaf first with Leaf more => Leaf (steps ++ more) | other => other end
  end.

(** Another orthogonal matrix in every lower rule. *)
Definition turn (s : step) : step :=
  match s with Lower a b c d sign => Lower a b c d (negb sign) | Upper => Upper end.
Fixpoint turned (t : tree) : tree :=
  match t with
  | Leaf steps => Leaf (map turn steps)
  | Split steps k first second => Split (map turn steps) k (turned first) (turned second)
  end.

Definition with_bounds (c : machine_claim) (least greatest : number) : machine_claim :=
  MachineClaim (slider1 c) (slider2 c) (slider3 c) (workspace c) (Some least) (Some greatest).

Module Tolerance.
Import OrthoglideTolerance.
Local Notation accepts c t := (check 100 c t).
Example first_leaf_removed : accepts claim (without_first_leaf certificate) = false. Proof. vm_compute. reflexivity. Qed.
Example last_leaf_removed : accepts claim (without_last_leaf certificate) = false. Proof. vm_compute. reflexivity. Qed.
Example not_split : accepts claim (first_leaf certificate) = false. Proof. vm_compute. reflexivity. Qed.
Example rule_turned : accepts claim (turned certificate) = false. Proof. vm_compute. reflexivity. Qed.
Example lower_bound_tightened : accepts (with_bounds claim (1 // 2) (19 // 10)) certificate = false.
Proof. vm_compute. reflexivity. Qed.
Example upper_bound_tightened : accepts (with_bounds claim (501 // 1000) (2 // 1)) certificate = false.
Proof. vm_compute. reflexivity. Qed.
End Tolerance.

Module Delta.
Import LinearDelta.
Local Notation accepts c t := (check 100 c t).
Example first_leaf_removed : accepts claim (without_first_leaf certificate) = false. Proof. vm_compute. reflexivity. Qed.
Example bound_tightened : accepts (with_bounds claim (1 // 2) (3 // 2)) certificate = false.
Proof. vm_compute. reflexivity. Qed.
End Delta.
