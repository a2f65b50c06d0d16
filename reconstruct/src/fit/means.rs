//! The mean reactions of the model over each block of samples.

use super::forward::Forward;
use super::problem::{BRANCH, Fit, Model};
use crate::point::Clamp;
use nalgebra::Vector3;
use rod_contact::{Contact, State};
use rod_core::PhysicalRod;

impl<R: PhysicalRod> Fit<'_, R> {
    /// The mean reactions of each block, dimensionless: those at its mean pose, to second order in its way, and the mean of states along it where contacts
    /// change. At a state on another branch than the rod, a mean of its neighbours tells nothing: there it is the state's own.
    pub fn means(&self, model: &Model) -> Vec<Vector3<f64>> {
        let Model { curve, objects, states, corrected, .. } = model;
        let (forward, units) = (Forward { rod: self.rod, curve, objects }, self.rod.units());
        let at: Vec<Vector3<f64>> = (0..states.len()).map(|k| self.reactions(k, model)).collect();
        let blocks = &self.blocks.blocks;
        let mean = |k: usize| {
            let (block, segment) = (&blocks[k], self.blocks.segment_of(k));
            // a block of one sample is at its place
            let Some(state) = states[k].as_ref().filter(|_| block.half != Vector3::zeros()) else { return at[k] };
            let beside = |j: usize| Some((j, states.get(j).filter(|_| segment.contains(&j))?.as_ref()?));
            let neighbours = [k.checked_sub(1).and_then(beside), beside(k + 1)];
            if neighbours.into_iter().flatten().all(|(_, other)| is_alike(state, other)) {
                let [Some(before), Some(after)] = neighbours.map(|one| one.map(|(j, _)| j)) else { return at[k] };
                let three = [before, k, after];
                let more = curved(three.map(|i| blocks[i].tau), three.map(|i| at[i]), block.half.norm());
                return at[k] + more;
            }
            if corrected[k].residual(&at[k], &model.by_pose[k], block).norm() > BRANCH {
                return at[k];
            }
            let half = [block.half.x * units.length, block.half.y * units.length, block.half.z];
            let mean = forward.mean_reactions(state, corrected[k].friction, half);
            Clamp::new(units, state.pose, mean).reactions + model.bend(k, units)
        };
        (0..states.len()).map(mean).collect()
    }
}

/// Whether two states have their contacts on the same pieces of the contour.
fn is_alike(one: &State, other: &State) -> bool {
    let place = |contact: &Contact| (contact.object, contact.piece, contact.kind);
    one.contacts.iter().map(place).eq(other.contacts.iter().map(place))
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
