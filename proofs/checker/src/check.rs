//! Reading and checking a certificate: the only way to an accepted verdict.

use orthocert_kernel::certificate::{Certificate, Verdict};
use orthocert_kernel::document::Unreadable;
use orthocert_kernel::{check, rejected};
use thiserror::Error;

/// Why a certificate is rejected.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Rejected {
    /// There is none.
    #[error("not a certificate: {0}")]
    Unreadable(#[from] Unreadable),
    /// The claim is not well formed, or the proof does not show it.
    #[error("{0}")]
    Kernel(#[from] rejected::Rejected),
}

/// Reads a certificate.
///
/// # Errors
/// If it is none, or too large.
pub fn read(bytes: &[u8]) -> Result<Certificate, Rejected> {
    Ok(Certificate::read(bytes)?)
}

/// Checks a certificate: recomputes everything that its proof uses from its claim. Returns its verdict,
/// which is then true.
///
/// # Errors
/// If its proof does not show what its verdict says of its claim.
pub fn check(certificate: &Certificate) -> Result<Verdict, Rejected> {
    check::check(certificate)?;
    Ok(certificate.verdict)
}
