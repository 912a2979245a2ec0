//! Rows of three entries, of one machine, at vertices: what [`super`] computes for rows of any length, in the
//! same numbers, on the stack.

use super::{Multiplier, Over, Row};
use crate::arithmetic::Enclosure;
use crate::cell::Vertex;
use crate::definite::{eliminate, is_positive_definite_three, rows_of_three};
use crate::formula::Formula;
use crate::slope::Slope;

/// The entries of each row, then its `D_i`.
pub(super) type Three<'a, N> = Vec<[&'a Slope<N>; 4]>;

/// Rows, where they are of three entries, and taken at vertices for one machine.
pub(super) fn three<'a, E: Enclosure>(
    over: &'a Over<'_, E>,
    rows: &[Row<Formula>],
) -> Option<Three<'a, E::Number>> {
    let is_plain = over.controls.is_none() && over.tolerances.is_none();
    let row = |row: &Row<Formula>| match row.a[..] {
        [a, b, c] if is_plain => Some([over.of(a)?, over.of(b)?, over.of(c)?, over.of(row.d)?]),
        _ => None,
    };
    rows.iter().map(row).collect()
}

/// A row at a vertex.
fn at<E: Enclosure>(
    over: &Over<'_, E>,
    [a, b, c, d]: &[&Slope<E::Number>; 4],
    v: Vertex,
) -> Option<[E::Number; 4]> {
    let value = |slope| v.value(&over.slopes, slope);
    Some([value(a)?, value(b)?, value(c)?, value(d)?])
}

/// `c I`.
fn scalar<E: Enclosure>(e: &E, c: &E::Number) -> Option<[E::Number; 6]> {
    let zero = || e.integer(0);
    Some([c.clone(), zero()?, zero()?, c.clone(), zero()?, c.clone()])
}

/// [`super::is_lower`].
pub(super) fn is_lower<E: Enclosure>(
    over: &Over<'_, E>,
    rows: &Three<'_, E::Number>,
    v: Vertex,
    rest: &E::Number,
    Multiplier { y, places }: &Multiplier,
) -> Option<bool> {
    let e = over.slopes.arithmetic;
    let mut t = scalar(e, rest)?;
    for (row, y) in rows.iter().zip(y) {
        let ([a, b, c, d], &[p, q, r]) = (at(over, row, v)?, y.first_chunk()?);
        let [_, greatest] = e.ends(&d);
        let residual = |a, y| e.sub(&e.add(a, a)?, &e.dyadic(y, *places, &greatest)?);
        let (x, y, z) = (residual(&a, p)?, residual(&b, q)?, residual(&c, r)?);
        let half = |y, z| e.dyadic(y, places + 1, z);
        let square = |p, x| half(p, x).and_then(|half| e.add(&half, &half));
        let mixed = |p, y, q, x| e.add(&half(p, y)?, &half(q, x)?);
        let change = [
            square(p, &x)?,
            mixed(p, &y, q, &x)?,
            mixed(p, &z, r, &x)?,
            square(q, &y)?,
            mixed(q, &z, r, &y)?,
            square(r, &z)?,
        ];
        for (entry, change) in t.iter_mut().zip(&change) {
            *entry = e.add(entry, change)?;
        }
    }
    Some(is_positive_definite_three(e, &t))
}

/// [`super::is_upper`].
pub(super) fn is_upper<E: Enclosure>(
    over: &Over<'_, E>,
    rows: &Three<'_, E::Number>,
    v: Vertex,
    bound: &E::Number,
) -> Option<bool> {
    let e = over.slopes.arithmetic;
    let mut rest = scalar(e, bound)?;
    for row in rows {
        let [a, b, c, d] = at(over, row, v)?;
        let [least, _] = e.ends(&d);
        eliminate(e, &[least, a, b, c], &mut rows_of_three(&mut rest))?;
    }
    Some(is_positive_definite_three(e, &rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::Arithmetic as _;
    use crate::cell::{evaluate, Cell};
    use crate::fixed::{Fixed, Interval};
    use crate::formula::Tape;
    use crate::slope::Slopes;

    /// Numbers that look random.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self, most: i64) -> i64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (self.0 >> 33) as i64 % (2 * most + 1) - most
        }
    }

    #[test]
    fn what_is_shown_of_rows_of_any_length_is_shown_of_three_and_nothing_else() {
        let (mut numbers, mut shown) = (Numbers(1), [[0; 2]; 2]);
        let e = Fixed::<i64>::new(40);
        for _ in 0..2000 {
            let mut tape = Tape::default();
            let unit = tape.integer(16);
            let mut formula = |least: i64, most: i64| {
                let n = tape.integer(least + numbers.next(most));
                let constant = tape.div(n, unit);
                let terms = (0..3).map(|k| {
                    let (n, x) = (tape.integer(numbers.next(8)), tape.coordinate(k));
                    let product = tape.mul(n, x);
                    tape.div(product, unit)
                });
                let terms: Vec<Formula> = terms.collect();
                terms.into_iter().fold(constant, |sum, term| tape.add(sum, term))
            };
            let entry = |i: usize, j: usize| if i == j { 16 } else { 0 };
            let rows: Vec<Row<Formula>> = (0..3)
                .map(|i| Row {
                    a: (0..3).map(|j| formula(entry(i, j), 6)).collect(),
                    d: formula(16, 6),
                })
                .collect();
            let range = Interval { lo: -(1i64 << 37), hi: 1 << 37 };
            let edges = Cell(vec![range; 3]).edges().unwrap();
            let slopes = Slopes::new(&e, 3);
            let values = evaluate(&tape, &[], slopes, &edges);
            let over = Over::new(slopes, &values);
            let mut entries = |i: usize| (0..3).map(|j| entry(i, j) + numbers.next(3)).collect();
            let y = Multiplier { y: (0..3).map(&mut entries).collect(), places: 4 };
            let three = three(&over, &rows).unwrap();
            let rest = e.neg(&e.dyadic(numbers.next(4) + 4, 4, &e.integer(1).unwrap()).unwrap());
            let bound = e.dyadic(numbers.next(16) + 48, 4, &e.integer(1).unwrap());
            let (rest, bound) = (rest.unwrap(), bound.unwrap());
            for v in over.vertices() {
                let varied = over.rows(&rows, v).unwrap();
                let lower = crate::test::is_lower(&over, &varied, &rest, &y);
                assert_eq!(is_lower(&over, &three, v, &rest, &y) == Some(true), lower);
                let upper = crate::test::is_upper(&over, &varied, &bound);
                assert_eq!(is_upper(&over, &three, v, &bound) == Some(true), upper);
                shown[0][usize::from(lower)] += 1;
                shown[1][usize::from(upper)] += 1;
            }
        }
        assert!(shown.iter().flatten().all(|&n| n > 500), "{shown:?}");
    }
}
