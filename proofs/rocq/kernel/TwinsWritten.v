(** * Two points of a mechanism by formulas with the same joint coordinates

    As in Twins.v, of numbers that are written. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool String.
From Orthocert Require Import Claim.
From Orthocert.kernel Require Import Statement Number Witness Configuration Same Twins Written AtPoint FarWritten.
From Orthocert.kernel Require Linear.
Import ListNotations.
Local Open Scope list_scope.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

(** Two points of the box, at which all is defined, with the same joint coordinates. *)
Definition has_two_points {names : naming} (c : written_claim) : Prop :=
  let m := by_formulas c in one_to_one c = true /\ exists theta x y, is_about_written c theta x /\ Forall2 within (box_of c) y /\
    is_reached m theta x /\ is_reached m theta y /\ joint_values m theta y = joint_values m theta x /\ y <> x.

(** Divisors that are certainly not zero, and radicands that are certainly positive. *)
Section Sure.
Variable sure : number -> bool.
Fixpoint is_sure (env : environment number) (e : written) : bool :=
  match e with
  | Constant _ | Named _ => true
  | Opposite a | Raised a _ => is_sure env a
  | Sum a b | Difference a b | Product a b => is_sure env a && is_sure env b
  | Quotient a b => is_sure env a && is_sure env b && (let d := number_at env b in sure d || sure (Minus (0 // 1) d))
  | RootOf a => is_sure env a && sure (number_at env a)
  end.
Fixpoint are_sure (env : environment number) (ds : list (string * written)) : bool :=
  match ds with [] => true | (n, e) :: ds' => is_sure env e && are_sure ((n, number_at env e) :: env) ds' end.
Definition all_sure (m : mechanism) (thetas xs : list number) (es : list written) : bool :=
  are_sure (given m xs thetas) (definitions m) && forallb (is_sure (numbers_at m thetas xs)) es.

Variable other : naming.
Context {names : naming}.
Hypothesis sure_sound : forall x, sure x = true -> 0 < @Claim.value other x.
Lemma is_sure_sound : forall env renv e, stand_for other env renv -> is_constant e = true -> is_sure env e = true -> is_defined renv e.
Proof.
  intros env renv e agree. induction e as [c | n | a IH | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IHa b IHb | a IH n | a IH]; intros k h; cbn [is_sure is_constant is_defined] in *; try exact I; try (apply IH; assumption);
    try (apply andb_true_iff in k as [k1 k2]; apply andb_true_iff in h as [h1 h2]; split; [apply IHa | apply IHb]; assumption).
  - apply andb_true_iff in k as [k1 k2]. apply andb_true_iff in h as [h s]. apply andb_true_iff in h as [h1 h2]. split; [apply IHa; assumption |]. split; [apply IHb; assumption |].
    cbv zeta in s. rewrite <- (number_at_is other env renv b agree k2). apply orb_true_iff in s as [s | s]; apply sure_sound in s; cbn [Claim.value] in s; lra.
  - apply andb_true_iff in h as [h s]. split; [apply IH; assumption |]. rewrite <- (number_at_is other env renv a agree k). exact (sure_sound _ s).
Qed.
Lemma are_sure_sound : forall ds env renv, stand_for other env renv -> forallb (fun d => is_constant (snd d)) ds = true -> are_sure env ds = true -> all_defined renv ds.
Proof.
  induction ds as [| [n e] ds IH]; intros env renv agree k h; [exact I |]. cbn [forallb snd are_sure all_defined] in *. apply andb_true_iff in k as [k1 k2]. apply andb_true_iff in h as [h1 h2].
  split; [exact (is_sure_sound _ _ _ agree k1 h1) |]. refine (IH _ _ _ k2 h2). intro name. cbn [lookup]. destruct (String.eqb n name); [exact (number_at_is other env renv e agree k1) | apply agree].
Qed.
End Sure.

Section Named.
Context {names : naming}.
Section Precision.
Variable bits : positive.

Definition refute_same_written (c : written_claim) (thetas xs : list number) (least greatest : list Q) (C : list (list Q)) : bool :=
  let m := by_formulas c in let X := somewhere 0 least greatest in
  one_to_one c && all_parts bits (map snd (parameters m)) thetas && all_parts bits (box_of c) xs && all_parts bits (box_of c) (map of_Q least) && all_parts bits (box_of c) (map of_Q greatest) &&
  are_ordered least greatest && is_beside bits least greatest xs && is_steady (thetas ++ xs) && forallb (fun d => is_constant (snd d)) (definitions m) &&
  match all_coordinates (joint_forms m) with
  | Some es => forallb is_constant es && all_sure (certainly bits true) m thetas xs es && all_sure (is_certain bits (length least)) m thetas X es &&
      fits bits (map (fun e => Minus (number_at (numbers_at m thetas X) e) (number_at (numbers_at m thetas xs) e)) es) C
  | None => false
  end.

Theorem refute_same_written_sound : forall c thetas xs least greatest C, refute_same_written c thetas xs least greatest C = true -> has_two_points c.
Proof.
  intros c thetas xs least greatest C h. unfold refute_same_written in h. cbv zeta in h. unfold has_two_points. cbv zeta. set (m := by_formulas c) in *. set (X := somewhere 0 least greatest) in *.
  apply andb_true_iff in h as [h rest]. apply andb_true_iff in h as [h constant]. apply andb_true_iff in h as [h steady]. apply andb_true_iff in h as [h beside]. apply andb_true_iff in h as [h ordered].
  apply andb_true_iff in h as [h hb]. apply andb_true_iff in h as [h ha]. apply andb_true_iff in h as [h hx]. apply andb_true_iff in h as [one hp]. split; [exact one |].
  destruct (all_coordinates (joint_forms m)) as [es |] eqn:ec; [| discriminate]. apply all_coordinates_sound in ec. apply andb_true_iff in rest as [rest fit]. apply andb_true_iff in rest as [rest there]. apply andb_true_iff in rest as [ce here].
  apply steady_app in steady as [st sx]. destruct (fits_sound bits _ _ fit) as [u [_ [_ zero]]]. rewrite Forall_map, Forall_forall in zero. pose proof (somewhere_between u _ _ ordered) as B. fold X in B.
  pose proof (are_within bits m thetas hp) as P. apply all_parts_sound in hx, ha, hb. set (theta := map Claim.value thetas) in *. set (x := map Claim.value xs) in *. set (y := map (@Claim.value (spot u)) X) in *.
  assert (T : map (@Claim.value (spot u)) thetas = theta) by exact (steady_values _ st (spot u)). assert (X0 : map (@Claim.value (spot u)) xs = x) by exact (steady_values _ sx (spot u)).
  assert (Stand : forall other ys, stand_for other (given m ys thetas) (given m (map (@Claim.value other) ys) (map (@Claim.value other) thetas))) by (intros; apply given_are).
  assert (All : forall other ys, stand_for other (numbers_at m thetas ys) (@environment_at names m (map (@Claim.value other) thetas) (map (@Claim.value other) ys))) by (intros; apply all_numbers_are; [apply Stand | exact constant]).
  rewrite forallb_forall in ce. assert (Reached : forall (other : naming) sure ys, (forall z, sure z = true -> 0 < @Claim.value other z) -> all_sure sure m thetas ys es = true ->
    @is_reached names m (map (@Claim.value other) thetas) (map (@Claim.value other) ys)).
  { intros other sure ys ss k. apply andb_true_iff in k as [k1 k2]. split; [exact (@are_sure_sound sure other names ss _ _ _ (Stand other ys) constant k1) |]. rewrite ec, Forall_map. apply Forall_forall. intros e ie.
    rewrite forallb_forall in k2. exact (@is_sure_sound sure other names ss _ _ e (All other ys) (ce e ie) (k2 e ie)). }
  exists theta, x, y. split; [split; assumption |]. split.
  { assert (l : length least = length greatest) by (apply andb_true_iff in ordered as [l _]; apply Nat.eqb_eq, l). clear - ha hb B l. clearbody y. clear X. revert B ha hb. generalize (box_of c) y. revert greatest l.
    induction least as [| a least IH]; intros [| b greatest] l ts ys B ha hb; try discriminate; cbn [combine map] in *; inversion B as [| ? z ? ? h k]; subst; inversion ha as [| t ? ? ? a1 a2]; subst; inversion hb as [| ? ? ? ? b1 b2]; subst; constructor.
    - cbn [fst snd] in h. unfold within, Q2R, Rdiv in *. lra.
    - apply (IH greatest); try assumption. cbn in l. congruence. }
  split; [exact (Reached names _ xs (fun z => positive_sound bits z) here) |]. split; [rewrite <- T; exact (Reached (spot u) _ X (fun z => is_certain_sound bits _ u z) there) |]. split.
  - unfold joint_values. rewrite ec, !map_map. apply map_ext_in. intros e ie. f_equal. specialize (zero e ie). cbn [Claim.value] in zero.
    rewrite (number_at_is (spot u) _ _ e (All (spot u) X) (ce e ie)), (number_at_is (spot u) _ _ e (All (spot u) xs) (ce e ie)), T, X0 in zero. fold y in zero. lra.
  - exact (is_beside_sound bits _ _ _ _ beside B).
Qed.
End Precision.
End Named.
