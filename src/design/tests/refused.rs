//! Every class of bad structure: keys, types, words, conflicts, syntax.

use super::*;
use Defect::{
    Conflict, MissingKey, NotANumber, OutOfDomain, Reversed, Syntax, Tolerance, UnknownKey,
    UnknownWord, WrongType,
};

/// `row!(name, design, [changes], line, key, defect, found, accepted)`.
macro_rules! row {
    ($name:literal, $design:ident, [$($change:expr),*], $line:literal, $key:literal, $defect:ident,
     $found:literal, $accepted:literal) => {
        Row {
            name: $name,
            design: $design,
            changes: &[$($change),*],
            line: $line,
            key: $key,
            defect: $defect,
            found: $found,
            accepted: $accepted,
        }
    };
}
pub(super) use row;

#[test]
#[rustfmt::skip]
fn keys_that_are_unknown_or_missing() {
    check(&[
        row!("misspelt table", CUBE, [(5, "[workspce]")], 5, "workspce", UnknownKey,
            "an unknown key", "title, unit, mechanism, workspace, requirements; did you mean workspace?"),
        row!("misspelt key", BOX, [(4, "leg_lenght = 310")], 4, "mechanism.leg_lenght", UnknownKey,
            "an unknown key", "kind, leg_length, base, offset, bodies; did you mean leg_length?"),
        row!("first of two unknown keys", BOX, [(4, "z = 1"), (5, "a = 1")], 4, "mechanism.z",
            UnknownKey, "an unknown key", "leg_length"),
        row!("key that needs quotes", BOX, [(4, "\"leg length\" = 310")], 4,
            "mechanism.\"leg length\"", UnknownKey, "an unknown key", "did you mean leg_length?"),
        row!("key of another table", BOX, [(12, "title = \"late\"")], 12, "requirements.title",
            UnknownKey, "an unknown key", "transmission, joint_range"),
        row!("unknown form of workspace", BOX, [(8, "sphere = 3"), (9, "")], 8, "workspace.sphere",
            UnknownKey, "an unknown key", "cube, min, max, cylinder"),
        row!("unknown bound", BOX, [(11, "transmission = { mim = 0.5 }")], 11,
            "requirements.transmission.mim", UnknownKey, "an unknown key", "did you mean min?"),
        row!("unknown key of a tolerance", BOX, [(4, "leg_length = { min = 1, most = 2 }")], 4,
            "mechanism.leg_length.most", UnknownKey, "an unknown key", "min, max"),
        row!("unknown key of a leg", LEGS, [(15, "mod = \"-\"")], 15, "mechanism.legs.1.mod",
            UnknownKey, "an unknown key", "did you mean mode?"),
        row!("legs of an Orthoglide", LEGS, [(2, "kind = \"orthoglide\"")], 3, "mechanism.legs",
            UnknownKey, "an unknown key", "kind, leg_length, base, offset"),
        row!("no mechanism", CUBE, [(2, ""), (3, ""), (4, "")], 8, "mechanism", MissingKey,
            "nothing: the key is missing", "a table [mechanism]"),
        row!("no workspace", CUBE, [(5, ""), (6, "")], 8, "workspace", MissingKey,
            "nothing: the key is missing", "a table [workspace]"),
        row!("no requirements", CUBE, [(7, ""), (8, "")], 6, "requirements", MissingKey,
            "nothing: the key is missing", "a table [requirements]"),
        row!("no kind", BOX, [(3, "")], 2, "mechanism.kind", MissingKey,
            "nothing: the key is missing", "\"orthoglide\", \"translational\""),
        row!("no leg length", BOX, [(4, "")], 2, "mechanism.leg_length", MissingKey,
            "nothing: the key is missing", "a length greater than 0"),
        row!("no form of workspace", CUBE, [(6, "")], 5, "workspace.min", MissingKey,
            "nothing: the key is missing", "or cube (the side)"),
        row!("no upper corner", BOX, [(9, "")], 7, "workspace.max", MissingKey,
            "nothing: the key is missing", "[x, y, z]: three exact numbers"),
        row!("no lower corner", BOX, [(8, "")], 7, "workspace.min", MissingKey,
            "nothing: the key is missing", "[x, y, z]: three exact numbers"),
        row!("no requirement", BOX, [(11, ""), (12, "")], 10, "requirements.transmission",
            MissingKey, "nothing: the key is missing", "at least one requirement: transmission, joint_range,"),
        row!("no bound of transmission", BOX, [(11, "transmission = {}")], 11,
            "requirements.transmission.max", MissingKey, "nothing: the key is missing", "min, max or both"),
        row!("no bound of any joint", BOX, [(12, "joint_range = [{}, {}, {}]")], 12,
            "requirements.joint_range.0.max", MissingKey, "nothing: the key is missing", "min, max or both"),
        row!("a plus and a minus", BOX, [(4, "leg_length = \"310.25 +- 0.02\"")], 4,
            "mechanism.leg_length", Tolerance, "+- 0.02", "\"310.25 ± 0.02\" for a tolerance"),
        row!("half a tolerance", BOX, [(4, "leg_length = { min = 310 }")], 4,
            "mechanism.leg_length.max", MissingKey, "nothing: the key is missing", "a number"),
        row!("no drive", LEGS, [(11, "")], 10, "mechanism.legs.1.drive", MissingKey,
            "nothing: the key is missing", "\"slider\""),
        row!("no direction", LEGS, [(5, "")], 3, "mechanism.legs.0.direction", MissingKey,
            "nothing: the key is missing", "the guide's direction"),
        row!("no anchor", LEGS, [(6, "")], 3, "mechanism.legs.0.anchor", MissingKey,
            "nothing: the key is missing", "where rho = 0"),
        row!("no length", LEGS, [(20, "")], 16, "mechanism.legs.2.length", MissingKey,
            "nothing: the key is missing", "a length greater than 0"),
        row!("no mode", LEGS, [(21, "")], 16, "mechanism.legs.2.mode", MissingKey,
            "nothing: the key is missing", "\"+\", \"-\""),
    ]);
}

#[test]
#[rustfmt::skip]
fn values_of_the_wrong_type_or_word() {
    check(&[
        row!("title is a number", BOX, [(1, "title = 3")], 1, "title", WrongType,
            "3", "a text in quotes"),
        row!("table is a number", CUBE, [(5, ""), (6, "workspace = 200"), (2, ""),
            (3, "mechanism.kind = \"orthoglide\""), (4, "")], 6, "workspace", WrongType,
            "200", "a table [workspace]"),
        row!("kind is a number", BOX, [(3, "kind = 1")], 3, "mechanism.kind", WrongType,
            "1", "\"orthoglide\", \"translational\""),
        row!("misspelt kind", BOX, [(3, "kind = \"ortoglide\"")], 3, "mechanism.kind", UnknownWord,
            "\"ortoglide\"", "did you mean \"orthoglide\"?"),
        row!("unknown kind", BOX, [(3, "kind = \"hexapod\"")], 3, "mechanism.kind", UnknownWord,
            "\"hexapod\"", "such a machine is of kind \"spatial\""),
        row!("unknown drive", LEGS, [(4, "drive = \"belt\"")], 4, "mechanism.legs.0.drive",
            UnknownWord, "\"belt\"", "\"slider\""),
        row!("unknown mode", LEGS, [(9, "mode = \"*\"")], 9, "mechanism.legs.0.mode", UnknownWord,
            "\"*\"", "\"+\", \"-\""),
        row!("mode is a number", LEGS, [(9, "mode = -1")], 9, "mechanism.legs.0.mode", WrongType,
            "-1", "\"+\", \"-\""),
        row!("length is a boolean", BOX, [(4, "leg_length = true")], 4, "mechanism.leg_length",
            WrongType, "the boolean true", "a number or a tolerance"),
        row!("length is a date", BOX, [(4, "leg_length = 2001-02-03")], 4, "mechanism.leg_length",
            WrongType, "the datetime 2001-02-03", "a number or a tolerance"),
        row!("length is an array", BOX, [(4, "leg_length = [310]")], 4, "mechanism.leg_length",
            WrongType, "an array of one element", "a number or a tolerance"),
        row!("side is a boolean", CUBE, [(6, "cube = false")], 6, "workspace.cube", WrongType,
            "the boolean false", "a number"),
        row!("side is a table", CUBE, [(6, "cube = { side = 1 }")], 6, "workspace.cube", WrongType,
            "a table", "a number"),
        row!("corner is a number", BOX, [(8, "min = -73")], 8, "workspace.min", WrongType,
            "-73", "[x, y, z]: three exact numbers"),
        row!("corner of two numbers", BOX, [(9, "max = [1, 2]")], 9, "workspace.max", WrongType,
            "an array of 2 elements", "[x, y, z]: three exact numbers"),
        row!("corner of four numbers", BOX, [(9, "max = [1, 2, 3, 4]")], 9, "workspace.max",
            WrongType, "an array of 4 elements", "[x, y, z]: three exact numbers"),
        row!("coordinate is a table", BOX, [(9, "max = [1, {}, 3]")], 9, "workspace.max.1",
            WrongType, "a table", "a number"),
        row!("anchor of two numbers", LEGS, [(6, "anchor = [0, 0]")], 6,
            "mechanism.legs.0.anchor", WrongType, "an array of 2 elements", "[x, y, z]"),
        row!("two legs", LEGS, [(16, "# none"), (17, ""), (18, ""), (19, ""), (20, ""), (21, "")], 3,
            "mechanism.legs", WrongType, "an array of 2 elements", "three [[mechanism.legs]] tables"),
        row!("transmission is a number", BOX, [(11, "transmission = 2")], 11,
            "requirements.transmission", WrongType, "2", "{ min = \"1/2\", max = 2 }"),
        row!("joint range is a number", BOX, [(12, "joint_range = 257")], 12,
            "requirements.joint_range", WrongType, "257", "an array of three such tables"),
        row!("two joint ranges", BOX, [(12, "joint_range = [{ min = 0 }, { min = 0 }]")], 12,
            "requirements.joint_range", WrongType, "an array of 2 elements", "array of three"),
        row!("joint ranges are numbers", BOX, [(12, "joint_range = [0, 1, 2]")], 12,
            "requirements.joint_range.0", WrongType, "0", "{ min = 0, max = 257 }"),
    ]);
}

#[test]
#[rustfmt::skip]
fn keys_that_exclude_each_other() {
    check(&[
        row!("cube with leg length", CUBE, [(4, "leg_length = 310")], 4, "mechanism.leg_length",
            Conflict, "310, next to workspace.cube", "it follows from requirements.transmission.max"),
        row!("cube with base", CUBE, [(4, "base = -383.8")], 4, "mechanism.base", Conflict,
            "-383.8, next to workspace.cube", "it follows from requirements.transmission.max"),
        row!("cube with psi_min", CUBE, [(8, "transmission = { min = 0.5, max = 2 }")], 8,
            "requirements.transmission.min", Conflict, "0.5, next to workspace.cube",
            "min is 1/max by definition"),
        row!("cube with psi_min alone", CUBE, [(8, "transmission = { min = 0.5 }")], 8,
            "requirements.transmission.min", Conflict, "0.5, next to workspace.cube",
            "min is 1/max by definition"),
        row!("cube without psi_max", CUBE, [(8, "joint_range = { min = 0 }")], 7,
            "requirements.transmission", MissingKey, "nothing: the key is missing", "{ max = 2 }"),
        row!("cube with psi_max 1", CUBE, [(8, "transmission = { max = 1 }")], 8,
            "requirements.transmission.max", OutOfDomain, "1", "greater than 1"),
        row!("cube with psi_max below 1", CUBE, [(8, "transmission.max = \"sqrt(3)/2\"")], 8,
            "requirements.transmission.max", OutOfDomain, "sqrt(3)/2", "greater than 1"),
        row!("cube with tolerance on offset", CUBE, [(4, "offset = \"0 ± 1\"")], 4,
            "mechanism.offset", Tolerance, "a tolerance", "leaves no room for tolerances"),
        row!("cube and box", BOX, [(7, "[workspace]\ncube = 200"), (4, ""), (5, "")], 9,
            "workspace.min", Conflict, "next to workspace.cube", "one workspace"),
        row!("cube of another machine", LEGS, [(23, "cube = 200"), (24, "")], 23, "workspace.cube",
            Conflict, "a cube, next to another machine", "\"orthoglide\" only"),
        row!("joint range without base", BOX, [(5, "")], 12, "requirements.joint_range", Conflict,
            "a joint range without mechanism.base", "where rho = 0 on each axis"),
        row!("corners exchanged", BOX, [(8, "min = [-73, -73, 126.5]")], 9, "workspace.max.2",
            Reversed, "126, below the lower end 126.5", "at least the lower one"),
        row!("order not provable", BOX, [(8, "min = [\"sqrt(2)*sqrt(3)\", 0, 0]"),
            (9, "max = [\"sqrt(6)\", 1, 1]")], 9, "workspace.max.0",
            Reversed, "not provably at least the lower end \"sqrt(2)*sqrt(3)\"", "at least"),
        row!("joint range reversed", BOX, [(12, "joint_range = { min = 1, max = 0 }")], 12,
            "requirements.joint_range.max", Reversed, "0, below the lower end 1", "at least"),
        row!("one joint range reversed", BOX,
            [(12, "joint_range = [{ min = 1 }, { min = 1, max = 2 }, { min = 2, max = 1.5 }]")],
            12, "requirements.joint_range.2.max", Reversed, "1.5, below the lower end 2", "at least"),
        row!("psi_max below psi_min", BOX, [(11, "transmission = { min = 2, max = 0.5 }")], 11,
            "requirements.transmission.max", Reversed, "0.5", "max greater than min"),
        row!("psi_max equals psi_min", BOX, [(11, "transmission = { min = 2, max = 2.0 }")], 11,
            "requirements.transmission.max", Reversed, "2.0", "max greater than min"),
        row!("tolerance reversed", BOX, [(4, "leg_length = { min = 311, max = 310 }")], 4,
            "mechanism.leg_length.max", Reversed, "310, below the lower end 311", "at least"),
    ]);
}

#[test]
#[rustfmt::skip]
fn texts_that_are_not_toml() {
    check(&[
        row!("no quotes", BOX, [(3, "kind = orthoglide")], 3, "mechanism.kind", Syntax,
            "orthoglide", ""),
        row!("unit after a number", BOX, [(4, "leg_length = 310 mm")], 4, "mechanism.leg_length",
            Syntax, "310 mm: string values must be quoted", "numbers carry no unit: \"310\""),
        row!("unit in the second leg", LEGS, [(14, "length = 333 mm")], 14, "mechanism.legs.1.length",
            Syntax, "333 mm: string values must be quoted", "numbers carry no unit: \"333\""),
        row!("tolerance without quotes", BOX, [(4, "leg_length = 310 ± 1")], 4,
            "mechanism.leg_length", Syntax, "must be quoted", "\"310.25 ± 0.02\""),
        row!("a call", BOX, [(4, "leg_length = np.float64(1)")], 4, "mechanism.leg_length", Syntax,
            "invalid float", "a plain number, or text in quotes"),
        row!("decimal comma", BOX, [(4, "leg_length = 310,25")], 4, "mechanism.leg_length", Syntax,
            "a comma in a number", "a point: 310.7"),
        row!("a range as an array", BOX, [(12, "joint_range = [0, 257]")], 12, "requirements.joint_range",
            WrongType, "an array of 2 elements", "did you mean { min = 0, max = 257 }?"),
        row!("one bracket for each leg", LEGS, [(10, "[mechanism.legs]")], 10, "mechanism.legs", Syntax,
            "duplicate key", "[[mechanism.legs]]"),
        row!("a requirement of the mechanism", BOX, [(5, "transmission = { max = 2 }")], 5,
            "mechanism.transmission", UnknownKey, "an unknown key", "transmission goes with [requirements]"),
        row!("an orientation as a requirement", BOX, [(12, "orientation = { angle = 5 }")], 12,
            "requirements.orientation", UnknownKey, "an unknown key", "orientation goes with [workspace]"),
        row!("a header with a comment", BOX, [(7, "[workspace] # of P"), (8, "min = 15\u{b0}")], 8,
            "workspace.min", Syntax, "15\u{b0}", "numbers carry no unit"),
        row!("decimal comma in a table", BOX, [(11, "transmission = { min = 0,5, max = 2 }")], 11,
            "requirements.transmission", Syntax, "a comma in a number", "a point: 310.7"),
        row!("decimal comma at its end", BOX, [(11, "transmission = { max = 2,5 }")], 11,
            "requirements.transmission", Syntax, "a comma in a number", "a point: 310.7"),
        row!("a certificate", BOX, [(1, "{\"format\":\"orthocert/2\"}")], 1, "", Syntax,
            "a certificate", "orthocert check"),
        row!("an atlas", BOX, [(1, "[atlas]")], 1, "atlas", UnknownKey, "an unknown key",
            "orthocert atlas"),
        row!("an unknown unit", BOX, [(1, "unit = \"ft\"")], 1, "unit", UnknownWord, "\"ft\"",
            "\"um\", \"mm\", \"cm\", \"m\", \"in\""),
        row!("degrees", BOX, [(4, "leg_length = \"310 deg\"")], 4, "mechanism.leg_length", NotANumber,
            "310 deg", "in degrees where a key says so"),
        row!("point without digits", BOX, [(4, "leg_length = 310.")], 4, "mechanism.leg_length",
            Syntax, "", ""),
        row!("expression without quotes", BOX, [(4, "leg_length = 1/3")], 4,
            "mechanism.leg_length", Syntax, "/3", ""),
        row!("no value", BOX, [(4, "leg_length =")], 4, "mechanism.leg_length", Syntax, "", ""),
        row!("no equals sign", BOX, [(4, "leg_length")], 4, "mechanism", Syntax, "", "`=`"),
        row!("quote not closed", BOX, [(1, "title = \"box")], 1, "title", Syntax, "", ""),
        row!("header not closed", BOX, [(7, "[workspace")], 7, "workspace", Syntax, "", "`]`"),
        row!("array not closed", CUBE, [(8, "transmission = [")], 8, "requirements.transmission",
            Syntax, "", "`]`"),
        row!("key twice", BOX, [(5, "leg_length = 310")], 5, "mechanism.leg_length", Syntax,
            "leg_length: duplicate key", "each key once"),
        row!("table twice", BOX, [(10, "[workspace]")], 10, "workspace", Syntax,
            "workspace: duplicate key", "each key once"),
        row!("bad hexadecimal digit", BOX, [(4, "leg_length = 0xG1")], 4, "mechanism.leg_length",
            Syntax, "", ""),
        row!("control character", BOX, [(4, "leg_length = \"\u{1b}[31m\"")], 4,
            "mechanism.leg_length", Syntax, "\\u{1b}: invalid basic string", ""),
        row!("JSON", BOX, [(1, "{ \"title\": \"box\" }")], 1, "", Syntax, "{", ""),
    ]);
}

/// A machine whose legs stand on line 3.
const ONE_LINE: &str = "[mechanism]
kind = \"translational\"
legs = []
[workspace]
min = [0, 0, 0]
max = [1, 1, 1]
[requirements]
transmission = { max = 2 }
";

#[test]
#[rustfmt::skip]
fn legs_that_are_not_three_tables() {
    check(&[
        row!("no legs", ONE_LINE, [(3, "")], 1, "mechanism.legs", MissingKey,
            "nothing: the key is missing", "three [[mechanism.legs]] tables"),
        row!("empty array", ONE_LINE, [], 3, "mechanism.legs", WrongType,
            "an array of 0 elements", "three [[mechanism.legs]] tables"),
        row!("one table", ONE_LINE, [(3, "[mechanism.legs]")], 3, "mechanism.legs", WrongType,
            "a table", "three [[mechanism.legs]] tables"),
        row!("a number", ONE_LINE, [(3, "legs = 3")], 3, "mechanism.legs", WrongType,
            "3", "three [[mechanism.legs]] tables"),
        row!("three numbers", ONE_LINE, [(3, "legs = [1, 2, 3]")], 3, "mechanism.legs.0",
            WrongType, "1", "a [[mechanism.legs]] table"),
        row!("a fourth table", LEGS, [(22, "[[mechanism.legs]]\n[workspace]")], 22,
            "mechanism.legs.3.drive", MissingKey, "nothing: the key is missing", "\"slider\""),
    ]);
}

#[test]
fn empty_texts_lack_the_first_table() {
    for text in ["", "\n\n", "# nothing\n", "\u{feff}"] {
        let error = refuse(text);
        assert_eq!((error.defect(), error.key()), (MissingKey, "mechanism"), "{error}");
        assert_eq!(error.position().line, 1, "{error}");
        check_message(&error, text);
    }
}

#[test]
fn deep_nesting_is_refused_without_recursion() {
    let deep = 100_000;
    for text in [
        format!("title = {}", "[".repeat(deep)),
        format!("title = {}{}", "[".repeat(deep), "]".repeat(deep)),
        format!("title = {}", "{a=".repeat(deep)),
        format!("{}x = 1", "a.".repeat(deep)),
        format!("[{}x]", "a.".repeat(deep)),
        format!("[[{}x]]", "a.".repeat(deep)),
        format!("title = {{ {}x = 1 }}", "a.".repeat(deep)),
    ] {
        let error = refuse(&text);
        assert_eq!(error.position().line, 1, "{error}");
        check_message(&error, &text);
    }
}

#[test]
fn no_text_makes_the_reader_panic() {
    let replacements = ["", "\"", "[", "]", "{", "}", "=", ".", "\n", "-", "9", "±", "\u{0}"];
    for design in [BOX, CUBE, LEGS] {
        for (at, c) in design.char_indices() {
            for new in replacements {
                let rest = &design[at + c.len_utf8()..];
                let text = format!("{}{new}{rest}", &design[..at]);
                if let Err(error) = Design::parse(&text, "test.toml") {
                    check_message(&error, &text);
                }
            }
            if let Err(error) = Design::parse(&design[..at], "test.toml") {
                check_message(&error, &design[..at]);
            }
        }
    }
}
