//! Certificates as files of the formal development in `proofs/rocq`.
//!
//! An exported file holds a claim in exact numbers, a bisection tree, and a theorem about real
//! numbers that mentions the claim and not the tree. Rocq computes the check and accepts the
//! theorem, or it does not: nothing here has to be trusted. What a reader has to look at is the
//! claim and the theorem in the file.

use num_rational::BigRational;
use num_traits::Signed;
use orthocert_checker::cell::Axis;
use orthocert_checker::certificate::{Certificate, Node, Proof, Step, Verdict};
use orthocert_checker::claim::{
    Claim, Leg, MachineClaim, Mechanism, Quantity, Requirements, Sign, Workspace,
};
use orthocert_checker::number::Exact;
use std::fmt::Write;
use std::slice::Iter;

mod kernel;

/// What is exported.
const ONLY: &str = "only certified claims about slider legs, a box and transmission are exported";

/// What is exported of other machines.
const KERNEL: &str =
    "of machines that are not three sliders, certified claims about sliders, struts and \
     planar legs that do not turn the platform, a box, transmission and ranges of joints that are \
     lengths are exported";

/// Why a certificate is not exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// It refutes.
    #[error("the certificate refutes its claim; {ONLY}")]
    Refutes,
    /// It proves the postulate.
    #[error(
        "the claim is the Q1/Q2 postulate, whose trees the formal checker does not read; {ONLY}"
    )]
    Postulate,
    /// It is about cubes that do not fit.
    #[error("the claim is that no cube fits; {ONLY}")]
    NoCube,
    /// Not all legs are of fixed length on linear guides.
    #[error("a leg is not of fixed length on a linear guide; {ONLY}")]
    NotSliders,
    /// The workspace is not a box.
    #[error("the workspace is not a box; {ONLY}")]
    NotABox,
    /// There are requirements other than those on transmission, or none on transmission.
    #[error("the claim asks for something else than bounds on transmission; {ONLY}")]
    NotTransmission,
    /// The platform turns, or the mechanism is given by formulas.
    #[error("the platform turns, or the mechanism is given by formulas; {KERNEL}")]
    NotTranslational,
    /// A leg is an arm, or a strut that keeps the platform from turning.
    #[error("a leg is an arm, or a strut with a base axis; {KERNEL}")]
    Drive,
    /// The workspace of a claim of the kernel is not a box.
    #[error("the workspace is not a box; {KERNEL}")]
    KernelNotABox,
    /// A claim of the kernel bounds this quantity.
    #[error("the claim bounds \"{0}\", which the formal kernel lacks; {KERNEL}")]
    Quantity(&'static str),
    /// The kernel does not accept the claim.
    #[error("the claim is not well formed")]
    NotWellFormed,
    /// The tree uses this rule.
    #[error("the proof uses the rule \"{0}\", which the formal checker lacks; {ONLY}")]
    Rule(&'static str),
    /// The nodes are not those of one tree over x, y and z.
    #[error("the nodes are not those of the trees that the claim needs")]
    NotATree,
}

/// The text of a Rocq file that states the certificate's claim and proves it by the certificate.
/// Whether the proof is right, Rocq decides.
///
/// # Errors
/// If the claim or the proof is not of the kind that the formal checker reads.
pub fn rocq(certificate: &Certificate) -> Result<String, ExportError> {
    if certificate.verdict != Verdict::Certified {
        return Err(ExportError::Refutes);
    }
    let claim = match (&certificate.claim, &certificate.proof) {
        (Claim::Machine(claim), _) => claim,
        (Claim::Postulate(_), _) => return Err(ExportError::Postulate),
        (Claim::NoCube(_), _) => return Err(ExportError::NoCube),
        (Claim::Atlas(_), _) => return Err(ExportError::NotATree),
        (Claim::Kernel(claim), Proof::Kernel(proof)) => return kernel::kernel(claim, proof),
        (Claim::Kernel(_), _) => return Err(ExportError::NotATree),
    };
    let Proof::Tree(tree) = &certificate.proof else {
        return Err(ExportError::NotATree);
    };
    let Mechanism::Translational(legs) = &claim.mechanism else {
        return Err(ExportError::NotSliders);
    };
    let Workspace::Box { min, max } = &claim.workspace else {
        return Err(ExportError::NotABox);
    };
    let (least, greatest) = bounds(&claim.requirements)?;
    let bits = precision(claim, tree.precision);

    let mut out = String::from(HEADER);
    for (i, leg) in legs.iter().enumerate() {
        slider(&mut out, i + 1, leg)?;
    }
    let edges: Vec<Quantity> =
        min.iter().zip(max).map(|(a, b)| Quantity { min: a.clone(), max: b.clone() }).collect();
    let _ = write!(out, "Definition box : tolerances :=\n  Tolerances");
    for edge in &edges {
        let _ = write!(out, "\n    {}", tolerance(edge));
    }
    let optional = |x: Option<&Exact>| x.map_or("None".into(), |x| format!("(Some {})", number(x)));
    let _ = write!(
        out,
        ".\n\n(** Transmission factors from psi_min to psi_max. *)\nDefinition claim : machine_claim :=\n  \
         MachineClaim leg_1 leg_2 leg_3 box {} {}.\n\n",
        optional(least),
        optional(greatest)
    );
    let low =
        greatest.map(|x| format!(" /\\\n  sigma_at_least (1 / value {}) (Jinv m P)", number(x)));
    let up = least.map(|x| format!(" /\\\n  sigma_at_most (1 / value {}) (Jinv m P)", number(x)));
    let _ =
        writeln!(out, "(** The proof: a bisection tree, and the rules that hold on its boxes. *)");
    out.push_str("Definition certificate : tree :=\n");
    let mut nodes = tree.nodes.iter();
    node(&mut out, &mut nodes, 1)?;
    if nodes.next().is_some() {
        return Err(ExportError::NotATree);
    }
    let close = match (&low, &up) {
        (Some(_), Some(_)) => "split; [exact (low _ eq_refl) | exact (up _ eq_refl)]",
        (Some(_), None) => "exact (low _ eq_refl)",
        (None, _) => "exact (up _ eq_refl)",
    };
    let _ = write!(
        out,
        ".\n\nLemma checked : check {bits} claim certificate = true.\n\
         Proof. vm_cast_no_check (eq_refl true). Qed.\n\n\
         Theorem certified : forall m P, is_machine claim m -> all_within box P ->\n  \
         regular m P{}{}.\n\
         Proof.\n  intros m P hm hP. destruct (check_sound {bits} claim certificate checked m P hm hP) as \
         [reg [low up]].\n  split; [exact reg |]. {close}.\nQed.\n",
        low.unwrap_or_default(),
        up.unwrap_or_default()
    );
    Ok(out)
}

const HEADER: &str = "\
(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the numbers of
    the claim and the last theorem, with the definitions of Claim.v and Kinematics.v. *)

From Coq Require Import ZArith Reals List.
From Orthocert Require Import Vec3 SingularValues Kinematics Claim Checker.
Import ListNotations.
Local Open Scope R_scope.

";

/// `psi_min` and `psi_max`, at least one.
fn bounds(requirements: &Requirements) -> Result<(Option<&Exact>, Option<&Exact>), ExportError> {
    let Requirements {
        transmission: Some(range),
        joint_range: None,
        conditioning: None,
        serial_margin: None,
        parallel_margin: None,
        leg_angle: None,
        joint_speed: None,
    } = requirements
    else {
        return Err(ExportError::NotTransmission);
    };
    match (&range.min, &range.max) {
        (None, None) => Err(ExportError::NotTransmission),
        (min, max) => Ok((min.as_ref(), max.as_ref())),
    }
}

/// Fractional bits for lengths in the claim's unit where the certificate has `bits` in a unit next
/// to the leg length: a product of four lengths or of their inverses keeps its relative precision.
fn precision(claim: &MachineClaim, bits: u32) -> u64 {
    let Mechanism::Translational(legs) = &claim.mechanism else {
        return u64::from(bits);
    };
    let size = |leg: &Leg| match leg {
        Leg::Slider { length, .. } => length.max.enclose(0, 64).map_or(0, |x| {
            let (whole, integer) = (x.sup(), x.sup().to_integer());
            if integer.is_positive() {
                integer.bits()
            } else {
                whole.denom().bits().saturating_sub(whole.numer().bits())
            }
        }),
        _ => 0,
    };
    u64::from(bits) + 4 * legs.iter().map(size).max().unwrap_or(0)
}

fn slider(out: &mut String, number: usize, leg: &Leg) -> Result<(), ExportError> {
    let Leg::Slider { direction, anchor, platform, length, mode } = leg else {
        return Err(ExportError::NotSliders);
    };
    let _ = writeln!(out, "(** direction, anchor, platform, length, mode *)");
    let _ = write!(out, "Definition leg_{number} : slider :=\n  Slider");
    for vector in [direction, anchor, platform] {
        let [x, y, z] = vector.each_ref().map(tolerance);
        let _ = write!(out, "\n    (Tolerances {x} {y} {z})");
    }
    let mode = matches!(mode, Sign::Plus);
    let _ = write!(out, "\n    {}\n    {mode}.\n\n", tolerance(length));
    Ok(())
}

fn tolerance(x: &Quantity) -> String {
    if x.is_exact() {
        format!("(exactly {})", number(&x.min))
    } else {
        format!("(Within {} {})", number(&x.min), number(&x.max))
    }
}

fn number(x: &Exact) -> String {
    let zero = || number(&Exact::integer(0));
    match x {
        Exact::Rational(x) => rational(x),
        Exact::Neg(x) => format!("(Minus {} {})", zero(), number(x)),
        Exact::Add(x, y) => format!("(Plus {} {})", number(x), number(y)),
        Exact::Sub(x, y) => format!("(Minus {} {})", number(x), number(y)),
        Exact::Mul(x, y) => format!("(Times {} {})", number(x), number(y)),
        Exact::Div(x, y) => format!("(Over {} {})", number(x), number(y)),
        Exact::Sqrt(x) => format!("(Root {})", number(x)),
        // Of atlases only, which are not exported.
        Exact::Name(name) => name.to_string(),
    }
}

fn rational(x: &BigRational) -> String {
    let numer =
        if x.is_negative() { format!("(-{})", x.numer().abs()) } else { x.numer().to_string() };
    format!("({numer} // {})", x.denom())
}

/// The tree that begins with the next node, indented.
fn node(out: &mut String, nodes: &mut Iter<'_, Node>, depth: usize) -> Result<(), ExportError> {
    let Node { by, split } = nodes.next().ok_or(ExportError::NotATree)?;
    let steps: Result<Vec<String>, ExportError> = by.iter().map(step).collect();
    let steps = steps?.join("; ");
    let indent = "  ".repeat(depth.min(MAX_INDENT));
    let Some(axis) = split else {
        let _ = write!(out, "{indent}(Leaf [{steps}])");
        return Ok(());
    };
    let axis = match axis {
        Axis::X => "AlongX",
        Axis::Y => "AlongY",
        Axis::Z => "AlongZ",
    };
    let _ = writeln!(out, "{indent}(Split [{steps}] {axis}");
    node(out, nodes, depth + 1)?;
    out.push('\n');
    node(out, nodes, depth + 1)?;
    out.push(')');
    Ok(())
}

/// Deeper nodes are not indented further.
const MAX_INDENT: usize = 24;

fn step(step: &Step) -> Result<String, ExportError> {
    match step {
        Step::Lower(rotation) => {
            let [a, b, c, d] = rotation.q;
            let sign = matches!(rotation.sign, Sign::Plus);
            Ok(format!("Lower ({a}) ({b}) ({c}) ({d}) {sign}"))
        }
        Step::Upper => Ok("Upper".to_owned()),
        other => Err(ExportError::Rule(other.rule().0)),
    }
}
