//! `printer.cfg`, read as Klipper reads it: klippy/configfile.py on top of Python's configparser.

use crate::import::files::{is_pattern, Reading};
use crate::import::settings::Settings;
use crate::import::{ImportError, Setting};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A line with its number.
type Line = (usize, String);

const SAVE_CONFIG: &str = "
#*# <---------------------- SAVE_CONFIG ---------------------->
#*# DO NOT EDIT THIS BLOCK OR BELOW. The contents are auto-generated.
#*#
";
const LINE: &str = "a section, a setting or a comment, settings inside a section";

/// What a configuration sets, its included files and its SAVE_CONFIG block (of which only what is
/// set nowhere else counts) among it.
pub(super) fn read(reading: &mut Reading<'_>, path: &Path) -> Result<Settings, ImportError> {
    let file = reading.shown(path);
    // Python's text mode: a carriage return ends a line.
    let text = reading.text(path)?.replace('\r', "\n");
    let mut settings = Settings::new(file.clone());
    let (body, saved) = split(&text);
    let mut inside = BTreeSet::new();
    with_includes(reading, &mut settings, path, &body, &mut inside)?;
    match saved {
        Some(saved) => {
            let saved = without_duplicates(saved, &settings);
            section_by_section(&mut settings, &file, &saved)?;
        }
        None if text.contains("\n#*#") => settings.note(
            "The SAVE_CONFIG block: it is not as the firmware writes it, and the firmware skips \
             such a block.",
        ),
        None => {}
    }
    Ok(settings)
}

/// The configuration without its SAVE_CONFIG block, and the block without its prefixes; all is body
/// where the firmware finds the block corrupted (`_find_autosave_data`).
fn split(text: &str) -> (Vec<Line>, Option<Vec<Line>>) {
    let number = |text: &str, first: usize| -> Vec<Line> {
        text.split('\n').enumerate().map(|(i, line)| (first + i, line.to_owned())).collect()
    };
    let whole = || (number(text, 1), None);
    let Some(at) = text.find(SAVE_CONFIG) else { return whole() };
    let (body, rest) = (&text[..at], &text[at + SAVE_CONFIG.len()..]);
    let block = rest.trim_start();
    let first = 1 + text[..text.len() - block.len()].matches('\n').count();
    let block = block.trim_end();
    if body.contains("\n#*# ") || block.contains(SAVE_CONFIG) {
        return whole();
    }
    let mut lines = number(block, first);
    for (_, line) in &mut lines {
        let stripped = line.strip_prefix("#*#");
        *line = match stripped.map(|rest| rest.strip_prefix(' ').unwrap_or(rest)) {
            Some(rest) if line.len() == 3 || line.starts_with("#*# ") => rest.to_owned(),
            _ if block.is_empty() => String::new(),
            _ => return whole(),
        };
    }
    (number(body, 1), Some(lines))
}

/// The lines of a SAVE_CONFIG block but those of settings that the body has (`_strip_duplicates`).
fn without_duplicates(block: Vec<Line>, body: &Settings) -> Vec<Line> {
    let (mut section, mut duplicate) = (String::new(), false);
    let mut kept = Vec::new();
    for (number, line) in block {
        let pruned = line.split(['#', ';']).next().unwrap_or_default().trim_end();
        if pruned.starts_with(char::is_whitespace) {
            if !duplicate {
                kept.push((number, line));
            }
            continue;
        }
        if let Some(header) = pruned.strip_prefix('[') {
            let mut header = header.to_owned();
            header.pop();
            section = header.trim().to_owned();
            duplicate = false;
        } else if !pruned.is_empty() {
            let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let field = &pruned[..pruned.find(|c| !word(c)).unwrap_or(pruned.len())];
            duplicate = body.peek(&key(&section, field)).is_some();
        }
        if !duplicate {
            kept.push((number, line));
        }
    }
    kept
}

/// A body and what it includes, in order (`_parse_config`). `inside` are the files being read.
fn with_includes(
    reading: &mut Reading<'_>,
    settings: &mut Settings,
    path: &Path,
    lines: &[Line],
    inside: &mut BTreeSet<PathBuf>,
) -> Result<(), ImportError> {
    let file = reading.shown(path);
    let normal = normalised(path);
    if !inside.insert(normal.clone()) {
        let reason = "includes itself; the firmware refuses that".to_owned();
        return Err(ImportError::Refused { file, reason });
    }
    let mut buffer = Vec::new();
    for (number, line) in lines {
        let line = line.split('#').next().unwrap_or_default();
        let included = header(line).and_then(|header| header.strip_prefix("include "));
        let Some(included) = included else {
            buffer.push((*number, line.to_owned()));
            continue;
        };
        section_by_section(settings, &file, &std::mem::take(&mut buffer))?;
        let pattern = path.parent().unwrap_or(Path::new("")).join(included.trim());
        let found = match is_pattern(&pattern.to_string_lossy()) {
            true => reading.matching(&pattern)?,
            false => vec![pattern],
        };
        for included in found {
            let text = reading.text(&included)?.replace('\r', "\n");
            let lines: Vec<Line> =
                text.split('\n').enumerate().map(|(i, line)| (i + 1, line.to_owned())).collect();
            with_includes(reading, settings, &included, &lines, inside)?;
        }
    }
    section_by_section(settings, &file, &buffer)?;
    inside.remove(&normal);
    Ok(())
}

/// A path without `.` and `..`, so that a file is known again.
fn normalised(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for component in path.components() {
        match component {
            std::path::Component::CurDir => {}
            std::path::Component::ParentDir if normal.file_name().is_some() => {
                normal.pop();
            }
            other => normal.push(other),
        }
    }
    normal
}

/// The name of a section header.
fn header(line: &str) -> Option<&str> {
    let rest = line.strip_prefix('[')?;
    rest.rfind(']').map(|end| &rest[..end]).filter(|header| !header.is_empty())
}

/// The key of a setting; options are told apart without case, sections with it.
pub(super) fn key(section: &str, option: &str) -> String {
    format!("[{section}] {}", option.to_lowercase())
}

/// Lines as configparser reads them: a line that is indented more than its setting continues it.
fn section_by_section(
    settings: &mut Settings,
    file: &str,
    lines: &[Line],
) -> Result<(), ImportError> {
    let mut section: Option<String> = None;
    let mut open: Option<Setting> = None;
    let mut indent = 0;
    for (number, whole) in lines {
        let line = without_comment(whole.split('#').next().unwrap_or_default());
        let text = line.trim();
        if text.is_empty() {
            continue;
        }
        let refused = ImportError::Syntax { file: file.to_owned(), line: *number, expected: LINE };
        let depth = line.chars().take_while(|c| c.is_whitespace()).count();
        if let Some(setting) = open.as_mut().filter(|_| depth > indent) {
            setting.value.push('\n');
            setting.value.push_str(text);
            continue;
        }
        indent = depth;
        open.take().into_iter().for_each(|setting| settings.set(setting));
        if let Some(header) = header(text) {
            // An include counts at the start of a line only.
            if header.starts_with("include ") {
                return Err(refused);
            }
            section = Some(header.to_owned());
            continue;
        }
        let (Some(section), Some(at)) = (&section, text.find(['=', ':'])) else {
            return Err(refused);
        };
        let (option, value) = (text[..at].trim_end(), text[at + 1..].trim());
        if option.is_empty() {
            return Err(refused);
        }
        let (file, key) = (file.to_owned(), key(section, option));
        open = Some(Setting { file, line: *number, key, value: value.to_owned() });
    }
    open.into_iter().for_each(|setting| settings.set(setting));
    Ok(())
}

/// `line` up to a `;` at its start or after white space.
fn without_comment(line: &str) -> &str {
    let starts = |at: usize| at == 0 || line[..at].ends_with(char::is_whitespace);
    let end = line.match_indices(';').map(|(at, _)| at).find(|&at| starts(at));
    end.map_or(line, |end| &line[..end])
}
