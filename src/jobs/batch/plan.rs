//! The designs that files and folders stand for, and where their certificates go.

use crate::files::output::follows_links;
use crate::files::read::{beside, identity, in_folder, Named};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// A design and the path of its certificate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Planned {
    /// The design file.
    pub design: PathBuf,
    /// Its certificate.
    pub certificate: PathBuf,
    /// The folder below which the certificate has to stay; none beside a design named by itself.
    pub below: Option<PathBuf>,
}

/// Why there is no plan; nothing was touched.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A folder without designs.
    #[error(
        "{}: found a folder without designs; accepted: a folder with *.toml files, at any depth \
         (what is hidden is skipped)",
        .0.shown()
    )]
    NoDesigns(PathBuf),
    /// A folder without certificates.
    #[error(
        "{}: found a folder without certificates; accepted: a folder with *.cert.json files, at any \
         depth (what is hidden is skipped)",
        .0.shown()
    )]
    NoCertificates(PathBuf),
    /// A folder that cannot be read.
    #[error("{path}: cannot be read: {1}; accepted: a folder", path = .0.shown())]
    Unreadable(PathBuf, #[source] io::Error),
    /// Two designs with the same certificate path.
    #[error(
        "found {} and {}, which both have the certificate {}; accepted: designs of different names, \
         or their common folder as the argument",
        .0.0.design.shown(), .0.1.design.shown(), .0.0.certificate.shown()
    )]
    Clash(Box<(Planned, Planned)>),
    /// A design whose certificate would be written over a design.
    #[error(
        "{}: its certificate {} is a design of this batch; accepted: another name",
        .0.design.shown(), .0.certificate.shown()
    )]
    OverDesign(Planned),
}

/// The designs of `arguments`, each once, in the order of the arguments and sorted within each
/// folder. Certificates stand beside their designs, or below `out`: there, a design of a folder
/// keeps its path below that folder, and a design named by itself keeps its path as it was given
/// (of a path that is absolute or has `..`, the name).
///
/// A path that does not exist is planned too: reading it will say what is wrong with it.
///
/// # Errors
/// [`PlanError`]: in particular, no two designs of a plan have the same certificate.
pub fn plan(arguments: &[PathBuf], out: Option<&Path>) -> Result<Vec<Planned>, PlanError> {
    let mut planned: Vec<Planned> = Vec::new();
    let (mut named, mut known) = (BTreeSet::new(), BTreeSet::new());
    for argument in arguments {
        let found = match argument.is_dir() {
            true => below(argument, ".toml")?,
            false => vec![argument.clone()],
        };
        if found.is_empty() {
            return Err(PlanError::NoDesigns(argument.clone()));
        }
        let folder = argument.is_dir().then_some(argument.as_path());
        for design in found {
            // A link is a design of its own, with a certificate of its own.
            if !named.insert(in_folder(&design).unwrap_or_else(|| design.clone())) {
                continue;
            }
            known.insert(identity(&design));
            let beside = certificate_of(&design);
            let certificate = match out {
                Some(out) => out.join(kept(argument, &beside)),
                None => beside,
            };
            let below = out.or(folder).map(Path::to_owned);
            planned.push(Planned { design, certificate, below });
        }
    }
    let mut targets: BTreeMap<PathBuf, &Planned> = BTreeMap::new();
    for one in &planned {
        // One link of a stranger's does not stop them all: it will be refused by itself.
        let unfollowed = || in_folder(&one.certificate).filter(|_| !follows_links());
        let target = unfollowed().unwrap_or_else(|| identity(&one.certificate));
        if known.contains(&target) || named.contains(&target) {
            return Err(PlanError::OverDesign(one.clone()));
        }
        if let Some(other) = targets.insert(target, one) {
            return Err(PlanError::Clash(Box::new((other.clone(), one.clone()))));
        }
    }
    Ok(planned)
}

/// `NAME.cert.json` beside `NAME.toml`.
pub fn certificate_of(design: &Path) -> PathBuf {
    let design = beside(design);
    let toml = design.extension().is_some_and(|extension| extension == "toml");
    let name = if toml { design.file_stem() } else { design.file_name() };
    let mut name = name.unwrap_or_default().to_owned();
    name.push(".cert.json");
    design.with_file_name(name)
}

/// The part of a certificate's path that it keeps below another folder.
fn kept(argument: &Path, certificate: &Path) -> PathBuf {
    if let Ok(below) = certificate.strip_prefix(argument) {
        return below.to_owned();
    }
    let plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if certificate.components().all(plain) {
        return certificate.components().filter(|part| *part != Component::CurDir).collect();
    }
    certificate.file_name().map(PathBuf::from).unwrap_or_default()
}

/// The files below `folder` whose names end in `ending`, sorted. Hidden files and folders are
/// skipped, and links to folders are not followed, so that there is an end to it.
///
/// # Errors
/// [`PlanError::Unreadable`] for the first folder that cannot be read.
pub fn below(folder: &Path, ending: &str) -> Result<Vec<PathBuf>, PlanError> {
    let mut found = Vec::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(folder) = waiting.pop() {
        let unreadable = |error| PlanError::Unreadable(folder.clone(), error);
        for entry in fs::read_dir(&folder).map_err(unreadable)? {
            let entry = entry.map_err(unreadable)?;
            let (path, name) = (entry.path(), entry.file_name());
            let name = name.to_string_lossy();
            if name.starts_with('.') {
                continue;
            }
            if entry.file_type().map_err(unreadable)?.is_dir() {
                waiting.push(path);
            } else if name.ends_with(ending) && !path.is_dir() {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn certificates_stand_beside_their_designs() {
        for (design, certificate) in [
            ("a.toml", "a.cert.json"),
            ("x/y/delta.v2.toml", "x/y/delta.v2.cert.json"),
            ("x/plain", "x/plain.cert.json"),
        ] {
            assert_eq!(certificate_of(Path::new(design)), Path::new(certificate));
        }
    }

    fn tree(names: &[&str]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for name in names {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        folder
    }

    #[test]
    fn a_folder_is_walked_sorted_and_without_what_is_hidden() {
        let names = ["b.toml", "a/x.toml", "a/x.txt", ".git/c.toml", ".hidden.toml", "a/b/z.toml"];
        let folder = tree(&names);
        let found = below(folder.path(), ".toml").unwrap();
        let found: Vec<_> = found.iter().map(|p| p.strip_prefix(folder.path()).unwrap()).collect();
        assert_eq!(found, ["a/b/z.toml", "a/x.toml", "b.toml"].map(Path::new));
    }

    #[test]
    fn folders_are_kept_below_another_folder() {
        let folder = tree(&["a/x.toml", "b/x.toml"]);
        let out = Path::new("proofs");
        let planned = plan(&[folder.path().to_owned()], Some(out)).unwrap();
        let certificates: Vec<_> = planned.iter().map(|one| one.certificate.as_path()).collect();
        assert_eq!(certificates, ["proofs/a/x.cert.json", "proofs/b/x.cert.json"].map(Path::new));
        for (argument, certificate) in [
            ("d/x.toml", "proofs/d/x.cert.json"),
            ("./x.toml", "proofs/x.cert.json"),
            ("../x.toml", "proofs/x.cert.json"),
            ("/tmp/x.toml", "proofs/x.cert.json"),
        ] {
            let planned = plan(&[PathBuf::from(argument)], Some(out)).unwrap();
            assert_eq!(planned[0].certificate, Path::new(certificate), "{argument}");
        }
    }

    #[test]
    fn a_design_named_twice_is_planned_once() {
        let folder = tree(&["x.toml"]);
        let arguments = [folder.path().to_owned(), folder.path().join("x.toml")];
        assert_eq!(plan(&arguments, None).unwrap().len(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_to_designs_are_designs_and_links_to_folders_are_left() {
        let folder = tree(&["a/x.toml"]);
        let link = |to: &str, name: &str| {
            std::os::unix::fs::symlink(to, folder.path().join(name)).unwrap();
        };
        link("x.toml", "a/alias.toml");
        link("../a", "a/loop");
        let planned = plan(&[folder.path().to_owned()], None).unwrap();
        let names: Vec<_> = planned.iter().filter_map(|one| one.certificate.file_name()).collect();
        assert_eq!(names, ["alias.cert.json", "x.cert.json"]);
        // A certificate that is a link, be it to a design, is not written through, and stops no other.
        link("alias.toml", "a/x.cert.json");
        assert_eq!(plan(&[folder.path().to_owned()], None).unwrap(), planned);
    }

    #[test]
    fn clashes_are_refused() {
        let folder = tree(&["a/x.toml", "b/x.toml", "b/x"]);
        let path = |name: &str| folder.path().join(name);
        let out = Some(Path::new("proofs"));
        assert!(matches!(
            plan(&[path("a/x.toml"), path("b/x.toml")], out),
            Err(PlanError::Clash(..))
        ));
        assert!(matches!(plan(&[path("b/x.toml"), path("b/x")], None), Err(PlanError::Clash(..))));
        let other = path("b/../b/x");
        assert!(matches!(plan(&[path("b/x.toml"), other], None), Err(PlanError::Clash(..))));
        fs::write(path("b/x.cert.json"), "").unwrap();
        let arguments = [path("b/x.toml"), path("b/x.cert.json")];
        assert!(matches!(plan(&arguments, None), Err(PlanError::OverDesign(_))));
    }

    #[test]
    fn a_folder_without_designs_is_refused() {
        let folder = tree(&["a/readme.txt"]);
        let refused = plan(&[folder.path().to_owned()], None);
        assert!(matches!(refused, Err(PlanError::NoDesigns(_))));
    }
}
