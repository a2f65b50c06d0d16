//! The mean reactions of the model over each block of samples.

use super::forward::Forward;
use super::problem::{Fit, Model};
use crate::point::Clamp;
use nalgebra::Vector3;
use rod_contact::{Contact, State};
use rod_core::PhysicalRod;

impl<R: PhysicalRod> Fit<'_, R> {
    /// The mean reactions of each block, dimensionless: those at its mean pose, to second order in its way, and the mean of states along it where contacts
    /// change. None where the rod jumps inside it.
    pub fn means(&self, model: &Model) -> Vec<Option<Vector3<f64>>> {
        let Model { curve, objects, states, corrected, .. } = model;
        let (forward, units) = (Forward { rod: self.rod, curve, objects }, self.rod.units());
        let at: Vec<Vector3<f64>> = (0..states.len()).map(|k| self.reactions(k, model)).collect();
        let blocks = &self.blocks.blocks;
        let mean =
            |k: usize| {
                let Some(state) = &states[k] else { return Some(at[k]) };
                let half = blocks[k].half;
                if changes_inside(states, k) {
                    let half = [half.x * units.length, half.y * units.length, half.z];
                    let mean = forward.mean_reactions(state, corrected[k].friction, half)?;
                    return Some(Clamp::new(units, state.pose, mean).reactions + model.bend(k, units));
                }
                let segment = self.blocks.segment_of(k);
                let has_neighbours =
                    k > segment.start && k + 1 < segment.end && states[k - 1].is_some() && states[k + 1].is_some();
                let beside = has_neighbours.then(|| [k - 1, k, k + 1]);
                Some(beside.map_or(at[k], |three| {
                    at[k] + curved(three.map(|i| blocks[i].tau), three.map(|i| at[i]), half.norm())
                }))
            };
        (0..states.len()).map(mean).collect()
    }
}

/// Whether the contacts of a block, or the pieces of the contour on which they are, are not those of its neighbours: they change inside it.
fn changes_inside(states: &[Option<State>], block: usize) -> bool {
    let place = |contact: &Contact| (contact.object, contact.piece, contact.kind);
    let neighbours = [block.checked_sub(1), Some(block + 1)];
    let mut others = neighbours.into_iter().flatten().filter_map(|k| states.get(k)?.as_ref());
    states[block]
        .as_ref()
        .is_some_and(|state| others.any(|other| other.contacts.iter().map(place).ne(state.contacts.iter().map(place))))
}

/// The mean over `half` on either side of the second place, less the value there, of the parabola through the values at three places.
fn curved([before, at, after]: [f64; 3], values: [Vector3<f64>; 3], half: f64) -> Vector3<f64> {
    let slopes = [(values[1] - values[0]) / (at - before), (values[2] - values[1]) / (after - at)];
    (slopes[1] - slopes[0]) / (after - before) * (half * half / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_a_parabola_is_exact() {
        let of = |t: f64| Vector3::new(3.0 * t * t - t, 2.0 * t + 1.0, -t * t);
        // the integrals from 0.5 to 1.5 less the values at 1
        let found = curved([-0.2, 1.0, 2.5], [-0.2, 1.0, 2.5].map(of), 0.5);
        assert!((found - Vector3::new(0.25, 0.0, -1.0 / 12.0)).amax() < 1e-15, "{found}");
    }
}
