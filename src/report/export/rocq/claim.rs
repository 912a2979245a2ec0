//! Claims, as a `subject` of Certificate.v, and what `means` there says of them.

use super::{apply, lines, list, not_covered, optional, quoted, text, Exported};
use orthocert_kernel::certificate::{Claim, Failure, Proof};
use orthocert_kernel::claim::{
    Body, Bound, Formulas, JointFormula, Leg, MachineClaim, Mechanism, Orientation, Parameter,
    PsiMax, Quantity, Requirement, Sign, Turning, Workspace,
};
use orthocert_kernel::number::Expression;
use std::collections::HashMap;

/// The constructors of `subject`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Machine,
    Legs,
    Turning,
    Formulas,
    Closed,
    NoCube,
    Postulate,
    Atlas,
}

/// An argument of the constructor: a name, its type, and what it stands for.
type Argument = (&'static str, &'static str, String);

/// A claim as it is exported.
pub struct Subject<'a> {
    pub kind: Kind,
    pub arguments: Vec<Argument>,
    /// The legs of its machine, if it has any.
    pub legs: &'a [Leg],
    pub requirements: &'a [Requirement],
    /// Over a box, of as many legs as there are coordinates, of place and of orientation.
    pub is_square_over_box: bool,
}

impl Subject<'_> {
    /// The value of the type `subject`.
    pub fn term(&self) -> String {
        let names: Vec<&str> = self.arguments.iter().map(|(name, _, _)| *name).collect();
        match (self.kind, names.as_slice()) {
            (Kind::Postulate, []) => "Postulate_ None".to_owned(),
            (Kind::Postulate, [psi, ..]) => format!("Postulate_ (Some {psi})"),
            (kind, names) => format!("{kind:?}_ {}", names.join(" ")),
        }
    }

    /// The claim that its theorem is about, if that is one by itself: its type, and the function of the
    /// constructor's arguments that it is.
    pub fn claim(&self) -> Option<(&'static str, &'static str)> {
        match self.kind {
            Kind::Machine => Some(("claim", "claim_of")),
            Kind::Legs => Some(("driven_claim", "driven_claim_of")),
            Kind::Turning => Some(("turning_claim", "turning_claim_of")),
            Kind::Formulas => Some(("written_claim", "written_claim_of")),
            Kind::Closed | Kind::NoCube | Kind::Postulate | Kind::Atlas => None,
        }
    }

    /// What `means` says of a certificate of it, with a witness or without.
    pub fn means(&self, proof: &Proof) -> &'static str {
        let is_refuted = matches!(proof, Proof::Witness(_));
        let has_parts = self.requirements.iter().any(is_of_legs_alone);
        match (self.kind, is_refuted) {
            (Kind::Turning, true) if is_same(proof) => {
                "one_pose the_claim = true /\\ exists m P Q P' Q', is_about_struts the_claim m P Q /\\\n  \
                 Statement.in_region (positions the_claim) P' /\\ Orientation.in_orientations (turned the_claim) Q' /\\\n  \
                 Forall (fun l => strut_length l P' Q' = strut_length l P Q) m /\\ ~ (P' = P /\\ Q' = Q)"
            }
            (Kind::Legs, true) if is_same(proof) => "has_two_poses the_claim",
            (Kind::Formulas, true) if is_same(proof) => "has_two_points the_claim",
            (Kind::Machine, false) if has_parts => {
                "(holds the_claim /\\ exists m P, is_about the_claim m P) /\\\n  \
                 driven_holds (claim_of_legs the_legs the_workspace the_requirements)"
            }
            (Kind::Machine, true) if has_parts => {
                "(exists m P, is_about the_claim m P /\\ ~ meets the_claim m P) \\/\n  \
                 let c := claim_of_legs the_legs the_workspace the_requirements in\n  \
                 exists m P Q, Forall well_formed_driven m /\\ is_about_driven c m P Q /\\ ~ meets_driven c m P Q"
            }
            (Kind::Machine, false) => "holds the_claim /\\ exists m P, is_about the_claim m P",
            (Kind::Machine, true) => "exists m P, is_about the_claim m P /\\ ~ meets the_claim m P",
            (Kind::Legs, false) => {
                "driven_holds the_claim /\\ exists m P Q, is_about_driven the_claim m P Q"
            }
            (Kind::Legs, true) => {
                "exists m P Q, Forall well_formed_driven m /\\ is_about_driven the_claim m P Q /\\\n  \
                 ~ meets_driven the_claim m P Q"
            }
            (Kind::Turning, false) => {
                "turning_holds the_claim /\\ exists m P Q, is_about_struts the_claim m P Q"
            }
            (Kind::Turning, true) => {
                "exists m P Q, is_about_struts the_claim m P Q /\\ ~ meets_turning the_claim m P Q"
            }
            (Kind::Formulas, false) => {
                "written_holds the_claim /\\ exists theta x, is_about_written the_claim theta x"
            }
            (Kind::NoCube, false) => {
                "let c := claim_of the_legs (Box_ the_least the_greatest) [] the_requirements in\n  \
                 has_no_cube c (denoted the_side) /\\ exists m C, is_about c m C"
            }
            (Kind::Postulate, false) if self.arguments.is_empty() => {
                "forall psi, (1 < psi)%R -> postulate_for psi"
            }
            (Kind::Postulate, false) => {
                "(1 < value (greatest (tolerance_of the_psi)))%R /\\\n  \
                 forall psi, (1 < psi)%R -> within (tolerance_of the_psi) psi -> postulate_for psi"
            }
            (Kind::Formulas, true) => {
                "let m := by_formulas the_claim in exists theta x, is_about_written the_claim theta x /\\\n  \
                 ~ exists M, Forall2 (is_row m theta x) (joint_forms m) M /\\\n    \
                 Configuration.meets (List.length (coordinate_names m)) (machine_at m theta x M) (written_demands the_claim)"
            }
            // Of atlases that depends on their cells.
            _ => "means the_certificate",
        }
    }
}

fn is_same(proof: &Proof) -> bool {
    matches!(proof, Proof::Witness(witness) if matches!(witness.fails, Failure::Same { .. }))
}

/// Which requirements have a meaning for a kind of machine.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Asked {
    Anything,
    OfLegs,
    OfTwoPoints,
    OfStruts,
}

/// The claim as it is exported.
pub fn subject(claim: &Claim) -> Exported<Subject<'_>> {
    match claim {
        Claim::Machine(claim) => machine(claim),
        Claim::Postulate(claim) => {
            let arguments = match &claim.psi_max {
                PsiMax::Every(_) => Vec::new(),
                PsiMax::Of(psi) => vec![("the_psi", "quantity", quantity(psi))],
            };
            Ok(Subject {
                kind: Kind::Postulate,
                arguments,
                legs: &[],
                requirements: &[],
                is_square_over_box: false,
            })
        }
        Claim::NoCube(claim) => {
            const WHAT: &str = "a claim that no cube of such a machine fits";
            let (subject, [legs, _, requirements]) = alone(&claim.machine, WHAT)?;
            let Workspace::Box { min, max } = &claim.machine.workspace else {
                return not_covered(WHAT);
            };
            let arguments = vec![
                legs,
                ("the_least", "triple expression", triple(min, expression)?),
                ("the_greatest", "triple expression", triple(max, expression)?),
                requirements,
                ("the_side", "expression", expression(&claim.side)),
            ];
            Ok(Subject { kind: Kind::NoCube, arguments, ..subject })
        }
        Claim::Atlas(claim) => {
            let (subject, [legs, workspace, requirements]) =
                alone(&claim.machine, "an atlas of such a machine")?;
            let parameter = |Parameter { name, min, max }: &Parameter| {
                format!("({}, {})", quoted(name), pair([min, max]))
            };
            let arguments = vec![
                ("the_parameters", "parameters_", lines(claim.parameters.iter().map(parameter))),
                legs,
                workspace,
                requirements,
                ("the_certified_share", "expression", expression(&claim.certified)),
                ("the_refuted_share", "expression", expression(&claim.refuted)),
            ];
            Ok(Subject { kind: Kind::Atlas, arguments, ..subject })
        }
    }
}

/// Of a machine of [`Kind::Machine`] without bodies, its legs, workspace and requirements.
fn alone<'a>(claim: &'a MachineClaim, what: &str) -> Exported<(Subject<'a>, [Argument; 3])> {
    let subject = machine(claim)?;
    match (subject.kind, subject.arguments.as_slice()) {
        (Kind::Machine, [legs, workspace, _, requirements])
            if claim.bodies.is_empty() && !claim.require.iter().any(is_of_legs_alone) =>
        {
            let arguments = [legs.clone(), workspace.clone(), requirements.clone()];
            Ok((subject, arguments))
        }
        _ => not_covered(what),
    }
}

/// What is asked of legs that do not turn the platform in the words of Legs.v alone.
fn is_of_legs_alone(requirement: &Requirement) -> bool {
    ["leg_angle", "load"].contains(&requirement.quantity.as_str())
}

fn machine(claim: &MachineClaim) -> Exported<Subject<'_>> {
    let MachineClaim { mechanism, workspace, bodies, require, .. } = claim;
    let is_of_legs = |legs: &[Leg]| {
        let is_arm = |leg: &Leg| matches!(leg, Leg::Arm { .. });
        let is_whole = |r: &Requirement| match r.quantity.as_str() {
            "constraint_margin" | "clearance" | "joint_acceleration" | "accuracy" => true,
            "one_to_one" => legs.iter().any(|leg| matches!(leg, Leg::Planar { .. })),
            "parallel_margin" => !legs.iter().all(|leg| matches!(leg, Leg::Slider { .. })),
            _ => false,
        };
        legs.iter().any(is_arm)
            || require.iter().any(is_of_legs_alone) && !require.iter().any(is_whole)
    };
    let (kind, arguments, legs) = match (mechanism, workspace) {
        (Mechanism::Planar(turning), _) => turning_machine(claim, turning, "InPlane")?,
        (Mechanism::Spatial(turning), _) => turning_machine(claim, turning, "InSpace")?,
        (Mechanism::Spherical(turning), _) => turning_machine(claim, turning, "AboutPoint")?,
        (Mechanism::Translational(legs), Workspace::Box { .. } | Workspace::Cylinder { .. }) => {
            let written = requirements(require, Asked::Anything)?;
            if !is_of_legs(legs) {
                let arguments = vec![
                    ("the_legs", "list written_leg", written_legs(legs, Shape::Three)?),
                    ("the_workspace", "written_region", region(workspace, Shape::Three)?),
                    ("the_bodies", "list written_body", lines(bodies.iter().map(body))),
                    written,
                ];
                (Kind::Machine, arguments, &legs[..])
            } else {
                (Kind::Legs, any_legs("Translates", legs, None, claim)?, &legs[..])
            }
        }
        (Mechanism::Formulas(formulas), Workspace::Box { min, max }) => {
            without_bodies(claim)?;
            (Kind::Formulas, by_formulas(formulas, [min, max], require)?, &[][..])
        }
        (Mechanism::Orthoglide { offset }, Workspace::Cube { side }) => {
            without_bodies(claim)?;
            let written = requirements(require, Asked::OfLegs)?;
            let bounds = require.iter().filter(|r| r.quantity == "transmission").map(|r| &r.bound);
            match bounds.collect::<Vec<_>>().as_slice() {
                [Bound::Min(_), Bound::Max(_)] | [Bound::Max(_), Bound::Min(_)] => {}
                _ => {
                    return not_covered(
                        "the closed design with other bounds on psi than one from below and one from above",
                    )
                }
            }
            let [offset, side] = [("the_offset", offset), ("the_side", side)]
                .map(|(name, x)| (name, "expression", expression(x)));
            (Kind::Closed, vec![offset, side, written], &[][..])
        }
        (Mechanism::Orthoglide { .. }, _) => return not_covered("the mechanism \"orthoglide\""),
        (_, Workspace::Cube { .. }) => return not_covered("the workspace \"cube\""),
        (_, Workspace::Cylinder { .. }) => return not_covered("the workspace \"cylinder\""),
    };
    let coordinates = match mechanism {
        Mechanism::Planar(_) => Some(3),
        Mechanism::Spatial(_) => Some(6),
        _ => None,
    };
    let is_square_over_box =
        coordinates == Some(legs.len()) && matches!(workspace, Workspace::Box { .. });
    let requirements = require;
    Ok(Subject { kind, arguments, legs, requirements, is_square_over_box })
}

fn without_bodies(claim: &MachineClaim) -> Exported<()> {
    match claim.bodies.is_empty() {
        true => Ok(()),
        false => not_covered("such a machine with bodies"),
    }
}

/// Legs in the plane, or of a platform that turns.
fn turning_machine<'a>(
    claim: &MachineClaim,
    Turning { legs, characteristic_length: length }: &'a Turning,
    motion: &'static str,
) -> Exported<(Kind, Vec<Argument>, &'a [Leg])> {
    let is_strut = |leg: &Leg| matches!(leg, Leg::Strut { .. });
    let (length, orientation) = match (length, &claim.orientation) {
        (Some(length), Some(orientation)) if legs.iter().all(is_strut) => (length, orientation),
        (_, Some(_)) if legs.iter().any(is_strut) => {
            return not_covered("a platform that turns on struts and other drives")
        }
        (None, _) if motion == "InPlane" => {
            return Ok((Kind::Legs, any_legs("TranslatesInPlane", legs, None, claim)?, legs))
        }
        (length, _) => {
            let mobility = format!("Turns {motion}");
            return Ok((Kind::Legs, any_legs(&mobility, legs, length.as_ref(), claim)?, legs));
        }
    };
    let written = requirements(&claim.require, Asked::OfStruts)?;
    let strut = |leg: &Leg| match leg {
        Leg::Strut { anchor, platform, base_axis: None } => {
            let [anchor, platform] = [anchor, platform].map(|v| list(v.iter().map(quantity)));
            Ok(format!("({anchor}, {platform})"))
        }
        _ => not_covered("a base axis of such a platform"),
    };
    let struts = legs.iter().map(strut).collect::<Exported<Vec<_>>>()?;
    let arguments = vec![
        ("the_motion", "motion", motion.to_owned()),
        ("the_struts", "list (list quantity * list quantity)", lines(struts)),
        ("the_length", "expression", expression(length)),
        ("the_workspace", "written_place", region(&claim.workspace, Shape::Any)?),
        ("the_orientations", "written_orientation", orientations(orientation)),
        ("the_bodies", "list written_body", lines(claim.bodies.iter().map(body))),
        written,
    ];
    Ok((Kind::Turning, arguments, legs))
}

/// Legs in any motion.
fn any_legs(
    mobility: &str,
    legs: &[Leg],
    length: Option<&Expression>,
    claim: &MachineClaim,
) -> Exported<Vec<Argument>> {
    without_bodies(claim)?;
    let written = requirements(&claim.require, Asked::OfLegs)?;
    let orientation = claim.orientation.as_ref().map(orientations);
    Ok(vec![
        ("the_motion", "mobility", mobility.to_owned()),
        ("the_legs", "list written_driven", written_legs(legs, Shape::Any)?),
        ("the_length", "option expression", optional(length.map(expression))),
        ("the_workspace", "written_place", region(&claim.workspace, Shape::Any)?),
        ("the_orientations", "option written_orientation", optional(orientation)),
        written,
    ])
}

/// Most operations of formulas with their definitions written out, as they are proved, and of definitions.
const MOST_WRITTEN_OUT: usize = 1 << 15;

fn written_out(definitions: &[(String, Expression)], joints: &[JointFormula]) -> usize {
    fn size(x: &Expression, known: &HashMap<&str, usize>) -> usize {
        let parts = x.parts().map(|part| size(part, known));
        let parts = parts.fold(0, usize::saturating_add);
        match x {
            Expression::Name(name) => known.get(&**name).copied().unwrap_or(1),
            Expression::Power(_, n) => parts.saturating_mul(*n as usize),
            _ => parts.saturating_add(1),
        }
    }
    let (mut known, mut all) = (HashMap::new(), 0usize);
    for (name, x) in definitions {
        let size = size(x, &known);
        known.insert(&**name, size);
        all = all.saturating_add(size);
    }
    let terms = joints.iter().flat_map(|joint| match joint {
        JointFormula::Rho(rho) => std::slice::from_ref(rho),
        JointFormula::Row(row) => row,
    });
    terms.map(|x| size(x, &known)).fold(all, usize::saturating_add)
}

fn by_formulas(
    Formulas { coordinates, parameters, definitions, joints }: &Formulas,
    ends: [&Vec<Expression>; 2],
    require: &[Requirement],
) -> Exported<Vec<Argument>> {
    if written_out(definitions, joints) > MOST_WRITTEN_OUT {
        return not_covered(format!(
            "a mechanism of more than {MOST_WRITTEN_OUT} operations, with its definitions written out,"
        ));
    }
    let [least, greatest] = ends.map(|end| list(end.iter().map(expression)));
    let joint = |joint: &JointFormula| match joint {
        JointFormula::Rho(rho) => apply("Rho_", [formula(rho)]),
        JointFormula::Row(row) => apply("Row_", [list(row.iter().map(formula))]),
    };
    let parameters =
        parameters.iter().map(|(name, x)| format!("({}, {})", quoted(name), quantity(x)));
    let definitions =
        definitions.iter().map(|(name, x)| format!("({}, {})", quoted(name), formula(x)));
    Ok(vec![
        ("the_coordinates", "list string", list(coordinates.iter().map(|name| quoted(name)))),
        ("the_parameters", "list (string * quantity)", lines(parameters)),
        ("the_definitions", "list (string * term string)", lines(definitions)),
        ("the_joints", "list written_form", lines(joints.iter().map(joint))),
        ("the_least", "list expression", least),
        ("the_greatest", "list expression", greatest),
        requirements(require, Asked::OfTwoPoints)?,
    ])
}

/// How vectors are written: as `triple`, or as lists, of constructors whose names begin with `Any`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shape {
    Three,
    Any,
}

impl Shape {
    fn vector<T>(self, v: &[T], of: impl Fn(&T) -> String) -> Exported<String> {
        match (self, v) {
            (Shape::Any, v) => Ok(list(v.iter().map(of))),
            (Shape::Three, v) => triple(v, of),
        }
    }

    fn constructor(self, name: &str) -> String {
        let any = if self == Shape::Any { "Any" } else { "" };
        format!("{any}{name}_")
    }
}

fn written_legs(legs: &[Leg], shape: Shape) -> Exported<String> {
    Ok(lines(legs.iter().map(|l| leg(l, shape)).collect::<Exported<Vec<_>>>()?))
}

fn leg(leg: &Leg, shape: Shape) -> Exported<String> {
    let v = |v: &[Quantity]| shape.vector(v, quantity);
    let sign = |mode: &Sign| (*mode == Sign::Plus).to_string();
    Ok(match (leg, shape) {
        (Leg::Slider { direction, anchor, platform, length, mode }, shape) => apply(
            &shape.constructor("Slider"),
            [v(direction)?, v(anchor)?, v(platform)?, quantity(length), sign(mode)],
        ),
        (Leg::Strut { anchor, platform, base_axis }, shape) => {
            let axis = optional(base_axis.as_deref().map(v).transpose()?);
            apply(&shape.constructor("Strut"), [v(anchor)?, v(platform)?, axis])
        }
        (Leg::Planar { direction }, shape) => apply(&shape.constructor("Planar"), [v(direction)?]),
        (Leg::Arm { axis, reference, anchor, platform, arm, length, mode }, _) => apply(
            "AnyArm_",
            [
                v(axis)?,
                v(reference)?,
                v(anchor)?,
                v(platform)?,
                quantity(arm),
                quantity(length),
                sign(mode),
            ],
        ),
    })
}

fn body(body: &Body) -> String {
    let at =
        |[x, y, z]: &[Expression; 3]| format!("({})", apply("Triple", [x, y, z].map(expression)));
    let fixed = |moves: bool, from, to, radius| {
        apply("Fixed_", [moves.to_string(), at(from), at(to), expression(radius)])
    };
    match body {
        Body::Leg { leg, radius, trim: [base, platform], offset } => {
            let [radius, base, platform] = [radius, base, platform].map(expression);
            let offset = optional(offset.as_ref().map(at));
            apply("AlongLeg_", [leg.to_string(), radius, base, platform, offset])
        }
        Body::Base { from, to, radius } => fixed(false, from, to, radius),
        Body::Platform { from, to, radius } => fixed(true, from, to, radius),
    }
}

fn region(workspace: &Workspace, shape: Shape) -> Exported<String> {
    match workspace {
        Workspace::Box { min, max } => {
            let ends = [shape.vector(min, expression)?, shape.vector(max, expression)?];
            Ok(apply(&shape.constructor("Box"), ends))
        }
        Workspace::Cylinder { center: [x, y], radius, z: [bottom, top] } => {
            let numbers = [x, y, radius, bottom, top].map(expression);
            Ok(apply(&shape.constructor("Cylinder"), numbers))
        }
        Workspace::Cube { .. } => not_covered("the workspace \"cube\" of such a machine"),
    }
}

fn orientations(set: &Orientation) -> String {
    match set {
        Orientation::Range(ends) => apply("Range_", ends.each_ref().map(expression)),
        Orientation::RollPitchYaw { roll, pitch, yaw } => {
            apply("RollPitchYaw_", [roll, pitch, yaw].map(|ends| pair(ends.each_ref())))
        }
        Orientation::Angle(angle) => apply("Angle_", [expression(angle)]),
        Orientation::Tilt { tilt, torsion } => apply("Tilt_", [tilt, torsion].map(expression)),
    }
}

fn requirements(all: &[Requirement], asked: Asked) -> Exported<Argument> {
    let all = all.iter().map(|r| requirement(r, asked)).collect::<Exported<Vec<_>>>()?;
    Ok(("the_requirements", "list written_requirement", lines(all)))
}

fn requirement(requirement: &Requirement, asked: Asked) -> Exported<String> {
    let Requirement { quantity, leg, given, bound } = requirement;
    let about = match quantity.as_str() {
        "transmission" => "Transmission",
        "joint_range" => "JointRange",
        "joint_speed" => "Speed_",
        "conditioning" => "Condition_",
        "serial_margin" => "Serial_",
        "parallel_margin" => "Parallel_",
        "stiffness" => "Stiffness_",
        "constraint_margin" => "Constraint_",
        "joint_force" => "Force_",
        "joint_acceleration" => "Acceleration_",
        "one_to_one" => "OneToOne_",
        "accuracy" => "Accuracy_",
        "clearance" => "Clearance_",
        "leg_angle" => "LegAngle_",
        "load" => "Load_",
        "base_joint" if asked > Asked::Anything => "BaseJoint_",
        "platform_joint" if asked > Asked::Anything => "PlatformJoint_",
        other => return not_covered(format!("the quantity {other:?}")),
    };
    let bound = match bound {
        Bound::Min(b) => format!("(AtLeast_ {})", expression(b)),
        Bound::Max(b) => format!("(AtMost_ {})", expression(b)),
        Bound::Within([a, b]) => format!("(Within_ {} {})", expression(a), expression(b)),
        Bound::Holds => "Holds_".to_owned(),
    };
    let all: Vec<_> = given.iter().map(|(name, x)| (name.as_str(), x.as_slice())).collect();
    let given = match (about, all.as_slice()) {
        (_, []) => None,
        ("Speed_" | "Force_", [("tool", [x])])
        | ("Stiffness_", [("joint", [x])])
        | ("Accuracy_", [("joint_error", [x])]) => Some(format!("(Given_ {})", expression(x))),
        ("Acceleration_", [("acceleration", [a]), ("speed", [v])]) => {
            Some(format!("(Motion_ {} {})", expression(a), expression(v)))
        }
        ("Accuracy_", [("joint_error", [e]), ("max_angle", [a])]) => {
            Some(format!("(Near_ {} {})", expression(e), expression(a)))
        }
        ("Stiffness_", [("joint", all)])
        | ("BaseJoint_" | "PlatformJoint_", [("axis", all)])
        | ("Load_", [("force", all)]) => {
            Some(format!("(Each_ {})", list(all.iter().map(expression))))
        }
        _ => return not_covered(format!("what is given for {quantity:?}")),
    };
    let is_asked = match about {
        "Transmission" | "JointRange" | "Condition_" | "Speed_" | "Force_" | "Stiffness_" => true,
        "Serial_" | "Parallel_" | "LegAngle_" | "Load_" => asked < Asked::OfTwoPoints,
        "OneToOne_" | "Accuracy_" => true,
        "BaseJoint_" | "PlatformJoint_" => asked == Asked::OfStruts,
        "Clearance_" => matches!(asked, Asked::Anything | Asked::OfStruts),
        "Acceleration_" => asked != Asked::OfTwoPoints,
        _ => asked == Asked::Anything,
    };
    if !is_asked {
        return not_covered("this quantity of such a mechanism");
    }
    let leg = optional(leg.map(|leg| format!("{leg}%nat")));
    Ok(format!("Require_ {about} {leg} {} {bound}", optional(given)))
}

fn triple<T>(v: &[T], of: impl Fn(&T) -> String) -> Exported<String> {
    match v {
        [x, y, z] => Ok(format!("({})", apply("Triple", [x, y, z].map(of)))),
        _ => not_covered("a vector that has not three numbers"),
    }
}

fn pair([a, b]: [&Expression; 2]) -> String {
    format!("({}, {})", expression(a), expression(b))
}

fn quantity(quantity: &Quantity) -> String {
    match quantity {
        Quantity::Exactly(x) => expression(x),
        Quantity::Between { min, max } => {
            format!("(Between {} {})", expression(min), expression(max))
        }
    }
}

/// A number, in parentheses if it is no literal.
pub fn expression(x: &Expression) -> String {
    text(x, |name| format!("Name (Called {name})"))
}

fn formula(x: &Expression) -> String {
    text(x, |name| format!("Name {name}"))
}
