//! Marlin's configurations: what is read of them, and the designs against Marlin's kinematics.

use crate::configurations::{compare, Compared, Figures, Towers};
use crate::support::{claim, exactly, file, ignoring, import, legs, number};
use crate::support::{Leg, Workspace};
use orthocert::import::{marlin, ImportError, Imported};

/// src/module/delta.cpp, `forward_kinematics`.
fn forward_kinematics(towers: &Towers, [z1, z2, z3]: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = towers.at;
    let [ra, rb, rc] = towers.rod2;
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let p12 = [b[0] - a[0], b[1] - a[1], z2 - z1];
    let d2 = dot(p12, p12);
    let inv_d = 1.0 / d2.sqrt();
    let ex = p12.map(|x| x * inv_d);
    let p13 = [c[0] - a[0], c[1] - a[1], z3 - z1];
    let i = dot(ex, p13);
    let ey = [p13[0] - ex[0] * i, p13[1] - ex[1] * i, p13[2] - ex[2] * i];
    let j2 = dot(ey, ey);
    let inv_j = 1.0 / j2.sqrt();
    let ey = ey.map(|x| x * inv_j);
    let ez = [
        ex[1] * ey[2] - ex[2] * ey[1],
        ex[2] * ey[0] - ex[0] * ey[2],
        ex[0] * ey[1] - ex[1] * ey[0],
    ];
    let x = (ra - rb + d2) * inv_d * 0.5;
    let y = ((ra - rc + i * i + j2) * 0.5 - i * x) * inv_j;
    let z = (ra - x * x - y * y).sqrt();
    let start = [a[0], a[1], z1];
    std::array::from_fn(|k| start[k] + ex[k] * x + ey[k] * y - ez[k] * z)
}

/// src/module/delta.cpp, `recalc_delta_settings`: radius, rod, trims of angles, radii, rods.
fn recalc_delta_settings(radius: f64, rod: f64, trims: [[f64; 3]; 3]) -> Towers {
    let [angles, radii, rods] = trims;
    let tower = |i: usize| {
        let angle = ([210.0, 330.0, 90.0][i] + angles[i]).to_radians();
        [angle.cos() * (radius + radii[i]), angle.sin() * (radius + radii[i])]
    };
    let at = [tower(0), tower(1), tower(2)];
    Towers { at, rod2: rods.map(|trim| (rod + trim) * (rod + trim)), forward: forward_kinematics }
}

/// A header with these figures, in one of three spellings: every number in its place; the radius as the
/// difference of offsets; the rod by the alternatives of a model.
fn header(n: &[f64], free: bool, spelling: usize) -> String {
    let vector = |what: usize| format!("{{ {}, {}, {} }}", n[5 + what], n[8 + what], n[11 + what]);
    let radius = match spelling {
        1 => format!(
            "#define DELTA_SMOOTH_ROD_OFFSET {}\n#define DELTA_EFFECTOR_OFFSET 12.5 // mm\n\
             #define DELTA_CARRIAGE_OFFSET 20\n#define DELTA_RADIUS (DELTA_SMOOTH_ROD_OFFSET \\\n \
             -(DELTA_EFFECTOR_OFFSET)-(DELTA_CARRIAGE_OFFSET))",
            n[0] + 32.5
        ),
        _ => format!("#define DELTA_RADIUS {}", n[0]),
    };
    let rod = match spelling {
        2 => format!(
            "#if MODEL > 1 || ENABLED(LONG_RODS)\n#define DELTA_DIAGONAL_ROD 1.0\n#elif MODEL == 1\n\
             #define DELTA_DIAGONAL_ROD {}\n#else\n#define DELTA_DIAGONAL_ROD 2.0\n#endif",
            n[1]
        ),
        _ => format!("#define DELTA_DIAGONAL_ROD {}", n[1]),
    };
    let endstops = match free {
        true => "//#define MIN_SOFTWARE_ENDSTOPS\n//#define MAX_SOFTWARE_ENDSTOPS",
        false => "#define MIN_SOFTWARE_ENDSTOPS\n#define MAX_SOFTWARE_ENDSTOPS",
    };
    format!(
        "#define MODEL 1\n//#define LONG_RODS\n#define DELTA\n#if ENABLED(DELTA)\n\
         #define PRINTABLE_RADIUS {print}\n#define DELTA_MAX_RADIUS {print}\n{rod}\n\
         #define DELTA_HEIGHT {height}\n#define DELTA_ENDSTOP_ADJ {{ 0.0, 0.0, 0.0 }}\n{radius}\n\
         #define DELTA_TOWER_ANGLE_TRIM {angles}\n#define DELTA_RADIUS_TRIM_TOWER {radii}\n\
         #define DELTA_DIAGONAL_ROD_TRIM_TOWER {rods}\n#endif\n\
         #define X_MIN_POS -(PRINTABLE_RADIUS)\n#define X_MAX_POS PRINTABLE_RADIUS\n\
         #define Y_MIN_POS -(PRINTABLE_RADIUS)\n#define Y_MAX_POS PRINTABLE_RADIUS\n\
         #define Z_MIN_POS {low}\n#define MANUAL_Z_HOME_POS DELTA_HEIGHT\n\
         #define Z_MAX_POS MANUAL_Z_HOME_POS\n{endstops}\n\
         #if ENABLED(MIN_SOFTWARE_ENDSTOPS)\n#define MIN_SOFTWARE_ENDSTOP_Z\n#endif\n\
         #if ENABLED(MAX_SOFTWARE_ENDSTOPS)\n#define MAX_SOFTWARE_ENDSTOP_Z\n#endif\n",
        print = n[2],
        height = n[3],
        low = n[4],
        angles = vector(0),
        radii = vector(1),
        rods = vector(2),
    )
}

#[test]
fn configurations_are_marlins() {
    let mut compared = Compared::default();
    let text = file("marlin.txt");
    let lines: Vec<&str> = text.lines().collect();
    let sections =
        lines.windows(2).filter_map(|pair| Some((pair[0].strip_prefix("== ")?, pair[1])));
    for (at, (origin, figures)) in sections.enumerate() {
        let free = figures.ends_with(" free");
        let words = figures.trim_end_matches(" free").split_whitespace();
        let n: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
        let trims = [0, 1, 2].map(|what| [n[5 + what], n[8 + what], n[11 + what]]);
        let firmware = recalc_delta_settings(n[0], n[1], trims);
        let files = vec![("Configuration.h", header(&n, free, at % 3))];
        let figures = Figures { origin, ignore: Vec::new(), files };
        let region = compare(marlin, &figures, &firmware, &mut compared);
        // src/module/motion.cpp, apply_motion_limits and position_is_reachable.
        let (radius, [low, high]) = region.cylinder();
        let expected = if free { n[2] + 0.0001 } else { n[2] };
        assert!((radius - expected).abs() < 1e-9, "{origin}: {radius}");
        assert!((low - n[4]).abs() + (high - n[3]).abs() < 1e-9, "{origin}: {low} {high}");
    }
    println!("{compared:?}");
    assert!(compared.configurations >= 30);
}

const PLAIN: &str = "#define DELTA
#define PRINTABLE_RADIUS 90.0
#define DELTA_DIAGONAL_ROD 218.0
#define DELTA_HEIGHT 300
#define DELTA_RADIUS 97.0
#define Z_MIN_POS 0
";

fn text(text: &str) -> Result<Imported, ImportError> {
    import(marlin, &[("Configuration.h", text)])
}

#[test]
fn values_are_those_of_the_preprocessor() {
    for (radius, expected) in [
        ("#define DELTA_RADIUS 97.0", "97"),
        ("#define DELTA_RADIUS (186-(31)-(20.6))", "672/5"),
        ("#define A (B)\n#define B 10.0 + 87\n#define DELTA_RADIUS A", "97"),
        ("#define A 10.0 + 20\n#define DELTA_RADIUS 2 * A", "40"),
        ("#define DELTA_RADIUS 195 / 2", "97"),
        ("#define DELTA_RADIUS 195 / 2.", "195/2"),
        ("#define DELTA_RADIUS /* 1\n2 */ 9\\\n7.0 // 3", "97"),
        ("#define A\n#if ENABLED(A)\n#define DELTA_RADIUS 97\n#else\n#define DELTA_RADIUS 98\n#endif", "97"),
        ("#define A false\n#if ENABLED(A)\n#define DELTA_RADIUS 96\n#else\n#define DELTA_RADIUS 97\n#endif", "97"),
        ("//#define A\n#ifndef A\n#define A 3\n#endif\n#if A*2 > 5 && (A == 3 || FOO(1))\n#define DELTA_RADIUS 97\n#endif", "97"),
        ("//#define A\n//#define B\n#if EITHER(A, B)\n#define DELTA_RADIUS 1\n#elif NONE(A, B) && DISABLED(A)\n#define DELTA_RADIUS 97\n#else\n#define DELTA_RADIUS 2\n#endif", "97"),
        ("#define A 1\n#undef A\n#ifdef A\n#define DELTA_RADIUS 96\n#else\n#define DELTA_RADIUS 97\n#endif", "97"),
        ("#if __AVR__\n#define TEMP 1\n#endif\n#define DELTA_RADIUS 97", "97"),
        ("#define A 2\n#define B 1+1\n#if A-B*A == 0 || BOTH(A, B)\n#else\n#define DELTA_RADIUS 97\n#endif", "97"),
    ] {
        let changed = PLAIN.replace("#define DELTA_RADIUS 97.0", radius);
        let claim = claim(&text(&changed).unwrap_or_else(|error| panic!("{radius}: {error}")));
        let Leg::Slider { anchor, .. } = &legs(&claim)[2] else { panic!("{claim:?}") };
        assert_eq!(anchor[1], exactly(expected), "{radius}");
    }
}

#[test]
fn what_depends_on_other_headers_is_refused() {
    for (radius, told) in [
        ("#if MB(RAMPS)\n#define DELTA_RADIUS 97\n#endif", "DELTA_RADIUS depends on MB (Configuration.h:5)"),
        ("#define DELTA_RADIUS 97\n#ifdef __AVR__\n#undef DELTA_RADIUS\n#define DELTA_RADIUS 98\n#endif", "depends on __AVR__ (Configuration.h:6)"),
        ("#define DELTA_RADIUS 97\n#if MOTHERBOARD == BOARD_X\n#undef DELTA_RADIUS\n#endif", "depends on MOTHERBOARD"),
        ("#if STM32F1\n#define A 1\n#endif\n#define DELTA_RADIUS (A + 96.0)", "depends on STM32F1"),
        ("#if STM32F1\n#elif 1\n#define DELTA_RADIUS 97\n#endif", "depends on STM32F1"),
        ("#if 1 +\n#define DELTA_RADIUS 97\n#endif", "depends on a condition"),
        ("#define DELTA_RADIUS BOARD_RADIUS", "found \"BOARD_RADIUS\""),
        ("#define DELTA_RADIUS(x) 97", "found \"(x) 97\""),
        ("#define DELTA_RADIUS sqrt(97)", "found \"sqrt(97)\""),
        ("#define DELTA_RADIUS DELTA_RADIUS", "found \"DELTA_RADIUS\""),
        ("#define DELTA_RADIUS 97 / 0", "found \"97 / 0\""),
        ("#define DELTA_RADIUS", "found \"\""),
        ("", "DELTA_RADIUS: not set; it is the towers' distance from the centre"),
        ("#define DELTA_RADIUS 300", "less than the rods' length"),
        ("#define DELTA_RADIUS -97", "less than the rods' length"),
        ("#define DELTA_RADIUS 97\n#endif", "Configuration.h:6: found a line"),
        ("#if 1\n#define DELTA_RADIUS 97", "Configuration.h:5: found a line"),
        ("#define DELTA_RADIUS 97\n#define DELTA_WARP 3", "DELTA_WARP = 3: not understood"),
        ("#define DELTA_RADIUS 97\n#define SKEW_CORRECTION", "SKEW_CORRECTION = : not understood"),
        ("#define DELTA_RADIUS 97\n#include \"mine.h\"", "#include = \"mine.h\": not understood"),
        ("#define DELTA_RADIUS 97\n#define COREXY", "both DELTA and COREXY"),
        ("#define DELTA_RADIUS 97\n#define CONFIGURATION_H_VERSION 010109", "CONFIGURATION_H_VERSION"),
        ("#define DELTA_RADIUS 97\n#define DELTA_PRINTABLE_RADIUS 91", "differ"),
        ("#define DELTA_RADIUS 97\n#define BLTOUCH", "NOZZLE_TO_PROBE_OFFSET: not set"),
        ("#define DELTA_RADIUS 97\n#define DELTA_TOWER_ANGLE_TRIM { 0, 400, 0 }", "angle"),
        ("#define DELTA_RADIUS 97\n#define DELTA_TOWER_ANGLE_TRIM { 0, 0, 0, 0 }", "found \"{ 0, 0, 0, 0 }\""),
    ] {
        let error = text(&PLAIN.replace("#define DELTA_RADIUS 97.0", radius)).expect_err(radius);
        assert!(error.to_string().contains(told), "{radius}: {error}");
    }
    let error = text(&PLAIN.replace("#define DELTA\n", "//#define DELTA\n")).unwrap_err();
    assert!(matches!(error, ImportError::OtherMachine { .. }), "{error}");
    let warped = format!("{PLAIN}#define DELTA_WARP 3\n");
    let disk = crate::support::files(&[("Configuration.h", &warped)]);
    let imported = ignoring(marlin, &disk, &["Configuration.h"], &["DELTA_WARP"]).unwrap();
    assert_eq!(imported.ignored.len(), 1);
}

#[test]
fn all_that_is_read_is_told() {
    let imported = text(&format!(
        "{PLAIN}#define MIN_SOFTWARE_ENDSTOPS\n#define X_MIN_POS -(PRINTABLE_RADIUS)\n\
         #define Y_MIN_POS -80\n#define X_MAX_POS PRINTABLE_RADIUS\n#define Y_MAX_POS 70.5\n\
         #define FIX_MOUNTED_PROBE\n#define NOZZLE_TO_PROBE_OFFSET {{ 0, 0, -2.5 }}\n#define EEPROM_SETTINGS\n"
    ))
    .unwrap();
    let claim = claim(&imported);
    let Workspace::Cylinder { radius, z, .. } = &claim.workspace else { panic!("{claim:?}") };
    // The least of 90, of the greater of -90 and -80, of 90 and of 70.5.
    assert_eq!((radius, z), (&number("70.5"), &[number("0"), number("302.5")]));
    let used: Vec<&str> = imported.used.iter().map(|used| used.setting.key.as_str()).collect();
    for key in ["DELTA", "DELTA_RADIUS", "PRINTABLE_RADIUS", "Y_MAX_POS", "NOZZLE_TO_PROBE_OFFSET"]
    {
        assert!(used.contains(&key), "{key}: {used:?}");
    }
    let defaults: Vec<&str> = imported.defaults.iter().map(|taken| taken.key.as_str()).collect();
    assert!(defaults.contains(&"DELTA_TOWER_ANGLE_TRIM"), "{defaults:?}");
    let told = imported.not_carried_over.join("\n");
    for part in ["EEPROM", "about z = 279.73", "MIN_SOFTWARE_ENDSTOP_Z is not enabled"] {
        assert!(told.contains(part), "{part}: {told}");
    }
}

#[test]
fn expansion_is_bounded() {
    let mut bomb = String::from("#define A0 1.0\n");
    for i in 1..60 {
        bomb.push_str(&format!("#define A{i} A{} + A{}\n", i - 1, i - 1));
    }
    let radius = format!("{bomb}#define DELTA_RADIUS A59");
    let error = text(&PLAIN.replace("#define DELTA_RADIUS 97.0", &radius)).unwrap_err();
    assert!(error.to_string().contains("more than is read"), "{error}");
    let asked = format!("{PLAIN}{bomb}{}", "#if A59\n#endif\n".repeat(10_000));
    text(&asked).unwrap_err();
    let nested = format!("{PLAIN}#define DEEP {}1{}\n", "(".repeat(100_000), ")".repeat(100_000));
    text(&format!("{nested}#if DEEP\n#endif\n")).unwrap();
    let error = text(&nested.replace("RADIUS 97.0", "RADIUS DEEP")).unwrap_err();
    assert!(error.to_string().contains("DELTA_RADIUS"), "{error}");
}

#[test]
fn no_header_makes_the_importer_panic() {
    let text = format!(
        "{PLAIN}#if ANY(A, B) || !defined(C) && (D+1)\n#define DELTA_ENDSTOP_ADJ {{ 0, -(1.5), 2/4. }}\n\
         #else\n#include \"x\"\n#endif /* a \"b */ // c\n"
    );
    for (at, c) in text.char_indices() {
        for new in ["", "\n", "#", "(", ")", "\"", "\\", "/*", "-", "9", "\u{0}", "±", "if", ","] {
            let mutant = format!("{}{new}{}", &text[..at], &text[at + c.len_utf8()..]);
            let _ = import(marlin, &[("Configuration.h", &mutant)]);
        }
    }
}
