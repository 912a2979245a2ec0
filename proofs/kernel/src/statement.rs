//! A claim in words: what an accepted certificate establishes.

use crate::certificate::{Failure, Verdict, Witness};
use crate::claim::{
    Body, Bound, Formulas, JointFormula, Leg, MachineClaim, Mechanism, Orientation,
};
use crate::claim::{Quantity, Requirement, Sign, Turning, Workspace};
use crate::number::Expression;
use crate::paving::{Accepted, Header, Share, Summary};
use crate::problem::Problem;
use crate::quantity::{Obligation, Test, TABLE};
use crate::test::apart::Apart;
use std::fmt::{self, Display};

/// The theorem that an accepted certificate establishes.
pub fn statement(claim: &MachineClaim, verdict: Verdict) -> String {
    let proved = match verdict {
        Verdict::Certified => "It is proved:",
        Verdict::Refuted => "It is proved that the following is FALSE:",
    };
    format!("{proved}\n{}", holds(claim, &workspace(claim)))
}

/// All that is claimed, at these points.
pub(crate) fn holds(claim: &MachineClaim, points: &str) -> String {
    let (machine, orientation) = (machine(&claim.mechanism), orientation(claim));
    [&machine, points, &orientation, &bodies(claim), &requirements(claim)].concat()
}

/// What an accepted paving establishes.
pub fn paving(accepted: &Accepted) -> String {
    region(&accepted.header, &accepted.summary, "It is proved")
}

/// What is `shown` of the region of a paving.
pub(crate) fn region(header: &Header, summary: &Summary, shown: &str) -> String {
    let claim = &header.claim.machine;
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
    let Summary { inner, outer, boundary, mirrored, inner_share, boundary_share, .. } = summary;
    let left_out = match header.symmetry {
        None => String::new(),
        Some(_) => format!(
            "  {mirrored} are left out, for R is invariant under permutations of x, y, z, and they hold no
  point with x < y < z;
"
        ),
    };
    let all = holds(claim, &workspace(claim));
    let most = Share(inner_share.0.saturating_add(boundary_share.0));
    format!(
        "\
Let R be the set of {points} all of the following holds.
{all}The box{of} is cut into boxes that overlap in faces only, of which
  {inner} lie in R and {outer} do not meet R;
  {boundary} are left undecided, or cut by two planes: all points before one lie in R,
  none beyond the other does, and what is between is undecided;
{left_out}{shown}: the volume of R is at least the share
  {inner_share}
of the box's volume, and at most the share
  {most}.
"
    )
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

/// A line for each, with its number from one.
fn lines<T>(items: &[T], line: impl Fn(usize, &T) -> String) -> String {
    items.iter().zip(1..).map(|(item, i)| line(i, item) + "\n").collect()
}

impl Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Quantity::Exactly(x) => write!(f, "{x}"),
            Quantity::Between { min, max } => write!(f, "in [{min}, {max}]"),
        }
    }
}

fn machine(mechanism: &Mechanism) -> String {
    match mechanism {
        Mechanism::Orthoglide { offset } => format!(
            "\
For the Orthoglide with guides along the axes and offset e = {offset}, whose
leg length L and corners follow from psi_max (kappa = 1/psi_max,
t1 = (1 - kappa)/2, t2 = 1 - kappa if kappa <= 1/2 and (1/kappa - 1)/2
otherwise, q1 = -L t1/sqrt(1 + 2 t1^2), q2 = L t2/sqrt(1 + 2 t2^2)),
"
        ),
        Mechanism::Translational(all) => still(all),
        Mechanism::Planar(turning) => turned(turning, "the plane, P = (x, y)", "(P', ell omega)"),
        Mechanism::Spatial(turning) => turned(turning, "space, P = (x, y, z)", "(P', ell omega)"),
        Mechanism::Spherical(turning) => {
            turned(turning, "space about the fixed point P = 0", "ell omega")
        }
        Mechanism::Formulas(formulas) => inverse_kinematics(formulas),
    }
}

/// A platform that may turn, with its twist.
fn turned(turning: &Turning, place: &str, twist: &str) -> String {
    let Some(length) = &turning.characteristic_length else {
        return format!("In {place}:\n{}", still(&turning.legs));
    };
    let legs = legs(&turning.legs, "P + R platform - anchor");
    format!(
        "\
In {place}, R the rotation of the platform:
{legs}with rho' = M {twist} (the inverse Jacobian), omega the platform's
angular velocity in radians, ell = {length},
"
    )
}

/// Legs of a platform that does not turn.
fn still(all: &[Leg]) -> String {
    legs(all, "P + platform - anchor") + "with rho' = M P' (the inverse Jacobian),\n"
}

/// The set of orientations, in words and in the coordinates of the formulas.
fn orientation(claim: &MachineClaim) -> String {
    let range = |[min, max]: &[Expression; 2]| format!("from {min} to {max}");
    let words = match &claim.orientation {
        None => return String::new(),
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
    format!("for every {words}\n")
}

fn legs(legs: &[Leg], w: &str) -> String {
    let of_leg = |i: usize, leg: &Leg| {
        let (drive, mode) = match leg {
            Leg::Slider { mode, .. } => ("slider", Some(*mode)),
            Leg::Strut { .. } => ("strut", None),
            Leg::Arm { mode, .. } => ("arm", Some(*mode)),
            Leg::Planar { .. } => ("planar", None),
        };
        let quantities = leg.quantities().into_iter().map(|(key, _, own)| match own {
            [] => String::new(),
            [one] => format!(", {key} {one}"),
            several => format!(", {key} ({})", list(several)),
        });
        let sign = match mode {
            Some(Sign::Plus) => ", eta > 0",
            Some(Sign::Minus) => ", eta < 0",
            None => "",
        };
        format!("  leg {i}: {drive}{}{sign}", quantities.collect::<String>())
    };
    format!(
        "\
For every machine with {} legs, w_i = {w}:
{}where every interval is taken through independently of all others, directions
and axes stand for the unit vectors along them, rho_i is the joint coordinate,
eta_i the leg's component along the motion of its driven end, and M the matrix
",
        legs.len(),
        lines(legs, of_leg)
    )
}

fn inverse_kinematics(formulas: &Formulas) -> String {
    let Formulas { coordinates, parameters, definitions, joints } = formulas;
    let parameters = lines(parameters, |_, (name, quantity)| match quantity {
        Quantity::Exactly(x) => format!("  {name} = {x}"),
        Quantity::Between { .. } => format!("  {name} {quantity}"),
    });
    let definitions =
        lines(definitions, |_, (name, expression)| format!("  {name} = {expression}"));
    let joints = lines(joints, |i, joint| match joint {
        JointFormula::Rho(rho) => format!("  joint {i}: rho_{i} = {rho}"),
        JointFormula::Row(row) => format!("  row {i} of M: ({})", list(row)),
    });
    let coordinates = list(coordinates);
    format!(
        "\
For every mechanism with the coordinates {coordinates}
{parameters}{definitions}{joints}\
where every interval is taken through independently of all others and M holds the
derivatives of the rho_i by the coordinates,
"
    )
}

pub(crate) fn workspace(claim: &MachineClaim) -> String {
    match &claim.workspace {
        Workspace::Box { min, .. } if min.is_empty() => String::new(),
        Workspace::Box { .. } => format!("at every point of the box {},\n", box_of(claim)),
        Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => format!(
            "at every point with (x - ({x}))^2 + (y - ({y}))^2 <= ({radius})^2, {low} <= z <= {high},\n"
        ),
        Workspace::Cube { side } => {
            format!("at every point of the cube [q1, q2]^3 with q2 - q1 = {side},\n")
        }
    }
}

fn bodies(claim: &MachineClaim) -> String {
    let segment = |from: &[_], to: &[_], at: &str| {
        format!("the segment from {at}({}) to {at}({})", list(from), list(to))
    };
    lines(&claim.bodies, |i, body| {
        let (radius, of) = match body {
            Body::Leg { leg, radius, trim: [first, last], offset } => {
                let beside = offset.as_ref().map(|by| format!(" moved by ({})", list(by)));
                let beside = beside.unwrap_or_default();
                let ends = format!("{first} after its base end to {last} before its platform end");
                (radius, format!("leg {leg}{beside}, from {ends}"))
            }
            Body::Base { from, to, radius } => (radius, segment(from, to, "")),
            Body::Platform { from, to, radius } => {
                let at = if claim.orientation.is_some() { "P + R " } else { "P + " };
                (radius, segment(from, to, at))
            }
        };
        format!("  body {i}: all within {radius} of {of}")
    })
}

fn requirements(claim: &MachineClaim) -> String {
    let all = lines(&claim.require, |_, Requirement { quantity, leg, given, bound }| {
        let known = TABLE.iter().find(|known| known.key == quantity);
        let (symbol, words) = known.map_or((&**quantity, ""), |known| (known.symbol, known.words));
        let bound = match bound {
            Bound::Min(bound) => format!(" >= {bound}"),
            Bound::Max(bound) => format!(" <= {bound}"),
            Bound::Holds => String::new(),
            Bound::Within([min, max]) => format!(" from {min} to {max}, up to whole turns"),
        };
        let given = given.iter().map(|(name, numbers)| format!(", {name} = {}", list(numbers)));
        let given: String = given.collect();
        let leg = leg.map_or_else(String::new, |leg| format!(", leg {leg}"));
        format!("  {symbol}{bound}{given}{leg} ({words});")
    });
    format!(
        "\
every formula is defined (roots of positive numbers alone),
every leg reaches without a serial singularity,
there is no parallel singularity (M has full column rank), and
{all}psi_i are the inverses of the singular values of M.
"
    )
}

/// Where, for which machine and in what a refuted claim fails.
pub fn counterexample(claim: &MachineClaim, witness: &Witness) -> String {
    let problem = Problem::new(claim).ok();
    let point = list(&witness.point);
    let turned = match claim.orientation {
        Some(_) => "  (the point, then half-angle tangents)\n",
        None => "",
    };
    let tolerances = problem.iter().flat_map(Problem::tolerances).zip(&witness.machine);
    let machine: String = tolerances
        .map(|((place, _, _), value)| format!("  of the machine with {place} = {value}\n"))
        .collect();
    let fails = match &witness.fails {
        Failure::Reach => "where a leg does not reach, or is serially singular.".to_owned(),
        Failure::Obligation(number, _) | Failure::Row(number, _) => {
            let obligation = problem.as_ref().and_then(|p| p.obligations.get(*number));
            let requirement = obligation
                .and_then(|obligation| claim.require.get(obligation.requirement?))
                .map_or("freedom from singularities", |r| r.quantity.as_str());
            let of = match obligation {
                Some(Obligation { test: Test::Apart(Apart { bodies: [i, j], .. }), .. }) => {
                    format!("of body {i} and body {j} ")
                }
                Some(Obligation { leg: Some(leg), .. }) => format!("of leg {} ", leg + 1),
                _ => String::new(),
            };
            format!("where {of}{requirement} is violated.")
        }
        Failure::Same { least, greatest, .. } => {
            let (least, greatest) = (list(least), list(greatest));
            format!("and some point from ({least}) to ({greatest}) has the same joint coordinates.")
        }
        Failure::Singular(other) => {
            format!("and at ({}), where det M has the other sign.", list(other))
        }
        Failure::Dependent => "where the columns of M are linearly dependent.".to_owned(),
    };
    format!("It fails at ({point})\n{turned}{machine}{fails}\n")
}
