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

use crate::exact::arithmetic::{is_between, number};
use crate::questions::frontier::{
    approach, bracket, proof, About, Approach, Approached, NoAnswer, Succeeds,
};
use crate::questions::placement::{best_place, cube_about, is_endless, Centres, Cube, Placed};
use crate::search::solver::{self, approximate};
use crate::search::{Budget, Control};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{FromPrimitive, Zero};
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
    /// Whether with more time the bounds may have been nearer.
    pub out_of_time: bool,
    /// Whether with more time a better centre may have been found, where no claim is of all centres.
    pub is_short: bool,
    /// The centre of `refuted_here`.
    pub centre: Option<[BigRational; 3]>,
}

/// Share of the gap that is left between the place found and either bound.
const SHARE: f64 = 0.3;
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
        best_place(claim, Centres::Workspace, gap * PLACEMENT, budget.shared(2), control)
    })?;
    let Some(Placed { cube: place, out_of_time: is_short }) = place else {
        return Ok(Bracket::default());
    };
    let budget = budget.at_most(BOXES);
    let endless = approximate_width(claim).is_some_and(|width| is_endless(&place, width));
    if claim.orientation.is_some() {
        return match endless {
            true => Ok(Bracket { endless, ..Bracket::default() }),
            false => {
                let found = about_one_centre(claim, &place, gap, budget, control)?;
                Ok(Bracket { is_short, out_of_time: found.out_of_time || is_short, ..found })
            }
        };
    }
    let near = |succeeds| Approach::from_afar(place.side, succeeds, SHARE * gap);
    let inside = control.part([0.3, 0.6], |control| {
        let budget = budget.shared(2);
        approach(&near(Succeeds::Below), budget, control, |side, budget, control| {
            certified(claim, &number(side), &place.centre, gap, budget, control)
        })
    })?;
    let too_large = control.part([0.6, 1.0], |control| {
        if endless {
            return Ok(Approached { found: None, out_of_time: false });
        }
        approach(&near(Succeeds::Above), budget, control, |side, budget, control| {
            let side = number(side);
            let excluded = exclude(claim, &side, budget, control)?;
            Ok(excluded.map(|certificate| TooLarge { side, certificate }))
        })
    })?;
    let out_of_time = inside.out_of_time || too_large.out_of_time || is_short;
    let inside = inside.found.map(|(_, inside)| inside);
    let too_large = too_large.found.map(|(_, too_large)| too_large);
    let fails = match (&inside, &too_large) {
        (Some(Inside { centre, .. }), Some(TooLarge { side, .. })) => {
            let workspace = cube_about(centre, side);
            solver::refutation(&MachineClaim { workspace, ..claim.clone() })
        }
        _ => None,
    };
    Ok(Bracket { inside, too_large, endless, fails, out_of_time, ..Bracket::default() })
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
    let centre = rounded(place, gap);
    if !contains(claim, &centre) {
        return Ok(Bracket::default());
    }
    let cube = |side: &BigRational| {
        let workspace = cube_about(&centre, &number(side));
        Some(MachineClaim { workspace, ..claim.clone() })
    };
    let about = About {
        expected: place.side,
        holds: Succeeds::Below,
        share: SHARE,
        // Sampling sees little of many orientations: the side expected may be too great.
        is_sure: false,
        gap,
    };
    let found = control.part([0.3, 1.0], |control| bracket(&about, cube, budget, control))?;
    let inside = found.certified.map(|(side, certificate)| Inside {
        side: number(&side),
        centre: centre.clone(),
        certificate,
    });
    let fails = found.refuted.as_ref().map(|(_, certificate)| certificate.clone());
    let refuted_here =
        found.refuted.map(|(side, certificate)| TooLarge { side: number(&side), certificate });
    let (centre, out_of_time) = (Some(centre), found.out_of_time);
    Ok(Bracket { inside, refuted_here, centre, fails, out_of_time, ..Bracket::default() })
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
    let place = best_place(claim, Centres::Workspace, FINE * PLACEMENT, budget.shared(2), control)?;
    bracket.is_short = place.is_some_and(|place| place.out_of_time);
    let place = place.map(|place| place.cube);
    if let Some(place) = place.filter(|place| place.side >= wanted * (1.0 - 1e-12)) {
        bracket.inside = certified(claim, side, &place.centre, FINE, budget, control)?;
    }
    bracket.out_of_time = bracket.is_short || budget.is_over();
    if bracket.inside.is_none() && claim.orientation.is_none() {
        let excluded = exclude(claim, side, budget, control)?;
        bracket.out_of_time |= budget.is_over();
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
    let Some(size) = approximate(side) else { return Ok(None) };
    let centre = rounded(&Cube { centre: *centre, side: size }, gap);
    if !contains(claim, &centre) {
        return Ok(None);
    }
    let workspace = cube_about(&centre, side);
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
    edges.all(|((min, max), x)| is_between(x, [min, max]))
}

/// A decimal within a hundredth of `width` of `x`.
fn decimal(x: f64, width: f64) -> Option<BigRational> {
    let places = 2 - width.log10().floor() as i32;
    let grid = BigRational::from_integer(BigInt::from(10)).pow(places);
    Some((BigRational::from_f64(x)? * &grid).round() / grid)
}
