//! `orthocert report`.

use super::check::{examine, is_of};
use super::input::{self, Begun};
use super::{interrupt, print, Failure, Format, Status};
use crate::design::Design;
use crate::exact::decimal::grouped;
use crate::files::digest::sha256;
use crate::files::output;
use crate::files::read::Named;
use crate::files::shown::Shown;
use crate::questions::summary::signed;
use crate::report::page::paving::{PavingPage, DEPTH};
use crate::report::page::{File, Page, Picture};
use crate::search::paving::{components, Components, Decider, Detail, SurfaceError, Tree};
use orthocert_checker::certificate::{Certificate, Verdict};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::paving::{self, is_paving, Accepted, Reader, Share, Subject};
use serde::Serialize;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The certificate, or a paving
    #[arg(value_name = "CERT.json|PAVING")]
    certificate: PathBuf,
    /// Where the report is written [default: NAME.report.html beside NAME.cert.json,
    /// NAME.paving.report.html beside NAME.paving]
    #[arg(short, long, value_name = "REPORT.html")]
    output: Option<PathBuf>,
    /// The design that the certificate is about, for its title and unit of lengths; another's is
    /// refused [default: NAME.toml beside NAME.cert.json, if it is that design]
    #[arg(long, value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// The report's title [default: the design's, or the certificate's name]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Also write every figure as an SVG file into this folder, which is made if it is not there
    #[arg(long, value_name = "FOLDER")]
    svg: Option<PathBuf>,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Megabytes for the table of a paving's components, which is left out beyond.
const MEMORY: u64 = 1024;

/// Largest paving that is reported on, in bytes.
const MAX_PAVING: u64 = 1 << 30;

/// The answer for scripts.
#[derive(Serialize)]
#[serde(untagged)]
enum Answer<'a> {
    Written {
        accepted: bool,
        verdict: Verdict,
        certificate_sha256: String,
        files: &'a [Written],
    },
    Paving {
        accepted: bool,
        inner_share: Share,
        boundary_share: Share,
        paving_sha256: String,
        files: &'a [Written],
    },
}

/// A file that was written.
#[derive(Serialize)]
struct Written {
    path: String,
    bytes: usize,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let path = &arguments.certificate;
    let design = arguments.design.as_deref().map(Design::read).transpose();
    let design = design.map_err(Failure::input)?;
    let begun = Begun::new(path, "a certificate or a paving")?;
    let target = arguments.target()?;
    output::probe(&target)?;
    if is_paving(&begun.start) {
        if arguments.design.is_some() {
            let refused = "--design: found a paving; accepted: a certificate";
            return Err(Failure::Input(refused.to_owned()));
        }
        let mut bytes = Vec::new();
        begun.whole().take(MAX_PAVING + 1).read_to_end(&mut bytes).map_err(|error| {
            Failure::Input(format!("{}: cannot be read: {error}", path.shown()))
        })?;
        if bytes.len() as u64 > MAX_PAVING {
            let path = path.shown();
            return Err(Failure::Input(format!("{path}: cannot be reported on: more than 1 GiB")));
        }
        return of_paving(arguments, &bytes, &target);
    }
    let bytes = begun.start;
    let (certificate, accepted) = match examine(&bytes, design.as_ref()) {
        Ok(examined) => examined,
        Err(reason) => return reject(arguments, &reason),
    };
    let design = design.or_else(|| arguments.design_beside(&certificate));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let file = File { name: &name, bytes: &bytes };
    let title = arguments.title.as_deref().or(design.as_ref().and_then(|own| own.title.as_deref()));
    let unit = design.as_ref().and_then(|own| own.unit);
    let notes = design.as_ref().map(Design::notes).unwrap_or_default();
    let page = Page::new(&certificate, &accepted, file, title, unit).noting(notes);
    let page = page.signing(|claim| signed(claim, unit));
    let pictures: Vec<&Picture> = page.pictures().collect();
    let files = arguments.write(&target, &page.html(), &pictures)?;
    let verdict = accepted.verdict;
    let certificate_sha256 = sha256(&bytes);
    let answer = Answer::Written { accepted: true, verdict, certificate_sha256, files: &files };
    print::told(arguments.format, &answer, || listed(&verdict.to_string(), &files))?;
    Ok(Status::Decided(verdict))
}

fn listed(verdict: &str, files: &[Written]) -> String {
    let mut text = format!("ACCEPTED: {verdict}\n");
    for Written { path, bytes } in files {
        text.push_str(&format!("  {} ({} bytes)\n", Shown(path), grouped(*bytes as u64)));
    }
    text
}

fn of_paving(arguments: &Arguments, bytes: &[u8], target: &Path) -> Result<Status, Failure> {
    let (accepted, tree, components) = match examined(bytes) {
        Ok(examined) => examined,
        Err(SurfaceError::Cancelled) => return Err(Failure::Interrupted),
        Err(SurfaceError::Rejected(reason)) => return reject(arguments, &reason.to_string()),
        Err(error) => return Err(Failure::Input(format!("{}: {error}", arguments.shown()))),
    };
    let name = arguments.certificate.file_name().unwrap_or_default().to_string_lossy();
    let file = File { name: &name, bytes };
    let design = arguments.design_of_paving(&accepted.header.claim.machine);
    let title = arguments.title.as_deref().or(design.as_ref().and_then(|own| own.title.as_deref()));
    let unit = design.as_ref().and_then(|own| own.unit);
    let page = PavingPage::new(&accepted, &tree, components.as_ref(), file, title, unit);
    let page = page.ok_or_else(|| {
        let path = arguments.shown();
        Failure::Input(format!("{path}: the box's ends are beyond what floating point can show"))
    })?;
    let pictures: Vec<&Picture> = page.pictures().collect();
    let files = arguments.write(target, &page.html(), &pictures)?;
    let answer = Answer::Paving {
        accepted: true,
        inner_share: accepted.summary.inner_share,
        boundary_share: accepted.summary.boundary_share,
        paving_sha256: sha256(bytes),
        files: &files,
    };
    print::told(arguments.format, &answer, || listed("paving", &files))?;
    Ok(Status::Done)
}

/// What the exact checker says of a paving, its tree, and the components of its inner part.
fn examined(bytes: &[u8]) -> Result<(Accepted, Tree, Option<Components>), SurfaceError> {
    let accepted = paving::check(bytes)?;
    let (header, tree) =
        Tree::read(Reader::new(bytes)?, Detail::Depth(DEPTH), interrupt::cancelled())?;
    let subject = Subject::new(&header)?;
    let decider = Decider::new(&subject)?;
    let components = components(&mut Reader::new(bytes)?, &decider, MEMORY << 20)?;
    Ok((accepted, tree, components))
}

fn reject(arguments: &Arguments, reason: &str) -> Result<Status, Failure> {
    let path = &arguments.certificate;
    let hint = input::design_hint(path) + "; no report is written";
    print::rejected(arguments.format, path, &reason, &hint)
}

impl Arguments {
    fn shown(&self) -> Shown<std::ffi::os_str::Display<'_>> {
        self.certificate.shown()
    }

    /// The design beside the certificate, if the certificate is about it.
    fn design_beside(&self, certificate: &Certificate) -> Option<Design> {
        self.beside(".cert.json").filter(|design| is_of(certificate, design))
    }

    /// The design beside the paving, if that is about it, in whatever box.
    fn design_of_paving(&self, claim: &MachineClaim) -> Option<Design> {
        let workspace = || claim.workspace.clone();
        let searched = |own: &Design| MachineClaim { workspace: workspace(), ..own.claim.clone() };
        self.beside(".paving").filter(|own| searched(own) == *claim)
    }

    fn beside(&self, suffix: &str) -> Option<Design> {
        let name = self.certificate.file_name()?.to_str()?.strip_suffix(suffix)?;
        let path = self.certificate.with_file_name(format!("{name}.toml"));
        path.is_file().then(|| Design::read(&path).ok())?
    }

    /// Writes the page, and the figures that are asked for.
    fn write(
        &self,
        target: &Path,
        html: &str,
        pictures: &[&Picture],
    ) -> Result<Vec<Written>, Failure> {
        let mut files = Vec::new();
        let mut write = |folder: Option<&Path>, path: &Path, bytes: &[u8]| -> Result<(), Failure> {
            self.apart(path)?;
            match folder {
                Some(folder) => output::write_below(folder, path, bytes)?,
                None => output::write(path, bytes)?,
            }
            files.push(Written { path: path.to_string_lossy().into_owned(), bytes: bytes.len() });
            Ok(())
        };
        write(None, target, html.as_bytes())?;
        if let Some(folder) = &self.svg {
            for picture in pictures {
                let path = folder.join(format!("{}.svg", picture.name));
                write(Some(folder), &path, picture.file().as_bytes())?;
            }
        }
        Ok(files)
    }

    /// Where the report goes: never over what it is about.
    fn target(&self) -> Result<PathBuf, Failure> {
        let target = match &self.output {
            Some(output) => output.clone(),
            None => beside(&self.certificate),
        };
        self.apart(&target)?;
        Ok(target)
    }

    fn apart(&self, output: &Path) -> Result<(), Failure> {
        input::apart(output, [&self.certificate].into_iter().chain(&self.design))
    }
}

/// `NAME.report.html` beside `NAME.cert.json`, `NAME.paving.report.html` beside `NAME.paving`.
fn beside(certificate: &Path) -> PathBuf {
    let name = certificate.file_name().unwrap_or_default();
    let mut report = match name.to_str() {
        Some(text) => {
            let text = text.strip_suffix(".json").unwrap_or(text);
            text.strip_suffix(".cert").unwrap_or(text).into()
        }
        None => name.to_owned(),
    };
    report.push(".report.html");
    certificate.with_file_name(report)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_stand_beside_their_certificates() {
        for (certificate, report) in [
            ("a.cert.json", "a.report.html"),
            ("x/y/delta.v2.json", "x/y/delta.v2.report.html"),
            ("x/plain", "x/plain.report.html"),
            ("x/region.paving", "x/region.paving.report.html"),
        ] {
            assert_eq!(beside(Path::new(certificate)), Path::new(report));
        }
    }
}
