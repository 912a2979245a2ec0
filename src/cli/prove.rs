//! One design, from its claim to its certificate on the disk: searched for, or found there and
//! re-checked.

use super::check::is_of;
use super::{certify, input, print, Failure, Status};
use crate::design::Design;
use crate::files::digest::sha256;
use crate::files::open::is_stream;
use crate::files::output;
use crate::files::read::Named;
use crate::questions::decide::recalled;
use crate::report::{CertificateFile, Report};
use crate::search::accepted::check;
use crate::search::solver::Verification;
use orthocert_checker::read;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::input::ClaimError;
use std::path::Path;
use std::time::Instant;

/// What is to be done with a design.
pub struct Task<'a> {
    /// The design.
    pub design: &'a Design,
    /// Its file, unless it is the built-in one.
    pub file: Option<&'a Path>,
    /// Where its certificate goes, or is.
    pub target: &'a Path,
    /// The folder below which it has to stay, where the certificates of several go.
    pub below: Option<&'a Path>,
    /// Whether a certificate that is there is to be left out of account.
    pub reprove: bool,
    /// Whether worst values are to be sampled also where nothing is searched for.
    pub table: bool,
    /// When the work on it began.
    pub started: Instant,
}

/// What was found, and the file that its certificate was read from.
type Recalled = (Verification, CertificateFile);

impl Task<'_> {
    /// Does it; `search` decides the claim where there is no certificate of it.
    pub fn run(
        &self,
        search: impl FnOnce(&MachineClaim) -> Result<Verification, ClaimError>,
    ) -> Result<(Report, Status), Failure> {
        let claim = &self.design.claim;
        let recalled = if self.reprove { None } else { self.recall()? };
        let (found, status, file) = match recalled {
            Some((found, file)) => {
                let Some((_, accepted)) = found.decided() else {
                    return Err(Failure::Defect);
                };
                let status = Status::Decided(accepted.verdict);
                (found, status, Some((file, true)))
            }
            None => {
                output::probe(self.target)?;
                let mut found = search(claim).map_err(Failure::input)?;
                match certify::decided(&mut found)? {
                    Some(decision) => {
                        let file = certify::store(self.below, self.target, &decision.text)?;
                        (found, Status::Decided(decision.verdict), Some((file, false)))
                    }
                    None => (found, Status::Undecided, None),
                }
            }
        };
        let mut report =
            found.report(claim, self.started.elapsed()).ok_or_else(Failure::too_large)?;
        report.title.clone_from(&self.design.title);
        report.length_unit = self.design.unit;
        report.notes = self.design.notes();
        report.design = self.file.map(|path| path.to_string_lossy().into_owned());
        match file {
            Some((file, cached)) => {
                report.certificate = Some(file);
                report.cached = cached;
            }
            None => {
                report.earlier_certificate =
                    certify::earlier(self.target, |own| is_of(own, self.design))
            }
        }
        Ok((report, status))
    }

    /// What the certificate at the target amounts to: if it is of this very claim, and if the exact
    /// checker accepts it now.
    fn recall(&self) -> Result<Option<Recalled>, Failure> {
        // Streams hold no earlier certificate, and folders will be refused.
        if is_stream(self.target) || !self.target.exists() || self.target.is_dir() {
            return Ok(None);
        }
        let bytes = match input::certificate(self.target) {
            Ok(bytes) => bytes,
            Err(_) if self.target.is_file() => return Ok(None),
            Err(failure) => return Err(failure),
        };
        let Some(certificate) = read(&bytes).ok().filter(|read| is_of(read, self.design)) else {
            return Ok(None);
        };
        let accepted = match check(&certificate) {
            Ok(accepted) => accepted,
            Err(reason) => {
                let path = self.target.shown();
                print::diagnostic(&format!(
                    "{path}: the certificate that is there is not accepted ({reason}); the design \
                     is proved anew"
                ));
                return Ok(None);
            }
        };
        let file = CertificateFile {
            path: self.target.to_string_lossy().into_owned(),
            bytes: bytes.len(),
            sha256: sha256(&bytes),
        };
        let found = recalled(&self.design.claim, certificate, accepted, self.table)
            .map_err(Failure::input)?;
        Ok(Some((found, file)))
    }
}
