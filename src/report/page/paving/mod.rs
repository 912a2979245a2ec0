//! A paving as one HTML file, like those of certificates.
//!
//! | module   | holds                                              |
//! |----------|----------------------------------------------------|
//! | `region` | the region in pictures, from the paving's tree     |
//!
//! Proved are the volumes, and what is said of the boxes. Pictures stop at a depth that keeps the file
//! small, which they say; a box that is split further counts as undecided in them, unless all of it
//! is inner, or all outer.

mod region;
mod sections;

use super::isomap::Mark;
use super::legs::Point;
use super::{drawing, mechanism, shape, stem, File, Framed, Picture};
use crate::exact::decimal::{briefly, percent, Toward};
use crate::report::paving::unit_of_volume;
use crate::search::paving::{axes, box_ends, box_volume, ends, ranges, Components, Tree};
use num_bigint::BigInt;
use num_rational::BigRational;
use orthocert_checker::certificate;
use orthocert_kernel::certificate::Provenance;
use orthocert_kernel::claim::MachineClaim;
use orthocert_kernel::number::Expression;
use orthocert_kernel::paving::{Accepted, Share};
use region::Region;
use serde_json::json;

/// The depth down to which a paving is read for its page.
pub const DEPTH: u32 = 24;
/// Most boxes of the view in space.
const MOST_IN_VIEW: usize = 40_000;
/// Most boxes of the picture of it.
const MOST_IN_PICTURE: usize = 6_000;
/// Most bytes of the slices.
const MOST_OF_SLICES: usize = 1_500_000;
/// Fractional bits of the ends of a box that are not rational.
const END_BITS: u32 = 256;
/// Digits of volumes.
const DIGITS: u32 = 9;

/// What is on a page.
pub struct PavingPage<'a> {
    claim: &'a MachineClaim,
    accepted: &'a Accepted,
    components: Option<&'a Components>,
    file: File<'a>,
    title: String,
    /// The unit of volumes.
    unit: Option<String>,
    marks: Vec<Mark>,
    /// The tree of the view in space.
    tree: Tree,
    ends: [Point; 2],
    dimension: usize,
    /// The depths of the view in space, of the pictures of it, and of the slices; none where all of
    /// the paving is there.
    depths: [Option<u32>; 3],
    pictures: Vec<Picture>,
    /// The names of the axes.
    axes: [String; 3],
}

impl<'a> PavingPage<'a> {
    /// The page of a paving that the checker has accepted; `tree` is its tree down to [`DEPTH`], title and unit of lengths
    /// are the design's. `None` if its box is beyond floating point.
    pub fn new(
        accepted: &'a Accepted,
        tree: &Tree,
        components: Option<&'a Components>,
        file: File<'a>,
        title: Option<&str>,
        unit: Option<&str>,
    ) -> Option<Self> {
        let claim = &accepted.header.claim.machine;
        let (ends, axes) = (ends(&accepted.header)?, axes(&accepted.header));
        let least: Point = ends.map(|[least, _]| least);
        let width: Point = ends.map(|[least, most]| most - least);
        let is_shown = |x: &f64| x.abs() < 1e60;
        if !ends.as_flattened().iter().all(is_shown) || width.iter().any(|w| *w <= 0.0) {
            return None;
        }
        let box_ends = box_ends(claim, accepted.header.coordinates.as_deref())?;
        let components = components.filter(|found| !found.all.is_empty());
        let best = components.filter(|found| found.conditioning.is_finite());
        let mark = best.map(|found| Mark {
            name: "best conditioned".to_owned(),
            // Along axes that there are not, in the middle.
            at: found.point(&box_ends).into_iter().chain([0.5; 3]).take(3).collect(),
        });
        let marks: Vec<Mark> = mark.into_iter().collect();
        // Images are of parts of boxes: their tree may be deeper than the paving.
        let deepest = tree.depth();
        let fitting = |most: usize| {
            let trees = (0..=deepest).rev().map(|depth| (depth, tree.to_depth(depth)));
            let mut trees = trees.filter(|(_, tree)| region::leaves(tree) <= most);
            trees.next().unwrap_or_else(|| (0, tree.to_depth(0)))
        };
        let (of_view, view) = fitting(MOST_IN_VIEW);
        let (of_picture, coarse) = fitting(MOST_IN_PICTURE);
        let in_slices = |depth: u32| {
            let tree = tree.to_depth(depth);
            (depth, Region { tree: &tree, least, width, axes: &axes }.slices(&marks))
        };
        let is_small = |slices: &Picture| slices.content.len() <= MOST_OF_SLICES;
        let mut slices = (0..=deepest).rev().map(in_slices);
        let (of_slices, slices) = slices.find(|(depth, slices)| *depth == 0 || is_small(slices))?;
        let is_whole = accepted.header.depth <= DEPTH;
        let depths = [of_view, of_picture, of_slices].map(|depth| match depth {
            _ if !is_whole => Some(depth.min(DEPTH)),
            _ => Some(depth).filter(|depth| *depth < deepest),
        });
        let machine = shape::shape(claim);
        let mut pictures: Vec<Picture> =
            machine.iter().map(|machine| drawing::drawing(machine, &[])).collect();
        pictures.push(Region { tree: &coarse, least, width, axes: &axes }.picture());
        pictures.push(slices);
        Some(PavingPage {
            claim,
            accepted,
            components,
            file,
            title: title.unwrap_or(stem(file.name)).to_owned(),
            unit: unit_of_volume(claim, accepted.header.coordinates.as_deref(), unit)
                .map(|unit| unit.replace("^2", "\u{b2}").replace("^3", "\u{b3}")),
            marks,
            tree: view,
            ends: [least, width],
            dimension: box_ends.len(),
            depths,
            pictures,
            axes,
        })
    }

    /// Every figure.
    pub fn pictures(&self) -> impl Iterator<Item = &Picture> {
        self.pictures.iter()
    }

    fn picture(&self, name: &str) -> String {
        let found = self.pictures.iter().find(|picture| picture.name == name);
        found.map(Picture::inline).unwrap_or_default()
    }

    /// The HTML file.
    pub fn html(&self) -> String {
        let [least, width] = self.ends;
        let region = Region { tree: &self.tree, least, width, axes: &self.axes };
        let data = json!({
            "trees": [], "marks": [], "region": region.data(&self.marks), "ends": self.exact_ends(),
        });
        let [low, high] = self.volume();
        let headline = format!("\u{2713} CERTIFIED: volume between {low} and {high}");
        let meaning =
            "Every inner box lies in the region where all requirements hold, and no outer box \
            meets it; nor do the parts of boxes that planes cut off. The exact checker accepted the evidence of \
            every box.";
        let Provenance { tool, version } = self.accepted.header.provenance.clone();
        Framed {
            kind: "paving",
            title: &self.title,
            subject: &format!(
                "Where the requirements hold: {}, in {}",
                mechanism::machine(self.claim),
                mechanism::workspace(self.claim)
            ),
            verdict: "certified",
            headline: &headline,
            meaning,
            sections: &self.sections(),
            provenance: &certificate::Provenance { tool, version },
            data: &data,
            verified: None,
        }
        .html()
    }

    /// The certified bounds of the region's volume, rounded outwards; as shares of the box where its
    /// own volume is not rational.
    fn volume(&self) -> [String; 2] {
        let summary = &self.accepted.summary;
        let (inner, open) = (summary.inner_share.fraction(), summary.boundary_share.fraction());
        let unit = self.unit.iter().map(|unit| format!(" {unit}")).collect();
        let (unit, whole): (String, _) =
            match box_volume(self.claim, self.accepted.header.coordinates.as_deref()) {
                Some(volume) => (unit, volume),
                None => (" of the box".to_owned(), BigRational::from_integer(1.into())),
            };
        let low = briefly(&(&inner * &whole), DIGITS, Toward::Below);
        let high = briefly(&((inner + open) * whole), DIGITS, Toward::Above);
        [low + &unit, high + &unit]
    }

    /// The ends of the box along every axis, for read-outs of its parts: the least and the greatest as
    /// `[p, q, r, s]`, for `p/q` and `r/s`, twice: neither above its end, then neither below it.
    ///
    /// **Lemma.** Where the part `0 <= u <= 1` of an edge ends, `(1 - u) a + u b` with `a` and `b` the
    /// ends, is not below what the former give, and not above what the latter give. *Proof.* Both
    /// weights are not negative. ∎
    fn exact_ends(&self) -> Option<Vec<[[String; 4]; 2]>> {
        let ranges = ranges(self.claim, self.accepted.header.coordinates.as_deref())?;
        let enclosed = |x: &Expression| match x.rational() {
            Some(x) => Some([x.clone(), x]),
            None => {
                let x = x.enclose(END_BITS)?;
                let end = |x| BigRational::new(x, BigInt::from(1) << END_BITS);
                Some([end(x.lo), end(x.hi)])
            }
        };
        let constant = |x: i64| Expression::integer(x);
        let ends = |k: usize| {
            let none = [0, 1].map(constant);
            let [min, max] = ranges.get(k).copied().unwrap_or([&none[0], &none[1]]);
            let (least, most) = (enclosed(min)?, enclosed(max)?);
            Some([0, 1].map(|side| {
                let (a, b) = (&least[side], &most[side]);
                [a.numer(), a.denom(), b.numer(), b.denom()].map(ToString::to_string)
            }))
        };
        (0..3).map(ends).collect()
    }

    /// A share of the box, in percent.
    fn percent(share: Share, toward: Toward) -> String {
        percent(&share.fraction(), 6, toward)
    }
}
