//! `orthocert bounds`.

use super::{certify, effort, input, print, Failure, Format, Status};
use num_rational::BigRational;
use num_traits::Signed;
use orthocert::decimal::{rounded, Toward};
use orthocert::exact::Exact;
use orthocert::output;
use orthocert::report::{exactly, CertificateFile};
use orthocert::search::Budget;
use orthocert::solver::extremes::{
    enclose, is_singular, loosest, of_cube, Enclosed, Extreme, NotEnclosed,
};
use orthocert::solver::value::with_unit;
use orthocert_checker::certificate::{Certificate, Proof};
use orthocert_kernel::claim as kernel;
use orthocert_kernel::machine::Leg;
use orthocert_kernel::problem::Problem;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

/// Significant digits beyond those that the width leaves certain.
const GUARD_DIGITS: u32 = 2;

/// Width of the column of quantities: "joint/tool speed, deg/length".
const WIDEST: usize = 28;

/// Boxes after which a width is given up for a looser one: what closes at all mostly closes in a
/// few hundred; the condition number of the rotary Delta takes 40,000.
const BOXES: u64 = 100_000;

/// Its flags.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The design file; without it, the prototype of the paper
    #[arg(value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// Relative width of every enclosure
    #[arg(long, value_name = "WIDTH", default_value = "1e-6", allow_hyphen_values = true)]
    relative: String,
    /// Write both certificates of every bound into this folder, which exists
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    effort: effort::Effort,
}

/// A quantity's extreme for scripts.
#[derive(Serialize)]
struct Row {
    quantity: String,
    /// Its unit, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'static str>,
    /// "least" or "greatest".
    end: &'static str,
    /// Below the extreme, or equal.
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<Exact>,
    /// Above the extreme, or equal.
    #[serde(skip_serializing_if = "Option::is_none")]
    max: Option<Exact>,
    /// The point that reaches the inner end, in exact numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    point: Option<Vec<Exact>>,
    /// The relative width that was reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    relative: Option<String>,
    /// Whether it is wider than what was asked for.
    #[serde(skip)]
    wide: bool,
    /// Why there is no enclosure.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_enclosed: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    certificates: Vec<CertificateFile>,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let relative = relative(&arguments.relative)?;
    let design = input::design(arguments.design.as_deref())?;
    if let Some(folder) = &arguments.output {
        output::probe(&folder.join("bounds.cert.json"))?;
        arguments.design.as_deref().map_or(Ok(()), |design| input::apart_in(folder, design))?;
    }
    effort.start_threads()?;
    let budget = effort.budget_or(BOXES, started)?;
    let claim = &design.claim;
    let rows = rows(claim, &relative, arguments, budget)?;
    match effort.format {
        Format::Json => print::json(&serde_json::json!({ "bounds": rows }))?,
        Format::Text => print::answer(&text(&rows, started))?,
    }
    let complete = rows.iter().all(|row| row.not_enclosed.is_none());
    Ok(if complete { Status::Done } else { Status::Undecided })
}

fn rows(
    claim: &kernel::MachineClaim,
    relative: &BigRational,
    arguments: &Arguments,
    budget: Budget,
) -> Result<Vec<Row>, Failure> {
    let effort = &arguments.effort;
    let failure = |error: NotEnclosed| match error {
        NotEnclosed::Cancelled => Failure::Interrupted,
        error => Failure::input(error),
    };
    let problem = Problem::new(claim).map_err(Failure::input)?;
    let angular = problem.legs.iter().any(Leg::is_angular);
    let singular = effort.run(|control| is_singular(claim, budget, control)).map_err(failure)?;
    let mut rows = exact_rows(claim);
    for extreme in Extreme::of(claim, problem.legs.len()) {
        let found = if singular {
            Err(NotEnclosed::Singular)
        } else {
            effort.run(|control| enclose(claim, &extreme, relative, budget, control))
        };
        let mut row = Row::new(extreme.quantity(), extreme.unit(angular), extreme.is_greatest());
        match found {
            Ok(Enclosed { width, inner, outer, refuted, certified, .. }) => {
                let [inner, outer] = [inner, outer].map(Exact::Rational);
                let certificates = (refuted.as_deref(), &*certified);
                row.enclosed((width, inner, outer), relative);
                row.store(arguments, extreme.file_stem(), certificates)?;
            }
            Err(error @ (NotEnclosed::Cancelled | NotEnclosed::Claim(_))) => {
                return Err(failure(error));
            }
            Err(error) => row.not_enclosed = Some(error.to_string()),
        }
        rows.push(row);
    }
    Ok(rows)
}

fn relative(text: &str) -> Result<BigRational, Failure> {
    let number = input::number("--relative", text)?;
    let least = BigRational::new(1.into(), 10.into()).pow(12);
    match number.as_rational() {
        Some(x) if x.is_positive() && *x >= least && *x <= loosest() => Ok(x.clone()),
        _ => Err(Failure::Input(format!(
            "--relative: found \"{text}\"; accepted: a number from 1e-12 to 0.1"
        ))),
    }
}

/// The rows that the paper's cube has by definition.
fn exact_rows(claim: &kernel::MachineClaim) -> Vec<Row> {
    let row = |(greatest, value): (bool, Exact)| Row {
        min: Some(value.clone()),
        max: Some(value),
        relative: Some("0".into()),
        ..Row::new("psi".into(), None, greatest)
    };
    of_cube(claim).into_iter().map(row).collect()
}

impl Row {
    fn new(quantity: String, unit: Option<&'static str>, greatest: bool) -> Self {
        Row {
            quantity,
            unit,
            end: if greatest { "greatest" } else { "least" },
            min: None,
            max: None,
            point: None,
            relative: None,
            wide: false,
            not_enclosed: None,
            certificates: Vec::new(),
        }
    }

    /// Between a refuted bound and a certified one.
    fn enclosed(
        &mut self,
        (width, inner, outer): (BigRational, Exact, Exact),
        asked: &BigRational,
    ) {
        self.wide = width > *asked;
        self.relative = Some(rounded(&width, 2, Toward::Above));
        let (min, max) = if self.end == "greatest" { (inner, outer) } else { (outer, inner) };
        (self.min, self.max) = (Some(min), Some(max));
    }

    /// Writes the certificates, if they are asked for; the point is that of the refutation.
    fn store(
        &mut self,
        arguments: &Arguments,
        stem: String,
        (refuted, certified): (Option<&Certificate>, &Certificate),
    ) -> Result<(), Failure> {
        self.point = refuted.and_then(witness_point);
        let Some(folder) = &arguments.output else { return Ok(()) };
        let inner = refuted.into_iter().map(|certificate| (certificate, "inner"));
        for (certificate, side) in inner.chain([(certified, "outer")]) {
            let text = certificate.to_text().map_err(|_| Failure::Defect)?;
            let path = folder.join(format!("{stem}-{side}.cert.json"));
            self.certificates.push(certify::store(Some(folder), &path, &text)?);
        }
        Ok(())
    }
}

fn witness_point(certificate: &Certificate) -> Option<Vec<Exact>> {
    match &certificate.proof {
        Proof::Witness(witness) => witness.point.iter().map(exactly).collect(),
        _ => None,
    }
}

fn text(rows: &[Row], started: Instant) -> String {
    let mut out = "Every extreme lies between its two decimals: one is refuted by a witness as a\n\
         bound, the other is certified.\n\n"
        .to_owned();
    let _ = writeln!(
        out,
        "  {:<WIDEST$} {:<8} {:<17} {:<17} {:>7}",
        "quantity", "extreme", "from", "to", "width"
    );
    for row in rows {
        let quantity = with_unit(&row.quantity, row.unit);
        let _ = write!(out, "  {quantity:<WIDEST$} {:<8} ", row.end);
        match (&row.min, &row.max, &row.not_enclosed) {
            (Some(min), Some(max), _) => {
                let (min, max) = (shown(min, Toward::Below), shown(max, Toward::Above));
                let width = row.relative.as_deref().unwrap_or_default();
                let mark = if row.wide { " *" } else { "" };
                let _ = writeln!(out, "{min:<17} {max:<17} {width:>7}{mark}");
            }
            (_, _, reason) => {
                let _ = writeln!(out, "{}", reason.as_deref().unwrap_or("not enclosed"));
            }
        }
    }
    if rows.iter().any(|row| row.wide) {
        out += "\n  * wider than asked for: no narrower proof was found\n";
    }
    let _ = writeln!(out, "\n  {:.1} s", started.elapsed().as_secs_f64());
    out
}

fn shown(x: &Exact, toward: Toward) -> String {
    match x.as_rational() {
        Some(x) => rounded(x, 12 + GUARD_DIGITS, toward),
        None => x.to_string(),
    }
}
