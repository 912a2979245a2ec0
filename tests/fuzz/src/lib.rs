//! What the fuzz targets share: the tests' own oracle and edits, and certificates to start from.

#[path = "../../../proofs/checker/tests/adversary/mutation/edits.rs"]
pub mod edits;
#[path = "../../../proofs/checker/tests/adversary/oracle.rs"]
pub mod oracle;
#[path = "../../../proofs/checker/tests/adversary/random.rs"]
pub mod random;
pub mod reader;
#[path = "../../../proofs/checker/tests/adversary/truth.rs"]
pub mod truth;

use oracle::{opinion, Opinion};
use orthocert_checker::statement::statement;
use orthocert_checker::{check, read};

/// Reads and checks a text as `orthocert-check` does. What is accepted has to be stated in words,
/// to be written and read back as it is, and not to look false in floating point.
///
/// # Panics
/// If anything of that is not so.
pub fn examine(bytes: &[u8]) {
    let Ok(certificate) = read(bytes) else { return };
    let text = certificate.to_text().expect("a text");
    assert_eq!(read(text.as_bytes()).as_ref(), Ok(&certificate), "written and read back");
    let Ok(accepted) = check(&certificate) else { return };
    statement(&certificate.claim, accepted.verdict).expect("a statement");
    let mut random = random::Random::new(bytes.len() as u64);
    if let Opinion::Contradicts(reason) = opinion(&certificate, &mut random, 50) {
        panic!("accepted, but {reason}");
    }
}
