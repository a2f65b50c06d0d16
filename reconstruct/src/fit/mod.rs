//! The contour, and the errors that all samples share, that explain a whole recording.
//!
//! Least squares on the forward model: the states of the rod past a free-form contour ([`rod_contact`]) at the poses of the recording are
//! compared with its reactions. A recording is cut at the jumps that it shows, and each segment is followed from an equilibrium of its own
//! (multiple shooting, Bock and Plitt 1984), so that a snap of the model at another pose than that of the recording spoils nothing beyond
//! it. Inside a segment contacts form and let go as the model says: labels of the local answer are where the fit starts, no more.

mod blocks;
mod curve;
mod forward;
mod outline;
mod problem;
#[cfg(test)]
mod tests;
mod verdict;

pub use verdict::{Goodness, WorstWindow};

use crate::least_squares::{Damped, Iterate, iterate};
use crate::phase::Label;
use crate::pipeline::Reconstruction;
use crate::point::{OneSample, one_sample};
use crate::scan::Track;
use crate::systematic::{Correction, Errors, Frame, Source, still};
use blocks::Blocks;
use curve::Curve;
use nalgebra::{DMatrix, DVector, Matrix3, Vector2, Vector3};
use outline::{Touched, outline};
use problem::{Fit, Sources};
use rod_contact::{Contact, ContactKind};
use rod_core::{PhysicalRod, Pose, Reactions, Rod, Sample, Units};
use std::ops::Range;

/// Contours, each with twice as many points as the one before, from 0.03 L on.
const LEVELS: usize = 3;
/// Chi squared over its degrees of freedom above which no finer contour is tried: where the start has the right contacts, the coarsest one
/// leaves 1 to 3. Larger: more time on recordings that nothing explains.
const HOPELESS: f64 = 30.0;
/// Most steps before the smoothness is estimated anew. As a rule 20 are enough; a start that is far off takes 50.
const STEPS: usize = 60;
/// Initial standard deviation of the change of curvature, L^-1.5: a parabola of 5 / L has 10 to 20.
const BEND: f64 = 30.0;
/// Smallest and largest one, L^-1.5: a contour of the size of a hundred rods, and a vertex at each point.
const BENDS: (f64, f64) = (1.0, 1e3);
/// How often it is estimated anew at each contour: a third time changes it by less than a tenth.
const ESTIMATES: usize = 2;
/// Smallest standard deviation of a contact point of the start, rod lengths: none counts more than others by much.
const SURE: f64 = 1e-3;
/// Largest one of a point that a single contact would have where there is no answer, and smallest force over its noise.
const UNSURE: f64 = 0.05;
const CERTAIN: f64 = 6.0;

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The local answer has no contact point.
    #[error("no contact point is known from which a fit could start")]
    NoContacts,
    /// With friction the states of a rod depend on the whole way of the clamp.
    #[error("recordings with friction cannot be fitted")]
    Friction,
    /// The contact points give no curve that the fit could change.
    #[error("the contact points are in no order that gives a contour to start from")]
    NoStart,
}

/// A block of samples against the fit.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedBlock {
    /// The samples from the first to after the last.
    pub samples: Range<usize>,
    /// The phase of the model; none where it is not reached.
    pub label: Option<Label>,
    /// Measured less model for f0x, f0y, m0z, in standard deviations of the mean of the block; none where it is left out (beside a jump) or
    /// not reached.
    pub residuals: Option<[f64; 3]>,
}

/// The contour that explains a recording best, and how well it does.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContourFit {
    /// Points of a cubic spline with natural ends, in the direction of contours, m.
    pub contour: Vec<[f64; 2]>,
    /// Standard deviations of these across the contour, m.
    pub sigmas: Vec<f64>,
    /// The errors that all samples share, in the units of the sources, with their standard deviations; empty where they are not estimated.
    pub errors: Vec<(Source, f64, f64)>,
    /// How well it explains the recording.
    pub goodness: Goodness,
    /// The recording in blocks.
    pub blocks: Vec<FittedBlock>,
}

/// Fits contour and shared errors to the `samples` of a recording, from its local answers `local` on. Of a rod that is not uniform no errors
/// are estimated, and of a uniform one none of its natural curvature.
///
/// First the fit starts from the contact points that are answered; where that does not explain the recording, also from those that single
/// contacts would have wherever there is no answer. A start that explains the recording wins, else the one of lower cost.
///
/// # Errors
/// [`FitError`].
pub fn fit_contour<R: PhysicalRod>(
    rod: &R,
    samples: &[Sample],
    local: &Reconstruction,
) -> Result<ContourFit, FitError> {
    if local.passes.iter().any(|pass| pass.used_friction != 0.0) {
        return Err(FitError::Friction);
    }
    let units = rod.units();
    let uniform = Rod::new(units.length, units.moment * units.length).map_err(|_| FitError::NoStart)?;
    let answered = in_units(Blocks::of(&uniform, samples, local), units);
    let (first, last) = answered.blocks.first().zip(answered.blocks.last()).ok_or(FitError::NoContacts)?;
    let (track, _) = Track::new(&uniform, samples);
    let frame = Frame::of(&track).ok_or(FitError::NoContacts)?.on_way(last.tau - first.tau);
    let (sources, errors) = sources(&uniform, local);
    let recording = Recording { rod, units, frame, sources: &sources, errors };
    let found = recording.fitted(&answered, &touched(local, &uniform), true);
    if found.as_ref().is_ok_and(|solved| solved.goodness.explains) {
        return found.map(|solved| solved.result(&answered, &sources, &uniform));
    }
    let mut singles = answered.clone();
    let mut points = touched(local, &uniform);
    points.extend(recording.fill_with_singles(&mut singles));
    let other = recording.fitted(&singles, &points, false);
    let is_other_better = match (&found, &other) {
        (Ok(found), Ok(other)) => other.goodness.explains || other.cost < found.cost,
        (found, other) => found.is_err() && other.is_ok(),
    };
    let (best, blocks) = if is_other_better { (other, &singles) } else { (found, &answered) };
    best.map(|solved| solved.result(blocks, &sources, &uniform))
}

/// What the fits of a recording from several starts share.
struct Recording<'a, R> {
    rod: &'a R,
    units: Units,
    frame: Frame,
    sources: &'a Sources,
    /// Errors at the start, in standard deviations of their budget.
    errors: DVector<f64>,
}

impl<R: PhysicalRod> Recording<'_, R> {
    /// The fit from a contour through these points on, at finer and finer contours until one explains the recording.
    fn fitted(&self, blocks: &Blocks, points: &[Touched], is_sure: bool) -> Result<Solved, FitError> {
        let Self { rod, units, frame, sources, .. } = *self;
        let points = outline(points, is_sure).ok_or(FitError::NoContacts)?;
        let start = points.iter().map(|point| point * units.length).collect();
        let curve = Curve::through(start).ok_or(FitError::NoContacts)?;
        let states = vec![None; blocks.blocks.len()];
        let mut fit = Fit { rod, curve, blocks, frame, sources, bend: BEND * units.length.powf(-1.5), states };
        let mut best: Option<Solved> = None;
        let mut errors = self.errors.clone();
        for _ in 0..LEVELS {
            let Some(solved) = solve(&mut fit, &errors, units) else { break };
            errors = solved.x.rows(fit.curve.count(), errors.len()).into_owned();
            fit.curve = solved.curve.clone();
            let explains = solved.goodness.explains;
            let ratio = solved.goodness.chi_squared / solved.goodness.degrees_of_freedom;
            if best.as_ref().is_none_or(|best| solved.cost < best.cost || explains) {
                best = Some(solved);
            }
            if explains || ratio > HOPELESS {
                break;
            }
            let Some(finer) = fit.curve.refined() else { break };
            fit.curve = finer;
        }
        best.ok_or(FitError::NoStart)
    }

    /// Gives blocks without an answer the single contact that their reactions would have, and returns those points.
    fn fill_with_singles(&self, blocks: &mut Blocks) -> Vec<Touched> {
        let mut errors = self.sources.known;
        self.sources.free.iter().zip(&self.errors).for_each(|(k, z)| errors[*k] += z * self.sources.sigmas[*k]);
        let Some(correction) = Correction::new(self.frame, &errors) else { return Vec::new() };
        let mut found = Vec::new();
        for block in blocks.blocks.iter_mut().filter(|block| block.contacts.is_empty()) {
            let clamp = correction.apply(block.tau, &block.clamp, &still(block.motion)).0;
            let (pose, [f0x, f0y, m0z]) = (clamp.pose, clamp.reactions.into());
            if clamp.reactions.component_div(&block.sigma).xy().norm() < CERTAIN {
                continue;
            }
            let pose = Pose { x: pose.x * self.units.length, y: pose.y * self.units.length, phi: pose.z };
            let reactions =
                Reactions { f0x: f0x * self.units.force, f0y: f0y * self.units.force, m0z: m0z * self.units.moment };
            let units = self.units;
            let sigma = block.sigma.component_mul(&Vector3::new(units.force, units.force, units.moment));
            let told = one_sample(self.rod, pose, reactions, &Matrix3::from_diagonal(&sigma.component_mul(&sigma)));
            let Some((touch, tip)) =
                told.ok().and_then(|told| Some((told.touch()?, matches!(told, OneSample::Tip(_)))))
            else {
                continue;
            };
            let sigma = touch.sigma_normal() / units.length;
            if sigma > UNSURE {
                continue;
            }
            let kind = if tip { ContactKind::Tip } else { ContactKind::Tangent };
            block.contacts = vec![Contact { kind, s: touch.s.min(self.units.length), ..touch.into() }];
            found.push(Touched {
                at: Vector2::new(touch.x, touch.y) / self.units.length,
                along: Vector2::new(touch.alpha.cos(), touch.alpha.sin()),
                weight: sigma.hypot(SURE).powi(-2),
            });
        }
        found
    }
}

/// A fit at one contour.
struct Solved {
    x: DVector<f64>,
    curve: Curve,
    cost: f64,
    covariance: DMatrix<f64>,
    explained: problem::Explained,
    goodness: Goodness,
}

/// The best offsets and errors at the contour of `fit`, with the smoothness that the recording asks for.
fn solve<R: PhysicalRod>(fit: &mut Fit<'_, R>, errors: &DVector<f64>, units: Units) -> Option<Solved> {
    let (count, free) = (fit.curve.count(), errors.len());
    let mut x = DVector::zeros(count + free);
    x.rows_mut(0, count).copy_from(&fit.curve.offsets);
    x.rows_mut(count, free).copy_from(errors);
    let bends = [BENDS.0, BENDS.1].map(|bend| bend * units.length.powf(-1.5));
    for _ in 0..ESTIMATES {
        let (at, _) = iterate(fit, x.clone(), Damped::default(), STEPS);
        x = at.x;
        if let Some(covariance) = at.equations.covariance() {
            fit.bend = fit.bend_of(&x, &covariance).clamp(bends[0], bends[1]);
        }
    }
    let (Iterate { x, equations }, _) = iterate(fit, x, Damped::default(), STEPS);
    let covariance = equations.covariance()?;
    let model = fit.model(&x)?;
    let explained = fit.explained(&model);
    let problem::Model { curve, states, .. } = model;
    // unknowns that the prior alone determines count for nothing
    let prior = fit.prior(&x, &curve).matrix;
    let determined = x.len() as f64 - (&covariance * prior).trace();
    let samples: Vec<Range<usize>> = fit.blocks.blocks.iter().map(|block| block.samples.clone()).collect();
    let off = |(i, k): (usize, &usize)| (Source::ALL[*k], x[count + i]);
    let farthest = fit.sources.free.iter().enumerate().map(off).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let goodness = Goodness::of(&explained, &samples, determined, farthest);
    fit.states = states;
    Some(Solved { x, curve, cost: equations.cost, covariance, explained, goodness })
}

impl Solved {
    fn result(self, blocks: &Blocks, sources: &Sources, rod: &Rod) -> ContourFit {
        let Self { x, curve, covariance, explained, goodness, .. } = self;
        let count = curve.count();
        let sigma = |i: usize| covariance[(i, i)].max(0.0).sqrt();
        let of_source = |(i, k): (usize, &usize)| {
            let (source, unit, given) = (Source::ALL[*k], Source::ALL[*k].unit(rod), sources.sigmas[*k]);
            (source, (sources.known[*k] + x[count + i] * given) * unit, sigma(count + i) * given * unit)
        };
        let errors: Vec<(Source, f64, f64)> = sources.free.iter().enumerate().map(of_source).collect();
        // the model has the length of the given rod; the true one may have another
        let length = errors.iter().find(|one| one.0 == Source::Length).map_or(1.0, |one| 1.0 + one.1);
        let block = |(k, block): (usize, &blocks::Block)| FittedBlock {
            samples: block.samples.clone(),
            label: explained.labels[k],
            residuals: explained.residuals[k].map(Into::into),
        };
        ContourFit {
            contour: curve.points().map(|[x, y]| [x * length, y * length]).collect(),
            sigmas: (0..count).map(|i| sigma(i) * length).collect(),
            errors,
            goodness,
            blocks: blocks.blocks.iter().enumerate().map(block).collect(),
        }
    }
}

/// The contacts of blocks in SI units of the given rod.
fn in_units(mut blocks: Blocks, units: Units) -> Blocks {
    for contact in blocks.blocks.iter_mut().flat_map(|block| &mut block.contacts) {
        (contact.x, contact.y, contact.s) =
            (contact.x * units.length, contact.y * units.length, contact.s * units.length);
        contact.force *= units.force;
    }
    blocks
}

/// The sources of errors that the local answer had a budget for, and its estimates in standard deviations of that.
fn sources(rod: &Rod, local: &Reconstruction) -> (Sources, DVector<f64>) {
    let (mut sigmas, mut known, mut start) = (Errors::zeros(), Errors::zeros(), Errors::zeros());
    for estimate in local.calibration().iter().flat_map(|calibration| &calibration.sources) {
        // the rod of the model is straight and has no friction
        if !matches!(estimate.source, Source::NaturalCurvature | Source::Friction) {
            let (k, unit) = (estimate.source as usize, estimate.source.unit(rod));
            (sigmas[k], known[k], start[k]) = (estimate.budget / unit, estimate.known / unit, estimate.taken / unit);
        }
    }
    let free: Vec<usize> = (0..sigmas.len()).filter(|k| sigmas[*k] > 0.0).collect();
    let start = DVector::from_iterator(free.len(), free.iter().map(|k| (start[*k] - known[*k]) / sigmas[*k]));
    (Sources { sigmas, known, free }, start)
}

/// The contact points of the local answer, in lengths of its rod.
fn touched(local: &Reconstruction, given: &Rod) -> Vec<Touched> {
    let length = local.calibration().map_or(given.length(), |calibration| calibration.rod(given).length());
    let touches = local.readings.iter().flat_map(|reading| {
        let second = reading.second.and_then(Result::ok);
        reading.touch.ok().into_iter().chain(second)
    });
    let of = |touch: crate::point::Touch| Touched {
        at: Vector2::new(touch.x, touch.y) / length,
        along: Vector2::new(touch.alpha.cos(), touch.alpha.sin()),
        weight: (touch.sigma_normal() / length).hypot(SURE).powi(-2),
    };
    touches.map(of).collect()
}
