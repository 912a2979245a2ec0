(** * What the Rust kernel computes, computed again

    Written by proofs/kernel/tests/kernel/rocq.rs.  The digests are of the
    integers that the kernel's arithmetic gives: operations on random
    intervals, definiteness of random matrices, what is shown of random cells
    of the postulate's faces and the slopes of elbows in so few bits that each
    rounding counts, and the slopes of all rows of two machines over cells of their boxes.  Nothing
    depends on this file. *)

From Coq Require Import ZArith NArith List Bool.
From Orthocert Require Import Fixed Claim.
From Orthocert.kernel Require Import Arithmetic Slope Definite Test Check Number Statement Machine Problem Formula.
From Orthocert.kernel Require Faces.
From Orthocert.instances Require FourSliders StrutsAndPlane.
Import ListNotations.
Local Open Scope Z_scope.

Definition mask := Eval vm_compute in Z.ones 127.
Definition absorb (digest x : Z) : Z := Z.land (digest * 1000003 + x) mask.
Definition absorb_interval (digest : Z) (a : option fixed) : Z :=
  match a with Some a => absorb (absorb digest (lo a)) (hi a) | None => absorb digest 7 end.

(** ** Operations *)

Definition word := Eval vm_compute in Z.ones 64.
Definition next (seed : Z) : Z := Z.land (seed * 6364136223846793005 + 1442695040888963407) word.
Definition drawn (seed n : Z) : Z := Z.shiftr seed 33 mod n.
(** An interval, and the seed after it. *)
Definition interval (seed low width : Z) : fixed * Z :=
  let s := next seed in let t := next s in
  let a := low + drawn s width in let b := low + drawn t width in (Fixed (Z.min a b) (Z.max a b), t).

Fixpoint operations_digest (n : nat) (seed digest : Z) : Z * Z :=
  match n with
  | O => (digest, seed)
  | S n =>
      let (a, s) := interval seed (-1500) 3000 in let (b, s) := interval s (-1500) 3000 in
      let (c, s) := interval s 1 2000 in let s := next s in
      let results := [Some (mul 10 a b); Some (sqr 10 a); recip 10 a; Fixed.root 10 a; Some (halve a);
        Some (dyadic (drawn s 2000 - 1000) 7 a); Some (ratio a b c)] in
      operations_digest n s (fold_left absorb_interval results digest)
  end.

Fixpoint row_of (n : nat) (seed : Z) : list fixed * Z :=
  match n with
  | O => ([], seed)
  | S n => let (a, s) := interval seed (-900) 1800 in let (row, t) := row_of n s in (a :: row, t)
  end.
(** Of size n + 1. *)
Fixpoint matrix_of (n : nat) (seed : Z) : triangle * Z :=
  let (a, s) := interval seed 1800 1500 in let (row, t) := row_of n s in
  match n with
  | O => ([a :: row], t)
  | S n => let (rest, u) := matrix_of n t in ((a :: row) :: rest, u)
  end.
Fixpoint definite_digest (n : nat) (seed digest : Z) : Z :=
  match n with
  | O => digest
  | S n => let (m, s) := matrix_of 3 seed in definite_digest n s (absorb digest (if is_positive_definite 10 m then 1 else 0))
  end.

Definition drawn_operations := operations_digest 200 1 0.
Definition arithmetic : Z := fst drawn_operations.
Definition definite : Z := definite_digest 100 (snd drawn_operations) 0.

(** ** The postulate's faces *)

Definition compiled (l : list formula) : list (op address) * list nat := let tape := compile l in (tape, map (place (formulas tape)) l).
Definition part (f : face) (low : bool) : list (op address) * list nat := compiled (Faces.entries f low).
Definition part_1 := Eval vm_compute in part Q1 true.
Definition part_2 := Eval vm_compute in part Q1 false.
Definition part_3 := Eval vm_compute in part Q2 true.
Definition part_4 := Eval vm_compute in part Q2 false.
Definition near (seed low base width : Z) : fixed * Z := let s := next seed in interval s (low + drawn s base) width.
Fixpoint face_digest (n : nat) (f : face) (from : Z) (part : list (op address) * list nat) (st : Z * Z) : Z * Z :=
  match n with
  | O => st
  | S n =>
      let (y, s) := near (snd st) 0 3400 700 in let (z, s) := near s 0 3400 700 in let (k, s) := near s from 1400 600 in
      let shows e := if Faces.shows f 12 (fst part) (snd part) [y; z; k] e then 1 else 0 in
      face_digest n f from part (absorb (fst st) (2 * shows ByTest + shows (ByCorner f)), s)
  end.
Definition shown : Z :=
  fst (face_digest 100 Q2 2048 part_4 (face_digest 100 Q2 0 part_3 (face_digest 100 Q1 2048 part_2 (face_digest 100 Q1 0 part_1 (0, 1))))).

(** ** Slopes *)

Definition absorb_slope (digest : Z) (f : option slope) : Z :=
  match f with
  | Some f => fold_left absorb_interval (map Some (at_c f :: range f :: map (fun k => nth k (slopes f) zero) [0; 1; 2]%nat)) digest
  | None => absorb digest 7
  end.
(** The elbow of three coordinates, over random cells in few bits. *)
Definition elbow_tape : list (op address) :=
  compile (let crossing second := F (Elbow second (F (Coord 0)) (F (Coord 1)) (F (Coord 2))) in [crossing false; crossing true]).
Fixpoint elbows_digest (n : nat) (st : Z * Z) : Z :=
  match n with
  | O => fst st
  | S n =>
      let (a, s) := near (snd st) (-5000) 9000 500 in let (b, s) := near s (-5000) 9000 500 in let (t, s) := near s 200 9000 500 in
      let values := evaluate 12 elbow_tape [] [a; b; t] in
      elbows_digest n (fold_left absorb_slope [nth 1 values None; nth 0 values None] (fst st), s)
  end.
Definition elbows : Z := elbows_digest 200 (0, 1).

(** A tape of all rows, and where they are on it. *)
Definition compiled_rows (c : claim) (s : Z) (ds : list Z) : list (op address) * list nat :=
  let fs := all_formulas s ds (legs c) 0 in compiled (entries (whole_rows fs) ++ entries (divided_rows fs)).
Definition rows_digest (rows : list (op address) * list nat) (inputs : list parameter) (bits : positive) (cell : list fixed) : Z :=
  match all_some (map (enclose_parameter bits) inputs) with
  | Some params =>
      let values := evaluate bits (fst rows) params cell in
      fold_left absorb_slope (map (fun i => nth i values None) (snd rows)) 0
  | None => 0
  end.

Module FourSliders.
Definition units := [0; 0; 0; 0].
Definition rows := Eval vm_compute in compiled_rows FourSliders.the_claim 9 units.
Definition over := rows_digest rows (layouts 9 units (legs FourSliders.the_claim)).
End FourSliders.
Module StrutsAndPlane.
Definition units := [0; 0; 0; 1].
Definition rows := Eval vm_compute in compiled_rows StrutsAndPlane.the_claim 9 units.
Definition over := rows_digest rows (layouts 9 units (legs StrutsAndPlane.the_claim)).
End StrutsAndPlane.

Example operations : arithmetic = 7017841435846086887692315725061807257.
Proof. vm_cast_no_check (eq_refl 7017841435846086887692315725061807257). Qed.
Example definiteness : definite = 117724195210062243353930469751842205840.
Proof. vm_cast_no_check (eq_refl 117724195210062243353930469751842205840). Qed.
Example faces : shown = 31913373165326602092280992525734546912.
Proof. vm_cast_no_check (eq_refl 31913373165326602092280992525734546912). Qed.
Example elbows_are : elbows = 67286614231854316446669086773251632626.
Proof. vm_cast_no_check (eq_refl 67286614231854316446669086773251632626). Qed.

Example foursliders_52_0 : FourSliders.over 52 [Fixed (-527765581332480) (527765581332480); Fixed (-527765581332480) (527765581332480); Fixed (0) (1759218604441600)] = 112952018440446013053676556095504964808.
Proof. vm_cast_no_check (eq_refl 112952018440446013053676556095504964808). Qed.
Example foursliders_52_1 : FourSliders.over 52 [Fixed (-527765581332480) (0); Fixed (-527765581332480) (527765581332480); Fixed (0) (1759218604441600)] = 141918998624116755765617505168916669542.
Proof. vm_cast_no_check (eq_refl 141918998624116755765617505168916669542). Qed.
Example foursliders_52_2 : FourSliders.over 52 [Fixed (-527765581332480) (0); Fixed (0) (527765581332480); Fixed (0) (1759218604441600)] = 30775135419699682390336540155037426712.
Proof. vm_cast_no_check (eq_refl 30775135419699682390336540155037426712). Qed.
Example foursliders_52_3 : FourSliders.over 52 [Fixed (-527765581332480) (0); Fixed (263882790666240) (527765581332480); Fixed (0) (1759218604441600)] = 64886988133670897372959615908092192876.
Proof. vm_cast_no_check (eq_refl 64886988133670897372959615908092192876). Qed.
Example strutsandplane_52_0 : StrutsAndPlane.over 52 [Fixed (-351843720888320) (351843720888320); Fixed (-351843720888320) (351843720888320); Fixed (1583296743997440) (2111062325329920)] = 163992950136267105297690689105268292135.
Proof. vm_cast_no_check (eq_refl 163992950136267105297690689105268292135). Qed.
Example strutsandplane_52_1 : StrutsAndPlane.over 52 [Fixed (-351843720888320) (0); Fixed (-351843720888320) (351843720888320); Fixed (1583296743997440) (2111062325329920)] = 134321228582190885000435994130063179254.
Proof. vm_cast_no_check (eq_refl 134321228582190885000435994130063179254). Qed.
Example strutsandplane_52_2 : StrutsAndPlane.over 52 [Fixed (-351843720888320) (0); Fixed (0) (351843720888320); Fixed (1583296743997440) (2111062325329920)] = 85057445131515762727177877292413919757.
Proof. vm_cast_no_check (eq_refl 85057445131515762727177877292413919757). Qed.
Example strutsandplane_52_3 : StrutsAndPlane.over 52 [Fixed (-351843720888320) (0); Fixed (175921860444160) (351843720888320); Fixed (1583296743997440) (2111062325329920)] = 106247363745788709824487096591301014585.
Proof. vm_cast_no_check (eq_refl 106247363745788709824487096591301014585). Qed.
Example foursliders_100_0 : FourSliders.over 100 [Fixed (-148552804714245632987894906880) (148552804714245632987894906880); Fixed (-148552804714245632987894906880) (148552804714245632987894906880); Fixed (0) (495176015714152109959649689600)] = 70808838892546518459953281237441805212.
Proof. vm_cast_no_check (eq_refl 70808838892546518459953281237441805212). Qed.
Example foursliders_100_1 : FourSliders.over 100 [Fixed (-148552804714245632987894906880) (148552804714245632987894906880); Fixed (-148552804714245632987894906880) (148552804714245632987894906880); Fixed (0) (247588007857076054979824844800)] = 70808838892546518459953281237441805212.
Proof. vm_cast_no_check (eq_refl 70808838892546518459953281237441805212). Qed.
Example foursliders_100_2 : FourSliders.over 100 [Fixed (-148552804714245632987894906880) (0); Fixed (-148552804714245632987894906880) (148552804714245632987894906880); Fixed (0) (247588007857076054979824844800)] = 37935754058709384404474079329795518260.
Proof. vm_cast_no_check (eq_refl 37935754058709384404474079329795518260). Qed.
Example foursliders_100_3 : FourSliders.over 100 [Fixed (-148552804714245632987894906880) (0); Fixed (-148552804714245632987894906880) (148552804714245632987894906880); Fixed (0) (123794003928538027489912422400)] = 37935754058709384404474079329795518260.
Proof. vm_cast_no_check (eq_refl 37935754058709384404474079329795518260). Qed.
Example strutsandplane_100_0 : StrutsAndPlane.over 100 [Fixed (-99035203142830421991929937920) (99035203142830421991929937920); Fixed (-99035203142830421991929937920) (99035203142830421991929937920); Fixed (445658414142736898963684720640) (594211218856982531951579627520)] = 37428417742739119792253782549204535725.
Proof. vm_cast_no_check (eq_refl 37428417742739119792253782549204535725). Qed.
Example strutsandplane_100_1 : StrutsAndPlane.over 100 [Fixed (-99035203142830421991929937920) (99035203142830421991929937920); Fixed (-99035203142830421991929937920) (99035203142830421991929937920); Fixed (445658414142736898963684720640) (519934816499859715457632174080)] = 49524104770934260418547546311082256229.
Proof. vm_cast_no_check (eq_refl 49524104770934260418547546311082256229). Qed.
Example strutsandplane_100_2 : StrutsAndPlane.over 100 [Fixed (-99035203142830421991929937920) (0); Fixed (-99035203142830421991929937920) (99035203142830421991929937920); Fixed (445658414142736898963684720640) (519934816499859715457632174080)] = 142926452134707714380882920269509352798.
Proof. vm_cast_no_check (eq_refl 142926452134707714380882920269509352798). Qed.
Example strutsandplane_100_3 : StrutsAndPlane.over 100 [Fixed (-99035203142830421991929937920) (0); Fixed (-99035203142830421991929937920) (99035203142830421991929937920); Fixed (445658414142736898963684720640) (482796615321298307210658447360)] = 107322947056794558559404046919946328325.
Proof. vm_cast_no_check (eq_refl 107322947056794558559404046919946328325). Qed.
