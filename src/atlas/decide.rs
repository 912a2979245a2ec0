//! One cell of parameters: certified, refuted, or open.

use crate::design::AtlasDesign;
use crate::interval::Interval;
use crate::refute;
use crate::sample::{Place, Sampler};
use crate::search::{self, Budget, Control, Stop};
use crate::verify::{worst_values, Worst, MODEL_PRECISION, PRECISIONS};
use orthocert_checker::atlas::{check_cell, Side};
use orthocert_checker::cell::Cell;
use orthocert_checker::certificate::{AtlasCell, Tree, Witness};
use orthocert_checker::claim::{AtlasClaim, Leg, MachineClaim, Mechanism, Quantity};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use orthocert_checker::{witness, TreeSize};
use std::sync::atomic::AtomicBool;

/// Finest step of the search for worst values, `2^-FINEST` of the workspace: a guide only.
const FINEST: i32 = 14;
/// Margin below which a claim is not worth a search.
const HOPELESS: f64 = 1e-12;
/// Parts of the way from the middle of the workspace to the worst place at which a witness for a
/// whole cell is looked for: where some machines of the cell do not reach the worst place itself,
/// all of them may fail a bit nearer to the middle.
const WAY: [f64; 6] = [1.0, 0.99, 0.97, 0.94, 0.9, 0.8];

/// What became of a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Decision {
    /// The checker accepts this of the cell: certified, or refuted.
    Decided(AtlasCell),
    /// Neither was found.
    Open,
    /// The work was cancelled.
    Cancelled,
}

/// Decides a cell within the boxes that the design allows for one.
pub fn decide(
    design: &AtlasDesign,
    claim: &AtlasClaim,
    cell: &Cell,
    cancel: &AtomicBool,
) -> Decision {
    let strictest = claim.cell(cell, Side::Strictest).ok();
    // What seems to fail for some machine of the cell cannot be certified; what seems to hold for
    // a machine in its middle cannot be refuted.
    if let Some(strictest) = strictest.filter(promising) {
        return certified(design, claim, cell, &strictest, cancel);
    }
    refuted(claim, cell).map_or(Decision::Open, Decision::Decided)
}

/// A cell refuted, if the checker accepts a witness that is found for it.
pub(super) fn refuted(claim: &AtlasClaim, cell: &Cell) -> Option<AtlasCell> {
    let loosest = claim.cell(cell, Side::Loosest).ok()?;
    let refuted = AtlasCell::Refuted(Box::new(common_witness(&loosest)?));
    accepted(claim, cell, &refuted).then_some(refuted)
}

fn accepted(claim: &AtlasClaim, cell: &Cell, said: &AtlasCell) -> bool {
    check_cell(claim, cell, said, &mut TreeSize::default()).is_ok()
}

/// Samples the claim; `None` if it has no model.
pub(super) fn sampled(claim: &MachineClaim) -> Option<(Sampler, Vec<Worst>)> {
    let model = Model::new(claim, MODEL_PRECISION).ok()?;
    let sampler = Sampler::new(claim, &model)?;
    let worst = worst_values(&sampler, FINEST);
    Some((sampler, worst))
}

fn promising(claim: &MachineClaim) -> bool {
    sampled(claim).is_some_and(|(_, worst)| worst.iter().all(|w| w.margin > HOPELESS))
}

fn certified(
    design: &AtlasDesign,
    claim: &AtlasClaim,
    cell: &Cell,
    strictest: &MachineClaim,
    cancel: &AtomicBool,
) -> Decision {
    let Ok(model) = Model::new(strictest, MODEL_PRECISION) else {
        return Decision::Open;
    };
    let budget = Budget { max_boxes: design.boxes, deadline: None };
    let mut control = Control { cancel, progress: &mut |_| {} };
    let found = search::search(&model.map(&Interval::from_fixed), budget, &mut control);
    if found.stop == Stop::Cancelled {
        return Decision::Cancelled;
    }
    if !found.open.is_empty() || found.stop != Stop::Exhausted {
        return Decision::Open;
    }
    let tree = |precision| AtlasCell::Certified(Tree { precision, nodes: found.nodes.clone() });
    let proof = PRECISIONS.into_iter().map(tree).find(|proof| accepted(claim, cell, proof));
    proof.map_or(Decision::Open, Decision::Decided)
}

/// A witness that refutes the claim for every machine within its tolerances: one that refutes it
/// for a machine in their middle, if it does.
fn common_witness(loosest: &MachineClaim) -> Option<Witness> {
    let nominal = nominal(loosest)?;
    let (sampler, mut worst) = sampled(&nominal)?;
    worst.sort_by(|a, b| a.margin.total_cmp(&b.margin));
    let failing = || worst.iter().filter(|w| w.margin < 0.0);
    WAY.iter().find_map(|part| {
        let nearer = |u: f64| 0.5 + part * (u - 0.5);
        // Not only the quality that fails most: each at each place.
        failing().find_map(|at| {
            let place = Place { u: at.place.u.map(nearer), t: at.place.t.clone() };
            failing().find_map(|w| {
                let witness = refute::witness_at(&nominal, &sampler, w.quality, &place)?;
                witness::check_every_machine(loosest, &witness).is_ok().then_some(witness)
            })
        })
    })
}

/// The claim about the machine in the middle of the tolerances.
fn nominal(claim: &MachineClaim) -> Option<MachineClaim> {
    let mut nominal = claim.clone();
    if let Mechanism::Translational(legs) = &mut nominal.mechanism {
        for quantity in legs.iter_mut().flat_map(Leg::parameters_mut) {
            if !quantity.is_exact() {
                let sum = quantity.min.clone().plus(quantity.max.clone()).ok()?;
                *quantity = Quantity::exactly(sum.over(Exact::integer(2)).ok()?);
            }
        }
    }
    Some(nominal)
}
