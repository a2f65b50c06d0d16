//! From blocks that are explained to those next to them.

use super::solution::mean_square;
use super::{Curve, GOOD, Grown, Growth, MISSED, NEAR, Node, WINDOW};
use crate::fit::finer::finer;
use crate::fit::propose::{NEW, onwards};
use crate::fit::trim::{touched, trimmed};
use nalgebra::{Vector2, Vector3};
use rod_core::PhysicalRod;
use std::ops::Range;

/// Most steps of a fit to all that is explained.
const STEPS: usize = 12;
/// Nodes by which an end that is touched goes on, each turned by so much (radians) towards the solid; and how far one goes on that is made anew, rod
/// lengths.
const NODES: usize = 4;
const END_TURN: f64 = 0.2;
const END: f64 = 0.06;

/// What explains more of a recording.
pub(super) struct Together {
    pub grown: Grown,
    /// Which blocks more.
    pub range: Range<usize>,
    /// Of the whole recording.
    pub cost: f64,
    mean: f64,
    residuals: Vec<Option<Vector3<f64>>>,
}

impl Together {
    pub fn is_good(&self) -> bool {
        self.mean < GOOD
    }
}

impl<R: PhysicalRod> Growth<'_, '_, R> {
    /// The contour that explains these blocks together with those that were explained before.
    pub fn together(&self, with: Grown, range: Range<usize>) -> Option<Together> {
        let found = self.solved(&with.chains, &[], self.fit.blocks, with.states, with.asked.clone(), STEPS)?;
        let states = found.states.into_iter().zip(found.known).map(|(new, known)| new.or(known)).collect();
        let mean = self.mean(&found.residuals, &range);
        let grown = Grown { chains: found.chains, states, asked: with.asked };
        Some(Together { grown, range, cost: found.cost, mean, residuals: found.residuals })
    }

    /// Mean square of the residuals of some blocks, or of the first or the last of those that are reached, whichever is largest.
    fn mean(&self, residuals: &[Option<Vector3<f64>>], range: &Range<usize>) -> f64 {
        let mean_of = |part: Range<usize>, missed: Option<f64>| {
            mean_square(&residuals[part.clone()], &self.fit.blocks.blocks[part], missed)
        };
        let Range { start, end } = *range;
        let edges = [start..end.min(start + NEAR + 1), end.saturating_sub(NEAR + 1).max(start)..end];
        edges.into_iter().map(|edge| mean_of(edge, None)).fold(mean_of(range.clone(), Some(MISSED)), f64::max)
    }

    /// The same with the most blocks beyond `before` that are explained; none where these are few.
    fn shortened(&self, found: &Together, before: &Together, is_forwards: bool) -> Option<Together> {
        let Range { start, end } = found.range;
        let more = (found.range.len() - before.range.len()).saturating_sub(1);
        let ranges = (NEAR + 1..=more).rev().map(|more| match is_forwards {
            true => start..before.range.end + more,
            false => before.range.start - more..end,
        });
        let (range, mean) =
            ranges.map(|range| (range.clone(), self.mean(&found.residuals, &range))).find(|of| of.1 < GOOD)?;
        let mut grown = Grown { asked: before.grown.asked.clone(), ..found.grown.clone() };
        grown.asked[range.clone()].fill(true);
        let cost = self.cost(&grown);
        let residuals = found.residuals.clone();
        (cost < before.cost).then_some(Together { grown, range, cost, mean, residuals })
    }

    /// From blocks that are explained on towards the end of their run.
    pub fn continued(&self, mut at: Together, end: usize, is_forwards: bool) -> Together {
        let mut more = WINDOW;
        loop {
            let Range { start, end: stop } = at.range;
            let range = if is_forwards {
                start..end.min(stop + more).max(stop)
            } else {
                end.max(start.saturating_sub(more)).min(start)..stop
            };
            if range == at.range {
                return at;
            }
            let mut wider = at.grown.clone();
            wider.asked[range.clone()].fill(true);
            wider.chains = self.with_ends(&wider);
            let Some(found) = self.together(wider, range) else { return at };
            if found.is_good() {
                (at, more) = (found, more + more / 2);
            } else if let Some(part) = self.shortened(&found, &at, is_forwards) {
                (at, more) = (part, WINDOW);
            } else if more > NEAR {
                more /= 3;
            } else {
                // nodes may be too far apart there
                match self.refined(&found, is_forwards).filter(Together::is_good) {
                    Some(finer) => (at, more) = (finer, WINDOW),
                    None => return at,
                }
            }
        }
    }

    /// The same with more nodes where the last of the blocks touch the contour.
    fn refined(&self, at: &Together, is_forwards: bool) -> Option<Together> {
        let Range { start, end } = at.range;
        let last =
            if is_forwards { end.saturating_sub(WINDOW).max(start)..end } else { start..end.min(start + WINDOW) };
        let seen = |k: usize| Some((at.grown.states[k].as_ref()?, at.residuals[k]?, last.contains(&k)));
        let curve = finer(&Curve::through(&at.grown.chains)?, (0..at.residuals.len()).filter_map(seen), self.length)?;
        let chains = curve.nodes_of_chains();
        self.together(Grown { chains, ..at.grown.clone() }, at.range.clone())
    }

    /// The contour as it is, or beyond what is touched of it in another way: what explains most.
    pub fn with_ends(&self, at: &Grown) -> Vec<Vec<Node>> {
        let touched = touched(&at.chains, &at.states, self.length);
        let more =
            |from: Vector2<f64>, at: Vector2<f64>, turn: f64| onwards(at, at - from, turn, NODES, NEW * self.length);
        let longer = |(chain, touched): (&Vec<Node>, &Vec<bool>)| {
            let (mut all, last) = (Vec::new(), chain.len() - 1);
            // the second node from an end: its interval is one of the last two
            if touched[1.min(last)] {
                all = more(chain[1].at, chain[0].at, -END_TURN);
                all.reverse();
            }
            all.extend_from_slice(chain);
            if touched[last - 1] {
                all.extend(more(chain[last - 1].at, chain[last].at, END_TURN));
            }
            all
        };
        let longer = at.chains.iter().zip(&touched).map(longer).collect();
        let trimmed = trimmed(&at.chains, &touched, &self.swept_by(at), self.length, END);
        let cost = |chains: &Vec<Vec<Node>>| self.cost(&Grown { chains: chains.clone(), ..at.clone() });
        let ways = [Some(longer), trimmed, Some(at.chains.clone())]
            .into_iter()
            .flatten()
            .map(|chains| (cost(&chains), chains));
        ways.min_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(|| at.chains.clone(), |best| best.1)
    }
}
