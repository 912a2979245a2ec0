//! The angle between a leg and an axis of its joint on the platform.

use super::{base_joint, Quantity};

/// Of a platform that does not turn, axes on it are axes in the base.
pub(super) const PLATFORM_JOINT: Quantity = Quantity {
    key: "platform_joint",
    symbol: "angle(leg_i, axis)",
    words: "angle between the leg, from base to platform, and the axis on the platform, degrees",
    given: &["axis"],
    ..Quantity::of_legs(|context, (_, leg)| base_joint::tests(context, leg, true))
};
