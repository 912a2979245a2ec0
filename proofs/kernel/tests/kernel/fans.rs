//! Directions apart, and the two bounds of a condition number: what is accepted, and what is not.
//!
//! Three rows, each turned by up to 0.2 about its own place: of both singular values nearly all directions are worst for some
//! machine, so that no one of them serves all.

use crate::prover::{certificate, Prover};
use orthocert_kernel::certificate::{Certificate, Claim, Evidence, Part, Proof, Step, Verdict};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::Bound;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::test::Multiplier;

/// `psi <= 0.945`, where the greatest is 0.9285.
const PSI: &str = include_str!("fans/psi.json");
/// `sigma_max <= 1.4 sigma_min`.
const CONDITIONING: &str = include_str!("fans/conditioning.json");

/// Whether it is accepted with the last step's evidence changed.
fn with(text: &str, change: impl Fn(Evidence) -> Evidence) -> bool {
    let mut own = Certificate::read(text).expect("canonical");
    let Proof::Tree(tree) = &mut own.proof else { panic!("a tree") };
    let Step(_, by) = tree.nodes[0].by.last_mut().expect("a step");
    *by = change(by.clone());
    let read = Certificate::read(&own.to_text().expect("a text")).expect("canonical");
    assert_eq!(read, own);
    check(&own).is_ok()
}

/// With the parts changed.
fn parts(change: impl Fn(&mut Vec<Part>)) -> bool {
    with(PSI, |by| {
        let Evidence::Fan(mut parts) = by else { panic!("a fan") };
        change(&mut parts);
        Evidence::Fan(parts)
    })
}

#[test]
fn a_fan_shows_what_no_direction_alone_does() {
    assert!(parts(|_| ()));
    let own = Certificate::read(PSI).expect("canonical");
    let Claim::Machine(claim) = &own.claim else { panic!("a machine") };
    let problem = Problem::new(claim).expect("well formed").with_derivatives();
    assert!(Prover::new(&problem).tree(50).is_none());
    // Each part is needed, and all together are of all directions.
    let Proof::Tree(tree) = &own.proof else { panic!("a tree") };
    let Step(_, Evidence::Fan(all)) = &tree.nodes[0].by[0] else { panic!("a fan") };
    for at in 0..all.len() {
        // One may be in what its neighbour shows.
        assert!(!parts(|all| drop(all.drain(at..all.len().min(at + 4)))), "without part {at}");
        assert!(!parts(|all| *all = vec![all[at].clone()]), "part {at} alone");
        assert!(!parts(|all| all[at].1 = -all[at].1), "part {at} with a negative multiple");
        assert!(!parts(|all| all[at].1 = i64::MAX), "part {at} with so much that it overflows");
        assert!(!parts(|all| all[at].2 = 64), "part {at} with too many places");
        assert!(!parts(|all| all[at].0.push(0)), "part {at} with too many components");
        assert!(!parts(|all| all[at].0.truncate(1)), "part {at} with too few components");
        assert!(!parts(|all| all[at].0 = vec![i64::MIN, 1]), "part {at} without a negative");
        assert!(!parts(|all| all[at].3 = Evidence::Fan(all.clone())), "a fan in part {at}");
    }
    assert!(!parts(Vec::clear), "of no part");
    assert!(!parts(|all| all.truncate(all.len() / 2)), "not closed");
    assert!(!parts(|all| all.iter_mut().for_each(|part| part.1 = 0)), "of no wedge");
}

#[test]
fn false_claims_have_no_fan() {
    for bound in ["0.928", "0.92", "0.9"] {
        let mut own = Certificate::read(PSI).expect("canonical");
        let Claim::Machine(claim) = &mut own.claim else { panic!("a machine") };
        claim.require[0].bound =
            Bound::Max(serde_json::from_str(&format!("\"{bound}\"")).expect("a number"));
        assert!(check(&own).is_err(), "{bound}");
    }
}

#[test]
fn nothing_else_goes_with_a_fan() {
    let wrapped = |wrap: fn(Box<Evidence>) -> Evidence| with(PSI, |by| wrap(Box::new(by)));
    assert!(!wrapped(Evidence::Control), "at control points");
    assert!(!wrapped(|by| Evidence::Inside(by, 0, 0)), "inside of nothing");
    assert!(!wrapped(|by| Evidence::Turned(by, 0, 0)), "turned of nothing");
    assert!(!wrapped(|by| Evidence::Tolerances(by, "000".to_owned(), vec![vec![1, 0]])), "within");
    assert!(
        !wrapped(|by| Evidence::Between(vec![1, 0, 0], 0, vec![], by.clone(), by)),
        "of one bound"
    );
    // Tests that are not about singular values have no directions.
    let claim = crate::certificates::claim(
        r#"{"mechanism":{"formulas":{"coordinates":["x"],"parameters":[],"definitions":[],"joints":[{"rho":"x"}]}},"workspace":{"box":{"min":["0"],"max":["1"]}},"require":[{"quantity":"joint_range","leg":1,"end":"max","bound":"2"}]}"#,
    );
    let good = crate::prover::certify(&claim, 9).expect("true");
    let Proof::Tree(tree) = good.proof else { panic!("a tree") };
    let accepted = |wrap: &dyn Fn(&Step) -> Evidence| {
        let mut tree = tree.clone();
        for step in &mut tree.nodes[0].by {
            step.1 = wrap(step);
        }
        check(&certificate(&claim, Verdict::Certified, Proof::Tree(tree))).is_ok()
    };
    let fan = |by: &Evidence| Evidence::Fan(vec![Part(vec![1], 0, 0, by.clone())]);
    assert!(accepted(&|step| step.1.clone()));
    assert!(accepted(&|step| if step.0 == 0 { fan(&step.1) } else { step.1.clone() }));
    assert!(!accepted(&|step| if step.0 == 1 { fan(&step.1) } else { step.1.clone() }));
}

#[test]
fn both_bounds_of_a_condition_number_have_the_same_mu() {
    type Halves = (Vec<i64>, u32, Box<Evidence>, Box<Evidence>);
    let halves = |change: &dyn Fn(Halves) -> Evidence| {
        with(CONDITIONING, |by| {
            let Evidence::Between(mu, places, _, lower, upper) = by else { panic!("two bounds") };
            change((mu, places, lower, upper))
        })
    };
    let between =
        |(mu, places, lower, upper): Halves| Evidence::Between(mu, places, vec![], lower, upper);
    assert!(halves(&between));
    assert!(
        !halves(&|(mu, p, lower, upper)| between((mu, p, upper, lower))),
        "the other way about"
    );
    assert!(!halves(&|(mu, p, lower, _)| between((mu, p, lower.clone(), lower))), "one bound");
    assert!(!halves(&|(mu, p, _, upper)| between((mu, p, upper.clone(), upper))), "the other");
    assert!(
        !halves(&|(mu, p, lower, upper)| between((mu[1..].to_vec(), p, lower, upper))),
        "short"
    );
    assert!(!halves(&|(mu, _, lower, upper)| between((mu, 64, lower, upper))), "places");
    assert!(
        !halves(&|(_, p, lower, upper)| between((vec![-1, 0, 0], p, lower, upper))),
        "negative"
    );
    for part in [0.8, 1.25] {
        let moved = |mu: Vec<i64>| vec![(mu[0] as f64 * part) as i64, 0, 0];
        assert!(!halves(&|(mu, p, lower, upper)| between((moved(mu), p, lower, upper))), "{part}");
    }
    assert!(!halves(&|(.., lower, _)| *lower), "without mu");
    assert!(
        !halves(&|(mu, p, lower, upper)| {
            Evidence::Between(
                mu.clone(),
                p,
                vec![],
                Box::new(between((mu, p, lower, upper.clone()))),
                upper,
            )
        }),
        "twice"
    );
    assert!(
        !halves(&|(mu, p, lower, upper)| {
            between((mu, p, Box::new(Evidence::Control(lower)), upper))
        }),
        "at control points, where mu is another function"
    );
    // A condition number with a mu of its own for each wedge would be true of none.
    assert!(
        !halves(&|(mu, p, lower, upper)| {
            let Evidence::Fan(mut parts) = *lower else { panic!("a fan") };
            let y = Multiplier { y: vec![vec![1, 0], vec![0, 1], vec![0, 0]], places: 0 };
            let own = Evidence::Conditioning(y, vec![1, 0, 0]);
            parts.iter_mut().for_each(|part| part.3 = own.clone());
            between((mu, p, Box::new(Evidence::Fan(parts)), upper))
        }),
        "conditioning in a fan"
    );
}

#[test]
fn a_mu_of_its_own_for_each_direction_is_refused() {
    // M = diag(1, 2): each part alone shows any condition number above 1 of its directions.
    let claim = crate::certificates::claim(
        r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[["a",{"min":"1.999","max":"2"}]],"definitions":[],"joints":[{"row":["1","0"]},{"row":["0","a"]}]}},"workspace":{"box":{"min":["0","0"],"max":["1","1"]}},"require":[{"quantity":"conditioning","end":"max","bound":"2.1"}]}"#,
    );
    let good = crate::prover::certify(&claim, 9).expect("true");
    let Proof::Tree(tree) = good.proof else { panic!("a tree") };
    let accepted = |wrap: &dyn Fn(&Evidence) -> Evidence| {
        let mut tree = tree.clone();
        let last = tree.nodes[0].by.last_mut().expect("a step");
        last.1 = wrap(&last.1);
        check(&certificate(&claim, Verdict::Certified, Proof::Tree(tree))).is_ok()
    };
    assert!(accepted(&Clone::clone));
    assert!(!accepted(&|by| Evidence::Fan(vec![Part(vec![1, 0], 0, 0, by.clone())])));
    assert!(!accepted(&|by| {
        let own = || Box::new(by.clone());
        Evidence::Between(vec![1, 0, 0], 0, vec![], own(), own())
    }));
}
