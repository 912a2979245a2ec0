//! What firmwares read otherwise than it looks: the import reads it as they do, or refuses it.

use crate::support::import;
use orthocert::import::{klipper, linuxcnc, marlin, reprap, smoothieware, Importer};

/// A design with this text in it, or a refusal.
enum Is {
    With(&'static str),
    Refused,
}

fn becomes(trap: &str, importer: Importer, files: &[(&str, &str)], is: &Is) {
    match (import(importer, files), is) {
        (Ok(imported), Is::With(text)) => {
            assert!(imported.design.contains(text), "{trap}: {}", imported.design);
        }
        (Err(_), Is::Refused) => {}
        (Ok(imported), Is::Refused) => panic!("{trap}: {}", imported.design),
        (Err(error), Is::With(_)) => panic!("{trap}: {error}"),
    }
}

#[test]
fn marlins_compiler() {
    let header = |more: &str| {
        format!(
            "#define DELTA\n#define PRINTABLE_RADIUS 90.0\n#define DELTA_DIAGONAL_ROD 218.0\n\
             #define DELTA_HEIGHT 300\n#define DELTA_RADIUS 124.5\n#define Z_MIN_POS 0\n{more}"
        )
    };
    for (trap, more, is) in [
        ("nothing", "", Is::With("124.5")),
        ("another value", "#undef DELTA_RADIUS\n#define DELTA_RADIUS 130.5\n", Is::With("130.5")),
        ("a comment goes on", "// \\\n#define DELTA_RADIUS 130.5\n", Is::With("124.5")),
        ("behind a blank", "// \\ \t\n#define DELTA_RADIUS 130.5\n", Is::With("124.5")),
        (
            "a carriage return",
            "// x\r#undef DELTA_RADIUS\r#define DELTA_RADIUS 130.5\n",
            Is::With("130.5"),
        ),
        ("a header of its own", "#include \"my_macros.h\"\n", Is::Refused),
        ("the firmware's header", "#include \"../inc/macros.h\"\n", Is::With("124.5")),
        ("elifdef", "#if 0\n#elifdef DELTA\n#endif\n", Is::Refused),
        ("a digraph", "%:define DELTA_RADIUS 130.5\n", Is::Refused),
    ] {
        becomes(trap, marlin, &[("Configuration.h", &header(more))], &is);
    }
}

#[test]
fn a_tab_of_reprapfirmware() {
    let config = |more: &str| format!("M665 L300 R150.5 B100 H300\n{more}");
    let block = "  if false\n\tM665 R120\n";
    becomes("in a block", reprap, &[("config.g", &config(block))], &Is::Refused);
    becomes("no block", reprap, &[("config.g", &config(""))], &Is::With("150.5"));
}

#[test]
fn a_carriage_return_of_klipper() {
    let config = |radius: &str| {
        format!(
            "[printer]\nkinematics: delta\nmax_velocity: 300\nmax_accel: 3000\n\
             delta_radius: {radius}\n[stepper_a]\nposition_endstop: 297.05\narm_length: 333.0\n\
             rotation_distance: 40\nmicrosteps: 16\n[stepper_b]\nrotation_distance: 40\n\
             microsteps: 16\n[stepper_c]\nrotation_distance: 40\nmicrosteps: 16\n"
        )
    };
    let plain = config("141.5");
    let trapped = config("150.5\n# measured:\rdelta_radius: 141.5");
    let designs = [plain, trapped].map(|text| {
        let imported = import(klipper, &[("printer.cfg", &text)]).expect("a Delta");
        let lines = imported.design.lines().filter(|line| !line.starts_with('#'));
        lines.map(str::to_owned).collect::<Vec<_>>()
    });
    assert_eq!(designs[0], designs[1]);
}

#[test]
fn pins_that_linuxcnc_does_not_have() {
    let pins = "setp lineardeltakins.L 269.5\nsetp lineardeltakins.R 130.5\n";
    let hal = |more: &str| format!("loadrt lineardeltakins\n{pins}{more}");
    becomes("plain", linuxcnc, &[("delta.hal", &hal(""))], &Is::With("130.5"));
    for (trap, more) in [
        ("another case", "setp lineardeltakins.r 180\n"),
        ("another name", "setp lineardeltakins.Radius 150\n"),
        ("a signal", "net rr lineardeltakins.r\nsets rr 180\n"),
        ("quotes", "setp 'lineardeltakins.R' 180\n"),
    ] {
        becomes(trap, linuxcnc, &[("delta.hal", &hal(more))], &Is::Refused);
    }
    let named = hal("").replace("loadrt lineardeltakins", "loadrt lineardeltakins names=foo");
    becomes("names", linuxcnc, &[("delta.hal", &named)], &Is::Refused);
}

#[test]
fn the_letters_of_smoothieware() {
    let config = "arm_solution linear_delta\narm_length 300.0\narm_radius 150.5\n\
                  gamma_max 300\n";
    for (trap, saved, is) in [
        ("capitals", "M665 R120.5\n", Is::With("120.5")),
        ("small letters", "m665 r120.5\n", Is::With("150.5")),
    ] {
        becomes(trap, smoothieware, &[("config", config), ("config-override", saved)], &is);
    }
    let design = |saved: &str| {
        let files = [("config", config), ("config-override", saved)];
        let design = import(smoothieware, &files).expect("a Delta").design;
        design.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(design("M665 H0.5 F0.2\n"), design("M665 F0.2 H0.5\n"), "by letter, not by place");
}
