//! A scene that was swept.

use crate::interval::{self, Interval};
use crate::{Cycle, Error, Scene};
use vibrissa::Outcome;

/// A scene and all its states and events.
#[derive(Debug)]
pub struct Scan {
    /// What was asked.
    pub scene: Scene,
    /// What came out.
    pub outcome: Outcome,
}

impl Scan {
    /// Sweeps the scene to its end, or to where the sweep must stop.
    ///
    /// # Errors
    /// [`Error::Contact`] where the scene's step is no step.
    pub fn run(scene: Scene) -> Result<Self, Error> {
        let outcome = scene.sweep()?.run();
        Ok(Self { scene, outcome })
    }

    /// The phases in order.
    pub fn cycle(&self) -> Cycle {
        Cycle::of(&self.outcome)
    }

    /// The parts of the scan between transitions.
    pub fn intervals(&self) -> Vec<Interval<'_>> {
        interval::intervals(&self.scene.path, &self.outcome)
    }
}
