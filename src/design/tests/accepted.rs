//! Designs that are accepted, and the exact claims that they are read into.

use super::*;
use crate::design::leg::WorkingMode;
use crate::design::{template, TEMPLATES};

/// A leg on a guide.
struct Slider {
    direction: [Quantity; 3],
    anchor: [Quantity; 3],
    platform: [Quantity; 3],
    length: Quantity,
    mode: WorkingMode,
}

fn slider(claim: &Said, leg: usize) -> Slider {
    match legs(claim)[leg].clone() {
        Leg::Slider { direction, anchor, platform, length, mode } => {
            Slider { direction, anchor, platform, length, mode }
        }
        other => panic!("{other:?}"),
    }
}

pub(super) fn length(written: &str) -> Quantity {
    let claim = read(&with(BOX, &[(4, &format!("leg_length = {written}"))]));
    slider(&claim, 0).length
}

#[test]
fn numbers_mean_what_is_written() {
    for (written, value) in [
        ("310.25", "1241/4"),
        ("0.1", "1/10"),
        ("1e-3", "1/1000"),
        ("1E+3", "1000"),
        ("+310.25", "1241/4"),
        ("6.5e2", "650"),
        ("1_000.000_5", "2000001/2000"),
        ("1_0e1_0", "100000000000"),
        ("1_000", "1000"),
        ("+310", "310"),
        ("0x1F4", "500"),
        ("0o764", "500"),
        ("0b1_1111_0100", "500"),
        ("0xffff_ffff_ffff_ffff_ffff", "1208925819614629174706175"),
        ("123456789012345678901234567890", "123456789012345678901234567890"),
        ("0.30000000000000000000000000000001", "0.30000000000000000000000000000001"),
        ("\"310.25\"", "1241/4"),
        ("'1/3'", "1/3"),
        ("\"174.75*sqrt(3)/2\"", "174.75*sqrt(3)/2"),
        ("\"  sqrt( 9/16 ) \"", "3/4"),
        ("\"\\u0031\"", "1"),
        ("\"\"\"\n1/3\"\"\"", "1/3"),
        ("1e1000", "1e1000"),
        ("1e-1000", "1e-1000"),
    ] {
        assert_eq!(length(written), exactly(value), "{written}");
    }
}

#[test]
fn a_thousand_digits_are_kept() {
    let digits = "7".repeat(1000);
    assert_eq!(length(&digits), exactly(&digits));
    assert_eq!(length(&format!("{digits}e-1000")), exactly(&format!("{digits}e-1000")));
    assert_eq!(length(&format!("\"{digits}\"")), exactly(&digits));
}

#[test]
fn tolerances_have_three_spellings() {
    let expected = between("310.23", "310.27");
    for written in [
        "\"310.25 ± 0.02\"",
        "\"310.25±0.02\"",
        "\"310.25 +/- 0.02\"",
        "\"310.25+/-0.02\"",
        "\"1241/4 ± (1/50)\"",
        "{ min = 310.23, max = \"310.27\" }",
    ] {
        assert_eq!(length(written), expected, "{written}");
    }
    assert_eq!(length("\"3 ± sqrt(2)\""), between("3-sqrt(2)", "3+sqrt(2)"));
    assert_eq!(length("\"sqrt(2) ± 0\""), exactly("sqrt(2)"));
    assert_eq!(length("{ min = 310, max = 310.0 }"), exactly("310"));
}

#[test]
fn an_orthoglide_on_a_box_has_three_sliders_along_the_axes() {
    let claim = read(BOX);
    for axis in 0..3 {
        let Slider { direction, anchor, platform, length, mode } = slider(&claim, axis);
        for k in 0..3 {
            let on = |value: &str| if k == axis { exactly(value) } else { exactly("0") };
            assert_eq!(direction[k], on("1"));
            assert_eq!(anchor[k], on("-383.8"));
            assert_eq!(platform[k], on("-3"));
        }
        assert_eq!(length, between("310.23", "310.27"));
        assert_eq!(mode, WorkingMode::Plus);
    }
    let corner = |x: &str| vec![number(x); 3];
    assert_eq!(claim.workspace, Workspace::Box { min: corner("-73"), max: corner("126") });
    assert_eq!(claim.of("transmission"), ["min 1/2", "max 2"]);
    assert_eq!(claim.of("joint_range"), ["min 0", "max 257"]);
}

#[test]
fn base_and_offset_may_carry_tolerances() {
    let changes = [(5, "base = \"-383.8 ± 0.1\""), (6, "offset = { min = 1, max = 2 }")];
    let claim = read(&with(BOX, &changes));
    let Slider { anchor, platform, .. } = slider(&claim, 0);
    assert_eq!(anchor[0], between("-383.9", "-383.7"));
    assert_eq!(platform[0], between("-2", "-1"));
}

#[test]
fn base_and_offset_are_optional_without_a_joint_range() {
    let claim = read(&with(BOX, &[(5, ""), (6, ""), (12, "")]));
    for leg in 0..3 {
        let Slider { anchor, platform, .. } = slider(&claim, leg);
        assert!(anchor.iter().chain(&platform).all(|x| *x == exactly("0")));
    }
    assert!(claim.of("joint_range").is_empty());
}

#[test]
fn a_single_bound_or_requirement_is_enough() {
    let only = |line: &str| read(&with(BOX, &[(11, line), (12, "")])).demands;
    assert_eq!(only("transmission.max = 2"), ["transmission max 2"]);
    assert_eq!(only("transmission = { min = 0.5 }"), ["transmission min 1/2"]);
    assert_eq!(only("joint_range = { max = 257 }"), ["joint_range max 257"]);
}

#[test]
fn joint_ranges_may_differ_by_leg() {
    let ranges = "joint_range = [{ min = 1 }, { max = 2 }, { min = 3, max = 3 }]";
    let said = read(&with(BOX, &[(12, ranges)]));
    assert_eq!(said.of("joint_range"), ["[1] min 1", "[2] max 2", "[3] min 3", "[3] max 3"]);
    let said = read(&with(BOX, &[(12, "joint_range = [{}, { max = 2 }, {}]")]));
    assert_eq!(said.of("joint_range"), ["[2] max 2"]);
}

#[test]
fn a_cube_makes_the_orthoglide_of_the_paper() {
    assert_eq!(kinds::kernel(CUBE), Design::prototype().claim);
    let claim = read(&with(CUBE, &[(4, "offset = \"sqrt(2)\""), (6, "cube = \"100*sqrt(3)\"")]));
    assert_eq!(claim.offset, Some(number("sqrt(2)")));
    assert_eq!(claim.workspace, Workspace::Cube { side: number("100*sqrt(3)") });
}

#[test]
fn legs_are_read_one_by_one() {
    let claim = read(LEGS);
    let Slider { anchor, platform, length, mode, .. } = slider(&claim, 0);
    assert_eq!(anchor, [exactly("0"), exactly("174.75"), exactly("0")]);
    assert!(platform.iter().all(|x| *x == exactly("0")));
    assert_eq!(length, between("332.95", "333.05"));
    assert_eq!(mode, WorkingMode::Minus);
    let Slider { anchor, mode, .. } = slider(&claim, 1);
    assert_eq!(anchor[0], exactly("-174.75*sqrt(3)/2"));
    assert_eq!(mode, WorkingMode::Minus);
    assert_eq!(slider(&claim, 2).mode, WorkingMode::Plus);
}

#[test]
fn any_layout_of_toml_is_the_same_design() {
    let inline = r#"
        mechanism = { kind = "orthoglide", offset = 0 }
        workspace.cube = 2e2
        requirements."transmission" = {
            max = 2, # a table over several lines
        }
    "#;
    let claim = |text: &str| Design::parse(text, "test.toml").unwrap().claim;
    assert_eq!(claim(inline), claim(CUBE));
    assert_eq!(claim(&CUBE.replace('\n', "\r\n")), claim(CUBE));
    assert_eq!(claim(&format!("\u{feff}{CUBE}")), claim(CUBE));
}

#[test]
fn every_key_has_its_place() {
    let design = Design::parse(LEGS, "legs.toml").unwrap();
    for (key, line, column) in [
        ("mechanism.kind", 2, 1),
        ("mechanism.legs.0", 3, 1),
        ("mechanism.legs.1.anchor", 13, 1),
        ("mechanism.legs.1.anchor.1", 13, 32),
        ("workspace.max.2", 24, 16),
        ("requirements.transmission", 26, 1),
        ("requirements.transmission.max", 26, 18),
    ] {
        let at = design.sources.position(key).unwrap_or_else(|| panic!("{key}"));
        assert_eq!((at.line, at.column), (line, column), "{key}");
    }
    assert_eq!(design.sources.position("requirements.joint_range"), None);
}

#[test]
fn templates_are_designs() {
    for (kind, text) in TEMPLATES {
        assert_eq!(template(kind), Some(*text));
        assert!(!kinds::kernel(text).require.is_empty(), "{kind}");
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{kind}");
    }
    assert_eq!(kinds::kernel(template("orthoglide-cube").unwrap()), Design::prototype().claim);
    assert_eq!(template("hexapod"), template("spatial"));
    assert_eq!(template("octopod"), None);
}
