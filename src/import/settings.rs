//! The settings of a configuration, and a record of what became of each.

use super::files::Reading;
use super::toml::{document, Machine, Number};
use super::{DefaultTaken, ImportError, Imported, Setting, Used};
use std::collections::{BTreeMap, BTreeSet};

const NUMBER: &str = "a decimal number";
const POSITIVE: &str = "a decimal number greater than 0";

/// What a configuration sets, by key. Whatever is read is recorded; [`Settings::finish`] refuses
/// what is left and may matter.
pub(super) struct Settings {
    /// The first file, for messages about what is nowhere.
    file: String,
    found: BTreeMap<String, Setting>,
    /// Statements that set no single key and may matter, in order.
    statements: Vec<Setting>,
    read: BTreeSet<String>,
    used: Vec<Used>,
    defaults: Vec<DefaultTaken>,
    notes: Vec<String>,
}

impl Settings {
    /// None yet, of a configuration whose first file is `file`.
    pub fn new(file: impl Into<String>) -> Self {
        Settings {
            file: file.into(),
            found: BTreeMap::new(),
            statements: Vec::new(),
            read: BTreeSet::new(),
            used: Vec::new(),
            defaults: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Sets a key; a later setting overrides an earlier one.
    pub fn set(&mut self, setting: Setting) {
        self.found.insert(setting.key.clone(), setting);
    }

    /// Takes a key back, as a later line of the configuration does.
    pub fn unset(&mut self, key: &str) {
        self.found.remove(key);
    }

    /// A statement that is not understood and may matter, whatever else has its key.
    pub fn not_understood(&mut self, statement: Setting) {
        self.statements.push(statement);
    }

    /// A sentence about what is not carried over.
    pub fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }

    /// A setting, without recording that it was read.
    pub fn peek(&self, key: &str) -> Option<&Setting> {
        self.found.get(key)
    }

    /// A setting that became part of the design; `became` says what.
    pub fn text(&mut self, key: &str, became: &str) -> Option<Setting> {
        let setting = self.found.get(key)?.clone();
        if self.read.insert(key.to_owned()) {
            self.used.push(Used { setting: setting.clone(), became: became.to_owned() });
        }
        Some(setting)
    }

    /// A number, if it is set.
    pub fn number(&mut self, key: &str, became: &str) -> Result<Option<Number>, ImportError> {
        let Some(setting) = self.text(key, became) else { return Ok(None) };
        Number::parse(&setting.value).map(Some).ok_or_else(|| self.bad(key, NUMBER))
    }

    /// A number greater than 0, if it is set.
    pub fn positive(&mut self, key: &str, became: &str) -> Result<Option<Number>, ImportError> {
        match self.number(key, became) {
            Ok(Some(number)) if number.is_positive() => Ok(Some(number)),
            Ok(None) => Ok(None),
            _ => Err(self.bad(key, POSITIVE)),
        }
    }

    /// A number greater than 0 that the firmware demands.
    pub fn required(&mut self, key: &str, became: &str) -> Result<Number, ImportError> {
        self.positive(key, became)?.ok_or_else(|| self.lacks(key, became))
    }

    /// A number, or the default that `source`, a file of the firmware, gives.
    pub fn number_or(
        &mut self,
        key: &str,
        became: &str,
        (default, source): (&str, &'static str),
    ) -> Result<Number, ImportError> {
        let text = match self.number(key, became)? {
            Some(number) => return Ok(number),
            None => self.defaulted(key, default, source),
        };
        Number::parse(&text).ok_or_else(|| self.missing(key))
    }

    /// A number greater than 0, or the default that `source` gives.
    pub fn positive_or(
        &mut self,
        key: &str,
        became: &str,
        default: (&str, &'static str),
    ) -> Result<Number, ImportError> {
        let number = self.number_or(key, became, default)?;
        match number.is_positive() {
            true => Ok(number),
            false => Err(self.bad(key, POSITIVE)),
        }
    }

    /// Records that a key is not set and what the firmware takes.
    pub fn defaulted(&mut self, key: &str, value: &str, source: &'static str) -> String {
        let taken = DefaultTaken { key: key.to_owned(), value: value.to_owned(), source };
        if !self.defaults.contains(&taken) {
            self.defaults.push(taken);
        }
        value.to_owned()
    }

    /// That the value of `key` is not what it has to be; that the key is missing if it is not set.
    pub fn bad(&self, key: &str, expected: impl Into<String>) -> ImportError {
        match self.found.get(key) {
            Some(setting) => ImportError::BadValue {
                file: setting.file.clone(),
                line: setting.line,
                setting: setting.key.clone(),
                found: setting.value.clone(),
                expected: expected.into(),
            },
            None => self.missing(key),
        }
    }

    /// That `key` is not set.
    pub fn missing(&self, key: &str) -> ImportError {
        self.lacks(key, None)
    }

    /// The same with what it is of the machine, where that is known.
    pub fn lacks<'a>(&self, key: &str, is: impl Into<Option<&'a str>>) -> ImportError {
        let is = is.into().map(str::to_owned);
        ImportError::Missing { file: self.file.clone(), setting: key.to_owned(), is }
    }

    /// That a design cannot be made of this; `reason` is a sentence without its full stop.
    pub fn refused(&self, reason: impl Into<String>) -> ImportError {
        ImportError::Refused { file: self.file.clone(), reason: reason.into() }
    }

    /// The design of `machine`, if all that was not read is `harmless` or to be ignored.
    ///
    /// # Errors
    /// The first setting, by file and line, that is neither; or a key of `ignore` that none has.
    pub fn finish(
        self,
        machine: &Machine,
        harmless: impl Fn(&Setting) -> bool,
        ignore: &[String],
        reading: Reading<'_>,
    ) -> Result<Imported, ImportError> {
        let unread = self.found.into_values().filter(|s| !self.read.contains(&s.key));
        let unread = unread.filter(|setting| !harmless(setting));
        let mut left: Vec<Setting> = unread.chain(self.statements).collect();
        left.sort_by(|a, b| (&a.file, a.line).cmp(&(&b.file, b.line)));
        let (ignored, refused): (Vec<Setting>, Vec<Setting>) =
            left.into_iter().partition(|setting| ignore.contains(&setting.key));
        if let Some(Setting { file, line, key, value: found }) = refused.into_iter().next() {
            return Err(ImportError::NotUnderstood { file, line, key, found });
        }
        let idle = |key: &&String| !ignored.iter().any(|setting| setting.key == **key);
        if let Some(key) = ignore.iter().find(idle) {
            return Err(ImportError::NothingToIgnore { key: key.clone() });
        }
        let mut imported = Imported {
            design: String::new(),
            used: self.used,
            defaults: self.defaults,
            not_carried_over: vec![
                "The requirements: a configuration has no bounds on transmission factors; change \
                 those below."
                    .to_owned(),
                "Tolerances: every number is taken as exact; write \"333.0 ± 0.05\" where one is \
                 known."
                    .to_owned(),
            ],
            ignored,
            files: reading.read,
        };
        imported.not_carried_over.extend(self.notes);
        imported.design = document(&self.file, machine, &imported);
        Ok(imported)
    }
}
