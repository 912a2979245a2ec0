//! The paper's cube: bounds are met with equality at `Q_1` and `Q_2`, where no strict rule may hold.

use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::claim::{MachineClaim, Mechanism, Range, Requirements, Workspace};
use orthocert_checker::expansion::{Expansion, ExpansionPoint};
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use orthocert_checker::rule::{self, Rotation, TightCorner};

const BITS: u32 = 128;
const CORNERS: [TightCorner; 2] = [TightCorner::Q1, TightCorner::Q2];

#[test]
fn no_strict_rule_holds_at_a_tight_corner() {
    for psi in ["101/100", "3/2", "2", "3", "20", "1000", "sqrt(3)", "sqrt(5)"] {
        let psi_max = Exact::parse(psi, 100).expect("a number");
        let low = psi_max.compare(&Exact::integer(2)) != Some(std::cmp::Ordering::Less);
        let high = psi_max.compare(&Exact::integer(2)) != Some(std::cmp::Ordering::Greater);
        let claim = MachineClaim {
            mechanism: Mechanism::Orthoglide { offset: Exact::integer(0) },
            workspace: Workspace::Cube { side: Exact::integer(200) },
            requirements: Requirements {
                transmission: Some(Range { min: None, max: Some(psi_max) }),
                ..Requirements::default()
            },
        };
        let model = Model::new(&claim, BITS).expect("enclosed");
        for corner in CORNERS {
            let mut cell = Cell::ROOT;
            let mut closed_at = None;
            for depth in 0..90 {
                let expand = |point| Expansion::new(&model, &cell, point);
                if let Ok(e) = expand(ExpansionPoint::Centre) {
                    if corner == TightCorner::Q1 || low {
                        let holds = rule::lower(&model, &e, &Rotation::IDENTITY).is_ok();
                        assert!(!holds, "lower at {corner:?}, psi_max {psi}, depth {depth}");
                    }
                    if corner == TightCorner::Q2 && high {
                        let holds = rule::upper(&model, &e).is_ok();
                        assert!(!holds, "upper at {corner:?}, psi_max {psi}, depth {depth}");
                    }
                }
                let about = expand(corner.expansion_point());
                if about.is_ok_and(|e| rule::corner(&model, &e).is_ok()) {
                    closed_at = closed_at.or(Some(depth));
                }
                let (lower, upper) = cell.halves(Axis::ALL[depth % 3]).expect("not too deep");
                cell = if corner == TightCorner::Q1 { lower } else { upper };
            }
            assert!(closed_at.is_some_and(|d| d < 12), "{corner:?}, psi_max {psi}");
        }
    }
}
