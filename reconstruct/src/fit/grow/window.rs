//! A contour against some blocks.

use super::solution::mean_square;
use super::{Blocks, Growth, MISSED, Node};
use nalgebra::Vector2;
use rod_contact::State;
use rod_core::PhysicalRod;
use std::ops::Range;

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
        let blocks = Blocks { blocks, segments, recordings: self.fit.blocks.recordings.clone() };
        Window { range, blocks, states }
    }

    /// What a contour makes of a window; after so many steps of its fit, in which nodes at the places `held` stay.
    pub fn tried(&self, chains: &[Vec<Node>], window: &Window, held: &[Vector2<f64>], steps: usize) -> Option<Tried> {
        let (blocks, states) = (&window.blocks, window.states.clone());
        let found = self.solved(chains, held, blocks, states, vec![true; blocks.blocks.len()], steps)?;
        let mean = mean_square(&found.residuals, &blocks.blocks, Some(MISSED));
        let window = Window { states: found.states, ..window.clone() };
        Some(Tried { cost: found.cost, mean, chains: found.chains, window })
    }
}
