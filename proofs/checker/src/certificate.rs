//! Certificates: a claim, a verdict and a proof, as JSON. `FORMAT.md` is normative.

use crate::cell::Axis;
use crate::claim::{Claim, Leg};
use crate::kernel;
use crate::number::Exact;
use crate::rule::{Mu, Rotation, TightCorner};
use crate::strict;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The format that this version reads and writes.
pub const FORMAT: &str = "orthocert/2";
/// Largest certificate, in bytes: with the next three, a bound on memory and time.
pub const MAX_BYTES: usize = 16 << 20;
/// Most nodes of a tree.
pub const MAX_NODES: usize = 500_000;
/// Most steps of one node.
pub const MAX_STEPS: usize = 16;
/// Most bytes of a string of the provenance.
pub const MAX_LABEL: usize = 64;
/// Admissible precisions, in fractional bits.
pub const PRECISIONS: std::ops::RangeInclusive<u32> = 32..=1024;

/// A certificate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// [`FORMAT`].
    pub format: String,
    /// What is claimed.
    pub claim: Claim,
    /// Whether the claim is proved or refuted.
    pub verdict: Verdict,
    /// The argument.
    pub proof: Proof,
    /// Who wrote the certificate. Never trusted, never needed.
    #[serde(deserialize_with = "strict::object")]
    pub provenance: Provenance,
}

/// What a certificate says of its claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The claim is a theorem.
    Certified,
    /// The claim is false.
    Refuted,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Certified => "certified",
            Verdict::Refuted => "refuted",
        })
    }
}

/// The argument for a verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Proof {
    /// A bisection tree, for "certified".
    Tree(#[serde(deserialize_with = "strict::object")] Tree),
    /// A counterexample, for "refuted".
    Witness(#[serde(deserialize_with = "strict::object")] Box<Witness>),
    /// A tree, a witness or the cells of an atlas, of the kernel; read and written as the kernel does.
    #[serde(skip_deserializing)]
    Kernel(orthocert_kernel::certificate::Proof),
}

/// A bisection tree of the workspace in preorder: a node, then, if it is split, its lower part
/// and its upper part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tree {
    /// Fractional bits of the arithmetic in which the rules are to be evaluated.
    pub precision: u32,
    /// The nodes.
    #[serde(deserialize_with = "strict::nodes")]
    pub nodes: Vec<Node>,
}

/// A node: the steps that discharge obligations on its cell, and whether it is split.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Node {
    /// What is shown of the whole cell.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "strict::steps")]
    pub by: Vec<Step>,
    /// The axis on which the cell is halved; absent for a leaf.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub split: Option<Axis>,
}

/// The application of a rule, with its evidence; see [`crate::rule`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Step {
    /// Vertex rule for the lower bound.
    Lower(#[serde(deserialize_with = "strict::object")] Rotation),
    /// The same for wide tolerances, with the ends of each entry of `M`.
    Entrywise(#[serde(deserialize_with = "strict::object")] Rotation),
    /// Vertex rule about a tight corner of the paper's cube.
    Corner(TightCorner),
    /// Vertex rule for the upper bound.
    Upper,
    /// The upper bound on the paper's cube, by hand.
    Cube,
    /// Enclosure of the joint coordinates.
    Range,
    /// Both vertex rules with one affine `mu`, for the condition number.
    Conditioning(#[serde(deserialize_with = "strict::object")] ConditioningEvidence),
    /// Enclosure of `eta_i / L_i`.
    SerialMargin,
    /// Slope form of `det A`.
    ParallelMargin,
    /// Enclosure of `eta_i / L_i`, for the angle between leg and guide.
    LegAngle,
    /// Rows of `M` at the vertices.
    Speed,
    /// The cell has no point of the cylinder.
    Outside,
}

/// Evidence for [`crate::rule::conditioning`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConditioningEvidence {
    /// `W`.
    #[serde(deserialize_with = "strict::object")]
    pub rotation: Rotation,
    /// `mu`.
    pub mu: Mu,
}

/// A point of the workspace, and a machine within its tolerances, at which the claim is false.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Witness {
    /// Fractional bits of the arithmetic in which the violation is to be evaluated.
    pub precision: u32,
    /// `P`, rational, in the claim's unit of length.
    #[serde(deserialize_with = "strict::point")]
    pub point: [Exact; 3],
    /// The machine: the claim's legs without tolerance. Present exactly if the claim has any.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "strict::optional_three"
    )]
    pub machine: Option<[Leg; 3]>,
    /// What is violated there.
    pub violates: Violation,
}

/// A provably violated requirement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Violation {
    /// `|M v|^2 < kappa^2 |v|^2`: some `psi_i > psi_max`.
    SigmaMin(#[serde(deserialize_with = "strict::object")] Direction),
    /// `|M v|^2 > k^2 |v|^2`: some `psi_i < psi_min`.
    SigmaMax(#[serde(deserialize_with = "strict::object")] Direction),
    /// `|row_i of M| > k`, or the leg cannot reach the point: some `psi_i < psi_min`.
    Row(#[serde(deserialize_with = "strict::object")] LegNumber),
    /// A leg cannot reach the point, or is serially singular there.
    Reach(#[serde(deserialize_with = "strict::object")] LegNumber),
    /// A joint coordinate is outside its range.
    JointRange(#[serde(deserialize_with = "strict::object")] LegNumber),
    /// `|M u|^2 |v|^2 > c^2 |M v|^2 |u|^2`.
    Conditioning(#[serde(deserialize_with = "strict::object")] TwoDirections),
    /// `|eta_i| / L_i` is less than its bound.
    SerialMargin(#[serde(deserialize_with = "strict::object")] LegNumber),
    /// `|det A| / (L_1 L_2 L_3)` is less than its bound.
    ParallelMargin,
    /// The angle between leg and guide is greater than its bound.
    LegAngle(#[serde(deserialize_with = "strict::object")] LegNumber),
    /// `|row_i of M|` is greater than its bound.
    JointSpeed(#[serde(deserialize_with = "strict::object")] LegNumber),
    /// `det M` has opposite signs at two points of the workspace.
    Singular(#[serde(deserialize_with = "strict::object")] SecondPoint),
}

/// A direction of motion `v`, not zero.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Direction {
    /// `v`.
    pub vector: [i64; 3],
}

/// Two directions of motion, not zero.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TwoDirections {
    /// `u`, which `M` stretches much.
    pub u: [i64; 3],
    /// `v`, which `M` stretches little.
    pub v: [i64; 3],
}

/// A leg.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LegNumber {
    /// Counted from one.
    pub leg: usize,
}

/// A second point of the workspace.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondPoint {
    /// Rational, in the claim's unit of length.
    #[serde(deserialize_with = "strict::point")]
    pub other: [Exact; 3],
}

/// Who wrote a certificate.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Name of the program: at most [`MAX_LABEL`] printable ASCII characters.
    #[serde(deserialize_with = "strict::label")]
    pub tool: String,
    /// Its version, likewise.
    #[serde(deserialize_with = "strict::label")]
    pub version: String,
}

impl Certificate {
    /// The text of the certificate: one node a line, ending in a line feed; of the kernel's, as it writes them. A
    /// function of the certificate alone.
    ///
    /// # Errors
    /// Never for certificates that [`crate::read`] accepts; serialisation of other values may fail.
    pub fn to_text(&self) -> Result<String, serde_json::Error> {
        let lines = |nodes: &[Node]| -> Result<String, serde_json::Error> {
            let lines: Result<Vec<String>, _> = nodes.iter().map(serde_json::to_string).collect();
            Ok(lines?.join(",\n"))
        };
        let proof = match &self.proof {
            Proof::Kernel(proof) => return kernel::text(self, proof),
            Proof::Witness(witness) => {
                format!("{{\"witness\":{}}}", serde_json::to_string(witness)?)
            }
            Proof::Tree(Tree { precision, nodes }) => {
                let nodes = lines(nodes)?;
                format!("{{\"tree\":{{\"precision\":{precision},\"nodes\":[\n{nodes}\n]}}}}")
            }
        };
        Ok(format!(
            "{{\n\"format\":{},\n\"claim\":{},\n\"verdict\":{},\n\"proof\":{proof},\n\"provenance\":{}\n}}\n",
            serde_json::to_string(&self.format)?,
            serde_json::to_string(&self.claim)?,
            serde_json::to_string(&self.verdict)?,
            serde_json::to_string(&self.provenance)?,
        ))
    }
}
