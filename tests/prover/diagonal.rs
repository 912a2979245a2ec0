//! Cubes `[-c_1, c_2]^3` on the diagonal of the Orthoglide with `L = 1`, which are decided in
//! closed form: with `T` and `U` the tangents that belong to `c_1` and `c_2`, `c = t / sqrt(1 +
//! 2 t^2)`, and `2T < 1`, `U < 1`,
//!
//! ```text
//! min sigma_min = 1 - max(2T, U)        max sigma_max = 1 + 2U   if c_1 <= c_2
//! ```
//!
//! Bounds a relative 1e-6 either side of the truth must give the right verdict.

use super::machines::{exact, orthoglide};
use super::random::Random;
use super::{verdict, verified};
use orthocert::exact::Exact;
use orthocert_checker::certificate::Verdict;
use orthocert_checker::claim::{MachineClaim, Range};

/// A random cube: the tangents as texts, and its claim without requirements.
struct Cube {
    t: String,
    u: String,
    claim: MachineClaim,
    /// `max(2T, U)`.
    loss: String,
    /// `c_1 <= c_2`.
    upper_is_known: bool,
}

fn random_cube(random: &mut Random) -> Cube {
    // In thousandths: 2T and U up to 0.95, often nearly equal.
    let u = random.within(1, 950);
    let t = match random.within(0, 2) {
        0 => (u / 2).max(1),
        _ => random.within(1, 475),
    };
    let coordinate = |t: i64| format!("{t}/1000/sqrt(1+2*{t}*{t}/1000000)");
    let claim = orthoglide("1", &format!("-({})", coordinate(t)), &coordinate(u));
    Cube {
        t: format!("{t}/1000"),
        u: format!("{u}/1000"),
        claim,
        loss: format!("{}/1000", (2 * t).max(u)),
        upper_is_known: t <= u,
    }
}

fn one_over(text: &str) -> Option<Exact> {
    Some(exact(&format!("1/({text})")))
}

/// Verifies the cube with one bound; `relative` says how far the required extreme is from the
/// true one.
fn decided(cube: &Cube, lower: bool, relative: &str) -> (Option<Verdict>, usize) {
    let mut claim = cube.claim.clone();
    let range = if lower {
        Range { min: None, max: one_over(&format!("(1-{})*(1{relative})", cube.loss)) }
    } else {
        Range { min: one_over(&format!("(1+2*{})*(1{relative})", cube.u)), max: None }
    };
    claim.requirements.transmission = Some(range);
    let found = verified(&claim, 20_000);
    (verdict(&found), found.boxes)
}

#[test]
fn bounds_near_the_truth_get_the_right_verdict() {
    let mut random = Random::new(60);
    let (mut lower, mut upper, mut most) = (0, 0, 0);
    for _ in 0..1000 {
        let cube = random_cube(&mut random);
        let name = format!("T = {}, U = {}", cube.t, cube.u);
        for (relative, expected) in [("-1e-6", Verdict::Certified), ("+1e-6", Verdict::Refuted)] {
            let (found, boxes) = decided(&cube, true, relative);
            assert_eq!(found, Some(expected), "{name}: kappa {relative}");
            lower += 1;
            most = most.max(boxes);
        }
        if !cube.upper_is_known {
            continue;
        }
        for (relative, expected) in [("+1e-6", Verdict::Certified), ("-1e-6", Verdict::Refuted)] {
            let (found, boxes) = decided(&cube, false, relative);
            assert_eq!(found, Some(expected), "{name}: k {relative}");
            upper += 1;
            most = most.max(boxes);
        }
    }
    assert!(lower == 2000 && upper > 500, "{lower} {upper}");
    assert!(most <= 200, "{most} boxes");
}
