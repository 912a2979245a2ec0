//! What is about a machine's bodies and passive joints: `rod`, `base_joint` and `platform_joint` on
//! legs, and `[[mechanism.bodies]]`.

use super::description::{Bound, Demand, Motion};
use super::document::{Table, Value};
use super::drive::axes;
use super::error::{Defect, DesignError};
use super::exactly;
use super::independence::product;
use super::number::{exact, less_than_half_a_turn, not_negative, positive};
use crate::exact::monomial::Monomial;
use crate::exact::{Exact, NumberErrorKind};
use orthocert_kernel::claim::Body;
use orthocert_kernel::number::Expression;

const ROD: &str =
    "{ radius = 8, trim = [20, 30] }: the rod's radius, and how far from the base joint it \
                   begins and from the platform joint it ends; of a parallelogram also spread = 80 and \
                   axis = [0, 1, 0], how far apart its two rods are, and along what";
const BODIES: &str = "[[mechanism.bodies]] tables with on, from, to and radius";
const RADIUS: &str = "a radius greater than 0";

/// What a leg says of its rod, or of the two rods of a parallelogram.
pub(super) fn rods(
    leg: &Table<'_>,
    number: usize,
    motion: Motion,
) -> Result<Vec<Body>, DesignError> {
    let Some(value) = leg.find("rod") else {
        return Ok(Vec::new());
    };
    let table = value.table(ROD)?;
    table.only(&["radius", "trim", "spread", "axis"])?;
    let radius = radius(&table)?;
    let trim = table.require("trim", "[20, 30], or [0, 0]: lengths from either joint")?;
    let [base, platform] = trim.elements("[20, 30]: lengths from either joint")?;
    let end = |value: &Value<'_>| {
        let length = exact(value)?;
        not_negative(value, &length, "a length from the joint")?;
        exactly::of(value, &length)
    };
    let trim = [end(&base)?, end(&platform)?];
    let with =
        |offset| Body::Leg { leg: number, radius: radius.clone(), trim: trim.clone(), offset };
    if table.find("spread").or(table.find("axis")).is_none() {
        return Ok(vec![with(None)]);
    }
    let value =
        table.require("spread", "80: how far apart the two rods of the parallelogram are")?;
    if motion.turns() {
        let found = "two rods of a parallelogram, of a platform that turns";
        return Err(value.error(
            Defect::Conflict,
            found,
            "one rod a leg: two would hold the platform",
        ));
    }
    let spread = exact(&value)?;
    positive(&value, &spread, "a distance of two rods")?;
    let axis =
        axis(&table.require("axis", "[0, 1, 0]: along what the two rods are apart")?, motion)?;
    let half = |sign: i64| offset(&spread, &axis, sign).map_err(|_| exactly::too_long(&value));
    let written = |x: Vec<Exact>| -> Result<[Expression; 3], DesignError> {
        let all = x.iter().map(|x| exactly::of(&value, x)).collect::<Result<Vec<_>, _>>()?;
        all.try_into().map_err(|_| value.wrong_type("a rod in space"))
    };
    Ok(vec![with(Some(written(half(-1)?)?)), with(Some(written(half(1)?)?))])
}

/// Half of `spread` along an axis, or against it: in numbers `c sqrt(r)` where these are such.
fn offset(spread: &Exact, axis: &[Exact], sign: i64) -> Result<Vec<Exact>, NumberErrorKind> {
    if let Some(short) = in_monomials(spread, axis, sign) {
        return Ok(short);
    }
    let mut square = Exact::integer(0);
    for x in axis {
        square = square.plus(product(x, x)?)?;
    }
    let half = product(spread, &Exact::integer(sign))?.over(Exact::integer(2))?;
    let unit = half.over(square.root()?)?;
    axis.iter().map(|x| product(&unit, x)).collect()
}

fn in_monomials(spread: &Exact, axis: &[Exact], sign: i64) -> Option<Vec<Exact>> {
    let axis: Vec<Monomial> = axis.iter().map(Monomial::of).collect::<Option<_>>()?;
    let square = axis.iter().map(Monomial::square).sum();
    let half =
        Monomial::of(&product(spread, &Exact::integer(sign)).ok()?.over(Exact::integer(2)).ok()?)?;
    let unit = half.times(&Monomial::root(square)?.inverse()?);
    axis.iter().map(|x| unit.times(x).exact()).collect()
}

fn radius(table: &Table<'_>) -> Result<Expression, DesignError> {
    let value = table.require("radius", RADIUS)?;
    let radius = exact(&value)?;
    positive(&value, &radius, "a radius")?;
    exactly::of(&value, &radius)
}

/// What a leg says of the angles at its joints.
pub(super) fn joints(
    leg: &Table<'_>,
    number: usize,
    motion: Motion,
) -> Result<Vec<Demand>, DesignError> {
    let mut demands = Vec::new();
    for key in ["base_joint", "platform_joint"] {
        let Some(value) = leg.find(key) else {
            continue;
        };
        let accepted = match motion {
            Motion::Planar { .. } => "{ axis = [0, 1], max = 45 }, in degrees",
            _ => "{ axis = [0, 0, 1], max = 45 }, in degrees",
        };
        let table = value.table(accepted)?;
        table.only(&["axis", "max"])?;
        let (axis, bound) = (table.require("axis", accepted)?, table.require("max", accepted)?);
        let axis = self::axis(&axis, motion)?;
        let max = exact(&bound)?;
        less_than_half_a_turn(&bound, &max)?;
        let given = vec![("axis", axis)];
        demands.push(Demand { quantity: key, leg: Some(number), given, bound: Bound::Max(max) });
    }
    Ok(demands)
}

/// A direction without tolerance.
fn axis(value: &Value<'_>, motion: Motion) -> Result<Vec<Exact>, DesignError> {
    let [positions, _] = motion.coordinates();
    let count = if positions == 2 { 2 } else { 3 };
    let accepted = format!("{}: a direction, exact numbers not all zero", axes(motion));
    let elements = value.list(&accepted)?;
    if elements.len() != count {
        return Err(value.wrong_type(&accepted));
    }
    let axis: Vec<Exact> = elements.iter().map(exact).collect::<Result<_, _>>()?;
    if value.document.demands() && !axis.iter().any(|x| matches!(x.sign(), Some(1 | -1))) {
        let found = "a vector that is, or may be, zero";
        return Err(value.error(Defect::OutOfDomain, found, accepted));
    }
    Ok(axis)
}

/// Reads `[[mechanism.bodies]]`.
pub(super) fn bodies(mechanism: &Table<'_>, motion: Motion) -> Result<Vec<Body>, DesignError> {
    match mechanism.find("bodies") {
        Some(value) => value.list(BODIES)?.iter().map(|value| body(value, motion)).collect(),
        None => Ok(Vec::new()),
    }
}

fn body(value: &Value<'_>, motion: Motion) -> Result<Body, DesignError> {
    let table = value.table("a [[mechanism.bodies]] table")?;
    table.only(&["on", "from", "to", "radius"])?;
    let on = super::mechanism::word(&table, "on", &["base", "platform"], |on| on)?;
    let end = |key: &str| {
        let accepted = format!("{}: an end of the body's axis", axes(motion));
        let value = table.require(key, &accepted)?;
        if let Motion::Planar { .. } = motion {
            let [x, y] = value.elements(&accepted)?;
            return Ok([exactly::number(&x)?, exactly::number(&y)?, Expression::integer(0)]);
        }
        let [x, y, z] = value.elements(&accepted)?;
        Ok([exactly::number(&x)?, exactly::number(&y)?, exactly::number(&z)?])
    };
    let (from, to, radius) = (end("from")?, end("to")?, radius(&table)?);
    Ok(match *on {
        "base" => Body::Base { from, to, radius },
        _ => Body::Platform { from, to, radius },
    })
}
