//! Directions of one scale, in tolerances apart: with them more is shown, and of no other machines.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::prover::{certificate, Prover};
use orthocert_kernel::certificate::{Evidence, Proof, Step, Verdict};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;

fn range([min, max]: [f64; 2]) -> String {
    if min == max {
        format!(r#""{min}""#)
    } else {
        format!(r#"{{"min":"{min}","max":"{max}"}}"#)
    }
}

/// Two sliders in the plane, next to the point `(1, 2)`: how great the first joint coordinate may be, of a guide along
/// `direction`.
fn guided(direction: [[f64; 2]; 2], length: [f64; 2], bound: f64) -> MachineClaim {
    // The other guide is across.
    let other =
        if direction[0][0] < 0.0 && 0.0 < direction[0][1] { r#""1","0""# } else { r#""0","1""# };
    let [x, y] = direction.map(range);
    let length = range(length);
    claim(&format!(
        r#"{{"mechanism":{{"planar":{{"legs":[{{"drive":"slider","direction":[{x},{y}],"anchor":["0","0"],"platform":["0","0"],"length":{length},"mode":"+"}},{{"drive":"slider","direction":[{other}],"anchor":["0","0"],"platform":["0","0"],"length":"10","mode":"+"}}]}}}},"workspace":{{"box":{{"min":["1","2"],"max":["1.0001","2.0001"]}}}},"require":[{{"quantity":"joint_range","leg":1,"end":"max","bound":"{bound}"}}]}}"#
    ))
}

type Guide = ([[f64; 2]; 2], [f64; 2]);

/// Whether a bound is shown so: by the sign of one machine, less what the others differ by.
fn is_shown((direction, length): Guide, bound: f64, ends: &str) -> bool {
    let loose = Problem::new(&guided(direction, length, 100.0));
    let loose = loose.expect("well formed").with_derivatives();
    let mut tree = Prover::new(&loose).tree(1).expect("one box");
    for Step(number, by) in &mut tree.nodes[0].by {
        if loose.obligations[*number].requirement.is_some() {
            *by = Evidence::Tolerances(Box::new(Evidence::Test), ends.to_owned(), Vec::new());
        }
    }
    let claim = guided(direction, length, bound);
    check(&certificate(&claim, Verdict::Certified, Proof::Tree(tree))).is_ok()
}

/// The greatest joint coordinate of many machines and points.
fn greatest(([x, y], length): Guide) -> f64 {
    let mut random = Random(3);
    let mut part = |[lo, hi]: [f64; 2]| lo + (hi - lo) * random.below(17) as f64 / 16.0;
    let mut of = || {
        let (u, v, l) = (part(x), part(y), part(length));
        let norm = u.hypot(v);
        let (n, w) = ([u / norm, v / norm], [part([1.0, 1.0001]), part([2.0, 2.0001])]);
        let (along, across) = (n[0] * w[0] + n[1] * w[1], n[0] * w[1] - n[1] * w[0]);
        along - (l * l - across * across).sqrt()
    };
    (0..20_000).map(|_| of()).fold(f64::NEG_INFINITY, f64::max)
}

/// All machines that evidence may name, of so many quantities.
fn machines(quantities: u32) -> impl Iterator<Item = String> {
    let digits = move |n: usize| (0..quantities).map(move |k| n / 4usize.pow(k) % 4);
    (0..4usize.pow(quantities)).map(move |n| digits(n).map(|k| ['-', '+', '0', '1'][k]).collect())
}

const ONE: [f64; 2] = [10.0, 10.0];

#[test]
fn a_scale_is_no_tolerance() {
    let off = [-0.02, 0.02];
    for along in [[0.9, 1.1], [-1.1, -0.9]] {
        let own = ([along, off], ONE);
        let near = greatest(own) + 2e-4;
        let by: Vec<String> = machines(2).filter(|ends| is_shown(own, near, ends)).collect();
        assert!(!by.is_empty() && by.iter().all(|ends| ends.starts_with('1')), "{by:?}");
        assert!(!machines(2).any(|ends| is_shown(own, near - 3e-4, &ends)), "false");
    }
    // In the other order, and with a length that differs too.
    let own = ([off, [0.9, 1.1]], [9.99, 10.01]);
    let near = greatest(own) + 1e-3;
    assert!(machines(3).any(|ends| ends.contains('1') && is_shown(own, near, &ends)));
    assert!(!machines(3).any(|ends| is_shown(own, near - 2e-3, &ends)), "false");
}

#[test]
fn what_is_no_scale_is_not_taken_for_one() {
    // Far from the bound, any machine will do.
    let taken = |own: Guide, ends: &str| is_shown(own, greatest(own) + 5.0, ends);
    let (along, off) = ([0.9, 1.1], [-0.02, 0.02]);
    assert!(taken(([along, off], ONE), "1-"));
    // Not where 0 is not among the values of the other component.
    for other in [[0.01, 0.05], [-0.05, -0.01]] {
        assert!(taken(([along, other], ONE), "--"));
        assert!(machines(2).all(|ends| ends.contains('1') != taken(([along, other], ONE), &ends)));
    }
    assert!(taken(([along, [1.0, 1.0]], ONE), "-") && !taken(([along, [1.0, 1.0]], ONE), "1"));
    // Nor the component that has 0, nor a length.
    assert!(!["-1", "+1", "11"].iter().any(|ends| taken(([along, off], ONE), ends)));
    assert!(taken(([along, off], [9.99, 10.01]), "1--"));
    assert!(!["1-1", "--1"].iter().any(|ends| taken(([along, off], [9.99, 10.01]), ends)));
    // Of machines whose other component would leave its range, those of one scale are not the worst.
    let skew = ([[0.5, 0.5], [0.5, 0.6]], ONE);
    let least = greatest(([[0.5, 0.5], [0.5, 0.5]], ONE));
    assert!(least + 0.01 < greatest(skew));
    assert!(!machines(1).any(|ends| is_shown(skew, least + 0.005, &ends)), "false");
}
