//! What is enclosed, side by side, and the time of each.

use super::rows::{exact_rows, Row};
use super::Arguments;
use crate::cli::{interrupt, Failure};
use crate::report::{counterexample, Counterexample};
use crate::search::solver::enclose::{self, Enclosed, NotEnclosed, Sought};
use crate::search::solver::extremes::Extreme;
use crate::search::solver::sector;
use crate::search::{turns, Budget, Control};
use num_rational::BigRational;
use orthocert_kernel::claim as kernel;
use orthocert_kernel::machine::{Joint, Leg};
use orthocert_kernel::problem::Problem;
use std::time::Duration;

/// What is enclosed in one search.
enum Question {
    Extreme(Box<Extreme>),
    /// The least and the greatest angle of an arm of this leg.
    Angle(usize),
}

impl Question {
    /// In a few words.
    fn name(&self) -> String {
        match self {
            Question::Extreme(extreme) => format!("{} {}", extreme.end(), extreme.name()),
            Question::Angle(leg) => format!("rho_{}", leg + 1),
        }
    }

    /// A row for each end, and what the names of its files begin with.
    fn rows(&self, claim: &kernel::MachineClaim, angular: bool) -> Vec<(Row, String)> {
        match self {
            Question::Extreme(extreme) => {
                vec![(Row::of(claim, extreme, angular), extreme.file_stem())]
            }
            Question::Angle(leg) => {
                let row = |greatest| {
                    let row = Row::new(&format!("rho_{}", leg + 1), Some("deg"), greatest);
                    let stem = format!("rho-{}-{}", leg + 1, row.end);
                    (row, stem)
                };
                vec![row(false), row(true)]
            }
        }
    }

    /// The ends. With a limit of time the design's own bound is tried first, where it is asked for, in one of so many
    /// parts of it; without one, where nothing narrower is proved.
    fn ends(
        &self,
        (claim, relative): (&kernel::MachineClaim, &BigRational),
        required: Option<usize>,
        budget: Budget,
        control: &mut Control<'_>,
    ) -> Vec<Ended> {
        match self {
            Question::Extreme(extreme) => {
                let sought = match Sought::new(claim, extreme) {
                    Ok(sought) => sought,
                    Err(error) => return vec![Err(error)],
                };
                let (mut own, has_limit) = (Vec::new(), budget.deadline.is_some());
                if let Some(parts) = required.filter(|_| has_limit) {
                    own.push(sought.as_required(budget.shared(parts), control));
                }
                let sought = if budget.is_over() { sought } else { sought.nearer() };
                let found = sought.enclose(relative, budget, control);
                if !has_limit && matches!(found, Err(NotEnclosed::Undecided)) {
                    own.push(sought.as_required(budget, control));
                }
                narrower(own, vec![found])
            }
            Question::Angle(leg) => match sector::enclose(claim, *leg, relative, budget, control) {
                Ok(sector) => sector.into_ends().into(),
                Err(error) => vec![Err(error.clone()), Err(error)],
            },
        }
    }
}

type Ended = Result<Enclosed, NotEnclosed>;

/// How widely ends are enclosed, where all are.
fn width(ends: &[Ended]) -> Option<&BigRational> {
    let widths = ends.iter().map(|end| end.as_ref().ok().map(|end| &end.width));
    widths.collect::<Option<Vec<_>>>()?.into_iter().max()
}

/// The narrower ones.
fn narrower(before: Vec<Ended>, now: Vec<Ended>) -> Vec<Ended> {
    match (width(&before), width(&now)) {
        (Some(before_width), Some(now_width)) if now_width < before_width => now,
        (Some(_), _) => before,
        (None, _) => now,
    }
}

/// Whether with more time ends may be as narrow as is asked for.
fn want_more(ends: &[Ended], relative: &BigRational) -> bool {
    let is_wide = width(ends).is_none_or(|width| width > relative);
    is_wide && ends.iter().all(|end| matches!(end, Ok(_) | Err(NotEnclosed::Time)))
}

/// A question, and what was found of it.
struct Asked {
    question: Question,
    name: String,
    ends: Vec<Ended>,
    /// The time that it had.
    had: Duration,
    /// As soon as no more is looked for.
    rows: Option<Vec<Row>>,
}

/// The rows of the answer.
pub(super) fn rows(
    claim: &kernel::MachineClaim,
    relative: &BigRational,
    arguments: &Arguments,
    budget: Budget,
) -> Result<(Vec<Row>, Option<Counterexample>), Failure> {
    let problem = Problem::new(claim).map_err(Failure::input)?;
    let angular = problem.legs.iter().any(Leg::is_angular);
    let extremes = Extreme::of(claim, problem.legs.len()).into_iter();
    let turning = problem.legs.iter().enumerate();
    let turning = turning.filter(|(_, leg)| matches!(leg.rho, Some(Joint::Angle { .. })));
    let questions = extremes.map(|extreme| Question::Extreme(Box::new(extreme)));
    let questions: Vec<Question> =
        questions.chain(turning.map(|(leg, _)| Question::Angle(leg))).collect();
    let mut bar = arguments.effort.bar();
    let count = questions.len();
    let own = budget.shared(turns(count) + 1);
    let singular =
        bar.run("singularities", count + 1, |control| enclose::singular(claim, own, control))?;
    let asked = |(number, question): (usize, Question)| {
        let name = format!("{} of {count}, {}", number + 1, question.name());
        Asked { question, name, ends: Vec::new(), had: Duration::ZERO, rows: None }
    };
    let mut all: Vec<Asked> = questions.into_iter().enumerate().map(asked).collect();
    let error = || match (&singular, interrupt::is_cancelled()) {
        (Some(_), _) => Some(NotEnclosed::Singular),
        (None, true) => Some(NotEnclosed::Cancelled),
        (None, false) => None,
    };
    let told = |question: &Question, ends: &[Ended]| {
        let rows = question.rows(claim, angular).into_iter().zip(ends.iter().cloned());
        let told =
            |((row, stem), end): ((Row, String), Ended)| row.found(&stem, end, relative, arguments);
        rows.map(told).collect::<Result<Vec<Row>, Failure>>()
    };
    let mut asked: Vec<usize> = (0..all.len()).collect();
    let mut is_first = true;
    while !asked.is_empty() && (is_first || !interrupt::is_cancelled()) {
        let names: Vec<String> = asked.iter().map(|&at| all[at].name.clone()).collect();
        let later = usize::from(is_first && budget.deadline.is_some());
        let found = bar.at_once(&names, later, |number, turns, control| -> Result<_, Failure> {
            let Asked { question, ends, .. } = &all[asked[number]];
            let budget = budget.shared(turns - later);
            let share = budget.left().unwrap_or_default();
            if !is_first && budget.is_over() {
                return Ok((ends.clone(), share, None));
            }
            let now = match error() {
                Some(error) => {
                    question.rows(claim, angular).iter().map(|_| Err(error.clone())).collect()
                }
                None => {
                    let required = match (is_first, width(ends)) {
                        (true, _) => Some(3),
                        (false, None) => Some(1),
                        (false, Some(_)) => None,
                    };
                    question.ends((claim, relative), required, budget, control)
                }
            };
            let ends = narrower(ends.clone(), now);
            let rows = match budget.is_over() && want_more(&ends, relative) {
                true => None,
                false => Some(told(question, &ends)?),
            };
            Ok((ends, share, rows))
        });
        for (&at, found) in asked.iter().zip(found) {
            let own = &mut all[at];
            let (ends, had, rows) = found?;
            (own.ends, own.had, own.rows) = (ends, had.max(own.had), rows);
        }
        is_first = false;
        asked = with_more_time(&all, budget);
    }
    let mut rows = exact_rows(claim);
    for Asked { question, ends, rows: own, .. } in all {
        rows.extend(own.map_or_else(|| told(&question, &ends), Ok)?);
    }
    Ok((rows, singular.as_deref().and_then(counterexample)))
}

/// Those whose time was up and which can have twice that of what is left, or half of it if they are not enclosed: first
/// these, then the widest.
fn with_more_time(all: &[Asked], budget: Budget) -> Vec<usize> {
    let mut asked: Vec<usize> = (0..all.len()).filter(|&at| all[at].rows.is_none()).collect();
    asked.sort_by(|&a, &b| match (width(&all[a].ends), width(&all[b].ends)) {
        (Some(a), Some(b)) => b.cmp(a),
        (a, b) => a.is_some().cmp(&b.is_some()),
    });
    loop {
        let share = budget.shared(turns(asked.len())).left().unwrap_or_default();
        let is_enough = |at: &usize| {
            let Asked { ends, had, .. } = &all[*at];
            !share.is_zero() && share >= if width(ends).is_some() { 2 * *had } else { *had / 2 }
        };
        match asked.iter().filter(|at| is_enough(at)).count() {
            enough if enough == asked.len() => return asked,
            // Without some, or else the last, there is more for the others.
            0 => drop(asked.pop()),
            _ => asked.retain(is_enough),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orthocert_checker::certificate::Certificate;
    use std::time::Instant;

    fn end(width: i64) -> Ended {
        let number = |n: i64| BigRational::from_integer(n.into());
        let text = include_str!("../../../proofs/certificates/orthoglide-prototype.cert.json");
        let certified = Box::new(Certificate::read(text).unwrap());
        let (width, inner, outer) = (number(width), number(1), number(1 + width));
        Ok(Enclosed { width, inner, outer, refuted: None, certified, boxes: 0 })
    }

    #[test]
    fn the_narrower_ends_stay_and_wide_ones_want_more() {
        let time = || Err(NotEnclosed::Time);
        let widest = |ends: &[Ended]| width(ends).and_then(num_traits::ToPrimitive::to_f64);
        let kept = |before: Vec<Ended>, now: Vec<Ended>| widest(&narrower(before, now));
        assert_eq!(kept(vec![], vec![end(5)]), Some(5.0));
        assert_eq!(kept(vec![end(5)], vec![end(3)]), Some(3.0));
        assert_eq!(kept(vec![end(3)], vec![end(5)]), Some(3.0));
        assert_eq!(kept(vec![end(3)], vec![time()]), Some(3.0));
        assert_eq!(kept(vec![end(3), time()], vec![end(5), end(4)]), Some(5.0));
        let asked = BigRational::from_integer(3.into());
        assert!(!want_more(&[end(3)], &asked) && want_more(&[end(4)], &asked));
        assert!(want_more(&[end(1), time()], &asked));
        assert!(!want_more(&[end(4), Err(NotEnclosed::Undecided)], &asked));
    }

    #[test]
    fn those_have_more_time_that_can_have_more_than_they_had() {
        let asked = |ends: Vec<Ended>, had| Asked {
            question: Question::Angle(0),
            name: String::new(),
            ends,
            had: Duration::from_secs(had),
            rows: None,
        };
        let all = [
            asked(vec![end(2)], 1),
            asked(vec![end(9)], 1),
            asked(vec![Err(NotEnclosed::Time)], 60),
        ];
        let with = |seconds| {
            let deadline = Some(Instant::now() + Duration::from_secs(seconds));
            with_more_time(&all, Budget { max_boxes: 1, deadline })
        };
        assert_eq!(with(3600), [2, 1, 0]);
        assert_eq!(with(50), [1, 0]);
        assert!(with(0).is_empty() && with(1).is_empty());
        let none = Budget { max_boxes: 1, deadline: None };
        assert!(with_more_time(&all, none).is_empty());
    }
}
