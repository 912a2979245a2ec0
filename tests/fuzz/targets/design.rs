//! Any text as a design file: what is read states a claim that the checker reads back as it is,
//! and whatever is wrong is said in a few printable words.
#![no_main]

use libfuzzer_sys::fuzz_target;
use orthocert::design::Design;
use orthocert_checker::certificate::{Claim, Verdict};
use orthocert_checker::statement::statement;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let design = match Design::parse(text, "design.toml") {
        Ok(design) => design,
        Err(error) => {
            let message = error.to_string();
            let clean = !message.chars().any(|c| c.is_control() && c != '\n');
            assert!(clean && message.len() < 4000, "{message:?}");
            return;
        }
    };
    let claim = &design.claim;
    let written = serde_json::to_string(claim).expect("a text");
    let again = serde_json::from_str(&written);
    assert_eq!(again.ok().as_ref(), Some(claim), "{written}");
    let claim = Claim::Machine(design.claim.clone());
    assert!(!statement(&claim, Verdict::Certified).is_empty());
});
