//! One to one, of platforms that turn.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::motions::{decimal, rotation};
use crate::prover::{certify, Prover};
use crate::turning::{
    arm, hexapod_legs, on_circle, planar, slider_legs, spatial, spherical, strut, FIFTEEN,
};
use nalgebra::DMatrix;
use orthocert_kernel::certificate::{Evidence, Failure, Proof, Step, Tree, Witness};
use orthocert_kernel::check::check;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::Test;
use orthocert_kernel::test::Multiplier;
use orthocert_kernel::witness::{self, WitnessError};

const ONE_TO_ONE: &str = r#"{"quantity":"one_to_one","end":"holds"}"#;
const SQUARE: [&str; 2] = [r#""-0.2","-0.2""#, r#""0.2","0.2""#];

fn rpr() -> Vec<String> {
    [90.0, 210.0, 330.0].map(|at| strut(&on_circle(1.0, at), &on_circle(0.5, at + 80.0))).to_vec()
}

fn machines() -> Vec<String> {
    let arms: Vec<String> = [90.0, 210.0, 330.0]
        .map(|at| arm(&on_circle(1.2, at), &on_circle(0.3, at + 60.0), "+"))
        .to_vec();
    let mut mixed = hexapod_legs();
    mixed[0] = slider_legs()[0].clone();
    vec![
        spatial(&hexapod_legs(), FIFTEEN, ONE_TO_ONE),
        spatial(&slider_legs(), FIFTEEN, ONE_TO_ONE),
        spatial(&mixed, FIFTEEN, ONE_TO_ONE),
        planar(&rpr(), SQUARE, r#""-20","20""#, ONE_TO_ONE),
        planar(&arms, SQUARE, r#""-20","20""#, ONE_TO_ONE),
        spherical(FIFTEEN, ONE_TO_ONE),
    ]
}

fn rows(problem: &Problem) -> &[orthocert_kernel::test::Row<orthocert_kernel::formula::Formula>] {
    let rows = problem.obligations.iter().find_map(|o| match &o.test {
        Test::OneToOne(rows) => Some(rows),
        _ => None,
    });
    rows.expect("an obligation")
}

/// The rows at a point in the unit of the problem.
fn matrix(prover: &Prover<'_>, x: &[f64]) -> DMatrix<f64> {
    let values = prover.values(x);
    let rows = rows(prover.problem);
    let all = rows.iter().flat_map(|row| &row.a).map(|&f| values.of(f).expect("defined").0);
    DMatrix::from_row_iterator(rows.len(), x.len(), all)
}

/// The vector of the leg, and its moment about the origin by its base end; times `w` if all legs are
/// struts.
#[test]
fn moments_are_about_the_origin() {
    for text in machines() {
        let problem = Problem::new(&claim(&text)).expect("well formed");
        let prover = Prover::new(&problem);
        let lengths = problem.corners[0].len();
        let scaled = problem.legs.iter().all(|leg| leg.scaled.is_some());
        for x in prover.grid(if problem.dimension() > 3 { 2 } else { 4 }) {
            let values = prover.values(&x);
            let of = |f| values.of(f).expect("defined").0;
            let w = if scaled { of(problem.weight.expect("turns")) } else { 1.0 };
            let found = matrix(&prover, &x);
            for (i, leg) in problem.legs.iter().enumerate() {
                let tip = leg.tip.expect("an end").map(of);
                let mut a = [0.0; 3];
                match lengths {
                    // Of a strut about the origin, the tip less the anchor.
                    0 => {
                        let anchor = leg.ends.expect("a strut")[0].map(of);
                        a = std::array::from_fn(|k| tip[k] - anchor[k]);
                    }
                    _ => (0..lengths).for_each(|k| a[k] = of(leg.row.a[k])),
                }
                let base: Vec<f64> = (0..3).map(|k| tip[k] - a[k]).collect();
                let cross = |k: usize| {
                    base[(k + 1) % 3] * a[(k + 2) % 3] - base[(k + 2) % 3] * a[(k + 1) % 3]
                };
                let moment: Vec<f64> =
                    if lengths == 2 { vec![cross(2)] } else { (0..3).map(cross).collect() };
                let unit = if lengths == 0 { (problem.scale as f64).exp2() } else { 1.0 };
                let expected = a[..lengths].iter().copied().chain(moment.iter().map(|m| m * unit));
                for (found, expected) in found.row(i).iter().zip(expected) {
                    assert!((found - w * expected).abs() < 1e-9, "{found} {expected}: {text}");
                }
                assert_eq!(
                    rows(&problem)[i].d,
                    if scaled { leg.scaled.as_ref().expect("scaled").d } else { leg.row.d }
                );
            }
        }
    }
}

/// Legs made to have the same joint coordinates at two poses, with their base ends at the same distance
/// from both platform ends: their rows have a sum that is singular, and those of `M`, with moments
/// about `P`, do not.
#[test]
fn the_sum_over_two_poses_with_the_same_joints_is_singular() {
    let mut random = Random(11);
    let mut number = |size: f64| size * (random.below(2001) as f64 / 1000.0 - 1.0);
    let poses = [[0.15, -0.1, 0.9, 0.1, -0.2, 0.15], [-0.1, 0.2, 1.1, -0.1, 0.15, 0.3]];
    let text = |x: [f64; 3]| x.map(|x| format!("\"{}\"", decimal(x))).join(",");
    let mut leg = |is_strut: bool| {
        let b: [f64; 3] = std::array::from_fn(|_| number(0.5));
        let ends = poses.map(|[x, y, z, c @ ..]| {
            let r = rotation("angle", &c);
            let turned = r.map(|row| row[0] * b[0] + row[1] * b[1] + row[2] * b[2]);
            [x + turned[0], y + turned[1], z + turned[2]]
        });
        let off: [f64; 3] = std::array::from_fn(|k| ends[1][k] - ends[0][k]);
        let v = [number(4.0), number(4.0), number(4.0)];
        let base: [f64; 3] = std::array::from_fn(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            0.5 * (ends[0][k] + ends[1][k]) + off[i] * v[j] - off[j] * v[i]
        });
        if is_strut {
            return strut(&text(base), &text(b));
        }
        let along: [f64; 3] = std::array::from_fn(|k| ends[0][k] + ends[1][k] - 2.0 * base[k]);
        let length = (0..3).map(|k| (ends[0][k] - base[k]).powi(2)).sum::<f64>().sqrt();
        // The carriage is half a direction from the anchor.
        let anchor: [f64; 3] = std::array::from_fn(|k| base[k] - 0.5 * along[k]);
        format!(
            r#"{{"drive":"slider","direction":[{}],"anchor":[{}],"platform":[{}],"length":"{}","mode":"+"}}"#,
            text(along),
            text(anchor),
            text(b),
            decimal(length)
        )
    };
    for struts in [6, 3, 0] {
        let legs: Vec<String> = (0..6).map(|i| leg(i < struts)).collect();
        let text = spatial(&legs, r#"{"angle":"80"}"#, ONE_TO_ONE);
        let problem = Problem::new(&claim(&text)).expect("well formed");
        let prover = Prover::new(&problem);
        let unit = (problem.scale as f64).exp2();
        let at = poses.map(|[x, y, z, c @ ..]| [&[x, y, z].map(|x| x / unit)[..], &c].concat());
        let [one, other] = at.each_ref().map(|x| {
            let w = if struts == 6 { 1.0 + x[3..].iter().map(|c| c * c).sum::<f64>() } else { 1.0 };
            matrix(&prover, x) / w
        });
        let least = |m: DMatrix<f64>| m.singular_values().min();
        assert!(least(one + other) < 1e-7, "{struts}");
        let [one, other] = at.each_ref().map(|x| {
            let values = prover.values(x);
            let rows = problem.legs.iter().flat_map(|leg| &leg.row.a);
            let all = rows.map(|&f| values.of(f).expect("defined").0);
            DMatrix::from_row_iterator(6, 6, all)
        });
        assert!(least(one + other) > 1e-4, "{struts}");
    }
}

#[test]
fn platforms_that_turn_are_one_to_one() {
    for text in [
        spatial(&hexapod_legs(), FIFTEEN, ONE_TO_ONE),
        planar(&rpr(), SQUARE, r#""-20","20""#, ONE_TO_ONE),
        spherical(FIFTEEN, ONE_TO_ONE),
    ] {
        let proof = certify(&claim(&text), 9).unwrap_or_else(|| panic!("no proof: {text}"));
        check(&proof).unwrap_or_else(|e| panic!("{e}: {text}"));
        let Proof::Tree(tree) = &proof.proof else { panic!("a tree") };
        let by = Step(1, Evidence::Control(Box::new(Evidence::Chords)));
        assert!(tree.nodes.iter().any(|node| node.by.contains(&by)));
        for change in [
            (|tree| tree.chords = None) as fn(&mut Tree),
            |tree| tree.chords.as_mut().expect("Y").y.iter_mut().flatten().for_each(|y| *y = -*y),
            |tree| tree.chords.as_mut().expect("Y").y.iter_mut().flatten().for_each(|y| *y = 0),
            |tree| tree.chords.as_mut().expect("Y").y[0].iter_mut().for_each(|y| *y = -*y),
            |tree| tree.chords.as_mut().expect("Y").y.swap(0, 1),
            |tree| drop(tree.chords.as_mut().expect("Y").y.pop()),
            |tree| tree.chords.as_mut().expect("Y").places = 64,
        ] {
            let mut changed = proof.clone();
            let Proof::Tree(tree) = &mut changed.proof else { panic!("a tree") };
            change(tree);
            check(&changed).expect_err(&text);
        }
    }
}

#[test]
fn what_is_not_one_to_one_is_not_proved() {
    // Similar hexagons, alike: singular wherever the platform is not turned.
    let similar = |i: usize| {
        let at = i as f64 * 60.0 + if i.is_multiple_of(2) { 0.0 } else { 20.0 };
        let (base, platform) = (on_circle(1.0, at), on_circle(0.5, at));
        strut(&format!(r#"{base},"0""#), &format!(r#"{platform},"0""#))
    };
    let similar: Vec<String> = (0..6).map(similar).collect();
    let yaw = r#"{"roll_pitch_yaw":{"roll":["0","0"],"pitch":["0","0"],"yaw":["60","110"]}}"#;
    let mirrored = spatial(&hexapod_legs(), FIFTEEN, ONE_TO_ONE).replace(r#""0.8""#, r#""-1.2""#);
    for text in [
        spatial(&similar, r#"{"angle":"5"}"#, ONE_TO_ONE),
        spatial(&hexapod_legs(), yaw, ONE_TO_ONE),
        mirrored,
    ] {
        assert!(certify(&claim(&text), 9).is_none(), "{text}");
    }
}

#[test]
fn orientations_differ_by_less_than_half_a_turn() {
    let rpy = |roll: &str, pitch: &str, yaw: &str| {
        format!(r#"{{"roll_pitch_yaw":{{"roll":[{roll}],"pitch":[{pitch}],"yaw":[{yaw}]}}}}"#)
    };
    let tilt = |tilt: &str, torsion: &str| {
        format!(r#"{{"tilt":{{"tilt":"{tilt}","torsion":"{torsion}"}}}}"#)
    };
    let (ten, most) = (r#""-10","10""#, r#""-89.9","89.9""#);
    for (orientation, holds) in [
        (r#"{"angle":"89.99"}"#.to_owned(), true),
        (r#"{"angle":"90"}"#.to_owned(), false),
        (tilt("40", "49.9"), true),
        (tilt("40", "50"), false),
        (rpy(ten, most, r#""0","159.9""#), true),
        (rpy(ten, ten, r#""0","160""#), false),
        (rpy(ten, r#""-90","10""#, ten), false),
        (rpy(ten, r#""-10","90""#, ten), false),
        (rpy(ten, r#""80","100""#, ten), false),
        (rpy(r#""-90","90""#, ten, r#""0","0""#), false),
    ] {
        let text = spatial(&hexapod_legs(), &orientation, ONE_TO_ONE);
        assert_eq!(Problem::new(&claim(&text)).is_ok(), holds, "{orientation}");
        let text = spherical(&orientation, ONE_TO_ONE);
        assert_eq!(Problem::new(&claim(&text)).is_ok(), holds, "{orientation}");
        Problem::new(&claim(&spherical(&orientation, ""))).expect("well formed without");
    }
    for (range, holds) in [(r#""0","179.9""#, true), (r#""-90","90""#, false)] {
        let text = planar(&rpr(), SQUARE, range, ONE_TO_ONE);
        assert_eq!(Problem::new(&claim(&text)).is_ok(), holds, "{range}");
    }
}

fn numbers(x: &[f64]) -> Vec<Expression> {
    let of = |x: f64| Expression::try_from(decimal(x)).expect("a number");
    x.iter().map(|&x| of((x * 1e6).round() / 1e6)).collect()
}

/// The pose on the other side of the base, in a box of this half-width.
fn mirrored(orientation: &str, low: &str, half: f64) -> Result<(), WitnessError> {
    let text = spatial(&hexapod_legs(), orientation, ONE_TO_ONE);
    let claim = claim(&text.replace(r#""0.8""#, &format!("\"{low}\"")));
    let problem = Problem::new(&claim).expect("well formed");
    let prover = Prover::new(&problem);
    let unit = (problem.scale as f64).exp2();
    // Of rotation vectors, and of roll, pitch and yaw, the first two change their sign.
    let at = |sign: f64| vec![0.05, 0.02, sign, 0.1 * sign, 0.05 * sign, 0.02];
    let (one, other) = (at(1.0), at(-1.0));
    // The inverse of the derivative of the lengths by the coordinates, by differences.
    let lengths = |x: &[f64]| -> Vec<f64> {
        let x: Vec<f64> =
            x.iter().enumerate().map(|(k, x)| if k < 3 { x / unit } else { *x }).collect();
        let values = prover.values(&x);
        problem
            .legs
            .iter()
            .map(|leg| values.of(leg.length.expect("a strut")).expect("defined").0)
            .collect()
    };
    let step = 1e-5;
    let mut derivative = DMatrix::zeros(6, 6);
    for k in 0..6 {
        let moved = |sign: f64| {
            let mut x = other.clone();
            x[k] += sign * step;
            lengths(&x)
        };
        let (more, less) = (moved(1.0), moved(-1.0));
        let by = 2.0 * step / if k < 3 { unit } else { 1.0 };
        (0..6).for_each(|i| derivative[(i, k)] = (more[i] - less[i]) / by);
    }
    let inverse = derivative.try_inverse().expect("regular");
    let row = |i: usize| inverse.row(i).iter().map(|y| (y * 30f64.exp2()).round() as i64).collect();
    let inverse = Multiplier { y: (0..6).map(row).collect(), places: 30 };
    let moved = |by: f64| -> Vec<f64> { other.iter().map(|x| x + by).collect() };
    let (least, greatest) = (numbers(&moved(-half)), numbers(&moved(half)));
    let fails = Failure::Same { obligation: 1, least, greatest, inverse };
    let witness = Witness { precision: 128, point: numbers(&one), machine: vec![], fails };
    witness::check(&problem, &claim.workspace, &witness)
}

#[test]
fn a_pose_and_its_mirror_image() {
    // Rodrigues coordinates of (0.1, 0.05, 0.02): 12.96 degrees.
    assert_eq!(mirrored(r#"{"angle":"20"}"#, "-1.2", 1e-4), Ok(()));
    assert_eq!(mirrored(r#"{"angle":"13"}"#, "-1.2", 1e-4), Ok(()));
    // The point is in the set, the box not all.
    assert_eq!(mirrored(r#"{"angle":"12.97"}"#, "-1.2", 1e-4), Err(WitnessError::NotViolated));
    assert_eq!(mirrored(r#"{"angle":"12.97"}"#, "-1.2", 1e-6), Ok(()));
    assert_eq!(mirrored(r#"{"angle":"20"}"#, "0.8", 1e-4), Err(WitnessError::Outside));
    // So large a box that nothing is certain.
    assert!(mirrored(r#"{"angle":"40"}"#, "-1.2", 0.1).is_err());
    let rpy = |roll: &str| {
        format!(r#"{{"roll_pitch_yaw":{{"roll":[{roll}],"pitch":["-9","9"],"yaw":["-9","9"]}}}}"#)
    };
    assert_eq!(mirrored(&rpy(r#""-20","20""#), "-1.2", 1e-4), Ok(()));
    // Its roll is another one than the workspace has.
    assert_eq!(mirrored(&rpy(r#""0","20""#), "-1.2", 1e-4), Err(WitnessError::NotViolated));
}
