//! Every class of bad number: not finite, too long, no expression, tolerances, signs, lengths.

use super::refused::row;
use super::*;
use Defect::{NotANumber, OutOfDomain, Tolerance};

#[test]
#[rustfmt::skip]
fn what_is_not_a_number() {
    check(&[
        row!("word", BOX, [(4, "leg_length = \"abc\"")], 4, "mechanism.leg_length", NotANumber,
            "\"abc\" (expected a number, \"-\", \"(\" or \"sqrt\" at character 1)",
            "\"310.25 ± 0.02\""),
        row!("empty string", BOX, [(4, "leg_length = \"\"")], 4, "mechanism.leg_length",
            NotANumber, "at character 1", "a number or a tolerance"),
        row!("unit in a string", BOX, [(4, "leg_length = \"310 mm\"")], 4, "mechanism.leg_length",
            NotANumber, "unexpected text at character 5", "a number or a tolerance"),
        row!("decimal comma in a string", BOX, [(4, "leg_length = \"310,25\"")], 4,
            "mechanism.leg_length", NotANumber, "unexpected text at character 4", "a number"),
        row!("underscore in a string", CUBE, [(6, "cube = \"1_000\"")], 6, "workspace.cube",
            NotANumber, "unexpected text at character 2", "a number"),
        row!("Unicode minus sign", BOX, [(5, "base = \"\u{2212}383\"")], 5, "mechanism.base",
            NotANumber, "at character 1", "a number"),
        row!("infinity", BOX, [(4, "leg_length = inf")], 4, "mechanism.leg_length", NotANumber,
            "inf", "a finite number"),
        row!("minus infinity", BOX, [(8, "min = [0, -inf, 0]")], 8, "workspace.min.1", NotANumber,
            "-inf", "a finite number"),
        row!("not a number", CUBE, [(8, "transmission = { max = +nan }")], 8,
            "requirements.transmission.max", NotANumber, "+nan", "a finite number"),
        row!("infinity in a string", CUBE, [(8, "transmission = { max = \"inf\" }")], 8,
            "requirements.transmission.max", NotANumber, "\"inf\"", "a number"),
        row!("exponent too large", BOX, [(4, "leg_length = 1e1001")], 4, "mechanism.leg_length",
            NotANumber, "1e1001 (exponent beyond ±1000", "exponents within ±1,000"),
        row!("exponent too small", BOX, [(4, "leg_length = 1e-1001")], 4, "mechanism.leg_length",
            NotANumber, "1e-1001 (exponent beyond ±1000", "exponents within ±1,000"),
        row!("exponent past all integers", CUBE, [(6, "cube = \"1e99999999999999999999\"")], 6,
            "workspace.cube", NotANumber, "exponent beyond ±1000", "exponents within ±1,000"),
        row!("value too long", CUBE, [(6, "cube = \"1e1000*1e1000*1e1000\"")], 6, "workspace.cube",
            NotANumber, "number too large", "at most 1,000 digits"),
        row!("value far too long", CUBE,
            [(6, "cube = \"1e1000*1e1000*1e1000*1e1000*1e1000*1e1000*1e1000*1e1000*1e1000*1e1000\"")],
            6, "workspace.cube", NotANumber, "number too large", "at most 1,000 digits"),
        row!("division by zero", BOX, [(4, "leg_length = \"1/(2-2)\"")], 4, "mechanism.leg_length",
            NotANumber, "division by something that is or may be zero", "a number"),
        row!("root of a negative number", BOX, [(4, "leg_length = \"sqrt(1-2)\"")], 4,
            "mechanism.leg_length", NotANumber, "square root of something", "a number"),
        row!("parenthesis not closed", LEGS, [(13, "anchor = [0, \"(1+2\", 0]")], 13,
            "mechanism.legs.1.anchor.1", NotANumber, "\")\" at character 5", "a number"),
    ]);
}

#[test]
#[rustfmt::skip]
fn numbers_outside_of_their_domain() {
    check(&[
        row!("zero leg length", BOX, [(4, "leg_length = 0")], 4, "mechanism.leg_length",
            OutOfDomain, "0", "a length greater than 0"),
        row!("negative leg length", BOX, [(4, "leg_length = -310.25")], 4, "mechanism.leg_length",
            OutOfDomain, "-310.25", "a length greater than 0"),
        row!("tolerance reaches zero", BOX, [(4, "leg_length = \"1 ± 1\"")], 4,
            "mechanism.leg_length", OutOfDomain, "\"1 ± 1\"", "a length greater than 0"),
        row!("tolerance table reaches zero", BOX, [(4, "leg_length = { min = -1, max = 1 }")], 4,
            "mechanism.leg_length", OutOfDomain, "a table", "a length greater than 0"),
        row!("length not provably positive", BOX,
            [(4, "leg_length = \"sqrt(2)*sqrt(3)-sqrt(6)\"")], 4, "mechanism.leg_length",
            OutOfDomain, "not provably positive", "a length greater than 0"),
        row!("zero length of a leg", LEGS, [(14, "length = 0.0")], 14, "mechanism.legs.1.length",
            OutOfDomain, "0.0", "a length greater than 0"),
        row!("zero side", CUBE, [(6, "cube = 0")], 6, "workspace.cube", OutOfDomain,
            "0", "a length greater than 0"),
        row!("negative side", CUBE, [(6, "cube = \"-200\"")], 6, "workspace.cube", OutOfDomain,
            "\"-200\"", "a length greater than 0"),
        row!("zero psi_min", BOX, [(11, "transmission = { min = 0, max = 2 }")], 11,
            "requirements.transmission.min", OutOfDomain, "0", "greater than 0"),
        row!("negative psi_min", BOX, [(11, "transmission = { min = -0.5, max = 2 }")], 11,
            "requirements.transmission.min", OutOfDomain, "-0.5", "greater than 0"),
        row!("negative psi_max", BOX, [(11, "transmission = { max = -2 }")], 11,
            "requirements.transmission.max", OutOfDomain, "-2", "greater than 0"),
        row!("zero direction", LEGS, [(5, "direction = [0, 0.0, \"1-1\"]")], 5,
            "mechanism.legs.0.direction", OutOfDomain, "is, or may be, zero", "not zero"),
        row!("direction that may be zero", LEGS, [(5, "direction = [0, \"0 ± 1\", 0]")], 5,
            "mechanism.legs.0.direction", OutOfDomain, "is, or may be, zero", "not zero"),
    ]);
}

#[test]
#[rustfmt::skip]
fn tolerances_where_there_can_be_none() {
    check(&[
        row!("on the side", CUBE, [(6, "cube = \"200 ± 1\"")], 6, "workspace.cube", Tolerance,
            "the tolerance \"200 ± 1\"", "workspace and requirements not"),
        row!("on a corner", BOX, [(9, "max = [1, \"2 +/- 1\", 3]")], 9, "workspace.max.1",
            Tolerance, "the tolerance \"2 +/- 1\"", "workspace and requirements not"),
        row!("as a table on a corner", BOX, [(9, "max = [1, 2, { min = 1, max = 2 }]")], 9,
            "workspace.max.2", Tolerance, "a tolerance { min, max }", "one exact number"),
        row!("on a bound", BOX, [(11, "transmission = { max = \"2 ± 0.1\" }")], 11,
            "requirements.transmission.max", Tolerance, "2 ± 0.1", "workspace and requirements not"),
        row!("on a joint range", BOX, [(12, "joint_range = { max = \"257 ± 1\" }")], 12,
            "requirements.joint_range.max", Tolerance, "257 ± 1", "one exact number"),
        row!("inside a tolerance", BOX, [(4, "leg_length = { min = \"1 ± 1\", max = 3 }")], 4,
            "mechanism.leg_length.min", Tolerance, "1 ± 1", "one exact number"),
        row!("negative", BOX, [(4, "leg_length = \"310 ± -0.02\"")], 4, "mechanism.leg_length",
            Tolerance, "310 ± -0.02", "not negative"),
        row!("twice", BOX, [(4, "leg_length = \"310 ± 1 ± 1\"")], 4, "mechanism.leg_length",
            NotANumber, "at character 9", "a number or a tolerance"),
        row!("without a nominal value", BOX, [(4, "leg_length = \"± 1\"")], 4,
            "mechanism.leg_length", NotANumber, "at character 1", "a number or a tolerance"),
        row!("without a value", BOX, [(4, "leg_length = \"310 ±\"")], 4, "mechanism.leg_length",
            NotANumber, "at character 6", "a number or a tolerance"),
        row!("percent", BOX, [(4, "leg_length = \"310 ± 1%\"")], 4, "mechanism.leg_length",
            NotANumber, "unexpected text at character 8", "the unit of their number: \"333 ± 0.1\""),
        row!("comma", BOX, [(4, "leg_length = \"310,5\"")], 4, "mechanism.leg_length",
            NotANumber, "unexpected text at character 4", "a point begins the decimals"),
        row!("power", BOX, [(4, "leg_length = \"18**2\"")], 4, "mechanism.leg_length",
            NotANumber, "at character 4", "a power is a product: \"18*18\""),
        row!("cosine", BOX, [(4, "leg_length = \"310*cos(30)\"")], 4, "mechanism.leg_length",
            NotANumber, "at character 5", "there is sqrt alone"),
    ]);
}

#[test]
fn literals_of_more_than_a_thousand_digits_are_refused() {
    let digits = "7".repeat(1001);
    for written in [
        digits.clone(),
        format!("-{digits}"),
        format!("\"{digits}\""),
        format!("{digits}.5"),
        format!("0.{digits}"),
        format!("0x{digits}"),
        format!("\"1 ± {digits}\""),
        "8".repeat(10_000),
    ] {
        let text = with(BOX, &[(4, &format!("leg_length = {written}"))]);
        let error = refuse(&text);
        assert_eq!((error.defect(), error.position().line), (NotANumber, 4), "{error}");
        assert_eq!(error.accepted(), "a number of at most 1,000 digits, exponents within ±1,000");
        assert!(error.to_string().len() < 1000, "{error}");
        check_message(&error, &text);
    }
}

#[test]
fn the_caret_is_under_the_defect() {
    for (line, column) in [
        ("leg_length = \"abc\"", 15),
        ("leg_length = \"310 mm\"", 19),
        ("leg_length = \"310.25 ± 0.02 ± 1\"", 29),
        ("leg_length =  1e1001", 17),
        ("leg_length = +1e1001", 17),
        ("leg_length = 1_0e1001", 14),
        ("leg_length = \"\\u0031x\"", 14),
        ("  leg_length = 0", 16),
        ("ö = 1", 1),
    ] {
        let error = refuse(&with(BOX, &[(4, line)]));
        let at = error.position();
        assert_eq!((at.line, at.column), (4, column), "{error}");
        let message = error.to_string();
        let caret = message.lines().last().unwrap();
        assert_eq!(caret.find('^'), Some("  4 | ".len() + column - 1), "{error}");
    }
}

#[test]
fn a_message_reads_like_this() {
    let error = refuse(&with(BOX, &[(4, "leg_length = \"310.25 mm\"  # L")]));
    assert_eq!(
        error.to_string(),
        "test.toml:4:22: mechanism.leg_length: found \"310.25 mm\" (unexpected text at character 8); \
         accepted: a number or a tolerance: 310.25, \"1/3\", \"310.25 ± 0.02\", \
         { min = 310.2, max = 310.3 }; numbers carry no unit: \"310.25\", and unit = \"mm\" above the \
         tables to name the unit of all lengths\n  \
         4 | leg_length = \"310.25 mm\"  # L\n    \
           |                      ^"
    );
}
