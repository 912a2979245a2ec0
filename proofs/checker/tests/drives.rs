//! Drives and the rules about their joints: against direct geometry, over random boxes, and by
//! tables of what is accepted and rejected.

use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_checker::cell::{Axis, Cell};
use orthocert_checker::certificate::{LegNumber, Violation};
use orthocert_checker::claim::{
    self, AtLeast, AtMost, JointSpeed, MachineClaim, Mechanism, Quantity, Range, Requirements,
    WorkingMode, Workspace,
};
use orthocert_checker::enclosure::{Enclosure, Scalar};
use orthocert_checker::expansion::{Expansion, ExpansionPoint};
use orthocert_checker::fixed::Fixed;
use orthocert_checker::kinematics::{JointCoordinate, Leg};
use orthocert_checker::linear::Vector;
use orthocert_checker::model::Model;
use orthocert_checker::number::Exact;
use orthocert_checker::rule::{self, Failure};

const BITS: u32 = 128;
type V = [f64; 3];

/// SplitMix64, so that a failure is the same on every machine.
struct Random(u64);

impl Random {
    fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A multiple of 2^-20 in `[least, greatest)`.
    fn within(&mut self, least: f64, greatest: f64) -> f64 {
        let part = (self.word() >> 11) as f64 / (1u64 << 53) as f64;
        ((least + (greatest - least) * part) * f64::from(1 << 20)).round() / f64::from(1 << 20)
    }

    fn vector(&mut self, size: f64) -> V {
        [self.within(-size, size), self.within(-size, size), self.within(-size, size)]
    }
}

fn exact(x: f64) -> Exact {
    Exact::Rational(BigRational::from_float(x).unwrap())
}

fn quantities(v: V) -> [Quantity; 3] {
    v.map(|x| Quantity::exactly(exact(x)))
}

fn fixed(x: f64) -> Fixed {
    Fixed::rational(&BigRational::from_float(x).unwrap(), 0, BITS)
}

fn point(v: V) -> Vector<Fixed> {
    v.map(fixed)
}

fn near(x: &Fixed, value: f64, tolerance: f64) -> bool {
    let middle = exact(value);
    let distance = x.sub(&middle.enclose(0, BITS).unwrap());
    distance.sub(&fixed(tolerance)).upper() < 0.into()
        && distance.add(&fixed(tolerance)).lower() > 0.into()
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: V, b: V, factor: f64) -> V {
    std::array::from_fn(|k| a[k] + factor * b[k])
}

fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn leg(claim: &claim::Leg) -> (Leg<Fixed>, Vector<Fixed>) {
    let parameters: Vec<Fixed> =
        claim.parameters().iter().map(|(_, q)| q.min.enclose(0, BITS).unwrap()).collect();
    Leg::new(claim, &parameters).unwrap()
}

/// One leg of each drive and mode, with unit vectors along the axes where directions matter.
fn legs(random: &mut Random) -> Vec<claim::Leg> {
    let (anchor, platform) = (random.vector(0.5), random.vector(0.25));
    let both = [WorkingMode::Plus, WorkingMode::Minus];
    let mut all = vec![
        claim::Leg::Strut { anchor: quantities(anchor), platform: quantities(platform) },
        claim::Leg::Planar { direction: quantities([0.6, random.within(0.1, 1.0), -0.3]) },
    ];
    let reference = [random.within(0.25, 1.0), random.within(-1.0, 1.0), 0.0];
    for mode in both {
        all.push(claim::Leg::Slider {
            direction: quantities([random.within(0.25, 1.0), random.within(-1.0, 1.0), 0.5]),
            anchor: quantities(anchor),
            platform: quantities(platform),
            length: Quantity::exactly(exact(random.within(2.0, 3.0))),
            mode,
        });
        all.push(claim::Leg::Arm {
            axis: quantities([0.0, 0.0, random.within(0.5, 2.0)]),
            reference: quantities(reference),
            anchor: quantities(anchor),
            platform: quantities(platform),
            arm: Quantity::exactly(exact(random.within(0.8, 1.2))),
            length: Quantity::exactly(exact(random.within(1.6, 2.0))),
            mode,
        });
    }
    all
}

/// The angle at which `|w - u| = length` with the leg's component along the elbow's motion of the
/// sign of `mode`: found by bisection of the circle, none if it is not unique.
fn angle(w: V, e: V, f: V, arm: f64, length: f64, mode: f64) -> Option<f64> {
    let elbow = |t: f64| add([0.0; 3], add(e.map(|x| x * t.cos()), f, t.sin()), arm);
    let gap = |t: f64| dot(add(w, elbow(t), -1.0), add(w, elbow(t), -1.0)) - length * length;
    let motion = |t: f64| dot(add(w, elbow(t), -1.0), add(f.map(|x| x * t.cos()), e, -t.sin()));
    let step = std::f64::consts::TAU / 720.0;
    let mut found = (0..720).filter_map(|i| {
        let (mut a, mut b) = (f64::from(i) * step, f64::from(i + 1) * step);
        if gap(a).signum() == gap(b).signum() {
            return None;
        }
        for _ in 0..60 {
            let m = (a + b) / 2.0;
            if gap(m).signum() == gap(a).signum() {
                a = m;
            } else {
                b = m;
            }
        }
        (motion(a) * mode > 0.0).then_some(a)
    });
    let first = found.next()?;
    found.next().is_none().then_some(first)
}

#[test]
fn an_arm_of_whole_numbers_has_the_row_that_the_geometry_gives() {
    let at = |x: f64| Quantity::exactly(exact(x));
    for (mode, w, row) in [
        (WorkingMode::Plus, [3.0, 4.0, 3.0], [0.0, 1.0 / 3.0, 0.25]),
        (WorkingMode::Minus, [3.0, -4.0, 3.0], [0.0, 1.0 / 3.0, -0.25]),
    ] {
        let arm = claim::Leg::Arm {
            axis: quantities([0.0, 0.0, 7.0]),
            reference: quantities([2.0, 0.0, 0.0]),
            anchor: quantities([0.0; 3]),
            platform: quantities([0.0; 3]),
            arm: at(3.0),
            length: at(5.0),
            mode,
        };
        // The elbow at (3, 0, 0) is 5 away from w; the leg is (0, +-4, 3), the motion (0, 1, 0).
        let state = leg(&arm).0.at(&point(w)).unwrap();
        let JointCoordinate::Angle { cos, sin } = &state.rho else { panic!("an angle") };
        assert!(near(cos, 1.0, 1e-30) && near(sin, 0.0, 1e-30), "{mode:?}");
        for (entry, expected) in state.row.iter().zip(row) {
            assert!(near(entry, expected, 1e-15), "{mode:?} {expected}");
        }
    }
}

#[test]
fn arms_meet_their_legs_and_their_rows_are_derivatives() {
    let mut random = Random(3);
    let (mut met, step) = (0, 1e-4);
    for _ in 0..200 {
        for claim in legs(&mut random) {
            let claim::Leg::Arm { reference, arm, length, mode, .. } = &claim else { continue };
            let number = |x: &Exact| x.enclose(0, 40).unwrap().lo().to_string().parse::<f64>();
            let number = |x: &Exact| number(x).unwrap() / f64::from(1 << 20).powi(2);
            let reference = [0, 1, 2].map(|k| number(&reference[k].min));
            let e = reference.map(|x| x / dot(reference, reference).sqrt());
            let f = cross([0.0, 0.0, 1.0], e);
            let (r, l, m) = (number(&arm.min), number(&length.min), mode.as_integer() as f64);
            let w = random.vector(1.8);
            let Some(state) = leg(&claim).0.at(&point(w)) else { continue };
            let Some(theta) = angle(w, e, f, r, l, m) else { continue };
            let JointCoordinate::Angle { cos, sin } = &state.rho else { panic!("an angle") };
            assert!(near(cos, theta.cos(), 1e-9) && near(sin, theta.sin(), 1e-9));
            let unit = |k| std::array::from_fn(|j| if j == k { 1.0 } else { 0.0 });
            for k in 0..3 {
                let moved = |h: f64| angle(add(w, unit(k), h), e, f, r, l, m);
                let (Some(a), Some(b)) = (moved(-step), moved(step)) else { continue };
                let slope = (b - a) / (2.0 * step);
                if slope.abs() < 5.0 {
                    assert!(near(&state.row[k], slope, 1e-4), "{claim:?} {w:?}");
                    met += 1;
                }
            }
        }
    }
    assert!(met > 300, "{met}");
}

/// Whether `difference` is enclosed by `slope (P - c)`.
fn encloses(slope: &[Fixed; 3], delta: &Vector<Fixed>, difference: &Fixed) -> bool {
    let product = (0..3).fold(fixed(0.0), |sum, k| sum.add(&slope[k].mul(&delta[k])));
    product.intersection(difference).is_some()
}

#[test]
fn slopes_enclose_differences_over_random_boxes() {
    let mut random = Random(5);
    let mut met = [0; 3];
    for _ in 0..120 {
        for claim in legs(&mut random) {
            let (leg, origin) = leg(&claim);
            let corner = random.vector(1.2);
            let size = random.within(0.01, 0.3);
            let inside = |random: &mut Random| {
                // Often on a face: differences are largest there.
                corner.map(|x| match random.word() % 4 {
                    0 => x,
                    1 => x + size,
                    _ => x + random.within(0.0, size),
                })
            };
            let (c, p) = (inside(&mut random), inside(&mut random));
            let w =
                |p: V| -> Vector<Fixed> { std::array::from_fn(|k| origin[k].add(&fixed(p[k]))) };
            let (low, high) = (w(corner), w(corner.map(|x| x + size)));
            let over: Vector<Fixed> = std::array::from_fn(|k| low[k].join(&high[k]));
            let delta: Vector<Fixed> = std::array::from_fn(|k| fixed(p[k]).sub(&fixed(c[k])));
            let Some(expansion) = leg.expand(&w(c), &over) else { continue };
            let (at_c, at_p) = (leg.at(&w(c)).unwrap(), leg.at(&w(p)).unwrap());
            for j in 0..3 {
                let difference = at_p.row[j].sub(&at_c.row[j]);
                assert!(encloses(&expansion.slope[j], &delta, &difference), "{claim:?}");
                assert!(expansion.row[j].intersection(&at_c.row[j]).is_some(), "{claim:?}");
            }
            met[0] += 1;
            if let (Some((rho, slope)), JointCoordinate::Length(c), JointCoordinate::Length(p)) =
                (&expansion.rho, &at_c.rho, &at_p.rho)
            {
                assert!(encloses(slope, &delta, &p.sub(c)) && rho.intersection(c).is_some());
                met[1] += 1;
            }
            let alone = |p: V| leg.expand_unit(&w(p), &w(p)).unwrap().0;
            let (unit, slope) = leg.expand_unit(&w(c), &over).unwrap();
            for j in 0..3 {
                let difference = alone(p)[j].sub(&alone(c)[j]);
                assert!(encloses(&slope[j], &delta, &difference), "{claim:?}");
                assert!(unit[j].intersection(&alone(c)[j]).is_some(), "{claim:?}");
            }
            // A unit vector that is a multiple of the row: rows and units have one direction.
            let (u, row) = (alone(c), &at_c.row);
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let minor = u[i].mul(&row[j]).sub(&u[j].mul(&row[i]));
                assert!(near(&minor, 0.0, 1e-25), "{claim:?}");
            }
            let length = u.iter().fold(fixed(0.0), |sum, x| sum.add(&x.sqr()));
            assert!(near(&length, 1.0, 1e-25), "{claim:?}");
            met[2] += 1;
        }
    }
    assert!(met.iter().all(|&n| n > 200), "{met:?}");
}

#[test]
fn a_tilted_reference_is_made_orthogonal() {
    let arm = |reference: V| claim::Leg::Arm {
        axis: quantities([0.0, 0.0, 1.0]),
        reference: quantities(reference),
        anchor: quantities([0.0; 3]),
        platform: quantities([0.0; 3]),
        arm: Quantity::exactly(exact(3.0)),
        length: Quantity::exactly(exact(5.0)),
        mode: WorkingMode::Plus,
    };
    let w = point([2.5, 3.5, 3.0]);
    let [straight, tilted] = [[1.0, 0.0, 0.0], [4.0, 0.0, 2.0]].map(|e| leg(&arm(e)).0.at(&w));
    let (straight, tilted) = (straight.unwrap(), tilted.unwrap());
    for k in 0..3 {
        assert!(straight.row[k].intersection(&tilted.row[k]).is_some());
    }
}

fn linear_delta(workspace: Workspace, requirements: Requirements) -> MachineClaim {
    let leg = |x: f64, y: f64| claim::Leg::Slider {
        direction: quantities([0.0, 0.0, 1.0]),
        anchor: quantities([x, y, 0.0]),
        platform: quantities([0.0; 3]),
        length: Quantity::exactly(exact(333.0)),
        mode: WorkingMode::Minus,
    };
    let (x, y) = (151.375, 87.375);
    let legs = [leg(0.0, 174.75), leg(-x, -y), leg(x, -y)];
    MachineClaim { mechanism: Mechanism::Translational(legs), workspace, requirements }
}

/// A small box of a linear Delta: `|x|, |y| <= half`, z in [0, 1].
fn small(half: f64, requirements: Requirements) -> Model<Fixed> {
    let min = [-half, -half, 0.0].map(exact);
    let max = [half, half, 1.0].map(exact);
    let claim = linear_delta(Workspace::Box { min, max }, requirements);
    Model::new(&claim, BITS).unwrap()
}

#[test]
fn margins_angles_and_speeds_are_decided_within_a_thousandth() {
    // At the centre r = 174.75 for leg 1 and hypot(151.375, 87.375) for the others: |eta|/L is
    // 0.8512..., |row| its inverse, and det the triangle's; on a box of 0.002 they hardly vary.
    let cosine = (1.0 - (174.785 / 333.0f64).powi(2)).sqrt();
    let degrees = cosine.acos().to_degrees();
    let (at_least, at_most) = (|min| Some(AtLeast { min }), |max| Some(AtMost { max }));
    let none = Requirements::default;
    let scaled = |factor: f64, value: f64| exact(value * factor);
    for (factor, holds) in [(0.999, true), (1.001, false)] {
        let margin = Requirements { serial_margin: at_least(scaled(factor, cosine)), ..none() };
        let model = small(0.001, margin);
        assert_eq!(rule::serial_margin(&model, &Cell::ROOT).is_ok(), holds);
        let angle = Requirements { leg_angle: at_most(scaled(1.0 / factor, degrees)), ..none() };
        assert_eq!(rule::leg_angle(&small(0.001, angle), &Cell::ROOT).is_ok(), holds);
        let speed = JointSpeed { tool: exact(1000.0), max: scaled(1.0 / factor, 1000.0 / cosine) };
        let model = small(0.001, Requirements { joint_speed: Some(speed), ..none() });
        let expansion = Expansion::new(&model, &Cell::ROOT, ExpansionPoint::Centre).unwrap();
        assert_eq!(rule::speed(&model, &expansion).is_ok(), holds);
        let unit = |x: f64, y: f64| {
            let z = -(333.0f64 * 333.0 - x * x - y * y).sqrt();
            [x / 333.0, y / 333.0, -z / 333.0]
        };
        let det =
            dot(unit(0.0, 174.75), cross(unit(-151.375, -87.375), unit(151.375, -87.375))).abs();
        let margin = Requirements { parallel_margin: at_least(scaled(factor, det)), ..none() };
        assert_eq!(rule::parallel_margin(&small(0.001, margin), &Cell::ROOT).is_ok(), holds);
    }
    let nothing = small(1.0, none());
    assert_eq!(rule::serial_margin(&nothing, &Cell::ROOT), Err(Failure::NoSuchBound));
    assert_eq!(rule::leg_angle(&nothing, &Cell::ROOT), Err(Failure::NoSuchBound));
    assert_eq!(rule::parallel_margin(&nothing, &Cell::ROOT), Err(Failure::NoSuchBound));
}

#[test]
fn margins_out_of_reach_are_rejected() {
    let all = Requirements {
        serial_margin: Some(AtLeast { min: exact(0.001) }),
        parallel_margin: Some(AtLeast { min: exact(0.001) }),
        leg_angle: Some(AtMost { max: exact(90.0) }),
        ..Requirements::default()
    };
    let model = small(300.0, all);
    assert!(rule::serial_margin(&model, &Cell::ROOT).is_err());
    assert!(rule::leg_angle(&model, &Cell::ROOT).is_err());
    assert!(rule::parallel_margin(&model, &Cell::ROOT).is_err());
}

fn cell(levels: &[(Axis, bool)]) -> Cell {
    levels.iter().fold(Cell::ROOT, |cell, &(axis, upper)| {
        let halves = cell.halves(axis).unwrap();
        if upper {
            halves.1
        } else {
            halves.0
        }
    })
}

#[test]
fn outside_holds_exactly_off_the_open_cylinder() {
    use Axis::{X, Y, Z};
    let z = [exact(0.0), exact(1.0)];
    let cylinder =
        Workspace::Cylinder { center: [exact(3.0), exact(-2.0)], radius: exact(80.0), z };
    let round = Model::new(&linear_delta(cylinder, Requirements::default()), BITS).unwrap();
    let quarter = [(X, false), (Y, false)];
    let eighth = [(X, false), (Y, false), (X, false), (Y, false)];
    // u = 1/8 is at 3/4 of the radius on each axis, 3/4 sqrt 2 > 1; u = 1/4 at 1/2, 1/2 sqrt 2 < 1.
    let tiny = [(X, false), (Y, false), (X, false), (Y, false), (X, false), (Y, false)];
    let next = [(X, false), (Y, false), (X, false), (Y, false), (X, true), (Y, true)];
    for (levels, outside) in [
        (&[] as &[_], false),
        (&quarter, false),
        (&eighth, false),
        (&tiny, true),
        (&next, false),
        (&[(Z, true)], false),
    ] {
        assert_eq!(rule::outside(&round, &cell(levels)).is_ok(), outside, "{levels:?}");
    }
    let square = small(80.0, Requirements::default());
    assert_eq!(rule::outside(&square, &cell(&tiny)), Err(Failure::NotOutside));
}

/// A rotary machine whose first arm stands at the angle 0 at the origin; the workspace is the
/// origin.
fn at_angle_zero(requirements: Requirements) -> Model<Fixed> {
    let arm = |axis: V, reference: V, w: V| claim::Leg::Arm {
        axis: quantities(axis),
        reference: quantities(reference),
        anchor: quantities(w.map(|x| -x)),
        platform: quantities([0.0; 3]),
        arm: Quantity::exactly(exact(3.0)),
        length: Quantity::exactly(exact(5.0)),
        mode: WorkingMode::Plus,
    };
    let legs = [
        arm([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [3.0, 4.0, 3.0]),
        arm([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, 3.0, 4.0]),
        arm([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [4.0, 3.0, 3.0]),
    ];
    let (least, greatest) = ([-1e-3; 3].map(exact), [1e-3; 3].map(exact));
    let workspace = Workspace::Box { min: least, max: greatest };
    let mechanism = Mechanism::Translational(legs);
    Model::new(&MachineClaim { mechanism, workspace, requirements }, BITS).unwrap()
}

#[test]
fn ranges_of_angles() {
    for (min, max, holds) in [
        (-1.0, 1.0, true),
        (-179.0, 0.5, true),
        (-0.5, 179.0, true),
        (-90.0, 80.0, true),
        (359.0, 360.0, false),
        (-360.0, -359.0, false),
        (0.5, 100.0, false),
        (-100.0, -0.5, false),
        (90.0, 269.0, false),
        (170.0, 190.0, false),
        (180.0, 180.0, false),
        (0.0, 0.0, false),
        // Up to whole turns.
        (-360.0, -182.0, false),
        (-361.0 + 1.5, -180.5, false),
        (300.0, 360.0, false),
    ] {
        let range = Range { min: Some(exact(min)), max: Some(exact(max)) };
        let joint_range = Some([range.clone(), range.clone(), range]);
        let model = at_angle_zero(Requirements { joint_range, ..Requirements::default() });
        let expansion = Expansion::new(&model, &Cell::ROOT, ExpansionPoint::Centre).unwrap();
        let found = rule::range(&model, &Cell::ROOT, &expansion);
        assert_eq!(found.is_ok(), holds, "[{min}, {max}]: {found:?}");
    }
}

/// At the origin, a leg `(0, 4, 3)` of length 5 is driven by an elbow 3 from the axis: it turns by
/// 5/12 radians, 23.87 degrees, per length.
#[test]
fn speeds_of_arms_are_in_degrees() {
    let model = |max: f64| {
        let joint_speed = Some(JointSpeed { tool: exact(100.0), max: exact(max) });
        at_angle_zero(Requirements { joint_speed, ..Requirements::default() })
    };
    let degrees = (500.0f64 / 12.0).to_degrees();
    for (max, certified, refuted) in [
        (1.01 * degrees, true, false),
        (0.99 * degrees, false, true),
        (1.01 * 500.0 / 12.0, false, true),
    ] {
        let model = model(max);
        let expansion = Expansion::new(&model, &Cell::ROOT, ExpansionPoint::Centre).unwrap();
        assert_eq!(rule::speed(&model, &expansion).is_ok(), certified, "{max}");
        let violation = Violation::JointSpeed(LegNumber { leg: 1 });
        assert_eq!(rule::violated(&model, &Cell::ROOT, &violation).is_ok(), refuted, "{max}");
    }
    // The bound is enclosed: (max/tool) (pi/180), per 2^2 lengths.
    let bound = model(18_000.0).bounds.joint_speed.unwrap();
    let number =
        |text: &str| Exact::parse(text, 100).unwrap().as_rational().unwrap() * BigInt::from(4);
    assert!(bound.inf() < number("3.14159265358979323846264338327950289"));
    assert!(bound.sup() > number("3.14159265358979323846264338327950288"));
    assert!(bound.hi() - bound.lo() < BigInt::from(100));
}
