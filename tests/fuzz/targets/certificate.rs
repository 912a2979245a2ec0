//! Good certificates with any number of edits, each of any value: a byte chooses the certificate,
//! two or three the place and the edit.
#![no_main]

use libfuzzer_sys::fuzz_target;
use num_rational::BigRational;
use orthocert::exact::arithmetic::number;
use orthocert_checker::certificate::Certificate;
use orthocert_fuzz::edits::{edits, paths};
use orthocert_fuzz::examine;
use orthocert_fuzz::reader::Reader;
use orthocert_kernel::number::Expression;
use serde_json::{json, Value};

macro_rules! certificates {
    ($($name:literal)*) => {
        [$(include_str!(concat!("../../../proofs/certificates/", $name, ".cert.json"))),*]
    };
}

const CERTIFICATES: [&str; 13] = certificates![
    "orthoglide-prototype" "orthoglide-tolerance" "orthoglide-joint-range" "orthoglide-310"
    "orthoglide-relaxed-1-percent" "tripteron" "upu-struts" "delta-joint-speed"
    "delta-conditioning-refuted" "delta-joint-speed-refuted" "delta-out-of-reach"
    "rotary-delta-angle-refuted" "star-singular"
];

/// The integer or number at a place, moved by what the bytes say.
fn moved(value: &Value, bytes: &mut Reader<'_>) -> Option<Value> {
    let by = i64::from(bytes.byte() as i8);
    if let Some(n) = value.as_i64() {
        return Some(json!(n.checked_add(by.checked_mul(1 << bytes.below(24))?)?));
    }
    let value = Expression::try_from(value.as_str()?.to_owned()).ok()?.rational()?;
    let step = BigRational::new(by.into(), (1_i64 << bytes.below(48)).into());
    Some(json!(number(&(value + step)).to_string()))
}

fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Reader(bytes);
    let text = CERTIFICATES[bytes.below(CERTIFICATES.len())];
    let mut certificate: Value = serde_json::from_str(text).expect("JSON");
    let mut edited = 0;
    while !bytes.is_empty() && edited < 40 {
        edited += 1;
        let mut all = Vec::new();
        paths(&certificate, "", &mut all);
        let path = &all[bytes.below(all.len())];
        let value = certificate.pointer(path).expect("a path of the document");
        let other = if bytes.byte() < 128 {
            moved(value, &mut bytes)
        } else {
            let mut all = edits(value);
            // Edits of the root, and copies of copies, only make a text longer.
            let chosen = (!all.is_empty() && !path.is_empty()).then(|| bytes.below(all.len()));
            chosen.map(|chosen| all.swap_remove(chosen))
        };
        if let Some(other) = other {
            *certificate.pointer_mut(path).expect("a path of the document") = other;
        }
        if certificate.to_string().len() > 1 << 16 {
            return;
        }
    }
    // In the one order that a certificate has.
    if let Ok(certificate) = serde_json::from_value::<Certificate>(certificate) {
        examine(certificate.to_text().expect("a text").as_bytes());
    }
});
