//! Claims that are not well formed for a reason that no single key shows.

use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use crate::search::solver::evidence::BITS;
use num_bigint::BigInt;
use orthocert_kernel::claim as kernel;
use orthocert_kernel::input::ClaimError as Refused;
use orthocert_kernel::problem::Problem;

/// Demands a claim that the kernel takes, with numbers that it encloses in the precision of proofs.
pub(super) fn compiled(root: &Table<'_>, claim: &kernel::MachineClaim) -> Result<(), DesignError> {
    let enclosed = |problem: Problem| problem.parameters::<BigInt>(BITS, &[]).map(drop);
    Problem::new(claim).and_then(enclosed).map_err(|error| refused(root, &error))
}

/// A claim that the kernel refuses: the error about the table that it names.
pub(super) fn refused(root: &Table<'_>, error: &Refused) -> DesignError {
    let Refused { place, expected } = error;
    let found = "a claim that is not well formed";
    // Which requirement, or leg, it is of stands before.
    let own = place.split_once(": ").map_or(&place[..], |(_, own)| own);
    let accepted = format!("a design whose {own} is {expected}");
    match named(root, place) {
        Some(value) => value.error(Defect::Claim, found, accepted),
        None => {
            let table = match place {
                _ if place.starts_with("workspace") => "workspace",
                _ if place.starts_with("orientation") => "workspace",
                _ if place.starts_with("requirement") => "requirements",
                _ => "mechanism",
            };
            of_table(root, table, found, accepted)
        }
    }
}

/// The value that a place of the kernel's, `requirement 3: stiffness`, `leg 2: length.0`,
/// `orientation` or the name of a parameter, stands for.
fn named<'a>(root: &Table<'a>, place: &str) -> Option<Value<'a>> {
    let table = |name: &str| root.find(name)?.table("a table").ok();
    let (subject, key) = place.split_once(": ").unwrap_or((place, ""));
    if subject.starts_with("requirement ") {
        return table("requirements")?.find(key);
    }
    if place.starts_with("transmission") {
        return table("requirements")?.find("transmission");
    }
    if place.starts_with("orientation") {
        return table("workspace")?.find("orientation");
    }
    let mechanism = table("mechanism")?;
    if let Some(number) = subject.strip_prefix("leg ") {
        let number: usize = number.parse().ok()?;
        let leg =
            mechanism.find("legs")?.list("legs").ok()?.into_iter().nth(number.checked_sub(1)?)?;
        let key = key.split('.').next().unwrap_or_default();
        let inner = leg.table("a leg").ok().and_then(|leg| leg.find(key));
        return Some(inner.unwrap_or(leg));
    }
    let of_formulas = |name: &str| mechanism.find(name)?.table("a table").ok()?.find(place);
    let whole = place.strip_prefix("mechanism.").and_then(|key| mechanism.find(key));
    whole.or_else(|| of_formulas("parameters")).or_else(|| of_formulas("definitions"))
}

/// The error about a table of the design as a whole.
pub(super) fn of_table(
    root: &Table<'_>,
    table: &str,
    found: &str,
    accepted: impl Into<String>,
) -> DesignError {
    match root.find(table) {
        Some(value) => value.error(Defect::Claim, found, accepted),
        None => root.lacks(table, accepted),
    }
}
