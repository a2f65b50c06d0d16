//! Contour where the recording asks for some and there is none.
//!
//! Where a run of explained blocks ends, either a new contact begins somewhere along the rod, or the contour goes on in another direction than was
//! guessed. The shape of the rod is known there, so a new contact has few unknowns. Each such contour is tried on the next blocks. The best
//! are fitted to more and more of these, and the one that is left is fitted together with all that was explained before, and followed to the end of
//! the run. It is kept only if the cost of the whole recording falls.

mod candidates;
mod contest;
mod extend;
mod solution;
mod window;

use super::blocks::Blocks;
use super::curve::{Curve, Node};
use super::problem::{Fit, Sources};
use super::propose::Space;
use super::swept::Swept;
use super::trim::{touched, trimmed};
use crate::systematic::Errors;
use nalgebra::Vector3;
use rod_contact::State;
use rod_core::PhysicalRod;
use solution::Solution;
use std::cell::Cell;
use std::ops::Range;
use window::Tried;

/// Most runs for which contour is looked for at a time.
const RUNS: usize = 8;
/// Mean square of residuals up to which blocks are explained.
const GOOD: f64 = 3.0;
/// Sum of the squares of the residuals of a block that is explained, at most.
const OUTLIER: f64 = 30.0;
/// Sum of the squares of the residuals that a block counts with which is not reached.
const MISSED: f64 = 368.0;
/// Blocks to either side of one over which that mean is taken.
const NEAR: usize = 2;
/// Blocks on which new contour is tried, and by which what is explained is extended at first.
const WINDOW: usize = 12;
/// How often what a window explains is halved until it is explained together with what was before.
const HALVES: usize = 4;
/// Least share of an evaluation of the whole recording that a part takes: the contour is made anew, and its equilibrium looked for.
const LEAST: f64 = 0.05;
/// Cost up to which a contour may lose by being trimmed: what noise does to some blocks.
const TRIMMED: f64 = 20.0;

/// A contour, and the states of the rod past it, as far as they are known.
#[derive(Clone)]
pub(super) struct Grown {
    pub chains: Vec<Vec<Node>>,
    pub states: Vec<Option<State>>,
    /// Which blocks are to be explained.
    pub asked: Vec<bool>,
}

struct Growth<'a, 'b, R> {
    fit: &'b Fit<'a, R>,
    /// The errors as they are.
    sources: Sources,
    length: f64,
    swept: Swept,
    /// Evaluations of the model at all poses that this took.
    evaluations: Cell<f64>,
}

/// A contour that explains more of a recording than `curve`, of which the fit has the states; none if none is found. And the number of evaluations
/// of the model that this took.
pub(super) fn grown<R: PhysicalRod>(fit: &Fit<'_, R>, errors: Vec<Errors>, curve: &Curve) -> (Option<Grown>, usize) {
    let mut now = Grown { chains: curve.nodes_of_chains(), states: fit.states.clone(), asked: fit.asked.clone() };
    let mut growth = Growth {
        fit,
        sources: Sources { known: errors, ..Sources::default() },
        length: fit.rod.units().length,
        swept: Swept::default(),
        evaluations: Cell::new(0.0),
    };
    growth.swept = growth.swept_by(&now);
    // more than was asked of it
    let all = Grown { asked: vec![true; now.asked.len()], ..now.clone() };
    let Some(whole) = growth.whole(&all) else { return (None, 1) };
    let mut good: Vec<bool> = (0..fit.blocks.blocks.len()).map(|k| is_good(k, fit.blocks, &whole.residuals)).collect();
    let mut is_new = good.iter().zip(&now.asked).any(|(is_good, asked)| *is_good && !asked);
    now.asked.iter_mut().zip(&good).for_each(|(asked, is_good)| *asked |= is_good);
    let mut cost = growth.cost(&now);
    if let Some(chains) = trimmed(&now.chains, &growth.touched(&now), &growth.swept, growth.length, f64::INFINITY) {
        let shorter = Grown { chains, ..now.clone() };
        let of_shorter = growth.cost(&shorter);
        if of_shorter < cost + TRIMMED {
            is_new |= of_shorter < cost;
            (now, cost) = (shorter, of_shorter);
        }
    }
    let mut seen: Vec<Range<usize>> = Vec::new();
    for _ in 0..RUNS {
        let Some(run) = longest_run(fit.blocks, &good, &seen) else { break };
        seen.push(run.clone());
        if let Some((found, part, less)) = growth.explaining(&now, cost, &good, &run) {
            good[part].fill(true);
            (now, cost, is_new) = (found, less, true);
            // of more, what is explained is known badly
            if now.asked.contains(&false) {
                break;
            }
        }
    }
    (is_new.then_some(now), growth.evaluations.get().ceil() as usize)
}

/// Whether a block is explained, together with those around it.
fn is_good(k: usize, blocks: &Blocks, residuals: &[Option<Vector3<f64>>]) -> bool {
    let segment = blocks.segment_of(k);
    let near = k.saturating_sub(NEAR).max(segment.start)..(k + NEAR + 1).min(segment.end);
    let squares: Vec<f64> = near.filter_map(|j| Some(residuals[j]?.norm_squared())).collect();
    let is_own = blocks.blocks[k].is_left_out || residuals[k].is_some_and(|r| r.norm_squared() < OUTLIER);
    is_own && !squares.is_empty() && squares.iter().sum::<f64>() < 3.0 * GOOD * squares.len() as f64
}

/// The longest run of blocks that are not explained, but for those that were seen.
fn longest_run(blocks: &Blocks, good: &[bool], seen: &[Range<usize>]) -> Option<Range<usize>> {
    let bad: Vec<bool> = good.iter().map(|is_good| !is_good).collect();
    let counted = |run: &Range<usize>| run.clone().filter(|k| !blocks.blocks[*k].is_left_out).count();
    let runs = blocks.runs(&bad).into_iter().filter(|run| counted(run) > 1 && !seen.contains(run));
    runs.max_by_key(Range::len)
}

impl<R: PhysicalRod> Growth<'_, '_, R> {
    fn touched(&self, now: &Grown) -> Vec<Vec<bool>> {
        touched(&now.chains, &now.states, self.length)
    }

    /// Where the rod was: by states, and where there is none, by the local answer.
    fn swept_by(&self, now: &Grown) -> Swept {
        let mut others = self.fit.blocks.clone();
        for (block, _) in others.blocks.iter_mut().zip(&now.states).filter(|(_, state)| state.is_some()) {
            block.contacts.clear();
        }
        let states = Swept::of_states(self.fit.rod, now.states.iter().flatten());
        states.and(Swept::of(self.fit.rod, &others, &self.sources.known))
    }

    fn space(&self) -> Space<'_> {
        Space { length: self.length, swept: &self.swept }
    }

    fn cost(&self, now: &Grown) -> f64 {
        self.whole(now).map_or(f64::INFINITY, |whole| whole.cost)
    }

    /// Counts evaluations of so many blocks.
    fn count(&self, blocks: usize, evaluations: usize) {
        let share = blocks as f64 / self.fit.blocks.blocks.len() as f64;
        self.evaluations.set(self.evaluations.get() + share.max(LEAST) * evaluations as f64);
    }

    /// What a contour makes of the whole recording.
    fn whole(&self, now: &Grown) -> Option<Solution> {
        self.solved(&now.chains, &[], self.fit.blocks, now.states.clone(), now.asked.clone(), 0)
    }

    /// With contour that explains a part of a run, if that costs less than before: that contour, the part and the cost.
    fn explaining(
        &self,
        now: &Grown,
        cost: f64,
        good: &[bool],
        run: &Range<usize>,
    ) -> Option<(Grown, Range<usize>, f64)> {
        let segment = self.fit.blocks.segment_of(run.start);
        let known = |k: &usize| good[*k] && now.states[*k].as_ref().is_some_and(|state| !state.contacts.is_empty());
        // the blocks next to the run may be half explained
        let before = (run.start >= segment.start + NEAR).then(|| run.start - NEAR).filter(known);
        let after = (run.end + NEAR <= segment.end).then(|| run.end + NEAR - 1).filter(known);
        let whole = |found: Option<Tried>, is_forwards: bool| {
            let found = found?;
            let Range { start, end } = found.window.range;
            let halves = (1..HALVES).map(|k| (end - start) >> k).take_while(|some| *some > NEAR + 1);
            let halves = std::iter::once(end - start).chain(halves);
            let parts = halves.map(|some| if is_forwards { start..start + some } else { end - some..end });
            let mut together = parts.filter_map(|part| self.together(now.with(&found, &part), part));
            together.find(|found| found.is_good() && found.cost < cost)
        };
        let forwards = || whole(self.beyond(now, before?, run.end, true), true);
        let backwards = || whole(self.beyond(now, after?, run.start, false), false);
        let seeded = || {
            let is_alone = before.is_none() && after.is_none();
            is_alone.then(|| whole(self.seeded(now, run), true))?
        };
        let remembered = || whole(self.remembered(now, good, run), true);
        let start = forwards().or_else(backwards).or_else(remembered).or_else(seeded)?;
        let found = self.continued(self.continued(start, run.end, true), run.start, false);
        (found.cost < cost).then_some((found.grown, found.range, found.cost))
    }
}

impl Grown {
    /// With the contour of a window, its states there, and a part of it that is to be explained.
    fn with(&self, found: &Tried, part: &Range<usize>) -> Self {
        let (mut states, mut asked) = (self.states.clone(), self.asked.clone());
        states[found.window.range.clone()].clone_from_slice(&found.window.states);
        asked[part.clone()].fill(true);
        Self { chains: found.chains.clone(), states, asked }
    }
}
