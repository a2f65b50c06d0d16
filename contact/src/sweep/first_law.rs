//! The first law at a pose: the clamp does no work there and friction only takes energy, so that no transition gains any.

use super::Sweep;
use crate::contact_set::Configuration;
use crate::continuation::certify::energy;
use crate::continuation::step::{Point, Seen};
use rod_core::PhysicalRod;

/// Gain of energy (E I / L), relative to 1 + the energy, that is rounding. Energies of two solutions at one pose agree to 1e-13.
const ROUNDING: f64 = 1e-11;

/// An equilibrium that has ended, and its energy (J).
pub(super) struct Ended {
    pub seen: Seen,
    pub energy: f64,
}

impl<R: PhysicalRod> Sweep<'_, R> {
    pub(super) fn ended(&self, seen: Seen) -> Ended {
        let energy = energy(self.setup(), &seen.configuration);
        Ended { seen, energy }
    }

    /// Whether a rod with this energy (J) may come to another equilibrium by itself: energy of rod and clamp only falls.
    pub(super) fn may_fall(&self, before: f64, after: &Configuration) -> bool {
        let unit = self.setup().rod.units().energy;
        energy(self.setup(), after) <= before + ROUNDING * (unit + before)
    }

    /// A point, if a rod with this energy may come to it.
    pub(super) fn fallen(&self, before: f64, point: Option<Point>) -> Option<Point> {
        point.filter(|point| self.may_fall(before, &point.configuration))
    }
}
