//! The formally verified checker in a page: the page proves its claim again when it is opened, or says what
//! of it that checker does not cover.
//!
//! `proofs/rocq/program/verified.js` is extracted from the formal development by `make js` there. Nothing
//! in a page rests on it: the exact checker has accepted the certificate before the page is made.

use crate::report::escape;
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::certificate::{Claim, Evidence, Proof, Step};
use orthocert_kernel::claim::{MachineClaim, Mechanism};
use serde_json::Value;

/// The program: it defines `orthocert_verify(text)`.
pub const PROGRAM: &str = include_str!("../../../proofs/rocq/program/verified.js");

/// Most bytes of a certificate in a page: what a browser checks in a second or two.
pub const MOST_BYTES: usize = 1 << 17;

/// Most tests at control points, of all steps of a certificate in a page: ten thousand take a browser a second.
pub const MOST_POINTS: usize = 25_000;

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

/// The certificate as the page holds it, if it is not too large for that.
pub fn verified(certificate: &Certificate, bytes: &[u8]) -> Verified {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) if bytes.len() <= MOST_BYTES && points(certificate) <= MOST_POINTS => text,
        _ => {
            return Verified {
                note: "<p class=\"note\" id=\"reproved\">The certificate is too large to be proved again in a \
                       page: run <code>orthocert-verified</code> on it, the formally verified checker.</p>"
                    .to_owned(),
                scripts: String::new(),
            }
        }
    };
    Verified {
        note: "<p class=\"scripted\" id=\"reproved\" role=\"status\">Proving the claim again, with the formally \
               verified checker\u{2026}</p><noscript><p class=\"note\">With scripts on, this page proves its \
               claim again, or says why it does not; section \u{201c}Check it again\u{201d} says how to do so without.</p></noscript>"
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
