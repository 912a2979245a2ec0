(** * Statements and assumptions of the final theorems

    `make` compares the output of this file with `assumptions.expected`: a
    changed statement or a new axiom makes the build fail. *)

From Coq Require Import Reals.
From Orthocert Require Import Vec3 SingularValues Kinematics Velocity Diagonal CubeLower Scaling
  Postulate Extremes Design TightCorner AllPsi Claim.
From Orthocert.kernel Require Apart Solve Tolerances Check Machine Acceleration Accuracy Gradient Near Problem Faces Witness Cubes NoCube Closed Trig Arm Written AtPoint Turning Same Twins Singular Legs Control Pose Drives Driven Certificate PavingText.
From Orthocert.instances Require OrthoglideTolerance LinearDelta PostulateAll PostulateUpTo2 FourSliders StrutsAndPlane DeltaSpeed DeltaMargin UpuAxes
  FiveBar PlanarPlatform FiveBarFormulas Prototype DeltaTooFast NoCube Atlas.
Local Open Scope R_scope.
Set Printing Width 100.

(** ** The model *)

Check Jinv_velocity.
Print Assumptions Jinv_velocity.
Check Jinv_is_derivative.
Print Assumptions Jinv_is_derivative.
Check rho_unique.
Print Assumptions rho_unique.
Check orthoglide_Jinv_mm.
Print Assumptions orthoglide_Jinv_mm.

(** ** The postulate *)

Check q1q2_postulate.
Print Assumptions q1q2_postulate.
Check velocity_transmission.
Print Assumptions velocity_transmission.
Check transmission_factors.
Print Assumptions transmission_factors.
Check tight_at_Q_1.
Print Assumptions tight_at_Q_1.
Check tight_at_Q_2_lower.
Print Assumptions tight_at_Q_2_lower.
Check tight_at_Q_2_upper.
Print Assumptions tight_at_Q_2_upper.
Check tight_only_at_Q1_Q2.
Print Assumptions tight_only_at_Q1_Q2.

(** ** Any diagonal cube *)

Check cube_regular.
Print Assumptions cube_regular.
Check min_sigma_min.
Print Assumptions min_sigma_min.
Check max_sigma_max.
Print Assumptions max_sigma_max.
Check corners_suffice.
Print Assumptions corners_suffice.
Check largest_cube.
Print Assumptions largest_cube.

(** ** The design of the paper *)

Check prescribed_side.
Print Assumptions prescribed_side.
Check numbers_200.
Print Assumptions numbers_200.
Check orthoglide_200.
Print Assumptions orthoglide_200.
Check L_310_too_short.
Print Assumptions L_310_too_short.
Check joint_range.
Print Assumptions joint_range.
Check joint_range_reached.
Print Assumptions joint_range_reached.
Check rho_max_200.
Print Assumptions rho_max_200.

(** ** A corner at which the bound is reached *)

Check symmetric_part.
Print Assumptions symmetric_part.
Check tight_corner_rule.
Print Assumptions tight_corner_rule.
Check tight_corner_semidefinite.
Print Assumptions tight_corner_semidefinite.

(** ** All psi at once *)

Check faces_suffice.
Print Assumptions faces_suffice.
Check two_faces_suffice.
Print Assumptions two_faces_suffice.
Check blow_up.
Print Assumptions blow_up.

(** ** The postulate by subdivision *)

Check Faces.check_postulate_sound.
Print Assumptions Faces.check_postulate_sound.
Check PostulateAll.certified.
Print Assumptions PostulateAll.certified.
Check Faces.check_postulate_up_to_sound.
Print Assumptions Faces.check_postulate_up_to_sound.
Check PostulateUpTo2.certified.
Print Assumptions PostulateUpTo2.certified.

(** ** The kernel *)

Check kernel.Machine.row_is_derivative.
Print Assumptions kernel.Machine.row_is_derivative.
Check kernel.Machine.three_guided.
Print Assumptions kernel.Machine.three_guided.
Check kernel.Machine.chord.
Print Assumptions kernel.Machine.chord.
Check kernel.Acceleration.slider_acceleration.
Print Assumptions kernel.Acceleration.slider_acceleration.
Check kernel.Acceleration.strut_acceleration.
Print Assumptions kernel.Acceleration.strut_acceleration.
Check kernel.Accuracy.one_position.
Print Assumptions kernel.Accuracy.one_position.
Check kernel.Gradient.derivatives_sound.
Print Assumptions kernel.Gradient.derivatives_sound.
Check kernel.Near.accurate_sound.
Print Assumptions kernel.Near.accurate_sound.
Check kernel.Solve.solved_sound.
Print Assumptions kernel.Solve.solved_sound.
Check kernel.Problem.beside_keeps.
Print Assumptions kernel.Problem.beside_keeps.
Check @kernel.Problem.check_claim_sound.
Print Assumptions kernel.Problem.check_claim_sound.
Check OrthoglideTolerance.certified.
Print Assumptions OrthoglideTolerance.certified.
Check LinearDelta.certified.
Print Assumptions LinearDelta.certified.
Check FourSliders.certified.
Print Assumptions FourSliders.certified.
Check StrutsAndPlane.certified.
Print Assumptions StrutsAndPlane.certified.
Check kernel.Check.check_all_open.
Print Assumptions kernel.Check.check_all_open.
Check DeltaSpeed.certified.
Print Assumptions DeltaSpeed.certified.
Check UpuAxes.certified.
Print Assumptions UpuAxes.certified.
Check DeltaMargin.certified.
Print Assumptions DeltaMargin.certified.
Check kernel.Apart.are_apart_sound.
Print Assumptions kernel.Apart.are_apart_sound.

(** ** Certificates as files: what the program accepts *)

Check @kernel.Witness.refute_sound.
Print Assumptions kernel.Witness.refute_sound.
Check kernel.NoCube.check_no_cube_sound.
Print Assumptions kernel.NoCube.check_no_cube_sound.
Check kernel.Closed.check_closed_sound.
Print Assumptions kernel.Closed.check_closed_sound.
Check kernel.Trig.cosine_sound.
Print Assumptions kernel.Trig.cosine_sound.
Check kernel.Arm.rod_closes.
Print Assumptions kernel.Arm.rod_closes.
Check kernel.Arm.angle_velocity.
Print Assumptions kernel.Arm.angle_velocity.
Check kernel.Legs.driven_velocity.
Print Assumptions kernel.Legs.driven_velocity.
Check kernel.Legs.refute_driven_sound.
Print Assumptions kernel.Legs.refute_driven_sound.
Check kernel.Driven.check_driven_sound.
Print Assumptions kernel.Driven.check_driven_sound.
Check kernel.Written.check_written_sound.
Print Assumptions kernel.Written.check_written_sound.
Check kernel.AtPoint.refute_written_sound.
Print Assumptions kernel.AtPoint.refute_written_sound.
Check kernel.Orientation.rotation_about_rotates.
Print Assumptions kernel.Orientation.rotation_about_rotates.
Check kernel.Orientation.rotation_about_axes.
Print Assumptions kernel.Orientation.rotation_about_axes.
Check kernel.Turning.length_velocity.
Print Assumptions kernel.Turning.length_velocity.
Check kernel.Turning.refute_turning_sound.
Print Assumptions kernel.Turning.refute_turning_sound.
Check kernel.Singular.refute_between_sound.
Print Assumptions kernel.Singular.refute_between_sound.
Check kernel.Same.fits_sound.
Print Assumptions kernel.Same.fits_sound.
Check @kernel.Twins.refute_same_sound.
Print Assumptions kernel.Twins.refute_same_sound.
Check @kernel.Twins.refute_same_pose_sound.
Print Assumptions kernel.Twins.refute_same_pose_sound.
Check kernel.Control.controls_decide.
Print Assumptions kernel.Control.controls_decide.
Check kernel.Pose.check_turning_sound.
Print Assumptions kernel.Pose.check_turning_sound.
Check @Claim.every_value.
Print Assumptions Claim.every_value.
Check kernel.Tolerances.mean_value.
Print Assumptions kernel.Tolerances.mean_value.
Check kernel.Tolerances.less_changes_sound.
Print Assumptions kernel.Tolerances.less_changes_sound.
Check kernel.Check.shows_apart_sound.
Print Assumptions kernel.Check.shows_apart_sound.
Check kernel.Certificate.accept_cells_sound.
Print Assumptions kernel.Certificate.accept_cells_sound.
Check FiveBar.certified.
Print Assumptions FiveBar.certified.
Check PlanarPlatform.certified.
Print Assumptions PlanarPlatform.certified.
Check FiveBarFormulas.certified.
Print Assumptions FiveBarFormulas.certified.
Check Prototype.certified.
Print Assumptions Prototype.certified.
Check DeltaTooFast.refuted.
Print Assumptions DeltaTooFast.refuted.
Check NoCube.certified.
Print Assumptions NoCube.certified.
Check Atlas.certified.
Print Assumptions Atlas.certified.
Check kernel.Certificate.verify_sound.
Print Assumptions kernel.Certificate.verify_sound.
Check kernel.PavingText.verify_paving_sound.
Print Assumptions kernel.PavingText.verify_paving_sound.
