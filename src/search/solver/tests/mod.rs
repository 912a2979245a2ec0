//! The prover of the kernel's claims.

mod extremes;
mod kinds;
mod machines;
mod reports;
mod verdicts;

use super::sample::{Place, Quality, Sampler};
use super::*;
use machines::*;
use orthocert_kernel::certificate::Failure;
use orthocert_kernel::claim::{Bound, Requirement};
use orthocert_kernel::number::Expression;
use std::sync::atomic::AtomicBool;

fn with_boxes(claim: &MachineClaim, max_boxes: usize) -> Verification {
    let budget = Budget { max_boxes, deadline: None };
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    verify(claim, budget, &mut control).expect("a claim")
}

fn decided(claim: &MachineClaim) -> (Certificate, Accepted) {
    match with_boxes(claim, 20_000).answer {
        Answer::Decided { certificate, accepted } => {
            let text = certificate.to_text().expect("a text");
            assert_eq!(orthocert_checker::read(text.as_bytes()), Ok((*certificate).clone()));
            (*certificate, accepted)
        }
        other => panic!("{other:?}"),
    }
}

/// psi at its least and greatest, as sampled.
fn psi(claim: &MachineClaim) -> [f64; 2] {
    let claim = with_psi(claim, 1.0, 1.0);
    let problem = Problem::new(&claim).expect("a claim");
    let sampler = Sampler::new(&claim, &problem).expect("numbers");
    let angular = problem.legs.iter().any(|leg| leg.is_angular());
    let unit = if angular { sampler.unit() } else { 1.0 };
    let worst = sampler.worst_values(30);
    let found = worst.iter().filter(|found| matches!(found.quality, Quality::Obligation(_)));
    let all: Vec<[f64; 2]> =
        found.map(|found| sampler.xi(&sampler.at(&found.place)).expect("reached")).collect();
    let least = all.iter().map(|xi| xi[0]).fold(f64::INFINITY, f64::min);
    let greatest = all.iter().map(|xi| xi[1]).fold(0.0, f64::max);
    [unit / greatest, unit / least]
}

/// The claim with both bounds on psi, so much beyond the extremes.
fn beyond(claim: &MachineClaim, part: f64) -> MachineClaim {
    let [least, greatest] = psi(claim);
    with_psi(claim, least * (1.0 - part), greatest * (1.0 + part))
}
