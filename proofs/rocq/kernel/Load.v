(** * The joint forces that hold one force on the platform

    F = M^T tau, so that tau_i is det M with F for row i over det M, and the rows
    of A are multiples of those of M: |tau_i| <= b where |det A| is neither less
    than c nor than - c, c = sqrt D_i det A', A' with F/b for row i. *)

From Coq Require Import Reals Lra Lia List Bool.
From Orthocert.kernel Require Import Linear Configuration Singular.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Definition multiples (cs : list R) (rows : list (list R)) : list (list R) := map (fun p => map (Rmult (fst p)) (snd p)) (combine cs rows).

Lemma determinant_laplace : forall n rows, is_square n rows = true -> determinant rows = laplace R 0 1 Rminus Rmult n rows.
Proof.
  intros n rows h. destruct (square_cases n rows h) as [[-> [a [b [c [d ->]]]]] | [-> [a [b [c [d [e [f [g [k [i ->]]]]]]]]]]]; cbn; ring.
Qed.

Lemma multiples_square : forall n cs rows, length cs = length rows -> is_square n (multiples cs rows) = is_square n rows.
Proof.
  intros n cs rows l. unfold is_square, multiples. rewrite map_length, combine_length, l, Nat.min_id. f_equal.
  revert cs l. induction rows as [| r rows IH]; intros [| c cs] l; try discriminate; [reflexivity |]. cbn [combine map forallb fst snd].
  rewrite map_length. f_equal. apply IH. injection l. auto.
Qed.
Lemma square_length : forall (A : Type) n (rows : list (list A)), is_square n rows = true -> length rows = n.
Proof. intros A n rows h. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [_ h]. apply Nat.eqb_eq, h. Qed.

(** The determinant of multiples of rows that see every direction is not zero. *)
Lemma determinant_regular : forall n cs rows, is_square n rows = true -> length cs = length rows -> Forall (fun c => c <> 0) cs ->
  (forall v, length v = n -> nonzero v -> 0 < speed2 rows v) -> determinant (multiples cs rows) <> 0.
Proof.
  intros n cs rows sq l nz inj z. rewrite (determinant_laplace n) in z by (rewrite multiples_square; assumption).
  assert (ln : length (multiples cs rows) = n).
  { apply square_length. rewrite multiples_square; assumption. }
  destruct (det_zero n _ ln z) as [v [lv [v0 h]]]. specialize (inj v lv v0). enough (speed2 rows v = 0) by lra. clear - l nz h.
  revert cs l nz h. induction rows as [| r rows IH]; intros [| c cs] l nz h; try discriminate; [reflexivity |]. unfold multiples in h. cbn [combine map fst snd] in h.
  inversion h as [| ? ? h1 h2]. inversion nz as [| ? ? n1 n2]. subst. rewrite dot_map in h1. apply Rmult_integral in h1 as [h1 | h1]; [contradiction |].
  cbn [speed2 fold_right]. change (fold_right _ 0 rows) with (speed2 rows v). rewrite h1, (IH cs ltac:(injection l; auto) n2 h2). ring.
Qed.

(** With row i replaced by a multiple of the force. *)
Lemma replaced_determinant : forall n cs rows tau F k i, is_square n rows = true -> length cs = length rows -> holds_force n rows tau F -> (i < n)%nat ->
  nth i cs 0 * determinant (replaced i (map (Rmult k) F) (multiples cs rows)) = k * nth i tau 0 * determinant (multiples cs rows).
Proof.
  intros n cs rows tau F k i sq lc [lt' [lF h]] li. destruct (square_cases n rows sq) as [[-> [a [b [c [d ->]]]]] | [-> [a [b [c [d [e [f [g [j [q ->]]]]]]]]]]].
  - destruct cs as [| x [| y [|]]]; try discriminate. destruct tau as [| t [| u [|]]]; try discriminate. destruct F as [| p [| r [|]]]; try discriminate.
    pose proof (h [1; 0] eq_refl) as h1. pose proof (h [0; 1] eq_refl) as h2. cbn in h1, h2.
    assert (E1 : p = t * a + u * c) by lra. assert (E2 : r = t * b + u * d) by lra. subst p r. destruct i as [| [| i]]; [| | lia]; cbn; ring.
  - destruct cs as [| x [| y [| z [|]]]]; try discriminate. destruct tau as [| t [| u [| w [|]]]]; try discriminate. destruct F as [| p [| r [| s [|]]]]; try discriminate.
    pose proof (h [1; 0; 0] eq_refl) as h1. pose proof (h [0; 1; 0] eq_refl) as h2. pose proof (h [0; 0; 1] eq_refl) as h3. cbn in h1, h2, h3.
    assert (E1 : p = t * a + u * d + w * g) by lra. assert (E2 : r = t * b + u * e + w * j) by lra. assert (E3 : s = t * c + u * f + w * q) by lra.
    subst p r s. destruct i as [| [| [| i]]]; [| | | lia]; cbn; ring.
Qed.

(** What the two tests show, of both signs of c. *)
Theorem load_bounded : forall n cs rows mu tau F b i, is_square n rows = true -> length cs = length rows -> Forall (fun c => c <> 0) cs -> 0 < mu -> 0 < b ->
  (forall v, length v = n -> nonzero v -> 0 < speed2 rows v) -> (i < n)%nat -> holds_force n rows tau F ->
  let A := multiples (map (fun c => c * mu) cs) rows in
  let c := sqrt (nth i cs 0 ^ 2) * determinant (replaced i (map (Rmult (mu / b)) F) A) in
  (0 <= determinant A - c \/ 0 <= - (determinant A + c)) -> (0 <= determinant A - - c \/ 0 <= - (determinant A + - c)) -> Rabs (nth i tau 0) <= b.
Proof.
  intros n cs rows mu tau F b i sq lc nz m0 b0 inj li hF A c h1 h2.
  assert (lc' : length (map (fun c => c * mu) cs) = length rows) by (rewrite map_length; exact lc).
  assert (nz' : Forall (fun c => c <> 0) (map (fun c => c * mu) cs)).
  { rewrite Forall_map. revert nz. apply Forall_impl. intros x x0. apply Rmult_integral_contrapositive_currified; lra. }
  pose proof (determinant_regular n _ rows sq lc' nz' inj) as D0. fold A in D0.
  pose proof (replaced_determinant n _ rows tau F (mu / b) i sq lc' hF li) as E. fold A in E. set (e := determinant (replaced i (map (Rmult (mu / b)) F) A)) in *.
  assert (N : nth i (map (fun c => c * mu) cs) 0 = nth i cs 0 * mu).
  { replace 0 with (0 * mu) at 1 by ring. apply (map_nth (fun c => c * mu)). } rewrite N in E.
  assert (E' : b * (nth i cs 0 * e) = nth i tau 0 * determinant A).
  { apply Rmult_eq_reg_l with mu; [| lra]. replace (mu * (b * (nth i cs 0 * e))) with (b * (nth i cs 0 * mu * e)) by ring. rewrite E. field. lra. }
  assert (C2 : Rabs c = Rabs (nth i cs 0 * e)).
  { unfold c. rewrite !Rabs_mult. f_equal. rewrite <- (Rsqr_pow2 (nth i cs 0)), sqrt_Rsqr_abs. apply Rabs_Rabsolu. }
  set (D := determinant A) in *. assert (L : Rabs c <= Rabs D).
  { unfold Rabs at 1. destruct (Rcase_abs c); [apply Rle_trans with (- c); [lra |] |]; unfold Rabs; destruct (Rcase_abs D); lra. }
  apply (f_equal Rabs) in E'. rewrite !Rabs_mult, (Rabs_right b) in E' by lra. rewrite Rabs_mult in C2. rewrite <- C2 in E'.
  pose proof (Rabs_pos_lt D D0) as d0. apply Rmult_le_reg_r with (Rabs D); [exact d0 |]. rewrite <- E'. apply Rmult_le_compat_l; lra.
Qed.
