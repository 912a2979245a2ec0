(** * What several quantities change of a row together

    Quantities of second order in the middle of their tolerances change a row by t_j in [-1, 1], two of them by t_j t_l,
    and one by t_j^2.  The form of all these changes is affine in each t_j and in each t_j^2, if these are numbers of
    [0, 1] by themselves: so it is not less than at some vertex, and with a matrix R it is positive if it is so at all of
    them ([together]).  R is then taken off in the place of each of them. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Fixed.
From Orthocert.kernel Require Import Linear Arithmetic Slope Definite Test Tolerances Weighted.
From Orthocert.kernel Require Solve Second Toward.
Import ListNotations.
Local Open Scope R_scope.
Local Notation is_in := Second.is_in.

(** ** Signs *)

Fixpoint at_parts (qs J : list nat) (holds : list nat -> bool) : bool :=
  match qs with [] => holds J | q :: qs' => at_parts qs' J holds && at_parts qs' (q :: J) holds end.
(** 1 for what is in J, -1 for what is not, and as it is for what is left. *)
Definition put (J qs : list nat) (z : nat -> R) (p : nat) : R := if is_in p J then 1 else if is_in p qs then z p else -1.

Lemma is_in_iff : forall p l, is_in p l = true <-> In p l.
Proof. intros p l. unfold is_in. rewrite existsb_exists. split; [intros [q [i e]]; apply Nat.eqb_eq in e; subst; exact i | intro i; exists p; split; [exact i | apply Nat.eqb_refl]]. Qed.
Lemma between_positive : forall t x y, 0 <= t <= 1 -> 0 < x -> 0 < y -> 0 < (1 - t) * x + t * y.
Proof.
  intros t x y [t0 t1] hx hy. replace ((1 - t) * x + t * y) with (x + t * (y - x)) by ring.
  destruct (Rle_lt_dec x y); [pose proof (Rmult_le_pos t (y - x) t0 ltac:(lra)); lra | nra].
Qed.

Lemma parts_decide : forall (f : (nat -> R) -> R) z holds,
  (forall q y y0 y1, (forall p, p <> q -> y0 p = y p /\ y1 p = y p) -> y0 q = -1 -> y1 q = 1 -> f y = (1 - y q) / 2 * f y0 + (1 + y q) / 2 * f y1) ->
  (forall J, holds J = true -> 0 < f (put J [] z)) ->
  forall qs J, NoDup qs -> (forall q, In q qs -> is_in q J = false) -> (forall q, In q qs -> -1 <= z q <= 1) -> at_parts qs J holds = true -> 0 < f (put J qs z).
Proof.
  intros f z holds affine H. induction qs as [| q qs IH]; intros J nd out hz h; [exact (H J h) |]. cbn [at_parts] in h. apply andb_true_iff in h as [h0 h1]. inversion nd as [| ? ? no nd']; subst.
  assert (A : 0 < f (put J qs z)) by (apply IH; [exact nd' | intros p i; apply out; right; exact i | intros p i; apply hz; right; exact i | exact h0]).
  assert (B : 0 < f (put (q :: J) qs z)).
  { apply IH; [exact nd' | | intros p i; apply hz; right; exact i | exact h1]. intros p i. cbn [Second.is_in existsb]. destruct (Nat.eqb_spec p q) as [-> |]; [contradiction | apply out; right; exact i]. }
  assert (nq : is_in q qs = false) by (destruct (is_in q qs) eqn:e; [apply is_in_iff in e; contradiction | reflexivity]).
  rewrite (affine q _ (put J qs z) (put (q :: J) qs z)).
  - assert (hq : -1 <= put J (q :: qs) z q <= 1) by (unfold put; rewrite (out q (or_introl eq_refl)); cbn [Second.is_in existsb]; rewrite Nat.eqb_refl; apply hz; left; reflexivity).
    set (t := put J (q :: qs) z q) in *. replace ((1 - t) / 2) with (1 - (1 + t) / 2) by field. apply between_positive; try assumption. lra.
  - intros p n. unfold put. cbn [Second.is_in existsb]. destruct (Nat.eqb_spec p q); [contradiction | split; reflexivity].
  - unfold put. rewrite (out q (or_introl eq_refl)), nq. reflexivity.
  - unfold put. cbn [Second.is_in existsb]. rewrite Nat.eqb_refl. reflexivity.
Qed.

(** ** Of which quantities a change is: of none that are looked at together, of one, or of two *)

Inductive kind := Alone | OfOne (p : nat) | OfTwo (p q : nat).
Definition share (z : nat -> R) (k : kind) : R := match k with Alone => 0 | OfOne p => z p | OfTwo p q => z p * z q end.
(** Without squares. *)
Definition once (z : nat -> R) (k : kind) : R := match k with OfTwo p q => if Nat.eqb p q then 0 else z p * z q | _ => share z k end.
Definition is_together (k : kind) : bool := match k with Alone => false | _ => true end.
Definition is_square (k : kind) : bool := match k with OfTwo p q => Nat.eqb p q | _ => false end.
Definition is_once (k : kind) : bool := is_together k && negb (is_square k).
Definition is_plus (J : list nat) (k : kind) : bool := match k with Alone => true | OfOne p => is_in p J | OfTwo p q => Bool.eqb (is_in p J) (is_in q J) end.
Definition quantities_of (k : kind) : list nat := match k with Alone => [] | OfOne p => [p] | OfTwo p q => [p; q] end.

Lemma once_affine : forall k q y y0 y1, (forall p, p <> q -> y0 p = y p /\ y1 p = y p) -> y0 q = -1 -> y1 q = 1 -> once y k = (1 - y q) / 2 * once y0 k + (1 + y q) / 2 * once y1 k.
Proof.
  intros k q y y0 y1 h h0 h1.
  assert (P : forall p, y0 p = (if Nat.eqb p q then -1 else y p) /\ y1 p = (if Nat.eqb p q then 1 else y p)) by (intro p; destruct (Nat.eqb_spec p q) as [-> | n]; [split; assumption | exact (h p n)]).
  destruct k as [| p | p r]; cbn [once share]; [field | |].
  - destruct (P p) as [-> ->]. destruct (Nat.eqb_spec p q) as [e |]; [rewrite e |]; field.
  - destruct (P p) as [-> ->]. destruct (P r) as [-> ->]. destruct (Nat.eqb_spec p r) as [e | n], (Nat.eqb_spec p q) as [e' |], (Nat.eqb_spec r q) as [e'' |]; subst; try congruence; field.
Qed.
Lemma once_at : forall J z k, once (put J [] z) k = if is_once k then if is_plus J k then 1 else -1 else 0.
Proof.
  assert (P : forall J z p, put J [] z p = if is_in p J then 1 else -1) by reflexivity.
  intros J z [| p | p q]; unfold is_once; cbn [once share is_together is_square is_plus andb negb]; rewrite ?P; [reflexivity | reflexivity |].
  destruct (Nat.eqb p q); [reflexivity |]. cbn [negb]. destruct (is_in p J), (is_in q J); cbn [Bool.eqb]; ring.
Qed.
Lemma once_same : forall qs z k, (forall p, In p (quantities_of k) -> In p qs) -> once (put [] qs z) k = once z k.
Proof.
  intros qs z k h. assert (P : forall p, In p (quantities_of k) -> put [] qs z p = z p) by (intros p i; unfold put; cbn [Second.is_in existsb]; rewrite (proj2 (is_in_iff p qs) (h p i)); reflexivity).
  destruct k as [| p | p q]; cbn [once share quantities_of] in *; rewrite ?P by (cbn; auto); reflexivity.
Qed.

(** Of changes with their quantities, by shares. *)
Definition weigh {A : Type} (f : kind -> R) (ps : list (kind * A)) (h : A -> R) : R := fold_right (fun p s => f (fst p) * h (snd p) + s) 0 ps.

Section Precision.
Variable bits : positive.
Local Notation contains := (contains bits).
Local Notation one := (one bits).
Local Notation triangle_in := (triangle_in bits).

(** ** Sums of changes, of a row and of a multiple of |v|^2 *)

Definition change : Type := list fixed * fixed.
Definition holds_change (c : change) (C : list R * R) : Prop := Forall2 contains (fst c) (fst C) /\ contains (snd c) (snd C).
Definition worth (first : nat) (e v : list R) (c : list R * R) : R := 2 * dot e v * dot (fst c) v + snd c * norm_from first v.

Definition plus (c d : change) : change := (merge (fun a => a) (fun a => a) add (fst c) (fst d), add (snd c) (snd d)).
Definition minus (c : change) : change := (map neg (fst c), neg (snd c)).
Lemma plus_sound : forall c d C D, holds_change c C -> holds_change d D -> exists S, holds_change (plus c d) S /\ forall f e v, worth f e v S = worth f e v C + worth f e v D.
Proof.
  intros c d [C n] [D k] [h1 h2] [k1 k2]. exists (comb 1 1 C D, n + k). split; [split |].
  - eapply merge_related; try eassumption; intros; cbv beta; rewrite ?Rmult_1_l; try assumption. apply add_sound; assumption.
  - apply add_sound; assumption.
  - intros f e v. unfold worth. cbn [fst snd]. rewrite dot_comb. ring.
Qed.
Lemma minus_sound : forall c C, holds_change c C -> exists S, holds_change (minus c) S /\ forall f e v, worth f e v S = - worth f e v C.
Proof.
  intros c [C n] [h1 h2]. cbn [fst snd] in *. exists (map (Rmult (-1)) C, - n). split; [split |].
  - cbn [minus fst]. eapply map_related; [| exact h1]. intros a x h. replace (-1 * x) with (- x) by ring. apply neg_sound, h.
  - apply neg_sound, h2.
  - intros f e v. unfold worth. cbn [fst snd]. rewrite dot_map. ring.
Qed.

(** With any of these more. *)
Fixpoint at_sums (c : change) (qs : list change) (holds : change -> bool) : bool :=
  match qs with [] => holds c | q :: qs' => at_sums c qs' holds && at_sums (plus c q) qs' holds end.
Lemma sums_decide : forall b f e v holds, (forall c C, holds c = true -> holds_change c C -> 0 < b + worth f e v C) ->
  forall qs ks, Forall2 (fun q k => is_share (fst k) /\ holds_change q (snd k)) qs ks -> forall c C, at_sums c qs holds = true -> holds_change c C -> 0 < b + worth f e v C + sum_of ks (worth f e v).
Proof.
  intros b f e v holds H qs ks h. induction h as [| q [k Q] qs ks [hk hq] h IH]; intros c C a hc; cbn [at_sums sum_of fold_right fst snd] in *.
  - pose proof (H c C a hc). lra.
  - apply andb_true_iff in a as [a0 a1]. pose proof (IH c C a0 hc) as A. destruct (plus_sound c q C Q hc hq) as [S [hs es]]. pose proof (IH _ S a1 hs) as B. rewrite es in B.
    pose proof (between_positive k _ _ hk A B) as P. unfold sum_of in P. set (s := fold_right _ _ ks) in *. lra.
Qed.

(** ** R is not less *)

(** R + e s^T + s e^T + nu J *)
Definition form_with (n first : nat) (r : triangle) (e : list fixed) (c : change) : triangle :=
  triangle_add (triangle_add r (both_of bits e (fst c))) (masked [zero] first (repeat [snd c] n)).
Lemma form_with_sound : forall n first r R0 e E c C v, Solve.is_definite bits n (form_with n first r e c) = true -> triangle_in r R0 -> Forall2 contains e E -> holds_change c C -> length v = n -> nonzero v ->
  0 < quad R0 v + worth first E v C.
Proof.
  intros n first r R0 e E c [C nu] v h hr he [h1 h2] lv nz. cbn [fst snd] in *. unfold Solve.is_definite in h. destruct (Nat.eqb_spec (length (form_with n first r e c)) n) as [l |]; [| discriminate].
  assert (J : triangle_in (masked [zero] first (repeat [snd c] n)) (masked [0] first (repeat [nu] n))).
  { clear - h2. revert first. induction n as [| n IH]; intros [| f]; cbn [repeat masked]; constructor; try exact (IH O); try exact (IH f); (constructor; [| constructor]); [exact h2 | apply zero_sound]. }
  pose proof (triangle_add_sound bits _ _ _ _ (triangle_add_sound bits _ _ _ _ hr (both_of_sound bits _ _ _ _ he h1)) J) as T.
  pose proof (related_length _ _ _ _ _ T) as lt. unfold form_with in l. pose proof (is_positive_definite_sound bits _ _ h T v ltac:(congruence) nz) as P. rewrite !quad_tcomb, quad_outer in P.
  assert (Q : quad (masked [0] first (repeat [nu] n)) v = nu * norm_from first v).
  { clear - lv. revert n first lv. induction v as [| t v IH]; intros [| n] f lv; try discriminate; [destruct f; unfold norm_from; cbn; ring |]. cbn in lv. apply Nat.succ_inj in lv.
    destruct f as [| f]; cbn [repeat masked quad row_form].
    - pose proof (IH n O lv) as K. cbn [masked] in K. rewrite K. unfold norm_from. cbn [masked dot]. ring.
    - rewrite IH by exact lv. unfold norm_from. cbn [masked dot]. ring. }
  rewrite Q in P. unfold worth. cbn [fst snd]. lra.
Qed.

(** No more than six quantities. *)
Definition most_together : nat := 6.
Definition part_of (J : list nat) (cs : list (kind * change)) : change := fold_right (fun c s => if is_once (fst c) then plus (if is_plus J (fst c) then snd c else minus (snd c)) s else s) ([], zero) cs.
Definition is_not_less (n first : nat) (r : triangle) (e : list fixed) (cs : list (kind * change)) : bool :=
  let qs := nodup Nat.eq_dec (flat_map (fun c => quantities_of (fst c)) cs) in
  let squares := map snd (filter (fun c => is_square (fst c)) cs) in
  Nat.leb (length qs) most_together && at_parts qs [] (fun J => at_sums (part_of J cs) squares (fun c => Solve.is_definite bits n (form_with n first r e c))).

Definition are_of (cs : list (kind * change)) (ps : list (kind * (list R * R))) : Prop := Forall2 (fun c p => fst c = fst p /\ holds_change (snd c) (snd p)) cs ps.
Lemma part_of_sound : forall J z cs ps, are_of cs ps -> exists C, holds_change (part_of J cs) C /\ forall f e v, worth f e v C = weigh (once (put J [] z)) ps (worth f e v).
Proof.
  intros J z cs ps h. induction h as [| [k c] [k' P] cs ps [e h1] h [C [h2 h3]]]; cbn [fst snd] in *.
  - exists ([], 0). split; [split; [constructor | apply zero_sound] |]. intros f e v. unfold worth, weigh. cbn. ring.
  - subst k'. cbn [part_of fold_right fst snd]. fold (part_of J cs). assert (W : forall f e v, weigh (once (put J [] z)) ((k, P) :: ps) (worth f e v) = (if is_once k then if is_plus J k then 1 else -1 else 0) * worth f e v P + worth f e v C)
      by (intros f e v; rewrite h3; unfold weigh; cbn [fold_right fst snd]; rewrite once_at; reflexivity).
    destruct (is_once k); [| exists C; split; [exact h2 | intros f e v; rewrite W; ring]].
    assert (Q : exists S, holds_change (if is_plus J k then c else minus c) S /\ forall f e v, worth f e v S = (if is_plus J k then 1 else -1) * worth f e v P).
    { destruct (is_plus J k); [exists P; split; [exact h1 | intros; ring] |]. destruct (minus_sound c P h1) as [S [hs es]]. exists S. split; [exact hs | intros; rewrite es; ring]. }
    destruct Q as [S [hs es]]. destruct (plus_sound _ _ S C hs h2) as [T [ht et]]. exists T. split; [exact ht |]. intros f e v. rewrite et, es, W. reflexivity.
Qed.
Lemma squares_sound : forall z cs ps, (forall p, -1 <= z p <= 1) -> are_of cs ps ->
  exists ks, Forall2 (fun q k => is_share (fst k) /\ holds_change q (snd k)) (map snd (filter (fun c => is_square (fst c)) cs)) ks /\
    forall f e v, weigh (share z) ps (worth f e v) = weigh (once z) ps (worth f e v) + sum_of ks (worth f e v).
Proof.
  intros z cs ps hz h. induction h as [| [k c] [k' P] cs ps [e h1] h [ks [h2 h3]]]; cbn [fst snd] in *.
  - exists []. split; [constructor |]. intros. unfold weigh, sum_of. cbn. ring.
  - subst k'. cbn [filter fst snd]. destruct (is_square k) eqn:s.
    + destruct k as [| | p q]; try discriminate. cbn [is_square] in s. apply Nat.eqb_eq in s as <-. exists ((z p * z p, P) :: ks). split.
      * cbn [map snd]. constructor; [| exact h2]. cbn [fst snd]. split; [| exact h1]. specialize (hz p). split; nra.
      * intros f e v. unfold weigh, sum_of in *. cbn [fold_right fst snd share once]. rewrite h3, Nat.eqb_refl. ring.
    + exists ks. split; [exact h2 |]. intros f e v. unfold weigh, sum_of in *. cbn [fold_right fst snd]. rewrite h3.
      assert (E : share z k = once z k) by (destruct k as [| | p q]; cbn [once share is_square] in *; rewrite ?s; reflexivity). rewrite E. ring.
Qed.

Theorem together : forall n first r R0 e E cs ps z v, is_not_less n first r e cs = true -> triangle_in r R0 -> Forall2 contains e E -> are_of cs ps -> (forall p, -1 <= z p <= 1) ->
  length v = n -> nonzero v -> 0 < quad R0 v + weigh (share z) ps (worth first E v).
Proof.
  intros n first r R0 e E cs ps z v h hr he hc hz lv nz. unfold is_not_less in h. cbv zeta in h. apply andb_true_iff in h as [_ h]. set (qs := nodup _ _) in h.
  destruct (squares_sound z cs ps hz hc) as [ks [h1 h2]]. rewrite h2. set (f := fun y => quad R0 v + weigh (once y) ps (worth first E v) + sum_of ks (worth first E v)).
  assert (F : 0 < f (put [] qs z)).
  { refine (parts_decide f z _ _ _ qs [] _ _ _ h).
    - intros q y y0 y1 h3 h4 h5. unfold f. assert (W : weigh (once y) ps (worth first E v) = (1 - y q) / 2 * weigh (once y0) ps (worth first E v) + (1 + y q) / 2 * weigh (once y1) ps (worth first E v)).
      { clear - h3 h4 h5. unfold weigh. induction ps as [| p ps IH]; cbn [fold_right]; [field |]. rewrite IH, (once_affine (fst p) q y y0 y1 h3 h4 h5). field. }
      rewrite W. field.
    - intros J hJ. destruct (part_of_sound J z cs ps hc) as [C [k1 k2]]. unfold f. rewrite <- k2.
      refine (sums_decide (quad R0 v) first E v _ _ _ _ h1 _ C hJ k1). intros c C' hd hC. exact (form_with_sound n first r R0 e E c C' v hd hr he hC lv nz).
    - apply NoDup_nodup.
    - reflexivity.
    - intros; apply hz. }
  assert (W : weigh (once (put [] qs z)) ps (worth first E v) = weigh (once z) ps (worth first E v)); [| unfold f in F; rewrite W in F; lra].
  assert (I : forall c p, In c cs -> In p (quantities_of (fst c)) -> In p qs) by (intros c p ic ip; apply nodup_In, in_flat_map; exists c; split; assumption).
  clearbody qs. clear - hc I. induction hc as [| c p cs ps [e _] hc IH]; [reflexivity |]. unfold weigh in *. cbn [fold_right]. rewrite IH by (intros c' p' i; apply I; right; exact i).
  rewrite once_same by (rewrite <- e; intros q i; exact (I c q (or_introl eq_refl) i)). reflexivity.
Qed.

(** ** A matrix less R, and less each of the other changes; as without R where none is given *)

Fixpoint triangle_over {A : Type} (n : nat) (l : list A) : list (list A) := match n with O => [] | S k => firstn n l :: triangle_over k (skipn n l) end.
Definition less_group (w : list fixed) (across : option (list fixed)) (first : nat) (e : list fixed) (places : N) (l : list Z) (cs : list (kind * change)) (t : triangle) : option triangle :=
  match l, filter (fun c => is_together (fst c)) cs with
  | [], [] => less_all bits w across first e (map snd cs) t
  | [], _ => None
  | _, own =>
      let n := length w in let r := triangle_over n (map (fun x => Arithmetic.dyadic x places one) l) in
      if Nat.eqb (2 * length l) (n * (n + 1)) && Nat.eqb (length e) n && is_not_less n first r e own then
        less_all bits w across first e (map snd (filter (fun c => negb (is_together (fst c))) cs)) (triangle_add t (map (map neg) r))
      else None
  end.

Definition is_so (z : nat -> R) (k : kind) (m : R) : Prop := match k with Alone => is_share m | _ => m = share z k end.
Lemma less_group_sound : forall w W across first e E places l z cs ms t t' S, less_group w across first e places l cs t = Some t' -> may_cross bits across first -> triangle_in t S ->
  Forall2 contains w W -> Forall2 contains e E -> (forall p, -1 <= z p <= 1) ->
  Forall2 (fun c m => is_so z (fst c) (fst m) /\ holds_change (snd c) (snd m)) cs ms ->
  exists S', triangle_in t' S' /\ forall v, length v = length w -> nonzero v -> quad S' v <= quad S v + sum_of ms (worth first E v).
Proof.
  intros w W across first e E places l z cs ms t t' S h ok hS hw he hz hc. unfold less_group in h. destruct l as [| x l].
  - destruct (filter _ cs) as [| c0 cs0] eqn:no in h; [| discriminate]. destruct (less_all_sound bits w W across first e E (map snd cs) ms t t' S h ok hS hw he) as [S' [h1 h2]].
    + clear - hc no. induction hc as [| [k c] m cs ms [h1 h2] hc IH]; cbn [map]; constructor; cbn [filter fst] in *; destruct k; try discriminate; [split; assumption | exact (IH no)].
    + exists S'. split; [exact h1 |]. intros v lv _. exact (h2 v lv).
  - cbv zeta in h. set (n := length w) in *. set (r := triangle_over n _) in h. destruct (_ && is_not_less n first r e _) eqn:g in h; [| discriminate]. apply andb_true_iff in g as [_ g].
    assert (hr : triangle_in r (triangle_over n (map (Y_value places) (x :: l)))).
    { unfold r. clear. generalize (x :: l). clear x l. intro l.
      assert (L : Forall2 contains (map (fun x => Arithmetic.dyadic x places one) l) (map (Y_value places) l)).
      { induction l as [| x l IH]; cbn [map]; constructor; [| exact IH]. replace (Y_value places x) with (Y_value places x * 1) by ring. apply Arithmetic.dyadic_sound, integer_sound. }
      revert L. generalize (map (fun x => Arithmetic.dyadic x places one) l), (map (Y_value places) l). clear l. induction n as [| n IH]; intros a b h; [constructor |].
      assert (K : forall k (a : list fixed) (b : list R), Forall2 contains a b -> Forall2 contains (firstn k a) (firstn k b) /\ Forall2 contains (skipn k a) (skipn k b)).
      { clear. induction k as [| k IH]; intros a b h; [split; [constructor | exact h] |]. destruct h as [| a x b y h k']; [split; constructor |]. cbn [firstn skipn]. destruct (IH _ _ k'). split; [constructor; assumption | assumption]. }
      destruct (K (Datatypes.S n) a b h) as [k1 k2]. change (triangle_in (firstn (Datatypes.S n) a :: triangle_over n (skipn (Datatypes.S n) a)) (firstn (Datatypes.S n) b :: triangle_over n (skipn (Datatypes.S n) b))).
      constructor; [exact k1 | apply IH, k2]. }
    set (R0 := triangle_over n (map (Y_value places) (x :: l))) in *.
    (* those together, and the others *)
    assert (Two : exists ps ms', are_of (filter (fun c => is_together (fst c)) cs) ps /\
      Forall2 (fun c m => is_share (fst m) /\ Forall2 contains (fst c) (fst (snd m)) /\ contains (snd c) (snd (snd m))) (map snd (filter (fun c => negb (is_together (fst c))) cs)) ms' /\
      forall h, sum_of ms h = weigh (share z) ps h + sum_of ms' h).
    { clear - hc. induction hc as [| [k c] [m C] cs ms [h1 h2] hc [ps [ms' [k1 [k2 k3]]]]]; cbn [filter fst snd] in *.
      - exists [], []. split; [constructor |]. split; [constructor |]. intro. unfold weigh, sum_of. cbn. ring.
      - destruct (is_together k) eqn:s; cbn [negb].
        + exists ((k, C) :: ps), ms'. split; [constructor; [split; [reflexivity | exact h2] | exact k1] |]. split; [exact k2 |]. intro f. specialize (k3 f). unfold weigh, sum_of in *. cbn [fold_right fst snd]. rewrite k3.
          assert (E : m = share z k) by (destruct k; [discriminate | exact h1 ..]). rewrite E. ring.
        + exists ps, ((m, C) :: ms'). split; [exact k1 |]. split; [cbn [map snd]; constructor; [split; [destruct k; [exact h1 | discriminate ..] | exact h2] | exact k2] |]. intro f. specialize (k3 f). unfold weigh, sum_of in *. cbn [fold_right fst snd]. rewrite k3. ring. }
    destruct Two as [ps [ms' [k1 [k2 k3]]]].
    assert (hT : triangle_in (triangle_add t (map (map neg) r)) (tcomb 1 1 S (map (map (Rmult (- 1))) R0))).
    { apply triangle_add_sound; [exact hS |]. eapply map_related; [| exact hr]. intros a b hab. eapply map_related; [| exact hab]. intros y u hy. replace (- 1 * u) with (- u) by ring. apply neg_sound, hy. }
    destruct (less_all_sound bits w W across first e E _ ms' _ t' _ h ok hT hw he k2) as [S' [h1 h2]]. exists S'. split; [exact h1 |]. intros v lv nz. specialize (h2 v lv).
    rewrite quad_tcomb, quad_map in h2.
    pose proof (together n first r R0 e E _ ps z v g hr he k1 hz lv nz) as P. rewrite k3. change (sum_of ms' (fun c => 2 * dot E v * dot (fst c) v + snd c * norm_from first v)) with (sum_of ms' (worth first E v)) in h2. lra.
Qed.

(** ** Rows of which some changes are looked at together *)

Definition grouped : Type := (list fixed * fixed) * list (kind * (list fixed * fixed * fixed)).
Definition grouped_in (z : nat -> R) (i : grouped) (r : list R * R * R) : Prop :=
  exists a d ms, weighted_by bits (fun _ => True) (fst i, map snd (snd i)) r a d ms /\ Forall2 (fun k m => is_so z k (fst m)) (map fst (snd i)) ms.
Lemma both_related : forall (A B C : Type) (P : A -> C -> Prop) (Q : B -> C -> Prop) cs ms, Forall2 P (map fst cs) ms -> Forall2 Q (map snd cs) ms -> Forall2 (fun c m => P (fst c) m /\ Q (snd c) m) cs ms.
Proof.
  intros A B C P Q. induction cs as [| c cs IH]; intros ms h k; inversion h; subst; inversion k; subst; constructor; [split; assumption | apply IH; assumption].
Qed.

(** Each row with what R is there over [2^pl], by rows, or nothing. *)
Fixpoint lower_grouped (w : list fixed) (across : option (list fixed)) (pl places : N) (Y : list (list Z)) (r : list (list Z * grouped)) (start : triangle) : option triangle :=
  match Y, r with
  | [], [] => Some start
  | y :: Y', (l, ((a, d), cs)) :: r' =>
      match less_group w across 0 (map (fun n => Arithmetic.dyadic n places one) y) pl l
        (map (fun c => (fst c, (map halve (residual places (fst (fst (snd c))) (snd (fst (snd c))) y), neg (snd (snd c))))) cs)
        (triangle_add start (Test.halves places y (residual places a (upper_end d) y))) with
      | Some t => lower_grouped w across pl places Y' r' t
      | None => None
      end
  | _, _ => None
  end.

Lemma lower_grouped_sound : forall w W across pl places Y z i r start S T, Forall2 contains w W -> may_cross bits across 0 -> (forall p, -1 <= z p <= 1) -> Forall2 (fun i r => grouped_in z (snd i) r) i r -> triangle_in start S ->
  lower_grouped w across pl places Y i start = Some T ->
  exists U, triangle_in T U /\ forall v, length v = length w -> nonzero v -> quad U v <= quad S v + (form (lower_weights places Y v) (map fst r) v - changed r * dot v v).
Proof.
  intros w W across pl places Y z i r start S T hw ok hz h. revert i r start S h. induction Y as [| y Y IH]; intros i r start S h hS u.
  { destruct h; [| discriminate]. injection u as <-. exists S. split; [exact hS |]. intros v _ _. cbn. lra. }
  destruct h as [| [l [[a d] cs]] [[A D] t0] i r [a0 [d0 [ms [[ha [hd [hm [eA [eD eT]]]]] hk]]]] h]; [discriminate |]. cbn [fst snd] in *.
  cbn [lower_grouped] in u. destruct (upper_end_sound bits d d0 hd) as [g [hg le]].
  destruct (less_group _ _ _ _ _ _ _ _) as [t |] eqn:el in u; [| discriminate].
  pose proof (triangle_add_sound bits _ _ _ _ hS (Test.halves_sound bits places y _ _ (residual_sound bits places a a0 _ g y ha hg))) as hT.
  assert (hY : Forall2 contains (map (fun n => Arithmetic.dyadic n places one) y) (map (Y_value places) y)).
  { clear. induction y as [| n y I]; cbn [map]; constructor; [| exact I]. replace (Y_value places n) with (Y_value places n * 1) by ring. apply Arithmetic.dyadic_sound, integer_sound. }
  set (half := fun c : list R * R * R => (map (Rmult (/ 2)) (comb 2 (- snd (fst c)) (fst (fst c)) (map (Y_value places) y)), - snd c)).
  assert (hC : Forall2 (fun c m => is_so z (fst c) (fst m) /\ holds_change (snd c) (snd m))
    (map (fun c => (fst c, (map halve (residual places (fst (fst (snd c))) (snd (fst (snd c))) y), neg (snd (snd c))))) cs) (map (fun m => (fst m, half (snd m))) ms)).
  { eapply map_related; [| exact (both_related _ _ _ _ _ _ _ hk hm)]. intros c m [h0 [_ [h2 [h3 h4]]]]. cbn [fst snd]. split; [exact h0 |]. unfold half, holds_change. cbn [fst snd]. split; [| apply neg_sound, h4].
    eapply map_related; [| apply residual_sound; eassumption]. intros b x hb. replace (/ 2 * x) with (x / 2) by (unfold Rdiv; ring). apply halve_sound, hb. }
  destruct (less_group_sound _ _ _ _ _ _ _ _ z _ _ _ _ _ el ok hT hw hY hz hC) as [S1 [h1 q1]]. destruct (IH i r t S1 h h1 u) as [U [hU q]]. exists U. split; [exact hU |].
  intros v lv nz. specialize (q v lv nz). specialize (q1 v lv nz). cbn [lower_weights map form changed fold_right fst snd]. fold (lower_weights places Y v). fold (changed r). rewrite quad_tcomb, quad_outer, dot_comb in q1.
  assert (E : dot (map (Y_value places) y) v = 2 * dot (map (Y_half places) y) v).
  { rewrite <- dot_map, map_map. f_equal. apply map_ext. exact (Y_half_eq places). }
  set (s := dot (map (Y_value places) y) v) in *. rewrite sum_mapped in q1. unfold worth in q1. change (norm_from 0 v) with (dot v v) in q1. fold s in q1.
  rewrite (sum_equal _ ms _ (fun c => 1 * (2 * s * dot (fst (fst c)) v + - s ^ 2 * snd (fst c)) + - dot v v * snd c)) in q1 by (intro c; unfold half; cbn [fst snd]; rewrite dot_map, dot_comb; fold s; field).
  rewrite sum_plus, sum_plus in q1. rewrite eA, eD, eT. replace (dot (map (Y_half places) y) v) with (s / 2) in q1 by lra. pose proof (pow2_ge_0 s). nra.
Qed.

(** Of c^2 times the multiple. *)
Fixpoint upper_grouped (w : list fixed) (c2 : fixed) (pl : N) (r : list (list Z * grouped)) (start : triangle) : option triangle :=
  match r with
  | [] => Some start
  | (l, ((a, d), cs)) :: r' =>
      let bordered := (lower_end d :: a) :: start in
      let lessened := match l, cs with
        | [], [] => Some bordered
        | _, _ => if (0 <? lo d)%Z then
            less_group (neg (Arithmetic.ratio (along bits a w) one d) :: w) None 1 (one :: map (fun _ => zero) a) pl l
              (map (fun c => (fst c, (halve (snd (fst (snd c))) :: fst (fst (snd c)), mul bits c2 (snd (snd c))))) cs) bordered
            else None
        end in
      match lessened with
      | Some t => match eliminated bits t with Some t => upper_grouped w c2 pl r' t | None => None end
      | None => None
      end
  end.

Lemma upper_grouped_sound : forall w W c2 c pl z i r start S T, Forall2 contains w W -> contains c2 c -> (forall p, -1 <= z p <= 1) -> Forall2 (fun i r => grouped_in z (snd i) r) i r -> triangle_in start S ->
  upper_grouped w c2 pl i start = Some T ->
  exists U, triangle_in T U /\ forall v x, length v = length w -> nonzero v -> quad U v <= quad S v + (form (upper_weights x) (map fst r) v + c * changed r * dot v v).
Proof.
  intros w W c2 c pl z i r start S T hw hc2 hz h. revert start S. induction h as [| [l [[a d] cs]] [[A D] t0] i r [a0 [d0 [ms [[ha [hd [hm [eA [eD eT]]]]] hk]]]] h IH]; intros start S hS u.
  - injection u as <-. exists S. split; [exact hS |]. intros v [| t x] _ _; cbn; lra.
  - cbn [upper_grouped] in u. cbn [fst snd] in *. cbv zeta in u. destruct (lower_end_sound bits d d0 hd) as [g [hg le]].
    assert (hB : triangle_in ((lower_end d :: a) :: start) ((g :: a0) :: S)) by (constructor; [constructor; assumption | exact hS]).
    match type of u with match ?x with Some _ => _ | None => _ end = _ => destruct x as [t |] eqn:el; [| discriminate u] end.
    destruct (eliminated bits t) as [t2 |] eqn:e2; [| discriminate].
    assert (L : exists S1, triangle_in t S1 /\ forall y v, length v = length w -> nonzero v ->
      quad S1 (y :: v) <= g * y ^ 2 + 2 * y * dot a0 v + quad S v + (sum_of ms (fun c => 2 * y * dot (fst (fst c)) v + y ^ 2 * snd (fst c)) + c * sum_of ms snd * dot v v)).
    { match type of el with ?x = _ => assert (Case : (l = [] /\ cs = [] /\ t = (lower_end d :: a) :: start) \/ (if (0 <? lo d)%Z then less_group (neg (Arithmetic.ratio (along bits a w) one d) :: w) None 1 (one :: map (fun _ => zero) a) pl l
        (map (fun c => (fst c, (halve (snd (fst (snd c))) :: fst (fst (snd c)), mul bits c2 (snd (snd c))))) cs) ((lower_end d :: a) :: start) else None) = Some t)
        by (destruct l; [destruct cs; [left; injection el as <-; auto |] |]; right; exact el) end. clear el. destruct Case as [[_ [-> ->]] | el].
      - inversion hm; subst. exists ((g :: a0) :: S). split; [exact hB |]. intros y v _ _. cbn [quad row_form sum_of fold_right]. lra.
      - destruct (0 <? lo d)%Z eqn:p; [| discriminate]. apply Z.ltb_lt in p.
        assert (hE : Forall2 contains (one :: map (fun _ => zero) a) (1 :: map (fun _ => 0) a)).
        { constructor; [apply integer_sound |]. clear. induction a; cbn; constructor; auto using zero_sound. }
        assert (hW : Forall2 contains (neg (Arithmetic.ratio (along bits a w) one d) :: w) (- (dot a0 W * 1 / d0) :: W)).
        { constructor; [| exact hw]. apply neg_sound, Arithmetic.ratio_sound; [exact p | apply Toward.along_sound; assumption | apply integer_sound | exact hd]. }
        assert (hC : Forall2 (fun c m => is_so z (fst c) (fst m) /\ holds_change (snd c) (snd m))
          (map (fun c => (fst c, (halve (snd (fst (snd c))) :: fst (fst (snd c)), mul bits c2 (snd (snd c))))) cs) (map (fun m => (fst m, (snd (fst (snd m)) / 2 :: fst (fst (snd m)), c * snd (snd m)))) ms)).
        { eapply map_related; [| exact (both_related _ _ _ _ _ _ _ hk hm)]. intros c' m' [h0 [_ [h2 [h3 h4]]]]. unfold holds_change. cbn [fst snd]. split; [exact h0 |].
          split; [constructor; [apply halve_sound, h3 | exact h2] | apply mul_sound; assumption]. }
        destruct (less_group_sound _ _ None _ _ _ _ _ z _ _ _ _ _ el I hB hW hE hz hC) as [S1 [h1 q]]. exists S1. split; [exact h1 |]. intros y v lv nz.
        assert (nz' : nonzero (y :: v)) by (unfold nonzero in *; cbn [dot]; pose proof (Rle_0_sqr y) as Q; unfold Rsqr in Q; lra). specialize (q (y :: v) ltac:(cbn [length]; congruence) nz').
        rewrite (sum_mapped _ _ ms (fun m : list R * R * R => (snd (fst m) / 2 :: fst (fst m), c * snd m))) in q. cbn [quad row_form] in q.
        assert (Z0 : dot (1 :: map (fun _ => 0) a) (y :: v) = y).
        { cbn [dot]. assert (N : forall (k : list fixed) v, dot (map (fun _ => 0) k) v = 0) by (induction k as [| x k I0]; intros [| y' v']; cbn [map dot]; try reflexivity; rewrite I0; ring). rewrite N. ring. }
        assert (J : norm_from 1 (y :: v) = dot v v) by (unfold norm_from; cbn [masked dot]; ring). unfold worth in q.
        rewrite (sum_equal _ _ _ (fun e => 1 * (2 * y * dot (fst (fst e)) v + y ^ 2 * snd (fst e)) + c * dot v v * snd e)) in q by (intro c'; rewrite Z0, J; cbn [dot fst snd]; field).
        rewrite sum_plus in q. lra. }
    destruct L as [S1 [h1 q1]]. clear el. revert e2 q1. destruct h1 as [| row real t S1 hr h1]; intros e2 q1; [discriminate |]. revert e2 q1. destruct hr as [| b x row u' hb hr]; intros e2 q1; [discriminate |].
    destruct (eliminated_sound bits _ _ _ _ _ _ _ e2 hb hr h1) as [x0 h2]. destruct (IH _ _ h2 u) as [U [hU q]]. exists U. split; [exact hU |].
    intros v xs lv nz.
    assert (K : forall y, quad S1 v - / x * dot u' v ^ 2 <= quad S v + (2 * y * dot A v + y ^ 2 * D + c * t0 * dot v v)).
    { intro y. specialize (q1 y v lv nz). rewrite sum_plus in q1. cbn [quad row_form] in q1. rewrite eA, eD, eT. set (k := dot u' v) in *.
      assert (0 <= / x * (x * y + k) ^ 2) by (apply Rmult_le_pos; [apply Rlt_le, Rinv_0_lt_compat, x0 | apply pow2_ge_0]).
      replace (/ x * (x * y + k) ^ 2) with (x * y ^ 2 + 2 * y * k + / x * k ^ 2) in * by (field; lra).
      assert (g * y ^ 2 <= d0 * y ^ 2) by (apply Rmult_le_compat_r; [apply pow2_ge_0 | exact le]). lra. }
    cbn [changed fold_right map fst snd]. fold (changed r).
    destruct xs as [| y xs]; cbn [upper_weights map form].
    + specialize (q v [] lv nz). rewrite quad_schur in q by lra. specialize (K 0). cbn in q. cbn. lra.
    + specialize (q v xs lv nz). rewrite quad_schur in q by lra. specialize (K y). fold (upper_weights xs). lra.
Qed.

(** ** Rows as slopes: a change of which all entries are still is of none, and all are where there is no R *)

Fixpoint kinds_for (l : list Z) (kinds : list kind) (p : nat) (r : list (multi slope) * multi slope) : list kind :=
  match kinds with
  | [] => []
  | k :: kinds' =>
      (match l with [] => Alone | _ => if forallb (fun q => is_still (nth p (snd q) (constant zero))) (snd r :: fst r) then Alone else k end) :: kinds_for l kinds' (S p) r
  end.
(** Of what is looked at together the first step alone: each other one is this or minus this. *)
Definition first_of (k : kind) (rs : list fixed) : list fixed := if is_together k then firstn 1 rs else rs.
Definition firsts (kinds : list kind) (steps : list (list fixed)) : list (list fixed) := map (fun p => first_of (fst p) (snd p)) (combine kinds steps).
Definition kinds_of (kinds : list kind) (steps : list (list fixed)) : list kind := flat_map (fun p => map (fun _ => fst p) (first_of (fst p) (snd p))) (combine kinds steps).
Definition grouped_at (places : N) (s : list bool) (steps : list (list fixed)) (ns : list Z) (kinds : list kind) (r : list (multi slope) * multi slope) : grouped :=
  let w := weighted_at bits places s (firsts kinds steps) ns r in (fst w, combine (kinds_of kinds steps) (snd w)).

Definition are_so (z : nat -> R) (kinds : list kind) (steps : list (list fixed)) (ds : list R) : Prop :=
  Forall2 (fun k s => k = Alone \/ exists y, Forall2 contains (firstn 1 (fst s)) [y] /\ snd s = share z k * y) kinds (combine steps ds).
Lemma kinds_for_so : forall z l r steps ds kinds p, are_so z kinds steps ds -> are_so z (kinds_for l kinds p r) steps ds.
Proof.
  intros z l r steps ds kinds p h. revert p. unfold are_so in *. induction h as [| k s kinds ss h1 h IH]; intro p; cbn [kinds_for]; constructor; [| apply IH].
  destruct l; [left; reflexivity |]. destruct (forallb _ _); [left; reflexivity | exact h1].
Qed.
Lemma firsts_so : forall z steps mss, Forall2 (stepped bits) steps mss -> forall kinds, are_so z kinds steps (map stride mss) ->
  exists mss', Forall2 (Forall2 (fun r (m : R * R) => True /\ contains r (snd m))) (firsts kinds steps) mss' /\ map stride mss' = map stride mss /\ Forall2 (is_so z) (kinds_of kinds steps) (map fst (concat mss')).
Proof.
  intros z steps mss h. unfold are_so, firsts, kinds_of. induction h as [| rs ms steps mss h1 h IH]; intros kinds hk; cbn [map combine] in hk; inversion hk as [| k s kinds' ss k1 hk']; subst.
  - exists []. repeat constructor.
  - destruct (IH kinds' hk') as [mss' [h2 [h3 h4]]]. cbn [fst snd] in k1. cbn [combine map flat_map fst snd]. unfold first_of at 1 3. destruct (is_together k) eqn:t.
    + destruct k1 as [-> | [y [k1 k2]]]; [discriminate |]. exists ([(share z k, y)] :: mss'). destruct rs as [| r rs]; cbn [firstn] in *; inversion k1 as [| ? ? ? ? k3 _]; subst. split; [| split].
      * constructor; [| exact h2]. constructor; [split; [exact I | exact k3] | constructor].
      * cbn [map]. rewrite h3, k2. f_equal. unfold stride. cbn. ring.
      * cbn [map app concat fst]. constructor; [destruct k; [discriminate | reflexivity ..] | exact h4].
    + destruct k; try discriminate. exists (ms :: mss'). split; [| split].
      * constructor; [| exact h2]. clear - h1. induction h1 as [| r m rs ms [_ h] h1 IH]; constructor; [split; [exact I | exact h] | exact IH].
      * cbn [map]. rewrite h3. reflexivity.
      * cbn [concat]. rewrite map_app. apply Forall2_app; [| exact h4]. clear - h1. induction h1 as [| r m rs ms [h _] h1 IH]; cbn [map]; constructor; assumption.
Qed.

Lemma grouped_at_sound : forall places s steps ns kinds z l r a d mss, Forall2 (multi_in bits) (fst r) a -> multi_in bits (snd r) d -> Forall2 (stepped bits) steps mss -> are_so z kinds steps (map stride mss) ->
  let lambda := map corner s in let m e := at_lambda lambda (moved (fst e) (map stride mss) (snd e)) in
  grouped_in z (grouped_at places s steps ns (kinds_for l kinds 0 r) r) (map m a, m d, dot (map (Y_value places) ns) (map stride mss)).
Proof.
  intros places s steps ns kinds z l r a d mss ha hd hm hk lambda m. unfold grouped_at. set (ks := kinds_for l kinds 0 r). destruct (firsts_so z steps mss hm ks (kinds_for_so z l r steps _ kinds 0 hk)) as [mss' [f1 [f2 K]]].
  destruct (weighted_at_shares bits (fun _ => True) places s (firsts ks steps) ns r a d mss' ha hd f1) as [a0 [d0 [ms [h1 h2]]]]. cbv zeta in h1. rewrite f2 in h1. rewrite <- h2 in K. exists a0, d0, ms.
  assert (L : length (kinds_of ks steps) = length (snd (weighted_at bits places s (firsts ks steps) ns r))).
  { rewrite (related_length _ _ _ _ _ K), map_length. symmetry. exact (related_length _ _ _ _ _ (proj1 (proj2 (proj2 h1)))). }
  assert (C : forall (A B : Type) (x : list A) (y : list B), length x = length y -> map fst (combine x y) = x /\ map snd (combine x y) = y).
  { clear. induction x as [| b x IH]; intros [| c y] e; try discriminate; [split; reflexivity |]. cbn in e. destruct (IH y ltac:(congruence)) as [I J]. cbn [combine map fst snd]. rewrite I, J. split; reflexivity. }
  cbn [fst snd]. destruct (C _ _ _ _ L) as [-> ->]. split; [exact h1 |]. clear - K. revert K. generalize (kinds_of ks steps). induction ms as [| m ms IH]; intros own K; inversion K; subst; constructor; [assumption | apply IH; assumption].
Qed.

(** ** Shares of first steps: of parameters of second order in the middle *)

Section Ends.
Variables (ends : list (nat * choice)) (curved : list nat).
Definition is_middle (p : nat) : bool := match nth p ends (O, FromLeast) with (j, FromMiddle) => is_in j curved | _ => false end.
Definition kinds : list kind :=
  map (fun p => if is_middle p then OfOne p else Alone) (seq 0 (length ends)) ++
  map (fun k => if is_middle (fst k) && is_middle (snd k) then OfTwo (fst k) (snd k) else Alone) (Second.pairs ends curved).

Theorem shares_sound : forall params theta0 theta mss, Forall2 (stepped bits) (Tolerances.steps ends params) mss ->
  Forall2 (fun e ms => nth (fst e) theta 0 - nth (fst e) theta0 0 = stride ms) ends mss ->
  exists z, (forall p, -1 <= z p <= 1) /\ are_so z kinds (Second.steps bits ends curved params) (Second.differences ends curved theta0 theta).
Proof.
  intros params theta0 theta mss h d. unfold Second.steps, Second.differences. cbv zeta. set (ss := Tolerances.steps ends params) in *. pose proof (unit_R_pos bits) as u.
  assert (ed : map (fun e => nth (fst e) theta 0 - nth (fst e) theta0 0) ends = map stride mss) by (clear h ss; induction d as [| e ms es mss h d IH]; [reflexivity |]; cbn [map]; rewrite h, IH; reflexivity).
  rewrite ed. set (ds := map stride mss). assert (lm : length ends = length mss) by exact (related_length _ _ _ _ _ d).
  set (z := fun p => match nth p mss [] with [m; m'] => fst m - fst m' | _ => 0 end). exists z.
  assert (N : forall p, stepped bits (nth p ss []) (nth p mss [])) by (intro p; clear - h; revert p; induction h as [| s ms ss mss h1 h IH]; intros [| p]; cbn [nth]; auto; constructor).
  assert (D : forall p, nth p ds 0 = stride (nth p mss [])) by (intro p; exact (map_nth stride mss [] p)).
  assert (One : forall p, is_middle p = true -> exists r rs y, nth p ss [] = r :: rs /\ contains r y /\ nth p ds 0 = z p * y).
  { intros p o. rewrite D. unfold is_middle in o. destruct (nth p ends (O, FromLeast)) as [j c] eqn:e. destruct c; try discriminate. assert (l : (p < length ends)%nat) by (apply Nat.nle_gt; intro n; rewrite nth_overflow in e by exact n; discriminate).
    assert (E : nth p ss [] = snd (start (nth j params zero) FromMiddle)).
    { unfold ss, Tolerances.steps. set (f := fun e : nat * choice => snd (start (nth (fst e) params zero) (snd e))). rewrite (nth_indep _ _ (f (O, FromLeast))) by (rewrite map_length; exact l). rewrite map_nth, e. reflexivity. }
    specialize (N p). unfold z. rewrite E in *. cbn [start snd] in *. set (n := (hi _ - _)%Z) in *. clear - N u. revert N. generalize (nth p mss []). intros ms N.
    inversion N as [| ? [m r] ? ? [h1 h2] h3]; subst. inversion h3 as [| ? [m' r'] ? ? [k1 k2] k3]; subst. inversion k3; subst. cbn [fst snd] in *. eexists _, _, r. split; [reflexivity |]. split; [exact h2 |].
    assert (e : r' = - r); [| subst r'; unfold stride; cbn; ring].
    destruct h2 as [l1 l2], k2 as [g1 g2]. cbn [lo hi] in *. match type of g1 with IZR ?z <= _ => replace z with (- n)%Z in g1, g2 by (unfold n; lia) end. rewrite opp_IZR in g1, g2. apply Rmult_eq_reg_r with (unit_R bits); lra. }
  split.
  - intro p. unfold z. specialize (N p). destruct (nth p mss []) as [| m [| m' [|]]]; try lra. inversion N as [| ? ? ? ? [h1 _] h2]; subst. inversion h2 as [| ? ? ? ? [k1 _] _]; subst. destruct h1, k1. lra.
  - unfold are_so. assert (A : forall (A B : Type) (a c : list A) (b e : list B), length a = length b -> combine (a ++ c) (b ++ e) = combine a b ++ combine c e).
    { clear. induction a as [| x a IH]; intros c [| y b] e l; try discriminate; [reflexivity |]. cbn [app combine]. rewrite IH by (cbn in l; congruence). reflexivity. }
    assert (M : forall (A B C : Type) (f : A -> B) (g : A -> C) l, combine (map f l) (map g l) = map (fun a => (f a, g a)) l) by (clear; induction l as [| a l IH]; [reflexivity |]; cbn [map combine]; rewrite IH; reflexivity).
    rewrite A by (unfold ss, Tolerances.steps, ds; rewrite !map_length; exact lm). unfold kinds. apply Forall2_app.
    + rewrite <- (Second.as_seq _ [] ss), <- (Second.as_seq _ 0 ds). replace (length ss) with (length ends) by (symmetry; apply map_length). replace (length ds) with (length ends) by (unfold ds; rewrite map_length; exact lm). rewrite M.
      generalize (seq 0 (length ends)). induction l as [| p l I]; cbn [map]; constructor; [| exact I]. destruct (is_middle p) eqn:o; [right | left; reflexivity]. destruct (One p o) as [r [rs [y [e [k1 k2]]]]]. exists y. cbn [fst snd share]. rewrite e. cbn [firstn]. split; [constructor; [exact k1 | constructor] | exact k2].
    + rewrite M. generalize (Second.pairs ends curved). induction l as [| [p q] l I]; cbn [map]; constructor; [| exact I]. cbn [fst snd]. destruct (is_middle p && is_middle q) eqn:o; [right | left; reflexivity].
      apply andb_true_iff in o as [o1 o2]. destruct (One p o1) as [r [rs [y [e1 [e2 e3]]]]]. destruct (One q o2) as [r' [rs' [y' [e1' [e2' e3']]]]]. unfold Second.product, Second.difference. cbn [fst snd share]. rewrite e3, e3', e1, e1'. destruct (Nat.eqb_spec p q) as [<- | n].
      * exists (y * y / 2). cbn [firstn]. split; [constructor; [apply halve_sound, mul_sound; exact e2 | constructor] | field].
      * exists (y * y'). cbn [flat_map map app firstn]. split; [constructor; [apply mul_sound; assumption | constructor] | ring].
Qed.
End Ends.
End Precision.
