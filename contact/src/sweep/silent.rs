//! A sweep in silence: it brings an equilibrium to another pose and hands out nothing on the way.

use super::{AT_END, Sweep};
use crate::contact_set::Configuration;
use crate::continuation::step::Seen;
use crate::path::ClampPath;
use rod_core::{PhysicalRod, Pose};

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The equilibrium that the rod comes to at `end` of another way of the clamp, from one on it. A `start` without contacts
    /// is the rod free there.
    pub(super) fn led(&mut self, way: ClampPath, start: Configuration, end: f64) -> Option<Configuration> {
        let mut silent = Self::from_setup(self.setup().along(way), self.stepper.steps_left, f64::INFINITY, 0);
        let mut point = Box::new(silent.at_rest(start));
        let led = loop {
            if point.configuration.tau() >= end {
                break Some(point.configuration);
            }
            match silent.stepper.step(&point, end).and_then(|step| silent.arrive(step)) {
                Ok(next) => point = next,
                Err(_) => break None,
            }
            silent.pending.clear();
        };
        self.stepper.steps_left = silent.stepper.steps_left;
        led
    }

    /// A rod that has landed further on than the leg goes, at the end of the leg: the clamp goes back there. None where it does not
    /// come to it.
    pub(super) fn back_to_end(&mut self, landed: &Configuration) -> Option<Seen> {
        let path = &self.setup().path;
        let (beyond, end) = (landed.tau(), path.length());
        let Pose { x, y, phi } = path.rate(end);
        // beyond its end a path is straight
        let back = ClampPath::along(path.at(beyond), Pose { x: -x, y: -y, phi: -phi });
        let mut start = landed.clone();
        start.set_tau(0.0);
        let way = beyond - end;
        let mut there = self.led(back, start, way).filter(|there| there.tau() <= way + AT_END)?;
        there.set_tau(end);
        let seen = self.stepper.look(there);
        seen.scan.is_outside().then_some(seen)
    }
}
