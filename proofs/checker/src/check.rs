//! Reading and checking a certificate: the only way to an accepted verdict.

use crate::shown::Shown;
use orthocert_kernel::certificate::{Certificate, Unreadable, Verdict, FORMAT, MOST_BYTES};
use orthocert_kernel::{check, rejected};
use std::fmt;

/// Most characters of a message that quotes the file.
const MAX_MESSAGE: usize = 300;

/// Why a certificate is rejected.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rejected {
    /// More bytes than [`MOST_BYTES`].
    TooLarge(usize),
    /// Not a text of the format.
    Syntax(String),
    /// Another format or version.
    Format(String),
    /// The claim is not well formed, or the proof does not show it.
    Kernel(rejected::Rejected),
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rejected::TooLarge(bytes) => {
                write!(f, "the file has {bytes} bytes; at most {MOST_BYTES} are accepted")
            }
            Rejected::Syntax(message) => write!(f, "not a certificate: {message}"),
            Rejected::Format(found) => {
                write!(f, "format {found:?} is not known; this checker reads {FORMAT:?}")
            }
            Rejected::Kernel(reason) => write!(f, "{reason}"),
        }
    }
}

impl std::error::Error for Rejected {}

/// Reads a certificate.
///
/// # Errors
/// If it is none, or too large.
pub fn read(bytes: &[u8]) -> Result<Certificate, Rejected> {
    if bytes.len() > MOST_BYTES {
        return Err(Rejected::TooLarge(bytes.len()));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| syntax(&error))?;
    Certificate::read(text).map_err(|unreadable| match unreadable {
        Unreadable::TooLong(bytes) => Rejected::TooLarge(bytes),
        Unreadable::Format(format) => Rejected::Format(quoted(&format)),
        Unreadable::Malformed(message) => syntax(&message),
        Unreadable::NotCanonical { at } => {
            syntax(&format_args!("the same certificate is written otherwise, from byte {at} on"))
        }
    })
}

fn syntax(message: &dyn fmt::Display) -> Rejected {
    Rejected::Syntax(quoted(&message.to_string()))
}

/// The beginning of a text that may quote the file, fit for a terminal.
fn quoted(text: &str) -> String {
    let start: String = text.chars().take(MAX_MESSAGE).collect();
    Shown(start).to_string().chars().take(MAX_MESSAGE).collect()
}

/// Checks a certificate: recomputes everything that its proof uses from its claim. Returns its verdict,
/// which is then true.
///
/// # Errors
/// If its proof does not show what its verdict says of its claim.
pub fn check(certificate: &Certificate) -> Result<Verdict, Rejected> {
    check::check(certificate).map_err(Rejected::Kernel).map(|()| certificate.verdict)
}
