//! Where the keys of a design stand in its file.

use super::document::joined;
use super::error::{Defect, DesignError, Position};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// The place of every key of a design file, by its path: `requirements.transmission`,
/// `mechanism.legs.0.length` (elements are counted from 0).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    file: String,
    text: String,
    places: BTreeMap<String, Range<usize>>,
}

impl Sources {
    pub(super) fn of((file, text): (&str, &str), root: &DeTable<'_>) -> Self {
        let mut sources =
            Sources { file: file.to_owned(), text: text.to_owned(), places: BTreeMap::new() };
        sources.add_table("", root);
        sources
    }

    /// The place of the key `path`, or `None` if the file does not have it.
    pub fn position(&self, path: &str) -> Option<Position> {
        self.places.get(path).map(|at| Position::of(&self.text, at.start))
    }

    /// The first key in the file below `table` with this last name.
    pub(super) fn first(&self, table: &str, name: &str) -> Option<&str> {
        let named = |path: &str| {
            let below = path.strip_prefix(table).and_then(|rest| rest.strip_prefix('.'));
            below.is_some_and(|rest| rest.rsplit('.').next() == Some(name))
        };
        let found = self.places.iter().filter(|(path, _)| named(path));
        found.min_by_key(|(_, at)| at.start).map(|(path, _)| path.as_str())
    }

    /// What is said of a key that a question does not fit, as of one that is not well formed; of a
    /// key that the file does not have, of the table that it would be in. `None` without a file.
    pub(super) fn refused(&self, key: &str, found: &str, accepted: &str) -> Option<DesignError> {
        let mut there = key;
        loop {
            if let Some(at) = self.places.get(there) {
                let about = (there, Defect::Conflict);
                let (found, accepted) = (found.to_owned(), accepted.to_owned());
                let source = (self.file.as_str(), self.text.as_str());
                return Some(DesignError::new(source, at.clone(), about, found, accepted));
            }
            there = there.rsplit_once('.')?.0;
        }
    }

    fn add_table(&mut self, path: &str, table: &DeTable<'_>) {
        for (key, value) in table {
            let path = joined(path, key.get_ref());
            self.places.insert(path.clone(), key.span());
            self.add_below(&path, value.get_ref());
        }
    }

    // The parser bounds the nesting, and with it this recursion.
    fn add_below(&mut self, path: &str, value: &DeValue<'_>) {
        match value {
            DeValue::Table(table) => self.add_table(path, table),
            DeValue::Array(elements) => {
                for (i, element) in elements.iter().enumerate() {
                    let path = format!("{path}.{i}");
                    self.places.insert(path.clone(), element.span());
                    self.add_below(&path, element.get_ref());
                }
            }
            _ => {}
        }
    }
}
