//! `pentakins`: five struts from points of the base to rings about the spindle's axis.
//!
//! ```text
//! d = R^T (base_i - P),  R = R_y(B) R_x(A)
//! rho_i = |(d_z - z_i, |(d_x, d_y)| - r_i)|
//!       = sqrt(|d|^2 - 2 z_i d_z + z_i^2 + r_i^2 - 2 r_i sqrt(|d|^2 - d_z^2))
//! ```
//!
//! A strut's end runs on its ring towards the strut's own base: no leg of a design, but formulas in x, y, z and
//! the half tangents of A and B. The tool's offset is added to the heights of the base and of the rings.

use super::hal::Hal;
use super::hexapod::raised;
use super::machine::{joint_range, limits, pin};
use crate::import::settings::Settings;
use crate::import::toml::{half_tangent, less, quoted, Machine, Number};
use crate::import::ImportError;

const SOURCE: &str = "src/emc/kinematics/pentakins.c";
const HEADER: &str = "src/emc/kinematics/pentakins.h";

const BASE: [[&str; 3]; 5] = [
    ["-418.03", "324.56", "895.56"],
    ["417.96", "324.56", "895.56"],
    ["-418.03", "-325.44", "895.56"],
    ["417.96", "-325.44", "895.56"],
    ["-0.06", "-492.96", "895.56"],
];
const EFFECTOR: [[&str; 2]; 5] = [
    ["80.32", "-185.50"],
    ["80.32", "-159.50"],
    ["80.32", "-67.50"],
    ["80.32", "-41.50"],
    ["80.32", "-14.00"],
];

/// The machine of the module.
pub(super) fn pentapod(settings: &mut Settings, hal: &mut Hal) -> Result<Machine, ImportError> {
    let became = "added to the heights of the base and of the rings";
    let offset = [pin(settings, hal, "pentakins.tool-offset", became, ("0.0", SOURCE))?];
    let (mut parameters, mut across, mut heights) = (String::new(), Vec::new(), Vec::new());
    for (i, (base, effector)) in BASE.iter().zip(&EFFECTOR).enumerate() {
        let mut number = |end: &str, key: &str, became, default| {
            pin(settings, hal, &format!("pentakins.{end}.{i}.{key}"), became, (default, HEADER))
        };
        let stands = "where a strut stands";
        let [x, y, z] = [
            number("base", "x", stands, base[0])?,
            number("base", "y", stands, base[1])?,
            number("base", "z", stands, base[2])?,
        ];
        let radius = number("effector", "r", "a ring's radius", effector[0])?;
        let height = number("effector", "z", "a ring's height", effector[1])?;
        let size = |x: &Number| x.text.trim_start_matches('-').to_owned();
        across.extend([&x, &y].into_iter().filter(|x| x.value.sign() != Some(0)).map(size));
        heights.push(format!("({})", z.text));
        parameters.push_str(&format!(
            "x{i} = {}\ny{i} = {}\nz{i} = {}\nr{i} = {}\nh{i} = {}\n",
            x.text,
            y.text,
            raised(&z, &offset),
            radius.text,
            raised(&height, &offset)
        ));
    }
    if across.is_empty() {
        return Err(settings.refused("all struts of pentakins stand on one line"));
    }
    let mut definitions = String::from(
        "c_a = \"(1 - a^2)/(1 + a^2)\"\ns_a = \"2*a/(1 + a^2)\"\n\
         c_b = \"(1 - b^2)/(1 + b^2)\"\ns_b = \"2*b/(1 + b^2)\"\n",
    );
    let mut joints = Vec::new();
    for i in 0..BASE.len() {
        // The square of the distance, and the height along the spindle.
        definitions.push_str(&format!(
            "n{i} = \"(x{i} - x)^2 + (y{i} - y)^2 + (z{i} - z)^2\"\n\
             d{i} = \"c_a*(s_b*(x{i} - x) + c_b*(z{i} - z)) - s_a*(y{i} - y)\"\n"
        ));
        joints.push(format!(
            "[[mechanism.joints]]               # joint {i}\n\
             rho = \"sqrt(n{i} - 2*h{i}*d{i} + h{i}^2 + r{i}^2 - 2*r{i}*sqrt(n{i} - d{i}^2))\"\n"
        ));
    }
    let coordinates =
        "coordinates = [\"x\", \"y\", \"z\", \"a\", \"b\"] # a, b: the tangents of half of A and B";
    let mechanism = format!(
        "{coordinates}\n\n[mechanism.parameters]\n{parameters}\n[mechanism.definitions]\n{definitions}"
    );
    let legs = std::iter::once(mechanism).chain(joints).collect();
    let workspace = workspace(settings, &across.join("+"), &heights.join("+"))?;
    let ranges = joint_range(settings, 5, false)?;
    let requirements =
        if ranges.is_empty() { "joint_range = { min = 0 }\n".to_owned() } else { ranges };
    Ok(Machine { title: "Pentapod", kind: "formulas", unit: None, legs, workspace, requirements })
}

/// The box of the axes' limits, its angles' half tangents rounded outward, or a guess of the same kind.
fn workspace(settings: &mut Settings, across: &str, heights: &str) -> Result<String, ImportError> {
    let all = limits(settings, ["AXIS_X", "AXIS_Y", "AXIS_Z", "AXIS_A", "AXIS_B"])?;
    let half = |[min, max]: &[Number; 2]| -> Option<[String; 2]> {
        let is_within = less("-180", &min.text) && less(&max.text, "180");
        let turned = || Some((half_tangent(min)?, half_tangent(max)?));
        let ([least, _], [_, greatest]) = is_within.then(turned)??;
        Some([least, greatest])
    };
    let halves = all.and_then(|[x, y, z, a, b]| Some(([x, y, z], half(&a)?, half(&b)?)));
    let [min, max] = match halves {
        Some((points, a, b)) => {
            settings.note(
                "The workspace is the box of the axes' limits, all of which need not be in reach; the tangents \
                 of half of A and B are rounded outward in the 18th decimal.",
            );
            [0, 1].map(|end| {
                let ends = points.iter().map(|axis| axis[end].text.clone());
                ends.chain([a[end].clone(), b[end].clone()]).collect::<Vec<_>>()
            })
        }
        _ => {
            settings.note(
                "The workspace: MIN_LIMIT and MAX_LIMIT of AXIS_X, AXIS_Y and AXIS_Z, and of AXIS_A and AXIS_B \
                 between -180 and 180 degrees, are not all given; what is below is a guess to be changed.",
            );
            ["-", "+"].map(|sign| {
                let off = format!("{sign}({across})/150");
                let off = off.trim_start_matches('+').to_owned();
                let turned = format!("{}0.026", sign.trim_start_matches('+'));
                let height = quoted(&format!("({heights})/10{sign}({across})/150"));
                vec![quoted(&off), quoted(&off), height, turned.clone(), turned]
            })
        }
    };
    Ok(format!("min = [{}]\nmax = [{}]\n", min.join(", "), max.join(", ")))
}
