//! Smoothieware's configuration file: lines of a key and a value, `FileConfigSource.cpp` and
//! `ConfigSource.cpp`; and its override file, G-code.

use crate::import::files::Reading;
use crate::import::gcode::{lines, Command, Content};
use crate::import::settings::Settings;
use crate::import::toml::Number;
use crate::import::{ImportError, Setting};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The firmware reads so many bytes of a line.
const LINE: usize = 130;
const MOST_INCLUDES: usize = 8;
const OVERRIDE: &str = "config-override";

/// A command of the override file.
pub(super) struct Overridden {
    command: Command,
    file: String,
    line: usize,
}

/// Reads the configuration into `settings`; the commands of the override file are returned, for
/// what they set depends on the kinematics.
pub(super) fn read(
    reading: &mut Reading<'_>,
    settings: &mut Settings,
    paths: &[PathBuf],
) -> Result<Vec<Overridden>, ImportError> {
    let [first, others @ ..] = paths else { return Ok(Vec::new()) };
    let is_override = |path: &&PathBuf| {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        name.to_ascii_lowercase().starts_with(OVERRIDE)
    };
    transfer(reading, settings, first, others, 0)?;
    let beside = first.with_file_name(OVERRIDE);
    let saved = match others.iter().find(is_override) {
        Some(path) => Some(path.clone()),
        None => reading.exists(&beside).then_some(beside),
    };
    let mut overridden = Vec::new();
    if let Some(path) = saved {
        let file = reading.shown(&path);
        for line in lines(&reading.text(&path)?) {
            let Content::Commands(commands) = line.content else { continue };
            // The firmware's letters are capitals (src/modules/communication/GcodeDispatch.cpp).
            let capital = |command: &Command| command.text.starts_with(char::is_uppercase);
            for command in commands.into_iter().filter(capital) {
                overridden.push(Overridden { command, file: file.clone(), line: line.number });
            }
        }
    }
    if let Some(path) = others.iter().find(|path| !reading.read.contains(path)) {
        let reason = format!(
            "{} is not included, so that the firmware does not read it; accepted: files that are, \
             and config-override",
            reading.shown(path)
        );
        return Err(ImportError::Refused { file: reading.shown(first), reason });
    }
    Ok(overridden)
}

fn transfer(
    reading: &mut Reading<'_>,
    settings: &mut Settings,
    path: &Path,
    others: &[PathBuf],
    depth: usize,
) -> Result<(), ImportError> {
    let file = reading.shown(path);
    let text = reading.text(path)?;
    for (at, line) in text.lines().enumerate() {
        let end = line.char_indices().map(|(at, c)| at + c.len_utf8());
        let read = &line[..end.take_while(|&end| end <= LINE).last().unwrap_or(0)];
        let Some((key, value)) = setting(read) else { continue };
        let whole = read.len() == line.len() || !read.ends_with(value);
        let found = Setting {
            file: file.clone(),
            line: at + 1,
            key: key.to_owned(),
            value: value.to_owned(),
        };
        if key == "include" {
            let name = Path::new(value).file_name();
            let given = others.iter().find(|other| name.is_some() && other.file_name() == name);
            let beside = path.with_file_name(value.trim_start_matches('/'));
            let included = match given {
                Some(given) => Some(given.clone()),
                None => reading.exists(&beside).then_some(beside),
            };
            match included {
                Some(included) if depth < MOST_INCLUDES => {
                    transfer(reading, settings, &included, others, depth + 1)?;
                }
                _ => settings.not_understood(found),
            }
        } else if matters(key) {
            match whole {
                true => settings.set(found),
                false => settings.not_understood(found),
            }
        }
    }
    Ok(())
}

/// The key and the value of a line, if it has both.
fn setting(line: &str) -> Option<(&str, &str)> {
    let line = line.trim_start_matches([' ', '\t']);
    if line.starts_with('#') {
        return None;
    }
    let (key, rest) = line.split_once([' ', '\t'])?;
    let rest = rest.trim_start_matches([' ', '\t']);
    let first = rest.chars().next().filter(|c| *c != '#')?;
    let end = rest[first.len_utf8()..].find(['\r', '\n', '#', ' ', '\t']);
    let value = &rest[..end.map_or(rest.len(), |end| end + first.len_utf8())];
    (!value.trim().is_empty()).then_some((key, value))
}

/// What the firmware takes for true.
pub(super) fn is_true(value: &str) -> bool {
    value.contains(['t', 'y', '1'])
}

/// What concerns the fourth motor, `delta`, and how fast and where a Delta homes.
const HARMLESS: [&str; 22] = [
    "delta_acceleration",
    "delta_current",
    "delta_dir_pin",
    "delta_en_pin",
    "delta_fast_homing_rate_mm_s",
    "delta_halt_on_error",
    "delta_homing",
    "delta_homing_direction",
    "delta_homing_retract_mm",
    "delta_limit_enable",
    "delta_max_endstop",
    "delta_max_rate",
    "delta_max_travel",
    "delta_microsteps",
    "delta_min_endstop",
    "delta_ms_pins",
    "delta_segments_per_second",
    "delta_slow_homing_rate_mm_s",
    "delta_step_pin",
    "delta_steps_per_mm",
    "soft_endstop.halt",
    "endstops_enable",
];

/// Whether a key is among those that say what machine it is, or might.
fn matters(key: &str) -> bool {
    let homing = ["_max", "_min", "_homing_direction", "_trim_mm", "_trim"];
    let tower = ["alpha", "beta", "gamma"].iter().find_map(|axis| key.strip_prefix(axis));
    key.starts_with("arm_")
        || ["arm1_trim", "arm2_trim", "arm3_trim"].contains(&key)
        || key.starts_with("delta_")
        || key.starts_with("soft_endstop.")
        || key == "endstops_enable"
        || tower.is_some_and(|rest| homing.contains(&rest))
}

/// Whether a setting that was not read cannot change the machine: only where it homes, or how fast
/// it moves. Trims of an older name are of no effect in the firmware, and refused unless they are 0.
pub(super) fn is_harmless(setting: &Setting) -> bool {
    let key = setting.key.as_str();
    let old_trim = key.ends_with("_trim");
    let homing = ["_max", "_min", "_homing_direction", "_trim_mm"];
    let homes = ["alpha", "beta", "gamma"]
        .iter()
        .find_map(|axis| key.strip_prefix(axis))
        .is_some_and(|rest| homing.contains(&rest));
    HARMLESS.contains(&key) || homes || (old_trim && is_zero(setting))
}

fn is_zero(setting: &Setting) -> bool {
    Number::parse(&setting.value).is_some_and(|number| number.value.sign() == Some(0))
}

const LINEAR: [(char, &str); 13] = [
    ('L', "arm_length"),
    ('R', "arm_radius"),
    ('A', "delta_tower1_offset"),
    ('B', "delta_tower2_offset"),
    ('C', "delta_tower3_offset"),
    ('D', "delta_tower1_angle"),
    ('E', "delta_tower2_angle"),
    ('F', "delta_tower3_angle"),
    ('H', "delta_tower3_angle"),
    ('I', "arm1_trim"),
    ('J', "arm2_trim"),
    ('K', "arm3_trim"),
    ('Z', "gamma_max"),
];

const ROTARY: [(char, &str); 7] = [
    ('A', "delta_e"),
    ('B', "delta_f"),
    ('C', "delta_re"),
    ('D', "delta_rf"),
    ('E', "delta_z_offset"),
    ('H', "delta_tool_offset"),
    ('I', "delta_ee_offs"),
];

const TRIMS: [(char, &str); 3] =
    [('X', "alpha_trim_mm"), ('Y', "beta_trim_mm"), ('Z', "gamma_trim_mm")];

/// What `M665`, `M666` and `M206` set of a linear Delta.
pub(super) fn override_linear(settings: &mut Settings, overridden: &[Overridden]) {
    for saved in overridden {
        match saved.command.name.as_str() {
            "M665" => {
                saved.apply(settings, &LINEAR);
                saved.refuse_mixture(settings);
            }
            "M666" => saved.apply(settings, &TRIMS),
            "M206" => saved.apply(settings, &[('Z', "M206 Z"), ('X', "M206 X"), ('Y', "M206 Y")]),
            _ => {}
        }
    }
    for key in ["M206 X", "M206 Y", "M206 Z"] {
        if settings.peek(key).is_some_and(is_zero) {
            settings.unset(key);
        }
    }
}

/// What `M665` sets of a rotary Delta; `M206` and `M666` set angles at which it homes.
pub(super) fn override_rotary(settings: &mut Settings, overridden: &[Overridden]) {
    for saved in overridden.iter().filter(|saved| saved.command.name == "M665") {
        saved.apply(settings, &ROTARY);
    }
}

impl Overridden {
    fn apply(&self, settings: &mut Settings, keys: &[(char, &str)]) {
        // The firmware walks its arguments by letter (src/modules/communication/utils/Gcode.cpp).
        let words: BTreeMap<char, &str> = self.command.words().collect();
        for (letter, value) in words {
            let key = keys.iter().find(|(known, _)| *known == letter).map(|(_, key)| *key);
            let named = format!("{} {letter}", self.command.name);
            let (file, line, value) = (self.file.clone(), self.line, value.to_owned());
            match key {
                Some(key) => settings.set(Setting { file, line, key: key.to_owned(), value }),
                // Segments; debugging.
                None if "SUW".contains(letter) => {}
                None => settings.not_understood(Setting { file, line, key: named, value }),
            }
        }
    }

    /// Corrections of which `M665` names some: what becomes of the others depends on the firmware's revision
    /// (`LinearDeltaSolution::set_optional` has set most of them to 0).
    fn refuse_mixture(&self, settings: &mut Settings) {
        let letters: Vec<char> = self.command.words().map(|(letter, _)| letter).collect();
        let named = LINEAR.into_iter().filter(|(letter, _)| letters.contains(letter));
        let named: Vec<&str> = named.map(|(_, key)| key).collect();
        let is_correction = |key: &str| key.starts_with("delta_tower") || key.ends_with("_trim");
        if !named.iter().any(|key| is_correction(key)) {
            return;
        }
        let others =
            LINEAR.into_iter().filter(|(_, key)| is_correction(key) && !named.contains(key));
        for (letter, key) in others {
            if settings.peek(key).is_some_and(|setting| !is_zero(setting)) {
                let (file, line) = (self.file.clone(), self.line);
                let value = format!("no {letter}, where {key} is set");
                settings.not_understood(Setting { file, line, key: "M665".to_owned(), value });
            }
        }
    }
}
