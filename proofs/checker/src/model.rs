//! The model: a claim's numbers enclosed, in units in which they are of the order of one.
//!
//! For legs with numbers of their own the unit of length is `2^scale`, exactly; for the paper's
//! cube it is `L`, since `M` depends on `P/L` only. Transmission factors do not depend on it.

use crate::claim::{self, ClaimError, MachineClaim, Mechanism, Parameter, Range, Workspace};
use crate::enclosure::{Enclosure, Scalar};
use crate::fixed::Fixed;
use crate::kinematics::{Leg, Slider};
use crate::linear::Vector;
use crate::number::{Exact, NumberErrorKind};
use crate::trig::{cos_sin, pi};
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use std::array::from_fn;
use std::cmp::Ordering;

/// A machine, a workspace and bounds, enclosed.
#[derive(Clone, Debug)]
pub struct Model<S> {
    /// The three legs.
    pub legs: [Leg<S>; 3],
    /// `w_i = P + d_i - a_i` at the workspace's least corner, `u = 0`.
    pub origin: [Vector<S>; 3],
    /// The workspace's edges: `P = least corner + width * u` for `u` in `[0, 1]^3`.
    pub width: Vector<S>,
    /// What is to be shown.
    pub bounds: Bounds<S>,
    /// Whether this is the paper's cube, whose corners `Q_1`, `Q_2` may meet bounds with equality.
    pub is_cube: bool,
    /// Whether only the cylinder inscribed in the box's x and y is asked about.
    pub is_cylinder: bool,
    /// `scale` where the model's unit of length is `2^scale` of the claim's; `None` where it is the
    /// leg length of the paper's cube.
    pub unit_exponent: Option<i64>,
}

/// The bounds that the obligations are about, in model units.
#[derive(Clone, Debug)]
pub struct Bounds<S> {
    /// `kappa = 1/psi_max`; zero where there is no `psi_max`: then `sigma_min > 0` is to be shown.
    pub kappa: S,
    /// `1/psi_min`.
    pub k: Option<S>,
    /// Least and greatest `rho_i`.
    pub joint_range: Option<[JointRange<S>; 3]>,
    /// Greatest `sigma_max / sigma_min`.
    pub conditioning: Option<S>,
    /// The square of the least `|eta_i| / L_i`.
    pub serial_margin: Option<S>,
    /// Least `|det A| / (L_1 L_2 L_3)`.
    pub parallel_margin: Option<S>,
    /// The square of the cosine of the greatest angle between leg and guide.
    pub leg_angle: Option<S>,
    /// Greatest `|row_i of M|`, `V`. For arms it is an enclosure of `(max/tool) (pi/180)`, as `M`
    /// counts radians: a proof compares with its lower end, a violation with its upper one.
    pub joint_speed: Option<S>,
}

/// The range of a joint coordinate.
#[derive(Clone, Debug)]
pub enum JointRange<S> {
    /// Of a length.
    Length {
        /// Least value.
        min: Option<S>,
        /// Greatest value.
        max: Option<S>,
    },
    /// Of an angle, less than half a turn wide: cosine and sine of both ends.
    Angle {
        /// Of the least angle.
        min: (S, S),
        /// Of the greatest angle.
        max: (S, S),
    },
}

impl<S> JointRange<S> {
    fn map<T>(&self, convert: &impl Fn(&S) -> T) -> JointRange<T> {
        let pair = |(a, b): &(S, S)| (convert(a), convert(b));
        match self {
            JointRange::Length { min, max } => JointRange::Length {
                min: min.as_ref().map(convert),
                max: max.as_ref().map(convert),
            },
            JointRange::Angle { min, max } => JointRange::Angle { min: pair(min), max: pair(max) },
        }
    }
}

impl<S> Bounds<S> {
    fn map<T>(&self, convert: &impl Fn(&S) -> T) -> Bounds<T> {
        let optional = |x: &Option<S>| x.as_ref().map(convert);
        Bounds {
            kappa: convert(&self.kappa),
            k: optional(&self.k),
            joint_range: self.joint_range.as_ref().map(|r| from_fn(|i| r[i].map(convert))),
            conditioning: optional(&self.conditioning),
            serial_margin: optional(&self.serial_margin),
            parallel_margin: optional(&self.parallel_margin),
            leg_angle: optional(&self.leg_angle),
            joint_speed: optional(&self.joint_speed),
        }
    }
}

impl<S> Model<S> {
    /// The same model in another arithmetic; `convert` must enclose.
    pub fn map<T>(&self, convert: &impl Fn(&S) -> T) -> Model<T> {
        let vector = |v: &Vector<S>| from_fn(|k| convert(&v[k]));
        Model {
            legs: from_fn(|i| self.legs[i].map(convert)),
            origin: from_fn(|i| vector(&self.origin[i])),
            width: vector(&self.width),
            bounds: self.bounds.map(convert),
            is_cylinder: self.is_cylinder,
            is_cube: self.is_cube,
            unit_exponent: self.unit_exponent,
        }
    }
}

impl<S: Scalar> Model<S> {
    /// `w_i` for every leg at a displacement from the workspace's least corner.
    pub fn leg_vectors(&self, displacement: &Vector<S>) -> [Vector<S>; 3] {
        from_fn(|i| crate::linear::add(&self.origin[i], displacement))
    }
}

impl<S: Enclosure> Model<S> {
    /// `width * index / 2^level`, coordinate by coordinate.
    pub fn displacement(&self, parts: [(u128, u32); 3]) -> Vector<S> {
        from_fn(|k| {
            let (index, level) = parts[k];
            self.width[k].mul(&self.width[k].dyadic_like(index, level))
        })
    }
}

/// Numbers of a claim brought to the model's unit and enclosed.
pub struct Units {
    bits: u32,
    form: Form,
}

enum Form {
    /// `x / 2^scale`.
    PowerOfTwo(i64),
    /// `x / L` for the paper's cube, with its constants for `L = 1`.
    Cube(Box<CubeConstants>),
}

/// The paper's Steps 1 and 2 for `L = 1`; see proofs/README.md, section 1.
pub struct CubeConstants {
    /// `q_1 = -t_1 / sqrt(1 + 2 t_1^2) < 0`.
    pub q1: Exact,
    /// `q_2 = t_2 / sqrt(1 + 2 t_2^2) > 0`.
    pub q2: Exact,
    /// `tan(theta)` at `Q_1`, without its sign: `t_1 = (1 - kappa) / 2`.
    pub t1: Exact,
    /// `tan(theta)` at `Q_2`: `1 - kappa` for `kappa <= 1/2`, `(1/kappa - 1) / 2` above.
    pub t2: Exact,
    /// `1 / L`.
    pub inverse_length: Exact,
}

fn precision(what: &str) -> ClaimError {
    ClaimError::Precision(what.to_owned())
}

impl CubeConstants {
    /// The constants for `psi_max > 1` and a cube of this side.
    pub fn new(psi_max: &Exact, side: &Exact) -> Result<Self, ClaimError> {
        let kappa = Exact::integer(1).over(psi_max.clone());
        let (t1, t2) = kappa
            .and_then(|kappa| corner_tangents(&kappa))
            .map_err(|_| precision("transmission.max"))?;
        let constants = || {
            let q1 = sine_of(&t1)?.negated();
            let q2 = sine_of(&t2)?;
            let inverse_length = q2.clone().minus(q1.clone())?.over(side.clone())?;
            Ok((q1, q2, inverse_length))
        };
        let (q1, q2, inverse_length) =
            constants().map_err(|_: NumberErrorKind| precision("workspace.cube"))?;
        Ok(CubeConstants { q1, q2, t1, t2, inverse_length })
    }
}

/// `(t_1, t_2)` for `0 < kappa < 1`.
fn corner_tangents(kappa: &Exact) -> Result<(Exact, Exact), NumberErrorKind> {
    let two = Exact::integer(2);
    let rest = Exact::integer(1).minus(kappa.clone())?;
    let t1 = rest.clone().over(two.clone())?;
    let half = Exact::integer(1).over(two.clone())?;
    let t2 = match kappa.compare(&half) {
        // At 1/2 both forms agree.
        Some(Ordering::Less | Ordering::Equal) => rest,
        Some(Ordering::Greater) => {
            Exact::integer(1).over(kappa.clone())?.minus(Exact::integer(1))?.over(two)?
        }
        None => return Err(NumberErrorKind::TooLarge),
    };
    Ok((t1, t2))
}

/// `sin(beta) = t / sqrt(1 + 2 t^2)`: the coordinate of the diagonal point whose leg has
/// `tan(theta) = t`, for `L = 1`.
fn sine_of(t: &Exact) -> Result<Exact, NumberErrorKind> {
    let square = t.clone().times(t.clone())?;
    let root = square.times(Exact::integer(2))?.plus(Exact::integer(1))?.root()?;
    t.clone().over(root)
}

impl Units {
    /// The units in which `claim` is modelled, at a precision of `bits`.
    pub fn new(claim: &MachineClaim, bits: u32) -> Result<Self, ClaimError> {
        let form = match (&claim.mechanism, &claim.workspace) {
            (Mechanism::Translational(legs), _) => Form::PowerOfTwo(scale_of(legs)),
            (Mechanism::Orthoglide { .. }, Workspace::Cube { side }) => {
                let psi_max = claim.requirements.transmission.as_ref().and_then(|t| t.max.as_ref());
                let psi_max = psi_max.ok_or(ClaimError::CubeNeedsPsiMax)?;
                Form::Cube(Box::new(CubeConstants::new(psi_max, side)?))
            }
            _ => return Err(ClaimError::CubeNeedsOrthoglide),
        };
        Ok(Units { bits, form })
    }

    /// An inverse length (of arms: angle per length) in the model's unit.
    fn inverse_length(&self, x: &Exact, what: &str) -> Result<Fixed, ClaimError> {
        let scale = self.exponent().unwrap_or(0);
        x.enclose(-scale, self.bits).ok_or_else(|| precision(what))
    }

    /// A length in the model's unit.
    fn length(&self, x: &Exact, what: &str) -> Result<Fixed, ClaimError> {
        let enclosed = match &self.form {
            Form::PowerOfTwo(scale) => x.enclose(*scale, self.bits),
            Form::Cube(cube) => {
                let scaled = x.clone().times(cube.inverse_length.clone());
                scaled.ok().and_then(|x| x.enclose(0, self.bits))
            }
        };
        enclosed.ok_or_else(|| precision(what))
    }

    fn number(&self, x: &Exact, what: &str) -> Result<Fixed, ClaimError> {
        x.enclose(0, self.bits).ok_or_else(|| precision(what))
    }

    fn exponent(&self) -> Option<i64> {
        match self.form {
            Form::PowerOfTwo(scale) => Some(scale),
            Form::Cube(_) => None,
        }
    }

    fn zero(&self) -> Fixed {
        Fixed::integer(0, self.bits)
    }
}

/// `scale` with `2^scale` near the largest leg length: a choice of unit, with no effect on what is
/// true of the enclosures.
fn scale_of(legs: &[claim::Leg; 3]) -> i64 {
    let parameters = || legs.iter().flat_map(claim::Leg::parameters);
    let lengths = || parameters().filter(|(p, _)| p.is_length()).map(|(_, q)| &q.max);
    if lengths().next().is_some() {
        magnitude(lengths())
    } else {
        let places = parameters().filter(|(p, _)| !p.is_direction());
        magnitude(places.flat_map(|(_, q)| [&q.min, &q.max]))
    }
}

/// The exponent of the power of two next to the largest absolute value; 0 if all are zero.
fn magnitude<'a>(numbers: impl Iterator<Item = &'a Exact>) -> i64 {
    let bits = |n: &num_bigint::BigInt| i64::try_from(n.bits()).unwrap_or(i64::MAX / 4);
    let size = |x: &BigRational| (!x.is_zero()).then(|| bits(x.numer()) - bits(x.denom()));
    let sizes = numbers.filter_map(|x| match x.as_rational() {
        Some(x) => size(x),
        None => size(&x.enclose(0, 256)?.sup().abs()),
    });
    sizes.max().unwrap_or(0)
}

impl Workspace {
    /// The least and greatest coordinates of a box or cylinder.
    pub fn bounding_box(&self) -> Result<([Exact; 3], [Exact; 3]), ClaimError> {
        match self {
            Workspace::Box { min, max } => Ok((min.clone(), max.clone())),
            Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => {
                let ends = |c: &Exact| {
                    let (c, r) = (c.clone(), radius.clone());
                    Ok((c.clone().minus(r.clone())?, c.plus(r)?))
                };
                let ends = |c| ends(c).map_err(|_: NumberErrorKind| precision("workspace"));
                let ((x0, x1), (y0, y1)) = (ends(x)?, ends(y)?);
                Ok(([x0, y0, low.clone()], [x1, y1, high.clone()]))
            }
            Workspace::Cube { .. } => Err(ClaimError::CubeNeedsOrthoglide),
        }
    }
}

impl Model<Fixed> {
    /// The model of a valid claim at a precision of `bits` fractional bits.
    pub fn new(claim: &MachineClaim, bits: u32) -> Result<Self, ClaimError> {
        claim.validate()?;
        let units = Units::new(claim, bits)?;
        let (legs, origin, width) = match (&claim.mechanism, &claim.workspace, &units.form) {
            (Mechanism::Translational(legs), _, Form::PowerOfTwo(_)) => {
                let (min, max) = claim.workspace.bounding_box()?;
                let (legs, origin) = translational(legs, &min, &units)?;
                let mut width = [units.zero(), units.zero(), units.zero()];
                for k in 0..3 {
                    let edge = max[k].clone().minus(min[k].clone());
                    let edge = edge.map_err(|_| precision("workspace"))?;
                    width[k] = units.length(&edge, "workspace")?;
                }
                (legs, origin, width)
            }
            (Mechanism::Orthoglide { .. }, Workspace::Cube { .. }, Form::Cube(cube)) => {
                let side = cube.q2.clone().minus(cube.q1.clone());
                let side = side.map_err(|_| precision("workspace.cube"))?;
                let side = units.number(&side, "workspace.cube")?;
                let q1 = units.number(&cube.q1, "workspace.cube")?;
                let zero = [units.zero(), units.zero(), units.zero()];
                let (legs, origin) = orthoglide(&[q1.clone(), q1.clone(), q1], &zero, bits)?;
                (legs, origin, [side.clone(), side.clone(), side])
            }
            _ => return Err(ClaimError::CubeNeedsOrthoglide),
        };
        Model::assemble(claim, &units, (legs, origin), width)
    }

    fn assemble(
        claim: &MachineClaim,
        units: &Units,
        (legs, origin): LegsAndOrigin,
        width: Vector<Fixed>,
    ) -> Result<Self, ClaimError> {
        Ok(Model {
            legs,
            origin,
            width,
            bounds: bounds(claim, units)?,
            is_cube: matches!(claim.workspace, Workspace::Cube { .. }),
            is_cylinder: matches!(claim.workspace, Workspace::Cylinder { .. }),
            unit_exponent: units.exponent(),
        })
    }

    /// The model of one machine at one point: of zero width, so that `u = 0` is `point`.
    /// `machine` replaces the claim's legs.
    pub fn at_point(
        claim: &MachineClaim,
        machine: Option<&[claim::Leg; 3]>,
        point: &[Exact; 3],
        bits: u32,
    ) -> Result<Self, ClaimError> {
        claim.validate()?;
        let units = Units::new(claim, bits)?;
        let (legs, origin) = match (&claim.mechanism, &units.form) {
            (Mechanism::Translational(legs), _) => {
                translational(machine.unwrap_or(legs), point, &units)?
            }
            (Mechanism::Orthoglide { .. }, Form::Cube(cube)) => {
                let q1 = units.number(&cube.q1, "workspace.cube")?;
                let mut p = [units.zero(), units.zero(), units.zero()];
                for k in 0..3 {
                    p[k] = units.length(&point[k], "point")?;
                }
                let from_q1 = from_fn(|k| p[k].sub(&q1));
                orthoglide(&p, &from_q1, bits)?
            }
            _ => return Err(ClaimError::CubeNeedsOrthoglide),
        };
        let width = [units.zero(), units.zero(), units.zero()];
        Model::assemble(claim, &units, (legs, origin), width)
    }
}

type LegsAndOrigin = ([Leg<Fixed>; 3], [Vector<Fixed>; 3]);

fn translational(
    legs: &[claim::Leg; 3],
    least: &[Exact; 3],
    units: &Units,
) -> Result<LegsAndOrigin, ClaimError> {
    let [a, b, c] = [
        leg_and_origin(&legs[0], least, units, 1)?,
        leg_and_origin(&legs[1], least, units, 2)?,
        leg_and_origin(&legs[2], least, units, 3)?,
    ];
    Ok(([a.0, b.0, c.0], [a.1, b.1, c.1]))
}

fn leg_and_origin(
    leg: &claim::Leg,
    least: &[Exact; 3],
    units: &Units,
    number: usize,
) -> Result<(Leg<Fixed>, Vector<Fixed>), ClaimError> {
    let parameters = leg.parameters();
    // A direction's own size does not matter: it is brought to the order of one.
    let size = |kind: Parameter| {
        let directions = parameters.iter().filter(|(p, _)| *p == kind);
        magnitude(directions.flat_map(|(_, q)| [&q.min, &q.max]))
    };
    let end = |parameter: Parameter, x: &Exact| {
        let what = format!("leg {number}: {parameter}");
        match parameter.is_direction() {
            true => x.enclose(size(parameter), units.bits).ok_or_else(|| precision(&what)),
            false => units.length(x, &what),
        }
    };
    let enclosed = parameters.iter().map(|&(parameter, q)| {
        let min = end(parameter, &q.min)?;
        match q.is_exact() {
            true => Ok(min),
            false => Ok(min.hull(&end(parameter, &q.max)?)),
        }
    });
    let enclosed: Vec<Fixed> = enclosed.collect::<Result<_, ClaimError>>()?;
    let (leg, offset) = Leg::new(leg, &enclosed)
        .ok_or_else(|| ClaimError::ZeroDirection(format!("leg {number}: direction")))?;
    let mut origin = offset;
    for (w, p) in origin.iter_mut().zip(least) {
        *w = w.add(&units.length(p, "workspace")?);
    }
    Ok((leg, origin))
}

/// The Orthoglide with `L = 1` and `a = q_1 - e - L`: `w_i = P - e e_i - a e_i`, whose `i`-th
/// coordinate is `P_i - q_1 + L`.
fn orthoglide(
    p: &Vector<Fixed>,
    from_q1: &Vector<Fixed>,
    bits: u32,
) -> Result<LegsAndOrigin, ClaimError> {
    let one = Fixed::integer(1, bits);
    let leg = |i: usize| {
        let e_i = from_fn(|k| Fixed::integer(i64::from(i == k), bits));
        Slider::new(&e_i, &one, claim::WorkingMode::Plus)
            .map(Leg::Slider)
            .ok_or_else(|| precision("mechanism"))
    };
    let origin = from_fn(|i| from_fn(|k| if i == k { one.add(&from_q1[k]) } else { p[k].clone() }));
    Ok(([leg(0)?, leg(1)?, leg(2)?], origin))
}

fn bounds(claim: &MachineClaim, units: &Units) -> Result<Bounds<Fixed>, ClaimError> {
    let requirements = &claim.requirements;
    let angular = claim.mechanism.is_angular();
    // M has the unit of an inverse length for arms, and none for other drives.
    let rate = |x: &Exact, what: &str| {
        if angular {
            units.inverse_length(x, what)
        } else {
            units.number(x, what)
        }
    };
    let quotient =
        |x: &Exact, y: &Exact, what: &str| x.clone().over(y.clone()).map_err(|_| precision(what));
    let inverse = |psi: &Exact, what: &str| rate(&quotient(&Exact::integer(1), psi, what)?, what);
    let transmission = requirements.transmission.as_ref();
    let psi_max = transmission.and_then(|t| t.max.as_ref());
    let psi_min = transmission.and_then(|t| t.min.as_ref());
    let kappa = match psi_max {
        Some(psi) => inverse(psi, "transmission.max")?,
        None => units.zero(),
    };
    let k = match (&units.form, psi_min, psi_max) {
        (Form::Cube(_), _, Some(psi)) => Some(units.number(psi, "transmission.max")?),
        (_, Some(psi), _) => Some(inverse(psi, "transmission.min")?),
        _ => None,
    };
    let joint_range = match &requirements.joint_range {
        Some([a, b, c]) => Some([
            joint_range(a, angular, units)?,
            joint_range(b, angular, units)?,
            joint_range(c, angular, units)?,
        ]),
        None => None,
    };
    let number = |x: Option<&Exact>, what: &str| x.map(|x| units.number(x, what)).transpose();
    let at_most = |x: &Option<claim::AtMost>| x.as_ref().map(|x| x.max.clone());
    let at_least = |x: &Option<claim::AtLeast>| x.as_ref().map(|x| x.min.clone());
    let serial_margin = number(at_least(&requirements.serial_margin).as_ref(), "serial_margin")?;
    let leg_angle = match at_most(&requirements.leg_angle) {
        Some(angle) => Some(cos_sin(&angle, units.bits).ok_or_else(|| precision("leg_angle"))?.0),
        None => None,
    };
    let joint_speed = match &requirements.joint_speed {
        Some(speed) => {
            let ratio = quotient(&speed.max, &speed.tool, "joint_speed")?;
            Some(if angular {
                let half_turns = quotient(&ratio, &Exact::integer(180), "joint_speed")?;
                rate(&half_turns, "joint_speed")?.mul(&pi(units.bits))
            } else {
                rate(&ratio, "joint_speed")?
            })
        }
        None => None,
    };
    Ok(Bounds {
        kappa,
        k,
        joint_range,
        conditioning: number(at_most(&requirements.conditioning).as_ref(), "conditioning")?,
        serial_margin: serial_margin.map(|m| m.sqr()),
        parallel_margin: number(
            at_least(&requirements.parallel_margin).as_ref(),
            "parallel_margin",
        )?,
        leg_angle: leg_angle.map(|c| c.sqr()),
        joint_speed,
    })
}

fn joint_range(
    range: &Range,
    angular: bool,
    units: &Units,
) -> Result<JointRange<Fixed>, ClaimError> {
    if !angular {
        let end =
            |x: &Option<Exact>| x.as_ref().map(|x| units.length(x, "joint_range")).transpose();
        return Ok(JointRange::Length { min: end(&range.min)?, max: end(&range.max)? });
    }
    let end = |x: &Option<Exact>| {
        let angle = x.as_ref().and_then(|x| cos_sin(x, units.bits));
        angle.ok_or_else(|| precision("joint_range"))
    };
    Ok(JointRange::Angle { min: end(&range.min)?, max: end(&range.max)? })
}
