//! Makes the map of an atlas: which of the designs within a box of parameters meet their
//! requirements.
//!
//! Cells of parameters are decided one by one, and those that are not are halved; what becomes of a
//! cell depends on the cell alone. So the map is the same for every number of threads, and parts of
//! it can be made anywhere (`part`).

mod best;
mod contours;
mod decide;
mod margin;
mod page;
mod part;
mod picture;
mod widest;

pub use best::{best, verdict_at, Best, Standing};
pub use contours::{contours, Contour};
pub use decide::{decide, Decision};
pub use margin::{margin, tightened, without_margin};
pub use page::page;
pub use part::{assemble, grow, waiting, Growing, Stopped, Top};
pub use picture::{picture, Point};
pub use widest::{widest, Bound, Widest};

use crate::design::AtlasDesign;
use orthocert_checker::certificate::{Atlas, AtlasCell, Certificate, Proof, Verdict};
use orthocert_checker::claim::Claim;
use orthocert_checker::number::Exact;
use orthocert_checker::{atlas, check_part, Accepted, Rejected, TreeSize};
use rayon::prelude::*;
use std::num::NonZeroUsize;

/// Parts in which the exact check is done: whatever the number of threads, so that what it says does
/// not depend on it.
const PARTS: NonZeroUsize = NonZeroUsize::MIN.saturating_add(31);

/// The certificate of a map whose cells are these, accepted by the checker.
///
/// # Errors
/// If the checker does not accept it.
pub fn certify(
    design: &AtlasDesign,
    cells: Vec<AtlasCell>,
) -> Result<(Certificate, Accepted), Rejected> {
    let mut claim = design.claim();
    let shares = atlas::walk(&cells, claim.parameters.len(), |_, _, _| Ok(()))?;
    claim.certified = Exact::Rational(shares.certified);
    claim.refuted = Exact::Rational(shares.refuted);
    let proof = Proof::Atlas(Atlas { cells });
    let certificate = crate::verify::certificate(Claim::Atlas(claim), Verdict::Certified, proof);
    let size = checked(&certificate)?;
    let accepted = Accepted { verdict: certificate.verdict, size };
    Ok((certificate, accepted))
}

/// Has every part of an atlas checked, side by side; returns its size.
fn checked(certificate: &Certificate) -> Result<TreeSize, Rejected> {
    let parts: Vec<Result<TreeSize, Rejected>> = (0..PARTS.get())
        .into_par_iter()
        .with_max_len(1)
        .map(|part| check_part(certificate, part, PARTS))
        .collect();
    parts.into_iter().try_fold(TreeSize::default(), |mut sum, part| {
        let part = part?;
        sum.nodes += part.nodes;
        sum.leaves += part.leaves;
        sum.depth = sum.depth.max(part.depth);
        for (rule, uses) in part.steps {
            *sum.steps.entry(rule).or_default() += uses;
        }
        Ok(sum)
    })
}
