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
use crate::number::{Expression, Operator, Range, MOST_EXACT};
use crate::slope::{Slope, Slopes};
use num_bigint::BigInt;
use std::sync::Arc;

/// Most names, which are the parameters of an atlas.
pub const MOST_PARAMETERS: usize = 3;

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
    Some(sloped(x, &Slopes::new(&Fixed::new(bits), MOST_PARAMETERS))?.range)
}

type Number = Interval<BigInt>;

/// A number's slopes in coordinates one a parameter; `None` where it is not certainly defined for all values.
pub(crate) fn sloped(x: &Expression, slopes: &Slopes<'_, Fixed<BigInt>>) -> Option<Slope<Number>> {
    let of = |x: &Expression| sloped(x, slopes);
    let found = match x {
        _ if !x.varies() => slopes.constant(x.enclose(slopes.arithmetic.bits())?),
        Expression::Literal { .. } | Expression::Name(_) => None,
        Expression::Varying(range) => {
            slopes.coordinate(range.parameter, range.edge(slopes.arithmetic.bits()))
        }
        Expression::Neg(inner) => slopes.neg(&of(inner)?),
        Expression::Binary(Operator::Mul, a, b) if a == b => slopes.sqr(&of(a)?),
        Expression::Binary(operator, a, b) => operator.of(slopes, &of(a)?, &of(b)?),
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

/// What has numbers in it.
pub trait Numbers {
    /// Adds all of them.
    fn add_to<'a>(&'a mut self, all: &mut Vec<&'a mut Expression>);

    /// All of them.
    fn numbers_mut(&mut self) -> Vec<&mut Expression> {
        let mut all = Vec::new();
        self.add_to(&mut all);
        all
    }
}

impl Numbers for Expression {
    fn add_to<'a>(&'a mut self, all: &mut Vec<&'a mut Expression>) {
        all.push(self);
    }
}

/// Of each kind of thing its parts, none of which can be forgotten, and those that have numbers in them, in sequences.
macro_rules! numbers {
    ($($of:ty { $($parts:pat => [$($with:expr),*],)* })*) => { $(
        impl Numbers for $of {
            fn add_to<'a>(&'a mut self, all: &mut Vec<&'a mut Expression>) {
                match self {
                    $($parts => { $($with.into_iter().for_each(|part| part.add_to(all));)* })*
                }
            }
        }
    )* };
}

numbers! {
    MachineClaim {
        MachineClaim { mechanism, workspace, orientation, bodies, require } =>
            [[mechanism], [workspace], orientation, bodies, require],
    }
    Mechanism {
        Mechanism::Translational(legs) => [legs],
        Mechanism::Orthoglide { offset } => [[offset]],
        Mechanism::Planar(turning) | Mechanism::Spatial(turning) | Mechanism::Spherical(turning) =>
            [[turning]],
        Mechanism::Formulas(formulas) => [[formulas]],
    }
    Turning {
        Turning { legs, characteristic_length } => [legs, characteristic_length],
    }
    Leg {
        Leg::Slider { direction, anchor, platform, length, mode: _ } =>
            [direction, anchor, platform, [length]],
        Leg::Strut { anchor, platform, base_axis } =>
            [anchor, platform, base_axis.iter_mut().flatten()],
        Leg::Arm { axis, reference, anchor, platform, arm, length, mode: _ } =>
            [axis, reference, anchor, platform, [arm, length]],
        Leg::Planar { direction } => [direction],
    }
    Quantity {
        Quantity::Exactly(x) => [[x]],
        Quantity::Between { min, max } => [[min, max]],
    }
    Formulas {
        Formulas { coordinates: _, parameters, definitions, joints } =>
            [parameters.iter_mut().map(|(_, x)| x), definitions.iter_mut().map(|(_, x)| x), joints],
    }
    JointFormula {
        JointFormula::Rho(rho) => [[rho]],
        JointFormula::Row(row) => [row],
    }
    Workspace {
        Workspace::Box { min, max } => [min, max],
        Workspace::Cylinder { center, radius, z } => [center, [radius], z],
        Workspace::Cube { side } => [[side]],
    }
    Orientation {
        Orientation::Angle(angle) => [[angle]],
        Orientation::Tilt { tilt, torsion } => [[tilt, torsion]],
        Orientation::RollPitchYaw { roll, pitch, yaw } => [roll, pitch, yaw],
        Orientation::Range(range) => [range],
    }
    Body {
        Body::Leg { leg: _, radius, trim, offset } => [[radius], trim, offset.iter_mut().flatten()],
        Body::Base { from, to, radius } | Body::Platform { from, to, radius } => [from, to, [radius]],
    }
    Requirement {
        Requirement { quantity: _, leg: _, given, bound } =>
            [given.values_mut().flatten(), [bound]],
    }
    Bound {
        Bound::Min(bound) | Bound::Max(bound) => [[bound]],
        Bound::Within(bounds) => [bounds],
        Bound::Holds => [],
    }
    Witness {
        Witness { precision: _, point, machine, fails } => [point, machine, [fails]],
    }
    Failure {
        Failure::Singular(other) => [other],
        Failure::Same { obligation: _, least, greatest, inverse: _ } => [least, greatest],
        Failure::Reach | Failure::Obligation(..) | Failure::Row(..) | Failure::Dependent => [],
    }
}
