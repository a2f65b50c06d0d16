//! Boundary-value problems: the same problem from the same guesses by every method there is.

use crate::guess::Start;
use crate::held::{Case, largest};
use crate::integrators::integrators;
use crate::measure::{kernel, segments};
use crate::minimise;
use crate::point::Point;
use crate::row::NONE;
use crate::scalar::Scalar;
use crate::shooting::Shooting;
use std::cell::Cell;
use std::hint::black_box;
use vibrissa::rod::{NewtonOptions, NewtonWorkspace, System, solve};

pub const PHASES: [&str; 6] = ["A", "B", "BA", "BB", "BBA", "BBB"];
pub const KERNEL: &str = "one segment";
pub const NEWTON: &str = "Newton";
const UNDER_ARGMIN: &str = "Newton under argmin";
const GAUSS_NEWTON: &str = "argmin Gauss-Newton";
const TRUST_REGION: &str = "argmin trust region";
const BRENT: &str = "Brent";

/// An error from which on a solution is another one.
const ELSEWHERE: f64 = 0.1;
/// Shooting iterates to what its integrator can tell, not beyond this.
const LEAST_TOLERANCE: f64 = 1e-13;

fn options(tolerance: f64) -> NewtonOptions {
    NewtonOptions { tolerance, ..NewtonOptions::default() }
}

/// 1e-first, ..., 1e-last.
fn tolerances(first: i32, last: i32) -> impl Iterator<Item = (String, f64)> {
    (first..=last).map(|digits| format!("1e-{digits}")).map(|setting| (setting.clone(), setting.parse().unwrap()))
}

/// Counts what Newton's method asks for.
struct Counted<'a, S> {
    system: S,
    evaluations: &'a Cell<usize>,
}

impl<S: System> System for Counted<'_, S> {
    fn dimension(&self) -> usize {
        self.system.dimension()
    }
    fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
        self.evaluations.set(self.evaluations.get() + 1);
        self.system.evaluate(u, residual, jacobian);
    }
    fn weights(&self, u: &[f64], weights: &mut [f64]) {
        self.system.weights(u, weights);
    }
}

/// A method at a setting, run from every guess: in place, and whether it says that it converged.
fn point<'a>(
    case: &Case<'_>,
    start: &'a Start,
    (method, setting): (&'static str, String),
    mut solver: impl FnMut(&mut [f64]) -> bool + 'a,
) -> Point<'a> {
    let (mut errors, mut solved) = (Vec::new(), Vec::new());
    for guess in &start.guesses {
        let mut u = guess.clone();
        let error = if solver(&mut u) { case.error(&u) } else { f64::NAN };
        if error < ELSEWHERE {
            errors.push(error);
            solved.push(guess.as_slice());
        }
    }
    let (of, all) = (solved.len(), start.guesses.len());
    let note = if of == all { String::new() } else { format!("{SOLVED_FROM} {of} of {all} guesses") };
    let error = (of > 0).then(|| largest(errors));
    let mut u = case.solution.clone();
    let work = move || {
        for guess in &solved {
            u.copy_from_slice(guess);
            solver(black_box(&mut u));
            black_box(&u);
        }
        solved.len()
    };
    let work = (of > 0).then(|| Box::new(work) as Box<dyn FnMut() -> usize>);
    Point { method, setting, errors: vec![(case.problem.name.clone(), error)], note, work }
}

/// Newton's method at every tolerance, its evaluations counted.
pub fn newton<'a>(case: &'a Case<'a>, start: &'a Start) -> Vec<Point<'a>> {
    let mut points = Vec::new();
    let problem = || case.clamped(case.clamp);
    for (setting, tolerance) in tolerances(3, 13) {
        let mut workspace = NewtonWorkspace::new();
        let mut newton = point(case, start, (NEWTON, setting), move |u| {
            solve(&problem(), u, &options(tolerance), &mut workspace).status.is_solved()
        });
        let evaluations = Cell::new(0);
        for guess in &start.guesses {
            let counted = Counted { system: problem(), evaluations: &evaluations };
            solve(&counted, &mut guess.clone(), &options(tolerance), &mut NewtonWorkspace::new());
        }
        if newton.note.is_empty() {
            let kernels = evaluations.get() * case.problem.contacts.len();
            newton.note = format!("{} {KERNELS}", kernels as f64 / start.guesses.len() as f64);
        }
        points.push(newton);
    }
    points
}

/// All methods on one problem.
pub fn points<'a>(case: &'a Case<'a>, start: &'a Start) -> Vec<Point<'a>> {
    // not a method, but what its time is made of
    let segments = segments();
    let kernel: Box<dyn FnMut() -> usize> = Box::new(move || kernel(&segments));
    let errors = vec![(case.problem.name.clone(), None)];
    let note = "time of one, of many random ones".to_owned();
    let mut points = vec![Point { method: KERNEL, setting: NONE.to_owned(), errors, note, work: Some(kernel) }];
    points.extend(newton(case, start));
    let problem = || case.clamped(case.clamp);
    for (setting, tolerance) in tolerances(3, 13).step_by(2) {
        let label = (UNDER_ARGMIN, setting);
        points.push(point(case, start, label, move |u| minimise::newton(problem(), u, options(tolerance))));
    }
    for (setting, tolerance) in tolerances(3, 13).step_by(2) {
        let label = (GAUSS_NEWTON, setting);
        points.push(point(case, start, label, move |u| minimise::gauss_newton(problem(), u, tolerance)));
    }
    for (setting, tolerance) in tolerances(3, 13).step_by(2) {
        let label = (TRUST_REGION, setting);
        points.push(point(case, start, label, move |u| minimise::trust_region(problem(), u, tolerance)));
    }
    for integrator in integrators(2) {
        let tolerance = integrator.tolerance.max(LEAST_TOLERANCE);
        let label = (integrator.name.of_shooting(), integrator.setting.clone());
        let mut workspace = NewtonWorkspace::new();
        points.push(point(case, start, label, move |u| {
            let shooting = Shooting { problem: problem(), integrator: &integrator };
            solve(&shooting, u, &options(tolerance), &mut workspace).status.is_solved()
        }));
    }
    if let Some(scalar) = Scalar::of(case) {
        for (setting, tolerance) in tolerances(3, 15).step_by(2) {
            let scalar = scalar.clone();
            points.push(point(case, start, (BRENT, setting), move |u| scalar.solve(u, start.reach, tolerance)));
        }
    }
    points
}

/// How the note begins where not every guess led to the solution.
pub const SOLVED_FROM: &str = "solved from";
/// What the note of a solve counts: evaluations of its segments.
pub const KERNELS: &str = "evaluations of a segment";
