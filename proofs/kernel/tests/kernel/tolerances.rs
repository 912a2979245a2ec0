//! Tolerances apart: what is certified so is true of every machine, and nearer to the truth than ranges.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::motions::decimal;
use crate::prover::{certificate, Prover};
use crate::turning::{on_circle, planar, psi, strut};
use orthocert_kernel::certificate::{Certificate, Evidence, Node, Proof, Step, Tree, Verdict};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::test::Multiplier;

/// One joint, whose row is this formula of `a` and `b`, and `psi` at most so much.
fn one_row(row: &str, [a, b]: [[&str; 2]; 2], bound: &str) -> MachineClaim {
    let [a, b] = [a, b].map(|[min, max]| format!(r#"{{"min":"{min}","max":"{max}"}}"#));
    claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[["a",{a}],["b",{b}]],"definitions":[],"joints":[{{"row":["{row}"]}}]}}}},"workspace":{{"box":{{"min":["0"],"max":["1"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"{bound}"}}]}}"#
    ))
}

/// One joint coordinate of `x` and `a`, from 1 to 3, and how great it may be.
fn one_rho(rho: &str, max: &str) -> MachineClaim {
    claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":["x"],"parameters":[["a",{{"min":"1","max":"3"}}]],"definitions":[],"joints":[{{"rho":"{rho}"}}]}}}},"workspace":{{"box":{{"min":["0"],"max":["1"]}}}},"require":[{{"quantity":"joint_range","leg":1,"end":"max","bound":"{max}"}}]}}"#
    ))
}

/// Two sliders of length 10 at right angles, each guide off by up to 0.3.
fn sliders(bound: &str) -> MachineClaim {
    let leg = |[direction, anchor]: [&str; 2]| {
        format!(
            r#"{{"drive":"slider","direction":{direction},"anchor":{anchor},"platform":["0","0"],"length":"10","mode":"+"}}"#
        )
    };
    let first = [r#"["1","0"]"#, r#"["0",{"min":"-0.3","max":"0.3"}]"#];
    let second = [r#"["0","1"]"#, r#"[{"min":"-0.3","max":"0.3"},"0"]"#];
    let legs = [first, second].map(leg).join(",");
    claim(&format!(
        r#"{{"mechanism":{{"planar":{{"legs":[{legs}]}}}},"workspace":{{"box":{{"min":["-1","-1"],"max":["2","2"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"{bound}"}}]}}"#
    ))
}

/// A certificate with tolerances apart, if one of at most so many boxes is found, and accepted.
fn apart(claim: &MachineClaim, most: usize) -> Option<Certificate> {
    found(&Problem::new(claim).expect("well formed").with_derivatives(), claim, most)
}

/// The same to second order.
fn to_second_order(claim: &MachineClaim, most: usize) -> Option<Certificate> {
    let problem = Problem::new(claim).expect("well formed").with_derivatives();
    let differing = problem.inputs.iter().enumerate().filter(|(_, input)| input.differs());
    let by = differing.map(|(j, _)| j).collect();
    let problem = problem.with_second_derivatives(&by);
    assert!(problem.derived.as_ref().is_some_and(|derived| derived.second.is_some()));
    found(&problem, claim, most)
}

fn found(problem: &Problem, claim: &MachineClaim, most: usize) -> Option<Certificate> {
    let tree = Prover::new(problem).tree(most)?;
    let found = certificate(claim, Verdict::Certified, Proof::Tree(tree));
    check(&found).is_ok().then_some(found)
}

/// The same in ranges.
fn in_ranges(claim: &MachineClaim, most: usize) -> bool {
    Prover::new(&Problem::new(claim).expect("well formed")).tree(most).is_some()
}

#[test]
fn what_a_number_shares_with_itself_cancels() {
    // a - a^2/8 is from 1.44875 to 1.54875, in ranges from 1.34875; b only has to be named.
    let (row, ends) = ("a-a^2/8+b*0", [["1.9", "2.1"]; 2]);
    let own = |bound| one_row(row, ends, bound);
    assert!(!in_ranges(&own("0.691"), 8));
    let found = apart(&own("0.691"), 8).expect("true");
    let printed = found.to_text().expect("a text");
    assert!(printed.contains(r#"{"tolerances":[{"#), "{printed}");
    assert_eq!(Certificate::read(&printed).as_ref(), Ok(&found));
    assert!(apart(&own("0.69"), 8).is_none(), "false");
    // Another number of the same range shares nothing.
    assert!(apart(&one_row("a-b^2/8", ends, "0.7"), 8).is_none(), "false");
    // Signs, exactly at the end where they are least.
    assert!(!in_ranges(&one_rho("x-a+a^2/8", "0.126"), 8));
    assert!(apart(&one_rho("x-a+a^2/8", "0.126"), 8).is_some());
    assert!(apart(&one_rho("x-a+a^2/8", "0.124"), 8).is_none());
}

#[test]
fn derivatives_are_of_all_machines() {
    // At a = 0 nothing changes to first order; at its ends the row is 1.
    for bound in ["0.6", "0.9", "0.999"] {
        assert!(
            apart(&one_row("2-a^2+b*0", [["-1", "1"], ["1", "3"]], bound), 8).is_none(),
            "{bound}"
        );
    }
    for max in ["0.8", "0.95"] {
        // a (4 - a)/4 - x is 1 at a = 2, and 3/4 at both ends.
        assert!(apart(&one_rho("a*(4-a)/4-x", max), 8).is_none(), "{max}");
    }
    assert!(apart(&one_rho("a*(4-a)/4-x", "2.1"), 8).is_some());
}

/// An interior extreme costs the range of the second derivative alone.
#[test]
fn second_derivatives_leave_what_is_of_third_order() {
    // a (4 - a)/4 - x is 1 at a = 2, where its derivative is 0, and -1/2 the second, of all machines.
    let own = |max| one_rho("a*(4-a)/4-x", max);
    for max in ["0.8", "0.95", "0.9999"] {
        assert!(to_second_order(&own(max), 8).is_none(), "{max}");
    }
    assert!(apart(&own("1.0001"), 8).is_none());
    let found = to_second_order(&own("1.0001"), 8).expect("true");
    let printed = found.to_text().expect("a text");
    assert!(printed.contains(r#","=",[]]}"#), "{printed}");
    assert_eq!(Certificate::read(&printed).as_ref(), Ok(&found));
    // Of a row, whose least value is at an end: 2 - a^2 for a in [-1, 1].
    let row = |bound| one_row("2-a^2+b*0", [["-1", "1"], ["1", "3"]], bound);
    for bound in ["0.6", "0.9", "0.999"] {
        assert!(to_second_order(&row(bound), 8).is_none(), "{bound}");
    }
    assert!(to_second_order(&row("1.01"), 8).is_some());
}

/// At the middle no derivative of `a b` says anything; that by both does.
#[test]
fn pairs_of_quantities_count() {
    let row = |bound| one_row("2-a*b", [["-1", "1"]; 2], bound);
    for bound in ["0.5", "0.51", "0.7", "0.99"] {
        assert!(to_second_order(&row(bound), 8).is_none(), "{bound}");
    }
    assert!(to_second_order(&row("1.01"), 8).is_some());
    // Half of it twice would be too little: (a + b)^2/4 is 1 at both least ends and at both greatest.
    let square = |bound| one_row("2-(a+b)^2/4", [["-1", "1"]; 2], bound);
    for bound in ["0.51", "0.6", "0.7", "0.99"] {
        assert!(to_second_order(&square(bound), 8).is_none(), "{bound}");
    }
    assert!(to_second_order(&square("1.01"), 8).is_some());
    // Third derivatives are in the ranges of second ones: a^3 from 0 to 1.
    let cube = |bound| one_row("2-a^3+b*0", [["0", "1"], ["1", "3"]], bound);
    for bound in ["0.51", "0.7", "0.99"] {
        assert!(to_second_order(&cube(bound), 8).is_none(), "{bound}");
    }
    assert!(to_second_order(&cube("1.01"), 8).is_some());
}

#[test]
fn certified_bounds_hold_for_sampled_machines() {
    // M = [[1, p], [q, 1]], p = (y - a)/sqrt(100 - (y - a)^2), q = (x - b)/sqrt(100 - (x - b)^2).
    let psi = |[x, y]: [f64; 2], [a, b]: [f64; 2]| {
        let [p, q] = [y - a, x - b].map(|off| off / (100.0 - off * off).sqrt());
        let (trace, det) = (2.0 + p * p + q * q, 1.0 - p * q);
        let least = 0.5 * (trace - (trace * trace - 4.0 * det * det).sqrt());
        least.sqrt().recip()
    };
    let mut random = Random(7);
    let mut part = |lo: f64, hi: f64| match random.below(3) {
        0 => lo,
        1 => hi,
        _ => lo + (hi - lo) * random.below(1001) as f64 / 1000.0,
    };
    let mut worst = 0f64;
    for _ in 0..20_000 {
        let [x, y] = [part(-1.0, 2.0), part(-1.0, 2.0)];
        worst = worst.max(psi([x, y], [part(-0.3, 0.3), part(-0.3, 0.3)]));
    }
    let at = |factor: f64| sliders(&format!("{:.6}", worst * factor));
    assert!(apart(&at(1.0003), 400).is_some());
    assert!(to_second_order(&at(1.0003), 400).is_some());
    for factor in [0.9999, 0.999, 0.99] {
        assert!(apart(&at(factor), 400).is_none(), "{factor}");
        assert!(to_second_order(&at(factor), 400).is_none(), "{factor}");
    }
}

/// Characters of second order say what they say of each quantity by itself.
#[test]
fn nothing_else_goes_with_second_order() {
    let own = one_row("a-a^2/8+b*0", [["1.9", "2.1"]; 2], "0.691");
    let good = to_second_order(&own, 8).expect("true");
    let accepted = |own: &MachineClaim, bound: &str, ends: &str| {
        let Proof::Tree(mut tree) = good.proof.clone() else { panic!("a tree") };
        for Step(_, by) in tree.nodes.iter_mut().flat_map(|node| &mut node.by) {
            if let Evidence::Tolerances(_, own, _) = by {
                ends.clone_into(own);
            }
        }
        let text = serde_json::to_string(own).expect("a text").replace("0.691", bound);
        check(&certificate(&claim(&text), Verdict::Certified, Proof::Tree(tree))).is_ok()
    };
    let all = |own: &MachineClaim, bound: &str| {
        let ends = |n: usize| -> String {
            [n % 6, n / 6].iter().map(|&k| char::from(b"-+0<>="[k])).collect()
        };
        (0..36).map(ends).filter(|ends| accepted(own, bound, ends)).collect::<Vec<String>>()
    };
    assert_eq!(all(&own, "0.69"), Vec::<String>::new(), "false");
    assert!(all(&own, "0.691").len() >= 12);
    for ends in ["<", "<<<", "x<", "<1", ""] {
        assert!(!accepted(&own, "0.691", ends), "{ends}");
    }
}

/// The same certificate with the evidence of one step changed: not accepted, whatever the change.
#[test]
fn nothing_else_goes_with_it() {
    let own = one_row("a-a^2/8+b*0", [["1.9", "2.1"]; 2], "0.691");
    let good = apart(&own, 8).expect("true");
    let with = |own: &MachineClaim, change: &dyn Fn(&mut Evidence)| {
        let Proof::Tree(mut tree) = good.proof.clone() else { panic!("a tree") };
        let steps = tree.nodes.iter_mut().flat_map(|node| &mut node.by);
        let mut apart = steps.filter(|Step(_, by)| matches!(by, Evidence::Tolerances(..)));
        change(&mut apart.next().expect("one").1);
        drop(apart);
        check(&certificate(own, Verdict::Certified, Proof::Tree(tree))).is_ok()
    };
    assert!(with(&own, &|_| ()));
    let replaced = |ends: fn(&str) -> String, directions: fn(&mut Vec<Vec<i64>>)| {
        with(&own, &|evidence| {
            let Evidence::Tolerances(_, own, all) = evidence else { panic!("one") };
            *own = ends(own);
            directions(all);
        })
    };
    let same = |ends: &str| ends.to_owned();
    assert!(!replaced(|ends| ends[1..].to_owned(), |_| ()), "too few ends");
    assert!(!replaced(|ends| format!("{ends}0"), |_| ()), "too many ends");
    assert!(!replaced(|_| "xx".to_owned(), |_| ()), "ends of no name");
    assert!(!replaced(same, Vec::clear), "no direction");
    assert!(!replaced(same, |all| all[0].push(1)), "too long a direction");
    assert!(!replaced(same, |all| all.push(vec![1])), "too many directions");
    assert!(replaced(same, |all| all[0][0] = i64::MAX / 1_000_000), "any direction");
    let wrapped = |wrap: fn(Box<Evidence>) -> Evidence| {
        with(&own, &|evidence| *evidence = wrap(Box::new(evidence.clone())))
    };
    assert!(!wrapped(|inner| Evidence::Tolerances(inner, "00".to_owned(), vec![vec![1]])), "twice");
    assert!(!wrapped(Evidence::Control), "at control points");
    assert!(!wrapped(|inner| Evidence::Inside(inner, 0, 0)), "inside of nothing");
    let inner = |new: fn() -> Evidence| {
        with(&own, &|evidence| {
            let Evidence::Tolerances(inner, ..) = evidence else { panic!("one") };
            **inner = new();
        })
    };
    let y = || Multiplier { y: vec![vec![3]], places: 1 };
    assert!(!inner(|| Evidence::Test), "of another test");
    assert!(
        !inner(|| Evidence::LowerDivided(Multiplier { y: vec![vec![3]], places: 1 })),
        "divided"
    );
    // Of a claim without tolerances there is nothing to take apart.
    let exact = one_row("a-a^2/8+b*0", [["1.9", "2.1"]; 2], "0.691");
    let text = serde_json::to_string(&exact)
        .expect("a text")
        .replace(r#"{"min":"1.9","max":"2.1"}"#, r#""2""#);
    let exact = claim(&text);
    assert!(!with(&exact, &|evidence| {
        let Evidence::Tolerances(_, ends, _) = evidence else { panic!("one") };
        ends.clear();
    }));
    let plain = |evidence: Evidence| {
        let nodes = vec![Node { by: vec![Step(0, evidence)], ..Node::default() }];
        let tree = Tree { precision: 52, chords: None, nodes };
        check(&certificate(&exact, Verdict::Certified, Proof::Tree(tree))).is_ok()
    };
    assert!(plain(Evidence::Lower(y())));
    assert!(!plain(Evidence::Tolerances(
        Box::new(Evidence::Lower(y())),
        String::new(),
        vec![vec![1]]
    )));
}

fn short(x: f64) -> String {
    decimal((x * 1e6).round() / 1e6)
}

fn range(x: f64, off: f64) -> String {
    format!(r#"{{"min":"{}","max":"{}"}}"#, short(x - off), short(x + off))
}

/// Three struts in the plane, of one of which both ends may be off along x.
fn three_struts([anchor, platform]: [&dyn Fn(f64) -> String; 2], require: &str) -> MachineClaim {
    let at = |turn: f64| on_circle(0.5, turn + 80.0);
    let legs = [
        strut(
            &format!(r#"{},"1""#, anchor(0.0)),
            &format!(r#"{},"0.086824""#, platform(-0.492404)),
        ),
        strut(r#""-0.866025","-0.5""#, &at(210.0)),
        strut(r#""0.866025","-0.5""#, &at(330.0)),
    ];
    claim(&planar(&legs, [r#""-0.2","-0.2""#, r#""0.2","0.2""#], r#""-20","20""#, require))
}

const OFF: f64 = 0.1;

/// The least singular value of such machines, all ends and the middle, at poses of a grid.
fn worst_of_three_struts() -> f64 {
    let exact = |part: f64| move |x: f64| format!("\"{}\"", short(x + part * OFF));
    let parts = [-1.0, 0.0, 1.0];
    let all = parts.iter().flat_map(|p| parts.iter().map(move |q| (*p, *q)));
    let sigma = all.flat_map(|(p, q)| {
        let problem = Problem::new(&three_struts([&exact(p), &exact(q)], "")).expect("a claim");
        let prover = Prover::new(&problem);
        let at = |x: &Vec<f64>| prover.matrix(x).expect("within reach").singular_values().min();
        prover.grid(9).iter().map(at).collect::<Vec<f64>>()
    });
    sigma.fold(f64::INFINITY, f64::min)
}

/// With tolerances.
fn three_loose_struts(require: &str) -> MachineClaim {
    three_struts([&|x| range(x, OFF); 2], require)
}

#[test]
fn of_platforms_that_turn_at_control_points() {
    let sigma = worst_of_three_struts();
    let bound = |part: f64| three_loose_struts(&psi("max", part * sigma));
    let found = apart(&bound(0.95), 9).expect("true");
    let printed = found.to_text().expect("a text");
    assert!(printed.contains(r#"{"tolerances":[{"control":{"lower""#), "{printed}");
    assert_eq!(Certificate::read(&printed).as_ref(), Ok(&found));
    assert!(!in_ranges(&bound(0.95), 9));
    for part in [1.0005, 1.005, 1.05] {
        assert!(apart(&bound(part), 9).is_none(), "{part}");
    }
    // The shortest that the first strut gets.
    let mut shortest = f64::INFINITY;
    for (at, turn) in (0..3 * 3 * 3 * 3 * 41).map(|n| (n % 81, n / 81)) {
        let part = |k: u32| f64::from(at / 3i32.pow(k) % 3) / 2.0 - 0.5;
        let [x, y, off, own] =
            [0.4 * part(0), 0.4 * part(1), 0.2 * part(2), 0.2 * part(3) - 0.492404];
        let (sin, cos) = f64::from(turn - 20).to_radians().sin_cos();
        let u = x + own * cos - 0.086824 * sin - off;
        shortest = shortest.min(u.hypot(y + own * sin + 0.086824 * cos - 1.0));
    }
    let stroke = |part: f64| {
        let min = short(shortest * part);
        three_loose_struts(&format!(
            r#"{{"quantity":"joint_range","leg":1,"end":"min","bound":"{min}"}}"#
        ))
    };
    let found = apart(&stroke(0.9), 9).expect("true");
    let printed = found.to_text().expect("a text");
    assert!(printed.contains(r#"{"tolerances":[{"control":"test"}"#), "{printed}");
    assert!(!in_ranges(&stroke(0.9), 9));
    for part in [1.0005, 1.002, 1.02] {
        assert!(apart(&stroke(part), 9).is_none(), "{part}");
    }
}

/// Around evidence at control points nothing else may stand, and nothing in its place.
#[test]
fn nothing_else_goes_with_control_points() {
    let own = three_loose_struts(&psi("max", 0.95 * worst_of_three_struts()));
    let good = apart(&own, 9).expect("true");
    let with = |change: &dyn Fn(Evidence) -> Evidence| {
        let Proof::Tree(mut tree) = good.proof.clone() else { panic!("a tree") };
        let steps = tree.nodes.iter_mut().flat_map(|node| &mut node.by);
        let mut apart = steps.filter(|Step(_, by)| matches!(by, Evidence::Tolerances(..)));
        let step = &mut apart.next().expect("one").1;
        *step = change(step.clone());
        drop(apart);
        check(&certificate(&own, Verdict::Certified, Proof::Tree(tree))).is_ok()
    };
    let inner = |change: &dyn Fn(Evidence) -> Evidence| {
        with(&|evidence| {
            let Evidence::Tolerances(inner, ends, directions) = evidence else { panic!("one") };
            Evidence::Tolerances(Box::new(change(*inner)), ends, directions)
        })
    };
    assert!(inner(&|evidence| evidence));
    assert!(!with(&|evidence| Evidence::Control(Box::new(evidence))), "the other way about");
    assert!(!inner(&|evidence| Evidence::Control(Box::new(evidence))), "twice");
    assert!(!inner(&|evidence| Evidence::Turned(Box::new(evidence), 1, 0)), "turned of nothing");
    assert!(!inner(&|evidence| Evidence::Inside(Box::new(evidence), 1, 0)), "inside of nothing");
    assert!(!inner(&|_| Evidence::Control(Box::new(Evidence::Test))), "of another test");
    let at_vertices = |evidence| match evidence {
        Evidence::Control(inner) => *inner,
        other => other,
    };
    assert!(!inner(&at_vertices), "derivatives are of polynomials alone");
    let plain = |evidence| match evidence {
        Evidence::Tolerances(inner, ..) => *inner,
        other => other,
    };
    assert!(!with(&plain), "ranges are too wide");
    let second = |evidence| match evidence {
        Evidence::Tolerances(inner, ends, directions) => {
            let ends = ends.replace('-', "<").replace('0', "=").replace('+', ">");
            Evidence::Tolerances(inner, ends, directions)
        }
        other => other,
    };
    assert!(!with(&second), "second derivatives are of vertices alone");
}

/// The axis of a strut's joint, `[0, -1]`, and the strut, whose end is off by as much.
fn loose_joint(ends: [&str; 2], bound: &str, evidence: &str) -> String {
    let [lo, hi] = ends;
    format!(
        r#"{{"format":"orthocert/2","claim":{{"machine":{{"mechanism":{{"planar":{{"legs":[{{"drive":"strut","anchor":["0",{{"min":"{lo}","max":"{hi}"}}],"platform":["50","50"]}},{{"drive":"strut","anchor":["-346","-200"],"platform":["-86","50"]}},{{"drive":"strut","anchor":["346","-200"],"platform":["0","-100"]}}],"characteristic_length":"100"}}}},"workspace":{{"box":{{"min":["-0.125","-0.125"],"max":["0.125","0.125"]}}}},"orientation":{{"range":["-0.1","0.1"]}},"require":[{{"quantity":"base_joint","leg":1,"given":{{"axis":["0","-1"]}},"end":"max","bound":"{bound}"}}]}}}},"verdict":"certified","proof":{{"tree":{{"precision":52,"nodes":[{{"by":[[0,{{"control":{{"rank":{{"y":[[0,-1,-1],[1,1,-1],[-1,0,-1]],"places":1}}}}}}],[1,{{"control":"test"}}],[2,{evidence}]]}}]}}}},"provenance":{{"tool":"test","version":"0"}}}}
"#
    )
}

/// The bound of a leg's angle, `U . j`, is another for each machine, and is not that of the one.
#[test]
fn bounds_that_tolerances_change_are_lessened_too() {
    let accepted = |ends, bound, evidence: &str| {
        check(&Certificate::read(&loose_joint(ends, bound, evidence)).expect("a text")).is_ok()
    };
    let apart = |inner: &str, end: &str, direction: &str| {
        format!(r#"{{"tolerances":[{inner},"{end}",[{direction}]]}}"#)
    };
    let all = ["\"test\"", r#"{"control":"test"}"#].into_iter().flat_map(|inner| {
        let directions = ["[-9,64,0]", "[9,64,0]", "[0,1,0]", "[1,0,0]"];
        let with = move |end| directions.map(|direction| apart(inner, end, direction));
        ["-", "+", "0"].into_iter().flat_map(with)
    });
    // atan(50/310) is 9.16 degrees.
    for evidence in all {
        for bound in ["7.4", "8", "8.6", "9.1"] {
            assert!(!accepted(["360", "440"], bound, &evidence), "{bound} {evidence}");
        }
    }
    let own = r#"{"control":"test"}"#;
    assert!(accepted(["399", "401"], "9.5", &apart(own, "+", "[-9,64,0]")));
    assert!(!accepted(["399", "401"], "9.5", own), "ranges are too wide");
}

/// Of a joint's speed `|b|^2` is in the bound, another for each machine, and not that of the one.
#[test]
fn bounds_that_tolerances_change_are_raised_too() {
    let accepted = |[lo, hi]: [&str; 2], bound: &str, evidence: &str| {
        let text = loose_joint(["400", "400"], bound, evidence)
            .replace(r#"{"min":"400","max":"400"}"#, r#""400""#)
            .replace(r#"["50","50"]"#, &format!(r#"["50",{{"min":"{lo}","max":"{hi}"}}]"#))
            .replace(
                r#""base_joint","leg":1,"given":{"axis":["0","-1"]}"#,
                r#""joint_speed","leg":1,"given":{"tool":["1"]}"#,
            )
            .replace(r#"[1,{"control":"test"}],[2,"#, "[1,");
        check(&Certificate::read(&text).expect("a text")).is_ok()
    };
    let apart = |y: i64, end: &str, direction: &str| {
        format!(
            r#"{{"tolerances":[{{"control":{{"lower":{{"y":[[{y}]],"places":7}}}}}},"{end}",[{direction}]]}}"#
        )
    };
    // sqrt(1 + 16/(1 + (400 - y)^2/2500)) at the middle, y = 60: 1.1570.
    for (y, end) in (-24..=0).flat_map(|y| ["-", "+", "0"].map(|end| (y, end))) {
        for bound in ["1.145", "1.15", "1.155"] {
            assert!(!accepted(["40", "60"], bound, &apart(y, end, "[1]")), "{y} {end} {bound}");
        }
    }
    assert!(accepted(["49.5", "50.5"], "1.16", &apart(-15, "+", "[1]")));
    assert!(!accepted(["49.5", "50.5"], "1.16", &apart(-15, "+", "[1,0,0]")), "one entry");
    assert!(!accepted(["49.5", "50.5"], "1.16", &apart(15, "+", "[1]")), "the other way");
}

/// What tolerances change of one obligation in six coordinates would take seconds: it is not taken apart.
#[test]
fn too_many_changes_are_not_taken_apart() {
    let names: Vec<String> = (0..80).map(|k| format!("a{k}")).collect();
    let parameter = |name: &String| format!(r#"["{name}",{{"min":"0","max":"1"}}]"#);
    let parameters: Vec<String> = names.iter().map(parameter).collect();
    let rows: Vec<String> = (0..6)
        .map(|i| {
            let entry = |k| {
                if i == k {
                    format!("\"9+0.001*({})\"", names.join("+"))
                } else {
                    "\"0\"".to_owned()
                }
            };
            format!(r#"{{"row":[{}]}}"#, (0..6).map(entry).collect::<Vec<_>>().join(","))
        })
        .collect();
    let claim = claim(&format!(
        r#"{{"mechanism":{{"formulas":{{"coordinates":["u","v","w","x","y","z"],"parameters":[{}],"definitions":[],"joints":[{}]}}}},"workspace":{{"box":{{"min":["0","0","0","0","0","0"],"max":["1","1","1","1","1","1"]}}}},"require":[{{"quantity":"transmission","end":"max","bound":"1"}}]}}"#,
        parameters.join(","),
        rows.join(",")
    ));
    let problem = Problem::new(&claim).expect("well formed");
    assert!(problem.tolerances().count() == 80 && problem.with_derivatives().derived.is_none());
}
