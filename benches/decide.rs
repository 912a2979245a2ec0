//! What verdicts cost: designs with one bound 0.1 % inside an extreme, or beyond it.
//!
//! `cargo bench --bench decide -- [DESIGNS] [BOXES] [PARTS]` draws machines, workspaces, tolerances and
//! quantities, finds an extreme by random ascents, which share nothing with the prover's, puts the bound
//! 0.1 % (one of 1000 parts; of accuracies ten) inside, and refutes; or, of fewer than no parts, beyond, and
//! certifies. Told of each kind of optimum: designs, how many were not decided so, how many needed boxes,
//! the processor time of the thread, median and greatest, and leaves. With `ORTHOCERT_SHOW=1` the slow ones follow.

use num_rational::BigRational;
use num_traits::FromPrimitive;
use orthocert::design::Design;
use orthocert::exact::arithmetic::number;
use orthocert::search::solver::sample::{Place, Quality, Sampler};
use orthocert::search::solver::value::Bounded;
use orthocert::search::solver::{verify, Answer};
use orthocert::search::{Budget, Control};
use orthocert_checker::certificate::Verdict;
use orthocert_kernel::claim::{Bound, MachineClaim};
use orthocert_kernel::problem::Problem;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

/// What bounds are inside by.
const INSIDE: f64 = 1e-3;
/// Random places, ascents from the best of them, and steps of one.
const PLACES: usize = 1500;
const ASCENTS: usize = 10;
const STEPS: usize = 500;
/// Slower refutations, in seconds, are shown.
const SLOW: f64 = 0.05;

/// Always the same numbers.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn from(&mut self, least: f64, greatest: f64) -> f64 {
        least + (greatest - least) * self.unit()
    }

    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    /// A number in a design, of three decimals.
    fn told(&mut self, least: f64, greatest: f64) -> String {
        format!("{:.3}", self.from(least, greatest))
    }

    /// The same, or with a tolerance of at most so much.
    fn built(&mut self, value: f64, tolerance: Option<f64>) -> String {
        match tolerance {
            Some(most) => format!("\"{value:.3} ± {:.4}\"", self.from(0.2 * most, most)),
            None => format!("{value:.3}"),
        }
    }

    fn part(&mut self) -> f64 {
        match self.below(4) {
            0 => 0.0,
            1 => 1.0,
            _ => self.unit(),
        }
    }
}

fn on_circle(radius: f64, degrees: f64) -> [f64; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [radius * cos, radius * sin]
}

/// The mechanism and the workspace of a machine, and the kind of quantities that it has.
fn drawn(random: &mut Random, toleranced: bool) -> (&'static str, String) {
    let tolerance = |most| toleranced.then_some(most);
    let around = |random: &mut Random, half: f64, z: [f64; 2]| {
        let half = random.from(0.4 * half, half);
        if random.below(2) == 0 {
            let (x, y) = (random.told(-half, 0.3 * half), random.told(-half, 0.3 * half));
            format!(
                "[workspace]\nmin = [{x}, {y}, {:.3}]\nmax = [{half:.3}, {half:.3}, {:.3}]\n",
                z[0], z[1]
            )
        } else {
            let centre = [random.told(-20.0, 20.0), random.told(-20.0, 20.0)].join(", ");
            format!(
                "[workspace]\ncylinder = {{ center = [{centre}], radius = {half:.3}, z = [{:.3}, {:.3}] }}\n",
                z[0], z[1]
            )
        }
    };
    let mut text = String::from("[mechanism]\n");
    let family = match random.below(8) {
        0 | 1 => {
            let radius = random.from(100.0, 200.0);
            let length = radius * random.from(1.6, 2.4);
            text += "kind = \"translational\"\n";
            for i in 0..3 {
                let off = if random.below(2) == 0 { 0.0 } else { random.from(-10.0, 10.0) };
                let [x, y] = on_circle(radius, 90.0 + 120.0 * f64::from(i) + off);
                let length = random.built(length, tolerance(0.3));
                let (x, y) = (random.built(x, tolerance(0.2)), random.built(y, tolerance(0.2)));
                text += &format!("[[mechanism.legs]]\ndrive = \"slider\"\ndirection = [0, 0, 1]\nanchor = [{x}, {y}, 0]\nlength = {length}\nmode = \"-\"\n");
            }
            text += &around(random, 0.62 * (length - radius), [0.0, 50.0]);
            "linear Delta"
        }
        2 => {
            let length = random.built(310.0, tolerance(0.2));
            text += &format!("kind = \"orthoglide\"\nleg_length = {length}\nbase = -384\n");
            let [a, b, c] = [(); 3].map(|()| random.told(-100.0, -30.0));
            let [d, e, f] = [(); 3].map(|()| random.told(40.0, 130.0));
            text += &format!("[workspace]\nmin = [{a}, {b}, {c}]\nmax = [{d}, {e}, {f}]\n");
            "Orthoglide"
        }
        3 => {
            text += "kind = \"translational\"\n";
            for i in 0..3 {
                let off = random.from(-15.0, 15.0);
                let radius = random.from(260.0, 340.0);
                let [x, y] = on_circle(radius, 90.0 + 120.0 * f64::from(i) + off);
                let (x, y) = (random.built(x, tolerance(0.3)), random.built(y, tolerance(0.3)));
                text += &format!(
                    "[[mechanism.legs]]\ndrive = \"strut\"\nanchor = [{x}, {y}, {}]\n",
                    random.told(-10.0, 10.0)
                );
            }
            let z = random.from(150.0, 220.0);
            let top = z + random.from(20.0, 80.0);
            text += &around(random, 100.0, [z, top]);
            "struts"
        }
        4 => {
            text += "kind = \"translational\"\n";
            let (arm, length) = (random.from(90.0, 110.0), random.from(200.0, 260.0));
            for i in 0..3 {
                let turn = 120.0 * f64::from(i);
                let ([x, y], [s, t]) = (on_circle(60.0, turn), on_circle(1.0, turn));
                let (arm, length) =
                    (random.built(arm, tolerance(0.1)), random.built(length, tolerance(0.1)));
                text += &format!("[[mechanism.legs]]\ndrive = \"arm\"\nanchor = [{x:.6}, {y:.6}, 0]\naxis = [{:.6}, {s:.6}, 0]\nreference = [{s:.6}, {t:.6}, 0]\narm = {arm}\nlength = {length}\nplatform = [{:.6}, {:.6}, 0]\nmode = \"+\"\n", -t, 0.3 * x, 0.3 * y);
            }
            let z = random.from(-250.0, -215.0);
            let top = z + random.from(10.0, 40.0);
            text += &around(random, 60.0, [z, top]);
            "rotary Delta"
        }
        5 => {
            text += "kind = \"planar\"\ncharacteristic_length = 100\n";
            for i in 0..3 {
                let turn = 90.0 + 120.0 * f64::from(i);
                let [x, y] = on_circle(random.from(350.0, 450.0), turn + random.from(-10.0, 10.0));
                let [s, t] = on_circle(random.from(80.0, 120.0), turn - random.from(50.0, 70.0));
                let (x, y) = (random.built(x, tolerance(0.2)), random.built(y, tolerance(0.2)));
                text += &format!("[[mechanism.legs]]\ndrive = \"strut\"\nanchor = [{x}, {y}]\nplatform = [{s:.3}, {t:.3}]\n");
            }
            let [a, b, c, d] = [(); 4].map(|()| random.told(20.0, 60.0));
            let [e, f] = [(); 2].map(|()| random.told(5.0, 20.0));
            text += &format!("[workspace]\nmin = [-{a}, -{b}]\nmax = [{c}, {d}]\norientation = {{ angle = [-{e}, {f}] }}\n");
            "planar"
        }
        6 => {
            text += "kind = \"spherical\"\ncharacteristic_length = 100\n";
            for i in 0..3 {
                let turn = 120.0 * f64::from(i);
                let [x, y] = on_circle(random.from(130.0, 170.0), turn + random.from(-8.0, 8.0));
                let [s, t] = on_circle(random.from(90.0, 110.0), turn + random.from(80.0, 100.0));
                let (x, y) = (random.built(x, tolerance(0.1)), random.built(y, tolerance(0.1)));
                let z = random.told(130.0, 170.0);
                text += &format!("[[mechanism.legs]]\ndrive = \"strut\"\nanchor = [{x}, {y}, -{z}]\nplatform = [{s:.3}, {t:.3}, 0]\n");
            }
            text += match random.below(3) {
                0 => "[workspace]\norientation = { angle = 15 }\n",
                1 => "[workspace]\norientation = { tilt = 20, torsion = 15 }\n",
                _ => "[workspace]\norientation = { roll = [-15, 14], pitch = [-13, 15], yaw = [-14, 12] }\n",
            };
            "spherical"
        }
        _ => {
            text += "kind = \"spatial\"\ncharacteristic_length = 100\n";
            for i in 0..6u8 {
                let side = if i % 2 == 0 { 1.0 } else { -1.0 };
                let third = 120.0 * f64::from(i / 2);
                let [x, y] = on_circle(200.0, third + side * random.from(8.0, 14.0));
                let [s, t] = on_circle(110.0, third + side * random.from(40.0, 50.0));
                let (x, y) = (random.built(x, tolerance(0.1)), random.built(y, tolerance(0.1)));
                text += &format!("[[mechanism.legs]]\ndrive = \"strut\"\nanchor = [{x}, {y}, 0]\nplatform = [{s:.3}, {t:.3}, 0]\n");
            }
            let z = random.from(150.0, 220.0);
            text += &around(random, 30.0, [z, z + 20.0]);
            text += match random.below(3) {
                0 => "orientation = { angle = 5 }\n",
                1 => "orientation = { tilt = 6, torsion = 4 }\n",
                _ => "orientation = { roll = [-5, 4], pitch = [-3, 5], yaw = [-4, 4] }\n",
            };
            "hexapod"
        }
    };
    (family, text)
}

/// A requirement that every machine of the family may be asked for.
fn asked(random: &mut Random, family: &str, toleranced: bool) -> &'static str {
    let psi = [
        "transmission = { max = 2 }",
        "transmission = { min = \"1/2\" }",
        "transmission = { min = \"1/2\", max = 2 }",
        "conditioning = { max = 2 }",
    ];
    let turned = ["stiffness = { joint = 50, min = 20 }"];
    let translational = [
        "joint_range = { max = 200 }",
        "joint_range = { min = 200 }",
        "joint_speed = { tool = 100, max = 200 }",
        "joint_force = { tool = 100, max = 200 }",
        "stiffness = { joint = 50, min = 20 }",
        "joint_acceleration = { speed = 1200, acceleration = 14000, max = 40000 }",
    ];
    let sliders = [
        "serial_margin = { min = \"1/2\" }",
        "parallel_margin = { min = \"1/2\" }",
        "leg_angle = { max = 50 }",
    ];
    let accuracy = ["accuracy = { joint_error = 0.05, max = 1 }"];
    let mut all = psi.to_vec();
    if matches!(family, "hexapod" | "planar" | "spherical") {
        all.extend(turned);
    } else {
        all.extend(translational);
        all.extend(accuracy.iter().filter(|_| toleranced));
    }
    if matches!(family, "linear Delta" | "Orthoglide") {
        all.extend(sliders);
    }
    if family == "rotary Delta" {
        all.retain(|one| !one.starts_with("joint_range"));
    }
    all[random.below(all.len())]
}

/// The least margin of an obligation, by random ascents.
fn least(random: &mut Random, sampler: &Sampler<'_>, quality: Quality) -> Place {
    let centre = sampler.centre();
    let margin = |place: &Place| sampler.margin(quality, &sampler.at(place));
    let mut starts: Vec<(f64, Place)> = (0..PLACES)
        .map(|_| {
            let mut place = centre.clone();
            place.u.iter_mut().chain(&mut place.t).for_each(|x| *x = random.part());
            (margin(&place), place)
        })
        .collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.truncate(ASCENTS);
    for (known, place) in &mut starts {
        let mut size = 0.2;
        for _ in 0..STEPS {
            let mut next = place.clone();
            let some = random.unit();
            for x in next.u.iter_mut().chain(&mut next.t) {
                if random.unit() < some {
                    let step = size * (random.unit() + random.unit() + random.unit() - 1.5);
                    *x = (*x + step).clamp(0.0, 1.0);
                }
            }
            let found = margin(&next);
            let better = found < *known;
            size = (size * if better { 1.5 } else { 0.92 }).clamp(1e-7, 0.3);
            if better {
                (*known, *place) = (found, next);
            }
        }
    }
    starts.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("some").1
}

/// Whether a machine is regular wherever it is looked at.
fn is_regular(random: &mut Random, sampler: &Sampler<'_>) -> bool {
    let general = sampler.qualities().into_iter();
    let general: Vec<Quality> = general.filter(|q| !matches!(q, Quality::Obligation(_))).collect();
    (0..300).all(|_| {
        let mut place = sampler.centre();
        place.u.iter_mut().chain(&mut place.t).for_each(|x| *x = random.part());
        let values = sampler.at(&place);
        sampler.matrix(&values).is_some()
            && general.iter().all(|&quality| sampler.margin(quality, &values) > 0.0)
    })
}

/// The claim with the bound of its first requirement.
fn bounded(claim: &MachineClaim, bound: f64) -> Option<MachineClaim> {
    let mut claim = claim.clone();
    let billionths = BigRational::from_f64((bound * 1e9).round())?;
    let bound = number(&(billionths / BigRational::from_integer(1_000_000_000.into())));
    let first = claim.require.first_mut()?;
    first.bound = match &first.bound {
        Bound::Min(_) => Bound::Min(bound),
        Bound::Max(_) => Bound::Max(bound),
        Bound::Within(_) | Bound::Holds => return None,
    };
    Some(claim)
}

/// A claim that is refutable by `inside`, or holds by that with the other sign, and on how many ends of the
/// workspace its extreme is.
fn bounded_by(
    random: &mut Random,
    claim: &MachineClaim,
    inside: f64,
) -> Option<(MachineClaim, Place, String)> {
    let mut claim = claim.clone();
    let mut found = None;
    for _ in 0..2 {
        let problem = Problem::new(&claim).ok()?;
        let sampler = Sampler::new(&claim, &problem).ok()?;
        if !is_regular(random, &sampler) {
            return None;
        }
        let own = problem.obligations.iter().enumerate();
        let own = own.filter(|(_, own)| own.requirement == Some(0)).map(|(number, _)| number);
        let worst = own.filter_map(|number| {
            let place = least(random, &sampler, Quality::Obligation(number));
            let bounded = Bounded::of(&claim, &problem, number)?;
            let value = bounded.value(&claim, &problem, &sampler, &place)?;
            let centre = bounded.value(&claim, &problem, &sampler, &sampler.centre())?;
            Some((value, centre, place))
        });
        let is_least = matches!(claim.require[0].bound, Bound::Min(_));
        let beyond = |a: &f64, b: &f64| if is_least { a.total_cmp(b) } else { b.total_cmp(a) };
        let (value, centre, place) = worst.min_by(|a, b| beyond(&a.0, &b.0))?;
        // Witnesses against an accuracy have to overcome what is not of first order.
        let part = inside * if claim.require[0].quantity == "accuracy" { 10.0 } else { 1.0 };
        let by = if claim.require[0].quantity == "joint_range" { value - centre } else { value };
        let inside = by.abs() * part * if is_least { 1.0 } else { -1.0 };
        let kind = kind(&claim, &sampler, &place);
        claim = bounded(&claim, value)?;
        found = Some((bounded_inside(&claim, value + inside)?, place, kind));
    }
    found
}

fn bounded_inside(claim: &MachineClaim, bound: f64) -> Option<MachineClaim> {
    let claim = bounded(claim, bound)?;
    Problem::new(&claim).is_ok().then_some(claim)
}

/// Where an optimum is, by how many coordinates are at an end.
fn kind(claim: &MachineClaim, sampler: &Sampler<'_>, place: &Place) -> String {
    let u = sampler.parts(&place.u);
    let end = |x: f64| !(1e-3..=1.0 - 1e-3).contains(&x);
    let ends = u.iter().filter(|&&x| end(x)).count();
    let curved = matches!(claim.workspace, orthocert_kernel::claim::Workspace::Cylinder { .. });
    let radius = (2.0 * u[0] - 1.0).hypot(2.0 * u[1] - 1.0);
    let bound = if curved && radius > 0.999 && !end(u[0]) && !end(u[1]) { ends + 1 } else { ends };
    match (u.len(), bound) {
        (_, 0) => "inside".to_owned(),
        (3, 1) => "face".to_owned(),
        (3, 2) => "edge".to_owned(),
        (3, _) => "corner".to_owned(),
        (_, n) => format!("six, {n} ends"),
    }
}

/// Seconds of this thread on a processor; what is told is brought up to date when it yields.
fn processor_time() -> f64 {
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|x| x.parse::<f64>().ok()).unwrap_or(0.0) / 1e9
}

fn main() {
    let numbers: Vec<i32> = std::env::args().filter_map(|x| x.parse().ok()).collect();
    let whole = |at: usize, otherwise: usize| {
        numbers.get(at).map_or(otherwise, |&n| usize::try_from(n).expect("a number of things"))
    };
    let (designs, max_boxes) = (whole(0, 500), whole(1, 2000));
    let inside = numbers.get(2).map_or(INSIDE, |&n| 1.0 / f64::from(n));
    let show = std::env::var_os("ORTHOCERT_SHOW").is_some();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    pool.install(|| run(designs, max_boxes, inside, show));
}

fn run(designs: usize, max_boxes: usize, inside: f64, show: bool) {
    let mut random = Random(1);
    let mut all: BTreeMap<String, Vec<(f64, usize, Option<usize>)>> = BTreeMap::new();
    let expected = if inside > 0.0 { Verdict::Refuted } else { Verdict::Certified };
    let mut count = 0;
    while count < designs {
        let toleranced = random.below(2) == 0;
        let (family, text) = drawn(&mut random, toleranced);
        let asked = asked(&mut random, family, toleranced);
        let text = format!("{text}[requirements]\n{asked}\n");
        let design = match Design::parse(&text, "drawn") {
            Ok(design) => design,
            Err(error) => panic!("{error}\n{text}"),
        };
        let mut claim = design.claim;
        if claim.require.len() == 2 && random.below(2) == 0 {
            claim.require.swap(0, 1);
        }
        // The other end is no limit.
        if let Some(other) = claim.require.get_mut(1).filter(|_| asked.starts_with("tr")) {
            other.bound = match &other.bound {
                Bound::Min(_) => Bound::Min(number(&BigRational::new(1.into(), 1000.into()))),
                _ => Bound::Max(number(&BigRational::from_integer(1_000_000.into()))),
            };
        }
        let Some((claim, place, kind)) = bounded_by(&mut random, &claim, inside) else { continue };
        count += 1;
        let cancel = AtomicBool::new(false);
        let budget = Budget { max_boxes, deadline: None };
        let before = processor_time();
        let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
        let found = verify(&claim, budget, &mut control).expect("a claim");
        let time = processor_time() - before;
        // Of an ascent that stopped short of the extreme, what is beyond it may be inside.
        let leaves = match &found.answer {
            Answer::Decided { accepted, .. } => {
                assert!(accepted.verdict == expected || inside < 0.0, "{text}");
                Some(accepted.size.leaves).filter(|_| accepted.verdict == expected)
            }
            _ => None,
        };
        if show && (leaves.is_none() || time > SLOW && inside > 0.0) {
            println!("{count}: {family}, {kind}: {asked}: {time:.3} s, {} boxes, leaves: {leaves:?}, {:?} {:?} bound {:?}", found.boxes, place.u, place.t, claim.require[0].bound);
            println!(
                "    found {:?}",
                found
                    .worst
                    .iter()
                    .map(|w| (w.margin, w.quality, w.place.u.clone()))
                    .collect::<Vec<_>>()
            );
        }
        let tolerance = if toleranced { "tolerances" } else { "nominal" };
        for key in [
            kind,
            family.to_owned(),
            asked.split(" =").next().unwrap_or("").to_owned(),
            tolerance.to_owned(),
            " all".to_owned(),
        ] {
            all.entry(key).or_default().push((time, found.boxes, leaves));
        }
    }
    println!(
        "{:20} {:>7} {:>11} {:>10} {:>10} {:>12} {:>7} {:>8}",
        "",
        "designs",
        "not decided",
        "with boxes",
        "median, ms",
        "greatest, ms",
        "leaves",
        "greatest"
    );
    for (key, mut found) in all {
        let not = found.iter().filter(|one| one.2.is_none()).count();
        let boxes = found.iter().filter(|one| one.1 > 0).count();
        let mut leaves: Vec<usize> = found.iter().filter_map(|one| one.2).collect();
        leaves.sort_unstable();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (median, most) = (found[found.len() / 2].0, found[found.len() - 1].0);
        let (middle, last) = (leaves.get(leaves.len() / 2), leaves.last());
        println!(
            "{key:20} {:7} {not:11} {boxes:10} {:10.1} {:12.1} {:7} {:8}",
            found.len(),
            1e3 * median,
            1e3 * most,
            middle.copied().unwrap_or(0),
            last.copied().unwrap_or(0)
        );
    }
}
