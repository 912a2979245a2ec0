//! One cell of parameters: certified, refuted, or open.

use crate::design::AtlasDesign;
use crate::exact::arithmetic::number;
use crate::exact::Exact;
use crate::search::solver::refute::{failures, machine, opposite, point, short, turned, Toward};
use crate::search::solver::sample::{Place, Quality, Sampler, Worst};
use crate::search::solver::tree;
use crate::search::{Budget, Control, Stop};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_kernel::certificate::{AtlasCell, Failure, Witness};
use orthocert_kernel::claim::{AtlasClaim, MachineClaim, Quantity, Workspace};
use orthocert_kernel::input::{Input, Value};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::prover::check_cell;
use orthocert_kernel::witness;
use std::sync::atomic::AtomicBool;

/// Finest step of the search for worst values, `2^-FINEST` of the workspace: a guide only.
pub(super) const FINEST: i32 = 14;
/// Margin below which a claim is not worth a search.
const HOPELESS: f64 = 1e-12;
/// Parts of the way from the middle of the workspace to the worst place at which a witness for a
/// whole cell is looked for: where some machines of the cell do not reach the worst place itself,
/// all of them may fail a bit nearer to the middle.
const WAY: [f64; 6] = [1.0, 0.99, 0.97, 0.94, 0.9, 0.8];
/// Decimal places of the coordinates of a witness, relative to the range's width.
const DIGITS: i32 = 5;
/// Directions tried at a place, shortest first.
const DIRECTIONS: usize = 2;
/// Fractional bits in which a witness is evaluated.
const PRECISION: u32 = 64;

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
    part: &[(u64, u32)],
    cancel: &AtomicBool,
) -> Decision {
    let Ok(over) = claim.over(part) else {
        return Decision::Open;
    };
    let problem = Problem::new(&over).ok();
    // What seems to fail for some machine of the cell cannot be certified; what seems to hold for
    // a machine in its middle cannot be refuted.
    match problem.map(|problem| (promising(&over, &problem), problem)) {
        Some((Some(worst), problem)) => {
            certified(design, (claim, part), (&problem, &worst), cancel)
        }
        Some((None, problem)) => common_witness(design, (claim, part), (&over, &problem))
            .map(AtlasCell::Refuted)
            .filter(|refuted| check_cell(claim, part, refuted).is_ok())
            .map_or(Decision::Open, Decision::Decided),
        None => Decision::Open,
    }
}

/// A cell refuted, if the checker accepts a witness that is found for it.
pub(super) fn refuted(
    design: &AtlasDesign,
    claim: &AtlasClaim,
    part: &[(u64, u32)],
) -> Option<AtlasCell> {
    let over = claim.over(part).ok()?;
    let problem = Problem::new(&over).ok()?;
    let witness = common_witness(design, (claim, part), (&over, &problem))?;
    let refuted = AtlasCell::Refuted(witness);
    check_cell(claim, part, &refuted).is_ok().then_some(refuted)
}

/// The points at which the claim's obligations are nearest to failing, if none is seen to fail.
fn promising(over: &MachineClaim, problem: &Problem) -> Option<Vec<Vec<f64>>> {
    let sampler = Sampler::new(over, problem).ok()?;
    let holds = |w: &Worst| (w.margin > HOPELESS).then(|| sampler.point(&w.place.u));
    let worst = sampler.worst_on_grid();
    worst.iter().map(holds).collect::<Option<Vec<_>>>()?;
    let deeper = |w: &Worst| holds(&sampler.descend(w.quality, &w.place, FINEST));
    worst.iter().map(deeper).collect()
}

fn certified(
    design: &AtlasDesign,
    (claim, part): (&AtlasClaim, &[(u64, u32)]),
    (problem, worst): (&Problem, &[Vec<f64>]),
    cancel: &AtomicBool,
) -> Decision {
    let budget = Budget { max_boxes: design.boxes, deadline: None };
    let mut control = Control { cancel, progress: &mut |_| {} };
    let said = |tree: &_| AtlasCell::Certified(Clone::clone(tree));
    let accepts = |tree: &_| check_cell(claim, part, &said(tree)).is_ok();
    match tree(problem, worst, budget, &mut control, accepts) {
        Ok(tree) => Decision::Decided(AtlasCell::Certified(tree)),
        Err(Stop::Cancelled) => Decision::Cancelled,
        Err(_) => Decision::Open,
    }
}

/// The values of the parameters in the middle of a cell.
pub(super) fn middle(design: &AtlasDesign, part: &[(u64, u32)]) -> Option<Vec<Exact>> {
    let of = |(parameter, &(n, level)): (&crate::design::Parameter, &(u64, u32))| {
        let half = BigRational::new((2 * n + 1).into(), BigInt::from(1) << (level + 1));
        parameter.at(&half)
    };
    design.parameters.iter().zip(part).map(of).collect()
}

/// A witness that refutes the claim for every value of the parameters in a cell: one that refutes it
/// for those in its middle, if it does.
fn common_witness(
    design: &AtlasDesign,
    (claim, part): (&AtlasClaim, &[(u64, u32)]),
    (over, cell): (&MachineClaim, &Problem),
) -> Option<Witness> {
    let nominal = design.at(&middle(design, part)?);
    let problem = Problem::new(&nominal).ok()?;
    let sampler = Sampler::new(&nominal, &problem).ok()?;
    let named = Named { claim: &claim.machine, over, cell };
    let fails = |witness: &Witness| {
        let there = claim.varied(part, witness);
        there.is_ok_and(|there| witness::check(cell, &over.workspace, &there).is_ok())
    };
    let at_place = |quality: Quality, place: &Place, way: f64, inner: bool| {
        let point = |place: &Place| {
            if inner {
                return named.inner(&sampler.parts(&place.u));
            }
            let fixed = point(&nominal, &problem, &sampler, &place.u, DIGITS)?;
            named.point(fixed, &sampler.parts(&place.u))
        };
        let (own, machine) = (point(place)?, named.machine(&place.t)?);
        let ways = match quality {
            Quality::Determinant => {
                let other = opposite(&sampler, place)?;
                vec![Failure::Singular(point(&nearer(&other, way))?)]
            }
            _ => {
                let found = Worst { quality, place: place.clone(), margin: 0.0 };
                failures(&nominal, &problem, &sampler, &found, DIGITS)
            }
        };
        let with = |fails| Witness {
            precision: PRECISION,
            point: own.clone(),
            machine: machine.clone(),
            fails,
        };
        ways.into_iter().take(DIRECTIONS).map(with).find(fails)
    };
    let among = |mut worst: Vec<Worst>| {
        worst.retain(|w| w.margin < 0.0);
        worst.sort_by(|a, b| a.margin.total_cmp(&b.margin));
        // Not only the quality that fails most: each at each place.
        WAY.iter().find_map(|&way| {
            worst.iter().find_map(|at| {
                let place = nearer(&at.place, way);
                let values = sampler.at(&place);
                let mut fail = worst.iter().filter(|w| sampler.margin(w.quality, &values) < 0.0);
                fail.find_map(|w| {
                    let at = |inner| at_place(w.quality, &place, way, inner);
                    at(true).or_else(|| at(false))
                })
            })
        })
    };
    let grid = sampler.worst_on_grid();
    among(grid.clone()).or_else(|| {
        let deeper = |w: &Worst| sampler.descend(w.quality, &w.place, FINEST);
        let deeper = grid.iter().map(|w| (w, deeper(w)));
        among(deeper.filter(|(w, found)| w.place != found.place).map(|(_, w)| w).collect())
    })
}

/// The place at a part of the way from the middle of the workspace.
fn nearer(place: &Place, way: f64) -> Place {
    Place { u: place.u.iter().map(|u| 0.5 + way * (u - 0.5)).collect(), t: place.t.clone() }
}

/// The numbers of a claim with their names.
struct Named<'a> {
    claim: &'a MachineClaim,
    /// The claim over a cell.
    over: &'a MachineClaim,
    /// Its problem.
    cell: &'a Problem,
}

impl Named<'_> {
    /// A point at these parts of the workspace whatever it is for some values: at its ends where it is at
    /// them, on a part of its radius, elsewhere fixed.
    fn point(&self, fixed: Vec<Expression>, parts: &[f64]) -> Option<Vec<Expression>> {
        let [min, max] = &self.cell.corners;
        let coordinate = |(k, fixed): (usize, Expression)| match &self.claim.workspace {
            Workspace::Cylinder { center, radius, .. } if k < 2 => {
                let part = part_of(2.0 * parts[k] - 1.0)?;
                let off = over(Operator::Mul, radius.clone(), part);
                match center[k].rational() {
                    Some(zero) if zero == BigRational::from_integer(0.into()) => Some(off),
                    _ => Some(over(Operator::Add, center[k].clone(), off)),
                }
            }
            // Of orientations the tangents of an angle's ends are no numbers of the claim.
            _ if k >= min.len() => Some(fixed),
            _ if parts[k] <= 0.0 => Some(by_name(&min[k])),
            _ if parts[k] >= 1.0 => Some(by_name(&max[k])),
            _ => Some(fixed),
        };
        fixed.into_iter().enumerate().map(coordinate).collect()
    }

    /// A fixed point at these parts of the workspace that is in it for all values; `None` where none is
    /// found.
    fn inner(&self, parts: &[f64]) -> Option<Vec<Expression>> {
        let [min, max] = &self.cell.corners;
        let coordinate = |(k, part): (usize, &f64)| match &self.over.workspace {
            Workspace::Cylinder { center, radius, .. } if k < 2 => {
                let [radius, _] = ends(radius)?;
                let off = short([&-&radius, &radius], *part, DIGITS, Toward::Middle)?;
                Some(number(&(center[k].rational()? + off.rational()?)))
            }
            _ if k >= min.len() => turned(self.over, self.cell, k - min.len(), *part, DIGITS),
            _ => {
                let ([_, least], [greatest, _]) = (ends(&min[k])?, ends(&max[k])?);
                let is_there = least <= greatest;
                is_there.then(|| short([&least, &greatest], *part, DIGITS, Toward::Nearest))?
            }
        };
        parts.iter().enumerate().map(coordinate).collect()
    }

    /// A machine at these parts of its tolerances.
    fn machine(&self, t: &[f64]) -> Option<Vec<Expression>> {
        let value = |((_, min, max), t): ((&str, &Expression, &Expression), &f64)| {
            let (min, max) = (by_name(min), by_name(max));
            if *t <= 0.0 || *t >= 1.0 {
                return Some(if *t <= 0.0 { min } else { max });
            }
            let width = over(Operator::Sub, max, min.clone());
            Some(over(Operator::Add, min, over(Operator::Mul, width, part_of(*t)?)))
        };
        if !self.cell.tolerances().any(|(_, min, max)| min.varies() || max.varies()) {
            return machine(self.cell, t, DIGITS);
        }
        self.cell.tolerances().zip(t).map(value).collect()
    }
}

/// Rationals about the values of a number.
fn ends(x: &Expression) -> Option<[BigRational; 2]> {
    if let Some(x) = x.rational() {
        return Some([x.clone(), x]);
    }
    let value = Value::Quantity(Quantity::Exactly(x.clone()));
    let x = Input { place: String::new(), value, scale: 0 }.enclose(PRECISION, None)?;
    Some([x.lo, x.hi].map(|x| BigRational::new(x, BigInt::from(1) << PRECISION)))
}

/// A decimal near a part of a whole, nearer to zero.
fn part_of(part: f64) -> Option<Expression> {
    let ten = BigRational::from_integer(10.into()).pow(DIGITS);
    Some(number(&(BigRational::from_f64((part * 10f64.powi(DIGITS)).trunc())? / ten)))
}

fn over(operator: Operator, left: Expression, right: Expression) -> Expression {
    Expression::Binary(operator, left.into(), right.into())
}

/// The number with names in the place of their ranges.
fn by_name(x: &Expression) -> Expression {
    let of = |x: &Expression| by_name(x).into();
    match x {
        Expression::Varying(range) => Expression::Name(range.name.clone()),
        Expression::Literal { .. } | Expression::Name(_) => x.clone(),
        Expression::Neg(x) => Expression::Neg(of(x)),
        Expression::Sqrt(x) => Expression::Sqrt(of(x)),
        Expression::Power(x, n) => Expression::Power(of(x), *n),
        Expression::Binary(operator, x, y) => Expression::Binary(*operator, of(x), of(y)),
    }
}
