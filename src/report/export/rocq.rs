//! Certificates as files of the formal development in `proofs/rocq`.
//!
//! An exported file holds a claim in exact numbers, a bisection tree, and a theorem about real
//! numbers that mentions the claim and not the tree. Rocq computes the check and accepts the
//! theorem, or it does not: nothing here has to be trusted. What a reader has to look at is the
//! claim and the theorem in the file.

use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use orthocert_kernel::certificate::Claim;

mod kernel;
mod postulate;

pub use postulate::postulate;

/// What is exported.
const ONLY: &str =
    "the postulate is exported, and of machines, certified claims about sliders, struts and \
     planar legs that do not turn the platform, over a box or a cylinder, of transmission, ranges of \
     joints that are lengths, joint speeds, condition numbers, one stiffness of all joints, and margins \
     to singularities";

/// Why a certificate is not exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// It refutes.
    #[error("the certificate refutes its claim; {ONLY}")]
    Refutes,
    /// It is an atlas.
    #[error("the claim is about a box of parameters; {ONLY}")]
    Atlas,
    /// The platform turns, or the mechanism is given by formulas.
    #[error("the platform turns, or the mechanism is given by formulas; {ONLY}")]
    NotTranslational,
    /// A leg is an arm.
    #[error("a leg is an arm; {ONLY}")]
    Drive,
    /// It is about cubes that do not fit.
    #[error("the claim is that no cube fits; {ONLY}")]
    NoCube,
    /// It is about the paper's cube.
    #[error("the claim is about the paper's cube, of which Closed.v has the theorem; {ONLY}")]
    Cube,
    /// The claim bounds this quantity.
    #[error("the claim bounds \"{0}\", which the formal kernel lacks; {ONLY}")]
    Quantity(&'static str),
    /// The kernel does not accept the claim.
    #[error("the claim is not well formed")]
    NotWellFormed,
    /// The tree has this evidence.
    #[error("the proof has the evidence \"{0}\", which the formal checker lacks; {ONLY}")]
    Evidence(&'static str),
    /// The nodes are not those of one tree, or of the trees of the faces.
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
    match (&certificate.claim, &certificate.proof) {
        (Claim::Machine(claim), proof) => kernel::kernel(claim, proof),
        (Claim::Postulate(claim), Proof::Tree(tree)) => postulate(claim, tree),
        (Claim::NoCube(_), _) => Err(ExportError::NoCube),
        (Claim::Atlas(_), _) => Err(ExportError::Atlas),
        (Claim::Postulate(_), _) => Err(ExportError::NotATree),
    }
}

/// Deeper nodes are not indented further.
const MAX_INDENT: usize = 24;
