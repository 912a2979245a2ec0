(** * Orientations as polynomials of coordinates, and the box and inequality of a set (orientation.rs)

    R = N/w, of degree two at most in each coordinate.  Coordinates of rotations
    about any axis, and of tilt and torsion, are those along the axis (Rodrigues):
    the set is where g >= 0 in its box. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 Kinematics Fixed Claim.
From Orthocert.kernel Require Import Arithmetic Check Number Trig Formula Machine Witness Orientation.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** ** Formulas *)

Record emat := EMat { erow1 : evec; erow2 : evec; erow3 : evec }.
Definition eweight (t : formula) : formula := plus (integer 1) (square t).
Definition eabout (k : nat) (t : formula) : emat :=
  let w := eweight t in let c := minus (integer 1) (square t) in let s := times (integer 2) t in let z := integer 0 in
  match k with
  | 0%nat => EMat (EVec w z z) (EVec z c (opposite s)) (EVec z s c)
  | 1%nat => EMat (EVec c z s) (EVec z w z) (EVec (opposite s) z c)
  | _ => EMat (EVec c (opposite s) z) (EVec s c z) (EVec z z w)
  end.
Definition emulv (M : emat) (u : evec) : evec := EVec (Machine.product (erow1 M) u) (Machine.product (erow2 M) u) (Machine.product (erow3 M) u).
Definition emulm (A B : emat) : emat :=
  let column f := EVec (f (erow1 B)) (f (erow2 B)) (f (erow3 B)) in
  let row u := EVec (Machine.product u (column ex)) (Machine.product u (column ey)) (Machine.product u (column ez)) in
  EMat (row (erow1 A)) (row (erow2 A)) (row (erow3 A)).
(** Along the axis. *)
Definition erodrigues (c : evec) : emat :=
  let q := Machine.product c c in let x := ex c in let y := ey c in let z := ez c in
  let own a := plus (minus (integer 1) q) (times (integer 2) (square a)) in
  let off join a b d := times (integer 2) (join (times a b) d) in
  EMat (EVec (own x) (off minus x y z) (off plus x z y)) (EVec (off plus x y z) (own y) (off minus y z x))
    (EVec (off minus x z y) (off plus y z x) (own z)).

(** N and w of these coordinates. *)
Definition chart (o : orientations) (first : nat) : emat * formula :=
  let c k := F (Coord (first + k)) in
  match o with
  | TurnedBy _ => (eabout 2 (c 0%nat), eweight (c 0%nat))
  | RollPitchYaw _ _ _ =>
      (emulm (eabout 2 (c 2%nat)) (emulm (eabout 1 (c 1%nat)) (eabout 0 (c 0%nat))),
       times (eweight (c 2%nat)) (times (eweight (c 1%nat)) (eweight (c 0%nat))))
  | TurnedUpTo _ | Tilted _ _ =>
      let u := EVec (c 0%nat) (c 1%nat) (c 2%nat) in (erodrigues u, plus (integer 1) (Machine.product u u))
  end.

(** The angle of which the half tangent t is in g, and g, in which t is parameter [j]. *)
Definition curved (o : orientations) : list number := match o with TurnedUpTo a | Tilted a _ => [a] | _ => [] end.
Definition curve (o : orientations) (first j : nat) : option formula :=
  let c k := F (Coord (first + k)) in let t2 := square (F (Param j)) in
  match o with
  | TurnedUpTo _ => let u := EVec (c 0%nat) (c 1%nat) (c 2%nat) in Some (minus t2 (Machine.product u u))
  | Tilted _ _ => Some (minus (minus (times t2 (plus (integer 1) (square (c 2%nat)))) (square (c 0%nat))) (square (c 1%nat)))
  | _ => None
  end.

Section Values.
Variables x theta : list R.
Local Notation value := (Formula.value x theta).
Definition val3 (u : evec) : vec := Vec (value (ex u)) (value (ey u)) (value (ez u)).
Definition valm (M : emat) : mat := Mat (val3 (erow1 M)) (val3 (erow2 M)) (val3 (erow3 M)).

Lemma value_dot : forall u v, value (Machine.product u v) = Vec3.dot (val3 u) (val3 v).
Proof. intros. unfold Machine.product. rewrite !value_plus, !value_times. reflexivity. Qed.
Lemma val3_mulv : forall M u, val3 (emulv M u) = mulv (valm M) (val3 u).
Proof. intros. unfold emulv, mulv. unfold val3 at 1. cbn [ex ey ez]. rewrite !value_dot. reflexivity. Qed.
Lemma valm_mulm : forall A B, valm (emulm A B) = mulm (valm A) (valm B).
Proof.
  intros A B. unfold emulm, mulm, valm at 1. cbv zeta. cbn [erow1 erow2 erow3]. unfold val3 at 1 2 3. cbn [ex ey ez]. rewrite !value_dot.
  unfold valm, mulv, transpose, col1, col2, col3, val3, Vec3.dot. cbn [row1 row2 row3 vx vy vz ex ey ez]. f_equal; f_equal; ring.
Qed.

Lemma value_weight : forall t, value (eweight t) = 1 + value t ^ 2.
Proof. intro t. unfold eweight. rewrite value_plus, Formula.value_square. reflexivity. Qed.

Lemma valm_about : forall t a, is_half_tangent (value t) a ->
  valm (eabout 0 t) = mscale (1 + value t ^ 2) (rotation_x (in_degrees a)) /\
  valm (eabout 1 t) = mscale (1 + value t ^ 2) (rotation_y (in_degrees a)) /\
  valm (eabout 2 t) = mscale (1 + value t ^ 2) (rotation_z (in_degrees a)).
Proof.
  intros t a [C S]. pose proof (pow2_ge_0 (value t)) as t0. unfold valm, eabout, rotation_x, rotation_y, rotation_z. cbv zeta. cbn [erow1 erow2 erow3].
  rewrite C, S. unfold val3. cbn [ex ey ez]. rewrite !value_weight, !value_opposite, !value_minus, !value_times, !Formula.value_square.
  change (value (integer 0)) with 0. change (value (integer 1)) with 1. change (value (integer 2)) with 2.
  repeat split; apply mscale_ext; unfold vscale; cbn [vx vy vz]; f_equal; field; lra.
Qed.
Lemma valm_rodrigues : forall c, valm (erodrigues c) = rodrigues (val3 c).
Proof.
  intros [a b c]. unfold valm, erodrigues, rodrigues, val3, norm2. cbv zeta. cbn [erow1 erow2 erow3 ex ey ez vx vy vz].
  repeat rewrite ?value_times, ?value_plus, ?value_minus, ?Formula.value_square, ?value_dot. unfold Vec3.dot, val3. cbn [ex ey ez vx vy vz].
  change (value (integer 1)) with 1. change (value (integer 2)) with 2. f_equal; f_equal; ring.
Qed.
End Values.

(** ** The box *)

Definition angles_of (o : orientations) : list tolerance :=
  match o with TurnedBy t => [t] | RollPitchYaw r p y => [r; p; y] | TurnedUpTo a => [either_way a] | Tilted a s => [either_way a; either_way s] end.
Definition are_angles (o : orientations) : Prop := Forall (fun t => is_angle (Claim.value (least t)) /\ is_angle (Claim.value (greatest t))) (angles_of o).

(** With tangents t and s of halves: t, or t sqrt(1 + s^2), which c_1 and c_2 of a tilt do not exceed. *)
Inductive chart_end := HalfTangent (x : number) | TiltReach (tilt torsion : number).
Definition half_tangents (t : tolerance) : chart_end * chart_end := (HalfTangent (least t), HalfTangent (greatest t)).
Definition chart_ends (o : orientations) : list (chart_end * chart_end) :=
  match o with
  | TurnedBy t => [half_tangents t]
  | RollPitchYaw r p y => [half_tangents r; half_tangents p; half_tangents y]
  | TurnedUpTo a => let e := half_tangents (either_way a) in [e; e; e]
  | Tilted a s => let e := (TiltReach (least (either_way a)) s, TiltReach a s) in [e; e; half_tangents (either_way s)]
  end.
Definition end_value (e : chart_end) : R :=
  match e with
  | HalfTangent x => tangent (Claim.value x)
  | TiltReach x y => tangent (Claim.value x) * sqrt (1 + tangent (Claim.value y) ^ 2)
  end.
Definition in_box (o : orientations) (cs : list R) : Prop := Forall2 (fun e c => end_value (fst e) <= c <= end_value (snd e)) (chart_ends o) cs.

Lemma opposite_value : forall x, Claim.value (Minus (0 // 1) x) = - Claim.value x.
Proof. intro x. cbn [Claim.value]. lra. Qed.

Lemma square_between : forall x t, 0 <= t -> x ^ 2 <= t ^ 2 -> - t <= x <= t.
Proof. intros x t t0 h. split; nra. Qed.

(** In some coordinates of the box N = w Q, and g is not negative. *)
Lemma chart_sound : forall o Q, in_orientations o Q -> are_angles o -> exists cs w, in_box o cs /\ 0 < w /\
  forall x theta first j, (forall k, (k < length cs)%nat -> nth (first + k) x 0 = nth k cs 0) -> (forall a, In a (curved o) -> nth j theta 0 = tangent (Claim.value a)) ->
    valm x theta (fst (chart o first)) = mscale w Q /\ Formula.value x theta (snd (chart o first)) = w /\
    forall g, curve o first j = Some g -> 0 <= Formula.value x theta g.
Proof.
  assert (B : forall t a, is_angle (Claim.value (least t)) /\ is_angle (Claim.value (greatest t)) -> within t a ->
    is_angle a /\ tangent (Claim.value (least t)) <= tangent a <= tangent (Claim.value (greatest t))).
  { intros t a [[h1 h2] [h3 h4]] [l g]. assert (is_angle a) by (split; lra). split; [assumption |].
    split; apply tangent_increases; try assumption; split; assumption. }
  assert (C : forall x theta first c, (forall k, (k < 3)%nat -> nth (first + k) x 0 = nth k [vx c; vy c; vz c] 0) ->
    val3 x theta (EVec (F (Coord (first + 0))) (F (Coord (first + 1))) (F (Coord (first + 2)))) = c).
  { intros x theta first [p q r] h. unfold val3. cbn [ex ey ez Formula.value map_op real_op]. rewrite (h 0%nat), (h 1%nat), (h 2%nat) by lia. reflexivity. }
  intros [t | r p y | m | m n] Q h ok; unfold are_angles, in_box in *; cbn [angles_of chart fst snd curved curve chart_ends half_tangents end_value] in *.
  - destruct h as [a [ha ->]]. inversion ok as [| ? ? o1 _]. subst. destruct (B t a o1 ha) as [ia ba].
    exists [tangent a], (1 + tangent a ^ 2). split; [constructor; [exact ba | constructor] |]. split; [pose proof (pow2_ge_0 (tangent a)); lra |].
    intros x theta first j hx _. assert (V : Formula.value x theta (F (Coord (first + 0))) = tangent a) by exact (hx 0%nat ltac:(cbn; lia)).
    pose proof (tangent_is a ia) as T. rewrite <- V in T. destruct (valm_about x theta _ a T) as [_ [_ M]]. rewrite V in M. split; [exact M |].
    split; [rewrite value_weight, V; reflexivity | discriminate].
  - destruct h as [a [b [c [ha [hb [hc ->]]]]]]. inversion ok as [| ? ? o1 ok1]. inversion ok1 as [| ? ? o2 ok2]. inversion ok2 as [| ? ? o3 _]. subst.
    destruct (B r a o1 ha) as [ia ba]. destruct (B p b o2 hb) as [ib bb]. destruct (B y c o3 hc) as [ic bc].
    exists [tangent a; tangent b; tangent c], ((1 + tangent c ^ 2) * ((1 + tangent b ^ 2) * (1 + tangent a ^ 2))).
    split; [repeat (constructor; [assumption |]); constructor |].
    pose proof (pow2_ge_0 (tangent a)). pose proof (pow2_ge_0 (tangent b)). pose proof (pow2_ge_0 (tangent c)).
    split; [apply Rmult_lt_0_compat; [lra | apply Rmult_lt_0_compat; lra] |].
    intros x theta first j hx _. assert (Va : Formula.value x theta (F (Coord (first + 0))) = tangent a) by exact (hx 0%nat ltac:(cbn; lia)).
    assert (Vb : Formula.value x theta (F (Coord (first + 1))) = tangent b) by exact (hx 1%nat ltac:(cbn; lia)).
    assert (Vc : Formula.value x theta (F (Coord (first + 2))) = tangent c) by exact (hx 2%nat ltac:(cbn; lia)).
    pose proof (tangent_is a ia) as Ta. rewrite <- Va in Ta. destruct (valm_about x theta _ a Ta) as [Ma _].
    pose proof (tangent_is b ib) as Tb. rewrite <- Vb in Tb. destruct (valm_about x theta _ b Tb) as [_ [Mb _]].
    pose proof (tangent_is c ic) as Tc. rewrite <- Vc in Tc. destruct (valm_about x theta _ c Tc) as [_ [_ Mc]].
    rewrite !valm_mulm, Ma, Mb, Mc, !mulm_scaled, !value_times, !value_weight, Va, Vb, Vc. split; [reflexivity | split; [reflexivity | discriminate]].
  - inversion ok as [| ? ? [_ im] _]. subst. cbn [either_way greatest] in im.
    assert (m0 : 0 <= Claim.value m) by (destruct h as [? [? [_ [? _]]]]; lra).
    destruct (up_to_coordinates m Q h im) as [c [e le]]. pose proof (tangent_nonneg _ m0 im) as t0.
    exists [vx c; vy c; vz c], (1 + norm2 c). pose proof (norm2_nonneg c). split.
    { unfold norm2 in le. pose proof (pow2_ge_0 (vx c)). pose proof (pow2_ge_0 (vy c)). pose proof (pow2_ge_0 (vz c)).
      repeat (constructor; [cbn [half_tangents fst snd end_value either_way least greatest]; rewrite opposite_value, tangent_opposite by exact im;
        apply square_between; [exact t0 | lra] |]). constructor. }
    split; [lra |]. intros x theta first j hx ht. pose proof (C x theta first c hx) as V. specialize (ht m (or_introl eq_refl)).
    rewrite valm_rodrigues, value_plus, value_dot, V, <- norm2_dot. split; [exact e |]. split; [reflexivity |].
    intros g eg. injection eg as <-. rewrite value_minus, Formula.value_square, value_dot, V, <- norm2_dot. cbn [Formula.value map_op real_op]. rewrite ht. lra.
  - inversion ok as [| ? ? [_ im] ok1]. inversion ok1 as [| ? ? [_ is] _]. subst. cbn [either_way greatest] in im, is.
    assert (m0 : 0 <= Claim.value m) by (destruct h as [? [? [? [? _]]]]; lra).
    destruct (tilt_coordinates m n Q h im is) as [c [e [le lz]]]. pose proof (tangent_nonneg _ m0 im) as t0.
    exists [vx c; vy c; vz c], (1 + norm2 c). pose proof (norm2_nonneg c). split.
    { pose proof (pow2_ge_0 (vx c)). pose proof (pow2_ge_0 (vy c)). pose proof (pow2_ge_0 (tangent (Claim.value n))) as s0.
      assert (z2 : vz c ^ 2 <= tangent (Claim.value n) ^ 2) by nra. pose proof (sqrt_pos (1 + tangent (Claim.value n) ^ 2)) as r0.
      assert (R2 : (tangent (Claim.value m) * sqrt (1 + tangent (Claim.value n) ^ 2)) ^ 2 = tangent (Claim.value m) ^ 2 * (1 + tangent (Claim.value n) ^ 2))
        by (rewrite Rpow_mult_distr, pow2_sqrt by lra; reflexivity).
      assert (le' : tangent (Claim.value m) ^ 2 * (1 + vz c ^ 2) <= tangent (Claim.value m) ^ 2 * (1 + tangent (Claim.value n) ^ 2))
        by (apply Rmult_le_compat_l; [apply pow2_ge_0 | lra]).
      do 2 (constructor; [cbn [half_tangents fst snd end_value either_way least greatest]; rewrite opposite_value, tangent_opposite, Ropp_mult_distr_l_reverse by assumption;
        apply square_between; [apply Rmult_le_pos; assumption | lra] |]).
      constructor; [| constructor]. cbn [half_tangents fst snd end_value either_way least greatest]. rewrite opposite_value, tangent_opposite by assumption. exact lz. }
    split; [lra |]. intros x theta first j hx ht. pose proof (C x theta first c hx) as V. specialize (ht m (or_introl eq_refl)).
    rewrite valm_rodrigues, value_plus, value_dot, V, <- norm2_dot. split; [exact e |]. split; [reflexivity |].
    intros g eg. injection eg as <-. pose proof (f_equal vx V) as V1. pose proof (f_equal vy V) as V2. pose proof (f_equal vz V) as V3.
    unfold val3 in V1, V2, V3. cbn [ex ey ez vx vy vz] in V1, V2, V3.
    rewrite !value_minus, value_times, value_plus, !Formula.value_square, V1, V2, V3. cbn [Formula.value map_op real_op integer]. rewrite ht. lra.
Qed.

Lemma curved_angles : forall o a, are_angles o -> In a (curved o) -> is_angle (Claim.value a).
Proof.
  intros o a ok i. unfold are_angles in ok. rewrite Forall_forall in ok. apply (ok (either_way a)).
  destruct o; cbn [curved angles_of In] in *; try contradiction; destruct i as [-> | []]; left; reflexivity.
Qed.

Section Precision.
Variable bits : positive.

Definition enclose_end (e : chart_end) : option fixed :=
  match e with
  | HalfTangent x => enclose_tangent bits x
  | TiltReach x y =>
      match enclose_tangent bits x, enclose_tangent bits y with
      | Some t, Some s => option_map (mul bits t) (Fixed.root bits (add (Fixed.integer bits 1) (sqr bits s)))
      | _, _ => None
      end
  end.
Definition end_box (e : chart_end * chart_end) : option fixed :=
  match enclose_end (fst e), enclose_end (snd e) with Some a, Some b => Some (Fixed (lo a) (hi b)) | _, _ => None end.
Definition angles_in (e : chart_end) : list number := match e with HalfTangent x => [x] | TiltReach x y => [x; y] end.

Lemma enclose_end_sound : forall e a, enclose_end e = Some a -> Forall (fun x => is_angle (Claim.value x)) (angles_in e) -> contains bits a (end_value e).
Proof.
  intros [x | x y] a h ok; cbn [enclose_end angles_in end_value] in *; inversion ok as [| ? ? ix ok1]; subst; [exact (enclose_tangent_sound bits _ _ h ix) |].
  inversion ok1 as [| ? ? iy _]. subst. destruct (enclose_tangent bits x) as [t |] eqn:et; [| discriminate].
  destruct (enclose_tangent bits y) as [s |] eqn:es; [| discriminate]. destruct (Fixed.root bits _) as [r |] eqn:er; [| discriminate].
  injection h as <-. apply mul_sound; [exact (enclose_tangent_sound bits _ _ et ix) |].
  apply (root_sound bits _ _ _ er). apply add_sound; [apply Fixed.integer_sound | apply sqr_sound, (enclose_tangent_sound bits _ _ es iy)].
Qed.

Lemma box_sound : forall o cs box, are_angles o -> in_box o cs -> all_some (map end_box (chart_ends o)) = Some box -> Forall2 (contains bits) box cs.
Proof.
  assert (K : forall es cs, Forall2 (fun e c => end_value (fst e) <= c <= end_value (snd e)) es cs ->
    Forall (fun e => Forall (fun x => is_angle (Claim.value x)) (angles_in (fst e) ++ angles_in (snd e))) es ->
    forall box, all_some (map end_box es) = Some box -> Forall2 (contains bits) box cs).
  { induction 1 as [| e c es cs hc h IH]; intros ok box q; cbn [map all_some] in q; [injection q as <-; constructor |].
    inversion ok as [| ? ? o1 ok']. subst. apply Forall_app in o1 as [o1 o2]. unfold end_box in q at 1.
    destruct (enclose_end (fst e)) as [a |] eqn:ea; [| discriminate]. destruct (enclose_end (snd e)) as [b |] eqn:eb; [| discriminate].
    destruct (all_some _) as [r |]; [| discriminate]. injection q as <-. constructor; [| exact (IH ok' r eq_refl)].
    destruct (enclose_end_sound _ _ ea o1) as [l _]. destruct (enclose_end_sound _ _ eb o2) as [_ u].
    pose proof (unit_R_pos bits). unfold contains. cbn [lo hi]. split; nra. }
  intros o cs box ok h. apply (K _ _ h). unfold are_angles in ok. rewrite Forall_forall in ok.
  assert (A : forall t, In t (angles_of o) -> is_angle (Claim.value (least t)) /\ is_angle (Claim.value (greatest t))) by exact ok.
  destruct o as [t | r p y | m | m n]; cbn [angles_of chart_ends] in *; repeat constructor; cbn [angles_in half_tangents fst snd app] in *;
    try (apply A; cbn [In]; tauto).
  all: first [apply (A (either_way m)); cbn [In]; tauto | apply (A (either_way n)); cbn [In]; tauto].
Qed.

Lemma tangents_in : forall l ts, (forall a, In a l -> is_angle (Claim.value a)) -> all_some (map (enclose_tangent bits) l) = Some ts ->
  Forall2 (contains bits) ts (map (fun a => tangent (Claim.value a)) l).
Proof.
  induction l as [| a l IH]; intros ts A e; cbn [map all_some] in *; [injection e as <-; constructor |].
  destruct (enclose_tangent bits a) as [t |] eqn:et; [| discriminate]. destruct (all_some _) as [r |]; [| discriminate]. injection e as <-.
  constructor; [exact (enclose_tangent_sound bits _ _ et (A a (or_introl eq_refl))) | apply IH; [intros b i; apply A; right; exact i | reflexivity]].
Qed.
End Precision.
End Named.
