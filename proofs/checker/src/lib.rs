//! Exact, independent checker of orthocert certificates and pavings.
//!
//! A certificate states a theorem about a parallel machine and an argument for it or against it.
//! [`read`] and [`check`](fn@check) accept it only if the argument, recomputed from the claim in integer
//! arithmetic, is complete. There is no floating point and no `unsafe` here or in
//! [`orthocert_kernel`], which has all of the mathematics, and nothing of the program that searched
//! for the proof.
//!
//! [`statement`] has the claim in words.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_macros))]

pub mod statement;

pub use orthocert_kernel::rejected::Rejected;
pub use orthocert_kernel::{certificate, paving};

use certificate::{Certificate, Verdict};

/// Reads a certificate.
///
/// # Errors
/// If it is none, or too large.
pub fn read(bytes: &[u8]) -> Result<Certificate, Rejected> {
    Ok(Certificate::read(bytes)?)
}

/// Checks a certificate, the only way to an accepted verdict: recomputes everything that its proof uses
/// from its claim. Returns its verdict, which is then true.
///
/// # Errors
/// If its proof does not show what its verdict says of its claim.
pub fn check(certificate: &Certificate) -> Result<Verdict, Rejected> {
    orthocert_kernel::check::check(certificate).map(|()| certificate.verdict)
}

/// What `orthocert-check --help` prints.
pub const USAGE: &str = "usage: orthocert-check CERT.json | PAVING

Re-proves an orthocert certificate or paving in exact arithmetic and prints what it establishes.
exit: 0 certified, 1 refuted, 2 bad usage or unreadable file, 5 rejected";

/// Every file of `src`, with its path there, in the order of the paths' bytes.
pub const SOURCES: [(&str, &[u8]); 3] = [
    ("bin/orthocert-check.rs", include_bytes!("bin/orthocert-check.rs")),
    ("lib.rs", include_bytes!("lib.rs")),
    ("statement.rs", include_bytes!("statement.rs")),
];
