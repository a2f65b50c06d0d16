//! From blocks that are explained to those next to them.

use super::window::SETTLED;
use super::{Curve, Fit, GOOD, Grown, Growth, MISSED, NEAR, Node, WINDOW};
use crate::fit::finer::finer;
use crate::fit::propose::{NEW, onwards};
use crate::fit::trim::{touched, trimmed};
use crate::least_squares::{Damped, iterate};
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
    /// Mean square of the residuals of these, and of the first and the last of them, whichever is largest.
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
        let curve = Curve::through(&with.chains)?;
        let x = curve.offsets.clone();
        let mut fit = Fit::new(self.fit.rod, curve, self.fit.blocks, &self.sources);
        (fit.states, fit.asked) = (with.states, with.asked);
        fit.bend = fit.bend.max(self.fit.bend);
        let x = iterate(&mut fit, x, Damped::until(SETTLED), STEPS).0.x;
        let model = fit.model(&x)?;
        let explained = fit.explained(&model);
        self.count(fit.count_asked(), fit.evaluations + 1);
        let is_counted = |k: &usize| !self.fit.blocks.blocks[*k].is_left_out;
        let size = |k: usize| explained.residuals[k].map(|r| r.norm());
        let cost = fit.cost_of(&explained);
        let mean_of = |part: Range<usize>, missed: Option<f64>| {
            let own: Vec<f64> = part.filter(is_counted).filter_map(|k| size(k).map(|r| r * r).or(missed)).collect();
            own.iter().sum::<f64>() / (3 * own.len().max(1)) as f64
        };
        let edges = [
            range.start..range.end.min(range.start + NEAR + 1),
            range.end.saturating_sub(NEAR + 1).max(range.start)..range.end,
        ];
        let mean =
            edges.into_iter().map(|edge| mean_of(edge, None)).fold(mean_of(range.clone(), Some(MISSED)), f64::max);
        let mut chains = model.curve.nodes_of_chains();
        for (node, given) in chains.iter_mut().flatten().zip(with.chains.iter().flatten()) {
            node.sigma = given.sigma;
        }
        let states = fit.states.iter().zip(&model.states).map(|(known, new)| new.clone().or(known.clone())).collect();
        Some(Together {
            grown: Grown { chains, states, asked: fit.asked },
            range,
            cost,
            mean,
            residuals: explained.residuals,
        })
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
            match self.together(wider, range) {
                Some(wider) if wider.is_good() => (at, more) = (wider, more + more / 2),
                _ if more > NEAR => more /= 3,
                // nodes may be too far apart there
                Some(wider) => match self.refined(&wider, is_forwards) {
                    Some(finer) if finer.is_good() => (at, more) = (finer, WINDOW),
                    _ => return at,
                },
                None => return at,
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
