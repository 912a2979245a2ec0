//! Files that appear whole or not at all, where they are meant to.
//!
//! A folder is named by who runs the program, the files in it may be strangers': a link in the place
//! of a file, or of a folder below the one that was named, would lead to somebody else's. Links are
//! refused, unless [`follow_links`] was called.

use crate::files::open::is_stream;
use crate::files::read::Named;
use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempPath;

/// Held while a temporary file exists: who wants to end the process takes it first.
static WRITING: Mutex<()> = Mutex::new(());
/// Whether links are followed: a decision of who runs the program, for all of it.
static FOLLOW: AtomicBool = AtomicBool::new(false);

/// Why a file could not be written; the target is as it was before.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The target is a folder.
    #[error("{}: cannot be written: it is a folder", .0.shown())]
    IsFolder(PathBuf),
    /// The target exists and is marked read-only.
    #[error("{}: cannot be written: the file is read-only", .0.shown())]
    ReadOnly(PathBuf),
    /// The folder of the target does not exist, or is not a folder.
    #[error("{}: cannot be written: there is no folder {}", .0.shown(), folder_of(.0).shown())]
    NoFolder(PathBuf),
    /// What is there is a link, or no regular file.
    #[error(
        "{}: cannot be written: it is a symbolic link, or no regular file; --follow-links follows links",
        .0.shown()
    )]
    NotAFile(PathBuf),
    /// Another run is writing the file.
    #[error("{}: cannot be written: another run is writing it", .0.shown())]
    Busy(PathBuf),
    /// The operating system's reason.
    #[error("{path}: cannot be written: {1}", path = .0.shown())]
    Io(PathBuf, #[source] io::Error),
}

impl OutputError {
    /// The same of another path.
    fn of(self, path: &Path) -> Self {
        let path = path.to_owned();
        match self {
            OutputError::IsFolder(_) => OutputError::IsFolder(path),
            OutputError::ReadOnly(_) => OutputError::ReadOnly(path),
            OutputError::NoFolder(_) => OutputError::NoFolder(path),
            OutputError::NotAFile(_) => OutputError::NotAFile(path),
            OutputError::Busy(_) => OutputError::Busy(path),
            OutputError::Io(_, error) => OutputError::Io(path, error),
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

/// Has links followed from now on where files are written.
pub fn follow_links() {
    FOLLOW.store(true, Ordering::Relaxed);
}

/// Whether links are followed where files are written.
pub fn follows_links() -> bool {
    FOLLOW.load(Ordering::Relaxed)
}

/// What is at a path: of a link, what it leads to only where links are followed.
fn look(path: &Path) -> io::Result<Metadata> {
    match follows_links() {
        true => fs::metadata(path),
        // A separator at the end of the path of a link would have it followed.
        false => fs::symlink_metadata(path.components().collect::<PathBuf>()),
    }
}

/// Finds out, before the work, whether [`write()`] has a chance.
///
/// # Errors
/// As [`write()`], without touching the file system.
pub fn probe(path: &Path) -> Result<(), OutputError> {
    if is_stream(path) {
        return Ok(());
    }
    match look(path) {
        Ok(found) if found.is_dir() => Err(OutputError::IsFolder(path.to_owned())),
        Ok(found) if !found.is_file() => Err(OutputError::NotAFile(path.to_owned())),
        Ok(found) if found.permissions().readonly() => Err(OutputError::ReadOnly(path.to_owned())),
        Ok(_) => Ok(()),
        Err(_) if path.file_name().is_none() => Err(OutputError::IsFolder(path.to_owned())),
        Err(_) if !folder_of(path).is_dir() => Err(OutputError::NoFolder(path.to_owned())),
        Err(_) => Ok(()),
    }
}

/// Writes `bytes` to `path` so that at every moment the path holds either all of them or what it
/// held before: a temporary file in the same folder, flushed to the disk, takes the path's place. An
/// existing file keeps its permissions. What the system names as a stream ([`is_stream`]) is written
/// to as it is.
///
/// # Errors
/// [`OutputError`]; then the path holds what it held before and no temporary file remains.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    probe(path)?;
    let fail = |error| OutputError::Io(path.to_owned(), error);
    if is_stream(path) {
        let mut file = OpenOptions::new().write(true).open(path).map_err(fail)?;
        return file.write_all(bytes).and_then(|()| file.flush()).map_err(fail);
    }
    match look(path) {
        Ok(found) => {
            // Where links are followed, the file that they lead to is replaced.
            let target = match follows_links() {
                true => fs::canonicalize(path).map_err(fail)?,
                false => path.to_owned(),
            };
            replace(&target, bytes, Some(found.permissions())).map_err(fail)
        }
        Err(_) => replace(path, bytes, None).map_err(fail),
    }
}

/// As [`write()`], below a folder: neither that nor any on the way from it to the file may be a link;
/// those that are not there are made.
///
/// # Errors
/// As [`write()`].
pub fn write_below(root: &Path, path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let folder = folder(root, folder_of(path))?;
    let name = path.file_name().ok_or_else(|| OutputError::IsFolder(path.to_owned()))?;
    // What goes wrong is told of the path as it was named.
    write(&folder.path().join(name), bytes).map_err(|error| error.of(path))
}

/// The folder at `path`, which is `root` or below it: neither is a link, nor is any between; those
/// that are not there are made.
///
/// # Errors
/// [`OutputError`].
pub fn folder(root: &Path, path: &Path) -> Result<Folder, OutputError> {
    let io = |error| OutputError::Io(path.to_owned(), error);
    let below = path.strip_prefix(root).map_err(|_| io(no_folder()))?;
    // Of the names on the way to the root, and of the links there, whoever named it knows.
    let root: PathBuf = root.components().collect();
    let root = if root.as_os_str().is_empty() { Path::new(".") } else { &root };
    fs::create_dir_all(folder_of(root)).map_err(io)?;
    let mut folder = Folder::enter(root.to_owned()).map_err(io)?;
    for part in below.components() {
        folder = Folder::enter(folder.path().join(part)).map_err(io)?;
    }
    Ok(folder)
}

/// A folder that stays the same one, whatever becomes of its path.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    #[cfg(target_os = "linux")]
    _handle: std::os::fd::OwnedFd,
}

impl Folder {
    /// The folder at a path, which is made if nothing is there.
    fn enter(path: PathBuf) -> io::Result<Self> {
        match fs::create_dir(&path) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists && !path.is_dir() => {
                Err(error)
            }
            _ => Self::open(path),
        }
    }

    #[cfg(target_os = "linux")]
    fn open(path: PathBuf) -> io::Result<Self> {
        use rustix::fs::{open, Mode, OFlags};
        use std::os::fd::AsRawFd;
        let mut flags = OFlags::PATH | OFlags::DIRECTORY | OFlags::CLOEXEC;
        if !follows_links() {
            flags |= OFlags::NOFOLLOW;
        }
        let handle = open(&path, flags, Mode::empty()).map_err(|error| match error {
            rustix::io::Errno::NOTDIR | rustix::io::Errno::LOOP => no_folder(),
            error => error.into(),
        })?;
        let held = PathBuf::from(format!("/proc/self/fd/{}", handle.as_raw_fd()));
        let path = if held.is_dir() { held } else { path };
        Ok(Folder { path, _handle: handle })
    }

    #[cfg(not(target_os = "linux"))]
    fn open(path: PathBuf) -> io::Result<Self> {
        if look(&path)?.is_dir() {
            Ok(Folder { path })
        } else {
            Err(no_folder())
        }
    }

    /// Demands that nothing in it is a link, for the sake of programs that follow links; `path` is for
    /// messages only.
    ///
    /// # Errors
    /// [`OutputError::NotAFile`].
    pub fn has_no_links(&self, path: &Path) -> Result<(), OutputError> {
        let io = |error| OutputError::Io(path.to_owned(), error);
        for entry in fs::read_dir(&self.path).map_err(io)? {
            let entry = entry.map_err(io)?;
            if entry.file_type().map_err(io)?.is_symlink() && !follows_links() {
                return Err(OutputError::NotAFile(path.join(entry.file_name())));
            }
        }
        Ok(())
    }

    /// A path that leads to it; messages are to name another.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

fn no_folder() -> io::Error {
    io::Error::other("no folder, or a symbolic link to one; --follow-links follows links")
}

fn replace(target: &Path, bytes: &[u8], keep: Option<fs::Permissions>) -> io::Result<()> {
    let _writing = hold();
    let complete = Pending::beside(target)?;
    complete.file().write_all(bytes)?;
    if let Some(permissions) = keep {
        complete.file().set_permissions(permissions)?;
    }
    complete.file().sync_all()?;
    complete.persist(target)
}

/// A file that nobody else has, to be completed and then put in a path's place; dropped before, it
/// leaves nothing.
#[derive(Debug)]
pub struct Pending {
    file: File,
    /// Its name; `None` where a file may have none, so that not even a process that is killed
    /// leaves a part of it.
    named: Option<TempPath>,
}

impl Pending {
    /// An empty file in the folder of `target`.
    ///
    /// # Errors
    /// If there can be none.
    pub fn beside(target: &Path) -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        if let Some(file) = nameless(folder_of(target)) {
            return Ok(Pending { file, named: None });
        }
        let (file, named) = builder().tempfile_in(folder_of(target))?.into_parts();
        Ok(Pending { file, named: Some(named) })
    }

    /// The file, to be written and read.
    pub fn file(&self) -> &File {
        &self.file
    }

    /// Puts the file, which is complete and on the disk, in the place of `target`.
    ///
    /// # Errors
    /// If that fails; then `target` holds what it held before.
    pub fn persist(self, target: &Path) -> io::Result<()> {
        let named = match self.named {
            Some(named) => named,
            None => named(&self.file, folder_of(target))?,
        };
        // The folder itself need not be flushed: whenever its entry arrives, the file is complete.
        named.persist(target).map_err(|error| error.error)
    }
}

/// A file without a name; `None` where the file system has no such files.
#[cfg(target_os = "linux")]
fn nameless(folder: &Path) -> Option<File> {
    use rustix::fs::{open, Mode, OFlags};
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    open(folder, flags, Mode::from_raw_mode(0o666)).ok().map(File::from)
}

/// Gives a file without a name one; where that cannot be, a copy of it.
fn named(file: &File, folder: &Path) -> io::Result<TempPath> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{linkat, AtFlags, CWD};
        use std::os::fd::AsRawFd;
        let itself = format!("/proc/self/fd/{}", file.as_raw_fd());
        let link = |path: &Path| Ok(linkat(CWD, &itself, CWD, path, AtFlags::SYMLINK_FOLLOW)?);
        if let Ok(named) = builder().make_in(folder, link) {
            return Ok(named.into_temp_path());
        }
    }
    let mut copy = builder().tempfile_in(folder)?;
    let mut from = file;
    from.rewind()?;
    io::copy(&mut from, &mut copy)?;
    copy.as_file().set_permissions(file.metadata()?.permissions())?;
    copy.as_file().sync_all()?;
    Ok(copy.into_temp_path())
}

/// Demands that a file of this program's own is at `path`, or nothing: such files are written in
/// place, and a link would lead to somebody's else.
///
/// # Errors
/// [`OutputError::NotAFile`].
pub fn own(path: &Path) -> Result<(), OutputError> {
    match look(path) {
        Ok(found) if !found.is_file() => Err(OutputError::NotAFile(path.to_owned())),
        _ => Ok(()),
    }
}

/// Opens a file of this program's own as [`own`] demands it, with these options, which do not
/// truncate.
///
/// # Errors
/// [`OutputError`].
pub fn open_own(path: &Path, options: &mut OpenOptions) -> Result<File, OutputError> {
    own(path)?;
    // What came there since is not followed, nor waited for.
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        let follow = follows_links();
        let nofollow = if follow { OFlags::empty() } else { OFlags::NOFOLLOW };
        options.custom_flags((nofollow | OFlags::NONBLOCK).bits().cast_signed());
    }
    let io = |error| OutputError::Io(path.to_owned(), error);
    let file = options.open(path).map_err(io)?;
    match file.metadata().map_err(io)?.is_file() {
        true => Ok(file),
        false => Err(OutputError::NotAFile(path.to_owned())),
    }
}

/// Opens a file of this program's own to read and write it, and locks it until it is closed: what
/// it holds is not touched before nobody else writes it.
///
/// # Errors
/// [`OutputError`]; [`OutputError::Busy`] where another run has it.
pub fn open_locked(path: &Path, create: bool) -> Result<File, OutputError> {
    loop {
        let mut options = OpenOptions::new();
        let file = open_own(path, options.read(true).write(true).create(create).truncate(false))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(OutputError::Busy(path.to_owned())),
            Err(TryLockError::Error(error)) => {
                return Err(OutputError::Io(path.to_owned(), error));
            }
        }
        // Between, whoever had it may have put it elsewhere: that is then theirs.
        if is_at(&file, path).map_err(|error| OutputError::Io(path.to_owned(), error))? {
            return Ok(file);
        }
    }
}

/// Whether `path` still names this file.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let this = file.metadata()?;
    Ok(look(path).is_ok_and(|found| (found.dev(), found.ino()) == (this.dev(), this.ino())))
}

/// Whether `path` still names a file; another one only where the other run's last step fell between
/// two calls of this one.
#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> io::Result<bool> {
    Ok(look(path).is_ok_and(|found| found.is_file()))
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
    fn links_are_refused_and_permissions_kept() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        assert!(matches!(write(&link, b"new"), Err(OutputError::NotAFile(_))));
        assert_eq!(fs::read(&file).unwrap(), b"old");
        write(&file, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn nothing_is_written_through_a_link_below_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let (root, other) = (folder.path().join("out"), folder.path().join("other"));
        fs::create_dir(&other).unwrap();
        write_below(&root, &root.join("a/b/c.json"), b"x").unwrap();
        assert_eq!(fs::read(root.join("a/b/c.json")).unwrap(), b"x");
        std::os::unix::fs::symlink(&other, root.join("a/link")).unwrap();
        std::os::unix::fs::symlink(&other, folder.path().join("root")).unwrap();
        for (root, file) in
            [("out", "out/a/link/c.json"), ("root", "root/c.json"), ("root/", "root/c.json")]
        {
            let path = folder.path().join(file);
            let error = write_below(&folder.path().join(root), &path, b"x").unwrap_err();
            assert!(error.to_string().contains(&*folder_of(&path).to_string_lossy()), "{error}");
        }
        assert!(names(&other).is_empty());
    }

    #[test]
    fn a_file_is_locked_once_and_what_it_holds_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.part");
        assert!(matches!(open_locked(&path, false), Err(OutputError::Io(..))));
        let first = open_locked(&path, true).unwrap();
        (&first).write_all(b"first").unwrap();
        assert!(matches!(open_locked(&path, true), Err(OutputError::Busy(_))));
        // Who has it puts it elsewhere: what comes next is another file.
        fs::rename(&path, folder.path().join("a")).unwrap();
        let second = open_locked(&path, true).unwrap();
        assert!(is_at(&second, &path).unwrap() && !is_at(&first, &path).unwrap());
        drop(second);
        fs::write(&path, "left").unwrap();
        open_locked(&path, false).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"left");
    }

    #[test]
    fn what_is_pending_is_nowhere_until_it_is_persisted() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let [one, two] = [0, 1].map(|_| Pending::beside(&path).unwrap());
        one.file().write_all(b"one").unwrap();
        two.file().write_all(b"two").unwrap();
        assert!(!path.exists());
        drop(two);
        one.persist(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error() {
        assert!(matches!(write(Path::new("/dev/full"), b"x"), Err(OutputError::Io(..))));
    }
}
