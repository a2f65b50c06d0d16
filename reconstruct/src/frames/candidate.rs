//! One set of contacts, solved for.

use super::observed::{Dot, Observed};
use super::problem::{FrameProblem, Left, Start};
use super::shape::{Place, Shape, trace};
use crate::least_squares::{Damped, Monotone, Problem, Status, iterate};
use nalgebra::{DMatrix, DVector};
use rod_core::RodModel;

/// Most steps of a solve, and those after which one is given up whose contacts are not needed to explain the frame: after the fewer ones
/// if it explains less than half as much as it has to, after the others if it explains less than that.
pub(super) const MOST_STEPS: usize = 60;
pub(super) const SOME_STEPS: usize = 18;
pub(super) const FEW_STEPS: usize = 6;
/// Most rounds of steps: damped ones first, then lightly damped ones.
const ROUNDS: usize = 5;
/// Growth of chi squared, one expected, between which it counts as quadratic; evaluations until foot points have followed; noise of points (L) below
/// which chi squared is rounding.
const GROWTH: (f64, f64) = (0.3, 3.0);
const FOLLOWS: usize = 3;
const ROUNDING: f64 = 1e-10;
/// Share of chi squared by which it falls no more.
const SETTLED: f64 = 1e-3;
/// Standard deviations (dimensionless) of channels with which exact ones are solved first.
const FLOORS: [f64; 5] = [0.1, 1e-2, 1e-3, 1e-4, 1e-5];
/// Standard deviations from the bounds of friction within which they count.
const NEAR: f64 = 3.0;

/// The shape with one set of contacts that explains a frame best.
#[derive(Clone)]
pub(super) struct Candidate {
    pub contacts: Vec<Place>,
    pub u: DVector<f64>,
    pub feet: Vec<f64>,
    pub shape: Shape,
    /// Covariance of the unknowns; none where the observations do not determine them.
    pub covariance: Option<DMatrix<f64>>,
    pub chi_squared: f64,
    /// Residuals less unknowns.
    pub freedom: isize,
}

/// Solves for the unknowns from `start` on. Forces along the rod are those of friction up to the coefficient `friction`, all as likely. None where
/// the frame has no such shape.
pub(super) fn solve<M: RodModel>(
    model: &M,
    observed: &Observed,
    start: &Start,
    friction: f64,
    most_steps: usize,
) -> Option<Candidate> {
    // exact channels make narrow valleys, which are entered from where they are wide
    let mut start = start.clone();
    for floor in FLOORS.into_iter().filter(|floor| *floor > observed.most_exact()) {
        start = without_bounds(model, &observed.blurred(floor), &start, most_steps)?.start();
    }
    let mut candidate = without_bounds(model, observed, &start, most_steps)?;
    let mut bounded = Vec::new();
    for number in 0..start.contacts.len() {
        let Some(across) = candidate.rubbing(number) else { continue };
        let (share, sigma) = candidate.share(across);
        if share.abs() + NEAR * sigma <= friction {
            continue;
        }
        let (mean, deviation) = within(share, sigma, friction);
        bounded.push((number, mean, deviation));
        candidate = candidate.with_share(model, observed, number, mean)?;
    }
    if bounded.is_empty() { Some(candidate) } else { candidate.set_free(model, observed, &bounded) }
}

fn without_bounds<M: RodModel>(model: &M, observed: &Observed, start: &Start, most_steps: usize) -> Option<Candidate> {
    let mut problem = FrameProblem::new(model, observed, &start.contacts, start.feet.clone());
    let mut u = start.u.clone();
    let mut cost = f64::INFINITY;
    // damped steps end in a valley that undamped ones may follow
    for round in 0..ROUNDS {
        let control = if round == 0 { Damped::default() } else { Damped::lightly() };
        let (at, status) = iterate(&mut problem, u, control, most_steps);
        u = at.x;
        let is_given_up = status == Status::OutOfSteps && most_steps < MOST_STEPS;
        let is_settled = at.equations.cost > cost * (1.0 - SETTLED) || is_given_up;
        cost = at.equations.cost;
        if is_settled {
            break;
        }
    }
    let found = Candidate::at(&mut problem, &u)?;
    if found.explains() || most_steps < MOST_STEPS {
        return Some(found);
    }
    // along a narrow curved valley, that of contacts that are close to each other, steps that let the cost fall are tiny
    let (at, _) = iterate(&mut problem, u, Monotone::with_sizes(DVector::repeat(start.u.len(), 1.0)), most_steps);
    let (at, _) = iterate(&mut problem, at.x, Damped::lightly(), most_steps);
    let beyond = Candidate::at(&mut problem, &at.x).filter(|beyond| beyond.chi_squared < found.chi_squared);
    Some(beyond.unwrap_or(found))
}

impl Candidate {
    fn at<M: RodModel>(problem: &mut FrameProblem<'_, M>, u: &DVector<f64>) -> Option<Self> {
        let Left { normal, shape, count } = problem.at(u)?;
        Some(Self {
            contacts: problem.contacts.to_vec(),
            covariance: normal.covariance(),
            chi_squared: normal.cost,
            freedom: count as isize - u.len() as isize,
            feet: problem.feet.clone(),
            u: u.clone(),
            shape,
        })
    }

    /// A start from here.
    pub fn start(&self) -> Start {
        self.start_with(self.contacts.clone(), self.u.clone())
    }

    /// A start with other contacts and unknowns.
    pub fn start_with(&self, contacts: Vec<Place>, u: DVector<f64>) -> Start {
        Start { contacts, u, feet: self.feet.clone(), chi_squared: self.chi_squared }
    }

    /// Whether chi squared grows as the covariance says, by one, along the direction in which the unknowns are known worst together, one standard
    /// deviation each way. In a curved valley it does not, and the standard deviations are too small. Not looked at with exact observations, which
    /// are curved at once.
    pub fn is_quadratic<M: RodModel>(&self, model: &M, observed: &Observed, friction: f64) -> bool {
        let is_exact = |dot: &Dot| dot.sigma < ROUNDING;
        if !observed.channels.is_empty() || observed.pole.is_some() || observed.dots.iter().any(is_exact) {
            return true;
        }
        let Some(covariance) = &self.covariance else { return false };
        let sizes = covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
        let scaled = DMatrix::from_fn(sizes.len(), sizes.len(), |i, j| covariance[(i, j)] / (sizes[i] * sizes[j]));
        let directions = scaled.symmetric_eigen();
        let worst = directions.eigenvalues.imax();
        let step = directions.eigenvectors.column(worst).component_mul(&sizes) * directions.eigenvalues[worst].sqrt();
        // the bounds of friction make deviations smaller than chi squared does
        let least = if friction > 0.0 { f64::NEG_INFINITY } else { GROWTH.0 };
        let mut problem = FrameProblem::new(model, observed, &self.contacts, self.feet.clone());
        [1.0, -1.0].into_iter().all(|side| {
            let moved = &self.u + &step * side;
            let cost = (0..FOLLOWS).fold(f64::NAN, |_, _| problem.equations(&moved).cost);
            (least..GROWTH.1).contains(&(cost - self.chi_squared))
        })
    }

    /// The number of the unknown that is the force of a contact across the rod, if that along it is unknown too: the next one.
    fn rubbing(&self, number: usize) -> Option<usize> {
        let first = 3 + self.contacts[..number].iter().map(Place::unknowns).sum::<usize>();
        match self.contacts[number] {
            Place::Side { s, rub: None } => Some(first + usize::from(s.is_none())),
            _ => None,
        }
    }

    /// The force along the rod as a share of that across it, with its standard deviation.
    fn share(&self, across: usize) -> (f64, f64) {
        let share = self.u[across + 1] / self.u[across];
        let Some(covariance) = &self.covariance else { return (0.0, f64::INFINITY) };
        let mut gradient = DVector::zeros(self.u.len());
        gradient[across] = -share / self.u[across];
        gradient[across + 1] = 1.0 / self.u[across];
        (share, deviation(covariance, &gradient))
    }

    /// The same contacts with a share that is given.
    fn with_share<M: RodModel>(&self, model: &M, observed: &Observed, number: usize, share: f64) -> Option<Self> {
        let mut contacts = self.contacts.clone();
        let Place::Side { s, rub } = contacts[number] else { return None };
        contacts[number] = Place::Side { s, rub: Some(share) };
        let u = match (rub, self.rubbing(number)) {
            (None, Some(across)) => self.u.clone().remove_row(across + 1),
            _ => self.u.clone(),
        };
        without_bounds(model, observed, &self.start_with(contacts, u), MOST_STEPS)
    }

    /// The same shape with shares that were given as unknowns again, which are known by their standard deviations: what the other unknowns do while
    /// a share changes, they do in their covariance.
    fn set_free<M: RodModel>(self, model: &M, observed: &Observed, bounded: &[(usize, f64, f64)]) -> Option<Self> {
        let mut contacts = self.contacts.clone();
        for (number, ..) in bounded {
            if let Place::Side { rub, .. } = &mut contacts[*number] {
                *rub = None;
            }
        }
        // the unknowns with the forces along the rod
        let whole = |u: &DVector<f64>, shares: &dyn Fn(usize) -> f64| {
            let (mut from, mut all) = (3, u.as_slice()[..3].to_vec());
            for (number, (given, free)) in self.contacts.iter().zip(&contacts).enumerate() {
                all.extend(&u.as_slice()[from..from + given.unknowns()]);
                from += given.unknowns();
                if free.unknowns() > given.unknowns() {
                    all.push(shares(number) * all[all.len() - 1]);
                }
            }
            DVector::from_vec(all)
        };
        let of = |number: usize| bounded.iter().find(|known| known.0 == number).map_or(0.0, |known| known.1);
        let u = whole(&self.u, &of);
        let covariance = self.covariance.as_ref().map(|given| {
            // with the shares as they are, forces along the rod follow those across it
            let columns: Vec<DVector<f64>> = (0..self.u.len())
                .map(|k| {
                    let unit = DVector::from_fn(self.u.len(), |i, _| f64::from(u8::from(i == k)));
                    whole(&unit, &of)
                })
                .collect();
            let jacobian = DMatrix::from_columns(&columns);
            &jacobian * given * jacobian.transpose()
        });
        let mut covariance = covariance?;
        for &(number, mean, deviation) in bounded {
            let moved = |share: f64| {
                let moved = self.with_share(model, observed, number, share)?;
                Some(whole(&moved.u, &|k| if k == number { share } else { of(k) }))
            };
            if let (Some(more), Some(less)) = (moved(mean + deviation), moved(mean - deviation)) {
                let change = (more - less) / 2.0;
                covariance += &change * change.transpose();
            }
        }
        let shape = trace(model, &contacts, u.as_slice(), &[], |_, _| ())?;
        Some(Self { contacts, u, shape, covariance: Some(covariance), ..self })
    }
}

/// Standard deviation of a number with this gradient by the unknowns.
pub(super) fn deviation(covariance: &DMatrix<f64>, gradient: &DVector<f64>) -> f64 {
    gradient.dot(&(covariance * gradient)).max(0.0).sqrt()
}

/// Mean and standard deviation of a normal variable of which it is known that it lies between -bound and bound.
fn within(mean: f64, sigma: f64, bound: f64) -> (f64, f64) {
    const PARTS: u32 = 800;
    // beyond so many widths nothing is left
    const WIDTHS: f64 = 20.0;
    if !(sigma.is_finite() && mean.is_finite()) {
        return (0.0, bound / 3.0_f64.sqrt());
    }
    let peak = mean.clamp(-bound, bound);
    // beyond a bound the density falls away from it within a shorter length
    let width = sigma.min(sigma * sigma / (mean - peak).abs().max(f64::MIN_POSITIVE));
    let (from, to) = ((peak - WIDTHS * width).max(-bound), (peak + WIDTHS * width).min(bound));
    let (mut weights, mut first, mut second) = (0.0, 0.0, 0.0);
    for k in 0..PARTS {
        let x = from + (to - from) * (f64::from(k) + 0.5) / f64::from(PARTS);
        let weight = (0.5 * ((peak - mean).powi(2) - (x - mean).powi(2)) / (sigma * sigma)).exp();
        weights += weight;
        first += weight * (x - peak);
        second += weight * (x - peak).powi(2);
    }
    let shift = first / weights;
    (peak + shift, (second / weights - shift * shift).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::within;

    #[test]
    fn bounded_normal_variables() {
        // uniform, hardly bounded, half a normal distribution, an exponential tail
        let half = (2.0 / std::f64::consts::PI).sqrt();
        for (given, mean, deviation) in [
            ((0.3, f64::INFINITY, 0.6), 0.0, 0.6 / 3.0_f64.sqrt()),
            ((0.1, 1e-3, 0.4), 0.1, 1e-3),
            ((0.4, 1e-2, 0.4), 0.4 - 1e-2 * half, 1e-2 * (1.0 - half * half).sqrt()),
            ((-1.4, 1e-2, 0.4), -0.4 + 1e-4, 1e-4),
        ] {
            let (m, d) = within(given.0, given.1, given.2);
            assert!(
                (m - mean).abs() < 1e-3 * deviation + 1e-12 && (d / deviation - 1.0).abs() < 1e-3,
                "{given:?}: {m} {d}"
            );
        }
    }
}
