//! Condition numbers with a `mu` of each machine: what is accepted, and what is not.

use crate::certificates::claim;
use crate::prover::certificate;
use nalgebra::{Matrix2, SymmetricEigen, Vector2};
use orthocert_kernel::certificate::{
    Certificate, Claim, Evidence, Node, Part, Proof, Step, Tree, Verdict,
};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::Bound;
use orthocert_kernel::test::Multiplier;

/// An Orthoglide with directions known to 0.6 degrees, next to a corner where two singular values are least:
/// `sigma_max <= 2.2 sigma_min`, the greatest being 2.18754. Written by `orthocert verify`.
const ORTHOGLIDE: &str = include_str!("weights/orthoglide.json");

/// What is in the evidence.
#[derive(Clone)]
struct Halves {
    mu: Vec<i64>,
    places: u32,
    weights: Vec<Vec<i64>>,
    lower: Evidence,
    upper: Evidence,
}

/// Whether the Orthoglide's certificate is accepted with other evidence.
fn with(change: impl Fn(Halves) -> Halves) -> bool {
    let mut own = Certificate::read(ORTHOGLIDE).expect("canonical");
    let Proof::Tree(tree) = &mut own.proof else { panic!("a tree") };
    let Step(_, by) = tree.nodes[0].by.last_mut().expect("a step");
    let Evidence::Between(mu, places, weights, lower, upper) = by.clone() else { panic!("both") };
    let Halves { mu, places, weights, lower, upper } =
        change(Halves { mu, places, weights, lower: *lower, upper: *upper });
    *by = Evidence::Between(mu, places, weights, Box::new(lower), Box::new(upper));
    let read = Certificate::read(&own.to_text().expect("a text")).expect("canonical");
    assert_eq!(read, own);
    check(&own).is_ok()
}

fn apart(by: &mut Evidence) -> (&mut String, &mut Vec<Vec<i64>>) {
    let Evidence::Tolerances(_, ends, directions) = by else { panic!("apart") };
    (ends, directions)
}

/// With the weights changed.
fn weights(change: impl Fn(&mut Vec<Vec<i64>>)) -> bool {
    with(|mut all| {
        change(&mut all.weights);
        all
    })
}

/// With the directions of one bound changed.
fn directions(of_lower: bool, change: impl Fn(&mut Vec<Vec<i64>>)) -> bool {
    with(|mut all| {
        change(apart(if of_lower { &mut all.lower } else { &mut all.upper }).1);
        all
    })
}

#[test]
fn each_machine_has_a_mu_of_its_own() {
    assert!(with(|all| all));
    assert!(!weights(Vec::clear), "one mu for all");
    assert!(!weights(|all| all.iter_mut().flatten().for_each(|n| *n = 0)), "weights of zero");
    assert!(!weights(|all| all.iter_mut().flatten().for_each(|n| *n = -*n)), "the other way");
    assert!(!weights(|all| all.iter_mut().flatten().for_each(|n| *n *= 2)), "twice as much");
    assert!(!weights(|all| drop(all.pop())), "too few rows");
    assert!(!weights(|all| all.push(all[0].clone())), "too many rows");
    assert!(!weights(|all| all[0].truncate(11)), "too few quantities");
    assert!(!weights(|all| all[0].push(0)), "too many quantities");
    assert!(!weights(|all| all.swap(0, 1)), "of rows that do not depend on these");
    assert!(!weights(|all| all[1][1] = 1), "of one that does not");
    assert!(!weights(|all| all[0][1] = i64::MAX), "with so much that it overflows");
    assert!(!weights(|all| all[0][1] = i64::MIN), "with so little that it overflows");
    assert!(!with(|all| Halves { places: 64, ..all }), "places");
}

#[test]
fn both_bounds_are_of_the_same_mu() {
    for part in [-1.0, 0.0, 0.9, 1.1] {
        let moved = |mu: &[i64]| [&[(mu[0] as f64 * part) as i64], &mu[1..]].concat();
        assert!(!with(|all| Halves { mu: moved(&all.mu), ..all }), "{part}");
    }
    assert!(!with(|all| Halves { lower: all.upper.clone(), upper: all.lower.clone(), ..all }));
    assert!(!with(|all| Halves { upper: all.lower.clone(), ..all }));
    assert!(!with(|all| Halves { lower: all.upper.clone(), ..all }));
}

#[test]
fn directions_are_along_and_across() {
    assert!(!directions(true, |all| drop(all.pop())), "across nothing");
    assert!(!directions(true, |all| all[1] = vec![0; 3]), "across zero");
    assert!(!directions(true, |all| all[1] = vec![-74, 74, 0]), "across what is least");
    assert!(!directions(true, |all| all.push(vec![0; 3])), "one more");
    assert!(!directions(true, |all| all[1] = vec![i64::MAX; 3]), "too far");
    assert!(!directions(true, |all| all[0].push(0)), "of four components");
    assert!(!directions(false, |all| all.push(vec![0; 3])), "two above");
    assert!(!directions(false, |all| all[0] = vec![0; 3]), "along none");
    assert!(!directions(false, |all| all[0] = vec![1, -1, 0]), "along another");
}

#[test]
fn nothing_else_goes_with_weights() {
    let fan = |by: &Evidence| Evidence::Fan(vec![Part(vec![1, 0, 0], 0, 0, by.clone())]);
    assert!(!with(|all| Halves { lower: fan(&all.lower), ..all }), "a fan below");
    assert!(!with(|all| Halves { upper: fan(&all.upper), ..all }), "a fan above");
    let plain = |by: &Evidence| match by {
        Evidence::Tolerances(by, ..) => (**by).clone(),
        _ => panic!("apart"),
    };
    assert!(!with(|all| Halves { lower: plain(&all.lower), ..all }), "all at once below");
    assert!(!with(|all| Halves { upper: plain(&all.upper), ..all }), "all at once above");
    let elsewhere = |ends: &str, from: char| {
        let ends = ends.to_owned();
        move |mut all: Halves| {
            let other: String =
                ends.chars().map(|end| if end == from { '>' } else { end }).collect();
            other.clone_into(apart(&mut all.upper).0);
            all
        }
    };
    assert!(!with(elsewhere("1<<-<1<-<<1-", '<')), "from the best machine");
}

#[test]
fn false_bounds_are_not_accepted() {
    for bound in ["2.1875", "2.18", "2.1", "1.5"] {
        let mut own = Certificate::read(ORTHOGLIDE).expect("canonical");
        let Claim::Machine(claim) = &mut own.claim else { panic!("a machine") };
        claim.require[0].bound =
            Bound::Max(serde_json::from_str(&format!("\"{bound}\"")).expect("a number"));
        for part in [0.97, 0.99, 0.995, 1.0, 1.005, 1.01, 1.03] {
            let Proof::Tree(tree) = &mut own.proof else { panic!("a tree") };
            let Step(_, by) = tree.nodes[0].by.last_mut().expect("a step");
            let Evidence::Between(mu, ..) = by else { panic!("both") };
            let [before, after] = [mu[0], (mu[0] as f64 * part) as i64];
            mu[0] = after;
            assert!(check(&own).is_err(), "{bound} with {part} of mu");
            let Proof::Tree(tree) = &mut own.proof else { panic!("a tree") };
            let Step(_, by) = tree.nodes[0].by.last_mut().expect("a step");
            let Evidence::Between(mu, ..) = by else { panic!("both") };
            mu[0] = before;
        }
    }
}

/// `M = [[1 + a, 0.3], [0.2, 1.1 + b]]`, `a`, `b` in `[-0.02, 0.02]`.
fn machine([a, b]: [f64; 2]) -> Matrix2<f64> {
    Matrix2::new(1.0 + a, 0.3, 0.2, 1.1 + b)
}

/// Whether some evidence of a grid is accepted for a bound, with weights or without.
fn is_shown(bound: f64, with_weights: bool) -> bool {
    let bound = (bound * 1e6).round() / 1e6;
    let own = claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":["x","y"],"parameters":[["a",{{"min":"-0.02","max":"0.02"}}],["b",{{"min":"-0.02","max":"0.02"}}]],"definitions":[],"joints":[{{"row":["1+a","0.3"]}},{{"row":["0.2","1.1+b"]}}]}}}},"workspace":{{"box":{{"min":["0","0"],"max":["1","1"]}}}},"require":[{{"quantity":"conditioning","end":"max","bound":"{bound}"}}]}}"#
    ));
    const PLACES: u32 = 16;
    let integers = |x: &[f64], scale: f64| -> Vec<i64> {
        x.iter().map(|x| (x * scale).round() as i64).collect()
    };
    let rank = Evidence::Rank(Multiplier { y: vec![vec![1, 0], vec![0, 1]], places: 0 });
    let shows = |by: Evidence| {
        let by = vec![Step(0, rank.clone()), Step(1, by)];
        let nodes = vec![Node { by, ..Node::default() }];
        let tree = Tree { precision: 48, chords: None, nodes };
        check(&certificate(&own, Verdict::Certified, Proof::Tree(tree))).is_ok()
    };
    let most = if with_weights { 20 } else { 0 };
    [[-0.02, -0.02], [-0.02, 0.02], [0.02, -0.02], [0.02, 0.02]].into_iter().any(|at| {
        let m = machine(at);
        let eigen = SymmetricEigen::new(m.transpose() * m);
        let (least, greatest) = (eigen.eigenvalues.imin(), eigen.eigenvalues.imax());
        let along = |k: usize, length: f64| {
            let w: Vector2<f64> = eigen.eigenvectors.column(k).into_owned();
            integers(w.as_slice(), length)
        };
        let ends: String = at.iter().map(|x| if *x < 0.0 { '-' } else { '+' }).collect();
        let mu = 0.5 * (eigen.eigenvalues[least] + eigen.eigenvalues[greatest] / (bound * bound));
        let y = [m.row(0), m.row(1)].map(|y| integers(&[y[0], y[1]], 256.0));
        let y = Multiplier { y: y.to_vec(), places: 8 };
        let scale = f64::from(PLACES).exp2();
        // What changes the square of the least singular value, and that of the greatest over the bound's.
        let by = |k: usize| {
            let w: Vector2<f64> = eigen.eigenvectors.column(k).into_owned();
            let own = m * w;
            [2.0 * own[0] * w[0], 2.0 * own[1] * w[1]]
        };
        let (below, above) = (by(least), by(greatest).map(|g| g / (bound * bound)));
        let parts = (0..=most).flat_map(|i| (0..=most).map(move |j| [i, j]));
        let mut parts = parts.flat_map(|n| [0.0, 4.0].map(|across| (n, across)));
        parts.any(|(n, across)| {
            let n = [0, 1].map(|j| match with_weights {
                true => above[j] + f64::from(n[j]) / 20.0 * (below[j] - above[j]),
                false => 0.0,
            });
            let zero = mu - n[0] * at[0] - n[1] * at[1];
            let mu = [&integers(&[zero], scale)[..], &[0, 0]].concat();
            let n = integers(&n, scale);
            let weights = if with_weights { vec![vec![n[0], 0], vec![0, n[1]]] } else { vec![] };
            let of = |by: Evidence, directions: Vec<Vec<i64>>| {
                Box::new(Evidence::Tolerances(Box::new(by), ends.clone(), directions))
            };
            let mut below = vec![along(least, 256.0)];
            if with_weights {
                let d: Vector2<f64> = eigen.eigenvectors.column(greatest) * across;
                below.push(integers(d.as_slice(), 16.0));
            }
            let lower = of(Evidence::Lower(y.clone()), below);
            let upper = of(Evidence::Test, vec![along(greatest, 4096.0)]);
            shows(Evidence::Between(mu, PLACES, weights, lower, upper))
        })
    })
}

#[test]
fn bounds_hold_for_sampled_machines() {
    let mut worst = 0f64;
    for i in 0..=200 {
        for j in 0..=200 {
            let at = [i, j].map(|k| f64::from(k) / 5000.0 - 0.02);
            let sigma = machine(at).singular_values();
            worst = worst.max(sigma.max() / sigma.min());
        }
    }
    for factor in [0.9999, 0.999, 0.99, 0.9] {
        assert!(!is_shown(worst * factor, true), "{factor}");
    }
    assert!(is_shown(worst * 1.002, true));
    assert!(!is_shown(worst * 1.002, false));
}
