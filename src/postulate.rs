//! Proofs of the Q1/Q2 postulate for one `psi_max`, a range of them, or every one.
//!
//! For a single `psi_max` one tree over the cube is searched; for more, a tree over `kappa` and two
//! coordinates for each face and half. The rules are those of [`orthocert_checker::postulate`].

use crate::interval::Interval;
use crate::search::{self, by_weight, Budget, Control, Outcome, Problem, Stop, Trial};
use crate::verify::{accepted, Answer, Undecided};
use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::{FacePart, Faces, Proof, Step, Tree};
use orthocert_checker::claim::{Claim, ClaimError, PostulateClaim, PsiMax};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::postulate::{self, BlowUp, Face, Half};
use orthocert_checker::rule::{Failure, Obligation, TightCorner};
use orthocert_checker::{parts_needed, single_kappa, PartNeeded};

/// Fractional bits in which `kappa` is enclosed for the search.
const PRECISION: u32 = 192;
/// The corners at which a bound may be met with equality.
const CORNERS: [TightCorner; 2] = [TightCorner::Q1, TightCorner::Q2];

/// The result of a proof search for the postulate.
#[derive(Clone, Debug)]
pub struct Proved {
    /// The answer.
    pub answer: Answer,
    /// Boxes tried.
    pub boxes: usize,
}

/// Proves the postulate for the claim's `psi_max`.
///
/// # Errors
/// If the claim is not well formed.
pub fn prove(
    claim: &PostulateClaim,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Proved, ClaimError> {
    claim.validate()?;
    let unenclosed = || ClaimError::Precision("psi_max".into());
    let is_single = matches!(&claim.psi_max, PsiMax::Range(range) if range.is_exact());
    let mut found = Vec::new();
    if is_single {
        let (kappa, half) = single_kappa(claim, PRECISION).ok_or_else(unenclosed)?;
        let problem = OneCube { kappa: Interval::from_fixed(&kappa), half };
        found.push((None, search::search(&problem, budget, control)));
    } else {
        let mut left = budget;
        for part in parts_needed(claim).ok_or_else(unenclosed)? {
            let (least, width) = part.range(PRECISION).ok_or_else(unenclosed)?;
            let problem = FaceProblem {
                least: Interval::from_fixed(&least),
                width: Interval::from_fixed(&width),
                half: part.half,
                face: part.face,
            };
            let outcome = search::search(&problem, left, control);
            left.max_boxes -= outcome.boxes;
            found.push((Some(part), outcome));
        }
    }
    let boxes = found.iter().map(|(_, outcome)| outcome.boxes).sum();
    Ok(Proved { answer: answer(claim, found), boxes })
}

fn answer(claim: &PostulateClaim, found: Vec<(Option<PartNeeded>, Outcome)>) -> Answer {
    let unfinished = |o: &Outcome| o.stop != Stop::Exhausted || !o.open.is_empty();
    if let Some(stop) = found.iter().find(|(_, o)| unfinished(o)).map(|(_, o)| o.stop) {
        if stop == Stop::Cancelled {
            return Answer::Cancelled;
        }
        let open = found.into_iter().flat_map(|(_, outcome)| outcome.open).collect();
        return Answer::Undecided(Undecided { open, stop, objection: None });
    }
    let claim = Claim::Postulate(claim.clone());
    accepted(claim, |precision| {
        let mut parts = Vec::new();
        for (part, outcome) in &found {
            let nodes = outcome.nodes.clone();
            match part {
                None => return Proof::Tree(Tree { precision, nodes }),
                Some(part) => parts.push(FacePart { face: part.face, half: part.half, nodes }),
            }
        }
        Proof::Faces(Faces { precision, parts })
    })
}

/// The cube for one `psi_max`; axes x, y and z.
struct OneCube {
    kappa: Interval,
    half: Half,
}

impl Problem for OneCube {
    fn obligations(&self) -> Vec<Obligation> {
        vec![Obligation::SigmaMin, Obligation::SigmaMax]
    }

    fn try_box(&self, cell: &Cell, open: &[Obligation]) -> Trial {
        let mut trial = try_blow_up(postulate::on_cube(&self.kappa, self.half, cell), Axis::ALL);
        if open.contains(&Obligation::SigmaMax) {
            trial.steps.insert(0, Step::Cube);
        }
        trial
    }
}

/// A face over a range of `kappa`; axes kappa, y and z.
struct FaceProblem {
    least: Interval,
    width: Interval,
    half: Half,
    face: Face,
}

impl Problem for FaceProblem {
    fn obligations(&self) -> Vec<Obligation> {
        vec![Obligation::SigmaMin]
    }

    fn try_box(&self, cell: &Cell, _open: &[Obligation]) -> Trial {
        let mut trial = self.rules(cell);
        if !trial.failures.is_empty() {
            // Prefer the axis whose halves close most often; the order breaks ties.
            let closing = |axis: &Axis| {
                let halves = cell.halves(*axis).map_or(Vec::new(), |(a, b)| vec![a, b]);
                halves.iter().filter(|half| self.rules(half).failures.is_empty()).count()
            };
            trial.axes.sort_by_cached_key(|axis| std::cmp::Reverse(closing(axis)));
        }
        trial
    }
}

impl FaceProblem {
    fn rules(&self, cell: &Cell) -> Trial {
        if postulate::mirror(cell).is_ok() {
            return closed(Step::Mirror, Axis::FACE);
        }
        let blow_up = postulate::on_face(&self.least, &self.width, self.half, self.face, cell);
        try_blow_up(blow_up, Axis::FACE)
    }
}

fn closed(step: Step, axes: [Axis; 3]) -> Trial {
    Trial { steps: vec![step], failures: Vec::new(), axes, hopeless: false }
}

fn try_blow_up(blow_up: Option<BlowUp<Interval>>, axes: [Axis; 3]) -> Trial {
    let Some(blow_up) = blow_up else {
        let failures = vec![(Obligation::SigmaMin, Failure::NotEnclosed)];
        return Trial { steps: Vec::new(), failures, axes, hopeless: false };
    };
    let failure = match postulate::blow_up(&blow_up) {
        Ok(()) => return closed(Step::BlowUp, axes),
        Err(failure) => failure,
    };
    if let Some(corner) = CORNERS.into_iter().find(|&c| postulate::edge(&blow_up, c).is_ok()) {
        return closed(Step::Edge(corner), axes);
    }
    Trial {
        steps: Vec::new(),
        failures: vec![(Obligation::SigmaMin, failure)],
        axes: by_variation(&blow_up, axes),
        hopeless: false,
    }
}

/// The axes by how much `F` varies along them: by slopes for coordinates; by the widths of `F` at
/// the centre and (half) of the slopes for `kappa`, which has no slopes of its own.
fn by_variation(blow_up: &BlowUp<Interval>, axes: [Axis; 3]) -> [Axis; 3] {
    let Ok(expansion) = blow_up.expand(None) else {
        return axes;
    };
    let width = |x: &Interval| x.sup() - x.inf();
    let slopes = |k: usize| -> f64 { expansion.slopes[k].iter().map(Interval::mag).sum() };
    let first = if axes[0] == Axis::Kappa {
        let at_centre: f64 = expansion.off.iter().map(width).sum();
        let of_slopes: f64 = expansion.slopes.iter().flatten().map(width).sum();
        at_centre + of_slopes / 2.0
    } else {
        slopes(0)
    };
    by_weight(axes, [first, slopes(1), slopes(2)])
}
