//! The search, on families whose verdicts are known.

use super::search::between;
use super::*;
use orthocert_checker::certificate::Verdict::{Certified, Refuted};
use std::time::Duration;

/// Verdicts by value; `None` where it is undecided. Admissible are values between the ends.
struct Known<V> {
    verdict: V,
    ends: (i64, i64),
    tried: Vec<BigRational>,
    /// Values after which it is cancelled.
    most: usize,
    /// The share that was done when the last value was asked for.
    done: f64,
}

impl<V: Fn(&BigRational) -> Option<Verdict>> Family for Known<V> {
    type Claim = BigRational;
    type Proof = BigRational;

    fn claim(&self, value: &BigRational) -> Result<BigRational, String> {
        let (least, greatest) = (number(self.ends.0, 1), number(self.ends.1, 1));
        if least < *value && *value < greatest {
            Ok(value.clone())
        } else {
            Err(format!("{value} is out"))
        }
    }

    fn decide(
        &mut self,
        x: &BigRational,
        [from, to]: [f64; 2],
        _: Option<Instant>,
    ) -> Result<Option<(Verdict, BigRational)>, NoAnswer> {
        assert!(self.done <= from && from <= to && to <= 1.0, "{} {from} {to}", self.done);
        self.done = from;
        if self.tried.len() == self.most {
            return Err(NoAnswer::Cancelled);
        }
        self.tried.push(x.clone());
        Ok((self.verdict)(x).map(|verdict| (verdict, x.clone())))
    }
}

fn number(p: i64, q: i64) -> BigRational {
    BigRational::new(p.into(), q.into())
}

const BOTH: [Direction; 2] = [Direction::Down, Direction::Up];

/// The limits from an own value, and how many values were tried.
fn found(
    own: BigRational,
    directions: &[Direction],
    verdict: impl Fn(&BigRational) -> Option<Verdict>,
) -> (Question, Vec<Limit<BigRational>>, usize) {
    let size = if own == number(0, 1) { number(50, 1) } else { own.abs() };
    let (gap, directions) = (number(1, 1_000_000), directions.to_vec());
    let question = Question { own, size, gap, directions, deadline: None };
    let mut family = Known {
        verdict,
        ends: (-100_000, 100_000),
        tried: Vec::new(),
        most: usize::MAX,
        done: 0.0,
    };
    let start = family.decide(&question.own, [0.0, 1.0], None).unwrap();
    let limits = limits(&question, start, &mut family).unwrap();
    for limit in &limits {
        for (end, verdict) in [(&limit.certified, Certified), (&limit.refuted, Refuted)] {
            let Some(end) = end else { continue };
            // What is reported is what was decided, of that very value.
            assert_eq!((&end.proof, end.verdict), (&end.value, verdict));
            assert_eq!((family.verdict)(&end.value), Some(verdict));
        }
        if let (Some(certified), Some(refuted)) = (&limit.certified, &limit.refuted) {
            let upper = certified.value < refuted.value;
            assert_eq!(limit.side, if upper { Side::Upper } else { Side::Lower });
        }
    }
    (question, limits, family.tried.len())
}

fn certified_between(a: BigRational, b: BigRational) -> impl Fn(&BigRational) -> Option<Verdict> {
    move |x| Some(if a <= *x && *x <= b { Certified } else { Refuted })
}

fn is_about(limit: &Limit<BigRational>, x: &BigRational) -> bool {
    let (certified, refuted) = (limit.certified.as_ref(), limit.refuted.as_ref());
    let (a, b) = (&certified.unwrap().value, &refuted.unwrap().value);
    a.min(b) <= x && x <= a.max(b)
}

#[test]
fn both_limits_of_a_certified_value_are_found() {
    for own in [number(312, 1), number(1, 3), number(-73, 1), number(0, 1)] {
        let size = if own == number(0, 1) { number(50, 1) } else { own.abs() };
        for (below, above) in [(3, 7000), (999, 1), (1, 999)] {
            let low = &own - &size * number(below, 1000);
            let high = &own + &size * number(above, 1000);
            let verdict = certified_between(low.clone(), high.clone());
            let (question, limits, tried) = found(own.clone(), &BOTH, verdict);
            let [lower, upper] = &limits[..] else { panic!("{limits:?}") };
            assert!(is_about(lower, &low) && is_about(upper, &high), "{limits:?}");
            assert!(limits.iter().all(|l| question.is_reached(l) && !question.is_open(l)));
            assert!(tried < 100, "{tried}");
        }
    }
}

#[test]
fn from_a_refuted_value_the_certified_ones_are_looked_for() {
    let (low, high) = (number(314, 1), number(400, 1));
    let verdict = certified_between(low.clone(), high.clone());
    let (question, limits, _) = found(number(312, 1), &BOTH, &verdict);
    let [lower, other] = &limits[..] else { panic!("{limits:?}") };
    assert!(is_about(lower, &low) && question.is_reached(lower), "{lower:?}");
    assert!(other.certified.is_none() && other.refuted.is_some() && !question.is_open(other));
    let (_, limits, _) = found(number(500, 1), &[Direction::Down], &verdict);
    let [upper] = &limits[..] else { panic!("{limits:?}") };
    assert!(is_about(upper, &high) && upper.side == Side::Upper, "{upper:?}");
}

#[test]
fn what_is_undecided_narrows_nothing() {
    // Certified up to 10, refuted from 11, undecided between.
    let verdict = |x: &BigRational| {
        if *x <= number(10, 1) {
            Some(Certified)
        } else {
            (*x >= number(11, 1)).then_some(Refuted)
        }
    };
    let (question, limits, _) = found(number(9, 1), &[Direction::Up], verdict);
    let [limit] = &limits[..] else { panic!("{limits:?}") };
    assert!(!question.is_reached(limit) && question.is_open(limit));
    let near = |end: &Option<Decided<BigRational>>, x: i64| {
        let value = &end.as_ref().unwrap().value;
        question.distance(value, &number(x, 1)) <= question.gap
    };
    assert!(near(&limit.certified, 10) && near(&limit.refuted, 11), "{limit:?}");
    let [first, last] = limit.undecided.as_ref().unwrap();
    assert!(number(10, 1) < *first && first < last && *last < number(11, 1));
}

#[test]
fn about_an_undecided_value_both_verdicts_are_found() {
    let verdict = |x: &BigRational| match x.cmp(&number(2, 1)) {
        std::cmp::Ordering::Less => Some(Refuted),
        std::cmp::Ordering::Equal => None,
        std::cmp::Ordering::Greater => Some(Certified),
    };
    let (question, limits, _) = found(number(2, 1), &BOTH, verdict);
    let [lower, upward] = &limits[..] else { panic!("{limits:?}") };
    assert!(is_about(lower, &number(2, 1)) && question.is_reached(lower), "{lower:?}");
    assert!(lower.direction.is_none() && !question.is_open(lower));
    assert!(upward.refuted.is_none() && upward.certified.is_some());
}

#[test]
fn where_all_is_undecided_that_is_what_is_found() {
    let (question, limits, _) = found(number(2, 1), &BOTH, |_| None);
    assert_eq!(limits.len(), 2);
    for limit in &limits {
        assert!(limit.certified.is_none() && limit.refuted.is_none() && question.is_open(limit));
    }
}

#[test]
fn verdicts_need_not_be_monotone() {
    // Certified again beyond a refuted stretch that a step meets: the nearest limit is found.
    let verdict = |x: &BigRational| {
        let hole = number(12, 1) <= *x && *x <= number(20, 1);
        Some(if hole { Refuted } else { Certified })
    };
    let (question, limits, _) = found(number(10, 1), &[Direction::Up], verdict);
    let [limit] = &limits[..] else { panic!("{limits:?}") };
    assert!(is_about(limit, &number(12, 1)) && question.is_reached(limit), "{limit:?}");
}

#[test]
fn the_search_ends_where_there_is_no_claim() {
    let (question, limits, _) = found(number(90_000, 1), &BOTH, |_| Some(Certified));
    for (limit, end) in limits.iter().zip([-100_000, 100_000]) {
        let certified = &limit.certified.as_ref().unwrap().value;
        let out = limit.end.as_ref().unwrap();
        // The last value with a claim and the first without one are beside each other.
        assert!(certified.abs() < number(100_000, 1) && out.value.abs() >= number(100_000, 1));
        assert!(question.distance(certified, &number(end, 1)) <= question.gap, "{certified}");
        assert_eq!(out.reason, format!("{} is out", out.value));
        assert!(!question.is_open(limit));
    }
}

#[test]
fn the_verdict_may_change_at_the_last_value_with_a_claim() {
    let verdict = |x: &BigRational| Some(if *x < number(99_990, 1) { Certified } else { Refuted });
    let (question, limits, _) = found(number(90_000, 1), &[Direction::Up], verdict);
    assert!(is_about(&limits[0], &number(99_990, 1)) && question.is_reached(&limits[0]));
    assert!(limits[0].end.is_some());
}

#[test]
fn without_time_nothing_is_tried() {
    let size = number(1, 1);
    let question = Question {
        own: size.clone(),
        size,
        gap: number(1, 10),
        directions: BOTH.to_vec(),
        deadline: Some(Instant::now()),
    };
    let verdict = |_: &BigRational| Some(Certified);
    let mut family =
        Known { verdict, ends: (0, 10), tried: Vec::new(), most: usize::MAX, done: 0.0 };
    let own = Some((Certified, number(1, 1)));
    let limits = limits(&question, own, &mut family).unwrap();
    assert!(family.tried.is_empty());
    assert!(limits.iter().all(|limit| limit.out_of_time && question.is_open(limit)));
}

/// Neither direction takes the time of the other, and what one leaves is the other's.
#[test]
fn directions_share_the_time() {
    struct Timed {
        begin: Instant,
        asked: Vec<(BigRational, Duration)>,
        /// Whether the first value takes all of its share.
        is_slow: bool,
    }
    impl Family for Timed {
        type Claim = BigRational;
        type Proof = ();
        fn claim(&self, value: &BigRational) -> Result<BigRational, String> {
            Ok(value.clone())
        }
        fn decide(
            &mut self,
            x: &BigRational,
            _: [f64; 2],
            deadline: Option<Instant>,
        ) -> Result<Option<(Verdict, ())>, NoAnswer> {
            let deadline = deadline.unwrap();
            self.asked.push((x.clone(), deadline.duration_since(self.begin)));
            if std::mem::take(&mut self.is_slow) {
                std::thread::sleep(deadline.saturating_duration_since(Instant::now()));
                return Ok(None);
            }
            Ok(Some((Certified, ())))
        }
    }
    let searched = |whole: Duration, is_slow: bool| {
        let (begin, own) = (Instant::now(), number(5, 1));
        let (size, gap) = (own.clone(), number(1, 1_000_000));
        let (directions, deadline) = (BOTH.to_vec(), Some(begin + whole));
        let question = Question { own: own.clone(), size, gap, directions, deadline };
        let mut family = Timed { begin, asked: Vec::new(), is_slow };
        let found = limits(&question, Some((Certified, ())), &mut family).unwrap();
        let (down, up): (Vec<_>, Vec<_>) = family.asked.into_iter().partition(|(x, _)| *x < own);
        (down, up, found)
    };
    let whole = Duration::from_secs(1000);
    let half = whole / 2 + Duration::from_secs(60);
    let (down, up, _) = searched(whole, false);
    assert!(down.len() > 1 && down.iter().all(|(_, share)| *share <= half));
    assert!(up.len() > 1 && up.iter().all(|(_, share)| *share > half));
    // What took all of its share is not undecided before it has had the rest, too.
    let (down, up, found) = searched(Duration::from_secs(2), true);
    assert!(down[0].0 == down[1].0 && !up.is_empty());
    assert!(found.iter().all(|limit| limit.undecided.is_none()), "{found:?}");
}

#[test]
fn values_are_short_decimals_well_between() {
    for (a, b, text) in [
        (number(0, 1), number(100, 1), "50"),
        (number(-3, 1), number(4, 1), "0"),
        (number(312, 1), number(311, 1), "311.5"),
        (number(1, 3), number(2, 3), "0.5"),
        (number(-1, 1_000_000), number(-2, 1_000_000), "-0.0000015"),
    ] {
        let value = between(&a, &b);
        assert_eq!(crate::exact::decimal::terminating(&value, 40).as_deref(), Some(text));
        let part = (&value - &a) / (&b - &a);
        assert!(number(1, 4) <= part && part <= number(3, 4), "{value}");
    }
}

#[test]
fn a_witness_of_the_kernel_has_its_requirement_and_its_place() {
    use crate::search::solver::certificate;
    use orthocert_checker::certificate::Proof;
    use orthocert_kernel::certificate::Claim;
    use orthocert_kernel::certificate::{self as kernel, Failure};
    use orthocert_kernel::number::Expression;

    let leg = |direction: &str, length: &str| {
        format!(
            r#"{{"drive":"slider","direction":[{direction}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":{length},"mode":"+"}}"#
        )
    };
    let legs = [
        leg(r#""1","0","0""#, r#"{"min":"310","max":"311"}"#),
        leg(r#""0","1","0""#, r#""310""#),
        leg(r#""0","0","1""#, r#""310""#),
    ]
    .join(",");
    let claim = format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["-72","-72","-72"],"max":["125","125","125"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"1.96"}}]}}"#
    );
    let claim = Claim::Machine(serde_json::from_str(&claim).unwrap());
    let number = |text: &str| Expression::try_from(text.to_owned()).unwrap();
    let place = |fails: Failure| {
        let witness = kernel::Witness {
            precision: 96,
            point: ["125", "125", "125/2"].map(number).to_vec(),
            machine: vec![number("310")],
            fails,
        };
        let proof = Proof::Witness(witness);
        Place::of(&certificate(claim.clone(), Refuted, proof)).unwrap()
    };
    let found = place(Failure::Obligation(0, vec![vec![1, -1, 0]]));
    assert_eq!(found.violated, "greatest psi <= 1.96");
    assert_eq!(found.point, ["125", "125", "62.5"]);
    assert_eq!(
        found.machine.into_iter().collect::<Vec<_>>(),
        [("leg 1 length".into(), "310".into())]
    );
    let singular = place(Failure::Singular(["0", "0", "0"].map(number).to_vec()));
    assert_eq!(singular.other_point, ["0", "0", "0"]);
    assert_eq!(
        place(Failure::Reach).violated,
        "every leg reaches P and is not serially singular there"
    );
    // What is certified, or no witness, has no place.
    let tree = kernel::Tree { precision: 96, chords: None, nodes: Vec::new() };
    let proof = Proof::Tree(tree);
    assert_eq!(Place::of(&certificate(claim.clone(), Certified, proof)), None);
}

#[test]
fn shortest_decimals_have_no_digit_too_many() {
    for (min, max, text) in [
        (number(1, 3), number(1, 2), "0.4"),
        (number(95, 1), number(105, 1), "100"),
        (number(99, 1), number(101, 1), "100"),
        (number(-7, 1), number(1, 1), "0"),
        (number(311, 1), number(312, 1), "311"),
        (number(12_345, 1000), number(12_346, 1000), "12.345"),
    ] {
        let value = crate::exact::decimal::shortest(&min, &max);
        let found = crate::exact::decimal::terminating(&value, 40).unwrap();
        assert!(min <= value && value <= max, "{found}");
        assert!(found.len() <= text.len(), "{found} {text}");
    }
}

/// What is found before is told, whenever it is cancelled, and is open.
#[test]
fn cancelled_it_has_what_was_found_before() {
    let own = number(5, 1);
    let verdict = |x: &BigRational| Some(if *x <= number(10, 1) { Certified } else { Refuted });
    let directions = vec![Direction::Up];
    let (size, gap) = (number(5, 1), number(1, 1_000_000));
    let question = Question { own, size, gap, directions, deadline: None };
    let of = |most| {
        let (ends, tried) = ((-100_000, 100_000), Vec::new());
        let mut family = Known { verdict, ends, tried, most, done: 0.0 };
        let start = family.decide(&question.own, [0.0, 0.1], None).unwrap();
        let limit = limits(&question, start, &mut family).unwrap().remove(0);
        (limit, family.tried)
    };
    let all = of(usize::MAX).1.len();
    for most in 1..all {
        let (limit, tried) = of(most);
        let best = tried.iter().filter(|x| verdict(x) == Some(Certified)).max();
        assert_eq!(limit.certified.as_ref().map(|end| &end.value), best);
        let least = tried.iter().filter(|x| verdict(x) == Some(Refuted)).min();
        assert_eq!(limit.refuted.as_ref().map(|end| &end.value), least);
        assert!(limit.out_of_time && limit.undecided.is_none() && question.is_open(&limit));
    }
    assert!(!of(all).0.out_of_time);
}
