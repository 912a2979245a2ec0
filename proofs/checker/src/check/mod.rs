//! Checking a certificate: the only way to an accepted verdict.
//!
//! | module      | holds                                                               |
//! |-------------|---------------------------------------------------------------------|
//! | `walk`      | the walk over a tree, and what every tree is held to                |
//! | `evaluate`  | the steps of a node on its cell                                     |
//! | `machine`   | trees about a machine over its workspace                            |
//! | `rejected`  | why certificates are rejected                                       |

mod evaluate;
mod machine;
mod rejected;
mod walk;

use crate::certificate::{Certificate, Proof, Verdict, FORMAT, MAX_BYTES};
use crate::claim::Claim;
use crate::model::Model;
use crate::rule::Obligation;
use crate::shown::Shown;
use crate::strict::{self, Strict};
use crate::{kernel, witness};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt;
use std::num::NonZeroUsize;

pub(crate) use machine::check_tree;
pub use rejected::Rejected;

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

impl TreeSize {
    /// Adds those of another tree.
    pub fn add(&mut self, other: TreeSize) {
        self.nodes += other.nodes;
        self.leaves += other.leaves;
        self.depth = self.depth.max(other.depth);
        for (rule, uses) in other.steps {
            *self.steps.entry(rule).or_default() += uses;
        }
    }
}

/// Reads a certificate.
pub fn read(bytes: &[u8]) -> Result<Certificate, Rejected> {
    if bytes.len() > MAX_BYTES {
        return Err(Rejected::TooLarge(bytes.len()));
    }
    let text = std::str::from_utf8(bytes).map_err(|e| syntax(&e))?;
    let certificate = match strictly(text) {
        Ok(certificate) => certificate,
        Err(_) if kernel::is_meant(text) => return kernel::read(text),
        Err(reason) => {
            return Err(match serde_json::from_str(text) {
                // A later version may have any shape.
                Ok(Header { format }) if format != FORMAT => Rejected::Format(quoted(&format)),
                _ => reason,
            });
        }
    };
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

pub(crate) fn syntax(message: &dyn fmt::Display) -> Rejected {
    Rejected::Syntax(quoted(&message.to_string()))
}

/// The beginning of a text that may quote the file, fit for a terminal.
pub(crate) fn quoted(text: &str) -> String {
    let start: String = text.chars().take(MAX_MESSAGE).collect();
    Shown(start).to_string().chars().take(MAX_MESSAGE).collect()
}

/// Checks a certificate: recomputes everything that its proof uses from its claim.
pub fn check(certificate: &Certificate) -> Result<Accepted, Rejected> {
    let size = check_part(certificate, 0, NonZeroUsize::MIN)?;
    Ok(Accepted { verdict: certificate.verdict, size })
}

/// Checks all of a certificate but, of an atlas, the cells whose number is not `part` modulo `of`;
/// returns the size of what was checked. Each cell is of exactly one part: a certificate of which
/// the parts `0..of` are admitted, say by as many threads, is accepted by [`check`](fn@check).
pub fn check_part(
    certificate: &Certificate,
    part: usize,
    of: NonZeroUsize,
) -> Result<TreeSize, Rejected> {
    let mut size = TreeSize::default();
    match (&certificate.claim, &certificate.proof, certificate.verdict) {
        (Claim::Machine(claim), Proof::Tree(tree), Verdict::Certified) => {
            check_tree(claim, tree, &mut size)?;
        }
        (Claim::Machine(claim), Proof::Witness(witness), Verdict::Refuted) => {
            witness::check(claim, witness).map_err(Rejected::Witness)?;
        }
        (Claim::Atlas(claim), Proof::Kernel(proof), Verdict::Certified) => {
            kernel::check_atlas(claim, proof, |number| number % of == part, &mut size)?;
        }
        (claim, Proof::Kernel(proof), verdict) => {
            kernel::check(claim, verdict, proof, &mut size)?;
        }
        _ => return Err(Rejected::VerdictMismatch),
    }
    Ok(size)
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
