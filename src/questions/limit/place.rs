//! The requirement that a refuted claim violates, and where, for every kind of claim.

use crate::exact::decimal::exact;
use crate::exact::Exact;
use crate::report::{counterexample, Setting};
use orthocert_checker::certificate::Certificate;
use serde::Serialize;
use std::collections::BTreeMap;

/// What a refutation's witness says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Place {
    /// The requirement: `greatest psi <= 2`.
    pub violated: String,
    /// The value there, with certified digits.
    pub value: String,
    /// The point, in exact numbers.
    pub point: Vec<String>,
    /// A second point, where the determinant of `M` has the opposite sign.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub other_point: Vec<String>,
    /// The parameters with a tolerance, in exact numbers.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub machine: BTreeMap<String, String>,
    /// What ends there, in a few words.
    #[serde(skip)]
    pub limit: String,
    /// The point of a platform that turns, its angles in degrees, rounded.
    #[serde(skip)]
    pub pose: Option<String>,
    /// The machine again, leg by leg.
    #[serde(skip)]
    pub settings: Vec<Setting>,
}

impl Place {
    /// Where a certificate refutes its claim; `None` of another certificate.
    pub fn of(certificate: &Certificate) -> Option<Self> {
        let found = counterexample(certificate)?;
        let texts = |point: &[Exact]| point.iter().map(exact).collect();
        let setting = |s: &Setting| {
            let leg = s.leg.map_or(String::new(), |leg| format!("leg {leg} "));
            (leg + &s.parameter, exact(&s.value))
        };
        Some(Place {
            limit: found.limit,
            pose: found.pose,
            violated: found.violated,
            value: found.value,
            point: texts(&found.point),
            other_point: found.other_point.as_deref().map(texts).unwrap_or_default(),
            machine: found.machine.iter().map(setting).collect(),
            settings: found.machine,
        })
    }
}
