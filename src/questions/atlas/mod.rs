//! Makes the map of an atlas: which of the designs within a box of parameters meet their
//! requirements.
//!
//! Cells of parameters are decided one by one, and those that are not are halved; what becomes of a
//! cell depends on the cell alone. So the map is the same for every number of threads, and parts of
//! it can be made anywhere (`part`).

mod best;
mod decide;
mod kept;
mod margin;
mod part;
mod widest;

pub use best::{best, ends, verdict_at, Best, Standing};
pub use decide::{decide, Decision};
pub use kept::{Kept, KeptError, FORMAT};
pub use margin::{margin, margin_to, tightened};
pub use part::{assemble, grow, waiting, Growing, Stopped, Top};
pub use widest::{widest, Bound, Widest};

use crate::design::AtlasDesign;
use crate::search::accepted::{size_of_all, Accepted};
use crate::search::solver::certificate;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use orthocert_checker::{check_part, Rejected};
use orthocert_kernel::atlas::{walk, AtlasCell};
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::number::{Expression, Operator};
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
    let shares = walk(&cells, claim.parameters.len(), |_, _, _| Ok(()));
    let shares = shares.map_err(Rejected::Kernel)?;
    (claim.certified, claim.refuted) = (fraction(&shares.certified), fraction(&shares.refuted));
    let proof = Proof::Atlas(cells);
    let certificate = certificate(Claim::Atlas(claim), Verdict::Certified, proof);
    check(&certificate)?;
    let size = size_of_all(&certificate.proof);
    let accepted = Accepted { verdict: certificate.verdict, size };
    Ok((certificate, accepted))
}

/// A share as a fraction.
fn fraction(share: &BigRational) -> Expression {
    let whole = |x: &BigInt| Expression::Literal { digits: x.clone(), places: 0 };
    let (p, q) = (whole(share.numer()), whole(share.denom()));
    match share.denom().is_one() {
        true => p,
        false => Expression::Binary(Operator::Div, p.into(), q.into()),
    }
}

/// Has every part of an atlas checked, side by side; of several refusals, the first part's is said.
fn check(certificate: &Certificate) -> Result<(), Rejected> {
    let parts: Vec<Result<(), Rejected>> = (0..PARTS.get())
        .into_par_iter()
        .with_max_len(1)
        .map(|part| check_part(certificate, part, PARTS))
        .collect();
    parts.into_iter().collect()
}
