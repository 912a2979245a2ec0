//! What a search may take, and how it ends.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Most boxes to be tried.
    pub max_boxes: usize,
    /// The moment at which to give up.
    pub deadline: Option<Instant>,
}

/// How far a search is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Boxes tried.
    pub boxes: usize,
    /// Share of the workspace's volume on which nothing is open.
    pub closed: f64,
}

/// The outside's hold on a search.
pub struct Control<'a> {
    /// Set to make the search end with [`Stop::Cancelled`].
    pub cancel: &'a AtomicBool,
    /// Called now and then, from the thread that started the search.
    pub progress: &'a mut dyn FnMut(Progress),
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Every box was either closed or cannot be closed by splitting it further.
    Exhausted,
    /// A box cannot be closed by splitting it further, and that is all that was asked.
    Hopeless,
    /// [`Budget::max_boxes`] were tried.
    Boxes,
    /// The deadline passed.
    Time,
    /// It was cancelled.
    Cancelled,
}
