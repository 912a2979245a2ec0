//! `orthocert export`.

use super::input::{self, Begun};
use super::{interrupt, print, Failure, Format, Status};
use crate::exact::decimal::grouped;
use crate::files::digest::Summed;
use crate::files::output;
use crate::files::read::Named;
use crate::report::export;
use crate::search::paving::{surface, Surface, SurfaceError};
use clap::Subcommand;
use orthocert_checker::read;
use orthocert_kernel::paving::{is_paving, Reader};
use std::fmt::Display;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    language: Language,
}

#[derive(Debug, Subcommand)]
enum Language {
    /// A Rocq file that states the claim, or that it is false, and proves it by the certificate.
    ///
    /// Of every certificate that the verified checker covers; of others the reason is told. The file is of the
    /// formal development, `coqc -Q proofs/rocq Orthocert FILE.v`, which accepts it if the verified checker, run
    /// in Rocq, accepts the certificate. That takes a second or two for most machines, and minutes for hexapods.
    Rocq {
        /// The certificate
        #[arg(value_name = "CERT.json")]
        certificate: PathBuf,
        /// Where the file is written; without it, on standard output
        #[arg(short, long, value_name = "FILE.v")]
        output: Option<PathBuf>,
    },
    /// The surface of a paving's inner part, with all images, as a VTK XML unstructured grid.
    ///
    /// Quadrilaterals and triangles that share all their edges; cell data `beyond` (what is on the
    /// other side: 0 outer boxes, 1 boxes some of which are undecided, 2 outside the box that is
    /// paved). The paving's evidence is not checked: that is what `check` does.
    Vtk {
        /// The paving
        #[arg(value_name = "PAVING")]
        paving: PathBuf,
        /// Where the file is written
        #[arg(short, long, value_name = "FILE.vtu")]
        output: PathBuf,
    },
    /// The surface of a paving's inner part, with all images, as binary STL.
    ///
    /// Closed: every edge is shared, by two triangles or, where parts touch in an edge, by four. The
    /// corners are rounded to single precision. The paving's evidence is not checked: that is what
    /// `check` does.
    Stl {
        /// The paving
        #[arg(value_name = "PAVING")]
        paving: PathBuf,
        /// Where the file is written
        #[arg(short, long, value_name = "FILE.stl")]
        output: PathBuf,
    },
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    match &arguments.language {
        Language::Rocq { certificate, output } => rocq(certificate, output.as_deref()),
        Language::Vtk { paving, output } => mesh(paving, output, export::vtk::vtu),
        Language::Stl { paving, output } => mesh(paving, output, export::stl::stl),
    }
}

fn rocq(path: &Path, output: Option<&Path>) -> Result<Status, Failure> {
    if let Some(output) = output {
        input::apart(output, [path])?;
        output::probe(output)?;
    }
    let bytes = input::certificate(path)?;
    let refused =
        |reason: &dyn Display| Failure::Input(format!("{}: not exported: {reason}", path.shown()));
    if is_paving(&bytes) {
        return Err(refused(
            &"the evidence of a paving is a stream of cells, which has no form that Rocq reads; \
              `orthocert-verified` proves it again from the file",
        ));
    }
    let certificate = match read(&bytes) {
        Ok(certificate) => certificate,
        Err(reason) => return print::rejected(Format::Text, path, &reason, ""),
    };
    let text = export::rocq::rocq(&certificate).map_err(|error| refused(&error))?;
    match output {
        Some(file) => output::write(file, text.as_bytes())?,
        None => print::answer(&text)?,
    }
    Ok(Status::Done)
}

fn mesh(
    path: &Path,
    output: &Path,
    file: fn(&Surface) -> Result<Vec<u8>, SurfaceError>,
) -> Result<Status, Failure> {
    let begun = Begun::new(path, "a paving")?;
    if !is_paving(&begun.start) {
        let path = path.shown();
        return Err(Failure::Input(format!(
            "{path}: cannot be read: it does not begin like a paving; accepted: a file that `pave` writes"
        )));
    }
    let mut paving = BufReader::new(Summed::new(begun.whole()));
    input::apart(output, [path])?;
    output::probe(output)?;
    let found = Reader::new(&mut paving)
        .map_err(SurfaceError::from)
        .and_then(|reader| surface(reader, interrupt::cancelled()))
        .and_then(|surface| Ok((file(&surface)?, surface)));
    let (bytes, surface) = match found {
        Ok(found) => found,
        Err(SurfaceError::Cancelled) => return Err(Failure::Interrupted),
        Err(SurfaceError::Rejected(reason)) => {
            return print::rejected(Format::Text, path, &reason, "")
        }
        Err(error) => {
            return Err(Failure::Input(format!("{}: not exported: {error}", path.shown())))
        }
    };
    let (sha256, _) = paving
        .into_inner()
        .finish()
        .map_err(|error| Failure::Input(format!("{}: cannot be read: {error}", path.shown())))?;
    output::write(output, &bytes)?;
    print::answer(&format!(
        "{}: {} faces, {} corners\nof {}, not checked, sha256 {sha256}\n",
        output.shown(),
        grouped(surface.faces() as u64),
        grouped(surface.points.len() as u64),
        path.shown(),
    ))?;
    Ok(Status::Done)
}
