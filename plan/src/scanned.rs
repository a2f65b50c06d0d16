//! What comes of one scan.

use crate::touched::{Touched, Trail};
use crate::{Outline, PlanError};
use rod_contact::{Chain, Event, EventKind, Item, Path, State, Stop, Sweep};
use rod_contours::Composite;
use rod_core::PhysicalRod;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Distance of the states of a sweep, rod lengths. Smaller: slower; the ends of what is touched are exact all the same.
pub(crate) const STEP: f64 = 0.01;

/// What comes of one scan without friction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scanned {
    /// What it touches of each object.
    pub touched: Touched,
    /// Jumps of the rod to another equilibrium in contact.
    pub snaps: usize,
    /// Largest bending stress at the surface of the rod over the states, Pa; none where its diameter is not known.
    pub largest_stress: Option<f64>,
    /// Largest moment at the clamp over the states, N m.
    pub largest_moment: f64,
    /// Largest force at the clamp over the states, N.
    pub largest_force: f64,
    /// Why the sweep stopped early, if it did: what it would touch after that is not known.
    pub stop: Option<Stop>,
}

/// How a scan is computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Computation {
    /// Distance of the states, m.
    pub step: f64,
    /// Steps of the sweep after which it is given up; none for those that a sweep may have.
    pub most_steps: Option<u64>,
    /// Stress (Pa) beyond which the rest of the scan is of no interest.
    pub most_stress: Option<f64>,
}

/// How many scans are done, and whether to go on.
pub(crate) struct Progress<'a> {
    goes_on: &'a (dyn Fn(usize) -> bool + Sync),
    done: AtomicUsize,
    is_ended: AtomicBool,
}

impl<'a> Progress<'a> {
    /// `goes_on` hears how many scans are done. From its first false on the work ends.
    pub fn new(goes_on: &'a (dyn Fn(usize) -> bool + Sync)) -> Self {
        Self { goes_on, done: AtomicUsize::new(0), is_ended: AtomicBool::new(false) }
    }

    /// Whether to go on within a scan.
    fn goes_on(&self) -> bool {
        self.ask(self.done.load(Ordering::Relaxed))
    }

    /// A scan is done; whether to go on, and the scan is complete.
    pub fn count(&self) -> bool {
        self.ask(self.done.fetch_add(1, Ordering::Relaxed) + 1)
    }

    fn ask(&self, done: usize) -> bool {
        if !(self.goes_on)(done) {
            self.is_ended.store(true, Ordering::Relaxed);
        }
        !self.is_ended.load(Ordering::Relaxed)
    }
}

impl Scanned {
    /// A scan along a path, and its states at equal distances. Ended early, it is of no use.
    pub(crate) fn of<R: PhysicalRod>(
        rod: &R,
        objects: &[Composite],
        outlines: &[Outline],
        path: &Arc<dyn Path>,
        Computation { step, most_steps, most_stress }: Computation,
        progress: &Progress<'_>,
    ) -> Result<(Self, Vec<State>), PlanError> {
        let (mut found, mut trail, mut states) = (Self::default(), Trail::default(), Vec::new());
        let mut sweep = Sweep::new(rod, objects, Chain::new(vec![path.clone()])?, step)?;
        if let Some(most) = most_steps {
            sweep = sweep.with_most_steps(most);
        }
        for item in sweep {
            match item {
                Ok(Item::State(state)) => {
                    found.load(&state);
                    states.push(state.clone());
                    trail.state(state);
                }
                Ok(Item::Event(event)) => {
                    found.pass(&event);
                    trail.event(event);
                }
                Err(stop) => found.stop = Some(stop),
            }
            if found.is_beyond(most_stress) || !progress.goes_on() {
                break;
            }
        }
        found.touched = Touched::of(&trail, rod, objects, outlines);
        Ok((found, states))
    }

    /// Whether the rod is bent further than by a stress (Pa).
    pub(crate) fn is_beyond(&self, stress: Option<f64>) -> bool {
        self.largest_stress.zip(stress).is_some_and(|(largest, most)| largest > most)
    }

    fn pass(&mut self, event: &Event) {
        self.snaps += usize::from(event.kind == EventKind::Snap);
        self.load(&event.before);
        self.load(&event.after);
    }

    fn load(&mut self, state: &State) {
        self.largest_moment = self.largest_moment.max(state.reactions.m0z.abs());
        self.largest_force = self.largest_force.max(state.reactions.f0x.hypot(state.reactions.f0y));
        self.largest_stress = match (self.largest_stress, state.max_stress) {
            (Some(one), Some(other)) => Some(one.max(other)),
            (one, other) => one.or(other),
        };
    }
}
