//! Surfaces as VTK XML unstructured grids (`.vtu`), little-endian base64 in place.
//!
//! | array    | is                                                                             |
//! |----------|--------------------------------------------------------------------------------|
//! | `Points` | the corners, each once                                                         |
//! | cells    | quadrilaterals (VTK type 9), then triangles (5), counterclockwise seen from without |
//! | `beyond` | what a face separates the inner part from: 0 outer boxes, 1 boxes some of which are undecided, 2 what is outside the box that is paved |

use crate::search::paving::{Beyond, Surface, SurfaceError};
use data_encoding::BASE64;

/// VTK's number for quadrilaterals.
const QUAD: u8 = 9;
/// VTK's number for triangles.
const TRIANGLE: u8 = 5;

/// The file of a surface.
///
/// # Errors
/// [`SurfaceError::TooClose`] if corners coincide in double precision.
pub fn vtu(surface: &Surface) -> Result<Vec<u8>, SurfaceError> {
    let points = surface.coordinates(|x| x)?;
    let Surface { quads, triangles, .. } = surface;
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n\
         <!-- orthocert: the inner part of a paving; the evidence of its boxes is not checked by the \
         export, but by `orthocert check` -->\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
        points.len(),
        surface.faces()
    );
    let numbers = points.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    array(&mut text, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", numbers);
    text.push_str("</Points>\n<Cells>\n");
    let of_quads = quads.iter().flat_map(|face| face.corners);
    let corners = of_quads.chain(triangles.iter().flat_map(|face| face.corners));
    let corners = corners.flat_map(|at| i64::from(at).to_le_bytes());
    array(&mut text, "type=\"Int64\" Name=\"connectivity\"", corners);
    let of_quads = (1..=quads.len()).map(|n| 4 * n);
    let ends = of_quads.chain((1..=triangles.len()).map(|n| 4 * quads.len() + 3 * n));
    let ends = ends.flat_map(|end| (end as i64).to_le_bytes());
    array(&mut text, "type=\"Int64\" Name=\"offsets\"", ends);
    let types = quads.iter().map(|_| QUAD).chain(triangles.iter().map(|_| TRIANGLE));
    array(&mut text, "type=\"UInt8\" Name=\"types\"", types);
    text.push_str("</Cells>\n<CellData>\n");
    let of_quads = quads.iter().map(|face| face.beyond);
    let beyond =
        of_quads.chain(triangles.iter().map(|face| face.beyond)).map(|beyond| match beyond {
            Beyond::Outer => 0,
            Beyond::Undecided => 1,
            Beyond::OutsideBox => 2,
        });
    array(&mut text, "type=\"UInt8\" Name=\"beyond\"", beyond);
    text.push_str("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    Ok(text.into_bytes())
}

/// An array of numbers: the count of its bytes, and they, as base64.
fn array(text: &mut String, attributes: &str, bytes: impl Iterator<Item = u8>) {
    let bytes: Vec<u8> = bytes.collect();
    text.push_str(&format!("<DataArray {attributes} format=\"binary\">\n"));
    let mut all = (bytes.len() as u64).to_le_bytes().to_vec();
    all.extend(bytes);
    BASE64.encode_append(&all, text);
    text.push_str("\n</DataArray>\n");
}
