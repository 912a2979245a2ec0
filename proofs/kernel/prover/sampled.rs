//! Checks of some cells of a paving, drawn at random.

use crate::paving::{Accepted, Cut, Judge, Kind, Outer, Reader, Rejected, Step, Subject, Visited};
use crate::statement;
use std::io::BufRead;

/// What a paving establishes if the evidence holds that was not drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// The paving; of its cells those are counted that were drawn.
    pub accepted: Accepted,
    /// How many there are.
    pub decided: u64,
}

/// Checks a paving, but of its inner and outer cells, and inner parts of cells, the evidence of `size` only,
/// or of all if there are fewer, drawn without replacement: any set of that size is as likely as another for a
/// random seed. They are kept in memory until the last node is read. Whoever knows the seed before the file is
/// made can forge what is not drawn. The shape of the tree, what every node claims, the symmetry and the
/// summary are checked whole.
///
/// # Errors
/// If it is rejected.
pub fn check_sample<R: BufRead>(input: R, size: u64, seed: u64) -> Result<Sampled, Rejected> {
    let mut reader = Reader::new(input)?;
    let subject = Subject::new(reader.header())?;
    let judge = Judge::new(&subject)?;
    let mut sample = Sample { drawn: Vec::new(), size, seen: 0, state: seed };
    while let Some(visited) = reader.next()? {
        if visited.item.kind.is_decided() {
            claims(&subject, &visited)?;
            sample.offer(visited);
        } else {
            judge.check(&visited)?;
        }
    }
    let (header, summary) = (reader.header().clone(), reader.finish()?);
    sample.drawn.iter().try_for_each(|visited| judge.check(visited))?;
    let accepted = Accepted { header, summary, checked: sample.drawn.len() as u64 };
    Ok(Sampled { accepted, decided: sample.seen })
}

/// Checks of a node, without evaluating its evidence, that it names obligations that the claim has.
fn claims(subject: &Subject, Visited { item, node, .. }: &Visited) -> Result<(), Rejected> {
    let is_none = |o: &usize| *o >= subject.problem.obligations.len();
    if let Some(Step(o, _)) = item.steps.iter().find(|Step(o, _)| is_none(o)) {
        return Err(Rejected::Step(*node, *o));
    }
    match &item.kind {
        Kind::Outer(Outer::Own(o))
        | Kind::At(_, Outer::Own(o))
        | Kind::Cut(Cut { fails: o, .. })
            if is_none(o) =>
        {
            Err(Rejected::Node(*node, " is not outer: it does not certainly fail throughout"))
        }
        _ => Ok(()),
    }
}

impl Sampled {
    /// What is known of the paving, in words.
    pub fn statement(&self) -> String {
        let Sampled { accepted, decided } = self;
        let Accepted { header, summary, checked } = accepted;
        if checked == decided {
            return statement::paving(accepted);
        }
        let parts = if header.coordinates.is_some() { " and parts of boxes" } else { "" };
        let shown = format!(
            "The evidence of {checked} of the {decided} boxes{parts} in R or off it, drawn at random, \
             was checked and holds.\nIf that of the others holds"
        );
        statement::region(header, summary, &shown)
    }
}

/// Draws `size` of however many cells are offered: the one after `seen` others takes the place of one
/// of the drawn with the probability `size / (seen + 1)` (Knuth, TAOCP 3.4.2, algorithm R, with all in
/// memory), by SplitMix64.
struct Sample {
    drawn: Vec<Visited>,
    size: u64,
    seen: u64,
    state: u64,
}

impl Sample {
    fn offer(&mut self, visited: Visited) {
        self.seen += 1;
        if self.seen <= self.size {
            self.drawn.push(visited);
            return;
        }
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let place = usize::try_from((z ^ (z >> 31)) % self.seen).ok();
        if let Some(replaced) = place.and_then(|place| self.drawn.get_mut(place)) {
            *replaced = visited;
        }
    }
}
