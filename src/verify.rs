//! Verification of a claim: certified, refuted, or undecided.

use crate::interval::Interval;
use crate::refute;
use crate::sample::{Place, Quality, Sampler};
use crate::search::{self, Budget, Control, OpenBox, Stop};
pub(crate) use crate::solver::certificate;
use orthocert_checker::certificate::{Certificate, Proof, Tree, Verdict, Witness};
use orthocert_checker::claim::{Claim, ClaimError, MachineClaim};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::model::Model;
use orthocert_checker::{check, Accepted, Rejected};

/// Precisions of the exact check, in fractional bits, lowest first: the first that is accepted is
/// written into the certificate.
pub(crate) const PRECISIONS: [u32; 4] = [64, 96, 128, 256];
/// Fractional bits in which the claim's numbers are enclosed for the search.
pub(crate) const MODEL_PRECISION: u32 = 192;
/// Finest step of the search for worst values, `2^-FINEST` of the workspace.
pub(crate) const FINEST: i32 = 26;
/// Open boxes from whose centres a violation is looked for.
const OPEN_CENTRES: usize = 64;

/// The answer to a claim.
#[derive(Clone, Debug)]
pub enum Answer {
    /// The exact checker has accepted this certificate: the claim is proved, or refuted.
    Decided {
        /// The certificate.
        certificate: Box<Certificate>,
        /// What the checker says of it.
        accepted: Accepted,
    },
    /// Neither a proof nor a refutation was found within the budget.
    Undecided(Undecided),
    /// The verification was cancelled.
    Cancelled,
}

/// What remains of an undecided claim.
#[derive(Clone, Debug)]
pub struct Undecided {
    /// The boxes on which something is open.
    pub open: Vec<OpenBox>,
    /// Why the search ended.
    pub stop: Stop,
    /// The checker's objection, if a complete proof was found but not accepted.
    pub objection: Option<Rejected>,
}

/// The worst value found of a requirement, by sampling.
#[derive(Clone, Debug)]
pub struct Worst {
    /// Which one.
    pub quality: Quality,
    /// The place.
    pub place: Place,
    /// Relative margin to the bound (absolute for qualities without a relative meaning).
    pub margin: f64,
}

/// The result of a verification.
#[derive(Clone, Debug)]
pub struct Verification {
    /// The answer.
    pub answer: Answer,
    /// The worst values found, one a requirement.
    pub worst: Vec<Worst>,
    /// Boxes tried by the search.
    pub boxes: usize,
}

/// Decides a claim within a budget.
///
/// # Errors
/// If the claim is not well formed.
pub fn verify(
    claim: &MachineClaim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Verification, ClaimError> {
    let model = Model::new(claim, MODEL_PRECISION)?;
    let sampler =
        Sampler::new(claim, &model).ok_or_else(|| ClaimError::Precision("mechanism".into()))?;
    let mut worst = worst_values(&sampler, FINEST);
    if let Some(witness) = refutation(claim, &sampler, &worst) {
        return Ok(Verification { answer: refuted(claim, witness), worst, boxes: 0 });
    }
    let found = search::search(&model.map(&Interval::from_fixed), budget, control);
    let boxes = found.boxes;
    if found.stop == Stop::Cancelled {
        return Ok(Verification { answer: Answer::Cancelled, worst, boxes });
    }
    if found.open.is_empty() && found.stop == Stop::Exhausted {
        let answer = accepted(Claim::Machine(claim.clone()), |precision| {
            Proof::Tree(Tree { precision, nodes: found.nodes.clone() })
        });
        return Ok(Verification { answer, worst, boxes });
    }
    look_into(&sampler, &found.open, OPEN_CENTRES, &mut worst);
    let answer = match refutation(claim, &sampler, &worst) {
        Some(witness) => refuted(claim, witness),
        None => {
            Answer::Undecided(Undecided { open: found.open, stop: found.stop, objection: None })
        }
    };
    Ok(Verification { answer, worst, boxes })
}

/// The certificate of a proof, at the lowest precision at which the checker accepts it.
pub(crate) fn accepted(claim: Claim, proof: impl Fn(u32) -> Proof) -> Answer {
    let mut certificate = certificate(claim, Verdict::Certified, proof(PRECISIONS[0]));
    let mut objection = None;
    for bits in PRECISIONS {
        certificate.proof = proof(bits);
        match check(&certificate) {
            Ok(accepted) => {
                return Answer::Decided { certificate: Box::new(certificate), accepted };
            }
            Err(reason) => objection = Some(reason),
        }
    }
    Answer::Undecided(Undecided { open: Vec::new(), stop: Stop::Exhausted, objection })
}

/// The refutation by a witness, once the checker has accepted it.
pub(crate) fn refuted(claim: &MachineClaim, witness: Witness) -> Answer {
    let proof = Proof::Witness(Box::new(witness));
    let certificate = certificate(Claim::Machine(claim.clone()), Verdict::Refuted, proof);
    match check(&certificate) {
        Ok(accepted) => Answer::Decided { certificate: Box::new(certificate), accepted },
        Err(objection) => Answer::Undecided(Undecided {
            open: Vec::new(),
            stop: Stop::Exhausted,
            objection: Some(objection),
        }),
    }
}

/// The worst value of every quality, from the best start of a coarse grid, down to steps of
/// `2^-finest` of the workspace.
pub(crate) fn worst_values(sampler: &Sampler, finest: i32) -> Vec<Worst> {
    let grid: Vec<_> = sampler.grid().into_iter().map(|p| (sampler.at(&p), p)).collect();
    let qualities = sampler.qualities().into_iter();
    qualities
        .filter_map(|quality| {
            let margin = |values| sampler.margin(quality, values).unwrap_or(f64::MAX);
            let (_, start) =
                grid.iter().min_by(|(a, _), (b, _)| margin(a).total_cmp(&margin(b)))?;
            let (margin, place) = sampler.descend(quality, start, finest);
            Some(Worst { quality, place, margin })
        })
        .collect()
}

/// Improves the worst values from the centres of at most so many of the open boxes.
pub(crate) fn look_into(sampler: &Sampler, open: &[OpenBox], centres: usize, worst: &mut [Worst]) {
    let t = vec![0.5; sampler.parameters()];
    let stride = open.len().div_ceil(centres).max(1);
    for item in open.iter().step_by(stride) {
        let u = item.cell.edges.map(|e| (e.index as f64 + 0.5) * (-f64::from(e.level)).exp2());
        let start = Place { u, t: t.clone() };
        for known in worst.iter_mut() {
            let (margin, place) = sampler.descend(known.quality, &start, FINEST);
            if margin < known.margin {
                (known.margin, known.place) = (margin, place);
            }
        }
    }
}

/// A witness for the requirement that fails most, if any fails.
pub(crate) fn refutation(
    claim: &MachineClaim,
    sampler: &Sampler,
    worst: &[Worst],
) -> Option<Witness> {
    let mut by_margin: Vec<&Worst> = worst.iter().collect();
    by_margin.sort_by(|a, b| a.margin.total_cmp(&b.margin));
    let direct = by_margin
        .iter()
        .find_map(|found| refute::witness_at(claim, sampler, found.quality, &found.place));
    direct.or_else(|| {
        let grid = sampler.grid();
        let least = by_margin.iter().find(|w| w.quality == Quality::Determinant)?;
        let start = &least.place;
        let same_machine = |place: &Place| Place { u: place.u, t: start.t.clone() };
        grid.iter().find_map(|other| {
            grid.iter().chain([start]).find_map(|one| {
                refute::singular_between(claim, sampler, &same_machine(one), &same_machine(other))
            })
        })
    })
}
