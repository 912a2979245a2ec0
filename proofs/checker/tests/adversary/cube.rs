//! The paper's cube and the postulate: bounds are met with equality at `Q_1` and `Q_2`, where no
//! strict rule may hold; and where a rule holds, so does what it says.

use super::random::Random;
use super::truth::{dot, singular, V};
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_checker::cell::{Axis, Cell, Edge};
use orthocert_checker::claim::{MachineClaim, Mechanism, Range, Requirements, Workspace};
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::expansion::{Expansion, ExpansionPoint};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use orthocert_checker::postulate::{self, BlowUp, Face, Half, Part};
use orthocert_checker::rule::{self, Rotation, TightCorner};
use std::array::from_fn;

const BITS: u32 = 128;
const CORNERS: [TightCorner; 2] = [TightCorner::Q1, TightCorner::Q2];

/// `q_1`, `q_2` for `L = 1` and this form of `t_2`.
fn ends(kappa: f64, half: Half) -> [f64; 2] {
    let t1 = (1.0 - kappa) / 2.0;
    let t2 = match half {
        Half::Low => 1.0 - kappa,
        Half::High => (1.0 / kappa - 1.0) / 2.0,
    };
    [-t1 / (1.0 + 2.0 * t1 * t1).sqrt(), t2 / (1.0 + 2.0 * t2 * t2).sqrt()]
}

/// `M` of the Orthoglide with `L = 1`.
fn orthoglide(p: V) -> [V; 3] {
    from_fn(|i| {
        let s = (1.0 - dot(p, p) + p[i] * p[i]).sqrt();
        from_fn(|j| if i == j { 1.0 } else { p[j] / s })
    })
}

/// The least eigenvalue of `sym(M) - kappa I`.
fn least_eigenvalue(p: V, kappa: f64) -> f64 {
    let m = orthoglide(p);
    // Shifted to be positive semidefinite, so that singular values are eigenvalues.
    let shift = 4.0;
    let t: [V; 3] =
        from_fn(|i| from_fn(|j| (m[i][j] + m[j][i]) / 2.0 + if i == j { shift } else { 0.0 }));
    singular(&t).0[0] - shift - kappa
}

/// A dyadic cell of a random shape that touches the corner, or lies anywhere.
fn random_cell(random: &mut Random, touching: Option<TightCorner>) -> Cell {
    let edges = from_fn(|_| {
        let level = random.below(7) as u32;
        let last = (1u128 << level) - 1;
        let index = match touching {
            None => u128::from(random.below(1 << level)),
            Some(TightCorner::Q1) => 0,
            Some(TightCorner::Q2) => last,
        };
        Edge { index, level }
    });
    Cell { edges }
}

fn fixed(x: f64) -> Fixed {
    Fixed::rational(&BigRational::from_float(x).expect("finite"), 0, BITS)
}

#[test]
fn no_strict_rule_holds_at_a_tight_corner() {
    for psi in ["101/100", "3/2", "2", "3", "20", "1000", "sqrt(3)", "sqrt(5)"] {
        let psi_max = Exact::parse(psi, 100).expect("a number");
        let low = psi_max.compare(&Exact::integer(2)) != Some(std::cmp::Ordering::Less);
        let high = psi_max.compare(&Exact::integer(2)) != Some(std::cmp::Ordering::Greater);
        let claim = MachineClaim {
            mechanism: Mechanism::Orthoglide { offset: Exact::integer(0) },
            workspace: Workspace::Cube { side: Exact::integer(200) },
            requirements: Requirements {
                transmission: Some(Range { min: None, max: Some(psi_max) }),
                ..Requirements::default()
            },
        };
        let model = Model::new(&claim, BITS).expect("enclosed");
        for corner in CORNERS {
            let mut cell = Cell::ROOT;
            let mut closed_at = None;
            for depth in 0..90 {
                let expand = |point| Expansion::new(&model, &cell, point);
                if let Ok(e) = expand(ExpansionPoint::Centre) {
                    if corner == TightCorner::Q1 || low {
                        let holds = rule::lower(&model, &e, &Rotation::IDENTITY).is_ok();
                        assert!(!holds, "lower at {corner:?}, psi_max {psi}, depth {depth}");
                    }
                    if corner == TightCorner::Q2 && high {
                        let holds = rule::upper(&model, &e).is_ok();
                        assert!(!holds, "upper at {corner:?}, psi_max {psi}, depth {depth}");
                    }
                }
                let about = expand(corner.expansion_point());
                if about.is_ok_and(|e| rule::corner(&model, &e).is_ok()) {
                    closed_at = closed_at.or(Some(depth));
                }
                let (lower, upper) = cell.halves(Axis::ALL[depth % 3]).expect("not too deep");
                cell = if corner == TightCorner::Q1 { lower } else { upper };
            }
            assert!(closed_at.is_some_and(|d| d < 12), "{corner:?}, psi_max {psi}");
        }
    }
}

/// A random blow-up over an interval of `kappa`: on the cube, or on a face.
fn random_blow_up(
    random: &mut Random,
    half: Half,
    kappa: [f64; 2],
    touching: Option<TightCorner>,
) -> ([Part; 3], TightCorner, Option<BlowUp<Fixed>>) {
    let enclosed = fixed(kappa[0]).join(&fixed(kappa[1]));
    let Cell { edges: [x, y, z] } = random_cell(random, touching);
    let face = match random.below(3) {
        0 => Part::Edge(x),
        1 => Part::AtQ1,
        _ => Part::AtQ2,
    };
    let normaliser = match face {
        Part::AtQ1 => TightCorner::Q1,
        _ => TightCorner::Q2,
    };
    let parts = [face, Part::Edge(y), Part::Edge(z)];
    (parts, normaliser, BlowUp::new(&enclosed, half, normaliser, parts))
}

fn random_kappa(random: &mut Random, half: Half) -> [f64; 2] {
    let (from, to) = match half {
        Half::Low => (0.05, 0.5),
        Half::High => (0.5, 0.95),
    };
    let least = random.between(from, to);
    let width = (to - least) * (-(random.below(12) as f64)).exp2();
    [least, random.between(least, least + width)]
}

/// A random point of the box for one `kappa`, as parts `u`.
fn random_place(random: &mut Random, parts: &[Part; 3]) -> V {
    from_fn(|k| match parts[k] {
        Part::AtQ1 => 0.0,
        Part::AtQ2 => 1.0,
        Part::Edge(e) => {
            let within = match random.below(4) {
                0 => 0.0,
                1 => 1.0,
                _ => random.between(0.0, 1.0),
            };
            (e.index as f64 + within) / f64::from(e.level).exp2()
        }
    })
}

#[test]
fn the_blow_up_is_the_matrix_that_it_stands_for() {
    let mut random = Random::new(8);
    let mut tried = 0;
    for _ in 0..1500 {
        let half = if random.coin() { Half::Low } else { Half::High };
        let kappa = random_kappa(&mut random, half);
        let about = [None, Some(TightCorner::Q1), Some(TightCorner::Q2)][random.below(3) as usize];
        let (parts, normaliser, blow_up) = random_blow_up(&mut random, half, kappa, about);
        let touches = |part: &Part| {
            !matches!(
                (part, about),
                (Part::AtQ1, Some(TightCorner::Q2)) | (Part::AtQ2, Some(TightCorner::Q1))
            )
        };
        let Some(blow_up) = blow_up.filter(|_| parts.iter().all(touches)) else { continue };
        let Ok(expansion) = blow_up.expand(about) else { continue };
        for _ in 0..6 {
            let kappa = kappa[0] + random.between(0.0, 1.0) * (kappa[1] - kappa[0]);
            let [q1, q2] = ends(kappa, half);
            let u = random_place(&mut random, &parts);
            let m = orthoglide(u.map(|u| q1 + u * (q2 - q1)));
            // lambda_k: where P lies between the expansion point and the extent.
            let lambda: V = from_fn(|k| match parts[k] {
                Part::Edge(e) => {
                    let within = u[k] * f64::from(e.level).exp2() - e.index as f64;
                    match about {
                        None => 2.0 * within - 1.0,
                        Some(TightCorner::Q1) => within,
                        Some(TightCorner::Q2) => 1.0 - within,
                    }
                }
                _ => 0.0,
            });
            let t = match (normaliser, half) {
                (TightCorner::Q1, _) => (1.0 - kappa) / 2.0,
                (TightCorner::Q2, Half::Low) => 1.0 - kappa,
                (TightCorner::Q2, Half::High) => (1.0 / kappa - 1.0) / 2.0,
            };
            for (entry, (i, j)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
                let truth = (m[i][j] + m[j][i]) / t;
                let enclosed = (0..3).fold(expansion.off[entry].clone(), |sum, k| {
                    sum.add(&expansion.slopes[k][entry].mul(&fixed(lambda[k])))
                });
                let slack = fixed(1e-9);
                assert!(enclosed.add(&slack).sub(&fixed(truth)).hi() >= &BigInt::from(0));
                assert!(enclosed.sub(&slack).sub(&fixed(truth)).lo() <= &BigInt::from(0));
            }
            tried += 1;
        }
    }
    assert!(tried > 3000, "{tried}");
}

#[test]
fn where_a_rule_of_the_postulate_holds_so_does_the_bound() {
    let mut random = Random::new(9);
    let mut accepted = [0, 0, 0];
    for round in 0..6000 {
        let half = if random.coin() { Half::Low } else { Half::High };
        let mut kappa = random_kappa(&mut random, half);
        if round % 3 == 0 {
            // The other form of t_2, with which the bound fails near Q_2 for kappa < 1/2.
            kappa = random_kappa(&mut random, Half::Low);
        }
        let about = [None, Some(TightCorner::Q1), Some(TightCorner::Q2)][random.below(3) as usize];
        let (parts, _, blow_up) = random_blow_up(&mut random, half, kappa, about);
        let Some(blow_up) = blow_up else { continue };
        let holds = match about {
            None => postulate::blow_up(&blow_up),
            Some(corner) => postulate::edge(&blow_up, corner),
        };
        if holds.is_err() {
            continue;
        }
        accepted[about.map_or(2, |corner| corner as usize)] += 1;
        for _ in 0..20 {
            let kappa = kappa[0] + random.between(0.0, 1.0) * (kappa[1] - kappa[0]);
            let [q1, q2] = ends(kappa, half);
            let p = random_place(&mut random, &parts).map(|u| q1 + u * (q2 - q1));
            let least = least_eigenvalue(p, kappa);
            assert!(least > -1e-12, "{least} at {p:?}, kappa {kappa}, {parts:?}, {about:?}");
        }
    }
    assert!(accepted.iter().all(|&n| n > 100), "{accepted:?}");
}

#[test]
fn the_strict_rule_of_the_postulate_fails_on_cells_with_a_tight_corner() {
    let mut random = Random::new(10);
    for _ in 0..3000 {
        let half = if random.coin() { Half::Low } else { Half::High };
        let corner = CORNERS[random.below(2) as usize];
        if (half, corner) == (Half::High, TightCorner::Q2) {
            continue;
        }
        let kappa = random_kappa(&mut random, half);
        let (parts, _, blow_up) = random_blow_up(&mut random, half, kappa, Some(corner));
        let excluded = match corner {
            TightCorner::Q1 => Part::AtQ2,
            TightCorner::Q2 => Part::AtQ1,
        };
        if let Some(blow_up) = blow_up.filter(|_| !parts.contains(&excluded)) {
            assert!(postulate::blow_up(&blow_up).is_err(), "{parts:?}, kappa {kappa:?}");
        }
    }
}

#[test]
fn beyond_its_half_the_edge_at_q2_is_refused() {
    for kappa in [0.4, 0.49, 0.499_999_999] {
        let cell = (0..60).fold(Cell::ROOT, |cell: Cell, depth| {
            cell.halves(Axis::ALL[depth % 3]).expect("not too deep").1
        });
        let on_cube = |half| postulate::on_cube(&fixed(kappa), half, &cell).expect("enclosed");
        assert!(postulate::edge(&on_cube(Half::Low), TightCorner::Q2).is_ok());
        assert!(postulate::edge(&on_cube(Half::High), TightCorner::Q2).is_err());
        assert!(postulate::blow_up(&on_cube(Half::High)).is_err());
    }
}

#[test]
fn the_trees_of_a_face_reach_both_ends_of_kappa() {
    // The halves [0, 1/2] and [1/2, 1] with their ends, where constants degenerate.
    let (zero, half) = (fixed(0.0), fixed(0.5));
    for (least, which) in [(&zero, Half::Low), (&half, Half::High)] {
        for (face, corner) in [(Face::Q1, TightCorner::Q1), (Face::Q2, TightCorner::Q2)] {
            for (kappa_up, small) in [(false, 8), (true, 8)] {
                let mut cell = Cell::ROOT;
                for _ in 0..small {
                    for axis in Axis::FACE {
                        let (lower, upper) = cell.halves(axis).expect("not too deep");
                        let up = match axis {
                            Axis::Kappa => kappa_up,
                            _ => corner == TightCorner::Q2,
                        };
                        cell = if up { upper } else { lower };
                    }
                }
                let blow_up = postulate::on_face(least, &half, which, face, &cell);
                let blow_up = blow_up.expect("enclosed");
                assert!(postulate::edge(&blow_up, corner).is_ok(), "{which:?} {face:?} {cell}");
                let other = CORNERS.into_iter().find(|&c| c != corner).expect("two corners");
                assert!(postulate::edge(&blow_up, other).is_err());
            }
        }
    }
}

#[test]
fn mirror_holds_exactly_where_u_y_is_nowhere_less_than_u_z() {
    for (a, b) in [(0, 0), (1, 3), (3, 1), (2, 2), (4, 3)] {
        for y in 0..1u128 << a {
            for z in 0..1u128 << b {
                let edge = |index, level| Edge { index, level };
                let cell = Cell { edges: [edge(0, 0), edge(y, a), edge(z, b)] };
                let y_low = y as f64 / f64::from(a).exp2();
                let z_high = (z + 1) as f64 / f64::from(b).exp2();
                assert_eq!(postulate::mirror(&cell).is_ok(), y_low >= z_high, "{cell}");
            }
        }
    }
}
