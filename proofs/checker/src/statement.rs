//! A claim in words: what an accepted certificate establishes.

use orthocert_kernel::certificate::{Certificate, Claim, Proof, Verdict};
use orthocert_kernel::{atlas, no_cube, postulate, statement};

/// The theorem that an accepted certificate with this claim and verdict establishes.
pub fn statement(claim: &Claim, verdict: Verdict) -> String {
    match claim {
        Claim::Machine(claim) => statement::statement(claim, verdict),
        Claim::Postulate(claim) => postulate::statement(claim),
        Claim::NoCube(claim) => no_cube::statement(claim),
        Claim::Atlas(claim) => atlas::statement(claim),
    }
}

/// What a certificate establishes once it is accepted: its claim, proved or refuted, and, where the
/// witness says so, how it fails.
pub fn established(certificate: &Certificate) -> String {
    let words = statement(&certificate.claim, certificate.verdict);
    match (&certificate.claim, &certificate.proof) {
        (Claim::Machine(claim), Proof::Witness(witness)) => {
            words + &statement::counterexample(claim, witness)
        }
        _ => words,
    }
}
