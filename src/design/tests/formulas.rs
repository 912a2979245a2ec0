//! Mechanisms by formulas: their texts, and every class of what is refused.

use super::kinds::{kernel, shown};
use super::refused::row;
use super::*;
use crate::design::exactly;
use orthocert_kernel::number::Expression;
use serde_json::json;
use Defect::{Conflict, MissingKey, NotANumber, Tolerance, UnknownKey, UnknownWord, WrongType};

/// Two sliders that carry a point.
const FORMULAS: &str = r#"[mechanism]
kind = "formulas"
coordinates = ["x", "y"]
[mechanism.parameters]
l = "200 ± 0.05"
d = "100*sqrt(3)"
[mechanism.definitions]
s = "sqrt(l^2 - y^2)"
t = "sqrt(l^2 - (y - d)^2)"
[[mechanism.joints]]
rho = "x - s"
[[mechanism.joints]]
rho = "x + t / 2"
[workspace]
min = [-10, 20]
max = [10, 40]
[requirements]
transmission = { max = 20 }
"#;

#[test]
fn a_mechanism_by_formulas() {
    let design = Design::parse(FORMULAS, "test.toml").unwrap();
    assert_eq!(design.claim, kernel(FORMULAS));
    assert_eq!(
        shown(FORMULAS)["mechanism"]["formulas"],
        json!({
            "coordinates": ["x", "y"],
            "parameters": [["d", "100*sqrt(3)"], ["l", { "min": "199.95", "max": "200.05" }]],
            "definitions": [["s", "sqrt(l^2-y^2)"], ["t", "sqrt(l^2-(y-d)^2)"]],
            "joints": [{ "rho": "x-s" }, { "rho": "x+t/2" }],
        })
    );
    let rows = [(11, "row = [1, \"y/s\"]"), (13, "row = [\"t/t\", 0.5]")];
    let joints = &shown(&with(FORMULAS, &rows))["mechanism"]["formulas"]["joints"];
    assert_eq!(*joints, json!([{ "row": ["1", "y/s"] }, { "row": ["t/t", "0.5"] }]));
}

#[test]
fn every_spelling_has_one_text() {
    for (written, expected) in [
        ("x - s", "x-s"),
        ("(x) - ((s))", "x-s"),
        ("x-(s-1)", "x-(s-1)"),
        ("x-s*(1)", "x-s*1"),
        ("  2.50 * x - s\t", "2.5*x-s"),
        ("1e3*x-s", "1000*x-s"),
        ("1.5e-3 * x - s", "0.0015*x-s"),
        ("-x^2-s", "-x^2-s"),
        ("(-x)^2-s", "(-x)^2-s"),
        ("x^1-s", "x-s"),
        ("x ^ 64 - s", "x^64-s"),
        ("--x-s", "--x-s"),
        ("x*-s", "x*-s"),
        ("sqrt ( (x) ) - s", "sqrt(x)-s"),
        ("x/2/(3*s)", "x/2/(3*s)"),
        ("x + sqrt(0) - s", "x+sqrt(0)-s"),
        ("007*x-s", "7*x-s"),
        ("x/(l-100)-s", "x/(l-100)-s"),
    ] {
        let text = with(FORMULAS, &[(11, &format!("rho = \"{written}\""))]);
        let claim = kernel(&text);
        let orthocert_kernel::claim::Mechanism::Formulas(formulas) = claim.mechanism else {
            panic!("{text}");
        };
        let orthocert_kernel::claim::JointFormula::Rho(rho) = &formulas.joints[0] else {
            panic!("{text}");
        };
        assert_eq!(rho.to_string(), expected, "{written}");
        // The kernel reads the text that it is written in, as the same expression.
        assert_eq!(Expression::try_from(expected.to_owned()).as_ref(), Ok(rho), "{written}");
    }
}

#[test]
fn numbers_in_formulas_are_those_of_designs() {
    for text in ["0.1", "310.250", "1e-3", "1/3-1/7", "2*sqrt(3)", "-(4-9)/0.5", "1.20e2"] {
        let formula = with(FORMULAS, &[(11, &format!("rho = \"x - s + ({text})\""))]);
        let claim = serde_json::to_string(&kernel(&formula)).unwrap();
        let number = exactly::written(&number(text)).unwrap();
        let plain = with(FORMULAS, &[(6, &format!("d = \"{text}\""))]);
        assert!(serde_json::to_string(&kernel(&plain)).unwrap().contains(&format!("\"{number}\"")));
        let formula = claim.split("x-s+").nth(1).unwrap().split('"').next().unwrap();
        let formula = formula.strip_prefix('(').map_or(formula, |f| f.trim_end_matches(')'));
        // Written differently, perhaps, and the same number.
        assert_eq!(Exact::parse(formula, 1000).unwrap(), self::number(text), "{text}");
    }
}

#[test]
fn the_caret_is_under_what_is_wrong_in_a_formula() {
    for (line, column, width) in [
        ("rho = \"x - r\"", 12, 1),
        ("rho = \"x - s + sin(y)\"", 16, 3),
        ("rho = \"x - s / (2 - 2)\"", 16, 7),
        ("rho = \"x - s + sqrt(1 - 2)\"", 20, 7),
        ("rho = \"x - s )\"", 14, 1),
        ("rho = \"x - \"", 12, 1),
        ("rho = \"x ± s\"", 10, 1),
        ("rho = \"x - 2s\"", 13, 1),
        ("rho = \"x - s^-1\"", 14, 1),
        ("rho = \"x - s^0.5\"", 14, 3),
    ] {
        let error = refuse(&with(FORMULAS, &[(11, line)]));
        let message = error.to_string();
        let caret = message.lines().last().unwrap();
        assert_eq!((error.position().line, error.position().column), (11, column), "{message}");
        assert_eq!(caret.matches('^').count(), width, "{message}");
    }
}

#[test]
#[rustfmt::skip]
fn formulas_that_are_not_well_written() {
    check(&[
        row!("unknown name", FORMULAS, [(8, "span = \"sqrt(l^2 - y^2)\""), (11, "rho = \"x - spam\"")], 11,
            "mechanism.joints.0.rho", UnknownWord, "the unknown name spam",
            "x, y, l, d, span, t; did you mean span?"),
        row!("name given further down", FORMULAS, [(8, "s = \"sqrt(t^2 - y^2)\"")], 8,
            "mechanism.definitions.s", UnknownWord, "t, which is given further down", "x, y, l, d"),
        row!("itself", FORMULAS, [(8, "s = \"s\"")], 8, "mechanism.definitions.s", UnknownWord,
            "s, which is given further down", "x, y, l, d"),
        row!("function", FORMULAS, [(11, "rho = \"x - cos(s)\"")], 11, "mechanism.joints.0.rho",
            NotANumber, "the function cos", "sqrt, +"),
        row!("division by zero", FORMULAS, [(11, "rho = \"x/(d*d - 30000) - s\"")], 11,
            "mechanism.joints.0.rho", NotANumber, "a divisor that is or may be zero", "other than zero"),
        row!("division by what a tolerance makes zero", FORMULAS, [(11, "rho = \"x/(l - 200) - s\"")],
            11, "mechanism.joints.0.rho", NotANumber, "may be zero", "other than zero"),
        row!("root of a negative number", FORMULAS, [(11, "rho = \"x - s*sqrt(1-2)\"")], 11,
            "mechanism.joints.0.rho", NotANumber, "may be negative", "not negative"),
        row!("root of what a tolerance makes negative", FORMULAS, [(11, "rho = \"x - s*sqrt(l - 200)\"")],
            11, "mechanism.joints.0.rho", NotANumber, "may be negative", "not negative"),
        row!("division by a definition that is zero", FORMULAS, [(9, "t = \"d - d\""), (13, "rho = \"x/t\"")],
            13, "mechanism.joints.1.rho", NotANumber, "t, a divisor that is or may be zero", "other than zero"),
        row!("a tolerance", FORMULAS, [(11, "rho = \"x - s ± 1\"")], 11, "mechanism.joints.0.rho",
            Tolerance, "a tolerance in a formula", "the name of a parameter"),
        row!("a comma", FORMULAS, [(11, "rho = \"x - 0,5*s\"")], 11, "mechanism.joints.0.rho",
            NotANumber, ", in a formula", "an operator"),
        row!("a point alone", FORMULAS, [(11, "rho = \"x - 5.*s\"")], 11, "mechanism.joints.0.rho",
            NotANumber, "* in a formula", "digits after the point"),
        row!("exponent zero", FORMULAS, [(11, "rho = \"x - s^0\"")], 11, "mechanism.joints.0.rho",
            NotANumber, "0 in a formula", "from 1 to 64"),
        row!("exponent too great", FORMULAS, [(11, "rho = \"x - s^65\"")], 11,
            "mechanism.joints.0.rho", NotANumber, "65 in a formula", "from 1 to 64"),
        row!("power of a power", FORMULAS, [(11, "rho = \"x - s^2^2\"")], 11,
            "mechanism.joints.0.rho", NotANumber, "^ in a formula", "an operator"),
        row!("parenthesis not closed", FORMULAS, [(11, "rho = \"(x - s\"")], 11,
            "mechanism.joints.0.rho", NotANumber, "the end of the formula", "an operator, or )"),
        row!("nothing", FORMULAS, [(11, "rho = \"\"")], 11, "mechanism.joints.0.rho", NotANumber,
            "the end of the formula", "a number, a name"),
        row!("exponent of ten too great", FORMULAS, [(11, "rho = \"x - 1e1001*s\"")], 11,
            "mechanism.joints.0.rho", NotANumber, "a number too long", "within ±1,000"),
        row!("powers too great", FORMULAS, [(11, "rho = \"x - (1e300^64)^64*s\"")], 11,
            "mechanism.joints.0.rho", NotANumber, "too large", "moderate"),
        row!("a boolean", FORMULAS, [(11, "rho = true")], 11, "mechanism.joints.0.rho", WrongType,
            "the boolean true", "a formula in quotes"),
    ]);
}

#[test]
#[rustfmt::skip]
fn mechanisms_that_are_not_well_described() {
    check(&[
        row!("no coordinates", FORMULAS, [(3, "")], 1, "mechanism.coordinates", MissingKey,
            "nothing: the key is missing", "one to six names"),
        row!("seven coordinates", FORMULAS, [(3, "coordinates = [\"a\", \"b\", \"c\", \"d\", \"e\", \"f\", \"g\"]")],
            3, "mechanism.coordinates", WrongType, "an array of 7 elements", "one to six names"),
        row!("coordinate twice", FORMULAS, [(3, "coordinates = [\"x\", \"x\"]")], 3,
            "mechanism.coordinates.1", Conflict, "the name x once more", "that differ"),
        row!("coordinate called sqrt", FORMULAS, [(3, "coordinates = [\"x\", \"sqrt\"]")], 3,
            "mechanism.coordinates.1", UnknownWord, "the name sqrt", "the square root"),
        row!("coordinate that is no name", FORMULAS, [(3, "coordinates = [\"x\", \"2y\"]")], 3,
            "mechanism.coordinates.1", UnknownWord, "the name 2y", "a letter first"),
        row!("parameter with a coordinate's name", FORMULAS, [(5, "x = 2")], 5,
            "mechanism.parameters.x", Conflict, "the name x once more", "that differ"),
        row!("definition with a parameter's name", FORMULAS, [(8, "l = \"y\"")], 8,
            "mechanism.definitions.l", Conflict, "the name l once more", "that differ"),
        row!("parameter that is no name", FORMULAS, [(5, "\"l 1\" = 2")], 5,
            "mechanism.parameters.\"l 1\"", UnknownWord, "the name l 1", "letters, digits and _"),
        row!("unused parameter", FORMULAS, [(9, "t = \"sqrt(l^2 - y^2)\"")], 6,
            "mechanism.parameters.d", Conflict, "which no joint depends on", "names that formulas use"),
        row!("unused definition", FORMULAS, [(13, "rho = \"x + y\"")], 9,
            "mechanism.definitions.t", Conflict, "which no joint depends on", "names that formulas use"),
        row!("parameter that is a formula of another", FORMULAS, [(6, "d = \"2*l\"")], 6,
            "mechanism.parameters.d", NotANumber, "\"2*l\"", "a number"),
        row!("one joint", FORMULAS, [(12, ""), (13, ""), (9, ""), (6, "")], 10, "mechanism.joints", WrongType,
            "1 joints of 2 coordinates", "as many as coordinates"),
        row!("no joints", FORMULAS, [(10, ""), (11, ""), (12, ""), (13, "")], 1, "mechanism.joints",
            MissingKey, "nothing: the key is missing", "with rho or row"),
        row!("rho and row", FORMULAS, [(11, "rho = \"x - s\"\nrow = [1, 0]")], 12,
            "mechanism.joints.0.row", Conflict, "a row, next to rho", "or row"),
        row!("neither", FORMULAS, [(11, "")], 10, "mechanism.joints.0.rho", MissingKey,
            "nothing: the key is missing", "rho ="),
        row!("row of three", FORMULAS, [(11, "row = [1, 0, 0]")], 11, "mechanism.joints.0.row",
            WrongType, "an array of 3 elements", "2 formulas, one a coordinate"),
        row!("misspelt key", FORMULAS, [(11, "roh = \"x\"")], 11, "mechanism.joints.0.roh",
            UnknownKey, "an unknown key", "did you mean rho?"),
        row!("legs", FORMULAS, [(4, "[[mechanism.legs]]\n[mechanism.parameters]")], 4, "mechanism.legs",
            UnknownKey, "an unknown key", "legs goes with kind = \"translational\", \"planar\", \"spatial\", \"spherical\""),
        row!("parameters of an Orthoglide", BOX, [(6, "parameters = { l = 2 }")], 6,
            "mechanism.parameters", UnknownKey, "an unknown key", "parameters goes with kind = \"formulas\""),
        row!("corner of three", FORMULAS, [(15, "min = [0, 0, 0]")], 15, "workspace.min", WrongType,
            "an array of 3 elements", "[x, y]: exact numbers, one a coordinate"),
        row!("cylinder", FORMULAS, [(15, "cylinder = { center = [0, 0], radius = 1, z = [0, 1] }"), (16, "")],
            15, "workspace.cylinder", Conflict, "a cylinder", "min and max = [x, y]"),
        row!("cube", FORMULAS, [(15, "cube = 200"), (16, "")], 15, "workspace.cube", Conflict,
            "a cube, next to another machine", "\"orthoglide\" only"),
        row!("range of a joint given by its row", FORMULAS, [(11, "row = [1, \"s\"]"), (18, "joint_range = { min = 0 }")],
            18, "requirements.joint_range", Conflict, "a joint without rho", "every joint has a rho"),
        row!("margins of joints without legs", FORMULAS, [(18, "serial_margin = { min = 0.1 }")], 18,
            "requirements.serial_margin", Conflict, "legs without a length", "sliders and arms"),
        row!("volume of joints without legs", FORMULAS, [(18, "parallel_margin = { min = 0.1 }")], 18,
            "requirements.parallel_margin", Conflict, "joints without legs", "with legs"),
    ]);
}

#[test]
fn deep_and_long_formulas_are_refused() {
    let formula = |text: &str| with(FORMULAS, &[(11, &format!("rho = \"{text}\""))]);
    let deep = |n: usize| format!("x - s + {}1{}", "(".repeat(n), ")".repeat(n));
    kernel(&formula(&deep(64)));
    for (text, found) in [
        (deep(65), "a formula too deep"),
        (format!("x - s + {}1", "-".repeat(4000)), "a formula too deep"),
        (format!("x - s{}", "+y".repeat(512)), "a formula too long"),
        (format!("x - s + {}", "0".repeat(8192)), "a formula too long"),
        (format!("x - s + {}", "7".repeat(1001)), "a number too long"),
    ] {
        let error = refuse(&formula(&text));
        assert_eq!((error.defect(), error.position().line), (NotANumber, 11), "{error}");
        assert!(error.found().contains(found), "{error}");
        check_message(&error, &formula(&text));
    }
    kernel(&formula(&format!("x - s{}", "+y".repeat(511))));
}

#[test]
fn no_formula_makes_the_reader_panic() {
    let replacements = ["", "\"", "[", "(", ")", "^", "e", ".", "\n", "-", "9", "±", "\u{0}", "ö"];
    for (at, c) in FORMULAS.char_indices() {
        for new in replacements {
            let text = format!("{}{new}{}", &FORMULAS[..at], &FORMULAS[at + c.len_utf8()..]);
            if let Err(error) = Design::parse(&text, "test.toml") {
                check_message(&error, &text);
            }
        }
    }
}
