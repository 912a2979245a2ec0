//! Certificates of the kernel: legs that do not turn the platform, as many as there are.
//!
//! What is exported is checked by `kernel/Problem.v`, in the integers of `orthocert-kernel`: the units
//! of lengths and directions are those of its problem, the tree is its tree, and a requirement is named
//! by the number of its obligation.

use super::{ExportError, MAX_INDENT};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed};
use orthocert_kernel::certificate::{Corner, Evidence, Node, Proof, Step, Tree};
use orthocert_kernel::claim::{
    Bound, Leg, MachineClaim, Mechanism, Quantity, Requirement, Sign, Workspace,
};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::{Obligation, TABLE};
use orthocert_kernel::test::Multiplier;
use std::fmt::Write;
use std::slice::Iter;

/// Most nodes between the root and a leaf: of a tree that is accepted there are fewer.
const MOST_DEPTH: usize = 1024;

const HEADER: &str = "\
(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the numbers of
    the claim and the last theorem, with the definitions of kernel/Statement.v, Claim.v and
    Kinematics.v. *)

From Coq Require Import ZArith NArith Reals List.
From Orthocert Require Import Vec3 SingularValues Kinematics Claim.
From Orthocert.kernel Require Import Statement Check Problem.
Import ListNotations.
Local Open Scope R_scope.

";

/// A requirement, as it is written in a claim, and what the theorem says of it.
struct Stated {
    requirement: String,
    sentence: Option<String>,
}

/// The file that states the claim and proves it by the tree.
pub(super) fn kernel(claim: &MachineClaim, proof: &Proof) -> Result<String, ExportError> {
    let Proof::Tree(tree) = proof else { return Err(ExportError::Refutes) };
    let Mechanism::Translational(legs) = &claim.mechanism else {
        return Err(ExportError::NotTranslational);
    };
    let problem = Problem::new(claim).map_err(|_| ExportError::NotWellFormed)?;
    let mut out = String::from(HEADER);
    for (number, leg) in legs.iter().enumerate() {
        let _ = writeln!(out, "Definition leg_{} : drive :=\n  {}.\n", number + 1, drive(leg)?);
    }
    let _ =
        writeln!(out, "Definition the_workspace : region :=\n  {}.\n", region(&claim.workspace)?);
    let stated = |obligation: &Obligation| stated(claim, obligation);
    let stated = problem.obligations.iter().map(stated).collect::<Result<Vec<_>, _>>()?;
    let requirements: Vec<&str> = stated.iter().map(|stated| &*stated.requirement).collect();
    let names: Vec<String> = (1..=legs.len()).map(|leg| format!("leg_{leg}")).collect();
    let _ = writeln!(
        out,
        "Definition the_claim : claim :=\n  MakeClaim [{}] the_workspace [{}].\n",
        names.join("; "),
        requirements.join("; ")
    );
    out.push_str(
        "(** The proof: a bisection tree, and what shows the requirements on its boxes. *)\n",
    );
    out.push_str("Definition certificate : tree :=\n");
    let mut nodes = tree.nodes.iter();
    node(&mut out, &mut nodes, 1)?;
    if nodes.next().is_some() {
        return Err(ExportError::NotATree);
    }
    out.push_str(".\n\n");
    theorem(&mut out, tree, &units(&problem, legs.len()), &stated);
    Ok(out)
}

/// Binary orders of the units of lengths and of each leg's direction, as the kernel has them.
fn units(problem: &Problem, legs: usize) -> String {
    let direction = |leg: usize| {
        let places = ["direction", "base_axis"].map(|key| format!("leg {}: {key}.", leg + 1));
        let is_one = |place: &str| places.iter().any(|start| place.starts_with(start));
        let input = problem.inputs.iter().find(|input| is_one(&input.place));
        input.map_or(0, |input| input.scale).to_string()
    };
    let directions: Vec<String> = (0..legs).map(|leg| format!("({})", direction(leg))).collect();
    format!("({}) [{}]%Z", problem.scale, directions.join("; "))
}

fn theorem(out: &mut String, tree: &Tree, units: &str, stated: &[Stated]) {
    let place =
        |at: usize| format!("{}or_introl eq_refl{}", "or_intror (".repeat(at), ")".repeat(at));
    let uses: Vec<String> = stated
        .iter()
        .enumerate()
        .filter(|(_, stated)| stated.sentence.is_some())
        .map(|(at, stated)| format!("exact (met {} ({}))", stated.requirement, place(at)))
        .collect();
    let check = format!("check_claim {} the_claim {units} certificate", tree.precision);
    let sentences = stated.iter().filter_map(|stated| stated.sentence.as_deref());
    let regular = if uses.is_empty() { "" } else { "split; [exact regular |].\n  " };
    let sentences: String = sentences.map(|sentence| format!(" /\\\n  {sentence}")).collect();
    let _ = write!(
        out,
        "Lemma checked : {check} = true.\nProof. vm_cast_no_check (eq_refl true). Qed.\n\n\
         Theorem certified : forall m P, is_machine the_claim m -> in_region the_workspace P ->\n  \
         Forall (reaches P) m /\\\n  (forall v, v <> vzero -> 0 < speed2 m P v){sentences}.\n\
         Proof.\n  intros m P hm hP.\n  \
         destruct (check_claim_sound _ _ _ _ _ checked m P hm hP) as [reached [regular met]].\n  \
         rewrite Forall_forall in met. split; [exact reached |]. {regular}"
    );
    let uses = match uses.split_last() {
        None => "exact regular".to_owned(),
        Some((last, [])) => last.clone(),
        Some((last, others)) => {
            let split: String =
                others.iter().map(|other| format!("split; [{other} |]. ")).collect();
            format!("{split}{last}")
        }
    };
    let _ = writeln!(out, "{uses}.\nQed.");
}

fn region(workspace: &Workspace) -> Result<String, ExportError> {
    match workspace {
        Workspace::Box { min, max } => {
            let edge = |(min, max)| between(min, max);
            let edges: Vec<String> = min.iter().zip(max).map(edge).collect();
            Ok(format!("Box (Tolerances {})", edges.join(" ")))
        }
        Workspace::Cylinder { center: [x, y], radius, z: [bottom, top] } => {
            let [x, y, radius] = [x, y, radius].map(number);
            Ok(format!("Cylinder {x} {y} {radius} {}", between(bottom, top)))
        }
        Workspace::Cube { .. } => Err(ExportError::Cube),
    }
}

fn drive(leg: &Leg) -> Result<String, ExportError> {
    match leg {
        Leg::Slider { direction, anchor, platform, length, mode } => Ok(format!(
            "SliderLeg (Slider\n    {}\n    {}\n    {}\n    {} {})",
            vector(direction)?,
            vector(anchor)?,
            vector(platform)?,
            tolerance(length),
            *mode == Sign::Plus
        )),
        Leg::Strut { anchor, platform, base_axis } => {
            let axis = match base_axis {
                Some(axis) => format!("(Some {})", vector(axis)?),
                None => "None".to_owned(),
            };
            Ok(format!("StrutLeg\n    {}\n    {}\n    {axis}", vector(anchor)?, vector(platform)?))
        }
        Leg::Planar { direction } => Ok(format!("PlanarLeg\n    {}", vector(direction)?)),
        Leg::Arm { .. } => Err(ExportError::Drive),
    }
}

/// An obligation as a requirement of the formal claim.
fn stated(claim: &MachineClaim, obligation: &Obligation) -> Result<Stated, ExportError> {
    let Some(requirement) = obligation.requirement else {
        return Ok(Stated { requirement: "NotSingular".to_owned(), sentence: None });
    };
    let Requirement { quantity, bound, given, .. } =
        claim.require.get(requirement).ok_or(ExportError::NotATree)?;
    let leg = obligation.leg.unwrap_or(0);
    let joint =
        |relation: String| Some(format!("(exists l, nth_error m {leg} = Some l /\\ {relation})"));
    let (requirement, sentence) = match (quantity.as_str(), bound) {
        ("transmission", Bound::Max(b)) => {
            let b = number(b);
            let below = format!("(forall v, (1 / value {b}) ^ 2 * norm2 v <= speed2 m P v)");
            (format!("(PsiMax {b})"), Some(below))
        }
        ("transmission", Bound::Min(b)) => {
            let b = number(b);
            let above = format!("(forall v, speed2 m P v <= (1 / value {b}) ^ 2 * norm2 v)");
            (format!("(PsiMin {b})"), Some(above))
        }
        ("joint_range", Bound::Min(b)) => {
            let b = number(b);
            (format!("(JointMin {leg} {b})"), joint(format!("value {b} <= joint l P")))
        }
        ("joint_range", Bound::Max(b)) => {
            let b = number(b);
            (format!("(JointMax {leg} {b})"), joint(format!("joint l P <= value {b}")))
        }
        ("joint_speed", Bound::Max(b)) => {
            let tool = given
                .get("tool")
                .and_then(|tool| tool.first())
                .ok_or(ExportError::NotWellFormed)?;
            let (b, tool) = (number(b), number(tool));
            let slow = format!(
                "forall v, norm2 v <= value {tool} ^ 2 -> dot (row l P) v ^ 2 <= value {b} ^ 2"
            );
            (format!("(JointSpeed {leg} {tool} {b})"), joint(slow))
        }
        ("conditioning", Bound::Max(b)) => {
            let b = number(b);
            let even = format!(
                "(forall u v, speed2 m P u * norm2 v <= value {b} ^ 2 * (speed2 m P v * norm2 u))"
            );
            (format!("(ConditionMax {b})"), Some(even))
        }
        ("serial_margin", Bound::Min(b)) => {
            let b = number(b);
            let far = format!(
                "(exists k, nth_error m {leg} = Some (Guided k) /\\ (value {b} * leg_length k) ^ 2 <= eta k P ^ 2)"
            );
            (format!("(SerialMargin {leg} {b})"), Some(far))
        }
        ("parallel_margin", Bound::Min(b)) => {
            let b = number(b);
            let far = format!(
                "(exists l1 l2 l3, m = [l1; l2; l3] /\\ value {b} * size_of l1 P * size_of l2 P * size_of l3 P <= \
                 Rabs (det (Mat (vector_of l1 P) (vector_of l2 P) (vector_of l3 P))))"
            );
            (format!("(ParallelMargin {b})"), Some(far))
        }
        ("stiffness", Bound::Min(b)) => {
            let [joint] = given.get("joint").map_or(&[][..], |joint| joint) else {
                return Err(ExportError::Quantity("stiffness"));
            };
            let (b, joint) = (number(b), number(joint));
            let stiff = format!("(forall v, value {b} / value {joint} * norm2 v <= speed2 m P v)");
            (format!("(Stiffness {joint} {b})"), Some(stiff))
        }
        ("constraint_margin", Bound::Min(b)) => {
            let b = number(b);
            let far = format!(
                "(exists cs, Forall2 (fun l c => couple_of l P = Some c /\\ c <> vzero) m cs /\\ forall v, \
                 value {b} ^ 2 * norm2 v <= fold_right (fun c sum => dot (normalised c) v ^ 2 + sum) 0 cs)"
            );
            (format!("(ConstraintMargin {b})"), Some(far))
        }
        (key, _) => {
            let known = TABLE.iter().find(|quantity| quantity.key == key);
            return Err(ExportError::Quantity(known.map_or("", |quantity| quantity.key)));
        }
    };
    Ok(Stated { requirement, sentence })
}

fn vector(x: &[Quantity]) -> Result<String, ExportError> {
    let [x, y, z] = x else { return Err(ExportError::NotWellFormed) };
    let [x, y, z] = [x, y, z].map(tolerance);
    Ok(format!("(Tolerances {x} {y} {z})"))
}

fn tolerance(x: &Quantity) -> String {
    match x {
        Quantity::Exactly(x) => format!("(exactly {})", number(x)),
        Quantity::Between { min, max } => between(min, max),
    }
}

fn between(min: &Expression, max: &Expression) -> String {
    format!("(Within {} {})", number(min), number(max))
}

/// The number, operation by operation, so that it is enclosed as the kernel encloses it.
pub(super) fn number(x: &Expression) -> String {
    match x {
        Expression::Literal { digits, places } => fraction(digits.clone(), *places),
        Expression::Neg(inner) => match &**inner {
            Expression::Literal { digits, places } => fraction(-digits, *places),
            inner => format!("(Minus (0 // 1) {})", number(inner)),
        },
        Expression::Binary(operator, left, right) => {
            let name = match operator {
                Operator::Add => "Plus",
                Operator::Sub => "Minus",
                Operator::Mul => "Times",
                Operator::Div => "Over",
            };
            format!("({name} {} {})", number(left), number(right))
        }
        Expression::Power(base, n) => {
            let base = number(base);
            (1..*n).fold(base.clone(), |power, _| format!("(Times {power} {base})"))
        }
        Expression::Sqrt(inner) => format!("(Root {})", number(inner)),
        // A number of a claim has none.
        Expression::Name(name) => name.clone(),
        Expression::Varying(range) => range.name.clone(),
    }
}

/// `digits / 10^places` in lowest terms.
pub(super) fn lowest(digits: BigInt, places: u32) -> [BigInt; 2] {
    let ten = BigInt::from(10).pow(places);
    let common = if places == 0 { BigInt::one() } else { digits.gcd(&ten) };
    [digits / &common, ten / &common]
}

fn fraction(digits: BigInt, places: u32) -> String {
    let [numer, denom] = lowest(digits, places);
    let numer = if numer.is_negative() { format!("({numer})") } else { numer.to_string() };
    format!("({numer} // {denom})")
}

/// The tree that begins with the next node, indented.
pub(super) fn node(
    out: &mut String,
    nodes: &mut Iter<'_, Node>,
    depth: usize,
) -> Result<(), ExportError> {
    let Node { by, split, fails, at: _ } = nodes.next().ok_or(ExportError::NotATree)?;
    if fails.is_some() {
        return Err(ExportError::NotATree);
    }
    if depth > MOST_DEPTH {
        return Err(ExportError::NotATree);
    }
    let steps = by.iter().map(step).collect::<Result<Vec<_>, _>>()?;
    let steps = match steps.as_slice() {
        [] => "[]".to_owned(),
        steps => format!("[{}]%nat", steps.join("; ")),
    };
    let indent = "  ".repeat(depth.min(MAX_INDENT));
    let Some(k) = split else {
        let _ = write!(out, "{indent}(Leaf {steps})");
        return Ok(());
    };
    let _ = writeln!(out, "{indent}(Split {steps} {k}");
    node(out, nodes, depth + 1)?;
    out.push('\n');
    node(out, nodes, depth + 1)?;
    out.push(')');
    Ok(())
}

fn step(Step(obligation, step): &Step) -> Result<String, ExportError> {
    Ok(format!("({obligation}, {})", evidence(step)?))
}

fn evidence(step: &Evidence) -> Result<String, ExportError> {
    Ok(match step {
        Evidence::Test => "ByTest".to_owned(),
        Evidence::Divided => "ByDivided".to_owned(),
        Evidence::Lower(y) => format!("ByLower {}", multiplier(y)),
        Evidence::LowerDivided(y) => format!("ByLowerDivided {}", multiplier(y)),
        Evidence::Rank(y) => format!("ByRank {}", multiplier(y)),
        Evidence::Conditioning(y, mu) => {
            format!("ByConditioning {} {}%Z", multiplier(y), integers(mu))
        }
        Evidence::Negative => "ByNegative".to_owned(),
        Evidence::Corner(Corner::Q1) => "ByCorner Q1".to_owned(),
        Evidence::Corner(Corner::Q2) => "ByCorner Q2".to_owned(),
        Evidence::Mirror => "ByMirror".to_owned(),
        Evidence::Outside => "Outside".to_owned(),
        Evidence::Inside(inner, n, places) => {
            format!("Inside ({}) ({n})%Z {places}", evidence(inner)?)
        }
        other => return Err(ExportError::Evidence(other.name())),
    })
}

fn integers(row: &[i64]) -> String {
    let row: Vec<String> = row.iter().map(|y| format!("({y})")).collect();
    format!("[{}]", row.join("; "))
}

fn multiplier(y: &Multiplier) -> String {
    let rows: Vec<String> = y.y.iter().map(|row| integers(row)).collect();
    format!("{} [{}]%Z", y.places, rows.join("; "))
}
