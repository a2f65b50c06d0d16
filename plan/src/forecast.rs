//! What candidate scans are expected to add to what is known.

use crate::choice::{Choice, exhaustive, greedy};
use crate::hypothesis::Hypothesis;
use crate::precision::{Measurement, PlaceSigma, predicted};
use crate::scanned::{self, Computation, Progress};
use crate::support::along;
use crate::{IntervalSet, PlanError, ReachGrid, Scanned, StraightScan};
use rayon::prelude::*;
use rod_contact::{Path, StopReason};
use rod_core::{PhysicalRod, Pose};
use rod_reconstruct::{FittedObject, Knowledge};
use std::fmt;
use std::sync::Arc;

/// Distance (rod lengths) of the states of a sweep past a drawn object. The ends of what is touched do not depend on it; between two states the stress may be somewhat
/// larger than at both. Smaller: slower.
const COARSE: f64 = 0.03;

/// Steps of a sweep past a drawn object after which it is given up. Of 1,088 sweeps past objects that were drawn from a scan of O1 none took 2,500. Larger: a rod that is
/// caught and jumps to and fro takes longer; with the limit of the sweep, 2 million steps, minutes.
const MOST_STEPS: u64 = 10_000;

/// How candidates are judged.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanSettings {
    /// Objects that are drawn, beside the most plausible one. More: slower; the error of the expected gains falls with the root of it.
    pub hypotheses: usize,
    /// Seed of the draws: the same one gives the same plan.
    pub seed: u64,
    /// Speed of the clamp, m/s.
    pub speed: f64,
    /// Largest bending stress of a scan, Pa; none for any.
    pub most_stress: Option<f64>,
    /// The sensor, and the contour that will be fitted; without it no standard deviations are predicted.
    pub measurement: Option<Measurement>,
}

impl Default for PlanSettings {
    /// 16 hypotheses, 1 mm/s, and any stress.
    fn default() -> Self {
        Self { hypotheses: 16, seed: 0, speed: 1e-3, most_stress: None, measurement: None }
    }
}

/// A scan that may be made.
#[derive(Clone)]
pub struct Candidate {
    /// Where it stands in a grid; none where its path was given.
    pub scan: Option<StraightScan>,
    /// The way of the clamp. Its parameter is the way in m, as of a [`ClampPath`](rod_contact::ClampPath) or a [`ClampArc`](rod_contact::ClampArc) on which the clamp moves.
    pub path: Arc<dyn Path>,
}

impl Candidate {
    /// First and last pose of the clamp.
    pub fn ends(&self) -> [Pose; 2] {
        [0.0, self.path.length()].map(|way| self.path.point(way).pose)
    }
}

impl fmt::Debug for Candidate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Candidate").field("scan", &self.scan).field("ends", &self.ends()).finish_non_exhaustive()
    }
}

/// What a candidate is expected to bring.
#[derive(Clone, Debug)]
pub struct Forecast {
    /// The scan.
    pub candidate: Candidate,
    /// What it adds; none where it is ruled out: in a hypothesis the clamp runs into the object, or the rod bends beyond the largest stress.
    pub gain: Option<Gain>,
    /// Hypotheses that were swept: all of them, or those up to the one that rules it out.
    pub swept: usize,
    /// Time of the scan at the speed of the settings, s.
    pub time: f64,
    /// Largest bending stress over the hypotheses that were swept, Pa; none where the diameter of the rod is not known.
    pub largest_stress: Option<f64>,
    /// Largest moment at the clamp over them, N m.
    pub largest_moment: f64,
    /// Largest force at the clamp over them, N.
    pub largest_force: f64,
    /// Whether the clamp runs into the object in one of them.
    pub is_blocked: bool,
    /// Predicted standard deviations along the most plausible object; empty without a measurement, or where the scan is ruled out.
    pub sigmas: Vec<PlaceSigma>,
    /// The points touched before, and how certain they get; empty as the standard deviations.
    pub known: Vec<KnownPoint>,
}

/// Length of the contour that a scan adds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain {
    /// Mean length that is touched and was not before, m.
    pub mean: f64,
    /// Its standard deviation over the hypotheses, m.
    pub sigma: f64,
    /// Mean length that is touched at all, m.
    pub touched: f64,
}

/// A point that was touched before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownPoint {
    /// Length of the contour that it stands for, m.
    pub length: f64,
    /// Standard deviation so far, m.
    pub before: f64,
    /// Standard deviation with the scan, m.
    pub after: f64,
}

impl Forecast {
    /// Median standard deviation at the points touched before, and after this scan as well, m; none without a measurement.
    pub fn known_sigma(&self) -> Option<[f64; 2]> {
        let median = |sigma: fn(&KnownPoint) -> f64| {
            let mut sigmas: Vec<f64> = self.known.iter().map(sigma).collect();
            sigmas.sort_by(f64::total_cmp);
            sigmas.get(sigmas.len() / 2).copied()
        };
        Some([median(|point| point.before)?, median(|point| point.after)?])
    }
}

/// What all candidates are expected to bring.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The objects that agree with what is known, the most plausible one first.
    pub hypotheses: Vec<Hypothesis>,
    /// The candidates in the given order; fewer where the work was ended early.
    pub forecasts: Vec<Forecast>,
    /// What each candidate newly touches of each object of each hypothesis; nothing of one that is ruled out.
    new: Vec<Vec<Vec<IntervalSet>>>,
}

impl Plan {
    /// Mean length (m) that some candidates newly touch together.
    pub fn value(&self, taken: &[usize]) -> f64 {
        let of_hypothesis = |hypothesis: usize| {
            let of_object = |object: usize| {
                let mut union = IntervalSet::default();
                let new = taken.iter().filter_map(|candidate| self.new[*candidate].get(hypothesis)?.get(object));
                new.for_each(|new| union.extend(new));
                union.length()
            };
            (0..self.hypotheses[hypothesis].objects.len()).map(of_object).sum::<f64>()
        };
        (0..self.hypotheses.len()).map(of_hypothesis).sum::<f64>() / self.hypotheses.len().max(1) as f64
    }

    /// Length (m) of the contour, touched before, whose standard deviation falls below `sigma` (m) by one of some candidates.
    pub(crate) fn improved(&self, taken: &[usize], sigma: f64) -> f64 {
        let points = taken.first().map_or(0, |first| self.forecasts[*first].known.len());
        let improves = |point: &KnownPoint| point.before > sigma && point.after <= sigma;
        let length = |k: usize| {
            let mut points = taken.iter().map(|candidate| &self.forecasts[*candidate].known[k]);
            points.find(|point| improves(point)).map_or(0.0, |point| point.length)
        };
        (0..points).map(length).sum()
    }

    /// Up to `count` candidates that together newly touch most, taken one after the other: at least 0.632 of the most that so many can
    /// ([`greedy`]). None of them is ruled out.
    pub fn greedy(&self, count: usize) -> Vec<Choice> {
        let allowed = self.allowed();
        let own = |taken: &[usize]| taken.iter().map(|k| allowed[*k]).collect::<Vec<_>>();
        let choices = greedy(allowed.len(), count, |taken| self.value(&own(taken)));
        choices.into_iter().map(|choice| Choice { candidate: allowed[choice.candidate], ..choice }).collect()
    }

    /// The best set of at most `count` candidates by trying all of them, and its value.
    pub fn best(&self, count: usize) -> (Vec<usize>, f64) {
        let allowed = self.allowed();
        let own = |taken: &[usize]| taken.iter().map(|k| allowed[*k]).collect::<Vec<_>>();
        let (taken, value) = exhaustive(allowed.len(), count, &|taken: &[usize]| self.value(&own(taken)));
        (own(&taken), value)
    }

    /// The candidates that are not ruled out.
    pub(crate) fn allowed(&self) -> Vec<usize> {
        (0..self.forecasts.len()).filter(|k| self.forecasts[*k].gain.is_some()).collect()
    }
}

/// Straight scans at the distances and angles of a grid, both ways, whose lines are so far from all hypotheses about the object: those of
/// [`plan`] with the same settings. There are fewer from where `goes_on` returns false.
///
/// # Errors
/// [`PlanError`].
pub fn straight_candidates<R: PhysicalRod>(
    rod: &R,
    known: &[FittedObject],
    grid: &ReachGrid,
    settings: &PlanSettings,
    goes_on: &dyn Fn() -> bool,
) -> Result<Vec<Candidate>, PlanError> {
    grid.check(rod)?;
    candidates(rod, known, grid.scans(), settings, goes_on)
}

/// These scans, whose lines are so far from all hypotheses about the object: those of [`plan`] with the same settings. There are fewer from where
/// `goes_on` returns false.
///
/// # Errors
/// [`PlanError`].
pub fn candidates<R: PhysicalRod>(
    rod: &R,
    known: &[FittedObject],
    scans: impl IntoIterator<Item = StraightScan>,
    settings: &PlanSettings,
    goes_on: &dyn Fn() -> bool,
) -> Result<Vec<Candidate>, PlanError> {
    let length = rod.units().length;
    let scans: Vec<StraightScan> = scans.into_iter().collect();
    scans.iter().try_for_each(|scan| scan.check(length))?;
    if scans.is_empty() {
        return Ok(Vec::new());
    }
    candidates_of(&hypotheses(known, length, settings, &|_| true)?, scans, length, goes_on)
}

/// Objects that agree with what is known, and whose contours beyond what is known stay where they `may_be`.
pub(crate) fn hypotheses(
    known: &[FittedObject],
    length: f64,
    settings: &PlanSettings,
    may_be: &dyn Fn([f64; 2]) -> bool,
) -> Result<Vec<Hypothesis>, PlanError> {
    let all = Hypothesis::all(known, length, (settings.hypotheses, settings.seed), may_be);
    if all.is_empty() { Err(PlanError::NothingKnown) } else { Ok(all) }
}

/// Scans past these objects; `length` is that of the rod, m. Many scans take seconds, so `goes_on` is asked before each.
pub(crate) fn candidates_of(
    hypotheses: &[Hypothesis],
    scans: impl IntoIterator<Item = StraightScan>,
    length: f64,
    goes_on: &dyn Fn() -> bool,
) -> Result<Vec<Candidate>, PlanError> {
    let candidate = |scan: StraightScan| {
        let frames = || {
            hypotheses
                .iter()
                .flat_map(|one| one.objects.iter().zip(&one.outlines))
                .flat_map(|(object, outline)| outline.points(object))
        };
        let nearest = frames().map(|(_, frame)| along(scan.angle, frame)).fold(f64::INFINITY, f64::min);
        let left = scan.angle + std::f64::consts::FRAC_PI_2;
        let limit = nearest - scan.distance + length;
        let within =
            frames().filter(|(_, frame)| along(scan.angle, *frame) <= limit).map(|(_, frame)| along(left, frame));
        let across =
            within.fold((f64::INFINITY, f64::NEG_INFINITY), |ends, place| (ends.0.min(place), ends.1.max(place)));
        Ok(Candidate { scan: Some(scan), path: Arc::new(scan.path(nearest, across, length)?) })
    };
    scans.into_iter().take_while(|_| goes_on()).map(candidate).collect()
}

/// What each of some candidate scans is expected to add to what is `known` of an object, on all cores, without friction. `goes_on` hears how many
/// candidates are done, also within a scan, and ends the work where it returns false.
///
/// # Errors
/// [`PlanError::NothingKnown`] where no point is known.
pub fn plan<R: PhysicalRod + Sync>(
    rod: &R,
    known: &[FittedObject],
    candidates: &[Candidate],
    settings: &PlanSettings,
    goes_on: &(impl Fn(usize) -> bool + Sync),
) -> Result<Plan, PlanError> {
    if !goes_on(0) {
        return Ok(Plan { hypotheses: Vec::new(), forecasts: Vec::new(), new: Vec::new() });
    }
    if candidates.is_empty() {
        return Err(PlanError::Empty { what: "candidates" });
    }
    let hypotheses = hypotheses(known, rod.units().length, settings, &|_| true)?;
    plan_of(rod, known, hypotheses, candidates, settings, goes_on)
}

/// [`plan`] with these objects.
pub(crate) fn plan_of<R: PhysicalRod + Sync>(
    rod: &R,
    known: &[FittedObject],
    hypotheses: Vec<Hypothesis>,
    candidates: &[Candidate],
    settings: &PlanSettings,
    goes_on: &(impl Fn(usize) -> bool + Sync),
) -> Result<Plan, PlanError> {
    let places = hypotheses.first().map_or_else(Vec::new, |one| known_places(known, one));
    let progress = Progress::new(goes_on);
    let one = |candidate: &Candidate| {
        let found = forecast(rod, &places, &hypotheses, candidate.clone(), settings, &progress);
        (found, progress.count())
    };
    let found = candidates.par_iter().map(one).take_any_while(|(_, goes_on)| *goes_on).map(|(found, _)| found);
    let (forecasts, new) = found.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    Ok(Plan { hypotheses, forecasts, new })
}

/// What one candidate brings, and what it newly touches of each object of each hypothesis. The first hypothesis that rules it out is the last one that is swept.
fn forecast<R: PhysicalRod>(
    rod: &R,
    known_places: &[KnownPlace],
    hypotheses: &[Hypothesis],
    candidate: Candidate,
    settings: &PlanSettings,
    progress: &Progress<'_>,
) -> Result<(Forecast, Vec<Vec<IntervalSet>>), PlanError> {
    let path = candidate.path.clone();
    let (mut new, mut gains, mut touched, mut plausible) = (Vec::new(), Vec::new(), 0.0, Vec::new());
    let mut forecast = Forecast {
        candidate,
        gain: None,
        swept: 0,
        time: path.length() / settings.speed,
        largest_stress: None,
        largest_moment: 0.0,
        largest_force: 0.0,
        is_blocked: false,
        sigmas: Vec::new(),
        known: Vec::new(),
    };
    for (number, Hypothesis { objects, outlines, touched: before, .. }) in hypotheses.iter().enumerate() {
        // only of the most plausible object are the states themselves of use
        let step = if number == 0 { scanned::STEP } else { COARSE } * rod.units().length;
        let computation = Computation { step, most_steps: Some(MOST_STEPS), most_stress: settings.most_stress };
        let (found, states) = Scanned::of(rod, objects, outlines, &path, computation, progress)?;
        forecast.swept += 1;
        forecast.largest_moment = forecast.largest_moment.max(found.largest_moment);
        forecast.largest_force = forecast.largest_force.max(found.largest_force);
        forecast.largest_stress = match (forecast.largest_stress, found.largest_stress) {
            (Some(one), Some(other)) => Some(one.max(other)),
            (one, other) => one.or(other),
        };
        let is_beyond = found.is_beyond(settings.most_stress);
        forecast.is_blocked = found.stop.is_some_and(|stop| stop.reason == StopReason::ClampInside);
        if is_beyond || forecast.is_blocked {
            return Ok((forecast, Vec::new()));
        }
        let all: Vec<IntervalSet> = (0..objects.len()).map(|object| found.touched.all(object)).collect();
        let fresh: Vec<IntervalSet> = all.iter().zip(before).map(|(all, before)| all.without(before)).collect();
        gains.push(fresh.iter().map(IntervalSet::length).sum::<f64>());
        touched += all.iter().map(IntervalSet::length).sum::<f64>();
        new.push(fresh);
        if number == 0 {
            plausible = states;
        }
    }
    if let (Some(Hypothesis { objects, outlines, .. }), Some(measurement)) = (hypotheses.first(), &settings.measurement)
    {
        forecast.sigmas = predicted(rod, objects, outlines, &plausible, path.length(), measurement);
        forecast.known = known_points(known_places, &forecast.sigmas, measurement);
    }
    let count = hypotheses.len() as f64;
    let mean = gains.iter().sum::<f64>() / count;
    let square: f64 = gains.iter().map(|gain| (gain - mean).powi(2)).sum();
    forecast.gain = Some(Gain { mean, sigma: (square / (count - 1.0).max(1.0)).sqrt(), touched: touched / count });
    Ok((forecast, new))
}

/// A point touched before, on the most plausible object: its number, arc length (m), standard deviation (m), and the length (m) that it stands for.
type KnownPlace = (usize, f64, f64, f64);

/// The points touched before, on the most plausible object.
fn known_places(known: &[FittedObject], hypothesis: &Hypothesis) -> Vec<KnownPlace> {
    let mut places = Vec::new();
    for contour in known {
        let way = |k: usize| match (contour.points.get(k), contour.points.get(k + 1)) {
            (Some(from), Some(to)) => (to[0] - from[0]).hypot(to[1] - from[1]),
            _ => 0.0,
        };
        for (k, (point, known)) in contour.points.iter().zip(&contour.known).enumerate() {
            let Knowledge::Touched { sigma } = *known else { continue };
            let shapes = hypothesis.objects.iter().zip(&hypothesis.outlines).enumerate();
            let at = shapes.filter_map(|(object, (shape, outline))| {
                let place = outline.nearest(shape, point[0], point[1])?;
                let frame = outline.frame(shape, place);
                Some((object, place, (frame.x - point[0]).hypot(frame.y - point[1])))
            });
            let nearest = at.min_by(|one, other| one.2.total_cmp(&other.2));
            let length = 0.5 * (way(k) + k.checked_sub(1).map_or(0.0, way));
            places.extend(nearest.map(|(object, place, _)| (object, place, sigma, length)));
        }
    }
    places
}

/// The points touched before with the predicted standard deviations at the same places, as of independent measurements.
fn known_points(places: &[KnownPlace], predicted: &[PlaceSigma], measurement: &Measurement) -> Vec<KnownPoint> {
    let point = |&(object, place, before, length): &KnownPlace| {
        let is_near =
            |one: &&PlaceSigma| one.object == object && (one.place - place).abs() <= 0.5 * measurement.resolution;
        let new = predicted.iter().filter(is_near).map(|one| one.sigma).reduce(f64::min).unwrap_or(f64::INFINITY);
        KnownPoint { length, before, after: (before.powi(-2) + new.powi(-2)).sqrt().recip() }
    };
    places.iter().map(point).collect()
}
