//! Machines that turn their platforms: proved, refuted, and refused.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::motions::decimal;
use crate::prover::{certify, Prover};
use orthocert_kernel::certificate::{Certificate, Evidence, Proof, Step};
use orthocert_kernel::check::check;
use orthocert_kernel::problem::Problem;

/// A point of a circle.
pub fn on_circle(radius: f64, degrees: f64) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let of = |x: f64| decimal((x * radius * 1e6).round() / 1e6);
    format!(r#""{}","{}""#, of(cos), of(sin))
}

pub fn strut(anchor: &str, platform: &str) -> String {
    format!(r#"{{"drive":"strut","anchor":[{anchor}],"platform":[{platform}]}}"#)
}

/// Base radius 1, platform radius 1/2, pairs of joints 20 degrees apart.
pub fn hexapod_legs() -> Vec<String> {
    let leg = |i: usize| {
        let (pair, side) = ((i / 2) as f64 * 120.0, if i.is_multiple_of(2) { -1.0 } else { 1.0 });
        let base = on_circle(1.0, pair + side * 10.0);
        // The near one of the platform's pairs, at 60 degrees on either side.
        let platform = on_circle(0.5, pair + side * 50.0);
        strut(&format!(r#"{base},"0""#), &format!(r#"{platform},"0""#))
    };
    (0..6).map(leg).collect()
}

pub fn spatial(legs: &[String], orientation: &str, require: &str) -> String {
    format!(
        r#"{{"mechanism":{{"spatial":{{"legs":[{}],"characteristic_length":"1"}}}},"workspace":{{"box":{{"min":["-0.2","-0.2","0.8"],"max":["0.2","0.2","1.2"]}}}},"orientation":{orientation},"require":[{require}]}}"#,
        legs.join(",")
    )
}

/// `psi <= 1/sigma` for the least, or `psi >= 1/sigma` for the greatest singular value.
pub fn psi(end: &str, sigma: f64) -> String {
    let bound = decimal((1e6 / sigma).round() / 1e6);
    format!(r#"{{"quantity":"transmission","end":"{end}","bound":"{bound}"}}"#)
}

/// Proves and checks; the leaves, and those outside.
fn leaves(text: &str, most: usize) -> (usize, usize, Certificate) {
    let certificate = certify(&claim(text), 2 * most).unwrap_or_else(|| panic!("no proof: {text}"));
    check(&certificate).unwrap_or_else(|e| panic!("{e}: {text}"));
    let written = certificate.to_text().expect("a text");
    assert_eq!(Certificate::read(&written).expect("canonical"), certificate);
    let Proof::Tree(tree) = &certificate.proof else { panic!("a tree") };
    let all = tree.nodes.iter().filter(|node| node.split.is_none());
    let outside = all.clone().filter(|node| node.by == [Step(0, Evidence::Outside)]).count();
    (all.count() - outside, outside, certificate)
}

/// The least singular value of `M` over poses of the box and orientations of a claim.
fn least(text: &str) -> f64 {
    let claim = claim(text);
    let problem = Problem::new(&claim).expect("a claim");
    let [least, greatest] = crate::sampled::extremes(&Prover::new(&problem));
    assert!(least < greatest);
    least
}

pub const FIFTEEN: &str =
    r#"{"roll_pitch_yaw":{"roll":["-15","15"],"pitch":["-15","15"],"yaw":["-15","15"]}}"#;

#[test]
fn hexapods() {
    // Leaves for freedom from singularities, and for parts of the least singular value, as sampled.
    for (orientation, sigma, parts, most) in [
        (r#"{"angle":"15"}"#, 0.375093, [0.5, 0.9], [1, 1, 8]),
        (FIFTEEN, 0.275990, [0.9, 0.95], [1, 3, 8]),
        (r#"{"tilt":{"tilt":"20","torsion":"20"}}"#, 0.280030, [0.5, 0.7], [1, 1, 8]),
        (r#"{"angle":"0"}"#, 0.528875, [0.9, 0.99], [1, 1, 5]),
    ] {
        let text = |require: &str| spatial(&hexapod_legs(), orientation, require);
        let [some, more] = parts.map(|part| psi("max", part * sigma));
        let found = [String::new(), some, more].map(|require| leaves(&text(&require), 40).0);
        assert!(found.iter().zip(most).all(|(&found, most)| found <= most), "{found:?}");
        // What is false is not proved.
        assert!(certify(&claim(&text(&psi("max", 1.001 * sigma))), 8).is_none());
    }
}

#[test]
fn the_sampled_values_are_found() {
    let sigma = least(&spatial(&hexapod_legs(), r#"{"angle":"15"}"#, ""));
    assert!((sigma - 0.375094).abs() < 1e-5, "{sigma}");
}

#[test]
fn workspaces_with_singularities_are_not_proved() {
    // Similar hexagons, alike: singular wherever the platform is not turned.
    let similar = |i: usize| {
        let at = i as f64 * 60.0 + if i.is_multiple_of(2) { 0.0 } else { 20.0 };
        let (base, platform) = (on_circle(1.0, at), on_circle(0.5, at));
        strut(&format!(r#"{base},"0""#), &format!(r#"{platform},"0""#))
    };
    let similar: Vec<String> = (0..6).map(similar).collect();
    let yaw = r#"{"roll_pitch_yaw":{"roll":["0","0"],"pitch":["0","0"],"yaw":["60","110"]}}"#;
    for (legs, orientation) in [
        (&similar, r#"{"angle":"5"}"#),
        (&similar, r#"{"angle":"0"}"#),
        (&hexapod_legs(), yaw),
        (&hexapod_legs(), r#"{"tilt":{"tilt":"5","torsion":"95"}}"#),
    ] {
        assert!(certify(&claim(&spatial(legs, orientation, "")), 9).is_none(), "{orientation}");
    }
}

/// A number of so many thousandths.
fn thousandths(random: &mut Random, from: i64, to: i64) -> f64 {
    (from + random.below((to - from + 1) as u64) as i64) as f64 / 1000.0
}

#[test]
fn what_control_points_show_holds_at_sampled_poses() {
    let mut random = Random(31);
    let mut passed = [0; 2];
    for round in 0..36 {
        let mut point = |radius: i64, height: i64| {
            let at = thousandths(&mut random, 0, 360_000);
            let height = thousandths(&mut random, -height, height);
            format!(r#"{},"{}""#, on_circle(radius as f64 / 1000.0, at), decimal(height))
        };
        let legs: Vec<String> =
            (0..6 + round % 2).map(|_| strut(&point(1000, 200), &point(500, 200))).collect();
        let size = thousandths(&mut random, 3, 15);
        let ends = |x: f64| format!(r#"["{}","{}"]"#, decimal(x - size), decimal(x + size));
        let angle = thousandths(&mut random, 300, 3000);
        let orientation = match round % 3 {
            0 => format!(r#"{{"angle":"{angle}"}}"#),
            1 => format!(r#"{{"tilt":{{"tilt":"{angle}","torsion":"2"}}}}"#),
            _ => {
                let [roll, pitch, yaw] = [20.0, -10.0, 40.0]
                    .map(|x| format!(r#"["{}","{}"]"#, decimal(x - angle), decimal(x + angle)));
                format!(r#"{{"roll_pitch_yaw":{{"roll":{roll},"pitch":{pitch},"yaw":{yaw}}}}}"#)
            }
        };
        let text = |require: &str| {
            let corners = [ends(0.1), ends(-0.1), ends(0.9)];
            let corner = |k: usize| {
                corners
                    .each_ref()
                    .map(|x| x.split(',').nth(k).unwrap_or("").trim_matches(['[', ']']).to_owned())
                    .join(",")
            };
            format!(
                r#"{{"mechanism":{{"spatial":{{"legs":[{}],"characteristic_length":"0.7"}}}},"workspace":{{"box":{{"min":[{}],"max":[{}]}}}},"orientation":{orientation},"require":[{require}]}}"#,
                legs.join(","),
                corner(0),
                corner(1)
            )
        };
        let open = claim(&text(""));
        let problem = Problem::new(&open).expect("a claim");
        let prover = Prover::new(&problem);
        let ranges = prover.ranges();
        let centre: Vec<f64> = ranges.iter().map(|(low, high)| (low + high) / 2.0).collect();
        let s = prover.matrix(&centre).expect("a pose").singular_values();
        if s.min() < 0.02 {
            continue;
        }
        for (which, (end, bound)) in [
            ("max", s.min() * thousandths(&mut random, 500, 990)),
            ("min", s.max() * thousandths(&mut random, 1010, 1200)),
        ]
        .into_iter()
        .enumerate()
        {
            let Some(certificate) = certify(&claim(&text(&psi(end, bound))), 1) else { continue };
            check(&certificate).expect("accepted");
            passed[which] += 1;
            for sample in 0..300 {
                let x: Vec<f64> = ranges
                    .iter()
                    .map(|(low, high)| {
                        let steps = if sample % 3 == 0 { 1 } else { 16 };
                        low + (high - low) * random.below(steps + 1) as f64 / steps as f64
                    })
                    .collect();
                if !prover.is_inside(&x) {
                    continue;
                }
                let s = prover.matrix(&x).expect("a pose").singular_values();
                let holds =
                    if which == 0 { s.min() >= bound - 1e-5 } else { s.max() <= bound + 1e-5 };
                assert!(holds, "{end} {bound}: {} {}", s.min(), s.max());
            }
        }
    }
    assert!(passed[0] > 12 && passed[1] > 12, "{passed:?}");
}

#[test]
fn quantities_of_a_hexapod() {
    let require = r#"{"quantity":"transmission","end":"max","bound":"4"},
        {"quantity":"transmission","end":"min","bound":"0.4"},
        {"quantity":"joint_range","end":"min","bound":"0.7"},
        {"quantity":"joint_range","leg":2,"end":"max","bound":"1.7"},
        {"quantity":"conditioning","end":"max","bound":"12"},
        {"quantity":"joint_speed","given":{"tool":["1"]},"end":"max","bound":"2"}"#;
    let (found, _, certificate) =
        leaves(&spatial(&hexapod_legs(), r#"{"angle":"10"}"#, require), 200);
    let Proof::Tree(tree) = &certificate.proof else { panic!("a tree") };
    let mut steps = tree.nodes.iter().flat_map(|node| &node.by);
    assert!(steps.any(|Step(_, evidence)| matches!(evidence, Evidence::Control(_))));
    assert!(found <= 30, "{found}");
}

#[test]
fn tolerances_and_a_seventh_strut() {
    let mut legs = hexapod_legs();
    let toleranced = |leg: &String| {
        let (start, platform) = leg.split_once(r#""platform""#).expect("a platform");
        let (drive, anchor) = start.split_once('[').expect("an anchor");
        let anchor: Vec<String> = anchor
            .trim_end_matches("],")
            .split(',')
            .map(|x| {
                let x: f64 = x.trim_matches('"').parse().expect("a number");
                let (min, max) = (decimal(x - 0.001), decimal(x + 0.001));
                format!(r#"{{"min":"{min}","max":"{max}"}}"#)
            })
            .collect();
        format!(r#"{drive}[{}],"platform"{platform}"#, anchor.join(","))
    };
    let text = |legs: &[String]| spatial(legs, FIFTEEN, &psi("max", 0.2));
    assert!(leaves(&text(&legs.iter().map(toleranced).collect::<Vec<_>>()), 20).0 <= 3);
    legs.push(strut(r#""0.3","0","0""#, r#""0","0.1","0""#));
    assert!(leaves(&text(&legs), 20).0 <= 3);
}

pub fn planar(legs: &[String], workspace: [&str; 2], turned: &str, require: &str) -> String {
    let (ell, orientation) = match turned {
        "" => ("", String::new()),
        range => (
            r#","characteristic_length":"1/2""#,
            format!(r#""orientation":{{"range":[{range}]}},"#),
        ),
    };
    format!(
        r#"{{"mechanism":{{"planar":{{"legs":[{}]{ell}}}}},"workspace":{{"box":{{"min":[{}],"max":[{}]}}}},{orientation}"require":[{require}]}}"#,
        legs.join(","),
        workspace[0],
        workspace[1]
    )
}

pub fn arm(anchor: &str, platform: &str, mode: &str) -> String {
    format!(
        r#"{{"drive":"arm","axis":[],"reference":["1","0"],"anchor":[{anchor}],"platform":[{platform}],"arm":"0.8","length":"0.9","mode":"{mode}"}}"#
    )
}

#[test]
fn machines_in_the_plane() {
    let struts: Vec<String> = [90.0, 210.0, 330.0]
        .map(|at| strut(&on_circle(1.0, at), &on_circle(0.5, at + 80.0)))
        .to_vec();
    let square = [r#""-0.2","-0.2""#, r#""0.2","0.2""#];
    let text = |require: &str| planar(&struts, square, r#""-20","20""#, require);
    let sigma = least(&text(""));
    assert_eq!(leaves(&text(""), 10).0, 1);
    let near = leaves(&text(&psi("max", 0.99 * sigma)), 100).0;
    assert!(near <= 20, "{near}");
    // One orientation, and not that of the coordinates' origin.
    assert!(leaves(&planar(&struts, square, r#""10","10""#, &psi("max", sigma)), 100).0 <= 20);
    let arms: Vec<String> = [90.0, 210.0, 330.0]
        .map(|at| arm(&on_circle(1.2, at), &on_circle(0.3, at + 60.0), "+"))
        .to_vec();
    let small = [r#""-0.1","-0.1""#, r#""0.1","0.1""#];
    let found = leaves(&planar(&arms, small, r#""-10","10""#, ""), 400).0;
    assert!(found <= 8, "{found}");
    let five_bar =
        [arm(r#""-0.4","0""#, r#""0","0""#, "+"), arm(r#""0.4","0""#, r#""0","0""#, "-")];
    let require = r#"{"quantity":"transmission","end":"max","bound":"2"},
        {"quantity":"parallel_margin","end":"min","bound":"0.2"}"#;
    let high = [r#""-0.2","1""#, r#""0.2","1.2""#];
    let found = leaves(&planar(&five_bar, high, "", require), 400).0;
    assert!(found <= 4, "{found}");
}

pub fn spherical(orientation: &str, require: &str) -> String {
    let leg = |at: f64| {
        let (base, platform) = (on_circle(1.0, at), on_circle(0.8, at + 100.0));
        strut(&format!(r#"{base},"-0.5""#), &format!(r#"{platform},"0.4""#))
    };
    let legs = [0.0, 120.0, 240.0].map(leg).join(",");
    format!(
        r#"{{"mechanism":{{"spherical":{{"legs":[{legs}],"characteristic_length":"1"}}}},"workspace":{{"box":{{"min":[],"max":[]}}}},"orientation":{orientation},"require":[{require}]}}"#
    )
}

#[test]
fn machines_about_a_point() {
    for (orientation, most) in [(r#"{"angle":"20"}"#, 23), (FIFTEEN, 40)] {
        let sigma = least(&spherical(orientation, ""));
        assert_eq!(leaves(&spherical(orientation, ""), 10).0, 1);
        let found = leaves(&spherical(orientation, &psi("max", 0.95 * sigma)), 60).0;
        assert!(found <= most, "{found}");
    }
}

/// Vertical guides.
pub fn slider_legs() -> Vec<String> {
    let leg = |i: usize| {
        let (pair, side) = ((i / 2) as f64 * 120.0, if i.is_multiple_of(2) { -1.0 } else { 1.0 });
        let base = on_circle(1.0, pair + side * 12.0);
        let platform = on_circle(0.4, pair + side * 50.0);
        format!(
            r#"{{"drive":"slider","direction":["0","0","1"],"anchor":[{base},"0"],"platform":[{platform},"0"],"length":"1.2","mode":"-"}}"#
        )
    };
    (0..6).map(leg).collect()
}

#[test]
fn sliders_that_turn_a_platform() {
    // Slopes in six coordinates.
    let text = spatial(&slider_legs(), r#"{"angle":"3"}"#, "").replace("0.2\"", "0.05\"");
    let text = text.replace("\"0.8\"", "\"0.95\"").replace("\"1.2\"]", "\"1.05\"]");
    assert_eq!(leaves(&text, 400).0, 1);
}

#[test]
fn a_hexapod_over_a_cylinder() {
    let round = r#"{"cylinder":{"center":["0.01","-0.02"],"radius":"0.25","z":["0.8","1.2"]}}"#;
    let text = spatial(&hexapod_legs(), FIFTEEN, &psi("max", 0.25));
    let square = r#"{"box":{"min":["-0.2","-0.2","0.8"],"max":["0.2","0.2","1.2"]}}"#;
    let (found, _, certificate) = leaves(&text.replace(square, round), 40);
    let Proof::Tree(tree) = &certificate.proof else { panic!("a tree") };
    let mut steps = tree.nodes.iter().flat_map(|node| &node.by);
    let inside = |evidence: &Evidence| match evidence {
        Evidence::Control(evidence) => matches!(**evidence, Evidence::Inside(..)),
        _ => false,
    };
    assert!(steps.any(|Step(_, evidence)| inside(evidence)));
    assert!(found <= 20, "{found}");
}
