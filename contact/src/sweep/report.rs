//! The reports of a sweep: states at the poses to report, events and the reason of a stop.

use super::{Item, Stage, Sweep};
use crate::continuation::Point;
use crate::continuation::certify::{Quality, state};
use crate::error::{Stop, StopReason};
use crate::event::{Event, EventKind};
use crate::limits::LIMITS;
use crate::scene::Setup;
use crate::state::State;
use rod_core::{PhysicalRod, Pose};

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The next pose to report.
    pub(super) fn pose(&self) -> f64 {
        self.course.next_pose(self.setup().path.length())
    }

    /// Distance (path parameter) beyond the next pose to report that is rounding.
    pub(super) fn slack(&self) -> f64 {
        if self.pose() < self.setup().path.length() { LIMITS.step.same_pose } else { LIMITS.sweep.at_end }
    }

    pub(super) fn report(&mut self, point: &Point) {
        self.hand_out(point.configuration.tau(), self.state(point));
    }

    /// The state at a pose to report.
    pub(super) fn hand_out(&mut self, tau: f64, state: State) {
        self.reached = self.reached.max(tau);
        self.pending.push_back(Item::State(State { leg: self.course.leg, ..state }));
        self.course.pass();
    }

    /// Hands out an event. What the rod loses in it, its jump at a pose included, is dissipated.
    pub(super) fn announce(&mut self, kind: EventKind, before: &Point, after: &Point) {
        let [before, after] = [before, after].map(|point| self.state(point));
        if before.pose == after.pose {
            let lost = (before.energy - after.energy).max(0.0) / self.setup().rod.units().energy;
            self.dissipated = self.dissipated.map(|work| work + lost);
        }
        let dissipated = self.dissipated();
        self.pending.push_back(Item::Event(Event { kind, before, after, dissipated }));
    }

    pub(super) fn state(&self, point: &Point) -> State {
        let free = point.configuration.count() == 0;
        let quality = if free { Quality::FREE } else { point.quality };
        State { leg: self.course.leg, ..state(self.setup(), &point.configuration, &point.scan, quality) }
    }

    /// How far along the path the sweep has come.
    pub(super) fn reached_tau(&self) -> f64 {
        let at = match &self.stage {
            Stage::At(point, _) | Stage::Over(Some(point)) => point.configuration.tau(),
            Stage::Begins(_) | Stage::Over(None) => 0.0,
        };
        at.max(self.reached)
    }

    pub(super) fn stop(&self, reason: StopReason) -> Stop {
        let Setup { rod, path, .. } = self.setup();
        let tau = self.reached_tau();
        let length = rod.units().length;
        let Pose { x, y, phi } = path.at(tau);
        let passed = self.course.before + path.parameter(tau, length);
        Stop { pose: Pose { x: x * length, y: y * length, phi }, tau: passed, reason }
    }
}
