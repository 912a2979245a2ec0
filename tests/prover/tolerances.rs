//! Tolerances so wide that they are halved: what is certified is true of sampled machines.

use super::{claim, verdict, verified, Random};
use orthocert::search::solver::Answer;
use orthocert_checker::certificate::{Proof, Verdict};

const DESIGN: &str = include_str!("../designs/kernel/five-bar.toml");

/// The least and the greatest velocity transmission factor of the five-bar at a point, in length per radian.
fn psi([x, y]: [f64; 2], lengths: [f64; 2]) -> [f64; 2] {
    // Elbows are outward of the lines from the anchors to the point.
    let row = |(anchor, length, outward): (f64, f64, f64)| {
        let (dx, dy) = (x - anchor, y);
        let distance = dx.hypot(dy);
        let along = (distance * distance + 90.0 * 90.0 - length * length) / (2.0 * distance);
        let off = (90.0f64 * 90.0 - along * along).sqrt() * outward;
        let [ex, ey] = [along * dx - off * dy, along * dy + off * dx].map(|e| e / distance);
        let rod = [dx - ex, dy - ey];
        let lever = rod[1] * ex - rod[0] * ey;
        rod.map(|r| r / lever)
    };
    let [[a, b], [c, d]] = [(-59.0, lengths[0], 1.0), (59.0, lengths[1], -1.0)].map(row);
    let (trace, det) = (a * a + b * b + c * c + d * d, (a * d - b * c).abs());
    let root = (trace * trace - 4.0 * det * det).max(0.0).sqrt();
    [(0.5 * (trace + root)).sqrt().recip(), (0.5 * (trace + root)).sqrt() / det]
}

#[test]
fn a_five_bar_with_rods_of_any_length_within_a_fifth() {
    let with = |t: &str| DESIGN.replace("± 0.01", &format!("± {t}"));
    let found = verified(&claim(&with("20")), 20_000);
    assert_eq!(verdict(&found), Some(Verdict::Certified));
    let Answer::Decided { certificate, .. } = &found.answer else { unreachable!() };
    let Proof::Tree(tree) = &certificate.proof else { panic!("a tree") };
    let of_tolerances = tree.nodes.iter().filter(|node| node.split.is_some_and(|k| k >= 2));
    assert!(of_tolerances.count() > 4 && tree.nodes.len() < 400, "{}", tree.nodes.len());
    assert_eq!(verdict(&verified(&claim(&with("23")), 20_000)), Some(Verdict::Refuted));
    let mut random = Random(11);
    let mut extremes = |t: f64| {
        let mut all = [f64::MAX, 0.0f64];
        for _ in 0..40_000 {
            let mut part = |lo: f64, hi: f64| match random.within(0, 2) {
                0 => lo,
                1 => hi,
                _ => lo + (hi - lo) * random.within(0, 1000) as f64 / 1000.0,
            };
            let point = [part(-20.0, 20.0), part(110.0, 150.0)];
            let lengths = [part(110.0 - t, 110.0 + t), part(110.0 - t, 110.0 + t)];
            let [least, greatest] = psi(point, lengths);
            all = [all[0].min(least), all[1].max(greatest)];
        }
        all
    };
    let [least, greatest] = extremes(20.0);
    assert!(least > 50.0 && greatest < 300.0, "{least} {greatest}");
    // The refuted one is so by what sampling finds too, and so is where the middle of both is refuted.
    assert!(extremes(23.0)[0] < 50.0);
}
