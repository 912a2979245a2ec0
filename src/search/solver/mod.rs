//! Decides claims of the kernel: any mechanism, any quantity of its table.
//!
//! | module     | does                                                                        |
//! |------------|-----------------------------------------------------------------------------|
//! | `doubles`  | what proposals are computed in                                              |
//! | `evidence` | a problem in doubles, over a box                                            |
//! | `propose`  | evidence with which the kernel's tests hold on a box                        |
//! | `apart`    | directions in which tolerances matter most                                  |
//! | `parts`    | tolerances in parts, where they are too wide for boxes of any size          |
//! | `fan`      | the directions apart, where several are worst at once                       |
//! | `together` | what tolerances change of a row together                                    |
//! | `inequalities` | linear matrix inequalities                                             |
//! | `weighted` | a condition number of machines of which each has a `mu` of its own          |
//! | `balance`  | what stands between the bounds of a condition number                         |
//! | `less`     | how much of the workspace's own inequalities it takes                       |
//! | `rows`, `directions`, `chords` | matrices, directions and the one `Y` to begin with      |
//! | `search`   | branch and bound: a tree on whose leaves every obligation is discharged     |
//! | `ahead`    | one of fewer leaves                                                         |
//! | `trees`    | trees by several means, the cheapest first                                  |
//! | [`sample`] | approximate values at single points and machines                            |
//! | `needed`, `program` | the formulas that each of them takes, one after the other        |
//! | `descent`, `adverse` | the worst of them                                                 |
//! | `fails`    | how a claim fails at every point of a box                                   |
//! | `same`     | two points with the same joint coordinates                                  |
//! | `refute`   | a place where an obligation seems to fail as an exact witness               |
//! | `violation` | how far from holding a test is at a place, and along which direction       |
//! | [`value`]  | a quantity at a place, in the claim's own unit                              |
//! | [`extremes`] | how small and how large each quantity gets                                |
//! | [`mod@enclose`] | encloses that                                                          |
//! | [`sector`] | encloses the angles that a joint takes                                      |
//! | [`margin`](mod@margin) | by how much a claim's bounds could be tightened                 |
//!
//! Nothing in it is trusted: [`orthocert_checker::check`] decides.

mod accuracy;
mod adverse;
mod ahead;
mod apart;
mod balance;
mod chords;
mod descent;
mod directions;
pub(crate) mod doubles;
pub mod enclose;
pub(crate) mod evidence;
pub mod extremes;
pub(crate) mod fails;
mod fan;
mod inequalities;
mod less;
pub mod margin;
mod needed;
mod parts;
pub(crate) mod program;
mod propose;
pub(crate) mod refute;
mod rows;
mod same;
pub mod sample;
pub mod search;
pub mod sector;
mod together;
mod trees;
pub mod value;
pub(crate) mod violation;
mod weighted;

use crate::exact::arithmetic::number;
use crate::search::accepted::{check, Accepted};
use crate::search::{Budget, Control, Stop};
use evidence::Prover;
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_checker::certificate::{Certificate, Proof, Provenance, Verdict, FORMAT};
use orthocert_checker::Rejected;
use orthocert_kernel::certificate::{Claim, Node, Tree, Witness};
use orthocert_kernel::claim::{Bound, MachineClaim};
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use rayon::prelude::*;
use sample::{Sampler, Worst};
use search::{search, search_below, Branch, Ends, Open, Outcome};
use std::sync::atomic::AtomicBool;
use std::time::Instant;
use trees::{in_ranges, with_derivatives, Ways, FEW_APART, MOST_APART};

pub use refute::approximate;

/// Finest step of the search for worst values, `2^-FINEST` of the workspace.
pub const FINEST: i32 = 26;
/// Precisions of the exact check, in fractional bits: up to 60 it runs in machine words, if numbers are
/// small enough.
pub(crate) const PRECISIONS: [u32; 4] = [52, 80, 128, 256];
/// Bits of a machine word's integer part, sign and what a test adds to its formulas' size.
const GUARD: u32 = 9;
/// The same where tolerances are apart: what little some change is divided by.
const GUARD_APART: u32 = 22;
/// The greatest bound that is searched with.
const GREATEST_BOUND: f64 = 1e60;
/// Open boxes from whose centres a violation is looked for.
const OPEN_CENTRES: usize = 64;

/// The answer to a claim.
#[derive(Clone, Debug)]
pub enum Answer {
    /// The exact checker has accepted this certificate.
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

/// A certificate that the exact checker has accepted, and what the checker says of it.
pub(crate) type Confirmed = (Box<Certificate>, Accepted);

impl From<Result<Confirmed, Option<Rejected>>> for Answer {
    fn from(found: Result<Confirmed, Option<Rejected>>) -> Self {
        match found {
            Ok((certificate, accepted)) => Answer::Decided { certificate, accepted },
            Err(objection) => {
                Answer::Undecided(Undecided { open: Vec::new(), stop: Stop::Exhausted, objection })
            }
        }
    }
}

/// What remains of an undecided claim.
#[derive(Clone, Debug)]
pub struct Undecided {
    /// The boxes on which something is open.
    pub open: Vec<Open>,
    /// Why the search ended.
    pub stop: Stop,
    /// The checker's objection, if a complete proof was found but not accepted.
    pub objection: Option<Rejected>,
}

/// The result of a verification.
#[derive(Clone, Debug)]
pub struct Verification {
    /// The answer.
    pub answer: Answer,
    /// The worst values found, by sampling.
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
    let problem = Problem::new(claim)?;
    let sampler = Sampler::new(claim, &problem)?;
    let mut worst = sampler.worst_values(FINEST);
    if let Some(witness) = on_the_spot(claim, &problem, &sampler, &worst) {
        return Ok(Verification { answer: refuted(claim, witness).into(), worst, boxes: 0 });
    }
    let [ranges, rest, checks] = parts_of(&problem);
    let tighter = tighter(claim).map(|claim| Problem::new(&claim)).transpose()?;
    let own = tighter.as_ref().unwrap_or(&problem);
    let in_ranges = control.part(ranges, |control| in_ranges(own, budget, control));
    let (searched, found) = match in_ranges {
        Ok(found) => (own, Some(found)),
        Err(ref derived) => (&**derived, None),
    };
    let prover = Prover::new(searched)?;
    let points: Vec<Vec<f64>> = worst.iter().map(|found| sampler.point(&found.place.u)).collect();
    let ways = Ways::new(&prover, (&points, MOST_APART), budget);
    let search = |control: &mut Control<'_>| {
        // Of platforms that turn it takes millions of boxes to come where they are hopeless. Half of the time is for those.
        let is_turned = searched.derived.is_some() && !searched.orientation.is_empty();
        if is_turned && !ways.holds(false, control) {
            let half = Ways::new(&prover, (&points, MOST_APART), budget.shared(2));
            let found = control.part([0.0, 0.5], |control| half.apart_or_in_parts(control));
            return found
                .unwrap_or_else(|| control.part([0.5, 1.0], |control| ways.boxes(false, control)));
        }
        let found = ways.tree(searched.derived.is_some(), control);
        // What is open is looked for where nothing is given up.
        match found.stop {
            Stop::Hopeless => ways.boxes(false, control),
            _ => found,
        }
    };
    let found = found.unwrap_or_else(|| control.part(rest, search));
    let boxes = found.boxes;
    if found.stop == Stop::Cancelled {
        return Ok(Verification { answer: Answer::Cancelled, worst, boxes });
    }
    if found.is_proof() {
        let (nodes, more) = fewer(&prover, found.nodes, budget.deadline, control.cancel);
        let answer = control.part(checks, |_| accepted(claim, &prover, nodes)).into();
        return Ok(Verification { answer, worst, boxes: boxes + more });
    }
    look_into(&sampler, &found.open, OPEN_CENTRES, &mut worst);
    let answer = match refute::refutation(claim, &problem, &sampler, &worst) {
        Some(witness) => refuted(claim, witness).into(),
        None => {
            Answer::Undecided(Undecided { open: found.open, stop: found.stop, objection: None })
        }
    };
    Ok(Verification { answer, worst, boxes })
}

/// A claim with bounds whose squares are doubles, in place of bounds so far off that theirs are not: what shows the
/// one mostly shows the other.
fn tighter(claim: &MachineClaim) -> Option<MachineClaim> {
    let (mut tighter, mut found) = (claim.clone(), false);
    for own in &mut tighter.require {
        let ends = match &mut own.bound {
            Bound::Min(x) | Bound::Max(x) => std::slice::from_mut(x),
            Bound::Within(ends) => &mut ends[..],
            Bound::Holds => &mut [],
        };
        for x in ends {
            let far = approximate(x).filter(|x| x.abs() > GREATEST_BOUND);
            let Some(far) = far else { continue };
            *x = number(&BigRational::from_f64(GREATEST_BOUND.copysign(far))?);
            found = true;
        }
    }
    found.then_some(tighter)
}

/// Shares of the work: the search in ranges, which only tolerances have, the search, and the exact check.
fn parts_of(problem: &Problem) -> [[f64; 2]; 3] {
    let ranges = if problem.tolerances().next().is_some() { 0.3 } else { 0.0 };
    [[0.0, ranges], [ranges, 0.8], [0.8, 1.0]]
}

/// A witness against a claim that sampling alone finds.
fn on_the_spot(
    claim: &MachineClaim,
    problem: &Problem,
    sampler: &Sampler<'_>,
    worst: &[Worst],
) -> Option<Witness> {
    refute::refutation(claim, problem, sampler, worst)
        .or_else(|| same::refutation(claim, problem, sampler))
}

/// The top of a claim's tree, to be grown in parts: as [`verify`] begins, but for at most so many boxes
/// in a level. `None` if the claim is refuted on the spot.
///
/// # Errors
/// If the claim is not well formed.
pub fn top(
    claim: &MachineClaim,
    enough: usize,
    control: &mut Control<'_>,
) -> Result<Option<Outcome>, ClaimError> {
    let problem = in_parts(claim, control)?;
    let sampler = Sampler::new(claim, &problem)?;
    let worst = sampler.worst_values(FINEST);
    if on_the_spot(claim, &problem, &sampler, &worst).is_some() {
        return Ok(None);
    }
    let prover = Prover::new(&problem)?;
    let ends = Ends { enough: Some(enough), ..Ends::default() };
    let budget = Budget { max_boxes: usize::MAX, deadline: None };
    Ok(Some(search(&prover, ends, budget, control)))
}

/// The tree below a branch; none below one that no tree of the claim has.
///
/// # Errors
/// If the claim is not well formed.
pub fn below(
    claim: &MachineClaim,
    branch: &Branch,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Option<Outcome>, ClaimError> {
    let problem = in_parts(claim, control)?;
    Ok(search_below(&Prover::new(&problem)?, branch, Ends::default(), budget, control))
}

/// What a tree that was grown in parts, and on which nothing is open, amounts to.
///
/// # Errors
/// If the claim is not well formed.
pub fn concluded(
    claim: &MachineClaim,
    nodes: Vec<Node>,
    boxes: usize,
) -> Result<Verification, ClaimError> {
    let problem = Problem::new(claim)?;
    let worst = Sampler::new(claim, &problem)?.worst_values(FINEST);
    let prover = Prover::new(&problem)?;
    let (nodes, more) = fewer(&prover, nodes, None, &AtomicBool::new(false));
    let answer = accepted(claim, &prover, nodes).into();
    Ok(Verification { answer, worst, boxes: boxes + more })
}

/// The certificate of a claim that the search proves within the budget; why there is none, if not.
///
/// # Errors
/// Why the search ended.
pub fn proof(
    claim: &MachineClaim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Box<Certificate>, Stop> {
    proof_about(claim, None, budget, control)
}

/// The same, where it is known at which point the claim is nearest to failing: tolerances that are too wide there already
/// are seen before boxes about it are.
///
/// # Errors
/// Why the search ended.
pub fn proof_about(
    claim: &MachineClaim,
    point: Option<&[Expression]>,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Box<Certificate>, Stop> {
    let problem = Problem::new(claim).map_err(|_| Stop::Hopeless)?;
    let sampler = Sampler::new(claim, &problem).map_err(|_| Stop::Hopeless)?;
    let place = point.and_then(|point| sampler.place_of(point, &[]));
    let point = place.map(|place| sampler.point(&place.u));
    let holds = |problem: &Problem| {
        let holds = |point: &Vec<f64>| Some(Prover::new(problem).ok()?.holds_next_to(point, false));
        point.as_ref().is_none_or(|point| holds(point) == Some(true))
    };
    let [ranges, rest, checks] = parts_of(&problem);
    let in_ranges = match holds(&problem) {
        true => control.part(ranges, |control| in_ranges(&problem, budget, control)),
        false => Err(Box::new(with_derivatives(problem.clone()))),
    };
    let (problem, found) = match in_ranges {
        Ok(found) => (problem, Some(found)),
        Err(derived) => (*derived, None),
    };
    let prover = Prover::new(&problem).map_err(|_| Stop::Hopeless)?;
    let most_apart = if point.is_some() { MOST_APART } else { FEW_APART };
    let ways = Ways::new(&prover, (point.as_slice(), most_apart), budget);
    let search = |control: &mut Control<'_>| match holds(prover.problem) {
        true => Some(ways.tree(true, control)),
        false => ways.apart_or_in_parts(control),
    };
    let found = found.or_else(|| control.part(rest, search)).ok_or(Stop::Hopeless);
    let nodes = found.and_then(Outcome::proof).map_err(|stop| match stop {
        // What there was no time to see is not hopeless.
        Stop::Hopeless if control.is_cancelled() => Stop::Cancelled,
        Stop::Hopeless if budget.is_over() => Stop::Time,
        stop => stop,
    })?;
    let found = control.part(checks, |_| accepted(claim, &prover, nodes));
    found.map(|(certificate, _)| certificate).map_err(|_| Stop::Exhausted)
}

/// The problem of a claim whose tree is grown in parts, the same for all of them.
fn in_parts(claim: &MachineClaim, control: &mut Control<'_>) -> Result<Problem, ClaimError> {
    let problem = Problem::new(claim)?;
    let budget = Budget { max_boxes: usize::MAX, deadline: None };
    Ok(match in_ranges(&problem, budget, control) {
        Ok(_) => problem,
        Err(derived) => *derived,
    })
}

/// A tree of fewer nodes, of a machine without tolerances; and how many boxes were tried for it. With tolerances each
/// box takes far longer.
fn fewer(
    prover: &Prover<'_>,
    nodes: Vec<Node>,
    deadline: Option<Instant>,
    cancel: &AtomicBool,
) -> (Vec<Node>, usize) {
    match prover.problem.tolerances().next() {
        None => ahead::fewer(prover, nodes, deadline, cancel),
        Some(_) => (nodes, 0),
    }
}

/// A certificate that a claim does not hold, if sampling finds a witness; none of a claim that is not
/// well formed.
pub fn refutation(claim: &MachineClaim) -> Option<Box<Certificate>> {
    refutation_and_worst(claim)?.0
}

/// The same, and the worst place found of every quality.
pub(crate) fn refutation_and_worst(claim: &MachineClaim) -> Option<Refutation> {
    refutation_at(claim, |sampler| match sampler.frees() {
        0 => sampler.worst_values(FINEST),
        _ => sampler.worst_machines(FINEST),
    })
}

/// A certificate in far less time, from where the claim was worst of machines that differ from each other more or less,
/// and near there alone.
pub(crate) fn refutation_from(claim: &MachineClaim, worst: &[Worst]) -> Option<Box<Certificate>> {
    refutation_at(claim, |sampler| sampler.worst_machines_from(worst, FINEST))?.0
}

type Refutation = (Option<Box<Certificate>>, Vec<Worst>);

fn refutation_at(
    claim: &MachineClaim,
    sample: impl FnOnce(&Sampler<'_>) -> Vec<Worst>,
) -> Option<Refutation> {
    let problem = Problem::new(claim).ok()?;
    let sampler = Sampler::new(claim, &problem).ok()?;
    let worst = sample(&sampler);
    let witness = refute::refutation(claim, &problem, &sampler, &worst);
    let found = witness.and_then(|witness| refuted(claim, witness).ok());
    Some((found.map(|(certificate, _)| certificate), worst))
}

/// The worst values of a claim's obligations that sampling finds.
///
/// # Errors
/// If the claim is not well formed.
pub fn sampled(claim: &MachineClaim) -> Result<Vec<Worst>, ClaimError> {
    let problem = Problem::new(claim)?;
    Ok(Sampler::new(claim, &problem)?.worst_values(FINEST))
}

/// The precisions at which a proof is tried.
fn precisions(prover: &Prover<'_>, tree: &Tree) -> impl Iterator<Item = u32> {
    let size = prover.greatest().log2().ceil().clamp(0.0, 64.0) as u32;
    let guard = if tree.takes_tolerances_apart() { GUARD_APART } else { GUARD };
    let words = 63u32.saturating_sub(guard + size);
    let first = (32..PRECISIONS[0]).contains(&words).then_some(words);
    first.into_iter().chain(PRECISIONS)
}

/// A tree on whose leaves every obligation of a problem is discharged, if one is found that `accepts`;
/// why not, if not. No search is worth it unless tests hold next to each of these points.
pub(crate) fn tree(
    problem: &Problem,
    points: &[Vec<f64>],
    budget: Budget,
    control: &mut Control<'_>,
    accepts: impl Fn(&Tree) -> bool,
) -> Result<Tree, Stop> {
    let problem = &with_derivatives(problem.clone());
    let prover = Prover::new(problem).map_err(|_| Stop::Hopeless)?;
    if !points.iter().all(|point| prover.holds_next_to(point, problem.derived.is_some())) {
        return Err(Stop::Hopeless);
    }
    let ways = Ways::new(&prover, (&[], FEW_APART), budget);
    let nodes = ways.tree(true, control).proof()?;
    let mut tree = Tree { precision: 0, chords: prover.chords.clone(), nodes };
    for bits in precisions(&prover, &tree) {
        tree.precision = bits;
        if accepts(&tree) {
            return Ok(tree);
        }
    }
    Err(Stop::Exhausted)
}

/// The certificate of a proof.
fn accepted(
    claim: &MachineClaim,
    prover: &Prover<'_>,
    nodes: Vec<Node>,
) -> Result<Confirmed, Option<Rejected>> {
    let tree = Tree { precision: PRECISIONS[0], chords: prover.chords.clone(), nodes };
    let precisions = precisions(prover, &tree);
    confirmed(Claim::Machine(claim.clone()), tree, precisions)
}

/// The certificate of a tree, at the first of the precisions at which the checker accepts it; else its last objection.
pub(crate) fn confirmed(
    claim: Claim,
    tree: Tree,
    precisions: impl IntoIterator<Item = u32>,
) -> Result<Confirmed, Option<Rejected>> {
    let mut objection = None;
    let proof = Proof::Tree(tree);
    let mut whole = certificate(claim, Verdict::Certified, proof);
    for bits in precisions {
        if let Proof::Tree(tree) = &mut whole.proof {
            tree.precision = bits;
        }
        match check(&whole) {
            Ok(accepted) => return Ok((Box::new(whole), accepted)),
            Err(reason) => objection = Some(reason),
        }
    }
    Err(objection)
}

/// A certificate by this program.
pub(crate) fn certificate(claim: Claim, verdict: Verdict, proof: Proof) -> Certificate {
    Certificate {
        format: FORMAT.to_owned(),
        claim,
        verdict,
        proof,
        provenance: Provenance {
            tool: env!("CARGO_PKG_NAME").to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        },
    }
}

/// The refutation by a witness, once the checker has accepted it.
pub(crate) fn refuted(
    claim: &MachineClaim,
    witness: Witness,
) -> Result<Confirmed, Option<Rejected>> {
    let proof = Proof::Witness(witness);
    let certificate = certificate(Claim::Machine(claim.clone()), Verdict::Refuted, proof);
    match check(&certificate) {
        Ok(accepted) => Ok((Box::new(certificate), accepted)),
        Err(objection) => Err(Some(objection)),
    }
}

/// Improves the worst values from the centres of at most so many of the open boxes.
fn look_into(sampler: &Sampler<'_>, open: &[Open], centres: usize, worst: &mut [Worst]) {
    let stride = open.len().div_ceil(centres).max(1);
    let items: Vec<&Open> = open.iter().step_by(stride).collect();
    let below = |item: &&Open| -> Vec<Worst> {
        let start = sampler.place_in(&item.cell);
        worst.iter().map(|known| sampler.descend(known.quality, &start, FINEST)).collect()
    };
    let all: Vec<Vec<Worst>> = items.par_iter().map(below).collect();
    for found in all {
        for (known, found) in worst.iter_mut().zip(found) {
            if found.margin < known.margin {
                *known = found;
            }
        }
    }
}

#[cfg(test)]
mod tests;
