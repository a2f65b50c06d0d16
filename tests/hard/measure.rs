//! Forward error, backward error and condition of a solution.

use super::exact::{Problem, Shape};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use std::fmt;
use twofloat::TwoFloat;
use vibrissa::contact::{Contact, ContactKind};
use vibrissa::rod::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, SolveStatus, System, Uniform, solve};
use vibrissa::{Rod, State};

/// A residual beyond this is that of no solution.
const FARTHEST: f64 = 1e-6;

/// The integrator takes as long as the angles are large.
const FARTHEST_ANGLE: f64 = 1e3;

/// A correction beyond this has left where the equations are about linear.
const LARGEST_CORRECTION: f64 = 1.0;

/// How good a solution is.
#[derive(Clone, Copy, Debug)]
pub struct Measure {
    pub status: SolveStatus,
    /// Largest error of a result: places, arc lengths and angles as they are, forces and reactions relative to 1 + their size.
    pub forward: f64,
    /// Largest residual of the equations, in double-double, relative to the curvature where that is more than 1.
    pub backward: f64,
    /// Largest change of a result by the change of an equation.
    pub condition: f64,
}

impl Measure {
    /// How much more than the rounding of the equations the error is.
    pub fn factor(&self) -> f64 {
        self.forward / (self.condition * f64::EPSILON)
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { status, forward, backward, condition } = self;
        let status = format!("{status:?}");
        write!(
            f,
            "{status:<18} forward {forward:8.1e}  backward {backward:8.1e}  condition {condition:8.1e}  {:8.2}",
            self.factor()
        )
    }
}

/// Solves from `u` down to `tolerance` and measures what came out.
pub fn solved(problem: &Problem, u: &mut [f64], tolerance: f64) -> Measure {
    let system = MultiPoint { rod: Uniform, clamp: problem.clamp, supports: problem };
    let options = NewtonOptions { tolerance, ..NewtonOptions::default() };
    let report = solve(&system, u, &options, &mut NewtonWorkspace::new());
    measure(problem, u, report.status)
}

/// The errors of a state of a rod with length and stiffness 1, whose contacts are where `place` says: a shape, and the
/// parameter there.
pub fn of_state(state: &State, status: SolveStatus, place: impl Fn(&Contact) -> (Shape, f64)) -> Measure {
    let rod = state.elastica(&Rod::new(1.0, 1.0).unwrap()).unwrap();
    let (mut held, mut u) = (Vec::new(), Vec::new());
    for contact in &state.contacts {
        let (shape, t) = place(contact);
        let phi = rod.at(contact.s).phi;
        let turns = ((phi - contact.alpha) / PI).round();
        let tip = contact.kind == ContactKind::Tip;
        held.push((shape, if tip { Hold::Tip } else { Hold::Tangent { offset: PI * turns } }));
        u.extend([t, contact.force, if tip { phi } else { contact.s }]);
    }
    measure(&Problem { clamp: state.pose, held }, &u, status)
}

/// The errors of `u`.
pub fn measure(problem: &Problem, u: &[f64], status: SolveStatus) -> Measure {
    let n = u.len();
    let system = MultiPoint { rod: Uniform, clamp: problem.clamp, supports: problem };
    let (mut residual, mut jacobian, mut weights) = (vec![0.0; n], vec![0.0; n * n], vec![0.0; n]);
    system.evaluate(u, &mut residual, Some(&mut jacobian));
    system.weights(u, &mut weights);
    for j in 0..n / 3 {
        weights[3 * j + 1] = 1.0 / (1.0 + u[3 * j + 1].abs());
    }
    // from what ran away no Newton step leads back
    let ran_away = !residual.iter().all(|r| r.abs() < FARTHEST)
        || u.chunks(3).any(|u| u[0].abs().max(u[2].abs()) > FARTHEST_ANGLE);
    let lost = Measure { status, forward: f64::INFINITY, backward: f64::INFINITY, condition: f64::INFINITY };
    let Some(inverse) = DMatrix::from_vec(n, n, jacobian).try_inverse().filter(|_| !ran_away) else {
        return lost;
    };
    let at: Vec<TwoFloat> = u.iter().map(|&v| TwoFloat::from(v)).collect();
    let (exact, _) = problem.residual(&at);
    let exact = DVector::from_iterator(n, exact.iter().map(|&v| f64::from(v)));
    let change = &inverse * &exact;
    let moved = change.iter().zip(&weights).map(|(d, w)| (d * w).abs()).fold(0.0, f64::max);
    let row = |i: usize| inverse.row(i).iter().map(|v| v.abs()).sum::<f64>() * weights[i];
    let condition = (0..n).map(row).fold(1.0, f64::max);
    let mut bend = 1.0_f64;
    system.segments(u, |segment| bend = bend.max(segment.start.kappa.abs()));
    let backward = exact.amax() / bend;
    if moved > LARGEST_CORRECTION {
        return Measure { status, forward: moved, backward, condition };
    }
    // where the exact reactions are, and where the library's
    let corrected: Vec<TwoFloat> = at.iter().zip(change.iter()).map(|(&u, &d)| u - d).collect();
    let reactions = problem.residual(&corrected).1.map(f64::from);
    let ours = reactions_of(&system, problem, u);
    let off = reactions.iter().zip(ours).map(|(e, o)| (e - o).abs() / (1.0 + e.abs()));
    Measure { status, forward: off.fold(moved, f64::max), backward, condition }
}

/// (f0x, f0y, m0z) as the library gives them.
fn reactions_of(system: &MultiPoint<'_, Problem>, problem: &Problem, u: &[f64]) -> [f64; 3] {
    use vibrissa::rod::Supports;
    let (mut a, mut b) = (0.0, 0.0);
    for j in (0..problem.count()).rev() {
        let (sin, cos) = problem.support(j, u[3 * j]).alpha.sin_cos();
        a += u[3 * j + 1] * cos;
        b += u[3 * j + 1] * sin;
    }
    [-b, a, -system.clamp_curvature(u)]
}
