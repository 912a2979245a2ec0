(** * By what angle a direction has turned, where it is less than a quarter *)

From Coq Require Import Reals Lra Ranalysis5.
From Orthocert Require MeanValue.
From Orthocert Require Import Velocity.
Local Open Scope R_scope.

(** That of the library rests on classical logic. *)
Definition clipped (x : R) : R := Rmax (-1) (Rmin x 1).
Lemma clipped_in : forall x, -1 <= clipped x <= 1.
Proof. intro x. unfold clipped. split; [apply Rmax_l | apply Rmax_lub; [lra | apply Rmin_r]]. Qed.
Lemma clipped_is : forall x, -1 <= x <= 1 -> clipped x = x.
Proof. intros x h. unfold clipped. rewrite Rmin_left, Rmax_right; lra. Qed.

Lemma quarter_positive : - (PI / 2) <= PI / 2.
Proof. pose proof PI_RGT_0. lra. Qed.
Lemma arcsine_continuous : forall x, continuity (fun t => sin t - clipped x).
Proof. intro x. apply continuity_minus; [exact continuity_sin | apply continuity_const; intros y z; reflexivity]. Qed.
Lemma arcsine_signs : forall x, (sin (- (PI / 2)) - clipped x) * (sin (PI / 2) - clipped x) <= 0.
Proof. intro x. rewrite sin_neg, sin_PI2. destruct (clipped_in x). nra. Qed.
Definition arcsine (x : R) : R := proj1_sig (IVT_cor _ _ _ (arcsine_continuous x) quarter_positive (arcsine_signs x)).
Lemma arcsine_between : forall x, - (PI / 2) <= arcsine x <= PI / 2.
Proof. intro x. exact (proj1 (proj2_sig (IVT_cor _ _ _ (arcsine_continuous x) quarter_positive (arcsine_signs x)))). Qed.
Lemma arcsine_is : forall x, -1 <= x <= 1 -> sin (arcsine x) = x.
Proof. intros x h. pose proof (proj2 (proj2_sig (IVT_cor _ _ _ (arcsine_continuous x) quarter_positive (arcsine_signs x)))) as e. cbv beta in e. fold (arcsine x) in e. rewrite (clipped_is x h) in e. lra. Qed.
Lemma arcsine_cosine : forall x, 0 <= cos (arcsine x).
Proof. intro x. destruct (arcsine_between x). apply cos_ge_0; lra. Qed.

Lemma arcsine_rate : forall x, -1 < x < 1 -> derivable_pt_lim arcsine x (/ cos (arcsine x)).
Proof.
  intros x h. pose proof PI_RGT_0 as p0. assert (lu : -1 < 1) by lra.
  assert (S1 : sin (- (PI / 2)) = -1) by (rewrite sin_neg, sin_PI2; reflexivity). assert (S2 : sin (PI / 2) = 1) by exact sin_PI2.
  assert (E1 : arcsine (-1) = - (PI / 2)).
  { destruct (arcsine_between (-1)) as [a b]. destruct (Req_dec (arcsine (-1)) (- (PI / 2))) as [e | n]; [exact e |]. exfalso.
    assert (sin (- (PI / 2)) < sin (arcsine (-1))) by (apply sin_increasing_1; lra). rewrite arcsine_is in H by lra. lra. }
  assert (E2 : arcsine 1 = PI / 2).
  { destruct (arcsine_between 1) as [a b]. destruct (Req_dec (arcsine 1) (PI / 2)) as [e | n]; [exact e |]. exfalso.
    assert (sin (arcsine 1) < sin (PI / 2)) by (apply sin_increasing_1; lra). rewrite arcsine_is in H by lra. lra. }
  assert (C : continuity_pt arcsine x).
  { apply (continuity_pt_recip_interv sin arcsine (- (PI / 2)) (PI / 2)); [lra | | | | |].
    - intros a b ha hab hb. apply sin_increasing_1; lra.
    - intros a ha hb. rewrite S1 in ha. rewrite S2 in hb. unfold comp, id. apply arcsine_is. lra.
    - intros a _ _. apply arcsine_between.
    - intros a _. apply continuity_sin.
    - rewrite S1, S2. exact h. }
  set (Prf := fun (a : R) (_ : arcsine (-1) <= a <= arcsine 1) => derivable_pt_sin a).
  assert (In_ : arcsine (-1) <= arcsine x <= arcsine 1) by (rewrite E1, E2; apply arcsine_between).
  assert (c0 : cos (arcsine x) <> 0).
  { intro z. pose proof (sin2_cos2 (arcsine x)) as q. unfold Rsqr in q. rewrite z, arcsine_is in q by lra. nra. }
  assert (D : derive_pt sin (arcsine x) (Prf (arcsine x) In_) = cos (arcsine x)) by (unfold Prf; apply derive_pt_sin).
  pose proof (derivable_pt_lim_recip_interv sin arcsine (-1) 1 x Prf C lu h In_ ltac:(intros y hy; unfold comp, id; apply arcsine_is, hy) ltac:(rewrite D; exact c0)) as L.
  rewrite D in L. unfold Rdiv in L. rewrite Rmult_1_l in L. exact L.
Qed.

(** From the direction with one cosine and sine to that with others. *)
Definition turn_between (c0 s0 c s : R) : R := arcsine (s * c0 - c * s0).

Lemma turned_angle : forall c0 s0 c s, c0 ^ 2 + s0 ^ 2 = 1 -> c ^ 2 + s ^ 2 = 1 -> 0 < c * c0 + s * s0 -> let a := turn_between c0 s0 c s in
  cos a = c * c0 + s * s0 /\ sin a = s * c0 - c * s0 /\ c = c0 * cos a - s0 * sin a /\ s = s0 * cos a + c0 * sin a.
Proof.
  intros c0 s0 c s h0 h p a. set (C := c * c0 + s * s0) in *. set (S := s * c0 - c * s0) in *.
  assert (CS : C ^ 2 + S ^ 2 = 1) by (unfold C, S; transitivity ((c ^ 2 + s ^ 2) * (c0 ^ 2 + s0 ^ 2)); [ring | rewrite h, h0; ring]).
  assert (sa : sin a = S) by (unfold a, turn_between; fold S; apply arcsine_is; split; nra). pose proof (arcsine_cosine S) as ca0. fold S in a. change (arcsine S) with a in ca0.
  pose proof (sin2_cos2 a) as q. unfold Rsqr in q. rewrite sa in q. assert (ca : cos a = C) by (apply Rsqr_inj; [exact ca0 | lra | unfold Rsqr; nra]).
  rewrite ca, sa. split; [reflexivity |]. split; [reflexivity |]. unfold C, S. split; [transitivity (c * (c0 ^ 2 + s0 ^ 2)) | transitivity (s * (c0 ^ 2 + s0 ^ 2))]; try ring; rewrite h0; ring.
Qed.

Lemma turned_rate : forall c0 s0 c s t rho, c0 ^ 2 + s0 ^ 2 = 1 -> c t ^ 2 + s t ^ 2 = 1 -> 0 < c t * c0 + s t * s0 ->
  derivable_pt_lim c t (- s t * rho) -> derivable_pt_lim s t (c t * rho) -> derivable_pt_lim (fun u => turn_between c0 s0 (c u) (s u)) t rho.
Proof.
  intros c0 s0 c s t rho h0 h p hc hs. destruct (turned_angle c0 s0 (c t) (s t) h0 h p) as [ca [sa _]]. set (a := turn_between c0 s0 (c t) (s t)) in *.
  assert (S1 : -1 < s t * c0 - c t * s0 < 1). { rewrite <- sa. pose proof (sin2_cos2 a) as q. unfold Rsqr in q. rewrite ca in q. split; nra. }
  assert (D : derivable_pt_lim (fun u => s u * c0 - c u * s0) t ((c t * c0 + s t * s0) * rho)).
  { eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_scal c0 _ _ _ hs) (derivable_scal (- s0) _ _ _ hc)) | intro u; cbv beta; ring | ring]. }
  eapply derivable_eq; [exact (derivable_pt_lim_comp _ arcsine t _ _ D (arcsine_rate _ S1)) | reflexivity |].
  change (arcsine (s t * c0 - c t * s0)) with a. rewrite ca. field. lra.
Qed.

(** A path on which it turns by less than a radian in all. *)
Lemma turned_little : forall c s rho : R -> R, (forall t, 0 <= t <= 1 -> c t ^ 2 + s t ^ 2 = 1 /\ derivable_pt_lim c t (- s t * rho t) /\ derivable_pt_lim s t (c t * rho t) /\ Rabs (rho t) < 1) ->
  forall t, 0 <= t <= 1 -> 0 < c t * c 0 + s t * s 0.
Proof.
  intros c s rho h t ht. destruct (Req_dec t 0) as [-> | n0]; [destruct (h 0 ltac:(lra)) as [e _]; nra |].
  assert (D : forall u, 0 <= u <= t -> derivable_pt_lim (fun u => c u * c 0 + s u * s 0) u (- (s u * c 0 - c u * s 0) * rho u)).
  { intros u hu. destruct (h u ltac:(lra)) as [_ [hc [hs _]]]. eapply derivable_eq; [exact (derivable_add _ _ _ _ _ (derivable_scal (c 0) _ _ _ hc) (derivable_scal (s 0) _ _ _ hs)) | intro v; cbv beta; ring | unfold Rminus; ring]. }
  destruct (MeanValue.mean_value_theorem _ _ 0 t ltac:(lra) D) as [u [e hu]]. destruct (h 0 ltac:(lra)) as [e0 _]. destruct (h u ltac:(lra)) as [eu [_ [_ small]]].
  set (S := s u * c 0 - c u * s 0) in *. set (C := c u * c 0 + s u * s 0).
  assert (CS : C ^ 2 + S ^ 2 = 1) by (unfold C, S; transitivity ((c u ^ 2 + s u ^ 2) * (c 0 ^ 2 + s 0 ^ 2)); [ring | rewrite eu, e0; ring]).
  assert (Rabs S <= 1) by (apply Rabs_le; split; nra). pose proof (Rabs_pos S). pose proof (Rabs_pos (rho u)).
  assert (B : Rabs (- S * rho u * (t - 0)) < 1).
  { rewrite !Rabs_mult, Rabs_Ropp, (Rabs_pos_eq (t - 0)) by lra. assert (Rabs S * Rabs (rho u) <= Rabs (rho u)) by nra. assert (0 <= Rabs S * Rabs (rho u)) by (apply Rmult_le_pos; assumption). nra. }
  pose proof (Rle_abs (- (- S * rho u * (t - 0)))) as l. rewrite Rabs_Ropp in l. nra.
Qed.
