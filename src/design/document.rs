//! A TOML document with places: every table and value knows its key's full path and its span, so
//! that whoever reads it can say precisely what is wrong.

use super::error::{Defect, DesignError};
use super::suggestion;
use crate::exact::Exact;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// What a value without quotes could be instead.
const QUOTED_VALUES: &str =
    r#"a plain number, or text in quotes: 310.25, "1/3", "310.25 ± 0.02", "orthoglide""#;

/// The text of a design file.
#[derive(Clone, Copy)]
pub(super) struct Document<'a> {
    /// The file's name, for messages.
    pub file: &'a str,
    /// All of the file.
    pub text: &'a str,
    /// What names in expressions mean.
    pub names: Names<'a>,
}

/// What names in expressions mean.
#[derive(Clone, Copy)]
pub(super) enum Names<'a> {
    /// Nothing: a design has none.
    None,
    /// These parameters of an atlas have these values.
    Values(&'a [(String, Exact)]),
    /// These parameters of an atlas stay names. Nothing can be proved of expressions with them, so
    /// what numbers have to be is not demanded: the same file is read with values for that.
    Kept(&'a [(String, Exact)]),
}

/// A table of a document.
pub(super) struct Table<'a> {
    document: Document<'a>,
    key: String,
    at: Range<usize>,
    entries: &'a DeTable<'a>,
}

/// A value of a document.
pub(super) struct Value<'a> {
    pub document: Document<'a>,
    /// The path of keys and indices, from 0, that leads to it, as `limit` takes it.
    pub key: String,
    /// Its bytes in the text.
    pub at: Range<usize>,
    pub inner: &'a DeValue<'a>,
}

impl<'a> Document<'a> {
    /// Whether numbers have to be what their keys demand.
    pub fn demands(&self) -> bool {
        !matches!(self.names, Names::Kept(_))
    }

    /// Values of the names.
    pub fn values(&self) -> &'a [(String, Exact)] {
        match self.names {
            Names::None => &[],
            Names::Values(values) | Names::Kept(values) => values,
        }
    }

    /// The error about `text[at]`.
    pub fn error(
        &self,
        at: Range<usize>,
        (key, defect): (&str, Defect),
        found: impl Into<String>,
        accepted: impl Into<String>,
    ) -> DesignError {
        let source = (self.file, self.text);
        DesignError::new(source, at, (key, defect), found.into(), accepted.into())
    }

    /// The document's outermost table; what it lacks is reported at the end of the text.
    pub fn root(self, entries: &'a DeTable<'a>) -> Table<'a> {
        let end = self.text.trim_end().len();
        Table { document: self, key: String::new(), at: end..end, entries }
    }

    /// TOML's own errors: bad syntax, duplicated keys, tables nested too deeply.
    pub fn syntax_error(&self, error: &toml::de::Error) -> DesignError {
        let end = self.text.trim_end().len();
        let at = error.span().filter(|at| at.start < end).unwrap_or(end..end);
        let (what, expected) = match error.message().split_once(", expected ") {
            _ if self.is_decimal_comma(at.start) => ("a comma in a number", "a point: 310.7"),
            _ if self.text.trim_start().starts_with(r#"{"format":"#) => (
                "a certificate",
                "a design file (TOML text); `orthocert check` re-proves certificates",
            ),
            Some((what @ ("string values must be quoted" | "invalid float"), _)) => {
                (what, QUOTED_VALUES)
            }
            Some((what, expected)) => (what, expected),
            None if error.message() == "duplicate key" => {
                let key = self.text.get(at.clone()).unwrap_or_default().trim();
                let accepted = match suggestion::LISTS.contains(&key) {
                    true => "each key once; of a list, each table between two brackets: [[mechanism.legs]]",
                    false => "each key once",
                };
                (error.message(), accepted)
            }
            None => (error.message(), "TOML text"),
        };
        let rest = self.text.get(at.start..).unwrap_or_default().lines().next().unwrap_or_default();
        let found = match self.text.get(at.clone()).unwrap_or_default().trim() {
            "" if rest.trim().is_empty() => format!("the end of the line: {what}"),
            "" => format!("{}: {what}", quoted(rest.trim())),
            snippet => format!("{}: {what}", quoted(snippet)),
        };
        let key = self.key_around(at.start);
        let snippet = self.text.get(at.clone()).unwrap_or_default();
        let ends = snippet.find(|c: char| c.is_alphabetic() || c == '\u{b0}');
        let hint = ends.and_then(|ends| suggestion::without_unit(snippet, ends));
        let hint = hint.map(|number| format!("; numbers carry no unit: {number}"));
        let expected = expected.to_owned() + &hint.unwrap_or_default();
        self.error(at, (&key, Defect::Syntax), found, expected)
    }

    /// Whether a number of the text has a comma at `at`, or is the last thing before it and a table's only
    /// value so far: `{ min = 0,5, max = 2 }`, of which `5` is read as a key.
    fn is_decimal_comma(&self, at: usize) -> bool {
        let digit = |at: usize| self.text.as_bytes().get(at).is_some_and(u8::is_ascii_digit);
        let before = self.text.get(..at).unwrap_or_default().trim_end();
        let decimals = before.trim_end_matches(|c: char| c.is_ascii_digit());
        let whole = decimals.strip_suffix(',').filter(|_| decimals.len() < before.len());
        let value = whole.map(|whole| {
            let number = |c: char| c.is_ascii_digit() || "+-._".contains(c);
            (whole.ends_with(|c: char| c.is_ascii_digit()), whole.trim_end_matches(number))
        });
        let in_table =
            value.is_some_and(|(is_number, before)| is_number && before.trim_end().ends_with('='));
        let in_number =
            self.text.as_bytes().get(at) == Some(&b',') && at > 0 && digit(at - 1) && digit(at + 1);
        in_number || in_table
    }

    /// The key that the byte at `offset` seems to belong to, where the text is not TOML and can only
    /// be read line by line: the last table header, and what precedes the line's equals sign.
    fn key_around(&self, offset: usize) -> String {
        let end = (offset..self.text.len()).find(|&i| self.text.as_bytes().get(i) == Some(&b'\n'));
        let lines = self.text.get(..end.unwrap_or(self.text.len())).unwrap_or_default();
        let name = |text: &str| {
            let bare = |c: char| c.is_ascii_alphanumeric() || "_-. ".contains(c);
            Some(text.trim()).filter(|t| t.chars().all(bare)).unwrap_or_default().to_owned()
        };
        // What follows a header is a comment.
        let named = |line: &str, brackets: &str| {
            line.trim().strip_prefix(brackets)?.trim_start_matches('[').split(']').next().map(name)
        };
        let last = lines.lines().rev().find(|line| named(line, "[").is_some()).unwrap_or_default();
        let header = named(last, "[").unwrap_or_default();
        // Of an array of tables, which of them.
        let same = |line: &&str| named(line, "[[").is_some_and(|other| other == header);
        let header = match named(last, "[[") {
            Some(_) => format!("{header}.{}", lines.lines().filter(same).count() - 1),
            None => header,
        };
        let last = lines.lines().next_back().unwrap_or_default();
        let key = last.split_once('=').map(|(key, _)| name(key)).unwrap_or_default();
        match (header.is_empty(), key.is_empty()) {
            (false, false) => format!("{header}.{key}"),
            (false, true) => header,
            (true, _) => key,
        }
    }
}

impl<'a> Table<'a> {
    /// Values of the names.
    pub fn values(&self) -> &'a [(String, Exact)] {
        self.document.values()
    }

    /// The path of the entry `name`.
    pub fn path(&self, name: &str) -> String {
        joined(&self.key, name)
    }

    /// The error about this table as a whole, or about the key `name` that it lacks.
    pub fn lacks(&self, name: &str, accepted: impl Into<String>) -> DesignError {
        let key = self.path(name);
        let about = (key.as_str(), Defect::MissingKey);
        self.document.error(self.at.clone(), about, "nothing: the key is missing", accepted)
    }

    /// Refuses every key that is not `accepted`, the first in the text first.
    pub fn only(&self, accepted: &[&str]) -> Result<(), DesignError> {
        self.only_here(accepted, |_| None)
    }

    /// The same; of a key that stands elsewhere, `elsewhere` says where.
    pub fn only_here(
        &self,
        accepted: &[&str],
        elsewhere: impl Fn(&str) -> Option<String>,
    ) -> Result<(), DesignError> {
        let unknown = self.entries.keys().filter(|key| !accepted.contains(&key.get_ref().as_ref()));
        let Some(unknown) = unknown.min_by_key(|key| key.span().start) else {
            return Ok(());
        };
        let name = unknown.get_ref();
        let home = || suggestion::home_of(name).filter(|home| *home != format!("[{}]", self.key));
        let hint = match elsewhere(name).or_else(|| home().map(str::to_owned)) {
            Some(place) => format!("; {name} goes with {place}"),
            None => suggestion::hint(name, accepted, |word| word.to_owned()),
        };
        let key = self.path(name);
        let accepted = format!("{}{hint}", accepted.join(", "));
        let about = (key.as_str(), Defect::UnknownKey);
        Err(self.document.error(unknown.span(), about, "an unknown key", accepted))
    }

    /// The value of `name`, if there is one.
    pub fn find(&self, name: &str) -> Option<Value<'a>> {
        let value = self.entries.get(name)?;
        let (at, inner) = (value.span(), value.get_ref());
        Some(Value { document: self.document, key: self.path(name), at, inner })
    }

    /// The value of `name`, which has to be there; `accepted` says what it could be.
    pub fn require(&self, name: &str, accepted: &str) -> Result<Value<'a>, DesignError> {
        self.find(name).ok_or_else(|| self.lacks(name, accepted))
    }

    /// The entries in the order of the file.
    pub fn entries(&self) -> Vec<(&'a str, Value<'a>)> {
        let mut keys: Vec<_> = self.entries.keys().collect();
        keys.sort_by_key(|key| key.span().start);
        let entry = |key: &&'a toml::Spanned<toml::de::DeString<'a>>| {
            let name: &'a str = key.get_ref();
            Some((name, self.find(name)?))
        };
        keys.iter().filter_map(entry).collect()
    }
}

impl<'a> Value<'a> {
    /// The error about this value.
    pub fn error(
        &self,
        defect: Defect,
        found: impl Into<String>,
        accepted: impl Into<String>,
    ) -> DesignError {
        self.document.error(self.at.clone(), (&self.key, defect), found, accepted)
    }

    /// The error that this value is of another type than `accepted`.
    pub fn wrong_type(&self, accepted: &str) -> DesignError {
        let range = self.range().filter(|_| accepted.contains("{ min = "));
        let hint = range.map_or_else(String::new, |range| format!("; did you mean {range}?"));
        self.error(Defect::WrongType, self.found(), format!("{accepted}{hint}"))
    }

    /// The value as the file has it, for messages.
    pub fn found(&self) -> String {
        let written = self.document.text.get(self.at.clone()).unwrap_or_default();
        match self.inner {
            DeValue::Array(elements) if elements.len() == 1 => "an array of one element".into(),
            DeValue::Array(elements) => format!("an array of {} elements", elements.len()),
            DeValue::Table(_) => "a table".into(),
            DeValue::String(text) if written.contains('\n') => quoted(&format!("{text:?}")),
            DeValue::Boolean(_) | DeValue::Datetime(_) => {
                format!("the {} {}", self.inner.type_str(), quoted(written))
            }
            _ => quoted(written),
        }
    }

    /// The table that this value is.
    pub fn table(&self, accepted: &str) -> Result<Table<'a>, DesignError> {
        let entries = self.inner.as_table().ok_or_else(|| self.wrong_type(accepted))?;
        let (key, at) = (self.key.clone(), self.at.clone());
        Ok(Table { document: self.document, key, at, entries })
    }

    /// The `N` elements of the array that this value is.
    pub fn elements<const N: usize>(&self, accepted: &str) -> Result<[Value<'a>; N], DesignError> {
        <[Value; N]>::try_from(self.list(accepted)?).map_err(|_| self.wrong_type(accepted))
    }

    /// The three elements of the array that this value is.
    pub fn three(&self, accepted: &str) -> Result<[Value<'a>; 3], DesignError> {
        self.elements(accepted)
    }

    /// The elements of the array that this value is.
    pub fn list(&self, accepted: &str) -> Result<Vec<Value<'a>>, DesignError> {
        let elements = self.inner.as_array().ok_or_else(|| self.wrong_type(accepted))?;
        let all = elements.iter().enumerate().map(|(i, element)| Value {
            document: self.document,
            key: format!("{}.{i}", self.key),
            at: element.span(),
            inner: element.get_ref(),
        });
        Ok(all.collect())
    }

    /// The table of the two ends that an array of two may be meant as.
    fn range(&self) -> Option<String> {
        let [least, greatest] = &self.inner.as_array()?[..] else { return None };
        let number = |end: &toml::Spanned<DeValue<'_>>| {
            let is_one = !matches!(end.get_ref(), DeValue::Array(_) | DeValue::Table(_));
            self.document.text.get(end.span()).filter(|_| is_one)
        };
        let (least, greatest) = (number(least)?, number(greatest)?);
        Some(quoted(&format!("{{ min = {least}, max = {greatest} }}")))
    }

    /// The text that this value is.
    pub fn text(&self, accepted: &str) -> Result<&'a str, DesignError> {
        self.inner.as_str().ok_or_else(|| self.wrong_type(accepted))
    }

    /// Where `part` of the value's content stands in the file. Between its quotes, if any, the content
    /// stands there as it is, unless it has escapes or underscores.
    pub fn place(&self, content: &str, part: Range<usize>) -> Range<usize> {
        let written = self.document.text.get(self.at.clone()).unwrap_or_default();
        let between_quotes = written.get(1..written.len().saturating_sub(1));
        match (written == content, between_quotes == Some(content)) {
            (false, false) => self.at.clone(),
            (as_it_is, _) => {
                let start = self.at.start + usize::from(!as_it_is);
                start + part.start..start + part.end
            }
        }
    }

    /// The row of `table` that is named by the word that this value is.
    pub fn choose<'t, T>(
        &self,
        table: &'t [T],
        name: impl Fn(&T) -> &'static str,
    ) -> Result<&'t T, DesignError> {
        let names: Vec<&str> = table.iter().map(name).collect();
        let shown: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
        let accepted = shown.join(", ");
        let word = self.text(&accepted)?;
        let row = names.iter().position(|name| *name == word).and_then(|i| table.get(i));
        row.ok_or_else(|| {
            let known = suggestion::kind_of(word).filter(|kind| names.contains(kind));
            let hint = match known {
                Some(kind) => format!("; such a machine is of kind {kind:?}"),
                None => suggestion::hint(word, &names, |name| format!("{name:?}")),
            };
            self.error(Defect::UnknownWord, self.found(), format!("{accepted}{hint}"))
        })
    }
}

/// The path of the entry `name` of the table `key`, quoted where TOML needs it.
pub(super) fn joined(key: &str, name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let name = match !name.is_empty() && name.chars().all(bare) {
        true => name.to_owned(),
        false => quoted(&format!("{name:?}")),
    };
    match key.is_empty() {
        true => name,
        false => format!("{key}.{name}"),
    }
}

/// Most characters of a file that are repeated in a message.
const QUOTED: usize = 48;

/// `text` on one line, control characters escaped, shortened where it is long.
fn quoted(text: &str) -> String {
    let mut shown = String::new();
    for c in text.chars().take(QUOTED) {
        match c {
            '\n' | '\r' | '\t' => shown.push(' '),
            c if c.is_control() => shown.extend(c.escape_default()),
            c => shown.push(c),
        }
    }
    match text.chars().count() {
        length if length > QUOTED => format!("{shown}... ({length} characters)"),
        _ => shown,
    }
}
