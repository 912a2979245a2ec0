//! Checking a certificate: the only way to an accepted verdict.

use crate::atlas::{self, AtlasError};
use crate::cell::{Axis, Cell};
use crate::certificate::{
    Certificate, FacePart, Faces, Node, Proof, Step, Tree, Verdict, Violated, FORMAT, MAX_BYTES,
    MAX_NODES, MAX_STEPS, PRECISIONS,
};
use crate::claim::{Claim, ClaimError, MachineClaim, NoCubeClaim, PostulateClaim, PsiMax};
use crate::enclosure::Enclosure;
use crate::expansion::{Expansion, ExpansionPoint, OutOfReach};
use crate::fixed::Fixed;
use crate::model::Model;
use crate::number::Exact;
use crate::postulate::{self, BlowUp, Face, Half};
use crate::rule::{self, Failure, Obligation};
use crate::strict::{self, Strict};
use crate::witness::{self, WitnessError};
use crate::word::{Word, MAX_BITS};
use serde::Deserialize;
use std::cell::OnceCell;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fmt;

/// Most characters of a message that quotes the file.
const MAX_MESSAGE: usize = 300;

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
    /// A node is split on an axis that its tree does not have.
    NoSuchAxis(usize),
    /// A single tree proves the postulate for a single `psi_max` only.
    OneCubeOnly,
    /// The faces and halves of `kappa` are not those that the claim needs.
    Parts,
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
    /// The claim of an atlas, or of a cell of it, is not well formed.
    AtlasClaim(AtlasError),
    /// The trees of an atlas have too many nodes together.
    TooManyNodes(usize),
    /// The shares that an atlas claims are not those of its cells.
    Shares,
    /// What an atlas says of a cell is not proved.
    Cell {
        /// The cell, counted from zero in preorder.
        cell: usize,
        /// Why.
        reason: Box<Rejected>,
    },
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
            Rejected::NoSuchAxis(node) => {
                write!(f, "node {node} is split on an axis that its tree does not have")
            }
            Rejected::OneCubeOnly => {
                write!(f, "a tree over one cube proves the postulate for a single psi_max only")
            }
            Rejected::Parts => write!(
                f,
                "the parts are not the faces and halves of kappa that the claim needs, in order"
            ),
            Rejected::Step { node, rule, failure } => {
                write!(f, "node {node}: rule \"{rule}\" does not apply: {failure}")
            }
            Rejected::Open { node, obligation } => {
                write!(f, "node {node} is a leaf, but {obligation} is not discharged on its path")
            }
            Rejected::Witness(error) => write!(f, "the witness does not refute: {error}"),
            Rejected::AtlasClaim(error) => {
                write!(f, "the claim of the atlas is not well formed: {error}")
            }
            Rejected::TooManyNodes(nodes) => write!(
                f,
                "the trees of the atlas have {nodes} nodes; at most {MAX_NODES} are accepted"
            ),
            Rejected::Shares => {
                write!(f, "the shares that are claimed are not those of the proof's cells")
            }
            Rejected::Cell { cell, reason } => write!(f, "cell {cell} of the atlas: {reason}"),
        }
    }
}

impl std::error::Error for Rejected {}

/// Reads a certificate.
pub fn read(bytes: &[u8]) -> Result<Certificate, Rejected> {
    if bytes.len() > MAX_BYTES {
        return Err(Rejected::TooLarge(bytes.len()));
    }
    let text = std::str::from_utf8(bytes).map_err(|e| syntax(&e))?;
    let certificate = strictly(text).map_err(|reason| match serde_json::from_str(text) {
        // A later version may have any shape.
        Ok(Header { format }) if format != FORMAT => Rejected::Format(quoted(&format)),
        _ => reason,
    })?;
    if certificate.format != FORMAT {
        return Err(Rejected::Format(quoted(&certificate.format)));
    }
    Ok(certificate)
}

/// What a certificate of any version has.
#[derive(Deserialize)]
struct Header {
    format: String,
}

fn strictly(text: &str) -> Result<Certificate, Rejected> {
    if let Some((at, c)) = strict::foreign_byte(text) {
        return Err(syntax(&format_args!("{c:?} at byte {at}, outside a string")));
    }
    let Strict(certificate) = serde_json::from_str(text).map_err(|e| syntax(&e))?;
    Ok(certificate)
}

fn syntax(message: &dyn fmt::Display) -> Rejected {
    Rejected::Syntax(quoted(&message.to_string()))
}

/// The beginning of a text that may quote the file, fit for a terminal.
pub(crate) fn quoted(text: &str) -> String {
    let escaped = text.chars().flat_map(|c| {
        let plain = matches!(c, '"' | '\'' | '\\').then_some(c);
        plain.into_iter().chain(c.escape_debug().filter(move |_| plain.is_none()))
    });
    escaped.take(MAX_MESSAGE).collect()
}

/// Checks a certificate: recomputes everything that its proof uses from its claim.
pub fn check(certificate: &Certificate) -> Result<Accepted, Rejected> {
    let mut size = TreeSize::default();
    match (&certificate.claim, &certificate.proof, certificate.verdict) {
        (Claim::Machine(claim), Proof::Tree(tree), Verdict::Certified) => {
            check_tree(claim, tree, &mut size)?;
        }
        (Claim::Machine(claim), Proof::Witness(witness), Verdict::Refuted) => {
            witness::check(claim, witness).map_err(Rejected::Witness)?;
        }
        (Claim::NoCube(claim), Proof::Tree(tree), Verdict::Certified) => {
            check_no_cube(claim, tree, &mut size)?;
        }
        (Claim::Postulate(claim), Proof::Tree(tree), Verdict::Certified) => {
            check_one_cube(claim, tree, &mut size)?;
        }
        (Claim::Postulate(claim), Proof::Faces(faces), Verdict::Certified) => {
            check_faces(claim, faces, &mut size)?;
        }
        (Claim::Atlas(claim), Proof::Atlas(map), Verdict::Certified) => {
            atlas::check(claim, map, &mut size)?;
        }
        _ => return Err(Rejected::VerdictMismatch),
    }
    Ok(Accepted { verdict: certificate.verdict, size })
}

/// The obligations that a claim consists of.
pub fn obligations<S>(model: &Model<S>) -> Vec<Obligation> {
    let bounds = &model.bounds;
    let needed = |obligation: &Obligation| match obligation {
        Obligation::SigmaMin => true,
        Obligation::SigmaMax => bounds.k.is_some(),
        Obligation::JointRange => bounds.joint_range.is_some(),
        Obligation::Conditioning => bounds.conditioning.is_some(),
        Obligation::SerialMargin => bounds.serial_margin.is_some(),
        Obligation::ParallelMargin => bounds.parallel_margin.is_some(),
        Obligation::LegAngle => bounds.leg_angle.is_some(),
        Obligation::JointSpeed => bounds.joint_speed.is_some(),
    };
    Obligation::ALL.into_iter().filter(needed).collect()
}

/// A set of obligations, as a bit for each.
pub(crate) type Discharged = u32;
const _: () = assert!(Obligation::ALL.len() <= Discharged::BITS as usize);

pub(crate) fn bit(obligation: Obligation) -> Discharged {
    1 << obligation as u8
}

/// What a step discharges.
pub(crate) fn discharges(step: &Step) -> Discharged {
    match step.rule().1 {
        Some(obligation) => bit(obligation),
        None => Discharged::MAX,
    }
}

/// A tree to be walked: its nodes, the number of the first in the certificate, its axes, and what
/// every leaf has to end with.
struct Walk<'a> {
    nodes: &'a [Node],
    first: usize,
    axes: [Axis; 3],
    obligations: &'a [Obligation],
}

impl Walk<'_> {
    /// Walks the tree in preorder with a stack of cells that wait for their node, each with what
    /// its ancestors have discharged: what holds on a cell holds on its halves. `step` checks one
    /// node's steps on its cell and returns what they discharge.
    ///
    /// **Lemma.** If the walk ends without complaint, every obligation holds at every point of the
    /// root. *Proof.* By induction the leaves below a cell cover it, as its halves do; on each leaf
    /// every obligation is discharged on it or on a cell that contains it. ∎
    fn run(
        &self,
        size: &mut TreeSize,
        mut steps: impl FnMut(&Cell, &Node, usize, &mut TreeSize) -> Result<Discharged, Rejected>,
    ) -> Result<(), Rejected> {
        let mut waiting: Vec<(Cell, Discharged, usize)> = vec![(Cell::ROOT, 0, 0)];
        for (position, node) in self.nodes.iter().enumerate() {
            let index = self.first + position;
            let Some((cell, inherited, depth)) = waiting.pop() else {
                return Err(Rejected::TrailingNodes(self.nodes.len() - position));
            };
            if node.by.len() > MAX_STEPS {
                return Err(Rejected::TooManySteps(index));
            }
            refuse_repetition(inherited, node, index)?;
            let discharged = inherited | steps(&cell, node, index, size)?;
            size.nodes += 1;
            size.depth = size.depth.max(depth);
            if let Some(axis) = node.split {
                if !self.axes.contains(&axis) {
                    return Err(Rejected::NoSuchAxis(index));
                }
                let (lower, upper) = cell.halves(axis).ok_or(Rejected::TooDeep(index))?;
                waiting.push((upper, discharged, depth + 1));
                waiting.push((lower, discharged, depth + 1));
                continue;
            }
            size.leaves += 1;
            if let Some(&obligation) = self.obligations.iter().find(|&&o| discharged & bit(o) == 0)
            {
                return Err(Rejected::Open { node: index, obligation });
            }
        }
        if waiting.is_empty() {
            Ok(())
        } else {
            Err(Rejected::MissingNode)
        }
    }
}

/// Every step discharges something that its path has not discharged: that bounds the work for a tree by its
/// leaves, whatever the file.
fn refuse_repetition(mut done: Discharged, node: &Node, index: usize) -> Result<(), Rejected> {
    for step in &node.by {
        let new = discharges(step) & !done;
        if new == 0 {
            let (rule, _) = step.rule();
            return Err(Rejected::Step { node: index, rule, failure: Failure::Repeated });
        }
        done |= new;
    }
    Ok(())
}

fn admit_precision(bits: u32) -> Result<(), Rejected> {
    if PRECISIONS.contains(&bits) {
        Ok(())
    } else {
        Err(Rejected::Precision(bits))
    }
}

/// Checks that a tree proves a machine claim.
pub(crate) fn check_tree(
    claim: &MachineClaim,
    tree: &Tree,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    admit_precision(tree.precision)?;
    let model = Model::new(claim, tree.precision)?;
    let obligations = obligations(&model);
    let walk = Walk { nodes: &tree.nodes, first: 0, axes: Axis::ALL, obligations: &obligations };
    let coarse = coarse_model(claim, tree);
    let models = (&model, coarse.as_ref());
    walk.run(size, |cell, node, index, size| check_steps(models, cell, node, index, size))
}

/// No cube: a tree over the box of the centres, each of whose leaves has a step `violated`.
///
/// **Lemma.** Then no cube of that side with its centre in the box lies in the region where the
/// claim of `machine` holds, for any machine described. *Proof.* A centre `C` lies in a leaf, which
/// or an ancestor of which has a step with the offset `o`. The cell of the claim moved by `o` is that
/// cell moved by `o`: it contains `C + o`, a point of the cube, and by [`rule::violated`] the claim
/// fails at each of its points for every machine. ∎
fn check_no_cube(claim: &NoCubeClaim, tree: &Tree, size: &mut TreeSize) -> Result<(), Rejected> {
    admit_precision(tree.precision)?;
    claim.validate()?;
    let mut moved: BTreeMap<[i64; 3], Model<Fixed>> = BTreeMap::new();
    let obligations = [Obligation::SigmaMin];
    let walk = Walk { nodes: &tree.nodes, first: 0, axes: Axis::ALL, obligations: &obligations };
    walk.run(size, |cell, node, index, size| {
        let mut discharged = 0;
        for step in &node.by {
            let (rule, _) = step.rule();
            let failed = |failure| Rejected::Step { node: index, rule, failure };
            let Step::Violated(evidence) = step else {
                return Err(failed(Failure::OtherKind));
            };
            let Violated { at, violates } = evidence.as_ref();
            if !moved.contains_key(at) {
                let claim = claim.moved(at).ok_or(failed(Failure::NotOfTheCube))?;
                moved.insert(*at, Model::new(&claim, tree.precision)?);
            }
            let model = moved.get(at).ok_or(failed(Failure::NotOfTheCube))?;
            rule::violated(model, cell, violates).map_err(failed)?;
            discharged |= discharges(step);
            *size.steps.entry(rule).or_default() += 1;
        }
        Ok(discharged)
    })
}

/// The obligations of the postulate. The rules of `sigma_min` enclose `1/s_i`, so `s_i > 0`.
const POSTULATE: [Obligation; 2] = [Obligation::SigmaMin, Obligation::SigmaMax];

/// The postulate for one `psi_max`: a tree over the cube.
fn check_one_cube(
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
fn check_faces(claim: &PostulateClaim, faces: &Faces, size: &mut TreeSize) -> Result<(), Rejected> {
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

/// Nodes from which on a coarse model saves more than it costs.
const WORTH_A_COARSE_MODEL: usize = 20;

/// The model in machine words, of fewer bits than the certificate asks for, where it is worth having.
///
/// A rule holds of whatever its intervals enclose: what it admits in these, it admits. Where it does
/// not, the precision of the certificate decides.
fn coarse_model(claim: &MachineClaim, tree: &Tree) -> Option<Model<Word>> {
    let model = (tree.nodes.len() >= WORTH_A_COARSE_MODEL).then(|| Model::new(claim, MAX_BITS))?;
    Some(model.ok()?.map(&Word::from_fixed))
}

/// Checks every step of a node; returns what they discharge.
fn check_steps(
    (model, coarse): (&Model<Fixed>, Option<&Model<Word>>),
    cell: &Cell,
    node: &Node,
    index: usize,
    size: &mut TreeSize,
) -> Result<Discharged, Rejected> {
    let (centre, coarse_centre) = (OnceCell::new(), OnceCell::new());
    let mut discharged = 0;
    for step in &node.by {
        let (rule, _) = step.rule();
        let admitted = |model| check_step(model, cell, step, &coarse_centre).is_ok();
        if !coarse.is_some_and(admitted) {
            check_step(model, cell, step, &centre).map_err(|failure| Rejected::Step {
                node: index,
                rule,
                failure,
            })?;
        }
        discharged |= discharges(step);
        *size.steps.entry(rule).or_default() += 1;
    }
    Ok(discharged)
}

/// The expansion of a cell about its centre, made for the first step that needs it.
pub(crate) type CentreExpansion<S> = OnceCell<Result<Expansion<S>, OutOfReach>>;

pub(crate) fn check_step<S: Enclosure>(
    model: &Model<S>,
    cell: &Cell,
    step: &Step,
    centre: &CentreExpansion<S>,
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
        Step::Conditioning(evidence) => {
            rule::conditioning(model, about_centre()?, &evidence.rotation, &evidence.mu)
        }
        Step::SerialMargin => rule::serial_margin(model, cell),
        Step::ParallelMargin => rule::parallel_margin(model, cell),
        Step::LegAngle => rule::leg_angle(model, cell),
        Step::Speed => rule::speed(model, about_centre()?),
        Step::Outside => rule::outside(model, cell),
        Step::Violated(_) | Step::BlowUp | Step::Edge(_) | Step::Mirror => Err(Failure::OtherKind),
    }
}

impl Step {
    /// The rule's name and what it discharges; `None` for everything.
    pub fn rule(&self) -> (&'static str, Option<Obligation>) {
        let (name, obligation) = match self {
            Step::Lower(_) => ("lower", Obligation::SigmaMin),
            Step::Corner(_) => ("corner", Obligation::SigmaMin),
            Step::Upper => ("upper", Obligation::SigmaMax),
            Step::Cube => ("cube", Obligation::SigmaMax),
            Step::Range => ("range", Obligation::JointRange),
            Step::Conditioning(_) => ("conditioning", Obligation::Conditioning),
            Step::SerialMargin => ("serial_margin", Obligation::SerialMargin),
            Step::ParallelMargin => ("parallel_margin", Obligation::ParallelMargin),
            Step::LegAngle => ("leg_angle", Obligation::LegAngle),
            Step::Speed => ("speed", Obligation::JointSpeed),
            Step::BlowUp => ("blow_up", Obligation::SigmaMin),
            Step::Edge(_) => ("edge", Obligation::SigmaMin),
            Step::Mirror => ("mirror", Obligation::SigmaMin),
            Step::Outside => return ("outside", None),
            Step::Violated(_) => return ("violated", None),
        };
        (name, Some(obligation))
    }
}
