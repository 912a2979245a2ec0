//! No cube of a side fits: a tree over the centres.

use crate::questions::frontier::NoAnswer;
use crate::search::solver::doubles::{middle, Pair};
use crate::search::solver::fails::Failing;
use crate::search::solver::search::{search, Boxes, Cell, Ends, Trial};
use crate::search::solver::{approximate, confirmed, PRECISIONS};
use crate::search::{Budget, Control, Stop};
use orthocert_checker::certificate::Certificate;
use orthocert_kernel::certificate::{Claim, Node, Tree};
use orthocert_kernel::claim::{MachineClaim, NoCubeClaim};
use orthocert_kernel::number::Expression;
use orthocert_kernel::problem::Problem;
use orthocert_kernel::tree::OFFSET_PARTS;

/// A precision at which most exclusions are checked in machine words.
const IN_WORDS: u32 = 40;

/// The search, in every cell of centres, for a point of the cube at which the claim fails.
struct Centres<'a> {
    failing: Failing<'a>,
    /// Points of the cube, and how far they are from its centre: corners, the middles of edges and
    /// faces, the centre.
    points: Vec<([i64; 3], [f64; 3])>,
}

impl Boxes for Centres<'_> {
    fn root(&self) -> &Cell {
        self.failing.root()
    }

    fn obligations(&self) -> usize {
        1
    }

    fn trial(&self, cell: &Cell, _open: &[usize], _asked: bool) -> Trial {
        let margin = |by: &[f64; 3]| {
            let point: Vec<f64> = cell.iter().zip(by).map(|(x, by)| middle(x) + by).collect();
            self.failing.margin(&point)
        };
        let margins = self.points.iter().map(|point| (margin(&point.1), point));
        let mut failing: Vec<_> = margins.filter(|(margin, _)| *margin < 0.0).collect();
        failing.sort_by(|a, b| a.0.total_cmp(&b.0));
        let found = failing.into_iter().find_map(|(_, (at, by))| {
            let moved: Vec<Pair> =
                cell.iter().zip(by).map(|(x, by)| (x.0 + by, x.1 + by)).collect();
            Some((at, self.failing.throughout(&moved)?))
        });
        let weights = cell.iter().map(|(lo, hi)| hi - lo).collect();
        let (node, open) = match found {
            Some((at, fails)) => {
                (Node { fails: Some(fails), at: at.to_vec(), ..Node::default() }, Vec::new())
            }
            None => (Node::default(), vec![0]),
        };
        Trial { node, open, weights, hopeless: false }
    }
}

/// A certificate that no cube of this side fits with its centre in the workspace of `claim`, a box;
/// `None` where there is none within the budget.
///
/// # Errors
/// [`NoAnswer`].
pub fn exclude(
    claim: &MachineClaim,
    side: &Expression,
    budget: Budget,
    control: &mut Control<'_>,
) -> Result<Option<Box<Certificate>>, NoAnswer> {
    let too_large = || NoAnswer::Claim("its numbers exceed what can be reported".to_owned());
    let problem = Problem::new(claim)?;
    let failing = Failing::new(claim, &problem)?;
    let half = 0.5 * approximate(side).ok_or_else(too_large)? / failing.unit();
    let offset = |n: i64| [n % 3, n / 3 % 3, n / 9].map(|i| i - 1);
    let point = |n| (offset(n).map(|i| i * OFFSET_PARTS), offset(n).map(|i| i as f64 * half));
    let centres = Centres { failing, points: (0..27).map(point).collect() };
    let found = search(&centres, Ends::default(), budget, control);
    if found.stop == Stop::Cancelled {
        return Err(NoAnswer::Cancelled);
    }
    if !found.is_proof() {
        return Ok(None);
    }
    let claim = NoCubeClaim { machine: claim.clone(), side: side.clone() };
    let tree = Tree { precision: IN_WORDS, chords: None, nodes: found.nodes };
    let precisions = [IN_WORDS].into_iter().chain(PRECISIONS);
    Ok(confirmed(Claim::NoCube(claim), tree, precisions).ok().map(|(certificate, _)| certificate))
}
