//! What `#if` asks: C's integer expressions with Marlin's `ENABLED` and its relatives.

use super::macros::{Body, Doubt, Macros, Place, Problem, Truth};
use super::source::Token;

/// Whether a condition holds. One that is no expression depends on itself.
pub(super) fn holds(macros: &Macros, tokens: &[Token], at: Place<'_>) -> Truth {
    let mut items = Vec::new();
    let doubt = || at.doubt("a condition that is not understood");
    match resolve(macros, tokens, at, &mut Vec::new(), &mut items) {
        Ok(()) => {}
        Err(Problem::Depends(doubt)) => return Truth::Unknown(doubt),
        Err(Problem::TooLong) => return Truth::Unknown(doubt()),
    }
    let mut parser = Parser { items: &items, at: 0, depth: 0 };
    match parser.conditional() {
        Some(value) if parser.at == items.len() => value.truth(),
        _ => Truth::Unknown(doubt()),
    }
}

/// An operand or an operator.
enum Item {
    Value(Value),
    Sign(&'static str),
}

/// A value, if it is known.
#[derive(Clone)]
enum Value {
    Integer(i64),
    Unknown(Doubt),
}

impl Value {
    fn of(truth: Truth) -> Value {
        match truth {
            Truth::Yes => Value::Integer(1),
            Truth::No => Value::Integer(0),
            Truth::Unknown(doubt) => Value::Unknown(doubt),
        }
    }

    fn truth(self) -> Truth {
        match self {
            Value::Integer(value) => Truth::of(value != 0),
            Value::Unknown(doubt) => Truth::Unknown(doubt),
        }
    }
}

/// Replaces macros and evaluates what takes names as they are: `defined`, `ENABLED` and the like.
fn resolve<'a>(
    macros: &'a Macros,
    tokens: &'a [Token],
    at: Place<'_>,
    within: &mut Vec<&'a str>,
    items: &mut Vec<Item>,
) -> Result<(), Problem> {
    let mut rest = tokens;
    while let [token, after @ ..] = rest {
        macros.count()?;
        rest = after;
        let name = match token {
            Token::Sign(sign) => {
                items.push(Item::Sign(sign));
                continue;
            }
            Token::Number(text) => {
                let doubt = || Value::Unknown(at.doubt(text));
                items.push(Item::Value(integer(text).map_or_else(doubt, Value::Integer)));
                continue;
            }
            Token::Other(text) => {
                items.push(Item::Value(Value::Unknown(at.doubt(text))));
                continue;
            }
            Token::Name(name) => name.as_str(),
        };
        if let ("defined", [Token::Name(asked), after @ ..]) = (name, rest) {
            items.push(Item::Value(Value::of(macros.defined(asked, at))));
            rest = after;
            continue;
        }
        let body = macros.get(name).map(|found| &found.body);
        let called = match body {
            None | Some(Body::Function) => arguments(macros, rest)?,
            _ => None,
        };
        if let Some([names, after]) = called {
            items.push(Item::Value(Value::of(function(macros, name, names, at))));
            rest = after;
            continue;
        }
        match body {
            Some(Body::Tokens(body)) if !within.contains(&name) => {
                if within.len() == 64 {
                    return Err(Problem::TooLong);
                }
                within.push(name);
                resolve(macros, body, at, within, items)?;
                within.pop();
            }
            Some(Body::Depends(doubt)) => {
                items.push(Item::Value(Value::Unknown(doubt.clone())));
            }
            _ => {
                let value = match name {
                    "true" => Value::Integer(1),
                    "false" => Value::Integer(0),
                    name if macros.is_option(name) => Value::Integer(0),
                    name => Value::Unknown(at.doubt(name)),
                };
                items.push(Item::Value(value));
            }
        }
    }
    Ok(())
}

/// What is between the parentheses that open at the start of `tokens`, and what follows them.
fn arguments<'a>(
    macros: &Macros,
    tokens: &'a [Token],
) -> Result<Option<[&'a [Token]; 2]>, Problem> {
    let mut depth = 0usize;
    for (at, token) in tokens.iter().enumerate() {
        macros.count()?;
        match token {
            Token::Sign("(") => depth += 1,
            _ if depth == 0 => return Ok(None),
            Token::Sign(")") => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Ok(Some([&tokens[1..at], &tokens[at + 1..]]));
        }
    }
    Ok(None)
}

/// Marlin's core/macros.h.
fn function(macros: &Macros, name: &str, names: &[Token], at: Place<'_>) -> Truth {
    let asked: Option<Vec<&str>> = names
        .split(|token| *token == Token::Sign(","))
        .map(|argument| match argument {
            [Token::Name(name)] => Some(name.as_str()),
            _ => None,
        })
        .collect();
    let Some(asked) = asked else { return Truth::Unknown(at.doubt(name)) };
    let enabled = |name: &&str| macros.enabled(name, at);
    let all = || asked.iter().fold(Truth::Yes, |truth, name| truth.and(|| enabled(name)));
    let any = || asked.iter().fold(Truth::No, |truth, name| truth.or(|| enabled(name)));
    match (name, &asked[..]) {
        ("defined", [name]) => macros.defined(name, at),
        ("ENABLED" | "ALL" | "BOTH", _) => all(),
        ("ANY" | "EITHER", _) => any(),
        ("DISABLED" | "NONE", _) => any().not(),
        _ => Truth::Unknown(at.doubt(name)),
    }
}

/// An integer constant.
fn integer(text: &str) -> Option<i64> {
    let text = text.trim_end_matches(['u', 'U', 'l', 'L']);
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => i64::from_str_radix(digits, 16).ok(),
        None if text.len() > 1 && text.starts_with('0') => i64::from_str_radix(text, 8).ok(),
        None => text.parse().ok(),
    }
}

struct Parser<'a> {
    items: &'a [Item],
    at: usize,
    depth: usize,
}

/// Binary operators by precedence, the loosest first.
const LEVELS: [&[&str]; 10] = [
    &["||"],
    &["&&"],
    &["|"],
    &["^"],
    &["&"],
    &["==", "!="],
    &["<", ">", "<=", ">="],
    &["<<", ">>"],
    &["+", "-"],
    &["*", "/", "%"],
];

impl Parser<'_> {
    fn sign(&mut self, among: &[&str]) -> Option<&'static str> {
        match self.items.get(self.at) {
            Some(Item::Sign(sign)) if among.contains(sign) => {
                self.at += 1;
                Some(sign)
            }
            _ => None,
        }
    }

    fn conditional(&mut self) -> Option<Value> {
        self.depth += 1;
        if self.depth > 64 {
            return None;
        }
        let condition = self.binary(0)?;
        let value = match self.sign(&["?"]) {
            None => condition,
            Some(_) => {
                let yes = self.conditional()?;
                self.sign(&[":"])?;
                let no = self.conditional()?;
                match condition.truth() {
                    Truth::Yes => yes,
                    Truth::No => no,
                    Truth::Unknown(doubt) => Value::Unknown(doubt),
                }
            }
        };
        self.depth -= 1;
        Some(value)
    }

    fn binary(&mut self, level: usize) -> Option<Value> {
        let Some(signs) = LEVELS.get(level) else { return self.unary() };
        let mut value = self.binary(level + 1)?;
        while let Some(sign) = self.sign(signs) {
            let right = self.binary(level + 1)?;
            value = combined(value, sign, right);
        }
        Some(value)
    }

    fn unary(&mut self) -> Option<Value> {
        let mut signs = Vec::new();
        while let Some(sign) = self.sign(&["!", "-", "+", "~"]) {
            signs.push(sign);
        }
        let mut value = match self.items.get(self.at)? {
            Item::Value(value) => {
                self.at += 1;
                value.clone()
            }
            Item::Sign(_) => {
                self.sign(&["("])?;
                let value = self.conditional()?;
                self.sign(&[")"])?;
                value
            }
        };
        for sign in signs.into_iter().rev() {
            value = match (sign, value) {
                ("!", value) => Value::of(value.truth().not()),
                ("-", Value::Integer(value)) => Value::Integer(value.checked_neg()?),
                ("~", Value::Integer(value)) => Value::Integer(!value),
                (_, value) => value,
            };
        }
        Some(value)
    }
}

fn combined(left: Value, sign: &str, right: Value) -> Value {
    match sign {
        "&&" => return Value::of(left.truth().and(|| right.truth())),
        "||" => return Value::of(left.truth().or(|| right.truth())),
        _ => {}
    }
    let (a, b) = match (left, right) {
        (Value::Integer(a), Value::Integer(b)) => (a, b),
        (Value::Unknown(doubt), _) | (_, Value::Unknown(doubt)) => return Value::Unknown(doubt),
    };
    let shift = u32::try_from(b).ok();
    let value = match sign {
        "|" => Some(a | b),
        "^" => Some(a ^ b),
        "&" => Some(a & b),
        "==" => Some((a == b).into()),
        "!=" => Some((a != b).into()),
        "<" => Some((a < b).into()),
        ">" => Some((a > b).into()),
        "<=" => Some((a <= b).into()),
        ">=" => Some((a >= b).into()),
        "<<" => shift.and_then(|by| a.checked_shl(by)),
        ">>" => shift.and_then(|by| a.checked_shr(by)),
        "+" => a.checked_add(b),
        "-" => a.checked_sub(b),
        "*" => a.checked_mul(b),
        "/" => a.checked_div(b),
        _ => a.checked_rem(b),
    };
    let nowhere = Doubt { name: format!("{a} {sign} {b}"), file: String::new(), line: 0 };
    value.map_or(Value::Unknown(nowhere), Value::Integer)
}
