//! What the figures and tables of a page show, whatever the certificate is about.

use super::evidence::Row;
use super::isomap::{Mark, Scale};
use super::legend::Legend;
use super::legs::Shape;
use super::nominal::Nominal;
use super::shape::shape;
use super::subdivision::{Root, Subdivision};
use super::svg::Picture;
use crate::exact::decimal::significant;
use crate::search::accepted::trees as kernel_trees;
use crate::search::solver::approximate;
use orthocert_checker::certificate::Proof;
use orthocert_kernel::certificate as kernel;
use orthocert_kernel::claim::{MachineClaim, PostulateClaim};
use orthocert_kernel::postulate::{parts, Part};
use std::rc::Rc;

/// What is shown.
#[derive(Debug, Default)]
pub struct Scene {
    /// What is drawn.
    pub shape: Option<Shape>,
    /// What is mapped.
    pub slices: Vec<Slice>,
    /// The requirement nearest to its limit, in a sentence.
    pub nearest: Option<(&'static str, String)>,
    /// What is required, with the worst values found.
    pub rows: Vec<Row>,
    /// What is marked in all figures.
    pub marks: Vec<Mark>,
    /// What is subdivided.
    pub trees: Vec<Subdivision>,
}

/// Maps over two coordinates.
#[derive(Debug)]
pub struct Slice {
    /// The maps.
    pub maps: Vec<Picture>,
    /// The scale of each.
    pub legends: Vec<String>,
    /// The other coordinates.
    pub fixed: String,
}

/// What is shown of the postulate: for a single `psi_max` the machine, and the parts of every proof.
pub fn of_postulate(
    claim: &PostulateClaim,
    proof: &Proof,
    of_cube: Option<&MachineClaim>,
    machine: Option<(&Nominal, Option<&Scale>)>,
) -> Scene {
    let marks = machine.map(|(machine, _)| corners_of_cube(machine)).unwrap_or_default();
    let slices = machine.and_then(|(machine, scale)| Some(first_slice(machine, scale?, &marks)));
    let trees = match proof {
        Proof::Tree(tree) => faces(claim, tree),
        _ => Vec::new(),
    };
    let shape = of_cube.and_then(shape);
    Scene { shape, slices: slices.into_iter().collect(), trees, marks, ..Scene::default() }
}

/// The first maps of the transmission factors.
pub fn first_slice(machine: &Nominal, scale: &Scale, marks: &[Mark]) -> Slice {
    let z = significant(machine.point([0.0, 0.0, machine.slice])[2], 6);
    Slice { maps: machine.maps(scale, marks), legends: scale.legends(), fixed: format!("z = {z}") }
}

/// `Q_1` and `Q_2`.
pub fn corners_of_cube(machine: &Nominal) -> Vec<Mark> {
    let corners = [("Q\u{2081}", 0.0), ("Q\u{2082}", 1.0)];
    let corners = corners.into_iter().filter(|_| machine.is_cube);
    corners
        .map(|(name, u)| Mark { name: name.to_owned(), at: machine.point([u; 3]).to_vec() })
        .collect()
}

/// The plane of the first maps, as a part of the workspace's height: through `Q_1`, or through the
/// counterexample.
pub fn slice(machine: &Nominal, proof: &Proof) -> f64 {
    let z = match proof {
        Proof::Witness(witness) => witness.point.get(2).and_then(approximate),
        _ => machine.is_cube.then_some(machine.least[2]),
    };
    z.map_or(machine.slice, |z| machine.part(2, z))
}

/// The parts of a proof of the postulate: two faces of the cube, and the ranges of `kappa`.
fn faces(claim: &PostulateClaim, tree: &kernel::Tree) -> Vec<Subdivision> {
    let needed = parts(claim).unwrap_or_default();
    let bound = "\u{3c3}_min(M) \u{2265} 1/psi_max".to_owned();
    let (legend, ruled) = Legend::of_kernel(tree, vec![bound], &|_| 0);
    let legend = Rc::new(legend);
    let mut rest = &ruled[..];
    let part = |(nodes, part): (&[kernel::Node], &Part)| {
        let (own, others) = rest.split_at(nodes.len());
        rest = others;
        let face = match part.face {
            kernel::Corner::Q1 => "x = q1",
            kernel::Corner::Q2 => "x = q2",
        };
        let [low, high] = [&part.least, &part.greatest].map(|x| approximate(x).unwrap_or_default());
        let half = if high > 0.5 { "kappa >= 1/2" } else { "kappa <= 1/2" };
        let name = format!("face {face}, {half}");
        let root = Root::new(["y", "z", "kappa"], [0.0, 0.0, low], [1.0, 1.0, high - low]);
        Subdivision::new(&name, root, &legend, own)
    };
    kernel_trees(&tree.nodes).into_iter().zip(&needed).map(part).collect()
}

/// The workspace alone, of claims of which no boxes are shown.
pub fn of_nothing() -> Subdivision {
    let root = Root::new(["x", "y", "z"], [0.0; 3], [1.0; 3]);
    Subdivision::new("the workspace", root, &Rc::new(Legend::default()), &[])
}
