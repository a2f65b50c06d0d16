//! Other solvers of `argmin` on the boundary-value problem. The only file that knows them.

use argmin::core::{Executor, OptimizationResult, Solver, State};
use argmin::solver::gaussnewton::GaussNewton;
use argmin::solver::trustregion::{Dogleg, TrustRegion};
use nalgebra::DVector;
use vibrissa::rod::{NewtonOptions, NewtonSolver, RootProblem, System};

/// Iterations after which a solver that does not come to an end has not converged.
const MOST: u64 = 60;

/// Our own step under argmin's executor. Returns whether it converged.
pub fn newton(system: impl System, u: &mut [f64], options: NewtonOptions) -> bool {
    let executor = Executor::new(RootProblem(system), NewtonSolver::new(options));
    let result = run(executor.configure(|state| state.param(DVector::from_column_slice(u))), u);
    result.is_some_and(|result| result.solver.report().is_some_and(|report| report.status.is_solved()))
}

/// Argmin's Gauss-Newton method, which goes on until |F| changes by less than the tolerance.
pub fn gauss_newton(system: impl System, u: &mut [f64], tolerance: f64) -> bool {
    let executor = Executor::new(RootProblem(system), GaussNewton::new().with_tolerance(tolerance).unwrap());
    let executor = executor.configure(|state| state.param(DVector::from_column_slice(u)).max_iters(MOST));
    run(executor, u).is_some_and(|result| result.state.get_iter() < MOST)
}

/// Argmin's trust region with dogleg steps, which goes on until |F| is below the tolerance: it has no other end.
pub fn trust_region(system: impl System, u: &mut [f64], tolerance: f64) -> bool {
    let executor = Executor::new(RootProblem(system), TrustRegion::new(Dogleg::new()));
    let executor = executor.configure(|state| {
        state.param(DVector::from_column_slice(u)).target_cost(0.5 * tolerance * tolerance).max_iters(MOST)
    });
    run(executor, u).is_some_and(|result| result.state.get_iter() < MOST)
}

/// Runs a solver from its start to its end, which goes to `u`.
fn run<O, S, I>(executor: Executor<O, S, I>, u: &mut [f64]) -> Option<OptimizationResult<O, S, I>>
where
    S: Solver<O, I>,
    I: State<Param = DVector<f64>>,
{
    let result = executor.ctrlc(false).timer(false).run().ok()?;
    if let Some(found) = result.state.get_param() {
        u.copy_from_slice(found.as_slice());
    }
    Some(result)
}
