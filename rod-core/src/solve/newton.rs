//! Damped Newton's method for square systems: one step, and the plain loop around it.
//!
//! The step is Deuflhard's error-oriented one (P. Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 3.3): a
//! trial is accepted by the natural monotonicity test, that is, if the simplified correction, made with the old Jacobian at
//! the trial point, is shorter than the correction itself. Where it is much shorter, the old Jacobian serves on.
//! [`argmin`](crate::NewtonSolver) drives the same step.

use super::jacobian::Jacobian;
use super::system::System;

/// When to stop, and when to give up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonOptions {
    /// Largest error of the solution that is left, in the weighted maximum norm, before one more correction by the
    /// residual that is reported: of the default, 1e-13, that leaves rounding. An ill-conditioned problem ends as
    /// [`SolveStatus::Stalled`] at what rounding allows.
    pub tolerance: f64,
    /// Largest number of steps (Jacobians).
    pub max_iterations: u32,
    /// Smallest damping factor.
    pub least_damping: f64,
    /// Longest step, in the weighted maximum norm: the linear model is not trusted beyond.
    pub longest_step: f64,
}

impl Default for NewtonOptions {
    fn default() -> Self {
        Self { tolerance: 1e-13, max_iterations: 30, least_damping: 1e-3, longest_step: 1.0 }
    }
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SolveStatus {
    /// The error left is below the tolerance.
    Converged,
    /// Corrections no longer shrink, but are at the level of rounding for this condition number: as good as it gets.
    Stalled,
    /// The iterations ran out.
    TooManyIterations,
    /// No damped step passed the monotonicity test.
    NoDescent,
    /// The Jacobian has no inverse, none that rounding leaves a digit of (the condition number is above 1 / 2.2e-16), or
    /// something was not finite.
    Singular,
}

impl SolveStatus {
    /// Whether the solution can be used.
    pub fn is_solved(self) -> bool {
        matches!(self, Self::Converged | Self::Stalled)
    }
}

/// How well a solve went.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SolveReport {
    /// How it ended.
    pub status: SolveStatus,
    /// Number of steps.
    pub iterations: u32,
    /// Largest |F_i| at the solution; where it converged, just before the last correction, which is made without looking
    /// again.
    pub residual: f64,
    /// Condition number of the last Jacobian in the 1-norm.
    pub condition: f64,
    /// Length of the last correction in the weighted maximum norm: an estimate of the error.
    pub correction: f64,
}

/// Memory of a solve. Keep one and no solve allocates once it has seen the largest dimension.
#[derive(Clone, Debug, Default)]
pub struct NewtonWorkspace {
    residual: Vec<f64>,
    jacobian: Jacobian,
    step: Vec<f64>,
    bar: Vec<f64>,
    trial: Vec<f64>,
    weights: Vec<f64>,
    damping: f64,
}

/// What one step came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepOutcome {
    /// Go on: the correction was this long.
    Continue(f64),
    /// Done: the error left is about this.
    Done(SolveStatus, f64),
}

impl NewtonWorkspace {
    /// An empty workspace.
    pub fn new() -> Self {
        Self::default()
    }

    /// Gets ready for a solve of `system` from `u`: to be called before the first [`newton_step`].
    pub fn prepare(&mut self, system: &impl System, u: &[f64]) {
        let n = system.dimension();
        for v in [&mut self.residual, &mut self.step, &mut self.bar, &mut self.trial, &mut self.weights] {
            v.resize(n, 0.0);
        }
        system.weights(u, &mut self.weights);
        self.damping = 1.0;
    }

    /// Report on the solution `u` that the last [`newton_step`] led to, with its true residual.
    pub fn report(
        &mut self,
        system: &impl System,
        u: &[f64],
        status: SolveStatus,
        iterations: u32,
        correction: f64,
    ) -> SolveReport {
        system.evaluate(u, &mut self.residual, None);
        let residual = largest(&self.residual);
        let condition = self.jacobian.condition();
        let lost =
            status.is_solved() && condition > NO_DIGIT && self.jacobian.weighted_condition(&self.weights) > NO_DIGIT;
        let status = if lost { SolveStatus::Singular } else { status };
        SolveReport { status, iterations, residual, condition, correction }
    }

    /// The [`report`](Self::report) on `u`, and, where that has converged, one more simplified correction of it: the
    /// residual is known, so that it costs no evaluation, and of an error of the tolerance it leaves rounding. In an
    /// ill-conditioned problem it would be nothing but rounding, and is not made.
    pub(crate) fn finish(
        &mut self,
        system: &impl System,
        u: &mut [f64],
        status: SolveStatus,
        iterations: u32,
        correction: f64,
    ) -> SolveReport {
        let report = self.report(system, u, status, iterations, correction);
        if status == SolveStatus::Converged {
            self.jacobian.correction(&self.residual, &mut self.bar);
            if self.norm(&self.bar) <= LAST_STEP {
                add(u, 1.0, &self.bar);
            }
        }
        report
    }

    /// Writes the last column of the inverse of the Jacobian that the last step used.
    pub fn last_column(&self, column: &mut [f64]) {
        self.jacobian.last_column(column);
    }

    fn norm(&self, v: &[f64]) -> f64 {
        largest_of(v.iter().zip(&self.weights).map(|(v, w)| v * w))
    }
}

/// Condition number at which no digit of a solution is right.
const NO_DIGIT: f64 = 1.0 / f64::EPSILON;
/// Largest ratio of two successive simplified corrections at which the old Jacobian is kept. A larger ratio costs more steps than
/// a new Jacobian.
const WORTH_A_CHORD: f64 = 0.05;
/// Limit of simplified steps with one Jacobian.
const MOST_CHORDS: usize = 4;
/// Largest correction that counts as rounding when corrections no longer shrink, if the residual is at rounding too.
const ROUNDING_STEP: f64 = 1e-9;
/// Largest last correction, taken after convergence.
const LAST_STEP: f64 = 1e-10;
/// Rounding of a residual whose terms are of order 1 to 10.
const ROUNDING_RESIDUAL: f64 = 1e-13;
/// Rounding of the residual by that of the unknowns, relative to their weighted norm: the parameter of a long contour may be in
/// the thousands.
const ROUNDING_UNKNOWNS: f64 = 4.0 * f64::EPSILON;

/// One damped Newton step from `u`, in place. `workspace` must have been prepared for this system by
/// [`NewtonWorkspace::prepare`].
pub fn newton_step(
    system: &impl System,
    u: &mut [f64],
    options: &NewtonOptions,
    workspace: &mut NewtonWorkspace,
) -> StepOutcome {
    let w = workspace;
    if !w.jacobian.take(system, u, &mut w.residual) {
        return StepOutcome::Done(SolveStatus::Singular, f64::INFINITY);
    }
    w.jacobian.correction(&w.residual, &mut w.step);
    let (length, before) = (w.norm(&w.step), largest(&w.residual));
    if !length.is_finite() {
        return StepOutcome::Done(SolveStatus::Singular, f64::INFINITY);
    }
    if length <= options.tolerance {
        add(u, 1.0, &w.step);
        return StepOutcome::Done(SolveStatus::Converged, length);
    }
    let mut damping = (2.0 * w.damping).min(1.0).min(options.longest_step / length);
    loop {
        w.trial.copy_from_slice(u);
        add(&mut w.trial, damping, &w.step);
        system.evaluate(&w.trial, &mut w.residual, None);
        w.jacobian.correction(&w.residual, &mut w.bar);
        let simplified = w.norm(&w.bar);
        if simplified <= (1.0 - 0.25 * damping) * length {
            u.copy_from_slice(&w.trial);
            w.damping = damping;
            if damping < 1.0 {
                return StepOutcome::Continue(length);
            }
            return chords(system, u, options, w, length, simplified);
        }
        let rounding = ROUNDING_RESIDUAL + ROUNDING_UNKNOWNS * w.norm(u);
        let left = largest(&w.residual);
        if simplified <= ROUNDING_STEP && left <= rounding {
            // what the full step came from may be much farther off
            if left <= before {
                u.copy_from_slice(&w.trial);
            }
            return StepOutcome::Done(SolveStatus::Stalled, simplified);
        }
        damping *= 0.5;
        if damping < options.least_damping {
            return StepOutcome::Done(SolveStatus::NoDescent, length);
        }
    }
}

/// Simplified steps with the Jacobian at hand, as long as they pay. The first of them, `w.bar`, is known.
fn chords(
    system: &impl System,
    u: &mut [f64],
    options: &NewtonOptions,
    w: &mut NewtonWorkspace,
    mut length: f64,
    mut simplified: f64,
) -> StepOutcome {
    for _ in 0..MOST_CHORDS {
        let contraction = simplified / length;
        if contraction > WORTH_A_CHORD && simplified > options.tolerance {
            return StepOutcome::Continue(length);
        }
        add(u, 1.0, &w.bar);
        // The next simplified correction would be shorter by the contraction: that is the error left.
        if 2.0 * contraction * simplified <= options.tolerance {
            return StepOutcome::Done(SolveStatus::Converged, simplified);
        }
        system.evaluate(u, &mut w.residual, None);
        w.jacobian.correction(&w.residual, &mut w.bar);
        (length, simplified) = (simplified, w.norm(&w.bar));
    }
    StepOutcome::Continue(length)
}

fn largest(v: &[f64]) -> f64 {
    largest_of(v.iter().copied())
}

/// Largest absolute value; NaN comes through, which f64::max would swallow.
fn largest_of(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a })
}

fn add(u: &mut [f64], scale: f64, v: &[f64]) {
    for (u, v) in u.iter_mut().zip(v) {
        *u += scale * v;
    }
}

/// Solves F(u) = 0 from the guess `u`, in place, by the plain loop of the hot path. Allocates nothing once `workspace` has
/// seen a system of this dimension.
///
/// ```
/// use rod_core::{NewtonOptions, NewtonWorkspace, System, solve};
/// struct Circle; // x^2 + y^2 = 1 and x = y
/// impl System for Circle {
///     fn dimension(&self) -> usize { 2 }
///     fn evaluate(&self, u: &[f64], r: &mut [f64], j: Option<&mut [f64]>) {
///         r.copy_from_slice(&[u[0] * u[0] + u[1] * u[1] - 1.0, u[0] - u[1]]);
///         if let Some(j) = j {
///             j.copy_from_slice(&[2.0 * u[0], 1.0, 2.0 * u[1], -1.0]);
///         }
///     }
/// }
/// let mut u = [1.0, 0.2];
/// let report = solve(&Circle, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
/// assert!(report.status.is_solved());
/// assert!((u[0] - 0.5_f64.sqrt()).abs() < 1e-15);
/// ```
pub fn solve(
    system: &impl System,
    u: &mut [f64],
    options: &NewtonOptions,
    workspace: &mut NewtonWorkspace,
) -> SolveReport {
    workspace.prepare(system, u);
    let (mut status, mut iterations, mut correction) = (SolveStatus::TooManyIterations, 0, f64::INFINITY);
    while iterations < options.max_iterations {
        iterations += 1;
        match newton_step(system, u, options, workspace) {
            StepOutcome::Continue(length) => correction = length,
            StepOutcome::Done(how, length) => {
                (status, correction) = (how, length);
                break;
            }
        }
    }
    workspace.finish(system, u, status, iterations, correction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// sin u = 0.
    struct Sine;

    impl System for Sine {
        fn dimension(&self) -> usize {
            1
        }

        fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
            residual[0] = u[0].sin();
            if let Some(jacobian) = jacobian {
                jacobian[0] = u[0].cos();
            }
        }
    }

    /// u^2 + v = 2 twice, but for 1e-6: condition 1e7.
    struct NearlySingular;

    impl System for NearlySingular {
        fn dimension(&self) -> usize {
            2
        }

        fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
            let square = u[0] * u[0];
            residual.copy_from_slice(&[square + u[1] - 2.0, square + (1.0 + 1e-6) * u[1] - (2.0 + 1e-6)]);
            if let Some(jacobian) = jacobian {
                jacobian.copy_from_slice(&[2.0 * u[0], 2.0 * u[0], 1.0, 1.0 + 1e-6]);
            }
        }
    }

    #[test]
    fn a_solve_that_stalls_leaves_nothing_but_rounding() {
        let mut stalled = 0;
        for k in 0..1000 {
            let mut u = [1.0 + 3e-6 * f64::from(k), 1.0 - 2e-6 * f64::from(k % 7)];
            let report = solve(&NearlySingular, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
            stalled += u32::from(report.status == SolveStatus::Stalled);
            if report.status.is_solved() {
                assert!(report.residual <= 2e-13, "{k}: {report:?}");
            }
        }
        assert!(stalled > 10, "{stalled}");
    }

    /// u^3 = 2.
    struct CubeRoot;

    impl System for CubeRoot {
        fn dimension(&self) -> usize {
            1
        }

        fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
            residual[0] = u[0].powi(3) - 2.0;
            if let Some(jacobian) = jacobian {
                jacobian[0] = 3.0 * u[0] * u[0];
            }
        }
    }

    #[test]
    fn what_has_converged_is_exact_to_rounding() {
        let mut converged = 0;
        for guess in 1..1000 {
            let mut u = [1.0 + 1e-3 * f64::from(guess)];
            let report = solve(&CubeRoot, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
            converged += u32::from(report.status == SolveStatus::Converged);
            assert!((u[0] - 2.0_f64.cbrt()).abs() <= 2.0 * f64::EPSILON, "{guess}: {u:?} {report:?}");
        }
        assert!(converged > 900, "{converged}");
    }

    #[test]
    fn a_large_unknown_is_found_to_its_own_rounding() {
        for k in 1000..3000 {
            let mut u = [f64::from(k) * PI + 0.1];
            let report = solve(&Sine, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
            assert!(report.status.is_solved(), "{k}: {report:?}");
            assert!((u[0] - f64::from(k) * PI).abs() <= f64::EPSILON * u[0], "{k}: {report:?}");
        }
    }
}
