//! Operands of expressions, which know what has been computed of them.

use super::{Exact, PRECISIONS};
use num_bigint::BigInt;
use orthocert_kernel::fixed::Interval;
use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, OnceLock};

/// An operand. Clones share its enclosures, each of which is computed once, from those of its own
/// operands: time is in proportion to the text, however often the number is asked for.
#[derive(Clone)]
pub struct Operand(Arc<Node>);

struct Node {
    value: Exact,
    is_open: bool,
    enclosures: [OnceLock<Option<Box<Interval<BigInt>>>>; PRECISIONS.len()],
}

impl Operand {
    pub(super) fn new(value: Exact) -> Self {
        let is_open = value.is_open();
        Operand(Arc::new(Node { value, is_open, enclosures: Default::default() }))
    }

    pub(super) fn has_name(&self) -> bool {
        self.0.is_open
    }

    /// As [`Exact::enclosure`].
    pub(super) fn enclosure(&self, level: usize) -> Option<&Interval<BigInt>> {
        let computed = self.0.enclosures.get(level)?;
        let compute = || {
            #[cfg(test)]
            tests::COMPUTED.with(|count| count.set(count.get() + 1));
            self.0.value.enclosure(level).map(Box::new)
        };
        computed.get_or_init(compute).as_deref()
    }
}

impl Deref for Operand {
    type Target = Exact;

    fn deref(&self) -> &Exact {
        &self.0.value
    }
}

impl PartialEq for Operand {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.value == other.0.value
    }
}

impl Eq for Operand {}

impl fmt::Debug for Operand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.value.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::MAX_ROOTS;
    use std::cell::Cell;

    thread_local! {
        /// Enclosures of operands that were computed.
        pub(super) static COMPUTED: Cell<usize> = const { Cell::new(0) };
    }

    /// A number as hostile as they come is worked on in proportion to its text, once.
    #[test]
    fn every_operand_is_enclosed_once_at_each_precision() {
        let mut text = "sqrt(2)".to_owned();
        for _ in 1..MAX_ROOTS {
            text = format!("1/sqrt({text}*{text2}+1e-500)", text2 = "3");
        }
        COMPUTED.with(|count| count.set(0));
        let number = Exact::parse(&text, 1000).expect("a number");
        let tiny = number.clone().minus(number.clone()).expect("a number");
        for _ in 0..100 {
            assert_eq!((number.clone().sign(), tiny.sign()), (Some(1), None));
            assert!(number.enclose(1000).is_some());
            assert!(number.compare(&tiny).is_some());
        }
        let operations = text.bytes().filter(|c| b"+-*/q".contains(c)).count();
        let computed = COMPUTED.with(Cell::get);
        // At most two operands an operation, and those of the comparisons with `tiny`.
        let most = PRECISIONS.len() * (2 * operations + 4) + 2 * 100;
        assert!(computed > operations && computed <= most, "{computed} of {most}");
    }
}
