//! Mechanisms as formulas: legs by their drives, and joints that users give.

use crate::claim::{Formulas, JointFormula, Kind, Leg, Quantity};
use crate::formula::{formula, Formula, Tape, Term};
use crate::input::{magnitude, malformed, ordered, positive, ClaimError, Input, Value};
use crate::machine;
use crate::machine::motion::Motion;
use crate::number::{Expression, Operator};
use std::collections::{HashMap, HashSet};

/// Legs, or joints, as formulas.
type Legs = Result<Vec<machine::Leg>, ClaimError>;
/// What names stand for.
pub(crate) type Names<'a> = HashMap<&'a str, Formula>;

/// Most legs or joints.
pub const MOST_LEGS: usize = 12;

/// What a claim is compiled with.
#[derive(Default)]
pub(crate) struct Builder {
    pub tape: Tape,
    pub inputs: Vec<Input>,
    pub scale: i64,
    pub partial: Vec<Formula>,
    /// The components of directions, of which no name is a part.
    pub directions: Vec<Vec<Formula>>,
    /// Not negative on the paper's cube.
    pub reached: Vec<Formula>,
    /// The formulas of the legs' quantities, leg by leg.
    of_legs: Vec<Vec<Vec<Formula>>>,
}

impl Builder {
    /// A quantity of the claim, divided by `2^scale`. Small integers are no inputs.
    pub fn quantity(&mut self, place: &str, quantity: &Quantity, scale: i64) -> Formula {
        if let Quantity::Exactly(x) = quantity {
            if let Some(n) = small(x).filter(|&n| scale == 0 || n == 0) {
                return self.tape.integer(n);
            }
            if let Some(formula) = self.of_names(place, x, scale) {
                return formula;
            }
        }
        self.input(place, Value::Quantity(quantity.clone()), scale)
    }

    /// A number as a formula of an atlas's names, where it has such: each of these is one input.
    fn of_names(&mut self, place: &str, x: &Expression, scale: i64) -> Option<Formula> {
        let whole = x.varies().then(|| self.compiled(&Names::new(), x).ok())??;
        let unit = self.number(place, &Expression::integer(1), scale);
        self.few().is_ok().then(|| self.tape.mul(whole, unit))
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
                ordered(&place, min, max, quantity.has_width())?;
                if kind == Kind::Length {
                    positive(&place, min)?;
                }
            }
            let scale = match kind {
                Kind::Direction => magnitude(quantities.iter().flat_map(Quantity::ends))
                    .ok_or_else(|| malformed(&place, "a direction"))?,
                Kind::Place | Kind::Length => self.scale,
            };
            let formula = |(k, quantity): (usize, &Quantity)| {
                let place =
                    if quantities.len() == 1 { place.clone() } else { format!("{place}.{k}") };
                self.quantity(&place, quantity, scale)
            };
            let formulas: Vec<Formula> = quantities.iter().enumerate().map(formula).collect();
            let has_names = quantities.iter().flat_map(Quantity::ends).any(Expression::varies);
            if kind == Kind::Direction && !has_names {
                self.directions.push(formulas.clone());
            }
            Ok(formulas)
        };
        leg.quantities().into_iter().map(formulas).collect()
    }

    /// The unit of length is that of the greatest length, or, where no leg has one, coordinate.
    pub fn unit(&mut self, legs: &[Leg]) -> Result<(), ClaimError> {
        if legs.is_empty() {
            return Ok(());
        }
        if legs.len() > MOST_LEGS {
            return Err(malformed("mechanism.legs", "twelve legs at most"));
        }
        let of_kind = |wanted: Kind| {
            let quantities = legs.iter().flat_map(Leg::quantities);
            let wanted = quantities.filter(move |(_, kind, _)| *kind == wanted);
            magnitude(
                wanted.flat_map(|(_, _, quantities)| quantities.iter().flat_map(Quantity::ends)),
            )
        };
        let has_length =
            legs.iter().flat_map(Leg::quantities).any(|(_, kind, _)| kind == Kind::Length);
        let scale = of_kind(if has_length { Kind::Length } else { Kind::Place });
        self.scale = scale.ok_or_else(|| malformed("mechanism", "numbers"))? + 1;
        Ok(())
    }

    /// Legs of a platform that moves so.
    pub fn built(&mut self, motion: &Motion, legs: &[Leg]) -> Legs {
        let quantities = legs.iter().enumerate().map(|(number, leg)| self.quantities(number, leg));
        self.of_legs = quantities.collect::<Result<_, _>>()?;
        self.moved(motion, legs)
    }

    /// The same legs at another pose.
    pub fn moved(&mut self, motion: &Motion, legs: &[Leg]) -> Legs {
        let Builder { tape, of_legs, .. } = self;
        let leg = |(leg, formulas): (_, &Vec<_>)| built_leg(tape, motion, leg, formulas);
        legs.iter().zip(of_legs.iter()).map(leg).collect()
    }

    /// The joints of a mechanism that its user gives.
    pub fn by_formulas(&mut self, formulas: &Formulas) -> Legs {
        let m = formulas.coordinates.len();
        if !(1..=crate::slope::MOST_COORDINATES).contains(&m) {
            return Err(malformed("coordinates", "one to six names"));
        }
        if formulas.joints.len() > MOST_LEGS {
            return Err(malformed("joints", "twelve at most"));
        }
        if !formulas.names().all(Expression::is_name) {
            return Err(malformed("mechanism", "named by letters, digits and _, a letter first"));
        }
        if formulas.names().collect::<HashSet<_>>().len() < formulas.names().count() {
            return Err(malformed("mechanism", "given names that differ"));
        }
        let coordinates = formulas.coordinates.iter().enumerate();
        let mut names: Names<'_> =
            coordinates.map(|(k, name)| (name.as_str(), self.tape.coordinate(k))).collect();
        for (name, quantity) in &formulas.parameters {
            let [min, max] = quantity.ends();
            ordered(name, min, max, quantity.has_width())?;
            names.insert(name, self.quantity(name, quantity, 0));
        }
        for (name, expression) in &formulas.definitions {
            let formula = self.compiled(&names, expression)?;
            self.few()?;
            names.insert(name, formula);
        }
        let joint = |joint: &JointFormula| match joint {
            JointFormula::Rho(rho) => {
                let rho = self.compiled(&names, rho)?;
                self.few_derivatives(rho, m)?;
                let joint = machine::joint(&mut self.tape, rho, m);
                self.few().map(|()| joint)
            }
            JointFormula::Row(row) if row.len() == m => {
                let a = row.iter().map(|x| self.compiled(&names, x)).collect::<Result<_, _>>()?;
                Ok(machine::row(&mut self.tape, a))
            }
            JointFormula::Row(_) => Err(malformed("joints", "rows with an entry a coordinate")),
        };
        formulas.joints.iter().map(joint).collect()
    }

    /// Whether the tape has few entries.
    pub fn few(&self) -> Result<(), ClaimError> {
        fewer(self.tape.ops().len(), MOST_FORMULAS)
    }

    /// Asked before a formula is derived by so many inputs: each of its parts then has as many derivatives.
    pub fn few_derivatives(&self, f: Formula, by: usize) -> Result<(), ClaimError> {
        let parts = self.tape.parts(&[f]).into_iter().filter(|&part| part).count();
        fewer(parts.saturating_mul(by), MOST_DERIVATIVES)
    }

    /// An expression as a formula.
    pub fn compiled(&mut self, names: &Names<'_>, x: &Expression) -> Result<Formula, ClaimError> {
        Ok(match x {
            Expression::Literal { .. } => self.number("a formula's number", x, 0),
            Expression::Varying(range) => {
                let value = Value::Quantity(Quantity::Exactly(x.clone()));
                let same = |input: &Input| input.scale == 0 && input.value == value;
                match self.inputs.iter().position(same) {
                    Some(j) => self.tape.parameter(j),
                    None => self.input(&range.name, value, 0),
                }
            }
            Expression::Name(name) => {
                *names.get(name.as_str()).ok_or_else(|| malformed(name, "a name given before"))?
            }
            Expression::Neg(inner) => {
                let inner = self.compiled(names, inner)?;
                self.tape.neg(inner)
            }
            Expression::Binary(operator, left, right) => {
                let (left, right) = (self.compiled(names, left)?, self.compiled(names, right)?);
                match operator {
                    Operator::Add => self.tape.add(left, right),
                    Operator::Sub => self.tape.sub(left, right),
                    Operator::Mul => self.tape.mul(left, right),
                    Operator::Div => {
                        let quotient = self.tape.div(left, right);
                        self.partial.push(quotient);
                        quotient
                    }
                }
            }
            Expression::Power(base, n) => {
                let base = self.compiled(names, base)?;
                let square = self.tape.sqr(base);
                let even = (1..n / 2).fold(square, |power, _| self.tape.mul(power, square));
                if n % 2 == 0 {
                    even
                } else {
                    self.tape.mul(even, base)
                }
            }
            Expression::Sqrt(inner) => {
                let inner = self.compiled(names, inner)?;
                let root = self.tape.sqrt(inner);
                self.partial.push(root);
                root
            }
        })
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

fn built_leg(
    tape: &mut Tape,
    motion: &Motion,
    leg: &Leg,
    formulas: &[Vec<Formula>],
) -> Result<machine::Leg, ClaimError> {
    let (zero, one) = (tape.integer(0), tape.integer(1));
    let (moves, in_plane) = (!motion.velocity.is_empty(), motion.velocity.len() == 2);
    let vector = |formulas: &[Formula]| match *formulas {
        [x, y, z] if !in_plane => Some([x, y, z]),
        [x, y] if in_plane => Some([x, y, zero]),
        _ => None,
    };
    let mut build = || match (leg, formulas) {
        (Leg::Slider { mode, .. }, [direction, anchor, platform, length]) if moves => {
            let ends = [&vector(anchor)?, &vector(platform)?];
            let (direction, length) = (vector(direction)?, *length.first()?);
            motion.leg(tape, ends, |tape, w| {
                let n = tape.normalised(&direction);
                machine::slider(tape, w, &n, length, mode.as_integer())
            })
        }
        (Leg::Strut { .. }, [anchor, platform, base_axis @ ..]) => {
            let anchor = vector(anchor)?;
            let mut leg = motion.strut(tape, [&anchor, &vector(platform)?]);
            if let (Some(axis), Some(tip)) = (base_axis.first(), leg.tip) {
                let k = tape.normalised(&vector(axis)?);
                let w = formula!(tape; tip - anchor);
                leg.couple = Some(machine::couple(tape, &w, &k));
            }
            Some(leg)
        }
        (Leg::Arm { mode, .. }, [axis, reference, anchor, platform, arm, length]) if moves => {
            let ends = [&vector(anchor)?, &vector(platform)?];
            // In the plane motors turn about +z.
            let up = || axis.is_empty().then_some([zero, zero, one]);
            let axis = if in_plane { up()? } else { vector(axis)? };
            let (reference, lengths) = (vector(reference)?, [*arm.first()?, *length.first()?]);
            motion.leg(tape, ends, |tape, w| {
                let k = tape.normalised(&axis);
                let across = formula!(tape; reference - ((k . reference) * k));
                let e = tape.normalised(&across);
                machine::arm(tape, w, [&k, &e], lengths, mode.as_integer())
            })
        }
        (Leg::Planar { .. }, [direction]) if moves && !in_plane && motion.turn.is_none() => {
            let n = tape.normalised(&vector(direction)?);
            Some(machine::planar(tape, &motion.position, &n))
        }
        _ => None,
    };
    build().ok_or_else(|| malformed("mechanism.legs", "legs with their quantities"))
}

/// Most entries of a tape that a user's formulas come to.
const MOST_FORMULAS: usize = 1 << 14;
/// Most derivatives of one formula and of all that it is made of; by tolerances, of all formulas.
pub(crate) const MOST_DERIVATIVES: usize = 1 << 17;

fn fewer(n: usize, most: usize) -> Result<(), ClaimError> {
    if n > most {
        return Err(malformed("mechanism", "of fewer operations"));
    }
    Ok(())
}
