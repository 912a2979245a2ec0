//! What a configuration script does, command by command, as far as it concerns geometry.

use crate::import::files::Reading;
use crate::import::gcode::{lines, Command, Content};
use crate::import::settings::Settings;
use crate::import::toml::Number;
use crate::import::{ImportError, Setting};
use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What the machine is so far.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kinematics {
    /// `M665`, `M669 K3`.
    Linear,
    /// `M669 K10`.
    Rotary,
}

/// Commands that change geometry or limits, or call what may.
const MATTER: [&str; 12] =
    ["M98", "M99", "M208", "M501", "M502", "M505", "M556", "M564", "M579", "M665", "M666", "M669"];
const MATTERS_TOO: &str = "M667";

/// A run of `config.g`.
pub(super) struct Script<'r, 'f> {
    reading: &'r mut Reading<'f>,
    settings: &'r mut Settings,
    others: Vec<PathBuf>,
    called: BTreeSet<PathBuf>,
    kinematics: Option<Kinematics>,
    /// What `M669 K` chose that is neither.
    other: String,
}

const MOST_CALLS: usize = 8;

impl<'r, 'f> Script<'r, 'f> {
    /// Of the files `paths`, of which the first is run.
    pub fn new(
        reading: &'r mut Reading<'f>,
        settings: &'r mut Settings,
        paths: &[PathBuf],
    ) -> Self {
        Script {
            reading,
            settings,
            others: paths.iter().skip(1).cloned().collect(),
            called: BTreeSet::new(),
            kinematics: None,
            other: "M669 K0, the firmware's default".to_owned(),
        }
    }

    /// The kinematics at the end.
    pub fn finished(self, first: &Path) -> Result<Kinematics, ImportError> {
        if let Some(path) = self.others.iter().find(|path| !self.called.contains(*path)) {
            let reason = format!(
                "{} is not called (M98, M501), so that the firmware does not read it; accepted: \
                 files that are",
                self.reading.shown(path)
            );
            return Err(ImportError::Refused { file: self.reading.shown(first), reason });
        }
        self.kinematics.ok_or(ImportError::OtherMachine {
            file: self.reading.shown(first),
            found: self.other,
            expected: "a linear Delta (M665 with L, or M669 K3), a rotary Delta (M669 K10)",
        })
    }

    /// Runs a file; `depth` others have called it.
    pub fn run(&mut self, path: &Path, depth: usize) -> Result<(), ImportError> {
        let file = self.reading.shown(path);
        let text = self.reading.text(path)?;
        let mut blocks: Vec<usize> = Vec::new();
        for line in lines(&text) {
            while blocks.last().is_some_and(|&indent| indent >= line.indent) {
                blocks.pop();
            }
            let at = |key: String, value: &str| Setting {
                file: file.clone(),
                line: line.number,
                key,
                value: value.to_owned(),
            };
            let inside = if blocks.is_empty() { "" } else { " in a block" };
            match &line.content {
                Content::Word(word, text) => match word.as_str() {
                    "if" | "elif" | "else" | "while" => blocks.push(line.indent),
                    "abort" => {
                        self.settings.not_understood(at(format!("abort{inside}"), text));
                    }
                    _ => {}
                },
                Content::Commands(commands) => {
                    for command in commands.iter().filter(|command| matters(command)) {
                        let Command { name, text, .. } = command;
                        if !inside.is_empty() || text.contains(['\'', '*', '(']) {
                            self.settings.not_understood(at(format!("{name}{inside}"), text));
                            continue;
                        }
                        let at = |key: &str, value: &str| at(key.to_owned(), value);
                        self.command(command, path, depth, &at)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn command(
        &mut self,
        command: &Command,
        path: &Path,
        depth: usize,
        at: &dyn Fn(&str, &str) -> Setting,
    ) -> Result<(), ImportError> {
        match command.name.as_str() {
            "M98" | "M501" => return self.call(command, path, depth, at),
            "M665" => {
                let chosen = command.word('L').is_some() || command.word('D').is_some();
                if chosen {
                    self.choose(Some(Kinematics::Linear));
                }
                match self.kinematics {
                    Some(Kinematics::Linear) => self.keep(command, at, "M665"),
                    _ => self.settings.not_understood(at("M665", &command.text)),
                }
            }
            "M669" => {
                if let Some(kind) = command.word('K') {
                    self.other = format!("M669 K{kind}");
                    self.choose(match kind {
                        "3" => Some(Kinematics::Linear),
                        "10" => Some(Kinematics::Rotary),
                        _ => None,
                    });
                }
                self.keep(command, at, "M669");
            }
            "M666" if self.kinematics.is_some() => self.keep(command, at, "M666"),
            "M208" => self.limits(command, at)?,
            "M579" => self.unless(command, at, "1"),
            "M556" => self.unless(command, at, "0"),
            "M564" => {
                if command.word('S').is_some_and(|value| value != "1") {
                    self.settings.set(at("M564 S", &command.text));
                } else if command.word('S').is_some() {
                    self.settings.unset("M564 S");
                }
            }
            name => self.settings.not_understood(at(name, &command.text)),
        }
        Ok(())
    }

    /// Other kinematics begin with their defaults.
    fn choose(&mut self, kinematics: Option<Kinematics>) {
        if self.kinematics != kinematics {
            for code in ["M665", "M666", "M669"] {
                for letter in 'A'..='Z' {
                    self.settings.unset(&format!("{code} {letter}"));
                }
            }
        }
        self.kinematics = kinematics;
    }

    fn keep(&mut self, command: &Command, at: &dyn Fn(&str, &str) -> Setting, code: &str) {
        for (letter, value) in command.words() {
            self.settings.set(at(&format!("{code} {letter}"), value));
        }
    }

    /// Axes whose value is not `neutral` matter.
    fn unless(&mut self, command: &Command, at: &dyn Fn(&str, &str) -> Setting, neutral: &str) {
        let neutral = Number::parse(neutral);
        for (letter, value) in command.words().filter(|(letter, _)| "XYZ".contains(*letter)) {
            let key = format!("{} {letter}", command.name);
            let same = Number::parse(value)
                .zip(neutral.as_ref())
                .and_then(|(a, b)| a.value.compare(&b.value));
            match same {
                Some(Ordering::Equal) => self.settings.unset(&key),
                _ => self.settings.set(at(&key, value)),
            }
        }
    }

    /// `M208`: of the axes, only z has limits that Deltas are held to.
    fn limits(
        &mut self,
        command: &Command,
        at: &dyn Fn(&str, &str) -> Setting,
    ) -> Result<(), ImportError> {
        let Some(value) = command.word('Z') else { return Ok(()) };
        let lower = match command.word('S') {
            Some("1") => true,
            Some("0") | None => false,
            Some(_) => {
                self.settings.not_understood(at("M208 S", &command.text));
                return Ok(());
            }
        };
        match value.split_once(':') {
            Some((low, high)) => {
                self.settings.set(at("M208 Z min", low.trim()));
                self.settings.set(at("M208 Z max", high.trim()));
            }
            None if lower => self.settings.set(at("M208 Z min", value)),
            None => self.settings.set(at("M208 Z max", value)),
        }
        Ok(())
    }

    /// `M98 P"file"` and `M501`, which calls `config-override.g`.
    fn call(
        &mut self,
        command: &Command,
        path: &Path,
        depth: usize,
        at: &dyn Fn(&str, &str) -> Setting,
    ) -> Result<(), ImportError> {
        let named = match command.name.as_str() {
            "M501" => "config-override.g",
            _ => command.word('P').unwrap_or_default(),
        };
        let named = named.split(" R").next().unwrap_or(named).trim().trim_matches('"');
        let name = named.rsplit(['/', ':']).next().unwrap_or(named);
        let same = |path: &&PathBuf| {
            path.file_name().is_some_and(|found| found.eq_ignore_ascii_case(name))
        };
        let beside = path.with_file_name(name);
        let folder = named.strip_prefix("0:").unwrap_or(named);
        let is_beside = folder == name || folder.strip_prefix("/sys/") == Some(name);
        let found = match self.others.iter().find(same) {
            Some(given) => Some(given.clone()),
            None => {
                (!name.is_empty() && is_beside && self.reading.exists(&beside)).then_some(beside)
            }
        };
        match found {
            Some(found) if depth < MOST_CALLS => {
                self.called.insert(found.clone());
                self.run(&found, depth + 1)
            }
            _ => {
                let value =
                    format!("{named}, which is not given or beside {}", self.reading.shown(path));
                self.settings.not_understood(at(&command.name, &value));
                Ok(())
            }
        }
    }
}

fn matters(command: &Command) -> bool {
    MATTER.contains(&command.name.as_str()) || command.name == MATTERS_TOO
}
