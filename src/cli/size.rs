//! `orthocert size`, and what it has in common with `orthocert tolerance`.

use super::{certify, effort, input, print, Failure, Format, Status};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert::decimal::{exact, rounded, terminating, Toward};
use orthocert::frontier::{Bracket, NoAnswer};
use orthocert::output;
use orthocert::report::CertificateFile;
use orthocert::size::{is_side, Family, Unknown};
use orthocert_checker::certificate::Certificate;
use orthocert_checker::claim::Claim;
use orthocert_checker::number::Exact;
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Boxes after which a size counts as not certified.
const BOXES: usize = 20_000;
/// Significant digits of a size.
const DIGITS: u32 = 15;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The design file; without it, the prototype of the paper
    #[arg(value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// Side of the cube that is to lie where every requirement holds
    #[arg(long, value_name = "SIDE", allow_hyphen_values = true)]
    cube: String,
    /// Relative distance of the certified and the refuted size to stop at
    #[arg(long, value_name = "WIDTH", default_value = "1e-6", allow_hyphen_values = true)]
    gap: String,
    /// Write the certificates of both ends into this folder, which exists
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
    /// The greatest that was refuted, for this placement.
    refuted: Option<Exact>,
    /// What the refutation speaks about: always "this placement".
    refuted_for: &'static str,
    /// `certified/refuted - 1`, rounded up.
    gap: Option<String>,
    gap_reached: bool,
    /// The cube's centre for size 1: it moves in proportion to the size.
    centre_for_size_one: [Exact; 3],
    /// The cube's centre for the certified size.
    #[serde(skip_serializing_if = "Option::is_none")]
    centre: Option<[Exact; 3]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    certificates: Vec<CertificateFile>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let width = gap(&arguments.gap, 1e-9, 0.1)?;
    let side = side(&arguments.cube)?;
    let design = input::design(arguments.design.as_deref())?;
    let Claim::Machine(claim) = &design.claim else {
        return Err(Failure::Defect);
    };
    if let Some(folder) = &arguments.output {
        output::probe(&folder.join("size.cert.json"))?;
    }
    effort.start_threads()?;
    let mut budget = effort.budget(started)?;
    budget.max_boxes = budget.max_boxes.min(BOXES);
    let family = Family::new(claim, &side, width).map_err(explain)?;
    let found = effort.run(|control| family.smallest(width, budget, control)).map_err(explain)?;
    let answer = answer(&family, &found, side, width, arguments)?;
    match effort.format {
        Format::Json => print::json(&answer)?,
        Format::Text => print::answer(&text(&answer, started))?,
    }
    let complete = answer.certified.is_some() && answer.refuted.is_some();
    Ok(if complete { Status::Done } else { Status::Undecided })
}

fn side(text: &str) -> Result<BigRational, Failure> {
    let number = input::number("--cube", text)?;
    number.as_rational().filter(|side| is_side(side)).cloned().ok_or_else(|| {
        let text: String = text.chars().take(60).collect();
        Failure::Input(format!(
            "--cube: found \"{text}\"; accepted: a rational number greater than 0: the cube's side"
        ))
    })
}

/// The relative width that an option `--gap` asks for.
pub fn gap(text: &str, least: f64, greatest: f64) -> Result<f64, Failure> {
    let number = input::number("--gap", text)?;
    let value = number.as_rational().and_then(ToPrimitive::to_f64);
    value.filter(|gap| (least..=greatest).contains(gap)).ok_or_else(|| {
        let text: String = text.chars().take(60).collect();
        Failure::Input(format!(
            "--gap: found \"{text}\"; accepted: a number from {least:e} to {greatest}"
        ))
    })
}

/// The failure that there is no answer.
pub fn explain(error: NoAnswer) -> Failure {
    match error {
        NoAnswer::Cancelled => Failure::Interrupted,
        error => Failure::input(error),
    }
}

/// Writes a certificate into a file.
pub fn file(path: &Path, certificate: &Certificate) -> Result<CertificateFile, Failure> {
    let text = certificate.to_text().map_err(|_| Failure::Defect)?;
    certify::store(path, &text)
}

/// A relative width, two digits, rounded up.
pub fn gap_text(gap: &BigRational) -> String {
    rounded(gap, 2, Toward::Above)
}

/// A decimal in full, if it is one of at most so many digits; else rounded to them.
pub fn shown(x: &Exact, digits: u32, toward: Toward) -> String {
    let Some(value) = x.as_rational() else {
        return x.to_string();
    };
    let short = terminating(value, digits).filter(|text| text.len() <= digits as usize + 2);
    short.unwrap_or_else(|| rounded(value, digits, toward))
}

fn answer(
    family: &Family,
    found: &Bracket,
    side: BigRational,
    width: f64,
    arguments: &Arguments,
) -> Result<Answer, Failure> {
    let mut certificates = Vec::new();
    if let Some(folder) = &arguments.output {
        for (end, name) in [(&found.certified, "certified"), (&found.refuted, "refuted")] {
            if let Some((_, certificate)) = end {
                certificates
                    .push(file(&folder.join(format!("size-{name}.cert.json")), certificate)?);
            }
        }
    }
    let end = |end: &Option<(BigRational, _)>| {
        end.as_ref().map(|(size, _)| Exact::Rational(size.clone()))
    };
    let (certified, refuted) = (end(&found.certified), end(&found.refuted));
    let centre = certified.as_ref().and_then(|size| {
        let [x, y, z] = family.centre.each_ref().map(|c| c.clone().times(size.clone()).ok());
        Some([x?, y?, z?])
    });
    let reached = found.gap();
    Ok(Answer {
        unknown: match family.unknown {
            Unknown::LegLength => "leg_length",
            Unknown::Scale => "scale",
        },
        cube: Exact::Rational(side),
        certified,
        refuted,
        refuted_for: "this placement",
        gap: reached.as_ref().map(gap_text),
        gap_reached: reached.and_then(|gap| gap.to_f64()).is_some_and(|gap| gap <= width),
        centre_for_size_one: family.centre.clone(),
        centre,
        certificates,
    })
}

fn text(answer: &Answer, started: Instant) -> String {
    let (name, what) = match answer.unknown {
        "leg_length" => ("leg length", "the leg length"),
        _ => {
            ("scale", "the scale of the whole machine, whose lengths and coordinates it multiplies")
        }
    };
    let cube = exact(&answer.cube);
    let mut out = format!("The smallest machine for a cube of side {cube},\nby {what}.\n\n");
    let row = |out: &mut String, label: &str, value: &str, note: &str| {
        let _ = writeln!(out, "  {label:<22} {value:<20} {note}");
    };
    match &answer.certified {
        Some(size) => {
            let value = shown(size, DIGITS, Toward::Above);
            row(&mut out, &format!("{name}, certified"), &value, "and every greater one");
        }
        None => row(&mut out, &format!("{name}, certified"), "none", "no proof was found"),
    }
    match &answer.refuted {
        Some(size) => {
            let value = shown(size, DIGITS, Toward::Below);
            row(&mut out, &format!("{name}, refuted"), &value, "for this placement, and smaller");
        }
        None => row(&mut out, &format!("{name}, refuted"), "none", "no point that fails was found"),
    }
    if let Some(gap) = &answer.gap {
        let _ = writeln!(out, "  {:<22} {gap}", "relative gap");
    }
    if let Some(centre) = &answer.centre {
        let _ = writeln!(out, "  cube's centre, certified");
        for (axis, x) in ["x", "y", "z"].iter().zip(centre) {
            let _ = writeln!(out, "    {axis} = {}", shown(x, DIGITS, Toward::Below));
        }
    }
    out +=
        "\n  The centre moves in proportion to the size. The refutation is for the cube placed\n  \
            so, the best place that was found: that no other place works is not proved.\n";
    let _ = writeln!(out, "\n  {:.1} s", started.elapsed().as_secs_f64());
    out
}
