//! Atlas files: a design some numbers of which are expressions with the names of parameters, the
//! parameters' ranges, and how the map of them is to be made.

use super::document::{Document, Names, Table, Value};
use super::error::{Defect, DesignError, ReadError};
use super::margin::without_margin;
use super::number::{exact, ordered};
use super::refusal::compiled;
use super::{exactly, mapped_claim, names, text_of, unit, Design};
use crate::exact::Exact;
use num_rational::BigRational;
use orthocert_kernel::atlas::Part;
use orthocert_kernel::claim::{self, AtlasClaim, MachineClaim};
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::vary::{Numbers as _, MOST_PARAMETERS};
use serde::{Deserialize, Serialize};
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// Most halvings of one parameter.
pub const MAX_RESOLUTION: i64 = 20;
/// Most boxes for one cell.
const MAX_BOXES: i64 = 100_000;
/// Most machines drawn on a map.
const MAX_MARKS: usize = 64;
/// Most digits of a number of an objective, whose own are fewer.
const MAX_DIGITS: usize = 4000;
/// Most characters of a label.
const MAX_LABEL: usize = 80;

const PARAMETER: &str = r#"{ min = "0.3", max = "0.8", label = "anchor radius / leg length" }"#;
const PARAMETERS: &str = "one to three parameters, such as radius = { min = 0.3, max = 0.8 }";
const OBJECTIVE: &str =
    r#"{ maximise = "an expression with parameters" }, or minimise, or "widest margin""#;
const MARKS: &str = r#"an array of { label = "my machine", ... } with a number for each parameter"#;

/// An atlas file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtlasDesign {
    /// The title that the file gives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// What is varied.
    pub parameters: Vec<Parameter>,
    /// What the axes of the map are called, one for each parameter.
    pub labels: Vec<String>,
    /// The claim about a design, with the names of parameters.
    pub machine: MachineClaim,
    /// Most halvings of each parameter's range.
    pub resolution: u32,
    /// Most boxes tried for a cell.
    pub boxes: usize,
    /// What the best design is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective: Option<Objective>,
    /// Machines to be shown on the map.
    pub marks: Vec<Mark>,
}

/// A parameter of an atlas: every real value from `min` to `max`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// How expressions call it.
    pub name: String,
    /// Least value, rational.
    pub min: Exact,
    /// Greatest value, rational and greater than the least.
    pub max: Exact,
}

impl Parameter {
    /// The value at a part of the range.
    pub fn at(&self, part: &BigRational) -> Option<Exact> {
        let (min, max) = (self.min.as_rational()?, self.max.as_rational()?);
        Some(Exact::Rational(min + (max - min) * part))
    }
}

/// What the best design is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Objective {
    /// The greatest value of an expression with the names of parameters.
    Maximise(Expression),
    /// The least value of one.
    Minimise(Expression),
    /// The widest margin ([`crate::search::solver::margin::tightened`]).
    WidestMargin,
}

/// A machine shown on the map.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    /// Its name.
    pub label: String,
    /// Its parameters.
    pub at: Vec<Exact>,
}

/// Whether a file is meant as an atlas: it has the tables that only atlases have.
///
/// # Errors
/// If it cannot be read.
pub fn is_atlas(path: &Path) -> Result<bool, ReadError> {
    let bytes = Design::bytes(path)?;
    let tables = DeTable::parse(text_of(&bytes, path)?);
    let has = |key| tables.as_ref().is_ok_and(|tables| tables.get_ref().contains_key(key));
    Ok(has("parameters") || has("atlas"))
}

impl AtlasDesign {
    /// Reads an atlas file.
    ///
    /// # Errors
    /// If the file cannot be read or is not one.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let bytes = Design::bytes(path)?;
        Ok(AtlasDesign::parse(text_of(&bytes, path)?, &path.to_string_lossy())?)
    }

    /// Reads the text of an atlas file; `file` is for messages only. The design is read at the
    /// vertices and the middle of the box of parameters, where all that is demanded of designs has
    /// to hold, and once more with the names kept.
    ///
    /// # Errors
    /// If it is not one; the message names line, key, what was found and what is accepted.
    pub fn parse(text: &str, file: &str) -> Result<Self, DesignError> {
        let document = Document { file, text, names: Names::None };
        let tree = DeTable::parse(text).map_err(|error| document.syntax_error(&error))?;
        let root = document.root(tree.get_ref());
        let keys =
            ["title", "unit", "parameters", "atlas", "mechanism", "workspace", "requirements"];
        root.only(&keys)?;
        unit(&root)?;
        let title = root.find("title").map(|title| title.text("a text in quotes")).transpose()?;
        let table = root.require(
            "parameters",
            "a table [parameters]; a design without one is for `orthocert verify`",
        )?;
        let (parameters, labels) = parameters(&table)?;
        let settings = root.require("atlas", "a table [atlas] with resolution and boxes")?;
        let settings = settings.table("a table [atlas]")?;
        settings.only(&["resolution", "boxes", "objective", "marks"])?;
        let resolution = whole(&settings, "resolution", MAX_RESOLUTION)?;
        let boxes = whole(&settings, "boxes", MAX_BOXES)?;
        let marks = match settings.find("marks") {
            Some(value) => marks(&value, &parameters)?,
            None => Vec::new(),
        };
        for values in probes(&parameters) {
            let document = Document { names: Names::Values(&values), ..document };
            let root = document.root(tree.get_ref());
            let mut claim = mapped_claim(&root)?;
            names::put(&mut claim, &values);
            compiled(&root, &claim)?;
        }
        let middle = at_part(&parameters, |_| 1);
        let document = Document { names: Names::Kept(&middle), ..document };
        let root = document.root(tree.get_ref());
        let machine = mapped_claim(&root)?;
        let objective = root.require("atlas", "")?.table("")?.find("objective");
        let objective = objective.map(|value| self::objective(&value, &machine)).transpose()?;
        let read = AtlasDesign {
            title: title.map(str::to_owned),
            parameters,
            labels,
            machine,
            resolution: u32::try_from(resolution).unwrap_or(0),
            boxes: usize::try_from(boxes).unwrap_or(0),
            objective,
            marks,
        };
        read.well_formed().map_err(|reason| {
            table.error(Defect::Claim, reason, "parameters that make designs everywhere")
        })?;
        Ok(read)
    }

    /// The claim, with shares to be stated.
    pub fn claim(&self) -> AtlasClaim {
        // Rational numbers of a design have a text.
        let written = |x: &Exact| exactly::written(x).unwrap_or(Expression::integer(0));
        let parameters = self.parameters.iter().map(|p| claim::Parameter {
            name: p.name.clone(),
            min: written(&p.min),
            max: written(&p.max),
        });
        AtlasClaim {
            parameters: parameters.collect(),
            machine: self.machine.clone(),
            certified: Expression::integer(0),
            refuted: Expression::integer(0),
        }
    }

    /// Demands parameters that are used, and lengths that are positive all over their box.
    ///
    /// # Errors
    /// A sentence.
    pub fn well_formed(&self) -> Result<(), String> {
        for Parameter { name, .. } in &self.parameters {
            if Exact::parse_open(name, 1) != Ok(Exact::Name(name.as_str().into())) {
                return Err(format!(
                    "the name {name:?}; a parameter's is a small letter, then small letters, \
                     digits and \"_\", not \"sqrt\""
                ));
            }
        }
        let claim = self.claim();
        claim.validate().map_err(|error| error.to_string())?;
        let mut machine = self.machine.clone();
        let mut used = Vec::new();
        for number in machine.numbers_mut() {
            names(number, &mut used);
        }
        if let Some(spare) = self.parameters.iter().find(|p| !used.contains(&p.name)) {
            return Err(format!("no number of the design depends on {}", spare.name));
        }
        let over = claim.over(&self.whole()).map_err(|error| error.to_string())?;
        match Problem::new(&over) {
            Err(ClaimError { place, expected: "greater than zero" }) => Err(format!(
                "{place}, which is not (provably) greater than zero for all values of the \
                 parameters: a cell may have a length of zero"
            )),
            // Of smaller cells more is provable.
            _ => Ok(()),
        }
    }

    /// The box of parameters as a cell.
    pub fn whole(&self) -> Part {
        vec![(0, 0); self.parameters.len()]
    }

    /// The names, with these values.
    fn named(&self, values: &[Exact]) -> Vec<(String, Exact)> {
        let names = self.parameters.iter().map(|parameter| parameter.name.clone());
        names.zip(values.iter().cloned()).collect()
    }

    /// The design at values of its parameters.
    pub fn at(&self, values: &[Exact]) -> MachineClaim {
        let mut claim = self.machine.clone();
        names::put(&mut claim, &self.named(values));
        claim
    }

    /// The value of an expression at values of the parameters, if it has one.
    pub fn value(&self, expression: &Expression, values: &[Exact]) -> Option<Exact> {
        let open = Exact::parse_open(&expression.to_string(), MAX_DIGITS).ok()?;
        names::value(&open, &self.named(values)).ok()
    }
}

/// Reads `[parameters]`.
fn parameters(value: &Value<'_>) -> Result<(Vec<Parameter>, Vec<String>), DesignError> {
    let table = value.table("a table [parameters]")?;
    let entries = table.entries();
    if entries.is_empty() || entries.len() > MOST_PARAMETERS {
        let found = format!("{} parameters", entries.len());
        return Err(value.error(Defect::OutOfDomain, found, PARAMETERS));
    }
    let mut parameters = Vec::new();
    let mut labels = Vec::new();
    for (name, entry) in entries {
        let range = entry.table(PARAMETER)?;
        range.only(&["min", "max", "label"])?;
        let (least, greatest) =
            (range.require("min", PARAMETER)?, range.require("max", PARAMETER)?);
        let (min, max) = (exact(&least)?, exact(&greatest)?);
        for (value, number) in [(&least, &min), (&greatest, &max)] {
            if number.as_rational().is_none() {
                let accepted = "a rational number: ranges of parameters are cut in equal parts";
                return Err(value.error(Defect::NotANumber, value.found(), accepted));
            }
        }
        ordered((&least, &min), (&greatest, &max))?;
        if min == max {
            let accepted = "a max greater than min: a range to be explored";
            return Err(greatest.error(Defect::Reversed, greatest.found(), accepted));
        }
        labels.push(match range.find("label") {
            Some(value) => label(&value)?,
            None => name.to_owned(),
        });
        parameters.push(Parameter { name: name.to_owned(), min, max });
    }
    Ok((parameters, labels))
}

fn label(value: &Value<'_>) -> Result<String, DesignError> {
    let accepted = "a text in quotes, of one line and at most 80 characters";
    let text = value.text(accepted)?;
    if text.chars().count() > MAX_LABEL || !super::is_line(text) {
        return Err(value.error(Defect::OutOfDomain, value.found(), accepted));
    }
    Ok(text.to_owned())
}

/// A whole number from 1 to `most`.
fn whole(table: &Table<'_>, key: &str, most: i64) -> Result<i64, DesignError> {
    let accepted = format!("a whole number from 1 to {most}");
    let value = table.require(key, &accepted)?;
    let number = match value.inner {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        _ => None,
    };
    number
        .filter(|n| (1..=most).contains(n))
        .ok_or_else(|| value.error(Defect::OutOfDomain, value.found(), accepted))
}

fn marks(value: &Value<'_>, parameters: &[Parameter]) -> Result<Vec<Mark>, DesignError> {
    let values = value.list(MARKS)?;
    if values.len() > MAX_MARKS {
        return Err(value.error(Defect::OutOfDomain, value.found(), "at most 64 marks"));
    }
    let mut keys = vec!["label"];
    keys.extend(parameters.iter().map(|parameter| parameter.name.as_str()));
    let mark = |value: &Value<'_>| {
        let table = value.table(MARKS)?;
        table.only(&keys)?;
        let at = parameters.iter().map(|p| exact(&table.require(&p.name, "a number")?));
        let at = at.collect::<Result<_, _>>()?;
        Ok(Mark { label: label(&table.require("label", "a text in quotes")?)?, at })
    };
    values.iter().map(mark).collect()
}

fn objective(value: &Value<'_>, design: &MachineClaim) -> Result<Objective, DesignError> {
    if let DeValue::String(text) = value.inner {
        if text != "widest margin" {
            return Err(value.error(Defect::WrongType, value.found(), OBJECTIVE));
        }
        return match without_margin(design) {
            None => Ok(Objective::WidestMargin),
            Some(why) => Err(value.error(
                Defect::Conflict,
                format!("{} of designs without margins: {why}", value.found()),
                "requirements whose bounds can be tightened",
            )),
        };
    }
    let table = value.table(OBJECTIVE)?;
    table.only(&["maximise", "minimise"])?;
    match (table.find("maximise"), table.find("minimise")) {
        (Some(expression), None) => Ok(Objective::Maximise(exactly::number(&expression)?)),
        (None, Some(expression)) => Ok(Objective::Minimise(exactly::number(&expression)?)),
        _ => Err(value.error(Defect::Conflict, value.found(), OBJECTIVE)),
    }
}

/// The values of the parameters at the vertices of their box and in its middle.
fn probes(parameters: &[Parameter]) -> Vec<Vec<(String, Exact)>> {
    let vertices = 0..1usize << parameters.len();
    let mut probes = vec![at_part(parameters, |_| 1)];
    probes.extend(vertices.map(|vertex| at_part(parameters, |i| 2 * (vertex >> i & 1))));
    probes
}

/// The values at `part(i)` halves of the range of parameter `i`.
fn at_part(parameters: &[Parameter], part: impl Fn(usize) -> usize) -> Vec<(String, Exact)> {
    let value = |(i, p): (usize, &Parameter)| {
        let value = match (part(i), p.min.as_rational(), p.max.as_rational()) {
            (1, Some(min), Some(max)) => Exact::Rational((min + max) / num_bigint::BigInt::from(2)),
            (0, ..) => p.min.clone(),
            _ => p.max.clone(),
        };
        (p.name.clone(), value)
    };
    parameters.iter().enumerate().map(value).collect()
}

/// Adds the names in an expression.
fn names(x: &Expression, used: &mut Vec<String>) {
    if let Expression::Name(name) = x {
        used.push(name.clone());
    }
    x.parts().for_each(|part| names(part, used));
}
