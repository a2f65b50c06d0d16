//! The shape of a rod at rest, from frames in which nothing touches it.

use super::check::check;
use super::choose::BEYOND_CHANCE;
use super::fault::FrameFault;
use super::noise::SETTLED;
use super::observation::{Frame, SeenPoint};
use super::problem::MOST_WAY;
use super::rest_curve::Curve;
use super::scatter::{LEAST, scatter};
use crate::least_squares::{Damped, NormalMatrix, Problem, iterate};
use crate::numeric::chi_squared::wilson_hilferty;
use crate::numeric::legendre;
use nalgebra::{DMatrix, DVector};

/// Most Legendre polynomials of a curvature.
const MOST_TERMS: usize = 8;
/// How many times terms and noise are found in turn.
const ROUNDS: usize = 3;
const MOST_STEPS: usize = 60;

/// Why frames give no shape at rest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RestError {
    /// No frame shows enough.
    #[error(
        "no frame has 5 points or more and shows an end of the rod, expected frames of the free rod of 5 points or more each"
    )]
    NoFrames,
    /// A frame cannot be used.
    #[error("frame {index} (from 0): {fault}")]
    Frame {
        /// Its number, from 0.
        index: usize,
        /// Why.
        fault: FrameFault,
    },
    /// No curvature explains the frames.
    #[error(
        "no curvature at rest was found that fits the frames: is this the rod of the film, and is it free in all frames?"
    )]
    NoShape,
}

/// The curvature of a rod at rest, by Legendre polynomials.
#[derive(Clone, Debug, PartialEq)]
pub struct RestShape {
    /// Length of the rod, m.
    pub length: f64,
    /// Coefficients of P_j(2 s / length - 1), 1/m.
    pub coefficients: Vec<f64>,
    /// Their covariance, row by row.
    pub covariance: Vec<Vec<f64>>,
    /// Standard deviation of the coordinates of points, m.
    pub sigma: f64,
    /// Chi squared of all frames, and its degrees of freedom.
    pub chi_squared: f64,
    /// Degrees of freedom.
    pub freedom: usize,
    /// Number of frames.
    pub frames: usize,
    /// The frame (from 0) that has another shape than the others, by more than chance, if there is one.
    pub other: Option<usize>,
}

impl RestShape {
    /// The curvature at an arc length (m), 1/m, with its standard deviation.
    pub fn curvature(&self, s: f64) -> (f64, f64) {
        let mut values = vec![0.0; self.coefficients.len()];
        legendre::values(2.0 * s / self.length - 1.0, &mut values);
        let sum = |row: &[f64]| row.iter().zip(&values).map(|(c, p)| c * p).sum::<f64>();
        let variance = self.covariance.iter().zip(&values).map(|(row, p)| p * sum(row)).sum::<f64>();
        (sum(&self.coefficients), variance.max(0.0).sqrt())
    }

    /// Coefficients that are off by one standard deviation, in independent directions.
    pub fn variations(&self) -> Vec<Vec<f64>> {
        let n = self.coefficients.len();
        let covariance = DMatrix::from_fn(n, n, |i, j| self.covariance[i][j]);
        let eigen = covariance.symmetric_eigen();
        let vary = |k: usize| {
            let size = eigen.eigenvalues[k].max(0.0).sqrt();
            (0..n).map(|i| self.coefficients[i] + size * eigen.eigenvectors[(i, k)]).collect()
        };
        (0..n).map(vary).collect()
    }
}

/// The curvature at rest that explains all `frames` of a rod of `length` (m) together, with the fewest terms; each frame has a pose of its own.
///
/// `sigma` is the standard deviation of the coordinates of the points (m), found from the frames where it is not given.
///
/// # Errors
/// [`RestError`].
pub fn rest_shape(length: f64, frames: &[Frame], sigma: Option<f64>) -> Result<RestShape, RestError> {
    // a frame of which neither end was seen does not say where along the rod its points are
    let is_usable = |frame: &&Frame| frame.points.len() >= 5 && (frame.base_is_first || frame.tip_is_last);
    let usable: Vec<&Frame> = frames.iter().filter(is_usable).collect();
    if usable.is_empty() {
        return Err(RestError::NoFrames);
    }
    for (index, frame) in frames.iter().enumerate().filter(|(_, frame)| is_usable(frame)) {
        check(length, frame, f64::INFINITY).map_err(|fault| RestError::Frame { index, fault })?;
    }
    let mut noise = sigma.map_or_else(|| scatter(usable.iter().copied(), length), |sigma| sigma / length);
    let mut best = None;
    for _ in 0..ROUNDS {
        let found = terms(length, &usable, noise).ok_or(RestError::NoShape)?;
        let ratio = (found.cost / found.freedom.max(1) as f64).sqrt();
        let is_settled = sigma.is_some() || (ratio - 1.0).abs() < SETTLED;
        best = Some(found);
        if is_settled {
            break;
        }
        noise = (noise * ratio).max(LEAST);
    }
    let Solved { coefficients, covariance, cost, freedom } = best.ok_or(RestError::NoShape)?;
    let rows = (0..coefficients.len()).map(|i| covariance.row(i).iter().map(|v| v / (length * length)).collect());
    Ok(RestShape {
        length,
        covariance: rows.collect(),
        coefficients: coefficients.iter().map(|c| c / length).collect(),
        sigma: noise * length,
        chi_squared: cost,
        freedom,
        frames: usable.len(),
        other: other_shape(length, &usable, noise, &coefficients)
            .and_then(|other| frames.iter().position(|frame| std::ptr::eq(frame, usable[other]))),
    })
}

/// The frame whose own shape explains it best in place of the common one, if all own shapes together explain so much more that chance does not.
fn other_shape(length: f64, frames: &[&Frame], sigma: f64, coefficients: &DVector<f64>) -> Option<usize> {
    let terms = coefficients.len();
    let (mut own, mut freedom, mut worst) = (0.0, 0, (0, 0.0));
    let mut common = 0.0;
    for (index, frame) in frames.iter().enumerate() {
        let alone = solve(length, &[frame], sigma, coefficients)?;
        let mut problem = Rest { films: vec![Dots::of(frame, length, sigma)], terms, freedom: 0 };
        let pose = problem.films[0].pose;
        let held = Held { rest: &mut problem, coefficients };
        let together = held.cost(pose)?;
        own += alone.cost;
        freedom += alone.freedom;
        common += together;
        if together - alone.cost > worst.1 {
            worst = (index, together - alone.cost);
        }
    }
    let more = (frames.len() - 1) * terms;
    if more == 0 || freedom == 0 {
        return None;
    }
    // in units of the noise that own shapes leave
    let gain = (common - own) / (own / freedom as f64);
    (gain > wilson_hilferty(more, BEYOND_CHANCE)).then_some(worst.0)
}

/// A frame with a curvature that is given: only its pose is unknown.
struct Held<'a> {
    rest: &'a mut Rest,
    coefficients: &'a DVector<f64>,
}

impl Held<'_> {
    /// What the best pose leaves, from one nearby on.
    fn cost(mut self, pose: [f64; 3]) -> Option<f64> {
        let (at, _) = iterate(&mut self, DVector::from_column_slice(&pose), Damped::default(), MOST_STEPS);
        Some(self.equations(&at.x).cost).filter(|cost| cost.is_finite())
    }
}

impl Problem for Held<'_> {
    type Equations = NormalMatrix;

    fn equations(&mut self, pose: &DVector<f64>) -> NormalMatrix {
        let terms = self.coefficients.len();
        let all = DVector::from_iterator(terms + 3, self.coefficients.iter().chain(pose).copied());
        let NormalMatrix { matrix, gradient, cost } = self.rest.equations(&all);
        NormalMatrix {
            matrix: matrix.view((terms, terms), (3, 3)).into_owned(),
            gradient: gradient.rows(terms, 3).into_owned(),
            cost,
        }
    }
}

/// Coefficients with a number of terms, dimensionless.
struct Solved {
    coefficients: DVector<f64>,
    covariance: DMatrix<f64>,
    cost: f64,
    freedom: usize,
}

/// As many terms as chance does not explain: where one more is not worth it, the next but one may be.
fn terms(length: f64, frames: &[&Frame], sigma: f64) -> Option<Solved> {
    let mut best = solve(length, frames, sigma, &DVector::zeros(1))?;
    while best.coefficients.len() < MOST_TERMS {
        let count = best.coefficients.len();
        let more = (1..=2).filter(|more| count + more <= MOST_TERMS).find_map(|more| {
            let start = best.coefficients.clone().resize_vertically(count + more, 0.0);
            let next = solve(length, frames, sigma, &start)?;
            (best.cost - next.cost > wilson_hilferty(more, BEYOND_CHANCE)).then_some(next)
        });
        match more {
            Some(next) => best = next,
            None => break,
        }
    }
    Some(best)
}

fn solve(length: f64, frames: &[&Frame], sigma: f64, start: &DVector<f64>) -> Option<Solved> {
    let films: Vec<Dots> = frames.iter().map(|frame| Dots::of(frame, length, sigma)).collect();
    let mut problem = Rest { films, terms: start.len(), freedom: 0 };
    let poses = problem.films.iter().flat_map(|dots| dots.pose);
    let x = DVector::from_iterator(start.len() + 3 * frames.len(), start.iter().copied().chain(poses));
    let (mut at, _) = iterate(&mut problem, x, Damped::default(), MOST_STEPS);
    at.equations = problem.equations(&at.x);
    let terms = start.len();
    let covariance = at.equations.covariance()?.view((0, 0), (terms, terms)).into_owned();
    Some(Solved {
        coefficients: at.x.rows(0, terms).into_owned(),
        covariance,
        cost: at.equations.cost,
        freedom: problem.freedom.saturating_sub(at.x.len()),
    })
}

/// The points of a frame, lengths in L.
struct Dots {
    at: Vec<[f64; 2]>,
    sigma: Vec<f64>,
    feet: Vec<f64>,
    /// Whether the first one is the base; otherwise the last one is the tip.
    from_base: bool,
    pose: [f64; 3],
}

impl Dots {
    fn of(frame: &Frame, length: f64, sigma: f64) -> Self {
        let at: Vec<[f64; 2]> = frame.points.iter().map(|&SeenPoint { x, y, .. }| [x / length, y / length]).collect();
        let mut feet = vec![0.0; at.len()];
        for k in 1..at.len() {
            feet[k] = feet[k - 1] + (at[k][0] - at[k - 1][0]).hypot(at[k][1] - at[k - 1][1]);
        }
        let from_base = frame.base_is_first;
        let last = feet[at.len() - 1];
        feet.iter_mut().for_each(|foot| *foot = (*foot + if from_base { 0.0 } else { 1.0 - last }).clamp(0.0, 1.0));
        let near = (at.len() / 5).max(1);
        let phi = (at[near][1] - at[0][1]).atan2(at[near][0] - at[0][0]);
        // back to the base along the tangent
        let back = feet[0];
        let pose = [at[0][0] - back * phi.cos(), at[0][1] - back * phi.sin(), phi];
        Self {
            sigma: frame.points.iter().map(|p| p.sigma.map_or(sigma, |own| own / length)).collect(),
            at,
            feet,
            from_base,
            pose,
        }
    }
}

/// All frames: the unknowns are the coefficients, and of each frame the pose of its base.
struct Rest {
    films: Vec<Dots>,
    terms: usize,
    freedom: usize,
}

impl Problem for Rest {
    type Equations = NormalMatrix;

    fn equations(&mut self, x: &DVector<f64>) -> NormalMatrix {
        let curve = Curve::of(&x.as_slice()[..self.terms]);
        let mut normal = NormalMatrix::empty(x.len());
        self.freedom = 0;
        for (number, dots) in self.films.iter_mut().enumerate() {
            let first = self.terms + 3 * number;
            let (sin0, cos0) = x[first + 2].sin_cos();
            let turn = |[a, b]: [f64; 2]| [a * cos0 - b * sin0, a * sin0 + b * cos0];
            let last = dots.at.len() - 1;
            for (k, point) in dots.at.iter().enumerate() {
                let is_held = if dots.from_base { k == 0 } else { k == last };
                let foot = dots.feet[k];
                let spot = curve.at(foot);
                let [rx, ry] = turn([spot.x, spot.y]);
                let left = [x[first] + rx - point[0], x[first + 1] + ry - point[1]];
                let (sin, cos) = (spot.phi + x[first + 2]).sin_cos();
                let ahead = -(left[0] * cos + left[1] * sin);
                let mut add = |along: [f64; 2], residual: f64, slope: f64| {
                    let rates = spot.by.iter().zip(&spot.turns).map(|(by, turns)| {
                        let [a, b] = turn(*by);
                        along[0] * a + along[1] * b + slope * turns
                    });
                    let mut row: Vec<(usize, f64)> = rates.enumerate().collect();
                    let spin = along[0] * -ry + along[1] * rx + slope;
                    row.extend([(first, along[0]), (first + 1, along[1]), (first + 2, spin)]);
                    normal.add(&row, residual, dots.sigma[k]);
                    self.freedom += 1;
                };
                if is_held {
                    add([1.0, 0.0], left[0], 0.0);
                    add([0.0, 1.0], left[1], 0.0);
                } else {
                    // the residual across the rod; the tangent turns with the unknowns
                    add([-sin, cos], cos * left[1] - sin * left[0], ahead);
                    dots.feet[k] = (foot + ahead.clamp(-MOST_WAY, MOST_WAY)).clamp(0.0, 1.0);
                }
            }
        }
        normal
    }
}
