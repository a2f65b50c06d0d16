//! The contour, and the errors that all samples share, that explain a whole recording.
//!
//! Least squares on the forward model: the states of the rod past a free-form contour ([`rod_contact`]) at the poses of the recording are
//! compared with its reactions. A recording is cut at the jumps that it shows, and each segment is followed from an equilibrium of its own
//! (multiple shooting, Bock and Plitt 1984), so that a snap of the model at another pose than that of the recording spoils nothing beyond
//! it. Inside a segment contacts form and let go as the model says: labels of the local answer are where the fit starts, no more.

mod answers;
mod bent;
mod blocks;
mod contact_rates;
mod curve;
mod distinct;
mod doubt;
mod ends;
mod family;
mod finer;
mod flatten;
mod forward;
mod grow;
mod jumps;
mod kinks;
mod knowledge;
mod means;
mod needed;
mod order;
mod outline;
mod pair;
mod piece;
mod posterior;
mod prior;
mod problem;
mod propose;
mod simple;
mod solve;
mod start;
mod swept;
#[cfg(test)]
mod tests;
mod trim;
mod verdict;

pub use family::ShapeKind;
pub use knowledge::Knowledge;
pub use simple::SimpleShape;
pub use verdict::{Goodness, WorstWindow};

use crate::phase::Label;
use crate::pipeline::{Reading, Reconstruction};
use crate::systematic::{BEYOND, Source};
use blocks::Blocks;
use nalgebra::{DVector, Vector2};
use needed::{with_fewest_errors, with_friction};
use piece::Piece;
use problem::Sources;
use rod_contours::{Composite, Contour as _, ContourError};
use rod_core::{PhysicalRod, Rod, Sample};
use solve::{Search, Solved};
use start::{Start, starts};
use std::ops::Range;

/// Most evaluations of the model at all poses of a recording, each of milliseconds. Larger: more time on recordings that nothing explains; smaller:
/// those with many contacts are given up.
const MOST_EVALUATIONS: usize = 600;
/// The same without errors that all samples share, where these may not be needed; and once more from the contour that was found.
const WITHOUT_ERRORS: usize = 500;
const AGAIN: usize = 200;
/// Most evaluations for the starts that first explain a part of a recording, and then more and more of it.
const GROWING: usize = 1500;
/// An error that is so many standard deviations of its budget off what is known of it may make up for a contour that is wrong: then a fit starts anew, so often
/// at most. Smaller: more time on recordings whose errors are as large as they may be.
const FAR: f64 = 2.0;
const SETTLINGS: usize = 3;

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The local answer has no contact point.
    #[error("no contact point is known, so that the fit has no start")]
    NoContacts,
    /// Each sample tells its contact point more exactly than the points of a spline can.
    #[error("without noise the contact points of the single samples are more accurate than a fit")]
    Exact,
    /// The contact points give no curve that the fit could change.
    #[error("the contact points have no order along a contour, so that the fit has no start")]
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

/// A part of the contour: a cubic spline with natural ends through points in the direction of contours, cut at its vertices.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedObject {
    /// Points, m.
    pub points: Vec<[f64; 2]>,
    /// Numbers of the points at which smooth pieces meet at an angle.
    pub vertices: Vec<usize>,
    /// What is known of the contour at each point.
    pub known: Vec<Knowledge>,
}

impl FittedObject {
    /// The part as a shape.
    ///
    /// # Errors
    /// [`ContourError`], where numbers that were changed by hand give no contour.
    pub fn contour(&self) -> Result<Composite, ContourError> {
        let pieces = self.pieces().map(|piece| piece?.contour()).collect::<Result<_, ContourError>>()?;
        Composite::new(pieces)
    }

    /// Places along the part, m: for each interval from a point to the next, `count` from its beginning on, and its end.
    ///
    /// # Errors
    /// As [`FittedObject::contour`].
    pub fn intervals(&self, count: usize) -> Result<Vec<Vec<[f64; 2]>>, ContourError> {
        let mut intervals = Vec::new();
        for piece in self.pieces() {
            let piece = piece?;
            for knots in piece.knots().windows(2) {
                let share = |k: usize| k as f64 / count.max(1) as f64;
                let place = |k: usize| piece.spline.frame(knots[0] + share(k) * (knots[1] - knots[0]));
                intervals.push((0..=count).map(place).map(|frame| [frame.x, frame.y]).collect());
            }
        }
        Ok(intervals)
    }

    /// The smooth pieces.
    fn pieces(&self) -> impl Iterator<Item = Result<Piece, ContourError>> {
        let cuts = std::iter::once(0).chain(self.vertices.iter().copied());
        let ends = self.vertices.iter().copied().chain([self.points.len().saturating_sub(1)]);
        cuts.zip(ends).map(|(from, to)| {
            let points: Vec<Vector2<f64>> =
                self.points.get(from..=to).unwrap_or_default().iter().map(|point| (*point).into()).collect();
            Piece::through(&points, from, 0, 0)
        })
    }
}

/// The contour that explains a recording best, and how well it does.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContourFit {
    /// What was touched, as far as it hangs together.
    pub objects: Vec<FittedObject>,
    /// Simple shapes that explain an object as well, the best of each object first; none where no contour explains the recording.
    pub shapes: Vec<SimpleShape>,
    /// The errors that all samples share which the recording asks for, in the units of the sources, with their standard deviations, in which others may
    /// be in their place; all others are as they are known. Empty where none is needed.
    pub errors: Vec<(Source, f64, f64)>,
    /// How well it explains the recording.
    pub goodness: Goodness,
    /// The recording in blocks.
    pub blocks: Vec<FittedBlock>,
    /// Number of samples that are left out because the free rod rings after a jump.
    pub ringing: usize,
    /// The answer to each sample by the states of the rod past the contour; none where it is not reached, and where the contour does not explain
    /// the recording. They are not a part of serialised data.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub readings: Vec<Option<Reading>>,
    /// Length of the given rod, m.
    pub length: f64,
}

impl ContourFit {
    /// The coefficient of friction that the recording asks for, with its standard deviation, in which other errors may be in its place: if it is more than three
    /// of them. None where a smaller one, or none, explains the recording.
    pub fn friction_beside_errors(&self) -> Option<(f64, f64)> {
        let (_, mu, sigma) = self.errors.iter().find(|error| error.0 == Source::Friction)?;
        (mu.abs() > BEYOND * sigma).then_some((*mu, *sigma))
    }

    /// Samples along which the model has one phase, in order; none where it is not reached.
    pub fn runs(&self) -> Vec<(Range<usize>, Option<Label>)> {
        let mut runs: Vec<(Range<usize>, Option<Label>)> = Vec::new();
        for block in &self.blocks {
            match runs.last_mut().filter(|run| run.1 == block.label) {
                Some(run) => run.0.end = block.samples.end,
                None => runs.push((block.samples.clone(), block.label)),
            }
        }
        runs
    }
}

/// Fits contour and shared errors to the `samples` of a recording, from its local answers `local` on; see [`fit_contours`].
///
/// # Errors
/// [`FitError`].
pub fn fit_contour<R: PhysicalRod>(
    rod: &R,
    samples: &[Sample],
    local: &Reconstruction,
) -> Result<ContourFit, FitError> {
    fit_contours(rod, &[(samples, local)])?.pop().ok_or(FitError::NoStart)
}

/// Fits one contour to the samples of several recordings of one object, with one rod in one frame, from their answers so far on. Each recording has a bias
/// and a drift of its own; all other errors (of rod, sensor, clamp and stage) are those of all recordings. The fit to each recording is the same but for its
/// errors, blocks, answers and goodness. All recordings are explained, or none. Errors are estimated if the local answer
/// corrects some, or no contour explains the recording without; that of the natural curvature counts to first order. Of those only the ones stay free
/// that the recording asks for, by evidence.
///
/// The fit starts from the contact points that are answered, taken in several ways for a contour, and from those that single contacts would have
/// wherever there is no answer. The first start that explains the recording well wins, else the most probable one.
///
/// # Errors
/// [`FitError`].
pub fn fit_contours<R: PhysicalRod>(
    rod: &R,
    recordings: &[(&[Sample], &Reconstruction)],
) -> Result<Vec<ContourFit>, FitError> {
    let locals: Vec<&Reconstruction> = recordings.iter().map(|(_, local)| *local).collect();
    if recordings.iter().all(|(samples, local)| blocks::is_exact(rod.units(), samples, local)) {
        return Err(FitError::Exact);
    }
    let units = rod.units();
    let uniform = Rod::new(units.length, units.moment * units.length).map_err(|_| FitError::NoStart)?;
    let of_recording = |(samples, local): &(&[Sample], &Reconstruction)| Blocks::of(&uniform, samples, local);
    let blocks = recordings.iter().map(of_recording).reduce(|all, one| Some(all?.and(one?)));
    let blocks = blocks.flatten().ok_or(FitError::NoContacts)?;
    let (sources, errors) = Sources::of(&uniform, &locals, |estimate| estimate.taken);
    let starts_by = |errors| starts(rod, &uniform, &locals, blocks.clone(), &sources.errors(errors));
    let starts = starts_by(&errors);
    if starts.is_empty() {
        return Err(FitError::NoContacts);
    }
    let exact = sources.exact();
    // errors that the recording does not ask for would move its contour as far as they are uncertain
    let are_free = locals.iter().any(|local| local.is_corrected()) || sources.free.len() == exact.free.len();
    let (first, at_first, evaluations) = match are_free {
        true => (&sources, errors.clone(), MOST_EVALUATIONS),
        false => (&exact, sources.of_free(&errors, &exact), WITHOUT_ERRORS),
    };
    let search = Search { rod, sources: first, errors: &at_first, evaluations };
    let (mut best, mut blocks) = best_of(&starts, search).ok_or(FitError::NoStart)?;
    let mut used = first;
    if !are_free && !best.goodness.explains {
        let mut search = Search { rod, sources: &sources, errors: &errors, evaluations: AGAIN };
        if let Some(found) = search.resumed(&best, blocks) {
            (best, used) = (found, &sources);
        }
    }
    best = settled(rod, used, best, blocks);
    // the local answer corrects no more than it needs; its estimates of all errors are another start
    let estimates = Sources::of(&uniform, &locals, |estimate| estimate.value).1;
    let is_needed = !best.goodness.explains && !best.is_near() && estimates != errors;
    let mut others = if is_needed { starts_by(&estimates) } else { Vec::new() };
    others.retain(Start::is_whole);
    let search = Search { rod, sources: &sources, errors: &estimates, evaluations: MOST_EVALUATIONS };
    if let Some((found, its)) = best_of(&others, search) {
        let found = settled(rod, &sources, found, its);
        if found.preferred(&best).is_lt() {
            (best, blocks, used) = (found, its, &sources);
        }
    }
    let samples: Vec<Sample> = recordings.iter().flat_map(|(samples, _)| *samples).copied().collect();
    // errors may be in the place of friction that was not asked for
    let may_rub = !used.is_rough && !used.free.is_empty() && best.is_near();
    let rubbing = if may_rub { with_friction(rod, used, &best, blocks) } else { None };
    let (best, used) = rubbing.unwrap_or_else(|| (best, used.clone()));
    let is_explained_by_errors = best.goodness.explains && !used.free.is_empty();
    let fewer = if is_explained_by_errors { with_fewest_errors(rod, &used, &best, blocks) } else { None };
    let (best, used) = fewer.unwrap_or((best, used));
    // other errors may be in the place of friction also where none is needed
    let best = best.with_least_spread(&used.least_spread(&locals));
    Ok(best.results(rod, &samples, blocks, &used, &uniform))
}

/// A fit whose errors have settled. While a contour is far off, its prior draws it to where it started, and errors far off what is known of them make up
/// for it. So the fit starts anew from the contour that was found and the errors that are known, as long as that is better.
fn settled<'a, R: PhysicalRod>(rod: &'a R, sources: &'a Sources, mut best: Solved, blocks: &'a Blocks) -> Solved {
    for _ in 0..SETTLINGS {
        let is_far = best.goodness.farthest_error.is_some_and(|error| error.1.abs() > FAR);
        if !best.is_near() || best.goodness.explains && !is_far {
            break;
        }
        let errors = if is_far { DVector::zeros(sources.free.len()) } else { best.errors() };
        let mut search = Search { rod, sources, errors: &errors, evaluations: AGAIN };
        let found = best.curve_anew().and_then(|curve| search.continued(&curve, &best, blocks));
        match found.filter(|found| found.preferred(&best).is_lt()) {
            Some(found) => best = found,
            None => break,
        }
    }
    best
}

/// The best fit from some starts: the first that explains the recording well, else the most probable one of those that explain it, or the one of lowest cost of
/// all. Starts that first explain a part of it come last, where none explains it, with evaluations of their own.
fn best_of<'a, R: PhysicalRod>(starts: &'a [Start], mut search: Search<'a, R>) -> Option<(Solved, &'a Blocks)> {
    let (whole, parts): (Vec<&Start>, Vec<&Start>) = starts.iter().partition(|start| start.is_whole());
    let mut best = None;
    search_from(&whole, &mut search, &mut best);
    if best.as_ref().is_none_or(|best| !best.0.goodness.explains) {
        search.evaluations = GROWING;
        search_from(&parts, &mut search, &mut best);
    }
    best
}

/// Searches from some starts, the most promising first, until a fit explains the recording well.
fn search_from<'a, R: PhysicalRod>(
    starts: &[&'a Start],
    search: &mut Search<'a, R>,
    best: &mut Option<(Solved, &'a Blocks)>,
) {
    let is_done = |best: &Option<(Solved, &Blocks)>| best.as_ref().is_some_and(|best| best.0.goodness.explains_well());
    let mut begun = Vec::new();
    for start in starts {
        if is_done(best) {
            return;
        }
        match search.begun(start) {
            Some(one) if one.solved.is_near() => search.improve(one, best),
            one => begun.extend(one),
        }
    }
    begun.sort_by(|a, b| a.solved.preferred(&b.solved));
    for one in begun {
        if is_done(best) {
            return;
        }
        search.improve(one, best);
    }
}
