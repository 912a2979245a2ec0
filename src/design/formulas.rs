//! `kind = "formulas"`: a mechanism by its inverse kinematics.

use super::document::{Table, Value};
use super::error::{Defect, DesignError};
use super::exactly;
use super::expression::{enclosed, formula, misnamed, Known, Meaning};
use super::mechanism::MOST_LEGS;
use orthocert_kernel::claim::{Formulas, JointFormula, Quantity};
use orthocert_kernel::number::Expression;
use toml::de::DeValue;

const COORDINATES: &str = r#"["x", "y"]: one to six names"#;
const JOINTS: &str =
    "[[mechanism.joints]] tables with rho or row, as many as coordinates, or more, up to twelve";
const PARAMETERS: &str =
    r#"a table [mechanism.parameters] of numbers and tolerances: l = "200 ± 0.05""#;
const DEFINITIONS: &str = r#"a table [mechanism.definitions] of formulas: s = "sqrt(l^2 - y^2)""#;
const FORMULA: &str = r#"a formula in quotes, such as "x - sqrt(l^2 - y^2)""#;
const JOINT: &str = r#"rho = "a formula", or row = ["...", "..."], the row of M"#;

/// The keys of `[mechanism]`.
pub(super) const KEYS: &[&str] = &["kind", "coordinates", "parameters", "definitions", "joints"];

/// Reads them.
pub(super) fn formulas(table: &Table<'_>) -> Result<Formulas, DesignError> {
    let mut known = Known::default();
    let values = table.values();
    for (name, x) in values {
        let expression = exactly::written(x);
        let interval = expression.and_then(|x| enclosed(&x, &x, &[]));
        known.names.extend(interval.map(|x| (name.clone(), Meaning::Constant(x))));
    }
    let coordinates = coordinates(table, &mut known)?;
    let (parameters, given) = parameters(table, &mut known)?;
    let (definitions, defined) = definitions(table, &mut known)?;
    let joints = joints(table, coordinates.len(), &mut known)?;
    for value in given.iter().chain(&defined) {
        let name = value.key.rsplit('.').next().unwrap_or_default();
        if !known.used.contains(name) {
            let found = format!("{}, which no joint depends on", value.found());
            let accepted = "names that formulas use";
            return Err(value.error(Defect::Conflict, found, accepted));
        }
    }
    Ok(Formulas { coordinates, parameters, definitions, joints })
}

/// Refuses a name that cannot be one, or that something else has.
fn named(value: &Value<'_>, name: &str, known: &Known) -> Result<(), DesignError> {
    if let Some(accepted) = misnamed(name) {
        let found = format!("the name {name}");
        return Err(value.error(Defect::UnknownWord, found, accepted));
    }
    if known.names.iter().any(|(other, _)| other == name) {
        let found = format!("the name {name} once more");
        let accepted = "names of coordinates, parameters and definitions that differ";
        return Err(value.error(Defect::Conflict, found, accepted));
    }
    Ok(())
}

fn coordinates(table: &Table<'_>, known: &mut Known) -> Result<Vec<String>, DesignError> {
    let value = table.require("coordinates", COORDINATES)?;
    let values = value.list(COORDINATES)?;
    if !(1..=6).contains(&values.len()) {
        return Err(value.wrong_type(COORDINATES));
    }
    let mut coordinates = Vec::new();
    for value in values {
        let name = value.text("a name in quotes")?;
        named(&value, name, known)?;
        known.names.push((name.to_owned(), Meaning::Varying));
        coordinates.push(name.to_owned());
    }
    Ok(coordinates)
}

type Named<'a, T> = (Vec<(String, T)>, Vec<Value<'a>>);

/// The parameters in the order of their names: a table of TOML has no other.
fn parameters<'a>(
    table: &Table<'a>,
    known: &mut Known,
) -> Result<Named<'a, Quantity>, DesignError> {
    let Some(value) = table.find("parameters") else {
        return Ok((Vec::new(), Vec::new()));
    };
    let (mut parameters, mut values) = (Vec::new(), Vec::new());
    for (name, value) in value.table(PARAMETERS)?.entries() {
        named(&value, name, known)?;
        let quantity = exactly::quantity(&value)?;
        let [min, max] = quantity.ends();
        let Some(interval) = enclosed(min, max, value.document.values()) else {
            let accepted = "a number of moderate size";
            return Err(value.error(Defect::NotANumber, value.found(), accepted));
        };
        known.names.push((name.to_owned(), Meaning::Constant(interval)));
        parameters.push((name.to_owned(), quantity));
        values.push(value);
    }
    parameters.sort_by(|(a, _), (b, _)| a.cmp(b));
    Ok((parameters, values))
}

/// The definitions in the order of the file, each in what stands before it.
fn definitions<'a>(
    table: &Table<'a>,
    known: &mut Known,
) -> Result<Named<'a, Expression>, DesignError> {
    let Some(value) = table.find("definitions") else {
        return Ok((Vec::new(), Vec::new()));
    };
    let entries = value.table(DEFINITIONS)?.entries();
    known.later = entries.iter().map(|(name, _)| (*name).to_owned()).collect();
    let (mut definitions, mut values) = (Vec::new(), Vec::new());
    for (name, value) in entries {
        named(&value, name, known)?;
        let (expression, meaning) = read(&value, known)?;
        known.names.push((name.to_owned(), meaning));
        definitions.push((name.to_owned(), expression));
        values.push(value);
    }
    Ok((definitions, values))
}

fn joints(
    table: &Table<'_>,
    coordinates: usize,
    known: &mut Known,
) -> Result<Vec<JointFormula>, DesignError> {
    let value = table.require("joints", JOINTS)?;
    let values = value.list(JOINTS)?;
    if !(coordinates..=MOST_LEGS).contains(&values.len()) {
        let found = format!("{} joints of {coordinates} coordinates", values.len());
        return Err(value.error(Defect::WrongType, found, JOINTS));
    }
    let joint = |value: &Value<'_>| {
        let table = value.table("a [[mechanism.joints]] table")?;
        table.only(&["rho", "row"])?;
        match (table.find("rho"), table.find("row")) {
            (Some(rho), None) => Ok(JointFormula::Rho(read(&rho, known)?.0)),
            (None, Some(row)) => {
                let accepted = format!("{coordinates} formulas, one a coordinate");
                let entries = row.list(&accepted)?;
                if entries.len() != coordinates {
                    return Err(row.wrong_type(&accepted));
                }
                let entries = entries.iter().map(|entry| Ok(read(entry, known)?.0));
                Ok(JointFormula::Row(entries.collect::<Result<_, _>>()?))
            }
            (Some(_), Some(row)) => Err(row.error(Defect::Conflict, "a row, next to rho", JOINT)),
            (None, None) => Err(table.lacks("rho", JOINT)),
        }
    };
    values.iter().map(joint).collect()
}

/// A formula, or a plain number.
fn read(value: &Value<'_>, known: &mut Known) -> Result<(Expression, Meaning), DesignError> {
    let text = match value.inner {
        DeValue::String(text) => text,
        DeValue::Integer(_) | DeValue::Float(_) => {
            let number = exactly::number(value)?;
            let interval = enclosed(&number, &number, &[]);
            let too_large = || value.error(Defect::NotANumber, value.found(), "a moderate number");
            return Ok((number, Meaning::Constant(interval.ok_or_else(too_large)?)));
        }
        _ => return Err(value.wrong_type(FORMULA)),
    };
    match formula(text, known) {
        Ok(formula) => Ok((formula.expression, formula.meaning)),
        Err(error) => {
            let at = value.place(text, error.at);
            let about = (value.key.as_str(), error.defect);
            Err(value.document.error(at, about, error.found, error.accepted))
        }
    }
}
