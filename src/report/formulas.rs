//! The formulas that a claim is about.

use orthocert_kernel::formula::{Formula, Op, Tape};
use orthocert_kernel::machine::Joint;
use orthocert_kernel::problem::Problem;
use std::fmt::{self, Write};

/// The formulas of a problem: inputs `p`, coordinates `x`, and, leg by leg, `A`, `D` and `rho`, with
/// what is used more than once named `t`.
///
/// # Errors
/// Only if the formatter fails.
pub fn formulas(problem: &Problem) -> Result<String, fmt::Error> {
    let mut out = String::new();
    writeln!(out, "Lengths are divided by 2^{}.", problem.scale)?;
    let (first, m) = (problem.corners[0].len(), problem.dimension());
    if first < m {
        writeln!(out, "Half-angle tangents: x{first} to x{}.", m - 1)?;
    }
    for (j, input) in problem.inputs.iter().enumerate() {
        writeln!(out, "p{j} = {}", input.place)?;
    }
    let mut printer = Printer { tape: &problem.tape, out: &mut out, named: Vec::new() };
    if let Some(weight) = problem.weight {
        printer.line("w", weight)?;
    }
    for (i, leg) in problem.legs.iter().enumerate() {
        let scaled = leg.scaled.as_ref().map(|row| ("w ", row));
        for (w, row) in [("", &leg.row)].into_iter().chain(scaled) {
            for (k, &a) in row.a.iter().enumerate() {
                printer.line(&format!("{w}A_{}{}", i + 1, k + 1), a)?;
            }
            printer.line(&format!("{w}D_{}", i + 1), row.d)?;
        }
        match leg.rho {
            Some(Joint::Length(rho)) => printer.line(&format!("rho_{}", i + 1), rho)?,
            Some(Joint::Angle { cos, sin }) => {
                printer.line(&format!("cos(rho_{})", i + 1), cos)?;
                printer.line(&format!("sin(rho_{})", i + 1), sin)?;
            }
            None => {}
        }
    }
    if let Some(g) = problem.turned {
        printer.line("orientations, where not negative: g", g)?;
    }
    Ok(out)
}

/// Prints entries of a tape, each with those that it needs before it.
struct Printer<'a> {
    tape: &'a Tape,
    out: &'a mut String,
    named: Vec<Formula>,
}

impl Printer<'_> {
    fn line(&mut self, name: &str, formula: Formula) -> fmt::Result {
        let text = self.text(formula)?;
        writeln!(self.out, "{name} = {text}")
    }

    /// An operand: itself, or the name of the entry, which is printed first.
    fn text(&mut self, formula: Formula) -> Result<String, fmt::Error> {
        let op = self.tape.op(formula);
        match op {
            Op::Coordinate(k) => return Ok(format!("x{k}")),
            Op::Parameter(j) => return Ok(format!("p{j}")),
            Op::Integer(n) if n < 0 => return Ok(format!("({n})")),
            Op::Integer(n) => return Ok(n.to_string()),
            _ => {}
        }
        if let Some(at) = self.named.iter().position(|&known| known == formula) {
            return Ok(format!("t{at}"));
        }
        let text = match op {
            Op::Add(a, b) => format!("{} + {}", self.text(a)?, self.text(b)?),
            Op::Sub(a, b) => format!("{} - {}", self.text(a)?, self.text(b)?),
            Op::Mul(a, b) => format!("{} {}", self.text(a)?, self.text(b)?),
            Op::Div(a, b) => format!("{}/{}", self.text(a)?, self.text(b)?),
            Op::Neg(a) => format!("-{}", self.text(a)?),
            Op::Sqr(a) => format!("{}^2", self.text(a)?),
            Op::Sqrt(a) => format!("sqrt({})", self.text(a)?),
            Op::Elbow([a, b, t], second) => {
                let (name, a) = (if second { "elbow_s" } else { "elbow_c" }, self.text(a)?);
                format!("{name}({a}, {}, {})", self.text(b)?, self.text(t)?)
            }
            Op::Coordinate(_) | Op::Parameter(_) | Op::Integer(_) => return Err(fmt::Error),
        };
        let at = self.named.len();
        self.named.push(formula);
        writeln!(self.out, "t{at} = {text}")?;
        Ok(format!("t{at}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orthocert_kernel::certificate::{Certificate, Claim};
    use orthocert_kernel::claim::MachineClaim;

    const FIVE_BAR: &str = r#"{"mechanism":{"formulas":{"coordinates":["x","y"],"parameters":[["l",{"min":"199.95","max":"200.05"}]],"definitions":[["s","sqrt(l^2-y^2)"]],"joints":[{"rho":"x-s"},{"rho":"x+s"}]}},"workspace":{"box":{"min":["-50","80"],"max":["50","160"]}},"require":[{"quantity":"transmission","end":"max","bound":"3"}]}"#;

    fn text(claim: &MachineClaim) -> String {
        formulas(&Problem::new(claim).expect("a claim")).expect("words")
    }

    fn says(text: &str, lines: &[&str]) {
        for line in lines {
            assert!(text.contains(line), "{line}\n{text}");
        }
    }

    #[test]
    fn they_are_those_of_the_claim() {
        let text = text(&serde_json::from_str(FIVE_BAR).expect("a claim"));
        says(&text, &["p0 = l", "t0 = p0^2", "sqrt(", "A_11 = ", "D_2 = ", "rho_1 = "]);
        // Every name is given before it is used.
        let defined = text.lines().filter(|line| line.starts_with('t'));
        for (known, line) in defined.enumerate() {
            let (name, is) = line.split_once(" = ").expect("a definition");
            assert_eq!(name, format!("t{known}"));
            let words = is.split(|c: char| !c.is_alphanumeric());
            for used in words.filter_map(|w| w.strip_prefix('t')?.parse::<usize>().ok()) {
                assert!(used < known, "{line}");
            }
        }
    }

    #[test]
    fn those_of_platforms_that_turn_are_scaled_too() {
        let certificate = include_str!("../../proofs/certificates/hexapod-linuxcnc.cert.json");
        let certificate = Certificate::read(certificate).expect("a certificate");
        let Claim::Machine(claim) = &certificate.claim else { panic!("a machine") };
        let text = text(claim);
        let names = ["Half-angle tangents: x3 to x5.", "w = ", "A_66 = ", "w A_11 = ", "w D_6 = "];
        says(&text, &names);
        says(&text, &["g = "]);
    }
}
