(** * The postulate, for a range of psi or every psi at once

    A second proof of [q1q2_postulate]'s lower bound, by subdivision: the faces
    x = q_1 and x = q_2 suffice ([AllPsi.v]).  With t and |q| of the face's
    corner Q_1 or Q_2 and eta = P/|q|, v^T M v - kappa |v|^2 is (t/2) v^T F v
    with F = (2 (1 - kappa)/t) I + (eta_j/S_i + eta_i/S_j)_ij, which has a tape
    in u_y, u_z and kappa that is regular up to kappa = 1 and kappa = 0; that
    F >= 0 is shown on the cells of a tree.  Formulas and steps are those of
    postulate.rs. *)

From Coq Require Import ZArith Reals Lra Lia Psatz List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Diagonal CubeLower CubeUpper Scaling Postulate AllPsi Fixed Claim.
From Orthocert.kernel Require Import Linear Arithmetic Slope Definite Test Cell Check Number Formula.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.
Local Notation value := Formula.value.
Local Notation regular := Kinematics.regular.

Local Ltac pairwise := repeat first [apply Forall2_nil | apply Forall2_cons].

(** ** F, from its diagonal entry and those at (1, 2), (1, 3) and (2, 3) *)

Definition upper {A : Type} (d xy xz yz : A) : list (list A) := [[d; xy; xz]; [d; yz]; [d]].

Lemma upper_form : forall d a b c x y z, quad (upper d a b c) [x; y; z]
  = d * (x ^ 2 + y ^ 2 + z ^ 2) + 2 * (a * (x * y) + b * (x * z) + c * (y * z)).
Proof. intros. cbn. ring. Qed.

Definition S_of (T a b : R) : R := sqrt (1 + T * (2 - a ^ 2 - b ^ 2)).

Definition F_of (d T i j k : R) : list (list R) :=
  upper d (j / S_of T j k + i / S_of T k i) (k / S_of T j k + i / S_of T i j) (k / S_of T k i + j / S_of T i j).
Definition nonnegative (S : list (list R)) : Prop := forall x y z, 0 <= quad S [x; y; z].

Lemma S_sym : forall T a b, S_of T a b = S_of T b a.
Proof. intros. unfold S_of. f_equal. ring. Qed.

Lemma mirrored : forall d T i j k, nonnegative (F_of d T i j k) -> nonnegative (F_of d T i k j).
Proof.
  intros d T i j k h x y z. specialize (h x z y). unfold F_of in *. rewrite upper_form in *.
  rewrite (S_sym T k j), (S_sym T j i), (S_sym T i k). lra.
Qed.

(** ** Formulas *)

Section Part.
Variable f : face.
(** kappa <= 1/2, or kappa >= 1/2. *)
Variable low : bool.

Definition kappa_ : formula := F (Coord 2).
Definition delta_ : formula := minus (integer 1) kappa_.
Definition p_ : formula :=
  let d2 := square delta_ in
  root (if low then over (plus (integer 1) (times (integer 2) d2)) (plus (integer 4) (times (integer 2) d2))
        else over (plus (times (integer 2) (square kappa_)) d2) (plus (integer 2) d2)).
Definition diagonal_ : formula :=
  match f with Q1 => integer 4 | Q2 => if low then integer 2 else times (integer 4) kappa_ end.
Definition t_ : formula :=
  match f with
  | Q1 => over delta_ (integer 2)
  | Q2 => if low then delta_ else over delta_ (times (integer 2) kappa_)
  end.
Definition x_ : formula := integer (match f with Q1 => -1 | Q2 => 1 end).
Definition eta_ (u : formula) : formula :=
  match f with
  | Q1 => minus (times u (plus (integer 1) (over (integer 1) p_))) (integer 1)
  | Q2 => minus (integer 1) (times (minus (integer 1) u) (plus (integer 1) p_))
  end.
Definition s_ (a b : formula) : formula :=
  root (plus (integer 1) (times (square t_) (minus (minus (integer 2) (square a)) (square b)))).

Definition entries : list formula :=
  let i := x_ in let j := eta_ (F (Coord 0)) in let k := eta_ (F (Coord 1)) in
  [diagonal_; plus (over j (s_ j k)) (over i (s_ k i)); plus (over k (s_ j k)) (over i (s_ i j));
   plus (over k (s_ k i)) (over j (s_ i j))].

(** Their values. *)
Definition p_of (kappa : R) : R :=
  sqrt (if low then (1 + 2 * (1 - kappa) ^ 2) / (4 + 2 * (1 - kappa) ^ 2)
        else (2 * kappa ^ 2 + (1 - kappa) ^ 2) / (2 + (1 - kappa) ^ 2)).
Definition d_of (kappa : R) : R := match f with Q1 => 4 | Q2 => if low then 2 else 4 * kappa end.
Definition t_of (kappa : R) : R :=
  match f with Q1 => (1 - kappa) / 2 | Q2 => if low then 1 - kappa else (1 - kappa) / (2 * kappa) end.
Definition x_of : R := match f with Q1 => -1 | Q2 => 1 end.
Definition eta_of (kappa u : R) : R :=
  match f with Q1 => u * (1 + 1 / p_of kappa) - 1 | Q2 => 1 - (1 - u) * (1 + p_of kappa) end.
Definition F_at (y z kappa : R) : list (list R) :=
  F_of (d_of kappa) (t_of kappa ^ 2) x_of (eta_of kappa y) (eta_of kappa z).

Definition matrix {A : Type} (l : list A) : list (list A) :=
  match l with [d; a; b; c] => upper d a b c | _ => [] end.

Lemma entries_value : forall y z kappa, matrix (map (value [y; z; kappa] []) entries) = F_at y z kappa.
Proof.
  intros. unfold entries, F_at, F_of, S_of, eta_of, p_of, x_of, d_of, t_of. cbv zeta. cbn [map matrix].
  unfold diagonal_, s_, eta_, x_, t_, p_, delta_, kappa_.
  destruct f, low; rewrite ?value_plus, ?value_over, ?value_root, ?value_plus, ?value_times, ?value_minus, ?value_square,
    ?value_over, ?value_times, ?value_minus, ?value_plus, ?value_over, ?value_root, ?value_over, ?value_plus, ?value_times,
    ?value_square, ?value_minus; reflexivity.
Qed.

(** ** The corner's own matrix *)

Definition corner_u : R := match f with Q1 => 0 | Q2 => 1 end.
Definition in_half (kappa : R) : Prop := if low then kappa <= 1 / 2 else 1 / 2 <= kappa.

Lemma S_corner : forall T a b, a ^ 2 = 1 -> b ^ 2 = 1 -> S_of T a b = 1.
Proof. intros T a b ha hb. unfold S_of. rewrite ha, hb. replace (1 + T * (2 - 1 - 1)) with 1 by ring. apply sqrt_1. Qed.

Lemma corner_nonnegative : forall kappa, in_half kappa -> nonnegative (F_at corner_u corner_u kappa).
Proof.
  intros kappa h x y z. unfold F_at, F_of. rewrite upper_form.
  assert (E : eta_of kappa corner_u = x_of) by (unfold eta_of, corner_u, x_of; destruct f; ring).
  assert (X : x_of ^ 2 = 1) by (unfold x_of; destruct f; ring).
  rewrite !E, !S_corner by exact X. unfold x_of, d_of, in_half in *.
  pose proof (pow2_ge_0 (x - y)). pose proof (pow2_ge_0 (x - z)). pose proof (pow2_ge_0 (y - z)).
  pose proof (pow2_ge_0 (x + y + z)). pose proof (pow2_ge_0 x). pose proof (pow2_ge_0 y). pose proof (pow2_ge_0 z).
  destruct f; [lra |]. destruct low; [lra |].
  assert (0 <= (4 * kappa - 2) * (x ^ 2 + y ^ 2 + z ^ 2)) by (apply Rmult_le_pos; lra). lra.
Qed.

(** ** What is shown on a cell *)

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Variable tape : list (op address).
Variable places : list nat.
Hypothesis represented : map (formula_at tape) places = entries.

(** The value where lambda_k is 1 or 0. *)
Fixpoint value_about (s : list bool) (sum : fixed) (terms : list fixed) : fixed :=
  match s, terms with
  | b :: s', a :: terms' => value_about s' (if b then add sum a else sum) terms'
  | _, _ => sum
  end.
Definition about_corner (s : list bool) (a : slope) : fixed := value_about s (at_c a) (slopes a).

Lemma about_corner_sound : forall s a e, entry_in bits a e ->
  contains (about_corner s a) (at_lambda (map (fun b : bool => if b then 1 else 0) s) e).
Proof.
  intros s [c r t] [y u]. unfold entry_in, about_corner, at_lambda. cbn [at_c slopes fst snd]. intros [hc h].
  revert s c y hc. induction h as [| a x t u hx h IH]; intros [| b s] c y hc; cbn [value_about map dot];
    try (rewrite Rplus_0_r; exact hc).
  rewrite <- Rplus_assoc. apply IH. destruct b.
  - rewrite Rmult_1_r. apply add_sound; assumption.
  - rewrite Rmult_0_r, Rplus_0_r. exact hc.
Qed.

(** F is positive definite at all of these vertices. *)
Definition definite_at (values : list (option slope)) (vertices : list (slope -> fixed)) : bool :=
  match map (fun i => nth i values None) places with
  | [Some d; Some a; Some b; Some c] =>
      forallb (fun at_ => is_positive_definite bits (upper (at_ d) (at_ a) (at_ b) (at_ c))) vertices
  | _ => false
  end.

Definition about (y z kappa : fixed) : list slope :=
  let c := Fixed.integer bits (match f with Q1 => 0 | Q2 => 1 end) in
  let edge a := sub (match f with Q1 => upper_end a | Q2 => lower_end a end) c in
  [Slope c y [edge y]; Slope c z [zero; edge z]; constant kappa].

Definition shows (cell : list fixed) (e : evidence) : bool :=
  match cell, e with
  | [_; _; _], ByTest => definite_at (evaluate bits tape [] cell) (map at_vertex (signs 3))
  | [y; z; kappa], ByCorner g =>
      match f, g with
      | Q1, Q1 | Q2, Q2 =>
          definite_at (run (option slope) None (slope_op bits (about y z kappa) []) tape)
            (map about_corner [[true; false]; [false; true]; [true; true]])
      | _, _ => false
      end
  | [y; z; _], ByMirror => (hi z <=? lo y)%Z
  | _, _ => false
  end.

Section Values.
Variables lambda xs cs : list R.
Variable values : list (option slope).
Hypothesis enclosed_at : forall i, encloses bits lambda xs cs [] (nth i values None) (formula_at tape i).

Lemma entry_exists : forall i s, nth i values None = Some s -> exists e, entry_in bits s e /\
  value cs [] (formula_at tape i) = fst e /\ value xs [] (formula_at tape i) = at_lambda lambda e.
Proof.
  intros i s h. pose proof (enclosed_at i) as H. rewrite h in H. destruct H as [_ [_ [h1 [_ [u [h3 h4]]]]]].
  exists (value cs [] (formula_at tape i), u). split; [split; assumption |]. split; [reflexivity |].
  unfold at_lambda. cbn [fst snd]. lra.
Qed.

Lemma definite_at_sound : forall vertices, definite_at values vertices = true -> exists d a b c : entry,
  matrix (map (value cs []) entries) = upper (fst d) (fst a) (fst b) (fst c) /\
  matrix (map (value xs []) entries)
    = upper (at_lambda lambda d) (at_lambda lambda a) (at_lambda lambda b) (at_lambda lambda c) /\
  forall at_ l, In at_ vertices -> (forall s e, entry_in bits s e -> contains (at_ s) (at_lambda l e)) ->
    forall v, length v = 3%nat -> nonzero v ->
      0 < quad (upper (at_lambda l d) (at_lambda l a) (at_lambda l b) (at_lambda l c)) v.
Proof.
  intros vertices h. unfold definite_at in h. rewrite <- represented.
  destruct places as [| i1 [| i2 [| i3 [| i4 [| ? ?]]]]]; cbn [map] in *; try discriminate;
    repeat match goal with H : match nth ?i values None with _ => _ end = true |- _ =>
      let e := fresh "e" in destruct (nth i values None) eqn:e; [| discriminate H] end; try discriminate.
  destruct (entry_exists _ _ e) as [d [hd [d1 d2]]]. destruct (entry_exists _ _ e0) as [a [ha [a1 a2]]].
  destruct (entry_exists _ _ e1) as [b [hb [b1 b2]]]. destruct (entry_exists _ _ e2) as [c [hc [c1 c2]]].
  exists d, a, b, c. cbn [matrix]. rewrite d1, d2, a1, a2, b1, b2, c1, c2. split; [reflexivity |]. split; [reflexivity |].
  intros at_ l i H v lv nz. rewrite forallb_forall in h. specialize (h at_ i).
  eapply (is_positive_definite_sound bits); [exact h | | exact lv | exact nz].
  unfold upper. unfold triangle_in. pairwise; apply H; assumption.
Qed.
End Values.

Lemma nonzero_or : forall x y z, nonzero [x; y; z] \/ forall S, quad S [x; y; z] = 0.
Proof.
  intros. destruct (Rlt_le_dec 0 (dot [x; y; z] [x; y; z])) as [p | n]; [left; exact p | right; intro S].
  apply quad_zero, zero_vector, n.
Qed.

(** **Definite.** *)
Lemma definite_sound : forall cell y z kappa, shows cell ByTest = true -> Forall2 contains cell [y; z; kappa] ->
  nonnegative (F_at y z kappa).
Proof.
  intros cell y z kappa h hx a b c. destruct cell as [| ? [| ? [| ? [| ? ?]]]]; try discriminate. cbn [shows] in h.
  rewrite <- entries_value. set (cell := [f0; f1; f2]) in *.
  destruct (coords_from_hold bits cell _ hx) as [lambda [el [hlam [_ C]]]]. specialize (C []). cbn [app length] in C.
  pose proof (evaluate_sound bits lambda hlam [y; z; kappa] (map (centre_of bits) cell) [] _ _ C
    (params_hold bits lambda [] [] (Forall2_nil _)) tape) as E.
  destruct (definite_at_sound lambda [y; z; kappa] (map (centre_of bits) cell) _
    (nth_related _ _ None (integer 0) (encloses bits lambda [y; z; kappa] (map (centre_of bits) cell) []) I _ _ E) _ h)
    as [e0 [e1 [e2 [e3 [_ [-> H]]]]]].
  destruct (nonzero_or a b c) as [nz | ->]; [apply Rlt_le | lra].
  apply (vertices_decide lambda
    (fun l => quad (upper (at_lambda l e0) (at_lambda l e1) (at_lambda l e2) (at_lambda l e3)) [a; b; c]) hlam).
  - intros before t after. rewrite !(at_lambda_affine before t after), !upper_form. field.
  - intros s ls. apply (H (at_vertex s)); [| intros; apply at_vertex_sound; assumption | reflexivity | exact nz].
    apply in_map. replace 3%nat with (length s) by (rewrite ls, el; reflexivity). apply signs_all.
Qed.

Lemma part_of : forall r h, 0 <= r <= h -> exists s, 0 <= s <= 1 /\ r = h * s.
Proof.
  intros r h b. destruct (Req_dec h 0) as [-> | n]; [exists 0; lra |]. exists (r / h).
  assert (E : r / h * h = r) by (field; exact n).
  split; [split; apply Rmult_le_reg_r with h; lra | lra].
Qed.

(** The coordinate from the corner. *)
Lemma edge_sound : forall a u, contains a u -> 0 <= u <= 1 -> exists h s, 0 <= s <= 1 /\ u - corner_u = h * s /\
  contains (sub (match f with Q1 => upper_end a | Q2 => lower_end a end) (Fixed.integer bits (match f with Q1 => 0 | Q2 => 1 end))) h.
Proof.
  intros a u hu b. unfold corner_u. destruct f.
  - destruct (upper_end_sound bits a u hu) as [h [hh le]]. destruct (part_of u h ltac:(lra)) as [s [hs e]].
    exists (h - 0), s. split; [exact hs |]. split; [lra |]. apply sub_sound; [exact hh | apply integer_sound].
  - destruct (lower_end_sound bits a u hu) as [h [hh le]]. destruct (part_of (1 - u) (1 - h) ltac:(lra)) as [s [hs e]].
    exists (h - 1), s. split; [exact hs |]. split; [lra |]. apply sub_sound; [exact hh | apply integer_sound].
Qed.

(** **Tight edge.** *)
Lemma tight_edge_sound : forall iy iz ik g y z kappa, shows [iy; iz; ik] (ByCorner g) = true ->
  contains iy y -> contains iz z -> contains ik kappa -> 0 <= y <= 1 -> 0 <= z <= 1 -> in_half kappa ->
  nonnegative (F_at y z kappa).
Proof.
  intros iy iz ik g y z kappa h hy hz hk by' bz hh a b c. cbn [shows] in h.
  assert (h' : definite_at (run (option slope) None (slope_op bits (about iy iz ik) []) tape)
    (map about_corner [[true; false]; [false; true]; [true; true]]) = true) by (destruct f, g; try discriminate; exact h).
  clear h. destruct (edge_sound iy y hy by') as [h1 [s [hs [es c1]]]].
  destruct (edge_sound iz z hz bz) as [h2 [t [ht [et c2]]]].
  assert (hc : contains (Fixed.integer bits (match f with Q1 => 0 | Q2 => 1 end)) corner_u)
    by (unfold corner_u; destruct f; apply integer_sound).
  set (lambda := [s; t; 0]). set (cs := [corner_u; corner_u; kappa]).
  assert (hl : Forall (fun t => -1 <= t <= 1) lambda)
    by (unfold lambda; repeat first [apply Forall_nil | apply Forall_cons]; lra).
  assert (C : forall k, Slope.holds bits lambda (nth k (about iy iz ik) (constant zero)) (nth k cs 0) (nth k [y; z; kappa] 0)).
  { assert (N : Slope.holds bits lambda (constant zero) 0 0) by (apply constant_holds, zero_sound).
    intros [| [| [| [| k]]]]; try exact N; unfold about, cs; cbn [nth].
    - split; [exact hc |]. split; [exact hy |]. exists [h1]. split; [pairwise; exact c1 |]. cbn. lra.
    - split; [exact hc |]. split; [exact hz |]. exists [0; h2].
      split; [pairwise; [apply zero_sound | exact c2] |]. cbn. lra.
    - apply constant_holds, hk. }
  assert (P : forall k, Slope.holds bits lambda (nth k [] (constant zero)) (nth k [] 0) (nth k [] 0))
    by exact (params_hold bits lambda [] [] (Forall2_nil _)).
  pose proof (evaluate_sound bits lambda hl [y; z; kappa] cs [] _ _ C P tape) as E.
  destruct (definite_at_sound lambda [y; z; kappa] cs _
    (nth_related _ _ None (integer 0) (encloses bits lambda [y; z; kappa] cs []) I _ _ E) _ h') as [e0 [e1 [e2 [e3 [K [L H]]]]]].
  rewrite <- entries_value, L. destruct (nonzero_or a b c) as [nz | ->]; [| lra].
  pose proof (corner_nonnegative kappa hh a b c) as O. rewrite <- entries_value in O. fold cs in O. rewrite K in O.
  assert (V : forall p q, In [p; q] [[true; false]; [false; true]; [true; true]] ->
    0 < quad (upper (at_lambda [if p then 1 else 0; if q then 1 else 0] e0) (at_lambda [if p then 1 else 0; if q then 1 else 0] e1)
      (at_lambda [if p then 1 else 0; if q then 1 else 0] e2) (at_lambda [if p then 1 else 0; if q then 1 else 0] e3)) [a; b; c]).
  { intros p q i. apply (H (about_corner [p; q])); [apply in_map; exact i | | reflexivity | exact nz].
    intros. apply (about_corner_sound [p; q]). assumption. }
  pose proof (V true false ltac:(cbn; tauto)) as V1. pose proof (V false true ltac:(cbn; tauto)) as V2.
  pose proof (V true true ltac:(cbn; tauto)) as V3. clear V H K L.
  assert (A : forall u v w e, at_lambda [u; v; w] e = fst e + u * nth 0 (snd e) 0 + v * nth 1 (snd e) 0 + w * nth 2 (snd e) 0)
    by (intros u v w [e [| n [| m [| k l]]]]; unfold at_lambda; cbn; try destruct l; cbn; ring).
  assert (B : forall u v e, at_lambda [u; v] e = fst e + u * nth 0 (snd e) 0 + v * nth 1 (snd e) 0)
    by (intros u v [e [| n [| m l]]]; unfold at_lambda; cbn; try destruct l; cbn; ring).
  unfold lambda. rewrite !A. rewrite !B in V1, V2, V3. rewrite !upper_form in *.
  destruct (Rle_dec s t).
  - match type of O with 0 <= ?o => match type of V2 with 0 < ?v => match type of V3 with 0 < ?w =>
      assert (0 <= (1 - t) * o + (t - s) * v + s * w)
        by (assert (0 <= (1 - t) * o) by (apply Rmult_le_pos; lra); assert (0 <= (t - s) * v) by (apply Rmult_le_pos; lra);
            assert (0 <= s * w) by (apply Rmult_le_pos; lra); lra) end end end. lra.
  - match type of O with 0 <= ?o => match type of V1 with 0 < ?v => match type of V3 with 0 < ?w =>
      assert (0 <= (1 - s) * o + (s - t) * v + t * w)
        by (assert (0 <= (1 - s) * o) by (apply Rmult_le_pos; lra); assert (0 <= (s - t) * v) by (apply Rmult_le_pos; lra);
            assert (0 <= t * w) by (apply Rmult_le_pos; lra); lra) end end end. lra.
Qed.

(** ** The tree of a part

    Points with u_y <= u_z are followed; the others are their mirror images.
    At a split of y the midpoint goes to the lower half, at a split of z to the
    upper: so a followed point never ends in a cell with u_y >= u_z throughout,
    and such a cell needs no proof. *)

Definition steps_on (cell : list fixed) (steps : list (nat * evidence)) (open : bool) : option bool :=
  match steps, open with
  | [], _ => Some open
  | [(O, e)], true => if shows cell e then Some false else None
  | _, _ => None
  end.

Fixpoint check (cell : list fixed) (open : bool) (t : tree) : bool :=
  match t with
  | Leaf steps => match steps_on cell steps open with Some last => negb last | None => false end
  | Split steps k lower upper =>
      match steps_on cell steps open with
      | Some last => let (a, b) := halves k cell in if check a last lower then check b last upper else false
      | None => false
      end
  | Parts _ _ _ _ => false
  end.

Definition in_y (e : fixed) (u : R) : Prop := contains e u /\ (lo e = 0%Z \/ IZR (lo e) < u * unit_R bits).
Definition in_z (e : fixed) (u : R) : Prop := contains e u /\ (hi e = unit_Z bits \/ u * unit_R bits < IZR (hi e)).

Variables y z kappa : R.
Hypothesis y_in : 0 <= y <= 1.
Hypothesis z_in : 0 <= z <= 1.
Hypothesis kappa_in : in_half kappa.
Hypothesis followed : y <= z.

Lemma shows_sound : forall e iy iz ik, shows [iy; iz; ik] e = true -> in_y iy y -> in_z iz z -> contains ik kappa ->
  nonnegative (F_at y z kappa).
Proof.
  intros e iy iz ik h hy hz hk. destruct e; try discriminate.
  - apply (definite_sound [iy; iz; ik]); [exact h |]. pairwise; [apply hy | apply hz | exact hk].
  - eapply tight_edge_sound; try eassumption; [apply hy | apply hz].
  - exfalso. cbn [shows] in h. apply Z.leb_le in h. pose proof (unit_R_pos bits) as u. destruct hy as [hy [y0 | y0]], hz as [hz [z1 | z1]].
    + rewrite y0, z1 in h. pose proof (unit_Z_pos bits). lia.
    + rewrite y0 in h. apply IZR_le in h. assert (0 <= z * unit_R bits) by (apply Rmult_le_pos; lra). lra.
    + rewrite z1 in h. apply IZR_le in h. fold (unit_R bits) in h.
      assert (y * unit_R bits <= 1 * unit_R bits) by (apply Rmult_le_compat_r; lra). lra.
    + apply IZR_le in h. assert (y * unit_R bits <= z * unit_R bits) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Theorem check_sound : forall t iy iz ik open, check [iy; iz; ik] open t = true ->
  in_y iy y -> in_z iz z -> contains ik kappa -> (open = false -> nonnegative (F_at y z kappa)) ->
  nonnegative (F_at y z kappa).
Proof.
  assert (S : forall steps iy iz ik open last, steps_on [iy; iz; ik] steps open = Some last ->
    in_y iy y -> in_z iz z -> contains ik kappa -> (open = false -> nonnegative (F_at y z kappa)) ->
    last = false -> nonnegative (F_at y z kappa)).
  { intros [| [[| n] e] [| ? ?]] iy iz ik [|] last h hy hz hk ho hl; cbn [steps_on] in h; try discriminate;
      try (apply ho; congruence).
    destruct (shows [iy; iz; ik] e) eqn:s; [| discriminate]. exact (shows_sound _ _ _ _ s hy hz hk). }
  induction t as [steps | steps k lower IHl upper IHu | steps k lower IHl upper IHu]; intros iy iz ik open h hy hz hk ho; cbn [check] in h; try discriminate h;
    destruct (steps_on [iy; iz; ik] steps open) as [last |] eqn:s; try discriminate;
    pose proof (S _ _ _ _ _ _ s hy hz hk ho) as D; [apply D; destruct last; [discriminate | reflexivity] |].
  assert (H : exists a b, halves k [iy; iz; ik] = (a, b) /\ check a last lower = true /\ check b last upper = true).
  { destruct (halves k [iy; iz; ik]) as [a b]. exists a, b. destruct (check a last lower); [auto | discriminate]. }
  destruct H as [a [b [e [ha hb]]]]. destruct k as [| [| [| [| k]]]]; cbn [halves] in e; injection e as <- <-.
  - destruct hy as [[l r] o]. destruct (Rle_dec (y * unit_R bits) (IZR (midpoint iy))) as [c | c].
    + apply (IHl _ _ _ _ ha); auto. split; [split; assumption | exact o].
    + apply (IHu _ _ _ _ hb); auto. split; [split; [apply Rlt_le, Rnot_le_lt, c | exact r] | right; apply Rnot_le_lt, c].
  - destruct hz as [[l r] o]. destruct (Rlt_dec (z * unit_R bits) (IZR (midpoint iz))) as [c | c].
    + apply (IHl _ _ _ _ ha); auto. split; [split; [exact l | apply Rlt_le, c] | right; exact c].
    + apply (IHu _ _ _ _ hb); auto. split; [split; [apply Rnot_lt_le, c | exact r] | exact o].
  - destruct hk as [l r]. destruct (Rle_dec (kappa * unit_R bits) (IZR (midpoint ik))) as [c | c].
    + apply (IHl _ _ _ _ ha); auto. split; assumption.
    + apply (IHu _ _ _ _ hb); auto. split; [apply Rlt_le, Rnot_le_lt, c | exact r].
  - apply (IHl _ _ _ _ ha); auto.
  - apply (IHl _ _ _ _ ha); auto.
Qed.
End Precision.
End Part.

(** ** The trees of all parts *)

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).

Definition half_unit : Z := 2 ^ (Zpos bits - 1).

Definition check_part (f : face) (low : bool) (kappa : fixed) (t : tree) : bool :=
  let tape := compile (entries f low) in let places := map (place (formulas tape)) (entries f low) in
  let whole := Fixed 0 (unit_Z bits) in check f bits tape places [whole; whole; kappa] true t.

(** For kappa from least / 2^bits: both faces, up to 1/2 and from there, as far as there are any. *)
Definition check_from (least : Z) (trees : list tree) : bool :=
  match (least <? half_unit)%Z, trees with
  | true, [a; b; c; d] =>
      let below := Fixed least half_unit in let above := Fixed half_unit (unit_Z bits) in
      check_part Q1 true below a && check_part Q1 false above b && (check_part Q2 true below c && check_part Q2 false above d)
  | false, [b; d] => let all := Fixed least (unit_Z bits) in check_part Q1 false all b && check_part Q2 false all d
  | _, _ => false
  end.

(** Every psi > 1. *)
Definition check_postulate (trees : list tree) : bool := check_from 0 trees.

(** Every psi from 1 to a greatest one, which is more than 1. *)
Definition check_postulate_up_to (greatest : number) (trees : list tree) : bool :=
  match enclose_scaled bits 0 greatest, enclose_scaled bits 0 (Over (1 // 1) greatest) with
  | Some g, Some k => (unit_Z bits <? lo g)%Z && check_from (lo k) trees
  | _, _ => false
  end.

Lemma half_unit_value : IZR half_unit = unit_R bits / 2.
Proof.
  unfold half_unit, unit_R, unit_Z. replace (2 ^ Z.pos bits)%Z with (2 * 2 ^ (Z.pos bits - 1))%Z.
  - rewrite mult_IZR. field.
  - rewrite <- Z.pow_succ_r by lia. f_equal. lia.
Qed.

Lemma compiled : forall f low, map (formula_at (compile (entries f low))) (map (place (formulas (compile (entries f low)))) (entries f low)) = entries f low.
Proof. intros [|] [|]; vm_compute; reflexivity. Qed.

Lemma check_part_sound : forall f low ik t y z kappa, check_part f low ik t = true -> contains ik kappa -> in_half low kappa ->
  0 <= y <= 1 -> 0 <= z <= 1 -> nonnegative (F_at f low y z kappa).
Proof.
  intros f low ik t y z kappa h hk hh by' bz. unfold check_part in h. pose proof (compiled f low) as C.
  cbn zeta in h. set (tape := compile (entries f low)) in *. set (places := map (place (formulas tape)) (entries f low)) in *. clearbody tape places. pose proof (unit_R_pos bits) as u.
  set (whole := Fixed 0 (unit_Z bits)) in *. cbn zeta in h.
  assert (Y : forall w, 0 <= w <= 1 -> in_y bits whole w /\ in_z bits whole w).
  { intros w b. assert (contains whole w) by (split; cbn [whole lo hi]; fold (unit_R bits); nra).
    split; (split; [assumption | left; reflexivity]). }
  destruct (Rle_dec y z) as [c | c]; [| apply mirrored];
    eapply (check_sound f low bits tape places C); try exact h; try assumption; try (apply Y; assumption);
    try lra; discriminate.
Qed.

Lemma check_from_holds : forall least trees, check_from least trees = true ->
  forall f kappa y z, 0 < kappa < 1 -> IZR least <= kappa * unit_R bits -> 0 <= y <= 1 -> 0 <= z <= 1 ->
  exists low, in_half low kappa /\ nonnegative (F_at f low y z kappa).
Proof.
  intros least trees h f kappa y z k l by' bz. unfold check_from in h.
  pose proof (unit_R_pos bits) as u. pose proof half_unit_value as H. assert (U : kappa * unit_R bits <= unit_R bits) by nra.
  destruct (least <? half_unit)%Z eqn:s.
  - destruct trees as [| a [| b [| c [| d [| ? ?]]]]]; try discriminate. cbn zeta in h.
    apply andb_true_iff in h as [h1 h2]. apply andb_true_iff in h1 as [h1 h1'], h2 as [h2 h2'].
    destruct (Rle_dec kappa (1 / 2)) as [c' | c'].
    + exists true. split; [exact c' |]. assert (contains (Fixed least half_unit) kappa) by (split; cbn [lo hi]; [| rewrite H]; nra).
      destruct f; eapply check_part_sound; eassumption.
    + exists false. split; [cbn; lra |].
      assert (contains (Fixed half_unit (unit_Z bits)) kappa) by (split; cbn [lo hi]; [rewrite H; nra | exact U]).
      destruct f; (eapply check_part_sound; [eassumption .. | cbn; lra | |]; assumption).
  - destruct trees as [| b [| d [| ? ?]]]; try discriminate. cbn zeta in h. apply andb_true_iff in h as [h1 h2].
    apply Z.ltb_ge, IZR_le in s. rewrite H in s.
    assert (hh : in_half false kappa) by (cbn; nra). exists false. split; [exact hh |].
    assert (contains (Fixed least (unit_Z bits)) kappa) by (split; [exact l | exact U]).
    destruct f; eapply check_part_sound; eassumption.
Qed.
End Precision.

(** ** From F to the machine *)

Lemma s_unit_corner : forall t a b, 0 < t ->
  s_unit (position_of_entry t * a) (position_of_entry t * b) = S_of (t ^ 2) a b / sqrt (1 + 2 * t ^ 2).
Proof.
  intros t a b ht. destruct (position_on_diagonal t ht) as [_ [_ e]]. set (c := position_of_entry t) in *.
  assert (n : 0 < 1 + 2 * t ^ 2) by nra. unfold s_unit, S_of. rewrite <- sqrt_div_alt by exact n. f_equal.
  assert (E : c ^ 2 = t ^ 2 / (1 + 2 * t ^ 2)).
  { apply Rmult_eq_reg_r with (1 + 2 * t ^ 2); [rewrite e; field; lra | lra]. }
  rewrite !Rpow_mult_distr, E. field. lra.
Qed.

Lemma entry_corner : forall t a S, 0 < t -> position_of_entry t * a / (S / sqrt (1 + 2 * t ^ 2)) = t * (a * / S).
Proof.
  intros t a S ht. unfold position_of_entry. assert (n : 0 < sqrt (1 + 2 * t ^ 2)) by (apply sqrt_lt_R0; nra).
  set (N := sqrt (1 + 2 * t ^ 2)) in *. unfold Rdiv. rewrite Rinv_mult, Rinv_inv.
  generalize (/ S). intro i. field. lra.
Qed.

Lemma lower_form_of : forall kappa t i j k, 0 < t -> nonnegative (F_of (2 * (1 - kappa) / t) (t ^ 2) i j k) ->
  let c := position_of_entry t in lower_form_at kappa (Vec (c * i) (c * j) (c * k)).
Proof.
  intros kappa t i j k ht h c [x y z]. specialize (h x y z). unfold F_of in h. rewrite upper_form in h. unfold c.
  unfold M, mulv, Vec3.dot, norm2. cbn [vx vy vz row1 row2 row3].
  rewrite !s_unit_corner by assumption. rewrite !entry_corner by assumption.
  rewrite (S_sym (t ^ 2) k i) in h. unfold Rdiv in h.
  generalize dependent (/ S_of (t ^ 2) j k). generalize dependent (/ S_of (t ^ 2) i k).
  generalize dependent (/ S_of (t ^ 2) i j). intros i3 i2 i1 h.
  apply Rmult_le_compat_l with (r := t / 2) in h; [| lra]. rewrite Rmult_0_r in h.
  match type of h with 0 <= ?e => assert (E : e = (1 - kappa) * (x ^ 2 + y ^ 2 + z ^ 2)
    + t * ((j * i1 + i * i2) * (x * y) + (k * i1 + i * i3) * (x * z) + (k * i2 + j * i3) * (y * z)))
    by (field; lra) end.
  rewrite E in h. lra.
Qed.

(** ** The constants of a face *)

Definition corner_t (f : face) (kappa : R) : R := match f with Q1 => t_1 kappa | Q2 => t_2 kappa end.
Definition corner_c (f : face) (kappa : R) : R := position_of_entry (corner_t f kappa).

Section Constants.
Variables (low : bool) (kappa : R).
Hypothesis k : 0 < kappa < 1.
Hypothesis hh : in_half low kappa.

Lemma t_of_corner : forall f, t_of f low kappa = corner_t f kappa.
Proof.
  intros [|]; cbn [t_of corner_t]; unfold t_1, t_2; [lra |].
  destruct low; cbn [in_half] in hh; destruct (Rle_dec kappa (1/2)) as [l | l]; try lra.
  - replace kappa with (1/2) by lra. field.
  - field. lra.
Qed.

Lemma corner_t_pos : forall f, 0 < corner_t f kappa.
Proof. destruct (t_facts kappa k) as [T1 [T2 _]]. intros [|]; cbn [corner_t]; lra. Qed.

Lemma corner_c_pos : forall f, 0 < corner_c f kappa.
Proof. intro f. apply (position_on_diagonal (corner_t f kappa)), corner_t_pos. Qed.

Lemma d_of_corner : forall f, d_of f low kappa = 2 * (1 - kappa) / corner_t f kappa.
Proof. intro f. rewrite <- t_of_corner. destruct f; cbn [d_of t_of]; [| destruct low]; field; lra. Qed.

(** |q_1| / q_2 *)
Lemma p_of_corner : p_of low kappa = corner_c Q1 kappa / corner_c Q2 kappa.
Proof.
  pose proof (corner_c_pos Q1) as P1. pose proof (corner_c_pos Q2) as P2.
  destruct (position_on_diagonal _ (corner_t_pos Q1)) as [_ [_ e1]].
  destruct (position_on_diagonal _ (corner_t_pos Q2)) as [_ [_ e2]].
  fold (corner_c Q1 kappa) in e1. fold (corner_c Q2 kappa) in e2. rewrite <- t_of_corner in e1, e2.
  set (c1 := corner_c Q1 kappa) in *. set (c2 := corner_c Q2 kappa) in *. clearbody c1 c2.
  assert (PP : 0 < c1 / c2) by (apply Rdiv_lt_0_compat; assumption).
  rewrite <- (sqrt_pow2 (c1 / c2)) by lra. unfold p_of. f_equal.
  assert (N : forall t, 0 < 1 + 2 * t ^ 2) by (intro; nra).
  assert (E : forall c t, c ^ 2 * (1 + 2 * t ^ 2) = t ^ 2 -> c ^ 2 = t ^ 2 / (1 + 2 * t ^ 2)).
  { intros c t e. pose proof (N t). apply Rmult_eq_reg_r with (1 + 2 * t ^ 2); [rewrite e; field; lra | lra]. }
  replace ((c1 / c2) ^ 2) with (c1 ^ 2 / c2 ^ 2) by (field; lra). rewrite (E _ _ e1), (E _ _ e2). clear E e1 e2.
  pose proof (N (t_of Q1 low kappa)) as n1. pose proof (N (t_of Q2 low kappa)) as n2. clear N hh.
  assert (0 < 2 + (1 - kappa) ^ 2) by nra. assert (0 < 4 + 2 * (1 - kappa) ^ 2) by nra.
  cbn [t_of] in *. destruct low; field; repeat split; try nra; try lra.
Qed.
End Constants.

(** Every coordinate of the cube, on the face's own scale. *)
Lemma coordinate_of : forall f low kappa w, 0 < kappa < 1 -> in_half low kappa -> q1_unit kappa <= w <= q2_unit kappa ->
  exists u, 0 <= u <= 1 /\ w = corner_c f kappa * eta_of f low kappa u.
Proof.
  intros f low kappa w k hh b. pose proof (corner_c_pos kappa k Q1) as P1. pose proof (corner_c_pos kappa k Q2) as P2.
  change (q1_unit kappa) with (- corner_c Q1 kappa) in b. change (q2_unit kappa) with (corner_c Q2 kappa) in b.
  unfold eta_of. rewrite (p_of_corner low kappa k hh). set (c := corner_c Q1 kappa) in *. set (c' := corner_c Q2 kappa) in *.
  exists ((w + c) / (c + c')). assert (E : (w + c) / (c + c') * (c + c') = w + c) by (field; lra).
  split; [split; apply Rmult_le_reg_r with (c + c'); lra |]. destruct f; fold c c'; field; lra.
Qed.

(** Trees for kappa from least / 2^bits prove the postulate for every psi with 1/psi in that range. *)
Lemma check_from_sound : forall bits least trees, check_from bits least trees = true ->
  forall L a e, 0 < L -> forall psi, 1 < psi -> IZR least <= 1 / psi * unit_R bits -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros bits least trees h L a e hL psi hpsi from P hP. pose proof (unit_R_pos bits) as u.
  destruct (kappa_range psi hpsi) as [k _].
  assert (reach : reachable_unit (vscale (/ L) P)) by (eapply cube_reachable; eassumption).
  apply transmission_from_M; [exact hL | exact hpsi | exact reach | |].
  - apply symmetric_part_identity; [lra |].
    assert (box : in_W (1 / psi) (vscale (/ L) P)) by (apply (cube_scaled L hL psi); exact hP).
    generalize dependent (vscale (/ L) P). intros p _ box.
    apply (two_faces_suffice (1 / psi) k); [| exact box]. clear p box.
    intros kappa [x y z] b [hx [hy hz]] on. cbn [vx vy vz] in *.
    assert (k' : 0 < kappa < 1) by lra.
    assert (l : IZR least <= kappa * unit_R bits) by (apply Rle_trans with (1 := from), Rmult_le_compat_r; lra).
    assert (G : forall f, x = corner_c f kappa * x_of f -> lower_form_at kappa (Vec x y z)).
    { intros f ->. destruct (check_from_holds bits least trees h f kappa 0 0 k' l ltac:(lra) ltac:(lra)) as [low [hh _]].
      destruct (coordinate_of f low kappa y k' hh hy) as [uy [by' ey]]. destruct (coordinate_of f low kappa z k' hh hz) as [uz [bz ez]].
      destruct (check_from_holds bits least trees h f kappa uy uz k' l by' bz) as [low' [hh' N]].
      unfold F_at in N. rewrite (d_of_corner low' kappa k' hh'), (t_of_corner low' kappa k' hh') in N.
      pose proof (lower_form_of kappa _ _ _ _ (corner_t_pos kappa k' f) N) as R. cbn zeta in R.
      fold (corner_c f kappa) in R.
      assert (S : forall u, eta_of f low kappa u = eta_of f low' kappa u)
        by (intro; unfold eta_of; rewrite (p_of_corner low kappa k' hh), (p_of_corner low' kappa k' hh'); reflexivity).
      rewrite S in ey, ez. rewrite <- ey, <- ez in R. exact R. }
    unfold q1_unit, q2_unit in on. destruct on as [fx | fx]; [apply (G Q1) | apply (G Q2)]; rewrite fx;
      unfold corner_c, corner_t; cbn [x_of]; ring.
  - destruct (t_facts _ k) as [T1 [T2 _]].
    apply sigma_at_most_weaken with (1 + 2 * t_2 (1 / psi)).
    + pose proof (sum_below_psi psi hpsi). lra.
    + apply (cube_upper (position_of_entry (t_2 (1 / psi)))); [apply position_on_diagonal; lra |].
      apply (cube_inside L hL psi hpsi). exact hP.
Qed.

(** What the checker accepts proves the postulate, for every psi > 1. *)
Theorem check_postulate_sound : forall bits trees, check_postulate bits trees = true ->
  forall L a e, 0 < L -> forall psi, 1 < psi -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros bits trees h L a e hL psi hpsi. apply (check_from_sound bits _ _ h); [exact hL | exact hpsi |].
  pose proof (unit_R_pos bits). destruct (kappa_range psi hpsi). apply Rmult_le_pos; lra.
Qed.

Lemma greatest_checked : forall bits greatest trees, check_postulate_up_to bits greatest trees = true ->
  1 < Claim.value greatest /\
  exists least, IZR least <= 1 / Claim.value greatest * unit_R bits /\ check_from bits least trees = true.
Proof.
  intros bits greatest trees h. unfold check_postulate_up_to in h. pose proof (unit_R_pos bits) as u.
  destruct (enclose_scaled bits 0 greatest) as [g |] eqn:eg; [| discriminate].
  destruct (enclose_scaled bits 0 (Over (1 // 1) greatest)) as [k |] eqn:ek; [| discriminate].
  apply andb_true_iff in h as [h1 h2]. apply Z.ltb_lt, IZR_lt in h1. fold (unit_R bits) in h1.
  apply enclose_scaled_sound in eg as [l _], ek as [l' _]. cbn [Claim.value] in l'. change (two_to 0) with 1 in l, l'.
  unfold Rdiv in l, l'. rewrite Rinv_1, ?Rmult_1_r in l, l'. split.
  - apply Rmult_lt_reg_r with (unit_R bits); lra.
  - exists (lo k). split; [| exact h2]. unfold Rdiv. rewrite !Rmult_1_l in *. exact l'.
Qed.

(** The greatest psi is an admissible one. *)
Lemma check_postulate_greatest : forall bits greatest trees, check_postulate_up_to bits greatest trees = true ->
  1 < Claim.value greatest.
Proof. intros bits greatest trees h. apply (greatest_checked _ _ _ h). Qed.

(** The same for every psi up to a greatest one: smaller cubes need only the faces with kappa >= 1 / psi. *)
Theorem check_postulate_up_to_sound : forall bits greatest trees, check_postulate_up_to bits greatest trees = true ->
  forall L a e, 0 < L -> forall psi, 1 < psi <= Claim.value greatest -> forall P, in_cube L psi P ->
  regular (orthoglide L a e) P /\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
Proof.
  intros bits greatest trees h L a e hL psi [hpsi le]. destruct (greatest_checked _ _ _ h) as [g [least [l c]]].
  apply (check_from_sound bits _ _ c); [exact hL | exact hpsi |]. apply Rle_trans with (1 := l).
  apply Rmult_le_compat_r; [apply Rlt_le, unit_R_pos |]. unfold Rdiv. rewrite !Rmult_1_l.
  apply Rinv_le_contravar; lra.
Qed.
