//! The JSON Schema of certificates.

mod kernel;

use jsonschema::Validator;
use serde_json::Value;
use std::sync::OnceLock;

fn validator() -> &'static Validator {
    static VALIDATOR: OnceLock<Validator> = OnceLock::new();
    VALIDATOR.get_or_init(|| {
        let schema = include_str!("../../proofs/certificate.schema.json");
        let schema = serde_json::from_str(schema).expect("the schema is JSON");
        jsonschema::draft202012::new(&schema).expect("the schema is a schema")
    })
}

/// What the schema objects to in a JSON text; `None` if it holds.
pub fn objection(value: &Value) -> Option<String> {
    let error = validator().iter_errors(value).next()?;
    Some(format!("at {}: {error:.300}", error.instance_path()))
}

/// The schema holds for the text of a certificate.
pub fn holds(text: &str, name: &str) {
    let value = serde_json::from_str(text).unwrap_or_else(|error| panic!("{name}: {error}"));
    if let Some(objection) = objection(&value) {
        panic!("{name}: {objection}");
    }
}
