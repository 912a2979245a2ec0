//! Machines of every kind, and the claims of the kernel that they are read into.

use super::*;
use orthocert_kernel::claim as kernel;
use serde_json::{json, Value};

/// A machine in the plane that turns its platform.
pub(super) const PLANAR: &str = r#"[mechanism]
kind = "planar"
characteristic_length = 100
[[mechanism.legs]]
drive = "strut"
anchor = [0, 400]
platform = [0, "-100 ± 0.01"]
[[mechanism.legs]]
drive = "slider"
direction = [0, 1]
anchor = ["200*sqrt(3)", -200]
length = 500
mode = "-"
[[mechanism.legs]]
drive = "strut"
anchor = [-400, 0]
[workspace]
min = [-5, -5]
max = [5, 5]
orientation = { angle = [-20, 20] }
[requirements]
transmission = { max = 2 }
"#;

/// A five-bar.
pub(super) const POINT: &str = r#"[mechanism]
kind = "planar"
[[mechanism.legs]]
drive = "arm"
anchor = [-59, 0]
arm = 90
length = 90
mode = "+"
[[mechanism.legs]]
drive = "arm"
anchor = [59, 0]
reference = [-1, 0]
arm = 90
length = 90
mode = "-"
[workspace]
min = [-20, 90]
max = [20, 130]
[requirements]
joint_range = [{ min = 0, max = 33 }, { min = -33, max = 0 }]
joint_speed = { tool = 100, max = 1500 }
"#;

/// A hexapod.
pub(super) const SPATIAL: &str = r#"[mechanism]
kind = "spatial"
characteristic_length = 10
legs = [
  { drive = "strut", anchor = [-22.95, 13.25, 0], platform = [-1, 11.5, 0] },
  { drive = "strut", anchor = [22.95, 13.25, 0], platform = [1, 11.5, 0] },
  { drive = "strut", anchor = [22.95, 13.25, 0], platform = [10.459, -4.884, 0] },
  { drive = "strut", anchor = [0, -26.5, 0], platform = [9.459, -6.616, 0] },
  { drive = "strut", anchor = [0, -26.5, 0], platform = [-9.459, -6.616, 0] },
  { drive = "strut", anchor = [-22.95, 13.25, 0], platform = [-10.459, -4.884, 0] },
]
[workspace]
min = [-4, -4, 16]
max = [4, 4, 24]
orientation = { angle = 15 }
[requirements]
transmission = { max = 2 }
"#;

/// A platform on a ball joint.
pub(super) const SPHERICAL: &str = r#"[mechanism]
kind = "spherical"
characteristic_length = 100
[[mechanism.legs]]
drive = "strut"
anchor = [150, 0, -150]
platform = [0, 100, 0]
[[mechanism.legs]]
drive = "strut"
anchor = [-75, 130, -150]
platform = [-87, -50, 0]
[[mechanism.legs]]
drive = "strut"
anchor = [-75, -130, -150]
platform = [87, -50, 0]
[workspace]
orientation = { tilt = 25, torsion = 20 }
[requirements]
transmission = { max = 3 }
"#;

/// The claim that a design is read into, in the form of certificates; what the kernel makes of it is
/// left out.
pub(super) fn kernel(text: &str) -> kernel::MachineClaim {
    let tree = toml::de::DeTable::parse(text).unwrap();
    let document = document::Document { file: "test.toml", text, names: document::Names::None };
    let description = crate::design::description(&document.root(tree.get_ref()));
    let description = description.unwrap_or_else(|error| panic!("{error}\n{text}"));
    description.kernel().expect("short numbers")
}

pub(super) fn shown(text: &str) -> Value {
    serde_json::to_value(kernel(text)).unwrap()
}

#[test]
fn legs_in_the_plane_have_vectors_of_two() {
    let claim = shown(PLANAR);
    let legs = json!([
        { "drive": "strut", "anchor": ["0", "400"], "platform": ["0", { "min": "-100.01", "max": "-99.99" }] },
        { "drive": "slider", "direction": ["0", "1"], "anchor": ["200*sqrt(3)", "-200"],
          "platform": ["0", "0"], "length": "500", "mode": "-" },
        { "drive": "strut", "anchor": ["-400", "0"], "platform": ["0", "0"] },
    ]);
    assert_eq!(
        claim,
        json!({
            "mechanism": { "planar": { "legs": legs, "characteristic_length": "100" } },
            "workspace": { "box": { "min": ["-5", "-5"], "max": ["5", "5"] } },
            "orientation": { "range": ["-20", "20"] },
            "require": [{ "quantity": "transmission", "end": "max", "bound": "2" }],
        })
    );
}

#[test]
fn a_platform_without_orientations_is_a_point() {
    let arm = |x: &str, e: &str, mode: &str| {
        json!({ "drive": "arm", "axis": [], "reference": [e, "0"], "anchor": [x, "0"],
                "platform": ["0", "0"], "arm": "90", "length": "90", "mode": mode })
    };
    let legs = json!([arm("-59", "1", "+"), arm("59", "-1", "-")]);
    let range = |leg: usize, min: &str, max: &str| json!({ "quantity": "joint_range", "leg": leg, "end": "within", "bound": [min, max] });
    let speed = json!({ "quantity": "joint_speed", "given": { "tool": ["100"] }, "end": "max", "bound": "1500" });
    assert_eq!(
        shown(POINT),
        json!({
            "mechanism": { "planar": { "legs": legs } },
            "workspace": { "box": { "min": ["-20", "90"], "max": ["20", "130"] } },
            "require": [range(1, "0", "33"), range(2, "-33", "0"), speed],
        })
    );
}

#[test]
fn a_hexapod_and_its_orientations() {
    let claim = kernel(SPATIAL);
    let kernel::Mechanism::Spatial(turning) = &claim.mechanism else { panic!("{claim:?}") };
    assert_eq!(turning.legs.len(), 6);
    for (written, expected) in [
        ("{ angle = 15 }", json!({ "angle": "15" })),
        ("{ angle = 0 }", json!({ "angle": "0" })),
        (
            "{ torsion = 40, tilt = \"20.5\" }",
            json!({ "tilt": { "tilt": "20.5", "torsion": "40" } }),
        ),
        (
            "{ yaw = [0, 0], roll = [-5, 5], pitch = [\"-1/3\", 5] }",
            json!({ "roll_pitch_yaw": { "roll": ["-5", "5"], "pitch": ["-1/3", "5"], "yaw": ["0", "0"] } }),
        ),
    ] {
        let text = with(SPATIAL, &[(15, &format!("orientation = {written}"))]);
        assert_eq!(shown(&text)["orientation"], expected, "{written}");
    }
    let one_to_one = shown(&with(SPATIAL, &[(17, "one_to_one = true")]));
    assert_eq!(one_to_one["require"], json!([{ "quantity": "one_to_one", "end": "holds" }]));
    let cylinder = with(
        SPATIAL,
        &[(13, "cylinder = { center = [0, 1], radius = 4, z = [16, 24] }"), (14, "")],
    );
    let expected =
        json!({ "cylinder": { "center": ["0", "1"], "radius": "4", "z": ["16", "24"] } });
    assert_eq!(shown(&cylinder)["workspace"], expected);
}

#[test]
fn a_platform_on_a_ball_joint_has_no_position() {
    let claim = shown(SPHERICAL);
    assert_eq!(claim["workspace"], json!({ "box": { "min": [], "max": [] } }));
    assert_eq!(claim["orientation"], json!({ "tilt": { "tilt": "25", "torsion": "20" } }));
    assert_eq!(claim["mechanism"]["spherical"]["legs"][1]["anchor"], json!(["-75", "130", "-150"]));
}

#[test]
fn four_legs_without_turning_are_of_the_kernel() {
    let fourth = "[[mechanism.legs]]\ndrive = \"strut\"\nanchor = [3, 3, 3]\nbase_axis = [0, 0, 1]\n[workspace]";
    let claim = shown(&with(STRUTS, &[(13, fourth)]));
    let legs = claim["mechanism"]["translational"].as_array().unwrap().clone();
    assert_eq!(legs.len(), 4);
    assert_eq!(legs[3]["base_axis"], json!(["0", "0", "1"]));
    assert_eq!(legs[0]["platform"], json!(["1", "0", "0"]));
    assert!(legs[0].get("base_axis").is_none());
    assert!(claim.get("orientation").is_none() && claim.get("bodies").is_none());
}

/// Requirements that only the kernel knows, and what each comes to.
fn requirements() -> Vec<(&'static str, Value)> {
    let stiffness = |joint: Value| json!([{ "quantity": "stiffness", "given": { "joint": joint }, "end": "min", "bound": "20" }]);
    vec![
        ("stiffness = { joint = 50, min = 20 }", stiffness(json!(["50"]))),
        (
            "stiffness = { joint = [50, \"1/3\", 7.5], min = 20 }",
            stiffness(json!(["50", "1/3", "7.5"])),
        ),
        (
            "joint_acceleration = { speed = 1200, acceleration = 14000, max = 40000 }",
            json!([{ "quantity": "joint_acceleration", "given": { "acceleration": ["14000"], "speed": ["1200"] },
                     "end": "max", "bound": "40000" }]),
        ),
        ("one_to_one = true", json!([{ "quantity": "one_to_one", "end": "holds" }])),
        (
            "joint_force = { tool = 100, max = 250 }",
            json!([{ "quantity": "joint_force", "given": { "tool": ["100"] }, "end": "max", "bound": "250" }]),
        ),
        (
            "load = { force = [0, -1.5, \"-1/3\"], max = 250 }",
            json!([{ "quantity": "load", "given": { "force": ["0", "-1.5", "-1/3"] }, "end": "max", "bound": "250" }]),
        ),
        (
            "accuracy = { joint_error = 0.01, max = 0.05 }",
            json!([{ "quantity": "accuracy", "given": { "joint_error": ["0.01"] }, "end": "max", "bound": "0.05" }]),
        ),
    ]
}

#[test]
fn three_legs_with_what_only_the_kernel_knows_are_of_the_kernel() {
    for (line, expected) in requirements() {
        let claim = shown(&with(LEGS, &[(26, line)]));
        assert_eq!(claim["require"], expected, "{line}");
        assert_eq!(claim["mechanism"]["translational"].as_array().unwrap().len(), 3);
        assert_eq!(
            claim["mechanism"]["translational"][0]["length"],
            json!({ "min": "332.95", "max": "333.05" })
        );
        // Without it, the design is what it was.
        read(LEGS);
    }
}

#[test]
fn an_orthoglide_by_its_leg_length_is_three_sliders() {
    let claim = shown(&with(BOX, &[(12, "one_to_one = true")]));
    let zeros = |k: usize, x: Value| {
        let mut vector = json!(["0", "0", "0"]);
        vector[k] = x;
        vector
    };
    for k in 0..3 {
        let expected = json!({
            "drive": "slider", "direction": zeros(k, json!("1")), "anchor": zeros(k, json!("-383.8")),
            "platform": zeros(k, json!("-3")), "length": { "min": "310.23", "max": "310.27" }, "mode": "+",
        });
        assert_eq!(claim["mechanism"]["translational"][k], expected);
    }
    assert_eq!(claim["require"].as_array().unwrap().len(), 3);
}

#[test]
fn the_cube_of_the_paper_has_both_bounds() {
    for (psi, least, greatest) in
        [("2", "0.5", "2"), ("3", "1/3", "3"), ("\"1+sqrt(2)\"", "1/(1+sqrt(2))", "1+sqrt(2)")]
    {
        let lines = format!("transmission = {{ max = {psi} }}\none_to_one = true");
        let claim = shown(&with(CUBE, &[(8, &lines)]));
        assert_eq!(
            claim,
            json!({
                "mechanism": { "orthoglide": { "offset": "0" } },
                "workspace": { "cube": { "side": "200" } },
                "require": [
                    { "quantity": "transmission", "end": "min", "bound": least },
                    { "quantity": "transmission", "end": "max", "bound": greatest },
                    { "quantity": "one_to_one", "end": "holds" },
                ],
            }),
        );
    }
}

#[test]
fn rods_joints_and_bodies() {
    let leg = "anchor = [0, 2, 0]\nrod = { radius = 0.1, trim = [0.2, 0] }\n\
               base_joint = { axis = [0, -1, 0], max = 45 }\nplatform_joint = { axis = [1, 0, 0], max = 30 }";
    let body = "[[mechanism.bodies]]\non = \"base\"\nfrom = [0, 0, 0]\nto = [\"1/3\", 0, 0]\nradius = 0.5\n\
                [[mechanism.bodies]]\non = \"platform\"\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nradius = 0.25\n[workspace]";
    let all = "clearance = { min = 0.05 }\nconditioning = { max = 30 }";
    let claim = shown(&with(STRUTS, &[(9, leg), (13, body), (17, all)]));
    assert_eq!(
        claim["bodies"],
        json!([
            { "on": "leg", "leg": 2, "radius": "0.1", "trim": ["0.2", "0"] },
            { "on": "base", "from": ["0", "0", "0"], "to": ["1/3", "0", "0"], "radius": "0.5" },
            { "on": "platform", "from": ["0", "0", "0"], "to": ["0", "0", "1"], "radius": "0.25" },
        ])
    );
    assert_eq!(
        claim["require"],
        json!([
            { "quantity": "conditioning", "end": "max", "bound": "30" },
            { "quantity": "clearance", "end": "min", "bound": "0.05" },
            { "quantity": "base_joint", "leg": 2, "given": { "axis": ["0", "-1", "0"] }, "end": "max", "bound": "45" },
            { "quantity": "platform_joint", "leg": 2, "given": { "axis": ["1", "0", "0"] }, "end": "max", "bound": "30" },
        ])
    );
    // The two rods of a parallelogram, to either side along the axis.
    let two = "anchor = [0, 2, 0]\nrod = { radius = 0.1, trim = [0.2, 0], spread = 10, axis = [0, 3, 4] }";
    let claim = shown(&with(STRUTS, &[(9, two), (17, "clearance = { min = 0.05 }")]));
    let rod = |offset: [&str; 3]| json!({ "on": "leg", "leg": 2, "radius": "0.1", "trim": ["0.2", "0"], "offset": offset });
    assert_eq!(claim["bodies"], json!([rod(["0", "-3", "-4"]), rod(["0", "3", "4"])]));
    // Along an axis with roots, the offsets are simplified.
    let oblique = two.replace("[0, 3, 4]", "[\"-1/2\", \"sqrt(3)/2\", 0]");
    let claim = shown(&with(STRUTS, &[(9, &oblique), (17, "clearance = { min = 0.05 }")]));
    assert_eq!(claim["bodies"][1], rod(["-2.5", "5*sqrt(3)/2", "0"]));
    // Of joints alone, no requirement of the machine is needed.
    let alone = "anchor = [0, 2, 0]\nbase_joint = { axis = [0, 1, 0], max = 45 }";
    let claim = kernel(&with(STRUTS, &[(9, alone), (17, "")]));
    assert_eq!(claim.require.len(), 1);
}

#[test]
fn couples_of_universal_joints() {
    let leg = |anchor: &str| format!("anchor = {anchor}\nbase_axis = [1, \"sqrt(2)\", 0]");
    let lines = ["[2, 0, 0]", "[0, 2, 0]", "[0, 0, 2]"].map(leg);
    let changes = [
        (5, lines[0].as_str()),
        (9, lines[1].as_str()),
        (12, lines[2].as_str()),
        (17, "constraint_margin = { min = 0.1 }"),
    ];
    let claim = shown(&with(STRUTS, &changes));
    assert_eq!(
        claim["require"],
        json!([{ "quantity": "constraint_margin", "end": "min", "bound": "0.1" }])
    );
    assert_eq!(claim["mechanism"]["translational"][2]["base_axis"], json!(["1", "sqrt(2)", "0"]));
}

#[test]
fn a_unit_of_angles_is_needed_where_something_depends_on_it() {
    let text = with(SPATIAL, &[(3, ""), (17, "joint_range = { max = 40 }")]);
    assert_eq!(shown(&text)["mechanism"]["spatial"]["characteristic_length"], json!("1"));
}

#[test]
fn the_order_of_keys_does_not_matter() {
    let joint = |leg: &str| format!("{leg}\nbase_joint = {{ axis = [0, 0, 1], max = 60 }}");
    let legs = [joint("anchor = [2, 0, 0]"), joint("anchor = [0, 0, 2]")];
    let lines = [
        "one_to_one = true",
        "transmission = { max = 2, min = 0.5 }",
        "joint_speed = { max = 2000, tool = 1 }",
        "joint_range = [{ max = 9, min = 1 }, { min = 2 }, { max = 8 }]",
        "stiffness = { min = 1, joint = 2 }",
    ];
    let text = |lines: Vec<&str>| {
        let lines = lines.join("\n");
        with(STRUTS, &[(5, &legs[0]), (12, &legs[1]), (17, &lines)])
    };
    let forwards = kernel(&text(lines.to_vec()));
    let backwards = kernel(&text(lines.iter().rev().copied().collect()));
    assert_eq!(forwards, backwards);
    let order: Vec<_> = forwards.require.iter().map(|r| (r.quantity.as_str(), r.leg)).collect();
    let first = [
        ("transmission", None),
        ("transmission", None),
        ("joint_range", Some(1)),
        ("joint_range", Some(1)),
        ("joint_range", Some(2)),
        ("joint_range", Some(3)),
        ("joint_speed", None),
    ];
    assert_eq!(order[..first.len()], first);
    assert!(matches!(forwards.require[0].bound, kernel::Bound::Min(_)));
    assert!(matches!(forwards.require[2].bound, kernel::Bound::Min(_)));
    let position = |key: &str| order.iter().position(|(other, _)| *other == key).unwrap();
    let known = |key: &str| orthocert_kernel::quantity::TABLE.iter().position(|q| q.key == key);
    for pair in order.windows(2) {
        if let (Some(a), Some(b)) = (known(pair[0].0), known(pair[1].0)) {
            assert!(a <= b, "{order:?}");
        }
    }
    assert_eq!(order[position("base_joint") + 1], ("base_joint", Some(3)));
}

#[test]
fn the_kernel_takes_what_it_knows() {
    let fourth = "[[mechanism.legs]]\ndrive = \"strut\"\nanchor = [3, 3, -3]\n[workspace]";
    let design = Design::parse(&with(STRUTS, &[(13, fourth)]), "test.toml").unwrap();
    assert_eq!(design.sources.position("mechanism.legs.3").unwrap().line, 13);
}

#[test]
fn what_no_requirement_is_about_is_noted() {
    let rods = "anchor = [0, 2, 0]\nrod = { radius = 0.1, trim = [0.2, 0] }";
    let axes = "anchor = [0, 2, 0]\nbase_axis = [1, 0, 0]";
    let notes = |changes: &[(usize, &str)]| {
        Design::parse(&with(STRUTS, changes), "d.toml").unwrap().notes()
    };
    assert_eq!(notes(&[]), [""; 0]);
    let [note] = &notes(&[(15, "max = [6, 5, 6]")])[..] else { panic!("one note") };
    assert!(note.starts_with("workspace.min.1, line 14: the same as workspace.max.1"), "{note}");
    let [note] = &notes(&[(9, rods)])[..] else { panic!("one note") };
    assert!(
        note.starts_with("mechanism.legs.1.rod, line 10: nothing is claimed of rods"),
        "{note}"
    );
    assert!(note.ends_with("no clearance"), "{note}");
    let other = "anchor = [0, 0, 2]\nrod = { radius = 0.1, trim = [0, 0.2] }";
    assert_eq!(notes(&[(9, rods), (12, other), (17, "clearance = { min = 0.05 }")]), [""; 0]);
    let [note] = &notes(&[(9, axes)])[..] else { panic!("one note") };
    assert!(
        note.starts_with("mechanism.legs.1.base_axis, line 10: ")
            && note.ends_with("no constraint_margin")
    );
    // Ten degrees in radians.
    let text = include_str!("../../../tests/designs/kernel/linapod-six-type.toml");
    let turned = text.replace("angle = 8", "angle = 0.1745");
    assert_eq!(Design::parse(text, "d.toml").unwrap().notes(), [""; 0]);
    let [note] = &Design::parse(&turned, "d.toml").unwrap().notes()[..] else { panic!("one note") };
    assert!(note.ends_with(": 0.1745 degrees, less than one"), "{note}");
    assert!(note.starts_with("workspace.orientation.angle, line "), "{note}");
}
