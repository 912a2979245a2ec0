//! Claims, proved, printed, read and checked.

use crate::prover::{certificate, certify};
use orthocert_kernel::certificate::{
    Certificate, Evidence, Node, Part, Proof, Step, Tree, Verdict,
};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::rejected::Rejected;
use orthocert_kernel::test::Multiplier;

pub fn claim(text: &str) -> MachineClaim {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Proves, prints, reads back and checks.
fn accepted(text: &str) -> Certificate {
    let certificate = certify(&claim(text), 20_000).expect("a proof");
    let text = certificate.to_text().expect("a text");
    let read = Certificate::read(&text).expect("canonical");
    assert_eq!(read, certificate);
    check(&read).unwrap_or_else(|e| panic!("{e}: {text}"));
    read
}

#[test]
fn the_prototype() {
    accepted(
        r#"{"mechanism":{"orthoglide":{"offset":"0"}},"workspace":{"cube":{"side":"200"}},
        "require":[{"quantity":"transmission","end":"min","bound":"1/2"},
        {"quantity":"transmission","end":"max","bound":"2"}]}"#,
    );
}

#[test]
fn an_orthoglide_by_its_inverse_kinematics() {
    accepted(
        r#"{"mechanism":{"formulas":{"coordinates":["x","y","z"],
        "parameters":[["l","310.7"]],"definitions":[],
        "joints":[{"rho":"x-sqrt(l^2-y^2-z^2)"},{"rho":"y-sqrt(l^2-x^2-z^2)"},{"rho":"z-sqrt(l^2-x^2-y^2)"}]}},
        "workspace":{"box":{"min":["-72","-72","-72"],"max":["125","125","125"]}},
        "require":[{"quantity":"transmission","end":"min","bound":"0.5"},
        {"quantity":"transmission","end":"max","bound":"2"}]}"#,
    );
}

/// A claim over a linear Delta with these requirements.
fn delta(require: &str) -> String {
    let leg = |anchor: &str| {
        format!(
            r#"{{"drive":"slider","direction":["0","0","1"],"anchor":[{anchor}],"platform":["0","0","0"],"length":{{"min":"332.95","max":"333.05"}},"mode":"-"}}"#
        )
    };
    let legs = [
        leg(r#""-174.75*sqrt(3)/2","-174.75/2","0""#),
        leg(r#""174.75*sqrt(3)/2","-174.75/2","0""#),
        leg(r#""0","174.75","0""#),
    ];
    format!(
        r#"{{"mechanism":{{"translational":[{}]}},"workspace":{{"cylinder":{{"center":["0","0"],"radius":"60","z":["0","1"]}}}},"require":[{require}]}}"#,
        legs.join(",")
    )
}

#[test]
fn every_quantity_of_a_toleranced_linear_delta() {
    accepted(&delta(
        r#"{"quantity":"transmission","end":"max","bound":"1.45"},
        {"quantity":"joint_range","end":"min","bound":"200"},
        {"quantity":"joint_range","leg":2,"end":"max","bound":"330"},
        {"quantity":"conditioning","end":"max","bound":"2.8"},
        {"quantity":"serial_margin","end":"min","bound":"0.6"},
        {"quantity":"parallel_margin","end":"min","bound":"0.2"},
        {"quantity":"leg_angle","end":"max","bound":"50"},
        {"quantity":"joint_speed","given":{"tool":["100"]},"end":"max","bound":"160"}"#,
    ));
}

#[test]
fn a_rotary_delta_with_the_range_of_its_arms() {
    let leg = |axis: &str, e: &str, a: &str| {
        format!(
            r#"{{"drive":"arm","axis":[{axis}],"reference":[{e}],"anchor":[{a}],"platform":["0","0","0"],"arm":"10","length":"14","mode":"+"}}"#
        )
    };
    let legs = [
        leg(r#""1","0","0""#, r#""0","1","0""#, r#""0","4","0""#),
        leg(r#""-1/2","sqrt(3)/2","0""#, r#""-sqrt(3)/2","-1/2","0""#, r#""-2*sqrt(3)","-2","0""#),
        leg(r#""-1/2","-sqrt(3)/2","0""#, r#""sqrt(3)/2","-1/2","0""#, r#""2*sqrt(3)","-2","0""#),
    ];
    let text = |range: &str| {
        format!(
            r#"{{"mechanism":{{"translational":[{}]}},"workspace":{{"box":{{"min":["-1","-1","-12"],"max":["1","1","-11"]}}}},"require":[{{"quantity":"joint_range","end":"within","bound":{range}}},{{"quantity":"joint_speed","given":{{"tool":["1"]}},"end":"max","bound":"20"}}]}}"#,
            legs.join(",")
        )
    };
    accepted(&text(r#"["100","250"]"#));
    assert!(certify(&claim(&text(r#"["0","90"]"#)), 300).is_none());
}

#[test]
fn a_five_bar_by_its_inverse_kinematics() {
    // Prismatic five-bar: two sliders on the x axis, rods of 200.
    accepted(
        r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[["l",{"min":"199.95","max":"200.05"}]],"definitions":[["s","sqrt(l^2-y^2)"]],"joints":[{"rho":"x-s"},{"rho":"x+s"}]}},"workspace":{"box":{"min":["-50","80"],"max":["50","160"]}},"require":[{"quantity":"transmission","end":"max","bound":"3"}]}"#,
    );
}

/// Six joints in six coordinates, of which elimination shows nothing, and all sign vertices do.
fn costly(leaves: usize, precision: u32) -> Certificate {
    let row = |i: usize| {
        let entries = (0..6).map(|j| if i == j { "\"1\"" } else { "\"p\"" });
        format!(r#"{{"row":[{}]}}"#, entries.collect::<Vec<_>>().join(","))
    };
    let rows: Vec<String> = (0..6).map(row).collect();
    let own = claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":["u","v","w","x","y","z"],"parameters":[["p",{{"min":"0.23","max":"0.27"}}]],"definitions":[],"joints":[{}]}}}},"workspace":{{"box":{{"min":["0","0","0","0","0","0"],"max":["1","1","1","1","1","1"]}}}},"require":[{{"quantity":"joint_force","given":{{"tool":["1"]}},"end":"max","bound":"1000"}}]}}"#,
        rows.join(",")
    ));
    let y = || {
        let row = |i| (0..6).map(|j| i64::from(i == j)).collect();
        Multiplier { y: (0..6).map(row).collect(), places: 0 }
    };
    let lower = (1..=6).map(|obligation| Step(obligation, Evidence::Lower(y())));
    let by: Vec<Step> = [Step(0, Evidence::Rank(y()))].into_iter().chain(lower).collect();
    let split = Node { split: Some(0), ..Node::default() };
    let leaf = Node { by, ..Node::default() };
    let halves = (1..leaves).flat_map(|_| [split.clone(), leaf.clone()]);
    let nodes = halves.chain([leaf.clone()]).collect();
    certificate(&own, Verdict::Certified, Proof::Tree(Tree { precision, chords: None, nodes }))
}

/// Matrices at vertices are counted, in integers of any size more: such a leaf takes an eighth of a second there, with
/// 1,024 bits a second.
#[test]
fn matrices_in_six_coordinates_are_work() {
    assert_eq!(check(&costly(2, 52)), Ok(()));
    assert_eq!(check(&costly(512, 52)), Err(Rejected::Work));
    assert_eq!(check(&costly(32, 60)), Err(Rejected::Work));
    assert_eq!(check(&costly(8, 1024)), Err(Rejected::Work));
}

/// The certificate of six joints in six coordinates with these entries, one of `psi` by one step in the root.
fn of_six(
    parameters: &str,
    entry: impl Fn(usize, usize) -> String,
    bound: &str,
    (precision, by): (u32, Evidence),
) -> Certificate {
    let row = |i: usize| {
        let entries: Vec<String> = (0..6).map(|j| format!("{:?}", entry(i, j))).collect();
        format!(r#"{{"row":[{}]}}"#, entries.join(","))
    };
    let rows: Vec<String> = (0..6).map(row).collect();
    let own = claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":["u","v","w","x","y","z"],"parameters":[{parameters}],"definitions":[],"joints":[{}]}}}},"workspace":{{"box":{{"min":["-1","-1","-1","-1","-1","-1"],"max":["1","1","1","1","1","1"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"{bound}"}}]}}"#,
        rows.join(",")
    ));
    let nodes = vec![Node { by: vec![Step(0, by)], ..Node::default() }];
    certificate(&own, Verdict::Certified, Proof::Tree(Tree { precision, chords: None, nodes }))
}

/// What quantities change of rows together takes a matrix for each corner of their tolerances, and one of which elimination
/// shows nothing all of its sign vertices: with three such rows 2,400 bytes asked for 20 s.
#[test]
fn matrices_of_quantities_together_are_work_with_their_sign_vertices() {
    let parameters: Vec<String> =
        (0..6).map(|k| format!(r#"["p{k}",{{"min":"-1","max":"1"}}]"#)).collect();
    let constant = |i: usize, j: usize| if i == j { 1365 } else { -683 };
    let check = |rows: usize| {
        let entry = |i: usize, j: usize| {
            let own = format!("{}/1024", constant(i, j));
            let sum = "(p0+p1+p2+p3+p4+p5)^3";
            if i < rows {
                format!("{own}+0.0000001*{sum}")
            } else {
                own
            }
        };
        let y = (0..6).map(|i| (0..6).map(|j| constant(i, j)).collect()).collect();
        let lower = Evidence::Lower(Multiplier { y, places: 10 });
        // 2^40 (0.01 + 0.001 I).
        let r: Vec<i64> = (0..6)
            .flat_map(|k| {
                let of = move |l| if k == l { 12_094_627_905 } else { 10_995_116_277 };
                (k..6).map(of)
            })
            .collect();
        let r = (0..6).map(|i| if i < rows { r.clone() } else { Vec::new() }).collect();
        let together = Evidence::Together(Box::new(lower), r, 40);
        let ends = "=".repeat(6);
        let direction = vec![vec![1, 0, 0, 0, 0, 0]];
        let by = Evidence::Tolerances(Box::new(together), ends, direction);
        check(&of_six(&parameters.join(","), entry, "1.5", (48, by)))
    };
    assert_eq!(check(3), Err(Rejected::Work));
}

/// So are those of each part of a fan, from which tolerances are taken off: 500 parts, of 86,000 bytes, asked for 40 s.
#[test]
fn matrices_of_tolerances_are_work() {
    let check = |parts: usize, precision: u32| {
        let entry = |i: usize, j: usize| {
            let own = if i == j { "5" } else { "4" };
            let more = if (i, j) == (0, 0) { "+0.000001*p" } else { "" };
            format!("{own}+0.00001*(u+v+w+x+y+z)^3{more}")
        };
        let y = (0..6).map(|i| (0..6).map(|j| if i == j { 5 } else { 4 }).collect()).collect();
        let lower = Evidence::Lower(Multiplier { y, places: 0 });
        let none = vec![0; 6];
        let own = Evidence::Tolerances(Box::new(lower), "-".to_owned(), vec![none.clone()]);
        let fan = vec![Part(none, 0, 0, own); parts];
        let parameters = r#"["p",{"min":"-1","max":"1"}]"#;
        check(&of_six(parameters, entry, "2", (precision, Evidence::Fan(fan))))
    };
    assert_eq!(check(4, 35), Ok(()));
    assert_eq!(check(500, 63), Err(Rejected::Work));
}
