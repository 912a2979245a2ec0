//! From an answer to a certificate on the disk: what all commands that prove have in common.

use super::{input, Failure};
use crate::files::read::Named;
use crate::files::{digest, output};
pub use crate::questions::decide::as_written;
use crate::report::{CertificateFile, EarlierFile};
use crate::search::solver::Verification;
use orthocert_checker::certificate::{Certificate, Verdict};
use orthocert_checker::read;
use std::path::Path;

/// A verdict, and the certificate of it as it is to be written.
pub struct Decision {
    /// The verdict that the exact checker has accepted.
    pub verdict: Verdict,
    /// The certificate's text.
    pub text: String,
}

/// The decision that an answer amounts to. An answer whose certificate would not read back as the
/// very one that was accepted becomes undecided.
pub fn decided(found: &mut Verification) -> Result<Option<Decision>, Failure> {
    if found.is_cancelled() {
        return Err(Failure::Interrupted);
    }
    let Some((certificate, accepted)) = found.decided() else { return Ok(None) };
    let verdict = accepted.verdict;
    match as_written(certificate) {
        Ok(text) => Ok(Some(Decision { verdict, text })),
        Err(objection) => {
            found.object(objection);
            Ok(None)
        }
    }
}

/// Writes a certificate, whole or not at all; where it is one of a folder's, below that folder.
pub fn store(folder: Option<&Path>, path: &Path, text: &str) -> Result<CertificateFile, Failure> {
    match folder {
        Some(folder) => output::write_below(folder, path, text.as_bytes())?,
        None => output::write(path, text.as_bytes())?,
    }
    let sha256 = digest::sha256(text.as_bytes());
    Ok(CertificateFile { path: path.to_string_lossy().into_owned(), bytes: text.len(), sha256 })
}

/// Writes a certificate that reads back as the very one that was accepted.
pub fn write(
    folder: Option<&Path>,
    path: &Path,
    certificate: &Certificate,
) -> Result<CertificateFile, Failure> {
    let unwritable = |why| Failure::Output(format!("{}: cannot be written: {why}", path.shown()));
    store(folder, path, &as_written(certificate).map_err(unwritable)?)
}

/// Why files of an answer could not be written: told after the answer, which is not lost with them.
#[derive(Default)]
pub struct Unwritten(Option<Failure>);

impl Unwritten {
    /// The file, if it was written.
    pub fn unless(&mut self, stored: Result<CertificateFile, Failure>) -> Option<CertificateFile> {
        match stored {
            Ok(file) => Some(file),
            Err(failure) => {
                self.0.get_or_insert(failure);
                None
            }
        }
    }

    /// The first failure, if there is one.
    pub fn told(self) -> Result<(), Failure> {
        self.0.map_or(Ok(()), Err)
    }
}

/// What stands where a certificate of `claim` would have been written.
pub fn earlier(path: &Path, is_it: impl Fn(&Certificate) -> bool) -> Option<EarlierFile> {
    if !path.is_file() {
        return None;
    }
    let certificate = input::certificate(path).ok().and_then(|bytes| read(&bytes).ok());
    let same_claim = certificate.is_some_and(|certificate| is_it(&certificate));
    Some(EarlierFile { path: path.to_string_lossy().into_owned(), same_claim })
}
