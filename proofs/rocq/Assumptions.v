(** * Statements and assumptions of the final theorems

    `make` compares the output of this file with `assumptions.expected`: a
    changed statement or a new axiom makes the build fail. *)

From Coq Require Import Reals.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Diagonal CubeLower Scaling
  Postulate Extremes Design TightCorner AllPsi Claim Paper.
From Orthocert.kernel Require Apart Solve Tolerances Second Weighted Check Machine Acceleration Accuracy Gradient Near Problem Faces Witness Cubes NoCube Closed Trig Arm Written AtPoint Turning Same Twins TwinsDriven TwinsWritten Accelerated Far FarWritten BetweenWritten Singular Legs Control Pose Drives Driven Certificate PavingText.
From Orthocert.instances Require OrthoglideTolerance LinearDelta PostulateAll PostulateUpTo2 FourSliders StrutsAndPlane DeltaSpeed DeltaMargin UpuAxes
  FiveBar PlanarPlatform FiveBarFormulas Prototype DeltaTooFast NoCube Atlas.
Local Open Scope R_scope.
Set Printing Width 100.

(** ** The model *)

Check Jinv_velocity.
Check Jinv_is_derivative.
Check rho_unique.
Check orthoglide_Jinv_mm.

(** ** The postulate *)

Check q1q2_postulate.
Check velocity_transmission.
Check transmission_factors.
Check tight_at_Q_1.
Check tight_at_Q_2_lower.
Check tight_at_Q_2_upper.
Check tight_only_at_Q1_Q2.
Check joints_apart.
Check one_to_one.

(** ** Any diagonal cube *)

Check cube_regular.
Check min_sigma_min.
Check max_sigma_max.
Check corners_suffice.
Check largest_cube.
Check paper.

(** ** The design of the paper *)

Check prescribed_side.
Check numbers_200.
Check orthoglide_200.
Check L_310_too_short.
Check joint_range.
Check joint_range_reached.
Check rho_max_200.

(** ** A corner at which the bound is reached *)

Check symmetric_part.
Check tight_corner_rule.
Check tight_corner_semidefinite.

(** ** All psi at once *)

Check faces_suffice.
Check two_faces_suffice.
Check blow_up.

(** ** The postulate by subdivision *)

Check Faces.check_postulate_sound.
Check PostulateAll.certified.
Check Faces.check_postulate_up_to_sound.
Check PostulateUpTo2.certified.

(** ** The kernel *)

Check kernel.Machine.row_is_derivative.
Check kernel.Machine.three_guided.
Check kernel.Machine.chord.
Check kernel.Acceleration.slider_acceleration.
Check kernel.Acceleration.strut_acceleration.
Check kernel.Accuracy.one_position.
Check kernel.Gradient.derivatives_sound.
Check kernel.Near.accurate_sound.
Check kernel.Solve.solved_sound.
Check kernel.Problem.beside_keeps.
Check @kernel.Problem.check_claim_sound.
Check OrthoglideTolerance.certified.
Check LinearDelta.certified.
Check FourSliders.certified.
Check StrutsAndPlane.certified.
Check kernel.Check.check_all_open.
Check DeltaSpeed.certified.
Check UpuAxes.certified.
Check DeltaMargin.certified.
Check kernel.Apart.are_apart_sound.

(** ** Certificates as files: what the program accepts *)

Check @kernel.Witness.refute_sound.
Check kernel.NoCube.check_no_cube_sound.
Check kernel.Closed.check_closed_sound.
Check kernel.Trig.cosine_sound.
Check kernel.Arm.rod_closes.
Check kernel.Arm.angle_velocity.
Check kernel.Legs.driven_velocity.
Check kernel.Legs.refute_driven_sound.
Check kernel.Load.load_bounded.
Check @kernel.Recover.legs_recovered.
Check kernel.Driven.check_driven_sound.
Check kernel.HalfTurn.never_half_a_turn.
Check kernel.Poses.poses_differ.
Check kernel.Written.check_written_sound.
Check kernel.AtPoint.refute_written_sound.
Check kernel.Orientation.rotation_about_rotates.
Check kernel.Orientation.rotation_about_axes.
Check kernel.Turning.length_velocity.
Check kernel.Turning.refute_turning_sound.
Check kernel.Singular.refute_between_sound.
Check @kernel.Between.refute_between_driven_sound.
Check @kernel.Between.refute_between_legs_sound.
Check @kernel.BetweenWritten.refute_between_written_sound.
Check kernel.Same.fits_sound.
Check @kernel.Twins.refute_same_sound.
Check @kernel.Twins.refute_same_pose_sound.
Check @kernel.TwinsDriven.refute_same_driven_sound.
Check @kernel.TwinsWritten.refute_same_written_sound.
Check kernel.Accelerated.refute_accelerated_sound.
Check kernel.LegBend.leg_accelerates_so.
Check kernel.Hastened.own_accelerates.
Check kernel.Hastened.refute_hastened_sound.
Check @kernel.Far.refute_far_sound.
Check @kernel.Far.refute_far_pose_sound.
Check @kernel.Far.refute_far_driven_sound.
Check @kernel.FarWritten.refute_far_written_sound.
Check kernel.Control.controls_decide.
Check kernel.Pose.check_turning_sound.
Check @Claim.every_value.
Check kernel.Tolerances.mean_value.
Check kernel.Tolerances.less_changes_sound.
Check kernel.Second.second_mean_value.
Check kernel.Second.second_symmetric.
Check kernel.Check.shows_apart_sound.
Check kernel.Weighted.less_all_sound.
Check kernel.Check.weighted_half_sound.
Check kernel.Together.together.
Check kernel.Check.shows_together_sound.
Check kernel.Certificate.accept_cells_sound.
Check FiveBar.certified.
Check PlanarPlatform.certified.
Check FiveBarFormulas.certified.
Check Prototype.certified.
Check DeltaTooFast.refuted.
Check NoCube.certified.
Check Atlas.certified.
Check kernel.Certificate.verify_sound.
Check kernel.PavingText.verify_paving_sound.

(** ** What all of them assume: one walk through their proofs, which share most of them *)

Definition all_of_them :=
  (@Jinv_velocity, @Jinv_is_derivative, @rho_unique, @orthoglide_Jinv_mm, @q1q2_postulate,
   @velocity_transmission, @transmission_factors, @tight_at_Q_1, @tight_at_Q_2_lower,
   @tight_at_Q_2_upper, @tight_only_at_Q1_Q2, @joints_apart, @one_to_one, @paper, @cube_regular, @min_sigma_min, @max_sigma_max,
   @corners_suffice, @largest_cube, @prescribed_side, @numbers_200, @orthoglide_200,
   @L_310_too_short, @joint_range, @joint_range_reached, @rho_max_200, @symmetric_part,
   @tight_corner_rule, @tight_corner_semidefinite, @faces_suffice, @two_faces_suffice, @blow_up,
   @Faces.check_postulate_sound, @PostulateAll.certified, @Faces.check_postulate_up_to_sound,
   @PostulateUpTo2.certified, @kernel.Machine.row_is_derivative, @kernel.Machine.three_guided,
   @kernel.Machine.chord, @kernel.Acceleration.slider_acceleration,
   @kernel.Acceleration.strut_acceleration, @kernel.Accuracy.one_position,
   @kernel.Gradient.derivatives_sound, @kernel.Near.accurate_sound, @kernel.Solve.solved_sound,
   @kernel.Problem.beside_keeps, @kernel.Problem.check_claim_sound,
   @OrthoglideTolerance.certified, @LinearDelta.certified, @FourSliders.certified,
   @StrutsAndPlane.certified, @kernel.Check.check_all_open, @DeltaSpeed.certified,
   @UpuAxes.certified, @DeltaMargin.certified, @kernel.Apart.are_apart_sound,
   @kernel.Witness.refute_sound, @kernel.NoCube.check_no_cube_sound,
   @kernel.Closed.check_closed_sound, @kernel.Trig.cosine_sound, @kernel.Arm.rod_closes,
   @kernel.Arm.angle_velocity, @kernel.Legs.driven_velocity, @kernel.Legs.refute_driven_sound,
   @kernel.Load.load_bounded, @kernel.Recover.legs_recovered, @kernel.Driven.check_driven_sound,
   @kernel.HalfTurn.never_half_a_turn, @kernel.Poses.poses_differ, @kernel.Written.check_written_sound,
   @kernel.AtPoint.refute_written_sound, @kernel.Orientation.rotation_about_rotates,
   @kernel.Orientation.rotation_about_axes, @kernel.Turning.length_velocity,
   @kernel.Turning.refute_turning_sound, @kernel.Singular.refute_between_sound,
   @kernel.Between.refute_between_driven_sound, @kernel.Between.refute_between_legs_sound,
   @kernel.BetweenWritten.refute_between_written_sound, @kernel.Same.fits_sound, @kernel.Twins.refute_same_sound,
   @kernel.Twins.refute_same_pose_sound, @kernel.TwinsDriven.refute_same_driven_sound,
   @kernel.TwinsWritten.refute_same_written_sound, @kernel.Accelerated.refute_accelerated_sound,
   @kernel.LegBend.leg_accelerates_so, @kernel.Hastened.own_accelerates, @kernel.Hastened.refute_hastened_sound,
   @kernel.Far.refute_far_sound, @kernel.Far.refute_far_pose_sound,
   @kernel.Far.refute_far_driven_sound, @kernel.FarWritten.refute_far_written_sound, @kernel.Control.controls_decide,
   @kernel.Pose.check_turning_sound, @Claim.every_value, @kernel.Tolerances.mean_value,
   @kernel.Tolerances.less_changes_sound, @kernel.Second.second_mean_value, @kernel.Second.second_symmetric,
   @kernel.Check.shows_apart_sound, @kernel.Weighted.less_all_sound, @kernel.Check.weighted_half_sound,
   @kernel.Together.together, @kernel.Check.shows_together_sound,
   @kernel.Certificate.accept_cells_sound, @FiveBar.certified, @PlanarPlatform.certified,
   @FiveBarFormulas.certified, @Prototype.certified, @DeltaTooFast.refuted, @NoCube.certified,
   @Atlas.certified, @kernel.Certificate.verify_sound, @kernel.PavingText.verify_paving_sound).
Print Assumptions all_of_them.
