//! A claim as formulas, a box, and obligations: what a proof is about.

use crate::cell::Cell;
use crate::claim::{
    Formulas, JointFormula, Kind, Leg, MachineClaim, Mechanism, Quantity, Workspace,
};
use crate::fixed::{Fixed, Integer, Interval};
use crate::formula::{Formula, Op, Tape, Vector};
use crate::machine;
use crate::number::{Expression, Operator};
use crate::quantity::{self, Obligation};
use crate::trig::{cos_sin, pi};
use num_bigint::BigInt;
use num_traits::Signed;
use std::collections::HashMap;
use std::fmt;

/// Bits in which a claim is held to be well formed.
const SIGN_BITS: u32 = 512;
/// Most legs or joints.
pub const MOST_LEGS: usize = 12;

/// Why a claim is not well formed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ClaimError {
    /// A number that cannot be enclosed, or not certainly of the sign it has to have.
    Number {
        /// Where it stands.
        place: String,
        /// What it has to be.
        expected: &'static str,
    },
    /// Something that does not go together.
    Shape {
        /// Where.
        place: String,
        /// What is accepted there.
        expected: &'static str,
    },
}

impl fmt::Display for ClaimError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (ClaimError::Number { place, expected } | ClaimError::Shape { place, expected }) = self;
        write!(f, "{place}: has to be {expected}")
    }
}

impl std::error::Error for ClaimError {}

pub(crate) fn number_error(place: &str, expected: &'static str) -> ClaimError {
    ClaimError::Number { place: place.to_owned(), expected }
}

pub(crate) fn shape_error(place: &str, expected: &'static str) -> ClaimError {
    ClaimError::Shape { place: place.to_owned(), expected }
}

/// A number that formulas depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Where it stands in the claim.
    pub place: String,
    /// Its value, or what is made of it.
    pub value: Value,
    /// Formulas have it divided by `2^scale`.
    pub scale: i64,
}

/// What an input is.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A quantity of the claim.
    Quantity(Quantity),
    /// The cosine of an angle in degrees.
    Cosine(Expression),
    /// The sine of an angle in degrees.
    Sine(Expression),
    /// An angle in degrees, in radians.
    Radians(Expression),
}

/// Numbers of a claim have no names in them.
fn nameless(_: &str) -> Option<Interval<BigInt>> {
    None
}

/// Encloses a number with `bits` fractional bits, after division by `2^scale`.
///
/// It is evaluated with enough bits for 64 to be left after the division, which rounds outward.
fn enclosed(number: &Expression, scale: i64, bits: u32) -> Option<Interval<BigInt>> {
    let guard = 64 + u32::try_from((-scale).max(0)).ok()?;
    let working = bits.checked_add(guard)?;
    let x = number.enclose(&Fixed::new(working), &nameless)?;
    // x / 2^working / 2^scale 2^bits = x / 2^(guard + scale), with guard + scale >= 64.
    let places = i64::from(guard) + scale;
    Some(Interval { lo: x.lo >> places, hi: -(-x.hi >> places) })
}

impl Input {
    /// Encloses it with `bits` fractional bits. `machine` replaces an interval.
    pub fn enclose(&self, bits: u32, machine: Option<&Expression>) -> Option<Interval<BigInt>> {
        let angle = |degrees: &Expression| {
            cos_sin(|bits| degrees.enclose(&Fixed::new(bits), &nameless), bits)
        };
        match &self.value {
            Value::Quantity(Quantity::Exactly(x)) => enclosed(x, self.scale, bits),
            Value::Quantity(Quantity::Between { min, max }) => {
                if let Some(x) = machine {
                    return enclosed(x, self.scale, bits);
                }
                let (min, max) =
                    (enclosed(min, self.scale, bits)?, enclosed(max, self.scale, bits)?);
                Some(Interval { lo: min.lo, hi: max.hi })
            }
            Value::Cosine(degrees) => angle(degrees).map(|[cos, _]| cos),
            Value::Sine(degrees) => angle(degrees).map(|[_, sin]| sin),
            Value::Radians(degrees) => {
                use crate::arithmetic::Arithmetic;
                let fixed = Fixed::<BigInt>::new(bits);
                let x = enclosed(degrees, self.scale, bits)?;
                fixed.div(&fixed.mul(&x, &pi(bits)?)?, &fixed.integer(180)?)
            }
        }
    }
}

/// A claim, compiled.
#[derive(Clone, Debug)]
pub struct Problem {
    /// All formulas.
    pub tape: Tape,
    /// What parameter `j` of the tape is.
    pub inputs: Vec<Input>,
    /// The legs.
    pub legs: Vec<machine::Leg>,
    /// What is to be shown at every point.
    pub obligations: Vec<Obligation>,
    /// The workspace's least and greatest coordinates, divided by `2^scale`.
    pub corners: [Vec<Expression>; 2],
    /// The unit of coordinates is `2^scale`.
    pub scale: i64,
    /// `g(x) >= 0` in the workspace, concave; none of a box.
    pub inside: Option<Inside>,
    /// `kappa = 1/psi_max`, of the paper's cube.
    pub cube_kappa: Option<Formula>,
    /// Whether the least psi asked for is at most `kappa`, as on all of the paper's cube.
    pub cube_has_least: bool,
    /// Quotients and roots of a user's formulas: defined where the claim is true.
    pub partial: Vec<Formula>,
}

/// The workspace's own inequality.
#[derive(Clone, Debug)]
pub struct Inside {
    /// `g`, concave.
    pub g: Formula,
    /// Its derivatives.
    pub gradient: Vec<Formula>,
}

/// What a claim is compiled with.
pub(crate) struct Builder {
    pub tape: Tape,
    pub inputs: Vec<Input>,
    pub scale: i64,
    pub partial: Vec<Formula>,
}

impl Builder {
    /// A quantity of the claim, divided by `2^scale`. Small integers are no inputs.
    pub fn quantity(&mut self, place: &str, quantity: &Quantity, scale: i64) -> Formula {
        if let Quantity::Exactly(x) = quantity {
            if let Some(n) = small(x).filter(|&n| scale == 0 || n == 0) {
                return self.tape.integer(n);
            }
        }
        self.input(place, Value::Quantity(quantity.clone()), scale)
    }

    /// Some other input.
    pub fn input(&mut self, place: &str, value: Value, scale: i64) -> Formula {
        self.inputs.push(Input { place: place.to_owned(), value, scale });
        self.tape.parameter(self.inputs.len() - 1)
    }

    /// A number of the claim, divided by `2^scale`.
    pub fn number(&mut self, place: &str, number: &Expression, scale: i64) -> Formula {
        self.quantity(place, &Quantity::Exactly(number.clone()), scale)
    }

    /// The formulas of a leg's quantities: of directions brought to the order of one, of lengths
    /// divided by `2^scale`.
    fn quantities(&mut self, number: usize, leg: &Leg) -> Result<Vec<Vec<Formula>>, ClaimError> {
        let formulas = |(key, kind, quantities): (&str, Kind, &[Quantity])| {
            let place = format!("leg {}: {key}", number + 1);
            for quantity in quantities {
                let [min, max] = quantity.ends();
                ordered(&place, min, max, matches!(quantity, Quantity::Between { .. }))?;
                if kind == Kind::Length {
                    positive(&place, min)?;
                }
            }
            let scale = match kind {
                Kind::Direction => magnitude(quantities.iter().flat_map(Quantity::ends))
                    .ok_or_else(|| number_error(&place, "a direction"))?,
                Kind::Place | Kind::Length => self.scale,
            };
            let formula = |(k, quantity): (usize, &Quantity)| {
                let place =
                    if quantities.len() == 1 { place.clone() } else { format!("{place}.{k}") };
                self.quantity(&place, quantity, scale)
            };
            Ok(quantities.iter().enumerate().map(formula).collect())
        };
        leg.quantities().into_iter().map(formulas).collect()
    }
}

fn small(x: &Expression) -> Option<i64> {
    match x {
        Expression::Literal { digits, places: 0 } => {
            i64::try_from(digits).ok().filter(|n| n.abs() < 1 << 15)
        }
        Expression::Neg(x) => small(x).map(|n| -n),
        _ => None,
    }
}

/// The exponent of the power of two that is at most the greatest absolute value; 0 if all are zero. A
/// choice of unit, with no effect on what is true.
fn magnitude<'a>(numbers: impl Iterator<Item = &'a Expression>) -> Option<i64> {
    let mut greatest = None;
    for x in numbers {
        let x = x.enclose(&Fixed::new(SIGN_BITS), &nameless)?;
        let bits = x.lo.abs().max(x.hi.abs()).bits();
        if bits > 0 {
            greatest = greatest.max(Some(i64::try_from(bits).ok()? - 1 - i64::from(SIGN_BITS)));
        }
    }
    Some(greatest.unwrap_or(0))
}

/// Whether a number is certainly greater than zero, or not less.
pub(crate) fn sign(x: &Expression) -> Option<[bool; 2]> {
    if let Some(x) = x.rational() {
        return Some([x.is_positive(), !x.is_negative()]);
    }
    let x = x.enclose(&Fixed::new(SIGN_BITS), &nameless)?;
    Some([x.lo.is_positive(), !x.lo.is_negative()])
}

/// `a - b` and the like.
pub(crate) fn binary(operator: Operator, a: &Expression, b: &Expression) -> Expression {
    Expression::Binary(operator, Box::new(a.clone()), Box::new(b.clone()))
}

/// `x > 0`, or an error.
pub(crate) fn positive(place: &str, x: &Expression) -> Result<(), ClaimError> {
    match sign(x) {
        Some([true, _]) => Ok(()),
        _ => Err(number_error(place, "greater than zero")),
    }
}

/// `min <= max`, or, where `strictly`, `min < max`; or an error.
pub(crate) fn ordered(
    place: &str,
    min: &Expression,
    max: &Expression,
    strictly: bool,
) -> Result<(), ClaimError> {
    let [more, not_less] =
        sign(&binary(Operator::Sub, max, min)).ok_or_else(|| number_error(place, "a number"))?;
    if more || (!strictly && (not_less || min == max)) {
        Ok(())
    } else {
        Err(number_error(place, "a range whose end is not before its beginning"))
    }
}

impl Problem {
    /// The problem of a claim.
    ///
    /// # Errors
    /// If the claim is not well formed; that is decided here, before any proof, and at a precision of
    /// its own.
    pub fn new(claim: &MachineClaim) -> Result<Self, ClaimError> {
        let cube = match (&claim.mechanism, &claim.workspace) {
            (Mechanism::Orthoglide { offset }, Workspace::Cube { side }) => {
                Some(Cube::new(claim, offset, side)?)
            }
            (Mechanism::Orthoglide { .. }, _) | (_, Workspace::Cube { .. }) => {
                return Err(shape_error("workspace", "a cube with kind orthoglide, and only then"));
            }
            _ => None,
        };
        let corners = match (&cube, &claim.workspace) {
            (Some(cube), _) => [&cube.q1, &cube.q2].map(|q| vec![q.clone(); 3]),
            (None, workspace) => corners(workspace)?,
        };
        let mut builder =
            Builder { tape: Tape::default(), inputs: Vec::new(), scale: 0, partial: Vec::new() };
        let legs = match (&cube, &claim.mechanism) {
            (Some(cube), _) => built(&mut builder, &cube.legs)?,
            (_, Mechanism::Translational(legs)) => built(&mut builder, legs)?,
            (_, Mechanism::Formulas(formulas)) => by_formulas(&mut builder, formulas)?,
            (None, Mechanism::Orthoglide { .. }) => Vec::new(),
        };
        let m = match &claim.mechanism {
            Mechanism::Formulas(formulas) => formulas.coordinates.len(),
            _ => 3,
        };
        let shape = corners.iter().all(|corner| corner.len() == m);
        if !shape || !(m..=MOST_LEGS).contains(&legs.len()) {
            return Err(shape_error("mechanism", "as many joints as coordinates, or more"));
        }
        let inside = inside(&mut builder, &claim.workspace);
        let mut problem = Problem {
            tape: Tape::default(),
            inputs: Vec::new(),
            legs,
            obligations: Vec::new(),
            corners,
            scale: builder.scale,
            inside,
            cube_has_least: cube.as_ref().zip(quantity::psi_min(claim)).is_some_and(
                |(cube, least)| ordered("transmission", least, &cube.kappa, false).is_ok(),
            ),
            partial: std::mem::take(&mut builder.partial),
            cube_kappa: cube.map(|cube| builder.number("transmission", &cube.kappa, 0)),
        };
        problem.obligations = quantity::obligations(&mut builder, claim, &problem)?;
        problem.tape = builder.tape;
        problem.inputs = builder.inputs;
        problem.constants_are_defined()?;
        Ok(problem)
    }

    /// Whether what depends on no coordinate is defined, for every machine: directions are not zero,
    /// divisors not zero, radicands positive.
    fn constants_are_defined(&self) -> Result<(), ClaimError> {
        let parameters = self.parameters::<BigInt>(SIGN_BITS, &[])?;
        let values = self.tape.run(&Fixed::<BigInt>::new(SIGN_BITS), |op| match op {
            Op::Parameter(j) => parameters.get(j).cloned(),
            _ => None,
        });
        let defined = self.tape.constants().into_iter().all(|f| values.of(f).is_some());
        defined.then_some(()).ok_or_else(|| number_error("mechanism", "defined for every machine"))
    }

    /// The coordinates.
    pub fn dimension(&self) -> usize {
        self.corners[0].len()
    }

    /// The parameters of the tape with `bits` fractional bits; `machine` has the values of those that
    /// are intervals, in their order, or is empty.
    ///
    /// # Errors
    /// If one cannot be enclosed, or `machine` has another length.
    pub fn parameters<Z: Integer>(
        &self,
        bits: u32,
        machine: &[Expression],
    ) -> Result<Vec<Interval<Z>>, ClaimError> {
        let mut machine = machine.iter();
        let enclose = |input: &Input| {
            let value = match &input.value {
                Value::Quantity(Quantity::Between { .. }) => machine.next(),
                _ => None,
            };
            let x = input.enclose(bits, value);
            x.and_then(|x| narrowed(&x)).ok_or_else(|| number_error(&input.place, "a number"))
        };
        self.inputs.iter().map(enclose).collect()
    }

    /// The toleranced inputs, in their order.
    pub fn tolerances(&self) -> impl Iterator<Item = (&str, &Expression, &Expression)> {
        self.inputs.iter().filter_map(|input| match &input.value {
            Value::Quantity(Quantity::Between { min, max }) => Some((&*input.place, min, max)),
            _ => None,
        })
    }

    /// The box of the workspace, rounded outward to `bits` fractional bits.
    ///
    /// # Errors
    /// If a corner cannot be enclosed.
    pub fn root<Z: Integer>(&self, bits: u32) -> Result<Cell<Z>, ClaimError> {
        let [min, max] = &self.corners;
        let edge = |(min, max): (&Expression, &Expression)| {
            let (lo, hi) =
                (enclosed(min, self.scale, bits)?.lo, enclosed(max, self.scale, bits)?.hi);
            narrowed(&Interval { lo, hi })
        };
        let edges = min
            .iter()
            .zip(max)
            .map(|e| edge(e).ok_or_else(|| number_error("workspace", "numbers")));
        edges.collect::<Result<_, _>>().map(Cell)
    }

    /// `q_1` and `q_2` of the paper's cube.
    pub fn tight<Z: Integer>(&self, bits: u32) -> Option<[Interval<Z>; 2]> {
        self.cube_kappa?;
        let of = |corner: &[Expression]| narrowed(&enclosed(corner.first()?, self.scale, bits)?);
        Some([of(&self.corners[0])?, of(&self.corners[1])?])
    }

    /// A point of the workspace in the problem's unit.
    pub(crate) fn point<Z: Integer>(
        &self,
        point: &[Expression],
        bits: u32,
    ) -> Option<Vec<Interval<Z>>> {
        point.iter().map(|x| narrowed(&enclosed(x, self.scale, bits)?)).collect()
    }
}

fn narrowed<Z: Integer>(x: &Interval<BigInt>) -> Option<Interval<Z>> {
    Some(Interval { lo: Z::of(&x.lo)?, hi: Z::of(&x.hi)? })
}

/// The least box about a workspace.
fn corners(workspace: &Workspace) -> Result<[Vec<Expression>; 2], ClaimError> {
    let (min, max) = match workspace {
        Workspace::Box { min, max } => (min.clone(), max.clone()),
        Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => {
            positive("workspace.radius", radius)?;
            let [min, max] = [Operator::Sub, Operator::Add]
                .map(|operator| [x, y].map(|c| binary(operator, c, radius)));
            let with = |[x, y]: [Expression; 2], z: &Expression| vec![x, y, z.clone()];
            (with(min, low), with(max, high))
        }
        Workspace::Cube { .. } => return Err(shape_error("workspace", "a box or a cylinder")),
    };
    if min.len() != max.len() {
        return Err(shape_error("workspace", "as many least as greatest coordinates"));
    }
    for (min, max) in min.iter().zip(&max) {
        ordered("workspace", min, max, false)?;
    }
    Ok([min, max])
}

/// `radius^2 - (x - center_1)^2 - (y - center_2)^2`.
fn inside(builder: &mut Builder, workspace: &Workspace) -> Option<Inside> {
    let Workspace::Cylinder { center, radius, .. } = workspace else { return None };
    let scale = builder.scale;
    let radius = builder.number("workspace.radius", radius, scale);
    let mut g = builder.tape.sqr(radius);
    for (k, center) in center.iter().enumerate() {
        let center = builder.number("workspace.center", center, scale);
        let x = builder.tape.coordinate(k);
        let off = builder.tape.sub(x, center);
        let off = builder.tape.sqr(off);
        g = builder.tape.sub(g, off);
    }
    let gradient = builder.tape.gradient(g, 3).numerators;
    Some(Inside { g, gradient })
}

/// The paper's Steps 1 to 3.
struct Cube {
    kappa: Expression,
    q1: Expression,
    q2: Expression,
    legs: Vec<Leg>,
}

impl Cube {
    fn new(
        claim: &MachineClaim,
        offset: &Expression,
        side: &Expression,
    ) -> Result<Self, ClaimError> {
        use Operator::{Add, Div, Mul, Sub};
        let place = "requirements.transmission";
        let psi = quantity::psi_max(claim)
            .ok_or_else(|| shape_error(place, "a greatest psi, for the paper's cube"))?;
        let one = Expression::integer(1);
        positive("workspace.side", side)?;
        ordered(place, &one, psi, true)?;
        let two = Expression::integer(2);
        let kappa = binary(Div, &one, psi);
        let rest = binary(Sub, &one, &kappa);
        let t1 = binary(Div, &rest, &two);
        let above = sign(&binary(Sub, psi, &two));
        let below = sign(&binary(Sub, &two, psi));
        let t2 = match (above, below) {
            (Some([_, true]), _) => rest,
            (_, Some([_, true])) => binary(Div, &binary(Sub, psi, &one), &two),
            _ => return Err(number_error(place, "told from 2")),
        };
        // sin(beta) = t/sqrt(1 + 2 t^2).
        let sine = |t: &Expression| {
            let square = binary(Mul, &two, &binary(Mul, t, t));
            binary(Div, t, &Expression::Sqrt(Box::new(binary(Add, &one, &square))))
        };
        let (s1, s2) = (sine(&t1), sine(&t2));
        let length = binary(Div, side, &binary(Add, &s1, &s2));
        let q1 = Expression::Neg(Box::new(binary(Mul, &length, &s1)));
        let q2 = binary(Mul, &length, &s2);
        let base = binary(Sub, &binary(Sub, &q1, offset), &length);
        let zero = Expression::integer(0);
        let along = |i: usize, x: &Expression| {
            std::array::from_fn(|k| {
                Quantity::Exactly(if i == k { x.clone() } else { zero.clone() })
            })
        };
        let leg = |i: usize| Leg::Slider {
            direction: along(i, &one),
            anchor: along(i, &base),
            platform: along(i, &Expression::Neg(Box::new(offset.clone()))),
            length: Quantity::Exactly(length.clone()),
            mode: crate::claim::Sign::Plus,
        };
        Ok(Cube { kappa, legs: (0..3).map(leg).collect(), q1, q2 })
    }
}

/// Legs that do not turn the platform. The unit of length is that of the greatest length, or, where
/// no leg has one, coordinate.
fn built(builder: &mut Builder, legs: &[Leg]) -> Result<Vec<machine::Leg>, ClaimError> {
    if legs.len() > MOST_LEGS {
        return Err(shape_error("mechanism.legs", "twelve legs at most"));
    }
    let of_kind = |wanted: Kind| {
        let quantities = legs.iter().flat_map(Leg::quantities);
        let wanted = quantities.filter(move |(_, kind, _)| *kind == wanted);
        magnitude(wanted.flat_map(|(_, _, quantities)| quantities.iter().flat_map(Quantity::ends)))
    };
    let has_length = legs.iter().flat_map(Leg::quantities).any(|(_, kind, _)| kind == Kind::Length);
    let scale = of_kind(if has_length { Kind::Length } else { Kind::Place });
    builder.scale = scale.ok_or_else(|| number_error("mechanism", "numbers"))? + 1;
    legs.iter().enumerate().map(|(number, leg)| built_leg(builder, number, leg)).collect()
}

fn built_leg(builder: &mut Builder, number: usize, leg: &Leg) -> Result<machine::Leg, ClaimError> {
    let formulas = builder.quantities(number, leg)?;
    let tape = &mut builder.tape;
    let p: Vector = std::array::from_fn(|k| tape.coordinate(k));
    let vector = |formulas: &[Formula]| -> Option<Vector> { formulas.try_into().ok() };
    let from_base = |tape: &mut Tape, anchor: &[Formula], platform: &[Formula]| {
        let joint = tape.plus(&p, &vector(platform)?);
        Some(tape.minus(&joint, &vector(anchor)?))
    };
    let mut build = || match (leg, formulas.as_slice()) {
        (Leg::Slider { mode, .. }, [direction, anchor, platform, length]) => {
            let w = from_base(tape, anchor, platform)?;
            let n = tape.normalised(&vector(direction)?);
            Some(machine::slider(tape, &w, &n, *length.first()?, mode.as_integer()))
        }
        (Leg::Strut { .. }, [anchor, platform]) => {
            let w = from_base(tape, anchor, platform)?;
            Some(machine::strut(tape, &w))
        }
        (Leg::Arm { mode, .. }, [axis, reference, anchor, platform, arm, length]) => {
            let w = from_base(tape, anchor, platform)?;
            let k = tape.normalised(&vector(axis)?);
            let reference = vector(reference)?;
            let along = tape.dot(&k, &reference);
            let along = tape.scaled(along, &k);
            let across = tape.minus(&reference, &along);
            let e = tape.normalised(&across);
            let lengths = [*arm.first()?, *length.first()?];
            Some(machine::arm(tape, &w, [&k, &e], lengths, mode.as_integer()))
        }
        (Leg::Planar { .. }, [direction]) => {
            let n = tape.normalised(&vector(direction)?);
            Some(machine::planar(tape, &p, &n))
        }
        _ => None,
    };
    build().ok_or_else(|| shape_error("mechanism.legs", "legs with their quantities"))
}

/// The joints of a mechanism that its user gives.
fn by_formulas(
    builder: &mut Builder,
    formulas: &Formulas,
) -> Result<Vec<machine::Leg>, ClaimError> {
    let mut names: HashMap<&str, Formula> = HashMap::new();
    let m = formulas.coordinates.len();
    if !(1..=crate::slope::MOST_COORDINATES).contains(&m) {
        return Err(shape_error("coordinates", "one to six names"));
    }
    if formulas.joints.len() > MOST_LEGS {
        return Err(shape_error("joints", "twelve at most"));
    }
    let define = |names: &mut HashMap<_, _>, name, formula| match names.insert(name, formula) {
        None => Ok(()),
        Some(_) => Err(shape_error("mechanism", "given names that differ")),
    };
    let named = formulas.parameters.iter().map(|(name, _)| name);
    let named = named.chain(formulas.definitions.iter().map(|(name, _)| name));
    if !named.chain(&formulas.coordinates).all(|name| Expression::is_name(name)) {
        return Err(shape_error("mechanism", "named by letters, digits and _, a letter first"));
    }
    for (k, name) in formulas.coordinates.iter().enumerate() {
        let coordinate = builder.tape.coordinate(k);
        define(&mut names, name.as_str(), coordinate)?;
    }
    for (name, quantity) in &formulas.parameters {
        let [min, max] = quantity.ends();
        ordered(name, min, max, matches!(quantity, Quantity::Between { .. }))?;
        let parameter = builder.quantity(name, quantity, 0);
        define(&mut names, name.as_str(), parameter)?;
    }
    for (name, expression) in &formulas.definitions {
        let formula = compiled(builder, &names, expression)?;
        few(builder)?;
        define(&mut names, name.as_str(), formula)?;
    }
    let joint = |joint: &JointFormula| match joint {
        JointFormula::Rho(rho) => {
            let rho = compiled(builder, &names, rho)?;
            let joint = machine::joint(&mut builder.tape, rho, m);
            few(builder).map(|()| joint)
        }
        JointFormula::Row(row) if row.len() == m => {
            let a = row.iter().map(|x| compiled(builder, &names, x));
            let a = a.collect::<Result<_, _>>()?;
            Ok(machine::row(&mut builder.tape, a))
        }
        JointFormula::Row(_) => Err(shape_error("joints", "rows with an entry a coordinate")),
    };
    formulas.joints.iter().map(joint).collect()
}

/// Most entries of a tape that a user's formulas come to.
const MOST_FORMULAS: usize = 1 << 17;

fn few(builder: &Builder) -> Result<(), ClaimError> {
    if builder.tape.ops().len() > MOST_FORMULAS {
        return Err(shape_error("mechanism", "of fewer operations"));
    }
    Ok(())
}

/// An expression as a formula.
fn compiled(
    builder: &mut Builder,
    names: &HashMap<&str, Formula>,
    expression: &Expression,
) -> Result<Formula, ClaimError> {
    Ok(match expression {
        Expression::Literal { .. } => builder.number("a formula's number", expression, 0),
        Expression::Name(name) => {
            *names.get(name.as_str()).ok_or_else(|| shape_error(name, "a name given before"))?
        }
        Expression::Neg(inner) => {
            let inner = compiled(builder, names, inner)?;
            builder.tape.neg(inner)
        }
        Expression::Binary(operator, left, right) => {
            let (left, right) = (compiled(builder, names, left)?, compiled(builder, names, right)?);
            match operator {
                Operator::Add => builder.tape.add(left, right),
                Operator::Sub => builder.tape.sub(left, right),
                Operator::Mul => builder.tape.mul(left, right),
                Operator::Div => {
                    let quotient = builder.tape.div(left, right);
                    builder.partial.push(quotient);
                    quotient
                }
            }
        }
        Expression::Power(base, n) => {
            let base = compiled(builder, names, base)?;
            let square = builder.tape.sqr(base);
            let even = (1..n / 2).fold(square, |power, _| builder.tape.mul(power, square));
            if n % 2 == 0 {
                even
            } else {
                builder.tape.mul(even, base)
            }
        }
        Expression::Sqrt(inner) => {
            let inner = compiled(builder, names, inner)?;
            let root = builder.tape.sqrt(inner);
            builder.partial.push(root);
            root
        }
    })
}
