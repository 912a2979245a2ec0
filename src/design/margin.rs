//! Whether all bounds of a claim can be tightened together.

use orthocert_kernel::claim::{Bound, MachineClaim, Requirement};
use orthocert_kernel::number::Expression;

/// The one quantity whose bounds may be of any sign.
pub(crate) const JOINT_RANGE: &str = "joint_range";

/// Why a claim's margin is not defined; `None` if it is.
pub fn without_margin(claim: &MachineClaim) -> Option<&'static str> {
    let lone = |own: &Requirement| own.quantity == JOINT_RANGE && joint_range(claim, own).is_none();
    let half_open = claim.require.iter().any(lone);
    half_open.then_some("a joint_range with one end has no middle about which to tighten it")
}

/// Both ends of the joint range that a requirement is of.
pub(crate) fn joint_range<'a>(
    claim: &'a MachineClaim,
    own: &'a Requirement,
) -> Option<[&'a Expression; 2]> {
    let other = |wanted: fn(&Bound) -> Option<&Expression>| {
        let same = |r: &&Requirement| r.quantity == own.quantity && r.leg == own.leg;
        claim.require.iter().filter(same).find_map(|r| wanted(&r.bound))
    };
    let least = other(|bound| match bound {
        Bound::Min(min) | Bound::Within([min, _]) => Some(min),
        Bound::Max(_) | Bound::Holds => None,
    });
    let greatest = other(|bound| match bound {
        Bound::Max(max) | Bound::Within([_, max]) => Some(max),
        Bound::Min(_) | Bound::Holds => None,
    });
    Some([least?, greatest?])
}
