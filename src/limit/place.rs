//! The requirement that a refuted claim violates, and where, for every kind of claim.

use crate::decimal::exact;
use crate::report::Counterexample;
use orthocert_checker::certificate::{Certificate, Proof};
use orthocert_checker::claim::Claim;
use orthocert_kernel::certificate as kernel;
use orthocert_kernel::claim::{Bound, MachineClaim, Requirement};
use orthocert_kernel::problem::Problem;
use orthocert_kernel::quantity::TABLE;
use serde::Serialize;
use std::collections::BTreeMap;

/// What a refutation's witness says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Place {
    /// The requirement: `greatest psi <= 2`.
    pub violated: String,
    /// The value there, with certified digits, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<String>,
    /// The point, in exact numbers.
    pub point: Vec<String>,
    /// A second point, where the determinant of `M` has the opposite sign.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub other_point: Vec<String>,
    /// The parameters with a tolerance, in exact numbers.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub machine: BTreeMap<String, String>,
}

impl Place {
    /// Where a certificate refutes its claim; `None` of another certificate.
    pub fn of(certificate: &Certificate) -> Option<Self> {
        match (&certificate.claim, &certificate.proof) {
            (Claim::Machine(claim), Proof::Witness(witness)) => {
                let found = Counterexample::new(claim, witness);
                let texts =
                    |point: &[orthocert_checker::number::Exact]| point.iter().map(exact).collect();
                let setting = |s: &crate::report::Setting| {
                    let leg = s.leg.map_or(String::new(), |leg| format!("leg {leg} "));
                    (leg + &s.parameter, exact(&s.value))
                };
                Some(Place {
                    violated: found.violated,
                    value: Some(found.value),
                    point: texts(&found.point),
                    other_point: found.other_point.as_deref().map(texts).unwrap_or_default(),
                    machine: found.machine.iter().map(setting).collect(),
                })
            }
            (Claim::Kernel(claim), Proof::Kernel(kernel::Proof::Witness(witness))) => {
                Some(Place::in_kernel(claim, witness))
            }
            _ => None,
        }
    }

    fn in_kernel(claim: &MachineClaim, witness: &kernel::Witness) -> Self {
        let problem = Problem::new(claim).ok();
        let violated = match &witness.fails {
            kernel::Failure::Reach => "every leg reaches, without a serial singularity".to_owned(),
            kernel::Failure::Singular(_) => "no parallel singularity".to_owned(),
            kernel::Failure::Obligation(number, _)
            | kernel::Failure::Row(number, _)
            | kernel::Failure::Same { obligation: number, .. } => {
                let obligation = problem.as_ref().and_then(|p| p.obligations.get(*number));
                let requirement = obligation.and_then(|o| claim.require.get(o.requirement?));
                requirement.map_or("no parallel singularity".to_owned(), words)
            }
        };
        let texts = |point: &[_]| point.iter().map(ToString::to_string).collect();
        let places = problem.iter().flat_map(Problem::tolerances);
        let places = places.map(|(place, _, _)| place.to_owned());
        Place {
            violated,
            value: None,
            point: texts(&witness.point),
            other_point: match &witness.fails {
                kernel::Failure::Singular(other) => texts(other),
                _ => Vec::new(),
            },
            machine: places.zip(witness.machine.iter().map(ToString::to_string)).collect(),
        }
    }
}

/// A requirement in words and numbers.
fn words(requirement: &Requirement) -> String {
    let Requirement { quantity, leg, bound, .. } = requirement;
    let symbol = TABLE.iter().find(|known| known.key == quantity).map(|known| known.symbol);
    let of = leg.map_or(String::new(), |leg| format!(" of leg {leg}"));
    let bound = match bound {
        Bound::Min(min) => format!(" >= {min}"),
        Bound::Max(max) => format!(" <= {max}"),
        Bound::Holds => String::new(),
        Bound::Within([min, max]) => format!(" from {min} to {max}, up to whole turns"),
    };
    match symbol {
        Some(symbol) if *symbol != **quantity => format!("{quantity}: {symbol}{of}{bound}"),
        _ => format!("{quantity}{of}{bound}"),
    }
}
