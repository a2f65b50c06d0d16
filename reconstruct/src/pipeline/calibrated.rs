//! A scan up to the errors that its samples share: track, kinks, places and what is known of the errors.

use super::settings::{ReconstructError, Settings, positive, possible};
use crate::friction::{
    ANY, Friction, FrictionAlone, FrictionEstimate, PlateauFriction, flatness, plateau_friction, shows_friction,
};
use crate::kink::{Kink, KinkKind, KinkOptions, find_kinks};
use crate::phase::{Break, Place, evaluate_places};
use crate::point::Inverse;
use crate::scan::noise_estimate::{ChannelNoise, estimate};
use crate::scan::{FEWEST_SAMPLES, Fault, Noise, Track, TrackIndex, dimensionless, quantum};
use crate::systematic::{
    Budget, Calibration, CalibrationScan, Correction, Errors, Known, RemainingErrors, Source, SourceEstimate,
    calibrate, log_likelihood,
};
use rod_core::{Rod, Sample, Units};

/// Steps of the reactions, in EI/L^2 and EI/L, from which on they hide transitions: those of a contact that begins are no larger.
const COARSE: f64 = 0.02;

/// A scan without the errors that its samples share.
#[derive(Clone)]
pub(super) struct Calibrated {
    pub track: Track,
    /// For each sample, by its number, its track index or the reason why the track leaves it out.
    pub indices: Vec<Result<TrackIndex, Fault>>,
    /// The noise of each channel, in EI/L^2 and EI/L.
    pub found: [ChannelNoise; 3],
    pub kinks: Vec<Kink>,
    pub noise: Noise,
    /// Steps of each channel that hide transitions, in EI/L^2 and EI/L.
    pub steps: [Option<f64>; 3],
    pub breaks: Vec<Break>,
    pub places: Vec<Place>,
    /// The units of the rod, as it was found.
    pub units: Units,
    pub calibration: Option<(RemainingErrors, Calibration)>,
    /// What the scan tells of friction, where that was asked for or seems to be there.
    pub friction: Option<FrictionEstimate>,
}

impl Calibrated {
    /// From the samples of one path of the clamp; `given` is a rod of the same units as `rod`.
    pub fn of<I: Inverse>(
        rod: &I,
        given: &Rod,
        samples: &[Sample],
        settings: &Settings,
    ) -> Result<Self, ReconstructError> {
        let scan = Self::measured(rod, given, samples, settings)?;
        if settings.friction != Friction::None {
            let without = log_likelihood(&scan.scan(rod, given), &allowed::<I>(given, settings)?, &settings.known);
            let mut rough = scan.clone().rough(rod, given, settings)?;
            rough.friction = rough.compared_with(without);
            if let Friction::Known { mu, sigma } = settings.friction {
                rough = rough.against_alone(scan.rough(rod, given, &alone(settings))?.friction, mu, sigma);
            }
            return Ok(rough);
        }
        let smooth = scan.clone().smooth(rod, given, settings)?;
        let shows_friction =
            |tare: Option<&Correction>| shows_friction(rod, &scan.track, &scan.noise, &scan.places, tare);
        // a bias blurs the plateau
        if !shows_friction(None) && !smooth.tare(given).is_some_and(|tare| shows_friction(Some(&tare))) {
            return Ok(smooth);
        }
        let without = smooth.calibration.as_ref().map(|found| found.1.log_likelihood);
        Ok(Self { friction: scan.rough(rod, given, settings)?.compared_with(without), ..smooth })
    }

    /// The correction of bias and drift alone; none where nothing was subtracted.
    fn tare(&self, rod: &Rod) -> Option<Correction> {
        let (shared, report) = self.calibration.as_ref().filter(|found| found.1.is_applied())?;
        Correction::new(shared.frame, &report.tare(rod))
    }

    /// Without friction, and without the errors that all samples share.
    pub fn smooth<I: Inverse>(self, rod: &I, given: &Rod, settings: &Settings) -> Result<Self, ReconstructError> {
        Ok(self.subtract_shared_errors(rod, given, &allowed::<I>(given, settings)?, &settings.known))
    }

    /// With friction that is known or estimated, and without the errors that all samples share.
    pub fn rough<I: Inverse>(self, rod: &I, given: &Rod, settings: &Settings) -> Result<Self, ReconstructError> {
        let budget = with_friction(allowed::<I>(given, settings)?, settings);
        let scan = self.with_plateau_friction(rod, settings);
        Ok(scan.subtract_shared_errors(rod, given, &budget, &settings.known))
    }

    /// The scan with friction that is known or estimated from its plateau.
    fn with_plateau_friction<I: Inverse>(self, rod: &I, settings: &Settings) -> Self {
        let mu = if let Friction::Known { mu, .. } = settings.friction { Some(mu) } else { None };
        let (PlateauFriction { mu, sigma, scatter, spread, against, likelihood, without }, places) =
            plateau_friction(rod, &self.track, &self.noise, self.places, mu);
        let track = self.track.with_friction(mu);
        let gain = likelihood - without;
        let found = FrictionEstimate { mu, sigma, sigma_of_noise: sigma, scatter, spread, gain, against, alone: None };
        Self { track, places, friction: Some(found), ..self }
    }

    /// With what the scan tells of friction on its own, where a coefficient of this standard deviation was given.
    fn against_alone(mut self, alone: Option<FrictionEstimate>, mu: f64, sigma: f64) -> Self {
        if let Some((found, alone)) = self.friction.as_mut().zip(alone) {
            found.alone = Some(FrictionAlone::of(&alone, mu.copysign(found.mu), sigma));
        }
        self
    }

    /// What this scan with friction tells of it, where this is the logarithm of the likelihood without, if shared errors are estimated.
    fn compared_with(&self, without: Option<f64>) -> Option<FrictionEstimate> {
        let with = self.calibration.as_ref().map(|found| found.1.log_likelihood);
        let gain = with.zip(without).map(|(with, without)| with - without);
        self.friction.map(|found| FrictionEstimate { gain: gain.unwrap_or(found.gain), ..found })
    }

    fn scan<'a, I>(&'a self, inverse: &'a I, rod: &'a Rod) -> CalibrationScan<'a, I> {
        CalibrationScan {
            inverse,
            rod,
            track: &self.track,
            noise: &self.noise,
            breaks: &self.breaks,
            places: &self.places,
        }
    }

    /// Estimates the errors that all samples share, and subtracts those that the scan needs.
    fn subtract_shared_errors<I: Inverse>(mut self, inverse: &I, rod: &Rod, budget: &Budget, known: &Known) -> Self {
        let found = calibrate(&self.scan(inverse, rod), budget, known);
        let Self { track, noise, breaks, places, units, calibration, friction, .. } = &mut self;
        let plateau = track.friction;
        if let Some((correction, shared, mut report)) = found {
            if let Some(correction) = correction {
                // errors beyond their budgets explain nothing: then friction changes as on the samples as they are
                let explained = !report.sources.iter().any(SourceEstimate::is_beyond);
                let mu = plateau + report.source(Source::Friction).map_or(0.0, |estimate| estimate.taken);
                if let Some(found) = friction.as_mut().filter(|_| explained) {
                    (found.scatter, found.spread) = flatness(inverse, track, noise, places, &correction, mu);
                }
                *track = correction.track(track);
                if report.is_applied() {
                    *places = evaluate_places(inverse, track, noise, breaks);
                } else {
                    places.iter_mut().for_each(|place| place.fit.set_friction(track.friction));
                }
                *units = report.rod(rod).units();
            }
            shared.weaken_breaks(places);
            shared.update_evidence(inverse, &Errors::zeros(), track, places);
            report.shift(Source::Friction, plateau);
            if let Some((found, own)) = friction.as_mut().zip(report.source(Source::Friction).copied()) {
                report.direction = found.mu.signum() * (0.5 - found.against).signum();
                (found.mu, found.sigma) = (track.friction, own.sigma);
            }
            *calibration = Some((shared, report));
        }
        self
    }

    /// The samples as they are; `units` is a rod of the same units as `rod`.
    pub fn measured<I: Inverse>(
        rod: &I,
        units: &Rod,
        samples: &[Sample],
        settings: &Settings,
    ) -> Result<Self, ReconstructError> {
        if let Some(value) = settings.friction.fault() {
            return Err(ReconstructError::Friction { value });
        }
        positive([("false_alarms", settings.false_alarms), ("largest_sigma", settings.largest_sigma)])?;
        let (track, indices) = Track::new(units, samples);
        let units = units.units();
        if track.len() < FEWEST_SAMPLES {
            return Err(ReconstructError::TooFew {
                usable: track.len(),
                samples: samples.len(),
                fewest: FEWEST_SAMPLES,
            });
        }
        let channels = [0, 1, 2].map(|c| track.clamps.iter().map(|clamp| clamp.reactions[c]).collect::<Vec<f64>>());
        let size = [units.force, units.force, units.moment];
        let found = match settings.noise {
            Some(noise) => dimensionless(&noise, units),
            None => noise_of(&track, &channels, samples, size),
        };
        let [f0x, f0y, m0z] = &channels;
        let options = KinkOptions { false_alarms: settings.false_alarms, ..KinkOptions::default() };
        let kinks = find_kinks(&track.tau, [f0x, f0y, m0z], &found, options);
        let noise = Noise::new(&found);
        let steps = channels.each_ref().map(|channel| quantum(channel).filter(|step| *step > COARSE));
        let breaks: Vec<Break> = kinks
            .iter()
            .map(|kink| Break { index: kink.next, jump: kink.kind == KinkKind::Jump, score: kink.score })
            .collect();
        let places = evaluate_places(rod, &track, &noise, &breaks);
        // numbers so large that their squares overflow leave none
        if places.is_empty() {
            return Err(ReconstructError::TooFew { usable: 0, samples: samples.len(), fewest: FEWEST_SAMPLES });
        }
        let (calibration, friction) = (None, None);
        Ok(Self { track, indices, found, kinks, noise, steps, breaks, places, units, calibration, friction })
    }
}

/// The settings without a coefficient of friction that was given.
fn alone(settings: &Settings) -> Settings {
    Settings { friction: Friction::Estimate, ..*settings }
}

/// The budget but for friction, if it and what is known are possible.
fn allowed<I: Inverse>(rod: &Rod, settings: &Settings) -> Result<Budget, ReconstructError> {
    let budget = settings.budget.unwrap_or_else(|| Budget::laboratory(rod));
    possible(&budget, &settings.known)?;
    // another rod than the uniform one is bent at rest as its model says
    match settings.known.of(Source::NaturalCurvature) {
        Some(_) if !I::UNIFORM => Err(ReconstructError::NaturalCurvature),
        _ => Ok(budget),
    }
}

/// The budget with that of friction, of which nothing is known where it is not asked for.
fn with_friction(budget: Budget, settings: &Settings) -> Budget {
    let friction = if settings.friction == Friction::None { ANY } else { settings.friction.sigma() };
    Budget { friction, ..budget }
}

/// The noise of the samples: the standard deviations of the samples, if they have some, otherwise those of the scan; with the correlation
/// that the scan shows.
fn noise_of(track: &Track, channels: &[Vec<f64>; 3], samples: &[Sample], size: [f64; 3]) -> [ChannelNoise; 3] {
    let stated: Option<Vec<_>> = samples.iter().map(|sample| sample.sigma).collect();
    std::array::from_fn(|c| {
        let found = estimate(&track.tau, &channels[c]);
        let stated = stated.as_ref().filter(|stated| !stated.is_empty()).map(|stated| {
            let squares =
                stated.iter().map(|sigma| [sigma.f0x, sigma.f0y, sigma.m0z][c].powi(2)).filter(|v| v.is_finite());
            (squares.sum::<f64>() / stated.len() as f64).sqrt() / size[c]
        });
        ChannelNoise { sigma: stated.unwrap_or(found.sigma), ..found }
    })
}
