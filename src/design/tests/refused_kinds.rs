//! Every class of what is refused of machines of every kind, and of what only the kernel knows.

use super::kinds::{PLANAR, POINT, SPATIAL, SPHERICAL};
use super::refused::row;
use super::*;
use crate::design::refusal::refused;
use orthocert_kernel::input::ClaimError;
use Defect::{
    Claim, Conflict, MissingKey, OutOfDomain, Reversed, Tolerance, UnknownKey, UnknownWord,
    WrongType,
};

#[test]
#[rustfmt::skip]
fn legs_of_other_kinds() {
    check(&[
        row!("vector of three in the plane", PLANAR, [(6, "anchor = [0, 400, 0]")], 6,
            "mechanism.legs.0.anchor", WrongType, "an array of 3 elements", "[x, y]: two numbers"),
        row!("vector of two in space", SPATIAL, [(5, "  { drive = \"strut\", anchor = [-22.95, 13.25] },")], 5,
            "mechanism.legs.0.anchor", WrongType, "an array of 2 elements", "[x, y, z]: three numbers"),
        row!("axis in the plane", POINT, [(5, "anchor = [-59, 0]\naxis = [0, 0, 1]")], 6,
            "mechanism.legs.0.axis", UnknownKey, "an unknown key", "in the plane motors turn about +z"),
        row!("no anchor in the plane", PLANAR, [(6, "")], 4, "mechanism.legs.0.anchor", MissingKey,
            "nothing: the key is missing", "[x, y]: the leg's joint on the base"),
        row!("no direction in the plane", PLANAR, [(10, "")], 8, "mechanism.legs.1.direction",
            MissingKey, "nothing: the key is missing", "[x, y]: the guide's direction"),
        row!("zero reference in the plane", POINT, [(12, "reference = [0, 0]")], 12,
            "mechanism.legs.1.reference", OutOfDomain, "may be, zero", "not zero"),
        row!("planes in the plane", PLANAR, [(9, "drive = \"planar\"")], 9, "mechanism.legs.1.drive",
            Conflict, "\"planar\", in a machine of kind \"planar\"", "\"slider\", \"strut\", \"arm\""),
        row!("sliders on a ball joint", SPHERICAL, [(9, "drive = \"slider\"")], 9,
            "mechanism.legs.1.drive", Conflict, "in a machine of kind \"spherical\"", "\"strut\""),
        row!("arms beside struts", PLANAR, [(15, "drive = \"arm\"\narm = 100\nlength = 500\nmode = \"+\"")], 15,
            "mechanism.legs.2.drive", Conflict, "next to another kind of drive", "no unit"),
        row!("key of another drive", PLANAR, [(7, "length = 3")], 7, "mechanism.legs.0.length",
            UnknownKey, "an unknown key", "length goes with drive = \"slider\", drive = \"arm\""),
        row!("base axis of a hexapod", SPATIAL, [(5, "  { drive = \"strut\", anchor = [-23, 13, 0], base_axis = [0, 0, 1] },")],
            5, "mechanism.legs.0.base_axis", UnknownKey, "an unknown key", "of kind \"translational\""),
        row!("base axis of a slider", LEGS, [(7, "base_axis = [1, 0, 0]")], 7,
            "mechanism.legs.0.base_axis", UnknownKey, "an unknown key", "drive = \"strut\""),
        row!("zero base axis", STRUTS, [(6, "base_axis = [0, 0, 0]")], 6, "mechanism.legs.0.base_axis",
            OutOfDomain, "may be, zero", "not zero"),
        row!("rod of a plane", PLANES, [(5, "direction = [1, 0, 0]\nrod = { radius = 1, trim = [0, 0] }")], 6,
            "mechanism.legs.0.rod", UnknownKey, "an unknown key", "drive, direction"),
        row!("five legs in space", SPATIAL, [(10, "")], 4, "mechanism.legs", WrongType,
            "an array of 5 elements", "six [[mechanism.legs]] tables, or more"),
        row!("two legs that turn", PLANAR, [(14, ""), (15, ""), (16, "")], 4, "mechanism.legs", WrongType,
            "an array of 2 elements", "three [[mechanism.legs]] tables, or more"),
        row!("one leg in the plane", POINT, [(9, ""), (10, ""), (11, ""), (12, ""), (13, ""), (14, ""), (15, "")],
            3, "mechanism.legs", WrongType, "an array of one element", "two [[mechanism.legs]] tables, or more"),
        row!("a leg twice", SPATIAL, [(6, "  { drive = \"strut\", anchor = [-22.95, 13.25, 0], platform = [-1, 11.5, 0] },")],
            6, "mechanism.legs.1", OutOfDomain, "the leg mechanism.legs.0 once more", "independent"),
        row!("misspelt drive", SPATIAL, [(5, "  { drive = \"strutt\", anchor = [-23, 13, 0] },")], 5,
            "mechanism.legs.0.drive", UnknownWord, "\"strutt\"", "did you mean \"strut\"?"),
        row!("leg length of a hexapod", SPATIAL, [(3, "leg_length = 3")], 3, "mechanism.leg_length",
            UnknownKey, "an unknown key", "leg_length goes with kind = \"orthoglide\""),
    ]);
}

#[test]
#[rustfmt::skip]
fn units_and_orientations() {
    check(&[
        row!("no unit of angles", SPATIAL, [(3, "")], 1, "mechanism.characteristic_length", MissingKey,
            "nothing: the key is missing", "which transmission of a platform that turns needs"),
        row!("no unit of angles for stiffness", PLANAR, [(3, ""), (22, "stiffness = { joint = 1, min = 2 }")], 1,
            "mechanism.characteristic_length", MissingKey, "nothing: the key is missing", "stiffness"),
        row!("unit of angles of a point", POINT, [(2, "kind = \"planar\"\ncharacteristic_length = 3")], 3,
            "mechanism.characteristic_length", Conflict, "3, of a platform that does not turn", "orientation"),
        row!("unit of angles without turning", LEGS, [(2, "kind = \"translational\"\ncharacteristic_length = 3")], 3,
            "mechanism.characteristic_length", UnknownKey, "an unknown key",
            "characteristic_length goes with kind = \"planar\", \"spatial\", \"spherical\""),
        row!("zero unit", SPATIAL, [(3, "characteristic_length = 0")], 3, "mechanism.characteristic_length",
            OutOfDomain, "0", "a length greater than 0"),
        row!("unit with tolerance", SPATIAL, [(3, "characteristic_length = \"10 ± 1\"")], 3,
            "mechanism.characteristic_length", Tolerance, "10 ± 1", "one exact number"),
        row!("no orientation", SPATIAL, [(15, "")], 12, "workspace.orientation", MissingKey,
            "nothing: the key is missing", "{ angle = 15 }, { tilt = 20, torsion = 40 }"),
        row!("no orientation on a ball joint", SPHERICAL, [(17, "min = [0, 0, 0]")], 17, "workspace.min",
            Conflict, "of a platform that turns about the origin", "orientation alone"),
        row!("orientation without turning", LEGS, [(24, "max = [60, 60, 200]\norientation = { angle = 3 }")], 25,
            "workspace.orientation", Conflict, "does not turn", "or no orientation"),
        row!("a number", SPATIAL, [(15, "orientation = 15")], 15, "workspace.orientation", WrongType,
            "15", "{ angle = 15 }"),
        row!("nothing", SPATIAL, [(15, "orientation = {}")], 15, "workspace.orientation.angle", MissingKey,
            "nothing: the key is missing", "{ angle = 15 }"),
        row!("two sets", SPATIAL, [(15, "orientation = { angle = 15, tilt = 2 }")], 15,
            "workspace.orientation.tilt", Conflict, "2, next to workspace.orientation.angle", "one of"),
        row!("tilt alone", SPATIAL, [(15, "orientation = { tilt = 15 }")], 15, "workspace.orientation.torsion",
            MissingKey, "nothing: the key is missing", "from 0 to less than 180"),
        row!("roll alone", SPATIAL, [(15, "orientation = { roll = [0, 1], yaw = [0, 1] }")], 15,
            "workspace.orientation.pitch", MissingKey, "nothing: the key is missing", "the least and the greatest angle"),
        row!("half a turn", SPATIAL, [(15, "orientation = { angle = 180 }")], 15, "workspace.orientation.angle",
            OutOfDomain, "180", "less than 180"),
        row!("negative angle", SPATIAL, [(15, "orientation = { angle = -1 }")], 15, "workspace.orientation.angle",
            OutOfDomain, "-1", "from 0"),
        row!("range in space", SPATIAL, [(15, "orientation = { angle = [-20, 20] }")], 15,
            "workspace.orientation.angle", WrongType, "an array of 2 elements", "an angle in degrees"),
        row!("range reversed", SPATIAL, [(15, "orientation = { roll = [1, 0], pitch = [0, 0], yaw = [0, 0] }")], 15,
            "workspace.orientation.roll.1", Reversed, "0, below the lower end 1", "at least"),
        row!("range of a turn", PLANAR, [(20, "orientation = { angle = [-180, 20] }")], 20,
            "workspace.orientation.angle.0", OutOfDomain, "-180", "between -180 and 180"),
        row!("angle in the plane", PLANAR, [(20, "orientation = { angle = 20 }")], 20,
            "workspace.orientation.angle", WrongType, "20", "the least and the greatest angle"),
        row!("tilt in the plane", PLANAR, [(20, "orientation = { tilt = 20 }")], 20,
            "workspace.orientation.tilt", UnknownKey, "an unknown key", "kind = \"spatial\""),
        row!("misspelt", SPATIAL, [(15, "orientation = { anlge = 3 }")], 15, "workspace.orientation.anlge",
            UnknownKey, "an unknown key", "did you mean angle?"),
        row!("corner of three in the plane", PLANAR, [(18, "min = [-5, -5, 0]")], 18, "workspace.min",
            WrongType, "an array of 3 elements", "[x, y]: two exact numbers"),
        row!("cylinder in the plane", PLANAR, [(18, "cylinder = { center = [0, 0], radius = 1, z = [0, 1] }"), (19, "")],
            18, "workspace.cylinder", Conflict, "a cylinder", "min and max = [x, y]"),
        row!("cube of a hexapod", SPATIAL, [(13, "cube = 3"), (14, "")], 13, "workspace.cube", Conflict,
            "a cube, next to another machine", "\"orthoglide\" only"),
    ]);
}

#[test]
#[rustfmt::skip]
fn requirements_that_only_the_kernel_knows() {
    check(&[
        row!("stiffness of no joint", LEGS, [(26, "stiffness = { min = 20 }")], 26,
            "requirements.stiffness.joint", MissingKey, "nothing: the key is missing", "{ joint = 50, min = 20 }"),
        row!("stiffness of two joints", LEGS, [(26, "stiffness = { joint = [1, 2], min = 20 }")], 26,
            "requirements.stiffness.joint", WrongType, "an array of 2 elements", "an array of three numbers"),
        row!("joint without stiffness", LEGS, [(26, "stiffness = { joint = [1, 0, 2], min = 20 }")], 26,
            "requirements.stiffness.joint.1", OutOfDomain, "0", "a stiffness greater than 0"),
        row!("stiffness from above", LEGS, [(26, "stiffness = { joint = 1, max = 20 }")], 26,
            "requirements.stiffness.max", UnknownKey, "an unknown key", "joint, min"),
        row!("acceleration without speed", LEGS, [(26, "joint_acceleration = { acceleration = 1, max = 2 }")], 26,
            "requirements.joint_acceleration.speed", MissingKey, "nothing: the key is missing", "{ speed = 1200"),
        row!("negative speed", LEGS, [(26, "joint_acceleration = { speed = -1, acceleration = 1, max = 2 }")], 26,
            "requirements.joint_acceleration.speed", OutOfDomain, "-1", "0 or greater"),
        row!("no acceleration", LEGS, [(26, "joint_acceleration = { speed = 1, acceleration = 1, max = 0 }")], 26,
            "requirements.joint_acceleration.max", OutOfDomain, "0", "greater than 0"),
        row!("force without a tool", LEGS, [(26, "joint_force = { max = 2 }")], 26,
            "requirements.joint_force.tool", MissingKey, "nothing: the key is missing", "{ tool = 100, max = 250 }"),
        row!("load of no force", LEGS, [(26, "load = { force = [0, 0, 0], max = 2 }")], 26,
            "requirements.load.force", OutOfDomain, "an array of 3 elements", "not zero"),
        row!("load of two numbers", LEGS, [(26, "load = { force = [1, 0], max = 2 }")], 26,
            "requirements.load.force", OutOfDomain, "an array of 2 elements", "a number for each coordinate"),
        row!("load without a bound", LEGS, [(26, "load = { force = [1, 0, 0] }")], 26,
            "requirements.load.max", MissingKey, "nothing: the key is missing", "{ force = [0, 0, -100], max = 250 }"),
        row!("load of a platform that turns", SPATIAL, [(17, "load = { force = [1, 0, 0], max = 2 }")], 17,
            "requirements.load", Conflict, "a platform that turns", "joint_force"),
        row!("not one to one", LEGS, [(26, "one_to_one = false")], 26, "requirements.one_to_one",
            OutOfDomain, "the boolean false", "true, or nothing: the key is missing"),
        row!("one to one of half a turn", SPATIAL, [(15, "orientation = { angle = 90 }"), (17, "one_to_one = true")], 17,
            "requirements.one_to_one", Claim, "not well formed", "differ by less than half a turn"),
        row!("accuracy of no size", LEGS, [(26, "accuracy = { joint_error = 0, max = \"1e-50\" }")], 26,
            "requirements.accuracy", Claim, "not well formed", "neither too small nor too large"),
        row!("one to one by a number", LEGS, [(26, "one_to_one = 1")], 26, "requirements.one_to_one",
            WrongType, "1", "true, or nothing: the key is missing"),
        row!("accuracy without an error", LEGS, [(26, "accuracy = { max = 1 }")], 26,
            "requirements.accuracy.joint_error", MissingKey, "nothing: the key is missing", "{ joint_error = 0.01, max = 0.05 }"),
        row!("accuracy of angles", LEGS, [(26, "accuracy = { joint_error = 0, max = 1, max_angle = 1 }")],
            26, "requirements.accuracy.max_angle", UnknownKey, "an unknown key", "joint_error, max"),
        row!("accuracy of a platform that turns", SPATIAL, [(17, "accuracy = { joint_error = 0, max = 1 }")],
            17, "requirements.accuracy.max_angle", MissingKey, "nothing: the key is missing",
            "{ joint_error = 0.01, max = 0.05, max_angle = 0.1 }"),
        row!("accuracy of half a turn", SPATIAL, [(17, "accuracy = { joint_error = 0, max = 1, max_angle = 180 }")],
            17, "requirements.accuracy.max_angle", OutOfDomain, "180", "less than 180"),
        row!("clearance of nothing", LEGS, [(26, "clearance = { min = 1 }")], 26, "requirements.clearance",
            Conflict, "without rods and bodies", "rod = { radius = 8"),
        row!("clearance of one body", LEGS, [(9, "mode = \"-\"\nrod = { radius = 1, trim = [0, 0] }"), (26, "clearance = { min = 1 }")],
            27, "requirements.clearance", Conflict, "of one body alone", "[[mechanism.bodies]]"),
        row!("margin of couples without axes", STRUTS, [(17, "constraint_margin = { min = 0.1 }")], 17,
            "requirements.constraint_margin", Conflict, "without a base_axis", "every leg a strut"),
        row!("joint of a leg among the requirements", LEGS, [(26, "base_joint = { axis = [0, 0, 1], max = 45 }")], 26,
            "requirements.base_joint", UnknownKey, "an unknown key", "base_joint goes with a leg"),
        row!("joint without an axis", LEGS, [(7, "base_joint = { max = 45 }")], 7, "mechanism.legs.0.base_joint.axis",
            MissingKey, "nothing: the key is missing", "{ axis = [0, 0, 1], max = 45 }"),
        row!("joint with a zero axis", LEGS, [(7, "platform_joint = { axis = [0, 0, 0], max = 45 }")], 7,
            "mechanism.legs.0.platform_joint.axis", OutOfDomain, "may be, zero", "not all zero"),
        row!("axis of two in space", LEGS, [(7, "platform_joint = { axis = [0, 1], max = 45 }")], 7,
            "mechanism.legs.0.platform_joint.axis", WrongType, "an array of 2 elements", "[x, y, z]"),
        row!("axis with tolerance", LEGS, [(7, "platform_joint = { axis = [0, 0, \"1 ± 0.1\"], max = 45 }")], 7,
            "mechanism.legs.0.platform_joint.axis.2", Tolerance, "1 ± 0.1", "one exact number"),
        row!("joint of half a turn", LEGS, [(7, "base_joint = { axis = [0, 0, 1], max = 180 }")], 7,
            "mechanism.legs.0.base_joint.max", OutOfDomain, "180", "less than 180"),
        row!("rod without a trim", LEGS, [(7, "rod = { radius = 1 }")], 7, "mechanism.legs.0.rod.trim",
            MissingKey, "nothing: the key is missing", "or [0, 0]"),
        row!("rod without a radius", LEGS, [(7, "rod = { radius = 0, trim = [0, 0] }")], 7,
            "mechanism.legs.0.rod.radius", OutOfDomain, "0", "a radius greater than 0"),
        row!("spread without an axis", LEGS, [(7, "rod = { radius = 1, trim = [0, 0], spread = 8 }")], 7,
            "mechanism.legs.0.rod.axis", MissingKey, "nothing: the key is missing", "along what the two rods are apart"),
        row!("axis without a spread", LEGS, [(7, "rod = { radius = 1, trim = [0, 0], axis = [0, 1, 0] }")], 7,
            "mechanism.legs.0.rod.spread", MissingKey, "nothing: the key is missing", "how far apart the two rods"),
        row!("spread of nothing", LEGS, [(7, "rod = { radius = 1, trim = [0, 0], spread = 0, axis = [0, 1, 0] }")], 7,
            "mechanism.legs.0.rod.spread", OutOfDomain, "0", "greater than 0"),
        row!("axis of a spread without direction", LEGS, [(7, "rod = { radius = 1, trim = [0, 0], spread = 8, axis = [0, 0, 0] }")], 7,
            "mechanism.legs.0.rod.axis", OutOfDomain, "zero", "not all zero"),
        row!("negative trim", LEGS, [(7, "rod = { radius = 1, trim = [0, -1] }")], 7,
            "mechanism.legs.0.rod.trim.1", OutOfDomain, "-1", "0 or greater"),
        row!("body on a leg", LEGS, [(3, "[[mechanism.bodies]]\non = \"leg\"\n[[mechanism.legs]]")], 4,
            "mechanism.bodies.0.on", UnknownWord, "\"leg\"", "\"base\", \"platform\""),
        row!("body without an end", LEGS, [(3, "[[mechanism.bodies]]\non = \"base\"\nfrom = [0, 0, 0]\n[[mechanism.legs]]")],
            3, "mechanism.bodies.0.to", MissingKey, "nothing: the key is missing", "an end of the body's axis"),
        row!("body of tolerance", LEGS, [(3, "bodies = [{ on = \"base\", from = [0, 0, \"1 ± 1\"], to = [0, 0, 0], radius = 1 }]\n[[mechanism.legs]]")],
            3, "mechanism.bodies.0.from.2", Tolerance, "1 ± 1", "one exact number"),
        row!("joint range of two joints", POINT, [(20, "joint_range = [{ min = 0, max = 33 }]")], 20,
            "requirements.joint_range", WrongType, "an array of one element", "an array of two such tables"),
        row!("angles without an end", POINT, [(20, "joint_range = { min = 0 }")], 20,
            "requirements.joint_range.max", MissingKey, "nothing: the key is missing", "in degrees, both ends"),
        row!("guides of struts", SPATIAL, [(17, "leg_angle = { max = 30 }")], 17, "requirements.leg_angle",
            Conflict, "legs without a guide", "leg_angle for sliders"),
    ]);
    let redundant = |line: &str| {
        let fourth = "[[mechanism.legs]]\ndrive = \"strut\"\nanchor = [3, 3, -3]\n[workspace]";
        refuse(&with(STRUTS, &[(13, fourth), (17, line)]))
    };
    for line in [
        "joint_force = { tool = 1, max = 2 }",
        "load = { force = [1, 0, 0], max = 2 }",
        "accuracy = { joint_error = 1, max = 2 }",
        "parallel_margin = { min = 0.1 }",
    ] {
        let error = redundant(line);
        assert_eq!((error.defect(), error.position().line), (Conflict, 20), "{error}");
        assert!(error.found().contains("4 joints of 3 coordinates"), "{error}");
    }
}

#[test]
fn what_the_kernel_refuses_is_said_where_it_stands() {
    let tree = toml::de::DeTable::parse(PLANAR).unwrap();
    let names = document::Names::None;
    let document = document::Document { file: "test.toml", text: PLANAR, names };
    let root = document.root(tree.get_ref());
    for (place, key, line) in [
        ("mechanism", "mechanism", 1),
        ("mechanism.legs", "mechanism.legs", 4),
        ("mechanism.characteristic_length", "mechanism.characteristic_length", 3),
        ("leg 2: length", "mechanism.legs.1.length", 12),
        ("leg 1: platform.1", "mechanism.legs.0.platform", 7),
        ("leg 3: base_joint", "mechanism.legs.2", 14),
        ("leg 9: length", "mechanism", 1),
        ("requirement 1: transmission", "requirements.transmission", 22),
        ("requirement 2: stiffness", "requirements", 21),
        ("workspace", "workspace", 17),
        ("workspace.radius", "workspace", 17),
        ("orientation", "workspace.orientation", 20),
        ("l", "mechanism", 1),
    ] {
        let number = ClaimError { place: place.to_owned(), expected: "greater than zero" };
        let error = refused(&root, &number);
        assert_eq!((error.defect(), error.key()), (Defect::Claim, key), "{error}");
        assert_eq!(error.position().line, line, "{error}");
        assert!(error.accepted().contains("greater than zero"), "{error}");
        check_message(&error, PLANAR);
    }
}

#[test]
fn maps_are_of_platforms_that_turn_too() {
    let head = "[parameters]\na = { min = 1, max = 2 }\n[atlas]\nresolution = 1\nboxes = 10\n";
    let text = format!("{head}{}", with(SPATIAL, &[(3, "characteristic_length = \"a\"")]));
    let map = crate::design::AtlasDesign::parse(&text, "test.toml").unwrap();
    assert!(map.machine.orientation.is_some());
}

#[test]
fn no_text_of_any_kind_makes_the_reader_panic() {
    let replacements = ["", "\"", "[", "]", "}", "=", "\n", "-", "9", "±"];
    for design in [PLANAR, POINT, SPATIAL, SPHERICAL] {
        for (at, c) in design.char_indices().step_by(4) {
            for new in replacements {
                let text = format!("{}{new}{}", &design[..at], &design[at + c.len_utf8()..]);
                if let Err(error) = Design::parse(&text, "test.toml") {
                    check_message(&error, &text);
                }
            }
        }
    }
}
