//! The statement of a claim as papers would have it: decimals, Greek letters, signs. The exact checker's
//! words stand below it, folded.

use super::mechanism::{number, LETTERS};
use crate::exact::Exact;
use crate::report::escape::xml;
use orthocert_checker::certificate::Verdict;
use orthocert_checker::statement;
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::{Every, PsiMax, Quantity};
use orthocert_kernel::number::Expression;
use orthocert_kernel::vary::Numbers;
use std::fmt::Write;

/// What an accepted certificate establishes: to read, and in the checker's words.
pub fn theorem(claim: &Claim, verdict: Verdict) -> String {
    let mut read = claim.clone();
    match &mut read {
        Claim::Machine(claim) => in_decimals(claim),
        Claim::NoCube(claim) => {
            in_decimals(&mut claim.machine);
            in_decimals(&mut claim.side);
        }
        Claim::Postulate(claim) => match &mut claim.psi_max {
            PsiMax::Of(Quantity::Exactly(psi)) => in_decimals(psi),
            PsiMax::Of(Quantity::Between { min, max }) => {
                in_decimals(min);
                in_decimals(max);
            }
            PsiMax::Every(Every::All) => {}
        },
        Claim::Atlas(claim) => {
            in_decimals(&mut claim.machine);
            in_decimals(&mut claim.certified);
            in_decimals(&mut claim.refuted);
        }
    }
    shown(&statement::statement(&read, verdict), &statement::statement(claim, verdict))
}

/// Writes every number that is no name's as [`number`] does.
pub fn in_decimals(of: &mut impl Numbers) {
    for x in of.numbers_mut() {
        if Exact::of(x).is_some() {
            *x = Expression::Name(number(x));
        }
    }
}

/// A statement to read, and the same in the checker's words.
pub fn shown(read: &str, exact: &str) -> String {
    let note = match read.contains('\u{2026}') {
        true => "<p class=\"note\">Where digits end in \u{2026}, more follow.</p>",
        false => "",
    };
    format!(
        "<div class=\"theorem\">{}</div>{note}\
         <details><summary>In the words of the exact checker, complete and without rounding</summary>\
         <pre>{}</pre></details>",
        paragraphs(read),
        xml(exact.trim_end())
    )
}

/// Lines as paragraphs, indented ones as items of a list.
fn paragraphs(text: &str) -> String {
    let mut blocks: Vec<(bool, String)> = Vec::new();
    for line in text.lines() {
        let is_item = line.starts_with("  ");
        match blocks.last_mut() {
            // What is indented goes on after a comma, or in the middle of a sentence.
            Some((was_item, last)) if *was_item == is_item && (!is_item || goes_on(last)) => {
                last.push(' ');
                last.push_str(line.trim());
            }
            _ => blocks.push((is_item, line.trim().to_owned())),
        }
    }
    let mut out = String::new();
    let mut in_list = false;
    for (is_item, text) in blocks {
        if is_item != in_list {
            out.push_str(if is_item { "<ul>" } else { "</ul>" });
            in_list = is_item;
        }
        let tag = if is_item { "li" } else { "p" };
        let _ = write!(out, "<{tag}>{}</{tag}>", typeset(&text));
    }
    if in_list {
        out.push_str("</ul>");
    }
    out
}

fn goes_on(item: &str) -> bool {
    item.ends_with(',') || item.ends_with(" no")
}

/// A piece of a statement.
#[derive(Clone, Copy, PartialEq)]
enum Token<'a> {
    /// A word, a name, or a number.
    Word(&'a str),
    Sign(&'a str),
    /// A parameter of a map: `<name>`.
    Parameter(&'a str),
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let in_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '\u{2026}');
    let mut out = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = in_word(first);
        let mut length = rest.find(|c| in_word(c) != is_word).unwrap_or(rest.len());
        if !is_word {
            let sign = ["<=", ">=", "^-1", "^-T", "-> "].into_iter().find(|s| rest.starts_with(s));
            length = sign.map_or(first.len_utf8(), str::len);
        } else if first.is_ascii_digit() {
            // The decimals of a number.
            let is_digit = |c: char| c.is_ascii_digit() || c == '\u{2026}';
            let more = rest[length..].strip_prefix('.').filter(|more| more.starts_with(is_digit));
            length += more.map_or(0, |more| 1 + more.find(|c| !is_digit(c)).unwrap_or(more.len()));
        }
        let (token, others) = rest.split_at(length);
        out.push(if is_word { Token::Word(token) } else { Token::Sign(token) });
        rest = others;
    }
    out
}

/// A line as markup: `psi_i >= 0.5` with a Greek letter, an index and one sign; `(80)^2` without what is
/// needed in plain text alone.
fn typeset(text: &str) -> String {
    use Token::{Parameter, Sign, Word};
    let mut all: Vec<Token<'_>> = Vec::new();
    for token in tokens(text) {
        all.push(token);
        let bare = match all[..] {
            [.., Sign("<"), Word(name), Sign(">")] => Some(Parameter(name)),
            // In parentheses that are a function's, they stay.
            [.., Word(_), Sign("("), _, Sign(")")] => None,
            [.., Sign("("), x @ Parameter(_), Sign(")")] => Some(x),
            [.., Sign("("), x @ Word(number), Sign(")")] => {
                Some(x).filter(|_| number.starts_with(|c: char| c.is_ascii_digit()))
            }
            _ => None,
        };
        if let Some(bare) = bare {
            all.truncate(all.len() - 3);
            all.push(bare);
        }
    }
    let mut out = String::new();
    for (i, token) in all.iter().enumerate() {
        let before = i.checked_sub(1).map(|i| all[i]);
        let after = all.get(i + 1).copied();
        match token {
            Word(name) if before == Some(Sign("^")) => {
                let _ = write!(out, "<sup>{name}</sup>");
            }
            Word("sqrt") if after == Some(Sign("(")) => out.push('\u{221a}'),
            Word(name) => out.push_str(&letter(name)),
            Parameter(name) => {
                let _ = write!(out, "<var>{}</var>", xml(name));
            }
            Sign("<=") => out.push('\u{2264}'),
            Sign(">=") => out.push('\u{2265}'),
            Sign("*") => out.push('\u{b7}'),
            Sign("^-1") => out.push_str("<sup>\u{2212}1</sup>"),
            Sign("^-T") => out.push_str("<sup>\u{2212}T</sup>"),
            Sign("^") if matches!(after, Some(Word(_))) => {}
            Sign("'") if after == Some(Word("s")) => out.push('\u{2019}'),
            Sign("'") => out.push('\u{2032}'),
            Sign("-") => out.push(if is_hyphen(before, after) { '-' } else { '\u{2212}' }),
            Sign(sign) => out.push_str(&xml(sign)),
        }
    }
    // A disc about the origin.
    ["x", "y"].iter().fold(out, |out, name| out.replace(&format!("({name} \u{2212} 0)"), name))
}

/// Whether a dash is within a word.
fn is_hyphen(before: Option<Token<'_>>, after: Option<Token<'_>>) -> bool {
    let is_word = |token| match token {
        Some(Token::Word(w)) => w.len() > 2 && w.chars().all(|c| c.is_ascii_lowercase()),
        _ => false,
    };
    is_word(before) && is_word(after)
}

/// A name as papers have it: of Greek ones the letter, indices below the line.
fn letter(name: &str) -> String {
    let (base, index) = match name.split_once('_') {
        Some((base, index)) => (base, index),
        // q1, t2
        None => match name.find(|c: char| c.is_ascii_digit()) {
            Some(1) if name.len() == 2 => name.split_at(1),
            _ => (name, ""),
        },
    };
    let greek = LETTERS.iter().find(|(known, _)| *known == base).map(|(_, letter)| letter);
    let base = match greek {
        Some(letter) => letter.to_string(),
        None if matches!(base, "P" | "M" | "R" | "L" | "H" | "A" | "w" | "c" | "q" | "t") => {
            format!("<var>{base}</var>")
        }
        None if index.is_empty() || base == "row" => base.to_owned(),
        None => return xml(name),
    };
    match index {
        "" => base,
        index => format!("{base}<sub>{}</sub>", xml(index)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    #[test]
    fn statements_have_the_letters_and_signs_of_papers() {
        for (text, shown) in [
            ("psi_i >= 0.5", "\u{3c8}<sub>i</sub> \u{2265} 0.5"),
            ("(x - (0))^2 <= (80)^2", "x<sup>2</sup> \u{2264} 80<sup>2</sup>"),
            ("(x - (-1))^2", "(x \u{2212} (\u{2212}1))<sup>2</sup>"),
            ("q1 = -L t1/sqrt(1 + 2 t1^2)", "<var>q</var><sub>1</sub> = \u{2212}<var>L</var> <var>t</var><sub>1</sub>/\u{221a}(1 + 2 <var>t</var><sub>1</sub><sup>2</sup>)"),
            ("the leg's P'", "the leg\u{2019}s <var>P</var>\u{2032}"),
            ("No axis-aligned cube, 2*x-y", "No axis-aligned cube, 2\u{b7}x\u{2212}y"),
            ("eta < 0, (<r>)^2 & my_own", "\u{3b7} &lt; 0, <var>r</var><sup>2</sup> &amp; my_own"),
            ("from -(0.1\u{2026}) to 20", "from \u{2212}0.1\u{2026} to 20"),
            ("f(2), roots (5)", "f(2), roots 5"),
        ] {
            assert_eq!(typeset(text), shown);
        }
    }

    /// What is shown in decimals is below, in the checker's words, exactly.
    #[test]
    fn numbers_are_decimals_and_exact_below() {
        let text = r#"
            [mechanism]
            kind = "orthoglide"
            leg_length = "100*sqrt(10)"
            [workspace]
            min = [-60, "-1/3", -60]
            max = [100, 100, 100]
            [requirements]
            transmission = { min = "1/3", max = 3 }
        "#;
        let claim = Claim::Machine(Design::parse(text, "test.toml").unwrap().claim);
        let html = theorem(&claim, Verdict::Certified);
        let (read, exact) = html.split_once("<details>").unwrap();
        assert!(read.contains("\u{3c8}<sub>i</sub> \u{2265} 0.333333333\u{2026}"), "{read}");
        assert!(read.contains("(\u{2212}60, \u{2212}0.333333333\u{2026}, \u{2212}60)"), "{read}");
        assert!(read.contains("length 316.227766\u{2026},"), "{read}");
        assert!(
            exact.contains("psi_i &gt;= 1/3") && exact.contains("length 100*sqrt(10)"),
            "{exact}"
        );
    }
}
