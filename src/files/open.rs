//! Reading files of strangers: nothing is waited for, and nothing is read without end.
//!
//! Regular files alone are read, also at the end of a link: a pipe may never begin, a device never
//! end. What the caller of the process has opened for it, and names as such, is read whatever it is.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufReader, Read as _, Take};
use std::path::Path;

/// Whether a path, as it is spelled, is the system's name of something that is no file of a folder:
/// what the process was given (`/dev/stdin`, `/dev/fd/N`), or nothing at all.
pub fn is_stream(path: &Path) -> bool {
    const NAMES: [&str; 5] = ["/dev/stdin", "/dev/stdout", "/dev/stderr", "/dev/null", "/dev/full"];
    const GIVEN: [&str; 2] = ["/dev/fd/", "/proc/self/fd/"];
    let digits = |number: &str| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
    path.to_str().is_some_and(|path| {
        NAMES.contains(&path) || GIVEN.iter().any(|way| path.strip_prefix(way).is_some_and(digits))
    })
}

/// Opens a regular file to read it, or a stream ([`is_stream`]).
///
/// # Errors
/// The operating system's; for everything else that may be there, a sentence.
pub fn open(path: &Path) -> io::Result<File> {
    if is_stream(path) {
        return File::open(path);
    }
    // Opening a device may already do something to it.
    regular(&fs::metadata(path)?)?;
    let mut options = OpenOptions::new();
    let file = unhurried(options.read(true)).open(path)?;
    // What came there between is not waited for, nor read.
    regular(&file.metadata()?)?;
    Ok(file)
}

fn regular(found: &Metadata) -> io::Result<()> {
    if found.is_file() {
        return Ok(());
    }
    let what = if found.is_dir() { "it is a folder" } else { "no regular file" };
    Err(io::Error::other(what))
}

/// Options with which nothing is waited for, and no terminal becomes the process's own.
fn unhurried(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(any(target_os = "linux", target_os = "macos"))]
    {
        use std::os::unix::fs::OpenOptionsExt;
        // O_NONBLOCK | O_NOCTTY, as on all processors but MIPS, SPARC and Alpha.
        options.custom_flags(match cfg!(target_os = "linux") {
            true => 0o4000 | 0o400,
            false => 0x4 | 0x2_0000,
        });
    }
    options
}

/// A file of any length to be read piece by piece, no farther than it goes now.
///
/// # Errors
/// As [`open`].
pub fn reader(path: &Path) -> io::Result<BufReader<Take<File>>> {
    let file = open(path)?;
    let found = file.metadata()?;
    let end = if found.is_file() { found.len() } else { u64::MAX };
    Ok(BufReader::new(file.take(end)))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn regular_files_alone_are_read() {
        let folder = std::env::temp_dir().join(format!("orthocert-file-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = |name: &str| folder.join(name);
        fs::write(path("file"), "text").unwrap();
        assert!(Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
        for (name, to) in [("link", "file"), ("zero", "/dev/zero"), ("loop", "loop")] {
            std::os::unix::fs::symlink(to, path(name)).unwrap();
        }
        let read = |path: &Path| std::io::read_to_string(reader(path).unwrap()).unwrap();
        assert_eq!(read(&path("link")), "text");
        for name in ["pipe", "zero", "loop", "."] {
            assert!(open(&path(name)).is_err(), "{name}");
        }
        assert_eq!(read(Path::new("/dev/null")), "");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn streams_are_known_by_their_spelling() {
        for (path, stream) in [
            ("/dev/stdin", true),
            ("/dev/fd/63", true),
            ("/dev/fd/", false),
            ("/dev/fd/../zero", false),
            ("dev/stdin", false),
            ("/dev/zero", false),
        ] {
            assert_eq!(is_stream(Path::new(path)), stream, "{path}");
        }
    }
}
