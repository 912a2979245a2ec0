//! Surfaces as binary STL.
//!
//! The corners are single-precision numbers, and the same corner has the same bytes wherever it
//! occurs: every edge is shared exactly, and a reader that joins equal corners gets a closed mesh.

use crate::search::paving::{Surface, SurfaceError};

/// Bytes of the header, which readers ignore and people may read.
const HEADER: usize = 80;
/// Bytes of a triangle: normal, three corners, and a number that is zero.
const TRIANGLE: usize = 50;

/// The file of a surface.
///
/// # Errors
/// [`SurfaceError::TooClose`] if corners coincide in single precision.
pub fn stl(surface: &Surface) -> Result<Vec<u8>, SurfaceError> {
    let points = surface.coordinates(|x| x as f32)?;
    let count = 2 * surface.quads.len() + surface.triangles.len();
    let mut bytes = Vec::with_capacity(HEADER + 4 + TRIANGLE * count);
    // Not beginning with "solid", by which readers know the textual form.
    bytes.extend(
        format!(
            "{:HEADER$}",
            "binary STL by orthocert: inner part of a paving, evidence of boxes not checked"
        )
        .bytes(),
    );
    let count = u32::try_from(count).map_err(|_| SurfaceError::TooFine)?;
    bytes.extend(count.to_le_bytes());
    for corners in surface.in_triangles() {
        let [a, b, c] = corners.map(|at| points[at as usize]);
        for number in normal(a, b, c).iter().chain([a, b, c].as_flattened()) {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0, 0]);
    }
    Ok(bytes)
}

/// The unit normal of a triangle in a plane orthogonal to an axis: that axis, and its sign by which
/// way the corners turn.
fn normal(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> [f32; 3] {
    // Planes that differ do so by 2^-24 of their coordinates, about: doubles tell the sign.
    let side = |q: [f32; 3]| [0, 1, 2].map(|k| f64::from(q[k]) - f64::from(a[k]));
    let (p, q) = (side(b), side(c));
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let turn = p[i] * q[j] - p[j] * q[i];
        f32::from(i8::from(turn > 0.0) - i8::from(turn < 0.0))
    })
}
