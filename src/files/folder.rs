//! Folders that appear whole or not at all, and take the place of nothing but their like.
//!
//! A folder is one of these if it holds [`SUMS`] and the files that are listed there, of names that
//! such a folder may have, with the bytes that were written. What somebody else put into it, or
//! changed in it, stays: the folder is then not replaced.

use crate::files::digest::{sha256, Summed};
use crate::files::output::{self, folder_of, OutputError};
use crate::files::read::Named;
use crate::files::shown::Shown;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The SHA-256 of every other file of the folder, as `sha256sum` writes and checks them.
pub const SUMS: &str = "SHA256SUMS";
/// Most bytes of [`SUMS`].
const MAX_SUMS: u64 = 1 << 16;

/// Why a folder is not written; what was there is as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// The path has no name of its own: `.`, `..` or the root.
    #[error("{}: found no name; accepted: the name of a folder", .0.shown())]
    Nameless(PathBuf),
    /// A link is there, or no folder.
    #[error("{}: cannot be written: it is a symbolic link, or no folder", .0.shown())]
    NotAFolder(PathBuf),
    /// It holds this file, which is not as it was written, or was not written at all.
    #[error(
        "{}: found {} in it, which is not what an earlier run left there; accepted: a new folder, an \
         empty one, or one with what an earlier run left and nothing else",
        .0.shown(), Shown(.1)
    )]
    Foreign(PathBuf, String),
    /// The operating system's reason.
    #[error("{path}: cannot be written: {1}", path = .0.shown())]
    Io(PathBuf, #[source] io::Error),
}

/// Finds out, before the work, whether [`write()`] has a chance; makes the folder's own folder.
///
/// # Errors
/// As [`write()`].
pub fn probe(path: &Path, names: &[&str]) -> Result<(), FolderError> {
    let io = |error| FolderError::Io(path.to_owned(), error);
    replaceable(path, names)?;
    fs::create_dir_all(folder_of(path)).map_err(io)?;
    hidden(path).and_then(TempDir::close).map_err(io)
}

/// Writes these files, whose names are among `names`, and their [`SUMS`] so that at every moment the
/// path holds either the folder with all of them or what it held before: a hidden folder beside it,
/// flushed to the disk, takes its place. Where two folders cannot be exchanged in one step (outside
/// Linux, and on some network file systems), there is a moment between two steps at which the path
/// holds nothing and the earlier folder is the hidden one.
///
/// # Errors
/// [`FolderError`]; then the path holds what it held before.
pub fn write(path: &Path, names: &[&str], files: &[(&str, String)]) -> Result<(), FolderError> {
    let io = |error| FolderError::Io(path.to_owned(), error);
    let _writing = output::hold();
    replaceable(path, names)?;
    let fresh = hidden(path).map_err(io)?;
    let sum = |(name, text): &(&str, String)| format!("{}  {name}\n", sha256(text.as_bytes()));
    let sums: String = files.iter().map(sum).collect();
    for (name, text) in files.iter().map(|(name, text)| (*name, text)).chain([(SUMS, &sums)]) {
        let file = File::create_new(fresh.path().join(name));
        let written = file.and_then(|mut file| {
            file.write_all(text.as_bytes())?;
            file.sync_all()
        });
        written.map_err(io)?;
    }
    #[cfg(unix)]
    File::open(fresh.path()).and_then(|folder| folder.sync_all()).map_err(io)?;
    put(fresh, path, names)
}

/// Puts the folder in the place of what is at `path`, if that may be replaced.
fn put(fresh: TempDir, path: &Path, names: &[&str]) -> Result<(), FolderError> {
    let io = |error| FolderError::Io(path.to_owned(), error);
    let is_there = || fs::symlink_metadata(path).is_ok();
    if !is_there() {
        match fs::rename(fresh.path(), path) {
            Ok(()) => {
                let _ = fresh.keep();
                return Ok(());
            }
            Err(error) if !is_there() => return Err(io(error)),
            // Another run was faster.
            Err(_) => {}
        }
    }
    let found = fs::metadata(path).map_err(io)?;
    fs::set_permissions(fresh.path(), found.permissions()).map_err(io)?;
    exchange(fresh.path(), path).map_err(io)?;
    // From here on the hidden folder is the earlier one.
    let earlier = fresh.keep();
    if let Err(changed) = replaceable(&earlier, names) {
        exchange(&earlier, path).map_err(io)?;
        remove(&earlier, names);
        return Err(match changed {
            FolderError::Foreign(_, name) => FolderError::Foreign(path.to_owned(), name),
            _ => FolderError::NotAFolder(path.to_owned()),
        });
    }
    remove(&earlier, names);
    Ok(())
}

/// Removes a folder of these files; what came there since stays, and the folder with it.
fn remove(folder: &Path, names: &[&str]) {
    for name in names.iter().chain([&SUMS]) {
        let _ = fs::remove_file(folder.join(name));
    }
    let _ = fs::remove_dir(folder);
}

/// Demands that nothing is at `path`, an empty folder, or one that [`write()`] wrote.
fn replaceable(path: &Path, names: &[&str]) -> Result<(), FolderError> {
    let io = |error| FolderError::Io(path.to_owned(), error);
    if path.file_name().is_none() {
        return Err(FolderError::Nameless(path.to_owned()));
    }
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(io(error)),
        Ok(found) if !found.is_dir() => return Err(FolderError::NotAFolder(path.to_owned())),
        Ok(_) => {}
    }
    let entries = fs::read_dir(path).map_err(io)?;
    let found: io::Result<Vec<OsString>> = entries.map(|e| e.map(|e| e.file_name())).collect();
    let found = found.map_err(io)?;
    let sums = sums(path).unwrap_or_default();
    let as_written = |name: &OsString| {
        let listed = sums.lines().filter_map(|line| line.split_once("  "));
        let mut of_that_name = listed.filter(|(_, listed)| name == listed);
        name == SUMS && !sums.is_empty()
            || of_that_name.next().is_some_and(|(sum, name)| {
                names.contains(&name) && sum_of(&path.join(name)).is_ok_and(|found| found == sum)
            })
    };
    match found.iter().find(|name| !as_written(name)) {
        None => Ok(()),
        Some(name) => {
            let name = name.to_string_lossy().into_owned();
            Err(FolderError::Foreign(path.to_owned(), name))
        }
    }
}

fn sums(folder: &Path) -> Result<String, OutputError> {
    let path = folder.join(SUMS);
    let mut text = String::new();
    let read = opened(&path)?.take(MAX_SUMS).read_to_string(&mut text);
    read.map_err(|error| OutputError::Io(path, error))?;
    Ok(text)
}

fn sum_of(path: &Path) -> Result<String, OutputError> {
    let found = Summed::new(opened(path)?).finish();
    found.map(|(sum, _)| sum).map_err(|error| OutputError::Io(path.to_owned(), error))
}

/// A regular file, to be read.
fn opened(path: &Path) -> Result<File, OutputError> {
    output::open_own(path, OpenOptions::new().read(true))
}

/// An empty hidden folder beside `path`.
fn hidden(path: &Path) -> io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".orthocert-").suffix(".part");
    #[cfg(unix)]
    {
        // As any new folder: the process's mask takes from it what it takes from all.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o777));
    }
    builder.tempdir_in(folder_of(path))
}

/// Exchanges two folders beside each other, in one step where the system can.
fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{renameat_with, RenameFlags, CWD};
        if renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE).is_ok() {
            return Ok(());
        }
    }
    in_steps(one, other)
}

/// Exchanges two folders, `other` being the one that is not to be without a folder for long.
fn in_steps(one: &Path, other: &Path) -> io::Result<()> {
    let between = hidden(other)?.keep();
    let aside = between.join("earlier");
    let moved = fs::rename(other, &aside);
    let put = moved.and_then(|()| {
        fs::rename(one, other).inspect_err(|_| {
            let _ = fs::rename(&aside, other);
        })
    });
    let exchanged = put.and_then(|()| fs::rename(&aside, one));
    let _ = fs::remove_dir(&between);
    exchanged
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 2] = ["a", "b"];

    fn files(text: &str) -> Vec<(&'static str, String)> {
        vec![("a", text.to_owned())]
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<String> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_folder_is_replaced_whole_and_nothing_else_remains() {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("new/map");
        probe(&path, &NAMES).unwrap();
        write(&path, &NAMES, &[("a", "1".into()), ("b", "2".into())]).unwrap();
        assert_eq!(names(&path), [SUMS, "a", "b"]);
        write(&path, &NAMES, &files("3")).unwrap();
        assert_eq!(
            (names(&path), fs::read(path.join("a")).unwrap()),
            (vec![SUMS.into(), "a".into()], b"3".to_vec())
        );
        assert_eq!(names(path.parent().unwrap()), ["map"]);
        let empty = scratch.path().join("empty");
        fs::create_dir(&empty).unwrap();
        write(&empty, &NAMES, &files("4")).unwrap();
        assert_eq!(names(scratch.path()), ["empty", "new"]);
    }

    #[test]
    fn what_is_not_ours_stays() {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("map");
        let kept = |spoil: &dyn Fn(), foreign: &str| {
            if path.exists() {
                fs::remove_dir_all(&path).unwrap();
            }
            write(&path, &NAMES, &files("1")).unwrap();
            spoil();
            let before = names(&path);
            let refused = write(&path, &NAMES, &files("2"));
            assert!(matches!(refused, Err(FolderError::Foreign(_, name)) if name == foreign));
            assert!(probe(&path, &NAMES).is_err());
            assert_eq!((names(&path), names(scratch.path())), (before, vec!["map".to_owned()]));
        };
        kept(&|| fs::write(path.join("c"), "mine").unwrap(), "c");
        kept(&|| fs::write(path.join("b"), "mine").unwrap(), "b");
        kept(&|| fs::write(path.join("a"), "changed").unwrap(), "a");
        kept(&|| fs::create_dir(path.join("b")).unwrap(), "b");
        kept(&|| fs::remove_file(path.join(SUMS)).unwrap(), "a");
        // Listed, but of no name that such a folder has.
        let listed = format!("{}  a\n{}  c\n", sha256(b"1"), sha256(b"mine"));
        let spoil = || {
            fs::write(path.join("c"), "mine").unwrap();
            fs::write(path.join(SUMS), &listed).unwrap();
        };
        kept(&spoil, "c");
    }

    #[test]
    fn what_is_no_folder_is_refused() {
        let scratch = tempfile::tempdir().unwrap();
        let file = scratch.path().join("file");
        fs::write(&file, "").unwrap();
        assert!(matches!(write(&file, &NAMES, &files("1")), Err(FolderError::NotAFolder(_))));
        for none in [".", "..", "/"] {
            assert!(matches!(probe(Path::new(none), &NAMES), Err(FolderError::Nameless(_))));
        }
        #[cfg(unix)]
        {
            let link = scratch.path().join("link");
            std::os::unix::fs::symlink(".", &link).unwrap();
            assert!(matches!(write(&link, &NAMES, &files("1")), Err(FolderError::NotAFolder(_))));
        }
        assert_eq!(fs::read(&file).unwrap(), b"");
    }

    #[test]
    fn folders_are_exchanged_in_steps_where_that_is_all_there_is() {
        let scratch = tempfile::tempdir().unwrap();
        let [one, other] = ["one", "other"].map(|name| scratch.path().join(name));
        for folder in [&one, &other] {
            fs::create_dir(folder).unwrap();
            fs::write(folder.join("was"), folder.file_name().unwrap().as_encoded_bytes()).unwrap();
        }
        in_steps(&one, &other).unwrap();
        assert_eq!(fs::read(one.join("was")).unwrap(), b"other");
        assert_eq!(fs::read(other.join("was")).unwrap(), b"one");
        assert_eq!(names(scratch.path()), ["one", "other"]);
        assert!(in_steps(&scratch.path().join("none"), &other).is_err());
        assert_eq!(names(scratch.path()), ["one", "other"]);
    }
}
