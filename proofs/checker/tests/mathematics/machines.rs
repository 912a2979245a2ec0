//! Machines that the tests are about, and their exact values at single points.

use super::random::Random;
use num_rational::BigRational;
use orthocert_checker::cell::{Cell, Edge};
use orthocert_checker::claim::{
    Leg, MachineClaim, Mechanism, Quantity, Range, Requirements, Sign, Workspace,
};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::kinematics::LegState;
use orthocert_checker::linear::Vector;
use orthocert_checker::model::{CubeConstants, Model};
use orthocert_checker::number::Exact;
use std::array::from_fn;

/// Fractional bits of reference values.
pub const REFERENCE_BITS: u32 = 256;

pub fn exact(text: &str) -> Exact {
    Exact::parse(text, 1000).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn quantities(texts: [&str; 3]) -> [Quantity; 3] {
    texts.map(|text| Quantity::exactly(exact(text)))
}

pub fn slider(
    direction: [&str; 3],
    anchor: [&str; 3],
    platform: [&str; 3],
    length: &str,
    mode: Sign,
) -> Leg {
    Leg::Slider {
        direction: quantities(direction),
        anchor: quantities(anchor),
        platform: quantities(platform),
        length: Quantity::exactly(exact(length)),
        mode,
    }
}

fn transmission(min: Option<&str>, max: Option<&str>) -> Requirements {
    let range = Range { min: min.map(exact), max: max.map(exact) };
    Requirements { transmission: Some(range), ..Requirements::default() }
}

/// `[1/1000, 1000]`, bounds that the tests replace in the model.
fn loose() -> Requirements {
    transmission(Some("1/1000"), Some("1000"))
}

fn over(
    legs: [Leg; 3],
    min: [&str; 3],
    max: [&str; 3],
    requirements: Requirements,
) -> MachineClaim {
    MachineClaim {
        mechanism: Mechanism::Translational(legs),
        workspace: Workspace::Box { min: min.map(exact), max: max.map(exact) },
        requirements,
    }
}

/// The Orthoglide with base point zero and legs of this length, over `[low, high]^3`.
pub fn orthoglide(length: &str, low: &str, high: &str) -> MachineClaim {
    const AXES: [[&str; 3]; 3] = [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]];
    let legs = AXES.map(|axis| slider(axis, ["0"; 3], ["0"; 3], length, Sign::Plus));
    over(legs, [low; 3], [high; 3], loose())
}

/// The linear Delta 333 / 174.75 mm: three vertical guides, on a circle at 3-4-5 angles.
pub fn linear_delta() -> MachineClaim {
    let at = |x, y| slider(["0", "0", "1"], [x, y, "0"], ["0"; 3], "333", Sign::Minus);
    let legs = [at("0", "174.75"), at("-139.8", "-104.85"), at("139.8", "-104.85")];
    over(legs, ["-110", "-110", "-5"], ["110", "110", "5"], loose())
}

/// Three guides in general position, with platform offsets.
pub fn skew_guides() -> MachineClaim {
    let p = Sign::Plus;
    let legs = [
        slider(["3", "1", "0"], ["-10", "2", "0"], ["5", "0", "-3"], "310", p),
        slider(["0", "4", "1"], ["1", "-12", "0"], ["0", "6", "2"], "305", p),
        slider(["1", "0", "5"], ["0", "3", "-9"], ["-2", "0", "4"], "320", p),
    ];
    over(legs, ["-90"; 3], ["120"; 3], loose())
}

/// The paper's cube of this side.
pub fn cube(psi_max: &str, side: &str) -> MachineClaim {
    MachineClaim {
        mechanism: Mechanism::Orthoglide { offset: Exact::integer(0) },
        workspace: Workspace::Cube { side: exact(side) },
        requirements: transmission(None, Some(psi_max)),
    }
}

/// Every mechanism that the enclosures are tested on. The second reaches out to where legs are
/// serially singular and beyond.
pub fn all() -> Vec<(&'static str, MachineClaim)> {
    vec![
        ("cube, psi_max = 2", cube("2", "200")),
        ("cube, psi_max = 20", cube("20", "1")),
        ("box up to serial singularities", orthoglide("1", "-3/4", "3/4")),
        ("box 310.25 mm", orthoglide("310.25", "-73", "126")),
        ("linear delta", linear_delta()),
        ("skew guides", skew_guides()),
    ]
}

/// The ends of a workspace in the claim's unit.
pub fn ends(claim: &MachineClaim) -> ([Exact; 3], [Exact; 3]) {
    match &claim.workspace {
        Workspace::Box { .. } | Workspace::Cylinder { .. } => {
            claim.workspace.bounding_box().unwrap()
        }
        Workspace::Cube { side } => {
            let transmission = claim.requirements.transmission.as_ref().unwrap();
            let cube = CubeConstants::new(transmission.max.as_ref().unwrap(), side).unwrap();
            let end = |q: Exact| q.over(cube.inverse_length.clone()).unwrap();
            let (q1, q2) = (end(cube.q1.clone()), end(cube.q2.clone()));
            (from_fn(|_| q1.clone()), from_fn(|_| q2.clone()))
        }
    }
}

/// `min + (max - min) u`, exactly.
pub fn point(claim: &MachineClaim, u: &Vector<BigRational>) -> [Exact; 3] {
    let (min, max) = ends(claim);
    from_fn(|k| {
        let width = max[k].clone().minus(min[k].clone()).unwrap();
        let part = width.times(Exact::Rational(u[k].clone())).unwrap();
        min[k].clone().plus(part).unwrap()
    })
}

/// The machine's values at `u`, to 256 bits: its own model, made for that point alone. `None`
/// where some leg does not reach it.
pub fn reference(claim: &MachineClaim, u: &Vector<BigRational>) -> Option<[LegState<Fixed>; 3]> {
    let model = Model::at_point(claim, None, &point(claim, u), REFERENCE_BITS).unwrap();
    states(&model)
}

pub fn states(model: &Model<Fixed>) -> Option<[LegState<Fixed>; 3]> {
    let [a, b, c] = &model.origin;
    Some([model.legs[0].at(a)?, model.legs[1].at(b)?, model.legs[2].at(c)?])
}

/// A cell of random proportions, often at a corner, an edge or a face of the workspace.
pub fn random_cell(random: &mut Random, deepest: i64) -> Cell {
    let deepest = random.within(0, deepest);
    let mut edge = || {
        let level = u32::try_from(random.within((deepest - 2).max(0), deepest)).unwrap();
        let last = (1i64 << level) - 1;
        let index = match random.within(0, 4) {
            0 => 0,
            1 => last,
            2 => last / 2,
            _ => random.within(0, last),
        };
        Edge { index: u128::try_from(index).unwrap(), level }
    };
    Cell { edges: [edge(), edge(), edge()] }
}

/// Where a point lies in a cell: `lambda` in `[-1, 1]^3`, in 256ths, often at an end.
pub fn random_lambda(random: &mut Random) -> [i64; 3] {
    from_fn(|_| match random.within(0, 5) {
        0 => -256,
        1 => 256,
        2 => random.within(-3, 3),
        _ => random.within(-256, 256),
    })
}

/// `u` at `centre + lambda / 256 * half edge` of a cell.
pub fn within_cell(cell: &Cell, lambda: &[i64; 3]) -> Vector<BigRational> {
    from_fn(|k| {
        let Edge { index, level } = cell.edges[k];
        let numerator = i128::try_from(index).unwrap() * 512 + 256 + i128::from(lambda[k]);
        BigRational::new(numerator.into(), (1i128 << (level + 9)).into())
    })
}
