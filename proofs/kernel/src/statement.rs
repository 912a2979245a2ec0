//! A claim in words: what an accepted certificate establishes, and the formulas that it is about.

use crate::certificate::{Failure, Verdict, Witness};
use crate::claim::{Bound, Formulas, JointFormula, Leg, MachineClaim, Mechanism, Quantity};
use crate::claim::{RegionClaim, Requirement, Turning, Workspace};
use crate::formula::{Formula, Op, Tape};
use crate::machine::Joint;
use crate::problem::Problem;
use crate::quantity::TABLE;
use std::fmt::{self, Display, Write};

/// The theorem that an accepted certificate establishes.
///
/// # Errors
/// Only if the formatter fails.
pub fn statement(claim: &MachineClaim, verdict: Verdict) -> Result<String, fmt::Error> {
    let mut out = String::new();
    match verdict {
        Verdict::Certified => writeln!(out, "It is proved:")?,
        Verdict::Refuted => writeln!(out, "It is proved that the following is FALSE:")?,
    }
    machine(&mut out, claim)?;
    workspace(&mut out, claim)?;
    requirements(&mut out, claim)?;
    Ok(out)
}

/// What an accepted region establishes.
///
/// # Errors
/// Only if the formatter fails.
pub fn region(claim: &RegionClaim) -> Result<String, fmt::Error> {
    let RegionClaim { machine: claim, inner, outer } = claim;
    let mut out = String::new();
    writeln!(
        out,
        "Let a point be good if all of the following holds, and bad if some of it fails"
    )?;
    writeln!(out, "whichever of the machines it is.")?;
    machine(&mut out, claim)?;
    workspace(&mut out, claim)?;
    requirements(&mut out, claim)?;
    writeln!(out, "It is proved: of the box's volume, the good points have at least the share")?;
    writeln!(out, "{inner}, and the bad points at least the share {outer}.")?;
    Ok(out)
}

/// "from (..) to (..)", of a box.
pub(crate) fn box_of(claim: &MachineClaim) -> String {
    match &claim.workspace {
        Workspace::Box { min, max } => format!("from ({}) to ({})", list(min), list(max)),
        Workspace::Cylinder { .. } | Workspace::Cube { .. } => String::new(),
    }
}

fn list<T: Display>(items: &[T]) -> String {
    let items: Vec<String> = items.iter().map(ToString::to_string).collect();
    items.join(", ")
}

impl Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Quantity::Exactly(x) => write!(f, "{x}"),
            Quantity::Between { min, max } => write!(f, "in [{min}, {max}]"),
        }
    }
}

pub(crate) fn machine(out: &mut String, claim: &MachineClaim) -> fmt::Result {
    match &claim.mechanism {
        Mechanism::Orthoglide { offset } => {
            writeln!(
                out,
                "For the Orthoglide with guides along the axes and offset e = {offset}, whose"
            )?;
            writeln!(out, "leg length L and corners follow from psi_max (kappa = 1/psi_max,")?;
            writeln!(
                out,
                "t1 = (1 - kappa)/2, t2 = 1 - kappa if kappa <= 1/2 and (1/kappa - 1)/2"
            )?;
            writeln!(out, "otherwise, q1 = -L t1/sqrt(1 + 2 t1^2), q2 = L t2/sqrt(1 + 2 t2^2)),")
        }
        Mechanism::Translational(all) => legs(out, all),
        Mechanism::Planar(Turning { legs: all, .. })
        | Mechanism::Spatial(Turning { legs: all, .. })
        | Mechanism::Spherical(Turning { legs: all, .. }) => legs(out, all),
        Mechanism::Formulas(formulas) => inverse_kinematics(out, formulas),
    }
}

fn legs(out: &mut String, legs: &[Leg]) -> fmt::Result {
    writeln!(out, "For every machine with {} legs, w_i = P + platform - anchor:", legs.len())?;
    for (i, leg) in legs.iter().enumerate() {
        let (drive, mode) = match leg {
            Leg::Slider { mode, .. } => ("slider", Some(*mode)),
            Leg::Strut { .. } => ("strut", None),
            Leg::Arm { mode, .. } => ("arm", Some(*mode)),
            Leg::Planar { .. } => ("planar", None),
        };
        write!(out, "  leg {}: {drive}", i + 1)?;
        for (key, _, quantities) in leg.quantities() {
            match quantities {
                [one] => write!(out, ", {key} {one}")?,
                several => write!(out, ", {key} ({})", list(several))?,
            }
        }
        match mode.map(crate::claim::Sign::as_integer) {
            Some(1) => writeln!(out, ", eta > 0")?,
            Some(_) => writeln!(out, ", eta < 0")?,
            None => writeln!(out)?,
        }
    }
    writeln!(out, "where every interval is taken through independently of all others, directions")?;
    writeln!(
        out,
        "and axes stand for the unit vectors along them, rho_i is the joint coordinate,"
    )?;
    writeln!(
        out,
        "eta_i the leg's component along the motion of its driven end, and M the matrix"
    )?;
    writeln!(out, "with rho' = M P' (the inverse Jacobian),")
}

fn inverse_kinematics(out: &mut String, formulas: &Formulas) -> fmt::Result {
    writeln!(out, "For every mechanism with the coordinates {}", list(&formulas.coordinates))?;
    for (name, quantity) in &formulas.parameters {
        let is = if matches!(quantity, Quantity::Exactly(_)) { " =" } else { "" };
        writeln!(out, "  {name}{is} {quantity}")?;
    }
    for (name, expression) in &formulas.definitions {
        writeln!(out, "  {name} = {expression}")?;
    }
    for (i, joint) in formulas.joints.iter().enumerate() {
        match joint {
            JointFormula::Rho(rho) => writeln!(out, "  rho_{} = {rho}", i + 1)?,
            JointFormula::Row(row) => writeln!(out, "  row {} of M: ({})", i + 1, list(row))?,
        }
    }
    writeln!(
        out,
        "where every interval is taken through independently of all others and M holds the"
    )?;
    writeln!(out, "derivatives of the rho_i by the coordinates,")
}

pub(crate) fn workspace(out: &mut String, claim: &MachineClaim) -> fmt::Result {
    match &claim.workspace {
        Workspace::Box { min, max } => {
            writeln!(out, "at every point of the box from ({}) to ({}),", list(min), list(max))
        }
        Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => writeln!(
            out,
            "at every point with (x - ({x}))^2 + (y - ({y}))^2 <= ({radius})^2, {low} <= z <= {high},"
        ),
        Workspace::Cube { side } => {
            writeln!(out, "at every point of the cube [q1, q2]^3 with q2 - q1 = {side},")
        }
    }
}

pub(crate) fn requirements(out: &mut String, claim: &MachineClaim) -> fmt::Result {
    writeln!(out, "every formula is defined, every leg reaches without a serial singularity,")?;
    writeln!(out, "there is no parallel singularity (M has full column rank), and")?;
    for Requirement { quantity, leg, given, bound } in &claim.require {
        let known = TABLE.iter().find(|known| known.key == quantity);
        let symbol = known.map_or(quantity.as_str(), |known| known.symbol);
        let words = known.map_or("", |known| known.words);
        write!(out, "  {symbol} ")?;
        match bound {
            Bound::Min(bound) => write!(out, ">= {bound}")?,
            Bound::Max(bound) => write!(out, "<= {bound}")?,
            Bound::Holds => write!(out, "holds")?,
            Bound::Within([min, max]) => write!(out, "from {min} to {max}, up to whole turns")?,
        }
        for (name, numbers) in given {
            write!(out, ", {name} = {}", list(numbers))?;
        }
        match leg {
            Some(leg) => writeln!(out, ", leg {leg} ({words});")?,
            None => writeln!(out, " ({words});")?,
        }
    }
    writeln!(out, "psi_i are the inverses of the singular values of M.")
}

/// Where, for which machine and in what a refuted claim fails.
///
/// # Errors
/// Only if the formatter fails.
pub fn counterexample(claim: &MachineClaim, witness: &Witness) -> Result<String, fmt::Error> {
    let mut out = String::new();
    writeln!(out, "It fails at ({})", list(&witness.point))?;
    if let (Ok(problem), false) = (Problem::new(claim), witness.machine.is_empty()) {
        for ((place, _, _), value) in problem.tolerances().zip(&witness.machine) {
            writeln!(out, "  of the machine with {place} = {value}")?;
        }
    }
    match &witness.fails {
        Failure::Reach => writeln!(out, "where a leg does not reach, or is serially singular.")?,
        Failure::Obligation(number, _) | Failure::Row(number, _) => {
            let problem = Problem::new(claim).ok();
            let requirement = problem
                .and_then(|problem| problem.obligations.get(*number)?.requirement)
                .and_then(|number| claim.require.get(number));
            let of = requirement.map_or("freedom from singularities", |r| r.quantity.as_str());
            writeln!(out, "where {of} is violated.")?;
        }
        Failure::Singular(other) => {
            writeln!(out, "and at ({}), where det M has the other sign.", list(other))?;
        }
    }
    Ok(out)
}

/// The formulas of a problem: inputs `p`, coordinates `x`, and, leg by leg, `A`, `D` and `rho`, with
/// what is used more than once named `t`.
///
/// # Errors
/// Only if the formatter fails.
pub fn formulas(problem: &Problem) -> Result<String, fmt::Error> {
    let mut out = String::new();
    writeln!(out, "Lengths are divided by 2^{}.", problem.scale)?;
    for (j, input) in problem.inputs.iter().enumerate() {
        writeln!(out, "p{j} = {}", input.place)?;
    }
    let mut printer = Printer { tape: &problem.tape, out: &mut out, named: Vec::new() };
    for (i, leg) in problem.legs.iter().enumerate() {
        for (k, &a) in leg.row.a.iter().enumerate() {
            printer.line(&format!("A_{}{}", i + 1, k + 1), a)?;
        }
        printer.line(&format!("D_{}", i + 1), leg.row.d)?;
        match leg.rho {
            Some(Joint::Length(rho)) => printer.line(&format!("rho_{}", i + 1), rho)?,
            Some(Joint::Angle { cos, sin }) => {
                printer.line(&format!("cos(rho_{})", i + 1), cos)?;
                printer.line(&format!("sin(rho_{})", i + 1), sin)?;
            }
            None => {}
        }
    }
    Ok(out)
}

/// Prints entries of a tape, each with those that it needs before it.
struct Printer<'a> {
    tape: &'a Tape,
    out: &'a mut String,
    named: Vec<Formula>,
}

impl Printer<'_> {
    fn line(&mut self, name: &str, formula: Formula) -> fmt::Result {
        let text = self.text(formula)?;
        writeln!(self.out, "{name} = {text}")
    }

    /// An operand: itself, or the name of the entry, which is printed first.
    fn text(&mut self, formula: Formula) -> Result<String, fmt::Error> {
        let op = self.tape.op(formula);
        match op {
            Op::Coordinate(k) => return Ok(format!("x{k}")),
            Op::Parameter(j) => return Ok(format!("p{j}")),
            Op::Integer(n) if n < 0 => return Ok(format!("({n})")),
            Op::Integer(n) => return Ok(n.to_string()),
            _ => {}
        }
        if let Some(at) = self.named.iter().position(|&known| known == formula) {
            return Ok(format!("t{at}"));
        }
        let text = match op {
            Op::Add(a, b) => format!("{} + {}", self.text(a)?, self.text(b)?),
            Op::Sub(a, b) => format!("{} - {}", self.text(a)?, self.text(b)?),
            Op::Mul(a, b) => format!("{} {}", self.text(a)?, self.text(b)?),
            Op::Div(a, b) => format!("{}/{}", self.text(a)?, self.text(b)?),
            Op::Neg(a) => format!("-{}", self.text(a)?),
            Op::Sqr(a) => format!("{}^2", self.text(a)?),
            Op::Sqrt(a) => format!("sqrt({})", self.text(a)?),
            Op::Coordinate(_) | Op::Parameter(_) | Op::Integer(_) => return Err(fmt::Error),
        };
        let at = self.named.len();
        self.named.push(formula);
        writeln!(self.out, "t{at} = {text}")?;
        Ok(format!("t{at}"))
    }
}
