//! What the figures show of a kernel claim: a machine with any number of legs, over any coordinates.

use super::contour::Field;
use super::evidence::{share, Row};
use super::isomap::{map, Map, Mark, Plane, Scale, NODES};
use super::legend::Legend;
use super::mechanism;
use super::sampled::{positions, Sampled, Worst};
use super::scene::{Scene, Slice};
use super::shape::shape;
use super::subdivision::{pairs, Root, Subdivision};
use crate::exact::decimal::{exact, significant};
use crate::exact::Exact;
use crate::report::place::angle_of;
use crate::report::text::machine;
use crate::report::{placed, pose_text};
use crate::search::solver::approximate;
use crate::search::solver::sample::At;
use crate::search::solver::value::{coordinates, in_length, OF_ANGLE};
use orthocert_kernel::certificate as kernel;
use orthocert_kernel::claim::{
    Bound, MachineClaim, Mechanism, NoCubeClaim, Requirement, Workspace,
};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use std::rc::Rc;

/// Operations of a tape beyond which maps have coarser grids.
const LONG: usize = 20_000;
/// Nodes of those on either side.
const FEW_NODES: usize = 25;
/// Margins below this may be rounding.
const NOISE: f64 = 1e-9;

/// A kernel claim in doubles.
struct General<'a> {
    claim: &'a MachineClaim,
    sampled: Option<Sampled<'a>>,
    /// Names of coordinates, of orientations those of the chart.
    names: Vec<String>,
    witness: Option<&'a kernel::Witness>,
    /// The unit of lengths.
    length: Option<&'static str>,
}

/// What the figures and tables show.
pub fn scene(claim: &MachineClaim, proof: &kernel::Proof, length: Option<&'static str>) -> Scene {
    let witness = match proof {
        kernel::Proof::Witness(witness) => Some(witness),
        kernel::Proof::Tree(_) | kernel::Proof::Atlas(_) => None,
    };
    let problem = Problem::new(claim).ok();
    let sampled = problem.as_ref().and_then(|problem| Sampled::new(claim, problem));
    let of = General { claim, sampled, names: names(claim), witness, length };
    let worst = of.sampled.as_ref().map(Sampled::worst).unwrap_or_default();
    let marks = of.marks(&worst);
    Scene {
        shape: shape(claim),
        slices: of.slices(&worst),
        nearest: of.nearest(&worst),
        rows: of.rows(&worst),
        trees: vec![of.tree(proof)],
        marks,
    }
}

/// What they show of a claim that no cube fits: the machine, and the boxes of the centres.
pub fn of_centres(claim: &NoCubeClaim, proof: &kernel::Proof) -> Scene {
    let mut scene = scene(&claim.machine, proof, None);
    scene.rows.clear();
    scene.nearest = None;
    scene.marks.clear();
    for tree in &mut scene.trees {
        "the box of the centres".clone_into(&mut tree.name);
    }
    scene
}

/// Names of the coordinates: of the position, then of the chart of the orientations.
pub fn names(claim: &MachineClaim) -> Vec<String> {
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

fn mark(name: &str, at: Vec<f64>) -> Mark {
    Mark { name: name.to_owned(), at }
}

/// The points of a counterexample.
pub fn witnessed(witness: &kernel::Witness) -> Vec<Mark> {
    let point = |x: &[Expression]| x.iter().map(approximate).collect::<Option<Vec<f64>>>();
    let mut all: Vec<Mark> =
        point(&witness.point).map(|at| mark("counterexample", at)).into_iter().collect();
    if let kernel::Failure::Singular(other) = &witness.fails {
        all.extend(point(other).map(|at| mark("P'", at)));
    }
    all
}

impl General<'_> {
    fn positions(&self) -> usize {
        positions(self.claim).unwrap_or(self.names.len())
    }

    /// The requirement of which the least is left.
    fn critical<'w>(&self, worst: &'w [Worst], but: Option<usize>) -> Option<&'w Worst> {
        let others = worst.iter().filter(|worst| Some(worst.number) != but);
        let left = |worst: &Worst| worst.left.unwrap_or(f64::INFINITY);
        others.min_by(|a, b| left(a).total_cmp(&left(b)))
    }

    /// The points of a counterexample, or the one where least is left to a bound.
    fn marks(&self, worst: &[Worst]) -> Vec<Mark> {
        let Some(witness) = self.witness else {
            let found = self.critical(worst, None);
            let mark = |worst: &Worst| mark("nearest limit", worst.row.at.clone());
            return found.map(mark).into_iter().collect();
        };
        witnessed(witness)
    }

    /// The requirement of which the least is left, in a sentence.
    fn nearest(&self, worst: &[Worst]) -> Option<(&'static str, String)> {
        let found = self.critical(worst, None)?;
        let left = found.left?;
        let label = if left < -NOISE { "violated" } else { "nearest limit" };
        let left = match left {
            left if left == f64::NEG_INFINITY => "exceeded without bound".to_owned(),
            left if left < -NOISE => format!("exceeded by {}", share(-left)),
            left if left < NOISE => "met with equality".to_owned(),
            left => format!("{} left", share(left)),
        };
        let row = &found.row;
        let name = in_length(&row.requirement, row.unit, self.length);
        let bound = match &found.bound {
            Bound::Min(bound) => format!(">= {}", mechanism::number(bound)),
            Bound::Max(bound) => format!("<= {}", mechanism::number(bound)),
            Bound::Within(_) | Bound::Holds => row.bound_text.clone(),
        };
        let what = mechanism::typeset(&format!("{name} {bound}"));
        Some((label, format!("{what}: {left}, {}", placed(&self.place(&row.at)))))
    }

    fn rows(&self, worst: &[Worst]) -> Vec<Row> {
        let row = |(number, requirement): (usize, &Requirement)| {
            let mut row = Row {
                requirement: mechanism::typeset(&mechanism::short(requirement)),
                bound: mechanism::bound(&requirement.bound),
                found: "\u{2013}".to_owned(),
                is_violated: false,
                margin: "\u{2013}".to_owned(),
                at: String::new(),
                machine: String::new(),
            };
            if let Some(Worst { row: own, leg, left, bound, .. }) =
                worst.iter().find(|worst| worst.number == number)
            {
                let leg = leg.map_or(String::new(), |leg| format!(", leg {leg}"));
                let of = if requirement.leg.is_none() { leg } else { String::new() };
                row.found = match own.worst_found {
                    Some(value) if !value.is_finite() => "singular".to_owned(),
                    Some(value) => significant(value, 9) + &of,
                    None if own.seems_violated => "out of reach".to_owned(),
                    None => "\u{2013}".to_owned(),
                };
                let unit = match (own.unit, self.length) {
                    (Some(unit), Some(length)) => Some(unit.replace("length", length)),
                    // Of a length alone, nothing is told.
                    (unit, None) => unit
                        .filter(|unit| unit.starts_with("deg") || unit.ends_with("rad"))
                        .map(str::to_owned),
                    (None, _) => None,
                };
                row.bound = mechanism::bound(bound);
                if let Some(unit) = unit {
                    row.bound = format!("{} {unit}", row.bound);
                }
                if own.requirement.contains(OF_ANGLE) {
                    row.requirement = row.requirement.replacen("accuracy", OF_ANGLE, 1);
                }
                row.is_violated = own.seems_violated;
                let left = left.filter(|left| left.is_finite());
                row.margin = left.map_or_else(|| "\u{2013}".to_owned(), share);
                row.at = self.place(&own.at);
                row.machine = machine(&own.machine);
            }
            row
        };
        self.claim.require.iter().enumerate().map(row).collect()
    }

    /// A point in words, angles in degrees.
    fn place(&self, at: &[f64]) -> String {
        pose_text(at, &coordinates(self.claim), 6)
    }

    fn tree(&self, proof: &kernel::Proof) -> Subdivision {
        let m = self.names.len();
        let root = match &self.sampled {
            Some(sampled) => sampled.root(),
            None => vec![[0.0, 1.0]; m],
        };
        // Without numbers in doubles, coordinates are told as parts of the workspace.
        let turns = self.claim.orientation.is_some() && self.sampled.is_some();
        let mut axes = if turns { axes(self.claim) } else { self.names.clone() };
        axes.extend((axes.len()..root.len()).map(|k| format!("x{}", k + 1)));
        axes.truncate(root.len());
        let root = Root {
            positions: self.positions().min(axes.len()),
            turns,
            least: root.iter().map(|[lo, _]| *lo).collect(),
            width: root.iter().map(|[lo, hi]| hi - lo).collect(),
            axes,
        };
        let kernel::Proof::Tree(tree) = proof else {
            return Subdivision::new("the workspace", root, &Rc::new(Legend::default()), &[]);
        };
        let mut requirements = vec!["freedom from singularities".to_owned()];
        requirements.extend(self.claim.require.iter().map(mechanism::heading));
        let of = |obligation: usize| {
            let requirement = self.sampled.as_ref().and_then(|s| s.requirement(obligation));
            requirement.map_or(0, |number| number + 1)
        };
        let (legend, nodes) = Legend::of_kernel(tree, requirements, &of);
        let name = match self.sampled {
            Some(_) => "the workspace",
            None => "the workspace, coordinates as parts of it",
        };
        Subdivision::new(name, root, &Rc::new(legend), &nodes)
    }

    /// Maps over pairs of coordinates, the others where the counterexample is, or where least is left to
    /// a bound: of the greatest psi, and of the requirement, other than that on it, of which least is
    /// left.
    fn slices(&self, worst: &[Worst]) -> Vec<Slice> {
        let Some(sampled) = &self.sampled else { return Vec::new() };
        let m = self.names.len();
        let is_psi =
            |r: &Requirement| r.quantity == "transmission" && matches!(r.bound, Bound::Max(_));
        let of_psi = self.claim.require.iter().position(is_psi);
        let mut functions: Vec<Function<'_>> = vec![Function {
            file: "psi",
            heading: "greatest \u{3c8}".to_owned(),
            of: Box::new(|at| sampled.psi(at).map(|psi| (psi, -psi))),
        }];
        let critical = self.critical(worst, of_psi).map(|worst| worst.number);
        if let Some((number, requirement)) =
            critical.and_then(|n| Some((n, self.claim.require.get(n)?)))
        {
            functions.push(Function {
                file: "critical",
                heading: mechanism::heading(requirement),
                of: Box::new(move |at| sampled.value(number, at)),
            });
        }
        let middle = || sampled.root().iter().map(|[lo, hi]| lo + (hi - lo) / 2.0).collect();
        let point = match self.witness {
            Some(witness) => witness.point.iter().map(approximate).collect(),
            None => self.critical(worst, None).map(|worst| worst.row.at.clone()),
        };
        let base = point.filter(|p: &Vec<f64>| p.len() == m).unwrap_or_else(middle);
        let marks = self.marks(worst);
        let mut all = pairs(m, self.positions().min(m));
        // Of a cylinder, the plane along its axis in which there is more of it.
        if let Workspace::Cylinder { center, .. } = &self.claim.workspace {
            let off =
                |k: usize| center.get(k).and_then(approximate).map_or(0.0, |c| (base[k] - c).abs());
            if off(1) > off(0) {
                all.iter_mut().filter(|pair| **pair == [0, 2]).for_each(|pair| *pair = [1, 2]);
            }
        }
        let all = all.into_iter().enumerate();
        let slices = all.map(|(i, pair)| self.slice(sampled, i, pair, (&base, &marks), &functions));
        slices.filter(|slice| !slice.maps.is_empty()).collect()
    }

    /// A coordinate as it is shown: of orientations, from the chart's tangent, in degrees.
    fn shown(&self, k: usize, x: f64) -> f64 {
        if self.is_turn(k) {
            2.0 * x.atan().to_degrees()
        } else {
            x
        }
    }

    /// The same back.
    fn meant(&self, k: usize, x: f64) -> f64 {
        if self.is_turn(k) {
            (x / 2.0).to_radians().tan()
        } else {
            x
        }
    }

    fn is_turn(&self, k: usize) -> bool {
        self.claim.orientation.is_some() && k >= self.positions()
    }

    fn slice(
        &self,
        sampled: &Sampled<'_>,
        number: usize,
        [a, b]: [usize; 2],
        (base, marks): (&[f64], &[Mark]),
        functions: &[Function<'_>],
    ) -> Slice {
        let all = axes(self.claim);
        let name = |k: usize| all.get(k).map_or("?", String::as_str);
        let root = sampled.root();
        let root = [a, b].map(|k| root[k].map(|x| self.shown(k, x)));
        let is_round =
            matches!(self.claim.workspace, Workspace::Cylinder { .. }) && [a, b] == [0, 1];
        let of_kind = |k: usize| k < self.positions();
        let is_of_users = matches!(self.claim.mechanism, Mechanism::Formulas(_));
        let same_kind = !is_of_users && of_kind(a) == of_kind(b);
        let width = root.map(|[lo, hi]| hi - lo);
        let plane =
            Plane::new(root.map(|[lo, _]| lo), width, [name(a), name(b)], is_round, same_kind);
        let nodes = if sampled.operations() > LONG { FEW_NODES } else { NODES };
        let mut found: Vec<([f64; 2], Option<At>)> = Vec::new();
        let out_of_reach = plane.field(nodes, |x, y| {
            let mut point = base.to_vec();
            (point[a], point[b]) = (self.meant(a, x), self.meant(b, y));
            found.push(([x, y], sampled.at(&point)));
            if found.last().is_some_and(|(_, at)| at.is_some()) {
                -1.0
            } else {
                1.0
            }
        });
        let fixed = all.iter().zip(base).enumerate().filter(|(k, _)| *k != a && *k != b);
        let fixed: Vec<String> = fixed
            .map(|(k, (name, x))| {
                let value = significant(self.shown(k, *x), 6);
                match name.strip_suffix(", deg") {
                    Some(name) if name.starts_with("about") => format!("{name}: {value} deg"),
                    Some(name) => format!("{name} = {value} deg"),
                    None => format!("{name} = {value}"),
                }
            })
            .collect();
        let fixed = fixed.join("; ");
        let at = if fixed.is_empty() { String::new() } else { format!(" at {fixed}") };
        let marks: Vec<(&str, [f64; 2])> = marks
            .iter()
            .take(1)
            .filter_map(|mark| {
                let [x, y] = [mark.at.get(a)?, mark.at.get(b)?];
                Some((mark.name.as_str(), [self.shown(a, *x), self.shown(b, *y)]))
            })
            .collect();
        let mut maps = Vec::new();
        let mut legends = Vec::new();
        for function in functions {
            let of = |at: &Option<At>| at.as_ref().and_then(|at| (function.of)(at));
            let values: Vec<Option<(f64, f64)>> = found.iter().map(|(_, at)| of(at)).collect();
            let known = values.iter().flatten().map(|(value, _)| *value).collect();
            let Some(scale) = Scale::over(vec![known]) else { continue };
            let field = Field {
                values: values.iter().map(|v| v.map_or(f64::NAN, |(value, _)| value)).collect(),
                ..out_of_reach.clone()
            };
            let ranked =
                found.iter().zip(&values).filter_map(|((at, _), v)| Some((v.as_ref()?.1, *at)));
            let worst = ranked.min_by(|a, b| a.0.total_cmp(&b.0));
            let mut shown = marks.clone();
            let is_there = |at: &[f64; 2]| {
                let off = marks.iter().flat_map(|(_, mark)| [mark[0] - at[0], mark[1] - at[1]]);
                marks.iter().len() > 0
                    && off.zip(width).all(|(off, width)| off.abs() <= 0.05 * width.abs())
            };
            shown.extend(
                worst
                    .filter(|(_, at)| self.witness.is_none() && !is_there(at))
                    .map(|(_, at)| ("worst here", at)),
            );
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
            legends.extend(scale.legends());
        }
        Slice { maps, legends, fixed }
    }
}

/// A number at a point, and how good it is: less is worse.
type Of<'a> = Box<dyn Fn(&At) -> Option<(f64, f64)> + 'a>;

/// What a map is of.
struct Function<'a> {
    file: &'static str,
    heading: String,
    of: Of<'a>,
}

/// Names of the coordinates for people: of orientations angles in degrees, about an axis each twice the
/// arc tangent of the chart's coordinate.
fn axes(claim: &MachineClaim) -> Vec<String> {
    let one = |name: &String| match (name.as_str(), angle_of(name)) {
        ("c_x", _) => "about x, deg".to_owned(),
        ("c_y", _) => "about y, deg".to_owned(),
        ("c_z", _) => "about z, deg".to_owned(),
        (_, Some(angle)) => format!("{angle}, deg"),
        (other, None) => other.to_owned(),
    };
    let all = coordinates(claim);
    all.positions().iter().cloned().chain(all.turns().iter().map(one)).collect()
}

/// The counterexample in a table: names and values.
pub fn counterexample(
    claim: &MachineClaim,
    witness: &kernel::Witness,
) -> (Vec<(String, String)>, String) {
    let number = |x: &Expression| Exact::of(x).map_or_else(|| x.to_string(), |x| exact(&x));
    let list = |x: &[Expression]| {
        let all: Vec<String> = x.iter().map(number).collect();
        format!("({})", all.join(", "))
    };
    let problem = Problem::new(claim).ok();
    let sampled = problem.as_ref().and_then(|problem| Sampled::new(claim, problem));
    let found = sampled.as_ref().and_then(|sampled| sampled.counterexample(witness));
    let mut rows = Vec::new();
    if let Some(found) = &found {
        rows.push(("violated".to_owned(), found.violated.clone()));
        rows.push(("value there".to_owned(), found.value.clone()));
        let of = ["of", "and"].into_iter().zip(&found.bodies);
        rows.extend(of.map(|(label, near)| (label.to_owned(), near.to_string())));
    }
    rows.push((format!("at ({})", coordinates(claim).join(", ")), list(&witness.point)));
    if claim.orientation.is_some() {
        let at: Option<Vec<f64>> = witness.point.iter().map(approximate).collect();
        rows.extend(at.map(|at| ("which is".to_owned(), pose_text(&at, &coordinates(claim), 6))));
    }
    if let kernel::Failure::Singular(other) = &witness.fails {
        rows.push(("and, with the other sign of det M, at".to_owned(), list(other)));
    }
    if let kernel::Failure::Same { least, greatest, .. } = &witness.fails {
        let between = format!("{} to {}", list(least), list(greatest));
        rows.push(("and, with the same joint coordinates, from".to_owned(), between));
    }
    for direction in found.iter().flat_map(|found| &found.directions) {
        let all: Vec<String> = direction.iter().map(ToString::to_string).collect();
        rows.push(("moving along".to_owned(), format!("({})", all.join(", "))));
    }
    let machine = problem.iter().flat_map(|problem| {
        problem.tolerances().zip(&witness.machine).map(|((place, ..), x)| (place, number(x)))
    });
    (rows, mechanism::of_witness(claim.mechanism.legs().len(), machine))
}
