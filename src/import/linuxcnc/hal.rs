//! HAL files, read as halcmd reads them: src/hal/utils/halcmd.c, src/hal/hal_lib.c.
//!
//! Only pins of kinematics modules are followed, through `setp`, signals and links. What is linked
//! to such a pin and might drive it, and every command that might set one unseen, is kept as not
//! understood.

use super::ini::Ini;
use crate::import::files::Reading;
use crate::import::{ImportError, Setting};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The modules whose pins are followed.
pub(super) const MODULES: [&str; 5] =
    ["lineardeltakins", "rotarydeltakins", "tripodkins", "genhexkins", "pentakins"];
/// Components that only read the pins which draw a machine.
const READERS: [&str; 3] = ["lineardelta.", "rotarydelta.", "hexagui."];
/// Programs of LinuxCNC that set no pin of a kinematics module, nor run such as might.
const PROGRAMS: [&str; 33] = [
    "hexagui",
    "hexagui.py",
    "lineardelta",
    "lineardelta.py",
    "rotarydelta",
    "rotarydelta.py",
    "lcec_conf",
    "halsampler",
    "hal_manualtoolchange",
    "halui",
    "halmeter",
    "halscope",
    "halshow",
    "hal-histogram",
    "hal_input",
    "sim_pin",
    "sim-torch",
    "moveoff_gui",
    "monitor-xhc-hb04",
    "classicladder",
    "pyvcp",
    "gladevcp",
    "panelui",
    "shuttle",
    "sendkeys",
    "thermistor",
    "xhc-hb04",
    "xhc-whb04b-6",
    "gs2_vfd",
    "huanyang-vfd",
    "hy_vfd",
    "mb2hal",
    "wj200_vfd",
];
/// Commands that set no pin.
const IDLE: [&str; 22] = [
    "addf",
    "delf",
    "initf",
    "start",
    "stop",
    "lock",
    "unlock",
    "show",
    "list",
    "print",
    "status",
    "debug",
    "echo",
    "unecho",
    "save",
    "getp",
    "gets",
    "ptype",
    "stype",
    "help",
    "waitusr",
    "setexact_for_test_suite_only",
];

const COMMAND: &str = "a command of halcmd with as many words as it takes";

/// What a pin or signal holds.
#[derive(Clone)]
enum Value {
    /// The default of this pin.
    Default(String),
    /// What a line says.
    Set(Setting),
    /// What something else left there.
    Unknown,
}

#[derive(Default)]
struct Signal {
    linked: bool,
    value: Option<Value>,
    strangers: Vec<Setting>,
}

/// The state of HAL.
#[derive(Default)]
pub(super) struct Hal {
    /// Kinematics modules that are loaded, in order.
    pub modules: Vec<Setting>,
    /// Statements that may change the geometry.
    pub not_understood: Vec<Setting>,
    /// Whether a file was not read that may have linked pins to signals.
    pub unseen: bool,
    pins: BTreeMap<String, Value>,
    links: BTreeMap<String, (String, Setting)>,
    signals: BTreeMap<String, Signal>,
}

/// Where commands come from.
pub(super) struct Source<'a> {
    pub ini: &'a Ini,
    /// The folder in which LinuxCNC runs, that of its INI file.
    pub folder: PathBuf,
}

/// Pins of kinematics modules.
fn is_geometry(name: &str) -> bool {
    let module = name.split_once('.').map(|(module, _)| module);
    module.is_some_and(|module| MODULES.contains(&module))
}

impl Hal {
    /// What sets a pin, if anything does.
    ///
    /// # Errors
    /// The statement on which its value depends and that is not understood.
    pub fn pin(&self, pin: &str) -> Result<Option<Setting>, Setting> {
        let (value, link) = match self.links.get(pin) {
            None => (self.pins.get(pin).cloned(), None),
            Some((signal, link)) => {
                let signal = self.signals.get(signal);
                (signal.and_then(|signal| signal.value.clone()), Some(link))
            }
        };
        match (value, link) {
            (Some(Value::Set(setting)), _) => Ok(Some(Setting { key: pin.to_owned(), ..setting })),
            (None, None) => Ok(None),
            (Some(Value::Default(of)), _) if of == pin => Ok(None),
            (_, Some(link)) => Err(link.clone()),
            (_, None) => Ok(None),
        }
    }

    /// What is linked to a pin and may drive it.
    pub fn strangers(&self, pin: &str) -> Vec<Setting> {
        let signal = self.links.get(pin).and_then(|(signal, _)| self.signals.get(signal));
        signal.map(|signal| signal.strangers.clone()).unwrap_or_default()
    }

    /// Runs a HAL file, and what it sources, at most `depth` deep.
    pub fn file(
        &mut self,
        reading: &mut Reading<'_>,
        source: &Source<'_>,
        path: &Path,
        depth: usize,
    ) -> Result<(), ImportError> {
        let file = reading.shown(path);
        let text = reading.text(path)?;
        let refused = |line, expected| ImportError::Syntax { file: file.clone(), line, expected };
        let mut line = String::new();
        for (number, part) in text.lines().enumerate() {
            let number = number + 1;
            if let Some(part) = part.strip_suffix('\\') {
                // What `source` names is read without continued lines.
                if depth < DEPTH {
                    return Err(refused(number, "a line without \\ in a file that is sourced"));
                }
                line.push_str(part);
                continue;
            }
            line.push_str(part);
            let whole = std::mem::take(&mut line);
            let text = without_comment(&whole)
                .ok_or_else(|| refused(number, "quotes that are closed on their line"))?;
            let text = substituted(text, source.ini).map_err(|found| ImportError::BadValue {
                file: file.clone(),
                line: number,
                setting: "HAL".to_owned(),
                found,
                expected: "[SECTION]KEY of the INI file".to_owned(),
            })?;
            let words: Vec<&str> = text.split_whitespace().collect();
            if matches!(words[..], ["quit" | "exit", ..]) {
                break;
            }
            let setting = |key: &str, value: &str| Setting {
                file: file.clone(),
                line: number,
                key: key.to_owned(),
                value: value.to_owned(),
            };
            if let ["source", named] = words[..] {
                if depth == 0 {
                    return Err(refused(number, "files sourced at most 16 deep"));
                }
                self.file(reading, source, &source.folder.join(named), depth - 1)?;
                continue;
            }
            self.command(&words, setting).ok_or_else(|| refused(number, COMMAND))?;
        }
        Ok(())
    }

    /// Runs a command but `source`; `None` if halcmd refuses it.
    pub fn command(
        &mut self,
        words: &[&str],
        setting: impl Fn(&str, &str) -> Setting,
    ) -> Option<()> {
        let Some((command, arguments)) = words.split_first() else { return Some(()) };
        let arrows = ["<=", "=>", "<=>"];
        let named: Vec<&str> =
            arguments.iter().copied().filter(|word| !arrows.contains(word)).collect();
        let whole = || setting(command, &arguments.join(" "));
        match (*command, &named[..]) {
            (pin, ["=", value]) => self.setp(pin, setting(pin, value))?,
            ("setp", [pin, value]) => self.setp(pin, setting(pin, value))?,
            ("setp", _) => return None,
            ("newsig", [signal, _]) => {
                self.signals.entry((*signal).to_owned()).or_default();
            }
            ("sets", [signal, value]) => {
                let signal_now = self.signals.entry((*signal).to_owned()).or_default();
                signal_now.value = Some(Value::Set(setting(signal, value)));
            }
            ("net", [signal, pins @ ..]) if !pins.is_empty() => {
                self.signals.entry((*signal).to_owned()).or_default();
                for pin in pins {
                    self.link(pin, signal, setting(pin, &format!("net {signal}")))?;
                }
            }
            ("linkps", [pin, signal]) | ("linksp", [signal, pin]) => {
                self.link(pin, signal, setting(pin, &format!("{command} {signal}")))?;
            }
            ("loadrt", [module, ..]) => {
                if module.ends_with("kins") || MODULES.contains(module) {
                    self.modules.push(setting("loadrt", module));
                }
                // The modules take no other names for their pins.
                if MODULES.contains(module) && arguments.iter().any(|word| word.contains('=')) {
                    self.not_understood.push(setting("loadrt", &arguments.join(" ")));
                }
            }
            ("loadusr", _) => {
                let program = program(arguments);
                let touches = arguments.iter().any(|word| MODULES.iter().any(|m| word.contains(m)));
                if touches || !PROGRAMS.contains(&program) {
                    let key = format!("loadusr {program}");
                    self.not_understood.push(setting(&key, &arguments.join(" ")));
                }
            }
            (
                "unloadrt" | "unloadusr" | "unload" | "unlinkp" | "delsig" | "alias" | "unalias",
                _,
            ) => {
                let followed = |word: &&str| is_geometry(word) || self.signals.contains_key(*word);
                if named.iter().any(followed)
                    || command.starts_with("unload")
                        && named.iter().any(|word| MODULES.contains(word) || *word == "all")
                {
                    self.not_understood.push(whole());
                }
            }
            (command, _) if IDLE.contains(&command) => {}
            _ => return None,
        }
        Some(())
    }

    /// `setp`; the firmware refuses it of a linked pin.
    fn setp(&mut self, pin: &str, setting: Setting) -> Option<()> {
        if self.links.contains_key(pin) || is_no_pin(pin) {
            return None;
        }
        if is_geometry(pin) {
            self.pins.insert(pin.to_owned(), Value::Set(setting));
        }
        Some(())
    }

    /// `hal_link`: the first pin of a signal gives it its own value.
    fn link(&mut self, pin: &str, name: &str, setting: Setting) -> Option<()> {
        if is_no_pin(pin) {
            return None;
        }
        let signal = self.signals.entry(name.to_owned()).or_default();
        if let Some((linked, _)) = self.links.get(pin) {
            return (linked == name).then_some(());
        }
        let first = !std::mem::replace(&mut signal.linked, true);
        if is_geometry(pin) {
            let own = self.pins.get(pin).cloned().unwrap_or(Value::Default(pin.to_owned()));
            if first {
                signal.value = Some(if self.unseen { Value::Unknown } else { own });
            }
        } else if READERS.iter().any(|reader| pin.starts_with(reader)) {
            if first {
                signal.value = Some(Value::Unknown);
            }
        } else {
            if first {
                signal.value = Some(Value::Unknown);
            }
            signal.strangers.push(setting.clone());
        }
        self.links.insert(pin.to_owned(), (name.to_owned(), setting));
        Some(())
    }
}

/// The pins of the modules, as `hal_pin_new_real` names them.
const PINS: [&str; 9] = [
    "lineardeltakins.L",
    "lineardeltakins.R",
    "rotarydeltakins.platformradius",
    "rotarydeltakins.thighlength",
    "rotarydeltakins.shinlength",
    "rotarydeltakins.footradius",
    "tripodkins.Bx",
    "tripodkins.Cx",
    "tripodkins.Cy",
];

/// Whether a name is one of a kinematics module's without being a pin of it, or is quoted: the firmware
/// refuses it.
fn is_no_pin(name: &str) -> bool {
    name.contains(['\'', '"'])
        || (is_geometry(name)
            && !PINS.contains(&name)
            && !is_of_a_hexapod(name)
            && !is_of_a_pentapod(name))
}

/// Whether a pin is one of `genhexkins`.
fn is_of_a_hexapod(name: &str) -> bool {
    const OTHERS: [&str; 15] = [
        "spindle-offset",
        "tool-offset",
        "screw-lead",
        "convergence-criterion",
        "limit-iterations",
        "max-error",
        "last-iterations",
        "max-iterations",
        "fwd-kins-fail",
        "x",
        "y",
        "z",
        "a",
        "b",
        "c",
    ];
    let Some(name) = name.strip_prefix("genhexkins.") else { return false };
    let parts: Vec<&str> = name.split('.').collect();
    let strut = |n: &str| matches!(n, "0" | "1" | "2" | "3" | "4" | "5");
    match parts[..] {
        ["base" | "platform" | "base-n" | "platform-n", n, "x" | "y" | "z"] => strut(n),
        ["correction", n] => strut(n),
        _ => OTHERS.contains(&name),
    }
}

/// Whether a pin is one of `pentakins`.
fn is_of_a_pentapod(name: &str) -> bool {
    const OTHERS: [&str; 6] = [
        "tool-offset",
        "convergence-criterion",
        "limit-iterations",
        "max-error",
        "last-iterations",
        "max-iterations",
    ];
    let Some(name) = name.strip_prefix("pentakins.") else { return false };
    let parts: Vec<&str> = name.split('.').collect();
    match parts[..] {
        ["base", n, "x" | "y" | "z"] | ["effector", n, "r" | "z"] => {
            matches!(n, "0" | "1" | "2" | "3" | "4")
        }
        _ => OTHERS.contains(&name),
    }
}

/// Most levels of `source`.
pub(super) const DEPTH: usize = 16;

/// The program that `loadusr` runs, without its folders: the first word that is no option.
fn program<'a>(arguments: &[&'a str]) -> &'a str {
    let mut words = arguments.iter();
    while let Some(word) = words.next() {
        match *word {
            "-Wn" => {
                words.next();
            }
            word if word.starts_with('-') => {}
            word => return word.strip_prefix("./").unwrap_or(word),
        }
    }
    ""
}

/// Whether an application is among the programs that set no pin of a kinematics module.
pub(super) fn is_idle(application: &str) -> bool {
    let words: Vec<&str> = application.split_whitespace().collect();
    PROGRAMS.contains(&program(&words)) && !MODULES.iter().any(|m| application.contains(m))
}

/// `line` up to a `#` outside quotes; `None` if quotes stay open.
fn without_comment(line: &str) -> Option<&str> {
    let mut open = None;
    for (at, c) in line.char_indices() {
        match (open, c) {
            (None, '#') => return Some(&line[..at]),
            (None, '\'' | '"') => open = Some(c),
            (Some(quote), c) if c == quote => open = None,
            _ => {}
        }
    }
    open.is_none().then_some(line)
}

/// `line` with the values of `[SECTION]KEY` and `[SECTION](KEY)`.
///
/// # Errors
/// What has no value here: an environment's `$VARIABLE`, or a setting that is not in the file.
fn substituted(line: &str, ini: &Ini) -> Result<String, String> {
    let mut text = String::new();
    let mut rest = line;
    while let Some(at) = rest.find(['[', '$']) {
        text.push_str(&rest[..at]);
        let found = &rest[at..];
        let unknown = || found.split_whitespace().next().unwrap_or(found).to_owned();
        let (section, after) =
            found.strip_prefix('[').and_then(|rest| rest.split_once(']')).ok_or_else(unknown)?;
        let word = |c: char| c.is_ascii_alphanumeric() || ".-_".contains(c);
        let (name, after) = match after.strip_prefix('(') {
            Some(inside) => inside.split_once(')').ok_or_else(unknown)?,
            None => after.split_at(after.find(|c| !word(c)).unwrap_or(after.len())),
        };
        let setting = ini.find(&format!("[{section}]{name}")).ok_or_else(unknown)?;
        text.push_str(&setting.value);
        rest = after;
    }
    text.push_str(rest);
    Ok(text)
}
