//! The boundary-value problem by shooting through an integrator, with a Jacobian of differences.

use crate::integrators::Integrator;
use vibrissa::rod::{Cut, MultiPoint, Segment, Supports, System};

/// Differences of what is exact to rounding: the root of the rounding.
const LEAST_STEP: f64 = 2e-8;
/// Differences of what an integrator is exact to only, in roots of its tolerance.
const STEP: f64 = 0.3;

/// From the clamp and from each contact the rod is integrated to the next, where it must meet it in position and angle. The
/// curvatures and forces at the starts follow from the unknowns by balance, as for the closed form.
pub struct Shooting<'a, S> {
    pub problem: MultiPoint<'a, S>,
    pub integrator: &'a Integrator,
}

impl<S: Supports> Shooting<'_, S> {
    fn residual(&self, u: &[f64], residual: &mut [f64]) {
        let mut rows = residual.chunks_exact_mut(3);
        let mut before: Option<Segment> = None;
        self.problem.segments(u, |segment| {
            let Segment { s, start: section, .. } = segment;
            if let (Some(Segment { s: from, start, a, b }), Some(row)) = (before, before.and_then(|_| rows.next())) {
                let cut = Cut { x: start.x, y: start.y, phi: start.phi, moment: start.kappa };
                // no number tells Newton's method that this is no way
                let end = self.integrator.rod.advance(from, &cut, a, b, s - from);
                let off = end.map(|end| [end.x - section.x, end.y - section.y, end.phi - section.phi]);
                row.copy_from_slice(&off.unwrap_or([f64::NAN; 3]));
            }
            before = Some(segment);
        });
    }
}

impl<S: Supports> System for Shooting<'_, S> {
    fn dimension(&self) -> usize {
        self.problem.dimension()
    }

    fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
        self.residual(u, residual);
        let Some(jacobian) = jacobian else { return };
        let mut moved = u.to_vec();
        for (j, column) in jacobian.chunks_exact_mut(u.len()).enumerate() {
            let step = LEAST_STEP.max(STEP * self.integrator.tolerance.sqrt()) * (1.0 + u[j].abs());
            moved[j] = u[j] + step;
            self.residual(&moved, column);
            moved[j] = u[j];
            column.iter_mut().zip(&*residual).for_each(|(column, residual)| *column = (*column - residual) / step);
        }
    }

    fn weights(&self, u: &[f64], weights: &mut [f64]) {
        self.problem.weights(u, weights);
    }
}
