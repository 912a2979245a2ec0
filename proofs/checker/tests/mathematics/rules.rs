//! Each rule's table: what it accepts, and what it rejects, named after the defect.

use super::approximate::{polar_rotation, Approximate};
use super::machines::{cube, linear_delta, orthoglide};
use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert_checker::cell::{Cell, Edge};
use orthocert_checker::claim::{MachineClaim, Sign};
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::expansion::{Expansion, ExpansionPoint, OutOfReach, Region};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::hull::Hull;
use orthocert_checker::linear::{product, Matrix};
use orthocert_checker::model::{JointRange, Model};
use orthocert_checker::rule::{self, Failure, Rotation, TightCorner, MAX_QUATERNION};
use std::array::from_fn;

const BITS: u32 = 64;

fn fixed(x: f64) -> Fixed {
    Fixed::rational(&BigRational::from_f64(x).unwrap(), 0, BITS)
}

fn cell(index: [u128; 3], level: u32) -> Cell {
    Cell { edges: index.map(|index| Edge { index, level }) }
}

/// A model with `kappa` and `k` next to the true extremes over a cell: `slack` relative to them,
/// on the true side if positive.
fn model_with_slack(claim: &MachineClaim, cell: &Cell, slack: f64) -> Model<Fixed> {
    let mut model = Model::new(claim, BITS).unwrap();
    let approximate = Approximate::new(&model);
    let least = approximate.least(cell, |m| m.xi[0]).unwrap().1;
    let greatest = -approximate.least(cell, |m| -m.xi[2]).unwrap().1;
    model.bounds.kappa = fixed(least * (1.0 - slack));
    model.bounds.k = Some(fixed(greatest * (1.0 + slack)));
    model
}

fn centred(model: &Model<Fixed>, cell: &Cell) -> Expansion<Fixed> {
    Expansion::new(model, cell, ExpansionPoint::Centre).unwrap()
}

fn rotation(q: [i64; 4], sign: Sign) -> Rotation {
    Rotation { q, sign }
}

fn is_definite_failure(result: Result<(), Failure>) -> bool {
    matches!(result, Err(Failure::NotDefinite { .. }))
}

#[test]
fn lower_on_the_orthoglide() {
    let claim = orthoglide("1", "-1/4", "1/4");
    let centre = cell([3, 3, 3], 3);
    let model = model_with_slack(&claim, &centre, 0.01);
    let expansion = centred(&model, &centre);
    let lower = |q, sign| rule::lower(&model, &expansion, &rotation(q, sign));
    let (plus, minus, most) = (Sign::Plus, Sign::Minus, MAX_QUATERNION);
    for (name, q, sign) in [
        ("identity", [1, 0, 0, 0], plus),
        ("identity, negative quaternion", [-7, 0, 0, 0], plus),
        ("identity, greatest component", [most, 0, 0, 0], plus),
        ("nearly the identity", [most, 1, -1, 1], plus),
    ] {
        assert_eq!(lower(q, sign), Ok(()), "{name}");
    }
    for (name, q, sign) in [
        ("quarter turn", [1, 0, 0, 1], plus),
        ("half turn", [0, 1, 0, 0], plus),
        ("third of a turn", [1, 1, 1, 1], plus),
        ("wrong sign", [1, 0, 0, 0], minus),
        ("eighth of a turn, greatest components", [most, most, most, most], minus),
    ] {
        assert!(is_definite_failure(lower(q, sign)), "{name}");
    }
    for (name, q) in [
        ("zero quaternion", [0; 4]),
        ("component too large", [most + 1, 0, 0, 0]),
        ("component too small", [1, 0, -most - 1, 0]),
        ("least integer", [i64::MIN, 0, 0, 0]),
        ("greatest integers", [i64::MAX; 4]),
    ] {
        assert_eq!(lower(q, plus), Err(Failure::BadRotation), "{name}");
    }
}

#[test]
fn entrywise_rejects_the_evidence_that_lower_rejects() {
    let claim = orthoglide("1", "-1/4", "1/4");
    let centre = cell([3, 3, 3], 3);
    let model = model_with_slack(&claim, &centre, 0.01);
    let expansion = centred(&model, &centre);
    let entrywise = |q, sign| rule::entrywise(&model, &expansion, &rotation(q, sign));
    let (plus, minus, most) = (Sign::Plus, Sign::Minus, MAX_QUATERNION);
    assert_eq!(entrywise([1, 0, 0, 0], plus), Ok(()));
    assert_eq!(entrywise([most, 1, -1, 1], plus), Ok(()));
    for (q, sign) in [
        ([1, 0, 0, 1], plus),
        ([0, 1, 0, 0], plus),
        ([1, 1, 1, 1], plus),
        ([1, 0, 0, 0], minus),
        ([most; 4], minus),
    ] {
        assert!(is_definite_failure(entrywise(q, sign)), "{q:?}");
    }
    for q in [[0; 4], [most + 1, 0, 0, 0], [1, 0, -most - 1, 0], [i64::MIN, 0, 0, 0]] {
        assert_eq!(entrywise(q, plus), Err(Failure::BadRotation), "{q:?}");
    }
}

/// With `W = D_s`, `W A = 40 I - 3 b b^T` and radius `r`, `X_ab` of `a = s b` has the least eigenvalue
/// `40 - 9 - 3 r`, and all others have more than 5 for `r = 11`: each of the 32 patterns is needed.
#[test]
fn each_pattern_of_ends_matters() {
    let mut model = Model::new(&orthoglide("1", "-1/4", "1/4"), BITS).unwrap();
    model.bounds.kappa = Fixed::integer(0, BITS);
    let zero = || [0; 3].map(|_| [0; 3].map(|_| Fixed::integer(0, BITS)));
    let sign = |negative: bool| if negative { -1 } else { 1 };
    for pattern in 0..32 {
        let bit = |n: i32| sign(pattern >> n & 1 == 1);
        let (s, b) = ([bit(0), bit(1), bit(2)], [1, bit(3), bit(4)]);
        let proper = s[0] * s[1] * s[2];
        // A half turn about the axis that keeps its sign.
        let q = match s.map(|x| x * proper) {
            [1, 1, 1] => [1, 0, 0, 0],
            [1, ..] => [0, 1, 0, 0],
            [_, 1, _] => [0, 0, 1, 0],
            _ => [0, 0, 0, 1],
        };
        let w = rotation(q, if proper > 0 { Sign::Plus } else { Sign::Minus });
        let within = |radius: i64| {
            let entry = |i: usize, j: usize| {
                let centre = s[i] * (if i == j { 40 } else { 0 } - 3 * b[i] * b[j]);
                Fixed::integer(centre - radius, BITS).hull(&Fixed::integer(centre + radius, BITS))
            };
            let expansion = Expansion {
                matrix: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
                slopes: [zero(), zero(), zero()],
                rho: [None, None, None],
                hull: Hull::CELL,
            };
            rule::entrywise(&model, &expansion, &w)
        };
        assert_eq!(within(10), Ok(()), "{s:?} {b:?}");
        assert!(is_definite_failure(within(11)), "{s:?} {b:?}");
    }
}

#[test]
fn lower_bounds_beyond_the_truth_are_rejected_and_short_of_it_accepted() {
    let deep = 30;
    let tiny = cell([1 << (deep - 1); 3], deep);
    for (name, claim) in
        [("orthoglide", orthoglide("1", "-1/10", "1/4")), ("linear delta", linear_delta())]
    {
        for (slack, holds) in [(1e-6, true), (1e-8, true), (-1e-8, false), (-1e-6, false)] {
            let model = model_with_slack(&claim, &tiny, slack);
            let expansion = centred(&model, &tiny);
            let best = polar_rotation(&expansion.matrix);
            let accepted = rule::lower(&model, &expansion, &best).is_ok();
            // 15 bits of evidence lose 1e-9 of the bound, quadratically.
            assert_eq!(accepted, holds, "{name}: {slack}");
        }
    }
}

#[test]
fn evidence_of_another_box_is_rejected() {
    let claim = linear_delta();
    let (one, other) = (cell([0, 8, 8], 4), cell([15, 8, 8], 4));
    let mut seen = Vec::new();
    for (here, there) in [(one, other), (other, one)] {
        let model = model_with_slack(&claim, &here, 0.3);
        let (expansion, elsewhere) = (centred(&model, &here), centred(&model, &there));
        let own = polar_rotation(&expansion.matrix);
        assert_eq!(rule::lower(&model, &expansion, &own), Ok(()), "{here}");
        let foreign = polar_rotation(&elsewhere.matrix);
        seen.push(rule::lower(&model, &expansion, &foreign));
        // The other box's rotation with the sign flipped is no better.
        let flipped = Rotation { sign: opposite(foreign.sign), ..foreign };
        assert!(is_definite_failure(rule::lower(&model, &expansion, &flipped)), "{here}");
    }
    assert!(seen.iter().all(|result| is_definite_failure(*result)), "{seen:?}");
}

fn opposite(sign: Sign) -> Sign {
    match sign {
        Sign::Plus => Sign::Minus,
        Sign::Minus => Sign::Plus,
    }
}

/// An expansion whose matrices are `U diag(t, 1, 1) V` for `t` in `[-1, 1]`, `U` and `V` orthogonal
/// up to the factor 9: at every vertex the least singular value is one, in the middle it is zero.
fn singular_between_vertices(axis: usize, entry: usize) -> Expansion<Fixed> {
    let integer = |n: i64| Fixed::integer(n, BITS);
    let diagonal = |d: [i64; 3]| -> Matrix<Fixed> {
        from_fn(|i| from_fn(|j| integer(if i == j { d[i] } else { 0 })))
    };
    // 3 times an orthogonal matrix.
    let u: Matrix<Fixed> = [[1, 2, 2], [2, 1, -2], [2, -2, 1]].map(|row| row.map(integer));
    let v: Matrix<Fixed> = [[2, -1, 2], [2, 2, -1], [-1, 2, 2]].map(|row| row.map(integer));
    let turned = |d| product(&product(&u, &diagonal(d)), &v);
    let zero = diagonal([0; 3]);
    Expansion {
        matrix: turned(from_fn(|i| i64::from(i != entry))),
        slopes: from_fn(|k| match k == axis {
            true => turned(from_fn(|i| i64::from(i == entry))),
            false => zero.clone(),
        }),
        rho: [None, None, None],
        hull: Hull::CELL,
    }
}

#[test]
fn a_singular_matrix_between_regular_vertices_is_never_accepted() {
    // sigma_min >= kappa holds at all eight vertices and fails between them: any rule that tests
    // singular values at the vertices would accept.
    let mut model = Model::new(&orthoglide("1", "-1/4", "1/4"), BITS).unwrap();
    model.bounds.kappa = fixed(1e-6);
    for (axis, entry) in (0..3).flat_map(|axis| (0..3).map(move |entry| (axis, entry))) {
        let trap = singular_between_vertices(axis, entry);
        let mut at_vertex = trap.clone();
        at_vertex.slopes = from_fn(|_| from_fn(|_| from_fn(|_| Fixed::integer(0, BITS))));
        at_vertex.matrix =
            from_fn(|i| from_fn(|j| trap.matrix[i][j].add(&trap.slopes[axis][i][j])));
        // The vertex itself is as regular as can be.
        let best = polar_rotation(&at_vertex.matrix);
        assert_eq!(rule::lower(&model, &at_vertex, &best), Ok(()));
        let components = [-2, -1, 0, 1, 2];
        let pairs = components.iter().flat_map(|&a| components.map(|b| (a, b)));
        for ((a, b), (c, d)) in pairs.clone().flat_map(|p| pairs.clone().map(move |r| (p, r))) {
            for sign in [Sign::Plus, Sign::Minus] {
                let evidence = rotation([a, b, c, d], sign);
                assert!(rule::lower(&model, &trap, &evidence).is_err(), "{evidence:?}");
            }
        }
        assert!(rule::lower(&model, &trap, &best).is_err());
    }
}

#[test]
fn upper_table() {
    let deep = 30;
    let (tiny, coarse) = (cell([1 << (deep - 1); 3], deep), cell([0; 3], 1));
    for (name, claim) in
        [("orthoglide", orthoglide("1", "-1/10", "1/4")), ("linear delta", linear_delta())]
    {
        for (row, cell, slack, holds) in [
            ("k above the greatest singular value", &tiny, 1e-7, true),
            ("k below the greatest singular value", &tiny, -1e-7, false),
            ("coarse box, generous k", &coarse, 0.5, true),
            ("coarse box, k too near the truth", &coarse, 1e-6, false),
        ] {
            let model = model_with_slack(&claim, cell, slack);
            let result = rule::upper(&model, &centred(&model, cell));
            assert_eq!(result.is_ok(), holds, "{name}: {row}");
            assert!(holds || is_definite_failure(result), "{name}: {row}");
        }
        let mut model = Model::new(&claim, BITS).unwrap();
        model.bounds.k = None;
        let result = rule::upper(&model, &centred(&model, &tiny));
        assert_eq!(result, Err(Failure::NoSuchBound), "{name}: no psi_min");
    }
    let mut model = Model::new(&orthoglide("1", "-1/4", "1/4"), BITS).unwrap();
    model.bounds.k = Some(fixed(1e-3));
    let trap = singular_between_vertices(0, 0);
    assert!(is_definite_failure(rule::upper(&model, &trap)), "norm 9 against 1/1000");
}

#[test]
fn corner_table() {
    let claim = cube("2", "200");
    let model = Model::new(&claim, BITS).unwrap();
    let about = |model: &Model<Fixed>, corner: TightCorner, cell: &Cell| {
        rule::corner(model, &Expansion::new(model, cell, corner.expansion_point()).unwrap())
    };
    let (q1, q2) = (TightCorner::Q1, TightCorner::Q2);
    for (row, corner, cell, holds) in [
        ("small box at Q1", q1, cell([0; 3], 3), true),
        ("small box at Q2", q2, cell([7; 3], 3), true),
        ("tiny box at Q2", q2, cell([(1 << 20) - 1; 3], 20), true),
        ("box below the precision", q2, cell([(1 << 120) - 1; 3], 120), false),
        ("whole cube from Q1", q1, Cell::ROOT, false),
        ("whole cube from Q2", q2, Cell::ROOT, false),
    ] {
        let result = about(&model, corner, &cell);
        assert_eq!(result.is_ok(), holds, "{row}: {result:?}");
    }
    for (row, corner, cell, touches) in [
        ("at Q1", q1, cell([0; 3], 3), true),
        ("at Q2", q2, cell([7; 3], 3), true),
        ("Q1's box for Q2", q2, cell([0; 3], 3), false),
        ("Q2's box for Q1", q1, cell([7; 3], 3), false),
        ("one step off Q1", q1, cell([0, 1, 0], 3), false),
        ("one step off Q2", q2, cell([7, 7, 6], 3), false),
        ("another corner of the cube", q2, cell([7, 0, 7], 3), false),
    ] {
        assert_eq!(corner.touches(&cell), touches, "{row}");
    }
    // The same machine as a box has no exact corner to expand about.
    let box_model = Model::new(&orthoglide("310.583", "-73", "126"), BITS).unwrap();
    assert_eq!(about(&box_model, q1, &cell([0; 3], 3)), Err(Failure::NotTheCube));
    // The lower rule cannot close what the corner rule closes, however small the box.
    let tiny = cell([(1 << 20) - 1; 3], 20);
    let lower = rule::lower(&model, &centred(&model, &tiny), &Rotation::IDENTITY);
    assert!(is_definite_failure(lower), "the bound is met with equality");
}

#[test]
fn cube_table() {
    for (psi_max, side) in [("1.000001", "1"), ("2", "200"), ("1000", "1/7")] {
        assert_eq!(rule::cube(&Model::new(&cube(psi_max, side), BITS).unwrap()), Ok(()));
    }
    let same_as_a_box = Model::new(&orthoglide("310.583", "-73", "126"), BITS).unwrap();
    assert_eq!(rule::cube(&same_as_a_box), Err(Failure::NotTheCube));
    assert_eq!(rule::cube(&Model::new(&linear_delta(), BITS).unwrap()), Err(Failure::NotTheCube));
}

#[test]
fn range_table() {
    let claim = orthoglide("1", "-1/4", "1/4");
    let cell = cell([3, 5, 1], 3);
    let mut model = Model::new(&claim, BITS).unwrap();
    let expansion = centred(&model, &cell);
    let enclosures: [Fixed; 3] = from_fn(|leg| {
        let (at, slopes) = expansion.rho[leg].as_ref().unwrap();
        let centred = slopes.iter().fold(at.clone(), |sum, h| sum.add(&h.join(&h.neg())));
        let over = Region::new(&model, &cell, ExpansionPoint::Centre).over;
        let natural = model.legs[leg].at(&over[leg]).unwrap();
        natural.rho.length().unwrap().meet(&centred).unwrap()
    });
    let unit = || Fixed::new(1.into(), 1.into(), BITS).unwrap();
    let point = |x: &num_bigint::BigInt| Fixed::new(x.clone(), x.clone(), BITS).unwrap();
    for (leg, rho) in enclosures.iter().enumerate() {
        let (low, high) = (point(rho.lo()), point(rho.hi()));
        let mut with = |min: Option<Fixed>, max: Option<Fixed>| {
            let free = || JointRange::Length { min: None, max: None };
            let mut ranges = [free(), free(), free()];
            ranges[leg] = JointRange::Length { min, max };
            model.bounds.joint_range = Some(ranges);
            rule::range(&model, &cell, &expansion)
        };
        let beyond = Err(Failure::OutOfRange(leg));
        assert_eq!(with(None, None), Ok(()), "no bound on this leg");
        assert_eq!(with(Some(low.clone()), Some(high.clone())), Ok(()), "both ends met");
        assert_eq!(with(Some(low.add(&unit())), None), beyond, "min one unit too high");
        assert_eq!(with(None, Some(high.sub(&unit()))), beyond, "max one unit too low");
        let wide = Fixed::new(rho.lo() - 1u8, rho.lo() + 1u8, BITS).unwrap();
        assert_eq!(with(Some(wide), None), beyond, "min not certainly reached");
        assert_eq!(with(Some(high), Some(low)), beyond, "ends exchanged");
    }
    model.bounds.joint_range = None;
    assert_eq!(rule::range(&model, &cell, &expansion), Err(Failure::NoSuchBound));
}

#[test]
fn boxes_out_of_reach_have_no_expansion() {
    // y^2 + z^2 < 1 for the first leg, and so on: beyond at the corners of [-3/4, 3/4]^3.
    let model = Model::new(&orthoglide("1", "-3/4", "3/4"), BITS).unwrap();
    let about = |cell| Expansion::new(&model, &cell, ExpansionPoint::Centre).map(|_| ());
    assert_eq!(about(cell([4, 4, 4], 3)), Ok(()));
    assert_eq!(about(cell([0, 0, 0], 3)), Err(OutOfReach { leg: 0 }));
    assert_eq!(about(cell([7, 3, 7], 3)), Err(OutOfReach { leg: 1 }));
    assert_eq!(about(cell([7, 7, 4], 3)), Err(OutOfReach { leg: 2 }));
    assert_eq!(about(Cell::ROOT), Err(OutOfReach { leg: 0 }));
    // Serially singular on a face of the box only: r = (0, 3/5, 4/5) exactly.
    let mut claim = orthoglide("1", "0", "3/5");
    let orthocert_checker::claim::Workspace::Box { max, .. } = &mut claim.workspace else {
        panic!("not a box")
    };
    max[2] = super::machines::exact("4/5");
    let model = Model::new(&claim, BITS).unwrap();
    let about = |cell| Expansion::new(&model, &cell, ExpansionPoint::Centre).map(|_| ());
    assert_eq!(about(cell([0, 3, 3], 2)), Err(OutOfReach { leg: 0 }));
    assert_eq!(about(cell([0, 2, 3], 2)), Ok(()));
}

/// `a I + sum_k lambda_k d_k I` with integers `a` and `d`.
fn multiples_of_identity(a: i64, d: [i64; 3]) -> Expansion<Fixed> {
    let integer = |n: i64| Fixed::integer(n, BITS);
    let times = |n: i64| from_fn(|i| from_fn(|j| integer(if i == j { n } else { 0 })));
    Expansion { matrix: times(a), slopes: d.map(times), rho: [None, None, None], hull: Hull::CELL }
}

#[test]
fn every_vertex_matters() {
    // One vertex of eight violates the bound, by little; it alone must be found.
    for vertex in 0..8u8 {
        let towards = |k: usize| if vertex >> k & 1 == 1 { 1 } else { -1 };
        let alone = Err(Failure::NotDefinite { vertex });
        let mut model = Model::new(&orthoglide("1", "-1/4", "1/4"), BITS).unwrap();
        // 10 + sum of three terms of +-1: 7 at one vertex, 9 or more at the others; 13 and 11.
        let (falling, rising) = (from_fn(|k| -towards(k)), from_fn(towards));
        for (kappa, expected) in [(6.9, Ok(())), (7.1, alone), (8.9, alone)] {
            model.bounds.kappa = fixed(kappa);
            let expansion = multiples_of_identity(10, falling);
            let found = rule::lower(&model, &expansion, &Rotation::IDENTITY);
            assert_eq!(found, expected, "{kappa}");
        }
        for (k, expected) in [(13.1, Ok(())), (12.9, alone), (11.1, alone)] {
            model.bounds.k = Some(fixed(k));
            assert_eq!(rule::upper(&model, &multiples_of_identity(10, rising)), expected, "{k}");
        }
    }
    let mut model = Model::new(&cube("2", "1"), BITS).unwrap();
    model.bounds.kappa = fixed(6.5);
    for vertex in 1..8u8 {
        // From a corner inward: 7 is reached with all of the vertex's own steps, and only there.
        let steps = i64::from(vertex.count_ones());
        let towards = from_fn(|k| if vertex >> k & 1 == 1 { -1 } else { 1 });
        let about_corner = |a| {
            let expansion = multiples_of_identity(a, towards);
            rule::corner(&model, &Expansion { hull: Hull::ABOUT_CORNER, ..expansion })
        };
        assert_eq!(about_corner(6 + steps), Err(Failure::NotDefinite { vertex }));
        assert_eq!(about_corner(7 + steps), Ok(()));
    }
    // The corner's own vertex is left to the hand proof.
    let expansion = Expansion { hull: Hull::ABOUT_CORNER, ..multiples_of_identity(6, [1; 3]) };
    assert_eq!(rule::corner(&model, &expansion), Ok(()));
}
