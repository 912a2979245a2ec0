//! What quantities change of a row together: what is accepted, and what is not.

use crate::certificates::claim;
use crate::prover::certificate;
use orthocert_kernel::certificate::{
    Certificate, Evidence, Node, Part, Proof, Step, Tree, Verdict,
};
use orthocert_kernel::check::check;
use orthocert_kernel::test::Multiplier;

/// The derivative of a machine of one joint and one coordinate, of parameters `a` and `b` in `[-1, 1]`, and what stands in a
/// certificate of `sigma_min >= 1/psi`.
#[derive(Clone)]
struct Machine {
    derivative: &'static str,
    psi: &'static str,
    y: i64,
    /// `R`, over 8.
    r: Vec<Vec<i64>>,
    places: u32,
    ends: &'static str,
}

impl Machine {
    fn certificate(&self, wrapped: impl Fn(Evidence) -> Evidence) -> Certificate {
        let own = claim(&format!(
            r#"{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[["a",{{"min":"-1","max":"1"}}],["b",{{"min":"-1","max":"1"}}]],"definitions":[],"joints":[{{"row":["{}"]}}]}}}},"workspace":{{"box":{{"min":["0"],"max":["1"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"{}"}}]}}"#,
            self.derivative, self.psi
        ));
        let lower = Evidence::Lower(Multiplier { y: vec![vec![self.y]], places: 0 });
        let together = Evidence::Together(Box::new(lower), self.r.clone(), self.places);
        let by = wrapped(together);
        let nodes = vec![Node { by: vec![Step(0, by)], ..Node::default() }];
        let tree = Tree { precision: 48, chords: None, nodes };
        certificate(&own, Verdict::Certified, Proof::Tree(tree))
    }

    fn within(&self, by: Evidence) -> Evidence {
        Evidence::Tolerances(Box::new(by), self.ends.to_owned(), vec![vec![1]])
    }

    fn holds(&self) -> bool {
        let own = self.certificate(|by| self.within(by));
        let read = Certificate::read(&own.to_text().expect("a text")).expect("canonical");
        assert_eq!(read, own);
        check(&own).is_ok()
    }

    fn with_r(&self, r: i64) -> Self {
        Machine { r: vec![vec![r]], ..self.clone() }
    }

    /// Whether some `R` is accepted.
    fn is_shown(&self) -> bool {
        (-8..=80).any(|r| self.with_r(r).holds())
    }
}

/// `M = 3 + a b` is least, 2, where the signs differ: `psi <= 1/2`. With `Y = 2`, `4 a b` are at least -4.
const PRODUCT: Machine =
    Machine { derivative: "3+a*b", psi: "0.51", y: 2, r: Vec::new(), places: 3, ends: "==" };

/// `M = 2 + a + a^2` is least, 7/4, where `a = -1/2`, and `2 - 1 + 0` is what its terms are at least.
const SQUARE: Machine =
    Machine { derivative: "2+a+a*a", psi: "1.1", y: 1, r: Vec::new(), places: 3, ends: "==" };

#[test]
fn what_two_change_together_is_of_the_product_of_their_signs() {
    assert!(PRODUCT.is_shown());
    assert!(PRODUCT.with_r(33).holds() && !PRODUCT.with_r(31).holds());
    for psi in ["0.499", "0.45", "0.4"] {
        for y in 1..4 {
            assert!(!Machine { psi, y, ..PRODUCT }.is_shown(), "{psi} with {y}");
        }
    }
    // Neither by itself, nor of the other sign.
    let plus = Machine { derivative: "3-a*b", ..PRODUCT };
    assert!(plus.with_r(33).holds() && !plus.with_r(31).holds());
}

#[test]
fn squares_are_between_zero_and_their_greatest() {
    assert!(SQUARE.with_r(17).holds() && !SQUARE.with_r(15).holds());
    // Of machines at the ends alone it would be `2 + a + 1`, at least 2.
    for psi in ["0.57", "0.51", "0.4"] {
        for y in 1..4 {
            assert!(!Machine { psi, y, ..SQUARE }.is_shown(), "{psi} with {y}");
        }
    }
    let negative = Machine { derivative: "4+a-a*a", psi: "0.51", y: 2, ..SQUARE };
    assert!(negative.is_shown());
    for y in 1..5 {
        assert!(!Machine { psi: "0.49", y, ..negative.clone() }.is_shown(), "{y}");
    }
}

#[test]
fn lists_are_of_the_rows() {
    let with = |r: Vec<Vec<i64>>| Machine { r, ..PRODUCT }.holds();
    assert!(with(vec![vec![33]]));
    assert!(!with(Vec::new()), "none");
    assert!(!with(vec![vec![33]; 2]), "one more");
    assert!(!with(vec![vec![33, 0, 0]]), "of two columns");
    assert!(!with(vec![vec![0]]) && !with(vec![vec![-33]]), "not positive");
    assert!(!with(vec![vec![i64::MAX]]) && !with(vec![vec![i64::MIN]]), "too much");
    assert!(!Machine { places: 2, ..PRODUCT.with_r(33) }.holds(), "twice as much");
    assert!(!Machine { places: 64, ..PRODUCT.with_r(33) }.holds(), "places");
    // Without a list each is taken off by itself: of a product all four of its steps.
    let apart = Machine { r: vec![Vec::new()], ..PRODUCT };
    assert!(Machine { derivative: "3+a", ..apart.clone() }.holds() && !apart.holds(), "apart");
}

#[test]
fn all_are_in_the_middle_and_of_second_order() {
    for ends in ["=<", ">=", "=0", "00", "<>", "--", "=", "==="] {
        assert!(!Machine { ends, ..PRODUCT.with_r(33) }.holds(), "{ends}");
    }
}

#[test]
fn it_stands_within_tolerances_alone() {
    let own = PRODUCT.with_r(33);
    let wrapped = |of: &dyn Fn(Evidence) -> Evidence| check(&own.certificate(of)).is_ok();
    let twice = |by: Evidence| Evidence::Together(Box::new(by), own.r.clone(), own.places);
    assert!(wrapped(&|by| own.within(by)));
    assert!(!wrapped(&|by| by), "alone");
    assert!(!wrapped(&|by| twice(own.within(by))), "around");
    assert!(!wrapped(&|by| own.within(twice(by))), "twice");
    let fan = |by: Evidence| Evidence::Fan(vec![Part(vec![1], 0, 0, by)]);
    assert!(!wrapped(&|by| fan(own.within(by))), "in a fan");
    assert!(!wrapped(&|by| own.within(Evidence::Control(Box::new(by)))), "at control points");
    let rank = |by: Evidence| match by {
        Evidence::Together(_, r, places) => {
            let y = Multiplier { y: vec![vec![2]], places: 0 };
            Evidence::Together(Box::new(Evidence::Rank(y)), r, places)
        }
        by => by,
    };
    assert!(!wrapped(&|by| own.within(rank(by))), "about a rank");
}
