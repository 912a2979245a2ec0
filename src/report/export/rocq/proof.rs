//! Proofs, as a `proof` of Certificate.v, if the verified checker covers such a proof of the claim.

use super::claim::{expression, Kind, Subject};
use super::{lines, list, matrix, not_covered, optional, quoted, row, Exported};
use orthocert_kernel::certificate::{
    AtlasCell, Corner, Evidence, Failure, Node, Part, Proof, Step, Tree, Witness,
};
use orthocert_kernel::claim::{Bound, Leg, Requirement};
use orthocert_kernel::number::Expression;
use orthocert_kernel::test::Multiplier;

/// The proof as it is exported.
pub fn proof(proof: &Proof, subject: &Subject<'_>) -> Exported<String> {
    let written = match proof {
        Proof::Tree(tree) => format!("Nodes {}", written_tree(tree)?),
        Proof::Witness(witness) => format!("ByWitness {}", written_witness(witness)?),
        Proof::Atlas(cells) => {
            let cells = cells.iter().map(cell).collect::<Exported<Vec<_>>>()?;
            format!("Cells {}", lines(cells))
        }
    };
    covered(proof, subject)?;
    Ok(written)
}

/// Refuses what `accept` has no theorem for, though there is a value for it.
fn covered(proof: &Proof, subject: &Subject<'_>) -> Exported<()> {
    let requires =
        |keys: &[&str]| subject.requirements.iter().any(|r| keys.contains(&r.quantity.as_str()));
    let holds_alone = || requires(&["joint_force", "joint_acceleration", "one_to_one", "accuracy"]);
    let for_each = |r: &Requirement| r.given.get("joint").is_some_and(|all| all.len() != 1);
    let accelerates_plane = requires(&["joint_acceleration"])
        && subject.legs.iter().any(|leg| matches!(leg, Leg::Planar { .. }));
    let has = |is: &dyn Fn(&Evidence) -> bool| match proof {
        Proof::Tree(tree) => tree.nodes.iter().flat_map(|node| &node.by).any(|Step(_, by)| is(by)),
        _ => false,
    };
    let has_sign = subject.requirements.iter().any(is_by_slopes);
    let fails = |tree: &Tree| tree.nodes.iter().any(|node| node.fails.is_some());
    let is_outside = |cell: &AtlasCell| matches!(cell, AtlasCell::Certified(tree) if fails(tree));
    let is_same = |cell: &AtlasCell| {
        matches!(cell, AtlasCell::Refuted(Witness { fails: Failure::Same { .. }, .. }))
    };
    let what = match (subject.kind, proof) {
        (Kind::Turning, Proof::Tree(tree)) if has_other_apart(tree, subject) => {
            "this evidence \"tolerances\" of a platform that turns"
        }
        (Kind::Legs, _) if has(&|by| matches!(by, Evidence::Turned(..) | Evidence::Control(_))) => {
            "this set of orientations with such drives"
        }
        (Kind::Turning, _)
            if has(&|by| is_no_step_of_pose(by) || (*by == Evidence::Test && !has_sign)) =>
        {
            "a step of a platform that turns that is not at control points"
        }
        (Kind::Atlas, Proof::Atlas(cells)) if cells.iter().any(is_same) => {
            "the failure \"same\" of such a mechanism"
        }
        (Kind::Machine | Kind::Legs, Proof::Tree(_)) | (Kind::Atlas, _) if accelerates_plane => {
            "the acceleration of a joint of a machine with a plane"
        }
        (Kind::NoCube, _) if holds_alone() => "this quantity in a claim that is refuted",
        (Kind::NoCube, Proof::Tree(tree)) if tree.nodes.iter().any(|node| !node.by.is_empty()) => {
            "a step in a proof that no cube fits"
        }
        (Kind::NoCube | Kind::Atlas, _) if subject.requirements.iter().any(for_each) => {
            "a stiffness for each joint in such a claim"
        }
        (Kind::NoCube, _) => return Ok(()),
        (Kind::Atlas, Proof::Atlas(cells)) if cells.iter().any(is_outside) => "a leaf that fails",
        (_, Proof::Tree(tree)) if fails(tree) => "a leaf that fails",
        _ => return Ok(()),
    };
    not_covered(what)
}

fn is_no_step_of_pose(by: &Evidence) -> bool {
    use Evidence::{Control, Direction, Fan, Outside, Test, Tolerances};
    !matches!(by, Control(_) | Outside | Direction(_) | Test | Tolerances(..) | Fan(_))
}

/// Apart are tolerances in what is shown of `M`, at control points.
fn has_other_apart(tree: &Tree, subject: &Subject<'_>) -> bool {
    let is_lower = |by: &Evidence| match by {
        Evidence::Turned(by, ..) => matches!(**by, Evidence::Lower(_)),
        by => matches!(by, Evidence::Lower(_)),
    };
    let is_shown = |by: &Evidence| {
        let Evidence::Tolerances(by, ..) = by else { return false };
        matches!(&**by, Evidence::Control(by) if is_lower(by)) && subject.is_square_over_box
    };
    let is_other = |Step(obligation, by): &Step| match by {
        Evidence::Tolerances(..) => *obligation != 0 || !is_shown(by),
        Evidence::Fan(parts) => *obligation != 0 || !parts.iter().all(|part| is_shown(&part.3)),
        _ => false,
    };
    tree.nodes.iter().flat_map(|node| &node.by).any(is_other)
}

/// An angle at a joint of more than 90 degrees, or an acceleration: slopes show these.
fn is_by_slopes(requirement: &Requirement) -> bool {
    let of_joint = matches!(requirement.quantity.as_str(), "base_joint" | "platform_joint");
    let Bound::Max(bound) = &requirement.bound else { return false };
    let more = &Expression::integer(90) - bound;
    let is_wide = || more.enclose(512).is_none_or(|more| more.lo.sign() == num_bigint::Sign::Minus);
    requirement.quantity == "joint_acceleration" || (of_joint && is_wide())
}

fn written_tree(Tree { precision, chords, nodes }: &Tree) -> Exported<String> {
    let chords =
        chords.as_ref().map(|Multiplier { y, places }| format!("({}, {places}%N)", matrix(y)));
    let nodes = nodes.iter().map(node).collect::<Exported<Vec<_>>>()?;
    Ok(format!("{precision} {} {}", optional(chords), lines(nodes)))
}

fn written_witness(Witness { precision, point, machine, fails }: &Witness) -> Exported<String> {
    let [point, machine] = [point, machine].map(|all| list(all.iter().map(expression)));
    Ok(format!("{precision} {point}%written {machine}%written {}", failure(fails)?))
}

fn cell(cell: &AtlasCell) -> Exported<String> {
    Ok(match cell {
        AtlasCell::Split(k) => format!("Cut {k}"),
        AtlasCell::Certified(tree) => format!("Proved {}", written_tree(tree)?),
        AtlasCell::Refuted(witness) => format!("Disproved {}", written_witness(witness)?),
        AtlasCell::Undecided => "Undecided".to_owned(),
    })
}

fn node(Node { by, split, fails, at }: &Node) -> Exported<String> {
    let step = |Step(obligation, by): &Step| Ok(format!("({obligation}, {})", evidence(by)?));
    let by = by.iter().map(step).collect::<Exported<Vec<_>>>()?;
    let fails = fails.as_ref().map(failure).transpose()?;
    let split = optional(split.map(|k| k.to_string()));
    Ok(format!("Node {} {split} {} {}", list(by), optional(fails), row(at)))
}

fn evidence(by: &Evidence) -> Exported<String> {
    let multiplied =
        |y: &Multiplier| format!("Multiplied \"{}\" {} {}", by.name(), matrix(&y.y), y.places);
    Ok(match by {
        Evidence::Test
        | Evidence::Divided
        | Evidence::Chords
        | Evidence::Negative
        | Evidence::Cube
        | Evidence::Mirror
        | Evidence::Outside => format!("Plain \"{}\"", by.name()),
        Evidence::Lower(y)
        | Evidence::LowerDivided(y)
        | Evidence::Rank(y)
        | Evidence::Direction(y) => multiplied(y),
        Evidence::Conditioning(y, mu) => {
            format!("Conditioned_ {} {} {}", matrix(&y.y), y.places, row(mu))
        }
        Evidence::Accuracy(y, kappa, q) => {
            format!("Accurate_ {} {} ({kappa}) {q}", matrix(&y.y), y.places)
        }
        Evidence::Corner(Corner::Q1) => "AtCorner Check.Q1".to_owned(),
        Evidence::Corner(Corner::Q2) => "AtCorner Check.Q2".to_owned(),
        Evidence::Tolerances(by, ends, directions) => {
            format!("Apart_ ({}) {} {}", evidence(by)?, quoted(ends), matrix(directions))
        }
        Evidence::Together(by, rows, places) => {
            format!("Together_ ({}) {} {places}", evidence(by)?, matrix(rows))
        }
        Evidence::Inside(by, n, places) => format!("Inside_ ({}) ({n}) {places}", evidence(by)?),
        Evidence::Control(by) => match &**by {
            Evidence::Turned(by, n, places) => {
                format!("AtControls_ (Turned_ ({}) ({n}) {places})", at_controls(by)?)
            }
            by => format!("AtControls_ ({})", at_controls(by)?),
        },
        Evidence::Turned(..) => return not_covered("the evidence \"turned\""),
        Evidence::Fan(parts) => format!("Fan_ {}", list(fan(parts)?)),
        Evidence::Between(mu, places, weights, lower, upper) => {
            let [lower, upper] = [evidence(lower)?, evidence(upper)?];
            format!("Between_ {} {places}%N {} ({lower}) ({upper})", row(mu), matrix(weights))
        }
    })
}

fn fan(parts: &[Part]) -> Exported<Vec<String>> {
    let part = |Part(c, n, places, by): &Part| match is_of_fan(by) {
        true => Ok(format!("({}, ({n})%Z, {places}%N, {})", row(c), evidence(by)?)),
        false => not_covered("this evidence \"fan\""),
    };
    let exported = parts.iter().map(part).collect::<Exported<Vec<String>>>()?;
    let about_divided = || parts.iter().map(|Part(.., by)| is_of_divided(by));
    match about_divided().any(|it| it) && !about_divided().all(|it| it) {
        true => not_covered("evidence \"fan\" about \"divided\" and other rows"),
        false => Ok(exported),
    }
}

fn is_of_fan(by: &Evidence) -> bool {
    use Evidence::{Divided, Inside, Lower, LowerDivided, Rank, Test, Tolerances};
    match by {
        Inside(by, ..) => is_of_fan(by),
        by => matches!(by, Test | Divided | Lower(_) | LowerDivided(_) | Rank(_) | Tolerances(..)),
    }
}

fn is_of_divided(by: &Evidence) -> bool {
    match by {
        Evidence::Inside(by, ..) | Evidence::Tolerances(by, ..) => is_of_divided(by),
        by => matches!(by, Evidence::Divided | Evidence::LowerDivided(_)),
    }
}

fn at_controls(by: &Evidence) -> Exported<String> {
    match by {
        Evidence::Test
        | Evidence::Chords
        | Evidence::Lower(_)
        | Evidence::Rank(_)
        | Evidence::Conditioning(..)
        | Evidence::Accuracy(..) => evidence(by),
        _ => not_covered("this evidence at control points"),
    }
}

fn failure(fails: &Failure) -> Exported<String> {
    Ok(match fails {
        Failure::Reach => "Reach".to_owned(),
        Failure::Obligation(number, directions) => {
            format!("(Obligation {number} {})", matrix(directions))
        }
        Failure::Row(number, leg) => format!("(Row {number} {leg})"),
        Failure::Dependent => "Dependent_".to_owned(),
        Failure::Same { obligation, least, greatest, inverse: Multiplier { y, places } } => {
            let [least, greatest] = [least, greatest].map(|all| list(all.iter().map(expression)));
            let y = matrix(y);
            format!("(Same_ {obligation} {least}%written {greatest}%written {y} {places})")
        }
        Failure::Singular(other) => {
            format!("(Singular_ {}%written)", list(other.iter().map(expression)))
        }
    })
}
