(** * Pavings: a box cut into cells in which a claim holds, cells in which it fails, and undecided ones

    A paving is read node by node, in preorder: [read_node] takes the next one, and keeps nothing but the cells that
    are to be read and what those that were read are, in numbers.  What is known at the end is [is_paving]:
    to know what has been proved, read it, with the definitions before it and those of Statement.v. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Fixed Claim.
From Orthocert.kernel Require Import Statement Linear Arithmetic Slope Test Cell Check Number Machine Formula Problem Witness NoCube Symmetry.
From Orthocert.kernel Require Configuration Compare.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** ** What is shown

    Where in the box a point is, is told by three numbers from 0 to 1, u. *)

(** [index/2^level, (index + 1)/2^level] *)
Record edge := Edge { index : Z; level : N }.
(** Its edges along x, y and z. *)
Definition cell : Type := list edge.

Definition pieces (level : N) : Z := 2 ^ Z.of_N level.
Definition on_edge (e : edge) (u : R) : Prop := IZR (index e) <= u * IZR (pieces (level e)) <= IZR (index e + 1).
Definition in_cell (k : cell) (u : list R) : Prop := Forall2 on_edge k u.
Definition in_box (u : list R) : Prop := length u = 3%nat /\ Forall (fun t => 0 <= t <= 1) u.

(** Its share of the box's volume, in units of 2^-120. *)
Definition share_places : Z := 120.
Definition depth_of (k : cell) : Z := fold_right (fun e n => Z.of_N (level e) + n)%Z 0%Z k.
Definition share (k : cell) : Z := 2 ^ (share_places - depth_of k).
Definition halved (upper : Z) (e : edge) : edge := Edge (2 * index e + upper) (N.succ (level e)).
Definition half (upper : Z) (k : nat) (c : cell) : cell := firstn k c ++ match skipn k c with e :: r => halved upper e :: r | [] => [] end.

(** Of machines that look the same from permuted axes, the points with u_1 < u_2 < u_3 stand for all: what counts of a cell is six times
    the volume of its points in order.  An edge that holds another is halved until every two are the same, or
    overlap in an end at most: then all points are in order or none, of two that are the same half of them, of three a sixth. *)
Definition in_order (u : list R) : Prop := nth 0 u 0 < nth 1 u 0 < nth 2 u 0.
Definition is_after (e f : edge) : bool := ((index f + 1) * pieces (level e) <=? index e * pieces (level f))%Z.
Definition is_same (e f : edge) : bool := (index e =? index f)%Z && (level e =? level f)%N.
(** No point of it is in order. *)
Definition is_mirrored (k : cell) : bool := match k with [x; y; z] => is_after x y || is_after y z || is_after x z | _ => false end.
Fixpoint six_ordered (depth : nat) (k : cell) : Z :=
  match depth, k with
  | S d, [x; y; z] =>
      let longer i j := match nth_error k i, nth_error k j with
        | Some e, Some f => if is_after f e || is_same e f then None else Some (if (level e <? level f)%N then i else j)
        | _, _ => None
        end in
      let halves i := (six_ordered d (half 0 i k) + six_ordered d (half 1 i k))%Z in
      if is_mirrored k then 0%Z else
      match longer 0%nat 1%nat, longer 1%nat 2%nat, longer 0%nat 2%nat with
      | Some i, _, _ | None, Some i, _ | None, None, Some i => halves i
      | None, None, None => (share k * match is_same x y, is_same y z with false, false => 6 | true, true => 1 | _, _ => 3 end)%Z
      end
  | _, _ => 0%Z
  end.
Definition weight (symmetric : bool) (k : cell) : Z := if symmetric then six_ordered 128 k else share k.
Definition weights (symmetric : bool) (ks : list cell) : Z := fold_right (fun k n => weight symmetric k + n)%Z 0%Z ks.

Definition between (t : tolerance) (u : R) : R := Claim.value (least t) + (Claim.value (greatest t) - Claim.value (least t)) * u.
Definition point_at (edges : tolerances) (u : list R) : vec :=
  Vec (between (tx edges) (nth 0 u 0)) (between (ty edges) (nth 1 u 0)) (between (tz edges) (nth 2 u 0)).

(** The claim holds there, for every machine; and so for all values of the coordinates that are not paved. *)
Definition holds_at (c : claim) (edges : tolerances) (u : list R) : Prop := forall m, is_machine c m -> meets c m (point_at edges u).
Definition in_region (c : claim) (edges : tolerances) (paved : list nat) (u : list R) : Prop :=
  forall u', in_box u' -> (forall k, In k paved -> nth k u' 0 = nth k u 0) -> holds_at c edges u'.

(** The cells are the box, or its points in order, which all shares together are; all points of inner cells are in the region, and none of outer cells;
    with symmetry, the region is the same from permuted axes. *)
Record is_paving (c : claim) (edges : tolerances) (paved : list nat) (symmetric : bool) (inner outer rest : list cell) : Prop := {
  covered : forall u, in_box u -> (symmetric = true -> in_order u) -> exists k, In k (inner ++ outer ++ rest) /\ in_cell k u;
  whole : weights symmetric (inner ++ outer ++ rest) = (2 ^ share_places)%Z;
  inside : forall k u, In k inner -> in_box u -> in_cell k u -> in_region c edges paved u;
  outside : forall k u, In k outer -> in_box u -> in_cell k u -> ~ in_region c edges paved u;
  same_from : symmetric = true -> forall p u, in_box u -> holds_at c edges u -> holds_at c edges (moved p u) }.

(** ** Nodes *)

Inductive outer_by := ByOwn (number : nat) | ByGiven (f : Configuration.nfailure).
Inductive kind :=
  | Halve (k : nat)                 (* along a coordinate that is paved *)
  | InParts (k : nat)               (* along another: inner if both parts are *)
  | Inner
  | Outer (at_ : option (list Z)) (by_ : outer_by)   (* where the others are so many 2^16ths of the way *)
  | Boundary
  | Mirrored.                       (* with symmetry: without a point in order *)
(** Steps name obligations by their numbers; of none that is given the evidence is the own one. *)
Record item := Item { steps_ : list (nat * option evidence); kind_ : kind }.

(** What evidence there is, of itself, for obligations on a cell, by the values there; it may be any at all. *)
Record finder := Finder {
  evidence_for : list (option slope) -> nat -> evidence;
  failures_for : list (option slope) -> nat -> list Configuration.nfailure }.

(** ** The claim as formulas *)

Record board := Board {
  its_tape : list (op address); its_whole : rows nat; its_divided : rows nat; its_params : list fixed; its_tests : list test;
  its_failings : failings; first_bound : nat; its_requirements : list requirement;
  its_ends : list (fixed * fixed); its_paved : list nat; its_others : list nat; most_depth : N; its_symmetry : bool }.

Definition is_read (r : requirement) : bool := match r with OneToOne | Accuracy _ _ | Stiffnesses _ _ => false | _ => true end.

(** [exact]: the bits with which signs of numbers are found. *)
Definition board_of (exact bits : positive) (c : claim) (edges : tolerances) (s : Z) (ds : list Z) (paved : list nat) (depth : N) (symmetric : bool) : option board :=
  let ps := layouts s ds (legs c) in
  let fs := all_formulas s ds (legs c) 0 in
  let n := (length ps, length ps + length (require c))%nat in
  let needed := entries (whole_rows fs) ++ entries (divided_rows fs) ++ map rod fs ++ range_formulas fs s n (require c) in
  let tape := compile needed in
  let found := formulas tape in
  let at_ := place found in
  let ends_of t := match enclose_scaled bits s (least t), enclose_scaled bits s (greatest t) with Some a, Some b => Some (a, b) | _, _ => None end in
  if forallb (fun e => same (nth (at_ e) found (integer 0)) e) needed && existsb is_lower (require c) && are_buildable bits s ds (legs c) &&
    forallb is_read (require c) && is_inhabited exact c && forallb (fun k => Nat.ltb k 3) paved && (negb symmetric || is_symmetric c) then
    match all_some (map (enclose_parameter bits) (ps ++ map (bound_of s) (require c) ++ flat_map (extras s) (require c))),
      all_some (tests_of bits (0%N, []) at_ ps fs s n (require c)), all_some (map ends_of [tx edges; ty edges; tz edges]) with
    | Some params, Some tests, Some ends =>
        if forallb (fun k => match nth_error ends k with Some (a, b) => (hi a <? lo b)%Z | None => false end) paved then
          Some (Board tape (map_rows at_ (whole_rows fs)) (map_rows at_ (divided_rows fs)) params tests
            (failings_of bits at_ fs s n (require c)) (fst n) (require c) ends paved (filter (fun k => negb (existsb (Nat.eqb k) paved)) [0; 1; 2]%nat) depth symmetric)
        else None
    | _, _, _ => None
    end
  else None.

(** The values from [from]/2^places to [upto]/2^places of the way, of ends that are enclosed. *)
Definition range_of (places : N) (from upto : Z) (ends : fixed * fixed) : fixed :=
  let at_ n := add (dyadic (pieces places - n) places (fst ends)) (dyadic n places (snd ends)) in
  Fixed (lo (at_ from)) (hi (at_ upto)).
Definition most_level : N := 40.
Definition may_halve (k : nat) (c : cell) : bool := match nth_error c k with Some e => (level e <? most_level)%N | None => false end.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Variable b : board.
Variable find : finder.

Definition edge_range (e : edge) : fixed * fixed -> fixed := range_of (level e) (index e) (index e + 1).
Definition ranges (k : cell) : list fixed := map (fun p => edge_range (fst p) (snd p)) (combine k (its_ends b)).
(** The same at values of the others. *)
Definition value_places : N := 16.
Fixpoint moved_to (others : list nat) (at_ : list Z) (rs : list fixed) : option (list fixed) :=
  match others, at_ with
  | [], [] => Some rs
  | k :: others', n :: at' => match nth_error (its_ends b) k with
      | Some ends => if (0 <=? n)%Z && (n <=? pieces value_places)%Z then
          moved_to others' at' (firstn k rs ++ range_of value_places n n ends :: skipn (S k) rs) else None
      | None => None
      end
  | _, _ => None
  end.

Definition values_on (rs : list fixed) : list (option slope) := evaluate bits (its_tape b) (its_params b) rs.
Definition discharged (values : list (option slope)) (rs : list fixed) (steps : list (nat * option evidence)) (open : list bool) : option (list bool) :=
  discharge bits (its_tape b) (its_whole b) (its_divided b) [] (its_params b) (its_tests b) (fun _ => None) values rs
    (map (fun s => (fst s, match snd s with Some e => e | None => evidence_for find values (fst s) end)) steps) open.
Definition open_ones (open : list bool) : list (nat * option evidence) :=
  map (fun p => (fst p, None)) (filter snd (combine (seq 0 (length open)) open)).
Definition fails_on (values : list (option slope)) (rs : list fixed) (f : Configuration.nfailure) : bool :=
  fails_over bits (first_bound b) (its_requirements b) (its_failings b) is_positive (coords_from 0 rs) (map constant (its_params b)) values f.

(** ** The cells that are to be read, the first first, and what those that were read are *)

(** [of_part]: below a cell in parts, which counts as inner. *)
Record waiting := Waiting { its_cell : cell; its_open : list bool; its_depth : N; of_part : bool }.
Record tally := Tally { splits : Z; inners : Z; outers : Z; boundaries : Z; mirrored : Z; inner_share : Z; outer_share : Z; boundary_share : Z }.
(** What is to be added. *)
Definition one_inner (n : Z) (t : tally) : tally := Tally (splits t) (inners t + 1) (outers t) (boundaries t) (mirrored t) (inner_share t + n) (outer_share t) (boundary_share t).
Definition one_outer (n : Z) (t : tally) : tally := Tally (splits t) (inners t) (outers t + 1) (boundaries t) (mirrored t) (inner_share t) (outer_share t + n) (boundary_share t).
Definition one_boundary (n : Z) (t : tally) : tally := Tally (splits t) (inners t) (outers t) (boundaries t + 1) (mirrored t) (inner_share t) (outer_share t) (boundary_share t + n).
Definition one_split (t : tally) : tally := Tally (splits t + 1) (inners t) (outers t) (boundaries t) (mirrored t) (inner_share t) (outer_share t) (boundary_share t).
Definition one_mirrored (t : tally) : tally := Tally (splits t) (inners t) (outers t) (boundaries t) (mirrored t + 1) (inner_share t) (outer_share t) (boundary_share t).
Record state := State { to_read : list waiting; tally_ : tally }.

Definition read_node (st : state) (i : item) : option state :=
  match to_read st with
  | [] => None
  | w :: rest =>
      let c := its_cell w in
      let t := tally_ st in
      let n := weight (its_symmetry b) in
      let rs := ranges c in
      let shown (steps : list (nat * option evidence)) := match steps with [] => Some (its_open w) | _ => discharged (values_on rs) rs steps (its_open w) end in
      let below (k : nat) (deeper : N) (p : bool) (t : tally) :=
        match shown (steps_ i) with
        | Some open => if may_halve k c then
            let child upper := Waiting (half upper k c) open (its_depth w + deeper)%N p in Some (State (child 0%Z :: child 1%Z :: rest) t) else None
        | None => None
        end in
      let is_leaf := negb (of_part w) && match steps_ i with [] => true | _ => false end in
      match kind_ i with
      | Halve k => if negb (of_part w) && existsb (Nat.eqb k) (its_paved b) && (its_depth w <? most_depth b)%N then
          below k 1%N false (one_split t) else None
      | InParts k => match nth_error (its_others b) k with
          | Some k => below k 0%N true (if of_part w then t else one_inner (n c) t)
          | None => None
          end
      | Inner =>
          let values := values_on rs in
          match discharged values rs (steps_ i) (its_open w) with
          | Some open => match discharged values rs (open_ones open) open with
              | Some open => if forallb negb open then Some (State rest
                  (if of_part w then t else one_inner (n c) t)) else None
              | None => None
              end
          | None => None
          end
      | Outer at_ by_ =>
          match (match at_ with None => Some rs | Some at_ => moved_to (its_others b) at_ rs end) with
          | Some rs =>
              let values := values_on rs in
              if is_leaf && existsb (fails_on values rs) (match by_ with ByOwn o => failures_for find values o | ByGiven f => [f] end) then
                Some (State rest (one_outer (n c) t)) else None
          | None => None
          end
      | Boundary => if is_leaf then
          Some (State rest (one_boundary (n c) t)) else None
      | Mirrored => if is_leaf && its_symmetry b && is_mirrored c then Some (State rest (one_mirrored t)) else None
      end
  end.

Definition start_paving : state := State [Waiting (repeat (Edge 0 0) 3) (all_open (its_tests b)) 0 false] (Tally 0 0 0 0 0 0 0 0).
End Precision.

(** ** Cells *)

Lemma pieces_pos : forall n, 0 < IZR (pieces n).
Proof. exact two_power. Qed.
Lemma pieces_succ : forall n, pieces (N.succ n) = (2 * pieces n)%Z.
Proof. intro n. unfold pieces. rewrite N2Z.inj_succ, Z.pow_succ_r by apply N2Z.is_nonneg. reflexivity. Qed.

Lemma on_halved : forall e u, on_edge e u -> on_edge (halved 0 e) u \/ on_edge (halved 1 e) u.
Proof.
  intros [i l] u [h1 h2]. unfold on_edge, halved in *. cbn [index level] in *. rewrite pieces_succ.
  rewrite ?plus_IZR, ?mult_IZR in *. destruct (Rle_lt_dec (u * IZR (pieces l) * 2) (2 * IZR i + 1)); [left | right]; lra.
Qed.
Lemma halved_on : forall upper e u, (upper = 0 \/ upper = 1)%Z -> on_edge (halved upper e) u -> on_edge e u.
Proof.
  intros upper [i l] u d [h1 h2]. unfold on_edge, halved in *. cbn [index level] in *. rewrite pieces_succ in *.
  rewrite ?plus_IZR, ?mult_IZR in *. destruct d as [-> | ->]; lra.
Qed.
Lemma in_half : forall k c u, in_cell c u -> in_cell (half 0 k c) u \/ in_cell (half 1 k c) u.
Proof.
  intros k c u h. revert k. induction h as [| e t c u he h IH]; intros [| k]; cbn; try (left; constructor; fail).
  - destruct (on_halved e t he); [left | right]; constructor; assumption.
  - destruct (IH k); [left | right]; constructor; assumption.
Qed.
Lemma half_in : forall upper k c u, (upper = 0 \/ upper = 1)%Z -> in_cell (half upper k c) u -> in_cell c u.
Proof.
  intros upper k c u d. revert k u. induction c as [| e c IH]; intros [| k] u h; cbn in h; try exact h; inversion h as [| ? t ? u' h1 h2]; subst; constructor.
  - exact (halved_on _ _ _ d h1).
  - exact h2.
  - exact h1.
  - exact (IH k _ h2).
Qed.
Lemma half_length : forall upper k c, length (half upper k c) = length c.
Proof. intros upper k c. revert k. induction c as [| e c IH]; intros [| k]; cbn; [reflexivity .. |]. f_equal. apply IH. Qed.
(** Of a cell that is mirrored, no point is in order. *)
Lemma after_sound : forall e f x y, is_after e f = true -> on_edge e x -> on_edge f y -> y <= x.
Proof.
  intros e f x y h [h1 _] [_ h2]. apply Z.leb_le, IZR_le in h. rewrite !mult_IZR in h. pose proof (pieces_pos (level e)) as p. pose proof (pieces_pos (level f)) as q.
  apply Rmult_le_reg_r with (IZR (pieces (level e)) * IZR (pieces (level f))); [apply Rmult_lt_0_compat; assumption |].
  assert (y * IZR (pieces (level f)) * IZR (pieces (level e)) <= IZR (index f + 1) * IZR (pieces (level e))) by (apply Rmult_le_compat_r; lra).
  assert (IZR (index e) * IZR (pieces (level f)) <= x * IZR (pieces (level e)) * IZR (pieces (level f))) by (apply Rmult_le_compat_r; lra). lra.
Qed.
Lemma mirrored_sound : forall k u, is_mirrored k = true -> in_cell k u -> ~ in_order u.
Proof.
  intros k u m h [o1 o2]. destruct k as [| e0 [| e1 [| e2 [|]]]]; try discriminate.
  inversion h as [| ? u0 ? ? a0 h0]; subst. inversion h0 as [| ? u1 ? ? a1 h1]; subst. inversion h1 as [| ? u2 ? ? a2 h2]; subst. cbn [nth] in *.
  cbn [is_mirrored] in m. apply orb_true_iff in m as [m | m]; [apply orb_true_iff in m as [m | m] |].
  - pose proof (after_sound _ _ _ _ m a0 a1). lra.
  - pose proof (after_sound _ _ _ _ m a1 a2). lra.
  - pose proof (after_sound _ _ _ _ m a0 a2). lra.
Qed.

Section Ranges.
Variable bits : positive.
(** [range_of] holds them: they are between those of both ends. *)
Lemma range_of_sound : forall places from upto ends x y u, contains bits (fst ends) x -> contains bits (snd ends) y -> x <= y ->
  IZR from <= u * IZR (pieces places) <= IZR upto -> contains bits (range_of places from upto ends) (x + (y - x) * u).
Proof.
  intros places from upto [a b] x y u ha hb le [h1 h2]. cbn [fst snd] in *. pose proof (pieces_pos places) as p.
  assert (At : forall n, contains bits (add (dyadic (pieces places - n) places a) (dyadic n places b)) (x + (y - x) * (IZR n / IZR (pieces places)))).
  { intro n. replace (x + (y - x) * (IZR n / IZR (pieces places))) with (IZR (pieces places - n) / IZR (pieces places) * x + IZR n / IZR (pieces places) * y)
      by (rewrite minus_IZR; field; lra).
    apply add_sound; apply dyadic_sound; assumption. }
  pose proof (unit_R_pos bits) as up. destruct (At from) as [l _]. destruct (At upto) as [_ r]. unfold range_of. cbn [fst snd].
  assert (F : IZR from / IZR (pieces places) <= u) by (apply Rmult_le_reg_r with (IZR (pieces places)); [exact p |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
  assert (G : u <= IZR upto / IZR (pieces places)) by (apply Rmult_le_reg_r with (IZR (pieces places)); [exact p |]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
  split; cbn [lo hi].
  - eapply Rle_trans; [exact l |]. apply Rmult_le_compat_r; [lra |]. apply Rplus_le_compat_l, Rmult_le_compat_l; lra.
  - eapply Rle_trans; [| exact r]. apply Rmult_le_compat_r; [lra |]. apply Rplus_le_compat_l, Rmult_le_compat_l; lra.
Qed.
End Ranges.

(** ** Soundness *)

Section Sound.
Variables (exact bits : positive) (c : claim) (edges : tolerances) (s : Z) (ds : list Z) (paved : list nat) (depth : N) (symmetric : bool) (b : board) (find : finder).
Hypothesis box_is : workspace c = Box edges.
Hypothesis made : board_of exact bits c edges s ds paved depth symmetric = Some b.
Let ps := layouts s ds (legs c).
Let fs := all_formulas s ds (legs c) 0.
Let n := (length ps, length ps + length (require c))%nat.
Local Notation at_ := (place (formulas (its_tape b))).
Local Notation x_at u := (coordinates (vscale (/ two_to s) (point_at edges u))).

Record is_board : Prop := {
  found : forall e, In e (entries (whole_rows fs) ++ entries (divided_rows fs) ++ map rod fs ++ range_formulas fs s n (require c)) ->
    formula_at (its_tape b) (at_ e) = e;
  has_lower : existsb is_lower (require c) = true;
  buildable : are_buildable bits s ds (legs c) = true;
  are_read : forallb is_read (require c) = true;
  is_about_something : is_inhabited exact c = true;
  are_places : forall k, In k paved -> (k < 3)%nat;
  params_are : all_some (map (enclose_parameter bits) (ps ++ map (bound_of s) (require c) ++ flat_map (extras s) (require c))) = Some (its_params b);
  tests_are : all_some (tests_of bits (0%N, []) at_ ps fs s n (require c)) = Some (its_tests b);
  ends_are : Forall2 (fun t p => enclose_scaled bits s (least t) = Some (fst p) /\ enclose_scaled bits s (greatest t) = Some (snd p)) [tx edges; ty edges; tz edges] (its_ends b);
  whole_is : its_whole b = map_rows at_ (whole_rows fs);
  divided_is : its_divided b = map_rows at_ (divided_rows fs);
  failings_are : its_failings b = failings_of bits at_ fs s n (require c);
  first_is : first_bound b = fst n;
  requirements_are : its_requirements b = require c;
  paved_is : its_paved b = paved;
  symmetry_is : its_symmetry b = symmetric;
  is_same_from : symmetric = true -> is_symmetric c = true;
  others_are : forall k, In k (its_others b) -> ~ In k paved }.

Lemma board_is : is_board.
Proof.
  unfold board_of in made. cbv zeta in made. fold ps fs n in made.
  destruct (forallb _ (entries (whole_rows fs) ++ _) && _ && _ && _ && _ && _ && _) eqn:g; [| discriminate].
  repeat apply andb_true_iff in g as [g ?]. destruct (all_some (map (enclose_parameter bits) _)) as [params |] eqn:ep; [| discriminate].
  destruct (all_some (tests_of _ _ _ _ _ _ _ _)) as [tests |] eqn:et; [| discriminate]. destruct (all_some (map _ [tx edges; ty edges; tz edges])) as [ends |] eqn:ee; [| discriminate].
  destruct (forallb _ paved) eqn:w in made; [| discriminate]. injection made as eb. constructor; rewrite <- ?eb; cbn [its_tape its_whole its_divided its_params its_tests its_failings first_bound its_requirements its_ends its_paved its_others its_symmetry]; try assumption; try reflexivity.
  - rewrite forallb_forall in g. intros e i. apply Formula.same_sound, g, i.
  - intros k i. apply Nat.ltb_lt. revert k i. apply forallb_forall. assumption.
  - revert ee. apply all_some_related. intros t [p q] e. destruct (enclose_scaled bits s (least t)), (enclose_scaled bits s (greatest t)); try discriminate.
    injection e as <- <-. split; reflexivity.
  - intros ->. assumption.
  - intros k i h. apply filter_In with (f := fun k => negb (existsb (Nat.eqb k) paved)) (l := [0; 1; 2]%nat) in i as [_ i]. apply negb_true_iff in i.
    assert (existsb (Nat.eqb k) paved = true) by (apply existsb_exists; exists k; split; [exact h | apply Nat.eqb_refl]). congruence.
Qed.

Lemma edges_in_order : Forall (fun t => Claim.value (least t) <= Claim.value (greatest t)) [tx edges; ty edges; tz edges].
Proof.
  destruct board_is as [_ _ _ _ i _ _ _ _ _ _ _ _ _ _ _]. unfold is_inhabited, admits in i. rewrite box_is in i. apply andb_true_iff in i as [_ i].
  cbn [is_in some_point] in i. unfold Witness.parts, Witness.part, leasts in i. cbn [nx ny nz] in i. repeat (apply andb_true_iff in i as [i ?]). repeat (match goal with h : _ && _ = true |- _ => apply andb_true_iff in h as [? h] end).
  repeat (apply Forall_cons; [eapply Compare.below_sound; eassumption |]). apply Forall_nil.
Qed.

Lemma x_at_list : forall u, in_box u -> x_at u = map (fun p => between (fst p) (snd p) / two_to s) (combine [tx edges; ty edges; tz edges] u).
Proof.
  intros u [l _]. destruct u as [| x [| y [| z [|]]]]; try discriminate. unfold coordinates, vscale, point_at. cbn [vx vy vz nth combine map fst snd].
  unfold Rdiv. rewrite !(Rmult_comm (/ two_to s)). reflexivity.
Qed.

Lemma coordinate_holds : forall t p places from upto y, enclose_scaled bits s (least t) = Some (fst p) /\ enclose_scaled bits s (greatest t) = Some (snd p) ->
  Claim.value (least t) <= Claim.value (greatest t) -> IZR from <= y * IZR (pieces places) <= IZR upto ->
  contains bits (range_of places from upto p) (between t y / two_to s).
Proof.
  intros t p places from upto y [h1 h2] o h. unfold between. pose proof (two_to_pos s) as p0.
  replace ((Claim.value (least t) + (Claim.value (greatest t) - Claim.value (least t)) * y) / two_to s)
    with (Claim.value (least t) / two_to s + (Claim.value (greatest t) / two_to s - Claim.value (least t) / two_to s) * y) by (field; lra).
  apply range_of_sound; [apply enclose_scaled_sound, h1 | apply enclose_scaled_sound, h2 | | exact h].
  apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat, p0 | exact o].
Qed.

Lemma ranges_hold : forall k u, in_box u -> in_cell k u -> Forall2 (contains bits) (ranges b k) (x_at u).
Proof.
  intros k u hu h. rewrite (x_at_list u hu). destruct hu as [l _]. destruct board_is as [_ _ _ _ _ _ _ _ ends _ _ _ _ _ _ _]. pose proof edges_in_order as o.
  unfold ranges. clear l. revert k u h o. induction ends as [| t p ts es h ends IH]; intros k u h' o; [destruct k; constructor |].
  destruct h' as [| e y k u h1 h']; [constructor |]. cbn [combine map fst snd]. inversion o as [| ? ? o1 o2]; subst. constructor.
  - apply coordinate_holds; assumption.
  - exact (IH k u h' o2).
Qed.

Lemma moved_hold : forall others at_ rs rs' u, moved_to b others at_ rs = Some rs' -> (forall k, In k others -> ~ In k paved) -> in_box u -> Forall2 (contains bits) rs (x_at u) ->
  exists u', in_box u' /\ (forall k, In k paved -> nth k u' 0 = nth k u 0) /\ Forall2 (contains bits) rs' (x_at u').
Proof.
  destruct board_is as [_ _ _ _ _ _ _ _ ends _ _ _ _ _ _ _]. pose proof edges_in_order as o.
  destruct (its_ends b) as [| e0 [| e1 [| e2 [|]]]] eqn:E0; try (exfalso; apply related_length in ends; discriminate).
  inversion ends as [| ? ? ? ? a0 ends1]; subst. inversion ends1 as [| ? ? ? ? a1 ends2]; subst. inversion ends2 as [| ? ? ? ? a2 _]; subst.
  inversion o as [| ? ? o0 oo]; subst. inversion oo as [| ? ? o1 oo']; subst. inversion oo' as [| ? ? o2 _]; subst.
  induction others as [| k others IH]; intros [| z at_] rs rs' u h no hu hr; cbn [moved_to] in h; try discriminate.
  - injection h as <-. exists u. split; [exact hu |]. split; [reflexivity | exact hr].
  - rewrite E0 in h. destruct (nth_error _ k) as [e |] eqn:ne; [| discriminate]. destruct ((0 <=? z)%Z && (z <=? pieces value_places)%Z) eqn:nn; [| discriminate].
    apply andb_true_iff in nn as [n0 n1]. apply Z.leb_le, IZR_le in n0. apply Z.leb_le, IZR_le in n1. pose proof (pieces_pos value_places) as p.
    set (y := IZR z / IZR (pieces value_places)). assert (hy : 0 <= y <= 1).
    { unfold y. split; apply Rmult_le_reg_r with (IZR (pieces value_places)); try exact p; unfold Rdiv; rewrite ?Rmult_assoc, ?Rinv_l by lra; lra. }
    assert (ey : IZR z <= y * IZR (pieces value_places) <= IZR z) by (unfold y, Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra).
    destruct hu as [l hu]. destruct u as [| u0 [| u1 [| u2 [|]]]]; try discriminate. inversion hu as [| ? ? b0 hu1]; subst. inversion hu1 as [| ? ? b1 hu2]; subst. inversion hu2 as [| ? ? b2 _]; subst.
    assert (G : forall u', in_box u' -> (forall j, j <> k -> nth j u' 0 = nth j [u0; u1; u2] 0) ->
      Forall2 (contains bits) (firstn k rs ++ range_of value_places z z e :: skipn (S k) rs) (x_at u') ->
      exists u', in_box u' /\ (forall k, In k paved -> nth k u' 0 = nth k [u0; u1; u2] 0) /\ Forall2 (contains bits) rs' (x_at u')).
    { intros u' hu' same hr'. destruct (IH at_ _ rs' u' h (fun j ij => no j (or_intror ij)) hu' hr') as [v [v1 [v2 v3]]]. exists v. split; [exact v1 |]. split; [| exact v3].
      intros j ij. rewrite (v2 j ij). apply same. intros ->. exact (no k (or_introl eq_refl) ij). }
    rewrite x_at_list in hr by (split; [reflexivity | exact hu]). cbn [combine map fst snd] in hr.
    inversion hr as [| r0 ? ? ? q0 hr1]; subst. inversion hr1 as [| r1 ? ? ? q1 hr2]; subst. inversion hr2 as [| r2 ? ? ? q2 hr3]; subst. inversion hr3; subst.
    destruct k as [| [| [| k]]]; cbn [nth_error firstn skipn app] in *; [injection ne as -> .. | destruct k; discriminate].
    + apply (G [y; u1; u2]); [split; [reflexivity | repeat (apply Forall_cons; [assumption |]); apply Forall_nil] | intros [| [| [| j]]] d; try reflexivity; congruence |].
      rewrite x_at_list by (split; [reflexivity | repeat (apply Forall_cons; [assumption |]); apply Forall_nil]). cbn [combine map fst snd]. repeat (apply Forall2_cons; [try assumption; apply coordinate_holds; assumption |]); apply Forall2_nil.
    + apply (G [u0; y; u2]); [split; [reflexivity | repeat (apply Forall_cons; [assumption |]); apply Forall_nil] | intros [| [| [| j]]] d; try reflexivity; congruence |].
      rewrite x_at_list by (split; [reflexivity | repeat (apply Forall_cons; [assumption |]); apply Forall_nil]). cbn [combine map fst snd]. repeat (apply Forall2_cons; [try assumption; apply coordinate_holds; assumption |]); apply Forall2_nil.
    + apply (G [u0; u1; y]); [split; [reflexivity | repeat (apply Forall_cons; [assumption |]); apply Forall_nil] | intros [| [| [| j]]] d; try reflexivity; congruence |].
      rewrite x_at_list by (split; [reflexivity | repeat (apply Forall_cons; [assumption |]); apply Forall_nil]). cbn [combine map fst snd]. repeat (apply Forall2_cons; [try assumption; apply coordinate_holds; assumption |]); apply Forall2_nil.
Qed.

(** *** What tests show *)

Local Notation params := (its_params b).
Local Notation test_holds theta u t := (Check.holds bits (its_tape b) (its_whole b) (its_divided b) [] params theta 3 (x_at u) t).

Lemma machine_at : forall m u, is_machine c m -> exists theta, Forall2 (contains bits) params theta /\
  Forall2 (represents (vscale (/ two_to s) (point_at edges u)) theta) fs (map (resized (/ two_to s)) m) /\ Forall well_formed_leg m /\
  (forall k r, nth_error (require c) k = Some r -> nth (fst n + k) theta 0 = bound_value s r) /\
  forall r, In r (require c) -> exists j t, nth (fst j) theta 0 = bound_value s r /\
    map (value (x_at u) theta) (numbered (snd j) (extras s r)) = map exact_value (extras s r) /\
    (forall f, In f (range_formula fs s j r) -> formula_at (its_tape b) (at_ f) = f) /\
    test_of bits (0%N, []) at_ ps fs s j r = Some t /\ In t (its_tests b).
Proof.
  intros m u hm. destruct board_is as [Found _ able _ _ _ ep et _ _ _ _ _ _ _ _].
  destruct (all_represent s (legs c) m hm ds) as [th [L R]].
  set (tb := map (bound_value s) (require c) ++ map exact_value (flat_map (extras s) (require c))). exists (th ++ tb).
  pose proof (Forall2_app (bounds_within s (require c)) (all_extras_within s (require c))) as B. fold tb in B.
  assert (ln : length ps = length th) by apply (related_length _ _ _ _ _ L).
  split; [exact (enclosed_all _ _ _ _ ep (Forall2_app L B)) |]. split; [exact (R _ [] tb) |]. split; [exact (are_buildable_sound bits (0%N, []) s _ _ hm ds able) |]. split.
  - intros k r e. unfold n. cbn [fst]. rewrite ln, app_nth2_plus. unfold tb. rewrite app_nth1 by (rewrite map_length; apply nth_error_Some; congruence).
    apply nth_error_nth. rewrite nth_error_map, e. reflexivity.
  - intros r i. destruct (In_nth_error _ _ i) as [k e].
    destruct (requirement_at bits (0%N, []) at_ ps fs s (require c) n k r e) as [j [front [back [-> [h1 [h2 h3]]]]]].
    destruct (all_some_in _ _ _ _ et h2) as [t [e2 it]]. exists (fst n + k, snd n + length front)%nat, t.
    destruct (numbers_at (x_at u) s (require c) th k r front back e h1) as [b1 b2]. rewrite <- ln in b1, b2.
    split; [exact b1 |]. split; [exact b2 |]. split; [| split; [exact e2 | exact it]].
    intros f g. apply Found, in_or_app. right. apply in_or_app. right. apply in_or_app. right. exact (h3 f g).
Qed.

Lemma tests_meet : forall u, (forall theta, Forall2 (contains bits) params theta -> forall t, In t (its_tests b) -> test_holds theta u t) -> holds_at c edges u.
Proof.
  intros u H m hm. destruct (machine_at m u hm) as [theta [T [R [built [_ Each]]]]]. specialize (H theta T).
  destruct board_is as [Found low _ read _ _ _ _ _ ew ed _ _ _ _ _]. rewrite ew, ed in H.
  assert (W : forall e, In e (entries (whole_rows fs)) -> formula_at (its_tape b) (at_ e) = e)
    by (intros e i; apply Found, in_or_app; left; exact i).
  assert (V : forall e, In e (entries (divided_rows fs)) -> formula_at (its_tape b) (at_ e) = e)
    by (intros e i; apply Found, in_or_app; right; apply in_or_app; left; exact i).
  apply existsb_exists in low as [r0 [i0 l0]]. destruct (Each r0 i0) as [j0 [t0 [E1 [E0 [E2 [E3 E4]]]]]].
  destruct (lower_fulfilled bits (0%N, []) c s ds m (point_at edges u) theta params (its_tape b) R W V j0 r0 E1 E0 E2 t0 E3 (H t0 E4) l0) as [h1 [h2 _]].
  split; [exact h1 |]. split; [exact h2 |]. apply Forall_forall. intros r i. destruct (Each r i) as [j [t [F1 [F0 [F2 [F3 F4]]]]]].
  apply (fulfilled bits (0%N, []) c s ds m (point_at edges u) theta params (its_tape b) R W V j r F1 F0 F2 t F3 (H t F4) h1 hm built).
  rewrite forallb_forall in read. specialize (read r i). destruct r; try exact I; discriminate.
Qed.

Lemma fails_sound : forall rs u f, Forall2 (contains bits) rs (x_at u) -> fails_on bits b (values_on bits b rs) rs f = true -> ~ holds_at c edges u.
Proof.
  intros rs u f hr hf hold. destruct board_is as [Found _ _ _ about _ _ _ _ _ _ efail efirst ereq _ _].
  destruct (inhabited exact c about) as [m [P [hm _]]]. destruct (machine_at m u hm) as [theta [T [R [built [bounds _]]]]].
  destruct (hold m hm) as [reached [_ met]]. destruct (coords_from_hold bits rs (x_at u) hr) as [lambda [_ [hl [_ C]]]]. specialize (C []). cbn [app length] in C.
  pose proof (params_hold bits lambda params theta T) as ph.
  unfold fails_on in hf. rewrite efail, efirst, ereq in hf.
  refine (fails_over_sound bits c s ds m (point_at edges u) theta (its_tape b) R built hm n bounds _ reached lambda (map (centre_of bits) rs) _ _ _ is_positive f
    (eval_sound bits lambda hl _ _ theta (coords_from 0 rs) (map constant params) C ph (its_tape b))
    (is_positive_sound bits lambda hl _ _ theta (coords_from 0 rs) (map constant params) C ph (its_tape b)) hf met).
  intros e i. apply Found. apply in_app_or in i as [i | i]; [apply in_or_app; left; exact i | apply in_or_app; right; apply in_or_app; right; exact i].
Qed.

Definition done_at (open : list bool) (u : list R) : Prop := forall theta, Forall2 (contains bits) params theta ->
  done bits (its_tape b) (its_whole b) (its_divided b) [] params (its_tests b) theta 3 (x_at u) open.

Lemma discharged_sound : forall rs steps open open' u, Forall2 (contains bits) rs (x_at u) ->
  discharged bits b find (values_on bits b rs) rs steps open = Some open' -> done_at open u -> done_at open' u.
Proof.
  intros rs steps open open' u hr h D theta T. unfold discharged in h.
  assert (l : length rs = 3%nat) by (rewrite (related_length _ _ _ _ _ hr); reflexivity). rewrite <- l.
  set (steps' := map _ steps) in h. apply (discharge_sound bits _ _ _ [] params (its_tests b) (fun _ => None) theta T (fun _ => True)) with (keep := []) (steps := steps') (open := open).
  - discriminate.
  - exact hr.
  - exact I.
  - rewrite evaluate_all. exact h.
  - rewrite l. exact (D theta T).
Qed.

Lemma all_done : forall open u, forallb negb open = true -> done_at open u -> holds_at c edges u.
Proof.
  intros open u h D. apply tests_meet. intros theta T t i. destruct (In_nth_error _ _ i) as [k e]. apply (D theta T k t e).
  rewrite forallb_forall in h. destruct (nth_in_or_default k open false) as [j | ->]; [| reflexivity]. apply h in j. destruct (nth k open false); [discriminate | reflexivity].
Qed.

(** Its cell is all of the box in the coordinates that are not paved. *)
Definition is_whole (k : cell) : Prop := length k = 3%nat /\ forall j e, nth_error k j = Some e -> ~ In j paved -> e = Edge 0 0.

Lemma whole_agree : forall k u u', is_whole k -> in_box u' -> (forall j, In j paved -> nth j u' 0 = nth j u 0) -> in_cell k u -> in_cell k u'.
Proof.
  intros k u u' [l w] [l' h'] same h.
  assert (One : forall j e, nth_error k j = Some e -> on_edge e (nth j u 0) -> 0 <= nth j u' 0 <= 1 -> on_edge e (nth j u' 0)).
  { intros j e n1 h1 h2. destruct (in_dec Nat.eq_dec j paved) as [i | i]; [rewrite (same j i); exact h1 |].
    rewrite (w j e n1 i). unfold on_edge, pieces. cbn. lra. }
  destruct k as [| e0 [| e1 [| e2 [|]]]]; try discriminate. destruct u' as [| x [| y [| z [|]]]]; try discriminate.
  inversion h as [| ? u0 ? ? a0 h0]; subst. inversion h0 as [| ? u1 ? ? a1 h1]; subst. inversion h1 as [| ? u2 ? ? a2 h2]; subst.
  inversion h' as [| ? ? b0 h3]; subst. inversion h3 as [| ? ? b1 h4]; subst. inversion h4 as [| ? ? b2 _]; subst.
  apply Forall2_cons; [exact (One 0%nat e0 eq_refl a0 b0) |]. apply Forall2_cons; [exact (One 1%nat e1 eq_refl a1 b1) |].
  apply Forall2_cons; [exact (One 2%nat e2 eq_refl a2 b2) | apply Forall2_nil].
Qed.

(** What is to be covered. *)
Definition is_due (u : list R) : Prop := symmetric = true -> in_order u.
Definition whole_cells (l : list waiting) : list cell := map its_cell (filter (fun w => negb (of_part w)) l).
Record stands (st : state) (inner outer rest : list cell) : Prop := {
  covers : forall u, in_box u -> is_due u -> exists k, In k (inner ++ outer ++ rest ++ whole_cells (to_read st)) /\ in_cell k u;
  holds_in : forall k u, In k inner -> in_box u -> in_cell k u -> holds_at c edges u \/ exists w, In w (to_read st) /\ of_part w = true /\ in_cell (its_cell w) u;
  fails_in : forall k u, In k outer -> in_box u -> in_cell k u -> ~ in_region c edges paved u;
  are_whole : forall k, In k (inner ++ whole_cells (to_read st)) -> is_whole k;
  are_done : forall w u, In w (to_read st) -> in_box u -> in_cell (its_cell w) u -> done_at (its_open w) u;
  inner_is : inner_share (tally_ st) = weights symmetric inner;
  outer_is : outer_share (tally_ st) = weights symmetric outer;
  boundary_is : boundary_share (tally_ st) = weights symmetric rest }.

Lemma starts : stands (start_paving b) [] [] [].
Proof.
  constructor; cbn [start_paving to_read tally_ whole_cells filter map app its_cell of_part negb repeat].
  - intros u [l h] _. eexists. split; [left; reflexivity |]. destruct u as [| x [| y [| z [|]]]]; try discriminate.
    inversion h as [| ? ? h0 h']; subst. inversion h' as [| ? ? h1 h'']; subst. inversion h'' as [| ? ? h2 _]; subst.
    repeat (apply Forall2_cons; [unfold on_edge, pieces; cbn; lra |]). apply Forall2_nil.
  - intros k u [].
  - intros k u [].
  - intros k [<- | []]. split; [reflexivity |]. intros [| [| [| j]]] e h _; cbn in h; try (injection h as <-; reflexivity). destruct j; discriminate.
  - intros w u [<- | []] _ _ theta T i t e o. exfalso. cbn [its_open] in o. unfold all_open in o. rewrite (nth_indep _ false true) in o.
    + rewrite (map_nth (fun _ => true) (its_tests b) (SigmaMin zero) i) in o. discriminate.
    + rewrite map_length. apply nth_error_Some. congruence.
  - reflexivity.
  - reflexivity.
  - reflexivity.
Qed.

Lemma half_whole : forall upper k e, In k paved -> is_whole e -> is_whole (half upper k e).
Proof.
  intros upper k e i [l w]. split; [rewrite half_length; exact l |]. intros j f h nj. apply (w j f); [| exact nj].
  assert (j <> k) by (intros ->; exact (nj i)). clear - h H. revert k j h H. induction e as [| g e IH]; intros [| k] [| j] h d; cbn in *; try exact h; try congruence; try lia.
  apply (IH k j h). congruence.
Qed.

(** A cell that is read. *)
Lemma leaf_stands : forall w rest t t' inner outer und inner' outer' und', of_part w = false -> stands (State (w :: rest) t) inner outer und ->
  (forall k, In k (inner ++ outer ++ und) -> In k (inner' ++ outer' ++ und')) ->
  (forall u, in_box u -> is_due u -> in_cell (its_cell w) u -> In (its_cell w) (inner' ++ outer' ++ und')) ->
  (forall k, In k inner' -> In k inner \/ k = its_cell w /\ forall u, in_box u -> in_cell k u -> holds_at c edges u) ->
  (forall k, In k outer' -> In k outer \/ k = its_cell w /\ forall u, in_box u -> in_cell k u -> ~ in_region c edges paved u) ->
  (inner_share t = weights symmetric inner -> inner_share t' = weights symmetric inner') ->
  (outer_share t = weights symmetric outer -> outer_share t' = weights symmetric outer') ->
  (boundary_share t = weights symmetric und -> boundary_share t' = weights symmetric und') ->
  stands (State rest t') inner' outer' und'.
Proof.
  intros w rest t t' inner outer und inner' outer' und' np S Cov Own Hin Hout Ei Eo Eb. destruct S as [C HI FI W D Si So Sb]. cbn [to_read tally_] in *.
  unfold whole_cells in *. cbn [filter] in *. rewrite np in *. cbn [negb map] in *. constructor; unfold whole_cells; cbn [to_read tally_].
  - intros u hu due. destruct (C u hu due) as [k [ik hk]]. exists k. split; [| exact hk]. specialize (Cov k). specialize (Own u hu due). rewrite !in_app_iff in *. cbn [In] in ik.
    destruct ik as [i | [i | [i | [<- | i]]]]; [tauto | tauto | tauto | specialize (Own hk); rewrite ?in_app_iff in Own; tauto | tauto].
  - intros k u ik hu hk. destruct (Hin k ik) as [i | [-> h]]; [| left; exact (h u hu hk)].
    destruct (HI k u i hu hk) as [h | [v [[<- | iv] [pv hv]]]]; [left; exact h | congruence | right; exists v; split; [exact iv | split; assumption]].
  - intros k u ik hu hk. destruct (Hout k ik) as [i | [-> h]]; [exact (FI k u i hu hk) | exact (h u hu hk)].
  - intros k ik. apply W. rewrite in_app_iff in *. cbn [In]. destruct ik as [ik | ik]; [destruct (Hin k ik) as [i | [-> _]]; tauto | tauto].
  - intros v u iv. apply D. right. exact iv.
  - exact (Ei Si).
  - exact (Eo So).
  - exact (Eb Sb).
Qed.

Lemma part_stands : forall w rest t inner outer und, of_part w = true -> stands (State (w :: rest) t) inner outer und ->
  (forall u, in_box u -> in_cell (its_cell w) u -> holds_at c edges u) -> stands (State rest t) inner outer und.
Proof.
  intros w rest t inner outer und p S H. destruct S as [C HI FI W D Si So Sb]. cbn [to_read tally_] in *.
  unfold whole_cells in *. cbn [filter] in *. rewrite p in *. cbn [negb] in *. constructor; unfold whole_cells; cbn [to_read tally_]; try assumption.
  - intros k u ik hu hk. destruct (HI k u ik hu hk) as [h | [v [[<- | iv] [pv hv]]]]; [left; exact h | left; exact (H u hu hv) | right; exists v; split; [exact iv | split; assumption]].
  - intros v u iv. apply D. right. exact iv.
Qed.

(** A cell, or part of one, that is halved. *)
Lemma halves_stand : forall w rest t t' inner outer und k open d, stands (State (w :: rest) t) inner outer und -> may_halve k (its_cell w) = true ->
  (forall u, in_box u -> in_cell (its_cell w) u -> done_at open u) ->
  inner_share t' = inner_share t -> outer_share t' = outer_share t -> boundary_share t' = boundary_share t -> (of_part w = false -> In k paved) ->
  let child upper := Waiting (half upper k (its_cell w)) open d (of_part w) in
  stands (State (child 0%Z :: child 1%Z :: rest) t') inner outer und.
Proof.
  intros w rest t t' inner outer und k open d S may D' Ei Eo Eb ik child. destruct S as [C HI FI W D Si So Sb]. cbn [to_read tally_] in *.
  unfold whole_cells in *. cbn [filter] in *. unfold child in *. cbn [of_part].
  assert (Children : forall v u, In v [child 0%Z; child 1%Z] -> in_box u -> in_cell (its_cell v) u -> done_at (its_open v) u).
  { intros v u [<- | [<- | []]] hu hv; cbn [its_open its_cell child] in *; apply (D' u hu); eapply half_in; try exact hv; auto. }
  constructor; unfold whole_cells; cbn [to_read tally_ its_cell].
  - intros u hu due. destruct (C u hu due) as [e [ie he]]. destruct (of_part w) eqn:p; cbn [filter negb of_part map its_cell In] in *; [exists e; split; assumption |].
    rewrite !in_app_iff in ie. cbn [In] in ie.
    assert (X : e = its_cell w \/ e <> its_cell w -> exists k', In k' (inner ++ outer ++ und ++ half 0 k (its_cell w) :: half 1 k (its_cell w) :: map its_cell (filter (fun w => negb (of_part w)) rest)) /\ in_cell k' u).
    { intros _. destruct ie as [i | [i | [i | [<- | i]]]].
      - exists e. split; [| exact he]. rewrite !in_app_iff. tauto.
      - exists e. split; [| exact he]. rewrite !in_app_iff. tauto.
      - exists e. split; [| exact he]. rewrite !in_app_iff. tauto.
      - destruct (in_half k (its_cell w) u he) as [h | h]; eexists; (split; [| exact h]); rewrite !in_app_iff; cbn [In]; tauto.
      - exists e. split; [| exact he]. rewrite !in_app_iff. cbn [In]. tauto. }
    apply X. assert (dec : forall x y : edge, {x = y} + {x <> y}) by (intros; repeat decide equality).
    destruct (list_eq_dec dec e (its_cell w)); auto.
  - intros e u ie hu he. destruct (HI e u ie hu he) as [h | [v [[<- | iv] [pv hv]]]]; [left; exact h | right | right; exists v; split; [right; right; exact iv | split; assumption]].
    destruct (in_half k (its_cell w) u hv) as [h | h]; [exists (child 0%Z) | exists (child 1%Z)]; (split; [| split; [exact pv | exact h]]).
    + left. unfold child. rewrite pv. reflexivity.
    + right. left. unfold child. rewrite pv. reflexivity.
  - exact FI.
  - intros e ie. destruct (of_part w) eqn:p; cbn [filter negb of_part map its_cell] in *; [apply W, ie |].
    rewrite in_app_iff in ie. cbn [In] in ie. assert (Ww : is_whole (its_cell w)) by (apply W; rewrite in_app_iff; cbn [In]; tauto).
    destruct ie as [i | [<- | [<- | i]]]; [apply W; rewrite in_app_iff; tauto | apply half_whole; auto | apply half_whole; auto | apply W; rewrite in_app_iff; cbn [In]; tauto].
  - intros v u [<- | [<- | iv]] hu hv; [apply (Children _ u (or_introl eq_refl) hu hv) | apply (Children _ u (or_intror (or_introl eq_refl)) hu hv) | exact (D v u (or_intror iv) hu hv)].
  - rewrite Ei. exact Si.
  - rewrite Eo. exact So.
  - rewrite Eb. exact Sb.
Qed.

(** A cell in parts counts as inner. *)
Lemma into_parts : forall w rest t t' inner outer und, of_part w = false -> stands (State (w :: rest) t) inner outer und ->
  inner_share t' = (inner_share t + weight symmetric (its_cell w))%Z -> outer_share t' = outer_share t -> boundary_share t' = boundary_share t ->
  stands (State (Waiting (its_cell w) (its_open w) (its_depth w) true :: rest) t') (its_cell w :: inner) outer und.
Proof.
  intros w rest t t' inner outer und p S Ei Eo Eb. destruct S as [C HI FI W D Si So Sb]. cbn [to_read tally_] in *.
  unfold whole_cells in *. cbn [filter of_part negb] in *. rewrite p in *. cbn [negb map] in *. constructor; unfold whole_cells; cbn [to_read tally_].
  - intros u hu due. destruct (C u hu due) as [e [ie he]]. exists e. split; [| exact he]. rewrite !in_app_iff in *. cbn [In app filter of_part negb map its_cell] in *. rewrite ?in_app_iff in *. tauto.
  - intros e u ie hu he. assert (X : in_cell (its_cell w) u \/ In e inner) by (destruct ie as [<- | ie]; [left; exact he | right; exact ie]).
    destruct X as [X | X]; [right; eexists; split; [left; reflexivity | split; [reflexivity | exact X]] |].
    destruct (HI e u X hu he) as [h | [v [[<- | iv] [pv hv]]]]; [left; exact h | congruence | right; exists v; split; [right; exact iv | split; assumption]].
  - exact FI.
  - intros e ie. apply W. rewrite in_app_iff in *. cbn [In filter of_part negb app] in *. tauto.
  - intros v u [<- | iv] hu hv; [exact (D w u (or_introl eq_refl) hu hv) | exact (D v u (or_intror iv) hu hv)].
  - rewrite Ei, Si. unfold weights. cbn [fold_right]. lia.
  - rewrite Eo. exact So.
  - rewrite Eb. exact Sb.
Qed.

Lemma step_stands : forall st i st' inner outer und, stands st inner outer und -> read_node bits b find st i = Some st' ->
  exists inner' outer' und', stands st' inner' outer' und'.
Proof.
  intros [[| w rest] t] i st' inner outer und S h; [discriminate |]. unfold read_node in h. cbn [to_read tally_] in h. cbv zeta in h.
  set (rs := ranges b (its_cell w)) in *. pose proof (are_done _ _ _ _ S) as D. cbn [to_read] in D. specialize (fun u => D w u (or_introl eq_refl)).
  assert (R : forall u, in_box u -> in_cell (its_cell w) u -> Forall2 (contains bits) rs (x_at u)) by (intros u; apply ranges_hold).
  assert (Shown : forall steps open, match steps with [] => Some (its_open w) | _ => discharged bits b find (values_on bits b rs) rs steps (its_open w) end = Some open ->
    forall u, in_box u -> in_cell (its_cell w) u -> done_at open u).
  { intros steps open e u hu hw. destruct steps; [injection e as <-; exact (D u hu hw) |]. exact (discharged_sound _ _ _ _ u (R u hu hw) e (D u hu hw)). }
  pose proof (paved_is board_is) as paved_is0. pose proof (others_are board_is) as others_are0. rewrite (symmetry_is board_is) in h.
  destruct (kind_ i) as [k | k | | at' by_' | |].
  - destruct (negb (of_part w) && existsb (Nat.eqb k) (its_paved b) && (its_depth w <? most_depth b)%N) eqn:g; [| discriminate].
    apply andb_true_iff in g as [g _]. apply andb_true_iff in g as [np ik]. apply negb_true_iff in np. apply existsb_exists in ik as [k' [ik e]]. apply Nat.eqb_eq in e. subst k'.
    rewrite paved_is0 in ik. destruct (match steps_ i with [] => _ | _ => _ end) as [open |] eqn:sh; [| discriminate].
    destruct (may_halve k (its_cell w)) eqn:may; [| discriminate]. injection h as <-. exists inner, outer, und. rewrite <- np at 1 2.
    apply (halves_stand w rest t); auto. exact (Shown _ _ sh).
  - destruct (nth_error (its_others b) k) as [j |] eqn:nj; [| discriminate]. destruct (match steps_ i with [] => _ | _ => _ end) as [open |] eqn:sh; [| discriminate].
    destruct (may_halve j (its_cell w)) eqn:may; [| discriminate]. injection h as <-. destruct (of_part w) eqn:p.
    + exists inner, outer, und. rewrite <- p. apply (halves_stand w rest t); auto; [exact (Shown _ _ sh) | congruence].
    + exists (its_cell w :: inner), outer, und. set (t' := one_inner _ t).
      refine (halves_stand (Waiting (its_cell w) (its_open w) (its_depth w) true) rest t' t' _ _ _ j open _ (into_parts w rest t t' _ _ _ p S eq_refl eq_refl eq_refl) may (Shown _ _ sh) eq_refl eq_refl eq_refl _).
      discriminate.
  - destruct (discharged bits b find (values_on bits b rs) rs (steps_ i) (its_open w)) as [open |] eqn:e1; [| discriminate].
    destruct (discharged bits b find (values_on bits b rs) rs (open_ones open) open) as [open' |] eqn:e2; [| discriminate].
    destruct (forallb negb open') eqn:e3; [| discriminate]. injection h as <-.
    assert (H : forall u, in_box u -> in_cell (its_cell w) u -> holds_at c edges u).
    { intros u hu hw. apply (all_done open' u e3). apply (discharged_sound _ _ _ _ u (R u hu hw) e2), (discharged_sound _ _ _ _ u (R u hu hw) e1), (D u hu hw). }
    destruct (of_part w) eqn:p; [exists inner, outer, und; exact (part_stands w rest t _ _ _ p S H) |].
    exists (its_cell w :: inner), outer, und. apply (leaf_stands w rest t _ inner outer und); auto; unfold one_inner, weights; cbn [app In inner_share outer_share boundary_share fold_right].
    + auto.
    + auto.
    + intros k [<- | ik]; auto.
    + intros ->. unfold weights. lia.
  - destruct (match at' with None => Some rs | Some at_ => moved_to b (its_others b) at_ rs end) as [rs' |] eqn:em; [| discriminate].
    destruct (_ && existsb _ _) eqn:g in h; [| discriminate]. injection h as <-. apply andb_true_iff in g as [g hf]. apply andb_true_iff in g as [np _]. apply negb_true_iff in np.
    apply existsb_exists in hf as [f [_ hf]].
    assert (F : forall u, in_box u -> in_cell (its_cell w) u -> ~ in_region c edges paved u).
    { intros u hu hw reg. assert (X : exists u', in_box u' /\ (forall k, In k paved -> nth k u' 0 = nth k u 0) /\ Forall2 (contains bits) rs' (x_at u')).
      { destruct at' as [z |]; [exact (moved_hold _ _ _ _ u em others_are0 hu (R u hu hw)) |]. injection em as <-. exists u. split; [exact hu |]. split; [reflexivity | exact (R u hu hw)]. }
      destruct X as [u' [x1 [x2 x3]]]. exact (fails_sound rs' u' f x3 hf (reg u' x1 x2)). }
    exists inner, (its_cell w :: outer), und. apply (leaf_stands w rest t _ inner outer und); auto; unfold one_outer, weights; cbn [inner_share outer_share boundary_share fold_right].
    + intros k ik. rewrite !in_app_iff in *. cbn [In]. tauto.
    + intros u _ _ _. rewrite !in_app_iff. cbn [In]. tauto.
    + intros k [<- | ik]; auto.
    + intros ->. unfold weights. lia.
  - destruct (_ && _) eqn:g in h; [| discriminate]. injection h as <-. apply andb_true_iff in g as [np _]. apply negb_true_iff in np.
    exists inner, outer, (its_cell w :: und). apply (leaf_stands w rest t _ inner outer und); auto; unfold one_boundary, weights; cbn [inner_share outer_share boundary_share fold_right].
    + intros k ik. rewrite !in_app_iff in *. cbn [In]. tauto.
    + intros u _ _ _. rewrite !in_app_iff. cbn [In]. tauto.
    + intros ->. unfold weights. lia.
  - destruct (_ && _ && _) eqn:g in h; [| discriminate]. injection h as <-. apply andb_true_iff in g as [g gm]. apply andb_true_iff in g as [g gs]. apply andb_true_iff in g as [np _]. apply negb_true_iff in np.
    exists inner, outer, und. apply (leaf_stands w rest t _ inner outer und); auto.
    intros u _ due hw. destruct (mirrored_sound _ u gm hw (due gs)).
Qed.

(** All nodes, one after the other. *)
Fixpoint after (st : state) (l : list item) : option state :=
  match l with [] => Some st | i :: l' => match read_node bits b find st i with Some st' => after st' l' | None => None end end.

Lemma same_holds : symmetric = true -> forall p u, in_box u -> holds_at c edges u -> holds_at c edges (Symmetry.moved p u).
Proof.
  intros e p u [l _] h. pose proof (is_same_from board_is e) as sym. assert (E : point_at edges (Symmetry.moved p u) = turn p (point_at edges u)).
  { unfold is_symmetric in sym. rewrite box_is in sym. apply andb_true_iff in sym as [sym _]. apply andb_true_iff in sym as [_ sym]. apply andb_true_iff in sym as [s1 s2].
    apply same_tolerance_sound in s1, s2. destruct u as [| x [| y [| z [|]]]]; try discriminate. unfold point_at. rewrite s1, s2.
    destruct p; reflexivity. }
  intros m hm. rewrite E. exact (symmetric_sound c p _ sym h m hm).
Qed.

Theorem paving_sound : forall items st, after (start_paving b) items = Some st -> to_read st = [] -> (inner_share (tally_ st) + outer_share (tally_ st) + boundary_share (tally_ st) = 2 ^ share_places)%Z ->
  exists inner outer rest, is_paving c edges paved symmetric inner outer rest /\ weights symmetric inner = inner_share (tally_ st) /\ weights symmetric rest = boundary_share (tally_ st).
Proof.
  intros items st h e total. assert (G : forall items st0 i o r, stands st0 i o r -> after st0 items = Some st -> exists i' o' r', stands st i' o' r').
  { clear items h. induction items as [| x items IH]; intros st0 i o r S h; cbn [after] in h; [injection h as <-; exists i, o, r; exact S |].
    destruct (read_node bits b find st0 x) as [st1 |] eqn:e1; [| discriminate]. destruct (step_stands _ _ _ _ _ _ S e1) as [i1 [o1 [r1 S1]]]. exact (IH st1 i1 o1 r1 S1 h). }
  destruct (G items (start_paving b) [] [] [] starts h) as [i [o [r S]]]. exists i, o, r. destruct S as [C HI FI W _ Si So Sb]. rewrite e in *. cbn [whole_cells map filter] in *.
  rewrite !app_nil_r in *. split; [| split; congruence]. constructor.
  - exact C.
  - rewrite Si, So, Sb in total. rewrite <- total. assert (A : forall l k, weights symmetric (l ++ k) = (weights symmetric l + weights symmetric k)%Z)
      by (induction l as [| x l IH]; intro k; [reflexivity |]; unfold weights in *; cbn [app fold_right]; rewrite IH; lia).
    rewrite !A. lia.
  - intros k u ik hu hk u' hu' same. destruct (HI k u' ik hu') as [h' | [w [[] _]]]; [| exact h'].
    apply (whole_agree k u u'); auto.
  - exact FI.
  - exact same_holds.
Qed.
End Sound.
