//! What the figures show of a kernel claim: a machine with any number of legs, over any coordinates.

use super::contour::Field;
use super::evidence::{share, Row};
use super::isomap::{map, Map, Mark, Plane, Scale, NODES};
use super::legend::Legend;
use super::mechanism;
use super::sampled::{double, positions, Sampled, Sampler, Worst};
use super::scene::{Scene, Slice};
use super::shape::{all, shape};
use super::subdivision::{pairs, Root, Subdivision};
use crate::decimal::significant;
use orthocert_kernel::certificate as kernel;
use orthocert_kernel::claim::{Bound, MachineClaim, Mechanism, Requirement, Workspace};
use orthocert_kernel::no_cube::NoCubeClaim;
use orthocert_kernel::number::Expression;
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
        kernel::Proof::Tree(_) | kernel::Proof::Atlas(_) => None,
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

/// What they show of a claim that no cube fits: the machine, and the boxes of the centres.
pub fn of_centres(claim: &NoCubeClaim, proof: &kernel::Proof) -> Scene {
    let mut scene = scene(&claim.machine, proof);
    scene.rows.clear();
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
    let point = |x: &[Expression]| x.iter().map(double).collect::<Option<Vec<f64>>>();
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
        let Some(witness) = self.witness else {
            let found = self.critical(worst, None);
            let mark = |(_, worst): (usize, &Worst)| mark("least margin", worst.at.clone());
            return found.map(mark).into_iter().collect();
        };
        witnessed(witness)
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
        kernel::Failure::Same { .. } => {
            rows.push(("violated".to_owned(), "one point for all joint coordinates".to_owned()));
        }
        kernel::Failure::Obligation(number, _) | kernel::Failure::Row(number, _) => {
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
    if let kernel::Failure::Same { least, greatest, .. } = &witness.fails {
        let between = format!("{} to {}", list(least), list(greatest));
        rows.push(("and, with the same joint coordinates, from".to_owned(), between));
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
