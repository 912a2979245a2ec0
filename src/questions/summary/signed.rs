//! What a designer signs of a certified machine, beside its verdict.

use super::asked::{asked, is_angular, Asked, Question};
use super::{ends, text, tightened, End, Found};
use crate::search::{Budget, Control};
use num_rational::BigRational;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use std::sync::atomic::AtomicBool;

/// Boxes for each width that is tried: few, as a report is to be made in a second or two.
const BOXES: usize = 200;
/// What takes longer than that of a platform that turns: of these the bound is told.
const LONG: [&str; 2] = ["accuracy", "clearance"];
/// What is of the platform's velocity, of which positions and angles have one unit.
const OF_VELOCITY: [&str; 5] =
    ["transmission", "conditioning", "stiffness", "joint_speed", "joint_acceleration"];

/// Names of strokes, transmission factors, joint speeds and all that is required, in this unit of lengths, and
/// between which ends they are certified to lie, of a claim that is certified.
pub fn signed(claim: &MachineClaim, length: Option<&str>) -> Vec<(String, String)> {
    let Ok(problem) = Problem::new(claim) else { return Vec::new() };
    let turns = claim.orientation.is_some();
    let requires = |quantity: &str| claim.require.iter().any(|own| own.quantity == quantity);
    let question = Question {
        speed: (!requires("joint_speed")).then(|| Expression::integer(1)),
        force: None,
        acceleration: None,
        one_unit: !turns || OF_VELOCITY.into_iter().any(requires),
        gap: BigRational::new(1.into(), if turns { 100 } else { 1000 }.into()),
    };
    let budget = Budget { max_boxes: BOXES, deadline: None };
    let never = AtomicBool::new(false);
    let mut control = Control { cancel: &never, progress: &mut |_| {} };
    let mut found = |asked: Asked| {
        let of_bound = match &asked {
            Asked::Extreme(extreme) if turns && LONG.contains(&asked.of().0) => {
                extreme.required_bound(claim)
            }
            _ => None,
        };
        let ends = match of_bound {
            Some(certified) => {
                Ok(vec![End { certified, reached: None, relative: None, own_bound: true }])
            }
            None => {
                let ends = ends(claim, &asked, true, &question.gap, budget, &mut control);
                tightened(claim, &asked, ends, &question.gap)
            }
        };
        Found { asked, ends }.values(is_angular(&problem))
    };
    let values = asked(claim, &problem, &question).0.into_iter().flat_map(&mut found);
    let values: Vec<_> = values.filter(|value| value.certified.is_some()).collect();
    text::lines(&values, length).into_iter().map(|(name, row)| (name, row.certified)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    #[test]
    fn a_designer_signs_strokes_factors_speeds_and_accuracy() {
        let text = r#"
            [mechanism]
            kind = "orthoglide"
            leg_length = 310
            base = 0
            [workspace]
            min = [-60, -60, -60]
            max = [100, 100, 100]
            [requirements]
            transmission = { max = 2 }
            accuracy = { joint_error = "0.001", max = "0.01" }
        "#;
        let claim = Design::parse(text, "test.toml").unwrap().claim;
        let found = signed(&claim, Some("mm"));
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        let expected = [
            "strokes of joints 1, 2, 3, mm",
            "transmission factor psi",
            "joint speed for tool speed 1",
            "off by, joint errors up to 0.001, mm",
        ];
        assert_eq!(names, expected);
        // rho = x - sqrt(L^2 - y^2 - z^2) from -60 - 310 to 100 - sqrt(310^2 - 2 100^2).
        let ends: Vec<f64> = found[0].1.split(" to ").map(|end| end.parse().unwrap()).collect();
        let greatest = 100.0 - f64::from(310 * 310 - 20_000).sqrt();
        assert!(ends[0] <= -370.0 && ends[0] > -370.8 && ends[1] >= greatest, "{ends:?}");
        assert!(ends[1] < greatest + 0.8, "{ends:?}");
        let off: f64 = found[3].1.strip_prefix("at most ").unwrap().parse().unwrap();
        assert!(off < 0.0036, "{off}");
    }
}
