//! Many designs at once: which they are, how each ended, and reports of it in the forms that
//! continuous integration reads. Every writer is a function of the [`Batch`] alone.
//!
//! | module          | does                                                                |
//! |-----------------|---------------------------------------------------------------------|
//! | [`annotations`] | messages that GitHub shows beside the lines of a design             |
//! | [`junit`]       | a test report, as JUnit's readers take it                           |
//! | [`pair`]        | certificates with their designs, and what has no counterpart        |
//! | [`plan`]        | the designs of files and folders, and where their certificates go   |
//! | [`run`]         | several jobs at a time                                              |
//! | [`sarif`]       | SARIF 2.1.0                                                         |
//! | [`summary`]     | the table at the end, for terminals and as Markdown                 |

pub mod annotations;
pub mod junit;
pub mod pair;
pub mod plan;
pub mod run;
pub mod sarif;
pub mod summary;
#[cfg(test)]
mod tests;

use crate::files::shown::Shown;
use crate::report::requirement::Requirement;
use crate::report::{CertificateFile, Counterexample};
use orthocert_checker::certificate::Verdict;
use serde::Serialize;

/// How the work on one design, or on one certificate, ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The exact checker has accepted a proof.
    Certified,
    /// The exact checker has accepted a counterexample.
    Refuted,
    /// Neither was found within the budget.
    Undecided,
    /// The file is no design, or cannot be read.
    BadInput,
    /// The certificate proves nothing, or nothing of that design, or one of the two is missing.
    Rejected,
    /// A file could not be written, the work was interrupted, or this program is wrong.
    NotFinished,
    /// The work was interrupted before this one's turn.
    NotRun,
}

impl Ending {
    /// All of them, best first.
    pub const ALL: [Ending; 7] = [
        Ending::Certified,
        Ending::Undecided,
        Ending::Refuted,
        Ending::Rejected,
        Ending::BadInput,
        Ending::NotFinished,
        Ending::NotRun,
    ];

    /// The exit code of a command that ends so.
    pub fn code(self) -> u8 {
        match self {
            Ending::Certified => 0,
            Ending::Refuted => 1,
            Ending::BadInput => 2,
            Ending::Undecided => 3,
            Ending::NotFinished | Ending::NotRun => 4,
            Ending::Rejected => 5,
        }
    }

    /// The word for it in lists.
    pub fn word(self) -> &'static str {
        match self {
            Ending::Certified => "certified",
            Ending::Refuted => "refuted",
            Ending::Undecided => "undecided",
            Ending::BadInput => "bad input",
            Ending::Rejected => "rejected",
            Ending::NotFinished => "not finished",
            Ending::NotRun => "not run",
        }
    }
}

impl From<Verdict> for Ending {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Certified => Ending::Certified,
            Verdict::Refuted => Ending::Refuted,
        }
    }
}

/// The exit code of several endings: the worst of theirs, in the order 4, 2, 5, 1, 3, 0.
pub fn worst(endings: impl IntoIterator<Item = Ending>) -> u8 {
    let rank = |ending: &Ending| Ending::ALL.iter().position(|other| other == ending);
    endings.into_iter().max_by_key(rank).map_or(0, Ending::code)
}

/// `28 certified, 1 refuted`, leaving out what did not occur.
pub fn counts(endings: impl IntoIterator<Item = Ending>) -> String {
    let endings: Vec<Ending> = endings.into_iter().collect();
    let of = |kind: &Ending| endings.iter().filter(|ending| *ending == kind).count();
    let counts = Ending::ALL.iter().map(|kind| (of(kind), kind.word()));
    let told: Vec<String> = counts
        .filter(|(count, _)| *count > 0)
        .map(|(count, word)| format!("{count} {word}"))
        .collect();
    told.join(", ")
}

/// What became of one design.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// The design file, as it was named or found.
    pub design: String,
    /// How it ended.
    pub verdict: Ending,
    /// The design's title.
    pub title: Option<String>,
    /// Whether a certificate that was there was re-checked, instead of a search.
    pub cached: bool,
    /// Seconds of work on it.
    pub seconds: f64,
    /// Boxes tried by the search.
    pub boxes_tried: usize,
    /// What the design demands, and what is known of each.
    pub requirements: Vec<Requirement>,
    /// The counterexample of a refutation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub counterexample: Option<Counterexample>,
    /// Why there is no verdict, or what else there is to say.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// The line of the design that the message is about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// The certificate that was written, or re-checked.
    pub certificate: Option<CertificateFile>,
}

impl Entry {
    /// A design of which nothing is known but that it ended so, and why.
    pub fn without_verdict(design: String, verdict: Ending, message: String) -> Self {
        Entry {
            design,
            verdict,
            title: None,
            cached: false,
            seconds: 0.0,
            boxes_tried: 0,
            requirements: Vec::new(),
            counterexample: None,
            message: Some(message),
            line: None,
            certificate: None,
        }
    }

    /// What there is to say beyond the verdict, in one sentence fit to be shown; empty where that is
    /// all.
    pub fn remark(&self) -> String {
        if let Some(found) = &self.counterexample {
            return Shown(format!("{}; demanded: {}", found.value, found.violated)).to_string();
        }
        let first = self.message.as_deref().unwrap_or_default().lines().next();
        Shown(first.unwrap_or_default()).to_string()
    }

    /// The same beside the design's name, with which messages about a file begin: `line 11:14: ..`.
    pub fn remark_beside_name(&self) -> String {
        let remark = self.remark();
        let name = format!("{}:", Shown(&self.design));
        match remark.strip_prefix(&name) {
            Some(rest) if rest.starts_with(|c: char| c.is_ascii_digit()) => format!("line {rest}"),
            Some(rest) => rest.trim_start().to_owned(),
            None => remark,
        }
    }
}

/// What became of many designs, in the order of the plan.
#[derive(Clone, Debug, Serialize)]
pub struct Batch {
    /// One for each design.
    pub designs: Vec<Entry>,
    /// Whether a signal ended it early.
    pub interrupted: bool,
    /// Seconds from the start to the last verdict.
    pub seconds: f64,
    /// The exit code that follows from the designs.
    pub exit_code: u8,
}

impl Batch {
    /// The batch of these entries.
    pub fn new(designs: Vec<Entry>, interrupted: bool, seconds: f64) -> Self {
        let exit_code = match interrupted {
            true => Ending::NotFinished.code(),
            false => worst(designs.iter().map(|entry| entry.verdict)),
        };
        Batch { designs, interrupted, seconds, exit_code }
    }
}
