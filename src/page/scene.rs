//! Where to look: the slice, the marked points and the trees of a certificate.

use super::isomap::Mark;
use super::nominal::Nominal;
use super::subdivision::Subdivision;
use crate::decimal::approximate;
use crate::report::Row;
use orthocert_checker::cell::Axis;
use orthocert_checker::certificate::{Certificate, FacePart, Proof, Violation, Witness};
use orthocert_checker::claim::Claim;
use orthocert_checker::number::Exact;
use orthocert_checker::postulate::{Face, Half};
use orthocert_checker::{parts_needed, PartNeeded};

/// The plane of the first maps, as a part of the workspace's height: through `Q_1`, through the
/// counterexample, or through the place where the greatest factor was found.
pub fn slice(machine: &Nominal, certificate: &Certificate, rows: &[Row]) -> f64 {
    let (least, width) = (machine.frame.least[2], machine.frame.width[2]);
    let z = match &certificate.proof {
        Proof::Witness(witness) => approximate(&witness.point[2]),
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
pub fn marks(machine: Option<&Nominal>, certificate: &Certificate) -> Vec<Mark> {
    let mut all = Vec::new();
    if let Some(machine) = machine.filter(|machine| machine.is_cube) {
        for (name, u) in [("Q\u{2081}", 0.0), ("Q\u{2082}", 1.0)] {
            all.push(Mark { name: name.to_owned(), at: machine.point([u; 3]) });
        }
    }
    if let Proof::Witness(witness) = &certificate.proof {
        let at =
            |p: &[Exact; 3]| Some([approximate(&p[0])?, approximate(&p[1])?, approximate(&p[2])?]);
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
pub fn trees(certificate: &Certificate, machine: Option<&Nominal>) -> Vec<Subdivision> {
    let (least, width) = match machine {
        Some(machine) => (machine.frame.least, machine.frame.width),
        None => ([0.0; 3], [1.0; 3]),
    };
    let axes = Subdivision::axes_of(Axis::ALL);
    match (&certificate.proof, &certificate.claim) {
        (Proof::Tree(tree), _) => {
            let name = match machine {
                Some(_) => "the workspace",
                None => "the workspace, x, y and z as parts of it",
            };
            vec![Subdivision::new(name, axes, least, width, &tree.nodes)]
        }
        (Proof::Faces(faces), Claim::Postulate(claim)) => {
            let needed = parts_needed(claim).unwrap_or_default();
            let part = |(part, needed): (&FacePart, &PartNeeded)| {
                let face = match part.face {
                    Face::Q1 => "x = q1",
                    Face::Q2 => "x = q2",
                };
                let half = match part.half {
                    Half::Low => "kappa <= 1/2",
                    Half::High => "kappa >= 1/2",
                };
                let ends = [&needed.least, &needed.greatest].map(|x| approximate(x).unwrap_or(0.0));
                let name = format!("face {face}, {half}");
                let axes = Subdivision::axes_of(Axis::FACE);
                let (least, width) = ([ends[0], 0.0, 0.0], [ends[1] - ends[0], 1.0, 1.0]);
                Subdivision::new(&name, axes, least, width, &part.nodes)
            };
            faces.parts.iter().zip(&needed).map(part).collect()
        }
        _ => vec![Subdivision::new("the workspace", axes, least, width, &[])],
    }
}
