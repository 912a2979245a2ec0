//! The surface of the inner part of a paving, as faces that fit together.
//!
//! | module | holds                                                        |
//! |--------|--------------------------------------------------------------|
//! | `tree` | what is inner, outer and undecided, with all images          |
//! | `wall` | rectangles with the inner part on one side                   |
//! | `mesh` | the rectangles cut into faces that share their edges         |
//!
//! The *inner part* is the union of the inner cells; with symmetry, of all images of what they have
//! with `u_x <= u_y <= u_z`. Its volume is the paving's certified inner volume, and its surface
//! encloses that.

mod mesh;
mod tree;
mod wall;

use super::box_ends;
use orthocert_kernel::paving::{Header, Reader, Rejected};
use std::io::Read;
use std::sync::atomic::AtomicBool;

pub use tree::{Detail, Node, Tree, INNER, OUTER, UNDECIDED};
pub use wall::{walls, Wall, EDGE};

/// What lies beyond a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Beyond {
    /// Outer cells.
    Outer,
    /// Cells some of which are undecided.
    Undecided,
    /// What is outside the box that is paved.
    OutsideBox,
}

/// A face of the surface: three or four corners, counterclockwise seen from without.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face<const N: usize> {
    /// Its corners, as positions in [`Surface::points`].
    pub corners: [u32; N],
    /// What it separates the inner part from.
    pub beyond: Beyond,
}

/// The surface of the inner part.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The corners as parts of the box's edges, in units of `1/`[`EDGE`], sorted by the last
    /// coordinate first, no two the same.
    pub points: Vec<[u64; 3]>,
    /// The rectangles among the faces.
    pub quads: Vec<Face<4>>,
    /// The triangles among the faces.
    pub triangles: Vec<Face<3>>,
    /// The ends of the box, nearly.
    ends: [[f64; 2]; 3],
}

/// Why there is no surface.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The paving is malformed.
    #[error("{0}")]
    Rejected(#[from] Rejected),
    /// No cell is inner.
    #[error("no box is inner: there is no surface")]
    Empty,
    /// There would be too many rectangles, or nodes.
    #[error(
        "the surface is too fine; accepted: at most {} rectangles, of at most {} boxes that are split",
        wall::MOST_WALLS, tree::MOST_NODES
    )]
    TooFine,
    /// The box's ends are beyond floating point, or corners would coincide there.
    #[error(
        "corners that differ would have the same coordinates; accepted: coordinates that the file's \
         numbers tell apart"
    )]
    TooClose,
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Reads a paving to its end and finds the surface of its inner part.
///
/// The shape of the tree and its summary are checked, the evidence is not.
///
/// # Errors
/// [`SurfaceError`].
pub fn surface<R: Read>(reader: Reader<R>, cancel: &AtomicBool) -> Result<Surface, SurfaceError> {
    let (header, tree) = Tree::read(reader, Detail::InnerPart, cancel)?;
    let ends = ends(&header).ok_or(SurfaceError::TooClose)?;
    let walls = walls(&tree, cancel)?;
    drop(tree);
    if walls.is_empty() {
        return Err(SurfaceError::Empty);
    }
    Ok(mesh::assembled(&walls, ends))
}

/// The ends of the box that is paved, nearly; along axes that there are not, 0 and 1.
pub fn ends(header: &Header) -> Option<[[f64; 2]; 3]> {
    let mut ends = [[0.0, 1.0]; 3];
    for (end, (min, max)) in
        ends.iter_mut().zip(box_ends(&header.claim.machine, header.coordinates.as_deref())?)
    {
        *end = [min, max];
    }
    ends.as_flattened().iter().all(|x| x.is_finite()).then_some(ends)
}

impl Surface {
    /// The corners in the design's frame and unit, nearly, as `number` makes them of doubles.
    ///
    /// # Errors
    /// [`SurfaceError::TooClose`] if planes of corners that differ would coincide.
    pub fn coordinates<T: Copy + PartialOrd>(
        &self,
        number: impl Fn(f64) -> T,
    ) -> Result<Vec<[T; 3]>, SurfaceError> {
        let along = |k: usize, index: u64| {
            // Exact: index <= EDGE = 2^40.
            let part = index as f64 / EDGE as f64;
            number(self.ends[k][0] * (1.0 - part) + self.ends[k][1] * part)
        };
        for k in 0..3 {
            let mut planes: Vec<u64> = self.points.iter().map(|point| point[k]).collect();
            planes.sort_unstable();
            planes.dedup();
            if !planes.windows(2).all(|pair| along(k, pair[0]) < along(k, pair[1])) {
                return Err(SurfaceError::TooClose);
            }
        }
        Ok(self.points.iter().map(|p| [along(0, p[0]), along(1, p[1]), along(2, p[2])]).collect())
    }

    /// The number of its faces.
    pub fn faces(&self) -> usize {
        self.quads.len() + self.triangles.len()
    }

    /// All of it as triangles.
    pub fn in_triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let halves = |face: &Face<4>| {
            let [a, b, c, d] = face.corners;
            [[a, b, c], [a, c, d]]
        };
        let triangles = self.triangles.iter().map(|face| face.corners);
        self.quads.iter().flat_map(halves).chain(triangles)
    }

    /// The enclosed share of the box's volume, in units of `2^-`[`SHARE_BITS`], by the divergence
    /// theorem: the sum of `x n_x` over the faces.
    ///
    /// [`SHARE_BITS`]: orthocert_kernel::paving::SHARE_BITS
    pub fn share(&self) -> i128 {
        let twice = self.in_triangles().map(|corners| {
            let [a, b, c] = corners.map(|at| self.points[at as usize].map(i128::from));
            // At most 2^40 2^81: all corners have the same x, or the product of the sides is zero.
            a[0] * ((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]))
        });
        // Modulo 2^128; the sum is at most 2^121.
        twice.fold(0, i128::wrapping_add) / 2
    }
}

#[cfg(test)]
mod tests;
