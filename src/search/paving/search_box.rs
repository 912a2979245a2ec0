//! A claim with another box in the place of its workspace.

use orthocert_kernel::claim::{MachineClaim, Workspace};
use orthocert_kernel::input::ClaimError;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::prover::written_out;

/// The same machine and requirements, over the box `[min, max]`. Of the paper's cube, whose machine
/// follows from its side and `psi_max`, the machine is written out by Steps 1 to 3.
///
/// # Errors
/// If there is no such claim.
pub fn in_box(
    claim: &MachineClaim,
    min: Vec<Expression>,
    max: Vec<Expression>,
) -> Result<MachineClaim, ClaimError> {
    let mut claim = written_out(claim)?;
    claim.workspace = Workspace::Box { min, max };
    Problem::new(&claim)?;
    Ok(claim)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use crate::search::solver::refute::approximate;
    use orthocert_kernel::claim::{Bound, Leg, Mechanism, Quantity};

    /// Leg length, `a_1`, `d_1` along the guide, and `psi_min`, of a cube of side 200.
    fn numbers(psi_max: &str, offset: &str) -> [f64; 4] {
        let text = format!(
            "[mechanism]\nkind = \"orthoglide\"\noffset = {offset}\n[workspace]\ncube = 200\n\
             [requirements]\ntransmission = {{ max = {psi_max} }}\n"
        );
        let design = Design::parse(&text, "test").unwrap();
        let ends = |x: i64| vec![Expression::integer(x); 3];
        let found = in_box(&design.claim, ends(-10), ends(10)).unwrap();
        let Mechanism::Translational(legs) = found.mechanism else { panic!() };
        let Leg::Slider { anchor, platform, length, .. } = &legs[0] else { panic!() };
        let min = found.require.iter().find_map(|own| match &own.bound {
            Bound::Min(min) => Some(Quantity::Exactly(min.clone())),
            _ => None,
        });
        [length, &anchor[0], &platform[0], &min.unwrap()].map(|q| approximate(q.ends()[0]).unwrap())
    }

    #[test]
    fn the_machine_of_the_cube_is_that_of_steps_1_to_3() {
        for (psi_max, kappa, offset) in [("2", 0.5, "7"), ("1.25", 0.8, "0"), ("4", 0.25, "-3")] {
            let t1 = (1.0 - kappa) / 2.0;
            let t2 = if kappa <= 0.5 { 1.0 - kappa } else { (1.0 / kappa - 1.0) / 2.0 };
            let [q1, q2] = [-t1, t2].map(|t: f64| t / (1.0 + 2.0 * t * t).sqrt());
            let (length, e): (f64, f64) = (200.0 / (q2 - q1), offset.parse().unwrap());
            let expected = [length, q1 * length - e - length, -e, kappa];
            let found = numbers(psi_max, offset);
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{psi_max}: {found}, {expected}");
            }
        }
        // The paper's prototype.
        assert!((numbers("2", "0")[0] - 310.582_854_123_025).abs() < 1e-9);
    }
}
