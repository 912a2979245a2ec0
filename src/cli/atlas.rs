//! `orthocert atlas`, and what it has in common with a merge of parts of an atlas.

use super::effort::{deadline, Work};
use super::{certify, input, interrupt, print, Failure, Format, Status};
use crate::cli::progress::Bar;
use crate::design::{AtlasDesign, Objective};
use crate::exact::decimal::{counted, grouped};
use crate::exact::Exact;
use crate::files::digest::sha256;
use crate::files::folder::{self, FolderError, SUMS};
use crate::files::read::{beside, Named};
use crate::questions::atlas::{
    self, Bound, Growing, Kept, KeptError, Stopped, Top, Widest, FORMAT,
};
use crate::questions::frontier::NoAnswer;
use crate::report::atlas::{
    AtlasReport, BestDesign, MarginBound, MarkedDesign, Part, Standing, MARGIN,
};
use crate::report::map::{self, Point};
use crate::report::page::theorem::theorem;
use crate::report::CertificateFile;
use crate::search::paving::unfinished;
use crate::search::solver::{verify, Answer};
use crate::search::{Budget, Control};
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::certificate::{AtlasCell, Claim, Proof};
use orthocert_kernel::number::Expression;
use std::cmp::Ordering;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The files in the folder of an atlas.
const CERTIFICATE: &str = "atlas.cert.json";
const BEST: &str = "best.cert.json";
const BOUND: &str = "bound.cert.json";
const PICTURE: &str = "map.svg";
const PAGE: &str = "index.html";
/// All that such a folder may have.
const NAMES: [&str; 5] = [CERTIFICATE, BEST, BOUND, PICTURE, PAGE];

/// Its flags.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
A run that is interrupted, killed, or out of time leaves DIR.part, with what it has decided, which --resume
takes up again: the map is the same, byte for byte. While a run writes DIR.part, another one is refused;
what it holds is checked again with the whole map.

Exit code 0 if the map decides anything; 3 if nothing, or if the time was up.")]
pub struct Arguments {
    /// The atlas: a design file with [parameters] and [atlas]
    #[arg(value_name = "ATLAS.toml")]
    atlas: PathBuf,
    /// The folder of the map: a new one, or one with an earlier map and nothing else, which is replaced
    /// [default: NAME.atlas beside NAME.toml]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Take up the interrupted run that left DIR.part
    #[arg(long)]
    resume: bool,
    /// Time after which no further cell is tried: seconds, or a number with ms, s, min or h
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    timeout: Option<String>,
    #[command(flatten)]
    work: Work,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let design = AtlasDesign::read(&arguments.atlas).map_err(Failure::input)?;
    let folder = match &arguments.output {
        Some(folder) => folder.clone(),
        None => beside(&arguments.atlas).with_extension("atlas"),
    };
    probe(&folder)?;
    let deadline = deadline(arguments.timeout.as_deref(), started)?;
    let mut kept = kept(&design, &folder, arguments)?;
    interrupt::grant();
    arguments.work.start_threads()?;
    let grown = map(&design, &mut kept, deadline, arguments.work.quiet);
    let cells = match grown {
        Ok(top) => atlas::assemble(top, Vec::new()).ok_or(Failure::Defect)?,
        Err(stopped) => return left(stopped, &kept, &folder, arguments.work.format),
    };
    let name = arguments.atlas.to_string_lossy().into_owned();
    let report =
        publish(&design, name, cells, &folder, started).map_err(|failure| match failure {
            // Of its own making: no certificate was given.
            Failure::Rejected(reason) => Failure::Output(reason),
            failure => failure,
        })?;
    kept.remove();
    answer(&report, &arguments.work)
}

/// Where what is decided is kept: that of an earlier run, if it is asked for.
fn kept(design: &AtlasDesign, folder: &Path, arguments: &Arguments) -> Result<Kept, Failure> {
    let part = unfinished(folder);
    input::apart(&part, [&arguments.atlas])?;
    let found = match arguments.resume {
        true => Kept::take_up(&part, design),
        false => {
            input::not_taken_up(&part, FORMAT.as_bytes(), "map")?;
            Kept::begin(&part, design)
        }
    };
    found.map_err(|error| match error {
        KeptError::Output(error) => Failure::from(error),
        error => Failure::input(error),
    })
}

/// What a run that did not end leaves.
fn left(stopped: Stopped, kept: &Kept, folder: &Path, format: Format) -> Result<Status, Failure> {
    let time_is_up = match stopped {
        Stopped::Cancelled => false,
        Stopped::Time => true,
        Stopped::Unkept(reason) => return Err(Failure::Output(reason)),
        Stopped::TooLarge => return Err(Failure::Input(stopped.to_string())),
    };
    let (cells, share) = (grouped(kept.cells as u64), 100.0 * kept.share);
    let part = unfinished(folder);
    let held = format!(
        "{} holds what is done, {cells} cells, by which {share:.2} % of the box is decided; \
         --resume takes it up",
        part.shown()
    );
    interrupt::unfinished(time_is_up, &held, Some(&part), format)
}

/// Finds out, before the work, whether the map can be written there.
pub fn probe(folder: &Path) -> Result<(), Failure> {
    Ok(folder::probe(folder, &NAMES)?)
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::Foreign(..) | FolderError::Nameless(_) => {
                Failure::Input(format!("--output: {error}"))
            }
            error => Failure::Output(error.to_string()),
        }
    }
}

/// The files of a map, which are written together.
struct Files<'a> {
    folder: &'a Path,
    all: Vec<(&'static str, String)>,
}

impl Files<'_> {
    fn add(&mut self, name: &'static str, text: String) -> CertificateFile {
        let path = self.folder.join(name).to_string_lossy().into_owned();
        let (bytes, sha256) = (text.len(), sha256(text.as_bytes()));
        self.all.push((name, text));
        CertificateFile { path, bytes, sha256 }
    }
}

/// All cells of a design's map.
fn map(
    design: &AtlasDesign,
    kept: &mut Kept,
    deadline: Option<Instant>,
    quiet: bool,
) -> Result<Vec<Top>, Stopped> {
    Bar::new("cells", quiet).run("", 1, |control| {
        let mut growing = Growing::new(design, control).keeping(kept, deadline);
        atlas::grow(&mut growing, design.whole(), None)
    })
}

/// Has the map accepted by the checker, and writes everything there is to write of it: a function
/// of the design and its cells alone.
pub fn publish(
    design: &AtlasDesign,
    name: String,
    cells: Vec<AtlasCell>,
    folder: &Path,
    started: Instant,
) -> Result<AtlasReport, Failure> {
    let rejected = |reason| Failure::Rejected(format!("the map was not accepted: {reason}"));
    let (certificate, accepted, too_long) = atlas::certify(design, cells).map_err(rejected)?;
    let (Claim::Atlas(claim), Proof::Atlas(cells)) = (&certificate.claim, &certificate.proof)
    else {
        return Err(Failure::Defect);
    };
    if too_long > 0 {
        print::diagnostic(&format!(
            "{} left undecided, which would take the checker longer than it admits; accepted: a smaller \
             claim, or wider bounds",
            counted(too_long, "cell is", "cells are")
        ));
    }
    let share = |x: &Expression| x.rational().map(Exact::Rational).ok_or(Failure::Defect);
    let (certified, refuted) = (share(&claim.certified)?, share(&claim.refuted)?);
    let text = certify::as_written(&certificate).map_err(rejected)?;
    let mut files = Files { folder, all: Vec::new() };
    let best = match &design.objective {
        Some(Objective::Maximise(x)) => {
            best_value(design, (x, Ordering::Greater), cells, &mut files)?
        }
        Some(Objective::Minimise(x)) => best_value(design, (x, Ordering::Less), cells, &mut files)?,
        Some(Objective::WidestMargin) => widest_margin(design, cells, &mut files)?,
        None => None,
    };
    let marks = design.marks.iter().map(|mark| MarkedDesign {
        label: mark.label.clone(),
        at: mark.at.clone(),
        verdict: atlas::verdict_at(design, mark, cells),
    });
    let file = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let mut report = AtlasReport {
        title: design.title.clone(),
        atlas: name,
        parameters: design.parameters.clone(),
        undecided: part(cells, rest(&certified, &refuted)?, Standing::Undecided),
        certified: part(cells, certified, Standing::Certified),
        refuted: part(cells, refuted, Standing::Refuted),
        nodes: accepted.size.nodes,
        best,
        marks: marks.collect(),
        certificate: files.add(CERTIFICATE, text),
        files: vec![file(PICTURE), file(PAGE), file(SUMS)],
        seconds: 0.0,
    };
    let contours = map::contours(design, cells);
    let svg = map::picture(design, cells, &contours, &points(&report));
    let words = theorem(&certificate.claim, accepted.verdict);
    let title = design.title.as_deref().unwrap_or("Atlas");
    let page = map::page(title, (&svg, !contours.is_empty()), &report.facts(), &words);
    files.all.extend([(PICTURE, svg), (PAGE, page)]);
    folder::write(folder, &NAMES, &files.all)?;
    report.seconds = started.elapsed().as_secs_f64();
    Ok(report)
}

/// Prints the report.
pub fn answer(report: &AtlasReport, work: &Work) -> Result<Status, Failure> {
    print::told(work.format, report, || match work.quiet {
        true => report.headline() + "\n",
        false => report.text(),
    })?;
    let decided = report.certified.cells + report.refuted.cells;
    Ok(if decided > 0 { Status::Done } else { Status::Undecided })
}

fn part(cells: &[AtlasCell], share: Exact, standing: Standing) -> Part {
    let same = |cell: &&AtlasCell| match cell {
        AtlasCell::Certified(_) => standing == Standing::Certified,
        AtlasCell::Refuted(_) => standing == Standing::Refuted,
        AtlasCell::Undecided => standing == Standing::Undecided,
        AtlasCell::Split(_) => false,
    };
    Part { cells: cells.iter().filter(same).count(), share }
}

fn rest(certified: &Exact, refuted: &Exact) -> Result<Exact, Failure> {
    let rest = Exact::integer(1).minus(certified.clone());
    rest.and_then(|rest| rest.minus(refuted.clone())).map_err(|_| Failure::Defect)
}

/// The marked designs, and the best one, as they are drawn.
fn points(report: &AtlasReport) -> Vec<Point> {
    let point = |label: &str, at: &[Exact]| Point { label: label.to_owned(), at: at.to_vec() };
    let mut points: Vec<Point> =
        report.marks.iter().map(|mark| point(&mark.label, &mark.at)).collect();
    points.extend(report.best.iter().map(|best| point("best", &best.at)));
    points
}

/// The design with the best value, with an ordinary certificate of its own.
fn best_value(
    design: &AtlasDesign,
    (expression, better): (&Expression, Ordering),
    cells: &[AtlasCell],
    files: &mut Files<'_>,
) -> Result<Option<BestDesign>, Failure> {
    let Some(best) = atlas::best(design, expression, better, cells) else {
        return Ok(None);
    };
    let claim = design.at(&best.at);
    // A part of what was proved of its cell: the same number of boxes is enough in all but rare
    // cases, and where it is not, the report says so.
    let budget = Budget { max_boxes: 10 * design.boxes, deadline: None };
    let mut control = Control { cancel: interrupt::cancelled(), progress: &mut |_| {} };
    let found = verify(&claim, budget, &mut control).map_err(Failure::input)?;
    let certificate = match found.answer {
        Answer::Decided { certificate, .. } => {
            certify::as_written(&certificate).ok().map(|text| files.add(BEST, text))
        }
        Answer::Undecided(_) => None,
        Answer::Cancelled => return Err(Failure::Interrupted),
    };
    Ok(Some(BestDesign {
        at: best.at,
        sense: if better == Ordering::Greater { "maximise" } else { "minimise" },
        objective: expression.to_string(),
        value: best.value,
        certificate,
        bound: None,
    }))
}

/// Adds a certificate that the checker accepts as it is written.
fn stored(
    files: &mut Files<'_>,
    name: &'static str,
    certificate: &Certificate,
) -> Result<CertificateFile, Failure> {
    let text = certify::as_written(certificate)
        .map_err(|reason| Failure::Output(format!("{name} was not accepted: {reason}")))?;
    Ok(files.add(name, text))
}

/// The design with the widest margin, with the certificates of both sides.
fn widest_margin(
    design: &AtlasDesign,
    cells: &[AtlasCell],
    files: &mut Files<'_>,
) -> Result<Option<BestDesign>, Failure> {
    let found =
        atlas::widest(design, cells, interrupt::cancelled()).map_err(|none| match none {
            NoAnswer::Cancelled => Failure::Interrupted,
            other => Failure::input(other),
        })?;
    let Some(Widest { at, margin, certificate, bound }) = found else {
        return Ok(None);
    };
    let certificate = Some(stored(files, BEST, &certificate)?);
    let bound = match bound {
        Some(Bound { margin: value, certificate }) => {
            Some(MarginBound { value, certificate: stored(files, BOUND, &certificate)? })
        }
        None => None,
    };
    let objective = MARGIN.to_owned();
    Ok(Some(BestDesign { at, sense: "maximise", objective, value: margin, certificate, bound }))
}
