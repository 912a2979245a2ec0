//! Findings that rest on certificates.

use super::{value, Agreement, Basis, Finding, NotEstablished};
use crate::design::Design;
use crate::search::solver;
use crate::search::{Budget, Control};
use orthocert_checker::certificate::{Certificate, Verdict};
use orthocert_kernel::claim::{Every, PostulateClaim, PsiMax};
use std::sync::atomic::AtomicBool;

/// Far more than any of the proofs needs.
const BUDGET: Budget = Budget { max_boxes: 100_000, deadline: None };

/// The closed cube of the prototype with further requirements.
fn prototype_with(requirements: &str) -> String {
    format!(
        "[mechanism]\nkind = \"orthoglide\"\n[workspace]\ncube = 200\n\
         [requirements]\ntransmission = {{ max = 2 }}\n{requirements}\n"
    )
}

/// The Orthoglide of this leg length on a given cube, at `psi_max = 2`.
fn machine(leg_length: &str, min: &str, max: &str) -> String {
    format!(
        "[mechanism]\nkind = \"orthoglide\"\nleg_length = {leg_length}\n[workspace]\n\
         min = [{min}, {min}, {min}]\nmax = [{max}, {max}, {max}]\n\
         [requirements]\ntransmission = {{ min = \"1/2\", max = 2 }}\n"
    )
}

/// The certificate of a design whose verdict is known.
fn decided(
    id: &'static str,
    design: &str,
    verdict: Verdict,
) -> Result<Certificate, NotEstablished> {
    let fails = |reason: String| NotEstablished { id, reason };
    let design = Design::parse(design, id).map_err(|e| fails(e.to_string()))?;
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let found =
        solver::verify(&design.claim, BUDGET, &mut control).map_err(|e| fails(e.to_string()))?;
    match found.decided() {
        Some((certificate, accepted)) if accepted.verdict == verdict => Ok(certificate.clone()),
        Some((_, accepted)) => {
            Err(fails(format!("the verdict is {}, not {verdict}", accepted.verdict)))
        }
        None => Err(fails("it is not decided".into())),
    }
}

fn postulate(id: &'static str) -> Result<Certificate, NotEstablished> {
    let claim = PostulateClaim { psi_max: PsiMax::Every(Every::All) };
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let proved = crate::questions::postulate::prove(&claim, BUDGET, &mut control)
        .map_err(|e| NotEstablished { id, reason: e.to_string() })?;
    match proved.answer {
        solver::Answer::Decided { certificate, .. } => Ok(*certificate),
        _ => Err(NotEstablished { id, reason: "not decided within the budget".into() }),
    }
}

/// The findings with certificates.
pub(super) fn findings() -> Result<Vec<Finding>, NotEstablished> {
    Ok(vec![
        bounds()?,
        the_postulate()?,
        joint_range()?,
        serial_distance()?,
        parallel_distance()?,
        rounded_machine()?,
        published_corners()?,
        motion()?,
        collisions()?,
    ])
}

fn bounds() -> Result<Finding, NotEstablished> {
    let id = "bounds";
    let certificate = decided(id, &prototype_with(""), Verdict::Certified)?;
    Ok(Finding {
        id,
        place: "Section on the transmission factors",
        says: "1/2 <= psi_i <= 2 on the 200 mm cube, for psi_max = 2",
        proved: "1/2 <= psi_i <= 2 on the closed cube, free of serial and parallel singularities",
        agreement: Agreement::Holds,
        values: Vec::new(),
        basis: Basis::Certificates(vec![("paper-bounds", certificate)]),
    })
}

fn the_postulate() -> Result<Finding, NotEstablished> {
    let id = "postulate";
    Ok(Finding {
        id,
        place: "Step 1",
        says:
            "if the bounds hold at Q1 and Q2 they hold on the cube; interval analysis can show it",
        proved: "the bounds hold on the cube for every psi_max > 1, and no two points of it have the same joint coordinates",
        agreement: Agreement::Holds,
        values: Vec::new(),
        basis: Basis::Certificates(vec![("paper-postulate", postulate(id)?)]),
    })
}

fn joint_range() -> Result<Finding, NotEstablished> {
    let id = "joint-range";
    // A little above rho_max; 0 is met with equality.
    let requirement = "joint_range = { min = 0, max = \"256.993015637\" }";
    let certificate = decided(id, &prototype_with(requirement), Verdict::Certified)?;
    let rho_max = "200+200/(1/sqrt(18)+1/sqrt(6))*(1-sqrt(2/3))";
    Ok(Finding {
        id,
        place: "Step 3",
        says: "joint range 257 mm",
        proved: "0 <= rho_i <= rho_max on the cube; both ends are attained, rho_max at Q2",
        agreement: Agreement::Corrected,
        values: vec![value(id, "rho_max (mm)", rho_max)?],
        basis: Basis::Certificates(vec![("paper-joint-range", certificate)]),
    })
}

fn serial_distance() -> Result<Finding, NotEstablished> {
    let id = "serial-distance";
    let requirement = "serial_margin = { min = \"0.816496\" }";
    let certificate = decided(id, &prototype_with(requirement), Verdict::Certified)?;
    Ok(Finding {
        id,
        place: "Section on singular configurations",
        says: "serial singularities are far from the workspace",
        proved: "|eta_i|/L >= 0.816496 on the cube; the least value is attained at Q2",
        agreement: Agreement::Holds,
        values: vec![value(id, "min |eta_i|/L", "sqrt(2/3)")?],
        basis: Basis::Certificates(vec![("paper-serial-distance", certificate)]),
    })
}

fn parallel_distance() -> Result<Finding, NotEstablished> {
    let id = "parallel-distance";
    let requirement = "parallel_margin = { min = \"0.272165\" }";
    let certificate = decided(id, &prototype_with(requirement), Verdict::Certified)?;
    Ok(Finding {
        id,
        place: "Section on singular configurations",
        says: "parallel singularities are far from the workspace",
        proved: "|det A|/L^3 >= 0.272165 on the cube; Q2 comes within 2e-6 of it",
        agreement: Agreement::Holds,
        values: vec![value(id, "|det A|/L^3 at Q2", "2/3*sqrt(2/3)/2")?],
        basis: Basis::Certificates(vec![("paper-parallel-distance", certificate)]),
    })
}

fn rounded_machine() -> Result<Finding, NotEstablished> {
    let id = "rounded-machine";
    let rounded = decided(id, &machine("310", "-73.2", "126.8"), Verdict::Refuted)?;
    Ok(Finding {
        id,
        place: "Step 3, example",
        says: "L = 310 mm for a 200 mm cube at psi_max = 2",
        proved: "L = 310 violates psi <= 2 on [-73.2, 126.8]^3; the largest cube on the diagonal \
                 that it admits is smaller than 200 mm",
        agreement: Agreement::Fails,
        values: vec![value(id, "largest side for L = 310 (mm)", "310*(1/sqrt(18)+1/sqrt(6))")?],
        basis: Basis::Certificates(vec![("paper-rounded-machine", rounded)]),
    })
}

fn published_corners() -> Result<Finding, NotEstablished> {
    let id = "published-corners";
    let refuted = decided(id, &machine("310.25", "-73.65", "126.35"), Verdict::Refuted)?;
    Ok(Finding {
        id,
        place: "later publications of the prototype",
        says: "L = 310.25 mm with corners -73.65 and 126.35 mm",
        proved: "psi <= 2 is violated at (-73.65, -73.65, -73.65); no 200 mm cube on the diagonal \
                 will do",
        agreement: Agreement::Fails,
        values: vec![value(
            id,
            "largest side for L = 310.25 (mm)",
            "310.25*(1/sqrt(18)+1/sqrt(6))",
        )?],
        basis: Basis::Certificates(vec![("paper-published-corners", refuted)]),
    })
}

fn motion() -> Result<Finding, NotEstablished> {
    let id = "motion";
    // What the motion asks of joints; 56 N accelerate 4 kg by 14 m/s^2.
    let requirements = "joint_speed = { tool = 1200, max = 1500 }\n\
                        joint_acceleration = { speed = 1200, acceleration = 14000, max = 26000 }\n\
                        joint_force = { tool = 56, max = 93 }\none_to_one = true";
    let certificate = decided(id, &prototype_with(requirements), Verdict::Certified)?;
    Ok(Finding {
        id,
        place: "Section on the prototype",
        says: "1.2 m/s, 14 m/s^2, a payload of 4 kg",
        proved:
            "in every direction everywhere on the cube, with joints that do 1.5 m/s, 26 m/s^2 and \
                 93 N for the payload alone; no two points have the same joint coordinates",
        agreement: Agreement::Holds,
        values: Vec::new(),
        basis: Basis::Certificates(vec![("paper-motion", certificate)]),
    })
}

fn collisions() -> Result<Finding, NotEstablished> {
    let id = "collisions";
    let unit = |k: usize| ["1, 0, 0", "0, 1, 0", "0, 0, 1"][k % 3];
    let anchor = |k: usize| ["-383.8, 0, 0", "0, -383.8, 0", "0, 0, -383.8"][k];
    let leg = |k: usize| {
        format!(
            "[[mechanism.legs]]\ndrive = \"slider\"\ndirection = [{}]\nanchor = [{}]\nlength = 310.6\n\
             mode = \"+\"\nrod = {{ radius = 10, trim = [30, 45], spread = 80, axis = [{}] }}\n",
            unit(k),
            anchor(k),
            unit(k + 1)
        )
    };
    let design = format!(
        "[mechanism]\nkind = \"translational\"\n{}[[mechanism.bodies]]\non = \"platform\"\n\
         from = [0, 0, 0]\nto = [60, 60, 60]\nradius = 15\n[workspace]\nmin = [-73.2, -73.2, -73.2]\n\
         max = [126.8, 126.8, 126.8]\n[requirements]\nclearance = {{ min = 2 }}\n",
        (0..3).map(leg).collect::<String>()
    );
    let certificate = decided(id, &design, Verdict::Certified)?;
    Ok(Finding {
        id,
        place: "Introduction",
        says: "a workspace free of singularities and self-collisions",
        proved: "with parallelograms of two bars of radius 10 mm, 80 mm apart, and a tool of radius 15 mm \
                 (chosen here), all keep 2 mm on [-73.2, 126.8]^3, L = 310.6 mm",
        agreement: Agreement::Holds,
        values: Vec::new(),
        basis: Basis::Certificates(vec![("paper-collisions", certificate)]),
    })
}
