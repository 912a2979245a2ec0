//! What a decision about a machine amounts to.

use crate::report::Report;
use crate::search::accepted::{check, Accepted};
use crate::search::solver::{self, Answer, Undecided, Verification};
use crate::search::Stop;
use orthocert_checker::certificate::Certificate;
use orthocert_checker::{read, Rejected};
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::document::Unreadable;
use orthocert_kernel::input::ClaimError;
use std::time::Duration;

/// What an accepted certificate of a claim amounts to; with the worst values that sampling finds, where
/// they are asked for.
///
/// # Errors
/// If the claim is not well formed.
pub fn recalled(
    claim: &MachineClaim,
    certificate: Certificate,
    accepted: Accepted,
    sampled: bool,
) -> Result<Verification, ClaimError> {
    let worst = if sampled { solver::sampled(claim)? } else { Vec::new() };
    let answer = Answer::Decided { certificate: Box::new(certificate), accepted };
    Ok(Verification { answer, worst, boxes: 0 })
}

/// The text of a certificate, which reads back as the certificate.
///
/// # Errors
/// If it does not.
pub fn as_written(certificate: &Certificate) -> Result<String, Rejected> {
    let malformed = |why: String| Rejected::Unreadable(Unreadable::Malformed(why));
    let text = certificate.to_text().map_err(|error| malformed(error.to_string()))?;
    if read(text.as_bytes())? == *certificate {
        Ok(text)
    } else {
        Err(malformed("it does not read back as it was written".to_owned()))
    }
}

/// What another claim's proof amounts to for a claim, if the checker accepts it for that one: of claims
/// that differ little in a number, one proof often serves both.
pub fn by_proof_of(claim: &MachineClaim, other: &Certificate) -> Option<Verification> {
    let claim = Claim::Machine(claim.clone());
    let certificate = Box::new(Certificate { claim, ..other.clone() });
    let accepted = check(&certificate).ok()?;
    let answer = Answer::Decided { certificate, accepted };
    Some(Verification { answer, worst: Vec::new(), boxes: 0 })
}

impl Verification {
    /// The accepted certificate.
    pub fn decided(&self) -> Option<(&Certificate, &Accepted)> {
        match &self.answer {
            Answer::Decided { certificate, accepted } => Some((certificate, accepted)),
            Answer::Undecided(_) | Answer::Cancelled => None,
        }
    }

    /// Whether it was cancelled.
    pub fn is_cancelled(&self) -> bool {
        matches!(self.answer, Answer::Cancelled)
    }

    /// Makes it undecided, for this reason.
    pub fn object(&mut self, objection: Rejected) {
        let (stop, objection) = (Stop::Exhausted, Some(objection));
        self.answer = Answer::Undecided(Undecided { open: Vec::new(), stop, objection });
    }

    /// The facts about it; `None` if it was cancelled, or if the claim's numbers exceed what can be
    /// shown.
    pub fn report(&self, claim: &MachineClaim, elapsed: Duration) -> Option<Report> {
        Report::new(claim, self, elapsed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use crate::search::{Budget, Control};
    use orthocert_checker::certificate::Verdict;
    use std::sync::atomic::AtomicBool;

    const DELTA: &str = include_str!("../../tests/designs/linear-delta-linuxcnc-cylinder.toml");

    fn claim(text: &str) -> MachineClaim {
        Design::parse(text, "design").unwrap().claim
    }

    #[test]
    fn a_proof_serves_the_claims_for_which_the_checker_accepts_it() {
        let own = claim(DELTA);
        let cancel = AtomicBool::new(false);
        let control = &mut Control { cancel: &cancel, progress: &mut |_| {} };
        let budget = Budget { max_boxes: 1000, deadline: None };
        let certificate = solver::proof(&own, budget, control).unwrap();
        let of = |text: &str| {
            let found = by_proof_of(&claim(text), &certificate)?;
            let (certificate, accepted) = found.decided()?;
            assert_eq!(certificate.claim, Claim::Machine(claim(text)));
            Some(accepted.verdict)
        };
        let moved = |to: &str| {
            let moved = DELTA.replacen("radius = 70", &format!("radius = {to}"), 1);
            assert_ne!(moved, DELTA);
            moved
        };
        assert_eq!(of(DELTA), Some(Verdict::Certified));
        assert_eq!(of(&moved("69.99")), Some(Verdict::Certified));
        assert_eq!(of(&moved("200")), None);
    }
}
