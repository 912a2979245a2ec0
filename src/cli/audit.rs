//! `orthocert check` of a folder: every certificate, with the design that it belongs to.

use super::check::examine;
use super::{batch, input, interrupt, print, Failure, Format, Status};
use crate::design::Design;
use crate::exact::decimal::counted;
use crate::files::digest::sha256;
use crate::files::shown::Shown;
use crate::jobs::batch::pair::{pairs, Pair};
use crate::jobs::batch::run::{run as run_jobs, Outcome};
use crate::jobs::batch::{counts, worst, Ending};
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// What became of a certificate, a design, or a pair of them.
#[derive(Clone, Serialize)]
struct Row {
    /// The certificate's path; `None` for a design without one.
    certificate: Option<String>,
    /// The design's path; `None` for a certificate without one.
    design: Option<String>,
    /// What the checker accepts of it, or why that is nothing.
    verdict: Ending,
    /// Why it is not accepted.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    /// The SHA-256 of the certificate's bytes that were checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    sha256: Option<String>,
}

/// The answer for scripts.
#[derive(Serialize)]
struct Answer<'a> {
    accepted: bool,
    pairs: &'a [Row],
    seconds: f64,
    exit_code: u8,
}

/// Re-checks every certificate below `certificates` against the designs below `designs`.
pub fn run(
    certificates: &Path,
    designs: &Path,
    jobs: Option<u64>,
    (format, quiet): (Format, bool),
) -> Result<Status, Failure> {
    let started = Instant::now();
    let pairs: Arc<[Pair]> = pairs(certificates, designs).map_err(Failure::input)?.into();
    let workers = batch::workers(jobs);
    let cancel = interrupt::cancelled();
    let outcomes = run_jobs(Arc::clone(&pairs), workers, cancel, audit, |_, _| {});
    interrupt::unless_cancelled(())?;
    let rows: Option<Vec<Row>> = outcomes
        .into_iter()
        .map(|outcome| match outcome {
            Outcome::Ended(row) => Some(row),
            _ => None,
        })
        .collect();
    let rows = rows.ok_or(Failure::Defect)?;
    let exit_code = worst(rows.iter().map(|row| row.verdict));
    match format {
        Format::Text => print::answer(&text(&rows, quiet))?,
        Format::Json => print::json(&Answer {
            accepted: rows.iter().all(|row| is_accepted(row.verdict)),
            pairs: &rows,
            seconds: started.elapsed().as_secs_f64(),
            exit_code,
        })?,
    }
    Ok(Status::Worst(exit_code))
}

fn is_accepted(ending: Ending) -> bool {
    matches!(ending, Ending::Certified | Ending::Refuted)
}

/// Checks one pair.
fn audit(pair: &Pair) -> Row {
    let name = |path: &Option<std::path::PathBuf>| {
        path.as_ref().map(|path| path.to_string_lossy().into_owned())
    };
    let (certificate, design) = (name(&pair.certificate), name(&pair.design));
    let mut row =
        Row { certificate, design, verdict: Ending::Rejected, reason: None, sha256: None };
    match judge(pair, &mut row.sha256) {
        Ok(verdict) => row.verdict = verdict,
        Err((verdict, reason)) => (row.verdict, row.reason) = (verdict, Some(reason)),
    }
    row
}

fn judge(pair: &Pair, digest: &mut Option<String>) -> Result<Ending, (Ending, String)> {
    let rejected = |reason: &str| Err((Ending::Rejected, reason.to_owned()));
    let (certificate, design) = match (&pair.certificate, &pair.design) {
        (Some(certificate), Some(design)) => (certificate, design),
        (Some(_), None) => return rejected("a certificate without a design"),
        (None, _) => return rejected("a design without a certificate"),
    };
    let bad_input = |message: String| (Ending::BadInput, message);
    let design = Design::read(design).map_err(|error| bad_input(error.to_string()))?;
    let bytes = input::certificate(certificate)
        .map_err(|failure| bad_input(failure.message().to_owned()))?;
    *digest = Some(sha256(&bytes));
    let (_, accepted) =
        examine(&bytes, Some(&design)).map_err(|reason| (Ending::Rejected, reason))?;
    Ok(accepted.verdict.into())
}

fn text(rows: &[Row], quiet: bool) -> String {
    let mut out = String::new();
    for row in rows.iter().filter(|_| !quiet) {
        let name = row.certificate.as_ref().or(row.design.as_ref());
        let name = Shown(name.map_or("", String::as_str));
        let verdict = match row.verdict {
            Ending::Certified => "ACCEPTED: certified".to_owned(),
            Ending::Refuted => "ACCEPTED: refuted".to_owned(),
            other => other.word().to_uppercase(),
        };
        let reason = row.reason.as_deref().and_then(|reason| reason.lines().next());
        let reason = reason.map(|reason| format!(": {}", Shown(reason))).unwrap_or_default();
        let _ = writeln!(out, "{verdict:<19}  {name}{reason}");
    }
    let pairs = counted(rows.len(), "certificate or design", "certificates and designs");
    let blank = if quiet { "" } else { "\n" };
    let _ = writeln!(out, "{blank}{pairs}: {}", counts(rows.iter().map(|row| row.verdict)));
    out
}
