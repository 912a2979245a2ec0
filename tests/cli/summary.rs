//! `summary`: values against closed forms, the nearest requirement, every kind of machine, refused.

use crate::support::{number, Folder};
use serde_json::Value;

const PROTOTYPE_STROKE: f64 = 256.993_015_636_8;

fn summary(folder: &Folder, arguments: &[&str], code: i32) -> Value {
    let all = [&["summary"], arguments, &["--format", "json"]].concat();
    serde_json::from_str(&folder.run(&all).exits(code).stdout).unwrap()
}

fn find<'a>(answer: &'a Value, quantity: &str, end: &str) -> &'a Value {
    let values = answer["values"].as_array().unwrap();
    let own = |row: &&Value| row["quantity"] == quantity && row["end"] == end;
    values.iter().find(own).unwrap_or_else(|| panic!("no {end} {quantity} in {answer}"))
}

/// Holds that a value is between its two ends, which are near each other.
fn encloses(row: &Value, exact: f64, width: f64) {
    let (certified, reached) = (number(&row["certified"]), number(&row["reached"]));
    let (lo, hi) = if certified < reached { (certified, reached) } else { (reached, certified) };
    assert_eq!(row["end"] == "least", certified < reached, "{row}");
    assert!(lo <= exact && exact <= hi && hi - lo <= width, "{row}: {exact}");
}

/// A folder with one of the designs of the kernel's machines.
fn kernel(design: &str) -> Folder {
    let folder = Folder::new();
    let from = format!("{}/tests/designs/kernel/{design}", env!("CARGO_MANIFEST_DIR"));
    folder.write(design, std::fs::read(from).unwrap());
    folder
}

/// Two sliders across each other in the plane.
fn two_sliders(length: &str, requirements: &str) -> String {
    format!(
        "[mechanism]\nkind = \"formulas\"\ncoordinates = [\"x\", \"y\"]\n\
         [mechanism.parameters]\nl = {length}\n\
         [[mechanism.joints]]\nrho = \"x - sqrt(l^2 - y^2)\"\n\
         [[mechanism.joints]]\nrho = \"y - sqrt(l^2 - x^2)\"\n\
         [workspace]\nmin = [-30, -30]\nmax = [30, 30]\n[requirements]\n{requirements}\n"
    )
}

/// One quantity has one name in every text; symbols are for scripts.
#[test]
fn a_quantity_has_one_name() {
    for (design, name, symbol) in [
        ("delta-conditioning.toml", "condition number", "sigma_max/sigma_min"),
        ("delta-serial-margin.toml", "serial margin", "|eta_i|/L_i"),
        ("delta-parallel-margin.toml", "parallel margin", "|det A|/(L_1 .. L_n)"),
    ] {
        let folder = Folder::with(&[design]);
        for command in ["verify", "summary"] {
            let answer = folder.run(&[command, design]).exits(0).says(&[name]);
            assert!(!answer.stdout.contains(symbol), "{}", answer.stdout);
        }
        let answer = folder.run(&["verify", design, "--format", "json"]).exits(0);
        let answer: Value = serde_json::from_str(&answer.stdout).unwrap();
        assert_eq!(answer["margins"][0]["quantity"], symbol);
    }
}

/// Where a platform turns, how far and by which angle it is off are two things.
#[test]
fn an_accuracy_has_two_bounds() {
    let folder = Folder::new();
    let leg = |anchor: &str, platform: &str| {
        format!("[[mechanism.legs]]\ndrive = \"strut\"\nanchor = {anchor}\nplatform = {platform}\n")
    };
    let legs = [
        leg("[0, \"4 ± 0.001\"]", "[\"sqrt(3)/2\", \"1/2\"]"),
        leg("[\"-2*sqrt(3) ± 0.001\", -2]", "[\"-sqrt(3)/2\", \"1/2\"]"),
        leg("[\"2*sqrt(3) ± 0.001\", -2]", "[0, -1]"),
    ];
    let design = |angle: &str| {
        format!(
            "[mechanism]\nkind = \"planar\"\ncharacteristic_length = 1\n{}[workspace]\n\
             min = [\"-1/2\", \"-1/2\"]\nmax = [\"1/2\", \"1/2\"]\norientation = {{ angle = [-20, 20] }}\n\
             [requirements]\naccuracy = {{ joint_error = 0.001, max = 0.005, max_angle = {angle} }}\n",
            legs.join("")
        )
    };
    // At most 0.144 degrees, and at most 0.003, are found.
    folder.write("near.toml", design("0.16"));
    let answer = summary(&folder, &["near.toml"], 0);
    let nearest = &answer["nearest"];
    assert_eq!(nearest["requirement"], "accuracy of the angle, deg", "{nearest}");
    let margin = [number(&nearest["margin_at_least"]), number(&nearest["margin_at_most"])];
    assert!(0.03 < margin[0] && margin[0] < 0.102 && margin[1] > 0.1, "{nearest}");
    let rows = answer["values"].as_array().unwrap();
    let rows: Vec<&Value> = rows.iter().filter(|row| row["quantity"] == "accuracy").collect();
    let [off, angle] = rows[..] else { panic!("{answer}") };
    assert!(off["unit"] != "deg" && angle["unit"] == "deg", "{off} {angle}");
    encloses(off, 0.002986, 0.0005);
    encloses(angle, 0.14386, 0.02);
    let answer: Value = {
        folder.write("near.toml", design("0.14"));
        let json = folder.run(&["verify", "near.toml", "--format", "json"]).exits(1).stdout;
        serde_json::from_str(&json).unwrap()
    };
    let told = answer["counterexample"]["value"].as_str().unwrap();
    assert_eq!(told, "no pose within both bounds");
}

/// 100,000 samples of `benches/accuracy.py` reach 0.005098, and 0.028875 degrees.
#[test]
fn the_worst_of_many_tolerances_is_found() {
    let folder = kernel("hexapod-accuracy.toml");
    let verify = ["verify", "hexapod-accuracy.toml", "--format", "json"];
    let answer: Value = serde_json::from_str(&folder.run(&verify).exits(0).stdout).unwrap();
    let rows = answer["requirements"].as_array().unwrap();
    let found = |name: &str| {
        let row = rows.iter().find(|row| row["requirement"] == name);
        row.unwrap_or_else(|| panic!("no {name} in {answer}"))["worst_found"].as_f64().unwrap()
    };
    assert!((0.005098..0.0052).contains(&found("accuracy")), "{answer}");
    assert!((0.028875..0.029).contains(&found("accuracy of the angle, deg")), "{answer}");
}

#[test]
fn the_prototype_has_the_strokes_and_speeds_of_its_theory() {
    let folder = Folder::new();
    let options = ["--speed", "1200", "--force", "100", "--acceleration", "14000", "--gap", "0.01"];
    let answer = summary(&folder, &options, 0);
    assert_eq!(answer["verdict"], "certified");
    for end in ["least", "greatest"] {
        let (psi, exact) =
            (find(&answer, "transmission", end), if end == "least" { 0.5 } else { 2.0 });
        assert_eq!((number(&psi["certified"]), number(&psi["reached"])), (exact, exact));
    }
    let size = 0.011 * PROTOTYPE_STROKE;
    encloses(find(&answer, "joint_range", "least"), 0.0, size);
    encloses(find(&answer, "joint_range", "greatest"), PROTOTYPE_STROKE, size);
    // Row 1 of M is (1, y/s, z/s), s^2 = L^2 - y^2 - z^2, of length L/s: longest at y = z = c, the greater
    // corner, where c/s = 1/2.
    let speed = find(&answer, "joint_speed", "greatest");
    encloses(speed, 1200.0 * 1.5f64.sqrt(), 1200.0 * 0.0125);
    assert_eq!(speed["given"]["tool"][0], "1200");
    assert!(number(&find(&answer, "joint_force", "greatest")["certified"]) < 200.0);
    let acceleration = find(&answer, "joint_acceleration", "greatest");
    assert!(number(&acceleration["certified"]) > 14000.0, "{acceleration}");
    assert_eq!(number(&answer["nearest"]["margin_at_least"]), 0.0);
    assert_eq!(answer["left_out"].as_array().unwrap().len(), 0);
}

/// Rows are searched side by side: all are there, in their order, with what one thread finds.
#[test]
fn rows_do_not_depend_on_the_threads() {
    let design = "rotary-delta-linuxcnc.toml";
    let folder = Folder::with(&[design]);
    for command in [&["summary", design][..], &["bounds", design, "--relative", "0.01"]] {
        let answer = |threads: &str| {
            let more = ["--format", "json", "--threads", threads];
            let text = folder.run(&[command, &more].concat()).exits(0).stdout;
            let mut answer: Value = serde_json::from_str(&text).unwrap();
            answer["seconds"].take();
            answer
        };
        let one = answer("1");
        let rows = one.get("values").or(one.get("bounds")).and_then(Value::as_array).unwrap();
        assert!(rows.len() > 5, "{one}");
        assert_eq!(one, answer("5"), "{command:?}");
    }
}

#[test]
fn the_first_lines_answer_the_question() {
    let folder = Folder::new();
    let text = folder.run(&["summary", "--speed", "1200", "--gap", "0.01"]).exits(0).stdout;
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("CERTIFIED  Orthoglide prototype"), "{text}");
    assert!(lines[4].contains("nearest limit") && lines[4].contains("exactly 0 % left"), "{text}");
    assert!(lines[5].contains("seen") && lines[5].contains("(x, y, z) = ("), "{text}");
    assert!(lines.len() <= 25 && lines.iter().all(|line| line.chars().count() <= 100), "{text}");
    assert!(text.contains("strokes of joints 1, 2, 3") && text.contains("0.5 to 2"), "{text}");
    let quiet = folder.run(&["summary", "-q"]).exits(0).stdout;
    assert_eq!(quiet, "CERTIFIED  Orthoglide prototype\n");
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn the_nearest_requirement_is_the_one_with_the_least_margin() {
    let folder = Folder::new();
    // rho goes from -30 - 100 to 30 - (100^2 - 30^2)^(1/2) = -65.394; psi is within 1 -+ t, t = 0.3145.
    for (requirements, nearest, margin) in [
        ("joint_range = { max = -65 }\ntransmission = { max = 3 }", "greatest rho_", 0.0061),
        ("joint_range = { max = 100 }\ntransmission = { max = 1.5 }", "greatest psi", 0.0275),
        ("joint_range = { min = -131 }\nconditioning = { max = 8 }", "least rho_", 0.0155),
    ] {
        folder.write("a.toml", two_sliders("100", requirements));
        let answer = summary(&folder, &["a.toml"], 0);
        let found = &answer["nearest"];
        assert!(found["requirement"].as_str().unwrap().starts_with(nearest), "{found}");
        let (least, most) = (number(&found["margin_at_least"]), number(&found["margin_at_most"]));
        assert!(least <= margin + 1e-4 && margin - 1e-4 <= most, "{found}");
        assert!(most - least < 0.005, "{found}");
        assert_eq!(found["seen_at"].as_array().unwrap().len(), 2);
    }
}

#[test]
fn a_refuted_design_says_by_how_much() {
    let folder = Folder::with(&["orthoglide-310.toml", "orthoglide-tie.toml"]);
    let run = folder.run(&["summary", "orthoglide-310.toml"]).exits(1);
    run.says(&["REFUTED", "violated greatest psi <= 2", "greatest psi <= 2: exceeded by 0.2"]);
    let answer = summary(&folder, &["orthoglide-310.toml"], 1);
    // 2.0058 for 2.
    let least = number(&answer["nearest"]["margin_at_least"]);
    assert!((-0.005..-0.0028).contains(&least), "{least}");
    assert!(number(&answer["nearest"]["margin_at_most"]) < 0.0);
    let answer = summary(&folder, &["orthoglide-tie.toml", "--max-boxes", "50"], 3);
    assert_eq!(answer["verdict"], "undecided");
    assert!(answer["undecided"].is_string());
    // Nothing is claimed without time.
    let answer = summary(&folder, &["orthoglide-310.toml", "--timeout", "0"], 1);
    let values = answer["values"].as_array().unwrap();
    assert!(values.iter().all(|row| row["certified"].is_null() && row["not_enclosed"].is_string()));
    folder.write("out.toml", two_sliders("25", "joint_range = { max = 100 }"));
    let answer = summary(&folder, &["out.toml"], 1);
    assert!(answer["nearest"].is_null());
}

#[test]
fn machines_of_every_kind() {
    for (design, options, present, absent) in [
        (
            "planar-3-rpr.toml",
            &["--speed", "100", "--force", "10", "--acceleration", "500"][..],
            &["joint_range", "transmission", "joint_speed", "joint_force", "joint_acceleration"][..],
            "",
        ),
        (
            "five-bar.toml",
            &["--force", "10"],
            &["joint_range", "transmission", "joint_speed", "joint_force"],
            "",
        ),
        (
            "spherical-3-ups.toml",
            &["--force", "10"],
            &["joint_range", "transmission", "joint_force"],
            "",
        ),
        (
            "four-guides.toml",
            &["--force", "10"],
            &["joint_range", "transmission"],
            "as many joints",
        ),
    ] {
        let most = ["--max-boxes", "400", "--gap", "0.05"];
        let answer = summary(&kernel(design), &[&[design], options, &most].concat(), 0);
        let values = answer["values"].as_array().unwrap();
        for quantity in present {
            let there = |row: &&Value| row["quantity"] == *quantity && row["certified"].is_string();
            assert!(values.iter().any(|row| there(&row)), "{design} {quantity} {answer}");
        }
        let left_out = answer["left_out"].as_array().unwrap();
        assert_eq!(left_out.len(), usize::from(!absent.is_empty()), "{answer}");
        assert!(left_out.iter().all(|why| why.as_str().unwrap().contains(absent)), "{answer}");
        assert!(answer["nearest"].is_object(), "{answer}");
    }
}

#[test]
fn angles_of_arms_are_sectors_in_degrees() {
    let folder = kernel("five-bar.toml");
    let answer = summary(&folder, &["five-bar.toml", "--gap", "0.01"], 0);
    let (least, greatest) =
        (find(&answer, "joint_range", "least"), find(&answer, "joint_range", "greatest"));
    assert_eq!(least["unit"], "deg");
    // The angle of the first arm at the corners: the point's direction from the anchor, and the triangle.
    let angle = |x: f64, y: f64| {
        let (dx, dy) = (x + 59.0, y);
        let d = dx.hypot(dy);
        let inner = ((90.0f64.powi(2) + d * d - 110.0f64.powi(2)) / (2.0 * 90.0 * d)).acos();
        (dy.atan2(dx) + inner).to_degrees()
    };
    let all =
        (0..=40).flat_map(|i| (0..=40).map(move |j| (f64::from(i - 20), 110.0 + f64::from(j))));
    let all: Vec<f64> = all.map(|(x, y)| angle(x, y)).collect();
    let (lo, hi) = all.iter().fold((f64::MAX, f64::MIN), |(lo, hi), x| (lo.min(*x), hi.max(*x)));
    let width = 0.02 * (hi - lo);
    encloses(least, lo, width);
    encloses(greatest, hi, width);
}

#[test]
fn the_tolerance_that_matters_most_comes_first() {
    let folder = Folder::new();
    let design = "[mechanism]\nkind = \"formulas\"\ncoordinates = [\"x\", \"y\"]\n\
                  [mechanism.parameters]\na = \"0 ± 0.3\"\nb = \"0 ± 0.1\"\n\
                  [[mechanism.joints]]\nrho = \"x + a\"\n[[mechanism.joints]]\nrho = \"y + b\"\n\
                  [workspace]\nmin = [-1, -1]\nmax = [1, 1]\n\
                  [requirements]\naccuracy = { joint_error = 0.05, max = 1 }\n";
    folder.write("a.toml", design);
    let answer = summary(&folder, &["a.toml", "--gap", "0.01"], 0);
    let shares = answer["accuracy"]["alone"].as_array().unwrap();
    let names: Vec<&str> = shares.iter().map(|row| row["parameter"].as_str().unwrap()).collect();
    assert_eq!(names, ["a", "b", "joint_error"]);
    // The joints' errors together put the platform 0.05 sqrt(2) off.
    for (row, exact) in shares.iter().zip([0.3, 0.1, 0.05 * 2f64.sqrt()]) {
        let bound = number(&row["certified"]);
        assert!(exact <= bound && bound <= 1.02 * exact, "{row}");
    }
    let whole = number(&answer["accuracy"]["together"]);
    let exact = 0.35f64.hypot(0.15);
    assert!(exact <= whole && whole <= 1.02 * exact, "{whole}");
    let text = folder.run(&["summary", "a.toml", "--gap", "0.01"]).exits(0);
    text.says(&["one deviation alone", "a 0.3", "joint errors 0.07", "all at once: 0.38"]);
}

#[test]
fn what_is_no_speed_is_refused_with_the_option_and_what_is_accepted() {
    let folder = Folder::new();
    for option in ["--speed", "--force", "--acceleration"] {
        for text in ["-1", "0", "x", "sqrt(2)", "1 ± 0.1", "inf", "1e400", "1e-400"] {
            folder.run(&["summary", option, text]).exits(2).complains(&[option, "accepted"]);
        }
    }
    for gap in ["0", "1", "-1e-3", "1e-10", "x"] {
        folder.run(&["summary", "--gap", gap]).exits(2).complains(&["--gap", "accepted"]);
    }
    folder.run(&["summary", "missing.toml"]).exits(2).complains(&["missing.toml"]);
    assert_eq!(folder.names(), [""; 0]);
}

/// By the paper, psi of the cube is from `1/psi_max` to `psi_max`, exactly.
#[test]
fn an_irrational_psi_of_the_papers_cube_is_enclosed() {
    let folder = Folder::new();
    folder.write(
        "d.toml",
        "[mechanism]\nkind = \"orthoglide\"\n[workspace]\ncube = 200\n[requirements]\ntransmission = { max = \"sqrt(3)\" }\n",
    );
    let answer = summary(&folder, &["d.toml"], 0);
    for (end, exact) in [("least", 3f64.sqrt().recip()), ("greatest", 3f64.sqrt())] {
        let row = find(&answer, "transmission", end);
        for end in ["certified", "reached"] {
            assert!((number(&row[end]) - exact).abs() < 1e-15, "{row}");
        }
        assert_ne!(row["certified"], row["reached"]);
    }
}
