//! Edits of a certificate's text: what any of its values may be replaced by.

use orthocert_checker::number::{Exact, MAX_DIGITS};
use serde_json::{json, Map, Value};

/// The kinds of edits, by what they are done to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A number of the claim or of a point: moved, negated, zero, huge, of an equal value.
    Number,
    /// A number in another notation, or in none.
    Notation,
    /// A number becomes a tolerance, or a tolerance one of its ends.
    Tolerance,
    /// An integer: precision, evidence, the number of a leg.
    Integer,
    /// The axis of a split.
    Axis,
    /// A rule, a violation or their evidence replaced by every other.
    Rule,
    /// A name: drive, mode, sign, corner, face, half, verdict, version.
    Name,
    /// Nodes and steps dropped, doubled, moved.
    Tree,
    /// Elements of other arrays dropped, doubled, moved.
    Array,
    /// Keys missing, renamed, added.
    Key,
    /// A value of another JSON type.
    Type,
    /// The text: cut off, altered byte by byte, keys twice.
    Text,
}

/// An edit: its kind and the value in the place of the former.
pub type Edit = (Kind, Value);

/// Paths (JSON pointers) to every value of a document, in order.
pub fn paths(value: &Value, at: &str, found: &mut Vec<String>) {
    found.push(at.to_owned());
    match value {
        Value::Array(items) => {
            for (i, item) in items.iter().enumerate() {
                paths(item, &format!("{at}/{i}"), found);
            }
        }
        Value::Object(fields) => {
            for (key, item) in fields {
                let key = key.replace('~', "~0").replace('/', "~1");
                paths(item, &format!("{at}/{key}"), found);
            }
        }
        _ => {}
    }
}

/// Everything that the value at a path may be replaced by.
pub fn edits(path: &str, value: &Value) -> Vec<Edit> {
    let mut all: Vec<Edit> =
        [Value::Null, json!([]), json!({}), json!(""), json!(true), json!(1.5)]
            .map(|other| (Kind::Type, other))
            .to_vec();
    match value {
        Value::Number(n) => integers(n.as_i64().unwrap_or(0), &mut all),
        Value::String(text) => strings(path, text, &mut all),
        Value::Array(items) => arrays(path, items, &mut all),
        Value::Object(fields) => objects(path, fields, &mut all),
        _ => {}
    }
    all.retain(|(_, other)| other != value);
    all
}

fn integers(n: i64, all: &mut Vec<Edit>) {
    let near = [1, -1, 2, -2, 7, -7].map(|by| n.saturating_add(by));
    let far = [n.wrapping_neg(), 0, 1, 2, 3, 4, 32, 128, 1024, 1025, n / 2, i64::MAX, i64::MIN];
    let multiples = [2, 10, 40, 1 << 20].map(|by| n.saturating_mul(by));
    all.extend(near.iter().chain(&far).chain(&multiples).map(|n| (Kind::Integer, json!(n))));
    all.push((Kind::Integer, json!(u64::MAX)));
    all.extend([json!(n.to_string()), json!([n]), json!(n as f64)].map(|v| (Kind::Type, v)));
}

/// Every name that the format has in some place, and some that it does not.
const NAMES: [&str; 33] = [
    "x",
    "y",
    "z",
    "Q1",
    "Q2",
    "+",
    "-",
    "q1",
    "q2",
    "low",
    "high",
    "all",
    "slider",
    "strut",
    "arm",
    "planar",
    "certified",
    "refuted",
    "undecided",
    "orthocert/2",
    "orthocert/3",
    "upper",
    "cube",
    "range",
    "serial_margin",
    "parallel_margin",
    "leg_angle",
    "speed",
    "outside",
    "0",
    "1",
    "X",
    "certified ",
];

fn strings(path: &str, text: &str, all: &mut Vec<Edit>) {
    let number = Exact::parse_canonical(text).ok();
    let kind = match () {
        () if path.ends_with("/split") => Kind::Axis,
        () if path.contains("/by/") || path.ends_with("/violates") => Kind::Rule,
        () if number.is_some() => Kind::Notation,
        () => Kind::Name,
    };
    all.extend(NAMES.map(|name| (kind, json!(name))));
    if kind == Kind::Rule {
        all.extend(steps().into_iter().map(|step| (kind, step)));
    }
    let Some(number) = number else {
        all.push((Kind::Name, json!(text.to_uppercase())));
        all.push((Kind::Name, json!(format!("{text} "))));
        all.push((Kind::Name, json!("\u{1b}[2K")));
        all.push((Kind::Name, json!({ text: {} })));
        return;
    };
    for change in MOVES {
        // The text of a number is an operand only in parentheses.
        let moved = Exact::parse(&change.replace('n', &format!("({number})")), MAX_DIGITS);
        all.extend(moved.map(|moved| (Kind::Number, json!(moved.to_string()))));
    }
    all.extend(
        [format!("1{}", "0".repeat(400)), format!("1/1{}", "0".repeat(400))]
            .map(|far| (Kind::Number, json!(far))),
    );
    for form in NOTATIONS {
        all.push((Kind::Notation, json!(form.replace('n', text))));
    }
    all.push((Kind::Notation, json!("(".repeat(100) + text + &")".repeat(100))));
    all.push((Kind::Notation, json!("9".repeat(MAX_DIGITS + 1))));
    all.push((Kind::Type, json!(1)));
    for (low, high) in [("n-1/1000", "n+1/1000"), ("n", "n+1"), ("n-1", "n"), ("n+1", "n-1")] {
        let end =
            |form: &str| Exact::parse(&form.replace('n', &format!("({number})")), MAX_DIGITS).ok();
        if let (Some(low), Some(high)) = (end(low), end(high)) {
            let wide = json!({"min": low.to_string(), "max": high.to_string()});
            all.push((Kind::Tolerance, wide));
        }
    }
    all.push((Kind::Tolerance, json!({"min": text, "max": text})));
}

/// What becomes of a number `n`.
const MOVES: [&str; 24] = [
    "n+1",
    "n-1",
    "n+1/1000",
    "n-1/1000",
    "n+1/1000000",
    "n-1/1000000",
    "n+1/1000000000000000000",
    "n-1/1000000000000000000",
    "n*2",
    "n/2",
    "n*3",
    "n*(-1)",
    "n*1.01",
    "n*0.99",
    "n*1000000",
    "n/1000000",
    "n*1e60",
    "n*1e-60",
    "n*sqrt(2)",
    "sqrt(n)",
    "1/n",
    "0",
    "n+sqrt(2)-1.414213562373095",
    "n*sqrt(3)/sqrt(3)",
];

/// Texts for `n` that are not canonical, and some that are no numbers.
const NOTATIONS: [&str; 16] = [
    "+n",
    " n",
    "n ",
    "n.0",
    "ne0",
    "0n",
    "n/1",
    "2*n/2",
    "(n)",
    "--n",
    "n+0",
    "n/0",
    "sqrt(0-1)",
    "sqrt(n",
    "n,5",
    "\u{ff11}",
];

/// Every rule with some evidence, and what is no rule.
pub fn steps() -> Vec<Value> {
    let rotation = |sign: &str| json!({"q": [1, 0, 0, 0], "sign": sign});
    let names =
        ["upper", "cube", "range", "serial_margin", "parallel_margin", "leg_angle", "speed"];
    let mut all: Vec<Value> = names.map(|name| json!(name)).to_vec();
    all.extend(["outside", "lower", "none"].map(|name| json!(name)));
    all.extend(["Q1", "Q2"].map(|corner| json!({ "corner": corner })));
    all.extend(["Q1", "Q2"].map(|corner| json!({ "edge": corner })));
    all.extend(["+", "-"].map(|sign| json!({ "lower": rotation(sign) })));
    all.extend(["+", "-"].map(|sign| json!({ "entrywise": rotation(sign) })));
    for mu in [[1i64 << 39, 0, 0, 0], [1 << 36, 0, 0, 0], [0, 0, 0, 0], [i64::MAX, 0, 0, 0]] {
        all.push(json!({"conditioning": {"rotation": rotation("+"), "mu": mu}}));
    }
    all
}

/// Every violation with some evidence.
fn violations() -> Vec<Value> {
    let mut all = vec![json!("parallel_margin")];
    for v in [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [1, -1, 0], [0, 0, 0]] {
        all.push(json!({"sigma_min": {"vector": v}}));
        all.push(json!({"sigma_max": {"vector": v}}));
        all.push(json!({"conditioning": {"u": [1, 1, 1], "v": v}}));
    }
    for leg in 0..5 {
        for name in ["reach", "joint_range", "serial_margin", "leg_angle", "joint_speed"] {
            all.push(json!({ name: {"leg": leg} }));
        }
    }
    all.push(json!({"singular": {"other": ["0", "0", "0"]}}));
    all
}

/// The `i`-th element removed, doubled, or exchanged with the next.
fn arrays(path: &str, items: &[Value], all: &mut Vec<Edit>) {
    let tree = path.ends_with("/nodes") || path.ends_with("/by") || path.ends_with("/parts");
    let kind = if tree { Kind::Tree } else { Kind::Array };
    let mut add = |items: Vec<Value>| all.push((kind, Value::Array(items)));
    // Of many, one in so many.
    for i in (0..items.len()).step_by(1 + items.len() / 64) {
        let mut less = items.to_vec();
        let item = less.remove(i);
        add(less.clone());
        // Moved anywhere if there are few, else to the ends.
        let few = items.len() <= 12;
        for place in (0..=less.len()).filter(|&n| few || n == 0 || n == less.len()) {
            let mut moved = less.clone();
            moved.insert(place, item.clone());
            add(moved);
        }
        let mut doubled = items.to_vec();
        doubled.insert(i, item);
        add(doubled);
        if i + 1 < items.len() {
            let mut cut = items.to_vec();
            cut.truncate(i);
            add(cut);
        }
    }
    add(items.iter().rev().cloned().collect());
    add([items, items].concat());
    if path.ends_with("/nodes") {
        add([items, &[json!({})]].concat());
        add(items.iter().map(|_| json!({})).collect());
    }
    if path.ends_with("/by") {
        let one = steps().into_iter().map(|step| (Kind::Rule, json!([step])));
        let more = steps().into_iter().map(|step| (Kind::Rule, json!([items, &[step]].concat())));
        all.extend(one.chain(more));
    }
}

fn objects(path: &str, fields: &Map<String, Value>, all: &mut Vec<Edit>) {
    let mut add = |kind: Kind, fields: Map<String, Value>| all.push((kind, Value::Object(fields)));
    for (key, value) in fields {
        let mut less = fields.clone();
        less.remove(key);
        add(Kind::Key, less.clone());
        for name in [key.to_uppercase(), format!("{key} "), format!("{key}s"), String::new()] {
            let mut renamed = less.clone();
            renamed.insert(name, value.clone());
            add(Kind::Key, renamed);
        }
        // The values of two keys exchanged.
        for other in fields.keys().filter(|other| *other > key) {
            let mut exchanged = fields.clone();
            exchanged.insert(key.clone(), fields[other].clone());
            exchanged.insert(other.clone(), value.clone());
            add(Kind::Key, exchanged);
        }
    }
    let mut more = fields.clone();
    more.insert("extra".to_owned(), json!(1));
    add(Kind::Key, more);
    let is_node = path.rsplit_once('/').is_some_and(|(before, _)| before.ends_with("/nodes"));
    if is_node {
        node(fields, all);
    }
    let ends = fields.contains_key("min") || fields.contains_key("max");
    if ends && fields.len() <= 2 {
        all.extend(fields.values().map(|end| (Kind::Tolerance, end.clone())));
    }
    if path.contains("/by/") && fields.len() == 1 {
        all.extend(steps().into_iter().map(|step| (Kind::Rule, step)));
    }
    if path.ends_with("/violates") {
        all.extend(violations().into_iter().map(|violation| (Kind::Rule, violation)));
    }
    if path.ends_with("/requirements") {
        let added = [
            ("transmission", json!({"min": "99/100", "max": "101/100"})),
            ("joint_range", json!([{"min": "0"}, {"min": "0"}, {"min": "0"}])),
            ("conditioning", json!({"max": "101/100"})),
            ("serial_margin", json!({"min": "99/100"})),
            ("parallel_margin", json!({"min": "99/100"})),
            ("leg_angle", json!({"max": "1"})),
            ("joint_speed", json!({"tool": "1", "max": "1/100"})),
        ];
        for (key, requirement) in added {
            let mut more = fields.clone();
            more.insert(key.to_owned(), requirement);
            all.push((Kind::Key, Value::Object(more)));
        }
    }
}

/// A node split on every axis, or no longer; with every rule in the place of its steps.
fn node(fields: &Map<String, Value>, all: &mut Vec<Edit>) {
    for axis in ["x", "y", "z"] {
        let mut split = fields.clone();
        split.insert("split".to_owned(), json!(axis));
        all.push((Kind::Axis, Value::Object(split)));
    }
    for step in steps() {
        let mut by = fields.clone();
        by.insert("by".to_owned(), json!([step]));
        all.push((Kind::Rule, Value::Object(by)));
    }
}

/// The text of a certificate altered without regard for what it means.
pub fn texts(text: &str, mut each: impl FnMut(Vec<u8>)) {
    let bytes = text.as_bytes();
    for at in 0..bytes.len() {
        each(bytes[..at].to_vec());
        each([&bytes[..at], &bytes[at + 1..]].concat());
        each([&bytes[..=at], &bytes[at..]].concat());
        for byte in [b'"', b'0', b'1', b'9', b'-', b',', b'}', b']', b'[', b'{', b' ', 0, 0xff] {
            let mut altered = bytes.to_vec();
            altered[at] = byte;
            each(altered);
        }
    }
    // A key twice, with the same value and with another one.
    for (at, _) in text.match_indices("\":") {
        let start = text[..at].rfind('"').expect("a key has two quotes");
        let key = &text[start..at + 2];
        for value in ["1", "\"1\"", "{}", "[]"] {
            each([&text[..start], key, value, ",", &text[start..]].concat().into_bytes());
        }
    }
    for (before, after) in [("\u{feff}", ""), ("[", "]"), ("", "{}"), ("", "\0"), ("null", "")] {
        each([before, text, after].concat().into_bytes());
    }
}
