//! `orthocert design`.

use super::{input, print, Failure, Format, Status};
use crate::exact::decimal::{readable, rounded, Toward};
use crate::exact::Exact;
use crate::questions::dimensions::{dimensions, Dimension, DimensionError, Unit};
use serde::Serialize;
use std::fmt::Write;

/// Significant digits of every decimal.
const DIGITS: u32 = 15;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Greatest velocity transmission factor, greater than 1; psi_min = 1/psi_max
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    psi_max: String,
    /// Side of the cubic workspace, greater than 0
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    cube: String,
    /// Platform offset e
    #[arg(long, value_name = "E", default_value = "0", allow_hyphen_values = true)]
    offset: String,
    /// Print a design file for "orthocert verify"
    #[arg(long, conflicts_with = "format")]
    toml: bool,
    /// The form of the answer
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// The answer for scripts; every number is exact or a proved bound.
#[derive(Serialize)]
struct Answer {
    psi_max: Exact,
    cube: Exact,
    offset: Exact,
    dimensions: Vec<Enclosed>,
}

/// A dimension between two proved decimals.
#[derive(Serialize)]
struct Enclosed {
    symbol: &'static str,
    name: &'static str,
    unit: &'static str,
    min: String,
    max: String,
}

impl Enclosed {
    fn new(dimension: &Dimension) -> Self {
        Enclosed {
            symbol: dimension.symbol,
            name: dimension.name,
            unit: match dimension.unit {
                Unit::Length => "length",
                Unit::Degree => "deg",
            },
            min: rounded(&dimension.inf(), DIGITS, Toward::Below),
            max: rounded(&dimension.sup(), DIGITS, Toward::Above),
        }
    }
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let psi_max = input::number("--psi-max", &arguments.psi_max)?;
    let cube = input::number("--cube", &arguments.cube)?;
    let offset = input::number("--offset", &arguments.offset)?;
    let found = dimensions(&psi_max, &cube, &offset, DIGITS)
        .map_err(|error| Failure::Input(arguments.explain(&error)))?;
    let dimensions: Vec<Enclosed> = found.iter().map(Enclosed::new).collect();
    let answer = Answer { psi_max, cube, offset, dimensions };
    match arguments.format {
        _ if arguments.toml => print::answer(&toml(arguments, &answer))?,
        Format::Text => print::answer(&text(&answer))?,
        Format::Json => print::json(&answer)?,
    }
    Ok(Status::Done)
}

impl Arguments {
    fn explain(&self, error: &DimensionError) -> String {
        match error {
            DimensionError::PsiMaxNotAboveOne => format!("--psi-max {}: {error}", self.psi_max),
            DimensionError::CubeNotPositive => format!("--cube {}: {error}", self.cube),
            _ => error.to_string(),
        }
    }
}

/// The table of dimensions, every line behind `margin`.
fn table(out: &mut String, dimensions: &[Enclosed], margin: &str) {
    let width = |of: fn(&Enclosed) -> &str| dimensions.iter().map(|d| of(d).len()).max();
    let (symbols, names) = (width(|d| d.symbol).unwrap_or(0), width(|d| d.name).unwrap_or(0));
    let numbers = width(|d| &d.min).max(width(|d| &d.max)).unwrap_or(0);
    let head = format!(
        "{margin}{:symbols$}  {:names$}  {:>numbers$}  {:>numbers$}",
        "", "", "at least", "at most"
    );
    let _ = writeln!(out, "{}", head.trim_end());
    for Enclosed { symbol, name, unit, min, max } in dimensions {
        let unit = if *unit == "deg" { "  deg" } else { "" };
        let _ = writeln!(
            out,
            "{margin}{symbol:symbols$}  {name:names$}  {min:>numbers$}  {max:>numbers$}{unit}"
        );
    }
}

fn text(answer: &Answer) -> String {
    let [psi_max, cube, offset] = [&answer.psi_max, &answer.cube, &answer.offset].map(readable);
    let mut out = format!(
        "Orthoglide for psi_max = {psi_max} and a cube of side {cube}, offset e = {offset}\n\
         Every value is proved to lie between its two decimals.\n\n"
    );
    table(&mut out, &answer.dimensions, "  ");
    out
}

/// A design file in the closed form, from which `verify` computes the same dimensions.
fn toml(arguments: &Arguments, answer: &Answer) -> String {
    let mut out = "\
# The Orthoglide whose dimensions follow from the side of its cubic workspace and the greatest\n\
# velocity transmission factor. Every value lies between its two decimals:\n#\n"
        .to_owned();
    table(&mut out, &answer.dimensions, "#   ");
    let [psi_max, cube, offset] =
        [&arguments.psi_max, &arguments.cube, &arguments.offset].map(|text| literal(text));
    let _ = write!(
        out,
        "
title = \"Orthoglide of a cube\"

[mechanism]
kind = \"orthoglide\"
offset = {offset}

[workspace]
cube = {cube}

[requirements]
transmission = {{ max = {psi_max} }}
"
    );
    out
}

/// A number as it was given, bare where that is a number of TOML.
fn literal(text: &str) -> String {
    let text = text.trim();
    let (whole, fraction) = text.split_once('.').unwrap_or((text, "0"));
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    let bare = digits(whole) && digits(fraction) && (whole == "0" || !whole.starts_with('0'));
    if bare {
        text.to_owned()
    } else {
        format!("\"{text}\"")
    }
}
