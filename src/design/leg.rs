//! Legs as designs have them: quantities between exact ends.

pub use orthocert_checker::claim::{Leg, Quantity, WorkingMode};
