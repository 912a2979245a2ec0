//! Definiteness of interval matrices against brute force over their members.

use super::random::Random;
use orthocert_checker::definite::is_positive_definite;
use orthocert_checker::fixed::Fixed;
use orthocert_checker::linear::Symmetric;

/// An interval matrix of integers: the diagonal's and the others' least and greatest values.
struct Members {
    diagonal: [(i64, i64); 3],
    off: [(i64, i64); 3],
}

impl Members {
    fn random(random: &mut Random) -> Self {
        let mut interval = |least: i64, greatest: i64, width: i64| {
            let low = random.within(least, greatest);
            (low, low + random.within(0, width))
        };
        Members {
            diagonal: std::array::from_fn(|_| interval(1, 9, 2)),
            off: std::array::from_fn(|_| interval(-5, 4, 3)),
        }
    }

    fn enclosed(&self) -> Symmetric<Fixed> {
        let fixed = |&(lo, hi): &(i64, i64)| Fixed::new(lo.into(), hi.into(), 3).unwrap();
        Symmetric {
            diagonal: self.diagonal.each_ref().map(fixed),
            off: self.off.each_ref().map(fixed),
        }
    }

    /// Every member with integer entries, the vertices among them.
    fn all_definite(&self) -> bool {
        let span = |(lo, hi): (i64, i64)| lo..=hi;
        let [a, b, c] = self.diagonal;
        let [x, y, z] = self.off;
        span(x).all(|x| {
            span(y).all(|y| {
                span(z).all(|z| {
                    let off = (x, y, z);
                    span(a).all(|a| span(b).all(|b| span(c).all(|c| definite(a, b, c, off))))
                })
            })
        })
    }
}

/// Sylvester's criterion from the last diagonal entry upward; the checker goes from the first.
fn definite(a: i64, b: i64, c: i64, (x, y, z): (i64, i64, i64)) -> bool {
    let det = -z * (a * z - x * y) + c * (a * b - x * x) - y * (y * b - x * z);
    c > 0 && b * c - z * z > 0 && det > 0
}

#[test]
fn an_interval_matrix_is_accepted_exactly_if_all_its_members_are_definite() {
    let mut random = Random::new(30);
    let (mut accepted, mut rejected, mut nearly) = (0, 0, 0);
    for _ in 0..6000 {
        let members = Members::random(&mut random);
        let definite = members.all_definite();
        let Members { diagonal, off } = &members;
        let found = is_positive_definite(&members.enclosed());
        assert_eq!(found, definite, "{diagonal:?} {off:?}");
        *if found { &mut accepted } else { &mut rejected } += 1;
        // The hard cases: the midpoints are definite, some other member is not.
        let middle = |(lo, hi): (i64, i64)| lo + hi;
        let [a, b, c] = diagonal.map(middle);
        let [x, y, z] = off.map(middle);
        nearly += i32::from(!found && self::definite(a, b, c, (x, y, z)));
    }
    assert!(accepted > 300 && rejected > 300 && nearly > 300, "{accepted} {rejected} {nearly}");
}

#[test]
fn real_members_of_accepted_matrices_are_definite() {
    let mut random = Random::new(31);
    let mut tried = 0;
    while tried < 3000 {
        let members = Members::random(&mut random);
        if !is_positive_definite(&members.enclosed()) {
            continue;
        }
        tried += 1;
        // Members in 64ths; their minors are integers in powers of 64.
        let mut member = |(lo, hi): (i64, i64)| random.within(64 * lo, 64 * hi);
        let [a, b, c] = members.diagonal.map(&mut member);
        let [x, y, z] = members.off.map(&mut member);
        assert!(definite(a, b, c, (x, y, z)), "{:?} {:?}", members.diagonal, members.off);
    }
}
