//! Of machines that turn their platforms: refutations, what is refused, and what is said of them.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::prover::{certify, Prover};
use crate::turning::{hexapod_legs, planar, psi, spatial, spherical, strut, FIFTEEN};
use orthocert_kernel::certificate::{Certificate, Claim, Evidence, Failure, Proof, Step, Witness};
use orthocert_kernel::check::check;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::test::Multiplier;
use orthocert_kernel::witness::{self, WitnessError};

fn numbers(x: &[&str]) -> Vec<Expression> {
    x.iter().map(|&x| Expression::try_from(x.to_owned()).expect("a number")).collect()
}

fn try_witness(text: &str, pose: &[&str], fails: Failure) -> Result<(), WitnessError> {
    let claim = claim(text);
    let problem = Problem::new(&claim).expect("well formed");
    let witness = Witness { precision: 128, point: numbers(pose), machine: vec![], fails };
    witness::check(&problem, &claim.workspace, &witness)
}

const CENTRE: [&str; 6] = ["0", "0", "1", "0", "0", "0"];

#[test]
fn poses_at_which_a_claim_fails() {
    let angle = r#"{"angle":"15"}"#;
    let least = |bound: &str, orientation: &str| {
        let require = format!(r#"{{"quantity":"joint_range","end":"min","bound":"{bound}"}}"#);
        spatial(&hexapod_legs(), orientation, &require)
    };
    // A strut of the centre: |(1, 10 degrees) - (1/2, 50 degrees)|^2 + 1 is 1.484, of the length 1.218.
    let shorter = || Failure::Obligation(1, vec![]);
    assert_eq!(try_witness(&least("1.22", angle), &CENTRE, shorter()), Ok(()));
    let not = Err(WitnessError::NotViolated);
    assert_eq!(try_witness(&least("1.21", angle), &CENTRE, shorter()), not);
    // A direction that M stretches by less than sqrt(6): twists (v, ell omega).
    let false_psi = spatial(&hexapod_legs(), angle, &psi("max", 2.0));
    let along = |v: [i64; 6]| Failure::Obligation(0, vec![v.to_vec()]);
    assert_eq!(try_witness(&false_psi, &CENTRE, along([0, 0, 0, 0, 0, 1])), Ok(()));
    assert_eq!(try_witness(&false_psi, &CENTRE, along([0, 0, 1, 0, 0, 0])), not);
    // Of a set of orientations the pose has to be certainly one: |c| <= tan(7.5 degrees) = 0.13165.
    let outside = Err(WitnessError::Outside);
    for (orientation, pose, inside) in [
        (angle, ["0.1316", "0", "0"], true),
        (angle, ["0.1317", "0", "0"], false),
        (angle, ["0.1", "0.1", "0"], false),
        (FIFTEEN, ["0.1316", "0.1316", "-0.1316"], true),
        (FIFTEEN, ["0", "0", "0.1317"], false),
        (r#"{"angle":"0"}"#, ["0", "0", "0"], true),
        (r#"{"angle":"0"}"#, ["0", "0.000000001", "0"], false),
        // tan(10 degrees) = 0.17633, tan(40 degrees) = 0.8391: 0.17633 sqrt(1 + 0.8391^2) = 0.23018.
        (r#"{"tilt":{"tilt":"20","torsion":"80"}}"#, ["0", "0.1763", "0"], true),
        (r#"{"tilt":{"tilt":"20","torsion":"80"}}"#, ["0", "0.1764", "0"], false),
        (r#"{"tilt":{"tilt":"20","torsion":"80"}}"#, ["0", "0.2301", "0.839"], true),
        (r#"{"tilt":{"tilt":"20","torsion":"80"}}"#, ["0", "0.2303", "0.839"], false),
        (r#"{"tilt":{"tilt":"20","torsion":"80"}}"#, ["0", "0", "0.8392"], false),
    ] {
        let pose = [["0", "0", "1"], pose].concat();
        let found = try_witness(&least("3", orientation), &pose, shorter());
        assert_eq!(found, if inside { Ok(()) } else { outside.clone() }, "{orientation} {pose:?}");
    }
    assert_eq!(try_witness(&least("3", angle), &CENTRE[..3], shorter()), outside);
    let beyond = ["0", "0", "1.3", "0", "0", "0"];
    assert_eq!(try_witness(&least("3", angle), &beyond, shorter()), outside);
}

#[test]
fn singularities_between_two_poses() {
    // Singular where the platform is turned by about 90 degrees: tan(45 degrees) is 1.
    let other = |c: &str| Failure::Singular(numbers(&["0", "0", "1", "0", "0", c]));
    let not = Err(WitnessError::NotViolated);
    for orientation in [
        r#"{"tilt":{"tilt":"5","torsion":"120"}}"#,
        r#"{"roll_pitch_yaw":{"roll":["0","0"],"pitch":["0","0"],"yaw":["0","120"]}}"#,
    ] {
        let text = spatial(&hexapod_legs(), orientation, "");
        assert_eq!(try_witness(&text, &CENTRE, other("1.2")), Ok(()));
        assert_eq!(try_witness(&text, &CENTRE, other("0.8")), not);
    }
    // Seven struts have no determinant.
    let mut legs = hexapod_legs();
    legs.push(strut(r#""0.3","0","0""#, r#""0","0.1","0""#));
    let text = spatial(&legs, r#"{"tilt":{"tilt":"5","torsion":"120"}}"#, "");
    assert_eq!(try_witness(&text, &CENTRE, other("1.2")), not);
}

#[test]
fn claims_of_turning_machines_that_are_not_well_formed() {
    let spatial = spatial(&hexapod_legs(), r#"{"angle":"15"}"#, &psi("max", 0.2));
    let struts = [r#""1","0""#, r#""-1","0""#, r#""0","1""#].map(|a| strut(a, r#""0.3","0.1""#));
    let square = [r#""-0.1","-0.1""#, r#""0.1","0.1""#];
    let planar_claim = planar(&struts, square, r#""-5","5""#, "");
    let point = planar(&struts[..2], square, "", "");
    let spherical = spherical(r#"{"angle":"20"}"#, "");
    for good in [&spatial, &planar_claim, &point, &spherical] {
        Problem::new(&claim(good)).expect("well formed");
    }
    let ell = r#","characteristic_length":"1""#;
    let angle = |orientation: &'static str| (r#"{"angle":"15"}"#, orientation);
    let (range, box_of_three) = (r#"{"range":["-5","5"]}"#, r#""min":["-0.1","-0.1"]"#);
    for (defect, good, (from, to)) in [
        ("no characteristic length", &spatial, (ell, "")),
        ("length of zero", &spatial, (ell, r#","characteristic_length":"0""#)),
        ("no orientation", &spatial, (r#""orientation":{"angle":"15"},"#, "")),
        ("angle of 180", &spatial, angle(r#"{"angle":"180"}"#)),
        ("negative angle", &spatial, angle(r#"{"angle":"-1"}"#)),
        ("tilt of 180", &spatial, angle(r#"{"tilt":{"tilt":"180","torsion":"1"}}"#)),
        ("torsion of 180", &spatial, angle(r#"{"tilt":{"tilt":"1","torsion":"180"}}"#)),
        (
            "yaw to 180",
            &spatial,
            angle(r#"{"roll_pitch_yaw":{"roll":["0","0"],"pitch":["0","0"],"yaw":["0","180"]}}"#),
        ),
        (
            "roll the wrong way round",
            &spatial,
            angle(r#"{"roll_pitch_yaw":{"roll":["1","0"],"pitch":["0","0"],"yaw":["0","1"]}}"#),
        ),
        ("a range in space", &spatial, angle(r#"{"range":["-5","5"]}"#)),
        ("an angle in the plane", &planar_claim, (range, r#"{"angle":"5"}"#)),
        ("range from -180", &planar_claim, (range, r#"{"range":["-180","5"]}"#)),
        ("a workspace in space", &planar_claim, (box_of_three, r#""min":["0","0","0"]"#)),
        ("a joint in space", &planar_claim, (r#""anchor":["1","0"]"#, r#""anchor":["1","0","0"]"#)),
        ("a joint in the plane", &spatial, (r#","0"],"platform""#, r#"],"platform""#)),
        (
            "length without orientation",
            &point,
            (r#"]}},"workspace""#, r#"],"characteristic_length":"1"}},"workspace""#),
        ),
        (
            "orientation without length",
            &point,
            (r#","require""#, r#","orientation":{"range":["-5","5"]},"require""#),
        ),
        ("a point's workspace about a point", &spherical, (r#""min":[]"#, r#""min":["0"]"#)),
        ("a plane that moves", &spatial, (r#""drive":"strut""#, r#""drive":"planar""#)),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(&text, good, "{defect}");
        let refused =
            serde_json::from_str(&text).map_or(true, |claim| Problem::new(&claim).is_err());
        assert!(refused, "{defect}");
    }
    let five = spatial.replacen(&format!("{},", hexapod_legs()[0]), "", 1);
    assert_ne!(five, spatial);
    assert!(Problem::new(&claim(&five)).is_err(), "five legs");
    let margin = r#"{"quantity":"parallel_margin","end":"min","bound":"0.1"}"#;
    let text = crate::turning::spatial(&hexapod_legs(), FIFTEEN, margin);
    assert!(Problem::new(&claim(&text)).is_err(), "a margin that makes no sense");
    let slider = r#"{"drive":"slider","direction":["0","0","1"],"anchor":["1","0","0"],"platform":["0","1","0"],"length":"2","mode":"-"}"#;
    let start = spherical.find(r#"{"drive""#).expect("a leg");
    let text = format!("{}{slider},{}", &spherical[..start], &spherical[start..]);
    assert!(Problem::new(&claim(&text)).is_err(), "a slider about a point");
    let translational = spatial.replace("spatial", "translational");
    assert!(serde_json::from_str::<orthocert_kernel::claim::MachineClaim>(&translational).is_err());
}

/// Whether the certificate is accepted with this evidence for its last step.
fn with(certificate: &Certificate, change: impl Fn(Evidence) -> Evidence) -> bool {
    let mut certificate = certificate.clone();
    let Proof::Tree(tree) = &mut certificate.proof else { panic!("a tree") };
    for node in &mut tree.nodes {
        for Step(_, evidence) in &mut node.by {
            *evidence = change(evidence.clone());
        }
    }
    check(&certificate).is_ok()
}

/// The evidence inside [`Evidence::Control`].
fn inner(evidence: Evidence) -> Box<Evidence> {
    match evidence {
        Evidence::Control(inner) => inner,
        other => panic!("{other:?}"),
    }
}

#[test]
fn evidence_that_shows_less_than_it_says() {
    let text = |orientation: &str, require: &str| spatial(&hexapod_legs(), orientation, require);
    let proved = |text: &str| certify(&claim(text), 8).expect("a proof");
    let control = |evidence: Evidence| Evidence::Control(Box::new(evidence));
    let regular = proved(&text(r#"{"angle":"15"}"#, ""));
    let bounded = proved(&text(FIFTEEN, &psi("max", 0.2)));
    for certificate in [&regular, &bounded] {
        assert!(with(certificate, |evidence| evidence));
        assert!(!with(certificate, |evidence| *inner(evidence)), "at the vertices");
        assert!(!with(certificate, control), "twice");
        assert!(!with(certificate, |_| control(Evidence::Test)));
        let changed = |change: fn(&mut Multiplier)| {
            with(certificate, |evidence| {
                let mut own = inner(evidence);
                if let Evidence::Rank(y) | Evidence::Lower(y) = &mut *own {
                    change(y);
                }
                Evidence::Control(own)
            })
        };
        assert!(changed(|_| ()));
        assert!(!changed(|y| y.y.iter_mut().flatten().for_each(|y| *y = 0)), "Y of zero");
        assert!(!changed(|y| y.y.iter_mut().flatten().for_each(|y| *y = -*y)), "Y negated");
        assert!(!changed(|y| drop(y.y.pop())), "Y with a row too few");
        assert!(!changed(|y| y.y[0].truncate(5)), "Y with an entry too few");
        assert!(!changed(|y| y.places = 64), "Y over too many places");
    }
    // Full rank alone is no bound.
    let rank = |evidence: Evidence| match *inner(evidence) {
        Evidence::Lower(y) => Evidence::Rank(y),
        other => other,
    };
    assert!(!with(&bounded, |evidence| control(rank(evidence))));
    assert!(!with(&bounded, rank));
    // The orientations' own inequality: none of a box, and no negative multiple.
    let less = |multiple: i64| {
        move |evidence: Evidence| control(Evidence::Turned(inner(evidence), multiple, 10))
    };
    assert!(with(&regular, less(0)) && with(&regular, less(1)));
    assert!(!with(&regular, less(-1)) && !with(&regular, less(i64::MAX)));
    assert!(!with(&bounded, less(0)));
    let outside = |_| Evidence::Outside;
    assert!(!with(&regular, outside) && !with(&bounded, outside));
    // A larger set, and a greater bound.
    for (from, to) in [("15", "100"), ("\"0.8\"", "\"0\"")] {
        let mut certificate = regular.clone();
        let larger = text(r#"{"angle":"15"}"#, "").replace(from, to);
        certificate.claim = Claim::Machine(claim(&larger));
        assert!(check(&certificate).is_err(), "{from}");
    }
    let mut certificate = bounded.clone();
    certificate.claim = Claim::Machine(claim(&text(FIFTEEN, &psi("max", 0.29))));
    assert!(check(&certificate).is_err());
    // Sliders have no rows at control points: no bound holds of none.
    let sliders: Vec<String> = crate::turning::slider_legs();
    let near = |x: &str| x.replace("0.2\"", "0.05\"").replace("\"0.8\"", "\"0.95\"");
    let require = [psi("min", 9.0), psi("max", 0.01)].join(",");
    let slopes = proved(
        &near(&text(r#"{"angle":"1"}"#, &require))
            .replace(&hexapod_legs().join(","), &sliders.join(",")),
    );
    assert!(with(&slopes, |evidence| evidence));
    let to_control = |which: fn(&Evidence) -> bool| {
        with(&slopes, |evidence| if which(&evidence) { control(evidence) } else { evidence })
    };
    assert!(to_control(|_| false));
    assert!(!to_control(|evidence| matches!(evidence, Evidence::Test)));
    assert!(!to_control(|evidence| matches!(evidence, Evidence::Lower(_))));
    let none = |evidence: Evidence| match evidence {
        Evidence::Lower(y) => control(Evidence::Lower(Multiplier { y: vec![], ..y })),
        other => other,
    };
    assert!(!with(&slopes, none));
    // Control points are of platforms that turn.
    let square = [r#""-0.1","-0.1""#, r#""0.1","0.1""#];
    let struts = [strut(r#""1","0""#, r#""0","0""#), strut(r#""0","1""#, r#""0","0""#)];
    let point = proved(&planar(&struts, square, "", ""));
    assert!(with(&point, |evidence| evidence));
    assert!(!with(&point, control));
}

#[test]
fn cells_outside_a_set_of_orientations() {
    let mut random = Random(41);
    let mut outside = 0;
    for set in [r#"{"angle":"60"}"#, r#"{"tilt":{"tilt":"40","torsion":"90"}}"#, FIFTEEN] {
        let problem = Problem::new(&claim(&spherical(set, ""))).expect("a claim");
        let prover = Prover::new(&problem);
        let ranges = prover.ranges();
        for _ in 0..400 {
            let cell: Vec<[f64; 2]> = ranges
                .iter()
                .map(|(low, high)| {
                    let width = (high - low) / (1 << random.below(5)) as f64;
                    // Two times of three at an end of the box.
                    let at = [0, 32, random.below(33)][random.below(3) as usize];
                    let start = low + (high - low - width) * at as f64 / 32.0;
                    [start, start + width]
                })
                .collect();
            if !prover.drops(&cell) {
                continue;
            }
            outside += 1;
            for _ in 0..40 {
                let at = |[low, high]: &[f64; 2]| low + (high - low) * random.below(9) as f64 / 8.0;
                let c: Vec<f64> = cell.iter().map(at).collect();
                assert!(!prover.is_inside(&c), "{set} {c:?}");
            }
        }
    }
    assert!(outside > 60, "{outside}");
}

#[test]
fn what_is_said_of_machines_that_turn() {
    let says = |text: &str, words: &[&str]| {
        for words in words {
            assert!(text.contains(words), "{words}\n{text}");
        }
    };
    let said = |text: &str| {
        let certificate = certify(&claim(text), 30).expect("a proof");
        crate::statements::words(&certificate)
    };
    let angle = spatial(&hexapod_legs(), r#"{"angle":"15"}"#, "");
    says(
        &said(&angle),
        &[
            "In space, P = (x, y, z), R the rotation of the platform:",
            "6 legs, w_i = P + R platform - anchor:",
            "rho' = M (P', ell omega)",
            "ell = 1,",
            "at every point of the box from (-0.2, -0.2, 0.8) to (0.2, 0.2, 1.2),",
            "for every rotation R by at most 15 degrees about any axis",
        ],
    );
    let tilt = spatial(&hexapod_legs(), r#"{"tilt":{"tilt":"5","torsion":"9"}}"#, "");
    says(
        &said(&tilt),
        &["a tilt b up to 5", "a torsion s\nfrom -(9) to 9 degrees", "tan(5/2)^2 (1 + c_3^2)"],
    );
    says(
        &said(&spatial(&hexapod_legs(), FIFTEEN, "")),
        &["R = R_z(yaw) R_y(pitch) R_x(roll)", "yaw from -15 to 15 degrees"],
    );
    says(
        &said(&spherical(r#"{"angle":"20"}"#, "")),
        &["about the fixed point P = 0", "rho' = M ell omega"],
    );
    let square = [r#""-0.1","-0.1""#, r#""0.1","0.1""#];
    let struts = [strut(r#""1","0""#, r#""0","0""#), strut(r#""0","1""#, r#""0","0""#)];
    says(
        &said(&planar(&struts, square, "", "")),
        &["In the plane, P = (x, y):", "w_i = P + platform - anchor", "rho' = M P'"],
    );
}
