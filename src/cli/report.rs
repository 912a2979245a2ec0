//! `orthocert report`.

use super::{input, print, Failure, Format, Status};
use orthocert::decimal::grouped;
use orthocert::digest::sha256;
use orthocert::page::{raster::Fonts, File, Page};
use orthocert::{output, page};
use orthocert_checker::certificate::Verdict;
use orthocert_checker::{check, read};
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The certificate
    #[arg(value_name = "CERT.json")]
    certificate: PathBuf,
    /// Where the report is written [default: NAME.report.html beside NAME.cert.json]
    #[arg(short, long, value_name = "REPORT.html")]
    output: Option<PathBuf>,
    /// The report's title [default: the certificate's name]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Also write every figure as an SVG file into this folder, which is made if it is not there
    #[arg(long, value_name = "FOLDER")]
    svg: Option<PathBuf>,
    /// Also write every figure as a PNG file into this folder, which is made if it is not there
    #[arg(long, value_name = "FOLDER")]
    png: Option<PathBuf>,
    /// The font for PNG files [default: DejaVu Sans, Liberation Sans, Noto Sans or Arial, where the
    /// system has one]
    #[arg(long, value_name = "FILE.ttf", requires = "png")]
    font: Option<PathBuf>,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// The answer for scripts.
#[derive(Serialize)]
#[serde(untagged)]
enum Answer<'a> {
    Written { accepted: bool, verdict: Verdict, certificate_sha256: String, files: Vec<Written> },
    Rejected { accepted: bool, reason: &'a str },
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
    let bytes = input::certificate(path)?;
    let target = arguments.target()?;
    output::probe(&target)?;
    let fonts = arguments.png.as_ref().map(|_| Fonts::find(arguments.font.as_deref()));
    let fonts = fonts.transpose().map_err(Failure::input)?;
    let checked = read(&bytes).and_then(|certificate| Ok((check(&certificate)?, certificate)));
    let (accepted, certificate) = match checked {
        Ok(checked) => checked,
        Err(reason) => return reject(arguments, &reason.to_string()),
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let file = File { name: &name, bytes: &bytes };
    let page = Page::new(&certificate, &accepted, file, arguments.title.as_deref());
    let mut files = Vec::new();
    let mut write = |path: &Path, bytes: &[u8]| -> Result<(), Failure> {
        output::write(path, bytes)?;
        files.push(Written { path: path.display().to_string(), bytes: bytes.len() });
        Ok(())
    };
    write(&target, page.html().as_bytes())?;
    if let Some(folder) = &arguments.svg {
        make(folder)?;
        for picture in page.pictures() {
            write(&folder.join(format!("{}.svg", picture.name)), picture.file().as_bytes())?;
        }
    }
    if let (Some(folder), Some(fonts)) = (&arguments.png, &fonts) {
        make(folder)?;
        for picture in page.pictures() {
            let png = page::raster::png(picture, fonts).map_err(Failure::Output)?;
            write(&folder.join(format!("{}.png", picture.name)), &png)?;
        }
    }
    let verdict = accepted.verdict;
    match arguments.format {
        Format::Json => print::json(&Answer::Written {
            accepted: true,
            verdict,
            certificate_sha256: sha256(&bytes),
            files,
        })?,
        Format::Text => {
            let mut text = format!("ACCEPTED: {verdict}\n");
            for Written { path, bytes } in files {
                text.push_str(&format!("  {path} ({} bytes)\n", grouped(bytes as u64)));
            }
            print::answer(&text)?;
        }
    }
    Ok(Status::Decided(verdict))
}

fn reject(arguments: &Arguments, reason: &str) -> Result<Status, Failure> {
    match arguments.format {
        Format::Json => print::json(&Answer::Rejected { accepted: false, reason })?,
        Format::Text => {
            let path = arguments.certificate.display();
            print::diagnostic(&format!("{path}: REJECTED: {reason}; no report is written"));
        }
    }
    Ok(Status::Rejected)
}

/// Makes a folder, if it is not there.
fn make(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder).map_err(|error| {
        Failure::Output(format!("{}: cannot be made a folder: {error}", folder.display()))
    })
}

impl Arguments {
    /// Where the report goes: never over the certificate.
    fn target(&self) -> Result<PathBuf, Failure> {
        let target = match &self.output {
            Some(output) => output.clone(),
            None => beside(&self.certificate),
        };
        let same = match (fs::canonicalize(&self.certificate), fs::canonicalize(&target)) {
            (Ok(one), Ok(other)) => one == other,
            _ => false,
        };
        if same {
            let path = target.display();
            let message =
                format!("--output: {path} is the certificate itself; accepted: another path");
            return Err(Failure::Input(message));
        }
        Ok(target)
    }
}

/// `NAME.report.html` beside `NAME.cert.json`.
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
        ] {
            assert_eq!(beside(Path::new(certificate)), Path::new(report));
        }
    }
}
