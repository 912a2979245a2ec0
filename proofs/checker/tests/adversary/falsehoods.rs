//! Claims that are false by a hair at one point: no rule may discharge the violated obligation on
//! any cell that contains the point, whatever the evidence; and a witness refutes them. Claims that
//! hold there with room to spare: the rules do, on small cells, and no witness is accepted.

use super::case::{cells_around, discharged, with_tolerances, workspace, Case};
use super::random::Random;
use super::truth::{self, determinant, exact, Leg, V};
use orthocert_checker::cell::Cell;
use orthocert_checker::certificate::{LegNumber, SecondPoint, Violation, Witness};
use orthocert_checker::claim::{AtLeast, MachineClaim, Mechanism, Range, Requirements, Workspace};
use orthocert_checker::model::Model;
use orthocert_checker::rule;
use orthocert_checker::witness;
use std::array::from_fn;
use std::collections::BTreeMap;

#[test]
fn no_rule_holds_where_a_claim_is_false_by_a_hair() {
    let mut random = Random::new(1);
    let mut tried = 0;
    for round in 0..240 {
        let case = Case::random(&mut random);
        let (leg, at_min) = (random.below(3) as usize, random.coin());
        let hair = [1e-6, 1e-3, 0.1][random.below(3) as usize];
        let (workspace, min, max) = workspace(&mut random, case.p, case.unit);
        let mut claim = case.claim(workspace, case.requirements(-hair, leg, at_min));
        let toleranced = random.coin();
        if toleranced {
            claim = with_tolerances(&mut random, claim, case.unit);
        }
        if claim.validate().is_err() {
            continue;
        }
        let bits = [32, 48, 64, 128][random.below(4) as usize];
        let Ok(model) = Model::new(&claim, bits) else { continue };
        tried += 1;
        let (rotations, mus) = (case.rotations(&mut random), case.mus(&mut random));
        for cell in cells_around(&mut random, case.p, min, max, 36) {
            let accepted: Vec<_> = discharged(&model, &cell, &rotations, &mus)
                .into_iter()
                .filter_map(|(rule, holds)| holds.then_some(rule))
                .collect();
            assert_eq!(accepted, [""; 0], "round {round}, {cell}: {:?}", case.legs);
        }
    }
    assert!(tried > 150, "{tried}");
}

#[test]
fn the_rules_hold_on_small_cells_where_there_is_room() {
    let mut random = Random::new(2);
    let mut counts: BTreeMap<&'static str, [usize; 2]> = BTreeMap::new();
    for _ in 0..120 {
        let case = Case::random(&mut random);
        let (leg, at_min) = (random.below(3) as usize, random.coin());
        let (workspace, min, max) = workspace(&mut random, case.p, case.unit);
        let claim = case.claim(workspace, case.requirements(1e-2, leg, at_min));
        if claim.validate().is_err() {
            continue;
        }
        let model = Model::new(&claim, 128).expect("enclosed");
        let (rotations, mus) = (case.rotations(&mut random), case.mus(&mut random));
        let cell = cells_around(&mut random, case.p, min, max, 90)[90];
        for (rule, holds) in discharged(&model, &cell, &rotations, &mus) {
            counts.entry(rule).or_default()[usize::from(holds)] += 1;
        }
    }
    assert_eq!(counts.remove("outside").map(|[_, accepted]| accepted), Some(0));
    assert_eq!(counts.len(), 9);
    for (rule, [refused, accepted]) in counts {
        assert!(accepted > 19 * refused, "{rule}: refused {refused}, accepted {accepted}");
    }
}

#[test]
fn witnesses_refute_what_is_false_and_nothing_that_is_true() {
    let mut random = Random::new(3);
    for round in 0..300 {
        let case = Case::random(&mut random);
        let (leg, at_min) = (random.below(3) as usize, random.coin());
        let (workspace, _, _) = workspace(&mut random, case.p, case.unit);
        let toleranced = random.coin();
        for slack in [-1e-5, 1e-5] {
            let requirements = case.requirements(slack, leg, at_min);
            let mut claim = case.claim(workspace.clone(), requirements);
            if toleranced {
                claim = with_tolerances(&mut random, claim, case.unit);
            }
            let Mechanism::Translational(legs) = &claim.mechanism else { continue };
            let machine = legs
                .iter()
                .any(|leg| leg.has_tolerance())
                .then(|| case.legs.map(|leg| leg.claimed()));
            if claim.validate().is_err() {
                continue;
            }
            let check = |precision: u32, violates: Violation| {
                let point = case.p.map(exact);
                let machine = machine.clone();
                witness::check(&claim, &Witness { precision, point, machine, violates })
            };
            for violation in case.violations(&claim, leg) {
                let result = check(128, violation.clone());
                assert_eq!(
                    result.is_ok(),
                    slack < 0.0,
                    "round {round}: {violation:?} {result:?} {:?}",
                    case.legs
                );
                if slack > 0.0 {
                    assert!(check(32, violation).is_err());
                }
            }
            for leg in 1..=3 {
                for precision in [32, 128] {
                    assert!(check(precision, Violation::Reach(LegNumber { leg })).is_err());
                }
            }
        }
    }
}

#[test]
fn reach_is_refuted_exactly_out_of_reach() {
    let mut random = Random::new(4);
    let mut counts = [0, 0];
    for _ in 0..1500 {
        let (mut legs, _) = truth::machine(&mut random, 0.1);
        if let (Leg::Arm { arm, .. }, true) = (&mut legs[0], random.coin()) {
            *arm *= (-(random.below(100) as f64)).exp2();
        }
        let p = random.vector(1.5);
        let reach = legs[0].reach(p);
        if reach.abs() < 1e-9 || matches!(legs[0], Leg::Strut { .. }) {
            continue;
        }
        let mechanism = Mechanism::Translational(legs.map(|leg| leg.claimed()));
        let workspace = Workspace::Box { min: p.map(exact), max: p.map(exact) };
        let claim = MachineClaim { mechanism, workspace, requirements: Requirements::default() };
        for precision in [32, 64, 96, 256] {
            let violates = Violation::Reach(LegNumber { leg: 1 });
            let witness = Witness { precision, point: p.map(exact), machine: None, violates };
            let refuted = witness::check(&claim, &witness).is_ok();
            assert!(!(refuted && reach > 0.0), "{precision} bits, {p:?}: {:?}", legs[0]);
            assert!(refuted || reach > 0.0 || precision < 256, "{p:?}: {:?}", legs[0]);
        }
        counts[usize::from(reach > 0.0)] += 1;
    }
    assert!(counts.iter().all(|&n| n > 100), "{counts:?}");
}

#[test]
fn singular_is_accepted_exactly_for_determinants_of_opposite_signs() {
    let mut random = Random::new(5);
    let mut counts = [0, 0];
    for _ in 0..600 {
        let (legs, p) = truth::machine(&mut random, 1e-3);
        let q = random.vector(0.75);
        if !legs.iter().all(|leg| leg.reach(q) > 1e-3) {
            continue;
        }
        let det = |p: V| determinant(&legs.map(|leg| leg.at(p).row));
        if det(p).abs().min(det(q).abs()) < 1e-6 {
            continue;
        }
        let opposite = (det(p) > 0.0) != (det(q) > 0.0);
        let min = from_fn(|k| exact(p[k].min(q[k])));
        let max = from_fn(|k| exact(p[k].max(q[k])));
        let claim = MachineClaim {
            mechanism: Mechanism::Translational(legs.map(|leg| leg.claimed())),
            workspace: Workspace::Box { min, max },
            requirements: Requirements::default(),
        };
        let violates = Violation::Singular(SecondPoint { other: q.map(exact) });
        let witness = Witness { precision: 128, point: p.map(exact), machine: None, violates };
        assert_eq!(witness::check(&claim, &witness).is_ok(), opposite);
        counts[usize::from(opposite)] += 1;
    }
    assert!(counts.iter().all(|&n| n > 20), "{counts:?}");
}

/// The paper's Orthoglide for `psi_max` and a cube of this side, as three sliders, and `q_1`, `q_2`.
fn orthoglide(psi_max: f64, side: f64, offset: f64) -> ([Leg; 3], [f64; 2]) {
    let kappa = 1.0 / psi_max;
    let t1 = (1.0 - kappa) / 2.0;
    let t2 = if kappa <= 0.5 { 1.0 - kappa } else { (psi_max - 1.0) / 2.0 };
    let sine = |t: f64| t / (1.0 + 2.0 * t * t).sqrt();
    let length = side / (sine(t1) + sine(t2));
    let (q1, q2) = (-length * sine(t1), length * sine(t2));
    let legs = from_fn(|i| {
        let along = |x: f64| from_fn(|k| if k == i { x } else { 0.0 });
        Leg::Slider {
            direction: along(1.0),
            anchor: along(q1 - offset - length),
            platform: along(-offset),
            length,
            mode: 1.0,
        }
    });
    (legs, [q1, q2])
}

#[test]
fn the_cube_meets_further_requirements_exactly_where_its_sliders_do() {
    let mut random = Random::new(11);
    let transmission = ["lower", "entrywise", "upper", "outside"];
    for round in 0..60 {
        let psi_max = random.between(1.1, 8.0);
        let side = random.between(0.5, 300.0);
        let offset = random.between(-5.0, 5.0);
        let (legs, [q1, q2]) = orthoglide(psi_max, side, offset);
        let p = from_fn(|_| random.between(q1 + 1e-3 * side, q2 - 1e-3 * side));
        let Some(case) = Case::at(legs, p, side) else { continue };
        let (leg, at_min) = (random.below(3) as usize, random.coin());
        for slack in [-1e-6, 1e-2] {
            let claim = MachineClaim {
                mechanism: Mechanism::Orthoglide { offset: exact(offset) },
                workspace: Workspace::Cube { side: exact(side) },
                requirements: Requirements {
                    transmission: Some(Range { min: None, max: Some(exact(psi_max)) }),
                    ..case.requirements(slack, leg, at_min)
                },
            };
            if claim.validate().is_err() {
                continue;
            }
            let model = Model::new(&claim, 128).expect("enclosed");
            let (rotations, mus) = (case.rotations(&mut random), case.mus(&mut random));
            let cells = cells_around(&mut random, p, [q1; 3], [q2; 3], 60);
            // What is true shows on the smallest cell, what is false on none.
            let passed_over = if slack < 0.0 { 0 } else { cells.len() - 1 };
            for cell in cells.into_iter().skip(passed_over) {
                for (rule, holds) in discharged(&model, &cell, &rotations, &mus) {
                    if !transmission.contains(&rule) {
                        assert_eq!(holds, slack > 0.0, "round {round}: {rule} at {cell}");
                    }
                }
            }
            for violates in case.violations(&claim, leg) {
                let unviolated =
                    matches!(violates, Violation::SigmaMin(_) | Violation::SigmaMax(_));
                let point = p.map(exact);
                let witness = Witness { precision: 128, point, machine: None, violates };
                let refuted = witness::check(&claim, &witness).is_ok();
                assert_eq!(refuted, slack < 0.0 && !unviolated, "round {round}");
            }
        }
    }
}

/// With guides along x and y and a fixed normal along z, `det U = eta_1 eta_2 - x y` for `L = 1`,
/// which is `1 - (x + y)^2/2` up to fourth powers: all of it is of second order about the centre.
/// On `|x|, |y| <= a` the least value is near `1 - 2 a^2`, and the slope form gives just that: it
/// has nothing to spare that would hide a term left out.
#[test]
fn the_slope_form_of_the_determinant_misses_no_term_of_second_order() {
    let a = 0.125;
    let guide = |direction: V| Leg::Slider {
        direction,
        anchor: [0.0; 3],
        platform: [0.0; 3],
        length: 1.0,
        mode: 1.0,
    };
    let (x, y) = (guide([1.0, 0.0, 0.0]), guide([0.0, 1.0, 0.0]));
    let z = Leg::Planar { direction: [0.0, 0.0, 1.0] };
    for legs in [[x, y, z], [x, z, y], [y, x, z], [y, z, x], [z, x, y], [z, y, x]] {
        let corner = determinant(&legs.map(|leg| leg.at([a, a, 0.0]).unit)).abs();
        for (least, holds) in [(corner * (1.0 + 1e-6), false), (1.0 - 2.2 * a * a, true)] {
            let claim = MachineClaim {
                mechanism: Mechanism::Translational(legs.map(|leg| leg.claimed())),
                workspace: Workspace::Box {
                    min: [-a, -a, 0.0].map(exact),
                    max: [a, a, 0.0].map(exact),
                },
                requirements: Requirements {
                    parallel_margin: Some(AtLeast { min: exact(least) }),
                    ..Requirements::default()
                },
            };
            let model = Model::new(&claim, 128).expect("enclosed");
            assert_eq!(rule::parallel_margin(&model, &Cell::ROOT).is_ok(), holds, "{legs:?}");
        }
    }
}
