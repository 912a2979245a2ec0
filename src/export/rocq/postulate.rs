//! Certificates of the Q1/Q2 postulate, by the faces of the cube.
//!
//! The exported theorem is about every `psi` up to the greatest of the claim, or every one: "faces
//! suffice" needs every `kappa` up to 1 in any case, so the least `psi_max` of a range does not
//! occur.

use super::{number, ExportError, MAX_INDENT};
use num_traits::Signed;
use orthocert_checker::cell::Axis;
use orthocert_checker::certificate::{Faces, Node, Step};
use orthocert_checker::claim::PsiMax;
use orthocert_checker::number::Exact;
use orthocert_checker::postulate::{Face, Half};
use orthocert_checker::rule::TightCorner;
use std::fmt::Write;
use std::slice::Iter;

/// Faces and halves in the order of a proof, with the names of their trees.
const TREES: [(Face, Half, &str); 4] = [
    (Face::Q1, Half::Low, "q1_low"),
    (Face::Q1, Half::High, "q1_high"),
    (Face::Q2, Half::Low, "q2_low"),
    (Face::Q2, Half::High, "q2_high"),
];

/// The file that states the postulate for the claim's range of `psi_max` and proves it by the trees.
/// Which trees are needed, `psi_max <= 2` or not, Rocq decides.
pub(super) fn postulate(psi_max: &PsiMax, faces: &Faces) -> Result<String, ExportError> {
    let given: Vec<_> = faces.parts.iter().map(|part| (part.face, part.half)).collect();
    let both = given == TREES.map(|(face, half, _)| (face, half));
    let high_only = given == [(Face::Q1, Half::High), (Face::Q2, Half::High)];
    let bits = faces.precision;
    let theorem = match psi_max {
        PsiMax::All if both => all(bits),
        PsiMax::Range(range) if both => {
            up_to(&range.max, bits, ["Both q1_low q1_high", "Both q2_low q2_high"])
        }
        PsiMax::Range(range) if high_only => {
            up_to(&range.max, bits, ["HighOnly q1_high", "HighOnly q2_high"])
        }
        _ => return Err(ExportError::NotATree),
    };
    let mut out = String::from(HEADER);
    for part in &faces.parts {
        let name = TREES.iter().find(|(face, half, _)| (*face, *half) == (part.face, part.half));
        let (_, _, name) = name.ok_or(ExportError::NotATree)?;
        let _ = writeln!(out, "Definition {name} : face_tree :=");
        let mut nodes = part.nodes.iter();
        face_node(&mut out, &mut nodes, part.face, 1)?;
        if nodes.next().is_some() {
            return Err(ExportError::NotATree);
        }
        out.push_str(".\n\n");
    }
    out.push_str(&theorem);
    Ok(out)
}

const HEADER: &str = "\
(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the theorem
    `certified`, with the definitions of Postulate.v and Kinematics.v. *)

From Coq Require Import ZArith Reals.
From Orthocert Require Import Vec3 SingularValues Kinematics Postulate Claim Checker CheckerPostulate.
Local Open Scope R_scope.

";

/// Of the theorem, after "for every `psi` and `P`".
const CONCLUSION: &str = "regular (orthoglide L a e) P /\\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
";

/// The theorem for every `psi`.
fn all(bits: u32) -> String {
    format!(
        "Lemma checked : check_postulate {bits} q1_low q1_high q2_low q2_high = true.\n\
         Proof. vm_cast_no_check (eq_refl true). Qed.\n\n\
         Theorem certified : forall L a e, 0 < L -> forall psi, 1 < psi -> forall P, in_cube L psi P ->\n  \
         {CONCLUSION}\
         Proof. exact (check_postulate_sound {bits} q1_low q1_high q2_low q2_high checked). Qed.\n"
    )
}

/// The theorem for every `psi` up to the greatest, and its corollary for that one.
fn up_to(greatest: &Exact, bits: u32, [q1, q2]: [&str; 2]) -> String {
    let (exact, psi) = (number(greatest), real(greatest));
    let at_greatest = CONCLUSION.replace("psi", &psi);
    format!(
        "Definition q1 : halves := {q1}.\n\
         Definition q2 : halves := {q2}.\n\n\
         Lemma checked : check_postulate_up_to {bits} {exact} q1 q2 = true.\n\
         Proof. vm_cast_no_check (eq_refl true). Qed.\n\n\
         Lemma greatest_psi : value {exact} = {psi}.\n\
         Proof. cbn [value]. unfold Rdiv. rewrite ?Rinv_1, ?Rmult_1_r. reflexivity. Qed.\n\n\
         Theorem certified : forall L a e, 0 < L -> forall psi, 1 < psi <= {psi} -> forall P, in_cube L psi P ->\n  \
         {CONCLUSION}\
         Proof.\n  intros L a e hL psi h. \
         apply (check_postulate_up_to_sound {bits} {exact} q1 q2 checked); [exact hL |].\n  \
         rewrite greatest_psi. exact h.\nQed.\n\n\
         Corollary at_greatest : forall L a e, 0 < L -> forall P, in_cube L {psi} P ->\n  \
         {at_greatest}\
         Proof.\n  intros L a e hL. apply (certified L a e hL {psi}). split; [| apply Rle_refl].\n  \
         rewrite <- greatest_psi. exact (check_postulate_greatest {bits} {exact} q1 q2 checked).\nQed.\n"
    )
}

/// The number as Rocq's real numbers are written; equal to `value` of [`number`], which Rocq proves.
fn real(x: &Exact) -> String {
    match x {
        Exact::Rational(x) if x.is_integer() && !x.is_negative() => x.numer().to_string(),
        Exact::Rational(x) if x.is_integer() => format!("({})", x.numer()),
        Exact::Rational(x) => format!("({} / {})", x.numer(), x.denom()),
        Exact::Neg(x) => format!("(0 - {})", real(x)),
        Exact::Add(x, y) => format!("({} + {})", real(x), real(y)),
        Exact::Sub(x, y) => format!("({} - {})", real(x), real(y)),
        Exact::Mul(x, y) => format!("({} * {})", real(x), real(y)),
        Exact::Div(x, y) => format!("({} / {})", real(x), real(y)),
        Exact::Sqrt(x) => format!("(sqrt {})", real(x)),
        // Names stand in atlases only, which are not exported.
        Exact::Name(name) => name.to_string(),
    }
}

/// The tree of a face that begins with the next node. The formal checker measures a face from its
/// tight corner: on the face of `q_2`, where `w = 1 - u`, halves and the axes y and z change places,
/// so that the mirrored half is the same.
fn face_node(
    out: &mut String,
    nodes: &mut Iter<'_, Node>,
    face: Face,
    depth: usize,
) -> Result<(), ExportError> {
    let Node { by, split } = nodes.next().ok_or(ExportError::NotATree)?;
    let indent = "  ".repeat(depth.min(MAX_INDENT));
    let corner = match face {
        Face::Q1 => TightCorner::Q1,
        Face::Q2 => TightCorner::Q2,
    };
    let Some(axis) = split else {
        let [step] = by.as_slice() else {
            return Err(ExportError::NotATree);
        };
        let rule = match step {
            Step::BlowUp => "BlowUp",
            Step::Edge(at) if *at == corner => "EdgeRule",
            Step::Mirror => "Mirror",
            other => return Err(ExportError::Rule(other.rule().0)),
        };
        let _ = write!(out, "{indent}(FaceLeaf {rule})");
        return Ok(());
    };
    if !by.is_empty() {
        return Err(ExportError::NotATree);
    }
    let turned = matches!(face, Face::Q2) && !matches!(axis, Axis::Kappa);
    let along = match (axis, turned) {
        (Axis::Kappa, _) => "AlongX",
        (Axis::Y, false) | (Axis::Z, true) => "AlongY",
        (Axis::Z, false) | (Axis::Y, true) => "AlongZ",
        (Axis::X, _) => return Err(ExportError::NotATree),
    };
    let mut halves = [String::new(), String::new()];
    for half in &mut halves {
        face_node(half, nodes, face, depth + 1)?;
    }
    if turned {
        halves.reverse();
    }
    let [first, second] = halves;
    let _ = write!(out, "{indent}(FaceSplit {along}\n{first}\n{second})");
    Ok(())
}
