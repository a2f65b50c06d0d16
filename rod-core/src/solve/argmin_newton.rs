//! The damped Newton step under `argmin`'s executor, for observers, limits, checkpoints and exchange of solvers.
//!
//! [`solve`](crate::solve) is the plain loop around the same step and costs less; both give the same iterates.

use super::newton::{NewtonOptions, NewtonWorkspace, SolveReport, SolveStatus, StepOutcome, newton_step};
use super::system::System;
use argmin::core::{
    CostFunction, Error, Gradient, Hessian, IterState, Jacobian, KV, Operator, Problem, Solver, TerminationReason,
    TerminationStatus,
};
use nalgebra::{DMatrix, DVector};

/// A [`System`] as a problem of `argmin`: the operator F(u) with its Jacobian for root-finders, 1/2 |F|^2 with its gradient
/// and the Hessian of Gauss and Newton, J^T J, for minimisers. Derivatives that are not finite, or above 1e100, are an error.
#[derive(Clone, Copy, Debug)]
pub struct RootProblem<S>(pub S);

impl<S: System> RootProblem<S> {
    fn residual(&self, u: &DVector<f64>) -> DVector<f64> {
        let mut residual = DVector::zeros(u.len());
        self.0.evaluate(u.as_slice(), residual.as_mut_slice(), None);
        residual
    }
}

/// Largest derivative that a minimiser gets: squares of larger ones overflow.
const LARGEST: f64 = 1e100;

fn moderate(derivatives: &[f64]) -> Result<(), Error> {
    let within = derivatives.iter().all(|v| v.abs() <= LARGEST);
    if within { Ok(()) } else { Err(Error::msg("the derivatives are not finite, or above 1e100")) }
}

impl<S: System> Operator for RootProblem<S> {
    type Param = DVector<f64>;
    type Output = DVector<f64>;
    fn apply(&self, u: &Self::Param) -> Result<Self::Output, Error> {
        Ok(self.residual(u))
    }
}

impl<S: System> Jacobian for RootProblem<S> {
    type Param = DVector<f64>;
    type Jacobian = DMatrix<f64>;
    fn jacobian(&self, u: &Self::Param) -> Result<Self::Jacobian, Error> {
        let mut residual = DVector::zeros(u.len());
        let mut jacobian = DMatrix::zeros(u.len(), u.len());
        self.0.evaluate(u.as_slice(), residual.as_mut_slice(), Some(jacobian.as_mut_slice()));
        Ok(jacobian)
    }
}

impl<S: System> CostFunction for RootProblem<S> {
    type Param = DVector<f64>;
    type Output = f64;
    fn cost(&self, u: &Self::Param) -> Result<f64, Error> {
        Ok(0.5 * self.residual(u).norm_squared())
    }
}

impl<S: System> Gradient for RootProblem<S> {
    type Param = DVector<f64>;
    type Gradient = DVector<f64>;
    fn gradient(&self, u: &Self::Param) -> Result<Self::Gradient, Error> {
        let gradient = self.jacobian(u)?.tr_mul(&self.residual(u));
        moderate(gradient.as_slice())?;
        Ok(gradient)
    }
}

impl<S: System> Hessian for RootProblem<S> {
    type Param = DVector<f64>;
    type Hessian = DMatrix<f64>;
    fn hessian(&self, u: &Self::Param) -> Result<Self::Hessian, Error> {
        let jacobian = self.jacobian(u)?;
        let hessian = jacobian.tr_mul(&jacobian);
        moderate(hessian.as_slice())?;
        Ok(hessian)
    }
}

/// The damped Newton method as a solver of `argmin`. Its cost is the largest |F_i|; observers get the length of each
/// correction under the key `correction`.
///
/// ```
/// use argmin::core::{Executor, State};
/// use nalgebra::DVector;
/// use rod_core::{NewtonOptions, NewtonSolver, RootProblem, System};
/// struct Root2; // u^2 = 2
/// impl System for Root2 {
///     fn dimension(&self) -> usize { 1 }
///     fn evaluate(&self, u: &[f64], r: &mut [f64], j: Option<&mut [f64]>) {
///         r[0] = u[0] * u[0] - 2.0;
///         if let Some(j) = j { j[0] = 2.0 * u[0]; }
///     }
/// }
/// let result = Executor::new(RootProblem(Root2), NewtonSolver::new(NewtonOptions::default()))
///     .configure(|state| state.param(DVector::from_element(1, 1.0)))
///     .ctrlc(false)
///     .run()?;
/// let u = result.state().get_param().unwrap();
/// assert!((u[0] - 2.0_f64.sqrt()).abs() < 1e-15);
/// assert!(result.solver.report().is_some_and(|report| report.status.is_solved()));
/// # Ok::<(), argmin::core::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct NewtonSolver {
    options: NewtonOptions,
    workspace: NewtonWorkspace,
    iterations: u32,
    done: Option<SolveReport>,
}

/// What `argmin` keeps between iterations of [`NewtonSolver`].
pub type NewtonState = IterState<DVector<f64>, (), DMatrix<f64>, (), DVector<f64>, f64>;

impl NewtonSolver {
    /// A solver with these options.
    pub fn new(options: NewtonOptions) -> Self {
        Self { options, ..Self::default() }
    }

    /// How the solve ended; none while it runs, or where `argmin` stopped it before.
    pub fn report(&self) -> Option<&SolveReport> {
        self.done.as_ref()
    }
}

impl<S: System> Solver<RootProblem<S>, NewtonState> for NewtonSolver {
    fn name(&self) -> &str {
        "damped Newton method"
    }

    fn init(
        &mut self,
        problem: &mut Problem<RootProblem<S>>,
        mut state: NewtonState,
    ) -> Result<(NewtonState, Option<KV>), Error> {
        let u = state.take_param().ok_or_else(|| Error::msg("the damped Newton method needs an initial guess"))?;
        (self.iterations, self.done) = (0, None);
        let workspace = &mut self.workspace;
        let residual = problem.problem("apply_count", |p| {
            if u.len() != p.0.dimension() {
                return Err(Error::msg(format!("the guess has {} entries, expected {}", u.len(), p.0.dimension())));
            }
            workspace.prepare(&p.0, u.as_slice());
            Ok(p.residual(&u))
        })?;
        Ok((state.param(u).cost(residual.amax()), None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<RootProblem<S>>,
        mut state: NewtonState,
    ) -> Result<(NewtonState, Option<KV>), Error> {
        let mut u = state.take_param().ok_or_else(|| Error::msg("the damped Newton method lost its iterate"))?;
        let Self { options, workspace, iterations, done } = self;
        let (outcome, residual) = problem.problem("jacobian_count", |p| {
            *iterations += 1;
            let outcome = newton_step(&p.0, u.as_mut_slice(), options, workspace);
            let (status, correction) = match outcome {
                StepOutcome::Done(status, length) => (Some(status), length),
                StepOutcome::Continue(length) if *iterations >= options.max_iterations => {
                    (Some(SolveStatus::TooManyIterations), length)
                }
                StepOutcome::Continue(length) => (None, length),
            };
            *done = status.map(|how| workspace.finish(&p.0, u.as_mut_slice(), how, *iterations, correction));
            Ok((correction, p.residual(&u)))
        })?;
        let mut kv = KV::new();
        kv.insert("correction", outcome.into());
        Ok((state.param(u).cost(residual.amax()), Some(kv)))
    }

    fn terminate(&mut self, _state: &NewtonState) -> TerminationStatus {
        match &self.done {
            None => TerminationStatus::NotTerminated,
            Some(report) if report.status.is_solved() => {
                TerminationStatus::Terminated(TerminationReason::SolverConverged)
            }
            Some(report) => {
                TerminationStatus::Terminated(TerminationReason::SolverExit(format!("{:?}", report.status)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::newton::solve;
    use super::*;
    use argmin::core::observers::{Observe, ObserverMode};
    use argmin::core::{Executor, State};
    use argmin::solver::gaussnewton::GaussNewton;
    use proptest::prelude::*;
    use std::sync::{Arc, Mutex};

    /// Two ellipses, or where they do not meet: nothing.
    #[derive(Clone, Copy)]
    struct Ellipses {
        a: f64,
        b: f64,
        shift: f64,
    }

    impl System for Ellipses {
        fn dimension(&self) -> usize {
            2
        }
        fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
            let (x, y) = (u[0], u[1]);
            residual[0] = x * x / (self.a * self.a) + y * y - 1.0;
            residual[1] = (x - self.shift).powi(2) + y * y / (self.b * self.b) - 1.0;
            if let Some(jacobian) = jacobian {
                jacobian.copy_from_slice(&[
                    2.0 * x / (self.a * self.a),
                    2.0 * (x - self.shift),
                    2.0 * y,
                    2.0 * y / (self.b * self.b),
                ]);
            }
        }
    }

    struct Record(Arc<Mutex<Vec<DVector<f64>>>>);

    impl Observe<NewtonState> for Record {
        fn observe_iter(&mut self, state: &NewtonState, _: &KV) -> Result<(), Error> {
            self.0.lock().unwrap().extend(state.get_param().cloned());
            Ok(())
        }
    }

    proptest! {
        #[test]
        fn both_drivers_give_the_same_iterates(
            a in 0.5..2.0_f64, b in 0.5..2.0_f64, shift in -1.0..1.0_f64, x in -2.0..2.0_f64, y in -2.0..2.0_f64,
        ) {
            let system = Ellipses { a, b, shift };
            let options = NewtonOptions::default();
            let mut plain = vec![x, y];
            let by_loop = solve(&system, &mut plain, &options, &mut NewtonWorkspace::new());

            let seen = Arc::new(Mutex::new(Vec::new()));
            let result = Executor::new(RootProblem(system), NewtonSolver::new(options))
                .configure(|state| state.param(DVector::from_vec(vec![x, y])))
                .add_observer(Record(seen.clone()), ObserverMode::Always)
                .ctrlc(false)
                .run()
                .unwrap();
            let seen = seen.lock().unwrap();
            prop_assert_eq!(result.solver.report(), Some(&by_loop));
            prop_assert_eq!(seen.len(), by_loop.iterations as usize);
            prop_assert_eq!(seen.last().unwrap().as_slice(), plain.as_slice());
            // and step by step
            let (mut u, mut workspace) = (vec![x, y], NewtonWorkspace::new());
            workspace.prepare(&system, &u);
            for (iterate, count) in seen.iter().zip(1..) {
                if let StepOutcome::Done(how, length) = newton_step(&system, &mut u, &options, &mut workspace) {
                    workspace.finish(&system, &mut u, how, count, length);
                }
                prop_assert_eq!(iterate.as_slice(), u.as_slice());
            }
        }
    }

    #[test]
    fn other_solvers_of_argmin_run_on_the_same_problem() {
        let system = Ellipses { a: 1.5, b: 1.2, shift: 0.3 };
        let result = Executor::new(RootProblem(system), GaussNewton::new().with_tolerance(1e-14).unwrap())
            .configure(|state| state.param(DVector::from_vec(vec![0.8, 0.9])).max_iters(50))
            .ctrlc(false)
            .run()
            .unwrap();
        let u = result.state().get_best_param().unwrap();
        let mut plain = [0.8, 0.9];
        solve(&system, &mut plain, &NewtonOptions::default(), &mut NewtonWorkspace::new());
        assert!((u[0] - plain[0]).abs() < 1e-7 && (u[1] - plain[1]).abs() < 1e-7, "{u} {plain:?}");
    }

    #[test]
    fn a_guess_of_the_wrong_size_is_an_error() {
        let result = Executor::new(RootProblem(Ellipses { a: 1.0, b: 1.0, shift: 0.5 }), NewtonSolver::default())
            .configure(|state| state.param(DVector::zeros(3)))
            .ctrlc(false)
            .run();
        assert!(result.err().unwrap().to_string().contains("3 entries, expected 2"));
    }
}
