//! A violation that holds on all of a cell: proposed in doubles, confirmed in machine words.

use crate::paving::Spectrum;
use crate::rough::Rough;
use nalgebra::Matrix3;
use orthocert_checker::cell::Cell;
use orthocert_checker::certificate::{Direction, LegNumber, TwoDirections, Violation};
use orthocert_checker::claim::{ClaimError, MachineClaim};
use orthocert_checker::enclosure::Enclosure;
use orthocert_checker::expansion::{Expansion, ExpansionPoint, Region};
use orthocert_checker::kinematics::JointCoordinate;
use orthocert_checker::model::{JointRange, Model};
use orthocert_checker::rule;
use orthocert_checker::word::Word;

/// Fractional bits of the confirmation: the most for which it can be done in machine words.
const PRECISION: u32 = 36;
/// Half the bits of a direction's components: eight bits with a sign, or more where cells are small.
const DIRECTION: [f64; 2] = [127.0, 1_048_576.0];

/// Finds violations of one claim.
pub struct Violations {
    rough: Model<Rough>,
    words: Model<Word>,
}

impl Violations {
    /// Of a claim.
    ///
    /// # Errors
    /// If it has no model.
    pub fn new(claim: &MachineClaim) -> Result<Self, ClaimError> {
        let rough = Model::new(claim, crate::verify::MODEL_PRECISION)?.map(&Rough::from_fixed);
        let words = Model::new(claim, PRECISION)?.map(&Word::from_fixed);
        Ok(Violations { rough, words })
    }

    fn confirms(&self, cell: &Cell, violation: &Violation) -> bool {
        rule::violated(&self.words, cell, violation).is_ok()
    }

    /// A violation that holds on all of the cell.
    pub fn violated(&self, cell: &Cell) -> Option<Violation> {
        let Ok(expansion) = Expansion::new(&self.rough, cell, ExpansionPoint::Centre) else {
            return self.beyond_reach(cell);
        };
        let spectrum = spectrum(&expansion);
        let failing = self.failing_at_centre(cell, &expansion, &spectrum);
        failing.into_iter().find(|violation| {
            self.violated_roughly(cell, &expansion, violation) && self.confirms(cell, violation)
        })
    }

    /// A violation by a leg that does not reach, or hardly reaches, any of the cell.
    fn beyond_reach(&self, cell: &Cell) -> Option<Violation> {
        let numbered = [1, 2, 3].map(|leg| LegNumber { leg });
        let rows = numbered.iter().cloned().map(Violation::Row);
        let reach = numbered.iter().cloned().map(Violation::Reach);
        let holds = |violation: &Violation| {
            rule::violated(&self.rough, cell, violation).is_ok() && self.confirms(cell, violation)
        };
        rows.chain(reach).find(holds)
    }

    /// The violations, with evidence, that the centre suggests.
    fn failing_at_centre(
        &self,
        cell: &Cell,
        expansion: &Expansion<Rough>,
        spectrum: &Spectrum,
    ) -> Vec<Violation> {
        let bounds = &self.rough.bounds;
        let mut found = Vec::new();
        let scales = if depth(cell) < 27 { &DIRECTION[..1] } else { &DIRECTION[..] };
        let kappa = bounds.kappa.mid();
        if spectrum.least < kappa * kappa {
            found.extend(scales.iter().map(|&s| {
                Violation::SigmaMin(Direction { vector: integers(spectrum.least_direction(), s) })
            }));
        }
        if bounds.k.is_some_and(|k| spectrum.greatest > k.mid() * k.mid()) {
            found.extend(scales.iter().map(|&s| {
                Violation::SigmaMax(Direction {
                    vector: integers(spectrum.greatest_direction(), s),
                })
            }));
        }
        self.others_at_centre(cell, expansion, spectrum, &mut found);
        found
    }

    fn others_at_centre(
        &self,
        cell: &Cell,
        expansion: &Expansion<Rough>,
        spectrum: &Spectrum,
        found: &mut Vec<Violation>,
    ) {
        let model = &self.rough;
        let bounds = &model.bounds;
        let at = Region::new(model, cell, ExpansionPoint::Centre).at;
        for leg in 0..3 {
            let number = || LegNumber { leg: leg + 1 };
            let cosine = model.legs[leg].cosine_squared(&at[leg]).map(|c| c.mid());
            let oblique = |bound: Option<Rough>| {
                bound.zip(cosine).is_some_and(|(bound, cosine)| cosine < bound.mid())
            };
            if oblique(bounds.serial_margin) {
                found.push(Violation::SerialMargin(number()));
            }
            if oblique(bounds.leg_angle) {
                found.push(Violation::LegAngle(number()));
            }
            let row: f64 = expansion.matrix[leg].iter().map(|x| x.mid() * x.mid()).sum();
            if bounds.joint_speed.is_some_and(|v| row > v.mid() * v.mid()) {
                found.push(Violation::JointSpeed(number()));
            }
            let rho = model.legs[leg].at(&at[leg]).map(|state| state.rho);
            if let (Some(rho), Some(ranges)) = (rho, &bounds.joint_range) {
                if outside(&rho, &ranges[leg]) {
                    found.push(Violation::JointRange(number()));
                }
            }
        }
        let ratio = bounds.conditioning.map(|c| c.mid() * c.mid());
        if ratio.is_some_and(|c| spectrum.greatest > c * spectrum.least) {
            found.push(Violation::Conditioning(TwoDirections {
                u: integers(spectrum.greatest_direction(), DIRECTION[1]),
                v: integers(spectrum.least_direction(), DIRECTION[1]),
            }));
        }
        let small = |min: Rough| unit_determinant(model, &at).is_some_and(|det| det < min.mid());
        if bounds.parallel_margin.is_some_and(small) {
            found.push(Violation::ParallelMargin);
        }
    }

    fn violated_roughly(
        &self,
        cell: &Cell,
        expansion: &Expansion<Rough>,
        violation: &Violation,
    ) -> bool {
        match violation {
            Violation::SigmaMin(v) => rule::shrunk(&self.rough, expansion, &v.vector),
            Violation::SigmaMax(v) => rule::stretched(&self.rough, expansion, &v.vector),
            other => rule::violated(&self.rough, cell, other),
        }
        .is_ok()
    }
}

fn spectrum(expansion: &Expansion<Rough>) -> Spectrum {
    let m = expansion.matrix.map(|row| row.map(|x| x.mid()));
    let entry = |i: usize, j: usize| (0..3).map(|k| m[k][i] * m[k][j]).sum();
    Spectrum::of([(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(i, j)| entry(i, j)))
}

/// The number of splits above a cell.
fn depth(cell: &Cell) -> u32 {
    cell.edges.iter().map(|e| e.level).sum()
}

/// A unit vector as integers of this size.
fn integers(v: [f64; 3], scale: f64) -> [i64; 3] {
    let most = v.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let rounded = v.map(|x| (x / most * scale).round() as i64);
    if rounded == [0; 3] {
        [1, 0, 0]
    } else {
        rounded
    }
}

fn outside(rho: &JointCoordinate<Rough>, range: &JointRange<Rough>) -> bool {
    match (rho, range) {
        (JointCoordinate::Length(rho), JointRange::Length { min, max }) => {
            min.is_some_and(|min| rho.mid() < min.mid())
                || max.is_some_and(|max| rho.mid() > max.mid())
        }
        (JointCoordinate::Angle { cos, sin }, JointRange::Angle { min, max }) => {
            let sine = |a: (f64, f64), b: (f64, f64)| a.1 * b.0 - a.0 * b.1;
            let pair = |p: &(Rough, Rough)| (p.0.mid(), p.1.mid());
            let theta = (cos.mid(), sin.mid());
            sine(theta, pair(min)) < 0.0 || sine(pair(max), theta) < 0.0
        }
        _ => false,
    }
}

fn unit_determinant(model: &Model<Rough>, at: &[[Rough; 3]; 3]) -> Option<f64> {
    let unit = |i: usize| model.legs[i].expand_unit(&at[i], &at[i]).map(|(unit, _)| unit);
    let units = [unit(0)?, unit(1)?, unit(2)?];
    Some(Matrix3::from_fn(|i, j| units[i][j].mid()).determinant().abs())
}
