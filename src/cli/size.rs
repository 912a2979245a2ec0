//! `orthocert size`.

use super::certify::{self, Unwritten};
use super::ends::{explain, gap, gap_text, missed, NOT_BEST};
use super::{effort, input, interrupt, print, Failure, Status};
use crate::exact::decimal::{exact, outward, readable, Toward};
use crate::exact::Exact;
use crate::questions::frontier::{Bracket, Certified};
use crate::questions::size::{Family, Scope, Unknown};
use crate::report::text::{duration, file_line, labelled, wrap};
use crate::report::{counterexample, CertificateFile, Counterexample};
use num_rational::BigRational;
use orthocert_kernel::claim::{Leg, MachineClaim, Mechanism, Quantity};
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Boxes after which a size counts as not certified; of centres, as not refuted for every
/// axis-aligned placement.
const BOXES: u64 = 20_000;
/// Significant digits of a size.
const DIGITS: u32 = 15;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The design file; without it, the prototype of the paper
    #[arg(value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// Side of the cube, its edges along the axes, that is to lie where every requirement holds
    #[arg(long, value_name = "SIDE", allow_hyphen_values = true)]
    cube: String,
    /// Relative distance of the certified and the refuted size to stop at
    #[arg(long, value_name = "WIDTH", default_value = "1e-6", allow_hyphen_values = true)]
    gap: String,
    /// Write the certificates of all ends into this folder, which exists: size-certified,
    /// size-refuted (for the cube's place) and size-excluded (for every place of a cube with its
    /// edges along the axes; nothing is claimed of turned cubes)
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: effort::Effort,
}

/// The answer for scripts.
#[derive(Serialize)]
struct Answer {
    /// "leg_length" or "scale".
    unknown: &'static str,
    cube: Exact,
    /// The smallest size that was certified.
    certified: Option<Exact>,
    /// The greatest that was refuted.
    refuted: Option<Exact>,
    /// For which placements of the cube, with its edges along the axes.
    refuted_for: &'static str,
    /// `certified/refuted - 1`, rounded up.
    gap: Option<String>,
    gap_reached: bool,
    /// Why not.
    #[serde(skip_serializing_if = "Option::is_none")]
    missed: Option<&'static str>,
    /// The greatest that was refuted for more than one placement.
    excluded: Option<Exact>,
    /// For which; `null` if that is not known how to prove.
    excluded_for: Option<&'static str>,
    /// The cube's centre for size 1: it moves in proportion to the size.
    centre_for_size_one: [Exact; 3],
    /// The cube's centre for the certified size.
    #[serde(skip_serializing_if = "Option::is_none")]
    centre: Option<[Exact; 3]>,
    /// What fails first in a smaller machine, the cube placed so.
    #[serde(skip_serializing_if = "Option::is_none")]
    limited_by: Option<Counterexample>,
    /// The length that all legs have in common, for scale 1.
    #[serde(skip)]
    length: Option<Exact>,
    #[serde(skip_serializing_if = "Option::is_none")]
    length_unit: Option<&'static str>,
    /// Whether it was interrupted: this is what was found before.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    certificates: Vec<CertificateFile>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let width = gap(&arguments.gap, ["1e-9", "0.1"])?;
    let side = input::rational_within("--cube", &arguments.cube, input::SIZES)?;
    let design = input::design(arguments.design.as_deref(), effort.quiet)?;
    let claim = &design.claim;
    if let Some(folder) = &arguments.output {
        input::probe_in(folder, "size.cert.json", arguments.design.as_deref())?;
    }
    effort.start_threads()?;
    let budget = effort.budget_or(BOXES, started)?;
    interrupt::grant();
    let mut bar = effort.bar();
    let family = bar.run("place of the cube", 5, |control| {
        Family::new(claim, &side, width, budget.shared(2), control)
    });
    let family = family.map_err(|error| explain(error, &design))?;
    let found = bar
        .run("this place", 2, |control| family.smallest(width, budget.shared(2), control))
        .map_err(|error| explain(error, &design))?;
    let excluded = bar
        .run("every place", 1, |control| family.excluded(width, budget, control))
        .map_err(|error| explain(error, &design))?;
    drop(bar);
    let out_of_time = found.out_of_time || excluded.out_of_time || family.out_of_time;
    let excluded = excluded.found;
    let nothing = found.certified.is_none() && found.refuted.is_none() && excluded.is_none();
    if nothing && interrupt::is_cancelled() {
        return Err(Failure::Interrupted);
    }
    let mut unwritten = Unwritten::default();
    let answer = answer(&family, (found, excluded), side, width, (arguments, &mut unwritten));
    let missed = match answer.interrupted {
        false if !answer.gap_reached => Some(missed(out_of_time)),
        false if family.out_of_time => Some(NOT_BEST),
        _ => None,
    };
    let length = common_length(claim);
    let answer = Answer { length, length_unit: design.unit, missed, ..answer };
    print::told(effort.format, &answer, || text(&answer, effort.quiet, started))?;
    let is_done = answer.gap_reached && answer.missed.is_none();
    let status = if is_done { Status::Done } else { Status::Undecided };
    unwritten.told()?;
    interrupt::unless_cancelled(status)
}

/// The length that all legs have, if it is one exact number.
fn common_length(claim: &MachineClaim) -> Option<Exact> {
    let Mechanism::Translational(legs) = &claim.mechanism else { return None };
    let length = |leg: &Leg| match leg {
        Leg::Slider { length: Quantity::Exactly(length), .. }
        | Leg::Arm { length: Quantity::Exactly(length), .. } => Some(length.clone()),
        _ => None,
    };
    let first = length(legs.first()?)?;
    let same = legs.iter().all(|leg| length(leg).as_ref() == Some(&first));
    same.then(|| Exact::of(&first)).flatten()
}

fn scope(scope: Scope) -> &'static str {
    match scope {
        Scope::Everywhere => "every axis-aligned placement",
        Scope::Workspace => "every axis-aligned placement centred in the workspace, scaled",
    }
}

fn answer(
    family: &Family,
    (mut found, excluded): (Bracket, Option<Certified>),
    side: BigRational,
    width: f64,
    (arguments, unwritten): (&Arguments, &mut Unwritten),
) -> Answer {
    let certificates = match &arguments.output {
        Some(folder) => stored(folder, &found, excluded.as_ref(), unwritten),
        None => Vec::new(),
    };
    let end = |end: &Option<Certified>| end.as_ref().map(|(size, _)| Exact::Rational(size.clone()));
    let excluded_for = family.scope().map(scope);
    let for_all = Bracket { refuted: excluded, ..found.clone() };
    let excluded = end(&for_all.refuted);
    let limit = found.refuted.as_ref().and_then(|(_, certificate)| counterexample(certificate));
    let mut refuted_for = "this placement";
    if let (true, Some(all)) = (for_all.reaches(width), excluded_for) {
        (found, refuted_for) = (for_all, all);
    }
    let certified = end(&found.certified);
    let centre = found
        .certified
        .as_ref()
        .map(|(size, _)| family.centre.each_ref().map(|c| Exact::Rational(c * size)));
    Answer {
        unknown: match family.unknown {
            Unknown::LegLength => "leg_length",
            Unknown::Scale => "scale",
        },
        cube: Exact::Rational(side),
        certified,
        refuted: end(&found.refuted),
        refuted_for,
        gap: found.gap().as_ref().map(gap_text),
        gap_reached: found.reaches(width),
        missed: None,
        excluded,
        excluded_for,
        centre_for_size_one: family.centre.clone().map(Exact::Rational),
        centre,
        limited_by: limit,
        length: None,
        length_unit: None,
        interrupted: interrupt::is_cancelled(),
        certificates,
    }
}

/// Writes the certificates that there are.
fn stored(
    folder: &Path,
    found: &Bracket,
    excluded: Option<&Certified>,
    unwritten: &mut Unwritten,
) -> Vec<CertificateFile> {
    let ends = [
        ("certified", found.certified.as_ref()),
        ("refuted", found.refuted.as_ref()),
        ("excluded", excluded),
    ];
    let there = ends.into_iter().filter_map(|(name, end)| Some((name, &end?.1)));
    there
        .filter_map(|(name, certificate)| {
            let path = folder.join(format!("size-{name}.cert.json"));
            unwritten.unless(certify::write(Some(folder), &path, certificate))
        })
        .collect()
}

fn text(answer: &Answer, quiet: bool, started: Instant) -> String {
    let (name, what, unit) = match (answer.unknown, answer.length_unit) {
        ("leg_length", unit) => ("leg length", "leg length", unit),
        _ => (
            "scale",
            "scale of the whole machine, whose lengths and coordinates it multiplies",
            None,
        ),
    };
    let with_unit = |unit: Option<&str>| unit.map(|unit| format!(" {unit}")).unwrap_or_default();
    let cube = exact(&answer.cube) + &with_unit(answer.length_unit);
    let unit = with_unit(unit);
    let value = |size: &Exact, toward| outward(size, DIGITS, toward) + &unit;
    // Of a refutation for one placement the first line says nothing: another may do.
    let for_all = answer.excluded_for == Some(answer.refuted_for);
    let excluded = if for_all { &answer.refuted } else { &answer.excluded };
    let mut out = match (&answer.certified, excluded) {
        (Some(size), Some(less)) => format!(
            "smallest {name} for a cube of side {cube}: between {} and {}\n",
            outward(less, DIGITS, Toward::Below),
            value(size, Toward::Above)
        ),
        (Some(size), None) => {
            format!(
                "smallest {name} for a cube of side {cube}: at most {}\n",
                value(size, Toward::Above)
            )
        }
        (None, Some(less)) => {
            format!(
                "smallest {name} for a cube of side {cube}: more than {}\n",
                value(less, Toward::Below)
            )
        }
        (None, None) => format!("undecided: no {name} is certified for a cube of side {cube}\n"),
    };
    if answer.interrupted {
        let _ = writeln!(out, "{}", interrupt::PARTIAL);
    }
    if quiet {
        return out;
    }
    wrap(&mut out, &format!("The cube has its edges along the axes; sought was the {what}."), 0);
    out.push('\n');
    match &answer.certified {
        Some(size) => labelled(&mut out, "certified", &value(size, Toward::Above)),
        None => labelled(&mut out, "certified", "none: no proof was found"),
    }
    let scaled = answer.length.as_ref().zip(answer.certified.as_ref());
    let scaled = scaled.filter(|_| answer.unknown == "scale").and_then(|(length, size)| {
        let whole = size.clone().times(length.clone()).ok()?;
        let unit = with_unit(answer.length_unit);
        Some(format!("{}{unit}, for the {} of the design", readable(&whole), readable(length)))
    });
    if let Some(text) = scaled {
        labelled(&mut out, "leg length", &text);
    }
    match &answer.refuted {
        Some(size) => {
            let text = format!("{}, for {}", value(size, Toward::Below), answer.refuted_for);
            labelled(&mut out, "refuted", &text);
        }
        None => labelled(&mut out, "refuted", "none: no point that fails was found"),
    }
    if let (Some(size), Some(all)) = (&answer.excluded, answer.excluded_for) {
        if answer.refuted_for != all {
            let text = format!("{}, for {all}", value(size, Toward::Below));
            labelled(&mut out, "excluded", &text);
        }
    }
    if let Some(gap) = &answer.gap {
        labelled(&mut out, "gap", gap);
    }
    if let Some(why) = answer.missed {
        labelled(&mut out, "gap missed", why);
    }
    if let Some(found) = &answer.limited_by {
        labelled(&mut out, "limited by", &found.limit);
        labelled(&mut out, "at", &found.at());
    }
    if let Some(centre) = &answer.centre {
        let centre: Vec<String> = centre.iter().map(exact).collect();
        labelled(&mut out, "centre", &format!("({}), of the certified cube", centre.join(", ")));
    }
    answer.certificates.iter().for_each(|file| file_line(&mut out, file));
    out.push('\n');
    wrap(
        &mut out,
        "The centre moves in proportion to the size. What is certified is for every greater size too, \
         what is refuted or excluded for every smaller one. Nothing is claimed of turned cubes.",
        2,
    );
    match (answer.excluded_for, &answer.excluded) {
        (Some(all), Some(_)) if answer.refuted_for == all => {}
        (Some(_), Some(_)) => wrap(
            &mut out,
            "The refutation is for the cube placed so, the best place that was found; of other places, \
             the exclusion says what is proved.",
            2,
        ),
        _ => wrap(
            &mut out,
            "The refutation is for the cube placed so, the best place that was found: that no other \
             place works is not proved.",
            2,
        ),
    }
    let _ = writeln!(out, "\n  {}", duration(started.elapsed().as_secs_f64()));
    out
}
