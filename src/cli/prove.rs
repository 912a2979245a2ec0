//! One design, from its claim to its certificate on the disk: searched for, or found there and
//! re-checked.

use super::{certify, input, print, Failure, Status};
use orthocert::design::Design;
use orthocert::digest::sha256;
use orthocert::output;
use orthocert::report::{CertificateFile, Report};
use orthocert::verify::{sampled, Answer, Verification};
use orthocert_checker::claim::{Claim, ClaimError, MachineClaim};
use orthocert_checker::file::is_stream;
use orthocert_checker::shown::Named;
use orthocert_checker::{check, read};
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

/// A verification, and the file that its certificate was read from.
type Recalled = (Verification, CertificateFile);

impl Task<'_> {
    /// Does it; `search` decides the claim where there is no certificate of it.
    pub fn run(
        &self,
        search: impl FnOnce(&MachineClaim) -> Result<Verification, ClaimError>,
    ) -> Result<(Report, Status), Failure> {
        let Claim::Machine(claim) = &self.design.claim else {
            return Err(Failure::Input("a design is about a machine".to_owned()));
        };
        let recalled = if self.reprove { None } else { self.recall(claim)? };
        let (found, status, file) = match recalled {
            Some((found, file)) => {
                let Answer::Decided { accepted, .. } = &found.answer else {
                    return Err(Failure::Defect);
                };
                let status = Status::Decided(accepted.verdict);
                (found, status, Some((file, true)))
            }
            None => {
                output::probe(self.target)?;
                let mut found = search(claim).map_err(Failure::input)?;
                match certify::decide(&mut found.answer)? {
                    Some(decision) => {
                        let file = certify::store(self.below, self.target, &decision.text)?;
                        (found, Status::Decided(decision.verdict), Some((file, false)))
                    }
                    None => (found, Status::Undecided, None),
                }
            }
        };
        let mut report = Report::new(claim, &found, self.started.elapsed()).ok_or_else(|| {
            Failure::Input("the design's numbers exceed what can be reported".to_owned())
        })?;
        report.title.clone_from(&self.design.title);
        report.design = self.file.map(|path| path.to_string_lossy().into_owned());
        match file {
            Some((file, cached)) => {
                report.certificate = Some(file);
                report.cached = cached;
            }
            None => report.earlier_certificate = certify::earlier(self.target, &self.design.claim),
        }
        Ok((report, status))
    }

    /// The verification that the certificate at the target amounts to: if it is of this very claim,
    /// and if the exact checker accepts it now.
    fn recall(&self, claim: &MachineClaim) -> Result<Option<Recalled>, Failure> {
        // Streams hold no earlier certificate, and folders will be refused.
        if is_stream(self.target) || !self.target.exists() || self.target.is_dir() {
            return Ok(None);
        }
        let bytes = match input::certificate(self.target) {
            Ok(bytes) => bytes,
            Err(_) if self.target.is_file() => return Ok(None),
            Err(failure) => return Err(failure),
        };
        let Some(certificate) = read(&bytes).ok().filter(|read| read.claim == self.design.claim)
        else {
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
        let worst = if self.table { sampled(claim).map_err(Failure::input)? } else { Vec::new() };
        let answer = Answer::Decided { certificate: Box::new(certificate), accepted };
        let file = CertificateFile {
            path: self.target.to_string_lossy().into_owned(),
            bytes: bytes.len(),
            sha256: sha256(&bytes),
        };
        Ok(Some((Verification { answer, worst, boxes: 0 }, file)))
    }
}
