//! Drives against geometry: closure, working mode, and rows against differences of the joint coordinate.

use crate::arithmetic::Random;
use crate::rough::{Pair, Rough};
use orthocert_kernel::formula::{Tape, Values, Vector};
use orthocert_kernel::machine::{arm, joint, planar, slider, strut, Joint, Leg};

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn along(a: V, t: f64, b: V) -> V {
    std::array::from_fn(|k| a[k] + t * b[k])
}

fn unit(a: V) -> V {
    a.map(|x| x / dot(a, a).sqrt())
}

fn vector(random: &mut Random) -> V {
    [0; 3].map(|_: i64| random.below(2001) as f64 / 1000.0 - 1.0)
}

/// A leg at a place: coordinates are `w`, parameters as given.
struct At<'a> {
    tape: &'a Tape,
    parameters: &'a [f64],
}

impl At<'_> {
    fn values(&self, w: V) -> Values<Pair> {
        self.tape.run(
            &Rough,
            |k| Some((w[k], w[k])),
            |j| Some((self.parameters[j], self.parameters[j])),
        )
    }

    /// `A`, `D`, the divided row, and the joint coordinate; nothing out of reach.
    fn leg(&self, leg: &Leg, w: V) -> Option<(V, f64, V, f64)> {
        let values = self.values(w);
        let of = |f| values.of(f).map(|x: &Pair| x.0);
        let row = |a: &[_]| -> Option<V> { Some([of(a[0])?, of(a[1])?, of(a[2])?]) };
        let rho = match leg.rho? {
            Joint::Length(rho) => of(rho)?,
            Joint::Angle { cos, sin } => of(sin)?.atan2(of(cos)?),
        };
        Some((row(&leg.row.a)?, of(leg.row.d)?, row(&leg.divided.a)?, rho))
    }

    /// Holds the rows against each other and against differences of the joint coordinate.
    fn rows_are_derivatives(&self, leg: &Leg, w: V, mode: f64) -> Option<(V, f64)> {
        let (a, d, divided, rho) = self.leg(leg, w)?;
        if d < 0.01 {
            return None;
        }
        for k in 0..3 {
            assert!((divided[k] - mode * a[k] / d.sqrt()).abs() < 1e-9, "{leg:?}");
            let moved = |h: f64| {
                let mut w = w;
                w[k] += h;
                self.leg(leg, w).map(|(.., rho)| rho)
            };
            let step = 1e-6;
            let change = (moved(step)? - moved(-step)?) / (2.0 * step);
            let turns = (change * 2.0 * step / std::f64::consts::TAU).round();
            let change = change - turns * std::f64::consts::TAU / (2.0 * step);
            assert!((divided[k] - change).abs() < 1e-4 * (1.0 + change.abs()), "{change}");
        }
        Some((a, rho))
    }
}

fn close(x: f64, y: f64) -> bool {
    (x - y).abs() < 1e-9 * (1.0 + y.abs())
}

fn parameters(tape: &mut Tape, at: usize) -> Vector {
    std::array::from_fn(|k| tape.parameter(at + k))
}

fn position(tape: &mut Tape) -> Vector {
    std::array::from_fn(|k| tape.coordinate(k))
}

#[test]
fn sliders() {
    let mut random = Random(3);
    let mut reached = 0;
    for _ in 0..4_000 {
        let mode = if random.below(2) == 0 { 1 } else { -1 };
        let mut tape = Tape::default();
        let (w, n) = (position(&mut tape), parameters(&mut tape, 0));
        let length = tape.parameter(3);
        let leg = slider(&mut tape, &w, &n, length, mode);
        let (n, length) = (unit(vector(&mut random)), 1.0 + random.below(100) as f64 / 100.0);
        let numbers = [n[0], n[1], n[2], length];
        let at = At { tape: &tape, parameters: &numbers };
        let w = vector(&mut random);
        let Some((a, rho)) = at.rows_are_derivatives(&leg, w, mode as f64) else { continue };
        // The base end is rho n, the leg of its length, and on the side of its mode.
        let foot = along([0.0; 3], rho, n);
        let rod = along(w, -1.0, foot);
        assert!(close(dot(rod, rod).sqrt(), length) && close(dot(a, a).sqrt(), length));
        assert!((0..3).all(|k| (rod[k] - a[k]).abs() < 1e-9));
        assert!(dot(rod, n) * mode as f64 > 0.0);
        reached += 1;
    }
    assert!(reached > 2_500, "{reached}");
}

#[test]
fn arms() {
    let mut random = Random(5);
    let mut reached = 0;
    for _ in 0..6_000 {
        let mode = if random.below(2) == 0 { 1 } else { -1 };
        let mut tape = Tape::default();
        let w = position(&mut tape);
        let (k, e) = (parameters(&mut tape, 0), parameters(&mut tape, 3));
        let lengths = [tape.parameter(6), tape.parameter(7)];
        let leg = arm(&mut tape, &w, [&k, &e], lengths, mode);
        let k = unit(vector(&mut random));
        let e = unit(cross(k, vector(&mut random)));
        let f = cross(k, e);
        let (r, length) =
            (0.5 + random.below(50) as f64 / 100.0, 0.6 + random.below(90) as f64 / 100.0);
        let numbers = [k[0], k[1], k[2], e[0], e[1], e[2], r, length];
        let at = At { tape: &tape, parameters: &numbers };
        let w = vector(&mut random);
        let Some((a, theta)) = at.rows_are_derivatives(&leg, w, mode as f64) else { continue };
        let elbow = along(along([0.0; 3], r * theta.cos(), e), r * theta.sin(), f);
        let rod = along(w, -1.0, elbow);
        assert!(close(dot(rod, rod).sqrt(), length));
        assert!((0..3).all(|j| (rod[j] - a[j]).abs() < 1e-7), "{rod:?} {a:?}");
        // eta: the leg's component along the elbow's motion.
        let motion = along(along([0.0; 3], -theta.sin(), e), theta.cos(), f);
        assert!(dot(rod, motion) * mode as f64 > 0.0);
        reached += 1;
    }
    assert!(reached > 800, "{reached}");
}

#[test]
fn struts_planes_and_users_joints() {
    let mut random = Random(9);
    for _ in 0..1_000 {
        let mut tape = Tape::default();
        let (w, n) = (position(&mut tape), parameters(&mut tape, 0));
        let legs = [strut(&mut tape, &w), planar(&mut tape, &w, &n)];
        // The slider once more, from its joint coordinate alone.
        let length = tape.parameter(3);
        let guided = slider(&mut tape, &w, &n, length, -1);
        let Some(Joint::Length(rho)) = guided.rho else { panic!("a length") };
        let own = joint(&mut tape, rho, 3);
        let n = unit(vector(&mut random));
        let numbers = [n[0], n[1], n[2], 2.0];
        let at = At { tape: &tape, parameters: &numbers };
        let w = vector(&mut random);
        for leg in &legs {
            at.rows_are_derivatives(leg, w, 1.0);
        }
        let (.., expected, _) = at.leg(&guided, w).expect("within reach");
        let (a, d, found, _) = at.leg(&own, w).expect("within reach");
        for k in 0..3 {
            assert!((expected[k] - found[k]).abs() < 1e-9);
            assert!((a[k] * a[k] / d - found[k] * found[k]).abs() < 1e-9);
        }
    }
}
