//! Certificates of the kernel, beside those of the rules: read, written and checked by it.

use crate::certificate::{Certificate, Proof, Provenance, Verdict, FORMAT};
use crate::check::{syntax, Rejected, TreeSize};
use crate::claim::Claim;
use orthocert_kernel::atlas::{self, AtlasCell, AtlasClaim};
use orthocert_kernel::certificate::{self as kernel, Node, Tree, Unreadable};
use orthocert_kernel::check;
use orthocert_kernel::claim::MachineClaim;
use serde::de::IgnoredAny;
use serde::Deserialize;
use std::fmt;

/// Whether a text is meant as a certificate of the kernel: its claim has a list of requirements, or is
/// of another kind that the kernel has.
pub(crate) fn is_meant(text: &str) -> bool {
    #[derive(Deserialize)]
    struct Header {
        #[serde(rename = "claim")]
        _claim: About,
    }
    #[derive(Deserialize)]
    #[serde(rename_all = "snake_case")]
    enum About {
        Machine {
            #[serde(rename = "require")]
            _require: IgnoredAny,
        },
        Postulate(IgnoredAny),
        NoCube(IgnoredAny),
        Atlas(IgnoredAny),
    }
    serde_json::from_str::<Header>(text).is_ok()
}

/// Reads a certificate of the kernel.
pub(crate) fn read(text: &str) -> Result<Certificate, Rejected> {
    let certificate = kernel::Certificate::read(text).map_err(|unreadable| match unreadable {
        Unreadable::TooLong(bytes) => Rejected::TooLarge(bytes),
        Unreadable::Format(format) => Rejected::Format(crate::check::quoted(&format)),
        Unreadable::Malformed(message) => syntax(&message),
        Unreadable::NotCanonical { at } => {
            syntax(&format_args!("the same certificate is written otherwise, from byte {at} on"))
        }
    })?;
    let kernel::Certificate { claim, verdict, proof, provenance, .. } = certificate;
    let claim = match claim {
        kernel::Claim::Machine(claim) => Claim::Kernel(claim),
        kernel::Claim::Postulate(claim) => Claim::Postulate(claim),
        kernel::Claim::NoCube(claim) => Claim::NoCube(claim),
        kernel::Claim::Atlas(claim) => Claim::Atlas(claim),
        _ => return Err(syntax(&"a claim about machines over workspaces is expected")),
    };
    Ok(Certificate {
        format: FORMAT.to_owned(),
        claim,
        verdict: match verdict {
            kernel::Verdict::Certified => Verdict::Certified,
            kernel::Verdict::Refuted => Verdict::Refuted,
        },
        proof: Proof::Kernel(proof),
        provenance: Provenance { tool: provenance.tool, version: provenance.version },
    })
}

fn verdict_of(verdict: Verdict) -> kernel::Verdict {
    match verdict {
        Verdict::Certified => kernel::Verdict::Certified,
        Verdict::Refuted => kernel::Verdict::Refuted,
    }
}

/// The text of a certificate of the kernel.
pub(crate) fn text(
    certificate: &Certificate,
    proof: &kernel::Proof,
) -> Result<String, serde_json::Error> {
    let claim = match certificate.claim.clone() {
        Claim::Kernel(claim) => kernel::Claim::Machine(claim),
        Claim::Postulate(claim) => kernel::Claim::Postulate(claim),
        Claim::NoCube(claim) => kernel::Claim::NoCube(claim),
        Claim::Atlas(claim) => kernel::Claim::Atlas(claim),
        _ => return Err(serde::ser::Error::custom("the kernel's proof of another claim")),
    };
    let Provenance { tool, version } = certificate.provenance.clone();
    let whole = kernel::Certificate {
        format: FORMAT.to_owned(),
        claim,
        verdict: verdict_of(certificate.verdict),
        proof: proof.clone(),
        provenance: kernel::Provenance { tool, version },
    };
    whole.to_text()
}

/// Accepts a proof, or says why not.
pub(crate) fn check(
    claim: &Claim,
    verdict: Verdict,
    proof: &kernel::Proof,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    let verdict = verdict_of(verdict);
    let checked = match claim {
        Claim::Kernel(claim) => check::check_machine(claim, verdict, proof),
        Claim::Postulate(claim) => check::check_postulate(claim, verdict, proof),
        Claim::NoCube(claim) => check::check_no_cube(claim, verdict, proof),
        _ => return Err(Rejected::VerdictMismatch),
    };
    checked.map_err(Rejected::Kernel)?;
    if let kernel::Proof::Tree(tree) = proof {
        *size = size_of(tree);
    }
    Ok(())
}

/// The nodes of each tree of a proof.
pub fn trees(mut nodes: &[Node]) -> Vec<&[Node]> {
    let mut trees = Vec::new();
    while !nodes.is_empty() {
        let mut open = 1;
        let last = nodes.iter().position(|node| {
            open = if node.split.is_some() { open + 1 } else { open - 1 };
            open == 0
        });
        let (tree, rest) = nodes.split_at(last.map_or(nodes.len(), |last| last + 1));
        trees.push(tree);
        nodes = rest;
    }
    trees
}

/// Accepts an atlas but for the cells that are not wanted, or says why not; adds up the
/// trees of the others.
pub(crate) fn check_atlas(
    claim: &AtlasClaim,
    proof: &kernel::Proof,
    is_wanted: impl Fn(usize) -> bool,
    size: &mut TreeSize,
) -> Result<(), Rejected> {
    let kernel::Proof::Atlas(cells) = proof else { return Err(Rejected::VerdictMismatch) };
    atlas::check_part(claim, cells, &is_wanted).map_err(Rejected::Kernel)?;
    let wanted = cells.iter().enumerate().filter(|(number, _)| is_wanted(*number));
    for (_, cell) in wanted {
        if let AtlasCell::Certified(tree) = cell {
            size.add(size_of(tree));
        }
    }
    Ok(())
}

/// The size and shape of trees together.
pub fn size_of(tree: &Tree) -> TreeSize {
    let mut size = TreeSize { nodes: tree.nodes.len(), ..TreeSize::default() };
    let mut waiting = vec![0];
    for node in &tree.nodes {
        let depth = waiting.pop().unwrap_or(0);
        size.depth = size.depth.max(depth);
        match node.split {
            Some(_) => waiting.extend([depth + 1, depth + 1]),
            None => size.leaves += 1,
        }
        for step in &node.by {
            *size.steps.entry(step.1.name()).or_default() += 1;
        }
        if node.fails.is_some() {
            *size.steps.entry("fails").or_default() += 1;
        }
    }
    size
}

/// The claim in words.
pub(crate) fn statement(claim: &MachineClaim, verdict: Verdict) -> Result<String, fmt::Error> {
    orthocert_kernel::statement::statement(claim, verdict_of(verdict))
}
