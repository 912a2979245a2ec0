//! Tolerances as people write them, told from arithmetic.
//!
//! On a drawing `333.0 +0.05 -0.02` is a range; as an expression it is 333.03. What may be read as
//! either is refused, in designs, atlases and on the command line alike:
//!
//! | a text with                                             | such as                               |
//! |---------------------------------------------------------|---------------------------------------|
//! | a binary sign with a blank on one of its two sides      | `333 +0.05`, `333 +0 -0.1`            |
//! | `+` before `-`                                          | `333 +- 0.05`                         |
//! | `/` before a sign                                       | `333+0.05/-0.02`, `333 (+0.05/-0.02)` |
//! | nothing but three numbers, one added and one subtracted | `333+0.05-0.02`                       |
//! | a number, a sign and a quotient of small decimals       | `333+0.05/0.02`, `333 - 0/0.02`       |
//! | a number, a sign, and a sign or a lone parenthesis      | `333--0.02`, `333+(0.05)-(0.02)`      |
//! | a quotient of two decimals, near each other             | `332.98/333.02`                       |
//! | a tolerance with a sign or `/` outside of parentheses   | `333 ±0.05/0.02`, `333 ± 0.05 - 0.02` |

/// The nominal value and the tolerance's text, each with its byte offset in `text`.
pub(super) fn parts_of_tolerance(text: &str) -> Option<[(usize, &str); 2]> {
    let sign = ["±", "+/-"].into_iter().filter_map(|sign| Some((text.find(sign)?, sign.len())));
    let (at, length) = sign.min()?;
    Some([(0, text.get(..at)?), (at + length, text.get(at + length..)?)])
}

/// Whether a text that is no tolerance by the grammar may be meant as one.
fn is_ambiguous(text: &str) -> bool {
    let tokens = tokens(text);
    let sign = |i: usize| tokens.get(i).is_some_and(|(_, token)| matches!(*token, "+" | "-"));
    let end = |i: usize| tokens.get(i).map_or(text.len(), |(at, token)| at + token.len());
    let start = |i: usize| tokens.get(i).map_or(text.len(), |(at, _)| *at);
    let ambiguous = |i: usize| match tokens.get(i).map(|(_, token)| *token) {
        Some("/") => sign(i + 1),
        Some(token @ ("+" | "-")) if i > 0 && is_operand(tokens.get(i - 1)) => {
            let (before, after) = (start(i) > end(i - 1), start(i + 1) > end(i));
            before != after || (token == "+" && sign(i + 1))
        }
        _ => false,
    };
    let deviations = match tokens.as_slice() {
        [(_, a), (_, first), (_, b), (_, second), (_, c)] => {
            let signs = matches!((*first, *second), ("+", "-") | ("-", "+"));
            signs && [a, b, c].iter().all(|x| x.starts_with(|c: char| c.is_ascii_digit()))
        }
        _ => false,
    };
    deviations || is_deviation(&tokens) || (0..tokens.len()).any(ambiguous)
}

/// Whether tokens are a nominal value with deviations in signs, quotients and lone parentheses.
fn is_deviation(tokens: &[(usize, &str)]) -> bool {
    let number = |token: &str| token.starts_with(|c: char| c.is_ascii_digit());
    let bare: Vec<&str> = tokens
        .iter()
        .map(|(_, token)| *token)
        .filter(|token| !matches!(*token, "(" | ")"))
        .collect();
    let parenthesised = bare.len() < tokens.len();
    match bare.as_slice() {
        [a, "+" | "-", b, "/", c] if number(a) && number(b) && number(c) && !parenthesised => {
            // 100+1/3 and 100+12.5/2 are sums.
            [b, c].iter().all(|x| (x.contains('.') || **x == "0") && is_small(x, a))
        }
        [a, "+" | "-", "+" | "-", b] => number(a) && number(b) && is_small(b, a),
        [a, "+" | "-", b, "+" | "-", c] => {
            number(a) && number(b) && number(c) && (*b == "0" || lone(tokens))
        }
        [a, "/", b] => a.contains('.') && b.contains('.') && near(a, b),
        _ => false,
    }
}

/// Whether some parentheses hold one number alone.
fn lone(tokens: &[(usize, &str)]) -> bool {
    tokens.windows(3).any(|three| (three[0].1, three[2].1) == ("(", ")"))
}

/// Whether a deviation is at most a twentieth of the nominal value.
fn is_small(deviation: &str, nominal: &str) -> bool {
    matches!((deviation.parse::<f64>(), nominal.parse::<f64>()), (Ok(d), Ok(n)) if d <= 0.05 * n)
}

/// Whether two decimals differ by less than a hundredth of themselves: a range, rather than a ratio.
fn near(a: &str, b: &str) -> bool {
    match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() < 0.01 * a.abs() && a != b,
        _ => false,
    }
}

/// Whether a text may be meant as a tolerance, whatever the grammar makes of it.
pub fn may_be_tolerance(text: &str) -> bool {
    parts_of_tolerance(text).is_some() || is_ambiguous(text)
}

/// Whether nominal value and tolerance can be read in one way only.
pub(super) fn is_plain_tolerance([(_, nominal), (_, tolerance)]: &[(usize, &str); 2]) -> bool {
    let mut depth = 0i32;
    let mut operand = false;
    for token in tokens(tolerance) {
        match token.1 {
            "(" => depth += 1,
            ")" => depth -= 1,
            "+" | "-" | "/" if operand && depth == 0 => return false,
            _ => {}
        }
        operand = is_operand(Some(&token));
    }
    !is_ambiguous(nominal) && !is_ambiguous(tolerance)
}

/// Whether an operand ends with this token, so that a sign after it is binary.
fn is_operand(token: Option<&(usize, &str)>) -> bool {
    let last = token.and_then(|(_, token)| token.chars().next_back());
    last.is_some_and(|c| c.is_alphanumeric() || matches!(c, '.' | '_' | ')'))
}

/// Literals, words and single characters with their byte offsets, without blanks.
fn tokens(text: &str) -> Vec<(usize, &str)> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let first = rest.chars().next().unwrap_or(' ');
        let length = match first {
            '0'..='9' => literal(rest),
            'a'..='z' | 'A'..='Z' => run(rest, |c| c.is_ascii_alphanumeric() || c == '_'),
            _ => first.len_utf8(),
        };
        if !first.is_whitespace() {
            tokens.push((at, rest.get(..length).unwrap_or(rest)));
        }
        at += length;
    }
    tokens
}

/// The bytes of the decimal literal that `text` begins with, its exponent included.
fn literal(text: &str) -> usize {
    let mantissa = run(text, |c| c.is_ascii_digit() || c == '.');
    let after = text.get(mantissa..).unwrap_or_default();
    let exponent = after.strip_prefix(['e', 'E']).map(|rest| {
        let digits = rest.strip_prefix(['+', '-']).unwrap_or(rest);
        (after.len() - digits.len(), run(digits, |c| c.is_ascii_digit()))
    });
    match exponent {
        Some((sign, digits)) if digits > 0 => mantissa + sign + digits,
        _ => mantissa,
    }
}

fn run(text: &str, is: impl Fn(char) -> bool) -> usize {
    text.find(|c: char| !is(c)).unwrap_or(text.len())
}
