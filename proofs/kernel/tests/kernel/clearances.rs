//! Bodies that keep their distance, and those that do not.

use crate::directions::nearest;
use crate::leaves::{linear_delta, orthoglide, rotary, struts};
use crate::prover::{certify, Prover};
use crate::quantities::{number, refutation, Asked, End, SLAB};
use nalgebra::Vector3;
use orthocert_kernel::certificate::{Evidence, Failure, Proof, Step};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{Body, MachineClaim};
use orthocert_kernel::formula::Vector;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::apart::Apart;
use orthocert_kernel::test::Multiplier;

/// The machine with rods on its legs, from 20 after the base joint to a trim before the platform's, with a
/// tool, and with a bar in the base.
fn with_bodies(
    machine: &MachineClaim,
    part: f64,
    tool: [f64; 3],
    bar: f64,
    trim: f64,
) -> MachineClaim {
    let mut machine = machine.clone();
    let length = |x: f64| number(x * part);
    for leg in 1..=3 {
        let trim = [length(20.0), length(trim)];
        machine.bodies.push(Body::Leg { leg, radius: length(4.0), trim, offset: None });
    }
    let point = |x: f64, y: f64, z: f64| [length(x), length(y), length(z)];
    let [x, y, z] = tool;
    let (from, to) = (point(x / 4.0, y / 4.0, z / 4.0), point(x, y, z));
    machine.bodies.push(Body::Platform { from, to, radius: length(5.0) });
    let (from, to) = (point(180.0, 150.0, bar), point(180.0, -150.0, bar));
    machine.bodies.push(Body::Base { from, to, radius: length(6.0) });
    machine
}

#[test]
fn clearance() {
    for (name, machine, part, most) in [
        (
            "linear Delta",
            with_bodies(&linear_delta(SLAB), 1.0, [0.0, 0.0, -40.0], 130.0, 30.0),
            1.0,
            10,
        ),
        ("Orthoglide", with_bodies(&orthoglide(), 1.0, [20.0, 20.0, 20.0], 130.0, 30.0), 1.0, 10),
        (
            "Orthoglide",
            with_bodies(&orthoglide(), 1.0, [20.0, 20.0, 20.0], -180.0, 150.0),
            1.0,
            700,
        ),
        ("struts", with_bodies(&struts(), 1.0, [0.0, 0.0, 40.0], -40.0, 30.0), 1.0, 100),
        ("rotary Delta", with_bodies(&rotary(), 0.02, [0.0, 0.0, -40.0], 130.0, 30.0), 0.02, 600),
    ] {
        let asked = Asked { quantity: "clearance", leg: None, given: &[], end: End::Min };
        let problem = Problem::new(&asked.of(&machine, 0.0)).expect("a claim");
        let prover = Prover::new(&problem);
        let unit = (problem.scale as f64).exp2();
        let pairs = problem.obligations.iter().filter_map(|o| match &o.test {
            Test::Apart(apart) => Some(apart),
            _ => None,
        });
        let pairs: Vec<_> = pairs.collect();
        assert_eq!(pairs.len(), 10, "{name}");
        let parameter = |f, x: &[f64]| prover.values(x).of(f).expect("defined").0;
        let distance = |pair: &Apart, x: &[f64]| {
            let values = prover.values(x);
            let point = |p: &Vector| Vector3::from_fn(|k, _| values.of(p[k]).expect("defined").0);
            let [first, second] = pair.ends.each_ref().map(|ends| ends.each_ref().map(point));
            let (weights, between) = nearest(first, second);
            (weights, between.norm() - parameter(pair.distance, x))
        };
        let (worst, at, which) = (0..pairs.len())
            .map(|i| {
                let (worst, at) = prover.greatest(|x| -distance(pairs[i], x).1);
                (-worst * unit, at, i)
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .expect("pairs");
        println!("{name}: nearest {worst} of pair {which}");
        assert!(worst > 0.5 * part, "{name}: {worst}");
        let ([s, t], _) = distance(pairs[which], &at);
        let weights = [s, t, 1.0].map(|x| (x * 1_048_576.0).round() as i64).to_vec();
        asked.is_decided(&machine, worst, most, |_| {
            (at.clone(), Failure::Obligation(1 + which, vec![weights.clone()]))
        });
    }
}

/// Two bars of a parallelogram, 40 to either side of a leg: `80 sqrt(1 - (A_y/L)^2)` from axis to axis.
#[test]
fn bars_of_a_parallelogram() {
    let asked = Asked { quantity: "clearance", leg: None, given: &[], end: End::Min };
    let mut machine = orthoglide();
    for side in [-40.0, 40.0] {
        let offset = Some([0.0, side, 0.0].map(number));
        let trim = [0.0, 0.0].map(number);
        machine.bodies.push(Body::Leg { leg: 1, radius: number(4.0), trim, offset });
    }
    let worst = 80.0 * (1.0 - (125.0 / 310.7f64).powi(2)).sqrt() - 8.0;
    asked.is_decided(&machine, worst, 1, |problem| {
        let at = [0.0, 125.0, 0.0].map(|x| x / (problem.scale as f64).exp2());
        (at.to_vec(), Failure::Obligation(1, Vec::new()))
    });
    // A bar and the leg itself; two bodies on the leg itself have no distance to keep.
    let rod = |offset| Body::Leg {
        leg: 1,
        radius: number(4.0),
        trim: [number(0.0), number(0.0)],
        offset,
    };
    machine.bodies[1] = rod(None);
    assert!(certify(&asked.of(&machine, worst / 2.0 - 4.1), 4).is_some());
    assert!(certify(&asked.of(&machine, worst / 2.0 - 3.9), 4).is_none());
    machine.bodies[0] = rod(None);
    assert!(Problem::new(&asked.of(&machine, 1.0)).is_err());
}

#[test]
fn bodies_and_directions_that_show_nothing() {
    let machine = with_bodies(&linear_delta(SLAB), 1.0, [0.0, 0.0, -40.0], 130.0, 30.0);
    let asked = Asked { quantity: "clearance", leg: None, given: &[], end: End::Min };
    let proof = certify(&asked.of(&machine, 5.0), 20).expect("a proof");
    check(&proof).expect("accepted");
    for (defect, change) in [
        (
            "no direction",
            (|g| g.y.iter_mut().flatten().for_each(|g| *g = 0)) as fn(&mut Multiplier),
        ),
        ("the other way", |g| g.y.iter_mut().flatten().for_each(|g| *g = -*g)),
        ("varied beyond", |g| g.y.iter_mut().for_each(|row| row[1] = 1 << 40)),
        ("a row too few", |g| drop(g.y.pop())),
        ("an entry too few", |g| g.y[0].truncate(3)),
        ("too many places", |g| g.places = 64),
        ("across", |g| g.y.rotate_left(1)),
    ] {
        let mut changed = proof.clone();
        let Proof::Tree(tree) = &mut changed.proof else { panic!("a tree") };
        for Step(_, evidence) in tree.nodes.iter_mut().flat_map(|node| &mut node.by) {
            if let Evidence::Direction(g) = evidence {
                change(g);
            }
        }
        assert!(check(&changed).is_err(), "{defect}");
    }
    let well_formed = |change: &dyn Fn(&mut MachineClaim)| {
        let mut claim = asked.of(&machine, 5.0);
        change(&mut claim);
        Problem::new(&claim).is_ok()
    };
    assert!(well_formed(&|_| ()));
    let rod = |leg, radius, trim: [f64; 2]| Body::Leg {
        leg,
        radius: number(radius),
        trim: trim.map(number),
        offset: None,
    };
    type Change<'a> = &'a dyn Fn(&mut MachineClaim);
    let all: [(&str, Change<'_>); 8] = [
        ("bodies that nothing is asked of", &|claim| claim.require.clear()),
        ("no bodies", &|claim| claim.bodies.clear()),
        ("bodies of one leg alone", &|claim| {
            claim.bodies = vec![rod(1, 1.0, [0.0, 200.0]), rod(1, 2.0, [200.0, 0.0])];
        }),
        ("a leg that is not", &|claim| claim.bodies.push(rod(4, 1.0, [0.0, 0.0]))),
        ("leg zero", &|claim| claim.bodies.push(rod(0, 1.0, [0.0, 0.0]))),
        ("no radius", &|claim| claim.bodies.push(rod(1, 0.0, [0.0, 0.0]))),
        ("a trim less than zero", &|claim| claim.bodies.push(rod(1, 1.0, [0.0, -1.0]))),
        ("too many bodies", &|claim| {
            claim.bodies.extend((0..20).map(|_| rod(1, 1.0, [0.0, 0.0])));
        }),
    ];
    for (defect, change) in all {
        assert!(!well_formed(change), "{defect}");
    }
    assert!(Problem::new(&asked.of(&machine, -1.0)).is_err(), "a gap less than zero");
    // Rods without trims meet at the platform.
    let untrimmed = with_bodies(&linear_delta(SLAB), 1.0, [0.0, 0.0, -40.0], 130.0, 0.0);
    assert!(certify(&asked.of(&untrimmed, 0.0), 60).is_none());
    let claim = asked.of(&untrimmed, 0.0);
    let problem = Problem::new(&claim).expect("well formed");
    let refuted = |weights: [i64; 3]| {
        let fails = Failure::Obligation(1, vec![weights.to_vec()]);
        check(&refutation(&problem, &claim, &[0.0, 0.0, 0.001], &[], &fails)).is_ok()
    };
    assert!(refuted([1, 1, 1]));
    for weights in [[0, 0, 1], [2, 2, 1], [0, 0, 0], [-1, -1, -1], [1, 1, -1]] {
        assert!(!refuted(weights), "{weights:?}");
    }
}
