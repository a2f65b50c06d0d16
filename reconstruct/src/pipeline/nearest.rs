//! The place with a label that is nearest to a sample.

use crate::phase::{Label, PlaceNumber, ScanPhases};
use crate::scan::TrackIndex;

/// Finds the nearest place with a label, for samples in order.
pub(super) struct NearestPlace<'a> {
    phases: &'a ScanPhases,
    label: Label,
    at: usize,
}

impl<'a> NearestPlace<'a> {
    /// For samples from the track index `start` on.
    pub fn new(phases: &'a ScanPhases, label: Label, start: usize) -> Self {
        let places = &phases.places;
        let at = places.partition_point(|place| place.index < start).min(places.len().saturating_sub(1));
        Self { phases, label, at }
    }

    /// The place that is nearest to a sample.
    pub fn of(&mut self, TrackIndex(index): TrackIndex) -> PlaceNumber {
        let (places, labels) = (&self.phases.places, &self.phases.labels);
        let off = |at: usize| (labels[at].0 != self.label, places[at].index.abs_diff(index));
        // places of other labels may lie between: go on to the sample
        let mut look = self.at;
        while look + 1 < places.len() && places[look].index <= index {
            look += 1;
            if off(look) < off(self.at) {
                self.at = look;
            }
        }
        PlaceNumber(self.at)
    }
}
