//! Sections of configurations, and linear Deltas as three firmwares compute them.

use crate::oracle::{same_extremes, same_joints, Extremes, Firmware, Region};
use crate::support::{claim, files, ignoring};
use orthocert::import::Importer;

/// A configuration's figures, as tests/import/reprap.txt has them.
pub struct Figures<'a> {
    /// Repository and path.
    pub origin: &'a str,
    /// The keys to ignore.
    pub ignore: Vec<&'a str>,
    /// The files, with their texts.
    pub files: Vec<(&'a str, String)>,
}

/// The sections of a file.
pub fn sections(text: &str) -> Vec<Figures<'_>> {
    let mut sections: Vec<Figures<'_>> = Vec::new();
    for line in text.lines() {
        if let Some(origin) = line.strip_prefix("== ") {
            sections.push(Figures { origin, ignore: Vec::new(), files: Vec::new() });
            continue;
        }
        let Some(section) = sections.last_mut() else { continue };
        if let Some(key) = line.strip_prefix("ignore ") {
            section.ignore.push(key);
        } else if let Some(name) = line.strip_prefix("-- ") {
            section.files.push((name, String::new()));
        } else if let Some((_, text)) = section.files.last_mut() {
            text.push_str(line);
            text.push('\n');
        }
    }
    sections
}

/// Every how many configurations the extremes are compared, which takes a second each: the
/// environment's `ORTHOCERT_EVERY`, or a dozen.
pub fn every() -> usize {
    std::env::var("ORTHOCERT_EVERY").ok().and_then(|text| text.parse().ok()).unwrap_or(12)
}

/// How the comparisons of [`compare`] ended.
#[derive(Debug, Default)]
pub struct Compared {
    /// Configurations.
    pub configurations: usize,
    /// Points within reach.
    pub points: usize,
    /// Extremes that agree; singular machines.
    pub extremes: [usize; 2],
}

/// Imports a configuration, and holds the design against the firmware's kinematics and volume.
pub fn compare(
    importer: Importer,
    figures: &Figures<'_>,
    firmware: &dyn Firmware,
    compared: &mut Compared,
) -> Region {
    let name = figures.origin;
    let texts: Vec<(&str, &str)> =
        figures.files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let imported = ignoring(importer, &files(&texts), &[texts[0].0], &figures.ignore)
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let claim = claim(&imported);
    compared.points += same_joints(name, &claim, firmware, 100);
    if compared.configurations.is_multiple_of(every()) {
        match same_extremes(name, &claim, firmware) {
            Extremes::Agree => compared.extremes[0] += 1,
            Extremes::Singular => compared.extremes[1] += 1,
            Extremes::Undecided => panic!("{name}: undecided"),
        }
    }
    compared.configurations += 1;
    Region::of(&claim)
}

/// Three vertical towers: `delta_tower` and `delta_diagonal_rod_2_tower` of Marlin's
/// src/module/delta.cpp, `towerX`, `towerY` and `D2` of RepRapFirmware's LinearDeltaKinematics.cpp,
/// `delta_tower1_x` and the like of Smoothieware's LinearDeltaSolution.cpp.
#[derive(Clone, Debug)]
pub struct Towers {
    /// Where they stand.
    pub at: [[f64; 2]; 3],
    /// The squares of the rods' lengths.
    pub rod2: [f64; 3],
    /// Which forward kinematics.
    pub forward: fn(&Towers, [f64; 3]) -> [f64; 3],
}

impl Firmware for Towers {
    /// `DELTA_Z` of Marlin's src/module/delta.h; `LinearDeltaKinematics::Transform` without tilt;
    /// `LinearDeltaSolution::cartesian_to_actuator`.
    fn joints(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        let joint = |i: usize| {
            let [tx, ty] = self.at[i];
            (self.rod2[i] - (x - tx) * (x - tx) - (y - ty) * (y - ty)).sqrt() + z
        };
        Some([0, 1, 2].map(joint)).filter(|joints| joints.iter().all(|joint| joint.is_finite()))
    }

    fn point(&self, joints: [f64; 3]) -> Option<[f64; 3]> {
        Some((self.forward)(self, joints)).filter(|p| p.iter().all(|x| x.is_finite()))
    }
}
