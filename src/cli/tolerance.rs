//! `orthocert tolerance`.

use super::certify::Unwritten;
use super::progress::Bar;
use super::size::{explain, file, gap, gap_text};
use super::{effort, input, interrupt, print, Failure, Format, Status};
use crate::design::Design;
use crate::exact::decimal::{exact, outward, Toward};
use crate::exact::Exact;
use crate::files::output;
use crate::questions::frontier::Bracket;
use crate::questions::tolerance::{legs_of, squares, widest, Kind, Scheme, ROOT_BITS};
use crate::report::text::{duration, wrap, WIDTH};
use crate::report::{counterexample, CertificateFile, Counterexample};
use crate::search::solver::{proof, refutation};
use crate::search::{turns, Budget};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert_checker::certificate::{Proof, Verdict};
use orthocert_kernel::claim::{MachineClaim, Mechanism};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Boxes after which a tolerance counts as not certified: what closes at all mostly closes in a few
/// hundred, or in a few times as many as without tolerances.
const BOXES: (usize, usize) = (2_000, 4);

/// Significant digits of tolerances.
const DIGITS: u32 = 6;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The design file
    #[arg(value_name = "DESIGN.toml")]
    design: PathBuf,
    /// The kinds of parameters: leg_length, anchor, direction, platform, axis, reference, arm
    /// [default: all that the mechanism has]
    #[arg(long, value_name = "KIND,...", value_delimiter = ',')]
    on: Vec<String>,
    /// Relative distance of the certified and the refuted tolerance to stop at
    #[arg(long, value_name = "WIDTH", default_value = "0.1", allow_hyphen_values = true)]
    gap: String,
    /// Time for each row of the answer, by the clock; rows that are searched side by side share the cores [default: no
    /// limit]: seconds, or a number with ms, s, min or h
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    each: Option<String>,
    /// Widen the parameters of one leg at a time, too, and rank the legs
    #[arg(long)]
    by_leg: bool,
    /// Tell the tolerances of directions as those of their components, as the design writes them
    #[arg(short, long, conflicts_with = "quiet")]
    verbose: bool,
    /// Write the certificates of both ends into this folder, which exists
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: effort::Effort,
}

/// What a row's number is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Measure {
    /// A length, in the design's unit.
    Length,
    /// A direction's component.
    Component,
    /// A part of each kind's own certified tolerance.
    Share,
}

/// A row for scripts.
#[derive(Serialize)]
struct Row {
    on: Vec<&'static str>,
    /// The leg whose parameters these are, counted from one; else those of all.
    #[serde(skip_serializing_if = "Option::is_none")]
    leg: Option<usize>,
    measure: Measure,
    /// For [`Measure::Share`]: the tolerance of each kind at share 1.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    weights: BTreeMap<&'static str, Exact>,
    /// The widest tolerance that was certified.
    certified: Option<Exact>,
    /// The narrowest that was refuted.
    refuted: Option<Exact>,
    /// `refuted/certified - 1`, rounded up.
    gap: Option<String>,
    gap_reached: bool,
    /// Whether the row's time, or that of one of its proofs, was up before the search for it ended.
    out_of_time: bool,
    /// The machine and the point of the refutation.
    #[serde(skip_serializing_if = "Option::is_none")]
    counterexample: Option<Counterexample>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    certificates: Vec<CertificateFile>,
    #[serde(skip)]
    unwritten: Unwritten,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let width = gap(&arguments.gap, 1e-6, 0.5)?;
    let design = input::design(Some(&arguments.design), effort.quiet)?;
    let claim = &design.claim;
    let kinds = named(&arguments.on, &design)?;
    if let Some(folder) = &arguments.output {
        output::probe(&folder.join("tolerance.cert.json"))?;
        input::apart_in(folder, &arguments.design)?;
    }
    let each = arguments.each.as_deref().map(|text| effort::time("--each", text)).transpose()?;
    let budget = effort.budget(started)?;
    effort.start_threads()?;
    let nominal = Scheme::common(&kinds).claim(claim, &BigRational::from_integer(0.into()));
    let nominal = nominal.ok_or_else(too_large)?;
    let nodes = match nodes_or_status(&nominal, arguments, budget)? {
        Ok(nodes) => nodes,
        Err(status) => return Ok(status),
    };
    let enough = BOXES.0.max(BOXES.1.saturating_mul(nodes));
    let budget = effort.budget_or(enough as u64, started)?;
    let legs = if arguments.by_leg { legs_of(&claim.mechanism) } else { 0 };
    interrupt::grant();
    let question = Question { claim, width, each, budget, arguments, design: &design };
    let rows = question.rows(&kinds, legs)?;
    match effort.format {
        Format::Json => {
            let each = &arguments.each;
            let mut answer =
                serde_json::json!({ "nominal": "certified", "each": each, "tolerances": rows });
            if interrupt::is_cancelled() {
                answer["interrupted"] = true.into();
            }
            print::json(&answer)?;
        }
        Format::Text => print::answer(&text(&rows, arguments, &design, started))?,
    }
    let complete = rows.iter().all(|row| row.gap_reached);
    let status = if complete { Status::Done } else { Status::Undecided };
    rows.into_iter().try_for_each(|row| row.unwritten.told())?;
    interrupt::unless_cancelled(status)
}

/// What is asked of every row.
struct Question<'a> {
    claim: &'a MachineClaim,
    /// The gap.
    width: f64,
    /// The time of each.
    each: Option<Duration>,
    budget: Budget,
    arguments: &'a Arguments,
    design: &'a Design,
}

/// The time of rows that are searched for at once.
struct Time {
    budget: Budget,
    /// The turns after them.
    after: usize,
    /// Each has half of what is left, in place of its share.
    halves: bool,
}

/// What a row widens and tells, and what is known of it.
struct Asked {
    scheme: Scheme,
    measure: Measure,
    known: Bracket,
    /// About where it is refuted, as other rows tell.
    about: Option<f64>,
    /// As soon as it was begun.
    row: Option<Row>,
}

impl Asked {
    fn new(scheme: Scheme, measure: Measure) -> Self {
        Asked { scheme, measure, known: Bracket::default(), about: None, row: None }
    }

    /// The widest tolerance that is certified.
    fn certified(&self) -> Option<&BigRational> {
        self.known.certified.as_ref().map(|(t, _)| t)
    }

    /// The narrowest that is refuted.
    fn refuted(&self) -> Option<&BigRational> {
        self.known.refuted.as_ref().map(|(t, _)| t)
    }
}

impl Question<'_> {
    /// The rows; interrupted, those that were begun.
    fn rows(&self, kinds: &[Kind], legs: usize) -> Result<Vec<Row>, Failure> {
        let bar = &mut self.arguments.effort.bar();
        let of_legs = turns(kinds.len() * legs);
        let after = turns(usize::from(mixed(kinds))) + of_legs;
        let mut all = schemes(kinds);
        let every: Vec<usize> = (0..all.len()).collect();
        let time = self.budget.deadline.map(|end| end.saturating_duration_since(Instant::now()));
        self.search(bar, (&mut all, &every), Time { budget: self.budget, after, halves: false })?;
        // What time the others left, but for that of those after them, is for those whose time was up, first for those of
        // which least is known: half of what is left each, for what is not proved in as much as before wants more.
        let own = turns(all.len());
        let of_rest = time.map(|time| time.mul_f64(after as f64 / (own + after) as f64));
        let deadline =
            self.budget.deadline.zip(of_rest).and_then(|(end, rest)| end.checked_sub(rest));
        let budget = Budget { deadline, ..self.budget };
        let mut improved = self.each.is_none();
        while std::mem::take(&mut improved) && !budget.is_over() {
            let is_short =
                |asked: &Asked| asked.known.out_of_time && !asked.known.reaches(self.width);
            let mut short = every.clone();
            short.retain(|&at| is_short(&all[at]));
            short.sort_by_key(|&at| all[at].certified().is_some());
            let time = Time { budget, after, halves: true };
            improved = self.search(bar, (&mut all, &short), time)?;
        }
        let weights = kinds.iter().zip(&all);
        let weights = weights.filter_map(|(kind, asked)| Some((*kind, asked.certified()?.clone())));
        let weights: Vec<_> = weights.collect();
        if mixed(kinds) && weights.len() == kinds.len() {
            let mut share = [Asked::new(Scheme { weights, leg: None }, Measure::Share)];
            // A machine that fails with one kind is among those of all.
            let of_kind = |asked: &Asked| (asked.refuted()? / asked.certified()?).to_f64();
            let shares = all[..kinds.len()].iter().filter_map(of_kind);
            share[0].about = shares.min_by(f64::total_cmp);
            let time = Time { budget: self.budget, after: of_legs, halves: false };
            self.search(bar, (&mut share, &[0]), time)?;
            all.extend(share);
        }
        let of_leg = |(kind, of_all, leg): (&Kind, &Asked, usize)| {
            let scheme = Scheme { leg: Some(leg), ..Scheme::common(&[*kind]) };
            let about = of_all.refuted().and_then(BigRational::to_f64);
            Asked { about, ..Asked::new(scheme, measure(kind.is_direction())) }
        };
        let pairs = kinds.iter().zip(&all);
        let pairs = pairs.flat_map(|(kind, of_all)| (0..legs).map(move |leg| (kind, of_all, leg)));
        let mut by_leg: Vec<Asked> = pairs.map(of_leg).collect();
        let every: Vec<usize> = (0..by_leg.len()).collect();
        let time = Time { budget: self.budget, after: 0, halves: false };
        self.search(bar, (&mut by_leg, &every), time)?;
        // The leg that allows least first.
        for of_kind in by_leg.chunks_mut(legs.max(1)) {
            of_kind.sort_by_key(|asked| asked.certified().cloned().unwrap_or_default());
        }
        let rows: Vec<Row> = all.into_iter().chain(by_leg).filter_map(|asked| asked.row).collect();
        match rows.is_empty() {
            true => interrupt::unless_cancelled(rows),
            false => Ok(rows),
        }
    }

    /// Searches for some of these. Whether of one a wider tolerance is certified than was before.
    fn search(
        &self,
        bar: &mut Bar,
        (all, which): (&mut [Asked], &[usize]),
        Time { budget, after, halves }: Time,
    ) -> Result<bool, Failure> {
        let names: Vec<String> = which.iter().map(|&at| words(&all[at].scheme)).collect();
        let own = &*all;
        let found: Vec<Result<_, Failure>> =
            bar.at_once(&names, after, |number, turns, control| {
                let Asked { scheme, measure, known, about, .. } = &own[which[number]];
                if interrupt::is_cancelled() {
                    return Ok(None);
                }
                let own = self.each.and_then(|each| Instant::now().checked_add(each));
                let shared = budget.shared(if halves { 2 } else { turns }).deadline;
                let deadline = [shared, own].into_iter().flatten().min();
                let budget = Budget { deadline, ..self.budget };
                let known = (known.clone(), *about);
                let found = widest(self.claim, scheme, self.width, known, budget, control)
                    .map_err(|error| explain(error, self.design))?;
                let row = row(scheme, *measure, &found, self.width, self.arguments)?;
                Ok(Some((found, row)))
            });
        let mut improved = false;
        for (&at, found) in which.iter().zip(found) {
            let Some((known, row)) = found? else { continue };
            let before = all[at].certified().cloned();
            (all[at].known, all[at].row) = (known, Some(row));
            improved |= all[at].certified() != before.as_ref();
        }
        Ok(improved)
    }
}

fn too_large() -> Failure {
    Failure::Input("the design's numbers exceed what can be reported".to_owned())
}

/// The kinds that are asked for, in the order of [`Kind::ALL`].
fn named(on: &[String], design: &Design) -> Result<Vec<Kind>, Failure> {
    let claim = &design.claim;
    let there = Kind::of(&claim.mechanism);
    if let Mechanism::Orthoglide { .. } = &claim.mechanism {
        return Err(Failure::Input(design.refused(
            "workspace.cube",
            "the Orthoglide that meets its bounds with equality, which leaves no room for tolerances",
            "of tolerance, a design with leg_length, min and max",
        )));
    }
    if there.is_empty() {
        return Err(Failure::Input(design.refused(
            "mechanism.kind",
            "a machine by formulas, whose parameters are of no kinds",
            "of tolerance, a machine of legs; limit says how far any number of a design goes",
        )));
    }
    for name in on {
        if !there.iter().any(|kind| kind.name() == name.trim()) {
            let names: Vec<&str> = there.iter().map(|kind| kind.name()).collect();
            let found: String = name.chars().take(60).collect();
            return Err(Failure::Input(format!(
                "--on: found \"{found}\"; accepted, as this mechanism has them: {}",
                names.join(", ")
            )));
        }
    }
    let wanted = |kind: &Kind| on.is_empty() || on.iter().any(|name| kind.name() == name.trim());
    Ok(there.into_iter().filter(wanted).collect())
}

fn mixed(kinds: &[Kind]) -> bool {
    kinds.iter().any(|kind| kind.is_direction()) && kinds.iter().any(|kind| !kind.is_direction())
}

/// What a scheme widens.
fn words(scheme: &Scheme) -> String {
    let names: Vec<&str> = scheme.weights.iter().map(|(kind, _)| kind.name()).collect();
    let of = scheme.leg.map_or(String::new(), |leg| format!(" of leg {}", leg + 1));
    names.join(", ") + &of
}

fn measure(direction: bool) -> Measure {
    if direction {
        Measure::Component
    } else {
        Measure::Length
    }
}

/// Every kind alone, then all lengths and all directions by a common tolerance.
fn schemes(kinds: &[Kind]) -> Vec<Asked> {
    let alone = |kind: &Kind| Asked::new(Scheme::common(&[*kind]), measure(kind.is_direction()));
    let mut all: Vec<Asked> = kinds.iter().map(alone).collect();
    for direction in [false, true] {
        let same: Vec<Kind> =
            kinds.iter().copied().filter(|kind| kind.is_direction() == direction).collect();
        if same.len() > 1 {
            all.push(Asked::new(Scheme::common(&same), measure(direction)));
        }
    }
    all
}

/// The nodes of the proof of the design with nominal values. If it is not certified, says so and
/// gives the status.
fn nodes_or_status(
    nominal: &MachineClaim,
    arguments: &Arguments,
    budget: Budget,
) -> Result<Result<usize, Status>, Failure> {
    let effort = &arguments.effort;
    let refuted = refutation(nominal);
    let counterexample = refuted.as_deref().and_then(counterexample);
    if refuted.is_none() {
        let found = effort.run(|control| proof(nominal, budget, control));
        interrupt::unless_cancelled(())?;
        if let Ok(Proof::Tree(tree)) = found.map(|certificate| certificate.proof) {
            return Ok(Ok(tree.nodes.len()));
        }
    }
    let (word, status, known) = match refuted {
        Some(_) => (
            "refuted",
            Status::Decided(Verdict::Refuted),
            "There is no tolerance with which it could be certified.",
        ),
        None => (
            "undecided",
            Status::Undecided,
            "Nothing is known of tolerances: the nominal design is undecided within the budget;\n\
             raise --max-boxes or --timeout.",
        ),
    };
    match effort.format {
        Format::Json => print::json(&serde_json::json!({
            "nominal": word, "counterexample": counterexample, "each": &arguments.each,
            "tolerances": [],
        }))?,
        Format::Text => {
            let mut out = format!(
                "{}  the design without tolerances on the parameters named.\n{known}\n",
                word.to_uppercase()
            );
            if let Some(found) = counterexample {
                let _ = writeln!(out, "\n  {}", found.value);
                let point: Vec<String> = found.point.iter().map(exact).collect();
                let _ = writeln!(out, "  at P = ({})", point.join(", "));
            }
            print::answer(&out)?;
        }
    }
    Ok(Err(status))
}

fn row(
    scheme: &Scheme,
    measure: Measure,
    found: &Bracket,
    width: f64,
    arguments: &Arguments,
) -> Result<Row, Failure> {
    let names: Vec<&'static str> = scheme.weights.iter().map(|(kind, _)| kind.name()).collect();
    let stem = match (&names[..], measure) {
        ([name], _) => (*name).to_owned(),
        (_, Measure::Length) => "lengths".to_owned(),
        (_, Measure::Component) => "directions".to_owned(),
        (_, Measure::Share) => "all".to_owned(),
    };
    let stem = match scheme.leg {
        Some(leg) => format!("{stem}-{}", leg + 1),
        None => stem,
    };
    let (mut certificates, mut unwritten) = (Vec::new(), Unwritten::default());
    if let Some(folder) = &arguments.output {
        for (end, side) in [(&found.certified, "certified"), (&found.refuted, "refuted")] {
            if let Some((_, certificate)) = end {
                let name = format!("tolerance-{stem}-{side}.cert.json");
                certificates.extend(unwritten.unless(file(folder, &name, certificate)));
            }
        }
    }
    let counterexample =
        found.refuted.as_ref().and_then(|(_, certificate)| counterexample(certificate));
    let weights = match measure {
        Measure::Share => scheme
            .weights
            .iter()
            .map(|(kind, weight)| (kind.name(), Exact::Rational(weight.clone())))
            .collect(),
        _ => BTreeMap::new(),
    };
    let end =
        |end: &Option<(BigRational, _)>| end.as_ref().map(|(t, _)| Exact::Rational(t.clone()));
    let reached = found.gap();
    Ok(Row {
        on: names,
        leg: scheme.leg.map(|leg| leg + 1),
        measure,
        weights,
        certified: end(&found.certified),
        refuted: end(&found.refuted),
        gap: reached.as_ref().map(gap_text),
        gap_reached: found.reaches(width),
        out_of_time: found.out_of_time,
        counterexample,
        certificates,
        unwritten,
    })
}

/// The unit of a direction's tolerance for people: thousandths of its length.
const PER_METRE: &str = "mm/m";
/// The same as the design writes it.
const COMPONENT: &str = "component";

/// A tolerance of the components of a vector, of which the square of the length is known, in thousandths of
/// that; rounded as asked for. The same where it is not known.
fn per_metre(t: Exact, square: Option<BigRational>, toward: Toward) -> Option<Exact> {
    let Some(square) = square else { return Some(t) };
    let thousandths = t.as_rational()? * BigRational::from_integer(1000.into());
    let ratio = Exact::Rational(&thousandths * &thousandths / square).root().ok()?;
    let [least, most] = ratio.ends(ROOT_BITS)?;
    Some(Exact::Rational(if matches!(toward, Toward::Below) { least } else { most }))
}

fn text(rows: &[Row], arguments: &Arguments, design: &Design, started: Instant) -> String {
    let name = |row: &Row| match (&row.on[..], row.measure, row.leg) {
        ([name], _, Some(leg)) => format!("{name} of leg {leg}"),
        ([name], ..) => (*name).to_owned(),
        (_, Measure::Length, _) => "all lengths, coordinates".to_owned(),
        (_, Measure::Component, _) => "all directions".to_owned(),
        (_, Measure::Share, _) => "all, at a common share".to_owned(),
    };
    let limit =
        |row: &Row| row.counterexample.as_ref().map_or(String::new(), |it| it.limit.clone());
    let names: Vec<String> = rows.iter().map(name).collect();
    let head = "widest tolerance ± t of";
    let width = |texts: &mut dyn Iterator<Item = usize>, head: &str| {
        texts.max().unwrap_or(0).max(head.chars().count())
    };
    let first = width(&mut names.iter().map(|name| name.chars().count()), head);
    // What is told of a row: its unit, and both ends in it.
    let told = |row: &Row| {
        let in_lengths = row.measure == Measure::Component && !arguments.verbose;
        let leg = row.leg.map(|leg| leg - 1);
        let sizes = in_lengths.then(|| squares(&design.claim.mechanism, &row.on, leg)).flatten();
        let unit = match row.measure {
            Measure::Length => design.unit.unwrap_or("length"),
            Measure::Component if sizes.is_some() => PER_METRE,
            Measure::Component => COMPONENT,
            Measure::Share => "share",
        };
        let [least, most] = sizes.map_or([None, None], |ends| ends.map(Some));
        let end = |t: &Option<Exact>, square, toward| {
            let t = t.clone().and_then(|t| per_metre(t, square, toward));
            t.map_or("not found".into(), |t| outward(&t, DIGITS, toward))
        };
        let certified = end(&row.certified, most, Toward::Below);
        (unit, [certified, end(&row.refuted, least, Toward::Above)])
    };
    let told: Vec<(&str, [String; 2])> = rows.iter().map(told).collect();
    let second = width(&mut told.iter().map(|(unit, _)| unit.len()), "in");
    let lengths = told.iter().flat_map(|(_, ends)| ends).map(String::len);
    let third = width(&mut { lengths }, "certified");
    let mut out = String::new();
    let quiet = arguments.effort.quiet;
    if !quiet {
        let _ = writeln!(
            out,
            "  {head:first$}  {:second$}  {:>third$}  {:>third$}  {:>7}  limited by",
            "in", "certified", "refuted", "gap"
        );
    }
    for ((row, name), (unit, [certified, refuted])) in rows.iter().zip(&names).zip(&told) {
        let gap = row.gap.as_deref().unwrap_or("-");
        let mark = if row.out_of_time { " *" } else { "" };
        let line = format!(
            "  {name:first$}  {unit:second$}  {certified:>third$}  {refuted:>third$}  {gap:>7}{mark}"
        );
        let limit = limit(row);
        let line = match line.chars().count() + 2 + limit.chars().count() {
            0..=WIDTH => format!("{line}  {limit}"),
            _ => format!("{line}\n      {limit}"),
        };
        let _ = writeln!(out, "{}", line.trim_end());
    }
    if interrupt::is_cancelled() {
        let _ = writeln!(out, "\n  {}", interrupt::PARTIAL);
    }
    if quiet {
        return out;
    }
    out.push('\n');
    wrap(
        &mut out,
        "Every parameter of the kinds named lies within ± t of its nominal value, independently of all \
         others. The design is certified for the t on the left, and refuted, by one machine and point, \
         for the t on the right, which is greater by the gap, a part of the left one.",
        2,
    );
    if rows.iter().any(|row| row.out_of_time) {
        wrap(
            &mut out,
            "* The time was up, or it was interrupted: with more time the ends may be nearer to each other.",
            2,
        );
    }
    if let Some(each) = &arguments.each {
        // Without a unit, seconds.
        let mut each: String = each.trim().chars().take(20).collect();
        if each.ends_with(|c: char| c.is_ascii_digit() || c == '.') {
            each.push('s');
        }
        wrap(&mut out, &format!("Each row had at most {each} of time."), 2);
    }
    let is_told_in = |one: &str| told.iter().any(|(unit, _)| *unit == one);
    if is_told_in(PER_METRE) {
        wrap(
            &mut out,
            "A direction's t is that of each component of its unit vector: 1 mm/m, across it, is 0.0573 \
             degrees. --verbose tells components as the design writes them.",
            2,
        );
    }
    if is_told_in(COMPONENT) {
        wrap(
            &mut out,
            "A direction's t is that of its components as the design writes them: of a unit vector, \
             0.001 is 1 mm per metre across it, or 0.0573 degrees.",
            2,
        );
    }
    if rows.iter().any(|row| row.measure == Measure::Share) {
        wrap(&mut out, "A share widens every kind by this part of its own certified t above.", 2);
    }
    if rows.iter().any(|row| !row.gap_reached) {
        wrap(
            &mut out,
            "Where the gap is wider than asked for, or an end not found, the tolerances between, or \
             beyond, are undecided: no proof was found, and no machine that fails; the exit code is 3 for \
             that.",
            2,
        );
    }
    if !arguments.by_leg {
        wrap(&mut out, "--by-leg widens one leg at a time, and ranks the legs.", 2);
    }
    let _ = writeln!(out, "\n  {}", duration(started.elapsed().as_secs_f64()));
    out
}
