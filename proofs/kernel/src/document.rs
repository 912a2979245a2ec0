//! Texts of which there is one for each value: what is read is what it prints.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Why a text is not read. What it quotes is in printable ASCII.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Unreadable {
    /// Too long.
    #[error("more than {0} bytes")]
    TooLong(usize),
    /// Not of the shape of the format.
    #[error("{0}")]
    Malformed(String),
    /// Of another format than this one.
    #[error("format {0:?} is not known; this checker reads {1:?}")]
    Format(String, &'static str),
    /// Its value prints another text, from this byte on.
    #[error("the same is written otherwise, from byte {0} on")]
    NotCanonical(usize),
}

/// The text of a value: JSON without blanks, keys in their order, a line feed after it.
///
/// # Errors
/// Never for what [`read`] gave.
pub fn written(value: &impl Serialize) -> Result<String, serde_json::Error> {
    serde_json::to_string(value).map(|text| text + "\n")
}

/// The value with this text, of at most so many bytes, whose key `format` names the format.
///
/// Whatever a JSON reader lets pass (a key twice, in another order, or of no meaning; a number
/// written otherwise; blanks) is refused, since the value prints otherwise.
///
/// # Errors
/// If it is not what the value prints.
pub fn read<T>(text: &[u8], format: &'static str, most: usize) -> Result<T, Unreadable>
where
    T: Serialize + DeserializeOwned,
{
    #[derive(Deserialize)]
    struct Format {
        format: String,
    }
    if text.len() > most {
        return Err(Unreadable::TooLong(most));
    }
    let malformed = |e: serde_json::Error| Unreadable::Malformed(quoted(&e.to_string()));
    let found = serde_json::from_slice::<Format>(text).map_err(malformed)?.format;
    if found != format {
        return Err(Unreadable::Format(quoted(&found), format));
    }
    let value = serde_json::from_slice(text).map_err(malformed)?;
    let printed = written(&value).map_err(malformed)?;
    match printed.bytes().zip(text).position(|(a, b)| a != *b) {
        None if printed.len() == text.len() => Ok(value),
        at => Err(Unreadable::NotCanonical(at.unwrap_or(printed.len().min(text.len())))),
    }
}

/// The beginning of a stranger's text.
fn quoted(text: &str) -> String {
    let shown = |c: char| if c == ' ' || c.is_ascii_graphic() { c } else { '?' };
    text.chars().take(200).map(shown).collect()
}
