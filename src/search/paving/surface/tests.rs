use super::*;
use crate::search::paving::header;
use orthocert_kernel::paving::{is_mirrored, Axis, Cell, Item, Kind, SHARE_BITS};
use std::collections::{BTreeSet, HashMap};

/// What a test makes of a cell.
enum Fate {
    Split(Axis),
    Inner,
    Undecided,
}

/// The bytes of a paving whose tree is as told: surfaces do not look at evidence.
fn paving(symmetric: bool, fate: impl Fn(&Cell) -> Fate) -> Vec<u8> {
    let text = "[mechanism]\nkind = \"orthoglide\"\nleg_length = 1\n[workspace]\n\
                min = [-0.1, -0.1, -0.1]\nmax = [0.1, 0.1, 0.1]\n[requirements]\n\
                transmission = { min = \"1/2\", max = 2 }\n";
    let design = crate::design::Design::parse(text, "test").unwrap();
    let mut header = header(&design.claim, None, 30);
    if !symmetric {
        header.symmetry = None;
    }
    let mut bytes = serde_json::to_vec(&header).unwrap();
    bytes.push(b'\n');
    let start = bytes.len();
    let mut waiting = vec![Cell::ROOT];
    while let Some(cell) = waiting.pop() {
        let kind = if symmetric && is_mirrored(&cell) {
            Kind::Mirrored
        } else {
            match fate(&cell) {
                Fate::Split(axis) => {
                    let (lower, upper) = cell.halves(axis).unwrap();
                    waiting.extend([upper, lower]);
                    Kind::Split(axis)
                }
                Fate::Inner => Kind::Inner,
                Fate::Undecided => Kind::Boundary,
            }
        };
        Item { steps: Vec::new(), kind }.write(&mut bytes).unwrap();
    }
    assert!(bytes.len() > start);
    let mut reader = Reader::new(bytes.as_slice()).unwrap();
    while reader.next().unwrap().is_some() {}
    let summary = serde_json::to_vec(&reader.summary).unwrap();
    bytes.extend(summary);
    bytes.push(b'\n');
    bytes
}

/// The surface, of which is held that it is closed, has no flat triangle, and encloses the paving's
/// inner volume.
fn held(symmetric: bool, fate: impl Fn(&Cell) -> Fate) -> Surface {
    let bytes = paving(symmetric, fate);
    let reader = Reader::new(bytes.as_slice()).unwrap();
    let found = surface(reader, &AtomicBool::new(false)).unwrap();
    let mut reader = Reader::new(bytes.as_slice()).unwrap();
    while reader.next().unwrap().is_some() {}
    assert_eq!(found.share() as u128, reader.summary.inner_share.0);
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    for corners in found.in_triangles() {
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
        let [a, b, c] = corners.map(|at| found.points[at as usize].map(i128::from));
        let side = |q: [i128; 3], k: usize| q[k] - a[k];
        let turn = |i, j| side(b, i) * side(c, j) - side(b, j) * side(c, i);
        assert!([turn(1, 2), turn(2, 0), turn(0, 1)].iter().any(|x| *x != 0), "flat");
    }
    assert!(edges.values().all(|sum| *sum == 0), "not closed");
    found
}

/// The surface's area, with the box's edges as units of length.
fn area(surface: &Surface) -> f64 {
    let twice = surface.in_triangles().map(|corners| {
        let [a, b, c] =
            corners.map(|at| surface.points[at as usize].map(|x| x as f64 / EDGE as f64));
        let turn =
            |i: usize, j: usize| (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        (turn(1, 2) + turn(2, 0) + turn(0, 1)).abs()
    });
    twice.sum::<f64>() / 2.0
}

/// Splits the longest edge, of x before y before z, down to cells of `2^-level`.
fn grid(cell: &Cell, level: u32, inner: impl Fn([u64; 3]) -> bool) -> Fate {
    let shortest = cell.edges.iter().map(|e| e.level()).min().unwrap();
    match Axis::ALL.into_iter().find(|axis| cell.edges[axis.index()].level() == shortest) {
        Some(axis) if shortest < level => Fate::Split(axis),
        _ if inner(cell.edges.map(|e| e.index())) => Fate::Inner,
        _ => Fate::Undecided,
    }
}

#[test]
fn the_whole_box_has_six_faces_and_eight_corners() {
    for symmetric in [false, true] {
        let whole = held(symmetric, |_| Fate::Inner);
        assert_eq!((whole.quads.len(), whole.triangles.len(), whole.points.len()), (6, 0, 8));
        assert!(whole.quads.iter().all(|face| face.beyond == Beyond::OutsideBox));
        let corners = whole.coordinates(|x| x).unwrap();
        assert_eq!((corners[0], corners[7]), ([-0.1; 3], [0.1; 3]));
        // However it is cut.
        let cut = held(symmetric, |at| grid(at, 3, |_| true));
        assert_eq!(cut, whole);
    }
}

#[test]
fn a_coarse_box_beside_a_fine_one_is_cut_about_it_alone() {
    // The lower half of x whole; of the upper, a grid of which one box is inner.
    let found = held(false, |cell| match cell.edges[0].level() {
        0 => Fate::Split(Axis::X),
        _ if cell.edges[0].index() << (3 - cell.edges[0].level().min(3)) < 4 => Fate::Inner,
        _ => grid(cell, 3, |c| c == [4, 2, 3]),
    });
    // Corners of the large and of the small box, and of at most eight rectangles about that.
    assert!((16..=16 + 12).contains(&found.points.len()), "{}", found.points.len());
    assert_eq!(area(&found), 2.0 * (1.0 + 0.5 + 0.5) + 4.0 / 64.0);
    // Euler: V - E + F = 2, with 3 F = 2 E.
    assert_eq!(found.in_triangles().count(), 2 * found.points.len() - 4);
}

#[test]
fn images_make_up_the_whole_surface() {
    // One box off the planes: six images. On one plane: three. On all: one.
    for (cell, images) in [([1, 3, 6], 6), ([3, 3, 6], 3), ([2, 5, 5], 3), ([4, 4, 4], 1)] {
        let found = held(true, |at| grid(at, 3, |c| c == cell));
        assert_eq!(found.quads.len(), 6 * images, "{cell:?}");
    }
    // A symmetric set: the surface is that which is found without symmetry.
    let ball = |c: [u64; 3]| c.iter().map(|x| (2 * x + 1).abs_diff(7).pow(2)).sum::<u64>() < 40;
    held(true, |at| grid(at, 3, ball));
    let [whole, sixth] = [false, true].map(|symmetric| {
        let bytes = paving(symmetric, |at| grid(at, 3, ball));
        let (reader, cancel) = (Reader::new(bytes.as_slice()).unwrap(), AtomicBool::new(false));
        let (_, tree) = Tree::read(reader, Detail::InnerPart, &cancel).unwrap();
        squares(&walls(&tree, &cancel).unwrap())
    });
    assert!(whole.len() > 100 && whole == sixth);
}

/// The squares of a grid of eight that walls consist of.
fn squares(walls: &[Wall]) -> BTreeSet<(u8, u64, bool, u64, u64)> {
    const UNIT: u64 = EDGE / 8;
    let squares = walls.iter().flat_map(|wall| {
        let Wall { axis, plane, upward, sides: [[a, b], [c, d]], .. } = *wall;
        let along = (a..b).step_by(UNIT as usize);
        along.flat_map(move |x| {
            (c..d).step_by(UNIT as usize).map(move |y| (axis, plane, upward, x, y))
        })
    });
    squares.collect()
}

#[test]
fn a_cell_across_the_planes_counts_only_within_the_order() {
    // [0, 1/2] x [0, 1] x [0, 1]: of its points in order, with their images, the box
    // without the part where all are in the upper half.
    let found = held(true, |cell| match cell.edges[0].level() {
        0 => Fate::Split(Axis::X),
        _ if cell.edges[0].index() == 0 => Fate::Inner,
        _ => Fate::Undecided,
    });
    assert_eq!((found.share(), area(&found)), (7 << (SHARE_BITS - 3), 6.0));
    // [0, 1] x [0, 1/2] x [0, 1]: two coordinates are in the lower half, at least.
    let found = held(true, |cell| match cell.edges[1].level() {
        0 => Fate::Split(Axis::Y),
        _ if cell.edges[1].index() == 0 => Fate::Inner,
        _ => Fate::Undecided,
    });
    assert_eq!((found.share(), area(&found)), (4 << (SHARE_BITS - 3), 18.0 / 4.0));
}

#[test]
fn boxes_that_touch_in_an_edge_share_it_four_times() {
    let found = held(false, |at| grid(at, 1, |[x, y, z]| x == y && z == 0));
    assert_eq!(found.points.len(), 14);
    assert_eq!(area(&found), 3.0);
}

/// Boxes of all sizes, at random: the surface of each is closed, and encloses what it should.
#[test]
fn surfaces_of_random_trees_are_closed() {
    for seed in 0..60_u64 {
        let random = |cell: &Cell| {
            let place = cell.edges.iter().fold(seed, |hash, edge| {
                (hash ^ edge.index() ^ u64::from(edge.level()) << 40)
                    .wrapping_mul(0x9e37_79b9_7f4a_7c15)
                    .rotate_left(29)
            });
            let depth: u32 = cell.edges.iter().map(|edge| edge.level()).sum();
            match place >> 32 & 7 {
                _ if depth < 3 => Fate::Split(Axis::ALL[depth as usize]),
                0..=3 if depth < 11 => Fate::Split(Axis::ALL[(place >> 40) as usize % 3]),
                0..=5 => Fate::Inner,
                _ => Fate::Undecided,
            }
        };
        held(false, random);
        held(true, random);
    }
}

#[test]
fn a_depth_keeps_only_what_is_inner_throughout() {
    let ball = |c: [u64; 3]| c.iter().map(|x| (2 * x + 1).abs_diff(16).pow(2)).sum::<u64>() < 200;
    let sixth = paving(true, |cell| grid(cell, 4, ball));
    let share = |depth: u32| {
        let reader = Reader::new(sixth.as_slice()).unwrap();
        let cancel = AtomicBool::new(false);
        let (header, tree) = Tree::read(reader, Detail::Depth(depth), &cancel).unwrap();
        let walls = walls(&tree, &cancel).unwrap();
        mesh::assembled(&walls, ends(&header).unwrap()).share()
    };
    // The same, of a tree that is there: without images depths are those of the paving.
    let bytes = paving(false, |cell| grid(cell, 4, ball));
    let read = |detail: Detail| {
        let cancel = AtomicBool::new(false);
        Tree::read(Reader::new(bytes.as_slice()).unwrap(), detail, &cancel).unwrap().1
    };
    let cancel = AtomicBool::new(false);
    for depth in 0..=12 {
        let [one, other] = [read(Detail::Depth(depth)), read(Detail::Depth(12)).to_depth(depth)];
        assert_eq!(walls(&one, &cancel).unwrap(), walls(&other, &cancel).unwrap(), "{depth}");
        assert!(one.depth() <= depth && one.depth() == other.depth(), "{depth}");
    }
    let shares: Vec<i128> = (3..=12).map(share).collect();
    assert!(shares.is_sorted() && shares[0] < shares[5] && shares[5] < shares[9], "{shares:?}");
    assert_eq!(shares[9], held(true, |cell| grid(cell, 4, ball)).share());
}

#[test]
fn what_has_no_surface_says_so() {
    let cancel = AtomicBool::new(false);
    let bytes = paving(false, |_| Fate::Undecided);
    let of = |bytes: &[u8], cancel: &AtomicBool| surface(Reader::new(bytes).unwrap(), cancel);
    assert!(matches!(of(&bytes, &cancel), Err(SurfaceError::Empty)));
    let bytes = paving(false, |_| Fate::Inner);
    assert!(matches!(of(&bytes[..bytes.len() - 1], &cancel), Err(SurfaceError::Rejected(_))));
    assert!(matches!(of(&bytes, &AtomicBool::new(true)), Err(SurfaceError::Cancelled)));
}

#[test]
fn corners_that_coincide_in_single_precision_are_refused() {
    let found = held(false, |cell| match cell.edges[0] {
        // A sliver of 2^-27 of the box at its upper end.
        edge if edge.level() < 27 && edge.index() + 1 == 1 << edge.level() => Fate::Split(Axis::X),
        edge if edge.level() == 27 && edge.index() + 1 == 1 << 27 => Fate::Inner,
        _ => Fate::Undecided,
    });
    assert!(found.coordinates(|x| x).is_ok());
    assert!(matches!(found.coordinates(|x| x as f32), Err(SurfaceError::TooClose)));
}
