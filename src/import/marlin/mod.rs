//! Marlin: `Configuration.h`, and `Configuration_adv.h` if it is given, of Marlin 2.
//!
//! The towers are those of `recalc_delta_settings` (src/module/delta.cpp): at 210, 330 and 90
//! degrees and their trims, at `DELTA_RADIUS` and its trims; the rods have `DELTA_DIAGONAL_ROD` and
//! its trims. The volume is that to which `apply_motion_limits` and `position_is_reachable`
//! (src/module/motion.cpp) hold a move: a cylinder up to `DELTA_HEIGHT`, less the probe's offset.
//! Marlin stops no carriage at its endstop; the height above which one gets there is told.

mod condition;
mod macros;
mod source;
mod value;

use super::files::{Files, Reading};
use super::settings::Settings;
use super::toml::{cylinder, Machine, Number, FACTORS};
use super::towers::{about, difference, legs, lesser, sum, written, Tower, TOWERS};
use super::{ImportError, Imported, Setting};
use macros::{Body, Doubt, Macro, Macros, Place, Problem, Truth};
use num_traits::Signed;
use source::Token;
use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// The firmware's files with the defaults, and with what is enforced.
const DEFAULTS: &str = "Marlin/src/inc/Conditionals_post.h";

/// Settings of Deltas that concern calibration, homing and speed.
const HARMLESS: [&str; 13] = [
    "DELTA_AUTO_CALIBRATION",
    "DELTA_CALIBRATION_DEFAULT_POINTS",
    "DELTA_CALIBRATION_MENU",
    "DELTA_CALIBRATION_RADIUS",
    "DELTA_CARRIAGE_OFFSET",
    "DELTA_EFFECTOR_OFFSET",
    "DELTA_FAST_SQRT",
    "DELTA_FEEDRATE_SCALING",
    "DELTA_HOME_TO_SAFE_ZONE",
    "DELTA_PROBEABLE_RADIUS",
    "DELTA_SEGMENTS_PER_SECOND",
    "DELTA_SMOOTH_ROD_OFFSET",
    "DELTA_SEGMENTS_PER_SECOND_DEFAULT",
];

/// Other kinematics, of which Marlin accepts one.
const OTHERS: [&str; 14] = [
    "AXEL_TPARA",
    "COREXY",
    "COREXZ",
    "COREYX",
    "COREYZ",
    "COREZX",
    "COREZY",
    "FOAMCUTTER_XYUV",
    "MARKFORGED_XY",
    "MARKFORGED_YX",
    "MORGAN_SCARA",
    "MP_SCARA",
    "POLAR",
    "POLARGRAPH",
];

/// What makes `HAS_BED_PROBE`.
const PROBES: [&str; 18] = [
    "BD_SENSOR",
    "BIQU_MICROPROBE_V1",
    "BIQU_MICROPROBE_V2",
    "BLTOUCH",
    "DUET_SMART_EFFECTOR",
    "FIX_MOUNTED_PROBE",
    "MAGLEV4",
    "MAG_MOUNTED_PROBE",
    "NOZZLE_AS_PROBE",
    "RACK_AND_PINION_PROBE",
    "SENSORLESS_PROBING",
    "SOLENOID_PROBE",
    "TOUCH_MI_PROBE",
    "Z_PROBE_ALLEN_KEY",
    "Z_PROBE_SLED",
    "Z_SERVO_PROBE",
    "HAS_Z_SERVO_PROBE",
    "HAS_BED_PROBE",
];

/// The design that Marlin's `Configuration.h` describes; further headers follow it.
///
/// # Errors
/// If a file cannot be read; if the headers enable no `DELTA`, lack a dimension, or have one that is
/// no number; if one depends on macros that they do not define; if they set what is not understood
/// and not in `ignore`.
pub fn marlin(
    files: &dyn Files,
    paths: &[PathBuf],
    ignore: &[String],
) -> Result<Imported, ImportError> {
    let expected = "Configuration.h, and headers that follow it";
    let first = paths.first().ok_or(ImportError::Files { found: 0, expected })?;
    let mut reading = Reading::new(files, first);
    let mut macros = Macros::default();
    for path in paths {
        let file = reading.shown(path);
        // A carriage return ends a line for the compiler.
        let text = reading.text(path)?.replace('\r', "\n");
        let expected = "directives of the C preprocessor, every #if with its #endif";
        macros.read(&text, &file).map_err(|line| ImportError::Syntax { file, line, expected })?;
    }
    let file = reading.shown(first);
    let mut header = Header { settings: Settings::new(file.clone()), macros: &macros, file };
    header.preliminaries()?;
    let towers = header.towers()?;
    let machine = header.machine(&towers)?;
    header.leftovers()?;
    let harmless = |setting: &Setting| HARMLESS.contains(&setting.key.as_str());
    header.settings.finish(&machine, harmless, ignore, reading)
}

/// What the headers define, and what became of it.
struct Header<'a> {
    settings: Settings,
    macros: &'a Macros,
    file: String,
}

impl Header<'_> {
    fn refused(&self, reason: String) -> ImportError {
        ImportError::Refused { file: self.file.clone(), reason }
    }

    fn depends(&self, key: &str, doubt: &Doubt) -> ImportError {
        self.refused(format!(
            "{key} depends on {} ({}:{}), which is not known here; accepted: a header that defines \
             it, given as well, or a configuration without the conditional",
            doubt.name, doubt.file, doubt.line
        ))
    }

    /// Whether an option is switched on.
    fn option(&self, key: &str) -> Result<bool, ImportError> {
        if self.macros.get(key).is_none() {
            return Ok(false);
        }
        match self.macros.enabled(key, Place { file: &self.file, line: 0 }) {
            Truth::Unknown(doubt) => Err(self.depends(key, &doubt)),
            truth => Ok(truth == Truth::Yes),
        }
    }

    /// A macro as a setting.
    fn setting(&self, key: &str, found: &Macro) -> Setting {
        let (file, line) = (found.file.clone(), found.line);
        Setting { file, line, key: key.to_owned(), value: found.text.clone() }
    }

    /// Kinematics, version, and what a compiler would say.
    fn preliminaries(&mut self) -> Result<(), ImportError> {
        if !self.option("DELTA")? {
            return Err(ImportError::OtherMachine {
                file: self.file.clone(),
                found: "DELTA is not enabled".to_owned(),
                expected: "#define DELTA",
            });
        }
        for other in OTHERS {
            if self.option(other)? {
                return Err(self.refused(format!("both DELTA and {other} are enabled")));
            }
        }
        self.record("DELTA", "a linear Delta");
        for (file, line, text) in &self.macros.errors {
            self.settings.note(format!(
                "{file}:{line}: #error {text}: the compiler stops there; the design is of the rest."
            ));
        }
        for (file, line, header) in &self.macros.included {
            let known = ["boards.h", "macros.h", "thermistornames.h"];
            let (file, key) = (file.clone(), "#include".to_owned());
            let path = header.trim_matches(['"', '<', '>']);
            if !known.contains(&path.rsplit('/').next().unwrap_or_default()) {
                let value = header.clone();
                self.settings.not_understood(Setting { file, line: *line, key, value });
            }
        }
        if let Some(found) = self.macros.get("CONFIGURATION_H_VERSION") {
            let setting = self.setting("CONFIGURATION_H_VERSION", found);
            match setting.value.starts_with("02") {
                true => {
                    self.settings.set(setting);
                    self.settings.text("CONFIGURATION_H_VERSION", "Marlin 2");
                }
                false => self.settings.not_understood(setting),
            }
        }
        Ok(())
    }

    /// Records that a setting became part of the design.
    fn record(&mut self, key: &str, became: &str) {
        if let Some(found) = self.macros.get(key) {
            self.settings.set(self.setting(key, found));
            self.settings.text(key, became);
        }
    }

    /// A setting's tokens with all macros replaced; none if it is not defined.
    fn tokens(&mut self, key: &str) -> Result<Option<Vec<Token>>, ImportError> {
        let Some(found) = self.macros.get(key) else { return Ok(None) };
        let expanded = match &found.body {
            Body::Tokens(tokens) => self.macros.expand(tokens),
            Body::Depends(doubt) => Err(Problem::Depends(doubt.clone())),
            Body::Function => return Err(self.bad(key)),
        };
        match expanded {
            Ok(tokens) => Ok(Some(tokens)),
            Err(Problem::Depends(doubt)) => Err(self.depends(key, &doubt)),
            Err(Problem::TooLong) => {
                Err(self.refused(format!("{key}: its macros expand to more than is read")))
            }
        }
    }

    fn bad(&self, key: &str) -> ImportError {
        let Some(found) = self.macros.get(key) else { return self.settings.missing(key) };
        let Setting { file, line, key: setting, value: found } = self.setting(key, found);
        ImportError::BadValue { file, line, setting, found, expected: value::EXPECTED.to_owned() }
    }

    /// Records a setting and all that it is made of.
    fn record_all(&mut self, key: &str, became: &str) {
        self.record(key, became);
        let mut seen: BTreeSet<&str> = BTreeSet::new();
        let mut open = vec![key];
        while let Some(name) = open.pop() {
            let Some(Macro { body: Body::Tokens(tokens), .. }) = self.macros.get(name) else {
                continue;
            };
            for token in tokens {
                match token {
                    Token::Name(name) if self.macros.get(name).is_some() && seen.insert(name) => {
                        open.push(name);
                    }
                    _ => {}
                }
            }
        }
        for name in seen {
            self.record(name, &format!("part of {key}"));
        }
    }

    /// A number, if it is defined.
    fn number(&mut self, key: &str, became: &str) -> Result<Option<Number>, ImportError> {
        let Some(tokens) = self.tokens(key)? else { return Ok(None) };
        let number = value::number(&tokens).ok_or_else(|| self.bad(key))?;
        self.record_all(key, &format!("{became}, {}", number.text));
        Ok(Some(number))
    }

    fn required(&mut self, key: &str, became: &str) -> Result<Number, ImportError> {
        self.number(key, became)?.ok_or_else(|| self.settings.lacks(key, became))
    }

    /// Three numbers; zeros if they are not defined.
    fn three(&mut self, key: &str, became: &str) -> Result<Vec<Number>, ImportError> {
        let tokens = match self.tokens(key)? {
            Some(tokens) => tokens,
            None => source::tokens(&self.settings.defaulted(key, "{ 0, 0, 0 }", DEFAULTS)),
        };
        let numbers = value::numbers(&tokens, 3).ok_or_else(|| self.bad(key))?;
        self.record_all(key, became);
        Ok(numbers)
    }

    fn towers(&mut self) -> Result<Vec<Tower>, ImportError> {
        let radius = self.required("DELTA_RADIUS", "the towers' distance from the centre")?;
        let rod = self.required("DELTA_DIAGONAL_ROD", "the rods' length")?;
        let radii = self.three("DELTA_RADIUS_TRIM_TOWER", "added to the towers' distances")?;
        let rods = self.three("DELTA_DIAGONAL_ROD_TRIM_TOWER", "added to the rods' lengths")?;
        let angles = self.three("DELTA_TOWER_ANGLE_TRIM", "added to the towers' angles")?;
        let mut towers = Vec::new();
        for (i, (label, degrees)) in TOWERS.into_iter().enumerate() {
            let degrees = Number::parse(degrees).and_then(|base| sum(&base, &angles[i]));
            towers.push(Tower {
                label,
                degrees: degrees.ok_or_else(|| self.bad("DELTA_TOWER_ANGLE_TRIM"))?,
                radius: sum(&radius, &radii[i]).ok_or_else(|| self.bad("DELTA_RADIUS"))?,
                rod: sum(&rod, &rods[i]).ok_or_else(|| self.bad("DELTA_DIAGONAL_ROD"))?,
            });
        }
        Ok(towers)
    }

    /// The radius to which moves are held.
    fn radius(&mut self, limited: bool) -> Result<Number, ImportError> {
        let [new, old] = ["PRINTABLE_RADIUS", "DELTA_PRINTABLE_RADIUS"];
        let became = "the radius that position_is_reachable accepts, but for 0.0001";
        let printable = match (self.number(new, became)?, self.number(old, became)?) {
            (Some(a), Some(b)) if a.value.compare(&b.value) != Some(Ordering::Equal) => {
                return Err(self.refused(format!("{new} and {old} differ")));
            }
            (Some(radius), _) | (None, Some(radius)) => radius,
            (None, None) => return Err(self.settings.missing(new)),
        };
        // What motion.h calls fslop.
        let slack = Number::parse("0.0001").ok_or_else(|| self.bad(new))?;
        let mut radius = sum(&printable, &slack).ok_or_else(|| self.bad(new))?;
        if let Some(greatest) =
            self.number("DELTA_MAX_RADIUS", "the radius, if it is the lesser")?
        {
            if greatest.value.compare(&printable.value) == Some(Ordering::Less) {
                radius = greatest;
            }
        }
        if limited {
            let mut limit = |key: &str| self.required(key, "a software endstop");
            let [x, y] = [limit("X_MIN_POS")?, limit("Y_MIN_POS")?];
            let [right, back] = [limit("X_MAX_POS")?, limit("Y_MAX_POS")?];
            let greater = if lesser(x.clone(), y.clone()) == x { y } else { x };
            let magnitude = greater.value.as_rational().and_then(|value| written(&value.abs()));
            let left = magnitude.ok_or_else(|| self.bad("X_MIN_POS"))?;
            radius = [left, right, back].into_iter().fold(radius, lesser);
        }
        match radius.is_positive() {
            true => Ok(radius),
            false => Err(self.refused("the software endstops leave no radius above 0".to_owned())),
        }
    }

    /// Heights from the bed to where moves are held.
    fn heights(&mut self, limited: bool) -> Result<[Number; 2], ImportError> {
        let mut height = None;
        for key in ["DELTA_HEIGHT", "MANUAL_Z_HOME_POS", "Z_MAX_POS"] {
            height = self.number(key, "the height of the platform at the endstops")?;
            if height.is_some() {
                break;
            }
        }
        let mut high = height.ok_or_else(|| self.settings.missing("DELTA_HEIGHT"))?;
        let mut probe = self.macros.get("Z_PROBE_SERVO_NR").is_some();
        for name in PROBES {
            probe |= self.option(name)?;
        }
        if probe {
            let key = "NOZZLE_TO_PROBE_OFFSET";
            let tokens = self.tokens(key)?.ok_or_else(|| self.settings.missing(key))?;
            let offset = value::numbers(&tokens, 3).ok_or_else(|| self.bad(key))?;
            self.record_all(key, "its third number is taken from the height");
            high = difference(&high, &offset[2]).ok_or_else(|| self.bad(key))?;
        }
        let low = self.required("Z_MIN_POS", "the least height")?;
        for (end, key) in [("Below", "MIN_SOFTWARE_ENDSTOP_Z"), ("Above", "MAX_SOFTWARE_ENDSTOP_Z")]
        {
            if !(limited && self.option(key)?) {
                self.settings.note(format!(
                    "{end} the workspace: {key} is not enabled, and Marlin stops no move there."
                ));
            }
        }
        let above = low.value.compare(&high.value) != Some(Ordering::Greater);
        above.then_some([low, high]).ok_or_else(|| self.bad("Z_MIN_POS"))
    }

    fn machine(&mut self, towers: &[Tower]) -> Result<Machine, ImportError> {
        let mut limited = false;
        for key in ["MIN_SOFTWARE_ENDSTOPS", "MAX_SOFTWARE_ENDSTOPS"] {
            if self.option(key)? {
                self.record(key, "moves are held to the software endstops");
                limited = true;
            }
        }
        let radius = self.radius(limited)?;
        let [low, high] = self.heights(limited)?;
        let adjusted =
            self.three("DELTA_ENDSTOP_ADJ", "in the height at which an endstop is met")?;
        let reach = "a radius less than the rods' length, an angle within a turn";
        let legs = legs(towers).ok_or_else(|| match self.bad("DELTA_RADIUS") {
            ImportError::BadValue { file, line, setting, found, .. } => {
                ImportError::BadValue { file, line, setting, found, expected: reach.to_owned() }
            }
            other => other,
        })?;
        let clear: Vec<f64> = towers
            .iter()
            .zip(&adjusted)
            .filter_map(|(tower, adjusted)| {
                let (rod, height, adjusted) = (&tower.rod.text, &high.text, &adjusted.text);
                about(&format!("{height}-({adjusted})+{}-{rod}", tower.centred()))?.parse().ok()
            })
            .collect();
        let clear = clear.into_iter().fold(f64::INFINITY, f64::min);
        self.settings.note(format!(
            "The carriages' endstops: Marlin does not stop a carriage there. Over a tower's foot one \
             is met about z = {clear:.3}; what is above may be out of the machine's reach."
        ));
        if self.option("EEPROM_SETTINGS")? || self.option("DELTA_AUTO_CALIBRATION")? {
            self.settings.note(
                "Values in the EEPROM: what M500 saved there, after G33 or by hand, overrides \
                 DELTA_HEIGHT, DELTA_RADIUS, DELTA_DIAGONAL_ROD, the trims and the probe's offset; \
                 M503 prints it.",
            );
        }
        Ok(Machine {
            title: "Linear Delta",
            kind: "translational",
            unit: Some("mm"),
            legs: legs.into(),
            workspace: cylinder(&radius.text, [&low.text, &high.text]),
            requirements: FACTORS.to_owned(),
        })
    }

    /// What is set and not read, and may matter.
    fn leftovers(&mut self) -> Result<(), ImportError> {
        for (key, found) in self.macros.iter() {
            let skew = key == "SKEW_CORRECTION" && self.option(key)?;
            if (skew || key.starts_with("DELTA_")) && self.settings.peek(key).is_none() {
                self.settings.set(self.setting(key, found));
            }
        }
        Ok(())
    }
}
