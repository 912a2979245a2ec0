//! Lists the sources of this crate, by whose digest reports name the checker.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=src");
    let folder = |name| env::var_os(name).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let root = folder("CARGO_MANIFEST_DIR")?.join("src");
    let mut files = Vec::new();
    gather(&root, "", &mut files)?;
    files.sort();
    let entry = |path: &String| format!("({path:?}, include_bytes!({:?})),\n", root.join(path));
    let list: String = files.iter().map(entry).collect();
    fs::write(folder("OUT_DIR")?.join("sources.rs"), format!("&[{list}]"))
}

/// The files below a folder, by their paths from `src` on.
fn gather(folder: &Path, prefix: &str, files: &mut Vec<String>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            gather(&entry.path(), &format!("{name}/"), files)?;
        } else {
            files.push(name);
        }
    }
    Ok(())
}
