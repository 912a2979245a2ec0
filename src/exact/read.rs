//! Reads expressions: the grammar of [`number`](super).

use super::{
    Exact, NumberError, NumberErrorKind, MAX_EXPONENT, MAX_FOLDED, MAX_LITERALS, MAX_NAME,
    MAX_NESTING, MAX_ROOTS, MAX_TEXT,
};
use num_bigint::BigInt;
use num_rational::BigRational;

/// Reads an expression; literals have at most `max_digits` digits, names are numbers where they may be.
pub(super) fn expression(text: &str, max_digits: usize, names: bool) -> Result<Exact, NumberError> {
    if text.len() > MAX_TEXT {
        return Err(NumberError { at: MAX_TEXT, kind: NumberErrorKind::TooLarge });
    }
    let mut parser = Parser {
        text: text.as_bytes(),
        at: 0,
        depth: 0,
        literals: 0,
        roots: 0,
        folded: 0,
        max_digits,
        names,
    };
    let value = parser.sum()?;
    parser.skip_blank();
    if parser.at < text.len() {
        return Err(parser.error(NumberErrorKind::TrailingText));
    }
    Ok(value)
}

struct Parser<'a> {
    text: &'a [u8],
    at: usize,
    depth: usize,
    literals: usize,
    roots: usize,
    /// Bits of the rational numbers made so far.
    folded: u64,
    max_digits: usize,
    /// Whether names are numbers.
    names: bool,
}

impl Parser<'_> {
    fn error(&self, kind: NumberErrorKind) -> NumberError {
        NumberError { at: self.at, kind }
    }

    fn skip_blank(&mut self) {
        while matches!(self.text.get(self.at), Some(b' ' | b'\t')) {
            self.at += 1;
        }
    }

    fn eat(&mut self, byte: u8) -> bool {
        self.skip_blank();
        let found = self.text.get(self.at) == Some(&byte);
        self.at += usize::from(found);
        found
    }

    /// A number that was made here, and is counted.
    fn combine(
        &mut self,
        at: usize,
        result: Result<Exact, NumberErrorKind>,
    ) -> Result<Exact, NumberError> {
        let value = result.map_err(|kind| NumberError { at, kind })?;
        if let Some(x) = value.as_rational() {
            self.folded += x.numer().bits() + x.denom().bits();
        }
        if self.folded > MAX_FOLDED {
            return Err(NumberError { at, kind: NumberErrorKind::TooLarge });
        }
        Ok(value)
    }

    fn sum(&mut self) -> Result<Exact, NumberError> {
        let mut value = self.product()?;
        loop {
            let at = self.at;
            value = if self.eat(b'+') {
                let term = self.product()?;
                self.combine(at, value.plus(term))?
            } else if self.eat(b'-') {
                let term = self.product()?;
                self.combine(at, value.minus(term))?
            } else {
                return Ok(value);
            };
        }
    }

    fn product(&mut self) -> Result<Exact, NumberError> {
        let mut value = self.unary()?;
        loop {
            if self.eat(b'*') {
                let at = self.at;
                let factor = self.unary()?;
                value = self.combine(at, value.times(factor))?;
            } else if self.eat(b'/') {
                self.skip_blank();
                let at = self.at;
                let divisor = self.unary()?;
                value = self.combine(at, value.over(divisor))?;
            } else {
                return Ok(value);
            }
        }
    }

    fn unary(&mut self) -> Result<Exact, NumberError> {
        self.depth += 1;
        if self.depth > MAX_NESTING {
            return Err(self.error(NumberErrorKind::TooLarge));
        }
        let value = self.unary_within_depth();
        self.depth -= 1;
        value
    }

    fn unary_within_depth(&mut self) -> Result<Exact, NumberError> {
        if self.eat(b'-') {
            return Ok(self.unary()?.negated());
        }
        if self.eat(b'(') {
            let value = self.sum()?;
            return self.closed(value);
        }
        let word = self.word();
        if self.names && word > 0 && self.text.get(self.at..self.at + word) != Some(b"sqrt") {
            return self.name(word);
        }
        if self.text.get(self.at..).is_some_and(|rest| rest.starts_with(b"sqrt")) {
            self.at += 4;
            self.roots += 1;
            if self.roots > MAX_ROOTS {
                return Err(self.error(NumberErrorKind::TooManyRoots));
            }
            if !self.eat(b'(') {
                return Err(self.error(NumberErrorKind::Expected("\"(\" after sqrt")));
            }
            let at = self.at;
            let radicand = self.sum()?;
            let radicand = self.closed(radicand)?;
            return self.combine(at, radicand.root());
        }
        let at = self.at;
        let literal = self.literal();
        literal.and_then(|value| self.combine(at, Ok(value)))
    }

    /// The number of bytes of the name or `sqrt` that begins here; 0 if none does.
    fn word(&self) -> usize {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let letters = |c: &&u8| matches!(c, b'a'..=b'z' | b'0'..=b'9' | b'_');
        match rest.first() {
            Some(b'a'..=b'z') => rest.iter().take_while(letters).count(),
            _ => 0,
        }
    }

    fn name(&mut self, length: usize) -> Result<Exact, NumberError> {
        self.literals += 1;
        if self.literals > MAX_LITERALS || length > MAX_NAME {
            return Err(self.error(NumberErrorKind::TooLarge));
        }
        let name = self.text.get(self.at..self.at + length).unwrap_or_default();
        let name = String::from_utf8_lossy(name).into();
        self.at += length;
        Ok(Exact::Name(name))
    }

    fn closed(&mut self, value: Exact) -> Result<Exact, NumberError> {
        if self.eat(b')') {
            Ok(value)
        } else {
            Err(self.error(NumberErrorKind::Expected("\")\"")))
        }
    }

    fn digits(&mut self) -> &str {
        let start = self.at;
        while self.text.get(self.at).is_some_and(u8::is_ascii_digit) {
            self.at += 1;
        }
        let run = self.text.get(start..self.at).unwrap_or_default();
        std::str::from_utf8(run).unwrap_or_default()
    }

    fn literal(&mut self) -> Result<Exact, NumberError> {
        let start = self.at;
        self.literals += 1;
        if self.literals > MAX_LITERALS {
            return Err(self.error(NumberErrorKind::TooLarge));
        }
        let mut digits = self.digits().to_owned();
        if digits.is_empty() {
            return Err(self.error(NumberErrorKind::Expected("a number, \"-\", \"(\" or \"sqrt\"")));
        }
        let mut exponent = 0i64;
        if self.text.get(self.at) == Some(&b'.') {
            self.at += 1;
            let fraction = self.digits().to_owned();
            if fraction.is_empty() {
                return Err(self.error(NumberErrorKind::Expected("a digit after the point")));
            }
            exponent -= i64::try_from(fraction.len()).unwrap_or(i64::MAX);
            digits.push_str(&fraction);
        }
        if digits.len() > self.max_digits {
            return Err(NumberError {
                at: start,
                kind: NumberErrorKind::TooManyDigits(self.max_digits),
            });
        }
        if matches!(self.text.get(self.at), Some(b'e' | b'E')) {
            self.at += 1;
            let negative = match self.text.get(self.at) {
                Some(b'-') => true,
                Some(b'+') => false,
                _ => {
                    self.at -= 1;
                    false
                }
            };
            self.at += 1;
            let at = self.at;
            let written = self.digits().to_owned();
            if written.is_empty() {
                return Err(self.error(NumberErrorKind::Expected("the digits of an exponent")));
            }
            let size = written.parse::<i64>().ok().filter(|e| *e <= MAX_EXPONENT);
            let size = size.ok_or(NumberError { at, kind: NumberErrorKind::ExponentTooLarge })?;
            exponent += if negative { -size } else { size };
        }
        let mantissa: BigInt =
            digits.parse().map_err(|_| self.error(NumberErrorKind::Expected("digits")))?;
        // |exponent| <= MAX_EXPONENT + max_digits fits u32 by the tests above.
        let power = BigInt::from(10).pow(u32::try_from(exponent.unsigned_abs()).unwrap_or(0));
        Ok(Exact::Rational(if exponent < 0 {
            BigRational::new(mantissa, power)
        } else {
            BigRational::from_integer(mantissa * power)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(input: &str) -> String {
        match Exact::parse(input, 1000) {
            Ok(value) => value.to_string(),
            Err(error) => panic!("{input}: {error}"),
        }
    }

    #[test]
    fn decimals_are_taken_as_written() {
        assert_eq!(text("310.25"), "1241/4");
        assert_eq!(text("0.1"), "1/10");
        assert_eq!(text("-73"), "-73");
        assert_eq!(text("1e-3"), "1/1000");
        assert_eq!(text("1.5E+2"), "150");
        assert_eq!(text("- 1 / 3"), "-1/3");
        assert_eq!(text("2-3-4"), "-5");
        assert_eq!(text("12/4/3"), "1");
        assert_eq!(text("sqrt(9/16)"), "3/4");
    }

    #[test]
    fn printed_form_parses_back_to_the_same_tree() {
        for input in [
            "174.75*sqrt(3)/2",
            "-sqrt(2)*3",
            "-(sqrt(2)*3)",
            "1-(2-sqrt(3))",
            "1/(2/sqrt(3))",
            "sqrt(3)*(3/4)",
            "sqrt(2+sqrt(3))-1/7",
            "2--sqrt(2)",
            "(1-sqrt(2))/(1+sqrt(2))",
            "200/(1/sqrt(18)+1/sqrt(6))",
            "-3/4*sqrt(2)",
            "sqrt(2)*-3/4",
            "sqrt(2)-(-3/4)",
        ] {
            let value = Exact::parse(input, 1000).unwrap();
            assert_eq!(Exact::parse_canonical(&value.to_string()), Ok(value), "{input}");
        }
    }

    #[test]
    fn what_is_not_a_number_is_refused_with_its_place() {
        for (input, at) in [
            ("", 0),
            ("1.", 2),
            (".5", 0),
            ("1e", 2),
            ("1e1001", 2),
            ("1 2", 2),
            ("1+", 2),
            ("(1", 2),
            ("sqrt 2", 5),
            ("sqrt(-1)", 5),
            ("1/0", 2),
            ("1/(sqrt(2)*sqrt(2)-2)", 2),
            ("sqrt(sqrt(2)*sqrt(2)-2)", 5),
            ("nan", 0),
            ("inf", 0),
            ("0x10", 1),
            ("1_000", 1),
            ("３", 0),
        ] {
            let error = Exact::parse(input, 1000).expect_err(input);
            assert_eq!(error.at, at, "{input}: {error}");
        }
        assert!(Exact::parse(&"1".repeat(1001), 1000).is_err());
        assert!(Exact::parse(&"(".repeat(4000), 1000).is_err());
        assert!(Exact::parse(&"-".repeat(4000), 1000).is_err());
        assert!(Exact::parse(&vec!["1"; 300].join("+"), 1000).is_err());
        assert!(Exact::parse(&vec!["1e1000"; 500].join("*"), 1000).is_err());
        assert!(Exact::parse_canonical("2/4").is_err());
        assert!(Exact::parse_canonical("0.5").is_err());
    }
}
