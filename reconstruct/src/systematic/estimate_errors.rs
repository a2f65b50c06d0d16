//! The errors that all samples share, from places whose phases are known: least squares with the budget as what is known before.

use super::correction::Frame;
use super::influence::{CorrectionDifferences, criteria_derivatives};
use super::source::{Errors, Joint, SOURCES, Source};
use crate::least_squares::{Iterate, Loss, Problem, Rows, WholeSteps, iterate};
use crate::numeric::{median, robust_sigma};
use crate::phase::{CRITERIA, Criterion, Evidence, Label};
use crate::point::Inverse;
use crate::scan::LocalEstimate;
use nalgebra::{DMatrix, DVector, SVector};

/// Most Gauss-Newton steps, for a result; each weighs the residuals anew.
pub(super) const STEPS: usize = 8;
/// A step below this many prior standard deviations of every source is the last one.
pub(super) const SMALL: f64 = 1e-4;
/// Residuals beyond about this many standard deviations count less and less, because the phase may be wrong.
const OUTLYING: f64 = 3.0;
const LOSS: Loss = Loss::Cauchy(OUTLYING);

/// A place with its phase, as measured.
pub(super) struct LabelledPlace {
    pub tau: f64,
    pub measured: LocalEstimate,
    pub weight: f64,
    pub label: Label,
}

/// What was estimated.
#[derive(Clone, Debug)]
pub(super) struct ErrorEstimate {
    pub errors: Errors,
    /// Factor of their covariance.
    pub factor: Joint,
    /// Its inverse in units of the budget: what the budget and the places tell of the errors.
    pub normal: Joint,
    /// For each criterion, root mean square residual in standard deviations of the noise, 1 at least.
    pub scatter: [f64; CRITERIA],
    /// For each criterion, what is left of it beyond the noise, in parts of what the budget let it be; 0 where noise may have left it, and where
    /// the budget lets it be nothing.
    pub misfit: [f64; CRITERIA],
}

/// The criteria that vanish in a phase, where the zero of the moment has a later one or not.
fn conditions(label: Label, again: bool) -> &'static [Criterion] {
    use Criterion::{F0x, F0y, K, Length, LengthByTip, M0z, Tangent, TangentByTip};
    match label {
        Label::Free => &[F0x, F0y, M0z],
        Label::A if again => &[LengthByTip, TangentByTip],
        Label::A => &[Length, Tangent],
        Label::B => &[K, Tangent],
        Label::BB => &[K],
        Label::BA => &[],
    }
}

/// Smallest part of a budget, root of the sum over all sources, that one place can tell of. Smaller: least squares of noise-free scans,
/// whose condition number is its inverse, lose all digits.
const FINEST: f64 = 1e-10;

/// The first sources are those of a sensor without load.
const WITHOUT_LOAD: usize = Source::BowM0z as usize + 1;

/// A residual: its criterion, its value in standard deviations of the noise, its weight, and its derivatives by the errors.
struct Residual {
    criterion: usize,
    z: f64,
    weight: f64,
    by_errors: SVector<f64, SOURCES>,
}

/// The residuals of the places after a correction by `errors`. Derivatives are by errors in units of `sigmas`.
fn residuals<I: Inverse>(
    rod: &I,
    frame: Frame,
    errors: &Errors,
    sigmas: &Errors,
    places: &[LabelledPlace],
) -> Vec<Residual> {
    // the reactions of a free rod are what the sensor shows without load, whatever gains, stiffness and the others are
    let without_load = errors.map_with_location(|k, _, error| if k < WITHOUT_LOAD { error } else { 0.0 });
    let all = CorrectionDifferences::new(frame, errors, |k| sigmas[k] > 0.0);
    let free = CorrectionDifferences::new(frame, &without_load, |k| k < WITHOUT_LOAD && sigmas[k] > 0.0);
    let Some((all, free)) = all.zip(free) else { return Vec::new() };
    let mut residuals = Vec::with_capacity(2 * places.len());
    for place in places {
        let around = if place.label == Label::Free { &free } else { &all };
        let here = around.here().apply(place.tau, &place.measured.clamp, &place.measured.rate);
        // several contacts that rub need not meet the criterion
        if place.label == Label::BA || place.label == Label::BB && here.0.friction != 0.0 {
            continue;
        }
        let estimate = place.measured.moved(here.0, here.1);
        // neither a free rod nor several contacts tell of the zero of the moment
        let zeros = !matches!(place.label, Label::Free | Label::BB);
        let evidence = if zeros {
            Evidence::of(rod, &estimate)
        } else {
            Evidence::of_sample(rod, &estimate.clamp, &estimate.covariance().diagonal())
        };
        let quantities = evidence.quantities();
        let by = criteria_derivatives(rod, &here, &around.input_derivatives(place.tau, &place.measured), zeros);
        for &criterion in conditions(place.label, evidence.again()) {
            let (c, quantity) = (criterion as usize, quantities[criterion as usize]);
            if !(quantity.sigma.is_finite() && quantity.value.is_finite()) {
                continue;
            }
            let by_errors = by.row(c).transpose().component_mul(sigmas);
            let sigma = quantity.sigma.max(FINEST * by_errors.norm());
            residuals.push(Residual {
                criterion: c,
                z: quantity.value / sigma,
                weight: place.weight,
                by_errors: by_errors / sigma,
            });
        }
    }
    residuals
}

/// What the budget lets each criterion be, in standard deviations of the noise: the median of its places.
fn allowances(residuals: &[Residual]) -> [f64; CRITERIA] {
    std::array::from_fn(|c| {
        let of = residuals.iter().filter(|residual| residual.criterion == c);
        median(of.map(|residual| residual.by_errors.norm()).collect()).unwrap_or(f64::INFINITY)
    })
}

/// Robust root mean square, 1 at least.
pub(super) fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    robust_sigma(values.filter(|value| value.is_finite())).map_or(1.0, |sigma| sigma.max(1.0))
}

/// Robust root mean square of the residuals of each criterion, 1 at least.
fn scatters(residuals: &[Residual]) -> [f64; CRITERIA] {
    std::array::from_fn(|c| {
        let of = residuals.iter().filter(|residual| residual.criterion == c);
        root_mean_square(of.map(|residual| residual.z))
    })
}

/// By how many standard deviations of its own the root mean square of a criterion's residuals exceeds 1 where noise does not explain it.
/// Smaller: scans with few independent places of a phase are called inconsistent by chance.
const BEYOND_CHANCE: f64 = 3.0;
/// Standard deviation of a robust root mean square of so many independent normal values, times the root of their number.
const SPREAD_OF_MEDIAN: f64 = 1.17;

/// The largest root mean square of each criterion's residuals that chance leaves. The weights count places that are independent.
fn largest_by_chance(residuals: &[Residual]) -> [f64; CRITERIA] {
    let mut count = [0.0; CRITERIA];
    residuals.iter().for_each(|residual| count[residual.criterion] += residual.weight);
    count.map(|count| 1.0 + BEYOND_CHANCE * SPREAD_OF_MEDIAN / count.sqrt())
}

/// The robust sum of squares.
fn robust_sum_of_squares(residuals: &[Residual], scatter: &[f64; CRITERIA]) -> f64 {
    let square = |r: &Residual| {
        let z = r.z / (OUTLYING * scatter[r.criterion]);
        r.weight * OUTLYING * OUTLYING * (z * z).ln_1p()
    };
    residuals.iter().map(square).sum()
}

/// What is known of the errors before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prior {
    pub means: Errors,
    /// Standard deviations; an error with 0 keeps its mean.
    pub sigmas: Errors,
}

/// The errors as a least-squares problem: their prior, and the residuals of the places with Cauchy's loss, whose scale is estimated with them.
struct ErrorProblem<'a, I> {
    rod: &'a I,
    frame: Frame,
    prior: &'a Prior,
    /// The sources that are not known exactly; the unknowns are these errors, in prior standard deviations off their means.
    free: &'a [usize],
    places: &'a [LabelledPlace],
    /// Smallest scatter of each criterion to be expected, in standard deviations of the noise.
    least: &'a [f64; CRITERIA],
    /// Of the residuals where the equations were last asked for.
    residuals: Vec<Residual>,
    scatter: [f64; CRITERIA],
}

impl<I> ErrorProblem<'_, I> {
    /// The errors in prior standard deviations.
    fn prior_deviations(&self, x: &DVector<f64>) -> Errors {
        let mut z = Errors::zeros();
        self.free.iter().zip(x.iter()).for_each(|(k, x)| z[*k] = *x);
        z
    }

    fn errors(&self, x: &DVector<f64>) -> Errors {
        self.prior.means + self.prior_deviations(x).component_mul(&self.prior.sigmas)
    }
}

impl<I: Inverse> Problem for ErrorProblem<'_, I> {
    type Equations = Rows;

    fn equations(&mut self, x: &DVector<f64>) -> Rows {
        self.residuals = residuals(self.rod, self.frame, &self.errors(x), &self.prior.sigmas, self.places);
        self.scatter = scatters(&self.residuals);
        self.scatter.iter_mut().zip(self.least).for_each(|(scatter, least)| *scatter = scatter.max(*least));
        let count = self.free.len();
        let mut rows = DMatrix::<f64>::zeros(count + self.residuals.len(), count);
        let mut right = DVector::<f64>::zeros(count + self.residuals.len());
        rows.view_mut((0, 0), (count, count)).fill_with_identity();
        right.rows_mut(0, count).copy_from(&-x);
        for (row, residual) in self.residuals.iter().enumerate() {
            let by = 1.0 / self.scatter[residual.criterion];
            let off = residual.z * by;
            let weight = LOSS.weight(residual.weight, off).sqrt();
            let of = self.free.iter().enumerate();
            of.for_each(|(i, k)| rows[(count + row, i)] = residual.by_errors[*k] * (weight * by));
            right[count + row] = -weight * off;
        }
        Rows::from_rows(rows, right)
    }
}

/// The errors that agree best with what is known before and with what the phases of the places require, from `start` on.
///
/// `least` are the smallest residuals of each criterion to be expected, in standard deviations of the noise, and `steps` the most
/// Gauss-Newton steps.
pub(super) fn estimate_errors<I: Inverse>(
    rod: &I,
    frame: Frame,
    prior: &Prior,
    start: &Errors,
    places: &[LabelledPlace],
    least: &[f64; CRITERIA],
    steps: usize,
) -> ErrorEstimate {
    let Prior { means, sigmas } = prior;
    let free: Vec<usize> = (0..SOURCES).filter(|k| sigmas[*k] > 0.0).collect();
    let x = DVector::from_iterator(free.len(), free.iter().map(|k| (start[*k] - means[*k]) * (1.0 / sigmas[*k])));
    let mut problem =
        ErrorProblem { rod, frame, prior, free: &free, places, least, residuals: Vec::new(), scatter: [1.0; CRITERIA] };
    let (Iterate { x, equations }, _) = iterate(&mut problem, x, WholeSteps::until(SMALL), steps);
    // R^T R is what budget and places tell of the errors
    let mut upper = Joint::identity();
    for (i, k) in free.iter().enumerate() {
        (i..free.len()).for_each(|j| upper[(*k, free[j])] = equations.triangle[(i, j)]);
    }
    // the covariance is (R^T R)^-1 = R^-1 R^-T
    let inverse = upper.solve_upper_triangular(&Joint::identity()).unwrap_or_else(Joint::identity);
    let factor = Joint::from_diagonal(sigmas) * inverse;
    let normal = upper.transpose() * upper;
    let here = &problem.residuals;
    let (own, allowed, chance) = (scatters(here), allowances(here), largest_by_chance(here));
    let misfit = std::array::from_fn(|c| {
        let excess = (own[c] * own[c] - 1.0).sqrt();
        if own[c] > chance[c] && allowed[c] > 0.0 { excess / allowed[c] } else { 0.0 }
    });
    ErrorEstimate { errors: problem.errors(&x), factor, normal, scatter: problem.scatter, misfit }
}

/// The robust sum of squares with these errors; residuals are expected to be as large as those that were found leave.
pub(super) fn misfit_of<I: Inverse>(
    rod: &I,
    frame: Frame,
    sigmas: &Errors,
    errors: &Errors,
    found: &ErrorEstimate,
    places: &[LabelledPlace],
) -> f64 {
    robust_sum_of_squares(&residuals(rod, frame, errors, sigmas, places), &found.scatter)
}
