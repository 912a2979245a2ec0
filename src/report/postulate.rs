//! What a proof search for the Q1/Q2 postulate found.

use super::remains::reason;
use super::{CertificateFile, EarlierFile, Outcome, Size};
use crate::search::solver::{Answer, Verification};
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::{Every, PostulateClaim, PsiMax, Quantity};
use serde::Serialize;
use std::time::Duration;

/// The facts about one proof search.
#[derive(Clone, Debug, Serialize)]
pub struct PostulateReport {
    /// Certified, or undecided.
    pub verdict: Outcome,
    /// What it is about, in words.
    pub subject: String,
    /// The size of the proof.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub proof: Option<Size>,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided: Option<String>,
    /// Boxes tried by the search.
    pub boxes_tried: usize,
    /// Seconds from the start to the accepted verdict.
    pub seconds: f64,
    /// The certificate that was written.
    pub certificate: Option<CertificateFile>,
    /// What an undecided run left in the certificate's place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub earlier_certificate: Option<EarlierFile>,
    /// The claim, in exact numbers, as it stands in certificates.
    pub claim: Claim,
}

impl PostulateReport {
    /// The facts about a search for a proof of `claim`; `None` if it was cancelled.
    pub fn new(claim: &PostulateClaim, found: &Verification, elapsed: Duration) -> Option<Self> {
        let (verdict, proof, undecided) = match &found.answer {
            Answer::Cancelled => return None,
            Answer::Decided { certificate, accepted } => {
                let size = Size::accepted(&certificate.proof, &accepted.size);
                (Outcome::Decided(accepted.verdict), size, None)
            }
            Answer::Undecided(undecided) => (
                Outcome::Undecided,
                None,
                Some(reason(undecided.objection.as_ref(), undecided.stop, found.boxes)),
            ),
        };
        Some(PostulateReport {
            verdict,
            subject: subject(&claim.psi_max),
            proof,
            undecided,
            boxes_tried: found.boxes,
            seconds: elapsed.as_secs_f64(),
            certificate: None,
            earlier_certificate: None,
            claim: Claim::Postulate(claim.clone()),
        })
    }
}

fn subject(psi_max: &PsiMax) -> String {
    match psi_max {
        PsiMax::Every(Every::All) => "Q1/Q2 postulate for every psi_max > 1".to_owned(),
        PsiMax::Of(Quantity::Exactly(psi)) => format!("Q1/Q2 postulate for psi_max = {psi}"),
        PsiMax::Of(Quantity::Between { min, max }) => {
            format!("Q1/Q2 postulate for {min} <= psi_max <= {max}")
        }
    }
}
