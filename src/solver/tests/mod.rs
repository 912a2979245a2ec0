//! The prover of the kernel's claims.

mod machines;

use super::*;
use machines::*;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

fn decided(claim: &MachineClaim) -> Verification {
    let budget = Budget { max_boxes: 20_000, deadline: None };
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    verify(claim, budget, &mut control).expect("a claim")
}

/// psi at its least and greatest, as sampled.
fn psi(claim: &MachineClaim) -> [f64; 2] {
    let claim = with_psi(claim, 1.0, 1.0);
    let problem = Problem::new(&claim).expect("a claim");
    let sampler = Sampler::new(&claim, &problem).expect("numbers");
    let unit = if problem.legs[0].is_angular() { sampler.unit() } else { 1.0 };
    let worst = sampler.worst_values(30);
    let of = |at: usize| {
        let found = worst.iter().filter(|w| matches!(w.quality, sample::Quality::Obligation(_)));
        let found = found.clone().nth(at).expect("an obligation");
        sampler.xi(&sampler.at(&found.place)).expect("reached")
    };
    let (a, b) = (of(0), of(1));
    let (low, high) = (a[0].min(b[0]), a[1].max(b[1]));
    [unit / high, unit / low]
}

#[test]
fn probe() {
    for (name, claim) in [
        ("linear Delta", linear_delta(SLAB)),
        ("linear Delta, cylinder", linear_delta(CYLINDER)),
        ("struts", struts()),
        ("Orthoglide", orthoglide("\"310.7\"", CUBE)),
        ("four struts", four_struts()),
        ("rotary Delta", rotary()),
    ] {
        let [least, greatest] = psi(&claim);
        for part in [1e-2, 1e-3, 1e-4] {
            let claim = with_psi(&claim, least * (1.0 - part), greatest * (1.0 + part));
            let started = Instant::now();
            let found = decided(&claim);
            let ms = started.elapsed().as_secs_f64() * 1e3;
            let Answer::Decided { certificate, accepted } = found.answer else {
                println!("{name} {part}: {:?}", found.answer);
                continue;
            };
            let started = Instant::now();
            check(&certificate).expect("accepted");
            let checked = started.elapsed().as_secs_f64() * 1e3;
            let bytes = certificate.to_text().expect("a text").len();
            println!("{name} {part}: {:?} {} leaves, {bytes} bytes, {ms:.1} ms, check {checked:.1} ms", accepted.verdict, accepted.size.leaves);
        }
    }
}
