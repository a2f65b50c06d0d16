//! Whether the sweep can go on with a contact set: whether it still holds a little further along the path.

use crate::contact_set::{Configuration, Unknown};
use crate::continuation::Point;
use crate::continuation::branch::Condition;
use crate::continuation::stepper::Stepper;
use crate::continuation::transition::breaks;
use crate::friction::reversed_slips;
use crate::limits::LIMITS;
use rod_core::PhysicalRod;

impl<R: PhysicalRod> Stepper<'_, R> {
    /// Whether the sweep can go on with a new contact set.
    pub fn goes_on(&mut self, point: &Point) -> bool {
        self.longest_probe(point, &LIMITS.probe.ways).is_some()
    }

    /// The same with friction: the number of the longest probe along the path on which it holds.
    pub fn longest_rubbing_probe(&mut self, point: &Point) -> Option<usize> {
        self.longest_probe(point, &LIMITS.probe.rubbing_ways)
    }

    /// The number of the first of these ways, which become shorter, after which the contact set still holds. The next transition may follow
    /// closely, but not at once.
    fn longest_probe(&mut self, point: &Point, ways: &[f64]) -> Option<usize> {
        let leads_on = point.tangent.by_tau() > 0.0 && !runs_off(point);
        leads_on.then(|| ways.iter().position(|way| self.holds_after(point, *way))).flatten()
    }

    /// Whether the contact set of a point still holds `way` further along the path.
    fn holds_after(&mut self, point: &Point, way: f64) -> bool {
        let Point { configuration, tangent, .. } = point;
        // where the pose hardly moves, a small step of the branch is small enough
        let distance = (way / tangent.by_tau()).min(LIMITS.probe.longest);
        let mut probe = tangent.ahead(configuration, distance);
        let plane = Condition::Plane { tangent, from: &configuration.z, distance };
        if !self.corrector.correct(&mut probe, plane).status.is_solved() {
            return false;
        }
        let scan = self.scan(&probe);
        let mut holds = true;
        breaks(&self.corrector.setup.world, &probe, &scan.crossings, |_| holds = false);
        if probe.rubs() {
            let there = self.corrector.inspect(&probe, plane).0;
            holds &= reversed_slips(&self.corrector.setup.world, &probe, &there).next().is_none();
        }
        holds && self.is_stable(&probe, &scan)
    }

    /// The stable equilibrium a little way along the tangent of a point at a fold, if the pose grows on that way.
    pub fn beyond_fold(&mut self, Point { configuration, tangent, .. }: &Point) -> Option<Configuration> {
        let mut probe = tangent.ahead(configuration, LIMITS.probe.longest);
        let plane = Condition::Plane { tangent, from: &configuration.z, distance: LIMITS.probe.longest };
        let solved = self.corrector.correct(&mut probe, plane).status.is_solved();
        if !solved || probe.tau() <= configuration.tau() {
            return None;
        }
        let scan = self.scan(&probe);
        self.is_stable(&probe, &scan).then_some(probe)
    }
}

/// Whether the last contact, which is at s = 1, is about to leave the rod.
fn runs_off(Point { configuration, tangent, .. }: &Point) -> bool {
    configuration.count().checked_sub(1).is_some_and(|j| {
        !configuration.is_tip(j)
            && configuration.s(j) > 1.0 - LIMITS.transition.at_once
            && tangent.rate_of(Unknown::ArcLength(j)) > 0.0
    })
}
