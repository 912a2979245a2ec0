//! The order of the modules.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The files of a module, without its tests.
fn source(at: &Path) -> String {
    if at.is_dir() {
        let mut all: Vec<_> = fs::read_dir(at).unwrap().map(|file| file.unwrap().path()).collect();
        all.retain(|file| file.file_stem().unwrap() != "tests");
        return all.iter().map(|file| source(file)).collect();
    }
    let text = fs::read_to_string(at).unwrap_or_default();
    let lines = text.lines().take_while(|line| !line.starts_with("#[cfg("));
    lines
        .filter(|line| !line.trim_start().starts_with("//"))
        .map(|line| format!("{line}\n"))
        .collect()
}

/// The modules that a text names, one by one or in braces.
fn used(text: &str) -> BTreeSet<&str> {
    let is_end = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split("crate::")
        .skip(1)
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(group) => group.split('}').next().unwrap().split(", ").collect(),
            None => vec![rest],
        })
        .filter_map(|rest| rest.split(is_end).next())
        .collect()
}

#[test]
fn each_module_uses_those_above_it_in_the_table_alone() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let lib = fs::read_to_string(src.join("lib.rs")).unwrap();
    let rows = lib.lines().filter(|line| line.starts_with("//! | "));
    let table: Vec<&str> = rows.filter_map(|row| row.split('`').nth(1)).collect();
    let declared = lib.lines().filter_map(|line| line.split_once("mod ")?.1.strip_suffix(';'));
    let declared: BTreeSet<&str> = declared.filter(|name| *name != "prover").collect();
    assert_eq!(table.iter().copied().collect::<BTreeSet<_>>(), declared);
    for (at, module) in table.iter().enumerate() {
        let text =
            [format!("{module}.rs"), (*module).to_owned()].map(|file| source(&src.join(file)));
        let text = text.concat();
        assert!(!text.is_empty(), "{module}");
        let below = table[at + 1..].iter().filter(|other| used(&text).contains(**other));
        assert_eq!(below.collect::<Vec<_>>(), Vec::<&&str>::new(), "{module}");
    }
}
