//! Certificates: a claim, a verdict, a proof, as canonical text.

use crate::claim::{AtlasClaim, MachineClaim, NoCubeClaim, PostulateClaim};
use crate::document::{read, Unreadable};
use crate::number::Expression;
use crate::test::Multiplier;
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// Most nodes of a tree.
pub const MOST_NODES: usize = 500_000;
/// Most work of all steps, each counted once for every 64 bits of the precision, and as that of the
/// integers it is in: a bound on time, whatever the file. That of a single machine, or of a cube, may be eight times as much.
pub const MOST_WORK: usize = 1 << 28;
/// The format that is read and written.
pub const FORMAT: &str = "orthocert/2";
/// Most bytes of a certificate.
pub const MOST_BYTES: usize = 16 << 20;
/// Least and greatest precision.
pub const PRECISIONS: std::ops::RangeInclusive<u32> = 32..=1024;

/// A certificate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// [`FORMAT`].
    pub format: String,
    /// What is claimed.
    pub claim: Claim,
    /// Whether it is true.
    pub verdict: Verdict,
    /// Why.
    pub proof: Proof,
    /// Who wrote this. Never trusted, never needed.
    pub provenance: Provenance,
}

/// What a certificate is about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Claim {
    /// A machine over a workspace.
    Machine(MachineClaim),
    /// No cube of some side fits, wherever its centre is in a box.
    NoCube(NoCubeClaim),
    /// The Q1/Q2 postulate.
    Postulate(PostulateClaim),
    /// A machine over a box of parameters, in part.
    Atlas(AtlasClaim),
}

/// What a certificate says of its claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It is a theorem.
    Certified,
    /// It is false.
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

/// The argument.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Proof {
    /// For "certified".
    Tree(Tree),
    /// For "refuted".
    Witness(Witness),
    /// For an atlas.
    Atlas(Vec<AtlasCell>),
}

/// A bisection tree in preorder: a node, then its lower half, then its upper half.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tree {
    /// Fractional bits of the arithmetic.
    pub precision: u32,
    /// The one `Y` of all steps by [`Evidence::Chords`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chords: Option<Multiplier>,
    /// The nodes.
    #[serde(deserialize_with = "few")]
    pub nodes: Vec<Node>,
}

impl Tree {
    /// Whether a step has tolerances apart.
    pub fn takes_tolerances_apart(&self) -> bool {
        self.nodes.iter().flat_map(|node| &node.by).any(|Step(_, by)| by.takes_tolerances_apart())
    }
}

/// Reads no more nodes than a tree may have: their memory is bounded while they are read, not after.
fn few<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Node>, D::Error> {
    struct Few;

    impl<'de> Visitor<'de> for Few {
        type Value = Vec<Node>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "at most {MOST_NODES} nodes")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut all: A) -> Result<Vec<Node>, A::Error> {
            let mut nodes = Vec::new();
            while let Some(node) = all.next_element()? {
                if nodes.len() == MOST_NODES {
                    return Err(A::Error::custom(format!("more than {MOST_NODES} nodes")));
                }
                nodes.push(node);
            }
            Ok(nodes)
        }
    }

    deserializer.deserialize_seq(Few)
}

/// A node. A leaf on whose path every obligation is discharged *holds*; one that says how the claim
/// fails *fails*; any other is *open*.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Node {
    /// What is shown of all of its cell.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub by: Vec<Step>,
    /// The coordinate along which it is halved, counted from zero; none of a leaf.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub split: Option<usize>,
    /// Of a leaf, how the claim fails at every point of its cell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fails: Option<Failure>,
    /// Of a leaf that fails in a claim of no cube, where: its cell is moved by so much.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<i64>,
}

/// An obligation, by its number, and the evidence with which it is discharged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step(pub usize, pub Evidence);

/// Evidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Evidence {
    /// None is needed.
    Test,
    /// None is needed; the rows are divided.
    Divided,
    /// For a least singular value, or a solution.
    Lower(Multiplier),
    /// The same, with divided rows.
    LowerDivided(Multiplier),
    /// For full rank alone.
    Rank(Multiplier),
    /// For a machine that is one to one: the tree's own `Y`.
    Chords,
    /// For a condition number: `Y`, and `mu_0, mu_1, .., mu_m`, over the same `2^places`.
    Conditioning(Multiplier, Vec<i64>),
    /// For accuracy: `Y`, `kappa` over the same `2^places`, and `p`.
    Accuracy(Multiplier, i64, u32),
    /// For two bodies: an affine direction, three rows of `g_0, g_1, .., g_m`.
    Direction(Multiplier),
    /// For a quantity whose absolute value is bounded from below: its sign is negative.
    Negative,
    /// The upper bound on the paper's cube.
    Cube,
    /// The lower bound about a tight corner of it.
    Corner(Corner),
    /// The cell's mirror image is shown: of the postulate.
    Mirror,
    /// No point of the workspace is in the cell: every obligation at once.
    Outside,
    /// The evidence for one machine of the tolerance, less what the others differ by: which one, and a
    /// direction for each matrix.
    Tolerances(Box<Evidence>, String, Vec<Vec<i64>>),
    /// In `tolerances`, evidence for singular values: for each row the upper triangle of an `R`, over `2^places`, not less than
    /// what the quantities of second order change of it together; or none, where each is taken off by itself.
    Together(Box<Evidence>, Vec<Vec<i64>>, u32),
    /// For singular values: evidence for the directions of each part.
    Fan(Vec<Part>),
    /// For a condition number: `mu_0, mu_1, .., mu_m`, over `2^places`, for each row how `mu` depends on the quantities by
    /// which machines differ, over the same, if it does; and evidence for `sigma_min^2 >= mu` and for `sigma_max^2 <= c^2 mu`.
    Between(Vec<i64>, u32, Vec<Vec<i64>>, Box<Evidence>, Box<Evidence>),
    /// The evidence, where it needs the workspace's own inequality: so much of it over `2^places`.
    Inside(Box<Evidence>, i64, u32),
    /// The evidence, where it needs the orientations' own inequality: so much of it over `2^places`.
    Turned(Box<Evidence>, i64, u32),
    /// The evidence, at control points ([`crate::control`]) in place of vertices, with the scaled rows of
    /// platforms that turn.
    Control(Box<Evidence>),
}

impl Evidence {
    /// Itself, or what is about each of its parts.
    pub(crate) fn parts(&self) -> Vec<&Evidence> {
        match self {
            Evidence::Fan(parts) => parts.iter().flat_map(|Part(.., by)| by.parts()).collect(),
            Evidence::Between(.., lower, upper) => [lower.parts(), upper.parts()].concat(),
            by => vec![by],
        }
    }

    /// Whether it has tolerances apart.
    pub(crate) fn takes_tolerances_apart(&self) -> bool {
        self.parts().into_iter().any(|by| matches!(by, Evidence::Tolerances(..)))
    }
}

/// Evidence for the directions `v` between this and the next one, after the last part minus the first: where both have
/// products with `v` of other signs. What says so is taken `n/2^places` times ([`crate::test::Wedge`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Part(pub Vec<i64>, pub i64, pub u32, pub Evidence);

/// A cell of an atlas: a bisection tree of the box of parameters, in preorder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AtlasCell {
    /// It is halved along this parameter, counted from zero.
    Split(usize),
    /// The claim is true for all its values.
    Certified(Tree),
    /// The claim is false for all its values. Numbers of the witness may name parameters.
    Refuted(Witness),
    /// Nothing is said of it.
    Undecided,
}

/// A corner of the paper's cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Corner {
    /// `(q_1, q_1, q_1)`.
    Q1,
    /// `(q_2, q_2, q_2)`.
    Q2,
}

/// A machine and a point at which an obligation fails.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Witness {
    /// Fractional bits of the arithmetic.
    pub precision: u32,
    /// The point; of platforms that turn, with the half-angle tangents of [`crate::statement`] after it.
    pub point: Vec<Expression>,
    /// Values of the quantities that are intervals, in the order of the claim.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub machine: Vec<Expression>,
    /// What fails.
    pub fails: Failure,
}

/// How a claim fails at a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Failure {
    /// A leg does not reach the point, or is serially singular there: a formula of the claim is not
    /// defined.
    Reach,
    /// The obligation of this number; of singular values, with directions.
    Obligation(usize, Vec<Vec<i64>>),
    /// Some point of a box elsewhere in the workspace has the same joint coordinates.
    Same {
        /// The obligation that there is none.
        obligation: usize,
        /// Least coordinates of the box.
        least: Vec<Expression>,
        /// Greatest coordinates.
        greatest: Vec<Expression>,
        /// About the inverse of `M` there.
        inverse: Multiplier,
    },
    /// Of an obligation `sigma_max(M) <= k`, by its number: the row of `M` of this leg, counted from
    /// zero, is longer, or the leg does not reach.
    Row(usize, usize),
    /// `det M` has the opposite sign at this point.
    Singular(Vec<Expression>),
    /// The columns of `M` are linearly dependent, all numbers being rational.
    Dependent,
}

/// Most bytes of a name or version in [`Provenance`].
pub const MOST_LABEL: usize = 64;

/// Who wrote a certificate, in printable ASCII.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// A program.
    #[serde(deserialize_with = "label")]
    pub tool: String,
    /// Its version.
    #[serde(deserialize_with = "label")]
    pub version: String,
}

fn label<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let text = String::deserialize(from)?;
    let is_label = text.bytes().all(|b| b == b' ' || b.is_ascii_graphic());
    match is_label && text.len() <= MOST_LABEL {
        true => Ok(text),
        false => Err(D::Error::custom("provenance: a name of printable ASCII")),
    }
}

impl Certificate {
    /// The certificate with this text.
    ///
    /// # Errors
    /// If there is none.
    pub fn read(text: &(impl AsRef<[u8]> + ?Sized)) -> Result<Self, Unreadable> {
        read(text.as_ref(), FORMAT, MOST_BYTES)
    }
}
