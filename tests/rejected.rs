//! The schema against the broken certificates of tests/rejected, which the checker's own tests hold
//! to their reasons: a text that is not of the format's shape fails the schema too, but for what no
//! schema can say.

#[path = "../proofs/checker/tests/rejected/broken.rs"]
mod broken;

use crate::schema;
use broken::Broken;
use orthocert_checker::{read, Rejected};

/// Beginnings of the names of files of the right shape that are refused when they are read.
const BEYOND_A_SCHEMA: [&str; 12] = [
    // To a schema, the value of a key that stands twice is one of the two.
    "duplicate-",
    // To a schema, 64.0 is an integer.
    "precision-float",
    "precision-exponent",
    "quaternion-of-floats",
    // Two texts for one quantity.
    "equal-ends-as-a-tolerance",
    // Numbers that are not in canonical form, too large, or not numbers.
    "number-divided-by-",
    "number-fraction-of-one",
    "number-leading-zero",
    "number-n",
    "number-r",
    "number-too-many-",
    "number-un",
];

#[test]
fn what_is_not_of_the_shape_fails_the_schema_or_is_beyond_it() {
    let (mut failing, mut beyond) = (0, 0);
    for Broken { name, bytes, .. } in broken::all() {
        let Ok(value) = serde_json::from_slice(&bytes) else { continue };
        if !matches!(read(&bytes), Err(Rejected::Syntax(_) | Rejected::Format(_))) {
            continue;
        }
        if schema::objection(&value).is_some() {
            failing += 1;
        } else {
            let known = BEYOND_A_SCHEMA.iter().any(|start| name.starts_with(start));
            assert!(known, "{name}: the schema holds");
            beyond += 1;
        }
    }
    assert!(failing > 60 && beyond > 20, "{failing} fail the schema, {beyond} are beyond it");
}
