(** * Rows of less than full rank, in fractions

    No fraction is rounded.  A direction that no row sees is found by elimination,
    and then only looked at: how it was found does not matter. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert Require Import Claim.
From Orthocert.kernel Require Import Linear Number Compare.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

(** The root of a square. *)
Definition square_root (q : Q) : option Q :=
  let r := Qred q in let s := (Z.sqrt (Qnum r) # Z.to_pos (Z.sqrt (Zpos (Qden r))))%Q in
  if (0 <? Qnum r)%Z && Qeq_bool (s * s) q then Some s else None.

Lemma square_root_sound : forall q s, square_root q = Some s -> sqrt (Q2R q) = Q2R s.
Proof.
  intros q s h. unfold square_root in h. cbv zeta in h. destruct (_ && _) eqn:e; [| discriminate]. injection h as <-.
  apply andb_true_iff in e as [_ e]. apply Qeq_bool_iff, Qeq_eqR in e. rewrite <- e, Q2R_mult. apply sqrt_square.
  unfold Q2R. cbn [Qnum Qden]. apply Rmult_le_pos; [apply IZR_le, Z.sqrt_nonneg | apply Rlt_le, Rinv_0_lt_compat, IZR_lt, Pos2Z.is_pos].
Qed.

(** Rows of [n] entries: one with a first entry that is not zero is taken from the others, and so on. *)
Fixpoint take_pivot (rows : list (list Q)) : option (list Q * list (list Q)) :=
  match rows with
  | [] => None
  | row :: rest =>
      if Qeq_bool (hd 0%Q row) 0 then option_map (fun p => (fst p, row :: snd p)) (take_pivot rest) else Some (row, rest)
  end.
Definition qdot (u v : list Q) : Q := fold_right (fun p sum => Qred (fst p * snd p + sum)) 0%Q (combine u v).
Fixpoint unseen (n : nat) (rows : list (list Q)) : option (list Q) :=
  match n with
  | O => None
  | S m =>
      match take_pivot rows with
      | None => Some (1%Q :: repeat 0%Q m)
      | Some (p, rest) =>
          let less row := let by_ := (hd 0 row / hd 0 p)%Q in map (fun e => Qred (fst e - by_ * snd e)) (combine (tl row) (tl p)) in
          option_map (fun v => Qred (- qdot (tl p) v / hd 0%Q p) :: v) (unseen m (map less rest))
      end
  end.

Definition is_unseen (n : nat) (rows : list (list Q)) (v : list Q) : bool :=
  Nat.eqb (length v) n && existsb (fun x => negb (Qeq_bool x 0)) v && forallb (fun row => Qeq_bool (qdot row v) 0) rows.

Fixpoint fractions (l : list number) : option (list Q) :=
  match l with [] => Some [] | x :: l' => match fraction square_root x, fractions l' with Some q, Some r => Some (q :: r) | _, _ => None end end.
Fixpoint all_fractions (rows : list (list number)) : option (list (list Q)) :=
  match rows with [] => Some [] | row :: l => match fractions row, all_fractions l with Some q, Some r => Some (q :: r) | _, _ => None end end.
Definition are_dependent (n : nat) (rows : list (list number)) : bool :=
  match all_fractions rows with
  | Some rows => match unseen n rows with Some v => is_unseen n rows v | None => false end
  | None => false
  end.

Lemma qdot_value : forall u v, Q2R (qdot u v) = dot (map Q2R u) (map Q2R v).
Proof.
  induction u as [| a u IH]; intros [| b v]; cbn [map dot]; try (unfold qdot, Q2R; cbn; lra).
  change (qdot (a :: u) (b :: v)) with (Qred (a * b + qdot u v)). rewrite (Qeq_eqR _ _ (Qred_correct _)), Q2R_plus, Q2R_mult, IH. reflexivity.
Qed.
Lemma fractions_value : forall l qs, fractions l = Some qs -> map value l = map Q2R qs.
Proof.
  induction l as [| x l IH]; intros qs h; cbn [fractions] in h; [injection h as <-; reflexivity |].
  destruct (fraction square_root x) as [q |] eqn:e; [| discriminate]. destruct (fractions l) as [r |]; [| discriminate]. injection h as <-.
  cbn [map]. rewrite (fraction_sound _ square_root_sound _ _ e), (IH r eq_refl). reflexivity.
Qed.
Lemma not_zero : forall v, existsb (fun x => negb (Qeq_bool x 0)) v = true -> nonzero (map Q2R v).
Proof.
  intros v h. unfold nonzero. induction v as [| x v IH]; [discriminate |]. cbn [existsb map dot] in *.
  assert (N : forall u, 0 <= dot u u) by (induction u as [| y u IHu]; cbn [dot]; [lra |]; nra).
  pose proof (N (map Q2R v)). apply orb_true_iff in h as [h | h]; [| specialize (IH h); nra].
  assert (Q2R x <> 0). { intro z. replace 0 with (Q2R 0) in z by (unfold Q2R; cbn; lra). apply eqR_Qeq, Qeq_bool_iff in z. rewrite z in h. discriminate. }
  assert (0 < Q2R x * Q2R x) by nra. lra.
Qed.

Theorem are_dependent_sound : forall n rows, are_dependent n rows = true ->
  exists v, length v = n /\ nonzero v /\ Forall (fun row => dot (map value row) v = 0) rows.
Proof.
  intros n rows h. unfold are_dependent in h. destruct (all_fractions rows) as [qs |] eqn:e; [| discriminate].
  destruct (unseen n qs) as [v |]; [| discriminate]. apply andb_true_iff in h as [h z]. apply andb_true_iff in h as [l nz]. apply Nat.eqb_eq in l.
  exists (map Q2R v). split; [rewrite map_length; exact l |]. split; [exact (not_zero v nz) |]. clear l nz. revert qs e z.
  induction rows as [| row rows IH]; intros qs e z; constructor; cbn [all_fractions] in e;
    destruct (fractions row) as [q |] eqn:er; try discriminate; destruct (all_fractions rows) as [r |]; try discriminate; injection e as <-;
    cbn [forallb] in z; apply andb_true_iff in z as [z1 z2].
  - rewrite (fractions_value _ _ er), <- qdot_value. apply Qeq_bool_iff, Qeq_eqR in z1. rewrite z1. unfold Q2R. cbn. lra.
  - exact (IH r eq_refl z2).
Qed.
End Named.
