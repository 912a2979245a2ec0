//! Machines that are singular exactly at a pose: refuted, and those that are only nearly so are not.

use crate::certificates::claim;
use crate::turning::{hexapod_legs, planar, spatial, spherical, strut};
use orthocert_kernel::certificate::{Failure, Witness};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::witness::{check, WitnessError};

type Found = Result<(), WitnessError>;

const NOT: Found = Err(WitnessError::NotViolated);
const ANGLE: &str = r#"{"angle":"15"}"#;
const CENTRE: [&str; 6] = ["0", "0", "1", "0", "0", "0"];
const TURNED: [&str; 6] = ["0.1", "-1/7", "1.05", "0.03", "1/30", "-0.1"];

fn numbers(x: &[&str]) -> Vec<Expression> {
    x.iter().map(|&x| Expression::try_from(x.to_owned()).expect("a number")).collect()
}

fn dependent(text: &str, point: &[&str], machine: &[&str]) -> Found {
    let claim = claim(text);
    let problem = Problem::new(&claim).expect("well formed");
    let (point, machine) = (numbers(point), numbers(machine));
    let witness = Witness { precision: 64, point, machine, fails: Failure::Dependent };
    check(&problem, &claim.workspace, &witness)
}

/// Six points of the base, in no particular order.
const BASE: [[&str; 2]; 6] = [
    ["0.98481", "-0.17365"],
    ["0.98481", "0.17365"],
    ["-0.34202", "0.93969"],
    ["-0.64279", "0.76604"],
    ["-0.64279", "-0.76604"],
    ["-0.34202", "-0.93969"],
];

fn hexapod(platform: impl Fn(usize, [&str; 2]) -> String) -> Vec<String> {
    let leg = |(i, [x, y]): (usize, &[&str; 2])| {
        strut(&format!(r#""{x}","{y}","0""#), &platform(i, [x, y]))
    };
    BASE.iter().enumerate().map(leg).collect()
}

fn one(_: usize, _: [&str; 2]) -> String {
    r#""0.3","0.1","-0.2""#.to_owned()
}

#[test]
fn hexapods_that_are_singular_everywhere() {
    let refuted = |legs: &[String]| {
        let text = spatial(legs, ANGLE, "");
        [&CENTRE, &TURNED].map(|pose| dependent(&text, pose, &[]))
    };
    let halves = |last: &str| {
        let more = |i: usize| if i == 5 { last } else { "" };
        hexapod(|i, [x, y]| format!(r#""{x}/2","{y}/2{}","0""#, more(i)))
    };
    assert_eq!(refuted(&halves("")), [Ok(()), Ok(())]);
    // Nearly similar, by one in 10^30: regular, if hardly, but for the pose at which five legs meet.
    assert_eq!(refuted(&halves(&format!("+1/1{}", "0".repeat(30)))), [Ok(()), NOT]);
    assert_eq!(refuted(&hexapod(one)), [Ok(()), Ok(())]);
    let other = |i: usize, x: [&str; 2]| match i {
        5 => r#""0.3","0.1","-0.2000001""#.to_owned(),
        i => one(i, x),
    };
    // Five legs in one point leave two turns about it free.
    assert_eq!(refuted(&hexapod(other)), [Ok(()), Ok(())]);
    // Legs that coincide; all but.
    let with_last = |leg: String| [&hexapod_legs()[..5], &[leg]].concat();
    let third = hexapod_legs().swap_remove(2);
    assert_eq!(refuted(&with_last(third.clone())), [Ok(()), Ok(())]);
    let beside = third.replace(r#","0"]}"#, r#","0.0000001"]}"#);
    assert_ne!(beside, third);
    assert_eq!(refuted(&with_last(beside)), [NOT, NOT]);
    assert_eq!(refuted(&hexapod_legs()), [NOT, NOT]);
    // More legs than freedoms.
    let seven = [hexapod(one), hexapod(one).split_off(5)].concat();
    assert_eq!(refuted(&seven), [Ok(()), Ok(())]);
    let regular = [hexapod(one), hexapod_legs().split_off(3)].concat();
    assert_eq!(refuted(&regular), [NOT, NOT]);
    // What is irrational is not told.
    let root = |_: usize, _: [&str; 2]| r#""sqrt(2)/4","0.1","0""#.to_owned();
    assert_eq!(refuted(&hexapod(root)), [NOT, NOT]);
}

#[test]
fn the_pose_and_the_machine_are_the_claims() {
    let text = spatial(&hexapod(one), ANGLE, "");
    let outside: Found = Err(WitnessError::Outside);
    for pose in [
        &["0", "0", "1.21", "0", "0", "0"][..],
        &["0", "0", "1", "0.14", "0", "0"],
        &CENTRE[..5],
        &["0", "0", "1", "0", "0", "0", "0"],
        &[],
    ] {
        assert_eq!(dependent(&text, pose, &[]), outside, "{pose:?}");
    }
    let beyond: Found = Err(WitnessError::OutsideTolerance);
    assert_eq!(dependent(&text, &CENTRE, &["0"]), beyond);
    // Similar for one machine of the tolerance.
    let half = |i: usize, [x, y]: [&str; 2]| match i {
        5 => format!(r#""{x}/2",{{"min":"-0.5","max":"-0.4"}},"0""#),
        _ => format!(r#""{x}/2","{y}/2","0""#),
    };
    let wide = spatial(&hexapod(half), ANGLE, "");
    assert_eq!(dependent(&wide, &TURNED, &["-0.469845"]), Ok(()));
    assert_eq!(dependent(&wide, &TURNED, &["-0.46984"]), NOT);
    for machine in [&["-0.51"][..], &["-0.3999"], &[], &["-0.469845"; 2]] {
        assert_eq!(dependent(&wide, &TURNED, machine), beyond);
    }
}

#[test]
fn other_machines() {
    // Of a plane, one platform joint; about a point, joints on a line through it.
    let anchors = [r#""1","0""#, r#""-1","0.1""#, r#""0","1""#];
    let square = [r#""-0.1","-0.1""#, r#""0.1","0.1""#];
    let legs = |platform: [&str; 3]| -> Vec<String> {
        anchors.iter().zip(platform).map(|(a, b)| strut(a, b)).collect()
    };
    let one = planar(&legs([r#""0.3","0.1""#; 3]), square, r#""-5","5""#, "");
    assert_eq!(dependent(&one, &["0.1", "0.05", "1/50"], &[]), Ok(()));
    let two = legs([r#""0.3","0.1""#, r#""0.3","0.1""#, r#""0.1","0.1""#]);
    assert_eq!(dependent(&planar(&two, square, r#""-5","5""#, ""), &["0", "0", "0"], &[]), NOT);
    let regular = spherical(r#"{"angle":"20"}"#, "");
    assert_eq!(dependent(&regular, &["0", "0", "0"], &[]), NOT);
    // Where all legs are orthogonal to one axis: at the pose alone.
    let legs: Vec<String> = [["1", "0"], ["0", "1"], ["-1", "1"]]
        .map(|[x, y]| strut(&format!(r#""{x}","{y}","1""#), r#""0","0","0""#))
        .to_vec();
    let point = |legs: &[String], z: &str| {
        format!(
            r#"{{"mechanism":{{"translational":[{}]}},"workspace":{{"box":{{"min":["-1","-1","{z}"],"max":["1","1","2"]}}}},"require":[]}}"#,
            legs.join(",")
        )
    };
    assert_eq!(dependent(&point(&legs, "0"), &["0.1", "0.2", "1"], &[]), Ok(()));
    assert_eq!(dependent(&point(&legs, "0"), &["0.1", "0.2", "1.001"], &[]), NOT);
    assert_eq!(
        dependent(&point(&legs, "1.001"), &["0.1", "0.2", "1"], &[]),
        Err(WitnessError::Outside)
    );
    // Sliders along z of the lengths 5, with legs of (3, 4) beside their guides: a root that is rational.
    let slider = |x: &str, y: &str| {
        format!(
            r#"{{"drive":"slider","direction":["0","0","2"],"anchor":["{x}","{y}","0"],"platform":["0","0","0"],"length":"5","mode":"+"}}"#
        )
    };
    let sliders = [slider("3", "0"), slider("-3", "0"), slider("0", "0")];
    assert_eq!(dependent(&point(&sliders, "0"), &["0", "0", "1"], &[]), Ok(()));
    let sliders = [slider("3", "0"), slider("-3", "0"), slider("0", "4")];
    assert_eq!(dependent(&point(&sliders, "0"), &["0", "0", "1"], &[]), NOT);
    // 25 - 2.9^2 is no square, 5 beside a guide out of reach.
    let sliders = [slider("2.9", "0"), slider("-2.9", "0"), slider("0", "0")];
    assert_eq!(dependent(&point(&sliders, "0"), &["0", "0", "1"], &[]), NOT);
}

#[test]
fn mechanisms_by_formulas() {
    let formulas = |second: &str| {
        format!(
            r#"{{"mechanism":{{"formulas":{{"coordinates":["x","y"],"parameters":[["a","0.1"]],"definitions":[["s","x^2+a*y"]],"joints":[{{"rho":"s"}},{{"rho":"{second}"}}]}}}},"workspace":{{"box":{{"min":["0","0"],"max":["1","1"]}}}},"require":[]}}"#
        )
    };
    let refuted = |second: &str| dependent(&formulas(second), &["1/3", "1/7"], &[]);
    assert_eq!(refuted("s*s+3*s"), Ok(()));
    assert_eq!(refuted("s/(s+1)"), Ok(()));
    assert_eq!(refuted("x"), NOT);
    assert_eq!(refuted("s+x/1000000000000"), NOT);
    // Defined by nothing at this point: a quotient by 0, the root of a negative number.
    assert_eq!(refuted("s/(x-1/3)"), NOT);
    assert_eq!(refuted("sqrt(s-x)"), NOT);
}
