(** * Changes of a row, and of a multiple of |v|^2 with it

    Where what |M v|^2 is compared with differs from one machine to another, tolerances change a row
    and a multiple nu of |v|^2 by the same shares.  Of e s^T + s e^T + nu J, where J is the identity
    but for first entries that may be 0, nu J is as good as a change of s along one direction w, and
    nothing of it is lost there ([along_kept]); or it is kept, and less nu d d^T makes up for what
    e s^T + s e^T takes off across a second direction d ([across_bound]). *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope Definite Test Tolerances.
From Orthocert.kernel Require Solve Second Toward.
Import ListNotations.
Local Open Scope R_scope.

(** ** Vectors without their first entries *)

Section Masked.
Context {A : Type} (none : A).
Fixpoint masked (first : nat) (v : list A) : list A :=
  match first, v with O, _ => v | _, [] => [] | S f, _ :: r => none :: masked f r end.
End Masked.

Local Notation mask := (masked 0).
(** J v . v *)
Definition norm_from (first : nat) (v : list R) : R := dot (mask first v) (mask first v).

Lemma mask_comb : forall f a b u v, mask f (comb a b u v) = comb a b (mask f u) (mask f v).
Proof.
  assert (M : forall f a v, mask f (map (Rmult a) v) = map (Rmult a) (mask f v)).
  { induction f as [| f IH]; intros a [| t v]; cbn [masked map]; try reflexivity. rewrite IH. f_equal. ring. }
  assert (C : forall a b v, comb a b [] v = map (Rmult b) v) by reflexivity. assert (D : forall a b u, comb a b u [] = map (Rmult a) u) by (intros a b [| x u]; reflexivity).
  induction f as [| f IH]; intros a b [| x u] [| y v]; try reflexivity; cbn [masked].
  - rewrite !C. exact (M (S f) b (y :: v)).
  - rewrite !D. exact (M (S f) a (x :: u)).
  - change (0 :: mask f (comb a b u v) = a * 0 + b * 0 :: comb a b (mask f u) (mask f v)). rewrite IH. f_equal. ring.
Qed.
Lemma dot_mask : forall f u v, dot (mask f u) v = dot (mask f u) (mask f v).
Proof. induction f as [| f IH]; intros [| x u] [| y v]; cbn [masked dot]; try reflexivity. rewrite IH. ring. Qed.
Lemma norm_from_nonneg : forall f v, 0 <= norm_from f v.
Proof. intros. apply dot_self. Qed.

(** e s^T + s e^T + nu J = e (s + nu z)^T + (s + nu z) e^T + nu K, with K >= 0 *)
Definition z_of (first : nat) (w e : list R) : list R := comb 1 (- (norm_from first w / 2 * / dot e w * / dot e w)) (map (Rmult (/ dot e w)) (mask first w)) e.
Lemma along_kept : forall f w e v, dot e w <> 0 -> 2 * dot e v * dot (z_of f w e) v <= norm_from f v.
Proof.
  intros f w e v n. pose proof (norm_from_nonneg f (comb 1 (- (dot e v * / dot e w)) v w)) as K. unfold norm_from in K at 1.
  rewrite mask_comb, dot_comb, !(Solve.dot_commutes _ (comb _ _ _ _)), !dot_comb, (Solve.dot_commutes (mask f v) (mask f w)) in K. fold (norm_from f v) (norm_from f w) in K.
  unfold z_of. rewrite dot_comb, dot_map, dot_mask. set (q := dot (mask f w) (mask f v)) in *.
  replace (2 * dot e v * (1 * (/ dot e w * q) + - (norm_from f w / 2 * / dot e w * / dot e w) * dot e v)) with
    (2 * (dot e v * / dot e w) * q - (dot e v * / dot e w) ^ 2 * norm_from f w) by (field; exact n). lra.
Qed.

Lemma cauchy : forall u v, dot u v ^ 2 <= dot u u * dot v v.
Proof.
  intros u v. destruct (Rle_lt_dec (dot u u) 0) as [z | p].
  - rewrite Solve.dot_commutes, (dot_zero u v (zero_vector u z)). pose proof (dot_self u). pose proof (dot_self v). nra.
  - pose proof (dot_self (comb (dot u u) (- dot u v) v u)) as K. rewrite dot_comb, !(Solve.dot_commutes _ (comb _ _ _ _)), !dot_comb, (Solve.dot_commutes v u) in K.
    apply Rmult_le_reg_l with (dot u u); [exact p |]. set (a := dot u u) in *. set (b := dot u v) in *. set (c := dot v v) in *. nra.
Qed.
Lemma across_bound : forall p d v a, let b := comb 1 (- a) p d in dot p v ^ 2 <= (dot b b + a ^ 2) * (dot v v + dot d v ^ 2).
Proof.
  intros p d v a b. pose proof (cauchy (a :: b) (dot d v :: v)) as C. cbn [dot] in C.
  assert (E : a * dot d v + dot b v = dot p v) by (unfold b; rewrite dot_comb; ring). rewrite E in C.
  replace (dot b b + a ^ 2) with (a * a + dot b b) by ring. replace (dot v v + dot d v ^ 2) with (dot d v * dot d v + dot v v) by ring. exact C.
Qed.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation one := (one bits).
Local Notation triangle_in := (triangle_in bits).

(** ** Entries *)

Definition norm (v : list fixed) : fixed := fold_right (fun a s => add (sqr bits a) s) zero v.
Lemma norm_sound : forall v V, Forall2 contains v V -> contains (norm v) (dot V V).
Proof.
  induction 1 as [| a x v V h _ IH]; cbn [norm fold_right dot]; [apply zero_sound |]. apply add_sound; [| exact IH]. replace (x * x) with (x ^ 2) by ring. apply sqr_sound, h.
Qed.
Lemma masked_sound : forall f v V, Forall2 contains v V -> Forall2 contains (masked zero f v) (mask f V).
Proof. induction f as [| f IH]; intros v V h; [destruct h; constructor; assumption |]. destruct h; cbn [masked]; constructor; auto using zero_sound. Qed.
Definition combined (k : fixed) (u v : list fixed) : list fixed := merge (fun a => a) (mul bits k) (fun a b => add a (mul bits k b)) u v.
Lemma combined_sound : forall k K u U v V, contains k K -> Forall2 contains u U -> Forall2 contains v V -> Forall2 contains (combined k u v) (comb 1 K U V).
Proof.
  intros k K u U v V hk hu hv. eapply merge_related; try eassumption.
  - intros a x h. rewrite Rmult_1_l. exact h.
  - intros a x h. apply mul_sound; assumption.
  - intros a x b y h h'. rewrite Rmult_1_l. apply add_sound; [| apply mul_sound]; assumption.
Qed.
(** u - k v *)
Definition less_multiple (k : fixed) (u v : list fixed) : list fixed := merge (fun a => a) (fun b => neg (mul bits k b)) (fun a b => sub a (mul bits k b)) u v.
Lemma less_multiple_sound : forall k K u U v V, contains k K -> Forall2 contains u U -> Forall2 contains v V -> Forall2 contains (less_multiple k u v) (comb 1 (- K) U V).
Proof.
  intros k K u U v V hk hu hv. eapply merge_related; try eassumption.
  - intros a x h. rewrite Rmult_1_l. exact h.
  - intros a x h. replace (- K * x) with (- (K * x)) by ring. apply neg_sound, mul_sound; assumption.
  - intros a x b y h h'. replace (1 * x + - K * y) with (x - K * y) by ring. apply sub_sound; [| apply mul_sound]; assumption.
Qed.

(** e z^T + z e^T *)
Fixpoint both_of (y g : list fixed) : triangle :=
  match y, g with
  | y1 :: y', g1 :: g' => (let p := mul bits y1 g1 in add p p :: merge (mul bits y1) (mul bits g1) (fun a b => add (mul bits y1 a) (mul bits g1 b)) g' y') :: both_of y' g'
  | _, _ => []
  end.
Lemma both_of_sound : forall y Y g G, Forall2 contains y Y -> Forall2 contains g G -> triangle_in (both_of y g) (outer Y G).
Proof.
  intros y Y g G h. revert g G. induction h as [| a A y Y ha h IH]; intros g G k; [constructor |]. destruct k as [| b B g G hb k]; [constructor |].
  cbn [both_of outer]. constructor; [| apply IH; exact k]. cbv zeta. constructor.
  - replace (2 * A * B) with (A * B + A * B) by ring. apply add_sound; apply mul_sound; assumption.
  - eapply merge_related; try eassumption; intros; try (apply mul_sound; assumption). apply add_sound; apply mul_sound; assumption.
Qed.
(** nu (J - T) *)
Fixpoint kept_of (nu : fixed) (first : nat) (t : triangle) : triangle :=
  match t with
  | [] => []
  | row :: t' => match row with [] => [] | b :: bs => mul bits nu (sub match first with O => one | S _ => zero end b) :: map (fun b => mul bits nu (neg b)) bs end :: kept_of nu (pred first) t'
  end.
Fixpoint real_kept (nu : R) (first : nat) (T : list (list R)) : list (list R) :=
  match T with
  | [] => []
  | row :: T' => match row with [] => [] | b :: bs => nu * (match first with O => 1 | S _ => 0 end - b) :: map (fun b => nu * - b) bs end :: real_kept nu (pred first) T'
  end.
Lemma kept_of_sound : forall nu N f t T, contains nu N -> triangle_in t T -> triangle_in (kept_of nu f t) (real_kept N f T).
Proof.
  intros nu N f t T hn h. revert f. induction h as [| row r t T hr h IH]; intro f; [constructor |]. cbn [kept_of real_kept]. constructor; [| apply IH].
  destruct hr as [| b B row r hb hr]; [constructor |]. constructor.
  - apply mul_sound; [exact hn |]. apply sub_sound; [destruct f; [apply integer_sound | apply zero_sound] | exact hb].
  - eapply map_related; [| exact hr]. intros a x h'. apply mul_sound; [exact hn | apply neg_sound, h'].
Qed.
Lemma quad_kept : forall N T f v, length T = length v -> Forall (fun row => row <> []) T -> quad (real_kept N f T) v = N * (norm_from f v - quad T v).
Proof.
  intros N. induction T as [| row T IH]; intros f [| t v] l n; try discriminate; [unfold norm_from; destruct f; cbn; ring |].
  inversion n as [| ? ? n1 n2]; subst. destruct row as [| b bs]; [contradiction n1; reflexivity |]. cbn [real_kept quad row_form]. rewrite IH by (cbn in l; congruence || exact n2).
  assert (D : dot (map (fun b => N * - b) bs) v = - N * dot bs v) by (rewrite <- dot_map; f_equal; apply map_ext; intro; ring). rewrite D.
  assert (F : norm_from f (t :: v) = match f with O => 1 | S _ => 0 end * t ^ 2 + norm_from (pred f) v) by (unfold norm_from; destruct f; cbn [masked dot pred]; ring). rewrite F. ring.
Qed.
Lemma outer_rows : forall y g, Forall (fun row => row <> []) (outer y g).
Proof. induction y as [| a y IH]; intros [| b g]; cbn [outer]; constructor; [discriminate | apply IH]. Qed.

(** ** One change *)

(** Along w, where it is known that e . w is not 0. *)
Definition less_along (w : list fixed) (first : nat) (e s : list fixed) (nu : fixed) (t : triangle) : option triangle :=
  if (lo nu =? 0)%Z then less_change bits w e s t
  else
    let n := lower_end nu in
    let grown (kept : unit -> triangle) := if (0 <? lo nu)%Z then Some t else
      let k := kept tt in if Nat.eqb (length k) (length w) then Some (triangle_add t (kept_of n first k)) else None in
    let '(s, t) := match recip bits (along bits e w) with
      | Some h =>
          let j := masked zero first w in
          let z := less_multiple (mul bits (mul bits (halve (norm j)) h) h) (map (fun x => mul bits x h) j) e in
          (combined n s z, grown (fun _ => both_of e z))
      | None => (s, grown (fun _ => repeat [zero] (length w)))
      end in
    match t with Some t => less_change bits w e s t | None => None end.

Lemma less_along_sound : forall w W f e E s C nu N t t' S, less_along w f e s nu t = Some t' -> triangle_in t S ->
  Forall2 contains w W -> Forall2 contains e E -> Forall2 contains s C -> contains nu N ->
  exists S', triangle_in t' S' /\ forall m v, is_share m -> length v = length w -> quad S' v <= quad S v + m * (2 * dot E v * dot C v + N * norm_from f v).
Proof.
  intros w W f e E s C nu N t t' S h hS hw he hs hn. unfold less_along in h. cbv zeta in h. destruct (lower_end_sound bits nu N hn) as [n [hl le]].
  assert (J0 : forall v, 0 <= norm_from f v) by (intro; apply norm_from_nonneg). pose proof (unit_R_pos bits) as u0.
  assert (sign : n * unit_R bits = IZR (lo nu)) by (destruct hl as [h1 h2]; cbn [lower_end lo hi] in *; lra).
  destruct (Z.eqb_spec (lo nu) 0) as [z | nz].
  { destruct (less_change_sound bits _ _ _ _ _ _ _ _ h hS he hs) as [S' [h1 h2]]. exists S'. split; [exact h1 |]. intros m v hm _. specialize (h2 m v hm).
    rewrite z in sign. assert (n0 : n = 0) by nra. destruct hm as [m0 _]. assert (0 <= N * norm_from f v) by (apply Rmult_le_pos; [lra | apply J0]). nra. }
  set (grown := fun kept : unit -> triangle => if (0 <? lo nu)%Z then Some t else
    if Nat.eqb (length (kept tt)) (length w) then Some (triangle_add t (kept_of (lower_end nu) f (kept tt))) else None).
  (* where n is negative, n (J - T) is added *)
  assert (G : forall kept T t1, grown kept = Some t1 -> triangle_in (kept tt) T -> Forall (fun row => row <> []) T -> (forall v, quad T v <= norm_from f v) ->
    exists S1, triangle_in t1 S1 /\ forall m v, is_share m -> length v = length w -> quad S1 v <= quad S v + m * (n * (norm_from f v - quad T v))).
  { intros kept T t1 g hT rows above. unfold grown in g. destruct (Z.ltb_spec 0 (lo nu)) as [p | p].
    - injection g as <-. exists S. split; [exact hS |]. intros m v [m0 _] _. specialize (above v). apply IZR_lt in p. assert (0 < n) by nra.
      assert (0 <= m * (n * (norm_from f v - quad T v))) by (apply Rmult_le_pos; [exact m0 | apply Rmult_le_pos; lra]). lra.
    - destruct (Nat.eqb_spec (length (kept tt)) (length w)) as [l |]; [| discriminate]. injection g as <-.
      exists (tcomb 1 1 S (real_kept n f T)). split; [apply triangle_add_sound; [exact hS | apply kept_of_sound; assumption] |].
      intros m v [m0 m1] lv. rewrite quad_tcomb, quad_kept; [| rewrite <- (related_length _ _ _ _ _ hT); congruence | exact rows]. specialize (above v). apply IZR_le in p. assert (n <= 0) by nra.
      assert (0 <= (1 - m) * (- n * (norm_from f v - quad T v))) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]). lra. }
  assert (Then : forall s1 C1 kept T, Forall2 contains s1 C1 -> match grown kept with Some t => less_change bits w e s1 t | None => None end = Some t' ->
    triangle_in (kept tt) T -> Forall (fun row => row <> []) T -> (forall v, quad T v <= norm_from f v) -> (forall v, 2 * dot E v * dot C1 v = 2 * dot E v * dot C v + n * quad T v) ->
    exists S', triangle_in t' S' /\ forall m v, is_share m -> length v = length w -> quad S' v <= quad S v + m * (2 * dot E v * dot C v + N * norm_from f v)).
  { intros s1 C1 kept T h1 k hT rows above eC. destruct (grown kept) as [t1 |] eqn:g; [| discriminate]. destruct (G kept T t1 g hT rows above) as [S1 [g1 g2]].
    destruct (less_change_sound bits _ _ _ _ _ _ _ _ k g1 he h1) as [S' [k1 k2]]. exists S'. split; [exact k1 |]. intros m v hm lv. specialize (k2 m v hm). specialize (g2 m v hm lv).
    rewrite eC in k2. destruct hm as [m0 _]. specialize (J0 v). assert (0 <= m * ((N - n) * norm_from f v)) by (apply Rmult_le_pos; [exact m0 | apply Rmult_le_pos; lra]). lra. }
  destruct (recip bits (along bits e w)) as [h0 |] eqn:r.
  - destruct (recip_sound bits _ _ _ r (Toward.along_sound bits e E w W he hw)) as [d0 hr]. set (j := masked zero f w) in *.
    pose proof (masked_sound f w W hw) as hj. fold j in hj. set (z := less_multiple _ _ _) in *.
    assert (hz : Forall2 contains z (z_of f W E)).
    { apply less_multiple_sound; [| | exact he].
      - apply mul_sound; [apply mul_sound; [apply halve_sound, norm_sound, hj | exact hr] | exact hr].
      - eapply map_related; [| exact hj]. intros a x h'. rewrite Rmult_comm. apply mul_sound; assumption. }
    apply (Then (combined (lower_end nu) s z) (comb 1 n C (z_of f W E)) (fun _ => both_of e z) (outer E (z_of f W E))).
    + apply combined_sound; assumption.
    + exact h.
    + apply both_of_sound; assumption.
    + apply outer_rows.
    + intro v. rewrite quad_outer. apply along_kept, d0.
    + intro v. rewrite dot_comb, quad_outer. ring.
  - apply (Then s C (fun _ => repeat [zero] (length w)) (diagonal (length w) 0)).
    + exact hs.
    + exact h.
    + apply diagonal_in, zero_sound.
    + unfold diagonal. clear. induction (length w); cbn; constructor; [discriminate | assumption].
    + intro v. assert (Z : quad (diagonal (length w) 0) v = 0) by (unfold diagonal; clear; generalize (length w); intro k; revert v; induction k as [| k IH]; intros [| t v]; cbn [repeat quad row_form dot]; rewrite ?IH; ring).
      rewrite Z. apply J0.
    + intro v. assert (Z : quad (diagonal (length w) 0) v = 0) by (unfold diagonal; clear; generalize (length w); intro k; revert v; induction k as [| k IH]; intros [| t v]; cbn [repeat quad row_form dot]; rewrite ?IH; ring).
      rewrite Z. ring.
Qed.

(** Across, where nu > 0: less nu d d^T, and of p p^T no more than what |b|^2 + a^2 leaves, b = p - a d. *)
Definition less_across (w d e s : list fixed) (nu : fixed) (t : triangle) : option triangle :=
  let n := lower_end nu in
  let t := triangle_add t (square_of bits n d) in
  if is_null e || is_null s then Some t
  else
    let k := size bits w s in
    let tau := lo (Arithmetic.ratio (Fixed (size bits w e) (size bits w e)) one (Fixed k k)) in
    if (0 <? k)%Z && (0 <? tau)%Z then
      let half := halve (recip_positive bits (Fixed tau tau)) in
      let p := merge (mul bits (Fixed tau tau)) neg (fun a b => sub (mul bits (Fixed tau tau) a) b) s e in
      let a := lower_end (Arithmetic.ratio (along bits p d) one (add one (norm d))) in
      let squares := add (norm (less_multiple a p d)) (sqr bits a) in
      if (0 <? lo squares)%Z then
        let kappa := upper_end (sub half (Arithmetic.ratio n one squares)) in
        Some (if (0 <? lo kappa)%Z then triangle_add t (square_of bits kappa p) else t)
      else None
    else None.

Lemma less_across_sound : forall w d D e E s C nu N t t' S, less_across w d e s nu t = Some t' -> (0 < lo nu)%Z -> triangle_in t S ->
  Forall2 contains d D -> Forall2 contains e E -> Forall2 contains s C -> contains nu N ->
  exists S', triangle_in t' S' /\ forall m v, is_share m -> quad S' v <= quad S v + m * (2 * dot E v * dot C v + N * dot v v).
Proof.
  intros w d D e E s C nu N t t' S h pos hS hd he hs hn. unfold less_across in h. cbv zeta in h. destruct (lower_end_sound bits nu N hn) as [n [hl le]].
  pose proof (contains_positive bits (lower_end nu) n pos hl) as n0. pose proof (unit_R_pos bits) as u0.
  set (t1 := triangle_add t _) in h. pose proof (triangle_add_sound bits _ _ _ _ hS (square_of_sound bits _ _ _ _ hl hd)) as h1. fold t1 in h1. set (S1 := tcomb 1 1 S (real_square n D)) in *.
  assert (q1 : forall v, quad S1 v = quad S v - n * dot D v ^ 2) by (intro v; unfold S1; rewrite quad_tcomb, quad_square; ring).
  destruct (is_null e || is_null s) eqn:z.
  - injection h as <-. exists S1. split; [exact h1 |]. intros m v [m0 _]. rewrite q1. pose proof (pow2_ge_0 (dot D v)). pose proof (dot_self v).
    assert (Z : dot E v * dot C v = 0) by (apply orb_true_iff in z as [z | z]; rewrite (null_sound bits _ _ z ltac:(eassumption)); ring).
    assert (0 <= m * (N * dot v v)) by (apply Rmult_le_pos; [exact m0 | apply Rmult_le_pos; lra]). assert (0 <= n * dot D v ^ 2) by (apply Rmult_le_pos; lra). nra.
  - set (tau := lo _) in h. destruct ((0 <? size bits w s)%Z && (0 <? tau)%Z) eqn:p; [| discriminate]. apply andb_true_iff in p as [_ p]. apply Z.ltb_lt in p.
    pose proof (point_sound bits tau) as ht. set (y := IZR tau / unit_R bits) in *. pose proof (contains_positive bits (Fixed tau tau) y p ht) as y0.
    pose proof (halve_sound bits _ _ (recip_positive_sound bits (Fixed tau tau) y p ht)) as hh.
    set (q := merge _ _ _ s e) in h. assert (hq : Forall2 contains q (comb y (-1) C E)).
    { eapply merge_related; try eassumption.
      - intros a x ha. apply mul_sound; assumption.
      - intros b x hb. replace (-1 * x) with (- x) by ring. apply neg_sound, hb.
      - intros a x b x' ha hb. replace (y * x + -1 * x') with (y * x - x') by ring. apply sub_sound; [apply mul_sound |]; assumption. }
    set (a := lower_end _) in h. assert (ha : exists A, contains a A) by (unfold a, lower_end; eexists; apply point_sound). destruct ha as [A ha].
    set (b := comb 1 (- A) (comb y (-1) C E) D). pose proof (less_multiple_sound a A q _ d D ha hq hd) as hb. fold b in hb.
    set (squares := add _ _) in h. pose proof (add_sound bits _ _ _ _ (norm_sound _ _ hb) (sqr_sound bits _ _ ha)) as hsq. fold squares in hsq. set (Q := dot b b + A ^ 2) in *.
    destruct (0 <? lo squares)%Z eqn:sp; [| discriminate]. apply Z.ltb_lt in sp. pose proof (contains_positive bits _ _ sp hsq) as Q0.
    pose proof (sub_sound bits _ _ _ _ hh (Arithmetic.ratio_sound bits _ _ _ _ _ _ sp hl (integer_sound bits 1) hsq)) as hk.
    destruct (upper_end_sound bits _ _ hk) as [K [hK leK]]. set (kappa := upper_end _) in *.
    (* with a multiple that is not negative *)
    assert (Enough : forall k v m, 0 <= k -> / y / 2 - n * 1 / Q <= k -> is_share m -> - n * dot D v ^ 2 - k * dot (comb y (-1) C E) v ^ 2 <= m * (2 * dot E v * dot C v + N * dot v v)).
    { intros k v m k0 kq [m0 m1]. pose proof (across_bound (comb y (-1) C E) D v A) as B. cbv zeta in B. fold b in B. fold Q in B.
      pose proof (dot_self v) as V0. set (V := dot v v) in *. set (F := dot D v ^ 2) in *. assert (F0 : 0 <= F) by apply pow2_ge_0.
      assert (eP : dot (comb y (-1) C E) v = y * dot C v - dot E v) by (rewrite dot_comb; ring). set (c := dot C v) in *. set (x := dot E v) in *.
      set (P := dot (comb y (-1) C E) v ^ 2) in *. assert (P0 : 0 <= P) by apply pow2_ge_0.
      assert (B' : n * 1 / Q * P <= n * (V + F)).
      { replace (n * 1 / Q * P) with (n * (P * / Q)) by (unfold Rdiv; ring). apply Rmult_le_compat_l; [lra |]. apply Rmult_le_reg_r with Q; [exact Q0 |]. rewrite Rmult_assoc, Rinv_l by lra. lra. }
      assert (X : 0 <= / y / 2 * P + 2 * x * c).
      { unfold P. rewrite eP. replace (/ y / 2 * (y * c - x) ^ 2 + 2 * x * c) with (/ y / 2 * (y * c + x) ^ 2) by (field; lra).
        apply Rmult_le_pos; [pose proof (Rinv_0_lt_compat _ y0); lra | apply pow2_ge_0]. }
      assert (kP : / y / 2 * P - n * 1 / Q * P <= k * P) by (rewrite <- Rmult_minus_distr_r; apply Rmult_le_compat_r; assumption).
      assert (E1 : 0 <= k * P + n * F + (n * V + 2 * x * c)) by lra.
      assert (E0 : 0 <= k * P + n * F) by (apply Rplus_le_le_0_compat; apply Rmult_le_pos; lra).
      assert (E2 : 0 <= m * ((N - n) * V)) by (apply Rmult_le_pos; [exact m0 | apply Rmult_le_pos; lra]).
      assert (E3 : 0 <= (1 - m) * (k * P + n * F)) by (apply Rmult_le_pos; [lra | exact E0]).
      assert (E4 : 0 <= m * (k * P + n * F + (n * V + 2 * x * c))) by (apply Rmult_le_pos; assumption).
      replace (m * (k * P + n * F + (n * V + 2 * x * c))) with (m * (k * P + n * F) + m * (n * V + 2 * x * c)) in E4 by ring. lra. }
    destruct (0 <? lo kappa)%Z eqn:kp; injection h as <-.
    + apply Z.ltb_lt in kp. pose proof (contains_positive bits _ _ kp hK) as K0. exists (tcomb 1 1 S1 (real_square K (comb y (-1) C E))).
      split; [apply triangle_add_sound; [exact h1 | apply square_of_sound; assumption] |]. intros m v hm. rewrite quad_tcomb, quad_square, q1.
      pose proof (Enough K v m (Rlt_le _ _ K0) leK hm). lra.
    + exists S1. split; [exact h1 |]. intros m v hm. rewrite q1. apply Z.ltb_ge, IZR_le in kp. destruct hK as [kl kh]. unfold kappa, upper_end in kp, kl, kh. cbn [lo hi] in kp, kl, kh.
      assert (K <= 0) by nra. pose proof (Enough 0 v m (Rle_refl 0) ltac:(lra) hm). lra.
Qed.

Definition less_weighted (w : list fixed) (across : option (list fixed)) (first : nat) (e s : list fixed) (nu : fixed) (t : triangle) : option triangle :=
  match across with Some d => if (0 <? lo nu)%Z then less_across w d e s nu t else less_along w first e s nu t | None => less_along w first e s nu t end.
Fixpoint less_all (w : list fixed) (across : option (list fixed)) (first : nat) (e : list fixed) (cs : list (list fixed * fixed)) (t : triangle) : option triangle :=
  match cs with [] => Some t | c :: cs' => match less_weighted w across first e (fst c) (snd c) t with Some t' => less_all w across first e cs' t' | None => None end end.

(** A second direction is one of all coordinates. *)
Definition may_cross (across : option (list fixed)) (first : nat) : Prop := match across with Some d => first = O /\ exists D, Forall2 contains d D | None => True end.
Theorem less_all_sound : forall w W across first e E cs ms t t' S, less_all w across first e cs t = Some t' -> may_cross across first -> triangle_in t S ->
  Forall2 contains w W -> Forall2 contains e E -> Forall2 (fun c m => is_share (fst m) /\ Forall2 contains (fst c) (fst (snd m)) /\ contains (snd c) (snd (snd m))) cs ms ->
  exists S', triangle_in t' S' /\ forall v, length v = length w -> quad S' v <= quad S v + sum_of ms (fun c => 2 * dot E v * dot (fst c) v + snd c * norm_from first v).
Proof.
  intros w W across first e E cs ms t t' S h ok hS hw he hc. revert t S h hS. induction hc as [| [s nu] [k [C N]] cs ms [hm [hs hn]] hc IH]; intros t S h hS; cbn [less_all sum_of fold_right fst snd] in *.
  - injection h as <-. exists S. split; [exact hS | intros; lra].
  - destruct (less_weighted w across first e s nu t) as [t1 |] eqn:e1; [| discriminate].
    assert (L : exists S1, triangle_in t1 S1 /\ forall v, length v = length w -> quad S1 v <= quad S v + k * (2 * dot E v * dot C v + N * norm_from first v)).
    { unfold less_weighted in e1.
      assert (Along : less_along w first e s nu t = Some t1 -> exists S1, triangle_in t1 S1 /\ forall v, length v = length w -> quad S1 v <= quad S v + k * (2 * dot E v * dot C v + N * norm_from first v)).
      { intro a. destruct (less_along_sound w W first e E s C nu N t t1 S a hS hw he hs hn) as [S1 [k1 k2]]. exists S1. split; [exact k1 | intros v lv; exact (k2 k v hm lv)]. }
      destruct across as [d |]; [| exact (Along e1)]. destruct (0 <? lo nu)%Z eqn:p; [| exact (Along e1)]. apply Z.ltb_lt in p. destruct ok as [-> [D hd]].
      destruct (less_across_sound w d D e E s C nu N t t1 S e1 p hS hd he hs hn) as [S1 [k1 k2]]. exists S1. split; [exact k1 | intros v _; exact (k2 k v hm)]. }
    destruct L as [S1 [h1 q1]]. destruct (IH t1 S1 h h1) as [S' [h2 q2]]. exists S'. split; [exact h2 |]. intros v lv. specialize (q2 v lv). specialize (q1 v lv). unfold sum_of in q2. lra.
Qed.

(** ** A row of one machine, with changes, and what these change of the multiple *)

Definition weighted (A : Type) : Type := (list A * A) * list (list A * A * A).
(** By shares of which this is so. *)
Definition weighted_by (is_so : R -> Prop) (i : weighted fixed) (r : list R * R * R) (a : list R) (d : R) (ms : list (R * (list R * R * R))) : Prop :=
  Forall2 contains (fst (fst i)) a /\ contains (snd (fst i)) d /\
    Forall2 (fun c m => is_so (fst m) /\ Forall2 contains (fst (fst c)) (fst (fst (snd m))) /\ contains (snd (fst c)) (snd (fst (snd m))) /\ contains (snd c) (snd (snd m))) (snd i) ms /\
    (forall v, dot (fst (fst r)) v = dot a v + sum_of ms (fun c => dot (fst (fst c)) v)) /\ snd (fst r) = d + sum_of ms (fun c => snd (fst c)) /\ snd r = sum_of ms snd.
Definition weighted_in (i : weighted fixed) (r : list R * R * R) : Prop := exists a d ms, weighted_by is_share i r a d ms.
Definition changed (r : list (list R * R * R)) : R := fold_right (fun r s => snd r + s) 0 r.

Fixpoint lower_weighted (w : list fixed) (across : option (list fixed)) (places : N) (Y : list (list Z)) (r : list (weighted fixed)) (start : triangle) : option triangle :=
  match Y, r with
  | [], [] => Some start
  | y :: Y', ((a, d), cs) :: r' =>
      match less_all w across 0 (map (fun n => Arithmetic.dyadic n places one) y) (map (fun c => (map halve (residual places (fst (fst c)) (snd (fst c)) y), neg (snd c))) cs)
        (triangle_add start (Test.halves places y (residual places a (upper_end d) y))) with
      | Some t => lower_weighted w across places Y' r' t
      | None => None
      end
  | _, _ => None
  end.

Lemma lower_weighted_sound : forall w W across places Y i r start S T, Forall2 contains w W -> may_cross across 0 -> Forall2 weighted_in i r -> triangle_in start S ->
  lower_weighted w across places Y i start = Some T ->
  exists U, triangle_in T U /\ forall v, length v = length w -> quad U v <= quad S v + (form (lower_weights places Y v) (map fst r) v - changed r * dot v v).
Proof.
  intros w W across places Y i r start S T hw ok h. revert i r start S h. induction Y as [| y Y IH]; intros i r start S h hS u.
  { destruct h; [| discriminate]. injection u as <-. exists S. split; [exact hS |]. intros v _. cbn. lra. }
  destruct h as [| [[a d] cs] [[A D] t0] i r [a0 [d0 [ms [ha [hd [hm [eA [eD eT]]]]]]]] h]; [discriminate |]. cbn [fst snd] in *.
  cbn [lower_weighted] in u. destruct (upper_end_sound bits d d0 hd) as [g [hg le]].
  destruct (less_all _ _ _ _ _ _) as [t |] eqn:el in u; [| discriminate].
  pose proof (triangle_add_sound bits _ _ _ _ hS (Test.halves_sound bits places y _ _ (residual_sound bits places a a0 _ g y ha hg))) as hT.
  assert (hY : Forall2 contains (map (fun n => Arithmetic.dyadic n places one) y) (map (Y_value places) y)).
  { clear. induction y as [| n y I]; cbn [map]; constructor; [| exact I]. replace (Y_value places n) with (Y_value places n * 1) by ring. apply Arithmetic.dyadic_sound, integer_sound. }
  set (half := fun c : list R * R * R => (map (Rmult (/ 2)) (comb 2 (- snd (fst c)) (fst (fst c)) (map (Y_value places) y)), - snd c)).
  assert (hC : Forall2 (fun c m => is_share (fst m) /\ Forall2 contains (fst c) (fst (snd m)) /\ contains (snd c) (snd (snd m)))
    (map (fun c => (map halve (residual places (fst (fst c)) (snd (fst c)) y), neg (snd c))) cs) (map (fun m => (fst m, half (snd m))) ms)).
  { eapply map_related; [| exact hm]. intros c m [h1 [h2 [h3 h4]]]. cbn [fst snd]. split; [exact h1 |]. unfold half. cbn [fst snd]. split; [| apply neg_sound, h4].
    eapply map_related; [| apply residual_sound; eassumption]. intros b x hb. replace (/ 2 * x) with (x / 2) by (unfold Rdiv; ring). apply halve_sound, hb. }
  destruct (less_all_sound _ _ _ _ _ _ _ _ _ _ _ el ok hT hw hY hC) as [S1 [h1 q1]]. destruct (IH i r t S1 h h1 u) as [U [hU q]]. exists U. split; [exact hU |].
  intros v lv. specialize (q v lv). specialize (q1 v lv). cbn [lower_weights map form changed fold_right fst snd]. fold (lower_weights places Y v). fold (changed r). rewrite quad_tcomb, quad_outer, dot_comb in q1.
  assert (E : dot (map (Y_value places) y) v = 2 * dot (map (Y_half places) y) v).
  { rewrite <- dot_map, map_map. f_equal. apply map_ext. exact (Y_half_eq places). }
  set (s := dot (map (Y_value places) y) v) in *. rewrite sum_mapped in q1. change (norm_from 0 v) with (dot v v) in q1.
  rewrite (sum_equal _ ms _ (fun c => 1 * (2 * s * dot (fst (fst c)) v + - s ^ 2 * snd (fst c)) + - dot v v * snd c)) in q1 by (intro c; unfold half; cbn [fst snd]; rewrite dot_map, dot_comb; fold s; field).
  rewrite sum_plus, sum_plus in q1. rewrite eA, eD, eT. replace (dot (map (Y_half places) y) v) with (s / 2) in q1 by lra. pose proof (pow2_ge_0 s). nra.
Qed.

(** Of c^2 times the multiple. *)
Fixpoint upper_weighted (w : list fixed) (c2 : fixed) (r : list (weighted fixed)) (start : triangle) : option triangle :=
  match r with
  | [] => Some start
  | ((a, d), cs) :: r' =>
      let bordered := (lower_end d :: a) :: start in
      let lessened := match cs with
        | [] => Some bordered
        | _ => if (0 <? lo d)%Z then
            less_all (neg (Arithmetic.ratio (along bits a w) one d) :: w) None 1 (one :: map (fun _ => zero) a) (map (fun c => (halve (snd (fst c)) :: fst (fst c), mul bits c2 (snd c))) cs) bordered
            else None
        end in
      match lessened with
      | Some t => match eliminated bits t with Some t => upper_weighted w c2 r' t | None => None end
      | None => None
      end
  end.

Lemma upper_weighted_sound : forall w W c2 c i r start S T, Forall2 contains w W -> contains c2 c -> Forall2 weighted_in i r -> triangle_in start S -> upper_weighted w c2 i start = Some T ->
  exists U, triangle_in T U /\ forall v z, length v = length w -> quad U v <= quad S v + (form (upper_weights z) (map fst r) v + c * changed r * dot v v).
Proof.
  intros w W c2 c i r start S T hw hc2 h. revert start S. induction h as [| [[a d] cs] [[A D] t0] i r [a0 [d0 [ms [ha [hd [hm [eA [eD eT]]]]]]]] h IH]; intros start S hS u.
  - injection u as <-. exists S. split; [exact hS |]. intros v [| t z] _; cbn; lra.
  - cbn [upper_weighted] in u. cbn [fst snd] in *. cbv zeta in u. destruct (lower_end_sound bits d d0 hd) as [g [hg le]].
    assert (hB : triangle_in ((lower_end d :: a) :: start) ((g :: a0) :: S)) by (constructor; [constructor; assumption | exact hS]).
    match type of u with match ?x with Some _ => _ | None => _ end = _ => destruct x as [t |] eqn:el; [| discriminate u] end.
    destruct (eliminated bits t) as [t2 |] eqn:e2; [| discriminate].
    assert (L : exists S1, triangle_in t S1 /\ forall z v, length v = length w ->
      quad S1 (z :: v) <= g * z ^ 2 + 2 * z * dot a0 v + quad S v + (sum_of ms (fun c => 2 * z * dot (fst (fst c)) v + z ^ 2 * snd (fst c)) + c * sum_of ms snd * dot v v)).
    { destruct hm as [| b m cs ms hb hm].
      - injection el as <-. exists ((g :: a0) :: S). split; [exact hB |]. intros z v _. cbn [quad row_form sum_of fold_right]. lra.
      - destruct (0 <? lo d)%Z eqn:p; [| discriminate]. apply Z.ltb_lt in p.
        assert (hE : Forall2 contains (one :: map (fun _ => zero) a) (1 :: map (fun _ => 0) a)).
        { constructor; [apply integer_sound |]. clear. induction a; cbn; constructor; auto using zero_sound. }
        assert (hW : Forall2 contains (neg (Arithmetic.ratio (along bits a w) one d) :: w) (- (dot a0 W * 1 / d0) :: W)).
        { constructor; [| exact hw]. apply neg_sound, Arithmetic.ratio_sound; [exact p | apply Toward.along_sound; assumption | apply integer_sound | exact hd]. }
        assert (hC : Forall2 (fun c m => is_share (fst m) /\ Forall2 contains (fst c) (fst (snd m)) /\ contains (snd c) (snd (snd m)))
          (map (fun c => (halve (snd (fst c)) :: fst (fst c), mul bits c2 (snd c))) (b :: cs)) (map (fun m => (fst m, (snd (fst (snd m)) / 2 :: fst (fst (snd m)), c * snd (snd m)))) (m :: ms))).
        { eapply map_related; [| exact (Forall2_cons b m hb hm)]. intros c' m' [h1 [h2 [h3 h4]]]. cbn [fst snd]. split; [exact h1 |].
          split; [constructor; [apply halve_sound, h3 | exact h2] | apply mul_sound; assumption]. }
        destruct (less_all_sound _ _ None _ _ _ _ _ _ _ _ el I hB hW hE hC) as [S1 [h1 q]]. exists S1. split; [exact h1 |]. intros z v lv. specialize (q (z :: v) ltac:(cbn [length]; congruence)).
        rewrite (sum_mapped _ _ (m :: ms) (fun m : list R * R * R => (snd (fst m) / 2 :: fst (fst m), c * snd m))) in q. cbn [quad row_form] in q.
        assert (Z0 : dot (1 :: map (fun _ => 0) a) (z :: v) = z).
        { cbn [dot]. assert (N : forall (l : list fixed) v, dot (map (fun _ => 0) l) v = 0) by (induction l as [| x l I0]; intros [| y k]; cbn [map dot]; try reflexivity; rewrite I0; ring). rewrite N. ring. }
        assert (J : norm_from 1 (z :: v) = dot v v) by (unfold norm_from; cbn [masked dot]; ring).
        rewrite (sum_equal _ _ _ (fun e => 1 * (2 * z * dot (fst (fst e)) v + z ^ 2 * snd (fst e)) + c * dot v v * snd e)) in q by (intro c'; rewrite Z0, J; cbn [dot fst snd]; field).
        rewrite sum_plus in q. lra. }
    destruct L as [S1 [h1 q1]]. clear el. revert e2 q1. destruct h1 as [| row real t S1 hr h1]; intros e2 q1; [discriminate |]. revert e2 q1. destruct hr as [| b x row u' hb hr]; intros e2 q1; [discriminate |].
    destruct (eliminated_sound bits _ _ _ _ _ _ _ e2 hb hr h1) as [x0 h2]. destruct (IH _ _ h2 u) as [U [hU q]]. exists U. split; [exact hU |].
    intros v z lv.
    assert (K : forall y, quad S1 v - / x * dot u' v ^ 2 <= quad S v + (2 * y * dot A v + y ^ 2 * D + c * t0 * dot v v)).
    { intro y. specialize (q1 y v lv). rewrite sum_plus in q1. cbn [quad row_form] in q1. rewrite eA, eD, eT. set (k := dot u' v) in *.
      assert (0 <= / x * (x * y + k) ^ 2) by (apply Rmult_le_pos; [apply Rlt_le, Rinv_0_lt_compat, x0 | apply pow2_ge_0]).
      replace (/ x * (x * y + k) ^ 2) with (x * y ^ 2 + 2 * y * k + / x * k ^ 2) in * by (field; lra).
      assert (g * y ^ 2 <= d0 * y ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact le]). lra. }
    cbn [changed fold_right map fst snd]. fold (changed r).
    destruct z as [| y z]; cbn [upper_weights map form].
    + specialize (q v [] lv). rewrite quad_schur in q by lra. specialize (K 0). cbn in q. cbn. lra.
    + specialize (q v z lv). rewrite quad_schur in q by lra. specialize (K y). fold (upper_weights z). lra.
Qed.

(** ** Multiples that parameters make: of each row those by which some are multiplied, n over 2^places *)

Definition multiple_for (row : list (nat * Z)) (j : nat) : Z := fold_right (fun q s => if Nat.eqb (fst q) j then (snd q + s)%Z else s) 0%Z row.
Definition multiple_of (places : N) (params : list fixed) (row : list (nat * Z)) : fixed := fold_right (fun q s => add (Arithmetic.dyadic (snd q) places (nth (fst q) params zero)) s) zero row.
Definition multiple_at (places : N) (theta : list R) (row : list (nat * Z)) : R := fold_right (fun q s => Y_value places (snd q) * nth (fst q) theta 0 + s) 0 row.
Definition total_of (places : N) (params : list fixed) (rows : list (list (nat * Z))) : fixed := fold_right (fun row s => add (multiple_of places params row) s) zero rows.
Definition total_at (places : N) (theta : list R) (rows : list (list (nat * Z))) : R := fold_right (fun row s => multiple_at places theta row + s) 0 rows.

Lemma total_sound : forall places params theta rows, Forall2 contains params theta -> contains (total_of places params rows) (total_at places theta rows).
Proof.
  intros places params theta rows h. induction rows as [| row rows IH]; cbn [total_of total_at fold_right]; [apply zero_sound |]. apply add_sound; [| exact IH].
  induction row as [| q row I]; cbn [multiple_of multiple_at fold_right]; [apply zero_sound |]. apply add_sound; [| exact I]. apply Arithmetic.dyadic_sound.
  generalize (fst q). clear - h. induction h as [| a x params theta h _ IH]; intros [| j]; cbn [nth]; auto using zero_sound.
Qed.

Lemma no_total : forall (A : Type) (l : list A) f, (forall a, In a l -> f a = 0) -> Second.total l f = 0.
Proof. intros A l f h. unfold Second.total. induction l as [| a l IH]; [reflexivity |]. cbn [fold_right]. rewrite h by (left; reflexivity). rewrite IH by (intros; apply h; right; assumption). ring. Qed.
(** Of all machines that differ from one in these alone. *)
Lemma multiple_changes : forall places (ends : list (nat * choice)) theta0 theta row, NoDup (map fst ends) -> (forall j, ~ In j (map fst ends) -> nth j theta0 0 = nth j theta 0) ->
  dot (map (Y_value places) (map (fun e => multiple_for row (fst e)) ends)) (map (fun e => nth (fst e) theta 0 - nth (fst e) theta0 0) ends) = multiple_at places theta row - multiple_at places theta0 row.
Proof.
  intros places ends theta0 theta row once same. rewrite map_map, Second.dot_mapped.
  induction row as [| [j n] row IH]; cbn [multiple_for multiple_at fold_right fst snd].
  - rewrite no_total by (intros e _; unfold Y_value, Rdiv; ring). ring.
  - fold (multiple_for row). set (d := fun e : nat * choice => nth (fst e) theta 0 - nth (fst e) theta0 0) in *.
    rewrite (Second.total_same _ ends _ (fun e => Y_value places n * ((if Nat.eqb j (fst e) then 1 else 0) * d e) + Y_value places (multiple_for row (fst e)) * d e)).
    2: { intros e _. unfold multiple_for at 1. cbn [fold_right fst snd]. fold (multiple_for row (fst e)). unfold Y_value, d. destruct (Nat.eqb j (fst e)); [rewrite plus_IZR |]; unfold Rdiv; ring. }
    change (Second.total ends (fun e => Y_value places (multiple_for row (fst e)) * d e) = multiple_at places theta row - multiple_at places theta0 row) in IH. rewrite Second.total_linear, IH. fold (multiple_at places theta row) (multiple_at places theta0 row).
    assert (P : Second.total ends (fun e => (if Nat.eqb j (fst e) then 1 else 0) * d e) = nth j theta 0 - nth j theta0 0).
    { destruct (in_dec Nat.eq_dec j (map fst ends)) as [i | i].
      - clear same IH. unfold d in *. clear d. induction ends as [| e l I]; [contradiction |]. cbn [map] in once, i. inversion once as [| ? ? no once']; subst. unfold Second.total. cbn [fold_right].
        destruct (Nat.eqb_spec j (fst e)) as [-> | ne].
        + assert (Z : forall k, ~ In (fst e) (map fst k) -> fold_right (fun (a : nat * choice) s => (if Nat.eqb (fst e) (fst a) then 1 else 0) * (nth (fst a) theta 0 - nth (fst a) theta0 0) + s) 0 k = 0).
          { induction k as [| a k J]; intro n0; [reflexivity |]. cbn [map] in n0. cbn [fold_right]. rewrite J by (intro; apply n0; right; assumption). destruct (Nat.eqb_spec (fst e) (fst a)) as [q |]; [exfalso; apply n0; left; congruence | ring]. }
          rewrite (Z l no). ring.
        + unfold Second.total in I. rewrite I; [ring | exact once' | destruct i as [q |]; [congruence | assumption]].
      - rewrite (same j i), no_total; [ring |]. intros e ie. destruct (Nat.eqb_spec j (fst e)) as [q |]; [exfalso; apply i; rewrite q; apply in_map; exact ie | ring]. }
    rewrite P. ring.
Qed.

Fixpoint changes_with (places : N) (s : list bool) (p : nat) (steps : list (list fixed)) (ns : list Z) (r : list (multi slope) * multi slope) : list (list fixed * fixed * fixed) :=
  match steps with
  | [] => []
  | rs :: steps' =>
      let f q := at_vertex s (nth p (snd q) (constant zero)) in
      let a := map f (fst r) in let d := f (snd r) in let n := hd 0%Z ns in
      map (fun r => (map (mul bits r) a, mul bits r d, if (n =? 0)%Z then zero else Arithmetic.dyadic n places r)) rs ++ changes_with places s (S p) steps' (tl ns) r
  end.
Definition weighted_at (places : N) (s : list bool) (steps : list (list fixed)) (ns : list Z) (r : list (multi slope) * multi slope) : weighted fixed :=
  let f q := at_vertex s (fst q) in ((map f (fst r), f (snd r)), changes_with places s 0 steps ns r).

(** With the shares that steps have. *)
Lemma weighted_at_shares : forall (is_so : R -> Prop) places s steps ns r a d mss, Forall2 (multi_in bits) (fst r) a -> multi_in bits (snd r) d -> Forall2 (Forall2 (fun r m => is_so (fst m) /\ contains r (snd m))) steps mss ->
  let l := map corner s in let m e := at_lambda l (moved (fst e) (map stride mss) (snd e)) in
  exists a0 d0 ms, weighted_by is_so (weighted_at places s steps ns r) (map m a, m d, dot (map (Y_value places) ns) (map stride mss)) a0 d0 ms /\ map fst ms = map fst (concat mss).
Proof.
  intros is_so places s steps ns r a d mss ha hd hm l m.
  assert (At : forall q e p, multi_in bits q e -> contains (at_vertex s (nth p (snd q) (constant zero))) (at_lambda l (nth p (snd e) (0, [])))).
  { intros q e p [_ h]. apply at_vertex_sound. revert p. induction h as [| u v us vs k h IH]; intros [| p]; cbn [nth]; auto.
    - split; [apply zero_sound | constructor].
    - split; [apply zero_sound | constructor]. }
  assert (C : forall p ns, exists ms, Forall2 (fun c m => is_so (fst m) /\ Forall2 contains (fst (fst c)) (fst (fst (snd m))) /\ contains (snd (fst c)) (snd (fst (snd m))) /\ contains (snd c) (snd (snd m))) (changes_with places s p steps ns r) ms /\
    (forall v, sum_of ms (fun c => dot (fst (fst c)) v) = dot (map (fun e => dot (map stride mss) (map (at_lambda l) (skipn p (snd e)))) a) v) /\
    sum_of ms (fun c => snd (fst c)) = dot (map stride mss) (map (at_lambda l) (skipn p (snd d))) /\ sum_of ms snd = dot (map (Y_value places) ns) (map stride mss) /\ map fst ms = map fst (concat mss)).
  { clear ns. induction hm as [| rs ks steps mss h hm IH]; intros p ns; cbn [changes_with].
    - exists []. split; [constructor |]. split; [| split; [reflexivity | split; [destruct ns; reflexivity | reflexivity]]]. intro v. cbn [sum_of fold_right map]. symmetry. clear. revert v. induction a as [| e a IH]; intros [| t v]; cbn [map dot]; try reflexivity.
      rewrite IH. ring.
    - destruct (IH (S p) (tl ns)) as [ms [h1 [h2 [h3 [h4 h5]]]]]. set (g (e : multi entry) := at_lambda l (nth p (snd e) (0, []))). set (y := Y_value places (List.hd 0%Z ns)).
      exists (map (fun n : R * R => (fst n, (map (fun e => snd n * g e) a, snd n * g d, y * snd n))) ks ++ ms).
      assert (Sum : forall (f : list R * R * R -> R) k z, (forall n : R * R, f (map (fun e => snd n * g e) a, snd n * g d, y * snd n) = snd n * k) ->
        fold_right (fun (m : R * (list R * R * R)) s0 => fst m * f (snd m) + s0) z (map (fun n : R * R => (fst n, (map (fun e => snd n * g e) a, snd n * g d, y * snd n))) ks) = stride ks * k + z).
      { intros f k z e. unfold stride. clear - e. induction ks as [| n ks I]; cbn [map fold_right sum_of fst snd]; [ring |]. rewrite I, e. unfold sum_of. ring. }
      split; [| split; [| split; [| split]]].
      + apply Forall2_app; [| exact h1]. eapply map_related; [| exact h]. intros q n [k1 k2]. cbn [fst snd]. split; [exact k1 |]. split; [| split; [apply mul_sound; [exact k2 | apply At, hd] |]].
        * rewrite map_map. eapply map_related; [| exact ha]. intros u e k. apply mul_sound; [exact k2 | apply At, k].
        * destruct (Z.eqb_spec (List.hd 0%Z ns) 0) as [z | _]; [| apply Arithmetic.dyadic_sound, k2]. replace (y * snd n) with 0 by (unfold y, Y_value; rewrite z; unfold Rdiv; ring). apply zero_sound.
      + intro v. unfold sum_of in *. rewrite fold_right_app, h2. rewrite (Sum (fun c => dot (fst (fst c)) v) (dot (map g a) v)).
        2: { intro n. cbn [fst]. rewrite <- dot_map, map_map. reflexivity. }
        assert (P : forall e : multi entry, dot (map stride (ks :: mss)) (map (at_lambda l) (skipn p (snd e))) = stride ks * g e + dot (map stride mss) (map (at_lambda l) (skipn (S p) (snd e))))
          by (intro e; exact (dot_skipped (stride ks :: map stride mss) (snd e) l p)).
        rewrite (map_ext _ _ P). clear. revert v. induction a as [| e a I]; intros [| t v]; cbn [map]; try (cbn [dot]; ring).
        match goal with |- _ * dot (?b :: ?bs) _ + dot (?c :: ?cs) _ = dot (?d :: ?ds) _ => change (stride ks * (b * t + dot bs v) + (c * t + dot cs v) = d * t + dot ds v) end. rewrite <- I. ring.
      + unfold sum_of in *. rewrite fold_right_app, h3. rewrite (Sum (fun c => snd (fst c)) (g d)) by (intro; reflexivity). cbn [map]. rewrite (dot_skipped (stride ks :: map stride mss)). reflexivity.
      + unfold sum_of in *. rewrite fold_right_app, h4. rewrite (Sum snd y) by (intro; cbn [snd]; ring). unfold y. destruct ns as [| n ns]; cbn [List.hd tl map dot]; [unfold Y_value, Rdiv |]; ring.
      + cbn [concat]. rewrite !map_app, h5, map_map. reflexivity. }
  destruct (C 0%nat ns) as [ms [h1 [h2 [h3 [h4 h5]]]]]. exists (map (fun e => at_lambda l (fst e)) a), (at_lambda l (fst d)), ms. split; [| exact h5]. unfold weighted_by, weighted_at. cbn [fst snd].
  split; [| split; [| split; [exact h1 | split; [| split]]]].
  - eapply map_related; [| exact ha]. intros q e [k _]. apply at_vertex_sound, k.
  - apply at_vertex_sound, hd.
  - intro v. rewrite h2. unfold m. clear. revert v. induction a as [| e a I]; intros [| t v]; cbn [map dot]; try ring. rewrite I, at_moved. cbn [skipn]. ring.
  - rewrite h3. unfold m. rewrite at_moved. reflexivity.
  - symmetry. exact h4.
Qed.
Lemma weighted_at_sound : forall places s steps ns r a d mss, Forall2 (multi_in bits) (fst r) a -> multi_in bits (snd r) d -> Forall2 (stepped bits) steps mss ->
  let l := map corner s in let m e := at_lambda l (moved (fst e) (map stride mss) (snd e)) in
  weighted_in (weighted_at places s steps ns r) (map m a, m d, dot (map (Y_value places) ns) (map stride mss)).
Proof. intros places s steps ns r a d mss ha hd hm. destruct (weighted_at_shares is_share places s steps ns r a d mss ha hd hm) as [a0 [d0 [ms [h _]]]]. exists a0, d0, ms. exact h. Qed.

(** By what a multiple changes with a row, an entry of the row does. *)
Definition is_still (s : slope) : bool :=
  ((lo (at_c s) =? 0) && (hi (at_c s) =? 0) && (lo (range s) =? 0) && (hi (range s) =? 0))%Z && match slopes s with [] => true | _ => false end.
Definition are_related (ns : list Z) (r : list (multi slope) * multi slope) : bool :=
  forallb (fun p => (snd p =? 0)%Z || existsb (fun q => negb (is_still (nth (fst p) (snd q) (constant zero)))) (snd r :: fst r)) (combine (seq 0 (length ns)) ns).
End Precision.
