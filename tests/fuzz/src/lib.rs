//! What the fuzz targets share: edits of certificates, and what has to hold of those that are accepted.

pub mod edits;
pub mod reader;

use orthocert::search::solver::sample::{Place, Sampler};
use orthocert_checker::certificate::{Certificate, Claim, Verdict};
use orthocert_checker::statement::statement;
use orthocert_checker::{check, read};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;

/// Machines and points at which a certified claim is looked at.
const PLACES: usize = 50;
/// Margins below this contradict it: beyond what rounding makes.
const CONTRADICTS: f64 = -1e-6;

/// Reads and checks a text as `orthocert-check` does. What is accepted has to be stated in words,
/// to be written and read back as it is, and not to look false in floating point.
///
/// # Panics
/// If anything of that is not so.
pub fn examine(bytes: &[u8]) {
    let Ok(certificate) = read(bytes) else { return };
    let text = certificate.to_text().expect("a text");
    assert_eq!(read(text.as_bytes()).as_ref(), Ok(&certificate), "written and read back");
    let Ok(verdict) = check(&certificate) else { return };
    assert!(!statement(&certificate.claim, verdict).is_empty());
    if let Certificate { claim: Claim::Machine(claim), verdict: Verdict::Certified, .. } =
        &certificate
    {
        is_not_contradicted(claim, bytes.len() as u64);
    }
}

fn is_not_contradicted(claim: &MachineClaim, seed: u64) {
    let problem = Problem::new(claim).expect("an accepted claim");
    let sampler = Sampler::new(claim, &problem).expect("an accepted claim");
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut part = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        // Ends are worst more often than not.
        match state % 4 {
            0 => 0.0,
            1 => 1.0,
            _ => (state >> 11) as f64 / (1u64 << 53) as f64,
        }
    };
    let middle = sampler.centre();
    for _ in 0..PLACES {
        let mut random = |x: &Vec<f64>| x.iter().map(|_| part()).collect();
        let place = Place { u: random(&middle.u), t: random(&middle.t) };
        let values = sampler.at(&place);
        for quality in sampler.qualities() {
            let margin = sampler.margin(quality, &values);
            assert!(margin > CONTRADICTS, "accepted, but {quality:?} is {margin} at {place:?}");
        }
    }
}
