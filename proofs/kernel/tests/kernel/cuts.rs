//! Cells that planes cut: the parts' corners and shares, and what is accepted of them.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::pavings::{bare, header_of, reason, written};
use orthocert_kernel::paving::{
    check, Axis, Cell, Cut, Edge, Header, Item, Judge, Kind, Step, Subject, Symmetry, SHARE_BITS,
};

/// The whole share of a box.
const WHOLE: u128 = 1 << SHARE_BITS;

fn cut(normal: &[i64], ends: [i64; 2]) -> Cut {
    Cut { normal: normal.to_vec(), ends, fails: 0 }
}

fn part(share: u128) -> f64 {
    share as f64 / WHOLE as f64
}

/// A number from `-most` to `most`.
fn within(random: &mut Random, most: i64) -> i64 {
    (random.next() >> 33) as i64 % (2 * most + 1) - most
}

#[test]
fn shares_are_volumes_rounded_down() {
    let exactly = |normal: &[i64], ends: [i64; 2]| cut(normal, ends).shares(WHOLE).map(part);
    assert_eq!(exactly(&[1], [0, 0]), [0.5, 0.5]);
    assert_eq!(exactly(&[4], [-2, 1]), [0.25, 0.375]);
    assert_eq!(exactly(&[-4, 0], [-2, 1]), [0.25, 0.375]);
    assert_eq!(exactly(&[0, 1, 0], [-1, 1]), [0.0, 0.0]);
    assert_eq!(exactly(&[5, -7, 3], [-99, 99]), [0.0, 0.0]);
    assert_eq!(exactly(&[5, -7, 3], [99, 99]), [1.0, 0.0]);
    assert_eq!(exactly(&[1, 1], [-1, 1]), [0.125, 0.125]);
    // A corner of the cube: 1/48.
    let [inner, outer] = exactly(&[1, -1, 1], [-2, 2]);
    assert!(inner == outer && inner < 1.0 / 48.0 && inner > 1.0 / 48.0 - 2e-6, "{inner}");
    let mut random = Random(1);
    for m in 1..=3 {
        for _ in 0..40 {
            let normal: Vec<i64> = (0..m).map(|_| within(&mut random, 9)).collect();
            let c = within(&mut random, 20);
            let cut = cut(&normal, [c, c]);
            if !cut.is_of(m) {
                continue;
            }
            let [inner, outer] = cut.shares(WHOLE).map(part);
            // The midpoints of a grid.
            let n = 48usize;
            let u = |at: usize, k: u32| (2 * (at / n.pow(k) % n) + 1) as f64 / n as f64 - 1.0;
            let dot =
                |at: usize| -> f64 { (0..).zip(&normal).map(|(k, n)| u(at, k) * *n as f64).sum() };
            let counted =
                (0..n.pow(3)).filter(|at| dot(*at) <= c as f64).count() as f64 / n.pow(3) as f64;
            assert!((inner - counted).abs() < 0.03, "{normal:?} {c}: {inner} {counted}");
            assert!(inner + outer <= 1.0 && inner + outer > 1.0 - 4e-6, "{inner} {outer}");
        }
    }
    // Of the smallest cells too, and the greatest numbers.
    let most = cut(&[(1 << 20) - 1, 1 - (1 << 20), (1 << 20) - 1], [1 - (1 << 22), (1 << 22) - 1]);
    assert!(most.is_of(3));
    assert_eq!(most.shares(WHOLE), [0, 0]);
    let most = cut(&[(1 << 20) - 1, 1 - (1 << 20), (1 << 20) - 1], [(1 << 22) - 1; 2]);
    assert_eq!(most.shares(1), [0, 0]);
    assert_eq!(most.shares(6 * WHOLE), [6 * WHOLE, 0]);
}

/// Of all points of a grid that are before a plane, none is outside the hull of the corners: no
/// direction tells them apart. No corner is much beyond the plane.
#[test]
fn corners_hold_all_that_is_before_their_plane() {
    let one = 65536;
    let mut random = Random(7);
    for m in 1..=3usize {
        for _ in 0..60 {
            let normal: Vec<i64> = (0..m).map(|_| within(&mut random, 7)).collect();
            let ends = [within(&mut random, 14), 15];
            let cut = cut(&normal, ends);
            if !cut.is_of(m) {
                continue;
            }
            let dot = |n: &[i64], u: &[i64]| n.iter().zip(u).map(|(n, u)| n * u).sum::<i64>();
            for (side, corners) in cut.corners().iter().enumerate() {
                let (sign, end) = [(1, ends[0]), (-1, -ends[1])][side];
                let own: Vec<i64> = normal.iter().map(|n| sign * n).collect();
                let size: i64 = normal.iter().map(|n| n.abs()).sum();
                for corner in corners {
                    assert!(corner.iter().all(|u| u.abs() <= one));
                    assert!(dot(&own, corner) <= end * one + 4 * size + 7, "{normal:?} {end}");
                }
                let grid = 5i64.pow(m as u32);
                for at in 0..grid {
                    let u: Vec<i64> =
                        (0..m as u32).map(|k| (at / 5i64.pow(k) % 5 - 2) * one / 2).collect();
                    if dot(&own, &u) > end * one {
                        continue;
                    }
                    for _ in 0..20 {
                        let w: Vec<i64> = (0..m).map(|_| within(&mut random, 50)).collect();
                        let most = corners.iter().map(|corner| dot(&w, corner)).max();
                        assert!(most >= Some(dot(&w, &u)), "{normal:?} {end} {u:?}");
                    }
                }
            }
        }
    }
}

/// `x^2 + y^2 <= 1/2`, over a box.
fn disc(max: &str) -> Header {
    header_of(
        claim(&format!(
            r#"{{"mechanism":{{"formulas":{{"coordinates":["x","y"],"parameters":[],"definitions":[],"joints":[{{"rho":"x"}},{{"rho":"y"}},{{"rho":"x^2+y^2"}}]}}}},"workspace":{{"box":{{"min":["0","0"],"max":["{max}","{max}"]}}}},"require":[{{"quantity":"joint_range","leg":3,"end":"max","bound":"1/2"}}]}}"#
        )),
        12,
    )
}

/// The number of the obligation that the disc is.
fn of_disc(header: &Header) -> usize {
    Subject::new(header).unwrap().problem.obligations.len() - 1
}

/// Wherever the planes are, what is accepted is true, and most of what is true is accepted.
#[test]
fn a_disc_is_cut_where_it_ends_and_nowhere_else() {
    let header = disc("1");
    let subject = Subject::new(&header).unwrap();
    let (judge, fails) = (Judge::new(&subject).unwrap(), of_disc(&header));
    let (mut accepted, mut refused) = ([0; 2], [0; 2]);
    for (i, j, level) in [(5, 5, 3), (11, 2, 4), (2, 11, 4), (22, 3, 5), (0, 1, 1)] {
        let edge = |i: u64| Edge(i + (1 << level));
        let edges = [edge(i), edge(j), Cell::ROOT.edges[2]];
        let cell = Cell { edges, ..Cell::ROOT };
        // Of [i, i + 1]/2^level the middle and the half.
        let half = 0.5 / f64::from(1 << level);
        let (x, y) = ((2 * i + 1) as f64 * half, (2 * j + 1) as f64 * half);
        for normal in [[100, 100], [100, 20], [20, 100], [100, -5], [0, 100], [100, 0]] {
            let all = 201;
            // x^2 + y^2 is convex: greatest at corners of the inner part, and least on the plane.
            let f = |u: f64, v: f64| (x + half * u).powi(2) + (y + half * v).powi(2) - 0.5;
            let [a, b] = normal.map(|n| n as f64);
            let grid = || {
                (0..81 * 81)
                    .map(|at| ((at / 81) as f64 / 40.0 - 1.0, (at % 81) as f64 / 40.0 - 1.0))
            };
            for c in -all..=all {
                for side in 0..2 {
                    let ends = [[c, all], [-all, c]][side];
                    let cut = Cut { normal: normal.to_vec(), ends, fails };
                    let is_on = |(u, v): &(f64, f64)| {
                        [a * u + b * v <= f64::from(c as i32), a * u + b * v >= f64::from(c as i32)]
                            [side]
                    };
                    let is = judge.confirms(&cell, 0, &bare(Kind::Cut(cut)));
                    let is_true = grid().filter(is_on).all(|(u, v)| {
                        if side == 0 {
                            f(u, v) <= 0.0
                        } else {
                            f(u, v) > 0.0
                        }
                    });
                    assert!(!is || is_true, "{i} {j} {level}: {normal:?} {ends:?}");
                    accepted[side] += usize::from(is);
                    refused[side] += usize::from(is_true && !is);
                }
            }
        }
    }
    // Curvature over the cell, and slack.
    assert!(
        accepted.iter().zip(&refused).all(|(a, r)| *a > 1500 && r * 8 < *a),
        "{accepted:?} {refused:?}"
    );
}

#[test]
fn what_may_not_be_cut_is_not() {
    let header = disc("1");
    let fails = of_disc(&header);
    let split = bare(Kind::Split(Axis::X));
    let right =
        |cut: Cut| vec![split.clone(), bare(Kind::Boundary), bare(Kind::Cut(Cut { fails, ..cut }))];
    let whole = [-999, 999];
    let of = |items: &[Item]| check(&*written(&header, items));
    let (inner, outer) = ([-250, 999], [-999, 180]);
    for good in [whole, inner, outer, [-250, 180]] {
        of(&right(cut(&[100, 200], good))).unwrap_or_else(|e| panic!("{good:?}: {e}"));
    }
    let found = of(&right(cut(&[100, 200], [-250, 180]))).unwrap().summary;
    // Triangles at two corners, of a cell that is half of the box.
    let [one, other] = [0.5f64 * 0.25 * 0.125, 0.5 * 0.6 * 0.3].map(|share| share / 2.0);
    assert!((part(found.inner_share.0) - one).abs() < 1e-6, "{}", part(found.inner_share.0));
    assert!((part(found.boundary_share.0) - (1.0 - one - other)).abs() < 1e-6);
    let twice = Cut { normal: vec![100, 200, 0], ends: whole, fails };
    for (name, wrong) in [
        ("no plane", cut(&[0, 0], [0, 0])),
        ("of one coordinate", cut(&[100], whole)),
        ("of three", twice),
        ("of many bits", cut(&[1 << 20, 0], whole)),
        ("far", cut(&[100, 0], [-1 << 22, 0])),
        ("out of order", cut(&[100, 200], [180, -250])),
        ("extreme", cut(&[i64::MIN, 0], [i64::MIN, i64::MAX])),
    ] {
        let found = reason(&written_anyway(&header, &right(wrong)));
        assert!(found.contains("cut by no plane"), "{name}: {found}");
    }
    for (name, wrong, expected) in [
        ("inner beyond the disc", cut(&[100, 200], [0, 999]), "is not certainly met"),
        ("outer within the disc", cut(&[100, 200], [-999, 0]), "is not outer"),
        ("the other way round", cut(&[-100, -200], [-250, 180]), "is not certainly met"),
    ] {
        let found = reason(&written(&header, &right(wrong)));
        assert!(found.contains(expected), "{name}: {found}");
    }
    for other in (0..fails).chain([fails + 1, 63, 255]) {
        let mut items = right(cut(&[100, 200], outer));
        let Kind::Cut(cut) = &mut items[2].kind else { panic!("cut") };
        cut.fails = other;
        assert!(reason(&written(&header, &items)).contains("is not outer"), "{other}");
    }
    let mut idle = right(cut(&[100, 200], inner));
    idle[2].steps = vec![Step(0, None)];
    assert!(reason(&written_anyway(&header, &idle)).contains("neither split nor inner"));
    // Shares are of places, and of all others at once.
    let named = Header { coordinates: Some(vec!["x".into(), "y".into()]), ..header.clone() };
    let found = reason(&written_anyway(&named, &right(cut(&[100, 200], inner))));
    assert!(found.contains("cut by no plane, or is no cell"), "{found}");
}

/// With the summary of no tree at all: nodes are refused before it is read.
fn written_anyway(header: &Header, items: &[Item]) -> Vec<u8> {
    crate::pavings::body(header, items)
}

/// A cell that is all but lost in the rounding of its ends is not cut.
#[test]
fn cells_near_the_precision_are_not_cut() {
    let header = Header { precision: 32, depth: 100, ..disc("sqrt(2)") };
    let subject = Subject::new(&header).unwrap();
    let judge = Judge::new(&subject).unwrap();
    let fails = of_disc(&header);
    let at = |level: u32| {
        // About (1/2, 0): f = 1/4 there.
        let index = |part: f64| (part / 2f64.sqrt() * (1u64 << level) as f64) as u64;
        let edge = |part: f64| Edge(index(part) + (1 << level));
        let cell = Cell { edges: [edge(0.5), edge(0.0), Cell::ROOT.edges[2]], ..Cell::ROOT };
        let cut = Cut { normal: vec![1, 1], ends: [2, 3], fails };
        judge.confirms(&cell, 0, &bare(Kind::Cut(cut)))
    };
    assert!(at(4) && at(14));
    assert!(!at(18) && !at(30) && !at(40));
    let inner = |level: u32| {
        let edge = Edge(1 << level);
        judge.confirms(
            &Cell { edges: [edge, edge, Cell::ROOT.edges[2]], ..Cell::ROOT },
            0,
            &bare(Kind::Inner),
        )
    };
    assert!(inner(18) && inner(30));
}

/// With symmetry a cell stands for six images, if all of it is in order.
#[test]
fn cells_that_are_not_all_in_order_are_not_cut() {
    let text = r#"{"mechanism":{"translational":[L0,L1,L2]},"workspace":{"box":{"min":["-0.7","-0.7","-0.7"],"max":["0.7","0.7","0.7"]}},"require":[{"quantity":"transmission","end":"min","bound":"1/2"},{"quantity":"transmission","end":"max","bound":"2"}]}"#;
    let leg = |i: usize| {
        let n = [0, 1, 2].map(|k| if k == i { r#""1""# } else { r#""0""# }).join(",");
        format!(
            r#"{{"drive":"slider","direction":[{n}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":"1","mode":"+"}}"#
        )
    };
    let text = (0..3).fold(text.to_owned(), |text, i| text.replace(&format!("L{i}"), &leg(i)));
    let header = Header { symmetry: Some(Symmetry::Permutations), ..header_of(claim(&text), 20) };
    let edge = |index: u64, level: u32| Edge(index + (1 << level));
    let whole = |edges| header.may_cut(&Cell { edges, ..Cell::ROOT });
    assert!(!header.may_cut(&Cell::ROOT));
    assert!(
        whole([edge(0, 2), edge(1, 2), edge(2, 2)]) && whole([edge(0, 2), edge(1, 2), edge(1, 1)])
    );
    assert!(
        !whole([edge(0, 2), edge(0, 2), edge(2, 2)])
            && !whole([edge(1, 2), edge(0, 2), edge(2, 2)])
    );
    assert!(!whole([edge(0, 2), edge(0, 1), edge(1, 1)]));
    let items = vec![bare(Kind::Cut(cut(&[1, 1, 1], [-9, 9])))];
    assert!(reason(&written_anyway(&header, &items)).contains("stands for itself alone"));
}
