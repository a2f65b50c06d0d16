//! A contact set with its unknowns at a pose: one point on a branch of equilibria.

pub(crate) mod edit;
pub(crate) mod notch;
pub(crate) mod order;

use crate::path::ClampPath;
use crate::scene::world::World;
use crate::state::ContactKind;
use rod_contours::StretchKind;
use rod_core::{Hold, MultiPoint, Section, Support, Supports};
use smallvec::SmallVec;
use std::f64::consts::PI;

/// Forces down to minus this (E I / L^2) count as zero: a hundred times what a solve leaves of a force that vanishes.
pub(crate) const FORCE_TOLERANCE: f64 = 1e-12;

/// Where a contact is (a stretch of the contour) and how it holds the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Held {
    pub stretch: usize,
    pub hold: Hold,
}

/// Unknowns of the boundary-value problem, three a contact, and the path parameter behind them.
pub(crate) type Unknowns = SmallVec<[f64; 25]>;

/// Contacts from the clamp to the tip, and z = (t_1, f_1, s_1, ..., tau), where the last third of a tip contact is the
/// slope angle instead of the arc length.
#[derive(Clone, Debug)]
pub(crate) struct Configuration {
    pub contacts: SmallVec<[Held; 8]>,
    pub z: Unknowns,
}

impl Configuration {
    pub fn free(tau: f64) -> Self {
        Self { contacts: SmallVec::new(), z: SmallVec::from_slice(&[tau]) }
    }

    pub fn count(&self) -> usize {
        self.contacts.len()
    }

    pub fn tau(&self) -> f64 {
        self.z[3 * self.count()]
    }

    pub fn set_tau(&mut self, tau: f64) {
        let last = 3 * self.count();
        self.z[last] = tau;
    }

    pub fn t(&self, j: usize) -> f64 {
        self.z[3 * j]
    }

    pub fn force(&self, j: usize) -> f64 {
        self.z[3 * j + 1]
    }

    pub fn is_tip(&self, j: usize) -> bool {
        self.contacts[j].hold == Hold::Tip
    }

    /// Whether the last contact is at the tip.
    pub fn ends_at_tip(&self) -> bool {
        self.contacts.last().is_some_and(|c| c.hold == Hold::Tip)
    }

    pub fn s(&self, j: usize) -> f64 {
        if self.is_tip(j) { 1.0 } else { self.z[3 * j + 2] }
    }

    pub fn insert(&mut self, j: usize, held: Held, unknowns: [f64; 3]) {
        self.contacts.insert(j, held);
        self.z.insert_from_slice(3 * j, &unknowns);
    }

    pub fn remove(&mut self, j: usize) {
        self.contacts.remove(j);
        self.z.drain(3 * j..3 * j + 3);
    }

    /// The contacts as supports of the rod.
    pub fn supports<'a>(&'a self, world: &'a World<'a>) -> Holding<'a> {
        Holding { world, contacts: &self.contacts }
    }

    /// Visits the rod's segments: arc length and section at the start, force (A, B).
    pub fn segments(&self, world: &World<'_>, path: &ClampPath, visit: impl FnMut(f64, Section, f64, f64)) {
        let supports = self.supports(world);
        MultiPoint { clamp: path.at(self.tau()), supports: &supports }.segments(&self.z[..3 * self.count()], visit);
    }

    /// The rod's segments from the clamp to the tip; the last one is free.
    pub fn spans(&self, world: &World<'_>, path: &ClampPath) -> Spans {
        let mut spans = Spans::new();
        self.segments(world, path, |s, start, a, b| spans.push(Span { s, start, a, b }));
        spans
    }

    pub fn kind(&self, world: &World<'_>, j: usize) -> ContactKind {
        let Held { stretch, hold } = self.contacts[j];
        match (world.kind(stretch), hold) {
            (StretchKind::Notch { .. }, _) => ContactKind::Notch,
            (_, Hold::Tip) => ContactKind::Tip,
            (StretchKind::Corner { .. }, _) => ContactKind::Corner,
            _ => ContactKind::Tangent,
        }
    }
}

/// A segment of the rod: arc length and section where it starts, force (A, B) along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub s: f64,
    pub start: Section,
    pub a: f64,
    pub b: f64,
}

/// The segments of a rod.
pub(crate) type Spans = SmallVec<[Span; 9]>;

/// The hold of a rod that lies on a contour, from its slope angle less the contour's, about a multiple of pi.
pub(crate) fn lying(angle: f64) -> Hold {
    Hold::Tangent { offset: PI * (angle / PI).round() }
}

/// Contacts as the rod's supports.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Holding<'a> {
    pub world: &'a World<'a>,
    pub contacts: &'a [Held],
}

impl Supports for Holding<'_> {
    fn count(&self) -> usize {
        self.contacts.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.contacts[j].hold
    }
    fn support(&self, j: usize, t: f64) -> Support {
        self.world.support(self.contacts[j].stretch, t)
    }
}
