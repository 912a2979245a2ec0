//! Whatever a rule accepts is true: on random cells, with bounds near the cell's true extremes,
//! every accepted bound is held against exact values at the cell's worst points.

use super::approximate::{polar_rotation, Approximate};
use super::machines::{
    self, cube, random_cell, random_lambda, reference, within_cell, REFERENCE_BITS,
};
use super::random::Random;
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_checker::cell::{Cell, Edge};
use orthocert_checker::claim::MachineClaim;
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::expansion::{Expansion, ExpansionPoint};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::linear::{determinant, Matrix, Symmetric};
use orthocert_checker::model::{JointRange, Model};
use orthocert_checker::rule::{self, Rotation, TightCorner};
use std::array::from_fn;

const BITS: u32 = 64;

/// How often a rule accepted and how often it did not.
#[derive(Default)]
struct Counts {
    accepted: usize,
    rejected: usize,
}

impl Counts {
    fn add(&mut self, accepted: bool) {
        *if accepted { &mut self.accepted } else { &mut self.rejected } += 1;
    }

    fn assert_both(&self, least: usize, name: &str) {
        let Counts { accepted, rejected } = self;
        assert!(*accepted >= least && *rejected >= least, "{name}: {accepted} / {rejected}");
    }
}

fn fixed(x: f64) -> Fixed {
    Fixed::rational(&BigRational::from_f64(x).unwrap(), 0, BITS)
}

/// Whether `T` is certainly not positive semidefinite: some principal minor is certainly negative.
fn certainly_not_semidefinite(t: &Symmetric<Fixed>) -> bool {
    let Symmetric { diagonal: [a, b, c], off: [x, y, z] } = t;
    let second = |p: &Fixed, q: &Fixed, r: &Fixed| p.mul(q).sub(&r.sqr());
    let full: Matrix<Fixed> = [
        [a.clone(), x.clone(), y.clone()],
        [x.clone(), b.clone(), z.clone()],
        [y.clone(), z.clone(), c.clone()],
    ];
    let others = [second(a, b, x), second(a, c, y), second(b, c, z), determinant(&full)];
    t.diagonal.iter().chain(&others).any(|minor| minor.neg().is_positive())
}

/// The points that are tried: corners, the least of `value`, and random ones.
fn tried(random: &mut Random, worst: [i64; 3]) -> Vec<[i64; 3]> {
    let corners = (0..8).map(|v| from_fn(|k| if v >> k & 1 == 1 { 256 } else { -256 }));
    corners.chain([worst]).chain((0..3).map(|_| random_lambda(random))).collect()
}

/// `sigma_min >= bound` (`lower`) or `sigma_max <= bound` is not violated at these points.
fn assert_holds(
    claim: &MachineClaim,
    cell: &Cell,
    points: &[[i64; 3]],
    bound: &Fixed,
    lower: bool,
    what: &str,
) {
    let square = bound.rescale(0, REFERENCE_BITS).sqr();
    for lambda in points {
        let m = reference(claim, &within_cell(cell, lambda)).map(|s| s.map(|state| state.row));
        let m = m.unwrap_or_else(|| panic!("{what}: {cell} {lambda:?}: accepted out of reach"));
        let gram = Symmetric::gram_of(&m);
        let difference =
            if lower { gram.minus_identity(&square) } else { gram.subtracted_from(&square) };
        assert!(!certainly_not_semidefinite(&difference), "{what}: {cell} {lambda:?}");
    }
}

#[test]
fn violations_are_noticed() {
    // The check behind the tests below must not be blind: a bound beyond the truth is a violation.
    let claim = machines::orthoglide("1", "-1/4", "1/4");
    let cell = Cell::ROOT;
    let m = reference(&claim, &within_cell(&cell, &[256; 3])).unwrap().map(|state| state.row);
    // At (c, c, c) the singular values are 1 + 2m, 1 - m, 1 - m with m = c / sqrt(1 - 2 c^2).
    let t = 0.25 / 0.875f64.sqrt();
    for (bound, lower, violated) in [
        (1.0 - t + 1e-9, true, true),
        (1.0 - t - 1e-9, true, false),
        (1.0 + 2.0 * t - 1e-9, false, true),
        (1.0 + 2.0 * t + 1e-9, false, false),
    ] {
        let square = fixed(bound).rescale(0, REFERENCE_BITS).sqr();
        let gram = Symmetric::gram_of(&m);
        let difference =
            if lower { gram.minus_identity(&square) } else { gram.subtracted_from(&square) };
        assert_eq!(certainly_not_semidefinite(&difference), violated, "{bound} {lower}");
    }
}

/// A random cell that every leg certainly reaches, with its expansion.
fn random_expansion(random: &mut Random, model: &Model<Fixed>) -> (Cell, Expansion<Fixed>) {
    loop {
        let cell = random_cell(random, 7);
        if let Ok(expansion) = Expansion::new(model, &cell, ExpansionPoint::Centre) {
            return (cell, expansion);
        }
    }
}

/// Factors by which a bound is put beyond the true extreme (above one) or short of it.
const SLACK: [f64; 6] = [0.5, 0.9, 0.99, 0.9999, 1.0001, 1.02];

#[test]
fn lower_accepts_only_what_is_true() {
    let mut random = Random::new(10);
    for (name, claim) in machines::all() {
        let mut model = Model::new(&claim, BITS).unwrap();
        let approximate = Approximate::new(&model);
        let mut counts = Counts::default();
        for _ in 0..120 {
            let (cell, expansion) = random_expansion(&mut random, &model);
            let (worst, sigma_min) = approximate.least(&cell, |m| m.xi[0]).unwrap();
            let bound = fixed(sigma_min * random.pick(&SLACK));
            model.bounds.kappa = bound.clone();
            let rotation = match random.once_in(10) {
                true => Rotation::IDENTITY,
                false => polar_rotation(&expansion.matrix),
            };
            let accepted = rule::lower(&model, &expansion, &rotation).is_ok();
            counts.add(accepted);
            if accepted {
                let points = tried(&mut random, worst);
                assert_holds(&claim, &cell, &points, &bound, true, name);
            }
        }
        counts.assert_both(20, name);
    }
}

#[test]
fn upper_accepts_only_what_is_true() {
    let mut random = Random::new(11);
    for (name, claim) in machines::all() {
        let mut model = Model::new(&claim, BITS).unwrap();
        let approximate = Approximate::new(&model);
        let mut counts = Counts::default();
        for _ in 0..120 {
            let (cell, expansion) = random_expansion(&mut random, &model);
            let (worst, greatest) = approximate.least(&cell, |m| -m.xi[2]).unwrap();
            let bound = fixed(-greatest / random.pick(&SLACK));
            model.bounds.k = Some(bound.clone());
            let accepted = rule::upper(&model, &expansion).is_ok();
            counts.add(accepted);
            if accepted {
                let points = tried(&mut random, worst);
                assert_holds(&claim, &cell, &points, &bound, false, name);
            }
        }
        counts.assert_both(20, name);
    }
}

#[test]
fn range_accepts_only_what_is_true() {
    let mut random = Random::new(12);
    for (name, claim) in machines::all() {
        let mut model = Model::new(&claim, BITS).unwrap();
        let approximate = Approximate::new(&model);
        let mut counts = Counts::default();
        for _ in 0..120 {
            let (cell, expansion) = random_expansion(&mut random, &model);
            let leg = usize::try_from(random.within(0, 2)).unwrap();
            let least = approximate.least(&cell, |m| m.rho[leg]).unwrap();
            let greatest = approximate.least(&cell, |m| -m.rho[leg]).unwrap();
            let room = (-greatest.1 - least.1) * random.pick(&[0.5, 0.01, 1e-3, -1e-9, -0.01]);
            let (min, max) = (fixed(least.1 - room), fixed(-greatest.1 + room));
            let ends = (random.once_in(2), random.once_in(2));
            let ends = (ends.0.then(|| min.clone()), (!ends.0 || ends.1).then(|| max.clone()));
            let free = || JointRange::Length { min: None, max: None };
            let mut ranges = [free(), free(), free()];
            let (min, max) = ends.clone();
            ranges[leg] = JointRange::Length { min, max };
            model.bounds.joint_range = Some(ranges);
            let accepted = rule::range(&model, &cell, &expansion).is_ok();
            counts.add(accepted);
            if accepted {
                for lambda in [least.0, greatest.0, random_lambda(&mut random)] {
                    let rho =
                        reference(&claim, &within_cell(&cell, &lambda)).unwrap()[leg].rho.clone();
                    let rho = rho.length().unwrap();
                    let (low, high) = (ends.0.as_ref(), ends.1.as_ref());
                    assert!(low.is_none_or(|x| x.inf() <= rho.sup()), "{name}: {cell} {lambda:?}");
                    assert!(high.is_none_or(|x| rho.inf() <= x.sup()), "{name}: {cell} {lambda:?}");
                }
            }
        }
        counts.assert_both(20, name);
    }
}

#[test]
fn corner_accepts_only_what_is_true() {
    let mut random = Random::new(13);
    for psi_max in ["1.01", "1.5", "2", "3", "20", "1000"] {
        let claim = cube(psi_max, "200");
        let model = Model::new(&claim, BITS).unwrap();
        let approximate = Approximate::new(&model);
        for corner in [TightCorner::Q1, TightCorner::Q2] {
            let mut counts = Counts::default();
            for _ in 0..40 {
                let cell = cell_at(corner, &mut random);
                let expansion = Expansion::new(&model, &cell, corner.expansion_point());
                let expansion = expansion.unwrap();
                let accepted = rule::corner(&model, &expansion).is_ok();
                counts.add(accepted);
                if accepted {
                    let (worst, _) = approximate.least(&cell, |m| m.xi[0]).unwrap();
                    let points = tried(&mut random, worst);
                    let kappa = BigRational::new(1.into(), 1.into())
                        / machines::exact(psi_max).as_rational().unwrap();
                    let kappa = Fixed::rational(&kappa, 0, REFERENCE_BITS);
                    let what = format!("psi_max = {psi_max}, {corner:?}");
                    assert_holds(&claim, &cell, &points, &kappa, true, &what);
                }
            }
            // A nearly isotropic cube is closed from either corner at once.
            let least = if psi_max.starts_with("1.") { 0 } else { 4 };
            assert!(counts.accepted >= 20);
            counts.assert_both(least, &format!("psi_max = {psi_max}, {corner:?}"));
        }
    }
}

fn cell_at(corner: TightCorner, random: &mut Random) -> Cell {
    let depth = random.within(0, 6);
    let edges = from_fn(|_| {
        let level = u32::try_from((depth - random.within(0, 1)).max(0)).unwrap();
        Edge { index: if corner == TightCorner::Q2 { (1 << level) - 1 } else { 0 }, level }
    });
    Cell { edges }
}

#[test]
fn tight_corners_are_tight_and_no_worse() {
    // The hand proof of the corner rule: T(Q) is semidefinite and, at Q_1, not definite, whatever
    // psi_max is, rational or not.
    let mut random = Random::new(14);
    let mut texts: Vec<String> = ["2", "1.000001", "1e6", "sqrt(2)", "2*sqrt(2)", "1+sqrt(3)/1000"]
        .map(str::to_owned)
        .to_vec();
    texts.extend((0..30).map(|_| format!("1+{}/1000", random.within(1, 5000))));
    for text in texts {
        let claim = cube(&text, "1");
        let model = Model::new(&claim, REFERENCE_BITS).unwrap();
        for (point, tight) in
            [(ExpansionPoint::LowerCorner, true), (ExpansionPoint::UpperCorner, false)]
        {
            let m = Expansion::new(&model, &Cell::ROOT, point).unwrap().matrix;
            let two = Fixed::integer(2, REFERENCE_BITS);
            let t = Symmetric::twice_part_of(&m).minus_identity(&model.bounds.kappa.mul(&two));
            assert!(!certainly_not_semidefinite(&t), "{text}: {point:?}");
            // (1, 1, 1) is an eigenvector of zero at Q_1.
            let [a, b, c] = &t.diagonal;
            let [x, y, z] = &t.off;
            let sum = a.add(b).add(c).add(&two.mul(&x.add(y).add(z)));
            assert_eq!(!sum.is_positive(), tight, "{text}: {point:?}");
            assert!(!sum.neg().is_positive(), "{text}: {point:?}");
        }
    }
}
