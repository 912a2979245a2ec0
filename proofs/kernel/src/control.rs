//! Polynomials of degree two at most in each coordinate, at the control points of a cell.
//!
//! **Lemma (control points).** Let the range of coordinate `k` be `[l, h]`, and
//!
//! ```text
//! (lin, sq):   (l, l^2)    ((l + h)/2, l h)    (h, h^2)
//! ```
//!
//! its three *nodes*. Let a formula be affine in each pair `(x_k, x_k^2)`, whatever the others are. For
//! every point of the cell there are weights, not negative and of sum 1, *the same for all such
//! formulas*, with which `f(x)` is the weighted sum of the `f_j`, the formula with a node of each
//! coordinate in place of `(x_k, x_k^2)`. *Proof.* With `t = (x_k - l)/(h - l)` the Bernstein
//! polynomials `(1 - t)^2`, `2 t (1 - t)`, `t^2` are not negative, of sum 1, and
//!
//! ```text
//! (1 - t)^2 l + t (1 - t) (l + h) + t^2 h = l + t (h - l) = x_k
//! (1 - t)^2 l^2 + 2 t (1 - t) l h + t^2 h^2 = ((1 - t) l + t h)^2 = x_k^2
//! ```
//!
//! (if `l = h`, all nodes are `(x_k, x_k^2)`). So the pair is a weighted sum of the nodes, and `f`, affine
//! in it, the same sum; coordinate after coordinate, with products of the weights. ∎ A coordinate of
//! which no formula has the square needs the nodes `l` and `h` alone.
//!
//! *Ends alone.* Let what is shown be the easier the less `x_k^2` is, all else the same. Then the nodes `(l, l^2)` and
//! `(h, h^2)` of that coordinate will do ([`Control::at_ends`]): with the weights `1 - t` and `t` their sum
//! is `(x_k, s)`, `s = x_k^2 + t (1 - t) (h - l)^2 >= x_k^2`.
//!
//! The middle node is no point of the parabola: to take `((l + h)/2)^2` for its square would be unsound.
//! `(x - 1/4)^2 - 1/32` on `[0, 1]` has the values 1/32, 1/32, 17/32 at 0, 1/2 and 1, and -1/32 at 1/4.
//!
//! So these are to a formula what [`crate::cell::Vertex`] values are, and the tests are the same; but
//! nothing is lost to slopes.

use crate::arithmetic::{Arithmetic, Enclosure};
use crate::formula::{Formula, Op, Tape};
use crate::slope::MOST_COORDINATES;
use std::collections::HashMap;

/// The degree in each coordinate.
type Degrees = [u8; MOST_COORDINATES];

const CONSTANT: Degrees = [0; MOST_COORDINATES];

/// Formulas at control points.
#[derive(Clone, Debug)]
pub struct Control {
    /// Coordinate `m + k` is the square of coordinate `k`.
    tape: Tape,
    m: usize,
    pub(crate) images: HashMap<Formula, (Formula, Degrees)>,
    degrees: Degrees,
}

impl Control {
    /// Of a tape in `m` coordinates, those of the `wanted` formulas that are certainly affine in each
    /// `(x_k, x_k^2)`: sums; products of formulas that share no coordinate; squares of coordinates; and
    /// anything of what depends on none.
    pub fn new(tape: &Tape, m: usize, wanted: &[Formula]) -> Self {
        let mut own = Tape::default();
        let mut images: Vec<Option<(Formula, Degrees)>> = Vec::new();
        for (&op, needed) in tape.ops().iter().zip(tape.parts(wanted)) {
            let of = |f: Formula| images.get(f.0).copied().flatten();
            let image = needed.then(|| image(&mut own, m, op, tape, of)).flatten();
            images.push(image);
        }
        let known = wanted.iter().filter_map(|&f| Some((f, *images.get(f.0)?.as_ref()?)));
        let images: HashMap<Formula, (Formula, Degrees)> = known.collect();
        let degrees = images.values().fold(CONSTANT, |all, (_, d)| most(&all, d));
        Control { tape: own, m, images, degrees }
    }

    /// With the nodes at the ends alone of the first coordinates.
    #[must_use]
    pub fn at_ends(mut self, coordinates: usize) -> Self {
        self.degrees.iter_mut().take(coordinates).for_each(|degree| *degree = (*degree).min(1));
        self
    }

    /// Numbers that [`Control::values`] finds: of each formula one for all nodes of the coordinates that it depends on.
    pub fn work(&self) -> usize {
        let mut depends: Vec<[bool; MOST_COORDINATES]> = Vec::new();
        let mut sum = 0usize;
        for &op in self.tape.ops() {
            let own = |k: usize| match op {
                Op::Coordinate(j) => j % self.m == k,
                _ => op.parts().any(|f| depends[f.0][k]),
            };
            let own = std::array::from_fn(own);
            let of = |(on, &degree): (&bool, &u8)| if *on { usize::from(degree) + 1 } else { 1 };
            sum = sum.saturating_add(own.iter().zip(&self.degrees).map(of).product());
            depends.push(own);
        }
        sum
    }

    /// How many control points there are.
    pub fn points(&self) -> usize {
        self.degrees.iter().map(|&d| usize::from(d) + 1).product()
    }

    /// Values at all control points; `edges` has, for each coordinate, the cell's centre, range and
    /// half-width.
    pub fn values<E: Enclosure>(
        &self,
        e: &E,
        parameters: &[E::Number],
        edges: &[[E::Number; 3]],
    ) -> Option<Controls<E::Number>> {
        let nodes = |(range, &degree): (&[E::Number; 3], &u8)| nodes(e, &range[1], degree);
        let nodes = edges.iter().zip(&self.degrees).map(nodes).collect::<Option<Vec<_>>>()?;
        let counts = std::array::from_fn(|k| nodes.get(k).map_or(1, Vec::len));
        let own = |k: usize, part: usize| {
            let values = nodes.get(k)?.iter().map(|node| node[part].clone()).collect();
            Some(Tensor { depends: std::array::from_fn(|other| other == k), values })
        };
        let tensors = Tensors { e, nodes: counts };
        let at = self.tape.run(
            &tensors,
            |k| if k < self.m { own(k, 0) } else { own(k - self.m, 1) },
            |j| parameters.get(j).cloned().map(Tensor::constant),
        );
        let mut values = Vec::new();
        for (f, (image, _)) in &self.images {
            let Some(Tensor { depends, values: own }) = at.of(*image).cloned() else { continue };
            values.resize_with(values.len().max(f.0 + 1), || None);
            values[f.0] = Some((tensors.strides(&depends), own));
        }
        let point = |mut j: usize| {
            counts.map(|nodes| {
                let node = j % nodes;
                j /= nodes;
                node
            })
        };
        let points = (0..counts.iter().product()).map(point).collect();
        Some(Controls { nodes: counts, points, values })
    }
}

/// The values of a formula at the nodes of the coordinates that it depends on, those of the first one next to
/// each other.
#[derive(Clone, Debug)]
struct Tensor<N> {
    depends: [bool; MOST_COORDINATES],
    values: Vec<N>,
}

impl<N> Tensor<N> {
    fn constant(value: N) -> Self {
        Tensor { depends: [false; MOST_COORDINATES], values: vec![value] }
    }
}

/// The arithmetic of values at all nodes; of so many a coordinate.
struct Tensors<'a, E> {
    e: &'a E,
    nodes: [usize; MOST_COORDINATES],
}

impl<E: Enclosure> Tensors<'_, E> {
    /// From one node of each coordinate to the next; 0 where nothing depends on it.
    fn strides(&self, depends: &[bool; MOST_COORDINATES]) -> [usize; MOST_COORDINATES] {
        let mut size = 1;
        std::array::from_fn(|k| {
            let stride = if depends[k] { size } else { 0 };
            size *= if depends[k] { self.nodes[k] } else { 1 };
            stride
        })
    }

    fn each(
        &self,
        a: &Tensor<E::Number>,
        of: impl Fn(&E::Number) -> Option<E::Number>,
    ) -> Option<Tensor<E::Number>> {
        let values = a.values.iter().map(of).collect::<Option<_>>()?;
        Some(Tensor { depends: a.depends, values })
    }

    fn both(
        &self,
        a: &Tensor<E::Number>,
        b: &Tensor<E::Number>,
        of: impl Fn(&E::Number, &E::Number) -> Option<E::Number>,
    ) -> Option<Tensor<E::Number>> {
        let depends = std::array::from_fn(|k| a.depends[k] || b.depends[k]);
        let (p, q) = (self.strides(&a.depends), self.strides(&b.depends));
        let along: Vec<usize> = (0..MOST_COORDINATES).filter(|&k| depends[k]).collect();
        let size = along.iter().map(|&k| self.nodes[k]).product();
        let mut values = Vec::with_capacity(size);
        let (mut i, mut j, mut node) = (0, 0, [0; MOST_COORDINATES]);
        while values.len() < size {
            values.push(of(a.values.get(i)?, b.values.get(j)?)?);
            for &k in &along {
                (i, j, node[k]) = (i + p[k], j + q[k], node[k] + 1);
                if node[k] < self.nodes[k] {
                    break;
                }
                (i, j, node[k]) = (i - p[k] * node[k], j - q[k] * node[k], 0);
            }
        }
        Some(Tensor { depends, values })
    }
}

impl<E: Enclosure> Arithmetic for Tensors<'_, E> {
    type Number = Tensor<E::Number>;

    fn integer(&self, n: i64) -> Option<Self::Number> {
        self.e.integer(n).map(Tensor::constant)
    }

    fn add(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number> {
        self.both(a, b, |a, b| self.e.add(a, b))
    }

    fn sub(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number> {
        self.both(a, b, |a, b| self.e.sub(a, b))
    }

    fn neg(&self, a: &Self::Number) -> Option<Self::Number> {
        self.each(a, |a| self.e.neg(a))
    }

    fn mul(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number> {
        self.both(a, b, |a, b| self.e.mul(a, b))
    }

    fn div(&self, a: &Self::Number, b: &Self::Number) -> Option<Self::Number> {
        self.both(a, b, |a, b| self.e.div(a, b))
    }

    fn sqr(&self, a: &Self::Number) -> Option<Self::Number> {
        self.each(a, |a| self.e.sqr(a))
    }

    fn sqrt(&self, a: &Self::Number) -> Option<Self::Number> {
        self.each(a, |a| self.e.sqrt(a))
    }
}

/// Formulas at the control points of a cell.
#[derive(Clone, Debug)]
pub struct Controls<N> {
    /// How many nodes each coordinate has.
    nodes: [usize; MOST_COORDINATES],
    /// Of each control point the number of its node of each coordinate.
    points: Vec<[usize; MOST_COORDINATES]>,
    /// Of each formula its values, and from one node of each coordinate to the next.
    values: Vec<Option<([usize; MOST_COORDINATES], Vec<N>)>>,
}

impl<N> Controls<N> {
    /// How many points there are.
    #[allow(clippy::len_without_is_empty, reason = "there is one at least")]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether control points are the same.
    pub fn is_like(&self, other: &Self) -> bool {
        self.nodes == other.nodes
    }

    /// Where between the ends of its range, as -1, 0 and 1, control point `j` has coordinate `k`; `None` of a
    /// coordinate that no formula has.
    pub fn place(&self, k: usize, j: usize) -> Option<i64> {
        match (self.nodes.get(k)?, self.points.get(j)?.get(k)?) {
            (2, 0) | (3, 0) => Some(-1),
            (3, 1) => Some(0),
            (2, 1) | (3, 2) => Some(1),
            _ => None,
        }
    }

    /// Encloses `f_j`; `None` where it is not defined at all control points, or the formula has not the form.
    pub fn at(&self, formula: Formula, j: usize) -> Option<&N> {
        let (strides, values) = self.values.get(formula.0)?.as_ref()?;
        let terms = self.points.get(j)?.iter().zip(strides);
        values.get(terms.map(|(node, stride)| node * stride).sum::<usize>())
    }
}

fn most(a: &Degrees, b: &Degrees) -> Degrees {
    std::array::from_fn(|k| a[k].max(b[k]))
}

/// An entry, and its degrees, from those of its parts.
fn image(
    own: &mut Tape,
    m: usize,
    op: Op,
    tape: &Tape,
    of: impl Fn(Formula) -> Option<(Formula, Degrees)>,
) -> Option<(Formula, Degrees)> {
    let with = |k: usize, degree: u8| {
        let mut degrees = CONSTANT;
        *degrees.get_mut(k).filter(|_| k < m)? = degree;
        Some(degrees)
    };
    let constant = |f: Formula| of(f).filter(|(_, d)| *d == CONSTANT).map(|(f, _)| f);
    Some(match op {
        Op::Coordinate(k) => (own.coordinate(k), with(k, 1)?),
        Op::Parameter(j) => (own.parameter(j), CONSTANT),
        Op::Integer(n) => (own.integer(n), CONSTANT),
        Op::Add(a, b) | Op::Sub(a, b) => {
            let ((a, p), (b, q)) = (of(a)?, of(b)?);
            let sum = if matches!(op, Op::Add(..)) { own.add(a, b) } else { own.sub(a, b) };
            (sum, most(&p, &q))
        }
        Op::Neg(a) => {
            let (a, p) = of(a)?;
            (own.neg(a), p)
        }
        Op::Mul(a, b) => {
            let ((a, p), (b, q)) = (of(a)?, of(b)?);
            let apart = p.iter().zip(&q).all(|(&p, &q)| p == 0 || q == 0);
            apart.then(|| (own.mul(a, b), most(&p, &q)))?
        }
        Op::Div(a, b) => {
            let ((a, p), b) = (of(a)?, constant(b)?);
            (own.div(a, b), p)
        }
        Op::Sqr(a) => match tape.op(a) {
            Op::Coordinate(k) => (own.coordinate(m + k), with(k, 2)?),
            _ => (own.sqr(constant(a)?), CONSTANT),
        },
        Op::Sqrt(a) => (own.sqrt(constant(a)?), CONSTANT),
        Op::Elbow(..) => return None,
    })
}

/// The nodes `(lin, sq)` of a coordinate, as many as its degree needs.
fn nodes<E: Enclosure>(e: &E, range: &E::Number, degree: u8) -> Option<Vec<[E::Number; 2]>> {
    let [l, h] = e.ends(range);
    let end = |x: &E::Number| Some([x.clone(), e.sqr(x)?]);
    let middle = || Some([e.halve(&e.add(&l, &h)?)?, e.mul(&l, &h)?]);
    Some(match degree {
        0 => vec![end(&l)?],
        1 => vec![end(&l)?, end(&h)?],
        _ => vec![end(&l)?, middle()?, end(&h)?],
    })
}
