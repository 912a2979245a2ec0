//! Surfaces as binary STL: two triangles for each face.
//!
//! The corners are single-precision numbers, and the same corner has the same bytes wherever it
//! occurs: every edge is shared exactly, and a reader that joins equal corners gets a closed mesh.

use crate::paving::{Surface, SurfaceError};

/// Bytes of the header, which readers ignore.
const HEADER: usize = 80;
/// Bytes of a triangle: normal, three corners, and a number that is zero.
const TRIANGLE: usize = 50;

/// The file of a surface.
///
/// # Errors
/// [`SurfaceError::TooClose`] if corners coincide in single precision.
pub fn stl(surface: &Surface) -> Result<Vec<u8>, SurfaceError> {
    let points = surface.coordinates(|x| x as f32)?;
    let triangles = 2 * surface.faces.len();
    let mut bytes = Vec::with_capacity(HEADER + 4 + TRIANGLE * triangles);
    // Not beginning with "solid", by which readers know the textual form.
    bytes
        .extend(format!("{:HEADER$}", "binary STL by orthocert: surface of an inner part").bytes());
    // A surface has at most 2^24 faces.
    bytes.extend((triangles as u32).to_le_bytes());
    for face in &surface.faces {
        let [a, b, c, d] = face.corners.map(|at| points[at as usize]);
        let normal = normal(a, b, d);
        for corner in [[a, b, c], [a, c, d]] {
            for number in normal.iter().chain(corner.as_flattened()) {
                bytes.extend(number.to_le_bytes());
            }
            bytes.extend([0, 0]);
        }
    }
    Ok(bytes)
}

/// The unit normal of a rectangle with sides along two axes, corner `a` between `b` and `d`.
fn normal(a: [f32; 3], b: [f32; 3], d: [f32; 3]) -> [f32; 3] {
    let sign =
        |k: usize, q: [f32; 3]| f32::from(i8::from(q[k] > a[k])) - f32::from(i8::from(q[k] < a[k]));
    let cross = |i, j| sign(i, b) * sign(j, d) - sign(j, b) * sign(i, d);
    [cross(1, 2), cross(2, 0), cross(0, 1)]
}
