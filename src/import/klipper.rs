//! Klipper: `printer.cfg` with `kinematics: delta` or `kinematics: rotary_delta`, after the
//! firmware's public configuration reference.
//!
//! Tower `i` of a linear Delta stands at `delta_radius (cos angle_i, sin angle_i)`; its carriage is
//! at the height `z + sqrt(arm_length^2 - distance^2)`, so that the leg points down from it. The
//! carriage's endstop is at `position_endstop + sqrt(arm_length^2 - delta_radius^2)`. Shoulder `i` of
//! a rotary Delta is at `shoulder_radius (cos angle_i, sin angle_i)` and the height
//! `shoulder_height`; angles of arms count upwards from the horizontal.

use super::toml::{axis, design, least, polar, quoted, Number};
use super::{ImportError, Imported};
use orthocert_checker::number::Exact;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// The settings of a configuration, by section and key.
struct Config<'a> {
    file: &'a str,
    settings: BTreeMap<(String, String), String>,
    includes: Vec<String>,
}

const STEPPERS: [&str; 3] = ["stepper_a", "stepper_b", "stepper_c"];
const POSITIVE: &str = "a decimal number greater than 0";

/// The design that a Klipper configuration describes; `name` is for messages and comments.
///
/// # Errors
/// If the text is no configuration, or not of a linear or rotary Delta, or a dimension is missing.
pub fn klipper(text: &str, name: &str) -> Result<Imported, ImportError> {
    let config = Config::parse(text, name)?;
    match config.text("printer", "kinematics")?.as_str() {
        "delta" => linear_delta(&config),
        "rotary_delta" => rotary_delta(&config),
        other => Err(ImportError::OtherMachine {
            file: name.to_owned(),
            found: other.to_owned(),
            expected: "delta, rotary_delta",
        }),
    }
}

impl<'a> Config<'a> {
    fn parse(text: &str, file: &'a str) -> Result<Self, ImportError> {
        let mut config = Config { file, settings: BTreeMap::new(), includes: Vec::new() };
        let mut section = String::new();
        for (number, line) in text.lines().enumerate() {
            // What calibration saved is kept in comments of this form, and overrides the rest.
            let line = line.strip_prefix("#*#").map_or(line, str::trim_start);
            let value_goes_on = line.starts_with([' ', '\t']);
            let line = without_comment(line).trim();
            if line.is_empty() || value_goes_on || line.starts_with("<---") {
                continue;
            }
            if let Some(header) = line.strip_prefix('[') {
                section = header.trim_end_matches(']').trim().to_owned();
                if let Some(included) = section.strip_prefix("include ") {
                    config.includes.push(included.trim().to_owned());
                }
                continue;
            }
            match line.find([':', '=']) {
                Some(at) => {
                    let key = line[..at].trim().to_lowercase();
                    let value = line[at + 1..].trim().to_owned();
                    config.settings.insert((section.clone(), key), value);
                }
                None if section.is_empty() || STEPPERS.contains(&section.as_str()) => {
                    return Err(ImportError::Syntax { file: file.to_owned(), line: number + 1 });
                }
                None => {}
            }
        }
        Ok(config)
    }

    fn find(&self, section: &str, key: &str) -> Option<&String> {
        self.settings.get(&(section.to_owned(), key.to_owned()))
    }

    fn text(&self, section: &str, key: &str) -> Result<String, ImportError> {
        self.find(section, key).cloned().ok_or_else(|| ImportError::Missing {
            file: self.file.to_owned(),
            setting: format!("[{section}] {key}"),
        })
    }

    fn bad(&self, section: &str, key: &str, expected: &'static str) -> ImportError {
        ImportError::BadValue {
            file: self.file.to_owned(),
            setting: format!("[{section}] {key}"),
            found: self.find(section, key).cloned().unwrap_or_default(),
            expected,
        }
    }

    fn number(&self, section: &str, key: &str) -> Result<Option<Number>, ImportError> {
        let Some(text) = self.find(section, key) else { return Ok(None) };
        let number = Number::parse(text);
        number.map(Some).ok_or_else(|| self.bad(section, key, "a decimal number"))
    }

    fn positive(&self, section: &str, key: &str) -> Result<Option<Number>, ImportError> {
        match self.number(section, key)? {
            Some(number) if !number.is_positive() => Err(self.bad(section, key, POSITIVE)),
            number => Ok(number),
        }
    }

    fn required(&self, section: &str, key: &str) -> Result<Number, ImportError> {
        self.text(section, key)?;
        self.positive(section, key)?.ok_or_else(|| self.bad(section, key, POSITIVE))
    }

    /// A length of each stepper; that of the first where another has none.
    fn of_steppers(&self, key: &str) -> Result<[Number; 3], ImportError> {
        let first = self.required(STEPPERS[0], key)?;
        let second = self.positive(STEPPERS[1], key)?.unwrap_or_else(|| first.clone());
        let third = self.positive(STEPPERS[2], key)?.unwrap_or_else(|| first.clone());
        Ok([first, second, third])
    }

    fn angles(&self, defaults: [&str; 3]) -> Result<[Number; 3], ImportError> {
        let angle = |i: usize| {
            let given = self.number(STEPPERS[i], "angle")?.or_else(|| Number::parse(defaults[i]));
            given.ok_or_else(|| self.bad(STEPPERS[i], "angle", "degrees"))
        };
        Ok([angle(0)?, angle(1)?, angle(2)?])
    }

    fn beyond_a_turn(&self, i: usize) -> ImportError {
        self.bad(STEPPERS[i], "angle", "degrees from -270 to 360")
    }

    /// `minimum_z_position`, 0 where it is not set.
    fn lowest(&self) -> Result<String, ImportError> {
        let number = self.number("printer", "minimum_z_position")?;
        Ok(number.map_or_else(|| "0".to_owned(), |number| number.text))
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = vec![
            "The requirements: a configuration has no bounds on transmission factors; change \
             those below."
                .to_owned(),
            "Tolerances: every number is taken as exact; write \"333.0 ± 0.05\" where one is known."
                .to_owned(),
        ];
        notes.extend(self.includes.iter().map(|file| {
            format!("The included file {file} was not read; what it sets is not here.")
        }));
        notes
    }
}

/// `line` up to its comment: `#` or `;` at its start or after a blank.
fn without_comment(line: &str) -> &str {
    let starts = |at: usize| at == 0 || line[..at].ends_with([' ', '\t']);
    let end = line.match_indices(['#', ';']).map(|(at, _)| at).find(|&at| starts(at));
    end.map_or(line, |end| &line[..end])
}

fn linear_delta(config: &Config<'_>) -> Result<Imported, ImportError> {
    let radius = config.required("printer", "delta_radius")?;
    let arms = config.of_steppers("arm_length")?;
    let angles = config.angles(["210", "330", "90"])?;
    let mut legs: [String; 3] = Default::default();
    for (i, leg) in legs.iter_mut().enumerate() {
        let [x, y] = polar(&angles[i], Some(&radius)).ok_or_else(|| config.beyond_a_turn(i))?;
        *leg = format!(
            "[[mechanism.legs]]                 # {}, at {} degrees\ndrive = \"slider\"\n\
             direction = [0, 0, 1]\nanchor = [{x}, {y}, 0]\nlength = {}\nmode = \"-\"\n",
            STEPPERS[i], angles[i].text, arms[i].text
        );
    }
    let mut notes = config.notes();
    let r = &radius.text;
    let reach = |arm: &Number| format!("12*{}/sqrt(145)-{r}", arm.text);
    let given = config.positive("printer", "print_radius")?.unwrap_or_else(|| radius.clone());
    let mut radii = vec![given.text];
    radii.extend(arms.iter().map(reach));
    let (print_radius, value) = least(&radii)
        .ok_or_else(|| config.bad("printer", "print_radius", "a radius within the arms' reach"))?;
    if value.sign() != Some(1) {
        return Err(config.bad("printer", "delta_radius", "a radius less than the arms' length"));
    }
    let low = config.lowest()?;
    let (high, ranges) = match carriages(config, &radius, &arms)? {
        Some(carriages) => {
            notes.push(
                "The carriages' lower ends: a configuration has endstops at the top only.".into(),
            );
            let range = |top: &String| format!("  {{ max = {} }},\n", quoted(top));
            let ranges: String = carriages.iter().map(range).collect();
            (highest(&low, &arms, &carriages, &mut notes), format!("joint_range = [\n{ranges}]\n"))
        }
        None => {
            notes.push(
                "The height: position_endstop is not set; the workspace is flat. The factors of a \
                 linear Delta do not depend on z."
                    .to_owned(),
            );
            (low.clone(), String::new())
        }
    };
    let requirements = format!("transmission = {{ min = \"1/4\", max = 4 }}\n{ranges}");
    let workspace = format!(
        "cylinder = {{ center = [0, 0], radius = {}, z = [{low}, {}] }}\n",
        quoted(&print_radius),
        quoted(&high)
    );
    let design = design(config.file, "Linear Delta", &legs, &workspace, &requirements, &notes);
    Ok(Imported { design, not_carried_over: notes })
}

/// Where each carriage is at its endstop; none if an endstop is not set.
fn carriages(
    config: &Config<'_>,
    radius: &Number,
    arms: &[Number; 3],
) -> Result<Option<Vec<String>>, ImportError> {
    let first = config.number(STEPPERS[0], "position_endstop")?;
    let mut carriages = Vec::new();
    for (stepper, arm) in STEPPERS.into_iter().zip(arms) {
        let end = config.number(stepper, "position_endstop")?.or_else(|| first.clone());
        let Some(Number { text: end, .. }) = end else { return Ok(None) };
        let (l, r) = (&arm.text, &radius.text);
        carriages.push(format!("{end}+sqrt({l}*{l}-{r}*{r})"));
    }
    Ok(Some(carriages))
}

/// The greatest z of the full radius: an arm's length below the lowest endstop.
fn highest(low: &str, arms: &[Number; 3], carriages: &[String], notes: &mut Vec<String>) -> String {
    let tops = carriages.iter().zip(arms).map(|(top, arm)| format!("{top}-{}", arm.text));
    let top = least(&tops.collect::<Vec<_>>());
    let above = |top: &Exact| {
        Number::parse(low).and_then(|low| low.value.compare(top)) == Some(Ordering::Less)
    };
    match top.filter(|(_, value)| above(value)) {
        Some((top, _)) => {
            notes.push(
                "The workspace above the height at which the firmware tapers it towards the \
                 endstops: a design has cylinders, no cones."
                    .to_owned(),
            );
            top
        }
        None => {
            notes.push(
                "The height: the endstops leave no cylinder of the full radius; the workspace is \
                 flat."
                    .to_owned(),
            );
            low.to_owned()
        }
    }
}

fn rotary_delta(config: &Config<'_>) -> Result<Imported, ImportError> {
    let radius = config.required("printer", "shoulder_radius")?;
    let height = config.required("printer", "shoulder_height")?;
    let (upper, lower) =
        (config.of_steppers("upper_arm_length")?, config.of_steppers("lower_arm_length")?);
    let angles = config.angles(["30", "150", "270"])?;
    let mut legs: [String; 3] = Default::default();
    for (i, leg) in legs.iter_mut().enumerate() {
        let turn = || config.beyond_a_turn(i);
        let [x, y] = polar(&angles[i], Some(&radius)).ok_or_else(turn)?;
        let [e_x, e_y] = polar(&angles[i], None).ok_or_else(turn)?;
        let [k_x, k_y] = axis(&angles[i]).ok_or_else(turn)?;
        *leg = format!(
            "[[mechanism.legs]]                 # {}, at {} degrees\ndrive = \"arm\"\n\
             anchor = [{x}, {y}, {}]\naxis = [{k_x}, {k_y}, 0]\nreference = [{e_x}, {e_y}, 0]\n\
             arm = {}\nlength = {}\nmode = \"-\"\n",
            STEPPERS[i], angles[i].text, height.text, upper[i].text, lower[i].text
        );
    }
    let mut notes = config.notes();
    let r = &radius.text;
    let mut radii: Vec<String> = upper.iter().map(|arm| format!("{r}+{}", arm.text)).collect();
    radii.extend(lower.iter().map(|arm| format!("{}-{r}", arm.text)));
    let (reach, value) =
        least(&radii).ok_or_else(|| config.bad("printer", "shoulder_radius", POSITIVE))?;
    if value.sign() != Some(1) {
        let expected = "a radius less than the lower arms' length";
        return Err(config.bad("printer", "shoulder_radius", expected));
    }
    notes.push(
        "The height of the workspace: where the firmware tapers it depends on the arms' angles at \
         the endstops; it is flat below, at minimum_z_position."
            .to_owned(),
    );
    notes
        .push("The arms' ranges: a configuration has one endstop for each, at the top.".to_owned());
    let low = config.lowest()?;
    let workspace = format!(
        "cylinder = {{ center = [0, 0], radius = {}, z = [{low}, {low}] }}\n",
        quoted(&reach)
    );
    let per_radian = format!(
        "transmission = {{ min = \"{0}/4\", max = \"{0}*4\" }} # length per radian\n",
        upper[0].text
    );
    let design = design(config.file, "Rotary Delta", &legs, &workspace, &per_radian, &notes);
    Ok(Imported { design, not_carried_over: notes })
}
