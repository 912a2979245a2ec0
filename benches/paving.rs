//! How long a paving takes: one cell, a whole paving, and the exact check of it.
//!
//! | benchmark | what is timed                                                                  |
//! |-----------|--------------------------------------------------------------------------------|
//! | `decide`  | what becomes of one cell: inner, outer, and undecided ones                     |
//! | `grow`    | a tree on one core, without the file; elements are boxes                       |
//! | `check`   | the exact check of all leaves, from bytes to verdict; elements are leaves      |

use criterion::{criterion_group, criterion_main, Criterion, Throughput};
use orthocert::design::Design;
use orthocert::search::paving::{header, Decider, Grower, Tally};
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::paving::{check, Cell, Edge, Reader, Root, Subject};
use std::hint::black_box;
use std::sync::atomic::AtomicBool;

/// The Orthoglide with `L = 1` over a box that reaches beyond its region.
const DESIGN: &str = r#"
[mechanism]
kind = "orthoglide"
leg_length = 1
[workspace]
min = [-0.7, -0.7, -0.7]
max = [0.7, 0.7, 0.7]
[requirements]
transmission = { min = "1/2", max = 2 }
"#;

/// Splits of the trees: a gap of about a tenth.
const DEPTH: u32 = 18;

fn claim() -> MachineClaim {
    let design = Design::parse(DESIGN, "bench").expect("a design");
    design.claim
}

fn cell(u: [f64; 3], level: u32) -> Cell {
    let parts = f64::from(level).exp2();
    Cell { edges: u.map(|u| Edge((u * parts) as u64 + (1 << level))), ..Cell::ROOT }
}

fn paving(c: &mut Criterion) {
    let header = header(&claim(), None, DEPTH);
    let subject = Subject::new(&header).expect("a header");
    let decider = Decider::new(&subject).expect("a header");
    let mut group = c.benchmark_group("decide");
    for (name, u) in [
        ("inner", [0.4, 0.5, 0.6]),
        ("outer", [0.05, 0.1, 0.2]),
        // On the diagonal, where sigma_min = 1/2: u = (0.7 - 1/sqrt(18))/1.4.
        ("undecided", [0.331_641, 0.331_641, 0.331_641]),
    ] {
        let cell = cell(u, 8);
        group.bench_function(name, |b| b.iter(|| decider.decide(black_box(&cell), 0, None)));
    }
    group.finish();

    let cancel = AtomicBool::new(false);
    let grower = Grower { decider: &decider, depth: DEPTH, cancel: &cancel };
    let grow = || {
        let (mut bytes, mut tally) = (Vec::new(), Tally::default());
        grower.grow(Root::WHOLE, &mut bytes, &mut tally).expect("not cancelled");
        (bytes, tally)
    };
    let (tree, tally) = grow();
    let mut group = c.benchmark_group("paving");
    group.sample_size(20).throughput(Throughput::Elements(tally.boxes));
    group.bench_function("grow", |b| b.iter(grow));

    let mut file = serde_json::to_vec(&header).expect("a header");
    file.push(b'\n');
    file.extend(tree);
    let mut reader = Reader::new(file.as_slice()).expect("a header");
    while reader.next().expect("a node").is_some() {}
    let summary = reader.summary.clone();
    file.extend(serde_json::to_vec(&summary).expect("a summary"));
    file.push(b'\n');
    group.throughput(Throughput::Elements(summary.inner + summary.outer));
    group.bench_function("check", |b| b.iter(|| check(file.as_slice()).expect("accepted")));
    group.finish();
}

criterion_group!(benches, paving);
criterion_main!(benches);
