//! The best contour for some blocks, near one that is given.

use super::{Blocks, Curve, Fit, Growth, Node};
use crate::fit::blocks::Block;
use crate::least_squares::{Damped, iterate};
use nalgebra::{Vector2, Vector3};
use rod_contact::State;
use rod_core::PhysicalRod;

/// Standard deviation of what is held of a contour while the rest of it is fitted, rod lengths.
const HELD: f64 = 1e-4;
/// Relative decrease of the cost at which these fits have settled.
const SETTLED: f64 = 1e-3;

pub(super) struct Solution {
    pub chains: Vec<Vec<Node>>,
    /// The states past this contour, and the last that were known of each block.
    pub states: Vec<Option<State>>,
    pub known: Vec<Option<State>>,
    /// As in [`Explained`](crate::fit::problem::Explained).
    pub residuals: Vec<Option<Vector3<f64>>>,
    /// Of all these blocks.
    pub cost: f64,
}

impl<R: PhysicalRod> Growth<'_, '_, R> {
    /// The contour that explains the blocks that are `asked` for best, after so many steps of its fit, in which nodes at the places `held` stay; `states` are
    /// known of a contour near by.
    pub fn solved(
        &self,
        chains: &[Vec<Node>],
        held: &[Vector2<f64>],
        blocks: &Blocks,
        states: Vec<Option<State>>,
        asked: Vec<bool>,
        steps: usize,
    ) -> Option<Solution> {
        let mut nodes = chains.to_vec();
        for node in nodes.iter_mut().flatten().filter(|node| held.contains(&node.at)) {
            node.sigma = HELD * self.length;
        }
        let curve = Curve::through(&nodes)?;
        let mut x = curve.offsets.clone();
        let mut fit = Fit::new(self.fit.rod, curve, blocks, &self.sources);
        (fit.states, fit.asked) = (states, asked);
        // new contour may bend more than what is known
        fit.bend = fit.bend.max(self.fit.bend);
        if steps > 0 {
            x = iterate(&mut fit, x, Damped::until(SETTLED), steps).0.x;
        }
        let model = fit.model(&x)?;
        let explained = fit.explained(&model);
        self.count(fit.count_asked(), fit.evaluations + 1);
        let mut moved = model.curve.nodes_of_chains();
        for (node, given) in moved.iter_mut().flatten().zip(chains.iter().flatten()) {
            node.sigma = given.sigma;
        }
        let cost = fit.cost_of(&explained);
        Some(Solution { chains: moved, states: model.states, known: fit.states, residuals: explained.residuals, cost })
    }
}

/// Mean of the squares of residuals of blocks that are not left out; a block that is not reached counts as `missed`, or not at all.
pub(super) fn mean_square(residuals: &[Option<Vector3<f64>>], blocks: &[Block], missed: Option<f64>) -> f64 {
    let counted = residuals.iter().zip(blocks).filter(|(_, block)| !block.is_left_out);
    let squares: Vec<f64> =
        counted.filter_map(|(residual, _)| residual.map(|residual| residual.norm_squared()).or(missed)).collect();
    squares.iter().sum::<f64>() / (3 * squares.len().max(1)) as f64
}
