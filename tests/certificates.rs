//! The committed certificates: what the prover writes today, byte for byte, and accepted.
//!
//! After a change that is meant to change them:
//!
//! ```text
//! ORTHOCERT_BLESS=1 cargo test --release --test integration certificates
//! ```

use crate::schema;
use orthocert::design::{AtlasDesign, Design};
use orthocert::questions::atlas::{assemble, certify, grow, Growing};
use orthocert::questions::largest_cube::exclude;
use orthocert::questions::postulate;
use orthocert::search::accepted::check;
use orthocert::search::solver;
use orthocert::search::{Budget, Control};
use orthocert_checker::certificate::{Certificate, Claim, Verdict};
use orthocert_checker::read;
use orthocert_kernel::claim::{PostulateClaim, Workspace};
use orthocert_kernel::number::Expression;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use Verdict::{Certified, Refuted};

/// A committed certificate: `NAME.cert.json` is the answer to `tests/designs/NAME.toml`.
const OF_DESIGNS: [(&str, Verdict); 21] = [
    ("orthoglide-prototype", Certified),
    ("orthoglide-relaxed-1-percent", Certified),
    ("orthoglide-tolerance", Certified),
    ("orthoglide-joint-range", Certified),
    ("orthoglide-as-built-tight", Certified),
    ("orthoglide-prototype-whole", Certified),
    ("orthoglide-cube-all", Certified),
    ("linear-delta-klipper-cylinder", Certified),
    ("upu-struts", Certified),
    ("tripteron", Certified),
    ("linapod-wide-directions", Certified),
    ("delta-joint-speed", Certified),
    ("delta-parallel-margin", Certified),
    ("rotary-delta-speed", Certified),
    ("orthoglide-310", Refuted),
    ("orthoglide-310.25-published", Refuted),
    ("delta-out-of-reach", Refuted),
    ("delta-conditioning-refuted", Refuted),
    ("delta-joint-speed-refuted", Refuted),
    ("rotary-delta-angle-refuted", Refuted),
    ("star-singular", Refuted),
];
/// The same of `tests/designs/kernel/NAME.toml`.
const OF_OTHER_KINDS: [(&str, Verdict); 12] = [
    ("five-bar", Certified),
    ("five-bar-formulas", Certified),
    ("five-bar-rough", Certified),
    ("orthoglide-formulas", Certified),
    ("planar-3-prr", Certified),
    ("planar-3-rpr", Certified),
    ("spherical-3-ups", Certified),
    ("upu-base-axes", Certified),
    ("hexapod-joints", Certified),
    ("hexapod-linuxcnc", Certified),
    ("hexapod-rubin-camera", Certified),
    ("hexapod-rubin-camera-stroke-refuted", Refuted),
];
/// The committed certificates of the postulate: name and `psi_max`.
const POSTULATES: [(&str, &str); 7] = [
    ("postulate-all", r#""all""#),
    ("postulate-1.2-to-6.5", r#"{"min":"1.2","max":"6.5"}"#),
    ("postulate-2", r#""2""#),
    ("postulate-7-thirds", r#""7/3""#),
    ("postulate-1.37", r#""1.37""#),
    ("postulate-1.000000001", r#""1.000000001""#),
    ("postulate-1000000000", r#""1000000000""#),
];

/// No cube of 200 mm for legs of 310 mm.
const NO_CUBE: &str = "orthoglide-310-no-cube-of-200";
/// The committed certificates of atlases: `NAME.cert.json` is the answer to the atlas of
/// `tests/atlases` at this resolution.
const OF_ATLASES: [(&str, &str, u32); 1] = [("orthoglide-atlas", "orthoglide", 3)];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn folder() -> PathBuf {
    root().join("proofs/certificates")
}

fn path(name: &str) -> PathBuf {
    folder().join(format!("{name}.cert.json"))
}

fn decided(claim: &Claim) -> Certificate {
    let budget = Budget { max_boxes: 10_000, deadline: None };
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let found = match claim {
        Claim::Postulate(claim) => postulate::prove(claim, budget, &mut control),
        Claim::Machine(claim) => solver::verify(claim, budget, &mut control),
        Claim::NoCube(_) | Claim::Atlas(_) => panic!("not of a machine"),
    };
    match found.unwrap().answer {
        solver::Answer::Decided { certificate, .. } => *certificate,
        other => panic!("{other:?}"),
    }
}

fn is_what_the_prover_writes(name: &str, claim: &Claim, verdict: Verdict) {
    let certificate = decided(claim);
    assert_eq!(certificate.verdict, verdict, "{name}");
    is_committed(name, &certificate);
}

fn is_committed(name: &str, certificate: &Certificate) {
    let text = certificate.to_text().unwrap();
    if std::env::var_os("ORTHOCERT_BLESS").is_some() {
        fs::create_dir_all(folder()).unwrap();
        fs::write(path(name), &text).unwrap();
    }
    let committed = fs::read_to_string(path(name)).unwrap();
    assert!(committed == text, "{name}: the prover now writes\n{text}");
}

#[test]
fn committed_certificates_are_what_the_prover_writes() {
    for (name, verdict) in OF_DESIGNS {
        let design = root().join("tests/designs").join(format!("{name}.toml"));
        let claim = Claim::Machine(Design::read(&design).unwrap().claim);
        is_what_the_prover_writes(name, &claim, verdict);
    }
    for (name, verdict) in OF_OTHER_KINDS {
        let design = root().join("tests/designs/kernel").join(format!("{name}.toml"));
        let claim = Claim::Machine(Design::read(&design).unwrap().claim);
        is_what_the_prover_writes(name, &claim, verdict);
    }
    for (name, psi_max) in POSTULATES {
        let psi_max = serde_json::from_str(psi_max).unwrap();
        let claim = Claim::Postulate(PostulateClaim { psi_max });
        is_what_the_prover_writes(name, &claim, Certified);
    }
}

/// Legs of 310 have no cube of side 200. Beyond 217 a corner of it is out of reach: 217 + 100 > 310.
#[test]
fn the_committed_certificate_of_no_cube_is_what_the_prover_writes() {
    let design = Design::read(&root().join("tests/designs/orthoglide-310.toml")).unwrap();
    let mut machine = design.claim;
    let corner = |n| vec![Expression::integer(n); 3];
    machine.workspace = Workspace::Box { min: corner(-217), max: corner(217) };
    let budget = Budget { max_boxes: 10_000, deadline: None };
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let found = exclude(&machine, &Expression::integer(200), budget, &mut control).unwrap();
    is_committed(NO_CUBE, &found.unwrap());
}

#[test]
fn committed_atlases_are_what_the_prover_writes() {
    for (name, atlas, resolution) in OF_ATLASES {
        let path = root().join("tests/atlases").join(format!("{atlas}.toml"));
        let mut design = AtlasDesign::read(&path).unwrap();
        design.resolution = resolution;
        let cancel = AtomicBool::new(false);
        let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
        let top = grow(&mut Growing::new(&design, &mut control), design.whole(), None).unwrap();
        let (certificate, ..) = certify(&design, assemble(top, Vec::new()).unwrap()).unwrap();
        is_committed(name, &certificate);
    }
}

#[test]
fn no_certificate_is_committed_but_these() {
    let committed: BTreeSet<_> =
        fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    let designs = OF_DESIGNS.iter().chain(&OF_OTHER_KINDS).map(|(name, _)| *name);
    let known = designs.chain(POSTULATES.iter().map(|(name, _)| *name)).chain([NO_CUBE]);
    let known = known.chain(OF_ATLASES.iter().map(|(name, ..)| *name));
    assert_eq!(committed, known.map(path).collect());
}

#[test]
fn committed_certificates_are_accepted_and_written_back_unchanged() {
    for entry in fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        let bytes = fs::read(&path).unwrap();
        let certificate = read(&bytes).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let accepted = check(&certificate).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(accepted.verdict, certificate.verdict);
        assert_eq!(certificate.to_text().unwrap().as_bytes(), bytes, "{}", path.display());
        schema::holds(std::str::from_utf8(&bytes).unwrap(), &path.display().to_string());
    }
}
