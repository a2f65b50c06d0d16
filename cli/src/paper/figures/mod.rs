//! Figures of all scans of the paper.

mod contact_points;
mod criterion;
mod cycles;
mod distances;
mod goodness;
mod notches;
mod transitions;

pub(super) use contact_points::contact_points;
pub(super) use criterion::criterion;
pub(super) use cycles::cycles;
pub(super) use distances::distances;
pub(super) use goodness::goodness;
pub(super) use notches::notches;
pub(super) use transitions::transitions;
