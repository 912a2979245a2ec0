(** * Wrong certificates of the kernel are refused

    Each example damages a certificate or a claim of this directory and shows
    that the check is then [false]: no instance could be closed with it. *)

From Coq Require Import ZArith NArith Reals List String.
From Orthocert Require Import Claim.
From Orthocert.kernel Require Import Statement Arithmetic Check Problem Faces.
From Orthocert.kernel Require Certificate.
From Orthocert.instances Require FourSliders StrutsAndPlane OrthoglideTolerance LinearDelta DeltaSpeed DeltaMargin UpuAxes PostulateAll PostulateUpTo2.
Import ListNotations.

(** The trees that a certificate's nodes are. *)
Definition trees_in (p : Certificate.proof) : list tree :=
  match p with Certificate.Nodes _ _ nodes => match Certificate.trees_of 3 [] [] [] 4 nodes with Some ts => ts | None => [] end | _ => [] end.
Definition tree_in (p : Certificate.proof) : tree := nth 0 (trees_in p) (Leaf []).

Definition step : Type := nat * evidence.

(** The first leaf, and the last, left without a step. *)
Fixpoint without_first (t : tree) : tree :=
  match t with Leaf _ => Leaf [] | Split b k l u => Split b k (without_first l) u | Parts b j l u => Parts b j (without_first l) u end.
Fixpoint without_last (t : tree) : tree :=
  match t with Leaf _ => Leaf [] | Split b k l u => Split b k l (without_last u) | Parts b j l u => Parts b j l (without_last u) end.

(** The steps of the first leaf for all. *)
Fixpoint first_leaf (t : tree) : tree :=
  match t with
  | Leaf b => Leaf b
  | Split b _ l _ | Parts b _ l _ => match first_leaf l with Leaf more => Leaf (b ++ more) | other => other end
  end.

Fixpoint map_steps (f : list step -> list step) (t : tree) : tree :=
  match t with Leaf b => Leaf (f b) | Split b k l u => Split (f b) k (map_steps f l) (map_steps f u) | Parts b j l u => Parts (f b) j (map_steps f l) (map_steps f u) end.
Definition map_evidence (f : evidence -> evidence) : tree -> tree := map_steps (map (fun s => (fst s, f (snd s)))).

(** Another Y. *)
Definition with_Y (f : Z -> Z) (e : evidence) : evidence :=
  match e with ByLower p Y => ByLower p (map (map f) Y) | e => e end.
Definition twice (steps : list step) : list step := steps ++ steps.
Definition for_all_tests (steps : list step) : list step := map (fun s => (0%nat, snd s)) steps.

Definition requiring (c : claim) (r : list requirement) : claim := MakeClaim (legs c) (workspace c) r.

Module Sliders.
Import FourSliders.
Definition certificate : tree := tree_in the_proof.
Local Notation accepts c t := (check_claim 52 c 9 [0; 0; 0; 0]%Z t).
Local Notation over := (requiring the_claim).
Local Notation upper := (PsiMin (Over (9 // 1) (20 // 1))).
Local Notation joint := (JointMin 0 (200 // 1)).

Example the_certificate : accepts the_claim certificate = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example first_leaf_removed : accepts the_claim (without_first certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example last_leaf_removed : accepts the_claim (without_last certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example not_split : accepts the_claim (first_leaf certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example Y_of_the_other_sign : accepts the_claim (map_evidence (with_Y Z.opp) certificate) = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example Y_of_zeros : accepts the_claim (map_evidence (with_Y (fun _ => 0%Z)) certificate) = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example steps_repeated : accepts the_claim (map_steps twice certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example steps_of_one_test : accepts the_claim (map_steps for_all_tests certificate) = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example lower_bound_tightened : accepts (over [PsiMax (113 // 100); upper; joint]) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example upper_bound_tightened : accepts (over [PsiMax (Over (6 // 1) (5 // 1)); PsiMin (46 // 100); joint]) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example joint_range_narrowed : accepts (over [PsiMax (Over (6 // 1) (5 // 1)); upper; JointMin 0 (400 // 1)]) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example joint_of_a_leg_that_there_is_not : accepts (over [PsiMax (Over (6 // 1) (5 // 1)); upper; JointMin 4 (200 // 1)]) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example tests_exchanged : accepts (over [upper; PsiMax (Over (6 // 1) (5 // 1)); joint]) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example no_lower_bound : accepts (over []) (Leaf []) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example legs_left_out : accepts (MakeClaim (firstn 2 (legs the_claim)) (workspace the_claim) (require the_claim)) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
(** Out of reach: the rows are not regular. *)
Example box_out_of_reach :
  accepts (MakeClaim (legs the_claim) (Box (Tolerances (Within (400 // 1) (410 // 1)) (ty (hull (workspace the_claim))) (tz (hull (workspace the_claim))))) [NotSingular])
    (first_leaf certificate) = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
End Sliders.

Module Struts.
Import StrutsAndPlane.
Definition certificate : tree := tree_in the_proof.
Local Notation accepts c t := (check_claim 52 c 9 [0; 0; 0; 1]%Z t).

Example the_certificate : accepts the_claim certificate = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example first_leaf_removed : accepts the_claim (without_first certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example Y_of_the_other_sign : accepts the_claim (map_evidence (with_Y Z.opp) certificate) = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
(** A leg of length zero somewhere in the box: D is not positive there. *)
Example through_a_base_joint :
  accepts (MakeClaim (legs the_claim ++ [StrutLeg (hull (workspace the_claim)) (hull (workspace the_claim)) None]) (workspace the_claim) (require the_claim)) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
End Struts.

Module Tolerance.
Import OrthoglideTolerance.
Definition certificate : tree := tree_in the_proof.
Local Notation accepts c t := (check_claim 52 c 9 [0; 0; 0]%Z t).
Local Notation between least greatest := (requiring the_claim [PsiMax greatest; PsiMin least]).

Example the_certificate : accepts (between (1 // 2) (2 // 1)) certificate = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example first_leaf_removed : accepts the_claim (without_first certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example not_split : accepts the_claim (first_leaf certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example lower_bound_tightened : accepts (between (1 // 2) (19 // 10)) certificate = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example upper_bound_tightened : accepts (between (501 // 1000) (2 // 1)) certificate = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_another_machine : accepts LinearDelta.the_claim certificate = false. Proof. vm_cast_no_check (eq_refl false). Qed.

(** Halves of the first leg's length, each with this tree; the accuracy of a machine is of all. *)
Example in_halves : accepts (between (1 // 2) (2 // 1)) (Parts [] 9 certificate certificate) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example lower_half_left_out : accepts (between (1 // 2) (2 // 1)) (Parts [] 9 (without_last certificate) certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example upper_half_left_out : accepts (between (1 // 2) (2 // 1)) (Parts [] 9 certificate (Leaf [])) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example accuracy_in_halves : may_part is_of_each [Accurate zero []] [true] = false /\ may_part is_of_each [Accurate zero []; AtLeast 0] [false; true] = true. Proof. split; reflexivity. Qed.
End Tolerance.

Module Margin.
Import DeltaMargin.
Definition certificate : tree := tree_in the_proof.
Local Notation accepts c t := (check_claim 52 c 9 [0; 0; 0]%Z t).
Local Notation about r b := (MakeClaim (legs the_claim) (Cylinder (0 // 1) (0 // 1) r (Within (0 // 1) (100 // 1))) [NotSingular; ParallelMargin b]).
Definition never_negative (e : evidence) : evidence := match e with ByNegative => ByTest | e => e end.

Example the_certificate : accepts (about (80 // 1) (6 // 10)) certificate = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example first_leaf_removed : accepts the_claim (without_first certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example margin_raised : accepts (about (80 // 1) (7 // 10)) certificate = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example radius_raised : accepts (about (90 // 1) (6 // 10)) certificate = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example of_the_other_sign : accepts the_claim (map_evidence never_negative certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example rank_of_zeros : accepts the_claim (map_evidence (fun e => match e with ByRank p Y => ByRank p (map (map (fun _ => 0%Z)) Y) | e => e end) certificate) = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example rank_for_a_bound : accepts (MakeClaim (legs the_claim) (workspace the_claim) [PsiMax (1000 // 1); ParallelMargin (6 // 10)]) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
End Margin.

Module Speed.
Import DeltaSpeed.
Definition certificate : tree := tree_in the_proof.
Local Notation accepts c t := (check_claim 52 c 9 [0; 0; 0]%Z t).
(** Multiples of what is not negative in the workspace: of the other sign, and more. *)
Definition with_mu (f : Z -> Z) (e : evidence) : evidence := match e with Inside i n p => Inside i (f n) p | e => e end.
Definition all_outside (steps : list step) : list step := [(0%nat, Outside)].

Example the_certificate : accepts the_claim certificate = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example all_cells_outside : accepts the_claim (map_steps all_outside certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example mu_negative : accepts the_claim (map_evidence (with_mu Z.opp) certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example mu_great : accepts the_claim (map_evidence (with_mu (Z.mul 4096)) certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example in_a_box : accepts (MakeClaim (legs the_claim) (Box (hull (workspace the_claim))) (require the_claim)) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
End Speed.

Module Couples.
Import UpuAxes.
Definition certificate : tree := tree_in the_proof.
Local Notation accepts c t := (check_claim 52 c 8 [0; 0; 0]%Z t).

Example the_certificate : accepts the_claim certificate = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example Y_of_the_other_sign : accepts the_claim (map_evidence (with_Y Z.opp) certificate) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example margin_raised : accepts (MakeClaim (legs the_claim) (workspace the_claim)
  (map (fun r => match r with ConstraintMargin _ => ConstraintMargin (99 // 100) | r => r end) (require the_claim))) certificate = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
End Couples.

(** Of the first leaf, which touches the corner, another step. *)
Fixpoint first_by (e : evidence) (t : tree) : tree :=
  match t with Leaf _ => Leaf [(0%nat, e)] | Split b k l u => Split b k (first_by e l) u | Parts b j l u => Parts b j (first_by e l) u end.
Definition corner_for_test (f : face) (e : evidence) : evidence := match e with ByTest => ByCorner f | e => e end.
Definition mirrored (e : evidence) : evidence := ByMirror.

Module PostulateForAll.
Import PostulateAll.
Definition trees : list tree := trees_in the_proof.
Local Notation tree_ k := (nth k trees (Leaf [])).
Definition q1_low := tree_ 0. Definition q1_high := tree_ 1. Definition q2_low := tree_ 2. Definition q2_high := tree_ 3.
Local Notation accepts := (check_postulate 52).

Example the_certificate : accepts trees = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example first_leaf_removed : accepts [without_first q1_low; q1_high; q2_low; q2_high] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example last_leaf_removed : accepts [q1_low; q1_high; q2_low; without_last q2_high] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example steps_repeated : accepts (map (map_steps twice) trees) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example the_other_corner : accepts [first_by (ByCorner Q2) q1_low; q1_high; q2_low; q2_high] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example corner_by_vertices : accepts [first_by ByTest q1_low; q1_high; q2_low; q2_high] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example tight_edge_moved : accepts [map_evidence (corner_for_test Q1) q1_low; q1_high; q2_low; q2_high] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example all_mirrored : accepts [q1_low; q1_high; map_evidence mirrored q2_low; q2_high] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example one_leaf_for_all : accepts [q1_low; q1_high; q2_low; Leaf [(0%nat, ByCorner Q2)]] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example halves_exchanged : accepts [q1_low; q1_high; q2_high; q2_low] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example faces_exchanged : accepts [q2_low; q2_high; q1_low; q1_high] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example a_tree_left_out : accepts [q1_low; q1_high; q2_low] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End PostulateForAll.

(** Trees prove the range of kappa that they were found for, and a greatest psi no greater than theirs. *)
Module PostulateForARange.
Import PostulateUpTo2.
Definition trees : list tree := trees_in the_proof.
Definition q1_high := nth 0 trees (Leaf []). Definition q2_high := nth 1 trees (Leaf []).
Local Notation accepts := (check_postulate_up_to 52).

Example the_certificate : accepts (2 // 1) trees = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example greatest_increased : accepts (2000001 // 1000000) trees = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example trees_of_kappa_above_half_also_below : accepts (3 // 1) [q1_high; q1_high; q2_high; q2_high] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example tree_of_kappa_below_half_above : accepts (2 // 1) [q1_high; PostulateForAll.q2_low] = false.
Proof. vm_cast_no_check (eq_refl false). Qed.
Example trees_of_the_larger_range : accepts (2 // 1) PostulateForAll.trees = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example greatest_not_above_one : accepts (1 // 1) trees = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example corner_by_vertices : accepts (2 // 1) [first_by ByTest q1_high; q2_high] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example the_other_corner : accepts (2 // 1) [q1_high; first_by (ByCorner Q1) q2_high] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example faces_exchanged : accepts (2 // 1) [q2_high; q1_high] = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End PostulateForARange.

(** The closed design is a theorem whatever its tree: but no string of the tree may end a string of the text, so
    that what follows it would be read as another claim. *)
Module Closed.
Import Certificate.
Local Open Scope string_scope.
Local Notation two := (Literal (Decimal.D2 Decimal.Nil) Decimal.Nil).
Definition closed (name : string) (least greatest : expression) : certificate :=
  Certificate (Closed_ two two [Require_ Transmission None None (AtLeast_ least); Require_ Transmission None None (AtMost_ greatest)])
    (Nodes 52 None [Node [(1%nat, Plain name)] None None []]) "orthocert" "1".
Local Notation half := (Binary Division (Literal (Decimal.D1 Decimal.Nil) Decimal.Nil) two).

Example a_closed_design : accept (closed "cube" half two) = true. Proof. vm_cast_no_check (eq_refl true). Qed.
Example a_string_that_ends : accept (closed "cube""]]}]}},""claim"":{" half two) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example psi_min_above : accept (closed "cube" two two) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
Example another_text : verify "{}" (closed "cube" half two) = false. Proof. vm_cast_no_check (eq_refl false). Qed.
End Closed.
