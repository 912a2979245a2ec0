//! What a paving holds, for people and for scripts.

use crate::exact::decimal::{boxes, briefly, grouped, percent, significant, Toward};
use crate::exact::Exact;
use crate::files::shown::Shown;
use crate::search::paving::{box_ends, box_volume, Component, Components, Paved};
use crate::search::solver::doubles::Pair;
use num_rational::BigRational;
use num_traits::Zero;
use orthocert_kernel::claim::{MachineClaim, Mechanism};
use orthocert_kernel::paving::{Share, Summary, SHARE_BITS};
use serde::Serialize;
use std::path::Path;

/// Components that are told apart.
const SHOWN: usize = 5;
/// Digits of volumes.
const DIGITS: u32 = 9;

/// The report of a paving.
#[derive(Clone, Debug, Serialize)]
pub struct PavingReport {
    /// The design's title.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// The design's file, or what it was merged from.
    pub design: String,
    /// The coordinates that are paved, for all values of the others, where there are such.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coordinates: Option<Vec<String>>,
    /// Where the paving is.
    pub paving: String,
    /// Its length.
    pub bytes: u64,
    /// Its SHA-256, of the bytes that were confirmed.
    pub sha256: String,
    /// The volume of the undecided boxes over that of the inner ones; none without inner boxes.
    pub gap: Option<f64>,
    /// Whether the precision or gap that was asked for is reached.
    pub reached: bool,
    /// Boxes at every point of which all requirements hold.
    pub inner: Part,
    /// Boxes at every point of which some requirement fails.
    pub outer: Part,
    /// The rest.
    pub boundary: Part,
    /// Boxes left out by symmetry.
    pub mirrored: u64,
    /// Most splits on a path.
    pub depth: u32,
    /// Connected components of the inner boxes; none where the memory is too small.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub components: Option<ComponentsReport>,
    /// Boxes tried by this run, or merged.
    pub boxes: u64,
    /// Seconds taken.
    pub seconds: f64,
    /// The unit of volumes, as `mm^3`, where the design names one of lengths.
    #[serde(skip)]
    pub unit: Option<String>,
}

/// The unit of volumes of a box, where lengths have this unit; none of formulas, whose coordinates have none.
pub fn unit_of_volume(
    claim: &MachineClaim,
    coordinates: Option<&[String]>,
    unit: Option<&str>,
) -> Option<String> {
    let unit = unit.filter(|_| !matches!(claim.mechanism, Mechanism::Formulas(_)))?;
    match box_ends(claim, coordinates)?.len() {
        1 => Some(unit.to_owned()),
        power => Some(format!("{unit}^{power}")),
    }
}

/// The components of the inner boxes: boxes that share a part of a face are connected.
#[derive(Clone, Debug, Serialize)]
pub struct ComponentsReport {
    /// With images.
    pub count: u64,
    /// The largest, by descending volume.
    pub largest: Vec<ComponentReport>,
    /// The least condition number `sigma_max / sigma_min` found in an inner box; none where it depends on
    /// other coordinates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub best_conditioning: Option<f64>,
    /// Where that is, about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub best_conditioned_at: Option<Vec<f64>>,
    /// What that point is.
    #[serde(skip)]
    what_is_there: &'static str,
    /// Whether parts of boxes that planes cut are inner, too: they are in no component.
    #[serde(skip)]
    are_cut: bool,
}

/// A component.
#[derive(Clone, Debug, Serialize)]
pub struct ComponentReport {
    /// Its share of the box's volume, with its images, rounded down.
    pub share: f64,
    /// How many.
    pub boxes: u64,
    /// Itself and its images under permutations of the axes.
    pub copies: u64,
    /// Whether the best conditioned point is in it, or in an image of it.
    pub best_conditioned: bool,
}

/// The boxes of one kind, in a box that is searched.
#[derive(Clone, Debug, Serialize)]
pub struct Part {
    /// How many.
    pub boxes: u64,
    /// Their share of the box's volume, with their images.
    pub share: Exact,
    /// Their volume with their images, where the box's volume is rational.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub volume: Option<Exact>,
}

impl PavingReport {
    /// What a paving, at `target`, holds of a claim.
    pub fn new(
        claim: &MachineClaim,
        paved: &Paved,
        components: Option<&Components>,
        target: &Path,
    ) -> Self {
        let coordinates = paved.header.coordinates.as_deref();
        let volume = box_volume(claim, coordinates);
        let part = |boxes: u64, share: Share| {
            let share = share.fraction();
            let volume = volume.as_ref().map(|volume| Exact::Rational(volume * &share));
            Part { boxes, share: Exact::Rational(share), volume }
        };
        let summary = &paved.summary;
        let Summary { inner_share: Share(inner), boundary_share: Share(boundary), .. } =
            paved.summary;
        let whole = 1 << SHARE_BITS;
        let outer = Share(whole - inner - boundary);
        let gap = match (inner, boundary) {
            (_, 0) => Some(0.0),
            (0, _) => None,
            _ => Some(boundary as f64 / inner as f64),
        };
        PavingReport {
            title: None,
            design: String::new(),
            coordinates: paved.header.coordinates.clone(),
            paving: target.to_string_lossy().into_owned(),
            bytes: paved.bytes,
            sha256: paved.sha256.clone(),
            gap,
            reached: true,
            inner: part(summary.inner, summary.inner_share),
            outer: part(summary.outer, outer),
            boundary: part(summary.boundary, summary.boundary_share),
            mirrored: summary.mirrored,
            depth: paved.header.depth,
            components: components.map(|found| {
                let ends = box_ends(claim, coordinates).unwrap_or_default();
                described(found, &ends, inner)
            }),
            boxes: paved.boxes,
            seconds: 0.0,
            unit: None,
        }
    }

    /// The report for people, or its first line.
    pub fn text(&self, quiet: bool) -> String {
        let size = |part: &Part| part.volume.as_ref().unwrap_or(&part.share).as_rational().cloned();
        let (inner, open) = (size(&self.inner), size(&self.boundary));
        let (Some(inner), Some(open)) = (inner, open) else {
            return String::new();
        };
        let unit = match (&self.inner.volume, &self.unit) {
            (None, _) => " of the box".to_owned(),
            (Some(_), Some(unit)) => format!(" {unit}"),
            (Some(_), None) => String::new(),
        };
        // Of shares and of volumes the quotient is the same.
        let gap = match self.gap {
            Some(_) if open.is_zero() => "0 %".to_owned(),
            Some(_) => percent(&(&open / &inner), 3, Toward::Above),
            None => "none".to_owned(),
        };
        let first = format!(
            "volume: between {}{unit} and {}{unit}, gap {gap}\n",
            briefly(&inner, DIGITS, Toward::Below),
            briefly(&(&inner + &open), DIGITS, Toward::Above),
        );
        if quiet {
            return first;
        }
        let row = |name: &str, part: &Part, toward: Toward, what: &str| {
            let share = part.share.as_rational().map(|share| percent(share, 6, toward));
            format!(
                "  {name:<9} {:>13} {:<5} {:>11} of the box   {what}\n",
                grouped(part.boxes),
                if part.boxes == 1 { "box" } else { "boxes" },
                share.unwrap_or_default()
            )
        };
        let mut out = first + "\n";
        if let Some(own) = &self.coordinates {
            let own = own.join(", ");
            out += &format!(
                "  Of ({own}), for all values of the other coordinates in the workspace.\n\n"
            );
        }
        out += &row("inner", &self.inner, Toward::Below, "all requirements hold at every point");
        out += &row("outer", &self.outer, Toward::Below, "some requirement fails at every point");
        out += &row(
            "boundary",
            &self.boundary,
            Toward::Above,
            "undecided, or between planes that cut them",
        );
        if self.mirrored > 0 {
            out += "\n  The machine looks the same from permuted axes: only points with x <= y <= z are\n  \
                paved, and the shares count all images.\n";
        }
        if let Some(components) = &self.components {
            out += &components_text(components);
        }
        if !self.reached {
            out += "\n  What was asked for is not reached: raise --max-boxes.\n";
        }
        let rate = self.boxes as f64 / self.seconds;
        out + &format!(
        "\n  paving {} ({} bytes), every box confirmed by the exact checker\n  sha256 {}\n  {} in {} s, {} \
         boxes/s\n",
        Shown(&self.paving),
        grouped(self.bytes),
        self.sha256,
        boxes(self.boxes as usize),
        significant(self.seconds, 3),
        grouped(rate as u64),
    )
    }
}

fn described(found: &Components, ends: &[Pair], inner: u128) -> ComponentsReport {
    let described = |component: &Component| ComponentReport {
        share: rounded_down(component.share),
        boxes: component.boxes,
        copies: component.copies,
        best_conditioned: component.best_conditioned,
    };
    let point = found.point(ends);
    let is_found = found.conditioning.is_finite() && point.iter().all(|x| x.is_finite());
    ComponentsReport {
        are_cut: found.all.iter().map(|component| component.share).sum::<u128>() < inner,
        count: found.all.iter().map(|component| component.copies).sum(),
        largest: found.all.iter().take(SHOWN).map(described).collect(),
        best_conditioning: is_found.then_some(found.conditioning),
        best_conditioned_at: is_found.then_some(point),
        what_is_there: found.what_is_there(),
    }
}

/// A share in units of `2^-SHARE_BITS`, rounded down to a double. All bits but the 53 leading ones are
/// dropped, which makes it no greater; what is left is a double exactly, as is its product with a power
/// of two.
fn rounded_down(share: u128) -> f64 {
    let dropped = (u128::BITS - share.leading_zeros()).saturating_sub(f64::MANTISSA_DIGITS);
    ((share >> dropped) << dropped) as f64 * (-f64::from(SHARE_BITS)).exp2()
}

impl ComponentReport {
    /// Its share in per cent, rounded down.
    fn percent(&self) -> String {
        BigRational::from_float(self.share)
            .map_or_else(String::new, |share| percent(&share, 6, Toward::Below))
    }
}

fn components_text(components: &ComponentsReport) -> String {
    let at = components.best_conditioned_at.iter().flatten();
    let at: Vec<String> = at.map(|x| significant(*x, 3)).collect();
    let at = at.join(", ");
    let mut out = format!(
        "\n  components {:>10}, by shared faces; they may join in undecided boxes\n",
        grouped(components.count)
    );
    if components.are_cut {
        out += "              of whole inner boxes: the parts of boxes that planes cut, which the\n              \
                shares above have, are not in these\n";
    }
    for component in &components.largest {
        let copies = match component.copies {
            1 => String::new(),
            n => format!(" together with {} images", n - 1),
        };
        out += &format!(
            "    {:>11} of the box{copies}, {}\n",
            component.percent(),
            boxes(component.boxes as usize)
        );
        if component.best_conditioned {
            let least = components.best_conditioning.map(|least| significant(least, 4));
            let least = least.unwrap_or_default();
            out += &format!(
                "              has the {}, ({at}):\n              \
                 condition number {least}\n",
                components.what_is_there
            );
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_of_shares_are_not_above_them() {
        let whole = 1u128 << SHARE_BITS;
        assert_eq!(rounded_down(whole), 1.0);
        assert_eq!(rounded_down(0), 0.0);
        // The nearest double is 1.
        assert!(rounded_down(whole - 1) < 1.0);
        assert_eq!(rounded_down(1), (-f64::from(SHARE_BITS)).exp2());
    }
}
