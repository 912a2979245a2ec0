//! A machine of the tolerances for people: a row for each parameter, a column for each leg.

use super::text::{labelled, WIDTH};
use super::{FreeParameter, Setting};
use crate::exact::decimal::{readable, significant};
use std::fmt::Write;

/// Most lines that a machine takes, unless all are asked for.
const MOST_LINES: usize = 12;
/// Significant digits of values that are not exact.
const DIGITS: u32 = 9;

/// A parameter's leg, name and value.
type Cell<'a> = (Option<usize>, &'a str, String);

/// The machine of a witness.
pub fn machine_of_witness(out: &mut String, machine: &[Setting], verbose: bool) {
    let all = machine.iter().map(|s| (s.leg, s.parameter.as_str(), readable(&s.value)));
    told(out, &all.collect::<Vec<_>>(), verbose);
}

/// The machine at which a value was seen.
pub fn machine_at_ends(out: &mut String, machine: &[FreeParameter]) {
    let all = machine.iter().map(|p| (p.leg, p.parameter.as_str(), significant(p.value, DIGITS)));
    told(out, &all.collect::<Vec<_>>(), false);
}

fn told(out: &mut String, cells: &[Cell<'_>], verbose: bool) {
    if cells.is_empty() {
        return;
    }
    let lines = lines(cells);
    let most = if verbose { usize::MAX } else { MOST_LINES };
    if lines.len() <= most {
        return lines.iter().for_each(|line| out.push_str(line));
    }
    lines.iter().take(most - 1).for_each(|line| out.push_str(line));
    labelled(out, "", &format!("and {} lines more: --verbose", lines.len() - most + 1));
}

/// The machine's own parameters, one a line, then those of its legs.
fn lines(cells: &[Cell<'_>]) -> Vec<String> {
    let mut lines = Vec::new();
    for (_, name, value) in cells.iter().filter(|(leg, ..)| leg.is_none()) {
        lines.push(format!("  {name:<13} {value}\n"));
    }
    let mut legs: Vec<usize> = cells.iter().filter_map(|(leg, ..)| *leg).collect();
    legs.sort_unstable();
    legs.dedup();
    let mut names: Vec<&str> = Vec::new();
    for (_, name, _) in cells.iter().filter(|(leg, ..)| leg.is_some()) {
        if !names.contains(name) {
            names.push(name);
        }
    }
    let find = |leg: usize, name: &str| {
        let own = cells.iter().find(|(of, own, _)| *of == Some(leg) && *own == name);
        own.map_or("", |(_, _, value)| value)
    };
    let widest = cells.iter().map(|(_, _, value)| value.chars().count()).max().unwrap_or(0);
    let column = 2 + widest.max("leg 12".len());
    for legs in legs.chunks(((WIDTH - 16) / column).max(1)) {
        let row = |label: &str, value: &dyn Fn(usize) -> String| {
            let mut line = format!("  {label:<13}");
            for &leg in legs {
                let _ = write!(line, "{:>column$}", value(leg));
            }
            line + "\n"
        };
        lines.push(row("machine", &|leg| format!("leg {leg}")));
        lines.extend(names.iter().map(|name| row(name, &|leg| find(leg, name).to_owned())));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Exact;

    fn setting(leg: Option<usize>, parameter: &str, value: &str) -> Setting {
        Setting { leg, parameter: parameter.into(), value: Exact::parse(value, 100).unwrap() }
    }

    #[test]
    fn thirty_parameters_take_twelve_lines() {
        let names = ["a x", "a y", "a z", "d x", "d y", "d z", "p x", "p y", "p z", "length"];
        let legs = |most: usize| {
            let of = |leg| names.iter().map(move |name| setting(Some(leg), name, "-0.0001"));
            (1..=most).flat_map(of).collect::<Vec<_>>()
        };
        let text = |machine: &[Setting], verbose| {
            let mut out = String::new();
            machine_of_witness(&mut out, machine, verbose);
            out
        };
        let three = text(&legs(3), false);
        assert_eq!(three.lines().count(), 11, "{three}");
        assert_eq!(three.matches("-0.0001").count(), 30);
        let twelve = text(&legs(12), false);
        assert_eq!(twelve.lines().count(), MOST_LINES, "{twelve}");
        assert!(twelve.ends_with("--verbose\n"), "{twelve}");
        assert_eq!(text(&legs(12), true).matches("-0.0001").count(), 120);
        assert!(twelve.lines().all(|line| line.chars().count() <= WIDTH), "{twelve}");
    }

    #[test]
    fn parameters_without_a_leg_stand_alone() {
        let mut out = String::new();
        machine_of_witness(&mut out, &[setting(None, "l", "200.05")], false);
        assert_eq!(out, "  l             200.05\n");
    }
}
