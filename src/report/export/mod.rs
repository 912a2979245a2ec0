//! Certificates in the languages of other checkers, and the surfaces of pavings as meshes.

pub mod rocq;
pub mod stl;
pub mod vtk;
