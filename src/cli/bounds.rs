//! `orthocert bounds`.

use super::certify::{self, Unwritten};
use super::{effort, input, interrupt, print, Failure, Format, Status};
use crate::design::Design;
use crate::exact::decimal::{approximate, outward, rounded, Toward};
use crate::exact::Exact;
use crate::files::output;
use crate::report::text::{duration, wrap, WIDTH};
use crate::report::{exactly, placed, point_text, pose_text, CertificateFile};
use crate::search::solver::enclose::{enclose, is_singular, loosest, Enclosed, NotEnclosed};
use crate::search::solver::extremes::{of_cube, Extreme};
use crate::search::solver::sector::{self, Sector};
use crate::search::solver::value::{coordinates, in_length, in_words, listed, with_unit};
use crate::search::Budget;
use num_rational::BigRational;
use num_traits::Signed;
use orthocert_checker::certificate::{Certificate, Proof};
use orthocert_kernel::claim::{self as kernel, Requirement};
use orthocert_kernel::machine::{Joint, Leg};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

/// Significant digits of ends: two more than the narrowest width leaves certain.
const DIGITS: u32 = 14;
/// Significant digits of places.
const PLACE_DIGITS: u32 = 6;

/// Boxes after which a width is given up for a looser one: what closes at all mostly closes in a
/// few hundred; the condition number of the rotary Delta takes 40,000. A third of that for each coordinate
/// of orientation.
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
    /// What it is for.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    given: BTreeMap<String, Vec<String>>,
    /// Whether the design says so; a unit of each, if not.
    #[serde(skip)]
    is_asked: bool,
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
    #[serde(skip)]
    unwritten: Unwritten,
}

/// Runs it.
pub fn run(arguments: &Arguments) -> Result<Status, Failure> {
    let started = Instant::now();
    let effort = &arguments.effort;
    let relative = relative(&arguments.relative)?;
    let design = input::design(arguments.design.as_deref(), effort.quiet)?;
    if let Some(folder) = &arguments.output {
        output::probe(&folder.join("bounds.cert.json"))?;
        arguments.design.as_deref().map_or(Ok(()), |design| input::apart_in(folder, design))?;
    }
    effort.start_threads()?;
    let claim = &design.claim;
    let budget = effort.budget_or(effort::boxes_of(claim, BOXES), started)?;
    interrupt::grant();
    let rows = rows(claim, &relative, arguments, budget)?;
    match effort.format {
        Format::Json => {
            let mut answer = serde_json::json!({ "bounds": rows });
            if let Some(unit) = design.unit {
                answer["length_unit"] = unit.into();
            }
            if interrupt::is_cancelled() {
                answer["interrupted"] = true.into();
            }
            print::json(&answer)?;
        }
        Format::Text => print::answer(&text(&rows, &design, &relative, effort.quiet, started))?,
    }
    let complete = rows.iter().all(|row| row.not_enclosed.is_none());
    let status = if complete { Status::Done } else { Status::Undecided };
    rows.into_iter().try_for_each(|row| row.unwritten.told())?;
    interrupt::unless_cancelled(status)
}

/// What is enclosed in one search.
enum Question {
    Extreme(Box<Extreme>),
    /// The least and the greatest angle of an arm of this leg.
    Angle(usize),
}

fn rows(
    claim: &kernel::MachineClaim,
    relative: &BigRational,
    arguments: &Arguments,
    budget: Budget,
) -> Result<Vec<Row>, Failure> {
    let problem = Problem::new(claim).map_err(Failure::input)?;
    let angular = problem.legs.iter().any(Leg::is_angular);
    let extremes = Extreme::of(claim, problem.legs.len()).into_iter();
    let turning = problem.legs.iter().enumerate();
    let turning = turning.filter(|(_, leg)| matches!(leg.rho, Some(Joint::Angle { .. })));
    let questions = extremes.map(|extreme| Question::Extreme(Box::new(extreme)));
    let questions: Vec<Question> =
        questions.chain(turning.map(|(leg, _)| Question::Angle(leg))).collect();
    let mut bar = arguments.effort.bar();
    let singular = bar
        .run("singularities", questions.len() + 1, |control| is_singular(claim, budget, control))
        .map_err(|error| match error {
            NotEnclosed::Cancelled => Failure::Interrupted,
            error => Failure::input(error),
        })?;
    let name = |(number, question): (usize, &Question)| {
        let of = match question {
            Question::Extreme(extreme) => {
                let row = Row::of(claim, extreme, angular);
                format!("{} {}", row.end, in_words(&row.quantity))
            }
            Question::Angle(leg) => format!("rho_{}", leg + 1),
        };
        format!("{} of {}, {of}", number + 1, questions.len())
    };
    let names: Vec<String> = questions.iter().enumerate().map(name).collect();
    let possible = || match (singular, interrupt::is_cancelled()) {
        (true, _) => Err(NotEnclosed::Singular),
        (false, true) => Err(NotEnclosed::Cancelled),
        (false, false) => Ok(()),
    };
    let found = bar.at_once(&names, 0, |number, turns, control| {
        let budget = budget.shared(turns);
        match &questions[number] {
            Question::Extreme(extreme) => {
                let found =
                    possible().and_then(|()| enclose(claim, extreme, relative, budget, control));
                let row = Row::of(claim, extreme, angular);
                Ok(vec![row.found(&extreme.file_stem(), found, relative, arguments)?])
            }
            Question::Angle(leg) => {
                let found = possible()
                    .and_then(|()| sector::enclose(claim, *leg, relative, budget, control));
                of_angle(*leg, &found, relative, arguments)
            }
        }
    });
    let mut rows = exact_rows(claim);
    for found in found {
        rows.extend(found?);
    }
    Ok(rows)
}

/// Both rows of an arm's angle.
fn of_angle(
    leg: usize,
    found: &Result<Sector, NotEnclosed>,
    relative: &BigRational,
    arguments: &Arguments,
) -> Result<Vec<Row>, Failure> {
    let row = |(side, greatest): (usize, bool)| {
        let mut row = Row::new(format!("rho_{}", leg + 1), Some("deg"), greatest);
        let Sector { certified, certificate, reached, width } = match found {
            Ok(found) => found,
            Err(error) => return row.fails(error.clone()),
        };
        let Some((inner, refuted)) = &reached[side] else {
            return row.fails(NotEnclosed::Undecided);
        };
        row.enclosed((width.clone(), inner.clone(), certified[side].clone()), relative);
        let stem = format!("rho-{}-{}", leg + 1, row.end);
        row.store(arguments, &stem, (Some(&**refuted), &**certificate))?;
        Ok(row)
    };
    [false, true].into_iter().enumerate().map(row).collect()
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
            given: BTreeMap::new(),
            is_asked: true,
            min: None,
            max: None,
            point: None,
            relative: None,
            wide: false,
            not_enclosed: None,
            certificates: Vec::new(),
            unwritten: Unwritten::default(),
        }
    }

    /// Of this extreme of a claim.
    fn of(claim: &kernel::MachineClaim, extreme: &Extreme, angular: bool) -> Self {
        let own = &extreme.bounded().requirement;
        let texts = |(name, all): (&String, &Vec<Expression>)| {
            (name.clone(), all.iter().map(Expression::to_string).collect())
        };
        let given = own.given.iter().map(texts).collect();
        let same = |one: &Requirement| own.quantity == one.quantity && own.given == one.given;
        let is_asked = own.given.is_empty() || claim.require.iter().any(same);
        let row = Row::new(extreme.quantity(), extreme.unit(angular), extreme.is_greatest());
        Row { given, is_asked, ..row }
    }

    /// With what was found of it.
    fn found(
        mut self,
        stem: &str,
        found: Result<Enclosed, NotEnclosed>,
        relative: &BigRational,
        arguments: &Arguments,
    ) -> Result<Self, Failure> {
        match found {
            Ok(Enclosed { width, inner, outer, refuted, certified, .. }) => {
                self.enclosed((width, inner, outer), relative);
                self.store(arguments, stem, (refuted.as_deref(), &*certified))?;
                Ok(self)
            }
            Err(error) => self.fails(error),
        }
    }

    /// Between a refuted bound and a certified one.
    fn enclosed(
        &mut self,
        (width, inner, outer): (BigRational, BigRational, BigRational),
        asked: &BigRational,
    ) {
        let [inner, outer] = [inner, outer].map(Exact::Rational);
        self.wide = width > *asked;
        self.relative = Some(rounded(&width, 2, Toward::Above));
        let (min, max) = if self.end == "greatest" { (inner, outer) } else { (outer, inner) };
        (self.min, self.max) = (Some(min), Some(max));
    }

    /// Not enclosed. What was found before an interruption is told.
    fn fails(self, error: NotEnclosed) -> Result<Self, Failure> {
        match error {
            NotEnclosed::Claim(_) => Err(Failure::input(error)),
            error => Ok(Row { not_enclosed: Some(error.to_string()), ..self }),
        }
    }

    /// Writes the certificates, if they are asked for; the point is that of the refutation.
    fn store(
        &mut self,
        arguments: &Arguments,
        stem: &str,
        (refuted, certified): (Option<&Certificate>, &Certificate),
    ) -> Result<(), Failure> {
        self.point = refuted.and_then(witness_point);
        let Some(folder) = &arguments.output else { return Ok(()) };
        let inner = refuted.into_iter().map(|certificate| (certificate, "inner"));
        for (certificate, side) in inner.chain([(certified, "outer")]) {
            let text = certificate.to_text().map_err(|_| Failure::Defect)?;
            let path = folder.join(format!("{stem}-{side}.cert.json"));
            let stored = certify::store(Some(folder), &path, &text);
            self.certificates.extend(self.unwritten.unless(stored));
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

/// A line of the table: rows that say the same, each with its name.
struct Line<'a> {
    names: Vec<&'a str>,
    row: &'a Row,
    from: String,
    to: String,
}

/// The lines: joints with the same ends share one.
fn lines(rows: &[Row]) -> Vec<Line<'_>> {
    let mut lines: Vec<Line<'_>> = Vec::new();
    for row in rows {
        let end = |x: &Option<Exact>, toward| x.as_ref().map(|x| outward(x, DIGITS, toward));
        let from = end(&row.min, Toward::Below).unwrap_or_default();
        let to = end(&row.max, Toward::Above).unwrap_or_default();
        let same = |line: &&mut Line<'_>| {
            let own = (&line.from, &line.to, line.row.end, line.row.unit);
            own == (&from, &to, row.end, row.unit) && !from.is_empty() && row.unit.is_some()
        };
        match lines.iter_mut().find(same) {
            Some(line) => line.names.push(&row.quantity),
            None => lines.push(Line { names: vec![&row.quantity], row, from, to }),
        }
    }
    lines
}

/// The table, where each extreme is reached, and what its columns are.
fn text(
    rows: &[Row],
    design: &Design,
    asked: &BigRational,
    quiet: bool,
    started: Instant,
) -> String {
    let coordinates = coordinates(&design.claim);
    let lines = lines(rows);
    let name = |line: &Line<'_>| {
        let name = listed(&line.names.iter().copied().map(in_words).collect::<Vec<_>>());
        let name = with_unit(&name, line.row.unit);
        in_length(&name, line.row.unit, design.unit)
    };
    let names: Vec<String> = lines.iter().map(name).collect();
    let width = |title: &str, texts: &mut dyn Iterator<Item = &str>| {
        texts.map(|text| text.chars().count()).max().unwrap_or(0).max(title.len())
    };
    let first = width("quantity", &mut names.iter().map(String::as_str));
    let second = width("from", &mut lines.iter().map(|line| line.from.as_str()));
    let third = width("to", &mut lines.iter().map(|line| line.to.as_str()));
    let mut out = String::new();
    let mut line = |[name, extreme, from, to, at]: [&str; 5], wide: Option<&str>| {
        let mut values = format!("  {name:first$}  {extreme:8}  {from:second$}  {to:third$}");
        if let Some(width) = wide {
            let _ = write!(values, "  * width {width}");
        }
        let text = match values.chars().count() + 2 + at.chars().count() {
            0..=WIDTH => format!("{values}  {at}"),
            _ if at.is_empty() => values,
            _ => {
                let mut place = String::new();
                wrap(&mut place, &placed(at), 6);
                format!("{}\n{}", values.trim_end(), place.trim_end())
            }
        };
        let _ = writeln!(out, "{}", text.trim_end());
    };
    if !quiet {
        line(["quantity", "extreme", "from", "to", "at"], None);
    }
    for (own, name) in lines.iter().zip(&names) {
        let row = own.row;
        if let Some(reason) = &row.not_enclosed {
            line([name, row.end, reason, "", ""], None);
            continue;
        }
        let point = row.point.iter().flatten().map(approximate).collect::<Option<Vec<f64>>>();
        let point = point.filter(|point| !point.is_empty() && !quiet);
        let at = point.map_or_else(String::new, |point| match design.claim.orientation.is_some() {
            true => pose_text(&point, &coordinates, PLACE_DIGITS),
            false => point_text(&point, PLACE_DIGITS),
        });
        let wide = row.relative.as_deref().filter(|_| row.wide);
        line([name, row.end, &own.from, &own.to, &at], wide);
    }
    if interrupt::is_cancelled() {
        let _ = writeln!(out, "\n  {}", interrupt::PARTIAL);
    }
    if quiet {
        return out;
    }
    out.push('\n');
    if rows.iter().any(|row| row.not_enclosed.is_none()) {
        let asked = rounded(asked, 2, Toward::Above);
        let text = format!(
            "An extreme lies between its two decimals, relatively {asked} apart or less where no width \
             is named: one is refuted, as a bound, at the place named, the other is certified."
        );
        wrap(&mut out, &text, 2);
    }
    // The joint speed of a unit of tool speed says so in its name.
    let of_units = |row: &&Row| !row.is_asked && row.unit.is_some() && row.not_enclosed.is_none();
    let said = |(name, text): (&str, &'static str)| {
        rows.iter().filter(of_units).any(|row| row.given.contains_key(name)).then_some(text)
    };
    let units = [
        ("joint", "stiffness is of joints with a stiffness of 1 each"),
        ("tool", "joint force is that of a tool force of 1"),
    ];
    let units: Vec<&str> = units.into_iter().filter_map(said).collect();
    if !units.is_empty() {
        wrap(&mut out, &format!("Of what the design does not name: {}.", listed(&units)), 2);
    }
    if rows.iter().any(|row| row.wide) {
        wrap(&mut out, "* wider than asked for: no narrower proof was found", 2);
    }
    let _ = writeln!(out, "\n  {}", duration(started.elapsed().as_secs_f64()));
    out
}
