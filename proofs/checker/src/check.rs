//! Checking a certificate: the only way to an accepted verdict.

use crate::cell::Cell;
use crate::certificate::{
    Certificate, Node, Proof, Step, Tree, Verdict, FORMAT, MAX_BYTES, MAX_NODES, MAX_STEPS,
    PRECISIONS,
};
use crate::claim::{Claim, ClaimError, MachineClaim};
use crate::expansion::{Expansion, ExpansionPoint, OutOfReach};
use crate::fixed::Fixed;
use crate::model::Model;
use crate::rule::{self, Failure, Obligation};
use crate::strict::Strict;
use crate::witness::{self, WitnessError};
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::fmt;

/// What an accepted certificate establishes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Accepted {
    /// The claim is a theorem (`Certified`), or it is false (`Refuted`).
    pub verdict: Verdict,
    /// The size of the tree; all zero for a witness.
    pub size: TreeSize,
}

/// The size and shape of a tree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TreeSize {
    /// Nodes, split or not.
    pub nodes: usize,
    /// Nodes that are not split: the boxes that cover the workspace.
    pub leaves: usize,
    /// Most splits on one path.
    pub depth: usize,
    /// Uses of each rule.
    pub steps: BTreeMap<&'static str, usize>,
}

/// Why a certificate is rejected.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rejected {
    /// More bytes than [`MAX_BYTES`].
    TooLarge(usize),
    /// Not a JSON text of the format's shape.
    Syntax(String),
    /// Another format or version.
    Format(String),
    /// The claim is not well formed.
    Claim(ClaimError),
    /// A tree cannot refute, and a witness cannot certify.
    VerdictMismatch,
    /// The precision is not admissible.
    Precision(u32),
    /// The tree ends where a node is needed.
    MissingNode,
    /// Nodes are left over.
    TrailingNodes(usize),
    /// A node has too many steps.
    TooManySteps(usize),
    /// A cell is split beyond the deepest level.
    TooDeep(usize),
    /// A step does not discharge its obligation.
    Step {
        /// The node, counted from zero in preorder.
        node: usize,
        /// The rule's name.
        rule: &'static str,
        /// Why.
        failure: Failure,
    },
    /// A leaf leaves an obligation open.
    Open {
        /// The node, counted from zero in preorder.
        node: usize,
        /// What is not discharged on its path.
        obligation: Obligation,
    },
    /// The witness does not refute the claim.
    Witness(WitnessError),
}

impl From<ClaimError> for Rejected {
    fn from(error: ClaimError) -> Self {
        Rejected::Claim(error)
    }
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rejected::TooLarge(bytes) => {
                write!(f, "the file has {bytes} bytes; at most {MAX_BYTES} are accepted")
            }
            Rejected::Syntax(message) => write!(f, "not a certificate: {message}"),
            Rejected::Format(found) => {
                write!(f, "format {found:?} is not known; this checker reads {FORMAT:?}")
            }
            Rejected::Claim(error) => write!(f, "the claim is not well formed: {error}"),
            Rejected::VerdictMismatch => write!(
                f,
                "the verdict does not go with the proof: a tree certifies, a witness refutes"
            ),
            Rejected::Precision(bits) => {
                write!(f, "precision {bits} is not within {PRECISIONS:?}")
            }
            Rejected::MissingNode => write!(f, "the tree ends where a node is needed"),
            Rejected::TrailingNodes(count) => {
                write!(f, "{count} nodes are left over after the tree")
            }
            Rejected::TooManySteps(node) => {
                write!(f, "node {node} has more than {MAX_STEPS} steps")
            }
            Rejected::TooDeep(node) => write!(f, "node {node} is split too often"),
            Rejected::Step { node, rule, failure } => {
                write!(f, "node {node}: rule \"{rule}\" does not apply: {failure}")
            }
            Rejected::Open { node, obligation } => {
                write!(f, "node {node} is a leaf, but {obligation} is not discharged on its path")
            }
            Rejected::Witness(error) => write!(f, "the witness does not refute: {error}"),
        }
    }
}

impl std::error::Error for Rejected {}

/// Reads a certificate.
pub fn read(bytes: &[u8]) -> Result<Certificate, Rejected> {
    if bytes.len() > MAX_BYTES {
        return Err(Rejected::TooLarge(bytes.len()));
    }
    let syntax = |e: &dyn fmt::Display| Rejected::Syntax(e.to_string());
    let text = std::str::from_utf8(bytes).map_err(|e| syntax(&e))?;
    let Strict(certificate): Strict<Certificate> =
        serde_json::from_str(text).map_err(|e| syntax(&e))?;
    if certificate.format != FORMAT {
        return Err(Rejected::Format(certificate.format));
    }
    Ok(certificate)
}

/// Checks a certificate: recomputes everything that its proof uses from its claim.
pub fn check(certificate: &Certificate) -> Result<Accepted, Rejected> {
    let Claim::Machine(claim) = &certificate.claim;
    match (&certificate.proof, certificate.verdict) {
        (Proof::Tree(tree), Verdict::Certified) => {
            let size = check_tree(claim, tree)?;
            Ok(Accepted { verdict: Verdict::Certified, size })
        }
        (Proof::Witness(witness), Verdict::Refuted) => {
            witness::check(claim, witness).map_err(Rejected::Witness)?;
            Ok(Accepted { verdict: Verdict::Refuted, size: TreeSize::default() })
        }
        _ => Err(Rejected::VerdictMismatch),
    }
}

/// The obligations that a claim consists of.
pub fn obligations<S>(model: &Model<S>) -> Vec<Obligation> {
    let needed = |obligation: &Obligation| match obligation {
        Obligation::SigmaMin => true,
        Obligation::SigmaMax => model.bounds.k.is_some(),
        Obligation::JointRange => model.bounds.joint_range.is_some(),
    };
    Obligation::ALL.into_iter().filter(needed).collect()
}

/// A set of obligations, as a bit for each.
type Discharged = u8;

fn bit(obligation: Obligation) -> Discharged {
    1 << obligation as u8
}

/// Walks the tree in preorder with a stack of cells that wait for their node, each with what its
/// ancestors have discharged: what holds on a cell holds on its halves.
///
/// **Lemma.** If the walk ends without complaint, every obligation holds at every point of the
/// workspace. *Proof.* By induction the leaves below a cell cover it, as its halves do; on each
/// leaf every obligation is discharged on it or on a cell that contains it. ∎
fn check_tree(claim: &MachineClaim, tree: &Tree) -> Result<TreeSize, Rejected> {
    if !PRECISIONS.contains(&tree.precision) {
        return Err(Rejected::Precision(tree.precision));
    }
    if tree.nodes.len() > MAX_NODES {
        return Err(Rejected::TrailingNodes(tree.nodes.len() - MAX_NODES));
    }
    let model = Model::new(claim, tree.precision)?;
    let obligations = obligations(&model);
    let mut size = TreeSize::default();
    let mut waiting: Vec<(Cell, Discharged, usize)> = vec![(Cell::ROOT, 0, 0)];
    for (index, node) in tree.nodes.iter().enumerate() {
        let Some((cell, inherited, depth)) = waiting.pop() else {
            return Err(Rejected::TrailingNodes(tree.nodes.len() - index));
        };
        let discharged = inherited | check_steps(&model, &cell, node, index, &mut size)?;
        size.nodes += 1;
        size.depth = size.depth.max(depth);
        if let Some(axis) = node.split {
            let (lower, upper) = cell.halves(axis).ok_or(Rejected::TooDeep(index))?;
            waiting.push((upper, discharged, depth + 1));
            waiting.push((lower, discharged, depth + 1));
            continue;
        }
        size.leaves += 1;
        if let Some(&obligation) = obligations.iter().find(|&&o| discharged & bit(o) == 0) {
            return Err(Rejected::Open { node: index, obligation });
        }
    }
    if waiting.is_empty() {
        Ok(size)
    } else {
        Err(Rejected::MissingNode)
    }
}

/// Checks every step of a node; returns what they discharge.
fn check_steps(
    model: &Model<Fixed>,
    cell: &Cell,
    node: &Node,
    index: usize,
    size: &mut TreeSize,
) -> Result<Discharged, Rejected> {
    if node.by.len() > MAX_STEPS {
        return Err(Rejected::TooManySteps(index));
    }
    let centre = OnceCell::new();
    let mut discharged = 0;
    for step in &node.by {
        let (rule, obligation) = step.rule();
        check_step(model, cell, step, &centre).map_err(|failure| Rejected::Step {
            node: index,
            rule,
            failure,
        })?;
        discharged |= bit(obligation);
        *size.steps.entry(rule).or_default() += 1;
    }
    Ok(discharged)
}

/// The expansion of a cell about its centre, made for the first step that needs it.
type CentreExpansion = OnceCell<Result<Expansion<Fixed>, OutOfReach>>;

fn check_step(
    model: &Model<Fixed>,
    cell: &Cell,
    step: &Step,
    centre: &CentreExpansion,
) -> Result<(), Failure> {
    let about_centre = || {
        let expansion = centre.get_or_init(|| Expansion::new(model, cell, ExpansionPoint::Centre));
        expansion.as_ref().map_err(|&error| Failure::from(error))
    };
    match step {
        Step::Lower(rotation) => rule::lower(model, about_centre()?, rotation),
        Step::Upper => rule::upper(model, about_centre()?),
        Step::Range => rule::range(model, cell, about_centre()?),
        Step::Cube => rule::cube(model),
        Step::Corner(corner) => {
            if !corner.touches(cell) {
                return Err(Failure::NotAtCorner);
            }
            rule::corner(model, &Expansion::new(model, cell, corner.expansion_point())?)
        }
    }
}

impl Step {
    /// The rule's name and what it discharges.
    pub fn rule(&self) -> (&'static str, Obligation) {
        match self {
            Step::Lower(_) => ("lower", Obligation::SigmaMin),
            Step::Corner(_) => ("corner", Obligation::SigmaMin),
            Step::Upper => ("upper", Obligation::SigmaMax),
            Step::Cube => ("cube", Obligation::SigmaMax),
            Step::Range => ("range", Obligation::JointRange),
        }
    }
}
