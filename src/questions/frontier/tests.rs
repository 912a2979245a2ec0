//! Frontiers, and values that are come near to.

use super::*;
use crate::search::Progress;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

const WALK: Walk = Walk {
    start: 1.0,
    succeeds: Succeeds::Below,
    factor: 10.0,
    most: LARGEST_FACTOR,
    enough: None,
    limits: (1e-12, 1e12),
    gap: 1e-6,
    deadline: None,
};

fn found(walk: Walk, succeeds: impl Fn(f64) -> bool) -> Option<f64> {
    let test = |x: &BigRational, _: &mut Control<'_>| Ok(x.to_f64().filter(|x| succeeds(*x)));
    let cancel = AtomicBool::new(false);
    let mut shares = Vec::new();
    let mut note = |now: Progress| shares.push(now.share);
    let found = frontier(&walk, &mut Control { cancel: &cancel, progress: &mut note }, test);
    assert!(shares.is_sorted() && shares.iter().all(|x| (0.0..=1.0).contains(x)), "{shares:?}");
    found.unwrap().map(|(value, seen)| {
        assert_eq!(value.to_f64(), Some(seen));
        seen
    })
}

#[test]
fn the_last_success_is_found_from_either_side() {
    for threshold in [3e-9, 0.7, 1.0, 42.0, 6e8] {
        for start in [1e-3, 1.0, 1e4] {
            let walk = Walk { start, ..WALK };
            let x = found(walk, |x| x <= threshold).unwrap();
            assert!(x <= threshold && x * (1.0 + 2e-6) > threshold, "{x} {threshold}");
            let walk = Walk { succeeds: Succeeds::Above, ..walk };
            let x = found(walk, |x| x >= threshold).unwrap();
            assert!(x >= threshold && x < threshold * (1.0 + 2e-6), "{x} {threshold}");
        }
    }
}

#[test]
fn what_is_enough_is_not_improved() {
    let walk = Walk { enough: Some(0.3), start: 0.3, ..WALK };
    assert_eq!(found(walk, |x| x <= 5.0), Some(0.3));
    assert!(found(walk, |x| x <= 0.2).is_some_and(|x| x <= 0.2 && x > 0.199_999));
    let walk = Walk { enough: Some(0.25), start: 1.0, ..WALK };
    assert!(found(walk, |x| x <= 0.3).is_some_and(|x| (0.25..=0.3).contains(&x)));
    let walk = Walk { enough: Some(4.0), succeeds: Succeeds::Above, ..walk };
    assert!(found(walk, |x| x >= 3.0).is_some_and(|x| (3.0..=4.0).contains(&x)));
}

#[test]
fn cancelled_it_has_what_was_found_before() {
    let cancel = AtomicBool::new(false);
    for most in 0..20 {
        let mut tried = Vec::new();
        let test = |x: &BigRational, _: &mut Control<'_>| {
            if tried.len() == most {
                return Err(NoAnswer::Cancelled);
            }
            tried.push(x.clone());
            Ok(x.to_f64().filter(|x| *x <= 42.0))
        };
        let control = &mut Control { cancel: &cancel, progress: &mut |_| {} };
        let found = frontier(&WALK, control, test).unwrap().map(|(value, _)| value);
        let forty_two = BigRational::from_integer(42.into());
        assert_eq!(found, tried.into_iter().filter(|x| *x <= forty_two).max());
    }
}

const ENDLESS: Budget = Budget { max_boxes: usize::MAX, deadline: None };

fn approached(
    to: &Approach,
    budget: Budget,
    mut succeeds: impl FnMut(f64) -> Result<bool, NoAnswer>,
) -> Option<f64> {
    let cancel = AtomicBool::new(false);
    let control = &mut Control { cancel: &cancel, progress: &mut |_| {} };
    let found = approach(to, budget, control, |x, _, _| {
        let x = x.to_f64().unwrap();
        Ok(succeeds((to.to / x).max(x / to.to) - 1.0)?.then_some(x))
    });
    let Approached { found, out_of_time } = found.unwrap();
    assert_eq!(out_of_time, budget.is_over());
    found.map(|(_, x)| (to.to / x).max(x / to.to) - 1.0)
}

/// Of the three distances that fail, ever farther ones, the last decides whether time was what lacked.
#[test]
fn only_the_farthest_failure_may_be_for_want_of_time() {
    let to = Approach::from_afar(200.0, Succeeds::Below, 3e-7);
    let cancel = AtomicBool::new(false);
    for (late, out_of_time) in [(1, false), (2, false), (3, true)] {
        let control = &mut Control { cancel: &cancel, progress: &mut |_| {} };
        let deadline = Instant::now().checked_add(Duration::from_secs(2));
        let mut failures = 0;
        let found = approach(&to, Budget { deadline, ..ENDLESS }, control, |x, own, _| {
            let succeeds = 200.0 / x.to_f64().unwrap() - 1.0 >= 0.02;
            failures += usize::from(!succeeds);
            while !succeeds && failures == late && !own.is_over() {
                std::thread::sleep(Duration::from_millis(10));
            }
            Ok(succeeds.then_some(()))
        });
        assert_eq!((found.unwrap().out_of_time, failures), (out_of_time, 3));
    }
}

#[test]
fn the_nearest_distance_that_works_is_come_near_to_from_afar() {
    for succeeds in [Succeeds::Below, Succeeds::Above] {
        let to = Approach::from_afar(200.0, succeeds, 3e-7);
        for least in [2e-7, 3.1e-7, 7e-6, 0.004, 0.09, 0.11, 0.7, 30.0] {
            let mut tries = 0;
            let found = approached(&to, ENDLESS, |distance| {
                tries += 1;
                Ok(distance >= least)
            });
            let found = found.unwrap();
            let most = f64::max(1.01 * to.near, 1.11 * least);
            assert!((least..=most).contains(&found), "{least}: {found}");
            assert!(tries <= 12, "{least}: {tries}");
        }
        assert_eq!(approached(&to, ENDLESS, |_| Ok(false)), None);
    }
}

fn assert_near(tried: &[f64], expected: &[f64]) {
    let near = |(tried, expected): (&f64, &f64)| (tried / expected - 1.0).abs() < 0.03;
    let same = tried.len() == expected.len() && tried.iter().zip(expected).all(near);
    assert!(same, "{tried:?}, expected {expected:?}");
}

/// What is hoped for is tried first, and what is known is not tried again.
#[test]
fn an_approach_begins_near_where_that_is_hoped_for() {
    let far = (10.0, 1e3);
    let to = Approach { first: 0.0075, far, ..Approach::from_afar(1.0, Succeeds::Below, 0.0075) };
    for (least, known, expected) in [
        (0.007, None, &[0.0075][..]),
        (2.0, None, &[0.0075, 10.0, 3.13, 0.977, 1.75, 2.33, 2.02, 1.88, 1.95, 1.985]),
        (30.0, None, &[0.0075, 10.0, 32.0, 17.9, 23.9, 27.7, 29.7, 30.8, 30.2]),
        (1e5, None, &[0.0075, 10.0, 32.0, 102.0, 328.0, 1049.0]),
        (0.007, Some(0.3), &[0.03, 0.0075]),
        (0.02, Some(0.3), &[0.03, 0.0075, 0.015, 0.0212, 0.0178, 0.0194]),
        (0.007, Some(0.0074), &[]),
    ] {
        let mut tried = Vec::new();
        let to = Approach { known, ..to };
        approached(&to, ENDLESS, |distance| {
            tried.push(distance);
            Ok(distance >= least)
        });
        assert_near(&tried, expected);
    }
}

/// Where time is short no step is a great one.
#[test]
fn an_approach_by_thirds_comes_as_near() {
    for (near, expected) in
        [(0.0075, &[0.306, 0.0957, 0.00916, 0.0075][..]), (0.375, &[0.375]), (1.0, &[])]
    {
        let to = Approach::from_afar(1.0, Succeeds::Below, near);
        let to = Approach { known: Some(0.98), by_thirds: 0.1, ..to };
        let mut tried = Vec::new();
        approached(&to, ENDLESS, |distance| {
            tried.push(distance);
            Ok(true)
        });
        assert_near(&tried, expected);
    }
}

#[test]
fn an_approach_that_ends_early_has_what_was_found_before() {
    let to = Approach::from_afar(200.0, Succeeds::Above, 3e-7);
    for (most, expected) in [None, Some(0.1), Some(0.01), Some(1e-4), Some(3e-7)].iter().enumerate()
    {
        let mut tries = 0;
        let found = approached(&to, ENDLESS, |_| {
            tries += 1;
            (tries <= most).then_some(true).ok_or(NoAnswer::Cancelled)
        });
        assert!(match (found, expected) {
            (Some(found), Some(expected)) => (found / expected - 1.0).abs() < 0.01,
            (found, expected) => found == *expected,
        });
    }
    let now = Budget { deadline: Some(Instant::now()), ..ENDLESS };
    let mut tries = 0;
    let found = approached(&to, now, |_| {
        tries += 1;
        Ok(true)
    });
    assert!(found.is_some_and(|distance| distance > 0.09) && tries == 1);
}

#[test]
fn nothing_is_found_where_nothing_succeeds_and_the_limits_hold() {
    assert_eq!(found(WALK, |_| false), None);
    let last = found(WALK, |_| true).unwrap();
    assert!((1e11..=1e12).contains(&last));
    let walk = Walk { deadline: Some(Instant::now()), ..WALK };
    assert_eq!(found(walk, |_| true), None);
}
