//! The answers to the samples of a scan whose phases are known.

use super::reading::{Reading, Reason, sure};
use super::settings::Settings;
use crate::kink::Kink;
use crate::phase::{Break, Label, PlaceNumber, ScanPhases, contact};
use crate::point::{Inverse, Touch};
use crate::scan::{Noise, Track, TrackIndex};
use crate::systematic::RemainingErrors;
use nalgebra::Matrix2;
use rod_core::Units;

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

/// Standard deviations by which a criterion may contradict the phase of a single contact: as many as a contact point may be off.
const CONTRADICTED: f64 = 6.0;

/// What the answers to the samples of a scan are computed from.
pub(super) struct Answers<'a, I> {
    pub rod: &'a I,
    pub track: &'a Track,
    pub kinks: &'a [Kink],
    pub noise: &'a Noise,
    pub phases: &'a ScanPhases,
    pub units: Units,
    pub settings: &'a Settings,
    /// The errors that all samples share, if there are any.
    pub shared: Option<&'a RemainingErrors>,
    /// For each place the covariance that they cause of a single contact point there, dimensionless, if it is known; empty without them.
    pub systematic: &'a [Option<Matrix2<f64>>],
}

impl<I: Inverse> Answers<'_, I> {
    /// The readings of all usable samples, by track index.
    pub fn all(&self, breaks: &[Break]) -> Vec<Reading> {
        let mut readings = Vec::with_capacity(self.track.len());
        let runs = &self.phases.runs;
        let mut next = 0;
        while next < runs.len() {
            if runs[next].1.several() {
                let many = runs[next..].iter().take_while(|run| run.1.several()).count();
                self.several(next..next + many, breaks, &mut readings);
                next += many;
            } else {
                let (range, label) = runs[next].clone();
                let mut nearest = NearestPlace::new(self.phases, label, range.start);
                readings.extend(range.map(|index| self.single(&mut nearest, TrackIndex(index), label)));
                next += 1;
            }
        }
        readings
    }

    /// The reading of a sample, with the probability of the nearest place of its label.
    pub(super) fn reading(
        &self,
        nearest: &mut NearestPlace<'_>,
        index: TrackIndex,
        label: Label,
        touch: Result<Touch, Reason>,
    ) -> Reading {
        let place = nearest.of(index);
        let probability = match self.phases.labels[place.0] {
            (found, probability) if found == label => probability,
            _ => 0.0,
        };
        Reading { label, probability, touch, second: None, place }
    }

    /// The answer to a sample with one contact or none.
    fn single(&self, nearest: &mut NearestPlace<'_>, index: TrackIndex, label: Label) -> Reading {
        let number = nearest.of(index);
        let place = &self.phases.places[number.0];
        if let Some((criterion, z)) = place.evidence.against(label).filter(|(_, z)| *z > CONTRADICTED) {
            return self.reading(nearest, index, label, Err(Reason::Contradicted { criterion, z }));
        }
        if label == Label::Free {
            return self.reading(nearest, index, label, Err(Reason::Free));
        }
        let (fit, TrackIndex(at)) = (&place.fit, index);
        let touch = contact(self.rod, &self.track.clamps[at], self.track.tau[at], fit, self.noise, label);
        let systematic = match self.systematic.get(number.0) {
            Some(None) => return self.reading(nearest, index, label, Err(Reason::Unshared)),
            Some(Some(found)) => *found,
            None => Matrix2::zeros(),
        };
        let touch = touch.map_err(Reason::NoContact).and_then(|touch| self.sure(touch.with_systematic(systematic)));
        self.reading(nearest, index, label, touch)
    }

    /// The point in SI units, if it is known well enough.
    pub(super) fn sure(&self, touch: Touch) -> Result<Touch, Reason> {
        sure(touch, self.units, self.settings.largest_sigma, self.noise.is_clean())
    }
}
