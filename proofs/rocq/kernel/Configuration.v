(** * Mechanisms by their Jacobian: what is asked of a machine at a point

    For machines whose claims are not those of Statement.v: the rows of M = J^-1
    are lists, as many entries as the platform has coordinates. *)

From Coq Require Import ZArith Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 Fixed Claim.
From Orthocert.kernel Require Import Statement Linear Arithmetic Number Trig Dependent Witness.
From Orthocert.kernel Require Solve.
Import ListNotations.
Local Open Scope R_scope.
Local Notation length := Datatypes.length.

Section Named.
Context {names : naming}.

Inductive coordinate :=
  | Length (rho : R)
  (* by its cosine and sine *)
  | Angle (cosine sine : R)
  (* of a joint that is given by its row of M alone *)
  | Unknown.

(** A leg of fixed length: its vector, as many components as the platform has, its component eta along the motion of its driven end, and its length. *)
Record rod := Rod { rod_vector : list R; rod_eta : R; rod_size : R }.

(** A machine at a point. [reached]: all is defined there, and no leg is serially singular. [rods]: of its legs, or none. [limbs]: of legs
    with two ends, where angles at joints and bodies are asked for, the platform end, the vector from the base end to there, and the length;
    [placed]: where points of the platform are. [accelerates i v a y]: the acceleration of joint i where the platform has the velocity v, which changes at the
    rate a, is y. [recovers error b angle]: joint coordinates off by the error at most from those of the nominal machine belong to exactly one pose so near. *)
Record configuration := Configuration { jacobian : list (list R); joints : list coordinate; rods : list (option rod);
  limbs : list (option (vec * vec * R)); placed : vec -> vec; accelerates : nat -> list R -> list R -> R -> Prop;
  recovers : number -> number -> number -> Prop; reached : Prop }.

(** |M v|^2 *)
Definition speed2 (M : list (list R)) (v : list R) : R := fold_right (fun row sum => dot row v ^ 2 + sum) 0 M.

(** v . M^T diag(ks) M v *)
Fixpoint elastic (ks : list R) (M : list (list R)) (v : list R) : R :=
  match ks, M with k :: ks', row :: M' => k * dot row v ^ 2 + elastic ks' M' v | _, _ => 0 end.

Lemma elastic_nonneg : forall ks M v, Forall (fun k => 0 < k) ks -> 0 <= elastic ks M v.
Proof.
  intros ks M v h. revert M. induction h as [| k ks k0 _ IH]; intros [| row M]; cbn [elastic]; try lra. specialize (IH M).
  assert (0 <= k * dot row v ^ 2) by (apply Rmult_le_pos; [lra | apply pow2_ge_0]). lra.
Qed.

(** Off by the error at most, of angles in degrees. *)
Definition is_off (error : R) (nominal other : coordinate) : Prop :=
  match nominal, other with
  | Length a, Length b => Rabs (b - a) <= error
  | Angle c s, Angle c' s' => exists d, Rabs d <= error /\ c' = c * cos (in_degrees d) - s * sin (in_degrees d) /\ s' = s * cos (in_degrees d) + c * sin (in_degrees d)
  | _, _ => False
  end.

(** Joints are counted from zero. *)
Inductive demand :=
  | Nonsingular
  | FactorMax (b : number) | FactorMin (b : number)    (* velocity transmission factors *)
  | LengthMin (joint : nat) (b : number) | LengthMax (joint : nat) (b : number)
  | AngleWithin (joint : nat) (a b : number)           (* degrees, up to whole turns *)
  | Conditioned (b : number)                           (* sigma_max / sigma_min *)
  (* of joints that are lengths: a joint's speed, and its static force, at a speed of the platform, or a force on it, up to [tool] *)
  | SpeedMax (joint : nat) (tool b : number) | ForceMax (joint : nat) (tool b : number)
  | StiffnessMin (joints : list number) (b : number)   (* the least eigenvalue of M^T diag(joints) M *)
  | TurnMax (joint : nat) (tool b : number)            (* of joints that are angles, degrees: their speed *)
  (* of legs of fixed length: |eta|/L, its arc cosine in degrees, and |det A| over the product of all lengths *)
  | SerialMin (leg : nat) (b : number) | LegAngleMax (leg : nat) (b : number) | ParallelMin (b : number)
  (* degrees, from an axis of the leg's joint in the base, or on the platform, to the leg *)
  | JointAngleMax (leg : nat) (on_platform : bool) (axis : position) (b : number)
  (* the distance of two bodies *)
  | Clear (one other : body) (b : number)
  (* of no motion of the platform with this acceleration and speed at most *)
  | AccelerationMax (joint : nat) (acceleration speed b : number)
  (* the one pose within b, of platforms that turn turned by at most so many degrees, where joints are off by [error] at most *)
  | OnePose (error b angle : number)
  (* a joint's static force at this one force on the platform *)
  | LoadMax (joint : nat) (force : list number) (b : number).

(** By the first row. *)
Definition determinant (rows : list (list R)) : R :=
  match rows with
  | [[a; b]; [c; d]] => a * d - b * c
  | [[a; b; c]; [d; e; f]; [g; h; i]] => a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
  | _ => 0
  end.

(** No motion of the platform, of [n] coordinates, leaves all joints at rest. *)
Definition injective (n : nat) (c : configuration) : Prop :=
  forall v, length v = n -> nonzero v -> 0 < speed2 (jacobian c) v.

(** Virtual work: the joint forces tau hold the force F on the platform, F . v = tau . M v for every v. *)
Definition holds_force (n : nat) (M : list (list R)) (tau F : list R) : Prop :=
  length tau = length M /\ length F = n /\ forall v, length v = n -> dot F v = dot tau (map (fun row => dot row v) M).

Definition fulfils (n : nat) (c : configuration) (d : demand) : Prop :=
  match d with
  | Nonsingular => injective n c
  | FactorMax b => forall v, length v = n -> (1 / value b) ^ 2 * dot v v <= speed2 (jacobian c) v
  | FactorMin b => forall v, length v = n -> speed2 (jacobian c) v <= (1 / value b) ^ 2 * dot v v
  | LengthMin i b => exists rho, nth_error (joints c) i = Some (Length rho) /\ value b <= rho
  | LengthMax i b => exists rho, nth_error (joints c) i = Some (Length rho) /\ rho <= value b
  | AngleWithin i a b => exists angle, value a <= angle <= value b /\
      nth_error (joints c) i = Some (Angle (cos (in_degrees angle)) (sin (in_degrees angle)))
  | Conditioned b => forall u v, length u = n -> length v = n ->
      speed2 (jacobian c) u * dot v v <= value b ^ 2 * (speed2 (jacobian c) v * dot u u)
  | SpeedMax i tool b => exists row, nth_error (jacobian c) i = Some row /\
      forall v, length v = n -> dot v v <= value tool ^ 2 -> Rabs (dot row v) <= value b
  | ForceMax i tool b => forall tau F, holds_force n (jacobian c) tau F -> dot F F <= value tool ^ 2 -> Rabs (nth i tau 0) <= value b
  | StiffnessMin ks b => forall v, length v = n -> value b * dot v v <= elastic (map value ks) (jacobian c) v
  | TurnMax i tool b => exists row, nth_error (jacobian c) i = Some row /\
      forall v, length v = n -> dot v v <= value tool ^ 2 -> Rabs (dot row v) <= in_degrees (value b)
  | SerialMin i b => exists l, nth_error (rods c) i = Some (Some l) /\ value b * rod_size l <= Rabs (rod_eta l)
  | LegAngleMax i b => exists l, nth_error (rods c) i = Some (Some l) /\ cos (in_degrees (value b)) * rod_size l <= Rabs (rod_eta l)
  | ParallelMin b => exists ls, rods c = map Some ls /\
      fold_left (fun p l => p * rod_size l) ls (value b) <= Rabs (determinant (map rod_vector ls))
  | JointAngleMax i on_platform j b => exists C A L, nth_error (limbs c) i = Some (Some (C, A, L)) /\
      let a := if on_platform then vsub (placed c (located j)) (placed c vzero) else located j in
      0 < norm2 A /\ 0 < norm2 a /\ exists angle, 0 <= angle <= value b /\ Vec3.dot A a = sqrt (norm2 A) * sqrt (norm2 a) * cos (in_degrees angle)
  | Clear one other b => are_clear (segment_along (limbs c) (placed c)) one other b
  | AccelerationMax i acceleration speed b => forall v a, length v = n -> length a = n -> dot v v <= value speed ^ 2 -> dot a a <= value acceleration ^ 2 ->
      exists y, accelerates c i v a y /\ Rabs y <= value b
  | OnePose error b angle => recovers c error b angle
  | LoadMax i force b => forall tau, holds_force n (jacobian c) tau (map value force) -> Rabs (nth i tau 0) <= value b
  end.

Definition meets (n : nat) (c : configuration) (ds : list demand) : Prop :=
  reached c /\ injective n c /\ Forall (fulfils n c) ds.

(** A test of what is claimed of two points stands among those of one. *)
Definition inserted {A : Type} (place : nat) (l : list A) (a : A) : list A := firstn place l ++ a :: skipn place l.
Lemma inserted_in : forall (A : Type) place (l : list A) a b, In b (inserted place l a) <-> b = a \/ In b l.
Proof.
  intros A place l a b. unfold inserted. rewrite <- (firstn_skipn place l) at 3. rewrite !in_app_iff. cbn [In]. intuition.
Qed.

(** ** In exact numbers: what fails *)

Inductive ncoordinate := NLength (rho : number) | NAngle (cosine sine : number) | NUnknown.
(** [reserves]: where it is reached, these are positive. [nrays]: multiples of the rows there, which may be fractions where these are not. *)
Record nrod := NRod { nrod_vector : list number; nrod_eta : number; nrod_size : number }.
Record nconfiguration := NConfiguration { njacobian : list (list number); njoints : list ncoordinate; nrods : list (option nrod);
  nlimbs : list (option (numbers * numbers * number)); nplaced : numbers -> numbers; reserves : list number; nrays : list (option (list number)) }.

Definition coordinate_of (x : ncoordinate) : coordinate :=
  match x with NLength x => Length (value x) | NAngle c s => Angle (value c) (value s) | NUnknown => Unknown end.
Definition real_rod (l : nrod) : rod := Rod (map value (nrod_vector l)) (value (nrod_eta l)) (value (nrod_size l)).
Definition is_ray (ray : option (list number)) (row : list R) : Prop :=
  match ray with Some l => exists k, k <> 0 /\ row = map (fun x => k * value x) l | None => True end.
Definition stands_for (n : nconfiguration) (c : configuration) : Prop :=
  jacobian c = map (map value) (njacobian n) /\ joints c = map coordinate_of (njoints n) /\ rods c = map (option_map real_rod) (nrods n) /\
  limbs c = map (option_map Witness.real_rod) (nlimbs n) /\ (forall b, values (nplaced n b) = placed c (values b)) /\
  (reached c -> Forall (fun x => 0 < value x) (reserves n) /\ Forall2 is_ray (nrays n) (jacobian c)).

Fixpoint ndot (u v : list number) : number :=
  match u, v with a :: u', b :: v' => Plus (Times a b) (ndot u' v') | _, _ => 0 // 1 end.
Definition nspeed2 (M : list (list number)) (v : list number) : number :=
  fold_right (fun row sum => Plus (Times (ndot row v) (ndot row v)) sum) (0 // 1) M.

Lemma zero_value : value (0 // 1) = 0.
Proof. cbn. lra. Qed.

Lemma value_ndot : forall u v, value (ndot u v) = dot (map value u) (map value v).
Proof. induction u as [| a u IH]; intros [| b v]; cbn [ndot map dot]; rewrite ?zero_value; try reflexivity. cbn [value]. rewrite IH. reflexivity. Qed.

Lemma value_nspeed2 : forall M v, value (nspeed2 M v) = speed2 (map (map value) M) (map value v).
Proof.
  intros M v. induction M as [| row M IH]; [exact zero_value |]. cbn [nspeed2 speed2 map fold_right value].
  unfold nspeed2, speed2 in IH. rewrite IH, value_ndot. ring.
Qed.

Fixpoint nelastic (ks : list number) (M : list (list number)) (v : list number) : number :=
  match ks, M with k :: ks', row :: M' => Plus (Times k (Times (ndot row v) (ndot row v))) (nelastic ks' M' v) | _, _ => 0 // 1 end.
Lemma value_nelastic : forall ks M v, value (nelastic ks M v) = elastic (map value ks) (map (map value) M) (map value v).
Proof.
  induction ks as [| k ks IH]; intros [| row M] v; try exact zero_value. cbn [nelastic elastic map value]. rewrite IH, value_ndot. ring.
Qed.

Fixpoint nweighted (v : list number) (rows : list (list number)) : list number :=
  match v, rows with x :: v', r :: rows' => merge (Times x) (fun y => y) (fun a b => Plus (Times x a) b) r (nweighted v' rows') | _, _ => [] end.
Lemma value_merged : forall x r s, map value (merge (Times x) (fun y => y) (fun a b => Plus (Times x a) b) r s) = comb (value x) 1 (map value r) (map value s).
Proof.
  assert (I : forall s, map value s = map (Rmult 1) (map value s)) by (intro s; rewrite map_map; apply map_ext; intro; ring).
  intros x r. unfold comb. induction r as [| a r IH]; intro s.
  - destruct s; [reflexivity |]. cbn [merge map]. rewrite map_id. exact (I (_ :: _)).
  - destruct s as [| b s]; cbn [merge map]; [rewrite !map_map; reflexivity |]. rewrite IH. cbn [value]. rewrite Rmult_1_l. reflexivity.
Qed.
Lemma dot_nweighted : forall v rows w, dot (map value (nweighted v rows)) w = dot (map value v) (map (fun r => dot (map value r) w) rows).
Proof.
  induction v as [| x v IH]; intros [| r rows] w; cbn [nweighted map dot]; try (destruct w; reflexivity). rewrite value_merged, dot_comb, IH. ring.
Qed.
Lemma nweighted_length : forall n v rows, length v = length rows -> Forall (fun r => length r = n) rows -> rows <> [] -> length (nweighted v rows) = n.
Proof.
  assert (M : forall x r s, s = [] \/ length s = length r -> length (merge (Times x) (fun y => y) (fun a b => Plus (Times x a) b) r s) = length r).
  { intros x. induction r as [| a r IH]; intros [| b s] e; cbn [merge length]; rewrite ?map_length; try reflexivity.
    - destruct e as [e | e]; discriminate e.
    - rewrite IH; [reflexivity |]. right. destruct e as [e | e]; [discriminate e | cbn in e; congruence]. }
  intros n. induction v as [| x v IH]; intros [| r rows] l h ne; try discriminate; [contradiction |]. inversion h as [| ? ? h1 h2]; subst. cbn [nweighted]. apply M.
  destruct rows as [| q rows]; [left; destruct v; reflexivity | right; apply IH; [injection l; auto | exact h2 | discriminate]].
Qed.

Definition ndeterminant (rows : list (list number)) : number :=
  let minor a b c d := Minus (Times a d) (Times b c) in
  match rows with
  | [[a; b]; [c; d]] => minor a b c d
  | [[a; b; c]; [d; e; f]; [g; h; i]] => Plus (Minus (Times a (minor e f h i)) (Times b (minor d f g i))) (Times c (minor d e g h))
  | _ => 0 // 1
  end.
Lemma value_ndeterminant : forall rows, value (ndeterminant rows) = determinant (map (map value) rows).
Proof.
  intros [| [| a [| b [| c [| ? ?]]]] [| [| d [| e [| f [| ? ?]]]] [| [| g [| h [| i [| ? ?]]]] [| ? ?]]]]; cbn [ndeterminant determinant map]; try exact zero_value; cbn [value]; ring.
Qed.

(** [F] for row [i]. *)
Definition replaced {A : Type} (i : nat) (F : A) (rows : list A) : list A := firstn i rows ++ F :: skipn (S i) rows.
Definition is_square {A : Type} (n : nat) (rows : list (list A)) : bool :=
  (Nat.eqb n 2 || Nat.eqb n 3) && Nat.eqb (length rows) n && forallb (fun r => Nat.eqb (length r) n) rows.
Lemma map_replaced : forall (A B : Type) (f : A -> B) i F rows, map f (replaced i F rows) = replaced i (f F) (map f rows).
Proof. intros. unfold replaced. rewrite map_app, firstn_map, skipn_map. reflexivity. Qed.
Lemma square_map : forall (A B : Type) (f : A -> B) n rows, is_square n (map (map f) rows) = is_square n rows.
Proof.
  intros. unfold is_square. rewrite map_length. f_equal. induction rows as [| r rows IH]; [reflexivity |]. cbn [map forallb]. rewrite map_length, IH. reflexivity.
Qed.

(** Two or three rows of as many entries. *)
Lemma square_cases : forall n (rows : list (list R)), is_square n rows = true ->
  (n = 2%nat /\ exists a b c d, rows = [[a; b]; [c; d]]) \/ (n = 3%nat /\ exists a b c d e f g h i, rows = [[a; b; c]; [d; e; f]; [g; h; i]]).
Proof.
  intros n rows h. apply andb_true_iff in h as [h h2]. apply andb_true_iff in h as [h h1]. apply Nat.eqb_eq in h1. rewrite forallb_forall in h2.
  assert (K : forall r, In r rows -> length r = n) by (intros r i; apply Nat.eqb_eq, h2, i). clear h2.
  apply orb_true_iff in h as [h | h]; apply Nat.eqb_eq in h; subst n; [left | right]; (split; [reflexivity |]).
  - destruct rows as [| r1 [| r2 [|]]]; try discriminate. pose proof (K r1 ltac:(cbn; tauto)). pose proof (K r2 ltac:(cbn; tauto)).
    destruct r1 as [| a [| b [|]]]; try discriminate. destruct r2 as [| c [| d [|]]]; try discriminate. exists a, b, c, d. reflexivity.
  - destruct rows as [| r1 [| r2 [| r3 [|]]]]; try discriminate. pose proof (K r1 ltac:(cbn; tauto)). pose proof (K r2 ltac:(cbn; tauto)). pose proof (K r3 ltac:(cbn; tauto)).
    destruct r1 as [| a [| b [| c [|]]]]; try discriminate. destruct r2 as [| d [| e [| f [|]]]]; try discriminate. destruct r3 as [| g [| h' [| i [|]]]]; try discriminate.
    exists a, b, c, d, e, f, g, h', i. reflexivity.
Qed.

Lemma square_replaced : forall (A : Type) n i (F : list A) rows, is_square n rows = true -> length F = n -> (i < n)%nat -> is_square n (replaced i F rows) = true.
Proof.
  intros A n i F rows h lF li. unfold is_square in *. apply andb_true_iff in h as [h h2]. apply andb_true_iff in h as [h h1]. apply Nat.eqb_eq in h1. rewrite h. cbn [andb].
  apply andb_true_iff. split.
  - unfold replaced. apply Nat.eqb_eq. rewrite app_length, firstn_length. cbn [length]. rewrite skipn_length. lia.
  - rewrite forallb_forall in *. intros r ir. unfold replaced in ir. apply in_app_or in ir as [ir | [<- | ir]]; [| apply Nat.eqb_eq; exact lF |]; apply h2.
    + rewrite <- (firstn_skipn i rows). apply in_or_app. left. exact ir.
    + rewrite <- (firstn_skipn (S i) rows). apply in_or_app. right. exact ir.
Qed.

(** Cramer's rule. *)
Lemma cramer : forall n rows F w, is_square n rows = true -> length F = n -> length w = n ->
  determinant rows * dot F w = dot (map (fun j => determinant (replaced j F rows)) (seq 0 n)) (map (fun r => dot r w) rows).
Proof.
  intros n rows F w h lF lw. destruct (square_cases n rows h) as [[-> [a [b [c [d ->]]]]] | [-> [a [b [c [d [e [f [g [k [i ->]]]]]]]]]]].
  - destruct F as [| x [| y [|]]]; try discriminate. destruct w as [| p [| q [|]]]; try discriminate. cbn. ring.
  - destruct F as [| x [| y [| z [|]]]]; try discriminate. destruct w as [| p [| q [| r [|]]]]; try discriminate. cbn. ring.
Qed.

(** The legs, where all have fixed lengths. *)
Fixpoint all_rods (l : list (option nrod)) : option (list nrod) :=
  match l with [] => Some [] | Some q :: l' => option_map (cons q) (all_rods l') | None :: _ => None end.
Lemma all_rods_sound : forall l qs, all_rods l = Some qs -> l = map Some qs.
Proof.
  induction l as [| [q |] l IH]; intros qs h; cbn [all_rods] in h; try discriminate; [injection h as <-; reflexivity |].
  destruct (all_rods l) as [r |]; [| discriminate]. injection h as <-. cbn [map]. rewrite (IH r eq_refl). reflexivity.
Qed.

Fixpoint all_rays (l : list (option (list number))) : option (list (list number)) :=
  match l with [] => Some [] | Some r :: l' => option_map (cons r) (all_rays l') | None :: _ => None end.
Lemma all_rays_sound : forall l rows M, all_rays l = Some rows -> Forall2 is_ray l M ->
  exists ks, length ks = length rows /\ Forall (fun k => k <> 0) ks /\ M = map (fun p => map (fun x => fst p * value x) (snd p)) (combine ks rows).
Proof.
  intros l rows M e h. revert rows e. induction h as [| ray row l M hr h IH]; intros rows e; cbn [all_rays] in e; [injection e as <-; exists []; repeat split; constructor |].
  destruct ray as [r |]; [| discriminate]. destruct hr as [k [k0 ->]]. destruct (all_rays l) as [rest |]; [| discriminate]. injection e as <-.
  destruct (IH rest eq_refl) as [ks [h1 [h2 ->]]]. exists (k :: ks). split; [cbn; congruence |]. split; [constructor; assumption | reflexivity].
Qed.

Section Precision.
Variable bits : positive.
Local Notation certainly := (certainly bits).

(** sin (angle - end) is not negative at the least end, and sin (end - angle) at the greatest. *)
Definition before (c s : number) (degrees : number) : option fixed :=
  match enclose bits c, enclose bits s, cosine bits degrees, sine bits degrees with
  | Some c, Some s, Some c', Some s' => Some (sub (mul bits s c') (mul bits c s'))
  | _, _, _, _ => None
  end.
Definition is_negative (a : option fixed) : bool := match a with Some a => (hi a <? 0)%Z | None => false end.
Definition is_positive (a : option fixed) : bool := match a with Some a => (0 <? lo a)%Z | None => false end.

Lemma before_sound : forall c s d a, before c s d = Some a ->
  contains bits a (value s * cos (in_degrees (value d)) - value c * sin (in_degrees (value d))).
Proof.
  intros c s d a h. unfold before in h. destruct (enclose bits c) as [c1 |] eqn:e1; [| discriminate].
  destruct (enclose bits s) as [s1 |] eqn:e2; [| discriminate]. destruct (cosine bits d) as [c2 |] eqn:e3; [| discriminate].
  destruct (sine bits d) as [s2 |] eqn:e4; [| discriminate].
  assert (E : sub (mul bits s1 c2) (mul bits c1 s2) = a) by congruence. subst a.
  apply sub_sound; apply mul_sound; auto using enclose_sound, cosine_sound, sine_sound.
Qed.

(** Of angles less than half a turn, [least] or the greatest end. *)
Definition beyond (least : bool) (x : ncoordinate) (a b : number) : bool :=
  match x with
  | NAngle c s => certainly false (Minus (Plus a (180 // 1)) b) &&
      (if least then is_negative (before c s a) else is_positive (before c s b))
  | _ => false
  end.

(** Angles up to 90 degrees have a test of the sign, and, if they are less, one of a square. *)
Definition is_up_to_90 (b : number) : bool := certainly false (Minus (90 // 1) b).
(** The angle of [A] and [a], in the test [which]. *)
Definition is_wider (which : nat) (A a : numbers) (turned : numbers -> numbers) (vs : list (list number)) (b : number) : bool :=
  let along := product A a in
  match is_up_to_90 b, which, vs with
  | true, O, [] => certainly true (Minus (0 // 1) along)
  | true, S O, [[x; y; z]] => let d := turned (Numbers x y z) in let across := product A d in
      certainly true along && match cosine bits b, enclose bits (Times (product a a) (Times across across)), enclose bits (Times (Times along along) (product d d)) with
        | Some c, Some p, Some q => is_positive (Some c) && is_positive (Some (sub (mul bits (sqr bits c) p) q))
        | _, _, _ => false
        end
  | false, O, [] => certainly false (Minus (180 // 1) b) && match cosine bits b, enclose bits along, enclose bits (Root (Times (product a a) (product A A))) with
        | Some c, Some p, Some q => is_negative (Some (sub p (mul bits c q)))
        | _, _, _ => false
        end
  | _, _, _ => false
  end.

(** Rows of numbers, each enclosed once. *)
Fixpoint all_enclosed (l : list number) : option (list fixed) :=
  match l with [] => Some [] | x :: l' => match enclose bits x, all_enclosed l' with Some a, Some r => Some (a :: r) | _, _ => None end end.
Fixpoint all_rows_enclosed (rows : list (list number)) : option (list (list fixed)) :=
  match rows with [] => Some [] | r :: rows' => match all_enclosed r, all_rows_enclosed rows' with Some a, Some q => Some (a :: q) | _, _ => None end end.
Definition fsquare (l : list fixed) : fixed := fold_right (fun a s => add (sqr bits a) s) zero l.
Definition fdeterminant (rows : list (list fixed)) : fixed :=
  let minor a b c d := sub (mul bits a d) (mul bits b c) in
  match rows with
  | [[a; b]; [c; d]] => minor a b c d
  | [[a; b; c]; [d; e; f]; [g; h; i]] => add (sub (mul bits a (minor e f h i)) (mul bits b (minor d f g i))) (mul bits c (minor d e g h))
  | _ => zero
  end.
Lemma all_rows_enclosed_sound : forall rows q, all_rows_enclosed rows = Some q -> Forall2 (Forall2 (contains bits)) q (map (map value) rows).
Proof.
  induction rows as [| r rows IH]; intros q e; cbn [all_rows_enclosed map] in *; [injection e as <-; constructor |].
  destruct (all_enclosed r) as [b |] eqn:eb; [| discriminate]. destruct (all_rows_enclosed rows) as [q' |]; [| discriminate]. injection e as <-.
  constructor; [| exact (IH q' eq_refl)]. clear - eb. revert b eb. induction r as [| x r IH]; intros b e; cbn [all_enclosed map] in *; [injection e as <-; constructor |].
  destruct (enclose bits x) as [c |] eqn:ec; [| discriminate]. destruct (all_enclosed r) as [b' |]; [| discriminate]. injection e as <-.
  constructor; [exact (enclose_sound bits x c ec) | exact (IH b' eq_refl)].
Qed.
Lemma fsquare_sound : forall l L, Forall2 (contains bits) l L -> contains bits (fsquare l) (dot L L).
Proof.
  induction 1 as [| a x l L h hs IH]; [apply zero_sound |]. cbn [fsquare fold_right dot]. replace (x * x) with (x ^ 2) by ring. apply add_sound; [apply sqr_sound, h | exact IH].
Qed.
Lemma fdeterminant_sound : forall n rows M, is_square n M = true -> Forall2 (Forall2 (contains bits)) rows M -> contains bits (fdeterminant rows) (determinant M).
Proof.
  intros n rows M sq h. destruct (square_cases n M sq) as [[_ [a [b [c [d ->]]]]] | [_ [a [b [c [d [e [f [g [k [i ->]]]]]]]]]]];
    repeat match goal with H : Forall2 _ _ (_ :: _) |- _ => inversion H; clear H; subst | H : Forall2 _ _ [] |- _ => inversion H; clear H; subst end; cbn [fdeterminant determinant].
  - apply sub_sound; apply mul_sound; assumption.
  - repeat (apply add_sound || apply sub_sound || apply mul_sound); assumption.
Qed.
Lemma replaced_related : forall (A B : Type) (P : A -> B -> Prop) i a b l m, P a b -> Forall2 P l m -> Forall2 P (replaced i a l) (replaced i b m).
Proof.
  intros A B P i a b l m h hs. unfold replaced. revert i. induction hs as [| x y l m hxy hs IH]; intros [| i]; cbn [firstn skipn app]; try (constructor; [exact h | constructor]).
  - constructor; [exact h | exact hs].
  - constructor; [exact hxy | exact (IH i)].
Qed.

(** [vs]: directions, where the demand is about all; of what has several tests, [which]. *)
Definition fails (n : nat) (c : nconfiguration) (which : nat) (vs : list (list number)) (d : demand) : bool :=
  let bound b u := Times (Times (Over (1 // 1) b) (Over (1 // 1) b)) (ndot u u) in
  let speed := nspeed2 (njacobian c) in
  let of i f := match nth_error (njoints c) i with Some x => f x | None => false end in
  let of_row i f := match nth_error (njacobian c) i with Some row => Nat.eqb (length row) n && f row | None => false end in
  let of_rod i f := match nth_error (nrods c) i with Some (Some l) => f l | _ => false end in
  forallb (fun v => Nat.eqb (length v) match d with JointAngleMax _ _ _ _ | Clear _ _ _ => 3 | SpeedMax _ _ _ => 1 | _ => n end) vs &&
  match d, vs with
  | FactorMax b, [u] => certainly true (Minus (bound b u) (speed u))
  | FactorMin b, [u] => certainly true (Minus (speed u) (bound b u))
  | LengthMin i b, [] => of i (fun x => match x with NLength x => certainly true (Minus b x) | _ => false end)
  | LengthMax i b, [] => of i (fun x => match x with NLength x => certainly true (Minus x b) | _ => false end)
  | AngleWithin i a b, [] => of i (fun x => beyond (Nat.eqb which 0) x a b)
  | Conditioned b, [u; v] =>
      certainly true (Minus (Times (speed u) (ndot v v)) (Times (Times b b) (Times (speed v) (ndot u u))))
  (* in the direction of the row itself *)
  | SpeedMax i tool b, vs => of_row i (fun row => let k := Over b tool in certainly true tool && certainly true (Minus (ndot row row) (Times k k))) &&
      (* of struts, where what is told is of one number *)
      match nlimbs c, vs with [], [] => true | _ :: _, [[x]] => certainly true (Times x x) | _, _ => false end
  | TurnMax i tool b, [] => of_row i (fun row => certainly true tool && certainly false b &&
      match enclose bits (ndot row row), enclose bits (Over b tool) with
      | Some s, Some k => match radians bits k with Some k => is_positive (Some (sub s (sqr bits k))) | None => false end
      | _, _ => false
      end)
  | ForceMax i tool b, [v] => match all_rays (nrays c), nth_error v i with
      | Some rays, Some x => Nat.eqb (length rays) n && forallb (fun r => Nat.eqb (length r) n) rays && match nth_error rays i with
          | Some ray => of_row i (fun row => is_forceful bits ndot tool b x (nweighted v rays) row ray)
          | None => false
          end
      | _, _ => false
      end
  | JointAngleMax i on j b, vs => match nth_error (nlimbs c) i with
      | Some (Some (_, A, _)) => let turned v := if on then each2 Minus (nplaced c v) (nplaced c (Numbers (0 // 1) (0 // 1) (0 // 1))) else v in
          is_wider which A (turned (nposition j)) turned vs b
      | _ => false
      end
  | Clear one other b, [[s; t; u]] => are_nearer bits (nsegment_along (nlimbs c) (nplaced c)) (Numbers s t u) one other b
  | StiffnessMin ks b, [v] => certainly true (Minus (Times b (ndot v v)) (nelastic ks (njacobian c) v))
  | SerialMin i b, [] => of_rod i (fun l => let least := Times b (nrod_size l) in
      certainly true least && certainly true (Minus (Times least least) (Times (nrod_eta l) (nrod_eta l))))
  | LegAngleMax i b, [] => of_rod i (fun l =>
      match cosine bits b, enclose bits (nrod_size l), enclose bits (nrod_eta l) with
      | Some c, Some size, Some eta => let least := mul bits c size in is_positive (Some least) && is_positive (Some (sub (sqr bits least) (sqr bits eta)))
      | _, _, _ => false
      end)
  | ParallelMin b, [] => match all_rods (nrods c) with
      | Some ls => let least := fold_left (fun p l => Times p (nrod_size l)) ls b in let d := ndeterminant (map nrod_vector ls) in
          certainly true (Minus least d) && certainly true (Plus least d)
      | None => false
      end
  (* tau_i = k det(rays with F for ray i)/det(rays) where row i is ray i over k; of which sign the former is, is told by the test *)
  | LoadMax i F b, [] => match all_rays (nrays c) with
      | Some rays => is_square n rays && Nat.eqb (length F) n && match nth_error rays i with
          | Some ray => of_row i (fun row => match all_rows_enclosed rays, all_rows_enclosed [F; row; ray], enclose bits b with
              | Some rs, Some [f; q; r], Some y => let d := sqr bits (fdeterminant rs) in let e := fdeterminant (replaced i f rs) in
                  is_positive (Some y) && is_positive (Some d) && is_positive (Some (if Nat.eqb which 0 then e else neg e)) &&
                  is_positive (Some (sub (mul bits (sqr bits e) (fsquare r)) (mul bits (mul bits (sqr bits y) d) (fsquare q))))
              | _, _, _ => false
              end)
          | None => false
          end
      | None => false
      end
  | _, _ => false
  end.

Lemma is_positive_sound : forall a x, is_positive (Some a) = true -> contains bits a x -> 0 < x.
Proof. intros a x h. cbn [is_positive] in h. apply Z.ltb_lt in h. apply contains_positive, h. Qed.

(** A row longer than k is faster than k tool in its own direction. *)
Lemma fast_row : forall row tool k, 0 < tool -> 0 <= k -> k ^ 2 < dot row row ->
  exists v, length v = length row /\ dot v v <= tool ^ 2 /\ k * tool < Rabs (dot row v).
Proof.
  intros row tool k t0 k0 h. assert (r0 : 0 < dot row row) by (pose proof (pow2_ge_0 k); lra). pose proof (sqrt_lt_R0 _ r0) as s0.
  assert (S : sqrt (dot row row) ^ 2 = dot row row) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra). set (s := sqrt (dot row row)) in *.
  exists (map (Rmult (tool / s)) row). split; [apply map_length |].
  assert (E : forall u, dot u (map (Rmult (tool / s)) row) = tool / s * dot u row).
  { intro u. clearbody s. clear. revert row. induction u as [| a u IH]; intros [| b row]; cbn [dot map]; rewrite ?IH; ring. }
  rewrite !E, dot_map, <- S. split; [right; field; lra |]. replace (tool / s * s ^ 2) with (tool * s) by (field; lra).
  rewrite Rabs_right by (apply Rle_ge, Rmult_le_pos; lra). assert (k < s) by (apply Rnot_le_lt; intro n; nra). nra.
Qed.

Lemma beyond_sound : forall least x a b angle, beyond least x a b = true -> value a <= angle <= value b ->
  coordinate_of x <> Angle (cos (in_degrees angle)) (sin (in_degrees angle)).
Proof.
  intros least [r | c s |] a b angle h [h1 h2] e; try discriminate. cbn [coordinate_of] in e. injection e as ec es.
  cbn [beyond] in h. apply andb_true_iff in h as [w h]. apply nonneg_sound in w. cbn [value] in w. pose proof PI_RGT_0.
  pose proof (unit_R_pos bits).
  assert (S : forall x, 0 <= x <= 180 -> 0 <= sin (in_degrees x)).
  { intros x [p q]. apply sin_ge_0; unfold in_degrees; [nra |]. apply Rmult_le_reg_r with 180; [lra |]. field_simplify. nra. }
  assert (D : forall x y, in_degrees (x - y) = in_degrees x - in_degrees y) by (intros; unfold in_degrees; field).
  destruct least.
  - destruct (before c s a) as [f |] eqn:ef; [| discriminate]. apply before_sound in ef. apply Z.ltb_lt, IZR_lt in h.
    rewrite ec, es, <- sin_minus, <- D in ef. pose proof (S (angle - @value names a) ltac:(lra)). destruct ef. nra.
  - destruct (before c s b) as [f |] eqn:ef; [| discriminate]. apply before_sound in ef. apply Z.ltb_lt in h.
    pose proof (contains_positive bits _ _ h ef) as P. rewrite ec, es, <- sin_minus, <- D in P.
    pose proof (S (@value names b - angle) ltac:(lra)) as Q. rewrite D, sin_minus in Q. rewrite D, sin_minus in P. lra.
Qed.

Lemma is_wider_sound : forall which A a turned vs b, is_wider which A a turned vs b = true -> 0 < norm2 (values A) -> 0 < norm2 (values a) ->
  ~ exists angle, 0 <= angle <= value b /\ Vec3.dot (values A) (values a) = sqrt (norm2 (values A)) * sqrt (norm2 (values a)) * cos (in_degrees angle).
Proof.
  intros which A a turned vs b h A0 a0 [angle [[g0 g1] e]]. pose proof PI_RGT_0. unfold is_wider in h. cbv zeta in h.
  pose proof (sqrt_lt_R0 _ A0) as sA. pose proof (sqrt_lt_R0 _ a0) as sa. assert (S : 0 < sqrt (norm2 (values A)) * sqrt (norm2 (values a))) by (apply Rmult_lt_0_compat; assumption).
  assert (D : forall x, 0 <= x -> 0 <= in_degrees x) by (intros x h0; unfold in_degrees; nra).
  assert (D2 : forall x y, x <= y -> in_degrees x <= in_degrees y) by (intros x y h0; unfold in_degrees; nra).
  assert (H180 : in_degrees 180 = PI) by (unfold in_degrees; field). assert (H90 : in_degrees 90 = PI / 2) by (unfold in_degrees; field).
  destruct (is_up_to_90 b) eqn:up.
  - apply nonneg_sound in up. cbn [value] in up. assert (C : value b <= 180 -> cos (in_degrees (value b)) <= cos (in_degrees angle)).
    { intro b1. destruct (Req_dec angle (value b)) as [-> | ne]; [lra |]. left. apply cos_decreasing_1; try (apply D; lra); try (rewrite <- H180; apply D2; lra).
      unfold in_degrees. nra. }
    specialize (C ltac:(lra)). assert (C0 : 0 <= cos (in_degrees angle)) by (apply cos_ge_0; [pose proof (D angle g0); lra | rewrite <- H90; apply D2; lra]).
    destruct which as [| [| which]]; [| | discriminate].
    + destruct vs; [| discriminate]. apply positive_sound in h. cbn [value] in h. rewrite value_product, e in h. pose proof (Rmult_le_pos _ _ (Rlt_le _ _ S) C0). lra.
    + destruct vs as [| [| x [| y [| z [|]]]] [|]]; try discriminate. apply andb_true_iff in h as [h1 h]. apply positive_sound in h1. rewrite value_product in h1.
      set (d := turned (Numbers x y z)) in *. destruct (cosine bits b) as [c |] eqn:e1; [| discriminate]. destruct (enclose bits (Times (product a a) _)) as [p |] eqn:e2; [| discriminate].
      destruct (enclose bits (Times (Times (product A a) (product A a)) (product d d))) as [q |] eqn:e3; [| discriminate]. apply andb_true_iff in h as [h2 h3]. apply cosine_sound in e1. apply enclose_sound in e2, e3.
      pose proof (is_positive_sound _ _ h2 e1) as c0.
      pose proof (is_positive_sound _ _ h3 (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ (sqr_sound bits _ _ e1) e2) e3)) as lt. cbn [value] in lt. rewrite !value_square, !value_product, e in lt.
      pose proof (cauchy_schwarz (values A) (values d)) as CS. pose proof (norm2_nonneg (values d)) as d0.
      assert (SA : sqrt (norm2 (values A)) ^ 2 = norm2 (values A)) by (apply pow2_sqrt; lra). assert (Sa : sqrt (norm2 (values a)) ^ 2 = norm2 (values a)) by (apply pow2_sqrt; lra).
      set (cb := cos (in_degrees (value b))) in *. set (ca := cos (in_degrees angle)) in *. set (u := sqrt (norm2 (values A))) in *. set (w := sqrt (norm2 (values a))) in *.
      rewrite <- Sa in lt. rewrite <- SA in CS. set (t := Vec3.dot (values A) (values d)) in *. set (m := norm2 (values d)) in *.
      assert (L : w ^ 2 * (cb ^ 2 * t ^ 2) <= w ^ 2 * (ca ^ 2 * (u ^ 2 * m))).
      { apply Rmult_le_compat_l; [apply pow2_ge_0 |]. apply Rmult_le_compat; [apply pow2_ge_0 | apply pow2_ge_0 | apply pow_incr; lra | exact CS]. }
      assert (R : cb ^ 2 * (w ^ 2 * (t * t)) - u * w * ca * (u * w * ca) * m = w ^ 2 * (cb ^ 2 * t ^ 2) - w ^ 2 * (ca ^ 2 * (u ^ 2 * m))) by ring. lra.
  - destruct which; [| discriminate]. destruct vs; [| discriminate]. apply andb_true_iff in h as [b1 h]. apply nonneg_sound in b1. cbn [value] in b1.
    destruct (cosine bits b) as [c |] eqn:e1; [| discriminate]. destruct (enclose bits (product A a)) as [p |] eqn:e2; [| discriminate].
    destruct (enclose bits (Root (Times (product a a) (product A A)))) as [q |] eqn:e3; [| discriminate]. apply cosine_sound in e1. apply enclose_sound in e2, e3.
    pose proof (sub_sound bits _ _ _ _ e2 (mul_sound bits _ _ _ _ e1 e3)) as [_ u]. cbn [is_negative] in h. apply Z.ltb_lt, IZR_lt in h. pose proof (unit_R_pos bits).
    rewrite value_product, e in u. cbn [value] in u. rewrite !value_square, sqrt_mult in u by (apply norm2_nonneg).
    assert (C : cos (in_degrees (value b)) <= cos (in_degrees angle)).
    { destruct (Req_dec angle (value b)) as [-> | ne]; [lra |]. left. apply cos_decreasing_1; try (apply D; lra); try (rewrite <- H180; apply D2; lra). unfold in_degrees. nra. }
    set (cb := cos (in_degrees (value b))) in *. set (ca := cos (in_degrees angle)) in *. set (v := sqrt (norm2 (values A))) in *. set (w := sqrt (norm2 (values a))) in *.
    assert (0 <= v * w * ca - cb * (w * v)) by nra. nra.
Qed.

Lemma wider_limb : forall n c k i (on : bool) j b which vs, stands_for c k ->
  match nth_error (nlimbs c) i with
  | Some (Some (_, A, _)) => let turned v := if on then each2 Minus (nplaced c v) (nplaced c (Numbers (0 // 1) (0 // 1) (0 // 1))) else v in
      is_wider which A (turned (nposition j)) turned vs b
  | _ => false
  end = true -> ~ fulfils n k (JointAngleMax i on j b).
Proof.
  intros n c k i on j b which vs [_ [_ [_ [LB [PL _]]]]] h F. cbn [fulfils] in F. cbv zeta in F. destruct F as [C [A [L [e [A0 [a0 F]]]]]].
  rewrite LB, nth_error_map in e. destruct (nth_error (nlimbs c) i) as [[[[C' A'] L'] |] |]; try discriminate. injection e as <- <- <-. cbv beta zeta in h.
  set (a := if on then each2 Minus (nplaced c (nposition j)) (nplaced c (Numbers (0 // 1) (0 // 1) (0 // 1))) else nposition j) in h. assert (E : (if on then vsub (placed k (located j)) (placed k vzero) else located j) = values a).
  { unfold a. destruct on; [| reflexivity]. rewrite values_minus, !PL. replace (values (Numbers (0 // 1) (0 // 1) (0 // 1))) with vzero; [reflexivity |].
    unfold values, vzero. cbn. f_equal; lra. }
  rewrite E in a0, F. exact (is_wider_sound _ _ _ _ _ _ h A0 a0 F).
Qed.

Lemma nth_combined : forall (A B : Type) (l : list A) (r : list B) i x y, nth_error l i = Some x -> nth_error r i = Some y -> nth_error (combine l r) i = Some (x, y).
Proof. induction l as [| a l IH]; intros [| b r] [| i] x y h k; try discriminate; cbn in *; [congruence | exact (IH r i x y h k)]. Qed.

Lemma fails_sound : forall n c k which vs d, stands_for c k -> reached k -> fails n c which vs d = true -> ~ fulfils n k d.
Proof.
  intros n c k which vs d stands re h F. assert (stands' := stands). destruct stands' as [J [X [B0 [LB [PL RY]]]]]. specialize (RY re). destruct RY as [_ RY]. unfold fails in h. cbv zeta in h.
  apply andb_true_iff in h as [hv h]. rewrite forallb_forall in hv.
  assert (Of : match d with JointAngleMax _ _ _ _ | Clear _ _ _ | SpeedMax _ _ _ => True | _ => forall v, In v vs -> length (map value v) = n end)
    by (destruct d; try exact I; intros v i; rewrite map_length; apply Nat.eqb_eq, hv, i).
  assert (B : forall b u, value (Times (Times (Over (1 // 1) b) (Over (1 // 1) b)) (ndot u u)) = (1 / value b) ^ 2 * dot (map value u) (map value u)).
  { intros b u. cbn [value]. rewrite value_ndot. replace (1 / 1) with 1 by field. ring. }
  assert (At : forall i x, nth_error (joints k) i = Some x -> exists y, nth_error (njoints c) i = Some y /\ x = coordinate_of y).
  { intros i x e. rewrite X, nth_error_map in e. destruct (nth_error (njoints c) i) as [y |]; [| discriminate].
    injection e as <-. exists y. split; reflexivity. }
  assert (AtRow : forall i row, nth_error (jacobian k) i = Some row -> exists y, nth_error (njacobian c) i = Some y /\ row = map value y).
  { intros i x e. rewrite J, nth_error_map in e. destruct (nth_error (njacobian c) i) as [y |]; [| discriminate]. injection e as <-. exists y. split; reflexivity. }
  assert (AtRod : forall i l, nth_error (rods k) i = Some (Some l) -> exists y, nth_error (nrods c) i = Some (Some y) /\ l = real_rod y).
  { intros i x e. rewrite B0, nth_error_map in e. destruct (nth_error (nrods c) i) as [[y |] |]; try discriminate. injection e as <-. exists y. split; reflexivity. }
  assert (Short : forall x y, 0 < x -> y ^ 2 < x ^ 2 -> Rabs y < x) by (intros x y x0 l; rewrite <- (Rabs_right x) by lra; apply Rsqr_lt_abs_0; rewrite !Rsqr_pow2; exact l).
  assert (too_fast : forall i tool b, fulfils n k (SpeedMax i tool b) -> match nth_error (njacobian c) i with Some row => Nat.eqb (length row) n && (certainly true tool && certainly true (Minus (ndot row row) (Times (Over b tool) (Over b tool)))) | None => false end &&
    match nlimbs c, vs with [], [] => true | _ :: _, [[x]] => certainly true (Times x x) | _, _ => false end = true -> False).
  { clear h F d Of hv. intros i tool b F h. cbn [fulfils] in F. apply andb_true_iff in h as [h _].
    destruct F as [row [e F]]. destruct (AtRow i _ e) as [y [e' ->]]. rewrite e' in h. apply andb_true_iff in h as [hl h]. apply Nat.eqb_eq in hl.
    apply andb_true_iff in h as [t0 h]. apply positive_sound in t0, h. cbn [value] in h. rewrite value_ndot in h.
    pose proof (Rabs_pos (value b / value tool)) as k0.
    destruct (fast_row (map value y) (value tool) (Rabs (value b / value tool)) t0 k0) as [v [lv [sv fv]]].
    { replace (Rabs (value b / value tool) ^ 2) with ((value b / value tool) ^ 2) by (rewrite <- !Rsqr_pow2; apply Rsqr_abs). lra. }
    specialize (F v ltac:(rewrite lv, map_length; exact hl) sv).
    assert (value b <= Rabs (value b / value tool) * value tool).
    { replace (value b) with (value b / value tool * value tool) at 1 by (field; lra). apply Rmult_le_compat_r; [lra | apply Rle_abs]. }
    lra. }
  destruct d as [| b | b | i b | i b | i a b | b | i tool b | i a b | a b | i tool b | i b | i b | b | i on j b | one other b | i p q b | p q b | i P b]; cbn [fulfils] in F;
    destruct vs as [| u [| v [| w vs]]]; try discriminate.
  - apply positive_sound in h. specialize (F _ (Of u ltac:(left; reflexivity))). rewrite <- B, J, <- value_nspeed2 in F.
    set (t := Times _ (ndot u u)) in *. clearbody t. cbn [value] in h. lra.
  - apply positive_sound in h. specialize (F _ (Of u ltac:(left; reflexivity))). rewrite <- B, J, <- value_nspeed2 in F.
    set (t := Times _ (ndot u u)) in *. clearbody t. cbn [value] in h. lra.
  - destruct F as [r [e l]]. destruct (At i _ e) as [y [e' q]]. rewrite e' in h. destruct y; try discriminate.
    injection q as ->. apply positive_sound in h. cbn [value] in h. lra.
  - destruct F as [r [e l]]. destruct (At i _ e) as [y [e' q]]. rewrite e' in h. destruct y; try discriminate.
    injection q as ->. apply positive_sound in h. cbn [value] in h. lra.
  - destruct F as [angle [l e]]. destruct (At i _ e) as [y [e' q]]. rewrite e' in h.
    exact (beyond_sound _ _ _ _ _ h l (eq_sym q)).
  - apply positive_sound in h. cbn [value] in h. rewrite !value_nspeed2, !value_ndot, <- J in h.
    specialize (F _ _ (Of u ltac:(left; reflexivity)) (Of v ltac:(right; left; reflexivity))). nra.
  - exact (too_fast i tool b F h).
  - exact (too_fast i tool b F h).
  - exact (too_fast i tool b F h).
  - exact (too_fast i tool b F h).
  - destruct (all_rays (nrays c)) as [rays |] eqn:er; [| discriminate]. destruct (nth_error u i) as [x |] eqn:ex; [| discriminate].
    apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2]. apply Nat.eqb_eq in h1. rewrite forallb_forall in h2.
    destruct (nth_error rays i) as [ray |] eqn:ey; [| discriminate]. destruct (nth_error (njacobian c) i) as [row |] eqn:ew; [| discriminate].
    apply andb_true_iff in h3 as [_ h3]. apply andb_true_iff in h3 as [h3 h5]. apply andb_true_iff in h3 as [h3 h4]. apply positive_sound in h3, h4, h5. cbn [value] in h5. rewrite !value_ndot in h5.
    destruct (all_rays_sound _ _ _ er RY) as [ks [k1 [k2 k3]]]. specialize (Of u ltac:(left; reflexivity)). rewrite map_length in Of.
    assert (lk : nth_error ks i <> None) by (apply nth_error_Some; rewrite k1; apply nth_error_Some; congruence). destruct (nth_error ks i) as [k0 |] eqn:ek; [clear lk | congruence].
    assert (nk : k0 <> 0) by (rewrite Forall_forall in k2; apply k2, (nth_error_In _ _ ek)).
    assert (Scale : forall q r w, dot (map (fun y => q * value y) r) w = q * dot (map value r) w).
    { intros q r w. rewrite <- dot_map, map_map. reflexivity. }
    assert (er2 : map value row = map (fun y => k0 * value y) ray).
    { assert (E : nth_error (jacobian k) i = Some (map value row)) by (rewrite J, nth_error_map, ew; reflexivity). rewrite k3, nth_error_map in E.
      rewrite (nth_combined _ _ _ _ _ _ _ ek ey) in E. cbn [option_map fst snd] in E. congruence. }
    rewrite er2, Scale, (Solve.dot_commutes (map value ray) (map (fun y => k0 * value y) ray)), Scale in h5. set (f := dot (map value (nweighted u rays)) _) in h5. set (r := dot (map value ray) (map value ray)) in *.
    destruct (too_forceful (value a) (value b) (value x) k0 r f h3 h4 (dot_self _) (dot_self _) nk) as [t [t1 t2]]; [apply Rminus_gt_0_lt, (Rlt_le_trans _ _ _ h5); right; ring |].
    set (tau := map (fun p => t * (value (fst p) / snd p)) (combine u ks)). apply (Rlt_not_le _ _ t2).
    assert (et : nth i tau 0 = t * (value x / k0)).
    { assert (E : nth_error tau i = Some (t * (value x / k0))).
      { unfold tau. rewrite nth_error_map, (nth_combined _ _ _ _ _ _ _ ex ek). reflexivity. }
      exact (nth_error_nth _ _ _ E). }
    rewrite <- et. apply (F tau (map (Rmult t) (map value (nweighted u rays)))).
    + split; [unfold tau; rewrite k3, !map_length, !combine_length; congruence |]. split.
      * rewrite !map_length. apply nweighted_length; [congruence | | intro z; rewrite z in ey; destruct i; discriminate].
        apply Forall_forall. intros y iy. apply Nat.eqb_eq, h2, iy.
      * intros w lw. rewrite dot_map, dot_nweighted, k3. unfold tau. assert (lu : length u = length rays) by congruence. clear - k1 k2 lu Scale. revert u ks k1 k2 lu.
        induction rays as [| r rays IH]; intros [| y u] [| q ks] l1 n0 l2; try discriminate; cbn [combine map dot fst snd]; [ring |]. inversion n0 as [| ? ? q0 n1]; subst.
        rewrite Scale, <- IH by (assumption || (injection l1; injection l2; auto)). field. exact q0.
    + rewrite dot_map, Solve.dot_commutes, dot_map. fold f. lra.
  - apply positive_sound in h. specialize (F _ (Of u ltac:(left; reflexivity))). rewrite J, <- value_nelastic, <- value_ndot in F. cbn [value] in h. lra.
  - destruct F as [row [e F]]. destruct (AtRow i _ e) as [y [e' ->]]. rewrite e' in h. apply andb_true_iff in h as [hl h]. apply Nat.eqb_eq in hl.
    apply andb_true_iff in h as [t0 h]. apply andb_true_iff in t0 as [t0 b0]. apply positive_sound in t0. apply nonneg_sound in b0.
    destruct (enclose bits (ndot y y)) as [sq |] eqn:e1; [| discriminate]. destruct (enclose bits (Over b tool)) as [q |] eqn:e2; [| discriminate].
    destruct (radians bits q) as [r |] eqn:e3; [| discriminate]. apply enclose_sound in e1, e2. pose proof (radians_sound bits _ _ _ e3 e2) as R0.
    pose proof (is_positive_sound _ _ h (sub_sound bits _ _ _ _ e1 (sqr_sound bits _ _ R0))) as P. rewrite value_ndot in P. cbn [value] in P.
    assert (k0 : 0 <= in_degrees (value b / value tool)).
    { unfold in_degrees. pose proof PI_RGT_0. apply Rmult_le_pos; [| lra]. apply Rmult_le_pos; [| lra]. apply Rmult_le_pos; [exact b0 | apply Rlt_le, Rinv_0_lt_compat, t0]. }
    destruct (fast_row (map value y) (value tool) (in_degrees (value b / value tool)) t0 k0) as [v [lv [sv fv]]]; [lra |].
    specialize (F v ltac:(rewrite lv, map_length; exact hl) sv).
    replace (in_degrees (value b / value tool) * value tool) with (in_degrees (value b)) in fv by (unfold in_degrees; field; lra). lra.
  - destruct F as [l [e F]]. destruct (AtRod i _ e) as [y [e' ->]]. rewrite e' in h. apply andb_true_iff in h as [p h]. apply positive_sound in p, h.
    cbn [value real_rod rod_size rod_eta] in *. pose proof (Short _ (value (nrod_eta y)) p) as K. assert (Rabs (value (nrod_eta y)) < value b * value (nrod_size y)) by (apply K; lra). lra.
  - destruct F as [l [e F]]. destruct (AtRod i _ e) as [y [e' ->]]. rewrite e' in h. destruct (cosine bits b) as [cb |] eqn:e1; [| discriminate].
    destruct (enclose bits (nrod_size y)) as [size |] eqn:e2; [| discriminate]. destruct (enclose bits (nrod_eta y)) as [eta |] eqn:e3; [| discriminate].
    apply andb_true_iff in h as [p h]. apply cosine_sound in e1. apply enclose_sound in e2, e3. pose proof (mul_sound bits _ _ _ _ e1 e2) as M.
    pose proof (is_positive_sound _ _ p M) as p'. pose proof (is_positive_sound _ _ h (sub_sound bits _ _ _ _ (sqr_sound bits _ _ M) (sqr_sound bits _ _ e3))) as h'.
    cbn [real_rod rod_size rod_eta] in F. pose proof (Short _ (value (nrod_eta y)) p') as K. assert (Rabs (value (nrod_eta y)) < cos (in_degrees (value b)) * value (nrod_size y)) by (apply K; lra). lra.
  - destruct F as [ls [e F]]. destruct (all_rods (nrods c)) as [ns |] eqn:en; [| discriminate]. apply all_rods_sound in en. rewrite B0, en, map_map in e.
    assert (El : ls = map real_rod ns).
    { clear - e. revert ls e. induction ns as [| q ns IH]; intros [| l ls] e; cbn [map] in *; try discriminate; [reflexivity |]. injection e as e1 e2. cbn [option_map] in e1. rewrite <- (IH ls e2). congruence. }
    subst ls. apply andb_true_iff in h as [h1 h2]. apply positive_sound in h1, h2. cbn [value] in h1, h2. rewrite value_ndeterminant, !map_map in h1, h2.
    rewrite map_map in F. cbn [real_rod rod_vector] in F.
    assert (P : value (fold_left (fun p l => Times p (nrod_size l)) ns b) = fold_left (fun p l => p * rod_size l) (map real_rod ns) (value b)).
    { clear. revert b. induction ns as [| q ns IH]; intro b; cbn [fold_left map]; [reflexivity |]. rewrite IH. reflexivity. }
    rewrite P in h1, h2. set (d := determinant _) in *. unfold Rabs in F. destruct (Rcase_abs d); lra.
  - exact (wider_limb n c k i on j b which _ stands h F).
  - exact (wider_limb n c k i on j b which _ stands h F).
  - exact (wider_limb n c k i on j b which _ stands h F).
  - exact (wider_limb n c k i on j b which _ stands h F).
  - destruct u as [| s [| t [| x [|]]]]; try discriminate. apply (are_nearer_sound bits _ _ _ _ _ _ (nsegment_along_sound (nlimbs c) (nplaced c) (placed k) PL) h). rewrite <- LB. exact F.
  - destruct u as [| s [| t [| x [|]]]]; discriminate.
  - destruct u as [| s [| t [| x [|]]]]; discriminate.
  - destruct (all_rays (nrays c)) as [rays |] eqn:er; [| discriminate]. apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [sq lP]. apply Nat.eqb_eq in lP.
    destruct (nth_error rays i) as [ray |] eqn:ey; [| discriminate]. destruct (nth_error (njacobian c) i) as [row |] eqn:ew; [| discriminate].
    apply andb_true_iff in h3 as [_ h]. destruct (all_rows_enclosed rays) as [frs |] eqn:e1; [| discriminate]. destruct (all_rows_enclosed [P; row; ray]) as [[| fF [| fq [| fr [|]]]] |] eqn:e2; try discriminate.
    destruct (enclose bits b) as [fb |] eqn:e3; [| discriminate]. apply andb_true_iff in h as [h h4]. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [b0 d0].
    apply all_rows_enclosed_sound in e1, e2. apply enclose_sound in e3. rewrite <- (square_map _ _ value n rays) in sq. cbn [map] in e2.
    assert (C3 : Forall2 (contains bits) fF (map value P) /\ Forall2 (contains bits) fq (map value row) /\ Forall2 (contains bits) fr (map value ray)).
    { clear - e2. inversion e2 as [| ? ? ? ? c1 e2']. inversion e2' as [| ? ? ? ? c2 e2'']. inversion e2'' as [| ? ? ? ? c3 _]. subst. repeat split; assumption. }
    destruct C3 as [c1 [c2 c3]].
    assert (li : (i < n)%nat).
    { assert (ln := sq). apply andb_true_iff in ln as [ln _]. apply andb_true_iff in ln as [_ ln]. apply Nat.eqb_eq in ln. rewrite map_length in ln. rewrite <- ln. apply nth_error_Some. congruence. }
    pose proof (fdeterminant_sound _ _ _ sq e1) as Dc.
    pose proof (fdeterminant_sound _ _ _ (square_replaced _ _ i (map value P) _ sq ltac:(rewrite map_length; exact lP) li) (replaced_related _ _ _ i _ _ _ _ c1 e1)) as Ec.
    pose proof (is_positive_sound _ _ h4 (sub_sound bits _ _ _ _ (mul_sound bits _ _ _ _ (sqr_sound bits _ _ Ec) (fsquare_sound _ _ c3))
      (mul_sound bits _ _ _ _ (mul_sound bits _ _ _ _ (sqr_sound bits _ _ e3) (sqr_sound bits _ _ Dc)) (fsquare_sound _ _ c2)))) as P4.
    pose proof (is_positive_sound _ _ d0 (sqr_sound bits _ _ Dc)) as d1. pose proof (is_positive_sound _ _ b0 e3) as b1.
    clear h4 d0 b0. rename P4 into h4, d1 into d0, b1 into b0.
    destruct (all_rays_sound _ _ _ er RY) as [ks [k1 [k2 k3]]].
    assert (lk : nth_error ks i <> None) by (apply nth_error_Some; rewrite k1; apply nth_error_Some; congruence). destruct (nth_error ks i) as [k0 |] eqn:ek; [clear lk | congruence].
    assert (nk : k0 <> 0) by (rewrite Forall_forall in k2; apply k2, (nth_error_In _ _ ek)).
    assert (er2 : map value row = map (Rmult k0) (map value ray)).
    { assert (E : nth_error (jacobian k) i = Some (map value row)) by (rewrite J, nth_error_map, ew; reflexivity). rewrite k3, nth_error_map in E.
      rewrite (nth_combined _ _ _ _ _ _ _ ek ey) in E. cbn [option_map fst snd] in E. rewrite map_map. congruence. }
    rewrite er2, dot_map, (Solve.dot_commutes _ (map (Rmult k0) _)), dot_map in h4.
    set (A := map (map value) rays) in *. set (G := map value P) in *. assert (lG : length G = n) by (unfold G; rewrite map_length; exact lP). set (D := determinant A) in *.
    assert (D0 : D <> 0) by (intro z; rewrite z in d0; replace (0 ^ 2) with 0 in d0 by ring; lra). assert (lA : length A = n) by (apply andb_true_iff in sq as [sq _]; apply andb_true_iff in sq as [_ sq]; apply Nat.eqb_eq, sq).
    set (us := map (fun j => determinant (replaced j G A)) (seq 0 n)). assert (lu : length us = length rays) by (unfold us; rewrite map_length, seq_length, <- lA; apply map_length).
    set (tau := map (fun p => fst p / (D * snd p)) (combine us ks)).
    assert (et : nth i tau 0 = determinant (replaced i G A) / (D * k0)).
    { assert (E : nth_error tau i = Some (determinant (replaced i G A) / (D * k0))); [| exact (nth_error_nth _ _ _ E)]. unfold tau. rewrite nth_error_map.
      assert (I : (i < n)%nat) by (rewrite <- lA; unfold A; rewrite map_length; apply nth_error_Some; congruence).
      assert (U : nth_error us i = Some (determinant (replaced i G A))).
      { unfold us. rewrite nth_error_map. assert (Q : nth_error (seq 0 n) i = Some i); [| rewrite Q; reflexivity].
        rewrite (nth_error_nth' _ 0%nat) by (rewrite seq_length; exact I). rewrite seq_nth by exact I. reflexivity. }
      rewrite (nth_combined _ _ _ _ _ _ _ U ek). reflexivity. }
    assert (B2 : value b < Rabs (nth i tau 0)).
    { set (e := determinant (replaced i G A)) in *. set (r := dot (map value ray) (map value ray)) in *. pose proof (dot_self (map value ray)) as r0. fold r in r0.
      assert (H4 : 0 < r * (e ^ 2 - (value b * (D * k0)) ^ 2)) by (apply (Rlt_le_trans _ _ _ h4); right; ring).
      assert (rp : 0 < r) by (destruct (Rle_lt_or_eq_dec _ _ r0) as [|z]; [assumption | rewrite <- z in H4; lra]).
      assert (E2 : 0 < e ^ 2 - (value b * (D * k0)) ^ 2) by (apply Rmult_lt_reg_l with r; lra).
      assert (Dk : D * k0 <> 0) by (apply Rmult_integral_contrapositive_currified; assumption).
      rewrite et. apply Rnot_le_lt. intro z. assert (Z : (e / (D * k0)) ^ 2 <= value b ^ 2).
      { rewrite <- (Rabs_right (value b)) in z by lra. apply Rsqr_le_abs_1 in z. rewrite !Rsqr_pow2 in z. exact z. }
      assert (S0 : 0 < (D * k0) ^ 2) by (pose proof (pow2_ge_0 (D * k0)) as s0; destruct (Rle_lt_or_eq_dec _ _ s0) as [|w]; [assumption | exfalso; apply (pow_nonzero _ 2 Dk); symmetry; exact w]).
      apply (Rmult_le_compat_l _ _ _ (Rlt_le _ _ S0)) in Z. replace ((D * k0) ^ 2 * (e / (D * k0)) ^ 2) with (e ^ 2) in Z by (field; exact Dk || (split; assumption)). lra. }
    apply (Rlt_not_le _ _ B2), F. split; [unfold tau; rewrite k3, !map_length, !combine_length; congruence |]. split; [exact lG |]. intros w lw.
    apply Rmult_eq_reg_l with D; [| exact D0]. unfold D at 1. rewrite (cramer n A G w sq lG lw). fold us. rewrite k3. unfold tau, A. clear - k1 k2 lu D0. clearbody us D. revert us ks k1 k2 lu.
    induction rays as [| r rays IH]; intros [| y u] [| q ks] l1 n0 l2; try discriminate; cbn [combine map dot fst snd]; [ring |]. inversion n0 as [| ? ? q0 n1]; subst.
    rewrite Rmult_plus_distr_l, <- IH by (assumption || (injection l1; injection l2; auto)).
    replace (map (fun x => q * value x) r) with (map (Rmult q) (map value r)) by (rewrite map_map; reflexivity). rewrite dot_map. f_equal. field. split; assumption.
Qed.

(** Of the test [number] of the demands the demand, and which of its tests it is; [parts] are those of poses near another one. *)
Section Tests.
Variable parts : nat.
Definition tests_of (d : demand) : nat :=
  match d with
  | AngleWithin _ _ _ => 2
  | JointAngleMax _ _ _ b => if is_up_to_90 b && negb (certainly false (Minus b (90 // 1))) then 2 else 1
  | OnePose _ _ _ => parts
  | LoadMax _ _ _ => 2
  | _ => 1
  end.
Fixpoint test_at (number : nat) (ds : list demand) : option (demand * nat) :=
  match ds with
  | [] => None
  | d :: ds' => if Nat.ltb number (tests_of d) then Some (d, number) else test_at (number - tests_of d) ds'
  end.

Lemma test_at_in : forall ds k d b, test_at k ds = Some (d, b) -> In d ds.
Proof.
  induction ds as [| d ds IH]; intros k e b h; [discriminate |]. cbn [test_at] in h. destruct (Nat.ltb _ _); [injection h as <- _; left; reflexivity | right; exact (IH _ _ _ h)].
Qed.
End Tests.

Inductive nfailure :=
  | NOutOfReach
  | NFails (test : nat) (directions : list (list Z))
  (* in the direction of a row of M *)
  | NFailsAlong (test row : nat)
  (* the columns of M are linearly dependent *)
  | NDependent.

Lemma rays_see : forall l rows M v, all_rays l = Some rows -> Forall2 is_ray l M -> Forall (fun row => dot (map value row) v = 0) rows -> speed2 M v = 0.
Proof.
  intros l rows M v e h. revert rows e. induction h as [| ray row l M hr h IH]; intros rows e z; cbn [all_rays] in e; [reflexivity |].
  destruct ray as [r |]; [| discriminate]. destruct hr as [k [_ ->]].
  destruct (all_rays l) as [rest |]; [| discriminate]. injection e as <-. inversion z as [| ? ? z1 z2]. subst.
  cbn [speed2 fold_right]. change (fold_right _ 0 M) with (speed2 M v). rewrite (IH rest eq_refl z2).
  assert (E : dot (map (fun x => k * value x) r) v = k * dot (map value r) v).
  { clear. revert v. induction r as [| x r IH]; intros [| y v]; cbn [map dot]; rewrite ?IH; ring. }
  rewrite E, z1. ring.
Qed.

Definition integers_of (l : list Z) : list number := map (fun k => k // 1) l.
Definition refutes (parts n : nat) (c : nconfiguration) (ds : list demand) (f : nfailure) : bool :=
  match f with
  | NOutOfReach => existsb (fun x => certainly false (Minus (0 // 1) x)) (reserves c)
  | NFails k vs => match test_at parts k ds with Some (d, which) => fails n c which (map integers_of vs) d | None => false end
  | NFailsAlong k i =>
      match test_at parts k ds, nth_error (njacobian c) i with
      | Some (FactorMin b, which), Some row => fails n c which [row] (FactorMin b)
      | _, _ => false
      end
  | NDependent => match all_rays (nrays c) with Some rows => are_dependent n rows | None => false end
  end.

Theorem refutes_sound : forall parts n c k ds f, stands_for c k -> refutes parts n c ds f = true -> ~ meets n k ds.
Proof.
  intros parts n c k ds f st h [re [inj met]]. rewrite Forall_forall in met. destruct f as [| t vs | t i |]; cbn [refutes] in h.
  - apply existsb_exists in h as [x [i h]]. apply nonneg_sound in h. cbn [value] in h.
    destruct st as [_ [_ [_ [_ [_ R]]]]]. destruct (R re) as [R' _]. rewrite Forall_forall in R'. specialize (R' x i). lra.
  - destruct (test_at parts t ds) as [[d which] |] eqn:e; [| discriminate].
    exact (fails_sound _ _ _ _ _ _ st re h (met d (test_at_in _ _ _ _ _ e))).
  - destruct (test_at parts t ds) as [[d which] |] eqn:e; [| discriminate]. destruct d; try discriminate.
    destruct (nth_error _ i); [| discriminate].
    exact (fails_sound _ _ _ _ _ _ st re h (met _ (test_at_in _ _ _ _ _ e))).
  - destruct st as [_ [_ [_ [_ [_ R]]]]]. destruct (R re) as [_ rays]. destruct (all_rays (nrays c)) as [rows |] eqn:e; [| discriminate].
    destruct (are_dependent_sound _ _ h) as [v [lv [nz z]]]. pose proof (inj v lv nz). rewrite (rays_see _ _ _ _ e rays z) in *. lra.
Qed.
End Precision.
End Named.
