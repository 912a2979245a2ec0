(** * Refutations by a machine and a point, and claims that are about something

    A witness is one machine and one point in exact numbers.  What a
    requirement says of it is again a number, built by the functions of
    Statement.v on expressions instead of reals, and enclosed (Number.v).

    The same test of membership, at the least ends of all tolerances, shows that
    a certified claim is about at least one machine and one point. *)

From Coq Require Import ZArith QArith Qreals Reals Lra Lia List Bool.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Fixed Claim.
From Orthocert.kernel Require Import Statement Arithmetic Number Dependent Machine Acceleration Problem.
From Orthocert.kernel Require Export Compare.
Import ListNotations.
Local Open Scope R_scope.

Section Named.
Context {names : naming}.


Section Precision.
Variable bits : positive.
Local Notation certainly := (certainly bits).
Local Notation below := (below bits).
Local Notation positive_sound := (positive_sound bits).
Local Notation nonneg_sound := (nonneg_sound bits).
Local Notation below_sound := (below_sound bits).

(** ** Vectors of numbers *)

Record numbers := Numbers { nx : number; ny : number; nz : number }.
Definition values (a : numbers) : vec := Vec (value (nx a)) (value (ny a)) (value (nz a)).

Definition each2 (f : number -> number -> number) (a b : numbers) : numbers :=
  Numbers (f (nx a) (nx b)) (f (ny a) (ny b)) (f (nz a) (nz b)).
Definition scaled (k : number) (a : numbers) : numbers := Numbers (Times k (nx a)) (Times k (ny a)) (Times k (nz a)).
Definition product (a b : numbers) : number := Plus (Plus (Times (nx a) (nx b)) (Times (ny a) (ny b))) (Times (nz a) (nz b)).
Definition unit_of (a : numbers) : numbers := scaled (Over (1 // 1) (Root (product a a))) a.

Lemma values_plus : forall a b, values (each2 Plus a b) = vadd (values a) (values b).
Proof. reflexivity. Qed.
Lemma values_minus : forall a b, values (each2 Minus a b) = vsub (values a) (values b).
Proof. reflexivity. Qed.
Lemma values_scaled : forall k a, values (scaled k a) = vscale (value k) (values a).
Proof. reflexivity. Qed.
Lemma value_product : forall a b, value (product a b) = dot (values a) (values b).
Proof. reflexivity. Qed.
Lemma value_square : forall a, value (product a a) = norm2 (values a).
Proof. intro a. rewrite norm2_dot. reflexivity. Qed.
Lemma values_unit : forall a, values (unit_of a) = normalised (values a).
Proof.
  intro a. unfold unit_of, normalised. rewrite values_scaled. f_equal. cbn [value]. rewrite value_square.
  generalize (sqrt (norm2 (values a))). intro x. unfold Rdiv. rewrite Rinv_1. ring.
Qed.

(** ** A machine *)

Inductive exact_leg :=
  | ExactSlider (direction anchor platform : numbers) (length : number) (mode : bool)
  | ExactStrut (anchor platform : numbers) (base_axis : option numbers)
  | ExactPlanar (direction : numbers).

Definition leg_of (l : exact_leg) : Statement.leg :=
  match l with
  | ExactSlider d a p len m => Guided (Leg (normalised (values d)) (values a) (values p) (value len) (if m then 1 else -1))
  | ExactStrut a p k => Extensible (values a) (values p) (option_map (fun k => normalised (values k)) k)
  | ExactPlanar d => Plane (values d)
  end.

Definition part (t : tolerance) (x : number) : bool := below (least t) x && below x (greatest t).
Definition parts (t : tolerances) (a : numbers) : bool := part (tx t) (nx a) && part (ty t) (ny a) && part (tz t) (nz a).

Lemma part_sound : forall t x, part t x = true -> within t (value x).
Proof. intros t x h. apply andb_true_iff in h as [h k]. split; apply below_sound; assumption. Qed.
Lemma parts_sound : forall t a, parts t a = true -> all_within t (values a).
Proof.
  intros t a h. apply andb_true_iff in h as [h k]. apply andb_true_iff in h as [h j].
  split; [| split]; apply part_sound; assumption.
Qed.

Definition is_exact (d : drive) (l : exact_leg) : bool :=
  match d, l with
  | SliderLeg c, ExactSlider d a p len m =>
      parts (direction c) d && certainly true (product d d) && parts (anchor c) a && parts (platform c) p
      && part (length c) len && certainly true len && Bool.eqb (mode c) m
  | StrutLeg a p k, ExactStrut a' p' k' => parts a a' && parts p p' &&
      match k, k' with Some k, Some k' => parts k k' && certainly true (product k' k') | None, None => true | _, _ => false end
  | PlanarLeg d, ExactPlanar d' => parts d d' && certainly true (product d' d')
  | _, _ => false
  end.

Lemma is_exact_sound : forall d l, is_exact d l = true -> is_leg_of d (leg_of l) /\ well_formed_leg (leg_of l).
Proof.
  intros [c | a p k | n] [d' a' p' len m | a' p' k' | n'] h; cbn [is_exact] in h; try discriminate;
    cbn [is_leg_of leg_of well_formed_leg].
  - do 6 (apply andb_true_iff in h as [h ?]). match goal with k : Bool.eqb _ _ = true |- _ => apply Bool.eqb_prop in k; subst m end.
    repeat match goal with
    | k : parts _ _ = true |- _ => apply parts_sound in k
    | k : part _ _ = true |- _ => apply part_sound in k
    | k : certainly true _ = true |- _ => apply positive_sound in k
    end.
    rewrite value_square in *. split.
    + unfold is_leg. cbn [axis base_point platform_offset leg_length working_mode].
      split; [exists (values d'); split; [assumption | reflexivity] | auto].
    + unfold well_formed. cbn [axis leg_length working_mode]. split; [apply normalised_norm; assumption |].
      split; [assumption |]. destruct (mode c); auto.
  - apply andb_true_iff in h as [h hk]. apply andb_true_iff in h as [h g]. apply parts_sound in h, g.
    destruct k as [k |], k' as [k' |]; try discriminate; cbn [option_map]; [| tauto].
    apply andb_true_iff in hk as [hk n0]. apply parts_sound in hk. apply positive_sound in n0. rewrite value_square in n0.
    split; [| apply normalised_norm, n0]. split; [exact h |]. split; [exact g |]. exists (values k'). split; [exact hk | reflexivity].
  - apply andb_true_iff in h as [h H]. apply positive_sound in H. rewrite value_square in H. split; [apply parts_sound; exact h |].
    intro z. rewrite z in H. unfold norm2, vzero in H. cbn in H. lra.
Qed.

Fixpoint is_one_of (ds : list drive) (ls : list exact_leg) : bool :=
  match ds, ls with
  | [], [] => true
  | d :: ds', l :: ls' => is_exact d l && is_one_of ds' ls'
  | _, _ => false
  end.

(** A machine of the claim that can be built, at a point of its workspace. *)
Definition is_in (w : region) (P : numbers) : bool :=
  match w with
  | Box edges => parts edges P
  | Cylinder x y r height =>
      let dx := Minus (nx P) x in let dy := Minus (ny P) y in
      certainly false (Minus (Minus (Times r r) (Times dx dx)) (Times dy dy)) && certainly false r && part height (nz P)
  end.

Lemma is_in_sound : forall w P, is_in w P = true -> in_region w (values P).
Proof.
  intros [edges | x y r height] P h; [apply parts_sound, h |]. cbn [is_in] in h. cbv zeta in h.
  apply andb_true_iff in h as [h hz]. apply andb_true_iff in h as [h r0]. apply nonneg_sound in h, r0. apply part_sound in hz.
  cbn [value] in h. cbn [in_region values vx vy vz]. split; [nra |]. split; assumption.
Qed.

Definition admits (c : claim) (ls : list exact_leg) (P : numbers) : bool := is_one_of (legs c) ls && is_in (workspace c) P.
Definition is_about (c : claim) (m : list Statement.leg) (P : vec) : Prop :=
  is_machine c m /\ Forall well_formed_leg m /\ in_region (workspace c) P.

Lemma admits_sound : forall c ls P, admits c ls P = true -> is_about c (map leg_of ls) (values P).
Proof.
  intros c ls P h. apply andb_true_iff in h as [h p]. unfold is_about, is_machine. apply is_in_sound in p.
  assert (K : forall ds ls, is_one_of ds ls = true -> Forall2 is_leg_of ds (map leg_of ls) /\ Forall well_formed_leg (map leg_of ls)).
  { induction ds as [| d ds IH]; intros [| l k] e; cbn [is_one_of map] in *; try discriminate; [split; constructor |].
    apply andb_true_iff in e as [e1 e2]. destruct (IH k e2), (is_exact_sound d l e1). split; constructor; assumption. }
  destruct (K _ _ h). tauto.
Qed.

(** ** What a claim says of one machine at one point, in numbers *)

Definition nspan (a p P : numbers) : numbers := each2 Minus (each2 Plus P p) a.
Definition across (d a p P : numbers) : numbers :=
  let w := nspan a p P in each2 Minus w (scaled (product (unit_of d) w) (unit_of d)).
Definition clearance2 (d a p : numbers) (len : number) (P : numbers) : number :=
  let r := across d a p P in Minus (Times len len) (product r r).
Definition signed_root (m : bool) (x : number) : number := if m then Root x else Minus (0 // 1) (Root x).

Definition nrow (l : exact_leg) (P : numbers) : numbers :=
  match l with
  | ExactSlider d a p len m =>
      each2 Plus (unit_of d) (scaled (Over (1 // 1) (signed_root m (clearance2 d a p len P))) (across d a p P))
  | ExactStrut a p _ => unit_of (nspan a p P)
  | ExactPlanar d => unit_of d
  end.
(** A multiple of the row, which may be in fractions where the row is not: the vector of a leg that has one. *)
Definition nray (l : exact_leg) (P : numbers) : numbers :=
  match l with
  | ExactSlider d a p len m => each2 Plus (across d a p P) (scaled (signed_root m (clearance2 d a p len P)) (unit_of d))
  | ExactStrut a p _ => nspan a p P
  | ExactPlanar d => unit_of d
  end.
Definition njoint (l : exact_leg) (P : numbers) : number :=
  match l with
  | ExactSlider d a p len m => Minus (product (unit_of d) (nspan a p P)) (signed_root m (clearance2 d a p len P))
  | ExactStrut a p _ => Root (product (nspan a p P) (nspan a p P))
  | ExactPlanar d => product (unit_of d) P
  end.
(** The leg reaches the point where this is positive. *)
Definition reserve (l : exact_leg) (P : numbers) : option number :=
  match l with
  | ExactSlider d a p len m => Some (clearance2 d a p len P)
  | ExactStrut a p _ => Some (product (nspan a p P) (nspan a p P))
  | ExactPlanar _ => None
  end.

Lemma values_across : forall d a p len m P,
  values (across d a p P) = r (Leg (normalised (values d)) (values a) (values p) len m) (values P).
Proof.
  intros. unfold across. cbv zeta. rewrite values_minus, values_scaled, value_product, values_unit. reflexivity.
Qed.

Lemma value_clearance2 : forall d a p len m P,
  value (clearance2 d a p len P) = value len ^ 2 - norm2 (r (Leg (normalised (values d)) (values a) (values p) (value len) m) (values P)).
Proof.
  intros. unfold clearance2. cbv zeta. cbn [value]. rewrite value_square, (values_across d a p (value len) m P). ring.
Qed.

Lemma value_signed_root : forall d a p len m P,
  value (signed_root m (clearance2 d a p len P))
  = eta (Leg (normalised (values d)) (values a) (values p) (value len) (if m then 1 else -1)) (values P).
Proof.
  intros d a p len m P. unfold eta, s. cbn [leg_length working_mode].
  rewrite <- (value_clearance2 d a p len (if m then 1 else -1) P).
  destruct m; cbn [signed_root value]; unfold Rdiv; rewrite ?Rmult_0_l; ring.
Qed.

Lemma values_row : forall l P, values (nrow l P) = row (leg_of l) (values P).
Proof.
  intros [d a p len m | a p k | d] P; cbn [nrow row leg_of].
  - rewrite values_plus, values_scaled, values_unit. cbn [value].
    rewrite value_signed_root, (values_across d a p (value len) (if m then 1 else -1) P). unfold Jinv_row. cbn [axis].
    f_equal. f_equal. unfold Rdiv. rewrite Rinv_1. ring.
  - rewrite values_unit. reflexivity.
  - apply values_unit.
Qed.

Lemma values_ray : forall l P, reaches (values P) (leg_of l) -> exists k, k <> 0 /\ row (leg_of l) (values P) = vscale k (values (nray l P)).
Proof.
  intros [d a p len m | a p k | d] P h; cbn [nray row leg_of reaches] in *.
  - assert (H : eta (Leg (normalised (values d)) (values a) (values p) (value len) (if m then 1 else -1)) (values P) <> 0)
      by (unfold eta; cbn [working_mode]; destruct m; lra).
    rewrite values_plus, values_scaled, values_unit, value_signed_root, (values_across d a p (value len) (if m then 1 else -1) P).
    set (e := eta _ _) in *. exists (/ e). split; [apply Rinv_neq_0_compat, H |]. unfold Jinv_row. cbn [axis]. fold e. set (q := r _ _).
    unfold vadd, vscale. cbn [vx vy vz]. f_equal; field; exact H.
  - exists (/ sqrt (norm2 (span (values a) (values p) (values P)))). split; [apply Rinv_neq_0_compat, Rgt_not_eq, sqrt_lt_R0, h | reflexivity].
  - exists 1. split; [lra |]. rewrite values_unit. unfold vscale. destruct (normalised (values d)) as [x y z]. cbn [vx vy vz]. f_equal; ring.
Qed.

Lemma value_joint : forall l P, value (njoint l P) = joint (leg_of l) (values P).
Proof.
  intros [d a p len m | a p k | d] P; cbn [njoint joint leg_of].
  - cbn [value]. rewrite value_product, value_signed_root, values_unit. reflexivity.
  - cbn [value]. rewrite value_square. reflexivity.
  - rewrite value_product, values_unit. reflexivity.
Qed.

Lemma reserve_sound : forall l P x, reserve l P = Some x -> value x <= 0 -> ~ reaches (values P) (leg_of l).
Proof.
  intros [d a p len m | a p k | d] P x h n; cbn [reserve] in h; [| | discriminate]; injection h as <-; cbn [reaches leg_of].
  - rewrite (value_clearance2 d a p len (if m then 1 else -1) P) in n. unfold s. cbn [leg_length].
    rewrite sqrt_neg_0 by exact n. lra.
  - rewrite value_square in n. change (values (nspan a p P)) with (span (values a) (values p) (values P)) in n. lra.
Qed.

(** |M v|^2 *)
Definition nspeed2 (ls : list exact_leg) (P v : numbers) : number :=
  fold_right (fun l sum => Plus (Times (product (nrow l P) v) (product (nrow l P) v)) sum) (0 // 1) ls.

Lemma value_speed2 : forall ls P v, value (nspeed2 ls P v) = speed2 (map leg_of ls) (values P) (values v).
Proof.
  intros ls P v. induction ls as [| l ls IH]; cbn [nspeed2 speed2 map fold_right value]; [lra |].
  unfold nspeed2, speed2 in IH. rewrite IH, value_product, values_row. ring.
Qed.

Fixpoint nelastic2 (ks : list number) (ls : list exact_leg) (P v : numbers) : number :=
  match ks, ls with k :: ks', l :: ls' => Plus (Times k (Times (product (nrow l P) v) (product (nrow l P) v))) (nelastic2 ks' ls' P v) | _, _ => 0 // 1 end.

Lemma value_elastic2 : forall ks ls P v, value (nelastic2 ks ls P v) = elastic ks (map leg_of ls) (values P) (values v).
Proof.
  assert (Z : value (0 // 1) = 0) by (cbn; lra).
  induction ks as [| k ks IH]; intros [| l ls] P v; try exact Z. cbn [nelastic2 elastic map value]. rewrite IH, value_product, values_row. ring.
Qed.

(** ** Refutations *)

Definition integers (v : Z * Z * Z) : numbers := let '(a, b, c) := v in Numbers (a // 1) (b // 1) (c // 1).

Inductive failure :=
  | OutOfReach
  (* of a requirement, in directions where it is about all *)
  | Fails (number : nat) (u v : Z * Z * Z)
  (* of a requirement, in the direction of a leg's row *)
  | FailsAlong (number leg : nat)
  (* the columns of M are linearly dependent *)
  | AreDependent.

(** The determinant of legs' vectors, and their sizes. *)
Definition nsize (l : exact_leg) (P : numbers) : number :=
  match l with ExactSlider _ _ _ len _ => len | ExactStrut a p _ => Root (product (nspan a p P) (nspan a p P)) | ExactPlanar _ => 1 // 1 end.
Definition ndet (a b c : numbers) : number :=
  product a (Numbers (Minus (Times (ny b) (nz c)) (Times (nz b) (ny c))) (Minus (Times (nz b) (nx c)) (Times (nx b) (nz c)))
    (Minus (Times (nx b) (ny c)) (Times (ny b) (nx c)))).

(** The couples that struts with a base axis constrain. *)
Definition ncouple (l : exact_leg) (P : numbers) : option numbers :=
  match l with
  | ExactStrut a p (Some k) =>
      let w := nspan a p P in Some (each2 Minus w (scaled (product (unit_of k) w) (unit_of k)))
  | _ => None
  end.
Fixpoint ncouples (ls : list exact_leg) (P : numbers) : option (list numbers) :=
  match ls with
  | [] => Some []
  | l :: ls' => match ncouple l P, ncouples ls' P with Some c, Some cs => Some (c :: cs) | _, _ => None end
  end.
Definition ncouples2 (cs : list numbers) (v : numbers) : number :=
  fold_right (fun c sum => Plus (Times (product (unit_of c) v) (product (unit_of c) v)) sum) (0 // 1) cs.

(** The segments of bodies. *)
Definition nposition (p : position) : numbers := Numbers (px p) (py p) (pz p).
Definition nrod (l : exact_leg) (P : numbers) : option (numbers * numbers * number) :=
  match l with
  | ExactSlider d a p len m =>
      Some (each2 Plus P p, each2 Plus (across d a p P) (scaled (signed_root m (clearance2 d a p len P)) (unit_of d)), len)
  | ExactStrut a p _ => let w := nspan a p P in Some (each2 Plus P p, w, Root (product w w))
  | ExactPlanar _ => None
  end.
Definition nsegment_along (rods : list (option (numbers * numbers * number))) (nplaced : numbers -> numbers) (b : body) : option (numbers * numbers) :=
  match b with
  | AlongLeg i _ t u o =>
      match nth_error rods i with
      | Some (Some (C, A, L)) => let part x := each2 Plus (each2 Minus C (scaled x A)) (nposition o) in
          Some (part (Minus (1 // 1) (Over t L)), part (Over u L))
      | _ => None
      end
  | OnBase _ p q => Some (nposition p, nposition q)
  | OnPlatform _ p q => Some (nplaced (nposition p), nplaced (nposition q))
  end.
Definition nsegment (ls : list exact_leg) (P : numbers) : body -> option (numbers * numbers) := nsegment_along (map (fun l => nrod l P) ls) (each2 Plus P).
(** [k] parts of [n] from one end to the other, times [n]. *)
Definition ntowards (n k : number) (p p' : numbers) : numbers := each2 Plus (scaled (Minus n k) p) (scaled k p').

(** The greatest acceleration of a joint at these of the platform. *)
Definition nacceleration (l : exact_leg) (P : numbers) (a v : number) : number :=
  match l with
  | ExactSlider d a0 p len m => let t := Over len (Root (clearance2 d a0 p len P)) in Times t (Plus a (Times (Over (Times v v) len) (Times t t)))
  | ExactStrut a0 p _ => Plus a (Over (Times v v) (Root (product (nspan a0 p P) (nspan a0 p P))))
  | ExactPlanar _ => a
  end.

(** Points of two segments that are nearer than the bodies' radii and [b]: parts of [nz u] from one end to the other. *)
Definition are_nearer (segment : body -> option (numbers * numbers)) (u : numbers) (one other : body) (b : number) : bool :=
  match segment one, segment other with
  | Some (p, p'), Some (q, q') =>
      let s := nx u in let t := ny u in let n := nz u in
      let w := each2 Minus (ntowards n s p p') (ntowards n t q q') in
      let d := Times n (Plus (Plus (radius_of one) (radius_of other)) b) in
      certainly true n && certainly false s && certainly false (Minus n s) && certainly false t && certainly false (Minus n t) &&
      certainly true (Minus (Times d d) (product w w))
  | _, _ => false
  end.

(** Joint forces tau_j = B_j u_j, where row j is ray j over B_j, hold the force sum_j u_j ray_j: (tool tau_i)^2 > (b |F|)^2, times |row_i|^2 = |ray_i|^2/B_i^2. *)
Definition is_forceful {A : Type} (dot : A -> A -> number) (tool b u : number) (F row ray : A) : bool :=
  certainly true tool && certainly true b &&
  certainly true (Minus (Times (Times (Times tool tool) (Times u u)) (dot ray ray)) (Times (Times b b) (Times (dot F F) (dot row row)))).

Definition fails (ls : list exact_leg) (P u v : numbers) (r : requirement) : bool :=
  let bound b := Times (Times (Over (1 // 1) b) (Over (1 // 1) b)) (product u u) in
  let of i f := match nth_error ls i with Some l => certainly true (f l) | None => false end in
  match r with
  | NotSingular => false
  | PsiMax b => certainly true (Minus (bound b) (nspeed2 ls P u))
  | PsiMin b => certainly true (Minus (nspeed2 ls P u) (bound b))
  | JointMin i b => of i (fun l => Minus b (njoint l P))
  | JointMax i b => of i (fun l => Minus (njoint l P) b)
  (* the fastest is along the row: tool |row| > b *)
  | JointSpeed i tool b => of i (fun l => Minus (Times (Times tool tool) (product (nrow l P) (nrow l P))) (Times b b))
  | ConditionMax b =>
      certainly true (Minus (Times (nspeed2 ls P u) (product v v)) (Times (Times b b) (Times (nspeed2 ls P v) (product u u))))
  | SerialMargin i b =>
      match nth_error ls i with
      | Some (ExactSlider d a p len m as l) => let e := signed_root m (clearance2 d a p len P) in
          certainly true (Minus (Times (Times b len) (Times b len)) (Times e e))
      | _ => false
      end
  | ParallelMargin b =>
      match ls with
      | [k1; k2; k3] =>
          let least := Times (Times (Times b (nsize k1 P)) (nsize k2 P)) (nsize k3 P) in let d := ndet (nray k1 P) (nray k2 P) (nray k3 P) in
          certainly true (Minus least d) && certainly true (Plus least d)
      | _ => false
      end
  | Stiffness joint b => certainly true (Minus (Times (Over b joint) (product u u)) (nspeed2 ls P u))
  | ConstraintMargin b =>
      match ncouples ls P with
      | Some cs => certainly true (Minus (Times (Times b b) (product u u)) (ncouples2 cs u))
      | None => false
      end
  | Clearance one other b => are_nearer (nsegment ls P) u one other b
  | JointForce i tool b =>
      match ls, nth_error [nx u; ny u; nz u] i, nth_error ls i with
      | [k1; k2; k3], Some x, Some l =>
          is_forceful product tool b x (each2 Plus (each2 Plus (scaled (nx u) (nray k1 P)) (scaled (ny u) (nray k2 P))) (scaled (nz u) (nray k3 P))) (nrow l P) (nray l P)
      | _, _, _ => false
      end
  | Stiffnesses ks b => certainly true (Minus (Times b (product u u)) (nelastic2 ks ls P u))
  (* the lines are nearest where d + x A is orthogonal to A *)
  | Beside i one other b =>
      match nth_error ls i with
      | Some l => match nrod l P with
          | Some (C, A, L) =>
              let d := each2 Minus (nposition one) (nposition other) in
              certainly true (product A A) &&
              certainly true (Minus (Times b b) (Minus (product d d) (Over (Times (product d A) (product d A)) (product A A))))
          | None => false
          end
      | None => false
      end
  | JointAcceleration i a v b =>
      match nth_error ls i with
      | Some l => certainly false a && certainly false v && certainly true (Minus (nacceleration l P a v) b) &&
          match l with ExactPlanar _ => certainly true (product u u) | _ => true end
      | None => false
      end
  | OneToOne | Accuracy _ _ => false
  end.

Definition refute (c : claim) (ls : list exact_leg) (P : numbers) (f : failure) : bool :=
  admits c ls P &&
  match f with
  | OutOfReach => existsb (fun l => match reserve l P with Some x => certainly false (Minus (0 // 1) x) | None => false end) ls
  | Fails i u v => match nth_error (require c) i with Some r => fails ls P (integers u) (integers v) r | None => false end
  | FailsAlong i leg =>
      match nth_error (require c) i, nth_error ls leg with Some r, Some l => fails ls P (nrow l P) (nrow l P) r | _, _ => false end
  | AreDependent => are_dependent 3 (map (fun l => let q := nray l P in [nx q; ny q; nz q]) ls)
  end.

Lemma values_vector : forall l P, values (nray l P) = vector_of (leg_of l) (values P) /\ value (nsize l P) = size_of (leg_of l) (values P).
Proof.
  intros [d a p len m | a p k | d] P; cbn [nray nsize vector_of size_of leg_of].
  - split; [| reflexivity]. rewrite values_plus, values_scaled, values_unit, value_signed_root, leg_vector_eq,
      (values_across d a p (value len) (if m then 1 else -1) P). reflexivity.
  - split; [reflexivity |]. cbn [value]. rewrite value_square. reflexivity.
  - split; [apply values_unit | cbn; field].
Qed.

Lemma value_ndet : forall a b c, value (ndet a b c) = det (Mat (values a) (values b) (values c)).
Proof. intros. unfold ndet. rewrite value_product. unfold det, cross, dot, values. cbn [vx vy vz nx ny nz value row1 row2 row3]. ring. Qed.

Lemma ncouple_sound : forall l P c, ncouple l P = Some c -> couple_of (leg_of l) (values P) = Some (values c).
Proof.
  intros [| a p [k |] |] P c h; try discriminate. cbn [ncouple] in h. injection h as <-.
  cbn [leg_of option_map couple_of]. f_equal. unfold couple. rewrite values_minus, values_scaled, value_product, values_unit. reflexivity.
Qed.

Lemma ncouples_sound : forall ls P ns cs, ncouples ls P = Some ns ->
  Forall2 (fun l c => couple_of l (values P) = Some c /\ c <> vzero) (map leg_of ls) cs -> cs = map values ns.
Proof.
  induction ls as [| l ls IH]; intros P ns cs e h; cbn [ncouples map] in *.
  - injection e as <-. inversion h. reflexivity.
  - destruct (ncouple l P) as [c |] eqn:ec; [| discriminate]. destruct (ncouples ls P) as [r |] eqn:er; [| discriminate].
    injection e as <-. inversion h as [| ? d ? ds [h1 _] h2]. subst. rewrite (ncouple_sound _ _ _ ec) in h1. cbn [map].
    f_equal; [congruence | apply (IH P); [exact er | exact h2]].
Qed.

Lemma value_couples2 : forall cs v, value (ncouples2 cs v) = fold_right (fun c sum => dot (normalised c) (values v) ^ 2 + sum) 0 (map values cs).
Proof.
  intros cs v. induction cs as [| c cs IH]; [cbn; lra |]. cbn [ncouples2 map fold_right value]. unfold ncouples2 in IH.
  rewrite IH, value_product, values_unit. ring.
Qed.

Lemma nrod_sound : forall l P C A L, nrod l P = Some (C, A, L) -> rod_of (leg_of l) (values P) = Some (values C, values A, value L).
Proof.
  intros [d a p0 len m | a p0 k | d] P C A L e; cbn [nrod] in e; [| | discriminate]; injection e as <- <- <-; cbn [leg_of rod_of].
  - rewrite leg_vector_eq, values_plus, values_plus, values_scaled, values_unit, value_signed_root,
      (values_across d a p0 (value len) (if m then 1 else -1) P). reflexivity.
  - rewrite values_plus. cbn [value]. rewrite value_square. reflexivity.
Qed.

Definition real_rod (l : numbers * numbers * number) : vec * vec * R := let '(C, A, L) := l in (values C, values A, value L).
Lemma nsegment_along_sound : forall rods (nplaced : numbers -> numbers) placed, (forall b, values (nplaced b) = placed (values b)) -> forall b p q,
  nsegment_along rods nplaced b = Some (p, q) -> segment_along (map (option_map real_rod) rods) placed b = Some (values p, values q).
Proof.
  intros rods nplaced placed pl [i r t u o | r a c | r a c] p q h; cbn [nsegment_along segment_along] in *.
  - rewrite nth_error_map. destruct (nth_error rods i) as [[[[C A] L] |] |]; try discriminate. cbn [option_map real_rod]. cbv zeta in h. injection h as <- <-.
    rewrite !values_plus, !values_minus, !values_scaled. cbn [value]. replace (1 / 1) with 1 by field. reflexivity.
  - injection h as <- <-. reflexivity.
  - injection h as <- <-. rewrite !pl. reflexivity.
Qed.
Lemma nsegment_sound : forall ls P b p q, nsegment ls P b = Some (p, q) -> segment_of (map leg_of ls) (values P) b = Some (values p, values q).
Proof.
  intros ls P b p q h. unfold segment_of, nsegment in *. pose proof (nsegment_along_sound _ (each2 Plus P) (vadd (values P)) (values_plus P) _ _ _ h) as E.
  destruct b as [i r t u o | r a c | r a c]; try exact E. cbn [nsegment_along segment_along] in *. rewrite !map_map, !nth_error_map in *.
  destruct (nth_error ls i) as [l |]; [| discriminate]. cbn [option_map] in *. destruct (nrod l P) as [[[C A] L] |] eqn:e; [| discriminate].
  rewrite (nrod_sound _ _ _ _ _ e). exact E.
Qed.

Lemma are_nearer_sound : forall nsegment segment u one other b, (forall a p q, nsegment a = Some (p, q) -> segment a = Some (values p, values q)) ->
  are_nearer nsegment u one other b = true -> ~ are_clear segment one other b.
Proof.
  intros nsegment segment u one other b sound h F. unfold are_nearer in h.
  destruct (nsegment one) as [[a a'] |] eqn:s1; [| discriminate]. destruct (nsegment other) as [[c c'] |] eqn:s2; [| discriminate].
  cbv zeta in h. do 5 (apply andb_true_iff in h as [h ?]).
  repeat match goal with k : certainly true _ = true |- _ => apply positive_sound in k | k : certainly false _ = true |- _ => apply nonneg_sound in k end.
  destruct F as [p [p' [q [q' [g1 [g2 F]]]]]]. rewrite (sound _ _ _ s1) in g1. rewrite (sound _ _ _ s2) in g2.
  assert (e1 : values a = p) by congruence. assert (e2 : values a' = p') by congruence.
  assert (e3 : values c = q) by congruence. assert (e4 : values c' = q') by congruence. subst p p' q q'.
  match goal with k : 0 < value (Minus (Times _ _) _) |- _ => rename k into far end. cbn [value] in far. rewrite value_square in far.
  cbn [value] in *. set (n := value (nz u)) in *. set (x := value (nx u)) in *. set (y := value (ny u)) in *.
  set (d := value (radius_of one) + value (radius_of other) + value b) in *.
  assert (I : forall z, 0 <= z -> 0 <= n - z -> 0 <= z / n <= 1).
  { intros z z0 z1. split; [apply Rmult_le_pos; [exact z0 | apply Rlt_le, Rinv_0_lt_compat, h] |].
    apply Rmult_le_reg_r with n; [exact h |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
  specialize (F (x / n) (y / n) (I x ltac:(assumption) ltac:(assumption)) (I y ltac:(assumption) ltac:(assumption))).
  assert (E : values (each2 Minus (ntowards (nz u) (nx u) a a') (ntowards (nz u) (ny u) c c')) =
    vscale n (vsub (towards (x / n) (values a) (values a')) (towards (y / n) (values c) (values c')))).
  { unfold ntowards. rewrite values_minus, !values_plus, !values_scaled. cbn [value]. fold n x y.
    unfold towards, vsub, vadd, vscale. cbn [vx vy vz]. f_equal; field; lra. }
  rewrite E, norm2_scale in far. assert (n ^ 2 * d ^ 2 <= n ^ 2 * norm2 (vsub (towards (x / n) (values a) (values a')) (towards (y / n) (values c) (values c'))))
    by (apply Rmult_le_compat_l; [apply pow2_ge_0 | exact F]). nra.
Qed.

(** Of a joint force u/k where the row is k times the ray, of which |ray|^2 = r and |F|^2 = f. *)
Lemma too_forceful : forall tool b u k r f, 0 < tool -> 0 < b -> 0 <= f -> 0 <= r -> k <> 0 -> b ^ 2 * (f * (k ^ 2 * r)) < tool ^ 2 * u ^ 2 * r ->
  exists t, t ^ 2 * f <= tool ^ 2 /\ b < Rabs (t * (u / k)).
Proof.
  intros tool b u k r f t0 b0 f0 r0 k0 h. assert (r1 : 0 < r) by (destruct (Req_dec r 0) as [-> |]; lra).
  assert (k2 : 0 < k ^ 2) by (rewrite <- Rsqr_pow2; apply Rlt_0_sqr, k0).
  assert (H : b ^ 2 * (f * k ^ 2) < tool ^ 2 * u ^ 2) by (apply Rmult_lt_reg_r with r; [exact r1 | lra]).
  assert (W : forall t, b ^ 2 * k ^ 2 < t ^ 2 * u ^ 2 -> b < Rabs (t * (u / k))).
  { intros t ht. rewrite <- (Rabs_right b) by lra. apply Rsqr_lt_abs_0. unfold Rsqr. apply Rmult_lt_reg_r with (k ^ 2); [exact k2 |].
    replace (t * (u / k) * (t * (u / k)) * k ^ 2) with (t ^ 2 * u ^ 2) by (field; exact k0). lra. }
  assert (B : 0 <= b ^ 2 * (f * k ^ 2)) by (apply Rmult_le_pos; [apply pow2_ge_0 | apply Rmult_le_pos; lra]). assert (u2 : 0 < u ^ 2).
  { pose proof (pow2_ge_0 u). destruct (Req_dec (u ^ 2) 0) as [e |]; [rewrite e in H |]; lra. }
  destruct (Req_dec f 0) as [z | z].
  - exists ((b + 1) * k / u). assert (u0 : u <> 0) by (intro e; rewrite e in u2; lra). split; [rewrite z; pose proof (pow2_ge_0 tool); lra |].
    apply W. replace (((b + 1) * k / u) ^ 2 * u ^ 2) with ((b + 1) ^ 2 * k ^ 2) by (field; exact u0). apply Rmult_lt_compat_r; [exact k2 | nra].
  - assert (f1 : 0 < f) by lra. pose proof (sqrt_lt_R0 f f1) as s0. assert (S : sqrt f ^ 2 = f) by (apply pow2_sqrt; lra).
    exists (tool / sqrt f). assert (E : (tool / sqrt f) ^ 2 = tool ^ 2 / f) by (unfold Rdiv; rewrite Rpow_mult_distr, pow_inv, S; reflexivity).
    rewrite E. split; [right; field; lra |]. apply W. rewrite E. apply Rmult_lt_reg_r with f; [exact f1 |].
    replace (tool ^ 2 / f * u ^ 2 * f) with (tool ^ 2 * u ^ 2) by (field; lra). lra.
Qed.

Lemma accelerated : forall l P p q, well_formed_leg (leg_of l) -> reaches (values P) (leg_of l) -> 0 <= value p -> 0 <= value q ->
  accelerates_by (row (leg_of l)) (values P) (value p) (value q) (value (nacceleration l P p q)).
Proof.
  intros [d a0 p0 len m | a0 p0 k | d] P p q ok h p1 q1; cbn [leg_of reaches well_formed_leg nacceleration row] in *; cbv zeta.
  - cbn [value]. rewrite (value_clearance2 d a0 p0 len (if m then 1 else -1) P).
    pose proof (slider_reaches _ _ _ _ ok h p1 q1) as K. cbv zeta in K. cbn [leg_length] in K. unfold s in K. cbn [leg_length] in K.
    match goal with |- accelerates_by _ _ _ _ ?t => match type of K with accelerates_by _ _ _ _ ?t' => replace t with t' by (unfold Rdiv; ring); exact K end end.
  - cbn [value]. rewrite value_square. change (values (nspan a0 p0 P)) with (span (values a0) (values p0) (values P)). pose proof (strut_reaches _ _ _ _ _ h p1 q1) as K. match goal with |- accelerates_by _ _ _ _ ?t => match type of K with accelerates_by _ _ _ _ ?t' => replace t with t' by (unfold Rdiv; ring); exact K end end.
  - apply plane_reaches; [apply normalised_norm | exact p1]. pose proof (norm2_nonneg (values d)). destruct (Req_dec (norm2 (values d)) 0) as [z | z]; [apply norm2_zero in z; contradiction | lra].
Qed.

Lemma fails_sound : forall c ls P u v r, Forall well_formed_leg (map leg_of ls) -> Forall (reaches (values P)) (map leg_of ls) -> fails ls P u v r = true -> ~ fulfils c (map leg_of ls) (values P) r.
Proof.
  intros about ls P u v r built reached h F.
  assert (B : forall b, value (Times (Times (Over (1 // 1) b) (Over (1 // 1) b)) (product u u)) = (1 / value b) ^ 2 * norm2 (values u)).
  { intro b. cbn [value]. rewrite value_square. replace (1 / 1) with 1 by field. ring. }
  assert (At : forall i l, nth_error (map leg_of ls) i = Some l -> exists k, nth_error ls i = Some k /\ l = leg_of k).
  { intros i l n. rewrite nth_error_map in n. destruct (nth_error ls i) as [k |]; [| discriminate]. injection n as <-. exists k. split; reflexivity. }
  destruct r as [| b | b | i b | i b | i tool b | b | i b | b | joint b | b | one other b | i one other b | i a y b | i tool b | | error b | ks kb]; cbn [fails fulfils] in *; [discriminate | | | | | | | | | | | | | | | | |].
  - apply positive_sound in h. specialize (F (values u)). rewrite <- value_speed2, <- B in F.
    set (t := Times _ (product u u)) in *. clearbody t. cbn [value] in h. lra.
  - apply positive_sound in h. specialize (F (values u)). rewrite <- value_speed2, <- B in F.
    set (t := Times _ (product u u)) in *. clearbody t. cbn [value] in h. lra.
  - destruct F as [l [n j]]. destruct (At i l n) as [k [e ->]]. rewrite e in h.
    apply positive_sound in h. cbn [value] in h. rewrite value_joint in h. lra.
  - destruct F as [l [n j]]. destruct (At i l n) as [k [e ->]]. rewrite e in h.
    apply positive_sound in h. cbn [value] in h. rewrite value_joint in h. lra.
  - destruct F as [l [n j]]. destruct (At i l n) as [k [e ->]]. rewrite e in h.
    apply positive_sound in h. cbn [value] in h. rewrite value_square, values_row in h.
    set (q := row (leg_of k) (values P)) in *. set (t := value tool) in *. set (y := value b) in *. clearbody q t y.
    destruct (Req_dec (norm2 q) 0) as [z | z].
    + rewrite z in h. pose proof (Rle_0_sqr y) as p. unfold Rsqr in p. lra.
    + pose proof (norm2_nonneg q) as p. assert (n0 : 0 < norm2 q) by lra. pose proof (sqrt_lt_R0 _ n0) as s0.
      specialize (j (vscale (t / sqrt (norm2 q)) q)).
      assert (S : sqrt (norm2 q) ^ 2 = norm2 q) by (rewrite <- Rsqr_pow2; apply Rsqr_sqrt; lra).
      assert (N : norm2 (vscale (t / sqrt (norm2 q)) q) = t ^ 2).
      { rewrite norm2_scale. unfold Rdiv. rewrite Rpow_mult_distr, pow_inv, S. field. lra. }
      rewrite N in j. specialize (j (Rle_refl _)).
      assert (D : dot q (vscale (t / sqrt (norm2 q)) q) = t / sqrt (norm2 q) * norm2 q).
      { rewrite norm2_dot. unfold dot, vscale. cbn [vx vy vz]. ring. }
      rewrite D in j. replace ((t / sqrt (norm2 q) * norm2 q) ^ 2) with (t ^ 2 * norm2 q) in j.
      * nra.
      * rewrite Rpow_mult_distr. unfold Rdiv. rewrite Rpow_mult_distr, pow_inv, S. field. lra.
  - apply positive_sound in h. cbn [value] in h. rewrite !value_speed2, !value_square in h.
    specialize (F (values u) (values v)). nra.
  - destruct F as [k [n j]]. destruct (At i _ n) as [l [e e']]. rewrite e in h. destruct l as [d a p len m | ? ? ? | ?]; try discriminate.
    cbn [leg_of] in e'. injection e' as ->. cbv zeta in h. apply positive_sound in h. cbn [value] in h.
    rewrite value_signed_root in h. cbn [leg_length] in j. nra.
  - destruct F as [k1 [k2 [k3 [e j]]]]. destruct ls as [| x1 [| x2 [| x3 [| x4 rest]]]]; try discriminate. cbn [map] in e.
    injection e as <- <- <-. destruct (values_vector x1 P) as [c1 d1], (values_vector x2 P) as [c2 d2], (values_vector x3 P) as [c3 d3].
    cbv zeta in h. apply andb_true_iff in h as [h1 h2]. apply positive_sound in h1, h2. cbn [value] in h1, h2.
    rewrite value_ndet, c1, c2, c3, d1, d2, d3 in h1, h2.
    set (z := det _) in *. clearbody z. unfold Rabs in j. destruct (Rcase_abs z); lra.
  - apply positive_sound in h. cbn [value] in h. rewrite value_speed2, value_square in h. specialize (F (values u)). lra.
  - destruct F as [cs [h1 h2]]. destruct (ncouples ls P) as [ns |] eqn:e; [| discriminate]. apply positive_sound in h. cbn [value] in h.
    rewrite value_square, value_couples2, <- (ncouples_sound ls P ns cs e h1) in h. specialize (h2 (values u)). nra.
  - exact (are_nearer_sound _ _ _ _ _ _ (nsegment_sound ls P) h F).
  - destruct F as [l [C [A [L [n [e F]]]]]]. destruct (At i l n) as [k [e' ->]]. rewrite e' in h.
    destruct (nrod k P) as [[[C' A'] L'] |] eqn:er; [| discriminate]. rewrite (nrod_sound _ _ _ _ _ er) in e.
    assert (eA : values A' = A) by congruence. subst A. cbv zeta in h. apply andb_true_iff in h as [h1 h2]. apply positive_sound in h1, h2.
    rewrite value_square in h1. cbn [value] in h2. rewrite !value_square, !value_product in h2.
    set (d := values (each2 Minus (nposition one) (nposition other))) in *. set (a := values A') in *. set (y := dot d a / norm2 a).
    specialize (F y 0). replace (norm2 (vsub (vadd (vsub C (vscale y a)) (located one)) (vadd (vsub C (vscale 0 a)) (located other))))
      with (norm2 d - 2 * y * dot d a + y ^ 2 * norm2 a) in F
      by (unfold d; rewrite values_minus; change (values (nposition one)) with (located one); change (values (nposition other)) with (located other);
          unfold norm2, dot, vsub, vadd, vscale; cbn [vx vy vz]; ring).
    replace (norm2 d - 2 * y * dot d a + y ^ 2 * norm2 a) with (norm2 d - dot d a * dot d a / norm2 a) in F by (unfold y; field; lra). lra.
  - destruct F as [k [n j]]. destruct (At i _ n) as [l [e ->]]. rewrite e in h. apply andb_true_iff in h as [h _]. apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2].
    apply nonneg_sound in h1, h2. apply positive_sound in h3. cbn [value] in h3. rewrite Forall_forall in built, reached. pose proof (in_map leg_of _ _ (nth_error_In _ _ e)) as il.
    destruct (accelerated l P a y (built _ il) (reached _ il) h1 h2) as [path [V [acc [d [g1 [g2 [g3 [g4 [g5 [g6 g7]]]]]]]]]].
    destruct (j path V acc g1 g2 g3 g4 g5) as [d' [j1 j2]]. rewrite (uniqueness_limite _ _ _ _ j1 g6) in j2. lra.
  - destruct F as [_ F]. destruct ls as [| k1 [| k2 [| k3 [| k4 ls]]]]; try discriminate. destruct (nth_error [nx u; ny u; nz u] i) as [x |] eqn:ex; [| discriminate].
    destruct (nth_error [k1; k2; k3] i) as [l |] eqn:el; [| discriminate].
    inversion reached as [| ? ? r1 R1]; subst. inversion R1 as [| ? ? r2 R2]; subst. inversion R2 as [| ? ? r3 _]; subst.
    destruct (values_ray _ _ r1) as [q1 [n1 e1]], (values_ray _ _ r2) as [q2 [n2 e2]], (values_ray _ _ r3) as [q3 [n3 e3]].
    apply andb_true_iff in h as [h h3]. apply andb_true_iff in h as [h1 h2]. apply positive_sound in h1, h2, h3. cbn [value] in h3.
    rewrite !value_square, !values_plus, !values_scaled, values_row in h3.
    set (G := vadd _ _) in h3. assert (K : exists k, k <> 0 /\ row (leg_of l) (values P) = vscale k (values (nray l P)) /\
      forall t, t * (value x / k) = nth i [t * (value (nx u) / q1); t * (value (ny u) / q2); t * (value (nz u) / q3)] 0).
    { destruct i as [| [| [| i]]]; cbn [nth_error] in ex, el; try (destruct i; discriminate ex); injection ex as <-; injection el as <-;
        [exists q1 | exists q2 | exists q3]; (split; [assumption | split; [assumption | reflexivity]]). }
    destruct K as [k [k0 [ek et]]]. rewrite ek, norm2_scale in h3.
    destruct (too_forceful (value tool) (value b) (value x) k (norm2 (values (nray l P))) (norm2 G) h1 h2 (norm2_nonneg _) (norm2_nonneg _) k0 ltac:(apply Rminus_gt_0_lt, (Rlt_le_trans _ _ _ h3); right; ring)) as [t [t1 t2]].
    rewrite et in t2. apply (Rlt_not_le _ _ t2). apply (F _ (vscale t G)); [reflexivity | | rewrite norm2_scale; exact t1].
    intro w. cbn [joint_power map]. rewrite e1, e2, e3. unfold G.
    assert (A : forall a b c, dot (vscale t (vadd (vadd a b) c)) w = t * (dot a w + dot b w + dot c w)) by (intros; unfold dot, vscale, vadd; cbn [vx vy vz]; ring).
    assert (S : forall a q, dot (vscale q a) w = q * dot a w) by (intros; unfold dot, vscale; cbn [vx vy vz]; ring).
    rewrite A, !S. field. repeat split; assumption.
  - discriminate.
  - discriminate.
  - destruct F as [_ F]. apply positive_sound in h. cbn [value] in h. rewrite value_square, value_elastic2 in h. specialize (F (values u)). lra.
Qed.

(** A machine of the claim that can be built does not meet it at some point of the workspace. *)
Theorem refute_sound : forall c ls P f, refute c ls P f = true -> exists m P, is_about c m P /\ ~ meets c m P.
Proof.
  intros c ls P f h. apply andb_true_iff in h as [a h]. exists (map leg_of ls), (values P).
  split; [apply admits_sound, a |]. destruct (admits_sound _ _ _ a) as [_ [built _]]. intros [reached [inj met]]. destruct f as [| i u v | i leg |].
  - apply existsb_exists in h as [l [il h]]. destruct (reserve l P) as [t |] eqn:e; [| discriminate].
    apply nonneg_sound in h. cbn [value] in h. apply (reserve_sound l P t e); [lra |].
    rewrite Forall_forall in reached. apply reached, in_map, il.
  - destruct (nth_error (require c) i) as [q |] eqn:n; [| discriminate]. apply (fails_sound c _ _ _ _ _ built reached h).
    rewrite Forall_forall in met. apply met, (nth_error_In _ _ n).
  - destruct (nth_error (require c) i) as [q |] eqn:n; [| discriminate]. destruct (nth_error ls leg) as [l |]; [| discriminate].
    apply (fails_sound c _ _ _ _ _ built reached h). rewrite Forall_forall in met. apply met, (nth_error_In _ _ n).
  - destruct (are_dependent_sound _ _ h) as [v [lv [nz z]]]. destruct v as [| x [| y [| t [|]]]]; try discriminate lv.
    assert (V : Vec x y t <> vzero) by (intro e; injection e as -> -> ->; unfold Linear.nonzero in nz; cbn in nz; lra).
    specialize (inj _ V). enough (E : speed2 (map leg_of ls) (values P) (Vec x y t) = 0) by lra. clear - reached z.
    induction ls as [| l ls IH]; [reflexivity |]. cbn [map] in *. inversion reached as [| ? ? r1 r2]. inversion z as [| ? ? z1 z2]. subst.
    destruct (values_ray l P r1) as [k [_ e]]. specialize (IH r2 z2). unfold speed2 in *. cbn [fold_right]. rewrite IH, e.
    cbn [Linear.dot map] in z1. unfold values, dot, vscale. cbn [vx vy vz]. cbv zeta in z1.
    replace (k * value (nx (nray l P)) * x + k * value (ny (nray l P)) * y + k * value (nz (nray l P)) * t)
      with (k * (value (nx (nray l P)) * x + (value (ny (nray l P)) * y + (value (nz (nray l P)) * t + 0)))) by ring. rewrite z1. ring.
Qed.

(** ** A claim that is about something *)

Definition leasts (t : tolerances) : numbers := Numbers (least (tx t)) (least (ty t)) (least (tz t)).
Definition least_leg (d : drive) : exact_leg :=
  match d with
  | SliderLeg c => ExactSlider (leasts (direction c)) (leasts (anchor c)) (leasts (platform c)) (least (length c)) (mode c)
  | StrutLeg a p k => ExactStrut (leasts a) (leasts p) (option_map leasts k)
  | PlanarLeg d => ExactPlanar (leasts d)
  end.
Definition some_point (w : region) : numbers :=
  match w with Box edges => leasts edges | Cylinder x y _ height => Numbers x y (least height) end.
Definition is_inhabited (c : claim) : bool := admits c (map least_leg (legs c)) (some_point (workspace c)).

Lemma inhabited : forall c, is_inhabited c = true -> exists m P, is_about c m P.
Proof. intros c h. eexists; eexists. apply admits_sound, h. Qed.
End Precision.

(** A certified claim holds, and there is a machine and a point that it is about. *)
Definition certify (exact bits : positive) (chords : N * list (list Z)) (c : claim) (s : Z) (ds : list Z) (t : Check.tree) : bool :=
  is_inhabited exact c && check_claim_by bits chords c s ds t.

Theorem certify_sound : forall exact bits chords c s ds t, certify exact bits chords c s ds t = true ->
  Statement.holds c /\ exists m P, is_about c m P.
Proof.
  intros exact bits chords c s ds t h. apply andb_true_iff in h as [i h].
  split; [exact (check_claim_by_sound bits chords c s ds t h) | exact (inhabited exact c i)].
Qed.
End Named.
