//! `orthocert limit`.

use super::certify::{self, Unwritten};
use super::ends::{explain, gap_text};
use super::{effort::Effort, input, interrupt, print, Failure, Status};
use crate::design::{text_of, Design, Variable};
use crate::exact::decimal::{exact, significant};
use crate::exact::Exact;
use crate::files::output;
use crate::files::read::named_after;
use crate::files::shown::Shown;
use crate::questions::limit::Side;
use crate::questions::limit::{
    limits, Decided, DesignFamily, Direction, Family, Limit, Place, Question,
};
use crate::report::text::{file_line, labelled};
use crate::report::{machine_of_witness, CertificateFile, Outcome};
use crate::search::Budget;
use num_rational::BigRational;
use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

/// Boxes after which another value than the design's own counts as undecided: so many, or in so many
/// times as many as the proof of that has.
const BOXES: (usize, usize) = (20_000, 4);
/// Fractional bits in which an irrational own value is compared with others.
const OWN_BITS: u32 = 192;

/// Its flags.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
KEY is the path of a number in the design file, its elements counted from 0: mechanism.leg_length,
mechanism.legs.0.length, workspace.max.2, workspace.cylinder.radius, requirements.transmission.max.
mechanism.legs.*.length is the length that all legs have in common. Of a tolerance the middle is
varied and the width kept.

From the design's own number the search goes upward and downward in steps of a thousandth to about a
thousand times its size (of zero: of the largest number beside it) until the verdict changes, then
halves. A limit is a certified value and a refuted one: an upper limit where the refuted one is the
greater, a lower limit where it is the smaller. Nothing is claimed of other values, such as that all
on one side are certified. NAME.limit-upper-certified.cert.json, -upper-refuted, -lower-certified and
-lower-refuted are the certificates; another run replaces them.

Exit code 0 if a certified and a refuted value no further apart than the gap were found, and, of a
certified design, nothing is left undecided in any direction; else 3.")]
pub struct Arguments {
    /// The design file
    #[arg(value_name = "DESIGN.toml")]
    design: PathBuf,
    /// The number's key
    #[arg(value_name = "KEY")]
    key: String,
    /// Relative distance of the certified and the refuted value
    #[arg(long, value_name = "G", default_value = "1e-6", allow_hyphen_values = true)]
    gap: String,
    /// Look in this direction only
    #[arg(long, value_enum, value_name = "WHERE")]
    direction: Option<Toward>,
    /// The folder for the certificates, which exists [default: that of the design]
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: Effort,
}

/// A direction to look in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Toward {
    /// To greater values
    Up,
    /// To smaller ones
    Down,
}

/// The answer for scripts.
#[derive(Serialize)]
struct Answer {
    #[serde(skip_serializing_if = "Option::is_none")]
    title: Option<String>,
    design: String,
    key: String,
    /// The number in the file, of a tolerance the middle, and the design's verdict with it.
    own: Exact,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<String>,
    verdict: Outcome,
    limits: Vec<Row>,
    /// Whether it was interrupted: this is what was found before.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    seconds: f64,
}

/// A limit for scripts.
#[derive(Serialize)]
struct Row {
    /// "upper" or "lower".
    side: &'static str,
    /// "up" or "down" from the own value, or "about" it.
    searched: &'static str,
    certified: Option<Value>,
    refuted: Option<Value>,
    /// What the refuted value violates, and where.
    limited_by: Option<Place>,
    /// The relative distance of the two, rounded up.
    gap: Option<String>,
    gap_reached: bool,
    /// The least and the greatest undecided value, between the two or beyond the one there is.
    undecided: Option<[Exact; 2]>,
    /// Where the design is not well formed any more.
    ends: Option<EndOfForm>,
    out_of_time: bool,
    /// Whether more effort might find a limit, or a nearer one.
    open: bool,
}

/// A value with its certificate.
#[derive(Serialize)]
struct Value {
    value: Exact,
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<CertificateFile>,
}

/// A value for which there is no claim.
#[derive(Serialize)]
struct EndOfForm {
    value: Exact,
    reason: String,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let gap = input::rational_within("--gap", &arguments.gap, ["1e-9", "0.5"])?;
    let Budget { max_boxes, deadline } = effort.budget(started)?;
    let bytes = Design::bytes(&arguments.design).map_err(Failure::input)?;
    let design = Design::of(&bytes, &arguments.design).map_err(Failure::input)?;
    input::tell_notes(&design, Some(&arguments.design), effort.quiet);
    let text = text_of(&bytes, &arguments.design).map_err(Failure::input)?;
    let name = arguments.design.to_string_lossy();
    let variable = Variable::find(text, &name, &arguments.key).map_err(Failure::input)?;
    for (side, verdict) in ENDS {
        let target = arguments.target(side, verdict);
        input::apart(&target, [&arguments.design])?;
        output::probe(&target)?;
    }
    effort.start_threads()?;
    let question = Question {
        own: near(variable.own())?,
        size: variable.size().clone(),
        gap,
        directions: match arguments.direction {
            None => vec![Direction::Down, Direction::Up],
            Some(Toward::Up) => vec![Direction::Up],
            Some(Toward::Down) => vec![Direction::Down],
        },
        deadline,
    };
    let variable = &variable;
    interrupt::grant();
    let mut bar = effort.bar();
    let own = bar.run("own value", 20, |control| {
        let mut family = DesignFamily { variable, max_boxes, control };
        family.decide(&design.claim, [0.0, 1.0], deadline)
    });
    let own = own.map_err(|error| explain(error, &design))?;
    if own.is_none() && interrupt::is_cancelled() {
        return Err(Failure::Interrupted);
    }
    let verdict = own.as_ref().map(|(verdict, _)| *verdict);
    let nodes = own.as_ref().map_or(0, |(_, certificate)| nodes(&certificate.proof));
    let enough = BOXES.0.max(BOXES.1.saturating_mul(nodes));
    let Budget { max_boxes, .. } = effort.budget_or(enough as u64, started)?;
    let found = bar.run(&arguments.key, 1, |control| {
        limits(&question, own, &mut DesignFamily { variable, max_boxes, control })
    });
    drop(bar);
    let limits = found.map_err(|error| explain(error, &design))?;
    let mut unwritten = Unwritten::default();
    let mut row = |limit| row((arguments, &mut unwritten), &question, variable.own(), limit);
    let rows = limits.into_iter().map(&mut row);
    let answer = Answer {
        title: design.title.clone(),
        design: name.into_owned(),
        key: arguments.key.clone(),
        own: variable.own().clone(),
        tolerance: variable.tolerance().map(str::to_owned),
        verdict: verdict.map_or(Outcome::Undecided, Outcome::Decided),
        limits: rows.collect::<Result<_, _>>()?,
        interrupted: interrupt::is_cancelled(),
        seconds: started.elapsed().as_secs_f64(),
    };
    print::told(effort.format, &answer, || words(&answer, effort.quiet))?;
    let status = if is_complete(&answer) { Status::Done } else { Status::Undecided };
    unwritten.told()?;
    interrupt::unless_cancelled(status)
}

/// Whether a limit was found as near as was asked for, and none is left open: of a certified design
/// in any direction, of another where both values were found.
fn is_complete(answer: &Answer) -> bool {
    let certified = answer.verdict == Outcome::Decided(Verdict::Certified);
    let open = |row: &Row| row.open && (certified || row.gap.is_some());
    answer.limits.iter().any(|row| row.gap_reached) && !answer.limits.iter().any(open)
}

/// The files of an answer.
const ENDS: [(&str, &str); 4] =
    [("lower", "certified"), ("lower", "refuted"), ("upper", "certified"), ("upper", "refuted")];

impl Arguments {
    fn target(&self, side: &str, verdict: &str) -> PathBuf {
        named_after(
            &self.design,
            &format!("limit-{side}-{verdict}.cert.json"),
            self.output.as_deref(),
        )
    }
}

/// A rational number, itself or one very near.
fn near(own: &Exact) -> Result<BigRational, Failure> {
    let rational = own.as_rational().cloned();
    rational.or_else(|| own.below(OWN_BITS)).ok_or_else(Failure::too_large)
}

/// The nodes of a proof.
fn nodes(proof: &Proof) -> usize {
    match proof {
        Proof::Tree(tree) => tree.nodes.len(),
        _ => 0,
    }
}

/// A limit, its certificates on the disk.
fn row(
    (arguments, unwritten): (&Arguments, &mut Unwritten),
    question: &Question,
    own: &Exact,
    limit: Limit<Box<Certificate>>,
) -> Result<Row, Failure> {
    let side = match limit.side {
        Side::Lower => "lower",
        Side::Upper => "upper",
    };
    let number = |value: &BigRational| match *value == question.own {
        true => own.clone(),
        false => Exact::Rational(value.clone()),
    };
    let mut stored = |end: &Option<Decided<Box<Certificate>>>| -> Result<Option<Value>, Failure> {
        let Some(end) = end else { return Ok(None) };
        let target = arguments.target(side, &end.verdict.to_string());
        let written = certify::write(arguments.output.as_deref(), &target, &end.proof);
        let certificate = unwritten.unless(written);
        Ok(Some(Value { value: number(&end.value), certificate }))
    };
    Ok(Row {
        side,
        searched: match limit.direction {
            Some(Direction::Up) => "up",
            Some(Direction::Down) => "down",
            None => "about",
        },
        certified: stored(&limit.certified)?,
        refuted: stored(&limit.refuted)?,
        limited_by: limit.refuted.as_ref().and_then(|refuted| Place::of(&refuted.proof)),
        gap: question.gap_of(&limit).as_ref().map(gap_text),
        gap_reached: question.is_reached(&limit),
        undecided: limit.undecided.as_ref().map(|ends| ends.each_ref().map(number)),
        open: question.is_open(&limit),
        ends: limit
            .end
            .map(|end| EndOfForm { value: Exact::Rational(end.value), reason: end.reason }),
        out_of_time: limit.out_of_time,
    })
}

fn words(answer: &Answer, quiet: bool) -> String {
    let mut out = String::new();
    let verdict = match answer.verdict {
        Outcome::Decided(verdict) => verdict.to_string(),
        Outcome::Undecided => "undecided".to_owned(),
    };
    if !quiet {
        let own = exact(&answer.own);
        let tolerance = answer.tolerance.as_ref().map_or(String::new(), |t| format!(" ± {t}"));
        let (key, design) = (Shown(&answer.key), Shown(&answer.design));
        let _ = writeln!(out, "{key} of {design}\n");
        labelled(&mut out, "own value", &format!("{own}{tolerance}, {verdict}"));
    }
    // What was looked for, before where there is none.
    let (found, none): (Vec<&Row>, Vec<&Row>) =
        answer.limits.iter().partition(|row| row.gap.is_some());
    for row in found.into_iter().chain(none) {
        let title = title(row);
        if quiet {
            let value = |end: &Option<Value>| {
                end.as_ref().map_or_else(|| "none".to_owned(), |end| exact(&end.value))
            };
            let (certified, refuted) = (value(&row.certified), value(&row.refuted));
            let _ = writeln!(out, "{title}: certified {certified}, refuted {refuted}");
        } else {
            let _ = writeln!(out, "\n{title}");
            limit(&mut out, row);
        }
    }
    if answer.interrupted {
        let _ = writeln!(out, "{}{}", if quiet { "" } else { "\n  " }, interrupt::PARTIAL);
    }
    if !quiet {
        out += "\n  Each value has its own certificate; nothing is claimed of other values.\n";
        if answer.limits.iter().all(|row| row.gap.is_none() && !row.open) {
            out += "  No limit was found, for which the exit code is 3: no value that was tried has the\n  \
                    other verdict.\n";
        }
        if !answer.interrupted && answer.limits.iter().any(|row| row.open) {
            out += "  Where values are undecided, no proof was found, and no place that fails:\n  \
                    a larger --max-boxes or --timeout may help.\n";
        }
        let _ = writeln!(out, "\n  {} s", significant(answer.seconds, 3));
    }
    out
}

/// What a limit is, or where none was found.
fn title(row: &Row) -> String {
    match (&row.gap, row.searched) {
        (Some(_), _) => format!("{} limit", row.side),
        (None, "up") => "upward".to_owned(),
        (None, _) => "downward".to_owned(),
    }
}

fn limit(out: &mut String, row: &Row) {
    let beyond = if row.searched == "up" { "above" } else { "below" };
    match (&row.certified, &row.refuted) {
        (Some(certified), Some(refuted)) => {
            labelled(out, "certified", &exact(&certified.value));
            labelled(out, "refuted", &exact(&refuted.value));
        }
        (Some(end), None) => {
            labelled(
                out,
                "certified",
                &format!("{}; no refuted value was found {beyond} it", exact(&end.value)),
            );
        }
        (None, Some(end)) => {
            labelled(
                out,
                "refuted",
                &format!("{}; no certified value was found {beyond} it", exact(&end.value)),
            );
        }
        (None, None) => labelled(out, "", "no value was decided"),
    }
    if let Some(gap) = &row.gap {
        let missed = if row.gap_reached { "" } else { ", more than asked for" };
        labelled(out, "gap", &format!("{gap}{missed}"));
    }
    // Without a gap, where even the value nearest to a certified one fails, if there is any.
    if let Some(place) =
        row.limited_by.as_ref().filter(|_| row.gap.is_some() || row.certified.is_none())
    {
        self::place(out, place);
    }
    match &row.undecided {
        Some([one, other]) if one == other => labelled(out, "undecided", &exact(one)),
        Some([one, other]) => {
            labelled(out, "undecided", &format!("{} to {}", exact(one), exact(other)));
        }
        None => {}
    }
    if let Some(end) = &row.ends {
        labelled(out, "not a design", &format!("{}: {}", exact(&end.value), end.reason));
    }
    if row.out_of_time {
        let why = if interrupt::is_cancelled() { "interrupted" } else { "the time was up" };
        labelled(out, "", why);
    }
    let values = [&row.certified, &row.refuted].into_iter().flatten();
    values.filter_map(|value| value.certificate.as_ref()).for_each(|file| file_line(out, file));
}

/// The requirement that limits, and where.
fn place(out: &mut String, place: &Place) {
    labelled(out, "limited by", &place.limit);
    labelled(out, "value there", &place.value);
    match &place.pose {
        Some(pose) => labelled(out, "at", pose),
        None => labelled(out, "at", &format!("({})", place.point.join(", "))),
    }
    if !place.other_point.is_empty() {
        labelled(out, "and at", &format!("({})", place.other_point.join(", ")));
    }
    machine_of_witness(out, &place.settings, false);
}
