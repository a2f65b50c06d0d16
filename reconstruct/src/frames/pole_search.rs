//! The pole that a film shows: one place and radius that all contacts are at.
//!
//! Each frame with a contact has its own unknowns; the pole is common to all. With a given pole each frame is solved on its own, and the pole is
//! an observation so exact that it is a condition. All frames together give a step of the pole by three equations, the Schur complement of their
//! own unknowns: Gauss-Newton on the least chi squared of all frames.

use super::candidate::{Candidate, MOST_STEPS, solve};
use super::choose::{Allowed, BEYOND_CHANCE, CHANCE, Search, choose};
use super::observed::Observed;
use super::pole::{Centre, FilmPole, Pole, PolePrior};
use crate::numeric::chi_squared::{upper_tail, wilson_hilferty};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2, Vector3};
use rod_core::{RodModel, Units};

/// Steps of Gauss-Newton, and the share of its standard deviations below which a step is the last.
const MOST_ROUNDS: usize = 20;
const SETTLED: f64 = 1e-2;
/// Longest step, L, and how often it is halved where chi squared grows.
const MOST_WAY: f64 = 0.1;
const MOST_HALVINGS: usize = 5;
/// Largest share of the frames whose contact is elsewhere, rounded up.
const MOST_ELSEWHERE: f64 = 0.1;
/// Standard deviation of each coordinate of a given centre where none is given, L.
const KNOWN: f64 = 1e-3;
/// Standard deviation (L) from which on the contacts of the frames on their own do not tell where to begin. Then the contact of one frame
/// is tried at so many places, with so many frames.
const VAGUE: f64 = 0.1;
const PLACES: usize = 20;
const FEW: usize = 8;

/// A frame with a contact.
#[derive(Clone)]
pub(super) struct Touch {
    index: usize,
    observed: Observed,
    /// Its shape without the pole, and with it.
    alone: Candidate,
    with: Option<Candidate>,
}

impl Touch {
    /// A frame, by its index, if its single contact is beyond chance.
    pub fn of<M: RodModel>(model: &M, index: usize, observed: Observed, allowed: Allowed) -> Option<Self> {
        let alone = choose(model, &observed, allowed)?.best;
        (alone.contacts.len() == 1).then_some(Self { index, observed, alone, with: None })
    }

    /// By how much the pole makes chi squared grow.
    fn contradiction(&self) -> f64 {
        self.with.as_ref().map_or(f64::INFINITY, |with| with.chi_squared - self.alone.chi_squared)
    }
}

/// Normal equations of all frames for a step of the pole (x, y, radius).
struct PoleEquations {
    matrix: Matrix3<f64>,
    gradient: Vector3<f64>,
    chi_squared: f64,
}

/// The search for the pole of a film.
pub(super) struct PoleSearch<'a, M> {
    pub model: &'a M,
    pub allowed: Allowed,
    /// Lengths in L.
    pub prior: PolePrior,
    /// Standard deviation of the pole in each frame, L: so exact that it is a condition.
    pub exact: f64,
}

impl<M: RodModel> PoleSearch<'_, M> {
    /// The pole of the frames that have a contact; none where no pole explains most of them, or the frames contradict what is given.
    pub fn pole(&self, mut touches: Vec<Touch>, units: &Units) -> Option<FilmPole> {
        let radius = self.prior.radius.unwrap_or(0.0);
        let center = match self.prior.center {
            Some(center) => center,
            None => self.start(&touches, radius)?,
        };
        let mut pole = Pole { center, radius, sigma: self.exact };
        let mut equations = self.settle(&mut touches, &mut pole, false)?;
        let mut has_radius = false;
        if self.prior.radius.is_none() {
            let (mut round, mut others) = (pole, touches.clone());
            if let Some(of_round) = self.settle(&mut others, &mut round, true)
                && round.radius > 0.0
                && equations.chi_squared - of_round.chi_squared > wilson_hilferty(1, BEYOND_CHANCE)
            {
                (pole, touches, equations, has_radius) = (round, others, of_round, true);
            }
        }
        let mut elsewhere = Vec::new();
        while let Some(worst) = worst(&touches) {
            elsewhere.push(touches.remove(worst).index);
            if elsewhere.len() > (MOST_ELSEWHERE * (touches.len() + elsewhere.len()) as f64).ceil() as usize {
                return None;
            }
            equations = self.settle(&mut touches, &mut pole, has_radius)?;
        }
        if self.is_contradicted(&touches, pole, &equations) {
            return None;
        }
        let of_frames: isize = touches.iter().filter_map(|touch| touch.with.as_ref()).map(|with| with.freedom).sum();
        let given = if self.prior.center.is_some() { 2 } else { 0 };
        let freedom = (of_frames + given - 2 - isize::from(has_radius)).max(0) as usize;
        let p_value = upper_tail(equations.chi_squared, freedom.max(1) as f64);
        let covariance = equations.matrix.try_inverse().filter(|_| p_value > CHANCE)?;
        elsewhere.sort_unstable();
        let is_found = |i: usize| i < 2 || has_radius;
        let square = units.length * units.length;
        Some(FilmPole {
            center: pole.center.map(|c| c * units.length),
            radius: pole.radius * units.length,
            covariance: std::array::from_fn(|i| {
                std::array::from_fn(|j| if is_found(i) && is_found(j) { covariance[(i, j)] * square } else { 0.0 })
            }),
            chi_squared: equations.chi_squared,
            freedom,
            p_value,
            frames: touches.iter().map(|touch| touch.index).collect(),
            elsewhere,
        })
    }

    /// Whether another pole than the one that is given suits the frames better than chance does.
    fn is_contradicted(&self, touches: &[Touch], pole: Pole, given: &PoleEquations) -> bool {
        let PolePrior { center, radius, .. } = self.prior;
        let numbers = 2 * usize::from(center.is_some()) + usize::from(radius.is_some());
        if numbers == 0 {
            return false;
        }
        let free = PoleSearch { prior: PolePrior::default(), ..*self };
        let (mut others, mut other) = (touches.to_vec(), pole);
        let found = free.settle(&mut others, &mut other, true);
        found.is_some_and(|found| given.chi_squared - found.chi_squared > wilson_hilferty(numbers, BEYOND_CHANCE))
    }

    /// Moves the pole to where the frames have the least chi squared. None where the frames do not tell its place.
    fn settle(&self, touches: &mut [Touch], pole: &mut Pole, has_radius: bool) -> Option<PoleEquations> {
        let mut equations = self.equations(touches, pole, has_radius)?;
        for _ in 0..MOST_ROUNDS {
            let covariance = equations.matrix.try_inverse()?;
            let mut step = -covariance * equations.gradient;
            let sigmas = covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
            let is_last = (0..3).all(|i| step[i].abs() <= SETTLED * sigmas[i]);
            step *= (MOST_WAY / step.amax()).min(1.0);
            let from = *pole;
            let mut next = None;
            for _ in 0..MOST_HALVINGS {
                let center = [from.center[0] + step[0], from.center[1] + step[1]];
                *pole = Pole { center, radius: (from.radius + step[2]).max(0.0), ..from };
                let mut others = touches.to_vec();
                next = self
                    .equations(&mut others, pole, has_radius)
                    .filter(|next| next.chi_squared <= equations.chi_squared);
                if next.is_some() {
                    touches.clone_from_slice(&others);
                    break;
                }
                step *= 0.5;
            }
            let Some(next) = next else {
                *pole = from;
                break;
            };
            equations = next;
            if is_last {
                break;
            }
        }
        Some(equations)
    }

    /// Solves all frames with the pole. None where one has no such shape.
    fn equations(&self, touches: &mut [Touch], pole: &Pole, has_radius: bool) -> Option<PoleEquations> {
        let mut equations = PoleEquations { matrix: Matrix3::zeros(), gradient: Vector3::zeros(), chi_squared: 0.0 };
        let weight = pole.sigma.powi(-2);
        for touch in touches {
            touch.observed.pole = Some(*pole);
            let with = self.solve(touch)?;
            let count = with.u.len();
            let centre = Centre::of(with.shape.contacts.first()?, pole.radius, count);
            let mut mixed = DMatrix::zeros(count, 3);
            for axis in [0, 1] {
                let mut by_pole = Vector3::zeros();
                by_pole[axis] = -1.0;
                by_pole[2] = if has_radius { centre.direction[axis] } else { 0.0 };
                let own = DVector::from_fn(count, |k, _| centre.by(k)[axis]);
                equations.matrix += weight * by_pole * by_pole.transpose();
                equations.gradient += weight * (centre.at[axis] - pole.center[axis]) * by_pole;
                mixed += weight * own * by_pole.transpose();
            }
            let spread = mixed.transpose() * with.covariance.as_ref()? * &mixed;
            equations.matrix -= Matrix3::from_fn(|i, j| spread[(i, j)]);
            equations.chi_squared += with.chi_squared;
            touch.with = Some(with);
        }
        if let Some(center) = self.prior.center {
            let sigma = self.prior.sigma.unwrap_or(KNOWN).max(self.exact);
            for axis in [0, 1] {
                let off = (pole.center[axis] - center[axis]) / sigma;
                equations.matrix[(axis, axis)] += sigma.powi(-2);
                equations.gradient[axis] += off / sigma;
                equations.chi_squared += off * off;
            }
        }
        if !has_radius {
            equations.matrix[(2, 2)] = 1.0;
        }
        equations.chi_squared.is_finite().then_some(equations)
    }

    /// The shape of a frame at the pole: from where it was, or the best of all.
    fn solve(&self, touch: &Touch) -> Option<Candidate> {
        let solve =
            |start: &Candidate| solve(self.model, &touch.observed, &start.start(), self.allowed.friction, MOST_STEPS);
        if let Some(with) = &touch.with {
            return solve(with);
        }
        let chosen = choose(self.model, &touch.observed, self.allowed).map(|chosen| chosen.best);
        chosen.filter(|best| best.contacts.len() == 1).or_else(|| solve(&touch.alone))
    }

    /// Where the pole is by the contacts of the frames on their own; where these are vague, the place of one of them that suits some others best.
    fn start(&self, touches: &[Touch], radius: f64) -> Option<[f64; 2]> {
        let (mut matrix, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for touch in touches {
            let Some(covariance) = &touch.alone.covariance else { continue };
            let count = touch.alone.u.len();
            let centre = Centre::of(touch.alone.shape.contacts.first()?, radius, count);
            let rates = DMatrix::from_fn(2, count, |axis, k| centre.by(k)[axis]);
            let spread = &rates * covariance * rates.transpose();
            if let Some(inverse) = Matrix2::from_fn(|i, j| spread[(i, j)]).try_inverse() {
                matrix += inverse;
                right += inverse * Vector2::from(centre.at);
            }
        }
        if let Some(covariance) = matrix.try_inverse().filter(|found| found.trace() < VAGUE * VAGUE) {
            return Some((covariance * right).into());
        }
        let few: Vec<Touch> = touches.iter().step_by(touches.len().div_ceil(FEW).max(1)).cloned().collect();
        let search = Search::of(self.model, &few.first()?.observed, self.allowed);
        let places = (1..=PLACES).filter_map(|k| {
            let held = search.held_at(k as f64 / PLACES as f64)?;
            let center = Centre::of(held.shape.contacts.first()?, radius, held.u.len()).at;
            let chi_squared =
                self.equations(&mut few.clone(), &Pole { center, radius, sigma: self.exact }, false)?.chi_squared;
            Some((center, chi_squared))
        });
        places.min_by(|a, b| a.1.total_cmp(&b.1)).map(|best| best.0)
    }
}

/// The frame that contradicts the pole most, if chance does not explain it.
fn worst(touches: &[Touch]) -> Option<usize> {
    let most = touches.iter().map(Touch::contradiction).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    most.filter(|most| most.1 > wilson_hilferty(2, BEYOND_CHANCE)).map(|most| most.0)
}
