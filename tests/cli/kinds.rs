//! Machines of every kind: what is refused, and certificates of the kernel against their designs.

use crate::support::Folder;
use orthocert_kernel::certificate::{Certificate, Claim, Failure, Proof, Verdict, Witness};
use orthocert_kernel::claim::{
    Bound, Formulas, JointFormula, MachineClaim, Mechanism, Quantity, Requirement, Workspace,
};
use orthocert_kernel::number::Expression;

/// A carriage on a guide, whose joint goes to 2 and may go to 1.
const DESIGN: &str = "\
[mechanism]
kind = \"formulas\"
coordinates = [\"x\"]
[mechanism.parameters]
g = \"2 ± 0.5\"
[[mechanism.joints]]
rho = \"x / g\"
[workspace]
min = [0]
max = [4]
[requirements]
joint_range = { max = 1 }
";

fn number(text: &str) -> Expression {
    Expression::try_from(text.to_owned()).unwrap()
}

/// The refutation of that design: at `x = 4` with `g = 2`, `rho = 2`.
fn refuted() -> Vec<u8> {
    let claim = MachineClaim {
        mechanism: Mechanism::Formulas(Formulas {
            coordinates: vec!["x".to_owned()],
            parameters: vec![(
                "g".to_owned(),
                Quantity::Between { min: number("1.5"), max: number("2.5") },
            )],
            definitions: Vec::new(),
            joints: vec![JointFormula::Rho(number("x/g"))],
        }),
        workspace: Workspace::Box { min: vec![number("0")], max: vec![number("4")] },
        orientation: None,
        bodies: Vec::new(),
        require: vec![Requirement {
            quantity: "joint_range".to_owned(),
            leg: None,
            given: std::collections::BTreeMap::new(),
            bound: Bound::Max(number("1")),
        }],
    };
    let witness = Witness {
        precision: 64,
        point: vec![number("4")],
        machine: vec![number("2")],
        fails: Failure::Obligation(1, Vec::new()),
    };
    let certificate = Certificate {
        format: orthocert_kernel::certificate::FORMAT.to_owned(),
        claim: Claim::Machine(claim),
        verdict: Verdict::Refuted,
        proof: Proof::Witness(witness),
        provenance: orthocert_kernel::certificate::Provenance {
            tool: "by hand".to_owned(),
            version: "1".to_owned(),
        },
    };
    certificate.to_text().unwrap().into_bytes()
}

#[test]
fn a_certificate_is_checked_against_its_design() {
    let folder = Folder::new();
    folder.write("machine.json", refuted());
    folder.write("machine.toml", DESIGN);
    let run = folder.run(&["check", "machine.json", "--design", "machine.toml"]).exits(1);
    run.says(&["ACCEPTED: refuted", "rho_1 = x/g"]);
    for (old, new, parts) in [
        ("max = 1 }", "max = 3 }", "require.0.bound is 1 in the certificate and 3 in the design"),
        ("± 0.5", "± 0.4", "max is 2.5 in the certificate and 2.4 in the design"),
        ("x / g", "x * g", "joints.0.rho is x/g in the certificate and x*g in the design"),
        ("max = [4]", "max = [5]", " workspace.max.0 is 4 in the certificate and 5 in the design"),
        (
            "joint_range = { max = 1 }",
            "joint_range = { max = 1 }\nconditioning = { max = 3 }",
            "require.1 is absent in the certificate",
        ),
        (
            "joint_range = { max = 1 }",
            "joint_range = { min = 1 }",
            "require.0.end is max in the certificate and min in the design",
        ),
    ] {
        assert!(DESIGN.contains(old));
        folder.write("other.toml", DESIGN.replacen(old, new, 1));
        let run = folder.run(&["check", "machine.json", "--design", "other.toml"]).exits(5);
        run.complains(&["another claim", parts]);
    }
    let planar = folder.run(&["init", "--kind", "planar"]).exits(0).stdout;
    folder.write("planar.toml", planar);
    let run = folder.run(&["check", "machine.json", "--design", "planar.toml"]).exits(5);
    run.complains(&["mechanism is formulas in the certificate and planar in the design\n"]);
    let other = DESIGN.replacen("joint_range = { max = 1 }", "conditioning = { max = 3 }", 1);
    folder.write("other.toml", other);
    let run = folder.run(&["check", "machine.json", "--design", "other.toml"]).exits(5);
    run.complains(&["require.0.quantity is joint_range in the certificate and conditioning in"]);
}

/// Where boxes remain open, orientations are told in degrees, or explained.
#[test]
fn open_boxes_tell_how_they_are_turned() {
    let folder = Folder::new();
    for (design, says) in [
        ("planar-3-rrr.toml", &["phi, deg -15 .. 15"][..]),
        ("hexapod-ssm.toml", &["its middle: not turned", "c_x, c_y, c_z: of a turn by theta"]),
        ("spherical-3-ups.toml", &["its middle: tilt 0 deg, torsion 0 deg"]),
    ] {
        let from = format!("{}/tests/designs/kernel/{design}", env!("CARGO_MANIFEST_DIR"));
        folder.write(design, std::fs::read(from).unwrap());
        let run = folder.run(&["verify", design, "--max-boxes", "3"]).exits(3).says(says);
        assert!(!run.stdout.contains("tan(phi/2)"), "{}", run.stdout);
    }
}

#[test]
fn formulas_are_printed_on_request() {
    let folder = Folder::with(&["orthoglide-310.toml"]);
    folder.write("machine.json", refuted());
    let run = folder.run(&["check", "machine.json", "--formulas"]).exits(1);
    run.says(&["ACCEPTED: refuted", "Its formulas:", "p0 = g", "rho_1 = t1", "A_11 = ", "D_1 = "]);
    let run = folder.run(&["check", "machine.json"]).exits(1);
    assert!(!run.stdout.contains("Its formulas:"));
    let run = folder.run(&["check", "machine.json", "--formulas", "--format", "json"]).exits(1);
    let answer: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert!(answer["formulas"].as_str().unwrap().contains("p0 = g"));
    folder.run(&["verify", "orthoglide-310.toml", "-o", "legs.json"]).exits(1);
    let run = folder.run(&["check", "legs.json", "--formulas"]).exits(1);
    run.says(&["Its formulas:", "rho_1 = "]);
    folder.run(&["postulate", "--psi", "2", "-o", "postulate.json"]).exits(0);
    let run = folder.run(&["check", "postulate.json", "--formulas"]).exits(2);
    assert_eq!(run.stdout, "");
    run.complains(&["--formulas", "not checked by formulas", "accepted"]);
    folder.run(&["check", ".", "--formulas"]).exits(2).complains(&["--formulas", "a folder"]);
}

#[test]
fn spoiled_machines_are_refused_with_line_key_and_what_is_accepted() {
    for (old, new, parts) in [
        ("x / g", "x / h", &["bad.toml:7:12", "mechanism.joints.0.rho", "unknown name h"][..]),
        ("x / g", "x / (g - 2)", &["bad.toml:7:12", "may be zero", "^^^^^^^"]),
        ("x / g", "x / g + sqrt(1 - g)", &["bad.toml:7:20", "may be negative"]),
        ("x / g", "x", &["bad.toml:5", "mechanism.parameters.g", "no joint depends on"]),
        ("g =", "x =", &["bad.toml:5", "mechanism.parameters.x", "once more"]),
        ("[\"x\"]", "[\"x\", \"y\"]", &["bad.toml:6", "1 joints of 2 coordinates"]),
        ("rho =", "rhoo =", &["bad.toml:7", "did you mean rho?"]),
        ("min = [0]", "min = [0, 0]", &["bad.toml:9", "workspace.min", "an array of 2 elements"]),
        ("formulas", "spatial", &["bad.toml:3", "coordinates goes with kind = \"formulas\""]),
        ("joint_range", "clearance", &["bad.toml:12", "requirements.clearance.max", "min"]),
    ] {
        assert!(DESIGN.contains(old));
        let folder = Folder::new();
        folder.write("bad.toml", DESIGN.replacen(old, new, 1));
        folder.run(&["verify", "bad.toml"]).exits(2).complains(parts);
        assert_eq!(folder.names(), ["bad.toml"]);
    }
}

#[test]
fn machines_that_are_singular_at_every_pose_are_refuted_with_the_reason() {
    let folder = Folder::new();
    for (text, reason) in [
        (
            include_str!("../designs/kernel/hexapod-coinciding-refuted.toml"),
            "all joints on the platform are one point",
        ),
        (
            include_str!("../designs/kernel/hexapod-similar-refuted.toml"),
            "the joints on the platform are a scaled copy of those on the base",
        ),
        (
            include_str!("../designs/kernel/hexapod-collinear-refuted.toml"),
            "all joints on the platform are on one line",
        ),
    ] {
        let (machine, _) = text.split_once("[requirements]").unwrap();
        let asked = "[requirements]\njoint_range = { min = 0, max = 5 }\n";
        folder.write("d.toml", format!("{machine}{asked}"));
        let run = folder.run(&["verify", "d.toml"]).exits(1);
        let run = run.says(&["no parallel singularity", "M is singular at P, exactly"]);
        let words: Vec<&str> = run.stdout.split_whitespace().collect();
        let found = words.join(" ").contains(&format!("{reason}: singular at every pose"));
        assert!(found, "{}", run.stdout);
        folder.run(&["check", "d.cert.json", "--design", "d.toml"]).exits(1);
        folder.run(&["check", "d.cert.json"]).says(&["the columns of M are linearly dependent"]);
        folder.run(&["bounds", "d.toml"]).exits(3).says(&[
            "a singularity, or out of reach, inside",
            "inside M is singular at P, exactly",
        ]);
        folder.run(&["report", "d.cert.json"]).exits(1);
        let run = folder.run(&["limit", "d.toml", "workspace.max.2"]).exits(3);
        run.says(&["no parallel singularity"]);
    }
}
