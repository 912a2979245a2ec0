//! `orthocert largest-cube`.

use super::certify::{self, Unwritten};
use super::{effort::Effort, ends, input, interrupt, print, Failure, Status};
use crate::design::{written, Design};
use crate::exact::decimal::readable;
use crate::exact::Exact;
use crate::files::output;
use crate::files::read::named_after;
use crate::questions::largest_cube::{cube_of_side, largest_cube, Bracket};
use crate::report::text::{duration, file_line, labelled};
use crate::report::{counterexample, CertificateFile, Counterexample};
use num_rational::BigRational;
use num_traits::{FromPrimitive, ToPrimitive};
use orthocert_checker::certificate::Verdict;
use orthocert_kernel::claim::{MachineClaim, Workspace};
use orthocert_kernel::number::Expression;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

/// Why there is no upper bound where cubes a million times as large as the box of the centres seem to fit.
const ENDLESS: &str = "the requirements seem to hold in cubes of any size";

/// Why a side that is not certified stays undecided where the platform turns.
const ONE_CENTRE: &str = "of a platform that turns, no cube can be excluded everywhere";

/// Its flags.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Cubes have edges along the axes; their centres are searched for in the box [workspace] min and max
of the design. The lower bound is a certificate for a cube as a workspace; the upper bound one that
no cube of that side fits, wherever in the box its centre is. Of a platform that turns, the
requirements hold at every point of the cube in every orientation of the design's set, and the upper
bound is a side that is refuted about the centre of the certified cube: a cube elsewhere may be
larger. Where the gap is not reached, the bounds are as near as they were found, and the exit code is
3. With --side the exit code is 0 if such
a cube is certified, and 1 if it is proved that none fits.")]
pub struct Arguments {
    /// The design; its workspace is the box of the centres
    #[arg(value_name = "DESIGN.toml")]
    design: PathBuf,
    /// Relative distance of both bounds
    #[arg(long, value_name = "GAP", default_value = "1e-6", allow_hyphen_values = true)]
    gap: String,
    /// Decide whether a cube of this side fits, instead
    #[arg(long, value_name = "S", conflicts_with = "gap", allow_hyphen_values = true)]
    side: Option<String>,
    /// The folder for both certificates, NAME.cube.cert.json and NAME.no-cube.cert.json [default:
    /// that of the design]
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: Effort,
}

/// The answer.
#[derive(Serialize)]
struct Answer {
    #[serde(skip_serializing_if = "Option::is_none")]
    title: Option<String>,
    /// A side that is certified, below the greatest.
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<Expression>,
    /// The centre of the cube of that side, or else of the side that is refuted.
    #[serde(skip_serializing_if = "Option::is_none")]
    centre: Option<[Exact; 3]>,
    /// A side for which no cube fits, above the greatest.
    #[serde(skip_serializing_if = "Option::is_none")]
    max: Option<Expression>,
    /// A side that is refuted about that centre, where no claim is of all centres: of platforms that turn.
    #[serde(skip_serializing_if = "Option::is_none")]
    refuted_here: Option<Expression>,
    /// `(max - min) / min`, or that of `refuted_here`.
    #[serde(skip_serializing_if = "Option::is_none")]
    gap: Option<f64>,
    /// Why it is more than was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    missed: Option<&'static str>,
    /// What fails first in the cube of side `max`, or `refuted_here`, about the same centre.
    #[serde(skip_serializing_if = "Option::is_none")]
    limited_by: Option<Counterexample>,
    #[serde(skip_serializing_if = "Option::is_none")]
    length_unit: Option<&'static str>,
    certificates: Vec<CertificateFile>,
    /// Whether it was interrupted: this is what was found before.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    seconds: f64,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let gap = ends::gap(&arguments.gap, ["1e-9", "0.5"])?;
    let side = arguments.side.as_deref().map(side).transpose()?;
    let budget = effort.budget(started)?;
    let design = input::design(Some(&arguments.design), effort.quiet)?;
    let claim = boxed(&design)?;
    let turns = claim.orientation.is_some();
    let beyond = if turns { "refuted-cube" } else { "no-cube" };
    let targets = ["cube", beyond].map(|name| arguments.target(name));
    for target in &targets {
        output::probe(target)?;
    }
    effort.start_threads()?;
    interrupt::grant();
    let found = effort.run(|control| match &side {
        Some(side) => cube_of_side(claim, side, budget, control),
        None => largest_cube(claim, gap, budget, control),
    });
    let bracket = found.map_err(|error| ends::explain(error, &design))?;
    let (mut certificates, mut unwritten) = (Vec::new(), Unwritten::default());
    let inside = bracket.inside.as_ref().map(|inside| &inside.certificate);
    let beyond = bracket.too_large.as_ref().or(bracket.refuted_here.as_ref());
    if inside.is_none() && beyond.is_none() && interrupt::is_cancelled() {
        return Err(Failure::Interrupted);
    }
    let too_large = beyond.map(|too_large| &too_large.certificate);
    for (certificate, target) in [inside, too_large].into_iter().zip(&targets) {
        if let Some(certificate) = certificate {
            let written = certify::write(arguments.output.as_deref(), target, certificate);
            certificates.extend(unwritten.unless(written));
        }
    }
    let found = reached(&bracket);
    let missed = match &side {
        _ if interrupt::is_cancelled() => None,
        None if found.is_some_and(|found| found <= gap) => {
            bracket.is_short.then_some(ends::NOT_BEST)
        }
        None if bracket.endless => Some(ENDLESS),
        Some(_) if bracket.inside.is_some() || bracket.too_large.is_some() => None,
        Some(_) if turns && !bracket.out_of_time => Some(ONE_CENTRE),
        _ => Some(ends::missed(bracket.out_of_time)),
    };
    let answer = Answer {
        title: design.title.clone(),
        gap: found,
        missed,
        limited_by: bracket.fails.as_deref().and_then(counterexample),
        length_unit: design.unit,
        min: bracket.inside.as_ref().map(|inside| inside.side.clone()),
        centre: bracket
            .inside
            .map(|inside| inside.centre)
            .or(bracket.centre.filter(|_| bracket.refuted_here.is_some()))
            .map(|centre| centre.map(Exact::Rational)),
        max: bracket.too_large.map(|too_large| too_large.side),
        refuted_here: bracket.refuted_here.map(|refuted| refuted.side),
        certificates,
        interrupted: interrupt::is_cancelled(),
        seconds: started.elapsed().as_secs_f64(),
    };
    print::told(effort.format, &answer, || text(&answer, effort.quiet))?;
    let status = match (&answer.min, &answer.max, side) {
        (Some(_), _, Some(_)) => Status::Decided(Verdict::Certified),
        (_, Some(_), Some(_)) => Status::Decided(Verdict::Refuted),
        (_, _, None) if answer.gap.is_some_and(|found| found <= gap) && answer.missed.is_none() => {
            Status::Done
        }
        _ => Status::Undecided,
    };
    unwritten.told()?;
    interrupt::unless_cancelled(status)
}

fn boxed(design: &Design) -> Result<&MachineClaim, Failure> {
    let claim = &design.claim;
    let (key, found) = match &claim.workspace {
        Workspace::Box { min, .. } if min.len() == 3 => return Ok(claim),
        Workspace::Box { .. } => ("workspace.min", "a box of other coordinates than three"),
        Workspace::Cylinder { .. } => ("workspace.cylinder", "a cylinder"),
        Workspace::Cube { .. } => ("workspace.cube", "a cube"),
    };
    let accepted =
        "of largest-cube, a box of three coordinates, min and max, in which the centres are";
    Err(Failure::Input(design.refused(key, found, accepted)))
}

/// `(max - min) / min`, where both are there.
fn reached(bracket: &Bracket) -> Option<f64> {
    let too_large = bracket.too_large.as_ref().or(bracket.refuted_here.as_ref())?;
    let inside = bracket.inside.as_ref()?;
    let (min, max) = (inside.side.rational()?, too_large.side.rational()?);
    ((&max - &min) / min).to_f64()
}

fn side(text: &str) -> Result<Expression, Failure> {
    let side = input::within("--side", text, input::SIZES)?;
    written(&side).ok_or_else(|| input::refused("--side", text, "a number of fewer digits"))
}

impl Arguments {
    fn target(&self, name: &str) -> PathBuf {
        named_after(&self.design, &format!("{name}.cert.json"), self.output.as_deref())
    }
}

fn text(answer: &Answer, quiet: bool) -> String {
    let number = |x: &Exact| readable(x);
    let unit = answer.length_unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    let mut out = match (&answer.min, &answer.max) {
        (Some(min), Some(max)) => {
            format!("largest cube: side between {} and {}{unit}\n", exactly(min), exactly(max))
        }
        (Some(min), None) if answer.refuted_here.is_some() => {
            format!("largest cube: side of at least {}{unit}\n", exactly(min))
        }
        (Some(min), None) => format!("a cube of side {}{unit} fits\n", exactly(min)),
        (None, Some(max)) => format!("no cube of side {}{unit} fits\n", exactly(max)),
        (None, None) => "undecided: no cube is certified, and no side is excluded\n".to_owned(),
    };
    if answer.interrupted {
        let _ = writeln!(out, "{}", interrupt::PARTIAL);
    }
    if quiet {
        return out;
    }
    out.push('\n');
    if let Some(found) = &answer.limited_by {
        labelled(&mut out, "limited by", &found.limit);
        labelled(&mut out, "at", &found.at());
    }
    if let Some([x, y, z]) = &answer.centre {
        labelled(&mut out, "centre", &format!("({}, {}, {})", number(x), number(y), number(z)));
    }
    if let Some(side) = &answer.refuted_here {
        let text = format!("side {}{unit} about that centre; elsewhere may do", exactly(side));
        labelled(&mut out, "refuted", &text);
    }
    if let Some(gap) = answer.gap.and_then(BigRational::from_f64) {
        labelled(&mut out, "gap", &ends::gap_text(&gap));
    }
    if let Some(why) = answer.missed {
        labelled(&mut out, "gap missed", why);
    }
    answer.certificates.iter().for_each(|file| file_line(&mut out, file));
    let _ = writeln!(out, "\n  {}", duration(answer.seconds));
    out
}

fn exactly(x: &Expression) -> String {
    x.rational()
        .map_or_else(|| x.to_string(), |x| crate::exact::decimal::exact(&Exact::Rational(x)))
}
