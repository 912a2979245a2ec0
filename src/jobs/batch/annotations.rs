//! Messages that GitHub shows beside the lines of a design (workflow commands).

use super::{Batch, Ending, Entry};
use crate::files::shown::Shown;
use crate::report::requirement::Standing;

/// One line for everything that is not certified: an error for a refutation, bad input or trouble,
/// a warning for an undecided design. `locate` gives a design's path from the repository's root.
pub fn annotations(batch: &Batch, locate: impl Fn(&str) -> String) -> String {
    let wrong = batch.designs.iter().filter(|entry| entry.verdict != Ending::Certified);
    wrong.map(|entry| annotation(entry, &locate(&entry.design))).collect()
}

fn annotation(entry: &Entry, file: &str) -> String {
    let level = if entry.verdict == Ending::Undecided { "warning" } else { "error" };
    let failing = entry.requirements.iter().find(|one| one.standing == Standing::Fails);
    let line = entry.line.or_else(|| failing.and_then(|one| one.line)).unwrap_or(1);
    let title = property(&format!("orthocert: {}", entry.verdict.word()));
    let text = match entry.remark() {
        text if text.is_empty() => entry.verdict.word().to_owned(),
        text => text,
    };
    format!("::{level} file={},line={line},title={title}::{}\n", property(file), data(&text))
}

/// The text of a message, on one line.
fn data(text: &str) -> String {
    Shown(text).to_string().replace('%', "%25").replace("##[", "##\\u{5b}")
}

/// The value of a property, which `:` and `,` would end.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}
