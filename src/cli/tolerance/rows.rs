//! The rows of an answer: what each widens, their search side by side, and what they tell.

use super::Arguments;
use crate::cli::certify;
use crate::cli::certify::Unwritten;
use crate::cli::ends::{explain, gap_text};
use crate::cli::progress::Bar;
use crate::cli::{interrupt, Failure};
use crate::design::Design;
use crate::exact::Exact;
use crate::questions::frontier::Bracket;
use crate::questions::tolerance::{refuted_by, widest, Kind, Known, Scheme};
use crate::report::{counterexample, CertificateFile, Counterexample};
use crate::search::{turns, Budget};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert_kernel::claim::MachineClaim;
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// So much of each kind's own part is proved soon.
const EASY: f64 = 0.5;

/// What a row's number is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Measure {
    /// A length, in the design's unit.
    Length,
    /// A direction's component.
    Component,
    /// A part of each kind's own certified tolerance.
    Share,
}

/// A row for scripts.
#[derive(Serialize)]
pub(super) struct Row {
    pub(super) on: Vec<&'static str>,
    /// The leg whose parameters these are, counted from one; else those of all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) leg: Option<usize>,
    pub(super) measure: Measure,
    /// For [`Measure::Share`]: the tolerance of each kind at share 1.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) weights: BTreeMap<&'static str, Exact>,
    /// The widest tolerance that was certified.
    pub(super) certified: Option<Exact>,
    /// The narrowest that was refuted.
    pub(super) refuted: Option<Exact>,
    /// `refuted/certified - 1`, rounded up.
    pub(super) gap: Option<String>,
    pub(super) gap_reached: bool,
    /// Whether the row's time, or that of one of its proofs, was up before the search for it ended.
    pub(super) out_of_time: bool,
    /// The machine and the point of the refutation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) counterexample: Option<Counterexample>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) certificates: Vec<CertificateFile>,
    #[serde(skip)]
    pub(super) unwritten: Unwritten,
}

/// What is asked of every row.
pub(super) struct Question<'a> {
    pub(super) claim: &'a MachineClaim,
    /// The gap.
    pub(super) width: f64,
    /// The time of each.
    pub(super) each: Option<Duration>,
    pub(super) budget: Budget,
    pub(super) arguments: &'a Arguments,
    pub(super) design: &'a Design,
}

/// The time of rows that are searched for at once.
struct Time {
    budget: Budget,
    /// The turns after them.
    after: usize,
    /// Each has half of what is left, in place of its share.
    halves: bool,
}

/// What a row widens and tells, and what is known of it.
struct Asked {
    scheme: Scheme,
    measure: Measure,
    known: Known,
    /// As soon as it was begun.
    row: Option<Row>,
}

impl Asked {
    fn new(scheme: Scheme, measure: Measure) -> Self {
        Asked { scheme, measure, known: Known::default(), row: None }
    }

    /// The widest tolerance that is certified.
    fn certified(&self) -> Option<&BigRational> {
        self.known.ends.certified.as_ref().map(|(t, _)| t)
    }

    /// The narrowest that is refuted.
    fn refuted(&self) -> Option<&BigRational> {
        self.known.ends.refuted.as_ref().map(|(t, _)| t)
    }
}

impl Question<'_> {
    /// The rows; interrupted, those that were begun.
    pub(super) fn rows(&self, kinds: &[Kind], legs: usize) -> Result<Vec<Row>, Failure> {
        let bar = &mut self.arguments.effort.bar();
        let of_legs = turns(kinds.len() * legs);
        let after = turns(usize::from(mixed(kinds))) + of_legs;
        let mut all = schemes(kinds);
        let every: Vec<usize> = (0..all.len()).collect();
        let time = self.budget.left();
        self.search(bar, (&mut all, &every), Time { budget: self.budget, after, halves: false })?;
        self.refuted_with_one_kind(all.split_at_mut(kinds.len()))?;
        // What time the others left, but for that of those after them, is for those whose time was up, first for those of
        // which least is known: half of what is left each, for what is not proved in as much as before wants more.
        let own = turns(all.len());
        let of_rest = time.map(|time| time.mul_f64(after as f64 / (own + after) as f64));
        let deadline =
            self.budget.deadline.zip(of_rest).and_then(|(end, rest)| end.checked_sub(rest));
        let budget = Budget { deadline, ..self.budget };
        let mut improved = self.each.is_none();
        while std::mem::take(&mut improved) && !budget.is_over() {
            let is_short = |asked: &Asked| {
                asked.known.ends.out_of_time && !asked.known.ends.reaches(self.width)
            };
            let mut short = every.clone();
            short.retain(|&at| is_short(&all[at]));
            short.sort_by_key(|&at| all[at].certified().is_some());
            let time = Time { budget, after, halves: true };
            improved = self.search(bar, (&mut all, &short), time)?;
        }
        self.refuted_with_one_kind(all.split_at_mut(kinds.len()))?;
        let weights = kinds.iter().zip(&all);
        let weights = weights.filter_map(|(kind, asked)| Some((*kind, asked.certified()?.clone())));
        let weights: Vec<_> = weights.collect();
        if mixed(kinds) && weights.len() == kinds.len() {
            // A machine that fails with one kind is among those of all; and what is lost adds up over kinds, about.
            let of_kind = |asked: &Asked| (asked.refuted()? / asked.certified()?).to_f64();
            let shares = all[..kinds.len()].iter().filter_map(of_kind);
            let refuted = shares.min_by(f64::total_cmp);
            let certified = Some(EASY / kinds.len() as f64);
            let known = Known { refuted, certified, ..Known::default() };
            let share = Asked::new(Scheme { weights, leg: None }, Measure::Share);
            let mut share = [Asked { known, ..share }];
            let time = Time { budget: self.budget, after: of_legs, halves: false };
            self.search(bar, (&mut share, &[0]), time)?;
            all.extend(share);
        }
        let of_leg = |(kind, of_all, leg): (&Kind, &Asked, usize)| {
            let scheme = Scheme { leg: Some(leg), ..Scheme::common(&[*kind]) };
            let refuted = of_all.refuted().and_then(BigRational::to_f64);
            let known = Known { refuted, ..Known::default() };
            Asked { known, ..Asked::new(scheme, measure(kind.is_direction())) }
        };
        let pairs = kinds.iter().zip(&all);
        let pairs = pairs.flat_map(|(kind, of_all)| (0..legs).map(move |leg| (kind, of_all, leg)));
        let mut by_leg: Vec<Asked> = pairs.map(of_leg).collect();
        let every: Vec<usize> = (0..by_leg.len()).collect();
        let time = Time { budget: self.budget, after: 0, halves: false };
        self.search(bar, (&mut by_leg, &every), time)?;
        // The leg that allows least first.
        for of_kind in by_leg.chunks_mut(legs.max(1)) {
            of_kind.sort_by_key(|asked| asked.certified().cloned().unwrap_or_default());
        }
        let rows: Vec<Row> = all.into_iter().chain(by_leg).filter_map(|asked| asked.row).collect();
        match rows.is_empty() {
            true => interrupt::unless_cancelled(rows),
            false => Ok(rows),
        }
    }

    /// What fails with one kind alone fails with several at once, where the machine is among these.
    fn refuted_with_one_kind(
        &self,
        (alone, common): (&mut [Asked], &mut [Asked]),
    ) -> Result<(), Failure> {
        for asked in common.iter_mut().filter(|asked| asked.row.is_some()) {
            let kinds: Vec<Kind> = asked.scheme.weights.iter().map(|(kind, _)| *kind).collect();
            let is_of =
                |one: &&Asked| one.scheme.weights.iter().all(|(kind, _)| kinds.contains(kind));
            let all = alone.iter().filter(is_of).filter_map(|one| one.known.ends.refuted.as_ref());
            let least = all.min_by(|a, b| a.0.cmp(&b.0));
            let nearer = least.filter(|(t, _)| asked.refuted().is_none_or(|own| t < own));
            let refuted = nearer.and_then(|one| refuted_by(self.claim, &asked.scheme, one));
            if refuted.is_some() {
                let Asked { scheme, measure, known, row: told } = asked;
                known.ends.refuted = refuted;
                *told = Some(row(scheme, *measure, &known.ends, self.width, self.arguments)?);
            }
        }
        Ok(())
    }

    /// Searches for some of these. Whether of one a wider tolerance is certified than was before.
    fn search(
        &self,
        bar: &mut Bar,
        (all, which): (&mut [Asked], &[usize]),
        Time { budget, after, halves }: Time,
    ) -> Result<bool, Failure> {
        let names: Vec<String> = which.iter().map(|&at| words(&all[at].scheme)).collect();
        let own = &*all;
        let found: Vec<Result<_, Failure>> =
            bar.at_once(&names, after, |number, turns, control| {
                let Asked { scheme, measure, known, row: before } = &own[which[number]];
                if interrupt::is_cancelled() || (before.is_some() && budget.is_over()) {
                    return Ok(None);
                }
                let own = self.each.and_then(|each| Instant::now().checked_add(each));
                let shared = budget.shared(if halves { 2 } else { turns }).deadline;
                let deadline = [shared, own].into_iter().flatten().min();
                let budget = Budget { deadline, ..self.budget };
                let found = widest(self.claim, scheme, self.width, known.clone(), budget, control)
                    .map_err(|error| explain(error, self.design))?;
                let row = row(scheme, *measure, &found, self.width, self.arguments)?;
                Ok(Some((found, row)))
            });
        let mut improved = false;
        for (&at, found) in which.iter().zip(found) {
            let Some((known, row)) = found? else { continue };
            let before = all[at].certified().cloned();
            (all[at].known.ends, all[at].row) = (known, Some(row));
            improved |= all[at].certified() != before.as_ref();
        }
        Ok(improved)
    }
}

fn mixed(kinds: &[Kind]) -> bool {
    kinds.iter().any(|kind| kind.is_direction()) && kinds.iter().any(|kind| !kind.is_direction())
}

/// What a scheme widens.
fn words(scheme: &Scheme) -> String {
    let names: Vec<&str> = scheme.weights.iter().map(|(kind, _)| kind.name()).collect();
    let of = scheme.leg.map_or(String::new(), |leg| format!(" of leg {}", leg + 1));
    names.join(", ") + &of
}

fn measure(direction: bool) -> Measure {
    if direction {
        Measure::Component
    } else {
        Measure::Length
    }
}

/// Every kind alone, then all lengths and all directions by a common tolerance.
fn schemes(kinds: &[Kind]) -> Vec<Asked> {
    let alone = |kind: &Kind| Asked::new(Scheme::common(&[*kind]), measure(kind.is_direction()));
    let mut all: Vec<Asked> = kinds.iter().map(alone).collect();
    for direction in [false, true] {
        let same: Vec<Kind> =
            kinds.iter().copied().filter(|kind| kind.is_direction() == direction).collect();
        if same.len() > 1 {
            all.push(Asked::new(Scheme::common(&same), measure(direction)));
        }
    }
    all
}

fn row(
    scheme: &Scheme,
    measure: Measure,
    found: &Bracket,
    width: f64,
    arguments: &Arguments,
) -> Result<Row, Failure> {
    let names: Vec<&'static str> = scheme.weights.iter().map(|(kind, _)| kind.name()).collect();
    let stem = match (&names[..], measure) {
        ([name], _) => (*name).to_owned(),
        (_, Measure::Length) => "lengths".to_owned(),
        (_, Measure::Component) => "directions".to_owned(),
        (_, Measure::Share) => "all".to_owned(),
    };
    let stem = match scheme.leg {
        Some(leg) => format!("{stem}-{}", leg + 1),
        None => stem,
    };
    let (mut certificates, mut unwritten) = (Vec::new(), Unwritten::default());
    if let Some(folder) = &arguments.output {
        for (end, side) in [(&found.certified, "certified"), (&found.refuted, "refuted")] {
            if let Some((_, certificate)) = end {
                let path = folder.join(format!("tolerance-{stem}-{side}.cert.json"));
                let written = certify::write(Some(folder), &path, certificate);
                certificates.extend(unwritten.unless(written));
            }
        }
    }
    let counterexample =
        found.refuted.as_ref().and_then(|(_, certificate)| counterexample(certificate));
    let weights = match measure {
        Measure::Share => scheme
            .weights
            .iter()
            .map(|(kind, weight)| (kind.name(), Exact::Rational(weight.clone())))
            .collect(),
        _ => BTreeMap::new(),
    };
    let end =
        |end: &Option<(BigRational, _)>| end.as_ref().map(|(t, _)| Exact::Rational(t.clone()));
    let reached = found.gap();
    Ok(Row {
        on: names,
        leg: scheme.leg.map(|leg| leg + 1),
        measure,
        weights,
        certified: end(&found.certified),
        refuted: end(&found.refuted),
        gap: reached.as_ref().map(gap_text),
        gap_reached: found.reaches(width),
        out_of_time: found.out_of_time,
        counterexample,
        certificates,
        unwritten,
    })
}
