//! Imported designs, for tests.

use orthocert::design::Design;
use orthocert::exact::Exact;
use orthocert::import::{Files, ImportError, Imported, Importer};
use orthocert_kernel::claim::{self as kernel, MachineClaim, Mechanism, Sign};
use orthocert_kernel::number::Expression;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder of the configurations.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/import")
}

/// A configuration's text.
pub fn file(name: &str) -> String {
    std::fs::read_to_string(folder().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Files in memory, with their texts.
pub fn files(texts: &[(&str, &str)]) -> BTreeMap<PathBuf, String> {
    texts.iter().map(|(name, text)| (PathBuf::from(name), (*text).to_owned())).collect()
}

/// Imports the first of some files.
pub fn import(importer: Importer, texts: &[(&str, &str)]) -> Result<Imported, ImportError> {
    let first = texts.first().map(|(name, _)| PathBuf::from(name));
    importer(&files(texts), first.as_slice(), &[])
}

/// Imports some files and ignores some keys.
pub fn ignoring(
    importer: Importer,
    files: &dyn Files,
    paths: &[&str],
    keys: &[&str],
) -> Result<Imported, ImportError> {
    let paths: Vec<PathBuf> = paths.iter().map(PathBuf::from).collect();
    let keys: Vec<String> = keys.iter().map(|key| (*key).to_owned()).collect();
    importer(files, &paths, &keys)
}

/// The claim of an imported design, whose comments say all that is said of the import.
pub fn claim(imported: &Imported) -> Machine {
    let text = &imported.design;
    let design = Design::parse(text, "imported.toml").unwrap_or_else(|e| panic!("{e}\n{text}"));
    let comments: String = text.lines().take_while(|line| line.starts_with('#')).collect();
    let squeezed = |s: &str| s.replace(['#', ' '], "");
    let mut told = imported.not_carried_over.clone();
    told.extend(imported.used.iter().map(ToString::to_string));
    told.extend(imported.defaults.iter().map(ToString::to_string));
    told.extend(imported.ignored.iter().map(ToString::to_string));
    for sentence in told {
        assert!(squeezed(&comments).contains(&squeezed(&sentence)), "{sentence}\n{text}");
    }
    Machine::new(design.claim)
}

/// A claim about three legs, and its numbers as designs have them.
#[derive(Debug)]
pub struct Machine {
    pub legs: [Leg; 3],
    pub workspace: Workspace,
    /// As it is decided.
    pub kernel: MachineClaim,
}

/// Every value from one to the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    pub min: Exact,
    pub max: Exact,
}

impl Quantity {
    pub fn is_exact(&self) -> bool {
        self.min == self.max
    }
}

type Vector = [Quantity; 3];

#[derive(Debug)]
pub enum Leg {
    Slider { anchor: Vector, length: Quantity },
    Strut,
    Arm { anchor: Vector, arm: Quantity, length: Quantity, mode: Sign },
}

impl Leg {
    pub fn is_angular(&self) -> bool {
        matches!(self, Leg::Arm { .. })
    }
}

#[derive(Debug, PartialEq)]
pub enum Workspace {
    Box { min: [Exact; 3], max: [Exact; 3] },
    Cylinder { center: [Exact; 2], radius: Exact, z: [Exact; 2] },
}

fn exact(x: &Expression) -> Exact {
    Exact::parse(&x.to_string(), 2100).expect("a number")
}

fn all<const N: usize>(x: &[Expression]) -> [Exact; N] {
    std::array::from_fn(|k| exact(&x[k]))
}

fn quantity(x: &kernel::Quantity) -> Quantity {
    match x {
        kernel::Quantity::Exactly(x) => Quantity { min: exact(x), max: exact(x) },
        kernel::Quantity::Between { min, max } => Quantity { min: exact(min), max: exact(max) },
    }
}

fn vector(x: &[kernel::Quantity]) -> Vector {
    std::array::from_fn(|k| quantity(&x[k]))
}

fn leg(leg: &kernel::Leg) -> Leg {
    match leg {
        kernel::Leg::Slider { anchor, length, .. } => {
            Leg::Slider { anchor: vector(anchor), length: quantity(length) }
        }
        kernel::Leg::Arm { anchor, arm, length, mode, .. } => Leg::Arm {
            anchor: vector(anchor),
            arm: quantity(arm),
            length: quantity(length),
            mode: *mode,
        },
        kernel::Leg::Strut { .. } => Leg::Strut,
        kernel::Leg::Planar { .. } => panic!("no firmware has it: {leg:?}"),
    }
}

impl Machine {
    fn new(kernel: MachineClaim) -> Self {
        let Mechanism::Translational(legs) = &kernel.mechanism else { panic!("{kernel:?}") };
        let legs: Vec<Leg> = legs.iter().map(leg).collect();
        let workspace = match &kernel.workspace {
            kernel::Workspace::Box { min, max } => Workspace::Box { min: all(min), max: all(max) },
            kernel::Workspace::Cylinder { center, radius, z } => {
                Workspace::Cylinder { center: all(center), radius: exact(radius), z: all(z) }
            }
            kernel::Workspace::Cube { .. } => panic!("a cube"),
        };
        Machine { legs: legs.try_into().expect("three legs"), workspace, kernel }
    }

    /// The same over a box.
    pub fn on_a_box(self, [min, max]: [[Exact; 3]; 2]) -> Self {
        let texts = |corner: &[Exact; 3]| corner.each_ref().map(ToString::to_string);
        let own = serde_json::json!({ "box": { "min": texts(&min), "max": texts(&max) } });
        let workspace = serde_json::from_value(own).expect("a box of the kernel");
        Machine::new(MachineClaim { workspace, ..self.kernel })
    }

    /// The bounds on joint coordinates.
    pub fn joint_ranges(&self) -> Vec<&kernel::Requirement> {
        self.kernel.require.iter().filter(|own| own.quantity == "joint_range").collect()
    }
}

/// The legs of a translational machine.
pub fn legs(claim: &Machine) -> &[Leg; 3] {
    &claim.legs
}

/// An exact number.
pub fn number(text: &str) -> Exact {
    Exact::parse(text, 1000).expect("a number")
}

/// A quantity without tolerance.
pub fn exactly(text: &str) -> Quantity {
    Quantity { min: number(text), max: number(text) }
}
