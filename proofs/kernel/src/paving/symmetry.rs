//! Machines that look the same from permuted axes.

use super::cell::{Axis, Cell, Edge, MAX_AXIS_LEVEL};
use super::SHARE_BITS;
use crate::claim::{Kind, Leg, MachineClaim, Mechanism, Quantity, Requirement, Workspace};

/// A transposition and a cycle: they generate the permutations of three things.
const GENERATORS: [[usize; 3]; 2] = [[1, 0, 2], [1, 2, 0]];
/// Quantities that do not change with the axes: of singular values, of legs by their numbers, lengths
/// and angles between their own vectors.
const INVARIANT: [&str; 7] = [
    "transmission",
    "joint_range",
    "conditioning",
    "serial_margin",
    "parallel_margin",
    "leg_angle",
    "joint_speed",
];

/// **Lemma.** If the claim stays the same when the coordinates are permuted, leg `i` becoming
/// leg `p(i)` with coordinate `k` of its vectors becoming coordinate `p(k)`, then its region is
/// invariant under that permutation of the coordinates.
///
/// *Proof.* Let `Pi e_k = e_p(k)`. A machine of the claim with legs `l_i` at `P` has the same joint
/// coordinates, clearances and leg vectors turned by `Pi` as the machine with legs `Pi l_i` at
/// `Pi P` (drives are defined by scalar products and lengths; `M' = Pi M Pi^T`, the same singular
/// values and row lengths, and the same determinant of unit vectors but for its sign). That machine
/// is one of the claim's: its quantities vary over the same intervals, independently. Every
/// requirement is the same for all legs, or is permuted with them. So the claim holds at `P` for every
/// machine if and only if it holds at `Pi P`, and the box is invariant. ∎
///
/// Arms are turned by their axis, which a transposition reverses (`k x h` changes its sign): they
/// are refused, as are requirements with directions of their own, and bodies.
pub fn is_symmetric(claim: &MachineClaim) -> bool {
    let (Mechanism::Translational(legs), Workspace::Box { min, max }) =
        (&claim.mechanism, &claim.workspace)
    else {
        return false;
    };
    let all_same = |x: &[_]| matches!(x, [a, b, c] if a == b && b == c);
    let is_invariant = |own: &Requirement| INVARIANT.contains(&&*own.quantity);
    let permuted = |p: &[usize; 3]| {
        let image = |own: &Requirement| {
            let leg = own.leg.and_then(|leg| p.get(leg.checked_sub(1)?)).map(|leg| leg + 1);
            claim.require.contains(&Requirement { leg, ..own.clone() })
        };
        (0..3).all(|i| is_image(&legs[i], &legs[p[i]], p)) && claim.require.iter().all(image)
    };
    legs.len() == 3
        && claim.bodies.is_empty()
        && all_same(min)
        && all_same(max)
        && claim.require.iter().all(is_invariant)
        && GENERATORS.iter().all(permuted)
}

/// Whether `image` is `leg` with coordinate `k` of its vectors moved to `p(k)`.
fn is_image(leg: &Leg, image: &Leg, p: &[usize; 3]) -> bool {
    type Own<'a> = (&'static str, Kind, &'a [Quantity]);
    let is_moved = |((key, kind, own), (name, _, other)): (Own<'_>, Own<'_>)| {
        let is_moved = match (kind, own, other) {
            (Kind::Length, ..) => own == other,
            (_, [_, _, _], [_, _, _]) => (0..3).all(|k| own[k] == other[p[k]]),
            _ => false,
        };
        key == name && is_moved
    };
    let mode = |leg: &Leg| match leg {
        Leg::Slider { mode, .. } => Some(*mode),
        _ => None,
    };
    let has_axis = matches!(leg, Leg::Arm { .. } | Leg::Strut { base_axis: Some(_), .. });
    let (own, other) = (leg.quantities(), image.quantities());
    let is_like = !has_axis && mode(leg) == mode(image) && own.len() == other.len();
    is_like && own.into_iter().zip(other).all(is_moved)
}

/// Whether an edge lies wholly after another, which it may touch; edges are nested, equal, or before or
/// after each other.
fn is_after(a: Edge, b: Edge) -> bool {
    let at = |edge: Edge, part: u64| (edge.index() + part) << (MAX_AXIS_LEVEL - edge.level());
    at(a, 0) >= at(b, 1)
}

/// The coordinates of which the first has to be the less.
const ORDERED: [[Axis; 2]; 3] = [[Axis::X, Axis::Y], [Axis::Y, Axis::Z], [Axis::X, Axis::Z]];

/// Whether a cell has no point with `u_x < u_y < u_z`: some coordinate that should be the less lies
/// wholly after one that should be the greater.
pub fn is_mirrored(cell: &Cell) -> bool {
    let edge = |axis: Axis| cell.edges[axis.index()];
    ORDERED.iter().any(|&[less, greater]| is_after(edge(less), edge(greater)))
}

/// Six times the volume of the cell's points with `u_x <= u_y <= u_z`, in units of
/// `2^-`[`SHARE_BITS`].
///
/// *Proof.* Nested edges are halved, the longer one, until every two are equal or overlap in an end
/// at most. Then all points are in order, or none; of two equal edges half the points are, of three
/// a sixth. Levels stay those of the cell at most, so volumes are whole units. ∎
pub fn six_ordered(cell: &Cell) -> u128 {
    // An edge that lies after another leaves nothing, whatever is halved.
    if is_mirrored(cell) {
        return 0;
    }
    let mut equal = 0;
    for [less, greater] in ORDERED {
        let (a, b) = (cell.edges[less.index()], cell.edges[greater.index()]);
        if a == b {
            equal += 1;
        } else if !is_after(b, a) {
            let longer = if a.level() < b.level() { less } else { greater };
            return cell.halves(longer).map_or(0, |(a, b)| six_ordered(&a) + six_ordered(&b));
        }
    }
    let volume = 1 << (SHARE_BITS - cell.depth());
    match equal {
        0 => 6 * volume,
        1 => 3 * volume,
        _ => volume,
    }
}
