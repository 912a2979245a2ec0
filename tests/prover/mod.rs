//! Mathematical tests of the prover: values in doubles, and verdicts against what is known in closed
//! form. Random choices have fixed seeds.
//!
//! | module      | tests                                                                      |
//! |-------------|----------------------------------------------------------------------------|
//! | `atlas`     | maps against the closed form, and against single designs                   |
//! | `oracle`    | values in doubles against those of another program                         |
//! | `tolerances` | wide tolerances, against sampled machines                                 |
//! | `verdicts`  | sweeps over `psi_max` and over units of length                             |
//! | `diagonal`  | cubes on the diagonal, decided in closed form, either side of the truth    |
//! | `mutation`  | altered certificates are rejected, or still true                           |

mod atlas;
mod diagonal;
mod mutation;
mod oracle;
mod tolerances;
mod verdicts;

use orthocert::design::Design;
use orthocert::search::solver::{verify, Answer, Verification};
use orthocert::search::{Budget, Control};
use orthocert_checker::certificate::Verdict;
use orthocert_kernel::claim::MachineClaim;
use std::sync::atomic::AtomicBool;

/// The claim of a design's text.
fn claim(text: &str) -> MachineClaim {
    let design = Design::parse(text, "test").unwrap_or_else(|error| panic!("{error}"));
    design.claim
}

/// An Orthoglide with these legs over the cube `[low, high]^3`, and bounds on psi.
fn orthoglide(length: &str, [low, high]: [&str; 2], transmission: &str) -> MachineClaim {
    claim(&format!(
        "[mechanism]\nkind = \"orthoglide\"\nleg_length = \"{length}\"\n\
         [workspace]\nmin = [\"{low}\", \"{low}\", \"{low}\"]\nmax = [\"{high}\", \"{high}\", \"{high}\"]\n\
         [requirements]\ntransmission = {{ {transmission} }}\n"
    ))
}

/// The paper's Orthoglide of a cube.
fn cube(psi_max: &str, side: &str) -> MachineClaim {
    claim(&format!(
        "[mechanism]\nkind = \"orthoglide\"\n[workspace]\ncube = \"{side}\"\n\
         [requirements]\ntransmission = {{ max = \"{psi_max}\" }}\n"
    ))
}

/// Verifies with a budget of boxes alone.
fn verified(claim: &MachineClaim, max_boxes: usize) -> Verification {
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    verify(claim, Budget { max_boxes, deadline: None }, &mut control).unwrap()
}

/// The verdict, if there is one.
fn verdict(verification: &Verification) -> Option<Verdict> {
    match &verification.answer {
        Answer::Decided { certificate, .. } => Some(certificate.verdict),
        _ => None,
    }
}

/// Numbers that are always the same.
struct Random(u64);

impl Random {
    /// From `least` to `greatest`.
    fn within(&mut self, least: i64, greatest: i64) -> i64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        least + ((self.0 >> 33) as i64) % (greatest - least + 1)
    }
}
