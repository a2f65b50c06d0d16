//! The places of a live scan so far, and what they tell of the errors that all samples share.

use super::learned::Learned;
use crate::numeric::CHANCE;
use crate::phase::{Label, Place, Trellis, forward_probabilities, most_likely};
use crate::scan::Track;
use crate::systematic::{Budget, Calibration, Errors, Known, RemainingErrors, calibrate_labelled, errors_before_scan};
use rod_core::{Rod, Units};

/// Most places that are kept. More: more time and memory.
const MOST: usize = 400;
/// Places after which the errors are estimated for the first time, and fewest new ones after which they are again. Fewer: more time.
const FEWEST: usize = 16;
/// Part by which the places must have grown before the errors are estimated again. Smaller: more time.
const GROWTH: f64 = 0.2;
/// Probability of a label from which on its place counts for the errors. Smaller: wrong labels agree with wrong errors.
const SURE: f64 = 0.99;

/// The places of a live scan so far. Where there are too many, every second one is dropped.
#[derive(Clone, Debug)]
pub(super) struct History {
    rod: Rod,
    budget: Budget,
    known: Known,
    /// The track index of each place is that in `track`, which has one sample for each.
    places: Vec<Place>,
    track: Track,
    /// Numbers of the samples of the places in the scan.
    samples: Vec<usize>,
    /// Every so many places are kept.
    stride: usize,
    seen: usize,
    /// Places so far at which the errors are estimated again.
    due: usize,
    found: Option<Calibration>,
    learned: Option<Learned>,
}

impl History {
    /// Of a scan with these errors; `first` places are waited for.
    pub fn new(rod: &Rod, budget: &Budget, known: &Known, first: usize) -> Self {
        Self {
            rod: *rod,
            budget: *budget,
            known: *known,
            places: Vec::with_capacity(MOST),
            track: Track::default(),
            samples: Vec::with_capacity(MOST),
            stride: 1,
            seen: 0,
            due: first,
            found: None,
            learned: None,
        }
    }

    /// What was found last.
    pub fn calibration(&self) -> Option<&Calibration> {
        self.found.as_ref()
    }

    /// Takes the next place, whose samples are as they were measured.
    pub fn push(&mut self, tau: f64, place: &Place) {
        self.seen += 1;
        if !self.seen.is_multiple_of(self.stride) && place.observation.between.is_none() {
            return;
        }
        if self.places.len() == MOST {
            self.thin();
        }
        let weight = (place.weight * self.stride as f64).min(1.0);
        self.add(tau, place.index, Place { weight, ..place.clone() });
    }

    fn add(&mut self, tau: f64, sample: usize, place: Place) {
        self.track.tau.push(tau);
        self.track.clamps.push(place.fit.at(tau).clamp);
        self.samples.push(sample);
        self.places.push(Place { index: self.places.len(), ..place });
    }

    /// Drops every second place, but none after a break as long as these are few.
    fn thin(&mut self) {
        self.stride *= 2;
        let places = std::mem::take(&mut self.places);
        let (track, samples) = (std::mem::take(&mut self.track), std::mem::take(&mut self.samples));
        let breaks = places.iter().filter(|place| place.observation.between.is_some()).count();
        for (k, place) in places.into_iter().enumerate() {
            if k % 2 == 0 || place.observation.between.is_some() && breaks < MOST / 4 {
                let weight = (2.0 * place.weight).min(1.0);
                self.add(track.tau[k], samples[k], Place { weight, ..place });
            }
        }
    }

    /// What the places tell, when it is time for it, and the log of the probability of each label at the last place before `sample`.
    pub fn learn(&mut self, sample: usize) -> Option<(Learned, [f64; 5])> {
        if self.seen < self.due {
            return None;
        }
        self.due = self.seen + FEWEST.max((GROWTH * self.seen as f64) as usize);
        let mut learned = match self.learned.take() {
            Some(learned) => learned,
            // only the free rod at the begin is known
            None => {
                let (taken, shared) = errors_before_scan(&self.rod, &self.track, &self.budget, &self.known)?;
                let free = vec![(Label::Free, 1.0); self.free()];
                let (taken, shared) = self.estimated(&free).unwrap_or((taken, shared));
                Learned::new(taken, shared, self.units())?
            }
        };
        let mut judged = self.judged(&learned);
        let free = self.free();
        let mut trellis = Trellis::default();
        let chances = trellis.label_probabilities(&[0.0; 5], judged.iter().map(|place| place.observation));
        let label = |(k, chances): (usize, &[f64; 5])| {
            let best = if k < free { Label::Free as usize } else { most_likely(chances) };
            (Label::ALL[best], chances[best])
        };
        let labels: Vec<(Label, f64)> = chances.iter().enumerate().map(label).collect();
        if let Some((taken, shared)) = self.estimated(&labels) {
            learned = Learned::new(taken, shared, self.units())?;
            judged = self.judged(&learned);
        }
        let before = self.samples.partition_point(|other| *other < sample);
        let passed =
            judged[..before].iter().fold([0.0; 5], |before, place| forward_probabilities(&before, &place.observation));
        self.learned = Some(learned.clone());
        Some((learned, passed))
    }

    /// The places with the evidence of what was learned.
    fn judged(&self, learned: &Learned) -> Vec<Place> {
        let mut judged = self.places.clone();
        for (tau, place) in self.track.tau.iter().zip(&mut judged) {
            learned.judge(*tau, place);
        }
        judged
    }

    /// The errors by the first places, those of them whose labels are sure.
    fn estimated(&mut self, labels: &[(Label, f64)]) -> Option<(Errors, RemainingErrors)> {
        let sure = |k: &usize| labels[*k].1 > SURE;
        let (places, labels): (Vec<Place>, Vec<(Label, f64)>) =
            (0..labels.len()).filter(sure).map(|k| (self.places[k].clone(), labels[k])).unzip();
        let (taken, shared, found) =
            calibrate_labelled(&self.rod, &self.track, &places, &labels, &self.budget, &self.known)?;
        self.found = Some(found);
        Some((taken, shared))
    }

    /// The units of the rod as it was found.
    fn units(&self) -> Units {
        self.found.as_ref().map_or(self.rod, |found| found.rod(&self.rod)).units()
    }

    /// The number of places at the begin of the scan in which the rod is free: up to the first break, and as long as the reactions stay
    /// what they were but for drift.
    fn free(&self) -> usize {
        let Some(first) = self.places.first() else { return 0 };
        let before_break =
            self.places.iter().skip(1).take_while(|place| place.observation.between.is_none()).count() + 1;
        let units = self.rod.units();
        let drift =
            [units.force, units.force, units.moment].into_iter().zip(self.budget.drift).map(|(unit, by)| by / unit);
        let drift: Vec<f64> = drift.collect();
        let start = first.fit.at(self.track.tau[0]);
        let stays = |k: &usize| {
            let (way, here) = (self.track.tau[*k] - self.track.tau[0], self.places[*k].fit.at(self.track.tau[*k]));
            let variance = start.covariance() + here.covariance();
            (0..3).all(|c| {
                let off = here.clamp.reactions[c] - start.clamp.reactions[c];
                off.abs() <= CHANCE * (variance[(c, c)] + (drift[c] * way).powi(2)).sqrt()
            })
        };
        (0..before_break).take_while(stays).count()
    }
}
