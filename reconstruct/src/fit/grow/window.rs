//! A contour against some blocks.

use super::{Blocks, Curve, Fit, Growth, MISSED, Node};
use crate::fit::problem::cost_of;
use crate::least_squares::{Damped, iterate};
use nalgebra::Vector2;
use rod_contact::State;
use rod_core::PhysicalRod;
use std::ops::Range;

/// Standard deviation of what is known of the contour while new contour is fitted to a window, rod lengths.
const HELD: f64 = 1e-4;
/// Relative decrease of the cost at which these fits have settled.
pub(super) const SETTLED: f64 = 1e-3;

/// Blocks on which contour is tried, and the states that are known there.
#[derive(Clone)]
pub(super) struct Window {
    pub range: Range<usize>,
    pub blocks: Blocks,
    pub states: Vec<Option<State>>,
}

/// What a contour makes of a window.
pub(super) struct Tried {
    /// Of the blocks alone.
    pub cost: f64,
    /// Mean square of the residuals; a block that is not reached counts much.
    pub mean: f64,
    pub chains: Vec<Vec<Node>>,
    /// With the states that were found.
    pub window: Window,
}

impl<R: PhysicalRod> Growth<'_, '_, R> {
    /// Some blocks, of which nothing is known.
    pub fn window(&self, range: Range<usize>) -> Window {
        let mut blocks = self.fit.blocks.blocks[range.clone()].to_vec();
        blocks.iter_mut().for_each(|block| block.contacts.clear());
        let states = vec![None; blocks.len()];
        let segments = std::iter::once(0..blocks.len()).collect();
        let blocks = Blocks { blocks, segments, frame: self.fit.blocks.frame, ringing: 0 };
        Window { range, blocks, states }
    }

    /// What a contour makes of a window; after so many steps of its fit, in which nodes at the places `held` stay.
    pub fn tried(&self, chains: &[Vec<Node>], window: &Window, held: &[Vector2<f64>], steps: usize) -> Option<Tried> {
        let mut nodes = chains.to_vec();
        for node in nodes.iter_mut().flatten().filter(|node| held.contains(&node.at)) {
            node.sigma = HELD * self.length;
        }
        let curve = Curve::through(&nodes)?;
        let mut x = curve.offsets.clone();
        let mut fit = Fit::new(self.fit.rod, curve, &window.blocks, &self.sources);
        fit.states.clone_from(&window.states);
        // new contour may bend more than what is known
        fit.bend = fit.bend.max(self.fit.bend);
        if steps > 0 {
            x = iterate(&mut fit, x, Damped::until(SETTLED), steps).0.x;
        }
        let model = fit.model(&x)?;
        let explained = fit.explained(&model);
        self.count(window.range.len(), fit.evaluations + 1);
        let counted = explained.residuals.iter().zip(&window.blocks.blocks).filter(|(_, block)| !block.is_left_out);
        let squares: Vec<Option<f64>> = counted.map(|(residual, _)| residual.map(|r| r.norm_squared())).collect();
        let cost = squares.iter().map(|square| cost_of(square.map(f64::sqrt))).sum();
        let mean =
            squares.iter().map(|square| square.unwrap_or(MISSED)).sum::<f64>() / (3 * squares.len().max(1)) as f64;
        let mut moved = model.curve.nodes_of_chains();
        for (node, given) in moved.iter_mut().flatten().zip(chains.iter().flatten()) {
            node.sigma = given.sigma;
        }
        let chains = moved;
        Some(Tried { cost, mean, chains, window: Window { states: model.states, ..window.clone() } })
    }
}
