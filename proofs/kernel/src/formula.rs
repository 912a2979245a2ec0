//! Formulas: operations on earlier entries of a tape.
//!
//! A formula is *defined* at given coordinates and parameters if no divisor is zero and no radicand
//! zero or negative on the way. Equal subformulas are one entry, whoever builds them.
//!
//! **Derivatives.** [`Tape::gradient`] gives the partial derivatives of a formula as a fraction with
//! one denominator for all of them, so that a row of the inverse Jacobian comes as `A_i` and
//! `D_i = E^2` without a division (see [`crate::test`]).

use crate::arithmetic::Arithmetic;
use std::collections::HashMap;

/// An entry of a [`Tape`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Formula(pub(crate) usize);

/// What an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// Coordinate of the workspace, counted from zero.
    Coordinate(usize),
    /// Parameter of the claim, counted from zero.
    Parameter(usize),
    /// An integer.
    Integer(i64),
    /// `a + b`.
    Add(Formula, Formula),
    /// `a - b`.
    Sub(Formula, Formula),
    /// `-a`.
    Neg(Formula),
    /// `a b`.
    Mul(Formula, Formula),
    /// `a / b`.
    Div(Formula, Formula),
    /// `a^2`.
    Sqr(Formula),
    /// `sqrt(a)`.
    Sqrt(Formula),
    /// Of the [`elbow`](crate::arithmetic::elbow) of three, `c`, or, if it says so, `s`.
    Elbow([Formula; 3], bool),
}

impl Op {
    /// The entries it is made of.
    pub(crate) fn parts(self) -> impl Iterator<Item = Formula> {
        let (count, parts) = match self {
            Op::Coordinate(_) | Op::Parameter(_) | Op::Integer(_) => (0, [Formula(0); 3]),
            Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) => (2, [a, b, b]),
            Op::Neg(a) | Op::Sqr(a) | Op::Sqrt(a) => (1, [a; 3]),
            Op::Elbow(of, _) => (3, of),
        };
        parts.into_iter().take(count)
    }
}

/// Sums and products of integers up to this are integers of a tape.
fn is_small(n: i64) -> bool {
    n.unsigned_abs() < 1 << 15
}

/// The first `m` coordinates.
pub fn coordinates(m: usize) -> Vec<Op> {
    (0..m).map(Op::Coordinate).collect()
}

/// A vector of formulas.
pub type Vector = [Formula; 3];

/// A formula, or a vector of formulas, of which operations are those of the components.
pub(crate) trait Term: Copy {
    /// `of` the components of both.
    fn with(self, other: Self, of: impl FnMut(Formula, Formula) -> Formula) -> Self;
}

impl Term for Formula {
    fn with(self, other: Self, mut of: impl FnMut(Formula, Formula) -> Formula) -> Self {
        of(self, other)
    }
}

impl Term for Vector {
    fn with(self, other: Self, mut of: impl FnMut(Formula, Formula) -> Formula) -> Self {
        std::array::from_fn(|k| of(self[k], other[k]))
    }
}

/// Puts a formula on a tape as it is written, `formula!(tape; (n . w) - (m * (sqrt d)))`: in parentheses whatever is
/// part of another operation, in braces what is no name; of vectors sums, differences, multiples, quotients by a
/// formula, and products `u . v`.
macro_rules! formula {
    ($tape:ident; ($($all:tt)+)) => { formula!($tape; $($all)+) };
    ($tape:ident; { $x:expr }) => { $x };
    ($tape:ident; $x:ident) => { $x.to_owned() };
    ($tape:ident; $n:literal) => { $tape.integer($n) };
    ($tape:ident; sqrt $a:tt) => {{ let a = formula!($tape; $a); $tape.sqrt(a) }};
    ($tape:ident; $a:tt ^ 2) => {{ let a = formula!($tape; $a); $tape.sqr(a) }};
    ($tape:ident; $a:tt $op:tt $b:tt) => {{
        let (a, b) = (formula!($tape; $a), formula!($tape; $b));
        formula!(@ $tape, a $op b)
    }};
    (@ $tape:ident, $a:ident + $b:ident) => { $a.with($b, |a, b| $tape.add(a, b)) };
    (@ $tape:ident, $a:ident - $b:ident) => { $a.with($b, |a, b| $tape.sub(a, b)) };
    (@ $tape:ident, $a:ident * $b:ident) => { $b.with($b, |b, _| $tape.mul($a, b)) };
    (@ $tape:ident, $a:ident / $b:ident) => { $a.with($a, |a, _| $tape.div(a, $b)) };
    (@ $tape:ident, $a:ident . $b:ident) => { $tape.dot(&$a, &$b) };
}
pub(crate) use formula;

/// Formulas that share their parts.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    ops: Vec<Op>,
    known: HashMap<Op, Formula>,
}

/// Partial derivatives, `numerators[k] / denominator`.
#[derive(Clone, Debug)]
pub struct Gradient {
    /// One for each input by which it is derived.
    pub numerators: Vec<Formula>,
    /// A product of divisors and roots of the formula: not zero where it is defined.
    pub denominator: Formula,
}

impl Gradient {
    /// The derivatives themselves; the entry 0 stays.
    pub fn quotients(&self, tape: &mut Tape) -> Vec<Formula> {
        let zero = tape.integer(0);
        let each = |&n: &Formula| if n == zero { n } else { tape.div(n, self.denominator) };
        self.numerators.iter().map(each).collect()
    }
}

impl Tape {
    /// The operations, each on earlier ones.
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// The operation of an entry.
    pub fn op(&self, formula: Formula) -> Op {
        self.ops[formula.0]
    }

    fn push(&mut self, op: Op) -> Formula {
        let next = Formula(self.ops.len());
        let formula = *self.known.entry(op).or_insert(next);
        if formula == next {
            self.ops.push(op);
        }
        formula
    }

    /// Coordinate `k`.
    pub fn coordinate(&mut self, k: usize) -> Formula {
        self.push(Op::Coordinate(k))
    }

    /// Parameter `j`.
    pub fn parameter(&mut self, j: usize) -> Formula {
        self.push(Op::Parameter(j))
    }

    /// The integer `n`.
    pub fn integer(&mut self, n: i64) -> Formula {
        self.push(Op::Integer(n))
    }

    fn is(&self, formula: Formula, n: i64) -> bool {
        self.op(formula) == Op::Integer(n)
    }

    /// `a + b`.
    pub fn add(&mut self, a: Formula, b: Formula) -> Formula {
        match (self.op(a), self.op(b)) {
            (Op::Integer(0), _) => b,
            (_, Op::Integer(0)) => a,
            (Op::Integer(n), Op::Integer(m)) if is_small(n) && is_small(m) => self.integer(n + m),
            _ => self.push(Op::Add(a, b)),
        }
    }

    /// `a - b`; of a coordinate, which is defined everywhere, less itself, 0.
    pub fn sub(&mut self, a: Formula, b: Formula) -> Formula {
        match (self.is(a, 0), self.is(b, 0)) {
            (_, true) => a,
            (true, _) => self.neg(b),
            _ if a == b && matches!(self.op(a), Op::Coordinate(_)) => self.integer(0),
            _ => self.push(Op::Sub(a, b)),
        }
    }

    /// `-a`.
    pub fn neg(&mut self, a: Formula) -> Formula {
        match self.op(a) {
            Op::Integer(n) if is_small(n) => self.integer(-n),
            Op::Neg(b) => b,
            _ => self.push(Op::Neg(a)),
        }
    }

    /// `a b`.
    pub fn mul(&mut self, a: Formula, b: Formula) -> Formula {
        match (self.op(a), self.op(b)) {
            (Op::Integer(0), _) | (_, Op::Integer(1)) => a,
            (_, Op::Integer(0)) | (Op::Integer(1), _) => b,
            _ if a == b => self.sqr(a),
            _ => self.push(Op::Mul(a, b)),
        }
    }

    /// `a / b`.
    pub fn div(&mut self, a: Formula, b: Formula) -> Formula {
        if self.is(b, 1) {
            return a;
        }
        self.push(Op::Div(a, b))
    }

    /// `a^2`.
    pub fn sqr(&mut self, a: Formula) -> Formula {
        match self.op(a) {
            Op::Integer(n) if is_small(n) => self.integer(n * n),
            _ => self.push(Op::Sqr(a)),
        }
    }

    /// `(a - b)^2`, expanded.
    pub fn expanded(&mut self, a: Formula, b: Formula) -> Formula {
        formula!(self; ((a ^ 2) - ((2 * b) * a)) + (b ^ 2))
    }

    /// `a^2` without the roots that are factors of `a`: the same number where `a` is defined, and
    /// with better slopes. Each factor is squared once, however often it is one.
    pub fn square_without_roots(&mut self, a: Formula) -> Formula {
        let mut is_factor = vec![false; a.0 + 1];
        is_factor[a.0] = true;
        for k in (0..=a.0).rev() {
            match self.ops[k] {
                Op::Neg(b) if is_factor[k] => is_factor[b.0] = true,
                Op::Mul(b, c) if is_factor[k] => (is_factor[b.0], is_factor[c.0]) = (true, true),
                _ => {}
            }
        }
        let mut squares = vec![a; a.0 + 1];
        for k in 0..=a.0 {
            if is_factor[k] {
                squares[k] = match self.ops[k] {
                    Op::Sqrt(radicand) => radicand,
                    Op::Neg(b) => squares[b.0],
                    Op::Mul(b, c) => self.mul(squares[b.0], squares[c.0]),
                    _ => self.sqr(Formula(k)),
                };
            }
        }
        squares[a.0]
    }

    /// `sqrt(a)`.
    pub fn sqrt(&mut self, a: Formula) -> Formula {
        if self.is(a, 1) {
            return a;
        }
        self.push(Op::Sqrt(a))
    }

    /// The [`elbow`](crate::arithmetic::elbow) of three.
    pub fn elbow(&mut self, of: [Formula; 3]) -> [Formula; 2] {
        [false, true].map(|second| self.push(Op::Elbow(of, second)))
    }

    /// `u . v`.
    pub fn dot(&mut self, u: &Vector, v: &Vector) -> Formula {
        let [x, y, z] = std::array::from_fn(|k| self.mul(u[k], v[k]));
        let sum = self.add(x, y);
        self.add(sum, z)
    }

    /// `u x v`.
    pub fn cross(&mut self, u: &Vector, v: &Vector) -> Vector {
        std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (a, b) = (self.mul(u[j], v[k]), self.mul(u[k], v[j]));
            self.sub(a, b)
        })
    }

    /// `u / |u|`.
    pub fn normalised(&mut self, u: &Vector) -> Vector {
        formula!(self; u / (sqrt (u . u)))
    }

    /// The values of all entries; of an entry that is undefined, or depends on one, `None`.
    pub fn run<A: Arithmetic>(
        &self,
        arithmetic: &A,
        coordinate: impl Fn(usize) -> Option<A::Number>,
        parameter: impl Fn(usize) -> Option<A::Number>,
    ) -> Values<A::Number> {
        self.run_parts(arithmetic, (None, &Values::default()), coordinate, parameter)
    }

    /// The same of those that are needed alone, where it is said which: the others are undefined. What is
    /// known is as it would be found.
    pub fn run_parts<A: Arithmetic>(
        &self,
        arithmetic: &A,
        (needed, known): (Option<&[bool]>, &Values<A::Number>),
        coordinate: impl Fn(usize) -> Option<A::Number>,
        parameter: impl Fn(usize) -> Option<A::Number>,
    ) -> Values<A::Number> {
        let ops = needed.map_or(&self.ops[..], |needed| &self.ops[..needed.len()]);
        let mut values = Values(Vec::with_capacity(ops.len()));
        // Of the last elbow its two entries, which are found together.
        let mut elbow = ([Formula(usize::MAX); 3], None);
        for (at, &op) in ops.iter().enumerate() {
            if needed.is_some_and(|needed| !needed[at]) {
                values.0.push(None);
                continue;
            }
            let (own, at) = (Formula(at), |f: Formula| values.of(f));
            let both = |a, b| Some((at(a)?, at(b)?));
            let value = match op {
                _ if known.of(own).is_some() => known.of(own).cloned(),
                Op::Coordinate(k) => coordinate(k),
                Op::Parameter(j) => parameter(j),
                Op::Integer(n) => arithmetic.integer(n),
                Op::Add(a, b) => both(a, b).and_then(|(a, b)| arithmetic.add(a, b)),
                Op::Sub(a, b) => both(a, b).and_then(|(a, b)| arithmetic.sub(a, b)),
                Op::Neg(a) => at(a).and_then(|a| arithmetic.neg(a)),
                Op::Mul(a, b) => both(a, b).and_then(|(a, b)| arithmetic.mul(a, b)),
                Op::Div(a, b) => both(a, b).and_then(|(a, b)| arithmetic.div(a, b)),
                Op::Sqr(a) => at(a).and_then(|a| arithmetic.sqr(a)),
                Op::Sqrt(a) => at(a).and_then(|a| arithmetic.sqrt(a)),
                Op::Elbow(of, second) => {
                    if elbow.0 != of {
                        let found = || arithmetic.elbow([at(of[0])?, at(of[1])?, at(of[2])?]);
                        elbow = (of, found());
                    }
                    elbow.1.as_ref().map(|both| both[usize::from(second)].clone())
                }
            };
            values.0.push(value);
        }
        values
    }

    /// The entries that depend on no coordinate.
    pub fn constants(&self) -> Vec<Formula> {
        let mut constant: Vec<bool> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let is = |f: Formula| constant.get(f.0).is_some_and(|&is| is);
            constant.push(!matches!(op, Op::Coordinate(_)) && op.parts().all(is));
        }
        (0..self.ops.len()).filter(|&at| constant[at]).map(Formula).collect()
    }

    /// Of each entry, whether one of these is made of it.
    pub fn parts(&self, of: &[Formula]) -> Vec<bool> {
        let mut needed = vec![false; of.iter().map(|f| f.0 + 1).max().unwrap_or(0)];
        of.iter().for_each(|f| needed[f.0] = true);
        for at in (0..needed.len()).rev() {
            if needed[at] {
                self.ops[at].parts().for_each(|part| needed[part.0] = true);
            }
        }
        needed
    }

    /// The partial derivatives of `f` by coordinates and parameters, or by other entries, of which `f` is
    /// then taken as a function, all else held.
    ///
    /// With `f' = N/E` and `g' = K/F`:
    ///
    /// ```text
    /// (f +- g)' = (N F +- K E)/(E F)        (f g)' = (g N F + f K E)/(E F)       (f^2)' = 2 f N/E
    /// (f/g)'    = (N F - (f/g) K E)/(E F g)                       (sqrt f)' = N/(2 E sqrt f)
    /// (c, s)'   = (-s, c) (2 (a - c) a' + 2 (b - s) b' - t')/(2 (b c - a s))       of an elbow
    /// ```
    ///
    /// where the cross factors are left out if `E = F`. Those of an elbow are the limit of its slopes.
    pub fn gradient(&mut self, f: Formula, by: &[Op]) -> Gradient {
        self.differentiated(f, by, false)
    }

    /// The same, each quotient taken where it arises, so that all denominators are 1: cross factors, which
    /// stand above and below, widen ranges.
    pub fn derivatives(&mut self, f: Formula, by: &[Op]) -> Vec<Formula> {
        self.differentiated(f, by, true).numerators
    }

    fn differentiated(&mut self, f: Formula, by: &[Op], at_once: bool) -> Gradient {
        let (zero, one) = (self.integer(0), self.integer(1));
        let needed = self.parts(&[f]);
        let unneeded = Gradient { numerators: Vec::new(), denominator: one };
        let mut known: Vec<Gradient> = Vec::with_capacity(f.0 + 1);
        for (at, needed) in needed.into_iter().enumerate() {
            let gradient = match self.ops[at] {
                _ if !needed => unneeded.clone(),
                own if by.contains(&own) => {
                    let entry = |&by: &Op| if by == own { one } else { zero };
                    Gradient { numerators: by.iter().map(entry).collect(), denominator: one }
                }
                Op::Coordinate(_) | Op::Parameter(_) | Op::Integer(_) => {
                    Gradient { numerators: vec![zero; by.len()], denominator: one }
                }
                Op::Add(a, b) => self.combined((&known[a.0], one), (&known[b.0], one)),
                Op::Sub(a, b) => {
                    let minus = self.integer(-1);
                    self.combined((&known[a.0], one), (&known[b.0], minus))
                }
                Op::Neg(a) => {
                    let Gradient { numerators, denominator } = &known[a.0];
                    let numerators = numerators.iter().map(|&n| self.neg(n)).collect();
                    Gradient { numerators, denominator: *denominator }
                }
                Op::Mul(a, b) => self.combined((&known[a.0], b), (&known[b.0], a)),
                Op::Div(a, b) => {
                    let quotient = self.neg(Formula(at));
                    let whole = self.combined((&known[a.0], one), (&known[b.0], quotient));
                    self.divided(whole, b)
                }
                Op::Elbow([a, b, t], second) => {
                    let [c, s] = self.elbow([a, b, t]);
                    let (p, q) = (self.sub(a, c), self.sub(b, s));
                    let (two, minus) = (self.integer(2), self.integer(-1));
                    let along = self.combined((&known[a.0], p), (&known[b.0], q));
                    let mut whole = self.combined((&along, two), (&known[t.0], minus));
                    let by = if second { c } else { self.neg(s) };
                    whole.numerators.iter_mut().for_each(|n| *n = self.mul(by, *n));
                    let across = formula!(self; 2 * ((b * c) - (a * s)));
                    self.divided(whole, across)
                }
                Op::Sqr(a) => {
                    let factor = formula!(self; 2 * a);
                    let Gradient { numerators, denominator } = &known[a.0];
                    let numerators = numerators.iter().map(|&n| self.mul(factor, n)).collect();
                    Gradient { numerators, denominator: *denominator }
                }
                Op::Sqrt(a) => {
                    let Gradient { numerators, denominator } = known[a.0].clone();
                    if numerators.iter().all(|&n| n == zero) {
                        Gradient { numerators, denominator: one }
                    } else {
                        let factor = formula!(self; 2 * { Formula(at) });
                        Gradient { numerators, denominator: self.mul(denominator, factor) }
                    }
                }
            };
            known.push(match at_once {
                true => Gradient { numerators: gradient.quotients(self), denominator: one },
                false => gradient,
            });
        }
        known.swap_remove(f.0)
    }

    /// `f'/b`.
    fn divided(&mut self, mut f: Gradient, b: Formula) -> Gradient {
        if !f.numerators.iter().all(|&n| self.is(n, 0)) {
            f.denominator = self.mul(f.denominator, b);
        }
        f
    }

    /// `p f' + q g'`.
    fn combined(&mut self, (f, p): (&Gradient, Formula), (g, q): (&Gradient, Formula)) -> Gradient {
        let (e, d) = (f.denominator, g.denominator);
        let (across_f, across_g, denominator) =
            if e == d { (p, q, e) } else { (self.mul(p, d), self.mul(q, e), self.mul(e, d)) };
        let sum = |(n, k): (&Formula, &Formula)| formula!(self; (across_f * n) + (across_g * k));
        let numerators = f.numerators.iter().zip(&g.numerators).map(sum).collect();
        Gradient { numerators, denominator }
    }
}

/// The values of a tape's entries, where they are defined.
#[derive(Clone, Debug)]
pub struct Values<N>(Vec<Option<N>>);

impl<N> Default for Values<N> {
    fn default() -> Self {
        Values(Vec::new())
    }
}

impl<N> Values<N> {
    /// The value of a formula of the tape; `None` where it is undefined.
    pub fn of(&self, formula: Formula) -> Option<&N> {
        self.0.get(formula.0)?.as_ref()
    }
}
