//! How many leaves near-tight bounds take: bounds 1 %, 0.1 % and 0.01 % beyond the true extremes of
//! `psi_i`, found by dense sampling and local search. Prints the table of benches/runs:
//! `cargo test --release --test integration leaves -- --nocapture`.

use orthocert::design::Design;
use orthocert::exact::Exact;
use orthocert::sample::{Place, Sampler};
use orthocert::search::{Budget, Control, Progress};
use orthocert::verify::{verify, Answer};
use orthocert_checker::certificate::{Proof, Step};
use orthocert_checker::claim::{MachineClaim, Range};
use orthocert_checker::model::Model;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// A design of tests/designs, its workspace replaced, and the most leaves for each of the three
/// distances.
struct Row {
    name: &'static str,
    design: &'static str,
    workspace: &'static str,
    most: [usize; 3],
}

const ROWS: &[Row] = &[
    Row {
        name: "linear Delta 333 / 174.75, |x|, |y| <= 60",
        design: "linear-delta-klipper-box.toml",
        workspace: "min = [-60, -60, 0]\nmax = [60, 60, 10]",
        most: [52, 116, 178],
    },
    Row {
        name: "linear Delta 333 / 174.75, r <= 80",
        design: "linear-delta-klipper-box.toml",
        workspace: "cylinder = { center = [0, 0], radius = 80, z = [0, 10] }",
        most: [110, 250, 370],
    },
    Row {
        name: "skew guides",
        design: "skew-guides.toml",
        workspace: "min = [-70, -70, -70]\nmax = [90, 90, 90]",
        most: [6, 12, 17],
    },
    Row {
        name: "rotary Delta 10 / 10 / 14 / 6, box",
        design: "rotary-delta-linuxcnc.toml",
        workspace: "min = [-4, -4, -14]\nmax = [4, 4, -11]",
        most: [333, 478, 562],
    },
    Row {
        name: "struts, box",
        design: "upu-struts.toml",
        workspace: "min = [-30, -30, 100]\nmax = [30, 30, 130]",
        most: [80, 156, 184],
    },
];

const BEYOND: [f64; 3] = [0.01, 0.001, 0.0001];
const GRID: usize = 24;

fn claim_of(row: &Row) -> MachineClaim {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs").join(row.design);
    let text = std::fs::read_to_string(path).expect("a design");
    let (machine, _) = text.split_once("[workspace]").expect("a workspace");
    let rest = "[requirements]\ntransmission = { min = \"1/1000\", max = 1000 }";
    let text = format!("{machine}[workspace]\n{}\n{rest}\n", row.workspace);
    Design::parse(&text, row.design).unwrap_or_else(|error| panic!("{error}")).rules.unwrap()
}

/// `(least psi, greatest psi)` on the workspace, in the claim's unit.
fn extremes(claim: &MachineClaim) -> (f64, f64) {
    let model = Model::new(claim, 192).expect("a model");
    let unit = if matches!(claim.mechanism, orthocert_checker::claim::Mechanism::Translational(
        ref legs) if legs[0].is_angular())
    {
        (model.unit_exponent.expect("a unit") as f64).exp2()
    } else {
        1.0
    };
    let sampler = Sampler::new(claim, &model).expect("a sampler");
    let xi = |u: [f64; 3]| {
        let place = Place { u: sampler.within(u), t: Vec::new() };
        let reached = sampler.at(&place).reached.expect("within reach");
        (reached.xi[0], reached.xi[2])
    };
    let grid = (0..(GRID + 1).pow(3)).map(|i| {
        let part = |n: usize| (n % (GRID + 1)) as f64 / GRID as f64;
        [part(i), part(i / (GRID + 1)), part(i / (GRID + 1).pow(2))]
    });
    let grid: Vec<[f64; 3]> = grid.collect();
    let worst = |value: &dyn Fn([f64; 3]) -> f64| {
        let mut starts: Vec<(f64, [f64; 3])> = grid.iter().map(|&u| (value(u), u)).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.iter().take(20).map(|&start| descend(value, start)).fold(f64::MAX, f64::min)
    };
    let least = worst(&|u| xi(u).0);
    let greatest = -worst(&|u| -xi(u).1);
    (unit / greatest, unit / least)
}

/// The least value found by a pattern search from `start`.
fn descend(value: &dyn Fn([f64; 3]) -> f64, start: (f64, [f64; 3])) -> f64 {
    let (mut best, mut at) = start;
    let mut step = 1.0 / GRID as f64;
    while step > 1e-9 {
        let mut improved = false;
        for direction in 1..27 {
            let signs = [direction % 3, direction / 3 % 3, direction / 9];
            let u = std::array::from_fn(|k| {
                let by = [0.0, step, -step][signs[k]];
                (at[k] + by).clamp(0.0, 1.0)
            });
            let found = value(u);
            if found < best {
                (best, at, improved) = (found, u, true);
            }
        }
        if !improved {
            step /= 2.0;
        }
    }
    best
}

/// Leaves, those of them outside the cylinder, and milliseconds.
fn prove(claim: &MachineClaim) -> Option<(usize, usize, f64)> {
    let cancel = AtomicBool::new(false);
    let mut progress = |_: Progress| {};
    let mut control = Control { cancel: &cancel, progress: &mut progress };
    let start = Instant::now();
    let budget = Budget { max_boxes: 50_000, deadline: None };
    let found = verify(claim, budget, &mut control).expect("a claim");
    let time = start.elapsed().as_secs_f64() * 1000.0;
    let Answer::Decided { certificate, .. } = found.answer else { return None };
    let Proof::Tree(tree) = &certificate.proof else { return None };
    let leaves = tree.nodes.iter().filter(|node| node.split.is_none());
    let outside = leaves.clone().filter(|node| node.by.contains(&Step::Outside)).count();
    Some((leaves.count(), outside, time))
}

fn rounded(x: f64) -> Exact {
    Exact::parse(&format!("{x:.12}"), 1000).expect("a number")
}

#[test]
fn near_tight_bounds_take_few_leaves() {
    let mut slow = Vec::new();
    println!("| machine | beyond | psi_min | psi_max | leaves | of these outside | ms |");
    println!("|---|---|---|---|---|---|---|");
    for row in ROWS {
        let mut claim = claim_of(row);
        let (least, greatest) = extremes(&claim);
        for (beyond, most) in BEYOND.iter().zip(row.most) {
            let (min, max) = (least / (1.0 + beyond), greatest * (1.0 + beyond));
            let range = Range { min: Some(rounded(min)), max: Some(rounded(max)) };
            claim.requirements.transmission = Some(range);
            let proved = prove(&claim);
            let (leaves, outside, time) = proved.unwrap_or((usize::MAX, 0, 0.0));
            println!(
                "| {} | {} % | {min:.6} | {max:.6} | {leaves} | {outside} | {time:.1} |",
                row.name,
                beyond * 100.0
            );
            if leaves > most {
                slow.push(format!("{} at {beyond}: {leaves}, {most} expected", row.name));
            }
        }
    }
    assert!(slow.is_empty(), "{}", slow.join("\n"));
}
