//! What the figures show of a kernel claim: a machine with any number of legs, over any coordinates.

use super::contour::Field;
use super::evidence::{share, Row};
use super::isomap::{map, Map, Mark, Plane, Scale, NODES};
use super::legs::{across, unit, Numbers, Outline, Point, Shape};
use super::mechanism;
use super::sampled::{double, positions, Sampled, Sampler, Worst};
use super::scene::{Scene, Slice};
use super::subdivision::{pairs, Legend, Root, Subdivision};
use crate::decimal::significant;
use orthocert_kernel::certificate as kernel;
use orthocert_kernel::claim::{
    Body, Bound, Leg, MachineClaim, Mechanism, Orientation, Quantity, Requirement, Sign, Workspace,
};
use orthocert_kernel::number::Expression;
use std::array::from_fn;
use std::rc::Rc;

/// Values beyond this are not drawn: their powers would exceed the doubles.
const GREATEST: f64 = 1e60;
/// Operations of a tape beyond which maps have coarser grids.
const LONG: usize = 20_000;
/// Nodes of those on either side.
const FEW_NODES: usize = 25;
/// Margins below this may be rounding.
const NOISE: f64 = 1e-9;

/// A kernel claim in doubles.
struct General<'a> {
    claim: &'a MachineClaim,
    sampler: Option<Sampler>,
    names: Vec<String>,
    witness: Option<&'a kernel::Witness>,
}

/// What the figures and tables show.
pub fn scene(claim: &MachineClaim, proof: &kernel::Proof) -> Scene {
    let witness = match proof {
        kernel::Proof::Witness(witness) => Some(witness),
        kernel::Proof::Tree(_) => None,
    };
    let sampler = Sampler::new(claim)
        .filter(|sampler| sampler.root.iter().flatten().all(|x| x.abs() < GREATEST));
    let of = General { claim, sampler, names: names(claim), witness };
    let grid = of.sampler.as_ref().map(Sampler::grid).unwrap_or_default();
    let worst = of.sampler.as_ref().map(|sampler| sampler.worst(&grid)).unwrap_or_default();
    let marks = of.marks(&worst);
    Scene {
        shape: shape(claim),
        slices: of.slices(&grid, &worst),
        rows: of.rows(&worst),
        trees: vec![of.tree(proof)],
        marks,
    }
}

/// Names of the coordinates: of the position, then of the chart of the orientations.
fn names(claim: &MachineClaim) -> Vec<String> {
    let position = ["x", "y", "z"];
    let turned: &[&str] = match (&claim.mechanism, &claim.orientation) {
        (Mechanism::Formulas(formulas), _) => return formulas.coordinates.clone(),
        (_, None) => &[],
        (Mechanism::Planar(_), _) => &["t"],
        _ => &["c\u{2081}", "c\u{2082}", "c\u{2083}"],
    };
    let position = position.iter().take(positions(claim).unwrap_or(0));
    position.chain(turned).map(ToString::to_string).collect()
}

impl General<'_> {
    fn positions(&self) -> usize {
        positions(self.claim).unwrap_or(self.names.len())
    }

    /// The requirement of which the least margin was found.
    fn critical<'w>(
        &self,
        worst: &'w [Option<Worst>],
        but: Option<usize>,
    ) -> Option<(usize, &'w Worst)> {
        let found = worst.iter().enumerate().filter_map(|(i, w)| Some((i, w.as_ref()?)));
        let others = found.filter(|(i, _)| Some(*i) != but);
        others.min_by(|a, b| a.1.found.margin.total_cmp(&b.1.found.margin))
    }

    /// The points of a counterexample, or the one with the least margin that was found.
    fn marks(&self, worst: &[Option<Worst>]) -> Vec<Mark> {
        let point = |x: &[Expression]| x.iter().map(double).collect::<Option<Vec<f64>>>();
        let mark = |name: &str, at| Mark { name: name.to_owned(), at };
        let Some(witness) = self.witness else {
            let found = self.critical(worst, None);
            return found
                .map(|(_, worst)| mark("least margin", worst.at.clone()))
                .into_iter()
                .collect();
        };
        let mut all: Vec<Mark> =
            point(&witness.point).map(|at| mark("counterexample", at)).into_iter().collect();
        if let kernel::Failure::Singular(other) = &witness.fails {
            all.extend(point(other).map(|at| mark("P'", at)));
        }
        all
    }

    fn rows(&self, worst: &[Option<Worst>]) -> Vec<Row> {
        let row = |(number, requirement): (usize, &Requirement)| {
            let worst = worst.get(number).and_then(Option::as_ref);
            let mut row = Row {
                requirement: mechanism::quantity(requirement),
                bound: mechanism::bound(requirement),
                found: "\u{2013}".to_owned(),
                is_violated: false,
                margin: "\u{2013}".to_owned(),
                at: String::new(),
                machine: String::new(),
            };
            if let (Some(Worst { found, at, machine }), Some(sampler)) = (worst, &self.sampler) {
                let leg = found.leg.map_or(String::new(), |leg| format!(", leg {}", leg + 1));
                let of = if requirement.leg.is_none() { leg } else { String::new() };
                row.found = match found.value {
                    Some(value) => significant(value, 9) + &of,
                    None => format!("slack {}{of}", significant(found.margin, 4)),
                };
                row.is_violated = found.margin < -NOISE;
                row.margin = match found.value {
                    Some(_) => share(found.margin),
                    None => "\u{2013}".to_owned(),
                };
                row.at = self.place(at);
                let settings = sampler.settings(machine).into_iter();
                let settings =
                    settings.map(|(place, x)| format!("{place} = {}", significant(x, 9)));
                row.machine = settings.collect::<Vec<_>>().join(", ");
            }
            row
        };
        self.claim.require.iter().enumerate().map(row).collect()
    }

    /// A point in words.
    fn place(&self, at: &[f64]) -> String {
        // What the search left of a step about zero is none.
        let step = |k: usize| {
            let edge = self.sampler.as_ref().and_then(|s| s.root.get(k));
            edge.map_or(0.0, |[lo, hi]| 1e-6 * (hi - lo))
        };
        let one = |(k, (name, x)): (usize, (&String, &f64))| {
            let x = if x.abs() < step(k) { 0.0 } else { *x };
            format!("{name} = {}", significant(x, 6))
        };
        self.names.iter().zip(at).enumerate().map(one).collect::<Vec<_>>().join(", ")
    }

    fn tree(&self, proof: &kernel::Proof) -> Subdivision {
        let m = self.names.len();
        let root = match &self.sampler {
            Some(sampler) => sampler.root.clone(),
            None => vec![[0.0, 1.0]; m],
        };
        let mut axes = self.names.clone();
        axes.extend((axes.len()..root.len()).map(|k| format!("x{}", k + 1)));
        axes.truncate(root.len());
        let root = Root {
            positions: self.positions().min(axes.len()),
            least: root.iter().map(|[lo, _]| *lo).collect(),
            width: root.iter().map(|[lo, hi]| hi - lo).collect(),
            axes,
        };
        let kernel::Proof::Tree(tree) = proof else {
            return Subdivision::new("the workspace", root, &Rc::new(Legend::default()), &[]);
        };
        let mut requirements = vec!["freedom from singularities".to_owned()];
        requirements.extend(self.claim.require.iter().map(mechanism::formula));
        let of = |obligation: usize| {
            let requirement = self.sampler.as_ref().and_then(|s| s.requirement(obligation));
            requirement.map_or(0, |number| number + 1)
        };
        let (legend, nodes) = Legend::of_kernel(tree, requirements, &of);
        let name = match self.sampler {
            Some(_) => "the workspace",
            None => "the workspace, coordinates as parts of it",
        };
        Subdivision::new(name, root, &Rc::new(legend), &nodes)
    }

    /// Maps over pairs of coordinates, the others in the middle, or where the counterexample is: of
    /// the greatest psi, and of the other requirement of which the least margin was found.
    fn slices(&self, grid: &[Vec<f64>], worst: &[Option<Worst>]) -> Vec<Slice> {
        let Some(sampler) = &self.sampler else { return Vec::new() };
        let nominal = sampler.nominal();
        let sampled: Vec<Sampled> =
            grid.iter().filter_map(|p| sampler.values(&nominal, p)).collect();
        let m = sampler.root.len();
        let greatest = |s: &Sampled| s.psi.last().copied().filter(|_| s.psi.len() == m);
        let is_psi =
            |r: &Requirement| r.quantity == "transmission" && matches!(r.bound, Bound::Max(_));
        let of_psi = self.claim.require.iter().position(is_psi);
        let critical = self.critical(worst, of_psi).map(|(number, _)| number);
        let mut functions: Vec<Function<'_>> = vec![Function {
            file: "psi",
            heading: "greatest \u{3c8}".to_owned(),
            of: Box::new(greatest),
            worst: Box::new(move |s| greatest(s).map(|psi| -psi)),
        }];
        if let Some((number, requirement)) =
            critical.and_then(|n| Some((n, self.claim.require.get(n)?)))
        {
            functions.push(Function {
                file: "critical",
                heading: mechanism::formula(requirement),
                of: Box::new(move |s| s.of[number].map(|f| f.value.unwrap_or(f.margin))),
                worst: Box::new(move |s| s.of[number].map(|f| f.margin)),
            });
        }
        let scales: Vec<Option<Scale>> = functions
            .iter()
            .map(|f| Scale::over(vec![sampled.iter().filter_map(|s| (f.of)(s)).collect()]))
            .collect();
        let point = self.witness.and_then(|w| w.point.iter().map(double).collect());
        let base: Vec<f64> =
            point.filter(|p: &Vec<f64>| p.len() == m).unwrap_or_else(|| sampler.middle());
        let all = pairs(m, self.positions().min(m)).into_iter().enumerate();
        let slices =
            all.map(|(i, pair)| self.slice(sampler, i, pair, &base, (&functions, &scales)));
        slices.filter(|slice| !slice.maps.is_empty()).collect()
    }

    fn slice(
        &self,
        sampler: &Sampler,
        number: usize,
        [a, b]: [usize; 2],
        base: &[f64],
        (functions, scales): (&[Function<'_>], &[Option<Scale>]),
    ) -> Slice {
        let name = |k: usize| self.names.get(k).map_or("?", String::as_str);
        let root = [sampler.root[a], sampler.root[b]];
        let is_round =
            matches!(self.claim.workspace, Workspace::Cylinder { .. }) && [a, b] == [0, 1];
        let of_kind = |k: usize| k < self.positions();
        let is_of_users = matches!(self.claim.mechanism, Mechanism::Formulas(_));
        let same_kind = !is_of_users && of_kind(a) == of_kind(b);
        let width = root.map(|[lo, hi]| hi - lo);
        let plane =
            Plane::new(root.map(|[lo, _]| lo), width, [name(a), name(b)], is_round, same_kind);
        let nodes = if sampler.problem().tape.ops().len() > LONG { FEW_NODES } else { NODES };
        let nominal = sampler.nominal();
        let mut found: Vec<([f64; 2], Option<Sampled>)> = Vec::new();
        let out_of_reach = plane.field(nodes, |x, y| {
            let mut point = base.to_vec();
            (point[a], point[b]) = (x, y);
            found.push(([x, y], sampler.values(&nominal, &point)));
            if found.last().is_some_and(|(_, s)| s.is_some()) {
                -1.0
            } else {
                1.0
            }
        });
        let fixed = self.names.iter().zip(base).enumerate().filter(|(k, _)| *k != a && *k != b);
        let fixed: Vec<String> =
            fixed.map(|(_, (name, x))| format!("{name} = {}", significant(*x, 6))).collect();
        let fixed = fixed.join(", ");
        let at = if fixed.is_empty() { String::new() } else { format!(" at {fixed}") };
        let mut maps = Vec::new();
        let mut legends = Vec::new();
        for (function, scale) in functions.iter().zip(scales) {
            let Some(scale) = scale else { continue };
            let value = |s: &Option<Sampled>| s.as_ref().and_then(|s| (function.of)(s));
            let field = Field {
                values: found.iter().map(|(_, s)| value(s).unwrap_or(f64::NAN)).collect(),
                ..out_of_reach.clone()
            };
            let rank = |s: &Option<Sampled>| s.as_ref().and_then(|s| (function.worst)(s));
            let worst = found.iter().filter_map(|(at, s)| Some((rank(s)?, *at)));
            let worst = worst.min_by(|a, b| a.0.total_cmp(&b.0));
            let on_slice = |mark: &Mark| Some((mark.at.get(a).copied()?, mark.at.get(b).copied()?));
            let marks = if self.witness.is_some() { self.marks(&[]) } else { Vec::new() };
            let mut shown: Vec<(&str, [f64; 2])> = marks
                .iter()
                .take(1)
                .filter_map(|mark| on_slice(mark).map(|(x, y)| (mark.name.as_str(), [x, y])))
                .collect();
            shown.extend(worst.filter(|_| marks.is_empty()).map(|(_, at)| ("worst here", at)));
            maps.push(map(
                &plane,
                &Map {
                    name: &format!("{}-{}", function.file, number + 1),
                    heading: &function.heading,
                    title: format!(
                        "Lines of equal value of {} over {} and {}{at}",
                        function.heading,
                        name(a),
                        name(b)
                    ),
                    field: &field,
                    out_of_reach: &out_of_reach,
                    levels: &scale.maps[0],
                    marks: &shown,
                    script: None,
                },
            ));
            legends.push((function.heading.clone(), scale.legend()));
        }
        Slice { maps, legends, fixed }
    }
}

/// A number of what was sampled at a point.
type Of<'a> = Box<dyn Fn(&Sampled) -> Option<f64> + 'a>;

/// What a map is of.
struct Function<'a> {
    file: &'static str,
    heading: String,
    of: Of<'a>,
    /// Less is worse.
    worst: Of<'a>,
}

/// The nominal machine in the middle of its workspace; none of users' formulas, which say nothing of
/// where a leg is, and of numbers beyond what doubles can show.
pub fn shape(claim: &MachineClaim) -> Option<Shape> {
    let (least, width) = frame(claim)?;
    let legs = match &claim.mechanism {
        Mechanism::Formulas(_) => return None,
        Mechanism::Orthoglide { offset } => of_the_paper(claim, double(offset)?)?,
        mechanism => mechanism::legs(mechanism).iter().map(numbers).collect::<Option<_>>()?,
    };
    let is_flat = matches!(claim.mechanism, Mechanism::Planar(_));
    let is_round = matches!(claim.workspace, Workspace::Cylinder { .. });
    let mut outline = Outline::of(least, width, is_round);
    let turns_alone = matches!(claim.mechanism, Mechanism::Spherical(_));
    outline.rings.truncate(if turns_alone {
        0
    } else if is_flat {
        1
    } else {
        2
    });
    let grid = |n: u32| [n % 3, n / 3 % 3, n / 9].map(|i| f64::from(i) / 2.0);
    let place = |u: Point| -> Point { from_fn(|k| least[k] + u[k] * width[k]) };
    let ends = |from: &[Expression; 3], to: &[Expression; 3]| Some([point(from)?, point(to)?]);
    let mut bodies = [Vec::new(), Vec::new()];
    for body in &claim.bodies {
        match body {
            Body::Leg { .. } => {}
            Body::Base { from, to, .. } => bodies[0].extend(ends(from, to)),
            Body::Platform { from, to, .. } => bodies[1].extend(ends(from, to)),
        }
    }
    let shape = Shape {
        legs,
        position: place([0.5; 3]),
        rotation: rotation(claim.orientation.as_ref())?,
        outline,
        places: (0..27).map(|n| place(grid(n))).collect(),
        bodies,
        is_flat,
    };
    let poses = (0..shape.legs.len()).filter_map(|i| shape.pose(i, shape.position));
    let points = poses.flat_map(|pose| [pose.driven, pose.platform]).chain(shape.places.clone());
    let is_shown = points.flatten().all(|x| x.abs() < GREATEST);
    is_shown.then_some(shape)
}

/// The least corner and the edges of the box of positions; of less than three coordinates, with
/// zeros.
fn frame(claim: &MachineClaim) -> Option<(Point, Point)> {
    let (min, max) = match &claim.workspace {
        Workspace::Box { min, max } => (all(min)?, all(max)?),
        Workspace::Cylinder { center: [x, y], radius, z: [low, high] } => {
            let (x, y, r) = (double(x)?, double(y)?, double(radius)?);
            (vec![x - r, y - r, double(low)?], vec![x + r, y + r, double(high)?])
        }
        Workspace::Cube { side } => {
            let [q1, _, _] = of_cube(claim)?;
            (vec![q1; 3], vec![q1 + double(side)?; 3])
        }
    };
    let coordinate = |all: &[f64], k: usize| all.get(k).copied().unwrap_or(0.0);
    let least: Point = from_fn(|k| coordinate(&min, k));
    Some((least, from_fn(|k| coordinate(&max, k) - least[k])))
}

/// `q_1`, `q_2` and `L` of the paper's cube.
fn of_cube(claim: &MachineClaim) -> Option<Point> {
    let Workspace::Cube { side } = &claim.workspace else { return None };
    let psi_max = claim.require.iter().find_map(|requirement| match &requirement.bound {
        Bound::Max(bound) if requirement.quantity == "transmission" => double(bound),
        _ => None,
    });
    let kappa = 1.0 / psi_max?;
    let t1 = (1.0 - kappa) / 2.0;
    let t2 = if kappa <= 0.5 { 1.0 - kappa } else { (1.0 / kappa - 1.0) / 2.0 };
    let [q1, q2] = [-t1, t2].map(|t| t / (1.0 + 2.0 * t * t).sqrt());
    let length = double(side)? / (q2 - q1);
    Some([q1 * length, q2 * length, length])
}

/// The legs of the paper's Orthoglide.
fn of_the_paper(claim: &MachineClaim, offset: f64) -> Option<Vec<Numbers>> {
    let [q1, _, length] = of_cube(claim)?;
    let along = |i: usize, x: f64| -> Point { from_fn(|k| if k == i { x } else { 0.0 }) };
    let leg = |i: usize| Numbers::Slider {
        direction: along(i, 1.0),
        anchor: along(i, q1 - offset - length),
        platform: along(i, -offset),
        length,
        mode: 1.0,
    };
    Some((0..3).map(leg).collect())
}

/// The rows of `R` in the middle of a set of orientations.
fn rotation(orientation: Option<&Orientation>) -> Option<[Point; 3]> {
    let middle = |[min, max]: &[Expression; 2]| {
        let degrees = (double(min)? + double(max)?) / 2.0;
        Some(degrees.to_radians().sin_cos())
    };
    let still = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    match orientation {
        None | Some(Orientation::Angle(_) | Orientation::Tilt { .. }) => Some(still),
        Some(Orientation::Range(range)) => {
            let (s, c) = middle(range)?;
            Some([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        }
        Some(Orientation::RollPitchYaw { roll, pitch, yaw }) => {
            let ((sr, cr), (sp, cp), (sy, cy)) = (middle(roll)?, middle(pitch)?, middle(yaw)?);
            Some([
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ])
        }
    }
}

fn all(numbers: &[Expression]) -> Option<Vec<f64>> {
    numbers.iter().map(double).collect()
}

fn point(numbers: &[Expression; 3]) -> Option<Point> {
    let [x, y, z] = numbers;
    Some([double(x)?, double(y)?, double(z)?])
}

/// A leg with every quantity in the middle of its tolerance; in the plane with `z = 0`, and motors
/// about `+z` whose arms at angle 0 lie along x where nothing else is said.
fn numbers(leg: &Leg) -> Option<Numbers> {
    let middle = |q: &Quantity| {
        let [min, max] = q.ends();
        let (min, max) = (double(min)?, double(max)?);
        Some(min + (max - min) / 2.0)
    };
    let vector = |q: &[Quantity], absent: Point| -> Option<Point> {
        if q.is_empty() {
            return Some(absent);
        }
        let all: Vec<f64> = q.iter().map(middle).collect::<Option<_>>()?;
        Some(from_fn(|k| all.get(k).copied().unwrap_or(0.0)))
    };
    let sign = |mode: &Sign| mode.as_integer() as f64;
    let zero = [0.0; 3];
    Some(match leg {
        Leg::Slider { direction, anchor, platform, length, mode } => Numbers::Slider {
            direction: unit(vector(direction, zero)?)?,
            anchor: vector(anchor, zero)?,
            platform: vector(platform, zero)?,
            length: middle(length)?,
            mode: sign(mode),
        },
        Leg::Strut { anchor, platform, .. } => {
            Numbers::Strut { anchor: vector(anchor, zero)?, platform: vector(platform, zero)? }
        }
        Leg::Arm { axis, reference, anchor, platform, arm, length, mode } => {
            let axis = unit(vector(axis, [0.0, 0.0, 1.0])?)?;
            Numbers::Arm {
                axis,
                reference: across(vector(reference, [1.0, 0.0, 0.0])?, axis)?,
                anchor: vector(anchor, zero)?,
                platform: vector(platform, zero)?,
                arm: middle(arm)?,
                length: middle(length)?,
                mode: sign(mode),
            }
        }
        Leg::Planar { direction } => Numbers::Planar { direction: unit(vector(direction, zero)?)? },
    })
}

/// The counterexample in a table: names and values.
pub fn counterexample(claim: &MachineClaim, witness: &kernel::Witness) -> Vec<(String, String)> {
    let list = |x: &[Expression]| {
        let all: Vec<String> = x.iter().map(ToString::to_string).collect();
        format!("({})", all.join(", "))
    };
    let sampler = Sampler::new(claim);
    let mut rows = Vec::new();
    match &witness.fails {
        kernel::Failure::Reach => rows.push((
            "violated".to_owned(),
            "a leg does not reach the point, or is serially singular there".to_owned(),
        )),
        kernel::Failure::Singular(_) => {
            rows.push(("violated".to_owned(), "freedom from parallel singularities".to_owned()));
        }
        kernel::Failure::Obligation(number, _) => {
            let number = sampler.as_ref().and_then(|s| s.requirement(*number));
            let requirement = number.and_then(|n| claim.require.get(n));
            let what = requirement.map_or("freedom from singularities".to_owned(), |requirement| {
                format!("{}, {}", mechanism::quantity(requirement), mechanism::bound(requirement))
            });
            rows.push(("violated".to_owned(), what));
            let found = || {
                let sampler = sampler.as_ref()?;
                let machine = sampler.machine(&witness.machine)?;
                sampler.values(&machine, &all(&witness.point)?)?.of.get(number?).copied()?
            };
            if let Some(value) = found().and_then(|found| found.value) {
                rows.push(("value there, in floating point".to_owned(), significant(value, 9)));
            }
        }
    }
    rows.push((format!("at ({})", names(claim).join(", ")), list(&witness.point)));
    if let kernel::Failure::Singular(other) = &witness.fails {
        rows.push(("and, with the other sign of det M, at".to_owned(), list(other)));
    }
    if let Some(sampler) = &sampler {
        for ((place, _, _), x) in sampler.problem().tolerances().zip(&witness.machine) {
            rows.push((place.to_owned(), x.to_string()));
        }
    }
    if let kernel::Failure::Obligation(_, directions) = &witness.fails {
        for direction in directions {
            let all: Vec<String> = direction.iter().map(ToString::to_string).collect();
            rows.push(("moving along".to_owned(), format!("({})", all.join(", "))));
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::drawing::drawing;
    use crate::page::legs::{add, scaled};

    fn claim(mechanism: &str, workspace: &str, orientation: &str) -> MachineClaim {
        let text = format!(
            r#"{{"mechanism":{mechanism},"workspace":{{"box":{workspace}}},{orientation}"require":[]}}"#
        );
        serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"))
    }

    fn strut(anchor: &str, platform: &str) -> String {
        format!(r#"{{"drive":"strut","anchor":[{anchor}],"platform":[{platform}]}}"#)
    }

    fn length(shape: &Shape, leg: usize) -> f64 {
        let pose = shape.pose(leg, shape.position).unwrap();
        let d = add(pose.platform, scaled(-1.0, pose.driven));
        crate::page::legs::dot(d, d).sqrt()
    }

    fn drawn(shape: &Shape) -> String {
        let picture = drawing(shape, &[]);
        assert!(!picture.content.contains("NaN") && !picture.content.contains("inf"));
        picture.content
    }

    #[test]
    fn machines_in_the_plane_are_seen_from_above() {
        let legs = [
            strut(r#""0","0""#, r#""-1","0""#),
            r#"{"drive":"arm","axis":[],"reference":[],"anchor":["6","0"],"platform":["1","0"],"arm":"3","length":"4","mode":"+"}"#
                .to_owned(),
            r#"{"drive":"slider","direction":["1","0"],"anchor":["0","7"],"platform":["0","1"],"length":"5","mode":"-"}"#
                .to_owned(),
        ];
        let legs = legs.join(",");
        let mechanism = format!(r#"{{"planar":{{"legs":[{legs}],"characteristic_length":"1"}}}}"#);
        let workspace = r#"{"min":["2","2"],"max":["4","4"]}"#;
        let turned = r#""orientation":{"range":["80","100"]},"#;
        let shape = shape(&claim(&mechanism, workspace, turned)).unwrap();
        assert_eq!(shape.position, [3.0, 3.0, 0.0]);
        // Turned by a right angle, (-1, 0) of the platform is at (0, -1) from P.
        let platform = shape.pose(0, shape.position).unwrap().platform;
        assert!((platform[0] - 3.0).abs() < 1e-12 && (platform[1] - 2.0).abs() < 1e-12);
        assert!((length(&shape, 1) - 4.0).abs() < 1e-12);
        assert!((length(&shape, 2) - 5.0).abs() < 1e-12);
        let content = drawn(&shape);
        assert_eq!(content.matches("class=\"leg\"").count(), 3);
        assert_eq!(content.matches("class=\"arm\"").count(), 1);
        assert!(content.contains("class=\"platform\"") && !content.contains(">z<"));
        // The names of the two coordinates and of the angle.
        assert_eq!(names(&claim(&mechanism, workspace, turned)), ["x", "y", "t"]);
    }

    #[test]
    fn hexapods_have_six_legs_and_their_platform_turned() {
        let joint = |i: usize, r: f64, z: &str| {
            let (s, c) = (i as f64 * std::f64::consts::FRAC_PI_3).sin_cos();
            format!(r#""{}","{}","{z}""#, (100.0 * r * c).round(), (100.0 * r * s).round())
        };
        let legs: Vec<String> =
            (0..6).map(|i| strut(&joint(i, 2.0, "0"), &joint(i, 1.0, "0"))).collect();
        let mechanism = format!(
            r#"{{"spatial":{{"legs":[{}],"characteristic_length":"100"}}}}"#,
            legs.join(",")
        );
        let workspace = r#"{"min":["-10","-10","300"],"max":["10","10","300"]}"#;
        let level = claim(&mechanism, workspace, r#""orientation":{"angle":"15"},"#);
        let of_level = shape(&level).unwrap();
        assert!((length(&of_level, 0) - 300f64.hypot(100.0)).abs() < 1e-9);
        let content = drawn(&of_level);
        assert_eq!(content.matches("class=\"leg\"").count(), 6);
        assert!(content.contains("B\u{2086}") && content.contains(">z<"));
        let yaw = r#""orientation":{"roll_pitch_yaw":{"roll":["0","0"],"pitch":["-90","-90"],"yaw":["0","0"]}},"#;
        let turned = shape(&claim(&mechanism, workspace, yaw)).unwrap();
        // R_y(-90) carries x to z: R e_x = (cos p, 0, -sin p).
        let platform = turned.pose(0, turned.position).unwrap().platform;
        assert!((platform[2] - 400.0).abs() < 1e-9 && platform[0].abs() < 1e-9, "{platform:?}");
        // Nothing is sampled of what the kernel does not compile, and everything else is there.
        let scene =
            scene(&level, &kernel::Proof::Tree(kernel::Tree { precision: 52, nodes: Vec::new() }));
        assert_eq!(scene.trees[0].axes.len(), scene.trees[0].least.len());
    }

    #[test]
    fn a_platform_that_only_turns_has_no_workspace_of_positions() {
        let legs = [
            strut(r#""200","0","0""#, r#""100","0","50""#),
            strut(r#""-100","173","0""#, r#""-50","87","50""#),
            strut(r#""-100","-173","0""#, r#""-50","-87","50""#),
        ];
        let mechanism = format!(
            r#"{{"spherical":{{"legs":[{}],"characteristic_length":"100"}}}}"#,
            legs.join(",")
        );
        let orientation = r#""orientation":{"tilt":{"tilt":"20","torsion":"40"}},"#;
        let claim = claim(&mechanism, r#"{"min":[],"max":[]}"#, orientation);
        let shape = shape(&claim).unwrap();
        assert_eq!(shape.position, [0.0; 3]);
        let content = drawn(&shape);
        assert_eq!(content.matches("class=\"leg\"").count(), 3);
        assert!(!content.contains("class=\"solid\"") && content.contains("class=\"platform\""));
        assert!(mechanism::workspace(&claim).starts_with("tilted by at most 20\u{b0}"));
    }

    /// The paper's cube: `L = 310.58`, and the platform at the origin is where all legs are along the
    /// axes.
    #[test]
    fn the_legs_of_the_paper_follow_from_the_claim() {
        let text = r#"{"mechanism":{"orthoglide":{"offset":"0"}},"workspace":{"cube":{"side":"200"}},
            "require":[{"quantity":"transmission","end":"max","bound":"2"}]}"#;
        let claim: MachineClaim = serde_json::from_str(text).unwrap();
        let [q1, q2, l] = of_cube(&claim).unwrap();
        assert!((l - 310.582854123025).abs() < 1e-9 && (q1 + 73.2050807568877).abs() < 1e-9);
        assert!((q2 - q1 - 200.0).abs() < 1e-9);
        let shape = shape(&claim).unwrap();
        assert!((length(&shape, 2) - l).abs() < 1e-9);
    }
}
