//! Cubes `[-c_1, c_2]^3` on the diagonal of the Orthoglide with `L = 1`, which are decided in
//! closed form: with `T` and `U` the tangents that belong to `c_1` and `c_2`, `c = t / sqrt(1 +
//! 2 t^2)`, and `2T < 1`, `U < 1`,
//!
//! ```text
//! min sigma_min = 1 - max(2T, U)        max sigma_max = 1 + 2U   if c_1 <= c_2
//! ```
//!
//! Bounds a relative 1e-6 either side of the truth must give the right verdict.

use super::{orthoglide, verdict, verified, Random};
use orthocert_checker::certificate::Verdict;

/// Cubes tried.
const CUBES: usize = 100;

/// A random cube: the tangents in thousandths.
struct Cube {
    t: i64,
    u: i64,
}

impl Cube {
    /// `2T` and `U` up to 0.95, often nearly equal.
    fn new(random: &mut Random) -> Self {
        let u = random.within(1, 950);
        let t = match random.within(0, 2) {
            0 => (u / 2).max(1),
            _ => random.within(1, 475),
        };
        Cube { t, u }
    }

    /// Verifies one bound; `relative` says how far it is from the true extreme.
    fn decided(&self, lower: bool, relative: &str) -> (Option<Verdict>, usize) {
        let Cube { t, u } = self;
        let coordinate = |t: &i64| format!("{t}/1000/sqrt(1+2*{t}*{t}/1000000)");
        let bound = if lower {
            let loss = (2 * t).max(*u);
            format!("max = \"1/((1-{loss}/1000)*(1{relative}))\"")
        } else {
            format!("min = \"1/((1+2*{u}/1000)*(1{relative}))\"")
        };
        let ends = [format!("-({})", coordinate(t)), coordinate(u)];
        let claim = orthoglide("1", ends.each_ref().map(String::as_str), &bound);
        let found = verified(&claim, 20_000);
        (verdict(&found), found.boxes)
    }
}

#[test]
fn bounds_near_the_truth_get_the_right_verdict() {
    let mut random = Random(60);
    let (mut lower, mut upper, mut most) = (0, 0, 0);
    for _ in 0..CUBES {
        let cube = Cube::new(&mut random);
        let name = format!("T = {}, U = {}", cube.t, cube.u);
        for (relative, expected) in [("-1e-6", Verdict::Certified), ("+1e-6", Verdict::Refuted)] {
            let (found, boxes) = cube.decided(true, relative);
            assert_eq!(found, Some(expected), "{name}: kappa {relative}");
            lower += 1;
            most = most.max(boxes);
        }
        if cube.t > cube.u {
            continue;
        }
        for (relative, expected) in [("+1e-6", Verdict::Certified), ("-1e-6", Verdict::Refuted)] {
            let (found, boxes) = cube.decided(false, relative);
            assert_eq!(found, Some(expected), "{name}: k {relative}");
            upper += 1;
            most = most.max(boxes);
        }
    }
    assert!(lower == 2 * CUBES && upper > CUBES / 2, "{lower} {upper}");
    assert!(most <= 400, "{most} boxes");
}
