//! Files that appear whole or not at all.

use std::fmt;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Held while a temporary file exists: who wants to end the process takes it first.
static WRITING: Mutex<()> = Mutex::new(());

/// Why a file could not be written; the target is as it was before.
#[derive(Debug)]
#[non_exhaustive]
pub enum OutputError {
    /// The target is a folder.
    IsFolder(PathBuf),
    /// The target exists and is marked read-only.
    ReadOnly(PathBuf),
    /// The folder of the target does not exist, or is not a folder.
    NoFolder(PathBuf),
    /// The operating system's reason.
    Io(PathBuf, io::Error),
}

impl fmt::Display for OutputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OutputError::IsFolder(path) => {
                write!(f, "{}: cannot be written: it is a folder", path.display())
            }
            OutputError::ReadOnly(path) => {
                write!(f, "{}: cannot be written: the file is read-only", path.display())
            }
            OutputError::NoFolder(path) => write!(
                f,
                "{}: cannot be written: there is no folder {}",
                path.display(),
                folder_of(path).display()
            ),
            OutputError::Io(path, error) => {
                write!(f, "{}: cannot be written: {error}", path.display())
            }
        }
    }
}

impl std::error::Error for OutputError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            OutputError::Io(_, error) => Some(error),
            _ => None,
        }
    }
}

/// Keeps files from being begun; a file that is being written is finished, or removed, first.
pub fn hold() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The folder in which `path` is an entry.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Finds out, before the work, whether [`write()`] has a chance.
///
/// # Errors
/// As [`write()`], without touching the file system.
pub fn probe(path: &Path) -> Result<(), OutputError> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(OutputError::IsFolder(path.to_owned())),
        Ok(found) if found.is_file() && found.permissions().readonly() => {
            Err(OutputError::ReadOnly(path.to_owned()))
        }
        Ok(_) => Ok(()),
        Err(_) if path.file_name().is_none() => Err(OutputError::IsFolder(path.to_owned())),
        Err(_) if !folder_of(path).is_dir() => Err(OutputError::NoFolder(path.to_owned())),
        Err(_) => Ok(()),
    }
}

/// Writes `bytes` to `path` so that at every moment the path holds either all of them or what it
/// held before: a temporary file in the same folder, flushed to the disk, takes the path's place.
/// Links are followed, an existing file keeps its permissions, and what is not a regular file (a
/// device, a pipe) is written to as it is.
///
/// # Errors
/// [`OutputError`]; then the path holds what it held before and no temporary file remains.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    probe(path)?;
    let fail = |error| OutputError::Io(path.to_owned(), error);
    match fs::metadata(path) {
        Ok(found) if !found.is_file() => {
            let mut file = OpenOptions::new().write(true).open(path).map_err(fail)?;
            file.write_all(bytes).and_then(|()| file.flush()).map_err(fail)
        }
        Ok(found) => {
            let target = fs::canonicalize(path).map_err(fail)?;
            replace(&target, bytes, Some(found.permissions())).map_err(fail)
        }
        Err(_) => replace(path, bytes, None).map_err(fail),
    }
}

fn replace(target: &Path, bytes: &[u8], keep: Option<fs::Permissions>) -> io::Result<()> {
    let _writing = hold();
    let folder = folder_of(target);
    #[cfg(target_os = "linux")]
    if let Some(complete) = nameless(folder, bytes, keep.as_ref())? {
        return complete.persist(target).map_err(|error| error.error);
    }
    let mut temporary = builder().tempfile_in(folder)?;
    temporary.write_all(bytes)?;
    if let Some(permissions) = keep {
        fs::set_permissions(temporary.path(), permissions)?;
    }
    temporary.as_file().sync_all()?;
    // The folder itself need not be flushed: whenever its entry arrives, the file is complete.
    temporary.persist(target).map_err(|error| error.error)?;
    Ok(())
}

/// Writes a file that has no name until it is complete, so that not even a process that is killed
/// leaves a part of it; `None` where the file system has no such files.
#[cfg(target_os = "linux")]
fn nameless(
    folder: &Path,
    bytes: &[u8],
    keep: Option<&fs::Permissions>,
) -> io::Result<Option<tempfile::TempPath>> {
    use rustix::fs::{linkat, open, AtFlags, Mode, OFlags, CWD};
    use std::os::fd::AsRawFd;
    let flags = OFlags::TMPFILE | OFlags::WRONLY | OFlags::CLOEXEC;
    let Ok(file) = open(folder, flags, Mode::from_raw_mode(0o666)) else {
        return Ok(None);
    };
    let mut file = fs::File::from(file);
    file.write_all(bytes)?;
    if let Some(permissions) = keep {
        file.set_permissions(permissions.clone())?;
    }
    file.sync_all()?;
    let itself = format!("/proc/self/fd/{}", file.as_raw_fd());
    let named = builder()
        .make_in(folder, |path| Ok(linkat(CWD, &itself, CWD, path, AtFlags::SYMLINK_FOLLOW)?));
    Ok(named.ok().map(tempfile::NamedTempFile::into_temp_path))
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".orthocert-").suffix(".part");
    #[cfg(unix)]
    {
        // As any new file: the process's mask takes from it what it takes from all.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_remains() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        write(&path, b"one, and longer").unwrap();
        write(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(folder.path()), ["a.json"]);
    }

    #[test]
    fn folders_and_read_only_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(write(folder.path(), b"x"), Err(OutputError::IsFolder(_))));
        let missing = folder.path().join("no/such/a.json");
        assert!(matches!(write(&missing, b"x"), Err(OutputError::NoFolder(_))));
        let kept = folder.path().join("kept");
        fs::write(&kept, "old").unwrap();
        let mut permissions = fs::metadata(&kept).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&kept, permissions).unwrap();
        assert!(matches!(write(&kept, b"new"), Err(OutputError::ReadOnly(_))));
        assert_eq!(fs::read(&kept).unwrap(), b"old");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_permissions_kept() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error() {
        assert!(matches!(write(Path::new("/dev/full"), b"x"), Err(OutputError::Io(..))));
    }
}
