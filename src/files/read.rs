//! Files that are read, and their names.

use crate::files::open::{is_stream, open};
use crate::files::output::folder_of;
use crate::files::shown::Shown;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// The file that a name stands for: `-` for standard input.
pub fn meant(path: &Path) -> &Path {
    if path == Path::new("-") {
        Path::new("/dev/stdin")
    } else {
        path
    }
}

/// Beside what the answers about a file are written: beside itself, about a stream in the current folder, as
/// if it were called `stdin.toml`.
pub fn beside(path: &Path) -> &Path {
    if is_stream(meant(path)) {
        Path::new("stdin.toml")
    } else {
        path
    }
}

/// `DESIGN.NAME`, of a design without its ending: in the folder, or beside the design.
pub fn named_after(design: &Path, name: &str, folder: Option<&Path>) -> PathBuf {
    let design = beside(design);
    let mut file = design.file_stem().unwrap_or_default().to_owned();
    file.push(format!(".{name}"));
    match folder {
        Some(folder) => folder.join(file),
        None => design.with_file_name(file),
    }
}

/// The same for all ways to write the path of a file, which need not exist if its folder does.
pub fn identity(path: &Path) -> PathBuf {
    fs::canonicalize(path).ok().or_else(|| in_folder(path)).unwrap_or_else(|| path.to_owned())
}

/// The same for all ways to write the folder; a link stays what it is.
pub fn in_folder(path: &Path) -> Option<PathBuf> {
    let folder = fs::canonicalize(folder_of(path)).ok()?;
    Some(folder.join(path.file_name()?))
}

/// The bytes of a file, or the first `limit` and one more: then it is too large.
///
/// # Errors
/// As [`open`], or if it cannot be read.
pub fn read(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(meant(path))?.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// File names, shown.
pub trait Named {
    /// The name for messages, on one line.
    fn shown(&self) -> Shown<std::ffi::os_str::Display<'_>>;
}

impl Named for OsStr {
    #[allow(clippy::disallowed_methods)] // What is displayed is escaped.
    fn shown(&self) -> Shown<std::ffi::os_str::Display<'_>> {
        Shown(self.display())
    }
}

impl Named for Path {
    fn shown(&self) -> Shown<std::ffi::os_str::Display<'_>> {
        self.as_os_str().shown()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_more_than_the_limit_is_read_and_a_name_stays_on_its_line() {
        let path = std::env::temp_dir().join(format!("orthocert-read\n{}", std::process::id()));
        std::fs::write(&path, "text").unwrap();
        assert_eq!(read(&path, 4).unwrap(), b"text");
        assert_eq!(read(&path, 2).unwrap(), b"tex");
        assert!(path.shown().to_string().contains("orthocert-read\\n"));
        std::fs::remove_file(path).unwrap();
    }
}
