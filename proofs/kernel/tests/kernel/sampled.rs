//! Extremes of singular values over the workspace and the orientations, by sampling and descent.

use crate::arithmetic::Random;
use crate::prover::Prover;

/// The least and the greatest singular value of `M` at poses that are found.
pub fn extremes(prover: &Prover<'_>) -> [f64; 2] {
    let ranges = prover.ranges();
    let mut random = Random(17);
    let at = |x: &[f64]| {
        let s = prover.is_inside(x).then(|| prover.matrix(x))??.singular_values();
        Some([s.min(), -s.max()])
    };
    [0, 1].map(|which| {
        let mut starts: Vec<(f64, Vec<f64>)> = Vec::new();
        for sample in 0..20_000u32 {
            let x = ranges.iter().map(|&(low, high)| {
                let t = match sample % 4 {
                    0 => random.below(2) as f64,
                    _ => random.below(1001) as f64 / 1000.0,
                };
                low + t * (high - low)
            });
            let x: Vec<f64> = x.collect();
            starts.extend(at(&x).map(|value| (value[which], x)));
        }
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let refined = starts.into_iter().take(6).map(|(mut best, mut x)| {
            let mut step = 0.2;
            while step > 1e-7 {
                let mut moved = false;
                for _ in 0..60 {
                    let y: Vec<f64> = x
                        .iter()
                        .zip(&ranges)
                        .map(|(&x, &(low, high))| {
                            let t = random.below(2001) as f64 / 1000.0 - 1.0;
                            (x + t * step * (high - low)).clamp(low, high)
                        })
                        .collect();
                    if let Some(value) = at(&y).filter(|value| value[which] < best) {
                        (best, x, moved) = (value[which], y, true);
                    }
                }
                if !moved {
                    step /= 2.0;
                }
            }
            best
        });
        refined.fold(f64::MAX, f64::min).abs()
    })
}
