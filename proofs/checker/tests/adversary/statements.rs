//! The words of a claim leave no unit open.

use super::witnesses::tiny_arms;
use orthocert_checker::certificate::Verdict;
use orthocert_checker::claim::{Claim, JointSpeed, Range};
use orthocert_checker::number::Exact;
use orthocert_checker::statement::statement;
use std::array::from_fn;

#[test]
fn machines_with_arms_are_described_in_degrees() {
    let mut claim = tiny_arms();
    let range = |min, max| Range { min: Some(Exact::integer(min)), max: Some(Exact::integer(max)) };
    claim.requirements.transmission = Some(range(1, 2));
    claim.requirements.joint_range = Some(from_fn(|_| range(-30, 60)));
    let (tool, max) = (Exact::integer(5), Exact::integer(7));
    claim.requirements.joint_speed = Some(JointSpeed { tool, max });
    let text = statement(&Claim::Machine(claim), Verdict::Certified).expect("text");
    for line in [
        "  1 <= psi_i(P) <= 2 (length per radian) for i = 1, 2, 3;",
        "  -30 <= rho_2(P) <= 60 (degrees, up to whole turns);",
        "  |row_i of M| * 5 * 180/pi <= 7 for every leg (joint speed in degrees per unit of time);",
    ] {
        assert!(text.lines().any(|l| l == line), "{line}\n{text}");
    }
}
