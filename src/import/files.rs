//! Reading configurations: bounded in bytes and in number, whatever they include.

use super::ImportError;
use crate::files::read::{read, Named};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Where configurations are read from.
pub trait Files {
    /// The text of a file of at most `most` bytes.
    ///
    /// # Errors
    /// The reason why there is none.
    fn read(&self, path: &Path, most: u64) -> Result<String, String>;

    /// The names in a folder, sorted; none of what is no folder.
    fn names(&self, folder: &Path) -> Vec<String>;

    /// Whether there is a file of that path.
    fn exists(&self, path: &Path) -> bool;
}

/// The file system. Only regular files are opened.
#[derive(Clone, Copy, Debug)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path, most: u64) -> Result<String, String> {
        let bytes =
            read(path, most).map_err(|error| format!("{error}; accepted: a configuration file"))?;
        if bytes.len() as u64 > most {
            return Err("more than 1 MiB, with what it includes".to_owned());
        }
        String::from_utf8(bytes).map_err(|_| "it is not UTF-8".to_owned())
    }

    fn names(&self, folder: &Path) -> Vec<String> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut names: Vec<String> =
            entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
        names.sort();
        names
    }

    fn exists(&self, path: &Path) -> bool {
        path.exists()
    }
}

/// Texts by path, as if they were files.
impl Files for BTreeMap<PathBuf, String> {
    fn read(&self, path: &Path, most: u64) -> Result<String, String> {
        let text = self.get(path).ok_or("there is no such file")?;
        if text.len() as u64 > most {
            return Err("more than 1 MiB, with what it includes".to_owned());
        }
        Ok(text.clone())
    }

    fn names(&self, folder: &Path) -> Vec<String> {
        let inside = |path: &PathBuf| {
            let first = path.strip_prefix(folder).ok()?.components().next()?;
            Some(first.as_os_str().to_str()?.to_owned())
        };
        let mut names: Vec<String> = self.keys().filter_map(inside).collect();
        names.dedup();
        names
    }

    fn exists(&self, path: &Path) -> bool {
        self.contains_key(path)
    }
}

/// One import's reading: what was read, and how much more may be.
pub(super) struct Reading<'a> {
    files: &'a dyn Files,
    folder: PathBuf,
    left: u64,
    /// The files that were read, in order.
    pub read: Vec<PathBuf>,
}

/// Most bytes that are read, all files together.
const MOST_BYTES: u64 = 1 << 20;
/// What a file counts for at least: includes of little files stay few.
const LEAST_BYTES: u64 = 64;

impl<'a> Reading<'a> {
    /// Of the configuration whose first file is `first`.
    pub fn new(files: &'a dyn Files, first: &Path) -> Self {
        let folder = first.parent().unwrap_or(Path::new("")).to_owned();
        Reading { files, folder, left: MOST_BYTES, read: Vec::new() }
    }

    /// A path as it is named: relative to the folder of the first file, if it is below it.
    pub fn shown(&self, path: &Path) -> String {
        path.strip_prefix(&self.folder).unwrap_or(path).shown().to_string()
    }

    /// The text of a file, with `\r\n` as `\n`.
    pub fn text(&mut self, path: &Path) -> Result<String, ImportError> {
        let unreadable = |reason| ImportError::Unreadable { file: self.shown(path), reason };
        let text = self.files.read(path, self.left).map_err(unreadable)?;
        self.spend(path, LEAST_BYTES.max(text.len() as u64))?;
        self.read.push(path.to_owned());
        Ok(text.replace("\r\n", "\n"))
    }

    fn spend(&mut self, path: &Path, bytes: u64) -> Result<(), ImportError> {
        let left = self.left.checked_sub(bytes);
        self.left = left.ok_or_else(|| ImportError::Unreadable {
            file: self.shown(path),
            reason: "more than 1 MiB, or too many files, with what it includes".to_owned(),
        })?;
        Ok(())
    }

    /// Whether there is such a file.
    pub fn exists(&self, path: &Path) -> bool {
        self.files.exists(path)
    }

    /// The files that match `pattern` in its last or an earlier component, sorted; `*`, `?` and
    /// `[...]` are as in a shell, and match no leading dot.
    pub fn matching(&mut self, pattern: &Path) -> Result<Vec<PathBuf>, ImportError> {
        let mut found = vec![PathBuf::new()];
        for component in pattern.components() {
            let text = component.as_os_str().to_string_lossy();
            if !is_pattern(&text) {
                found.iter_mut().for_each(|path| path.push(component));
                continue;
            }
            let glob: Vec<char> = text.chars().collect();
            let mut below = Vec::new();
            for path in found {
                for name in self.files.names(&path) {
                    self.spend(pattern, 1)?;
                    let chars: Vec<char> = name.chars().collect();
                    if (text.starts_with('.') || !name.starts_with('.')) && matches(&glob, &chars) {
                        below.push(path.join(name));
                    }
                }
                self.spend(pattern, LEAST_BYTES)?;
            }
            found = below;
        }
        found.retain(|path| self.files.exists(path));
        found.sort();
        Ok(found)
    }
}

/// Whether `text` has a character that a shell expands.
pub(super) fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?', '['])
}

/// Whether a shell's pattern matches a name: a table over both, so that no pattern takes long.
fn matches(glob: &[char], name: &[char]) -> bool {
    let mut reached = vec![false; name.len() + 1];
    reached[0] = true;
    let mut at = 0;
    while at < glob.len() {
        let (class, next) = match glob[at] {
            '[' => class(glob, at).unwrap_or((Vec::new(), at)),
            _ => (Vec::new(), at),
        };
        let mut now = vec![false; name.len() + 1];
        for end in 0..=name.len() {
            now[end] = match glob[at] {
                '*' => reached[end] || (end > 0 && now[end - 1]),
                _ if end == 0 => false,
                '?' => reached[end - 1],
                '[' if next > at => reached[end - 1] && in_class(&class, name[end - 1]),
                c => reached[end - 1] && c == name[end - 1],
            };
        }
        (reached, at) = (now, next + 1);
    }
    reached[name.len()]
}

/// What is between the brackets that open at `at`, and where they close.
fn class(glob: &[char], at: usize) -> Option<(Vec<char>, usize)> {
    let first = at + 1 + usize::from(glob.get(at + 1) == Some(&'!'));
    let end = (first + 1..glob.len()).find(|&end| glob[end] == ']')?;
    Some((glob[at + 1..end].to_vec(), end))
}

fn in_class(class: &[char], c: char) -> bool {
    let (not, class) = match class.split_first() {
        Some(('!', rest)) => (true, rest),
        _ => (false, class),
    };
    let (mut at, mut found) = (0, false);
    while at < class.len() {
        if at + 2 < class.len() && class[at + 1] == '-' {
            found |= (class[at]..=class[at + 2]).contains(&c);
            at += 3;
        } else {
            found |= class[at] == c;
            at += 1;
        }
    }
    found != not
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn patterns_match_as_in_a_shell() {
        for (glob, name, expected) in [
            ("*.cfg", "a.cfg", true),
            ("*.cfg", "a.cfg~", false),
            ("a?c", "abc", true),
            ("a?c", "ac", false),
            ("[ab]*", "b", true),
            ("[!ab]*", "b", false),
            ("[a-c]x", "bx", true),
            ("[a-c]x", "dx", false),
            ("[a", "[a", true),
            ("**a**", "xxaxx", true),
            ("", "", true),
        ] {
            let chars = |text: &str| text.chars().collect::<Vec<_>>();
            assert_eq!(matches(&chars(glob), &chars(name)), expected, "{glob} {name}");
        }
    }
}
