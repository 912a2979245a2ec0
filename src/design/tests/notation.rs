//! Tolerances, arithmetic, and what may be read as either: every spelling means exactly what the
//! table says, or is refused with a sentence that says how to write it.

use super::accepted::length;
use super::*;

/// What a text means: every value between two numbers, one number, or nothing.
enum Meaning {
    Between(&'static str, &'static str),
    Exactly(&'static str),
    Refused,
}
use Meaning::{Between, Exactly, Refused};

#[rustfmt::skip]
const SPELLINGS: &[(&str, Meaning)] = &[
    // Tolerances.
    ("333 ± 0.05", Between("332.95", "333.05")),
    ("333 ±0.05", Between("332.95", "333.05")),
    ("333± 0.05", Between("332.95", "333.05")),
    ("333±0.05", Between("332.95", "333.05")),
    ("333 +/- 0.05", Between("332.95", "333.05")),
    ("333 +/-0.05", Between("332.95", "333.05")),
    ("333+/-0.05", Between("332.95", "333.05")),
    ("\t333.0  ±  0.05 ", Between("332.95", "333.05")),
    ("333 ± 5e-2", Between("332.95", "333.05")),
    ("333 ± (1/20)", Between("332.95", "333.05")),
    ("333 ± (0.02 + 0.03)", Between("332.95", "333.05")),
    ("333 ± 5*0.01", Between("332.95", "333.05")),
    ("333 ± sqrt(1/400)", Between("332.95", "333.05")),
    ("999/3 ± 0.05", Between("332.95", "333.05")),
    ("330 + 3 ± 0.05", Between("332.95", "333.05")),
    ("330+3 ± 0.05", Between("332.95", "333.05")),
    ("333 ± 0", Exactly("333")),
    // Arithmetic as people write it.
    ("333 + 0.05", Exactly("333.05")),
    ("333+0.05", Exactly("333.05")),
    ("333 - 0.05", Exactly("332.95")),
    ("200+10", Exactly("210")),
    ("200 + 10 + 5", Exactly("215")),
    ("200+(10-5)", Exactly("205")),
    ("(200 + 10) - 5", Exactly("205")),
    ("2*100 + 10 - 5", Exactly("205")),
    ("200 - 10 - 5", Exactly("185")),
    ("1/3", Exactly("1/3")),
    ("- 1 / 3 + 1", Exactly("2/3")),
    ("174.75*sqrt(3)/2", Exactly("174.75*sqrt(3)/2")),
    ("2 * -3 + 10", Exactly("4")),
    ("10/(-2) + 6", Exactly("1")),
    ("1e-3", Exactly("0.001")),
    ("1e+3", Exactly("1000")),
    ("2 + 1e-3", Exactly("2.001")),
    ("5--2", Exactly("7")),
    // On a drawing these are ranges, or limits of another kind; as expressions they are numbers.
    ("333.0 +0.05 -0.02", Refused),
    ("333.0 -0.02 +0.05", Refused),
    ("333 +0.05", Refused),
    ("333 -0.1", Refused),
    ("333+ 0.05", Refused),
    ("333 +0 -0.1", Refused),
    ("333 -0 -0.1", Refused),
    ("333+0.05-0.02", Refused),
    ("333+0.05/0.02", Refused),
    ("333 + 0.05 / 0.02", Refused),
    ("333 - 0.02/0.05", Refused),
    ("333+0/0.02", Refused),
    ("333--0.02", Refused),
    ("333 - -0.02", Refused),
    ("333+(0.05)-(0.02)", Refused),
    ("333 + (0.05) - (0.02)", Refused),
    ("333-0-0.02", Refused),
    ("332.98/333.02", Refused),
    ("333+1/3", Exactly("1000/3")),
    ("100 + 12.5/2", Exactly("425/4")),
    ("333.5/2", Exactly("667/4")),
    ("333-0.02+0.05", Refused),
    ("333 + 0.05 - 0.02", Refused),
    ("333 - 0.02 + 0.05", Refused),
    ("333.0 +0.05/-0.02", Refused),
    ("333+0.05/-0.02", Refused),
    ("333 + 0.05 / -0.02", Refused),
    ("333 -0.02/+0.05", Refused),
    ("333 (+0.05/-0.02)", Refused),
    ("333(+0.05/-0.02)", Refused),
    ("333 (+0.05 -0.02)", Refused),
    ("(333 +0.05)", Refused),
    ("2*(333 -0.1)", Refused),
    ("333 +- 0.05", Refused),
    ("333+-0.05", Refused),
    ("333 + -0.05", Refused),
    ("333 + - 0.05", Refused),
    ("333 -+ 0.05", Refused),
    ("333 -/+ 0.05", Refused),
    ("333 ±0.05/0.02", Refused),
    ("333 ± 0.05/0.02", Refused),
    ("333 ± 1/20", Refused),
    ("333 +/- 0.05/0.02", Refused),
    ("333 ± 0.05 - 0.02", Refused),
    ("333 ± 0.05 -0.02", Refused),
    ("333 ± +0.05/-0.02", Refused),
    ("333 +0.05 ± 0.01", Refused),
    ("333 ± (0.05 -0.02)", Refused),
    ("333 ± 0.05 ± 0.02", Refused),
    ("333 ± -0.05", Refused),
    // Not in the grammar of numbers.
    ("333+/-.05", Refused),
    ("333 ± .05", Refused),
    ("±0.05", Refused),
    ("333 ±", Refused),
    ("333 ± 5%", Refused),
    ("333 ± 0.05 mm", Refused),
    ("333 0.05", Refused),
    ("333 (0.05)", Refused),
    ("333(5)", Refused),
    ("333 h7", Refused),
    ("333h7", Refused),
    ("333 H7/g6", Refused),
    ("333 js6", Refused),
    ("332.98..333.05", Refused),
    ("332.98 to 333.05", Refused),
    ("[332.98, 333.05]", Refused),
    ("333,0 ± 0,05", Refused),
    ("333 +\u{2212} 0.05", Refused),
    ("333 +/\u{2212} 0.05", Refused),
    ("333 +0.05 \u{2212}0.02", Refused),
    ("333 \u{2212} 0.05", Refused),
    ("333 \u{2213} 0.05", Refused),
    ("333 \u{ff0b}0.05", Refused),
    ("333 \u{ff0b}0.05 \u{ff0d}0.02", Refused),
    ("333\u{a0}±\u{a0}0.05", Refused),
    ("333\u{a0}+0.05", Refused),
    ("333\u{2009}+\u{2009}0.05", Refused),
    ("333 \u{fe62}0.05", Refused),
    ("333 &plusmn; 0.05", Refused),
    ("333 +/ - 0.05", Refused),
];

#[test]
fn every_spelling_means_what_the_table_says_or_is_refused() {
    assert!(SPELLINGS.len() >= 60);
    for (text, meaning) in SPELLINGS {
        let written = format!("\"{text}\"");
        match meaning {
            Between(min, max) => assert_eq!(length(&written), between(min, max), "{text}"),
            Exactly(value) => assert_eq!(length(&written), exactly(value), "{text}"),
            Refused => {
                let error = refuse(&with(BOX, &[(4, &format!("leg_length = {written}"))]));
                assert!(error.accepted().contains("a tolerance"), "{text}: {error}");
            }
        }
    }
}

#[test]
fn where_no_tolerance_may_stand_the_same_texts_are_numbers() {
    for (text, meaning) in SPELLINGS {
        let text_of = |line: &str| with(BOX, &[(9, line)]);
        let design = text_of(&format!("max = [\"{text}\", 400, 400]"));
        match meaning {
            Exactly(value) if !text.contains('±') => {
                let claim = read(&design);
                let Workspace::Box { max, .. } = claim.workspace else {
                    panic!("no box");
                };
                assert_eq!(max[0], exactly(value).max, "{text}");
            }
            _ => assert_eq!(refuse(&design).position().line, 9, "{text}"),
        }
    }
}
