//! One number of a design file, by its key, and the file with another number in its place.
//!
//! A key is a path of names and of positions in arrays, counted from 0, with dots between them:
//! `workspace.max.0`. `*` stands for every element of an array: `mechanism.legs.*.length` is one
//! number that several legs have in common. All of the file but the number stays as it is, byte by
//! byte. Of a tolerance it is the middle that changes.

use super::document::{Document, Names, Table, Value};
use super::error::{Defect, DesignError};
use super::number::{centred, quantity};
use super::suggestion;
use crate::exact::decimal::{exact, terminating};
use crate::exact::Exact;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// Fractional bits of a number's size.
const SIZE_BITS: u32 = 128;
/// Most decimal places of a number that is put into a file.
const MOST_PLACES: u32 = 1000;
/// Every element of an array.
const EVERY: &str = "*";

/// A number of a design file.
#[derive(Clone, Debug)]
pub struct Variable<'a> {
    text: &'a str,
    /// Where it stands, in the order of the text.
    places: Vec<Range<usize>>,
    own: Exact,
    tolerance: Option<String>,
    size: BigRational,
}

impl<'a> Variable<'a> {
    /// The number at `key` of a design file's text; `file` is for messages only.
    ///
    /// # Errors
    /// If there is no number at that key; the message names what there is, and the nearest key.
    pub fn find(text: &'a str, file: &str, key: &str) -> Result<Self, DesignError> {
        let document = Document { file, text, names: Names::None };
        let tree = DeTable::parse(text).map_err(|error| document.syntax_error(&error))?;
        let root = document.root(tree.get_ref());
        let walk = Walk { key, root: &root };
        let names: Vec<&str> = key.split('.').collect();
        let found = walk.in_table(&root, "", &names)?;
        let (first, rest) = found.split_first().ok_or_else(|| root.lacks(key, "a number's key"))?;
        let (own, tolerance) = walk.number(first)?;
        for other in rest {
            walk.number(other)?;
            if quantity(other)? != quantity(first)? {
                let found = format!("{}, but {} at {}", other.found(), first.found(), first.key);
                let accepted = "the same number in every element, or the key of one of them";
                return Err(other.error(Defect::Conflict, found, accepted));
            }
        }
        let mut places: Vec<Range<usize>> = found.iter().map(|value| value.at.clone()).collect();
        places.sort_by_key(|at| at.start);
        let size = size_of(&own, &root, key);
        Ok(Variable { text, places, own, tolerance, size })
    }

    /// Every number of a design file's text with its key, in the order of the text; where the same
    /// number stands in all tables of an array, that of all of them. `file` is for messages only.
    ///
    /// # Errors
    /// If the text is not TOML.
    pub fn all(text: &'a str, file: &str) -> Result<Vec<(String, Self)>, DesignError> {
        let document = Document { file, text, names: Names::None };
        let tree = DeTable::parse(text).map_err(|error| document.syntax_error(&error))?;
        let root = document.root(tree.get_ref());
        let found = every(&root);
        let groups = alike(&found);
        let variable = |key: &str, number: &Found, places| {
            let (own, tolerance) = number.number.clone();
            let size = size_of(&own, &root, key);
            (key.to_owned(), Variable { text, places, own, tolerance, size })
        };
        // Of numbers that are one, the first is listed.
        let listed = found.iter().filter_map(|number| match number.group(&groups) {
            None => Some(variable(&number.key, number, vec![number.at.clone()])),
            Some((key, all)) if all.first().is_some_and(|first| first.at == number.at) => {
                Some(variable(key, number, all.iter().map(|one| one.at.clone()).collect()))
            }
            Some(_) => None,
        });
        Ok(listed.collect())
    }

    /// Where it stands in the text, in bytes.
    pub fn places(&self) -> &[Range<usize>] {
        &self.places
    }

    /// The number in the file: of a tolerance the middle.
    pub fn own(&self) -> &Exact {
        &self.own
    }

    /// What stands after `±`, as in the file.
    pub fn tolerance(&self) -> Option<&str> {
        self.tolerance.as_deref()
    }

    /// A size to measure changes by, not zero: the number's, or, where that is zero, that of the
    /// largest number beside it.
    pub fn size(&self) -> &BigRational {
        &self.size
    }

    /// The file with another number.
    pub fn with(&self, value: &BigRational) -> String {
        let number = terminating(value, MOST_PLACES).unwrap_or_else(|| format!("({value})"));
        let number = match &self.tolerance {
            Some(tolerance) => format!("\"{number} ± {tolerance}\""),
            None => format!("\"{number}\""),
        };
        let (mut text, mut done) = (String::new(), 0);
        for Range { start, end } in self.places.iter().cloned() {
            text.push_str(self.text.get(done..start).unwrap_or_default());
            text.push_str(&number);
            done = end;
        }
        text.push_str(self.text.get(done..).unwrap_or_default());
        text
    }
}

/// A key that is being looked up.
struct Walk<'w, 'd> {
    key: &'w str,
    root: &'w Table<'d>,
}

impl<'d> Walk<'_, 'd> {
    /// The values at the rest of a path.
    fn in_table(
        &self,
        table: &Table<'d>,
        path: &str,
        rest: &[&str],
    ) -> Result<Vec<Value<'d>>, DesignError> {
        let Some((name, rest)) = rest.split_first() else {
            return Err(table.lacks("", "the key of a number"));
        };
        let Some(value) = table.find(name) else {
            let there: Vec<String> =
                table.entries().iter().map(|(name, _)| dotted(path, name)).collect();
            return Err(table.lacks(name, self.accepted(&there)));
        };
        self.in_value(value, &dotted(path, name), rest)
    }

    fn in_value(
        &self,
        value: Value<'d>,
        path: &str,
        rest: &[&str],
    ) -> Result<Vec<Value<'d>>, DesignError> {
        let Some((name, further)) = rest.split_first() else {
            return Ok(vec![value]);
        };
        match value.inner {
            DeValue::Table(_) => self.in_table(&value.table("a table")?, path, rest),
            DeValue::Array(_) => {
                let all = value.list("an array")?;
                let one = name.parse::<usize>().ok().filter(|i| i.to_string() == **name);
                let chosen = |i: usize| *name == EVERY || one == Some(i);
                if !(0..all.len()).any(chosen) {
                    let found = format!("{}, and none at {name}", value.found());
                    let there = elements(path, all.len());
                    return Err(value.error(Defect::UnknownKey, found, self.accepted(&there)));
                }
                let all = all.into_iter().enumerate().filter(|(i, _)| chosen(*i));
                let below =
                    all.map(|(i, v)| self.in_value(v, &dotted(path, &i.to_string()), further));
                Ok(below.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
            }
            _ => {
                let found = format!("{}, which has no {name}", value.found());
                let there = [path.to_owned()];
                Err(value.error(Defect::UnknownKey, found, self.accepted(&there)))
            }
        }
    }

    /// The middle of the number or tolerance that a value is.
    fn number(&self, value: &Value<'d>) -> Result<(Exact, Option<String>), DesignError> {
        let there = match value.inner {
            DeValue::Array(all) => elements(self.key, all.len()),
            DeValue::Table(entries) if !is_tolerance(self.key, entries) => {
                let entries = value.table("a table")?.entries();
                entries.iter().map(|(name, _)| dotted(self.key, name)).collect()
            }
            DeValue::Table(_) if !is_inline(value) => {
                let found = "a tolerance that is not written in one pair of braces";
                let accepted = "{ min = 310.2, max = 310.3 }, or the key of one of its ends";
                return Err(value.error(Defect::WrongType, found, accepted));
            }
            _ => return centred(value),
        };
        Err(value.error(Defect::WrongType, value.found(), self.accepted(&there)))
    }

    /// The number next to a key: by its own name, in the same table, or else by the whole key; of a table,
    /// whose keys are told, none.
    fn beside(key: &str, all: &[&str]) -> String {
        if all.iter().any(|other| other.strip_prefix(key).is_some_and(|rest| rest.starts_with('.')))
        {
            return String::new();
        }
        let (table, name) = key.rsplit_once('.').unwrap_or(("", key));
        let names = all.iter().filter_map(|other| other.strip_prefix(table)?.strip_prefix('.'));
        let own: Vec<&str> = names.filter(|own| !own.contains('.')).collect();
        match suggestion::hint(name, &own, |name| dotted(table, name)) {
            none if none.is_empty() => suggestion::hint(key, all, |key| key.to_owned()),
            hint => hint,
        }
    }

    /// What there is, and the nearest key of a number.
    fn accepted(&self, there: &[String]) -> String {
        let found = every(self.root);
        let groups = alike(&found);
        // A number that all legs have is meant before one leg's.
        let one = found.iter().filter_map(|number| Some(number.group(&groups)?.0));
        let all: Vec<&str> = one.chain(found.iter().map(|number| number.key.as_str())).collect();
        // Without the tables that it is in, a key is meant as well as a misspelt one.
        let key = without_brackets(self.key);
        let end = format!(".{key}");
        let meant = |other: &&&str| {
            let other = other.replace(".*", "");
            other == key || other.ends_with(&end)
        };
        let hint = match all.iter().find(meant) {
            Some(key) => format!("; did you mean {key}?"),
            None => Self::beside(&key, &all),
        };
        format!("the key of a number; there is {}{hint}", there.join(", "))
    }
}

fn dotted(path: &str, name: &str) -> String {
    match path {
        "" => name.to_owned(),
        _ => format!("{path}.{name}"),
    }
}

/// A key with `[i]` written with `.i`.
fn without_brackets(key: &str) -> String {
    key.replace('[', ".").replace(']', "")
}

/// The keys of an array's elements.
fn elements(path: &str, length: usize) -> Vec<String> {
    match length {
        0 => vec!["nothing in it".to_owned()],
        1..=3 => (0..length).map(|i| dotted(path, &i.to_string())).collect(),
        _ => vec![format!("{path}.0 to {path}.{}", length - 1)],
    }
}

/// Whether a table is a tolerance: parameters of a mechanism have them.
fn is_tolerance(key: &str, entries: &DeTable<'_>) -> bool {
    let ends = ["min", "max"].iter().all(|end| entries.contains_key(*end));
    key.starts_with("mechanism.") && ends && entries.len() == 2
}

fn is_inline(value: &Value<'_>) -> bool {
    let written = value.document.text.get(value.at.clone()).unwrap_or_default();
    written.starts_with('{') && written.ends_with('}')
}

/// A number that was found.
struct Found {
    key: String,
    /// Its key with `*` for the outermost array of tables that it is in, and how many those are.
    common: Option<(String, usize)>,
    at: Range<usize>,
    /// The number, of a tolerance the middle, and what stands after `±`.
    number: (Exact, Option<String>),
}

impl Found {
    /// The numbers that it is one with, and their key, where all tables have the same.
    fn group<'a>(
        &'a self,
        groups: &'a BTreeMap<&str, Vec<&'a Found>>,
    ) -> Option<(&'a str, &'a [&'a Found])> {
        let (key, count) = self.common.as_ref()?;
        let all = groups.get(key.as_str())?;
        let one = all.len() == *count && all.iter().all(|other| other.number == self.number);
        one.then_some((key, all))
    }
}

/// All numbers of a file, in the order of the text.
fn every(root: &Table<'_>) -> Vec<Found> {
    let mut found = Vec::new();
    for (name, value) in root.entries() {
        numbers(&value, (name.to_owned(), None), &mut found);
    }
    found
}

/// Numbers by what is their key in all tables of an array.
fn alike(found: &[Found]) -> BTreeMap<&str, Vec<&Found>> {
    let mut groups: BTreeMap<&str, Vec<&Found>> = BTreeMap::new();
    for number in found {
        if let Some((key, _)) = &number.common {
            groups.entry(key).or_default().push(number);
        }
    }
    groups
}

/// All numbers below a value. The parser bounds the nesting, and with it this recursion.
fn numbers(
    value: &Value<'_>,
    (key, common): (String, Option<(String, usize)>),
    found: &mut Vec<Found>,
) {
    let below = |name: &str| {
        let common = common.as_ref().map(|(key, count)| (dotted(key, name), *count));
        (dotted(&key, name), common)
    };
    match value.inner {
        DeValue::Table(_) => {
            for (name, value) in value.table("").map(|table| table.entries()).unwrap_or_default() {
                numbers(&value, below(name), found);
            }
        }
        DeValue::Array(_) => {
            let all = value.list("").unwrap_or_default();
            let count = all.len();
            for (i, value) in all.iter().enumerate() {
                let (own, mut common) = below(&i.to_string());
                if common.is_none() && matches!(value.inner, DeValue::Table(_)) {
                    common = Some((dotted(&key, EVERY), count));
                }
                numbers(value, (own, common), found);
            }
        }
        _ => {
            if let Ok(number) = centred(value) {
                found.push(Found { key, common, at: value.at.clone(), number });
            }
        }
    }
}

/// A size to measure changes of a number by.
fn size_of(own: &Exact, root: &Table<'_>, key: &str) -> BigRational {
    let names: Vec<&str> = key.split('.').collect();
    let size = size(own).filter(|size| !size.is_zero());
    size.or_else(|| around(root, &names)).unwrap_or_else(BigRational::one)
}

/// The size of the largest number in the innermost array or table about a key that has one other
/// than zero.
fn around(root: &Table<'_>, names: &[&str]) -> Option<BigRational> {
    (0..names.len()).rev().find_map(|depth| {
        let (first, rest) = names.get(..depth)?.split_first()?;
        let mut value = root.find(first)?;
        for name in rest {
            value = match value.inner {
                DeValue::Array(_) => {
                    let i = if *name == EVERY { 0 } else { name.parse().ok()? };
                    value.list("").ok()?.into_iter().nth(i)?
                }
                _ => value.table("").ok()?.find(name)?,
            };
        }
        largest(&value)
    })
}

fn largest(value: &Value<'_>) -> Option<BigRational> {
    let within: Vec<Value<'_>> = match value.inner {
        DeValue::Table(_) => {
            value.table("").ok()?.entries().into_iter().map(|(_, value)| value).collect()
        }
        DeValue::Array(_) => value.list("").ok()?,
        _ => return size(&centred(value).ok()?.0).filter(|size| !size.is_zero()),
    };
    within.iter().filter_map(largest).max()
}

/// `|x|`, nearly.
fn size(x: &Exact) -> Option<BigRational> {
    let value = match x.as_rational() {
        Some(x) => x.clone(),
        None => x.below(SIZE_BITS)?,
    };
    Some(value.abs())
}

/// A tolerance's text for half of its width.
pub(super) fn half_width(half: &Exact) -> String {
    let text = exact(half);
    let plain = text.chars().all(|c| c.is_ascii_digit() || c == '.');
    if plain {
        text
    } else {
        format!("({text})")
    }
}
