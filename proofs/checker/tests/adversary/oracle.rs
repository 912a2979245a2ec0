//! What an accepted certificate says, looked at in floating point at a few points and machines:
//! whether something there contradicts it by more than rounding can explain.

use super::random::Random;
use super::truth::{determinant, dot, scale, singular, Leg, State, V};
use num_traits::ToPrimitive;
use orthocert_checker::certificate::{Certificate, Proof, Violation, Witness};
use orthocert_checker::claim::{
    self, Claim, MachineClaim, Mechanism, Quantity, Requirements, Workspace,
};
use orthocert_checker::number::Exact;
use std::array::from_fn;

/// What floating point has to say.
#[derive(Clone, Debug, PartialEq)]
pub enum Opinion {
    /// At every place looked at where doubles suffice, what is said looks true; there was one.
    Agrees,
    /// Nowhere did doubles suffice.
    None,
    /// At some place it is certainly not so.
    Contradicts(String),
}

/// The value, to about the precision of doubles unless there is cancellation.
pub fn approximate(x: &Exact) -> f64 {
    match x {
        Exact::Rational(x) => x.to_f64().unwrap_or(f64::NAN),
        Exact::Neg(x) => -approximate(x),
        Exact::Add(x, y) => approximate(x) + approximate(y),
        Exact::Sub(x, y) => approximate(x) - approximate(y),
        Exact::Mul(x, y) => approximate(x) * approximate(y),
        Exact::Div(x, y) => approximate(x) / approximate(y),
        Exact::Sqrt(x) => approximate(x).sqrt(),
        Exact::Name(_) => f64::NAN,
    }
}

/// The opinion on a certificate that was accepted.
pub fn opinion(certificate: &Certificate, random: &mut Random, samples: u64) -> Opinion {
    match (&certificate.claim, &certificate.proof) {
        (Claim::Machine(claim), Proof::Witness(witness)) => refuted(claim, witness),
        (Claim::Machine(claim), _) => certified(claim, random, samples),
        (Claim::Postulate(_) | Claim::NoCube(_) | Claim::Atlas(_) | Claim::Kernel(_), _) => {
            Opinion::None
        }
    }
}

/// How a parameter is chosen in its tolerance.
#[derive(Clone, Copy)]
enum Choice<'a> {
    Least,
    Greatest,
    Random(&'a std::cell::RefCell<Random>),
}

impl Choice<'_> {
    fn of(self, quantity: &Quantity) -> f64 {
        let (min, max) = (approximate(&quantity.min), approximate(&quantity.max));
        match self {
            Choice::Least => min,
            Choice::Greatest => max,
            Choice::Random(random) => {
                let part = [0.0, 1.0, 0.5, random.borrow_mut().between(0.0, 1.0)];
                min + part[random.borrow_mut().below(4) as usize] * (max - min)
            }
        }
    }
}

fn leg(claimed: &claim::Leg, choice: Choice<'_>) -> Leg {
    let vector = |v: &[Quantity; 3]| from_fn(|k| choice.of(&v[k]));
    let sign = |mode: claim::Sign| mode.as_integer() as f64;
    match claimed {
        claim::Leg::Slider { direction, anchor, platform, length, mode } => Leg::Slider {
            direction: vector(direction),
            anchor: vector(anchor),
            platform: vector(platform),
            length: choice.of(length),
            mode: sign(*mode),
        },
        claim::Leg::Strut { anchor, platform } => {
            Leg::Strut { anchor: vector(anchor), platform: vector(platform) }
        }
        claim::Leg::Arm { axis, reference, anchor, platform, arm, length, mode } => Leg::Arm {
            axis: vector(axis),
            reference: vector(reference),
            anchor: vector(anchor),
            platform: vector(platform),
            arm: choice.of(arm),
            length: choice.of(length),
            mode: sign(*mode),
        },
        claim::Leg::Planar { direction } => Leg::Planar { direction: vector(direction) },
    }
}

/// `q_1`, `q_2` and the legs of the Orthoglide that the paper's cube defines.
pub fn orthoglide(psi_max: f64, side: f64, offset: f64) -> ([Leg; 3], [f64; 2]) {
    let kappa = 1.0 / psi_max;
    let t1 = (1.0 - kappa) / 2.0;
    let t2 = if kappa <= 0.5 { 1.0 - kappa } else { (1.0 / kappa - 1.0) / 2.0 };
    let (q1, q2) = (-t1 / (1.0 + 2.0 * t1 * t1).sqrt(), t2 / (1.0 + 2.0 * t2 * t2).sqrt());
    let length = side / (q2 - q1);
    let axis = |i: usize| from_fn(|k| if i == k { 1.0 } else { 0.0 });
    let legs = from_fn(|i| Leg::Slider {
        direction: axis(i),
        anchor: scale(length * q1 - offset - length, axis(i)),
        platform: scale(-offset, axis(i)),
        length,
        mode: 1.0,
    });
    (legs, [length * q1, length * q2])
}

fn psi_max(claim: &MachineClaim) -> f64 {
    let range = claim.requirements.transmission.as_ref();
    range.and_then(|range| range.max.as_ref()).map_or(f64::NAN, approximate)
}

fn machine(claim: &MachineClaim, choice: Choice<'_>) -> [Leg; 3] {
    match (&claim.mechanism, &claim.workspace) {
        (Mechanism::Translational(legs), _) => from_fn(|i| leg(&legs[i], choice)),
        (Mechanism::Orthoglide { offset }, Workspace::Cube { side }) => {
            orthoglide(psi_max(claim), approximate(side), approximate(offset)).0
        }
        _ => panic!("an orthoglide without its cube was accepted"),
    }
}

/// A point of the workspace: a corner, or any.
fn point(claim: &MachineClaim, random: &mut Random) -> V {
    let corner = random.coin();
    let mut part = || match (corner, random.below(3)) {
        (true, n @ (0 | 1)) => n as f64,
        _ => random.between(0.0, 1.0),
    };
    let mut between = |low: f64, high: f64| low + part() * (high - low);
    match &claim.workspace {
        Workspace::Box { min, max } => {
            from_fn(|k| between(approximate(&min[k]), approximate(&max[k])))
        }
        Workspace::Cylinder { center, radius, z } => {
            let angle = between(0.0, std::f64::consts::TAU);
            let from_axis = approximate(radius) * between(0.0, 1.0).sqrt();
            let along = between(approximate(&z[0]), approximate(&z[1]));
            let [x, y] = [approximate(&center[0]), approximate(&center[1])];
            [x + from_axis * angle.cos(), y + from_axis * angle.sin(), along]
        }
        Workspace::Cube { side } => {
            let (_, [q1, q2]) = orthoglide(psi_max(claim), approximate(side), 0.0);
            from_fn(|_| between(q1, q2))
        }
    }
}

/// Which side of a statement is to be believed only with a margin.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    /// It fails by more than rounding.
    Fails,
    /// It holds with more to spare than rounding.
    Holds,
}

/// A machine at a point, with what rounding may have done to it.
struct Place {
    legs: [Leg; 3],
    p: V,
    states: [State; 3],
    /// Ascending singular values of `M`.
    sigma: V,
    /// Bound on relative errors.
    blur: f64,
}

/// Rounding in a leg at a point, relative, for a clearance `reach`; not a number where squares of
/// what the leg is made of overflow or underflow.
fn blur(leg: &Leg, p: V, reach: f64) -> f64 {
    let size = |vectors: &[V]| vectors.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
    let moderate = |x: f64| (1e-60..1e60).contains(&x);
    match *leg {
        Leg::Slider { direction, anchor, platform, length, .. }
            if moderate(size(&[direction])) && moderate(length) =>
        {
            let size = size(&[p, anchor, platform]).max(length) / length;
            1e-13 * size * size / reach
        }
        Leg::Strut { anchor, platform } if moderate(reach) => {
            1e-13 * size(&[p, anchor, platform]) / reach
        }
        Leg::Arm { axis, reference, anchor, platform, arm, length, .. }
            if [size(&[axis]), size(&[reference]), arm, length].into_iter().all(moderate) =>
        {
            let size = size(&[p, anchor, platform]).max(length).max(arm) / length.min(arm);
            let along = dot(axis, reference).powi(2) / dot(axis, axis) / dot(reference, reference);
            1e-13 * size * size / reach / (1.0 - along)
        }
        Leg::Planar { direction } if moderate(size(&[direction])) => 1e-13,
        _ => f64::NAN,
    }
}

/// What a look at a place comes to.
enum Look {
    Clear(Box<Place>),
    OutOfReach,
    Unclear,
}

fn look(legs: [Leg; 3], p: V) -> Look {
    let (mut worst, mut out) = (0.0f64, false);
    for leg in &legs {
        let reach = leg.reach(p);
        let sharp = blur(leg, p, 1.0);
        if reach < -100.0 * sharp && !matches!(leg, Leg::Strut { .. }) {
            out = true;
            continue;
        }
        if sharp.is_nan() || sharp > 1e-4 {
            return Look::Unclear;
        }
        let error = blur(leg, p, reach);
        // Not a number counts as unclear as well.
        if reach <= 0.0 || error.is_nan() {
            return Look::Unclear;
        }
        worst = worst.max(error);
    }
    if out {
        return Look::OutOfReach;
    }
    if worst > 1e-4 {
        return Look::Unclear;
    }
    let states = legs.map(|leg| leg.at(p));
    let (sigma, _) = singular(&states.map(|state| state.row));
    let blur = 10.0 * worst + 1e-9;
    Look::Clear(Box::new(Place { legs, p, states, sigma, blur }))
}

impl Place {
    /// Whether `x <= bound` fails, or holds, by more than rounding.
    fn beyond(&self, side: Side, x: f64, bound: f64, size: f64) -> bool {
        let room = self.blur * size;
        match side {
            Side::Fails => x > bound + room,
            Side::Holds => x < bound - room,
        }
    }

    fn psi_above(&self, side: Side, max: f64) -> bool {
        self.beyond(side, 1.0 / max, self.sigma[0], self.sigma[2])
    }

    fn psi_below(&self, side: Side, min: f64) -> bool {
        self.beyond(side, self.sigma[2], 1.0 / min, self.sigma[2])
    }

    fn conditioning(&self, side: Side, max: f64) -> bool {
        self.beyond(side, self.sigma[2], max * self.sigma[0], max * self.sigma[2])
    }

    /// The sign of `det M`, or zero if rounding may have made it.
    fn sign(&self) -> f64 {
        let det = determinant(&self.states.map(|state| state.unit));
        if det.abs() > 10.0 * self.blur {
            determinant(&self.states.map(|state| state.row)).signum()
        } else {
            0.0
        }
    }

    fn cosine_below(&self, side: Side, leg: usize, min: f64) -> bool {
        self.states[leg].cosine.is_some_and(|c| self.beyond(side, min, c, 1.0))
    }

    fn determinant_below(&self, side: Side, min: f64) -> bool {
        let det = determinant(&self.states.map(|state| state.unit)).abs();
        self.beyond(side, min, det, 1.0)
    }

    /// The bound on the norm of a row: of arms, whose speeds are in degrees, in radians.
    fn rate(&self, speed: &claim::JointSpeed) -> f64 {
        let rate = approximate(&speed.max) / approximate(&speed.tool);
        match self.legs.iter().any(|leg| matches!(leg, Leg::Arm { .. })) {
            true => rate.to_radians(),
            false => rate,
        }
    }

    fn too_fast(&self, side: Side, leg: usize, rate: f64) -> bool {
        let row = self.states[leg].row;
        self.beyond(side, dot(row, row).sqrt(), rate, rate)
    }

    fn outside_range(&self, side: Side, leg: usize, range: &claim::Range) -> bool {
        let (rho, state) = (self.states[leg].rho, &self.legs[leg]);
        let ends = [&range.min, &range.max].map(|end| end.as_ref().map(approximate));
        if let (Leg::Arm { .. }, [Some(min), Some(max)]) = (state, ends) {
            // Degrees from the middle of the range, the short way round.
            let from_middle = (rho - (min + max) / 2.0 + 180.0).rem_euclid(360.0) - 180.0;
            return self.beyond(side, from_middle.abs(), (max - min) / 2.0, 1000.0);
        }
        let size = [rho, self.p[0], self.p[1], self.p[2]];
        let size = size.iter().chain(ends.iter().flatten()).fold(1e-9, |a: f64, x| a.max(x.abs()));
        let below = ends[0].map(|min| self.beyond(side, min, rho, size));
        let above = ends[1].map(|max| self.beyond(side, rho, max, size));
        match side {
            Side::Fails => below == Some(true) || above == Some(true),
            Side::Holds => below != Some(false) && above != Some(false),
        }
    }

    /// A requirement that fails here by more than rounding.
    fn failure(&self, claim: &MachineClaim) -> Option<String> {
        let Requirements {
            transmission,
            joint_range,
            conditioning,
            serial_margin,
            parallel_margin,
            leg_angle,
            joint_speed,
        } = &claim.requirements;
        let fails = Side::Fails;
        let cube = matches!(claim.workspace, Workspace::Cube { .. });
        let max = transmission.as_ref().and_then(|range| range.max.as_ref()).map(approximate);
        let min = transmission.as_ref().and_then(|range| range.min.as_ref()).map(approximate);
        let min = if cube { max.map(|max| 1.0 / max) } else { min };
        let any_leg = |holds: &dyn Fn(usize) -> bool| (0..3).any(holds);
        let named = [
            ("psi_max", max.is_some_and(|max| self.psi_above(fails, max))),
            ("psi_min", min.is_some_and(|min| self.psi_below(fails, min))),
            (
                "joint_range",
                joint_range
                    .as_ref()
                    .is_some_and(|ranges| any_leg(&|i| self.outside_range(fails, i, &ranges[i]))),
            ),
            (
                "conditioning",
                conditioning
                    .as_ref()
                    .is_some_and(|c| self.conditioning(fails, approximate(&c.max))),
            ),
            (
                "serial_margin",
                serial_margin.as_ref().is_some_and(|margin| {
                    any_leg(&|i| self.cosine_below(fails, i, approximate(&margin.min)))
                }),
            ),
            (
                "parallel_margin",
                parallel_margin
                    .as_ref()
                    .is_some_and(|margin| self.determinant_below(fails, approximate(&margin.min))),
            ),
            (
                "leg_angle",
                leg_angle.as_ref().is_some_and(|angle| {
                    let least = approximate(&angle.max).to_radians().cos();
                    any_leg(&|i| self.cosine_below(fails, i, least))
                }),
            ),
            (
                "joint_speed",
                joint_speed.as_ref().is_some_and(|speed| {
                    let rate = self.rate(speed);
                    any_leg(&|i| self.too_fast(fails, i, rate))
                }),
            ),
        ];
        let (name, _) = named.into_iter().find(|(_, failing)| *failing)?;
        Some(format!("{name} fails at {:?} of {:?}", self.p, self.legs))
    }

    /// Whether a violation is certainly none.
    fn unviolated(&self, claim: &MachineClaim, violates: &Violation) -> bool {
        let needed = &claim.requirements;
        let holds = Side::Holds;
        let range = needed.transmission.as_ref();
        let max = range.and_then(|range| range.max.as_ref()).map(approximate);
        let min = range.and_then(|range| range.min.as_ref()).map(approximate);
        let cube = matches!(claim.workspace, Workspace::Cube { .. });
        let min = if cube { max.map(|max| 1.0 / max) } else { min };
        match violates {
            Violation::SigmaMin(_) => max.is_none_or(|max| self.psi_above(holds, max)),
            Violation::SigmaMax(_) | Violation::Row(_) => {
                min.is_none_or(|min| self.psi_below(holds, min))
            }
            // The place is within reach, by more than rounding.
            Violation::Reach(leg) => self.legs[leg.leg - 1].reach(self.p) > 1e-3,
            Violation::JointRange(leg) => needed
                .joint_range
                .as_ref()
                .is_none_or(|ranges| self.outside_range(holds, leg.leg - 1, &ranges[leg.leg - 1])),
            Violation::Conditioning(_) => needed
                .conditioning
                .as_ref()
                .is_none_or(|c| self.conditioning(holds, approximate(&c.max))),
            Violation::SerialMargin(leg) => needed
                .serial_margin
                .as_ref()
                .is_none_or(|c| self.cosine_below(holds, leg.leg - 1, approximate(&c.min))),
            Violation::ParallelMargin => needed
                .parallel_margin
                .as_ref()
                .is_none_or(|c| self.determinant_below(holds, approximate(&c.min))),
            Violation::LegAngle(leg) => needed.leg_angle.as_ref().is_none_or(|angle| {
                self.cosine_below(holds, leg.leg - 1, approximate(&angle.max).to_radians().cos())
            }),
            Violation::JointSpeed(leg) => needed.joint_speed.as_ref().is_none_or(|speed| {
                let rate = self.rate(speed);
                self.too_fast(holds, leg.leg - 1, rate)
            }),
            // Two points are needed.
            Violation::Singular(_) => false,
        }
    }
}

fn certified(claim: &MachineClaim, random: &mut Random, samples: u64) -> Opinion {
    let own = std::cell::RefCell::new(Random::new(random.below(1 << 40)));
    let (mut clear, mut sign) = (false, 0.0);
    for round in 0..samples {
        let choice = match round % 4 {
            0 => Choice::Least,
            1 => Choice::Greatest,
            _ => Choice::Random(&own),
        };
        let (legs, p) = (machine(claim, choice), point(claim, random));
        match look(legs, p) {
            Look::OutOfReach => {
                return Opinion::Contradicts(format!("out of reach at {p:?} of {legs:?}"))
            }
            Look::Unclear => {}
            Look::Clear(place) => {
                clear = true;
                if let Some(failure) = place.failure(claim) {
                    return Opinion::Contradicts(failure);
                }
                if place.sign() * sign < 0.0 {
                    return Opinion::Contradicts(format!("det M changes its sign at {p:?}"));
                }
                sign = if place.sign() == 0.0 { sign } else { place.sign() };
            }
        }
    }
    if clear {
        Opinion::Agrees
    } else {
        Opinion::None
    }
}

fn refuted(claim: &MachineClaim, witness: &Witness) -> Opinion {
    let legs = match &witness.machine {
        Some(legs) => from_fn(|i| leg(&legs[i], Choice::Least)),
        None => machine(claim, Choice::Least),
    };
    let p = from_fn(|k| approximate(&witness.point[k]));
    let place = match look(legs, p) {
        // Whatever it says it violates, the claim is false there.
        Look::OutOfReach => return Opinion::Agrees,
        Look::Unclear => return Opinion::None,
        Look::Clear(place) => place,
    };
    if let Violation::Singular(second) = &witness.violates {
        let q = from_fn(|k| approximate(&second.other[k]));
        let Look::Clear(other) = look(legs, q) else { return Opinion::None };
        return match place.sign() * other.sign() {
            1.0 => Opinion::Contradicts(format!("det M has one sign at {p:?} and {q:?}")),
            -1.0 => Opinion::Agrees,
            _ => Opinion::None,
        };
    }
    if place.unviolated(claim, &witness.violates) {
        return Opinion::Contradicts(format!("{:?} at {p:?} of {legs:?}", witness.violates));
    }
    Opinion::Agrees
}
