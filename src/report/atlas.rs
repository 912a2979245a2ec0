//! What a map of designs holds, for people and for scripts.

use super::text::{file_line, labelled, verbatim, wrap};
use super::CertificateFile;
use crate::design::Parameter;
use crate::exact::decimal::{approximate, boxes, counted, exact, percent, significant, Toward};
use crate::exact::Exact;
use crate::files::shown::Shown;
use num_rational::BigRational;
use num_traits::{One, Signed};
use serde::Serialize;
use std::fmt::Write;

/// What the objective of the widest margin is called.
pub const MARGIN: &str = "margin";

/// What is as near to the end of a range, as a part of it, is at the end.
const AT_END: f64 = 0.01;

/// What a map says of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// It is in a certified cell.
    Certified,
    /// It is in a refuted cell.
    Refuted,
    /// It is in an undecided cell.
    Undecided,
    /// It is not in the box of parameters.
    Outside,
}

/// The report of an atlas.
#[derive(Clone, Debug, Serialize)]
pub struct AtlasReport {
    /// The atlas's title.
    pub title: Option<String>,
    /// The atlas's file, or what it was merged from.
    pub atlas: String,
    /// What was varied.
    pub parameters: Vec<Parameter>,
    /// Cells certified, and their share of the box.
    pub certified: Part,
    /// Cells refuted.
    pub refuted: Part,
    /// The rest.
    pub undecided: Part,
    /// Boxes of all trees together.
    pub nodes: usize,
    /// The best certified design, where the file has an objective and the map a certified cell.
    pub best: Option<BestDesign>,
    /// What the map says of the marked designs.
    pub marks: Vec<MarkedDesign>,
    /// The map's certificate.
    pub certificate: CertificateFile,
    /// The other files written.
    pub files: Vec<String>,
    /// Seconds taken.
    pub seconds: f64,
}

/// Cells of one verdict.
#[derive(Clone, Debug, Serialize)]
pub struct Part {
    /// How many.
    pub cells: usize,
    /// The share of the box that they fill, exactly.
    pub share: Exact,
}

/// The best design of the certified cells.
#[derive(Clone, Debug, Serialize)]
pub struct BestDesign {
    /// Its parameters.
    pub at: Vec<Exact>,
    /// `maximise` or `minimise`.
    pub sense: &'static str,
    /// The objective: an expression, or `margin`.
    pub objective: String,
    /// Its value; of a margin, what is certified of it.
    pub value: Exact,
    /// The design's own certificate, for a margin with its bounds tightened by it; `null` if no
    /// separate proof was found within the budget.
    pub certificate: Option<CertificateFile>,
    /// Of a margin: what no design of the box has, if that was proved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bound: Option<MarginBound>,
}

/// A margin that no design of an atlas has.
#[derive(Clone, Debug, Serialize)]
pub struct MarginBound {
    /// The margin.
    pub value: Exact,
    /// The atlas with bounds tightened by it, all of which is refuted.
    pub certificate: CertificateFile,
}

impl BestDesign {
    /// How far the best may be from what was found, in words.
    fn gap(&self) -> String {
        let Some(bound) = &self.bound else {
            return "; no bound on the margins of other designs was proved".to_owned();
        };
        let ends = (bound.value.as_rational(), self.value.as_rational());
        let gap = match ends {
            (Some(bound), Some(value)) if value.is_positive() => {
                let gap = bound / value - BigRational::one();
                format!(" (gap {})", percent(&gap, 2, Toward::Above))
            }
            _ => String::new(),
        };
        format!("; no design of the box has {}{gap}", exact(&bound.value))
    }
}

/// A marked design.
#[derive(Clone, Debug, Serialize)]
pub struct MarkedDesign {
    /// Its name.
    pub label: String,
    /// Its parameters.
    pub at: Vec<Exact>,
    /// What the map says of it.
    pub verdict: Standing,
}

impl Part {
    /// The share in per cent.
    fn percent(&self, toward: Toward) -> String {
        self.share.as_rational().map_or_else(String::new, |share| percent(share, 4, toward))
    }

    fn text(&self, toward: Toward) -> String {
        let cells = counted(self.cells, "cell", "cells");
        format!("{} of the box ({}) in {cells}", self.percent(toward), self.share)
    }
}

impl AtlasReport {
    /// The first line.
    pub fn headline(&self) -> String {
        let name = Shown(self.title.as_deref().unwrap_or(&self.atlas));
        let proved = |part: &Part| part.percent(Toward::Below);
        let (certified, refuted) = (proved(&self.certified), proved(&self.refuted));
        format!("ATLAS  {name}: {certified} certified, {refuted} refuted")
    }

    /// A design's parameters.
    fn place(&self, at: &[Exact]) -> String {
        let value = |(p, x): (&Parameter, &Exact)| {
            let text = exact(x);
            // A fraction is told as a decimal, too.
            let about = approximate(x).filter(|_| text.contains('/'));
            let about =
                about.map_or_else(String::new, |x| format!(" (about {})", significant(x, 4)));
            format!("{} = {text}{about}", p.name)
        };
        self.parameters.iter().zip(at).map(value).collect::<Vec<_>>().join(", ")
    }

    /// Which parameters of the best design lie at an end of their range, where a wider map may have a
    /// better one.
    fn hint(&self, at: &[Exact]) -> Option<String> {
        let is_at_end = |(own, x): &(&Parameter, &Exact)| {
            let [least, greatest] = [&own.min, &own.max].map(approximate);
            let (Some(least), Some(greatest), Some(x)) = (least, greatest, approximate(x)) else {
                return false;
            };
            (x - least).min(greatest - x) <= AT_END * (greatest - least)
        };
        let all = self.parameters.iter().zip(at).filter(is_at_end);
        let names: Vec<&str> = all.map(|(own, _)| own.name.as_str()).collect();
        (!names.is_empty()).then(|| {
            format!(
                "the best design lies at the end of the range of {}: a wider map may have a better one",
                names.join(", ")
            )
        })
    }

    /// What the map says, in rows of a name and a text, without what depends on the run.
    pub fn facts(&self) -> Vec<(String, String)> {
        let mut facts = vec![
            ("certified".to_owned(), self.certified.text(Toward::Below)),
            ("refuted".to_owned(), self.refuted.text(Toward::Below)),
            ("undecided".to_owned(), self.undecided.text(Toward::Above)),
        ];
        if let Some(best) = &self.best {
            let (value, place) = (exact(&best.value), self.place(&best.at));
            let mut text = format!("{} {} = {value} at {place}", best.sense, best.objective);
            if best.objective == MARGIN {
                text += &best.gap();
            }
            facts.push(("best".to_owned(), text));
            facts.extend(self.hint(&best.at).map(|hint| ("hint".to_owned(), hint)));
        }
        for mark in &self.marks {
            let verdict = match mark.verdict {
                Standing::Certified => "certified",
                Standing::Refuted => "refuted",
                Standing::Undecided => "undecided",
                Standing::Outside => "outside of the map",
            };
            facts.push((mark.label.clone(), format!("{verdict}: {}", self.place(&mark.at))));
        }
        facts
    }

    /// The report for people.
    pub fn text(&self) -> String {
        let mut out = self.headline();
        out.push('\n');
        let meaning = "Every design of the certified cells meets every requirement, and every \
                       design of the refuted cells fails one. The proof of every cell was accepted \
                       by the exact checker.";
        wrap(&mut out, meaning, 0);
        out.push('\n');
        for (name, text) in self.facts() {
            labelled(&mut out, &name, &text);
        }
        out.push('\n');
        labelled(&mut out, "proof", &format!("{} in the trees of all cells", boxes(self.nodes)));
        file_line(&mut out, &self.certificate);
        let best = self.best.as_ref();
        let own = best.and_then(|best| best.certificate.as_ref()).map(|file| &file.path);
        let bound = best.and_then(|best| best.bound.as_ref()).map(|bound| &bound.certificate.path);
        for path in own.into_iter().chain(bound).chain(&self.files) {
            verbatim(&mut out, "", path);
        }
        let _ = writeln!(out, "  {:13} {} s", "time", significant(self.seconds, 3));
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_all_is_not_called_all() {
        let part = |share: &str| Part { cells: 2, share: Exact::parse(share, 1000).unwrap() };
        let most = part("65533/65536");
        assert_eq!(most.percent(Toward::Below), "99.99 %");
        assert_eq!(most.text(Toward::Below), "99.99 % of the box (65533/65536) in 2 cells");
        assert_eq!(part("3/65536").percent(Toward::Above), "0.004578 %");
        assert_eq!(part("1").percent(Toward::Below), "100 %");
    }
}
