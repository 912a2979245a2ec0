//! Level sets of a function on a grid, by marching squares.

use std::collections::BTreeMap;

/// A function at the nodes of a rectangular grid.
#[derive(Clone, Debug)]
pub struct Field {
    /// Abscissae of the columns, increasing.
    pub xs: Vec<f64>,
    /// Ordinates of the rows, increasing.
    pub ys: Vec<f64>,
    /// Values, row by row; NaN where the function has none.
    pub values: Vec<f64>,
}

/// A path in the plane.
pub type Path = Vec<[f64; 2]>;

/// The set where a function is at least a level.
#[derive(Clone, Debug, Default)]
pub struct LevelSet {
    /// Its boundary, as closed loops; inside by the even-odd rule.
    pub area: Vec<Path>,
    /// The parts of the boundary on which the function is at the level: neither the edge of the
    /// grid nor where the function ends.
    pub lines: Vec<Path>,
}

/// An edge of the padded grid: its lower end, and whether it goes up (`true`) or across.
type EdgeId = (usize, usize, bool);

/// The grid with a ring of nodes around it, at the same coordinates as its border, at which the
/// function is below every level: so all boundaries are closed.
struct Padded<'a> {
    field: &'a Field,
    level: f64,
}

impl Padded<'_> {
    /// The value at a padded node; `None` on the ring and where there is none.
    fn value(&self, i: usize, j: usize) -> Option<f64> {
        let (columns, rows) = (self.field.xs.len(), self.field.ys.len());
        let inside = (1..=columns).contains(&i) && (1..=rows).contains(&j);
        let value = if inside { self.field.values[(j - 1) * columns + i - 1] } else { f64::NAN };
        (!value.is_nan()).then_some(value)
    }

    fn within(&self, i: usize, j: usize) -> bool {
        self.value(i, j).is_some_and(|value| value >= self.level)
    }

    fn place(&self, i: usize, j: usize) -> [f64; 2] {
        let at = |all: &[f64], i: usize| all[i.saturating_sub(1).min(all.len() - 1)];
        [at(&self.field.xs, i), at(&self.field.ys, j)]
    }

    /// Where the level is crossed on an edge. Towards a node without a value, at that node.
    fn crossing(&self, (i, j, up): EdgeId) -> [f64; 2] {
        let (k, l) = if up { (i, j + 1) } else { (i + 1, j) };
        let (one, other) = (self.place(i, j), self.place(k, l));
        let part = match (self.value(i, j), self.value(k, l)) {
            (Some(a), Some(b)) => ((self.level - a) / (b - a)).clamp(0.0, 1.0),
            (Some(_), None) => 1.0,
            _ => 0.0,
        };
        let part = if part.is_nan() { 0.5 } else { part };
        [one[0] + part * (other[0] - one[0]), one[1] + part * (other[1] - one[1])]
    }

    /// The pieces of the boundary in a cell, as pairs of edges, each from where the way round the
    /// cell (counter-clockwise) leaves the set to where it enters it again.
    fn pieces(&self, i: usize, j: usize) -> Vec<(EdgeId, EdgeId)> {
        let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        let edges = [(i, j, false), (i + 1, j, true), (i, j + 1, false), (i, j, true)];
        let within = corners.map(|(i, j)| self.within(i, j));
        let leaves: Vec<usize> = (0..4).filter(|&e| within[e] && !within[(e + 1) % 4]).collect();
        let enters: Vec<usize> = (0..4).filter(|&e| !within[e] && within[(e + 1) % 4]).collect();
        // At a saddle, the value in the middle tells which corners are connected.
        let mean: Option<f64> = corners.iter().map(|&(i, j)| self.value(i, j)).sum();
        let joined = mean.is_none_or(|sum| sum / 4.0 >= self.level);
        let next = |e: usize| {
            let turn = |f: &&usize| if joined { (**f + 4 - e) % 4 } else { (e + 4 - **f) % 4 };
            enters.iter().min_by_key(turn).copied()
        };
        leaves.iter().filter_map(|&e| Some((edges[e], edges[next(e)?]))).collect()
    }

    /// Whether the function has a value at all corners of a cell.
    fn complete(&self, i: usize, j: usize) -> bool {
        [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            .iter()
            .all(|&(i, j)| self.value(i, j).is_some())
    }
}

impl Field {
    /// The field of `f` on a grid.
    pub fn of(xs: Vec<f64>, ys: Vec<f64>, mut f: impl FnMut(f64, f64) -> f64) -> Self {
        let mut values = Vec::with_capacity(xs.len() * ys.len());
        for &y in &ys {
            values.extend(xs.iter().map(|&x| f(x, y)));
        }
        Field { xs, ys, values }
    }

    /// The set where the function is at least `level`.
    pub fn at_least(&self, level: f64) -> LevelSet {
        let padded = Padded { field: self, level };
        let mut onward = BTreeMap::new();
        for j in 0..=self.ys.len() {
            for i in 0..=self.xs.len() {
                let complete = padded.complete(i, j);
                for (from, to) in padded.pieces(i, j) {
                    onward.insert(from, (to, complete));
                }
            }
        }
        let mut set = LevelSet::default();
        while let Some((&start, _)) = onward.iter().next() {
            let (mut area, mut drawn) = (Vec::new(), Vec::new());
            let mut at = start;
            while let Some((next, complete)) = onward.remove(&at) {
                area.push(padded.crossing(at));
                drawn.push(complete);
                at = next;
            }
            set.lines.extend(runs(&area, &drawn));
            set.area.push(area);
        }
        set
    }
}

/// The runs of a loop's pieces that are drawn; piece `i` goes from point `i` to the next.
fn runs(points: &[[f64; 2]], drawn: &[bool]) -> Vec<Path> {
    let n = points.len();
    let Some(gap) = drawn.iter().position(|d| !d) else {
        let closed = points.iter().chain(points.first()).copied().collect();
        return vec![closed];
    };
    let mut all: Vec<Path> = Vec::new();
    let mut run: Path = Vec::new();
    for step in 1..=n {
        let i = (gap + step) % n;
        if drawn[i] {
            if run.is_empty() {
                run.push(points[i]);
            }
            run.push(points[(i + 1) % n]);
        } else if !run.is_empty() {
            all.push(std::mem::take(&mut run));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(n: usize) -> Vec<f64> {
        (0..n).map(|i| i as f64).collect()
    }

    /// Twice the enclosed area, with the sign of the orientation.
    fn doubled_area(path: &Path) -> f64 {
        let next = path.iter().cycle().skip(1);
        path.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    }

    #[test]
    fn a_linear_function_is_cut_where_it_is_at_the_level() {
        let field = Field::of(axis(5), axis(4), |x, _| x);
        let set = field.at_least(2.5);
        assert_eq!((set.area.len(), set.lines.len()), (1, 1));
        assert!((doubled_area(&set.area[0]) / 2.0 - 1.5 * 3.0).abs() < 1e-12);
        assert!(set.lines[0].iter().all(|p| (p[0] - 2.5).abs() < 1e-12));
    }

    #[test]
    fn a_disc_has_its_area_and_a_hole_is_a_loop_of_its_own() {
        let f = |x: f64, y: f64| (x - 20.0).hypot(y - 20.0);
        let inside = Field::of(axis(41), axis(41), |x, y| -f(x, y)).at_least(-10.0);
        assert_eq!(inside.area.len(), 1);
        let area = doubled_area(&inside.area[0]) / 2.0;
        assert!((area - std::f64::consts::PI * 100.0).abs() < 2.0, "{area}");
        let outside = Field::of(axis(41), axis(41), f).at_least(10.0);
        assert_eq!((outside.area.len(), outside.lines.len()), (2, 1));
        let total: f64 = outside.area.iter().map(doubled_area).sum::<f64>() / 2.0;
        assert!((total - (1600.0 - area)).abs() < 1.0, "{total}");
    }

    #[test]
    fn where_the_function_ends_there_is_no_line() {
        let f = |x: f64, _: f64| if x > 2.0 { f64::NAN } else { 1.0 };
        let set = Field::of(axis(6), axis(6), f).at_least(0.5);
        assert_eq!((set.area.len(), set.lines.len()), (1, 0));
        assert!(Field::of(axis(3), axis(3), |_, _| 0.0).at_least(0.5).area.is_empty());
    }

    #[test]
    fn a_saddle_has_two_separate_pieces_on_either_side() {
        for (level, loops) in [(0.5, 2), (-0.5, 1)] {
            let field = Field::of(vec![-1.0, 1.0], vec![-1.0, 1.0], |x, y| x * y);
            let set = field.at_least(level);
            assert_eq!(set.area.len(), loops, "{level}");
            assert_eq!(set.lines.len(), 2);
        }
    }
}
