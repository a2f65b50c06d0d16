//! A silent sweep: it brings an equilibrium to another pose and reports nothing on the way.

use super::Sweep;
use crate::contact_set::Configuration;
use crate::continuation::Seen;
use crate::continuation::stepper::Stepper;
use crate::limits::LIMITS;
use crate::path::ClampPath;
use crate::scene::setup::Setup;
use crate::snap::settle::settle;
use rod_core::PhysicalRod;

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The equilibrium at `end` of the path of `setup`, swept to from `start`, an equilibrium on this path. A `start` without contacts is the free
    /// rod.
    pub(super) fn lead_to(&mut self, setup: Setup<'_, R>, start: Configuration, end: f64) -> Option<Configuration> {
        let mut silent = Sweep::from_setup(setup, self.stepper.steps_left, f64::INFINITY, 0);
        silent.is_silent = true;
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

    /// An equilibrium without friction, found further along the path, swept back to `tau`. None where the sweep does not arrive there.
    pub(super) fn bring_back(&mut self, ahead: &Configuration, tau: f64) -> Option<Seen> {
        let path = &self.setup().path;
        let way = ClampPath::between(path.at(ahead.tau()), path.at(tau))?;
        let (mut start, end) = (ahead.clone(), way.length());
        start.set_tau(0.0);
        let setup = self.setup().along(way).without_friction();
        let mut there = self.lead_to(setup, start, end).filter(|there| there.tau() <= end + LIMITS.sweep.at_end)?;
        there.set_tau(tau);
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        settle(corrector, scanner, there)
    }
}
