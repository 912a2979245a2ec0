//! Tests of the reader: designs to vary line by line, and what follows from each variation.

mod accepted;
mod files;
mod formulas;
mod kinds;
mod machines;
mod notation;
mod refused;
mod refused_kinds;
mod refused_numbers;
mod variable;

use super::{document, Defect, Design, DesignError};
use crate::design::description::{Bound, Demand, Mechanism, Workspace};
use crate::design::leg::{Leg, Quantity};
use crate::exact::Exact;

/// An Orthoglide on a box.
const BOX: &str = r#"title = "box"
[mechanism]
kind = "orthoglide"
leg_length = "310.25 ± 0.02"
base = -383.8
offset = 3
[workspace]
min = [-73, -73, -73]
max = [126, 126, 126]
[requirements]
transmission = { min = "1/2", max = 2 }
joint_range = { min = 0, max = 257 }
"#;

/// The Orthoglide of a cube.
const CUBE: &str = r#"title = "cube"
[mechanism]
kind = "orthoglide"
offset = 0
[workspace]
cube = 200
[requirements]
transmission = { max = 2 }
"#;

/// A machine leg by leg.
const LEGS: &str = r#"[mechanism]
kind = "translational"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = [0, "174.75", 0]
platform = [0, 0, 0]
length = "333.0 ± 0.05"
mode = "-"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = ["-174.75*sqrt(3)/2", "-174.75/2", 0]
length = 333
mode = "-"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = ["174.75*sqrt(3)/2", "-174.75/2", 0]
length = 333
mode = "+"
[workspace]
min = [-60, -60, 0]
max = [60, 60, 200]
[requirements]
transmission = { max = 2 }
"#;

/// A rotary Delta.
const ARMS: &str = r#"[mechanism]
kind = "translational"
[[mechanism.legs]]
drive = "arm"
anchor = [6, 0, 0]
axis = [0, -1, 0]
reference = [1, 0, 0]
arm = 10
length = "14 ± 0.001"
platform = [10, 0, 0]
mode = "+"
[[mechanism.legs]]
drive = "arm"
anchor = [-3, "3*sqrt(3)", 0]
axis = ["sqrt(3)/2", "1/2", 0]
reference = ["-1/2", "sqrt(3)/2", 0]
arm = 10
length = 14
platform = [-5, "5*sqrt(3)", 0]
mode = "+"
[[mechanism.legs]]
drive = "arm"
anchor = [-3, "-3*sqrt(3)", 0]
axis = ["-sqrt(3)/2", "1/2", 0]
reference = ["-1/2", "-sqrt(3)/2", 0]
arm = 10
length = 14
platform = [-5, "-5*sqrt(3)", 0]
mode = "+"
[workspace]
cylinder = { center = [0, 1], radius = 3, z = [-14, -12] }
[requirements]
transmission = { max = 20 }
joint_range = { min = -45, max = 120 }
"#;

/// A Tripteron.
const PLANES: &str = r#"[mechanism]
kind = "translational"
[[mechanism.legs]]
drive = "planar"
direction = [1, 0, 0]
[[mechanism.legs]]
drive = "planar"
direction = [0, 1, 0]
[[mechanism.legs]]
drive = "planar"
direction = [0, 0, 1]
[workspace]
min = [0, 0, 0]
max = [1, 1, 1]
[requirements]
transmission = { max = 2 }
"#;

/// Three struts.
const STRUTS: &str = r#"[mechanism]
kind = "translational"
[[mechanism.legs]]
drive = "strut"
anchor = [2, 0, 0]
platform = [1, 0, 0]
[[mechanism.legs]]
drive = "strut"
anchor = [0, 2, 0]
[[mechanism.legs]]
drive = "strut"
anchor = [0, 0, 2]
[workspace]
min = [5, 5, 5]
max = [6, 6, 6]
[requirements]
conditioning = { max = 30 }
"#;

/// `design` with some of its lines, counted from 1, replaced.
fn with(design: &str, changes: &[(usize, &str)]) -> String {
    let line =
        |(i, line)| changes.iter().find(|(at, _)| *at == i + 1).map_or(line, |(_, new)| *new);
    design.lines().enumerate().map(line).collect::<Vec<_>>().join("\n")
}

/// What a design says: legs as they are written, or the offset of the paper's Orthoglide.
#[derive(Debug)]
struct Said {
    legs: Vec<Leg>,
    offset: Option<Exact>,
    workspace: Workspace,
    /// `quantity[leg] given=.. end bound`, one a demand.
    demands: Vec<String>,
}

impl Said {
    /// The demands on a quantity.
    fn of(&self, quantity: &str) -> Vec<&str> {
        let own = self.demands.iter().filter_map(|demand| demand.strip_prefix(quantity));
        own.map(str::trim_start).collect()
    }
}

fn demand(demand: &Demand) -> String {
    let mut out = demand.quantity.to_owned();
    if let Some(leg) = demand.leg {
        out += &format!("[{leg}]");
    }
    for (name, numbers) in &demand.given {
        let numbers: Vec<String> = numbers.iter().map(Exact::to_string).collect();
        out += &format!(" {name}={}", numbers.join(","));
    }
    out + &match &demand.bound {
        Bound::Min(min) => format!(" min {min}"),
        Bound::Max(max) => format!(" max {max}"),
        Bound::Within([min, max]) => format!(" within {min} {max}"),
        Bound::Holds => " holds".to_owned(),
    }
}

fn read(text: &str) -> Said {
    if let Err(error) = Design::parse(text, "test.toml") {
        panic!("{error}\n{text}");
    }
    let text = text.trim_start_matches('\u{feff}');
    let tree = toml::de::DeTable::parse(text).unwrap();
    let document = document::Document { file: "test.toml", text, names: document::Names::None };
    let said = super::description(&document.root(tree.get_ref())).unwrap();
    let (legs, offset) = match said.mechanism {
        Mechanism::Legs { legs, .. } => (legs.into_iter().map(|leg| leg.drive).collect(), None),
        Mechanism::OfCube { offset } => (Vec::new(), Some(offset)),
        Mechanism::Formulas(_) => panic!("formulas: {text}"),
    };
    let demands = said.demands.iter().map(demand).collect();
    Said { legs, offset, workspace: said.workspace, demands }
}

fn refuse(text: &str) -> DesignError {
    match Design::parse(text, "test.toml") {
        Ok(design) => panic!("accepted as {:?}\n{text}", design.claim),
        Err(error) => error,
    }
}

fn number(text: &str) -> Exact {
    Exact::parse(text, 2000).unwrap()
}

fn between(min: &str, max: &str) -> Quantity {
    Quantity { min: number(min), max: number(max) }
}

fn exactly(text: &str) -> Quantity {
    Quantity::exactly(number(text))
}

fn legs(said: &Said) -> &[Leg; 3] {
    said.legs.as_slice().try_into().unwrap()
}

/// One defect: lines changed, and what the one message has to say.
struct Row {
    name: &'static str,
    design: &'static str,
    changes: &'static [(usize, &'static str)],
    line: usize,
    key: &'static str,
    defect: Defect,
    found: &'static str,
    accepted: &'static str,
}

fn check(rows: &[Row]) {
    for row in rows {
        let text = with(row.design, row.changes);
        let error = refuse(&text);
        let context = format!("{}:\n{error}", row.name);
        println!("{context}");
        assert_eq!(error.position().line, row.line, "{context}");
        assert_eq!(error.key(), row.key, "{context}");
        assert_eq!(error.defect(), row.defect, "{context}");
        assert!(error.found().contains(row.found), "{context}");
        assert!(error.accepted().contains(row.accepted), "{context}");
        check_message(&error, &text);
    }
}

/// The message names file, line and key, and marks a place of the line that it shows.
fn check_message(error: &DesignError, text: &str) {
    let message = error.to_string();
    let lines: Vec<&str> = message.lines().collect();
    let [sentence, excerpt, caret] = lines[..] else { panic!("{message}") };
    let key = if error.key().is_empty() { String::new() } else { format!("{}: ", error.key()) };
    let place = format!("{}:{}: {key}found ", error.file(), error.position());
    assert!(sentence.starts_with(&place), "{message}");
    assert!(sentence.contains("; accepted: "), "{message}");
    assert!(error.position().line <= text.lines().count().max(1), "{message}");
    assert!(excerpt.starts_with(&format!("  {} | ", error.position().line)), "{message}");
    assert!(caret.trim_start_matches([' ', '|']).chars().all(|c| c == '^'), "{message}");
    assert!(!message.chars().any(|c| c.is_control() && c != '\n'), "{message}");
    assert!(caret.chars().count() <= excerpt.chars().count() + 1, "{message}");
}
