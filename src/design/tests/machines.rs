//! Drives, cylinders and requirements: what is accepted, and every class of what is refused.

use super::refused::row;
use super::*;
use crate::design::leg::WorkingMode;
use Defect::{
    Claim as WholeClaim, Conflict, MissingKey, NotANumber, OutOfDomain, Reversed, Tolerance,
    UnknownKey, UnknownWord, WrongType,
};

#[test]
fn arms_are_read_one_by_one() {
    let claim = read(ARMS);
    let Leg::Arm { axis, reference, anchor, platform, arm, length, mode } = &legs(&claim)[0] else {
        panic!("{claim:?}");
    };
    assert_eq!(*axis, [exactly("0"), exactly("-1"), exactly("0")]);
    assert_eq!(*reference, [exactly("1"), exactly("0"), exactly("0")]);
    assert_eq!((&anchor[0], &platform[0]), (&exactly("6"), &exactly("10")));
    assert_eq!((arm, length), (&exactly("10"), &between("13.999", "14.001")));
    assert_eq!(*mode, WorkingMode::Plus);
    let (center, z) = ([number("0"), number("1")], [number("-14"), number("-12")]);
    assert_eq!(claim.workspace, Workspace::Cylinder { center, radius: number("3"), z });
    assert_eq!(claim.of("joint_range"), ["within -45 120"]);
}

#[test]
fn struts_and_planar_legs_are_read_one_by_one() {
    let claim = read(STRUTS);
    let [Leg::Strut { anchor, platform }, Leg::Strut { platform: second, .. }, _] = legs(&claim)
    else {
        panic!("{claim:?}");
    };
    assert_eq!((&anchor[0], &platform[0]), (&exactly("2"), &exactly("1")));
    assert!(second.iter().all(|x| *x == exactly("0")));
    assert_eq!(claim.demands, ["conditioning max 30"]);
    let claim = read(&with(PLANES, &[(5, "direction = [\"1 ± 0.1\", 0, 0]")]));
    let [Leg::Planar { direction }, ..] = legs(&claim) else { panic!("{claim:?}") };
    assert_eq!(direction[0], between("0.9", "1.1"));
}

#[test]
fn sliders_struts_and_planar_legs_may_be_mixed() {
    let strut = "drive = \"strut\"\nanchor = [0, 1, -5]";
    let claim = read(&with(PLANES, &[(10, strut), (11, "")]));
    assert!(matches!(legs(&claim), [Leg::Planar { .. }, Leg::Planar { .. }, Leg::Strut { .. }]));
}

#[test]
fn every_requirement_is_read() {
    let all = "transmission = { max = 2 }\n\
               conditioning = { max = 3 }\n\
               serial_margin = { min = 0.2 }\n\
               parallel_margin = { min = \"1/10\" }\n\
               leg_angle = { max = 90 }\n\
               joint_speed = { tool = 1200, max = 2000 }";
    for text in [with(LEGS, &[(26, all)]), with(CUBE, &[(8, all)])] {
        let mut demands = read(&text).demands;
        demands.sort();
        let expected = [
            "conditioning max 3",
            "joint_speed tool=1200 max 2000",
            "leg_angle max 90",
            "parallel_margin min 1/10",
            "serial_margin min 1/5",
            "transmission max 2",
        ];
        assert_eq!(demands, expected);
    }
    for alone in all.lines().skip(1) {
        read(&with(LEGS, &[(26, alone)]));
    }
}

#[test]
fn a_reference_with_tolerance_or_roots_is_made_orthogonal() {
    read(&with(ARMS, &[(7, "reference = [1, \"0 ± 0.01\", 0]")]));
    read(&with(ARMS, &[(7, "reference = [\"1 ± 0.01\", 0.02, 0]")]));
}

#[test]
#[rustfmt::skip]
fn drives_that_are_not_well_described() {
    check(&[
        row!("unknown drive", ARMS, [(4, "drive = \"armm\"")], 4, "mechanism.legs.0.drive",
            UnknownWord, "\"armm\"",
            "\"slider\", \"strut\", \"arm\", \"planar\"; did you mean \"arm\"?"),
        row!("key of another drive", STRUTS, [(6, "length = 3")], 6, "mechanism.legs.0.length",
            UnknownKey, "an unknown key", "drive, anchor, platform"),
        row!("mode of a planar leg", PLANES, [(11, "mode = \"+\"")], 11, "mechanism.legs.2.mode",
            UnknownKey, "an unknown key", "drive, direction"),
        row!("no axis", ARMS, [(6, "")], 3, "mechanism.legs.0.axis", MissingKey, "nothing: the key is missing",
            "the direction of the motor's axis"),
        row!("no reference", ARMS, [(16, "")], 12, "mechanism.legs.1.reference", MissingKey,
            "nothing: the key is missing", "the arm's direction at angle 0"),
        row!("no arm", ARMS, [(8, "")], 3, "mechanism.legs.0.arm", MissingKey, "nothing: the key is missing",
            "from the axis to the elbow"),
        row!("no anchor of a strut", STRUTS, [(9, "")], 7, "mechanism.legs.1.anchor", MissingKey,
            "nothing: the key is missing", "the leg's joint on the base"),
        row!("no direction of a plane", PLANES, [(8, "")], 6, "mechanism.legs.1.direction",
            MissingKey, "nothing: the key is missing", "the normal of the plane"),
        row!("zero arm", ARMS, [(8, "arm = 0")], 8, "mechanism.legs.0.arm", OutOfDomain, "0",
            "a length greater than 0"),
        row!("tolerance makes an arm zero", ARMS, [(26, "arm = \"1 ± 1\"")], 26,
            "mechanism.legs.2.arm", OutOfDomain, "\"1 ± 1\"",
            "a length greater than 0, over its whole tolerance"),
        row!("zero axis", ARMS, [(6, "axis = [0, 0, 0]")], 6, "mechanism.legs.0.axis",
            OutOfDomain, "is, or may be, zero", "any vector that is not zero"),
        row!("zero reference", ARMS, [(7, "reference = [0, 0, 0]")], 7,
            "mechanism.legs.0.reference", OutOfDomain, "is, or may be, zero", "not zero"),
        row!("zero normal", PLANES, [(8, "direction = [0, \"0 ± 1\", 0]")], 8,
            "mechanism.legs.1.direction", OutOfDomain, "is, or may be, zero", "not zero"),
        row!("axis parallel to reference", ARMS, [(7, "reference = [0, 3, 0]")], 7,
            "mechanism.legs.0.reference", OutOfDomain, "is, or may be, parallel to the axis",
            "orthogonal to the axis"),
        row!("axis parallel to reference, with roots", ARMS,
            [(16, "reference = [\"sqrt(6)\", \"sqrt(2)\", 0]")], 16,
            "mechanism.legs.1.reference", OutOfDomain, "is, or may be, parallel to the axis",
            "orthogonal to the axis"),
        row!("axis may be parallel to reference", ARMS,
            [(7, "reference = [\"0.01 ± 0.02\", 1, 0]")], 7, "mechanism.legs.0.reference",
            OutOfDomain, "is, or may be, parallel to the axis", "orthogonal to the axis"),
        row!("reference oblique to the axis", ARMS, [(7, "reference = [1, 0.001, 0]")], 7,
            "mechanism.legs.0.reference", OutOfDomain, "not orthogonal to the axis",
            "orthogonal to the axis"),
        row!("arms beside other drives", ARMS,
            [(13, "drive = \"strut\""), (15, ""), (16, ""), (17, ""), (18, ""), (20, "")], 13,
            "mechanism.legs.1.drive", Conflict, "next to another kind of drive", "no unit"),
        row!("other drives beside arms", PLANES, [(10, ARM), (11, "")], 10,
            "mechanism.legs.2.drive", Conflict, "next to another kind of drive", "no unit"),
    ]);
}

const ARM: &str = "drive = \"arm\"\nanchor = [0, 0, 0]\naxis = [0, 0, 1]\nreference = [1, 0, 0]\n\
                   arm = 1\nlength = 2\nmode = \"+\"";

#[test]
#[rustfmt::skip]
fn legs_whose_rows_are_dependent_everywhere() {
    check(&[
        row!("dependent directions", PLANES, [(11, "direction = [1, 2, 0]")], 11,
            "mechanism.legs.2.direction", OutOfDomain, "dependent", "a parallel singularity"),
        row!("directions that may be dependent", PLANES, [(11, "direction = [1, 2, \"1 ± 1\"]")],
            11, "mechanism.legs.2.direction", OutOfDomain, "may be, dependent", "independent"),
        row!("parallel directions", PLANES, [(8, "direction = [-2, 0, 0]")], 8,
            "mechanism.legs.1.direction", OutOfDomain, "parallel to that of mechanism.legs.0", "independent"),
        row!("a leg twice", STRUTS, [(9, "anchor = [0, 0, 2]")], 10, "mechanism.legs.2",
            OutOfDomain, "the leg mechanism.legs.1 once more", "independent"),
        row!("struts on one line", STRUTS, [(9, "anchor = [2, 0, 0]"), (12, "anchor = [7, 0, 0]")],
            12, "mechanism.legs.2.anchor", OutOfDomain, "on one line", "independent"),
    ]);
}

#[test]
#[rustfmt::skip]
fn cylinders_that_are_not_well_described() {
    check(&[
        row!("a number", ARMS, [(31, "cylinder = 3")], 31, "workspace.cylinder", WrongType, "3",
            "{ center = [0, 0], radius = 85, z = [0, 200] }"),
        row!("no center", ARMS, [(31, "cylinder = { radius = 3, z = [0, 1] }")], 31,
            "workspace.cylinder.center", MissingKey, "nothing: the key is missing", "where the axis crosses"),
        row!("center of three", ARMS, [(31, "cylinder = { center = [0, 0, 0], radius = 3, z = [0, 1] }")],
            31, "workspace.cylinder.center", WrongType, "an array of 3 elements", "[x, y]"),
        row!("zero radius", ARMS, [(31, "cylinder = { center = [0, 0], radius = 0, z = [0, 1] }")],
            31, "workspace.cylinder.radius", OutOfDomain, "0", "a radius greater than 0"),
        row!("empty", ARMS, [(31, "cylinder = { center = [0, 0], radius = 1, z = [1, 0] }")],
            31, "workspace.cylinder.z.1", Reversed, "0, below the lower end 1", "at least"),
        row!("unknown key", ARMS, [(31, "cylinder = { centre = [0, 0], radius = 1, z = [1, 2] }")],
            31, "workspace.cylinder.centre", UnknownKey, "an unknown key", "did you mean center?"),
        row!("cylinder and box", ARMS, [(31, "cylinder = { center = [0, 0], radius = 1, z = [1, 2] }\nmin = [0, 0, 0]")],
            31, "workspace.cylinder", Conflict, "next to workspace.min", "one workspace"),
        row!("cylinder and cube", CUBE, [(6, "cube = 200\ncylinder = {}")], 7,
            "workspace.cylinder", Conflict, "next to workspace.cube", "one workspace"),
    ]);
}

#[test]
#[rustfmt::skip]
fn requirements_that_are_not_well_described() {
    check(&[
        row!("conditioning of 1", LEGS, [(26, "conditioning = { max = 1 }")], 26,
            "requirements.conditioning.max", OutOfDomain, "1", "greater than 1"),
        row!("conditioning from below", LEGS, [(26, "conditioning = { min = 1 }")], 26,
            "requirements.conditioning.min", UnknownKey, "an unknown key", "max"),
        row!("conditioning is a number", LEGS, [(26, "conditioning = 3")], 26,
            "requirements.conditioning", WrongType, "3", "{ max = 3 }"),
        row!("no serial margin", LEGS, [(26, "serial_margin = { min = 0 }")], 26,
            "requirements.serial_margin.min", OutOfDomain, "0", "greater than 0"),
        row!("serial margin without a bound", LEGS, [(26, "serial_margin = {}")], 26,
            "requirements.serial_margin.min", MissingKey, "nothing: the key is missing", "{ min = \"1/5\" }"),
        row!("serial margin of struts", STRUTS, [(17, "serial_margin = { min = 0.1 }")], 17,
            "requirements.serial_margin", Conflict, "legs without a length", "sliders and arms"),
        row!("negative parallel margin", LEGS, [(26, "parallel_margin = { min = -1 }")], 26,
            "requirements.parallel_margin.min", OutOfDomain, "-1", "greater than 0"),
        row!("leg angle beyond 90", LEGS, [(26, "leg_angle = { max = 90.1 }")], 26,
            "requirements.leg_angle.max", OutOfDomain, "90.1", "at most 90"),
        row!("leg angle of 0", LEGS, [(26, "leg_angle = { max = 0 }")], 26,
            "requirements.leg_angle.max", OutOfDomain, "0", "greater than 0"),
        row!("leg angle of arms", ARMS, [(33, "leg_angle = { max = 45 }")], 33,
            "requirements.leg_angle", Conflict, "legs without a guide", "leg_angle for sliders"),
        row!("no tool speed", LEGS, [(26, "joint_speed = { max = 2000 }")], 26,
            "requirements.joint_speed.tool", MissingKey, "nothing: the key is missing", "the tool's speed"),
        row!("zero tool speed", LEGS, [(26, "joint_speed = { tool = 0, max = 2000 }")], 26,
            "requirements.joint_speed.tool", OutOfDomain, "0", "a speed greater than 0"),
        row!("negative joint speed", LEGS, [(26, "joint_speed = { tool = 1, max = -2 }")], 26,
            "requirements.joint_speed.max", OutOfDomain, "-2", "a speed greater than 0"),
        row!("tolerance on a bound", LEGS, [(26, "conditioning = { max = \"3 ± 1\" }")], 26,
            "requirements.conditioning.max", Tolerance, "\"3 ± 1\"", "one exact number"),
        row!("angles without an end", ARMS, [(34, "joint_range = { min = 0 }")], 34,
            "requirements.joint_range.max", MissingKey, "nothing: the key is missing", "in degrees, both ends"),
        row!("angles half a turn apart", ARMS, [(34, "joint_range = { min = -90, max = 90 }")], 34,
            "requirements.joint_range.max", OutOfDomain, "90", "less than 180 apart"),
        row!("angles before a turn", ARMS, [(34, "joint_range = { min = -361, max = -300 }")], 34,
            "requirements.joint_range.min", OutOfDomain, "-361", "within ±360"),
        row!("angles beyond a turn", ARMS, [(34, "joint_range = { min = 300, max = 361 }")], 34,
            "requirements.joint_range.max", OutOfDomain, "361", "within ±360"),
    ]);
}

#[test]
#[rustfmt::skip]
fn expressions_with_errors_name_leg_key_and_place() {
    check(&[
        row!("division by what may be zero", ARMS, [(14, "anchor = [-3, \"1/(sqrt(2)*sqrt(2)-2)\", 0]")],
            14, "mechanism.legs.1.anchor.1", NotANumber,
            "division by something that is or may be zero at character 3", "a number"),
        row!("root of what may be negative", ARMS, [(8, "arm = \"sqrt(2-3)\"")], 8,
            "mechanism.legs.0.arm", NotANumber,
            "square root of something that is or may be negative at character 6", "a number"),
        row!("unknown function", PLANES, [(5, "direction = [\"cos(30)\", 0, 0]")], 5,
            "mechanism.legs.0.direction.0", NotANumber, "at character 1", "a number"),
        row!("expression ends early", STRUTS, [(6, "platform = [0, 0, \"2*\"]")], 6,
            "mechanism.legs.0.platform.2", NotANumber, "at character 3", "a number"),
    ]);
}

#[test]
fn claims_refused_as_a_whole_are_of_that_class() {
    let far_too_wide = "axis = [\"0 ± 5\", -1, \"0 ± 5\"]";
    let error = refuse(&with(ARMS, &[(6, far_too_wide)]));
    assert_eq!((error.defect(), error.position().line), (WholeClaim, 6), "{error}");
    assert_eq!(error.key(), "mechanism.legs.0.axis", "{error}");
}
