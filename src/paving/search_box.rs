//! A claim with another box in the place of its workspace.

use orthocert_checker::claim::{
    ClaimError, Leg, MachineClaim, Mechanism, Quantity, Range, WorkingMode, Workspace,
};
use orthocert_checker::model::CubeConstants;
use orthocert_checker::number::{Exact, NumberErrorKind};
use std::array::from_fn;
use std::cmp::Ordering;

/// Why a claim has no such box.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SearchBoxError {
    /// On this axis the lower end is not provably less than the upper one.
    #[error("along {0} the first number is not less than the second")]
    Empty(&'static str),
    /// The machine's numbers cannot be made explicit.
    #[error("the machine of the cube cannot be written out: {0}")]
    Machine(ClaimError),
}

/// The same machine and requirements, over the box `[min, max]`.
///
/// Of the paper's cube, whose machine follows from its side and `psi_max`, the machine is written
/// out by Steps 1 to 3, with `q_1`, `q_2` for `L = 1`:
///
/// `L = side/(q_2 - q_1)`, `a = q_1 L - e - L`, `n_i = e_i`, `a_i = a e_i`, `d_i = -e e_i`,
/// `eta_i > 0`, `psi_min = 1/psi_max`.
///
/// # Errors
/// [`SearchBoxError`].
pub fn in_box(
    claim: &MachineClaim,
    min: [Exact; 3],
    max: [Exact; 3],
) -> Result<MachineClaim, SearchBoxError> {
    let less = |k: &usize| min[*k].compare(&max[*k]) == Some(Ordering::Less);
    if let Some((_, axis)) = (0..3).zip(["x", "y", "z"]).find(|(k, _)| !less(k)) {
        return Err(SearchBoxError::Empty(axis));
    }
    let mut claim = match (&claim.mechanism, &claim.workspace) {
        (Mechanism::Orthoglide { offset }, Workspace::Cube { side }) => {
            written_out(claim, offset, side).map_err(SearchBoxError::Machine)?
        }
        _ => claim.clone(),
    };
    claim.workspace = Workspace::Box { min, max };
    claim.validate().map_err(SearchBoxError::Machine)?;
    Ok(claim)
}

fn written_out(
    claim: &MachineClaim,
    offset: &Exact,
    side: &Exact,
) -> Result<MachineClaim, ClaimError> {
    let too_large = |_: NumberErrorKind| ClaimError::Precision("workspace.cube".to_owned());
    let psi_max = claim.requirements.transmission.as_ref().and_then(|range| range.max.as_ref());
    let psi_max = psi_max.ok_or(ClaimError::CubeNeedsPsiMax)?;
    let CubeConstants { t1, q2, .. } = CubeConstants::new(psi_max, side)?;
    let one = Exact::integer(1);
    let numbers = || {
        // -q_1 = t_1 / sqrt(1 + 2 t_1^2), which makes shorter expressions than q_1.
        let square = t1.clone().times(t1.clone())?.times(Exact::integer(2))?;
        let minus_q1 = t1.over(one.clone().plus(square)?.root()?)?;
        let length = side.clone().over(q2.plus(minus_q1.clone())?)?;
        let end = minus_q1.times(length.clone())?.plus(offset.clone())?.plus(length.clone())?;
        Ok((length, end.negated(), one.clone().over(psi_max.clone())?))
    };
    let (length, base, psi_min) = numbers().map_err(too_large)?;
    let along = |axis: usize, x: &Exact| -> [Quantity; 3] {
        from_fn(|k| Quantity::exactly(if k == axis { x.clone() } else { Exact::integer(0) }))
    };
    let leg = |axis: usize| Leg::Slider {
        direction: along(axis, &one),
        anchor: along(axis, &base),
        platform: along(axis, &offset.clone().negated()),
        length: Quantity::exactly(length.clone()),
        mode: WorkingMode::Plus,
    };
    let mut requirements = claim.requirements.clone();
    requirements.transmission = Some(Range { min: Some(psi_min), max: Some(psi_max.clone()) });
    Ok(MachineClaim {
        mechanism: Mechanism::Translational(from_fn(leg)),
        workspace: claim.workspace.clone(),
        requirements,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decimal::approximate;
    use crate::design::Design;

    /// Leg length, `a_1`, `d_1` along the guide, and `psi_min`, of a cube of side 200.
    fn numbers(psi_max: &str, offset: &str) -> [f64; 4] {
        let text = format!(
            "[mechanism]\nkind = \"orthoglide\"\noffset = {offset}\n[workspace]\ncube = 200\n\
             [requirements]\ntransmission = {{ max = {psi_max} }}\n"
        );
        let claim = Design::parse(&text, "test").unwrap().rules.unwrap();
        let ends = |x: i64| from_fn(|_| Exact::integer(x));
        let found = in_box(&claim, ends(-10), ends(10)).unwrap();
        let Mechanism::Translational([Leg::Slider { anchor, platform, length, .. }, ..]) =
            found.mechanism
        else {
            panic!()
        };
        let psi_min = found.requirements.transmission.unwrap().min.unwrap();
        [&length.min, &anchor[0].min, &platform[0].min, &psi_min].map(|x| approximate(x).unwrap())
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
