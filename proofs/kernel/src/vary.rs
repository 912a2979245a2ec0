//! Claims over a cell of parameters: names in numbers stand for every value of an interval.
//!
//! Whatever is decided of a claim whose names are given their ranges is decided for every value: a sign
//! that is certain, an order, an enclosure. Only what is the same expression is the same number.

use crate::arithmetic::Arithmetic;
use crate::certificate::{Failure, Witness};
use crate::claim::{
    Body, Bound, Formulas, JointFormula, Leg, MachineClaim, Mechanism, Orientation, Quantity,
    Requirement, Turning, Workspace,
};
use crate::fixed::{Fixed, Interval};
use crate::number::{Expression, Operator, MOST_EXACT};
use crate::slope::{Slope, Slopes};
use num_bigint::BigInt;
use num_integer::Integer as _;
use num_rational::BigRational;
use std::sync::Arc;

/// Most names, which are the parameters of an atlas.
pub const MOST_PARAMETERS: usize = 3;

/// A name, and the values that it stands for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Range {
    /// Which of the parameters it is, counted from zero.
    pub parameter: usize,
    /// Its name.
    pub name: String,
    /// From the one to the other.
    pub ends: [BigRational; 2],
}

impl Range {
    /// Its centre `c`, itself, and its half-width `h`, each rounded outward to `bits` fractional bits.
    ///
    /// A value is `c + lambda h` with the exact `c` and `h`: its `lambda` is the same with any number of
    /// bits. Were `c` and `h` the rounded ones, slopes of inputs with different units would be of
    /// different `lambda`.
    pub(crate) fn edge(&self, bits: u32) -> [Interval<BigInt>; 3] {
        let [least, greatest] = &self.ends;
        // Over twice the common denominator.
        let whole = (least.denom() * greatest.denom()) << 1u32;
        let lo = least.numer() * greatest.denom();
        let hi = greatest.numer() * least.denom();
        let (centre, half) = (&lo + &hi, &hi - &lo);
        [[&centre, &centre], [&(&lo << 1u32), &(&hi << 1u32)], [&half, &half]].map(|[lo, hi]| {
            let lo = (lo << bits).div_floor(&whole);
            Interval { lo, hi: -(-hi << bits).div_floor(&whole) }
        })
    }
}

/// Gives names their ranges. A name that has none stays, and no number has names.
pub(crate) fn vary(x: &mut Expression, ranges: &[Range]) {
    match x {
        Expression::Literal { .. } | Expression::Varying(_) => {}
        Expression::Name(name) => {
            if let Some(range) = ranges.iter().find(|range| range.name == *name) {
                *x = Expression::Varying(Box::new(range.clone()));
            }
        }
        Expression::Neg(inner) | Expression::Power(inner, _) | Expression::Sqrt(inner) => {
            vary(Arc::make_mut(inner), ranges);
        }
        Expression::Binary(_, left, right) => {
            vary(Arc::make_mut(left), ranges);
            vary(Arc::make_mut(right), ranges);
        }
    }
}

/// Encloses a number for every value of its names: by its slopes in them, so that what cancels does.
///
/// `None` where it is not certainly defined for all of them; a root of what may be zero is not.
pub(crate) fn enclose(x: &Expression, bits: u32) -> Option<Interval<BigInt>> {
    let place = |parameter| (parameter < MOST_PARAMETERS).then_some(parameter);
    Some(sloped(x, &Slopes::new(&Fixed::new(bits), MOST_PARAMETERS), &place)?.range)
}

/// Adds the parameters that an expression's names stand for.
pub(crate) fn parameters(x: &Expression, found: &mut Vec<usize>) {
    if let Expression::Varying(range) = x {
        found.push(range.parameter);
    }
    x.parts().for_each(|part| parameters(part, found));
}

type Number = Interval<BigInt>;

/// A number's slopes in coordinates of which names are those that `place` says of their parameters; `None` where a
/// name has none, or the number is not certainly defined for all values.
pub(crate) fn sloped(
    x: &Expression,
    slopes: &Slopes<'_, Fixed<BigInt>>,
    place: &impl Fn(usize) -> Option<usize>,
) -> Option<Slope<Number>> {
    let of = |x: &Expression| sloped(x, slopes, place);
    let found = match x {
        _ if !x.varies() => slopes.constant(x.enclose(slopes.arithmetic, &|_| None)?),
        Expression::Literal { .. } | Expression::Name(_) => None,
        Expression::Varying(range) => {
            slopes.coordinate(place(range.parameter)?, range.edge(slopes.arithmetic.bits()))
        }
        Expression::Neg(inner) => slopes.neg(&of(inner)?),
        Expression::Binary(operator, a, b) => {
            let (left, right) = (of(a)?, of(b)?);
            match operator {
                Operator::Add => slopes.add(&left, &right),
                Operator::Sub => slopes.sub(&left, &right),
                Operator::Mul if a == b => slopes.sqr(&left),
                Operator::Mul => slopes.mul(&left, &right),
                Operator::Div => slopes.div(&left, &right),
            }
        }
        Expression::Power(base, n) => {
            let base = of(base)?;
            let square = slopes.sqr(&base)?;
            let even = (1..n / 2).try_fold(square.clone(), |power, _| {
                slopes.mul(&power, &square).filter(is_moderate)
            })?;
            if n % 2 == 0 {
                Some(even)
            } else {
                slopes.mul(&even, &base)
            }
        }
        Expression::Sqrt(inner) => slopes.sqrt(&of(inner)?),
    };
    found.filter(is_moderate)
}

fn is_moderate(x: &Slope<Number>) -> bool {
    let all = x.slopes.iter().chain([&x.range]);
    all.into_iter().all(|x| x.lo.bits().max(x.hi.bits()) <= MOST_EXACT)
}

impl MachineClaim {
    /// Every number of the claim.
    pub fn numbers_mut(&mut self) -> Vec<&mut Expression> {
        let MachineClaim { mechanism, workspace, orientation, bodies, require } = self;
        let mut all = Vec::new();
        match mechanism {
            Mechanism::Translational(legs) => of_legs(legs, &mut all),
            Mechanism::Orthoglide { offset } => all.push(offset),
            Mechanism::Planar(turning)
            | Mechanism::Spatial(turning)
            | Mechanism::Spherical(turning) => {
                let Turning { legs, characteristic_length } = turning;
                of_legs(legs, &mut all);
                all.extend(characteristic_length);
            }
            Mechanism::Formulas(formulas) => {
                let Formulas { coordinates: _, parameters, definitions, joints } = formulas;
                of_quantities(parameters.iter_mut().map(|(_, quantity)| quantity), &mut all);
                all.extend(definitions.iter_mut().map(|(_, expression)| expression));
                for joint in joints {
                    match joint {
                        JointFormula::Rho(rho) => all.push(rho),
                        JointFormula::Row(row) => all.extend(row),
                    }
                }
            }
        }
        match workspace {
            Workspace::Box { min, max } => all.extend(min.iter_mut().chain(max)),
            Workspace::Cylinder { center, radius, z } => {
                all.extend(center.iter_mut().chain([radius]).chain(z));
            }
            Workspace::Cube { side } => all.push(side),
        }
        match orientation {
            Some(Orientation::Angle(angle)) => all.push(angle),
            Some(Orientation::Tilt { tilt, torsion }) => all.extend([tilt, torsion]),
            Some(Orientation::RollPitchYaw { roll, pitch, yaw }) => {
                all.extend(roll.iter_mut().chain(pitch).chain(yaw));
            }
            Some(Orientation::Range(range)) => all.extend(range),
            None => {}
        }
        for body in bodies {
            match body {
                Body::Leg { leg: _, radius, trim, offset } => {
                    all.extend([radius].into_iter().chain(trim).chain(offset.iter_mut().flatten()));
                }
                Body::Base { from, to, radius } | Body::Platform { from, to, radius } => {
                    all.extend(from.iter_mut().chain(to).chain([radius]));
                }
            }
        }
        for Requirement { quantity: _, leg: _, given, bound } in require {
            all.extend(given.values_mut().flatten());
            match bound {
                Bound::Min(bound) | Bound::Max(bound) => all.push(bound),
                Bound::Within(bounds) => all.extend(bounds),
                Bound::Holds => {}
            }
        }
        all
    }
}

impl Witness {
    /// Every number of the witness.
    pub fn numbers_mut(&mut self) -> Vec<&mut Expression> {
        let Witness { precision: _, point, machine, fails } = self;
        let mut all: Vec<&mut Expression> = point.iter_mut().chain(machine).collect();
        match fails {
            Failure::Singular(other) => all.extend(other),
            Failure::Same { least, greatest, .. } => all.extend(least.iter_mut().chain(greatest)),
            Failure::Reach | Failure::Obligation(..) | Failure::Row(..) | Failure::Dependent => {}
        }
        all
    }
}

fn of_legs<'a>(legs: &'a mut [Leg], all: &mut Vec<&'a mut Expression>) {
    for leg in legs {
        match leg {
            Leg::Slider { direction, anchor, platform, length, mode: _ } => {
                of_quantities(direction.iter_mut().chain(anchor).chain(platform), all);
                of_quantities([length], all);
            }
            Leg::Strut { anchor, platform, base_axis } => {
                of_quantities(anchor.iter_mut().chain(platform), all);
                of_quantities(base_axis.iter_mut().flatten(), all);
            }
            Leg::Arm { axis, reference, anchor, platform, arm, length, mode: _ } => {
                of_quantities(axis.iter_mut().chain(reference).chain(anchor), all);
                of_quantities(platform.iter_mut().chain([arm, length]), all);
            }
            Leg::Planar { direction } => of_quantities(direction, all),
        }
    }
}

fn of_quantities<'a>(
    quantities: impl IntoIterator<Item = &'a mut Quantity>,
    all: &mut Vec<&'a mut Expression>,
) {
    for quantity in quantities {
        match quantity {
            Quantity::Exactly(x) => all.push(x),
            Quantity::Between { min, max } => all.extend([min, max]),
        }
    }
}
