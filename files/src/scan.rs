//! A scene that was swept.

use crate::interval::{self, Interval};
use crate::{Cycle, Interrupt, Interrupted, Scene};
use vibrissa::contact::{ContactError, Item, Outcome, Phase};
use vibrissa::{Event, State};

/// A scene and all its states and events.
#[derive(Debug)]
pub struct Scan {
    /// What was asked.
    pub scene: Scene,
    /// What came out.
    pub outcome: Outcome,
    /// Where the sweep was when it was interrupted, if it was.
    pub interrupted: Option<Interrupted>,
}

impl Scan {
    /// Sweeps the scene to its end, or to where the sweep must stop.
    ///
    /// # Errors
    /// [`ContactError`] where the scene's step is no step.
    pub fn run(scene: Scene) -> Result<Self, ContactError> {
        Self::run_until(scene, &Interrupt::default())
    }

    /// The same, but only as far as it has come when it is interrupted. That is looked at between states.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_until(scene: Scene, interrupt: &Interrupt) -> Result<Self, ContactError> {
        let mut outcome = Outcome::default();
        let (mut pose, mut interrupted) = (None, None);
        let mut sweep = scene.sweep()?;
        loop {
            if interrupt.is_raised() {
                interrupted = Some(Interrupted { pose });
                break;
            }
            match sweep.next() {
                Some(Ok(Item::State(state))) => {
                    pose = Some(state.pose);
                    outcome.states.push(state);
                    interrupt.pass(outcome.states.len() as f64 / scene.steps());
                }
                Some(Ok(Item::Event(event))) => {
                    pose = Some(event.pose());
                    outcome.events.push(event);
                }
                Some(Err(stop)) => {
                    outcome.stop = Some(stop);
                    break;
                }
                None => break,
            }
        }
        outcome.start = sweep.start().cloned();
        outcome.dissipated = sweep.dissipated();
        drop(sweep);
        Ok(Self { scene, outcome, interrupted })
    }

    /// Whether the sweep came to the end of the path.
    pub fn is_complete(&self) -> bool {
        self.outcome.stop.is_none() && self.interrupted.is_none()
    }

    /// Whether the sweep ended before its first state.
    pub fn is_empty(&self) -> bool {
        self.outcome.states.is_empty() && self.outcome.events.is_empty()
    }

    /// The phases in order without the free rod before and after.
    pub fn cycle(&self) -> Cycle {
        Cycle::of(&self.outcome)
    }

    /// All phases in order, as in `free A B BB B A free`; those of the Python package.
    pub fn phases(&self) -> String {
        let first = self.outcome.states.first().map(State::phase);
        let mut phases: Vec<Phase> = first.into_iter().chain(self.outcome.events.iter().map(Event::to)).collect();
        phases.dedup();
        phases.iter().map(Phase::to_string).collect::<Vec<_>>().join(" ")
    }

    /// The parts of the scan between transitions.
    pub fn intervals(&self) -> Vec<Interval<'_>> {
        interval::intervals(|state| self.scene.way(state), &self.outcome)
    }

    /// The parts of the scan between all events: along each no contact changes its mode of friction.
    pub fn between_events(&self) -> Vec<Interval<'_>> {
        interval::cut(|state| self.scene.way(state), &self.outcome, |_| true)
    }
}
