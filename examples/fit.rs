//! Where an object is, how sharp it is, and how stiff the rod is, from 35 noisy reactions: a least-squares fit by `argmin`'s
//! Gauss-Newton method with the derivatives of the equilibria. See docs/fits.md.
//!
//! ```sh
//! cargo run --release --example fit
//! ```
#![allow(missing_docs, clippy::print_stdout, reason = "an example is there to be read and run")]

use argmin::core::{Error, Executor, Jacobian, Operator, State as _};
use argmin::solver::gaussnewton::GaussNewton;
use nalgebra::{DMatrix, DVector};
use std::cell::{Cell, RefCell};
use std::f64::consts::FRAC_PI_2;
use vibrissa::contact::{Contact, ContactKind, Derivatives, Inadmissible, Quantity};
use vibrissa::rod::Reactions;
use vibrissa::{ClampPath, Composite, Parabola, Pose, Rod, Sample, State, Sweep, equilibrium};

/// Length of the rod, m.
const LENGTH: f64 = 0.1;
/// Standard deviations of the sensor: f0x and f0y, N, and m0z, N m.
const SIGMA: [f64; 3] = [2.5e-3, 2.5e-3, 6e-5];
/// What counts as 1 of each parameter: x and y of the vertex, m; coefficient, 1/m; E I, N m^2. The normal equations of parameters
/// that differ by six orders would lose their digits.
const UNIT: [f64; 4] = [0.01, 0.01, 50.0, 6e-4];
/// The quantities in the order of the parameters.
const QUANTITIES: [Quantity<'static>; 4] = [
    Quantity::ObjectX(0),
    Quantity::ObjectY(0),
    Quantity::Shape { object: 0, piece: 0, parameter: "coefficient" },
    Quantity::Stiffness,
];

/// The rod and the object that the parameters stand for.
fn model(parameters: &[f64]) -> Result<(Rod, Composite), Error> {
    let [x, y, coefficient, stiffness] = [0, 1, 2, 3].map(|k| parameters[k] * UNIT[k]);
    Ok((Rod::new(LENGTH, stiffness)?, Composite::single(Parabola::new([x, y], coefficient)?)?))
}

/// A recording, and the states that the last parameters gave.
pub struct Fit {
    samples: Vec<Sample>,
    states: RefCell<Vec<State>>,
    solves: Cell<usize>,
}

impl Fit {
    pub fn new(samples: Vec<Sample>) -> Self {
        Self { samples, states: RefCell::default(), solves: Cell::new(0) }
    }

    /// The equilibrium at a sample: from the first guess that leads to one, with that contact or one of the other kind. A contact that pulls continues the
    /// model smoothly where the object is too far away to touch the rod, and lets the fit find its way back.
    fn state(&self, rod: &Rod, object: &Composite, pose: Pose, guesses: &[Contact]) -> Result<State, Error> {
        let mut pulling = None;
        let other = |kind| if kind == ContactKind::Tip { ContactKind::Tangent } else { ContactKind::Tip };
        let both = guesses.iter().flat_map(|guess| [*guess, Contact { kind: other(guess.kind), ..*guess }]);
        for guess in both {
            let found = equilibrium(rod, object, pose, &[guess])?;
            self.solves.set(self.solves.get() + 1);
            match found.is_admissible() {
                Ok(()) => return Ok(found.state),
                Err(Inadmissible::Pulls { .. }) => pulling = pulling.or(Some(found.state)),
                Err(_) => {}
            }
        }
        pulling.ok_or_else(|| Error::msg("no contact with the object holds the rod; start from a better guess"))
    }

    /// The contact that the reactions tell: its force, the tangent angle of the object there, and so the point of the parabola.
    fn guess(sample: &Sample, parameters: &[f64]) -> Contact {
        let Reactions { f0x, f0y, .. } = sample.reactions;
        let (force, alpha) = (f0x.hypot(f0y), (-f0x).atan2(f0y));
        let [vertex_x, vertex_y, coefficient] = [0, 1, 2].map(|k| parameters[k] * UNIT[k]);
        let t = alpha.tan() / (2.0 * coefficient);
        let (x, y) = (vertex_x + t, vertex_y + coefficient * t * t);
        let s = (x - sample.pose.x).hypot(y - sample.pose.y).min(LENGTH);
        Contact { object: 0, piece: 0, kind: ContactKind::Tangent, s, x, y, alpha, force, friction: None }
    }
}

impl Operator for Fit {
    type Param = DVector<f64>;
    type Output = DVector<f64>;

    /// (model - measured) / standard deviation of all reactions.
    fn apply(&self, parameters: &Self::Param) -> Result<Self::Output, Error> {
        let (rod, object) = model(parameters.as_slice())?;
        let known = self.states.take();
        let mut states: Vec<Option<State>> = vec![None; self.samples.len()];
        // From the strongest force to either side: its direction is known best, and the next sample's contact is next to it.
        let force = |sample: &Sample| sample.reactions.f0x.hypot(sample.reactions.f0y);
        let strongest =
            |one: &usize, other: &usize| force(&self.samples[*one]).total_cmp(&force(&self.samples[*other]));
        let start = (0..self.samples.len()).max_by(strongest).unwrap_or(0);
        for index in (start..self.samples.len()).chain((0..start).rev()) {
            let sample = &self.samples[index];
            let neighbour = if index < start { index + 1 } else { index.saturating_sub(1) };
            let before =
                known.get(index).or(states[neighbour].as_ref()).and_then(|state| state.contacts.first().copied());
            let guesses: Vec<_> = before.into_iter().chain([Self::guess(sample, parameters.as_slice())]).collect();
            states[index] = Some(self.state(&rod, &object, sample.pose, &guesses)?);
        }
        let states: Vec<State> = states.into_iter().flatten().collect();
        let mut residuals = Vec::with_capacity(3 * self.samples.len());
        for (state, sample) in states.iter().zip(&self.samples) {
            let (model, measured) = (state.reactions, sample.reactions);
            let off = [model.f0x - measured.f0x, model.f0y - measured.f0y, model.m0z - measured.m0z];
            residuals.extend(off.into_iter().zip(SIGMA).map(|(off, sigma)| off / sigma));
        }
        self.states.replace(states);
        Ok(DVector::from_vec(residuals))
    }
}

impl Jacobian for Fit {
    type Param = DVector<f64>;
    type Jacobian = DMatrix<f64>;

    /// From the states of the last [`apply`](Operator::apply), which the Gauss-Newton method makes at the same parameters: no solve.
    fn jacobian(&self, parameters: &Self::Param) -> Result<Self::Jacobian, Error> {
        let (rod, object) = model(parameters.as_slice())?;
        let states = self.states.borrow();
        let mut jacobian = DMatrix::zeros(3 * states.len(), QUANTITIES.len());
        for (index, state) in states.iter().enumerate() {
            let derivatives = Derivatives::new(&rod, &object, state)?;
            for (column, quantity) in QUANTITIES.into_iter().enumerate() {
                let Reactions { f0x, f0y, m0z } = derivatives.by(quantity)?.reactions;
                for (row, (rate, sigma)) in [f0x, f0y, m0z].into_iter().zip(SIGMA).enumerate() {
                    jacobian[(3 * index + row, column)] = rate * UNIT[column] / sigma;
                }
            }
        }
        Ok(jacobian)
    }
}

/// What a fit found, and what it cost.
#[derive(Debug)]
pub struct Found {
    /// x and y of the vertex, m; coefficient, 1/m; E I, N m^2.
    pub parameters: [f64; 4],
    /// Their standard deviations.
    pub sigmas: [f64; 4],
    /// Sum of the squared residuals over their standard deviations, and its degrees of freedom.
    pub chi_squared: (f64, usize),
    /// Equilibria that were solved for.
    pub solves: usize,
}

/// Fits the parameters to the samples, from a first guess of them.
pub fn fit(samples: Vec<Sample>, guess: [f64; 4]) -> Result<Found, Error> {
    let start = DVector::from_iterator(4, guess.iter().zip(UNIT).map(|(guess, unit)| guess / unit));
    let degrees = 3 * samples.len() - guess.len();
    // |residual| is about 10: a change of 1e-3 is far below one standard deviation of any parameter
    let solver = GaussNewton::new().with_tolerance(1e-3)?;
    let done = Executor::new(Fit::new(samples), solver).configure(|state| state.param(start).max_iters(10)).run()?;
    let (cost, best) = (done.state().get_cost(), done.state().get_param().cloned());
    let parameters = best.ok_or_else(|| Error::msg("no iteration was made"))?;
    let problem = done.problem.problem.ok_or_else(|| Error::msg("the problem is gone"))?;
    // The covariance by the Jacobian at the solution: its states are those of the last parameters.
    let jacobian = problem.jacobian(&parameters)?;
    let covariance = (jacobian.transpose() * jacobian)
        .try_inverse()
        .ok_or_else(|| Error::msg("the samples do not tell all parameters; take more of the object"))?;
    Ok(Found {
        parameters: [0, 1, 2, 3].map(|k| parameters[k] * UNIT[k]),
        sigmas: [0, 1, 2, 3].map(|k| covariance[(k, k)].sqrt() * UNIT[k]),
        chi_squared: (cost * cost, degrees),
        solves: problem.solves.get(),
    })
}

/// 35 samples of a scan in contact, with noise.
pub fn recording(truth: [f64; 4], seed: u64) -> Result<Vec<Sample>, Error> {
    let scaled: Vec<f64> = truth.iter().zip(UNIT).map(|(truth, unit)| truth / unit).collect();
    let (rod, object) = model(&scaled)?;
    let clamp = |x| Pose { x, y: -0.04, phi: FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.034), clamp(-0.017))?;
    let states = Sweep::new(&rod, &object, path, path.length() / 34.0)?.run().states;
    let mut noise = Noise(seed);
    let sample = |state: &State| {
        let Reactions { f0x, f0y, m0z } = state.reactions;
        let [x, y, m] = SIGMA.map(|sigma| sigma * noise.gaussian());
        Sample::new(state.pose, Reactions { f0x: f0x + x, f0y: f0y + y, m0z: m0z + m })
    };
    Ok(states.iter().map(sample).collect())
}

/// A linear congruential generator (Knuth), whose twelve numbers in a sum are nearly Gaussian.
struct Noise(u64);

impl Noise {
    fn gaussian(&mut self) -> f64 {
        let mut uniform = || {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }
}

pub fn main() -> Result<(), Error> {
    let (truth, guess) = ([0.002, 0.001, 50.0, 6.3e-4], [-0.001, 0.0, 40.0, 5e-4]);
    let found = fit(recording(truth, 1)?, guess)?;
    let names = ["vertex x, mm", "vertex y, mm", "coefficient, 1/m", "E I, N mm^2"];
    println!("{:18} {:>9} {:>9} {:>9} {:>9}", "", "guess", "truth", "fit", "+-");
    for (k, (name, scale)) in names.into_iter().zip([1e3, 1e3, 1.0, 1e6]).enumerate() {
        let [guess, truth, fit, sigma] =
            [guess[k], truth[k], found.parameters[k], found.sigmas[k]].map(|value| value * scale);
        println!("{name:18} {guess:9.3} {truth:9.3} {fit:9.3} {sigma:9.3}");
    }
    let (chi_squared, degrees) = found.chi_squared;
    println!("chi squared {chi_squared:.1} with {degrees} degrees of freedom, {} solves", found.solves);
    Ok(())
}
