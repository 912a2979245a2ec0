//! The prover of the kernel's claims.

mod machines;

use super::*;
use machines::*;
use orthocert_kernel::claim::{Bound, Requirement};
use orthocert_kernel::number::Expression;
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

#[test]
fn look() {
    use crate::report::{text, Report};
    let five = formulas(&["x", "y"], &[("u", "x+400"), ("v", "x-400"), ("a", "u^2+y^2")],
        &["sqrt(u^2+y^2)", "sqrt(v^2+y^2)"], r#"{"box":{"min":["-100","200"],"max":["100","400"]}}"#);
    let mut tol = orthoglide(r#"{"min":"311","max":"312"}"#, CUBE);
    tol.require = vec![
        require("transmission", Bound::Max(number(2.0))),
        require("transmission", Bound::Min(number(0.5))),
        require("serial_margin", Bound::Min(number(0.5))),
        require("leg_angle", Bound::Max(number(60.0))),
        require("parallel_margin", Bound::Min(number(0.2))),
        require("conditioning", Bound::Max(number(3.5))),
        require("joint_range", Bound::Max(number(0.5))),
        ];
    tol.require.push(Requirement { given: [("tool".to_owned(), vec![Expression::integer(10)])].into(), ..require("joint_speed", Bound::Max(number(30.0))) });
    let mut fine = tol.clone(); fine.require.retain(|r| r.quantity != "joint_range");
    let mut psi = tol.clone(); psi.require = vec![require("transmission", Bound::Max(number(1.8)))];
    let mut cond = tol.clone(); cond.require = vec![require("conditioning", Bound::Max(number(2.2)))];
    let mut speed = tol.clone(); speed.require.retain(|r| r.quantity == "joint_speed"); speed.require[0].bound = Bound::Max(number(15.0));
    let mut tie = orthoglide("\"310.7\"", CUBE); tie.require = vec![require("transmission", Bound::Max(number(1.998)))];
    let far = with_psi(&linear_delta(r#"{"box":{"min":["-300","-60","0"],"max":["60","60","1"]}}"#), 0.1, 10.0);
    for claim in [tol, fine, psi, cond, speed, tie, five, far, with_psi(&rotary(), 1.0, 30.0)] {
        let started = Instant::now();
        let found = decided(&claim);
        let ms = started.elapsed().as_secs_f64() * 1e3;
        let report = Report::of_kernel(&claim, &found, started.elapsed()).expect("a report");
        println!("{ms:.1} + {:.1} ms", started.elapsed().as_secs_f64() * 1e3 - ms);
        println!("{}", text::report(&report, text::Style::Plain));
    }
}

#[test]
fn bounds() {
    let five = formulas(&["x", "y"], &[], &["sqrt((x+400)^2+y^2)", "sqrt((x-400)^2+y^2)"], r#"{"box":{"min":["-100","200"],"max":["100","400"]}}"#);
    for claim in [orthoglide("\"310.7\"", CUBE), linear_delta(CYLINDER), four_struts(), five, orthoglide(r#"{"min":"311","max":"312"}"#, CUBE), rotary()] {
        let budget = Budget { max_boxes: 20_000, deadline: None };
        let cancel = AtomicBool::new(false);
        let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
        let legs = Problem::new(&claim).unwrap().legs.len();
        for extreme in extremes::Extreme::of(&claim, legs) {
            let started = Instant::now();
            let width = num_rational::BigRational::new(1.into(), 1_000_000.into());
            let found = extremes::enclose(&claim, &extreme, &width, budget, &mut control);
            let ms = started.elapsed().as_secs_f64() * 1e3;
            match found {
                Ok(f) => println!("{} {} {} .. {} width {} boxes {} {ms:.0} ms", extreme.quantity(), extreme.is_greatest(), f.inner, f.outer, f.width, f.boxes),
                Err(e) => println!("{} {}: {e} {ms:.0} ms", extreme.quantity(), extreme.is_greatest()),
            }
        }
    }
}
