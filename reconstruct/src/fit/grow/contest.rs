//! The best of several contours.

use super::window::{Tried, Window};
use super::{GOOD, Grown, Growth, Node};
use nalgebra::Vector2;
use rod_core::PhysicalRod;
use std::ops::Range;

/// How many of the contours that were tried are fitted, with at most so many steps.
const FITTED: usize = 16;
const STEPS: usize = 20;

/// A contour, and what it costs in a window.
pub(super) type Candidate<'a> = (f64, Vec<Vec<Node>>, &'a Window);

impl<R: PhysicalRod> Growth<'_, '_, R> {
    /// Of some contours that which explains most of the blocks towards the end of their run: each time half of them are fitted to twice as many blocks.
    pub fn best_of(
        &self,
        now: &Grown,
        mut found: Vec<Candidate<'_>>,
        held: &[Vector2<f64>],
        end: usize,
    ) -> Option<Tried> {
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let first =
            found.into_iter().take(FITTED).filter_map(|(_, chains, window)| self.tried(&chains, window, held, STEPS));
        let by_mean = |mut tried: Vec<Tried>, most: usize| {
            tried.retain(|tried| tried.mean < GOOD);
            tried.sort_by(|a, b| a.mean.total_cmp(&b.mean));
            tried.truncate(most);
            tried
        };
        let (mut most, mut left) = (FITTED / 2, by_mean(first.collect(), FITTED));
        loop {
            if left.len() < 2 {
                return left.pop();
            }
            let wider = |at: &Tried| {
                let Range { start, end: stop } = at.window.range;
                let more = 2 * (stop - start);
                let range =
                    if end >= stop { start..end.min(start + more) } else { end.max(stop.saturating_sub(more))..stop };
                if range == at.window.range {
                    return None;
                }
                let mut window = self.window(range.clone());
                for (k, state) in at.window.range.clone().zip(&at.window.states) {
                    window.states[k - range.start].clone_from(state);
                }
                self.tried(&self.with_ends(&now.with(at, &at.window.range)), &window, held, STEPS)
            };
            let next = by_mean(left.iter().filter_map(wider).collect(), most);
            if next.is_empty() {
                return Some(left.swap_remove(0));
            }
            (left, most) = (next, (most / 2).max(1));
        }
    }
}
