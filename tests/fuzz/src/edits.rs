//! Edits of a certificate's text: what any of its values may be replaced by.

use serde_json::{json, Value};

/// Names that stand for something in some certificate.
const NAMES: &[&str] = &[
    "certified",
    "refuted",
    "test",
    "divided",
    "negative",
    "cube",
    "outside",
    "chords",
    "mirror",
    "lower",
    "lower_divided",
    "rank",
    "conditioning",
    "accuracy",
    "direction",
    "tolerances",
    "fan",
    "between",
    "corner",
    "inside",
    "turned",
    "control",
    "reach",
    "obligation",
    "row",
    "same",
    "singular",
    "dependent",
    "min",
    "max",
    "within",
    "holds",
    "transmission",
    "joint_range",
    "serial_margin",
    "parallel_margin",
    "leg_angle",
    "joint_speed",
    "stiffness",
    "one_to_one",
    "slider",
    "strut",
    "arm",
    "planar",
    "Q1",
    "Q2",
    "+",
    "-",
];

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

/// Everything that a value may be replaced by: what it is near to, what might stand there as well.
pub fn edits(value: &Value) -> Vec<Value> {
    match value {
        Value::Number(n) => {
            let n = n.as_i64().unwrap_or(0);
            let moved = [0, 1, -1, 32, 64, 1024, i64::MAX, i64::MIN].map(|x| json!(x));
            let near = [n.wrapping_add(1), n.wrapping_sub(1), n.wrapping_neg(), n.wrapping_mul(2)];
            moved.into_iter().chain(near.map(|x| json!(x))).collect()
        }
        Value::String(text) => {
            let forms = ["0", "1", "-1", "1/3", "sqrt(2)", "1/0", "sqrt(-1)"].map(str::to_owned);
            let near = ["0*", "2*", "1/", "-", "sqrt(2)*", "1/3*"].map(|by| format!("{by}{text}"));
            let other =
                forms.into_iter().chain(near).chain(NAMES.iter().copied().map(str::to_owned));
            let tolerance = json!({ "min": text, "max": format!("1+{text}") });
            other.map(Value::String).chain([tolerance]).collect()
        }
        Value::Array(items) => {
            let mut all = vec![json!([])];
            for i in 0..items.len() {
                let mut fewer = items.clone();
                let dropped = fewer.remove(i);
                let mut moved = fewer.clone();
                moved.push(dropped.clone());
                let mut more = items.clone();
                more.insert(i, dropped);
                all.extend([fewer, moved, more].map(Value::Array));
            }
            all
        }
        Value::Object(fields) => {
            let mut all = Vec::new();
            for (key, value) in fields {
                let mut fewer = fields.clone();
                fewer.remove(key);
                all.push(Value::Object(fewer.clone()));
                for &name in NAMES {
                    let mut renamed = fewer.clone();
                    renamed.insert(name.to_owned(), value.clone());
                    all.push(Value::Object(renamed));
                }
            }
            all
        }
        Value::Null | Value::Bool(_) => Vec::new(),
    }
}
