//! A tape without what is the same everywhere: its operations on what varies, one after the other.

use super::doubles::Single;
use orthocert_kernel::arithmetic::{elbow, Arithmetic};
use orthocert_kernel::formula::{Formula, Op, Tape, Values};
use std::cell::RefCell;

/// Where a value is.
#[derive(Clone, Copy)]
pub(crate) enum Slot {
    /// Among the constants.
    Constant(usize),
    /// Among the values of the steps.
    Step(usize),
}

/// An operation on earlier values.
#[derive(Clone, Copy)]
pub(crate) enum Step {
    /// What the tape is run with, by its number.
    Input(usize),
    Add(Slot, Slot),
    Sub(Slot, Slot),
    Neg(Slot),
    Mul(Slot, Slot),
    Div(Slot, Slot),
    Sqr(Slot),
    Sqrt(Slot),
    /// The first component of an elbow, which finds both.
    Elbow([Slot; 3]),
    /// The second one of the elbow just before.
    ElbowToo,
}

/// What a coordinate or parameter is.
pub(crate) enum Input<N> {
    Constant(N),
    Varying(usize),
}

/// The operations of a tape.
pub(crate) struct Program<N> {
    pub steps: Vec<Step>,
    constants: Vec<N>,
    slots: Values<Slot>,
}

impl<N: Clone> Program<N> {
    /// Of the entries of a tape that are needed, all where it is not said which. Operations on constants
    /// are carried out in this arithmetic.
    pub fn new<A: Arithmetic<Number = N>>(
        tape: &Tape,
        needed: Option<&[bool]>,
        arithmetic: A,
        input: impl Fn(Op) -> Option<Input<N>>,
    ) -> Self {
        let record =
            Record { arithmetic, constants: RefCell::default(), steps: RefCell::default() };
        let own = |op: Op| {
            Some(match input(op)? {
                Input::Constant(x) => record.constant(x),
                Input::Varying(k) => record.push(Step::Input(k)),
            })
        };
        let slots = tape.run_parts(
            &record,
            (needed, &Values::default()),
            |k| own(Op::Coordinate(k)),
            |j| own(Op::Parameter(j)),
        );
        let Record { constants, steps, .. } = record;
        Program { steps: steps.into_inner(), constants: constants.into_inner(), slots }
    }

    /// The same with constants as another kind of number.
    pub fn map<M>(self, f: impl FnMut(N) -> M) -> Program<M> {
        let Program { steps, constants, slots } = self;
        Program { steps, constants: constants.into_iter().map(f).collect(), slots }
    }
}

impl<N> Program<N> {
    /// Where a formula's value is; `None` if it is undefined everywhere.
    #[inline]
    pub fn slot(&self, formula: Formula) -> Option<Slot> {
        self.slots.of(formula).copied()
    }

    /// What is there, given the values of the steps.
    #[inline(always)]
    pub fn at<'a>(&'a self, values: &'a [N], slot: Slot) -> Option<&'a N> {
        match slot {
            Slot::Constant(at) => self.constants.get(at),
            Slot::Step(at) => values.get(at),
        }
    }
}

impl Program<f64> {
    /// The values of the steps; of what is undefined, or depends on it, no number.
    pub fn run(&self, input: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.steps.len());
        let mut second = f64::NAN;
        for &step in &self.steps {
            let of = |slot| self.at(&values, slot).copied().unwrap_or(f64::NAN);
            let defined = |is: bool, x: f64| if is { x } else { f64::NAN };
            let value = match step {
                Step::Input(k) => input(k),
                Step::Add(a, b) => of(a) + of(b),
                Step::Sub(a, b) => of(a) - of(b),
                Step::Neg(a) => -of(a),
                Step::Mul(a, b) => of(a) * of(b),
                Step::Div(a, b) => defined(of(b) != 0.0, of(a) / of(b)),
                Step::Sqr(a) => of(a) * of(a),
                Step::Sqrt(a) => defined(of(a) > 0.0, of(a).sqrt()),
                Step::Elbow(slots) => {
                    let [a, b, t] = slots.map(of);
                    let both = elbow(&Single, [&a, &b, &t]).unwrap_or([f64::NAN; 2]);
                    second = both[1];
                    both[0]
                }
                Step::ElbowToo => second,
            };
            values.push(value);
        }
        values
    }
}

/// Writes down the operations on what varies.
struct Record<A: Arithmetic> {
    arithmetic: A,
    constants: RefCell<Vec<A::Number>>,
    steps: RefCell<Vec<Step>>,
}

impl<A: Arithmetic> Record<A> {
    fn push(&self, step: Step) -> Slot {
        let mut steps = self.steps.borrow_mut();
        steps.push(step);
        Slot::Step(steps.len() - 1)
    }

    fn constant(&self, x: A::Number) -> Slot {
        let mut constants = self.constants.borrow_mut();
        constants.push(x);
        Slot::Constant(constants.len() - 1)
    }

    /// A step on two slots, or its value where both are constant.
    fn of_two(
        &self,
        slots: [Slot; 2],
        step: Step,
        value: impl Fn(&A, &A::Number, &A::Number) -> Option<A::Number>,
    ) -> Option<Slot> {
        let [Slot::Constant(a), Slot::Constant(b)] = slots else { return Some(self.push(step)) };
        let value = {
            let constants = self.constants.borrow();
            value(&self.arithmetic, constants.get(a)?, constants.get(b)?)?
        };
        Some(self.constant(value))
    }
}

impl<A: Arithmetic> Arithmetic for Record<A> {
    type Number = Slot;

    fn integer(&self, n: i64) -> Option<Slot> {
        Some(self.constant(self.arithmetic.integer(n)?))
    }

    fn add(&self, &a: &Slot, &b: &Slot) -> Option<Slot> {
        self.of_two([a, b], Step::Add(a, b), A::add)
    }

    fn sub(&self, &a: &Slot, &b: &Slot) -> Option<Slot> {
        self.of_two([a, b], Step::Sub(a, b), A::sub)
    }

    fn neg(&self, &a: &Slot) -> Option<Slot> {
        self.of_two([a, a], Step::Neg(a), |own, a, _| own.neg(a))
    }

    fn mul(&self, &a: &Slot, &b: &Slot) -> Option<Slot> {
        self.of_two([a, b], Step::Mul(a, b), A::mul)
    }

    fn div(&self, &a: &Slot, &b: &Slot) -> Option<Slot> {
        self.of_two([a, b], Step::Div(a, b), A::div)
    }

    fn sqr(&self, &a: &Slot) -> Option<Slot> {
        self.of_two([a, a], Step::Sqr(a), |own, a, _| own.sqr(a))
    }

    fn sqrt(&self, &a: &Slot) -> Option<Slot> {
        self.of_two([a, a], Step::Sqrt(a), |own, a, _| own.sqrt(a))
    }

    fn elbow(&self, of: [&Slot; 3]) -> Option<[Slot; 2]> {
        let of = of.map(|&slot| slot);
        if of.iter().any(|slot| matches!(slot, Slot::Step(_))) {
            return Some([Step::Elbow(of), Step::ElbowToo].map(|step| self.push(step)));
        }
        elbow(self, [&of[0], &of[1], &of[2]])
    }
}
