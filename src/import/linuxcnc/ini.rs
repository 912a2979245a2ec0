//! INI files, read as LinuxCNC reads them: src/emc/ini/inifile.cc.

use crate::import::files::Reading;
use crate::import::{ImportError, Setting};
use std::path::Path;

/// What an INI file says, in order, by `[SECTION]TAG`. Of equal tags the first counts, where the
/// firmware does not ask for all.
#[derive(Default)]
pub(super) struct Ini {
    settings: Vec<Setting>,
    section: Option<String>,
}

const DEPTH: usize = 16;

impl Ini {
    /// Of a file, and of those that it includes.
    pub fn read(reading: &mut Reading<'_>, path: &Path) -> Result<Ini, ImportError> {
        let mut ini = Ini::default();
        ini.include(reading, path, DEPTH)?;
        Ok(ini)
    }

    /// The first setting of a key.
    pub fn find(&self, key: &str) -> Option<&Setting> {
        self.settings.iter().find(|setting| setting.key == key)
    }

    /// All settings of a key, in order.
    pub fn all<'a>(&'a self, key: &'a str) -> impl Iterator<Item = &'a Setting> {
        self.settings.iter().filter(move |setting| setting.key == key)
    }

    /// All settings, in order.
    pub fn settings(&self) -> &[Setting] {
        &self.settings
    }

    fn include(
        &mut self,
        reading: &mut Reading<'_>,
        path: &Path,
        depth: usize,
    ) -> Result<(), ImportError> {
        let file = reading.shown(path);
        let refused = |line, expected| ImportError::Syntax { file: file.clone(), line, expected };
        let text = reading.text(path)?;
        let mut line = String::new();
        for (number, part) in text.lines().enumerate() {
            let number = number + 1;
            let part = part.trim_end();
            if let Some(part) = part.strip_suffix('\\') {
                line.push_str(part);
                continue;
            }
            line.push_str(part);
            let whole = std::mem::take(&mut line);
            if let Some(named) = whole.strip_prefix("#INCLUDE") {
                let blank = named.starts_with([' ', '\t']) && !named.trim().is_empty();
                if !blank || depth == 0 {
                    return Err(refused(number, "#INCLUDE FILE, at most 16 deep"));
                }
                let included = path.parent().unwrap_or(Path::new("")).join(named.trim());
                self.include(reading, &included, depth - 1)?;
                continue;
            }
            self.line(&file, number, whole.trim())
                .ok_or_else(|| refused(number, "[SECTION], TAG = VALUE or a comment"))?;
        }
        match line.is_empty() {
            true => Ok(()),
            false => Err(refused(text.lines().count(), "a line after \\")),
        }
    }

    /// Reads one line, no include; `None` if the firmware refuses it.
    fn line(&mut self, file: &str, line: usize, text: &str) -> Option<()> {
        if text.is_empty() || text.starts_with(['#', ';']) {
            return Some(());
        }
        if let Some(rest) = text.strip_prefix('[') {
            let (section, _) = rest.split_once(']')?;
            self.section = Some(section.trim().to_owned()).filter(|name| is_name(name));
            return self.section.as_ref().map(|_| ());
        }
        let (tag, value) = text.split_once('=')?;
        let section = self.section.as_ref()?;
        let tag = Some(tag.trim_end()).filter(|tag| is_name(tag))?;
        self.settings.push(Setting {
            file: file.to_owned(),
            line,
            key: format!("[{section}]{tag}"),
            value: value.trim().to_owned(),
        });
        Some(())
    }
}

fn is_name(text: &str) -> bool {
    !text.starts_with(|c: char| c.is_ascii_digit())
        && !text.is_empty()
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
