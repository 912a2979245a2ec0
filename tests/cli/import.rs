//! `import`: what is said of a configuration, what is refused, and what is not read for ever.

use super::support::Folder;

const PRINTER: &str = "\
[include geometry/*.cfg]
[printer]
kinematics: delta
print_radius: 80
[stepper_a]
position_endstop: 297
arm_length: 333
rotation_distance: 40
microsteps: 16
[stepper_b]
rotation_distance: 40
microsteps: 16
[stepper_c]
rotation_distance: 40
microsteps: 16
";

fn folder() -> Folder {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("geometry")).unwrap();
    folder.write("printer.cfg", PRINTER);
    folder.write("geometry/a.cfg", "[printer]\ndelta_radius: 174.75#mm\n");
    folder
}

#[test]
fn every_setting_is_told_and_the_design_certifies() {
    let folder = folder();
    let run = folder.run(&["import", "klipper", "printer.cfg", "-o", "d.toml"]).exits(0);
    run.complains(&[
        "used: geometry/a.cfg:2: [printer] delta_radius = 174.75: the towers' distance",
        "default: [stepper_b] arm_length = 333, after klippy/kinematics/delta.py",
        "default: [printer] minimum_z_position = 0",
        "not carried over: The workspace above",
    ]);
    folder.run(&["verify", "d.toml"]).exits(0);
    // A file that is read through an include is no output.
    let own = ["import", "klipper", "printer.cfg", "-o", "geometry/a.cfg"];
    folder.run(&own).exits(2).complains(&["--output", "is read"]);
}

#[test]
fn what_may_matter_is_refused_unless_its_key_is_named() {
    let folder = folder();
    folder.write("printer.cfg", format!("{PRINTER}tower_lean: 0.3\n"));
    let refused = folder.run(&["import", "klipper", "printer.cfg"]).exits(2);
    refused.complains(&["printer.cfg:16: [stepper_c] tower_lean = 0.3", "--ignore"]);
    let key = "[stepper_c] tower_lean";
    let run = folder.run(&["import", "klipper", "printer.cfg", "--ignore", key]).exits(0);
    assert!(
        run.stderr.contains("ignored: printer.cfg:16: [stepper_c] tower_lean"),
        "{}",
        run.stderr
    );
    run.says(&["ignored: # - printer.cfg:16: [stepper_c] tower_lean = 0.3"]);
    let idle = ["import", "klipper", "printer.cfg", "--ignore", key, "--ignore", "other"];
    folder.run(&idle).exits(2).complains(&["--ignore \"other\""]);
}

#[cfg(unix)]
#[test]
fn only_regular_files_are_opened() {
    let folder = folder();
    folder.write("printer.cfg", format!("[include pipe.cfg]\n{PRINTER}"));
    let made = std::process::Command::new("mkfifo").arg(folder.path("pipe.cfg")).status();
    assert!(made.unwrap().success());
    let run = folder.run(&["import", "klipper", "printer.cfg"]).exits(2);
    run.complains(&["pipe.cfg: cannot be read", "no regular file"]);
    folder.run(&["import", "klipper", "/dev/zero"]).exits(2).complains(&["no regular file"]);
    folder.run(&["import", "linuxcnc", "."]).exits(2).complains(&["a folder"]);
}
