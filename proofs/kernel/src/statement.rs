//! A claim in words: what an accepted certificate establishes.

use crate::certificate::{Failure, Verdict, Witness};
use crate::claim::{
    Body, Bound, Formulas, JointFormula, Leg, MachineClaim, Mechanism, Orientation,
};
use crate::claim::{Quantity, Requirement, Turning, Workspace};
use crate::number::Expression;
use crate::paving::{Accepted, Header, Share, Summary};
use crate::problem::Problem;
use crate::quantity::{Obligation, Test, TABLE};
use crate::test::apart::Apart;
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
    orientation(&mut out, claim)?;
    bodies(&mut out, claim)?;
    requirements(&mut out, claim)?;
    Ok(out)
}

/// What an accepted paving establishes.
///
/// # Errors
/// Only if the formatter fails.
pub fn paving(accepted: &Accepted) -> Result<String, fmt::Error> {
    region(&accepted.header, &accepted.summary, "It is proved")
}

/// What is `shown` of the region of a paving.
pub(crate) fn region(
    header: &Header,
    summary: &Summary,
    shown: &str,
) -> Result<String, fmt::Error> {
    let claim = &header.claim;
    let mut out = String::new();
    let (points, of) = match &header.coordinates {
        None => ("the points at which".to_owned(), String::new()),
        Some(own) => {
            // Others have no names in an orientation.
            let is_angle = |name: &String| !matches!(&**name, "x" | "y" | "z");
            let degrees = match claim.orientation.is_some() && own.iter().any(is_angle) {
                true => " with angles in degrees,",
                false => "",
            };
            let own = format!("({})", list(own));
            let others = format!("for all values of the other coordinates,{degrees}");
            (format!("the values of {own} at which, {others}"), format!(" of {own}"))
        }
    };
    writeln!(out, "Let R be the set of {points} all of the following holds.")?;
    machine(&mut out, claim)?;
    workspace(&mut out, claim)?;
    orientation(&mut out, claim)?;
    bodies(&mut out, claim)?;
    requirements(&mut out, claim)?;
    writeln!(out, "The box{of} is cut into boxes that overlap in faces only, of which")?;
    writeln!(out, "  {} lie in R and {} do not meet R;", summary.inner, summary.outer)?;
    writeln!(
        out,
        "  {} are left undecided, or cut by two planes: all points before one lie in R,",
        summary.boundary
    )?;
    writeln!(out, "  none beyond the other does, and what is between is undecided;")?;
    if header.symmetry.is_some() {
        writeln!(
            out,
            "  {} are left out, for R is invariant under permutations of x, y, z, and they hold no",
            summary.mirrored
        )?;
        writeln!(out, "  point with x < y < z;")?;
    }
    writeln!(out, "{shown}: the volume of R is at least the share")?;
    let most = Share(summary.inner_share.0.saturating_add(summary.boundary_share.0));
    writeln!(out, "  {}", summary.inner_share)?;
    writeln!(out, "of the box's volume, and at most the share\n  {most}.")?;
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
        Mechanism::Translational(all) => {
            legs(out, all, "P + platform - anchor")?;
            writeln!(out, "with rho' = M P' (the inverse Jacobian),")
        }
        Mechanism::Planar(turning) => turned(out, turning, "the plane, P = (x, y)", "P"),
        Mechanism::Spatial(turning) => turned(out, turning, "space, P = (x, y, z)", "P"),
        Mechanism::Spherical(turning) => {
            turned(out, turning, "space about the fixed point P = 0", "")
        }
        Mechanism::Formulas(formulas) => inverse_kinematics(out, formulas),
    }
}

/// A platform that may turn: `moves` is its point, if that moves.
fn turned(out: &mut String, turning: &Turning, place: &str, moves: &str) -> fmt::Result {
    let Some(length) = &turning.characteristic_length else {
        writeln!(out, "In {place}:")?;
        legs(out, &turning.legs, "P + platform - anchor")?;
        return writeln!(out, "with rho' = M P' (the inverse Jacobian),");
    };
    writeln!(out, "In {place}, R the rotation of the platform:")?;
    legs(out, &turning.legs, "P + R platform - anchor")?;
    let twist = if moves.is_empty() { "ell omega" } else { "(P', ell omega)" };
    writeln!(out, "with rho' = M {twist} (the inverse Jacobian), omega the platform's")?;
    writeln!(out, "angular velocity in radians, ell = {length},")
}

/// The set of orientations, in words and in the coordinates of the formulas.
fn orientation(out: &mut String, claim: &MachineClaim) -> fmt::Result {
    let range = |[min, max]: &[Expression; 2]| format!("from {min} to {max}");
    let words = match &claim.orientation {
        None => return Ok(()),
        Some(Orientation::Angle(angle)) => format!(
            "rotation R by at most {angle} degrees about any axis (with the coordinates
c = tan(theta/2) axis, |c| <= tan({angle}/2)),"
        ),
        Some(Orientation::Tilt { tilt, torsion }) => format!(
            "R = R_z(a) R_y(b) R_z(s - a), of any a, a tilt b up to {tilt} and a torsion s
from -({torsion}) to {torsion} degrees (with the coordinates c = tan(theta/2) axis,
c_1^2 + c_2^2 <= tan({tilt}/2)^2 (1 + c_3^2), |c_3| <= tan({torsion}/2)),"
        ),
        Some(Orientation::RollPitchYaw { roll, pitch, yaw }) => format!(
            "R = R_z(yaw) R_y(pitch) R_x(roll), roll {}, pitch {},
yaw {} degrees (coordinates: tangents of half of these),",
            range(roll),
            range(pitch),
            range(yaw)
        ),
        Some(Orientation::Range(angle)) => format!(
            "rotation R {} degrees, counterclockwise
(coordinate: the tangent of half of it),",
            range(angle)
        ),
    };
    writeln!(out, "for every {words}")
}

fn legs(out: &mut String, legs: &[Leg], w: &str) -> fmt::Result {
    writeln!(out, "For every machine with {} legs, w_i = {w}:", legs.len())?;
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
                [] => {}
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
    writeln!(out, "eta_i the leg's component along the motion of its driven end, and M the matrix")
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
        Workspace::Box { min, .. } if min.is_empty() => Ok(()),
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

fn bodies(out: &mut String, claim: &MachineClaim) -> fmt::Result {
    for (i, body) in claim.bodies.iter().enumerate() {
        write!(out, "  body {}: all within ", i + 1)?;
        match body {
            Body::Leg { leg, radius, trim: [first, last], offset } => {
                let beside = offset.as_ref().map(|by| format!(" moved by ({})", list(by)));
                let beside = beside.unwrap_or_default();
                writeln!(
                    out,
                    "{radius} of leg {leg}{beside}, from {first} after its base end to {last} before its platform end"
                )?;
            }
            Body::Base { from, to, radius } => {
                writeln!(out, "{radius} of the segment from ({}) to ({})", list(from), list(to))?;
            }
            Body::Platform { from, to, radius } => {
                let at = if claim.orientation.is_some() { "P + R" } else { "P +" };
                let (from, to) = (list(from), list(to));
                writeln!(out, "{radius} of the segment from {at} ({from}) to {at} ({to})")?;
            }
        }
    }
    Ok(())
}

pub(crate) fn requirements(out: &mut String, claim: &MachineClaim) -> fmt::Result {
    writeln!(out, "every formula is defined (roots of positive numbers alone),")?;
    writeln!(out, "every leg reaches without a serial singularity,")?;
    writeln!(out, "there is no parallel singularity (M has full column rank), and")?;
    for Requirement { quantity, leg, given, bound } in &claim.require {
        let known = TABLE.iter().find(|known| known.key == quantity);
        let symbol = known.map_or(quantity.as_str(), |known| known.symbol);
        let words = known.map_or("", |known| known.words);
        write!(out, "  {symbol}")?;
        match bound {
            Bound::Min(bound) => write!(out, " >= {bound}")?,
            Bound::Max(bound) => write!(out, " <= {bound}")?,
            Bound::Holds => {}
            Bound::Within([min, max]) => write!(out, " from {min} to {max}, up to whole turns")?,
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
    if claim.orientation.is_some() {
        writeln!(out, "  (the point, then half-angle tangents)")?;
    }
    if let (Ok(problem), false) = (Problem::new(claim), witness.machine.is_empty()) {
        for ((place, _, _), value) in problem.tolerances().zip(&witness.machine) {
            writeln!(out, "  of the machine with {place} = {value}")?;
        }
    }
    match &witness.fails {
        Failure::Reach => writeln!(out, "where a leg does not reach, or is serially singular.")?,
        Failure::Obligation(number, _) | Failure::Row(number, _) => {
            let problem = Problem::new(claim).ok();
            let obligation = problem.as_ref().and_then(|p| p.obligations.get(*number));
            let requirement = obligation
                .and_then(|obligation| claim.require.get(obligation.requirement?))
                .map_or("freedom from singularities", |r| r.quantity.as_str());
            match obligation {
                Some(Obligation { test: Test::Apart(Apart { bodies: [i, j], .. }), .. }) => {
                    write!(out, "where of body {i} and body {j} {requirement}")?;
                }
                Some(Obligation { leg: Some(leg), .. }) => {
                    write!(out, "where of leg {} {requirement}", leg + 1)?;
                }
                _ => write!(out, "where {requirement}")?,
            }
            writeln!(out, " is violated.")?;
        }
        Failure::Same { least, greatest, .. } => {
            let (least, greatest) = (list(least), list(greatest));
            writeln!(
                out,
                "and some point from ({least}) to ({greatest}) has the same joint coordinates."
            )?;
        }
        Failure::Singular(other) => {
            writeln!(out, "and at ({}), where det M has the other sign.", list(other))?;
        }
        Failure::Dependent => writeln!(out, "where the columns of M are linearly dependent.")?,
    }
    Ok(out)
}
