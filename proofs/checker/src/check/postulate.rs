//! Trees about the Q1/Q2 postulate: over the cube, or over faces and `kappa`.

use super::walk::{admit_precision, discharges, Discharged, Walk};
use super::{Rejected, TreeSize};
use crate::cell::{Axis, Cell};
use crate::certificate::{FacePart, Faces, Node, Step, Tree};
use crate::claim::{ClaimError, PostulateClaim, PsiMax};
use crate::fixed::Fixed;
use crate::number::Exact;
use crate::postulate::{self, BlowUp, Face, Half};
use crate::rule::{Failure, Obligation};
use std::cmp::Ordering;

/// The obligations of the postulate. The rules of `sigma_min` enclose `1/s_i`, so `s_i > 0`.
const POSTULATE: [Obligation; 2] = [Obligation::SigmaMin, Obligation::SigmaMax];

/// The postulate for one `psi_max`: a tree over the cube.
pub(super) fn check_one_cube(
    claim: &PostulateClaim,
    tree: &Tree,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    admit_precision(tree.precision)?;
    claim.validate()?;
    let (kappa, half) = single_kappa(claim, tree.precision).ok_or(Rejected::OneCubeOnly)?;
    let walk = Walk { nodes: &tree.nodes, first: 0, axes: Axis::ALL, obligations: &POSTULATE };
    walk.run(size, |cell, node, index, size| {
        let blow_up = || postulate::on_cube(&kappa, half, cell);
        postulate_steps(blow_up, None, node, index, size)
    })
}

/// `kappa = 1/psi_max` enclosed, and its half, for a claim about a single `psi_max`.
pub fn single_kappa(claim: &PostulateClaim, bits: u32) -> Option<(Fixed, Half)> {
    let PsiMax::Range(psi) = &claim.psi_max else {
        return None;
    };
    if !psi.is_exact() {
        return None;
    }
    let half = match psi.min.compare(&Exact::integer(2))? {
        Ordering::Less => Half::High,
        Ordering::Equal | Ordering::Greater => Half::Low,
    };
    let kappa = Exact::integer(1).over(psi.min.clone()).ok()?;
    Some((kappa.enclose(0, bits)?, half))
}

/// A tree that a proof by faces consists of, and its range of `kappa`: from `least` to `greatest`.
#[derive(Clone, Debug, PartialEq)]
pub struct PartNeeded {
    /// The face.
    pub face: Face,
    /// The half.
    pub half: Half,
    /// Least `kappa`.
    pub least: Exact,
    /// Greatest `kappa`.
    pub greatest: Exact,
}

/// The trees that a proof of the postulate by faces needs, in order: faces `q_1`, `q_2` over
/// `[1/psi_max, 1/2]` (where that is not empty) and over `[max(1/psi_max, 1/2), 1]`, for the
/// greatest `psi_max`; `1/psi_max` is 0 for "all". "Faces suffice" needs every `kappa'` up to 1, so
/// the least `psi_max` does not matter.
pub fn parts_needed(claim: &PostulateClaim) -> Option<Vec<PartNeeded>> {
    let half = Exact::integer(1).over(Exact::integer(2)).ok()?;
    let least = match &claim.psi_max {
        PsiMax::All => Exact::integer(0),
        PsiMax::Range(range) => Exact::integer(1).over(range.max.clone()).ok()?,
    };
    let mut needed = Vec::new();
    for face in [Face::Q1, Face::Q2] {
        let from = match least.compare(&half)? {
            Ordering::Less => {
                let (least, greatest) = (least.clone(), half.clone());
                needed.push(PartNeeded { face, half: Half::Low, least, greatest });
                half.clone()
            }
            Ordering::Equal | Ordering::Greater => least.clone(),
        };
        let greatest = Exact::integer(1);
        needed.push(PartNeeded { face, half: Half::High, least: from, greatest });
    }
    Some(needed)
}

impl PartNeeded {
    /// `least` and `greatest - least`, enclosed.
    pub fn range(&self, bits: u32) -> Option<(Fixed, Fixed)> {
        let width = self.greatest.clone().minus(self.least.clone()).ok()?;
        Some((self.least.enclose(0, bits)?, width.enclose(0, bits)?))
    }
}

/// The postulate for an interval of `kappa`: a tree for each face and half that is needed.
pub(super) fn check_faces(
    claim: &PostulateClaim,
    faces: &Faces,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    admit_precision(faces.precision)?;
    claim.validate()?;
    let unenclosed = || ClaimError::Precision("psi_max".into());
    let needed = parts_needed(claim).ok_or_else(unenclosed)?;
    let same = |(part, needed): (&FacePart, &PartNeeded)| {
        part.face == needed.face && part.half == needed.half
    };
    if faces.parts.len() != needed.len() || !faces.parts.iter().zip(&needed).all(same) {
        return Err(Rejected::Parts);
    }
    let mut first = 0;
    for (part, needed) in faces.parts.iter().zip(&needed) {
        let (least, width) = needed.range(faces.precision).ok_or_else(unenclosed)?;
        let (half, face) = (needed.half, needed.face);
        let walk =
            Walk { nodes: &part.nodes, first, axes: Axis::FACE, obligations: &POSTULATE[..1] };
        walk.run(size, |cell, node, index, size| {
            let blow_up = || postulate::on_face(&least, &width, half, face, cell);
            postulate_steps(blow_up, Some(cell), node, index, size)
        })?;
        first += part.nodes.len();
    }
    Ok(())
}

/// Checks the steps of a node of the postulate; `face_cell` is the cell of a face's tree.
fn postulate_steps(
    blow_up: impl Fn() -> Option<BlowUp<Fixed>>,
    face_cell: Option<&Cell>,
    node: &Node,
    index: usize,
    size: &mut TreeSize,
) -> Result<Discharged, Rejected> {
    let mut discharged = 0;
    for step in &node.by {
        let (rule, _) = step.rule();
        let blown_up = || blow_up().ok_or(Failure::NotEnclosed);
        let result = match (step, face_cell) {
            (Step::BlowUp, _) => blown_up().and_then(|b| postulate::blow_up(&b)),
            (Step::Edge(corner), _) => blown_up().and_then(|b| postulate::edge(&b, *corner)),
            (Step::Mirror, Some(cell)) => postulate::mirror(cell),
            // The lemma of `rule::cube` holds for every psi_max > 1.
            (Step::Cube, None) => Ok(()),
            _ => Err(Failure::OtherKind),
        };
        result.map_err(|failure| Rejected::Step { node: index, rule, failure })?;
        discharged |= discharges(step);
        *size.steps.entry(rule).or_default() += 1;
    }
    Ok(discharged)
}
