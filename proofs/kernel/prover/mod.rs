//! What provers and tests need beside the kernel. The checker is built without it, and no verdict depends
//! on it.

mod paving;
mod sampled;

pub use paving::{write_pair, write_steps};
pub use sampled::{check_sample, Sampled};

use crate::atlas::shown;
use crate::cell::Cell;
use crate::certificate::{AtlasCell, Certificate, Evidence};
use crate::claim::{AtlasClaim, MachineClaim, Mechanism, Workspace};
use crate::control::Control;
use crate::cube::Cube;
use crate::document::written;
use crate::fixed::{Integer, Interval};
use crate::formula::Formula;
use crate::input::{ClaimError, Input, Value};
use crate::rejected::Rejected;
use crate::test::accuracy::Accuracy;
use crate::work::LEAST_BYTES;

/// Every file of `src`, with its path there, in the order of the paths' bytes; listed by `build.rs`.
pub const SOURCES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/sources.rs"));

/// Accepts what is said of one cell of an atlas by itself, or says why not.
///
/// # Errors
/// If it is not shown.
pub fn check_cell(
    claim: &AtlasClaim,
    part: &[(u64, u32)],
    cell: &AtlasCell,
) -> Result<(), Rejected> {
    claim.validate()?;
    shown(claim, part, cell, LEAST_BYTES)
}

/// The claim with the machine of the paper's cube written out; any other claim as it is. What follows
/// from the cube, and a workspace in its place, are then stated apart.
///
/// # Errors
/// If the cube is none.
pub fn written_out(claim: &MachineClaim) -> Result<MachineClaim, ClaimError> {
    match (&claim.mechanism, &claim.workspace) {
        (Mechanism::Orthoglide { offset }, Workspace::Cube { side }) => {
            let legs = Cube::new(claim, offset, side)?.legs;
            Ok(MachineClaim { mechanism: Mechanism::Translational(legs), ..claim.clone() })
        }
        _ => Ok(claim.clone()),
    }
}

impl<Z: Integer> Cell<Z> {
    /// Both halves along coordinate `k`. `None` if there is no such coordinate, or nothing to halve.
    pub fn halves(&self, k: usize) -> Option<[Self; 2]> {
        let with = |half: Interval<Z>| {
            let mut all = self.clone();
            all.0[k] = half;
            all
        };
        Some(self.0.get(k)?.halves()?.map(with))
    }
}

impl Certificate {
    /// Its text.
    ///
    /// # Errors
    /// Never for what [`Certificate::read`] gave.
    pub fn to_text(&self) -> Result<String, serde_json::Error> {
        written(self)
    }
}

impl Evidence {
    /// The rule's name.
    pub fn name(&self) -> &'static str {
        match self {
            Evidence::Test => "test",
            Evidence::Divided => "divided",
            Evidence::Lower(_) => "lower",
            Evidence::LowerDivided(_) => "lower_divided",
            Evidence::Rank(_) => "rank",
            Evidence::Chords => "chords",
            Evidence::Conditioning(..) => "conditioning",
            Evidence::Accuracy(..) => "accuracy",
            Evidence::Direction(_) => "direction",
            Evidence::Negative => "negative",
            Evidence::Tolerances(..) => "tolerances",
            Evidence::Together(..) => "together",
            Evidence::Fan(_) => "fan",
            Evidence::Between(..) => "between",
            Evidence::Cube => "cube",
            Evidence::Corner(_) => "corner",
            Evidence::Mirror => "mirror",
            Evidence::Outside => "outside",
            Evidence::Inside(..) => "inside",
            Evidence::Turned(..) => "turned",
            Evidence::Control(_) => "control",
        }
    }
}

impl Input {
    /// Whether it has names that stand for ranges.
    pub fn varies(&self) -> bool {
        match &self.value {
            Value::Quantity(quantity) => quantity.ends().iter().any(|x| x.varies()),
            Value::Cosine(x) | Value::Sine(x) | Value::Radians(x) | Value::HalfTangent(x) => {
                x.varies()
            }
            Value::TiltReach(x, y) => x.varies() || y.varies(),
        }
    }
}

impl Control {
    /// Whether a formula has the form.
    pub fn has(&self, formula: Formula) -> bool {
        self.images.contains_key(&formula)
    }
}

impl Accuracy {
    /// Whether this is about `u_c`.
    pub fn is_of_angle(&self) -> bool {
        self.turn.is_some_and(|(_, first)| self.part.start >= first)
    }
}
