//! Certificates with their designs, and what has no counterpart.

use super::plan::{below, certificate_of, PlanError};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A certificate and the design that it belongs to by name; at least one of them is there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pair {
    /// `NAME.cert.json`.
    pub certificate: Option<PathBuf>,
    /// `NAME.toml`, at the same place below its folder.
    pub design: Option<PathBuf>,
}

/// What the certificates below one folder and the designs below another, perhaps the same, make of
/// pairs: sorted by the certificate's path below its folder.
///
/// # Errors
/// If a folder cannot be read, or if there is nothing in both.
pub fn pairs(certificates: &Path, designs: &Path) -> Result<Vec<Pair>, PlanError> {
    let mut pairs: BTreeMap<PathBuf, Pair> = BTreeMap::new();
    let key = |path: &Path, folder: &Path| path.strip_prefix(folder).unwrap_or(path).to_owned();
    for certificate in below(certificates, ".cert.json")? {
        let pair = pairs.entry(key(&certificate, certificates)).or_default();
        pair.certificate = Some(certificate);
    }
    for design in below(designs, ".toml")? {
        let pair = pairs.entry(certificate_of(&key(&design, designs))).or_default();
        pair.design = Some(design);
    }
    match pairs.is_empty() {
        true => Err(PlanError::NoCertificates(certificates.to_owned())),
        false => Ok(pairs.into_values().collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn certificates_find_their_designs_by_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in ["d/a", "d/b", "c/a", "c/b"] {
            fs::create_dir_all(path(name)).unwrap();
        }
        for name in ["d/a/x.toml", "d/b/x.toml", "c/a/x.cert.json", "c/y.cert.json", "c/y.json"] {
            fs::write(path(name), "").unwrap();
        }
        let pair = |certificate: Option<&str>, design: Option<&str>| Pair {
            certificate: certificate.map(path),
            design: design.map(path),
        };
        let expected = [
            pair(Some("c/a/x.cert.json"), Some("d/a/x.toml")),
            pair(None, Some("d/b/x.toml")),
            pair(Some("c/y.cert.json"), None),
        ];
        assert_eq!(pairs(&path("c"), &path("d")).unwrap(), expected);
        assert!(matches!(pairs(&path("c/b"), &path("c/b")), Err(PlanError::NoCertificates(_))));
    }
}
