//! LinuxCNC: `lineardeltakins` and `rotarydeltakins`, from an INI file, HAL files, or both, after the
//! project's public manual pages.
//!
//! `lineardeltakins` has its joints at `(0, R)` and 120 degrees clockwise of it, rods of length `L`,
//! and the carriage above the platform. `rotarydeltakins` has its hips at the height 0 and the
//! distance `platformradius`, thighs whose angles count upwards from the horizontal, and feet at
//! the distance `footradius` from the controlled point. Pins are set by `setp` in HAL.

use super::toml::{axis, design, polar, quoted, Number};
use super::{ImportError, Imported};
use std::collections::BTreeMap;

/// What the files set.
#[derive(Default)]
struct Settings {
    /// Of INI files, by section and key.
    ini: BTreeMap<(String, String), String>,
    /// Pins, by name.
    pins: BTreeMap<String, String>,
    /// Kinematics modules that are loaded.
    modules: Vec<String>,
    /// HAL files that an INI file names.
    hal_files: Vec<String>,
}

struct Files<'a> {
    name: &'a str,
    settings: Settings,
    notes: Vec<String>,
}

/// The design that LinuxCNC files describe: the texts of an INI file, of HAL files, or of both, in
/// any order; `name` is for messages and comments.
///
/// # Errors
/// If they do not load `lineardeltakins` or `rotarydeltakins`, or a dimension is no number.
pub fn linuxcnc(texts: &[&str], name: &str) -> Result<Imported, ImportError> {
    let mut settings = Settings::default();
    for text in texts {
        settings.read(text);
    }
    let module = settings.module();
    let mut files = Files { name, settings, notes: Vec::new() };
    files.note(
        "The requirements: a configuration has no bounds on transmission factors; change those \
         below.",
    );
    files.note(
        "Tolerances: every number is taken as exact; write \"269.0 ± 0.05\" where one is known.",
    );
    match module.as_deref() {
        Some("lineardeltakins") => files.linear_delta(),
        Some("rotarydeltakins") => files.rotary_delta(),
        other => Err(ImportError::OtherMachine {
            file: name.to_owned(),
            found: other.unwrap_or("none").to_owned(),
            expected: "lineardeltakins, rotarydeltakins",
        }),
    }
}

impl Settings {
    /// INI and HAL files have few forms of lines in common; each is recognised by itself.
    fn read(&mut self, text: &str) {
        let mut section = String::new();
        let joined = text.replace("\\\r\n", " ").replace("\\\n", " ");
        for line in joined.lines() {
            let line = line.split('#').next().unwrap_or_default();
            let line = line.split(';').next().unwrap_or_default().trim();
            if let Some(header) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
                section = header.trim().to_uppercase();
                continue;
            }
            let mut command = line;
            if let Some((key, value)) = line.split_once('=').filter(|(key, _)| is_key(key)) {
                let (key, value) = (key.trim().to_uppercase(), value.trim());
                if key == "HALFILE" {
                    self.hal_files.push(value.to_owned());
                }
                if key == "HALCMD" {
                    command = value;
                } else {
                    self.ini.insert((section.clone(), key), value.to_owned());
                    continue;
                }
            }
            let words: Vec<&str> = command.split_whitespace().collect();
            match words[..] {
                ["setp", pin, value, ..] => {
                    self.pins.insert(pin.to_owned(), value.to_owned());
                }
                ["loadrt", module, ..] if module.ends_with("kins") => {
                    self.modules.push(module.to_owned());
                }
                _ => {}
            }
        }
    }

    /// The kinematics module: as `[KINS] KINEMATICS`, `loadrt`, or the pins that are set, say.
    fn module(&self) -> Option<String> {
        let named = self.ini.get(&("KINS".to_owned(), "KINEMATICS".to_owned()));
        let named = named.and_then(|text| text.split_whitespace().next()).map(str::to_owned);
        let loaded = || self.modules.last().cloned();
        let of_pin = |pin: &String| Some(pin.split_once('.')?.0.to_owned());
        let known = |module: &String| module.ends_with("deltakins");
        named.or_else(loaded).or_else(|| self.pins.keys().filter_map(of_pin).find(known))
    }

    /// A value, which may be that of an INI setting: `[SECTION]KEY` or `[SECTION](KEY)`.
    fn resolved(&self, value: &str) -> Option<String> {
        let Some((section, key)) = value.strip_prefix('[').and_then(|rest| rest.split_once(']'))
        else {
            return Some(value.to_owned());
        };
        let key = key.trim_matches(['(', ')']).to_uppercase();
        self.ini.get(&(section.to_uppercase(), key)).cloned()
    }
}

fn is_key(text: &str) -> bool {
    let text = text.trim();
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

impl Files<'_> {
    fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }

    fn bad(&self, setting: &str, found: &str, expected: &'static str) -> ImportError {
        ImportError::BadValue {
            file: self.name.to_owned(),
            setting: setting.to_owned(),
            found: found.to_owned(),
            expected,
        }
    }

    /// A pin's value; where it is not set, the module's documented default.
    fn pin(&mut self, pin: &str, default: &str) -> Result<Number, ImportError> {
        const EXPECTED: &str = "a decimal number greater than 0";
        let text = match self.settings.pins.get(pin) {
            Some(value) => match self.settings.resolved(value) {
                Some(text) => text,
                None => {
                    return Err(ImportError::Missing {
                        file: self.name.to_owned(),
                        setting: format!("{value}, the value of {pin}"),
                    });
                }
            },
            None if !self.settings.hal_files.is_empty() && self.settings.pins.is_empty() => {
                return Err(ImportError::Missing {
                    file: self.name.to_owned(),
                    setting: format!(
                        "{pin} (import the HAL files too: {})",
                        self.settings.hal_files.join(", ")
                    ),
                });
            }
            None => {
                self.note(format!("{pin} is not set: {default} is LinuxCNC's default."));
                default.to_owned()
            }
        };
        let number = Number::parse(&text).filter(Number::is_positive);
        number.ok_or_else(|| self.bad(pin, &text, EXPECTED))
    }

    /// `MIN_LIMIT` and `MAX_LIMIT` of a section.
    fn limits(&self, section: &str) -> Result<Option<[Number; 2]>, ImportError> {
        let limit = |key: &str| {
            let Some(text) = self.settings.ini.get(&(section.to_owned(), key.to_owned())) else {
                return Ok(None);
            };
            let number = Number::parse(text);
            let setting = format!("[{section}] {key}");
            number.map(Some).ok_or_else(|| self.bad(&setting, text, "a decimal number"))
        };
        Ok(limit("MIN_LIMIT")?.zip(limit("MAX_LIMIT")?).map(|(min, max)| [min, max]))
    }

    /// The box of the axes' limits, if all are given.
    fn workspace(&mut self, otherwise: String) -> Result<String, ImportError> {
        let axes = [self.limits("AXIS_X")?, self.limits("AXIS_Y")?, self.limits("AXIS_Z")?];
        let [Some([x0, x1]), Some([y0, y1]), Some([z0, z1])] = axes else {
            self.note(
                "The workspace: MIN_LIMIT and MAX_LIMIT of AXIS_X, AXIS_Y and AXIS_Z are not all \
                 given; the cylinder below is a guess to be changed.",
            );
            return Ok(otherwise);
        };
        self.note(
            "The workspace is the box of the axes' limits, all of which a Delta need not reach.",
        );
        let corner =
            |x: &Number, y: &Number, z: &Number| format!("[{}, {}, {}]", x.text, y.text, z.text);
        Ok(format!("min = {}\nmax = {}\n", corner(&x0, &y0, &z0), corner(&x1, &y1, &z1)))
    }

    /// The joints' limits, if all are given.
    fn joint_range(&mut self) -> Result<String, ImportError> {
        let joints = [self.limits("JOINT_0")?, self.limits("JOINT_1")?, self.limits("JOINT_2")?];
        let [Some(a), Some(b), Some(c)] = joints else {
            self.note("The joints' limits: MIN_LIMIT and MAX_LIMIT of JOINT_0 to JOINT_2 are not all given.");
            return Ok(String::new());
        };
        let range =
            |[min, max]: &[Number; 2]| format!("  {{ min = {}, max = {} }},\n", min.text, max.text);
        Ok(format!("joint_range = [\n{}{}{}]\n", range(&a), range(&b), range(&c)))
    }

    fn linear_delta(mut self) -> Result<Imported, ImportError> {
        let radius = self.pin("lineardeltakins.R", "130.25")?;
        let length = self.pin("lineardeltakins.L", "269.0")?;
        let mut legs: [String; 3] = Default::default();
        for (i, leg) in legs.iter_mut().enumerate() {
            let degrees = ["90", "-30", "210"][i];
            let [x, y] = self.coordinates(degrees, Some(&radius))?;
            *leg = format!(
                "[[mechanism.legs]]                 # joint {i}\ndrive = \"slider\"\n\
                 direction = [0, 0, 1]\nanchor = [{x}, {y}, 0]\nlength = {}\nmode = \"-\"\n",
                length.text
            );
        }
        let guess = format!("{}/2", radius.text);
        let otherwise =
            format!("cylinder = {{ center = [0, 0], radius = {}, z = [0, 0] }}\n", quoted(&guess));
        let workspace = self.workspace(otherwise)?;
        let requirements =
            format!("transmission = {{ min = \"1/4\", max = 4 }}\n{}", self.joint_range()?);
        Ok(self.imported("Linear Delta", &legs, &workspace, &requirements))
    }

    fn rotary_delta(mut self) -> Result<Imported, ImportError> {
        let hip = self.pin("rotarydeltakins.platformradius", "10.0")?;
        let thigh = self.pin("rotarydeltakins.thighlength", "10.0")?;
        let shin = self.pin("rotarydeltakins.shinlength", "14.0")?;
        let foot = self.pin("rotarydeltakins.footradius", "6.0")?;
        let mut legs: [String; 3] = Default::default();
        for (i, leg) in legs.iter_mut().enumerate() {
            let degrees = ["90", "210", "-30"][i];
            let [x, y] = self.coordinates(degrees, Some(&hip))?;
            let [d_x, d_y] = self.coordinates(degrees, Some(&foot))?;
            let [e_x, e_y] = self.coordinates(degrees, None)?;
            let [k_x, k_y] = Number::parse(degrees)
                .and_then(|degrees| axis(&degrees))
                .ok_or_else(|| self.bad("angle", degrees, "degrees"))?;
            *leg = format!(
                "[[mechanism.legs]]                 # joint {i}\ndrive = \"arm\"\n\
                 anchor = [{x}, {y}, 0]\naxis = [{k_x}, {k_y}, 0]\nreference = [{e_x}, {e_y}, 0]\n\
                 arm = {}\nlength = {}\nplatform = [{d_x}, {d_y}, 0]\nmode = \"-\"\n",
                thigh.text, shin.text
            );
        }
        let (radius, z) = (format!("{}/4", thigh.text), format!("-{}", shin.text));
        let otherwise = format!(
            "cylinder = {{ center = [0, 0], radius = {}, z = [{z}, {z}] }}\n",
            quoted(&radius)
        );
        let workspace = self.workspace(otherwise)?;
        let requirements = format!(
            "transmission = {{ min = \"{0}/4\", max = \"{0}*4\" }} # length per radian\n{1}",
            thigh.text,
            self.joint_range()?
        );
        Ok(self.imported("Rotary Delta", &legs, &workspace, &requirements))
    }

    fn coordinates(
        &self,
        degrees: &str,
        radius: Option<&Number>,
    ) -> Result<[String; 2], ImportError> {
        let found = Number::parse(degrees).and_then(|degrees| polar(&degrees, radius));
        found.ok_or_else(|| self.bad("angle", degrees, "degrees"))
    }

    fn imported(
        self,
        machine: &str,
        legs: &[String; 3],
        workspace: &str,
        requirements: &str,
    ) -> Imported {
        let design = design(self.name, machine, legs, workspace, requirements, &self.notes);
        Imported { design, not_carried_over: self.notes }
    }
}
