//! What is told of each extreme, with its certificates.

use super::Arguments;
use crate::cli::certify::{self, Unwritten};
use crate::cli::Failure;
use crate::exact::decimal::{rounded, Toward};
use crate::exact::Exact;
use crate::report::CertificateFile;
use crate::search::solver::enclose::{Enclosed, NotEnclosed};
use crate::search::solver::extremes::{of_cube, Extreme};
use num_rational::BigRational;
use orthocert_checker::certificate::{Certificate, Proof};
use orthocert_kernel::certificate::Claim;
use orthocert_kernel::claim::{self as kernel, Bound, Requirement};
use orthocert_kernel::number::Expression;
use serde::Serialize;
use std::collections::BTreeMap;

/// A quantity's extreme for scripts.
#[derive(Serialize)]
pub(super) struct Row {
    pub(super) quantity: String,
    /// Its name in texts.
    #[serde(skip)]
    pub(super) name: String,
    /// Its unit, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) unit: Option<&'static str>,
    /// "least" or "greatest".
    pub(super) end: &'static str,
    /// What it is for.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) given: BTreeMap<String, Vec<String>>,
    /// Whether the design says so; a unit of each, if not.
    #[serde(skip)]
    pub(super) is_asked: bool,
    /// Whether it is for less of an accuracy's other part than the design says.
    #[serde(skip)]
    pub(super) is_nearer: bool,
    /// Whether it is the angle of an accuracy.
    #[serde(skip)]
    is_angle: bool,
    /// Below the extreme, or equal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) min: Option<Exact>,
    /// Above the extreme, or equal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) max: Option<Exact>,
    /// The point that reaches the inner end, in exact numbers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) point: Option<Vec<Exact>>,
    /// The relative width that was reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) relative: Option<String>,
    /// Whether it is wider than what was asked for.
    #[serde(skip)]
    pub(super) wide: bool,
    /// Why there is no enclosure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) not_enclosed: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) certificates: Vec<CertificateFile>,
    #[serde(skip)]
    pub(super) unwritten: Unwritten,
}

/// The rows that the paper's cube has by definition.
pub(super) fn exact_rows(claim: &kernel::MachineClaim) -> Vec<Row> {
    let row = |(greatest, value): (bool, Exact)| Row {
        min: Some(value.clone()),
        max: Some(value),
        relative: Some("0".into()),
        ..Row::new("psi", None, greatest)
    };
    of_cube(claim).into_iter().map(row).collect()
}

impl Row {
    pub(super) fn new(name: &str, unit: Option<&'static str>, greatest: bool) -> Self {
        Row {
            quantity: name.to_owned(),
            name: name.to_owned(),
            unit,
            end: if greatest { "greatest" } else { "least" },
            given: BTreeMap::new(),
            is_asked: true,
            is_nearer: false,
            is_angle: false,
            min: None,
            max: None,
            point: None,
            relative: None,
            wide: false,
            not_enclosed: None,
            certificates: Vec::new(),
            unwritten: Unwritten::default(),
        }
    }

    /// Of this extreme of a claim.
    pub(super) fn of(claim: &kernel::MachineClaim, extreme: &Extreme, angular: bool) -> Self {
        let own = &extreme.bounded().requirement;
        let is_angle = extreme.bounded().angle;
        let given = given(own, is_angle);
        let same = |one: &Requirement| own.quantity == one.quantity && own.given == one.given;
        let is_asked = own.given.is_empty() || claim.require.iter().any(same);
        let row = Row::new(&extreme.name(), extreme.unit(angular), extreme.is_greatest());
        Row { quantity: extreme.symbol(), given, is_asked, is_angle, ..row }
    }

    /// With what was found of it: of an accuracy, for the bound on its other part with which it is certified.
    pub(super) fn found(
        mut self,
        stem: &str,
        found: Result<Enclosed, NotEnclosed>,
        relative: &BigRational,
        arguments: &Arguments,
    ) -> Result<Self, Failure> {
        match found {
            Ok(Enclosed { width, inner, outer, refuted, certified, .. }) => {
                self.enclosed((width, inner, outer), relative);
                if let (true, Claim::Machine(claim)) = (self.is_asked, &certified.claim) {
                    let given = claim.require.first().map(|own| given(own, self.is_angle));
                    let given = given.unwrap_or_default();
                    self.is_nearer = given != self.given;
                    self.given = given;
                }
                self.store(arguments, stem, (refuted.as_deref(), &*certified))?;
                Ok(self)
            }
            Err(error) => self.fails(error),
        }
    }

    /// Between a refuted bound and a certified one.
    fn enclosed(
        &mut self,
        (width, inner, outer): (BigRational, BigRational, BigRational),
        asked: &BigRational,
    ) {
        let [inner, outer] = [inner, outer].map(Exact::Rational);
        self.wide = width > *asked;
        self.relative = Some(rounded(&width, 2, Toward::Above));
        let (min, max) = if self.end == "greatest" { (inner, outer) } else { (outer, inner) };
        (self.min, self.max) = (Some(min), Some(max));
    }

    /// Not enclosed. What was found before an interruption is told.
    fn fails(self, error: NotEnclosed) -> Result<Self, Failure> {
        match error {
            NotEnclosed::Claim(_) => Err(Failure::input(error)),
            error => Ok(Row { not_enclosed: Some(error.to_string()), ..self }),
        }
    }

    /// Writes the certificates, if they are asked for; the point is that of the refutation.
    fn store(
        &mut self,
        arguments: &Arguments,
        stem: &str,
        (refuted, certified): (Option<&Certificate>, &Certificate),
    ) -> Result<(), Failure> {
        self.point = refuted.and_then(witness_point);
        let Some(folder) = &arguments.output else { return Ok(()) };
        let inner = refuted.into_iter().map(|certificate| (certificate, "inner"));
        for (certificate, side) in inner.chain([(certified, "outer")]) {
            let path = folder.join(format!("{stem}-{side}.cert.json"));
            let written = certify::write(Some(folder), &path, certificate);
            self.certificates.extend(self.unwritten.unless(written));
        }
        Ok(())
    }
}

/// What a requirement is for; the angle of an accuracy, with which distance.
fn given(own: &Requirement, is_angle: bool) -> BTreeMap<String, Vec<String>> {
    let mut given = own.given.clone();
    if let (true, Bound::Max(distance)) = (is_angle, &own.bound) {
        given.remove("max_angle");
        given.insert("max".to_owned(), vec![distance.clone()]);
    }
    let texts = |all: Vec<Expression>| all.iter().map(Expression::to_string).collect();
    given.into_iter().map(|(name, all)| (name, texts(all))).collect()
}

fn witness_point(certificate: &Certificate) -> Option<Vec<Exact>> {
    match &certificate.proof {
        Proof::Witness(witness) => witness.point.iter().map(Exact::of).collect(),
        _ => None,
    }
}
