//! The formally verified checker in a page: the page proves its claim again when it is opened.
//!
//! `proofs/rocq/program/verified.js` is extracted from the formal development by `make js` there. Nothing
//! in a page rests on it: the exact checker has accepted the certificate before the page is made.

use crate::report::escape;
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::atlas::AtlasClaim;
use orthocert_kernel::certificate::{Claim, Evidence, Proof, Step, Verdict};
use orthocert_kernel::claim::{
    Bound, Leg, MachineClaim, Mechanism, Requirement, Turning, Workspace,
};
use orthocert_kernel::no_cube::NoCubeClaim;
use serde_json::Value;

/// The program: it defines `orthocert_verify(text)`.
pub const PROGRAM: &str = include_str!("../../../proofs/rocq/program/verified.js");

/// Most bytes of a certificate in a page: what a browser checks in a second or two.
pub const MOST_BYTES: usize = 1 << 17;

/// Most tests at control points, of all steps of a certificate in a page: ten thousand take a browser a second.
pub const MOST_POINTS: usize = 25_000;

/// Quantities that the formal development knows.
const QUANTITIES: [&str; 9] = [
    "transmission",
    "joint_range",
    "joint_speed",
    "conditioning",
    "serial_margin",
    "parallel_margin",
    "stiffness",
    "constraint_margin",
    "clearance",
];

/// What of the verified checker is in a page.
pub struct Verified {
    /// For the verdict's box; HTML.
    pub note: String,
    /// The certificate and the program, as elements; empty where they are not there.
    pub scripts: String,
}

impl Verified {
    /// Of pages about other files.
    pub const NONE: Verified = Verified { note: String::new(), scripts: String::new() };
}

/// The certificate as the page holds it, or why it does not.
pub fn verified(certificate: &Certificate, bytes: &[u8]) -> Verified {
    let apart = |why: &str| Verified {
        note: format!("<p class=\"note\" id=\"reproved\">{why}</p>"),
        scripts: String::new(),
    };
    if !is_covered(&certificate.claim, certificate.verdict) {
        return apart(
            "Claims of this kind are not covered by the formally verified checker; the exact checker accepted \
             this one.",
        );
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) if bytes.len() <= MOST_BYTES && points(certificate) <= MOST_POINTS => text,
        _ => {
            return apart(
                "The certificate is too large to be proved again in a page: run \
                 <code>orthocert-verified</code> on it, the formally verified checker.",
            )
        }
    };
    Verified {
        note: "<p class=\"scripted\" id=\"reproved\" role=\"status\">Proving the claim again, with the formally \
               verified checker\u{2026}</p><noscript><p class=\"note\">With scripts on, this page proves its \
               claim again; section \u{201c}Check it again\u{201d} says how to do so without.</p></noscript>"
            .to_owned(),
        scripts: format!(
            "<script type=\"application/json\" id=\"certificate\">{}</script>\n<script>{PROGRAM}</script>\n",
            escape::data(&Value::from(text).to_string())
        ),
    }
}

/// How often the program does a test at a control point, at most: there are three to each coordinate of a cell.
fn points(certificate: &Certificate) -> usize {
    let Proof::Tree(tree) = &certificate.proof else { return 0 };
    let is_test = |Step(_, by): &Step| matches!(by, Evidence::Control(_));
    let steps = tree.nodes.iter().flat_map(|node| &node.by).filter(|&step| is_test(step)).count();
    let each = match &certificate.claim {
        Claim::Machine(MachineClaim { mechanism: Mechanism::Spatial(_), .. }) => 729,
        _ => 27,
    };
    steps.saturating_mul(each)
}

/// Whether the program reads claims of this kind. Where it does not read the proof, the page says so.
fn is_covered(claim: &Claim, verdict: Verdict) -> bool {
    match claim {
        Claim::Postulate(_) => true,
        Claim::Machine(claim) => {
            is_machine_covered(claim, verdict)
                || is_by_configuration(claim, verdict)
                || is_in_any_motion(claim, verdict)
        }
        Claim::NoCube(NoCubeClaim { machine, .. }) => {
            let is_box = matches!(machine.workspace, Workspace::Box { .. });
            is_box && machine.bodies.is_empty() && is_machine_covered(machine, Verdict::Refuted)
        }
        // Cells are certified, and refuted.
        Claim::Atlas(AtlasClaim { machine, .. }) => {
            machine.bodies.is_empty() && is_machine_covered(machine, Verdict::Refuted)
        }
    }
}

fn is_machine_covered(claim: &MachineClaim, verdict: Verdict) -> bool {
    let MachineClaim { mechanism, workspace, orientation, bodies: _, require } = claim;
    let is_leg = |leg: &Leg| match leg {
        Leg::Slider { .. } | Leg::Strut { .. } | Leg::Planar { .. } => true,
        Leg::Arm { .. } => false,
    };
    let legs = match mechanism {
        Mechanism::Translational(legs) => legs.as_slice(),
        _ => &[],
    };
    let is_required = require.iter().all(|requirement| {
        is_quantity(requirement, legs, verdict)
            && matches!(requirement.bound, Bound::Min(_) | Bound::Max(_) | Bound::Holds)
            && requirement.given.values().all(|given| given.len() == 1)
    });
    let is_mechanism = match (mechanism, workspace) {
        (Mechanism::Orthoglide { .. }, Workspace::Cube { .. }) => {
            require.iter().all(|requirement| requirement.quantity == "transmission")
        }
        (Mechanism::Translational(legs), Workspace::Box { .. } | Workspace::Cylinder { .. }) => {
            legs.iter().all(is_leg)
        }
        _ => false,
    };
    orientation.is_none() && is_required && is_mechanism
}

/// Whether it reads a requirement of a machine that does not turn its platform: all of them in certified claims.
fn is_quantity(requirement: &Requirement, legs: &[Leg], verdict: Verdict) -> bool {
    let has_plane = legs.iter().any(|leg| matches!(leg, Leg::Planar { .. }));
    match requirement.quantity.as_str() {
        "joint_force" | "one_to_one" | "accuracy" => verdict == Verdict::Certified,
        "joint_acceleration" => verdict == Verdict::Certified && !has_plane,
        "parallel_margin" => legs.iter().all(|leg| matches!(leg, Leg::Slider { .. })),
        key => QUANTITIES.contains(&key),
    }
}

/// Claims about transmission, condition numbers and joint coordinates of struts that turn their platform, and
/// certified ones about mechanisms by formulas, and about joint speeds and forces and stiffness.
fn is_by_configuration(claim: &MachineClaim, verdict: Verdict) -> bool {
    let MachineClaim { mechanism, workspace, orientation, bodies, require } = claim;
    let is_strut = |leg: &Leg| matches!(leg, Leg::Strut { base_axis: None, .. });
    let is_required = |requirement: &Requirement| match requirement.quantity.as_str() {
        "transmission" | "conditioning" | "joint_range" => true,
        "joint_speed" | "joint_force" | "stiffness" => {
            let is_one = requirement.given.values().all(|given| given.len() == 1);
            verdict == Verdict::Certified && is_one
        }
        _ => false,
    };
    let is_mechanism = match (mechanism, workspace) {
        (Mechanism::Formulas(_), Workspace::Box { .. }) => verdict == Verdict::Certified,
        (
            Mechanism::Planar(Turning { legs, .. })
            | Mechanism::Spatial(Turning { legs, .. })
            | Mechanism::Spherical(Turning { legs, .. }),
            Workspace::Box { .. },
        ) => orientation.is_some() && legs.iter().all(is_strut),
        _ => false,
    };
    bodies.is_empty() && is_mechanism && require.iter().all(is_required)
}

/// Claims about arms, and about sliders where the platform turns, moves in the plane, or angles of legs are asked for.
fn is_in_any_motion(claim: &MachineClaim, verdict: Verdict) -> bool {
    let MachineClaim { mechanism, workspace, orientation, bodies, require } = claim;
    let is_arm = |leg: &Leg| matches!(leg, Leg::Arm { .. });
    let has_angle = require.iter().any(|requirement| requirement.quantity == "leg_angle");
    let (legs, turns) = match mechanism {
        Mechanism::Translational(legs) if has_angle || legs.iter().any(is_arm) => (legs, false),
        Mechanism::Planar(Turning { legs, .. }) | Mechanism::Spatial(Turning { legs, .. }) => {
            (legs, orientation.is_some())
        }
        _ => return false,
    };
    let is_leg = |leg: &Leg| match leg {
        Leg::Slider { .. } | Leg::Arm { .. } => true,
        Leg::Strut { base_axis: None, .. } => !turns,
        _ => false,
    };
    let is_workspace = match workspace {
        Workspace::Box { .. } => true,
        Workspace::Cylinder { .. } => matches!(mechanism, Mechanism::Translational(_)),
        Workspace::Cube { .. } => false,
    };
    let is_required = |requirement: &Requirement| match requirement.quantity.as_str() {
        "transmission" | "conditioning" | "joint_range" | "serial_margin" | "leg_angle" => true,
        "joint_speed" | "stiffness" => requirement.given.values().all(|given| given.len() == 1),
        "joint_force" => verdict == Verdict::Certified,
        "parallel_margin" => !turns,
        _ => false,
    };
    bodies.is_empty() && is_workspace && legs.iter().all(is_leg) && require.iter().all(is_required)
}
