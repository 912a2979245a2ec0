//! Connected components of the inner part of a paving.
//!
//! Inner boxes that share a part of a face are connected: their union is. What is counted as two
//! components may be one component of the region, joined in the undecided boxes between them.

use super::isotropy::{best_conditioned, centre_of, parts_of, sides, Point};
use super::Decider;
use orthocert_kernel::paving::{Axis, Cell, Edge, Kind, Reader, Rejected};
use rayon::prelude::*;
use std::io::Read;

/// Bytes that a node and its box take, about.
const NODE_BYTES: u64 = 64;

/// A component, or several that are images of each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its share of the box's volume, with its images, in units of `2^-SHARE_BITS`.
    pub share: u128,
    /// Boxes, without images.
    pub boxes: u64,
    /// How many components it stands for: 1, 3 or 6 with symmetry, else 1.
    pub copies: u64,
    /// Whether it, or an image of it, has the best conditioned point.
    pub best_conditioned: bool,
}

/// The components of the inner part.
#[derive(Clone, Debug, PartialEq)]
pub struct Components {
    /// By descending share.
    pub all: Vec<Component>,
    /// The least `sigma_max / sigma_min` found in an inner box: 1 at an isotropic point.
    pub conditioning: f64,
    /// Where that is, in parts of the box that is paved.
    pub best_conditioned_at: [f64; 3],
}

impl Components {
    /// The best conditioned point, in the box with these ends: to eight digits of its width, as it was
    /// found by searching.
    pub fn point(&self, ends: &[(f64, f64)]) -> Vec<f64> {
        let along = |(&(least, most), u): (&(f64, f64), f64)| {
            let grid = 1e-8 * (most - least);
            ((least + u * (most - least)) / grid).round() * grid + 0.0
        };
        ends.iter().zip(self.best_conditioned_at).map(along).collect()
    }

    /// What the best conditioned point is.
    pub fn what_is_there(&self) -> &'static str {
        if self.conditioning < 1.0 + 1e-6 {
            "isotropic point"
        } else {
            "best conditioned point found"
        }
    }
}

/// The tree without what has no inner box.
#[derive(Clone, Copy)]
enum Node {
    Split(Axis, u32, u32),
    Inner(u32),
    Nothing,
}

/// Finds the components of a paving; `None` if that takes more than `memory` bytes.
///
/// # Errors
/// If the paving cannot be read.
pub fn components<R: Read>(
    reader: &mut Reader<R>,
    decider: &Decider<'_>,
    memory: u64,
) -> Result<Option<Components>, Rejected> {
    let most = usize::try_from(memory / NODE_BYTES).unwrap_or(usize::MAX).min(u32::MAX as usize);
    let symmetric = reader.header().symmetry.is_some();
    let mut nodes: Vec<Node> = Vec::new();
    let mut inner: Vec<Cell> = Vec::new();
    // Splits that wait for their halves: the axis, and the lower half once it is known.
    let mut waiting: Vec<(Axis, Option<u32>)> = Vec::new();
    let mut root = NOTHING;
    while let Some(visited) = reader.next()? {
        if nodes.len() + inner.len() + waiting.len() > most {
            return Ok(None);
        }
        if visited.cell.is_part() {
            continue;
        }
        let mut done = match visited.item.kind {
            Kind::Split(axis) => {
                waiting.push((axis, None));
                continue;
            }
            Kind::Inner | Kind::Part(_) => {
                inner.push(visited.cell);
                nodes.push(Node::Inner(inner.len() as u32 - 1));
                nodes.len() as u32 - 1
            }
            _ => NOTHING,
        };
        while let Some((axis, lower)) = waiting.pop() {
            let Some(lower) = lower else {
                waiting.push((axis, Some(done)));
                break;
            };
            if lower != NOTHING || done != NOTHING {
                nodes.push(Node::Split(axis, lower, done));
                done = nodes.len() as u32 - 1;
            }
        }
        root = done;
    }
    let mut union =
        Union { nodes: &nodes, inner: &inner, parent: (0..inner.len() as u32).collect() };
    union.within(root);
    Ok(Some(union.found(root, decider, symmetric)))
}

/// The place of a subtree that has no inner box.
const NOTHING: u32 = u32::MAX;

/// The edges of a box: a third of what a cell is, which walks copy often.
type Edges = [Edge; 3];

/// Sets of inner boxes that are known to be connected.
struct Union<'a> {
    nodes: &'a [Node],
    inner: &'a [Cell],
    parent: Vec<u32>,
}

impl Union<'_> {
    fn node(&self, at: u32) -> Node {
        self.nodes.get(at as usize).copied().unwrap_or(Node::Nothing)
    }

    fn root(&mut self, mut at: u32) -> u32 {
        while self.parent[at as usize] != at {
            let above = self.parent[self.parent[at as usize] as usize];
            self.parent[at as usize] = above;
            at = above;
        }
        at
    }

    /// Joins what touches within a subtree, in a walk over its splits.
    fn within(&mut self, top: u32) {
        let mut waiting = vec![(top, Cell::ROOT.edges)];
        while let Some((at, edges)) = waiting.pop() {
            if let Node::Split(axis, lower, upper) = self.node(at) {
                let [below, above] = halves(edges, axis);
                waiting.extend([(lower, below), (upper, above)]);
                self.across(axis, (lower, below), (upper, above));
            }
        }
    }

    /// Joins what touches across a plane orthogonal to `axis`, with `low` next to it from below and
    /// `high` from above.
    fn across(&mut self, axis: Axis, low: (u32, Edges), high: (u32, Edges)) {
        let mut waiting = vec![(low, high)];
        while let Some((low, high)) = waiting.pop() {
            let overlap = |k: usize| overlaps(low.1[k], high.1[k]);
            if !(0..3).all(|k| k == axis.index() || overlap(k)) {
                continue;
            }
            match (self.node(low.0), self.node(high.0)) {
                (Node::Nothing, _) | (_, Node::Nothing) => {}
                (Node::Inner(a), Node::Inner(b)) => {
                    let (a, b) = (self.root(a), self.root(b));
                    self.parent[a.max(b) as usize] = a.min(b);
                }
                (Node::Split(along, lower, upper), _) => {
                    let [below, above] = halves(low.1, along);
                    waiting.push(((upper, above), high));
                    if along != axis {
                        waiting.push(((lower, below), high));
                    }
                }
                (Node::Inner(_), Node::Split(along, lower, upper)) => {
                    let [below, above] = halves(high.1, along);
                    waiting.push((low, (lower, below)));
                    if along != axis {
                        waiting.push((low, (upper, above)));
                    }
                }
            }
        }
    }

    /// The inner box that a point is in, below a node.
    fn box_of(&self, (at, edges): (u32, Edges), point: &Point) -> Option<u32> {
        let (axis, lower, upper) = match self.node(at) {
            Node::Nothing => return None,
            Node::Inner(found) => return Some(found),
            Node::Split(axis, lower, upper) => (axis, lower, upper),
        };
        let [below, above] = halves(edges, axis);
        let [in_lower, in_upper] = sides(edges[axis.index()], point[axis.index()]);
        let found = in_lower.then(|| self.box_of((lower, below), point)).flatten();
        found.or_else(|| in_upper.then(|| self.box_of((upper, above), point)).flatten())
    }

    fn found(mut self, top: u32, decider: &Decider<'_>, symmetric: bool) -> Components {
        let mut sums: Vec<(u128, u64, u8)> = vec![(0, 0, 0); self.inner.len()];
        for (i, cell) in self.inner.iter().enumerate() {
            let root = self.root(i as u32);
            let sum = &mut sums[root as usize];
            sum.0 += decider.share(cell);
            sum.1 += 1;
            sum.2 |= mirrors(cell);
        }
        // Of a point, the image that a symmetric paving holds.
        let held = |point: &Point| {
            let mut held = *point;
            if symmetric {
                held.sort_unstable();
            }
            self.box_of((top, Cell::ROOT.edges), &held)
        };
        let centres = self.inner.par_iter().enumerate();
        let start = centres
            .map(|(i, cell)| (decider.conditioning(parts_of(&centre_of(cell))), i, cell))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let best = start.map(|(_, _, cell)| {
            best_conditioned(decider, centre_of(cell), |point| held(point).is_some())
        });
        let (point, conditioning) = best.unwrap_or(([0; 3], f64::INFINITY));
        let best = best.filter(|(_, conditioning)| conditioning.is_finite());
        let best_box = best.and_then(|(point, _)| held(&point));
        let best_root = best_box.map(|found| self.root(found));
        let copies = |planes: u8| match planes.count_ones() {
            _ if !symmetric => 1,
            0 => 6,
            1 => 3,
            _ => 1,
        };
        let mut all: Vec<Component> = sums
            .iter()
            .enumerate()
            .filter(|(_, sum)| sum.1 > 0)
            .map(|(root, &(share, boxes, planes))| Component {
                share,
                boxes,
                copies: copies(planes),
                best_conditioned: Some(root as u32) == best_root,
            })
            .collect();
        all.sort_by_key(|component| std::cmp::Reverse(component.share));
        Components { all, conditioning, best_conditioned_at: parts_of(&point) }
    }
}

/// The lower and the upper half along an axis.
fn halves(mut edges: Edges, axis: Axis) -> [Edges; 2] {
    let mut above = edges;
    let Edge(own) = edges[axis.index()];
    (edges[axis.index()], above[axis.index()]) = (Edge(2 * own), Edge(2 * own + 1));
    [edges, above]
}

/// Whether two dyadic intervals have inner points in common: one contains the other.
fn overlaps(a: Edge, b: Edge) -> bool {
    let (longer, shorter) = if a.level() <= b.level() { (a, b) } else { (b, a) };
    shorter.index() >> (shorter.level() - longer.level()) == longer.index()
}

/// The planes `u_x = u_y`, `u_y = u_z`, `u_x = u_z` that have inner points of the cell: it overlaps
/// with its image in them. The images of a component under the group that its planes generate are
/// the component itself: of the six, one is left for two planes or more, three for one.
fn mirrors(cell: &Cell) -> u8 {
    let [x, y, z] = cell.edges;
    u8::from(overlaps(x, y)) | u8::from(overlaps(y, z)) << 1 | u8::from(overlaps(x, z)) << 2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::paving::header;
    use orthocert_kernel::paving::{Header, Item, Subject};

    /// A small box about the isotropic point, with every cell inner or not as the test wants:
    /// components do not look at evidence.
    fn claimed(symmetric: bool) -> Header {
        let text = "[mechanism]\nkind = \"orthoglide\"\nleg_length = 1\n[workspace]\n\
                    min = [-0.1, -0.1, -0.1]\nmax = [0.1, 0.1, 0.1]\n[requirements]\n\
                    transmission = { min = \"1/2\", max = 2 }\n";
        let design = crate::design::Design::parse(text, "test").unwrap();
        let mut header = header(&design.claim, None, 9);
        if !symmetric {
            header.symmetry = None;
        }
        header
    }

    /// The components where the cells of a grid of eight along each axis are inner as told.
    fn of(symmetric: bool, inner: impl Fn([u64; 3]) -> bool) -> Vec<(u64, u64)> {
        let header = claimed(symmetric);
        let mut bytes = serde_json::to_vec(&header).unwrap();
        bytes.push(b'\n');
        let mut waiting = vec![(Cell::ROOT, 0)];
        while let Some((cell, depth)) = waiting.pop() {
            let kind = if depth < 9 {
                let axis = Axis::ALL[depth % 3];
                let (lower, upper) = cell.halves(axis).unwrap();
                waiting.extend([(upper, depth + 1), (lower, depth + 1)]);
                Kind::Split(axis)
            } else if inner(cell.edges.map(Edge::index)) {
                Kind::Inner
            } else {
                Kind::Boundary
            };
            Item { steps: Vec::new(), kind }.write(&mut bytes).unwrap();
        }
        let mut reader = Reader::new(bytes.as_slice()).unwrap();
        let subject = Subject::new(&header).unwrap();
        let decider = Decider::new(&subject).unwrap();
        let found = components(&mut reader, &decider, 1 << 30).unwrap().unwrap();
        assert_eq!(found.all.iter().filter(|c| c.best_conditioned).count(), 1);
        found.all.iter().map(|c| (c.boxes, c.copies)).collect()
    }

    #[test]
    fn boxes_are_connected_by_faces_alone() {
        assert_eq!(of(false, |_| true), [(512, 1)]);
        assert_eq!(of(false, |[x, _, _]| x != 3), [(256, 1), (192, 1)]);
        // Along a diagonal boxes touch in edges or corners.
        assert_eq!(of(false, |[x, y, z]| x == y && z == 0), [(1, 1); 8]);
        assert_eq!(of(false, |[x, y, z]| (x == y || x == y + 1) && z == 0), [(15, 1)]);
        // A shell, and what is within it.
        let shell = |x: u64| x == 0 || x == 7;
        let apart = |[x, y, z]: [u64; 3]| {
            shell(x) || shell(y) || shell(z) || [x, y, z].iter().all(|k| (2..6).contains(k))
        };
        assert_eq!(of(false, apart), [(296, 1), (64, 1)]);
    }

    #[test]
    fn images_are_counted_by_the_planes_that_a_component_crosses() {
        // Of the whole box, all is one; of a box off the planes there are six.
        assert_eq!(of(true, |_| true), [(512, 1)]);
        assert_eq!(of(true, |c| c == [1, 3, 6]), [(1, 6)]);
        assert_eq!(of(true, |c| c == [3, 3, 6]), [(1, 3)]);
        assert_eq!(of(true, |c| c == [3, 3, 3]), [(1, 1)]);
        // From one plane to another.
        assert_eq!(of(true, |[x, y, z]| x == 1 && z == 6 && (1..=6).contains(&y)), [(6, 1)]);
    }

    #[test]
    fn too_little_memory_is_said() {
        let header = claimed(false);
        let mut bytes = serde_json::to_vec(&header).unwrap();
        bytes.push(b'\n');
        for kind in [Kind::Split(Axis::X), Kind::Boundary, Kind::Boundary] {
            Item { steps: Vec::new(), kind }.write(&mut bytes).unwrap();
        }
        let mut reader = Reader::new(bytes.as_slice()).unwrap();
        let subject = Subject::new(&header).unwrap();
        let decider = Decider::new(&subject).unwrap();
        assert_eq!(components(&mut reader, &decider, 0).unwrap(), None);
    }
}
