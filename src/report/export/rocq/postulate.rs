//! Certificates of the Q1/Q2 postulate: the trees of the cube's faces, checked by `kernel/Faces.v`.
//!
//! The exported theorem is about every `psi` up to the greatest of the claim, or every one: "faces
//! suffice" needs every `kappa` up to 1 in any case, so the least `psi_max` of a range does not
//! occur.

use super::kernel::{lowest, node, number};
use super::ExportError;
use num_bigint::BigInt;
use num_traits::{One, Signed};
use orthocert_kernel::certificate::{Corner, Tree};
use orthocert_kernel::claim::{PostulateClaim, PsiMax};
use orthocert_kernel::number::{Expression, Operator};
use orthocert_kernel::postulate::parts;
use std::fmt::Write;

/// The file that states the postulate for the claim's `psi_max` and proves it by the trees. Which
/// trees are needed, `psi_max <= 2` or not, Rocq decides.
///
/// # Errors
/// If the claim is not well formed, or the nodes are not those of its trees.
pub fn postulate(claim: &PostulateClaim, tree: &Tree) -> Result<String, ExportError> {
    let parts = parts(claim).map_err(|_| ExportError::NotWellFormed)?;
    let halves: &[&str] = if parts.len() == 4 { &["_low", "_high"] } else { &["_high"] };
    let mut names = Vec::new();
    let mut out = String::from(HEADER);
    let mut nodes = tree.nodes.iter();
    for (number, part) in parts.iter().enumerate() {
        let face = match part.face {
            Corner::Q1 => "q1",
            Corner::Q2 => "q2",
        };
        let name = format!("{face}{}", halves[number % halves.len()]);
        let _ = writeln!(out, "Definition {name} : tree :=");
        node(&mut out, &mut nodes, 1)?;
        out.push_str(".\n\n");
        names.push(name);
    }
    if nodes.next().is_some() {
        return Err(ExportError::NotATree);
    }
    let _ = writeln!(out, "Definition trees : list tree := [{}].\n", names.join("; "));
    out.push_str(&match &claim.psi_max {
        PsiMax::Every(_) => all(tree.precision),
        PsiMax::Of(psi) => up_to(psi.ends()[1], tree.precision),
    });
    Ok(out)
}

const HEADER: &str = "\
(** Written by `orthocert export rocq`; nothing here is trusted but what is read: the theorem
    `certified`, with the definitions of Postulate.v and Kinematics.v. *)

From Coq Require Import ZArith Reals List.
From Orthocert.kernel Require Import Check Faces.
From Orthocert Require Import Vec3 SingularValues Kinematics Postulate Claim.
Import ListNotations.
Local Open Scope R_scope.

";

/// Of the theorem, after "for every `psi` and `P`".
const CONCLUSION: &str = "regular (orthoglide L a e) P /\\
  forall v, (1 / psi) ^ 2 * norm2 v <= norm2 (mulv (Jinv (orthoglide L a e) P) v) <= psi ^ 2 * norm2 v.
";

/// The theorem for every `psi`.
fn all(bits: u32) -> String {
    format!(
        "Lemma checked : check_postulate {bits} trees = true.\n\
         Proof. vm_cast_no_check (eq_refl true). Qed.\n\n\
         Theorem certified : forall L a e, 0 < L -> forall psi, 1 < psi -> forall P, in_cube L psi P ->\n  \
         {CONCLUSION}\
         Proof. exact (check_postulate_sound {bits} trees checked). Qed.\n"
    )
}

/// The theorem for every `psi` up to the greatest, and its corollary for that one.
fn up_to(greatest: &Expression, bits: u32) -> String {
    let (exact, psi) = (number(greatest), real(greatest));
    let at_greatest = CONCLUSION.replace("psi", &psi);
    format!(
        "Lemma checked : check_postulate_up_to {bits} {exact} trees = true.\n\
         Proof. vm_cast_no_check (eq_refl true). Qed.\n\n\
         Lemma greatest_psi : value {exact} = {psi}.\n\
         Proof. cbn [value]. unfold Rdiv. rewrite ?Rinv_1, ?Rmult_1_r. reflexivity. Qed.\n\n\
         Theorem certified : forall L a e, 0 < L -> forall psi, 1 < psi <= {psi} -> forall P, in_cube L psi P ->\n  \
         {CONCLUSION}\
         Proof.\n  intros L a e hL psi h. \
         apply (check_postulate_up_to_sound {bits} {exact} trees checked); [exact hL |].\n  \
         rewrite greatest_psi. exact h.\nQed.\n\n\
         Corollary at_greatest : forall L a e, 0 < L -> forall P, in_cube L {psi} P ->\n  \
         {at_greatest}\
         Proof.\n  intros L a e hL. apply (certified L a e hL {psi}). split; [| apply Rle_refl].\n  \
         rewrite <- greatest_psi. exact (check_postulate_greatest {bits} {exact} trees checked).\nQed.\n"
    )
}

/// The number as Rocq's real numbers are written; equal to `value` of [`number`], which Rocq proves.
fn real(x: &Expression) -> String {
    match x {
        Expression::Literal { digits, places } => quotient(digits.clone(), *places),
        Expression::Neg(inner) => match &**inner {
            Expression::Literal { digits, places } => quotient(-digits, *places),
            inner => format!("(0 - {})", real(inner)),
        },
        Expression::Binary(operator, left, right) => {
            let sign = match operator {
                Operator::Add => '+',
                Operator::Sub => '-',
                Operator::Mul => '*',
                Operator::Div => '/',
            };
            format!("({} {sign} {})", real(left), real(right))
        }
        Expression::Power(base, n) => {
            let base = real(base);
            (1..*n).fold(base.clone(), |power, _| format!("({power} * {base})"))
        }
        Expression::Sqrt(inner) => format!("(sqrt {})", real(inner)),
        // A number of a claim has none.
        Expression::Name(name) => name.clone(),
        Expression::Varying(range) => range.name.clone(),
    }
}

fn quotient(digits: BigInt, places: u32) -> String {
    match lowest(digits, places) {
        [numer, denom] if denom.is_one() && !numer.is_negative() => numer.to_string(),
        [numer, denom] if denom.is_one() => format!("({numer})"),
        [numer, denom] => format!("({numer} / {denom})"),
    }
}
