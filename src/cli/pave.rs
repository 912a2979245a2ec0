//! `orthocert pave`.

use super::{effort, input, interrupt, print, progress::Bar, Failure, Format, Status};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert::decimal::{grouped, rounded, significant, Toward};
use orthocert::design::Design;
use orthocert::output;
use orthocert::paving::{
    components, depth_for_edge, pave, unfinished, Component, Components, Decider, Goal, PaveError,
    Paved, Resume,
};
use orthocert::search::Control;
use orthocert_checker::claim::{Claim, MachineClaim, Workspace};
use orthocert_checker::number::Exact;
use orthocert_checker::paving::{Reader, Shares};
use serde::Serialize;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The gap that is aimed at by default.
const GAP: &str = "0.05";
/// Boxes tried by default, about.
const MAX_BOXES: u64 = 50_000_000;
/// Megabytes for components by default.
const MEMORY: u64 = 1024;
/// Components that are told apart.
const SHOWN: usize = 5;
/// Digits of volumes.
const DIGITS: u32 = 9;

/// Its flags.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The box is [workspace] min and max of the design. The region is the set of its points at which all
requirements hold, for every machine of the tolerance. Without --precision and --volume-gap the gap
that is aimed at is 0.05. An interrupted run leaves PAVING.part, which --resume takes up again: the
paving is the same, byte for byte. So it is for every number of threads.")]
pub struct Arguments {
    /// The design; its workspace is the box that is searched
    #[arg(value_name = "DESIGN.toml")]
    design: PathBuf,
    /// Split undecided boxes until the geometric mean of their edges is at most E, in the design's
    /// unit of length
    #[arg(long, value_name = "E", conflicts_with = "volume_gap", allow_hyphen_values = true)]
    precision: Option<String>,
    /// Split until the volume of the undecided boxes is at most G times that of the inner ones
    #[arg(long, value_name = "G", allow_hyphen_values = true)]
    volume_gap: Option<String>,
    /// Split no further than about so many boxes allow
    #[arg(long, value_name = "N", default_value_t = MAX_BOXES,
        value_parser = clap::value_parser!(u64).range(1..))]
    max_boxes: u64,
    /// Megabytes for the table of components, which are left out beyond; the paving itself takes a
    /// few
    #[arg(long, value_name = "MB", default_value_t = MEMORY)]
    memory: u64,
    /// Where the paving is written [default: NAME.paving beside NAME.toml]
    #[arg(short, long, value_name = "PAVING")]
    output: Option<PathBuf>,
    /// Take up the interrupted run that left PAVING.part; the other flags as they were
    #[arg(long)]
    resume: bool,
    /// Threads [default: one for each core]; the paving does not depend on it
    #[arg(long, value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..=effort::MAX_THREADS))]
    threads: Option<u64>,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Print the volumes' line only, and no progress
    #[arg(short, long)]
    quiet: bool,
}

/// The answer.
#[derive(Serialize)]
struct Answer {
    #[serde(skip_serializing_if = "Option::is_none")]
    title: Option<String>,
    design: String,
    paving: String,
    bytes: u64,
    /// The volume of the undecided boxes over that of the inner ones; none without inner boxes.
    gap: Option<f64>,
    /// Whether the precision or gap that was asked for is reached.
    reached: bool,
    inner: Part,
    outer: Part,
    boundary: Part,
    /// Boxes left out by symmetry.
    mirrored: u64,
    depth: u32,
    /// Connected components of the inner boxes; none where the memory is too small.
    #[serde(skip_serializing_if = "Option::is_none")]
    components: Option<ComponentsAnswer>,
    /// Boxes tried by this run.
    boxes: u64,
    seconds: f64,
}

/// The components of the inner boxes: boxes that share a part of a face are connected.
#[derive(Serialize)]
struct ComponentsAnswer {
    /// With images.
    count: u64,
    /// The largest, by descending volume.
    largest: Vec<ComponentAnswer>,
    /// The least condition number `sigma_max / sigma_min` found at an inner box's centre.
    best_conditioning: f64,
    /// That centre, about.
    best_conditioned_at: [f64; 3],
}

/// A component.
#[derive(Serialize)]
struct ComponentAnswer {
    /// Its share of the box's volume, with its images.
    share: f64,
    boxes: u64,
    /// Itself and its images under permutations of the axes.
    copies: u64,
    /// Whether the best conditioned centre is in it, or in an image of it.
    best_conditioned: bool,
}

/// The boxes of one kind, in a box that is searched.
#[derive(Serialize)]
struct Part {
    boxes: u64,
    /// Their share of the box's volume, with their images.
    share: Exact,
    /// Their volume with their images, where the box's volume is rational.
    #[serde(skip_serializing_if = "Option::is_none")]
    volume: Option<Exact>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let design = Design::read(&arguments.design).map_err(Failure::input)?;
    let Claim::Machine(claim) = &design.claim else {
        return Err(Failure::Input("a design is about a machine".to_owned()));
    };
    let goal = arguments.goal(claim)?;
    let target = arguments.target()?;
    output::probe(&target)?;
    output::probe(&unfinished(&target))?;
    effort::start_threads(arguments.threads)?;
    let mut bar = Bar::new(arguments.quiet);
    let mut progress = |now| bar.show(now);
    let mut control = Control { cancel: interrupt::cancelled(), progress: &mut progress };
    let resume = if arguments.resume { Resume::Yes } else { Resume::No };
    let paved = pave(claim, &goal, &target, resume, &mut control);
    bar.clear();
    let paved = paved.map_err(|error| failure(error, &target))?;
    let mut answer = Answer::new(claim, &paved, &target, started.elapsed());
    answer.components = arguments.components(claim, &target)?;
    answer.design = arguments.design.display().to_string();
    answer.title = design.title;
    answer.reached = match (goal.depth, goal.gap) {
        (Some(depth), _) => paved.header.depth >= depth,
        (None, Some(gap)) => answer.gap.is_some_and(|found| found <= gap),
        (None, None) => true,
    };
    match arguments.format {
        Format::Json => print::json(&answer)?,
        Format::Text => print::answer(&text(&answer, arguments.quiet))?,
    }
    Ok(if answer.reached { Status::Done } else { Status::Undecided })
}

fn failure(error: PaveError, target: &Path) -> Failure {
    match error {
        PaveError::Cancelled => {
            let part = unfinished(target);
            if part.exists() {
                let part = part.display();
                print::diagnostic(&format!("{part} holds what is done; --resume takes it up"));
            }
            Failure::Interrupted
        }
        PaveError::Claim(_) | PaveError::Resume(..) => Failure::Input(error.to_string()),
        other => Failure::Output(other.to_string()),
    }
}

impl Arguments {
    fn goal(&self, claim: &MachineClaim) -> Result<Goal, Failure> {
        let positive = |option: &str, text: &str| {
            let number = input::number(option, text)?;
            if number.sign() == Some(1) {
                Ok(number)
            } else {
                let refused = format!("{option}: found {text}; accepted: a positive number");
                Err(Failure::Input(refused))
            }
        };
        if !matches!(claim.workspace, Workspace::Box { .. }) {
            return Err(Failure::Input(
                "the workspace is not a box; accepted: [workspace] with min and max".to_owned(),
            ));
        }
        let depth = match &self.precision {
            None => None,
            Some(text) => {
                let edge = positive("--precision", text)?;
                let depth = depth_for_edge(claim, &edge).ok_or_else(|| {
                    Failure::Input(format!(
                        "--precision: found {text}; accepted: an edge that at most 90 splits lead to"
                    ))
                })?;
                Some(depth)
            }
        };
        let gap = match (&self.volume_gap, depth) {
            (None, Some(_)) => None,
            (text, _) => {
                let gap = positive("--volume-gap", text.as_deref().unwrap_or(GAP))?;
                orthocert::decimal::approximate(&gap)
            }
        };
        Ok(Goal { depth, gap, max_boxes: self.max_boxes })
    }

    fn components(
        &self,
        claim: &MachineClaim,
        target: &Path,
    ) -> Result<Option<ComponentsAnswer>, Failure> {
        let fails = |reason: &dyn std::fmt::Display| {
            Failure::Output(format!("{}: {reason}", target.display()))
        };
        let file = File::open(target).map_err(|error| fails(&error))?;
        let mut reader = Reader::new(BufReader::new(file)).map_err(|error| fails(&error))?;
        let decider = Decider::new(reader.header()).map_err(|error| fails(&error))?;
        let found = components(&mut reader, &decider, self.memory.saturating_mul(1 << 20))
            .map_err(|error| fails(&error))?;
        Ok(found.filter(|found| !found.all.is_empty()).map(|found| described(claim, &found)))
    }

    /// Where the paving goes: a path that is free, or a file that is not the design. Links are
    /// followed, for the finished paving takes the file's place.
    fn target(&self) -> Result<PathBuf, Failure> {
        let target = self.output.clone().unwrap_or_else(|| self.design.with_extension("paving"));
        let refused = |what: &str| {
            let path = target.display();
            Err(Failure::Input(format!("--output: {path} is {what}; accepted: another path")))
        };
        match fs::metadata(&target) {
            Ok(found) if !found.is_file() => refused("not a regular file"),
            Ok(_) => match (fs::canonicalize(&target), fs::canonicalize(&self.design)) {
                (Ok(target), Ok(design)) if target == design => refused("the design itself"),
                (Ok(target), _) => Ok(target),
                _ => Ok(target),
            },
            Err(_) => Ok(target),
        }
    }
}

impl Answer {
    fn new(claim: &MachineClaim, paved: &Paved, target: &Path, elapsed: Duration) -> Self {
        let volume = volume(claim);
        let part = |boxes: u64, share: Exact| {
            let volume = volume.clone().zip(share.as_rational().cloned());
            Part { boxes, share, volume: volume.map(|(v, share)| Exact::Rational(v * share)) }
        };
        let summary = &paved.summary;
        let Shares { inner, boundary } = paved.shares;
        let whole = 1 << orthocert_checker::paving::SHARE_BITS;
        let outer = Shares::fraction(whole - inner - boundary);
        let gap = match (inner, boundary) {
            (_, 0) => Some(0.0),
            (0, _) => None,
            _ => Some(boundary as f64 / inner as f64),
        };
        Answer {
            title: None,
            design: String::new(),
            paving: target.display().to_string(),
            bytes: paved.bytes,
            gap,
            reached: true,
            inner: part(summary.inner, summary.inner_share.clone()),
            outer: part(summary.outer, outer),
            boundary: part(summary.boundary, summary.boundary_share.clone()),
            mirrored: summary.mirrored,
            depth: paved.header.depth,
            components: None,
            boxes: paved.boxes,
            seconds: elapsed.as_secs_f64(),
        }
    }
}

fn described(claim: &MachineClaim, found: &Components) -> ComponentsAnswer {
    let unit = (-f64::from(orthocert_checker::paving::SHARE_BITS)).exp2();
    let described = |component: &Component| ComponentAnswer {
        share: component.share as f64 * unit,
        boxes: component.boxes,
        copies: component.copies,
        best_conditioned: component.best_conditioned,
    };
    let mut at = found.centre;
    if let Workspace::Box { min, max } = &claim.workspace {
        for (k, u) in found.centre.iter().enumerate() {
            let end = |x: &Exact| orthocert::decimal::approximate(x).unwrap_or(f64::NAN);
            at[k] = end(&min[k]) + (end(&max[k]) - end(&min[k])) * u;
        }
    }
    ComponentsAnswer {
        count: found.all.iter().map(|component| component.copies).sum(),
        largest: found.all.iter().take(SHOWN).map(described).collect(),
        best_conditioning: found.conditioning,
        best_conditioned_at: at,
    }
}

/// The volume of the box, where it is rational.
fn volume(claim: &MachineClaim) -> Option<BigRational> {
    let Workspace::Box { min, max } = &claim.workspace else {
        return None;
    };
    let edges = min.iter().zip(max).map(|(min, max)| Some(max.as_rational()? - min.as_rational()?));
    edges.product()
}

fn text(answer: &Answer, quiet: bool) -> String {
    let size = |part: &Part| part.volume.as_ref().unwrap_or(&part.share).as_rational().cloned();
    let (inner, open) = (size(&answer.inner), size(&answer.boundary));
    let (Some(inner), Some(open)) = (inner, open) else {
        return String::new();
    };
    let unit = if answer.inner.volume.is_some() { "" } else { " of the box" };
    let gap =
        answer.gap.map_or("none".to_owned(), |gap| format!("{} %", significant(100.0 * gap, 3)));
    let first = format!(
        "volume: between {}{unit} and {}{unit}, gap {gap}\n",
        rounded(&inner, DIGITS, Toward::Below),
        rounded(&(&inner + &open), DIGITS, Toward::Above),
    );
    if quiet {
        return first;
    }
    let row = |name: &str, part: &Part, what: &str| {
        let share = part.share.as_rational().and_then(BigRational::to_f64).unwrap_or(f64::NAN);
        format!(
            "  {name:<9} {:>13} boxes {:>9} % of the box   {what}\n",
            grouped(part.boxes),
            significant(100.0 * share, 6)
        )
    };
    let mut out = first + "\n";
    out += &row("inner", &answer.inner, "all requirements hold at every point");
    out += &row("outer", &answer.outer, "some requirement fails at every point");
    out += &row("boundary", &answer.boundary, "undecided");
    if answer.mirrored > 0 {
        out += "\n  The machine looks the same from permuted axes: only points with x <= y <= z are\n  \
                paved, and the shares count all images.\n";
    }
    if let Some(components) = &answer.components {
        out += &components_text(components);
    }
    if !answer.reached {
        out += "\n  What was asked for is not reached: raise --max-boxes.\n";
    }
    let rate = answer.boxes as f64 / answer.seconds;
    out + &format!(
        "\n  paving {} ({} bytes), every box confirmed by the exact checker\n  {} boxes in {} s, {} \
         boxes/s\n",
        answer.paving,
        grouped(answer.bytes),
        grouped(answer.boxes),
        significant(answer.seconds, 3),
        grouped(rate as u64),
    )
}

fn components_text(components: &ComponentsAnswer) -> String {
    let [x, y, z] = components.best_conditioned_at.map(|x| significant(x, 3));
    let mut out = format!(
        "\n  components {:>10}, by shared faces; they may join in undecided boxes\n",
        grouped(components.count)
    );
    for component in &components.largest {
        let copies = match component.copies {
            1 => String::new(),
            n => format!(" together with {} images", n - 1),
        };
        let best = if component.best_conditioned {
            format!(
                ", with the best conditioned point, sigma_max/sigma_min = {} at ({x}, {y}, {z})",
                significant(components.best_conditioning, 4)
            )
        } else {
            String::new()
        };
        out += &format!(
            "    {:>9} % of the box{copies}, {} boxes{best}\n",
            significant(100.0 * component.share, 6),
            grouped(component.boxes)
        );
    }
    out
}
