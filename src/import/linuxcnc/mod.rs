//! LinuxCNC: `lineardeltakins`, `rotarydeltakins`, `tripodkins`, `genhexkins` and `pentakins`, from an INI file and
//! the HAL files that it names, or from HAL files alone; after src/emc/kinematics.
//!
//! `lineardeltakins` has its joints 0, 1, 2 at 90, 210 and 330 degrees and the distance `R`, rods of
//! length `L`, and the carriage above the platform. `rotarydeltakins` has its hips at 270, 30 and 150
//! degrees, the height 0 and the distance `platformradius`, thighs whose angles count *downwards* from
//! the horizontal, and feet at the distance `footradius` from the controlled point, which is below.
//! `tripodkins` has three struts from (0, 0), (Bx, 0) and (Cx, Cy). `genhexkins` has six, from `base` to
//! `platform`, of a platform that is turned by A about x, then B about y, then C about z. `pentakins` has five, from
//! `base` to rings about its spindle, which is turned by A and B.

mod hal;
mod hexapod;
mod ini;
mod machine;
mod pentapod;

use super::files::Reading;
use super::settings::Settings;
use super::{Files, ImportError, Imported, Setting};
use hal::{is_idle, Hal, Source, DEPTH};
use ini::Ini;
use std::path::{Path, PathBuf};

/// LinuxCNC's own HAL files that set no pin of a kinematics module; its `tripodsim.hal` does.
const LIBRARY: [&str; 18] = [
    "axis_manualtoolchange.hal",
    "check_xyz_constraints.hal",
    "core_servo.hal",
    "core_sim.hal",
    "core_sim9.hal",
    "core_stepper.hal",
    "gantrysim.hal",
    "hookup_moveoff.tcl",
    "lathe.hal",
    "locking_indexer.hal",
    "moveoff_external.hal",
    "servo_sim.hal",
    "sim_spindle_encoder.hal",
    "simulated-gantry-home.hal",
    "simulated-xyyz-home.hal",
    "simulated_home.hal",
    "simulated_limits.hal",
    "wheeljogpins.tcl",
];

/// The design that LinuxCNC files describe: an INI file first, then those of the HAL files it names
/// that are not where it names them; or HAL files alone, in the order in which they are run.
///
/// # Errors
/// If LinuxCNC would not run them, if they load none of the five modules, or if something that may
/// set one of the module's pins is not understood.
pub fn linuxcnc(
    files: &dyn Files,
    paths: &[PathBuf],
    ignore: &[String],
) -> Result<Imported, ImportError> {
    let [first, others @ ..] = paths else {
        let expected = "an INI file, or HAL files";
        return Err(ImportError::Files { found: 0, expected });
    };
    let mut reading = Reading::new(files, first);
    let mut settings = Settings::new(reading.shown(first));
    let mut hal = Hal::default();
    let folder = first.parent().unwrap_or(Path::new("")).to_owned();
    if first.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ini")) {
        let ini = Ini::read(&mut reading, first)?;
        let source = Source { ini: &ini, folder };
        run(&mut reading, &mut settings, &mut hal, &source, others)?;
        // Of equal keys the first counts.
        ini.settings().iter().rev().for_each(|setting| settings.set(setting.clone()));
    } else {
        let source = Source { ini: &Ini::default(), folder };
        for path in paths {
            hal.file(&mut reading, &source, path, DEPTH)?;
        }
    }
    let machine = machine::machine(&mut settings, &mut hal)?;
    hal.not_understood.into_iter().for_each(|statement| settings.not_understood(statement));
    settings.note("Whatever changes a pin while the machine runs: panels, M-codes, programs.");
    settings.finish(&machine, cannot_matter, ignore, reading)
}

/// What scripts/linuxcnc runs: the HAL files, the commands, then those for after the display.
fn run(
    reading: &mut Reading<'_>,
    settings: &mut Settings,
    hal: &mut Hal,
    source: &Source<'_>,
    given: &[PathBuf],
) -> Result<(), ImportError> {
    let mut unread: Vec<&PathBuf> = given.iter().collect();
    for (files, commands) in [("HALFILE", "HALCMD"), ("POSTGUI_HALFILE", "POSTGUI_HALCMD")] {
        for named in source.ini.all(&format!("[HAL]{files}")) {
            let name = named.value.split_whitespace().next().unwrap_or_default();
            let name = name.strip_prefix("LIB:").unwrap_or(name);
            let beside = source.folder.join(name);
            let same = |path: &&PathBuf| path.file_name() == Path::new(name).file_name();
            let passed = given.iter().find(same);
            unread.retain(|path| Some(*path) != passed);
            let path = match passed {
                Some(path) => Some(path.clone()),
                None => Some(beside).filter(|path| reading.exists(path)),
            };
            match path {
                Some(path) if !name.ends_with(".tcl") => hal.file(reading, source, &path, DEPTH)?,
                None if LIBRARY.contains(&name) => {
                    hal.unseen = true;
                    settings.note(format!(
                        "{name}: LinuxCNC's own file, which sets no pin of the kinematics."
                    ));
                }
                _ => {
                    hal.unseen = true;
                    hal.not_understood.push(named.clone());
                }
            }
        }
        for named in source.ini.all(&format!("[HAL]{commands}")) {
            // The shell splits these into words; halcmd substitutes nothing in them.
            let words: Vec<&str> = named.value.split_whitespace().collect();
            let setting = |key: &str, value: &str| Setting {
                key: key.into(),
                value: value.into(),
                ..named.clone()
            };
            match words[..] {
                ["source", file] => {
                    hal.file(reading, source, &source.folder.join(file), DEPTH - 1)?;
                }
                _ => hal.command(&words, setting).ok_or_else(|| ImportError::Syntax {
                    file: named.file.clone(),
                    line: named.line,
                    expected: "HALCMD = a command of halcmd with as many words as it takes",
                })?,
            }
        }
    }
    let applications = source.ini.all("[APPLICATIONS]APP").filter(|app| !is_idle(&app.value));
    hal.not_understood.extend(applications.cloned());
    match unread.first() {
        None => Ok(()),
        Some(path) => Err(settings
            .refused(format!("{} is none of the files that its [HAL] names", reading.shown(path)))),
    }
}

/// Of an INI file only [KINS], the limits and what HAL takes from it reach the kinematics; its
/// [HAL] and [APPLICATIONS] were run.
fn cannot_matter(setting: &Setting) -> bool {
    const HAL: [&str; 9] = [
        "HALFILE",
        "HALCMD",
        "POSTGUI_HALFILE",
        "POSTGUI_HALCMD",
        "HALUI",
        "HALBRIDGE",
        "SHUTDOWN",
        "HALLIB_PATH",
        "DEBUG",
    ];
    let Some((section, tag)) = setting.key.strip_prefix('[').and_then(|rest| rest.split_once(']'))
    else {
        return false;
    };
    match section {
        "HAL" => HAL.contains(&tag),
        "KINS" => tag == "JOINTS",
        _ => true,
    }
}
