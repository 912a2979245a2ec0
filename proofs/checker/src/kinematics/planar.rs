//! Legs that constrain the platform to a plane moved by a linear drive: the Tripteron and other
//! Cartesian parallel manipulators.

use super::{map_vector, normalised, JointCoordinate, LegExpansion, LegState};
use crate::enclosure::Scalar;
use crate::linear::{dot, Vector};

/// A leg with the constant row `n = direction / |direction|` and `rho = n . P`. It is nowhere
/// serially singular.
#[derive(Clone, Debug)]
pub struct Planar<S> {
    n: Vector<S>,
}

impl<S: Scalar> Planar<S> {
    /// The leg with this direction; `None` if it may be zero.
    pub fn new(direction: &Vector<S>) -> Option<Self> {
        Some(Planar { n: normalised(direction)? })
    }

    pub(super) fn at(&self, w: &Vector<S>) -> LegState<S> {
        LegState {
            row: self.n.clone(),
            eta: w[0].integer_like(1),
            rho: JointCoordinate::Length(dot(&self.n, w)),
        }
    }

    /// Exact: the row has the slope matrix 0, and `rho` the slope `n`.
    pub(super) fn expand(&self, centre: &Vector<S>) -> LegExpansion<S> {
        let zero = || centre[0].integer_like(0);
        let zeros = || [zero(), zero(), zero()];
        LegExpansion {
            row: self.n.clone(),
            slope: [zeros(), zeros(), zeros()],
            rho: Some((dot(&self.n, centre), self.n.clone())),
        }
    }

    pub(super) fn clearance(&self) -> S {
        self.n[0].integer_like(1)
    }
}

impl<S> Planar<S> {
    pub(super) fn map<T>(&self, convert: &impl Fn(&S) -> T) -> Planar<T> {
        Planar { n: map_vector(&self.n, convert) }
    }
}
