//! Roots from rough guesses: where the damped Newton method fails, `argmin`'s trust region looks for a place from which it does not.
//!
//! The trust region (J. Nocedal and S. Wright, Numerical Optimization, 2006, chapter 4) minimises 1/2 |F|^2 with the Hessian J^T J of
//! Gauss and Newton and the steps of Steihaug (1983). Its unknowns are those of the system times their [weights](System::weights) at
//! the guess, so that its ball is round in natural sizes. Each accepted step lessens |F|. It may end in a minimum of |F| that is not
//! a root.

use super::argmin_newton::RootProblem;
use super::newton::{NewtonOptions, NewtonWorkspace, SolveReport, solve};
use super::system::System;
use argmin::core::{Error, Executor, IterState, State};
use argmin::solver::trustregion::{Steihaug, TrustRegion};
use nalgebra::{DMatrix, DVector};
use std::fmt;

/// A [`System`] in its unknowns times their weights at a guess.
pub struct Scaled<'a> {
    system: &'a dyn System,
    sizes: DVector<f64>,
}

/// What `argmin` keeps between iterations of the trust region, and shows its observers: `param` are the unknowns times their
/// weights at the guess, `cost` is 1/2 |F|^2.
pub type TrustRegionState = IterState<DVector<f64>, DVector<f64>, (), DMatrix<f64>, (), f64>;

/// A search by the trust region that is about to run: `argmin`'s executor, with its observers, checkpoints, limits of iterations
/// and of time.
pub type TrustRegionSearch<'a> =
    Executor<RootProblem<Scaled<'a>>, TrustRegion<Steihaug<DVector<f64>, f64>, f64>, TrustRegionState>;

/// Default limit of the iterations.
const MOST: u64 = 100;
/// 1/2 |F|^2 at which Newton's method goes on: |F| = 1e-3.
const NEAR: f64 = 5e-7;
/// Conjugate gradients for each unknown in one step: exact arithmetic needs one.
const GRADIENTS: u64 = 3;

impl<'a> Scaled<'a> {
    fn new(system: &'a dyn System, guess: &[f64]) -> Self {
        let mut weights = DVector::zeros(guess.len());
        system.weights(guess, weights.as_mut_slice());
        Self { system, sizes: weights.map(|w| 1.0 / w) }
    }

    fn unscaled(&self, v: &[f64]) -> Vec<f64> {
        v.iter().zip(&self.sizes).map(|(v, size)| v * size).collect()
    }
}

impl fmt::Debug for Scaled<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scaled").field("sizes", &self.sizes.as_slice()).finish_non_exhaustive()
    }
}

impl System for Scaled<'_> {
    fn dimension(&self) -> usize {
        self.system.dimension()
    }

    fn evaluate(&self, v: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
        let u = self.unscaled(v);
        let Some(jacobian) = jacobian else { return self.system.evaluate(&u, residual, None) };
        self.system.evaluate(&u, residual, Some(&mut *jacobian));
        for (column, size) in jacobian.chunks_exact_mut(v.len().max(1)).zip(&self.sizes) {
            column.iter_mut().for_each(|entry| *entry *= size);
        }
    }
}

/// Solves F(u) = 0 from a guess from which [`solve`] fails, in place: `argmin`'s trust region until |F| is below 1e-3 or 100
/// iterations are over, then [`solve`] from where it came to. The report is that of [`solve`], with the iterations of both.
///
/// `search` gets the executor before it runs, to set other limits and to add observers; give `|search| search` to leave it as it is.
/// Where the search stops early, [`solve`] goes on from its best point; where it fails (derivatives that are not finite), from the guess.
///
/// ```
/// use rod_core::{NewtonOptions, NewtonWorkspace, System, solve, solve_by_trust_region};
/// struct Bent; // atan x = 0 and y = x: flat far from the root, so that steps of Newton's method are far too long
/// impl System for Bent {
///     fn dimension(&self) -> usize { 2 }
///     fn evaluate(&self, u: &[f64], r: &mut [f64], j: Option<&mut [f64]>) {
///         r.copy_from_slice(&[u[0].atan(), u[1] - u[0]]);
///         if let Some(j) = j {
///             j.copy_from_slice(&[1.0 / (1.0 + u[0] * u[0]), -1.0, 0.0, 1.0]);
///         }
///     }
/// }
/// let options = NewtonOptions::default();
/// let (mut u, mut workspace) = ([100.0, 0.0], NewtonWorkspace::new());
/// assert!(!solve(&Bent, &mut u, &options, &mut workspace).status.is_solved());
///
/// let mut u = [100.0, 0.0];
/// let report = solve_by_trust_region(&Bent, &mut u, &options, &mut workspace, |search| {
///     search.timeout(std::time::Duration::from_secs(1))
/// });
/// assert!(report.status.is_solved() && u[0].abs() < 1e-15);
/// ```
pub fn solve_by_trust_region(
    system: &impl System,
    u: &mut [f64],
    options: &NewtonOptions,
    workspace: &mut NewtonWorkspace,
    search: impl FnOnce(TrustRegionSearch<'_>) -> TrustRegionSearch<'_>,
) -> SolveReport {
    let iterations = approach(system, u, search).unwrap_or(0);
    let report = solve(system, u, options, workspace);
    SolveReport { iterations: report.iterations.saturating_add(iterations), ..report }
}

/// Moves `u` to where the trust region comes to, and returns its number of iterations.
fn approach(
    system: &dyn System,
    u: &mut [f64],
    search: impl FnOnce(TrustRegionSearch<'_>) -> TrustRegionSearch<'_>,
) -> Result<u32, Error> {
    let scaled = Scaled::new(system, u);
    let sizes = scaled.sizes.clone();
    let guess = DVector::from_column_slice(u).component_div(&sizes);
    let steps = Steihaug::new().with_max_iters(GRADIENTS * u.len() as u64);
    let executor = Executor::new(RootProblem(scaled), TrustRegion::new(steps))
        .configure(|state| state.param(guess).target_cost(NEAR).max_iters(MOST))
        .ctrlc(false);
    let result = search(executor).run()?;
    if let Some(best) = result.state.get_best_param() {
        u.copy_from_slice(best.component_mul(&sizes).as_slice());
    }
    Ok(u32::try_from(result.state.get_iter()).unwrap_or(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Uniform;
    use crate::pose::Pose;
    use crate::support_problem::{Hold, MultiPoint, Support, Supports};
    use argmin::core::KV;
    use argmin::core::observers::{Observe, ObserverMode};
    use std::sync::{Arc, Mutex};

    /// The tip on the wall x = 0.5.
    struct Wall;

    impl Supports for Wall {
        fn count(&self) -> usize {
            1
        }
        fn hold(&self, _: usize) -> Hold {
            Hold::Tip
        }
        fn support(&self, _: usize, t: f64) -> Support {
            Support { x: 0.5, y: t, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 }
        }
    }

    const PROBLEM: MultiPoint<'_, Wall> =
        MultiPoint { rod: Uniform, clamp: Pose { x: 0.3, y: 0.0, phi: std::f64::consts::FRAC_PI_2 }, supports: &Wall };
    const GUESS: [f64; 3] = [-0.5, 8.0, 0.0];

    struct Costs(Arc<Mutex<Vec<f64>>>);

    impl Observe<TrustRegionState> for Costs {
        fn observe_iter(&mut self, state: &TrustRegionState, _: &KV) -> Result<(), Error> {
            self.0.lock().unwrap().push(state.get_cost());
            Ok(())
        }
    }

    fn options() -> NewtonOptions {
        NewtonOptions { longest_step: 0.5, ..NewtonOptions::default() }
    }

    fn solved(
        mut u: [f64; 3],
        search: impl FnOnce(TrustRegionSearch<'_>) -> TrustRegionSearch<'_>,
    ) -> ([f64; 3], SolveReport) {
        let report = solve_by_trust_region(&PROBLEM, &mut u, &options(), &mut NewtonWorkspace::new(), search);
        (u, report)
    }

    #[test]
    fn it_takes_over_where_newton_fails() {
        for force in [-12.0, -8.0, -4.0, -2.0, 2.0, 4.0, 8.0, 12.0] {
            for t in [-0.5, 0.0, 0.5, 0.9] {
                let (mut alone, options) = ([t, force, 0.0], options());
                let without = solve(&PROBLEM, &mut alone, &options, &mut NewtonWorkspace::new());
                let (u, report) = solved([t, force, 0.0], |search| search);
                assert!(
                    !without.status.is_solved() && report.status.is_solved(),
                    "{t} {force}: {without:?} {report:?}"
                );
                let mut residual = [1.0; 3];
                PROBLEM.evaluate(&u, &mut residual, None);
                assert!(residual.iter().all(|r| r.abs() < 1e-13), "{residual:?}");
                if force > 0.0 {
                    // a cantilever whose tip is pushed by 0.2: 3 E I w / L^3, and a little more
                    assert!((u[1] - 0.6).abs() < 0.05, "{u:?}");
                }
            }
        }
    }

    #[test]
    fn observers_and_limits_reach_it() {
        let costs = Arc::new(Mutex::new(Vec::new()));
        solved(GUESS, |search| search.add_observer(Costs(costs.clone()), ObserverMode::Always));
        let all = std::mem::take(&mut *costs.lock().unwrap());
        assert!(all.len() > 4 && all.is_sorted_by(|a, b| a >= b) && all[all.len() - 1] <= NEAR, "{all:?}");
        solved(GUESS, |search| {
            search.configure(|state| state.max_iters(4)).add_observer(Costs(costs.clone()), ObserverMode::Always)
        });
        assert_eq!(*costs.lock().unwrap(), all[..4]);
        costs.lock().unwrap().clear();
        solved(GUESS, |executor| {
            executor.timeout(std::time::Duration::ZERO).add_observer(Costs(costs.clone()), ObserverMode::Always)
        });
        assert_eq!(costs.lock().unwrap().len(), 1);
    }

    #[test]
    fn a_guess_that_is_not_finite_is_not_solved() {
        let mut u = [f64::NAN, 1.0, 1.0];
        let options = NewtonOptions::default();
        let report = solve_by_trust_region(&PROBLEM, &mut u, &options, &mut NewtonWorkspace::new(), |search| search);
        assert!(!report.status.is_solved());
    }
}
