use super::*;
use crate::paving::header;
use orthocert_checker::certificate::Step;
use orthocert_checker::claim::Claim;
use orthocert_checker::paving::{Item, SHARE_BITS};
use orthocert_checker::rule::Rotation;
use std::collections::HashMap;

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
    let Claim::Machine(claim) = design.claim else { panic!("not a machine") };
    let mut header = header(&claim, 30);
    if !symmetric {
        header.symmetry = None;
    }
    let mut bytes = serde_json::to_vec(&header).unwrap();
    bytes.push(b'\n');
    let start = bytes.len();
    let mut waiting = vec![Cell::ROOT];
    while let Some(cell) = waiting.pop() {
        let (kind, steps) = if symmetric && orthocert_checker::paving::is_mirrored(&cell) {
            (Kind::Mirrored, Vec::new())
        } else {
            match fate(&cell) {
                Fate::Split(axis) => {
                    let (lower, upper) = cell.halves(axis).unwrap();
                    waiting.extend([upper, lower]);
                    (Kind::Split(axis), Vec::new())
                }
                Fate::Inner => (Kind::Inner, vec![Step::Lower(Rotation::IDENTITY), Step::Upper]),
                Fate::Undecided => (Kind::Boundary, Vec::new()),
            }
        };
        Item { steps, kind }.write(&mut bytes).unwrap();
    }
    assert!(bytes.len() > start);
    let mut reader = Reader::new(bytes.as_slice()).unwrap();
    while reader.next().unwrap().is_some() {}
    let summary = serde_json::to_vec(&reader.summary()).unwrap();
    bytes.extend(summary);
    bytes.push(b'\n');
    bytes
}

/// The surface, of which is held that it is closed and encloses the paving's inner volume.
fn held(symmetric: bool, fate: impl Fn(&Cell) -> Fate) -> Surface {
    let bytes = paving(symmetric, fate);
    let reader = Reader::new(bytes.as_slice()).unwrap();
    let found = surface(reader, &AtomicBool::new(false)).unwrap();
    let mut reader = Reader::new(bytes.as_slice()).unwrap();
    while reader.next().unwrap().is_some() {}
    let shares = reader.shares();
    let cell = SHARE_BITS - found.levels.iter().sum::<u32>();
    assert_eq!(found.cells() as u128, shares.inner >> cell);
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    for face in &found.faces {
        for i in 0..4 {
            let (a, b) = (face.corners[i], face.corners[(i + 1) % 4]);
            *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|sum| *sum == 0), "not closed");
    found
}

/// Splits the longest edge, of x before y before z, down to cells of `2^-level`.
fn grid(cell: &Cell, level: u32, inner: impl Fn([u128; 3]) -> bool) -> Fate {
    let shortest = cell.edges.iter().map(|e| e.level).min().unwrap();
    match Axis::ALL.into_iter().find(|axis| cell.edges[axis.index()].level == shortest) {
        Some(axis) if shortest < level => Fate::Split(axis),
        _ if inner(cell.edges.map(|e| e.index)) => Fate::Inner,
        _ => Fate::Undecided,
    }
}

#[test]
fn the_whole_box_has_six_faces_and_eight_corners() {
    for symmetric in [false, true] {
        let whole = held(symmetric, |_| Fate::Inner);
        assert_eq!((whole.faces.len(), whole.points.len()), (6, 8));
        assert!(whole.faces.iter().all(|f| f.beyond == Beyond::OutsideBox && f.depth == 0));
        let corners = whole.coordinates(|x| x).unwrap();
        assert_eq!((corners[0], corners[7]), ([-0.1; 3], [0.1; 3]));
    }
}

#[test]
fn a_coarse_box_beside_fine_ones_is_split_like_them() {
    // The lower half of x whole; of the upper, a grid of which one box is inner.
    let found = held(false, |cell| match cell.edges[0].level {
        0 => Fate::Split(Axis::X),
        _ if cell.edges[0].index << (3 - cell.edges[0].level.min(3)) < 4 => Fate::Inner,
        _ => grid(cell, 3, |c| c == [4, 2, 3]),
    });
    assert_eq!(found.levels, [3, 3, 3]);
    // Of the coarse box 2 * 64 + 4 * 32 faces, less the one that the small box covers; of that, 5.
    assert_eq!(found.faces.len(), 256 - 1 + 5);
    let undecided = found.faces.iter().filter(|f| f.beyond == Beyond::Undecided).count();
    assert_eq!(undecided, 64 - 1 + 5);
}

#[test]
fn images_make_up_the_whole_surface() {
    // One box off the planes: six images. On one plane: three. On all: one.
    for (cell, images) in [([1, 3, 6], 6), ([3, 3, 6], 3), ([2, 5, 5], 3), ([4, 4, 4], 1)] {
        let found = held(true, |at| grid(at, 3, |c| c == cell));
        assert_eq!(found.faces.len(), 6 * images, "{cell:?}");
    }
    // A symmetric set: the surface is that which is found without symmetry.
    let ball = |c: [u128; 3]| c.iter().map(|x| (2 * x + 1).abs_diff(7).pow(2)).sum::<u128>() < 40;
    let (whole, sixth) = (held(false, |c| grid(c, 3, ball)), held(true, |c| grid(c, 3, ball)));
    let sorted = |surface: &Surface| {
        let mut faces: Vec<_> = surface.faces.iter().map(|f| (f.corners, f.depth)).collect();
        faces.sort();
        faces
    };
    assert_eq!(whole.points, sixth.points);
    assert_eq!(sorted(&whole), sorted(&sixth));
}

#[test]
fn a_cell_across_the_planes_counts_only_within_the_order() {
    // [0, 1/2] x [0, 1] x [0, 1]: of its points in order, with their images, the box
    // without the part where all are in the upper half.
    let found = held(true, |cell| match cell.edges[0].level {
        0 => Fate::Split(Axis::X),
        _ if cell.edges[0].index == 0 => Fate::Inner,
        _ => Fate::Undecided,
    });
    assert_eq!((found.levels, found.cells()), ([1; 3], 7));
    assert_eq!(found.faces.len(), 24);
    // [0, 1] x [0, 1/2] x [0, 1]: two coordinates are in the lower half, at least. The face between
    // (1/2, 1/2, .) and its neighbour up in x lies within the cell, and is one of the surface's.
    let found = held(true, |cell| match cell.edges[1].level {
        0 => Fate::Split(Axis::Y),
        _ if cell.edges[1].index == 0 => Fate::Inner,
        _ => Fate::Undecided,
    });
    assert_eq!((found.levels, found.cells()), ([1; 3], 4));
    assert_eq!(found.faces.len(), 18);
}

#[test]
fn boxes_that_touch_in_an_edge_share_it_four_times() {
    let found = held(false, |at| grid(at, 1, |[x, y, z]| x == y && z == 0));
    assert_eq!((found.faces.len(), found.points.len()), (12, 14));
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
    // Halves of halves make the grid fine: that is refused at once, and not tried.
    let bytes = paving(false, |cell| match cell.edges[0].level {
        level if level < 30 && cell.edges[0].index == 0 => Fate::Split(Axis::X),
        _ => Fate::Inner,
    });
    assert!(matches!(of(&bytes, &cancel), Err(SurfaceError::TooFine)));
}

#[test]
fn corners_that_coincide_in_single_precision_are_refused() {
    let found = held(false, |cell| match cell.edges[0] {
        // A sliver of 2^-27 of the box at its upper end.
        edge if edge.level < 27 && edge.index + 1 == 1 << edge.level => Fate::Split(Axis::X),
        edge if edge.level == 27 && edge.index + 1 == 1 << 27 => Fate::Inner,
        _ => Fate::Undecided,
    });
    assert!(found.coordinates(|x| x).is_ok());
    assert!(matches!(found.coordinates(|x| x as f32), Err(SurfaceError::TooClose)));
}
