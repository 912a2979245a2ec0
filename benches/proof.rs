//! How long a proof takes: the search per box, whole verifications, and the exact check.
//!
//! | benchmark    | what is timed                                                                |
//! |--------------|------------------------------------------------------------------------------|
//! | `*/baseline` | what any method computes at a box: `M` and its singular values at one point, |
//! |              | in doubles, without any proof                                                |
//! | `search/*`   | the search on one core; elements are boxes tried                             |
//! | `verify/*`   | claim to accepted certificate, the exact check included                      |
//! | `check/*`    | the exact check, text to verdict; elements are leaves                        |
//!
//! `runs/` holds raw figures with the machine they were taken on. Times of different runs are
//! compared as multiples of the baseline of the same group.

use criterion::measurement::WallTime;
use criterion::{criterion_group, criterion_main, BenchmarkGroup, Criterion, Throughput};
use orthocert::design::Design;
use orthocert::search::accepted::check;
use orthocert::search::solver::sample::{Place, Sampler};
use orthocert::search::solver::search::{Branch, Outcome};
use orthocert::search::solver::{below, verify, Answer};
use orthocert::search::{Budget, Control};
use orthocert_checker::read;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::problem::Problem;
use std::hint::black_box;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const BUDGET: Budget = Budget { max_boxes: 100_000, deadline: None };

/// A linear Delta with bounds 0.1 % beyond its extremes: evidence matters, trees are larger.
const LINEAR_DELTA: &str = r#"
[mechanism]
kind = "translational"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = [0, 174.75, 0]
length = 333
mode = "-"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = [-139.8, -104.85, 0]
length = 333
mode = "-"
[[mechanism.legs]]
drive = "slider"
direction = [0, 0, 1]
anchor = [139.8, -104.85, 0]
length = 333
mode = "-"
[workspace]
min = [-60, -60, -5]
max = [60, 60, 5]
[requirements]
transmission = { min = 0.5129, max = 1.5134 }
"#;

fn claim_of(design: Design) -> MachineClaim {
    design.claim
}

fn claims() -> [(&'static str, MachineClaim); 3] {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs");
    let read = |name| Design::read(&folder.join(name)).expect("a design of the tests");
    let delta = Design::parse(LINEAR_DELTA, "linear-delta").expect("the design above");
    [
        ("prototype", claim_of(read("orthoglide-prototype.toml"))),
        ("relaxed-0.1-percent", claim_of(read("orthoglide-relaxed-0.1-percent.toml"))),
        ("linear-delta-0.1-percent", claim_of(delta)),
    ]
}

fn controlled<T>(run: impl FnOnce(&mut Control<'_>) -> T) -> T {
    let cancel = AtomicBool::new(false);
    run(&mut Control { cancel: &cancel, progress: &mut |_| {} })
}

/// The tree below the root, from the claim.
fn searched(claim: &MachineClaim, whole: &Branch) -> Outcome {
    let found = controlled(|control| below(claim, whole, BUDGET, control));
    found.expect("a well-formed claim").expect("the root is a box of the tree")
}

/// The text of the certificate that certifies a claim.
fn certificate(claim: &MachineClaim) -> String {
    let found = controlled(|control| verify(claim, BUDGET, control)).expect("a well-formed claim");
    match found.answer {
        Answer::Decided { certificate, .. } => certificate.to_text().expect("a text"),
        other => panic!("undecided: {other:?}"),
    }
}

/// Times `M` and its singular values at one point in doubles: next to each group, since the speed
/// of a machine drifts.
fn baseline(group: &mut BenchmarkGroup<'_, WallTime>) {
    let [(_, claim), ..] = claims();
    let problem = Problem::new(&claim).expect("a well-formed claim");
    let sampler = Sampler::new(&claim, &problem).expect("numbers in doubles");
    let place = Place { u: vec![0.4, 0.5, 0.6], t: Vec::new() };
    group.throughput(Throughput::Elements(1));
    let at = |place| sampler.xi(&sampler.at(place));
    group.bench_function("baseline", |b| b.iter(|| at(black_box(&place))));
}

fn search_on_one_core(c: &mut Criterion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    let mut group = c.benchmark_group("search");
    baseline(&mut group);
    for (name, claim) in claims() {
        let obligations = Problem::new(&claim).expect("a well-formed claim").obligations.len();
        let whole = Branch { path: Vec::new(), open: (0..obligations).collect() };
        let boxes = searched(&claim, &whole).boxes;
        group.throughput(Throughput::Elements(boxes as u64));
        group.bench_function(name, |b| {
            pool.install(|| b.iter(|| searched(black_box(&claim), &whole)));
        });
    }
    group.finish();
}

fn whole_verification(c: &mut Criterion) {
    let mut group = c.benchmark_group("verify");
    baseline(&mut group);
    group.throughput(Throughput::Elements(1));
    for (name, claim) in claims() {
        group.bench_function(name, |b| {
            b.iter(|| controlled(|control| verify(black_box(&claim), BUDGET, control)));
        });
    }
    group.finish();
}

fn exact_check(c: &mut Criterion) {
    let mut group = c.benchmark_group("check");
    baseline(&mut group);
    for (name, claim) in claims() {
        let text = certificate(&claim);
        let run = |text: &str| check(&read(text.as_bytes()).expect("a certificate"));
        let leaves = run(&text).expect("an accepted certificate").size.leaves;
        group.throughput(Throughput::Elements(leaves as u64));
        group.bench_function(name, |b| b.iter(|| run(black_box(&text))));
    }
    group.finish();
}

criterion_group!(benches, search_on_one_core, whole_verification, exact_check);
criterion_main!(benches);
