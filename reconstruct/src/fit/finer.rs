//! More points of a contour, where its recording asks for them.

use super::curve::Curve;
use crate::numeric::chi_squared::upper_tail;
use nalgebra::Vector3;
use rod_contact::State;
use std::collections::{BTreeMap, BTreeSet};

/// Probability of the residuals of the blocks that touch an interval below which it is cut in two, and the shortest one that is (rod lengths). Larger,
/// and shorter: nodes for noise.
const ASKS: f64 = 1e-3;
const SHORTEST: f64 = 2e-3;
/// Radius (rod lengths) and angle (radians) of a bend from which on, smaller and larger, it becomes a vertex.
const SHARP: f64 = 6e-3;
const VERTEX_TURN: f64 = 0.4;

/// A contour, for a rod of this length, with more nodes where the recording asks for them; none where it asks for none. `seen` are the states of blocks with
/// their residuals, and whether they are where the recording is explained worst.
pub(super) fn finer<'a>(
    curve: &Curve,
    seen: impl Iterator<Item = (&'a State, Vector3<f64>, bool)>,
    length: f64,
) -> Option<Curve> {
    let mut asking: BTreeMap<usize, Asking> = BTreeMap::new();
    for (state, residual, is_worst) in seen {
        for (interval, share) in state.contacts.iter().filter_map(|contact| curve.interval(contact)) {
            asking.entry(interval).or_default().add(share, residual.norm_squared(), is_worst);
        }
    }
    let turns = curve.turns();
    let asks = |interval: &usize| asking.get(interval).is_some_and(Asking::is_unlikely);
    let is_cut = |(interval, long, _): &&(usize, f64, f64)| *long > 2.0 * SHORTEST * length && asks(interval);
    let at = |(interval, long, _): &(usize, f64, f64)| (*interval, asking[interval].cut(SHORTEST * length / long));
    let cut: BTreeMap<usize, f64> = turns.iter().filter(is_cut).map(at).collect();
    let sharp = turns.windows(2).filter(|pair| {
        let (turn, long) = (0.5 * (pair[0].2 + pair[1].2), 0.5 * (pair[0].1 + pair[1].1));
        pair[1].0 == pair[0].0 + 1
            && turn > VERTEX_TURN
            && long < SHARP * length * turn
            && (asks(&pair[0].0) || asks(&pair[1].0))
    });
    let sharp: BTreeSet<usize> = sharp.map(|pair| pair[1].0).collect();
    if cut.is_empty() && sharp.is_empty() {
        return None;
    }
    curve.refined(&cut, &sharp)
}

/// An interval of a contour, as the blocks see it that touch it.
struct Asking {
    /// Sum of the squares of their residuals, and number of these.
    sum: f64,
    count: f64,
    /// The part of the interval that they touch.
    touched: [f64; 2],
    /// Whether they are where the recording is explained worst: a long interval may hide that.
    is_worst: bool,
}

impl Default for Asking {
    fn default() -> Self {
        Self { sum: 0.0, count: 0.0, touched: [1.0, 0.0], is_worst: false }
    }
}

impl Asking {
    fn add(&mut self, share: f64, squares: f64, is_worst: bool) {
        (self.sum, self.count) = (self.sum + squares, self.count + 3.0);
        self.is_worst |= is_worst;
        self.touched = [self.touched[0].min(share), self.touched[1].max(share)];
    }

    fn is_unlikely(&self) -> bool {
        self.is_worst || upper_tail(self.sum, self.count) < ASKS
    }

    /// Where a node parts the touched half of it from the rest; in the middle, if both are touched. No part is smaller than `least`.
    fn cut(&self, least: f64) -> f64 {
        let [from, to] = self.touched;
        let share = if to < 0.5 {
            to
        } else if from > 0.5 {
            from
        } else {
            0.5
        };
        share.clamp(least, 1.0 - least)
    }
}
