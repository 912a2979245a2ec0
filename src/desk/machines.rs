//! The machines to choose from: designs of the tests.

/// Name, file and text of a design.
type Machine = (&'static str, &'static str, &'static str);

macro_rules! machine {
    ($name:literal, $folder:literal, $file:literal) => {
        (
            $name,
            concat!($file, ".toml"),
            include_str!(concat!("../../tests/designs/", $folder, $file, ".toml")),
        )
    };
}

/// The machines.
pub const MACHINES: &[Machine] = &[
    machine!("Orthoglide, the prototype of the paper", "", "orthoglide-prototype"),
    machine!("Orthoglide as built, with tolerances", "", "orthoglide-tolerance"),
    machine!("Linear Delta 333 / 174.75", "", "linear-delta-klipper-cylinder"),
    machine!("Linear Delta 269 / 130.25", "", "linear-delta-linuxcnc-cylinder"),
    machine!("Rotary Delta", "", "rotary-delta-linuxcnc"),
    machine!("Tripteron", "", "tripteron"),
    machine!("Hexapod: LinuxCNC", "kernel/", "hexapod-linuxcnc"),
    machine!("Hexapod: camera of the Rubin Observatory", "kernel/", "hexapod-rubin-camera"),
    machine!("Hexapod: left hand of INRIA", "kernel/", "hexapod-inria-left-hand"),
    machine!("Planar 3-RPR", "kernel/", "planar-3-rpr"),
    machine!("Planar 3-RRR", "kernel/", "planar-3-rrr"),
    machine!("Spherical 3-UPS", "kernel/", "spherical-3-ups"),
    machine!("Five-bar", "kernel/", "five-bar"),
];
