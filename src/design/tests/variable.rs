//! Numbers of a design by their keys: found, replaced, refused.

use super::{BOX, CUBE, LEGS};
use crate::design::{Defect, Design, DesignError, Variable};
use crate::exact::Exact;
use num_rational::BigRational;

fn variable<'a>(text: &'a str, key: &str) -> Variable<'a> {
    Variable::find(text, "design", key).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str, key: &str) -> DesignError {
    Variable::find(text, "design", key).map(|v| v.own().clone()).unwrap_err()
}

fn number(text: &str) -> BigRational {
    Exact::parse(text, 100).unwrap().as_rational().unwrap().clone()
}

/// Demands that replacing the number at `key` by `value` is editing `old` into `new` by hand.
fn same(text: &str, key: &str, value: &str, (old, new): (&str, &str)) {
    assert!(text.contains(old), "{old}");
    assert_eq!(variable(text, key).with(&number(value)), text.replace(old, new), "{key}");
}

#[test]
fn a_number_is_replaced_and_nothing_else() {
    same(BOX, "mechanism.base", "-380", ("base = -383.8", "base = \"-380\""));
    same(BOX, "workspace.max.1", "126.5", ("[126, 126, 126]", "[126, \"126.5\", 126]"));
    let (old, new) = ("{ min = \"1/2\", max = 2 }", "{ min = \"1/2\", max = \"2.01\" }");
    same(BOX, "requirements.transmission.max", "2.01", (old, new));
    same(
        BOX,
        "requirements.joint_range.min",
        "1e-3",
        ("min = 0, max = 257", "min = \"0.001\", max = 257"),
    );
    same(CUBE, "workspace.cube", "201", ("cube = 200", "cube = \"201\""));
    let (old, new) = ("\"-174.75*sqrt(3)/2\"", "\"-150\"");
    same(LEGS, "mechanism.legs.1.anchor.0", "-150", (old, new));
}

#[test]
fn of_a_tolerance_the_middle_is_varied() {
    let found = variable(BOX, "mechanism.leg_length");
    assert_eq!(
        (found.own(), found.tolerance()),
        (&Exact::parse("310.25", 9).unwrap(), Some("0.02"))
    );
    same(BOX, "mechanism.leg_length", "311", ("310.25 ± 0.02", "311 ± 0.02"));
    for (written, middle, kept) in [
        ("\"310 +/- (1/30)\"", "310", "\"312 ± (1/30)\""),
        ("{ min = 310.2, max = \"310.3\" }", "310.25", "\"312 ± 0.05\""),
        ("{ max = 311, min = \"931/3\" }", "932/3", "\"312 ± (1/3)\""),
    ] {
        let text = BOX.replace("\"310.25 ± 0.02\"", written);
        let found = variable(&text, "mechanism.leg_length");
        assert_eq!(found.own().as_rational(), Some(&number(middle)), "{written}");
        let edited = found.with(&number("312"));
        assert!(edited.contains(kept), "{edited}");
        Design::parse(&edited, "edited").unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn the_own_number_gives_the_own_claim() {
    let keys = [
        "mechanism.leg_length",
        "mechanism.base",
        "workspace.min.2",
        "requirements.joint_range.max",
    ];
    let own = Design::parse(BOX, "design").unwrap();
    for key in keys {
        let found = variable(BOX, key);
        let text = found.with(found.own().as_rational().unwrap());
        assert_eq!(Design::parse(&text, "design").unwrap().claim, own.claim, "{key}");
    }
    let braces = BOX.replace("\"310.25 ± 0.02\"", "{ min = 310.2, max = 310.3 }");
    let found = variable(&braces, "mechanism.leg_length");
    let text = found.with(found.own().as_rational().unwrap());
    let claims = [&braces, &text].map(|text| Design::parse(text, "design").unwrap().claim);
    assert_eq!(claims[0], claims[1]);
}

#[test]
fn equal_numbers_are_replaced_together() {
    let equal = LEGS.replace("\"333.0 ± 0.05\"", "\"333.0\"");
    let edited = variable(&equal, "mechanism.legs.*.length").with(&number("334.5"));
    assert_eq!(edited.matches("length = \"334.5\"").count(), 3);
    assert_eq!(edited.matches("333").count(), 0);
    let error = refused(LEGS, "mechanism.legs.*.length");
    assert_eq!((error.defect(), error.key()), (Defect::Conflict, "mechanism.legs.1.length"));
    assert!(error.found().contains("333.0 ± 0.05"), "{error}");
    assert!(refused(LEGS, "mechanism.legs.*.anchor.1").found().contains("mechanism.legs.0"));
}

#[test]
fn sizes_are_those_of_numbers_nearby() {
    for (text, key, size) in [
        (BOX, "mechanism.base", "383.8"),
        (BOX, "workspace.min.0", "73"),
        (BOX, "requirements.joint_range.min", "257"),
        (LEGS, "mechanism.legs.0.anchor.0", "174.75"),
        (LEGS, "mechanism.legs.0.platform.0", "333"),
        (CUBE, "mechanism.offset", "1"),
    ] {
        assert_eq!(*variable(text, key).size(), number(size), "{key}");
    }
}

#[test]
fn keys_without_a_number_are_refused_with_what_there_is() {
    for (text, key, parts) in [
        (BOX, "leg_length", &["mechanism.leg_length?"][..]),
        (BOX, "mechanism.leg_lenght", &["mechanism.base", "did you mean mechanism.leg_length?"]),
        (BOX, "mechanism", &["a table", "mechanism.base"]),
        (BOX, "workspace.max", &["an array of 3 elements", "workspace.max.2"]),
        (BOX, "workspace.max.3", &["none at 3", "workspace.max.2"]),
        (BOX, "workspace.max.00", &["none at 00"]),
        (BOX, "workspace.max.-1", &["none at -1"]),
        (BOX, "workspace.*", &["workspace.min, workspace.max"]),
        (BOX, "workspace.max.0.x", &["126, which has no x"]),
        (BOX, "mechanism.kind", &["orthoglide", "a number"]),
        (BOX, "title", &["box", "a number"]),
        (BOX, "requirements.transmission", &["a table", "requirements.transmission.max"]),
        (BOX, "", &["nothing: the key is missing", "mechanism"]),
        (BOX, "mechanism.", &["nothing: the key is missing"]),
        (LEGS, "mechanism.legs[1].length", &["did you mean mechanism.legs.1.length?"]),
        (LEGS, "mechanism.legs.3.length", &["none at 3", "mechanism.legs.2"]),
        (
            LEGS,
            "mechanism.legs.*.platform.0",
            &["nothing: the key is missing", "mechanism.legs.1.anchor"],
        ),
        (LEGS, "mechanism.legs.0.mode", &["a number"]),
    ] {
        let message = refused(text, key).to_string();
        for part in parts {
            assert!(message.contains(part), "{key}: no {part:?} in\n{message}");
        }
    }
}

#[test]
fn a_number_that_all_legs_have_is_meant_before_one_leg_s() {
    let alike = LEGS.replace("\"333.0 ± 0.05\"", "333");
    for (text, key, meant) in [
        (alike.as_str(), "mechanism.legs.length", "mechanism.legs.*.length"),
        (&alike, "length", "mechanism.legs.*.length"),
        (&alike, "mechanism.leg_length", "mechanism.legs.*.length"),
        (&alike, "mechanism.legs[1].length", "mechanism.legs.1.length"),
        (&alike, "mechanism.legs.1.lenght", "mechanism.legs.1.length"),
        (LEGS, "mechanism.leg_length", "mechanism.legs.0.length"),
    ] {
        let message = refused(text, key).to_string();
        assert!(message.contains(&format!("did you mean {meant}?")), "{key}:\n{message}");
    }
}

#[test]
fn a_tolerance_over_several_lines_is_refused_as_a_whole() {
    let apart = BOX
        .replace("\"310.25 ± 0.02\"\n", "{}\n")
        .replace("leg_length = {}", "leg_length.min = 310\nleg_length.max = 311");
    let error = refused(&apart, "mechanism.leg_length");
    assert!(error.accepted().contains("{ min ="), "{error}");
    let end = variable(&apart, "mechanism.leg_length.max");
    assert!(end.with(&number("312")).contains("leg_length.max = \"312\""));
}

#[test]
fn every_number_is_listed_with_its_key_and_its_places() {
    let text = include_str!("../../../tests/designs/linear-delta-klipper-cylinder.toml");
    let all = Variable::all(text, "design").unwrap();
    let keys: Vec<&str> = all.iter().map(|(key, _)| key.as_str()).collect();
    // One length of three legs, and of each direction the three coordinates that all have.
    assert_eq!(keys.iter().filter(|key| key.ends_with("length")).count(), 1);
    assert_eq!(keys.iter().filter(|key| key.contains("direction")).count(), 3);
    assert_eq!(keys.iter().filter(|key| key.contains("anchor")).count(), 7);
    for (key, listed) in &all {
        let found = variable(text, key);
        assert_eq!((found.own(), found.size()), (listed.own(), listed.size()), "{key}");
        let value = number("1/8");
        assert_eq!(found.with(&value), listed.with(&value), "{key}");
    }
    let length = &all.iter().find(|(key, _)| key == "mechanism.legs.*.length").unwrap().1;
    assert_eq!(length.places().len(), 3);
    assert!(length.places().iter().all(|at| &text[at.clone()] == "333"));
    // Where one leg has another length, each has its own.
    let text = text.replacen("length = 333", "length = 334", 1);
    let all = Variable::all(&text, "design").unwrap();
    assert_eq!(all.iter().filter(|(key, _)| key.ends_with("length")).count(), 3);
}
