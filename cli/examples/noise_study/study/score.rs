//! How near a reconstruction is to the truth.

use super::{Clean, MARGIN, STEP};
use nalgebra::Matrix3;
use std::collections::BTreeMap;
use vibrissa::reconstruct::score::{Confusion, KinkScore, signed_distance};
use vibrissa::reconstruct::{Assembly, Reconstruction, Touch, TraceKind, single};
use vibrissa::{Label, Sample};

/// Distance of the places at which an assembled contour is compared, m.
const SPACING: f64 = 5e-5;
/// Length of a stretch that is worth a line, m.
const LONG: f64 = 0.5e-3;

/// Standard deviations within which a point is covered: 95 % of normal errors are.
const COVERED: f64 = 2.0;

/// Least probabilities by which labels are counted.
pub const PROBABILITIES: [f64; 4] = [0.0, 0.7, 0.9, 0.98];

/// So many of so many.
#[derive(Clone, Copy, Debug, Default)]
pub struct Share {
    part: usize,
    whole: usize,
}

/// The score of one scan, or of several. Distances from the contour are in m, positive outside the solid.
#[derive(Clone, Debug, Default)]
pub struct Score {
    /// How many scans.
    pub scans: usize,
    /// Kinks and jumps.
    pub kinks: KinkScore,
    /// Transitions that were missed, and places where there is none, with their numbers.
    pub missed: BTreeMap<String, usize>,
    pub invented: BTreeMap<String, usize>,
    /// Stretches of at least [`LONG`] that were taken for another phase.
    pub mistaken: BTreeMap<String, usize>,
    /// Phases.
    pub phases: Confusion,
    /// Points of samples labelled as having one contact.
    pub points: Vec<f64>,
    /// Those of them that are within two standard deviations of the noise, and of the noise with the errors that samples share.
    pub covered: [Share; 2],
    /// Places along the contour assembled from them.
    pub contour: Vec<f64>,
    /// First and second contacts of samples labelled as having several.
    pub several: [Vec<f64>; 2],
    /// Points that one contact would have, of samples that have several.
    pub naive: Vec<f64>,
    /// Coefficients of friction that were found, each with its error in standard deviations of the noise, and in those with all errors that
    /// samples share.
    pub frictions: Vec<[f64; 3]>,
    /// Samples with one contact that are labelled so and have their point.
    pub answered: Share,
    /// Samples with several contacts that have their first, their second contact.
    pub resolved: [Share; 2],
    /// Stretches with several contacts in which no sample has a first, a second contact.
    pub given_up: [Share; 2],
    /// Recordings that one contour explains, of those to which one was fitted.
    pub explained: Share,
    /// Labels that are right, by their probability from each of [`PROBABILITIES`] on.
    pub sure: [Share; PROBABILITIES.len()],
    /// Wrong labels that the probabilities let expect.
    pub expected: f64,
}

impl Share {
    pub fn count(&mut self, is: bool) {
        self.part += usize::from(is);
        self.whole += 1;
    }

    fn merge(&mut self, other: Self) {
        self.part += other.part;
        self.whole += other.whole;
    }

    /// How many are not.
    pub fn others(&self) -> usize {
        self.whole - self.part
    }

    /// None of nothing.
    pub fn value(&self) -> Option<f64> {
        (self.whole > 0).then(|| self.part as f64 / self.whole as f64)
    }
}

impl Score {
    /// Of one scan. No sample was lost.
    pub fn of(clean: &Clean, samples: &[Sample], found: &Reconstruction) -> Self {
        let mut score = Self { scans: 1, ..Self::default() };
        score.kinks(clean, found);
        score.readings(clean, samples, found);
        score.stretches(clean, found);
        score.mistakes(clean, found);
        if let Some(friction) = found.passes.iter().find_map(|pass| pass.friction) {
            let off = friction.mu - clean.friction;
            score.frictions.push([friction.mu, off / friction.sigma_of_noise, off / friction.sigma]);
        }
        let objects = &clean.scene.objects;
        let contour = found.contour(&Assembly::default());
        let places = contour.of_kind(TraceKind::Single).flat_map(|trace| {
            let points: Vec<[f64; 2]> = trace.points.iter().map(|point| [point.x, point.y]).collect();
            along(&points)
        });
        score.contour.extend(places.filter_map(|[x, y]| signed_distance(objects, x, y)));
        score
    }

    /// Adds another scan, or several.
    pub fn merge(&mut self, other: Self) {
        self.scans += other.scans;
        self.kinks.merge(&other.kinks);
        for (sums, counts) in [
            (&mut self.missed, other.missed),
            (&mut self.invented, other.invented),
            (&mut self.mistaken, other.mistaken),
        ] {
            counts.into_iter().for_each(|(name, count)| *sums.entry(name).or_default() += count);
        }
        self.phases += other.phases;
        self.points.extend(other.points);
        self.covered.iter_mut().zip(other.covered).for_each(|(covered, other)| covered.merge(other));
        self.contour.extend(other.contour);
        self.naive.extend(other.naive);
        self.frictions.extend(other.frictions);
        self.answered.merge(other.answered);
        for (k, distances) in other.several.into_iter().enumerate() {
            self.several[k].extend(distances);
            self.resolved[k].merge(other.resolved[k]);
            self.given_up[k].merge(other.given_up[k]);
        }
        self.explained.merge(other.explained);
        self.sure.iter_mut().zip(other.sure).for_each(|(sure, other)| sure.merge(other));
        self.expected += other.expected;
    }

    /// Transitions that hardly show need not be found, and are no false alarms where they are.
    fn kinks(&mut self, clean: &Clean, found: &Reconstruction) {
        let places: Vec<f64> = found.kinks.iter().map(|kink| kink.tau).collect();
        let truth = clean.places(true);
        let matched = KinkScore::of(&places, &truth, MARGIN);
        let rest: Vec<f64> =
            places.iter().copied().filter(|place| matched.matches.iter().all(|pair| pair.found != *place)).collect();
        let faint = KinkScore::of(&rest, &clean.places(false), MARGIN);
        let counted: Vec<f64> =
            places.into_iter().filter(|place| faint.matches.iter().all(|pair| pair.found != *place)).collect();
        self.kinks = KinkScore::of(&counted, &truth, MARGIN);
        for transition in clean.transitions.iter().filter(|transition| transition.shows) {
            if self.kinks.matches.iter().all(|pair| pair.truth != transition.at) {
                let name = format!("{} {} at {:.2} mm", clean.scene.name, transition.name, 1e3 * transition.at);
                *self.missed.entry(name).or_default() += 1;
            }
        }
        for kink in found.kinks.iter().filter(|kink| counted.contains(&kink.tau)) {
            if self.kinks.matches.iter().all(|pair| pair.found != kink.tau) {
                let name = format!("{} {:?} near {:.0} mm", clean.scene.name, kink.kind, 1e3 * kink.tau);
                *self.invented.entry(name).or_default() += 1;
            }
        }
    }

    fn readings(&mut self, clean: &Clean, samples: &[Sample], found: &Reconstruction) {
        let objects = &clean.scene.objects;
        let off = |touch: &Touch| signed_distance(objects, touch.x, touch.y);
        for ((reading, truth), sample) in found.readings.iter().zip(&clean.labels).zip(samples) {
            self.phases.add(*truth, reading.label);
            let class = PROBABILITIES.iter().rposition(|least| reading.probability >= *least).unwrap_or(0);
            self.sure[class].count(*truth == reading.label);
            self.expected += 1.0 - reading.probability;
            let touch = reading.touch.as_ref().ok();
            if reading.label.several() {
                let second = reading.second.as_ref().and_then(|second| second.as_ref().ok());
                for (distances, touch) in self.several.iter_mut().zip([touch, second]) {
                    distances.extend(touch.and_then(off));
                }
            } else if let Some((touch, off)) = touch.and_then(|touch| Some((touch, off(touch)?))) {
                self.points.push(off);
                let all = touch.sigma_normal();
                let alone = (all * all - touch.sigma_systematic().powi(2)).max(0.0).sqrt();
                for (covered, sigma) in self.covered.iter_mut().zip([alone, all]) {
                    covered.count(off.abs() <= COVERED * sigma);
                }
            }
            if truth.several() {
                let point = single(clean.scene.rod.at_clamp(), sample.pose, sample.reactions, &Matrix3::zeros());
                let point = point.map_or_else(|none| none.touch(), Some);
                self.naive.extend(point.as_ref().and_then(off));
            } else if *truth != Label::Free {
                self.answered.count(touch.is_some() && !reading.label.several());
            }
        }
    }

    fn mistakes(&mut self, clean: &Clean, found: &Reconstruction) {
        let pairs: Vec<(Label, Label)> =
            clean.labels.iter().copied().zip(found.readings.iter().map(|reading| reading.label)).collect();
        let mut from = 0;
        for same in pairs.chunk_by(|a, b| a == b) {
            let ((truth, label), length) = (same[0], same.len() as f64 * STEP);
            if truth != label && length >= LONG {
                let (name, at) = (&clean.scene.name, 1e3 * from as f64 * STEP);
                let what = format!("{name} {truth} for {label} from about {at:.0} mm on, {:.0} mm", 1e3 * length);
                *self.mistaken.entry(what).or_default() += 1;
            }
            from += same.len();
        }
    }

    fn stretches(&mut self, clean: &Clean, found: &Reconstruction) {
        let mut from = 0;
        for stretch in clean.labels.chunk_by(|a, b| a == b) {
            let readings = &found.readings[from..from + stretch.len()];
            from += stretch.len();
            if !stretch[0].several() {
                continue;
            }
            let mut any = [false; 2];
            for reading in readings {
                let second = reading.second.as_ref().is_some_and(Result::is_ok);
                let first = reading.label.several() && reading.touch.is_ok();
                for (k, is) in [first, second].into_iter().enumerate() {
                    self.resolved[k].count(is);
                    any[k] |= is;
                }
            }
            any.into_iter().zip(&mut self.given_up).for_each(|(any, given_up)| given_up.count(!any));
        }
    }
}

/// Places along a polyline, m.
fn along(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut places: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let parts = ((to[0] - from[0]).hypot(to[1] - from[1]) / SPACING).ceil().max(1.0);
        let place = |part: usize| {
            let share = part as f64 / parts;
            [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]
        };
        places.extend((1..=parts as usize).map(place));
    }
    places
}
