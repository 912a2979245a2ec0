//! Expansions of `M = J^-1` and of the joint coordinates over a cell.
//!
//! With a fixed point `c` of the cell and `delta = P - c`, every leg gives slopes with
//!
//! ```text
//! M(P)   = M(c)   + sum_k delta_k E_k(P)
//! rho(P) = rho(c) + sum_k delta_k g_k(P)
//! ```
//!
//! and `E_k(P)`, `g_k(P)` enclosed over the cell. What is stored is multiplied by the extent of
//! `delta_k`: `M(P) = M(c) + sum_k lambda_k (h_k E_k)` with `lambda_k` in `[-1, 1]` for a centre
//! and in `[0, 1]` for a corner (there `h_k` carries the sign of the direction into the cell). The
//! `lambda` of the points in question are convex combinations of the vertices of [`Hull`].

use crate::cell::Cell;
use crate::enclosure::Enclosure;
use crate::hull::{Hull, Vertex};
use crate::linear::{scale, Matrix, Vector};
use crate::model::Model;
use std::array::from_fn;

/// Where a cell is expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpansionPoint {
    /// The cell's midpoint.
    Centre,
    /// The workspace's least corner, `u = (0, 0, 0)`; the cell must touch it.
    LowerCorner,
    /// The workspace's greatest corner, `u = (1, 1, 1)`; the cell must touch it.
    UpperCorner,
}

/// An expansion of `M` and `rho` over a cell.
#[derive(Clone, Debug)]
pub struct Expansion<S> {
    /// `M(c)`.
    pub matrix: Matrix<S>,
    /// `h_k E_k`: `slopes[k][i][j]` belongs to coordinate `k` and entry `(i, j)` of `M`.
    pub slopes: [Matrix<S>; 3],
    /// For each leg, `rho_i(c)` and `h_k g_k` for each coordinate; none for an angle.
    pub rho: [Option<(S, Vector<S>)>; 3],
    /// The vertices between which `lambda` lies.
    pub hull: Hull,
}

/// Why there is no expansion: leg `leg` (from zero) is not certainly within reach and free of
/// serial singularities on all of the cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfReach {
    /// The leg, counted from zero.
    pub leg: usize,
}

impl<S: Enclosure> Expansion<S> {
    /// The expansion of `cell` about `point`. For a corner the caller has made sure that the cell
    /// touches it.
    pub fn new(model: &Model<S>, cell: &Cell, point: ExpansionPoint) -> Result<Self, OutOfReach> {
        let region = Region::new(model, cell, point);
        let Region { at, over, extent, hull } = region;
        let expand = |i: usize| model.legs[i].expand(&at[i], &over[i]).ok_or(OutOfReach { leg: i });
        let legs = [expand(0)?, expand(1)?, expand(2)?];
        Ok(Expansion {
            slopes: from_fn(|k| {
                from_fn(|i| {
                    let column: Vector<S> = from_fn(|j| legs[i].slope[j][k].clone());
                    scale(&extent[k], &column)
                })
            }),
            matrix: from_fn(|i| legs[i].row.clone()),
            rho: from_fn(|i| {
                let (rho, slope) = legs[i].rho.as_ref()?;
                Some((rho.clone(), from_fn(|k| extent[k].mul(&slope[k]))))
            }),
            hull,
        })
    }

    /// `A(v) = M(c) + sum_k lambda_k (h_k E_k)` at a vertex.
    pub fn matrix_at(&self, vertex: &Vertex) -> Matrix<S> {
        from_fn(|i| self.row_at(i, vertex))
    }

    /// Row `i` of `A(v)`.
    pub fn row_at(&self, i: usize, vertex: &Vertex) -> Vector<S> {
        let [x, y, z] = &self.slopes;
        from_fn(|j| vertex.affine(&self.matrix[i][j], [&x[i][j], &y[i][j], &z[i][j]]))
    }
}

/// `M(P)` itself, enclosed over a cell, with slopes of zero: the identity of [`Expansion`] with
/// `M(P)` in the place of `M(c)`. Looser, but defined wherever the rows are.
pub fn natural<S: Enclosure>(model: &Model<S>, cell: &Cell) -> Result<Expansion<S>, OutOfReach> {
    let over = Region::new(model, cell, ExpansionPoint::Centre).over;
    let row = |i: usize| model.legs[i].at(&over[i]).ok_or(OutOfReach { leg: i });
    let rows = [row(0)?.row, row(1)?.row, row(2)?.row];
    let zero = model.width[0].integer_like(0);
    let zeros = || from_fn(|_| from_fn(|_| zero.clone()));
    let slopes = [zeros(), zeros(), zeros()];
    Ok(Expansion { matrix: rows, slopes, rho: [None, None, None], hull: Hull::CELL })
}

/// A cell in the terms that legs are met in.
pub struct Region<S> {
    /// `w_i` at the expansion point.
    pub at: [Vector<S>; 3],
    /// `w_i` over the cell.
    pub over: [Vector<S>; 3],
    /// The extent of `delta_k` about the expansion point.
    pub extent: Vector<S>,
    /// The vertices between which the points in question lie, about the expansion point.
    pub hull: Hull,
}

impl<S: Enclosure> Region<S> {
    /// The cell about `point`.
    pub fn new(model: &Model<S>, cell: &Cell, point: ExpansionPoint) -> Self {
        let low = model.displacement(cell.edges.map(|e| (e.index, e.level)));
        let high = model.displacement(cell.edges.map(|e| (e.index + 1, e.level)));
        let over: Vector<S> = from_fn(|k| low[k].join(&high[k]));
        let edge = || model.displacement(cell.edges.map(|e| (1, e.level)));
        let (centre, extent) = match point {
            ExpansionPoint::Centre => (
                model.displacement(cell.edges.map(|e| (2 * e.index + 1, e.level + 1))),
                model.displacement(cell.edges.map(|e| (1, e.level + 1))),
            ),
            ExpansionPoint::LowerCorner => (model.displacement([(0, 0); 3]), edge()),
            ExpansionPoint::UpperCorner => {
                (model.displacement([(1, 0); 3]), edge().map(|h| h.neg()))
            }
        };
        let hull = match point {
            ExpansionPoint::Centre if model.is_cylinder => Hull::in_cylinder(cell),
            ExpansionPoint::Centre => Hull::CELL,
            ExpansionPoint::LowerCorner | ExpansionPoint::UpperCorner => Hull::ABOUT_CORNER,
        };
        Region { at: model.leg_vectors(&centre), over: model.leg_vectors(&over), extent, hull }
    }
}
