//! The best contour and errors from a start on.

use super::blocks::{Block, Blocks};
use super::curve::Curve;
use super::outline::{Touched, outline};
use super::problem::{Explained, Fit, Model, Sources};
use super::verdict::Goodness;
use super::{ContourFit, FitError, FittedBlock};
use crate::least_squares::{Damped, Iterate, iterate};
use crate::systematic::Source;
use nalgebra::{DMatrix, DVector};
use rod_core::{PhysicalRod, Rod};
use std::ops::Range;

/// Contours, each with twice as many points as the one before, from 0.03 L on.
const LEVELS: usize = 3;
/// Chi squared over its degrees of freedom above which no finer contour is tried: in the tests the coarsest one leaves 1 to 2. Larger: more time
/// on recordings that nothing explains.
const HOPELESS: f64 = 30.0;
/// Most steps before the smoothness is estimated anew. The fits of the tests take up to 55.
const STEPS: usize = 60;
/// Initial standard deviation of the change of curvature, L^-1.5: the contour of O2 in the tests comes out at 12 to 18.
const BEND: f64 = 30.0;
/// Smallest and largest one, L^-1.5: a contour of the size of a hundred rods, and a vertex at each point.
const BENDS: (f64, f64) = (1.0, 1e3);
/// How often it is estimated anew at each contour. More: more time.
const ESTIMATES: usize = 2;

/// What the fits of a recording from several starts share.
pub(super) struct Recorded<'a, R> {
    pub rod: &'a R,
    pub sources: &'a Sources,
    /// Errors at the start less what is known of them, in standard deviations of their budget.
    pub errors: &'a DVector<f64>,
}

impl<R: PhysicalRod> Recorded<'_, R> {
    /// The fit from a contour through these points on, at finer and finer contours until one explains the recording.
    pub fn fitted(&self, blocks: &Blocks, points: &[Touched], is_sure: bool) -> Result<Solved, FitError> {
        let Self { rod, sources, .. } = *self;
        let units = rod.units();
        let points = outline(points, is_sure).ok_or(FitError::NoContacts)?;
        let start = points.iter().map(|point| point * units.length).collect();
        let curve = Curve::through(start).ok_or(FitError::NoContacts)?;
        let states = vec![None; blocks.blocks.len()];
        let mut fit = Fit { rod, curve, blocks, sources, bend: BEND * units.length.powf(-1.5), states };
        let mut best: Option<Solved> = None;
        let mut errors = self.errors.clone();
        for _ in 0..LEVELS {
            let Some(solved) = solve(&mut fit, &errors) else { break };
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
}

/// A fit at one contour.
pub(super) struct Solved {
    x: DVector<f64>,
    curve: Curve,
    pub cost: f64,
    covariance: DMatrix<f64>,
    explained: Explained,
    pub goodness: Goodness,
}

/// The best offsets and errors at the contour of `fit`, with the smoothness that the recording asks for.
fn solve<R: PhysicalRod>(fit: &mut Fit<'_, R>, errors: &DVector<f64>) -> Option<Solved> {
    let (count, free) = (fit.curve.count(), errors.len());
    let mut x = DVector::zeros(count + free);
    x.rows_mut(0, count).copy_from(&fit.curve.offsets);
    x.rows_mut(count, free).copy_from(errors);
    let bends = [BENDS.0, BENDS.1].map(|bend| bend * fit.rod.units().length.powf(-1.5));
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
    let Model { curve, states, .. } = model;
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
    pub fn result(self, blocks: &Blocks, sources: &Sources, rod: &Rod) -> ContourFit {
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
        let block = |(k, block): (usize, &Block)| FittedBlock {
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
