//! Where the keys of a design stand in its file.

use super::document::joined;
use super::error::Position;
use std::collections::BTreeMap;
use toml::de::{DeTable, DeValue};

/// The place of every key of a design file, by its path: `requirements.transmission`,
/// `mechanism.legs[1].length` (elements are counted from 1).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    positions: BTreeMap<String, Position>,
}

impl Sources {
    pub(super) fn of(text: &str, root: &DeTable<'_>) -> Self {
        let mut sources = Sources::default();
        sources.add_table(text, "", root);
        sources
    }

    /// The place of the key `path`, or `None` if the file does not have it.
    pub fn position(&self, path: &str) -> Option<Position> {
        self.positions.get(path).copied()
    }

    fn add_table(&mut self, text: &str, path: &str, table: &DeTable<'_>) {
        for (key, value) in table {
            let path = joined(path, key.get_ref());
            self.positions.insert(path.clone(), Position::of(text, key.span().start));
            self.add_below(text, &path, value.get_ref());
        }
    }

    // The parser bounds the nesting, and with it this recursion.
    fn add_below(&mut self, text: &str, path: &str, value: &DeValue<'_>) {
        match value {
            DeValue::Table(table) => self.add_table(text, path, table),
            DeValue::Array(elements) => {
                for (i, element) in elements.iter().enumerate() {
                    let path = format!("{path}[{}]", i + 1);
                    self.positions.insert(path.clone(), Position::of(text, element.span().start));
                    self.add_below(text, &path, element.get_ref());
                }
            }
            _ => {}
        }
    }
}
