//! Imported designs, for tests.

use orthocert::design::Design;
use orthocert::exact::Exact;
use orthocert::import::{Files, ImportError, Imported, Importer};
use orthocert_checker::claim::{Claim, Leg, MachineClaim, Mechanism, Quantity, Workspace};
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
    let Claim::Kernel(kernel) = design.claim else { panic!("about a machine") };
    Machine { rules: design.rules.expect("a machine of three legs"), kernel }
}

/// A claim about three legs, in both vocabularies.
#[derive(Debug)]
pub struct Machine {
    rules: MachineClaim,
    /// As it is decided.
    pub kernel: orthocert_kernel::claim::MachineClaim,
}

impl Machine {
    /// The same over a box.
    pub fn on_a_box(self, [min, max]: [[Exact; 3]; 2]) -> Self {
        let texts = |corner: &[Exact; 3]| corner.each_ref().map(ToString::to_string);
        let own = serde_json::json!({ "box": { "min": texts(&min), "max": texts(&max) } });
        let workspace = serde_json::from_value(own).expect("a box of the kernel");
        let kernel = orthocert_kernel::claim::MachineClaim { workspace, ..self.kernel };
        Machine {
            rules: MachineClaim { workspace: Workspace::Box { min, max }, ..self.rules },
            kernel,
        }
    }
}

impl std::ops::Deref for Machine {
    type Target = MachineClaim;

    fn deref(&self) -> &MachineClaim {
        &self.rules
    }
}

/// The legs of a translational machine.
pub fn legs(claim: &MachineClaim) -> &[Leg; 3] {
    match &claim.mechanism {
        Mechanism::Translational(legs) => legs,
        Mechanism::Orthoglide { .. } => panic!("an Orthoglide"),
    }
}

/// An exact number.
pub fn number(text: &str) -> Exact {
    Exact::parse(text, 1000).expect("a number")
}

/// A quantity without tolerance.
pub fn exactly(text: &str) -> Quantity {
    Quantity::exactly(number(text))
}
