//! How many leaves both bounds take on the machines of benches/runs/leaves.md, each leaf confirmed in
//! exact arithmetic.

mod rough;

use nalgebra::DMatrix;
use num_bigint::BigInt;
use orthocert_kernel::arithmetic::{Arithmetic, Enclosure};
use orthocert_kernel::cell::Cell;
use orthocert_kernel::fixed::{Fixed, Interval};
use orthocert_kernel::formula::{Formula, Op, Tape, Vector};
use orthocert_kernel::machine::{arm, row_of, slider, strut, Joint, Leg};
use orthocert_kernel::slope::Slopes;
use orthocert_kernel::test::{sigma_max, sigma_min, Multiplier, Over, Row};
use rough::{Pair, Rough};

const BITS: u32 = 52;

/// A machine over a box; lengths in the unit `unit`.
struct Case {
    tape: Tape,
    rows: Vec<Row<Formula>>,
    /// A second form of the rows: `M` and 1.
    second: Option<Vec<Row<Formula>>>,
    parameters: Vec<f64>,
    low: Vec<f64>,
    high: Vec<f64>,
}

enum Drive {
    Slider { n: [f64; 3], length: f64, m: i64 },
    Strut,
    Arm { k: [f64; 3], e: [f64; 3], r: f64, length: f64, m: i64 },
}

/// Legs with their base ends.
fn case(legs: &[([f64; 3], Drive)], low: [f64; 3], high: [f64; 3], unit: f64) -> Case {
    let mut tape = Tape::default();
    let mut parameters = Vec::new();
    let p: Vector = std::array::from_fn(|k| tape.coordinate(k));
    let mut built: Vec<Leg> = Vec::new();
    let mut guides: Vec<Option<(Vector, i64)>> = Vec::new();
    for (a, drive) in legs {
        let mut number = |tape: &mut Tape, x: f64| {
            parameters.push(x);
            tape.parameter(parameters.len() - 1)
        };
        let mut vector = |tape: &mut Tape, v: &[f64; 3], unit: f64| -> Vector {
            std::array::from_fn(|k| match v[k] {
                0.0 => tape.integer(0),
                x => number(tape, x / unit),
            })
        };
        let base = vector(&mut tape, a, unit);
        let w = tape.minus(&p, &base);
        built.push(match drive {
            Drive::Slider { n, length, m } => {
                let n = vector(&mut tape, n, 1.0);
                let n = if n.iter().filter(|&&c| c == tape.integer(0)).count() == 2 {
                    let one = tape.integer(1);
                    n.map(|c| if c == tape.integer(0) { c } else { one })
                } else {
                    tape.normalised(&n)
                };
                let length = vector(&mut tape, &[*length, 0.0, 0.0], unit)[0];
                guides.push(Some((n, *m)));
                slider(&mut tape, &w, &n, length, *m)
            }
            Drive::Strut => { guides.push(None); strut(&mut tape, &w) }
            Drive::Arm { k, e, r, length, m } => {
                let (k, e) = (vector(&mut tape, k, 1.0), vector(&mut tape, e, 1.0));
                let [r, length, _] = vector(&mut tape, &[*r, *length, 0.0], unit);
                guides.push(None);
                arm(&mut tape, &w, [&k, &e], [r, length], *m)
            }
        });
    }
    let rows = built.iter().map(|leg| leg.row.clone()).collect();
    let second = built
        .iter()
        .zip(&guides)
        .map(|(leg, n)| {
            let (Joint::Length(_), Some((n, m))) = (leg.rho, n) else { return None };
            let root = tape.sqrt(leg.row.d);
            let root = if *m < 0 { tape.neg(root) } else { root };
            let one = tape.integer(1);
            let row = leg.row.a.iter().zip(n).map(|(&a, &n)| {
                let axial = tape.mul(root, n);
                let _ = a;
                let _ = axial;
                n
            });
            let ns: Vec<Formula> = row.collect();
            let r = leg.r.expect("r");
            let a = ns.iter().zip(&r).map(|(&n, &r)| { let q = tape.div(r, root); tape.add(n, q) }).collect();
            Some(Row { a, d: one })
        })
        .collect();
    let scale = |v: [f64; 3]| v.map(|x| x / unit).to_vec();
    Case { tape, rows, second, parameters, low: scale(low), high: scale(high) }
}

impl Case {
    /// `M` at a point.
    fn matrix(&self, x: &[f64]) -> Option<DMatrix<f64>> {
        let values = self.tape.run(&Rough, |op| match op {
            Op::Coordinate(k) => Some((x[k], x[k])),
            Op::Parameter(j) => Some((self.parameters[j], self.parameters[j])),
            _ => None,
        });
        let mut m = DMatrix::zeros(self.rows.len(), x.len());
        for (i, row) in self.rows.iter().enumerate() {
            let d = values.of(row.d)?.0;
            for (k, a) in row.a.iter().enumerate() {
                m[(i, k)] = values.of(*a)?.0 / d.sqrt();
            }
        }
        Some(m)
    }

    /// `sigma_min` and `sigma_max` over the box: a grid, then steps that shrink.
    fn extremes(&self) -> [f64; 2] {
        let m = self.low.len();
        let at = |x: &[f64]| {
            let s = self.matrix(x).expect("within reach").singular_values();
            [s.min(), -s.max()]
        };
        const N: usize = 13;
        let grid = (0..N.pow(m as u32)).map(|i| {
            (0..m)
                .map(|k| {
                    let t = (i / N.pow(k as u32) % N) as f64 / (N - 1) as f64;
                    self.low[k] + t * (self.high[k] - self.low[k])
                })
                .collect::<Vec<f64>>()
        });
        let points: Vec<Vec<f64>> = grid.collect();
        [0, 1].map(|which| {
            let mut starts: Vec<(f64, &Vec<f64>)> =
                points.iter().map(|x| (at(x)[which], x)).collect();
            starts.sort_by(|a, b| a.0.total_cmp(&b.0));
            let refined = starts.iter().take(4).map(|(value, x)| {
                let (mut best, mut x, mut step) = (*value, (*x).clone(), 0.1);
                while step > 1e-9 {
                    let mut moved = false;
                    for k in 0..m {
                        for sign in [-1.0, 1.0] {
                            let mut y = x.clone();
                            let width = self.high[k] - self.low[k];
                            y[k] = (y[k] + sign * step * width).clamp(self.low[k], self.high[k]);
                            let value = at(&y)[which];
                            if value < best {
                                (best, x, moved) = (value, y, true);
                            }
                        }
                    }
                    if !moved {
                        step /= 2.0;
                    }
                }
                best
            });
            refined.fold(f64::MAX, f64::min).abs()
        })
    }
}

/// What the search tries on a cell.
struct Prover<'a> {
    case: &'a Case,
    kappa: f64,
    k: f64,
}

fn starts(m: &DMatrix<f64>, d: &[f64], kappa: f64) -> Vec<DMatrix<f64>> {
    let svd = m.clone().svd(true, true);
    let (u, vt) = (svd.u.expect("u"), svd.v_t.expect("v"));
    let with = |f: &dyn Fn(f64) -> f64| {
        let s = DMatrix::from_diagonal(&svd.singular_values.map(f));
        let mut y = &u * s * &vt;
        for (i, d) in d.iter().enumerate() {
            y.row_mut(i).scale_mut(1.0 / d.sqrt());
        }
        y
    };
    vec![with(&|_| kappa), with(&|s| s.min(1.3 * kappa)), with(&|s| s)]
}

impl Prover<'_> {
    fn lower(&self, over: &Over<'_, Rough>, rows: &[Row<Formula>]) -> Option<Multiplier> {
        let m = over.slopes.m;
        let mut matrix = DMatrix::zeros(rows.len(), m);
        let mut d = Vec::new();
        for (i, row) in rows.iter().enumerate() {
            let centre = |f: Formula| over.values.of(f).map(|s| s.at_centre.0);
            let di = centre(row.d).filter(|&d| d > 0.0)?;
            d.push(di);
            for (k, &a) in row.a.iter().enumerate() {
                matrix[(i, k)] = centre(a)? / di.sqrt();
            }
        }
        const PLACES: u32 = 14;
        starts(&matrix, &d, self.kappa).into_iter().find_map(|y| {
            let scaled = |i: usize| {
                (0..m).map(|k| (y[(i, k)] * f64::from(PLACES).exp2()).round() as i64).collect()
            };
            let evidence = Multiplier { y: (0..rows.len()).map(scaled).collect(), places: PLACES };
            let kappa = (self.kappa.powi(2), self.kappa.powi(2));
            sigma_min(over, rows, &kappa, &evidence).then_some(evidence)
        })
    }

    /// The evidence of `sigma_min` with its form, whether `sigma_max` holds, and what the axes weigh.
    fn attempt(
        &self,
        cell: &[Pair],
        wanted: [bool; 2],
    ) -> (Option<(usize, Multiplier)>, bool, Vec<f64>) {
        let slopes = Slopes { arithmetic: &Rough, m: cell.len() };
        let values = self.case.tape.run(&slopes, |op| match op {
            Op::Coordinate(k) => {
                let (lo, hi) = cell[k];
                let (c, h) = ((lo + hi) / 2.0, (hi - lo) / 2.0);
                slopes.coordinate(k, [(c, c), (lo, hi), (h, h)])
            }
            Op::Parameter(j) => slopes.constant((self.case.parameters[j], self.case.parameters[j])),
            _ => None,
        });
        let over = Over { slopes, values: &values };
        let k2 = (self.k * self.k, self.k * self.k);
        let forms = [Some(&self.case.rows), self.case.second.as_ref()];
        let lower = || {
            forms
                .iter()
                .enumerate()
                .find_map(|(form, rows)| Some((form, self.lower(&over, rows.as_ref()?)?)))
        };
        let low = wanted[0].then(lower).flatten();
        let high = !wanted[1] || forms.iter().flatten().any(|rows| sigma_max(&over, rows, &k2));
        let weight = |k: usize| -> f64 {
            let of = |f: Formula| {
                values.of(f).map_or(f64::INFINITY, |s| s.slopes[k].0.abs().max(s.slopes[k].1.abs()))
            };
            self.case.rows.iter().fold(0.0, |sum, row| {
                let d = values.of(row.d).map_or(1.0, |d| d.at_centre.0.max(1e-9));
                let a: f64 = row.a.iter().map(|&a| of(a)).sum();
                sum + a / d.sqrt() + std::env::var("FAC").ok().and_then(|x| x.parse::<f64>().ok()).unwrap_or(1.0) * of(row.d) / (2.0 * d)
            })
        };
        let weights: Vec<f64> = (0..cell.len()).map(weight).collect();
        let weights = if weights.iter().all(|w| w.is_finite()) {
            weights
        } else {
            cell.iter().map(|(lo, hi)| hi - lo).collect()
        };
        (low, high, weights)
    }

    /// Leaves of the tree, each confirmed.
    fn count(&self, most: usize) -> Option<usize> {
        let exact = Fixed::<i64>::new(BITS);
        let parameters: Vec<Interval<i64>> =
            self.case.parameters.iter().map(|&x| near(x)).collect();
        let point = |x: f64| near(x);
        let (kappa2, k2) = (point(self.kappa).clone(), point(self.k));
        let square = |x: &Interval<i64>| exact.sqr(x).expect("square");
        let (kappa2, k2) = (square(&kappa2), square(&k2));
        let root = Cell(
            self.case
                .low
                .iter()
                .zip(&self.case.high)
                .map(|(&lo, &hi)| Interval { lo: near(lo).lo, hi: near(hi).hi })
                .collect(),
        );
        let wanted = match std::env::var("ONLY").as_deref() { Ok("lower") => [true, false], Ok("upper") => [false, true], _ => [true, true] };
        let mut waiting = vec![(root, wanted)];
        let (mut leaves, mut tried) = (0, 0);
        while let Some((cell, wanted)) = waiting.pop() {
            tried += 1;
            if tried > most {
                return None;
            }
            let pairs: Vec<Pair> = cell.0.iter().map(|i| (double(i.lo), double(i.hi))).collect();
            let (low, high, weights) = self.attempt(&pairs, wanted);
            let values = cell.evaluate(&self.case.tape, &parameters, &exact);
            let over =
                Over { slopes: Slopes { arithmetic: &exact, m: cell.0.len() }, values: &values };
            let forms = [Some(&self.case.rows), self.case.second.as_ref()];
            if let Some((form, evidence)) = &low {
                let rows = forms[*form].expect("a form");
                assert!(sigma_min(&over, rows, &kappa2, evidence), "not confirmed: {cell:?}");
            }
            if wanted[1] && high {
                assert!(forms.iter().flatten().any(|rows| sigma_max(&over, rows, &k2)));
            }
            let open = [wanted[0] && low.is_none(), wanted[1] && !high];
            if open == [false, false] {
                leaves += 1;
                continue;
            }
            let axis = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b]))?;
            for half in cell.halves(axis)? {
                waiting.push((half, open));
            }
        }
        Some(leaves)
    }
}

fn near(x: f64) -> Interval<i64> {
    let scaled = x * f64::from(BITS).exp2();
    Interval { lo: scaled.floor() as i64, hi: scaled.ceil() as i64 }
}

fn double(n: i64) -> f64 {
    n as f64 / f64::from(BITS).exp2()
}

fn tower(degrees: f64, radius: f64) -> [f64; 3] {
    let t = degrees.to_radians();
    [radius * t.cos(), radius * t.sin(), 0.0]
}

fn linear_delta() -> Case {
    let leg = |t| (tower(t, 174.75), Drive::Slider { n: [0.0, 0.0, 1.0], length: 333.0, m: -1 });
    case(&[leg(210.0), leg(330.0), leg(90.0)], [-60.0, -60.0, 0.0], [60.0, 60.0, 1.0], 512.0)
}

fn struts() -> Case {
    let legs = [[-300.0, -180.0, 0.0], [310.0, -170.0, 10.0], [5.0, 340.0, -5.0]];
    let legs = legs.map(|a| (a, Drive::Strut));
    case(&legs, [-60.0, -60.0, 180.0], [60.0, 60.0, 260.0], 512.0)
}

fn orthoglide() -> Case {
    let leg = |i: usize| {
        let mut n = [0.0; 3];
        n[i] = 1.0;
        ([0.0; 3], Drive::Slider { n, length: 310.7, m: 1 })
    };
    case(&[leg(0), leg(1), leg(2)], [-72.0; 3], [125.0; 3], 512.0)
}

fn skew() -> Case {
    let leg = |n: [f64; 3], a: [f64; 3], d: [f64; 3], length: f64| {
        let base = std::array::from_fn(|k| a[k] - d[k]);
        (base, Drive::Slider { n, length, m: 1 })
    };
    let legs = [
        leg([7.0, 1.0, -1.0], [3.1, -8.2, 5.5], [4.0, -2.5, 1.0], 301.3),
        leg([-1.0, 6.0, 0.0], [-11.4, 2.0, 7.7], [0.5, 6.1, -3.0], 287.9),
        leg([1.0, 0.0, 5.0], [9.0, 13.2, -4.1], [-5.0, 3.3, 2.2], 322.6),
    ];
    case(&legs, [-45.0, -50.0, -40.0], [70.0, 66.0, 75.0], 512.0)
}

fn rotary() -> Case {
    let r3 = 3f64.sqrt() / 2.0;
    let leg = |c: f64, s: f64| {
        let drive = Drive::Arm { k: [s, -c, 0.0], e: [c, s, 0.0], r: 10.0, length: 14.0, m: 1 };
        ([4.0 * c, 4.0 * s, 0.0], drive)
    };
    let legs = [leg(0.0, 1.0), leg(-r3, -0.5), leg(r3, -0.5)];
    case(&legs, [-3.0, -3.0, -14.0], [3.0, 3.0, -10.0], 16.0)
}

/// The same legs from their joint coordinates alone.
fn from_rho(of: fn() -> Case, rho: impl Fn(&mut Case) -> Vec<Formula>) -> Case {
    let mut case = of();
    let joints = rho(&mut case);
    let m = case.low.len();
    case.rows = joints.iter().map(|&rho| row_of(&mut case.tape, rho, m)).collect();
    case
}

fn joints(case: &mut Case) -> Vec<Formula> {
    // The joint coordinates are the entries that legs were built with; found again by building.
    let _ = &case;
    Vec::new()
}

#[test]
fn leaves() {
    let cases: [(&str, fn() -> Case); 5] = [
        ("linear Delta", linear_delta),
        ("struts", struts),
        ("Orthoglide", orthoglide),
        ("skew", skew),
        ("rotary Delta", rotary),
    ];
    for (name, of) in cases {
        for second in [false, true] {
            let mut case = of();
            if !second {
                case.second = None;
            }
            let [least, greatest] = case.extremes();
            let counts = [1e-2, 1e-3, 1e-4].map(|part| {
                let prover =
                    Prover { case: &case, kappa: least * (1.0 - part), k: greatest * (1.0 + part) };
                prover.count(20_000)
            });
            println!("{name} second form {second}: {least:.6} {greatest:.6} {counts:?}");
        }
    }
    let _ = (from_rho as fn(_, fn(&mut Case) -> Vec<Formula>) -> _, joints as fn(&mut Case) -> _);
    let _ = (Rough.halve(&(0.0, 0.0)), BigInt::from(0));
}
#[test]
fn compare() {
    let case = rotary();
    let lo = [-3.0, -3.0, -14.0].map(|x: f64| x / 16.0);
    let hi = [-1.5, -1.5, -12.0].map(|x: f64| x / 16.0);
    let slopes = Slopes { arithmetic: &Rough, m: 3 };
    let values = case.tape.run(&slopes, |op| match op {
        Op::Coordinate(k) => {
            let (c, h) = ((lo[k] + hi[k]) / 2.0, (hi[k] - lo[k]) / 2.0);
            slopes.coordinate(k, [(c, c), (lo[k], hi[k]), (h, h)])
        }
        Op::Parameter(j) => slopes.constant((case.parameters[j], case.parameters[j])),
        _ => None,
    });
    for row in &case.rows {
        for f in row.a.iter() {
            let s = values.of(*f).unwrap();
            println!("A {:.5} {:.5} {:.5} {:?}", s.at_centre.0 * 16.0, s.range.0 * 16.0, s.range.1 * 16.0, s.slopes[..3].iter().map(|s| (s.0 * 16.0, s.1 * 16.0)).collect::<Vec<_>>());
        }
        let s = values.of(row.d).unwrap();
        let u = 256.0 / 100.0 * 256.0;
        println!("D {:.5} {:.5} {:.5} {:?}", s.at_centre.0 * u, s.range.0 * u, s.range.1 * u, s.slopes[..3].iter().map(|s| (s.0 * u, s.1 * u)).collect::<Vec<_>>());
    }
}
#[test]
fn cells() {
    let case = rotary();
    let [least, greatest] = case.extremes();
    let prover = Prover { case: &case, kappa: least / 1.01, k: greatest / 0.99 };
    println!("X {} {}", prover.kappa, prover.k);
    for (lo, hi) in [
        ([-3.0, -3.0, -14.0], [-1.5, -1.5, -12.0]),
        ([-3.0, -3.0, -14.0], [-2.25, -2.25, -13.0]),
        ([-0.75, -0.75, -14.0], [0.0, 0.0, -13.0]),
        ([0.0, 0.0, -11.0], [0.75, 0.75, -10.0]),
        ([0.0, 0.0, -10.5], [0.4, 0.4, -10.0]),
    ] {
        let cell: Vec<Pair> = (0..3).map(|k| (lo[k] / 16.0, hi[k] / 16.0)).collect();
        let (low, high, weights) = prover.attempt(&cell, [true, true]);
        println!("X {} {high} {weights:?}", low.is_some());
    }
}
