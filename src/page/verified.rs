//! The formally verified checker in a page: the page proves its claim again when it is opened.
//!
//! `proofs/rocq/program/verified.js` is extracted from the formal development by `make js` there. Nothing
//! in a page rests on it: the exact checker has accepted the certificate before the page is made.

use crate::escape;
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::{Bound, Leg, MachineClaim, Mechanism, Workspace};
use serde_json::Value;

/// The program: it defines `orthocert_verify(text)`.
pub const PROGRAM: &str = include_str!("../../proofs/rocq/program/verified.js");

/// Most bytes of a certificate in a page: what a browser checks in a second or two.
pub const MOST_BYTES: usize = 1 << 16;

/// Quantities that the formal development knows.
const QUANTITIES: [&str; 8] = [
    "transmission",
    "joint_range",
    "joint_speed",
    "conditioning",
    "serial_margin",
    "parallel_margin",
    "stiffness",
    "constraint_margin",
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
    if !is_covered(&certificate.claim) {
        return apart(
            "Claims of this kind are not covered by the formally verified checker; the exact checker accepted \
             this one.",
        );
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) if bytes.len() <= MOST_BYTES => text,
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

/// Whether the program reads claims of this kind. Where it does not read the proof, the page says so.
fn is_covered(claim: &Claim) -> bool {
    match claim {
        Claim::Postulate(_) => true,
        Claim::Machine(claim) => is_machine_covered(claim),
        Claim::NoCube(_) | Claim::Atlas(_) => false,
    }
}

fn is_machine_covered(claim: &MachineClaim) -> bool {
    let MachineClaim { mechanism, workspace, orientation, bodies, require } = claim;
    let is_known = |key: &str| QUANTITIES.contains(&key);
    let is_leg = |leg: &Leg| match leg {
        Leg::Slider { .. } | Leg::Strut { .. } | Leg::Planar { .. } => true,
        Leg::Arm { .. } => false,
    };
    let is_required = require.iter().all(|requirement| {
        is_known(&requirement.quantity)
            && matches!(requirement.bound, Bound::Min(_) | Bound::Max(_))
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
    orientation.is_none() && bodies.is_empty() && is_required && is_mechanism
}
