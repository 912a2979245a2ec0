//! `orthocert pave`.

use super::{effort, input, interrupt, print, progress::Bar, Failure, Format, Status};
use crate::design::{written, Design};
use crate::exact::decimal::{percent, Toward};
use crate::exact::Exact;
use crate::files::digest::Summed;
use crate::files::output;
use crate::files::read::{beside, Named};
use crate::report::paving::{unit_of_volume, PavingReport};
use crate::search::paving::{
    are_places, components, depth_for_edge, in_box, pave, unfinished, Components, Decider, Goal,
    PaveError, Resume, DEEPEST,
};
use num_rational::BigRational;
use num_traits::{FromPrimitive, Zero};
use orthocert_kernel::claim::{MachineClaim, Orientation, Workspace};
use orthocert_kernel::number::Expression;
use orthocert_kernel::paving::{names, Reader, Rejected, Subject};
use std::cmp::Ordering;
use std::fs::{self, OpenOptions};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The gap that is aimed at by default.
const GAP: &str = "0.05";
/// Boxes tried by default, about.
const MAX_BOXES: u64 = 50_000_000;
/// Megabytes for components by default.
pub const MEMORY: u64 = 1024;

/// Its flags.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The box is [workspace] min and max of the design, or --box. The region is the set of its points at which all
requirements hold, for every machine of the tolerance; with --coordinates, the set of their values at which
all requirements hold for every machine and all values of the others in the workspace. Without --precision and --volume-gap the gap
that is aimed at is 0.05. A run that is interrupted, or whose time is up (exit code 3), leaves what it has done, if
anything, in PAVING.part, which --resume checks and takes up again: the paving is the same, byte for byte. So it is for every number of threads. While a run writes
PAVING.part, another one is refused; nothing is said of bytes that another program put there.")]
pub struct Arguments {
    /// The design; its workspace is the box that is searched, without --box
    #[arg(value_name = "DESIGN.toml")]
    design: PathBuf,
    /// The box that is searched, in the place of the design's workspace, which may then be any
    #[arg(long = "box", value_name = "X0,X1,Y0,Y1,Z0,Z1", allow_hyphen_values = true)]
    search_box: Option<String>,
    /// Pave these coordinates, one to three, for all values of the others in the workspace: x, y, z, roll,
    /// pitch, yaw, of planar machines angle, or those of formulas
    #[arg(long, value_name = "NAME,...")]
    coordinates: Option<String>,
    /// Split undecided boxes until the geometric mean of their edges is at most E, in the design's
    /// unit of length; none is cut by planes
    #[arg(long, value_name = "E", conflicts_with = "volume_gap", allow_hyphen_values = true)]
    precision: Option<String>,
    /// Split, and cut by planes, until what is undecided has at most G times the volume of what is inner
    #[arg(long, value_name = "G", allow_hyphen_values = true)]
    volume_gap: Option<String>,
    /// Split no further than about so many boxes allow
    #[arg(long, value_name = "N", default_value_t = MAX_BOXES,
        value_parser = input::whole(1..=u64::MAX), allow_hyphen_values = true)]
    max_boxes: u64,
    /// Megabytes for the table of components, which are left out beyond; the paving itself takes a
    /// few
    #[arg(long, value_name = "MB", default_value_t = MEMORY,
        value_parser = input::whole(0..=u64::MAX), allow_hyphen_values = true)]
    memory: u64,
    /// Where the paving is written [default: NAME.paving beside NAME.toml]
    #[arg(short, long, value_name = "PAVING")]
    output: Option<PathBuf>,
    /// Take up the interrupted run that left PAVING.part; the other flags as they were
    #[arg(long)]
    resume: bool,
    /// Time after which no further box is tried, and PAVING.part is left: seconds, or a number with ms, s,
    /// min or h
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    timeout: Option<String>,
    /// Threads [default: one for each core]; the paving does not depend on it
    #[arg(long, value_name = "N",
        value_parser = input::whole(1..=effort::MAX_THREADS), allow_hyphen_values = true)]
    threads: Option<u64>,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Print the volumes' line only, and no progress
    #[arg(short, long)]
    quiet: bool,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let deadline = effort::deadline(arguments.timeout.as_deref(), started)?;
    let design = input::design(Some(&arguments.design), arguments.quiet)?;
    let claim = &searched(&design.claim, arguments.search_box.as_deref())?;
    let coordinates = chosen(&design, claim, arguments.coordinates.as_deref())?;
    let coordinates = coordinates.as_deref();
    let goal = arguments.goal(&design, claim, coordinates)?;
    let target = arguments.target()?;
    output::probe(&target)?;
    output::probe(&unfinished(&target))?;
    let part = unfinished(&target);
    if !arguments.resume {
        input::not_taken_up(&part, b"{\"format\":\"orthocert-paving/", "paving")?;
    }
    effort::start_threads(arguments.threads)?;
    if let Some(deadline) = deadline {
        interrupt::at(deadline)?;
    }
    let mut bar = Bar::new("boxes", arguments.quiet);
    let resume = if arguments.resume { Resume::Yes } else { Resume::No };
    let paved = bar.run("", 2, |control| pave(claim, coordinates, &goal, &target, resume, control));
    let time_is_up = || deadline.is_some_and(|time| time <= Instant::now());
    let paved = match paved {
        Ok(paved) => paved,
        Err(PaveError::Cancelled(share)) => {
            drop(bar);
            let shown = part.shown();
            let held = match share.and_then(BigRational::from_f64) {
                None => format!("{shown} holds what is done; --resume takes it up"),
                Some(none) if none.is_zero() => {
                    format!("{shown} holds no whole part of the tree yet: the first takes longer")
                }
                Some(share) => format!(
                    "{shown} holds what is done, {} of the tree's parts; --resume takes it up",
                    percent(&share, 2, Toward::Below)
                ),
            };
            return interrupt::unfinished(time_is_up(), &held, Some(&part), arguments.format);
        }
        Err(PaveError::NotBegun) => {
            drop(bar);
            return interrupt::unfinished(
                time_is_up(),
                "nothing was written",
                None,
                arguments.format,
            );
        }
        Err(error @ (PaveError::Claim(_) | PaveError::Resume(..))) => {
            return Err(Failure::input(error))
        }
        Err(error) => return Err(Failure::Output(error.to_string())),
    };
    let elapsed = started.elapsed();
    let found =
        bar.run("components", 1, |_| connected(&target, &paved.sha256, arguments.memory))?;
    drop(bar);
    let mut report = PavingReport::new(claim, &paved, found.as_ref(), &target);
    report.design = arguments.design.to_string_lossy().into_owned();
    report.title = design.title;
    report.unit = unit_of_volume(claim, coordinates, design.unit);
    report.reached = match (goal.depth, goal.gap) {
        (Some(depth), _) => paved.reaches(depth),
        (None, Some(gap)) => report.gap.is_some_and(|found| found <= gap),
        (None, None) => true,
    };
    report.seconds = elapsed.as_secs_f64();
    answer(&report, arguments.format, arguments.quiet)
}

/// Prints the report.
pub fn answer(report: &PavingReport, format: Format, quiet: bool) -> Result<Status, Failure> {
    print::told(format, report, || report.text(quiet))?;
    Ok(if report.reached { Status::Done } else { Status::Undecided })
}

/// The claim over the box that `--box` says, where it does.
pub fn searched(claim: &MachineClaim, text: Option<&str>) -> Result<MachineClaim, Failure> {
    let Some(text) = text else {
        return Ok(claim.clone());
    };
    let numbers = text.split(',').map(|text| input::number("--box", text));
    let numbers: Vec<Exact> = numbers.collect::<Result<_, _>>()?;
    let (m, names) = coordinates_of(claim);
    if numbers.len() != 2 * m {
        let (count, ends) = match m {
            1 => ("two numbers X0,X1, the ends".to_owned(), ""),
            2 => ("four numbers X0,X1,Y0,Y1, the ends along x and y".to_owned(), ""),
            3 => ("six numbers X0,X1,Y0,Y1,Z0,Z1, the ends along x, y and z".to_owned(), ""),
            m => (format!("{} numbers", 2 * m), ", two for each coordinate"),
        };
        return Err(Failure::Input(format!("--box: found {text}; accepted: {count}{ends}")));
    }
    let less = |k: &usize| numbers[2 * k].compare(&numbers[2 * k + 1]) == Some(Ordering::Less);
    if let Some(k) = (0..m).find(|k| !less(k)) {
        return Err(Failure::Input(format!(
            "--box: found {text}; along {} the first number is not less than the second",
            names[k]
        )));
    }
    let end = |side: usize| numbers.iter().skip(side).step_by(2).map(expression).collect();
    let (min, max): (Result<_, _>, Result<_, _>) = (end(0), end(1));
    in_box(claim, min?, max?)
        .map_err(|error| Failure::Input(format!("--box: found {text}; {error}")))
}

/// The names of a claim's coordinates of places, and how many there are.
fn coordinates_of(claim: &MachineClaim) -> (usize, Vec<String>) {
    let names = crate::report::page::coordinates(claim);
    let m = match &claim.workspace {
        Workspace::Box { min, .. } => min.len(),
        Workspace::Cylinder { .. } | Workspace::Cube { .. } => 3,
    };
    (m, names)
}

/// The coordinates that `--coordinates` names, where it does, and where these are not all.
fn chosen(
    design: &Design,
    claim: &MachineClaim,
    text: Option<&str>,
) -> Result<Option<Vec<String>>, Failure> {
    let names = names(claim);
    let known: Vec<String> = names.iter().flatten().cloned().collect();
    let list = match &claim.orientation {
        Some(Orientation::Angle(_) | Orientation::Tilt { .. }) => {
            format!("{}; of orientations by roll, pitch and yaw these also", known.join(", "))
        }
        _ => known.join(", "),
    };
    let Some(text) = text else {
        return match claim.orientation.is_some() || names.len() > 3 {
            true => {
                let found = format!(
                    "{} coordinates{}",
                    names.len(),
                    if claim.orientation.is_some() { ", with orientation" } else { "" }
                );
                let accepted = format!(
                    "of pave, up to three without orientation, or --coordinates NAME,.. with up to three \
                     to be paved for all values of the others: {list}"
                );
                Err(Failure::Input(design.refused("workspace", &found, &accepted)))
            }
            false => Ok(None),
        };
    };
    let chosen: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    let is_known = |name: &String| known.contains(name);
    let repeated = (1..chosen.len()).any(|k| chosen[..k].contains(&chosen[k]));
    if chosen.len() > 3 || repeated || !chosen.iter().all(is_known) {
        return Err(Failure::Input(format!(
            "--coordinates: found {text}; accepted: one to three different ones of {list}"
        )));
    }
    // All in their order are paved as without the flag.
    let is_all = claim.orientation.is_none() && chosen == known && known.len() == names.len();
    Ok(Some(chosen).filter(|_| !is_all))
}

fn expression(number: &Exact) -> Result<Expression, Failure> {
    written(number).ok_or_else(|| {
        let refused = "a number is too long; accepted: at most 8,192 characters and 512 operations";
        Failure::Input(refused.to_owned())
    })
}

impl Arguments {
    fn goal(
        &self,
        design: &Design,
        claim: &MachineClaim,
        coordinates: Option<&[String]>,
    ) -> Result<Goal, Failure> {
        is_a_box(design, claim, coordinates)?;
        at_a_point(design)?;
        let depth = self.precision.as_deref();
        let depth = depth.map(|edge| depth_to(claim, coordinates, edge)).transpose()?;
        let gap = match (&self.volume_gap, depth) {
            (None, Some(_)) => None,
            (text, _) => {
                let gap = positive("--volume-gap", text.as_deref().unwrap_or(GAP))?;
                crate::exact::decimal::approximate(&gap)
            }
        };
        Ok(Goal { depth, gap, max_boxes: self.max_boxes })
    }

    /// Where the paving goes, which is not the design, nor is its unfinished file.
    fn target(&self) -> Result<PathBuf, Failure> {
        let target =
            self.output.clone().unwrap_or_else(|| beside(&self.design).with_extension("paving"));
        let target = regular(&target)?;
        input::apart(&target, [&self.design])?;
        input::apart(&unfinished(&target), [&self.design])?;
        Ok(target)
    }
}

/// Demands a box as the workspace; of a cylinder, z may be paved for all x and y.
fn is_a_box(
    design: &Design,
    claim: &MachineClaim,
    coordinates: Option<&[String]>,
) -> Result<(), Failure> {
    let (key, found) = match claim.workspace {
        Workspace::Cylinder { .. } if coordinates.is_some() => return Ok(()),
        Workspace::Box { .. } => return Ok(()),
        Workspace::Cylinder { .. } => ("workspace.cylinder", "a cylinder"),
        Workspace::Cube { .. } => ("workspace.cube", "a cube"),
    };
    let accepted =
        "of pave, a box, min and max, or --box X0,X1,Y0,Y1,Z0,Z1, the box that is searched";
    Err(Failure::Input(design.refused(key, found, accepted)))
}

/// Refuses the requirement that is about two points at a time.
fn at_a_point(design: &Design) -> Result<(), Failure> {
    match design.claim.require.iter().any(|own| own.quantity == "one_to_one") {
        false => Ok(()),
        true => Err(Failure::Input(design.refused(
            "requirements.one_to_one",
            "a requirement on two points at a time, which has no region",
            "of pave, requirements that hold at a point or fail there",
        ))),
    }
}

fn positive(option: &str, text: &str) -> Result<Exact, Failure> {
    let number = input::number(option, text)?;
    if number.sign() == Some(1) {
        return Ok(number);
    }
    Err(Failure::Input(format!("{option}: found {text}; accepted: a positive number")))
}

/// The depth at which boxes have the edges that `--precision` asks for.
pub fn depth(design: &Design, claim: &MachineClaim, precision: &str) -> Result<u32, Failure> {
    is_a_box(design, claim, None)?;
    at_a_point(design)?;
    depth_to(claim, None, precision)
}

fn depth_to(
    claim: &MachineClaim,
    coordinates: Option<&[String]>,
    precision: &str,
) -> Result<u32, Failure> {
    if !are_places(claim, coordinates) {
        let refused = format!(
            "--precision: found {precision}, and coordinates that are angles; accepted: --volume-gap"
        );
        return Err(Failure::Input(refused));
    }
    let edge = expression(&positive("--precision", precision)?)?;
    depth_for_edge(claim, coordinates, &edge).ok_or_else(|| {
        Failure::Input(format!(
            "--precision: found {precision}; accepted: an edge that at most {DEEPEST} splits lead to"
        ))
    })
}

/// A path that is free, or that of a regular file.
pub fn regular(path: &Path) -> Result<PathBuf, Failure> {
    match fs::metadata(path) {
        Ok(found) if !found.is_file() => Err(refused(path, "not a regular file")),
        Ok(_) => {
            // A link is refused, or followed, for the finished paving takes the file's place.
            output::probe(path)?;
            match path.is_symlink() {
                true => Ok(fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())),
                false => Ok(path.to_owned()),
            }
        }
        Err(_) => Ok(path.to_owned()),
    }
}

fn refused(path: &Path, what: &str) -> Failure {
    let path = path.shown();
    Failure::Input(format!("--output: {path} is {what}; accepted: another path"))
}

/// The components of the paving with this SHA-256, if so many megabytes are enough for their table.
/// Where the file is another by now, nothing is said of it.
pub fn connected(path: &Path, sha256: &str, memory: u64) -> Result<Option<Components>, Failure> {
    let fails =
        |reason: &dyn std::fmt::Display| Failure::Output(format!("{}: {reason}", path.shown()));
    let file = output::open_own(path, OpenOptions::new().read(true))?;
    let mut input = BufReader::new(Summed::new(file));
    let found = found_in(&mut input, memory.saturating_mul(1 << 20));
    let (sum, _) = input.into_inner().finish().map_err(|error| fails(&error))?;
    if sum != sha256 {
        return Err(Failure::Output(PaveError::Changed(path.to_owned()).to_string()));
    }
    Ok(found.map_err(|error| fails(&error))?.filter(|found| !found.all.is_empty()))
}

fn found_in(input: impl BufRead, memory: u64) -> Result<Option<Components>, Rejected> {
    let mut reader = Reader::new(input)?;
    let subject = Subject::new(reader.header())?;
    let decider = Decider::new(&subject)?;
    components(&mut reader, &decider, memory)
}
