//! The table of quantities that a claim may bound: everything that goes through them goes through it.
//!
//! A quantity is a file: its key, its words, and the tests that a bound on it comes to.

mod accuracy;
mod base_joint;
mod clearance;
mod conditioning;
mod constraint_margin;
mod joint_acceleration;
mod joint_force;
mod joint_range;
mod joint_speed;
mod leg_angle;
mod load;
mod one_to_one;
mod parallel_margin;
mod platform_joint;
mod serial_margin;
mod stiffness;
mod transmission;

use crate::claim::{Bound, MachineClaim, Requirement};
use crate::compile::Builder;
use crate::formula::{Formula, Op, Tape};
use crate::input::{magnitude, malformed, positive, ClaimError, Value};
use crate::machine::{motion::Motion, Leg};
use crate::number::Expression;
use crate::test::accuracy::Accuracy;
use crate::test::apart::Apart;
use crate::test::curvature::Curvature;
use crate::test::solve::Solve;
use crate::test::Row;

/// A quantity.
pub struct Quantity {
    /// In claims and designs.
    pub key: &'static str,
    /// In formulas.
    pub symbol: &'static str,
    /// In sentences.
    pub words: &'static str,
    /// The names of what it is for; a requirement gives all of them, and no others.
    pub given: &'static [&'static str],
    /// More of these, where the platform turns.
    pub given_turning: &'static [&'static str],
    tests: Tests,
}

/// What a bound comes to: of the machine as a whole, or of the leg of this number.
enum Tests {
    OfMachine(OfMachine),
    OfLegs(OfLegs),
}

type OfMachine = fn(&mut Context<'_>) -> Result<Vec<Test>, ClaimError>;
type OfLegs = fn(&mut Context<'_>, (usize, &Leg)) -> Result<Vec<Test>, ClaimError>;

impl Quantity {
    const fn with(tests: Tests) -> Self {
        Quantity { key: "", symbol: "", words: "", given: &[], given_turning: &[], tests }
    }

    /// One of the machine.
    const fn of_machine(tests: OfMachine) -> Self {
        Self::with(Tests::OfMachine(tests))
    }

    /// One that every leg has.
    const fn of_legs(tests: OfLegs) -> Self {
        Self::with(Tests::OfLegs(tests))
    }
}

/// All of them, in the order of reports.
pub const TABLE: [&Quantity; 17] = [
    &transmission::TRANSMISSION,
    &joint_range::JOINT_RANGE,
    &conditioning::CONDITIONING,
    &serial_margin::SERIAL_MARGIN,
    &parallel_margin::PARALLEL_MARGIN,
    &leg_angle::LEG_ANGLE,
    &joint_speed::JOINT_SPEED,
    &stiffness::STIFFNESS,
    &joint_acceleration::JOINT_ACCELERATION,
    &joint_force::JOINT_FORCE,
    &load::LOAD,
    &accuracy::ACCURACY,
    &clearance::CLEARANCE,
    &constraint_margin::CONSTRAINT_MARGIN,
    &one_to_one::ONE_TO_ONE,
    &base_joint::BASE_JOINT,
    &platform_joint::PLATFORM_JOINT,
];

/// A test that has to be passed on every cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Test {
    /// `sigma_min(M) >= kappa`, all `D_i > 0`; of `kappa^2`. `kappa = 0`: `sigma_min(M) > 0`.
    SigmaMin(Formula),
    /// `sigma_max(M) <= k`; of `k^2`.
    SigmaMax(Formula),
    /// `sigma_max(M) <= c sigma_min(M)`; of `c^2`.
    Conditioning(Formula),
    /// `f >= 0`.
    AtLeast(Formula),
    /// `f >= b` everywhere, or `f <= -b` everywhere.
    Beyond(Formula, Formula),
    /// `sigma_min >= kappa` of other rows than the machine's; of `kappa^2`, of scaled rows of `w kappa^2`.
    Least(Vec<Row<Formula>>, Formula),
    /// `sigma_max <= k` of these; of `k^2` likewise.
    Greatest(Vec<Row<Formula>>, Formula),
    /// `sym(Y^T A) > 0` at every point, for one `Y`.
    OneToOne(Vec<Row<Formula>>),
    /// `|M^-1 e_i| <= 1/k`.
    Solve(Solve),
    /// One position within `d`.
    Accuracy(Accuracy),
    /// Two segments keep their distance.
    Apart(Apart),
    /// `a |row| + b |H| <= 1`.
    Curvature(Curvature),
}

impl Test {
    /// The rows of its matrix, where these are others than the machine's.
    pub(crate) fn others(&self) -> Option<&[Row<Formula>]> {
        match self {
            Test::Least(rows, _) | Test::Greatest(rows, _) | Test::OneToOne(rows) => Some(rows),
            _ => None,
        }
    }

    /// The formulas of each row of its matrix, the machine's `own` or others, of a bound that is one of another
    /// vertex, or of its sign; none of tests of whole cells.
    pub(crate) fn rows(&self, own: &[Row<Formula>]) -> Vec<Vec<Formula>> {
        let of = |row: &Row<Formula>| row.a.iter().copied().chain([row.d]).collect();
        let rows = self.others().unwrap_or(own).iter().map(of);
        match self {
            Test::SigmaMin(_) | Test::SigmaMax(_) | Test::Conditioning(_) | Test::Solve(_) => {
                rows.collect()
            }
            Test::Least(_, bound) | Test::Greatest(_, bound) => {
                rows.chain([vec![*bound]]).collect()
            }
            Test::AtLeast(f) => vec![vec![*f]],
            Test::Beyond(f, b) => vec![vec![*f, *b]],
            Test::OneToOne(_) | Test::Accuracy(_) | Test::Apart(_) | Test::Curvature(_) => {
                Vec::new()
            }
        }
    }
}

/// What is to be shown at every point of the workspace.
#[derive(Clone, Debug, PartialEq)]
pub struct Obligation {
    /// The requirement, counted from zero; none of freedom from singularities.
    pub requirement: Option<usize>,
    /// The leg, counted from zero.
    pub leg: Option<usize>,
    /// The test.
    pub test: Test,
}

/// What a quantity builds its tests with.
pub(crate) struct Context<'a> {
    builder: &'a mut Builder,
    claim: &'a MachineClaim,
    legs: &'a [Leg],
    motion: &'a Motion,
    weight: Option<Formula>,
    requirement: &'a Requirement,
    place: &'a str,
}

impl<'a> Context<'a> {
    fn tape(&mut self) -> &mut Tape {
        &mut self.builder.tape
    }

    /// The rows for tests of other rows than the machine's, with their weight: scaled, where all legs
    /// have such, and else those of `A`, with 1.
    fn own_rows(&mut self) -> (Vec<Row<Formula>>, Formula) {
        let scaled: Option<Vec<_>> = self.legs.iter().map(|leg| leg.scaled.clone()).collect();
        scaled.zip(self.weight).unwrap_or_else(|| {
            let rows = self.legs.iter().map(|leg| leg.row.clone());
            (rows.collect(), self.builder.tape.integer(1))
        })
    }

    /// A number of the requirement, divided by `2^(units scale)`: `units` of length.
    fn number(&mut self, x: &Expression, units: i64) -> Formula {
        let scale = units * self.builder.scale;
        self.builder.number(self.place, x, scale)
    }

    /// A direction, brought to the order of one.
    fn direction(&mut self, numbers: &[Expression]) -> Result<Vec<Formula>, ClaimError> {
        let scale = magnitude(numbers.iter());
        let scale = scale.ok_or_else(|| malformed(self.place, "a direction"))?;
        Ok(numbers.iter().map(|x| self.builder.number(self.place, x, scale)).collect())
    }

    /// The partial derivatives of a formula; refused where they come to too many operations.
    fn derivatives(&mut self, f: Formula, by: &[Op]) -> Result<Vec<Formula>, ClaimError> {
        self.builder.few_derivatives(f, by.len())?;
        let gradient = self.tape().gradient(f, by);
        self.builder.few()?;
        Ok(gradient.quotients(self.tape()))
    }

    fn input(&mut self, value: Value) -> Formula {
        self.builder.input(self.place, value, 0)
    }

    /// Whether joint coordinates are angles: `M` is then in radians per length.
    fn is_angular(&self) -> bool {
        self.legs.iter().any(|leg| leg.is_angular())
    }

    /// All numbers that the requirement gives by this name.
    fn all_given(&self, name: &str) -> Result<&'a [Expression], ClaimError> {
        match self.requirement.given.get(name) {
            Some(numbers) => Ok(numbers),
            None => self.refused("given what it is for"),
        }
    }

    /// The number that the requirement gives by this name.
    fn given(&self, name: &str) -> Result<&'a Expression, ClaimError> {
        match self.all_given(name)? {
            [number] => Ok(number),
            _ => self.refused("given one number"),
        }
    }

    /// Refuses platforms that turn, where the quantity is another one for them.
    fn without_rotation(&self) -> Result<(), ClaimError> {
        match self.claim.orientation {
            None => Ok(()),
            Some(_) => self.refused("of platforms that do not turn"),
        }
    }

    /// Refuses more joints than coordinates.
    fn not_redundant(&self) -> Result<(), ClaimError> {
        if self.legs.iter().any(|leg| leg.row.a.len() != self.legs.len()) {
            return self.refused("of as many joints as coordinates");
        }
        Ok(())
    }

    fn refused<T>(&self, expected: &'static str) -> Result<T, ClaimError> {
        Err(malformed(self.place, expected))
    }

    /// The number, which has to be greater than zero.
    fn positive(&self, number: &'a Expression) -> Result<&'a Expression, ClaimError> {
        positive(self.place, number).map(|()| number)
    }

    fn least(&self) -> Result<&'a Expression, ClaimError> {
        self.requirement.bound.least().map_or_else(|| self.refused("a least value"), Ok)
    }

    fn greatest(&self) -> Result<&'a Expression, ClaimError> {
        self.requirement.bound.greatest().map_or_else(|| self.refused("a greatest value"), Ok)
    }
}

/// The determinant, by the first row: `sum_j (-1)^j a_0j det(the rows below without column j)`.
pub(crate) fn determinant(tape: &mut Tape, rows: &[Vec<Formula>]) -> Formula {
    let Some((first, below)) = rows.split_first() else { return tape.integer(1) };
    let mut sum = tape.integer(0);
    for (j, &a) in first.iter().enumerate() {
        let without = |row: &Vec<Formula>| {
            let mut row = row.clone();
            row.remove(j);
            row
        };
        let minor: Vec<Vec<Formula>> = below.iter().map(without).collect();
        let minor = determinant(tape, &minor);
        let term = tape.mul(a, minor);
        sum = if j % 2 == 0 { tape.add(sum, term) } else { tape.sub(sum, term) };
    }
    sum
}

/// The least, or the greatest, psi that a claim asks for.
pub(crate) fn psi(
    claim: &MachineClaim,
    of: fn(&Bound) -> Option<&Expression>,
) -> Option<&Expression> {
    let mut own = claim.require.iter().filter(|own| own.quantity == transmission::TRANSMISSION.key);
    own.find_map(|requirement| of(&requirement.bound))
}

/// The obligations of a claim: freedom from singularities first, then requirement by requirement and
/// leg by leg. Every requirement is of a quantity of the table, and none is there twice.
pub(crate) fn obligations(
    builder: &mut Builder,
    claim: &MachineClaim,
    (legs, motion): (&[Leg], &Motion),
) -> Result<Vec<Obligation>, ClaimError> {
    if legs.iter().any(|leg| leg.is_angular()) && !legs.iter().all(|leg| leg.is_angular()) {
        return Err(malformed("mechanism.legs", "arms alone, or none: psi has no unit else"));
    }
    let kept = |requirement: &Requirement| requirement.quantity == clearance::CLEARANCE.key;
    if !claim.bodies.is_empty() && !claim.require.iter().any(kept) {
        return Err(malformed("bodies", "there where a clearance is asked for"));
    }
    let zero = builder.tape.integer(0);
    let mut all = vec![Obligation { requirement: None, leg: None, test: Test::SigmaMin(zero) }];
    for (number, requirement) in claim.require.iter().enumerate() {
        let place = format!("requirement {}: {}", number + 1, requirement.quantity);
        let same = |other: &Requirement| {
            other.quantity == requirement.quantity
                && other.leg == requirement.leg
                && std::mem::discriminant(&other.bound)
                    == std::mem::discriminant(&requirement.bound)
        };
        if claim.require[..number].iter().any(same) {
            return Err(malformed(&place, "there once"));
        }
        let Some(quantity) = TABLE.iter().find(|q| q.key == requirement.quantity) else {
            return Err(malformed(&place, "one of the table of quantities"));
        };
        let turning = if claim.orientation.is_some() { quantity.given_turning } else { &[] };
        let names = quantity.given.iter().chain(turning).copied();
        if !requirement.given.keys().map(String::as_str).eq(names) {
            return Err(malformed(&place, "given what it is for, and nothing else"));
        }
        let weight = motion.turn.as_ref().map(|turn| turn.weight);
        let place = place.as_str();
        let mut context = Context { builder, claim, legs, motion, weight, requirement, place };
        let mut add = |leg: Option<usize>, tests: Vec<Test>| {
            let of = |test| Obligation { requirement: Some(number), leg, test };
            all.extend(tests.into_iter().map(of));
        };
        match (&quantity.tests, requirement.leg.map(|leg| leg.wrapping_sub(1))) {
            (Tests::OfMachine(tests), None) => add(None, tests(&mut context)?),
            (Tests::OfLegs(tests), one) if one.is_none_or(|leg| leg < legs.len()) => {
                for leg in one.map_or(0..legs.len(), |leg| leg..leg + 1) {
                    add(Some(leg), tests(&mut context, (leg, &legs[leg]))?);
                }
            }
            _ => return context.refused("of a leg that there is"),
        }
    }
    // A bound on psi from above is freedom from singularities, and more.
    if let Some(at) = all.iter().skip(1).position(|o| matches!(o.test, Test::SigmaMin(_))) {
        let stronger = all.remove(at + 1);
        all[0] = stronger;
    }
    Ok(all)
}
