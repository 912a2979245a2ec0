(** * Lists as vectors and upper triangles as symmetric matrices

    Missing entries count as zero, so no lemma asks for a length. *)

From Coq Require Import Reals Lra List.
Import ListNotations.
Local Open Scope R_scope.

Fixpoint dot (u v : list R) : R :=
  match u, v with a :: u', b :: v' => a * b + dot u' v' | _, _ => 0 end.

Section Merge.
Variables A B C : Type.
Variables (l : A -> C) (r : B -> C) (lr : A -> B -> C).
Fixpoint merge (s : list A) (t : list B) : list C :=
  match s with
  | [] => map r t
  | a :: s' => match t with [] => map l s | b :: t' => lr a b :: merge s' t' end
  end.
End Merge.
Arguments merge {A B C}.

Lemma map_related : forall (A B C D : Type) (P : A -> B -> Prop) (Q : C -> D -> Prop) f g,
  (forall a b, P a b -> Q (f a) (g b)) -> forall s t, Forall2 P s t -> Forall2 Q (map f s) (map g t).
Proof. intros until g. intros h s t. induction 1; cbn; constructor; auto. Qed.

Lemma merge_related : forall (A B C A' B' C' : Type) (P : A -> A' -> Prop) (Q : B -> B' -> Prop) (S : C -> C' -> Prop)
  l r lr l' r' lr',
  (forall a a', P a a' -> S (l a) (l' a')) -> (forall b b', Q b b' -> S (r b) (r' b')) ->
  (forall a a' b b', P a a' -> Q b b' -> S (lr a b) (lr' a' b')) ->
  forall s s' t t', Forall2 P s s' -> Forall2 Q t t' -> Forall2 S (merge l r lr s t) (merge l' r' lr' s' t').
Proof.
  intros until lr'. intros hl hr hlr s s' t t' hs. revert t t'. induction hs as [| a a' s s' h hs IH]; intros t t' ht.
  - cbn. eapply map_related; eassumption.
  - destruct ht as [| b b' t t' k ht]; cbn.
    + constructor; auto. eapply map_related; eassumption.
    + constructor; auto.
Qed.

Lemma related_weaken : forall (A B : Type) (P Q : A -> B -> Prop), (forall a b, P a b -> Q a b) ->
  forall s t, Forall2 P s t -> Forall2 Q s t.
Proof. induction 2; constructor; auto. Qed.

Lemma related_length : forall (A B : Type) (P : A -> B -> Prop) s t, Forall2 P s t -> length s = length t.
Proof. induction 1; cbn; congruence. Qed.

(** a u + b v *)
Definition comb (a b : R) : list R -> list R -> list R := merge (Rmult a) (Rmult b) (fun x y => a * x + b * y).

Lemma dot_map : forall a u w, dot (map (Rmult a) u) w = a * dot u w.
Proof. induction u as [| x u IH]; intros [| y w]; cbn; rewrite ?IH; ring. Qed.

Lemma dot_comb : forall a b u v w, dot (comb a b u v) w = a * dot u w + b * dot v w.
Proof.
  unfold comb. intros a b. induction u as [| x u IH]; intros v w; cbn [merge].
  - rewrite dot_map. cbn. ring.
  - destruct v as [| y v]; [rewrite dot_map; cbn [dot]; ring |].
    destruct w as [| z w]; cbn [dot]; rewrite ?IH; ring.
Qed.

(** ** Upper triangles: row i is [s_ii; s_i,i+1; ...] *)

Definition row_form (row : list R) (t : R) (w : list R) : R :=
  match row with [] => 0 | a :: b => a * t ^ 2 + 2 * t * dot b w end.
Fixpoint quad (S : list (list R)) (v : list R) : R :=
  match S, v with row :: S', t :: w => row_form row t w + quad S' w | _, _ => 0 end.

Definition tcomb (a b : R) : list (list R) -> list (list R) -> list (list R) :=
  merge (map (Rmult a)) (map (Rmult b)) (comb a b).

Lemma row_form_map : forall a r t w, row_form (map (Rmult a) r) t w = a * row_form r t w.
Proof. intros a [| x r] t w; cbn; rewrite ?dot_map; ring. Qed.

Lemma row_form_comb : forall a b r s t w, row_form (comb a b r s) t w = a * row_form r t w + b * row_form s t w.
Proof.
  intros a b [| x r] [| y s] t w; cbn; rewrite ?dot_map; try ring.
  fold (comb a b r s). rewrite dot_comb. ring.
Qed.

Lemma quad_map : forall a S v, quad (map (map (Rmult a)) S) v = a * quad S v.
Proof. induction S as [| r S IH]; intros [| t w]; cbn; rewrite ?row_form_map, ?IH; ring. Qed.

Lemma quad_tcomb : forall a b S T v, quad (tcomb a b S T) v = a * quad S v + b * quad T v.
Proof.
  unfold tcomb. intros a b. induction S as [| r S IH]; intros T v; cbn [merge].
  - rewrite quad_map. cbn. ring.
  - destruct T as [| s T]; [rewrite quad_map; cbn [quad]; ring |].
    destruct v as [| t w]; cbn [quad]; rewrite ?row_form_comb, ?IH; ring.
Qed.

(** y g^T + g y^T *)
Fixpoint outer (y g : list R) : list (list R) :=
  match y, g with
  | y1 :: y', g1 :: g' => (2 * y1 * g1 :: comb y1 g1 g' y') :: outer y' g'
  | _, _ => []
  end.

Lemma quad_outer : forall y g v, quad (outer y g) v = 2 * dot y v * dot g v.
Proof.
  induction y as [| y1 y IH]; intros [| g1 g] [| t w]; cbn [outer quad dot row_form]; rewrite ?IH, ?dot_comb; try ring.
Qed.

(** C - b b^T / a *)
Fixpoint schur (a : R) (b : list R) (C : list (list R)) : list (list R) :=
  match b with
  | [] => C
  | b1 :: b' =>
      match C with
      | [] => map (Rmult (- (b1 * / a))) b :: schur a b' []
      | row :: C' => comb 1 (- (b1 * / a)) row b :: schur a b' C'
      end
  end.

Lemma quad_schur : forall a b C v, a <> 0 -> quad (schur a b C) v = quad C v - / a * dot b v ^ 2.
Proof.
  intros a b C v h. revert C v. induction b as [| b1 b IH]; intros C v; cbn [schur].
  - cbn [dot]. ring.
  - destruct C as [| row C], v as [| t w]; cbn [quad dot]; try ring.
    + rewrite IH, row_form_map. cbn. field; assumption.
    + rewrite IH, row_form_comb. cbn. field; assumption.
Qed.

(** c I, of size n *)
Definition diagonal (n : nat) (c : R) : list (list R) := repeat [c] n.

Lemma quad_diagonal : forall c v, quad (diagonal (length v) c) v = c * dot v v.
Proof. unfold diagonal. induction v as [| t w IH]; cbn [length repeat quad dot row_form]; rewrite ?IH; ring. Qed.

(** ** Vectors that are not zero *)

Definition nonzero (v : list R) : Prop := 0 < dot v v.

Lemma dot_self : forall v, 0 <= dot v v.
Proof. induction v as [| t w IH]; cbn [dot]; [lra |]. pose proof (pow2_ge_0 t). nra. Qed.

Lemma zero_vector : forall v, dot v v <= 0 -> Forall (eq 0) v.
Proof.
  induction v as [| t w IH]; cbn [dot]; intro h; constructor; pose proof (dot_self w); pose proof (pow2_ge_0 t).
  - nra.
  - apply IH. nra.
Qed.

Lemma dot_zero : forall v u, Forall (eq 0) v -> dot u v = 0.
Proof.
  intros v u h. revert u. induction h as [| t w <- h IH]; intros [| a u]; cbn [dot]; rewrite ?IH; ring.
Qed.

Lemma quad_zero : forall v S, Forall (eq 0) v -> quad S v = 0.
Proof.
  intros v S h. revert S. induction h as [| t w <- h IH]; intros [| [| a b] S]; cbn [quad row_form]; rewrite ?IH; try ring.
Qed.

Lemma dot_opposite : forall v u, dot u (map Ropp v) = - dot u v.
Proof. induction v as [| t w IH]; intros [| a u]; cbn [dot map]; rewrite ?IH; ring. Qed.

Lemma norm_opposite : forall v, dot (map Ropp v) (map Ropp v) = dot v v.
Proof. induction v as [| t w IH]; cbn [dot map]; rewrite ?IH; ring. Qed.

Lemma quad_opposite : forall v S, quad S (map Ropp v) = quad S v.
Proof.
  induction v as [| t w IH]; intros [| [| a b] S]; cbn [quad row_form map]; rewrite ?IH, ?dot_opposite; ring.
Qed.

Lemma schur_length : forall a b C, (length C <= length (schur a b C))%nat.
Proof.
  intros a b. induction b as [| b1 b IH]; intros [| row C]; cbn [schur length]; auto using le_n_S with arith.
Qed.
