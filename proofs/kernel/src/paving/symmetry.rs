//! Machines that look the same from permuted axes.

use super::cell::{Cell, Edge};
use super::SHARE_BITS;
use crate::claim::{Leg, MachineClaim, Mechanism, Quantity, Requirement, Workspace};

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
    let mut moved = leg.clone();
    let mut all = moved.parts_mut().0.into_iter();
    let is_moved = all.all(|vector| {
        let Ok(own) = <[Quantity; 3]>::try_from(vector.clone()) else { return false };
        own.into_iter().zip(p).for_each(|(x, &to)| vector[to] = x);
        true
    });
    let is_axial = matches!(leg, Leg::Arm { .. } | Leg::Strut { base_axis: Some(_), .. });
    is_moved && !is_axial && moved == *image
}

/// How two dyadic intervals lie: such intervals are nested or overlap in an end at most.
enum Relation {
    Before,
    After,
    Equal,
    Contains,
    Within,
}

fn relation(a: Edge, b: Edge) -> Relation {
    if a.level <= b.level {
        let ancestor = b.index >> (b.level - a.level);
        match a.index.cmp(&ancestor) {
            std::cmp::Ordering::Less => Relation::Before,
            std::cmp::Ordering::Greater => Relation::After,
            std::cmp::Ordering::Equal if a.level == b.level => Relation::Equal,
            std::cmp::Ordering::Equal => Relation::Contains,
        }
    } else {
        match relation(b, a) {
            Relation::Before => Relation::After,
            Relation::After => Relation::Before,
            Relation::Contains => Relation::Within,
            other => other,
        }
    }
}

/// Whether a cell has no point with `u_x < u_y < u_z`: some coordinate that should be the less lies
/// wholly after one that should be the greater.
pub fn is_mirrored(cell: &Cell) -> bool {
    let [x, y, z] = cell.edges;
    [(x, y), (y, z), (x, z)].iter().any(|&(a, b)| matches!(relation(a, b), Relation::After))
}

/// Six times the volume of the cell's points with `u_x <= u_y <= u_z`, in units of
/// `2^-`[`SHARE_BITS`]; every level is at most [`MAX_AXIS_LEVEL`](super::MAX_AXIS_LEVEL).
///
/// *Proof.* Nested edges are halved, the longer one, until every two are equal or overlap in an end
/// at most. Then all points are in order, or none; of two equal edges half the points are, of three
/// a sixth. Levels stay those of the cell at most, so volumes are whole units. ∎
pub fn six_ordered(cell: &Cell) -> u128 {
    let [x, y, z] = cell.edges;
    let mut equal = 0;
    for (a, b) in [(0, 1), (1, 2), (0, 2)] {
        let longer = match relation(cell.edges[a], cell.edges[b]) {
            Relation::After => return 0,
            Relation::Before => continue,
            Relation::Equal => {
                equal += 1;
                continue;
            }
            Relation::Contains => a,
            Relation::Within => b,
        };
        // An edge that lies after another leaves nothing, whatever is halved.
        if is_mirrored(cell) {
            return 0;
        }
        let Edge { index, level } = cell.edges[longer];
        let half = |index| {
            let mut cell = *cell;
            cell.edges[longer] = Edge { index, level: level + 1 };
            six_ordered(&cell)
        };
        return half(2 * index) + half(2 * index + 1);
    }
    let volume = 1 << (SHARE_BITS - x.level - y.level - z.level);
    match equal {
        0 => 6 * volume,
        1 => 3 * volume,
        _ => volume,
    }
}
