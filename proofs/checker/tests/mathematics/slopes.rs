//! The slope identities: expansions over random cells contain the machine's exact values.

use super::machines::{self, random_cell, random_lambda, reference, within_cell, REFERENCE_BITS};
use super::random::Random;
use num_rational::BigRational;
use orthocert_checker::cell::{Cell, Edge};
use orthocert_checker::enclosure::Scalar;
use orthocert_checker::expansion::{Expansion, ExpansionPoint, Region};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::kinematics::LegState;
use orthocert_checker::model::Model;

/// Whether two enclosures have a point in common. With the reference 2^-190 wide and the other
/// one rounded at 2^-64 or so, this says that the exact value is in both.
fn meets(enclosure: &Fixed, reference: &Fixed) -> bool {
    enclosure.rescale(0, REFERENCE_BITS).intersection(reference).is_some()
}

/// `at + sum_k lambda_k slopes_k` in units of 1/256 of `lambda`.
fn moved<'a>(at: &Fixed, slopes: impl IntoIterator<Item = &'a Fixed>, lambda: &[i64; 3]) -> Fixed {
    slopes.into_iter().zip(lambda).fold(at.clone(), |sum, (slope, &lambda)| {
        let part = BigRational::new(lambda.into(), 256.into());
        sum.add(&slope.mul(&Fixed::rational(&part, 0, at.bits())))
    })
}

/// Which of the 12 numbers (9 of `M`, 3 of `rho`) are enclosed at `lambda` in 256ths of the
/// expansion's slopes.
fn enclosed(expansion: &Expansion<Fixed>, lambda: &[i64; 3], exact: &[LegState<Fixed>; 3]) -> u32 {
    let mut count = 0;
    for (i, state) in exact.iter().enumerate() {
        for j in 0..3 {
            let slopes = expansion.slopes.iter().map(|slope| &slope[i][j]);
            let entry = moved(&expansion.matrix[i][j], slopes, lambda);
            count += u32::from(meets(&entry, &state.row[j]));
        }
        let (at, slopes) = expansion.rho[i].as_ref().unwrap();
        let rho = moved(at, slopes, lambda);
        count += u32::from(meets(&rho, state.rho.length().unwrap()));
    }
    count
}

#[test]
fn expansions_about_the_centre_enclose_m_and_rho() {
    let mut random = Random::new(1);
    for (name, claim) in machines::all() {
        let (mut expanded, mut refused, mut missed_elsewhere) = (0, 0, 0);
        for _ in 0..120 {
            let model = Model::new(&claim, random.pick(&[40, 64, 128])).unwrap();
            let cell = random_cell(&mut random, 12);
            let Ok(expansion) = Expansion::new(&model, &cell, ExpansionPoint::Centre) else {
                refused += 1;
                continue;
            };
            expanded += 1;
            for _ in 0..4 {
                let lambda = random_lambda(&mut random);
                let exact = reference(&claim, &within_cell(&cell, &lambda))
                    .unwrap_or_else(|| panic!("{name}: {cell} {lambda:?} is out of reach"));
                assert_eq!(enclosed(&expansion, &lambda, &exact), 12, "{name}: {cell} {lambda:?}");
                assert_natural_rho(&model, &cell, &exact, name);
                // The enclosures tell points apart: at the point opposite some entry is missed.
                let opposite = lambda.map(|x| -x);
                missed_elsewhere += i32::from(enclosed(&expansion, &opposite, &exact) < 12);
            }
        }
        assert!(expanded >= 40 && missed_elsewhere >= 3 * expanded, "{name}: {expanded}");
        assert_eq!(refused > 0, name.contains("singular"), "{name}: {refused}");
    }
}

fn assert_natural_rho(model: &Model<Fixed>, cell: &Cell, exact: &[LegState<Fixed>; 3], name: &str) {
    for (leg, state) in exact.iter().enumerate() {
        let over = Region::new(model, cell, ExpansionPoint::Centre).over;
        let found = model.legs[leg].at(&over[leg]);
        let rho = found.unwrap_or_else(|| panic!("{name}: {cell}: expanded, but no natural rho"));
        assert!(
            meets(rho.rho.length().unwrap(), state.rho.length().unwrap()),
            "{name}: {cell}: natural rho of leg {leg}"
        );
    }
}

#[test]
fn expansions_about_corners_enclose_m_and_rho() {
    let mut random = Random::new(2);
    for (name, claim) in machines::all() {
        let mut expanded = 0;
        for _ in 0..60 {
            let model = Model::new(&claim, 64).unwrap();
            let upper = random.once_in(2);
            let cell = corner_cell(&mut random, upper);
            let (point, sign) = match upper {
                true => (ExpansionPoint::UpperCorner, 1),
                false => (ExpansionPoint::LowerCorner, -1),
            };
            let Ok(expansion) = Expansion::new(&model, &cell, point) else { continue };
            expanded += 1;
            for _ in 0..4 {
                let lambda = random_lambda(&mut random).map(|x| x / 2 * 2);
                let exact = reference(&claim, &within_cell(&cell, &lambda)).unwrap();
                // From [-1, 1] about the centre to [0, 1] from the corner inward.
                let inward = lambda.map(|x| 128 - sign * x / 2);
                assert_eq!(enclosed(&expansion, &inward, &exact), 12, "{name}: {cell} {lambda:?}");
            }
        }
        assert!(expanded >= 30 || name.contains("singular"), "{name}: {expanded}");
    }
}

fn corner_cell(random: &mut Random, upper: bool) -> Cell {
    let edges = std::array::from_fn(|_| {
        let level = u32::try_from(random.within(0, 6)).unwrap();
        Edge { index: if upper { (1 << level) - 1 } else { 0 }, level }
    });
    Cell { edges }
}

#[test]
fn expansions_become_exact_at_twice_the_rate_of_the_cell() {
    // Slope enclosures are as wide as the cell, and are multiplied by its extent: the enclosure
    // of M - M(c) is wide of second order. A wrong term would leave a width of first order.
    for (name, claim) in machines::all() {
        let model = Model::new(&claim, 200).unwrap();
        let width_at = |level: u32| {
            let index = (1u128 << level) * 21 / 40;
            let cell = Cell { edges: [Edge { index, level }; 3] };
            let expansion = Expansion::new(&model, &cell, ExpansionPoint::Centre).unwrap();
            let slopes = expansion.slopes.iter().flatten().flatten();
            slopes.map(|s| s.sup() - s.inf()).max().unwrap()
        };
        let (coarse, fine) = (width_at(10), width_at(20));
        let ratio = BigRational::from_integer((1 << 20).into());
        assert!(coarse > BigRational::from_integer(0.into()), "{name}");
        assert!(fine < &coarse / ratio * BigRational::from_integer(2.into()), "{name}");
    }
}
