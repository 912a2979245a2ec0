//! What the formal development is held against: certificates that it re-checks, and values that it
//! computes again. With `ORTHOCERT_WRITE` set, the files in `proofs/rocq/instances` are written anew.

use crate::arithmetic::Random;
use crate::certificates::claim;
use crate::postulate;
use crate::prover::certify;
use num_bigint::BigInt;
use num_integer::Integer as _;
use orthocert_kernel::arithmetic::{Arithmetic as _, Enclosure as _};
use orthocert_kernel::cell::Cell;
use orthocert_kernel::certificate::{Certificate, Evidence};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::{Every, PostulateClaim, PsiMax};
use orthocert_kernel::definite::{is_positive_definite, Triangle};
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::formula::Tape;
use orthocert_kernel::postulate::parts;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::slope::{evaluate, Slopes};
use std::fmt::Write;

fn slider(x: &str, y: &str) -> String {
    format!(
        r#"{{"drive":"slider","direction":["0","0","1"],"anchor":["{x}","{y}",{{"min":"-0.1","max":"0.1"}}],"platform":["0","0","0"],"length":{{"min":"332.9","max":"333.1"}},"mode":"-"}}"#
    )
}

/// Four sliders on the corners of a square, one leg more than coordinates, within tolerances.
fn four_sliders() -> String {
    let anchors = [("-124", "-124"), ("124", "-124"), ("124", "124"), ("-124", "124")];
    let legs = anchors.map(|(x, y)| slider(x, y)).join(",");
    format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["-60","-60","0"],"max":["60","60","200"]}}}},"require":[{{"quantity":"transmission","end":"min","bound":"9/20"}},{{"quantity":"transmission","end":"max","bound":"6/5"}},{{"quantity":"joint_range","leg":1,"end":"min","bound":"200"}}]}}"#
    )
}

/// Three struts with irrational anchors, and a plane moved along a skew normal.
fn struts_and_a_plane() -> String {
    let strut = |anchor: &str| {
        format!(r#"{{"drive":"strut","anchor":[{anchor}],"platform":["0","0","10"]}}"#)
    };
    let legs = [
        strut(r#""-150*sqrt(3)","-150",{"min":"-1/10","max":"1/10"}"#),
        strut(r#""150*sqrt(3)","-150","0""#),
        strut(r#""0","300","0""#),
        r#"{"drive":"planar","direction":["1","2",{"min":"1.99","max":"2.01"}]}"#.to_owned(),
    ]
    .join(",");
    format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["-40","-40","180"],"max":["40","40","240"]}}}},"require":[{{"quantity":"transmission","end":"min","bound":"2/3"}},{{"quantity":"transmission","end":"max","bound":"23/20"}},{{"quantity":"joint_range","leg":4,"end":"max","bound":"250"}}]}}"#
    )
}

/// An Orthoglide, the length of each leg within a tolerance of its own.
fn orthoglide_within_tolerances() -> String {
    let leg = |direction: &str| {
        format!(
            r#"{{"drive":"slider","direction":[{direction}],"anchor":["0","0","0"],"platform":["0","0","0"],"length":{{"min":"311.3","max":"311.7"}},"mode":"+"}}"#
        )
    };
    let legs = [r#""1","0","0""#, r#""0","1","0""#, r#""0","0","1""#].map(leg).join(",");
    format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["-73.2","-73.2","-73.2"],"max":["126.8","126.8","126.8"]}}}},"require":[{{"quantity":"transmission","end":"min","bound":"1/2"}},{{"quantity":"transmission","end":"max","bound":"2"}}]}}"#
    )
}

/// A linear Delta: three parallel guides, at points of a circle.
fn linear_delta() -> String {
    let leg = |x: &str, y: &str| {
        format!(
            r#"{{"drive":"slider","direction":["0","0","1"],"anchor":["{x}","{y}","0"],"platform":["0","0","0"],"length":"333","mode":"-"}}"#
        )
    };
    let anchors = [("0", "174.75"), ("-139.8", "-104.85"), ("139.8", "-104.85")];
    let legs = anchors.map(|(x, y)| leg(x, y)).join(",");
    format!(
        r#"{{"mechanism":{{"translational":[{legs}]}},"workspace":{{"box":{{"min":["-60","-60","0"],"max":["60","60","200"]}}}},"require":[{{"quantity":"transmission","end":"min","bound":"1/2"}},{{"quantity":"transmission","end":"max","bound":"8/5"}}]}}"#
    )
}

/// The claims of the instances, by their names.
fn instances() -> [(&'static str, String); 4] {
    [
        ("FourSliders", four_sliders()),
        ("StrutsAndPlane", struts_and_a_plane()),
        ("OrthoglideTolerance", orthoglide_within_tolerances()),
        ("LinearDelta", linear_delta()),
    ]
}

fn path(file: &str) -> String {
    format!("{}/../rocq/instances/{file}", env!("CARGO_MANIFEST_DIR"))
}

/// The committed file; written first, if asked for.
fn committed(file: &str, text: impl FnOnce() -> String) -> String {
    if std::env::var_os("ORTHOCERT_WRITE").is_some() {
        std::fs::write(path(file), text()).expect("written");
    }
    std::fs::read_to_string(path(file)).expect("committed")
}

#[test]
fn certificates_of_instances_are_accepted() {
    for (name, text) in instances() {
        let proved = || {
            let certificate = certify(&claim(&text), 2_000).expect("a proof");
            certificate.to_text().expect("a text")
        };
        let certificate = Certificate::read(&committed(&format!("{name}.cert.json"), proved));
        check(&certificate.expect("canonical")).expect("accepted");
    }
    for (name, psi_max) in [("PostulateAll", r#""all""#), ("PostulateUpTo2", r#""2""#)] {
        let proved = || postulate::accepted(psi_max).to_text().expect("a text");
        let certificate = Certificate::read(&committed(&format!("{name}.cert.json"), proved));
        check(&certificate.expect("canonical")).expect("accepted");
    }
}

/// A number from many, of which all depends.
struct Digest(BigInt);

impl Digest {
    fn add(&mut self, x: &BigInt) {
        let modulus: BigInt = BigInt::from(1) << 127;
        let next: BigInt = &self.0 * 1_000_003 + x;
        self.0 = next.mod_floor(&modulus);
    }

    fn add_interval(&mut self, x: Option<&Interval<BigInt>>) {
        match x {
            Some(x) => [&x.lo, &x.hi].into_iter().for_each(|x| self.add(x)),
            None => self.add(&BigInt::from(7)),
        }
    }
}

/// Numbers that both sides draw: of Knuth's generator the upper bits.
struct Draw(u64);

impl Draw {
    fn below(&mut self, n: u64) -> i64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }

    fn interval(&mut self, low: i64, width: u64) -> Interval<BigInt> {
        let (a, b) = (low + self.below(width), low + self.below(width));
        Interval { lo: a.min(b).into(), hi: a.max(b).into() }
    }
}

/// The operations of ten bits on numbers of either sign, and definiteness.
fn operations() -> [BigInt; 2] {
    let fixed = Fixed::<BigInt>::new(10);
    let (mut draw, mut digest) = (Draw(1), Digest(BigInt::from(0)));
    for _ in 0..200 {
        let (a, b, c) =
            (draw.interval(-1500, 3000), draw.interval(-1500, 3000), draw.interval(1, 2000));
        digest.add_interval(fixed.mul(&a, &b).as_ref());
        digest.add_interval(fixed.sqr(&a).as_ref());
        digest.add_interval(fixed.recip(&a).as_ref());
        digest.add_interval(fixed.sqrt(&a).as_ref());
        digest.add_interval(fixed.halve(&a).as_ref());
        digest.add_interval(fixed.dyadic(draw.below(2000) - 1000, 7, &a).as_ref());
        digest.add_interval(fixed.ratio(&a, &b, &c).as_ref());
    }
    let mut definite = Digest(BigInt::from(0));
    for _ in 0..100 {
        let mut matrix = Vec::new();
        for i in 0..4 {
            let mut row = vec![draw.interval(1800, 1500)];
            row.extend((i + 1..4).map(|_| draw.interval(-900, 1800)));
            matrix.push(row);
        }
        let matrix = Triangle::new(4, |i, j| Some(matrix[i][j - i].clone())).unwrap();
        definite.add(&i32::from(is_positive_definite(&fixed, &matrix)).into());
    }
    [digest.0, definite.0]
}

/// What is shown of cells of the postulate's faces, in twelve bits.
fn faces() -> BigInt {
    let fixed = Fixed::<BigInt>::new(12);
    let (mut draw, mut digest) = (Draw(1), Digest(BigInt::from(0)));
    let all = parts(&PostulateClaim { psi_max: PsiMax::Every(Every::All) }).expect("well formed");
    for (number, part) in all.iter().enumerate() {
        for _ in 0..100 {
            let ranges = [(0, 3400, 700), (0, 3400, 700), (number as i64 % 2 * 2048, 1400, 600)];
            let cell = Cell(Vec::from(ranges.map(|(from, base, width)| {
                let low = from + draw.below(base);
                draw.interval(low, width)
            })));
            let edges = cell.edges().expect("edges");
            let shows = |evidence| i32::from(part.shows(&fixed, &edges, &evidence));
            let shown = 2 * shows(Evidence::Test) + shows(Evidence::Corner(part.face));
            digest.add(&shown.into());
        }
    }
    digest.0
}

/// The slopes of the elbow of three coordinates over random cells, in twelve bits.
fn elbows() -> BigInt {
    let fixed = Fixed::<BigInt>::new(12);
    let (mut draw, mut digest, mut defined) = (Draw(1), Digest(BigInt::from(0)), 0);
    let mut tape = Tape::default();
    let parts = [0, 1, 2].map(|k| tape.coordinate(k));
    let both = tape.elbow(parts);
    for _ in 0..200 {
        let cell = Cell(Vec::from([-5000, -5000, 200].map(|from| {
            let low = from + draw.below(9000);
            draw.interval(low, 500)
        })));
        let edges = cell.edges().expect("edges");
        let values = evaluate(&tape, &[], Slopes::new(&fixed, 3), &edges);
        for f in both {
            match values.of(f) {
                Some(f) => {
                    let parts = [&f.at_centre, &f.range].into_iter().chain(&f.slopes[..3]);
                    parts.for_each(|part| digest.add_interval(Some(part)));
                    defined += 1;
                }
                None => digest.add(&7.into()),
            }
        }
    }
    assert!((100..390).contains(&defined), "{defined}");
    digest.0
}

/// The values of all rows over a cell.
fn leaf(problem: &Problem, bits: u32, cell: &Cell<BigInt>) -> BigInt {
    let fixed = Fixed::<BigInt>::new(bits);
    let slopes = Slopes::new(&fixed, 3);
    let parameters = problem.parameters(bits, &[]).expect("parameters");
    let values = evaluate(&problem.tape, &parameters, slopes, &cell.edges().expect("edges"));
    let mut digest = Digest(BigInt::from(0));
    let rows = problem.legs.iter().map(|leg| &leg.row);
    for row in rows.chain(problem.legs.iter().map(|leg| &leg.divided)) {
        for &f in row.a.iter().chain([&row.d]) {
            let f = values.of(f).expect("defined");
            let parts = [&f.at_centre, &f.range].into_iter().chain(&f.slopes[..3]);
            parts.for_each(|part| digest.add_interval(Some(part)));
        }
    }
    digest.0
}

/// Cells on the way down to a random leaf of a claim's box, and their digests.
fn leaves(name: &str, text: &str, bits: u32) -> String {
    let problem = Problem::new(&claim(text)).expect("a claim");
    let mut random = Random(bits.into());
    let mut cell: Cell<BigInt> = problem.root(bits).expect("a box");
    let mut out = String::new();
    for number in 0..4 {
        let edges: Vec<String> =
            cell.0.iter().map(|x| format!("Fixed ({}) ({})", x.lo, x.hi)).collect();
        let digest = leaf(&problem, bits, &cell);
        let _ = writeln!(
            out,
            "Example {}_{bits}_{number} : {name}.over {bits} [{}] = {digest}.\nProof. vm_cast_no_check (eq_refl {digest}). Qed.",
            name.to_lowercase(),
            edges.join("; ")
        );
        let halves = cell.halves(random.below(3) as usize).expect("halves");
        cell = halves[random.below(2) as usize].clone();
    }
    out
}

#[test]
fn values_of_the_formal_kernel_are_these() {
    let [arithmetic, definite] = operations();
    let (shown, elbows) = (faces(), elbows());
    let mut text = include_str!("../../../rocq/instances/KernelValues.head").to_owned();
    let _ = writeln!(
        text,
        "Example operations : arithmetic = {arithmetic}.\nProof. vm_cast_no_check (eq_refl {arithmetic}). Qed.\n\
         Example definiteness : definite = {definite}.\nProof. vm_cast_no_check (eq_refl {definite}). Qed.\n\
         Example faces : shown = {shown}.\nProof. vm_cast_no_check (eq_refl {shown}). Qed.\n\
         Example elbows_are : elbows = {elbows}.\nProof. vm_cast_no_check (eq_refl {elbows}). Qed.\n"
    );
    for bits in [52, 100] {
        for (name, claim) in instances().into_iter().take(2) {
            text += &leaves(name, &claim, bits);
        }
    }
    assert_eq!(committed("KernelValues.v", || text.clone()), text);
}
