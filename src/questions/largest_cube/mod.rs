//! The largest axis-aligned cube in the region where a claim holds, between a cube that is
//! certified and a side for which none fits.
//!
//! | module    | does                                                                |
//! |-----------|---------------------------------------------------------------------|
//! | `exclude` | proves that no cube of a side fits, wherever its centre is in a box |
//!
//! The lower bound is a certificate for the cube as a workspace of its own; the upper bound is a
//! certificate of the claim [`NoCube`](orthocert_kernel::certificate::Claim::NoCube). Of platforms that turn,
//! for which there is no such claim, it is a refuted cube about the same centre.

mod exclude;

use crate::exact::arithmetic::at_most;
use crate::questions::frontier::{bracket, proof, About, NoAnswer, Succeeds};
use crate::questions::placement::{best_place, cube_about, is_endless, Centres, Cube};
use crate::search::solver::{self, approximate, number};
use crate::search::{Budget, Control, Steps};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{FromPrimitive, Signed, Zero};
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::claim::{MachineClaim, Workspace};
use orthocert_kernel::number::Expression;

pub use exclude::exclude;

/// A cube that is certified.
#[derive(Clone, Debug)]
pub struct Inside {
    /// Its side.
    pub side: Expression,
    /// Its centre.
    pub centre: [BigRational; 3],
    /// The certificate for the cube as a workspace.
    pub certificate: Box<Certificate>,
}

/// A side for which no cube fits.
#[derive(Clone, Debug)]
pub struct TooLarge {
    /// The side.
    pub side: Expression,
    /// The certificate.
    pub certificate: Box<Certificate>,
}

/// Both bounds, as far as they were found.
#[derive(Clone, Debug, Default)]
pub struct Bracket {
    /// The greatest cube that was certified.
    pub inside: Option<Inside>,
    /// The least side that was excluded.
    pub too_large: Option<TooLarge>,
    /// The least side found that is refuted about the centre of the cube that is certified, where no claim
    /// is of all centres: of platforms that turn.
    pub refuted_here: Option<TooLarge>,
    /// Whether no end was found of the cubes that seem to fit.
    pub endless: bool,
    /// What fails in a cube of that side about the centre of the one that fits.
    pub fails: Option<Box<Certificate>>,
}

/// Shares of the gap that are left between the place found and either bound, tried in turn. The
/// later ones are for tolerances, and for regions in which the place is not unique.
const SHARES: [f64; 7] = [0.3, 0.45, 5.0, 50.0, 500.0, 2e4, 1e5];
/// The greatest share with which both bounds are as near as the gap.
const ENOUGH: f64 = 0.5;
/// Shares tried between one that is too small and one that is not: a factor of ten becomes 1.15.
const NEARER: usize = 4;
/// Boxes after which a side is given up for a looser one: what closes at all closes in some thousand.
const BOXES: usize = 50_000;

/// Precision of the side of a place, relative to the gap.
const PLACEMENT: f64 = 1e-3;

/// Encloses the side of the largest cube with its centre in the workspace of `claim`, a box, to a
/// relative width of `gap`, or as near to it as the budget allows.
///
/// # Errors
/// [`NoAnswer`].
pub fn largest_cube(
    claim: &MachineClaim,
    gap: f64,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Bracket, NoAnswer> {
    let place = control.part([0.0, 0.3], |control| {
        best_place(claim, Centres::Workspace, gap * PLACEMENT, control)
    })?;
    let Some(place) = place else {
        return Ok(Bracket::default());
    };
    let budget = budget.at_most(BOXES);
    if claim.orientation.is_some() {
        return about_one_centre(claim, &place, gap, budget, control);
    }
    let inside = nearest(control, [0.3, 0.6], |share, control| {
        let side = decimal(place.side * (1.0 - share * gap), place.side * gap);
        match side.filter(BigRational::is_positive).and_then(|side| number(&side)) {
            Some(side) => certified(claim, &side, &place.centre, gap, budget, control),
            None => Ok(None),
        }
    })?;
    let width = approximate_width(claim);
    let endless = width.is_some_and(|width| is_endless(&place, width));
    let too_large = if endless {
        None
    } else {
        nearest(control, [0.6, 1.0], |share, control| {
            let side = decimal(place.side * (1.0 + share * gap), place.side * gap);
            let Some(side) = side.and_then(|side| number(&side)) else { return Ok(None) };
            let excluded = exclude(claim, &side, budget, control)?;
            Ok(excluded.map(|certificate| TooLarge { side, certificate }))
        })?
    };
    let fails = match (&inside, &too_large) {
        (Some(Inside { centre, .. }), Some(TooLarge { side, .. })) => cube_about(centre, side)
            .and_then(|workspace| solver::refutation(&MachineClaim { workspace, ..claim.clone() })),
        _ => None,
    };
    Ok(Bracket { inside, too_large, endless, fails, refuted_here: None })
}

/// The greatest side that is certified, and the least that is refuted, about the centre of a place, of a
/// platform that turns: in every orientation of the claim's set.
fn about_one_centre(
    claim: &MachineClaim,
    place: &Cube,
    gap: f64,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Bracket, NoAnswer> {
    if approximate_width(claim).is_some_and(|width| is_endless(place, width)) {
        return Ok(Bracket { endless: true, ..Bracket::default() });
    }
    let centre = rounded(place, gap);
    if !contains(claim, &centre) {
        return Ok(Bracket::default());
    }
    let cube = |side: &BigRational| {
        let workspace = cube_about(&centre, &number(side)?)?;
        Some(MachineClaim { workspace, ..claim.clone() })
    };
    let about = About {
        expected: place.side,
        holds: Succeeds::Below,
        share: SHARES[0],
        // Sampling sees little of many orientations: the side expected may be too great.
        is_sure: false,
        gap,
        parts: [0.3, 0.8, 1.0],
    };
    let found = bracket(&about, cube, budget, control)?;
    let inside = found.certified.and_then(|(side, certificate)| {
        Some(Inside { side: number(&side)?, centre: centre.clone(), certificate })
    });
    let fails = found.refuted.as_ref().map(|(_, certificate)| certificate.clone());
    let refuted_here = found
        .refuted
        .and_then(|(side, certificate)| Some(TooLarge { side: number(&side)?, certificate }));
    Ok(Bracket { inside, refuted_here, fails, ..Bracket::default() })
}

/// What is found for the least share of the gap for which something is: of [`SHARES`], and, if it is
/// none of those that are enough, from there towards the last for which nothing was found. Cancelled, it
/// has what was found before.
fn nearest<T>(
    control: &mut Control<'_>,
    part: [f64; 2],
    mut found: impl FnMut(f64, &mut Control<'_>) -> Result<Option<T>, NoAnswer>,
) -> Result<Option<T>, NoAnswer> {
    let mut steps = Steps::default();
    let mut found = |share| {
        let found =
            control.part(part, |control| steps.next(control, 2, |control| found(share, control)));
        // What was found before is the answer.
        match found {
            Err(NoAnswer::Cancelled) => Ok(Err(())),
            found => found.map(Ok),
        }
    };
    let mut least = 0.0;
    for share in SHARES {
        let Ok(tried) = found(share)? else { return Ok(None) };
        let Some(mut best) = tried else {
            least = share;
            continue;
        };
        let mut most = share;
        for _ in 0..if share > ENOUGH { NEARER } else { 0 } {
            let between = (least * most).sqrt();
            match found(between)? {
                Ok(Some(better)) => (best, most) = (better, between),
                Ok(None) => least = between,
                Err(()) => break,
            }
        }
        return Ok(Some(best));
    }
    Ok(None)
}

/// Whether a cube of this side fits with its centre in the workspace of `claim`: at most one of the
/// bounds, and none where it is not decided.
///
/// # Errors
/// [`NoAnswer`].
pub fn cube_of_side(
    claim: &MachineClaim,
    side: &Expression,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Bracket, NoAnswer> {
    const FINE: f64 = 1e-9;
    let mut bracket = Bracket::default();
    let wanted = approximate(side).unwrap_or(f64::INFINITY);
    let place = best_place(claim, Centres::Workspace, FINE * PLACEMENT, control)?;
    if let Some(place) = place.filter(|place| place.side >= wanted * (1.0 - 1e-12)) {
        bracket.inside = certified(claim, side, &place.centre, FINE, budget, control)?;
    }
    if bracket.inside.is_none() && claim.orientation.is_none() {
        let excluded = exclude(claim, side, budget, control)?;
        bracket.too_large =
            excluded.map(|certificate| TooLarge { side: side.clone(), certificate });
    }
    Ok(bracket)
}

/// The certificate for a cube, if there is one within the budget.
fn certified(
    claim: &MachineClaim,
    side: &Expression,
    centre: &[f64; 3],
    gap: f64,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Option<Inside>, NoAnswer> {
    let size = approximate(side).unwrap_or(1.0);
    let centre = rounded(&Cube { centre: *centre, side: size }, gap);
    if !contains(claim, &centre) {
        return Ok(None);
    }
    let Some(workspace) = cube_about(&centre, side) else {
        return Err(NoAnswer::Claim("its numbers exceed what can be reported".to_owned()));
    };
    let certificate = proof(&MachineClaim { workspace, ..claim.clone() }, budget, control)?;
    Ok(certificate.map(|certificate| Inside { side: side.clone(), centre, certificate }))
}

/// The centre of a place in decimals, a thousandth of the gap away at most.
fn rounded(place: &Cube, gap: f64) -> [BigRational; 3] {
    place.centre.map(|x| decimal(x, place.side * gap * 0.1).unwrap_or_else(BigRational::zero))
}

/// The greatest edge of the workspace, a box, about.
fn approximate_width(claim: &MachineClaim) -> Option<f64> {
    let Workspace::Box { min, max } = &claim.workspace else {
        return None;
    };
    let edges = min.iter().zip(max).map(|(min, max)| Some(approximate(max)? - approximate(min)?));
    edges.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::max)
}

/// Whether a point is provably in the workspace, a box.
fn contains(claim: &MachineClaim, point: &[BigRational; 3]) -> bool {
    let Workspace::Box { min, max } = &claim.workspace else {
        return false;
    };
    let mut edges = min.iter().zip(max).zip(point);
    edges.all(|((min, max), x)| number(x).is_some_and(|x| at_most(min, &x) && at_most(&x, max)))
}

/// A decimal within a hundredth of `width` of `x`.
fn decimal(x: f64, width: f64) -> Option<BigRational> {
    let places = 2 - width.log10().floor() as i32;
    let grid = BigRational::from_integer(BigInt::from(10)).pow(places);
    Some((BigRational::from_f64(x)? * &grid).round() / grid)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_share_that_works_is_come_near_to() {
        let cancel = std::sync::atomic::AtomicBool::new(false);
        let control = &mut Control { cancel: &cancel, progress: &mut |_| {} };
        for least in [0.2, 0.3, 0.4, 0.6, 7.3, 49.0, 300.0, 9e4] {
            let mut tries = 0;
            let found = nearest(control, [0.0, 1.0], |share, _| {
                tries += 1;
                Ok((share >= least).then_some(share))
            });
            let found = found.unwrap().unwrap();
            let enough = if least <= ENOUGH { ENOUGH } else { 1.3 * least };
            assert!((least..=enough).contains(&found), "{least}: {found}");
            assert!(tries <= SHARES.len() + NEARER);
        }
        let all = [0.0, 1.0];
        assert_eq!(nearest(control, all, |_, _| Ok(None::<f64>)).unwrap(), None);
        let cancelled = |_, _: &mut Control<'_>| Err::<Option<f64>, _>(NoAnswer::Cancelled);
        assert_eq!(nearest(control, all, cancelled), Ok(None));
        let mut found = Some(5.0);
        let then_cancelled =
            |_, _: &mut Control<'_>| found.take().map(Some).ok_or(NoAnswer::Cancelled);
        assert_eq!(nearest(control, all, then_cancelled), Ok(Some(5.0)));
    }
}
