//! What the figures and tables of a page show, whatever the certificate is about.

use super::evidence::Row;
use super::isomap::{Mark, Scale};
use super::legend::Legend;
use super::legs::Shape;
use super::nominal::Nominal;
use super::sampled::double;
use super::subdivision::{Root, Subdivision};
use super::svg::Picture;
use crate::decimal::{approximate, significant};
use crate::exact::Exact;
use crate::report::{self, exactly};
use orthocert_checker::cell::Axis;
use orthocert_checker::certificate::{Certificate, Proof, Violation, Witness};
use orthocert_checker::claim::Claim;
use orthocert_checker::kernel::trees as kernel_trees;
use orthocert_kernel::certificate as kernel;
use orthocert_kernel::postulate::{parts, Part};
use std::rc::Rc;

/// What is shown.
#[derive(Debug, Default)]
pub struct Scene {
    /// What is drawn.
    pub shape: Option<Shape>,
    /// What is mapped.
    pub slices: Vec<Slice>,
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
    /// What scales are of, and the scales.
    pub legends: Vec<(String, String)>,
    /// The other coordinates.
    pub fixed: String,
}

/// What is shown of three translating legs, and of the postulate.
pub fn of_three_legs(
    certificate: &Certificate,
    machine: Option<(&Nominal, Option<&Scale>)>,
    rows: &[report::Row],
) -> Scene {
    let nominal = machine.map(|(machine, _)| machine);
    let marks = marks(nominal, certificate);
    let slices = machine.and_then(|(machine, scale)| Some(first_slice(machine, scale?, &marks)));
    Scene {
        shape: nominal.map(Nominal::shape),
        slices: slices.into_iter().collect(),
        rows: rows.iter().map(Row::from).collect(),
        trees: trees(certificate, nominal),
        marks,
    }
}

/// The first maps of the transmission factors.
pub fn first_slice(machine: &Nominal, scale: &Scale, marks: &[Mark]) -> Slice {
    let z = significant(machine.point([0.0, 0.0, machine.slice])[2], 6);
    Slice {
        maps: machine.maps(scale, marks),
        legends: vec![(String::new(), scale.legend())],
        fixed: format!("z = {z}"),
    }
}

/// `Q_1` and `Q_2`.
pub fn corners_of_cube(machine: &Nominal) -> Vec<Mark> {
    let corners = [("Q\u{2081}", 0.0), ("Q\u{2082}", 1.0)];
    let corners = corners.into_iter().filter(|_| machine.is_cube);
    corners
        .map(|(name, u)| Mark { name: name.to_owned(), at: machine.point([u; 3]).to_vec() })
        .collect()
}

/// The plane of the first maps, as a part of the workspace's height: through `Q_1`, through the
/// counterexample, or through the place where the greatest factor was found.
pub fn slice(machine: &Nominal, certificate: &Certificate, rows: &[report::Row]) -> f64 {
    let (least, width) = (machine.frame.least[2], machine.frame.width[2]);
    let z = match &certificate.proof {
        Proof::Witness(witness) => approximate(&witness.point[2]),
        Proof::Kernel(kernel::Proof::Witness(witness)) => {
            witness.point.get(2).and_then(exactly).as_ref().and_then(approximate)
        }
        _ if machine.is_cube => Some(least),
        _ => rows
            .iter()
            .find(|row| row.requirement == "greatest psi")
            .and_then(|row| row.at.get(2).copied()),
    };
    match z {
        Some(z) if width > 0.0 => ((z - least) / width).clamp(0.0, 1.0),
        _ => machine.slice,
    }
}

/// `Q_1` and `Q_2` of the cube, and the points of a counterexample.
fn marks(machine: Option<&Nominal>, certificate: &Certificate) -> Vec<Mark> {
    let mut all = machine.map(corners_of_cube).unwrap_or_default();
    if let Proof::Witness(witness) = &certificate.proof {
        let at = |p: &[Exact; 3]| p.iter().map(approximate).collect::<Option<Vec<f64>>>();
        let name = |name: &str| name.to_owned();
        let Witness { point, violates, .. } = &**witness;
        all.extend(at(point).map(|at| Mark { name: name("counterexample"), at }));
        if let Violation::Singular(second) = violates {
            all.extend(at(&second.other).map(|at| Mark { name: name("P'"), at }));
        }
    }
    all
}

/// The trees of a proof; for a counterexample, the workspace alone.
fn trees(certificate: &Certificate, machine: Option<&Nominal>) -> Vec<Subdivision> {
    let (least, width) = match machine {
        Some(machine) => (machine.frame.least, machine.frame.width),
        None => ([0.0; 3], [1.0; 3]),
    };
    let legend = Rc::new(Legend::of_three_legs());
    let root = || Root::new(Root::axes_of(Axis::ALL), least, width);
    match (&certificate.proof, &certificate.claim) {
        (Proof::Tree(tree), _) => {
            let name = match machine {
                Some(_) => "the workspace",
                None => "the workspace, x, y and z as parts of it",
            };
            vec![Subdivision::new(name, root(), &legend, &legend.ruled(&tree.nodes))]
        }
        (Proof::Kernel(kernel::Proof::Tree(tree)), Claim::Postulate(claim)) => {
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
                let [low, high] =
                    [&part.least, &part.greatest].map(|x| double(x).unwrap_or_default());
                let half = if high > 0.5 { "kappa >= 1/2" } else { "kappa <= 1/2" };
                let name = format!("face {face}, {half}");
                let root = Root::new(["y", "z", "kappa"], [0.0, 0.0, low], [1.0, 1.0, high - low]);
                Subdivision::new(&name, root, &legend, own)
            };
            kernel_trees(&tree.nodes).into_iter().zip(&needed).map(part).collect()
        }
        _ => vec![Subdivision::new("the workspace", root(), &legend, &[])],
    }
}
