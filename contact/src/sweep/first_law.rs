//! The first law at a pose: the clamp does no work and friction dissipates, so that no transition gains energy.

use super::Sweep;
use crate::contact_set::Configuration;
use crate::continuation::certify::energy;
use crate::continuation::{Point, Seen};
use crate::limits::LIMITS;
use crate::scene::rod::Segment;
use rod_core::PhysicalRod;

/// An equilibrium that has ended, and its energy (J).
pub(super) struct EndedBranch {
    pub seen: Seen,
    pub energy: f64,
}

impl<R: PhysicalRod> Sweep<'_, R> {
    pub(super) fn end_with_energy(&self, seen: Seen) -> EndedBranch {
        let energy = energy(self.setup(), &seen.configuration);
        EndedBranch { seen, energy }
    }

    /// The same with the energy that is available further on: that of `last` plus the largest work of the clamp on its way to `ahead`, if its
    /// reactions on the way are between those at both ends.
    pub(super) fn end_with_clamp_work(&self, last: &EndedBranch, ahead: &Configuration) -> EndedBranch {
        let (setup, from) = (self.setup(), &last.seen.configuration);
        let [a, b] = [from.tau(), ahead.tau()].map(|tau| setup.path.at(tau));
        let work = [from, ahead].map(|configuration| {
            let Segment { start, a: along, b: across, .. } = configuration.segments(setup)[0];
            // f0x = -B, f0y = A, m0z = -M
            across * (a.x - b.x) + along * (b.y - a.y) + start.moment * (a.phi - b.phi)
        });
        let most = work[0].max(work[1]).max(0.0) * setup.rod.units().energy;
        EndedBranch { seen: last.seen.clone(), energy: last.energy + most }
    }

    /// Whether a rod with the energy `before` (J) may come to another equilibrium by itself: the energy of rod and clamp only falls.
    pub(super) fn may_fall(&self, before: f64, after: &Configuration) -> bool {
        let unit = self.setup().rod.units().energy;
        energy(self.setup(), after) <= before + LIMITS.snap.energy_rounding * (unit + before)
    }

    /// A point, if a rod with this energy may come to it.
    pub(super) fn if_energy_falls(&self, before: f64, point: Option<Point>) -> Option<Point> {
        point.filter(|point| self.may_fall(before, &point.configuration))
    }
}
