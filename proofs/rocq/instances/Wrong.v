(** * Wrong certificates are refused

    Each example damages a certificate or a claim of this directory and shows
    that the check is then [false]: no instance could be closed with it. *)

From Coq Require Import ZArith List.
From Orthocert Require Import Claim Checker CheckerPostulate.
From Orthocert.instances Require OrthoglideTolerance LinearDelta PostulateAll PostulateUpTo2.
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

Fixpoint map_rules (f : face_rule -> face_rule) (t : face_tree) : face_tree :=
  match t with
  | FaceLeaf by_ => FaceLeaf (f by_)
  | FaceSplit k first second => FaceSplit k (map_rules f first) (map_rules f second)
  end.

(** The first leaf, which touches the corner, by another rule. *)
Fixpoint first_by (rule : face_rule) (t : face_tree) : face_tree :=
  match t with
  | FaceLeaf _ => FaceLeaf rule
  | FaceSplit k first second => FaceSplit k (first_by rule first) second
  end.

Module PostulateForAll.
Import PostulateAll.

Local Notation accepts := (check_postulate 64).

Example edge_rule_replaced : accepts (first_by BlowUp q1_low) q1_high q2_low q2_high = false.
Proof. vm_compute. reflexivity. Qed.
Example edge_rule_moved :
  accepts (map_rules (fun r => match r with BlowUp => EdgeRule | r => r end) q1_low) q1_high q2_low q2_high = false.
Proof. vm_compute. reflexivity. Qed.
Example all_mirrored : accepts q1_low q1_high (map_rules (fun _ => Mirror) q2_low) q2_high = false.
Proof. vm_compute. reflexivity. Qed.
Example one_leaf_for_all : accepts q1_low q1_high q2_low (FaceLeaf EdgeRule) = false.
Proof. vm_compute. reflexivity. Qed.
Example halves_exchanged : accepts q1_low q1_high q2_high q2_low = false.
Proof. vm_compute. reflexivity. Qed.
End PostulateForAll.

(** Trees prove the range of kappa that they were found for, and a greatest psi no greater than theirs. *)
Module PostulateForARange.
Import PostulateUpTo2.
Local Notation accepts := (check_postulate_up_to 64).

Example greatest_increased : accepts (2000001 // 1000000) q1 q2 = false.
Proof. vm_compute. reflexivity. Qed.
Example trees_of_kappa_above_half_also_below :
  accepts (3 // 1) (Both q1_high q1_high) (Both q2_high q2_high) = false.
Proof. vm_compute. reflexivity. Qed.
Example tree_of_kappa_below_half_above : accepts (2 // 1) (HighOnly PostulateAll.q1_low) q2 = false.
Proof. vm_compute. reflexivity. Qed.
Example greatest_not_above_one : accepts (1 // 1) q1 q2 = false. Proof. vm_compute. reflexivity. Qed.
Example edge_rule_replaced : accepts (2 // 1) (HighOnly (first_by BlowUp q1_high)) q2 = false.
Proof. vm_compute. reflexivity. Qed.
Example faces_exchanged : accepts (2 // 1) q2 q1 = false. Proof. vm_compute. reflexivity. Qed.
End PostulateForARange.
