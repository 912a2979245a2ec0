//! Makes the map of an atlas: which of the designs within a box of parameters meet their
//! requirements.
//!
//! Cells of parameters are decided one by one, and those that are not are halved; what becomes of a
//! cell depends on the cell alone. So the map is the same for every number of threads, and parts of
//! it can be made anywhere (`part`).

mod best;
mod decide;
mod kept;
mod part;
mod widest;

pub use best::{best, ends, verdict_at, Best};
pub use decide::{decide, Decision};
pub use kept::{Kept, KeptError, FORMAT};
pub use part::{assemble, grow, waiting, Growing, Stopped, Top};
pub use widest::{widest, Bound, Widest};

use crate::design::AtlasDesign;
use crate::search::accepted::{size_of_all, Accepted};
use crate::search::solver::certificate;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::One;
use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use orthocert_checker::Rejected;
use orthocert_kernel::atlas::{check_part, walk};
use orthocert_kernel::certificate::{AtlasCell, Claim};
use orthocert_kernel::claim::AtlasClaim;
use orthocert_kernel::number::{Expression, Operator};
use rayon::prelude::*;

/// Parts in which the exact check is done: whatever the number of threads, so that what it says does
/// not depend on it.
const PARTS: usize = 32;

/// The certificate of a map whose cells are these, accepted by the checker, and how many of them are left
/// undecided in it because their proofs ask for more work than a certificate of so many bytes may.
///
/// # Errors
/// If the checker does not accept it.
pub fn certify(
    design: &AtlasDesign,
    mut cells: Vec<AtlasCell>,
) -> Result<(Certificate, Accepted, usize), Rejected> {
    let mut claim = design.claim();
    let mut too_long = 0;
    loop {
        let shares = walk(&cells, claim.parameters.len(), |_, _, _| Ok(()))?;
        (claim.certified, claim.refuted) = (fraction(&shares.certified), fraction(&shares.refuted));
        let refused = check(&claim, &cells);
        if refused.is_empty() {
            break;
        }
        for refused in refused {
            match refused {
                Rejected::Cell(at, why) if *why == Rejected::Work => {
                    cells[at] = AtlasCell::Undecided;
                    too_long += 1;
                }
                refused => return Err(refused),
            }
        }
    }
    let proof = Proof::Atlas(cells);
    let certificate = certificate(Claim::Atlas(claim), Verdict::Certified, proof);
    let size = size_of_all(&certificate.proof);
    let accepted = Accepted { verdict: certificate.verdict, size };
    Ok((certificate, accepted, too_long))
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

/// Has every cell of an atlas checked, so many side by side; the first refusal of each part.
fn check(claim: &AtlasClaim, cells: &[AtlasCell]) -> Vec<Rejected> {
    let parts = (0..PARTS).into_par_iter().with_max_len(1);
    let refused = parts.map(|part| check_part(claim, cells, |number| number % PARTS == part).err());
    refused.collect::<Vec<_>>().into_iter().flatten().collect()
}
