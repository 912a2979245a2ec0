//! Claims, proved, printed, read and checked.

use crate::prover::certify;
use orthocert_kernel::certificate::Certificate;
use orthocert_kernel::check::check;
use orthocert_kernel::claim::MachineClaim;

pub fn claim(text: &str) -> MachineClaim {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Proves, prints, reads back and checks.
fn accepted(text: &str) -> Certificate {
    let certificate = certify(&claim(text), 20_000).expect("a proof");
    let text = certificate.to_text().expect("a text");
    let read = Certificate::read(&text).expect("canonical");
    assert_eq!(read, certificate);
    check(&read).unwrap_or_else(|e| panic!("{e}: {text}"));
    println!("{} bytes, {}", text.len(), &text[..text.len().min(1200)]);
    read
}

#[test]
fn the_prototype() {
    accepted(
        r#"{"mechanism":{"orthoglide":{"offset":"0"}},"workspace":{"cube":{"side":"200"}},
        "require":[{"quantity":"transmission","end":"min","bound":"1/2"},
        {"quantity":"transmission","end":"max","bound":"2"}]}"#,
    );
}

#[test]
fn an_orthoglide_by_its_inverse_kinematics() {
    accepted(
        r#"{"mechanism":{"formulas":{"coordinates":["x","y","z"],
        "parameters":[["l","310.7"]],"definitions":[],
        "joints":[{"rho":"x-sqrt(l^2-y^2-z^2)"},{"rho":"y-sqrt(l^2-x^2-z^2)"},{"rho":"z-sqrt(l^2-x^2-y^2)"}]}},
        "workspace":{"box":{"min":["-72","-72","-72"],"max":["125","125","125"]}},
        "require":[{"quantity":"transmission","end":"min","bound":"0.5"},
        {"quantity":"transmission","end":"max","bound":"2"}]}"#,
    );
}
