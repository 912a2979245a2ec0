//! A claim in words: what an accepted certificate establishes.

use crate::certificate::{Certificate, Proof, Verdict};
use crate::claim::{
    Claim, Leg, MachineClaim, Mechanism, Quantity, Range, Requirements, Sign, Workspace,
};
use crate::kernel;
use std::fmt::{self, Write};

/// The theorem that an accepted certificate with this claim and verdict establishes.
///
/// # Errors
/// Only if the formatter fails.
pub fn statement(claim: &Claim, verdict: Verdict) -> Result<String, fmt::Error> {
    let mut out = String::new();
    match verdict {
        Verdict::Certified => writeln!(out, "It is proved:")?,
        Verdict::Refuted => writeln!(out, "It is proved that the following is FALSE:")?,
    }
    match claim {
        Claim::Machine(claim) => {
            machine(&mut out, claim)?;
            requirements(&mut out, claim)?;
        }
        Claim::Postulate(claim) => return orthocert_kernel::postulate::statement(claim),
        Claim::NoCube(claim) => return orthocert_kernel::no_cube::statement(claim),
        Claim::Atlas(claim) => return orthocert_kernel::atlas::statement(claim),
        Claim::Kernel(claim) => return kernel::statement(claim, verdict),
    }
    Ok(out)
}

/// What a certificate establishes once it is accepted: its claim, proved or refuted, and, where the
/// witness says so, how it fails.
///
/// # Errors
/// Only if the formatter fails.
pub fn established(certificate: &Certificate) -> Result<String, fmt::Error> {
    let words = statement(&certificate.claim, certificate.verdict)?;
    match (&certificate.claim, &certificate.proof) {
        (
            Claim::Kernel(claim),
            Proof::Kernel(orthocert_kernel::certificate::Proof::Witness(witness)),
        ) => Ok(words + &orthocert_kernel::statement::counterexample(claim, witness)?),
        _ => Ok(words),
    }
}

/// Most characters of a line.
const WIDTH: usize = 80;

/// A text for a terminal: long lines go on in the next, indented by four more, after a comma outside
/// parentheses, and where these are too far apart, after a word.
pub fn wrapped(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        let blanks = line.len() - line.trim_start().len();
        let (mut column, mut piece) = (0, String::new());
        let mut place = |out: &mut String, piece: &mut String| {
            let is_long = blanks + 4 + piece.trim_end().chars().count() > WIDTH;
            for part in piece.split_inclusive(|c| is_long && c == ' ') {
                let length = part.trim_end().chars().count();
                if column > blanks && column + length > WIDTH {
                    out.truncate(out.trim_end_matches(' ').len());
                    out.push('\n');
                    out.push_str(&" ".repeat(blanks + 4));
                    column = blanks + 4;
                }
                column += part.chars().count();
                out.push_str(part);
            }
            piece.clear();
        };
        let mut open = 0u32;
        for c in line.chars() {
            piece.push(c);
            match c {
                '(' | '[' => open += 1,
                ')' | ']' => open = open.saturating_sub(1),
                ' ' if open == 0 && piece.ends_with(", ") => place(&mut out, &mut piece),
                _ => {}
            }
        }
        place(&mut out, &mut piece);
        out.push('\n');
    }
    out
}

fn transmission_factors(out: &mut String) -> fmt::Result {
    writeln!(out, "where psi_i are the velocity transmission factors at P, the inverse singular")?;
    writeln!(out, "values of the inverse Jacobian M = J^-1.")
}

fn machine(out: &mut String, claim: &MachineClaim) -> fmt::Result {
    match &claim.mechanism {
        Mechanism::Orthoglide { offset } => {
            writeln!(
                out,
                "For the Orthoglide with orthogonal guides along the axes, offset e = {offset},"
            )?;
            writeln!(out, "whose leg length L and corners q1 < 0 < q2 follow from psi_max")?;
            writeln!(
                out,
                "(kappa = 1/psi_max, t1 = (1 - kappa)/2, t2 = 1 - kappa if kappa <= 1/2"
            )?;
            writeln!(out, "and (1/kappa - 1)/2 otherwise, q1 = -L t1/sqrt(1 + 2 t1^2),")?;
            writeln!(out, "q2 = L t2/sqrt(1 + 2 t2^2), base a = q1 - e - L):")?;
        }
        Mechanism::Translational(legs) => {
            let toleranced = legs.iter().any(Leg::has_tolerance);
            let every = if toleranced { "For every machine" } else { "For the machine" };
            writeln!(out, "{every} with three legs (w_i = P + platform - anchor):")?;
            for (i, leg) in legs.iter().enumerate() {
                writeln!(out, "  leg {}: {}", i + 1, Described(leg))?;
            }
        }
    }
    match &claim.workspace {
        Workspace::Box { min, max } => {
            writeln!(out, "and every point P = (x, y, z) of the box")?;
            for ((axis, min), max) in ["x", "y", "z"].iter().zip(min).zip(max) {
                writeln!(out, "  {min} <= {axis} <= {max}")?;
            }
        }
        Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => {
            writeln!(out, "and every point P = (x, y, z) of the cylinder")?;
            writeln!(out, "  (x - ({x}))^2 + (y - ({y}))^2 <= ({radius})^2, {low} <= z <= {high}")?;
        }
        Workspace::Cube { side } => {
            writeln!(
                out,
                "and every point P of the closed cube [q1, q2]^3 with q2 - q1 = {side}:"
            )?;
        }
    }
    Ok(())
}

fn requirements(out: &mut String, claim: &MachineClaim) -> fmt::Result {
    let Requirements {
        transmission,
        joint_range,
        conditioning,
        serial_margin,
        parallel_margin,
        leg_angle,
        joint_speed,
    } = &claim.requirements;
    writeln!(out, "  every leg reaches P without a serial singularity;")?;
    writeln!(out, "  P is not a parallel singularity;")?;
    // Motors turn arms: M is in radians per length, joint coordinates and speeds are in degrees.
    let angular = claim.mechanism.is_angular();
    let (per_radian, degrees) = match angular {
        true => (" (length per radian)", " (degrees, up to whole turns)"),
        false => ("", ""),
    };
    if let Some(range) = transmission {
        if let (Workspace::Cube { .. }, Some(max)) = (&claim.workspace, &range.max) {
            writeln!(
                out,
                "  1/psi_max <= psi_i(P) <= psi_max for i = 1, 2, 3, with psi_max = {max};"
            )?;
        } else {
            writeln!(out, "  {}{per_radian} for i = 1, 2, 3;", Bounded(range, "psi_i(P)"))?;
        }
    }
    for (i, range) in joint_range.iter().flatten().enumerate() {
        writeln!(out, "  {}{degrees};", Bounded(range, &format!("rho_{}(P)", i + 1)))?;
    }
    if let Some(bound) = conditioning {
        writeln!(out, "  sigma_max(M)/sigma_min(M) <= {};", bound.max)?;
    }
    if let Some(bound) = serial_margin {
        writeln!(
            out,
            "  |eta_i|/L_i >= {} for every leg, eta_i being the leg's component",
            bound.min
        )?;
        writeln!(out, "  along the motion of its driven end;")?;
    }
    if let Some(bound) = parallel_margin {
        writeln!(out, "  |det A|/(L_1 L_2 L_3) >= {};", bound.min)?;
    }
    if let Some(bound) = leg_angle {
        writeln!(out, "  every leg is within {} degrees of its guide;", bound.max)?;
    }
    if let Some(bound) = joint_speed {
        let (in_degrees, what) = match angular {
            true => (" * 180/pi", "joint speed in degrees per unit of time"),
            false => ("", "tool and joint speed"),
        };
        writeln!(
            out,
            "  |row_i of M| * {}{in_degrees} <= {} for every leg ({what});",
            bound.tool, bound.max
        )?;
    }
    transmission_factors(out)
}

struct Described<'a>(&'a Leg);

impl fmt::Display for Described<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mode = match self.0 {
            Leg::Slider { mode, .. } | Leg::Arm { mode, .. } => Some(mode),
            Leg::Strut { .. } | Leg::Planar { .. } => None,
        };
        f.write_str(match self.0 {
            Leg::Slider { .. } => "slider",
            Leg::Strut { .. } => "strut",
            Leg::Arm { .. } => "arm",
            Leg::Planar { .. } => "planar",
        })?;
        let parameters = self.0.parameters();
        let mut rest = parameters.as_slice();
        while let Some(&(parameter, first)) = rest.first() {
            match rest {
                [(_, x), (_, y), (_, z), after @ ..] if !parameter.is_length() => {
                    write!(f, ", {parameter} ({}, {}, {})", Value(x), Value(y), Value(z))?;
                    rest = after;
                }
                [_, after @ ..] => {
                    write!(f, ", {parameter} {}", Value(first))?;
                    rest = after;
                }
                [] => break,
            }
        }
        match mode {
            Some(Sign::Plus) => f.write_str(", eta > 0"),
            Some(Sign::Minus) => f.write_str(", eta < 0"),
            None => Ok(()),
        }
    }
}

struct Value<'a>(&'a Quantity);

impl fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_exact() {
            write!(f, "{}", self.0.min)
        } else {
            write!(f, "in [{}, {}]", self.0.min, self.0.max)
        }
    }
}

struct Bounded<'a>(&'a Range, &'a str);

impl fmt::Display for Bounded<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Bounded(Range { min, max }, name) = self;
        if let Some(min) = min {
            write!(f, "{min} <= ")?;
        }
        f.write_str(name)?;
        if let Some(max) = max {
            write!(f, " <= {max}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_go_on_in_the_next_with_nothing_lost() {
        let long = format!("  leg 1: slider, {}anchor (0, 0, 0), eta > 0", "length 1, ".repeat(7));
        let wrapped = wrapped(&long);
        let lines: Vec<&str> = wrapped.lines().collect();
        assert!(lines[0].len() <= WIDTH && lines[0].ends_with("length 1,"), "{wrapped}");
        assert_eq!(lines[1], "      length 1, anchor (0, 0, 0), eta > 0");
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&wrapped), words(&long));
        assert_eq!(super::wrapped("a\n\n  b\n"), "a\n\n  b\n");
    }
}
