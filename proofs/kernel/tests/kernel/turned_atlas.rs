//! Maps of machines that turn their platforms, against `M` by cosines and sines.

use crate::atlas::{certificate, claim, number, parts};
use crate::motions::{decimal, rotation, times};
use crate::prover::Prover;
use nalgebra::DMatrix;
use orthocert_kernel::atlas::{halves, Part};
use orthocert_kernel::certificate::{AtlasCell, Certificate, Failure, Witness};
use orthocert_kernel::check::check;
use orthocert_kernel::claim::AtlasClaim;
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::prover::check_cell;
use orthocert_kernel::rejected::Rejected;

type V = [f64; 3];

/// Struts from a base to a platform of the radius `r`, which turns by up to `a` degrees.
struct Turning {
    kind: &'static str,
    anchors: Vec<V>,
    /// Over `r`.
    platform: Vec<V>,
    /// Greatest coordinates of the position less its middle, and this.
    half: Vec<f64>,
    middle: Vec<f64>,
    /// Bound on the least singular value.
    least: f64,
    /// The ends of `r` and `a`.
    ranges: [[f64; 2]; 2],
}

fn on(radius: f64, degrees: f64, z: f64) -> V {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [radius * cos, radius * sin, z].map(|x| (x * 1e6).round() / 1e6)
}

fn machines() -> [Turning; 3] {
    let three = [90.0, 210.0, 330.0];
    let pairs =
        |near: f64| [0.0, 120.0, 240.0].into_iter().flat_map(move |at| [at - near, at + near]);
    [
        Turning {
            kind: "planar",
            anchors: three.map(|at| on(1.0, at, 0.0)).to_vec(),
            platform: three.map(|at| on(1.0, at + 80.0, 0.0)).to_vec(),
            half: vec![0.2; 2],
            middle: vec![0.0; 2],
            least: 0.88,
            ranges: [[0.5, 0.62], [4.0, 60.0]],
        },
        Turning {
            kind: "spherical",
            anchors: three.map(|at| on(1.5, at - 90.0, -1.5)).to_vec(),
            platform: three.map(|at| on(1.0, at, 0.0)).to_vec(),
            half: Vec::new(),
            middle: Vec::new(),
            least: 0.4,
            ranges: [[0.65, 0.75], [4.0, 36.0]],
        },
        Turning {
            kind: "spatial",
            anchors: pairs(10.0).map(|at| on(1.0, at, 0.0)).collect(),
            platform: pairs(50.0).map(|at| on(1.0, at, 0.0)).collect(),
            half: vec![0.1; 3],
            middle: vec![0.0, 0.0, 1.0],
            least: 0.6,
            ranges: [[0.5, 0.55], [4.0, 36.0]],
        },
    ]
}

impl Turning {
    /// How many coordinates a leg's ends have.
    fn width(&self) -> usize {
        if self.kind == "planar" {
            2
        } else {
            3
        }
    }

    fn text(&self) -> String {
        let quoted = |x: &mut dyn Iterator<Item = String>| {
            x.map(|x| format!("\"{x}\"")).collect::<Vec<_>>().join(",")
        };
        let leg = |(a, b): (&V, &V)| {
            let anchor = quoted(&mut a.iter().take(self.width()).map(|&x| decimal(x)));
            let platform =
                quoted(&mut b.iter().take(self.width()).map(|&x| format!("r*{}", decimal(x))));
            format!(r#"{{"drive":"strut","anchor":[{anchor}],"platform":[{platform}]}}"#)
        };
        let legs: Vec<String> = self.anchors.iter().zip(&self.platform).map(leg).collect();
        let corner = |sign: f64| {
            let ends = self.middle.iter().zip(&self.half);
            quoted(&mut ends.map(|(x, half)| decimal(((x + sign * half) * 1e6).round() / 1e6)))
        };
        let orientation =
            if self.kind == "planar" { r#"{"range":["-a","a"]}"# } else { r#"{"angle":"a"}"# };
        let length = if self.kind == "spherical" { "1" } else { "1/2" };
        let [r, a] = self.ranges.map(|ends| ends.map(decimal));
        format!(
            r#"{{"parameters":[{{"name":"r","min":"{}","max":"{}"}},{{"name":"a","min":"{}","max":"{}"}}],"machine":{{"mechanism":{{"{}":{{"legs":[{}],"characteristic_length":"{length}"}}}},"workspace":{{"box":{{"min":[{}],"max":[{}]}}}},"orientation":{orientation},"require":[{{"quantity":"transmission","end":"max","bound":"1/{}"}}]}},"certified":"0","refuted":"0"}}"#,
            r[0],
            r[1],
            a[0],
            a[1],
            self.kind,
            legs.join(","),
            corner(-1.0),
            corner(1.0),
            decimal(self.least)
        )
    }

    /// The least singular value at a pose, and its direction.
    fn least_at(&self, r: f64, pose: &[f64]) -> (f64, Vec<f64>) {
        let (at, turned) = pose.split_at(self.half.len());
        let kind = if self.kind == "planar" { "range" } else { "angle" };
        let still = turned.iter().all(|&c| c == 0.0);
        let rotation = rotation(if still { "none" } else { kind }, turned);
        let length = if self.kind == "spherical" { 1.0 } else { 0.5 };
        let row = |(a, b): (&V, &V)| -> Vec<f64> {
            let b = times(&rotation, b.map(|x| r * x));
            let u: V = std::array::from_fn(|k| at.get(k).unwrap_or(&0.0) + b[k] - a[k]);
            let rho = u.iter().map(|x| x * x).sum::<f64>().sqrt();
            let moment = |k: usize| {
                (b[(k + 1) % 3] * u[(k + 2) % 3] - b[(k + 2) % 3] * u[(k + 1) % 3]) / length
            };
            let spin = if self.kind == "planar" { 2..3 } else { 0..3 };
            (0..at.len()).map(|k| u[k]).chain(spin.map(moment)).map(|x| x / rho).collect()
        };
        let rows: Vec<f64> = self.anchors.iter().zip(&self.platform).flat_map(row).collect();
        let m = pose.len();
        let svd = DMatrix::from_row_slice(rows.len() / m, m, &rows).svd(false, true);
        let (v, k) = (svd.v_t.expect("asked for"), svd.singular_values.imin());
        (svd.singular_values[k], v.row(k).iter().copied().collect())
    }

    /// Poses at the vertices, and in the middle, with orientations of up to an angle.
    fn poses(&self, degrees: f64) -> Vec<Vec<f64>> {
        // Below the tangent by less than one in a million.
        let t = ((degrees.to_radians() / 2.0).tan() * 1e6).floor() / 1e6;
        let signs = |m: usize| {
            (0..3usize.pow(m as u32)).map(move |n| -> Vec<f64> {
                (0..m).map(|k| (n / 3usize.pow(k as u32) % 3) as f64 - 1.0).collect()
            })
        };
        let turned = |signs: Vec<f64>| -> Vec<f64> {
            let norm = signs.iter().map(|x| x * x).sum::<f64>().sqrt().max(1.0);
            signs.iter().map(|x| (x * t / norm * 1e6).trunc() / 1e6).collect()
        };
        let turns: Vec<Vec<f64>> =
            signs(if self.kind == "planar" { 1 } else { 3 }).map(turned).collect();
        let all = signs(self.half.len()).flat_map(|at| {
            let place = at.iter().zip(&self.half).zip(&self.middle);
            let place: Vec<f64> = place.map(|((s, half), middle)| middle + s * half).collect();
            turns.iter().map(move |turned| [place.clone(), turned.clone()].concat())
        });
        all.collect()
    }

    /// The values of `r` and `a` at parts of a cell.
    fn at(&self, part: &Part, parts: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|k| {
            let ([min, max], (n, level)) = (self.ranges[k], part[k]);
            min + (max - min) * (n as f64 + parts[k]) / f64::from(1 << level)
        })
    }

    /// A cell that is certified, or refuted by a witness at its worst pose, or neither.
    fn decided(&self, own: &AtlasClaim, part: &Part) -> AtlasCell {
        let problem = Problem::new(&own.over(part).expect("parameters")).expect("well formed");
        // Directions in six coordinates are too many to be tried.
        let problem = if self.kind == "spatial" { problem } else { problem.with_derivatives() };
        if let Some(tree) = Prover::new(&problem).tree(3) {
            let cell = AtlasCell::Certified(tree);
            if check_cell(own, part, &cell).is_ok() {
                return cell;
            }
        }
        let [r, _] = self.at(part, [0.5; 2]);
        let [_, a] = self.at(part, [0.0; 2]);
        let worst = self.poses(a).into_iter().map(|pose| (self.least_at(r, &pose), pose));
        let least = worst.min_by(|a, b| a.0 .0.total_cmp(&b.0 .0));
        let ((_, v), pose) = least.expect("some pose");
        let witness = Witness {
            precision: 64,
            point: pose.iter().map(|&x| number(&decimal((x * 1e6).round() / 1e6))).collect(),
            machine: Vec::new(),
            fails: Failure::Obligation(0, vec![v.iter().map(|x| (1e4 * x) as i64).collect()]),
        };
        let cell = AtlasCell::Refuted(witness);
        if check_cell(own, part, &cell).is_ok() {
            cell
        } else {
            AtlasCell::Undecided
        }
    }

    /// Cells of so many halvings, in preorder.
    fn grow(
        &self,
        own: &AtlasClaim,
        part: &Part,
        depth: usize,
        cells: &mut Vec<(Part, AtlasCell)>,
    ) {
        if depth == 0 {
            return cells.push((part.clone(), self.decided(own, part)));
        }
        cells.push((part.clone(), AtlasCell::Split(depth % 2)));
        for half in halves(part, depth % 2).expect("halves") {
            self.grow(own, &half, depth - 1, cells);
        }
    }
}

fn with_shares(mut own: AtlasClaim, cells: Vec<AtlasCell>, leaves: usize) -> Certificate {
    let share = |of: fn(&AtlasCell) -> bool| {
        let found = cells.iter().filter(|cell| of(cell)).count();
        number(&format!("{found}/{leaves}"))
    };
    own.certified = share(|cell| matches!(cell, AtlasCell::Certified(_)));
    own.refuted = share(|cell| matches!(cell, AtlasCell::Refuted(_)));
    certificate(own, cells)
}

#[test]
fn cells_say_what_is_true_of_platforms_that_turn() {
    for machine in machines() {
        let own = claim(&machine.text());
        let (mut grown, depth) = (Vec::new(), 4);
        machine.grow(&own, &vec![(0, 0); 2], depth, &mut grown);
        let (mut counts, mut closest) = ([0; 2], f64::INFINITY);
        for (part, cell) in &grown {
            for corner in 0..4 {
                let [r, a] = machine.at(part, [f64::from(corner & 1), f64::from(corner >> 1)]);
                match cell {
                    AtlasCell::Certified(_) => {
                        for pose in machine.poses(a) {
                            let room = machine.least_at(r, &pose).0 - machine.least;
                            assert!(room > -1e-9, "{}: {part:?} {r} {a} {pose:?}", machine.kind);
                            closest = closest.min(room);
                        }
                    }
                    AtlasCell::Refuted(_) => {
                        let fails = |pose: &Vec<f64>| machine.least_at(r, pose).0 < machine.least;
                        assert!(machine.poses(a).iter().any(fails), "{}: {r} {a}", machine.kind);
                    }
                    _ => {}
                }
            }
            counts[0] += usize::from(matches!(cell, AtlasCell::Certified(_)));
            counts[1] += usize::from(matches!(cell, AtlasCell::Refuted(_)));
        }
        assert!(counts[0] > 2 && counts[1] > 1 && closest < 0.15, "{counts:?} {closest}");
        let cells: Vec<AtlasCell> = grown.iter().map(|(_, cell)| cell.clone()).collect();
        let whole = with_shares(own, cells, 1 << depth);
        let text = whole.to_text().expect("a text");
        check(&Certificate::read(&text).expect("canonical")).expect("accepted");
        tampered(&whole, &grown);
    }
}

/// What is said of a cell is not accepted of others, nor of a box that reaches farther.
fn tampered(whole: &Certificate, grown: &[(Part, AtlasCell)]) {
    let (own, cells) = parts(whole);
    let one = |of: fn(&AtlasCell) -> bool| cells.iter().find(|cell| of(cell)).expect("one").clone();
    let good = one(|cell| matches!(cell, AtlasCell::Certified(_)));
    let bad = one(|cell| matches!(cell, AtlasCell::Refuted(_)));
    for (part, cell) in grown {
        let other = match cell {
            AtlasCell::Certified(_) => &bad,
            AtlasCell::Refuted(_) => &good,
            _ => continue,
        };
        assert!(check_cell(&own, part, other).is_err(), "{part:?}");
    }
    let with = |change: &dyn Fn(&mut AtlasClaim)| {
        let mut own = own.clone();
        change(&mut own);
        check(&certificate(own, cells.clone()))
    };
    let is_refused =
        |change: &dyn Fn(&mut AtlasClaim)| matches!(with(change), Err(Rejected::Cell(..)));
    with(&|_| {}).expect("accepted");
    assert!(is_refused(&|own| own.parameters[1].max = number("120")));
    assert!(is_refused(&|own| own.parameters[0].min = number("1/20")));
    // Half a turn, for some values only, is no orientation of any.
    assert!(is_refused(&|own| own.parameters[1].max = number("6000")));
    let text = serde_json::to_string(&own.machine).expect("a text");
    for (from, to) in [(r#""a""#, r#""5*a""#), (r#""r*"#, r#""1.4*r*"#), (r#""1/0."#, r#""0.8/0."#)]
    {
        let other = text.replace(from, to);
        assert_ne!(other, text);
        assert!(
            is_refused(&|own| own.machine = serde_json::from_str(&other).expect("a claim")),
            "{to}"
        );
    }
    let first: fn(&Expression) -> Expression = |x| number(&format!("{x}+1/1000000"));
    assert_eq!(with(&|own| own.certified = first(&own.certified)), Err(Rejected::Shares));
}
