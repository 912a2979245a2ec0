//! How near the ends of an extreme are tried to be, and with how many boxes.

use super::NotEnclosed;
use crate::search::solver::extremes::Extreme;
use crate::search::Budget;
use num_rational::BigRational;
use num_traits::{FromPrimitive, One, Signed, Zero};
use orthocert_kernel::problem::Problem;

/// Boxes after which a width is given up for a looser one. Of platforms that turn it is a third of the second number for
/// each coordinate of orientation, as each takes three times as long, and with tolerances a sixth of what is left.
const MOST_BOXES: [usize; 2] = [50_000, 20_000];
/// How often twice the loosest width that may be asked for is taken, where it has no proof.
pub const LOOSER: usize = 3;

/// The loosest relative width that may be asked for.
pub fn loosest() -> BigRational {
    BigRational::new(1.into(), 10.into())
}

/// What is found at the width `relative`, or else at the narrowest of its doubles up to [`loosest`], by halves of
/// their exponents, or else at the first of the doubles beyond: a width is as easy as all narrower ones. Where time is
/// short the loosest is first, and one between.
/// Once something is found, it stays so whatever then goes wrong.
pub fn narrowest<T>(
    relative: &BigRational,
    is_short: bool,
    mut at: impl FnMut(&BigRational) -> Result<Option<T>, NotEnclosed>,
) -> Result<Option<T>, NotEnclosed> {
    let mut wider = vec![relative.clone()];
    while let Some(last) = wider.last().filter(|last| **last < loosest()) {
        wider.push((last + last).min(loosest()));
    }
    let last = wider.len() - 1;
    for _ in 0..LOOSER {
        wider.extend(wider.last().map(|last| last + last));
    }
    let first = if is_short { &[last, last / 2, 0][..] } else { &[0, last] };
    // Found at `holds`, and nothing at and below `fails`.
    let (mut fails, mut holds) = (None, wider.len());
    let mut best = None;
    let mut next = first.iter().copied().chain(last + 1..wider.len());
    loop {
        let asked = next.find(|k| *k < holds && fails.is_none_or(|fails| *k > fails));
        let between = fails.filter(|fails| best.is_some() && holds - fails > 1);
        let middle = between.map(|fails| (fails + holds) / 2);
        let Some(k) = asked.or(middle) else { return Ok(best) };
        match at(&wider[k]) {
            Ok(Some(found)) => (best, holds) = (Some(found), k),
            Ok(None) => fails = Some(k),
            Err(error) => return best.map(Some).ok_or(error),
        }
    }
}

/// A bound at so many thirds of a step beyond the value found. No value is expected to go beyond two, where the
/// proof needs room; the value itself goes beyond one on its inner side.
pub fn end(extreme: &Extreme, found: f64, step: &BigRational, thirds: i32) -> Option<BigRational> {
    let sign = if extreme.is_greatest() { 1 } else { -1 };
    let beyond = step * BigRational::new((sign * thirds).into(), 3.into());
    Some(rounded(&(BigRational::from_f64(found)? + beyond), step))
}

/// The decimal nearest to `x` on a grid of at most a hundredth of `step`.
pub fn rounded(x: &BigRational, step: &BigRational) -> BigRational {
    let ten = BigRational::from_integer(10.into());
    let mut grid = BigRational::one();
    let wanted = step / BigRational::from_integer(100.into());
    while grid > wanted {
        grid /= &ten;
    }
    (x / &grid).round() * grid
}

/// A decimal near a value times `factor`; none of zero.
pub fn beyond(value: f64, factor: &BigRational) -> Option<BigRational> {
    let value = BigRational::from_f64(value).filter(|value| !value.is_zero())? * factor;
    Some(rounded(&value, &(value.abs() / BigRational::from_integer(10.into()))))
}

/// The budget after which a width, or one of several bounds, is given up.
pub fn of_one_width(budget: Budget, problem: &Problem) -> Budget {
    let slower = if turns_with_tolerances(problem) { 6 } else { 1 };
    let own = MOST_BOXES[usize::from(!problem.orientation.is_empty())];
    let most = own / 3usize.pow(problem.orientation.len() as u32) / slower;
    budget.at_most(most)
}

/// Whether it is a platform that turns, of a machine with tolerances.
fn turns_with_tolerances(problem: &Problem) -> bool {
    !problem.orientation.is_empty() && problem.tolerances().next().is_some()
}
