//! BA and BB told apart by their contacts, of a rod whose criteria do not tell them apart.
//!
//! Each piece of a run between kinks is resolved as either. The other one contradicts the reactions: the tip would have to move across the
//! contour, or the force at a tangential contact to act along it.

use super::answers::Answers;
use super::several::Together;
use crate::phase::Label;
use crate::point::{Inverse, Touch};
use crate::two_contacts::{AS_GOOD, Neighbour, Pair, Piece, Unresolved};
use nalgebra::Vector2;

/// Most pieces that are resolved together, with the labels in turn. Larger: more time; smaller: fewer pieces know the force of the first
/// contact from another one.
const MOST_TOGETHER: usize = 3;
/// Contacts farther apart than this many standard deviations and this length (rod lengths) are not the same.
const SIGMAS: f64 = 3.0;
const ROUNDING: f64 = 1e-6;

/// A way to explain the pieces up to one: the samples that it does not explain, its cost, and the numbers of what is resolved together.
#[derive(Clone, Debug, Default)]
struct Way {
    unexplained: usize,
    cost: f64,
    together: Vec<usize>,
}

impl Way {
    fn best(ways: impl IntoIterator<Item = Self>) -> Self {
        let better = |a: &Self, b: &Self| a.unexplained.cmp(&b.unexplained).then(a.cost.total_cmp(&b.cost));
        ways.into_iter().min_by(better).unwrap_or_default()
    }
}

fn other(label: Label) -> Label {
    if label == Label::BA { Label::BB } else { Label::BA }
}

impl<I: Inverse> Answers<'_, I> {
    /// Pieces without jumps in between, resolved with the labels that explain most samples best. Between pieces with one label are kinks
    /// that divide them. Those that nothing explains keep the labels of the phases. Where the other labels explain the reactions as well by
    /// contacts elsewhere, both are ambiguous.
    pub(super) fn tell_apart(&self, pieces: &[Piece], beside: [Option<&Neighbour>; 2]) -> Vec<Together> {
        let mut all: Vec<Together> = Vec::new();
        // up to each piece, which is BA or BB
        let mut best: Vec<[Way; 2]> = Vec::with_capacity(pieces.len());
        for end in 0..pieces.len() {
            let ways = [Label::BA, Label::BB].map(|last| {
                let label = |k: usize| if (end - k).is_multiple_of(2) { last } else { other(last) };
                let labelled = |k: usize| Piece { label: label(k), ..pieces[k].clone() };
                let ways = (0..=end).rev().take(MOST_TOGETHER).map_while(|start| {
                    // what contradicts the reactions alone does so together with others
                    let alone = |k: usize| all.iter().find(|together| together.pieces == [labelled(k)]);
                    let contradicts = |k: usize| alone(k).is_some_and(|together| together.found.contradicts());
                    if contradicts(start) || contradicts(end) {
                        return None;
                    }
                    let labelled = (start..=end).map(labelled).collect();
                    let here = [beside[0].filter(|_| start == 0), beside[1].filter(|_| end + 1 == pieces.len())];
                    let together = self.together(labelled, here);
                    // a piece before it that belongs to other ones has the same label
                    let before = start.checked_sub(1).map(|k| &best[k][usize::from(label(start) == Label::BB)]);
                    let mut way = before.cloned().unwrap_or_default();
                    way.unexplained += together.found.unexplained;
                    way.cost += together.found.cost;
                    way.together.push(all.len());
                    all.push(together);
                    Some(way)
                });
                Way::best(ways)
            });
            best.push(ways);
        }
        let chosen = Way::best(best.pop().into_iter().flatten());
        chosen.together.into_iter().map(|k| unless_ambiguous(&all, &all[k], pieces)).collect()
    }
}

/// What is resolved together, unless something else is as good.
fn unless_ambiguous(all: &[Together], chosen: &Together, given: &[Piece]) -> Together {
    let mut answer = chosen.clone();
    if chosen.found.unexplained > 0 {
        let phases = given.iter().skip_while(|piece| piece.range != chosen.pieces[0].range);
        answer.pieces.iter_mut().zip(phases).for_each(|(piece, given)| piece.label = given.label);
        return answer;
    }
    let turned = |together: &&Together| {
        let differs = |(a, b): (&Piece, &Piece)| a.range == b.range && a.label != b.label;
        together.pieces.len() == chosen.pieces.len() && together.pieces.iter().zip(&chosen.pieces).all(differs)
    };
    let is_as_good = |other: &&Together| other.found.unexplained == 0 && other.found.cost < chosen.found.cost + AS_GOOD;
    if all.iter().find(turned).filter(is_as_good).is_some_and(|other| elsewhere(chosen, other)) {
        answer.found.pairs.fill(Pair::without(Unresolved::Ambiguous));
    }
    answer
}

/// Whether the contacts of two answers differ somewhere.
fn elsewhere(a: &Together, b: &Together) -> bool {
    let apart = |(p, q): (Result<Touch, Unresolved>, Result<Touch, Unresolved>)| {
        let (Ok(p), Ok(q)) = (p, q) else { return p.is_ok() };
        let apart = Vector2::new(p.x - q.x, p.y - q.y);
        let distance = apart.norm();
        // of the distance times the deviation in its direction
        let product = apart.dot(&((p.covariance + q.covariance) * apart)).max(0.0).sqrt();
        distance > ROUNDING && distance * (distance - ROUNDING) > SIGMAS * product
    };
    let mut pairs = a.found.pairs.iter().zip(&b.found.pairs);
    pairs.any(|(a, b)| apart((a.first, b.first)) || apart((a.second, b.second)))
}
