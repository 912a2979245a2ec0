//! What a verification found, for people ([`text`]) and for scripts (as JSON, by `serde`): the
//! same facts.

pub mod atlas;
mod counterexample;
pub mod escape;
pub mod export;
mod facts;
pub mod formulas;
mod hint;
mod machine;
pub mod map;
pub mod page;
pub mod paving;
mod place;
mod postulate;
mod remains;
pub mod requirement;
mod share;
pub mod text;
mod worst;
mod wrap;

pub use counterexample::{Counterexample, Near, Setting};
pub use facts::{parameter, shown, Facts};
pub use machine::{machine_at_ends, machine_of_witness};
pub use place::{placed, point_text, pose_text, FreeParameter};
pub use postulate::PostulateReport;
pub use remains::{OpenRegion, OpenRequirement, Remains, WorstBox};
pub use worst::Row;
pub use wrap::wrapped;

use crate::exact::Exact;
use crate::search::accepted::TreeSize;
use crate::search::solver;
use crate::search::solver::value::Coordinates;
use num_rational::BigRational;
use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::time::Duration;

/// What is known of a claim after a verification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The exact checker has accepted a certificate that says so.
    Decided(Verdict),
    /// Neither was shown.
    Undecided,
}

impl Serialize for Outcome {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Outcome::Decided(verdict) => verdict.serialize(serializer),
            Outcome::Undecided => serializer.serialize_str("undecided"),
        }
    }
}

/// The facts about one verification.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Certified, refuted or undecided.
    pub verdict: Outcome,
    /// The design's title.
    pub title: Option<String>,
    /// The design file, as it was named; `None` for the built-in prototype.
    pub design: Option<String>,
    /// The unit of all lengths, as the design names it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_unit: Option<&'static str>,
    /// The names of the workspace's coordinates, in the order of places.
    pub coordinates: Coordinates,
    /// The requirements, with the worst values found by sampling.
    pub requirements: Vec<Row>,
    /// How far the quantities that requirements bound really go: bounds with certificates of their
    /// own, which are not kept. Empty where that was not cheap.
    pub margins: Vec<Margin>,
    /// The counterexample of a refutation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub counterexample: Option<Counterexample>,
    /// What may have gone wrong in the design of a refuted claim.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hint: Option<String>,
    /// What the design has and its claim has not.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// The size of a proof.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub proof: Option<Size>,
    /// What an undecided claim leaves open.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided: Option<Remains>,
    /// Boxes tried by the search.
    pub boxes_tried: usize,
    /// Seconds from the start to the accepted verdict.
    pub seconds: f64,
    /// Whether nothing was searched for: the certificate was there, and was re-checked exactly.
    pub cached: bool,
    /// The certificate that was written, or re-checked.
    pub certificate: Option<CertificateFile>,
    /// What an undecided run left in the certificate's place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub earlier_certificate: Option<EarlierFile>,
    /// The claim, in exact numbers, as it stands in certificates.
    pub claim: Claim,
}

/// A quantity never goes beyond this, as certified.
#[derive(Clone, Debug, Serialize)]
pub struct Margin {
    /// The quantity.
    pub quantity: String,
    /// Its name in texts.
    #[serde(skip)]
    pub name: String,
    /// Its unit, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
    /// `<=` or `>=`.
    pub relation: &'static str,
    /// The certified bound.
    pub bound: Exact,
}

impl Margin {
    /// The certified end of an enclosure.
    pub fn of(extreme: &solver::extremes::Extreme, bound: BigRational, angular: bool) -> Self {
        let relation = if extreme.is_greatest() { "<=" } else { ">=" };
        Margin {
            quantity: extreme.symbol(),
            name: extreme.name(),
            unit: extreme.unit(angular),
            relation,
            bound: Exact::Rational(bound),
        }
    }
}

/// The size and shape of a proof.
#[derive(Clone, Debug, Serialize)]
pub struct Size {
    /// Boxes that cover the workspace.
    pub leaves: usize,
    /// Boxes, split or not.
    pub nodes: usize,
    /// Most splits on one path.
    pub depth: usize,
    /// Fractional bits of the exact check.
    pub precision: u32,
    /// Uses of each rule.
    pub rules: BTreeMap<String, usize>,
}

impl Size {
    /// The size of a proof that the checker has accepted; `None` for a counterexample.
    pub fn accepted(proof: &Proof, size: &TreeSize) -> Option<Self> {
        let Proof::Tree(tree) = proof else {
            return None;
        };
        let precision = tree.precision;
        let rules = size.steps.iter().map(|(rule, uses)| ((*rule).to_owned(), *uses)).collect();
        let TreeSize { leaves, nodes, depth, .. } = *size;
        Some(Size { leaves, nodes, depth, precision, rules })
    }
}

/// What a certificate's witness says against its claim; `None` of another certificate, and if its
/// numbers exceed what can be shown.
pub fn counterexample(certificate: &Certificate) -> Option<Counterexample> {
    let (Claim::Machine(claim), Proof::Witness(witness)) = (&certificate.claim, &certificate.proof)
    else {
        return None;
    };
    let problem = Problem::new(claim).ok()?;
    Facts::new(claim, &problem)?.counterexample(witness)
}

/// A certificate on the disk.
#[derive(Clone, Debug, Serialize)]
pub struct CertificateFile {
    /// Its path.
    pub path: String,
    /// Its size.
    pub bytes: usize,
    /// The SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

/// A file that an earlier run left where this run's certificate would be.
#[derive(Clone, Debug, Serialize)]
pub struct EarlierFile {
    /// Its path.
    pub path: String,
    /// Whether it is a certificate of the very claim of this run.
    pub same_claim: bool,
}

impl Report {
    /// Nothing is known yet.
    fn about(claim: Claim, coordinates: Coordinates, boxes: usize, elapsed: Duration) -> Self {
        Report {
            verdict: Outcome::Undecided,
            title: None,
            design: None,
            length_unit: None,
            coordinates,
            requirements: Vec::new(),
            margins: Vec::new(),
            counterexample: None,
            hint: None,
            notes: Vec::new(),
            proof: None,
            undecided: None,
            boxes_tried: boxes,
            seconds: elapsed.as_secs_f64(),
            cached: false,
            certificate: None,
            earlier_certificate: None,
            claim,
        }
    }

    /// The facts about a verification of `claim`; `None` if it was cancelled, or if the claim's
    /// numbers exceed what can be shown.
    pub fn new(
        claim: &MachineClaim,
        found: &solver::Verification,
        elapsed: Duration,
    ) -> Option<Self> {
        let coordinates = solver::value::coordinates(claim);
        let mut report =
            Report::about(Claim::Machine(claim.clone()), coordinates, found.boxes, elapsed);
        let problem = Problem::new(claim).ok()?;
        let facts = Facts::new(claim, &problem)?;
        match &found.answer {
            solver::Answer::Cancelled => return None,
            solver::Answer::Decided { certificate, accepted } => {
                report.verdict = Outcome::Decided(accepted.verdict);
                report.proof = Size::accepted(&certificate.proof, &accepted.size);
                if let Proof::Witness(witness) = &certificate.proof {
                    report.counterexample = facts.counterexample(witness);
                    let found = report.counterexample.as_ref();
                    report.hint = found.and_then(|found| hint::hint(claim, found));
                }
            }
            solver::Answer::Undecided(undecided) => {
                report.undecided = Some(facts.remains(undecided, &found.worst, found.boxes));
            }
        }
        report.requirements = facts.rows(&found.worst);
        Some(report)
    }
}
