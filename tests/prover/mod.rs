//! Mathematical tests of the prover: enclosures in doubles, the search, and verdicts against what
//! is known in closed form. Random choices have fixed seeds.
//!
//! | module      | tests                                                                      |
//! |-------------|----------------------------------------------------------------------------|
//! | `atlas`     | maps against the closed form, and against single designs                   |
//! | `intervals` | enclosures in doubles against the oracle and exact values                  |
//! | `search`    | determinism, completeness of the tree, budgets                             |
//! | `verdicts`  | stated verdicts of designs, sweeps over `psi_max`                          |
//! | `diagonal`  | cubes on the diagonal, decided in closed form, either side of the truth    |
//! | `mutation`  | altered certificates are rejected, or still true                           |

mod atlas;
mod diagonal;
mod intervals;
mod mutation;
mod search;
mod verdicts;

#[allow(dead_code, reason = "shared with the checker's tests, which use all of it")]
#[path = "../../proofs/checker/tests/mathematics/machines.rs"]
mod machines;
#[allow(dead_code, reason = "shared with the checker's tests, which use all of it")]
#[path = "../../proofs/checker/tests/mathematics/random.rs"]
mod random;

use orthocert::search::{Budget, Control};
use orthocert::verify::{verify, Answer, Verification};
use orthocert_checker::certificate::Verdict;
use orthocert_checker::claim::MachineClaim;
use std::sync::atomic::AtomicBool;

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
